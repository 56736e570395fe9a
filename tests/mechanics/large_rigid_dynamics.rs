//! Goal: rigid bodies move in time as mechanics has it, alone and on a sheet that bends.
//!
//! References: the compound pendulum, ω₀² = 3g/2L, quarter period K(sin 45°)/ω₀ (analytical); Euler's
//! equations of a lamina on a ball joint by a Runge-Kutta method of its own; the linear method of this program,
//! which has references of its own (`tests/mechanics/rigid.rs`), where amplitudes are small; conservation of energy.

use std::ops::ControlFlow;

use kesf::element::{Formulation, Mass};
use kesf::mesh::{QuadMesh, rectangle};
use kesf::model::{Dof, Load, Model, RigidBody, Support};
use kesf::section::ShellSection;
use kesf::solve::newmark::{self, LoadHistory, Rayleigh, newmark};
use kesf::solve::nonlinear::dynamics::{Dynamics, integrate};
use kesf::solve::{Options, modes};
use nalgebra::{Matrix2, Matrix3, Point3, Vector3};

const G: f64 = 9.81;

fn section(b: f64) -> ShellSection {
    let t = 4e-4;
    let plane = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.5));
    ShellSection {
        d_m: plane * (12.0 * b / (t * t)),
        d_b: plane * b,
        d_s: Matrix2::identity() * (5.0 * b / (t * t)),
        areal_density: 0.15,
        thickness: t,
    }
}

/// A model under its weight in which the nodes at and beyond x follow the node `lead`, or a new one at the origin.
fn with_body(mut mesh: QuadMesh, x: f64, b: f64, g: f64, supports: Vec<Support>) -> (Model, u32) {
    let rigid: Vec<u32> =
        (0..mesh.nodes.len() as u32).filter(|n| mesh.nodes[*n as usize].x > x - 1e-9).collect();
    let lead = mesh.nodes.len() as u32;
    mesh.nodes.push(Point3::new(x.max(0.0), 0.0, 0.0));
    let model = Model {
        mesh,
        section: section(b),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports,
        loads: vec![Load::Gravity(Vector3::new(0.0, 0.0, -g))],
        bodies: vec![RigidBody { nodes: [&[lead], &rigid[..]].concat() }],
    };
    (model, lead)
}

fn settings(duration: f64, steps: usize) -> Dynamics {
    Dynamics {
        duration,
        step: duration / steps as f64,
        tolerance: None,
        spectral_radius: Some(0.9),
        damping: Rayleigh::default(),
        load: LoadHistory::Step,
        mass: Mass::Consistent,
    }
}

/// Where a node is in the end, the largest imbalance of the energies over the largest work, and the count of instants.
fn run(model: &Model, node: usize, dynamics: &Dynamics) -> (Point3<f64>, f64, usize) {
    let (mut place, mut off, mut work, mut instants) = (Point3::origin(), 0.0f64, 0.0f64, 0);
    integrate(model, dynamics, &Options::default(), |at| {
        let displacement = Vector3::from_column_slice(&at.displacement[6 * node..][..3]);
        place = model.mesh.nodes[node] + displacement;
        off = off.max(at.energy.imbalance().abs());
        work = work.max(at.energy.work.abs());
        instants += 1;
        ControlFlow::Continue(())
    })
    .unwrap();
    (place, off / work, instants)
}

#[test]
fn a_rigid_plate_on_a_hinge_is_a_compound_pendulum() {
    let length = 0.2;
    let mesh = rectangle(length, 0.1, 2, 1).unwrap();
    let end = mesh.set("right").unwrap()[0] as usize;
    let (mut model, lead) = with_body(mesh, 0.0, 8e-6, G, Vec::new());
    model.supports.push(Support::fix(&[lead], &[Dof::U, Dof::V, Dof::W, Dof::ThetaX, Dof::ThetaZ]));
    let duration = 5.0 * 1.854_074_677_301_37 / (1.5 * G / length).sqrt();
    let errors = |steps| {
        let (place, off, instants) = run(&model, end, &settings(duration, steps));
        assert_eq!(instants, steps + 1, "no step was cut");
        (place.x / length, off)
    };
    let (medium, fine) = (errors(200), errors(400));
    println!("{medium:?} {fine:?}");
    let slope = (medium.0 / fine.0).abs().log2();
    assert!((slope - 2.0).abs() < 0.1, "slope {slope}");
    assert!(fine.0.abs() < 1e-3 && fine.1 < 1e-3, "{fine:?}");
}

/// The far corner of a lamina a x b that hangs on a ball joint in its corner, released from the horizontal: Euler's
/// equations `J ω̇ = c × m g - ω × J ω`, `Ṙ = ω × R`, by the classical Runge-Kutta method.
fn lamina(a: f64, b: f64, duration: f64) -> Point3<f64> {
    // Per unit of mass, about the joint, in the axes of the body.
    let inertia = Matrix3::new(
        b * b / 3.0,
        -a * b / 4.0,
        0.0,
        -a * b / 4.0,
        a * a / 3.0,
        0.0,
        0.0,
        0.0,
        (a * a + b * b) / 3.0,
    );
    let rate = |(r, w): (Matrix3<f64>, Vector3<f64>)| {
        let j = r * inertia * r.transpose();
        let torque = (r * Vector3::new(0.5 * a, 0.5 * b, 0.0)).cross(&Vector3::new(0.0, 0.0, -G));
        (w.cross_matrix() * r, j.try_inverse().unwrap() * (torque - w.cross(&(j * w))))
    };
    let steps = 20_000;
    let h = duration / steps as f64;
    let (mut r, mut w) = (Matrix3::identity(), Vector3::zeros());
    for _ in 0..steps {
        let k1 = rate((r, w));
        let k2 = rate((r + k1.0 * (0.5 * h), w + k1.1 * (0.5 * h)));
        let k3 = rate((r + k2.0 * (0.5 * h), w + k2.1 * (0.5 * h)));
        let k4 = rate((r + k3.0 * h, w + k3.1 * h));
        r += (k1.0 + k2.0 * 2.0 + k3.0 * 2.0 + k4.0) * (h / 6.0);
        w += (k1.1 + k2.1 * 2.0 + k3.1 * 2.0 + k4.1) * (h / 6.0);
    }
    Point3::from(r * Vector3::new(a, b, 0.0))
}

