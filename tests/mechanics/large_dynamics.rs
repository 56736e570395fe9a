//! Goal: strips that swing through large angles keep the laws of the books.
//!
//! ```text
//!   hinge o==========> x     released from the horizontal, g down: a rigid bar
//! ```
//! References (analytical): the compound pendulum, ω₀² = 3g/2L, quarter period K(sin 45°)/ω₀ with the complete
//! elliptic integral K = 1.85407467730137; the linear method of this program where amplitudes are small,
//! which has references of its own (`tests/mechanics/dynamics.rs`); conservation of energy.

use std::ops::ControlFlow;

use kesf::element::{Formulation, Mass};
use kesf::mesh::rectangle;
use kesf::model::{Dof, Load, Model, Support};
use kesf::section::ShellSection;
use kesf::solve::newmark::{self, LoadHistory, Rayleigh, newmark};
use kesf::solve::nonlinear::dynamics::{Dynamics, integrate};
use kesf::solve::{Options, modes};
use nalgebra::{Matrix2, Matrix3, Vector3};

const G: f64 = 9.81;
const LENGTH: f64 = 0.2;

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

/// A strip along x in the plane of x and z; its left end is held in `root`.
fn strip(cells: usize, b: f64, root: &[Dof], g: f64) -> Model {
    let mesh = rectangle(LENGTH, LENGTH / cells as f64, cells, 1).unwrap();
    Model {
        supports: vec![
            Support::fix(mesh.set("all").unwrap(), &[Dof::V, Dof::ThetaX, Dof::ThetaZ]),
            Support::fix(mesh.set("left").unwrap(), root),
        ],
        loads: vec![Load::Gravity(Vector3::new(0.0, 0.0, -g))],
        mesh,
        section: section(b),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        bodies: Vec::new(),
    }
}

fn settings(duration: f64, step: f64) -> Dynamics {
    Dynamics {
        duration,
        step,
        tolerance: None,
        spectral_radius: Some(0.9),
        damping: Rayleigh::default(),
        load: LoadHistory::Step,
        mass: Mass::Consistent,
    }
}

/// After five quarters of a period the bar hangs straight down: x of its end over its length; and the largest
/// imbalance of the energies over the largest work.
fn pendulum(steps: usize, spectral_radius: Option<f64>) -> (f64, f64) {
    let model = strip(2, 1.0, &[Dof::U, Dof::W], G);
    let end = 6 * model.mesh.set("right").unwrap()[0] as usize;
    let quarter = 1.854_074_677_301_37 / (1.5 * G / LENGTH).sqrt();
    let dynamics = Dynamics { spectral_radius, ..settings(5.0 * quarter, 5.0 * quarter / steps as f64) };
    let (mut x, mut off, mut work) = (0.0, 0.0f64, 0.0f64);
    integrate(&model, &dynamics, &Options::default(), |at| {
        x = LENGTH + at.displacement[end];
        off = off.max(at.energy.imbalance().abs());
        work = work.max(at.energy.work.abs());
        ControlFlow::Continue(())
    })
    .unwrap();
    (x / LENGTH, off / work)
}

#[test]
fn a_rigid_strip_is_a_pendulum_of_second_order() {
    // The method that conserves the energy is so close that its error is that of the mesh.
    let conserved = pendulum(200, None);
    println!("{conserved:?}");
    assert!(conserved.0.abs() < 3e-4 && conserved.1 < 1e-6, "{conserved:?}");
    for radius in [Some(0.8), Some(0.9), Some(1.0)] {
        let (coarse, medium, fine) = (pendulum(200, radius), pendulum(400, radius), pendulum(800, radius));
        println!("radius {radius:?}: {coarse:?} {medium:?} {fine:?}");
        let slope = (medium.0 / fine.0).abs().log2();
        assert!((slope - 2.0).abs() < 0.1, "radius {radius:?}: slope {slope}");
        assert!(fine.0.abs() < 1e-3, "{}", fine.0);
        assert!(fine.1 < 1e-3, "energy {}", fine.1);
    }
}

