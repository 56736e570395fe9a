//! Natural frequencies of square plates.
//!
//! References: ω L² √(ρ/D), clamped 35.98519, 73.39385 (twice), 108.21650, 131.58077, 132.20479,
//! with H = 0 31.64060, 65.60565 (twice), 87.21854 (p-Ritz, computed independently); a free plate has
//! three rigid motions in bending and three in its plane.

use kesf::element::Formulation;
use kesf::mesh::rectangle;
use kesf::model::{DofGroup, Model, Support};
use kesf::section::ShellSection;
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
    }
}

#[test]
fn clamped_square_first_six() {
    let exact = [35.98519, 73.39385, 73.39385, 108.21650, 131.58077, 132.20479];
    let errors = |n: usize, lumped: bool| -> Vec<f64> {
        let found = modes(&plate(n, false, true), 6, lumped, &Options::default()).unwrap();
        found.iter().zip(exact).map(|(m, e)| m.angular_frequency / e - 1.0).collect()
    };
    let (coarse, fine) = (errors(16, false), errors(32, false));
    // The independent implementation gives +0.97 % and +0.24 % for the first, lumped +0.18 % and +0.04 %.
    assert!((coarse[0] - 0.0097).abs() < 1e-4 && (fine[0] - 0.0024).abs() < 1e-4, "{coarse:?} {fine:?}");
    assert!((errors(16, true)[0] - 0.0018).abs() < 1e-4);
    for (c, f) in coarse.iter().zip(&fine) {
        let slope = (c / f).log2();
        assert!((1.9..2.15).contains(&slope), "convergence slope {slope}");
        assert!(*f < 0.02);
    }
}

#[test]
fn clamped_square_without_torsional_rigidity() {
    let found = modes(&plate(32, true, true), 4, false, &Options::default()).unwrap();
    for (m, exact) in found.iter().zip([31.64060, 65.60565, 65.60565, 87.21854]) {
        assert!((m.angular_frequency / exact - 1.0).abs() < 0.012, "{}", m.angular_frequency);
    }
}

#[test]
fn a_free_sheet_has_six_rigid_motions() {
    let found = modes(&plate(8, false, false), 8, false, &Options::default()).unwrap();
    assert_eq!(found.iter().filter(|m| m.angular_frequency == 0.0).count(), 6);
    assert_eq!(found.iter().filter(|m| m.group == DofGroup::Membrane).count(), 3);
    assert!(found[6].angular_frequency > 1.0);
}

#[test]
fn shapes_have_unit_modal_mass() {
    let model = plate(8, false, true);
    let mode = &modes(&model, 1, true, &Options::default()).unwrap()[0];
    // Lumped mass of an interior node is the area of a cell; rotary inertia adds about (t/L)².
    let total: f64 = mode.shape.chunks_exact(6).map(|q| q[2] * q[2] / 64.0).sum();
    assert!((total - 1.0).abs() < 1e-3, "{total}");
}
