//! Layouts as laboratories have them, one small file each, against numbers worked out by hand.
//!
//! Kind: analytical. 1 gf = 9.80665e-3 N exactly, so gf/cm = 0.980665 N/m and gf·cm/cm = 9.80665e-3 N.

use std::path::Path;

use approx::assert_relative_eq;
use kesf::characterise::{FabricSheet, Settings, ValueStatus, characterise};
use kesf::instrument::{
    Dialect, Direction, FabricInput, FileContent, Parameter, ReadError, ReadSettings, Test, parse,
    read_fabrics,
};

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

/// 5 V of an output that ends at 5 V are the full scale, wherever the header says so; that 10 V are taken is told.
#[test]
fn a_stated_voltage_is_that_of_the_full_scale() {
    let record = "curvature (1/cm),moment (V)\n0,0\n1,2.5\n2,5\n";
    for (lines, expected, told) in [
        ("sens,20 gf·cm/cm", 10.0, 1),
        ("sens,20 gf·cm/cm\nFull scale voltage,5 V", 20.0, 0),
        ("sens,20 gf·cm/cm\nFull scale: 5 V", 20.0, 0),
        ("Range: 5 V\nSENS: 20 gf·cm/cm", 20.0, 0),
        ("sens,20 gf·cm/cm (5 V)", 20.0, 0),
        ("sens,4 gf·cm/cm/V", 20.0, 0),
        ("sens,5 V = 20 gf·cm/cm", 20.0, 0),
        ("sens,20 gf·cm/cm\nsens x,2.5 1/cm\nOutput,report.csv", 10.0, 1),
    ] {
        let found = read("a.csv", &format!("direction,warp\n{lines}\n\n{record}"));
        let last = found.measurements[0].curve.y[2];
        assert_relative_eq!(last, expected * 9.80665e-3, max_relative = 1e-12);
        let told_of: Vec<String> = messages(&found, "R109");
        assert!(told_of.len() == told && told_of.iter().all(|t| t.contains("10 V")), "{lines}: {told_of:?}");
        assert!(messages(&found, "R122").is_empty(), "{lines}");
    }
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

/// What is recorded beside a curve is no repeat of it: the shear force of 0.4 gf/cm is the only one.
#[test]
fn another_ordinate_under_the_abscissa_is_no_repeat() {
    for (abscissa, ordinates, other, rows) in [
        ("angle (deg)", "shear force (gf/cm),tension (gf/cm)", "tension", "0,0,10\n1,0.2,10.1\n2,0.4,10\n"),
        ("angle (deg)", "force (gf),normal load (gf/cm)", "normal load", "0,0,10\n1,4,10\n2,8,10\n"),
        ("angle (deg)", "shear force (gf),shear force (gf/cm)", "shear force", "0,0,0\n1,9,0.2\n2,18,0.4\n"),
        ("curvature (1/cm)", "moment (V),moment (gf·cm/cm)", "moment", "0,0,0\n1,3,0.2\n2,6,0.4\n"),
        ("thickness (mm)", "pressure (gf/cm²),force (gf)", "force", "2,0,0\n1,0.2,1\n0.5,0.4,2\n"),
        ("curvature (1/cm)", "force (gf),moment (gf·cm/cm)", "force", "0,0,0\n1,9,0.2\n2,18,0.4\n"),
        ("curvature (1/cm)", "torque (gf·cm),moment (gf·cm/cm)", "torque", "0,0,0\n1,9,0.2\n2,18,0.4\n"),
    ] {
        let heads = format!("{abscissa},{ordinates}");
        let found = read("a.csv", &format!("direction,warp\n{heads}\n{rows}"));
        assert_eq!(found.measurements.len(), 1, "{heads}");
        assert_eq!(
            messages(&found, "R104"),
            [format!("no KES parameters, and left out: {other}")],
            "{heads}"
        );
        let m = &found.measurements[0];
        let si = match m.test {
            Test::Bending => 9.80665e-3,
            Test::Compression => 98.0665,
            _ => 0.980665,
        };
        assert_relative_eq!(m.curve.y[2], 0.4 * si, max_relative = 1e-12);
    }
    // Two of one role and one kind of unit are repeats, whatever their units.
    let two =
        "direction,warp\nangle (deg),shear force (gf/cm),shear force (N/m)\n0,0,0\n1,0.2,0.3\n2,0.4,0.6\n";
    assert_eq!(read("a.csv", two).measurements.len(), 2);
}

/// The arm of a force in bending is unknown: N is the unit of a moment per width, and of no force there.
#[test]
fn a_bare_force_in_bending_is_refused() {
    for head in ["force (gf)", "load (mN)", "force (N)"] {
        let text = format!("test,bending\ndirection,warp\ncurvature (1/cm),{head}\n0,0\n1,0.2\n2,0.4\n");
        let error = read_as("lab.csv", &text, &ReadSettings::default()).unwrap_err();
        assert_eq!(error.code(), "R010", "{head}");
        assert!(error.to_string().contains("multiply the force by its arm"), "{error}");
    }
    for head in ["force (gf·cm/cm)", "moment (N)", "moment (gf)"] {
        let text = format!("test,bending\ndirection,warp\ncurvature (1/cm),{head}\n0,0\n1,0.2\n2,0.4\n");
        assert_eq!(read("a.csv", &text).measurements.len(), 1, "{head}");
    }
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

/// Units that a dialect states for a column are a statement; that numbers without one are those of the instruments is assumed.
#[test]
fn units_that_are_assumed_are_told() {
    let text = "direction,warp\nwidth,20\nK,M\n0,0\n1,0.1\n2,0.2\n";
    let stated = "[units]\ncurvature = \"1/cm\"\nmoment = \"gf·cm/cm\"\n";
    let told = |toml: &str| messages(&read_as("a.csv", text, &with_dialect(toml)).unwrap(), "R152");
    let all = told("name = \"lab\"\nkes_units = true\n");
    assert_eq!(all.len(), 1);
    assert!(all[0].ends_with("assumed: K in 1/cm, M in gf·cm/cm, width in cm"), "{all:?}");
    let of_width = told(&format!("name = \"lab\"\nkes_units = true\n{stated}"));
    assert!(of_width[0].ends_with("assumed: width in cm"), "{of_width:?}");
    let without = text.replace("width,20\n", "");
    let content = read_as("a.csv", &without, &with_dialect(&format!("name = \"lab\"\n{stated}"))).unwrap();
    assert!(messages(&content, "R152").is_empty());
    let kes = ReadSettings { kes_units: true, ..ReadSettings::default() };
    let table = read_as("t.csv", "fabric,B,2HB (gf·cm/cm)\nx,0.1,0.05\n", &kes).unwrap();
    let told = messages(&table, "R152");
    assert!(told.len() == 1 && told[0].ends_with("assumed: B in gf·cm²/cm"), "{told:?}");
}

/// What a file states goes before what a dialect does for files that state nothing, and where both do it is told.
#[test]
fn a_dialect_that_is_contradicted_is_told() {
    let text = "direction,warp\nwidth,200 mm\nK (1/cm),M (gf.cm/cm)\n0,0\n1,0.1\n2,0.2\n";
    let told = |units: &str, width: &str| {
        let units = format!("[units]\ncurvature = \"1/cm\"\nmoment = \"{units}\"\n");
        let toml = format!("name = \"lab\"\n{units}[conditions]\nwidth = \"{width}\"\n");
        messages(&read_as("a.csv", text, &with_dialect(&toml)).unwrap(), "R153")
    };
    // The same in other words.
    assert!(told("gf·cm/cm", "20 cm").is_empty());
    let all = told("mN·cm/cm", "10 cm");
    let expected = "the unit of \"M\" gf.cm/cm, and not mN·cm/cm; the width 20 cm, and not 10 cm";
    assert!(all.len() == 1 && all[0].ends_with(expected), "{all:?}");
}

/// A line that says nothing but a number of a specimen is the number of the record below it.
#[test]
fn a_line_numbers_the_specimen_below_it() {
    for line in ["Specimen 3", "Specimen #3", "Specimen No. 3", "# Repeat 3", "Probe Nr. 3", "試料番号 3"]
    {
        let block = |line: &str| format!("{line}\nK (1/cm),M (gf·cm/cm)\n0,0\n1,0.1\n2,0.2\n\n");
        let text = format!("direction,warp\n\n{}{}", block(line), block(&line.replace('3', "1")));
        let content = read("a.csv", &text);
        let numbers: Vec<usize> = content.measurements.iter().map(|m| m.specimen).collect();
        assert_eq!(numbers, [3, 1], "{line}");
    }
    let toml = "name = \"lab\"\n[keys]\nspecimen = [\"Sample\"]\n";
    let text = "direction,warp\n\nSample 7\nK (1/cm),M (gf·cm/cm)\n0,0\n1,0.1\n2,0.2\n";
    assert_eq!(read_as("a.csv", text, &with_dialect(toml)).unwrap().measurements[0].specimen, 7);
}

/// Two words of one list of a dialect are two columns all the same; a laboratory's own names of parameters go before ours.
#[test]
fn a_dialect_does_not_make_one_of_two_columns() {
    let toml = "name = \"lab\"\n[columns]\nmoment = [\"mom\", \"momraw\"]\n";
    let text = "direction,warp\n\nK (1/cm),momraw (gf·cm/cm),mom (gf·cm/cm)\n0,0,0\n1,0.12,0.1\n2,0.24,0.2\n";
    let content = read_as("a.csv", text, &with_dialect(toml)).unwrap();
    assert_eq!(messages(&content, "R119").len(), 1);
    let repeats = text.replace("momraw", "mom");
    let content = read_as("a.csv", &repeats, &with_dialect(toml)).unwrap();
    assert!(messages(&content, "R119").is_empty());
    let numbered = text.replace("momraw", "moment").replace("mom (", "moment 2 (");
    assert!(messages(&read("a.csv", &numbered), "R119").is_empty());
    let toml = "name = \"lab\"\n[symbols]\nB = [\"2HB05\"]\n";
    let table = "fabric,direction,2HB05 (gf·cm²/cm)\nx,warp,0.1\n";
    let content = read_as("t.csv", table, &with_dialect(toml)).unwrap();
    let keys: Vec<Parameter> = content.results.iter().map(|(_, value)| value.parameter).collect();
    assert_eq!(keys, [Parameter::B]);
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
    let value_of = |p, d| {
        content.results.iter().find(|(_, r)| r.parameter == p && r.direction == d).map(|(_, r)| r).unwrap()
    };
    assert_relative_eq!(
        value_of(Parameter::B, Some(Direction::Warp)).mean,
        200.0 * 5832.0 * 9.81e-12,
        max_relative = 1e-12
    );
    assert_relative_eq!(
        value_of(Parameter::B, Some(Direction::Weft)).mean,
        200.0 * 4096.0 * 9.81e-12,
        max_relative = 1e-12
    );
    assert_relative_eq!(value_of(Parameter::G, None).mean, 41.0, max_relative = 1e-12);
    assert!(value_of(Parameter::G, None).status == ValueStatus::Inferred);
    assert!(content.findings.iter().any(|f| f.code() == "R104" && f.message().contains("E100-1")));
}

/// A sheet of SiroFAST: -1 is warp and -2 weft also of values that KES knows; T2 (2 gf/cm²) is no T0 (0.5 gf/cm²); E5 and
/// E20 give the tensile stiffness between 5 and 20 gf/cm, 14.7 N/m over their difference; nothing is passed off as KES.
#[test]
fn a_sheet_of_fast_is_read_for_what_it_determines() {
    let text = "fabric,W (g/m2),T2 (mm),T100 (mm),ST (mm),C-1 (mm),C-2 (mm),B-1 (uN.m),B-2 (uN.m),E5-1 (%),E5-2 (%),\
                E20-1 (%),E20-2 (%),E100-1 (%),EB5 (%),G (N/m),RS-1 (%),HE-1 (%)\n\
                wool,195,0.62,0.48,0.14,18.1,17,11.34,9.4,0.3,0.4,0.9,1.1,2.5,3.1,39.7,1.2,3.5\n";
    let content = read("fast.csv", text);
    let value_of =
        |p, d| content.results.iter().find(|(_, r)| r.parameter == p && r.direction == d).map(|(_, r)| r);
    for (direction, b) in [(Direction::Warp, 11.34e-6), (Direction::Weft, 9.4e-6)] {
        let found = value_of(Parameter::B, Some(direction)).unwrap();
        assert_relative_eq!(found.mean, b, max_relative = 1e-12);
        assert!(found.status == ValueStatus::Inferred && found.n == 1);
    }
    assert_relative_eq!(value_of(Parameter::G, None).unwrap().mean, 39.7, max_relative = 1e-12);
    assert!(value_of(Parameter::T0, None).is_none() && value_of(Parameter::B, None).is_none());
    let stiffness: Vec<(Direction, f64)> =
        content.stiffnesses.iter().map(|(_, s)| (s.direction, s.stiffness)).collect();
    let [(Direction::Warp, warp), (Direction::Weft, weft)] = stiffness[..] else { panic!("{stiffness:?}") };
    assert_relative_eq!(warp, 14.709975 / 0.006, max_relative = 1e-9);
    assert_relative_eq!(weft, 14.709975 / 0.007, max_relative = 1e-9);
    let left_out = content.findings.iter().find(|f| f.code() == "R104").unwrap().message();
    for name in ["T2", "T100", "ST", "E100-1", "RS-1", "HE-1"] {
        assert!(left_out.contains(name), "{name}: {left_out}");
    }
}

/// Rows of one fabric are repeats also of E5 and E20, in any order.
#[test]
fn repeated_rows_of_fast_are_averaged() {
    let (head, rows) = (
        "fabric,W (g/m2),C-1 (mm),C-2 (mm),E5-1 (%),E20-1 (%)\n",
        ["wool,195,18,17,0.3,0.9\n", "wool,195,18,17,0.5,1.3\n"],
    );
    for [first, second] in [[0, 1], [1, 0]] {
        let content = read("fast.csv", &format!("{head}{}{}", rows[first], rows[second]));
        let [(_, stated)] = &content.stiffnesses[..] else { panic!("{:?}", content.stiffnesses) };
        assert_relative_eq!(stated.stiffness, 14.709975 / 0.007, max_relative = 1e-9);
    }
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
        let mean_of = |p, d| {
            let same = |r: &&kesf::instrument::ResultValue| r.parameter == p && r.direction == d;
            content.results.iter().map(|(_, r)| r).find(same).unwrap().mean
        };
        let expected = |c: f64| 200.0 * c.powi(3) * 9.81e-12;
        assert_relative_eq!(
            mean_of(Parameter::B, Some(Direction::Warp)),
            expected(18.0),
            max_relative = 1e-12
        );
        assert_relative_eq!(
            mean_of(Parameter::B, Some(Direction::Weft)),
            expected(16.0),
            max_relative = 1e-12
        );
        assert_relative_eq!(mean_of(Parameter::G, None), 41.0, max_relative = 1e-12);
    }
    // Without a unit nothing is guessed.
    assert_eq!(code("parameter,unit,value\nW,g/m²,200\nC-1,,18\n"), "R008");
}

/// What was inferred can be read: the words of `kesf check -v`.
#[test]
fn inference_is_told() {
    let text = "direction;warp\nK (1/cm);M (gf·cm/cm);what\n0,0;0,0;a\n1,5;0,1;b\n2,5;0,2;c\n";
    let inference = read("a.csv", text).inference.join("\n");
    for expected in [
        "encoding UTF-8: the bytes are valid UTF-8",
        "delimiter ';', decimal mark ',': 6 numbers so",
        "words that dialects know, of 5 texts: kesf 3, ",
        "\"K\" and \"M\": bending test, which the columns belong to",
        "width 20 cm (standard, not in the file)",
        "\"M\" (gf·cm/cm) times 0.00980665 is N",
        "bending warp (stated in line 1), specimen not numbered of sample \"a\": 3 points in lines 3 to 5",
    ] {
        assert!(inference.contains(expected), "{expected} is not in {inference}");
    }
    let unknown = read_as("a.csv", "sample,x\nfoo (1/cm),moment (gf)\n0,0\n1,1\n", &ReadSettings::default())
        .unwrap_err();
    assert_eq!(unknown.code(), "R006");
    assert!(unknown.to_string().contains("\"kesf\" comes closest"), "{unknown}");
    assert!(unknown.to_string().contains("foo"), "{unknown}");
    assert!(!unknown.hint().is_empty());
    // The error carries what was decided before it, and what a dialect file could say.
    let inference = unknown.about.inference.join("\n");
    for expected in [
        "encoding UTF-8",
        "headings foo (1/cm) | moment (gf)",
        "dialect kesf: knows moment (gf); does not know foo (1/cm)",
        "[columns]",
        "curvature = [\"foo\"]",
    ] {
        assert!(inference.contains(expected), "{expected} is not in {inference}");
    }
}

/// Two sheets: side-by-side curves with typed numbers, and a result table.
#[test]
fn a_workbook_is_read_like_text() {
    let bytes = include_bytes!("../workbooks/twill.xlsx");
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

/// Numbers of repeats, and messages of a code.
fn repeats(content: &FileContent) -> Vec<(Option<&str>, usize)> {
    content.results.iter().map(|(fabric, r)| (fabric.as_deref(), r.n)).collect()
}

fn messages(content: &FileContent, code: &str) -> Vec<String> {
    content.findings.iter().filter(|f| f.code() == code).map(|f| f.message()).collect()
}

/// Rows of means and deviations below specimens or fabrics are none; alone they are the values.
#[test]
fn rows_that_sum_up_others_are_no_specimens() {
    let table = read(
        "t.csv",
        "Specimen No.,B warp (gf·cm²/cm),B weft (gf·cm²/cm)\n1,0.10,0.05\n2,0.12,0.06\n3,0.11,0.04\nMean,0.11,0.05\nSD,0.01,0.01\n",
    );
    assert_eq!(repeats(&table), [(None, 3), (None, 3)]);
    assert_relative_eq!(table.results[0].1.mean, 0.11 * 9.80665e-5, max_relative = 1e-12);
    assert_relative_eq!(table.results[0].1.sd.unwrap(), 0.01 * 9.80665e-5, max_relative = 1e-12);
    assert_eq!(
        messages(&table, "R110"),
        ["rows that sum up others are left out: \"Mean\" (line 5), \"SD\" (line 6)"]
    );
    // Numbers of samples are fabrics.
    let fabrics = read(
        "t.csv",
        "試料番号\tB(gf·cm²/cm)\t2HB(gf·cm/cm)\n1\t0.1\t0.05\n2\t0.2\t0.06\n平均\t0.15\t0.055\n標準偏差\t0.07\t0.007\n変動係数\t47\t13\n",
    );
    assert_eq!(repeats(&fabrics), [(Some("1"), 1), (Some("1"), 1), (Some("2"), 1), (Some("2"), 1)]);
    assert!(
        messages(&fabrics, "R110")[0]
            .ends_with("\"平均\" (line 4), \"標準偏差\" (line 5), \"変動係数\" (line 6)")
    );
    // A row for each parameter.
    let long = read(
        "t.csv",
        "fabric,specimen,parameter,value,unit\nx,1,B,0.1,gf·cm²/cm\nx,2,B,0.3,gf·cm²/cm\nx,média,B,0.2,gf·cm²/cm\n",
    );
    assert_eq!(repeats(&long), [(Some("x"), 2)]);
    // Published: no specimens, but a mean and its deviation.
    let published = read(
        "t.csv",
        "fabric,specimen,B (gf·cm²/cm),G (N/m)\nx,Mean,0.1,30\nx,SD,0.01,2\ny,Mean,0.2,40\ny,SD,0.02,3\n",
    );
    let means: Vec<f64> = published.results.iter().map(|(_, r)| r.mean / 9.80665e-5).collect();
    assert_relative_eq!(means[0], 0.1, max_relative = 1e-12);
    assert_eq!(repeats(&published).iter().map(|(_, n)| *n).collect::<Vec<_>>(), [1, 1, 1, 1]);
    // A fabric is called like an extreme, and none is left out.
    let max = read("t.csv", "fabric,B (gf·cm²/cm),G (N/m)\nAnna,0.1,30\nMax,0.2,40\n");
    assert_eq!((repeats(&max).len(), messages(&max, "R110").len()), (4, 0));
}

/// `F1 mean` among rows of F1, its parts or its other statistics is no fabric; alone it is the name of one.
#[test]
fn a_name_with_a_statistic_is_that_of_the_fabric() {
    let rows = |names: &[&str]| {
        let row = |(i, name): (usize, &&str)| {
            format!("{name},{},{}\n", 0.1 + 0.017 * i as f64, 0.2 + 0.031 * i as f64)
        };
        let rows: String = names.iter().enumerate().map(row).collect();
        read("t.csv", &format!("Sample,B warp (gf·cm²/cm),B weft (gf·cm²/cm)\n{rows}"))
    };
    let names = |table: &FileContent| -> Vec<String> {
        let named = table.results.iter().filter(|(_, r)| r.direction == Some(Direction::Warp));
        named.map(|(fabric, r)| format!("{} {}", fabric.as_deref().unwrap_or("-"), r.n)).collect()
    };
    let repeated = rows(&["F1", "F1", "F1 mean", "F2", "F2", "F2 mean"]);
    assert_eq!(names(&repeated), ["F1 2", "F2 2"]);
    assert!(messages(&repeated, "R110")[0].contains("\"F2 mean\" (line 7)"));
    assert_eq!(
        names(&rows(&["F1 1", "F1 2", "Mean of F1", "F2 1", "F2 2", "F2 (SD)"])),
        ["F1 1 1", "F1 2 1", "F2 1 1", "F2 2 1"]
    );
    let published = rows(&["F1 mean", "F1 SD", "F2 mean", "F2 SD"]);
    assert_eq!(names(&published), ["F1 1", "F2 1"]);
    assert_relative_eq!(published.results[0].1.mean, 0.1 * 9.80665e-5, max_relative = 1e-12);
    assert_relative_eq!(published.results[0].1.sd.unwrap(), 0.117 * 9.80665e-5, max_relative = 1e-12);
    assert_eq!(names(&rows(&["Denim max", "Denims", "Poplin"])), ["Denim max 1", "Denims 1", "Poplin 1"]);
}

/// Two units of one value, wherever they stand, are refused with both.
#[test]
fn two_units_of_a_value_are_refused() {
    for (place, text) in [
        ("2:2", "Sample,B warp (gf·cm²/cm),B weft (gf·cm²/cm)\n,N·m²/m,N·m²/m\npoplin,0.1,0.2\n"),
        ("2:12", "parameter,unit,warp\nB (N·m²/m),gf·cm²/cm,0.1\n"),
        ("2:11", "unit,parameter,warp\ngf·cm²/cm,B (N·m²/m),0.1\n"),
        ("2:12", "parameter,warp (gf·cm²/cm),weft (gf·cm²/cm)\nB (N·m²/m),0.1,0.2\n"),
    ] {
        let error = read_as("t.csv", text, &ReadSettings::default()).unwrap_err();
        let message = error.to_string();
        assert!(error.code() == "R018" && message.contains("the unit of these values is"), "{message}");
        assert!(message.contains(&format!("t.csv:{place}")), "{message}");
    }
    let same = "parameter,unit,warp (gf cm^2/cm)\nB (gf·cm²/cm),gf.cm2/cm,0.1\n";
    assert_relative_eq!(read("t.csv", same).results[0].1.mean, 0.1 * 9.80665e-5, max_relative = 1e-12);
}

/// Fabrics over their directions may be called like symbols, where the rows are parameters.
#[test]
fn names_over_columns_may_look_like_symbols() {
    let table = read("t.csv", "Parameter,Unit,A,A,B,B\n,,warp,weft,warp,weft\nB,gf·cm²/cm,0.1,0.2,0.3,0.4\n");
    let found: Vec<_> =
        table.results.iter().map(|(f, r)| (f.as_deref().unwrap(), r.direction.unwrap())).collect();
    let (warp, weft) = (Direction::Warp, Direction::Weft);
    assert_eq!(found, [("A", warp), ("A", weft), ("B", warp), ("B", weft)]);
}

/// A column of deviations is no parameter: LT and its CV are both without unit.
#[test]
fn columns_that_sum_up_others_are_no_values() {
    let table = read("t.csv", "fabric,specimen,LT,LT CV (%),LT max\nx,1,0.8,3,0.9\nx,2,0.6,3,0.9\n");
    assert_eq!(repeats(&table), [(Some("x"), 2)]);
    assert_relative_eq!(table.results[0].1.mean, 0.7, max_relative = 1e-12);
    assert_eq!(messages(&table, "R104"), ["no KES parameters, and left out: LT CV (%), LT max"]);
    let long = read("t.csv", "parameter,unit,warp,warp SD,weft,weft SD\nB,gf·cm²/cm,0.1,0.01,0.05,0.01\n");
    assert_eq!(repeats(&long), [(None, 1), (None, 1)]);
    let sds: Vec<f64> = long.results.iter().filter_map(|(_, r)| r.sd).collect();
    assert_relative_eq!(sds[1], 0.01 * 9.80665e-5, max_relative = 1e-12);
    assert_eq!(messages(&long, "R104"), [""; 0]);
}

#[test]
fn curves_that_sum_up_others_are_no_specimens() {
    let rows = "0,0,0,0\n1,0.1,0.2,0.15\n2,0.2,0.4,0.3\n";
    let shared = read(
        "a.csv",
        &format!(
            "direction,warp\nK (1/cm),moment 1 (gf·cm/cm),moment 2 (gf·cm/cm),mean moment (gf·cm/cm)\n{rows}"
        ),
    );
    assert_eq!(shared.measurements.len(), 2);
    assert_eq!(
        messages(&shared, "R110"),
        ["curves that sum up others are left out: \"mean moment\" (line 2)"]
    );
    // The label stands over the columns.
    let labelled = read(
        "a.txt",
        "経-1\t\t経-2\t\t平均\t\nK (1/cm)\tM (gf·cm/cm)\tK (1/cm)\tM (gf·cm/cm)\tK (1/cm)\tM (gf·cm/cm)\n0\t0\t0\t0\t0\t0\n1\t0.1\t1\t0.2\t1\t0.15\n2\t0.2\t2\t0.4\t2\t0.3\n",
    );
    let found: Vec<_> = labelled.measurements.iter().map(|m| (m.direction, m.specimen)).collect();
    assert_eq!(found, [(Some(Direction::Warp), 1), (Some(Direction::Warp), 2)]);
    assert_eq!(messages(&labelled, "R110").len(), 1);
    // Column pairs, and a mean without an abscissa.
    let pairs = read(
        "a.csv",
        "direction,warp\nK (1/cm),M (gf·cm/cm),K (1/cm),M (gf·cm/cm),average moment (gf·cm/cm)\n0,0,0,0,0\n1,0.1,1,0.2,0.15\n2,0.2,2,0.4,0.3\n",
    );
    assert_eq!((pairs.measurements.len(), messages(&pairs, "R110").len()), (2, 1));
    // A curve that is published as a mean is a curve.
    let mean = read(
        "a.csv",
        "direction,warp\nK (1/cm),mean moment (gf·cm/cm),moment SD (gf·cm/cm)\n0,0,0\n1,0.1,0.01\n2,0.2,0.02\n",
    );
    assert_eq!((mean.measurements.len(), messages(&mean, "R110").len()), (1, 1));
    assert_relative_eq!(mean.measurements[0].curve.y[2], 0.2 * 9.80665e-3, max_relative = 1e-14);
}

/// A header line may begin with a word of statistics.
#[test]
fn a_set_maximum_is_no_label() {
    let text = "direction,warp\nmaximum,2.5 1/cm\n\nK (1/cm),M (gf·cm/cm)\n0,0\n1,1\n2,2\n";
    let m = &read("a.csv", text).measurements[0];
    assert_relative_eq!(m.conditions.maximum, 250.0);
}

/// Units that have the dimension of a raw force or moment and are those of B, G or 2HB.
#[test]
fn units_of_rigidities_are_refused_for_forces_and_moments() {
    let bending = |unit: &str| format!("direction;warp\nK (1/cm);moment ({unit})\n0;0\n1;1\n2;2\n");
    for unit in [
        "gf·cm²/cm",
        "gf cm2/cm",
        "gf·cm·cm/cm",
        "(gf·cm^2)/cm",
        "gf·cm²·cm-1",
        "uN·m²/m",
        "gf·cm/cm·deg",
        "gf·cm/deg",
    ] {
        let text = bending(unit);
        let error = read_as("a.csv", &text, &ReadSettings::default()).unwrap_err().to_string();
        assert!(error.contains("R010") || error.contains("R009"), "{unit}: {error}");
    }
    let error = read_as("a.csv", &bending("gf·cm²/cm"), &ReadSettings::default()).unwrap_err().to_string();
    assert_eq!(
        error,
        "a.csv:2:10: R010 \"gf·cm2/cm\" is not a unit of moment (which needs one like gf·cm/cm or gf·cm)"
    );
    // 2 of each over 20 cm of width, in N.
    for (unit, expected) in [
        ("gf·cm", 9.80665e-5),
        ("N·m", 1.0),
        ("mN·m", 1e-3),
        ("mN*cm", 1e-5),
        ("kg·m²/s²", 1.0),
        ("g mm2/s2", 1e-9),
    ] {
        let content = read("a.csv", &bending(unit));
        assert_relative_eq!(content.measurements[0].curve.y[2], 2.0 * expected / 0.2, max_relative = 1e-12);
    }
    assert_eq!(code(&bending("V").replace("warp\n", "warp\nsens;20 gf·cm²/cm\n")), "R010");
    let force =
        |abscissa: &str, unit: &str| format!("direction;warp\n{abscissa};force ({unit})\n0;0\n1;1\n2;2\n");
    for unit in ["gf/(cm·deg)", "gf/cm·deg", "N/(m·rad)", "gf/(cm·°)", "gf·cm/cm"] {
        assert_eq!(code(&force("angle (deg)", unit)), "R010", "{unit}");
    }
    assert_eq!(code(&force("strain (%)", "gf·cm/cm")), "R010");
    assert_eq!(code(&force("thickness (mm)", "gf·cm/cm").replace("force", "pressure")), "R010");
    assert_eq!(read("a.csv", &force("angle (deg)", "gf/cm")).measurements.len(), 1);
}

/// A column of the unloading branch is that of the loading one beside it, whichever comes first and whatever the force is called.
#[test]
fn columns_of_load_and_unload_are_one_curve() {
    for [load, unload] in [
        ["Load", "Unload"],
        ["carga", "descarga"],
        ["charge", "décharge"],
        ["carico", "scarico"],
        ["Force+", "Force-"],
        ["Force", "Recovery force"],
    ] {
        let rows = [["0,0,0", "1,10,2", "2,50,50"], ["0,0,0", "1,2,10", "2,50,50"]];
        for (heads, rows) in [[load, unload], [unload, load]].into_iter().zip(rows) {
            let [a, b] = heads;
            let text = format!("direction,warp\nstrain (%),{a} (gf/cm),{b} (gf/cm)\n{}\n", rows.join("\n"));
            let found = read("a.csv", &text);
            let forces: Vec<f64> =
                found.measurements[0].curve.y.iter().map(|f| (f / 0.980665).round()).collect();
            assert_eq!(
                (found.measurements.len(), forces),
                (1, vec![0.0, 10.0, 50.0, 50.0, 2.0, 0.0]),
                "{heads:?}"
            );
        }
    }
}

/// A dimension of the specimen that the standard set gave is told once; one that is stated is not.
#[test]
fn standard_dimensions_are_told() {
    let text = "direction,warp\nextension (mm),load 1 (gf),load 2 (gf)\n0,0,0\n0.5,100,110\n1,500,510\n";
    let width = "no width is stated: force or moment was divided by the standard 20 cm; state `width` in the header or in [conditions] of fabric.toml";
    let gauge = "no gauge is stated: travel was divided by the standard 5 cm; state `gauge` in the header or in [conditions.tensile] of fabric.toml";
    let content = read("a.csv", text);
    assert_eq!(
        (content.measurements.len(), messages(&content, "R109")),
        (2, vec![gauge.to_string(), width.to_string()])
    );
    // Both are the standard values: stated, they need no remark.
    let stated = format!("width,20 cm\ngauge,5 cm\n{text}");
    assert_eq!(messages(&read("a.csv", &stated), "R109"), [""; 0]);
    let by_dialect = with_dialect(
        "name = \"lab\"\n[conditions]\nwidth = \"20 cm\"\n[conditions.tensile]\ngauge = \"5 cm\"\n",
    );
    assert_eq!(messages(&read_as("a.csv", text, &by_dialect).unwrap(), "R109"), [""; 0]);
    let foot = "thickness (mm),force (gf)\n0.5,1\n0.4,50\n0.3,100\n";
    let content = read("a.csv", &format!("test,compression\n{foot}"));
    assert_eq!(
        messages(&content, "R109"),
        ["no foot area is stated: force was divided by the standard 2 cm²; state `area` in the header"]
    );
    assert_eq!(messages(&read("a.csv", &format!("test,compression\narea,2 cm²\n{foot}")), "R109"), [""; 0]);
    // Per width nothing was divided.
    assert_eq!(
        messages(&read("a.csv", "direction,warp\nK (1/cm),M (gf·cm/cm)\n0,0\n1,1\n2,2\n"), "R109"),
        [""; 0]
    );
}

/// Remarks stand before headings and among numbers, in curves and in tables; errors of spreadsheets are none.
#[test]
fn remarks_among_numbers_are_passed_over() {
    let text = "# made by hand\ndirection,warp\nK (1/cm),M (gf·cm/cm)\n0,0\n# pause\n1,0.1\n# note: 5 min, again\n\n#1.5,0.15\n2,0.2\n# end\n";
    let m = &read("a.csv", text).measurements[0];
    assert_eq!((m.lines.clone(), m.curve.len()), (vec![4, 6, 10], 3));
    // Stacked blocks: what stands before the next header belongs to it.
    let second = "# date: tomorrow\nspecimen,2\nK (1/cm),M (gf·cm/cm)\n0,0\n1,1\n2,2\n";
    let stacked = read("a.csv", &format!("{text}{second}"));
    assert_eq!(stacked.measurements.len(), 2);
    assert_eq!(stacked.measurements[1].metadata.get("date").map(String::as_str), Some("tomorrow"));
    assert_eq!(code("direction,warp\nK (1/cm),M (gf·cm/cm)\n0,0\n#REF!,0.1\n2,0.2\n3,0.3\n"), "R004");
    assert_eq!(code("direction,warp\nK (1/cm),M (gf·cm/cm)\n0,0\n#N/A,0.1\n2,0.2\n3,0.3\n"), "R017");
    let table = read("t.csv", "fabric,B (gf·cm²/cm),G (N/m)\n# two of ours\n#1,0.1,30\n#2,0.2,40\n");
    assert_eq!(repeats(&table), [(Some("#1"), 1), (Some("#1"), 1), (Some("#2"), 1), (Some("#2"), 1)]);
}

/// Reports of fixed width: gaps of two blanks in headings, of one in rows of numbers.
#[test]
fn blanks_may_separate_columns() {
    let text = "direction   warp\nwidth: 20 cm\n\n   curvature (1/cm)   moment (gf·cm)\n   0.0 0.0\n   1.0 -2.0\n   2.0 4.0\n";
    let content = read("a.prn", text);
    let m = &content.measurements[0];
    assert_relative_eq!(m.curve.y[2], 0.2 * 9.80665e-3, max_relative = 1e-14);
    assert!(content.inference.iter().any(|line| line.starts_with("columns that blanks separate")));
    // A broken number is found at its column.
    let broken = text.replace("1.0 -2.0", "1.0 -2.0.0");
    let error = read_as("a.prn", &broken, &ReadSettings::default()).unwrap_err();
    assert_eq!(error.to_string(), "a.prn:6:8: R004 \"-2.0.0\" is not a number (decimal mark is '.')");
    // A hole would shift the cells behind it.
    let holes = "direction   warp\nK (1/cm)  M (gf·cm/cm)  K (1/cm)  M (gf·cm/cm)\n0 0 0 0\n1 1 1 1\n2 2 2 2\n    3 3\n";
    assert_eq!(code(holes), "R002");
}

/// Warnings of the instrument's program may be an object with a name for each test.
#[test]
fn warnings_of_a_fab_file_are_told_in_any_form() {
    let text = r#"{"raw_data": {"warnings": {"BendRigidityWarp": "low-force"},
        "L": {"S1": {"length": 2.08, "width": 5, "samplesTree": [[1.9, 0.1, 2.0, 5.5, 2.1, 20]]}}}}"#;
    let content = read("a.json", text);
    assert_eq!(
        messages(&content, "R108"),
        ["the instrument's program warned: raw_data.BendRigidityWarp: low-force"]
    );
}

