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
use kesf::solve::newmark::{Beginning, LoadHistory, Rayleigh, Scheme, Settings, newmark};
use kesf::solve::{Options, VibrationMode, modes};
use nalgebra::{Matrix2, Matrix3, Vector3};

/// Isotropic, D = ρ = 1, ν = 0.3, of thickness t.
fn section(t: f64) -> ShellSection {
    let nu = 0.3;
    let plane = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu));
    ShellSection {
        d_m: plane * (12.0 / (t * t)),
        d_b: plane,
        d_s: Matrix2::identity() * (3.5 / (t * t)),
        areal_density: 1.0,
        thickness: t,
    }
}

/// A clamped square of unit size, lumped mass, loaded by M φ1 as nodal forces and moments.
fn model_in_first_mode() -> (Model, VibrationMode) {
    let t = 1e-2;
    let mesh = rectangle(1.0, 1.0, 6, 6).unwrap();
    let supports = vec![Support::clamped(mesh.set("boundary").unwrap())];
    let mut model = Model {
        mesh,
        section: section(t),
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

fn run(model: &Model, mode: &VibrationMode, settings: Settings, exact: impl Fn(f64) -> f64) -> Run {
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
        scheme: Scheme::default(),
        beginning: Beginning::default(),
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
            scheme: Scheme::default(),
            beginning: Beginning::default(),
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
        scheme: Scheme::default(),
        beginning: Beginning::default(),
    };
    let out = run(&model, &mode, settings, |t| (1.0 - (w * t).cos()) / (w * w));
    assert!(out.steps < 200, "{}", out.steps);
    assert!(out.worst < 0.02, "{}", out.worst);
}

/// A simply supported square of the first period 0.318 s under pressure, D = ρ = L = 1, t = 1 mm.
fn pressed() -> Model {
    let mesh = rectangle(1.0, 1.0, 8, 8).unwrap();
    Model {
        section: section(1e-3),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports: vec![Support::simple(&mesh, "boundary", true).unwrap()],
        loads: vec![Load::Pressure(1e-6)],
        bodies: Vec::new(),
        mesh,
    }
}

/// Times and one displacement at them.
fn motion(model: &Model, settings: &Settings, dof: usize) -> Vec<(f64, f64)> {
    let mut seen = Vec::new();
    newmark(model, settings, &Options::default(), |at| {
        seen.push((at.time, at.displacement[dof]));
        ControlFlow::Continue(())
    })
    .unwrap();
    seen
}

/// Largest difference from a fine motion at the instants of a coarse one, over the largest displacement.
fn off(coarse: &[(f64, f64)], fine: &[(f64, f64)]) -> f64 {
    let largest = fine.iter().fold(0.0f64, |m, (_, w)| m.max(w.abs()));
    let at = |t: f64| {
        let k = fine.partition_point(|(time, _)| *time < t).clamp(1, fine.len() - 1);
        let ((t0, w0), (t1, w1)) = (fine[k - 1], fine[k]);
        w0 + (w1 - w0) * (t - t0) / (t1 - t0)
    };
    coarse.iter().fold(0.0f64, |m, (t, w)| m.max((w - at(*t)).abs())) / largest
}

/// From rest under any history, damped or not: the estimate must neither be blind nor be ruled by modes that
/// nobody sees.
#[test]
fn the_adaptive_step_follows_what_moves() {
    let model = pressed();
    let omega = modes(&model, 3, Mass::Lumped, &Options::default()).unwrap();
    let damping = Rayleigh::from_ratios([0.05; 2], [omega[0].angular_frequency, omega[2].angular_frequency]);
    let runs = [
        ("step", LoadHistory::Step, Rayleigh::default()),
        ("damped step", LoadHistory::Step, damping),
        ("ramp", LoadHistory::Ramp(0.1), Rayleigh::default()),
        ("sine", LoadHistory::Sine(1.0), Rayleigh::default()),
        ("damped sine", LoadHistory::Sine(5.0), damping),
    ];
    for (name, load, damping) in runs {
        let settings = Settings {
            duration: 0.5,
            step: 5e-5,
            tolerance: None,
            damping,
            load,
            mass: Mass::Lumped,
            scheme: Scheme::default(),
            beginning: Beginning::default(),
        };
        let fine = motion(&model, &settings, 6 * 40 + 2);
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let adaptive = Settings { step: 0.01, tolerance: Some(tolerance), ..settings };
            let coarse = motion(&model, &adaptive, 6 * 40 + 2);
            let (off, steps) = (off(&coarse, &fine), coarse.len() - 1);
            println!("{name}, tolerance {tolerance:e}: {steps} steps, off {off:.1e}");
            // The errors of the steps add up: of third order each, they are of second order at the end, and the
            // step goes with the cube root of the tolerance.
            assert!(off < 3.0 * tolerance.powf(2.0 / 3.0), "{name}: {off:e} at {tolerance:e}");
            assert!(steps < 200, "{name}: {steps} steps at {tolerance:e}");
        }
    }
}

