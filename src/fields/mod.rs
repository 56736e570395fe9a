//! What the displacements mean: resultants, values at points and along lines.
//!
//! Resultants are in material axes (x = warp, y = weft), so that they compare with the section's
//! own stiffnesses whatever the mesh: `membrane` N (N/m), `moment` M (N), `shear` Q (N/m).

mod edge;
mod element;
mod error;
mod extrapolation;
mod probe;
mod reactions;
mod recovery;

pub use edge::edge_moments;
pub use error::ErrorEstimate;
pub use extrapolation::Extrapolation;
pub use probe::{Finder, Locator, ProbeValue, SampledLine, nearest};
pub use reactions::reaction_resultants;

use std::collections::BTreeSet;

use nalgebra::Vector3;

use crate::element::{SmoothingCell, membrane_and_plate};
use crate::mesh::{QuadMesh, nodes_of, normal};
use crate::model::{Load, Model, ModelError};
use crate::section::SheetLaw;
use crate::solve::nonlinear::State;
use element::{Displacement, Remembered, for_each_element, of_element, small, straining};
use recovery::{Patch, Patches};

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
    /// Names of the components and their SI units, in the order of [`components`](Self::components).
    pub const COMPONENTS: [(&str, &str); 8] = [
        ("membrane_x", "N/m"),
        ("membrane_y", "N/m"),
        ("membrane_xy", "N/m"),
        ("moment_x", "N"),
        ("moment_y", "N"),
        ("moment_xy", "N"),
        ("shear_x", "N/m"),
        ("shear_y", "N/m"),
    ];

    /// N, M and Q in one.
    pub fn components(&self) -> [f64; 8] {
        let ([nx, ny, nxy], [mx, my, mxy], [qx, qy]) = (self.membrane, self.moment, self.shear);
        [nx, ny, nxy, mx, my, mxy, qx, qy]
    }

    fn add(&mut self, other: &Self, weight: f64) {
        (0..3).for_each(|i| self.membrane[i] += weight * other.membrane[i]);
        (0..3).for_each(|i| self.moment[i] += weight * other.moment[i]);
        (0..2).for_each(|i| self.shear[i] += weight * other.shear[i]);
    }
}

/// Resultants of every smoothing cell, element by element, in the order of the cells: N and M are constant in a cell,
/// Q is that of MITC4 at its middle.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn cells(model: &Model, displacement: &[f64]) -> Result<Vec<Vec<Resultants>>, ModelError> {
    let flat = model.mesh.is_flat();
    let cells_of = |quad: usize| {
        let element = model.element(quad, flat)?;
        let (to_material, vector) = (element.to_material(), element.vector_to_material());
        let local = element.to_local() * of_element(model, displacement, quad);
        let (in_plane, plate) = membrane_and_plate(&local);
        let of_cell = |cell: SmoothingCell| {
            let (strain, curvature) = element.strains(&cell, &local);
            let membrane = match element.assumed_membrane(cell.middle) {
                Some((mean, varying)) => (model.section.d_m * to_material * mean + varying) * in_plane,
                None => model.section.d_m * to_material * strain,
            };
            let moment = model.section.d_b * to_material * curvature;
            let shear = vector * element.d_s * element.shear_strain_matrix(cell.middle) * plate;
            Resultants { membrane: membrane.into(), moment: moment.into(), shear: shear.into() }
        };
        Ok(element.cells().map(of_cell).collect())
    };
    (0..model.mesh.quads.len()).map(cells_of).collect()
}

/// Resultants of each element: the mean over its smoothing cells, shear at its centre.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn element_means(model: &Model, displacement: &[f64]) -> Result<Vec<Resultants>, ModelError> {
    means_of(model, None, small(model, displacement))
}

/// The same after large rotations: in the axes of the elements as they have turned, with the stresses of a law where the
/// sheet follows one.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn element_means_moved(
    model: &Model,
    state: &State,
    law: Option<&SheetLaw>,
) -> Result<Vec<Resultants>, ModelError> {
    means_of(model, Remembered::of(law, state), straining(model, state))
}

fn means_of(
    model: &Model,
    remembered: Option<Remembered<'_>>,
    displacement: impl Fn(usize) -> Displacement,
) -> Result<Vec<Resultants>, ModelError> {
    let mut means = Vec::with_capacity(model.mesh.quads.len());
    let (flat, quads) = (model.mesh.is_flat(), 0..model.mesh.quads.len());
    for_each_element(model, flat, remembered, quads, displacement, |_, [.., mean]| means.push(mean))?;
    Ok(means)
}

