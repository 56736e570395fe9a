//! Goal: triangles, alone and among quads, are right where quads are, and their errors are known.
//!
//! ```text
//!   +---+---+     +---+---+     +---+---+
//!   | / | / |     | \ | / |     | / |   |     a square of n x n cells, each cut in two; or only some of them
//!   +---+---+     +---+---+     +---+---+
//!    alike        alternating    mixed
//! ```
//! Data: squares of unit side under unit pressure (D = 1, ν = 0.3), strips in large rotations (B = 1, ν = 0), Cook's panel;
//! nodes moved at random (seeded) where it is said. References (analytical): linear and quadratic fields, the series of
//! `kesf::analytical`, the heavy elastica; p-Ritz frequencies as in `modal.rs`; the converged 23.96 of Cook's panel.

use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;

use kesf::analytical::Plate;
use kesf::analytical::elastica::{heavy_elastica, tip_loaded};
use kesf::analytical::levy::Edge;
use kesf::analytical::mindlin::MindlinPlate;
use kesf::element::{Formulation, Mass, Membrane};
use kesf::fields::{self, ErrorEstimate, Recovery};
use kesf::law::{Backbone, Channel, Family, Mode, Slider, Widening};
use kesf::mesh::{QuadMesh, distorted, rectangle};
use kesf::model::{Dof, Load, Model, Support};
use kesf::section::{SheetLaw, ShellSection};
use kesf::solve::nonlinear::{self, Settings, Solution};
use kesf::solve::{self, Options};
use kesf::study::{Case, section, solve_case};
use nalgebra::{Matrix2, Matrix3, Point3, Rotation3, Vector3};
use vtkio::model::{CellType, DataSet, Piece, Vtk};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Cut {
    Alike,
    Alternating,
    /// Every second cell stays a quad.
    Mixed,
}

const CUTS: [Cut; 3] = [Cut::Alike, Cut::Alternating, Cut::Mixed];

/// The cells of a mesh, `n` in a row, cut in two.
fn cut(mesh: QuadMesh, n: usize, cut: Cut) -> QuadMesh {
    let parts = |(k, &[a, b, c, d]): (usize, &[u32; 4])| match (cut, (k % n + k / n) % 2) {
        (Cut::Mixed, 1) => vec![[a, b, c, d]],
        (Cut::Alternating, 1) => vec![[a, b, d, d], [b, c, d, d]],
        _ => vec![[a, b, c, c], [c, d, a, a]],
    };
    let quads = mesh.quads.iter().enumerate().flat_map(parts).collect();
    QuadMesh { quads, ..mesh }
}

fn square(n: usize, how: Cut, random: f64) -> QuadMesh {
    let mesh = cut(distorted(rectangle(1.0, 1.0, n, n).unwrap(), random, 3).unwrap(), n, how);
    mesh.check().unwrap();
    mesh
}

fn plate_section(t: f64, nu: f64) -> ShellSection {
    let plane = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu));
    ShellSection {
        d_m: plane * (12.0 / (t * t)),
        d_b: plane,
        d_s: Matrix2::identity() * (5.0 * (1.0 - nu) / (t * t)),
        areal_density: 1.0,
        thickness: t,
    }
}

fn model(mesh: QuadMesh, section: ShellSection, supports: Vec<Support>, loads: Vec<Load>) -> Model {
    let (warp, formulation) = (Vector3::x(), Formulation::default());
    Model { mesh, section, warp, formulation, supports, loads, bodies: Vec::new() }
}

/// `(u, v, w, θx, θy, θz)` of constant strains: membrane, curvature, transverse shear.
fn fields_of_patch() -> [fn(f64, f64) -> [f64; 6]; 3] {
    [
        |x, y| [1e-3 * x + 4e-4 * y, 9e-4 * x - 6e-4 * y, 0.0, 0.0, 0.0, 0.5 * (9e-4 - 4e-4)],
        // θx = w,y and θy = -w,x of w = -(κx x² + κy y² + κxy xy) / 2.
        |x, y| {
            let w = -0.5e-3 * (x * x - 0.6 * y * y + 1.3 * x * y);
            [0.0, 0.0, w, -1e-3 * (0.65 * x - 0.6 * y), 1e-3 * (x + 0.65 * y), 0.0]
        },
        |x, y| [0.0, 0.0, 1e-3 * x - 6e-4 * y, 0.0, 0.0, 0.0],
    ]
}

