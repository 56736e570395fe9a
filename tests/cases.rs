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
        let result = solve_case(&case, section(table).unwrap(), None, &Options::default()).unwrap();
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
    let apart = solve_case(&case, s.clone(), None, &Options::default()).unwrap();
    let together = solve_case(&case, s, None, &Options { coupled: true, ..Options::default() }).unwrap();
    let scale = apart.w_max.abs();
    for (a, b) in apart.solution.displacement.iter().zip(&together.solution.displacement) {
        assert!((a - b).abs() < 1e-9 * scale.max(a.abs()));
    }
}
