//! Goal: sheets in large rotations that touch rigid surfaces obey statics and Coulomb's law.
//!
//! ```text
//!   clamp |====.             a strip that hangs down to the ground and lies on it;
//!               '-._         a sheet on an incline; a strip that is pulled over a drum
//!   ________________'======  ground
//! ```
//! References (none of them this program's): the heavy elastica from a clamp down to where it lies flat, by shooting
//! with Runge and Kutta's method in this file; tan = μ on an incline; Euler's e^(μ θ) of a rope on a drum; weight and moment balance.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;

use kesf::analytical::elastica::heavy_elastica;
use kesf::element::Formulation;
use kesf::mesh::rectangle;
use kesf::model::{Dof, Load, Model, RigidSurface, Support, SurfaceShape};
use kesf::section::ShellSection;
use kesf::solve::Options;
use kesf::solve::nonlinear::{
    ACCEPTED, Carried, Flow, LoadStep, Method, Settings, Solution, Step, continue_from, plan, solve,
};
use kesf::study::{Case, CaseResult, Status, section as section_of, solve_case};
use nalgebra::{Matrix2, Matrix3, Point3, UnitQuaternion, Vector3};

fn section(b: f64, t: f64) -> ShellSection {
    let plane = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5);
    ShellSection {
        d_m: plane * (12.0 * b / (t * t)),
        d_b: plane * b,
        d_s: Matrix2::identity() * (5.0 * b / (t * t)),
        areal_density: 1.0,
        thickness: t,
    }
}

/// A strip along x in cylindrical bending, free but for that.
fn strip(length: f64, cells: usize, b: f64, t: f64) -> Model {
    let mesh = rectangle(length, length / cells as f64, cells, 1).unwrap();
    Model {
        supports: vec![Support::fix(mesh.set("all").unwrap(), &[Dof::V, Dof::ThetaX, Dof::ThetaZ])],
        loads: Vec::new(),
        bodies: Vec::new(),
        section: section(b, t),
        mesh,
        warp: Vector3::x(),
        formulation: Formulation::default(),
    }
}

fn surface(shape: SurfaceShape, friction: f64) -> Vec<RigidSurface> {
    vec![RigidSurface { name: "surface".into(), shape, friction }]
}

fn go_on(_: &Step<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Sum of the forces of the surfaces on the sheet (N): those along the normals, and those of friction.
fn forces(surfaces: &[RigidSurface], solution: &Solution) -> [Vector3<f64>; 2] {
    let touches = solution.state.memory.touches.chunks_exact(surfaces.len());
    let mut sums = [Vector3::zeros(); 2];
    for (touches, place) in touches.zip(&solution.state.position) {
        for (touch, surface) in touches.iter().zip(surfaces) {
            sums[0] += surface.shape.gap(place).normal * touch.pressing;
            sums[1] += touch.traction;
        }
    }
    sums
}

/// A sheet that lies on an incline, in any direction of space, with tan of the incline `slope`.
fn on_an_incline(slope: f64, friction: f64) -> Result<[Vector3<f64>; 3], String> {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.9, 0.3));
    let mut mesh = rectangle(0.1, 0.08, 5, 4).unwrap();
    mesh.nodes.iter_mut().for_each(|p| *p = turn * *p);
    let down = turn * Vector3::new(0.6 * slope, 0.8 * slope, -1.0).normalize();
    let model = Model {
        supports: Vec::new(),
        loads: vec![Load::Gravity(down * 9.80665)],
        bodies: Vec::new(),
        section: ShellSection { areal_density: 0.15, ..section(1e-5, 1e-3) },
        mesh,
        warp: turn * Vector3::x(),
        formulation: Formulation::default(),
    };
    let shape = SurfaceShape::Plane { at: Point3::origin(), normal: turn * Vector3::z() };
    let surfaces = surface(shape, friction);
    let settings = Settings { surfaces: surfaces.clone(), smallest_step: 0.1, ..Settings::default() };
    let found = solve(&model, &settings, &Options::default(), go_on).map_err(|e| e.to_string())?;
    let [normal, across] = forces(&surfaces, &found);
    Ok([normal, across, down * (9.80665 * 0.15 * 0.1 * 0.08)])
}

#[test]
fn a_sheet_on_an_incline_slips_at_the_slope_of_its_friction() {
    for slope in [0.1, 0.3, 0.7] {
        let [normal, across, weight] = on_an_incline(slope, 1.001 * slope).unwrap();
        assert!((normal + across + weight).norm() < 1e-8 * weight.norm(), "the surface carries the weight");
        assert!((across.norm() / normal.norm() - slope).abs() < 1e-8);
        let slid = on_an_incline(slope, 0.999 * slope);
        assert!(slid.is_err(), "nothing holds it: {slid:?}");
    }
}