/// Its axes of inertia turn with it and it tumbles: without the terms of `ω` the answer is another.
#[test]
fn a_plate_on_a_ball_joint_tumbles_as_euler_says() {
    let (a, b, duration) = (0.2, 0.11, 0.8);
    let mesh = rectangle(a, b, 3, 2).unwrap();
    let far = mesh.nodes.len() - 1;
    let (mut model, lead) = with_body(mesh, 0.0, 8e-6, G, Vec::new());
    model.supports.push(Support::fix(&[lead], &[Dof::U, Dof::V, Dof::W]));
    let exact = lamina(a, b, duration);
    let errors = |steps| {
        let (place, off, instants) = run(&model, far, &settings(duration, steps));
        assert_eq!(instants, steps + 1, "no step was cut");
        ((place - exact).norm() / a.hypot(b), off)
    };
    let (medium, fine) = (errors(400), errors(800));
    println!("{medium:?} {fine:?}");
    let slope = (medium.0 / fine.0).log2();
    assert!((slope - 2.0).abs() < 0.1, "slope {slope}");
    assert!(fine.0 < 5e-3 && fine.1 < 1e-3, "{fine:?}");
}

/// A strip whose outer half is a rigid plate, under a weight that bends it by a hundredth of its thickness, with
/// and without damping: the linear method, step by step.
#[test]
fn small_motions_with_a_body_are_the_linear_ones() {
    let model = hanging_plate(1e-6);
    let end = 6 * model.mesh.set("right").unwrap()[0] as usize + 2;
    let first = modes(&model, 1, Mass::Consistent, &Options::default()).unwrap()[0].frequency();
    let (duration, steps) = (1.5 / first, 300);
    for damping in [Rayleigh::default(), Rayleigh { alpha: 0.5 * first, beta: 0.01 / first }] {
        let linear = newmark::Settings {
            duration,
            step: duration / steps as f64,
            tolerance: None,
            damping,
            load: LoadHistory::Step,
            mass: Mass::Consistent,
            scheme: newmark::Scheme::default(),
            beginning: newmark::Beginning::default(),
        };
        let (mut straight, mut turned) = (Vec::new(), Vec::new());
        newmark(&model, &linear, &Options::default(), |at| {
            straight.push(at.displacement[end]);
            ControlFlow::Continue(())
        })
        .unwrap();
        let dynamics = Dynamics { spectral_radius: Some(1.0), damping, ..settings(duration, steps) };
        integrate(&model, &dynamics, &Options::default(), |at| {
            turned.push(at.displacement[end]);
            ControlFlow::Continue(())
        })
        .unwrap();
        let largest = straight.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        let off = straight.iter().zip(&turned).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest;
        println!("off {off:.2e}");
        assert_eq!(straight.len(), turned.len());
        // Two methods of second order with 200 steps a period: (2π/200)²/12 = 8e-5 each, three half periods.
        assert!(off < 2e-3, "{off:e}");
    }
}

/// A strip of cloth, 20 cm, clamped at x = 0, whose outer half is a rigid plate.
fn hanging_plate(g: f64) -> Model {
    let mesh = rectangle(0.2, 0.02, 10, 1).unwrap();
    let all = mesh.set("all").unwrap().to_vec();
    let clamped = Support::clamped(mesh.set("left").unwrap());
    let flexible: Vec<u32> = all.into_iter().filter(|n| mesh.nodes[*n as usize].x < 0.1 - 1e-9).collect();
    let plane = [Dof::V, Dof::ThetaX, Dof::ThetaZ];
    let (mut model, lead) = with_body(mesh, 0.1, 8e-6, g, vec![clamped, Support::fix(&flexible, &plane)]);
    model.supports.push(Support::fix(&[lead], &plane));
    model
}

/// The same released from the horizontal under its own weight: a whip with a rigid end keeps its energy.
#[test]
fn a_plate_on_a_falling_sheet_keeps_its_energy() {
    let model = hanging_plate(G);
    let end = model.mesh.set("right").unwrap()[0] as usize;
    let swing = |steps| run(&model, end, &settings(0.3, steps));
    let (coarse, fine) = (swing(300), swing(600));
    println!("{coarse:?} {fine:?}");
    assert!(fine.0.z < -0.1, "{fine:?}");
    assert!(coarse.1 < 0.05 && fine.1 < 0.02, "{coarse:?} {fine:?}");
    // The body is rigid to rounding: its two ends stay 10 cm apart.
    let lead = model.bodies[0].nodes[0] as usize;
    let (start, last) = (run(&model, lead, &settings(0.3, 300)).0, coarse.0);
    assert!(((last - start).norm() - 0.1).abs() < 1e-12, "{start} {last}");
}
