//! Own statements (equilibrium, stability, the same always) and limits that need no other program.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use approx::assert_relative_eq;

use super::search::TOLERANCE;
use super::*;
use crate::characterise::bending_law;
use crate::law::{Backbone, Channel, Mode};

const CASE: &str = r#"
title = "t"
[section]
tensile_warp = "10000 N/m"
tensile_weft = "10000 N/m"
poisson = 0.2
shear = "40 N/m"
bending_warp = "BEND"
bending_weft = "BEND"
bending_coupling = "0 N·m"
torsion = "TWIST"
transverse_shear = "33 N/m"
areal_density = "0.15 kg/m²"
thickness = "0.4 mm"
[sheet]
shape = "annulus"
inner_diameter = "18 cm"
diameter = "30 cm"
cells = [4, 48]
[[supports]]
set = "inner"
kind = "clamped"
[[loads]]
kind = "gravity"
[analysis]
kind = "drape"
folds = [3, 5]
"#;

fn case(b: f64, from: &str, to: &str) -> Case {
    Case::parse(Path::new("drape.toml"), &text_of(b, from, to)).unwrap()
}

fn text_of(b: f64, from: &str, to: &str) -> String {
    let text = CASE.replace("BEND", &format!("{b} N·m")).replace("TWIST", &format!("{} N·m", 0.5 * b));
    assert!(text.contains(from));
    text.replace(from, to)
}

fn run(case: &Case) -> Drape {
    let section = build::section(case.section().unwrap()).unwrap();
    drape(case, &section, None, &Options::default(), Watch::default()).unwrap()
}

#[test]
fn a_cloth_hangs_in_folds_and_does_so_always() {
    let cloth = case(2e-5, "", "");
    let drape = run(&cloth);
    assert_eq!((drape.states.len(), drape.failed.len()), (2, 0));
    assert_eq!((drape.states[0].elements, drape.finest.elements), (192, 768));
    for state in drape.states.iter().chain([&drape.finest]) {
        assert!(state.residual <= TOLERANCE && state.negative_pivots == 0, "{state:?}");
        assert!(state.coefficient > 0.3 && state.coefficient < 0.95, "{state:?}");
        assert!(state.folds.count >= 2 && state.folds.amplitude > 1e-3, "{state:?}");
        assert!(state.energy < 0.0);
    }
    let [low, high] = drape.band();
    assert!(low <= drape.finest.coefficient && drape.finest.coefficient <= high);
    assert!(drape.findings.iter().any(|f| f.code() == "S113"));
    let again = run(&cloth);
    assert_eq!((again.states, again.finest), (drape.states, drape.finest));
}

/// Friction holds a sheet up, and shaking takes a part of that away; without a shake the sheet hangs as it was hung.
#[test]
fn a_shaken_sheet_hangs_between_one_without_friction_and_one_that_was_only_hung() {
    let b = 2e-5;
    let shaken = case(b, "folds = [3, 5]", "folds = [5]");
    // The case has a section, which has no friction: the law is put beside it here.
    let mut only_hung = shaken.clone();
    if let crate::case::Problem::Drape(problem) = &mut only_hung.problem {
        problem.shaking = 0.0;
    }
    let section = build::section(shaken.section().unwrap()).unwrap();
    // A residual curvature of a quarter per centimetre: 2HB = 2 B · 25 1/m.
    let bending = || Some(bending_law(b, 2.0 * b * 25.0).unwrap());
    let law = SheetLaw::new(Mode::Friction, [None, None, None, bending(), bending(), None]);
    let hang = |case: &Case, law: Option<&SheetLaw>| {
        drape(case, &section, law, &Options::default(), Watch::default()).unwrap()
    };
    let (elastic, hung, shaken) =
        (hang(&shaken, None), hang(&only_hung, Some(&law)), hang(&shaken, Some(&law)));
    assert_eq!(hung.hung, None);
    let tells = |drape: &Drape| drape.findings.iter().any(|f| f.code() == "S129");
    assert!(tells(&shaken) && !tells(&hung) && !tells(&elastic));
    let first = shaken.hung.as_ref().unwrap();
    assert_eq!(first, &hung.states[0], "the same until it is shaken");
    let [elastic_is, hung_is, shaken_is] = [&elastic, &hung, &shaken].map(|d| d.states[0].coefficient);
    println!("{elastic_is:.3} {shaken_is:.3} {hung_is:.3}");
    assert!(
        elastic_is + 0.01 < shaken_is && shaken_is + 0.01 < hung_is,
        "{elastic_is} {shaken_is} {hung_is}"
    );
    // The finer mesh remembers: without it the sheet would be held up as if it had been bent at one go.
    assert!(
        (shaken.finest.coefficient - shaken_is).abs() < (hung_is - shaken_is).min(0.03),
        "{:?}",
        shaken.meshes
    );
}

