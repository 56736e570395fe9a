//! What all supports together do.

use nalgebra::{Point3, Vector3};

/// Sum of the forces (N), and of their moments about the origin (N·m), `Σ r × R + M`, of reactions (six a node) that
/// act at these places.
pub fn reaction_resultants(places: &[Point3<f64>], reaction: &[f64]) -> [Vector3<f64>; 2] {
    let mut sums = [Vector3::zeros(); 2];
    for (place, r) in places.iter().zip(reaction.chunks_exact(6)) {
        let force = Vector3::new(r[0], r[1], r[2]);
        sums[0] += force;
        sums[1] += place.coords.cross(&force) + Vector3::new(r[3], r[4], r[5]);
    }
    sums
}