/// A knit of wale and course, whose foot presses it together: T0 is taken where the foot first touches, as the instrument's
/// program does, and not from the ends of branches. The second loading branch begins at another force.
#[test]
fn the_thickness_of_a_fab_file_is_that_of_the_first_contact() {
    let file = |program: f64| {
        format!(
            r#"{{"raw_data": {{"L": {{"S1": {{"length": 2.08, "width": 5, "samplesTree": [[1.9, 0.1, 2.0, 5.5, 2.1, 20]]}}}},
            "T": {{"samplesTree": [[0.0202, -560, 0.0105, -1200], [0.0106, -1190, 0.0150, -570], [0.0180, -800, 0.0104, -1300]]}}}},
            "custom": {{"browzwear": {{"category": "Knits", "thickness": {program}}}}}}}"#
        )
    };
    let sheet = |program: f64| {
        let content = read("knit.u3m", &file(program));
        assert_eq!(messages(&content, "R117").len(), 1);
        let input = FabricInput { fab: content.fab.into_iter().collect(), ..FabricInput::default() };
        characterise(&input, &Settings::default())
    };
    let t0 = sheet(0.2020);
    assert_relative_eq!(t0.get(Parameter::T0, None).unwrap().mean, 2.02e-4, max_relative = 1e-12);
    let codes = |sheet: &FabricSheet| sheet.findings.iter().map(|f| f.code()).collect::<Vec<_>>();
    assert!(!codes(&t0).contains(&"K048"));
    assert!(codes(&sheet(0.1156)).contains(&"K048"));
}

