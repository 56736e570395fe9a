//! Goal: strips in large rotations are the rods of the books, whatever the step.
//!
//! ```text
//!   clamp |==========> x        P, w down; or a moment; or a clamp that turns and is free to follow
//! ```
//! Data: strips one element wide, square elements, B = 1 and thickness as given (N m, m), ν = 0.
//! References (analytical): elastica and heavy elastica (`kesf::analytical`), a circle, Euler's
//! column after buckling (elliptic integrals), M = D11 κ. The facets of the mesh cost O(h²): with 16
//! elements 2e-4 of the length at P L²/B = 10 in an independent implementation.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::ControlFlow;

use kesf::analytical::elastica::{heavy_elastica, tip_loaded};
use kesf::element::{Formulation, Membrane};
use kesf::mesh::{QuadMesh, rectangle};
use kesf::model::{Dof, Load, Model, RigidBody, Support};
use kesf::section::ShellSection;
use kesf::solve::Options;
use kesf::solve::nonlinear::{
    ArcLength, Flow, Method, NonlinearError, Perturbation, Settings, Solution, State, Step, descend_from,
    plan, relax, search, solve,
};
use nalgebra::{Matrix2, Matrix3, Vector3};

fn strip_section(b: f64, t: f64) -> ShellSection {
    let plane = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5);
    ShellSection {
        d_m: plane * (12.0 * b / (t * t)),
        d_b: plane * b,
        d_s: Matrix2::identity() * (5.0 * b / (t * t)),
        areal_density: 1.0,
        thickness: t,
    }
}

/// A cantilever of unit length along x, clamped at x = 0, in cylindrical bending.
fn cantilever(cells: usize, t: f64, loads: impl Fn(&QuadMesh) -> Vec<Load>) -> Model {
    let mesh = rectangle(1.0, 1.0 / cells as f64, cells, 1).unwrap();
    let held = [Dof::V, Dof::ThetaX, Dof::ThetaZ];
    Model {
        supports: vec![
            Support::fix(mesh.set("all").unwrap(), &held),
            Support::clamped(mesh.set("left").unwrap()),
        ],
        loads: loads(&mesh),
        bodies: Vec::new(),
        mesh,
        section: strip_section(1.0, t),
        warp: Vector3::x(),
        formulation: Formulation::default(),
    }
}

/// Force and moment per width on the free end.
fn end_load(force: Vector3<f64>, moment: Vector3<f64>) -> impl Fn(&QuadMesh) -> Vec<Load> {
    move |mesh| vec![Load::Edge { edges: mesh.set_edges("right").unwrap(), force, moment }]
}

