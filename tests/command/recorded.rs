//! Every number of the main job, against a table that was recorded before the application moved from the command into
//! the library (those of the verification suite are held in tests/cases/verify.rs).
//!
//! Goal: a change of structure changes no number. Reference: our own output (kind `own`), so this guards against
//! change and proves nothing else.
//!
//! A machine with other vector instructions sums in another order, and its last digits differ. There a number may
//! differ by 1e-7 of itself, as the searches in large rotations end at a residual of 1e-8 of the load; how many
//! numbers differ at all is printed.

use std::path::Path;
use std::process::Command;

/// What the order of summation may change, relative to the number.
const ROUNDING: f64 = 1e-7;

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
