//! Exports of instruments: texts, workbooks, archives, FAB records.

use std::fmt::Write;
use std::path::{Component, Path};

use kesf::instrument::{FileContent, Measurement, ReadSettings, Shape, parse, unpacked};

use crate::archives::{damaged_compound, damaged_zip, unpacked_size, zipped};
use crate::{Damage, Target, corpus};

/// Texts of every layout and encoding, web pages among them.
pub fn text() -> Target {
    let mut seeds = corpus::folder("text");
    seeds.extend(corpus::shipped("tests/malformed", &[".csv"]));
    seeds.extend(corpus::shipped("kesf_data", &["1.csv", "warp.txt", "bending.csv", "results.csv"]));
    let seeds = seeds.into_iter().map(corpus::thinned).collect();
    Target {
        seeds,
        damaged: Damage::of,
        size: <[u8]>::len,
        holds: |bytes| holds(bytes, "F01_warp_FB2_1.csv"),
    }
}

/// Workbooks of Excel until 2003.
pub fn xls() -> Target {
    let seeds = corpus::shipped("tests/workbooks", &[".xls"]);
    Target {
        seeds,
        damaged: damaged_compound,
        size: <[u8]>::len,
        holds: |bytes| holds(bytes, "F01_warp_FB2_1.xls"),
    }
}

/// Workbooks of Excel.
pub fn xlsx() -> Target {
    let seeds = corpus::shipped("tests", &["twill.xlsx", "r113-hidden.xlsx"]);
    Target {
        seeds,
        damaged: damaged_zip,
        size: unpacked_size,
        holds: |bytes| holds(bytes, "F01_warp_FB2_1.xlsx"),
    }
}

/// Workbooks of LibreOffice.
pub fn ods() -> Target {
    Target {
        seeds: corpus::folder("ods"),
        damaged: damaged_zip,
        size: unpacked_size,
        holds: |bytes| holds(bytes, "F01_warp_FB2_1.ods"),
    }
}

/// FAB records and U3M files.
pub fn fab() -> Target {
    let mut seeds = corpus::shipped("tests/malformed", &[".json"]);
    seeds.extend(corpus::folder("fab"));
    Target { seeds, damaged: Damage::of, size: <[u8]>::len, holds: |bytes| holds(bytes, "cloth.u3m") }
}

/// Archives of exports.
pub fn archive() -> Target {
    let files = |folder: &str| -> Vec<(String, Vec<u8>)> {
        let found = corpus::shipped(folder, &["1.csv", "results.csv", "a.csv", "b.csv"])
            .into_iter()
            .map(corpus::thinned);
        found.enumerate().map(|(i, bytes)| (format!("lab/{folder}/{i}_warp_FB2_1.csv"), bytes)).collect()
    };
    let folders = ["kesf_data/poplin", "kesf_data/petrak_m1", "tests/malformed/r103-twice"];
    let seeds = folders.iter().map(|folder| zipped(&files(folder))).collect();
    Target { seeds, damaged: damaged_zip, size: unpacked_size, holds: archive_holds }
}

fn archive_holds(bytes: &[u8]) -> bool {
    let read = holds(bytes, "lab.zip");
    let Some(files) = unpacked(bytes) else { return read };
    let inside = |c: Component| matches!(c, Component::Normal(_) | Component::CurDir);
    assert!(files.iter().all(|(path, _)| path.components().all(inside)), "a file outside of its folder");
    let named: Vec<(String, Vec<u8>)> =
        files.iter().map(|(path, bytes)| (path.to_string_lossy().into_owned(), bytes.clone())).collect();
    // Two files of one name are one in an archive that is written anew.
    if named.windows(2).all(|pair| pair[0].0 != pair[1].0) && named.iter().all(|(name, _)| !name.is_empty()) {
        assert_eq!(unpacked(&zipped(&named)).unwrap_or_default(), files, "packed again");
    }
    read
}

