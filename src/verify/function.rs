//! Closed forms that serve as references.

use serde::{Deserialize, Serialize};

/// The functions of [`analytical`](crate::analytical) that serve as references.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Function {
    /// Navier's double series: thin, SSSS.
    Navier,
    /// Lévy's single series: thin, S.S. with any two other edges.
    Levy,
    /// Hencky's superposition: thin, CCCC.
    Superposition,
    /// Ritz's method: thin, CFFF.
    Ritz,
    /// Double series (SSSS) or Ritz's method (CCCC) for plates flexible in shear.
    ShearFlexible,
    /// Navier's (SSSS) or Ritz's (CCCC, CFFF) frequencies: thin.
    Frequencies,
    /// The elastica of a strip, loaded at its end or by its weight.
    Elastica,
}
