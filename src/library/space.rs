//! The space that fabrics are compared in.

use std::collections::BTreeMap;

use arrow_array::cast::AsArray;
use arrow_array::{Array, RecordBatch};
use serde::Serialize;

use crate::kes::{Direction, HAND, Parameter, ValueStatus};
use crate::quantity::Moments;

/// What the name of the column of a status ends with.
const STATUS: &str = "_status";

/// Fewest parameters that two fabrics must share to be compared.
pub const FEWEST: usize = 3;

/// A value of a parameter in warp, in weft, and of the fabric as a whole; not a number where there is none.
type Sides = [f64; 3];

/// A fabric in the space.
pub(super) type Point = [Sides; HAND.len()];

/// In what of a parameter two fabrics can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compared {
    /// Nothing: one of them lacks it, or has a value that cannot be, or all of the library have the same.
    Nothing,
    /// The one direction that both have.
    In(Direction),
    /// The mean of warp and weft, or the value of the fabric as a whole.
    Whole,
}

/// How alike two fabrics are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Comparison {
    /// The root mean square, over the parameters that are compared, of their difference in standard deviations.
    pub distance: f64,
    /// Number of these parameters.
    pub count: u64,
    /// In what of each parameter they are compared.
    pub compared: [Compared; HAND.len()],
}

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

/// Name of the column of the status of another.
pub(super) fn status_column(name: &str) -> String {
    format!("{name}{STATUS}")
}

/// Whether a column is that of a status.
pub(super) fn is_of_status(name: &str) -> bool {
    name.ends_with(STATUS)
}

/// How the value in a column of a row was had.
pub(super) fn status(table: &RecordBatch, name: &str, row: usize) -> ValueStatus {
    let column = table.column_by_name(&status_column(name)).filter(|column| column.is_valid(row));
    let text = column.and_then(|column| Some(column.as_string_opt::<i32>()?.value(row)));
    text.and_then(ValueStatus::from_name).unwrap_or_default()
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
    sources.each_ref().map(|sides| sides.each_ref().map(|source| value(source).unwrap_or(f64::NAN)))
}

/// Where a fabric stands among others: by the mean of warp and weft, or the one that is known, else by the value of the
/// fabric as a whole.
fn coordinate(sides: Sides, log10: bool) -> f64 {
    let [warp, weft, whole] = sides;
    let known = [f64::midpoint(warp, weft), warp, weft, whole].into_iter().find(|value| !value.is_nan());
    scaled(known.unwrap_or(f64::NAN), log10)
}

/// A value that is not above 0 has no logarithm and is not compared.
fn scaled(value: f64, log10: bool) -> f64 {
    match log10 {
        false => value,
        true if value > 0.0 => value.log10(),
        true => f64::NAN,
    }
}

/// The value of both directions together.
fn whole([warp, weft, whole]: Sides) -> f64 {
    let mean = f64::midpoint(warp, weft);
    if mean.is_nan() { whole } else { mean }
}

/// What is like in like: means of both directions, or the direction that both have where one of them lacks the other,
/// for a fabric that was measured in warp says nothing of weft.
fn difference(a: Sides, b: Sides, log10: bool) -> (f64, Compared) {
    let known = [a, b].map(|sides| [sides[0], sides[1]].map(|value| !value.is_nan()));
    let (x, y, compared) = match (known[0][0] && known[1][0], known[0][1] && known[1][1]) {
        (true, false) => (a[0], b[0], Compared::In(Direction::Warp)),
        (false, true) => (a[1], b[1], Compared::In(Direction::Weft)),
        _ => (whole(a), whole(b), Compared::Whole),
    };
    let difference = scaled(x, log10) - scaled(y, log10);
    if difference.is_finite() { (difference, compared) } else { (0.0, Compared::Nothing) }
}

/// Whether a fabric has any value of a parameter, whatever it is.
pub(super) fn has(sides: Sides) -> bool {
    sides.iter().any(|value| !value.is_nan())
}

/// Whether it has a value that can be compared.
pub(super) fn can_be_compared(sides: Sides, axis: &Axis) -> bool {
    coordinate(sides, axis.log10).is_finite()
}

