//! A simulated test, and its distance from the measured one.

use serde::{Deserialize, Serialize};

use crate::quantity::Curve;

/// How far a simulated curve is from a measured one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Agreement {
    /// Root mean square difference (N).
    pub rmse: f64,
    /// That over the span of the measured forces.
    pub nrmse: f64,
    /// 1 - SS_residual / SS_total.
    pub r2: f64,
    /// Samples compared.
    pub n: usize,
}

impl Agreement {
    pub(super) fn of(measured: &[f64], simulated: &[f64]) -> Option<Self> {
        let n = measured.len();
        let mean = measured.iter().sum::<f64>() / n as f64;
        let low = measured.iter().copied().fold(f64::INFINITY, f64::min);
        let high = measured.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let residual: f64 = measured.iter().zip(simulated).map(|(m, s)| (s - m).powi(2)).sum();
        let total: f64 = measured.iter().map(|m| (m - mean).powi(2)).sum();
        let rmse = (residual / n as f64).sqrt();
        (n > 1 && high > low).then(|| Self {
            rmse,
            nrmse: rmse / (high - low),
            r2: 1.0 - residual / total,
            n,
        })
    }
}

/// A simulated test and its distance from the measured one.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulated {
    /// Force (N) at the measured distances (m), the zero of the load added.
    pub force: Curve,
    /// Zero of the load (N): mean measured minus simulated force of the outermost cycle.
    pub zero: f64,
    /// Over the outermost cycle.
    pub outer: Option<Agreement>,
    /// Over the cycles before it, predicted; none if there is one cycle only.
    pub inner: Option<Agreement>,
    /// The same with a zero of their own, as the load drifts in the course of a test.
    pub inner_with_own_zero: Option<Agreement>,
}
