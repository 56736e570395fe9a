//! Fabrics of a table of curves: a row a point, as `kesf read` writes it.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::finding::errors;
use crate::instrument::{Direction, FabricInfo, FabricInput, Measurement, Origin, Source, Test};
use crate::quantity::{Curve, Unit};
use crate::report::table::{CurveRow, UnitSystem, curve_units};

errors! {
    /// Why a table of curves gives no fabrics.
    #[derive(Clone, Debug, PartialEq)]
    pub enum CurveTableError {
        /// O073: a row that is no point of a curve.
        "O073" Row {
            /// Name of the fabric.
            fabric: String,
            /// Number of the row, from 1.
            row: usize,
            /// What was found, and what was expected.
            problem: String,
        } = "row {row} of the table of curves ({fabric}): {problem}"
            => "write the columns as `kesf read -o curves.csv` and batch.curves() do";
    }
}

/// Fewest points of a curve.
const FEWEST: usize = 3;

/// A curve by its place among those of a fabric.
type Name = (Test, Option<Direction>, u64);

/// Index, row, abscissa and ordinate of points.
type Points = Vec<(u64, usize, f64, f64)>;

/// The fabrics of a table of curves, in order of names. A table does not say how wide a specimen was or what its test
/// was set to: the conditions are the standard ones of KES.
///
/// # Errors
/// [`CurveTableError`] with the number of the row.
pub fn fabrics_of_curves(rows: &[CurveRow]) -> Result<Vec<FabricInput>, CurveTableError> {
    let mut fabrics: BTreeMap<&str, BTreeMap<Name, Points>> = BTreeMap::new();
    let mut origins: BTreeMap<&str, Origin> = BTreeMap::new();
    for (at, row) in rows.iter().enumerate() {
        let failed =
            |problem: String| CurveTableError::Row { fabric: row.fabric.clone(), row: at + 1, problem };
        let (name, x, y) = point(row).map_err(failed)?;
        fabrics.entry(&row.fabric).or_default().entry(name).or_default().push((row.index, at + 1, x, y));
        let origin = origin(row).map_err(failed)?;
        if *origins.entry(&row.fabric).or_insert(origin) != origin {
            return Err(failed(format!("the origin is {} here and another before", origin.name())));
        }
    }
    let named = fabrics.into_iter().zip(origins.into_values());
    named.map(|((name, curves), origin)| fabric(name, origin, curves)).collect()
}

/// Where the fabric of a row comes from; a table that does not say it is of measurements.
fn origin(row: &CurveRow) -> Result<Origin, String> {
    let Some(name) = &row.origin else { return Ok(Origin::default()) };
    Origin::from_name(name)
        .ok_or_else(|| format!("`{name}` is no origin; there are measured, published and synthetic"))
}

fn fabric(
    name: &str,
    origin: Origin,
    curves: BTreeMap<Name, Points>,
) -> Result<FabricInput, CurveTableError> {
    let source = Source { path: PathBuf::from(name), ..Source::default() };
    let mut measurements = Vec::new();
    for ((test, direction, specimen), mut points) in curves {
        points.sort_by_key(|point| point.0);
        let (first, count) = (points[0].1, points.len());
        let failed = |row: usize, problem: String| CurveTableError::Row { fabric: name.into(), row, problem };
        if count < FEWEST {
            return Err(failed(
                first,
                format!("a {} curve has {count} points where {FEWEST} are needed", test.name()),
            ));
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(failed(pair[1].1, format!("index {} is there twice", pair[1].0)));
        }
        let curve = Curve {
            x: points.iter().map(|point| point.2).collect(),
            y: points.iter().map(|point| point.3).collect(),
        };
        measurements.push(Measurement {
            lines: points.iter().map(|point| point.1).collect(),
            source: source.clone(),
            ..Measurement::of_curve(test, direction, specimen as usize, curve)
        });
    }
    let path = PathBuf::from(name);
    let info = FabricInfo { origin, ..FabricInfo::default() };
    Ok(FabricInput {
        name: name.into(),
        path,
        info,
        measurements,
        sources: vec![source],
        ..FabricInput::default()
    })
}

