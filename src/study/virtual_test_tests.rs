//! References: closed forms, published estimates, differences of whole solutions, and Monte Carlo.

use super::*;
use crate::characterise::ValueStatus;
use crate::constitutive::InputSource;
use approx::assert_relative_eq;
use nalgebra::{Matrix2, Matrix3};
use std::path::Path;

fn case(test: &str) -> Case {
    let text =
        format!("title = \"t\"\nfabric = \"*\"\n[virtual_test]\ntest = \"{test}\"\ncells = [10, 40]\n");
    Case::parse(Path::new("t.toml"), &text).unwrap()
}

fn fabric(nu: f64, nu_b: f64) -> ShellSection {
    let (e1, e2, f) = (6000.0f64, 3000.0f64, 1.0 / (1.0 - nu * nu));
    let d12 = nu * (e1 * e2).sqrt() * f;
    let (b1, b2) = (1e-5f64, 6e-6f64);
    let b12 = nu_b * (b1 * b2).sqrt();
    ShellSection {
        d_m: Matrix3::new(e1 * f, d12, 0.0, d12, e2 * f, 0.0, 0.0, 0.0, 60.0),
        d_b: Matrix3::new(b1, b12, 0.0, b12, b2, 0.0, 0.0, 0.0, 3e-6),
        d_s: Matrix2::identity() * 50.0,
        areal_density: 0.15,
        thickness: 4e-4,
    }
    .checked()
    .unwrap()
}

fn run(test: &str, direction: Direction, section: &ShellSection) -> VirtualCurve {
    let case = case(test);
    simulate(&case, case.specimen().unwrap(), direction, section).unwrap()
}

/// FB2 bends a 20 x 1 cm strip into a cylinder: M = D11 κ (analytical; exact without D12).
#[test]
fn bending_gives_the_rigidity_of_each_direction() {
    let s = fabric(0.3, 0.0);
    assert_relative_eq!(run("bending", Direction::Warp, &s).apparent, 1e-5, max_relative = 1e-8);
    assert_relative_eq!(run("bending", Direction::Weft, &s).apparent, 6e-6, max_relative = 1e-8);
    // With ν_b = 0.25 the free edges relax: 0.9998 D11 in an independent solution, 20 x 1 cm.
    let s = fabric(0.3, 0.25);
    assert_relative_eq!(run("bending", Direction::Warp, &s).apparent, 1e-5, max_relative = 1e-3);
}

/// FB1: clamps hold the contraction in two corners' reach. Reference: the published-form
/// estimate E_app/E1 = 1 + φ [1/(1-ν12 ν21) - 1], φ = 0.5 (W/L) √(G/E2), an approximation.
#[test]
fn tension_and_shear_carry_their_edge_effects() {
    let s = fabric(0.3, 0.0);
    let t = run("tensile", Direction::Warp, &s);
    let phi = 0.5 * (0.20 / 0.05) * (60.0f64 / 3000.0).sqrt();
    let estimate = 1.0 + phi * (1.0 / (1.0 - 0.09) - 1.0);
    assert_relative_eq!(t.ideal, 6000.0, max_relative = 1e-12);
    assert_relative_eq!(t.apparent / t.ideal, estimate, max_relative = 0.01);
    let g = run("shear", Direction::Warp, &s);
    let estimate = 1.0 - 0.54 * (0.05 / 0.20) * (60.0f64 / 6000.0).sqrt();
    assert_relative_eq!(g.apparent / g.ideal, estimate, max_relative = 0.01);
}

#[test]
fn without_contraction_tension_is_exact() {
    let t = run("tensile", Direction::Weft, &fabric(0.0, 0.0));
    assert_relative_eq!(t.apparent, 3000.0, max_relative = 1e-8);
}