impl Usual {
    /// Counts a fabric.
    pub fn add(&mut self, point: &Point) {
        for ((moments, sides), (_, log10)) in self.0.iter_mut().zip(point).zip(HAND) {
            let value = coordinate(*sides, log10);
            if value.is_finite() {
                moments.add(value);
            }
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

impl Axis {
    /// Whether fabrics of the library differ in it: their standard deviation, where it is more than nothing.
    pub(super) fn spread(&self) -> Option<f64> {
        self.sd.filter(|sd| *sd > 0.0)
    }
}

/// How alike two fabrics are.
pub(super) fn compare(a: &Point, b: &Point, axes: &[Axis]) -> Comparison {
    let (mut sum, mut count, mut compared) = (0.0, 0, [Compared::Nothing; HAND.len()]);
    for (at, axis) in axes.iter().enumerate().take(HAND.len()) {
        let Some(sd) = axis.spread() else { continue };
        let (difference, by) = difference(a[at], b[at], axis.log10);
        compared[at] = by;
        if by != Compared::Nothing {
            sum += (difference / sd).powi(2);
            count += 1;
        }
    }
    Comparison { distance: (sum / count as f64).sqrt(), count, compared }
}

/// The columns of values of a fabric that a comparison with it rests on.
pub(super) fn rests_on(point: &Point, comparison: &Comparison) -> Vec<String> {
    let mut names = Vec::new();
    for (((parameter, _), sides), compared) in HAND.iter().zip(point).zip(comparison.compared) {
        let [warp, weft, whole] = columns(*parameter);
        match compared {
            Compared::Nothing => {}
            Compared::In(Direction::Warp) => names.push(warp),
            Compared::In(_) => names.push(weft),
            Compared::Whole if f64::midpoint(sides[0], sides[1]).is_nan() => names.push(whole),
            Compared::Whole => names.extend([warp, weft]),
        }
    }
    names
}

/// What a fabric has that another was not compared in: parameters, or columns where the other has but one direction.
pub(super) fn not_compared(target: &Point, comparison: &Comparison) -> Vec<String> {
    let mut names = Vec::new();
    for (((parameter, _), sides), compared) in HAND.iter().zip(target).zip(comparison.compared) {
        let [warp, weft, _] = columns(*parameter);
        match compared {
            Compared::Nothing if has(*sides) => names.push(column(parameter.symbol(), None)),
            Compared::In(Direction::Warp) if !sides[1].is_nan() => names.push(weft),
            Compared::In(Direction::Weft) if !sides[0].is_nan() => names.push(warp),
            _ => {}
        }
    }
    names
}

/// Values by the names of their columns.
pub(super) type Values = BTreeMap<String, f64>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coordinate_is_the_mean_of_two_directions_and_its_logarithm() {
        let none = f64::NAN;
        assert_eq!(coordinate([1.0, 3.0, 9.0], false), 2.0);
        assert_eq!(coordinate([none, 100.0, none], true), 2.0);
        assert_eq!(coordinate([none, none, 10.0], true), 1.0);
        assert!(coordinate([0.0, none, none], true).is_nan());
        assert!(coordinate([none; 3], false).is_nan());
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
        let far = compare(&points[0], &points[2], &axes);
        assert_eq!((far.distance, far.count), (2.0, 1));
        assert_eq!(rests_on(&points[0], &far), ["T0"]);
        assert_eq!(not_compared(&points[0], &far), ["B"], "all have the same");
    }

    #[test]
    fn like_is_compared_with_like() {
        let none = f64::NAN;
        let (both, warp, weft, whole) =
            ([10.0, 1000.0, none], [10.0, none, none], [none, 1000.0, none], [none, none, 505.0]);
        let in_warp = Compared::In(Direction::Warp);
        for (a, b, expected) in [
            (both, both, (0.0, Compared::Whole)),
            // The same in everything that was measured of both.
            (both, warp, (0.0, in_warp)),
            (weft, both, (0.0, Compared::In(Direction::Weft))),
            (warp, [100.0, none, none], (-1.0, in_warp)),
            // One value for both directions is their mean.
            (whole, both, (0.0, Compared::Whole)),
            // One direction says nothing of the other, nor of both.
            (warp, weft, (0.0, Compared::Nothing)),
            (warp, whole, (0.0, Compared::Nothing)),
            ([-0.3, none, none], both, (0.0, Compared::Nothing)),
            ([-20.0, 10.0, none], both, (0.0, Compared::Nothing)),
        ] {
            assert_eq!(difference(a, b, true), expected, "{a:?} {b:?}");
        }
        let mut points = [[[none; 3]; HAND.len()]; 2];
        (points[0][3], points[1][3]) = (both, warp);
        let comparison = Comparison {
            distance: 0.0,
            count: 1,
            compared: std::array::from_fn(|at| if at == 3 { in_warp } else { Compared::Nothing }),
        };
        assert_eq!(not_compared(&points[0], &comparison), ["B_weft"]);
        assert_eq!(not_compared(&points[1], &comparison), [""; 0]);
        assert_eq!(rests_on(&points[0], &comparison), ["B_warp"]);
    }
}
