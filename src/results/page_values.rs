//! Predictions on the page: what a laboratory measures first, plates in a form without units, tests beside measured
//! values.

use std::collections::BTreeMap;

use super::fabric::FabricReport;
use super::rests_on::{DOUBTFUL, OF_PLATE, remark};
use crate::instrument::Parameter;
use crate::quantity::significant;
use crate::report::html::{Block, Cell, DoubtfulValue};
use crate::report::number::{self, concise, unit_text};
use crate::report::table::{FabricRow, PredictionRow, UnitSystem};

/// Above the table of what a laboratory measures.
const LEADING: &str = "What a laboratory measures: drape, and the bending length of the cantilever; the measured value \
                       stands beside the simulated one where there is one.";

/// Above the table of plates.
const PLATES: &str = "Linear solves, normalised: largest deflection over the bending thickness √(12 B / D_m). A linear \
                      solve is meaningful below 0.3; above, the number says how stiff a sheet is, not what shape it takes.";

/// Deflection over the bending thickness below which a linear solve is meaningful.
const MEANINGFUL: f64 = 0.3;

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
        let cell = |row: &PredictionRow| Cell { text: shown(row), remark: rests_on(report, &row.quantity) };
        let of: BTreeMap<_, _> = rows(report).iter().map(|row| (key(row), cell(row))).collect();
        let cells = columns.iter().map(|(key, _)| of.get(key).cloned().unwrap_or("-".into()));
        std::iter::once(Cell::from(&report.name)).chain(cells).collect()
    };
    (!columns.is_empty()).then(|| Block::Table {
        caption: LEADING.into(),
        header: std::iter::once("fabric".to_string()).chain(header).collect(),
        rows: reports.iter().map(line).collect(),
        of_fabrics: true,
    })
}

/// `rests on a doubtful B warp`; nothing where there is nothing to say.
fn rests_on(report: &FabricReport, quantity: &str) -> String {
    let remark = remark(&report.rows, &report.findings, quantity);
    if remark.is_empty() { remark } else { format!("rests on {remark}") }
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
            found.map_or("-".into(), |(_, value)| plate(report, *value))
        };
        std::iter::once(Cell::from(&report.name)).chain(cases.iter().map(of)).collect()
    };
    (!cases.is_empty()).then(|| Block::Table {
        caption: PLATES.into(),
        header: std::iter::once("fabric").chain(cases.iter().copied()).map(String::from).collect(),
        rows: reports.iter().map(line).collect(),
        of_fabrics: true,
    })
}

/// A deflection over the bending thickness, with what speaks against it.
fn plate(report: &FabricReport, value: f64) -> Cell {
    let beyond = (value.abs() > MEANINGFUL).then(|| format!("above {MEANINGFUL}"));
    let resting = Some(rests_on(report, OF_PLATE)).filter(|text| !text.is_empty());
    let remarks: Vec<String> = beyond.into_iter().chain(resting).collect();
    Cell { text: significant(value), remark: remarks.join("; ") }
}

/// Measured against simulated, every KES test of the fabric.
pub(super) fn tests(report: &FabricReport) -> Option<Block> {
    let rows: Vec<Vec<[String; 2]>> =
        report.predictions.iter().filter(|row| is_of_test(row)).map(|row| test_row(report, row)).collect();
    (!rows.is_empty()).then(|| Block::Units {
        caption: "Measured against simulated. The section is made of the measured stiffness, so agreement there shows \
                  that the simulated test reads it back; a difference is of clamps, edges and friction."
            .into(),
        header: ["quantity", "measured", "simulated", "difference", "95 % band", "unit", "case", "remark"]
            .map(String::from)
            .to_vec(),
        rows,
    })
}

fn test_row(report: &FabricReport, row: &PredictionRow) -> Vec<[String; 2]> {
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
        same(test_remark(report, row)),
    ]
}

/// What a measured value is of, and what a simulated one rests on.
fn test_remark(report: &FabricReport, row: &PredictionRow) -> String {
    let (symbol, direction) = row.quantity.split_once(' ').unwrap_or((&row.quantity, ""));
    let has = |along: Option<&str>| {
        report.rows.iter().any(|r| r.parameter == symbol && r.direction.as_deref() == along)
    };
    let is_of_both = row.measured.is_some() && has(None) && !has(Some(direction)) && !direction.is_empty();
    let both = is_of_both.then(|| "measured for warp and weft together".to_string());
    let resting = Some(rests_on(report, &row.quantity)).filter(|text| !text.is_empty());
    both.into_iter().chain(resting).collect::<Vec<_>>().join("; ")
}

/// Values that a finding speaks against, then those that rest on an assumption; `page` is that of the problems, empty for
/// the page itself.
pub(super) fn doubtful(reports: &[FabricReport], page: &str) -> Option<Block> {
    let of = |status: &'static str| {
        reports.iter().flat_map(move |report| {
            let rows = report.rows.iter().enumerate().filter(move |(_, row)| row.status == status);
            rows.map(move |(at, row)| DoubtfulValue {
                causes: report.causes.get(&at).cloned().unwrap_or_default(),
                page: page.into(),
                ..doubtful_value(row)
            })
        })
    };
    let values: Vec<DoubtfulValue> = of(DOUBTFUL).chain(of("assumed")).collect();
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
        assert_eq!(rows, [["poplin", "62.00 (measured 50.00)", "21.20"].map(Cell::from)]);
        let Some(Block::Table { header, rows, .. }) = plates(&reports) else { panic!("a table") };
        assert_eq!(
            (header, rows),
            (
                vec!["fabric".into(), "seed_clamped".into()],
                vec![["poplin", "0.01200"].map(Cell::from).to_vec()]
            )
        );
        let Some(Block::Units { rows, .. }) = tests(&reports[0]) else { panic!("a table") };
        assert_eq!(rows.len(), 1);
        // One gf·cm²/cm is 9.80665e-5 N·m.
        assert_eq!(rows[0][1], ["0.1", "9.807 × 10⁻⁶"]);
        assert_eq!(rows[0][5], ["gf·cm²/cm", "N·m"]);
    }

    /// A linear solve beyond its meaning, a doubtful input and a value of the fabric as a whole are marked where they stand.
    #[test]
    fn what_speaks_against_a_prediction_stands_beside_it() {
        let b = FabricRow { parameter: "B".into(), status: DOUBTFUL.into(), ..FabricRow::default() };
        let report = FabricReport {
            rows: vec![b],
            relative_deflections: vec![("self_weight".into(), 710.0)],
            predictions: vec![
                row("cantilever", "bending_length warp", 0.0212, None, "m"),
                row("virtual_bending", "B warp", 9.8e-6, Some(9.8e-6), "N·m"),
            ],
            ..FabricReport::default()
        };
        let reports = [report];
        let Some(Block::Table { rows, .. }) = leading(&reports) else { panic!("a table") };
        assert_eq!(rows[0][1].remark, "rests on a doubtful B");
        let Some(Block::Table { rows, .. }) = plates(&reports) else { panic!("a table") };
        assert_eq!(rows[0][1].remark, "above 0.3; rests on a doubtful B");
        let Some(Block::Units { rows, .. }) = tests(&reports[0]) else { panic!("a table") };
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
