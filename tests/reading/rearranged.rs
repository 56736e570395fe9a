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
    for title in [
        "\"Table 3: Bending rigidity, B [gf.cm2/cm]\"",
        "Table 3: Bending rigidity, B [gf.cm2/cm]",
        "Table 4.2. Bending rigidity of fabrics (gf·cm²/cm)",
        "\"Bending rigidity (B) (gf·cm²/cm), n = 5\"",
        "Bending rigidity in gf·cm²/cm (mean of 5 specimens)",
        "Biegesteifigkeit B (gf·cm²/cm)\n",
    ] {
        let text = format!("{title}\nFabric,Warp,Weft\nCotton,0.08,0.06\nWool,0.09,0.07\n");
        assert_eq!((values(&text), told(&read(&text), "R143")), (expected.to_vec(), 0), "{title}");
    }
    // The same heads once more.
    let again = "B (gf·cm²/cm)\nFabric,Warp,Weft\nCotton,0.08,0.06\nFabric,Warp,Weft\nWool,0.09,0.07\n";
    assert_eq!(values(again), expected);
    // Heads over something else below a title.
    let yarns = "G (gf/(cm·deg))\nYarn,Warp,Weft\nTwist (1/mm),0.8,0.9\n";
    assert!(attempt(yarns).is_err());
    // Titles of several parameters, or of none.
    for title in ["Bending and shear: B and G", "Results of cotton"] {
        let text = format!("{title}\nFabric,Warp,Weft\nCotton,0.08,0.06\n");
        assert_eq!(attempt(&text).unwrap_err().code(), "R006", "{title}");
    }
    // What stands below without a blank line is another table, and told where it is not understood.
    let glued = "G (gf/(cm·deg))\nFabric,Warp,Weft\nCotton,1.4,1.7\nYarn density,Warp,Weft\nCotton,2.4,2.2\n";
    assert_eq!((read(glued).results.len(), told(&read(glued), "R123")), (2, 1));
    let rows = "B (gf·cm²/cm)\nFabric,Warp,Weft\nCotton,0.08,0.06\n2HB (gf·cm/cm)\nCotton,0.04,0.03\n";
    assert_eq!((read(rows).results.len(), told(&read(rows), "R128")), (2, 1));
    let deviations = "Fabric,2HG warp (gf/cm)\nCotton,1.9\nTable 2. Standard deviations\nFabric,2HG warp (gf/cm)\nCotton,0.19\n";
    assert_eq!((read(deviations).results.len(), told(&read(deviations), "R123")), (1, 1));
    // Names over directions that come again.
    let names = ",,Cotton,,Wool,\nParameter,Unit,Warp,Weft,Warp,Weft\nB,gf·cm²/cm,0.08,0.06,0.09,0.07\n";
    assert_eq!(values(names), expected);
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
    let letters = read("Fabric,B L/T (gf·cm²/cm)\nCotton,0.081 ± 0.004/0.062 ± 0.003\n");
    assert_eq!((letters.results.len(), told(&letters, "R133")), (2, 1));
    let german = "Gewebe;B Kette/Schuss (gf·cm²/cm)\nCotton;0,081/0,062\n";
    assert_eq!(values(german), [b("Cotton", WARP, 0.081), b("Cotton", WEFT, 0.062)]);
    // A row of units below the heads is that of both.
    let units = "Fabric,B warp/weft\n,gf·cm²/cm\nCotton,0.0812/0.0533\n";
    assert_eq!(values(units), [b("Cotton", WARP, 0.0812), b("Cotton", WEFT, 0.0533)]);
    // A value of the fabric as a whole, and one direction that was not measured.
    let mixed = "Parameter,Unit,Warp/Weft\nB,gf·cm²/cm,0.08/0.06\nW,mg/cm²,12\nG,gf/(cm·deg),0.8/-\n";
    let found: Vec<_> = values(mixed).into_iter().map(|v| (v.1, v.2, v.3)).collect();
    let (w, g) = ((Parameter::W, None, 12.0), (Parameter::G, WARP, 0.8));
    assert_eq!(found, [g, (Parameter::B, WARP, 0.08), (Parameter::B, WEFT, 0.06), w]);
    // Heads that come again in one paragraph.
    let again =
        "Fabric,B warp/weft (gf·cm²/cm)\nCotton,0.08/0.06\nFabric,B warp/weft (gf·cm²/cm)\nWool,0.09/0.07\n";
    assert_eq!(
        values(again),
        [b("Cotton", WARP, 0.08), b("Cotton", WEFT, 0.06), b("Wool", WARP, 0.09), b("Wool", WEFT, 0.07)]
    );
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
    let marked = values("Parameter,Unit,Warp,Weft\nB,gf·cm²/cm,0.0812a,0.0633\n,,[0.004],-\n");
    assert_eq!(
        marked.iter().map(|v| (v.3, v.4)).collect::<Vec<_>>(),
        [(0.0812, Some(0.004)), (0.0633, None)]
    );
    // What a line says of the brackets goes before their size.
    let other = "Weft values in brackets\nFabric,B (gf·cm²/cm)\nCotton,0.081 (0.030)\n";
    assert_eq!((values(other)[0].4, told(&read(other), "R139")), (None, 1));
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
    for key in
        ["1 = weft, 2 = warp", "\"1 = weft, 2 = warp\"", "1 = weft\n2 = warp", "\nNote: 1 - weft; 2 - warp"]
    {
        let found = read(&format!(
            "Fabric,B-1 (gf·cm²/cm),B-2 (gf·cm²/cm)\nCotton,0.05,0.08\nWool,0.06,0.09\n{key}\n"
        ));
        let of_warp: Vec<bool> = found.results.iter().map(|(_, v)| v.direction == WARP).collect();
        assert_eq!((of_warp, told(&found, "R111")), (vec![false, true, false, true], 0), "{key}");
    }
    // Below each of two tables, and above the second of two.
    let two = |first: &str, second: &str, third: &str| {
        let text = format!(
            "Fabric,B-1 (gf·cm²/cm),B-2 (gf·cm²/cm)\nCotton,0.05,0.08\n{first}\n{second}\nFabric,G-1 (gf/(cm·deg)),G-2 (gf/(cm·deg))\nCotton,0.5,0.8\n{third}"
        );
        values(&text).into_iter().map(|v| (v.1, v.2, v.3)).collect::<Vec<_>>()
    };
    let (g, b) = ((Parameter::G, WARP, 0.5), (Parameter::B, WARP, 0.08));
    let below = two("1 = weft, 2 = warp\n", "", "1 = warp, 2 = weft\n");
    assert!(below.contains(&g) && below.contains(&b), "{below:?}");
    let above = two("\nTable 2", "1 = weft, 2 = warp", "");
    assert!(
        above.contains(&(Parameter::G, WARP, 0.8)) && above.contains(&(Parameter::B, WARP, 0.05)),
        "{above:?}"
    );
    // A key of fabrics is none of directions.
    let fabrics = "Fabric,B-1 (gf·cm²/cm),B-2 (gf·cm²/cm)\nCotton,0.08,0.06\n\n\"Fabrics: 1 = weft rib, 2 = warp rib\"\n";
    assert_eq!((values(fabrics)[0].2, told(&read(fabrics), "R111")), (WARP, 1));
    // Numbers of titles are no keys.
    let titles = "Parameter,Unit,Value\n1. Warp,,\nB,gf·cm²/cm,0.08\n2. Weft,,\nB,gf·cm²/cm,0.06\n";
    assert_eq!(values(titles).len(), 2);
    let table = "Fabric,B warp (gf·cm²/cm)\nCotton,0.08\nWool,0.09\n\n";
    let title = attempt(&format!("{table}Table 3. Standard deviations of the KES parameters\n"));
    assert_eq!(title.unwrap_err().code(), "R026");
    let counted = attempt(&format!("{table}Table 3. Standard deviations (n = 5)\n"));
    assert_eq!(counted.unwrap_err().code(), "R026");
    for title in ["Standart sapma", "Desviación estándar", "标准偏差", "Écart-type", "CV values"] {
        let text = format!("{title}\nParameter,Unit,Warp,Weft\nLT,-,0.6,0.7\n");
        assert_eq!(attempt(&text).unwrap_err().code(), "R026", "{title}");
    }
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
    assert_eq!(told(&states, "R151"), 1);
    let washes = records("fabric,washes,direction", &["Cotton,0,warp", "Cotton,5,warp"], false);
    assert_eq!(of(&washes), [record("Cotton washes 0", WARP, 1), record("Cotton washes 5", WARP, 1)]);
    // Numbers may count cycles; they are told as not used.
    let loops = records("fabric,loop,direction", &["Cotton,1,warp", "Cotton,2,warp"], false);
    assert_eq!((loops.measurements.len(), told(&loops, "R104")), (1, 1));
    // What changes on the way is none, and who measured is none.
    let mut phases = String::from("direction,phase,curvature (1/cm),moment (gf·cm/cm)\n");
    for (i, point) in points(0.08).iter().enumerate() {
        writeln!(phases, "warp,{},{point}", if i < 20 { "outward" } else { "inward" }).unwrap();
    }
    assert_eq!(read(&phases).measurements.len(), 1);
    // The halves of a loop begin where it does, and go half as far.
    let mut halves = String::from("direction,half,curvature (1/cm),moment (gf·cm/cm)\n");
    for (i, point) in points(0.08).iter().enumerate() {
        writeln!(halves, "warp,{},{point}", if i <= 40 { "positive" } else { "negative" }).unwrap();
    }
    assert_eq!(read(&halves).measurements.len(), 1);
    // Names with a word of a direction in them stay names beside a column of directions, and so do words behind it.
    let knits = records("fabric,direction", &["Warp knit A,warp", "Warp knit B,warp"], false);
    assert_eq!(of(&knits), [record("Warp knit A", WARP, 1), record("Warp knit B", WARP, 1)]);
    let names = records("fabric,id", &["Cotton,A_warp_1", "Cotton,A_weft_1"], false);
    assert_eq!(of(&names), [record("Cotton", WARP, 1), record("Cotton", WEFT, 1)]);
    let turned = records("treatment,fabric,direction", &["raw,Cotton,warp", "washed,Cotton,warp"], false);
    assert_eq!(of(&turned), of(&states));
    // A name again at the top of a page changes nothing.
    let mut pages = String::from("fabric,direction,strain (%),force (gf/cm)\n");
    for (fabric, stiffness) in [("Cotton", 50.0), ("Wool", 30.0)] {
        for i in 0..40 {
            let keys = if i == 0 || i == 18 { format!("{fabric},warp") } else { ",".into() };
            let x = if i < 20 { 0.2 * f64::from(i) } else { 0.2 * f64::from(39 - i) };
            writeln!(pages, "{keys},{x:.2},{:.2}", stiffness * x).unwrap();
        }
    }
    let names: Vec<_> = of(&read(&pages)).into_iter().map(|(name, ..)| name).collect();
    assert_eq!(names, ["Cotton", "Wool"]);
    let operators =
        records("fabric,operator,direction,specimen", &["Cotton,Ana,warp,1", "Cotton,Rui,warp,2"], false);
    assert_eq!(of(&operators), [record("Cotton", WARP, 1), record("Cotton", WARP, 2)]);
}
