//! The shipped cases: every file is read, the benchmarks hold their checks.

use std::path::{Path, PathBuf};

use kesf::finding::Coded;
use kesf::solve::Options;
use kesf::study::{Case, Status, section, solve_case};

fn shipped() -> Vec<PathBuf> {
    let below = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect()
    };
    let all = below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("cases"));
    let mut files: Vec<PathBuf> =
        all.into_iter().flat_map(|path| if path.is_dir() { below(&path) } else { vec![path] }).collect();
    files.sort();
    files
}

#[test]
fn every_shipped_case_is_read_and_every_explicit_section_passes_its_checks() {
    let mut checks = 0;
    for path in shipped() {
        let case = Case::read(&path).unwrap_or_else(|e| panic!("{e}"));
        let Some(table) = case.section() else { continue };
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
    let s = section(case.section().unwrap()).unwrap();
    let apart = solve_case(&case, s.clone(), &Options::default()).unwrap();
    let together = solve_case(&case, s, &Options { coupled: true, ..Options::default() }).unwrap();
    let scale = apart.w_max.abs();
    for (a, b) in apart.solution.displacement.iter().zip(&together.solution.displacement) {
        assert!((a - b).abs() < 1e-9 * scale.max(a.abs()));
    }
}

fn parsed(analysis: &str, load: &str) -> Case {
    Case::parse(Path::new("inline.toml"), &text_of(analysis, load)).unwrap()
}

/// The same sheet held nowhere.
fn free(analysis: &str, load: &str) -> Case {
    let text = text_of(analysis, load).replace("\"clamped\"", "\"free\"");
    Case::parse(Path::new("inline.toml"), &text).unwrap()
}

fn text_of(analysis: &str, load: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/benchmark_clamped_isotropic.toml");
    let text = std::fs::read_to_string(path).unwrap().replace("cells = [40, 40]", "cells = [12, 12]");
    let end = text.find("[[checks]]").unwrap();
    let loads = text.find("[[loads]]").unwrap();
    let probes = text.find("[[probes]]").unwrap();
    format!("{}{load}{}[analysis]\n{analysis}\n", &text[..loads], &text[probes..end])
}

const PRESSURE: &str = "[[loads]]\nkind = \"pressure\"\nvalue = \"1e-6 Pa\"\n";

/// Clamped isotropic square: ω1 = 35.98519 √(D/ρ)/L² (p-Ritz), here with D = ρ = L = 1.
#[test]
fn a_modal_case_gives_frequencies_and_the_first_shape() {
    let case = parsed("kind = \"modal\"\nmodes = 3", "");
    let s = section(case.section().unwrap()).unwrap();
    let result = solve_case(&case, s, &Options::default()).unwrap();
    assert_eq!(result.frequencies.len(), 3);
    let omega = result.frequencies[0] * std::f64::consts::TAU;
    assert!((omega / 35.98519 - 1.0).abs() < 0.02, "{omega}");
    assert!((result.w_max.abs() - 1.0).abs() < 1e-12 && result.findings.is_empty());
    assert!(result.modes.len() == 3 && result.modes[0] == result.solution.displacement);
    assert!(result.is_modal() && !result.has_reactions() && result.solution.dofs > 0);
    let all = parsed("kind = \"modal\"\nmodes = 10000", "");
    let result = solve_case(&all, section(all.section().unwrap()).unwrap(), &Options::default()).unwrap();
    assert_eq!(result.findings[0].code(), "S104");
}

/// A clamp that moves takes the sheet with it: no strain, and no force to compare a residual with.
#[test]
fn a_moved_clamp_carries_the_sheet() {
    let load = "[[loads]]\nkind = \"prescribed\"\nset = \"boundary\"\ndof = \"w\"\nvalue = \"1 µm\"\n";
    let case = parsed("kind = \"linear\"", load);
    let s = section(case.section().unwrap()).unwrap();
    let result = solve_case(&case, s, &Options::default()).unwrap();
    let w = result.solution.displacement.iter().skip(2).step_by(6);
    assert!(w.into_iter().all(|w| (w / 1e-6 - 1.0).abs() < 1e-9));
    // A clamped edge that is pushed: its force is that of the other edges, to all digits that matter.
    let pushed = load.replace("boundary", "left");
    let case = parsed("kind = \"linear\"", &pushed);
    let s = section(case.section().unwrap()).unwrap();
    let result = solve_case(&case, s, &Options::default()).unwrap();
    let reactions = || result.solution.reaction.iter().skip(2).step_by(6);
    let (sum, largest) = (reactions().sum::<f64>(), reactions().fold(0.0f64, |m, r| m.max(r.abs())));
    assert!(sum.abs() < 1e-9 * largest, "{sum:e} {largest:e}");
}

/// Damping ratios are those of the modes that deform the sheet: a free one is damped like a held one.
#[test]
fn a_free_sheet_is_damped() {
    let analysis = "kind = \"newmark\"\nduration = \"0.02 s\"\nstep = \"0.5 ms\"\ndamping = [0.05, 0.05]";
    let load = "[[loads]]\nkind = \"point\"\nset = \"boundary\"\nvalue = \"1e-9 N\"\ndirection = [0, 0, 1]\n";
    let case = free(analysis, load);
    let s = section(case.section().unwrap()).unwrap();
    let history = solve_case(&case, s, &Options::default()).unwrap().history.unwrap();
    let last = history.energy.last().unwrap();
    assert!(last.dissipated > 1e-3 * last.work.abs(), "{last:?}");
}

/// A suddenly applied load swings to about twice the static deflection and conserves energy. The
/// first mode alone would give 2 times its share (a few percent above the static deflection); the
/// others add a few percent when their swings coincide, so the bound is 2.2.
#[test]
fn a_dynamic_case_swings_about_the_static_deflection() {
    let case = parsed("kind = \"newmark\"\nduration = \"0.175 s\"\nstep = \"0.5 ms\"", PRESSURE);
    let s = section(case.section().unwrap()).unwrap();
    let dynamic = solve_case(&case, s.clone(), &Options::default()).unwrap();
    let still = solve_case(&parsed("kind = \"linear\"", PRESSURE), s, &Options::default()).unwrap();
    let ratio = dynamic.w_max / still.w_max;
    assert!((1.9..2.2).contains(&ratio), "{ratio}");
    let history = dynamic.history.unwrap();
    assert!(history.imbalance < 1e-9);
    assert_eq!(history.time.len(), history.probes[0].len());
}

/// The quadrilateral mesh of a file gives what the generated one gives: 2 x 2 cells of a clamped strip.
#[test]
fn a_mesh_file_is_used_with_its_unit_and_its_groups() {
    let folder = tempfile::tempdir().unwrap();
    let mut msh = String::from(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"held\"\n$EndPhysicalNames\n",
    );
    msh += "$Entities\n0 1 1 0\n3 0 0 0 0 100 0 1 7 0\n1 0 0 0 100 100 0 0 0\n$EndEntities\n$Nodes\n1 9 1 9\n2 1 0 9\n";
    (1..=9).for_each(|k| msh += &format!("{k}\n"));
    (0..9).for_each(|k| msh += &format!("{} {} 0\n", 50 * (k % 3), 50 * (k / 3)));
    msh += "$EndNodes\n$Elements\n2 6 1 6\n1 3 1 2\n1 1 4\n2 4 7\n2 1 3 4\n";
    for (k, n) in [1, 2, 4, 5].into_iter().enumerate() {
        msh += &format!("{} {n} {} {} {}\n", k + 3, n + 1, n + 4, n + 3);
    }
    msh += "$EndElements\n";
    std::fs::write(folder.path().join("part.msh"), msh).unwrap();
    let base = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/benchmark_clamped_orthotropic.toml"),
    )
    .unwrap();
    let head = &base[..base.find("[sheet]").unwrap()];
    let rest = "[[loads]]\nkind = \"gravity\"\n[element]\nprofile = \"seed\"\n";
    let solve = |sheet: &str, set: &str| {
        let text =
            format!("{head}[sheet]\n{sheet}\n[[supports]]\nset = \"{set}\"\nkind = \"clamped\"\n{rest}");
        let case = Case::parse(&folder.path().join("c.toml"), &text).unwrap();
        let s = section(case.section().unwrap()).unwrap();
        solve_case(&case, s, &Options::default()).map(|r| r.w_max)
    };
    let from_file = solve("file = \"part.msh\"\nunit = \"mm\"", "held").unwrap();
    let generated =
        solve("shape = \"rectangle\"\nwidth = \"10 cm\"\nheight = \"10 cm\"\ncells = [2, 2]", "left")
            .unwrap();
    assert!((from_file / generated - 1.0).abs() < 1e-12, "{from_file} {generated}");
    let text = format!(
        "{head}[sheet]\nfile = \"part.msh\"\n[[supports]]\nset = \"held\"\nkind = \"clamped\"\n{rest}"
    );
    let error = Case::parse(&folder.path().join("c.toml"), &text).unwrap_err().to_string();
    assert!(error.contains("unit = \"mm\""), "{error}");
}