/// A direction or a parameter that stands in the first of its rows only, as merged cells are exported.
#[test]
fn blank_cells_below_a_direction_or_a_parameter_are_the_same() {
    let b = |content: &FileContent| -> Vec<(Option<String>, Option<Direction>, f64, usize)> {
        let of_b = content.results.iter().filter(|(_, r)| r.parameter == Parameter::B);
        of_b.map(|(f, r)| (f.clone(), r.direction, (r.mean / 9.80665e-5 * 1e4).round() / 1e4, r.n)).collect()
    };
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    let head = "B (gf·cm²/cm),2HB (gf·cm/cm)\n";
    let specimens = [
        format!("Direction,Specimen,{head}Warp,1,0.1,0.04\n,2,0.2,0.05\nWeft,1,0.3,0.03\n,2,0.5,0.02\n"),
        format!(
            ",No.,{head}Warp,1,0.1,0.04\n,2,0.2,0.05\n,Mean,0.15,0.045\nWeft,1,0.3,0.03\n,2,0.5,0.02\n,Mean,0.4,0.025\n"
        ),
    ];
    for text in specimens {
        let content = read("t.csv", &text);
        assert_eq!(b(&content), [(None, warp, 0.15, 2), (None, weft, 0.4, 2)], "{text}");
        assert_eq!(messages(&content, "R124").len(), 1, "{text}");
    }
    let f = |n: usize| Some(format!("F{n}"));
    let by_direction = read(
        "t.csv",
        &format!("Direction,Fabric,{head}Warp,F1,0.1,0.04\n,F2,0.2,0.05\nWeft,F1,0.3,0.03\n,F2,0.5,0.02\n"),
    );
    let expected = [(f(1), warp, 0.1, 1), (f(1), weft, 0.3, 1), (f(2), warp, 0.2, 1), (f(2), weft, 0.5, 1)];
    let mut found = b(&by_direction);
    found.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(found, expected);
    let down = read(
        "t.csv",
        "Parameter,Direction,Value,Unit\nB,Warp,0.1,gf·cm²/cm\n,Weft,0.3,gf·cm²/cm\n2HB,Warp,0.04,gf·cm/cm\n,Weft,0.03,gf·cm/cm\n",
    );
    assert_eq!(b(&down), [(None, warp, 0.1, 1), (None, weft, 0.3, 1)]);
    assert_eq!((down.results.len(), messages(&down, "R124").len()), (4, 1));
    // One row a direction, and one of the fabric as a whole.
    let whole = read("t.csv", "fabric,direction,B (gf·cm²/cm),LC\nF1,warp,0.1,\nF1,weft,0.3,\nF1,,,0.35\n");
    assert_eq!(b(&whole), [(f(1), warp, 0.1, 1), (f(1), weft, 0.3, 1)]);
    assert_eq!((whole.results.len(), messages(&whole, "R124").len()), (3, 0));
}

/// Texts and values of B in gf·cm²/cm, rounded, of a table.
fn of_b(content: &FileContent) -> Vec<(Option<&str>, Option<Direction>, f64, usize)> {
    let of_b = content.results.iter().filter(|(_, r)| r.parameter == Parameter::B);
    of_b.map(|(f, r)| (f.as_deref(), r.direction, (r.mean / 9.80665e-5 * 1e4).round() / 1e4, r.n)).collect()
}

const B: &str = "B (gf·cm²/cm)";

