//! Goal: the corotational element has one energy, and force and tangent are its derivatives.
//!
//! Data: a warped, irregular quad of an orthotropic section, displaced at random (seeded), its nodes
//! turned by rotations of any size.
//! Reference: central differences with step h; their error is about ε/h + h² (ε = 1e-16), so 1e-10
//! relative for h = 1e-5. Statements of invariance hold to rounding.

use kesf::element::corotational::{Motion, ReferenceFrame};
use kesf::element::{Drilling, Formulation, Matrix24, Prepared, Vector24};
use kesf::section::ShellSection;
use nalgebra::{Matrix2, Matrix3, Point3, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

type Nodes = ([Point3<f64>; 4], [UnitQuaternion<f64>; 4]);

fn element(formulation: Formulation) -> Prepared {
    let section = ShellSection {
        d_m: Matrix3::new(3.0, 0.4, 0.0, 0.4, 2.0, 0.0, 0.0, 0.0, 0.5),
        d_b: Matrix3::new(0.03, 0.004, 0.0, 0.004, 0.01, 0.0, 0.0, 0.0, 0.008),
        d_s: Matrix2::identity() * 0.7,
        areal_density: 1.0,
        thickness: 0.3,
    };
    let corners = [[0.1, -0.2, 0.05], [1.3, 0.1, -0.02], [1.1, 0.9, 0.08], [-0.2, 1.2, -0.06]];
    let corners = corners.map(|[x, y, z]| Point3::new(x, y, z));
    Prepared::from_corners(&corners, &section, formulation, &Vector3::new(0.8, 0.6, 0.0)).unwrap()
}

fn rest(element: &Prepared) -> Nodes {
    let f = &element.frame;
    let corner = |i: usize| f.rotation.transpose() * Vector3::new(f.xy[i][0], f.xy[i][1], f.z[i]);
    ([0, 1, 2, 3].map(|i| Point3::from(corner(i))), [UnitQuaternion::identity(); 4])
}

fn random(rng: &mut Pcg64, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.random_range(-size..size))
}

/// Corners and rotations moved by displacements and spatial spins.
fn displaced((x, r): &Nodes, step: &Vector24) -> Nodes {
    let part = |i: usize| -> Vector3<f64> { step.fixed_rows::<3>(3 * i).into() };
    (
        [0, 1, 2, 3].map(|i| x[i] + part(2 * i)),
        [0, 1, 2, 3].map(|i| UnitQuaternion::from_scaled_axis(part(2 * i + 1)) * r[i]),
    )
}

fn turned((x, r): &Nodes, q: &UnitQuaternion<f64>, shift: &Vector3<f64>) -> Nodes {
    (x.map(|x| q * x + shift), r.map(|r| q * r))
}

/// A deformed, turned state: strains and rotations against the frame of order `amplitude`.
fn state(element: &Prepared, amplitude: f64, rng: &mut Pcg64) -> Nodes {
    let step = Vector24::from_fn(|_, _| rng.random_range(-amplitude..amplitude));
    let q = UnitQuaternion::from_scaled_axis(random(rng, 3.0));
    turned(&displaced(&rest(element), &step), &q, &random(rng, 5.0))
}

fn energy(reference: &ReferenceFrame, k: &Matrix24, (x, r): &Nodes) -> f64 {
    let d = Motion::of(reference, x, r).deformation;
    0.5 * d.dot(&(k * d))
}

fn force(reference: &ReferenceFrame, k: &Matrix24, (x, r): &Nodes) -> Vector24 {
    let motion = Motion::of(reference, x, r);
    motion.force(&(k * motion.deformation))
}

fn both() -> [Prepared; 2] {
    [
        element(Formulation::default()),
        element(Formulation { drilling: Drilling::HughesBrezzi, ..Formulation::seed() }),
    ]
}

#[test]
fn rigid_motions_of_any_size_cost_nothing() {
    let mut rng = Pcg64::seed_from_u64(1);
    for element in both() {
        let (reference, k) = (ReferenceFrame::of(&element.frame), element.local_stiffness());
        for size in [1e-6, 0.1, 1.0, 1.8] {
            let q = UnitQuaternion::from_scaled_axis(random(&mut rng, size));
            let nodes = turned(&rest(&element), &q, &random(&mut rng, 10.0));
            // Rounding: a coordinate of 10 has 1e-15.
            assert!(force(&reference, &k, &nodes).norm() < 1e-13 * k.norm());
            assert!(energy(&reference, &k, &nodes) < 1e-26 * k.norm());
        }
    }
}

