//! Friction laws of cloth: one per specimen from its measured loop, one per direction from summary
//! values where no loop was recorded.
//!
//! The law is that of [`crate::law`]; strain and stress are those of the test (curvature and moment
//! per width, shear angle and force, strain and force, approach of the faces and pressure).
//! Identification is linear in the weights: least squares with weights not below zero over 20
//! slip levels, a search for the widening, then six sliders that carry equal parts of the friction
//! in place of the levels found, and the weights again. FAB strips grow with every cycle that goes further, and relax: that is
//! a [`StripMemory`] beside the law.

mod bands;
mod closed_form;
mod identify;
mod law;
mod loop_fit;
mod means;
pub(crate) mod nnls;
mod record;
mod strip;
mod strip_memory;
mod summary;

use std::collections::BTreeMap;

use self::identify::Path;
use super::{Branch, CycleChoice, FabricSheet, Key, Settings, SpecimenResult};
use crate::finding::{EvaluationFact, Finding, Place, Subject};
use crate::instrument::{Conditions, Direction, Parameter, Shape, Test, standard_conditions};
use crate::law::Channel;
use crate::platform;
use crate::quantity::Estimate;

pub use bands::LawBand;
pub use closed_form::ClosedForm;
pub use law::{Basis, FrictionLaw};
pub use loop_fit::{CycleFit, LoopFit};
pub use record::{cycle, extract};
pub use strip_memory::{Relaxation, StripMemory};
pub use summary::bending_law;

impl FrictionLaw {
    /// The law of bend loops along a direction, with what KES-FB2 would read of it.
    pub fn of_bend_loops(direction: Direction, channel: Channel, settings: &Settings) -> Self {
        let mut law = Self {
            test: Test::Bending,
            direction: Some(direction),
            specimen: 0,
            strip: None,
            basis: Basis::BendLoops,
            thickness: None,
            channel,
            memory: None,
            fit: None,
            closed_form: None,
            values: BTreeMap::new(),
            backbone_stiffness: None,
        };
        law.evaluate(&standard_conditions(Test::Bending), settings);
        law
    }

    /// Finds the values of the law in a cycle under the conditions of a test.
    fn evaluate(&mut self, conditions: &Conditions, settings: &Settings) {
        self.values = extract(self, conditions, settings);
        self.backbone_stiffness = self.elastic(conditions, settings);
    }
}

/// A measured cycle beside the law, sample by sample; abscissae are those of the test (SI).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LawTrace {
    /// Cycle, from 0.
    pub cycle: usize,
    /// Whether the law was fitted to it; a prediction otherwise.
    pub fitted: bool,
    /// Abscissae.
    pub x: Vec<f64>,
    /// Measured ordinates, as many.
    pub measured: Vec<f64>,
    /// Ordinates of the law.
    pub law: Vec<f64>,
    /// Ordinates of the straight line through the fitted cycle.
    pub line: Vec<f64>,
}

impl FrictionLaw {
    /// The cycles behind the law, from the sheet that holds it; none for a law from summary values.
    pub fn traces(&self, sheet: &FabricSheet) -> Vec<LawTrace> {
        let Some(fit) = &self.fit else { return Vec::new() };
        let mut traces = Vec::new();
        for (cycle, path, law) in self.cycles(sheet) {
            let Path { strain, stress, fitted, .. } = path;
            traces.push(LawTrace {
                cycle,
                fitted: cycle == fit.fitted.cycle,
                x: strain[fitted.clone()].iter().map(|e| self.abscissa(*e)).collect(),
                measured: stress[fitted.clone()].to_vec(),
                law: law[fitted.clone()].to_vec(),
                line: strain[fitted].iter().map(|e| fit.line[0] + fit.line[1] * e).collect(),
            });
        }
        traces
    }

    /// Number, path and stresses of the law of each measured cycle.
    fn cycles(&self, sheet: &FabricSheet) -> Vec<(usize, Path, Vec<f64>)> {
        let mine = |s: &&SpecimenResult| {
            let m = &s.measurement;
            (m.test, m.direction, m.specimen) == (self.test, self.direction, self.specimen)
        };
        let one_sided = self.channel.is_one_sided();
        let found = if let Some(index) = self.strip {
            let history = sheet.strips.get(index).and_then(strip::history);
            history.map(|h| (h.path, h.cycles, h.time))
        } else {
            let specimen = sheet.specimens.iter().find(mine);
            let path = specimen.and_then(|s| path(s, self.thickness, one_sided, CycleChoice::First));
            path.map(|(path, cycles)| (path, cycles, Vec::new()))
        };
        let Some((path, cycles, time)) = found else { return Vec::new() };
        let law = stresses(&self.channel, self.memory.as_ref(), &path.strain, &time);
        let cycle = |(i, range): (usize, std::ops::Range<usize>)| {
            (i, Path { fitted: range, ..path.clone() }, law.clone())
        };
        cycles.into_iter().enumerate().filter(|(_, r)| !r.is_empty()).map(cycle).collect()
    }
}