/// Patch tests, flat and turned in space: displacements, rotations and the resultants of every element; the recovery at the
/// nodes and the estimate of the error see nothing else.
#[test]
fn constant_strains_are_exact_on_irregular_meshes() {
    let section = ShellSection {
        d_m: Matrix3::new(1e4, 1.2e3, 0.0, 1.2e3, 6e3, 0.0, 0.0, 0.0, 40.0),
        d_b: Matrix3::from_diagonal(&[8.0, 4.0, 2.0].into()),
        d_s: Matrix2::identity() * 3.3e4,
        areal_density: 0.15,
        thickness: 4e-4,
    };
    let membranes = [Membrane::Cells, Membrane::OneCell, Membrane::AssumedStress];
    let spaces = [Rotation3::identity(), Rotation3::from_euler_angles(0.4, -1.1, 2.3)];
    let mut worst = 0.0f64;
    for (how, space, membrane) in
        CUTS.into_iter().flat_map(|how| spaces.iter().flat_map(move |s| membranes.map(|m| (how, s, m))))
    {
        for (kind, field) in fields_of_patch().into_iter().enumerate() {
            let flat = square(6, how, 0.5);
            let exact: Vec<[f64; 6]> = flat
                .nodes
                .iter()
                .map(|p| {
                    let f = field(p.x, p.y);
                    let [d, r] = [0, 3].map(|k| space * Vector3::new(f[k], f[k + 1], f[k + 2]));
                    [d.x, d.y, d.z, r.x, r.y, r.z]
                })
                .collect();
            let edge = flat.set("boundary").unwrap();
            let held = |node: usize| -> &[Dof] {
                match (edge.contains(&(node as u32)), kind) {
                    (true, _) => &Dof::ALL,
                    // Constant shear without moments is no equilibrium: rotations are held.
                    (false, 2) => &Dof::ALL[3..],
                    (false, _) => &[],
                }
            };
            let support = |node: usize| {
                let values = held(node).iter().map(|dof| (*dof, exact[node][*dof as usize])).collect();
                Support::at(vec![node as u32], values)
            };
            let supports =
                (0..flat.nodes.len()).filter(|node| !held(*node).is_empty()).map(support).collect();
            let mut mesh = flat.clone();
            mesh.nodes.iter_mut().for_each(|p| *p = space * *p);
            let mut model = model(mesh, section.clone(), supports, Vec::new());
            model.warp = space * Vector3::x();
            model.formulation.membrane = membrane;
            if kind == 2 {
                // Elements of different sizes have different stabilised stiffnesses, which a constant force would not strain alike.
                model.formulation.shear_stabilisation = 0.0;
            }
            let u = solve::solve(&model, &Options::default()).unwrap().displacement;
            for part in [0..3, 3..6] {
                let size = exact.iter().flat_map(|f| &f[part.clone()]).fold(0.0f64, |m, v| m.max(v.abs()));
                for (found, exact) in u.chunks_exact(6).zip(&exact) {
                    let error = part.clone().map(|k| (found[k] - exact[k]).abs()).fold(0.0, f64::max);
                    let relative = if size > 0.0 { error / size } else { error };
                    worst = worst.max(relative);
                    assert!(relative < 1e-9, "{how:?} {membrane:?} {kind}: {relative:e}");
                }
            }
            let nodal = fields::nodal(&model, &u).unwrap();
            let means = fields::element_means(&model, &u).unwrap();
            let expected: [f64; 8] = [
                [10.0 - 0.72, 1.2 - 3.6, 0.052, 0.0, 0.0, 0.0, 0.0, 0.0],
                [0.0, 0.0, 0.0, 8e-3, -2.4e-3, 2.6e-3, 0.0, 0.0],
                [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 33.0, -19.8],
            ][kind];
            let size = expected.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            // At nodes the shear force is the derivative of moments, which are no equilibrium here.
            let at_nodes = if kind == 2 { &[] } else { nodal.as_slice() };
            let part = [0..3, 3..6, 6..8][kind].clone();
            for all in means.iter().chain(at_nodes) {
                for k in part.clone() {
                    let off = (all.components()[k] - expected[k]).abs() / size;
                    worst = worst.max(off);
                    assert!(off < 1e-9, "{how:?} {membrane:?} {kind}: {off:e}");
                }
            }
            if kind < 2 {
                let estimate = ErrorEstimate::new(&model, &u, &nodal).unwrap();
                assert!(estimate.relative() < 1e-6, "{}", estimate.relative());
            }
        }
    }
    println!("largest relative error of displacements and rotations {worst:e}");
}

