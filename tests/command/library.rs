//! What a library of fabrics says of its values and of its answers.
//!
//! Kind: own. Statuses are those of `fabrics.csv`, distances and counts are written out once more.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

/// What a command ends with, and what it says.
struct Ended {
    code: i32,
    out: String,
    err: String,
}

fn kesf(folder: &Path, arguments: &[&str]) -> Ended {
    let output =
        Command::new(env!("CARGO_BIN_EXE_kesf")).current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ended { code: output.status.code().unwrap(), out: text(&output.stdout), err: text(&output.stderr) }
}

fn done(folder: &Path, arguments: &[&str]) -> Ended {
    let ended = kesf(folder, arguments);
    assert_eq!(ended.code, 0, "{arguments:?}: {}", ended.err);
    ended
}

fn found(folder: &Path, more: &[&str]) -> Value {
    let ended = done(folder, &[&["--json", "library", "find", "l.parquet"], more].concat());
    serde_json::from_str(&ended.out).unwrap()
}

/// The row of a fabric in an answer.
fn of<'a>(answer: &'a Value, fabric: &str) -> &'a Value {
    let rows = answer["fabrics"].as_array().unwrap();
    rows.iter().find(|row| row["fabric"] == fabric).unwrap_or_else(|| panic!("{fabric}: {answer}"))
}

/// Values of a fabric: B in warp and weft, 2HB in warp and weft, T0 and W.
type Cloth = [Option<f64>; 6];

const HEADS: [(&str, &str, &str); 6] = [
    ("B", "warp", "gf·cm²/cm"),
    ("B", "weft", "gf·cm²/cm"),
    ("2HB", "warp", "gf·cm/cm"),
    ("2HB", "weft", "gf·cm/cm"),
    ("T0", "", "mm"),
    ("W", "", "mg/cm²"),
];

fn cloth(i: u32) -> Cloth {
    let x = f64::from(i);
    [0.05 + 0.01 * x, 0.04 + 0.005 * x, 0.03 + 0.004 * x, 0.02 + 0.003 * x, 0.3 + 0.02 * x, 10.0 + x]
        .map(Some)
}

/// Twelve fabrics; one that is F03 but for an impossible value, one of which only the warp of F03 is known, one whose
/// mean hides an impossible value, and one with two values.
fn cloths() -> BTreeMap<String, Cloth> {
    let mut cloths: BTreeMap<String, Cloth> = (1..=12).map(|i| (format!("F{i:02}"), cloth(i))).collect();
    let [bw, bf, hw, hf, t, w] = cloth(3);
    cloths.insert("twin".into(), [Some(-0.3), bf, hw, hf, t, w]);
    cloths.insert("half".into(), [bw, None, hw, None, t, w]);
    cloths.insert("odd".into(), [Some(-0.01), Some(0.3), hw, hf, t, w]);
    cloths.insert("poor".into(), [None, None, None, None, t, w]);
    cloths
}

/// Makes `l.parquet` of them.
fn library(root: &Path) {
    let mut table = String::from("fabric,parameter,direction,mean,unit\n");
    for (fabric, values) in cloths() {
        for ((parameter, direction, unit), value) in HEADS.iter().zip(values) {
            if let Some(value) = value {
                table += &format!("{fabric},{parameter},{direction},{value},{unit}\n");
            }
        }
    }
    fs::write(root.join("t.csv"), table).unwrap();
    kesf(root, &["run", "-q", "t.csv", "--no-charts", "-o", "out"]);
    done(root, &["library", "build", "l.parquet", "out"]);
}

/// log10 of the mean of warp and weft, or of the one that is known.
fn coordinate(values: &[Option<f64>]) -> Option<f64> {
    let known: Vec<f64> = values.iter().copied().flatten().collect();
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    (mean > 0.0).then(|| mean.log10())
}

fn coordinates(cloth: &Cloth) -> [Option<f64>; 4] {
    [&cloth[..2], &cloth[2..4], &cloth[4..5], &cloth[5..]].map(coordinate)
}

/// The distance of two fabrics of which both directions are known.
fn by_hand(a: &str, b: &str) -> f64 {
    let cloths = cloths();
    let [x, y] = [a, b].map(|name| coordinates(&cloths[name]));
    let squares = (0..4).map(|axis| {
        let all: Vec<f64> = cloths.values().filter_map(|cloth| coordinates(cloth)[axis]).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let variance = all.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (all.len() - 1) as f64;
        (x[axis].unwrap() - y[axis].unwrap()).powi(2) / variance
    });
    (squares.sum::<f64>() / 4.0).sqrt()
}

