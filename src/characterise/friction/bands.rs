//! The loops of the laws of one fabric over its specimens: their mean, and how certain it is.

use serde::Serialize;

use super::{Basis, FrictionLaw, cycle};
use crate::characterise::spread::{MeanBranch, mean_branch};
use crate::characterise::{FabricSheet, SpecimenResult};
use crate::instrument::{Direction, Test};
use crate::quantity::Curve;

/// The cycle of an instrument, simulated with the law of each specimen, and averaged.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LawBand {
    /// The test.
    pub test: Test,
    /// Yarn direction; `None` for compression.
    pub direction: Option<Direction>,
    /// Number of laws, one a specimen, at least 2.
    pub n: usize,
    /// The runs of the cycle in order: out, back (and out to the other side), and back from there.
    pub branches: Vec<MeanBranch>,
}

impl FabricSheet {
    /// The mean loop of the laws of each test and direction with its bands, as Student's t has them
    /// over the specimens. None where fewer than two specimens have a law.
    pub fn law_bands(&self) -> Vec<LawBand> {
        let mut groups: Vec<(Test, Option<Direction>, Vec<[Curve; 3]>)> = Vec::new();
        for law in self.laws.iter().filter(|l| l.basis == Basis::Loop) {
            let mine = |s: &&SpecimenResult| {
                let m = &s.measurement;
                (m.test, m.direction, m.specimen) == (law.test, law.direction, law.specimen)
            };
            let Some(specimen) = self.specimens.iter().find(mine) else { continue };
            let runs = runs(law, &cycle(law, &specimen.measurement.conditions));
            match groups.iter_mut().find(|(t, d, _)| (*t, *d) == (law.test, law.direction)) {
                Some((.., all)) => all.push(runs),
                None => groups.push((law.test, law.direction, vec![runs])),
            }
        }
        let band = |(test, direction, all): (Test, Option<Direction>, Vec<[Curve; 3]>)| {
            let of_run = |k: usize| {
                let curves: Vec<&Curve> = all.iter().map(|runs| &runs[k]).collect();
                mean_branch(test, direction, &curves)
            };
            let branches: Vec<MeanBranch> = (0..3).filter_map(of_run).collect();
            (!branches.is_empty()).then_some(LawBand { test, direction, n: all.len(), branches })
        };
        groups.into_iter().filter_map(band).collect()
    }
}

/// A cycle between its turning points; a test to one side has no third run.
fn runs(law: &FrictionLaw, cycle: &Curve) -> [Curve; 3] {
    let place = |sign: f64| {
        let strain = |i: &usize| sign * law.strain(cycle.x[*i]);
        (0..cycle.len()).max_by(|i, j| strain(i).total_cmp(&strain(j))).unwrap_or(0)
    };
    let (top, end) = (place(1.0), cycle.len().saturating_sub(1));
    let bottom = if law.channel.is_one_sided() { end } else { place(-1.0) };
    let run = |from: usize, to: usize| Curve::from_points(cycle.points().skip(from).take(to + 1 - from));
    if end == 0 || bottom < top {
        return Default::default();
    }
    [run(0, top), run(top, bottom), if bottom < end { run(bottom, end) } else { Curve::default() }]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characterise::characterise;
    use crate::instrument::Parameter;
    use approx::assert_relative_eq;

    /// Half of 2HB is half of the difference of the mean branches, and the band of the loop at a
    /// curvature is the t interval of the moments of the laws there; poplin (synthetic), n = 3.
    #[test]
    fn the_band_of_a_loop_is_that_of_its_laws() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data/poplin");
        let batch = crate::instrument::read_fabrics(&[folder], &Default::default(), &|_| ());
        let sheet = characterise(&batch.fabrics[0], &Default::default());
        let bands = sheet.law_bands();
        // Tension, shear and bending along warp and weft, and compression.
        assert_eq!(bands.len(), 7);
        assert!(bands.iter().all(|b| b.n == 3));
        let bending = |b: &&LawBand| (b.test, b.direction) == (Test::Bending, Some(Direction::Warp));
        let band = bands.iter().find(bending).unwrap();
        assert_eq!(band.branches.len(), 3);
        let at = |curve: &Curve, k: f64| {
            let i =
                (0..curve.len()).min_by(|i, j| (curve.x[*i] - k).abs().total_cmp(&(curve.x[*j] - k).abs()));
            curve.y[i.unwrap()]
        };
        let width = at(&band.branches[0].mean, 100.0) - at(&band.branches[1].mean, 100.0);
        let measured = sheet.get(Parameter::Hb, Some(Direction::Warp)).unwrap();
        assert_relative_eq!(width, measured.mean, max_relative = 0.05);
        let out = &band.branches[0];
        let (k, half) = (out.mean.x[60], out.high.y[60] - out.mean.y[60]);
        let moments: Vec<f64> = (sheet.laws.iter())
            .filter(|l| (l.test, l.direction) == (Test::Bending, Some(Direction::Warp)))
            .map(|l| l.channel.virgin(k).stress)
            .collect();
        let estimate = crate::quantity::Estimate::of(&moments).unwrap();
        // The cycle is taken in 250 steps.
        assert_relative_eq!(half, estimate.ci95().unwrap(), max_relative = 1e-2);
        // √(1 + 1/n) over √(1/n).
        assert_relative_eq!(out.next_specimen[1].y[60] - out.mean.y[60], 2.0 * half, max_relative = 1e-9);
    }
}
