//! Rank and rigid-mode counts of one element (theory: table of zero-energy modes), reference: the
//! design document's independent implementation.

use super::*;
use crate::element::{
    Cells, Gradient, Mass, Membrane, ShearInterpolation, follower_pressure, gravity_load, pressure_load,
    pressure_moments,
};
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

/// A scalene triangle, oblique in space, that begins with its `first` corner.
fn triangle(first: usize) -> [Point3<f64>; 4] {
    let corners = [[0.1, -0.2, 0.3], [1.3, 0.1, -0.1], [0.4, 0.9, 0.2]].map(Point3::from);
    [0, 1, 2, 2].map(|i| corners[(first + i) % 3])
}

/// A matrix over the four corners of a triangle as that over its three nodes, in the order of [`triangle`] with 0.
fn of_nodes(k: &Matrix24, first: usize) -> SMatrix<f64, 18, 18> {
    let mut sum = SMatrix::zeros();
    let dof = |k: usize| 6 * ((first + (k / 6).min(2)) % 3) + k % 6;
    for (i, j) in (0..24).flat_map(|i| (0..24).map(move |j| (i, j))) {
        sum[(dof(i), dof(j))] += k[(i, j)];
    }
    sum
}

const MEMBRANES: [Membrane; 3] = [Membrane::Cells, Membrane::OneCell, Membrane::AssumedStress];

/// The spin of the rotations `β = e3 × x`, which a constant shear strain does not see, costs energy too.
#[test]
fn a_triangle_has_the_six_rigid_motions_and_no_other_without_energy() {
    let x = Vector3::x();
    for (membrane, nc) in MEMBRANES.into_iter().flat_map(|m| [1, 3, 4, 16].map(|nc| (m, nc))) {
        for (shear_stabilisation, drilling) in [(0.0, Drilling::HughesBrezzi), (0.05, Drilling::Scaled)] {
            let cells = Cells::from_count(nc).unwrap();
            let formulation =
                Formulation { cells, membrane, shear_stabilisation, drilling, ..Formulation::default() };
            let e = Prepared::from_corners(&triangle(0), &isotropic(1.0), formulation, &x).unwrap();
            assert_eq!(zero_modes(of_nodes(&e.stiffness(), 0)), 6, "{membrane:?}, nc = {nc}");
        }
    }
}

/// Every cell layout and every membrane is the constant strain of the triangle.
#[test]
fn a_triangle_is_the_same_whatever_the_cells_and_whichever_node_comes_first() {
    let mut section = isotropic(0.4);
    section.d_m[(1, 1)] *= 0.3;
    section.d_b[(1, 1)] *= 3.0;
    let warp = Vector3::new(0.8, 0.6, 0.0);
    let prepared = |first: usize, formulation| {
        Prepared::from_corners(&triangle(first), &section, formulation, &warp).unwrap()
    };
    // The spring of Nguyen-Trong et al. is a part of the largest term in the axes of the frame, which a node turns that comes first.
    let seed = Formulation { drilling: Drilling::HughesBrezzi, ..Formulation::seed() };
    for mut formulation in [Formulation::default(), seed, Formulation::fourth_order()] {
        let expected = of_nodes(&prepared(0, formulation).stiffness(), 0);
        for (membrane, first) in MEMBRANES.into_iter().flat_map(|m| [0, 1, 2].map(|first| (m, first))) {
            for nc in [1, 2, 3, 9] {
                formulation.membrane = membrane;
                formulation.cells = Cells::from_count(nc).unwrap();
                let found = of_nodes(&prepared(first, formulation).stiffness(), first);
                assert!((found - expected).norm() < 1e-12 * expected.norm(), "{membrane:?} {first} {nc}");
            }
        }
    }
    for shear in [ShearInterpolation::Displacement, ShearInterpolation::Reduced] {
        let formulation = Formulation { shear, ..Formulation::default() };
        let [a, b] = [0, 1].map(|first| of_nodes(&prepared(first, formulation).stiffness(), first));
        assert!((a - b).norm() < 1e-12 * a.norm(), "{shear:?}");
    }
}

