//! Folders of results and folders of inputs in one place, and names that are more than names.

use std::fs;

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
    let done = run(&["characterise", folder.path().to_str().unwrap()]);
    assert_eq!(code(&done), 0, "{}", stderr(&done));
    assert!(stderr(&done).contains("weft.csv: O062"), "{}", stderr(&done));
}
