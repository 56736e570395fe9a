//! What the displacements mean: resultants, values at points and along lines.
//!
//! Resultants are in material axes (x = warp, y = weft), so that they compare with the section's
//! own stiffnesses whatever the mesh: `membrane` N (N/m), `moment` M (N), `shear` Q (N/m).

mod edge;
mod probe;
mod recovery;

use nalgebra::{DMatrix, Matrix2, Matrix3, Point3, Vector2, Vector3};

pub use edge::edge_moments;
pub use probe::{Line, Locator, ProbeValue};

use crate::element::corotational::{Motion, Reference};
use crate::element::{Cell, Cells, Frame, Matrix24, Prepared, Vector24};
use crate::mesh::QuadMesh;
use crate::model::{Model, ModelError};
use crate::solve::nonlinear::State;
use recovery::Patches;

/// Stress resultants in material axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultants {
    /// Membrane forces `[N_x, N_y, N_xy]` (N/m).
    pub membrane: [f64; 3],
    /// Moments `[M_x, M_y, M_xy]` (N·m/m = N); positive stretches the +z face.
    pub moment: [f64; 3],
    /// Transverse shear forces `[Q_x, Q_y]` (N/m).
    pub shear: [f64; 2],
}

impl Resultants {
    fn add(&mut self, other: &Self, weight: f64) {
        (0..3).for_each(|i| self.membrane[i] += weight * other.membrane[i]);
        (0..3).for_each(|i| self.moment[i] += weight * other.moment[i]);
        (0..2).for_each(|i| self.shear[i] += weight * other.shear[i]);
    }
}

/// Resultants of one element: one entry per smoothing cell, and the shear at the four corners.
struct ElementResultants {
    /// N and M of each cell, with the cell's area.
    cells: Vec<(f64, [f64; 3], [f64; 3])>,
    /// Q at the natural corners, in node order.
    corner_shear: [[f64; 2]; 4],
    centre_shear: [f64; 2],
}

impl ElementResultants {
    /// The mean over the cells, the shear at the centre.
    fn mean(&self) -> Resultants {
        let area: f64 = self.cells.iter().map(|c| c.0).sum();
        let mut mean = Resultants::default();
        for (a, membrane, moment) in &self.cells {
            mean.add(&Resultants { membrane: *membrane, moment: *moment, shear: [0.0; 2] }, a / area);
        }
        mean.shear = self.centre_shear;
        mean
    }
}

/// What elements that are equal up to a translation share.
struct Geometry {
    element: Prepared,
    to_local: Matrix24,
    smoothing: Vec<Cell>,
    corners: [Point3<f64>; 4],
}

impl Geometry {
    fn of(model: &Model, quad: usize, flat: bool) -> Result<Self, ModelError> {
        let element = model.element(quad, flat)?;
        let (to_local, smoothing) = (element.to_local(), element.cells().collect());
        Ok(Self { element, to_local, smoothing, corners: model.mesh.corners(quad) })
    }

    /// Equal up to a translation, to the rounding of the coordinates.
    fn is_like(&self, corners: &[Point3<f64>; 4]) -> bool {
        let own = &self.corners;
        let size = (own[2] - own[0]).norm();
        (1..4).all(|i| ((corners[i] - corners[0]) - (own[i] - own[0])).amax() <= 1e-12 * size)
    }
}