/// State of a rod at a distance from its clamp: angle below the horizontal, curvature, x and drop.
type Rod = [f64; 4];

/// The heavy rod with B = 1 from a horizontal clamp, to a length: `B θ'' = -F cos θ` with `F = force - weight s`.
fn rod(weight: f64, [force, curvature]: [f64; 2], length: f64) -> Rod {
    let steps = 4000;
    let h = length / f64::from(steps);
    let slope = |s: f64, [angle, k, ..]: Rod| {
        let (sin, cos) = angle.sin_cos();
        [k, -(force - weight * s) * cos, cos, sin]
    };
    let plus = |a: Rod, b: Rod, t: f64| std::array::from_fn(|i| a[i] + t * b[i]);
    (0..steps).fold([0.0, curvature, 0.0, 0.0], |at, k| {
        let s = f64::from(k) * h;
        let a = slope(s, at);
        let b = slope(s + 0.5 * h, plus(at, a, 0.5 * h));
        let c = slope(s + 0.5 * h, plus(at, b, 0.5 * h));
        let d = slope(s + h, plus(at, c, h));
        std::array::from_fn(|i| at[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]))
    })
}

/// Force and curvature at the clamp, and the length to where the rod lies flat on ground that is `height` lower.
fn down_to_the_ground(weight: f64, height: f64) -> [f64; 3] {
    // Flat, and straight, at the height of the ground; the linear beam is the start.
    let mismatch = |[force, curvature, length]: [f64; 3]| {
        let [angle, k, _, drop] = rod(weight, [force, curvature], length);
        Vector3::new(angle, k * length, (drop - height) / length)
    };
    let span = (72.0 * height / weight).powf(0.25);
    let mut x = [2.0 / 3.0 * weight * span, weight * span * span / 6.0, span];
    for _ in 0..60 {
        let now = mismatch(x);
        if now.norm() < 1e-11 {
            return x;
        }
        let column = |i: usize| {
            let (mut up, mut down, h) = (x, x, 1e-6 * x[i]);
            (up[i], down[i]) = (x[i] + h, x[i] - h);
            (mismatch(up) - mismatch(down)) / (2.0 * h)
        };
        let step = Matrix3::from_columns(&[column(0), column(1), column(2)]).lu().solve(&now).unwrap();
        let part = (0.3 / (0..3).map(|i| (step[i] / x[i]).abs()).fold(0.0, f64::max)).min(1.0);
        x = std::array::from_fn(|i| x[i] - part * step[i]);
    }
    panic!("the rod does not come down")
}

#[test]
fn the_rod_of_the_reference_is_the_heavy_elastica() {
    let gamma = 50.0;
    // Without ground: the curvature at the clamp with which the end is straight.
    let (mut low, mut high) = (0.0, gamma);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if rod(gamma, [gamma, middle], 1.0)[1] > 0.0 { &mut high } else { &mut low }) = middle;
    }
    let drop = rod(gamma, [gamma, low], 1.0)[3];
    assert!((drop - heavy_elastica(gamma).unwrap().drop).abs() < 1e-8, "{drop}");
}

#[test]
fn a_strip_hangs_down_to_the_ground_and_lies_on_it() {
    let (weight, height) = (200.0, 0.3);
    let [force, curvature, length] = down_to_the_ground(weight, height);
    println!("reference: force {force:.4}, moment {curvature:.4}, lies from {length:.4} on");
    let mut offs = Vec::new();
    for cells in [40, 80] {
        let mut model = strip(1.0, cells, 1.0, 2e-3);
        model.supports.push(Support::clamped(model.mesh.set("left").unwrap()));
        model.loads = vec![Load::Gravity(Vector3::new(0.0, 0.0, -weight))];
        let shape = SurfaceShape::Plane { at: Point3::new(0.0, 0.0, -height), normal: Vector3::z() };
        let surfaces = surface(shape, 0.0);
        let settings = Settings {
            surfaces: surfaces.clone(),
            first_step: 0.1,
            largest_step: 0.1,
            ..Settings::default()
        };
        let found = solve(&model, &settings, &Options::default(), go_on).unwrap();
        assert!(found.stability.is_stable());
        let width = 1.0 / cells as f64;
        let reaction: Vec<f64> =
            (0..6).map(|d| found.reaction.iter().skip(d).step_by(6).sum::<f64>() / width).collect();
        let lifted = found.state.position.iter().map(|p| -p.z - height).fold(f64::MIN, f64::max);
        assert!(lifted <= ACCEPTED * (1.0 + width), "{lifted:e} below the ground");
        let ground = forces(&surfaces, &found)[0] / width;
        assert!((ground.z + reaction[2] - weight).abs() < 1e-6 * weight && ground.x.abs() < 1e-12);
        let lies: Vec<f64> = (found.state.memory.touches.iter().zip(&model.mesh.nodes))
            .filter(|(touch, _)| touch.pressing > 0.0)
            .map(|(_, p)| p.x)
            .collect();
        let first = lies.iter().copied().fold(1.0, f64::min);
        let off = [(reaction[2] / force - 1.0).abs(), (reaction[4].abs() / curvature - 1.0).abs()];
        println!(
            "{cells}: {reaction:.4?}, lies from {first:.4} on; {} iterations, {} steps; off by {off:?}",
            found.iterations, found.steps
        );
        assert!((first - length).abs() <= width, "{first} {length}");
        offs.push(off);
    }
    assert!(offs[0].iter().all(|off| *off < 1e-2) && offs[1].iter().all(|off| *off < 3e-3), "{offs:?}");
}

