//! Goal: sheets from drawings are solved as what they show, and what a case asks of them is refused where it has no meaning.
//!
//! Data: discs, squares and a patch that are drawn here (DXF, SVG), isotropic with ν = 0.3. References (analytical): the clamped disc
//! q R⁴ / (64 D), Navier's series of the supported square, the clamped square by `kesf::analytical`, the ring of
//! `examples/imported/patch.toml`.

use std::path::{Path, PathBuf};

use kesf::solve::Options;
use kesf::study::{Case, CaseResult, section, solve_case};

const SECTION: &str = "title = \"drawn\"\n[section]\ntensile_warp = \"600 N/m\"\ntensile_weft = \"600 N/m\"\npoisson = 0.3\nshear = \"230 N/m\"\n\
     bending_warp = \"8e-6 N·m\"\nbending_weft = \"8e-6 N·m\"\nbending_coupling = \"2.4e-6 N·m\"\ntorsion = \"2.8e-6 N·m\"\n\
     transverse_shear = \"200 N/m\"\nareal_density = \"0.15 kg/m²\"\nthickness = \"0.4 mm\"\n";
/// Bending stiffness (N·m).
const D: f64 = 8e-6;
/// Pressure of the cases (Pa).
const Q: f64 = 1e-6;

fn solved(path: &Path, text: &str) -> CaseResult {
    let case = Case::parse(path, text).unwrap();
    solve_case(&case, section(case.section().unwrap()).unwrap(), &Options::default()).unwrap()
}

fn pressed(sheet: &str, kind: &str, at: &str) -> String {
    format!(
        "{SECTION}[sheet]\n{sheet}\n[[supports]]\nset = \"outer\"\nkind = \"{kind}\"\n[[loads]]\nkind = \"pressure\"\n\
         value = \"1e-6 Pa\"\n[[probes]]\nname = \"centre\"\nat = [{at}]\n"
    )
}

/// A folder with these files, and the path of a case in it.
fn folder(files: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let case = folder.path().join("case.toml");
    (folder, case)
}

const DISC: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"300mm\" height=\"300mm\" viewBox=\"0 0 300 300\">\n\
     <circle cx=\"150\" cy=\"150\" r=\"100\"/>\n</svg>\n";

/// A square of 200 mm, its lower left corner at the origin.
const SQUARE: &str = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n5\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n5\n2F\n8\ncut\n90\n4\n70\n1\n\
     10\n0\n20\n0\n10\n20\n20\n0\n10\n20\n20\n20\n10\n0\n20\n20\n0\nTEXT\n8\ncut\n10\n1\n20\n1\n40\n1\n1\nfront\n0\nENDSEC\n0\nEOF\n";

#[test]
fn a_clamped_disc_of_a_drawing_comes_to_its_closed_form() {
    let (_folder, path) = folder(&[("disc.svg", DISC)]);
    let exact = Q * 0.1f64.powi(4) / (64.0 * D);
    let mut errors = Vec::new();
    for cell in [12, 6] {
        let sheet = format!("outline = \"disc.svg\"\ncell = \"{cell} mm\"");
        let result = solved(&path, &pressed(&sheet, "clamped", "\"150 mm\", \"150 mm\""));
        let error = result.probes[0].value.u[2] / exact - 1.0;
        println!("disc, {cell} mm: {} elements, {:.3} %", result.model.mesh.quads.len(), 100.0 * error);
        errors.push(error.abs());
    }
    assert!(errors[0] < 0.03 && errors[1] < 0.01, "{errors:?}");
}

#[test]
fn squares_of_a_drawing_come_to_their_series() {
    let (_folder, path) = folder(&[("square.dxf", SQUARE)]);
    // Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells (1959), tables 8 and 35.
    for (kind, factor) in [("simply_supported_soft", 0.00406235), ("clamped", 0.00126532)] {
        let text = pressed("outline = \"square.dxf\"\ncell = \"7 mm\"", kind, "\"100 mm\", \"100 mm\"");
        let result = solved(&path, &text);
        let exact = factor * Q * 0.2f64.powi(4) / D;
        let error = result.probes[0].value.u[2] / exact - 1.0;
        println!("square, {kind}: {} elements, {:.3} %", result.model.mesh.quads.len(), 100.0 * error);
        assert!(error.abs() < 0.01, "{kind}: {error}");
        let findings: Vec<String> = result.findings.iter().map(ToString::to_string).collect();
        let left_out = findings.iter().find(|f| f.contains("S154"));
        assert!(
            left_out.is_some_and(|f| f.contains("square.dxf:") && f.contains("1 of TEXT")),
            "{findings:?}"
        );
    }
}

