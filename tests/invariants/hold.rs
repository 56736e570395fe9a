//! What has to hold of an answer.

use kesf::fields::reaction_resultants;
use kesf::model::Model;
use kesf::solve::Solution;
use nalgebra::{Point3, Vector3};

/// Forces and moments of loads and supports add up to nothing, relative to what their sizes add up to.
pub fn balance(places: &[Point3<f64>], load: &[f64], reaction: &[f64], tolerance: f64) {
    let [f, m] = reaction_resultants(places, load);
    let [r, n] = reaction_resultants(places, reaction);
    let (mut forces, mut moments) = (0.0, 0.0);
    for (place, both) in places.iter().zip(load.chunks_exact(6).zip(reaction.chunks_exact(6))) {
        for v in [both.0, both.1] {
            let force = Vector3::from_column_slice(&v[..3]).norm();
            forces += force;
            moments += force * place.coords.norm() + Vector3::from_column_slice(&v[3..]).norm();
        }
    }
    assert!(forces > 0.0 || moments > 0.0, "there are no loads");
    let (force, moment) = ((f + r).norm(), (m + n).norm());
    assert!(force <= tolerance * forces, "forces are off by {force:e} of {forces:e} N");
    assert!(moment <= tolerance * moments, "moments are off by {moment:e} of {moments:e} N·m");
}

/// The strain energy is positive, and half the work of loads and supports along the displacements (Clapeyron).
pub fn energy_of_work(model: &Model, found: &Solution, tolerance: f64) {
    let load = model.load_vector();
    let forces = load.iter().zip(&found.reaction).map(|(f, r)| f + r);
    let work: f64 = 0.5 * forces.zip(&found.displacement).map(|(f, u)| f * u).sum::<f64>();
    assert!(found.strain_energy > 0.0, "{:e} J", found.strain_energy);
    let off = (found.strain_energy / work - 1.0).abs();
    assert!(off < tolerance, "energy {:e} J, work {work:e} J", found.strain_energy);
}

/// The largest difference of nodal vectors, relative to the largest of them; displacements and rotations, or forces
/// and moments, apart. What is nothing but rounding beside the other kind counts as that: `lever` makes the second
/// kind one of the first, a length for rotations and its inverse for moments.
pub fn off(a: &[f64], b: &[f64], lever: f64) -> f64 {
    let difference_and_size = |at: usize| {
        let (mut most, mut largest) = (0.0f64, 0.0f64);
        for (a, b) in a.chunks_exact(6).zip(b.chunks_exact(6)) {
            let [a, b] = [a, b].map(|v| Vector3::from_column_slice(&v[at..at + 3]));
            (most, largest) = (most.max((a - b).norm()), largest.max(b.norm()));
        }
        (most, largest)
    };
    let ((first, first_largest), (second, second_largest)) = (difference_and_size(0), difference_and_size(3));
    let relative = |most: f64, largest: f64| if most == 0.0 { 0.0 } else { most / largest };
    relative(first, first_largest.max(lever * second_largest))
        .max(relative(second, second_largest.max(first_largest / lever)))
}

/// Not one digit differs.
pub fn same_bytes(a: &[f64], b: &[f64]) {
    let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert!(bits(a) == bits(b), "the number of threads changes the answer");
}