fn go_on(_: &Step<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn run(model: &Model, settings: &Settings) -> Solution {
    solve(model, settings, &Options::default(), go_on).unwrap()
}

/// Displacement of the middle of the free end.
fn tip(model: &Model, solution: &Solution) -> Vector3<f64> {
    let nodes = model.mesh.set("right").unwrap();
    let displacements =
        nodes.iter().map(|n| solution.state.position[*n as usize] - model.mesh.nodes[*n as usize]);
    displacements.sum::<Vector3<f64>>() / nodes.len() as f64
}

#[test]
fn a_tip_load_in_a_single_step() {
    for (cells, t) in [(16, 2e-3), (32, 2e-3), (64, 5e-4)] {
        for alpha in [1.0, 10.0] {
            let model = cantilever(cells, t, end_load(Vector3::new(0.0, 0.0, -alpha), Vector3::zeros()));
            let solution = run(&model, &Settings::default());
            assert!(solution.steps == 1 && solution.iterations <= 10, "{} iterations", solution.iterations);
            assert!(solution.stability.is_stable());
            let (tip, exact) = (tip(&model, &solution), tip_loaded(alpha).unwrap());
            let off = (-tip.z - exact.drop).abs().max((-tip.x - exact.shortening).abs());
            assert!(off < 4e-4 * (16.0 / cells as f64).powi(2), "{cells} cells, alpha = {alpha}: {off:e}");
        }
    }
}

#[test]
fn its_own_weight_in_a_single_step() {
    for gamma in [1.0, 8.004197033, 50.0, 200.0, 1000.0] {
        let model = cantilever(32, 2e-3, |_| vec![Load::Gravity(Vector3::new(0.0, 0.0, -gamma))]);
        let solution = run(&model, &Settings::default());
        assert!(solution.steps == 1 && solution.iterations <= 20, "{} iterations", solution.iterations);
        assert!(solution.stability.is_stable());
        let drop = -tip(&model, &solution).z;
        let off = (drop - heavy_elastica(gamma).unwrap().drop).abs();
        assert!(off < 2e-4, "gamma = {gamma}: {off:e}");
    }
}

/// B θ' = 2π B / L bends the strip to a full circle: the end is back at the clamp.
#[test]
fn an_end_moment_rolls_up_a_circle_in_two_steps() {
    for cells in [8, 16] {
        let model = cantilever(cells, 2e-3, end_load(Vector3::zeros(), Vector3::new(0.0, -TAU, 0.0)));
        let solution = run(&model, &Settings { first_step: 0.5, ..Settings::default() });
        assert_eq!(solution.steps, 2);
        assert!(solution.iterations <= 30, "{} iterations", solution.iterations);
        // Every element bends alike, so the polygon closes whatever the mesh.
        assert!((tip(&model, &solution) + Vector3::x()).norm() < 1e-9);
    }
}

/// The same by turning the end through 2π, past the largest angle of a rotation vector: the
/// reaction is the moment.
#[test]
fn a_held_rotation_may_pass_half_a_turn() {
    let mut model = cantilever(16, 2e-3, |_| Vec::new());
    let nodes = model.mesh.set("right").unwrap().to_vec();
    model.supports.push(Support::at(vec![nodes[0]], vec![(Dof::ThetaY, -TAU)]));
    // Followers of a body must not be held themselves.
    let everywhere = model.supports[0].nodes.clone();
    model.supports[0].nodes = everywhere.into_iter().filter(|n| *n != nodes[1]).collect();
    let lead = 6 * nodes[0] as usize + Dof::ThetaY as usize;
    model.bodies = vec![RigidBody { nodes }];
    let solution = run(&model, &Settings { first_step: 0.5, ..Settings::default() });
    assert!((tip(&model, &solution) + Vector3::x()).norm() < 1e-9);
    let moment = solution.reaction[lead] * 16.0;
    assert!((moment + TAU).abs() < 1e-8, "{moment}");
}

/// The strip of a quarter width hangs over mesh lines that lean by 45 degrees in its middle. Four
/// membrane cells lock, by 9.5e-3 of the length; one does not: its error is that of the facets.
#[test]
fn a_strip_bends_across_oblique_mesh_lines() {
    let gamma = 50.0;
    let drop = |cells: usize, membrane: Membrane| {
        let mut model = cantilever(cells, 2e-4, |_| Vec::new());
        let mut mesh = rectangle(1.0, 0.25, cells, cells / 4).unwrap();
        mesh.nodes.iter_mut().for_each(|p| p.x += 4.0 * p.x * (1.0 - p.x) * (p.y - 0.125));
        model.supports = vec![Support::clamped(mesh.set("left").unwrap())];
        model.loads = vec![Load::Gravity(Vector3::new(0.0, 0.0, -gamma))];
        model.formulation.membrane = membrane;
        model.mesh = mesh;
        -tip(&model, &run(&model, &Settings { iterations: 60, ..Settings::default() })).z
    };
    let exact = heavy_elastica(gamma).unwrap().drop;
    assert!(exact - drop(16, Membrane::Cells) > 8e-3);
    assert!((exact - drop(16, Membrane::OneCell)).abs() < 4e-3);
    assert!((exact - drop(32, Membrane::OneCell)).abs() < 5e-4);
}

fn bending_test(cells: usize, width: f64, b: f64, curvature: f64) -> (Model, Settings, usize) {
    let mesh = rectangle(0.01, width, cells, 1).unwrap();
    let right = mesh.set("right").unwrap().to_vec();
    let turn = vec![(Dof::V, 0.0), (Dof::ThetaX, 0.0), (Dof::ThetaY, curvature * 0.01), (Dof::ThetaZ, 0.0)];
    let model = Model {
        supports: vec![Support::clamped(mesh.set("left").unwrap()), Support::at(vec![right[0]], turn)],
        loads: Vec::new(),
        bodies: vec![RigidBody { nodes: right.clone() }],
        mesh,
        section: ShellSection {
            d_m: Matrix3::new(1e4, 0.0, 0.0, 0.0, 6e3, 0.0, 0.0, 0.0, 40.0),
            d_b: Matrix3::new(b, 0.0, 0.0, 0.0, 0.5 * b, 0.0, 0.0, 0.0, 0.0),
            d_s: Matrix2::identity() * 50.0,
            areal_density: 0.15,
            thickness: 4e-4,
        },
        warp: Vector3::x(),
        formulation: Formulation::default(),
    };
    let lead = 6 * right[0] as usize + Dof::ThetaY as usize;
    let settings = Settings { first_step: 0.1, largest_step: 0.1, tolerance: 1e-10, ..Settings::default() };
    (model, settings, lead)
}

/// KES-FB2: gap 1 cm, curvature to 2.5 /cm, the clamp turns and is free to follow. B from 0.005
/// to 1 gf cm²/cm.
#[test]
fn the_bending_test_gives_the_rigidity_at_every_curvature() {
    let (curvature, unit) = (250.0, 9.80665e-5);
    for (cells, width, b) in
        [(10, 0.2, 8e-6), (20, 0.2, 8e-6), (40, 0.2, 8e-6), (20, 0.01, 0.005 * unit), (20, 0.2, 0.005 * unit)]
            .into_iter()
            .chain([(20, 0.01, unit), (20, 0.2, unit)])
    {
        let (model, settings, lead) = bending_test(cells, width, b, curvature);
        let mut steps = 0;
        solve(&model, &settings, &Options::default(), |step| {
            let ratio = step.reaction[lead] / width / (b * step.state.factor * curvature);
            assert!((ratio - 1.0).abs() < 1e-8, "{cells} cells, B = {b}: M/(D11 k) = {ratio}");
            steps += 1;
            ControlFlow::Continue(())
        })
        .unwrap();
        assert_eq!(steps, 10, "{cells} cells, width {width}, B = {b}");
    }
}

/// With a Poisson ratio of bending of 0.25 the edges relax: independent 0.99974 to 0.99979 of D11
/// on a finer mesh; half the specimen, 10 x 20 elements.
#[test]
fn the_bending_test_of_a_sheet_that_curls_across() {
    let (mut model, settings, lead) = bending_test(10, 0.2, 8e-6, 250.0);
    model.mesh = rectangle(0.01, 0.1, 10, 20).unwrap();
    let right = model.mesh.set("right").unwrap().to_vec();
    let middle = model.mesh.set("bottom").unwrap().iter().filter(|n| !right.contains(n));
    let supports = &mut model.supports;
    supports.push(Support::symmetry_y(&middle.copied().collect::<Vec<_>>()));
    supports[0] = Support::clamped(model.mesh.set("left").unwrap());
    supports[1].nodes = vec![right[0]];
    let coupling = 0.25 * (8e-6f64 * 4e-6).sqrt();
    model.section.d_b = Matrix3::new(8e-6, coupling, 0.0, coupling, 4e-6, 0.0, 0.0, 0.0, 2e-6);
    assert_eq!(lead, 6 * 10 + 4, "the lead of the clamp is the end of the first row in both meshes");
    model.bodies = vec![RigidBody { nodes: right }];
    let solution = solve(&model, &settings, &Options::default(), |step| {
        let ratio = step.reaction[lead] / 0.1 / (8e-6 * step.state.factor * 250.0);
        assert!((0.9995..0.9998).contains(&ratio), "M/(D11 k) = {ratio}");
        ControlFlow::Continue(())
    });
    assert!(solution.unwrap().iterations <= 50);
}

/// Complete elliptic integrals K and E of the modulus k, by the arithmetic-geometric mean.
fn elliptic(k: f64) -> (f64, f64) {
    let (mut a, mut g, mut c, mut sum, mut power) = (1.0, (1.0 - k * k).sqrt(), k, 0.0, 0.5);
    while f64::abs(c) > 1e-16 {
        sum += power * c * c;
        power *= 2.0;
        (a, g, c) = (0.5 * (a + g), f64::sqrt(a * g), 0.5 * (a - g));
    }
    (FRAC_PI_2 / a, FRAC_PI_2 / a * (1.0 - sum))
}

/// Euler's column, free at the loaded end: with tip angle α and k = sin α/2, P L²/B = K², the tip
/// stands at (2 E/K - 1, 2 k/K) L (Timoshenko and Gere, Theory of Elastic Stability, 2.7).
#[test]
fn a_column_buckles_and_the_straight_one_is_unstable() {
    let k = (0.5 * 80f64.to_radians()).sin();
    let (first, second) = elliptic(k);
    let model = cantilever(32, 2e-3, end_load(Vector3::new(-first * first, 0.0, 0.0), Vector3::zeros()));
    let straight = run(&model, &Settings::default());
    assert!(tip(&model, &straight).z.abs() < 1e-9);
    assert_eq!(straight.stability.negative_pivots, 1);
    assert!(straight.stability.lowest_eigenvalue < 0.0);
    let (settings, options) = (Settings::default(), Options::default());
    let flowed = [1, 2].map(|seed| {
        let flow = Flow { seed, ..Flow::default() };
        relax(&model, &settings, &flow, &options, go_on).unwrap()
    });
    let shared = plan(&model, &options).unwrap();
    let rest = State::rest(&model.mesh);
    let descended = descend_from(&model, &shared, rest, &settings, 600, &options, go_on).unwrap();
    for bent in flowed.into_iter().chain([descended]) {
        assert!(bent.stability.is_stable() && bent.residual < 1e-8);
        assert!(bent.energy - first * first / 32.0 * -tip(&model, &bent).x < straight.energy);
        let tip = tip(&model, &bent);
        // The facets shift the critical load by O(h²), and the deflection with it.
        let off = [1.0 + tip.x - (2.0 * second / first - 1.0), tip.z.abs() - 2.0 * k / first];
        assert!(off.iter().all(|off| off.abs() < 1e-3), "{off:?}");
    }
}

/// A strip between clamps that are brought together by Δ: with k of Δ/L = 2 (1 - E/K) the middle goes k L/K to the side (four
/// columns as above, end to end). Nothing but the held value drives it, and beside the tension that its membrane could bear the force
/// of the clamps is so small that rounding keeps it from the tolerance.
#[test]
fn a_strip_between_clamps_buckles_on_a_fine_mesh() {
    let k: f64 = 0.13;
    let (first, second) = elliptic(k);
    let mut model = cantilever(96, 5e-4, |_| Vec::new());
    let mut clamp = Support::clamped(model.mesh.set("right").unwrap());
    for (dof, value) in &mut clamp.held {
        if *dof == Dof::U {
            *value = -2.0 * (1.0 - second / first);
        }
    }
    model.supports.push(clamp);
    let (settings, options) = (Settings::default(), Options::default());
    let shared = plan(&model, &options).unwrap();
    for method in [Method::Stable, Method::Flow(Flow::default())] {
        let found = search(&model, &shared, &settings, &method, &options, go_on).unwrap();
        assert!(found.stability.is_stable());
        let side = found.state.position.iter().map(|p| p.z.abs()).fold(0.0, f64::max);
        println!("{method:?}: {side:.5}, exact {:.5}, residual {:.1e}", k / first, found.residual);
        assert!((side / (k / first) - 1.0).abs() < 1e-3, "{method:?}: {side}");
    }
}

/// The outer half of a strip is rigid: it stays so, turns with the inner half, and the load on it has
/// its lever. Reference: balance of moments, and the elastica of the inner half by its own root.
#[test]
fn a_rigid_half_turns_with_the_sheet() {
    let load = 3.0;
    let mut model = cantilever(16, 2e-3, end_load(Vector3::new(0.0, 0.0, -load), Vector3::zeros()));
    let outer = |n: &u32| model.mesh.nodes[*n as usize].x >= 0.5;
    let (mut nodes, inner): (Vec<u32>, Vec<u32>) = (0..model.mesh.nodes.len() as u32).partition(outer);
    let lead = nodes.iter().position(|n| model.mesh.nodes[*n as usize].x == 0.5).unwrap();
    nodes.swap(0, lead);
    model.supports[0].nodes = [&inner[..], &nodes[..1]].concat();
    let rest = model.mesh.nodes[nodes[0] as usize] - model.mesh.nodes[nodes[1] as usize];
    model.bodies = vec![RigidBody { nodes: nodes.clone() }];
    let solution = run(&model, &Settings::default());
    assert!(solution.iterations <= 10, "{} iterations", solution.iterations);
    let at = |n: u32| solution.state.position[n as usize];
    assert!(((at(nodes[0]) - at(nodes[1])).norm() - rest.norm()).abs() < 1e-13);
    let root: f64 =
        model.mesh.set("left").unwrap().iter().map(|n| solution.reaction[6 * *n as usize + 4]).sum();
    let force = load / 16.0;
    assert!((root + force * (1.0 + tip(&model, &solution).x)).abs() < 1e-8 * force);
}

#[test]
fn the_result_does_not_depend_on_the_threads() {
    let model = cantilever(16, 2e-3, end_load(Vector3::new(0.0, 0.0, -5.0), Vector3::zeros()));
    let one = run(&model, &Settings::default());
    let two = solve(&model, &Settings::default(), &Options { threads: 2, ..Options::default() }, go_on);
    assert_eq!(two.unwrap(), one);
}

#[test]
fn failures_keep_the_last_equilibrium() {
    let model = cantilever(16, 2e-3, end_load(Vector3::new(0.0, 0.0, -10.0), Vector3::zeros()));
    let settings = Settings { iterations: 4, smallest_step: 0.1, ..Settings::default() };
    match solve(&model, &settings, &Options::default(), go_on) {
        Err(e @ NonlinearError::NotConverged { .. }) => {
            assert_eq!(e.code(), "N007");
            assert!(e.to_string().contains("no convergence in 4 iterations"), "{e}");
            let NonlinearError::NotConverged { last, step, .. } = e else { unreachable!() };
            assert!(step >= 1 && last.factor < 1.0);
        }
        other => panic!("{other:?}"),
    }
    let stopped =
        solve(&model, &Settings { first_step: 0.2, ..Settings::default() }, &Options::default(), |_| {
            ControlFlow::Break(())
        });
    let stopped = stopped.unwrap();
    assert_eq!((stopped.steps, stopped.state.factor), (1, 0.2));
}

#[test]
fn bodies_that_cannot_be_are_refused() {
    let (model, settings, _) = bending_test(4, 0.2, 8e-6, 1.0);
    let refuse = |bodies: Vec<RigidBody>| {
        let model = Model { bodies, ..model.clone() };
        solve(&model, &settings, &Options::default(), go_on).unwrap_err().to_string()
    };
    let body = model.bodies[0].clone();
    assert!(refuse(vec![body.clone(), body.clone()]).starts_with("M010"));
    let reversed = RigidBody { nodes: body.nodes.iter().rev().copied().collect() };
    assert!(refuse(vec![reversed]).contains("hold node"));
}

/// A strip between two hinges, inflated: an arc of a circle with the tension N = p R, of length
/// L (1 + N/EA) over a chord L. A dead pressure would give a parabola. Bending stiffness 1e-6 of p L³.
#[test]
fn a_pressure_that_follows_blows_a_strip_to_an_arc() {
    let (pressure, stretch) = (50.0, 100.0);
    let cells = 32;
    let mut model =
        cantilever(cells, (12.0f64 * 1e-6 / stretch).sqrt(), |_| vec![Load::FollowerPressure(pressure)]);
    model.section = strip_section(1e-6, (12.0f64 * 1e-6 / stretch).sqrt());
    let ends = [model.mesh.set("left").unwrap(), model.mesh.set("right").unwrap()].concat();
    model.supports[1] = Support::fix(&ends, &[Dof::U, Dof::W]);
    // 2 R φ = 1 + p R / EA and 2 R sin φ = 1: the root φ by bisection.
    let (mut low, mut high) = (1e-3, FRAC_PI_2);
    for _ in 0..60 {
        let phi: f64 = 0.5 * (low + high);
        let r = 0.5 / phi.sin();
        if 2.0 * r * phi > 1.0 + pressure * r / stretch { high = phi } else { low = phi }
    }
    let rise = 0.5 / low.sin() * (1.0 - low.cos());
    let settings = Settings { first_step: 0.1, ..Settings::default() };
    let solution = run(&model, &settings);
    let middle = cells / 2;
    let found = solution.state.position[middle].z;
    println!("rise {found} for {rise}, {} iterations", solution.iterations);
    // Chords of an arc of 32 elements: (φ/32)² of the rise.
    assert!((found / rise - 1.0).abs() < 2e-3, "{found} for {rise}");
    assert!(solution.stability.is_stable());
    let dead = Model { loads: vec![Load::Pressure(pressure)], ..model };
    let parabola = run(&dead, &settings).state.position[middle].z;
    assert!((parabola / rise - 1.0).abs() > 0.02, "{parabola}");
}

/// Newton's method alone stays on the straight column; random loads that are taken away lead it to the bent
/// one, and the arc length ends on the factor that it was given.
#[test]
fn a_perturbation_breaks_the_symmetry_and_a_plan_is_shared() {
    let load = 1.3 * FRAC_PI_2 * FRAC_PI_2;
    let model = cantilever(16, 2e-3, end_load(Vector3::new(-load, 0.0, 0.0), Vector3::zeros()));
    let settings = Settings { first_step: 0.1, largest_step: 0.1, ..Settings::default() };
    let shared = plan(&model, &Options::default()).unwrap();
    let by =
        |method: Method| search(&model, &shared, &settings, &method, &Options::default(), go_on).unwrap();
    let straight = by(Method::Newton(None));
    assert_eq!(straight, run(&model, &settings));
    assert_eq!(straight.stability.negative_pivots, 1);
    let bent = by(Method::Newton(Some(Perturbation { size: 1e-3, seed: 1 })));
    let relaxed = by(Method::Flow(Flow::default()));
    let [a, b] = [&bent, &relaxed].map(|s| tip(&model, s).z.abs());
    assert!(bent.stability.is_stable() && bent.residual < 1e-8 && (a - b).abs() < 1e-6, "{a} {b}");
    let arc = by(Method::ArcLength(ArcLength { until: Some(0.5), ..ArcLength::default() }));
    assert_eq!(arc.state.factor, 0.5);
}

/// An end that is held at an angle and free to follow bends the strip to an arc, E = B θ² / 2 L: whole turns are
/// followed, whatever the first step and the way.
#[test]
fn a_held_end_turns_more_than_once() {
    let turn = 400f64.to_radians();
    let arc = |first: f64| Method::ArcLength(ArcLength { first, until: Some(1.0), ..ArcLength::default() });
    for method in [Method::Newton(None), arc(0.1), arc(1.0)] {
        let mut model = cantilever(40, 2e-3, |_| Vec::new());
        let end = model.mesh.set("right").unwrap().to_vec();
        model.supports.push(Support::at(end, vec![(Dof::ThetaY, -turn)]));
        let options = Options::default();
        let plan = plan(&model, &options).unwrap();
        let found = search(&model, &plan, &Settings::default(), &method, &options, go_on).unwrap();
        let (found, exact) = (found.energy, 0.5 * turn * turn / 40.0);
        assert!((found / exact - 1.0).abs() < 1e-6, "{method:?}: {found} {exact}");
    }
}
