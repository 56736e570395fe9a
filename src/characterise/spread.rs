//! The mean curve of repeats and how certain it is.

use serde::Serialize;

use super::graph::Graph;
use super::{FabricSheet, SpecimenResult};
use crate::instrument::{Direction, Shape, Test};
use crate::quantity::{Curve, Estimate};

/// The mean of one branch over the specimens of a direction, point by point along what the instrument
/// controls: the force of the tensile test and the pressure of the compression test (the mean strain or
/// thickness at each), the angle of the shear test and the curvature of the bending test (the mean force or
/// moment at each). SI; abscissae and ordinates are those of the test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeanBranch {
    /// Yarn direction; `None` for compression.
    pub direction: Option<Direction>,
    /// Number of specimens, at least 2.
    pub n: usize,
    /// The mean.
    pub mean: Curve,
    /// One end of the 95 % interval of the mean (Student t, n - 1 degrees of freedom) at each point.
    pub low: Curve,
    /// The other end.
    pub high: Curve,
    /// Both ends of the 95 % interval of one more specimen at each point.
    pub next_specimen: [Curve; 2],
}

/// Points along a branch.
const POINTS: usize = 100;

/// The mean branches of a test over all directions with two specimens or more, in recorded order. They reach
/// as far as every specimen does; specimens that were recorded in another number of branches than the first
/// of their direction are left out. Sweeps have none: their textures have no phase in common.
pub fn mean_branches(sheet: &FabricSheet, test: Test) -> Vec<MeanBranch> {
    if test.shape() == Shape::Sweep {
        return Vec::new();
    }
    let specimens: Vec<&SpecimenResult> =
        sheet.specimens.iter().filter(|s| s.measurement.test == test && !s.branches.is_empty()).collect();
    let mut directions: Vec<Option<Direction>> = specimens.iter().map(|s| s.measurement.direction).collect();
    directions.sort();
    directions.dedup();
    directions.into_iter().flat_map(|direction| mean_branches_along(&specimens, test, direction)).collect()
}

/// The mean branches of the specimens of a direction that have as many as the first.
fn mean_branches_along(
    specimens: &[&SpecimenResult],
    test: Test,
    direction: Option<Direction>,
) -> Vec<MeanBranch> {
    let along = || specimens.iter().filter(|s| s.measurement.direction == direction);
    let branches = along().next().map_or(0, |s| s.branches.len());
    let repeats: Vec<_> = along().filter(|s| s.branches.len() == branches).collect();
    let mean = |k: usize| {
        let curves: Vec<&Curve> = repeats.iter().map(|s| &s.branches[k].curve).collect();
        mean_branch(test, direction, &curves)
    };
    (0..branches).filter_map(mean).collect()
}

/// The mean of curves; `None` for fewer than two, or if they have no range in common.
pub(super) fn mean_branch(test: Test, direction: Option<Direction>, curves: &[&Curve]) -> Option<MeanBranch> {
    let along_ordinate = test.shape() == Shape::Rise;
    let turned = |c: &Curve| {
        if along_ordinate { Curve { x: c.y.clone(), y: c.x.clone() } } else { c.clone() }
    };
    let graphs: Vec<Graph> = curves.iter().map(|c| Graph::of(&turned(c))).collect();
    if graphs.len() < 2 {
        return None;
    }
    let from = graphs.iter().filter_map(|g| g.x.first()).copied().fold(f64::NEG_INFINITY, f64::max);
    let to = graphs.iter().filter_map(|g| g.x.last()).copied().fold(f64::INFINITY, f64::min);
    if from >= to {
        return None;
    }
    let mut points = Vec::with_capacity(POINTS + 1);
    for k in 0..=POINTS {
        let at = from + (to - from) * k as f64 / POINTS as f64;
        let values: Vec<f64> = graphs.iter().filter_map(|g| g.at(at)).collect();
        let estimate = Estimate::of(&values).filter(|e| e.n == graphs.len())?;
        points.push((at, estimate.mean, estimate.ci95()?));
    }
    let curve = |sign: f64| {
        let curve = Curve::from_points(points.iter().map(|(at, mean, half)| (*at, mean + sign * half)));
        turned(&curve)
    };
    let n = graphs.len();
    // The mean has SD/√n, and one more specimen SD √(1 + 1/n).
    let next = (n as f64 + 1.0).sqrt();
    let next_specimen = [curve(-next), curve(next)];
    Some(MeanBranch { direction, n, mean: curve(0.0), low: curve(-1.0), high: curve(1.0), next_specimen })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// y = 1 x, 2 x, 3 x: mean 2 x, SD x, half width t(0.975, 2)/√3 x = 2.484138 x (tables). Turned for a
    /// tensile test; the range is that common to all.
    #[test]
    fn three_lines_by_hand() {
        let line = |slope: f64, end: f64| Curve::from_points([(0.0, 0.0), (end, slope * end)]);
        let lines = [line(1.0, 4.0), line(2.0, 3.0), line(3.0, 5.0)];
        let refs: Vec<&Curve> = lines.iter().collect();
        let shear = mean_branch(Test::Shear, None, &refs).unwrap();
        assert_eq!((shear.n, shear.mean.len()), (3, POINTS + 1));
        assert_relative_eq!(*shear.mean.x.last().unwrap(), 3.0);
        assert_relative_eq!(*shear.mean.y.last().unwrap(), 6.0, max_relative = 1e-12);
        assert_relative_eq!(*shear.high.y.last().unwrap() - 6.0, 3.0 * 2.484_138, max_relative = 1e-6);
        let swapped: Vec<Curve> = lines.iter().map(|c| Curve { x: c.y.clone(), y: c.x.clone() }).collect();
        let tensile = mean_branch(Test::Tensile, None, &swapped.iter().collect::<Vec<_>>()).unwrap();
        assert_eq!((&tensile.low.x, &tensile.low.y), (&shear.low.y, &shear.low.x));
        assert_eq!(mean_branch(Test::Shear, None, &refs[..1]), None);
    }
}
