//! The overview of a batch: one line a fabric.

use std::collections::{BTreeMap, BTreeSet};

use super::bent;
use super::columns::Columns;
use super::fabric::FabricReport;
use super::judged::of_inputs;
use super::page_problems::BEYOND_LINEAR;
use super::rests_on::status;
use super::sheet_text::{BOTH, BOTH_LEGEND, mark};
use crate::case::{Analysis, Case, Problem};
use crate::characterise::{FabricSheet, Key, ValueStatus};
use crate::finding::Place;
use crate::instrument::{Direction, Parameter};
use crate::quantity::significant;
use crate::report::number::counted;
use crate::report::table::PredictionRow;
use crate::study::IN_PLANE;

/// Headings before the deflections, in KES units.
pub(super) const HEADINGS: [&str; 9] = [
    "fabric",
    "B warp",
    "B weft",
    "G warp",
    "G weft",
    "E warp (N/m)",
    "E weft (N/m)",
    "T (mm)",
    "W (mg/cm²)",
];

/// Units of the columns that do not name theirs.
pub(super) const CAPTION: &str = "B in gf·cm²/cm, G in gf/(cm·deg); E is the tangent at low load, or the secant where that is written; ? is doubtful, * rests on an assumption, ~ is inferred";

/// What the columns of predictions are.
const PREDICTIONS: &str = "drape coefficients in %, bending lengths of cantilevers in mm, largest deflections in mm or over the bending thickness t_b (a linear solve means something below 0.3), lowest frequencies in Hz, load factors of buckling; ?, * and ~ behind a prediction are of what it rests on";

/// B, G, E, T, W: KES units, except E in N/m.
pub(super) fn cells(sheet: &FabricSheet) -> Vec<String> {
    let (warp, weft) = (Direction::Warp, Direction::Weft);
    vec![
        parameter(sheet, Parameter::B, Some(warp)),
        parameter(sheet, Parameter::B, Some(weft)),
        parameter(sheet, Parameter::G, Some(warp)),
        parameter(sheet, Parameter::G, Some(weft)),
        modulus(sheet, warp),
        modulus(sheet, weft),
        parameter(sheet, Parameter::T0, None),
        parameter(sheet, Parameter::W, None),
    ]
}

fn parameter(sheet: &FabricSheet, parameter: Parameter, direction: Option<Direction>) -> String {
    let keys = [direction, None].map(|direction| Key { parameter, direction });
    let found = keys.into_iter().find_map(|key| Some((key, sheet.values.get(&key)?)));
    found.map_or("-".into(), |(key, e)| {
        let both = if key.direction == direction { "" } else { BOTH };
        format!("{}{both}{}", significant(e.mean / parameter.kes_factor()), mark(sheet.status(key)))
    })
}

/// The tangent at low load; where only a table is known the secant, and it says so.
fn modulus(sheet: &FabricSheet, direction: Direction) -> String {
    let found = [("tangent_low", ""), ("secant", " secant")].into_iter().find_map(|(name, kind)| {
        let mean = sheet.moduli.get(&(name.to_string(), direction))?.mean;
        Some(format!("{}{kind}{}", significant(mean), mark(sheet.modulus_status(name, direction))))
    });
    found.unwrap_or("-".into())
}

