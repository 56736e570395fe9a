//! Layouts as laboratories have them, one small file each, against numbers worked out by hand.
//!
//! Kind: analytical. 1 gf = 9.80665e-3 N exactly, so gf/cm = 0.980665 N/m and gf·cm/cm = 9.80665e-3 N.

use std::path::Path;

use approx::assert_relative_eq;
use kesf::instrument::{Dialect, Direction, FileContent, Parameter, ReadError, ReadSettings, Test, parse};

fn read_as(name: &str, text: &str, settings: &ReadSettings) -> Result<FileContent, ReadError> {
    parse(Path::new(name), text.as_bytes(), settings)
}

fn read(name: &str, text: &str) -> FileContent {
    read_as(name, text, &ReadSettings::default()).unwrap()
}

fn code(text: &str) -> &'static str {
    read_as("lab.csv", text, &ReadSettings::default()).unwrap_err().code()
}

fn with_dialect(toml: &str) -> ReadSettings {
    ReadSettings { dialects: vec![Dialect::from_toml(toml).unwrap()], ..ReadSettings::default() }
}

/// Raw load over 20 cm and extension over 5 cm: 500 gf is 25 gf/cm, 1 mm is 2 %.
#[test]
fn raw_load_and_extension_are_divided_by_width_and_gauge() {
    let text = "test,tensile\ndirection,warp\nwidth,20 cm\ngauge,5 cm\n\nextension (mm),load (gf)\n0,0\n0.5,100\n1,500\n";
    let m = &read("a.csv", text).measurements[0];
    assert_relative_eq!(m.curve.x[2], 0.02, max_relative = 1e-14);
    assert_relative_eq!(m.curve.y[2], 25.0 * 0.980665, max_relative = 1e-14);
}

/// 5 mm of travel over a gauge of 5 cm is atan(0.1).
#[test]
fn a_shear_displacement_becomes_an_angle() {
    let text = "test: shear\ndirection: weft\npretension: 12 gf/cm\n\ndisplacement [mm];force [gf/cm]\n0;0\n2.5;1\n5;2\n";
    let m = &read("a.csv", text).measurements[0];
    assert_eq!((m.test, m.direction), (Test::Shear, Some(Direction::Weft)));
    assert_relative_eq!(m.curve.x[2], 0.1f64.atan(), max_relative = 1e-14);
    assert_relative_eq!(m.conditions.pretension, 12.0 * 0.980665, max_relative = 1e-14);
}

/// 10 V are the full scale: 5 V of 2.5 1/cm are 1.25 1/cm, 1200 mV of 20 gf·cm/cm are 2.4 gf·cm/cm.
#[test]
fn volts_are_scaled_by_the_range() {
    let text = "test,bending\ndirection,warp\nsens,20 gf·cm/cm\nsens x,2.5 1/cm\n\nK (V),M (mV)\n0,0\n5,1200\n10,2500\n";
    let m = &read("a.csv", text).measurements[0];
    assert_relative_eq!(m.curve.x[1], 125.0, max_relative = 1e-14);
    assert_relative_eq!(m.curve.y[1], 2.4 * 9.80665e-3, max_relative = 1e-14);
}

#[test]
fn metadata_come_from_the_file_name_where_the_header_has_none() {
    let text = "strain (%),load (gf/cm)\n0,0\n1,10\n2,50\n";
    for (name, sample, direction, specimen) in [
        ("F01_warp_FB1_2.csv", Some("F01"), Direction::Warp, 2),
        ("経-1.csv", None, Direction::Warp, 1),
        ("ヨコ3.txt", None, Direction::Weft, 3),
        ("lab7 trama 02.csv", Some("lab7"), Direction::Weft, 2),
    ] {
        let m = &read(name, text).measurements[0];
        assert_eq!(
            (m.sample.as_deref(), m.direction, m.specimen),
            (sample, Some(direction), specimen),
            "{name}"
        );
    }
}

#[test]
fn units_may_stand_in_a_row_of_their_own_and_labels_over_column_blocks() {
    let text = "test\tbending\n経-1\t\t緯-1\t\ncurvature\tmoment\tcurvature\tmoment\n(1/cm)\t(gf·cm/cm)\t(1/cm)\t(gf·cm/cm)\n\
                0\t0\t0\t0\n1\t0.1\t1\t0.05\n2\t0.2\t2\t0.1\n";
    let content = read("a.txt", text);
    let directions: Vec<_> = content.measurements.iter().map(|m| m.direction).collect();
    assert_eq!(directions, [Some(Direction::Warp), Some(Direction::Weft)]);
    assert_relative_eq!(content.measurements[1].curve.y[2], 0.1 * 9.80665e-3, max_relative = 1e-14);
}

