//! Motions from a state.

use std::f64::consts::{PI, TAU};

use kesf::study::{CaseResult, History, Status};

use super::{BREADTH, DENSITY, NONLINEAR, Strip, fix, of_step, pull, step};

fn motion(duration: f64, time_step: f64, more: &str) -> String {
    format!(
        "[steps.analysis]\nkind = \"newmark\"\nduration = \"{duration} s\"\nstep = \"{time_step} s\"\n{more}"
    )
}

/// A dof of the ends that is moved.
fn prescribed(sets: &[&str], dof: &str, how: &str) -> String {
    let one = |set: &&str| {
        format!("[[steps.loads]]\nkind = \"prescribed\"\nset = \"{set}\"\ndof = \"{dof}\"\n{how}\n")
    };
    sets.iter().map(one).collect()
}

fn history(result: &CaseResult) -> &History {
    let history = result.history.as_ref().unwrap();
    assert_eq!(of_step(result, "move").history.as_ref().unwrap(), history);
    assert!(history.imbalance < 1e-3, "{}", history.imbalance);
    assert_eq!(result.status, Status::Ok, "{:?}", result.findings);
    history
}

/// The largest distance of a probe from a reference in a component, over a scale.
fn apart(
    history: &History,
    probe: usize,
    component: usize,
    scale: f64,
    reference: impl Fn(f64) -> f64,
) -> f64 {
    let samples = history.time.iter().zip(&history.probe_displacements[probe]);
    samples.map(|(t, u)| (u[component] - reference(*t)).abs() / scale).fold(0.0, f64::max)
}

/// A strip of one cell is an oscillator of its end, ω² = 2 E / (ρ L²), as half of the mass is there: its support goes to and fro,
/// or away evenly and stops.
#[test]
fn a_moved_support_drives_an_oscillator() {
    let (membrane, length) = (6e3, 0.1);
    let strip = Strip { membrane, bending: 8e-6, length, cells: 1 };
    let omega = (2.0 * membrane / (DENSITY * length * length)).sqrt();
    let (period, amplitude) = (TAU / omega, 1e-6);
    let run = |steps: f64, how: &str| {
        let case = [
            fix("all", &["w", "theta_y"]),
            fix("left", &["u"]),
            NONLINEAR.into(),
            // A weight along the strip, without which nothing would act before.
            step("rest", "[[steps.loads]]\nkind = \"gravity\"\nvalue = \"1e-12 m/s²\"\n"),
            step(
                "move",
                &[motion(3.0 * period, period / steps, ""), prescribed(&["left"], "u", how)].concat(),
            ),
        ];
        strip.solved(&case.concat())
    };
    let frequency = 0.3 / period;
    let drive = TAU * frequency;
    let sine = format!("value = \"{amplitude} m\"\ncourse = \"sine {frequency} Hz\"");
    let swung = |t: f64| {
        let whole = amplitude * omega / (omega * omega - drive * drive);
        whole * (omega * (drive * t).sin() - drive * (omega * t).sin())
    };
    let until = 0.8 * period;
    let ramp = format!("value = \"{amplitude} m\"\ncourse = \"ramp until {until} s\"");
    let dragged = |t: f64| {
        let from = |t: f64| if t <= 0.0 { 0.0 } else { amplitude / until * (t - (omega * t).sin() / omega) };
        from(t) - from(t - until)
    };
    for (how, reference) in [(&sine, &swung as &dyn Fn(f64) -> f64), (&ramp, &dragged)] {
        let error = |steps: f64| {
            let result = run(steps, how);
            apart(history(&result), 1, 0, amplitude, reference)
        };
        let (coarse, fine) = (error(40.0), error(80.0));
        println!("{how}: {coarse:.3e} {fine:.3e}");
        assert!(fine < 0.02 && (3.0..5.0).contains(&(coarse / fine)), "{how}: {coarse:e} {fine:e}");
    }
    // The same as a table.
    let table = format!("times = [\"0 s\", \"{until} s\"]\nvalues = [\"0 m\", \"{amplitude} m\"]");
    let (a, b) = (run(40.0, &ramp), run(40.0, &table));
    assert!(
        apart(history(&a), 1, 0, amplitude, |t| {
            let other = history(&b);
            let k = other.time.iter().position(|s| *s == t).unwrap();
            other.probe_displacements[1][k][0]
        }) < 1e-9
    );
}

