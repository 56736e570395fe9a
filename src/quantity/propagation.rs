//! First-order (delta) propagation of the spread of measured inputs to what is computed from them.

use serde::{Deserialize, Deserializer, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::Estimate;

/// A standard uncertainty and the 95 % interval that follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Band {
    /// Standard uncertainty, in the unit of the quantity.
    pub standard: f64,
    /// Half the width of the two-sided 95 % interval (Student t): value ± this.
    pub half_width: f64,
    /// Effective degrees of freedom (Welch-Satterthwaite); infinite where nothing is uncertain, which is `null` in JSON.
    #[serde(deserialize_with = "null_is_infinite")]
    #[cfg_attr(test, schemars(with = "Option<f64>"))]
    pub degrees_of_freedom: f64,
}

fn null_is_infinite<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::INFINITY))
}

/// The two questions that a band may answer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Bands {
    /// Where the value of the mean fabric lies: each input has the standard error SD/√n.
    pub mean_fabric: Band,
    /// Where the value of one more specimen lies: each input has SD·√(1 + 1/n), the spread between
    /// specimens and that of their mean together (prediction interval).
    pub next_specimen: Band,
}

/// An input without a spread: one value only, or a mean published alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoSpread {
    /// Place of the input among the terms, from 0.
    pub term: usize,
}

impl Bands {
    /// The bands of a quantity y from its inputs p_i and `∂y/∂ln p_i` (unit of y), inputs independent.
    ///
    /// The degrees of freedom are u⁴ / Σ u_i⁴/(n_i - 1): Welch (1947), Biometrika 34, 28-35;
    /// JCGM 100:2008, G.4.
    ///
    /// # Errors
    /// The first input with a derivative other than zero that has no spread.
    pub fn propagated(terms: &[(&Estimate, f64)]) -> Result<Self, NoSpread> {
        // Variance and variance²/ν of each term, per unit of the factor that makes SD² a variance.
        let (mut mean, mut next) = (Sums::default(), Sums::default());
        for (term, (input, derivative)) in terms.iter().enumerate().filter(|(_, t)| t.1 != 0.0) {
            let cv = input.cv().filter(|_| input.n > 1).ok_or(NoSpread { term })?;
            let (n, variance) = (input.n as f64, (derivative * cv).powi(2));
            mean.add(variance / n, n - 1.0);
            next.add(variance * (1.0 + 1.0 / n), n - 1.0);
        }
        Ok(Self { mean_fabric: mean.band(), next_specimen: next.band() })
    }
}

#[derive(Default)]
struct Sums {
    variance: f64,
    /// Σ variance² / ν.
    spread: f64,
}

impl Sums {
    fn add(&mut self, variance: f64, degrees_of_freedom: f64) {
        self.variance += variance;
        self.spread += variance * variance / degrees_of_freedom;
    }

    fn band(&self) -> Band {
        let standard = self.variance.sqrt();
        if self.spread == 0.0 {
            return Band { standard, half_width: 0.0, degrees_of_freedom: f64::INFINITY };
        }
        let degrees_of_freedom = self.variance * self.variance / self.spread;
        // Not a number where the spreads are so small that their fourth powers vanish.
        let t = StudentsT::new(0.0, 1.0, degrees_of_freedom).map_or(f64::NAN, |t| t.inverse_cdf(0.975));
        Band { standard, half_width: t * standard, degrees_of_freedom }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn one_input_has_the_t_interval_of_its_mean() {
        let e = Estimate::of(&[1.0, 2.0, 3.0]).unwrap();
        let bands = Bands::propagated(&[(&e, e.mean)]).unwrap();
        assert_relative_eq!(bands.mean_fabric.half_width, e.ci95().unwrap(), max_relative = 1e-9);
        assert_relative_eq!(bands.mean_fabric.degrees_of_freedom, 2.0, max_relative = 1e-12);
        assert_relative_eq!(bands.next_specimen.standard, (4.0f64 / 3.0).sqrt(), max_relative = 1e-12);
    }

    /// JCGM 100:2008, H.1.6 is too long to repeat: two equal terms of 4 repeats each have twice
    /// the degrees of freedom of one, t(0.975, 6) = 2.446912 (tables).
    #[test]
    fn equal_terms_add_their_degrees_of_freedom() {
        let e = Estimate { mean: 2.0, sd: Some(0.2), n: 4, values: vec![] };
        let bands = Bands::propagated(&[(&e, 3.0), (&e, -3.0)]).unwrap();
        let standard = 2f64.sqrt() * 3.0 * 0.1 / 2.0;
        assert_relative_eq!(bands.mean_fabric.standard, standard, max_relative = 1e-12);
        assert_relative_eq!(bands.mean_fabric.degrees_of_freedom, 6.0, max_relative = 1e-12);
        assert_relative_eq!(bands.mean_fabric.half_width, 2.446_912 * standard, max_relative = 1e-6);
    }

    #[test]
    fn an_input_without_spread_gives_no_band_unless_nothing_depends_on_it() {
        let (known, single) = (Estimate::of(&[1.0, 1.1]).unwrap(), Estimate::single(1.0));
        assert_eq!(Bands::propagated(&[(&known, 1.0), (&single, 1.0)]), Err(NoSpread { term: 1 }));
        assert!(Bands::propagated(&[(&known, 1.0), (&single, 0.0)]).is_ok());
        let nothing = Bands::propagated(&[]).unwrap();
        assert_eq!((nothing.mean_fabric.standard, nothing.mean_fabric.half_width), (0.0, 0.0));
    }
}
