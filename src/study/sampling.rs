//! How certain a result is that is no linear function of the measured inputs: the case is solved at
//! scrambled Sobol points of the inputs, once spread as the mean fabric and once as one more specimen.
//!
//! | case | results | solved at each point |
//! |---|---|---|
//! | drape | drape coefficient | the search on the mesh of the case, without refinement |
//! | nonlinear | largest deflection, displacements of probes | the whole path |
//! | newmark | largest deflection in time, displacements of probes at the end | the whole motion |
//! | cantilever, heart loop | bending length (elastic, with friction), height | the whole test |
//! | virtual test in large rotations | stiffness; with friction the KES parameters of the cycle | the whole test |
//!
//! Inputs are independent. One without a spread stays at its value; a result that moves with it has
//! no band, as it would be too narrow.

use super::bending::{BendingResult, simulate_strips};
use super::case::{Analysis, BendingKind, Case, TestFormulation, UncertaintyTable};
use super::{PreparedCase, PreparedTest, Status, StudyError, Watch, drape, simulate_cycle};
use crate::characterise::FabricSheet;
use crate::constitutive::{self, Constitutive, Input, law_inputs, perturbed};
use crate::finding::{Finding, Place, StudyFact};
use crate::instrument::{Direction, Parameter, Test};
use crate::law::Mode;
use crate::quantity::{Estimate, Population, Sampled, sampled, sobol_points};
use crate::solve::Options;

/// The results of a case with their bands.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    /// Measured inputs and stand-ins.
    pub inputs: Vec<Input>,
    /// Points of each band.
    pub points: u32,
    /// Seed of the points.
    pub seed: u32,
    /// Inputs that are taken as exact.
    pub exact: Vec<String>,
    /// The results.
    pub quantities: Vec<SampledQuantity>,
    /// What a reader of the bands must know.
    pub findings: Vec<Finding>,
}

/// A result with its bands.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledQuantity {
    /// As in the table of predictions, e.g. `drape_coefficient` or `2HB warp`.
    pub quantity: String,
    /// Its SI unit.
    pub unit: &'static str,
    /// At the means of the inputs (SI), solved as the points are.
    pub value: f64,
    /// Where the result of the mean fabric lies.
    pub mean_fabric: Option<Sampled>,
    /// Where the result of one more specimen lies.
    pub next_specimen: Option<Sampled>,
    /// Inputs without a spread that move it: they forbid its bands.
    pub without_spread: Vec<String>,
}

impl Sampling {
    /// The result of a name.
    pub fn of(&self, quantity: &str) -> Option<&SampledQuantity> {
        self.quantities.iter().find(|q| q.quantity == quantity)
    }
}

/// A result of one solution.
struct Reading {
    quantity: String,
    unit: &'static str,
    value: f64,
}

impl Reading {
    fn new(quantity: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self { quantity: quantity.into(), unit, value }
    }
}

/// Solves a case for a sheet and what was made of it.
type Evaluate<'a> = &'a (dyn Fn(&FabricSheet, &Constitutive) -> Result<Vec<Reading>, StudyError> + Sync);

/// An input without a spread is tried this much of itself higher (logarithm) ...
const STEP: f64 = 0.05;
/// ... and moves a result if that changes by more than this part of the step.
const NEGLIGIBLE: f64 = 1e-3;

/// How often [`Watch::stage`] of [`sample`] is called at most.
pub fn sampling_stages(case: &Case) -> usize {
    case.uncertainty.as_ref().map_or(0, |table| 2 * table.points as usize)
}

