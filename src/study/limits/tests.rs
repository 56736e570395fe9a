//! What a reader is told of a model, and which models are refused.

use std::path::Path;

use crate::finding::Finding;
use crate::solve::Options;
use crate::study::{Case, CaseResult, StudyError, build, solve_case, validate};

/// A strip of 1 m x 0.1 m: t = 10 mm, E = 1 MPa, nu = 0.3; `SHEET` is its outline.
const STRIP: &str = r#"
title = "t"
[section]
tensile_warp = "10000 N/m"
tensile_weft = "10000 N/m"
poisson = 0.3
shear = "3846.15 N/m"
bending_warp = "0.091575 N·m"
bending_weft = "0.091575 N·m"
bending_coupling = "0.027473 N·m"
torsion = "0.032051 N·m"
transverse_shear = "3205 N/m"
areal_density = "1 kg/m²"
thickness = "1 cm"
[sheet]
SHEET
[[supports]]
set = "left"
kind = "clamped"
"#;

const OUTLINE: &str = "shape = \"rectangle\"\nwidth = \"1 m\"\nheight = \"0.1 m\"\ncells = [8, 2]";
const PRESSURE: &str = "[[loads]]\nkind = \"pressure\"\nvalue = \"1e-6 Pa\"\n";
const MOMENT: &str =
    "[[loads]]\nkind = \"edge_moment\"\nset = \"right\"\nvalue = \"1e-6 N\"\ndirection = [0, 0, 1]\n";
const PUSH: &str =
    "[[loads]]\nkind = \"edge_force\"\nset = \"right\"\nvalue = \"1e-6 N/m\"\ndirection = [0, 1, 0]\n";

fn prescribed(set: &str, dof: &str, value: &str) -> String {
    format!("[[loads]]\nkind = \"prescribed\"\nset = \"{set}\"\ndof = \"{dof}\"\nvalue = \"{value}\"\n")
}

fn solved_of(text: &str, path: &Path) -> Result<CaseResult, StudyError> {
    let case = Case::parse(path, text)?;
    let section = build::section(case.section().unwrap())?;
    solve_case(&case, section, &Default::default())
}

fn solved(text: &str) -> Result<CaseResult, StudyError> {
    solved_of(text, Path::new("c.toml"))
}

fn codes(more: &str) -> Vec<&'static str> {
    let result = solved(&format!("{}{more}", STRIP.replace("SHEET", OUTLINE))).unwrap();
    result.findings.iter().map(|f| f.code()).collect()
}

#[test]
fn cells_in_one_row_need_a_torsional_rigidity() {
    let limp = STRIP.replace("SHEET", OUTLINE).replace("0.032051", "0");
    for (cells, is_reported) in
        [("[3, 1]", true), ("[1, 2]", true), ("2", true), ("3", false), ("[2, 3]", false)]
    {
        let element = format!("{PRESSURE}[element]\nsubcells = {cells}\n");
        let result = solved(&format!("{limp}{element}")).unwrap();
        assert_eq!(result.findings.iter().any(|f| f.code() == "S102"), is_reported, "{cells}");
        assert_eq!(codes(&element), [""; 0], "{cells} with a torsional rigidity");
    }
    assert_eq!(codes(&format!("{PRESSURE}[element]\nsubcells = [1, 1]\n")), ["S102"]);
}