/// Rows that are averaged although a column tells them apart: states, customers, remarks, but not who measured when.
#[test]
fn columns_that_tell_repeats_apart_are_told() {
    for (heads, rows, is_reported) in [
        ("Fabric,Finish,No.", "A,none,1,0.1\nA,none,2,0.2\nA,soft,3,0.3\nA,soft,4,0.4\n", true),
        ("Fabric,Washes", "A,0,0.1\nA,5,0.2\nA,10,0.3\n", true),
        ("Customer,Article,No.", "X,A,1,0.1\nX,A,2,0.2\nY,A,3,0.3\n", true),
        ("Fabric,No.,Comment", "A,1,,0.1\nA,2,discarded,0.2\nA,3,,0.3\n", true),
        ("Fabric,No.,Operator", "A,1,Ana,0.1\nA,2,Rui,0.2\nA,3,Ana,0.3\n", false),
        ("Fabric,No.,When", "A,1,10:31,0.1\nA,2,10:35,0.2\nA,3,10:35,0.3\n", false),
        ("Fabric,Finish", "A,none,0.1\nC,soft,0.2\nD,soft,0.3\n", false),
    ] {
        let content = read("t.csv", &format!("{heads},{B}\n{rows}"));
        assert_eq!(
            messages(&content, "R126").len(),
            usize::from(is_reported),
            "{rows}: {:?}",
            content.findings
        );
    }
}

/// A direction is the whole of a text: what else it says is told, and what is across the warp is no warp.
#[test]
fn what_is_said_beside_a_direction_is_not_lost() {
    let with = |direction: &str| format!("Direction,{B}\n{direction},0.1\nweft,0.2\n");
    for (text, count) in [("warp yarns", 0), ("along the warp", 0), ("Warp 1", 0), ("warp before washing", 1)]
    {
        let content = read("t.csv", &with(text));
        let mut found = of_b(&content);
        found.sort_by(|a, b| a.2.total_cmp(&b.2));
        assert_eq!(found[0], (None, Some(Direction::Warp), 0.1, 1), "{text}");
        assert_eq!(messages(&content, "R125").len(), count, "{text}: {:?}", content.findings);
    }
    for text in ["perpendicular to warp", "not warp", "90° to warp", "senkrecht zur Kette", "垂直于经向"]
    {
        let refused = read_as("t.csv", &with(text), &ReadSettings::default()).unwrap_err();
        assert!(refused.to_string().contains("is not a direction"), "{text}: {refused}");
        let curve =
            format!("test,bending\ndirection,{text}\n\ncurvature (1/cm),moment (gf·cm/cm)\n0,0\n1,1\n2,2\n");
        let refused = read_as("t.csv", &curve, &ReadSettings::default()).unwrap_err();
        assert!(refused.to_string().contains("is not a direction"), "{text}: {refused}");
    }
    let heads = read("t.csv", "Property,Unit,Warp direction,Filling direction\nB,gf·cm²/cm,0.1,0.2\n");
    assert_eq!(of_b(&heads), [(None, Some(Direction::Warp), 0.1, 1), (None, Some(Direction::Weft), 0.2, 1)]);
}

/// The mean is the value, whatever the column beside it is called; the statistic of a direction is no specimen of it.
#[test]
fn a_mean_beside_an_unknown_column_is_the_value() {
    let german = read(
        "t.csv",
        &format!("Fabric,{B},,2HB (gf·cm/cm),\n,Ø,s,Ø,s\nA,0.1,0.01,0.05,0.004\nC,0.2,0.02,0.06,0.006\n"),
    );
    assert_eq!(of_b(&german), [(Some("A"), None, 0.1, 1), (Some("C"), None, 0.2, 1)]);
    assert!(messages(&german, "R104")[0].contains(" s"), "{:?}", german.findings);
    let rows = read(
        "t.csv",
        &format!("Direction,No.,{B}\nWarp,1,0.1\nWarp,2,0.3\nWarp mean,,0.2\nWeft,1,0.4\nWeft,2,0.6\n"),
    );
    let mut found = of_b(&rows);
    found.sort_by(|a, b| a.2.total_cmp(&b.2));
    assert_eq!(found, [(None, Some(Direction::Warp), 0.2, 2), (None, Some(Direction::Weft), 0.5, 2)]);
}

/// Names alone over rows of specimens are fabrics; rows behind the end of a table are told.
#[test]
fn rows_between_and_behind_the_rows_of_a_table() {
    let titles = read("t.csv", &format!("No.,{B}\nCotton,\n1,0.1\n2,0.2\nWool,\n1,0.3\n2,0.5\n"));
    assert_eq!(of_b(&titles), [(Some("Cotton"), None, 0.15, 2), (Some("Wool"), None, 0.4, 2)]);
    let behind = read("t.csv", &format!("Fabric,{B}\nA,0.1\nC,0.2\n\nRepeated in March\nD,0.3\n"));
    assert_eq!(of_b(&behind).len(), 2);
    assert!(messages(&behind, "R128")[0].contains("line 6"), "{:?}", behind.findings);
    let header = read("t.csv", &format!("Fabric,{B}\nA,0.1\nC,0.2\n\nMeasured in March\nTemperature,20\n"));
    assert_eq!(messages(&header, "R128").len(), 0);
}

/// A square is the size of the cloth that was cut: the jaws are as far apart as the instrument has them, and that is told.
#[test]
fn a_square_specimen_does_not_state_the_gauge() {
    let text = |size: &str| {
        format!(
            "test,tensile\ndirection,warp\nspecimen size,{size}\n\nextension (mm),force (gf/cm)\n0,0\n1,100\n2,300\n3,500\n"
        )
    };
    let gauge = |size: &str| {
        let content = read("t.csv", &text(size));
        (content.measurements[0].conditions.gauge, messages(&content, "R109").len())
    };
    assert_eq!(gauge("20 x 5 cm"), (0.05, 0));
    assert_eq!(gauge("200 x 200 mm"), (0.05, 1));
    assert_eq!(gauge("20 x 10 cm"), (0.1, 0));
}

/// What papers print behind and in the place of numbers: letters of significance, footnotes, powers of ten, bounds and ranges.
#[test]
fn marks_are_left_out_and_bounds_are_no_values() {
    let marked =
        read("t.csv", &format!("Fabric,Direction,{B}\nA,warp,0.1a\nA,weft,0.2**\nC,warp,3.0×10⁻¹\n"));
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    assert_eq!(
        of_b(&marked),
        [(Some("A"), warp, 0.1, 1), (Some("A"), weft, 0.2, 1), (Some("C"), warp, 0.3, 1)]
    );
    assert!(messages(&marked, "R130")[0].contains("\"0.1a\", \"0.2**\""), "{:?}", marked.findings);
    let bounds =
        read("t.csv", "Property,Unit,Warp,Weft\nB,gf·cm²/cm,0.079-0.083,<0.01\n2HB,gf·cm/cm,0.04,n.d.\n");
    assert_eq!(of_b(&bounds), []);
    assert!(messages(&bounds, "R131")[0].contains("\"0.079-0.083\", \"<0.01\""), "{:?}", bounds.findings);
    assert_eq!(bounds.results.len(), 1);
}

/// A heading may say at which angle or load its parameter is read by definition, and repeat its name in words; another
/// condition is another quantity.
#[test]
fn headings_with_the_condition_of_the_definition() {
    let read_one = |heading: &str, value: &str| {
        let text = format!("Fabric,Direction,\"{heading}\",{B}\nA,warp,{value},0.1\nA,weft,{value},0.2\n");
        let content = read("t.csv", &text);
        let found: Vec<f64> = content
            .results
            .iter()
            .filter(|(_, r)| r.parameter != Parameter::B)
            .map(|(_, r)| r.mean)
            .collect();
        (found, messages(&content, "R104").len())
    };
    for (heading, si) in [
        ("2HG at 0.5° (gf/cm)", 0.980665),
        ("Hysteresis of shear force at 5 degrees, 2HG5 (gf/cm)", 0.980665),
        ("Hysteresis 2HB (gf·cm/cm)", 9.80665e-3),
        ("Schubhysterese 2HG (cN/cm)", 1.0),
        ("EMT (% at 500 gf/cm)", 0.01),
        ("Bending\nhysteresis\n(gf·cm/cm)", 9.80665e-3),
    ] {
        let (found, left_out) = read_one(heading, "1");
        assert!(left_out == 0 && found.len() == 2, "{heading}: {found:?}");
        assert!(found.iter().all(|v| (v / si - 1.0).abs() < 1e-12), "{heading}: {found:?}");
    }
    for heading in ["2HG at 3° (gf/cm)", "EMT at 50 gf/cm (%)", "2HB corrected (gf·cm/cm)"] {
        assert_eq!(read_one(heading, "1"), (vec![], 1), "{heading}");
    }
}

const LOOP: &str = "0,0\n1,0.1\n2,0.2\n1,0.06\n0,-0.03\n-1,-0.1\n-2,-0.2\n-1,-0.06\n0,0.03\n";

/// The codes of the findings of a file.
fn codes(name: &str, text: &str) -> Vec<&'static str> {
    read(name, text).findings.iter().map(|finding| finding.code()).collect()
}

/// A force per width is no force along the weft; where both words stand side by side they are directions.
#[test]
fn dimensions_in_headings_are_no_directions() {
    for heading in [
        "moment per unit width (gf·cm/cm)",
        "moment per unit length (gf·cm/cm)",
        "transverse moment (gf·cm/cm)",
    ] {
        let record = |header: &str| format!("test,bending\n{header}\ncurvature (1/cm),{heading}\n{LOOP}");
        assert_eq!(code(&record("")), "R012", "{heading}");
        let stated = read("lab.csv", &record("direction,warp\n"));
        assert_eq!(stated.measurements[0].direction, Some(Direction::Warp), "{heading}");
        assert!(stated.findings.is_empty(), "{heading}: {:?}", stated.findings);
    }
    let both = "test,bending\n\nlength K (1/cm),length M (gf·cm/cm),width K (1/cm),width M (gf·cm/cm)\n0,0,0,0\n1,0.1,1,0.05\n2,0.2,2,0.1\n";
    let directions: Vec<_> = read("a.csv", both).measurements.iter().map(|m| m.direction).collect();
    assert_eq!(directions, [Some(Direction::Warp), Some(Direction::Weft)]);
}

/// Lines of words over stacked records: numbers count them, words tell them apart.
#[test]
fn captions_tell_records_apart() {
    let folder = tempfile::tempdir().unwrap();
    for (captions, told) in [
        (["Cotton 120", "Wool 200"], true),
        (["dry", "wet"], true),
        (["Wool (dry)", "Wool (wet)"], true),
        (["Specimen 1", "Specimen 2"], false),
        (["31 Jan 2026 9:05 AM", "1 Feb 2026 1:10 PM"], false),
    ] {
        let record = |caption: &str| format!("\n{caption}\ncurvature (1/cm),moment (gf·cm/cm)\n{LOOP}");
        let text = format!("test,bending\ndirection,warp\n{}{}", record(captions[0]), record(captions[1]));
        std::fs::write(folder.path().join("lab.csv"), text).unwrap();
        let batch = read_fabrics(&[folder.path().into()], &ReadSettings::default(), &|_| ());
        let input: &FabricInput = &batch.fabrics[0];
        let codes: Vec<_> = input.findings.iter().map(|finding| finding.code()).collect();
        assert_eq!(input.measurements.len(), 2, "{captions:?}");
        assert_eq!(codes.contains(&"R127"), told, "{captions:?}: {codes:?}");
    }
}

/// Nobody can say whether a factor in words was applied.
/// A line over the headings that is a direction alone is that of the record below it.
#[test]
fn a_direction_above_a_record_is_its_own() {
    let record = "curvature (1/cm),moment (gf·cm/cm)\n0,0\n1,0.1\n2,0.2\n";
    for line in ["Weft direction", "** WEFT **", "Weft-1", "Weft", "緯"] {
        let found = read("a_warp.csv", &format!("{line}\n{record}"));
        assert_eq!(found.measurements[0].direction, Some(Direction::Weft), "{line}");
        assert_eq!(messages(&found, "R106").len(), 1, "{line}");
    }
    let two = read("a.csv", &format!("Warp\n{record}\nWeft\n{record}"));
    let directions: Vec<_> = two.measurements.iter().map(|m| m.direction).collect();
    assert_eq!(directions, [Some(Direction::Warp), Some(Direction::Weft)]);
}

/// Names that fill all cells over their columns are those of blocks.
#[test]
fn names_again_over_each_column_are_those_of_blocks() {
    let heads = "K (1/cm),M (gf·cm/cm),K (1/cm),M (gf·cm/cm)\n0,0,0,0\n1,0.1,1,0.2\n2,0.2,2,0.3\n";
    for names in ["Cotton,Cotton,Wool,Wool", "before,before,after,after", "Cotton,,Wool,"] {
        let found = read("a.csv", &format!("direction,warp\n{names}\n{heads}"));
        assert_eq!(messages(&found, "R119").len(), 1, "{names}");
    }
}

/// Files and records called after a mean, beside those of single specimens, are none.
#[test]
fn records_called_after_a_mean_are_left_out() {
    let heads = "K (1/cm),M (gf·cm/cm)\n0,0\n1,0.1\n2,0.2\n";
    for names in [["warp_1", "warp_2", "warp_mean"], ["F01_warp_1", "F01_warp_2", "F01_warp_Mittelwert"]] {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            std::fs::write(folder.path().join(format!("{name}.csv")), heads).unwrap();
        }
        let fabric = &read_fabrics(&[folder.path().into()], &ReadSettings::default(), &|_| ()).fabrics[0];
        let left_out = fabric.findings.iter().filter(|f| f.code() == "R110").count();
        assert_eq!((fabric.measurements.len(), left_out), (2, 1), "{names:?}");
    }
    let folder = tempfile::tempdir().unwrap();
    let captions = ["Specimen 1", "Specimen 2", "Mean"].map(|line| format!("{line}\n{heads}"));
    std::fs::write(folder.path().join("warp.csv"), captions.join("\n")).unwrap();
    let fabric = &read_fabrics(&[folder.path().into()], &ReadSettings::default(), &|_| ()).fabrics[0];
    assert_eq!(fabric.measurements.len(), 2, "{:?}", fabric.findings);
}

