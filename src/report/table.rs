//! Tidy tables: one observation a row, with its unit; as CSV, and as Parquet with the feature `parquet`.

mod cell;

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::CsvTable;
use crate::characterise::{FabricSheet, ValueStatus};
use crate::finding::{Finding, errors};
use crate::instrument::{Direction, FabricInput, MeasuredResult, Measurement, Parameter, Test};
use crate::quantity::Estimate;
use crate::study::CaseResult;
#[cfg(feature = "parquet")]
pub(super) use cell::harmless;
use cell::{Cell, Harmless};
pub use cell::{Row, Values};

errors! {
    /// Why there is no table.
    #[derive(Clone, Debug, PartialEq)]
    pub enum TableError {
        /// O030: the CSV or Parquet writer refused.
        "O030" Encode {
            /// `CSV` or `Parquet`.
            format: &'static str,
            /// What the writer said.
            problem: String,
        } = "the {format} table could not be made: {problem}";
    }
}

macro_rules! row {
    ($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        #[cfg_attr(test, derive(schemars::JsonSchema))]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $type,)*
        }

        impl Row for $name {
            const HEADER: &'static [&'static str] = &[$(stringify!($field)),*];

            fn values(rows: &[Self]) -> Vec<Values> {
                vec![$(<$type as Cell>::column(rows.iter().map(|row| row.$field.clone()))),*]
            }

            fn harmless(self) -> Self {
                Self { $($field: Harmless::harmless(self.$field)),* }
            }
        }
    };
}

row! {
    /// A parameter of a fabric (`fabrics.csv`).
    FabricRow {
        /// Identifier of the fabric.
        fabric: String,
        /// Symbol, e.g. `2HB`, or a measured result of `fabric.toml`, e.g. `drape_coefficient`.
        parameter: String,
        /// `warp`, `weft`, `bias`, or nothing for the fabric as a whole.
        direction: Option<String>,
        /// Mean over the repeats.
        mean: Option<f64>,
        /// Sample standard deviation.
        sd: Option<f64>,
        /// Number of repeats.
        n: u64,
        /// Unit of mean and sd.
        unit: String,
        /// `measured`, `inferred`, `assumed` or `doubtful`, as the findings of the fabric tell; the code of what went
        /// wrong in the row of a fabric that could not be read.
        status: String,
        /// Coefficient of variation, SD / |mean|.
        cv: Option<f64>,
        /// Half width of the 95 % Student t interval of the mean.
        ci95: Option<f64>,
        /// `measured`, `published` or `synthetic`: where the data of the fabric come from; nothing of a fabric that could
        /// not be read.
        origin: Option<String>,
    }
}

row! {
    /// A simulated quantity, beside its measured value where there is one (`predictions.csv`).
    PredictionRow {
        /// Identifier of the fabric.
        fabric: String,
        /// Name of the case.
        case: String,
        /// What was predicted, e.g. `w_max`.
        quantity: String,
        /// Simulated value.
        simulated: Option<f64>,
        /// Measured value.
        measured: Option<f64>,
        /// Unit of both.
        unit: String,
        /// (simulated - measured) / measured; see [`relative_error`].
        error: Option<f64>,
        /// Lower end of the 95 % band of the mean fabric; nothing where an input that matters has no
        /// spread, or where the result is not linear.
        simulated_low: Option<f64>,
        /// Upper end of that band.
        simulated_high: Option<f64>,
        /// Origin of the data of the fabric, as in `fabrics.csv`; nothing of a case with constants of its own.
        origin: Option<String>,
        /// What weighs most against the value: `not converged`, `check failed`, `beyond linear`, `doubtful`, `assumed`,
        /// `quick` or `inferred`; nothing where nothing does.
        status: Option<String>,
        /// What of its inputs speaks against it, e.g. `rests on an assumed E and a doubtful B warp`.
        remark: Option<String>,
        /// The least reliable of the inputs that the value shows: `measured`, `inferred`, `assumed` or `doubtful`; nothing of a
        /// case with constants of its own.
        inputs: Option<String>,
    }
}

row! {
    /// A value on the way of a nonlinear or dynamic analysis (`<case>.csv`).
    HistoryRow {
        /// Number of the step; a dynamic analysis starts with 0.
        step: u64,
        /// Time (s); nothing of statics.
        time: Option<f64>,
        /// Factor of the loads; nothing of dynamics.
        factor: Option<f64>,
        /// E.g. `centre.w`, `strain_energy`.
        quantity: String,
        /// Its value.
        value: f64,
        /// SI unit of the value.
        unit: String,
    }
}