/// A pressed square: deflection of its middle over the exact one, less 1.
fn error(mesh: QuadMesh, t: f64, clamped: bool) -> f64 {
    let section = plate_section(t, 0.3);
    let exact = match (clamped, t > 0.01) {
        (false, false) => {
            Plate::of_section(1.0, 1.0, &section).levy(Edge::Supported, 0.5, 0.5, 1.0).deflection
        }
        (true, false) => Plate::of_section(1.0, 1.0, &section).clamped(1.0).unwrap().deflection(0.5, 0.5),
        (false, true) => MindlinPlate::of_section(1.0, 1.0, &section).supported(0.5, 0.5, 1.0).deflection,
        (true, true) => {
            MindlinPlate::of_section(1.0, 1.0, &section).clamped(1.0, 12).unwrap().deflection(0.5, 0.5)
        }
    };
    let edge = mesh.set("boundary").unwrap();
    let support =
        if clamped { Support::clamped(edge) } else { Support::simple(&mesh, "boundary", true).unwrap() };
    let model = model(mesh, section, vec![support], vec![Load::Pressure(1.0)]);
    let u = solve::solve(&model, &Options::default()).unwrap().displacement;
    let found = fields::Locator::find(&model.mesh, &Point3::new(0.5, 0.5, 0.0)).unwrap();
    found.interpolate(&model.mesh, |n| u[6 * n + 2]) / exact - 1.0
}

/// Second order, and no locking: with t/L = 1e-5 as with 1e-3.
#[test]
fn pressed_squares_converge_to_the_series() {
    for (how, clamped) in CUTS.into_iter().flat_map(|how| [(how, true), (how, false)]) {
        for t in [0.1, 1e-3, 1e-5] {
            let errors = [8, 16, 32].map(|n| error(square(n, how, 0.0), t, clamped));
            let percent = errors.map(|e| format!("{:.2}", 100.0 * e));
            println!("{how:?} clamped {clamped} t/L {t}: {} %", percent.join(", "));
            assert!(errors[1].abs() < 0.01 && errors[2].abs() < 0.003, "{how:?} {clamped} {t}: {errors:?}");
            // Where the error changes its sign with the mesh it has no slope.
            if errors[0].abs() > 0.02 {
                let slope = (errors[0] / errors[2]).abs().log2() / 2.0;
                assert!((1.7..2.6).contains(&slope), "{how:?} {clamped} {t}: slope {slope}, {errors:?}");
            }
        }
    }
    for (clamped, t) in [(true, 1e-3), (false, 1e-3), (true, 1e-5)] {
        let errors = [16, 32].map(|n| error(square(n, Cut::Alike, 0.4), t, clamped));
        println!(
            "at random, clamped {clamped} t/L {t}: {:.2}, {:.2} %",
            100.0 * errors[0],
            100.0 * errors[1]
        );
        assert!(errors[0].abs() < 0.015 && errors[1].abs() < 0.005, "{clamped} {t}: {errors:?}");
    }
}