#[test]
fn one_abscissa_may_serve_several_ordinates() {
    let text = "test,bending\ndirection,warp\nspecimen,1,2\n\nK (1/cm),M (gf·cm/cm),M (gf·cm/cm)\n0,0,0\n1,0.1,0.2\n2,0.2,0.4\n";
    let content = read("a.csv", text);
    assert_eq!(content.measurements.len(), 2);
    assert_eq!(content.measurements[0].curve.x, content.measurements[1].curve.x);
    assert_relative_eq!(content.measurements[1].curve.y[2], 0.4 * 9.80665e-3, max_relative = 1e-14);
}

#[test]
fn stacked_tests_and_blank_lines_and_trailing_delimiters() {
    let text = "sample,lab,\ntest,tensile,\ndirection,warp,\n\nstrain (%),force (N/m),\n0,0,\n1,5,\n\n2,20,\n\n\
                test,compression,\n\nthickness (mm),pressure (Pa),\n0.5,1,\n0.4,100,\n0.3,1000,\n";
    let content = read("a.csv", text);
    let tests: Vec<_> = content.measurements.iter().map(|m| (m.test, m.direction, m.curve.len())).collect();
    assert_eq!(tests, [(Test::Tensile, Some(Direction::Warp), 3), (Test::Compression, None, 3)]);
    assert_eq!(content.measurements[0].lines, [6, 7, 9]);
}

/// A laboratory without headings writes a dialect and needs no code.
#[test]
fn a_dialect_names_columns_words_units_and_conditions() {
    let settings = with_dialect(
        "name = \"lab\"\ntest = \"bending\"\ncolumn_order = [\"ignored\", \"curvature\", \"moment\"]\n\
         [units]\ncurvature = \"1/cm\"\nmoment = \"gf·cm\"\n[conditions.bending]\nwidth = \"10 cm\"\n",
    );
    let m = &read_as("lab_warp_1.dat", "1,0,0\n2,1,1.0\n3,2,2.0\n", &settings).unwrap().measurements[0];
    // 2 gf·cm over 10 cm of width.
    assert_relative_eq!(m.curve.y[2], 0.2 * 9.80665e-3, max_relative = 1e-14);
    assert_relative_eq!(m.curve.x[2], 200.0);

    let settings = with_dialect(
        "name = \"lab\"\n[columns]\ncurvature = [\"foo\"]\nmoment = [\"bar\"]\n[directions]\nwarp = [\"up\"]\n",
    );
    let text = "direction,up\nfoo (1/cm),bar (gf·cm/cm)\n0,0\n1,1\n2,2\n";
    assert_eq!(read_as("a.csv", text, &settings).unwrap().measurements[0].direction, Some(Direction::Warp));
    assert_eq!(code(text), "R006");
}

#[test]
fn a_dialect_with_texts_to_match_applies_to_files_that_have_them() {
    let toml = "name = \"lab\"\nmatch = [\"Lab 7\"]\nkes_units = true\n";
    let text = "note,Lab 7\ndirection,warp\nK,M\n0,0\n1,0.1\n2,0.2\n";
    let m = &read_as("a.csv", text, &with_dialect(toml)).unwrap().measurements[0];
    assert_relative_eq!(m.curve.x[2], 200.0);
    let other = text.replace("Lab 7", "Lab 8");
    assert_eq!(read_as("a.csv", &other, &with_dialect(toml)).unwrap_err().code(), "R008");
}

#[test]
fn units_are_never_guessed() {
    let text = "direction,warp\nK,M\n0,0\n1,0.1\n2,0.2\n";
    assert_eq!(code(text), "R008");
    let kes = ReadSettings { kes_units: true, ..ReadSettings::default() };
    assert_relative_eq!(read_as("a.csv", text, &kes).unwrap().measurements[0].curve.x[2], 200.0);
    assert_eq!(code("direction,warp\nwidth,20\nK (1/cm),M (gf·cm/cm)\n0,0\n1,1\n2,2\n"), "R008");
    assert_eq!(code("fabric,B,2HB (gf·cm/cm)\nx,0.1,0.05\n"), "R008");
    // A shear angle in percent, and G without its degree.
    assert_eq!(code("direction,warp\nangle (%),shear force (gf/cm)\n0,0\n1,1\n2,2\n"), "R010");
    assert_eq!(code("fabric,G (gf/cm),B (gf·cm²/cm)\nx,0.5,0.05\n"), "R010");
}