#[test]
fn likeness_says_what_it_could_not_compare_and_what_is_doubtful() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    library(root);
    let answer = found(root, &["--like", "F03", "-n", "99"]);
    for name in ["F01", "F02", "F07", "F12"] {
        let row = of(&answer, name);
        let distance = row["distance"].as_f64().unwrap();
        assert!((distance - by_hand("F03", name)).abs() < 1e-9, "{name}: {distance}");
        let told = [&row["parameters"], &row["not_compared"], &row["doubtful"]];
        assert_eq!(told, [&json!(4), &Value::Null, &Value::Null], "{name}");
    }
    let told = |name: &str| {
        let row = of(&answer, name);
        json!([row["parameters"], row["not_compared"], row["doubtful"]])
    };
    // A value below 0 makes no twin in silence, and what was read of the same bending test is doubtful too.
    assert_eq!(told("twin"), json!([3, "B", "2HB_warp"]));
    assert_eq!(of(&answer, "twin")["B_warp_status"], "doubtful");
    // What is the same in everything that was measured is the nearest.
    assert_eq!(told("half"), json!([4, "B_weft, 2HB_weft", null]));
    assert_eq!(of(&answer, "half")["distance"], 0.0);
    assert_eq!(told("odd"), json!([4, null, "B_warp, 2HB_warp"]));
    assert_eq!((&answer["apart"], &answer["total"]), (&json!(1), &json!(14)));
    // What is doubtful of the fabric that is asked about is told too.
    let of_twin = found(root, &["--like", "odd"]);
    assert_eq!(of_twin["like_status"], json!({"B_warp": "doubtful", "2HB_warp": "doubtful"}));
    let text = done(root, &["library", "find", "l.parquet", "--like", "F03", "-n", "99"]).out;
    let line = |name: &str| text.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(line("twin").contains(" ? ") && line("twin").ends_with("  2HB_warp"), "{text}");
    assert!(text.contains("? doubtful (see its findings), * rests on an assumption"), "{text}");
    assert!(text.contains("1 fabric shares fewer than 3 parameters with it"), "{text}");
    let path = done(root, &["library", "find", "l.parquet", "--like", "odd", "-o", "near.csv"]);
    assert!(
        path.err.contains("not plainly measured: 2HB_warp (doubtful), B_warp (doubtful)"),
        "{}",
        path.err
    );
}

#[test]
fn bounds_say_whom_they_leave_out_and_what_is_meant() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    library(root);
    let answer = found(root, &["--where", "B_weft < 1 and thickness < 9"]);
    assert_eq!((&answer["total"], &answer["without_value"]), (&json!(14), &json!({"B_weft": 2})));
    let text = done(root, &["library", "find", "l.parquet", "--where", "B_weft < 1"]).out;
    assert!(text.contains("2 fabrics have no B_weft\n"), "{text}");
    let answer = found(root, &["--where", "origin = 'Measured' or fabric = 'F01'"]);
    let none = json!([{"column": "origin", "text": "Measured", "known": ["measured"]}]);
    assert_eq!((&answer["total"], &answer["no_such_text"]), (&json!(1), &none));
    let answer = found(root, &["--where", "B_warp_status <> 'doubtful' and fabric <> 'f02'"]);
    assert_eq!((&answer["total"], &answer["no_such_text"][0]["known"]), (&json!(13), &json!([])));
    let wrong = kesf(root, &["library", "find", "l.parquet", "--where", "b_warp < 1"]);
    assert!(wrong.code == 2 && wrong.err.contains("did you mean `B_warp`?"), "{}", wrong.err);
    // Three of four values are the same everywhere.
    let rows: String = (1..=4).map(|i| format!("G{i},0.6,0.1,0.05,{i}\n")).collect();
    fs::write(root.join("same.csv"), format!("fabric,LT,B (gf·cm²/cm),2HB (gf·cm/cm),W (mg/cm²)\n{rows}"))
        .unwrap();
    done(root, &["run", "-q", "same.csv", "--no-charts", "-o", "same"]);
    done(root, &["library", "build", "same.parquet", "same"]);
    let apart = kesf(root, &["library", "find", "same.parquet", "--like", "G1"]).err;
    assert!(
        apart.contains("share 4 parameters, and the fabrics of the library differ in 1 of these"),
        "{apart}"
    );
}

