//! What reading costs grows with the size of a file and not with its square.

use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

use kesf::instrument::{Library, ReadSettings};

#[path = "../common/shapes.rs"]
mod shapes;
use shapes::SHAPES;

/// Processor time that this thread has had (s); `None` where the system does not say.
fn processor_seconds() -> Option<f64> {
    // The time of a thread that is running is counted in steps of some milliseconds, and that of one that rested exactly.
    thread::sleep(Duration::from_micros(1));
    let statistics = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * statistics.split_whitespace().next()?.parse::<f64>().ok()?)
}

/// A machine is shared: what is timed takes so long (s) at least.
const SPAN: f64 = 0.04;

/// Processor time of reading a file (s), the mean of as many times as take [`SPAN`]. What a thread has read it keeps for the files
/// that follow, so that each time has a thread of its own.
fn of_reading(path: &Path) -> Option<f64> {
    let (mut taken, mut times) = (0.0, 0.0);
    while taken < SPAN {
        taken += thread::scope(|scope| scope.spawn(|| of_first_reading(path)).join()).unwrap()?;
        times += 1.0;
    }
    Some(taken / times)
}

/// The same of a file on this thread, which has read none before. One file is read on the thread that asks.
fn of_first_reading(path: &Path) -> Option<f64> {
    let start = processor_seconds()?;
    let library = Library::find(&[path.to_path_buf()], &ReadSettings::default());
    library.each(&|_: &Path| (), |input| input.measurements.len());
    Some(processor_seconds()? - start)
}

/// Four times as many pieces take less than eight times as long, where they would take sixteen times as long if each
/// were compared with all before it. What else the machine does can only lengthen one of the two: the pair is timed again
/// before it counts as too long.
#[test]
fn reading_is_linear_in_the_size_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    // The vocabulary is made by the first file that is read.
    let first = folder.path().join("first.csv");
    fs::write(&first, "sample,poplin\ncurvature (1/cm),moment (gf·cm/cm)\n0,0\n1,0.05\n").unwrap();
    if of_reading(&first).is_none() {
        return crate::common::skipped(
            "reading_is_linear_in_the_size_of_a_file",
            "the system does not tell the processor time of a thread",
        );
    }
    for (name, pieces, ending, text) in SHAPES {
        let paths = [pieces / 4, *pieces].map(|n| {
            let path = folder.path().join(format!("{n}.{ending}"));
            fs::write(&path, text(n)).unwrap();
            path
        });
        let mut tried = Vec::new();
        while tried.len() < 6 && tried.last().is_none_or(|growth| *growth >= 8.0) {
            let [few, many] = paths.each_ref().map(|path| of_reading(path).unwrap());
            println!("{name}: {few:.4} and {many:.4} s, times {:.1}", many / few);
            tried.push(many / few);
        }
        assert!(tried.last().is_some_and(|growth| *growth < 8.0), "{name}: {tried:?} times as long");
    }
}
