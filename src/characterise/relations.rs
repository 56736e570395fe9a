//! K059: values of one fabric that do not go together.

use super::FabricSheet;
use crate::finding::{EvaluationFact, Finding};
use crate::instrument::{FabricInput, Test};
use crate::kes::{Direction, Key, Relation};

/// A finding for each relation that the values of a direction do not obey. It points at the first cell of a table that
/// gave one of them.
pub(super) fn relations(sheet: &FabricSheet, input: &FabricInput) -> Vec<Finding> {
    let directions = [Direction::Warp, Direction::Weft, Direction::Bias].map(Some);
    let each = directions.into_iter().chain([None]).flat_map(|direction| {
        Relation::ALL.into_iter().filter_map(move |relation| broken(sheet, relation, direction))
    });
    each.map(|(relation, keys, ratio)| {
        let cell = keys.iter().find_map(|key| {
            let mean = sheet.values.get(key)?.mean;
            input
                .results
                .iter()
                .find(|r| (r.parameter, r.direction, r.mean) == (key.parameter, key.direction, mean))
        });
        let fact = EvaluationFact::NotTogether { relation, keys, ratio };
        Finding { place: cell.map(|cell| cell.place.clone()), fact: fact.into() }
    })
    .collect()
}

/// The keys and the ratio of a relation that does not hold; `None` where it does, or where a value is not known.
fn broken(
    sheet: &FabricSheet,
    relation: Relation,
    direction: Option<Direction>,
) -> Option<(Relation, Vec<Key>, f64)> {
    let keys: Vec<Key> =
        relation.parameters().iter().map(|&parameter| Key { parameter, direction }).collect();
    let means = keys.iter().map(|key| Some(sheet.values.get(key)?.mean)).collect::<Option<Vec<f64>>>()?;
    let maximum = |test| sheet.conditions(test, direction).maximum;
    let ratio = match (relation, means.as_slice()) {
        (Relation::TensileEnergy, [wt, lt, emt]) => wt / (0.5 * lt * maximum(Test::Tensile) * emt),
        (Relation::CompressionEnergy, [wc, lc, t0, tm]) => {
            wc / (0.5 * lc * maximum(Test::Compression) * (t0 - tm))
        }
        (Relation::Compressibility, [emc, t0, tm]) => emc * t0 / (t0 - tm),
        (Relation::ResidualCurvature, [hb, b]) => 0.5 * hb / b / maximum(Test::Bending),
        (Relation::ResidualAngle, [hg, g]) => 0.5 * hg / g / maximum(Test::Shear),
        (_, [first, second]) => first / second,
        _ => return None,
    };
    let [low, high] = relation.range();
    // A ratio that is no number comes of a zero, which is implausible itself, or of T0 = Tm, which their own ratio tells.
    (ratio.is_finite() && !(low..=high).contains(&ratio)).then_some((relation, keys, ratio))
}

#[cfg(test)]
mod tests {
    use super::super::Settings;
    use super::*;
    use crate::finding::Place;
    use crate::instrument::{Parameter, ResultValue};

    /// A poplin as tables give it (KES units), with one value times a factor.
    fn findings(slip: Option<(Parameter, f64)>) -> Vec<(Relation, f64)> {
        use Parameter as P;
        let values = [
            (P::Lt, 0.7),
            (P::Wt, 8.75),
            (P::Emt, 5.0),
            (P::Rt, 55.0),
            (P::G, 0.8),
            (P::Hg, 1.0),
            (P::Hg5, 2.2),
            (P::B, 0.08),
            (P::Hb, 0.06),
            (P::Lc, 0.35),
            (P::Wc, 0.175),
            (P::Rc, 50.0),
            (P::T0, 0.5),
            (P::Tm, 0.3),
            (P::Miu, 0.16),
            (P::Mmd, 0.02),
            (P::Smd, 4.0),
            (P::W, 13.0),
        ];
        let results = values.iter().enumerate().map(|(column, (parameter, value))| {
            let factor = slip.filter(|(of, _)| of == parameter).map_or(1.0, |(_, factor)| factor);
            ResultValue {
                parameter: *parameter,
                direction: parameter.is_directional().then_some(Direction::Warp),
                mean: factor * value * parameter.kes_factor(),
                sd: None,
                n: 1,
                values: Vec::new(),
                lines: Vec::new(),
                status: Default::default(),
                place: Place::at("table.csv", 2, column + 1),
            }
        });
        let input = FabricInput { name: "a".into(), results: results.collect(), ..FabricInput::default() };
        let sheet = super::super::characterise(&input, &Settings::default());
        relations(&sheet, &input)
            .into_iter()
            .map(|finding| match finding.fact {
                crate::finding::Fact::Evaluation(EvaluationFact::NotTogether { relation, ratio, .. }) => {
                    assert!(finding.place.is_some());
                    (relation, ratio)
                }
                other => panic!("{other:?}"),
            })
            .collect()
    }

    #[test]
    fn a_fabric_obeys_them_and_a_slip_of_a_unit_does_not() {
        assert_eq!(findings(None), []);
        let slips = [
            (Parameter::Wt, 0.1, Relation::TensileEnergy),
            (Parameter::Emt, 10.0, Relation::TensileEnergy),
            (Parameter::Wc, 10.0, Relation::CompressionEnergy),
            (Parameter::Tm, 10.0, Relation::CompressedThickness),
            (Parameter::Hb, 1000.0, Relation::ResidualCurvature),
            (Parameter::B, 0.01, Relation::ResidualCurvature),
            (Parameter::Hg, 9.80665, Relation::ShearHysteresis),
            (Parameter::Hg, 0.01, Relation::ShearHysteresis),
            (Parameter::W, 10.0, Relation::Density),
            (Parameter::T0, 0.1, Relation::Density),
            (Parameter::Mmd, 10.0, Relation::FrictionDeviation),
            // Tm = T0, a cloth that nothing compresses: a column that was copied.
            (Parameter::Tm, 0.5 / 0.3, Relation::CompressedThickness),
        ];
        for (parameter, factor, relation) in slips {
            let found = findings(Some((parameter, factor)));
            assert!(found.iter().any(|(of, _)| *of == relation), "{parameter:?} × {factor}: {found:?}");
        }
    }
}