row! {
    /// Something that a reader of the results must know (`problems.csv`).
    ProblemRow {
        /// `file:line:column`, or the fabric or case.
        place: String,
        /// Code for `kesf explain`.
        code: String,
        /// One sentence.
        message: String,
        /// The fabric that it is about.
        fabric: Option<String>,
        /// What to do about a failure; the message of a finding says it itself.
        hint: Option<String>,
    }
}

row! {
    /// Something that is known of a fabric: a parameter, or what a case predicts; SI (the results of a part).
    ResultRow {
        /// Identifier of the fabric; of a case with constants of its own, nothing.
        fabric: String,
        /// Name of the case; nothing of a parameter.
        case: Option<String>,
        /// Symbol of a parameter, e.g. `2HB`, or what was predicted, e.g. `w_max`.
        quantity: String,
        /// `warp`, `weft` or `bias` of a parameter that has one.
        direction: Option<String>,
        /// Mean over the repeats, or the simulated value.
        value: Option<f64>,
        /// SI unit of all numbers of the row.
        unit: String,
        /// Sample standard deviation of a parameter.
        sd: Option<f64>,
        /// Number of repeats of a parameter.
        n: Option<u64>,
        /// Measured value beside a prediction.
        measured: Option<f64>,
        /// Lower end of the 95 % band of a prediction.
        low: Option<f64>,
        /// Upper end of that band.
        high: Option<f64>,
        /// Status of a parameter as in `fabrics.csv`, of a prediction as in `predictions.csv`.
        status: Option<String>,
        /// Origin of the data of the fabric, as in `fabrics.csv`; nothing of a case with constants of its own.
        origin: Option<String>,
        /// Remark on a prediction, as in `predictions.csv`.
        remark: Option<String>,
    }
}

row! {
    /// What a reader of a part must know, or what gave nothing (the findings and failures of a part).
    RemarkRow {
        /// The fabric that it is about.
        fabric: Option<String>,
        /// Code for `kesf explain`.
        code: String,
        /// `file:line:column`, or the fabric or case.
        place: String,
        /// One sentence.
        message: String,
        /// What to do about a failure; the message of a finding says it itself.
        hint: Option<String>,
    }
}

row! {
    /// A point of a measured curve, as read (`kesf read`).
    CurveRow {
        /// Identifier of the fabric.
        fabric: String,
        /// `tensile`, `shear`, `bending` or `compression`.
        test: String,
        /// `warp`, `weft` or `bias`; nothing for compression.
        direction: Option<String>,
        /// Specimen number, from 1.
        specimen: u64,
        /// Place in recorded order, from 0.
        index: u64,
        /// Abscissa.
        x: f64,
        /// Its unit.
        x_unit: String,
        /// Ordinate.
        y: f64,
        /// Its unit.
        y_unit: String,
        /// Origin of the data of the fabric, as in `fabrics.csv`.
        origin: Option<String>,
    }
}

/// The units of a table of parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnitSystem {
    /// The customary units of the KES literature.
    #[default]
    Kes,
    /// SI.
    Si,
}

impl UnitSystem {
    /// Unit text of a parameter and its SI value.
    pub fn of(self, parameter: Parameter) -> (&'static str, f64) {
        match self {
            Self::Kes => (parameter.kes_unit(), parameter.kes_factor()),
            Self::Si => (parameter.si_unit(), 1.0),
        }
    }

    /// Unit text of a tensile modulus (force per width over strain) and its SI value.
    pub fn of_modulus(self) -> (&'static str, f64) {
        match self {
            Self::Kes => (Parameter::Hg.kes_unit(), Parameter::Hg.kes_factor()),
            Self::Si => ("N/m", 1.0),
        }
    }
}

