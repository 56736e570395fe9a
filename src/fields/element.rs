//! Resultants of one element as linear functions of its displacements: found once for all elements
//! that are equal up to a translation.

use nalgebra::{DMatrix, Matrix3, Point3, SMatrix, Vector3};

use super::Resultants;
use crate::element::corotational::{Motion, ReferenceFrame};
use crate::element::{
    Arcs, Cells, Frame, Matrix24, Vector24, YarnStrain, Yarns, membrane_and_plate, strain_matrices,
};
use crate::law;
use crate::mesh::is_translated;
use crate::model::{Model, ModelError};
use crate::section::SheetLaw;
use crate::solve::nonlinear::State;

/// Places of an element that have resultants: its four corners, then its mean.
const PLACES: usize = 5;
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Laws with a memory, and what they remember of each smoothing cell.
#[derive(Clone, Copy)]
pub struct Remembered<'a> {
    law: &'a SheetLaw,
    /// In the order of elements and cells; empty for new cloth.
    cells: &'a [[law::State; 6]],
}

impl<'a> Remembered<'a> {
    /// What a state remembers, if there is a law.
    pub fn of(law: Option<&'a SheetLaw>, state: &'a State) -> Option<Self> {
        law.map(|law| Self { law, cells: &state.memory.cells })
    }
}

/// The resultants at all places, each with its rows, for local displacements: N for `(u, v, θz)`, M
/// and Q for `(w, θx, θy)`, node by node.
struct Operator {
    corners: [Point3<f64>; 4],
    /// `None` where the local displacements are the global ones.
    to_local: Option<Matrix24>,
    membrane: SMatrix<f64, { 3 * PLACES }, 12>,
    moment: SMatrix<f64, { 3 * PLACES }, 12>,
    shear: SMatrix<f64, { 2 * PLACES }, 12>,
    /// What the mean strain of large motions has above the linear one: stretches of the yarns and their angle, and the
    /// arcs of a bent element where chords are not measured; and the membrane stiffness that it meets.
    yarns: Yarns,
    arcs: Option<Arcs>,
    d_m: Matrix3<f64>,
    /// What the value of each cell counts at each place.
    weights: Vec<[f64; PLACES]>,
}

impl Operator {
    /// `weights` are those of [`extrapolation`]; `d` are the matrices of membrane and bending, material axes.
    fn new(
        model: &Model,
        quad: usize,
        flat: bool,
        weights: &DMatrix<f64>,
        [d_m, d_b]: [Matrix3<f64>; 2],
    ) -> Result<Self, ModelError> {
        let element = model.element(quad, flat)?;
        let vector = element.vector_to_material();
        let (of_strain, of_curvature) = (d_m * element.to_material(), d_b * element.to_material());
        let area: f64 = element.cells().map(|cell| cell.area).sum();
        let weights: Vec<[f64; PLACES]> = element
            .cells()
            .enumerate()
            .map(|(k, cell)| {
                std::array::from_fn(|place| if place < 4 { weights[(place, k)] } else { cell.area / area })
            })
            .collect();
        let (mut membrane, mut moment) = (SMatrix::zeros(), SMatrix::zeros());
        for (cell, weights) in element.cells().zip(&weights) {
            let (strain, curvature) = strain_matrices(&cell);
            let (n, m) = (of_strain * strain, of_curvature * curvature);
            for (place, weight) in weights.iter().enumerate() {
                let add = |sum: &mut SMatrix<f64, { 3 * PLACES }, 12>, part: &SMatrix<f64, 3, 12>| {
                    let mut rows = sum.fixed_rows_mut::<3>(3 * place);
                    rows += part * *weight;
                };
                add(&mut membrane, &n);
                add(&mut moment, &m);
            }
        }
        let mut shear: SMatrix<f64, { 2 * PLACES }, 12> = SMatrix::zeros();
        for (place, at) in CORNERS.into_iter().chain([element.frame.middle()]).enumerate() {
            if let Some((mean, varying)) = element.assumed_membrane(at) {
                // The mean of the element is that of its constant stresses.
                let varying = if place < 4 { varying } else { SMatrix::zeros() };
                membrane.fixed_rows_mut::<3>(3 * place).copy_from(&(of_strain * mean + varying));
            }
            let q: SMatrix<f64, 2, 12> = vector * element.d_s * element.shear_strain_matrix(at);
            shear.fixed_rows_mut::<2>(2 * place).copy_from(&q);
        }
        let to_local = Some(element.to_local()).filter(|t| *t != Matrix24::identity());
        // In the frame that the element is moved in, whatever the axes here.
        let in_motion = model.element(quad, false)?;
        let (yarns, arcs, corners) = (in_motion.yarns(), in_motion.arcs(), model.mesh.corners(quad));
        Ok(Self { corners, to_local, membrane, moment, shear, yarns, arcs, d_m, weights })
    }