/// The curve and the point of a row in SI, or what is wrong with it.
fn point(row: &CurveRow) -> Result<(Name, f64, f64), String> {
    let test = Test::ALL.into_iter().find(|test| test.name() == row.test);
    let names = || Test::ALL.map(Test::name).join(", ");
    let test = test.ok_or_else(|| format!("`{}` is no test; there are {}", row.test, names()))?;
    let direction = match row.direction.as_deref() {
        None if !test.is_directional() => None,
        Some(_) if !test.is_directional() => return Err(format!("{} has no direction", test.name())),
        None => {
            return Err(format!(
                "a {} curve has no direction where warp, weft or bias was expected",
                test.name()
            ));
        }
        Some(name) => Some(
            Direction::ALL
                .into_iter()
                .find(|direction| direction.name() == name)
                .ok_or_else(|| format!("`{name}` is no direction; there are warp, weft and bias"))?,
        ),
    };
    if row.specimen == 0 {
        return Err("specimens count from 1, and this is 0".into());
    }
    let [x, y] = curve_units(test, UnitSystem::Si);
    let x = in_si(row.x, &row.x_unit, x.0)?;
    let y = in_si(row.y, &row.y_unit, y.0)?;
    Ok(((test, direction, row.specimen), x, y))
}

fn in_si(value: f64, unit: &str, expected: &str) -> Result<f64, String> {
    if !value.is_finite() {
        return Err(format!("{value} is no number of a curve"));
    }
    let wanted = Unit::parse(expected).map_err(|e| e.to_string())?;
    match Unit::parse(unit) {
        Ok(found) if found.dimension == wanted.dimension => Ok(value * found.factor),
        _ => Err(format!("the unit is `{unit}` where one such as {expected} was expected")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(index: u64) -> CurveRow {
        CurveRow {
            fabric: "cloth".into(),
            test: "bending".into(),
            direction: Some("warp".into()),
            specimen: 1,
            index,
            x: index as f64,
            x_unit: "1/cm".into(),
            y: 0.1 * index as f64,
            y_unit: "gf·cm/cm".into(),
            origin: None,
        }
    }

    #[test]
    fn what_was_made_by_a_generator_stays_so() {
        let origin = |origin: Option<&str>| {
            let rows = [0, 1, 2].map(|index| CurveRow { origin: origin.map(Into::into), ..row(index) });
            fabrics_of_curves(&rows).unwrap()[0].info.origin
        };
        assert_eq!((origin(Some("synthetic")), origin(None)), (Origin::Synthetic, Origin::Measured));
    }

    #[test]
    fn curves_come_in_si_and_in_order() {
        let fabrics = fabrics_of_curves(&[row(2), row(0), row(1)]).unwrap();
        let curve = &fabrics[0].measurements[0].curve;
        // 1 1/cm is 100 1/m, and 0.1 gf·cm/cm is 0.000980665 N.
        assert_eq!(curve.x, [0.0, 100.0, 200.0]);
        assert!((curve.y[1] - 9.80665e-4).abs() < 1e-15);
        assert_eq!(fabrics[0].measurements[0].lines, [2, 3, 1]);
    }

    #[test]
    fn rows_that_are_no_points_are_told() {
        let wrong_at = |place: usize, change: fn(&mut CurveRow), problem: &str| {
            let mut rows = [row(0), row(1), row(2)];
            change(&mut rows[2]);
            let text = fabrics_of_curves(&rows).unwrap_err().to_string();
            let begins = format!("O073 row {place} of the table of curves (cloth)");
            assert!(text.contains(&begins) && text.contains(problem), "{text}");
        };
        let wrong = |change: fn(&mut CurveRow), problem: &str| wrong_at(3, change, problem);
        wrong(|row| row.test = "bendng".into(), "`bendng` is no test");
        wrong(|row| row.direction = None, "no direction where warp");
        wrong(|row| row.direction = Some("up".into()), "`up` is no direction");
        wrong(|row| row.specimen = 0, "specimens count from 1");
        // Two of the three points are left to the first specimen, whose curve begins in row 1.
        wrong_at(1, |row| row.specimen = 2, "2 points where 3 are needed");
        wrong(|row| row.x = f64::NAN, "no number of a curve");
        wrong(|row| row.x_unit = "gf".into(), "the unit is `gf` where one such as 1/m");
        wrong(|row| row.index = 1, "index 1 is there twice");
        wrong(|row| row.test = "compression".into(), "compression has no direction");
        wrong(|row| row.origin = Some("guessed".into()), "`guessed` is no origin");
        wrong(|row| row.origin = Some("synthetic".into()), "the origin is synthetic here and another before");
    }
}
