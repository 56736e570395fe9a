//! Square plates against high-precision references.
//!
//! Goal: the element's deflections, mesh by mesh. Data: side L, t/L = 1e-3, uniform pressure,
//! values 100 w D / (q L⁴) at the centre. Reference: an independent implementation of the same
//! element (5 or 6 digits), and the exact thin-plate values .126532 (clamped), .406235 (simply
//! supported); theory of the element, corrected equations.

use kesf::element::{Cells, Drilling, Formulation};
use kesf::mesh::rectangle;
use kesf::model::{Load, Model, Support};
use kesf::section::ShellSection;
use kesf::solve::{self, Options};
use nalgebra::{Matrix2, Matrix3, Vector3};

fn isotropic(t: f64) -> ShellSection {
    let nu = 0.3;
    // D = 1; E t = 12 (1 - nu²) / t²; kappa = 5/6.
    let d_b = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu));
    let e_t = 12.0 * (1.0 - nu * nu) / (t * t);
    ShellSection {
        d_m: d_b * (12.0 / (t * t)),
        d_b,
        d_s: Matrix2::identity() * (5.0 / 6.0 * e_t / (2.0 * (1.0 + nu))),
        areal_density: 1.0,
        thickness: t,
    }
}

fn centre_deflection(n: usize, nc: u32, clamped: bool, section: ShellSection, alpha: f64) -> f64 {
    let mesh = rectangle(1.0, 1.0, n, n).unwrap();
    let supports = if clamped {
        vec![Support::clamped(mesh.set("boundary").unwrap())]
    } else {
        vec![Support::simple(&mesh, "boundary", true).unwrap()]
    };
    let centre = (n / 2) * (n + 1) + n / 2;
    let model = Model {
        mesh,
        section,
        warp: Vector3::x(),
        formulation: Formulation {
            cells: Cells::from_count(nc).unwrap(),
            shear_stabilisation: alpha,
            drilling: Drilling::Scaled,
            ..Formulation::default()
        },
        supports,
        loads: vec![Load::Pressure(1.0)],
        bodies: Vec::new(),
    };
    solve::solve(&model, &Options::default()).unwrap().displacement[6 * centre + 2]
}

#[test]
fn clamped_and_simply_supported_square_plates() {
    let clamped = [
        (1, [0.130210, 0.127177, 0.126686, 0.126572]),
        (2, [0.126649, 0.126382, 0.126491, 0.126523]),
        (3, [0.124940, 0.125986, 0.126394, 0.126499]),
        (4, [0.123276, 0.125593, 0.126296, 0.126475]),
        (16, [0.121657, 0.125201, 0.126199, 0.126450]),
    ];
    for (nc, values) in clamped {
        for (n, expected) in [4, 8, 16, 32].into_iter().zip(values) {
            let w = 100.0 * centre_deflection(n, nc, true, isotropic(1e-3), 0.0);
            assert!((w - expected).abs() < 2e-6, "CCCC nc = {nc}, n = {n}: {w:.6}, expected {expected:.6}");
        }
    }
    let supported = [
        (1, [0.412329, 0.407716, 0.406599, 0.406327]),
        (2, [0.406367, 0.406368, 0.406270, 0.406246]),
        (4, [0.400627, 0.405031, 0.405942, 0.406164]),
    ];
    for (nc, values) in supported {
        for (n, expected) in [4, 8, 16, 32].into_iter().zip(values) {
            let w = 100.0 * centre_deflection(n, nc, false, isotropic(1e-3), 0.0);
            assert!((w - expected).abs() < 2e-6, "SSSS nc = {nc}, n = {n}: {w:.6}, expected {expected:.6}");
        }
    }
}