/// Against the polynomials: a third of everything goes to each node, `ρ A / 12 (1 + δ_ij)` to each pair.
#[test]
fn masses_and_loads_of_a_triangle_are_those_of_linear_shape_functions() {
    let section = ShellSection { areal_density: 3.0, thickness: 0.2, ..isotropic(1.0) };
    for first in 0..3 {
        let corners = triangle(first);
        let frame = Frame::of(&corners);
        let [a, b, c, _] = corners;
        let normal = 0.5 * (b - a).cross(&(c - a));
        assert!((frame.area() - normal.norm()).abs() < 1e-15);
        let mass = 3.0 * frame.area();
        let consistent = of_nodes(&Mass::Consistent.matrix(&frame, &section), first);
        let lumped = of_nodes(&Mass::Lumped.matrix(&frame, &section), first);
        for (i, j) in
            (0..18).flat_map(|i| (0..18).map(move |j| (i, j))).filter(|(i, j)| i % 6 < 3 && j % 6 < 3)
        {
            let [same_node, same_dof] =
                [i / 6 == j / 6, i % 6 == j % 6].map(|same| f64::from(u8::from(same)));
            let of_pair = same_dof * mass / 12.0;
            assert!((consistent[(i, j)] - of_pair * (1.0 + same_node)).abs() < 1e-15);
            assert!((lumped[(i, j)] - of_pair * 4.0 * same_node).abs() < 1e-15);
        }
        let (g, p) = (Vector3::new(1.0, 2.0, -3.0), 5.0);
        for (loads, whole) in [
            (pressure_load(&frame, p), normal * p),
            (follower_pressure(&corners, p), normal * p),
            (gravity_load(&frame, 3.0, &g), g * mass),
        ] {
            let nodes = [loads[0], loads[1], loads[2] + loads[3]];
            assert!(nodes.iter().all(|f| (f - whole / 3.0).norm() < 1e-14));
        }
        // `p ∫ 4 λ_i λ_j dA / 8` on the rotations along each side.
        let moments = pressure_moments(&frame, p);
        for (node, moment) in moments.iter().take(3).enumerate() {
            let [before, after] = [2, 1].map(|step| corners[(node + step) % 3] - corners[node]);
            let along = normal.normalize().cross(&(-before - after)) * (p * frame.area() / 24.0);
            assert!((moment - along).norm() < 1e-14, "{moment} {along}");
        }
        assert_eq!(moments[3], Vector3::zeros());
    }
}

/// Linear displacements with constant rotations are sheared alike everywhere, linear rotations with their parabolas of w
/// not at all.
#[test]
fn the_shear_of_a_triangle_is_exact_for_constant_shear_and_for_constant_curvature() {
    let e =
        Prepared::from_corners(&triangle(0), &isotropic(1.0), Formulation::default(), &Vector3::x()).unwrap();
    let field = |at: fn(f64, f64) -> [f64; 3]| {
        SVector::<f64, 12>::from_fn(|k, _| at(e.frame.xy[k / 3][0], e.frame.xy[k / 3][1])[k % 3])
    };
    for natural in [[-1.0, -1.0], [0.3, 1.0], [0.0, -1.0 / 3.0]] {
        let b = e.shear_strain_matrix(natural);
        // γ = (w,x + θy, w,y - θx).
        let sheared = b * field(|x, y| [2.0 * x - y, 0.25, 0.5]);
        assert!((sheared - nalgebra::Vector2::new(2.5, -1.25)).norm() < 1e-13, "{sheared}");
        let bent =
            b * field(|x, y| [x * x + 3.0 * x * y - 2.0 * y * y, 3.0 * x - 4.0 * y, -2.0 * x - 3.0 * y]);
        assert!(bent.norm() < 1e-13, "{bent}");
    }
}

/// Three sides of an arc each: a triangle on a cylinder of radius R strains by `(s·t)⁴ / (24 R² |s|²)` along a side s less than
/// its chords say, `t` the direction around it.
#[test]
fn the_arcs_of_a_triangle_give_each_side_its_length() {
    let formulation = Formulation { membrane: Membrane::AssumedStress, ..Formulation::default() };
    let corners = [[0.0, 0.0], [1.0, 0.2], [0.3, 0.8], [0.3, 0.8]].map(|[x, y]| Point3::new(x, y, 0.0));
    let e = Prepared::new(Frame::global(&corners), &isotropic(1.0), formulation, &Vector3::x()).unwrap();
    let (curvature, around) = (0.1, nalgebra::Vector2::new(0.6, 0.8));
    // β = -κ t (t·x), of which the rotation vector is (-β_y, β_x).
    let mut local = Vector24::zeros();
    for (i, [x, y]) in e.frame.xy.into_iter().enumerate() {
        let beta = -around * curvature * around.dot(&nalgebra::Vector2::new(x, y));
        (local[6 * i + 3], local[6 * i + 4]) = (-beta.y, beta.x);
    }
    let strain = e.arcs().unwrap().bent(&local).strain;
    for [i, j] in [[0, 1], [1, 2], [2, 0]] {
        let s = corners[j] - corners[i];
        let (s, length) = (s.xy(), s.norm());
        let along = (strain.x * s.x * s.x + strain.y * s.y * s.y + strain.z * s.x * s.y) / (length * length);
        // The arc of a chord c with the turn φ between its ends is c (1 + φ²/24).
        let turn = curvature * around.dot(&s) * around.dot(&s) / length;
        assert!((along - turn * turn / 24.0).abs() < 1e-15, "{along}");
    }
}
