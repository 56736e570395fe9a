//! Results that are numbers: what is infinite or no number is an error, and no result.

use super::StudyError;
use super::result::CaseResult;
use crate::model::Dof;
use crate::solve::SolveError;

/// Whether every number of a solved case is one.
///
/// # Errors
/// N012 with the first that is none.
pub(super) fn finite(result: &CaseResult) -> Result<(), StudyError> {
    let solution = &result.solution;
    of_nodes("the displacement", &solution.displacement)?;
    of_nodes("the reaction", &solution.reaction)?;
    number("the strain energy", solution.strain_energy)?;
    number("the residual", solution.residual)?;
    for frequency in &result.frequencies {
        number("a natural frequency", *frequency)?;
    }
    let steps = result.path.iter().flat_map(|path| &path.load_steps);
    let of_steps = steps.flat_map(|step| step.frequencies.iter().chain(&step.load_factors));
    for eigenvalue in result.load_factors.iter().chain(of_steps) {
        number("a frequency or load factor", *eigenvalue)?;
    }
    for probe in &result.probes {
        let value = &probe.value;
        let all = value.u.iter().chain(&value.theta).copied().chain(value.resultants.components());
        all.into_iter().try_for_each(|v| number(&format!("probe `{}`", probe.name), v))?;
    }
    for at in result.history.iter().flat_map(|history| &history.energy) {
        let all = [at.kinetic, at.strain, at.dissipated, at.work];
        all.into_iter().try_for_each(|v| number("the energy of the motion", v))?;
    }
    Ok(())
}

fn number(quantity: &str, value: f64) -> Result<(), StudyError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(SolveError::NotFinite { quantity: quantity.to_string() }.into())
}

/// Six numbers a node.
fn of_nodes(what: &str, values: &[f64]) -> Result<(), StudyError> {
    let Some(at) = values.iter().position(|v| !v.is_finite()) else { return Ok(()) };
    let (node, dof) = (at / 6, Dof::ALL[at % 6].name());
    number(&format!("{what} {dof} of node {node}"), values[at])
}
