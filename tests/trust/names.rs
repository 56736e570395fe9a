//! Names and line ends of other systems: what is written here can be written there, and what comes from there is read.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use unicode_normalization::UnicodeNormalization;

use crate::{code, first_cells, run, stderr, tree, write};

/// Names of fabrics that are no names of folders somewhere.
const NAMES: [&str; 11] =
    ["CON", "nul.txt", "com1", "grey.", "Poplin", "poplin", "köper", "a:b?", "../up", "a/b", "run.json"];

/// Whether Windows takes a name for a device; not by the code that is tested.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap().trim().to_uppercase();
    let port = |kind| stem.strip_prefix(kind).is_some_and(|n: &str| n.chars().count() == 1);
    ["CON", "PRN", "AUX", "NUL"].contains(&stem.as_str()) || port("COM") || port("LPT")
}

#[test]
fn every_name_can_be_written_on_every_system() {
    let folder = tempfile::tempdir().unwrap();
    let [lab, out] = ["lab", "out"].map(|name| folder.path().join(name));
    let long = "ü".repeat(300);
    let names: Vec<&str> = NAMES.into_iter().chain([long.as_str()]).collect();
    let mut table = "fabric,B warp (gf·cm²/cm),B weft (gf·cm²/cm),W (mg/cm²)\n".to_string();
    for (k, name) in names.iter().enumerate() {
        table += &format!("\"{name}\",{},{},10\n", 0.1 + 0.01 * (k * k) as f64, 0.3 - 0.002 * (k * k) as f64);
    }
    write(&lab, "t.csv", &table);
    let case = fs::read_to_string("cases/cantilever_strip.toml").unwrap();
    write(&lab, "aux.toml", &case);
    let inputs = [lab.join("t.csv"), lab.join("aux.toml")].map(|path| path.to_str().unwrap().to_string());
    let done = run(&["run", "--no-charts", &inputs[0], &inputs[1], "-o", out.to_str().unwrap()]);
    assert_eq!(code(&done), 0, "{}", stderr(&done));
    assert!(stderr(&done).contains("\"aux\" cannot be the name of a file"), "{}", stderr(&done));
    assert_eq!(first_cells(&out.join("fabrics.csv")).len(), names.len());

    let mut seen = BTreeSet::new();
    for path in tree(&out).into_keys() {
        for part in Path::new(&path).iter().map(|part| part.to_str().unwrap()) {
            assert!(!is_device(part) && !part.ends_with(['.', ' ']) && part.len() <= 255, "{path}");
            assert!(!part.contains(|c: char| c.is_control() || "<>:\"\\|?*".contains(c)), "{path}");
        }
        assert!(
            seen.insert(path.nfc().collect::<String>().to_lowercase()),
            "{path} is there twice elsewhere"
        );
    }
    assert!(seen.iter().filter(|path| path.ends_with("sheet.json")).count() == names.len());
}

/// A copy with the line ends of Windows.
fn with_crlf(from: &Path, to: &Path) {
    if from.is_dir() {
        fs::create_dir_all(to).unwrap();
        for entry in fs::read_dir(from).unwrap() {
            let path = entry.unwrap().path();
            with_crlf(&path, &to.join(path.file_name().unwrap()));
        }
    } else if let Ok(text) = fs::read_to_string(from) {
        fs::write(to, text.replace("\r\n", "\n").replace('\n', "\r\n")).unwrap();
    } else {
        fs::copy(from, to).unwrap();
    }
}

#[test]
fn the_line_ends_of_windows_change_no_number() {
    const INPUTS: [&str; 5] = [
        "kesf_data/poplin",
        "kesf_data/satin",
        "kesf_data/petrak_m1",
        "cases/cantilever_strip.toml",
        "cases/virtual_bending.toml",
    ];
    let folder = tempfile::tempdir().unwrap();
    let results = |inputs: [String; 5], out: &str| {
        let out = folder.path().join(out);
        let inputs = inputs.iter().map(String::as_str);
        let arguments: Vec<&str> =
            ["run", "--no-charts", "-o", out.to_str().unwrap()].into_iter().chain(inputs).collect();
        let done = run(&arguments);
        assert_eq!(code(&done), 0, "{}", stderr(&done));
        ["fabrics.csv", "predictions.csv"].map(|name| fs::read_to_string(out.join(name)).unwrap())
    };
    let copies = INPUTS.map(|input| {
        let to = folder.path().join(input);
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        with_crlf(Path::new(input), &to);
        to.to_str().unwrap().to_string()
    });
    assert_eq!(results(INPUTS.map(String::from), "here"), results(copies, "there"));
}
