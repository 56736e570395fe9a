//! Cells, heads and lines with more in them than a number or a name: units, marks, letters of directions, what is not understood.
//!
//! Kind: analytical. 1 gf = 9.80665e-3 N exactly and 1 in = 0.0254 m exactly, so 0.1 gf·cm²/cm = 9.80665e-6 N·m.

use std::path::Path;

use approx::assert_relative_eq;
use kesf::instrument::{Direction, FileContent, Parameter, ReadError, ReadSettings, parse};

use crate::content::{findings_of, value};

fn read(text: &[u8]) -> Result<FileContent, ReadError> {
    parse(Path::new("lab.csv"), text, &ReadSettings::default())
}

const WARP: Option<Direction> = Some(Direction::Warp);
const WEFT: Option<Direction> = Some(Direction::Weft);
/// 0.1 gf·cm²/cm.
const TENTH: f64 = 9.80665e-6;

#[test]
fn values_are_read_with_the_unit_of_their_cell() {
    for text in [
        "Parameter,Warp,Weft\nB,0.1 gf.cm2/cm,0.2 gf·cm²/cm\nRT,52 %,51%\n",
        "Parameter;Warp;Weft\nB;0,1 gf.cm2/cm;0,2 gf·cm²/cm\nRT;52,0 %;%51\n",
        "Parameter,Warp,Weft\nB (gf·cm²/cm),0.1 gf.cm2/cm,0.2\nRT,52 % ± 3 %,51%*\n",
        "Sample,Direction,B,RT\nF,warp,9.80665 µN·m,52 %\nF,weft,0.2 gf.cm2/cm (0.01),51 %\n",
        "Warp\nB = 0.1 gf.cm2/cm\nRT: 52 %\nWeft\nB = 0.2 gf.cm2/cm\nRT: 51 %\n",
        "Warp\nB = 0,1 gf.cm2/cm\nRT: 52,0 %\nWeft\nB = 0,2 gf.cm2/cm\nRT: 51,0 %\n",
    ] {
        let content = read(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_relative_eq!(value(&content, Parameter::B, WARP), TENTH, max_relative = 1e-12);
        assert_relative_eq!(value(&content, Parameter::B, WEFT), 2.0 * TENTH, max_relative = 1e-12);
        assert_relative_eq!(value(&content, Parameter::Rt, WARP), 0.52, max_relative = 1e-12);
        assert_relative_eq!(value(&content, Parameter::Rt, WEFT), 0.51, max_relative = 1e-12);
    }
}

/// `0.1 ± 3 %` deviates by 0.003, and `52 ± 3 %` by three hundredths.
#[test]
fn a_deviation_in_per_cent_is_one_of_the_value() {
    let content = read(
        "Parameter,Warp,Weft\nB (gf·cm²/cm),0.1 ± 3 %,0.2\nRT,52 ± 3 %,51 %\nLT,0.8 ± 5 %,0.7\n".as_bytes(),
    )
    .unwrap();
    let sd = |p| {
        content.results.iter().find(|(_, r)| (r.parameter, r.direction) == (p, WARP)).unwrap().1.sd.unwrap()
    };
    assert_relative_eq!(sd(Parameter::B), 0.03 * TENTH, max_relative = 1e-12);
    assert_relative_eq!(sd(Parameter::Rt), 0.03, max_relative = 1e-12);
    assert_relative_eq!(sd(Parameter::Lt), 0.04, max_relative = 1e-12);
    assert_relative_eq!(value(&content, Parameter::Lt, WARP), 0.8, max_relative = 1e-12);
}

#[test]
fn a_unit_that_contradicts_or_is_unknown_is_refused_at_its_cell() {
    for (text, place) in [
        ("Parameter,Unit,Warp,Weft\nB,gf·cm²/cm,0.1 uN.m,0.2\n", "lab.csv:2:13: R018"),
        ("Parameter,Warp,Weft\nB,0.1 foo/bar,0.2\n", "lab.csv:2:3: R009"),
        ("Parameter,Warp,Weft\nB,0.1 foo/bar,0.2 foo/bar\nRT,52 %,51 %\n", "lab.csv:2:3: R009"),
        ("Sample,Direction,T0 (mm)\nF,warp,52 %\n", "lab.csv:2:8: R018"),
        ("Parameter,Warp,Weft\nB,0.1 kPa,0.2 kPa\n", "lab.csv:2:3: R010"),
    ] {
        let error = read(text.as_bytes()).map(|c| c.results).unwrap_err().to_string();
        assert!(error.starts_with(place), "{text}: {error}");
    }
}

/// 0.02 in are 0.508 mm.
#[test]
fn inches_are_read_where_a_length_can_stand() {
    let content = read(b"Property,Unit,Value\nT0,in,0.02\nB warp,lbf.in2/in,0.0001\nW,mg/cm2,12\n").unwrap();
    assert_relative_eq!(value(&content, Parameter::T0, None), 5.08e-4, max_relative = 1e-12);
    assert_relative_eq!(
        value(&content, Parameter::B, WARP),
        1e-4 * 4.4482216152605 * 0.0254,
        max_relative = 1e-12
    );
    let german =
        read("Muster;Richtung;Biegesteifigkeit B in gf·cm²/cm\nF;Kette;0,1\nF;Schuss;0,2\n".as_bytes())
            .unwrap();
    assert_relative_eq!(value(&german, Parameter::B, WARP), TENTH, max_relative = 1e-12);
}

#[test]
fn letters_are_directions_beside_their_partner_or_under_a_heading_of_directions() {
    for (text, is_told) in [
        ("Sample,Direction,B (gf·cm²/cm)\nF,L,0.1\nF,T,0.2\n", false),
        ("Sample,B_K (gf·cm²/cm),B_S (gf·cm²/cm)\nF,0.1,0.2\n", true),
        ("Sample,B (L) [gf·cm²/cm],B (T) [gf·cm²/cm]\nF,0.1,0.2\n", true),
        ("Parameter,Unit,L,T\nB,gf·cm²/cm,0.1,0.2\n", true),
        ("Sample,B (gf·cm²/cm)\nF-L,0.1\nF-T,0.2\n", true),
    ] {
        let content = read(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_relative_eq!(value(&content, Parameter::B, WARP), TENTH, max_relative = 1e-12);
        assert_relative_eq!(value(&content, Parameter::B, WEFT), 2.0 * TENTH, max_relative = 1e-12);
        assert_eq!(!findings_of(&content, "R133").is_empty(), is_told, "{text}");
    }
    // A course, or `chaîne`.
    let knit = read("Sample,Direction,B (gf·cm²/cm)\nF,C,0.1\n".as_bytes());
    assert!(knit.is_err() || !knit.unwrap().failures.is_empty());
    // Samples, and a thickness.
    let names = read("Parameter,Unit,K,L,T\nB,gf·cm²/cm,0.1,0.2,0.3\n".as_bytes()).unwrap();
    assert!(
        names.results.iter().all(|(name, r)| name.is_some() && r.direction.is_none()),
        "{:?}",
        names.results
    );
    let samples = read("Sample,Direction,B (gf·cm²/cm)\nT,warp,0.1\nT,weft,0.2\n".as_bytes()).unwrap();
    assert_relative_eq!(value(&samples, Parameter::B, WARP), TENTH, max_relative = 1e-12);
    assert_eq!(samples.results[0].0.as_deref(), Some("T"));
}

/// Numbers under heads of something else are told, and are no fabrics and no specimens.
#[test]
fn numbers_under_unknown_heads_are_no_values() {
    for text in [
        "Property,Unit,Warp,Weft,Setting,Machine\nB,gf·cm²/cm,0.1,0.2,2.5,7\n2HB,gf·cm/cm,0.1,0.2,2.5,7\n",
        "Property,Unit,Warp,a1,Weft\nB,gf·cm²/cm,0.1,12,0.2\n2HB,gf·cm/cm,0.1,13,0.2\n",
        "Property,Unit,Warp,,Weft\nB,gf·cm²/cm,0.1,12,0.2\n2HB,gf·cm/cm,0.1,13,0.2\n",
        "Sample,Direction,F1,F2,B (gf·cm²/cm)\nF,warp,3,4,0.1\nF,weft,5,6,0.2\n",
    ] {
        let content = read(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_relative_eq!(value(&content, Parameter::B, WARP), TENTH, max_relative = 1e-12);
        assert_relative_eq!(value(&content, Parameter::B, WEFT), 2.0 * TENTH, max_relative = 1e-12);
        assert!(!findings_of(&content, "R104").is_empty(), "{text}");
    }
    // Rows that such numbers tell apart are averaged, and that is told.
    let settings = read("Setting,B (gf·cm²/cm),2HB (gf·cm/cm)\n1,0.1,0.1\n2,0.3,0.1\n".as_bytes()).unwrap();
    assert!(findings_of(&settings, "R132").contains("\"Setting\""));
    let loops =
        read("Sample,Direction,Loops,B (gf·cm²/cm)\nF,warp,3,0.1\nF,warp,4,0.3\n".as_bytes()).unwrap();
    assert!(findings_of(&loops, "R112").contains("B warp") && findings_of(&loops, "R104").contains("Loops"));
}

/// A value that a header line states beside a table is told where it is not read.
#[test]
fn a_value_apart_from_its_table_is_told() {
    let text = "2HG5 = 2.1 gf/cm\nOperator,Sato\n\nSample,Direction,B (gf·cm²/cm)\nF,warp,0.1\nF,weft,0.2\n";
    let content = read(text.as_bytes()).unwrap();
    let read_or_told = content.results.iter().any(|(_, r)| r.parameter == Parameter::Hg5)
        || findings_of(&content, "R104").contains("2HG5");
    assert!(read_or_told, "{:?}", content.findings);
}

/// `s` and `V%` below the mean are no samples.
#[test]
fn deviations_below_a_mean_are_no_samples() {
    let text = "Probe;B (gf·cm²/cm)\nF1;0,1\nF2;0,2\nMW;0,15\ns;0,07\nV%;47,1\n";
    let content = read(text.as_bytes()).unwrap();
    let names: Vec<Option<&str>> = content.results.iter().map(|(name, _)| name.as_deref()).collect();
    assert_eq!(names, [Some("F1"), Some("F2")]);
    assert!(findings_of(&content, "R110").contains("\"V%\""));
}

/// A blend is a name, and `s` above a mean is a sample.
#[test]
fn names_with_per_cent_are_names() {
    let text = "Sample,B warp (gf·cm²/cm)\nPES 35%,0.1\nPES 65%,0.2\ns,0.3\nmean,0.2\nCV%,50\n";
    let content = read(text.as_bytes()).unwrap();
    let names: Vec<Option<&str>> = content.results.iter().map(|(name, _)| name.as_deref()).collect();
    assert_eq!(names, [Some("PES 35%"), Some("PES 65%"), Some("s")]);
}

/// In code page 850 of DOS the direction is `87 C6` within, and the unit has `FA` and `FD`.
#[test]
fn code_pages_of_dos_are_known_by_their_words_and_units() {
    let portuguese = b"Amostra;Dire\x87\xc6o;B (gf.cm2/cm)\r\nF;Urdume;0,1\r\nF;Trama;0,2\r\n";
    let units = b"Sample;Direction;B (gf\xfacm\xfd/cm)\r\nF;warp;0,1\r\nF;weft;0,2\r\n";
    let turkish = b"Numune;Y\x94n;B (gf.cm2/cm)\r\nF;\x80\x94zg\x81;0,1\r\nF;Atk\x8d;0,2\r\n";
    for (text, encoding) in [(&portuguese[..], "CP850"), (&units[..], "CP850"), (&turkish[..], "CP857")] {
        let content = read(text).unwrap();
        assert_eq!(content.source.encoding, encoding);
        assert_relative_eq!(value(&content, Parameter::B, WARP), TENTH, max_relative = 1e-12);
        assert_relative_eq!(value(&content, Parameter::B, WEFT), 2.0 * TENTH, max_relative = 1e-12);
    }
}

/// A heading or a label that was lost, cells that slipped by one, a line with other delimiters.
#[test]
fn rows_and_columns_that_lost_their_name_are_told() {
    for (text, expected) in [
        ("Fabric,B (gf.cm2/cm),,RT (%)\nP,0.1,0.3,52\nQ,0.2,0.4,51\n", "column 3 without a heading"),
        ("Parameter,Warp,Weft\nB (gf.cm2/cm),0.1,0.2\n,52,51\nLT,0.7,0.6\n", "line 3 without a name"),
        (
            "Parameter,Warp,Weft\nB (gf.cm2/cm),0.1,0.2\nRT (%);52;51\nLT,0.7,0.6\n",
            "line 3, which is one cell",
        ),
    ] {
        let content = read(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!(findings_of(&content, "R104").contains(expected), "{text}: {:?}", content.findings);
    }
    let lost =
        "Fabric,B (gf.cm2/cm),,2HB (gf.cm/cm),\n,,weft,warp,weft\nP,0.1,0.2,0.3,0.3\nQ,0.3,0.4,0.3,0.3\n";
    assert!(findings_of(&read(lost.as_bytes()).unwrap(), "R136").starts_with("lab.csv:3:3"));
    let rows: String = (0..9).map(|i| format!("{i}.5,{i}.25,{}.5\n", 2 * i)).collect();
    let curves = format!("Direction,warp\nK (1/cm),M (gf.cm/cm),Mm (gf.cm/cm),N\n{rows}");
    let curves = read(curves.as_bytes());
    assert!(findings_of(&curves.unwrap(), "R104").contains("Mm (gf.cm/cm)"));
    let shifted = "Fabric,B (gf.cm2/cm),RT (%)\nP,0.1,52\n0.2,51,\nR,0.3,50\n";
    let content = read(shifted.as_bytes()).unwrap();
    assert_eq!(content.failures.len(), 1, "{:?}", content.results);
    assert!(content.failures[0].to_string().starts_with("lab.csv:3:1: R018"), "{}", content.failures[0]);
    // Names may be numbers.
    let numbered = "Fabric,B (gf.cm2/cm),RT (%)\n101,0.1,52\n1.5,0.2,51\n";
    assert!(read(numbered.as_bytes()).unwrap().failures.is_empty());
}

/// As laboratories write them: numbers of specimens once more below each direction, specimens beside fabrics under a heading for
/// samples, a report of fixed width with nothing over the labels of its rows.
#[test]
fn numbers_over_columns_numbers_beside_names_and_rows_without_a_head() {
    for text in [
        "Parametr;Jednostka;Osnowa;;;Wątek;;\n;;1;2;3;1;2;3\nB;gf·cm²/cm;0,09;0,11;0,10;0,19;0,21;0,20\n",
        "Prova;Ordito;;;Trama;;\n;1;2;3;1;2;3\nB (gf·cm²/cm);0,09;0,11;0,10;0,19;0,21;0,20\n2HB (gf·cm/cm);1,0;1,1;1,2;1,3;1,4;1,5\n",
        "织物,方向,试样,B (gf·cm²/cm)\nP,经,1,0.09\nP,经,2,0.11\nP,经,平均值,0.10\nP,纬,1,0.19\nP,纬,2,0.21\nP,纬,平均值,0.20\n",
        "Bending\n\n           B           2HB\n        gf.cm2/cm    gf.cm/cm\nWARP 1    0.0900     0.0420\nWARP 2    0.1100     0.0440\n\
         WEFT 1    0.1900     0.0270\nWEFT 2    0.2100     0.0290\n",
    ] {
        let content = read(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_relative_eq!(value(&content, Parameter::B, WARP), TENTH, max_relative = 1e-9);
        assert_relative_eq!(value(&content, Parameter::B, WEFT), 2.0 * TENTH, max_relative = 1e-9);
    }
    // CP852 of DOS.
    let polish =
        b"Pr\xa2bka;Kierunek;B [gf.cm2/cm]\r\nP\x88\xa2tno;osnowa;0,1\r\nP\x88\xa2tno;w\xa5tek;0,2\r\n";
    let content = read(polish).unwrap();
    assert_eq!(content.source.encoding, "CP852");
    assert_relative_eq!(value(&content, Parameter::B, WEFT), 2.0 * TENTH, max_relative = 1e-9);
}
