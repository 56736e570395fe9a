//! Newmark's method against closed forms.
//!
//! A load in the shape of one mode, f = M φ, moves the sheet in that mode alone, so every dof
//! follows the one-degree-of-freedom oscillator: u = (1 - cos ωt)/ω² φ for a step from rest, and its
//! damped counterpart (any textbook of dynamics).

use std::ops::ControlFlow;

use kesf::element::{Formulation, Mass};
use kesf::mesh::rectangle;
use kesf::model::{Load, Model, Support};
use kesf::section::ShellSection;
use kesf::solve::newmark::{LoadHistory, Rayleigh, Settings, newmark};
use kesf::solve::{Mode, Options, modes};
use nalgebra::{Matrix2, Matrix3, Vector3};

/// A clamped square of unit size, lumped mass, loaded by M φ1 as nodal forces and moments.
fn model_in_first_mode() -> (Model, Mode) {
    let (nu, t) = (0.3, 1e-2);
    let plane = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu));
    let mesh = rectangle(1.0, 1.0, 6, 6).unwrap();
    let supports = vec![Support::clamped(mesh.set("boundary").unwrap())];
    let mut model = Model {
        mesh,
        section: ShellSection {
            d_m: plane * (12.0 / (t * t)),
            d_b: plane,
            d_s: Matrix2::identity() * (3.5 / (t * t)),
            areal_density: 1.0,
            thickness: t,
        },
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports,
        loads: Vec::new(),
        bodies: Vec::new(),
    };
    let mode = modes(&model, 1, Mass::Lumped, &Options::default()).unwrap().remove(0);
    let node_mass = 1.0 / 36.0;
    for (node, q) in mode.shape.chunks_exact(6).enumerate() {
        model.loads.push(Load::Point {
            nodes: vec![node as u32],
            force: Vector3::new(0.0, 0.0, q[2]) * node_mass,
            moment: Vector3::new(q[3], q[4], 0.0) * (node_mass * t * t / 12.0),
        });
    }
    (model, mode)
}

struct Run {
    worst: f64,
    imbalance: f64,
    steps: usize,
}

fn run(model: &Model, mode: &Mode, settings: Settings, exact: impl Fn(f64) -> f64) -> Run {
    let centre = 6 * 24 + 2;
    let w = mode.angular_frequency;
    let mut out = Run { worst: 0.0, imbalance: 0.0, steps: 0 };
    newmark(model, &settings, &Options::default(), |at| {
        let expected = exact(at.time) * mode.shape[centre];
        let scale = mode.shape[centre].abs() / (w * w);
        out.worst = out.worst.max((at.displacement[centre] - expected).abs() / scale);
        out.imbalance = out.imbalance.max(at.energy.imbalance().abs() * w * w);
        out.steps += 1;
        ControlFlow::Continue(())
    })
    .unwrap();
    out
}

#[test]
fn a_step_load_follows_the_oscillator_at_second_order_and_keeps_energy() {
    let (model, mode) = model_in_first_mode();
    let w = mode.angular_frequency;
    let period = std::f64::consts::TAU / w;
    let settings = |n: f64| Settings {
        duration: 2.0 * period,
        step: period / n,
        tolerance: None,
        damping: Rayleigh::default(),
        load: LoadHistory::Step,
        mass: Mass::Lumped,
    };
    let exact = |t: f64| (1.0 - (w * t).cos()) / (w * w);
    let (coarse, fine) =
        (run(&model, &mode, settings(40.0), exact), run(&model, &mode, settings(80.0), exact));
    let slope = (coarse.worst / fine.worst).log2();
    assert!((1.9..2.1).contains(&slope), "slope {slope}");
    // Period elongation of the average acceleration method: (ω Δt)²/12 a period.
    let elongation = (std::f64::consts::TAU / 80.0f64).powi(2) / 12.0;
    assert!(fine.worst < 1.1 * 2.0 * std::f64::consts::TAU * elongation, "{}", fine.worst);
    assert!(fine.imbalance < 1e-9, "{}", fine.imbalance);
}

#[test]
fn damping_ratios_are_those_asked_for() {
    let (model, mode) = model_in_first_mode();
    let w = mode.angular_frequency;
    let (period, zeta) = (std::f64::consts::TAU / w, 0.05);
    let wd = w * (1.0f64 - zeta * zeta).sqrt();
    let exact =
        |t: f64| (1.0 - (-zeta * w * t).exp() * ((wd * t).cos() + zeta * w / wd * (wd * t).sin())) / (w * w);
    for damping in
        [Rayleigh::from_ratios([zeta, 0.1], [w, 3.0 * w]), Rayleigh::from_ratios([zeta, zeta], [w, w])]
    {
        let settings = Settings {
            duration: 3.0 * period,
            step: period / 400.0,
            tolerance: None,
            damping,
            load: LoadHistory::Step,
            mass: Mass::Lumped,
        };
        let out = run(&model, &mode, settings, exact);
        assert!(out.worst < 1e-3, "{}", out.worst);
        assert!(out.imbalance < 1e-9, "{}", out.imbalance);
    }
}

#[test]
fn the_adaptive_step_meets_its_tolerance_with_few_steps() {
    let (model, mode) = model_in_first_mode();
    let w = mode.angular_frequency;
    let period = std::f64::consts::TAU / w;
    let settings = Settings {
        duration: period,
        step: period / 4000.0,
        tolerance: Some(1e-4),
        damping: Rayleigh::default(),
        load: LoadHistory::Step,
        mass: Mass::Lumped,
    };
    let out = run(&model, &mode, settings, |t| (1.0 - (w * t).cos()) / (w * w));
    assert!(out.steps < 200, "{}", out.steps);
    assert!(out.worst < 0.02, "{}", out.worst);
}