#[test]
fn commas_for_everything_are_refused() {
    assert_eq!(
        code("test,bending\ndirection,warp\nK (1/cm),M (gf·cm/cm)\n0,5,1,25\n1,0,2,25\n1,5,3,25\n"),
        "R005"
    );
}

#[test]
fn result_tables_wide_and_long() {
    let value = |content: &FileContent, fabric: Option<&str>, parameter, direction| {
        let same = |(f, r): &&(Option<String>, _)| {
            f.as_deref() == fabric && {
                let r: &kesf::instrument::ResultValue = r;
                r.parameter == parameter && r.direction == direction
            }
        };
        content.results.iter().find(same).map(|(_, r)| r.clone()).unwrap()
    };
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    let wide = read(
        "t.csv",
        "fabric;direction;B (gf·cm²/cm);B sd (gf·cm²/cm);G [gf/cm·deg];T0 (mm);n\nx;warp;0,1;0,01;0,5;0,4;3\nx;weft;0,2;0,02;0,6;0,4;3\n",
    );
    let b = value(&wide, Some("x"), Parameter::B, warp);
    assert_relative_eq!(b.mean, 9.80665e-6, max_relative = 1e-14);
    assert_relative_eq!(b.sd.unwrap(), 9.80665e-7, max_relative = 1e-14);
    assert_eq!(b.n, 3);
    // theory: 1 gf/(cm·deg) = 56.18796562 N/m per rad.
    assert_relative_eq!(
        value(&wide, Some("x"), Parameter::G, weft).mean,
        0.6 * 56.187_965_62,
        max_relative = 1e-9
    );
    assert_relative_eq!(value(&wide, Some("x"), Parameter::T0, None).mean, 4e-4, max_relative = 1e-14);

    let long = read("t.csv", "parameter,unit,warp,weft\nB,gf·cm²/cm,0.1,0.05\nEMT,%,4,8\nLT,-,0.8,0.7\n");
    assert_relative_eq!(value(&long, None, Parameter::Emt, weft).mean, 0.08, max_relative = 1e-14);
    assert_relative_eq!(value(&long, None, Parameter::Lt, warp).mean, 0.8);

    // Repeats are averaged: mean 0.2, SD 0.1, n = 3.
    let repeats =
        read("t.csv", "fabric,specimen,2HB (gf·cm/cm),2HG (gf/cm)\nx,1,0.1,1\nx,2,0.2,1\nx,3,0.3,1\n");
    let hb = value(&repeats, Some("x"), Parameter::Hb, None);
    assert_eq!(hb.n, 3);
    assert_relative_eq!(hb.mean, 0.2 * 9.80665e-3, max_relative = 1e-12);
    assert_relative_eq!(hb.sd.unwrap(), 0.1 * 9.80665e-3, max_relative = 1e-12);
}

/// B = W c³ 9.81e-6 µN·m and G = 123/EB5 N/m (FAST manual).
#[test]
fn fast_values_give_bending_and_shear_rigidity() {
    let content =
        read("fast.csv", "fabric,W (g/m²),C-1 (mm),C-2 (mm),EB5 (%),E100-1 (%)\nserge,200,18,16,3,4.1\n");
    let of = |p, d| {
        content.results.iter().find(|(_, r)| r.parameter == p && r.direction == d).map(|(_, r)| r).unwrap()
    };
    assert_relative_eq!(
        of(Parameter::B, Some(Direction::Warp)).mean,
        200.0 * 5832.0 * 9.81e-12,
        max_relative = 1e-12
    );
    assert_relative_eq!(
        of(Parameter::B, Some(Direction::Weft)).mean,
        200.0 * 4096.0 * 9.81e-12,
        max_relative = 1e-12
    );
    assert_relative_eq!(of(Parameter::G, None).mean, 41.0, max_relative = 1e-12);
    assert!(of(Parameter::G, None).inferred);
    assert!(content.findings.iter().any(|f| f.code == "R104" && f.message.contains("E100-1")));
}

