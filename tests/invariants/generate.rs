//! Cases at random: outline, mesh, cloth, supports and loads, each of a kind that the solvers are for.

use std::f64::consts::TAU;

use kesf::element::Formulation;
use kesf::mesh::{QuadMesh, annulus, disc, distorted, rectangle};
use kesf::model::{Dof, Load, Model, Support};
use kesf::section::ShellSection;
use kesf::solve::{Options, solve};
use nalgebra::{Matrix2, Matrix3, Point3, Rotation3, Unit, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A case, and what it is made of.
#[derive(Clone)]
pub struct Generated {
    pub model: Model,
    pub parts: Vec<String>,
    pub seed: u64,
}

impl Generated {
    pub fn new(seed: u64) -> Self {
        let mut rng = Pcg64::seed_from_u64(seed);
        let (mut mesh, outline) = sheet(&mut rng);
        let mut parts = vec![outline.to_string()];
        if rng.random_bool(0.3) {
            vault(&mut mesh, &mut rng);
            parts.push("curved".into());
        }
        let (supports, held) = supports(&mesh, outline, &mut rng);
        parts.push(held.into());
        let (loads, acting) = loads(&mesh, &supports, &mut rng);
        parts.extend(acting);
        let formulation = match rng.random_range(0..3) {
            0 => Formulation::fourth_order(),
            _ => Formulation::default(),
        };
        let model = Model {
            section: cloth(&mut rng),
            warp: warp(&mut rng),
            formulation,
            supports,
            loads,
            bodies: Vec::new(),
            mesh,
        };
        model.mesh.check().unwrap();
        Self { model, parts, seed }
    }

    /// A case that is its own mirror image at x = 0, and the image of each node.
    pub fn symmetric(seed: u64) -> (Model, Vec<usize>) {
        let mut rng = Pcg64::seed_from_u64(seed);
        let (width, height) = (rng.random_range(0.02..0.3), rng.random_range(0.02..0.3));
        let mut mesh = rectangle(width, height, rng.random_range(2..9), rng.random_range(2..9)).unwrap();
        mesh.nodes.iter_mut().for_each(|p| p.x -= 0.5 * width);
        let held: &[&str] = [&["left", "right"][..], &["bottom"], &["boundary"]][rng.random_range(0..3)];
        // A sheet on one simple support would turn about it.
        let (clamped, hard) = (held == ["bottom"] || rng.random_bool(0.5), rng.random_bool(0.5));
        let support = |set: &&str| match clamped {
            true => Support::clamped(mesh.set(set).unwrap()),
            false => Support::simple(&mesh, set, hard).unwrap(),
        };
        let supports = held.iter().map(support).collect();
        let loads = vec![
            Load::Pressure(rng.random_range(-1.0..1.0)),
            Load::Gravity(Vector3::new(0.0, rng.random_range(-9.81..9.81), -9.81)),
        ];
        let image = |p: &Point3<f64>| {
            let away = |q: &Point3<f64>| (q.x + p.x).hypot(q.y - p.y);
            (0..mesh.nodes.len())
                .min_by(|a, b| away(&mesh.nodes[*a]).total_cmp(&away(&mesh.nodes[*b])))
                .unwrap()
        };
        let image = mesh.nodes.iter().map(image).collect();
        let model = Model {
            section: cloth(&mut rng),
            warp: if rng.random_bool(0.5) { Vector3::x() } else { Vector3::y() },
            formulation: Formulation::default(),
            supports,
            loads,
            bodies: Vec::new(),
            mesh,
        };
        (model, image)
    }

    /// The diagonal of its box (m).
    pub fn size(&self) -> f64 {
        let [low, high] = self.model.mesh.bounds();
        (high - low).norm()
    }

    /// Other loads on the same sheet.
    pub fn other_loads(&self) -> Vec<Load> {
        let mut rng = Pcg64::seed_from_u64(self.seed + 7);
        loads(&self.model.mesh, &self.model.supports, &mut rng).0
    }

    /// The case with loads that bend it by some tenths of its size, as far as a linear answer says.
    pub fn with_moderate_loads(&self) -> Model {
        let mut rng = Pcg64::seed_from_u64(self.seed + 11);
        let mut model = self.model.clone();
        let found = solve(&model, &Options::default()).unwrap().displacement;
        let largest = found.chunks_exact(6).map(|u| u[0].hypot(u[1]).hypot(u[2])).fold(0.0, f64::max);
        let factor = rng.random_range(0.05..0.3) * self.size() / largest;
        for load in &mut model.loads {
            match load {
                Load::Pressure(p) | Load::FollowerPressure(p) => *p *= factor,
                Load::Gravity(g) => *g *= factor,
                Load::Point { force, moment, .. } | Load::Edge { force, moment, .. } => {
                    *force *= factor;
                    *moment *= factor;
                }
            }
        }
        for (_, value) in model.supports.iter_mut().flat_map(|s| &mut s.held) {
            *value *= factor;
        }
        model
    }

    pub fn turn_in_plane(&self) -> Rotation3<f64> {
        let mut rng = Pcg64::seed_from_u64(self.seed + 13);
        Rotation3::from_axis_angle(&Vector3::z_axis(), rng.random_range(0.0..TAU))
    }

    pub fn turn_in_space(&self) -> Rotation3<f64> {
        let mut rng = Pcg64::seed_from_u64(self.seed + 17);
        let axis = Unit::new_normalize(any(&mut rng, 1.0) + Vector3::new(0.1, 0.0, 0.0));
        Rotation3::from_axis_angle(&axis, rng.random_range(0.2..3.0))
    }
}

/// A vector of any direction.
fn any(rng: &mut Pcg64, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.random_range(-size..size))
}

