//! A slip of one sample of a record: it is told and stays out of every value, or it is too small to matter.
//!
//! Kind: own. The records are those of `kesf_data/poplin`, synthetic, with noise; in each, one sample at a time is
//! ten times, a tenth of, or the opposite of what it was. With `KESF_SPIKES=all` every sample is taken in turn; else the
//! first and the last ones, those about the reversals, and every eleventh. `-- --nocapture` prints the counts.

use std::collections::BTreeMap;
use std::path::Path;

use kesf::characterise::{FabricSheet, Settings, characterise};
use kesf::instrument::{FabricInput, Measurement, ReadSettings, Test, read_fabrics};

use crate::common;

/// Difference of a value that the clean record and the one without its spike may have.
const SAME: f64 = 0.02;
/// Slips by less than this part of the range of the record are noise to it, and may move where the load begins.
const SMALL: f64 = 0.01;
/// Samples on each side of a reversal, and at the ends, that are taken one by one.
const NEAR: usize = 5;

fn poplin() -> Option<FabricInput> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data/poplin");
    if !folder.is_dir() {
        common::skipped("spikes", "no kesf_data");
        return None;
    }
    let mut batch = read_fabrics(&[folder], &ReadSettings::default(), &|_: &Path| ());
    batch.fabrics.pop()
}

fn sheet(m: Measurement) -> FabricSheet {
    let input = FabricInput { name: "one".into(), measurements: vec![m], ..FabricInput::default() };
    characterise(&input, &Settings::default())
}

/// Everything that a record gives, by name: parameters, moduli, what the law gives, slopes of fits.
fn values(sheet: &FabricSheet) -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    all.extend(sheet.values.iter().map(|(key, e)| (key.to_string(), e.mean)));
    all.extend(sheet.moduli.iter().map(|((name, _), e)| (format!("E {name}"), e.mean)));
    for law in &sheet.laws {
        all.extend(law.values.iter().map(|(p, v)| (format!("law {p}"), *v)));
    }
    for fit in sheet.specimens.iter().flat_map(|s| &s.fits) {
        all.insert(format!("fit {}", fit.name), fit.slope);
    }
    all
}

/// The worst of the differences, and where.
fn worst(clean: &BTreeMap<String, f64>, found: &BTreeMap<String, f64>) -> (f64, String) {
    let difference = |(name, v): (&String, &f64)| match found.get(name) {
        Some(f) => ((f - v).abs() / v.abs(), name.clone()),
        None => (f64::INFINITY, format!("{name} is missing")),
    };
    clean.iter().map(difference).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
}

fn places(x: &[f64]) -> Vec<usize> {
    let n = x.len();
    if std::env::var("KESF_SPIKES").is_ok_and(|v| v == "all") {
        return (0..n).collect();
    }
    let low = (0..n).min_by(|a, b| x[*a].total_cmp(&x[*b])).unwrap_or(0);
    let high = (0..n).max_by(|a, b| x[*a].total_cmp(&x[*b])).unwrap_or(0);
    let near = |i: usize, at: usize| i.abs_diff(at) <= NEAR;
    let taken =
        |i: &usize| i.is_multiple_of(11) || near(*i, low) || near(*i, high) || near(*i, 0) || near(*i, n - 1);
    (0..n).filter(taken).collect()
}

#[derive(Default)]
struct Count {
    tried: usize,
    reported: usize,
    wrong: Vec<String>,
}

/// One sample of a record slips; `reported` where a finding names its line.
fn slip(m: &Measurement, clean: &BTreeMap<String, f64>, i: usize, factor: f64, count: &mut Count) {
    let mut slipped = m.clone();
    slipped.curve.y[i] *= factor;
    let found = sheet(slipped);
    let line = m.lines[i];
    let is_reported = found.findings.iter().any(|f| f.code() == "K045");
    let found = values(&found);
    let mut without = m.clone();
    without.curve.x.remove(i);
    without.curve.y.remove(i);
    without.lines.remove(i);
    // What is left out is as if it had never been recorded.
    let left_out = worst(&values(&sheet(without)), &found);
    let (difference, name) = if is_reported { left_out } else { worst(clean, &found) };
    count.tried += 1;
    count.reported += usize::from(is_reported);
    let [low, high] =
        m.curve.y.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
    let slips_by = (m.curve.y[i] * (factor - 1.0)).abs();
    if difference > SAME && slips_by > SMALL * (high - low) {
        let how = if is_reported { "told, but not left out" } else { "silent" };
        let [was, is] = [m.curve.y[i], m.curve.y[i] * factor];
        let record = m.record_name();
        count.wrong.push(format!(
            "{record}, line {line} (sample {i} of {}): {was:.4} to {is:.4}, {how}: {name} {:.1} %",
            m.curve.len(),
            100.0 * difference
        ));
    }
}

#[test]
fn a_sample_that_slips_moves_no_value() {
    let Some(fabric) = poplin() else { return };
    let mut wrong = Vec::new();
    for test in [Test::Tensile, Test::Shear, Test::Bending, Test::Compression] {
        let m = fabric.measurements.iter().find(|m| m.test == test).expect("a record");
        let clean = values(&sheet(m.clone()));
        for factor in [10.0, 0.1, -1.0] {
            let mut count = Count::default();
            for i in places(&m.curve.x) {
                slip(m, &clean, i, factor, &mut count);
            }
            println!(
                "{:<12} times {factor:<4}: {} samples, {} told, {} move a value by more than {} %",
                test.name(),
                count.tried,
                count.reported,
                count.wrong.len(),
                100.0 * SAME
            );
            wrong.extend(count.wrong);
        }
    }
    assert!(wrong.is_empty(), "{} slips:\n{}", wrong.len(), wrong.join("\n"));
}
