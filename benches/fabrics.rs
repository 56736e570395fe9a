//! What `kesf run` of many fabrics takes: `cargo bench --bench fabrics [-- [made-up|tables|records] COUNT…]`.
//!
//! Memory, processor time and disk of a run with one linear case, one thread, without charts and fields, over so many fabrics
//! (1,000 and 10,000): copies of shipped tables, copies of a shipped fabric of 21 records, or made-up tables of two values.
//! Linux tells memory and time of a process; elsewhere they are 0.

#[path = "../tests/common/many.rs"]
mod many;
use many::{Made, run};

fn main() -> std::io::Result<()> {
    let mut made = Made::OfTables;
    let mut counts: Vec<usize> = Vec::new();
    for word in std::env::args().skip(1).filter(|word| !word.starts_with('-')) {
        match word.as_str() {
            "made-up" => made = Made::Up,
            "tables" => made = Made::OfTables,
            "records" => made = Made::OfRecords,
            count => counts.push(count.parse().map_err(std::io::Error::other)?),
        }
    }
    if counts.is_empty() {
        counts = vec![1000, 10_000];
    }
    let mut first = None;
    for fabrics in counts {
        let taken = run(env!("CARGO_BIN_EXE_kesf"), fabrics, made)?;
        let least = *first.get_or_insert(taken.memory);
        println!(
            "{fabrics} fabrics: {:.1} MB ({:.2} times the first), {:.1} ms of processor time and {:.0} kB of disk each",
            1e-6 * taken.memory as f64,
            taken.memory as f64 / least.max(1) as f64,
            1e3 * taken.seconds / fabrics as f64,
            1e-3 * taken.disk as f64 / fabrics as f64
        );
    }
    Ok(())
}
