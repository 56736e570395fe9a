//! Shards, their merge, and libraries of fabrics, by the command.
//!
//! Kind: own, of what other parts of the program give: tables do not depend on the number of shards, are cell for cell
//! those of `kesf run`, and every way in which parts do not belong together is told. Distances are written out once more.

#[cfg(target_os = "linux")]
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CASES: [&str; 4] = [
    "cases/virtual_bending.toml",
    // For fabrics with friction laws: which have none is known only when all shards are there.
    "cases/virtual_bending_friction.toml",
    // For FAB records, of which there are none.
    "cases/fab_bend_loop.toml",
    // With constants of its own: it is in one shard.
    "cases/benchmark_clamped_isotropic.toml",
];

fn kesf(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kesf"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).env_remove("NO_COLOR").args(arguments).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn done(arguments: &[&str]) -> Output {
    let output = kesf(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    output
}

/// A command that is refused with a code.
fn refused(arguments: &[&str], code: &str) -> String {
    let output = kesf(arguments);
    let said = stderr(&output);
    assert!(output.status.code() == Some(2) && said.contains(code), "{arguments:?}: {said}");
    assert!(output.stdout.is_empty());
    said
}

fn shard(inputs: &[&str], shard: &str, out: &Path, more: &[&str]) -> Output {
    let out = out.to_str().unwrap();
    let arguments = [&["run"], inputs, &["--shard", shard, "-o", out], more].concat();
    kesf(&arguments)
}

fn all(inputs: &[&str], count: usize, out: &Path) {
    for number in 1..=count {
        let output = shard(inputs, &format!("{number}/{count}"), out, &["-q"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
}

fn inputs() -> Vec<&'static str> {
    [&["kesf_data"], &CASES[..]].concat()
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_string()
}

/// Cells of a CSV table in these columns.
fn cells(bytes: &[u8], columns: &[&str]) -> Vec<Vec<String>> {
    let mut reader = csv::Reader::from_reader(bytes);
    let header = reader.headers().unwrap().clone();
    let places: Vec<_> = columns.iter().map(|c| header.iter().position(|h| h == *c).unwrap()).collect();
    reader
        .records()
        .map(|row| places.iter().map(|at| row.as_ref().unwrap()[*at].to_string()).collect())
        .collect()
}

#[test]
fn any_number_of_shards_gives_the_same_bytes_and_they_are_those_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for count in [1, 2, 7] {
        all(&inputs(), count, &at(&count.to_string()));
        for table in ["results", "findings", "failures"] {
            let out = text(&at(&format!("{count}-{table}.parquet")));
            done(&["merge", &text(&at(&count.to_string())), "--table", table, "-o", &out]);
        }
    }
    for table in ["results", "findings", "failures"] {
        let bytes = [1, 2, 7].map(|count| fs::read(at(&format!("{count}-{table}.parquet"))).unwrap());
        assert!(bytes[0] == bytes[1] && bytes[1] == bytes[2], "{table}");
    }
    let run = text(&at("run"));
    done(&[&["run"], &inputs()[..], &["--no-charts", "-o", &run]].concat());
    let merged = done(&["merge", &text(&at("7"))]).stdout;
    let written = |name: &str| fs::read(at("run").join(name)).unwrap();
    let rows_of = |predicted: bool, columns: &[&str]| -> Vec<Vec<String>> {
        let rows = cells(&merged, &[&["case"], columns].concat());
        let mut rows: Vec<_> =
            rows.into_iter().filter(|row| row[0].is_empty() != predicted).map(|r| r[1..].to_vec()).collect();
        rows.sort();
        rows
    };
    let mut parameters = cells(
        &written("fabrics.csv"),
        &["fabric", "parameter", "direction", "mean", "unit", "sd", "n", "status"],
    );
    parameters.sort();
    assert_eq!(
        rows_of(false, &["fabric", "quantity", "direction", "value", "unit", "sd", "n", "status"]),
        parameters
    );
    let columns =
        ["fabric", "case", "quantity", "simulated", "unit", "measured", "simulated_low", "simulated_high"];
    let mut predictions = cells(&written("predictions.csv"), &columns);
    predictions.sort();
    assert_eq!(
        rows_of(true, &["fabric", "case", "quantity", "value", "unit", "measured", "low", "high"]),
        predictions
    );
    let columns = ["fabric", "code", "place", "message"];
    let mut problems = cells(&written("problems.csv"), &columns);
    let mut found = cells(&done(&["merge", &text(&at("2")), "--table", "findings"]).stdout, &columns);
    found.extend(cells(&done(&["merge", &text(&at("2")), "--table", "failures"]).stdout, &columns));
    problems.sort();
    found.sort();
    assert_eq!(found, problems);
    assert!(found.iter().any(|row| row[1] == "S118" && row[3].contains("petrak_m1, petrak_m2")));
}

#[test]
fn a_finished_shard_is_not_done_again() {
    let folder = tempfile::tempdir().unwrap();
    let (data, out) = (folder.path().join("data"), folder.path().join("parts"));
    for name in ["petrak_m1", "petrak_m2", "petrak_m3"] {
        fs::create_dir_all(data.join(name)).unwrap();
        for file in ["fabric.toml", "results.csv"] {
            let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data").join(name).join(file);
            fs::copy(from, data.join(name).join(file)).unwrap();
        }
    }
    let data_text = text(&data);
    let inputs = [data_text.as_str(), CASES[0]];
    all(&inputs, 1, &out);
    let part = out.join("part-0001-of-0001.parquet");
    let first = fs::read(&part).unwrap();
    let again = |more: &[&str]| stderr(&shard(&inputs, "1/1", &out, more));
    assert!(again(&[]).contains("is there already"));
    assert!(!again(&["--fresh"]).contains("is there already"));
    assert_eq!(fs::read(&part).unwrap(), first, "the same again");
    // Another byte in a file, or in what is said of it, and another case are another part.
    let results = data.join("petrak_m2/results.csv");
    fs::write(&results, [&fs::read(&results).unwrap()[..], b"\n"].concat()).unwrap();
    assert!(!again(&[]).contains("is there already") && again(&[]).contains("is there already"));
    let about = data.join("petrak_m2/fabric.toml");
    fs::write(&about, [&fs::read(&about).unwrap()[..], b"# so\n"].concat()).unwrap();
    assert!(!again(&[]).contains("is there already"));
    let other = shard(&[data_text.as_str(), "cases/virtual_shear.toml"], "1/1", &out, &[]);
    assert!(!stderr(&other).contains("is there already"));
    // One that was cut is made again, and nothing is left of what was half written.
    let cut = out.join("_findings/part-0001-of-0001.parquet");
    fs::write(&cut, &fs::read(&cut).unwrap()[..60]).unwrap();
    fs::write(out.join("_findings/.part-0001-of-0001.parquet.abc123.half"), "half").unwrap();
    assert!(!again(&[]).contains("is there already"));
    done(&["merge", &text(&out)]);
    let names: Vec<_> =
        fs::read_dir(out.join("_findings")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names, ["part-0001-of-0001.parquet"]);
}

#[test]
fn parts_that_do_not_belong_together_are_told_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let (out, all_of_them) = (folder.path().join("parts"), folder.path().join("all.parquet"));
    let merge = ["merge", &text(&out), "-o", &text(&all_of_them)].map(str::to_string);
    let merge = merge.each_ref().map(String::as_str);
    let inputs = ["kesf_data/petrak_m1", "kesf_data/petrak_m2"];
    assert!(refused(&merge, "O065").contains("there is no part"));
    all(&inputs, 3, &out);
    done(&merge);
    fs::remove_file(&all_of_them).unwrap();
    assert!(stderr(&shard(&inputs, "1/2", &out, &[])).contains("O066"));
    let part = out.join("part-0002-of-0003.parquet");
    let bytes = fs::read(&part).unwrap();
    fs::remove_file(&part).unwrap();
    assert!(refused(&merge, "O065").contains("1 of 3 parts are missing, number 2 first"));
    for (broken, code) in [
        (&bytes[..bytes.len() / 2], "O067"),
        (b"mine".as_slice(), "O067"),
        // The part of another number, and a table of something else.
        (&fs::read(out.join("part-0001-of-0003.parquet")).unwrap(), "O067"),
        (&fs::read(out.join("_findings/part-0002-of-0003.parquet")).unwrap(), "O067"),
    ] {
        fs::write(&part, broken).unwrap();
        assert!(refused(&merge, code).contains("part-0002-of-0003.parquet"));
    }
    fs::write(&part, &bytes).unwrap();
    // One bit of a row: a letter of a name, which the pages hold as it is written.
    let paths = (1..=3).map(|k| out.join(format!("part-000{k}-of-0003.parquet")));
    let named = paths.map(|path| (fs::read(&path).unwrap(), path));
    let found = |(bytes, path): (Vec<u8>, PathBuf)| {
        Some((bytes.windows(8).position(|window| window == b"petrak_m")?, bytes, path))
    };
    let (at, whole, path) = named.filter_map(found).next().expect("a part with rows");
    let mut changed = whole.clone();
    changed[at] ^= 1;
    fs::write(&path, &changed).unwrap();
    assert!(refused(&merge, "O067").contains("a disk or a copy has changed it"));
    fs::write(&path, &whole).unwrap();
    // Of other inputs.
    let other = folder.path().join("other");
    all(&["kesf_data/petrak_m1", "kesf_data/petrak_m3"], 3, &other);
    for folder in ["", "_findings/", "_failures/"] {
        let name = format!("{folder}part-0002-of-0003.parquet");
        fs::copy(other.join(&name), out.join(&name)).unwrap();
    }
    assert!(refused(&merge, "O066").contains("than part-0001-of-0003.parquet"));
    assert!(!all_of_them.exists());
    // A table that somebody else wrote is not overwritten.
    let mine = folder.path().join("mine");
    fs::create_dir(&mine).unwrap();
    fs::copy(
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/parts/foreign.parquet"),
        mine.join("part-0001-of-0001.parquet"),
    )
    .unwrap();
    assert!(stderr(&shard(&inputs, "1/1", &mine, &[])).contains("O002"));
    assert_eq!(shard(&inputs, "1/1", &mine, &["--force"]).status.code(), Some(0));
    for wrong in ["4/3", "0/3", "3", "a/b"] {
        assert!(stderr(&shard(&inputs, wrong, &out, &[])).contains("shard"), "{wrong}");
    }
}

/// A shard ends as a run does: 2 where nothing useful was done, 1 where something was.
#[test]
fn a_shard_ends_as_a_run_does() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for (inputs, expected) in [(&["nowhere"][..], 2), (&["nowhere", "kesf_data/petrak_m1"], 1)] {
        let run = kesf(&[&["run", "--no-charts", "-o", &text(&at("run"))], inputs].concat());
        assert_eq!(run.status.code(), Some(expected), "{}", stderr(&run));
        // The second time the part is there.
        for time in ["made", "kept"] {
            let part = shard(inputs, "1/1", &at(&format!("parts-{expected}")), &[]);
            assert_eq!(part.status.code(), Some(expected), "{time}: {}", stderr(&part));
        }
    }
}

