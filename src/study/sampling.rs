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

use super::bending::simulate_strip;
use super::reading::Reading;
use super::result::IN_PLANE;
use super::{
    Case, PreparedCase, PreparedTest, Status, StudyError, Watch, as_measured, drape, refused, simulate_cycle,
};
use crate::case::{
    BendingTest, DrapeProblem, FabricMaterial, InstrumentTest, Problem, SamplingPlan, ShellSpecimen,
};
use crate::characterise::FabricSheet;
use crate::constitutive::{
    self, Assumptions, Constitutive, InputSource, MeasuredInput, law_inputs, perturbed,
};
use crate::finding::{Finding, Place, StudyFact};
use crate::instrument::{Direction, Parameter, Test};
use crate::law::Mode;
use crate::quantity::{Estimate, Sampled, SampledPopulation, sampled, sobol_points};
use crate::solve::Options;

/// The results of a case with their bands.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    /// Measured inputs and stand-ins.
    pub inputs: Vec<MeasuredInput>,
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
    /// No results, and why.
    fn without_bands(case: &Case, plan: &SamplingPlan, why: StudyFact) -> Self {
        Self {
            inputs: Vec::new(),
            points: plan.points,
            seed: plan.seed,
            exact: Vec::new(),
            quantities: Vec::new(),
            findings: vec![Finding::new(why).at(Place::file(&case.path))],
        }
    }

    /// The result of a name.
    pub fn of(&self, quantity: &str) -> Option<&SampledQuantity> {
        self.quantities.iter().find(|q| q.quantity == quantity)
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
    case.sampling().map_or(0, |table| 2 * table.points as usize)
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
    let Some(FabricMaterial { assumptions, sampling: Some(plan), .. }) = case.fabric() else {
        return Ok(None);
    };
    // Neither the sheet nor its curves are there, of which a section at other values could be made.
    if made.inputs.is_empty() || made.inputs.iter().any(|input| input.source == InputSource::Document) {
        let fact = StudyFact::StatedSection { fabric: sheet.name.clone() };
        return Ok(Some(Sampling::without_bands(case, plan, fact)));
    }
    let options = &Options { threads: 1, ..Options::default() };
    let mut inputs = made.inputs.clone();
    let sampler =
        |inputs, evaluate| Sampler { case, assumptions, plan, inputs, evaluate }.run(sheet, made, watch);
    match &case.problem {
        Problem::BendingTest(BendingTest::Strip(test)) => {
            if test.kind.has_friction() {
                inputs.extend(law_inputs(sheet, Parameter::Hb));
            }
            let bend = |sheet: &FabricSheet, made: &Constitutive| {
                simulate_strip(test, sheet, &made.section).map(|result| result.readings())
            };
            sampler(inputs, &bend).map(Some)
        }
        Problem::InstrumentTest(InstrumentTest::Shell(specimen)) => {
            if specimen.test.test() == Test::Tensile && case.law() != Mode::Elastic {
                inputs.extend(law_inputs(sheet, Parameter::Wt));
            }
            let prepared = PreparedTest::new(case, specimen, options)?;
            let test = |sheet: &FabricSheet, made: &Constitutive| {
                of_specimen(specimen, &prepared, sheet, made, options)
            };
            sampler(inputs, &test).map(Some)
        }
        Problem::Drape(problem) => {
            let problem = DrapeProblem { refinements: 0, ..(**problem).clone() };
            let coarse = Case { problem: Problem::Drape(Box::new(problem)), ..case.clone() };
            let (coarse, _) = as_measured(&coarse, sheet);
            let hang = |_: &FabricSheet, made: &Constitutive| {
                let watch = Watch { stage: &|| (), ..watch };
                let hung = drape(&coarse, &made.section, made.law.as_ref(), options, watch)?;
                Ok(vec![Reading::new("drape_coefficient", hung.finest.coefficient, "1")])
            };
            sampler(inputs, &hang).map(Some)
        }
        Problem::Sheet(_) => {
            // What the mesh leaves open is asked of the means alone.
            let prepared = PreparedCase::new(case, options)?.on_own_mesh();
            let solve = |_: &FabricSheet, made: &Constitutive| of_sheet(&prepared, made);
            sampler(inputs, &solve).map(Some)
        }
        // Records are of one specimen, and the closed form of compression has bands of its own.
        Problem::BendingTest(BendingTest::FabBendLoop(_))
        | Problem::InstrumentTest(InstrumentTest::Compression(_)) => Ok(None),
    }
}

/// The parameters of the cycle of a specimen with friction, or the stiffness of an elastic one, along warp and weft.
fn of_specimen(
    specimen: &ShellSpecimen,
    prepared: &PreparedTest,
    sheet: &FabricSheet,
    made: &Constitutive,
    options: &Options,
) -> Result<Vec<Reading>, StudyError> {
    let mut readings = Vec::new();
    for direction in [Direction::Warp, Direction::Weft] {
        match simulate_cycle(specimen, direction, sheet, made, options)? {
            Some(cycle) => {
                let values = cycle.values.iter();
                readings
                    .extend(values.map(|(p, v)| Reading::new(format!("{p} {direction}"), *v, p.si_unit())));
            }
            None => {
                let value = prepared.simulate(direction, &made.section, &sheet.settings)?.apparent;
                let shown = specimen.test.test().spec().stiffness.iter();
                readings
                    .extend(shown.map(|s| Reading::new(format!("{} {direction}", s.symbol), value, s.unit)));
            }
        }
    }
    Ok(readings)
}

