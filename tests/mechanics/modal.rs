//! Natural frequencies of square plates.
//!
//! References: ω L² √(ρ/D), clamped 35.98519, 73.39385 (twice), 108.21650, 131.58077, 132.20479,
//! with H = 0 31.64060, 65.60565 (twice), 87.21854 (p-Ritz, computed independently); a free plate has
//! three rigid motions in bending and three in its plane.

use kesf::element::{Formulation, Mass};
use kesf::mesh::rectangle;
use kesf::model::{DofGroup, Model, Support};
use kesf::section::ShellSection;
use kesf::solve::assemble::{ElementMatrices, MatrixKind, multiply};
use kesf::solve::{Options, modes};
use nalgebra::{Matrix2, Matrix3, Vector3};

fn plate(n: usize, twistless: bool, clamped: bool) -> Model {
    let (nu, t) = (if twistless { 0.0 } else { 0.3 }, 1e-3);
    let twist = if twistless { 0.0 } else { 0.5 * (1.0 - nu) };
    let plane = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu));
    let mut d_b = plane;
    d_b[(2, 2)] = twist;
    let mesh = rectangle(1.0, 1.0, n, n).unwrap();
    let supports = if clamped { vec![Support::clamped(mesh.set("boundary").unwrap())] } else { Vec::new() };
    Model {
        mesh,
        section: ShellSection {
            d_m: plane * (12.0 / (t * t)),
            d_b,
            d_s: Matrix2::identity() * (3.5 / (t * t)),
            areal_density: 1.0,
            thickness: t,
        },
        warp: Vector3::x(),
        formulation: Formulation { shear_stabilisation: 0.0, ..Formulation::default() },
        supports,
        loads: Vec::new(),
        bodies: Vec::new(),
    }
}

#[test]
fn clamped_square_first_six() {
    let exact = [35.98519, 73.39385, 73.39385, 108.21650, 131.58077, 132.20479];
    let errors = |n: usize, mass: Mass| -> Vec<f64> {
        let found = modes(&plate(n, false, true), 6, mass, &Options::default()).unwrap();
        found.iter().zip(exact).map(|(m, e)| m.angular_frequency / e - 1.0).collect()
    };
    let (coarse, fine) = (errors(16, Mass::Consistent), errors(32, Mass::Consistent));
    // The independent implementation gives +0.97 % and +0.24 % for the first, lumped +0.18 % and +0.04 %.
    assert!((coarse[0] - 0.0097).abs() < 1e-4 && (fine[0] - 0.0024).abs() < 1e-4, "{coarse:?} {fine:?}");
    assert!((errors(16, Mass::Lumped)[0] - 0.0018).abs() < 1e-4);
    for (c, f) in coarse.iter().zip(&fine) {
        let slope = (c / f).log2();
        assert!((1.9..2.15).contains(&slope), "convergence slope {slope}");
        assert!(*f < 0.02);
    }
}

#[test]
fn clamped_square_without_torsional_rigidity() {
    let found = modes(&plate(32, true, true), 4, Mass::Consistent, &Options::default()).unwrap();
    for (m, exact) in found.iter().zip([31.64060, 65.60565, 65.60565, 87.21854]) {
        assert!((m.angular_frequency / exact - 1.0).abs() < 0.012, "{}", m.angular_frequency);
    }
}

#[test]
fn a_free_sheet_has_six_rigid_motions() {
    let found = modes(&plate(8, false, false), 8, Mass::Consistent, &Options::default()).unwrap();
    assert_eq!(found.iter().filter(|m| m.angular_frequency == 0.0).count(), 6);
    assert_eq!(found.iter().filter(|m| m.group == DofGroup::Membrane).count(), 3);
    assert!(found[6].angular_frequency > 1.0);
}