#[test]
fn factors_in_words_are_told_or_refused() {
    let record = |line: &str, heading: &str| {
        format!("test,bending\ndirection,warp\n{line}\n\ncurvature (1/cm),{heading} (gf·cm/cm)\n{LOOP}")
    };
    for line in
        ["moment values x 10", "Remark: moment divided by 2", "specimen,2 layers", "Number of strips: 2"]
    {
        assert_eq!(codes("lab.csv", &record(line, "moment")), ["R122"], "{line}");
    }
    assert!(codes("lab.csv", &record("size 20 x 20 cm, twill 2/2", "moment")).is_empty());
    for heading in ["moment of 2 strips", "moment/2", "moment x2", "half moment"] {
        assert_eq!(code(&record("", heading)), "R006", "{heading}");
    }
}

/// Numbers behind symbols that are other quantities, conditions without a unit, and raised figures of footnotes.
#[test]
fn numbers_that_are_no_values_of_a_parameter_are_left_out() {
    let values = |text: &str| -> Vec<(Parameter, f64)> {
        let found = read("results.csv", text).results;
        found.iter().map(|(_, r)| (r.parameter, r.mean / r.parameter.kes_factor())).collect()
    };
    let table = |rows: &str| format!("Parameter,Unit,Warp,Weft\nB,gf.cm2/cm,0.08,0.06\n{rows}\n");
    for rows in ["2HG3,gf/cm,0.8,0.7", "2HB (K=1.5),gf.cm/cm,0.04,0.03", "EMT50,%,1.2,2"] {
        assert!(values(&table(rows)).iter().all(|(p, _)| *p == Parameter::B), "{rows}");
        assert_eq!(codes("results.csv", &table(rows)), ["R104"], "{rows}");
    }
    let of_g = values(&table("G,gf/cm.deg,0.85,0.80\nG5,gf/cm.deg,0.65,0.60"));
    let of_g: Vec<f64> = of_g.iter().filter(|(p, _)| *p == Parameter::G).map(|(_, v)| *v).collect();
    assert!((of_g[0] - 0.85).abs() < 1e-12 && (of_g[1] - 0.8).abs() < 1e-12 && of_g.len() == 2, "{of_g:?}");
    let defined = values(&table("2HB (K=1),gf.cm/cm,0.04,0.03"));
    assert!(defined.iter().any(|(p, _)| *p == Parameter::Hb), "{defined:?}");
    let notes = values("Parameter;Wert;Einheit\nT0;0,5²;mm\nLT;0,7¹;-\n");
    assert!((notes[0].1 - 0.5).abs() < 1e-12 && (notes[1].1 - 0.7).abs() < 1e-12, "{notes:?}");
}

/// Titles of sections between the rows of a table, the first of them right below the headings; and zeros for what was not measured.
#[test]
fn titles_below_headings_and_zeros_are_no_values() {
    let table =
        "Property,Unit,Warp,Weft\nBending,,,\nB,gf.cm2/cm,0.08,0.06\nShear,,,\nG,gf/cm.deg,0.85,0.8\n";
    let found = read("results.csv", table).results;
    assert_eq!(found.len(), 4, "{found:?}");
    let zeros = "specimen,B warp (gf·cm²/cm),2HB warp (gf·cm/cm)\n1,0.08,0.03\n2,0,0\n3,0.10,0.05\n";
    let file = read("results.csv", zeros);
    let of = |p: Parameter| {
        file.results.iter().find(|(_, r)| r.parameter == p).map(|(_, r)| (r.n, r.mean / p.kes_factor()))
    };
    let (n, b) = of(Parameter::B).unwrap();
    assert!(n == 2 && (b - 0.09).abs() < 1e-12, "{n} {b}");
    let (n, hb) = of(Parameter::Hb).unwrap();
    assert!(n == 2 && (hb - 0.04).abs() < 1e-12, "{n} {hb}");
    let codes: Vec<_> = file.findings.iter().map(|finding| finding.code()).collect();
    assert_eq!(codes, ["R137"]);
}

/// Factors in a column of their own, and in the title of a table: told, and the values of the table are doubtful.
#[test]
fn factors_of_tables_are_told() {
    let rows = "B,gf.cm2/cm,0.853,0.612\n2HB,gf.cm/cm,0.34,0.25\n";
    let with_column = |factor: &str| {
        rows.lines()
            .map(|line| line.replacen(",0.", &format!(",{factor},0."), 1) + "\n")
            .fold("Parameter,Unit,Multiplier,Warp,Weft\n".to_string(), |text, line| text + &line)
    };
    for factor in ["10^-1", "0.1", "x10", "E-01"] {
        assert_eq!(codes("results.csv", &with_column(factor)), ["R122"], "{factor}");
    }
    for factor in ["1", "1.0", "10^0", "E+00", "-"] {
        assert!(codes("results.csv", &with_column(factor)).is_empty(), "{factor}");
    }
    for title in ["Bending results (values x 10)", "Note: B and 2HB multiplied by 10"] {
        let table = format!("{title}\nParameter,Unit,Warp,Weft\n{rows}");
        assert_eq!(codes("results.csv", &table), ["R122"], "{title}");
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("results.csv"), with_column("10^-1")).unwrap();
    let batch = read_fabrics(&[folder.path().into()], &ReadSettings::default(), &|_| ());
    let sheet = characterise(&batch.fabrics[0], &Settings::default());
    let of_b = sheet.statuses.iter().filter(|(key, _)| key.parameter == Parameter::B);
    let causes: Vec<_> = of_b.map(|(key, _)| sheet.causes(*key)).collect();
    assert_eq!(causes, [["R122"], ["R122"]]);
}

/// Angles to the warp are directions where each stands beside its partner.
#[test]
fn angles_to_the_warp_are_directions() {
    for [warp, weft] in [["0°", "90°"], ["0deg", "90deg"], ["B 0°", "B 90°"]] {
        let table = match warp.starts_with('B') {
            true => format!("fabric,{warp} (gf·cm²/cm),{weft} (gf·cm²/cm)\na,0.08,0.06\n"),
            false => format!("Parameter,Unit,{warp},{weft}\nB,gf·cm²/cm,0.08,0.06\n"),
        };
        let file = read("results.csv", &table);
        let directions: Vec<_> = file.results.iter().map(|(_, r)| r.direction).collect();
        assert_eq!(directions, [Some(Direction::Warp), Some(Direction::Weft)], "{warp}");
        assert_eq!(codes("results.csv", &table), ["R133"], "{warp}");
    }
}

/// A pressure beside a thickness says which thickness it is.
#[test]
fn a_condition_in_another_column_is_that_of_the_value() {
    let table = |method: &str| {
        format!("Property,Method,Unit,Value\nThickness,{method},mm,0.5\nMass,ISO 3801,g/m2,152\n")
    };
    let parameters = |method: &str| -> Vec<Parameter> {
        read("results.csv", &table(method)).results.iter().map(|(_, r)| r.parameter).collect()
    };
    assert_eq!(parameters("ISO 5084 (1 kPa)"), [Parameter::W]);
    assert_eq!(codes("results.csv", &table("ISO 5084 (1 kPa)")), ["R104"]);
    assert_eq!(parameters("KES-FB3 at 0.5 gf/cm²"), [Parameter::T0, Parameter::W]);
    assert_eq!(parameters("KES-FB3 at 50 gf/cm²"), [Parameter::Tm, Parameter::W]);
    assert_eq!(parameters("FB3 speed 20 mm/min"), [Parameter::T0, Parameter::W]);
}

/// A name that is across a direction states none; `not washed` behind a direction is a state of the cloth.
#[test]
fn names_across_a_direction_are_refused() {
    let record = format!("curvature (1/cm),moment (gf·cm/cm)\n{LOOP}");
    let table = format!("Specimen,{B}\n1,0.1\n2,0.2\n");
    let of = |name: &str, text: &str| read_as(name, text, &ReadSettings::default()).map_err(|e| e.code());
    for name in
        ["Uno_perpendicular to warp.csv", "Uno_senkrecht zur Kette.csv", "Uno normal to the warp yarns.csv"]
    {
        assert_eq!(of(name, &record).unwrap_err(), "R013", "{name}");
        assert_eq!(of(name, &table).unwrap_err(), "R013", "{name}");
        let stated = of(name, &format!("direction,weft\n\n{record}")).unwrap();
        assert_eq!(stated.measurements[0].direction, Some(Direction::Weft), "{name}");
    }
    for name in ["non-crimp_warp_1.csv", "Uno_warp_not washed.csv"] {
        let found = of(name, &record).unwrap();
        assert_eq!(found.measurements[0].direction, Some(Direction::Warp), "{name}");
    }
}

/// A direction above a table may be said in many words, as above a record; what is none is refused.
#[test]
fn directions_above_tables_are_those_of_their_values() {
    let down = "Parameter,Value,Unit\nB,0.1,gf·cm²/cm\n";
    let table = format!("Specimen,{B}\n1,0.1\n2,0.3\n");
    for (text, direction, more) in [
        ("Weft (filling)", Direction::Weft, false),
        ("Kette / warp", Direction::Warp, false),
        ("WARP DIR.", Direction::Warp, false),
        ("in the weft direction", Direction::Weft, false),
        ("タテ(経)", Direction::Warp, false),
        ("Urdume (Warp)", Direction::Warp, false),
        ("Warp (1)", Direction::Warp, false),
        ("Bias (45°)", Direction::Bias, false),
        ("warp before washing", Direction::Warp, true),
    ] {
        let told = if more { vec!["R125"] } else { vec![] };
        for file in [
            format!("Fabric,Uno\nDirection,{text}\n\n{down}"),
            format!("Direction: {text}\n{table}"),
            format!("Direction,{text}\nLoom,4\n\n{table}"),
        ] {
            let found = read("t.csv", &file);
            let directions: Vec<_> = of_b(&found).iter().map(|v| v.1).collect();
            assert_eq!(directions, [Some(direction)], "{file}");
            assert_eq!(codes("t.csv", &file), told, "{file}");
        }
    }
    let alone = read("t.csv", &format!("in the weft direction\n{table}"));
    assert_eq!(of_b(&alone), [(None, Some(Direction::Weft), 0.2, 2)]);
    for text in ["perpendicular to warp", "radial"] {
        assert_eq!(code(&format!("Fabric,Uno\nDirection,{text}\n\n{down}")), "R018", "{text}");
    }
    for text in ["all", "both", "warp and weft", "-"] {
        assert_eq!(
            of_b(&read("t.csv", &format!("Fabric,Uno\nDirection,{text}\n\n{down}"))),
            [(Some("Uno"), None, 0.1, 1)],
            "{text}"
        );
    }
}

/// Units of deviations are their own, a unit in a description may be that of a condition, and a number may stand before its parameter.
#[test]
fn rows_of_parameters_with_other_columns() {
    for head in ["CV (%)", "CV%", "COV (%)", "RSD (%)", "変動係数 (%)"] {
        let text = format!("Parameter,Direction,Unit,Mean,SD,{head}\nB,warp,gf·cm²/cm,0.1,0.01,10\n");
        let found = read("t.csv", &text);
        assert_eq!(of_b(&found), [(None, Some(Direction::Warp), 0.1, 1)], "{head}");
        assert_relative_eq!(found.results[0].1.sd.unwrap(), 0.01 * 9.80665e-5, max_relative = 1e-12);
        assert_eq!(messages(&found, "R104").len(), 1, "{head}: {:?}", found.findings);
    }
    for (rows, sd) in [("B,gf·cm²/cm,0.1,10\n", 0.01 * 9.80665e-5), ("EMT,%,4,10\n", 0.1)] {
        let found = read("t.csv", &format!("Parameter,Unit,Mean,SD (%)\n{rows}")).results;
        assert_relative_eq!(found[0].1.sd.unwrap(), sd, max_relative = 1e-12);
    }
    assert_eq!(code("Parameter,Unit,Mean,SD (N)\nB,gf·cm²/cm,0.1,10\n"), "R018");
    let specimens = "Fabric,Direction,Specimen,Parameter,Value,Unit\nUno,warp,1,B,0.1,gf·cm²/cm\nUno,warp,2,B,0.3,gf·cm²/cm\n";
    let found = read("t.csv", specimens);
    assert_eq!(of_b(&found), [(Some("Uno"), Some(Direction::Warp), 0.2, 2)]);
    assert!(found.findings.is_empty(), "{:?}", found.findings);
    let counted =
        read("t.csv", "Fabric,Direction,n,Parameter,Mean,SD,Unit\nUno,warp,5,B,0.1,0.02,gf·cm²/cm\n");
    assert_eq!(of_b(&counted), [(Some("Uno"), Some(Direction::Warp), 0.1, 5)]);
    let described = "Symbol,Description,Unit,Value\nW,Weight per unit area,mg/cm²,15\nT0,Fabric thickness at 0.5 gf/cm²,mm,0.5\n";
    let found = read("t.csv", described).results;
    let thickness: Vec<f64> =
        found.iter().filter(|(_, r)| r.parameter == Parameter::T0).map(|(_, r)| r.mean).collect();
    assert_eq!(thickness, [0.5e-3]);
}