/// Both supports of a taut strip move across it: y = u + Σ 4/(nπ) sin(nπx/L) q_n, with q_n the answer of an oscillator of the
/// natural frequency to the support, n odd.
#[test]
fn moved_supports_swing_a_taut_strip() {
    const LENGTH: f64 = 0.3;
    let (tension, bending, amplitude) = (5.0, 8e-6, 1e-4);
    let strip = Strip { membrane: 6e5, bending, length: LENGTH, cells: 40 };
    let natural = |n: i32| {
        let k = f64::from(n) * PI / LENGTH;
        ((k * k * tension + k.powi(4) * bending) / DENSITY).sqrt()
    };
    let (period, frequency) = (TAU / natural(1), 0.5 * natural(1) / TAU);
    let drive = TAU * frequency;
    let sine = format!("value = \"{amplitude} m\"\ncourse = \"sine {frequency} Hz\"");
    let case = [
        fix("left", &["u"]),
        NONLINEAR.into(),
        step(
            "tension",
            &format!(
                "{}[[steps.supports]]\nset = \"left\"\nfix = [\"w\"]\n[[steps.supports]]\nset = \"right\"\nfix = [\"w\"]\n",
                pull(tension)
            ),
        ),
        step(
            "move",
            &[
                motion(2.0 * period, period / 200.0, ""),
                pull(tension),
                prescribed(&["left", "right"], "w", &sine),
            ]
            .concat(),
        ),
    ];
    let result = strip.solved(&case.concat());
    let middle = |t: f64| {
        let mode = |n: i32| {
            let w = natural(n);
            let q =
                amplitude * drive / (w * w - drive * drive) * (drive * (drive * t).sin() - w * (w * t).sin());
            4.0 / (f64::from(n) * PI) * (f64::from(n) * PI / 2.0).sin() * q
        };
        amplitude * (drive * t).sin() + (1..200).step_by(2).map(mode).sum::<f64>()
    };
    let error = apart(history(&result), 0, 2, 2.0 * amplitude, middle);
    println!("{error:.3e}");
    assert!(error < 0.03, "{error}");
    // The work is that of the supports: nothing else moves.
    let last = history(&result).energy.last().unwrap();
    let first = history(&result).energy[0];
    let done = last.work - first.strain;
    assert!(done > 0.0 && (last.kinetic + last.strain - last.work).abs() < 1e-3 * done, "{last:?} {first:?}");
}

/// A hanging strip whose weight is turned by a small angle hangs straight at that angle; let go, its end swings as
/// w = Σ 8 φ L / (j³ J1(j)) cos(½ j √(g/L) t), j the zeros of J0.
#[test]
fn a_strip_that_hangs_aslant_is_let_go() {
    // Zeros of J0 and J1 there (Abramowitz and Stegun, Table 9.5).
    const ZEROS: [[f64; 2]; 5] = [
        [2.404825557695773, 0.5191474972894667],
        [5.520078110286311, -0.3402648065583682],
        [8.653727912911013, 0.2714522999283819],
        [11.791534439014281, -0.232459831364729],
        [14.930917708487787, 0.2065464330799563],
    ];
    // The later ones by McMahon's expansion, to 1e-5 and better.
    let later: Vec<[f64; 2]> = (6..60)
        .map(|k| {
            let b = (f64::from(k) - 0.25) * PI;
            let j = b + 1.0 / (8.0 * b) - 124.0 / (3.0 * (8.0 * b).powi(3));
            [j, if k % 2 == 1 { 1.0 } else { -1.0 } * (2.0 / (PI * j)).sqrt()]
        })
        .collect();
    let (length, angle) = (0.3, 1e-3);
    let period = TAU / (0.5 * ZEROS[0][0] * (9.80665f64 / length).sqrt());
    let weight = |z: f64| format!("[[steps.loads]]\nkind = \"gravity\"\ndirection = [1, 0, {z}]\n");
    let end = |t: f64| {
        let mode = |[j, j1]: &[f64; 2]| {
            8.0 * angle * length / (j.powi(3) * j1) * (0.5 * j * (9.80665f64 / length).sqrt() * t).cos()
        };
        ZEROS.iter().chain(&later).map(mode).sum::<f64>()
    };
    let error = |cells: usize, steps: f64| {
        let strip = Strip { membrane: 6e3, bending: 1e-8, length, cells };
        let case = [
            fix("left", &["u", "w"]),
            NONLINEAR.into(),
            step("aslant", &weight(angle)),
            step("move", &[motion(1.5 * period, period / steps, "load = \"step\"\n"), weight(0.0)].concat()),
        ];
        let result = strip.solved(&case.concat());
        apart(history(&result), 1, 2, angle * length, end)
    };
    let (coarse, fine) = (error(60, 150.0), error(120, 300.0));
    println!("{coarse:.3e} {fine:.3e}");
    assert!(fine < 0.03 && fine < 0.7 * coarse, "{coarse} {fine}");
}

