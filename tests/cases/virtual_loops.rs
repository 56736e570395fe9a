//! Goal: a shell with friction, taken through the cycle of an instrument, gives back the loop and the
//! parameters of the laws that it is made of.
//!
//! Data: `kesf_data`: matsudaira_b (published B and 2HB, the spectrum of its friction is assumed) and
//! twill (synthetic loops).
//! References: the law at a point along the same record; the parameters of the law's own cycle, by the
//! same evaluation (`FrictionLaw::values`); the published B and 2HB.

use std::path::{Path, PathBuf};

use kesf::case::{Case, Drive, ShellTest, VirtualTest};
use kesf::characterise::{FabricSheet, FrictionLaw, Settings, characterise};
use kesf::constitutive::{Assumptions, TensileLaw, section, tension};
use kesf::element::Formulation;
use kesf::instrument::{Direction, Parameter, ReadSettings, Test, read_fabrics};
use kesf::law::{Mode, State};
use kesf::section::SheetLaw;
use kesf::solve::Options;
use kesf::study::{PreparedCase, VirtualLoop, Watch, simulate_loop};

fn sheet(name: &str) -> FabricSheet {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("kesf_data").join(name);
    let batch = read_fabrics(&[folder], &ReadSettings::default(), &|_: &Path| ());
    assert!(batch.failures.is_empty(), "{:?}", batch.failures);
    characterise(&batch.fabrics[0], &Settings::default())
}

fn with_friction() -> Assumptions {
    Assumptions { law: Mode::Friction, ..Assumptions::default() }
}