/// The bands of a case with `[uncertainty]`; `None` without that table. The points are solved in parallel; [`Watch::stage`]
/// is called after each.
///
/// # Errors
/// See [`StudyError`]: those of the case at the means of the inputs. A point that fails is counted.
pub fn sample(
    case: &Case,
    sheet: &FabricSheet,
    made: &Constitutive,
    watch: Watch<'_>,
) -> Result<Option<Sampling>, StudyError> {
    let Some(table) = &case.uncertainty else { return Ok(None) };
    let options = &Options { threads: 1, ..Options::default() };
    let mut inputs = made.inputs.clone();
    let sampler = |inputs, evaluate| Sampler { case, table, inputs, evaluate }.run(sheet, made, watch);
    if let Some(spec) = &case.bending_test {
        if spec.test == BendingKind::Cantilever {
            inputs.extend(law_inputs(sheet, Parameter::Hb));
        }
        let bend = |sheet: &FabricSheet, made: &Constitutive| {
            simulate_strips(case, spec, sheet, &made.section).map(|r| of_strips(&r))
        };
        return sampler(inputs, &bend).map(Some);
    }
    if let Some(spec) = &case.virtual_test {
        if spec.test == Test::Tensile && case.assumptions.law != Mode::Elastic {
            inputs.extend(law_inputs(sheet, Parameter::Wt));
        }
        let prepared = PreparedTest::new(case, spec, options)?;
        let test = |sheet: &FabricSheet, made: &Constitutive| {
            let mut readings = Vec::new();
            for direction in [Direction::Warp, Direction::Weft] {
                match simulate_cycle(case, spec, direction, sheet, made, options)? {
                    Some(cycle) => readings.extend(
                        (cycle.values.iter())
                            .map(|(p, v)| Reading::new(format!("{p} {direction}"), *v, p.si_unit())),
                    ),
                    None => {
                        let value = prepared.simulate(direction, &made.section, &sheet.settings)?.apparent;
                        let (symbol, unit) = stiffness(spec.test);
                        readings.push(Reading::new(format!("{symbol} {direction}"), value, unit));
                    }
                }
            }
            Ok(readings)
        };
        return sampler(inputs, &test).map(Some);
    }
    if let Analysis::Drape { folds, .. } = &case.analysis {
        let analysis = Analysis::Drape { folds: folds.clone(), refinements: 0 };
        let coarse = Case { analysis, ..case.clone() };
        let hang = |_: &FabricSheet, made: &Constitutive| {
            let hung =
                drape(&coarse, &made.section, made.law.as_ref(), options, Watch { stage: &|| (), ..watch })?;
            Ok(vec![Reading::new("drape_coefficient", hung.finest.coefficient, "1")])
        };
        return sampler(inputs, &hang).map(Some);
    }
    let prepared = PreparedCase::new(case, options)?;
    let solve = |_: &FabricSheet, made: &Constitutive| {
        let result = prepared.solve_fabric(made)?;
        if result.status == Status::NotConverged {
            return Ok(Vec::new());
        }
        let of_probe = |p: &super::Probe| {
            let u = p.value.u;
            ["u", "v", "w"]
                .into_iter()
                .zip(u)
                .map(|(c, v)| Reading::new(format!("{}.{c}", p.name), v, "m"))
                .collect()
        };
        let probes: Vec<Vec<Reading>> = result.probes.iter().map(of_probe).collect();
        Ok(std::iter::once(Reading::new("w_max", result.w_max, "m"))
            .chain(probes.into_iter().flatten())
            .collect())
    };
    sampler(inputs, &solve).map(Some)
}

/// Symbol and SI unit of what an elastic test reads.
fn stiffness(test: Test) -> (&'static str, &'static str) {
    match test {
        Test::Tensile => ("E", "N/m"),
        Test::Shear => ("G", "N/m"),
        _ => ("B", "N·m"),
    }
}

fn of_strips(result: &BendingResult) -> Vec<Reading> {
    match result {
        BendingResult::Cantilever(tests) => (tests.iter())
            .flat_map(|c| {
                let elastic = Reading::new(format!("bending_length {}", c.direction), c.bending_length, "m");
                let name = format!("bending_length_friction {}", c.direction);
                let friction = c.friction.as_ref().map(|f| Reading::new(name, f.bending_length, "m"));
                std::iter::once(elastic).chain(friction)
            })
            .collect(),
        BendingResult::HeartLoop(tests) => (tests.iter())
            .map(|h| Reading::new(format!("heart_loop_height {}", h.direction), h.height, "m"))
            .collect(),
        BendingResult::FabBendLoop(_) => Vec::new(),
    }
}

impl Case {
    /// Why `[uncertainty]` has no meaning for the case, if it has none.
    pub(super) fn against_sampling(&self) -> Option<&'static str> {
        if self.section.is_some() {
            return Some(
                "the constants of a [section] have no spread: remove [uncertainty], or name a `fabric`",
            );
        }
        let records = |t: &super::BendingTest| t.test == BendingKind::FabBendLoop;
        if self.bending_test.as_ref().is_some_and(records) {
            return Some("FAB records are of one specimen and have no spread: remove [uncertainty]");
        }
        let linear = match (&self.virtual_test, &self.bending_test) {
            (Some(test), _) => test.formulation == TestFormulation::Linear,
            (_, Some(_)) => false,
            _ => !matches!(
                self.analysis,
                Analysis::Nonlinear(_) | Analysis::Drape { .. } | Analysis::Newmark { .. }
            ),
        };
        linear.then_some(
            "[uncertainty] is for drapes, nonlinear statics, dynamics, cantilevers, heart loops and virtual tests in large \
             rotations: remove it, the bands of linear cases need no points",
        )
    }
}

struct Sampler<'a> {
    case: &'a Case,
    table: &'a UncertaintyTable,
    inputs: Vec<Input>,
    evaluate: Evaluate<'a>,
}

