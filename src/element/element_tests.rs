//! Rank and rigid-mode counts of one element (theory: table of zero-energy modes), reference: the
//! design document's independent implementation.

use super::*;
use crate::element::{Cells, Gradient, Membrane};
use nalgebra::{DMatrix, Rotation3};

fn isotropic(twist: f64) -> ShellSection {
    // E = 1, nu = 0.3, t = 0.1.
    let (e, nu, t) = (1.0, 0.3, 0.1f64);
    let plane = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu)) * (e / (1.0 - nu * nu));
    let mut d_b = plane * (t.powi(3) / 12.0);
    d_b[(2, 2)] *= twist;
    if twist == 0.0 {
        d_b[(0, 1)] = 0.0;
        d_b[(1, 0)] = 0.0;
    }
    ShellSection {
        d_m: plane * t,
        d_b,
        d_s: Matrix2::identity() * (5.0 / 6.0 * e * t / 2.6),
        areal_density: 1.0,
        thickness: t,
    }
}

fn shapes() -> [[Point3<f64>; 4]; 3] {
    [
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]],
        [[0.1, -0.2], [1.3, 0.1], [1.1, 0.9], [-0.2, 1.2]],
    ]
    .map(|q| q.map(|[x, y]| Point3::new(x, y, 0.0)))
}

fn zero_modes<const N: usize>(k: SMatrix<f64, N, N>) -> usize {
    let values = DMatrix::from_column_slice(N, N, k.as_slice()).symmetric_eigenvalues();
    values.iter().filter(|v| v.abs() < 1e-10 * values.max()).count()
}

#[test]
fn zero_energy_modes_match_the_table() {
    // (nc, plate, shell with penalty, plate with H = B12 = 0)
    for (nc, plate, shell, twistless) in
        [(1, 5, 10, 6), (3, 3, 6, 4), (4, 3, 6, 4), (9, 3, 6, 4), (16, 3, 6, 4)]
    {
        let formulation = Formulation {
            cells: Cells::from_count(nc).unwrap(),
            shear_stabilisation: 0.0,
            drilling: Drilling::HughesBrezzi,
            ..Formulation::default()
        };
        for corners in shapes() {
            let x = Vector3::x();
            let e = Prepared::from_corners(&corners, &isotropic(1.0), formulation, &x).unwrap();
            assert_eq!(zero_modes(e.plate_stiffness()), plate, "plate, nc = {nc}");
            assert_eq!(zero_modes(e.stiffness()), shell, "shell, nc = {nc}");
            let e = Prepared::from_corners(&corners, &isotropic(0.0), formulation, &x).unwrap();
            assert_eq!(zero_modes(e.plate_stiffness()), twistless, "H = 0, nc = {nc}");
        }
    }
}

/// Six rigid motions of a warped, arbitrarily turned element cost nothing.
#[test]
fn rigid_motions_are_free_even_when_warped() {
    let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    let corners = [[0.1, -0.2, 0.05], [1.3, 0.1, -0.02], [1.1, 0.9, 0.08], [-0.2, 1.2, -0.06]]
        .map(|[x, y, z]| turn * Point3::new(x, y, z));
    let warp = turn * Vector3::new(0.8, 0.6, 0.0);
    let k =
        Prepared::from_corners(&corners, &isotropic(1.0), Formulation::default(), &warp).unwrap().stiffness();
    for axis in 0..3 {
        let e = Vector3::ith(axis, 1.0);
        let (mut translation, mut rotation) = (Vector24::zeros(), Vector24::zeros());
        for (i, c) in corners.iter().enumerate() {
            translation.fixed_rows_mut::<3>(6 * i).copy_from(&e);
            rotation.fixed_rows_mut::<3>(6 * i).copy_from(&e.cross(&c.coords));
            rotation.fixed_rows_mut::<3>(6 * i + 3).copy_from(&e);
        }
        assert!((k * translation).norm() < 1e-13 * k.norm());
        assert!((k * rotation).norm() < 1e-13 * k.norm());
    }
}

#[test]
fn a_warp_axis_normal_to_the_element_is_refused() {
    let corners = shapes()[0];
    let e = Prepared::from_corners(&corners, &isotropic(1.0), Formulation::default(), &Vector3::z());
    assert_eq!(e.err(), Some(MaterialAxisError));
}