/// `[[rigid]]` end to end: a clamped strip whose end is a rigid clamp about its middle. Turned through 0.1 rad
/// and free to follow it is a circle (ν = 0): w = κ L²/2. Masses are chosen by name.
#[test]
fn a_rigid_clamp_follows_in_a_case() {
    let head = r#"
title = "t"
[section]
tensile_warp = "12000 N/m"
tensile_weft = "12000 N/m"
poisson = 0
shear = "6000 N/m"
bending_warp = "1 N·m"
bending_weft = "1 N·m"
bending_coupling = "0 N·m"
torsion = "0.5 N·m"
transverse_shear = "1e5 N/m"
areal_density = "1 kg/m²"
thickness = "1 mm"
[sheet]
shape = "strip"
width = "1 m"
height = "0.1 m"
cells = [8, 2]
[[supports]]
set = "left"
kind = "clamped"
"#;
    let clamp = "[[rigid]]\nname = \"clamp\"\nset = \"right\"\nat = [\"1.2 m\", \"5 cm\", \"0 m\"]\n";
    let turn = "[[loads]]\nkind = \"prescribed\"\nset = \"clamp\"\ndof = \"theta_y\"\nvalue = \"0.1 rad\"\n";
    let parse = |text: &str| Case::parse(Path::new("inline.toml"), text);
    let solve = |text: &str| {
        let case = parse(text).unwrap();
        let s = section(case.section().unwrap()).unwrap();
        solve_case(&case, s, &Options::default())
    };
    let result = solve(&format!("{head}{clamp}{turn}")).unwrap();
    // The point of reference lies off the sheet and is not part of its largest deflection.
    assert!((result.w_max / -0.05 - 1.0).abs() < 1e-9, "{}", result.w_max);
    let reference = result.model.mesh.set("clamp").unwrap()[0] as usize;
    let moment = result.solution.reaction[6 * reference + 4];
    assert!((moment / (0.1 * 0.1) - 1.0).abs() < 1e-9, "{moment}");
    assert!(result.nodal().unwrap().iter().all(|r| r.moment[0].is_finite()));
    let held = "[[supports]]\nset = \"right\"\nfix = [\"v\"]\n";
    assert_eq!(solve(&format!("{head}{held}{clamp}{turn}")).unwrap_err().code(), "M010");
    let twice = clamp.replace("\"clamp\"", "\"left\"");
    assert!(solve(&format!("{head}{twice}{turn}")).unwrap_err().to_string().contains("choose another"));

    let modal = |keys: &str| format!("{head}{clamp}[analysis]\nkind = \"modal\"\nmodes = 2\n{keys}");
    let first = |keys: &str| solve(&modal(keys)).unwrap().frequencies[0];
    assert_eq!(first(""), first("mass = \"lumped\""));
    assert_eq!(first("lumped = true"), first("mass = \"lumped\""));
    assert_eq!(first("lumped = false"), first("mass = \"consistent\""));
    assert!(
        first("mass = \"averaged\"") > first("") && first("mass = \"averaged\"") < first("lumped = false")
    );
    let both = parse(&modal("mass = \"lumped\"\nlumped = true")).unwrap_err();
    assert!(both.to_string().contains("remove `lumped`"), "{both}");
}

