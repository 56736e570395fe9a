//! What the command makes of its arguments: standard input, names that are no names of folders, fabrics that are not
//! where a case says, and checks that do not hold.
//!
//! Inputs are the folders that ship with the package and small files written here.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/kesf_data");

fn run_in(folder: &Path, arguments: &[&str], stdin: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kesf"));
    command.current_dir(folder).args(arguments).stdin(Stdio::piped());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(stdin.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

fn status_and_errors(output: &Output) -> (i32, String) {
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn copy(fabric: &str, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(Path::new(DATA).join(fabric)).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
    }
}

/// A square sheet on its rim under a pressure, on line 13 of the file.
fn case(fabric: &str, more: &str) -> String {
    format!(
        "title = \"t\"\nfabric = \"{fabric}\"\n[sheet]\nshape = \"rectangle\"\nwidth = \"20 cm\"\nheight = \"20 cm\"\n\
         cells = [4, 4]\n{more}[[supports]]\nset = \"boundary\"\nkind = \"clamped\"\n[[loads]]\nkind = \"pressure\"\n\
         value = \"1e-6 Pa\"\n[[probes]]\nname = \"centre\"\nat = [\"10 cm\", \"10 cm\"]\n"
    )
}

#[test]
fn standard_input_may_be_a_sheet_or_a_case() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let fabric = format!("{DATA}/poplin");
    let sheet = run_in(here, &["characterise", &fabric, "--json", "-q"], "");
    let sheet = String::from_utf8(sheet.stdout).unwrap();
    let matrices = |arguments: &[&str], stdin: &str| -> Value {
        let document: Value = serde_json::from_slice(&run_in(here, arguments, stdin).stdout).unwrap();
        document["sections"][0]["d_b"].clone()
    };
    let direct = matrices(&["section", &fabric, "--json", "-q"], "");
    assert_eq!(matrices(&["section", "-", "--json", "-q"], &sheet), direct);

    fs::write(here.join("file.toml"), case(&fabric, "")).unwrap();
    let w = |input: &str, stdin: &str| -> Value {
        let output = run_in(here, &["solve", input, "--json", "-q"], stdin);
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        document["solutions"][0]["results"]["w_max"].clone()
    };
    let (piped, named) = (w("-", &case(&fabric, "")), w("file.toml", ""));
    assert!(piped["value"].as_f64().unwrap() > 0.0);
    assert_eq!(piped, named);
}

#[test]
fn several_files_do_not_go_to_standard_output() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("c.toml"), case(&format!("{DATA}/poplin"), "")).unwrap();
    for command in ["solve", "run"] {
        let (code, text) = status_and_errors(&run_in(folder.path(), &[command, "c.toml", "-o", "-"], ""));
        assert!(code == 2 && text.contains("O050"), "{command}: {text}");
    }
    assert!(!folder.path().join("-").exists());
}

#[test]
fn a_check_that_fails_and_a_set_that_is_missing_are_told_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let fabric = format!("{DATA}/poplin");
    let check = "[[checks]]\nquantity = \"centre.w\"\nexpected = \"1 mm\"\nrelative_tolerance = 0.02\n\
                 reference = { kind = \"own\", source = \"s\" }\n";
    fs::write(here.join("c.toml"), case(&fabric, "") + check).unwrap();
    let output = run_in(here, &["run", &fabric, "c.toml", "-o", "out", "--no-charts"], "");
    assert_eq!(output.status.code(), Some(1));
    let problems = fs::read_to_string(here.join("out/problems.csv")).unwrap();
    assert!(problems.contains("c.toml:18:12,S122"), "{problems}");
    for (from, to, expected) in [
        ("0.02", "inf", "c.toml:20:22: S003"),
        ("0.02", "-0.5", "c.toml:20:22: S003"),
        ("boundary", "nowhere", "c.toml:9:7: M007"),
        ("1e-6 Pa", "1e-6 m", "c.toml:13:9: S002"),
        ("value = \"1e-6 Pa\"\n", "", "c.toml:11:1: S002 missing key `value`"),
    ] {
        fs::write(here.join("c.toml"), (case(&fabric, "") + check).replace(from, to)).unwrap();
        let (code, text) = status_and_errors(&run_in(here, &["solve", "c.toml"], ""));
        assert!(code == 2 && text.contains(expected), "{to}: {text}");
    }
}

