//! OpenRadioss: the fabric LAW58, whose crimped yarns move each other, with the curves that were measured.

use std::fmt::Write as _;

use super::abaqus_fabric::{Response, responses};
use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, hysteresis_of, lost, no_place};
use super::crimp::Crimp;
use super::radioss::ONE_MODEL;
use super::radioss_fabric::{both_sides, funct, line, rising};
use super::text::{label, number, preamble_of};
use crate::finding::{ExchangeFact, Finding};
use crate::instrument::Parameter;
use crate::quantity::Curve;
use crate::section::ShellSection;

/// `kesf export --to radioss-fabric-a`.
pub static EXPORTER: Exporter = Exporter {
    name: "radioss-fabric-a",
    ending: "fabric-a.inc",
    title: "/MAT/LAW58 (FABR_A) with /FUNCT curves of its yarns, out and back, as measured; a membrane; SI",
    holds: "The curves out and back along warp and weft and in shear, mass, and as much of Poisson's ratio as its crimp \
            can give; a membrane does not resist bending; the crimp is its default unless it is stated.",
    write,
};

const PROGRAM: &str = "OpenRadioss LAW58";

/// `S1` and `S2` where none are stated (`hm_read_mat58.F`).
const DEFAULT_CRIMP: f64 = 0.1;

/// A crimp that is next to none, to compare with.
const NO_CRIMP: f64 = 1e-6;

/// Points of a straight line that stands in for a curve: that of its yarn is none.
const LINE: usize = 100;

/// OpenRadioss, `radioss2017/MAT/matl58_fabr_a.cfg` (columns), `hm_read_mat58.F`, `law58_upd.F` and `sigeps58c.F` (meaning); numbers
/// are columns:
///
/// ```text
/// RHO_I                                                       20
/// E1  B1  E2  B2  Flex                                        20 each
/// G0  GT  AlphaT  Gsh  sensor_ID                              20 each, 10 blank, 10
/// Df  Ds  GFROT  ZERO_STRESS                                  20 each, 20 blank, 20
/// N1  N2  S1  S2  FLEX1  FLEX2                                10, 10, 20 each
/// FCT_ID1  Fscale1                                            10, 10 blank, 20; the same for FCT_ID2 and FCT_ID3
/// FCT_ID4  FCT_ID5  Fscale4  Fscale5  FCT_ID6  Fscale6        10, 10, 20, 20, 10, 20
/// ```
///
/// With functions of the way back N1 and N2 are 1, a yarn that is pushed has the first slope of its function, and the spring of
/// the crimp is `FLEX1 E1 H0/D0 + FLEX2 E2 H0'/D0'` ([`Crimp`]). The way back of a yarn is scaled to where it turned, so both functions
/// begin at zero and end at one point (message 1716); every slope is positive (1581 to 1583). Functions 3 and 6 are the shear
/// stress over the change of the angle between the yarns in degrees, to both sides.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let law = Law::of(material, section)?;
    let title = label(&material.sheet.name, 60);
    let mut text = preamble_of(material, "#", LAW, &notes(material, section.thickness, &law));
    block(&mut text, &title, section, &law);
    for (i, (out, _)) in law.functions.iter().enumerate() {
        funct(&mut text, i + 1, &title, out);
    }
    for (i, (_, back)) in law.functions.iter().enumerate() {
        back.iter().for_each(|back| funct(&mut text, i + 4, &title, back));
    }
    Ok(Card { text, findings: findings(material, section, &law) })
}

const LAW: &str = "Out and back along the curves that were measured: no time, and no loop about the origin.";

/// A function out, and one back.
type Functions = (Vec<[f64; 2]>, Option<Vec<[f64; 2]>>);

/// What the law has of a fabric.
struct Law {
    responses: [Response; 3],
    /// Strain and nominal stress of the cloth along warp and weft and in shear.
    curves: [Vec<[f64; 2]>; 3],
    crimp: Crimp,
    /// The same with next to no crimp.
    without: Crimp,
    /// Of the yarns, and of shear in degrees.
    functions: [Functions; 3],
    /// Slopes that functions 1 and 2 begin with.
    first: [f64; 2],
    flex: f64,
}

