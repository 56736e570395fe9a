//! What a case needs, estimated before anything of it is made.
//!
//! Memory is that of the largest system: the factor of a sheet of N nodes with b dofs each, ordered by nested dissection,
//! has about `2.5 b² N log₂ N` entries (measured: 2.28 at 1,681 nodes, 2.34 at 25,921, 2.5 at 103,041; George, *SIAM J.
//! Numer. Anal.* 10 (1973) 345, has the order), and matrix, mesh and vectors come on top. Once the order of elimination is
//! known the factor is too, and [`Plan`](crate::solve::Plan) looks again.

use super::{Case, StudyError, placed};
use crate::case::{
    Analysis, Annulus, BendingTest, InstrumentTest, Outline, Problem, SheetProblem, StepAnalysis,
    StripBending,
};
use crate::finding::Located;
use crate::solve::{Method, Options, SolveError};

/// Entries of a factor over `b² N log₂ N`.
const FILL: f64 = 2.5;

/// Entries of a row of blocks of the stiffness: a node and its eight neighbours.
const NEIGHBOURS: f64 = 9.0;

/// Matrices of that size that are held at once: stiffness, mass or geometric part, preconditioner of an iteration.
const MATRICES: f64 = 3.0;

/// Blocks of a node that an iteration holds beside that: matrices and interpolations of all levels, and rows and products
/// while they are made (measured: 2.1 GB for 490,000 quads of three dofs, 5.5 GB for a million).
const BLOCKS_OF_LEVELS: f64 = 36.0;

/// Numbers of a node beside matrices: coordinates, displacements, reactions, resultants, elements.
const PER_NODE: f64 = 200.0;

/// Numbers kept of an instant of a motion, and of each probe of it.
const PER_INSTANT: f64 = 6.0;
const PER_PROBE: f64 = 4.0;

const BYTES: f64 = size_of::<f64>() as f64;

/// Cells of a disc over the square of those across its core: the core, and half as many rings of four sides.
const OF_DISC: f64 = 3.0;

/// Refuses a case that needs more memory than the options allow, before its mesh is made.
///
/// # Errors
/// N011 at the table that asks for it.
pub fn within_limits(case: &Case, options: &Options) -> Result<(), StudyError> {
    let fits = |bytes| SolveError::in_memory(bytes, options.memory_limit);
    match &case.problem {
        Problem::Sheet(problem) => {
            let cells = quads(&problem.sheet.outline);
            placed(case, &problem.sheet.table, fits(of_sheet(problem, cells, options)))
        }
        Problem::Drape(problem) => {
            let [along, around] = problem.ring.cells.map(|n| n as f64);
            let quads = along * around * 4.0f64.powf(problem.refinements as f64);
            placed(case, &problem.table, fits(of_system(quads, 6.0, false)))
        }
        Problem::InstrumentTest(InstrumentTest::Shell(specimen)) => {
            let quads = specimen.test.cells.map_or(0.0, |[a, b]| a as f64 * b as f64);
            placed(case, &Located::from(()), fits(of_system(quads, 6.0, false)))
        }
        Problem::BendingTest(BendingTest::Strip(StripBending { strip, .. })) => {
            // A wide strip has at most as many cells across as along.
            let cells = strip.cells.map_or(0.0, |n| n as f64);
            let across = if strip.width.is_some() { cells } else { 1.0 };
            placed(case, &Located::from(()), fits(of_system(cells * across, 6.0, false)))
        }
        Problem::BendingTest(BendingTest::FabBendLoop(test)) => {
            let cells = test.cells.map_or(0.0, |n| n as f64);
            placed(case, &Located::from(()), fits(of_system(cells, 6.0, false)))
        }
        Problem::InstrumentTest(InstrumentTest::Compression(_)) => Ok(()),
    }
}