/// A table is CSV on standard output; a file that is to have text for people is refused, for there is none.
#[test]
fn a_merged_table_has_no_text_for_people() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    all(&["kesf_data/petrak_m1"], 1, &at("parts"));
    let csv = done(&["merge", &text(&at("parts"))]);
    assert!(String::from_utf8_lossy(&csv.stdout).starts_with("fabric,"));
    for name in ["all.txt", "all.xlsx"] {
        let said = refused(&["merge", &text(&at("parts")), "-o", &text(&at(name))], "O050");
        assert!(said.contains(".csv, .parquet or .json"), "{said}");
        assert!(!at(name).exists());
    }
    refused(&["read", "kesf_data/poplin", "-q", "-o", &text(&at("curves.txt"))], "O050");
}

#[test]
fn a_fabric_that_is_in_two_parts_is_told() {
    let folder = tempfile::tempdir().unwrap();
    // Two tables whose names fall to different shards name the same two fabrics.
    let table = "fabric,parameter,unit,warp,weft\none,B,gf·cm²/cm,0.1,0.1\ntwo,B,gf·cm²/cm,0.2,0.2\n";
    let names = ["a", "b", "c", "d"].map(|name| folder.path().join("data").join(format!("{name}.csv")));
    fs::create_dir(folder.path().join("data")).unwrap();
    names.iter().for_each(|name| fs::write(name, table).unwrap());
    let inputs: Vec<String> = names.iter().map(|name| text(name)).collect();
    let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
    let out = folder.path().join("parts");
    for number in ["1/2", "2/2"] {
        shard(&inputs, number, &out, &[]);
    }
    let said = refused(&["merge", &text(&out)], "O068");
    // Both parts, and both files.
    let (_, places) =
        said.split_once("one is in part-0001-of-0002.parquet too: here of ").expect("the parts");
    let (here, there) = places.split_once(", there of ").expect("both files");
    assert!(here.contains(".csv") && there.contains(".csv") && !there.starts_with(here), "{said}");
}

