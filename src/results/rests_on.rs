//! What a simulated value rests on that is not to be relied on: a constant of the section that nobody measured, or a
//! measured value that a finding speaks against.

use super::task::Task;
use crate::characterise::ValueStatus;
use crate::finding::{Fact, Finding, SectionFact};
use crate::instrument::{Direction, Parameter, Test};
use crate::report::table::{FabricRow, UnitSystem, fabric_rows};

/// Status of a value that a finding speaks against.
pub(super) const DOUBTFUL: &str = "doubtful";

/// What the deflection of a plate rests on.
pub(super) const OF_PLATE: &str = "w_max";

/// What a strip under its own weight rests on, before the direction.
pub(super) const OF_STRIP: &str = "strip";

/// Something that a value rests on and that is not to be relied on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Ground {
    /// `Measured` of what was measured, but of warp and weft together.
    pub status: ValueStatus,
    /// `an assumed E`.
    pub text: String,
}

impl Ground {
    fn new(status: ValueStatus, text: impl Into<String>) -> Self {
        Self { status, text: text.into() }
    }
}

/// Parameters of the fabric of a task, and what was found while they and the section were made.
pub(super) fn known(task: &Task) -> (Vec<FabricRow>, Vec<Finding>) {
    let Some(sheet) = task.fabric else { return Default::default() };
    let of_section = task.section().ok().and_then(|(_, made)| made).map(|made| made.findings);
    let findings = sheet.findings.iter().cloned().chain(of_section.into_iter().flatten());
    (fabric_rows(sheet, UnitSystem::Si), findings.collect())
}

/// What a quantity of the fabric of a task rests on that is not to be relied on.
pub(super) fn of_task(task: &Task, quantity: &str) -> Vec<Ground> {
    let (values, findings) = known(task);
    grounds(&values, &findings, quantity)
}

/// `an assumed E`, `a doubtful B warp`; nothing for a value of `quantity` that rests on measured values alone.
pub(super) fn grounds(rows: &[FabricRow], findings: &[Finding], quantity: &str) -> Vec<Ground> {
    let (_, direction) = quantity.split_once(' ').unwrap_or_default();
    let of_input = |symbol: &&str| match stand_in(symbol, direction, findings) {
        // What stands in is one value, of whatever direction.
        Some(stand_in) => std::iter::once(stand_in).chain(doubts(rows, symbol, "")).collect(),
        None => doubts(rows, symbol, direction),
    };
    let mut grounds: Vec<Ground> = inputs(quantity).iter().flat_map(of_input).collect();
    grounds.dedup();
    grounds
}

/// `rests on an assumed E and a doubtful B warp`; nothing without grounds.
pub(super) fn remark(grounds: &[Ground]) -> Option<String> {
    (!grounds.is_empty()).then(|| format!("rests on {}", joined(grounds)))
}

/// `an assumed E and a doubtful B warp`.
pub(super) fn joined<'g>(grounds: impl IntoIterator<Item = &'g Ground>) -> String {
    let texts: Vec<&str> = grounds.into_iter().map(|ground| ground.text.as_str()).collect();
    texts.join(" and ")
}

/// The status that prevails among them.
pub(super) fn status(grounds: &[Ground]) -> ValueStatus {
    grounds.iter().map(|ground| ground.status).max().unwrap_or_default()
}

/// `an assumed E weft`: what stands for a stiffness in a direction (any, if it is empty) that the sheet does not have.
fn stand_in(symbol: &str, direction: &str, findings: &[Finding]) -> Option<Ground> {
    findings.iter().find_map(|finding| {
        if let Fact::Section(SectionFact::OneRigidity { known: None, .. }) = &finding.fact {
            return (symbol == "B").then(|| Ground::new(ValueStatus::Measured, "one B for warp and weft"));
        }
        let substitute = Substitute::of(&finding.fact)?;
        let assumed = || Ground::new(ValueStatus::Assumed, format!("an assumed {}", substitute.name()));
        substitute.replaces(symbol, direction).then(assumed)
    })
}

/// A stiffness that nobody measured, and for which the section has another value.
struct Substitute {
    symbol: &'static str,
    /// The direction; none for both.
    direction: Option<Direction>,
}

impl Substitute {
    fn of(fact: &Fact) -> Option<Self> {
        let (symbol, known) = match fact {
            Fact::Section(SectionFact::NoTensileModulus { .. }) => ("E", None),
            Fact::Section(SectionFact::NoShearTest { .. }) => ("G", None),
            Fact::Section(SectionFact::OneModulus { known, .. }) => ("E", Some(*known)),
            Fact::Section(SectionFact::OneRigidity { known: Some(known), .. }) => ("B", Some(*known)),
            _ => return None,
        };
        Some(Self { symbol, direction: known.map(Direction::across) })
    }

