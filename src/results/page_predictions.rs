//! Predictions of cases on the page: what a laboratory measures first, plates in a form without units after it.

use super::fabric::FabricReport;
use super::page_values::is_of_test;
use super::rests_on::remark;
use crate::quantity::significant;
use crate::report::html::{Block, TableCell};
use crate::report::number::{counted, unit_text};
use crate::report::table::PredictionRow;

/// Deflection over the bending thickness below which a linear solve is meaningful.
const MEANINGFUL: f64 = 0.3;

/// A column of what a laboratory measures.
#[derive(Clone, Debug, PartialEq)]
struct Column {
    case: String,
    quantity: String,
    /// Whether it is the measured value beside it.
    is_measured: bool,
}

/// The first columns of a table of fabrics.
const NAMED: [&str; 2] = ["fabric", "origin"];

/// The cells below [`NAMED`].
fn named(report: &FabricReport) -> [TableCell; 2] {
    [TableCell::from(&report.name), report.origin().unwrap_or("-").into()]
}

/// What speaks against a deflection, and against the bending thickness that it is divided by.
fn relative_remark(report: &FabricReport, case: &str) -> String {
    let of_deflection = found(report, case, "w_max").and_then(|row| row.remark.clone());
    let of_thickness = report.thickness_grounds.get(case).and_then(|grounds| remark(grounds));
    let of_thickness = of_thickness.map(|text| format!("{text}, by its bending thickness"));
    [of_deflection, of_thickness].into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// The row of the quantity of a case.
fn found<'r>(report: &'r FabricReport, case: &str, quantity: &str) -> Option<&'r PredictionRow> {
    report.predictions.iter().find(|row| row.case == case && row.quantity == quantity)
}

/// What the case is called.
fn title<'r>(reports: &'r [FabricReport], case: &'r str) -> &'r str {
    reports.iter().find_map(|r| r.cases.get(case)).map_or(case, |(title, _)| title)
}

fn is_drape(quantity: &str) -> bool {
    quantity == "drape_coefficient"
}

fn is_leading(row: &PredictionRow) -> bool {
    is_drape(&row.quantity) || row.quantity.starts_with("bending_length")
}

/// Whether the cloth has friction there.
fn has_friction(report: &FabricReport, row: &PredictionRow) -> bool {
    row.quantity.contains("_friction ") || report.cases.get(&row.case).is_some_and(|(_, friction)| *friction)
}

/// Drape and cantilever, one row a fabric: of elastic cloth, then of cloth with friction.
pub(super) fn leading(reports: &[FabricReport]) -> Vec<Block> {
    [false, true].into_iter().filter_map(|friction| leading_table(reports, friction)).collect()
}

fn leading_table(reports: &[FabricReport], friction: bool) -> Option<Block> {
    let mut columns: Vec<Column> = Vec::new();
    for report in reports {
        let mine = |row: &&PredictionRow| is_leading(row) && has_friction(report, row) == friction;
        for row in report.predictions.iter().filter(mine) {
            let simulated =
                Column { case: row.case.clone(), quantity: row.quantity.clone(), is_measured: false };
            let measured = Column { is_measured: true, ..simulated.clone() };
            let wanted = [Some(simulated), row.measured.map(|_| measured)];
            let new: Vec<Column> = wanted.into_iter().flatten().filter(|c| !columns.contains(c)).collect();
            columns.extend(new);
        }
    }
    if !friction && reports.iter().any(|report| report.measured_drape().is_some()) {
        add_measured_drape(&mut columns);
    }
    columns.sort_by(|a, b| {
        let key = |c: &Column| (!is_drape(&c.quantity), c.case.clone(), c.quantity.clone(), c.is_measured);
        key(a).cmp(&key(b))
    });
    let heading = |column: &Column| match column {
        Column { case, quantity, is_measured: true } if case.is_empty() => {
            format!("measured drape coefficient ({})", unit(quantity))
        }
        Column { quantity, is_measured: true, .. } => format!("measured ({})", unit(quantity)),
        Column { case, quantity, .. } => {
            let name = quantity.replace("_friction", "").replace('_', " ");
            format!("{name} ({}): {}", unit(quantity), title(reports, case))
        }
    };
    let line = |report: &FabricReport| {
        let cells = columns.iter().map(|column| leading_cell(report, column));
        named(report).into_iter().chain(cells).collect()
    };
    (!columns.is_empty()).then(|| Block::Table {
        caption: leading_caption(&columns, friction),
        header: NAMED.map(String::from).into_iter().chain(columns.iter().map(heading)).collect(),
        rows: reports.iter().map(line).collect(),
        of_fabrics: true,
    })
}

