//! A line of the suite: a problem, its reference, and how it came out.

use serde::{Deserialize, Serialize};

use super::error::VerifyError;
use super::function::Function;
use super::problem::VerifyProblem;
use super::problem::setting::Statics;
use crate::platform::Stopwatch;

/// One comparison of the suite.
#[derive(Clone, Debug)]
pub struct Line {
    /// Name, unique, its parts separated by full stops.
    pub id: String,
    /// What the value is, with its normalisation.
    pub quantity: String,
    /// The problem that gives the value.
    pub problem: VerifyProblem,
    /// What the value is compared with.
    pub reference: Reference,
    /// How far from the reference it may be.
    pub tolerance: Tolerance,
    /// On which side of that it is known to be.
    pub expected: Expected,
    /// What the publication prints whose claim the line is, if it prints a value.
    pub published: Option<f64>,
    /// Where the reference comes from.
    pub kind: Kind,
    /// Author and place, or method, of the reference.
    pub citation: String,
}

/// What a value is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Reference {
    /// A number.
    Number(f64),
    /// A function of the analytical module, for the parameters of the problem.
    Function(Function),
}

/// How far from the reference a value may be, inclusive.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tolerance {
    /// Of `value / reference - 1`.
    Relative(f64),
    /// Of `value - reference`.
    Absolute(f64),
}

/// On which side of its tolerance a value is known to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Expected {
    /// Within.
    #[default]
    Within,
    /// Beyond: the line shows that something does not hold.
    Beyond,
}

/// Where a reference comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A closed form, a convergent series, or a property that follows from theory.
    Analytical,
    /// An independent implementation of the same element on the same mesh.
    Independent,
    /// A published value.
    Published,
}

impl Kind {
    /// `analytical`, `independent` or `published`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Analytical => "analytical",
            Self::Independent => "independent",
            Self::Published => "published",
        }
    }
}

/// The residual that every linear static solve of the suite has to reach.
pub const RESIDUAL: f64 = 1e-8;

/// How a line came out.
#[derive(Clone, Debug)]
pub struct LineOutcome {
    /// The value, the reference and their difference; or why there are none.
    pub result: Result<ComparedValue, VerifyError>,
    /// Largest `|K u - f| / |f|` of the linear static models that were solved; `None` without any.
    pub residual: Option<f64>,
    /// Whether the difference is within the tolerance.
    pub within: bool,
    /// Whether that is so as it is known to be, with a value and with its residual within [`RESIDUAL`].
    pub pass: bool,
    /// Time taken (s).
    pub seconds: f64,
}

/// A value beside its reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ComparedValue {
    /// What this program gives.
    pub value: f64,
    /// What it should be.
    pub reference: f64,
    /// Signed difference, relative to the reference when the tolerance is relative.
    pub error: f64,
}

impl Line {
    /// Solves the problem and compares.
    pub fn check(&self) -> LineOutcome {
        let watch = Stopwatch::start();
        let mut statics = Statics::default();
        let result = self.compare(&mut statics);
        let residual = statics.residual;
        // A value that is not a number compares as false.
        let within = result.as_ref().is_ok_and(|c| c.error.abs() <= self.tolerance.limit());
        let beyond = result.as_ref().is_ok_and(|c| c.error.abs() > self.tolerance.limit());
        let known = match self.expected {
            Expected::Within => within,
            Expected::Beyond => beyond,
        };
        let pass = known && residual.is_none_or(|r| r <= RESIDUAL);
        LineOutcome { result, residual, within, pass, seconds: watch.seconds() }
    }

    fn compare(&self, statics: &mut Statics) -> Result<ComparedValue, VerifyError> {
        let (value, at) = self.problem.value(statics)?;
        let reference = match self.reference {
            Reference::Number(number) => number,
            Reference::Function(function) => {
                self.problem.exact(function, at).ok_or(VerifyError::NoReference { function })?
            }
        };
        let difference = value - reference;
        let error = match self.tolerance {
            Tolerance::Relative(_) => difference / reference,
            Tolerance::Absolute(_) => difference,
        };
        Ok(ComparedValue { value, reference, error })
    }
}

impl Tolerance {
    /// The number.
    pub fn limit(self) -> f64 {
        match self {
            Self::Relative(limit) | Self::Absolute(limit) => limit,
        }
    }
}