/// Over the edge of the disc the upper side is convex, so the stiffer face holds the sheet up where it is the upper one. Faces
/// that are alike change nothing.
#[test]
fn a_sheet_hangs_by_the_face_that_is_up() {
    let b = 2e-5;
    let case = case(b, "folds = [3, 5]", "folds = [5]\nrefinements = 0");
    let drape = run(&case);
    let bending =
        |below, above| Some(Channel::elastic(Backbone::new(0.0, &[-1.0, 1.0], &[below, above]).unwrap()));
    let law = |below: f64, above: f64| {
        let channels = [None, None, None, bending(below * b, above * b), bending(below * b, above * b), None];
        SheetLaw::new(Mode::Elastic, channels)
    };
    let hang = |below, above| {
        let mut drape = drape.clone();
        let laws = [law(below, above), law(above, below)];
        hang_by_face(&case, &mut drape, &laws, &Options::default(), Watch::default()).unwrap();
        assert!(drape.findings.iter().any(|f| f.code() == "S148"));
        drape.faces.unwrap()
    };
    let alike = hang(1.0, 1.0);
    assert_relative_eq!(alike.up.coefficient, drape.finest.coefficient, epsilon = 1e-4);
    assert_eq!(alike.up, alike.down);
    let Faces { up, down } = hang(0.7, 1.3);
    println!("{:.3} {:.3} {:.3}", down.coefficient, drape.finest.coefficient, up.coefficient);
    assert!(up.negative_pivots == 0 && down.negative_pivots == 0);
    assert!(down.coefficient + 0.005 < drape.finest.coefficient);
    assert!(drape.finest.coefficient + 0.005 < up.coefficient);
}

/// States that differ in the turn of the whole only are one, which counts as often as it was found.
#[test]
fn states_are_told_once_with_the_number_of_their_searches() {
    let drape = run(&case(2e-5, "folds = [3, 5]", "folds = [5, 5, 3]\nrefinements = 0"));
    assert_eq!(drape.states.iter().map(|s| s.searches).sum::<usize>(), 3);
    assert!(drape.states.len() < 3);
    let numbers = drape.fold_numbers();
    assert_eq!(numbers.values().sum::<usize>(), drape.near().iter().map(|s| s.searches).sum::<usize>());
    let [low, high] = drape.band();
    assert!((low..=high).contains(&drape.mean()));
}

/// The three specimens of the test: the more of a cloth hangs, the deeper, and the smaller its coefficient.
#[test]
fn specimens_of_24_30_and_36_cm_hang_deeper_in_turn() {
    let [small, middle, large] = ["24 cm", "30 cm", "36 cm"].map(|diameter| {
        let size = format!("\ndiameter = \"{diameter}\"\ngrading = 2");
        let drape = run(&case(2e-5, "\ndiameter = \"30 cm\"", &size));
        assert!(drape.failed.is_empty() && drape.finest.negative_pivots == 0, "{:?}", drape.finest);
        drape.finest.coefficient
    });
    println!("{small:.3} {middle:.3} {large:.3}");
    assert!(1.0 > small && small > middle && middle > large && large > 0.1);
}

/// The last refinement tells what the mesh may leave, if it changed the coefficient by more than two points.
#[test]
fn a_coarse_mesh_is_a_finding() {
    let state = |coefficient| DrapeState {
        searches: 1,
        start: 3,
        elements: 5040,
        coefficient,
        folds: Folds::default(),
        energy: -1.0,
        strain_energy: 1.0,
        residual: 1e-7,
        negative_pivots: 0,
        lowest_eigenvalue: 1.0,
        iterations: 1,
    };
    let mut case = case(1e-6, "", "");
    let first_finding = |case: &Case, coefficients: &[f64]| {
        let meshes: Vec<DrapeState> = coefficients.iter().map(|c| state(*c)).collect();
        let Problem::Drape(problem) = &case.problem else { panic!("a drape") };
        findings(case, problem, &meshes, &[], [None, None]).first().map(|f| (f.code(), f.message()))
    };
    let (code, message) = first_finding(&case, &[0.6, 0.503, 0.475]).unwrap();
    assert!(code == "S119" && message.contains("5040 elements") && message.contains("by -2.8"), "{message}");
    assert_eq!((first_finding(&case, &[0.288, 0.282]), first_finding(&case, &[0.5])), (None, None));
    assert!(case.make_quick());
    let (code, message) = first_finding(&case, &[0.288, 0.282]).unwrap();
    assert!(code == "S130" && message.contains("5040 elements") && message.contains("by -0.6"), "{message}");
}

