//! Values of fabrics on the page: simulated tests beside what was measured, and what is not to be relied on.

use super::fabric::FabricReport;
use super::rests_on::DOUBTFUL;
use crate::instrument::Parameter;
use crate::report::html::{Block, DoubtfulValue};
use crate::report::number::{self, concise, unit_text};
use crate::report::table::{FabricRow, PredictionRow, UnitSystem};

/// Whether the row is of a simulated KES test.
pub(super) fn is_of_test(row: &PredictionRow) -> bool {
    symbol(row).is_some()
}

/// The parameter of the row, or nothing of it if it is a modulus; `None` for what no KES test gives.
fn symbol(row: &PredictionRow) -> Option<Option<Parameter>> {
    let (first, _) = row.quantity.split_once(' ').unwrap_or((&row.quantity, ""));
    if first == "E" { Some(None) } else { Parameter::from_symbol(first).map(Some) }
}

/// Measured against simulated, every KES test of the fabric.
pub(super) fn tests(report: &FabricReport) -> Option<Block> {
    let rows: Vec<Vec<[String; 2]>> =
        report.predictions.iter().filter(|row| is_of_test(row)).map(test_row).collect();
    (!rows.is_empty()).then(|| Block::Units {
        caption: "Measured against simulated. The section is made of the measured stiffness, so agreement there shows \
                  that the simulated test reads it back; a difference is of clamps, edges and friction, and of G also that the \
                  section has one for both directions."
            .into(),
        header: ["quantity", "measured", "simulated", "difference", "95 % band", "unit", "case", "remark"]
            .map(String::from)
            .to_vec(),
        rows,
    })
}

fn test_row(row: &PredictionRow) -> Vec<[String; 2]> {
    let parameter = symbol(row).flatten();
    let [kes, si] = [UnitSystem::Kes, UnitSystem::Si]
        .map(|system| parameter.map_or(system.of_modulus(), |p| system.of(p)));
    let both = |value: Option<f64>, text: fn(f64) -> String| {
        [kes.1, si.1].map(|factor| value.map_or("-".into(), |v| text(v / factor)))
    };
    let computed = |value: f64| number::significant(value, 4);
    let same = |text: String| [text.clone(), text];
    let band = row.simulated_low.zip(row.simulated_high);
    vec![
        same(row.quantity.clone()),
        both(row.measured, concise),
        both(row.simulated, computed),
        same(row.error.map_or("-".into(), percent)),
        [kes.1, si.1].map(|factor| {
            let end = |v: f64| computed(v / factor);
            band.map_or("-".into(), |(low, high)| format!("{} to {}", end(low), end(high)))
        }),
        [kes.0, si.0].map(unit_text),
        same(row.case.clone()),
        same(row.remark.clone().unwrap_or_default()),
    ]
}

/// Values that a finding speaks against, then those that rest on an assumption; `page` is that of the problems, empty for
/// the page itself.
pub(super) fn doubtful(reports: &[FabricReport], page: &str) -> Option<Block> {
    let with_status = |status: &'static str| {
        reports.iter().flat_map(move |report| {
            let rows = report.rows.iter().enumerate().filter(move |(_, row)| row.status == status);
            rows.map(move |(at, row)| DoubtfulValue {
                causes: report.causes.get(&at).cloned().unwrap_or_default(),
                page: page.into(),
                ..doubtful_value(row)
            })
        })
    };
    let values: Vec<DoubtfulValue> = with_status(DOUBTFUL).chain(with_status("assumed")).collect();
    (!values.is_empty()).then_some(Block::Doubtful(values))
}

fn doubtful_value(row: &FabricRow) -> DoubtfulValue {
    let parameter = Parameter::from_symbol(&row.parameter);
    let direction = row.direction.as_deref().map_or(String::new(), |d| format!(" {d}"));
    let mean = [UnitSystem::Kes, UnitSystem::Si].map(|system| {
        let (unit, factor) = parameter.map_or(system.of_modulus(), |p| system.of(p));
        let mean = row.mean.map_or("-".into(), |mean| concise(mean / factor));
        format!("{mean} {}", unit_text(unit)).trim_end().to_string()
    });
    DoubtfulValue {
        fabric: row.fabric.clone(),
        parameter: format!("{}{direction}", row.parameter),
        mean,
        n: row.n,
        status: row.status.clone(),
        ..DoubtfulValue::default()
    }
}

/// A relative error; what is below what the text shows is no difference.
fn percent(error: f64) -> String {
    if error.abs() < 5e-5 {
        "below 0.01 %".into()
    } else {
        format!("{:+.2} %", 100.0 * error).replace('-', "−")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_stand_beside_what_was_measured_with_what_speaks_against_them() {
        let row = |quantity: &str, unit: &str| PredictionRow {
            case: "virtual_bending".into(),
            quantity: quantity.into(),
            // One gf·cm²/cm is 9.80665e-5 N·m.
            simulated: Some(9.80665e-6),
            measured: Some(9.80665e-6),
            unit: unit.into(),
            remark: Some("measured for warp and weft together; rests on a doubtful B".into()),
            ..PredictionRow::default()
        };
        let report = FabricReport {
            predictions: vec![row("bending_length warp", "m"), row("B warp", "N·m")],
            ..FabricReport::default()
        };
        let Some(Block::Units { rows, .. }) = tests(&report) else { panic!("a table") };
        assert_eq!(rows.len(), 1);
        assert_eq!(rows[0][1], ["0.1", "9.807 × 10⁻⁶"]);
        assert_eq!(rows[0][5], ["gf·cm²/cm", "N·m"]);
        assert_eq!(rows[0][7][0], "measured for warp and weft together; rests on a doubtful B");
    }

    #[test]
    fn only_what_is_not_to_be_relied_on_is_listed() {
        let row = |status: &str| FabricRow {
            fabric: "a".into(),
            parameter: "T0".into(),
            mean: Some(5e-4),
            n: 3,
            status: status.into(),
            ..FabricRow::default()
        };
        let report = |rows: [FabricRow; 2]| [FabricReport { rows: rows.to_vec(), ..FabricReport::default() }];
        assert!(doubtful(&report([row("measured"), row("inferred")]), "").is_none());
        let mut reports = report([row("assumed"), row("doubtful")]);
        reports[0].causes = [(1, vec!["K011".to_string()])].into();
        let Some(Block::Doubtful(values)) = doubtful(&reports, "") else { panic!("values") };
        assert_eq!(values.iter().map(|v| v.status.as_str()).collect::<Vec<_>>(), ["doubtful", "assumed"]);
        assert_eq!(values[0].mean, ["0.5 mm", "5 × 10⁻⁴ m"]);
        assert_eq!(
            (values[0].causes.as_slice(), values[1].causes.len()),
            (["K011".to_string()].as_slice(), 0)
        );
    }
}