/// Without the stabilisation thin triangles bend along their lines alone: what the element does not hide.
#[test]
fn without_stabilisation_thin_triangles_lock() {
    let centre = |alpha: f64| {
        let mesh = square(16, Cut::Alike, 0.0);
        let clamped = Support::clamped(mesh.set("boundary").unwrap());
        let mut model = model(mesh, plate_section(1e-4, 0.3), vec![clamped], vec![Load::Pressure(1.0)]);
        model.formulation.shear_stabilisation = alpha;
        solve::solve(&model, &Options::default()).unwrap().displacement[6 * (8 * 17 + 8) + 2] / 0.00126532
    };
    println!("without stabilisation {}", centre(0.0));
    assert!(centre(0.0) < 0.5, "{}", centre(0.0));
    assert!((centre(0.05) - 1.0).abs() < 0.01);
}

/// The first six of a clamped square, thin.
#[test]
fn frequencies_of_a_clamped_square() {
    let exact = [35.98519, 73.39385, 73.39385, 108.21650, 131.58077, 132.20479];
    for (how, mass) in CUTS.into_iter().flat_map(|how| [(how, Mass::Lumped), (how, Mass::Consistent)]) {
        let errors = [16, 32].map(|n| {
            let mesh = square(n, how, 0.0);
            let clamped = Support::clamped(mesh.set("boundary").unwrap());
            let model = model(mesh, plate_section(1e-3, 0.3), vec![clamped], Vec::new());
            let found = solve::modes(&model, 6, mass, &Options::default()).unwrap();
            let errors: Vec<f64> =
                found.iter().zip(exact).map(|(m, e)| 100.0 * (m.angular_frequency / e - 1.0)).collect();
            println!("{how:?} {mass:?} n {n}: {errors:.2?} %");
            errors
        });
        let largest = |e: &[f64]| e.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let limits = if mass == Mass::Lumped { [2.5, 0.7] } else { [6.0, 1.5] };
        assert!(largest(&errors[0]) < limits[0] && largest(&errors[1]) < limits[1], "{how:?}: {errors:?}");
    }
}

/// Whichever node of a triangle comes first, and whichever is the one that a quad has twice.
#[test]
fn the_order_of_the_nodes_does_not_matter() {
    let deflection = |turn: usize, nonlinear: bool| {
        let mut mesh = square(5, Cut::Mixed, 0.4);
        for (k, quad) in mesh.quads.iter_mut().enumerate().filter(|(_, q)| q[2] == q[3]) {
            let nodes = [quad[0], quad[1], quad[2]];
            *quad = [0, 1, 2, 2].map(|i| nodes[(i + turn * (k % 3)) % 3]);
        }
        let clamped = Support::clamped(mesh.set("left").unwrap());
        let model = model(mesh, plate_section(1e-2, 0.3), vec![clamped], vec![Load::Pressure(2.0)]);
        if nonlinear {
            let solution = run(&model, None);
            return solution.state.displacement(&model.mesh);
        }
        solve::solve(&model, &Options::default()).unwrap().displacement
    };
    for (nonlinear, tolerance) in [(false, 1e-8), (true, 1e-3)] {
        let one = deflection(0, nonlinear);
        let size = one.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        for turn in [1, 2] {
            let other = deflection(turn, nonlinear);
            let off = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size;
            println!("nonlinear {nonlinear}, turned by {turn}: {off:e}");
            assert!(off < tolerance, "{nonlinear} {turn}: {off:e}");
        }
    }
}

fn run(model: &Model, law: Option<SheetLaw>) -> Solution {
    let settings = Settings { law, first_step: 0.1, largest_step: 0.25, ..Settings::default() };
    nonlinear::solve(model, &settings, &Options::default(), |_| ControlFlow::Continue(())).unwrap()
}

/// A cantilever of unit length along x in cylindrical bending, `n` cells long and two across.
fn strip(n: usize, how: Cut, t: f64, membrane: Membrane, loads: impl Fn(&QuadMesh) -> Vec<Load>) -> Model {
    let mesh = cut(rectangle(1.0, 2.0 / n as f64, n, 2).unwrap(), n, how);
    let supports = vec![
        Support::fix(mesh.set("all").unwrap(), &[Dof::V, Dof::ThetaX, Dof::ThetaZ]),
        Support::clamped(mesh.set("left").unwrap()),
    ];
    let loads = loads(&mesh);
    let mut model = model(mesh, plate_section(t, 0.0), supports, loads);
    model.formulation.membrane = membrane;
    model
}

