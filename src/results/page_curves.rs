//! Curves of a fabric for the page.

use super::tested::Tested;
use crate::characterise::{FabricSheet, SpecimenResult};
use crate::instrument::Test;
use crate::report::html::{AxisEntry, Polyline, SimulatedLine, SpecimenCurves, TestCurves, shortened};

/// Tests with curves, in their order; the place of the fabric is for the caller to say.
pub(super) fn curves(sheet: &FabricSheet, simulated: &[Tested]) -> Vec<TestCurves> {
    let of_test = |test: Test| {
        let specimens: Vec<SpecimenCurves> =
            sheet.specimens.iter().filter(|s| s.measurement.test == test).map(specimen).collect();
        let simulated: Vec<SimulatedLine> = simulated
            .iter()
            .filter(|t| t.simulated.test == test && !t.curve.is_empty())
            .map(simulated_line)
            .collect();
        let axes = AxisEntry::of(test);
        let is_there = !(specimens.is_empty() && simulated.is_empty());
        is_there.then(|| TestCurves { fabric: 0, test: test.name().to_string(), axes, specimens, simulated })
    };
    Test::ALL.into_iter().filter_map(of_test).collect()
}

fn specimen(specimen: &SpecimenResult) -> SpecimenCurves {
    let measurement = &specimen.measurement;
    let branches = if specimen.branches.is_empty() {
        vec![Polyline::of(&measurement.curve)]
    } else {
        specimen.branches.iter().map(|b| Polyline::of(&b.curve)).collect()
    };
    let windows = specimen.windows.iter().map(|w| {
        (w.parameter.symbol().to_string(), [w.from, w.to].map(shortened), w.ordinates.map(shortened))
    });
    SpecimenCurves {
        direction: measurement.direction.map(|d| d.name().to_string()),
        specimen: measurement.specimen,
        branches,
        windows: windows.collect(),
    }
}

fn simulated_line(tested: &Tested) -> SimulatedLine {
    let how = if tested.simulated.cycle.is_some() { "with friction" } else { "elastic" };
    SimulatedLine {
        label: format!("simulated{}, {how}", tested.rests_on(" on ")),
        case: tested.case.clone(),
        direction: tested.simulated.direction.map(|d| d.name().to_string()),
        line: Polyline::of(&tested.curve),
    }
}
