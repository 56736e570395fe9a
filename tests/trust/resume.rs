//! Runs that end early, and those after them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::{code, kesf, stderr, tree, write};

/// Fabrics of the library that is run.
const FABRICS: usize = 12;

/// Names of files that hold nothing for people.
fn is_hidden(name: &str) -> bool {
    name.rsplit('/').next().is_some_and(|file| file.starts_with('.'))
}

/// A library with a case, and where its results go.
struct Library {
    folder: tempfile::TempDir,
    /// Options of the files that are wanted.
    files: &'static [&'static str],
}

impl Library {
    fn new() -> Self {
        Self::with_files(&["--no-charts"])
    }

    fn with_files(files: &'static [&'static str]) -> Self {
        let library = Self { folder: tempfile::tempdir().unwrap(), files };
        for k in 0..FABRICS {
            library.write_fabric(k, 0.1 + 0.01 * k as f64);
        }
        let case =
            fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/cantilever_strip.toml"));
        write(library.folder.path(), "case.toml", &case.unwrap());
        library
    }

    fn write_fabric(&self, k: usize, rigidity: f64) {
        let folder = self.folder.path().join(format!("lab/cloth{k:02}"));
        write(&folder, "fabric.toml", "areal_density = \"120 g/m²\"\n");
        let rows = format!("parameter,unit,warp,weft\nB,gf·cm²/cm,{rigidity},{}\n", 0.5 * rigidity);
        write(&folder, "t.csv", &rows);
    }

    fn command(&self, out: &str, more: &[&str]) -> Command {
        let path = |name: &str| self.folder.path().join(name);
        let mut command = kesf();
        command.arg("run").args(self.files).arg(path("lab")).arg(path("case.toml")).arg("-o").arg(path(out));
        command.args(more);
        command
    }

    fn run(&self, out: &str, more: &[&str]) -> Output {
        let done = self.command(out, more).output().unwrap();
        assert!([0, 1].contains(&code(&done)), "{}", stderr(&done));
        done
    }

    fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// What people see of the results.
    fn shown(&self, out: &str) -> BTreeMap<String, Vec<u8>> {
        tree(&self.out(out)).into_iter().filter(|(name, _)| !is_hidden(name)).collect()
    }
}

/// How many fabrics a run found done.
fn resumed(done: &Output) -> usize {
    let errors = stderr(done);
    let line = errors.lines().find(|line| line.contains("as an earlier run left them"));
    line.map_or(0, |line| line.split(' ').next().unwrap().parse().unwrap())
}

/// Whether every row group of a table can be read.
fn is_parquet(bytes: &[u8]) -> bool {
    use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
    let reader = ParquetRecordBatchReaderBuilder::try_new(bytes::Bytes::copy_from_slice(bytes));
    reader.and_then(|reader| reader.build()).is_ok_and(|mut batches| batches.all(|batch| batch.is_ok()))
}

/// Whether every pixel of a picture can be read.
fn is_png(bytes: &[u8]) -> bool {
    let Ok(mut reader) = png::Decoder::new(std::io::Cursor::new(bytes)).read_info() else { return false };
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).is_ok()
}

/// Every file that is there is whole: what has a reader here is read to its end.
fn assert_whole(folder: &Path, when: &str) {
    for (name, bytes) in tree(folder).into_iter().filter(|(name, _)| !is_hidden(name)) {
        let text = String::from_utf8_lossy(&bytes);
        let whole = match name.rsplit('.').next().unwrap() {
            "json" => serde_json::from_slice::<serde_json::Value>(&bytes).is_ok(),
            "csv" => {
                text.ends_with('\n') && csv::Reader::from_reader(&bytes[..]).records().all(|row| row.is_ok())
            }
            "parquet" => is_parquet(&bytes),
            "vtu" => vtkio::Vtk::parse_xml(&bytes[..]).is_ok(),
            "glb" => gltf::Gltf::from_slice(&bytes).is_ok(),
            "png" => is_png(&bytes),
            "svg" => text.trim_end().ends_with("</svg>"),
            "pdf" => lopdf::Document::load_mem(&bytes).is_ok_and(|pdf| !pdf.get_pages().is_empty()),
            "xlsx" => zip::ZipArchive::new(std::io::Cursor::new(&bytes)).is_ok(),
            "html" => text.trim_end().ends_with("</html>"),
            ending => panic!("{when}: what is {name} ({ending})?"),
        };
        assert!(whole, "{when}: {name} is not whole ({} bytes)", bytes.len());
    }
}

