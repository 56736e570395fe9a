//! Cases in large rotations, from the text of the case to its result.
//!
//! References: the heavy elastica for a strip (analytical); M = D11 κ and closed forms of edge effects are with
//! the virtual tests; von Kármán's equations for the clamped cloth are a check of the shipped case.

use std::path::Path;

use kesf::analytical::elastica::heavy_elastica;
use kesf::case::MethodChoice;
use kesf::characterise::{FabricSheet, Key};
use kesf::constitutive::{Constitutive, face_laws};
use kesf::finding::{Fact, StudyFact};
use kesf::instrument::{Direction, Parameter};
use kesf::quantity::Estimate;
use kesf::section::ShellSection;
use kesf::solve::Options;
use kesf::study::{Case, CaseResult, PreparedCase, Status, StudyError, Watch, section, solve_case};

/// A strip of cloth 20 x 1 cm along x, clamped on the left, in plane strain.
fn strip(analysis: &str, load: &str) -> Case {
    let text = text_of(analysis, load);
    Case::parse(Path::new("strip.toml"), &text).unwrap_or_else(|e| panic!("{e}"))
}

fn text_of(analysis: &str, load: &str) -> String {
    let strip = include_str!("../common/strip.toml");
    format!(
        r#"{strip}[[loads]]
{load}
[[probes]]
name = "tip"
at = ["20 cm", "5 mm"]
[analysis]
{analysis}
"#
    )
}

const WEIGHT: &str = "kind = \"gravity\"";
const NONLINEAR: &str = "kind = \"nonlinear\"";
/// Twice Euler's load of the clamped strip, along it.
const THRUST: &str = "kind = \"edge_force\"\nset = \"right\"\nvalue = \"0.001 N/m\"\ndirection = [-1, 0, 0]";

fn cloth(case: &Case) -> ShellSection {
    section(case.section().unwrap()).unwrap()
}