#[test]
fn the_shipped_patch_holds_its_check() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/imported/patch.toml");
    let result = solved(&path, &std::fs::read_to_string(&path).unwrap());
    println!("patch: {} elements, {:?}", result.model.mesh.quads.len(), result.checks[0].relative_error);
    assert!(result.checks[0].passed, "{:?}", result.checks[0]);
    assert_eq!(result.model.mesh.set("eyelet").unwrap(), result.model.mesh.set("inner").unwrap());
}

#[test]
fn large_rotations_take_a_drawn_sheet_too() {
    let (_folder, path) = folder(&[("square.dxf", SQUARE)]);
    let sheet = "outline = \"square.dxf\"\ncell = \"20 mm\"\nlayer = \"cut\"\nwarp_angle_deg = 30";
    let text = pressed(sheet, "clamped", "\"100 mm\", \"100 mm\"");
    let result = solved(&path, &(text + "[analysis]\nkind = \"nonlinear\"\n"));
    let linear = 0.00126532 * Q * 0.2f64.powi(4) / D;
    assert!((result.probes[0].value.u[2] / linear - 1.0).abs() < 0.05);
}

#[test]
fn a_case_is_refused_where_a_key_has_no_meaning() {
    let good = "outline = \"disc.svg\"\ncell = \"6 mm\"";
    for (sheet, more, line, message) in [
        ("outline = \"disc.svg\"".into(), "", 15, "needs `cell`"),
        ("outline = \"disc.svg\"\ncell = \"0 mm\"".into(), "", 16, "a length above 0"),
        (format!("{good}\ncells = [3, 3]"), "", 17, "brings its own sizes"),
        (format!("{good}\ndistortion = 0.1"), "", 17, "does not use `distortion`"),
        (format!("{good}\nfile = \"a.msh\""), "", 17, "one of `shape`, `file` and `outline`"),
        (format!("{good}\nshape = \"disc\""), "", 15, "one of `shape`, `file` and `outline`"),
        (format!("{good}\nunit = \"parsec\""), "", 17, "unit"),
        ("file = \"a.msh\"\nunit = \"mm\"\ncell = \"6 mm\"".into(), "", 17, "does not use `cell`"),
        (
            "shape = \"disc\"\ndiameter = \"1 m\"\ncells = [3, 3]\nlayer = \"a\"".into(),
            "",
            18,
            "does not use `layer`",
        ),
        (good.into(), "[convergence]\nmeshes = 2\n", 0, "a drawing has none"),
        (good.into(), "[adaptive]\nerror = \"5 %\"\n", 0, "a drawing has none"),
    ] {
        let text = pressed(&sheet, "clamped", "\"0 m\", \"0 m\"") + more;
        let error = Case::parse(Path::new("case.toml"), &text).unwrap_err().to_string();
        let at = if line > 0 { format!("case.toml:{line}:") } else { "case.toml:".into() };
        assert!(error.contains(message) && error.starts_with(&at), "{sheet}: {error}");
    }
    // What only the drawing shows is told at its line, or at the drawing.
    let (_folder, path) = folder(&[("disc.svg", &DISC.replace("r=\"100\"", "r=\"-1\""))]);
    for (sheet, message) in [(good, "disc.svg:2"), ("outline = \"none.svg\"\ncell = \"1 mm\"", "none.svg: ")]
    {
        let case = Case::parse(&path, &pressed(sheet, "clamped", "\"0 m\", \"0 m\"")).unwrap();
        let made = section(case.section().unwrap()).unwrap();
        let error = solve_case(&case, made, &Options::default()).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("M021") && error.contains(message), "{error}");
    }
}
