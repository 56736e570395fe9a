//! The overview of a batch: one line a fabric.

use super::columns::Columns;
use super::fabric::FabricReport;
use super::sheet_text::mark;
use crate::case::Case;
use crate::characterise::{FabricSheet, Key};
use crate::instrument::{Direction, Parameter};
use crate::quantity::significant;

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
        format!("{}{}", significant(e.mean / parameter.kes_factor()), mark(sheet.status(key)))
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

/// One line a fabric, one column of deflections a case.
pub(crate) struct Overview<'c> {
    cases: Vec<&'c str>,
    table: Columns,
}

impl<'c> Overview<'c> {
    /// A table for these cases, yet without fabrics.
    pub fn new(cases: impl Iterator<Item = &'c Case>) -> Self {
        let cases: Vec<&str> =
            cases.filter(|c| c.sheet().is_some() && c.fabric().is_some()).map(|c| c.name.as_str()).collect();
        let deflections = cases.iter().map(|c| format!("w_max {c} (mm)"));
        let headings =
            HEADINGS.map(String::from).into_iter().chain(deflections).chain(["status".to_string()]);
        Self { table: Columns::new(headings), cases }
    }

    /// Adds a fabric.
    pub fn row(&mut self, report: &FabricReport) {
        let mut row = vec![report.name.clone()];
        row.extend(report.cells.iter().cloned());
        row.extend(self.cases.iter().map(|case| deflection(report, case)));
        row.push(report.status.clone());
        self.table.row(row);
    }

    /// The table.
    pub fn table(self) -> Columns {
        self.table.with_note(CAPTION)
    }
}

fn deflection(report: &FabricReport, case: &str) -> String {
    let found = report.deflections.iter().find(|(name, _)| name == case);
    found.map_or("-".into(), |(_, w)| significant(1e3 * w))
}
