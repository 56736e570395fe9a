//! Layouts of reports whose numbers stand elsewhere than in a column of their own: titles over directions, two directions in a cell,
//! deviations below their values, tables beside each other, keys and titles below, and columns that name records.
//!
//! Kind: analytical. The numbers are those in the texts.

use std::fmt::Write as _;
use std::path::Path;

use kesf::instrument::{Direction, FileContent, Parameter, ReadError, ReadSettings, parse};

fn attempt(text: &str) -> Result<FileContent, ReadError> {
    parse(Path::new("t.csv"), text.as_bytes(), &ReadSettings::default())
}

fn read(text: &str) -> FileContent {
    attempt(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Fabric, parameter, direction, value in the KES unit and standard deviation in it.
type Value = (String, Parameter, Option<Direction>, f64, Option<f64>);

fn values(text: &str) -> Vec<Value> {
    let rounded = |x: f64| (x * 1e9).round() / 1e9;
    let mut all: Vec<Value> = read(text)
        .results
        .iter()
        .map(|(name, v)| {
            let factor = v.parameter.kes_factor();
            let name = name.clone().unwrap_or_default();
            (name, v.parameter, v.direction, rounded(v.mean / factor), v.sd.map(|sd| rounded(sd / factor)))
        })
        .collect();
    all.sort_by(|a, b| (&a.0, a.1, a.2).cmp(&(&b.0, b.1, b.2)));
    all
}

fn told(content: &FileContent, code: &str) -> usize {
    content.findings.iter().filter(|f| f.code() == code).count()
}

const WARP: Option<Direction> = Some(Direction::Warp);
const WEFT: Option<Direction> = Some(Direction::Weft);

fn b(name: &str, direction: Option<Direction>, value: f64) -> Value {
    (name.to_string(), Parameter::B, direction, value, None)
}

#[test]
fn a_parameter_in_the_title_is_that_of_the_directions_below() {
    let wide = "Bending rigidity (gf·cm²/cm)\nFabric,Warp,Weft\nCotton,0.08,0.06\nWool,0.09,0.07\n";
    let expected =
        [b("Cotton", WARP, 0.08), b("Cotton", WEFT, 0.06), b("Wool", WARP, 0.09), b("Wool", WEFT, 0.07)];
    assert_eq!(values(wide), expected);
    let other = "Fabric,Composition,Warp,Weft\nCotton,100 % CO,0.08,0.06\nWool,100 % WO,0.09,0.07\n";
    assert_eq!(values(&format!("Bending rigidity (gf·cm²/cm)\n{other}")), expected);
    let repeats =
        "Bending rigidity B (gf·cm²/cm),,,,\nFabric,Warp,,Weft,\n,1,2,1,2\nCotton,0.08,0.082,0.06,0.064\n";
    let found = read(repeats);
    let n: Vec<usize> = found.results.iter().map(|(_, v)| v.n).collect();
    let means: Vec<_> = values(repeats).into_iter().map(|v| (v.2, v.3)).collect();
    assert_eq!((n, means), (vec![2, 2], vec![(WARP, 0.081), (WEFT, 0.062)]));
}

#[test]
fn two_directions_in_one_cell() {
    let across = "Fabric,B warp/weft (gf·cm²/cm),LT\nCotton,0.0812/0.0533,0.6\nWool,0.09 / 0.07,-\n";
    let found = values(across);
    assert_eq!(found.iter().filter(|v| v.1 == Parameter::B).count(), 4, "{found:?}");
    assert!(
        found.contains(&b("Cotton", WARP, 0.0812)) && found.contains(&b("Wool", WEFT, 0.07)),
        "{found:?}"
    );
    let down = "Parameter,Unit,Weft/Warp\nB,gf·cm²/cm,0.0533/0.0812\n";
    assert_eq!(values(down), [b("", WARP, 0.0812), b("", WEFT, 0.0533)]);
    // A row of units below the heads is that of both.
    let units = "Fabric,B warp/weft\n,gf·cm²/cm\nCotton,0.0812/0.0533\n";
    assert_eq!(values(units), [b("Cotton", WARP, 0.0812), b("Cotton", WEFT, 0.0533)]);
    // The same words over a column of directions.
    let column = "Fabric,Warp/Weft,B (gf·cm²/cm)\nCotton,Warp,0.0812\nCotton,Weft,0.0533\n";
    assert_eq!(values(column), [b("Cotton", WARP, 0.0812), b("Cotton", WEFT, 0.0533)]);
}

#[test]
fn deviations_below_their_values_and_ranges_behind_them() {
    let below =
        "Parameter,Unit,Warp,Weft\nB,gf·cm²/cm,0.08,0.06\n,,(0.004),(0.003)\nLT,-,0.6,0.7\n,,±0.01,±0.02\n";
    let found: Vec<_> = values(below).into_iter().map(|v| (v.1, v.2, v.3, v.4)).collect();
    assert_eq!(
        found,
        [
            (Parameter::Lt, WARP, 0.6, Some(0.01)),
            (Parameter::Lt, WEFT, 0.7, Some(0.02)),
            (Parameter::B, WARP, 0.08, Some(0.004)),
            (Parameter::B, WEFT, 0.06, Some(0.003)),
        ]
    );
    for cell in ["0.08 [0.07–0.09]", "\"0.08 (0.07, 0.09)\"", "0.08 (0.07-0.09)"] {
        let text = format!("Parameter,Unit,Warp\nB,gf·cm²/cm,{cell}\n");
        assert_eq!(values(&text), [b("", WARP, 0.08)], "{cell}");
        assert_eq!(told(&read(&text), "R130"), 1, "{cell}");
    }
    let counted = "Parameter,Unit,Warp\nB,gf·cm²/cm,0.08 ± 0.004 (5)\n";
    assert_eq!((values(counted)[0].4, told(&read(counted), "R130")), (Some(0.004), 1));
}

#[test]
fn tables_beside_each_other() {
    let down = "Bending,,,,Shear,,,\nParameter,Unit,Warp,,Parameter,Unit,Warp,\nB,gf·cm²/cm,0.08,,G,gf/(cm·deg),0.8,\n,,,,2HG,gf/cm,1.1,\n";
    let found: Vec<_> = values(down).into_iter().map(|v| (v.1, v.2, v.3)).collect();
    assert_eq!(found, [(Parameter::G, WARP, 0.8), (Parameter::Hg, WARP, 1.1), (Parameter::B, WARP, 0.08)]);
    // Each half has fabrics of its own.
    let halves = "Fabric,B warp (gf·cm²/cm),,Fabric,B warp (gf·cm²/cm)\nCotton,0.08,,Silk,0.02\nWool,0.09,,Linen,0.2\n";
    assert_eq!(
        values(halves),
        [b("Cotton", WARP, 0.08), b("Linen", WARP, 0.2), b("Silk", WARP, 0.02), b("Wool", WARP, 0.09)]
    );
}

#[test]
fn keys_and_titles_below_a_table() {
    for key in ["1 = weft, 2 = warp", "\"1 = weft, 2 = warp\"", "\nNote: 1 - weft; 2 - warp"] {
        let found = read(&format!(
            "Fabric,B-1 (gf·cm²/cm),B-2 (gf·cm²/cm)\nCotton,0.05,0.08\nWool,0.06,0.09\n{key}\n"
        ));
        let of_warp: Vec<bool> = found.results.iter().map(|(_, v)| v.direction == WARP).collect();
        assert_eq!((of_warp, told(&found, "R111")), (vec![false, true, false, true], 0), "{key}");
    }
    let table = "Fabric,B warp (gf·cm²/cm)\nCotton,0.08\nWool,0.09\n\n";
    let title = attempt(&format!("{table}Table 3. Standard deviations of the KES parameters\n"));
    assert_eq!(title.unwrap_err().code(), "R026");
    // A remark is no title, and a title above goes before one below.
    assert!(attempt(&format!("{table}Standard deviations are given in Table 4\n")).is_ok());
    assert!(attempt(&format!("Table 2. Mean values\n{table}Table 3. Standard deviations\n")).is_ok());
}

#[test]
fn a_first_group_that_headers_have_as_a_key() {
    for group in ["Surface", "Face", "Bending"] {
        let text = format!("Parameter,Unit,Warp\n{group},,\nMIU,-,0.15\nB,gf·cm²/cm,0.08\n");
        assert_eq!(values(&text).len(), 2, "{group}");
    }
}

/// A loop of bending, line by line.
fn points(rigidity: f64) -> Vec<String> {
    let course = (0..=20).chain((-20..20).rev()).chain(-19..=0).map(|i| 0.125 * f64::from(i));
    course.enumerate().map(|(i, k)| format!("{k:.4},{:.5}", rigidity * k + 0.001 * (i % 3) as f64)).collect()
}

/// Records below one another, with what each row says before its point.
fn records(heads: &str, of: &[&str], only_first: bool) -> FileContent {
    let mut text = format!("{heads},curvature (1/cm),moment (gf·cm/cm)\n");
    let blanks = ",".repeat(heads.matches(',').count());
    for (k, keys) in of.iter().enumerate() {
        for (i, point) in points(0.05 + 0.01 * k as f64).iter().enumerate() {
            let keys = if i > 0 && only_first { &blanks } else { *keys };
            writeln!(text, "{keys},{point}").unwrap();
        }
    }
    read(&text)
}

#[test]
fn columns_that_name_records() {
    let of = |content: &FileContent| -> Vec<_> {
        let records = content.measurements.iter();
        records.map(|m| (m.sample.clone().unwrap_or_default(), m.direction, m.specimen)).collect()
    };
    let record = |name: &str, direction: Option<Direction>, specimen| (name.to_string(), direction, specimen);
    let expected = [record("Cotton", WARP, 1), record("Cotton", WARP, 2), record("Cotton", WEFT, 1)];
    let rows = ["Cotton,warp,1", "Cotton,warp,2", "Cotton,weft,1"];
    assert_eq!(of(&records("fabric,direction,specimen", &rows, true)), expected);
    assert_eq!(of(&records("id", &["Cotton_warp_1", "Cotton_warp_2", "Cotton_weft_1"], false)), expected);
    for ([warp, weft], code) in
        [(["L", "T"], "R133"), (["W", "F"], "R133"), (["1", "2"], "R111"), (["0", "90"], "R150")]
    {
        let found =
            records("fabric,direction", &[&format!("Cotton,{warp}"), &format!("Cotton,{weft}")], false);
        assert_eq!(of(&found), [record("Cotton", WARP, 1), record("Cotton", WEFT, 1)], "{warp} {weft}");
        assert_eq!(told(&found, code), 1, "{warp} {weft}: {:?}", found.findings);
    }
    let states = records("fabric,treatment,direction", &["Cotton,raw,warp", "Cotton,washed,warp"], false);
    assert_eq!(of(&states), [record("Cotton raw", WARP, 1), record("Cotton washed", WARP, 1)]);
    let lots = records("fabric,lot,direction", &["Cotton,1,warp", "Cotton,2,warp"], false);
    assert_eq!(of(&lots), [record("Cotton lot 1", WARP, 1), record("Cotton lot 2", WARP, 1)]);
    // What changes on the way is none, and who measured is none.
    let mut phases = String::from("direction,phase,curvature (1/cm),moment (gf·cm/cm)\n");
    for (i, point) in points(0.08).iter().enumerate() {
        writeln!(phases, "warp,{},{point}", if i < 20 { "outward" } else { "inward" }).unwrap();
    }
    assert_eq!(read(&phases).measurements.len(), 1);
    let operators =
        records("fabric,operator,direction,specimen", &["Cotton,Ana,warp,1", "Cotton,Rui,warp,2"], false);
    assert_eq!(of(&operators), [record("Cotton", WARP, 1), record("Cotton", WARP, 2)]);
}
