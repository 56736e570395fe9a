//! Layers of a sheet that touch each other: folds.
//!
//! Two layers touch when their middles are as far apart as the sheet is thick. Nearer, each point of either is pressed away
//! from the nearest place of the other on each of its sides by the barrier of incremental potential contact,
//! `b(d) = -κ (d - t)² ln(d/t)` per area (Li et al., *ACM Trans. Graph.* 39 (2020) 49): smooth where it begins, and without bound at
//! d = 0. Points are the nodes, the middles of the sides and of the quads with their parts of the area, so that
//! the pressure does not depend on the mesh (Li et al., *arXiv* 2307.15908 (2023)). κ is such that the load of one layer on
//! another takes a fifth of the thickness. Half of what presses comes from the points of either layer.
//!
//! No step brings a point nearer to a triangle of another layer than a tenth of their distance
//! ([`safe_part`]), so that points cannot pass through the sheet; two sides that cross between their points can, by less than their
//! distance. Layers slide on each other without friction.
//!
//! Forces between layers tie nodes together that no element joins. The pattern of the tangent is made anew when a pair of quads
//! comes near that it has no place for.

mod closest;
mod samples;

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use nalgebra::{Matrix3, Point3, Vector3};

use self::closest::{Distance, NODES, closest, safe_part};
use self::samples::{Sample, samples};
use super::State;
use crate::mesh::{BoundingBox, QuadMesh, overlapping};
use crate::model::{DofGroup, Links, Model};
use crate::solve::assemble::Pattern;
use crate::solve::factor::{self, FactorError, Path, SymbolicAnalysis};
use crate::solve::sparse::BlockMatrix;

/// The part of their distance that a step leaves between a point and a triangle.
const LEFT: f64 = 0.1;

/// Part of the thickness that the load of one layer on another takes.
const YIELDING: f64 = 0.2;

/// Quads whose middles are within so many thicknesses of touching have a place in the pattern.
const REACH: f64 = 4.0;

/// A sheet that keeps its layers apart.
pub(super) struct Layers<'a> {
    mesh: &'a QuadMesh,
    path: Path,
    /// Distance of layers that touch (m).
    thickness: f64,
    /// Of the barrier (N/m³).
    stiffness: f64,
    samples: Vec<Sample>,
    of_quads: Vec<[usize; 9]>,
    coupling: Mutex<Option<Arc<Coupling>>>,
}

/// A pattern with places for quads that are near each other.
pub(super) struct Coupling {
    pub pattern: Pattern,
    /// Where the nodes were when it was made: layers that touch are near each other there.
    places: Vec<[f64; 3]>,
    path: Path,
    analysis: OnceLock<SymbolicAnalysis>,
}

/// A point and a triangle that press each other.
pub(super) struct Contact {
    /// Four of the point, three of the triangle.
    pub nodes: [u32; NODES],
    quads: [usize; 2],
    distance: Distance,
    /// Energy (J) and its derivatives by the distance.
    pub energy: f64,
    slope: f64,
    bend: f64,
}

impl Contact {
    /// Force on one of its nodes (N).
    pub fn force(&self, i: usize) -> Vector3<f64> {
        self.distance.normal * (-self.slope * self.distance.weights[i])
    }

    /// Stiffness between two of its nodes (N/m).
    pub fn stiffness(&self, i: usize, j: usize) -> Matrix3<f64> {
        let Distance { normal, weights, .. } = &self.distance;
        normal * normal.transpose() * (self.bend * weights[i] * weights[j])
            + self.distance.curvature(i, j) * self.slope
    }
}

/// A point near a quad.
struct Near {
    sample: usize,
    quad: usize,
    triangle: [u32; 3],
    /// Whether the quad is on the side of the normal of the sheet.
    above: bool,
    distance: Distance,
}

