//! What reading a file costs as it grows: `cargo bench --bench sizes [-- NAME…]`.
//!
//! Files of one repeated piece (header lines, rows, columns, words, brackets) of n, 2n and 4n pieces are read, and the seconds and
//! their growth from step to step are printed. What is read in a time that grows with its size doubles; what is compared
//! with all that came before it becomes four times as much.

use std::path::Path;
use std::time::Instant;

use kesf::instrument::{Library, ReadSettings};

const HEAD: &str = "sample,poplin\ninstrument,KES-FB2\ndirection,warp\nspecimen,1\n";
const RECORD: &str =
    "curvature (1/cm),moment (gf·cm/cm)\n0,0\n1,0.05\n2.5,0.2\n1,0.0\n0,-0.05\n-2.5,-0.2\n-1,0\n0,0.05\n";
const TABLE: &str = "fabric,B warp (gf·cm²/cm),B weft (gf·cm²/cm)\n";

/// A name, pieces of the smallest file, its ending, and its text of so many pieces.
type Shape = (&'static str, usize, &'static str, fn(usize) -> String);

fn repeated(n: usize, piece: impl Fn(usize) -> String) -> String {
    (0..n).map(piece).collect()
}

const SHAPES: &[Shape] = &[
    ("words in one line", 20_000, "txt", |n| "lorem ipsum dolor sit ".repeat(n)),
    ("keys in one line", 5_000, "txt", |n| "test: bending = 5 gf/cm, ".repeat(n)),
    ("brackets in one line", 50_000, "txt", |n| "(".repeat(n)),
    ("columns", 2_000, "csv", |n| {
        let line = |of: fn(usize) -> String| repeated(n, of) + "\n";
        line(|i| format!("c{i} (gf/cm),")) + &line(|_| "1,".into()) + &line(|_| "2,".into())
    }),
    ("header lines of one direction", 5_000, "csv", |n| "direction,warp\n".repeat(n) + HEAD + RECORD),
    ("header lines", 5_000, "csv", |n| repeated(n, |i| format!("note {i},value {i}\n")) + HEAD + RECORD),
    ("blank lines", 50_000, "csv", |n| format!("{HEAD}{}{RECORD}", "\n".repeat(n))),
    ("records", 250, "csv", |n| {
        repeated(n, |i| HEAD.replace("specimen,1", &format!("specimen,{}", i + 1)) + RECORD + "\n")
    }),
    ("samples of a record", 20_000, "csv", |n| {
        let sample =
            |i: usize| format!("{:.5},{:.5}\n", 2.5 * i as f64 / n as f64, 0.2 * i as f64 / n as f64);
        format!("{HEAD}curvature (1/cm),moment (gf·cm/cm)\n{}", repeated(n, sample))
    }),
    ("fabrics of a table", 5_000, "csv", |n| {
        TABLE.to_string() + &repeated(n, |i| format!("f{i},0.{},0.05\n", 100 + i % 800))
    }),
    ("rows of a fabric in a table", 5_000, "csv", |n| {
        TABLE.to_string() + &repeated(n, |i| format!("f,0.{},0.05\n", 100 + i % 800))
    }),
    ("tables of a web page", 2_000, "xls", |n| {
        "<table><tr><td>lorem ipsum dolor</td></tr></table>".repeat(n)
    }),
];

fn main() -> std::io::Result<()> {
    let folder = tempfile::tempdir()?;
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().map_err(std::io::Error::other)?;
    for (name, pieces, ending, text) in SHAPES {
        if !wanted.is_empty() && !wanted.iter().any(|w| name.contains(w.as_str())) {
            continue;
        }
        let mut seconds = Vec::new();
        for n in [1, 2, 4] {
            let path = folder.path().join(format!("file.{ending}"));
            std::fs::write(&path, text(n * pieces))?;
            let start = Instant::now();
            let library = Library::find(&[path], &ReadSettings::default());
            library.each(&|_: &Path| (), |input| input.measurements.len());
            seconds.push(start.elapsed().as_secs_f64());
        }
        let growth = |a: usize| seconds[a + 1] / seconds[a].max(1e-4);
        println!(
            "{name}: {:.3}, {:.3}, {:.3} s for {pieces}, twice and four times as many: times {:.1} and {:.1}",
            seconds[0],
            seconds[1],
            seconds[2],
            growth(0),
            growth(1)
        );
    }
    Ok(())
}