/// A parameter measured, and re-extracted from the simulated cycles of the laws.
#[derive(Clone, Debug, PartialEq)]
pub struct ReExtracted {
    /// Parameter and direction.
    pub key: Key,
    /// Over the laws: one a specimen, or that from summary values (SI).
    pub simulated: Estimate,
    /// As the sheet has it (SI).
    pub measured: Estimate,
    /// Whether the laws rest on loops.
    pub from_loops: bool,
}

impl FabricSheet {
    /// Every parameter that both the instrument and a law give, in order of parameter and direction.
    pub fn re_extracted(&self) -> Vec<ReExtracted> {
        self.values.iter().filter_map(|(key, measured)| self.re_extracted_value(*key, measured)).collect()
    }

    fn re_extracted_value(&self, key: Key, measured: &Estimate) -> Option<ReExtracted> {
        // The values of bend loops are read from the law itself: nothing else measured them.
        let mine = |l: &&FrictionLaw| {
            Some(l.test) == key.parameter.test()
                && l.direction == key.direction
                && l.basis != Basis::BendLoops
        };
        let laws = || self.laws.iter().filter(mine);
        let values: Vec<f64> = laws().filter_map(|l| l.values.get(&key.parameter).copied()).collect();
        Some(ReExtracted {
            key,
            simulated: Estimate::of(&values)?,
            measured: measured.clone(),
            from_loops: laws().any(|l| l.basis == Basis::Loop),
        })
    }
}

/// Adds the laws to a sheet.
pub(super) fn add(sheet: &mut FabricSheet, settings: &Settings) {
    // A sweep over a surface is no law of the cloth.
    let looped = |s: &&SpecimenResult| s.measurement.test.shape() != Shape::Sweep;
    let specimens: Vec<&SpecimenResult> = sheet.specimens.iter().filter(looped).collect();
    let found: Vec<_> = platform::map(&specimens, |s| of_specimen(s, settings));
    for (specimen, law) in specimens.into_iter().zip(found) {
        match law {
            Ok(law) => sheet.laws.push(law),
            Err(why) => sheet.findings.push(none(specimen, why)),
        }
    }
    for (i, strip) in sheet.strips.iter().enumerate() {
        match strip::law(i, strip) {
            Ok(law) => sheet.laws.push(law),
            Err(reason) => {
                let subject = Subject::Strip { strip: strip.kind.name().into(), direction: strip.direction };
                let reason = reason.to_string();
                sheet.findings.push(Finding::new(EvaluationFact::NoLaw { subject, reason }));
            }
        }
    }
    summary::add(sheet, settings);
}

/// The stresses of a law along strains from cloth never deformed. `time` in samples, for what relaxes.
fn stresses(channel: &Channel, memory: Option<&StripMemory>, strain: &[f64], time: &[f64]) -> Vec<f64> {
    let Some(memory) = memory else {
        return channel.path(Default::default(), strain.iter().copied()).map(|r| r.stress).collect();
    };
    let strain = memory.effective(strain);
    let Some(relaxation) = &memory.relaxation else {
        return channel.path(Default::default(), strain).map(|r| r.stress).collect();
    };
    // The strip is slack where both together would push.
    let arm = relaxation.stresses(&strain, time);
    let channel = channel.uncut();
    let both = channel.path(Default::default(), strain).zip(arm).map(|(r, arm)| r.stress + arm);
    both.map(|stress| stress.max(0.0)).collect()
}

/// A law that misses its own loop by more than this part of the span is none: the stress falls, or the
/// record is no loop.
const WORST_FIT: f64 = 0.1;

/// A way back is one that goes over this part of the way out at least.
const BACK: f64 = 0.5;
/// A loop that gives more work than this part of its spans' product is run through the wrong way.
const GIVEN: f64 = 0.005;

