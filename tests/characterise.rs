//! From files to parameters: the shipped fabrics against the truth behind them.
//!
//! References: `truth.toml` of the synthetic fabrics (analytical: closed forms and dense sums of the
//! generator, which shares no code with the evaluation) and the published tables themselves.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use kesf::characterise::{FabricSheet, Settings, characterise};
use kesf::instrument::{Direction, Parameter, ReadSettings, Test, read_fabrics};
use kesf::quantity::Unit;
use serde::Deserialize;

fn data() -> PathBuf {
    std::env::var_os("KESF_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data"), PathBuf::from)
}

fn sheet(name: &str) -> FabricSheet {
    let batch = read_fabrics(&[data().join(name)], &ReadSettings::default(), &|_: &Path| ());
    assert_eq!(batch.failures, [], "{name}");
    characterise(&batch.fabrics[0], &Settings::default())
}

#[derive(Deserialize)]
struct Truth {
    areal_density: f64,
    specimen: Vec<Specimen>,
}

#[derive(Deserialize)]
struct Specimen {
    test: Test,
    direction: Option<Direction>,
    number: usize,
    /// Value and tolerance in KES units.
    values: BTreeMap<String, [f64; 2]>,
}

/// Every parameter of every specimen within the tolerance that the stated noise allows.
#[test]
fn synthetic_fabrics_come_back() {
    for name in ["poplin", "twill", "satin"] {
        let text = std::fs::read_to_string(data().join(name).join("truth.toml")).unwrap();
        let truth: Truth = toml::from_str(&text).unwrap();
        let sheet = sheet(name);
        let mut wrong = Vec::new();
        let mut compared = 0;
        for specimen in &truth.specimen {
            let found = (sheet.specimens.iter())
                .find(|s| {
                    let m = &s.measurement;
                    (m.test, m.direction, m.specimen) == (specimen.test, specimen.direction, specimen.number)
                })
                .unwrap_or_else(|| panic!("{name}: no {:?} {}", specimen.test, specimen.number));
            for (symbol, [expected, tolerance]) in &specimen.values {
                let value = match Parameter::from_symbol(symbol) {
                    Some(p) => found.values.get(&p).map(|v| v / p.kes_factor()),
                    None => found.moduli.get(symbol).map(|v| v / Parameter::Hg.kes_factor()),
                };
                compared += 1;
                let off = value.map_or(f64::NAN, |v| (v - expected).abs() / tolerance);
                if off.is_nan() || off > 1.0 {
                    let at = format!("{:?} {:?} {}", specimen.test, specimen.direction, specimen.number);
                    wrong.push(format!("{at}: {symbol} {value:?}, expected {expected} ± {tolerance}"));
                }
            }
        }
        assert!(wrong.is_empty(), "{name}:\n{}", wrong.join("\n"));
        // 6 tensile records with 7 values, 6 shear with 3, 6 bending with 5, 3 compression with 6.
        assert_eq!(compared, 6 * 7 + 6 * 3 + 6 * 5 + 3 * 6);
        let w = sheet.get(Parameter::W, None).unwrap();
        assert!((w.mean * 1e3 - truth.areal_density).abs() < 1e-9);
        for (key, estimate) in sheet.values.iter().filter(|(k, _)| k.parameter != Parameter::W) {
            assert_eq!(estimate.n, 3, "{name} {:?}", key);
        }
        assert!(sheet.findings.is_empty(), "{name}: {:#?}", sheet.findings);
    }
}

/// The sheet of a published fabric is its table: every cell, in its own unit, and nothing else.
#[test]
fn published_tables_pass_through() {
    let mut fabrics = 0;
    for entry in std::fs::read_dir(data()).unwrap().flatten() {
        let table = entry.path().join("results.csv");
        let Ok(text) = std::fs::read_to_string(&table) else { continue };
        fabrics += 1;
        let name = entry.file_name().to_string_lossy().into_owned();
        let sheet = sheet(&name);
        let mut cells = 0;
        for line in text.lines().skip(1) {
            let [symbol, direction, mean, _, _, unit, status] = line.split(',').collect::<Vec<_>>()[..]
            else {
                panic!("{line}");
            };
            let parameter = Parameter::from_symbol(symbol).unwrap();
            let direction = Direction::ALL.into_iter().find(|d| d.name() == direction);
            let found = sheet.get(parameter, direction).unwrap();
            let expected = mean.parse::<f64>().unwrap() * Unit::parse(unit).unwrap().factor;
            // One multiplication by the unit's factor: equal to the last bits.
            assert!(
                (found.mean / expected - 1.0).abs() < 1e-15,
                "{name} {symbol}: {} {expected}",
                found.mean
            );
            let told = sheet.findings.iter().any(|f| f.code == "K014" && f.message.starts_with(symbol));
            assert_eq!(told, status == "inferred", "{name} {symbol}");
            cells += 1;
        }
        assert_eq!(sheet.values.len(), cells, "{name}");
    }
    assert_eq!(fabrics, 10);
}

/// Origin and size of the shipped records.
#[test]
fn synthetic_fabrics_are_sampled_and_labelled() {
    for name in ["poplin", "twill", "satin"] {
        let sheet = sheet(name);
        assert_eq!(sheet.info.origin.name(), "synthetic");
        for specimen in &sheet.specimens {
            let samples = specimen.measurement.curve.len();
            assert!((150..=300).contains(&samples), "{name}: {samples}");
        }
    }
}
