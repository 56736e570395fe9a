//! Bending waves on an endless mesh of equal elements: their frequency from the matrices of one of them, against
//! that of a thin plate, `ρ ω² = D11 kx⁴ + 2 (D12 + 2 D66) kx² ky² + D22 ky⁴`.

use nalgebra::{Complex, Matrix2, Matrix3, Point3, SMatrix, Vector3};

use super::{Cells, Formulation, Frame, Mass, Prepared};
use crate::section::ShellSection;

/// Transverse shear stiffness (N/m): thin, yet with digits left.
const SHEAR: f64 = 1e6;

fn section([d11, d22, d12, d66]: [f64; 4]) -> ShellSection {
    let d_b = Matrix3::new(d11, d12, 0.0, d12, d22, 0.0, 0.0, 0.0, d66);
    ShellSection { d_m: d_b, d_b, d_s: Matrix2::identity() * SHEAR, areal_density: 1.0, thickness: 1e-6 }
}

/// Relative error of ω² for the wave vector `(kx, ky)` on elements of the given sides, warp along x or along y.
fn error(
    d: [f64; 4],
    sides: [f64; 2],
    k: [f64; 2],
    formulation: Formulation,
    mass: Mass,
    along_y: bool,
) -> f64 {
    let [a, b] = sides;
    let corners = [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]].map(|[x, y]| Point3::new(x, y, 0.0));
    let frame = Frame::global(&corners);
    let (section, warp) = (section(d), if along_y { Vector3::y() } else { Vector3::x() });
    let element = Prepared::new(frame, &section, formulation, &warp).unwrap();
    // The four nodes move as one, but for the phase of the wave.
    let phase = corners.map(|c| Complex::from_polar(1.0, k[0] * c.x + k[1] * c.y));
    let wave = SMatrix::<Complex<f64>, 12, 3>::from_fn(|row, column| {
        if row % 3 == column { phase[row / 3] } else { Complex::default() }
    });
    let stiffness = wave.adjoint() * element.plate_stiffness().map(Complex::from) * wave;
    let pairs = mass.pairs(&frame, &section);
    let mass: f64 = (0..4)
        .flat_map(|i| (0..4).map(move |j| (i, j)))
        .map(|(i, j)| pairs[(i, j)] * (phase[i].conj() * phase[j]).re)
        .sum();
    let turning = stiffness.fixed_view::<2, 2>(1, 1).try_inverse().unwrap();
    let bent = stiffness.fixed_view::<1, 2>(0, 1) * turning * stiffness.fixed_view::<2, 1>(1, 0);
    let squared = (stiffness[(0, 0)] - bent[(0, 0)]).re / mass;
    let [warp, weft] = if along_y { [k[1], k[0]] } else { k };
    // Q = M_x,x + M_xy,y and so on; what shears the sheet is missing in its bending.
    let twist = d[2] + 2.0 * d[3];
    let shear = [
        warp * (d[0] * warp * warp + twist * weft * weft),
        weft * (twist * warp * warp + d[1] * weft * weft),
    ];
    let energy = warp * shear[0] + weft * shear[1];
    squared / (energy - (shear[0] * shear[0] + shear[1] * shear[1]) / SHEAR) - 1.0
}

const ANGLES: [f64; 5] = [0.0, 0.3, 0.785, 1.2, 1.55];

/// Square elements of side 1 and nc cells, isotropic: `k² (1/12 - p (2/3 - c (3 - ν)/2))`, `p = kx² ky² / k⁴`, and c = 0 for
/// one cell, 1/16 for four, 2/27 for nine, 5/64 for sixteen: the variance of the middles of the cells.
#[test]
fn cells_disperse_waves_as_derived() {
    let (nu, k) = (0.3, 0.1);
    let d = [1.0, 1.0, nu, 0.5 * (1.0 - nu)];
    for (nc, c) in [(1, 0.0), (4, 1.0 / 16.0), (9, 2.0 / 27.0), (16, 5.0 / 64.0)] {
        let formulation = Formulation {
            cells: Cells::from_count(nc).unwrap(),
            shear_stabilisation: 0.0,
            ..Formulation::default()
        };
        for angle in ANGLES {
            let (sin, cos) = f64::sin_cos(angle);
            let p = (sin * cos).powi(2);
            let derived = 1.0 / 12.0 - p * (2.0 / 3.0 - 0.5 * c * (3.0 - nu));
            let found = error(d, [1.0; 2], [k * cos, k * sin], formulation, Mass::Lumped, false) / (k * k);
            assert!((found - derived).abs() < 1e-3, "nc = {nc}, {angle}: {found} for {derived}");
        }
    }
}

/// One bending cell: with the residual flexibility and row sums the error is of fourth order in every direction, on
/// rectangles whose sides run along warp and weft, for any ratio of the rigidities.
#[test]
fn one_bending_cell_is_of_fourth_order_along_the_yarns() {
    let sections = [
        [1.0, 1.0, 0.3, 0.35],
        [1.0, 0.2, 0.0, 0.0],
        [1.0, 0.3, 0.05, 0.1],
        [0.1, 1.0, 0.05, 0.4],
        [1.0, 1.0, -0.4, 0.7],
    ];
    for d in sections {
        for (sides, along_y) in
            [([1.0, 1.0], false), ([1.0, 1.0], true), ([1.0, 0.4], false), ([0.5, 1.0], true)]
        {
            for angle in ANGLES {
                let (sin, cos) = f64::sin_cos(angle);
                let error = |k: f64| {
                    let wave = [k * cos, k * sin];
                    error(d, sides, wave, Formulation::fourth_order(), Mass::Lumped, along_y)
                };
                let (coarse, fine) = (error(0.4), error(0.2));
                let bound = 0.1 * 0.2f64.powi(4);
                assert!(fine.abs() < bound && (coarse - 16.0 * fine).abs() < 0.1 * (coarse.abs() + bound));
            }
        }
    }
}