fn solved(case: &Case) -> CaseResult {
    solve_case(case, cloth(case), &Options::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn codes(result: &CaseResult) -> Vec<&str> {
    result.findings.iter().map(|f| f.code()).collect()
}

#[test]
fn a_heavy_strip_hangs_as_the_elastica_and_the_linear_answer_stands_beside() {
    let case = strip(NONLINEAR, WEIGHT);
    let result = solved(&case);
    let gamma = 0.15 * 9.80665 * 0.2f64.powi(3) / 8e-6;
    let exact = heavy_elastica(gamma).unwrap().drop * 0.2;
    let tip = result.probes[0].value;
    println!("tip {} exact {exact}", tip.u[2]);
    // Its stretch under its own weight, w L / 2 EA of the length, is 2.5e-4; the mesh 5e-4.
    assert!((-tip.u[2] / exact - 1.0).abs() < 1e-3, "{tip:?}");
    assert_eq!((result.status, codes(&result)), (Status::Ok, vec![]));
    let path = result.path.as_ref().unwrap();
    assert!(
        path.converged && path.stability.unwrap().is_stable() && path.steps.last().unwrap().factor == 1.0
    );
    assert_eq!(path.probes[0].len(), path.steps.len());
    assert_eq!(path.probes[0].last().unwrap()[2], tip.u[2]);
    // w L⁴/8B, a length and a half and more below.
    let linear = path.linear_w_max.unwrap();
    assert!((-linear / (gamma / 8.0 * 0.2) - 1.0).abs() < 0.01, "{linear}");
    // The clamp carries the weight along the strip: resultants are those of the turned elements.
    let nodal = result.nodal().unwrap();
    let hanging = nodal.iter().map(|n| n.membrane[0]).fold(0.0, f64::max);
    assert!(hanging < 1.05 * 0.15 * 9.81 * 0.2 && hanging > 0.8 * 0.15 * 9.81 * 0.2, "{hanging}");
}

#[test]
fn a_prepared_case_gives_the_same_for_every_fabric() {
    let case = strip(NONLINEAR, WEIGHT);
    let prepared = PreparedCase::new(&case, &Options::default()).unwrap();
    let soft = ShellSection { areal_density: 0.3, ..cloth(&case) };
    for s in [cloth(&case), soft] {
        let apart = solve_case(&case, s.clone(), &Options::default()).unwrap();
        let shared = prepared.solve(s).unwrap();
        assert_eq!(apart.solution.displacement, shared.solution.displacement);
        assert_eq!(apart.path, shared.path);
    }
}

/// A strip that hangs from its clamp is convex on its upper side all along: with its face up it bends with Bf, and with its face
/// down with Bb. Reference: the heavy elastica of each.
#[test]
fn a_strip_hangs_by_the_rigidity_of_the_face_that_is_up() {
    let case = strip(NONLINEAR, WEIGHT);
    let [bf, bb] = [1.2e-5, 0.6e-5];
    let mut sheet = FabricSheet { name: "two-sided".into(), ..FabricSheet::default() };
    for (parameter, value) in [(Parameter::B, 0.5 * (bf + bb)), (Parameter::Bf, bf), (Parameter::Bb, bb)] {
        for direction in [Direction::Warp, Direction::Weft] {
            let key = Key { parameter, direction: Some(direction) };
            sheet.values.insert(key, Estimate::single(value));
        }
    }
    let mut section = cloth(&case);
    section.d_b[(0, 0)] = 0.5 * (bf + bb);
    section.d_b[(1, 1)] = section.d_b[(0, 0)];
    let mut made = Constitutive {
        section,
        law: None,
        used: Vec::new(),
        inputs: Vec::new(),
        surface_friction: None,
        findings: Vec::new(),
    };
    let laws = face_laws(&sheet, &made).unwrap().unwrap();
    let prepared = PreparedCase::new(&case, &Options::default()).unwrap();
    for (law, b) in laws.into_iter().zip([bf, bb]) {
        made.law = Some(law);
        let result = prepared.solve_watched(&made, Watch::default()).unwrap();
        let exact = heavy_elastica(0.15 * 9.80665 * 0.2f64.powi(3) / b).unwrap().drop * 0.2;
        let drop = -result.probes[0].value.u[2];
        println!("B = {b:e}: {drop} exact {exact}");
        assert!((drop / exact - 1.0).abs() < 2e-3, "{drop} {exact}");
    }
}

#[test]
fn a_column_buckles_by_itself_and_every_method_ends_in_one_shape() {
    let straight = solved(&strip("kind = \"nonlinear\"\nmethod = \"arc_length\"", THRUST));
    assert_eq!(codes(&straight), ["S111"]);
    assert!(straight.findings[0].message().contains("flow") && straight.w_max.abs() < 1e-12);
    let buckled = solved(&strip("kind = \"nonlinear\"\nfirst_step = 0.1\nlargest_step = 0.1", THRUST));
    assert_eq!(codes(&buckled), ["S124"]);
    assert!(buckled.findings[0].message().contains("is unstable"), "{}", buckled.findings[0].message());
    assert!(buckled.path.as_ref().unwrap().stability.unwrap().is_stable());
    // Euler's load is 0.4935 of the thrust; the last stable step before it is a short one.
    let Fact::Study(StudyFact::Buckled { factors, unstable_w_max }) = &buckled.findings[0].fact else {
        panic!("{:?}", buckled.findings)
    };
    assert!((0.47..0.4945).contains(&factors[0]) && factors.iter().all(|f| *f < 0.52), "{factors:?}");
    assert!(unstable_w_max.unwrap().abs() < 1e-12);
    let asked = solved(&strip("kind = \"nonlinear\"\nmethod = \"stable\"", THRUST));
    assert_eq!(codes(&asked), ["S124"]);
    let flow = solved(&strip("kind = \"nonlinear\"\nmethod = \"flow\"\nseed = 3", THRUST));
    assert_eq!(codes(&flow), [""; 0]);
    // The steps that it took are enough, one less is not.
    let taken = flow.path.as_ref().unwrap().steps.len();
    for (steps, expected) in [(taken, vec![]), (taken - 1, vec!["N007"])] {
        let analysis = format!("kind = \"nonlinear\"\nmethod = \"flow\"\nseed = 3\nsteps = {steps}");
        let flow = solved(&strip(&analysis, THRUST));
        assert_eq!(codes(&flow), expected, "{steps}");
        assert!(flow.findings.iter().all(|f| f.message().contains("no rest at the end of the flow")));
    }
    let pushed = solved(&strip(
        "kind = \"nonlinear\"\nfirst_step = 0.1\nlargest_step = 0.1\nperturbation = 1e-3",
        THRUST,
    ));
    assert_eq!(codes(&pushed), [""; 0]);
    let a = flow.w_max.abs();
    for b in [pushed.w_max.abs(), buckled.w_max.abs(), asked.w_max.abs()] {
        assert!(a > 0.01 && (a / b - 1.0).abs() < 1e-4, "{a} {b}");
    }
    let arc = solved(&strip("kind = \"nonlinear\"\nmethod = \"arc_length\"", WEIGHT));
    assert_eq!(arc.path.as_ref().unwrap().steps.last().unwrap().factor, 1.0);
    let short =
        solved(&strip("kind = \"nonlinear\"\nmethod = \"arc_length\"\nsteps = 1\nfirst_step = 1e-4", WEIGHT));
    assert_eq!((short.status, codes(&short)), (Status::NotConverged, vec!["S112"]));
}

/// A stiff sheet under next to nothing moves no further than rounding, whatever its forces do: that is told.
#[test]
fn loads_below_rounding_are_told() {
    let text = include_str!("../../cases/self_weight_clamped.toml");
    let (text, _) = text.split_once("[[checks]]").unwrap();
    let text = text.replace("10000 N/m", "1e8 N/m").replace("6000 N/m", "6e7 N/m");
    let solved_under = |pressure: &str| {
        let text = text.replace("\"gravity\"", &format!("\"pressure\"\nvalue = \"{pressure}\""));
        solved(&Case::parse(Path::new("stiff.toml"), &text).unwrap())
    };
    let tiny = solved_under("1e-8 Pa");
    assert_eq!(codes(&tiny), ["S127"], "{:?}", tiny.path);
    assert!(tiny.path.unwrap().steps.last().unwrap().residual > 1e-6);
    assert_eq!(codes(&solved_under("0.147 Pa")), [""; 0]);
}

/// A linear answer is that of a sheet that cannot buckle: beyond Euler's load, π² B / 4 L² of the clamped strip, that is
/// said, and below it is not. Tension is no matter at any load.
#[test]
fn a_linear_answer_beyond_buckling_is_told() {
    let euler = (0.5 * std::f64::consts::PI / 0.2).powi(2) * 8e-6;
    for (load, expected) in [(0.97 * euler, vec![]), (1.03 * euler, vec!["S105"]), (-3.0 * euler, vec![])] {
        let thrust = THRUST.replace("0.001 N/m", &format!("{load} N/m"));
        let result = solved(&strip("kind = \"linear\"", &thrust));
        assert_eq!(codes(&result), expected, "{load}");
        assert_eq!(result.status == Status::BeyondLinear, !expected.is_empty());
    }
}

/// Four iterations a step and no shorter steps: nothing beyond the start can be found. Newton's method, which fails as well, is
/// helped by a flow under the whole load.
#[test]
fn what_does_not_converge_keeps_its_last_state_and_says_what_to_try() {
    const HARD: &str = "kind = \"nonlinear\"\niterations = 4\nfirst_step = 0.02\nsmallest_step = 0.015";
    let result = solved(&strip(HARD, WEIGHT));
    assert_eq!((result.status, codes(&result)), (Status::Ok, vec!["S124"]));
    assert_eq!(result.path.as_ref().unwrap().method, MethodChoice::Flow);
    let known = solved(&strip("kind = \"nonlinear\"", WEIGHT));
    assert!((result.w_max / known.w_max - 1.0).abs() < 1e-6, "{} and {}", result.w_max, known.w_max);
    let result = solved(&strip(&format!("{HARD}\nmethod = \"stable\""), WEIGHT));
    assert_eq!((result.status, codes(&result)), (Status::NotConverged, vec!["N007"]));
    assert!(result.findings[0].message().contains("method = \"flow\""), "{}", result.findings[0].message());
    let path = result.path.as_ref().unwrap();
    assert!(!path.converged && path.stability.is_none());
    let last = path.steps.last().map_or(0.0, |s| s.factor);
    assert!(last < 1.0 && result.state.as_ref().unwrap().factor == last);
}

/// Half a circle by a moment on the end, M = π B / L: the moment is the same everywhere, and the sheet is
/// not stretched; read with small rotations, displacements as these would mean anything else.
#[test]
fn resultants_are_those_of_the_turned_elements() {
    let moment = std::f64::consts::PI * 8e-6 / 0.2;
    let load =
        format!("kind = \"edge_moment\"\nset = \"right\"\nvalue = \"{moment} N\"\ndirection = [0, -1, 0]");
    let result = solved(&strip("kind = \"nonlinear\"\nfirst_step = 0.5", &load));
    for n in result.nodal().unwrap() {
        assert!((n.moment[0].abs() / moment - 1.0).abs() < 1e-6, "{n:?}");
        assert!(n.membrane[0].abs() < 1e-6 * 600.0, "{n:?}");
    }
    assert!((result.probes[0].value.theta[1].abs() - std::f64::consts::PI).abs() < 1e-3);
}

/// A dead pressure, q L³/B = 10, is the weight of the heavy elastica upside down (analytical); one that follows the
/// strip keeps its lever and bends it further back.
#[test]
fn a_follower_pressure_is_a_key_of_the_load() {
    let solve = |follower: bool, kind: &str| {
        let load = format!("kind = \"pressure\"\nvalue = \"0.01 Pa\"\nfollower = {follower}");
        solved(&strip(kind, &load)).probes[0].value.u
    };
    let (dead, follower) = (solve(false, NONLINEAR), solve(true, NONLINEAR));
    let exact = heavy_elastica(10.0).unwrap().drop * 0.2;
    assert!((dead[2] / exact - 1.0).abs() < 1e-3, "{dead:?}");
    assert!(follower[2] > dead[2] && follower[0] < 1.5 * dead[0], "{dead:?} {follower:?}");
    let linear = "kind = \"linear\"";
    assert_eq!(solve(false, linear), solve(true, linear));
}

#[test]
fn a_strip_falls_and_the_linear_finding_names_the_cure() {
    let motion = "kind = \"newmark\"\nduration = \"0.2 s\"\nstep = \"4 ms\"";
    let large = solved(&strip(&format!("{motion}\nlarge_rotations = true"), WEIGHT));
    let history = large.history.as_ref().unwrap();
    println!("imbalance {:e}", history.imbalance);
    assert!(history.w_max < -0.15 && history.w_max > -0.2 && history.imbalance < 0.02);
    assert_eq!((large.status, codes(&large)), (Status::Ok, vec![]));
    // The steps asked for, but for a few that are halved.
    assert!((51..70).contains(&history.time.len()), "{}", history.time.len());
    // A rigid bar along an edge that plane strain keeps straight changes nothing.
    let bar = format!(
        "{WEIGHT}\n[[rigid]]\nname = \"bar\"\nset = \"right\"\n[[supports]]\nset = \"bar\"\n\
         fix = [\"v\", \"theta_x\", \"theta_z\"]"
    );
    let stiffened = solved(&strip(&format!("{motion}\nlarge_rotations = true"), &bar));
    let lowest = stiffened.history.as_ref().unwrap().w_max;
    assert!((lowest / history.w_max - 1.0).abs() < 1e-6, "{lowest} {}", history.w_max);
    let small = solved(&strip(motion, WEIGHT));
    assert_eq!(codes(&small), ["S101"]);
    assert!(small.findings[0].message().contains("large_rotations = true"));
    let still = solved(&strip("kind = \"linear\"", WEIGHT));
    assert!(still.findings[0].message().contains("kind = \"nonlinear\""));
}

/// A bias strip is statically determinate: by virtual work with the stretches of the yarns and their angle, for a force p per
/// width along x and sides λx, λy, each yarn of length L = √((λx² + λy²)/2) carries p λx / 2L, and their angle is held by p λy / 2.
#[test]
fn yarns_of_a_sheared_strip_carry_what_statics_says() {
    for membrane in ["assumed_stress", "one_cell", "cells"] {
        let text = text_of(
            "kind = \"nonlinear\"",
            "kind = \"edge_force\"\nset = \"right\"\nvalue = \"20 N/m\"\ndirection = [1, 0, 0]",
        );
        let text = text
            .replace("600 N/m", "6000 N/m")
            .replace("shear = \"300 N/m\"", "shear = \"50 N/m\"")
            .replace("height = \"1 cm\"\ncells = [20, 1]", "height = \"10 cm\"\ncells = [6, 4]\nwarp_angle_deg = 45")
            .replace("fix = [\"v\", \"theta_x\", \"theta_z\"]", "fix = [\"w\", \"theta_x\", \"theta_y\"]")
            .replace("kind = \"clamped\"", "fix = [\"u\"]\n[[supports]]\nset = \"bottom\"\nfix = [\"v\"]")
            .replace("[analysis]", "[[probes]]\nname = \"corner\"\nat = [\"20 cm\", \"10 cm\"]\n[element]\nmembrane = \"MEMBRANE\"\n[analysis]")
            .replace("MEMBRANE", membrane);
        let result = solved(&Case::parse(Path::new("bias.toml"), &text).unwrap());
        let [u, v, _] = result.probes[1].value.u;
        let (x, y) = (1.0 + u / 0.2, 1.0 + v / 0.1);
        let length = ((x * x + y * y) / 2.0).sqrt();
        let found = result.probes[1].value.resultants.membrane;
        let expected = [20.0 * x / (2.0 * length), 20.0 * x / (2.0 * length), 20.0 * y / 2.0];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found.abs() - expected).abs() < 1e-5 * expected, "{membrane}: {found} {expected}");
        }
        assert!(found[0] > 0.0 && found[1] > 0.0 && y < 0.95, "{found:?} {y}");
    }
}