/// A column of measured drapes where there is none: what was measured is shown where nothing was simulated, too.
fn add_measured_drape(columns: &mut Vec<Column>) {
    if columns.iter().any(|column| is_drape(&column.quantity) && column.is_measured) {
        return;
    }
    let case = columns.iter().find(|c| is_drape(&c.quantity)).map_or(String::new(), |c| c.case.clone());
    columns.push(Column { case, quantity: "drape_coefficient".into(), is_measured: true });
}

/// Names only what the table has.
fn leading_caption(columns: &[Column], friction: bool) -> String {
    let has = |drape: bool| columns.iter().any(|c| is_drape(&c.quantity) == drape);
    let parts = [(has(true), "drape"), (has(false), "the bending length of the cantilever")];
    // A column of drapes that were measured and not simulated has no case.
    let is_simulated = columns.iter().any(|c| is_drape(&c.quantity) && !c.case.is_empty());
    let named: Vec<&str> = parts.into_iter().filter_map(|(has, name)| has.then_some(name)).collect();
    let subject = if friction {
        "What a laboratory measures, of cloth with friction"
    } else {
        "What a laboratory measures"
    };
    let mut caption = format!("{subject}: {}.", named.join(", and "));
    if is_simulated {
        caption += " A drape coefficient is that of the state of lowest energy; the least and the greatest of the \
                    states of nearly that energy stand in brackets, and then how many folds it has.";
    }
    if columns.iter().any(|c| c.is_measured) {
        caption += " The measured value stands beside the simulated one where there is one.";
    }
    caption
}

/// The unit in which a leading quantity is read.
fn unit(quantity: &str) -> &'static str {
    if is_drape(quantity) { "%" } else { "mm" }
}

/// The cell of a fabric that the case was not solved for: its measured drape all the same.
fn not_simulated(report: &FabricReport, column: &Column) -> TableCell {
    let Some(measured) = report.measured_drape().filter(|_| is_drape(&column.quantity)) else {
        return "-".into();
    };
    if column.is_measured { format!("{:.1}", 1e2 * measured).into() } else { "not simulated".into() }
}

fn leading_cell(report: &FabricReport, column: &Column) -> TableCell {
    let Some(row) = found(report, &column.case, &column.quantity) else {
        return not_simulated(report, column);
    };
    let text = |value: f64| {
        if is_drape(&row.quantity) { format!("{:.1}", 1e2 * value) } else { significant(1e3 * value) }
    };
    let row_of = |quantity: &str| found(report, &column.case, quantity);
    let folds = |value: Option<f64>| value.map_or(String::new(), |count| format!(", {count} folds"));
    let counted = row_of("drape_nodes").filter(|_| is_drape(&row.quantity));
    if column.is_measured {
        return match row.measured {
            Some(value) => format!("{}{}", text(value), folds(counted.and_then(|row| row.measured))).into(),
            None => "-".into(),
        };
    }
    let Some(value) = row.simulated else { return "-".into() };
    let [least, greatest] = ["drape_coefficient_least", "drape_coefficient_greatest"]
        .map(|quantity| row_of(quantity).filter(|_| is_drape(&row.quantity)).and_then(|row| row.simulated));
    let band = least.zip(greatest).map_or(String::new(), |(a, b)| format!(" ({}–{})", text(a), text(b)));
    TableCell {
        text: format!("{}{band}{}", text(value), folds(counted.and_then(|row| row.simulated))),
        remark: row.remark.clone().unwrap_or_default(),
        ..TableCell::default()
    }
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
        let cell = |case: &&str| {
            let deflection = report.relative_deflections.iter().find(|(name, _)| name == case);
            deflection.map_or("-".into(), |(_, value)| TableCell {
                text: significant(*value),
                remark: relative_remark(report, case),
                ..TableCell::default()
            })
        };
        named(report).into_iter().chain(cases.iter().map(cell)).collect()
    };
    (!cases.is_empty()).then(|| Block::Table {
        caption: plates_caption(reports, &cases),
        header: NAMED
            .into_iter()
            .chain(cases.iter().map(|case| title(reports, case)))
            .map(String::from)
            .collect(),
        rows: reports.iter().map(line).collect(),
        of_fabrics: true,
    })
}

