//! What workbooks show beside the values of cells, names of their sheets, and texts of another code page.
//!
//! Kind: analytical. 1 gf = 9.80665e-3 N exactly, so 0.1 gf·cm²/cm = 9.80665e-6 N·m. `formats.xls` was written by xlwt: number
//! formats with units and per cent, a hidden row and column, a row that is struck out.

use std::path::Path;

use approx::assert_relative_eq;
use kesf::instrument::{Direction, FileContent, Parameter, ReadError, ReadSettings, parse};
use rust_xlsxwriter::{Format, Workbook};

use crate::content::{findings_of, value};

const WARP: Option<Direction> = Some(Direction::Warp);
const WEFT: Option<Direction> = Some(Direction::Weft);
/// 0.1 gf·cm²/cm.
const TENTH: f64 = 9.80665e-6;

#[derive(Clone, Copy)]
enum Cell<'t> {
    Text(&'t str),
    Number(f64),
    Shown(f64, &'t str),
}

use Cell::{Number, Shown, Text};

fn read(name: &str, bytes: &[u8]) -> Result<FileContent, ReadError> {
    parse(Path::new(name), bytes, &ReadSettings::default())
}

fn book(sheets: &[(&str, Vec<Vec<Cell<'_>>>)]) -> Vec<u8> {
    let mut book = Workbook::new();
    for (name, rows) in sheets {
        let sheet = book.add_worksheet();
        sheet.set_name(*name).unwrap();
        for (r, row) in (0..).zip(rows) {
            for (c, cell) in (0..).zip(row) {
                match cell {
                    Text("") => {}
                    Text(text) => drop(sheet.write_string(r, c, *text).unwrap()),
                    Number(n) => drop(sheet.write_number(r, c, *n).unwrap()),
                    Shown(n, code) => {
                        let format = Format::new().set_num_format(*code);
                        sheet.write_number_with_format(r, c, *n, &format).unwrap();
                    }
                }
            }
        }
    }
    book.save_to_buffer().unwrap()
}

fn table(b: [&str; 2], head: &str) -> Vec<u8> {
    book(&[(
        "results",
        vec![
            vec![Text("Fabric"), Text("Direction"), Text(head), Text("EMT"), Text("T0")],
            vec![
                Text("P"),
                Text("warp"),
                Shown(0.1, b[0]),
                Shown(0.042, "0.0%"),
                Shown(0.31, "0.00\\ \\m\\m"),
            ],
            vec![Text("P"), Text("weft"), Shown(0.2, b[1]), Shown(7.1, "0.0\"%\""), Text("")],
        ],
    )])
}

#[test]
fn units_of_number_formats_are_units_of_their_cells() {
    for code in ["0.000\" gf·cm²/cm\"", "General\" gf.cm2/cm\"", "0.000\\ [$gf·cm²/cm];-0.0"] {
        for head in ["B", "B (gf·cm²/cm)"] {
            let content = read("a.xlsx", &table([code; 2], head)).unwrap_or_else(|e| panic!("{code}: {e}"));
            assert_relative_eq!(value(&content, Parameter::B, WARP), TENTH, max_relative = 1e-12);
            assert_relative_eq!(value(&content, Parameter::B, WEFT), 2.0 * TENTH, max_relative = 1e-12);
            // Per cent that the format multiplies, and per cent that it only writes.
            assert_relative_eq!(value(&content, Parameter::Emt, WARP), 0.042, max_relative = 1e-12);
            assert_relative_eq!(value(&content, Parameter::Emt, WEFT), 0.071, max_relative = 1e-12);
            assert_relative_eq!(value(&content, Parameter::T0, None), 0.31e-3, max_relative = 1e-12);
            let finding = findings_of(&content, "R134");
            assert!(finding.contains("\"mm\" in cell E2 of sheet \"results\""), "{finding}");
        }
    }
}

#[test]
fn a_format_that_divides_by_a_thousand_shows_another_number() {
    let rows = vec![
        vec![Text("Fabric"), Text("T0"), Text("LC")],
        vec![Text("P"), Shown(310.0, "0.00,\" mm\""), Number(0.4)],
        vec![Text("Q"), Shown(520.0, "0.00,\" mm\""), Number(0.4)],
    ];
    let content = read("a.xlsx", &book(&[("results", rows)])).unwrap();
    assert_relative_eq!(content.results[0].1.mean, 0.31e-3, max_relative = 1e-12);
}

#[test]
fn units_of_formats_and_headings_that_differ_are_a_conflict() {
    for (formats, head) in [
        (["0.000\" N·m\""; 2], "B (gf·cm²/cm)"),
        (["0.000\" mm\""; 2], "B (gf·cm²/cm)"),
        (["0.000\" gf/foo\""; 2], "B"),
    ] {
        let error = read("a.xlsx", &table(formats, head)).unwrap_err().to_string();
        assert!(error.contains("unit"), "{error}");
    }
}

#[test]
fn curves_take_the_units_of_their_cells() {
    let rise = |i: usize| (0.1 * i as f64, 0.01 * i as f64);
    let mut rows =
        vec![vec![Text("Direction"), Text("warp")], vec![Text("Curvature"), Text("Moment (gf·cm/cm)")]];
    rows.extend(
        (0..20).map(rise).map(|(k, m)| vec![Shown(k, "0.000\" 1/cm\""), Shown(m, "0.00\" gf·cm/cm\"")]),
    );
    let content = read("a.xlsx", &book(&[("FB2", rows)])).unwrap();
    let curve = &content.measurements[0].curve;
    assert_relative_eq!(curve.x[10], 100.0, max_relative = 1e-12);
    assert_relative_eq!(curve.y[10], 0.1 * 9.80665e-3, max_relative = 1e-12);

    let text = |unit: &str| {
        let lines: String = (0..20).map(rise).map(|(a, f)| format!("{a:.2} °;{f:.3} {unit}\n")).collect();
        format!("Test;Shear\nDirection;warp\nAngle;Shear force (gf/cm)\n{lines}")
    };
    let content = read("a.csv", text("gf/cm").as_bytes()).unwrap();
    let curve = &content.measurements[0].curve;
    assert_relative_eq!(curve.x[10], 1f64.to_radians(), max_relative = 1e-12);
    assert_relative_eq!(curve.y[10], 0.1 * 0.980665, max_relative = 1e-12);
    let error = read("a.csv", text("N/m").as_bytes()).unwrap_err().to_string();
    assert!(error.starts_with("a.csv:4:8") && error.contains("gf/cm") && error.contains("N/m"), "{error}");
}

#[test]
fn an_old_workbook_shows_the_same() {
    let content = read("formats.xls", include_bytes!("../workbooks/formats.xls")).unwrap();
    assert_relative_eq!(value(&content, Parameter::B, WARP), 0.81 * TENTH, max_relative = 1e-12);
    assert_relative_eq!(value(&content, Parameter::B, WEFT), 0.5 * TENTH, max_relative = 1e-12);
    assert_relative_eq!(value(&content, Parameter::Emt, WARP), 0.042, max_relative = 1e-12);
    assert_relative_eq!(value(&content, Parameter::Emt, WEFT), 0.071, max_relative = 1e-12);
    let hidden = findings_of(&content, "R113");
    for what in ["row 3", "column 6", "cells C5, D5, struck out"] {
        assert!(hidden.contains(what), "{hidden}");
    }
    assert!(!content.results.iter().any(|(_, r)| r.parameter == Parameter::G));
}

#[test]
fn sheets_that_are_named_by_letters_are_of_these_directions() {
    let rows = |b: f64| {
        vec![
            vec![Text("Specimen"), Text("B (gf·cm²/cm)")],
            vec![Number(1.0), Number(b)],
            vec![Number(2.0), Number(b)],
        ]
    };
    for (warp, weft) in [("L", "T"), ("K", "S"), ("O", "T"), ("Ç", "A"), ("silk O", "silk T"), ("K1", "S1")]
    {
        let content = read("a.xlsx", &book(&[(warp, rows(0.1)), (weft, rows(0.2))])).unwrap();
        assert_relative_eq!(value(&content, Parameter::B, WARP), TENTH, max_relative = 1e-12);
        assert_relative_eq!(value(&content, Parameter::B, WEFT), 2.0 * TENTH, max_relative = 1e-12);
        assert!(
            findings_of(&content, "R133").contains(&format!("{warp:?}, {weft:?}")),
            "{}",
            findings_of(&content, "R133")
        );
    }
    let curve: Vec<_> = (0..9).map(|i| vec![Number(f64::from(i)), Number(0.1 * f64::from(i))]).collect();
    let record = |name| (name, [vec![vec![Text("K (1/cm)"), Text("M (gf·cm/cm)")]], curve.clone()].concat());
    let content = read("a.xlsx", &book(&[record("K"), record("S")])).unwrap();
    assert_eq!(content.measurements.iter().map(|m| m.direction).collect::<Vec<_>>(), [WARP, WEFT]);
    assert!(findings_of(&content, "R105").is_empty());
    // Without its partner a letter is a name; so are numbers and letters of two languages.
    for (one, other) in [("L", "M"), ("1", "2"), ("K", "T"), ("L a", "T b")] {
        let content = read("a.xlsx", &book(&[(one, rows(0.1)), (other, rows(0.2))])).unwrap();
        assert!(content.results.iter().all(|(_, r)| r.direction.is_none()), "{one} {other}");
        assert!(findings_of(&content, "R133").is_empty());
    }
}

#[test]
fn a_sheet_against_its_name_is_told() {
    let rows = |b: f64, d: &'static str| {
        vec![
            vec![Text("Specimen"), Text("Direction"), Text("B (gf·cm²/cm)")],
            vec![Number(1.0), Text(d), Number(b)],
            vec![Number(2.0), Text(d), Number(b)],
        ]
    };
    let content = read("a.xlsx", &book(&[("L", rows(0.1, "warp")), ("T", rows(0.2, "warp"))])).unwrap();
    let finding = findings_of(&content, "R106");
    assert!(finding.contains("a.xlsx[T]") && !finding.contains("a.xlsx[L]"), "{finding}");
}

#[test]
fn a_unit_decides_the_code_page_that_was_mistaken() {
    let table = |unit: &str| format!("Fabric,Direction,G ({unit}),2HG (gf/cm)\nP,warp,1,1.1\nP,weft,0.9,1\n");
    let factor = 0.980665 * 180.0 / std::f64::consts::PI;
    for unit in ["gf/cmø", "gf/cmúø", "gf/cm░", "gf/cmÂ°", "gf/cmÂ·Â°", "gf/cm¡"] {
        let content = read("a.csv", table(unit).as_bytes());
        let Ok(content) = content else { panic!("{unit}: {content:?}") };
        assert_relative_eq!(value(&content, Parameter::G, WARP), factor, max_relative = 1e-12);
        assert!(findings_of(&content, "R135").contains(unit), "{}", findings_of(&content, "R135"));
    }
    for unit in ["gf/cmé", "gf/cmß"] {
        assert!(read("a.csv", table(unit).as_bytes()).is_err(), "{unit}");
    }
}
