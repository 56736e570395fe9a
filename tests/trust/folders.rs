//! Folders of results and folders of inputs in one place, and names that are more than names.

use std::fs;
use std::path::Path;

use crate::{code, first_cells, run, stderr, table, write};

const CASE: &str = "cases/cantilever_strip.toml";

/// A second run into the folder of its measurements sees no fabric that the first did not see.
#[test]
fn results_among_the_inputs_are_no_measurements() {
    // Output within input, equal to it, and input within output. The last two are folders of results, into which somebody has
    // put measurements since: others with measurements are refused.
    for (input, output) in [("lab", "lab/out"), ("lab", "lab"), ("out/lab", "out")] {
        let folder = tempfile::tempdir().unwrap();
        let [input, output] = [input, output].map(|name| folder.path().join(name));
        if !output.starts_with(&input) || input == output {
            write(&folder.path().join("first"), "t.csv", &table(&["A"]));
            let [first, output] = [folder.path().join("first"), output.clone()];
            run(&["run", "--no-charts", first.to_str().unwrap(), "-o", output.to_str().unwrap()]);
        }
        write(&input, "t.csv", &table(&["A", "B"]));
        let tables = |time: &str| {
            let done =
                run(&["run", "--no-charts", input.to_str().unwrap(), CASE, "-o", output.to_str().unwrap()]);
            assert_eq!(code(&done), 0, "{time}: {}", stderr(&done));
            let tables =
                ["fabrics.csv", "predictions.csv"].map(|name| fs::read_to_string(output.join(name)).unwrap());
            (tables, stderr(&done))
        };
        let (first, _) = tables("first");
        let (second, errors) = tables("second");
        assert_eq!(first, second, "{input:?} into {output:?}");
        assert_eq!(first_cells(&output.join("fabrics.csv")), ["A", "B"]);
        let said = errors.contains("O061") && errors.contains("results of this program");
        assert_eq!(
            said,
            input == output,
            "results beside measurements are told, a folder of results is passed by: {errors}"
        );
    }
}

/// Results that are named as inputs, by their folder or one by one, give nothing and are told.
#[test]
fn results_that_are_named_are_no_measurements() {
    let folder = tempfile::tempdir().unwrap();
    let [lab, out, copy] = ["lab", "out", "copy"].map(|name| folder.path().join(name));
    write(&lab, "t.csv", &table(&["A"]));
    run(&["run", "--no-charts", lab.to_str().unwrap(), "-o", out.to_str().unwrap()]);
    let tables = out.join("fabrics.csv");
    // As `cp results/*` leaves them, without the hidden list.
    fs::create_dir(&copy).unwrap();
    for name in ["fabrics.csv", "run.json"] {
        fs::copy(out.join(name), copy.join(name)).unwrap();
    }
    for input in [&out, &tables, &copy] {
        let done = run(&["characterise", input.to_str().unwrap()]);
        assert_eq!(code(&done), 2, "{}", stderr(&done));
        assert!(stderr(&done).contains("O061"), "{}", stderr(&done));
    }
}

/// What two inputs name is one fabric, and its repeats do not count twice.
#[test]
fn what_is_named_twice_is_read_once() {
    let folder = tempfile::tempdir().unwrap();
    let lab = folder.path().join("lab");
    for name in ["a", "b"] {
        write(&lab.join(name), "t.csv", &table(&[name]));
    }
    let [lab, a, file] = ["lab", "lab/a", "lab/a/t.csv"].map(|name| folder.path().join(name));
    let [lab, a, file] = [&lab, &a, &file].map(|path| path.to_str().unwrap());
    let fabrics = |inputs: &[&str]| {
        let done = run(&[&["characterise"], inputs].concat());
        assert_eq!(code(&done), 0, "{}", stderr(&done));
        (String::from_utf8(done.stdout.clone()).unwrap(), stderr(&done))
    };
    let (once, errors) = fabrics(&[lab]);
    assert!(!errors.contains("O075"), "{errors}");
    for inputs in
        [&[lab, lab][..], &[lab, a], &[lab, file], &[file, lab], &[a, lab, &format!("{lab}/../lab/b")]]
    {
        let (again, errors) = fabrics(inputs);
        assert_eq!(again, once, "{inputs:?}");
        assert!(errors.contains("O075") && !errors.contains("O056"), "{inputs:?}: {errors}");
    }
    // Others of one name are two.
    write(&folder.path().join("other/a"), "t.csv", &table(&["a"]));
    let (_, errors) = fabrics(&[a, folder.path().join("other/a").to_str().unwrap()]);
    assert!(errors.contains("O056") && !errors.contains("O075"), "{errors}");
}