/// That a linear solve cannot hold for cloth is said once, with the count of each case.
fn plates_caption(reports: &[FabricReport], cases: &[&str]) -> String {
    let mut caption = format!(
        "Linear solves, normalised: largest deflection over the bending thickness √(12 B / D_m). A linear solve is \
         meaningful below {MEANINGFUL}; above, the number says how stiff a sheet is, not what shape it takes."
    );
    let beyond: Vec<String> = cases
        .iter()
        .filter_map(|case| {
            let of_case =
                || reports.iter().flat_map(|r| &r.relative_deflections).filter(|(name, _)| name == case);
            let beyond = of_case().filter(|(_, value)| value.abs() > MEANINGFUL).count();
            let title = title(reports, case);
            (beyond > 0).then(|| format!("{beyond} of {} in “{title}”", counted(of_case().count(), "fabric")))
        })
        .collect();
    if !beyond.is_empty() {
        caption += &format!(" Above it: {}.", beyond.join(", "));
    }
    caption
}

/// What the other tables have no place for: vibrations, buckling, motions, steps, and sheets in their plane.
pub(super) fn others(report: &FabricReport) -> Option<Block> {
    let rows: Vec<Vec<TableCell>> =
        report.predictions.iter().filter(|row| is_other(report, row)).map(other_row).collect();
    (!rows.is_empty()).then(|| Block::Table {
        caption: "Other predictions: vibrations, buckling, motions, steps, and sheets in their plane.".into(),
        header: ["quantity", "simulated", "95 % band", "measured", "unit", "case", "remark"]
            .map(String::from)
            .to_vec(),
        rows,
        of_fabrics: false,
    })
}

/// Whether the row is of no test, of no linear plate, and of no case of which a leading table shows something.
fn is_other(report: &FabricReport, row: &PredictionRow) -> bool {
    !is_of_test(row)
        && report.relative_deflections.iter().all(|(case, _)| *case != row.case)
        && report.predictions.iter().all(|other| other.case != row.case || !is_leading(other))
}

fn other_row(row: &PredictionRow) -> Vec<TableCell> {
    let (unit, factor) = match row.unit.as_str() {
        "m" => ("mm", 1e3),
        "1/s" => ("Hz", 1.0),
        unit => (unit, 1.0),
    };
    let [simulated, low, high, measured] =
        [row.simulated, row.simulated_low, row.simulated_high, row.measured].map(|v| scaled(v, factor));
    let has_band = row.simulated_low.is_some() && row.simulated_high.is_some();
    [
        row.quantity.clone(),
        simulated,
        if has_band { format!("{low} to {high}") } else { "-".into() },
        measured,
        unit_text(unit),
        row.case.clone(),
        row.remark.clone().unwrap_or_default(),
    ]
    .map(TableCell::from)
    .to_vec()
}

