//! D_b, Eq. (5): bending rigidities, their coupling and the torsional rigidity.
//!
//! KES-FB2 bends a sheet 20 cm wide over a gap of 1 cm, so cylindrically: its B, in N·m (moment
//! per width over curvature), is D11 itself. There is no factor 1/(1-ν²), and no t³/12.
//! Eq. (5) of Nguyen-Trong et al. multiplies B by t³/12. That is right only if "B" is a bending *modulus*
//! 12 B / t³ (Pa); with the measured rigidity it is wrong by 12/t³, about 1e11 at 0.5 mm. The
//! paper does not say which it means; the units of its instrument do.
//!
//! Torsion is not measured by a standard KES set. The H = D66 of Nguyen-Trong et al. may be zero; then twisting
//! w = x y costs nothing. Huber's D12 + 2 D66 = √(B1 B2) makes B(45°) the mean of warp, weft and
//! twice their geometric mean, which lies near what bias tests of woven cloth give.

use nalgebra::Matrix3;

use super::notes::{Because, Notes, because, for_both};
use super::{Assumptions, BendingCoupling, Constant, ConstitutiveError, Provenance, Torsion};
use crate::characterise::{Key, ValueStatus};
use crate::finding::{EvaluationFact, Fact, Finding, SectionFact};
use crate::instrument::{Direction, Parameter};
use crate::quantity::significant;

/// D_b (N·m); `g` (N/m) and `thickness` (m) enter only with `Torsion::Shear`.
pub(super) fn matrix(
    g: f64,
    thickness: f64,
    assumptions: &Assumptions,
    notes: &mut Notes,
) -> Result<Matrix3<f64>, ConstitutiveError> {
    let Some([b1, b2]) = notes.bending_rigidities() else {
        return Err(notes.missing("bending rigidity B", "add a KES-FB2 test or a result table with B"));
    };
    for (direction, b) in [("warp", b1), ("weft", b2)] {
        let what = format!("the bending rigidity B along the {direction}");
        notes.positive(&what, b, "N·m", "look at the bending chart and its windows")?;
    }
    let value = format!("warp {} N·m, weft {} N·m", significant(b1), significant(b2));
    let source = rigidity_source(notes);
    notes.used("bending rigidity", value, source);

    let d12 = match assumptions.bending_coupling {
        BendingCoupling::Poisson(nu) => nu * (b1 * b2).sqrt(),
        BendingCoupling::Value(d12) => d12.si(),
    };
    let why = match assumptions.bending_coupling {
        BendingCoupling::Poisson(0.0) => "no coupling".into(),
        BendingCoupling::Poisson(nu) => format!("{nu} √(B1 B2)").into(),
        BendingCoupling::Value(_) => "stated".into(),
    };
    let value = format!("{} N·m", significant(d12));
    notes.used("bending coupling D12", value, (Provenance::Assumed, why));

    let (d66, source) = torsion([b1, b2, d12], g, thickness, assumptions.torsion, notes)?;
    notes.used("torsional rigidity D66", format!("{} N·m", significant(d66)), source);
    Ok(Matrix3::new(b1, d12, 0.0, d12, b2, 0.0, 0.0, 0.0, d66))
}

/// D66 over the geometric mean of D11 and D22 beyond which it is told: Huber's assumption has 0.5, and a
/// homogeneous plate (1 - ν)/2 or G t²/12, which a thick sheet of stiff shear may raise.
const STIFF_TORSION: f64 = 100.0;

/// What a B of the sheet is of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Origin {
    /// KES-FB2, or a table that does not say otherwise.
    Fb2,
    /// A table of another instrument.
    Table,
    /// The friction law of bend loops.
    BendLoops,
    /// The slope of buckled strips.
    Buckled,
}

impl Origin {
    fn of(notes: &Notes, direction: Option<Direction>) -> Self {
        let tells = |f: &Finding| match &f.fact {
            Fact::Evaluation(EvaluationFact::BuckledStrips { direction: of, .. })
                if Some(*of) == direction =>
            {
                Some(Self::Buckled)
            }
            Fact::Evaluation(EvaluationFact::BendLoopLaw { direction: of, .. }) if Some(*of) == direction => {
                Some(Self::BendLoops)
            }
            _ => None,
        };
        let key = Key { parameter: Parameter::B, direction };
        let inferred = notes.sheet.status(key) == ValueStatus::Inferred;
        let other = if inferred { Self::Table } else { Self::Fb2 };
        notes.sheet.findings.iter().find_map(tells).unwrap_or(other)
    }

