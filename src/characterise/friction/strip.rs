//! The law of a FAB strip: its last cycle fitted, the ones before it predicted.

use std::collections::BTreeMap;
use std::ops::Range;

use super::identify::{Path, one_sided};
use super::{Basis, FrictionLaw, LoopFit, stresses};
use crate::characterise::Strip;
use crate::instrument::Test;
use crate::instrument::fab::FabKind;

/// The law of the last cycle, after the ones before it: the strip remembers them. Strains of all cycles count from
/// the onset of load of the last, so that what the strip has grown by since is part of what is predicted.
pub(super) fn law(strip: &Strip) -> Option<FrictionLaw> {
    let (path, cycles) = history(strip)?;
    let (channel, relaxation) = one_sided(&path)?;
    let fit = LoopFit::of(&stresses(&channel, relaxation.as_ref(), &path), &path, &cycles);
    Some(FrictionLaw {
        test: Test::Tensile,
        direction: Some(strip.direction),
        specimen: number(strip),
        basis: Basis::Strip,
        thickness: None,
        channel,
        relaxation,
        fit: Some(fit),
        closed_form: None,
        values: BTreeMap::new(),
        backbone_stiffness: None,
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
    let (mut path, mut cycles, mut sample) = (Path::default(), Vec::new(), 0);
    for cycle in &strip.cycles {
        let (start, longer) = (path.strain.len(), cycle.onset / gauge);
        for (e, f) in cycle.branches.iter().flat_map(|b| b.curve.points()) {
            let e = (1.0 + e) * longer - 1.0;
            if e >= 0.0 {
                path.strain.push(e);
                path.stress.push(f);
                path.time.extend(strip.rate.map(|rate| f64::from(sample) / rate));
            }
            sample += 1;
        }
        cycles.push(start..path.strain.len());
    }
    path.fitted = cycles.last()?.clone();
    Some((path, cycles))
}