/// What has not changed is not computed again, and what has is.
#[test]
fn a_second_run_computes_what_has_changed_and_nothing_else() {
    let library = Library::new();
    assert_eq!(resumed(&library.run("out", &[])), 0);
    let first = library.shown("out");
    assert_eq!(resumed(&library.run("out", &[])), FABRICS);
    assert_eq!(library.shown("out"), first);
    assert_eq!(resumed(&library.run("out", &["--fresh"])), 0);
    assert_eq!(library.shown("out"), first);

    library.write_fabric(3, 0.5);
    assert_eq!(resumed(&library.run("out", &[])), FABRICS - 1, "another measurement of one fabric");
    library.run("anew", &[]);
    assert_eq!(library.shown("out"), library.shown("anew"));
    fs::remove_file(library.out("out/cloth05/case.json")).unwrap();
    assert_eq!(resumed(&library.run("out", &[])), FABRICS - 1, "a file of one fabric is gone");
    assert_eq!(library.shown("out"), library.shown("anew"));
    let case = fs::read_to_string(library.out("case.toml")).unwrap();
    write(
        library.folder.path(),
        "case.toml",
        &case.replace("width = \"20 mm\"", "width = \"21 mm\"").replace("[\"20 mm\"", "[\"21 mm\""),
    );
    assert_eq!(resumed(&library.run("out", &[])), 0, "another case");
    assert_ne!(library.shown("out"), library.shown("anew"));
    write(library.folder.path(), "settings.toml", "");
    let settings = library.out("settings.toml");
    assert_eq!(
        resumed(&library.run("out", &["--settings", settings.to_str().unwrap()])),
        0,
        "other settings"
    );
}

/// What somebody changed in the results of an earlier run is not taken for ours.
#[test]
fn a_result_that_was_edited_is_not_kept_and_not_overwritten() {
    let library = Library::new();
    library.run("out", &[]);
    fs::write(library.out("out/cloth01/sheet.json"), "edited").unwrap();
    let done = library.command("out", &[]).output().unwrap();
    assert_eq!(code(&done), 1, "{}", stderr(&done));
    assert!(stderr(&done).contains("O002"), "{}", stderr(&done));
    assert_eq!(resumed(&done), FABRICS - 1);
    assert_eq!(fs::read_to_string(library.out("out/cloth01/sheet.json")).unwrap(), "edited");
}

