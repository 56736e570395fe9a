//! What a run holds in memory does not grow with its fabrics.

#[cfg(target_os = "linux")]
use crate::many::{Made, run};

/// What one fabric more may take (bytes): it was 149 kB when results were kept. Measured between 300 and 1,200: 5.8 kB, of which
/// most is what the page shows of the first 1,000 problems of a code.
#[cfg(target_os = "linux")]
const OF_FABRIC: f64 = 9e3;

/// Many fabrics take little more memory than a few: `KESF_FABRICS="1000 10000"` for other numbers; `cargo bench --bench
/// fabrics` for the figures of the docs.
#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_fabrics() {
    let counts = std::env::var("KESF_FABRICS").unwrap_or("300 1200".into());
    let counts: Vec<usize> = counts.split_whitespace().map(|n| n.parse().unwrap()).collect();
    let mut found = Vec::new();
    for fabrics in counts {
        let taken = run(env!("CARGO_BIN_EXE_kesf"), fabrics, Made::Up).unwrap();
        let (megabytes, each) = (1e-6 * taken.memory as f64, 1e3 * taken.seconds / fabrics as f64);
        println!("{fabrics} fabrics: {megabytes:.1} MB, {each:.1} ms of processor time each");
        found.push((fabrics as f64, taken.memory as f64));
    }
    let (first, last) = (found[0], found[found.len() - 1]);
    let each = (last.1 - first.1) / (last.0 - first.0);
    println!("{each:.0} bytes for each fabric more");
    assert!(last.1 < 150e6, "{found:?}");
    assert!(each < OF_FABRIC, "{each} bytes for each fabric more");
}

/// Fabrics of many curves fill a page sooner.
#[cfg(target_os = "linux")]
#[test]
fn fabrics_of_many_records_are_held_one_page_at_a_time() {
    let taken = run(env!("CARGO_BIN_EXE_kesf"), 120, Made::OfRecords).unwrap();
    println!("120 fabrics of 21 records: {:.1} MB", 1e-6 * taken.memory as f64);
    assert!(taken.memory < 150_000_000, "{}", taken.memory);
}
