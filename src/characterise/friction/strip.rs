//! The law of a FAB strip: its last cycle fitted, the ones before it predicted.

use std::collections::BTreeMap;
use std::ops::Range;

use super::conditioning::{Conditioning, EXPONENT};
use super::identify::{Path, lowest, one_sided};
use super::{BACK, Basis, CycleFit, FrictionLaw, GIVEN, LoopFit, WORST_FIT, stresses};
use crate::characterise::{Branch, Strip};
use crate::instrument::Test;
use crate::instrument::fab::FabKind;
use crate::law::Channel;

/// Lags that are tried first (samples): both readings of a sample are taken within its interval. The lag that fits best
/// takes up what it can of another cause too, above all of stress that relaxes while the clamps stop and turn.
const LAGS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// The lag is known to this (samples).
const LAG_KNOWN: f64 = 0.02;

/// The law of the last cycle, after the ones before it: the strip remembers them. Strains of all cycles count from
/// the onset of load of the last, so that what the strip has grown by since is part of what is predicted.
///
/// # Errors
/// Why the strip has none.
pub(super) fn law(index: usize, strip: &Strip) -> Result<FrictionLaw, &'static str> {
    let law = with_exponent(index, strip, EXPONENT).ok_or("its last cycle has too few samples")?;
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
fn returns(strip: &Strip) -> bool {
    let way = |outgoing: bool| {
        let last = strip.cycles.last().into_iter().flat_map(|c| &c.branches);
        let length = |b: &Branch| b.curve.x.first().zip(b.curve.x.last()).map_or(0.0, |(a, z)| (z - a).abs());
        last.filter(|b| b.outgoing == outgoing).map(length).fold(0.0, f64::max)
    };
    way(false) > BACK * way(true)
}

/// The same with another exponent of conditioning.
pub(super) fn with_exponent(index: usize, strip: &Strip, exponent: f64) -> Option<FrictionLaw> {
    let missed =
        |lag: f64| fitted(strip, exponent, lag).map_or(f64::INFINITY, |(_, _, fit)| fit.fitted.nrmse);
    let lag = lowest(&LAGS, LAG_KNOWN, missed);
    let (channel, conditioning, fit) = fitted(strip, exponent, lag)?;
    Some(FrictionLaw {
        test: Test::Tensile,
        direction: Some(strip.direction),
        specimen: number(strip),
        strip: Some(index),
        basis: Basis::Strip,
        thickness: None,
        channel,
        conditioning: Some(conditioning),
        fit: Some(fit),
        closed_form: None,
        values: BTreeMap::new(),
        backbone_stiffness: None,
    })
}

fn fitted(strip: &Strip, exponent: f64, lag: f64) -> Option<(Channel, Conditioning, LoopFit)> {
    let (path, cycles) = history(strip, lag)?;
    let greatest = path.strain[..path.fitted.end].iter().copied().fold(0.0, f64::max);
    let conditioning = Conditioning { exponent, greatest, lag };
    let factors = conditioning.factors(&path.strain);
    let alike = |v: &[f64]| v.iter().zip(&factors).map(|(v, r)| v / r).collect();
    let (strain, stress) = (alike(&path.strain), alike(&path.stress));
    let channel = one_sided(&Path { strain, stress, fitted: path.fitted.clone() })?;
    let fit = LoopFit::of(&stresses(&channel, Some(&conditioning), &path), &path, &cycles);
    Some((channel, conditioning, fit))
}

/// 1 for the short, 2 for the long clamp distance.
pub(super) fn number(strip: &Strip) -> usize {
    if strip.kind == FabKind::S1 { 1 } else { 2 }
}

/// All cycles as one path, of which the last is fitted, and the samples of each; strains count from the onset of load
/// of the last one. The slack strip is left out. A force stands beside the clamps as they are `lag` samples later.
pub(super) fn history(strip: &Strip, lag: f64) -> Option<(Path, Vec<Range<usize>>)> {
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
    // The onset of the last cycle lies where its clamps pass it for the first time.
    let (last, onset) = (ends[strip.cycles.len().checked_sub(1)?], strip.cycles.last()?.onset);
    let above = (last..force.len()).find(|&i| distance[i] > onset)?;
    let gauge = match above.checked_sub(1).filter(|i| *i >= last) {
        Some(i) => at(i as f64 + (onset - distance[i]) / (distance[above] - distance[i]) + lag),
        None => at(above as f64 + lag),
    };
    let (mut path, mut cycles) = (Path::default(), Vec::new());
    for cycle in ends.windows(2) {
        let start = path.strain.len();
        for (i, f) in force.iter().enumerate().take(cycle[1]).skip(cycle[0]) {
            let e = at(i as f64 + lag) / gauge - 1.0;
            if e >= 0.0 {
                path.strain.push(e);
                path.stress.push(*f);
            }
        }
        cycles.push(start..path.strain.len());
    }
    path.fitted = cycles.last()?.clone();
    Some((path, cycles))
}