#[test]
fn the_profile_of_fourth_order_tells_of_sheets_that_it_is_not_for() {
    let strip = STRIP.replace("\"left\"", "\"boundary\"");
    let findings = |sheet: &str, text: &str| {
        let text = text.replace("SHEET", sheet);
        let element = "[element]\nprofile = \"fourth_order\"\nsubcells = 2\n";
        let mut findings = solved(&format!("{text}{PRESSURE}{element}")).unwrap().findings;
        findings.retain(|f| f.code() != "S101");
        findings.into_iter().map(|f| f.to_string()).collect::<Vec<_>>().join("\n")
    };
    let turned = |angle: u8| format!("{OUTLINE}\nwarp_angle_deg = {angle}");
    let limp = strip.replace("0.032051", "0");
    assert_eq!(findings(OUTLINE, &strip), "");
    assert_eq!(findings(&turned(90), &strip), "");
    assert_eq!(findings(&turned(20), &strip), "", "an isotropic sheet has no direction");
    assert_eq!(
        findings(&turned(90), &limp),
        "",
        "no motion is without energy, though cells in one row would leave one"
    );
    assert!(findings(&turned(20), &limp).contains("16 of 16 elements are no rectangles along warp and weft"));
    assert!(findings(&format!("{OUTLINE}\ndistortion = 0.2"), &strip).contains("no rectangles"));
    let simple = |kind: &str| strip.replace("kind = \"clamped\"", kind);
    assert_eq!(findings(OUTLINE, &simple("kind = \"simply_supported\"")), "");
    let soft = findings(OUTLINE, &simple("kind = \"simply_supported_soft\""));
    assert!(soft.contains("20 of 20 element sides at the boundary are free or softly supported"), "{soft}");
    assert!(findings(OUTLINE, STRIP).contains("18 of 20 element sides"), "{}", findings(OUTLINE, STRIP));
    let limp_free = STRIP.replace("0.032051", "0");
    assert_eq!(findings(OUTLINE, &limp_free), "", "without torsional rigidity an edge has no layer");
}

#[test]
fn the_profile_of_fourth_order_refuses_what_goes_against_it() {
    let refused = |more: &str| {
        let text = format!("{}{more}", STRIP.replace("SHEET", OUTLINE));
        solved(&format!("{text}\n[element]\nprofile = \"fourth_order\"\n")).unwrap_err().to_string()
    };
    let modal = "[analysis]\nkind = \"modal\"\nmodes = 1\n";
    assert!(refused(&format!("{modal}mass = \"consistent\"")).contains("goes with mass = \"lumped\""));
    assert!(refused(&format!("{PRESSURE}[analysis]\nkind = \"nonlinear\"")).contains("small rotations"));
    let text =
        format!("{}{PRESSURE}[element]\nprofile = \"fourth_order\"\n", STRIP.replace("SHEET", OUTLINE));
    let own = solved(&format!("{text}shear_stabilisation = 0.05\n")).unwrap_err().to_string();
    assert!(own.contains(":28:1: S003 `shear_stabilisation` is given by"), "{own}");
}

#[test]
fn the_seeds_drilling_spring_is_told_where_a_flat_sheet_moves_in_its_plane() {
    let seed = "[element]\nprofile = \"seed\"\n";
    assert_eq!(codes(&format!("{MOMENT}{seed}")), ["S103", "S158"]);
    assert_eq!(codes(&format!("{PUSH}[element]\ndrilling = \"seed\"\n")), ["S103"]);
    assert_eq!(codes(&format!("{PRESSURE}{seed}")), [""; 0]);
    assert_eq!(codes(MOMENT), ["S158"]);
    let modal = "[analysis]\nkind = \"modal\"\nmodes = ";
    assert_eq!(codes(&format!("{modal}1\n{seed}")), [""; 0], "the lowest mode is one of bending");
    assert_eq!(codes(&format!("{modal}8\n{seed}")), ["S103"]);
}

#[test]
fn a_membrane_of_one_cell_is_for_large_rotations() {
    let one = "[element]\nmembrane = \"one_cell\"\n";
    assert_eq!(codes(&format!("{PUSH}{one}")), ["S107"]);
    assert_eq!(codes(&format!("{PRESSURE}{one}")), [""; 0]);
    let newmark = "[analysis]\nkind = \"newmark\"\nduration = \"2 ms\"\nstep = \"1 ms\"\n";
    assert_eq!(codes(&format!("{PUSH}{one}{newmark}")), ["S107"]);
    assert_eq!(codes(&format!("{PUSH}{one}{newmark}large_rotations = true\n")), [""; 0]);
    assert_eq!(codes(&format!("{PUSH}{one}[analysis]\nkind = \"nonlinear\"\n")), [""; 0]);
}

#[test]
fn a_prescribed_rotation_in_the_plane_belongs_to_a_body() {
    assert_eq!(codes(&prescribed("right", "theta_z", "1e-6 rad")), ["S109"]);
    assert_eq!(codes(&format!("{PRESSURE}{}", prescribed("right", "theta_z", "0 rad"))), [""; 0]);
    assert_eq!(codes(&prescribed("right", "theta_y", "1e-6 rad")), [""; 0]);
    let body = "[[rigid]]\nname = \"clamp\"\nset = \"right\"\n";
    assert_eq!(codes(&format!("{body}{}", prescribed("clamp", "theta_z", "1e-6 rad"))), [""; 0]);
}

