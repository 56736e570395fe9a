//! Predictions on the page: what a laboratory measures first, plates in a form without units, tests beside measured
//! values.

use std::collections::BTreeMap;

use super::fabric::FabricReport;
use crate::instrument::Parameter;
use crate::quantity::significant;
use crate::report::html::Block;
use crate::report::number::unit_text;
use crate::report::table::{FabricRow, PredictionRow, UnitSystem};

/// Above the table of what a laboratory measures.
const LEADING: &str = "What a laboratory measures: drape, and the bending length of the cantilever; the measured value \
                       stands beside the simulated one where there is one.";

/// Above the table of plates.
const PLATES: &str = "Linear solves, normalised: largest deflection over the bending thickness √(12 B / D_m). A linear \
                      solve is meaningful below 0.3; above, the number says how stiff a sheet is, not what shape it takes.";

/// Whether a laboratory measures the quantity of a row by a test that is no KES test.
fn leads(row: &PredictionRow) -> bool {
    row.quantity.starts_with("drape_") || row.quantity.starts_with("bending_length")
}

/// Whether the row is of a simulated KES test.
fn is_of_test(row: &PredictionRow) -> bool {
    symbol(row).is_some()
}

/// The parameter of the row, or nothing of it if it is a modulus; `None` for what no KES test gives.
fn symbol(row: &PredictionRow) -> Option<Option<Parameter>> {
    let (first, _) = row.quantity.split_once(' ').unwrap_or((&row.quantity, ""));
    if first == "E" { Some(None) } else { Parameter::from_symbol(first).map(Some) }
}

/// Drape and cantilever, one row a fabric.
pub(super) fn leading(reports: &[FabricReport]) -> Option<Block> {
    let rows = |r: &'_ FabricReport| -> Vec<PredictionRow> {
        r.predictions.iter().filter(|row| leads(row)).cloned().collect()
    };
    let key =
        |row: &PredictionRow| (!row.quantity.starts_with("drape_"), row.case.clone(), row.quantity.clone());
    let mut columns: Vec<_> = reports.iter().flat_map(rows).map(|row| (key(&row), unit(&row))).collect();
    columns.sort_by(|a, b| (a.0.0, &a.0.1).cmp(&(b.0.0, &b.0.1)));
    let mut seen = Vec::new();
    columns.retain(|(key, _)| {
        !seen.contains(key) && {
            seen.push(key.clone());
            true
        }
    });
    let header = columns.iter().map(|((_, case, quantity), unit)| {
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        format!("{}{unit}, {case}", quantity.replace('_', " "))
    });
    let line = |report: &FabricReport| {
        let of: BTreeMap<_, _> = rows(report).iter().map(|row| (key(row), shown(row))).collect();
        let cells = columns.iter().map(|(key, _)| of.get(key).cloned().unwrap_or("-".into()));
        std::iter::once(report.name.clone()).chain(cells).collect()
    };
    (!columns.is_empty()).then(|| Block::Table {
        caption: LEADING.into(),
        header: std::iter::once("fabric".to_string()).chain(header).collect(),
        rows: reports.iter().map(line).collect(),
    })
}

/// The unit in which a leading quantity is read.
fn unit(row: &PredictionRow) -> &'static str {
    match row.unit.as_str() {
        "m" => "mm",
        _ if row.quantity.starts_with("drape_coefficient") => "%",
        _ => "",
    }
}

fn shown(row: &PredictionRow) -> String {
    let factor = match unit(row) {
        "mm" => 1e-3,
        "%" => 1e-2,
        _ => 1.0,
    };
    let text = |value: f64| {
        if factor == 1.0 { value.to_string() } else { significant(value / factor) }
    };
    let simulated = row.simulated.map_or("-".into(), text);
    row.measured.map_or(simulated.clone(), |m| format!("{simulated} (measured {})", text(m)))
}

/// Linear solves, one row a fabric and one column a case.
pub(super) fn plates(reports: &[FabricReport]) -> Option<Block> {
    let mut cases: Vec<&str> = Vec::new();
    for (case, _) in reports.iter().flat_map(|r| &r.relative_deflections) {
        if !cases.contains(&case.as_str()) {
            cases.push(case);
        }
    }
    let line = |report: &FabricReport| {
        let of = |case: &&str| {
            let found = report.relative_deflections.iter().find(|(name, _)| name == case);
            found.map_or("-".to_string(), |(_, value)| significant(*value))
        };
        std::iter::once(report.name.clone()).chain(cases.iter().map(of)).collect()
    };
    (!cases.is_empty()).then(|| Block::Table {
        caption: PLATES.into(),
        header: std::iter::once("fabric").chain(cases.iter().copied()).map(String::from).collect(),
        rows: reports.iter().map(line).collect(),
    })
}

/// Measured against simulated, every KES test of the fabric.
pub(super) fn tests(report: &FabricReport) -> Option<Block> {
    let rows: Vec<Vec<[String; 2]>> =
        report.predictions.iter().filter(|row| is_of_test(row)).map(test_row).collect();
    (!rows.is_empty()).then(|| Block::Units {
        caption: "Measured against simulated. The section is made of the measured stiffness, so agreement there shows \
                  that the simulated test reads it back; a difference is of clamps, edges and friction."
            .into(),
        header: ["quantity", "measured", "simulated", "difference", "95 % band", "unit", "case"]
            .map(String::from)
            .to_vec(),
        rows,
    })
}