/// Mean displacement of the free end.
fn tip(model: &Model, solution: &Solution) -> Vector3<f64> {
    let nodes = model.mesh.set("right").unwrap();
    let displacements =
        nodes.iter().map(|n| solution.state.position[*n as usize] - model.mesh.nodes[*n as usize]);
    displacements.sum::<Vector3<f64>>() / nodes.len() as f64
}

/// Drops of the end of a strip under its weight and under a force, of its length; few iterations a step show that the tangent is that
/// of the forces. With the membrane along arcs triangles alone are closer by five times and more at the larger loads.
#[test]
fn strips_in_large_rotations_are_the_elastica() {
    let membranes = [Membrane::Cells, Membrane::OneCell, Membrane::AssumedStress];
    for (how, membrane) in CUTS.into_iter().flat_map(|how| membranes.map(|m| (how, m))) {
        for gamma in [8.0, 50.0, 200.0] {
            let exact = heavy_elastica(gamma).unwrap().drop;
            let errors = [16, 32].map(|n| {
                let weight = |_: &QuadMesh| vec![Load::Gravity(Vector3::new(0.0, 0.0, -gamma))];
                let model = strip(n, how, 2e-3, membrane, weight);
                let solution = run(&model, None);
                assert!(
                    solution.iterations <= 9 * solution.steps,
                    "{} steps, {} iterations",
                    solution.steps,
                    solution.iterations
                );
                assert!(solution.stability.is_stable());
                -tip(&model, &solution).z - exact
            });
            println!("{how:?} {membrane:?} weight {gamma}: {:.2?} thousandths", errors.map(|e| 1e3 * e));
            assert!(
                errors[0].abs() < 3e-3 && errors[1].abs() < 8e-4,
                "{how:?} {membrane:?} {gamma}: {errors:?}"
            );
        }
        let force = |mesh: &QuadMesh| {
            let edges = mesh.set_edges("right").unwrap();
            vec![Load::Edge { edges, force: Vector3::new(0.0, 0.0, -10.0), moment: Vector3::zeros() }]
        };
        let model = strip(32, how, 2e-3, membrane, force);
        let (found, exact) = (tip(&model, &run(&model, None)), tip_loaded(10.0).unwrap());
        let off = (-found.z - exact.drop).abs().max((-found.x - exact.shortening).abs());
        println!("{how:?} {membrane:?} force 10: {off:.1e}");
        assert!(off < 1.5e-4, "{how:?} {membrane:?}: {off:e}");
    }
}

/// A straight backbone and a slider in the bending along the strip.
fn friction() -> SheetLaw {
    let family = Family { widening: Widening::Constant, sliders: vec![Slider { stiffness: 0.4, slip: 0.5 }] };
    let channel = Channel::new(Backbone::line(0.6).unwrap(), vec![family], false).unwrap();
    SheetLaw::new(Mode::Friction, [None, None, None, Some(channel), None, None])
}

/// A strip whose bending rubs, loaded in its plane of bending: as one of quads, with which it shares every law.
#[test]
fn a_strip_with_friction_is_that_of_quads() {
    let force = |mesh: &QuadMesh| {
        let edges = mesh.set_edges("right").unwrap();
        vec![Load::Edge { edges, force: Vector3::new(0.0, 0.0, -2.0), moment: Vector3::zeros() }]
    };
    let drop = |mesh: fn(QuadMesh) -> QuadMesh| {
        let mut model = strip(32, Cut::Mixed, 2e-3, Membrane::OneCell, force);
        model.mesh = mesh(rectangle(1.0, 2.0 / 32.0, 32, 2).unwrap());
        let settings =
            Settings { law: Some(friction()), first_step: 0.1, largest_step: 0.1, ..Settings::default() };
        let found = nonlinear::solve(&model, &settings, &Options::default(), |_| ControlFlow::Continue(()));
        let found = found.unwrap();
        println!("{} steps, {} iterations", found.steps, found.iterations);
        assert!(found.iterations <= 5 * found.steps, "{} iterations", found.iterations);
        tip(&model, &found).z
    };
    let quads = drop(|mesh| mesh);
    for (how, cut) in [
        ("alike", (|mesh| cut(mesh, 32, Cut::Alike)) as fn(QuadMesh) -> QuadMesh),
        ("alternating", |mesh| cut(mesh, 32, Cut::Alternating)),
        ("mixed", |mesh| cut(mesh, 32, Cut::Mixed)),
    ] {
        let off = drop(cut) / quads - 1.0;
        println!("{how}: {off:e}");
        assert!(off.abs() < 5e-3, "{how}: {off}");
    }
}