/// A file of somebody else is told before the work and not at its end.
#[test]
fn a_table_of_somebody_else_is_told_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    write(&out, "predictions.csv", "mine\n");
    let arguments = ["run", "--no-charts", "kesf_data/petrak_m1", CASE, "-o", out.to_str().unwrap()];
    let done = run(&arguments);
    assert_eq!(code(&done), 2);
    assert!(stderr(&done).contains("O002") && stderr(&done).contains("predictions.csv"), "{}", stderr(&done));
    assert!(!out.join("petrak_m1").exists(), "nothing was computed");
    assert_eq!(code(&run(&[&arguments[..], &["--force"]].concat())), 0);
}

/// `kesf characterise` and `kesf run` say the same of a fabric.
#[test]
fn the_sheet_of_a_run_is_that_of_characterise() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let read = |bytes: &[u8]| serde_json::from_slice::<serde_json::Value>(bytes).unwrap();
    run(&["run", "--no-charts", "kesf_data/poplin", "-o", out.to_str().unwrap()]);
    let of_run = read(&fs::read(out.join("poplin/sheet.json")).unwrap());
    let characterised = read(&run(&["characterise", "kesf_data/poplin", "--json"]).stdout);
    assert_eq!(characterised["fabrics"], of_run["fabrics"]);
    assert_eq!(characterised["fabrics"][0]["friction_bands"].as_array().unwrap().len(), 7);
}

/// A name that a spreadsheet would run is text in every table.
#[test]
fn names_are_no_formulas() {
    let folder = tempfile::tempdir().unwrap();
    let [lab, out] = ["lab", "out"].map(|name| folder.path().join(name));
    let names = ["=cmd calc!A0", "+1", "-2", "@SUM(A1)", "＝3", "＋4", "－5", "＠SUM(A2)"];
    for name in names {
        write(&lab.join(name), "fabric.toml", "areal_density = \"100 g/m²\"\n");
        write(&lab.join(name), "t.csv", "parameter,unit,warp,weft\nB,gf·cm²/cm,0.1,0.1\n");
    }
    let done = run(&["run", "--no-charts", lab.to_str().unwrap(), CASE, "-o", out.to_str().unwrap()]);
    assert!([0, 1].contains(&code(&done)), "{}", stderr(&done));
    for name in ["fabrics.csv", "predictions.csv", "problems.csv"] {
        let mut reader = csv::ReaderBuilder::new().from_path(out.join(name)).unwrap();
        for row in reader.records() {
            for cell in row.unwrap().iter().filter(|cell| cell.parse::<f64>().is_err()) {
                assert!(
                    !cell.starts_with(['=', '+', '-', '@', '\t', '\r', '＝', '＋', '－', '＠']),
                    "{name}: {cell}"
                );
            }
        }
    }
    let fabrics = first_cells(&out.join("fabrics.csv"));
    assert!(names.iter().all(|name| fabrics.contains(&format!("'{name}"))), "{fabrics:?}");
}

/// What a link no longer leads to is missing, and is told.
#[cfg(unix)]
#[test]
fn links_that_lead_nowhere_are_told() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "t.csv", &table(&["A"]));
    std::os::unix::fs::symlink("/nowhere/weft.csv", folder.path().join("weft.csv")).unwrap();
    // Something is missing, also where nobody wants to hear of findings.
    let done = run(&["characterise", folder.path().to_str().unwrap(), "-q"]);
    assert_eq!(code(&done), 1, "{}", stderr(&done));
    assert!(stderr(&done).contains("weft.csv: O062"), "{}", stderr(&done));
}

/// Cells of the rows of a table that have this one among them.
fn rows_with(path: &Path, cell: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().from_path(path).unwrap();
    let rows = reader.records().map(|row| row.unwrap().iter().map(str::to_string).collect::<Vec<_>>());
    rows.filter(|row| row.iter().any(|c| c == cell)).collect()
}

/// A fabric behind a link that leads nowhere is one that failed, in a run and in its parts.
#[cfg(unix)]
#[test]
fn a_fabric_behind_a_link_that_leads_nowhere_failed() {
    let folder = tempfile::tempdir().unwrap();
    let [lab, out, parts] = ["lab", "out", "parts"].map(|name| folder.path().join(name));
    write(&lab.join("a"), "results.csv", &table(&["a"]));
    // The folder of both is a fabric too, and not the one that is missing.
    write(&lab, "own.csv", &table(&["lab"]));
    std::os::unix::fs::symlink("/nowhere/b", lab.join("b.2")).unwrap();
    std::os::unix::fs::symlink("/nowhere/c.csv", lab.join("a/results_2.csv")).unwrap();
    let [lab, to, parts] = [&lab, &out, &parts].map(|path| path.to_str().unwrap());
    let done = run(&["run", "--no-charts", lab, "-o", to, "-q"]);
    assert_eq!((code(&done), stderr(&done).matches("O062").count()), (1, 2), "{}", stderr(&done));
    let failed: Vec<_> =
        rows_with(&out.join("fabrics.csv"), "O062").into_iter().map(|row| row[0].clone()).collect();
    assert_eq!(failed, ["b.2", "a"]);
    for shard in ["1/2", "2/2"] {
        run(&["run", "--shard", shard, lab, "-o", parts, "-q"]);
    }
    let merged = run(&["merge", parts, "--table", "failures"]);
    let text = String::from_utf8(merged.stdout).unwrap();
    assert!(text.contains("a,O062,") && text.contains("b.2,O062,"), "{text}");
    let checked = run(&["check", lab]);
    assert_eq!(code(&checked), 1);
}