/// Rows of a table in order.
#[cfg(target_os = "linux")]
fn sorted(bytes: &[u8], columns: &[&str]) -> Vec<Vec<String>> {
    let mut rows = cells(bytes, columns);
    rows.sort();
    rows
}

/// Fabrics that get one name are told apart as in a run of all, in any number of shards, and what is not read of a fabric is
/// that fabric's, whatever its files are called.
#[cfg(target_os = "linux")]
#[test]
fn shards_name_fabrics_and_failures_as_a_run_does() {
    let folder = tempfile::tempdir().unwrap();
    let lab = folder.path().join("lab");
    let good = "parameter,unit,warp,weft\nB,gf·cm²/cm,0.1,0.1\n";
    let names = [
        "trail",
        "trail ",
        "trail-2",
        "a:b",
        "a-b",
        "ok",
        "g\u{e4}nse",
        "ga\u{308}nse",
        "Poplin",
        "poplin",
        "lot.1",
        "lot.2",
    ];
    for name in names {
        fs::create_dir_all(lab.join(name)).unwrap();
        fs::write(lab.join(name).join("results.csv"), good).unwrap();
    }
    std::os::unix::fs::symlink("ok", lab.join("linkok")).unwrap();
    for name in ["bad", "worse", "lot.3"] {
        fs::create_dir(lab.join(name)).unwrap();
        fs::write(lab.join(name).join("results.csv"), "\0\n").unwrap();
    }
    // The folder of them all is a fabric as well.
    fs::write(lab.join("lonely.csv"), good).unwrap();
    let [lab, run] = [text(&lab), text(&folder.path().join("run"))];
    assert_eq!(kesf(&["run", &lab, "--no-charts", "-o", &run, "-q"]).status.code(), Some(1));
    let written = |name: &str| fs::read(Path::new(&run).join(name)).unwrap();
    let columns = ["fabric", "code", "place", "message"];
    let problems = sorted(&written("problems.csv"), &columns);
    for name in ["bad", "worse", "lot.3"] {
        assert!(problems.iter().any(|row| row[0] == name && row[1] == "R003"), "{name}: {problems:?}");
    }
    let rows = cells(&written("fabrics.csv"), &["fabric", "status"]);
    assert!(rows.iter().any(|row| row == &["worse", "R003"]) && rows.iter().all(|row| row[0] != "results"));
    for count in [1, 3, 7] {
        let out = folder.path().join(count.to_string());
        for number in 1..=count {
            shard(&[&lab], &format!("{number}/{count}"), &out, &["-q"]);
        }
        let merged = |table: &str| done(&["merge", &text(&out), "--table", table]).stdout;
        let mut found = cells(&merged("findings"), &columns);
        found.extend(cells(&merged("failures"), &columns));
        found.sort();
        assert_eq!(found, problems, "{count}");
        let fabrics = |bytes: &[u8]| -> BTreeSet<String> {
            cells(bytes, &["fabric"]).into_iter().map(|mut row| row.remove(0)).collect()
        };
        let mut of_run = fabrics(&written("fabrics.csv"));
        of_run.retain(|name| !["bad", "worse", "lot.3"].contains(&name.as_str()));
        assert_eq!(fabrics(&merged("results")), of_run, "{count}");
    }
}