/// Files that are read with the measurements beside them are none themselves.
#[test]
fn a_description_is_no_measurement() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("fabric.toml"), "name = \"x\"\n").unwrap();
    fs::write(here.join("drape.toml"), "[[results]]\nquantity = \"drape_coefficient\"\nvalue = \"50 %\"\n")
        .unwrap();
    for name in ["fabric.toml", "drape.toml"] {
        let (code, said) = status_and_errors(&run_in(here, &["check", name], ""));
        let expected = format!("{name}: R027 {name} says something of the fabric in its folder");
        assert!(code == 2 && said.contains(&expected), "{code} {said}");
    }
}

#[test]
fn keys_that_have_no_effect_and_points_off_the_sheet_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let plain = case(&format!("{DATA}/poplin"), "");
    let drape = fs::read_to_string(format!("{DATA}/../cases/drape.toml")).unwrap();
    let section = fs::read_to_string(format!("{DATA}/../cases/self_weight_clamped.toml")).unwrap();
    let section = section[section.find("[section]").unwrap()..].split("\n\n").next().unwrap().to_string();
    let probe = |at: &str| format!("{plain}[[probes]]\nname = \"p\"\nat = {at}\n");
    for (text, expected) in [
        (plain.replace("[sheet]\n", "[sheet]\nseed = 3\n"), "and there is none"),
        (plain.replace("[sheet]\n", "[sheet]\ncels = [2, 2]\n"), "did you mean `cells`?"),
        (drape.replace("[sheet]\n", "[sheet]\ndistortion = 0.1\n"), "the mesh of a drape is not distorted"),
        (
            drape.replace("fabric = ", "# ").replace("sizes = \"measured\"", "shaking = 0.5")
                + "\n"
                + &section
                + "\n",
            "friction of a measured fabric",
        ),
        (probe("[\"5 cm\", \"5 cm\", \"1 mm\"]"), "lies outside the sheet"),
    ] {
        fs::write(here.join("c.toml"), &text).unwrap();
        let (code, said) = status_and_errors(&run_in(here, &["check", "c.toml"], ""));
        assert!(code == 2 && said.contains(expected), "{expected}: {said}\n{text}");
    }
    // In the plane it is found.
    fs::write(here.join("c.toml"), probe("[\"5 cm\", \"5 cm\", \"0 mm\"]")).unwrap();
    let (code, said) = status_and_errors(&run_in(here, &["check", "c.toml"], ""));
    assert!(code == 0, "{said}");
}

#[test]
fn the_fabric_of_a_case_that_is_nowhere_or_twice() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::create_dir(here.join("cases")).unwrap();
    fs::write(here.join("cases/c.toml"), case("cloth", "")).unwrap();
    for command in ["solve", "check"] {
        let (code, text) = status_and_errors(&run_in(here, &[command, "cases/c.toml"], ""));
        assert!(
            code > 0 && text.starts_with("cases/c.toml:2:10: O055") && text.lines().count() == 1,
            "{text}"
        );
    }
    copy("petrak_m1", &here.join("cases/cloth"));
    let (code, text) = status_and_errors(&run_in(here, &["solve", "cases/c.toml"], ""));
    assert!(code == 0 && !text.contains("O060"), "{text}");
    copy("petrak_m2", &here.join("cloth"));
    let (code, text) =
        status_and_errors(&run_in(here, &["solve", "cases/c.toml", &format!("{DATA}/twill")], ""));
    assert!(code == 0 && text.contains("cases/c.toml:2:10: O060"), "{text}");
    assert!(
        text.contains("not used, as every case names its own fabric or has a [section]: twill"),
        "{text}"
    );
}