/// Measured numbers under `Reference` and numbers of records name no fabric, where another column or line does.
#[test]
fn columns_of_names_that_name_no_fabric() {
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    let down = "Parameter,Unit,Warp,Weft,Reference\nEMT,%,4,9,4.62\nB,gf·cm²/cm,0.1,0.3,0.126\n";
    for (header, fabric) in [("Fabric,Uno\n\n", Some("Uno")), ("", None)] {
        let found = read("t.csv", &format!("{header}{down}"));
        assert_eq!(of_b(&found), [(fabric, warp, 0.1, 1), (fabric, weft, 0.3, 1)]);
        assert!(messages(&found, "R104")[0].contains("Reference"), "{:?}", found.findings);
    }
    let across = read(
        "t.csv",
        &format!("Fabric,Uno\nDirection,warp\n\nSpecimen,{B},Reference\n1,0.1,7.31\n2,0.3,7.35\n"),
    );
    assert_eq!(of_b(&across), [(Some("Uno"), warp, 0.2, 2)]);
    assert!(messages(&across, "R104")[0].contains("Reference"), "{:?}", across.findings);
    let records = "SampleID,Fabric,Component,Replicate,Result,Units\nS1,Uno,B_warp,1,0.1,gf·cm²/cm\nS2,Uno,B_warp,2,0.3,gf·cm²/cm\n";
    assert_eq!(of_b(&read("t.csv", records)), [(Some("Uno"), warp, 0.2, 2)]);
    // Without another name they are names.
    let names = read("t.csv", &format!("{B},Sample\n0.1,1.1\n0.3,1.2\n"));
    assert_eq!(of_b(&names), [(Some("1.1"), None, 0.1, 1), (Some("1.2"), None, 0.3, 1)]);
    let fabrics =
        read("t.csv", "ID,Material,Parameter,Value,Unit\nF1,Wool,B,0.1,gf·cm²/cm\nF2,Wool,B,0.3,gf·cm²/cm\n");
    assert_eq!(of_b(&fabrics), [(Some("F1"), None, 0.1, 1), (Some("F2"), None, 0.3, 1)]);
}

/// Names of files tell samples apart by numbers that count no specimens, and by words wherever they stand.
#[test]
fn samples_in_the_names_of_files_are_told() {
    let text = format!("curvature (1/cm),moment (gf·cm/cm)\n{LOOP}");
    let folder = tempfile::tempdir().unwrap();
    for (n, (files, told)) in [
        (["Style 501_warp", "Style 505_warp"], "Style-501, Style-505"),
        (["PES-100_warp_1", "PES-150_warp_1"], "PES-100, PES-150"),
        (["Lot 3_warp", "Lot 4_warp"], "Lot-3, Lot-4"),
        (["warp_Alpha", "warp_Beta"], "Alpha, Beta"),
        (["Uno_warp", "Uno_warp_washed"], "Uno, Uno washed"),
        (["Uno_1_warp", "Uno_2_warp"], ""),
        (["Uno_warp_2", "Uno_warp_3"], ""),
        (["Uno_1_warp", "Uno_2_weft"], ""),
        (["Uno_warp_a", "Uno_warp_b"], ""),
        (["Uno_2024-05-12_warp_1", "Uno_2024-05-13_warp_2"], ""),
    ]
    .into_iter()
    .enumerate()
    {
        let own = folder.path().join(n.to_string());
        std::fs::create_dir(&own).unwrap();
        for file in files {
            std::fs::write(own.join(format!("{file}.csv")), &text).unwrap();
        }
        let fabric = &read_fabrics(&[own], &ReadSettings::default(), &|_| ()).fabrics[0];
        let found = fabric.findings.iter().find(|finding| finding.code() == "R105");
        let message = found.map(|finding| finding.message()).unwrap_or_default();
        assert_eq!(message.contains(told) && !message.is_empty(), !told.is_empty(), "{files:?}: {message}");
    }
}

/// Among numbered specimens a label with a digit that is no number sums them up; and 試料番号 counts below the name of a sample.
#[test]
fn labels_among_numbered_specimens() {
    let warp = Some(Direction::Warp);
    for label in ["± 95 %", "U (k=2)", "P90", "25%", "σn-1", "3a"] {
        let text = format!("Fabric,Uno\nDirection,warp\n\nSpecimen,{B}\n1,0.1\n2,0.2\n3,0.3\n{label},0.9\n");
        let found = read("t.csv", &text);
        assert_eq!(of_b(&found), [(Some("Uno"), warp, 0.2, 3)], "{label}");
        assert!(messages(&found, "R110")[0].contains(label), "{label}: {:?}", found.findings);
    }
    let codes = read("t.csv", &format!("Direction,warp\n\nSpecimen,{B}\n1,0.1\n1a,0.2\n2,0.3\n2a,0.2\n"));
    assert_eq!(of_b(&codes), [(None, warp, 0.2, 4)]);
    let japanese = format!(
        "試料名,Alfa\n\nタテ\n試料番号,{B}\n1,0.1\n2,0.3\n平均,0.2\n\nヨコ\n試料番号,{B}\n1,0.4\n2,0.6\n"
    );
    let weft = Some(Direction::Weft);
    assert_eq!(of_b(&read("t.csv", &japanese)), [(Some("Alfa"), warp, 0.2, 2), (Some("Alfa"), weft, 0.5, 2)]);
    let fabrics = read("t.csv", &format!("試料番号,{B}\n1,0.1\n2,0.3\n"));
    assert_eq!(of_b(&fabrics), [(Some("1"), None, 0.1, 1), (Some("2"), None, 0.3, 1)]);
}

/// A milliradian is an angle, and no metre times a radian.
#[test]
fn angles_in_milliradians() {
    let text = "direction,warp\n\nAngle (mrad),Shear force (gf/cm)\n0,0\n50,1\n100,2\n";
    let curve = &read("t.csv", text).measurements[0].curve;
    assert_relative_eq!(curve.x[2], 0.1, max_relative = 1e-12);
}

/// Beside a column of values, columns with words that are not known are told, and are no fabrics.
#[test]
fn columns_beside_values_are_no_fabrics() {
    let warp = Some(Direction::Warp);
    for (head, row, left_out) in [
        ("Direction,Value,Unit,Population mean", "warp,0.1,gf·cm²/cm,0.14", "Population mean"),
        ("Direction,Measured,Unit,Population mean,Normalised", "warp,0.1,gf·cm²/cm,0.14,-1.5", "Normalised"),
        ("Direction,Result,Unit,U95", "warp,0.1,gf·cm²/cm,0.005", "U95"),
        ("Direction,KES unit,Value,SI unit,SI value", "warp,gf·cm²/cm,0.1,µN·m,9.8", "SI value"),
        ("Direction,Mean,Unit,Norm", "warp,0.1,gf·cm²/cm,0.005", "Norm"),
    ] {
        let found = read("t.csv", &format!("Fabric,Uno\n\nParameter,{head}\nB,{row}\n"));
        assert_eq!(of_b(&found), [(Some("Uno"), warp, 0.1, 1)], "{head}");
        assert!(messages(&found, "R104")[0].contains(left_out), "{head}: {:?}", found.findings);
    }
    let fabrics = read("t.csv", "Parameter,Unit,Uno,Due,Difference (%)\nB,gf·cm²/cm,0.1,0.3,19\n");
    assert_eq!(of_b(&fabrics), [(Some("Uno"), None, 0.1, 1), (Some("Due"), None, 0.3, 1)]);
    assert!(messages(&fabrics, "R104")[0].contains("Difference"), "{:?}", fabrics.findings);
}

/// A direction over the numbers of specimens, or over the names of parameters, is that of their values.
#[test]
fn directions_in_the_corner_of_a_table() {
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    let numbered =
        format!("Fabric,Alfa\n\nWarp,LC,{B}\n1,0.3,0.1\n2,0.3,0.3\n\nWeft,LC,{B}\n1,0.3,0.4\n2,0.3,0.6\n");
    let found = read("t.csv", &numbered);
    assert_eq!(of_b(&found), [(Some("Alfa"), warp, 0.2, 2), (Some("Alfa"), weft, 0.5, 2)]);
    assert!(messages(&found, "R132").is_empty(), "{:?}", found.findings);
    let down = read("t.csv", "Weft,1,2\nEMT (%),4,5\nB (gf·cm²/cm),0.1,0.3\n");
    assert_eq!(of_b(&down), [(None, weft, 0.2, 2)]);
    let width = read("t.csv", &format!("Specimen width,LC,{B}\n1,0.3,0.1\n2,0.3,0.3\n"));
    assert_eq!(of_b(&width)[0].1, None);
}

/// Rows of statistics and limits below fabrics are none; alone they may be, and that is told.
#[test]
fn rows_of_statistics_and_limits_below_fabrics() {
    let names = |below: &str| {
        let rows =
            format!("Sample,B warp (gf·cm²/cm),B weft (gf·cm²/cm)\nK1,0.11,0.06\nK2,0.13,0.07\n{below}");
        let found = read("t.csv", &rows);
        let warp = found.results.iter().filter(|(_, r)| r.direction == Some(Direction::Warp));
        let names: Vec<String> = warp.filter_map(|(fabric, _)| fabric.clone()).collect();
        (names.join(" "), ["R110", "R138"].map(|code| messages(&found, code).join(" ")))
    };
    for (below, left_out) in [
        ("Overall mean,0.12,0.065\nOverall SD,0.02,0.01\n", "Overall SD"),
        ("Lower limit,0.08,0.04\nUpper limit,0.15,0.09\n", "Upper limit"),
        ("Untergrenze,0.08,0.04\nObergrenze,0.15,0.09\n", "Obergrenze"),
    ] {
        let (found, [summed_up, kept]) = names(below);
        assert!(
            found == "K1 K2" && summed_up.contains(left_out) && kept.is_empty(),
            "{below}: {found} {kept}"
        );
    }
    for word in ["Max", "Median", "Uncertainty", "Lower limit", "Wool SD"] {
        let (found, [_, told]) = names(&format!("{word},0.14,0.08\n"));
        assert!(found == format!("K1 K2 {word}") && told.contains(word), "{word}: {found} {told}");
    }
}

/// Directions in the names of rows, in all the ways that laboratories have, and above the names of columns.
#[test]
fn directions_beside_the_names_of_fabrics() {
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    for [first, second] in [
        ["Uno warp direction", "Uno weft direction"],
        ["Uno in warp", "Uno in weft"],
        ["Uno sens chaîne", "Uno sens trame"],
        ["Uno warp-way", "Uno weft-way"],
        ["Uno (warp, 1)", "Uno (weft, 1)"],
        ["Uno warp 1", "Uno weft 1"],
    ] {
        let found = read("t.csv", &format!("Sample,LC,{B}\n\"{first}\",0.3,0.1\n\"{second}\",0.3,0.4\n"));
        assert_eq!(of_b(&found), [(Some("Uno"), warp, 0.1, 1), (Some("Uno"), weft, 0.4, 1)], "{first}");
        assert!(messages(&found, "R125").is_empty(), "{:?}", found.findings);
    }
    let four = "Uno warp 1,0.3,0.1\nUno warp 2,0.3,0.3\nUno weft 1,0.3,0.4\nUno weft 2,0.3,0.6\n";
    let found = read("t.csv", &format!("Sample,LC,{B}\n{four}"));
    assert_eq!(of_b(&found), [(Some("Uno"), warp, 0.2, 2), (Some("Uno"), weft, 0.5, 2)]);
    let others = read("t.csv", &format!("Sample,LC,{B}\nUno 1 (warp),0.3,0.1\nUno 2 (weft),0.3,0.4\n"));
    assert_eq!(of_b(&others), [(Some("Uno 1 (warp)"), warp, 0.1, 1), (Some("Uno 2 (weft)"), weft, 0.4, 1)]);
    assert_eq!(messages(&others, "R125").len(), 2, "{:?}", others.findings);
    let knits = read("t.csv", &format!("Sample,LC,{B}\nWarp knit A,0.3,0.1\nWarp knit B,0.3,0.4\n"));
    assert_eq!(of_b(&knits), [(Some("Warp knit A"), None, 0.1, 1), (Some("Warp knit B"), None, 0.4, 1)]);
    let groups =
        "Parameter,Warp,,,Weft,,\n,a,b,c,a,b,c\nEMT (%),4,5,6,7,8,9\nB (gf·cm²/cm),0.1,0.2,0.3,0.4,0.5,0.6\n";
    let content = read("t.csv", groups);
    let mut found = of_b(&content);
    found.sort_by(|a, b| a.2.total_cmp(&b.2));
    let names: Vec<_> =
        found.iter().map(|(fabric, direction, ..)| (fabric.unwrap_or("-"), *direction)).collect();
    let expected = [("a", warp), ("b", warp), ("c", warp), ("a", weft), ("b", weft), ("c", weft)];
    assert_eq!(names, expected);
}

/// Specimens with their mean below one direction and again below the other.
#[test]
fn numbered_specimens_and_their_mean_below_each_direction() {
    for mean in ["Mean", "Ave"] {
        let text = format!(
            "Parameter,Warp,,,Weft,,\n,1,2,{mean},1,2,{mean}\nEMT (%),4,5,4.5,6,7,6.5\nB (gf·cm²/cm),0.1,0.3,0.2,0.4,0.6,0.5\n"
        );
        let found = read("t.csv", &text);
        let expected = [(None, Some(Direction::Warp), 0.2, 2), (None, Some(Direction::Weft), 0.5, 2)];
        assert_eq!(of_b(&found), expected, "{mean}");
        assert!(messages(&found, "R110")[0].contains(mean), "{mean}: {:?}", found.findings);
    }
}

/// Rows at the head of a table without headings are told where their labels are not understood.
#[test]
fn rows_at_the_head_of_a_bare_table_are_told() {
    let rows = "RT - Elasticidade ao puxar (%);65.7\nEMT (%);3.2\nB (gf·cm²/cm);0.1\n";
    for head in [";Valor\n", ""] {
        let found = read("t.csv", &format!("{head}{rows}"));
        assert_eq!(of_b(&found), [(None, None, 0.1, 1)], "{head}");
        assert!(messages(&found, "R104")[0].contains("Elasticidade"), "{head}: {:?}", found.findings);
    }
    let apart = read("t.csv", &format!("Loom;4\n\n{}", rows.replacen("RT - Elasticidade ao puxar", "RT", 1)));
    assert!(messages(&apart, "R104").is_empty(), "{:?}", apart.findings);
}

