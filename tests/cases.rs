//! The shipped cases: every file is read, the benchmarks hold their checks.

use std::path::{Path, PathBuf};

use kesf::solve::Options;
use kesf::study::{Case, Status, section, solve_case};

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn every_shipped_case_is_read_and_every_explicit_section_passes_its_checks() {
    let mut checks = 0;
    for path in shipped() {
        let case = Case::read(&path).unwrap_or_else(|e| panic!("{e}"));
        let Some(table) = &case.section else { continue };
        let result = solve_case(&case, section(table).unwrap(), &Options::default()).unwrap();
        for check in &result.checks {
            println!("{}: {} error {:.2e}", case.name, check.quantity, check.relative_error);
            assert!(check.passed, "{}: {check:?}", case.name);
            checks += 1;
        }
        assert_eq!(result.status, Status::Ok, "{}: {:?}", case.name, result.findings);
    }
    assert!(checks >= 3);
}

/// A flat sheet solved as bending and membrane apart, and as one six-dof shell.
#[test]
fn decoupled_and_coupled_solutions_are_equal() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/benchmark_clamped_orthotropic.toml");
    let case = Case::read(&path).unwrap();
    let s = section(case.section.as_ref().unwrap()).unwrap();
    let apart = solve_case(&case, s.clone(), &Options::default()).unwrap();
    let together = solve_case(&case, s, &Options { coupled: true, ..Options::default() }).unwrap();
    let scale = apart.w_max.abs();
    for (a, b) in apart.solution.displacement.iter().zip(&together.solution.displacement) {
        assert!((a - b).abs() < 1e-9 * scale.max(a.abs()));
    }
}

fn parsed(analysis: &str, load: &str) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/benchmark_clamped_isotropic.toml");
    let text = std::fs::read_to_string(path).unwrap().replace("cells = [40, 40]", "cells = [12, 12]");
    let end = text.find("[[checks]]").unwrap();
    let loads = text.find("[[loads]]").unwrap();
    let probes = text.find("[[probes]]").unwrap();
    let text = format!("{}{load}{}[analysis]\n{analysis}\n", &text[..loads], &text[probes..end]);
    Case::parse(Path::new("inline.toml"), &text).unwrap()
}

const PRESSURE: &str = "[[loads]]\nkind = \"pressure\"\nvalue = \"1e-6 Pa\"\n";

/// Clamped isotropic square: ω1 = 35.98519 √(D/ρ)/L² (p-Ritz), here with D = ρ = L = 1.
#[test]
fn a_modal_case_gives_frequencies_and_the_first_shape() {
    let case = parsed("kind = \"modal\"\nmodes = 3", "");
    let s = section(case.section.as_ref().unwrap()).unwrap();
    let result = solve_case(&case, s, &Options::default()).unwrap();
    assert_eq!(result.frequencies.len(), 3);
    let omega = result.frequencies[0] * std::f64::consts::TAU;
    assert!((omega / 35.98519 - 1.0).abs() < 0.02, "{omega}");
    assert!((result.w_max.abs() - 1.0).abs() < 1e-12 && result.findings.is_empty());
}

/// A suddenly applied load swings to about twice the static deflection and conserves energy. The
/// first mode alone would give 2 times its share (a few percent above the static deflection); the
/// others add a few percent when their swings coincide, so the bound is 2.2.
#[test]
fn a_dynamic_case_swings_about_the_static_deflection() {
    let case = parsed("kind = \"newmark\"\nduration = \"0.175 s\"\nstep = \"0.5 ms\"", PRESSURE);
    let s = section(case.section.as_ref().unwrap()).unwrap();
    let dynamic = solve_case(&case, s.clone(), &Options::default()).unwrap();
    let still = solve_case(&parsed("kind = \"linear\"", PRESSURE), s, &Options::default()).unwrap();
    let ratio = dynamic.w_max / still.w_max;
    assert!((1.9..2.2).contains(&ratio), "{ratio}");
    let history = dynamic.history.unwrap();
    assert!(history.imbalance < 1e-9);
    assert_eq!(history.time.len(), history.probes[0].len());
}