/// An SI value in another unit, to 12 significant digits: what was 0.1 gf·cm²/cm in a file is that again, not
/// 0.09999999999999999.
pub(crate) fn in_unit(value: f64, factor: f64) -> f64 {
    if factor == 1.0 {
        return value;
    }
    let value = value / factor;
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// (simulated - measured) / measured, where that is a number.
pub fn relative_error(simulated: f64, measured: f64) -> Option<f64> {
    Some((simulated - measured) / measured).filter(|e| e.is_finite())
}

/// The rows of a sheet, in the order of its parameters and directions; then its moduli (`E secant`), and the results that
/// its `fabric.toml` states (`drape_coefficient`), which are in SI always.
pub fn fabric_rows(sheet: &FabricSheet, units: UnitSystem) -> Vec<FabricRow> {
    let row = |name: String,
               direction: Option<Direction>,
               e: &Estimate,
               (unit, factor): (&str, f64),
               status: ValueStatus| {
        let shown = |value: f64| in_unit(value, factor);
        FabricRow {
            fabric: sheet.name.clone(),
            parameter: name,
            direction: direction.map(|d| d.name().into()),
            mean: Some(shown(e.mean)),
            sd: e.sd.map(shown),
            n: e.n as u64,
            unit: unit.into(),
            status: status.name().into(),
            cv: e.cv(),
            ci95: e.ci95().map(shown),
            origin: Some(sheet.info.origin.name().into()),
        }
    };
    let values = sheet.values.iter().map(|(key, e)| {
        let name = key.parameter.symbol().into();
        row(name, key.direction, e, units.of(key.parameter), sheet.status(*key))
    });
    let moduli = sheet.moduli.iter().map(|((name, direction), e)| {
        let status = sheet.modulus_status(name, *direction);
        row(format!("E {name}"), Some(*direction), e, units.of_modulus(), status)
    });
    values.chain(moduli).chain(sheet.info.results.iter().filter_map(|r| stated_row(sheet, r))).collect()
}

/// The row of a measured result of `fabric.toml`, which does not say of how many repeats it is.
fn stated_row(sheet: &FabricSheet, result: &MeasuredResult) -> Option<FabricRow> {
    let (mean, unit) = result.si()?;
    Some(FabricRow {
        fabric: sheet.name.clone(),
        parameter: result.quantity.clone(),
        direction: result.direction.map(|d| d.name().into()),
        mean: Some(mean),
        n: 1,
        unit: unit.into(),
        status: ValueStatus::Measured.name().into(),
        origin: Some(sheet.info.origin.name().into()),
        ..FabricRow::default()
    })
}

impl FabricRow {
    /// Whether it is of a KES parameter or a modulus, and not of a result that `fabric.toml` states.
    pub fn is_of_parameter(&self) -> bool {
        self.parameter.starts_with("E ") || Parameter::from_symbol(&self.parameter).is_some()
    }

    /// A row of SI in other units.
    #[must_use]
    pub fn in_units(&self, units: UnitSystem) -> Self {
        let (unit, factor) = match Parameter::from_symbol(&self.parameter) {
            Some(parameter) => units.of(parameter),
            None if self.parameter.starts_with("E ") => units.of_modulus(),
            None => return self.clone(),
        };
        let shown = |value: f64| in_unit(value, factor);
        Self {
            mean: self.mean.map(shown),
            sd: self.sd.map(shown),
            ci95: self.ci95.map(shown),
            unit: unit.into(),
            ..self.clone()
        }
    }
}

/// Probes and energies against load factor or time; none of analyses without either.
pub fn history_rows(result: &CaseResult) -> Vec<HistoryRow> {
    let mut rows = Vec::new();
    if let Some(path) = &result.path {
        for (k, step) in path.steps.iter().enumerate() {
            let mut row = |quantity: String, value, unit: &str| {
                let (step, factor) = (k as u64 + 1, Some(step.factor));
                rows.push(HistoryRow { step, time: None, factor, quantity, value, unit: unit.into() });
            };
            row("w_max".into(), step.w_max, "m");
            row("strain_energy".into(), step.strain_energy, "J");
            for (probe, displacements) in result.probes.iter().zip(&path.probes) {
                for (component, value) in ["u", "v", "w"].iter().zip(displacements[k]) {
                    row(format!("{}.{component}", probe.name), value, "m");
                }
            }
        }
    }
    if let Some(history) = &result.history {
        for (k, (time, energy)) in history.time.iter().zip(&history.energy).enumerate() {
            let mut row = |quantity: String, value, unit: &str| {
                let (step, time) = (k as u64, Some(*time));
                rows.push(HistoryRow { step, time, factor: None, quantity, value, unit: unit.into() });
            };
            for (probe, displacements) in result.probes.iter().zip(&history.probe_displacements) {
                for (component, value) in ["u", "v", "w"].iter().zip(displacements[k]) {
                    row(format!("{}.{component}", probe.name), value, "m");
                }
            }
            row("kinetic_energy".into(), energy.kinetic, "J");
            row("strain_energy".into(), energy.strain, "J");
            row("dissipated_energy".into(), energy.dissipated, "J");
            row("work_of_loads".into(), energy.work, "J");
        }
    }
    rows
}

/// The row that stands for a fabric that could not be characterised.
pub fn failed_fabric_row(fabric: &str, code: &str) -> FabricRow {
    FabricRow { fabric: fabric.into(), status: code.into(), ..FabricRow::default() }
}

impl ProblemRow {
    /// The message, with what to do where it does not say it itself.
    pub fn whole_message(&self) -> Cow<'_, str> {
        let with_hint = |hint| Cow::Owned(format!("{}; {hint}", self.message));
        self.hint.as_ref().map_or(Cow::Borrowed(&self.message), with_hint)
    }
}