/// Cells of an answer as CSV.
fn found(library: &str, more: &[&str], columns: &[&str]) -> Vec<Vec<String>> {
    let folder = tempfile::tempdir().unwrap();
    let out = text(&folder.path().join("found.csv"));
    done(&[&["library", "find", library, "-o", &out], more].concat());
    cells(&fs::read(&out).unwrap(), columns)
}

#[test]
fn a_library_is_the_same_of_all_kinds_of_results_and_answers() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| text(&folder.path().join(name));
    all(&["kesf_data", CASES[0]], 3, &folder.path().join("parts"));
    done(&["merge", &at("parts"), "-o", &at("all.parquet")]);
    done(&["run", "kesf_data", "--no-charts", "-o", &at("run")]);
    fs::create_dir(folder.path().join("csv")).unwrap();
    fs::copy(folder.path().join("run/fabrics.csv"), folder.path().join("csv/fabrics.csv")).unwrap();
    let kinds = ["parts", "all.parquet", "run", "csv"];
    for kind in kinds {
        done(&["library", "build", &at(&format!("{kind}.library")), &at(kind)]);
    }
    let bytes = kinds.map(|kind| fs::read(at(&format!("{kind}.library"))).unwrap());
    assert!(bytes.iter().all(|other| *other == bytes[0]));
    let library = at("run.library");
    // Bounds are what they say, in KES units.
    let every = found(&library, &["-n", "99"], &["fabric", "thickness", "B_warp"]);
    assert_eq!(every.len(), 13);
    let within: Vec<_> = every
        .iter()
        .filter(|row| {
            row[1].parse().is_ok_and(|t: f64| t < 0.6) && row[2].parse().is_ok_and(|b: f64| b < 0.12)
        })
        .map(|row| vec![row[0].clone()])
        .collect();
    assert!(!within.is_empty() && within.len() < 13);
    let bounds = ["--where", "thickness < 0.6 and B_warp < 0.12"];
    assert_eq!(found(&library, &bounds, &["fabric"]), within);
    // The nearest come first; the fabric itself is left out, but not where it is given by its path.
    let near = found(&library, &["--like", "poplin", "-n", "99"], &["fabric", "distance"]);
    let distances: Vec<f64> = near.iter().map(|row| row[1].parse().unwrap()).collect();
    assert!(distances.is_sorted() && near.iter().all(|row| row[0] != "poplin"));
    let own =
        found(&library, &["--like", "kesf_data/poplin", "-n", "1"], &["fabric", "distance", "parameters"]);
    assert!(own[0][0] == "poplin" && own[0][1].parse::<f64>().unwrap() < 1e-9);
    // What is asked for does not change what is usual in the library.
    for row in found(&library, &[&["--like", "poplin"][..], &bounds].concat(), &["fabric", "distance"]) {
        assert!(near.contains(&row));
    }
}