/// A folder of a fabric from which nothing is read is told, and one of something else is not.
#[test]
fn folders_without_a_measurement_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let [lab, out] = ["lab", "out"].map(|name| folder.path().join(name));
    write(&lab.join("good"), "results.csv", &table(&["good"]));
    write(&lab.join("scans"), "scan.pdf", "%PDF");
    write(&lab.join("scans"), "bending", "?");
    write(&lab.join("hidden"), ".results.csv", "x");
    write(&lab.join("cases"), "strip.toml", &fs::read_to_string(CASE).unwrap());
    fs::create_dir(lab.join("empty")).unwrap();
    // Folders of tests are one fabric.
    write(&lab.join("tests/bending"), "a.doc", "");
    write(&lab.join("tests/shear"), "b.doc", "");
    let [lab, to] = [&lab, &out].map(|path| path.to_str().unwrap());
    let checked = run(&["check", lab]);
    let said = stderr(&checked);
    assert_eq!((code(&checked), said.matches("O081").count()), (0, 4), "{said}");
    assert!(said.contains("scans: O081") && said.contains("(2 files of other kinds: .pdf, none)"), "{said}");
    assert!(said.contains("hidden: O081") && said.contains("(a hidden file)"), "{said}");
    assert!(said.contains("empty: O081") && said.contains("(it is empty)"), "{said}");
    assert!(said.contains("tests: O081") && said.contains("(2 files of other kinds: .doc)"), "{said}");
    assert_eq!(code(&run(&["check", lab, "--strict"])), 1);
    let document: serde_json::Value = serde_json::from_slice(&run(&["check", lab, "--json"]).stdout).unwrap();
    let findings = document["findings"].as_array().unwrap();
    assert_eq!(findings.iter().filter(|finding| finding["code"] == "O081").count(), 4);
    assert_eq!(code(&run(&["run", "--no-charts", lab, "-o", to, "-q"])), 0);
    assert_eq!(rows_with(&out.join("problems.csv"), "O081").len(), 4);
    assert!(fs::read_to_string(out.join("index.html")).unwrap().contains("O081"));
}

/// A measurement that does not end as one is told where it lies, and a picture or a text is not.
#[test]
fn measurements_with_other_endings_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let [lab, out] = ["lab", "out"].map(|name| folder.path().join(name));
    let record = fs::read_to_string("kesf_data/poplin/poplin_warp_FB1_1.csv").unwrap();
    write(&lab.join("twill"), "bending_warp.csv", &record);
    for name in ["bending.003", "bending.bak", "bending.LST", "shear", "raw.out"] {
        write(&lab.join("twill"), name, &record);
    }
    for (name, text) in [
        ("README", "1 2\n3 4\n5 6\n"),
        ("notes.md", "1 2\n3 4\n5 6\n"),
        ("strip.vtu", "1 2\n3 4\n5 6\n"),
        ("letter", "Dear sirs,\nthe 3 samples of 5 May are on their way to you now.\n"),
        ("bending.txt~", &record),
        (".hidden", &record),
    ] {
        write(&lab.join("twill"), name, text);
    }
    write(&lab.join("other"), "bending.003", &record);
    let [lab, to] = [&lab, &out].map(|path| path.to_str().unwrap());
    let said = stderr(&run(&["check", lab]));
    let sentence = "5 files that hold numbers were not read, as they do not end as measurements do (.003, .bak, .lst, .out, none): \
                    \"bending.003\", \"bending.LST\", \"bending.bak\" and 2 more";
    assert!(said.contains("twill: O080") && said.contains(sentence), "{said}");
    assert!(
        said.contains("other: O080 a file that holds numbers was not read") && said.contains("other: O081"),
        "{said}"
    );
    run(&["run", "--no-charts", lab, "-o", to, "-q"]);
    let rows = rows_with(&out.join("problems.csv"), "O080");
    assert!(rows.len() == 2 && rows.iter().any(|row| row.iter().any(|cell| cell == "twill")), "{rows:?}");
    // What is named is read.
    let named = format!("{lab}/other/bending.003");
    assert_eq!(code(&run(&["characterise", &named])), 0);
}
