//! References: central differences of the section itself, which knows nothing of derivatives.

use super::super::section;
use super::*;
use crate::characterise::{FabricSheet, Key};
use crate::instrument::{Direction, Parameter};
use crate::quantity::BendingRigidity;
use approx::assert_relative_eq;

const WARP: Option<Direction> = Some(Direction::Warp);
const WEFT: Option<Direction> = Some(Direction::Weft);
const BIAS: Option<Direction> = Some(Direction::Bias);

fn five(mean: f64, cv: f64) -> Estimate {
    Estimate { mean, sd: Some(cv * mean), n: 5, values: vec![] }
}

/// Every input has its own value and spread; B at 45° is consistent with D12 up to 0.5 √(B1 B2).
fn cloth() -> FabricSheet {
    let mut sheet = FabricSheet { name: "cloth".into(), ..FabricSheet::default() };
    for (parameter, direction, mean) in [
        (Parameter::B, WARP, 8e-6),
        (Parameter::B, WEFT, 4e-6),
        (Parameter::B, BIAS, 9e-6),
        (Parameter::G, WARP, 50.0),
        (Parameter::G, WEFT, 54.0),
        (Parameter::T0, None, 5e-4),
        (Parameter::W, None, 0.15),
    ] {
        sheet.values.insert(Key { parameter, direction }, five(mean, 0.05));
    }
    for (direction, e) in [(Direction::Warp, 3000.0), (Direction::Weft, 1000.0)] {
        sheet.moduli.insert(("tangent_low".into(), direction), five(e, 0.1));
    }
    sheet
}

/// The estimate behind the name of an input.
fn estimate_mut<'a>(sheet: &'a mut FabricSheet, name: &str) -> &'a mut Estimate {
    let direction = [("warp", Direction::Warp), ("weft", Direction::Weft), ("bias", Direction::Bias)]
        .into_iter()
        .find_map(|(word, d)| name.ends_with(word).then_some(d));
    if let ("E", Some(d)) = (&name[..1], direction) {
        return sheet.moduli.get_mut(&("tangent_low".into(), d)).unwrap();
    }
    let parameter = match &name[..1] {
        "B" => Parameter::B,
        "G" => Parameter::G,
        "t" => Parameter::T0,
        _ => Parameter::W,
    };
    sheet.values.get_mut(&Key { parameter, direction }).unwrap()
}

fn differences_agree(sheet: &FabricSheet, assumptions: &Assumptions) {
    let c = section(sheet, assumptions).unwrap();
    for input in &c.inputs {
        // Truncation h²/6 and rounding 1e-16/h are both below 1e-9.
        let h = 1e-5f64;
        let at = |by: f64| {
            let mut changed = sheet.clone();
            estimate_mut(&mut changed, &input.name).mean *= by.exp();
            section(&changed, assumptions).unwrap().section
        };
        let (up, down, d) = (at(h), at(-h), &input.derivative);
        let slope = |a: f64, b: f64| (a - b) / (2.0 * h);
        for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
            let entry_slope = |m: &Matrix3<f64>, n: &Matrix3<f64>| slope(m[(i, j)], n[(i, j)]);
            assert_relative_eq!(
                d.d_m[(i, j)],
                entry_slope(&up.d_m, &down.d_m),
                max_relative = 1e-8,
                epsilon = 1e-5
            );
            assert_relative_eq!(
                d.d_b[(i, j)],
                entry_slope(&up.d_b, &down.d_b),
                max_relative = 1e-8,
                epsilon = 1e-14
            );
        }
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let expected = slope(up.d_s[(i, j)], down.d_s[(i, j)]);
            assert_relative_eq!(d.d_s[(i, j)], expected, max_relative = 1e-8, epsilon = 1e-6);
        }
        let expected = slope(up.areal_density, down.areal_density);
        assert_relative_eq!(d.areal_density, expected, max_relative = 1e-8, epsilon = 1e-9);
    }
}

#[test]
fn derivatives_agree_with_differences_for_every_choice() {
    let value = |v| BendingRigidity(v);
    for poisson_rule in [PoissonRule::Geometric, PoissonRule::Major, PoissonRule::Zero] {
        for torsion in
            [Torsion::Huber, Torsion::Bias, Torsion::Shear, Torsion::Neglect, Torsion::Value(value(2e-6))]
        {
            for bending_coupling in [BendingCoupling::Poisson(0.2), BendingCoupling::Value(value(1e-6))] {
                for transverse_shear in
                    [TransverseShear::InPlane, TransverseShear::Value(crate::quantity::LineForce(400.0))]
                {
                    let rest = Assumptions { poisson_rule, torsion, ..Assumptions::default() };
                    differences_agree(&cloth(), &Assumptions { bending_coupling, transverse_shear, ..rest });
                }
            }
        }
    }
}

#[test]
fn one_value_for_both_directions_is_one_input() {
    let mut sheet = cloth();
    sheet.values.retain(|k, _| k.parameter != Parameter::B);
    sheet.values.insert(Key { parameter: Parameter::B, direction: None }, five(6e-6, 0.05));
    differences_agree(&sheet, &Assumptions::default());
    let c = section(&sheet, &Assumptions::default()).unwrap();
    let names: Vec<_> = c.inputs.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["G warp", "G weft", "thickness", "E warp", "E weft", "B", "areal density"]);
}

#[test]
fn entries_carry_the_relative_spread_of_what_they_are_made_of() {
    let c = section(&cloth(), &Assumptions::default()).unwrap();
    let all = entries(&c.section, &c.inputs);
    let entry = |matrix: &str, row, column| {
        let mut entries = all.iter();
        let found = entries.find(|e| (e.matrix.as_ref(), e.row, e.column) == (matrix, row, column)).unwrap();
        (found.value, found.bands.unwrap().mean_fabric)
    };
    let root5 = 5f64.sqrt();
    let (b1, band) = entry("d_b", 1, 1);
    assert_relative_eq!(band.standard / b1, 0.05 / root5, max_relative = 1e-12);
    // H = √(B1 B2)/2: half of each.
    let (h, band) = entry("d_b", 3, 3);
    assert_relative_eq!(band.standard / h, 0.5 * 2f64.sqrt() * 0.05 / root5, max_relative = 1e-12);
    assert_relative_eq!(band.degrees_of_freedom, 8.0, max_relative = 1e-9);
    let (g, band) = entry("d_m", 3, 3);
    let expected = 0.05 * 50f64.hypot(54.0) / 104.0 / root5;
    assert_relative_eq!(band.standard / g, expected, max_relative = 1e-12);
}

#[test]
fn a_table_without_spread_gives_no_band_and_says_which_input_lacks_it() {
    let mut sheet = cloth();
    let b = sheet.values.get_mut(&Key { parameter: Parameter::B, direction: WEFT }).unwrap();
    *b = Estimate::single(b.mean);
    let c = section(&sheet, &Assumptions::default()).unwrap();
    for e in entries(&c.section, &c.inputs) {
        let lacks = e.matrix == "d_b" && (e.row, e.column) != (1, 1);
        assert_eq!(e.bands.is_none(), lacks, "{e:?}");
        assert_eq!(e.without_spread, if lacks { vec!["B weft"] } else { vec![] });
    }
}
