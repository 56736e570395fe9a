//! Simulated against measured: the same abscissae, the usual figures of merit.

use serde::Serialize;

use super::virtual_test::VirtualCurve;
use crate::characterise::{Branch, FabricSheet, SpecimenResult};
use crate::instrument::{Direction, Test};
use crate::quantity::Curve;

/// A simulated curve against all measured samples of one fabric, test and direction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// E.g. `bending warp`.
    pub name: String,
    /// Which test.
    pub test: Test,
    /// Direction; `None` for compression.
    pub direction: Option<Direction>,
    /// Root mean square of simulated - measured (SI of the ordinate).
    pub rmse: f64,
    /// RMSE over the span of the measured ordinates.
    pub nrmse: f64,
    /// 1 - SS_residual / SS_total.
    pub r2: f64,
    /// Number of samples compared.
    pub n: usize,
    /// SI unit of the ordinate.
    pub unit: &'static str,
    /// Simulated ordinates at the measured abscissae.
    pub simulated: Curve,
    /// Measured samples, corrected, all specimens one after the other.
    pub measured: Curve,
}

/// All corrected samples of a test in a direction; empty when only a table is known.
pub fn measured_curve(sheet: &FabricSheet, test: Test, direction: Option<Direction>) -> Curve {
    Curve::from_points(measured_branches(sheet, test, direction).flat_map(|b| b.curve.points()))
}

fn measured_branches(
    sheet: &FabricSheet,
    test: Test,
    direction: Option<Direction>,
) -> impl Iterator<Item = &Branch> {
    let is_of_test =
        move |s: &&SpecimenResult| s.measurement.test == test && s.measurement.direction == direction;
    sheet.specimens.iter().filter(is_of_test).flat_map(|s| &s.branches)
}

/// Compares a simulated test with the sheet's samples; `None` when there are fewer than two.
pub fn compare_curves(sheet: &FabricSheet, simulated: &VirtualCurve) -> Option<Comparison> {
    let measured = measured_curve(sheet, simulated.test, simulated.direction);
    if measured.len() < 2 {
        return None;
    }
    let n = measured.len();
    // A cycle has its own ordinates for the way out and the way back.
    let at = |outgoing: bool, x: f64| match &simulated.cycle {
        Some(cycle) => cycle.at(outgoing, x),
        None => simulated.at(x),
    };
    let branches = measured_branches(sheet, simulated.test, simulated.direction);
    let ours = Curve::from_points(branches.flat_map(|b| b.curve.x.iter().map(|&x| (x, at(b.outgoing, x)))));
    let residual: f64 = ours.y.iter().zip(&measured.y).map(|(s, m)| (s - m) * (s - m)).sum();
    let mean = measured.y.iter().sum::<f64>() / n as f64;
    let total: f64 = measured.y.iter().map(|m| (m - mean) * (m - mean)).sum();
    let low = measured.y.iter().copied().fold(f64::INFINITY, f64::min);
    let high = measured.y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let rmse = (residual / n as f64).sqrt();
    let name = match simulated.direction {
        Some(direction) => format!("{} {direction}", simulated.test.name()),
        None => simulated.test.name().to_string(),
    };
    let [_, unit] = simulated.test.axes();
    Some(Comparison {
        name,
        test: simulated.test,
        direction: simulated.direction,
        rmse,
        nrmse: rmse / (high - low),
        r2: 1.0 - residual / total,
        n,
        unit,
        simulated: ours,
        measured,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::Measurement;
    use approx::assert_relative_eq;

    /// y = 2 x measured, y = 3 x simulated on x = 0, 1, 2: residuals 0, 1, 2 by hand.
    #[test]
    fn figures_of_merit_by_hand() {
        let curve = Curve::from_points([(0.0, 0.0), (1.0, 2.0), (2.0, 4.0)]);
        let specimen = SpecimenResult {
            measurement: Measurement::of_curve(Test::Bending, Some(Direction::Warp), 1, curve.clone()),
            branches: vec![Branch { cycle: 0, outgoing: true, curve }],
            correction: [0.0; 2],
            windows: Vec::new(),
            fits: Vec::new(),
            values: Default::default(),
            moduli: Default::default(),
        };
        let sheet = FabricSheet { specimens: vec![specimen], ..Default::default() };
        let line = VirtualCurve::line(Test::Bending, Some(Direction::Warp), 3.0);
        let c = compare_curves(&sheet, &line).unwrap();
        assert_eq!((c.n, c.name.as_str()), (3, "bending warp"));
        assert_relative_eq!(c.rmse, (5.0f64 / 3.0).sqrt());
        assert_relative_eq!(c.nrmse, (5.0f64 / 3.0).sqrt() / 4.0);
        assert_relative_eq!(c.r2, 1.0 - 5.0 / 8.0);
        let weft = VirtualCurve::line(Test::Bending, Some(Direction::Weft), 3.0);
        assert_eq!(compare_curves(&sheet, &weft), None);
    }
}