/// An end that was held aside by a support swings when that is let go: the strip, clamped at its other end, begins where statics
/// have left it and gives back all of its energy.
#[test]
fn a_support_lets_go_at_once() {
    let (membrane, bending, length) = (6e5, 8e-6, 0.1);
    let strip = Strip { membrane, bending, length, cells: 16 };
    // Small: it is the beam that swings, as Σ of its modes; its first one has most of it.
    let lift = 1e-4;
    let first = 1.875104068711961f64.powi(2) / (length * length) * (bending / DENSITY).sqrt();
    let period = TAU / first;
    let case = [
        fix("left", &["u", "w", "theta_y"]),
        NONLINEAR.into(),
        step(
            "lift",
            &format!(
                "[[steps.loads]]\nkind = \"prescribed\"\nset = \"right\"\ndof = \"w\"\nvalue = \"{lift} m\"\n"
            ),
        ),
        step("move", &motion(2.0 * period, period / 100.0, "load = \"off\"\n")),
    ];
    let result = strip.solved(&case.concat());
    let history = history(&result);
    // 3 B b w²/(2 L³).
    let energy = 1.5 * bending * BREADTH * lift * lift / length.powi(3);
    assert!((history.energy[0].strain / energy - 1.0).abs() < 5e-3, "{} {energy}", history.energy[0].strain);
    // The first mode of a beam that is let go of a force at its end: 12 / β⁴ of it (β⁴ = 12.3624).
    let w: Vec<f64> = history.probes[1].clone();
    let crossings: Vec<f64> = history
        .time
        .windows(2)
        .zip(w.windows(2))
        .filter(|(_, w)| w[0] > 0.0 && w[1] <= 0.0)
        .map(|(t, w)| t[0] + (t[1] - t[0]) * w[0] / (w[0] - w[1]))
        .collect();
    println!("{crossings:?} of {period}, {}", w.iter().fold(0.0f64, |m, w| m.max(w.abs())) / lift);
    assert!((w[0] / lift - 1.0).abs() < 1e-9);
    let gap = crossings[crossings.len() - 1] - crossings[0];
    let turns = (gap / period).round();
    assert!(turns >= 1.0 && (gap / (turns * period) - 1.0).abs() < 0.02, "{crossings:?} {period}");
}

/// The logarithm of what is left of a swing after two periods of a hundred steps, as the damping ratio of it.
fn damping_of(result: &CaseResult, probe: usize) -> f64 {
    let w = &history(result).probes[probe];
    let lost = (w[100] / w[300]).ln() / (2.0 * TAU);
    lost / (1.0 + lost * lost).sqrt()
}

/// Damping ratios are those about the state: the first mode of a taut strip dies away by the mass alone, and what it cannot give is
/// told; that of a cantilever by its stiffness too.
#[test]
fn damping_is_that_about_the_state() {
    const LENGTH: f64 = 0.3;
    let (tension, bending) = (5.0, 8e-6);
    let strip = Strip { membrane: 6e5, bending, length: LENGTH, cells: 20 };
    let natural = |n: i32| {
        let k = f64::from(n) * PI / LENGTH;
        ((k * k * tension + k.powi(4) * bending) / DENSITY).sqrt()
    };
    let period = TAU / natural(1);
    let across = "[[steps.loads]]\nkind = \"pressure\"\nvalue = \"0.01 Pa\"\n";
    let taut = |third: f64| {
        let damped = motion(3.0 * period, period / 100.0, &format!("damping = [0.05, {third}]\n"));
        let case = [
            fix("left", &["u", "w"]),
            fix("right", &["w"]),
            NONLINEAR.into(),
            step("tension", &[pull(tension), across.into()].concat()),
            step("move", &[damped, pull(tension)].concat()),
        ];
        case.concat()
    };
    // Bending has next to nothing to damp here: that is told, with the ratios that the mass can give.
    let case = strip.parsed(&taut(0.05)).unwrap();
    let section = kesf::study::section(case.section().unwrap()).unwrap();
    let error = kesf::study::solve_case(&case, section, &kesf::solve::Options::default()).unwrap_err();
    assert!(error.code() == "S003" && error.to_string().contains("damping = [0.05000, 0.016"), "{error}");
    let found = damping_of(&strip.solved(&taut(0.05 * natural(1) / natural(3))), 0);
    println!("{found}");
    assert!((found / 0.05 - 1.0).abs() < 0.05, "{found}");

    let (length, ratio) = (0.1, 0.05);
    let strip = Strip { membrane: 6e5, bending, length, cells: 16 };
    let first = 1.875104068711961f64.powi(2) / (length * length) * (bending / DENSITY).sqrt();
    let period = TAU / first;
    let damped = motion(3.0 * period, period / 100.0, &format!("damping = [{ratio}, {ratio}]\n"));
    let case = [
        fix("left", &["u", "w", "theta_y"]),
        NONLINEAR.into(),
        step("press", "[[steps.loads]]\nkind = \"pressure\"\nvalue = \"1e-4 Pa\"\n"),
        step("move", &damped),
    ];
    let found = damping_of(&strip.solved(&case.concat()), 1);
    println!("{found}");
    assert!((found / ratio - 1.0).abs() < 0.1, "{found}");
}
