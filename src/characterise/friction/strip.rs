//! The law of a FAB strip: its last cycle fitted, the ones before it predicted.

use std::collections::BTreeMap;
use std::ops::Range;

use super::identify::{Path, relaxing};
use super::strip_memory::{LAG, StripMemory};
use super::{BACK, Basis, CycleFit, FrictionLaw, GIVEN, LoopFit, WORST_FIT, stresses};
use crate::characterise::{Branch, StripTest};
use crate::instrument::Test;
use crate::instrument::fab::FabKind;

/// The law of the last cycle, after the ones before it: the strip remembers them. Strains of all cycles count from
/// the onset of load of the last. The first cycle gives one number, where its load begins; nothing else of the cycles before the
/// last has a part in the law.
///
/// # Errors
/// Why the strip has none.
pub(super) fn law(index: usize, strip: &StripTest) -> Result<FrictionLaw, &'static str> {
    let law = fitted(index, strip).ok_or("its last cycle has too few samples")?;
    let fit = law.fit.as_ref().map_or(CycleFit::default(), |fit| fit.fitted);
    if !returns(strip) {
        Err("its last cycle has no way back, and so no loop")
    } else if fit.nrmse.is_nan() || fit.nrmse > WORST_FIT {
        Err("its last cycle is not one that a law can follow")
    } else if fit.work < -GIVEN {
        Err("its loop gives work instead of taking it: is the way back the way out?")
    } else {
        Ok(law)
    }
}

/// Whether the clamps come back in the last cycle.
fn returns(strip: &StripTest) -> bool {
    let travel = |outgoing: bool| {
        let last = strip.cycles.last().into_iter().flat_map(|c| &c.branches);
        let length = |b: &Branch| b.curve.x.first().zip(b.curve.x.last()).map_or(0.0, |(a, z)| (z - a).abs());
        last.filter(|b| b.outgoing == outgoing).map(length).fold(0.0, f64::max)
    };
    travel(false) > BACK * travel(true)
}

fn fitted(index: usize, strip: &StripTest) -> Option<FrictionLaw> {
    let History { path, cycles, time, mut memory } = history(strip)?;
    let along = Path { strain: memory.effective(&path.strain), ..path.clone() };
    let (channel, relaxation) = relaxing(&along, Some(&time))?;
    memory.relaxation = relaxation;
    let fit = LoopFit::of(&stresses(&channel, Some(&memory), &path.strain, &time), &path, &cycles);
    Some(FrictionLaw {
        test: Test::Tensile,
        direction: Some(strip.direction),
        specimen: number(strip),
        strip: Some(index),
        basis: Basis::Strip,
        thickness: None,
        channel,
        memory: Some(memory),
        fit: Some(fit),
        closed_form: None,
        values: BTreeMap::new(),
        backbone_stiffness: None,
    })
}

/// 1 for the short, 2 for the long clamp distance.
pub(super) fn number(strip: &StripTest) -> usize {
    if strip.kind == FabKind::S1 { 1 } else { 2 }
}

/// All cycles of a strip as one path.
pub(super) struct History {
    /// Strains from the onset of load in the last cycle, which is fitted. A strip that is slack has no sample.
    pub path: Path,
    /// The samples of each cycle.
    pub cycles: Vec<Range<usize>>,
    /// The place of each sample in the record.
    pub time: Vec<f64>,
    /// How the strip grows.
    pub memory: StripMemory,
}

/// The recorded cycles; `None` if the clamps never pass the onset of the last.
pub(super) fn history(strip: &StripTest) -> Option<History> {
    let mut force = Vec::new();
    let mut distance = Vec::new();
    let mut ends = vec![0];
    for cycle in &strip.cycles {
        for (e, f) in cycle.branches.iter().flat_map(|b| b.curve.points()) {
            distance.push((1.0 + e) * cycle.onset);
            force.push(f);
        }
        ends.push(force.len());
    }
    // Clamps at a place between samples.
    let at = |place: f64| {
        let i = (place as usize).min(distance.len() - 1);
        let next = distance[(i + 1).min(distance.len() - 1)];
        distance[i] + (place - i as f64).min(1.0) * (next - distance[i])
    };
    // The onset of a cycle lies where its clamps pass it for the first time.
    let onset_of = |cycle: usize| {
        let (start, onset) = (ends[cycle], strip.cycles[cycle].onset);
        let above = (start..force.len()).find(|&i| distance[i] > onset)?;
        Some(match above.checked_sub(1).filter(|i| *i >= start) {
            Some(i) => at(i as f64 + (onset - distance[i]) / (distance[above] - distance[i]) + LAG),
            None => at(above as f64 + LAG),
        })
    };
    let last = strip.cycles.len().checked_sub(1)?;
    let gauge = onset_of(last)?;
    let strain: Vec<f64> = (0..force.len()).map(|i| at(i as f64 + LAG) / gauge - 1.0).collect();
    let greatest = strain[..ends[last]].iter().copied().fold(0.0, f64::max);
    let memory = StripMemory::of(onset_of(0)? / gauge - 1.0, greatest);
    let taut = memory.effective(&strain).into_iter().map(|e| e >= 0.0).collect::<Vec<bool>>();
    let (mut path, mut time, mut cycles) = (Path::default(), Vec::new(), Vec::new());
    for cycle in ends.windows(2) {
        let start = time.len();
        for i in (cycle[0]..cycle[1]).filter(|&i| taut[i]) {
            path.strain.push(strain[i]);
            path.stress.push(force[i]);
            time.push(i as f64);
        }
        cycles.push(start..time.len());
    }
    path.fitted = cycles.last()?.clone();
    Some(History { path, cycles, time, memory })
}