/// A value in another unit.
fn scaled(value: Option<f64>, factor: f64) -> String {
    value.map_or("-".into(), |value| significant(factor * value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::{FabricInfo, MeasuredResult};

    fn row(case: &str, quantity: &str, simulated: f64, measured: Option<f64>) -> PredictionRow {
        PredictionRow {
            case: case.into(),
            quantity: quantity.into(),
            simulated: Some(simulated),
            measured,
            ..PredictionRow::default()
        }
    }

    fn table(block: Option<Block>) -> (String, Vec<String>, Vec<Vec<TableCell>>) {
        let Some(Block::Table { caption, header, rows, .. }) = block else { panic!("a table") };
        (caption, header, rows)
    }

    #[test]
    fn a_drape_is_one_cell_with_the_measured_value_beside_it() {
        let cases = [("drape", "Drape", false), ("drape_friction", "Drape with friction", true)];
        let report = FabricReport {
            name: "poplin".into(),
            cases: cases.map(|(name, title, friction)| (name.into(), (title.into(), friction))).into(),
            predictions: vec![
                row("cantilever", "bending_length warp", 0.0212, None),
                row("cantilever", "bending_length_friction warp", 0.0234, None),
                row("seed_clamped", "w_max", 3.5e-7, None),
                PredictionRow {
                    remark: Some("quick, 1260 elements".into()),
                    ..row("drape", "drape_coefficient", 0.647, Some(0.5))
                },
                row("drape", "drape_coefficient_least", 0.622, None),
                row("drape", "drape_coefficient_greatest", 0.674, None),
                row("drape", "drape_nodes", 7.0, Some(6.0)),
                row("drape_friction", "drape_coefficient", 0.7, None),
                row("virtual_bending", "B warp", 9.80665e-6, Some(9.80665e-6)),
            ],
            ..FabricReport::default()
        };
        let blocks = leading(std::slice::from_ref(&report));
        assert_eq!(blocks.len(), 2);
        let mut blocks = blocks.into_iter();
        let (caption, header, rows) = table(blocks.next());
        let expected = [
            "fabric",
            "origin",
            "drape coefficient (%): Drape",
            "measured (%)",
            "bending length warp (mm): cantilever",
        ];
        assert_eq!(header, expected);
        let cells = ["poplin", "-", "64.7 (62.2–67.4), 7 folds", "50.0, 6 folds", "21.20"];
        let mut expected = cells.map(TableCell::from);
        expected[2].remark = "quick, 1260 elements".into();
        assert_eq!(rows, [expected]);
        assert!(caption.contains("drape, and the bending length") && caption.contains("folds"), "{caption}");
        let (caption, header, rows) = table(blocks.next());
        let expected = [
            "fabric",
            "origin",
            "drape coefficient (%): Drape with friction",
            "bending length warp (mm): cantilever",
        ];
        assert_eq!(header, expected);
        assert_eq!(rows, [["poplin", "-", "70.0", "23.40"].map(TableCell::from)]);
        assert!(caption.contains("friction") && !caption.contains("measured value"), "{caption}");
    }

    #[test]
    fn a_drape_that_was_measured_is_shown_where_none_was_simulated() {
        let stated = MeasuredResult {
            quantity: "drape_coefficient".into(),
            value: "82.9 %".into(),
            method: String::new(),
            direction: None,
        };
        let info = FabricInfo { results: vec![stated], ..FabricInfo::default() };
        let measured = FabricReport { info: Some(info), ..FabricReport::default() };
        let simulated = FabricReport {
            predictions: vec![row("drape", "drape_coefficient", 0.647, None)],
            ..FabricReport::default()
        };
        let (_, header, rows) = table(leading(&[measured.clone(), simulated]).into_iter().next());
        assert_eq!(header[3], "measured (%)");
        assert_eq!([&rows[0][2].text, &rows[0][3].text, &rows[1][3].text], ["not simulated", "82.9", "-"]);
        assert_eq!([&rows[0][1].text, &rows[1][1].text], ["measured", "-"]);
        let (_, header, rows) = table(leading(&[measured]).into_iter().next());
        assert_eq!(
            (header[2].as_str(), rows[0][2].text.as_str()),
            ("measured drape coefficient (%)", "82.9")
        );
    }

    #[test]
    fn without_a_drape_nothing_says_drape() {
        let predictions = vec![row("cantilever", "bending_length warp", 0.0212, None)];
        let report = FabricReport { predictions, ..FabricReport::default() };
        let (caption, header, _) = table(leading(&[report]).into_iter().next());
        assert!(!caption.contains("drape") && !header.concat().contains("drape"), "{caption}");
    }

    #[test]
    fn what_no_other_table_has_is_listed() {
        let frequency = PredictionRow { unit: "1/s".into(), ..row("modes", "frequency_1", 4.25, None) };
        let stretched = PredictionRow {
            simulated_low: Some(1e-3),
            simulated_high: Some(3e-3),
            unit: "m".into(),
            remark: Some("rests on an assumed W".into()),
            ..row("pull", "in_plane_max", 2e-3, None)
        };
        let report = FabricReport {
            relative_deflections: vec![("own".into(), 3.0)],
            predictions: vec![
                row("own", "w_max", 1e-3, None),
                row("drape", "drape_coefficient", 0.6, None),
                row("drape", "drape_nodes", 7.0, None),
                row("virtual_bending", "B warp", 9.8e-6, None),
                frequency,
                stretched,
            ],
            ..FabricReport::default()
        };
        let (_, _, rows) = table(others(&report));
        let expected = [
            ["frequency_1", "4.250", "-", "-", "Hz", "modes", ""],
            ["in_plane_max", "2.000", "1.000 to 3.000", "-", "mm", "pull", "rests on an assumed W"],
        ];
        assert_eq!(rows, expected.map(|line| line.map(TableCell::from).to_vec()));
        assert_eq!(others(&FabricReport::default()), None);
    }

    /// That a linear solve is beyond its meaning is said once; what speaks against one fabric stands beside its value.
    #[test]
    fn only_another_cause_marks_a_plate() {
        let resting = |row: PredictionRow, on: &str| PredictionRow {
            remark: Some(on.to_string()).filter(|on| !on.is_empty()),
            ..row
        };
        let report = |name: &str, on: &str, value: f64| FabricReport {
            name: name.into(),
            cases: [("own".to_string(), ("Own weight".to_string(), false))].into(),
            relative_deflections: vec![("own".into(), value)],
            predictions: vec![
                resting(row("cantilever", "bending_length warp", 0.0212, None), on),
                resting(row("own", "w_max", 1e-3, None), on),
            ],
            ..FabricReport::default()
        };
        let reports =
            [report("a", "rests on a doubtful B", 710.0), report("b", "", -45.0), report("c", "", 0.01)];
        let (caption, header, rows) = table(plates(&reports));
        assert_eq!(header, ["fabric", "origin", "Own weight"]);
        assert!(caption.ends_with("Above it: 2 of 3 fabrics in “Own weight”."), "{caption}");
        let remarks: Vec<&str> = rows.iter().map(|row| row[2].remark.as_str()).collect();
        assert_eq!(remarks, ["rests on a doubtful B", "", ""]);
        let (_, _, rows) = table(leading(&reports).into_iter().next());
        assert_eq!(rows[0][2].remark, "rests on a doubtful B");
    }

    /// The bending thickness is of the tensile stiffness, which a deflection by weight does not show.
    #[test]
    fn a_relative_deflection_rests_on_its_thickness_too() {
        let input = crate::constitutive::MeasuredInput {
            name: "E".into(),
            estimate: crate::quantity::Estimate::stand_in(2e4),
            status: crate::characterise::ValueStatus::Assumed,
            source: crate::constitutive::InputSource::Document,
            derivative: Default::default(),
        };
        let report = FabricReport {
            relative_deflections: vec![("own".into(), 20.0)],
            thickness_grounds: [("own".into(), super::super::rests_on::of_symbols(&[input], &["E"]))].into(),
            predictions: vec![row("own", "w_max", 1e-3, None)],
            ..FabricReport::default()
        };
        assert_eq!(relative_remark(&report, "own"), "rests on an assumed E, by its bending thickness");
        assert_eq!(relative_remark(&report, "other"), "");
    }
}