fn element_resultants(geometry: &Geometry, warp: &Vector3<f64>, u: &Vector24) -> ElementResultants {
    let element = &geometry.element;
    let local = geometry.to_local * u;
    // From element axes to material axes: the warp seen in the element's plane.
    let a = element.frame.rotation * warp;
    let (s, c) = a.y.atan2(a.x).sin_cos();
    #[rustfmt::skip]
    let stress = Matrix3::new(
        c * c, s * s, 2.0 * c * s,
        s * s, c * c, -2.0 * c * s,
        -c * s, c * s, c * c - s * s,
    );
    let vector = Matrix2::new(c, s, -s, c);
    let cells = geometry
        .smoothing
        .iter()
        .map(|cell| {
            let (strain, curvature) = element.strains(cell, &local);
            (cell.area, (stress * element.d_m * strain).into(), (stress * element.d_b * curvature).into())
        })
        .collect();
    let shear = |at: [f64; 2]| -> [f64; 2] {
        let q: Vector2<f64> = vector * element.d_s * element.shear_strain(at, &local);
        q.into()
    };
    ElementResultants {
        cells,
        corner_shear: [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(shear),
        centre_shear: shear([0.0, 0.0]),
    }
}

fn for_each_element(
    model: &Model,
    flat: bool,
    displacement: impl Fn(usize) -> Vector24,
    mut visit: impl FnMut(usize, ElementResultants),
) -> Result<(), ModelError> {
    let mut last: Option<Geometry> = None;
    for quad in 0..model.mesh.quads.len() {
        let geometry = match last.take() {
            Some(geometry) if geometry.is_like(&model.mesh.corners(quad)) => geometry,
            _ => Geometry::of(model, quad, flat)?,
        };
        visit(quad, element_resultants(&geometry, &model.warp, &displacement(quad)));
        last = Some(geometry);
    }
    Ok(())
}

/// Displacements of the nodes of an element.
fn small<'a>(model: &'a Model, displacement: &'a [f64]) -> impl Fn(usize) -> Vector24 + 'a {
    |quad| {
        let nodes = &model.mesh.quads[quad];
        Vector24::from_fn(|k, _| displacement[6 * nodes[k / 6] as usize + k % 6])
    }
}

/// The part of the motion of an element's nodes that strains it, turned back to where the element rests.
fn straining<'a>(model: &'a Model, state: &'a State) -> impl Fn(usize) -> Vector24 + 'a {
    |quad| {
        let nodes = model.mesh.quads[quad].map(|n| n as usize);
        let frame = Frame::of(&model.mesh.corners(quad));
        let (places, turns) = (nodes.map(|n| state.position[n]), nodes.map(|n| state.rotation[n]));
        let deformation = Motion::of(&Reference::of(&frame), &places, &turns).deformation;
        let mut u = Vector24::zeros();
        for b in 0..8 {
            let part = frame.rotation.transpose() * deformation.fixed_rows::<3>(3 * b);
            u.fixed_rows_mut::<3>(3 * b).copy_from(&part);
        }
        u
    }
}

/// Membrane forces and moments of every smoothing cell, element by element, in the order of the
/// cells; transverse shear is not constant in a cell and is left at zero.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn cells(model: &Model, displacement: &[f64]) -> Result<Vec<Vec<Resultants>>, ModelError> {
    let mut all = vec![Vec::new(); model.mesh.quads.len()];
    for_each_element(model, model.mesh.is_flat(), small(model, displacement), |quad, e| {
        let of_cell = |(_, membrane, moment)| Resultants { membrane, moment, shear: [0.0; 2] };
        all[quad] = e.cells.into_iter().map(of_cell).collect();
    })?;
    Ok(all)
}

/// Resultants of each element: the mean over its smoothing cells, shear at its centre.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn element_means(model: &Model, displacement: &[f64]) -> Result<Vec<Resultants>, ModelError> {
    let mut means = Vec::with_capacity(model.mesh.quads.len());
    for_each_element(model, model.mesh.is_flat(), small(model, displacement), |_, e| means.push(e.mean()))?;
    Ok(means)
}

/// Resultants at the nodes of a model: a [`Recovery`] used once.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn nodal(model: &Model, displacement: &[f64]) -> Result<Vec<Resultants>, ModelError> {
    Recovery::new(&model.mesh).nodal(model, displacement)
}

/// What the resultants at the nodes take from the mesh alone, shared by every model on it.
///
/// N and M: inside the sheet each element's cells extrapolated to its corners and averaged over the
/// elements that meet; on its boundary the quadratic patch recovery from element means. Q: MITC4
/// values at the corners, averaged.
///
/// Second order everywhere. Averages would do for the inside and are first order on clamped
/// edges (12 % at 32 x 32 elements of a clamped square, where the patch recovery has 0.2 %). Where the mesh
/// has too few elements for a parabola (less than three across) the averages are kept. For clamped edges
/// [`edge_moments`] is a second source, from the reactions (0.1 %).
#[derive(Clone, Debug)]
pub struct Recovery {
    flat: bool,
    /// Boundary nodes that have a patch, and the weight of each element mean of it.
    boundary: Vec<(u32, Vec<(usize, f64)>)>,
}

impl Recovery {
    /// The patches of a mesh.
    pub fn new(mesh: &QuadMesh) -> Self {
        let patches = Patches::new(mesh);
        let mut nodes: Vec<u32> = mesh.boundary_edges().into_iter().flatten().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let boundary = nodes.into_iter().filter_map(|n| Some((n, patches.weights(n as usize)?))).collect();
        Self { flat: mesh.is_flat(), boundary }
    }

