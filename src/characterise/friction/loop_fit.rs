//! How well a law follows a measured loop, beside a straight line.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::identify::Path;

/// A loop of less than this part of the product of its spans is a line with noise.
const NO_LOOP: f64 = 1e-4;

/// A law beside the loop that it was identified from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LoopFit {
    /// The fitted cycle.
    pub fitted: CycleFit,
    /// Cycles that were not fitted: predictions.
    pub unseen: Vec<CycleFit>,
    /// Standard deviation of the noise of the record over its span.
    pub noise: f64,
    /// The straight line fitted to the same samples: its ordinate at strain 0 and its slope (SI).
    pub line: [f64; 2],
}

/// Simulated beside measured stress over one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CycleFit {
    /// Cycle, from 0.
    pub cycle: usize,
    /// Root mean square difference over the measured span of this cycle.
    pub nrmse: f64,
    /// Coefficient of determination.
    pub r_squared: f64,
    /// Area of the measured loop over the product of its spans; below zero where the test gives work.
    pub work: f64,
    /// Area of the loop, simulated over measured, less 1; `None` of a loop without an area.
    pub loop_energy: Option<f64>,
    /// NRMSE of the straight line.
    pub line_nrmse: f64,
}

impl LoopFit {
    /// The stresses of a law along the path, cycle by cycle.
    pub(super) fn of(law: &[f64], path: &Path, cycles: &[Range<usize>]) -> Self {
        let line = line(&path.strain[path.fitted.clone()], &path.stress[path.fitted.clone()]);
        let fits: Vec<CycleFit> = (cycles.iter().enumerate())
            .filter(|(_, range)| range.len() > 3)
            .map(|(cycle, range)| {
                let [e, measured, law] = [&path.strain[..], &path.stress, law].map(|v| &v[range.clone()]);
                CycleFit::of(cycle, e, measured, law, line)
            })
            .collect();
        let fitted = |f: &&CycleFit| cycles[f.cycle] == path.fitted;
        let span = span(&path.stress[path.fitted.clone()]);
        Self {
            fitted: fits.iter().find(fitted).copied().unwrap_or_default(),
            unseen: fits.iter().filter(|f| !fitted(f)).copied().collect(),
            noise: path.noise() / span,
            line,
        }
    }
}

impl CycleFit {
    /// Of one cycle: strains, measured stresses, those of the law, and a line.
    pub(super) fn of(cycle: usize, strain: &[f64], measured: &[f64], law: &[f64], line: [f64; 2]) -> Self {
        let n = measured.len() as f64;
        let squares =
            |f: &dyn Fn(usize) -> f64| (0..measured.len()).map(|i| (f(i) - measured[i]).powi(2)).sum::<f64>();
        let mean = measured.iter().sum::<f64>() / n;
        let (of_law, of_mean) = (squares(&|i| law[i]), squares(&|_| mean));
        let of_line = squares(&|i| line[0] + line[1] * strain[i]);
        let span = span(measured);
        let box_area = span * self::span(strain);
        let work = area(strain, measured) / box_area;
        Self {
            cycle,
            nrmse: (of_law / n).sqrt() / span,
            r_squared: 1.0 - of_law / of_mean,
            work,
            loop_energy: (work.abs() > NO_LOOP).then(|| area(strain, law) / box_area / work - 1.0),
            line_nrmse: (of_line / n).sqrt() / span,
        }
    }
}

/// The least-squares line: ordinate at 0 and slope.
pub(super) fn line(x: &[f64], y: &[f64]) -> [f64; 2] {
    let n = x.len() as f64;
    let [mx, my] = [x, y].map(|v| v.iter().sum::<f64>() / n);
    let xx: f64 = x.iter().map(|x| (x - mx).powi(2)).sum();
    let xy: f64 = x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum();
    let slope = xy / xx;
    [my - slope * mx, slope]
}

fn span(values: &[f64]) -> f64 {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
}

/// Work along a path, closed by a straight line: the area of its loop.
fn area(x: &[f64], y: &[f64]) -> f64 {
    let open: f64 = (1..x.len()).map(|i| 0.5 * (y[i] + y[i - 1]) * (x[i] - x[i - 1])).sum();
    let n = x.len() - 1;
    open + 0.5 * (y[n] + y[0]) * (x[0] - x[n])
}