fn sheet(rng: &mut Pcg64) -> (QuadMesh, &'static str) {
    let size = rng.random_range(0.02..0.3);
    let (mesh, outline) = match rng.random_range(0..4) {
        0 => (disc(size, 2 * rng.random_range(1..3)).unwrap(), "disc"),
        1 => {
            let inner = size * rng.random_range(0.2..0.8);
            (annulus(inner, size, rng.random_range(2..5), rng.random_range(6..13)).unwrap(), "annulus")
        }
        _ => {
            let height = size * rng.random_range(0.3..1.5);
            (rectangle(size, height, rng.random_range(2..9), rng.random_range(2..9)).unwrap(), "rectangle")
        }
    };
    let amount = if rng.random_bool(0.5) { rng.random_range(0.0..0.4) } else { 0.0 };
    (distorted(mesh, amount, rng.random()).unwrap(), outline)
}

/// Lifts the sheet into a part of a vault.
fn vault(mesh: &mut QuadMesh, rng: &mut Pcg64) {
    let [low, high] = mesh.bounds();
    let curvature = rng.random_range(0.2..1.0) / (high - low).norm();
    for p in &mut mesh.nodes {
        p.z = curvature * (p.x - 0.5 * (low.x + high.x)).powi(2);
    }
}

/// Stiffness over the range of cloth, and of paper above it.
fn cloth(rng: &mut Pcg64) -> ShellSection {
    let mut over = |low: f64, high: f64| low * (high / low).powf(rng.random_range(0.0..1.0));
    let mut orthotropic = |low: f64, high: f64, shear: f64| {
        let (a, b) = (over(low, high), over(low, high));
        let coupling = over(0.05, 0.5) * f64::sqrt(a * b);
        let c = shear * f64::sqrt(a * b) * over(0.1, 1.0);
        Matrix3::new(a, coupling, 0.0, coupling, b, 0.0, 0.0, 0.0, c)
    };
    let (d_m, d_b) = (orthotropic(5e2, 2e4, 0.1), orthotropic(1e-6, 1e-3, 0.5));
    ShellSection {
        d_m,
        d_b,
        d_s: Matrix2::from_diagonal(&[over(20.0, 500.0), over(20.0, 500.0)].into()),
        areal_density: over(0.03, 0.6),
        thickness: over(1e-4, 2e-3),
    }
}

fn warp(rng: &mut Pcg64) -> Vector3<f64> {
    let angle: f64 = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(0.0..TAU) };
    Vector3::new(angle.cos(), angle.sin(), 0.0)
}

fn supports(mesh: &QuadMesh, outline: &str, rng: &mut Pcg64) -> (Vec<Support>, &'static str) {
    let edge = match outline {
        "rectangle" => "left",
        "annulus" => "inner",
        _ => "outer",
    };
    let clamped = |set: &str| Support::clamped(mesh.set(set).unwrap());
    match rng.random_range(0..5) {
        0 => (vec![Support::simple(mesh, "boundary", false).unwrap()], "simply supported"),
        1 => (vec![clamped("boundary")], "clamped all around"),
        2 if outline == "rectangle" => {
            let value = rng.random_range(-1e-3..1e-3);
            let prescribed = Dof::ALL.iter().map(|dof| (*dof, if *dof == Dof::W { value } else { 0.0 }));
            let right = Support::at(mesh.set("right").unwrap().to_vec(), prescribed.collect());
            (vec![clamped("left"), right], "clamped at two edges, one of them moved")
        }
        _ => (vec![clamped(edge)], "clamped at one edge"),
    }
}

fn loads(mesh: &QuadMesh, supports: &[Support], rng: &mut Pcg64) -> (Vec<Load>, Vec<String>) {
    let is_free = |n: &u32| supports.iter().all(|s| !s.nodes.contains(n));
    let free: Vec<u32> = (0..mesh.nodes.len() as u32).filter(is_free).collect();
    let (mut loads, mut parts) = (Vec::new(), Vec::new());
    for n in 0..rng.random_range(1..4) {
        let (load, part) = match rng.random_range(0..4) {
            // The first acts on nodes that are free, whatever is held.
            _ if n == 0 && rng.random_bool(0.5) => (Load::Pressure(rng.random_range(0.1..2.0)), "pressure"),
            _ if n == 0 => (Load::Gravity(any(rng, 9.81) + Vector3::new(0.0, 0.0, -1.0)), "gravity"),
            0 => (Load::Pressure(rng.random_range(0.1..2.0)), "pressure"),
            1 if !free.is_empty() => {
                let node = free[rng.random_range(0..free.len())];
                (Load::Point { nodes: vec![node], force: any(rng, 1e-2), moment: any(rng, 1e-5) }, "point")
            }
            2 => {
                let edges = mesh.boundary_edges();
                (Load::Edge { edges, force: any(rng, 1e-2), moment: any(rng, 1e-4) }, "edge")
            }
            _ => (Load::Gravity(any(rng, 9.81) + Vector3::new(0.0, 0.0, -1.0)), "gravity"),
        };
        loads.push(load);
        parts.push(part.to_string());
    }
    parts.sort();
    parts.dedup();
    (loads, parts)
}
