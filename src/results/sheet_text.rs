//! Parameter sheets as text.

use std::collections::BTreeSet;

use super::columns::Columns;
use super::friction;
use crate::characterise::{FabricSheet, Key, Settings, ValueStatus};
use crate::instrument::{Direction, MeasuredResult, Parameter};
use crate::quantity::{Estimate, repeats_text, significant, stated_repeats};
use crate::report::table::{UnitSystem, fabric_rows};

/// One line a parameter: `mean ± SD (n)` in each direction.
pub fn parameters_text(sheet: &FabricSheet, units: UnitSystem) -> String {
    let mut columns = Columns::new(["", "warp", "weft", "bias", "fabric", "unit"]);
    let directions = Direction::ALL.map(Some).into_iter().chain([None]);
    for &parameter in Parameter::ALL {
        let (unit, factor) = units.of(parameter);
        let cells: Vec<String> = directions
            .clone()
            .map(|direction| {
                let key = Key { parameter, direction };
                let cell =
                    |e| format!("{}{}", estimate(e, factor, sheet.status(key)), band(sheet, key, factor));
                sheet.get(parameter, direction).map(cell).unwrap_or_default()
            })
            .collect();
        if cells.iter().any(|c| !c.is_empty()) {
            columns.row([vec![parameter.symbol().to_string()], cells, vec![unit.to_string()]].concat());
        }
    }
    let (unit, factor) = units.of_modulus();
    for name in modulus_names(sheet) {
        let modulus = |d| sheet.moduli.get(&(name.clone(), d));
        let cells = Direction::ALL.map(|d| {
            let status = sheet.modulus_status(name, d);
            modulus(d).map(|e| estimate(e, factor, status)).unwrap_or_default()
        });
        let cells = cells.to_vec();
        columns.row([vec![format!("E {name}")], cells, vec![String::new(), unit.to_string()]].concat());
    }
    let head = format!("{} ({}), mean ± SD (n)", sheet.name, sheet.info.origin.name());
    let (text, legend) = (columns.text(), legend(sheet));
    let stated = |r: &MeasuredResult| format!("measured {}: {}\n", r.name(), r.text());
    let stated: String = sheet.info.results.iter().map(stated).collect();
    format!("{head}\n{text}{legend}{stated}{}", friction::text(sheet, units))
}

fn modulus_names(sheet: &FabricSheet) -> BTreeSet<&String> {
    sheet.moduli.keys().map(|(name, _)| name).collect()
}

/// One line a value with all of its statistics (`-v`).
pub fn statistics_text(sheet: &FabricSheet, units: UnitSystem) -> String {
    let mut columns = Columns::new([
        "",
        "direction",
        "mean",
        "SD",
        "CV %",
        "95 % interval of the mean",
        "n",
        "unit",
        "status",
    ]);
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
            repeats_text(row.n, row.sd),
            row.unit,
            row.status,
        ]);
    }
    format!("{} ({})\n{}", sheet.name, sheet.info.origin.name(), columns.text())
}

/// Windows and readings behind the values.
pub fn evaluation_text(settings: &Settings) -> String {
    let lines = settings.describe().into_iter().map(|(name, value)| format!("  {name}: {value}\n"));
    format!("evaluated with\n{}", lines.collect::<String>())
}

fn estimate(e: &Estimate, factor: f64, status: ValueStatus) -> String {
    let spread = e.sd.map(|sd| format!(" ± {}", significant(sd / factor))).unwrap_or_default();
    let n = stated_repeats(e.n as u64, e.sd).map_or("n?".into(), |n| n.to_string());
    format!("{}{spread} ({n}){}", significant(e.mean / factor), mark(status))
}

/// The range of a value over what was identified together with it, where there is one.
fn band(sheet: &FabricSheet, key: Key, factor: f64) -> String {
    let ends = sheet.model_bands.get(&key).map(|band| band.map(|end| significant(end / factor)));
    ends.map(|[low, high]| format!(" [{low} to {high}]")).unwrap_or_default()
}

/// What stands behind a value that is not plainly measured, after a blank.
pub(super) fn mark(status: ValueStatus) -> String {
    if status == ValueStatus::Measured { String::new() } else { format!(" {}", status.mark()) }
}

/// Behind a value in the place of a direction that is one for the fabric as a whole.
pub(super) const BOTH: &str = " both";

/// What [`BOTH`] means.
pub(super) const BOTH_LEGEND: &str = "both: one value for warp and weft together, not a measurement of each";

/// The meaning of the marks, where there are any.
fn legend(sheet: &FabricSheet) -> String {
    let values = sheet.values.keys().map(|key| sheet.status(*key));
    let moduli = sheet.moduli.keys().map(|(name, direction)| sheet.modulus_status(name, *direction));
    match values.chain(moduli).all(|status| status == ValueStatus::Measured) {
        true => String::new(),
        false => format!("{}\n", ValueStatus::legend()),
    }
}