/// A column of predictions.
enum Prediction<'c> {
    /// The coefficient of a drape, and whether it is a quick one.
    Drape(&'c str, bool),
    /// A length that a bending test has along a direction, by its quantity.
    Length(&'c str, &'static str, Direction),
    /// Largest deflection over the bending thickness: what a linear solve can say of any cloth.
    Relative(&'c str),
    /// Largest deflection.
    Deflection(&'c str),
    /// The lowest frequency.
    Frequency(&'c str),
    /// The load factor of buckling nearest to zero.
    LoadFactor(&'c str),
}

impl<'c> Prediction<'c> {
    /// Columns of a case.
    fn of(case: &'c Case) -> Vec<Self> {
        if case.fabric().is_none() {
            return Vec::new();
        }
        let name = case.name.as_str();
        match &case.problem {
            Problem::Drape(_) => vec![Self::Drape(name, case.is_quick())],
            Problem::BendingTest(test) => {
                let along = |quantity| {
                    [Direction::Warp, Direction::Weft]
                        .map(|direction| Self::Length(name, quantity, direction))
                };
                bent::shown_length(test).into_iter().flat_map(along).collect()
            }
            Problem::Sheet(sheet) => vec![match sheet.analysis {
                Analysis::Linear(_) => Self::Relative(name),
                Analysis::Modal(_) => Self::Frequency(name),
                Analysis::Buckling(_) => Self::LoadFactor(name),
                Analysis::Newmark(_) | Analysis::Nonlinear(_) | Analysis::Steps(_) => Self::Deflection(name),
            }],
            Problem::InstrumentTest(_) => Vec::new(),
        }
    }

    /// What a laboratory measures stands before what it does not.
    fn rank(&self) -> u8 {
        match self {
            Self::Drape(..) => 0,
            Self::Length(..) => 1,
            Self::Relative(_) | Self::Deflection(_) | Self::Frequency(_) | Self::LoadFactor(_) => 2,
        }
    }

    fn heading(&self) -> String {
        match self {
            Self::Drape(case, false) => format!("{case} (%)"),
            Self::Drape(case, true) => format!("{case}, quick (%)"),
            Self::Length(case, _, direction) => format!("{case} {direction} (mm)"),
            Self::Relative(case) => format!("{case} (w/t_b)"),
            Self::Deflection(case) => format!("w_max {case} (mm)"),
            Self::Frequency(case) => format!("frequency_1 {case} (Hz)"),
            Self::LoadFactor(case) => format!("load_factor_1 {case}"),
        }
    }

    fn cell(&self, report: &FabricReport) -> String {
        let of_case = |list: &[(String, f64)], case: &str| {
            list.iter().find(|(name, _)| name == case).map(|(_, value)| *value)
        };
        let predicted = |case: &str, quantity: &str| predicted(report, case, quantity)?.simulated;
        let value = match self {
            Self::Drape(case, _) => predicted(case, "drape_coefficient").map(|part| 1e2 * part),
            Self::Length(case, quantity, direction) => {
                predicted(case, &format!("{quantity} {direction}")).map(|length| 1e3 * length)
            }
            Self::Relative(case) => of_case(&report.relative_deflections, case),
            Self::Deflection(case) => of_case(&report.deflections, case).map(|w| 1e3 * w),
            Self::Frequency(case) | Self::LoadFactor(case) => of_case(&report.eigenvalues, case),
        };
        let in_plane = match self {
            Self::Relative(case) | Self::Deflection(case) => predicted(case, IN_PLANE),
            _ => None,
        };
        match (value, self, report.measured_drape()) {
            (None, _, _) if in_plane.is_some() => {
                let within = in_plane.map_or("-".into(), |u| significant(1e3 * u));
                format!("{within} mm in plane{}", self.row(report).map(doubt).unwrap_or_default())
            }
            (None, Self::Drape(..), Some(measured)) => {
                format!("- ({} measured)", significant(1e2 * measured))
            }
            (value, ..) => value.map_or("-".into(), |value| {
                let of_deflection = self.row(report).map(of_inputs).unwrap_or_default();
                significant(value) + &mark(of_deflection.max(self.of_thickness(report)))
            }),
        }
    }

    /// What speaks against the bending thickness that the value is divided by.
    fn of_thickness(&self, report: &FabricReport) -> ValueStatus {
        match self {
            Self::Relative(case) => {
                report.thickness_grounds.get(*case).map(|grounds| status(grounds)).unwrap_or_default()
            }
            _ => ValueStatus::default(),
        }
    }

    /// The row that says what speaks against the value: of a sheet its first, as all of them rest on the same.
    fn row<'r>(&self, report: &'r FabricReport) -> Option<&'r PredictionRow> {
        match self {
            Self::Drape(case, _) => predicted(report, case, "drape_coefficient"),
            Self::Length(case, quantity, direction) => {
                predicted(report, case, &format!("{quantity} {direction}"))
            }
            Self::Relative(case)
            | Self::Deflection(case)
            | Self::Frequency(case)
            | Self::LoadFactor(case) => report.predictions.iter().find(|row| row.case == *case),
        }
    }
}

/// The row of what a case predicts.
fn predicted<'r>(report: &'r FabricReport, case: &str, quantity: &str) -> Option<&'r PredictionRow> {
    report.predictions.iter().find(|row| row.case == case && row.quantity == quantity)
}

/// The mark of a prediction whose inputs something speaks against, as parameters have it.
fn doubt(row: &PredictionRow) -> String {
    mark(of_inputs(row))
}

/// One line a fabric, with columns of what its cases predict.
pub(crate) struct Overview<'c> {
    predictions: Vec<Prediction<'c>>,
    table: Columns,
    /// Cases whose linear solve means nothing of a shape, and for how many fabrics.
    beyond: BTreeMap<String, usize>,
    /// Whether one value stands in the place of two.
    has_both: bool,
}

impl<'c> Overview<'c> {
    /// A table for these cases, yet without fabrics.
    pub fn new(cases: impl Iterator<Item = &'c Case>) -> Self {
        let mut predictions: Vec<Prediction> = cases.flat_map(Prediction::of).collect();
        predictions.sort_by_key(Prediction::rank);
        let predicted = predictions.iter().map(Prediction::heading);
        let headings = HEADINGS.map(String::from).into_iter().chain(predicted).chain(["status".to_string()]);
        Self { table: Columns::new(headings), predictions, beyond: BTreeMap::new(), has_both: false }
    }

    /// Adds a fabric.
    pub fn row(&mut self, report: &FabricReport) {
        let mut row = vec![report.shown_name()];
        row.extend(report.cells.iter().cloned());
        self.has_both |= report.cells.iter().any(|cell| cell.contains(BOTH));
        row.extend(self.predictions.iter().map(|prediction| prediction.cell(report)));
        row.push(report.status.clone());
        self.table.row(row);
        let beyond = report.findings.iter().filter(|finding| finding.code() == BEYOND_LINEAR);
        let cases: BTreeSet<String> = beyond.filter_map(|f| Some(stem(f.place.as_ref()?))).collect();
        cases.into_iter().for_each(|case| *self.beyond.entry(case).or_default() += 1);
    }