impl<'a> Layers<'a> {
    /// Of a mesh whose quads have these areas (m²); `load` is what presses them on each other (Pa).
    pub fn new(mesh: &'a QuadMesh, areas: &[f64], [thickness, load]: [f64; 2], path: Path) -> Self {
        let (samples, of_quads) = samples(mesh, areas);
        // b'(t (1 - ε)) = -3 κ t ε² for a small ε.
        let stiffness = load / (3.0 * thickness * YIELDING * YIELDING);
        let coupling = Mutex::new(None);
        Self { mesh, path, thickness, stiffness, samples, of_quads, coupling }
    }

    /// What presses in a state.
    pub fn contacts(&self, places: &[Point3<f64>]) -> Vec<Contact> {
        let mut near: Vec<Near> = Vec::new();
        for pair in self.pairs(places, None, 0.5 * self.thickness) {
            for [of, quad] in [pair, [pair[1], pair[0]]] {
                near.extend(self.of_quads[of].iter().filter_map(|s| self.near(places, *s, quad)));
            }
        }
        near.sort_by(|a, b| {
            let order = (a.sample, a.above).cmp(&(b.sample, b.above));
            order.then(a.distance.value.total_cmp(&b.distance.value)).then(a.quad.cmp(&b.quad))
        });
        near.dedup_by_key(|near| (near.sample, near.above));
        near.iter().map(|near| self.contact(near)).collect()
    }

    /// Pairs of quads without a common node whose boxes, after a motion too, come within twice `margin`.
    fn pairs(&self, places: &[Point3<f64>], ways: Option<&[Vector3<f64>]>, margin: f64) -> Vec<[usize; 2]> {
        let quads = &self.mesh.quads;
        let about = |quad: &[u32; 4]| {
            let now = BoundingBox::of(quad.map(|n| &places[n as usize]), margin);
            let Some(ways) = ways else { return now };
            let then = quad.map(|n| places[n as usize] + ways[n as usize]);
            now.with(&BoundingBox::of(&then, margin))
        };
        let boxes: Vec<BoundingBox> = quads.iter().map(about).collect();
        let mut pairs = overlapping(&boxes);
        pairs.retain(|[a, b]| !quads[*a].iter().any(|n| quads[*b].contains(n)));
        pairs
    }

    /// A point if it is nearer to a quad than the sheet is thick, and was not at rest.
    fn near(&self, places: &[Point3<f64>], sample: usize, quad: usize) -> Option<Near> {
        let Sample { quad: own, weights, .. } = &self.samples[sample];
        let nodes = &self.mesh.quads[*own];
        if self.mesh.quads[quad].iter().any(|n| nodes.contains(n)) {
            return None;
        }
        let point = middle(places, nodes, weights);
        let nearest = triangles(&self.mesh.quads[quad])
            .map(|triangle| (triangle, Distance::of(&point, weights, &triangle.map(|n| places[n as usize]))));
        let [a, b] = nearest;
        let (triangle, distance) = if b.1.value < a.1.value { b } else { a };
        if distance.value >= self.thickness || distance.value == 0.0 || self.were_near(sample, &triangle) {
            return None;
        }
        let [a, b, c, d] = nodes.map(|n| places[n as usize]);
        let above = (c - a).cross(&(d - b)).dot(&distance.normal) < 0.0;
        Some(Near { sample, quad, triangle, above, distance })
    }

    /// Whether a point and a triangle of the sheet at rest are so near that they belong together.
    fn were_near(&self, sample: usize, triangle: &[u32; 3]) -> bool {
        let Sample { quad, weights, .. } = &self.samples[sample];
        let places = &self.mesh.nodes;
        let point = middle(places, &self.mesh.quads[*quad], weights);
        let corners = triangle.map(|n| places[n as usize]);
        let (shares, _) = closest(&point, &corners);
        let on = (0..3).fold(Vector3::zeros(), |sum, k| sum + corners[k].coords * shares[k]);
        (point.coords - on).norm() <= 2.0 * self.thickness
    }