#[test]
fn the_nodes_inside_a_radius_are_a_set() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let fabric = format!("{DATA}/poplin");
    // The middle node and its four neighbours, 5 cm away.
    let held = case(&fabric, "inside_radius = \"5 cm\"\n").replace("\"boundary\"", "\"inside_radius\"");
    fs::write(here.join("c.toml"), held.replace("[\"10 cm\", \"10 cm\"]", "[\"15 cm\", \"10 cm\"]")).unwrap();
    let output = run_in(here, &["solve", "c.toml", "--json", "-q"], "");
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let results = &document["solutions"][0]["results"];
    assert_eq!(results["probes"]["centre"]["u"][2].as_f64(), Some(0.0));
    assert!(results["w_max"]["value"].as_f64().unwrap() > 0.0);
    let (code, text) =
        status_and_errors(&run_in(here, &["solve", "-"], &held.replace("\"5 cm\"", "\"-1 cm\"")));
    assert!(code == 2 && text.contains("S003"), "{text}");
}

#[test]
fn fabrics_called_like_the_tables_of_a_run_or_alike_but_for_case() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for name in ["fabrics.csv", "cases", "aux"] {
        copy("petrak_m1", &here.join("lab").join(name));
    }
    copy("petrak_m2", &here.join("lab/Cloth"));
    copy("petrak_m3", &here.join("lab/cloth"));
    let output = run_in(here, &["run", "lab", "-o", "out", "--no-charts", "-q"], "");
    assert_eq!(output.status.code(), Some(0));
    for name in ["fabric-fabrics.csv", "fabric-cases", "fabric-aux", "Cloth"] {
        assert!(here.join("out").join(name).join("sheet.json").is_file(), "{name}");
    }
    assert!(here.join("out/cloth-2/sheet.json").is_file());
    assert!(here.join("out/fabrics.csv").is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_utf_8_stops_nothing() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    copy("petrak_m1", &here.join("lab").join(OsStr::from_bytes(b"algod\xe3o")));
    copy("petrak_m2", &here.join("lab/cloth"));
    for arguments in [
        &["run", "lab", "-o", "out", "--no-charts"][..],
        &["check", "lab", "--json"],
        &["read", "lab", "--json"],
        &["characterise", "lab", "--json"],
        &["export", "lab", "--to", "u3m", "-o", "cards"],
    ] {
        let (code, text) = status_and_errors(&run_in(here, arguments, ""));
        assert_eq!(code, 0, "{arguments:?}: {text}");
    }
    assert!(here.join("out/index.html").is_file());
    // A place without an ending is a folder where there are several cards.
    assert_eq!(
        fs::read_dir(here.join("cards")).unwrap().filter(|e| e.is_ok()).count(),
        3,
        "and the manifest"
    );
}

/// A table of two fabrics is two from standard input as from disk; their values were averaged.
#[test]
fn a_table_of_several_fabrics_on_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    let table = "Fabric,B (gf·cm²/cm) warp\nF1,0.08\nF2,0.2\n";
    let found: Value =
        serde_json::from_slice(&run_in(folder.path(), &["characterise", "-", "--json", "-q"], table).stdout)
            .unwrap();
    let names: Vec<&str> =
        found["fabrics"].as_array().unwrap().iter().map(|f| f["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["F1", "F2"]);
    assert_eq!(found["fabrics"][1]["parameters"]["B"]["warp"]["n"], 1);
    // A file that names nothing is called after where it comes from.
    let bare = "Direction,B (gf·cm²/cm)\nwarp,0.08\n";
    let found: Value =
        serde_json::from_slice(&run_in(folder.path(), &["characterise", "-", "--json", "-q"], bare).stdout)
            .unwrap();
    assert_eq!(found["fabrics"][0]["name"], "stdin");
    // And so when it is read again for a run.
    let output = run_in(folder.path(), &["run", "-", "--no-charts", "-o", "out", "-q"], table);
    let rows = fs::read_to_string(folder.path().join("out/fabrics.csv")).unwrap();
    assert!(rows.contains("F1") && rows.contains("F2"), "{rows}{:?}", status_and_errors(&output));
}
