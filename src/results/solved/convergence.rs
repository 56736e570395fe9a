//! What the mesh leaves open in results, as a table.

use crate::quantity::significant;
use crate::results::columns::Columns;
use crate::results::task::Task;
use crate::study::CaseResult;

/// One line a result of a case with `[convergence]`: its values from the coarsest mesh to the finest, what they
/// approach, the order that was seen, and the grid convergence index.
pub(super) fn table(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let headings = ["result", "case", "fabric", "unit", "coarse to fine", "limit", "order", "± mesh (%)"];
    let mut table = Columns::new(headings);
    for (task, r) in solved {
        for q in r.convergence.iter().flat_map(|c| &c.quantities) {
            let values: Vec<String> = q.values.iter().map(|v| significant(*v)).collect();
            table.row([
                q.quantity.clone(),
                r.case.clone(),
                task.shown_fabric(),
                q.unit.to_string(),
                values.join("  "),
                significant(q.extrapolation.value),
                q.extrapolation.order.map_or("-".into(), |p| format!("{p:.2}")),
                format!("{:.3}", 100.0 * q.relative_index()),
            ]);
        }
    }
    table.filled()
}
