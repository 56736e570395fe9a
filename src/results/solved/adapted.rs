//! Meshes that were refined, as tables.

use crate::quantity::significant;
use crate::results::columns::Columns;
use crate::results::task::Task;
use crate::study::CaseResult;

/// One line a mesh of a case with `[adaptive]`, coarsest first.
pub(super) fn meshes(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let mut table =
        Columns::new(["mesh", "case", "fabric", "elements", "triangles", "unknowns", "energy error (%)"]);
    for (task, r) in solved {
        for (k, mesh) in r.adapted.iter().flat_map(|adapted| &adapted.meshes).enumerate() {
            table.row([
                (k + 1).to_string(),
                r.case.clone(),
                task.shown_fabric(),
                mesh.elements.to_string(),
                mesh.triangles.to_string(),
                mesh.dofs.to_string(),
                format!("{:.2}", 100.0 * mesh.error),
            ]);
        }
    }
    table.filled()
}

/// One line a result of a case with `[adaptive]`: its values from the coarsest mesh to the last, and what the last
/// refinement has changed.
pub(super) fn quantities(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let headings = ["result", "case", "fabric", "unit", "coarse to fine", "last change (%)"];
    let mut table = Columns::new(headings);
    for (task, r) in solved {
        for q in r.adapted.iter().flat_map(|adapted| &adapted.quantities) {
            let values: Vec<String> = q.values.iter().map(|v| significant(*v)).collect();
            table.row([
                q.quantity.clone(),
                r.case.clone(),
                task.shown_fabric(),
                q.unit.to_string(),
                values.join("  "),
                format!("{:.3}", 100.0 * q.change()),
            ]);
        }
    }
    table.filled()
}
