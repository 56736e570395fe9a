//! A value with its spread over repeats.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// The mean of n repeats and their sample standard deviation (SI).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Estimate {
    /// Arithmetic mean.
    pub mean: f64,
    /// Sample standard deviation (divisor n - 1); `None` for a single value.
    pub sd: Option<f64>,
    /// Number of repeats.
    pub n: usize,
    /// The repeats themselves, in specimen order; empty where only a mean was published.
    pub values: Vec<f64>,
}

impl Estimate {
    /// One value without a spread.
    pub fn single(value: f64) -> Self {
        Self { mean: value, sd: None, n: 1, values: vec![value] }
    }

    /// A value that nobody measured: it has no repeats.
    pub fn stand_in(value: f64) -> Self {
        Self { mean: value, sd: None, n: 0, values: Vec::new() }
    }

    /// Mean and sample standard deviation of the repeats; `None` if there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let n = values.len();
        let mean = values.iter().sum::<f64>() / n as f64;
        let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        let sd = (n > 1).then(|| (squares / (n - 1) as f64).sqrt());
        // Equal repeats differ by the rounding of their mean alone.
        let rounding = n as f64 * f64::EPSILON * mean.abs();
        let sd = sd.map(|sd| if sd <= rounding { 0.0 } else { sd });
        Some(Self { mean, sd, n, values: values.to_vec() })
    }

    /// Coefficient of variation, SD / |mean|.
    pub fn cv(&self) -> Option<f64> {
        self.sd.filter(|_| self.mean != 0.0).map(|sd| sd / self.mean.abs())
    }

    /// Half width of the two-sided 95 % Student t interval of the mean; `None` without a deviation or below two repeats.
    pub fn ci95(&self) -> Option<f64> {
        let sd = self.sd?;
        let t = StudentsT::new(0.0, 1.0, self.n.checked_sub(1)? as f64).ok()?.inverse_cdf(0.975);
        Some(t * sd / (self.n as f64).sqrt())
    }
}

/// The number of repeats; `None` of one with a deviation: that is of repeats whose number nobody stated.
pub fn stated_repeats(n: u64, sd: Option<f64>) -> Option<u64> {
    (n != 1 || sd.is_none()).then_some(n)
}

/// The number of repeats for people.
pub fn repeats_text(n: u64, sd: Option<f64>) -> String {
    stated_repeats(n, sd).map_or("not stated".into(), |n| n.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_deviation_of_one_value_is_of_repeats_that_nobody_counted() {
        assert_eq!(
            [(1, None), (1, Some(0.1)), (3, Some(0.1))].map(|(n, sd)| repeats_text(n, sd)),
            ["1", "not stated", "3"]
        );
    }

    /// The mean of three times 0.1 is none of them: 0.1 + 0.1 + 0.1 is not 0.3.
    #[test]
    fn equal_repeats_have_no_deviation_and_close_ones_have() {
        assert_eq!(Estimate::of(&[0.1; 3]).unwrap().sd, Some(0.0));
        assert_eq!(Estimate::of(&[0.04, 0.04 + 2e-17]).unwrap().sd, Some(0.0));
        assert_relative_eq!(
            Estimate::of(&[1.0, 1.0 + 2e-12]).unwrap().sd.unwrap(),
            2e-12 / 2f64.sqrt(),
            max_relative = 1e-3
        );
    }

    #[test]
    fn mean_spread_and_interval_of_three() {
        let e = Estimate::of(&[1.0, 2.0, 3.0]).unwrap();
        assert_relative_eq!(e.mean, 2.0);
        assert_relative_eq!(e.sd.unwrap(), 1.0);
        // t(0.975, 2) = 4.302652729911275 (tables).
        assert_relative_eq!(e.ci95().unwrap(), 4.302652729911275 / 3f64.sqrt(), max_relative = 1e-8);
        assert_eq!(Estimate::of(&[]), None);
        assert_eq!(Estimate::of(&[4.0]).unwrap().ci95(), None);
        // A deviation beside it: of repeats whose number nobody stated, or of a damaged document.
        for n in [0, 1] {
            assert_eq!(Estimate { mean: 4.0, sd: Some(1.0), n, values: vec![] }.ci95(), None);
        }
    }
}