/// Cook's panel: constant strains are stiff in bending in the plane.
#[test]
fn cooks_panel_tells_how_stiff_constant_strains_are() {
    let tip = |n: usize, how: Option<Cut>| {
        let mut mesh = rectangle(1.0, 1.0, n, n).unwrap();
        for p in &mut mesh.nodes {
            let low = 44.0 * p.x;
            *p = Point3::new(48.0 * p.x, low + (44.0 - 28.0 * p.x) * p.y, 0.0);
        }
        let mesh = how.map_or(mesh.clone(), |how| cut(mesh, n, how));
        let plane = Matrix3::new(1.0, 1.0 / 3.0, 0.0, 1.0 / 3.0, 1.0, 0.0, 0.0, 0.0, 1.0 / 3.0) * 1.125;
        let section = ShellSection { d_m: plane, d_b: plane / 12.0, ..plate_section(1.0, 1.0 / 3.0) };
        let supports = vec![
            Support::clamped(mesh.set("left").unwrap()),
            Support::fix(mesh.set("all").unwrap(), &[Dof::W, Dof::ThetaX, Dof::ThetaY]),
        ];
        let edges = mesh.set_edges("right").unwrap();
        let load = Load::Edge { edges, force: Vector3::new(0.0, 1.0 / 16.0, 0.0), moment: Vector3::zeros() };
        let middle = mesh.set("right").unwrap()[n / 2];
        let model = model(mesh, section, supports, vec![load]);
        solve::solve(&model, &Options::default()).unwrap().displacement[6 * middle as usize + 1] / 23.96
    };
    let quads = [4, 8, 16, 32].map(|n| tip(n, None));
    let alike = [4, 8, 16, 32].map(|n| tip(n, Some(Cut::Alike)));
    let alternating = [4, 8, 16, 32].map(|n| tip(n, Some(Cut::Alternating)));
    println!("quads {quads:.3?}, triangles {alike:.3?}, alternating {alternating:.3?}");
    for triangles in [alike, alternating] {
        assert!(triangles.windows(2).all(|w| w[0] < w[1]) && triangles[3] > 0.96 && triangles[3] < 1.0);
        assert!(triangles.iter().zip(quads).all(|(t, q)| *t < q));
    }
}

/// Moments and shear forces at the nodes inside a simply supported square, and the estimate of their error.
#[test]
fn moments_inside_are_recovered() {
    for (how, random) in [(Cut::Alike, 0.0), (Cut::Alternating, 0.0), (Cut::Mixed, 0.4)] {
        let mesh = square(32, how, random);
        let section = plate_section(1e-3, 0.3);
        let plate = Plate::of_section(1.0, 1.0, &section);
        let supports = vec![Support::simple(&mesh, "boundary", true).unwrap()];
        let model = model(mesh, section, supports, vec![Load::Pressure(1.0)]);
        let u = solve::solve(&model, &Options::default()).unwrap().displacement;
        let nodal = Recovery::new(&model.mesh).nodal(&model, &u).unwrap();
        let (mut error, mut size) = (0.0, 0.0);
        for (p, found) in model.mesh.nodes.iter().zip(&nodal) {
            if [p.x, p.y].iter().all(|c| (0.11..0.89).contains(c)) {
                let exact = plate.levy(Edge::Supported, p.x, p.y, 1.0);
                for (found, exact) in found.moment.into_iter().zip([exact.mx, exact.my, exact.mxy]) {
                    error += (found - exact).powi(2);
                    size += exact * exact;
                }
            }
        }
        let off = f64::sqrt(error / size);
        let estimate = ErrorEstimate::new(&model, &u, &nodal).unwrap();
        println!(
            "{how:?} {random}: M {:.2} % off, estimate {:.1} %",
            100.0 * off,
            100.0 * estimate.relative()
        );
        assert!(
            off < 0.02 && (0.01..0.1).contains(&estimate.relative()),
            "{how:?}: {off} {}",
            estimate.relative()
        );
    }
}

