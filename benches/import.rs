//! Import of a laboratory's library: raw files a second on one thread, and memory as the library grows.
//!
//! `cargo bench --bench import [-- FOLDER]` writes 100 synthetic fabrics of 21 files (the shipped poplin's
//! records, each fabric's loads scaled differently, re-written as text) below FOLDER, or below a
//! temporary one, and reads and characterises 500, 1000 and 2100 of the files, each with its own
//! SHA-256, then all of them once more without the evaluation. Times depend on the machine and on
//! what else it does. Memory is the high-water mark of the process (Linux).

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use kesf::characterise::{Settings, characterise};
use kesf::instrument::{FabricInput, Library, ReadSettings};

const FABRICS: usize = 100;

/// The file's text with the second column of its curve times `factor`, to four decimals.
fn scaled(text: &str, factor: f64) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let numbers =
            line.split_once(',').and_then(|(x, y)| Some((x.parse::<f64>().ok()?, y.parse::<f64>().ok()?)));
        match numbers {
            Some((x, y)) => writeln!(out, "{x:.4},{:.4}", y * factor),
            None => writeln!(out, "{line}"),
        }
        .expect("a String takes everything");
    }
    out
}

/// Writes the library and returns its folders.
fn library(root: &Path) -> std::io::Result<Vec<PathBuf>> {
    let poplin = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data/poplin");
    let mut records = Vec::new();
    for entry in std::fs::read_dir(poplin)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "csv") {
            records.push((
                path.file_name().map(PathBuf::from).unwrap_or_default(),
                std::fs::read_to_string(&path)?,
            ));
        }
    }
    let mut folders = Vec::new();
    for k in 0..FABRICS {
        let folder = root.join(format!("fabric{k:03}"));
        std::fs::create_dir_all(&folder)?;
        let about =
            format!("name = \"fabric {k}\"\norigin = \"synthetic\"\nareal_density = \"{} g/m²\"\n", 100 + k);
        std::fs::write(folder.join("fabric.toml"), about)?;
        for (name, text) in &records {
            // Tension and compression are driven to a load: there it stays.
            let to_load = ["compression", "tensile"].iter().any(|test| text.contains(test));
            let factor = if to_load { 1.0 } else { 1.0 + 0.002 * k as f64 };
            std::fs::write(folder.join(name), scaled(text, factor))?;
        }
        folders.push(folder);
    }
    Ok(folders)
}

/// High-water mark of the memory of this process in MB, where the system tells.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    Some(line.trim().trim_end_matches(" kB").parse::<f64>().ok()? / 1024.0)
}

/// Processor time of this process so far in seconds, all threads, where the system tells.
fn processor() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // After the name in brackets: utime and stime are the 12th and 13th field, in ticks of 10 ms.
    let mut fields = stat.rsplit(')').next()?.split_whitespace().skip(11);
    Some((fields.next()?.parse::<f64>().ok()? + fields.next()?.parse::<f64>().ok()?) / 100.0)
}

fn import<T: Send>(what: &str, folders: &[PathBuf], work: impl Fn(FabricInput) -> T + Sync) {
    let (start, used) = (Instant::now(), processor());
    let library = Library::find(folders, &ReadSettings::default());
    let files = library.files();
    let (done, failures) = library.each(&|_: &Path| (), work);
    assert!(failures.is_empty(), "{failures:?}");
    let seconds = start.elapsed().as_secs_f64();
    let used = used.and_then(|before| Some(processor()? - before)).filter(|s| *s > 0.0);
    let per_core =
        used.map_or_else(String::new, |s| format!(", {:.0} a second of processor time", files as f64 / s));
    let memory = peak().map_or_else(|| "unknown".to_string(), |mb| format!("{mb:.1} MB"));
    println!(
        "{what} {files} files of {} fabrics: {seconds:.2} s, {:.0} files a second{per_core}; peak memory {memory}",
        done.len(),
        files as f64 / seconds
    );
}

fn main() -> std::io::Result<()> {
    let temporary = tempfile::tempdir()?;
    let stated = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    let root = stated.map_or_else(|| temporary.path().to_path_buf(), PathBuf::from);
    let folders = library(&root)?;
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().map_err(std::io::Error::other)?;
    println!("one thread; before: peak memory {:.1} MB", peak().unwrap_or(f64::NAN));
    // What a sheet keeps for a table: its values, without the curves.
    let evaluate = |input: FabricInput| {
        let mut sheet = characterise(&input, &Settings::default());
        (sheet.specimens, sheet.strips) = Default::default();
        sheet
    };
    for count in [24, 48, FABRICS] {
        import("read and characterised", &folders[..count], evaluate);
    }
    import("read only", &folders, |input| input.measurements.len());
    Ok(())
}