/// Inputs that each scale one entry of the section: the bands are those of whole solutions, by Monte Carlo
/// (2000 draws of each mean, normal) and by differences.
#[test]
fn bands_agree_with_monte_carlo() {
    use crate::constitutive::SectionDerivative;
    use rand::{RngExt, SeedableRng};
    use statrs::distribution::{ContinuousCDF, Normal};
    let five = |mean: f64, cv: f64| Estimate { mean, sd: Some(cv * mean), n: 5, values: vec![] };
    let normal = Normal::standard();
    for (test, direction) in
        [("tensile", Direction::Warp), ("shear", Direction::Weft), ("bending", Direction::Warp)]
    {
        let section = fabric(0.3, 0.25);
        let section_derivative = |d_m: [f64; 4], d_b: [f64; 3]| {
            let mut d = SectionDerivative::default();
            let [e1, e2, e12, g] = d_m;
            let m = &section.d_m;
            d.d_m = Matrix3::new(
                e1 * m[(0, 0)],
                e12 * m[(0, 1)],
                0.0,
                e12 * m[(1, 0)],
                e2 * m[(1, 1)],
                0.0,
                0.0,
                0.0,
                g * m[(2, 2)],
            );
            d.d_b = Matrix3::from_diagonal(
                &[d_b[0] * section.d_b[(0, 0)], d_b[1] * section.d_b[(1, 1)], d_b[2] * section.d_b[(2, 2)]]
                    .into(),
            );
            d
        };
        let inputs: Vec<MeasuredInput> = [
            ("E warp", five(6000.0, 0.05), section_derivative([1.0, 0.0, 0.5, 0.0], [0.0; 3])),
            ("E weft", five(3000.0, 0.06), section_derivative([0.0, 1.0, 0.5, 0.0], [0.0; 3])),
            ("G", five(60.0, 0.08), section_derivative([0.0, 0.0, 0.0, 1.0], [0.0; 3])),
            ("B warp", five(1e-5, 0.07), section_derivative([0.0; 4], [1.0, 0.0, 0.0])),
            ("B weft", five(6e-6, 0.07), section_derivative([0.0; 4], [0.0, 1.0, 0.0])),
        ]
        .map(|(name, estimate, derivative)| MeasuredInput {
            name: name.into(),
            estimate,
            status: ValueStatus::Measured,
            source: InputSource::Shear,
            derivative,
        })
        .to_vec();
        let case = Case::parse(
            Path::new("t.toml"),
            &format!("title = \"t\"\nfabric = \"*\"\n[virtual_test]\ntest = \"{test}\"\ncells = [4, 6]\n"),
        )
        .unwrap();
        let spec = case.specimen().unwrap();
        let prepared = PreparedTest::new(&case, spec, &Options::default()).unwrap();
        let curve = prepared.simulate_measured(direction, &section, &Settings::default(), &inputs).unwrap();
        let prediction = curve.uncertainty.as_ref().unwrap();
        let apparent = |steps: &[f64]| {
            let mut section = section.clone();
            for (input, step) in inputs.iter().zip(steps) {
                section = input.derivative.step(&section, *step);
            }
            prepared.simulate(direction, &section, &Settings::default()).unwrap().apparent
        };
        for (k, derivative) in prediction.derivatives.iter().enumerate() {
            let at = |by: f64| apparent(&(0..5).map(|i| if i == k { by } else { 0.0 }).collect::<Vec<_>>());
            let difference = (at(1e-3) - at(-1e-3)) / 2e-3;
            assert!(
                (derivative - difference).abs() < 1e-5 * curve.apparent,
                "{test}: input {k}: {derivative} {difference}"
            );
        }
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
        let draws: Vec<f64> = (0..2000)
            .map(|_| {
                let steps: Vec<f64> = inputs
                    .iter()
                    .map(|i| {
                        let z = normal.inverse_cdf(random.random_range(1e-12..1.0));
                        z * i.estimate.cv().unwrap() / 5f64.sqrt()
                    })
                    .collect();
                apparent(&steps)
            })
            .collect();
        let found = Estimate::of(&draws).unwrap();
        let bands = prediction.bands.unwrap();
        // The SD of 2000 draws is itself 1.6 % uncertain: three times that.
        assert_relative_eq!(bands.mean_fabric.standard, found.sd.unwrap(), max_relative = 0.05);
        assert_relative_eq!(found.mean, curve.apparent, max_relative = 2e-3);
        let x = 0.01;
        assert_relative_eq!(curve.band(x).unwrap().half_width, bands.mean_fabric.half_width * x);
        assert_eq!(curve.repeats(), Some(5));
    }
}

/// P = P0 exp((T0 - T)/l): by differences of T0 and Tm, which are independent.
#[test]
fn the_band_of_compression_is_that_of_its_two_thicknesses() {
    use crate::characterise::Key;
    let sheet = |t0: f64, tm: f64| {
        let mut sheet = FabricSheet::default();
        for (parameter, mean, sd) in [(Parameter::T0, t0, 1e-5), (Parameter::Tm, tm, 4e-6)] {
            let estimate = Estimate { mean, sd: Some(sd), n: 4, values: vec![] };
            sheet.values.insert(Key { parameter, direction: None }, estimate);
        }
        sheet
    };
    let (t0, tm, at) = (6e-4, 4e-4, 4.5e-4);
    let p = |t0: f64, tm: f64| compression(&sheet(t0, tm)).unwrap().at(at);
    let step = 1e-9;
    let by = [
        (p(t0 + step, tm) - p(t0 - step, tm)) / (2.0 * step),
        (p(t0, tm + step) - p(t0, tm - step)) / (2.0 * step),
    ];
    let expected = ((by[0] * 1e-5).powi(2) + (by[1] * 4e-6).powi(2)).sqrt() / 2.0;
    let band = compression(&sheet(t0, tm)).unwrap().band(at).unwrap();
    assert_relative_eq!(band.standard, expected, max_relative = 1e-5);
}
