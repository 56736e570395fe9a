//! Invariances of the element, on quads at random: warped, up to 1 : 4, orthotropic.
//!
//! Goal: the stiffness does not know how the nodes are numbered, where the sheet is, how it is turned or
//! mirrored, or in which units it is given. Reference: none is needed, both sides are the element's;
//! the laws follow from the strain energy. Tolerances: rounding of 24 x 24 products, relative to the
//! largest entry.

use kesf::element::{Cells, Drilling, Formulation, Matrix24, Prepared, Vector24};
use kesf::section::ShellSection;
use nalgebra::{Matrix2, Matrix3, Point3, Rotation3, Vector3};
use proptest::prelude::*;

const ROUNDING: f64 = 1e-11;

fn section() -> ShellSection {
    ShellSection {
        d_m: Matrix3::new(9.0, 1.5, 0.0, 1.5, 5.0, 0.0, 0.0, 0.0, 0.8) * 1e3,
        d_b: Matrix3::new(2.0, 0.3, 0.0, 0.3, 0.7, 0.0, 0.0, 0.0, 0.4),
        d_s: Matrix2::new(300.0, 0.0, 0.0, 200.0),
        areal_density: 1.0,
        thickness: 0.05,
    }
}

fn formulation(nc: u32, drilling: Drilling) -> Formulation {
    Formulation { cells: Cells::from_count(nc).unwrap(), drilling, ..Formulation::default() }
}

/// The same with one bending cell and the residual flexibility.
fn fourth_order(drilling: Drilling) -> Formulation {
    Formulation { drilling, ..Formulation::fourth_order() }
}

fn stiffness(corners: &[Point3<f64>; 4], warp: &Vector3<f64>, formulation: Formulation) -> Matrix24 {
    Prepared::from_corners(corners, &section(), formulation, warp).unwrap().stiffness()
}

/// A convex quad: a rectangle whose corners are moved by up to a fifth of its sides, and out of its plane.
fn quad() -> impl Strategy<Value = [Point3<f64>; 4]> {
    (1.0..4.0f64, prop::array::uniform12(-0.2..0.2f64)).prop_map(|(side, offsets)| {
        let unit = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        std::array::from_fn(|i| {
            let [x, y] = unit[i];
            Point3::new(side * (x + offsets[3 * i]), y + offsets[3 * i + 1], 0.3 * offsets[3 * i + 2])
        })
    })
}

/// A warp direction in the plane z = 0.
fn warp() -> impl Strategy<Value = Vector3<f64>> {
    (0.0..std::f64::consts::PI).prop_map(|angle| Vector3::new(angle.cos(), angle.sin(), 0.0))
}

fn drilling() -> impl Strategy<Value = Drilling> {
    prop_oneof![Just(Drilling::Scaled), Just(Drilling::HughesBrezzi)]
}

/// `diag(t, t, ...)`: one 3 x 3 matrix on every displacement, another on every rotation.
fn blocks(displacement: Matrix3<f64>, rotation: Matrix3<f64>) -> Matrix24 {
    let mut all = Matrix24::zeros();
    for i in 0..4 {
        all.fixed_view_mut::<3, 3>(6 * i, 6 * i).copy_from(&displacement);
        all.fixed_view_mut::<3, 3>(6 * i + 3, 6 * i + 3).copy_from(&rotation);
    }
    all
}

/// `K[order[i], order[j]]`, by nodes.
fn renumbered(k: &Matrix24, order: [usize; 4]) -> Matrix24 {
    let place = |i: usize| 6 * order[i / 6] + i % 6;
    Matrix24::from_fn(|i, j| k[(place(i), place(j))])
}

fn assert_equal(a: &Matrix24, b: &Matrix24) -> Result<(), TestCaseError> {
    let error = (a - b).abs().max() / b.abs().max();
    prop_assert!(error < ROUNDING, "relative difference {error:e}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// One cell and 2 x 2 cells do not depend on the first node; halves and three cells do.
    #[test]
    fn renumbering(corners in quad(), warp in warp(), drilling in drilling(), first in 1..4usize) {
        for f in [formulation(1, drilling), formulation(4, drilling), fourth_order(drilling)] {
            let order: [usize; 4] = std::array::from_fn(|i| (i + first) % 4);
            let turned = stiffness(&order.map(|i| corners[i]), &warp, f);
            let plain = stiffness(&corners, &warp, f);
            assert_equal(&turned, &renumbered(&plain, order))?;
        }
    }

    #[test]
    fn rotation_and_translation(
        corners in quad(), warp in warp(), drilling in drilling(),
        angles in prop::array::uniform3(-3.0..3.0f64), shift in prop::array::uniform3(-5.0..5.0f64),
    ) {
        let turn = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let there = corners.map(|c| turn * c + Vector3::from(shift));
        let cells = [1, 2, 3, 4, 9].map(|nc| formulation(nc, drilling));
        for f in cells.into_iter().chain([fourth_order(drilling)]) {
            let plain = stiffness(&corners, &warp, f);
            let turned = stiffness(&there, &(turn * warp), f);
            let t = blocks(*turn.matrix(), *turn.matrix());
            assert_equal(&turned, &(t * plain * t.transpose()))?;
        }
    }

    /// In the mirror x -> -x displacements are mirrored and rotations, being axial, the other way.
    #[test]
    fn mirror(corners in quad(), warp in warp(), drilling in drilling()) {
        let mirror = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0));
        // Counter-clockwise again: from the first node backwards.
        let order = [0, 3, 2, 1];
        let seen = order.map(|i| Point3::from(mirror * corners[i].coords));
        let cells = [1, 4, 9].map(|nc| formulation(nc, drilling));
        for f in cells.into_iter().chain([fourth_order(drilling)]) {
            let plain = stiffness(&corners, &warp, f);
            let mirrored = stiffness(&seen, &(mirror * warp), f);
            let t = blocks(mirror, -mirror);
            assert_equal(&mirrored, &renumbered(&(t * plain * t), order))?;
        }
    }

    #[test]
    fn symmetric_and_without_negative_energy(corners in quad(), warp in warp(), values in prop::array::uniform24(-1.0..1.0f64)) {
        let cells = [1, 2, 3, 4].map(|nc| formulation(nc, Drilling::Scaled));
        for f in cells.into_iter().chain([fourth_order(Drilling::Scaled)]) {
            let k = stiffness(&corners, &warp, f);
            assert_equal(&k, &k.transpose())?;
            let q = Vector24::from(values);
            prop_assert!(q.dot(&(k * q)) > -ROUNDING * k.abs().max() * q.norm_squared());
        }
    }

    /// Lengths times s, bending stiffness times s²: displacements keep, rotations get the factor s; and
    /// the stiffness is linear in the section.
    #[test]
    fn scaling(corners in quad(), warp in warp(), s in 1e-3..1e3f64, c in 1e-6..1e6f64) {
        let (small, base) = (corners.map(|p| p * s), section());
        let scaled = ShellSection {
            d_m: base.d_m * c, d_b: base.d_b * (c * s * s), d_s: base.d_s * c, ..base.clone()
        };
        for f in [formulation(4, Drilling::Scaled), fourth_order(Drilling::Scaled)] {
            let k = Prepared::from_corners(&small, &scaled, f, &warp).unwrap().stiffness();
            let t = blocks(Matrix3::identity(), Matrix3::identity() / s);
            assert_equal(&(t * k * t / c), &stiffness(&corners, &warp, f))?;
        }
    }
}