#[test]
fn keys_that_a_method_does_not_have_are_refused() {
    let refused = |analysis: &str, load: &str| -> StudyError {
        let case = Case::parse(Path::new("strip.toml"), &text_of(analysis, load)).map_err(StudyError::from);
        case.and_then(|case| solve_case(&case, cloth(&case), &Options::default())).unwrap_err()
    };
    for analysis in [
        "method = \"flow\"\nfirst_step = 0.1",
        "method = \"arc_length\"\nperturbation = 0.1",
        "steps = 3",
        "tolerance = 0.0",
        "iterations = 0",
        "perturbation = 2.0",
    ] {
        let e = refused(&format!("{NONLINEAR}\n{analysis}"), WEIGHT);
        assert_eq!(e.code(), "S003", "{analysis}: {e}");
    }
    let turned = "kind = \"prescribed\"\nset = \"right\"\ndof = \"theta_y\"\nvalue = \"90 deg\"";
    assert!(refused(&format!("{NONLINEAR}\nperturbation = 0.1"), turned).to_string().contains("forces"));
    let newmark = "kind = \"newmark\"\nduration = \"0.2 s\"\nstep = \"4 ms\"";
    assert!(
        refused(&format!("{newmark}\nspectral_radius = 0.5"), WEIGHT).to_string().contains("large_rotations")
    );
}

/// The shipped example of a strip that is dropped, with a cloth of its own: it whips at the bottom of its fall, where damping by stiffness
/// meets the largest turns of a step.
#[test]
fn a_damped_strip_that_is_dropped_balances_its_energies() {
    let example = include_str!("../../examples/large_rotations/falling_strip.toml");
    let (_, sheet) = example.split_once("[sheet]").unwrap();
    let own = text_of("", "");
    let (head, _) = own.split_once("[sheet]").unwrap();
    let text = format!("{head}[sheet]{sheet}").replace("[40, 2]", "[20, 1]").replace("0.5 s", "0.3 s");
    let case = Case::parse(Path::new("fall.toml"), &text).unwrap_or_else(|e| panic!("{e}"));
    let history = solved(&case).history.unwrap();
    let lost: Vec<f64> = history.energy.iter().map(|e| e.dissipated).collect();
    println!("{} instants, imbalance {:.1e}", lost.len(), history.imbalance);
    assert!(history.imbalance < 1e-5 && lost.is_sorted() && *lost.last().unwrap() > 0.0);
    assert!((history.time.last().unwrap() - 0.3).abs() < 1e-9);
}
