//! How the `[[steps]]` of a case become its history.

use super::CaseError;
use super::error::refused;
use super::loads::SheetLoads;
use super::nonlinear::NonlinearTable;
use super::step_analysis::{SheetStep, StepAnalysis, step_analysis};
use super::steps::StepTable;
use crate::finding::Node;

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
        in_order(&steps, &step, &at)?;
        let name = &step.name.value;
        if name.trim().is_empty() || steps.iter().any(|s| s.name.value == *name) {
            let message =
                format!("two [[steps]] are called `{name}`, or one has no name: give each a name of its own");
            return refused(at.value_place("name"), message);
        }
        steps.push(step);
    }
    if steps.iter().all(SheetStep::is_idle) {
        return refused(
            case.key_place("steps"),
            "nothing acts on the sheet in any step: add [[steps.loads]]",
        );
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
        let places = at.get("supports");
        let supports = self.supports.iter().zip(places.iter().flat_map(Node::items));
        Ok(SheetStep {
            name: at.located_at("name", self.name.clone()),
            analysis: step_analysis(at, case, always, default)?,
            supports: supports.map(|(table, at)| table.clone().support(&at)).collect::<Result<_, _>>()?,
        })
    }
}

/// Refuses a step after what leaves no equilibrium, or before there is any.
fn in_order(steps: &[SheetStep], step: &SheetStep, at: &Node<'_>) -> Result<(), CaseError> {
    let is_static = matches!(step.analysis, StepAnalysis::Static(_));
    if steps.is_empty() && !is_static {
        let message = "the first of the [[steps]] is of kind = \"nonlinear\": modes, load factors and motions of a sheet at rest are \
                       cases without [[steps]]";
        return refused(at.get("analysis").unwrap_or(*at).value_place("kind"), message);
    }
    match steps.last() {
        Some(SheetStep { name, analysis: StepAnalysis::Motion(_), .. }) => {
            let message = format!(
                "step `{}` before it is a motion, which ends in no equilibrium: a motion is the last of the [[steps]]",
                name.value
            );
            refused(at.place(), message)
        }
        _ => Ok(()),
    }
}