/// A strip over a drum, half a turn, pulled by one end while a weight hangs on the other.
#[test]
fn a_strip_is_pulled_over_a_drum() {
    let (radius, friction, pull) = (1.0, 0.3, 1.0);
    for (cells, b) in [(60, 1e-3), (120, 1e-3)] {
        let length = 6.0;
        let mut model = strip(length, cells, b, 5e-3);
        model.mesh.nodes.iter_mut().for_each(|p| p.x -= 0.5 * length);
        let edges = ["left", "right"].map(|set| model.mesh.set_edges(set).unwrap());
        let down = |edges: &Vec<[u32; 2]>| Load::Edge {
            edges: edges.clone(),
            force: Vector3::new(0.0, 0.0, -pull),
            moment: Vector3::zeros(),
        };
        let both = Model { loads: edges.iter().map(down).collect(), ..model.clone() };
        let one = Model { loads: edges[..1].iter().map(down).collect(), ..model.clone() };
        let shape = SurfaceShape::Cylinder { at: Point3::new(0.0, 0.0, -radius), axis: Vector3::y(), radius };
        let surfaces = surface(shape, friction);
        let settings = Settings {
            surfaces: surfaces.clone(),
            first_step: 0.02,
            largest_step: 0.05,
            ..Settings::default()
        };
        let (plan, options, method) =
            (plan(&both, &Options::default()).unwrap(), Options::default(), Method::Newton(None));
        let flow = Method::Flow(Flow { perturbation: 0.0, ..Flow::default() });
        let step = LoadStep { model: &both, prescribed: &[], settings: &settings, method: &flow };
        let (hung, carried) = continue_from(&Carried::rest(&both), &step, &plan, &options, go_on)
            .unwrap_or_else(|e| panic!("{e}"));
        let ends = model.mesh.set("right").unwrap().to_vec();
        let sunk = hung.state.position[ends[0] as usize].z;
        println!(
            "{cells}: hung in {} steps and {} iterations, ends at {sunk:.4}",
            hung.steps, hung.iterations
        );
        let prescribed = [Support::at(ends, vec![(Dof::W, sunk - 0.03)])];
        let step = LoadStep { model: &one, prescribed: &prescribed, settings: &settings, method: &method };
        let (pulled, _) =
            continue_from(&carried, &step, &plan, &options, go_on).unwrap_or_else(|e| panic!("{e}"));
        let width = length / cells as f64;
        let tension = -pulled.reaction.iter().skip(2).step_by(6).sum::<f64>() / width;
        let exact = pull * (friction * PI).exp();
        println!(
            "{cells}: pulled in {} steps and {} iterations: {tension:.5} of {exact:.5}",
            pulled.steps, pulled.iterations
        );
        let [normal, across] = forces(&surfaces, &pulled).map(|f| f / width);
        assert!((normal.z + across.z - pull - tension).abs() < 1e-6 * tension, "forces balance");
        assert!((tension / exact - 1.0).abs() < 1e-3, "{tension} {exact}");
    }
}

fn case_of(obstacle: &str, analysis: &str) -> Result<CaseResult, String> {
    let strip = include_str!("../common/strip.toml").replace("[20, 1]", "[40, 1]");
    let text = format!(
        r#"{strip}[[loads]]
kind = "gravity"
[[obstacles]]
name = "ground"
{obstacle}
[analysis]
{analysis}
"#
    );
    let case = Case::parse(Path::new("strip.toml"), &text).map_err(|e| e.to_string())?;
    let made = section_of(case.section().unwrap()).unwrap();
    solve_case(&case, made, &Options::default()).map_err(|e| e.to_string())
}