/// The loop of the shell, the warp along the specimen, and the largest distance from that of the
/// law, over its span.
fn simulated(sheet: &FabricSheet, test: Test, law: SheetLaw) -> (VirtualLoop, f64) {
    let made = section(sheet, &with_friction()).unwrap();
    let drive = match ShellTest::of(test).unwrap() {
        ShellTest::Tensile => Drive::Stretch,
        ShellTest::Shear => Drive::Shear { pretension: None },
        ShellTest::Bending => Drive::Bend { curvature: None },
    };
    let spec = VirtualTest { cells: Some([8, 2]), drive };
    let direction = Direction::Warp;
    let found = simulate_loop(
        &spec,
        Formulation::default(),
        direction,
        &made.section,
        &law,
        (&sheet.conditions(test, Some(direction)), &Settings::default()),
        &Options::default(),
    );
    let found = found.unwrap();
    let own = sheet.law(test, Some(direction)).unwrap();
    let channel = match test {
        Test::Tensile => sheet.mean_law(test, Some(direction)),
        Test::Shear => law.channels[2].clone(),
        _ => law.channels[3].clone(),
    };
    let channel = channel.unwrap();
    let of_law = FrictionLaw { channel, ..own.clone() }.simulate(&found.record);
    let apart = found.record.y.iter().zip(&of_law.y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let [low, high] = of_law.y.iter().fold([0.0f64; 2], |[l, h], y| [l.min(*y), h.max(*y)]);
    (found, apart / (high - low))
}

fn off(found: &VirtualLoop, parameter: Parameter, expected: f64) -> f64 {
    found.values[&parameter] / expected - 1.0
}

/// Published B and 2HB come back from the shell as from the law at a point: the clamps follow the
/// arc, so that every cell has the same curvature.
#[test]
fn bending_of_a_fabric_from_a_table() {
    let sheet = sheet("matsudaira_b_wool_tropical");
    let made = section(&sheet, &with_friction()).unwrap();
    let law = made.law.clone().unwrap();
    let (found, apart) = simulated(&sheet, Test::Bending, law.clone());
    assert!(apart < 1e-6, "{apart:e}");
    for parameter in [Parameter::B, Parameter::Hb] {
        let published = sheet.get(parameter, None).unwrap().mean;
        let off = off(&found, parameter, published);
        println!("{parameter}: {off:+.4} of the published value");
        assert!(off.abs() < 0.01, "{parameter}: {off}");
    }
    // Half of the friction of twist comes from each direction, in proportion to the rigidities.
    let couple =
        |i: usize| law.channels[i].as_ref().unwrap().sliders().map(|s| s.stiffness * s.slip).sum::<f64>();
    let ratio = made.section.d_b[(2, 2)] / made.section.d_b[(0, 0)];
    assert!((couple(5) / couple(3) / ratio - 1.0).abs() < 1e-12);
    assert!(made.used.iter().any(|u| u.source.contains("assumed: how friction begins")), "{:?}", made.used);
}

/// Loops of the twill, with the means of its specimens: bending to rounding; shear to the second order of its angle, by which the force along the
/// clamps is more than the couple of the yarns; tension, whose coupling is in the laws, to what the solver leaves in
/// the slack, where the sheet hardly resists.
#[test]
fn the_three_tests_of_a_fabric_with_loops() {
    let sheet = sheet("twill");
    let made = section(&sheet, &with_friction()).unwrap();
    let mut law = made.law.clone().unwrap();
    for (test, within, parameters) in [
        (Test::Bending, 1e-6, &[Parameter::B, Parameter::Hb][..]),
        (Test::Shear, 0.03, &[Parameter::G, Parameter::Hg, Parameter::Hg5]),
        (Test::Tensile, 1e-4, &[Parameter::Lt, Parameter::Wt, Parameter::Rt, Parameter::Emt]),
    ] {
        if test == Test::Tensile {
            let [x, y] = tension(&sheet);
            (law.channels[0], law.channels[1]) = (x, y);
        }
        let (found, apart) = simulated(&sheet, test, law.clone());
        println!("{test:?}: {apart:.2e} of the span, {} iterations", found.iterations);
        for &parameter in parameters {
            // The warp and the weft test measure one shear.
            let mean = |d| sheet.get(parameter, Some(d)).unwrap().mean;
            let measured = match test {
                Test::Shear => 0.5 * (mean(Direction::Warp) + mean(Direction::Weft)),
                _ => mean(Direction::Warp),
            };
            let off = off(&found, parameter, measured);
            println!("  {parameter}: {off:+.4} of the measurement");
            assert!(off.abs() < if test == Test::Bending { 1e-3 } else { 0.03 }, "{parameter}: {off}");
        }
        assert!(apart < within, "{test:?}: {apart}");
    }
}

/// A strip in a structure, pulled by the greatest force of the instrument and let go: the strain at both ends of the way is that of the law
/// at a point (reference: the law in the same steps, whose slip levels are those of their starts), and the stretch that of the test. Elastic, the
/// strip goes along the reversible part.
#[test]
fn a_strip_of_a_structure_stretches_along_the_measured_curve() {
    const FORCE: f64 = 490.3325;
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/large_rotations/stretched.toml");
    let sheet = sheet("twill");
    for law in ["friction", "elastic"] {
        let text = std::fs::read_to_string(&file).unwrap().replace("\"friction\"", &format!("\"{law}\""));
        let case = Case::parse(&file, &text).unwrap();
        let made = section(&sheet, case.assumptions().unwrap()).unwrap();
        assert_eq!(made.section.d_m[(0, 1)], 0.0);
        assert!(made.used.iter().any(|u| u.name == "tension" && u.source.starts_with("measured")));
        let prepared = PreparedCase::new(&case, &Options::default()).unwrap();
        let result = prepared.solve_watched(&made, Watch::default()).unwrap();
        let path = result.path.as_ref().unwrap();
        assert!(path.converged && path.load_steps.len() == 2, "{:?}", result.findings);
        let ends = path.load_steps.iter().map(|step| path.probes[0][step.steps.end - 1][0] / 0.05);
        let ends: Vec<f64> = ends.collect();
        let (of_law, mode) = (made.law.as_ref().unwrap(), case.law());
        let channel = of_law.channels[0].as_ref().unwrap();
        // Forces in twenty steps up and down, each strain by bisection.
        let (mut state, mut expected) = (State::default(), Vec::new());
        for i in (0..=20).chain((0..20).rev()) {
            let force = FORCE * f64::from(i) / 20.0;
            let (mut low, mut high) = (-0.5, 0.5);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if channel.respond(mode, &state, middle).stress < force {
                    low = middle
                } else {
                    high = middle
                }
            }
            state = channel.respond(mode, &state, 0.5 * (low + high)).state;
            if i == 20 || expected.len() == 1 && i == 0 {
                expected.push(state.strain);
            }
        }
        println!("{law}: {ends:?}, of the law {expected:?}");
        for (end, expected) in ends.iter().zip(&expected) {
            assert!((end - expected).abs() < 0.01 * expected.abs().max(1e-3), "{law}: {end} {expected}");
        }
        let emt = sheet.get(Parameter::Emt, Some(Direction::Warp)).unwrap().mean;
        println!("EMT {emt}");
        if law == "friction" {
            assert!((ends[0] / emt - 1.0).abs() < 0.05, "{} {emt}", ends[0]);
            assert!(ends[1] > 0.05 * ends[0], "what friction keeps: {ends:?}");
        }
    }
}

