//! What reading a file costs as it grows: `cargo bench --bench sizes [-- NAME…]`.
//!
//! Files of one repeated piece (header lines, rows, columns, words, brackets) of n, 2n and 4n pieces are read, and the seconds and
//! their growth from step to step are printed. What is read in a time that grows with its size doubles; what is compared
//! with all that came before it becomes four times as much.

use std::path::Path;
use std::time::Instant;

use kesf::instrument::{Library, ReadSettings};

#[path = "../tests/common/shapes.rs"]
mod shapes;
use shapes::SHAPES;

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
