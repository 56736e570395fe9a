//! What the tests of strips with a section have in common.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::report::mm;
use crate::quantity::Curve;
use crate::results::rests_on::{self, OF_STRIP, OF_STRIP_WITH_FRICTION};
use crate::results::task::Task;

/// What a chart says of what the strips of a fabric rest on that is not to be relied on.
pub(super) fn warning(task: &Task, has_friction: bool) -> Option<String> {
    let strip = if has_friction { OF_STRIP_WITH_FRICTION } else { OF_STRIP };
    rests_on::warning(&rests_on::grounds(&rests_on::known(task), strip))
}

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