/// The largest deflection and the displacements of the probes; nothing where no equilibrium was found.
fn of_sheet(prepared: &PreparedCase<'_>, made: &Constitutive) -> Result<Vec<Reading>, StudyError> {
    let result = prepared.solve_fabric(made)?;
    if result.status == Status::NotConverged {
        return Ok(Vec::new());
    }
    let largest = if result.lies_in_its_plane() {
        Reading::new(IN_PLANE, result.in_plane_max(), "m")
    } else {
        Reading::new("w_max", result.w_max, "m")
    };
    let mut readings = vec![largest];
    for probe in &result.probes {
        let components = ["u", "v", "w"].into_iter().zip(probe.value.u);
        readings.extend(components.map(|(c, v)| Reading::new(format!("{}.{c}", probe.name), v, "m")));
    }
    Ok(readings)
}

struct Sampler<'a> {
    case: &'a Case,
    assumptions: &'a Assumptions,
    plan: &'a SamplingPlan,
    inputs: Vec<MeasuredInput>,
    evaluate: Evaluate<'a>,
}

impl Sampler<'_> {
    fn run(self, sheet: &FabricSheet, made: &Constitutive, watch: Watch<'_>) -> Result<Sampling, StudyError> {
        let sheet = &self.with_stand_ins(&without_records(sheet));
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
            self.plan.exact.iter().find(|name| !self.inputs.iter().any(|i| i.name == name.value))
        {
            let names: Vec<&str> = self.inputs.iter().map(|i| i.name.as_str()).collect();
            let text = format!(
                "[uncertainty] exact: there is no input `{}`; there are {}",
                unknown.value,
                names.join(", ")
            );
            return Err(refused(self.case, unknown, text));
        }
        let (spread, single): (Vec<MeasuredInput>, Vec<MeasuredInput>) =
            self.inputs.iter().cloned().partition(|i| i.estimate.n > 1 && i.estimate.cv().is_some());
        if let Some(measured) =
            self.plan.exact.iter().find(|name| spread.iter().any(|i| i.name == name.value))
        {
            let text = format!(
                "[uncertainty] exact: `{}` has a spread of its own, from its repeats, and counts with it: remove it from the list",
                measured.value
            );
            return Err(refused(self.case, measured, text));
        }
        for input in single.into_iter().filter(|i| !self.plan.exact.iter().any(|name| name.value == i.name)) {
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
            for population in [SampledPopulation::MeanFabric, SampledPopulation::NextSpecimen] {
                self.band(sheet, &spread, population, &mut quantities, watch);
                if (watch.stopped)() {
                    return Err(StudyError::Stopped);
                }
            }
        }
        let findings = self.findings(&quantities);
        let SamplingPlan { points, seed, exact } = self.plan.clone();
        let exact = exact.into_iter().map(|name| name.value).collect();
        Ok(Sampling { inputs: self.inputs, points, seed, exact, quantities, findings })
    }

    /// The sheet with what stands for a direction that it does not have, as a value of that direction: it stays where it is while the
    /// value of the other one moves.
    fn with_stand_ins(&self, sheet: &FabricSheet) -> FabricSheet {
        let is_of_direction = |input: &&MeasuredInput| {
            input.estimate.n == 0 && matches!(input.source, InputSource::Value(_) | InputSource::Modulus(..))
        };
        let stand_ins: Vec<MeasuredInput> = self.inputs.iter().filter(is_of_direction).cloned().collect();
        let values: Vec<f64> = stand_ins.iter().map(|input| input.estimate.mean).collect();
        perturbed(sheet, self.assumptions, &stand_ins, &values).0
    }

    fn band(
        &self,
        sheet: &FabricSheet,
        inputs: &[MeasuredInput],
        population: SampledPopulation,
        quantities: &mut [SampledQuantity],
        watch: Watch<'_>,
    ) {
        let estimates: Vec<&Estimate> = inputs.iter().map(|i| &i.estimate).collect();
        // All of them have a spread.
        let Ok(points) = sobol_points(&estimates, population, self.plan.points, self.plan.seed) else {
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
                SampledPopulation::MeanFabric => q.mean_fabric = band,
                SampledPopulation::NextSpecimen => q.next_specimen = band,
            }
        }
    }

    /// The quantities with other values of inputs; NaN where the case has no solution.
    fn at(
        &self,
        sheet: &FabricSheet,
        quantities: &[SampledQuantity],
        inputs: &[MeasuredInput],
        values: &[f64],
    ) -> Vec<f64> {
        let (sheet, assumptions) = perturbed(sheet, self.assumptions, inputs, values);
        let of_sheet =
            if self.case.needs_mass() { constitutive::section } else { constitutive::section_without_mass };
        let made = of_sheet(&sheet, &assumptions).ok();
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
            let fact = StudyFact::FailedPoints { failed, points: self.plan.points };
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