/// The shipped case of a mesh of quads and triangles through the command: the value of the books, what the document and the text tell
/// of the mesh, and the cells of its VTU file.
#[test]
fn a_mixed_mesh_goes_through_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = Command::new(env!("CARGO_BIN_EXE_kesf"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["solve", "--json", "-q", "examples/imported/plate.toml", "-o"])
        .arg(&out)
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let document: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    let solution = &document["solutions"][0];
    assert_eq!(solution["model"]["elements"], 366);
    assert_eq!(solution["model"]["triangles"], 156);
    assert_eq!(solution["checks"][0]["passed"], true, "{}", solution["checks"]);
    let vtu = std::fs::read(out.join("cases/plate.vtu")).unwrap();
    let DataSet::UnstructuredGrid { pieces, .. } = Vtk::parse_xml(vtu.as_slice()).unwrap().data else {
        panic!("not an unstructured grid")
    };
    let Piece::Inline(piece) = &pieces[0] else { panic!("not inline") };
    let triangles = piece.cells.types.iter().filter(|kind| **kind == CellType::Triangle).count();
    let quads = piece.cells.types.iter().filter(|kind| **kind == CellType::Quad).count();
    assert_eq!((triangles, quads), (156, 210));
    let (nodes, ends) = piece.cells.cell_verts.clone().into_xml();
    assert_eq!((nodes.len(), ends.last()), (3 * 156 + 4 * 210, Some(&(3 * 156 + 4 * 210))));
    assert!(out.join("cases/plate.png").exists() && out.join("cases/plate.glb").exists());
}

