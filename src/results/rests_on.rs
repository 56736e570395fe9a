//! What a simulated value rests on that is not to be relied on: a constant of the section that nobody measured, or a
//! measured value that a finding speaks against.

use crate::finding::{Fact, Finding, SectionFact};
use crate::instrument::{Parameter, Test};
use crate::report::table::FabricRow;

/// Status of a value that a finding speaks against.
pub(super) const DOUBTFUL: &str = "doubtful";

/// What the deflection of a plate rests on.
pub(super) const OF_PLATE: &str = "w_max";

/// `an assumed E and a doubtful B warp`; nothing for a value of `quantity` that rests on measured values alone.
pub(super) fn remark(rows: &[FabricRow], findings: &[Finding], quantity: &str) -> String {
    let (_, direction) = quantity.split_once(' ').unwrap_or_default();
    let of_input = |symbol: &&str| match stand_in(symbol, findings) {
        Some(assumed) => vec![assumed],
        None => doubts(rows, symbol, direction),
    };
    let mut remarks: Vec<String> = inputs(quantity).iter().flat_map(of_input).collect();
    remarks.dedup();
    remarks.join(" and ")
}

/// `an assumed E`, where the stiffness that a test shows is a stand-in of the section.
pub(super) fn assumed_of_test(test: Test, findings: &[Finding]) -> Option<String> {
    let symbol = match test {
        Test::Tensile => "E",
        Test::Shear => "G",
        Test::Bending | Test::Compression | Test::Friction | Test::Roughness => return None,
    };
    stand_in(symbol, findings)
}

fn stand_in(symbol: &str, findings: &[Finding]) -> Option<String> {
    let is_of_symbol = |finding: &Finding| symbol_of_stand_in(&finding.fact) == Some(symbol);
    findings.iter().any(is_of_symbol).then(|| format!("an assumed {symbol}"))
}

/// The stiffness that a section has a stand-in for.
fn symbol_of_stand_in(fact: &Fact) -> Option<&'static str> {
    match fact {
        Fact::Section(SectionFact::NoTensileModulus { .. }) => Some("E"),
        Fact::Section(SectionFact::NoShearTest { .. }) => Some("G"),
        _ => None,
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
        Some(Test::Tensile) => &["E"],
        Some(Test::Shear) => &["G"],
        Some(Test::Bending) => &["B"],
        Some(Test::Compression | Test::Friction | Test::Roughness) => &[],
        None if name.starts_with("drape_") => &["E", "G", "B", "W"],
        None if name.starts_with("bending_length") || name.starts_with("heart_loop") => &["B", "W"],
        None if name == OF_PLATE => &["B"],
        None => &[],
    }
}

/// Values of the fabric that are not to be relied on, in a direction (any, if it is empty) or of the fabric as a whole.
fn doubts(rows: &[FabricRow], symbol: &str, direction: &str) -> Vec<String> {
    let is_input = |parameter: &str| parameter.split(' ').next() == Some(symbol);
    let is_along = |along: Option<&str>| along.is_none_or(|along| direction.is_empty() || along == direction);
    let rows = rows.iter().filter(|row| is_input(&row.parameter) && is_along(row.direction.as_deref()));
    rows.filter_map(|row| {
        let name = [Some(symbol), row.direction.as_deref()];
        let name = name.into_iter().flatten().collect::<Vec<_>>().join(" ");
        match row.status.as_str() {
            DOUBTFUL => Some(format!("a doubtful {name}")),
            "assumed" => Some(format!("a {name} that rests on an assumption")),
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

    #[test]
    fn what_is_doubtful_or_assumed_goes_on_to_what_is_predicted() {
        let (rows, findings) = sheet();
        let remark = |quantity: &str| remark(&rows, &findings, quantity);
        assert_eq!(remark("bending_length warp"), "a doubtful B warp");
        assert_eq!(remark("bending_length weft"), "");
        assert_eq!(remark("E warp"), "an assumed E");
        assert_eq!(remark("drape_coefficient"), "an assumed E and a doubtful B warp");
        assert_eq!((remark("G warp"), remark(OF_PLATE)), (String::new(), "a doubtful B warp".into()));
    }

    #[test]
    fn a_test_that_shows_a_stand_in_says_so() {
        let (_, findings) = sheet();
        assert_eq!(assumed_of_test(Test::Tensile, &findings).as_deref(), Some("an assumed E"));
        assert_eq!(assumed_of_test(Test::Bending, &findings), None);
        assert_eq!(assumed_of_test(Test::Tensile, &[]), None);
    }
}