/// A quick drape searches on the widest cells that a search can begin on, and refines once: it ends on the mesh of the
/// case, and its energy is that of the whole search there.
#[test]
fn a_quick_drape_ends_near_the_whole_one() {
    let whole = case(2e-5, "cells = [4, 48]", "cells = [12, 60]");
    let mut quick = whole.clone();
    assert!(quick.make_quick() && quick.is_quick() && !whole.is_quick());
    let (whole, quick) = (run(&whole), run(&quick));
    assert_eq!(quick.states[0].elements, 6 * 30);
    assert_eq!(quick.finest.elements, whole.states[0].elements);
    assert_relative_eq!(quick.finest.energy, whole.states[0].energy, max_relative = 1e-2);
    assert!(quick.findings.iter().any(|f| f.code() == "S130"));
}

/// With friction, and at many points of its inputs, a drape takes minutes also on wide cells.
#[test]
fn a_drape_with_friction_or_bands_is_not_made_quick() {
    let shipped = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        Case::parse(&path, &std::fs::read_to_string(&path).unwrap()).unwrap()
    };
    assert!(shipped("cases/drape.toml").make_quick());
    for name in ["cases/drape_friction.toml", "cases/cantilever.toml", "examples/uncertainty/drape.toml"] {
        assert!(!shipped(name).make_quick(), "{name}");
    }
    // Nothing is done that the case does not ask for.
    let mut small = case(2e-5, "folds = [3, 5]", "folds = [3]\nrefinements = 0");
    assert!(small.make_quick());
    assert_eq!(run(&small).meshes.len(), 1);
}

/// A ring as stiff as card stays flat: its shadow is the sheet.
#[test]
fn a_stiff_sheet_stays_flat() {
    let drape = run(&case(0.1, "folds = [3, 5]", "folds = [3]\nrefinements = 0"));
    assert_relative_eq!(drape.finest.coefficient, 1.0, epsilon = 1e-4);
    assert_eq!(drape.finest.folds.count, 0);
}

/// Work that is told to stop ends at its next step, with no result; no other search begins, and no sheet is shaken.
#[test]
fn a_drape_can_be_stopped() {
    let case = case(2e-5, "folds = [3, 5]", "folds = [2, 3, 4, 5, 6, 7, 8, 9]");
    let section = build::section(case.section().unwrap()).unwrap();
    let bending = || Some(bending_law(2e-5, 2.0 * 2e-5 * 25.0).unwrap());
    let law = SheetLaw::new(Mode::Friction, [None, None, None, bending(), bending(), None]);
    for law in [None, Some(&law)] {
        let [asked, ended] = [const { AtomicUsize::new(0) }; 2];
        let stopped = || asked.fetch_add(1, Ordering::Relaxed) >= 3;
        let stage = || {
            ended.fetch_add(1, Ordering::Relaxed);
        };
        let watch = Watch { stopped: &stopped, stage: &stage };
        let error = drape(&case, &section, law, &Options::default(), watch).unwrap_err();
        assert!(matches!(error, StudyError::Stopped));
        // The three that were asked before it was to stop may all have been before a search.
        assert!(ended.into_inner() <= 3);
        assert!(asked.into_inner() < 20);
    }
}

#[test]
fn what_is_no_drape_is_refused() {
    let refused = |from, to| {
        let text = text_of(1e-5, from, to);
        let solved = Case::parse(Path::new("drape.toml"), &text).map_err(StudyError::from).and_then(|case| {
            let section = build::section(case.section().unwrap()).unwrap();
            drape(&case, &section, None, &Options::default(), Watch::default())
        });
        solved.unwrap_err().to_string()
    };
    assert!(refused("folds = [3, 5]", "folds = []").contains("S003"));
    assert!(
        refused("shape = \"annulus\"\ninner_diameter = \"18 cm\"", "shape = \"disc\"").contains("annulus")
    );
    assert!(refused("kind = \"drape\"\nfolds = [3, 5]", "kind = \"linear\"").contains("drape"));
}
