//! References: Hencky's series for a clamped plate, differences of whole solutions, and Monte Carlo.

use std::path::Path;

use approx::assert_relative_eq;
use nalgebra::{Matrix2, Matrix3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use statrs::distribution::{ContinuousCDF, Normal};

use super::super::{Case, CaseResult, PreparedCase, build};
use super::*;
use crate::analytical::Plate;
use crate::characterise::{FabricSheet, Key, ValueStatus};
use crate::constitutive::{Assumptions, InputSource, section};
use crate::instrument::{Direction, Parameter};
use crate::quantity::Estimate;
use crate::section::ShellSection;
use crate::solve::{Options, Plan, solve_with};

fn case(cells: usize, rest: &str) -> Case {
    let text = format!(
        "title = \"t\"\nfabric = \"*\"\n[sheet]\nshape = \"rectangle\"\nwidth = \"20 cm\"\nheight = \"20 cm\"\n\
         cells = [{cells}, {cells}]\n{rest}"
    );
    Case::parse(Path::new("case.toml"), &text).unwrap()
}

const CLAMPED: &str = "[[supports]]\nset = \"boundary\"\nkind = \"clamped\"\n\
                       [[loads]]\nkind = \"pressure\"\nvalue = \"2e-6 Pa\"\n";

/// Bent and stretched, under its weight, with a prescribed displacement, on a distorted mesh.
const MIXED: &str = "distortion = 0.3\nwarp_angle_deg = 20.0\n\
    [[supports]]\nset = \"left\"\nkind = \"clamped\"\n\
    [[loads]]\nkind = \"gravity\"\n\
    [[loads]]\nkind = \"edge_force\"\nset = \"right\"\nvalue = \"0.1 N/m\"\ndirection = [1.0, 0.4, 0.0]\n\
    [[loads]]\nkind = \"prescribed\"\nset = \"top\"\ndof = \"w\"\nvalue = \"1 mm\"\n\
    [[probes]]\nname = \"point\"\nat = [\"13 cm\", \"7 cm\"]\n";

fn solved(case: &Case, section: &ShellSection, inputs: &[MeasuredInput]) -> CaseResult {
    PreparedCase::new(case, &Options::default()).unwrap().solve_measured(section.clone(), inputs).unwrap()
}

fn input(name: &str, derivative: SectionDerivative) -> MeasuredInput {
    MeasuredInput {
        name: name.into(),
        estimate: Estimate::single(1.0),
        status: ValueStatus::Measured,
        source: InputSource::Shear,
        derivative,
    }
}

/// A bending stiffness D11, D22, D66 and each of them as an input, with the shear as a fourth.
fn plate([b1, b2, h]: [f64; 3]) -> (ShellSection, Vec<MeasuredInput>) {
    let section = ShellSection {
        d_m: Matrix3::new(6000.0, 900.0, 0.0, 900.0, 4000.0, 0.0, 0.0, 0.0, 50.0),
        d_b: Matrix3::from_diagonal(&[b1, b2, h].into()),
        d_s: Matrix2::identity() * 40.0,
        areal_density: 0.15,
        thickness: 4e-4,
    };
    let only = |i: usize| {
        let mut derivative = SectionDerivative::default();
        derivative.d_b[(i, i)] = section.d_b[(i, i)];
        derivative
    };
    let shear = SectionDerivative { d_s: section.d_s, ..SectionDerivative::default() };
    let inputs = vec![input("B1", only(0)), input("B2", only(1)), input("H", only(2)), input("shear", shear)];
    (section, inputs)
}

/// B1 : B2 = 1.45 and H = 0.45 √(B1 B2), a usual woven cloth. A deflection is homogeneous of
/// degree -1 in all stiffnesses, so the four sum to -1 but for the difference of the matrices.
#[test]
fn log_sensitivities_of_a_clamped_plate_are_those_of_henckys_series() {
    let rigidities = [10.15e-6, 7e-6, 0.45 * (10.15f64 * 7.0).sqrt() * 1e-6];
    let (section, inputs) = plate(rigidities);
    let result = solved(&case(24, CLAMPED), &section, &inputs);
    let uncertainty = result.uncertainty.unwrap();
    let w = uncertainty.of("w_max").unwrap();
    assert_relative_eq!(w.value, result.w_max);
    let logs: Vec<f64> = w.derivatives.iter().map(|d| d / w.value).collect();
    assert_relative_eq!(logs.iter().sum::<f64>(), -1.0, epsilon = 1e-7);
    assert!(logs[3].abs() < 1e-3, "cloth is shear-rigid: {logs:?}");
    for i in 0..3 {
        let deflection = |by: f64| {
            let mut b = rigidities;
            b[i] *= by;
            let plate = Plate { a: 0.2, b: 0.2, d11: b[0], d22: b[1], d12: 0.0, d66: b[2] };
            plate.clamped(1.0).unwrap().deflection(0.1, 0.1)
        };
        let series = (deflection(1.001) / deflection(0.999)).ln() / (1.001f64 / 0.999).ln();
        // The deflection itself is 0.2 % off at 24 x 24 elements.
        assert_relative_eq!(logs[i], series, epsilon = 2e-3);
    }
    // The same to three digits from an independent Ritz solution.
    for (log, ritz) in logs.iter().zip([-0.472, -0.314, -0.214]) {
        assert!((log - ritz).abs() < 2e-3, "{logs:?}");
    }
    // The energy of a load that stays is half its work: the same sum.
    let energy = uncertainty.of("strain_energy").unwrap();
    assert_relative_eq!(energy.derivatives.iter().sum::<f64>() / energy.value, -1.0, epsilon = 1e-7);
}

/// The measured cloth: five repeats of everything with a spread of 5 to 10 %.
fn cloth() -> FabricSheet {
    let five = |mean: f64, cv: f64| Estimate { mean, sd: Some(cv * mean), n: 5, values: vec![] };
    let mut sheet = FabricSheet { name: "cloth".into(), ..FabricSheet::default() };
    for (parameter, direction, mean, cv) in [
        (Parameter::B, Some(Direction::Warp), 8e-6, 0.08),
        (Parameter::B, Some(Direction::Weft), 4e-6, 0.1),
        (Parameter::G, Some(Direction::Warp), 50.0, 0.06),
        (Parameter::G, Some(Direction::Weft), 54.0, 0.05),
        (Parameter::T0, None, 5e-4, 0.02),
        (Parameter::W, None, 0.15, 0.03),
    ] {
        sheet.values.insert(Key { parameter, direction }, five(mean, cv));
    }
    for (direction, e) in [(Direction::Warp, 3000.0), (Direction::Weft, 1000.0)] {
        sheet.moduli.insert(("tangent_low".into(), direction), five(e, 0.1));
    }
    sheet
}

fn differences_agree(case: &Case) {
    let c = section(&cloth(), &Assumptions::default()).unwrap();
    let result = solved(case, &c.section, &c.inputs);
    let predictions = &result.uncertainty.as_ref().unwrap().predictions;
    assert_eq!(predictions.len(), 17, "w_max, in_plane_max, six components, eight resultants, energy");
    for (i, input) in c.inputs.iter().enumerate() {
        // Truncation h²/6 of the order of 1e-8; rounding of the solution 1e-10 over h.
        let h = 3e-4;
        let at = |by: f64| {
            let changed = solved(case, &input.derivative.step(&c.section, by), &c.inputs);
            changed.uncertainty.unwrap().predictions
        };
        for ((p, up), down) in predictions.iter().zip(at(h)).zip(at(-h)) {
            let slope = (up.value - down.value) / (2.0 * h);
            // A small component of a large field has the rounding of the field (1e-12 over h); resultants
            // are small differences of displacements and rotations, with a hundred times more.
            let same_unit = predictions.iter().filter(|q| q.unit == p.unit);
            let field = same_unit.map(|q| q.value.abs()).fold(0.0, f64::max);
            let rounding = if p.unit.starts_with('N') { 1e-6 } else { 1e-8 };
            let epsilon = f64::max(1e-6 * p.value.abs(), rounding * field);
            assert_relative_eq!(p.derivatives[i], slope, max_relative = 1e-6, epsilon = epsilon);
        }
    }
}

/// In the middle, beside a side, and in a corner, where patches are fitted.
#[test]
fn resultants_of_the_few_elements_around_a_point_are_those_of_the_field() {
    let probe = |name, at: [&str; 2]| format!("[[probes]]\nname = \"{name}\"\nat = {at:?}\n");
    let more = [probe("side", ["1 cm", "11 cm"]), probe("corner", ["20 cm", "20 cm"])].concat();
    let c = section(&cloth(), &Assumptions::default()).unwrap();
    let result = solved(&case(6, &format!("{MIXED}{more}")), &c.section, &c.inputs);
    let uncertainty = result.uncertainty.as_ref().unwrap();
    for p in &result.probes {
        for ((name, _), value) in Resultants::COMPONENTS.iter().zip(p.value.resultants.components()) {
            let near = uncertainty.of(&format!("{}.{name}", p.name)).unwrap().value;
            assert_relative_eq!(near, value, max_relative = 1e-10, epsilon = 1e-16);
        }
    }
}

/// The cloth is not the same along and across, and so no frequency repeats.
#[test]
fn derivatives_of_frequencies_agree_with_differences() {
    for mass in ["lumped", "consistent"] {
        let rest = format!(
            "[analysis]\nkind = \"modal\"\nmodes = 4\nmass = \"{mass}\"\n\
             [[supports]]\nset = \"boundary\"\nkind = \"clamped\"\n"
        );
        let case = case(6, &rest);
        let c = section(&cloth(), &Assumptions::default()).unwrap();
        let result = solved(&case, &c.section, &c.inputs);
        let predictions = &result.uncertainty.as_ref().unwrap().predictions;
        assert_eq!(predictions.len(), 4);
        for (i, input) in c.inputs.iter().enumerate() {
            let h = 3e-4;
            let at = |by: f64| solved(&case, &input.derivative.step(&c.section, by), &[]).frequencies;
            for (p, (up, down)) in predictions.iter().zip(at(h).into_iter().zip(at(-h))) {
                let slope = (up - down) / (2.0 * h);
                // The iteration leaves 1e-11 of an eigenvalue, over h.
                assert_relative_eq!(p.derivatives[i], slope, max_relative = 1e-6, epsilon = 1e-7 * p.value);
            }
        }
    }
}

#[test]
fn derivatives_agree_with_differences_of_whole_solutions() {
    differences_agree(&case(6, MIXED));
    let element = "[element]\ndrilling = \"hughes_brezzi\"\nshear_stabilisation = 0.0\n";
    differences_agree(&case(6, &format!("{MIXED}{element}")));
}

/// 4000 fabrics whose inputs are drawn around their means with their standard errors, each solved
/// anew. The SD of 4000 draws is known to 1/√8000 = 1.1 %; what is of second order adds about the
/// square of the spread (0.2 %): four standard errors are allowed.
#[test]
fn the_band_of_the_mean_fabric_agrees_with_monte_carlo() {
    const DRAWS: usize = 4000;
    let case = case(6, CLAMPED);
    let (sheet, assumptions, options) = (cloth(), Assumptions::default(), Options::default());
    let c = section(&sheet, &assumptions).unwrap();
    let result = solved(&case, &c.section, &c.inputs);
    let w_max = result.uncertainty.as_ref().unwrap().of("w_max").unwrap();
    let band = w_max.bands.unwrap().mean_fabric;

    let normal = Normal::new(0.0, 1.0).unwrap();
    let mut random = Pcg64Mcg::seed_from_u64(20);
    let mut draw = |e: &mut Estimate| {
        let z = normal.inverse_cdf(random.random_range(1e-12..1.0));
        e.mean *= (z * e.cv().unwrap() / (e.n as f64).sqrt()).exp();
    };
    let problem = case.sheet().unwrap();
    let mut model = build::model_on(&case, problem, &problem.sheet, c.section).unwrap();
    let plan = Plan::new(&model, &Plan::groups(&model, &options), options.path).unwrap();
    let values: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let mut drawn = sheet.clone();
            drawn.values.values_mut().chain(drawn.moduli.values_mut()).for_each(&mut draw);
            model.section = section(&drawn, &assumptions).unwrap().section;
            let u = solve_with(&model, &plan, &options).unwrap().displacement;
            u.iter().skip(2).step_by(6).copied().fold(0.0, |m: f64, w| if w.abs() > m.abs() { w } else { m })
        })
        .collect();
    let drawn = Estimate::of(&values).unwrap();
    assert_relative_eq!(drawn.mean, w_max.value, max_relative = 5e-3);
    assert_relative_eq!(drawn.sd.unwrap(), band.standard, max_relative = 4.0 / (2.0 * DRAWS as f64).sqrt());
    let [low, high] = w_max.mean_fabric().unwrap();
    assert!(low < w_max.value && w_max.value < high);
}

#[test]
fn an_input_without_spread_forbids_a_band_only_where_it_matters() {
    let mut sheet = cloth();
    let g = |direction| Key { parameter: Parameter::G, direction: Some(direction) };
    for direction in [Direction::Warp, Direction::Weft] {
        *sheet.values.get_mut(&g(direction)).unwrap() = Estimate::single(52.0);
    }
    let c = section(&sheet, &Assumptions::default()).unwrap();
    let deflection = |case: &Case, c: &crate::constitutive::Constitutive| {
        solved(case, &c.section, &c.inputs).uncertainty.unwrap().of("w_max").unwrap().clone()
    };
    let bent = deflection(&case(6, CLAMPED), &c);
    assert!(bent.bands.is_some() && bent.without_spread.is_empty(), "bending hardly depends on G");
    *sheet.values.get_mut(&Key { parameter: Parameter::B, direction: Some(Direction::Weft) }).unwrap() =
        Estimate::single(4e-6);
    let single = deflection(&case(6, CLAMPED), &section(&sheet, &Assumptions::default()).unwrap());
    assert_eq!((single.bands, single.without_spread), (None, vec!["B weft".to_string()]));
}
