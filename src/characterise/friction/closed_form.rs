//! Friction and rigidity of a bending loop without a fit.

use serde::{Deserialize, Serialize};

use super::identify::Path;
use super::loop_fit::line;

/// Half of a loop's width where everything slips, and the slope of what is left of the falling
/// branch without it: `E = M_down + Y`.
///
/// By Masing's rule the branch that comes up from the lowest curvature `-k` is `M_down` there and
/// `2 H` above it: `H(u) = [M_up(-k + 2u) - M_down(-k + 2u)] / 2` levels off at Y. Within 2 to 9 %
/// of 2HB/2 and 1.5 % of the elastic slope.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ClosedForm {
    /// Y, half of 2HB (N).
    pub moment: f64,
    /// Slope of E (N·m).
    pub rigidity: f64,
}

/// Where everything slips on the way up from `-k`, as parts of `k`.
const SLIDING: [f64; 2] = [-0.6, -0.1];
/// Where the slope is taken on the way down.
const SLOPE: [f64; 2] = [-0.6, 0.6];

impl ClosedForm {
    /// From a path 0, +k, -k, 0; `None` if it is another.
    pub(super) fn of(path: &Path) -> Option<Self> {
        let range = path.fitted.clone();
        let by = |i: &usize, j: &usize| path.strain[*i].total_cmp(&path.strain[*j]);
        let (top, bottom) = (range.clone().max_by(by)?, range.clone().min_by(by)?);
        let k = path.strain[top].min(-path.strain[bottom]);
        if !(top < bottom && k > 0.0) {
            return None;
        }
        let inside = |i: &usize, window: [f64; 2]| (window[0] * k..=window[1] * k).contains(&path.strain[*i]);
        let collect = |range: std::ops::Range<usize>, window| -> [Vec<f64>; 2] {
            let (x, y) =
                range.filter(|i| inside(i, window)).map(|i| (path.strain[i], path.stress[i])).unzip();
            [x, y]
        };
        let [up, down] = [bottom..range.end, top..bottom].map(|r| collect(r, SLIDING));
        let slope = collect(top..bottom, SLOPE);
        if [&up[0], &down[0], &slope[0]].iter().any(|x| x.len() < 4) {
            return None;
        }
        // The branches are sampled at different curvatures: their lines are compared in the middle.
        let middle = 0.5 * (SLIDING[0] + SLIDING[1]) * k;
        let [up, down] = [up, down].map(|[x, y]| line(&x, &y)).map(|[a, b]| a + b * middle);
        let rigidity = line(&slope[0], &slope[1])[1];
        Some(Self { moment: 0.5 * (up - down), rigidity }).filter(|c| c.moment > 0.0 && c.rigidity > 0.0)
    }
}