/// A cantilever of cloth under a load that bends it by a thousandth of its thickness: the linear method.
#[test]
fn small_motions_are_the_linear_ones() {
    let model = strip(10, 8e-6, &Dof::ALL, 1e-6);
    let end = 6 * model.mesh.set("right").unwrap()[0] as usize + 2;
    let first = modes(&model, 1, Mass::Consistent, &Options::default()).unwrap()[0].frequency();
    let (duration, step) = (1.5 / first, 1.0 / (200.0 * first));
    for damping in [Rayleigh::default(), Rayleigh { alpha: 0.5 * first, beta: 0.01 / first }] {
        let linear = newmark::Settings {
            duration,
            step,
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
        let dynamics = Dynamics { spectral_radius: Some(1.0), damping, ..settings(duration, step) };
        let mut imbalance = 0.0f64;
        integrate(&model, &dynamics, &Options::default(), |at| {
            turned.push(at.displacement[end]);
            imbalance = imbalance.max(at.energy.imbalance().abs() / at.energy.work.abs().max(1e-30));
            ControlFlow::Continue(())
        })
        .unwrap();
        let largest = straight.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        let off = straight.iter().zip(&turned).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest;
        println!("off {off:.2e}, imbalance {imbalance:.2e}");
        assert_eq!(straight.len(), turned.len());
        // Two methods of second order with 200 steps a period: (2π/200)²/12 = 8e-5 each, three half periods.
        assert!(off < 2e-3, "{off:e}");
    }
}

/// A heavy flexible strip, B = 8e-6 N m and 20 cm long, released from the horizontal: it whips, and loses no more
/// energy than its highest frequencies hold.
#[test]
fn a_falling_strip_keeps_its_energy_and_damping_takes_it() {
    let model = strip(16, 8e-6, &Dof::ALL, G);
    let run = |step: f64, damping: Rayleigh| {
        let dynamics = Dynamics { damping, ..settings(0.4, step) };
        let (mut off, mut work, mut dissipated, mut lowest) = (0.0f64, 0.0f64, 0.0, 0.0f64);
        integrate(&model, &dynamics, &Options::default(), |at| {
            off = off.max(at.energy.imbalance().abs());
            work = work.max(at.energy.work);
            assert!(at.energy.dissipated >= dissipated, "{} {dissipated}", at.energy.dissipated);
            dissipated = at.energy.dissipated;
            let w = at.displacement.iter().skip(2).step_by(6).copied();
            lowest = w.fold(lowest, f64::min);
            ControlFlow::Continue(())
        })
        .unwrap();
        (off / work, dissipated / work, lowest)
    };
    let free = run(2e-3, Rayleigh::default());
    println!("free {free:?}");
    assert!(free.2 < -0.9 * LENGTH && free.2 > -1.001 * LENGTH, "{free:?}");
    assert!(free.0 < 0.05 && free.1 == 0.0, "{free:?}");
    let damped = run(2e-3, Rayleigh { alpha: 10.0, beta: 1e-3 });
    println!("damped {damped:?}");
    assert!(damped.1 > 0.2 && damped.0 < 1e-3, "{damped:?}");
}

/// The step that adapts follows the constant one that is very short, from rest under loads that begin at 0 too.
#[test]
fn the_adaptive_step_follows_what_moves() {
    let model = strip(10, 8e-6, &Dof::ALL, 0.1);
    let end = 6 * model.mesh.set("right").unwrap()[0] as usize + 2;
    let first = modes(&model, 1, Mass::Consistent, &Options::default()).unwrap()[0].frequency();
    let run = |dynamics: Dynamics| {
        let mut seen = Vec::new();
        integrate(&model, &dynamics, &Options::default(), |at| {
            seen.push((at.time, at.displacement[end]));
            ControlFlow::Continue(())
        })
        .unwrap();
        seen
    };
    let damping = Rayleigh { alpha: 0.5 * first, beta: 0.01 / first };
    for (load, damping) in [
        (LoadHistory::Step, damping),
        (LoadHistory::Ramp(0.5 / first), Rayleigh::default()),
        (LoadHistory::Sine(first / 3.0), Rayleigh::default()),
    ] {
        let constant = Dynamics { load, damping, ..settings(1.5 / first, 1e-3 / first) };
        let fine = run(constant);
        let largest = fine.iter().fold(0.0f64, |m, (_, w)| m.max(w.abs()));
        for tolerance in [1e-2, 1e-3] {
            let coarse = run(Dynamics { step: 0.01 / first, tolerance: Some(tolerance), ..constant });
            let at = |t: f64| {
                let k = fine.partition_point(|(time, _)| *time < t).clamp(1, fine.len() - 1);
                let ((t0, w0), (t1, w1)) = (fine[k - 1], fine[k]);
                w0 + (w1 - w0) * (t - t0) / (t1 - t0)
            };
            let off = coarse.iter().map(|(t, w)| (w - at(*t)).abs()).fold(0.0, f64::max) / largest;
            let steps = coarse.len() - 1;
            println!("{load:?}, tolerance {tolerance:e}: {steps} steps, off {off:.1e}");
            // The errors of the steps add up, each of at most the tolerance.
            assert!(off < steps as f64 * tolerance, "{load:?}: {off:e} at {tolerance:e} in {steps} steps");
            assert!(steps < 400, "{load:?}: {steps} steps at {tolerance:e}");
        }
    }
}

/// A strip of 10 cm that whips without damping, in steps from short to far too long: its energies balance to a hundredth
/// whatever the step, or the run ends with the reason in a bounded number of steps. The generalised-α method may lose what
/// the highest frequencies hold, and gains nothing.
#[test]
fn no_motion_gains_energy_from_nowhere_or_loses_it() {
    let mut model = strip(10, 8e-6, &Dof::ALL, G);
    model.mesh.nodes.iter_mut().for_each(|p| p.coords *= 0.5);
    for (duration, step, spectral_radius) in [
        (1.0, 2e-3, None),
        (0.3, 1e-2, None),
        (1.0, 2e-3, Some(0.9)),
        (1.0, 3e-2, Some(0.9)),
        (0.3, 1e-2, Some(1.0)),
    ] {
        let dynamics = Dynamics { spectral_radius, ..settings(duration, step) };
        let (mut created, mut lost, mut largest, mut instants) = (0.0f64, 0.0f64, 0.0f64, 0);
        let end = integrate(&model, &dynamics, &Options::default(), |at| {
            largest = largest.max(at.energy.work.abs()).max(at.energy.kinetic + at.energy.strain);
            created = created.max(at.energy.imbalance() / largest.max(1e-30));
            lost = lost.max(-at.energy.imbalance() / largest.max(1e-30));
            instants += 1;
            ControlFlow::Continue(())
        });
        println!(
            "step {step}, radius {spectral_radius:?}: {instants} instants, created {created:.1e}, lost {lost:.1e}, {end:?}",
            end = end.as_ref().err()
        );
        assert!(created <= 0.01, "step {step}, radius {spectral_radius:?}: {created}");
        assert!(spectral_radius.is_some() || lost <= 0.01, "step {step}: {lost}");
        // Where the energy is conserved the motion comes to its end.
        assert!(end.is_ok() || (spectral_radius.is_some() && end.is_err_and(|e| e.code() == "N005")));
    }
}
