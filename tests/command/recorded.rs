//! Every number of the main job and of the verification suite, against a table that was recorded before the
//! application moved from the command into the library.
//!
//! Goal: a change of structure changes no number. Reference: our own output (kind `own`), so this guards against
//! change and proves nothing else.
//!
//! A machine with other vector instructions sums in another order, and its last digits differ. There a number may
//! differ by 1e-7 of itself, as the searches in large rotations end at a residual of 1e-8 of the load; how many
//! numbers differ at all is printed.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// What the order of summation may change, relative to the number.
const ROUNDING: f64 = 1e-7;

/// Verification lines whose value is itself a rounding error (such as the residual of a patch test) are equal when both
/// are below this.
const NOISE: f64 = 1e-8;

fn recorded(name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/recorded").join(name)).unwrap()
}

/// Rows of a CSV table.
fn rows(text: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    reader.records().map(|r| r.unwrap().iter().map(str::to_string).collect()).collect()
}

/// Compares cell by cell; returns how many numbers are equal only within rounding.
fn compare(name: &str, expected: &str, found: &str) -> usize {
    let (expected, found) = (rows(expected), rows(found));
    assert_eq!(expected.len(), found.len(), "{name}: another number of rows");
    let mut rounded = 0;
    for (line, (e, f)) in expected.iter().zip(&found).enumerate() {
        assert_eq!(e.len(), f.len(), "{name}:{}: another number of columns", line + 1);
        for (heading, (e, f)) in expected[0].iter().zip(e.iter().zip(f)).filter(|(_, (e, f))| e != f) {
            let close = match (e.parse::<f64>(), f.parse::<f64>()) {
                // A fraction of what was measured: that of a closed loop is nothing but rounding.
                (Ok(e), Ok(f)) if heading == "error" => (e - f).abs() <= ROUNDING,
                (Ok(e), Ok(f)) => (e - f).abs() <= ROUNDING * e.abs().max(f.abs()),
                _ => false,
            };
            assert!(close, "{name}:{}: {f} where {e} was recorded", line + 1);
            rounded += 1;
        }
    }
    rounded
}

#[test]
fn the_main_job_gives_the_numbers_that_were_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let run = Command::new(env!("CARGO_BIN_EXE_kesf"))
        // Drapes end at a residual of 1e-6, and have fewer digits that stay: they are held in `study::drape`.
        .args(["run", "kesf_data", "cases", "--drape=never", "--no-charts", "-o"])
        .arg(&out)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    for table in ["fabrics.csv", "predictions.csv"] {
        let found = std::fs::read_to_string(out.join(table)).unwrap();
        let rounded = compare(table, &recorded(table), &found);
        println!("{table}: {rounded} numbers differ in their last digits");
    }
}

#[test]
fn the_verification_suite_gives_the_numbers_that_were_recorded() {
    let run = Command::new(env!("CARGO_BIN_EXE_kesf")).args(["verify", "--json"]).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let document: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    let lines = document["lines"].as_array().unwrap();
    let found: BTreeMap<&str, f64> =
        lines.iter().map(|l| (l["id"].as_str().unwrap(), l["value"].as_f64().unwrap())).collect();
    let mut rounded = 0;
    for row in rows(&recorded("verify.csv")).iter().skip(1) {
        let (id, expected) = (row[0].as_str(), row[1].parse::<f64>().unwrap());
        let value = *found.get(id).unwrap_or_else(|| panic!("{id} is no longer verified"));
        let noise = expected.abs() < NOISE && value.abs() < NOISE;
        let close = (value - expected).abs() <= ROUNDING * expected.abs();
        assert!(noise || close, "{id}: {value:e} where {expected:e} was recorded");
        rounded += usize::from(value.to_bits() != expected.to_bits());
    }
    println!("verify: {rounded} numbers differ in their last digits");
}