/// Sides over directions keep the name of the fabric; masses of specimens are no areal densities; units as print has them.
#[test]
fn sides_masses_and_units_of_tables() {
    let sides = "Fabric,Uno\n\nParameter,Face,,Back,\n,Warp,Weft,Warp,Weft\nMIU,0.18,0.19,0.21,0.22\nSMD (µm),3.1,4.2,3.9,5.1\n";
    let found = read("t.csv", sides);
    let names: Vec<_> = found.results.iter().filter_map(|(fabric, _)| fabric.as_deref()).collect();
    assert!(names.contains(&"Uno Face") && names.contains(&"Uno Back"), "{names:?}");
    let masses = read(
        "t.csv",
        &format!("Fabric,Uno\nDirection,warp\n\nSpecimen,Weight (g),{B}\n1,5.31,0.1\n2,5.2,0.3\n"),
    );
    assert_eq!(of_b(&masses), [(Some("Uno"), Some(Direction::Warp), 0.2, 2)]);
    assert!(messages(&masses, "R104")[0].contains("Weight"), "{:?}", masses.findings);
    assert_eq!(code("Fabric,Weight (g)\nUno,5.3\n"), "R010");
    let area = read("t.csv", &format!("Fabric,Weight (gsm),{B}\nUno,132,0.1\n")).results;
    assert_relative_eq!(area[0].1.mean, 0.132, max_relative = 1e-12);
    let counted = read("t.csv", "Parameter,Direction,Unit,Mean (n=5),SD (n=5)\nB,warp,gf·cm²/cm,0.1,0.02\n");
    assert_eq!(of_b(&counted), [(None, Some(Direction::Warp), 0.1, 5)]);
    assert_relative_eq!(counted.results[0].1.sd.unwrap(), 0.02 * 9.80665e-5, max_relative = 1e-12);
    let friction = read("t.csv", "Direction,warp\n\nDistance (mm),MIU\n0,0.18\n0.2,0.19\n0.4,0.2\n");
    assert_eq!(friction.measurements[0].test, Test::Friction);
    assert_relative_eq!(friction.measurements[0].curve.x[2], 0.4e-3, max_relative = 1e-12);
    let record = "test,tensile\ndirection,warp\nBreite der Probe,10 cm\n\nextension (mm),load (gf)\n0,0\n0.5,100\n1,500\n";
    let content = read("t.csv", record);
    assert_relative_eq!(content.measurements[0].curve.y[2], 50.0 * 0.980665, max_relative = 1e-12);
}

/// A stated size is width by length of what is between the jaws, in the order that its key or the instrument says; where neither
/// does, nothing is taken of it. 400 gf over 20 cm are 20 gf/cm, over 10 cm 40 gf/cm.
#[test]
fn a_size_is_in_the_order_that_is_said() {
    let record = "extension (mm),load (gf)\n0,0\n0.5,100\n1,400\n";
    for (size, expected) in [
        ("Specimen size,20 x 5 cm", 20.0),
        ("Specimen size (W x L),20 x 5 cm", 20.0),
        ("Specimen size (cm),20 x 5", 20.0),
        ("Specimen size (L x W),5 x 20 cm", 20.0),
        ("Specimen size (length x width),10 x 20 cm", 20.0),
        ("Specimen size (L x W),50 mm x 100 mm", 40.0),
        ("Specimen size (W x L),10 x 20 cm", 40.0),
        ("Specimen size (L × B),5 × 10 cm", 40.0),
        // The jaws of KES-FB1 are 20 cm wide and 5 cm from each other.
        ("Specimen size,5 x 20 cm", 20.0),
        ("Specimen size,2.5 x 5 cm", 160.0),
    ] {
        let found = read("a.csv", &format!("test,tensile\ndirection,warp\n{size}\n\n{record}"));
        let last = found.measurements[0].curve.y[2];
        assert_relative_eq!(last, expected * 0.980665, max_relative = 1e-12);
        assert!(messages(&found, "R109").is_empty(), "{size}: {:?}", found.findings);
    }
    // Nobody says which number is the width: that of the instrument is assumed, and it is told.
    for size in ["10 x 20 cm", "5 x 10 cm"] {
        let text = format!("test,tensile\ndirection,warp\nSpecimen size,{size}\n\n{record}");
        let found = read("a.csv", &text);
        assert_relative_eq!(found.measurements[0].curve.y[2], 20.0 * 0.980665, max_relative = 1e-12);
        assert!(messages(&found, "R109").iter().all(|text| text.contains(size)), "{:?}", found.findings);
        assert_eq!(messages(&found, "R109").len(), 2, "the width and the distance of the jaws");
    }
}

/// A length of the specimen in a line of its own is the distance of the jaws only where it may be it. 1 mm over 5 cm is 2 %.
#[test]
fn a_length_of_the_cloth_is_not_the_distance_of_the_jaws() {
    let record = "extension (mm),load (gf/cm)\n0,0\n0.5,100\n1,400\n";
    for (lines, strain, told) in [
        ("Specimen length,20 cm\nSpecimen width,20 cm", 0.02, 1),
        ("Specimen length,20 cm", 0.02, 1),
        ("Probenlänge,20 cm\nProbenbreite,20 cm", 0.02, 1),
        ("Sample length,5 cm\nSpecimen width,5 cm", 0.02, 1),
        ("Specimen length,5 cm\nSpecimen width,20 cm", 0.02, 0),
        ("Specimen length,2.5 cm", 0.04, 0),
        ("Specimen length,20 cm\nGauge length,10 cm", 0.01, 0),
        ("Jaw distance,10 cm\nSpecimen length,20 cm", 0.01, 0),
    ] {
        let found = read("a.csv", &format!("test,tensile\ndirection,warp\n{lines}\n\n{record}"));
        assert_relative_eq!(found.measurements[0].curve.x[2], strain, max_relative = 1e-12);
        assert_eq!(messages(&found, "R109").len(), told, "{lines}: {:?}", found.findings);
        assert_eq!(messages(&found, "R118"), [""; 0], "{lines}");
    }
}

/// The peak that a program prints is no set maximum; a round number is one, in its own unit or in that of KES.
#[test]
fn a_printed_peak_is_no_set_maximum() {
    for (stated, peak, set) in [
        ("455 gf/cm", 455.0, 500.0),
        ("455.0 gf/cm", 455.2, 500.0),
        ("450 gf/cm", 450.0, 450.0),
        ("455 gf/cm", 480.0, 455.0),
        ("490.3 N/m", 499.96, 499.967),
        ("100 N/m", 101.972, 101.9716),
    ] {
        let text =
            format!("direction,warp\nMax load,{stated}\n\nstrain (%),force (gf/cm)\n0,0\n1,100\n2,{peak}\n");
        let maximum = read("a.csv", &text).measurements[0].conditions.maximum / 0.980665;
        assert_relative_eq!(maximum, set, max_relative = 1e-4);
    }
}

/// The difference of two thicknesses is none of them, whatever is written between the symbols.
#[test]
fn a_difference_of_thicknesses_is_no_thickness() {
    for heading in ["T0-Tm (mm)", "T0 - Tm (mm)", "(T0-Tm) mm", "T0 − Tm [mm]"] {
        let found = read("t.csv", &format!("Fabric,T0 (mm),{heading},{B}\nUno,0.61,0.2,0.1\n"));
        let thickness: Vec<_> =
            found.results.iter().map(|(_, v)| v.parameter).filter(|p| *p != Parameter::B).collect();
        assert_eq!(thickness, [Parameter::T0], "{heading}: {:?}", found.results);
        assert!(messages(&found, "R104")[0].contains("Tm"), "{heading}: {:?}", found.findings);
    }
    let named = read("t.csv", &format!("Fabric,thickness TM (mm),{B}\nUno,0.41,0.1\n"));
    assert!(named.results.iter().any(|(_, v)| v.parameter == Parameter::Tm), "{:?}", named.results);
}

/// `S` among fabrics is a fabric, and a deviation beside the mean; numbers below `Reference` are told.
#[test]
fn heads_of_one_letter_and_of_a_reference_over_values() {
    let fabrics = read("t.csv", "Parameter,Unit,P,T,S\nLT,-,0.65,0.61,0.68\nB,gf·cm²/cm,0.1,0.13,0.09\n");
    let names: Vec<_> =
        of_b(&fabrics).into_iter().map(|(name, ..)| name.unwrap_or("-").to_string()).collect();
    assert_eq!(names, ["P", "T", "S"]);
    let deviation = read("t.csv", "Parameter,Unit,Mean,S\nLT,-,0.65,0.02\nB,gf·cm²/cm,0.1,0.01\n");
    assert_eq!(of_b(&deviation), [(None, None, 0.1, 1)]);
    let reference =
        read("t.csv", "Parameter,Unit,Reference,Treated\nLT,-,0.65,0.61\nB,gf·cm²/cm,0.100,0.130\n");
    assert!(messages(&reference, "R104")[0].contains("Reference"), "{:?}", reference.findings);
    let whole = read("t.csv", "Parameter;Unit;Treated;Reference\nRT;%;55;54\nRC;%;50;49\n");
    assert!(messages(&whole, "R104")[0].contains("Reference"), "{:?}", whole.findings);
    // Numbers without a head are no fabric beside those with a name, whatever they count.
    let counted =
        read("t.csv", "Property;;Cotton;Wool\nLT;1;0.65;0.62\n;2;0.70;0.66\nRT (%);1;50;51\n;2;52;53\n");
    let names: Vec<_> = counted.results.iter().map(|(name, _)| name.as_deref()).collect();
    assert!(names.iter().all(|name| [Some("Cotton"), Some("Wool")].contains(name)), "{names:?}");
    assert!(messages(&counted, "R104")[0].contains("column 2"), "{:?}", counted.findings);
}

/// Rows are parameters, and the heads of columns hold a fabric or a state and a direction.
#[test]
fn heads_of_columns_with_a_fabric_and_a_direction() {
    let warp = Some(Direction::Warp);
    let weft = Some(Direction::Weft);
    for (heads, names) in [
        ("F1 warp,F1 weft,F2 warp,F2 weft", ["F1", "F2"]),
        ("Warp before,Weft before,Warp after,Weft after", ["before", "after"]),
        ("Control_warp,Control_weft,Treated_warp,Treated_weft", ["Control", "Treated"]),
        ("dry (warp),dry (weft),wet (warp),wet (weft)", ["dry", "wet"]),
        ("F1 経,F1 緯,F2 経,F2 緯", ["F1", "F2"]),
    ] {
        let text = format!(
            "Parameter,{heads}\nLT,0.65,0.70,0.62,0.66\n\"B, gf·cm²/cm\",0.1,0.08,0.12,0.09\nT0 (mm),0.7,,0.75,\n"
        );
        let found = read("t.csv", &text);
        let [one, two] = names.map(Some);
        let expected =
            [(one, warp, 0.1, 1), (one, weft, 0.08, 1), (two, warp, 0.12, 1), (two, weft, 0.09, 1)];
        assert_eq!(of_b(&found), expected, "{heads}");
        let of_fabric = |name| found.results.iter().filter(|(f, _)| f.as_deref() == name).count();
        assert_eq!([one, two].map(of_fabric), [5, 5], "{heads}");
    }
    // One fabric in one direction: the names stay, and the directions are taken.
    let found = read(
        "t.csv",
        "Parameter,F1 warp,F1 weft,F2 warp\nLT,0.65,0.70,0.62\n\"B, gf·cm²/cm\",0.1,0.08,0.12\n",
    );
    let expected =
        [(Some("F1 warp"), warp, 0.1, 1), (Some("F1 weft"), weft, 0.08, 1), (Some("F2 warp"), warp, 0.12, 1)];
    assert_eq!(of_b(&found), expected);
}

/// Means with their deviations in one cell, below heads that name one, the other or both.
#[test]
fn heads_of_means_with_deviations() {
    for head in [
        "\"B (SD), gf·cm²/cm\"",
        "B mean ± SD (gf·cm²/cm)",
        "\"B (gf·cm²/cm), mean ± SD\"",
        "B ± SD (gf·cm²/cm)",
        "B (mean ± SD) (gf·cm²/cm)",
        "B (SD) [gf·cm²/cm]",
    ] {
        for cell in ["0.1 (0.01)", "0.1 ± 0.01"] {
            let found = read("t.csv", &format!("Fabric,{head},LT\nUno,{cell},0.6\nDos,{cell},0.7\n"));
            assert_eq!(of_b(&found), [(Some("Uno"), None, 0.1, 1), (Some("Dos"), None, 0.1, 1)], "{head}");
            let b = found.results.iter().find(|(_, r)| r.parameter == Parameter::B).unwrap();
            assert_relative_eq!(b.1.sd.unwrap(), 0.01 * 9.80665e-5, max_relative = 1e-12);
        }
    }
    // Deviations behind each value; such without a value are told.
    let pairs = read("t.csv", &format!("Fabric,{B} warp,SD,{B} weft,SD\nUno,0.1,0.01,0.2,0.03\n"));
    let deviations: Vec<f64> = pairs.results.iter().map(|(_, r)| r.sd.unwrap() / 9.80665e-5).collect();
    assert_relative_eq!(deviations[..], [0.01, 0.03][..], max_relative = 1e-12);
    let alone = read("t.csv", &format!("Fabric,{B},LT (SD)\nUno,0.1,0.02\nDos,0.2,0.03\n"));
    assert_eq!(alone.results.len(), 2);
    assert!(messages(&alone, "R104")[0].contains("LT (SD)"), "{:?}", alone.findings);
    let means = read(
        "t.csv",
        &format!("Fabric,{B} mean,SD,LT mean,SD\nUno,0.1,0.01,0.6,0.02\nDos,0.2,0.01,0.7,0.02\n"),
    );
    assert!(means.results.iter().all(|(_, r)| r.sd.is_some()), "{:?}", means.results);
    // A standard error, per cent of the mean, and what is negative.
    for head in
        ["B mean ± SE (gf·cm²/cm)", "B (gf·cm²/cm) mean (CV%)", "B, mean ± standard error (gf·cm²/cm)"]
    {
        let found = read("t.csv", &format!("Fabric,\"{head}\",LT\nUno,0.1 ± 0.01,0.6\nDos,0.2 ± 0.02,0.7\n"));
        assert_eq!(of_b(&found).len(), 2, "{head}: {:?}", found.findings);
        assert!(found.results.iter().all(|(_, r)| r.sd.is_none()), "{head}: {:?}", found.results);
        assert_eq!(messages(&found, "R139").len(), 1, "{head}: {:?}", found.findings);
    }
    let stated = read(
        "t.csv",
        &format!(
            "Means with standard deviations in brackets, CV below 5 %\nFabric,{B},LT\nUno,0.1 (0.01),0.6\nDos,0.2 (0.01),0.7\n"
        ),
    );
    assert_eq!((messages(&stated, "R139").len(), of_b(&stated).len()), (0, 2));
    let relative = read("t.csv", &format!("Fabric,{B},SD (%)\nUno,0.1,3\nDos,0.2,4\n"));
    assert!(messages(&relative, "R104")[0].contains("SD (%)"), "{:?}", relative.findings);
    assert_eq!(code("parameter,mean,sd,n,unit\nB,0.1,-0.01,3,gf·cm²/cm\nLT,0.6,0.01,3,-\n"), "R018");
    // Per cent and values of the other direction are no deviations.
    for (title, cell) in
        [("Mean and CV% (in brackets)\n", "0.1 (0.04)"), ("", "0.1 (4.2)"), ("", "0.1 (0.09)")]
    {
        let found = read("t.csv", &format!("{title}Fabric,{B},LT\nUno,{cell},0.6\nDos,0.1 (0.01),0.7\n"));
        assert!(found.results.iter().all(|(_, r)| r.sd.is_none()), "{cell}: {:?}", found.results);
        assert_eq!(messages(&found, "R139").len(), 1, "{cell}: {:?}", found.findings);
    }
}