/// A triangle without area and one with a node twice are refused with file and line.
#[test]
fn what_is_no_triangle_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let example = |name: &str| {
        std::fs::read_to_string(format!("{}/examples/imported/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
    };
    std::fs::write(folder.path().join("plate.toml"), example("plate.toml")).unwrap();
    let mesh = example("plate.msh");
    let (line, row) =
        mesh.lines().enumerate().skip_while(|(_, row)| !row.starts_with("2 1 2 ")).nth(1).unwrap();
    let tag = row.split(' ').next().unwrap();
    for (nodes, message) in [("1 2 3", "in a line"), ("1 2 1", "three different ones"), ("1 2", "needs 4")] {
        std::fs::write(folder.path().join("plate.msh"), mesh.replace(row, &format!("{tag} {nodes}")))
            .unwrap();
        let run = Command::new(env!("CARGO_BIN_EXE_kesf"))
            .current_dir(folder.path())
            .args(["solve", "plate.toml"])
            .output()
            .unwrap();
        let error = String::from_utf8_lossy(&run.stderr);
        assert!(!run.status.success());
        assert!(error.contains(&format!("plate.msh:{}", line + 1)) && error.contains(message), "{error}");
    }
}

/// A quarter of 20 cm of cloth, clamped all round under its own weight: the sheet of `cases/self_weight_clamped.toml`, 1.948 mm by von
/// Kármán's equations.
#[test]
fn a_clamped_cloth_under_its_own_weight_is_a_membrane() {
    let section = ShellSection {
        d_m: Matrix3::new(10000.0, 1200.0, 0.0, 1200.0, 6000.0, 0.0, 0.0, 0.0, 40.0 * 0.976) / 0.976,
        d_b: Matrix3::from_diagonal(&[8e-6, 4e-6, 0.0].into()),
        d_s: Matrix2::identity() * 50.0,
        areal_density: 0.15,
        thickness: 4e-4,
    };
    for (how, membrane) in
        CUTS.into_iter().flat_map(|how| [(how, Membrane::OneCell), (how, Membrane::AssumedStress)])
    {
        let mesh = cut(rectangle(0.1, 0.1, 20, 20).unwrap(), 20, how);
        let set = |name: &str| mesh.set(name).unwrap();
        let supports = vec![
            Support::symmetry_x(set("left")),
            Support::symmetry_y(set("bottom")),
            Support::clamped(set("right")),
            Support::clamped(set("top")),
        ];
        let load = vec![Load::Gravity(Vector3::new(0.0, 0.0, -9.80665))];
        let mut model = model(mesh, section.clone(), supports, load);
        model.formulation.membrane = membrane;
        let solution = run(&model, None);
        let off = -solution.state.position[0].z / 1.948e-3 - 1.0;
        println!("{how:?} {membrane:?}: {:.2} %, {} iterations", 100.0 * off, solution.iterations);
        assert!(off.abs() < 0.02, "{how:?} {membrane:?}: {off}");
    }
}

/// Cloth that folds obliquely to its mesh: a square clamped in one corner up to x + y = 1/2, its other corner hanging down. Three
/// chords a triangle hold back a fold whose curvature varies; along its arcs the sheet folds as on a finer mesh of quads (own
/// reference: 32 x 32 of them).
#[test]
fn along_arcs_triangles_fold_obliquely_to_their_mesh() {
    let drop = |n: usize, how: Option<Cut>, membrane: Membrane| {
        let mesh = rectangle(1.0, 1.0, n, n).unwrap();
        let mesh = how.map_or(mesh.clone(), |how| cut(mesh, n, how));
        let held = |k: &u32| mesh.nodes[*k as usize].x + mesh.nodes[*k as usize].y < 0.5 + 1e-9;
        let clamped: Vec<u32> = (0..mesh.nodes.len() as u32).filter(held).collect();
        let weight = vec![Load::Gravity(Vector3::new(0.0, 0.0, -20.0))];
        let mut model = model(mesh, plate_section(1e-3, 0.0), vec![Support::clamped(&clamped)], weight);
        model.formulation.membrane = membrane;
        -run(&model, None).state.position[(n + 1) * (n + 1) - 1].z
    };
    let quads = drop(32, None, Membrane::AssumedStress);
    for how in [Cut::Alike, Cut::Alternating] {
        let [chords, arcs] =
            [Membrane::OneCell, Membrane::AssumedStress].map(|m| drop(16, Some(how), m) / quads);
        println!("{how:?}: chords {chords:.3}, arcs {arcs:.3} of the drop of quads");
        assert!(chords < 0.85 && (arcs - 1.0).abs() < 0.03, "{how:?}: {chords} {arcs}");
    }
}

/// The membrane along arcs is that of a mesh with triangles in large rotations, unless the case chooses another.
#[test]
fn a_case_in_large_rotations_has_arcs_where_there_are_triangles() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/imported/plate.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let text = &text[..text.find("[[checks]]").unwrap()];
    // Oblique hard supports are for small rotations.
    let text = text.replace("\"simply_supported\"", "\"simply_supported_soft\"");
    let nonlinear = "[analysis]\nkind = \"nonlinear\"\n";
    let cells = "[element]\nmembrane = \"cells\"\n";
    for (more, expected) in [
        (String::new(), Membrane::Cells),
        (nonlinear.to_string(), Membrane::AssumedStress),
        (format!("{nonlinear}{cells}"), Membrane::Cells),
    ] {
        let case = Case::parse(&file, &format!("{text}{more}")).unwrap();
        let made = section(case.section().unwrap()).unwrap();
        let result = solve_case(&case, made, &Options::default()).unwrap();
        assert_eq!(result.model.formulation.membrane, expected, "{more}");
        let centre = result.probes[0].value.u[2];
        println!("{more:?}: {centre:e}");
        assert!((centre / 1.041667e-6 - 1.0).abs() < 0.02, "{more}: {centre:e}");
    }
}