fn test_row(row: &PredictionRow) -> Vec<[String; 2]> {
    let parameter = symbol(row).flatten();
    let [kes, si] = [UnitSystem::Kes, UnitSystem::Si]
        .map(|system| parameter.map_or(system.of_modulus(), |p| system.of(p)));
    let both = |value: Option<f64>| {
        [kes.1, si.1].map(|factor| value.map_or("-".into(), |v| significant(v / factor)))
    };
    let same = |text: String| [text.clone(), text];
    let band = row.simulated_low.zip(row.simulated_high);
    vec![
        same(row.quantity.clone()),
        both(row.measured),
        both(row.simulated),
        same(row.error.map_or("-".into(), percent)),
        [kes.1, si.1].map(|factor| {
            let end = |v: f64| significant(v / factor);
            band.map_or("-".into(), |(low, high)| format!("{} to {}", end(low), end(high)))
        }),
        [kes.0, si.0].map(unit_text),
        same(row.case.clone()),
    ]
}

/// Values that a finding speaks against or that rest on an assumption.
pub(super) fn doubtful(reports: &[FabricReport]) -> Option<Block> {
    let is_meant = |row: &&FabricRow| matches!(row.status.as_str(), "doubtful" | "assumed");
    let rows: Vec<Vec<[String; 2]>> =
        reports.iter().flat_map(|r| &r.rows).filter(is_meant).map(doubtful_row).collect();
    (!rows.is_empty()).then(|| Block::Units {
        caption: "Values not to be relied on as they stand; why, and what to do, stands below.".into(),
        header: ["fabric", "parameter", "mean", "unit", "n", "status"].map(String::from).to_vec(),
        rows,
    })
}

fn doubtful_row(row: &FabricRow) -> Vec<[String; 2]> {
    let parameter = Parameter::from_symbol(&row.parameter);
    let [kes, si] = [UnitSystem::Kes, UnitSystem::Si]
        .map(|system| parameter.map_or(system.of_modulus(), |p| system.of(p)));
    let same = |text: String| [text.clone(), text];
    let direction = row.direction.as_deref().map_or(String::new(), |d| format!(" {d}"));
    vec![
        same(row.fabric.clone()),
        same(format!("{}{direction}", row.parameter)),
        [kes.1, si.1].map(|factor| row.mean.map_or("-".into(), |mean| significant(mean / factor))),
        [kes.0, si.0].map(unit_text),
        same(row.n.to_string()),
        same(row.status.clone()),
    ]
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

    fn row(case: &str, quantity: &str, simulated: f64, measured: Option<f64>, unit: &str) -> PredictionRow {
        PredictionRow {
            case: case.into(),
            quantity: quantity.into(),
            simulated: Some(simulated),
            measured,
            unit: unit.into(),
            error: measured.map(|m| simulated / m - 1.0),
            ..PredictionRow::default()
        }
    }

    #[test]
    fn drape_leads_the_cantilever_and_plates_are_elsewhere() {
        let report = FabricReport {
            name: "poplin".into(),
            relative_deflections: vec![("seed_clamped".into(), 0.012)],
            predictions: vec![
                row("cantilever", "bending_length warp", 0.0212, None, "m"),
                row("seed_clamped", "w_max", 3.5e-7, None, "m"),
                row("drape", "drape_coefficient", 0.62, Some(0.5), "1"),
                row("virtual_bending", "B warp", 9.80665e-6, Some(9.80665e-6), "N·m"),
            ],
            ..FabricReport::default()
        };
        let reports = [report];
        let Some(Block::Table { header, rows, .. }) = leading(&reports) else { panic!("a table") };
        assert_eq!(
            header,
            ["fabric", "drape coefficient (%), drape", "bending length warp (mm), cantilever"]
        );
        assert_eq!(rows, [["poplin", "62.00 (measured 50.00)", "21.20"]]);
        let Some(Block::Table { header, rows, .. }) = plates(&reports) else { panic!("a table") };
        assert_eq!(
            (header, rows),
            (vec!["fabric".into(), "seed_clamped".into()], vec![vec!["poplin".into(), "0.01200".into()]])
        );
        let Some(Block::Units { rows, .. }) = tests(&reports[0]) else { panic!("a table") };
        assert_eq!(rows.len(), 1);
        // One gf·cm²/cm is 9.80665e-5 N·m.
        assert_eq!(rows[0][1], ["0.1000", "9.807e-6"]);
        assert_eq!(rows[0][5], ["gf·cm²/cm", "N·m"]);
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
        assert!(doubtful(&report([row("measured"), row("inferred")])).is_none());
        let Some(Block::Units { rows, .. }) = doubtful(&report([row("measured"), row("doubtful")])) else {
            panic!("a table")
        };
        assert_eq!(rows.len(), 1);
        assert_eq!(rows[0][2], ["0.5000", "5.000e-4"]);
    }
}