impl Law {
    /// O046: a test whose record goes nowhere.
    fn of(material: &CardInput<'_>, section: &ShellSection) -> Result<Self, CardError> {
        let thickness = section.thickness;
        let responses = responses(material.sheet, section);
        let curves = responses.each_ref().map(|r| stresses(r, thickness));
        if curves.iter().any(|curve| curve.len() < 2) {
            return Err(CardError::Range { value: 0.0 });
        }
        let c = Constants::of(section);
        let contraction = c.poisson * thickness / (c.yarns[0].tensile * c.yarns[1].tensile).sqrt();
        let backs = [0, 1, 2].map(|i| {
            let back = responses[i].back.iter().flat_map(Curve::points);
            returning(back.map(|(x, y)| [x, y / thickness]), &curves[i])
        });
        let runs: Vec<(usize, &[[f64; 2]])> = [0, 1]
            .into_iter()
            .flat_map(|i| backs[i].iter().chain([&curves[i]]).map(move |run| (i, &run[..])))
            .collect();
        let [crimp, without] = [material.crimp.unwrap_or([DEFAULT_CRIMP; 2]), [NO_CRIMP; 2]]
            .map(|excess| Crimp::of(excess, contraction, &runs));
        let functions = [0, 1, 2].map(|i| {
            (function(&crimp, i, &curves[i]), backs[i].as_ref().map(|back| function(&crimp, i, back)))
        });
        let first = [0, 1].map(|i| functions[i].0[1][1] / functions[i].0[1][0]);
        let flex = crimp.flex(first);
        Ok(Self { responses, curves, crimp, without, functions, first, flex })
    }
}

/// A function: of the yarn along warp or weft, or of shear in degrees.
fn function(crimp: &Crimp, place: usize, curve: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if place == 2 { both_sides(curve) } else { rising(curve.iter().map(|point| crimp.yarn(place, *point))) }
}

/// The unit system and the lines of the material.
fn block(text: &mut String, title: &str, section: &ShellSection, law: &Law) {
    let (thickness, flex, [warp, weft]) = (section.thickness, law.flex, law.crimp.excess);
    let shear = section.d_m[(2, 2)] / thickness;
    let across = across(section) / thickness;
    let _ = writeln!(text, "/UNIT/1\nSI\n{:>20}{:>20}{:>20}", "kg", "m", "s");
    let _ = writeln!(text, "/MAT/LAW58/1/1\nKESF_{title}");
    line(text, "RHO_I", &[section.areal_density / thickness]);
    line(text, "E1 B1 E2 B2 Flex", &[law.first[0], 0.0, law.first[1], 0.0, flex]);
    fields(text, "G0 GT AlphaT Gsh", &[shear, shear, 0.0, across], "sensor_ID", "0");
    fields(text, "Df Ds GFROT", &[0.0, 0.0, shear], "ZERO_STRESS", &number(0.0));
    let heads = ["S1", "S2", "FLEX1", "FLEX2"].map(|name| format!("{name:>20}")).concat();
    let crimp = [warp, weft, flex, flex].map(|v| format!("{:>20}", number(v))).concat();
    let _ = writeln!(text, "#       N1        N2{heads}\n{:>10}{:>10}{crimp}", 1, 1);
    let one = number(1.0);
    for function in 1..=3 {
        let _ = writeln!(
            text,
            "#  FCT_ID{function}                       Fscale{function}\n{function:>10}{one:>30}"
        );
    }
    let [warp, weft, sheared] = [0, 1, 2].map(|i| if law.functions[i].1.is_some() { i + 4 } else { i + 1 });
    let _ = writeln!(
        text,
        "#  FCT_ID4   FCT_ID5             Fscale4             Fscale5   FCT_ID6             Fscale6\n\
         {warp:>10}{weft:>10}{one:>20}{one:>20}{sheared:>10}{one:>20}"
    );
}

/// The one transverse shear stiffness (N/m): the mean of warp and weft.
fn across(section: &ShellSection) -> f64 {
    (section.d_s[(0, 0)] * section.d_s[(1, 1)]).max(0.0).sqrt()
}

fn findings(material: &CardInput<'_>, section: &ShellSection, law: &Law) -> Vec<Finding> {
    let c = Constants::of(section);
    let modulus = (c.yarns[0].tensile * c.yarns[1].tensile).sqrt() / section.thickness;
    let poisson = [law.crimp.at_rest(modulus), c.poisson];
    let mut findings: Vec<Finding> =
        [Property::Bending, Property::Torsion].map(|what| no_place(PROGRAM, section, what)).into();
    if c.poisson != 0.0 {
        findings.extend(lost(PROGRAM, "Poisson's ratio at rest", poisson, ""));
    }
    for (i, along) in ["warp", "weft"].into_iter().enumerate() {
        let what = format!("a transverse shear stiffness along the {along}");
        findings.extend(lost(PROGRAM, &what, [across(section), section.d_s[(i, i)]], "N/m"));
    }
    if material.crimp.is_none() {
        findings.push(assumed(law, section.thickness));
    }
    findings.extend(hysteresis_of(PROGRAM, material.sheet, Parameter::Hb));
    findings.extend(match &law.functions[2] {
        (out, Some(back)) => loop_of_shear(material, [out, back], section.thickness),
        _ => hysteresis_of(PROGRAM, material.sheet, Parameter::Hg),
    });
    findings
}