    /// Adds the stresses that the cells of an element remember.
    fn add_remembered(&self, remembered: &Remembered<'_>, quad: usize, all: &mut [Resultants; PLACES]) {
        let count = self.weights.len();
        let Some(cells) = remembered.cells.get(quad * count..(quad + 1) * count) else { return };
        for (states, weights) in cells.iter().zip(&self.weights) {
            let [nx, ny, nxy, mx, my, mxy] = remembered.law.stresses(states);
            let stress =
                Resultants { membrane: [nx, ny, nxy], moment: [mx, my, mxy], ..Resultants::default() };
            all.iter_mut().zip(weights).for_each(|(at, weight)| at.add(&stress, *weight));
        }
    }

    /// The membrane forces that the linear strain of a motion in its frame lacks (N/m).
    fn above_linear(&self, local: &Vector24) -> Vector3<f64> {
        self.d_m * above_linear(&self.yarns, self.arcs.as_ref(), local)
    }

    fn apply(&self, motion: &Displacement) -> [Resultants; PLACES] {
        let added = motion.in_frame.as_ref().map_or_else(Vector3::zeros, |local| self.above_linear(local));
        let u = &motion.global;
        let (membrane, plate) = membrane_and_plate(&self.to_local.map_or(*u, |t| t * u));
        let (n, m, q) = (self.membrane * membrane, self.moment * plate, self.shear * plate);
        std::array::from_fn(|p| Resultants {
            membrane: [0, 1, 2].map(|i| n[3 * p + i] + added[i]),
            moment: [0, 1, 2].map(|i| m[3 * p + i]),
            shear: [0, 1].map(|i| q[2 * p + i]),
        })
    }
}

/// Displacements of the nodes of an element.
pub struct Displacement {
    /// In global axes; of large ones the part that strains the element, turned back to where it rests.
    pub global: Vector24,
    /// The same in the axes of the frame, of large ones.
    in_frame: Option<Vector24>,
}

impl Displacement {
    /// What the mean membrane strain of the element has above the linear one, material axes; nothing for small motions.
    pub fn above_linear(&self, model: &Model, quad: usize) -> Result<Vector3<f64>, ModelError> {
        let Some(local) = &self.in_frame else { return Ok(Vector3::zeros()) };
        // In the frame that the element is moved in, whatever the axes elsewhere.
        let element = model.element(quad, false)?;
        Ok(above_linear(&element.yarns(), element.arcs().as_ref(), local))
    }
}

/// What the mean membrane strain of a large motion in its frame has above the linear one: stretches of the yarns and their
/// angle, and the arcs of a bent element.
fn above_linear(yarns: &Yarns, arcs: Option<&Arcs>, local: &Vector24) -> Vector3<f64> {
    let arcs = arcs.map_or_else(Vector3::zeros, |arcs| arcs.bent(local).strain);
    YarnStrain::of(&yarns.gradient(local)).excess + arcs
}

/// Displacements of the nodes of an element, taken for small.
pub fn small<'a>(model: &'a Model, displacement: &'a [f64]) -> impl Fn(usize) -> Displacement + 'a {
    |quad| Displacement { global: of_element(model, displacement, quad), in_frame: None }
}

