//! Repeats: pooling, outliers, and specimens that seem to belong to the other direction.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::{FabricSheet, Key, Settings, SpecimenResult};
use crate::finding::{EvaluationFact, Fact, Finding};
use crate::instrument::{Direction, FabricInput, Measurement, Parameter};
use crate::quantity::Estimate;

/// Modified z-score above which a repeat is an outlier: Iglewicz and Hoaglin (1993), How to
/// Detect and Handle Outliers, ASQC.
const MODIFIED_Z: f64 = 3.5;
/// Two-sided level of Grubbs' test.
const LEVEL: f64 = 0.05;

/// Fills `sheet.values` and `sheet.moduli` from `sheet.specimens`.
pub(super) fn pool(sheet: &mut FabricSheet) {
    for &parameter in Parameter::ALL {
        for direction in Direction::ALL.map(Some).into_iter().chain([None]) {
            let values: Vec<f64> = (sheet.specimens.iter())
                .filter(|s| s.measurement.direction == direction)
                .filter_map(|s| s.values.get(&parameter).copied())
                .collect();
            if let Some(estimate) = Estimate::of(&values) {
                sheet.values.insert(Key { parameter, direction }, estimate);
            }
        }
    }
    for direction in Direction::ALL {
        let of_direction = || sheet.specimens.iter().filter(|s| s.measurement.direction == Some(direction));
        let mut names: Vec<&String> = of_direction().flat_map(|s| s.moduli.keys()).collect();
        names.sort();
        names.dedup();
        for name in names {
            let values: Vec<f64> = of_direction().filter_map(|s| s.moduli.get(name).copied()).collect();
            if let Some(estimate) = Estimate::of(&values) {
                sheet.moduli.insert((name.clone(), direction), estimate);
            }
        }
    }
}

/// K010: repeats that stand apart. They are kept in the mean.
pub(super) fn outliers(sheet: &FabricSheet, settings: &Settings) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (key, estimate) in &sheet.values {
        let Some((i, test)) = outlier(&estimate.values, settings.outlier_floor.si()) else { continue };
        let Some(measurement) = repeat(sheet, *key, i) else { continue };
        let fact = EvaluationFact::StandsApart {
            key: *key,
            repeat: measurement.specimen,
            in_table: false,
            others: estimate.n - 1,
            criterion: test.to_string(),
        };
        findings.push(Finding::new(fact).at(measurement.place()));
    }
    findings
}

/// K063: repeats of a factor between them that those of one cloth do not have.
///
/// The factors are a judgement, far above the scatter of repeats: thickness and mass are alike over a cloth. Hysteresis and
/// linearity are left out, as their repeats may be near zero or are alike in all cloth.
pub(super) fn no_repeats(sheet: &FabricSheet, input: &FabricInput) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (key, estimate) in &sheet.values {
        let widest = match key.parameter {
            Parameter::T0 | Parameter::Tm | Parameter::W => 1.5,
            Parameter::B | Parameter::G | Parameter::Emt | Parameter::Wt | Parameter::Wc => 3.0,
            _ => continue,
        };
        let apart = |f: &Finding| matches!(&f.fact, Fact::Evaluation(EvaluationFact::StandsApart { key: of, .. }) if of == key);
        let lowest = estimate.values.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = estimate.values.iter().copied().fold(0.0, f64::max);
        if estimate.values.len() < 2
            || lowest <= 0.0
            || highest <= widest * lowest
            || sheet.findings.iter().any(apart)
        {
            continue;
        }
        let cell =
            input.results.iter().find(|r| (r.parameter, r.direction) == (key.parameter, key.direction));
        let record = estimate.values.iter().position(|v| *v == highest).and_then(|i| repeat(sheet, *key, i));
        let place = record.map(Measurement::place).or(cell.map(|c| c.place.clone()));
        let fact = EvaluationFact::NoRepeats { key: *key, lowest, highest };
        findings.push(Finding { place, fact: fact.into() });
    }
    findings
}

/// The record behind the i-th value of an estimate.
fn repeat(sheet: &FabricSheet, key: Key, i: usize) -> Option<&Measurement> {
    let of_key = |s: &&SpecimenResult| {
        s.measurement.direction == key.direction && s.values.contains_key(&key.parameter)
    };
    sheet.specimens.iter().filter(of_key).nth(i).map(|s| &s.measurement)
}