fn notes(material: &CardInput<'_>, thickness: f64, law: &Law) -> Vec<String> {
    let crimp =
        if material.crimp.is_some() { "are stated" } else { "are the default of the law: none are stated" };
    let mut notes = vec![
        "A membrane: give /PROP/TYPE16 (SH_FABR) one integration point, this thickness, and its first direction along the \
         warp. Nobody has run this card here."
            .to_string(),
        format!("Stresses are forces per width over a thickness of {thickness:.4E} m: change both or none."),
        format!(
            "S1 and S2, the crimp, {crimp}. Functions 1, 2, 4 and 5 are of yarns: tension over what a yarn is longer, by the \
             formulas of the law and with this crimp and FLEX, so that strips that are free to contract have the measured \
             curves. Change none of them alone."
        ),
        "FLEX gives strips the contraction of the section, or less where the crimp would take more than half of a step of a \
         measured curve (this share is assumed). A yarn that is pushed resists as it begins to be pulled: the law has it \
         so, KES-FB1 only pulls."
            .into(),
        "The way back is scaled to where a strip turns, and ends at zero: below its last recorded point it is a straight line. \
         Functions 3 and 6 have degrees. Functions have no units of their own: the model must be in m, kg and s."
            .into(),
        ONE_MODEL.into(),
    ];
    for ((n, response), (_, back)) in (1..).zip(&law.responses).zip(&law.functions) {
        let back =
            if back.is_some() { format!("back: function {}", n + 3) } else { "back the same way".into() };
        notes.push(format!("function {n}: {}; {back}", response.source));
    }
    notes
}

/// Strain and stress over the thickness, with positive slopes.
fn stresses(response: &Response, thickness: f64) -> Vec<[f64; 2]> {
    let points = rising(response.curve.points().map(|(strain, force)| [strain, force / thickness]));
    match points[..] {
        [_, [strain, stress]] => {
            (0..=LINE).map(|k| [strain, stress].map(|v| v * k as f64 / LINE as f64)).collect()
        }
        _ => points,
    }
}

/// The way back to the origin from the end of the way out, with positive slopes; none if hardly anything was recorded. Noise of
/// the mean is brought into order: the greatest stress stands at the greatest strain, and so on.
fn returning(back: impl Iterator<Item = [f64; 2]>, out: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    let (mut x, mut y): (Vec<f64>, Vec<f64>) =
        back.filter(|p| p[0] > 0.0 && p[1] > 0.0).map(|[x, y]| (x, y)).unzip();
    for values in [&mut x, &mut y] {
        values.sort_by(|a, b| b.total_cmp(a));
    }
    let mut points = vec![out[out.len() - 1]];
    for (x, y) in x.into_iter().zip(y) {
        let [last_x, last_y] = points[points.len() - 1].map(|v| v * (1.0 - 1e-8));
        if x < last_x && y < last_y {
            points.push([x, y]);
        }
    }
    points.push([0.0; 2]);
    points.reverse();
    (points.len() > 4).then_some(points)
}

/// Values in fields of twenty columns with their names above, and one at the right end of a hundred columns.
fn fields(text: &mut String, names: &str, values: &[f64], last: &str, value: &str) {
    let heads: String = names.split(' ').map(|n| format!("{n:>20}")).collect();
    let fields: String = values.iter().map(|v| format!("{:>20}", number(*v))).collect();
    let rest = 100 - fields.len();
    let _ = writeln!(text, "#{}{last:>rest$}\n{fields}{value:>rest$}", &heads[1..]);
}

/// O047: what the crimp that nobody stated does to strips.
fn assumed(law: &Law, thickness: f64) -> Finding {
    let ends = [0, 1].map(|i| law.curves[i][law.curves[i].len() - 1]);
    let [contraction, without] =
        [law.crimp, law.without].map(|crimp| [0, 1].map(|i| crimp.contraction(i, ends[i])));
    Finding::new(ExchangeFact::AssumedCrimp {
        program: PROGRAM.into(),
        crimp: DEFAULT_CRIMP,
        load: ends.map(|[_, stress]| stress * thickness),
        contraction,
        little: NO_CRIMP,
        without,
    })
}

/// O043: the width of the loop of shear at half a degree, of which the law has the part above zero.
fn loop_of_shear(material: &CardInput<'_>, [out, back]: [&[[f64; 2]]; 2], thickness: f64) -> Option<Finding> {
    let own = material.sheet.values.iter().filter(|(key, _)| key.parameter == Parameter::Hg);
    let own: Vec<f64> = own.map(|(_, estimate)| estimate.mean).collect();
    let mean = own.iter().sum::<f64>() / own.len().max(1) as f64;
    let has = (at_half_a_degree(out)? - at_half_a_degree(back)?) * thickness;
    if own.is_empty() { None } else { lost(PROGRAM, "the hysteresis of shear 2HG", [has, mean], "N/m") }
}

fn at_half_a_degree(curve: &[[f64; 2]]) -> Option<f64> {
    let pair = curve.windows(2).find(|pair| pair[1][0] >= 0.5)?;
    let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
    Some(y0 + (y1 - y0) * (0.5 - x0) / (x1 - x0))
}
