//! Parameter sheets as text.

use std::collections::BTreeSet;

use super::columns::Columns;
use super::friction;
use crate::characterise::{FabricSheet, Settings};
use crate::instrument::{Direction, Parameter};
use crate::quantity::{Estimate, significant};
use crate::report::table::{UnitSystem, fabric_rows};

/// One line a parameter: `mean ± SD (n)` in each direction.
pub fn parameters_text(sheet: &FabricSheet, units: UnitSystem) -> String {
    let mut columns = Columns::new(["", "warp", "weft", "bias", "fabric", "unit"]);
    let directions = Direction::ALL.map(Some).into_iter().chain([None]);
    for &parameter in Parameter::ALL {
        let (unit, factor) = units.of(parameter);
        let cells: Vec<String> = directions
            .clone()
            .map(|d| sheet.get(parameter, d).map(|e| estimate(e, factor)).unwrap_or_default())
            .collect();
        if cells.iter().any(|c| !c.is_empty()) {
            columns.row([vec![parameter.symbol().to_string()], cells, vec![unit.to_string()]].concat());
        }
    }
    let (unit, factor) = units.of_modulus();
    for name in modulus_names(sheet) {
        let modulus = |d| sheet.moduli.get(&(name.clone(), d));
        let cells =
            Direction::ALL.map(|d| modulus(d).map(|e| estimate(e, factor)).unwrap_or_default()).to_vec();
        columns.row([vec![format!("E {name}")], cells, vec![String::new(), unit.to_string()]].concat());
    }
    let head = format!("{} ({}), mean ± SD (n)", sheet.name, sheet.info.origin.name());
    format!("{head}\n{}{}", columns.text(), friction::text(sheet, units))
}

fn modulus_names(sheet: &FabricSheet) -> BTreeSet<&String> {
    sheet.moduli.keys().map(|(name, _)| name).collect()
}

/// One line a value with all of its statistics (`-v`).
pub fn statistics_text(sheet: &FabricSheet, units: UnitSystem) -> String {
    let mut columns =
        Columns::new(["", "direction", "mean", "SD", "CV %", "95 % interval of the mean", "n", "unit"]);
    let number = |value: Option<f64>| value.map(significant).unwrap_or_default();
    for row in fabric_rows(sheet, units) {
        let ends = row.mean.zip(row.ci95).map(|(mean, half)| [mean - half, mean + half].map(significant));
        columns.row([
            row.parameter,
            row.direction.unwrap_or_default(),
            number(row.mean),
            number(row.sd),
            number(row.cv.map(|cv| 100.0 * cv)),
            ends.map(|[low, high]| format!("{low} to {high}")).unwrap_or_default(),
            row.n.to_string(),
            row.unit,
        ]);
    }
    format!("{} ({})\n{}", sheet.name, sheet.info.origin.name(), columns.text())
}

/// Windows and readings behind the values.
pub fn evaluation_text(settings: &Settings) -> String {
    let lines = settings.describe().into_iter().map(|(name, value)| format!("  {name}: {value}\n"));
    format!("evaluated with\n{}", lines.collect::<String>())
}

fn estimate(e: &Estimate, factor: f64) -> String {
    let spread = e.sd.map(|sd| format!(" ± {}", significant(sd / factor))).unwrap_or_default();
    format!("{}{spread} ({})", significant(e.mean / factor), e.n)
}
