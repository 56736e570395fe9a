//! Goal: a sheet that is taken through steps keeps what the steps before have made of it.
//!
//! ```text
//!   clamp |==========> x    weight down, an end that is moved, held where it is, and let go
//! ```
//! References (analytical): an elastic sheet under dead loads has one state for its loads, whatever came before, and goes
//! back to its rest; a strip in pure bending ends with the curvature at which the law of its cells, followed by itself, has
//! no moment any more; a rod in tension is a spring.

use std::ops::ControlFlow;
use std::path::Path;

use kesf::element::Formulation;
use kesf::law::{Backbone, Channel, Family, Mode, Slider, State as LawState, Widening};
use kesf::mesh::rectangle;
use kesf::model::{Dof, Load, Model, RigidBody, Support};
use kesf::section::{SheetLaw, ShellSection};
use kesf::solve::Options;
use kesf::solve::nonlinear::{
    ArcLength, Carried, Flow, LoadStep, Method, Settings, Solution, continue_from, plan, solve,
};
use kesf::study::{Case, CaseError, CaseResult, Status, section, solve_case};
use nalgebra::{Matrix2, Matrix3, Vector3};

const LENGTH: f64 = 0.2;

fn cloth() -> ShellSection {
    ShellSection {
        d_m: Matrix3::from_diagonal(&Vector3::new(600.0, 600.0, 300.0)),
        d_b: Matrix3::from_diagonal(&Vector3::new(1e-5, 6e-6, 3e-6)),
        d_s: Matrix2::identity() * 50.0,
        areal_density: 0.15,
        thickness: 4e-4,
    }
}

/// A strip along x in the plane of x and z, clamped on the left.
fn strip(loads: Vec<Load>) -> Model {
    let mesh = rectangle(LENGTH, 0.01, 20, 1).unwrap();
    Model {
        supports: vec![
            Support::fix(mesh.set("all").unwrap(), &[Dof::V, Dof::ThetaX, Dof::ThetaZ]),
            Support::clamped(mesh.set("left").unwrap()),
        ],
        loads,
        mesh,
        section: cloth(),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        bodies: Vec::new(),
    }
}

fn weight() -> Load {
    Load::Gravity(Vector3::new(0.0, 0.0, -9.81))
}

/// 1 mN at the end of the strip, along x.
fn pull(model: &Model) -> Load {
    let nodes = model.mesh.set("right").unwrap().to_vec();
    Load::Point { nodes, force: Vector3::new(1e-3, 0.0, 0.0), moment: Vector3::zeros() }
}