const GROUND: &str = "kind = \"plane\"\nat = [\"0 m\", \"0 m\", \"-5 cm\"]";
const NONLINEAR: &str = "kind = \"nonlinear\"";

/// The text of a case: what the ground bears is in the result, and a friction that nobody stated is told.
#[test]
fn a_case_has_obstacles() {
    let result = case_of(GROUND, NONLINEAR).unwrap();
    assert_eq!(result.status, Status::Ok, "{:?}", result.findings);
    let codes: Vec<&str> = result.findings.iter().map(|f| f.code()).collect();
    assert!(codes.contains(&"S147") && !codes.contains(&"S144") && !codes.contains(&"S146"), "{codes:?}");
    let [ground] = &result.contacts[..] else { panic!("one obstacle") };
    let weight = 0.15 * 9.80665 * 0.2 * 0.01;
    let [reaction, _] = result.reactions().unwrap();
    assert!((reaction.z + ground.force[2] - weight).abs() < 1e-6 * weight);
    assert!((reaction.x + ground.force[0]).abs() < 1e-6 * weight);
    assert!((ground.normal_force - ground.force[2]).abs() < 1e-12);
    assert!(ground.nodes > 20 && ground.slipping <= ground.nodes && ground.friction == 0.2);
    let sum: f64 = ground.forces.iter().map(|f| f[2]).sum();
    assert!((sum - ground.force[2]).abs() < 1e-12);
    assert!(ground.force[0].hypot(ground.force[1]) <= 0.2 * ground.normal_force);
    // The same by the flow of the energy, but for what friction makes of the way.
    let smooth = format!("{GROUND}\nfriction = 0");
    let [newton, flow] = [NONLINEAR, "kind = \"nonlinear\"\nmethod = \"flow\""].map(|analysis| {
        let result = case_of(&smooth, analysis).unwrap();
        assert_eq!(result.status, Status::Ok, "{:?}", result.findings);
        [result.contacts[0].force[2], result.reactions().unwrap()[1].y]
    });
    println!("newton {newton:?}, flow {flow:?}");
    assert!(newton.iter().zip(flow).all(|(a, b)| (a - b).abs() < 1e-3 * a.abs()));
}

/// A bar of 4 cm below a strip: short steps come to rest on it, one step goes through it, and that is told.
#[test]
fn a_bar_that_a_sheet_went_through_is_told() {
    let bar = "kind = \"cylinder\"\nat = [\"8 cm\", \"0 cm\", \"-3 cm\"]\naxis = [0.0, 1.0, 0.0]\ndiameter = \"4 cm\"";
    for (steps, passes) in [("", false), ("\nlargest_step = 1.0", true)] {
        let result = case_of(bar, &format!("{NONLINEAR}{steps}")).unwrap();
        let told = result.findings.iter().any(|finding| finding.code() == "S155");
        assert_eq!((told, result.contacts[0].nodes == 0), (passes, passes), "{:?}", result.findings);
    }
}

#[test]
fn obstacles_that_make_no_sense_are_refused() {
    for (obstacle, analysis, says) in [
        (GROUND, "kind = \"linear\"", "large rotations"),
        (GROUND, "kind = \"nonlinear\"\nmethod = \"arc_length\"", "newton"),
        ("kind = \"plane\"\nat = [\"0 m\", \"0 m\"]\nnormal = [0, 0, 0]", NONLINEAR, "no direction"),
        ("kind = \"plane\"\nat = [\"0 m\", \"0 m\"]\nfriction = -1", NONLINEAR, "0 to 2"),
        (
            "kind = \"cylinder\"\nat = [\"0 m\", \"0 m\"]\naxis = [0, 1, 0]\ndiameter = \"0 m\"",
            NONLINEAR,
            "diameter",
        ),
        (
            "kind = \"disc\"\nat = [\"0 m\", \"0 m\"]\ndiameter = \"1 cm\"\nedge_radius = \"1 cm\"",
            NONLINEAR,
            "edge_radius",
        ),
        ("kind = \"ball\"\nat = [\"0 m\", \"0 m\"]", NONLINEAR, "plane"),
    ] {
        let error = case_of(obstacle, analysis).err().unwrap_or_default();
        assert!(error.contains(says) && error.contains("strip.toml"), "{obstacle}: {error}");
    }
}