/// A title behind the sections of directions ends them, sums them up or comes again in each.
#[test]
fn titles_that_are_no_directions() {
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    let directed = [(Some("Uno"), warp, 0.1, 1), (Some("Uno"), weft, 0.2, 1)];
    for (behind, none, told) in [
        ("Surface\nUno,0.3\n", true, "R136"),
        ("Mean\nUno,0.15\n", false, "R110"),
        ("Warp and weft\nUno,0.15\n", false, "R110"),
    ] {
        let found = read("t.csv", &format!("Fabric,{B}\nWarp\nUno,0.1\nWeft\nUno,0.2\n{behind}"));
        let expected: Vec<_> =
            directed.iter().copied().chain(none.then_some((Some("Uno"), None, 0.3, 1))).collect();
        assert_eq!(of_b(&found), expected, "{behind}");
        assert_eq!(messages(&found, told).len(), 1, "{behind}: {:?}", found.findings);
    }
    let nested = "Parameter,Uno\nWarp\nTensile\nLT,0.6\nBending\nB (gf·cm²/cm),0.1\nWeft\nTensile\nLT,0.7\nBending\nB (gf·cm²/cm),0.2\n";
    assert_eq!(of_b(&read("t.csv", nested)).iter().map(|b| b.1).collect::<Vec<_>>(), [warp, weft]);
    // Groups of fabrics whose names come again, and fabrics over parameters that do.
    let groups = read(
        "t.csv",
        &format!("Treatment,{B},LT\nCotton\nRaw,0.1,0.6\nSoft,0.2,0.6\nPES\nRaw,0.3,0.6\nSoft,0.4,0.6\n"),
    );
    let names: Vec<_> = of_b(&groups).into_iter().map(|b| b.0.unwrap_or("-").to_string()).collect();
    assert_eq!(names, ["Cotton Raw", "Cotton Soft", "PES Raw", "PES Soft"]);
    let down = read(
        "t.csv",
        "Parameter,Warp,Weft\nCotton\nB (gf·cm²/cm),0.1,0.2\nLT,0.6,0.7\nWool\nB (gf·cm²/cm),0.3,0.4\nLT,0.6,0.7\n",
    );
    let expected = [
        (Some("Cotton"), warp, 0.1, 1),
        (Some("Cotton"), weft, 0.2, 1),
        (Some("Wool"), warp, 0.3, 1),
        (Some("Wool"), weft, 0.4, 1),
    ];
    assert_eq!(of_b(&down), expected);
}

/// Heads over several columns end where the others of their row do.
#[test]
fn heads_over_columns_reach_equally_far() {
    for over in ["Fabric,Warp,,Weft,,,", "Fabric,Warp,Warp,Weft,Weft,,"] {
        let found = read("t.csv", &format!("{over}\n,{B},LT,{B},LT,MIU,MMD\nUno,0.1,0.6,0.2,0.7,0.2,0.02\n"));
        let of_miu = found.results.iter().filter(|(_, r)| r.parameter == Parameter::Miu);
        assert_eq!(of_miu.map(|(_, r)| r.direction).collect::<Vec<_>>(), [None], "{over}");
        assert_eq!(
            of_b(&found).iter().map(|b| b.1).collect::<Vec<_>>(),
            [Some(Direction::Warp), Some(Direction::Weft)]
        );
    }
}

/// Numbers that may be those of fabrics are told, those beside numbers of specimens are names, and a quantity counts nothing.
#[test]
fn numbers_of_samples_and_of_specimens() {
    for (head, told) in
        [("Sample No.", 1), ("No.", 1), ("#", 1), ("编号", 1), ("Specimen", 0), ("Test No.", 0)]
    {
        let found = read("t.csv", &format!("{head},{B},LT\n1,0.1,0.6\n2,0.2,0.7\n3,0.3,0.8\n"));
        assert_eq!(of_b(&found), [(None, None, 0.2, 3)], "{head}");
        assert_eq!(messages(&found, "R132").len(), told, "{head}: {:?}", found.findings);
    }
    let both = read(
        "t.csv",
        &format!("Sample No.,Rep,{B},LT\n1,1,0.1,0.6\n1,2,0.2,0.6\n2,1,0.3,0.7\n2,2,0.4,0.7\n"),
    );
    assert_eq!(of_b(&both), [(Some("1"), None, 0.15, 2), (Some("2"), None, 0.35, 2)]);
    let over = read("t.csv", "Parameter,1,2,3\nLT,0.6,0.7,0.8\nB (gf·cm²/cm),0.1,0.2,0.3\n");
    assert_eq!((of_b(&over), messages(&over, "R132").len()), (vec![(None, None, 0.2, 3)], 1));
    for states in [["0 %", "2 %"], ["20/cm", "24/cm"], ["0 washes", "5 washes"]] {
        let rows: String = states.iter().map(|state| format!("Uno,{state},0.1,0.6\n")).collect();
        let found = read("t.csv", &format!("Fabric,Setting,{B},LT\n{rows}"));
        assert_eq!(messages(&found, "R126").len(), 1, "{states:?}: {:?}", found.findings);
    }
    // Numbered columns below the name of a fabric are its specimens.
    let tests = "Sample: Poplin\nDirection: warp\n\nParameter;Test 1;Test 2;Mean\nLT;0.6;0.7;0.65\nB (gf·cm²/cm);0.1;0.2;0.15\n";
    for text in [tests.to_string(), tests.replace("Test 1", "Forward").replace("Test 2", "Backward")] {
        let found = read("t.csv", &text);
        assert_eq!(of_b(&found), [(Some("Poplin"), Some(Direction::Warp), 0.15, 2)], "{text}");
        assert_eq!(messages(&found, "R132").len(), 1, "{:?}", found.findings);
    }
}

/// Directions in merged cells and names, values of the whole fabric, and columns that are made of others.
#[test]
fn directions_and_other_columns_over_parameters() {
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    let merged =
        "Direction,Parameter,Uno\nWarp,LT,0.6\n,B (gf·cm²/cm),0.1\nWeft,LT,0.7\n,B (gf·cm²/cm),0.2\n";
    assert_eq!(of_b(&read("t.csv", merged)), [(Some("Uno"), warp, 0.1, 1), (Some("Uno"), weft, 0.2, 1)]);
    let names = read(
        "t.csv",
        &format!("Fabric,{B},LT\nA warp,0.1,0.6\nA weft,0.2,0.7\nA mean,0.15,0.65\nC warp,0.3,0.6\n"),
    );
    assert_eq!(
        of_b(&names),
        [(Some("A"), warp, 0.1, 1), (Some("A"), weft, 0.2, 1), (Some("C"), warp, 0.3, 1)]
    );
    let whole =
        read("t.csv", "Parameter,Warp,Weft,Fabric\nB (gf·cm²/cm),0.1,0.2,\nT0 (mm),,,0.6\nW (g/m2),,,120\n");
    assert_eq!((whole.results.len(), of_b(&whole).len()), (4, 2));
    for change in ["% change", "Difference", "Δ", "Change", "Veränderung", "变化率"] {
        let text = format!("Parameter;Unit;Raw;Soft;{change}\nLT;-;0.6;0.7;0.1\nB;gf·cm²/cm;0.1;0.2;0.3\n");
        let found = read("t.csv", &text);
        assert_eq!(of_b(&found), [(Some("Raw"), None, 0.1, 1), (Some("Soft"), None, 0.2, 1)], "{change}");
        assert!(messages(&found, "R104").len() + messages(&found, "R110").len() == 1, "{:?}", found.findings);
    }
    let captioned =
        read("t.csv", &format!("Table 3. Properties in weft direction\nFabric,{B},LT\nUno,0.1,0.6\n"));
    assert_eq!(of_b(&captioned), [(Some("Uno"), weft, 0.1, 1)]);
    assert_eq!(messages(&captioned, "R125").len(), 1);
    // Long tables whose rows say by which statistic they sum up, and quartiles of `describe`.
    let long = "sample,direction,property,statistic,value,unit\nUno,warp,B,min,0.05,gf·cm²/cm\nUno,warp,B,mean,0.1,gf·cm²/cm\nUno,warp,B,sd,0.02,gf·cm²/cm\n";
    let found = read("t.csv", long);
    assert_eq!(of_b(&found), [(Some("Uno"), warp, 0.1, 1)]);
    assert_relative_eq!(found.results[0].1.sd.unwrap(), 0.02 * 9.80665e-5, max_relative = 1e-12);
    let described = read(
        "t.csv",
        &format!(
            ",LT,{B}\ncount,5,5\nmean,0.6,0.1\nstd,0.05,0.02\nmin,0.5,0.07\n25%,0.55,0.08\n50%,0.6,0.09\n75%,0.65,0.11\nmax,0.7,0.13\n"
        ),
    );
    assert_eq!(of_b(&described), [(None, None, 0.1, 1)]);
}

/// The folders of a fabric that are named after the tests are not fabrics.
#[test]
fn folders_of_tests_below_a_fabric() {
    let folder = tempfile::tempdir().unwrap();
    for (test, parameter) in
        [("bending", "B (gf·cm²/cm)"), ("shear", "G (gf/(cm·deg))"), ("KES-FB1", "RT (%)")]
    {
        let inner = folder.path().join("cupro").join(test);
        std::fs::create_dir_all(&inner).unwrap();
        std::fs::write(inner.join("t.csv"), format!("Direction,{parameter},n\nwarp,0.5,3\n")).unwrap();
    }
    let batch = read_fabrics(&[folder.path().into()], &ReadSettings::default(), &|_| ());
    assert_eq!(
        batch.fabrics.iter().map(|f| (f.name.as_str(), f.results.len())).collect::<Vec<_>>(),
        [("cupro", 3)]
    );
    // Folders of fabrics below those of tests stay apart.
    let folder = tempfile::tempdir().unwrap();
    for inner in ["bending/uno", "bending/dos", "shear/tres"] {
        let inner = folder.path().join(inner);
        std::fs::create_dir_all(&inner).unwrap();
        std::fs::write(inner.join("t.csv"), "Direction,RT (%),n\nwarp,50,3\n").unwrap();
    }
    let batch = read_fabrics(&[folder.path().into()], &ReadSettings::default(), &|_| ());
    assert_eq!(batch.fabrics.len(), 3);
}

/// States of the fabrics of the rows over the same parameters.
#[test]
fn states_over_columns_of_parameters() {
    for heads in ["Fabric,Raw,,Soft,\n,", ",Raw,,Soft,\nFabric,", ",Raw,Raw,Soft,Soft\nFabric,"] {
        let found =
            read("t.csv", &format!("{heads}{B},LT,{B},LT\nUno,0.1,0.6,0.2,0.7\nDos,0.3,0.6,0.4,0.7\n"));
        let names = ["Uno Raw", "Uno Soft", "Dos Raw", "Dos Soft"];
        let expected: Vec<_> =
            names.into_iter().zip([0.1, 0.2, 0.3, 0.4]).map(|(f, b)| (Some(f), None, b, 1)).collect();
        assert_eq!(of_b(&found), expected, "{heads}");
    }
}

/// `sample,Poplin, white`: commas in the name of the only curve of a file are a part of it.
#[test]
fn commas_in_the_name_of_a_sample() {
    let text = "sample,Poplin, white, lot 3\ntest,tensile\ndirection,warp\n\nstrain (%),force (gf/cm)\n0,0\n1,10\n2,50\n";
    assert_eq!(read("a.csv", text).measurements[0].sample.as_deref(), Some("Poplin, white, lot 3"));
}

/// Tables between bars, as Markdown has them, and in columns of blanks.
#[test]
fn tables_between_bars_and_in_columns_of_blanks() {
    let expected =
        [(Some("Uno"), Some(Direction::Warp), 0.1, 1), (Some("Dos"), Some(Direction::Warp), 0.2, 1)];
    let bars =
        format!("| Fabric | {B} warp | LT warp |\n|---|---|---|\n| Uno | 0.1 | 0.6 |\n| Dos | 0.2 | 0.7 |\n");
    assert_eq!(of_b(&read("t.md.txt", &bars)), expected);
    assert_eq!(
        of_b(&read(
            "t.txt",
            &bars
                .replace(" |\n", "\n")
                .replace("| F", "F")
                .replace("| U", "U")
                .replace("| D", "D")
                .replace("|---|---|---|\n", "")
        )),
        expected
    );
    let blanks = format!(
        "Fabric   {B} warp   LT warp\nUno      0.1                  0.6\nDos      0.2                  0.7\n"
    );
    assert_eq!(of_b(&read("t.txt", &blanks)), expected);
}