#[test]
fn tables_and_documents_hold_all_that_is_within_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    library(root);
    let rows = |more: &[&str]| {
        let ended = done(root, &[&["library", "find", "l.parquet", "--force", "-o", "x.csv"], more].concat());
        (fs::read_to_string(root.join("x.csv")).unwrap().lines().count() - 1, ended.err)
    };
    assert_eq!(rows(&["--where", "T0 > 0"]), (16, String::new()));
    let (count, said) = rows(&["--where", "T0 > 0", "-n", "5"]);
    assert!(count == 5 && said.contains("11 fabrics more, not shown: -n 16 shows all"), "{said}");
    let (count, said) = rows(&["--like", "F03"]);
    assert!(count == 10 && said.contains("4 fabrics more, not shown"), "{said}");
    assert_eq!(found(root, &[])["fabrics"].as_array().unwrap().len(), 16);
    let cut = found(root, &["-n", "2"]);
    assert_eq!((cut["fabrics"].as_array().unwrap().len(), &cut["total"]), (2, &json!(16)));
}

/// What `fabrics.csv` says of each value, the library says too; older libraries, which do not, are refused.
#[test]
fn a_library_keeps_how_each_value_was_had() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data");
    done(root, &["run", "-q", data.to_str().unwrap(), "--no-charts", "-o", "out"]);
    done(root, &["library", "build", "l.parquet", "out"]);
    let answer = found(root, &[]);
    let mut statuses: BTreeMap<String, usize> = BTreeMap::new();
    for row in csv::Reader::from_path(root.join("out/fabrics.csv")).unwrap().records() {
        let row = row.unwrap();
        let [fabric, parameter, direction, status] = [0, 1, 2, 7].map(|at| row[at].to_string());
        let name = if direction.is_empty() { parameter } else { format!("{parameter}_{direction}") };
        let name = name.replace(' ', "_");
        let one = of(&answer, &fabric);
        if one.get(&name).is_some() {
            assert_eq!(one[format!("{name}_status")], status.as_str(), "{fabric} {name}");
            *statuses.entry(status).or_default() += 1;
        }
    }
    assert_eq!(statuses.keys().collect::<Vec<_>>(), ["assumed", "doubtful", "inferred", "measured"]);
    assert_eq!(of(&answer, "poplin")["thickness_status"], of(&answer, "poplin")["T0_status"]);
    let earlier = fs::read(root.join("l.parquet")).unwrap();
    let (_, table) = kesf::report::arrow::read(earlier.into()).unwrap();
    let earlier = kesf::report::arrow::write(&table, &[("kesf.library", "1")]).unwrap();
    fs::write(root.join("earlier.parquet"), earlier).unwrap();
    let refused = kesf(root, &["library", "find", "earlier.parquet"]);
    assert!(refused.code == 2 && refused.err.contains("O070") && refused.err.contains("build it again"));
}

#[test]
fn fabrics_without_values_are_told_and_results_of_a_broken_run_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let head = "parameter,direction,mean,unit\n";
    for (name, rows) in [("good", "B,warp,0.1,gf·cm²/cm\n"), ("a", ""), ("b", "B,warp,n/a,gf·cm²/cm\n")] {
        fs::create_dir_all(root.join("data").join(name)).unwrap();
        fs::write(root.join("data").join(name).join("results.csv"), format!("{head}{rows}")).unwrap();
    }
    kesf(root, &["run", "-q", "data", "--no-charts", "-o", "out"]);
    kesf(root, &["run", "-q", "data", "--shard", "1/1", "-o", "parts"]);
    for results in ["out", "parts"] {
        let built = done(root, &["library", "build", "--force", "l.parquet", results]).err;
        assert_eq!(built, "l.parquet: 1 fabric; 2 without KES values are left out: a, b\n", "{results}");
    }
    let built = done(root, &["--json", "library", "build", "--force", "l.parquet", "out"]).out;
    let built: Value = serde_json::from_str(&built).unwrap();
    assert_eq!((&built["fabrics"], &built["left_out"]), (&json!(1), &json!(["a", "b"])));
    // What a run leaves behind that was killed.
    fs::write(root.join("out/.kesf-journal"), "[\"fabrics.csv\",\"00\"]\n").unwrap();
    for arguments in [&["library", "build", "new.parquet", "out"][..], &["report", "out", "-o", "page.html"]]
    {
        let refused = kesf(root, arguments);
        assert!(refused.code == 2 && refused.err.contains("out: O007"), "{}", refused.err);
    }
    assert!(!root.join("new.parquet").exists() && !root.join("page.html").exists());
}