/// The row of a finding; `otherwise` is the place of a finding that has none.
pub fn problem_row(finding: &Finding, otherwise: &str) -> ProblemRow {
    ProblemRow {
        place: finding.place.as_ref().map_or(otherwise.to_string(), ToString::to_string),
        code: finding.code().into(),
        message: finding.message(),
        fabric: None,
        hint: None,
    }
}

/// Every point of every curve of a fabric, in SI or in KES units.
pub fn curve_rows(fabric: &FabricInput, units: UnitSystem) -> Vec<CurveRow> {
    fabric.measurements.iter().flat_map(|m| measurement_rows(fabric, m, units)).collect()
}

fn measurement_rows<'a>(
    fabric: &'a FabricInput,
    measurement: &'a Measurement,
    units: UnitSystem,
) -> impl Iterator<Item = CurveRow> + 'a {
    let [(x_unit, x_factor), (y_unit, y_factor)] = curve_units(measurement.test, units);
    measurement.curve.points().enumerate().map(move |(index, (x, y))| CurveRow {
        fabric: fabric.name.clone(),
        test: measurement.test.name().into(),
        direction: measurement.direction.map(|d| d.name().into()),
        specimen: measurement.specimen as u64,
        index: index as u64,
        x: in_unit(x, x_factor),
        x_unit: x_unit.into(),
        y: in_unit(y, y_factor),
        y_unit: y_unit.into(),
        origin: Some(fabric.info.origin.name().into()),
    })
}

/// Units of abscissa and ordinate of a test, each with its SI value.
pub fn curve_units(test: Test, units: UnitSystem) -> [(&'static str, f64); 2] {
    let names = if units == UnitSystem::Kes { test.kes_axes() } else { test.axes() };
    // Every name is in the table of units; a test reads them all.
    names.map(|name| (name, crate::quantity::Unit::parse(name).map_or(f64::NAN, |u| u.factor)))
}

/// A table as CSV: UTF-8, comma, point, LF, with a header even if there are no rows.
///
/// Names come from folders and files of others. A text that begins with `=`, `+`, `-`, `@`, a tab or a carriage return
/// would be a formula to a spreadsheet and gets an apostrophe before it, as the Open Worldwide Application Security
/// Project advises (*CSV Injection*); numbers are untouched, and so are Parquet and JSON.
///
/// # Errors
/// [`TableError::Encode`].
pub fn csv<R: Row>(rows: &[R]) -> Result<Vec<u8>, TableError> {
    let mut table = CsvTable::new::<R>(Vec::new())?;
    rows.iter().try_for_each(|row| table.row(row))?;
    table.finish()
}

/// A CSV table with the mark (BOM) by which Excel knows UTF-8, in front of it.
pub fn marked(csv: Vec<u8>) -> Vec<u8> {
    ["\u{feff}".as_bytes(), &csv].concat()
}

/// A table as Parquet: UTF-8 and 64-bit columns, absent values are null.
///
/// # Errors
/// [`TableError::Encode`].
#[cfg(feature = "parquet")]
pub fn parquet<R: Row>(rows: &[R]) -> Result<Vec<u8>, TableError> {
    let mut table = super::ParquetTable::new(Vec::new())?;
    rows.iter().try_for_each(|row| table.row(row))?;
    table.finish()
}

#[cfg(test)]
mod tests;
