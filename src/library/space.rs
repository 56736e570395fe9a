//! The space that fabrics are compared in.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::kes::{Direction, HAND, Parameter};
use crate::quantity::Moments;

/// Fewest parameters that two fabrics must share to be compared.
pub const FEWEST: usize = 3;

/// A fabric in the space; not a number where it has no value.
pub(super) type Point = [f64; HAND.len()];

/// What is usual in a library for a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Axis {
    /// The parameter.
    pub parameter: Parameter,
    /// Whether its logarithm (log10) is taken.
    pub log10: bool,
    /// Number of fabrics that have it.
    pub n: u64,
    /// Mean over them, of the logarithm if that is taken.
    pub mean: f64,
    /// Standard deviation over them; nothing of fewer than two.
    pub sd: Option<f64>,
}

/// The moments of the axes over a library.
#[derive(Clone, Debug, Default)]
pub(super) struct Usual([Moments; HAND.len()]);

/// Name of the column of a parameter or modulus in a direction.
pub(super) fn column(parameter: &str, direction: Option<&str>) -> String {
    let name = parameter.replace(' ', "_");
    direction.map_or(name.clone(), |direction| format!("{name}_{direction}"))
}

/// Columns that a point is made of: those of the two directions, and that of the fabric as a whole.
pub(super) fn columns(parameter: Parameter) -> [String; 3] {
    let in_direction = |direction: Direction| column(parameter.symbol(), Some(direction.name()));
    [in_direction(Direction::Warp), in_direction(Direction::Weft), column(parameter.symbol(), None)]
}

/// What stands for the columns that a point is made of, by their names.
pub(super) type Sources<T> = [[T; 3]; HAND.len()];

/// Finds what stands for each of the columns.
pub(super) fn sources<T>(of: impl Fn(&str) -> T) -> Sources<T> {
    HAND.map(|(parameter, _)| columns(parameter).map(|name| of(&name)))
}

/// The point of values in these columns.
pub(super) fn point<T>(sources: &Sources<T>, value: impl Fn(&T) -> Option<f64>) -> Point {
    std::array::from_fn(|axis| coordinate(sources[axis].each_ref().map(&value), HAND[axis].1))
}

/// A coordinate: the mean of the two directions where one is known, else the fabric as a whole. A value that is not
/// above 0 has no logarithm and is not compared.
fn coordinate([warp, weft, whole]: [Option<f64>; 3], log10: bool) -> f64 {
    let mean = match (warp, weft) {
        (Some(a), Some(b)) => Some((a + b) / 2.0),
        (one, None) | (None, one) => one,
    };
    match mean.or(whole) {
        Some(value) if !log10 => value,
        Some(value) if value > 0.0 => value.log10(),
        _ => f64::NAN,
    }
}

impl Usual {
    /// Counts a fabric.
    pub fn add(&mut self, point: &Point) {
        for (moments, value) in self.0.iter_mut().zip(point).filter(|(_, value)| value.is_finite()) {
            moments.add(*value);
        }
    }

    /// What is usual, axis by axis.
    pub fn axes(&self) -> Vec<Axis> {
        let axis = |((parameter, log10), m): (&(Parameter, bool), &Moments)| Axis {
            parameter: *parameter,
            log10: *log10,
            n: m.n,
            mean: m.mean,
            sd: m.sd(),
        };
        HAND.iter().zip(&self.0).map(axis).collect()
    }
}

/// The distance of two points, and the number of parameters that it rests on: the root mean square, over those that
/// both have and in which the library differs, of their difference in standard deviations.
pub(super) fn distance(a: &Point, b: &Point, axes: &[Axis]) -> (f64, u64) {
    let (mut sum, mut count) = (0.0, 0);
    for ((x, y), axis) in a.iter().zip(b).zip(axes) {
        let Some(sd) = axis.sd.filter(|sd| *sd > 0.0) else { continue };
        if x.is_finite() && y.is_finite() {
            sum += ((x - y) / sd).powi(2);
            count += 1;
        }
    }
    ((sum / count as f64).sqrt(), count)
}

/// Values by the names of their columns.
pub(super) type Values = BTreeMap<String, f64>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coordinate_is_the_mean_of_two_directions_and_its_logarithm() {
        assert_eq!(coordinate([Some(1.0), Some(3.0), Some(9.0)], false), 2.0);
        assert_eq!(coordinate([None, Some(100.0), None], true), 2.0);
        assert_eq!(coordinate([None, None, Some(10.0)], true), 1.0);
        assert!(coordinate([Some(0.0), None, None], true).is_nan());
        assert!(coordinate([None; 3], false).is_nan());
    }

    #[test]
    fn distances_are_in_standard_deviations() {
        let mut usual = Usual::default();
        let point_of = |t: f64, b: f64| {
            let values = sources(|name| [("T0", t), ("B_warp", b)].iter().find(|c| c.0 == name).map(|c| c.1));
            point(&values, |value| *value)
        };
        // log10 of T0: 0, 1, 2: mean 1, SD 1. B is the same everywhere and says nothing.
        let points = [point_of(1.0, 5.0), point_of(10.0, 5.0), point_of(100.0, 5.0)];
        points.iter().for_each(|point| usual.add(point));
        let axes = usual.axes();
        let t0 = axes.iter().find(|axis| axis.parameter == Parameter::T0).unwrap();
        assert_eq!((t0.n, t0.mean, t0.sd), (3, 1.0, Some(1.0)));
        assert_eq!(distance(&points[0], &points[2], &axes), (2.0, 1));
    }
}