    fn contact(&self, near: &Near) -> Contact {
        let sample = &self.samples[near.sample];
        let (d, t) = (near.distance.value, self.thickness);
        let (short, log) = (d - t, (d / t).ln());
        let k = 0.5 * sample.area * self.stiffness;
        let [a, b, c, e] = self.mesh.quads[sample.quad];
        let [f, g, h] = near.triangle;
        Contact {
            nodes: [a, b, c, e, f, g, h],
            quads: [sample.quad.min(near.quad), sample.quad.max(near.quad)],
            distance: near.distance,
            energy: -k * short * short * log,
            slope: -k * (2.0 * short * log + short * short / d),
            bend: -k * (2.0 * log + 4.0 * short / d - short * short / (d * d)),
        }
    }

    /// The part of a motion of the nodes that brings no point to another layer.
    pub fn free_part(&self, places: &[Point3<f64>], ways: &[Vector3<f64>]) -> f64 {
        let mut part: f64 = 1.0;
        for pair in self.pairs(places, Some(ways), 0.0) {
            if self.keep_their_distance(places, ways, pair) {
                continue;
            }
            for [of, quad] in [pair, [pair[1], pair[0]]] {
                for sample in self.of_quads[of] {
                    part = part.min(self.free_part_of(places, ways, sample, quad));
                }
            }
        }
        part
    }

    /// Whether two quads move less towards each other than their boxes are apart.
    fn keep_their_distance(&self, places: &[Point3<f64>], ways: &[Vector3<f64>], pair: [usize; 2]) -> bool {
        let nodes = self.tied(&pair).map(|n| n as usize);
        let mean = nodes.iter().map(|n| ways[*n]).sum::<Vector3<f64>>() / nodes.len() as f64;
        let longest = nodes.iter().map(|n| (ways[*n] - mean).norm()).fold(0.0, f64::max);
        let [one, other] =
            pair.map(|quad| BoundingBox::of(self.mesh.quads[quad].map(|n| &places[n as usize]), 0.0));
        let apart = (one.low - other.high).sup(&(other.low - one.high)).sup(&Vector3::zeros());
        (1.0 - LEFT) * apart.norm() > 2.0 * longest
    }

    fn free_part_of(&self, places: &[Point3<f64>], ways: &[Vector3<f64>], sample: usize, quad: usize) -> f64 {
        let Sample { quad: own, weights, .. } = &self.samples[sample];
        let nodes = &self.mesh.quads[*own];
        if self.mesh.quads[quad].iter().any(|n| nodes.contains(n)) {
            return 1.0;
        }
        let point = middle(places, nodes, weights);
        let displacement = (0..4).fold(Vector3::zeros(), |sum, k| sum + ways[nodes[k] as usize] * weights[k]);
        let parts = triangles(&self.mesh.quads[quad]).map(|triangle| {
            let [a, b, c] = triangle.map(|n| n as usize);
            let corners = [point, places[a], places[b], places[c]];
            let part = safe_part(&corners, &[displacement, ways[a], ways[b], ways[c]], LEFT);
            // What belongs together at rest, as the lips of a slit, is pressed by no barrier.
            if part < 1.0 && self.were_near(sample, &triangle) { 1.0 } else { part }
        });
        parts[0].min(parts[1])
    }

    /// The pattern that has places for these contacts; `None` if there are none, for the sheet's own pattern has all that is needed.
    pub fn coupling(
        &self,
        links: &Arc<Links>,
        places: &[Point3<f64>],
        contacts: &[Contact],
    ) -> Option<Arc<Coupling>> {
        if contacts.is_empty() {
            return None;
        }
        let mut last = self.coupling.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(coupling) = last.as_ref().filter(|coupling| contacts.iter().all(|c| coupling.holds(c))) {
            return Some(Arc::clone(coupling));
        }
        let margin = 0.5 * REACH * self.thickness;
        let at_rest = |quad: usize| {
            BoundingBox::of(self.mesh.quads[quad].map(|n| &self.mesh.nodes[n as usize]), margin)
        };
        let mut pairs = self.pairs(places, None, margin);
        pairs.retain(|[one, other]| !at_rest(*one).overlaps(&at_rest(*other)));
        pairs.extend(contacts.iter().map(|contact| contact.quads));
        let tied: Vec<[u32; 8]> = pairs.iter().map(|pair| self.tied(pair)).collect();
        let pattern = Pattern::tied(self.mesh, Arc::clone(links), &tied);
        let places = places.iter().map(|p| [p.x, p.y, p.z]).collect();
        let coupling = Arc::new(Coupling { pattern, places, path: self.path, analysis: OnceLock::new() });
        *last = Some(Arc::clone(&coupling));
        Some(coupling)
    }