/// The law of a specimen, or why its record is none that a law can follow.
fn of_specimen(specimen: &SpecimenResult, settings: &Settings) -> Result<FrictionLaw, &'static str> {
    if !returns(specimen, settings.cycle) {
        return Err("it has no way back, and so no loop");
    }
    let law = fitted(specimen, settings).ok_or("its loop has too few samples or is not one of cloth")?;
    let gives = law.fit.as_ref().is_some_and(|fit| fit.fitted.work < -GIVEN);
    if gives {
        Err("its loop gives work instead of taking it: is the way back the way out?")
    } else {
        Ok(law)
    }
}

/// Whether the drive comes back in the chosen cycle: the strain, or the force of a test that is driven by it.
fn returns(specimen: &SpecimenResult, choice: CycleChoice) -> bool {
    let by_force = specimen.measurement.test.shape() == Shape::Rise;
    let length = |b: &Branch| {
        let driven = if by_force { &b.curve.y } else { &b.curve.x };
        driven.first().zip(driven.last()).map_or(0.0, |(a, z)| (z - a).abs())
    };
    let cycle = specimen.cycle(choice);
    let longest = |outgoing: bool| {
        let mine = specimen.branches.iter().filter(|b| Some(b.cycle) == cycle && b.outgoing == outgoing);
        mine.map(length).fold(0.0, f64::max)
    };
    longest(false) > BACK * longest(true)
}

/// The law of the chosen cycle; `None` if its loop is not one that the law can follow.
fn fitted(specimen: &SpecimenResult, settings: &Settings) -> Option<FrictionLaw> {
    let m = &specimen.measurement;
    let thickness = match m.test {
        Test::Compression => Some(match specimen.values.get(&Parameter::T0) {
            Some(t0) => *t0,
            None => *specimen.branches.first()?.curve.x.first()?,
        }),
        _ => None,
    };
    let one_sided = m.test.shape() == Shape::Rise;
    let (path, cycles) = path(specimen, thickness, one_sided, settings.cycle)?;
    let channel = if one_sided { identify::one_sided(&path)? } else { identify::two_sided(&path)? };
    let fit = LoopFit::of(&stresses(&channel, None, &path.strain, &[]), &path, &cycles);
    if fit.fitted.nrmse.is_nan() || fit.fitted.nrmse > WORST_FIT {
        return None;
    }
    let closed_form = (m.test == Test::Bending).then(|| ClosedForm::of(&path)).flatten();
    let mut law = FrictionLaw {
        test: m.test,
        direction: m.direction,
        specimen: m.specimen,
        strip: None,
        basis: Basis::Loop,
        thickness,
        channel,
        memory: None,
        fit: Some(fit),
        closed_form,
        values: BTreeMap::new(),
        backbone_stiffness: None,
    };
    law.evaluate(&specimen.conditions(settings.cycle), settings);
    Some(law)
}

/// K041: a loop that was recorded, but has no law.
fn none(specimen: &SpecimenResult, why: &str) -> Finding {
    let m = &specimen.measurement;
    let (subject, reason) = (Subject::Record(m.record_name()), why.to_string());
    Finding::new(EvaluationFact::NoLaw { subject, reason }).at(Place::file(&m.source.path))
}

/// The corrected record as one path of strain and stress, and the samples of each cycle. Of a
/// one-sided test the samples at strains below zero are left out: the cloth is slack.
fn path(
    specimen: &SpecimenResult,
    thickness: Option<f64>,
    one_sided: bool,
    choice: CycleChoice,
) -> Option<(Path, Vec<std::ops::Range<usize>>)> {
    let mut path = Path::default();
    let mut ends: Vec<usize> = Vec::new();
    for branch in &specimen.branches {
        // Branches share the sample at which they meet.
        let joined = |x: f64, y: f64| path.strain.last() == Some(&x) && path.stress.last() == Some(&y);
        let points: Vec<(f64, f64)> =
            branch.curve.points().map(|(x, y)| (thickness.map_or(x, |t| t - x), y)).collect();
        let skip = usize::from(points.first().is_some_and(|p| joined(p.0, p.1)));
        for (e, s) in points.into_iter().skip(skip).filter(|p| !one_sided || p.0 >= 0.0) {
            path.strain.push(e);
            path.stress.push(s);
        }
        ends.resize((branch.cycle + 1).max(ends.len()), 0);
        ends[branch.cycle] = path.strain.len();
    }
    let starts = std::iter::once(0).chain(ends.iter().copied());
    let cycles: Vec<_> = starts.zip(&ends).map(|(a, b)| a..*b).collect();
    path.fitted = match choice {
        CycleChoice::First => cycles.first(),
        CycleChoice::Last => cycles.last(),
    }?
    .clone();
    Some((path, cycles))
}

#[cfg(test)]
mod tests;
