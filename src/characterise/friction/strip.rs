//! The law of a FAB strip: its last cycle fitted, the ones before it predicted.

use std::collections::BTreeMap;
use std::ops::Range;

use super::identify::{Path, one_sided};
use super::{Basis, FrictionLaw, LoopFit};
use crate::characterise::Strip;
use crate::instrument::Test;
use crate::instrument::fab::FabKind;

/// The law of the last cycle, after the ones before it: the strip remembers them. Strains of all cycles count from
/// the onset of load of the last, so that what the strip has grown by since is part of what is predicted.
pub(super) fn law(strip: &Strip) -> Option<FrictionLaw> {
    let (path, cycles) = history(strip)?;
    let channel = one_sided(&path)?;
    let fit = LoopFit::of(&channel, &path, &cycles);
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

/// All cycles as one path, of which the last is fitted, and the samples of each; strains count from the onset of load
/// of the last one. The slack strip is left out.
pub(super) fn history(strip: &Strip) -> Option<(Path, Vec<Range<usize>>)> {
    let gauge = strip.cycles.last()?.onset;
    let (mut path, mut cycles) = (Path::default(), Vec::new());
    for cycle in &strip.cycles {
        let (start, longer) = (path.strain.len(), cycle.onset / gauge);
        let points = cycle.branches.iter().flat_map(|b| b.curve.points());
        for (e, f) in points.map(|(e, f)| ((1.0 + e) * longer - 1.0, f)).filter(|p| p.0 >= 0.0) {
            path.strain.push(e);
            path.stress.push(f);
        }
        cycles.push(start..path.strain.len());
    }
    path.fitted = cycles.last()?.clone();
    Some((path, cycles))
}