impl Sampler<'_> {
    fn run(self, sheet: &FabricSheet, made: &Constitutive, watch: Watch<'_>) -> Result<Sampling, StudyError> {
        let sheet = &without_records(sheet);
        let mut quantities: Vec<SampledQuantity> = ((self.evaluate)(sheet, made)?.into_iter())
            .map(|Reading { quantity, unit, value }| SampledQuantity {
                quantity,
                unit,
                value,
                mean_fabric: None,
                next_specimen: None,
                without_spread: Vec::new(),
            })
            .collect();
        if let Some(unknown) =
            self.table.exact.iter().find(|name| !self.inputs.iter().any(|i| i.name == **name))
        {
            let names: Vec<&str> = self.inputs.iter().map(|i| i.name.as_str()).collect();
            let text =
                format!("[uncertainty] exact: there is no input `{unknown}`; there are {}", names.join(", "));
            return Err(self.case.inconsistent(text));
        }
        let (spread, single): (Vec<Input>, Vec<Input>) =
            self.inputs.iter().cloned().partition(|i| i.estimate.n > 1 && i.estimate.cv().is_some());
        for input in single.into_iter().filter(|i| !self.table.exact.contains(&i.name)) {
            let values = self.at(
                sheet,
                &quantities,
                std::slice::from_ref(&input),
                &[input.estimate.mean * STEP.exp()],
            );
            for (q, value) in quantities.iter_mut().zip(values) {
                let change = (value - q.value).abs();
                if change.is_nan() || change > NEGLIGIBLE * STEP * q.value.abs() {
                    q.without_spread.push(input.name.clone());
                }
            }
        }
        if !spread.is_empty() && quantities.iter().any(|q| q.without_spread.is_empty()) {
            for population in [Population::MeanFabric, Population::NextSpecimen] {
                self.band(sheet, &spread, population, &mut quantities, watch);
                if (watch.stopped)() {
                    return Err(StudyError::Stopped);
                }
            }
        }
        let findings = self.findings(&quantities);
        let UncertaintyTable { points, seed, exact } = self.table.clone();
        Ok(Sampling { inputs: self.inputs, points, seed, exact, quantities, findings })
    }

    fn band(
        &self,
        sheet: &FabricSheet,
        inputs: &[Input],
        population: Population,
        quantities: &mut [SampledQuantity],
        watch: Watch<'_>,
    ) {
        let estimates: Vec<&Estimate> = inputs.iter().map(|i| &i.estimate).collect();
        // All of them have a spread.
        let Ok(points) = sobol_points(&estimates, population, self.table.points, self.table.seed) else {
            return;
        };
        let at = |values: &[f64]| {
            if (watch.stopped)() {
                return vec![f64::NAN; quantities.len()];
            }
            self.at(sheet, quantities, inputs, values)
        };
        let bands = sampled(&points, quantities.len(), at, watch.stage);
        for (q, band) in quantities.iter_mut().zip(bands).filter(|(q, _)| q.without_spread.is_empty()) {
            match population {
                Population::MeanFabric => q.mean_fabric = band,
                Population::NextSpecimen => q.next_specimen = band,
            }
        }
    }

    /// The quantities with other values of inputs; NaN where the case has no solution.
    fn at(
        &self,
        sheet: &FabricSheet,
        quantities: &[SampledQuantity],
        inputs: &[Input],
        values: &[f64],
    ) -> Vec<f64> {
        let (sheet, assumptions) = perturbed(sheet, &self.case.assumptions, inputs, values);
        let made = constitutive::section(&sheet, &assumptions).ok();
        let readings = made.and_then(|made| (self.evaluate)(&sheet, &made).ok()).unwrap_or_default();
        let value = |q: &SampledQuantity| {
            readings.iter().find(|r| r.quantity == q.quantity).map_or(f64::NAN, |r| r.value)
        };
        quantities.iter().map(value).collect()
    }

    fn findings(&self, quantities: &[SampledQuantity]) -> Vec<Finding> {
        let mut findings = Vec::new();
        let bands = || quantities.iter().flat_map(|q| [q.mean_fabric, q.next_specimen]).flatten();
        if let Some(failed) = bands().map(|b| b.failed).max().filter(|n| *n > 0) {
            let fact = StudyFact::FailedPoints { failed, points: self.table.points };
            findings.push(Finding::new(fact).at(Place::file(&self.case.path)));
        }
        let mut names: Vec<&str> =
            quantities.iter().flat_map(|q| &q.without_spread).map(String::as_str).collect();
        names.sort_unstable();
        names.dedup();
        if !names.is_empty() {
            let fact = StudyFact::NoBand { inputs: names.into_iter().map(str::to_string).collect() };
            findings.push(Finding::new(fact).at(Place::file(&self.case.path)));
        }
        findings
    }
}

/// The sheet as far as solutions need it: its copies are many.
fn without_records(sheet: &FabricSheet) -> FabricSheet {
    FabricSheet {
        name: sheet.name.clone(),
        info: sheet.info.clone(),
        values: sheet.values.clone(),
        moduli: sheet.moduli.clone(),
        laws: sheet.laws.clone(),
        settings: sheet.settings.clone(),
        run_to: sheet.run_to.clone(),
        ..FabricSheet::default()
    }
}

#[cfg(test)]
#[path = "sampling_tests.rs"]
mod tests;
