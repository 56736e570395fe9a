//! `[[steps]]`: a history of loads and supports.

use serde::Deserialize;

use super::supports::SupportTable;
use crate::finding::ReadLater;

/// `[[steps]]`: what a sheet is taken through in large rotations, one step after the other, each from the shape, the
/// stresses and the friction in which the one before has ended.
///
/// Over a step the loads go evenly from those of the step before to those of the step: what it does not list acts no
/// longer at its end. What it holds stays where it is when it begins; what it holds no longer is let go of gently. The
/// `[[supports]]` and `[[loads]]` of the case are there in every step.
///
/// A step of kind `modal` or `buckling` looks at the sheet as the step before has left it, loaded and held as there: its small
/// vibrations, or the factors of its own `[[steps.loads]]`, on top of those that act, at which it buckles. A step of kind
/// `newmark` is a motion from there, and the last of them; what it holds no longer it lets go of at once.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct StepTable {
    /// Name used in results.
    #[cfg_attr(test, schemars(example = &"release"))]
    pub name: String,
    /// Where the sheet is held in this step beside the `[[supports]]` of the case: each node stays where it is.
    #[serde(default)]
    pub supports: Vec<SupportTable>,
    /// What acts at its end beside the `[[loads]]` of the case, and what is moved. A prescribed displacement counts from
    /// the sheet at rest, a prescribed rotation from where its set was last taken hold of; in a motion both have a `course` or
    /// `times`, and count from where they are when it begins.
    #[serde(default, rename = "loads")]
    #[cfg_attr(test, schemars(with = "Vec<super::loads::LoadTable>"))]
    _loads: ReadLater,
    /// What is done: how its equilibrium is found (`nonlinear`; the `[analysis]` of the case when left out), or `modal`, `buckling`
    /// or `newmark`.
    #[serde(default, rename = "analysis")]
    #[cfg_attr(test, schemars(
        with = "Option<super::analysis::AnalysisTable>",
        example = serde_json::json!({"kind": "nonlinear", "method": "stable"})
    ))]
    _analysis: ReadLater,
}