/// Killed at many moments (`KESF_KILLS`, 10 by default): every file is whole each time, and the run after it gives
/// what an undisturbed one gives, without computing what was done.
#[cfg(unix)]
#[test]
fn a_run_that_is_killed_goes_on_where_it_was() {
    let kills = std::env::var("KESF_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(10);
    killed(&Library::new(), kills);
}

/// The same of a run with charts of every kind and a workbook, a fifth as often: it takes much longer.
#[cfg(unix)]
#[test]
fn a_run_with_charts_that_is_killed_goes_on_where_it_was() {
    let kills = std::env::var("KESF_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(10);
    killed(&Library::with_files(&["--format", "png,svg,pdf", "--xlsx"]), kills / 5);
}

#[cfg(unix)]
fn killed(library: &Library, kills: u32) {
    let start = Instant::now();
    library.run("undisturbed", &["-j", "1"]);
    let whole = start.elapsed();
    let (mut fresh, mut most) = (true, 0);
    for kill in 0..kills {
        if fresh && library.out("out").exists() {
            fs::remove_dir_all(library.out("out")).unwrap();
        }
        // Moments spread over the run by the golden section.
        let part = (0.618_034 * f64::from(kill)).fract();
        let mut child =
            library.command("out", &["-j", "1"]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(whole.mul_f64(part));
        child.kill().unwrap();
        child.wait().unwrap();
        if library.out("out").exists() {
            assert_whole(&library.out("out"), &format!("kill {kill}"));
        }
        // Every other time the next run goes on from there, and is killed too.
        fresh = kill % 2 == 1;
        if fresh {
            let done = library.run("out", &["-j", "1"]);
            most = most.max(resumed(&done));
            assert_eq!(library.shown("out"), library.shown("undisturbed"), "after kill {kill}");
            let remaining: Vec<String> = tree(&library.out("out"))
                .into_keys()
                .filter(|n| n.contains("/.kesf-") || n.starts_with(".kesf-"))
                .collect();
            let known = |name: &String| name.ends_with(".kesf-record.json") || name == ".kesf-manifest.json";
            assert!(remaining.iter().all(known), "temporary files are left: {remaining:?}");
        }
    }
    println!(
        "{kills} kills over {:.1} s; at most {most} of {FABRICS} fabrics were found done",
        whole.as_secs_f64()
    );
    assert!(most > 0 || kills < 10, "what was done is known");
}

/// Two runs into one folder: one works, the other says so.
#[test]
fn two_runs_into_one_folder_do_not_mix() {
    let library = Library::new();
    let mut first =
        library.command("out", &["-j", "1"]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let journal = library.out("out/.kesf-journal");
    let start = Instant::now();
    while !journal.exists() && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let second = library.command("out", &[]).output().unwrap();
    let ended_before = first.try_wait().unwrap().is_some();
    assert!(first.wait().unwrap().success());
    if !ended_before || code(&second) == 2 {
        assert_eq!(code(&second), 2, "{}", stderr(&second));
        assert!(stderr(&second).contains("O005"), "{}", stderr(&second));
    }
    library.run("alone", &[]);
    assert_eq!(library.shown("out"), library.shown("alone"));
}

/// Standard output that is closed or full costs no result.
#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_takes_nothing_costs_no_result() {
    let library = Library::new();
    library.run("expected", &[]);
    for (out, redirection) in [("closed", ">&-"), ("full", ">/dev/full"), ("pipe", "| head -c 1")] {
        let command = library.command(out, &[]);
        let quoted =
            command.get_args().map(|a| format!("'{}'", a.to_str().unwrap())).collect::<Vec<_>>().join(" ");
        let line = format!("{} {quoted} {redirection}", env!("CARGO_BIN_EXE_kesf"));
        let done = Command::new("sh").args(["-c", &line]).output().unwrap();
        let full = out == "full";
        assert_eq!(code(&done), if full { 2 } else { 0 }, "{out}: {}", stderr(&done));
        assert_eq!(stderr(&done).contains("O051"), full, "{out}: {}", stderr(&done));
        assert_eq!(library.shown(out), library.shown("expected"), "{out}");
    }
}

/// Disks of several sizes that fill up, and one that cannot be written to: an error that says so, every file whole,
/// and when there is room the same run goes on.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_costs_no_whole_file() {
    let library = Library::new();
    library.run("expected", &[]);
    let command = library.command("disk/out", &[]);
    let quoted =
        command.get_args().map(|a| format!("'{}'", a.to_str().unwrap())).collect::<Vec<_>>().join(" ");
    let (kesf, disk) = (env!("CARGO_BIN_EXE_kesf"), library.out("disk"));
    fs::create_dir(&disk).unwrap();
    let (disk, kept) = (disk.display(), library.out("kept"));
    let kept = kept.display();
    let sizes: Vec<usize> = (0..20).map(|k| (40.0 * 1.35f64.powi(k)) as usize).collect();
    let mut script = String::from("set -u\n");
    for size in &sizes {
        script += &format!(
            "mount -t tmpfs -o size={size}k none '{disk}' || exit 77\n\
             {kesf} {quoted} >/dev/null 2>'{kept}.err'; echo \"$? $(grep -c O001 '{kept}.err')\"\n\
             mkdir -p '{kept}.{size}'; cp -r '{disk}/.' '{kept}.{size}/'\n\
             mount -o remount,size=64m '{disk}'; {kesf} {quoted} >/dev/null 2>&1; echo \"again $?\"\n\
             rm -rf '{kept}.whole.{size}'; cp -r '{disk}/out' '{kept}.whole.{size}'\n\
             umount '{disk}'\n"
        );
    }
    script += &format!(
        "mount -t tmpfs -o ro none '{disk}' || exit 77\n{kesf} {quoted} >/dev/null 2>'{kept}.err'; echo \"$? $(grep -c O001 '{kept}.err')\"\n"
    );
    let done = Command::new("unshare").args(["-rm", "sh", "-c", &script]).output();
    let Some(done) = done.ok().filter(|done| done.status.code() != Some(77) && !done.stdout.is_empty())
    else {
        return crate::common::skipped(
            "a_full_disk_costs_no_whole_file",
            "no file system can be mounted here",
        );
    };
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    let mut lines = said.lines();
    let mut failed = 0;
    for size in &sizes {
        let first = lines.next().unwrap_or_else(|| panic!("{said} {}", stderr(&done)));
        let (exit, count) = first.split_once(' ').unwrap();
        assert!(exit == "0" || (["1", "2"].contains(&exit) && count != "0"), "{size} kB: {first}");
        failed += usize::from(exit != "0");
        assert_eq!(lines.next(), Some("again 0"), "{size} kB");
        assert_whole(&library.out(&format!("kept.{size}")), &format!("{size} kB"));
        let whole = library.shown(&format!("kept.whole.{size}"));
        assert_eq!(whole, library.shown("expected"), "{size} kB, then room");
    }
    println!("{failed} of {} disks were too small", sizes.len());
    assert!(failed > 0 && failed < sizes.len(), "{said}");
    let read_only = lines.next().unwrap();
    assert!(read_only.starts_with("2 ") && read_only != "2 0", "{read_only}");
}

/// Somebody takes the permission to write away in the middle of a run: an error that says so, every file whole, and
/// with the permission the same run goes on. The superuser may write everywhere, and so runs it as nobody.
#[cfg(unix)]
#[test]
fn a_permission_that_is_lost_costs_no_whole_file() {
    use std::os::unix::fs::PermissionsExt;
    const TEST: &str = "a_permission_that_is_lost_costs_no_whole_file";
    let library = Library::new();
    library.run("expected", &["-j", "1"]);
    let root = library.folder.path();
    let allow = |path: &Path, mode: u32| fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    allow(root, 0o777);
    // The command may lie where nobody may look.
    let own = library.out("kesf");
    fs::copy(env!("CARGO_BIN_EXE_kesf"), &own).unwrap();
    allow(&own, 0o755);
    let nobody = ["--reuid", "65534", "--regid", "65534", "--clear-groups"];
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout == b"0\n");
    if is_root && !Command::new("setpriv").args(nobody).arg("true").status().is_ok_and(|s| s.success()) {
        return crate::common::skipped(TEST, "no setpriv, and the superuser may write everywhere");
    }
    let command = |out: &str| {
        let mut command = Command::new(if is_root { Path::new("setpriv") } else { &own });
        if is_root {
            command.args(nobody).arg(&own);
        }
        command.args(library.command(out, &["-j", "1"]).get_args()).current_dir(root).stdin(Stdio::null());
        command
    };
    let mut lost = 0;
    for attempt in 0..5 {
        let (name, begun) = (format!("out{attempt}"), FABRICS / 4 + attempt);
        let out = library.out(&name);
        let child = command(&name).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let start = Instant::now();
        while !out.join(format!("cloth{begun:02}")).exists() && start.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(1));
        }
        let folders = || {
            let inner = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path());
            inner.filter(|path| path.is_dir()).chain([out.clone()])
        };
        folders().for_each(|folder| allow(&folder, 0o555));
        let done = child.wait_with_output().unwrap();
        assert_whole(&out, TEST);
        if code(&done) != 0 {
            lost += 1;
            assert!([1, 2].contains(&code(&done)), "{}", stderr(&done));
            assert!(stderr(&done).contains("O001"), "{}", stderr(&done));
        }
        folders().for_each(|folder| allow(&folder, 0o755));
        let again = command(&name).output().unwrap();
        assert_eq!(code(&again), 0, "{}", stderr(&again));
        if code(&done) != 0 {
            assert!(resumed(&again) > 0, "what was done is known: {}", stderr(&again));
        }
        assert_eq!(library.shown(&name), library.shown("expected"));
    }
    println!("{lost} of 5 runs lost the permission before they were done");
    assert!(lost > 0);
}