#[test]
fn contradictions_of_loads_are_refused() {
    let refused = |text: &str, more: &str| {
        let text = format!("{}{more}", text.replace("SHEET", OUTLINE));
        solved(&text).unwrap_err()
    };
    let [low, high] = ["1 um", "2 um"].map(|value| prescribed("right", "w", value));
    let e = refused(STRIP, &format!("{low}{}", prescribed("top", "w", "2 um")));
    assert_eq!(e.code(), "M014");
    assert!(e.to_string().contains("w of the node at (1, 0.1, 0) m"), "{e}");
    assert_eq!(refused(STRIP, &format!("{low}{high}")).code(), "M014");
    assert_eq!(codes(&format!("{low}{low}{}", prescribed("left", "w", "3 um"))), [""; 0]);
    // Weight without mass.
    let massless = STRIP.replace("1 kg/m²", "0 kg/m²");
    let gravity = "[[loads]]\nkind = \"gravity\"\n";
    assert_eq!(refused(&massless, gravity).code(), "N008");
    let text = format!("{}{gravity}", massless.replace("SHEET", OUTLINE));
    let case = Case::parse(Path::new("c.toml"), &text).unwrap();
    assert_eq!(validate(&case, &Options::default()).unwrap_err().code(), "N008");
    assert!(solved(&format!("{}{PRESSURE}", massless.replace("SHEET", OUTLINE))).is_ok());
}

/// Gmsh text of two squares of 1 m side by side, `second` the nodes of the second one, upright if asked.
fn two_squares(second: [u64; 4], upright: bool) -> String {
    let mut msh = String::from(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"left\"\n$EndPhysicalNames\n",
    );
    msh += "$Entities\n0 1 1 0\n3 0 0 0 0 1 0 1 7 0\n1 0 0 0 2 1 0 0 0\n$EndEntities\n";
    msh += "$Nodes\n1 8 1 8\n2 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n";
    for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1), (1, 0), (2, 0), (1, 1), (2, 1)] {
        msh += &if upright { format!("{x} 0 {y}\n") } else { format!("{x} {y} 0\n") };
    }
    let [a, b, c, d] = second;
    msh += "$EndNodes\n$Elements\n2 3 1 3\n1 3 1 1\n1 1 3\n2 1 3 2\n2 1 2 4 3\n";
    msh + &format!("3 {a} {b} {c} {d}\n$EndElements\n")
}

#[test]
fn what_a_mesh_file_alone_can_have() {
    let folder = tempfile::tempdir().unwrap();
    let solve = |second: [u64; 4], upright: bool, sheet: &str| {
        std::fs::write(folder.path().join("two.msh"), two_squares(second, upright)).unwrap();
        let sheet = format!("file = \"two.msh\"\nunit = \"m\"\n{sheet}");
        let text = format!("{}{PRESSURE}", STRIP.replace("SHEET", &sheet));
        // The second square alone hangs on nothing.
        let held = "[[supports]]\nset = \"all\"\nfix = [\"u\", \"v\", \"w\", \"theta_x\"]\n";
        solved_of(&format!("{text}{held}"), &folder.path().join("c.toml"))
    };
    let (joined, apart) = ([2, 6, 8, 4], [5, 6, 8, 7]);
    let whole: Vec<_> = solve(joined, false, "").unwrap().findings.iter().map(Finding::code).collect();
    assert_eq!(whole, ["S159"], "pressed where every node is held");
    let cut = solve(apart, false, "").unwrap();
    assert_eq!(cut.findings[0].code(), "S108");
    let message = &cut.findings[0].message();
    assert!(message.contains("4 nodes") && message.contains("(1.000, 0, 0) m"), "{message}");
    // Upright, an angle from x and a displacement along x and y have no meaning.
    let refused = |sheet: &str| solve(joined, true, sheet).unwrap_err();
    assert!(refused("warp_angle_deg = 30").to_string().contains("warp = [1, 0, 0]"));
    assert_eq!(refused("distortion = 0.2").code(), "M006");
    assert_eq!(refused("warp = [0, 1, 0]").code(), "M008");
    assert!(solve(joined, true, "warp = [0, 0, 1]").is_ok());
    assert!(solve(joined, false, "warp_angle_deg = 30").is_ok());
}