/// A sheet that nothing holds has no static displacement: under a load that stays it falls as the parabola of the
/// books, which the method has exactly, and under a sine it is carried away with the mean velocity F/mω.
#[test]
fn the_adaptive_step_of_a_free_sheet() {
    let mut model = pressed();
    model.supports.clear();
    let settings = |load| Settings {
        duration: 1.0,
        step: 1e-3,
        tolerance: Some(1e-3),
        damping: Rayleigh::default(),
        load,
        mass: Mass::Lumped,
        scheme: Scheme::default(),
        beginning: Beginning::default(),
    };
    let free = motion(&model, &settings(LoadHistory::Step), 6 * 40 + 2);
    let (t, w) = free[free.len() - 1];
    assert!((w / (0.5e-6 * t * t) - 1.0).abs() < 1e-6 && free.len() < 20, "{w:e} after {} steps", free.len());
    let carried = motion(&model, &settings(LoadHistory::Sine(5.0)), 6 * 40 + 2);
    let omega = 10.0 * std::f64::consts::PI;
    let exact = |t: f64| 1e-6 / omega * (t - (omega * t).sin() / omega);
    let worst = carried.iter().map(|(t, w)| (w - exact(*t)).abs()).fold(0.0, f64::max) / exact(1.0);
    println!("{} steps, off {worst:.1e}", carried.len());
    assert!(worst < 0.01 && carried.len() < 400, "{worst:e} after {} steps", carried.len());
}

/// Parameters and beginnings of a motion that have no meaning are refused where they stand.
#[test]
fn beta_gamma_and_the_beginning_are_refused_where_they_have_no_meaning() {
    let text = std::fs::read_to_string(
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/paper/paper_newmark_released.toml"),
    )
    .unwrap();
    let parse = |keys: &str| {
        let text = text.replace("beta = 0.25\ngamma = 0.5\nstart = \"deflected\"\n", keys);
        kesf::study::Case::parse("motion.toml".as_ref(), &text).map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(parse("start = \"deflected\"\n"), Ok(()));
    assert_eq!(parse("gamma = 0.6\nstart_velocity = \"1 mm/s\"\n"), Ok(()));
    for (keys, word) in [
        ("beta = 0.16666666666666666\nstart = \"deflected\"\n", "beta"),
        ("gamma = 0.4\nstart = \"deflected\"\n", "gamma"),
        ("gamma = 0.6\ntolerance = 1e-3\nstart = \"deflected\"\n", "tolerance"),
        ("", "off"),
        ("large_rotations = true\nstart = \"deflected\"\n", "start"),
    ] {
        let refused = parse(keys).unwrap_err();
        assert!(refused.contains("S003") && refused.contains(word), "{keys}: {refused}");
    }
}