/// The repeat that is furthest from the others, if a test calls it an outlier.
///
/// The median absolute deviation of three repeats is easily small by chance, so deviations below
/// `floor` (relative to the median) never count there; Grubbs' test needs four repeats.
pub(super) fn outlier(values: &[f64], floor: f64) -> Option<(usize, &'static str)> {
    let n = values.len();
    if n < 3 {
        return None;
    }
    let middle = median(values);
    let deviations: Vec<f64> = values.iter().map(|v| (v - middle).abs()).collect();
    let (worst, &largest) = deviations.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    let mad = median(&deviations);
    if largest > floor * middle.abs() && 0.6745 * largest > MODIFIED_Z * mad {
        return Some((worst, "MAD"));
    }
    let estimate = Estimate::of(values)?;
    let furthest = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
    let (worst, distance) = values.iter().map(|v| (v - estimate.mean).abs()).enumerate().max_by(furthest)?;
    (n >= 4 && distance > grubbs(n)? * estimate.sd?).then_some((worst, "Grubbs, 5 %"))
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    0.5 * (sorted[(n - 1) / 2] + sorted[n / 2])
}

/// Critical value of Grubbs' two-sided test: Grubbs (1969), Technometrics 11, 1-21.
fn grubbs(n: usize) -> Option<f64> {
    let n = n as f64;
    let t = StudentsT::new(0.0, 1.0, n - 2.0).ok()?.inverse_cdf(1.0 - LEVEL / (2.0 * n));
    Some((n - 1.0) / n.sqrt() * (t * t / (n - 2.0 + t * t)).sqrt())
}

/// K013: specimens whose EMT or B fits the other direction and not their own.
pub(super) fn swapped(sheet: &FabricSheet) -> Vec<Finding> {
    let mut findings = Vec::new();
    for parameter in [Parameter::Emt, Parameter::B] {
        for (own, other) in [(Direction::Warp, Direction::Weft), (Direction::Weft, Direction::Warp)] {
            for i in misplaced(repeats(sheet, parameter, own), repeats(sheet, parameter, other)) {
                let key = Key { parameter, direction: Some(own) };
                let Some(measurement) = repeat(sheet, key, i) else { continue };
                let specimen = measurement.specimen;
                let fact = EvaluationFact::OtherDirection { parameter, own, other, specimen };
                findings.push(Finding::new(fact).at(measurement.place()));
            }
        }
    }
    findings
}

/// The values of the repeats (SI).
fn repeats(sheet: &FabricSheet, parameter: Parameter, direction: Direction) -> &[f64] {
    sheet.get(parameter, Some(direction)).map(|e| e.values.as_slice()).unwrap_or_default()
}

/// Indices in `own` that lie with `other` although the rest of `own` lies clearly apart.
fn misplaced(own: &[f64], other: &[f64]) -> Vec<usize> {
    if own.len() < 3 || other.len() < 2 {
        return Vec::new();
    }
    // One swap usually comes with its partner in the other set: medians are not moved by it.
    let there = median(other);
    let spread = |v: &[f64], m: f64| median(&v.iter().map(|x| (x - m).abs()).collect::<Vec<_>>());
    (0..own.len())
        .filter(|&i| {
            let rest: Vec<f64> = own.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, v)| *v).collect();
            let here = median(&rest);
            let gap = (there - here).abs();
            let scatter = spread(&rest, here).max(spread(other, there));
            gap > 6.0 * scatter && (own[i] - there).abs() < 0.25 * gap
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Two-sided 5 % critical values as tabulated by Grubbs and Beck (1972), Technometrics 14, 847-854.
    #[test]
    fn grubbs_critical_values() {
        for (n, value) in [(4, 1.481), (5, 1.715), (6, 1.887), (10, 2.290)] {
            assert_relative_eq!(grubbs(n).unwrap(), value, epsilon = 6e-4);
        }
    }

    #[test]
    fn outliers_are_found_and_small_scatter_is_not_one() {
        assert_eq!(outlier(&[1.0, 1.001, 1.05], 0.1), None);
        assert_eq!(outlier(&[1.0, 1.02, 1.9], 0.1), Some((2, "MAD")));
        assert_eq!(outlier(&[1.0, 9.0], 0.1), None);
        assert_eq!(outlier(&[1.0, 1.01, 0.99, 1.09, 1.0], 0.1), Some((3, "Grubbs, 5 %")));
    }

    #[test]
    fn a_specimen_of_the_other_direction_is_pointed_out() {
        assert_eq!(misplaced(&[5.0, 5.1, 9.9], &[10.0, 10.1, 9.8]), [2]);
        assert_eq!(misplaced(&[5.0, 5.1, 9.9], &[10.0, 10.1, 5.2]), [2]);
        assert!(misplaced(&[5.0, 5.1, 4.9], &[10.0, 10.1, 9.8]).is_empty());
        assert!(misplaced(&[5.0, 5.3, 4.7], &[5.1, 5.2, 4.9]).is_empty());
    }
}
