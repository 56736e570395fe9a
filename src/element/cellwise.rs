//! The element cell by cell, for a law that is not linear: what strains each smoothing cell, and the
//! forces and the stiffness that the answers of the cells add up to.
//!
//! The element knows no law. It hands out the strains of its cells along the material axes, and
//! takes back one stress and one tangent for each.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::SmoothingCell;
use super::prepared::{Matrix24, Vector24};

/// Strains of a cell along the material axes, `(ε_x, ε_y, γ_xy, κ_x, κ_y, κ_xy)` (-, 1/m), or what
/// is conjugate to them, `(N_x, N_y, N_xy, M_x, M_y, M_xy)` (N/m, N).
pub type Strains = [f64; 6];

/// Dofs that stretch, and dofs that bend a cell.
pub(super) const STRETCHING: [usize; 8] = [0, 1, 6, 7, 12, 13, 18, 19];
const BENDING: [usize; 8] = [3, 4, 9, 10, 15, 16, 21, 22];

/// Rows of the strains of a membrane on the dofs that stretch it.
pub type Gradient = SMatrix<f64, 3, 8>;

/// Area (m²) of a cell, and the rows of its strains on the dofs that stretch and that bend.
#[derive(Clone, Debug)]
struct CellGradient {
    area: f64,
    membrane: Gradient,
    bending: Gradient,
}

/// An element whose cells follow laws of their own, in the axes of its frame.
#[derive(Clone, Debug)]
pub struct Cellwise {
    cells: Vec<CellGradient>,
    /// Stiffness of all that stays linear, rigid links included.
    linear: Matrix24,
    /// Rigid links from the corners to the plane; `None` if they lie in it.
    links: Option<Matrix24>,
}

impl Cellwise {
    /// From the cells, the map of strains to the material axes, whether membrane and bending are smoothed over all
    /// cells as one, the stiffness of the part that stays linear, and the rigid links of a warped element.
    pub(super) fn new(
        cells: impl Iterator<Item = SmoothingCell>,
        to_material: &Matrix3<f64>,
        [one_membrane_cell, one_bending_cell]: [bool; 2],
        linear: Matrix24,
        links: Option<Matrix24>,
    ) -> Self {
        let gradient = |cell: SmoothingCell| {
            let (mut membrane, mut bending) = (Gradient::zeros(), Gradient::zeros());
            for (i, [bx, by]) in cell.gradient.into_iter().enumerate() {
                // Eqs. (22) and (23), corrected: (u, v) and (θx, θy).
                membrane[(0, 2 * i)] = bx;
                membrane[(1, 2 * i + 1)] = by;
                membrane[(2, 2 * i)] = by;
                membrane[(2, 2 * i + 1)] = bx;
                bending[(0, 2 * i + 1)] = bx;
                bending[(1, 2 * i)] = -by;
                bending[(2, 2 * i)] = -bx;
                bending[(2, 2 * i + 1)] = by;
            }
            CellGradient { area: cell.area, membrane: to_material * membrane, bending: to_material * bending }
        };
        let mut cells: Vec<CellGradient> = cells.map(gradient).collect();
        let area: f64 = cells.iter().map(|c| c.area).sum();
        let mean = |of: fn(&CellGradient) -> &Gradient| {
            cells.iter().fold(Gradient::zeros(), |g, c| g + of(c) * (c.area / area))
        };
        let membrane = one_membrane_cell.then(|| mean(|c| &c.membrane));
        let bending = one_bending_cell.then(|| mean(|c| &c.bending));
        for cell in &mut cells {
            cell.membrane = membrane.unwrap_or(cell.membrane);
            cell.bending = bending.unwrap_or(cell.bending);
        }
        Self { cells, linear, links }
    }

    /// Areas of the cells (m²).
    pub fn areas(&self) -> impl Iterator<Item = f64> {
        self.cells.iter().map(|cell| cell.area)
    }

    /// Strains of the cells for local displacements, with the `excess` of all of them in the plane.
    pub fn strains(&self, local: &Vector24, excess: Vector3<f64>) -> impl Iterator<Item = Strains> {
        let plane = self.links.map_or(*local, |links| links * local);
        let (stretching, bending) = (pick(&plane, &STRETCHING), pick(&plane, &BENDING));
        self.cells.iter().map(move |cell| {
            let (e, k) = (cell.membrane * stretching + excess, cell.bending * bending);
            [e.x, e.y, e.z, k.x, k.y, k.z]
        })
    }

    /// Rates of the strains of the cells with those of the local displacements; `excess` are the rows of the
    /// excess, `warp` the rates of a strain that all cells have besides.
    pub fn strain_rates(
        &self,
        rates: &Vector24,
        excess: &Gradient,
        warp: Vector3<f64>,
    ) -> impl Iterator<Item = Strains> {
        let plane = self.links.map_or(*rates, |links| links * rates);
        self.strains(rates, excess * pick(&plane, &STRETCHING) + warp)
    }

    /// Local stiffness of what stays linear.
    pub fn linear(&self) -> &Matrix24 {
        &self.linear
    }

    /// Local force of the stresses of the cells, `excess` added to the rows of each of them.
    pub fn cell_force(&self, stresses: &[Strains], excess: &Gradient) -> Vector24 {
        let (mut stretching, mut bending) = (SVector::<f64, 8>::zeros(), SVector::<f64, 8>::zeros());
        for (cell, [nx, ny, nxy, mx, my, mxy]) in self.cells.iter().zip(stresses) {
            stretching += (cell.membrane + excess).tr_mul(&Vector3::new(*nx, *ny, *nxy)) * cell.area;
            bending += cell.bending.tr_mul(&Vector3::new(*mx, *my, *mxy)) * cell.area;
        }
        let mut plane = Vector24::zeros();
        for i in 0..8 {
            plane[STRETCHING[i]] = stretching[i];
            plane[BENDING[i]] = bending[i];
        }
        self.links.map_or(plane, |links| links.tr_mul(&plane))
    }

    /// Local stiffness of the cells for their tangents; `excess` as in [`strain_rates`](Self::strain_rates).
    pub fn stiffness(&self, tangents: &[Strains], excess: &Gradient) -> Matrix24 {
        let (mut stretching, mut bending) = (SMatrix::<f64, 8, 8>::zeros(), SMatrix::<f64, 8, 8>::zeros());
        for (cell, tangent) in self.cells.iter().zip(tangents) {
            add(&mut stretching, &(cell.membrane + excess), &tangent[..3], cell.area);
            add(&mut bending, &cell.bending, &tangent[3..], cell.area);
        }
        let mut plane = Matrix24::zeros();
        for (i, j) in (0..8).flat_map(|j| (0..8).map(move |i| (i, j))) {
            plane[(STRETCHING[i], STRETCHING[j])] += stretching[(i, j)];
            plane[(BENDING[i], BENDING[j])] += bending[(i, j)];
        }
        self.links.map_or(plane, |links| links.transpose() * plane * links)
    }
}

/// Adds `area gᵀ diag(tangent) g`.
fn add(k: &mut SMatrix<f64, 8, 8>, g: &Gradient, tangent: &[f64], area: f64) {
    let mut scaled = *g;
    for (row, t) in tangent.iter().enumerate() {
        scaled.row_mut(row).scale_mut(area * t);
    }
    *k += g.tr_mul(&scaled);
}

pub(super) fn pick(local: &Vector24, dofs: &[usize; 8]) -> SVector<f64, 8> {
    SVector::from_fn(|k, _| local[dofs[k]])
}
