//! How the `[[steps]]` of a case become its history.

use super::CaseError;
use super::analysis::AnalysisTable;
use super::error::refused;
use super::loads::SheetLoads;
use super::nonlinear::{NonlinearTable, SheetStep};
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
        let name = &step.name.value;
        if name.trim().is_empty() || steps.iter().any(|s| s.name.value == *name) {
            let message =
                format!("two [[steps]] are called `{name}`, or one has no name: give each a name of its own");
            return refused(at.value_place("name"), message);
        }
        steps.push(step);
    }
    if steps.iter().all(|step| step.analysis.loads.is_empty()) {
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
        let mut loads = always.clone();
        let own = SheetLoads::read(at)?;
        loads.acting.extend(own.acting);
        loads.prescribed.extend(own.prescribed);
        let analysis = match at.get("analysis") {
            None => default.checked(&case.get("analysis").unwrap_or(*case), loads)?,
            Some(of_step) => match AnalysisTable::read(at)? {
                AnalysisTable::Nonlinear(table) => {
                    table.with_obstacles(case, &of_step)?.checked(&of_step, loads)?
                }
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