/// What only the mesh can tell stands at the value that it is about too, not at the first word that is the same.
#[test]
fn what_is_found_late_stands_where_it_is_written() {
    let text = text_of("kind = \"linear\"", PRESSURE);
    let text = text.replace("title = \"", "title = \"rim ");
    let line_of = |text: &str, word: &str| text[..text.rfind(word).unwrap()].matches('\n').count() + 1;
    let place = |text: &str| {
        let case = Case::parse(Path::new("c.toml"), text).unwrap();
        let error = kesf::study::validate(&case, &kesf::solve::Options::default()).unwrap_err();
        let place = Coded::place(&error).unwrap_or_else(|| panic!("{error}"));
        (error.code(), place.line, place.column)
    };
    let rim = text.replace("set = \"boundary\"", "set = \"rim\"");
    assert_eq!(place(&rim), ("M007", line_of(&rim, "set = \"rim\""), 7));
    let held = "[[supports]]\nset = \"left\"\nkind = \"free\"\n";
    let second = format!("{text}{held}{}", held.replace("left", "rim"));
    assert_eq!(place(&second), ("M007", line_of(&second, "set = \"rim\""), 7));
    let push = "[[loads]]\nkind = \"point\"\nset = \"rim\"\nvalue = \"1 N\"\ndirection = [0, 0, 1]\n";
    let pushed = format!("{text}{push}");
    assert_eq!(place(&pushed), ("M007", line_of(&pushed, "set = \"rim\""), 7));
    let inside =
        "[[loads]]\nkind = \"edge_force\"\nset = \"all\"\nvalue = \"1 N/m\"\ndirection = [0, 0, 1]\n";
    let prescribed =
        inside.replace("edge_force", "prescribed").replace("direction = [0, 0, 1]\n", "dof = \"w\"\n");
    let prescribed = format!("{text}{}", prescribed.replace("\"all\"", "\"rim\"").replace("1 N/m", "1 mm"));
    assert_eq!(place(&prescribed), ("M007", line_of(&prescribed, "set = \"rim\""), 7));
    let probe = format!("{text}[[probes]]\nname = \"rim\"\nat = [\"2 m\", \"0 m\"]\n");
    assert_eq!(place(&probe), ("S003", line_of(&probe, "at = [\"2 m\""), 6));
    let body = format!("{text}[[rigid]]\nname = \"left\"\nset = \"right\"\n");
    assert_eq!(place(&body), ("S003", line_of(&body, "name = \"left\""), 8));
}