/// Numbers that no unit and no width may make infinite.
#[test]
fn numbers_stay_finite_in_si() {
    let text = |width, y| format!("direction,warp\nwidth,{width}\nstrain (%),force (gf)\n0,0\n1,{y}\n2,2\n");
    assert_eq!(code(&text("20 cm", "1e200")), "R017");
    assert_eq!(code(&text("1e-306 m", "1e6")), "R017");
    assert_eq!(code(&text("1e-320 m", "1")), "R013");
}

/// The same values with one row each: the symbol carries the direction, or columns do.
#[test]
fn fast_values_may_stand_in_rows() {
    let rows = "parameter,unit,value\nW,g/m²,200\nC-1,mm,18\nC-2,mm,16\nEB5,%,3\nE100-1,%,4.1\n";
    let columns = "property;unit;warp;weft\nbending length;mm;18;16\nEB5;%;3;-\nW;g/m²;200;\n";
    for text in [rows, columns] {
        let content = read("fast.csv", text);
        let of = |p, d| {
            let same = |r: &&kesf::instrument::ResultValue| r.parameter == p && r.direction == d;
            content.results.iter().map(|(_, r)| r).find(same).unwrap().mean
        };
        let expected = |c: f64| 200.0 * c.powi(3) * 9.81e-12;
        assert_relative_eq!(of(Parameter::B, Some(Direction::Warp)), expected(18.0), max_relative = 1e-12);
        assert_relative_eq!(of(Parameter::B, Some(Direction::Weft)), expected(16.0), max_relative = 1e-12);
        assert_relative_eq!(of(Parameter::G, None), 41.0, max_relative = 1e-12);
    }
    // Without a unit nothing is guessed.
    assert_eq!(code("parameter,unit,value\nW,g/m²,200\nC-1,,18\n"), "R008");
}

/// What was inferred can be read: the words of `kesf check -v`.
#[test]
fn inference_is_told() {
    let text = "direction;warp\nK (1/cm);M (gf·cm/cm);what\n0,0;0,0;a\n1,5;0,1;b\n2,5;0,2;c\n";
    let told = read("a.csv", text).inference.join("\n");
    for expected in [
        "encoding UTF-8: the bytes are valid UTF-8",
        "delimiter ';', decimal mark ',': 6 numbers so",
        "words that dialects know, of 5 texts: kesf 3, kes-japanese 0, kes-european 0",
        "\"K\" and \"M\": bending test, which the columns belong to",
        "width 20 cm (standard, not in the file)",
        "\"M\" (gf·cm/cm) times 0.00980665 is N",
        "bending warp (stated in line 1), specimen not numbered of sample \"a\": 3 points in lines 3 to 5",
    ] {
        assert!(told.contains(expected), "{expected} is not in {told}");
    }
    let unknown = read_as("a.csv", "sample,x\nfoo (1/cm),moment (gf)\n0,0\n1,1\n", &ReadSettings::default())
        .unwrap_err();
    assert_eq!(unknown.code(), "R006");
    assert!(unknown.to_string().contains("\"kesf\" comes closest"), "{unknown}");
    assert!(unknown.to_string().contains("foo"), "{unknown}");
    assert!(!unknown.hint().is_empty());
    // The error carries what was decided before it, and what a dialect file could say.
    let told = unknown.about.inference.join("\n");
    for expected in [
        "encoding UTF-8",
        "headings foo (1/cm) | moment (gf)",
        "dialect kesf: knows moment (gf); does not know foo (1/cm)",
        "dialect kes-japanese: knows nothing",
        "[columns] curvature = [\"foo\"]",
    ] {
        assert!(told.contains(expected), "{expected} is not in {told}");
    }
}

/// Two sheets: side-by-side curves with typed numbers, and a result table.
#[test]
fn a_workbook_is_read_like_text() {
    let bytes = include_bytes!("workbooks/twill.xlsx");
    let content = parse(Path::new("twill.xlsx"), bytes, &ReadSettings::default()).unwrap();
    let found: Vec<_> =
        content.measurements.iter().map(|m| (m.test, m.direction, m.specimen, m.curve.len())).collect();
    let warp = Some(Direction::Warp);
    assert_eq!(found, [(Test::Bending, warp, 1, 4), (Test::Bending, warp, 2, 5)]);
    assert_relative_eq!(content.measurements[1].curve.y[3], 0.26 * 9.80665e-3, max_relative = 1e-14);
    assert_eq!(content.measurements[1].lines, [7, 8, 9, 10, 11]);
    assert_eq!(content.results.len(), 5);
    assert_eq!(content.results[0].1.place.to_string(), "twill.xlsx[results]:3:2");
}
