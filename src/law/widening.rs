//! How slip levels grow with the strain.

use serde::{Deserialize, Serialize};

use super::{Backbone, LawError};

/// The factor `q(e) >= 0` on the slip levels of a family of sliders. Beyond the strain that the
/// law was measured to, `q` stays as it is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Widening {
    /// `q = 1`.
    Constant,
    /// `q = 1 + alpha (|e| / e_max)²`.
    Quadratic {
        /// Growth from strain 0 to `e_max`.
        alpha: f64,
        /// Greatest strain of the measurement.
        e_max: f64,
    },
    /// `q` = a loading curve through the origin over its value at its last knot, 0 below the
    /// origin: friction in proportion to the load.
    Loading(Backbone),
}

/// `q` with its derivative with respect to, and its integral over, the size of the strain.
pub(super) struct Growth {
    pub q: f64,
    pub slope: f64,
    pub integral: f64,
}

impl Widening {
    /// `q` at a strain.
    pub fn factor(&self, strain: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Quadratic { alpha, e_max } => 1.0 + alpha * (strain / e_max).powi(2).min(1.0),
            Self::Loading(_) => self.growth(strain).q,
        }
    }

    /// `q` at a strain, with its derivative and integral along the way out from strain 0 on that side.
    pub(super) fn growth(&self, strain: f64) -> Growth {
        let size = strain.abs();
        match self {
            Self::Constant => Growth { q: 1.0, slope: 0.0, integral: size },
            Self::Quadratic { alpha, e_max } => {
                let inside = size.min(*e_max);
                let part = inside / e_max;
                Growth {
                    q: 1.0 + alpha * part * part,
                    slope: if size < *e_max { 2.0 * alpha * part / e_max } else { 0.0 },
                    integral: inside * (1.0 + alpha * part * part / 3.0) + (1.0 + alpha) * (size - inside),
                }
            }
            Self::Loading(_) if strain <= 0.0 => Growth { q: 0.0, slope: 0.0, integral: 0.0 },
            Self::Loading(curve) => {
                let end = last_knot(curve);
                let (here, top) = (curve.at(size.min(end)), curve.at(end));
                Growth {
                    q: here.stress / top.stress,
                    slope: if size < end { here.tangent / top.stress } else { 0.0 },
                    integral: here.energy / top.stress + (size - size.min(end)),
                }
            }
        }
    }

    /// The same at strains multiplied by a factor.
    pub(super) fn stretched(&self, factor: f64) -> Result<Self, LawError> {
        Ok(match self {
            Self::Constant => Self::Constant,
            Self::Quadratic { alpha, e_max } => Self::Quadratic { alpha: *alpha, e_max: e_max * factor },
            Self::Loading(curve) => Self::Loading(curve.stretched(factor)?),
        })
    }

    /// Greatest derivative of `q`.
    pub(super) fn steepest(&self) -> f64 {
        match self {
            Self::Constant => 0.0,
            Self::Quadratic { alpha, e_max } => 2.0 * alpha / e_max,
            Self::Loading(curve) => curve.tangents().fold(0.0, f64::max) / curve.at(last_knot(curve)).stress,
        }
    }

    /// Refuses what is no growth.
    pub(super) fn check(&self) -> Result<(), LawError> {
        let positive = |what, value: f64| {
            let good = value.is_finite() && value > 0.0;
            if good { Ok(()) } else { Err(LawError::Value { what, value }) }
        };
        match self {
            Self::Constant => Ok(()),
            Self::Quadratic { alpha, .. } if !(alpha.is_finite() && *alpha >= 0.0) => {
                Err(LawError::Value { what: "the widening", value: *alpha })
            }
            Self::Quadratic { e_max, .. } => positive("the greatest strain", *e_max),
            Self::Loading(curve) if curve.offset() != 0.0 => {
                Err(LawError::Value { what: "the start of a loading curve", value: -curve.offset().abs() })
            }
            Self::Loading(curve) => {
                positive("the last knot of a loading curve", last_knot(curve))?;
                positive("the top of a loading curve", curve.at(last_knot(curve)).stress)
            }
        }
    }
}

/// The last knot of a curve.
fn last_knot(curve: &Backbone) -> f64 {
    curve.knots().last().unwrap_or(0.0)
}
