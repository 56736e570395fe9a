//! `kesf run` over many fabrics: what it holds in memory, the processor time and the disk that it takes.

use std::fs;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// What a fabric of the library is made of.
#[derive(Clone, Copy)]
pub enum Made {
    /// A table of a few values and a `fabric.toml`, each fabric with other values.
    Up,
    /// Copies of shipped fabrics that are known from tables, in turns.
    OfTables,
    /// Copies of a shipped fabric of 21 records.
    OfRecords,
}

/// What a run took.
pub struct Taken {
    /// Most memory that the process held (bytes).
    pub memory: u64,
    /// Processor time (s).
    pub seconds: f64,
    /// Bytes of all files that were written.
    pub disk: u64,
}

/// Most memory that a process has held (bytes), as Linux tells it while the process is there.
fn peak(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}

/// Processor time of a process (s), in hundredths of a second, while it is there.
fn processor_seconds(process: u32) -> Option<f64> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let fields: Vec<f64> =
        stat.rsplit(')').next()?.split_whitespace().map(|f| f.parse().unwrap_or(0.0)).collect();
    Some(fields.get(11..13)?.iter().sum::<f64>() / 100.0)
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        if path.is_file() {
            fs::copy(&path, to.join(path.file_name().unwrap_or_default()))?;
        }
    }
    Ok(())
}

fn size(folder: &Path) -> io::Result<u64> {
    let mut bytes = 0;
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        bytes += if entry.file_type()?.is_dir() { size(&entry.path())? } else { entry.metadata()?.len() };
    }
    Ok(bytes)
}

/// Lays out the fabrics.
fn library(root: &Path, fabrics: usize, made: Made) -> io::Result<()> {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data");
    for k in 0..fabrics {
        let folder = root.join(format!("cloth{k:05}"));
        match made {
            Made::Up => {
                let b = 0.1 + 1e-5 * k as f64;
                fs::create_dir_all(&folder)?;
                fs::write(folder.join("fabric.toml"), "areal_density = \"120 g/m²\"\n")?;
                let table = format!("parameter,unit,warp,weft\nB,gf·cm²/cm,{b},{}\n", 0.5 * b);
                fs::write(folder.join("t.csv"), table)?;
            }
            Made::OfTables => copy(&shipped.join(["petrak_m1", "petrak_m2", "petrak_m3"][k % 3]), &folder)?,
            Made::OfRecords => copy(&shipped.join("twill"), &folder)?,
        }
    }
    Ok(())
}

/// Runs the command over so many fabrics with a linear case, on one thread, without charts.
///
/// # Errors
/// Where the system refuses, or the command ends with another code than 0 or 1.
pub fn run(command: &str, fabrics: usize, made: Made) -> io::Result<Taken> {
    let folder = tempfile::tempdir()?;
    let (lab, out) = (folder.path().join("lab"), folder.path().join("out"));
    library(&lab, fabrics, made)?;
    let mut child = Command::new(command)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["-j", "1", "-q", "run", "--no-charts", "--fields", "never", "cases/cantilever_strip.toml"])
        .arg(&lab)
        .arg("-o")
        .arg(&out)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .spawn()?;
    let mut taken = Taken { memory: 0, seconds: 0.0, disk: 0 };
    loop {
        taken.memory = taken.memory.max(peak(child.id()).unwrap_or(0));
        taken.seconds = taken.seconds.max(processor_seconds(child.id()).unwrap_or(0.0));
        if let Some(status) = child.try_wait()? {
            if status.code().is_none_or(|code| code > 1) {
                return Err(io::Error::other(status.to_string()));
            }
            taken.disk = size(&out)?;
            return Ok(taken);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}
