//! Values that come from result tables and from `fabric.toml`.

use std::collections::BTreeMap;

use super::statistics::outlier;
use super::{FabricSheet, Key, Modulus, Settings};
use crate::finding::{EvaluationFact, Finding, Place};
use crate::instrument::{Direction, FabricInput, Parameter, ResultValue};
use crate::kes::ValueStatus;
use crate::quantity::Estimate;

/// Difference between a table and the curves that is reported.
const DISAGREEMENT: f64 = 0.05;
/// The same of a thickness, which depends on the pressure: at which one that of `fabric.toml` was measured is not known.
const OTHER_PRESSURE: f64 = 0.5;

/// Adds table values to the sheet. What was evaluated from curves stays; where the two differ, both are told.
pub(super) fn merge(sheet: &mut FabricSheet, input: &FabricInput, settings: &Settings) {
    let mut cells: BTreeMap<Key, Vec<&ResultValue>> = BTreeMap::new();
    for value in &input.results {
        let key = Key { parameter: value.parameter, direction: value.direction };
        cells.entry(key).or_default().push(value);
    }
    for (key, values) in cells {
        for value in values.iter().filter(|v| v.status != ValueStatus::Measured) {
            let fact = EvaluationFact::StatedStatus { key, status: value.status };
            sheet.findings.push(Finding::new(fact).at(value.place.clone()));
        }
        let Some(estimate) = together(&values) else { continue };
        if let Some((i, test)) = outlier(&estimate.values, settings.outlier_floor.si()) {
            let fact = EvaluationFact::StandsApart {
                key,
                repeat: i + 1,
                in_table: true,
                others: estimate.n - 1,
                criterion: test.to_string(),
            };
            let cell = values[if values.len() > 1 { i } else { 0 }];
            let line = cell.lines.get(i).copied().unwrap_or(cell.place.line);
            sheet.findings.push(Finding::new(fact).at(Place { line, ..cell.place.clone() }));
        }
        match sheet.values.get(&key) {
            None => {
                sheet.values.insert(key, estimate);
                sheet.table_files.insert(key, values.iter().map(|v| v.place.path.clone()).collect());
            }
            Some(own) if (own.mean - estimate.mean).abs() > DISAGREEMENT * own.mean.abs() => {
                let fact = EvaluationFact::TableDiffers { key, table: estimate.mean, curves: own.mean };
                sheet.findings.push(Finding::new(fact).at(values[0].place.clone()));
            }
            Some(_) => {}
        }
    }
}

/// Tensile stiffnesses of a table, where they are between the loads of `tangent_low`, or at any load, and no curve says
/// more.
pub(super) fn stiffnesses(sheet: &mut FabricSheet, input: &FabricInput, settings: &Settings) {
    let window = settings.tangent_low.map(crate::quantity::LineForce::si);
    for stated in &input.stiffnesses {
        let same =
            |loads: [f64; 2]| loads.iter().zip(window).all(|(own, set)| (own - set).abs() <= 1e-6 * set);
        let fits = stated.loads.is_none_or(same);
        let key = (Modulus::TangentLow.name(), stated.direction);
        if fits && !sheet.moduli.contains_key(&key) {
            sheet.moduli.insert(key, Estimate::single(stated.stiffness));
            let fact =
                EvaluationFact::StatedStiffness { direction: stated.direction, what: stated.what.clone() };
            sheet.findings.push(Finding::new(fact).at(stated.place.clone()));
        }
    }
}

/// One cell as it stands; several cells of one key are repeats.
fn together(values: &[&ResultValue]) -> Option<Estimate> {
    match values {
        [one] => Some(Estimate { mean: one.mean, sd: one.sd, n: one.n, values: one.values.clone() }),
        _ => Estimate::of(&values.iter().map(|v| v.mean).collect::<Vec<_>>()),
    }
}

/// Areal density and thickness from `fabric.toml`, where nothing better is known.
pub(super) fn metadata(sheet: &mut FabricSheet, input: &FabricInput) {
    let key = |parameter| Key { parameter, direction: None };
    if let Some(w) = input.info.areal_density {
        tell_another(sheet, key(Parameter::W), w, DISAGREEMENT);
        sheet.values.entry(key(Parameter::W)).or_insert_with(|| Estimate::single(w));
    } else if !sheet.values.contains_key(&key(Parameter::W)) {
        sheet.findings.push(Finding::new(EvaluationFact::NoArealDensity {}));
    }
    if let (Some(t), false) = (input.info.thickness, sheet.values.contains_key(&key(Parameter::T0))) {
        sheet.findings.push(Finding::new(EvaluationFact::StatedThickness {}));
        sheet.values.insert(key(Parameter::T0), Estimate::single(t));
    } else if let Some(t) = input.info.thickness {
        tell_another(sheet, key(Parameter::T0), t, OTHER_PRESSURE);
    }
}

/// K069: `fabric.toml` says another value than the files, which are used.
fn tell_another(sheet: &mut FabricSheet, key: Key, stated: f64, tolerance: f64) {
    let Some(value) = sheet.values.get(&key).map(|e| e.mean) else { return };
    if (stated - value).abs() > tolerance * value.abs() {
        sheet.findings.push(Finding::new(EvaluationFact::StatedDiffers { key, stated, value }));
    }
}

/// `Fm/e_m`, with the relative spread of the extension: to first order that of its reciprocal.
fn secant(maximum: f64, extension: &Estimate) -> Estimate {
    let mean = maximum / extension.mean;
    match extension.cv() {
        Some(cv) => Estimate { mean, sd: Some(cv * mean), n: extension.n, values: Vec::new() },
        None => Estimate::single(mean),
    }
}

/// Secant and energy modulus where only a table is known: Fm / e_m and LT Fm / e_m (or 2 WT / e_m²).
pub(super) fn moduli(sheet: &mut FabricSheet, settings: &Settings) {
    let maximum = settings.table_maximum.si();
    let mut used = false;
    for direction in Direction::ALL {
        let mean = |p| sheet.get(p, Some(direction)).map(|e| e.mean);
        let known = sheet.moduli.keys().any(|(_, d)| *d == direction);
        let extension = sheet.get(Parameter::Emt, Some(direction)).filter(|e| e.mean > 0.0).cloned();
        let (Some(extension), false) = (extension, known) else { continue };
        let (strain, secant) = (extension.mean, secant(maximum, &extension));
        let energy = (mean(Parameter::Lt).map(|lt| lt * secant.mean))
            .or_else(|| mean(Parameter::Wt).map(|wt| 2.0 * wt / (strain * strain)));
        // How LT and EMT vary together no table says.
        let energy = energy.map(Estimate::single);
        for (modulus, value) in [(Modulus::Secant, Some(secant)), (Modulus::Energy, energy)] {
            if let (Some(value), true) = (value, settings.moduli.contains(&modulus)) {
                sheet.moduli.insert((modulus.name(), direction), value);
                used = true;
            }
        }
    }
    if used {
        sheet.findings.push(Finding::new(EvaluationFact::ModuliOfTable { maximum }));
    }
}