/// Mean curvature of each element, `[κ_x, κ_y, κ_xy]` in material axes, κ_xy twice that of the tensor (1/m): D_b times it is the
/// moment of an elastic sheet.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn curvatures(model: &Model, displacement: &[f64]) -> Result<Vec<[f64; 3]>, ModelError> {
    let mut all = Vec::with_capacity(model.mesh.quads.len());
    element::for_each_curvature(model, small(model, displacement), |curvature| all.push(curvature))?;
    Ok(all)
}

/// The same after large rotations, in the axes of the elements as they have turned.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn curvatures_moved(model: &Model, state: &State) -> Result<Vec<[f64; 3]>, ModelError> {
    let mut all = Vec::with_capacity(model.mesh.quads.len());
    element::for_each_curvature(model, straining(model, state), |curvature| all.push(curvature))?;
    Ok(all)
}

/// The largest absolute value of the two principal ones of a symmetric tensor `[xx, yy, xy]`.
pub fn largest_principal([x, y, xy]: [f64; 3]) -> f64 {
    (0.5 * (x + y)).abs() + (0.5 * (x - y)).hypot(xy)
}

/// Unit vector along the warp in each element at rest, the x of its resultants.
pub fn warp_directions(model: &Model) -> Vec<Vector3<f64>> {
    let of_element = |quad| {
        let normal = normal(&model.mesh.corners(quad));
        (model.warp - normal * normal.dot(&model.warp)).normalize()
    };
    (0..model.mesh.quads.len()).map(of_element).collect()
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
/// Inside the sheet, where the elements about a node are alike, N and M from each element's cells extrapolated to its
/// corners, and Q as MITC4 has it there, averaged over the elements that meet. On its boundary the quadratic patch recovery from
/// element means, with Q at the elements' centres. Inside where the elements are not alike, the same patches of N and M, and Q
/// as the divergence of M; but not next to nodes inside that are held, loaded or rigid, where moments have kinks and shear forces jump.
///
/// On a simply supported square of 32 x 32 elements whose nodes were moved at random by up to a quarter of their side, M is 0.2 % and Q 1 % off
/// in the mean where averages are 1.2 % and 20 % off, whatever the number of elements (`tests/mechanics/recovery.rs`). At clamped
/// edges averages are first order (M 12 % and Q 5 % off at 32 x 32 elements of a clamped square, where the patch recovery has 0.2 % of M
/// and 0.1 % of Q). Where the mesh
/// has too few elements for a parabola (less than three across) the averages are kept. For clamped edges
/// [`edge_moments`] is a second source, from the reactions (0.1 %).
#[derive(Clone, Debug)]
pub struct Recovery {
    flat: bool,
    /// Of the nodes that have one, in their order.
    patches: Vec<Patch>,
    /// Nodes on the boundary, in order.
    boundary: Vec<u32>,
}

impl Recovery {
    /// The patches of a mesh.
    pub fn new(mesh: &QuadMesh) -> Self {
        let patches = Patches::new(mesh);
        let mut boundary: Vec<u32> = mesh.boundary_edges().into_iter().flatten().collect();
        boundary.sort_unstable();
        boundary.dedup();
        let nodes = 0..mesh.nodes.len() as u32;
        let patches = nodes.filter_map(|node| match boundary.binary_search(&node) {
            Ok(_) => patches.at_edge(node),
            Err(_) => patches.inside(node),
        });
        let patches = patches.collect();
        Self { flat: mesh.is_flat(), patches, boundary }
    }

    /// Resultants at the nodes of a model on the mesh.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn nodal(&self, model: &Model, displacement: &[f64]) -> Result<Vec<Resultants>, ModelError> {
        self.nodal_of(model, None, small(model, displacement))
    }

    /// The same after large rotations: see [`element_means_moved`].
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn nodal_moved(
        &self,
        model: &Model,
        state: &State,
        law: Option<&SheetLaw>,
    ) -> Result<Vec<Resultants>, ModelError> {
        self.nodal_of(model, Remembered::of(law, state), straining(model, state))
    }

    /// Resultants at one point, as [`nodal`](Self::nodal) and [`Locator::value`] give them, from the
    /// elements around it alone.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn at(&self, model: &Model, displacement: &[f64], at: &Locator) -> Result<Resultants, ModelError> {
        let mesh = &model.mesh;
        let nodes = mesh.quads[at.quad];
        let kinks = self.kinks(model);
        let patches = nodes.map(|node| {
            let found = self.patches.binary_search_by_key(&node, |patch| patch.node);
            found.ok().map(|i| &self.patches[i]).filter(|patch| !is_kinked(patch, &kinks))
        });
        let touches = |quad: &usize| mesh.quads[*quad].iter().any(|n| nodes.contains(n));
        let mut quads: Vec<usize> = (0..mesh.quads.len()).filter(touches).collect();
        quads.extend(patches.iter().flatten().flat_map(|patch| patch.weights.iter().map(|(quad, _)| *quad)));
        quads.sort_unstable();
        quads.dedup();
        let mut found = Vec::with_capacity(quads.len());
        for_each_element(
            model,
            self.flat,
            None,
            quads.iter().copied(),
            small(model, displacement),
            |quad, all| {
                found.push((quad, all));
            },
        )?;
        let mut value = Resultants::default();
        for ((node, patch), share) in nodes.into_iter().zip(patches).zip(at.weights) {
            let corner = |(quad, all): &(usize, [Resultants; 5])| {
                mesh.quads[*quad].iter().position(|n| *n == node).map(|corner| all[corner])
            };
            let corners: Vec<Resultants> = found.iter().filter_map(corner).collect();
            let mut nodal = Resultants::default();
            corners.iter().for_each(|c| nodal.add(c, 1.0 / corners.len() as f64));
            if let Some(patch) = patch {
                nodal = patch.value(&model.warp, |quad| {
                    let place = found.binary_search_by_key(&quad, |(quad, _)| *quad);
                    place.map_or_else(|_| Resultants::default(), |k| found[k].1[4])
                });
            }
            value.add(&nodal, share);
        }
        Ok(value)
    }

    fn nodal_of(
        &self,
        model: &Model,
        remembered: Option<Remembered<'_>>,
        displacement: impl Fn(usize) -> Displacement,
    ) -> Result<Vec<Resultants>, ModelError> {
        let mut means = Vec::with_capacity(model.mesh.quads.len());
        let mut sums = vec![(Resultants::default(), 0.0); model.mesh.nodes.len()];
        let quads = 0..model.mesh.quads.len();
        for_each_element(model, self.flat, remembered, quads, displacement, |quad, [corners @ .., mean]| {
            means.push(mean);
            for (corner, node) in corners.iter().zip(nodes_of(&model.mesh.quads[quad])) {
                let (sum, count) = &mut sums[*node as usize];
                sum.add(corner, 1.0);
                *count += 1.0;
            }
        })?;
        let mut nodal: Vec<Resultants> = sums
            .into_iter()
            .map(|(sum, count)| {
                let mut mean = Resultants::default();
                // A node that no element uses has none.
                mean.add(&sum, 1.0 / f64::max(count, 1.0));
                mean
            })
            .collect();
        let kinks = self.kinks(model);
        for patch in self.patches.iter().filter(|patch| !is_kinked(patch, &kinks)) {
            nodal[patch.node as usize] = patch.value(&model.warp, |quad| means[quad]);
        }
        Ok(nodal)
    }

    /// Whether an element has a node inside the sheet that is held, loaded or rigid; empty where none has.
    fn kinks(&self, model: &Model) -> Vec<bool> {
        let held = model.supports.iter().flat_map(|support| &support.nodes);
        let loaded = model.loads.iter().flat_map(|load| match load {
            Load::Point { nodes, .. } => nodes.as_slice(),
            Load::Edge { edges, .. } => edges.as_flattened(),
            Load::Pressure(_) | Load::FollowerPressure(_) | Load::Gravity(_) => &[],
        });
        let rigid = model.bodies.iter().flat_map(|body| &body.nodes);
        let all = held.chain(loaded).chain(rigid);
        let inside: BTreeSet<u32> =
            all.copied().filter(|node| self.boundary.binary_search(node).is_err()).collect();
        if inside.is_empty() {
            return Vec::new();
        }
        model.mesh.quads.iter().map(|nodes| nodes.iter().any(|n| inside.contains(n))).collect()
    }
}

/// Whether a patch inside a sheet has one of the elements where something acts.
fn is_kinked(patch: &Patch, kinks: &[bool]) -> bool {
    !kinks.is_empty() && patch.inside && patch.weights.iter().any(|(quad, _)| kinks[*quad])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: a uniaxial value that is turned by 45 degrees, pure shear, and two equal values.
    #[test]
    fn the_largest_principal_value_does_not_depend_on_the_axes() {
        for (tensor, expected) in [
            ([2.0, 0.0, 0.0], 2.0),
            ([1.0, 1.0, 1.0], 2.0),
            ([0.0, 0.0, -3.0], 3.0),
            ([-1.0, -1.0, 0.0], 1.0),
        ] {
            assert_eq!(largest_principal(tensor), expected, "{tensor:?}");
        }
    }
}