/// Six displacements of each node of an element.
pub fn of_element(model: &Model, displacement: &[f64], quad: usize) -> Vector24 {
    let nodes = &model.mesh.quads[quad];
    Vector24::from_fn(|k, _| displacement[6 * nodes[k / 6] as usize + k % 6])
}

/// The part of the motion of an element's nodes that strains it, turned back to where the element rests.
pub fn straining<'a>(model: &'a Model, state: &'a State) -> impl Fn(usize) -> Displacement + 'a {
    |quad| {
        let nodes = model.mesh.quads[quad].map(|n| n as usize);
        let frame = Frame::of(&model.mesh.corners(quad));
        let (places, turns) = (nodes.map(|n| state.position[n]), nodes.map(|n| state.rotation[n]));
        let deformation = Motion::of(&ReferenceFrame::of(&frame), &places, &turns).deformation;
        let mut u = Vector24::zeros();
        for b in 0..8 {
            let part = frame.rotation.transpose() * deformation.fixed_rows::<3>(3 * b);
            u.fixed_rows_mut::<3>(3 * b).copy_from(&part);
        }
        Displacement { global: u, in_frame: Some(deformation) }
    }
}

/// Calls `visit` with each of some elements and its resultants: at the corners, N and M extrapolated from the
/// cells (N of assumed stresses as they are there) and Q as MITC4 or MITC3 has it; then the mean over the cells, with Q at the
/// centre.
pub fn for_each_element(
    model: &Model,
    flat: bool,
    remembered: Option<Remembered<'_>>,
    quads: impl Iterator<Item = usize>,
    displacement: impl Fn(usize) -> Displacement,
    visit: impl FnMut(usize, [Resultants; PLACES]),
) -> Result<(), ModelError> {
    let section = &model.section;
    let d = remembered.map_or([section.d_m, section.d_b], |r| r.law.beside(section));
    for_each_element_of(model, flat, (remembered, d), quads, displacement, visit)
}

/// The mean curvature of each element in material axes, `[κ_x, κ_y, κ_xy]` with κ_xy twice that of the tensor (1/m).
pub fn for_each_curvature(
    model: &Model,
    displacement: impl Fn(usize) -> Displacement,
    mut visit: impl FnMut([f64; 3]),
) -> Result<(), ModelError> {
    // A moment is the stiffness of bending times the curvature: that of the unit stiffness is the curvature.
    let d = [model.section.d_m, Matrix3::identity()];
    let quads = 0..model.mesh.quads.len();
    for_each_element_of(model, false, (None, d), quads, displacement, |_, [.., mean]| visit(mean.moment))
}

fn for_each_element_of(
    model: &Model,
    flat: bool,
    (remembered, d): (Option<Remembered<'_>>, [Matrix3<f64>; 2]),
    quads: impl Iterator<Item = usize>,
    displacement: impl Fn(usize) -> Displacement,
    mut visit: impl FnMut(usize, [Resultants; PLACES]),
) -> Result<(), ModelError> {
    let weights = extrapolation(model.formulation.cells);
    let mut last: Option<Operator> = None;
    for quad in quads {
        let corners = model.mesh.corners(quad);
        if !last.as_ref().is_some_and(|operator| is_translated(&operator.corners, &corners)) {
            last = Some(Operator::new(model, quad, flat, &weights, d)?);
        }
        if let Some(operator) = &last {
            let mut all = operator.apply(&displacement(quad));
            if let Some(remembered) = &remembered {
                operator.add_remembered(remembered, quad, &mut all);
            }
            visit(quad, all);
        }
    }
    Ok(())
}

/// Weights (4 corners x cells) of the least-squares surface through the cell values, in natural
/// coordinates: bilinear through 2 x 2 cells or more, less where there are fewer.
fn extrapolation(cells: Cells) -> DMatrix<f64> {
    let middles: Vec<[f64; 2]> = cells.over(&CORNERS).map(|c| c.middle).collect();
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
    let at_cells = DMatrix::from_fn(middles.len(), terms, |i, j| basis(middles[i])[j]);
    let at_corners = DMatrix::from_fn(4, terms, |i, j| basis(CORNERS[i])[j]);
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
