//! `[[steps]]`: a history of loads and supports.

use schemars::JsonSchema;
use serde::Deserialize;

use super::CaseError;
use super::analysis::{AnalysisTable, Nonlinear};
use super::error::refused;
use super::loads::{LoadTable, SheetLoads};
use super::nonlinear::NonlinearTable;
use super::supports::{SheetSupport, SupportTable};
use crate::finding::{Located, Node, ReadLater};

/// `[[steps]]`: what a sheet is taken through in large rotations, one step after the other, each from the shape, the
/// stresses and the friction in which the one before has ended.
///
/// Over a step the loads go evenly from those of the step before to those of the step: what it does not list acts no
/// longer at its end. What it holds stays where it is when it begins; what it holds no longer is let go of gently. The
/// `[[supports]]` and `[[loads]]` of the case are there in every step.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct StepTable {
    /// Name used in results.
    #[schemars(example = &"release")]
    name: String,
    /// Where the sheet is held in this step beside the `[[supports]]` of the case: each node stays where it is.
    #[serde(default)]
    supports: Vec<SupportTable>,
    /// What acts at its end beside the `[[loads]]` of the case, and what is moved. A prescribed displacement counts from
    /// the sheet at rest, a prescribed rotation from where its set was last taken hold of.
    #[serde(default, rename = "loads")]
    #[schemars(with = "Vec<LoadTable>")]
    _loads: ReadLater,
    /// How its equilibrium is found, of kind `nonlinear`; the `[analysis]` of the case when left out.
    #[serde(default, rename = "analysis")]
    #[schemars(with = "Option<AnalysisTable>")]
    _analysis: ReadLater,
}

/// One of the steps that a sheet is taken through.
#[derive(Clone, Debug)]
pub struct SheetStep {
    /// Name used in results; no other step of the case has it.
    pub name: Located<String>,
    /// Where the sheet is held beside the supports of the case; each node stays where it is at the beginning.
    pub supports: Vec<SheetSupport>,
    /// What acts at its end, what is moved, and how the equilibrium is found; the loads of the case included.
    pub analysis: Nonlinear,
}

/// The `[[steps]]` of a case whose `[analysis]` is the table, one at least; none without.
pub(super) fn steps(
    tables: &[StepTable],
    case: &Node<'_>,
    default: &NonlinearTable,
) -> Result<Option<Vec<SheetStep>>, CaseError> {
    if tables.is_empty() {
        return Ok(None);
    }
    let always = SheetLoads::read(case)?;
    let places = case.get("steps");
    let mut steps: Vec<SheetStep> = Vec::with_capacity(tables.len());
    for (table, at) in tables.iter().zip(places.iter().flat_map(Node::items)) {
        let step = table.step(&at, case, &always, default)?;
        let name = &step.name.value;
        if name.trim().is_empty() || steps.iter().any(|s| s.name.value == *name) {
            let message = format!("two [[steps]] are called `{name}`, or one has no name: give each a name of its own");
            return refused(at.value_place("name"), message);
        }
        steps.push(step);
    }
    if steps.iter().all(|step| step.analysis.loads.is_empty()) {
        return refused(case.key_place("steps"), "nothing acts on the sheet in any step: add [[steps.loads]]");
    }
    Ok(Some(steps))
}

impl StepTable {
    fn step(
        &self,
        at: &Node<'_>,
        case: &Node<'_>,
        always: &SheetLoads,
        default: &NonlinearTable,
    ) -> Result<SheetStep, CaseError> {
        let mut loads = always.clone();
        let own = SheetLoads::read(at)?;
        loads.acting.extend(own.acting);
        loads.prescribed.extend(own.prescribed);
        let analysis = match at.get("analysis") {
            None => default.checked(&case.get("analysis").unwrap_or(*case), loads)?,
            Some(of_step) => match AnalysisTable::read(at)? {
                AnalysisTable::Nonlinear(table) => table.checked(&of_step, loads)?,
                _ => {
                    let message = "the [analysis] of a step is of kind = \"nonlinear\"";
                    return refused(of_step.value_place("kind"), message);
                }
            },
        };
        let places = at.get("supports");
        let supports = self.supports.iter().zip(places.iter().flat_map(Node::items));
        Ok(SheetStep {
            name: at.located_at("name", self.name.clone()),
            supports: supports.map(|(table, at)| table.clone().support(&at)).collect::<Result<_, _>>()?,
            analysis,
        })
    }
}