/// The ends of the steps of a history.
fn take(steps: &[(&Model, Vec<Support>, Method)], settings: &Settings) -> Vec<Solution> {
    let options = Options::default();
    let plan = plan(steps[0].0, &options).unwrap();
    let mut carried = Carried::rest(steps[0].0);
    let mut ends = Vec::new();
    for (model, prescribed, method) in steps {
        let step = LoadStep { model, prescribed, settings, method };
        let (end, next) =
            continue_from(&carried, &step, &plan, &options, |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(end.state.factor, 1.0);
        (carried, ends) = (next, [ends, vec![end]].concat());
    }
    ends
}

/// Largest distance of the nodes of two states (m).
fn apart(a: &Solution, b: &Solution) -> f64 {
    let places = a.state.position.iter().zip(&b.state.position);
    places.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// One state for its loads, by every method; at the end nothing is left.
#[test]
fn an_elastic_sheet_forgets_its_history() {
    let bare = strip(Vec::new());
    let (hangs, pulled) = (strip(vec![weight()]), strip(vec![weight(), pull(&bare)]));
    let settings = Settings { tolerance: 1e-10, ..Settings::default() };
    let at_once = solve(&pulled, &settings, &Options::default(), |_| ControlFlow::Continue(())).unwrap();
    let arc = ArcLength { until: Some(1.0), ..ArcLength::default() };
    let flow = Flow { perturbation: 0.0, ..Flow::default() };
    for method in [Method::Newton(None), Method::ArcLength(arc), Method::Flow(flow)] {
        let ends = take(
            &[
                (&hangs, Vec::new(), Method::Newton(None)),
                (&pulled, Vec::new(), method),
                (&bare, Vec::new(), method),
            ],
            &settings,
        );
        let (same, rest) = (apart(&ends[1], &at_once), solve_rest(&bare));
        println!("{method:?}: {same:e}, {:e}", apart(&ends[2], &rest));
        assert!(same < 1e-7 * LENGTH, "{method:?}: {same:e}");
        assert!(apart(&ends[2], &rest) < 1e-7 * LENGTH, "{method:?}");
        assert!(ends[2].energy < 1e-9 * ends[0].energy, "{method:?}: {}", ends[2].energy);
        assert!(ends.iter().all(|end| end.stability.is_stable()));
    }
}

fn solve_rest(model: &Model) -> Solution {
    take(&[(model, Vec::new(), Method::Newton(None))], &Settings::default()).remove(0)
}

/// The end is lifted, held where it is while the weight comes and goes, and let go.
#[test]
fn what_is_held_stays_where_it_is_until_it_is_let_go() {
    let bare = strip(Vec::new());
    let end = bare.mesh.set("right").unwrap().to_vec();
    let held = |loads| {
        let mut model = strip(loads);
        model.supports.push(Support::fix(&end, &[Dof::U, Dof::W, Dof::ThetaY]));
        model
    };
    let (held, heavy) = (held(Vec::new()), held(vec![weight()]));
    let lift = vec![Support::at(end.clone(), vec![(Dof::U, -0.03), (Dof::W, 0.08), (Dof::ThetaY, -1.0)])];
    let settings = Settings { first_step: 0.1, largest_step: 0.1, ..Settings::default() };
    let newton = Method::Newton(None);
    let ends = take(
        &[
            (&bare, lift.clone(), newton),
            (&heavy, Vec::new(), newton),
            (&held, Vec::new(), newton),
            (&held, lift, newton),
            (&bare, Vec::new(), newton),
        ],
        &settings,
    );
    for step in &ends[..4] {
        let (now, rest) = (step.state.position[end[0] as usize], bare.mesh.nodes[end[0] as usize]);
        assert!(((now - rest) - Vector3::new(-0.03, 0.0, 0.08)).norm() < 1e-12);
        let turn = step.state.rotation[end[0] as usize].scaled_axis();
        assert!((turn - Vector3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
    }
    assert!(apart(&ends[0], &ends[1]) > 1e-4, "{}", apart(&ends[0], &ends[1]));
    // Without weight again, and moved to where it is already.
    assert!(apart(&ends[0], &ends[2]) < 1e-6 * LENGTH && apart(&ends[2], &ends[3]) < 1e-8 * LENGTH);
    assert!(apart(&ends[4], &solve_rest(&bare)) < 1e-6 * LENGTH);
}

/// A rod along x: the reaction of a moved end is that of a spring, and half of it where it is moved half the way back.
#[test]
fn values_count_from_the_rest() {
    let bare = strip(Vec::new());
    let end = bare.mesh.set("right").unwrap().to_vec();
    let to = |u: f64| vec![Support::at(end.clone(), vec![(Dof::U, u), (Dof::W, 0.0)])];
    let newton = Method::Newton(None);
    let ends = take(&[(&bare, to(2e-3), newton), (&bare, to(1e-3), newton)], &Settings::default());
    let force = |step: &Solution| end.iter().map(|n| step.reaction[6 * *n as usize]).sum::<f64>();
    let spring = 600.0 * 0.01 / LENGTH;
    assert!((force(&ends[0]) / (spring * 2e-3) - 1.0).abs() < 1e-6, "{}", force(&ends[0]));
    assert!((force(&ends[1]) / (spring * 1e-3) - 1.0).abs() < 1e-6, "{}", force(&ends[1]));
}

/// KES-FB2: a gap of 1 cm is bent to 2.5 per cm by the clamp, which then lets it go.
#[test]
fn a_released_strip_keeps_the_curvature_of_its_law() {
    let sliders = [(2.4e-5, 12.5), (1e-5, 40.0)].map(|(stiffness, slip)| Slider { stiffness, slip });
    let family = Family { widening: Widening::Constant, sliders: sliders.to_vec() };
    let law = Channel::new(Backbone::line(1e-5).unwrap(), vec![family], false).unwrap();
    let bending = SheetLaw::new(Mode::Friction, [None, None, None, Some(law.clone()), None, None]);
    let mesh = rectangle(0.01, 0.2, 10, 1).unwrap();
    let right = mesh.set("right").unwrap().to_vec();
    let lead = right[0];
    let plane = [Dof::V, Dof::ThetaX, Dof::ThetaZ];
    let model = Model {
        supports: vec![Support::clamped(mesh.set("left").unwrap()), Support::fix(&[lead], &plane)],
        bodies: vec![RigidBody { nodes: right }],
        mesh,
        ..strip(Vec::new())
    };
    let turn = vec![Support::at(vec![lead], vec![(Dof::ThetaY, 2.5)])];
    let settings = Settings {
        first_step: 0.02,
        largest_step: 0.02,
        tolerance: 1e-10,
        law: Some(bending),
        ..Settings::default()
    };
    let newton = Method::Newton(None);
    let ends = take(&[(&model, turn, newton), (&model, Vec::new(), newton)], &settings);
    // The law of a cell: up to 250 per m, then down to where the moment is gone.
    let loaded = (1..=50).fold(LawState::default(), |state, k| law.trial(&state, 5.0 * f64::from(k)).state);
    let (mut low, mut high) = (0.0, 250.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if law.trial(&loaded, middle).stress > 0.0 { &mut high } else { &mut low }) = middle;
    }
    let turned = |step: &Solution| step.state.rotation[lead as usize].scaled_axis().y / 0.01;
    println!("{} {}, law {low}", turned(&ends[0]), turned(&ends[1]));
    assert!((turned(&ends[0]) - 250.0).abs() < 1e-9);
    assert!(low > 10.0 && (turned(&ends[1]) / low - 1.0).abs() < 1e-6, "{} {low}", turned(&ends[1]));
    assert!(ends[1].state.memory.dissipated > ends[0].state.memory.dissipated);
}

const SHEET: &str =
    concat!(include_str!("../common/strip.toml"), "[[probes]]\nname = \"tip\"\nat = [\"20 cm\", \"5 mm\"]\n");

const NONLINEAR: &str = "[analysis]\nkind = \"nonlinear\"\n";
const WEIGHT: &str = "[[loads]]\nkind = \"gravity\"\n";

fn parsed(rest: &str) -> Result<Case, CaseError> {
    Case::parse(Path::new("strip.toml"), &format!("{SHEET}{rest}"))
}

fn solved(rest: &str) -> CaseResult {
    let case = parsed(rest).unwrap_or_else(|e| panic!("{e}"));
    solve_case(&case, section(case.section().unwrap()).unwrap(), &Options::default()).unwrap()
}

/// The weight of the case is there in every step; a push of a step goes with it.
#[test]
fn steps_of_a_case_are_those_of_the_library() {
    let steps = "[[steps]]\nname = \"hang\"\n\
                 [[steps]]\nname = \"push\"\n[[steps.loads]]\nkind = \"point\"\nset = \"right\"\nvalue = \"1 mN\"\ndirection = [1, 0, 0]\n\
                 [[steps]]\nname = \"hang again\"\n[steps.analysis]\nkind = \"nonlinear\"\nmethod = \"flow\"\n";
    let result = solved(&format!("{NONLINEAR}{WEIGHT}{steps}"));
    let hung = solved(&format!("{NONLINEAR}{WEIGHT}"));
    assert_eq!(result.status, Status::Ok, "{:?}", result.findings);
    let path = result.path.as_ref().unwrap();
    let names: Vec<&str> = path.load_steps.iter().map(|step| step.name.as_str()).collect();
    assert_eq!(names, ["hang", "push", "hang again"]);
    assert!(path.load_steps.iter().all(|step| step.stability.unwrap().is_stable()));
    let ends: Vec<usize> = path.load_steps.iter().map(|step| step.steps.end).collect();
    assert_eq!(ends[2], path.steps.len());
    let w = |k: usize| path.probes[0][ends[k] - 1][2];
    let alone = hung.probes[0].value.u[2];
    assert!((w(0) / alone - 1.0).abs() < 1e-7 && (w(2) / alone - 1.0).abs() < 1e-6, "{} {}", w(0), w(2));
    assert!(w(1) > 0.9 * alone);
    assert!((result.probes[0].value.u[2] - w(2)).abs() < 1e-15);
    assert!((path.steps[ends[1] - 1].factor - 2.0).abs() < 1e-15);
    let then = result.at_end_of(&path.load_steps[1]);
    let tip = then.solution.displacement.len() - 6;
    assert!((then.solution.displacement[tip + 2] - w(1)).abs() < 1e-6 * LENGTH);
    // The strip in its step, and its forces there.
    let [force, _] = then.reactions().unwrap();
    assert!((force.x + 1e-3).abs() < 1e-9 && (force.z - 0.15 * 0.002 * 9.80665).abs() < 1e-8, "{force:?}");
}

/// A strip pushed at its end by more than Euler's load buckles; the step in which it does says so, and where.
#[test]
fn a_step_that_buckles_is_told_at_its_place() {
    let steps = "[[steps]]\nname = \"push\"\n[[steps.loads]]\nkind = \"point\"\nset = \"right\"\nvalue = \"0.01 mN\"\ndirection = [-1, 0, 0]\n\
                 [[steps]]\nname = \"rest\"\n";
    let result = solved(&format!("{NONLINEAR}{steps}"));
    let found = result.findings.iter().find(|f| f.code() == "S124").unwrap();
    let line = SHEET.lines().count() as u32 + 4;
    assert!(
        found.place.as_ref().unwrap().to_string().starts_with(&format!("strip.toml:{line}")),
        "{found:?}"
    );
}

#[test]
fn steps_that_mean_nothing_are_refused_at_their_place() {
    let step = "[[steps]]\nname = \"a\"\n";
    let cases = [
        (format!("{WEIGHT}{step}"), "large rotations"),
        (format!("[analysis]\nkind = \"modal\"\n{step}"), "large rotations"),
        (format!("{NONLINEAR}{step}"), "nothing acts"),
        (format!("{NONLINEAR}{WEIGHT}{step}{step}"), "a name of its own"),
        (format!("{NONLINEAR}{WEIGHT}[[steps]]\nname = \" \"\n"), "a name of its own"),
        (
            format!("{NONLINEAR}{WEIGHT}{step}[steps.analysis]\nkind = \"linear\"\n"),
            "of kind = \"nonlinear\"",
        ),
        (format!("{NONLINEAR}{WEIGHT}{step}[[steps.supports]]\nset = \"left\"\n"), "either `kind` or `fix`"),
        (format!("{NONLINEAR}{WEIGHT}{step}[[steps.loads]]\nkind = \"push\"\n"), "unknown variant `push`"),
        (format!("{NONLINEAR}{WEIGHT}{step}of = 1\n"), "unknown key `of`"),
    ];
    for (text, expected) in cases {
        let error = parsed(&text).unwrap_err().to_string();
        assert!(error.starts_with("strip.toml:") && error.contains(expected), "{text}\n{error}");
    }
    // A set that the mesh does not have, in a step that is not the last.
    let text = format!(
        "{NONLINEAR}{WEIGHT}[[steps]]\nname = \"a\"\n[[steps.supports]]\nset = \"ring\"\nkind = \"clamped\"\n[[steps]]\nname = \"b\"\n"
    );
    let case = parsed(&text).unwrap();
    let error = kesf::study::validate(&case, &Options::default()).unwrap_err();
    assert_eq!(error.code(), "M007");
}
