//! The same input gives the same bytes, whatever the threads, the order of the inputs, the language and the clock.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::{code, kesf, stderr, tree};

const INPUTS: [&str; 5] = [
    "kesf_data/poplin",
    "kesf_data/petrak_m1",
    "kesf_data/petrak_m2",
    "cases/cantilever_strip.toml",
    "cases/virtual_bending.toml",
];

/// Results of a run with options, inputs in an order, and variables of the environment.
fn run(options: &[&str], inputs: &[&str], variables: &[(&str, &str)]) -> BTreeMap<String, Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let done = kesf()
        .args(["run", "--no-charts"])
        .args(options)
        .args(inputs)
        .arg("-o")
        .arg(&out)
        .envs(variables.iter().copied())
        .output()
        .unwrap();
    assert!([0, 1].contains(&code(&done)), "{}", stderr(&done));
    tree(&out)
}

fn assert_same(what: &str, expected: &BTreeMap<String, Vec<u8>>, found: &BTreeMap<String, Vec<u8>>) {
    assert!(expected.keys().eq(found.keys()), "{what}: other files");
    for (name, bytes) in expected {
        assert!(bytes == &found[name], "{what}: {name} differs");
    }
}

#[test]
fn neither_threads_nor_language_nor_clock_change_a_byte() {
    let expected = run(&["-j", "1"], &INPUTS, &[]);
    for threads in ["2", "8"] {
        assert_same(&format!("-j {threads}"), &expected, &run(&["-j", threads], &INPUTS, &[]));
    }
    let languages = [("LC_ALL", "de_DE.UTF-8"), ("LANG", "tr_TR.UTF-8"), ("LANGUAGE", "ja")];
    assert_same("language", &expected, &run(&["-j", "2"], &INPUTS, &languages));
    assert_same("time zone", &expected, &run(&["-j", "2"], &INPUTS, &[("TZ", "Asia/Kathmandu")]));
}

/// The order of the inputs is the order of rows, and changes nothing else: no file of a fabric, and no row.
#[test]
fn the_order_of_the_inputs_changes_the_order_of_rows_only() {
    let mut reversed = INPUTS;
    reversed.reverse();
    let (expected, found) = (run(&[], &INPUTS, &[]), run(&[], &reversed, &[]));
    assert!(expected.keys().eq(found.keys()));
    for (name, bytes) in &expected {
        let is_of_fabric = name.contains('/');
        if is_of_fabric && !name.ends_with(".kesf-record.json") {
            assert!(bytes == &found[name], "{name} differs");
        } else if name.ends_with(".csv") {
            let sorted = |bytes: &[u8]| {
                let text = String::from_utf8(bytes.to_vec()).unwrap();
                let mut rows: Vec<String> = text.lines().map(str::to_string).collect();
                rows.sort();
                rows
            };
            assert_eq!(sorted(bytes), sorted(&found[name]), "{name}");
        }
    }
}

/// The same inputs, named in the same way in two folders that stand in different places: the same bytes. A path is kept
/// as it was typed, so that none of it says where the folder stands.
#[test]
fn the_folder_that_the_inputs_stand_in_changes_no_byte() {
    let places = ["here", "somewhere/else and further"];
    let all = places.map(|place| {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join(place);
        for input in INPUTS {
            let from = Path::new(env!("CARGO_MANIFEST_DIR")).join(input);
            let files =
                if from.is_dir() { tree(&from) } else { [(String::new(), fs::read(&from).unwrap())].into() };
            for (name, bytes) in files {
                let to = if name.is_empty() { folder.join(input) } else { folder.join(input).join(name) };
                fs::create_dir_all(to.parent().unwrap()).unwrap();
                fs::write(to, bytes).unwrap();
            }
        }
        let done = kesf()
            .current_dir(&folder)
            .args(["run", "--no-charts"])
            .args(INPUTS)
            .args(["-o", "results"])
            .output()
            .unwrap();
        assert!([0, 1].contains(&code(&done)), "{}", stderr(&done));
        tree(&folder.join("results"))
    });
    assert_same("folder", &all[0], &all[1]);
}