fn holds(bytes: &[u8], name: &str) -> bool {
    let customary = ReadSettings { kes_units: true, ..ReadSettings::default() };
    let mut accepted = false;
    for settings in [ReadSettings::default(), customary] {
        match parse(Path::new(name), bytes, &settings) {
            Ok(content) => {
                is_complete(&content);
                is_the_same_again(&content);
                accepted |=
                    !content.measurements.is_empty() || !content.results.is_empty() || content.fab.is_some();
            }
            Err(error) => assert!(error.to_string().contains(name), "{error}"),
        }
    }
    accepted
}

/// What is read is finite and whole.
fn is_complete(content: &FileContent) {
    for m in &content.measurements {
        assert_eq!((m.curve.x.len(), m.curve.x.len()), (m.curve.y.len(), m.lines.len()));
        assert!(m.curve.points().all(|(x, y)| x.is_finite() && y.is_finite()));
        assert!(m.specimen > 0 && m.curve.len() >= 3);
        assert_eq!(m.direction.is_some(), m.test.is_directional());
        assert!(m.conditions.width > 0.0 && m.conditions.maximum > 0.0);
    }
    for (_, result) in &content.results {
        assert!(result.mean.is_finite() && result.n > 0 && result.sd.is_none_or(f64::is_finite));
        assert!(result.values.iter().all(|v| v.is_finite()));
    }
    for test in content.fab.iter().flat_map(|fab| &fab.tests) {
        assert!(test.length > 0.0 && test.width > 0.0);
        assert!(test.branches.iter().flat_map(|b| b.points()).all(|(x, y)| x.is_finite() && y.is_finite()));
    }
}

/// What is written of it as JSON, and of a curve as an export, reads the same.
fn is_the_same_again(content: &FileContent) {
    let measurements = serde_json::to_string(&content.measurements).expect("JSON of curves");
    assert_eq!(
        serde_json::from_str::<Vec<Measurement>>(&measurements).expect("curves"),
        content.measurements
    );
    let results = serde_json::to_string(&content.results).expect("JSON of values");
    assert_eq!(serde_json::from_str::<kesf_values::Values>(&results).expect("values"), content.results);
    let fab = serde_json::to_string(&content.fab).expect("JSON of a record");
    assert_eq!(
        serde_json::from_str::<Option<kesf::instrument::fab::FabFile>>(&fab).expect("a record"),
        content.fab
    );
    for m in content.measurements.iter().filter(|m| m.test.shape() != Shape::Sweep) {
        let export = export(m);
        let read = parse(Path::new("a.csv"), export.as_bytes(), &ReadSettings::default());
        let read = read.unwrap_or_else(|e| panic!("{e}\n{export}")).measurements;
        assert_eq!(read.len(), 1, "{export}");
        assert_eq!((read[0].test, read[0].direction, read[0].specimen), (m.test, m.direction, m.specimen));
        assert_eq!(read[0].curve, m.curve, "{export}");
    }
}

mod kesf_values {
    /// Values of a result table, each with its fabric.
    pub type Values = Vec<(Option<String>, kesf::instrument::ResultValue)>;
}

/// A curve as the clean layout has it, in SI.
fn export(m: &Measurement) -> String {
    let [x, y] = m.test.axes();
    let [x_name, y_name] = match m.test.name() {
        "tensile" => ["strain", "force"],
        "shear" => ["angle", "shear force"],
        "bending" => ["curvature", "moment"],
        _ => ["thickness", "pressure"],
    };
    let mut text = format!("test,{}\nspecimen,{}\n", m.test.name(), m.specimen);
    if let Some(direction) = m.direction {
        let _ = writeln!(text, "direction,{direction}");
    }
    let _ = writeln!(text, "\n{x_name} ({x}),{y_name} ({y})");
    for (x, y) in m.curve.points() {
        let _ = writeln!(text, "{x:?},{y:?}");
    }
    text
}
