//! Vibrations about a state.

use std::f64::consts::{PI, TAU};

use kesf::study::Status;

use super::{DENSITY, NONLINEAR, Strip, fix, of_step, pull, solved, step};

const MODAL: &str = "[steps.analysis]\nkind = \"modal\"\nmodes = 3\n";

/// A simply supported beam under axial force: ω² = (nπ/L)² N/ρ + (nπ/L)⁴ D/ρ, exactly; the element converges to it by the square
/// of the mesh.
#[test]
fn a_tensioned_strip_sounds_like_a_string() {
    const LENGTH: f64 = 0.3;
    let errors = |cells: usize, mass: &str| -> Vec<f64> {
        let strip = Strip { membrane: 6e5, bending: 8e-6, length: LENGTH, cells };
        let case = [
            fix("left", &["u", "w"]),
            fix("right", &["w"]),
            NONLINEAR.into(),
            step("tension", &pull(5.0)),
            step("modes", &format!("{MODAL}mass = \"{mass}\"\n")),
        ];
        let result = strip.solved(&case.concat());
        assert_eq!(result.status, Status::Ok, "{:?}", result.findings);
        let modes = of_step(&result, "modes");
        assert!(modes.looks() && modes.shapes.len() == 3 && modes.load_factors.is_empty());
        (1..=3i32)
            .map(|n| {
                let k = f64::from(n) * PI / LENGTH;
                let exact = ((k * k * 5.0 + k.powi(4) * 8e-6) / DENSITY).sqrt() / TAU;
                modes.frequencies[n as usize - 1] / exact - 1.0
            })
            .collect()
    };
    for mass in ["lumped", "consistent"] {
        let (coarse, fine) = (errors(20, mass), errors(40, mass));
        println!("{mass}: {coarse:?} {fine:?}");
        for (coarse, fine) in coarse.iter().zip(&fine) {
            assert!((3.8..4.2).contains(&(coarse / fine)), "{mass}: {coarse:e} {fine:e}");
            assert!(((4.0 * fine - coarse) / 3.0).abs() < 2e-5, "{mass}: {coarse:e} {fine:e}");
        }
    }
}

/// A chain that hangs from one end: ω = ½ j √(g/L), j the zeros of the Bessel function J0 (D. Bernoulli 1733).
#[test]
fn a_hanging_strip_swings_like_a_chain() {
    const ZEROS: [f64; 3] = [2.404825557695773, 5.520078110286311, 8.653727912911013];
    let errors = |cells: usize| -> Vec<f64> {
        let strip = Strip { membrane: 6e3, bending: 1e-8, length: 0.3, cells };
        let weight = "[[loads]]\nkind = \"gravity\"\ndirection = [1, 0, 0]\n";
        let case = [
            fix("left", &["u", "w"]),
            weight.into(),
            NONLINEAR.into(),
            step("hang", ""),
            step("modes", MODAL),
        ];
        let modes = strip.solved(&case.concat());
        let found = &of_step(&modes, "modes").frequencies;
        let exact = ZEROS.map(|j| 0.5 * j * (9.80665f64 / 0.3).sqrt() / TAU);
        found.iter().zip(exact).map(|(f, exact)| f / exact - 1.0).collect()
    };
    let (coarse, fine) = (errors(40), errors(80));
    println!("{coarse:?} {fine:?}");
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert!((0.2..0.35).contains(&(fine / coarse)), "{coarse:e} {fine:e}");
        assert!(((4.0 * fine - coarse) / 3.0).abs() < 5e-4, "{coarse:e} {fine:e}");
    }
}

/// The square of the frequency of a column falls in proportion to the load, and is 0 at Euler's.
#[test]
fn a_column_loses_its_frequency_at_eulers_load() {
    const LENGTH: f64 = 0.2;
    let euler = PI * PI * 8e-6 / (LENGTH * LENGTH);
    let parts = [0.0001, 0.5, 0.9, 0.99];
    let mut case = [fix("left", &["u", "w"]), fix("right", &["w"]), NONLINEAR.into()].concat();
    for (k, part) in parts.iter().enumerate() {
        case += &step(&format!("push {k}"), &pull(-part * euler));
        case += &step(&format!("modes {k}"), MODAL);
    }
    let column = Strip { membrane: 6e5, bending: 8e-6, length: LENGTH, cells: 40 };
    let result = column.solved(&case);
    assert_eq!(result.status, Status::Ok, "{:?}", result.findings);
    let square = |k: usize| of_step(&result, &format!("modes {k}")).frequencies[0].powi(2);
    let fitted = (square(1) - square(2)) / (parts[2] - parts[1]);
    for (k, part) in parts.iter().enumerate() {
        // The mesh moves both ends of the line by the same part.
        let expected = square(0) * (1.0 - part);
        println!("{part}: {} {expected}", square(k));
        assert!((square(k) - expected).abs() < 1e-3 * square(0), "{part}: {} {expected}", square(k));
    }
    assert!((fitted / square(0) - 1.0).abs() < 2e-3);
    let exact = (PI / LENGTH).powi(4) * 8e-6 / DENSITY / (TAU * TAU);
    assert!((square(0) / exact - 1.0).abs() < 2e-3, "{} {exact}", square(0));
}

/// Rows, checks and shapes of a step have its name; the sheet is where the step before has left it.
#[test]
fn a_modal_step_leaves_the_sheet_as_it_is() {
    let strip = Strip { membrane: 600.0, bending: 8e-6, length: 0.2, cells: 10 };
    let rest = |more: &str| {
        let weight = "[[loads]]\nkind = \"gravity\"\n";
        [fix("left", &["u", "w", "theta_y"]), weight.into(), NONLINEAR.into(), more.into()].concat()
    };
    let checked = "[[checks]]\nquantity = \"modes.frequency_1\"\nexpected = \"5 Hz\"\nrelative_tolerance = 10\nreference = { kind = \"own\", source = \"t\" }\n";
    let both = [step("hang", ""), step("modes", MODAL), step("hang on", ""), checked.into()].concat();
    let (alone, looked) = (strip.solved(&rest(&step("hang", ""))), strip.solved(&rest(&both)));
    assert!((looked.probes[1].value.u[2] / alone.probes[1].value.u[2] - 1.0).abs() < 1e-7);
    assert!(looked.checks[0].passed && looked.checks[0].value == of_step(&looked, "modes").frequencies[0]);
    let then = looked.at_end_of(of_step(&looked, "modes"));
    assert!(then.modes.len() == 3 && then.reactions().is_some());
    let size =
        |shape: &Vec<f64>| shape.chunks_exact(6).flat_map(|n| &n[..3]).fold(0.0f64, |m, v| m.max(v.abs()));
    assert!(then.modes.iter().all(|shape| (size(shape) - 1.0).abs() < 1e-12));
    let unknown = format!("{}{}", step("hang", ""), checked);
    let error = strip.parsed(&rest(&unknown)).unwrap_err().to_string();
    assert!(error.contains("STEP.frequency_1"), "{error}");
    // Unloaded, it is that of a modal case: the tangent at rest is the stiffness of the element.
    let light = rest("").replace("gravity\"\n", "gravity\"\nvalue = \"1e-9 m/s²\"\n")
        + &step("hang", "")
        + &step("modes", MODAL);
    let linear = rest("").replace("[[loads]]\nkind = \"gravity\"\n", "").replace("nonlinear", "modal");
    let (light, linear) = (strip.solved(&light), solved(&strip.parsed(&linear).unwrap()));
    for (a, b) in of_step(&light, "modes").frequencies.iter().zip(&linear.frequencies) {
        assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
    }
}