/// One membrane cell leaves no motion without energy, strains a uniform state as four cells do, and
/// nearly nothing else of a thin sheet.
#[test]
fn one_membrane_cell_is_stabilised_and_exact_for_uniform_strain() {
    let prepared = |corners: &[Point3<f64>; 4], membrane, thin: f64| {
        let mut section = isotropic(1.0);
        section.d_b *= thin;
        let formulation = Formulation { membrane, ..Formulation::default() };
        Prepared::from_corners(corners, &section, formulation, &Vector3::x()).unwrap()
    };
    for corners in shapes() {
        let [one, four] = [Membrane::OneCell, Membrane::Cells].map(|m| prepared(&corners, m, 1.0));
        let assumed = prepared(&corners, Membrane::AssumedStress, 1.0);
        assert_eq!(zero_modes(one.stiffness()), 6);
        assert_eq!(zero_modes(assumed.stiffness()), 6);
        // u = 2x + y, v = 3y - x with the rotation that goes with it.
        let field = SVector::<f64, 12>::from_fn(|k, _| {
            let [x, y] = one.frame.xy[k / 3];
            [2.0 * x + y, 3.0 * y - x, -1.0][k % 3]
        });
        let [a, b, c] = [&one, &four, &assumed].map(|e| e.membrane_stiffness() * field);
        assert!((a - b).norm() < 1e-12 * b.norm());
        assert!((c - b).norm() < 1e-12 * b.norm());
        // The in-plane bending of the element, u = ξη.
        let bent = SVector::<f64, 12>::from_fn(|k, _| if k % 3 == 0 { [1.0, -1.0][k / 3 % 2] } else { 0.0 });
        let [one, four] = [Membrane::OneCell, Membrane::Cells].map(|m| {
            let k = prepared(&corners, m, 1e-6).membrane_stiffness();
            bent.dot(&(k * bent))
        });
        assert!(one < 1e-4 * four, "{one:e} of {four:e}");
    }
}

/// One bending cell bends a uniform state as four cells do, and cells that follow a law of their own add up to the
/// same matrix when the law is that of the section.
#[test]
fn one_bending_cell_is_exact_for_uniform_curvature_and_cell_by_cell() {
    for corners in shapes() {
        let prepared = |formulation| {
            let warp = Vector3::new(0.8, 0.6, 0.0);
            Prepared::from_corners(&corners, &isotropic(0.5), formulation, &warp).unwrap()
        };
        let (one, four) = (prepared(Formulation::fourth_order()), prepared(Formulation::default()));
        // Slopes 2x + y and y - x/2 along x and y, no deflection: bending alone.
        let field = SVector::<f64, 8>::from_fn(|k, _| {
            let [x, y] = one.frame.xy[k / 2];
            [0.5 * x - y, 2.0 * x + y][k % 2]
        });
        let bending = |e: &Prepared| {
            let k = Prepared { d_s: Matrix2::zeros(), ..*e }.plate_stiffness();
            let dof = |i: usize| 3 * (i / 2) + 1 + i % 2;
            SMatrix::<f64, 8, 8>::from_fn(|i, j| k[(dof(i), dof(j))])
        };
        let [a, b] = [&one, &four].map(|e| bending(e) * field);
        assert!((a - b).norm() < 1e-12 * b.norm());
        // Half of the section is left to laws.
        let section = isotropic(0.5);
        let diagonal = |d: &Matrix3<f64>| Matrix3::from_diagonal(&(d.diagonal() * 0.5));
        let laws = [diagonal(&section.d_m), diagonal(&section.d_b)];
        let rest = one.cellwise([section.d_m - laws[0], section.d_b - laws[1]]);
        let tangent = [laws[0], laws[1]].map(|d| d.diagonal());
        let tangents: Vec<_> = rest.areas().map(|_| std::array::from_fn(|i| tangent[i / 3][i % 3])).collect();
        let added = rest.linear() + rest.stiffness(&tangents, &Gradient::zeros());
        let all = one.local_stiffness();
        assert!((added - all).norm() < 1e-12 * all.norm());
    }
}

/// Pure bending of a parallelogram in its plane, by exact displacements at the corners: energy and resultants of beam theory,
/// but for the penalty on θz, which on an oblique element is no part of bending.
#[test]
fn assumed_stresses_are_those_of_bending_in_the_plane() {
    let section = isotropic(1.0);
    for lean in [0.0, 0.6] {
        let corners = [[-1.0, -0.5], [1.0, -0.5], [1.0 + lean, 0.5], [lean - 1.0, 0.5]];
        let corners = corners.map(|[x, y]| Point3::new(x, y, 0.0));
        let formulation = Formulation { membrane: Membrane::AssumedStress, ..Formulation::default() };
        let warp = Vector3::new(0.8, 0.6, 0.0);
        let e = Prepared::new(Frame::global(&corners), &section, formulation, &warp).unwrap();
        // σ_x = y E, so ε_x = y, ε_y = -ν y: u = x y, v = -x²/2 - ν y²/2, θz = -x.
        let field = SVector::<f64, 12>::from_fn(|k, _| {
            let [x, y] = e.frame.xy[k / 3];
            [x * y, -0.5 * x * x - 0.15 * y * y, -x][k % 3]
        });
        let gamma = if lean == 0.0 { e.gamma } else { 0.0 };
        let energy = field.dot(&(Prepared { gamma, ..e }.membrane_stiffness() * field));
        // E t b ∫ y² dy with b = 2, height 1.
        assert!((energy - 0.1 * 2.0 / 12.0).abs() < 1e-12, "{lean}: {energy}");
        let (mean, varying) = e.assumed_membrane([0.3, 1.0]).unwrap();
        assert!((mean * field).norm() < 1e-14);
        let (c, s) = (0.8, 0.6);
        // N_x = E t y at y = 1/2, seen along the warp.
        let along_warp = Vector3::new(c * c, s * s, -c * s) * 0.05;
        assert!((varying * field - along_warp).norm() < 1e-12, "{lean}: {}", varying * field);
    }
}
