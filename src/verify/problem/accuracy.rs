//! How far a plate is from its exact solution, and how fast that falls.

use serde::Deserialize;

use super::plate::PlateProblem;
use super::setting::Statics;
use crate::fields::Extrapolation;
use crate::verify::error::VerifyError;
use crate::verify::function::Function;

/// Slope of the error of a plate in a log-log plot, from `n` to `2 n` elements.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConvergenceRate {
    /// The plate on its coarse mesh.
    plate: PlateProblem,
    /// Its exact solution.
    exact: Function,
}

impl ConvergenceRate {
    /// `log2(error(n) / error(2n))`.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        let mut error = |plate: &PlateProblem| {
            let (value, exact) = both(plate, self.exact, statics)?;
            Ok::<f64, VerifyError>((value - exact).abs())
        };
        let fine = self.plate.refined();
        Ok((error(&self.plate)? / error(&fine)?).log2())
    }
}

/// Error of a plate.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Deviation {
    /// The plate.
    plate: PlateProblem,
    /// Its exact solution.
    exact: Function,
}

impl Deviation {
    /// `value / exact - 1` (%).
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        let (value, exact) = both(&self.plate, self.exact, statics)?;
        Ok(100.0 * (value - exact) / exact)
    }
}

/// A plate on meshes of which each halves the elements of the next, and what its values approach.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extrapolated {
    /// The plate on its finest mesh.
    plate: PlateProblem,
}

impl Extrapolated {
    /// The value on elements of no size, from three meshes; not a number where there is none.
    pub fn value(&self, statics: &mut Statics) -> Result<(f64, [f64; 2]), VerifyError> {
        let coarse = self.plate.coarsened();
        let plates = [&coarse.coarsened(), &coarse, &self.plate];
        let taken = plates.map(|p| p.value(statics)).into_iter().collect::<Result<Vec<_>, _>>()?;
        let values: Vec<f64> = taken.iter().map(|(value, _)| *value).collect();
        Ok((Extrapolation::of(&values).map_or(f64::NAN, |e| e.value), taken[2].1))
    }

    /// The analytical value at a point.
    pub fn exact(&self, function: Function, at: [f64; 2]) -> Option<f64> {
        self.plate.exact(function, at)
    }
}

/// What the plate has, and what it should have at that place.
fn both(plate: &PlateProblem, function: Function, statics: &mut Statics) -> Result<(f64, f64), VerifyError> {
    let (value, at) = plate.value(statics)?;
    let exact = plate.exact(function, at).ok_or(VerifyError::NoReference { function })?;
    Ok((value, exact))
}