#[test]
fn what_a_library_cannot_answer_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| text(&folder.path().join(name));
    refused(&["library", "build", &at("l"), &at("nowhere")], "O069");
    fs::create_dir(at("empty")).unwrap();
    refused(&["library", "build", &at("l"), &at("empty")], "O065");
    fs::write(at("none.csv"), "a,b\n1,2\n").unwrap();
    refused(&["library", "build", &at("l"), &at("none.csv")], "O069");
    all(&["kesf_data/petrak_m1"], 1, &folder.path().join("parts"));
    refused(&["library", "build", &at("l"), &at("parts"), &at("parts")], "O068");
    assert!(!Path::new(&at("l")).exists());
    done(&["library", "build", &at("l"), &at("parts")]);
    refused(&["library", "find", &at("nowhere")], "O070");
    refused(&["library", "find", &at("parts/part-0001-of-0001.parquet")], "O070");
    fs::write(at("cut"), &fs::read(at("l")).unwrap()[..100]).unwrap();
    refused(&["library", "find", &at("cut")], "O070");
    let said = refused(&["library", "find", &at("l"), "--where", "tickness < 0.4"], "O071");
    assert!(said.contains("no column `tickness` (at character 1); there are fabric, "), "{said}");
    refused(&["library", "find", &at("l"), "--where", "thickness <"], "O071");
    refused(&["library", "find", &at("l"), "--like", "denim"], "O072");
    // One fabric says nothing of what is usual.
    let said = refused(&["library", "find", &at("l"), "--like", "petrak_m1"], "O072");
    assert!(said.contains("the fabrics of the library differ in 0 of these"), "{said}");
}