#[test]
fn shapes_have_unit_modal_mass() {
    let model = plate(8, false, true);
    let mode = &modes(&model, 1, Mass::Lumped, &Options::default()).unwrap()[0];
    // Lumped mass of an interior node is the area of a cell; rotary inertia adds about (t/L)².
    let total: f64 = mode.shape.chunks_exact(6).map(|q| q[2] * q[2] / 64.0).sum();
    assert!((total - 1.0).abs() < 1e-3, "{total}");
}

/// Every mode of a small plate at once: as many as free dofs with mass, the lowest as by iteration, and
/// orthonormal in the mass.
#[test]
fn every_mode_can_be_asked_for() {
    let model = plate(4, false, true);
    let all = modes(&model, 1000, Mass::Consistent, &Options::default()).unwrap();
    // 9 free nodes: w, θx, θy in bending; u, v in the plane, where θz has no mass.
    assert_eq!(all.len(), 9 * 5);
    let plates: Vec<_> = all.iter().filter(|m| m.group == DofGroup::Plate).collect();
    assert_eq!(plates.len(), 27);
    let image = |q: &[f64]| {
        let elements = ElementMatrices::new(&model, DofGroup::Plate, MatrixKind::Mass(Mass::Consistent));
        multiply(elements, &DofGroup::Plate.gather(q)).unwrap()
    };
    for (i, a) in plates.iter().enumerate() {
        let m = image(&a.shape);
        for (j, b) in plates.iter().enumerate() {
            let product: f64 = DofGroup::Plate.gather(&b.shape).iter().zip(&m).map(|(x, y)| x * y).sum();
            let expected = f64::from(u8::from(i == j));
            assert!((product - expected).abs() < 1e-7, "modes {i} and {j}: {product}");
        }
    }
    // The iteration and the dense solution meet where both are used: 3 of 147 and 60 of 147 dofs.
    let model = plate(8, false, true);
    let few = modes(&model, 3, Mass::Lumped, &Options::default()).unwrap();
    let many = modes(&model, 60, Mass::Lumped, &Options::default()).unwrap();
    assert_eq!(many.len(), 60);
    for (a, b) in few.iter().zip(&many) {
        assert!((a.angular_frequency / b.angular_frequency - 1.0).abs() < 1e-9);
    }
}

/// Longitudinal waves of a bar held at both ends (ν = 0): the k-th frequency is k π √(E/ρ)/L. Straight
/// elements of length h miss k²h²/24 of it, more with consistent mass, less with row sums, and the mean
/// misses only terms of fourth order: k⁴h⁴/480.
#[test]
fn the_mean_mass_is_of_fourth_order_in_the_plane() {
    let mut model = plate(16, true, false);
    model.mesh = rectangle(1.0, 1.0 / 16.0, 16, 1).unwrap();
    let sets = |name: &str| model.mesh.set(name).unwrap().to_vec();
    let (ends, all) = ([sets("left"), sets("right")].concat(), sets("all"));
    use kesf::model::Dof;
    model.supports = vec![
        Support::clamped(&ends),
        Support::fix(&all, &[Dof::V, Dof::W, Dof::ThetaX, Dof::ThetaY, Dof::ThetaZ]),
    ];
    let kh = std::f64::consts::PI / 16.0;
    let exact = std::f64::consts::PI * model.section.d_m[(0, 0)].sqrt();
    let error =
        |mass| modes(&model, 1, mass, &Options::default()).unwrap()[0].angular_frequency / exact - 1.0;
    assert!((error(Mass::Consistent) / (kh * kh / 24.0) - 1.0).abs() < 0.02);
    assert!((error(Mass::Lumped) / (-kh * kh / 24.0) - 1.0).abs() < 0.02);
    assert!((error(Mass::Averaged) / (kh.powi(4) / 480.0)).abs() < 1.1, "{}", error(Mass::Averaged));
}

#[test]
fn a_sheet_without_mass_is_refused_by_name() {
    let mut model = plate(4, false, true);
    model.section.areal_density = 0.0;
    let refused = modes(&model, 1, Mass::default(), &Options::default()).unwrap_err();
    assert_eq!(refused.code(), "N008");
    assert!(refused.to_string().contains("areal_density"));
}
