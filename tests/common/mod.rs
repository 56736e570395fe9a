//! A test that cannot do its work says so, and `.ci/run` counts it as skipped.

use std::io::Write;

/// Says which test does not look at what, and why: in its own output, and as a line of the file that
/// `KESF_SKIPPED` names.
///
/// # Panics
/// Where that file cannot be written.
pub fn skipped(test: &str, why: &str) {
    println!("skipped: {test}: {why}");
    if let Some(path) = std::env::var_os("KESF_SKIPPED") {
        let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path).unwrap();
        // In one piece: tests run at the same time.
        file.write_all(format!("{test}: {why}\n").as_bytes()).unwrap();
    }
}
