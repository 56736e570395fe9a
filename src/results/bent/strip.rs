//! What the tests of strips with a section have in common.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::report::mm;
use crate::quantity::Curve;

/// The middle line of a strip.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct ProfileEntry {
    x: Vec<f64>,
    z: Vec<f64>,
    unit: Cow<'static, str>,
}

impl ProfileEntry {
    pub(super) fn new(profile: &Curve) -> Self {
        Self { x: profile.x.clone(), z: profile.y.clone(), unit: "m".into() }
    }
}

pub(super) fn millimetres(metres: f64) -> String {
    format!("{} mm", mm(metres))
}
