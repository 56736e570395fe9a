//! Goal: the preconditioned conjugate gradients find what the factorisation finds.
//!
//! Data: square plates of 1 m, clamped, simply supported and held on one side, isotropic and
//! orthotropic (B1/B2 = 4), t/L = 1e-2 to 1e-5, regular and distorted; the Scordelis-Lo roof. Reference: the direct
//! path on the same equations (own), which has references of its own; so this shows that the equations
//! are solved, not that they are right. Tolerance: 1e-8 of the largest displacement and of the
//! largest rotation.

use kesf::element::Formulation;
use kesf::mesh::{QuadMesh, distorted, rectangle};
use kesf::model::{Dof, Load, Model, RigidBody, Support};
use kesf::section::ShellSection;
use kesf::solve::iterative::Settings;
use kesf::solve::{Method, Options, SolveError, solve};
use nalgebra::{Matrix2, Matrix3, Point3, Vector3};

/// D11 = 1 N·m, D22 = 1 / `ratio`.
fn section(t: f64, ratio: f64) -> ShellSection {
    let (d22, h) = (1.0 / ratio, 0.35 / ratio.sqrt());
    let d12 = 0.3 * d22.sqrt();
    let d_b = Matrix3::new(1.0, d12, 0.0, d12, d22, 0.0, 0.0, 0.0, h);
    ShellSection {
        d_m: d_b * (12.0 / (t * t)),
        d_b,
        d_s: Matrix2::identity() * (3.5 / (t * t)),
        areal_density: 1.0,
        thickness: t,
    }
}

fn plate(mesh: QuadMesh, section: ShellSection, supports: Vec<Support>) -> Model {
    let loads = vec![Load::Pressure(1.0)];
    Model {
        mesh,
        section,
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports,
        loads,
        bodies: Vec::new(),
    }
}

fn clamped(n: usize, t: f64, ratio: f64) -> Model {
    let mesh = rectangle(1.0, 1.0, n, n).unwrap();
    let supports = vec![Support::clamped(mesh.set("boundary").unwrap())];
    plate(mesh, section(t, ratio), supports)
}

const ITERATIVE: Options = Options {
    threads: 1,
    path: kesf::solve::factor::Path::Auto,
    coupled: false,
    method: Method::Iterative,
    factor_limit: 0,
    memory_limit: u64::MAX,
    iteration: Settings { tolerance: 1e-10, max_iterations: 1000 },
};

/// Iterations of all systems, after the comparison.
fn check(model: &Model, coupled: bool, what: &str) -> usize {
    let direct = solve(model, &Options { coupled, method: Method::Direct, ..Options::default() }).unwrap();
    let iterated = solve(model, &Options { coupled, ..ITERATIVE }).unwrap();
    assert!(direct.systems.iter().all(|s| s.history.is_empty() && s.counts.flops > 0.0));
    assert!(iterated.residual <= 1e-8, "{what}: residual {:.1e}", iterated.residual);
    for from in [0, 3] {
        let components =
            |u: &[f64]| u.chunks_exact(6).flat_map(|n| n[from..from + 3].to_vec()).collect::<Vec<_>>();
        let (d, i) = (components(&direct.displacement), components(&iterated.displacement));
        let scale = d.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let error = d.iter().zip(&i).fold(0.0f64, |m, (d, i)| m.max((d - i).abs())) / scale;
        assert!(error <= 1e-8, "{what}: dofs {from} on differ by {error:.1e}");
    }
    let iterations = iterated.systems.iter().map(|s| s.iterations()).sum();
    println!(
        "{what}: {iterations} iterations, residual {:.1e}, direct {:.1e}",
        iterated.residual, direct.residual
    );
    iterations
}

#[test]
fn plates_of_every_thinness_and_support() {
    for t in [1e-2, 1e-3, 1e-5] {
        for ratio in [1.0, 4.0] {
            check(&clamped(40, t, ratio), false, &format!("clamped, t = {t}, ratio {ratio}"));
        }
        let mesh = rectangle(1.0, 1.0, 33, 41).unwrap();
        let supports = vec![Support::simple(&mesh, "boundary", true).unwrap()];
        check(&plate(mesh, section(t, 1.0), supports), false, &format!("simply supported, t = {t}"));
        let mesh = distorted(rectangle(1.0, 1.0, 40, 40).unwrap(), 0.4, 7).unwrap();
        let supports = vec![Support::clamped(mesh.set("boundary").unwrap())];
        check(&plate(mesh, section(t, 1.0), supports), false, &format!("distorted, t = {t}"));
    }
    let mesh = rectangle(1.0, 1.0, 40, 40).unwrap();
    let supports = vec![Support::clamped(mesh.set("left").unwrap())];
    check(&plate(mesh, section(1e-3, 1.0), supports), false, "held on one side");
    check(&clamped(32, 1e-3, 1.0), true, "six dofs");
}

