//! The law of a FAB strip: its last cycle fitted, the ones before it predicted.

use std::collections::BTreeMap;

use super::identify::{Path, one_sided};
use super::loop_fit::line;
use super::{Basis, CycleFit, FrictionLaw, LoopFit};
use crate::characterise::{Strip, StripCycle};
use crate::instrument::Test;
use crate::instrument::fab::FabKind;
use crate::law::State;

/// The law of the last cycle. Strains of all cycles count from its onset of load, so that what the
/// strip has grown by since is part of what is predicted.
pub(super) fn law(strip: &Strip) -> Option<FrictionLaw> {
    let mut unseen = paths(strip);
    let path = unseen.pop()?;
    let channel = one_sided(&path)?;
    let line = line(&path.strain, &path.stress);
    let fit = |(cycle, path): (usize, &Path)| {
        let law: Vec<f64> =
            channel.path(State::default(), path.strain.iter().copied()).map(|r| r.stress).collect();
        CycleFit::of(cycle, &path.strain, &path.stress, &law, line)
    };
    let span = path.stress.iter().copied().fold(0.0, f64::max);
    let fit = LoopFit {
        fitted: fit((unseen.len(), &path)),
        unseen: unseen.iter().enumerate().filter(|(_, p)| p.strain.len() > 3).map(fit).collect(),
        noise: path.noise() / span,
        line,
    };
    Some(FrictionLaw {
        test: Test::Tensile,
        direction: Some(strip.direction),
        specimen: number(strip),
        basis: Basis::Strip,
        thickness: None,
        channel,
        fit: Some(fit),
        closed_form: None,
        values: BTreeMap::new(),
    })
}

/// 1 for the short, 2 for the long clamp distance.
pub(super) fn number(strip: &Strip) -> usize {
    if strip.kind == FabKind::S1 { 1 } else { 2 }
}

/// The cycles, with strains from the onset of load of the last one.
pub(super) fn paths(strip: &Strip) -> Vec<Path> {
    let Some(last) = strip.cycles.last() else { return Vec::new() };
    strip.cycles.iter().map(|c| path(c, last.onset)).collect()
}

/// The samples beyond the length `gauge` (m), with strains of that length.
fn path(cycle: &StripCycle, gauge: f64) -> Path {
    let longer = cycle.onset / gauge;
    let points = cycle.branches.iter().flat_map(|b| b.curve.points());
    let (strain, stress): (Vec<f64>, Vec<f64>) =
        points.map(|(e, f)| ((1.0 + e) * longer - 1.0, f)).filter(|p| p.0 >= 0.0).unzip();
    Path { fitted: 0..strain.len(), strain, stress }
}