/// Curves are for sheets in large rotations, and need records of both directions.
#[test]
fn curves_of_tension_are_a_choice_that_needs_records() {
    let curve = Assumptions { tensile_law: TensileLaw::Curve, ..Assumptions::default() };
    let error = section(&sheet("matsudaira_b_wool_tropical"), &curve).unwrap_err();
    assert_eq!(error.code(), "C004");
    assert!(error.to_string().contains("law of tension"), "{error}");
    let text = "title = \"t\"\nfabric = \"*\"\n[assumptions]\ntensile_law = \"curve\"\n[sheet]\nshape = \"strip\"\nwidth = \"5 cm\"\n\
                height = \"1 cm\"\ncells = [4, 1]\n[[supports]]\nset = \"left\"\nkind = \"clamped\"\n[[loads]]\nkind = \"gravity\"\n\
                [analysis]\nkind = \"linear\"\n";
    let error = Case::parse(Path::new("t.toml"), text).unwrap_err();
    assert!(error.to_string().contains("tensile_law") && error.place().line == 4, "{error}");
}

/// Elastic cloth has no law beside its section; cloth without 2HB cannot have friction.
#[test]
fn friction_is_a_choice_that_needs_a_loop_or_its_width() {
    let mut sheet = sheet("matsudaira_b_wool_tropical");
    assert_eq!(section(&sheet, &Assumptions::default()).unwrap().law, None);
    sheet.laws.clear();
    let error = section(&sheet, &with_friction()).unwrap_err();
    assert_eq!(error.code(), "C004");
    assert!(error.to_string().contains("friction law of bending"), "{error}");
}

/// A strip of cloth B under its own weight; `law` is a line of the table of assumptions.
fn strip(law: &str, analysis: &str) -> Result<Case, String> {
    let text = format!(
        "title = \"t\"\nfabric = \"*\"\n[assumptions]\n{law}\n[sheet]\nshape = \"strip\"\nwidth = \"30 mm\"\n\
         height = \"25 mm\"\ncells = [16, 2]\n[[supports]]\nset = \"left\"\nkind = \"clamped\"\n[[loads]]\n\
         kind = \"gravity\"\n[analysis]\n{analysis}\n"
    );
    Case::parse(Path::new("strip.toml"), &text).map_err(|e| e.to_string())
}

/// From the text of a case to the result: friction holds the strip up and loses energy; first loading
/// without memory gives the same shape; small displacements have no friction.
#[test]
fn a_case_says_whether_cloth_has_friction() {
    let sheet = sheet("matsudaira_b_wool_tropical");
    let solve = |law: &str| {
        let case = strip(law, "kind = \"nonlinear\"").unwrap();
        let made = section(&sheet, case.assumptions().unwrap()).unwrap();
        let found = PreparedCase::new(&case, &Options::default()).unwrap().solve_fabric(&made).unwrap();
        let path = found.path.unwrap();
        assert!(path.converged);
        (found.w_max, path.steps.last().unwrap().dissipated)
    };
    let [elastic, friction, virgin] =
        ["law = \"elastic\"", "law = \"friction\"", "law = \"virgin\""].map(solve);
    println!("w_max: elastic {:.4} m, friction {:.4} m, virgin {:.4} m", elastic.0, friction.0, virgin.0);
    assert!(friction.0.abs() < 0.95 * elastic.0.abs(), "{friction:?} {elastic:?}");
    assert!((friction.0 - virgin.0).abs() < 1e-6 * virgin.0.abs());
    assert!(friction.1 > 0.0 && elastic.1 == 0.0 && virgin.1 == 0.0);
    let refused = strip("law = \"friction\"", "kind = \"linear\"").unwrap_err();
    assert!(refused.contains("S003") && refused.contains("friction needs large rotations"), "{refused}");
}