    /// Whether it stands for that stiffness in a direction; in any, if `along` is empty.
    fn replaces(&self, symbol: &str, along: &str) -> bool {
        self.symbol == symbol
            && (along.is_empty() || self.direction.is_none_or(|direction| direction.name() == along))
    }

    fn name(&self) -> String {
        self.direction.map_or(self.symbol.to_string(), |direction| format!("{} {direction}", self.symbol))
    }
}

/// Symbols of the inputs that a predicted quantity shows most of.
fn inputs(quantity: &str) -> &'static [&'static str] {
    let name = quantity.split(' ').next().unwrap_or_default();
    let test = if name == "E" {
        Some(Test::Tensile)
    } else {
        Parameter::from_symbol(name).and_then(Parameter::test)
    };
    match test {
        Some(test) => test.spec().stiffness.as_ref().map_or(&[], |shown| std::slice::from_ref(&shown.symbol)),
        None if name.starts_with("drape_") => &["E", "G", "B", "W"],
        None if name == OF_STRIP => &["B", "W"],
        None if name == OF_PLATE => &["B"],
        None => &[],
    }
}

/// Values of the fabric that are not to be relied on, in a direction (any, if it is empty) or of the fabric as a whole.
fn doubts(rows: &[FabricRow], symbol: &str, direction: &str) -> Vec<Ground> {
    let is_input = |parameter: &str| parameter.split(' ').next() == Some(symbol);
    let is_along = |along: Option<&str>| along.is_none_or(|along| direction.is_empty() || along == direction);
    let rows = rows.iter().filter(|row| is_input(&row.parameter) && is_along(row.direction.as_deref()));
    rows.filter_map(|row| {
        let name = [Some(symbol), row.direction.as_deref()];
        let name = name.into_iter().flatten().collect::<Vec<_>>().join(" ");
        match row.status.as_str() {
            DOUBTFUL => Some(Ground::new(ValueStatus::Doubtful, format!("a doubtful {name}"))),
            "assumed" => {
                Some(Ground::new(ValueStatus::Assumed, format!("a {name} that rests on an assumption")))
            }
            _ => None,
        }
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet() -> ([FabricRow; 3], [Finding; 1]) {
        let row = |parameter: &str, direction: &str, status: &str| FabricRow {
            parameter: parameter.into(),
            direction: Some(direction.into()),
            status: status.into(),
            ..FabricRow::default()
        };
        let assumed = SectionFact::NoTensileModulus { fabric: "a".into(), assumed: 5000.0 };
        let rows =
            [row("B", "warp", "doubtful"), row("B", "weft", "measured"), row("2HB", "weft", "doubtful")];
        (rows, [Finding::new(assumed)])
    }

    fn said(rows: &[FabricRow], findings: &[Finding], quantity: &str) -> String {
        let remark = remark(&grounds(rows, findings, quantity)).unwrap_or_default();
        remark.trim_start_matches("rests on ").to_string()
    }

    #[test]
    fn what_is_doubtful_or_assumed_goes_on_to_what_is_predicted() {
        let (rows, findings) = sheet();
        let remark = |quantity: &str| said(&rows, &findings, quantity);
        let status = |quantity: &str| super::status(&grounds(&rows, &findings, quantity));
        assert_eq!((status("B warp"), status("B weft")), (ValueStatus::Doubtful, ValueStatus::Measured));
        assert_eq!(
            (status("E warp"), status("drape_coefficient")),
            (ValueStatus::Assumed, ValueStatus::Doubtful)
        );
        assert_eq!(remark("strip warp"), "a doubtful B warp");
        assert_eq!(remark("strip weft"), "");
        assert_eq!(remark("E warp"), "an assumed E");
        assert_eq!(remark("drape_coefficient"), "an assumed E and a doubtful B warp");
        assert_eq!((remark("G warp"), remark(OF_PLATE)), (String::new(), "a doubtful B warp".into()));
    }

    /// A sheet with tests of the warp alone: what is said of the weft rests on them.
    #[test]
    fn one_direction_that_stands_for_both_is_no_measurement_of_the_other() {
        let (rows, _) = sheet();
        let (fabric, known) = ("a".to_string(), Direction::Warp);
        let modulus = "tangent_low".to_string();
        let findings = [
            Finding::new(SectionFact::OneModulus { fabric: fabric.clone(), known, modulus }),
            Finding::new(SectionFact::OneRigidity { fabric, known: Some(known) }),
        ];
        let remark = |quantity: &str| said(&rows, &findings, quantity);
        assert_eq!((remark("E warp"), remark("E weft")), (String::new(), "an assumed E weft".into()));
        assert_eq!(remark("strip warp"), "a doubtful B warp");
        assert_eq!(remark("strip weft"), "an assumed B weft and a doubtful B warp");
        let one = [Finding::new(SectionFact::OneRigidity { fabric: "a".into(), known: None })];
        assert_eq!(said(&rows[1..], &one, "strip warp"), "one B for warp and weft");
    }
}