#[test]
fn at_rest_the_tangent_is_the_linear_stiffness() {
    for element in both() {
        let (x, r) = rest(&element);
        let motion = Motion::of(&ReferenceFrame::of(&element.frame), &x, &r);
        let tangent = motion.tangent(&element.local_stiffness(), &Vector24::zeros());
        assert!((tangent - element.stiffness()).norm() < 1e-14 * tangent.norm());
    }
}

#[test]
fn the_force_is_the_gradient_of_the_energy() {
    let mut rng = Pcg64::seed_from_u64(2);
    for element in both() {
        let (reference, k) = (ReferenceFrame::of(&element.frame), element.local_stiffness());
        for amplitude in [0.01, 0.1, 0.3] {
            let nodes = state(&element, amplitude, &mut rng);
            let f = force(&reference, &k, &nodes);
            for i in 0..24 {
                let step = Vector24::ith(i, 1e-5);
                let up = energy(&reference, &k, &displaced(&nodes, &step));
                let down = energy(&reference, &k, &displaced(&nodes, &-step));
                let difference = (up - down) / 2e-5;
                assert!((difference - f[i]).abs() < 1e-9 * f.norm(), "{amplitude}: {i}");
            }
        }
    }
}

fn difference_of_force(reference: &ReferenceFrame, k: &Matrix24, nodes: &Nodes) -> Matrix24 {
    let mut tangent = Matrix24::zeros();
    for i in 0..24 {
        let step = Vector24::ith(i, 1e-5);
        let change =
            force(reference, k, &displaced(nodes, &step)) - force(reference, k, &displaced(nodes, &-step));
        tangent.set_column(i, &(change / 2e-5));
    }
    tangent
}

#[test]
fn the_exact_tangent_is_the_derivative_of_the_force() {
    let mut rng = Pcg64::seed_from_u64(3);
    for element in both() {
        let (reference, k) = (ReferenceFrame::of(&element.frame), element.local_stiffness());
        for amplitude in [0.01, 0.1, 0.3] {
            let nodes = state(&element, amplitude, &mut rng);
            let motion = Motion::of(&reference, &nodes.0, &nodes.1);
            let local = k * motion.deformation;
            let difference = difference_of_force(&reference, &k, &nodes);
            let exact = motion.exact_tangent(&k, &local);
            assert!((exact - difference).norm() < 1e-9 * exact.norm(), "{amplitude}");
            // The symmetric one leaves out terms of first order in the local force, and nothing else.
            let near = motion.tangent(&k, &local);
            assert!((near - near.transpose()).norm() < 1e-14 * near.norm());
            assert!((near - difference).norm() < 0.5 * amplitude * exact.norm(), "{amplitude}");
        }
    }
}

#[test]
fn the_rate_of_deformation_is_its_derivative() {
    let mut rng = Pcg64::seed_from_u64(4);
    let element = element(Formulation::default());
    let (reference, k) = (ReferenceFrame::of(&element.frame), element.local_stiffness());
    let nodes = state(&element, 0.3, &mut rng);
    let step = Vector24::from_fn(|_, _| rng.random_range(-1e-5..1e-5));
    let at = |(x, r): Nodes| Motion::of(&reference, &x, &r).deformation;
    let difference = 0.5 * (at(displaced(&nodes, &step)) - at(displaced(&nodes, &-step)));
    let rate = Motion::of(&reference, &nodes.0, &nodes.1).deformation_rate(&step);
    // Through the stiffness, which is blind to the translation that the rate keeps.
    assert!((k * (rate - difference)).norm() < 1e-9 * (k * rate).norm());
}

#[test]
fn forces_turn_with_the_element() {
    let mut rng = Pcg64::seed_from_u64(5);
    let element = element(Formulation::default());
    let (reference, k) = (ReferenceFrame::of(&element.frame), element.local_stiffness());
    let nodes = state(&element, 0.2, &mut rng);
    let q = UnitQuaternion::from_scaled_axis(random(&mut rng, 2.0));
    let (before, after) =
        (force(&reference, &k, &nodes), force(&reference, &k, &turned(&nodes, &q, &random(&mut rng, 3.0))));
    for b in 0..8 {
        let expected = q * Vector3::from(before.fixed_rows::<3>(3 * b));
        assert!((expected - after.fixed_rows::<3>(3 * b)).norm() < 1e-13 * before.norm());
    }
    // And they balance: no resultant force or moment.
    let (mut resultant, mut moment) = (Vector3::zeros(), Vector3::zeros());
    for i in 0..4 {
        let (n, m): (Vector3<f64>, Vector3<f64>) =
            (before.fixed_rows::<3>(6 * i).into(), before.fixed_rows::<3>(6 * i + 3).into());
        resultant += n;
        moment += m + nodes.0[i].coords.cross(&n);
    }
    assert!(resultant.norm() < 1e-13 * before.norm() && moment.norm() < 1e-12 * before.norm());
}
