//! Spread of measured inputs through a function that is not linear: scrambled Sobol points.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::{Estimate, NoSpread};
use crate::platform;

/// Which of two questions a sample answers; see [`Bands`](super::Bands).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SampledPopulation {
    /// Where the mean fabric lies: standard error SD/√n.
    MeanFabric,
    /// Where one more specimen lies: SD √(1 + 1/n).
    NextSpecimen,
}

/// A result over a sample of the inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Sampled {
    /// Median.
    pub median: f64,
    /// Ends of the central 95 %.
    pub interval: [f64; 2],
    /// Points that gave a result.
    pub n: usize,
    /// Points that gave none.
    pub failed: usize,
}

/// Points of inputs, each input in its own column: `ln p = ln mean + s t`, with t of Student's
/// distribution (n - 1 degrees of freedom), s the relative spread, inputs independent. 128 to 256 points
/// are enough for a band; a power of two keeps the points balanced. The same seed gives the same points.
///
/// # Errors
/// The first input that has no spread.
///
/// # Panics
/// With more than 256 inputs.
pub fn sobol_points(
    inputs: &[&Estimate],
    population: SampledPopulation,
    points: u32,
    seed: u32,
) -> Result<Vec<Vec<f64>>, NoSpread> {
    let mut columns = Vec::with_capacity(inputs.len());
    for (term, input) in inputs.iter().enumerate() {
        let n = input.n as f64;
        let cv = input.cv().filter(|_| input.n > 1).ok_or(NoSpread { term })?;
        let t = StudentsT::new(0.0, 1.0, n - 1.0).map_err(|_| NoSpread { term })?;
        let factor = match population {
            SampledPopulation::MeanFabric => 1.0 / n,
            SampledPopulation::NextSpecimen => 1.0 + 1.0 / n,
        };
        columns.push((input.mean, cv * factor.sqrt(), t));
    }
    let value = |i: u32, (d, (mean, s, t)): (u32, &(f64, f64, StudentsT))| {
        // The middle of the cell of single precision that the point stands for: never 0 or 1.
        let u = f64::from(sobol_burley::sample(i, d, seed)) + 0.5 / f64::from(1u32 << 24);
        mean * (s * t.inverse_cdf(u)).exp()
    };
    Ok((0..points).map(|i| (0u32..).zip(&columns).map(|c| value(i, c)).collect()).collect())
}

/// A function of several results at every point, in parallel, summed up for each of the first `results`;
/// `None` of one that is finite nowhere. `progress` is called after each point. The number of
/// threads changes nothing.
pub fn sampled(
    points: &[Vec<f64>],
    results: usize,
    function: impl Fn(&[f64]) -> Vec<f64> + Sync,
    progress: impl Fn() + Sync,
) -> Vec<Option<Sampled>> {
    let evaluate = |p: &Vec<f64>| {
        let y = function(p);
        progress();
        y
    };
    let all: Vec<Vec<f64>> = platform::map(points, evaluate);
    let finite_values =
        |k: usize| all.iter().filter_map(|y| y.get(k).copied()).filter(|y| y.is_finite()).collect();
    (0..results).map(|k| summed_up(finite_values(k), points.len())).collect()
}

/// Median and central 95 % of the results at some of the points.
fn summed_up(mut values: Vec<f64>, points: usize) -> Option<Sampled> {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    let last = n.checked_sub(1)?;
    // Linear between order statistics at (i + 1/2)/n.
    let quantile = |q: f64| {
        let at = (q * n as f64 - 0.5).clamp(0.0, last as f64);
        let i = at as usize;
        values[i] + (at - i as f64) * (values[(i + 1).min(last)] - values[i])
    };
    Some(Sampled {
        median: quantile(0.5),
        interval: [quantile(0.025), quantile(0.975)],
        n,
        failed: points - n,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn input(mean: f64, sd: f64, n: usize) -> Estimate {
        Estimate { mean, sd: Some(sd), n, values: Vec::new() }
    }

    /// One input, y = p³: the ends are those of Student's t, 4.302652730 for two degrees of freedom.
    #[test]
    fn one_input_has_the_band_of_student() {
        let p = input(2.0, 0.02, 3);
        for (population, factor) in
            [(SampledPopulation::MeanFabric, 1.0 / 3.0), (SampledPopulation::NextSpecimen, 4.0 / 3.0)]
        {
            let points = sobol_points(&[&p], population, 1024, 7).unwrap();
            let y = sampled(&points, 1, |p| vec![p[0].powi(3)], || ())[0].unwrap();
            let half = 3.0 * 4.302_652_730 * 0.01 * f64::sqrt(factor);
            // 1024 points: the 2.5 % point lies between order statistics 0.1 % apart.
            assert_relative_eq!(y.interval[1].ln() - 8f64.ln(), half, max_relative = 0.02);
            assert_relative_eq!(y.interval[0].ln() - 8f64.ln(), -half, max_relative = 0.02);
            assert_relative_eq!(y.median, 8.0, max_relative = 1e-3);
            assert_eq!((y.n, y.failed), (1024, 0));
        }
    }

    /// Ten inputs of nearly normal spread, y their product: variances add. 256 points.
    #[test]
    fn spreads_of_many_inputs_add() {
        let inputs: Vec<Estimate> = (1..=10).map(|i| input(f64::from(i), 0.01 * f64::from(i), 400)).collect();
        let points =
            sobol_points(&inputs.iter().collect::<Vec<_>>(), SampledPopulation::NextSpecimen, 256, 1)
                .unwrap();
        let y = sampled(&points, 1, |p| vec![p.iter().product()], || ())[0].unwrap();
        let half = 0.5 * (y.interval[1] / y.interval[0]).ln();
        // z = 1.960, and the sampling error of a 2.5 % point of 256.
        assert_relative_eq!(half, 1.960 * 0.01 * f64::sqrt(10.0 * (1.0 + 1.0 / 400.0)), max_relative = 0.08);
    }

    #[test]
    fn what_fails_is_counted_and_what_has_no_spread_refused() {
        let p = input(1.0, 0.1, 5);
        let points = sobol_points(&[&p], SampledPopulation::NextSpecimen, 64, 3).unwrap();
        assert_eq!(points, sobol_points(&[&p], SampledPopulation::NextSpecimen, 64, 3).unwrap());
        let only = |p: &[f64]| if p[0] > 1.0 { vec![p[0], f64::NAN] } else { Vec::new() };
        let both = sampled(&points, 2, only, || ());
        let y = both[0].unwrap();
        assert_eq!((y.n, y.failed), (32, 32));
        assert_eq!(both[1], None);
        let refused = sobol_points(&[&p, &Estimate::single(1.0)], SampledPopulation::MeanFabric, 8, 0);
        assert_eq!(refused, Err(NoSpread { term: 1 }));
    }
}
