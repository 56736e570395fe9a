//! What is not measured, rests on an assumption, stands for two, was not simulated or is lost is told in every table.

use super::*;

/// Column -> cell of each row of a table.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::ReaderBuilder::new().from_path(path).unwrap();
    let header = reader.headers().unwrap().clone();
    let named =
        |row: csv::StringRecord| header.iter().zip(row.iter()).map(|(n, c)| (n.into(), c.into())).collect();
    reader.records().map(|row| named(row.unwrap())).collect()
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn lines_with<'t>(text: &'t str, part: &str) -> Vec<&'t str> {
    text.lines().filter(|line| line.contains(part)).collect()
}

#[test]
fn a_run_tells_origins_assumptions_and_what_was_measured() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let fabric = "kesf_data/matsudaira_a_cotton_broad";
    let cases = ["cases/cantilever.toml", "cases/virtual_bending.toml", "cases/virtual_shear.toml"];
    let arguments = [&["run", "--no-charts", fabric][..], &cases, &["-o", out.to_str().unwrap()]].concat();
    let text = stdout(&run(&arguments));
    let [line] = lines_with(&text, "matsudaira_a_cotton_broad (published data)")[..] else {
        panic!("{text}")
    };
    assert_eq!(line.matches(" both").count(), 2, "B is one value: {line}");
    assert!(text.contains("both: one value for warp and weft together"), "{text}");
    let fabrics = rows(&out.join("fabrics.csv"));
    assert!(fabrics.iter().all(|row| row["origin"] == "published"), "{fabrics:?}");
    let drape = fabrics.iter().find(|row| row["parameter"] == "drape_coefficient").unwrap();
    assert!(
        (drape["mean"].parse::<f64>().unwrap() - 0.829).abs() < 1e-12 && drape["unit"] == "1",
        "{drape:?}"
    );
    let predictions = rows(&out.join("predictions.csv"));
    let of = |quantity: &str| predictions.iter().find(|row| row["quantity"] == quantity).unwrap();
    assert!(predictions.iter().all(|row| row["origin"] == "published"));
    assert_eq!(
        (of("G warp")["status"].as_str(), of("G warp")["remark"].as_str()),
        ("assumed", "rests on an assumed G")
    );
    assert_eq!(
        (of("B warp")["status"].as_str(), of("B warp")["remark"].as_str()),
        ("", "measured for warp and weft together; rests on one B for warp and weft")
    );
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    assert!(page.contains("Measured drape coefficient") && page.contains("82.9 % (Cusick drape"));
    assert!(page.contains("rests on an assumed G"));
    let document: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap();
    assert_eq!(document["origins"][0]["origin"], "published");
}

#[test]
fn solve_and_compare_say_where_data_come_from_and_name_a_fabric_once() {
    for (command, case) in [("solve", "cases/seed_clamped.toml"), ("compare", "cases/virtual_bending.toml")] {
        let fabric = "kesf_data/matsudaira_a_cotton_broad";
        let done = run(&[command, case, fabric]);
        assert!(stdout(&done).contains("matsudaira_a_cotton_broad (published data)"), "{}", stdout(&done));
        let told = stderr(&done);
        assert!(told.contains("C010") && !told.contains("broad: matsudaira"), "{told}");
        let document: serde_json::Value =
            serde_json::from_slice(&run(&[command, case, fabric, "--json"]).stdout).unwrap();
        let entries = document["solutions"].as_array().or(document["comparisons"].as_array()).unwrap();
        assert!(
            !entries.is_empty() && entries.iter().all(|entry| entry["origin"] == "published"),
            "{command}"
        );
    }
}

#[test]
fn a_fabric_of_which_nothing_can_be_read_has_a_row_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let (data, out) = (folder.path().join("data"), folder.path().join("out"));
    write(&data, "whole/fabric.toml", "name = \"Whole\"\n");
    write(&data, "whole/results.csv", "parameter,unit,warp,weft\nB,gf·cm²/cm,0.1,0.05\nW,mg/cm²,10,\n");
    write(&data, "broken/fabric.toml", "name = Broken\n");
    write(&data, "broken/results.csv", "parameter,unit,warp,weft\nB,gf·cm²/cm,0.1,0.05\n");
    let data = data.to_str().unwrap();
    let done = run(&["run", "--no-charts", data, "cases/cantilever.toml", "-o", out.to_str().unwrap()]);
    let (text, told) = (stdout(&done), stderr(&done));
    let [line] = lines_with(&text, "broken")[..] else { panic!("{text}") };
    assert!(line.split_whitespace().last().unwrap().starts_with('R'), "{text}");
    assert!(told.contains("1 failure and "), "{told}");
    let problems = rows(&out.join("problems.csv"));
    let problem = problems.iter().find(|row| row["fabric"] == "broken").unwrap();
    assert!(problem["code"].starts_with('R'), "{problem:?}");
    assert!(fs::read_to_string(out.join("index.html")).unwrap().contains("broken"));
    let checked = stdout(&run(&["check", data]));
    let [line] = lines_with(&checked, "broken")[..] else { panic!("{checked}") };
    assert!(line.contains("fabric") && line.split_whitespace().last().unwrap().starts_with('R'), "{checked}");
}

/// A fabric without an areal density has no section of its own, and simulated tests all the same: what stands in there is told.
#[test]
fn what_stands_in_is_told_of_a_fabric_without_an_areal_density() {
    let folder = tempfile::tempdir().unwrap();
    let (fabric, out) = (folder.path().join("light"), folder.path().join("out"));
    fs::create_dir(&fabric).unwrap();
    fs::write(fabric.join("t.csv"), "parameter,direction,mean,sd,n,unit\nB,warp,0.08,0.005,5,gf·cm²/cm\n")
        .unwrap();
    let [fabric, to] = [&fabric, &out].map(|path| path.to_str().unwrap());
    run(&["run", "--no-charts", fabric, "cases/virtual_bending.toml", "-o", to]);
    let codes: std::collections::BTreeSet<String> =
        rows(&out.join("problems.csv")).iter().map(|row| row["code"].clone()).collect();
    for code in ["C004", "C010", "C012", "C013"] {
        assert!(codes.contains(code), "{code}: {codes:?}");
    }
    let predictions = rows(&out.join("predictions.csv"));
    let of = |quantity: &str| predictions.iter().find(|row| row["quantity"] == quantity).unwrap();
    assert_eq!((of("B warp")["inputs"].as_str(), of("B weft")["inputs"].as_str()), ("measured", "assumed"));
    assert_ne!(of("B warp")["simulated_low"], "");
    assert_eq!(of("B weft")["simulated_low"], "", "the weft has none of the repeats of the warp");
}

/// What is ended before anything is written does not say that something stays.
#[cfg(unix)]
#[test]
fn an_interruption_says_what_is_there() {
    let mut command = kesf();
    // It waits for what nobody writes.
    command.args(["characterise", "-"]).stdin(Stdio::piped()).stderr(Stdio::piped()).stdout(Stdio::null());
    let child = command.spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(500));
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let mut child = child;
    let held = child.stdin.take();
    let done = child.wait_with_output().unwrap();
    drop(held);
    assert_eq!(done.status.code(), Some(130));
    assert_eq!(stderr(&done), "interrupted: nothing was written\n");
}