    fn provenance(self) -> Provenance {
        if self == Self::Fb2 { Provenance::Measured } else { Provenance::Inferred }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Fb2 => "B of KES-FB2 is D11, D22",
            Self::Table => {
                "B of a table that was not measured on KES-FB2 (a cantilever of FAST), for D11, D22"
            }
            Self::BendLoops => "friction law of FAB bend loops, as KES-FB2 would read it, for D11, D22",
            Self::Buckled => "slope of buckled FAB strips, which stands for D11, D22",
        }
    }
}

/// Where B comes from; C018 if it is the slope of buckled strips.
fn rigidity_source(notes: &mut Notes) -> Because {
    let along = [Direction::Warp, Direction::Weft];
    let known = |d: &Direction| notes.sheet.get(Parameter::B, Some(*d)).is_some();
    let directed: Vec<Direction> = along.into_iter().filter(known).collect();
    let of_fabric = directed.len() < 2 && notes.sheet.get(Parameter::B, None).is_some();
    let used: Vec<Option<Direction>> =
        if of_fabric { vec![None] } else { directed.iter().copied().map(Some).collect() };
    let origins: Vec<(Option<Direction>, Origin)> =
        used.iter().map(|d| (*d, Origin::of(notes, *d))).collect();
    let buckled = origins.iter().filter(|(_, o)| *o == Origin::Buckled);
    let directions: Vec<Direction> = buckled.filter_map(|(d, _)| *d).collect();
    if !directions.is_empty() {
        notes.finding(SectionFact::StripRigidity { fabric: notes.fabric(), directions });
    }
    let first = origins[0].1;
    let text = if origins.iter().all(|(_, o)| *o == first) {
        first.text().into()
    } else {
        let each = origins.iter().map(|(d, o)| format!("{}: {}", d.map_or("", Direction::name), o.text()));
        each.collect::<Vec<_>>().join("; ")
    };
    let values: Vec<_> = used.iter().map(|direction| notes.known(Parameter::B, *direction)).collect();
    let (_, why) = because(&values, text);
    match used[..] {
        [Some(one)] => for_both(one, &why),
        [None] => (first.provenance(), format!("{why}, one value of the fabric for both").into()),
        _ if origins.iter().all(|(_, o)| o.provenance() == Provenance::Measured) => {
            (Provenance::Measured, why)
        }
        _ => (Provenance::Inferred, why),
    }
}

fn assumed(why: &'static str) -> Because {
    (Provenance::Assumed, why.into())
}

/// D66 (N·m) and where it comes from.
fn torsion(
    [b1, b2, d12]: [f64; 3],
    g: f64,
    thickness: f64,
    torsion: Torsion,
    notes: &mut Notes,
) -> Result<(f64, Because), ConstitutiveError> {
    let (d66, why) = match torsion {
        Torsion::Huber => (((b1 * b2).sqrt() - d12) / 2.0, assumed("Huber, D12 + 2 D66 = √(B1 B2)")),
        Torsion::Bias => {
            let Some(b45) = notes.sheet.get(Parameter::B, Some(Direction::Bias)) else {
                return Err(notes.missing(
                    "bending test on the bias",
                    "measure one at 45°, or choose torsion = \"huber\" or a value",
                ));
            };
            notes.origin_value(Parameter::B, Some(Direction::Bias), &[(Constant::Bias, 1.0)]);
            let b45 = b45.mean;
            let origin = Origin::of(notes, Some(Direction::Bias));
            let source = match origin {
                Origin::Fb2 => "",
                Origin::Table => "of a table that was not measured on KES-FB2, ",
                Origin::BendLoops => "friction law of FAB bend loops, ",
                Origin::Buckled => "slope of buckled strips, ",
            };
            let why = format!("{source}B at 45° = {} N·m", significant(b45));
            (b45 - (b1 + b2 + 2.0 * d12) / 4.0, (origin.provenance(), why.into()))
        }
        Torsion::Shear => (g * thickness.powi(2) / 12.0, assumed("G t²/12")),
        Torsion::Value(h) => (h.si(), assumed("stated")),
        Torsion::Neglect => {
            notes.finding(SectionFact::NoTorsion { fabric: notes.fabric() });
            return Ok((0.0, assumed("neglected, as Nguyen-Trong et al. allow")));
        }
    };
    let cure = match torsion {
        Torsion::Huber => "the bending coupling D12 is not below √(B1 B2): lower it, or give torsion a value",
        _ => "choose torsion = \"huber\" or a value, or lower the bending coupling",
    };
    notes.positive("the torsional rigidity D66", d66, "N·m", cure)?;
    let times = d66 / (b1 * b2).sqrt();
    if times > STIFF_TORSION {
        notes.finding(SectionFact::StiffTorsion { fabric: notes.fabric(), times });
    }
    Ok((d66, why))
}
