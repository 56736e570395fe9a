//! What a run holds in memory does not grow with its fabrics.

use std::fs;
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::{kesf, write};

/// Most memory that a process has held (bytes), as Linux tells it while the process is there.
#[cfg(target_os = "linux")]
fn peak(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}

/// Processor time of the children of this process so far is not to be had without their system calls; that of one while
/// it runs is, in hundredths of a second.
#[cfg(target_os = "linux")]
fn processor_seconds(process: u32) -> Option<f64> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let fields: Vec<f64> =
        stat.rsplit(')').next()?.split_whitespace().map(|f| f.parse().unwrap_or(0.0)).collect();
    Some(fields.get(11..13)?.iter().sum::<f64>() / 100.0)
}

/// Runs so many fabrics with a linear case on one thread; the most memory (bytes) and the processor time (s).
#[cfg(target_os = "linux")]
fn run(fabrics: usize) -> (u64, f64) {
    let folder = tempfile::tempdir().unwrap();
    for k in 0..fabrics {
        let folder = folder.path().join(format!("lab/cloth{k:05}"));
        let b = 0.1 + 1e-5 * k as f64;
        write(&folder, "fabric.toml", "areal_density = \"120 g/m²\"\n");
        write(&folder, "t.csv", &format!("parameter,unit,warp,weft\nB,gf·cm²/cm,{b},{}\n", 0.5 * b));
    }
    let mut child = kesf()
        .args(["-j", "1", "-q", "run", "--no-charts", "cases/cantilever_strip.toml"])
        .arg(folder.path().join("lab"))
        .arg("-o")
        .arg(folder.path().join("out"))
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let (mut most, mut seconds) = (0, 0.0f64);
    loop {
        most = most.max(peak(child.id()).unwrap_or(0));
        seconds = seconds.max(processor_seconds(child.id()).unwrap_or(0.0));
        if let Some(status) = child.try_wait().unwrap() {
            assert!(status.code().is_some_and(|code| code < 2), "{status}");
            return (most, seconds);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// What one fabric more may take (bytes): it was 149 kB when results were kept. Measured between 150 and 900: 8 kB, of which
/// half is what pages show of the first 200 fabrics and the first 1,000 problems of a code.
const OF_FABRIC: f64 = 12e3;

/// Many fabrics take little more memory than a few: `KESF_FABRICS="1000 10000"` for the figures of the docs.
#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_fabrics() {
    let counts = std::env::var("KESF_FABRICS").unwrap_or("150 900".into());
    let counts: Vec<usize> = counts.split_whitespace().map(|n| n.parse().unwrap()).collect();
    let start = Instant::now();
    let mut found = Vec::new();
    for fabrics in counts {
        let (bytes, seconds) = run(fabrics);
        let (megabytes, each) = (bytes as f64 / 1e6, 1e3 * seconds / fabrics as f64);
        println!("{fabrics} fabrics: {megabytes:.1} MB, {each:.1} ms of processor time each");
        found.push((fabrics as f64, bytes as f64));
    }
    println!("{:.0} s", start.elapsed().as_secs_f64());
    let (first, last) = (found[0], found[found.len() - 1]);
    let each = (last.1 - first.1) / (last.0 - first.0);
    println!("{each:.0} bytes for each fabric more");
    assert!(last.1 < 150e6, "{found:?}");
    assert!(each < OF_FABRIC, "{each} bytes for each fabric more");
}