/// R = 25, L = 50, 80 degrees, t = 0.25, E = 4.32e8, weight 90 per area, diaphragms at the ends.
fn roof(n: usize) -> Model {
    let mut mesh = rectangle(1.0, 1.0, n, n).unwrap();
    mesh.nodes.iter_mut().for_each(|p| {
        let (sin, cos) = (80.0 * (p.y - 0.5)).to_radians().sin_cos();
        *p = Point3::new(50.0 * p.x, 25.0 * sin, 25.0 * cos);
    });
    let (e, t) = (4.32e8, 0.25);
    let unit = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5);
    let section = ShellSection {
        d_m: unit * (e * t),
        d_b: unit * (e * t * t * t / 12.0),
        d_s: Matrix2::identity() * (5.0 / 12.0 * e * t),
        areal_density: 90.0,
        thickness: t,
    };
    let ends = ["left", "right"].map(|set| Support::fix(mesh.set(set).unwrap(), &[Dof::V, Dof::W]));
    let corner = Support::fix(&[0], &[Dof::U]);
    let supports = ends.into_iter().chain([corner]).collect();
    let loads = vec![Load::Gravity(-Vector3::z())];
    Model {
        mesh,
        section,
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports,
        loads,
        bodies: Vec::new(),
    }
}

#[test]
fn a_curved_shell() {
    check(&roof(32), false, "roof");
}

#[test]
fn iterations_hardly_grow_with_the_mesh() {
    let count = |n| check(&clamped(n, 1e-3, 1.0), false, &format!("{n} x {n}"));
    let (coarse, fine) = (count(32), count(96));
    // Four times the work to be hidden: 9 times the elements, a condition number 81 times as large.
    assert!(fine <= coarse + coarse / 4, "{coarse}, then {fine}");
}

#[test]
fn the_factor_limit_decides() {
    let model = clamped(40, 1e-3, 1.0);
    let path = |factor_limit| {
        let options = Options { factor_limit, ..Options::default() };
        solve(&model, &options).unwrap().systems[0].path
    };
    assert_eq!([path(1 << 10), path(1 << 30)], ["conjugate gradients", "multifrontal"]);
}

#[test]
fn an_iteration_that_is_cut_short_is_an_error_with_its_history() {
    let iteration = Settings { max_iterations: 3, ..Settings::default() };
    match solve(&clamped(40, 1e-3, 1.0), &Options { iteration, ..ITERATIVE }) {
        Err(e @ SolveError::Stalled { .. }) => {
            assert_eq!(e.code(), "N009");
            let SolveError::Stalled { iterations, ref history, .. } = e else { unreachable!() };
            assert_eq!((iterations, history.len()), (3, 4));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_missing_support_is_an_error() {
    let mut model = clamped(40, 1e-3, 1.0);
    model.supports.clear();
    let error = solve(&model, &ITERATIVE).unwrap_err();
    assert!(["N001", "N006", "N009"].contains(&error.code()), "{error}");
}

/// The factor of 64 x 64 elements with six dofs is worth two threads.
#[test]
fn threads_do_not_change_the_solution() {
    let model = clamped(64, 1e-3, 1.0);
    let [one, two] = [1, 2].map(|threads| {
        let options = Options { coupled: true, threads, ..Options::default() };
        solve(&model, &options).unwrap()
    });
    assert_eq!([one.systems[0].threads, two.systems[0].threads], [1, 2]);
    assert!(one.displacement == two.displacement && one.reaction == two.reaction, "bit by bit");
}

/// Rounding of u alone would leave a residual that grows with the fourth power of the elements a side.
#[test]
fn the_residual_of_a_fine_mesh_is_refined() {
    let solution = solve(&clamped(160, 1e-3, 1.0), &Options::default()).unwrap();
    assert!(solution.residual <= 1e-10, "{:.1e}", solution.residual);
}

#[test]
fn prescribed_displacements_are_kept() {
    let mut model = clamped(40, 1e-3, 1.0);
    let left = model.mesh.set("left").unwrap().to_vec();
    model.supports.push(Support::at(left, vec![(Dof::W, 1e-3)]));
    check(&model, false, "prescribed");
}

/// A plate clamped on the left whose right edge is a rigid bar with its point of reference beyond it,
/// flat and as a curved shell; loads on plate, bar and follower.
#[test]
fn rigid_bodies_are_moved_as_in_the_direct_solution() {
    for curved in [false, true] {
        let mut mesh = rectangle(1.0, 1.0, 24, 24).unwrap();
        let (left, right) = (mesh.set("left").unwrap().to_vec(), mesh.set("right").unwrap().to_vec());
        if curved {
            mesh.nodes.iter_mut().for_each(|p| p.z = 0.2 * p.y * (1.0 - p.y));
        }
        let reference = mesh.nodes.len() as u32;
        mesh.nodes.push(Point3::new(1.3, 0.5, 0.0));
        let mut model = plate(mesh, section(1e-2, 2.0), vec![Support::clamped(&left)]);
        model.bodies = vec![RigidBody { nodes: [&[reference], right.as_slice()].concat() }];
        let force = |node, force: [f64; 3]| Load::Point {
            nodes: vec![node],
            force: force.into(),
            moment: Vector3::new(0.1, 0.2, 0.3),
        };
        model.loads.extend([force(reference, [0.0, 0.0, 1.0]), force(right[3], [1.0, -2.0, 0.5])]);
        let iterations = check(&model, false, "a rigid bar");
        assert!(iterations <= 200, "{iterations}");
    }
}
