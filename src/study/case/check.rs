//! `[[probes]]` and `[[checks]]`: what is reported and what must come out.

use serde::Deserialize;

use crate::study::point::SheetPoint;

/// `[[probes]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProbeTable {
    /// Name used in results and checks.
    pub name: String,
    /// Point of the undeformed sheet: `[x, y]` in the plane z = 0, or `[x, y, z]`.
    pub at: SheetPoint,
}

/// `[[checks]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// `w_max`, `strain_energy`, or `<probe>.<u|v|w|theta_x|...|moment_x|membrane_x|shear_x ...>`.
    pub quantity: String,
    /// Expected value with unit; a frequency in `rad/s` is an angular one.
    pub expected: String,
    /// Accepted |value - expected| / |expected|.
    pub relative_tolerance: f64,
    /// Where the expected value comes from.
    pub reference: Reference,
}

/// The source of an expected value.
#[derive(Clone, Debug, Deserialize, serde::Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// What kind of reference.
    pub kind: ReferenceKind,
    /// Citation.
    pub source: String,
}

/// Kinds of references; an accuracy claim never rests on `own`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReferenceKind {
    /// A closed form or a high-precision series.
    Analytical,
    /// A number printed elsewhere.
    Published,
    /// A measurement.
    Measured,
    /// This program's own earlier result: guards against change, proves nothing.
    Own,
}
