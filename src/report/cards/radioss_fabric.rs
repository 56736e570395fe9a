//! OpenRadioss: the fabric LAW158 with the curves that were measured.

use std::fmt::Write as _;

use super::abaqus_fabric::responses;
use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Property, no_place};
use super::radioss::ONE_MODEL;
use super::text::{label, number, preamble_of};
use crate::section::ShellSection;

/// `kesf export --to radioss-fabric`.
pub static EXPORTER: Exporter = Exporter {
    name: "radioss-fabric",
    ending: "fabric.inc",
    title: "/MAT/LAW158 (FABR_NL) with /FUNCT curves of tension and shear, as measured; a membrane; SI",
    holds: "The loading curves along warp and weft and in shear, and mass; a membrane does not resist bending; no \
            contraction across, as the crimp that decides it is not measured; no unloading curve.",
    write,
};

/// Nominal stretch of the crimp (S1, S2): so small that the strain of a yarn is that of the cloth. Zero would be the default,
/// 0.1.
const NO_CRIMP: f64 = 1e-6;

/// Stress of cloth that is pushed, over that at the end of its curve: the starter refuses curves with a level part.
const PUSHED: f64 = 1e-6;

/// OpenRadioss, `radioss2022/MAT/mat_158_fabric.cfg` (columns) and `sigeps158c.F` (meaning); `%20lg` is a field of 20
/// columns, `%10d` one of 10:
///
/// ```text
/// RHO_I                                       20
/// S1  S2  FLEX  FLEX1  FLEX2                  20 each
/// ZERO_STRESS  sensor_ID                      20, 10 blank, 10
/// FCT_ID1  Fscale1                            10, 10 blank, 20; the same for FCT_ID2 and FCT_ID3
/// FCT_ID4  FCT_ID5                            10 each
/// ```
///
/// and `/FUNCT/ID`, title, abscissa and ordinate in 20 columns each. Functions 1 and 2 are the nominal stress of a yarn
/// over its nominal strain, which with [`NO_CRIMP`] are those of the cloth; function 3 is the shear stress over the change
/// of the angle between the yarns in degrees. Every slope must be positive (messages 1581 to 1583 of the starter).
/// FLEX, FLEX1 and FLEX2 (Pa) move the crimp, of which there is none: they are the default 1 that a zero stands for.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let thickness = section.thickness;
    let responses = responses(material.sheet, section);
    let mut notes = vec![
        "A membrane: give /PROP/TYPE16 (SH_FABR) one integration point, this thickness, and its first direction along the \
         warp. Nobody has run this card here."
            .to_string(),
        format!("Stresses are forces per width over a thickness of {thickness:.4E} m: change both or none."),
        "S1 and S2, the crimp, are not measured: 1e-6 takes it away, and with it the contraction across. Yarns that are \
         pushed carry a millionth of what they carry at the end of their curve: this is assumed, KES-FB1 only pulls."
            .into(),
        "Function 3 has degrees. Functions have no units of their own: the model must be in m, kg and s.".into(),
        ONE_MODEL.into(),
    ];
    notes.extend(responses.iter().zip(1..).map(|(r, n)| format!("function {n}: {}", r.source)));
    let law = "Elastic, along the loading curves: no friction of yarns, no time.";
    let mut text = preamble_of(material, "#", law, &notes);
    let title = label(&material.sheet.name, 60);
    let _ = writeln!(text, "/UNIT/1\nSI\n{:>20}{:>20}{:>20}", "kg", "m", "s");
    let _ = writeln!(text, "/MAT/LAW158/1/1\nKESF_{title}");
    line(&mut text, "RHO_I", &[section.areal_density / thickness]);
    line(&mut text, "S1 S2 FLEX FLEX1 FLEX2", &[NO_CRIMP, NO_CRIMP, 1.0, 1.0, 1.0]);
    let _ = writeln!(text, "#        ZERO_STRESS           sensor_ID\n{:>20}{:>20}", number(0.0), 0);
    for function in 1..=3 {
        let _ = writeln!(text, "#  FCT_ID{function}                       Fscale{function}");
        let _ = writeln!(text, "{function:>10}{:>30}", number(1.0));
    }
    let _ = writeln!(text, "#  FCT_ID4   FCT_ID5\n{:>10}{:>10}", 0, 0);
    for (function, response) in (1..).zip(&responses) {
        let stress = response.curve.points().map(|(strain, force)| [strain, force / thickness]);
        funct(&mut text, function, &title, &function_points(stress, function == 3));
    }
    let lost = [Property::Bending, Property::Torsion, Property::TransverseShear, Property::Poisson];
    Ok(Card { text, findings: lost.map(|what| no_place("OpenRadioss LAW158", section, what)).into() })
}

/// A function with its number and title: abscissa and ordinate in 20 columns each.
pub(super) fn funct(text: &mut String, function: usize, title: &str, points: &[[f64; 2]]) {
    let _ = writeln!(text, "/FUNCT/{function}\nKESF_{title}_{function}");
    for [x, y] in points {
        let _ = writeln!(text, "{:>20}{:>20}", number(*x), number(*y));
    }
}

/// Names as a comment, and their values below them in fields of twenty columns.
pub(super) fn line(text: &mut String, names: &str, values: &[f64]) {
    let heads: String = names.split(' ').map(|n| format!("{n:>20}")).collect();
    let fields: String = values.iter().map(|v| format!("{:>20}", number(*v))).collect();
    let _ = writeln!(text, "#{}\n{fields}", &heads[1..]);
}

/// A curve with positive slopes on both sides of the origin: that of shear is the same to both sides and has degrees, that of a
/// yarn has next to nothing where it is pushed.
fn function_points(curve: impl Iterator<Item = [f64; 2]>, shear: bool) -> Vec<[f64; 2]> {
    let mut out = rising(curve);
    if shear {
        return both_sides(&out);
    }
    let [_, end] = out[out.len() - 1];
    out.insert(0, [-1.0, -PUSHED * end]);
    out
}

/// From the origin, with positive slopes. Points that print alike would be a vertical or a level part.
pub(super) fn rising(curve: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = vec![[0.0; 2]];
    for [x, y] in curve {
        let [before, level] = out[out.len() - 1].map(|v| v + 1e-8 * v.abs());
        if x > before && y > level {
            out.push([x, y]);
        }
    }
    out
}

/// A curve of shear from the origin, the same to both sides, in degrees.
pub(super) fn both_sides(curve: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let degrees = |[angle, stress]: [f64; 2]| [angle.to_degrees(), stress];
    let other = curve.iter().skip(1).rev().map(|[x, y]| [-x, -y]);
    other.chain(curve.iter().copied()).map(degrees).collect()
}
