//! The points of a sheet that are kept from passing through it.

use std::collections::HashMap;

use crate::mesh::{QuadMesh, is_triangle};

/// A point of a sheet: a node, the middle of a side, or of a quad.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The quad that it goes with, and what it has of its four nodes.
    pub quad: usize,
    pub weights: [f64; 4],
    /// Its part of the sheet (m²).
    pub area: f64,
}

/// The nine points of a quad, its corners first: what they have of its nodes, and their parts of its area (Simpson's rule).
const POINTS: [([f64; 4], f64); 9] = [
    ([1.0, 0.0, 0.0, 0.0], 1.0 / 36.0),
    ([0.0, 1.0, 0.0, 0.0], 1.0 / 36.0),
    ([0.0, 0.0, 1.0, 0.0], 1.0 / 36.0),
    ([0.0, 0.0, 0.0, 1.0], 1.0 / 36.0),
    ([0.5, 0.5, 0.0, 0.0], 4.0 / 36.0),
    ([0.0, 0.5, 0.5, 0.0], 4.0 / 36.0),
    ([0.0, 0.0, 0.5, 0.5], 4.0 / 36.0),
    ([0.5, 0.0, 0.0, 0.5], 4.0 / 36.0),
    ([0.25, 0.25, 0.25, 0.25], 16.0 / 36.0),
];

/// The seven points of a triangle that is a quad with its last node twice, at the same places of the list.
const OF_TRIANGLE: [([f64; 4], f64); 9] = [
    ([1.0, 0.0, 0.0, 0.0], 1.0 / 20.0),
    ([0.0, 1.0, 0.0, 0.0], 1.0 / 20.0),
    ([0.0, 0.0, 1.0, 0.0], 1.0 / 20.0),
    ([0.0, 0.0, 1.0, 0.0], 0.0),
    ([0.5, 0.5, 0.0, 0.0], 2.0 / 15.0),
    ([0.0, 0.5, 0.5, 0.0], 2.0 / 15.0),
    ([0.0, 0.0, 1.0, 0.0], 0.0),
    ([0.5, 0.0, 0.5, 0.0], 2.0 / 15.0),
    ([1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.0], 9.0 / 20.0),
];

/// The points of a mesh whose quads have these areas, each once, and which of them are on each quad.
pub fn samples(mesh: &QuadMesh, areas: &[f64]) -> (Vec<Sample>, Vec<[usize; 9]>) {
    let (mut samples, mut of_quads) = (Vec::new(), Vec::with_capacity(mesh.quads.len()));
    // By the nodes that a point lies between; one in the middle of a quad is its own.
    let mut known: HashMap<[u32; 2], usize> = HashMap::new();
    for (quad, nodes) in mesh.quads.iter().enumerate() {
        let mut of_quad = [0; 9];
        let points = if is_triangle(nodes) { OF_TRIANGLE } else { POINTS };
        for (k, (weights, part)) in points.into_iter().enumerate() {
            let mut own = || {
                samples.push(Sample { quad, weights, area: 0.0 });
                samples.len() - 1
            };
            of_quad[k] = match k {
                0..4 => *known.entry([nodes[k]; 2]).or_insert_with(own),
                4..8 => {
                    let [a, b] = [nodes[k - 4], nodes[(k - 3) % 4]];
                    *known.entry([a.min(b), a.max(b)]).or_insert_with(own)
                }
                _ => own(),
            };
            samples[of_quad[k]].area += part * areas[quad];
        }
        of_quads.push(of_quad);
    }
    (samples, of_quads)
}