    /// Adds a fabric of which nothing could be read; the code says why.
    pub fn unread(&mut self, fabric: &str, code: &str) {
        let values = HEADINGS.len() - 1 + self.predictions.len();
        let nothing = std::iter::repeat_n("-".to_string(), values);
        self.table.row(std::iter::once(fabric.to_string()).chain(nothing).chain([code.to_string()]));
    }

    /// The table.
    pub fn table(self) -> Columns {
        let mut caption =
            if self.predictions.is_empty() { CAPTION.into() } else { format!("{CAPTION}; {PREDICTIONS}") };
        if self.has_both {
            caption += &format!("; {BOTH_LEGEND}");
        }
        if !self.beyond.is_empty() {
            let named: Vec<String> = self
                .beyond
                .iter()
                .map(|(case, fabrics)| format!("{case} of {}", counted(*fabrics, "fabric")))
                .collect();
            caption += &format!("\nbeyond linear (S101), a stiffness and no shape: {}", named.join(", "));
        }
        self.table.with_note(&caption)
    }
}

/// The name of the case that a finding is about.
pub(super) fn stem(place: &Place) -> String {
    place.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::finding::{Excess, Fact, Finding, StudyFact};
    use crate::quantity::Estimate;

    fn case(file: &str) -> Case {
        Case::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(file)).unwrap()
    }

    #[test]
    fn what_a_laboratory_measures_stands_first() {
        let cases = ["seed_clamped.toml", "cantilever.toml", "drape.toml", "virtual_shear.toml"].map(case);
        let mut overview = Overview::new(cases.iter());
        let row = |case: &str, quantity: &str, simulated: f64| PredictionRow {
            case: case.into(),
            quantity: quantity.into(),
            simulated: Some(simulated),
            ..PredictionRow::default()
        };
        overview.row(&FabricReport {
            name: "poplin".into(),
            cells: vec!["-".into(); HEADINGS.len() - 1],
            predictions: vec![
                PredictionRow { inputs: Some("doubtful".into()), ..row("drape", "drape_coefficient", 0.5) },
                row("cantilever", "bending_length warp", 0.02),
            ],
            relative_deflections: vec![("seed_clamped".into(), 1e-5)],
            status: "ok".into(),
            ..FabricReport::default()
        });
        let text = overview.table().text();
        let head = text.lines().next().unwrap();
        let order = [
            "W (mg/cm²)",
            "drape (%)",
            "cantilever warp (mm)",
            "cantilever weft (mm)",
            "seed_clamped (w/t_b)",
            "status",
        ];
        let places: Vec<usize> = order.iter().map(|name| head.find(name).unwrap()).collect();
        assert!(places.is_sorted(), "{text}");
        let values: Vec<&str> = text.lines().nth(1).unwrap().split_whitespace().rev().take(6).collect();
        assert_eq!(values, ["ok", "1.000e-5", "-", "20.00", "?", "50.00"], "{text}");
    }

    #[test]
    fn one_value_for_the_fabric_is_marked_and_a_fabric_that_is_lost_has_a_row() {
        let mut sheet = FabricSheet::default();
        let key = Key { parameter: Parameter::B, direction: None };
        sheet.values.insert(key, Estimate::single(1.0));
        let cells = cells(&sheet);
        assert!(cells[0].ends_with(BOTH) && cells[1].ends_with(BOTH), "{cells:?}");
        let mut overview = Overview::new(std::iter::empty());
        overview.row(&FabricReport {
            name: "a".into(),
            cells,
            status: "ok".into(),
            ..FabricReport::default()
        });
        overview.unread("lost", "R101");
        let text = overview.table().text();
        assert!(text.contains(BOTH_LEGEND), "{text}");
        let lost = text.lines().find(|line| line.starts_with("lost")).unwrap();
        assert!(lost.ends_with("R101"), "{text}");
    }

    /// A linear solve that cannot hold for cloth says so once, not once a fabric.
    #[test]
    fn what_is_beyond_linear_is_told_once() {
        let beyond = Fact::Study(StudyFact::BeyondLinear {
            excess: Excess::Deflection,
            value: 0.65,
            ratio: 4.6e3,
            limit: 0.3,
            in_time: false,
        });
        let report = |name: &str| FabricReport {
            name: name.into(),
            status: "ok".into(),
            findings: vec![Finding::new(beyond.clone()).at(Place::file("cases/strip.toml"))],
            ..FabricReport::default()
        };
        let mut overview = Overview::new(std::iter::empty());
        ["a", "b"].iter().for_each(|name| overview.row(&report(name)));
        let text = overview.table().text();
        assert_eq!(text.matches("beyond linear").count(), 1, "{text}");
        assert!(text.ends_with("a stiffness and no shape: strip of 2 fabrics\n"), "{text}");
    }
}
