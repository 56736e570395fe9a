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
    let (last, inner) = strip.cycles.split_last()?;
    let path = path(last, last.onset);
    let channel = one_sided(&path)?;
    let line = line(&path.strain, &path.stress);
    let fit = |(cycle, path): (usize, &Path)| {
        let law: Vec<f64> =
            channel.path(State::default(), path.strain.iter().copied()).map(|r| r.stress).collect();
        CycleFit::of(cycle, &path.strain, &path.stress, &law, line)
    };
    let unseen: Vec<Path> = inner.iter().map(|c| self::path(c, last.onset)).collect();
    let span = path.stress.iter().copied().fold(0.0, f64::max);
    let fit = LoopFit {
        fitted: fit((inner.len(), &path)),
        unseen: unseen.iter().enumerate().filter(|(_, p)| p.strain.len() > 3).map(fit).collect(),
        noise: path.noise() / span,
        line,
    };
    Some(FrictionLaw {
        test: Test::Tensile,
        direction: Some(strip.direction),
        specimen: if strip.kind == FabKind::S1 { 1 } else { 2 },
        basis: Basis::Strip,
        thickness: None,
        channel,
        fit: Some(fit),
        closed_form: None,
        values: BTreeMap::new(),
    })
}

/// The samples beyond the length `gauge` (m), with strains of that length.
fn path(cycle: &StripCycle, gauge: f64) -> Path {
    let longer = cycle.onset / gauge;
    let points = cycle.branches.iter().flat_map(|b| b.curve.points());
    let (strain, stress): (Vec<f64>, Vec<f64>) =
        points.map(|(e, f)| ((1.0 + e) * longer - 1.0, f)).filter(|p| p.0 >= 0.0).unzip();
    Path { fitted: 0..strain.len(), strain, stress }
}