    /// The last coupling, if a matrix has its pattern.
    pub fn coupling_of(&self, matrix: &BlockMatrix) -> Option<Arc<Coupling>> {
        let last = self.coupling.lock().unwrap_or_else(PoisonError::into_inner);
        last.as_ref().filter(|coupling| Arc::ptr_eq(&coupling.pattern.graph, &matrix.graph)).map(Arc::clone)
    }

    fn tied(&self, [one, other]: &[usize; 2]) -> [u32; 8] {
        let [a, b, c, d] = self.mesh.quads[*one];
        let [e, f, g, h] = self.mesh.quads[*other];
        [a, b, c, d, e, f, g, h]
    }
}

impl Coupling {
    fn holds(&self, contact: &Contact) -> bool {
        let leads = contact.nodes.map(|n| self.pattern.links.leads[n as usize]);
        let mut pairs =
            leads[..4].iter().flat_map(|a| leads[4..].iter().map(move |b| [*a.max(b), *a.min(b)]));
        pairs.all(|[row, column]| self.pattern.graph.find(row, column).is_some())
    }

    /// The analysis of its pattern, made when it is first asked for.
    ///
    /// # Errors
    /// [`FactorError::OutOfMemory`].
    pub fn analysis(&self) -> Result<&SymbolicAnalysis, FactorError> {
        if let Some(analysis) = self.analysis.get() {
            return Ok(analysis);
        }
        let (graph, dofs) = (&self.pattern.graph, DofGroup::Shell.dofs().len());
        let analysis = factor::analyse(graph, dofs, Some(&self.places), self.path)?;
        Ok(self.analysis.get_or_init(|| analysis))
    }
}

/// Layers of a sheet that are nearer to each other than it is thick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayersInTouch {
    /// How many points (nodes, middles of sides and of elements) are.
    pub points: usize,
    /// The distance of the nearest (m).
    pub distance: f64,
    /// Where it is (m).
    pub at: [f64; 3],
}

/// The layers of a sheet that touch in a state. Those that have passed through each other are found by [`crossings`](crate::mesh::crossings).
pub fn layers_in_touch(model: &Model, state: &State) -> Option<LayersInTouch> {
    let (mesh, thickness) = (&model.mesh, model.section.thickness);
    let layers = Layers::new(mesh, &vec![0.0; mesh.quads.len()], [thickness, 0.0], Path::Auto);
    let contacts = layers.contacts(&state.position);
    let nearest = contacts.iter().min_by(|a, b| a.distance.value.total_cmp(&b.distance.value))?;
    let [a, b, c, d, ..] = nearest.nodes;
    let [e, f, g, h, ..] = nearest.distance.weights;
    let at = middle(&state.position, &[a, b, c, d], &[e, f, g, h]);
    Some(LayersInTouch { points: contacts.len(), distance: nearest.distance.value, at: at.coords.into() })
}

/// The two triangles that a quad is parted into; one is there twice if it is one already.
fn triangles([a, b, c, d]: &[u32; 4]) -> [[u32; 3]; 2] {
    [[*a, *b, *c], if c == d { [*a, *b, *c] } else { [*a, *c, *d] }]
}

/// The mean of the places of some nodes.
fn middle(places: &[Point3<f64>], nodes: &[u32; 4], weights: &[f64; 4]) -> Point3<f64> {
    Point3::from((0..4).fold(Vector3::zeros(), |sum, k| sum + places[nodes[k] as usize].coords * weights[k]))
}

#[cfg(test)]
mod tests;