    /// Resultants at the nodes of a model on the mesh.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn nodal(&self, model: &Model, displacement: &[f64]) -> Result<Vec<Resultants>, ModelError> {
        self.nodal_of(model, small(model, displacement))
    }

    /// The same after large rotations: in the axes of the elements as they have turned.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn nodal_moved(&self, model: &Model, state: &State) -> Result<Vec<Resultants>, ModelError> {
        self.nodal_of(model, straining(model, state))
    }

    fn nodal_of(
        &self,
        model: &Model,
        displacement: impl Fn(usize) -> Vector24,
    ) -> Result<Vec<Resultants>, ModelError> {
        let weights = extrapolation(model.formulation.cells);
        let mut means = Vec::with_capacity(model.mesh.quads.len());
        let mut sums = vec![(Resultants::default(), 0.0); model.mesh.nodes.len()];
        for_each_element(model, self.flat, displacement, |quad, e| {
            means.push(e.mean());
            for (corner, node) in model.mesh.quads[quad].iter().enumerate() {
                let (sum, count) = &mut sums[*node as usize];
                for (k, (_, membrane, moment)) in e.cells.iter().enumerate() {
                    let part = Resultants { membrane: *membrane, moment: *moment, shear: [0.0; 2] };
                    sum.add(&part, weights[(corner, k)]);
                }
                sum.add(&Resultants { shear: e.corner_shear[corner], ..Default::default() }, 1.0);
                *count += 1.0;
            }
        })?;
        let mut nodal: Vec<Resultants> = sums
            .into_iter()
            .map(|(sum, count)| {
                let mut mean = Resultants::default();
                mean.add(&sum, 1.0 / count);
                mean
            })
            .collect();
        for (node, patch) in &self.boundary {
            let mut fitted = Resultants::default();
            patch.iter().for_each(|(quad, weight)| fitted.add(&means[*quad], *weight));
            let at = &mut nodal[*node as usize];
            *at = Resultants { shear: at.shear, ..fitted };
        }
        Ok(nodal)
    }
}

/// Weights (4 corners x cells) of the least-squares surface through the cell values, in natural
/// coordinates: bilinear through 2 x 2 cells or more, less where there are fewer.
fn extrapolation(cells: Cells) -> DMatrix<f64> {
    let unit = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let middles: Vec<[f64; 2]> = cells.over(&unit).map(|c| c.middle).collect();
    let terms = match cells {
        Cells::HalfAndQuarters => 3,
        Cells::Grid { along_xi: 1, along_eta: 1 } => 1,
        Cells::Grid { along_eta: 1, .. } => 2,
        Cells::Grid { along_xi: 1, .. } => return column_extrapolation(&middles),
        Cells::Grid { .. } => 4,
    };
    let basis = |[xi, eta]: [f64; 2]| [1.0, xi, eta, xi * eta];
    fit(&middles, terms, basis)
}

fn column_extrapolation(middles: &[[f64; 2]]) -> DMatrix<f64> {
    fit(middles, 2, |[xi, eta]| [1.0, eta, xi, xi * eta])
}

fn fit(middles: &[[f64; 2]], terms: usize, basis: impl Fn([f64; 2]) -> [f64; 4]) -> DMatrix<f64> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let at_cells = DMatrix::from_fn(middles.len(), terms, |i, j| basis(middles[i])[j]);
    let at_corners = DMatrix::from_fn(4, terms, |i, j| basis(corners[i])[j]);
    // Distinct cell middles give full column rank, so the normal equations are regular.
    let gram = at_cells.transpose() * &at_cells;
    match gram.try_inverse() {
        Some(inverse) => at_corners * inverse * at_cells.transpose(),
        None => DMatrix::from_element(4, middles.len(), 1.0 / middles.len() as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn extrapolation_is_exact_for_what_the_cells_can_carry() {
        for (nc, field) in [
            (1, [2.0, 0.0, 0.0, 0.0]),
            (2, [2.0, 3.0, 0.0, 0.0]),
            (3, [2.0, 3.0, -1.0, 0.0]),
            (4, [2.0, 3.0, -1.0, 0.5]),
            (9, [2.0, 3.0, -1.0, 0.5]),
        ] {
            let cells = Cells::from_count(nc).unwrap();
            let unit = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let value = |[x, y]: [f64; 2]| field[0] + field[1] * x + field[2] * y + field[3] * x * y;
            let at_cells: Vec<f64> = cells.over(&unit).map(|c| value(c.middle)).collect();
            let weights = extrapolation(cells);
            for (i, corner) in unit.into_iter().enumerate() {
                let got: f64 = at_cells.iter().enumerate().map(|(k, v)| weights[(i, k)] * v).sum();
                assert_relative_eq!(got, value(corner), max_relative = 1e-12);
            }
        }
    }
}