/// About how many quads an outline has; none of a mesh file or a drawing, which are as large as they are.
fn quads(outline: &Outline) -> f64 {
    match outline {
        Outline::Rectangle { cells: [a, b], .. } | Outline::Annulus(Annulus { cells: [a, b], .. }) => {
            *a as f64 * *b as f64
        }
        Outline::Disc { cells, .. } => OF_DISC * (*cells as f64).powi(2),
        Outline::File { .. } | Outline::Drawn(_) => 0.0,
    }
}

/// Bytes of a case with a sheet of so many quads.
fn of_sheet(problem: &SheetProblem, quads: f64, options: &Options) -> f64 {
    let is_linear = matches!(problem.analysis, Analysis::Linear(_));
    // A flat sheet in small displacements has two systems of three dofs.
    let dofs = if problem.analysis.has_large_rotations() { 6.0 } else { 3.0 };
    let method = problem.solver.options(options).method;
    let limit = problem.solver.options(options).factor_limit as f64;
    let iterates = is_linear
        && match method {
            Method::Direct => false,
            Method::Auto => factor(quads, dofs) > limit,
            Method::Iterative => true,
        };
    let mut bytes = of_system(quads, dofs, iterates);
    // The subspace has twice as many columns, and its products are kept beside it.
    let of_subspace = |count: usize| 6.0 * (count as f64).min(dofs * quads) * dofs * quads * BYTES;
    let of_instants = |duration: f64, step: f64| {
        duration / step * (PER_INSTANT + PER_PROBE * problem.probes.len() as f64) * BYTES
    };
    match &problem.analysis {
        Analysis::Modal(modal) => bytes += of_subspace(modal.modes),
        Analysis::Buckling(buckling) => bytes += of_subspace(buckling.factors),
        // An adaptive step grows and shrinks as it must.
        Analysis::Newmark(motion) if motion.tolerance.is_none() => {
            bytes += of_instants(motion.duration.si(), motion.step.si());
        }
        Analysis::Steps(steps) => {
            for step in steps {
                bytes += match &step.analysis {
                    StepAnalysis::Static(_) => 0.0,
                    StepAnalysis::Modal { modes, .. } => of_subspace(*modes),
                    StepAnalysis::Buckling { factors, .. } => of_subspace(*factors),
                    StepAnalysis::Motion(motion) => {
                        let frames = motion.frames as f64 * dofs * quads * BYTES;
                        of_instants(motion.duration.si(), motion.step.si()) + frames
                    }
                };
            }
        }
        Analysis::Linear(_) | Analysis::Newmark(_) | Analysis::Nonlinear(_) => {}
    }
    bytes
}

/// Bytes of a factor.
fn factor(quads: f64, dofs: f64) -> f64 {
    FILL * dofs * dofs * quads * quads.max(2.0).log2() * BYTES
}

/// Bytes of the largest system on so many quads.
fn of_system(quads: f64, dofs: f64, iterates: bool) -> f64 {
    let matrices = MATRICES * NEIGHBOURS * dofs * dofs + PER_NODE;
    let solver = if iterates { quads * BLOCKS_OF_LEVELS * dofs * dofs * BYTES } else { factor(quads, dofs) };
    quads * matrices * BYTES + solver
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh;
    use crate::solve::factor::{Path, analyse_ordered, order};
    use crate::solve::sparse::BlockGraph;

    /// The estimate against the counts of the factorisation itself.
    #[test]
    fn the_estimate_of_a_factor_is_near_its_size() {
        for (n, dofs) in [(40usize, 3usize), (80, 3), (80, 6), (160, 3)] {
            let mesh = mesh::rectangle(1.0, 1.0, n, n).unwrap();
            let graph = std::sync::Arc::new(BlockGraph::from_elements(mesh.nodes.len(), &mesh.quads));
            let places: Vec<[f64; 3]> = mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect();
            let order = order(&graph, Some(&places)).unwrap();
            let counted = analyse_ordered(&graph, dofs, &order, Path::Auto).unwrap().counts().bytes as f64;
            let estimated = factor((n * n) as f64, dofs as f64);
            let ratio = estimated / counted;
            assert!((0.6..1.4).contains(&ratio), "{n} x {n}, {dofs} dofs: {ratio}");
        }
    }
}
