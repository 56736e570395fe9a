//! What the command refuses before anything is written, and words that look like inputs.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn run_in(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_kesf")).current_dir(folder).args(arguments).output().unwrap()
}

fn ended(output: &Output) -> (i32, String) {
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// A folder with one fabric, and cases for a fabric.
fn laboratory() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::create_dir_all(folder.path().join("data/poplin")).unwrap();
    let table = "parameter,unit,warp,weft\nB,gf·cm²/cm,0.1,0.1\nW,mg/cm²,10,10\n";
    fs::write(folder.path().join("data/poplin/t.csv"), table).unwrap();
    fs::write(folder.path().join("data/poplin/fabric.toml"), "origin = \"measured\"\n").unwrap();
    fs::copy(root.join("cases/drape.toml"), folder.path().join("drape.toml")).unwrap();
    fs::copy(root.join("cases/seed_clamped.toml"), folder.path().join("clamped.toml")).unwrap();
    folder
}

#[test]
fn a_blank_before_the_word_of_drape_is_as_good_as_a_sign() {
    let folder = laboratory();
    let root = folder.path();
    for (option, name) in [
        (&["--drape", "never"][..], "a"),
        (&["--drape=never"], "b"),
        (&["--fields", "never", "--drape", "never"], "c"),
    ] {
        let arguments = [&["run", "-q"], option, &["data", "drape.toml", "--no-charts", "-o", name]].concat();
        assert_eq!(ended(&run_in(root, &arguments)), (0, String::new()), "{option:?}");
        assert_eq!(fs::read_to_string(root.join(name).join("predictions.csv")).unwrap().lines().count(), 1);
    }
}

#[test]
fn results_do_not_go_among_the_inputs() {
    let folder = laboratory();
    let root = folder.path();
    for output in ["data", "data/poplin", ".", root.to_str().unwrap()] {
        for command in [&["run"][..], &["run", "--force"], &["compare"], &["run", "--shard", "1/2"]] {
            let arguments = [command, &["-q", "data", "-o", output]].concat();
            let (code, text) = ended(&run_in(root, &arguments));
            assert!(code == 2 && text.contains("O076"), "{arguments:?}: {code} {text}");
        }
    }
    let names: Vec<_> =
        fs::read_dir(root.join("data/poplin")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    assert_eq!(fs::read_dir(root).unwrap().count(), 3);
    // A folder of results below the inputs is none of them, the first time and the second.
    for _ in 0..2 {
        assert_eq!(
            ended(&run_in(root, &["run", "-q", ".", "-o", "results", "--drape", "never", "--no-charts"])).0,
            0
        );
    }
}

#[test]
fn a_run_that_can_do_nothing_writes_nothing() {
    let folder = laboratory();
    let root = folder.path();
    let (code, text) = ended(&run_in(root, &["run", "-q", "clamped.toml", "-o", "out"]));
    assert!(code == 2 && text.contains("O055"), "{code} {text}");
    assert!(!root.join("out").exists());
    // A case with constants of its own needs none.
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/benchmark_clamped_orthotropic.toml");
    let arguments = ["run", "-q", own.to_str().unwrap(), "--no-charts", "-o", "out"];
    assert_eq!(ended(&run_in(root, &arguments)).0, 0);
    assert!(root.join("out/predictions.csv").is_file());
}

#[test]
fn names_and_options_that_contradict_are_refused() {
    let folder = laboratory();
    let root = folder.path();
    let (code, text) = ended(&run_in(root, &["characterise", "data", "--json", "-o", "x.csv"]));
    assert!(code == 2 && text.contains("O050") && !root.join("x.csv").exists(), "{code} {text}");
    assert_eq!(ended(&run_in(root, &["-q", "characterise", "data", "--json", "-o", "x.json"])).0, 0);
    assert_eq!(ended(&run_in(root, &["run", "-q", "data", "--no-charts", "-o", "out"])).0, 0);
    let (code, text) = ended(&run_in(root, &["library", "build", "a.csv", "out"]));
    assert!(code == 2 && text.contains("a.csv: O050") && !root.join("a.csv").exists(), "{code} {text}");
    // The page that is read is not written over, with or without force.
    let index = fs::read(root.join("out/index.html")).unwrap();
    for force in [&[][..], &["--force"]] {
        let (code, text) =
            ended(&run_in(root, &[&["report", "out", "-o", "out/index.html"], force].concat()));
        assert!(code == 2 && text.contains("O006"), "{code} {text}");
        assert_eq!(fs::read(root.join("out/index.html")).unwrap(), index);
    }
    for output in [&[][..], &["-o", "out/report.html"], &["-o", "page.html"]] {
        assert_eq!(ended(&run_in(root, &[&["report", "out"], output].concat())).0, 0, "{output:?}");
    }
}

/// Fabrics that are not shown are counted, with what shows them; so is what distances rest on.
#[test]
fn a_library_says_what_it_does_not_show() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let rows: String = (1..=13)
        .map(|i| {
            let x = f64::from(i);
            let more = if i % 2 == 0 { format!("{},{}", 0.3 + 0.01 * x, 50.0 + x) } else { ",".into() };
            format!("F{i:02},{},{},{},{},{more}\n", 0.5 + 0.01 * x, 0.1 + 0.01 * x, 0.05 + 0.01 * x, 10.0 + x)
        })
        .collect();
    let heads = "fabric,LT,B (gf·cm²/cm),2HB (gf·cm/cm),W (mg/cm²),LC,RC (%)\n";
    fs::write(root.join("t.csv"), format!("{heads}{rows}")).unwrap();
    assert_eq!(ended(&run_in(root, &["run", "-q", "t.csv", "--no-charts", "-o", "out"])).0, 0);
    assert_eq!(ended(&run_in(root, &["library", "build", "l.parquet", "out"])).0, 0);
    let found = |more: &[&str]| {
        let output = run_in(root, &[&["library", "find", "l.parquet"], more].concat());
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(found(&[]).ends_with("\n3 fabrics more, not shown: -n 13 shows all\n"), "{}", found(&[]));
    assert!(!found(&["-n", "13"]).contains("not shown"));
    assert!(found(&["-n", "12"]).contains("1 fabric more"));
    let like = found(&["--like", "F02", "-n", "13"]);
    assert!(like.contains("distances are over 4 to 6 parameters"), "{like}");
}
