//! The forces of the elements in twice the working precision, by error-free transformations (Dekker, *Numer.
//! Math.* 18 (1971) 224; Ogita, Rump and Oishi, *SIAM J. Sci. Comput.* 26 (2005) 1955).
//!
//! Where stiffnesses lie far apart, those of a membrane and of bending in a sheet turned in space or of bending
//! and shear in a very thin one, the rounding of the products with the element matrices is all that keeps a
//! residual up. Without it the refinement goes on to what the matrices themselves say.

use nalgebra::Vector3;

use super::assemble::{ElementMatrices, MatrixKind, rigid_rotations};
use crate::element::MaterialAxisError;
use crate::model::{Dof, DofGroup, Model};

/// A sum and its rounding error, for terms of any order (Knuth).
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// A product and its rounding error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

/// A running sum and what has been rounded off it.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    high: f64,
    low: f64,
}

impl Sum {
    fn add(&mut self, value: f64) {
        let (high, error) = two_sum(self.high, value);
        self.high = high;
        self.low += error;
    }

    /// Adds `factor (high + low)`.
    fn add_product(&mut self, factor: f64, (high, low): (f64, f64)) {
        let (product, error) = two_product(factor, high);
        self.add(product);
        self.low += error + factor * low;
    }

    fn parts(self) -> (f64, f64) {
        two_sum(self.high, self.low)
    }
}

/// [`internal_forces`](super::assemble::internal_forces) under `u + low`, without the rounding of its products.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn internal_forces(
    model: &Model,
    group: DofGroup,
    u: &[f64],
    low: &[f64],
) -> Result<Vec<f64>, MaterialAxisError> {
    let b = group.dofs().len();
    let turns = rigid_rotations(model, group);
    let mut elements = ElementMatrices::new(model, group, MatrixKind::Stiffness);
    let mut product = vec![0.0; model.mesh.nodes.len() * b];
    let mut forces = vec![Sum::default(); 4 * b];
    for (quad, nodes) in model.mesh.quads.iter().enumerate() {
        let matrix = elements.of(quad)?;
        forces.fill(Sum::default());
        let deformation = deformation(model, group, turns, nodes, u, low);
        for (column, value) in matrix.chunks_exact(4 * b).zip(deformation) {
            forces.iter_mut().zip(column).for_each(|(f, k)| f.add_product(*k, value));
        }
        for (k, force) in forces.iter().enumerate() {
            product[nodes[k / b] as usize * b + k % b] += force.parts().0;
        }
    }
    Ok(product)
}

/// Displacements of an element's nodes less the displacement and, if `turns`, the rotation of the first, node by node,
/// each with its lower digits.
fn deformation(
    model: &Model,
    group: DofGroup,
    turns: bool,
    nodes: &[u32; 4],
    u: &[f64],
    low: &[f64],
) -> Vec<(f64, f64)> {
    let (dofs, points) = (group.dofs(), &model.mesh.nodes);
    let b = dofs.len();
    let at = |node: u32, k: usize| (u[node as usize * b + k], low[node as usize * b + k]);
    let first = |dof: usize| dofs.iter().position(|d| *d as usize == dof).map(|k| at(nodes[0], k));
    let relative_to_first = |node: u32, k: usize| {
        let dof = dofs[k] as usize;
        let mut sum = Sum::default();
        let ((high, low), (high_0, low_0)) = (at(node, k), at(nodes[0], k));
        sum.add(high);
        sum.low += low;
        if dof < Dof::ThetaX as usize || turns {
            sum.add(-high_0);
            sum.low -= low_0;
        }
        if dof < Dof::ThetaX as usize && turns {
            // Less θ × r of the first node's rotation θ.
            let r: Vector3<f64> = points[node as usize] - points[nodes[0] as usize];
            let (next, after) = ((dof + 1) % 3, (dof + 2) % 3);
            let theta = |axis: usize| first(Dof::ThetaX as usize + axis);
            if let Some(theta) = theta(next) {
                sum.add_product(-r[after], theta);
            }
            if let Some(theta) = theta(after) {
                sum.add_product(r[next], theta);
            }
        }
        sum.parts()
    };
    nodes.iter().flat_map(|node| (0..b).map(|k| relative_to_first(*node, k)).collect::<Vec<_>>()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Terms that cancel to the 24th digit, where plain sums have none left.
    #[test]
    fn sums_of_products_keep_what_cancels() {
        let mut sum = Sum::default();
        let terms = [(1.0 / 3.0, (3.0, 0.0)), (1e8, (1.0, 1e-25)), (-1e8, (1.0, 0.0)), (-1.0, (1.0, 0.0))];
        terms.into_iter().for_each(|(factor, value)| sum.add_product(factor, value));
        // 3 (1/3 rounded) - 1 = -2^-54, and 1e8 of the tiny part.
        let exact = 1e-17 - 2f64.powi(-54);
        let (high, low) = sum.parts();
        assert!((high + low - exact).abs() < 1e-30, "{high:e} {low:e}");
    }
}
