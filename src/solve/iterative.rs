//! Conjugate gradients for systems whose factor would not fit in memory, preconditioned by
//! smoothed aggregation (Vaněk, Mandel, Brezina, *Computing* 56 (1996) 179).
//!
//! Every coarse function moves an aggregate of about four nodes as a rigid body, smoothed by one
//! step of damped block Jacobi; so every rigid motion of the sheet, which is what costs a plate or
//! shell next to nothing, is on every level. A V-cycle smooths with one symmetric block
//! Gauss-Seidel sweep and factorises the coarsest level. The number of iterations hardly depends on
//! the mesh; it grows with the ratio of the rigidities along warp and weft, and where no shear
//! stabilisation bounds the ratio of shear to bending stiffness.

mod aggregates;
mod blocks;
mod cycle;
mod level;

use self::cycle::Hierarchy;
use super::factor::FactorError;
use super::sparse::BlockMatrix;
use crate::platform::over;

/// When the iteration ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Energy norm of the error, as the preconditioner measures it, over that of the solution.
    pub tolerance: f64,
    /// Iterations after which it is given up.
    pub max_iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { tolerance: 1e-10, max_iterations: 1000 }
    }
}

/// Why a matrix cannot be prepared.
#[derive(Clone, Debug, PartialEq)]
pub enum SetupError {
    /// A node without stiffness, or no memory.
    Factor(FactorError),
    /// The coarsest level is not positive definite: some motion is not held.
    SingularCoarse,
}

impl From<FactorError> for SetupError {
    fn from(e: FactorError) -> Self {
        Self::Factor(e)
    }
}

/// The iteration ended above its tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Stalled {
    /// Norm of the residual over its start, at the start and after each iteration.
    pub history: Vec<f64>,
}

/// A matrix with its preconditioner, for any number of right-hand sides.
#[derive(Debug)]
pub struct Iterative {
    hierarchy: AnyHierarchy,
}

/// Blocks of every size that elements have, known to the compiler.
#[derive(Debug)]
enum AnyHierarchy {
    Three(Hierarchy<3>),
    Six(Hierarchy<6>),
}

impl Iterative {
    /// Prepares a positive definite matrix of blocks of 3 or 6, whose held dofs are unit rows.
    ///
    /// `rigid` holds, for each row of the matrix, its value in as many rigid motions as a block has
    /// rows; 0 at held dofs.
    ///
    /// # Errors
    /// See [`SetupError`].
    ///
    /// # Panics
    /// If the blocks have another size, or `rigid` does not fit the matrix.
    pub fn new(matrix: BlockMatrix, rigid: &[f64]) -> Result<Self, SetupError> {
        assert_eq!(rigid.len(), matrix.rows() * matrix.block, "a value for every row and motion");
        let hierarchy = match matrix.block {
            3 => AnyHierarchy::Three(Hierarchy::new(matrix, rigid)?),
            6 => AnyHierarchy::Six(Hierarchy::new(matrix, rigid)?),
            other => panic!("blocks of {other}: elements have 3 or 6"),
        };
        Ok(Self { hierarchy })
    }

    /// Solves in place. Returns the history of the residual, as in [`Stalled`].
    ///
    /// # Errors
    /// [`Stalled`] above the tolerance, with `x` as far as it came.
    ///
    /// # Panics
    /// If `x` is not as long as the matrix has rows.
    pub fn solve(&self, x: &mut [f64], settings: &Settings) -> Result<Vec<f64>, Stalled> {
        match &self.hierarchy {
            AnyHierarchy::Three(h) => conjugate_gradients(h.matrix(), |r, z| h.cycle(r, z), x, settings),
            AnyHierarchy::Six(h) => conjugate_gradients(h.matrix(), |r, z| h.cycle(r, z), x, settings),
        }
    }

    /// Bytes of the matrices and interpolations on all levels.
    pub fn bytes(&self) -> usize {
        match &self.hierarchy {
            AnyHierarchy::Three(h) => h.bytes(),
            AnyHierarchy::Six(h) => h.bytes(),
        }
    }

    /// Rows of the matrix on each level, the finest first.
    pub fn levels(&self) -> Vec<usize> {
        match &self.hierarchy {
            AnyHierarchy::Three(h) => h.rows(),
            AnyHierarchy::Six(h) => h.rows(),
        }
    }
}

/// Preconditioned conjugate gradients from zero; `x` holds the right-hand side, then the solution.
fn conjugate_gradients(
    a: &BlockMatrix,
    precondition: impl Fn(&[f64], &mut [f64]),
    x: &mut [f64],
    settings: &Settings,
) -> Result<Vec<f64>, Stalled> {
    let mut r = x.to_vec();
    x.fill(0.0);
    let (mut z, mut ap) = (vec![0.0; r.len()], vec![0.0; r.len()]);
    precondition(&r, &mut z);
    let mut p = z.clone();
    let start = dot(&r, &z);
    let mut rz = start;
    let mut history = vec![1.0];
    if start == 0.0 {
        return Ok(history);
    }
    for _ in 0..settings.max_iterations {
        a.mul(&p, &mut ap);
        let step = rz / dot(&p, &ap);
        x.iter_mut().zip(&p).for_each(|(x, p)| *x += step * p);
        r.iter_mut().zip(&ap).for_each(|(r, ap)| *r -= step * ap);
        precondition(&r, &mut z);
        let next = dot(&r, &z);
        let norm = (next / start).sqrt();
        history.push(norm);
        if norm <= settings.tolerance {
            return Ok(history);
        }
        if !norm.is_finite() || over().is_some() {
            break;
        }
        p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + next / rz * *p);
        rz = next;
    }
    Err(Stalled { history })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
