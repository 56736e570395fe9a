//! One value of a complete table of parameters, slipped by a factor: how often it is told.
//!
//! The fabrics are drawn from wide populations and obey the definitions of the parameters; nothing here shares code
//! with the checks.

use kesf::characterise::{Settings, characterise};
use kesf::finding::Place;
use kesf::instrument::{Direction, FabricInput, Parameter, ResultValue};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Factors of slips: decimal places, gf against N, cm against mm, twice a half width.
const FACTORS: [f64; 8] = [0.01, 0.1, 0.101972, 0.5, 2.0, 9.80665, 10.0, 100.0];

/// The sixteen parameters, W and Tm of a fabric in KES units.
fn fabric(rng: &mut Pcg64) -> Vec<(Parameter, f64)> {
    use Parameter as P;
    let mut between = |low: f64, high: f64| rng.random_range(low.ln()..high.ln()).exp();
    let (lt, emt, rt) = (between(0.5, 0.9), between(2.0, 15.0), between(40.0, 70.0));
    let (g, hg) = (between(0.4, 2.0), between(0.4, 3.0));
    let hg5 = hg * between(1.0, 3.0);
    let (b, curvature) = (between(0.02, 0.4), between(0.1, 0.6));
    let (lc, rc, t0, squeezed) =
        (between(0.25, 0.5), between(40.0, 70.0), between(0.25, 1.0), between(0.15, 0.5));
    let (miu, mmd, smd) = (between(0.13, 0.3), between(0.01, 0.04), between(2.0, 12.0));
    let density = between(200.0, 600.0);
    vec![
        (P::Lt, lt),
        (P::Wt, lt * 500.0 * emt / 200.0),
        (P::Rt, rt),
        (P::Emt, emt),
        (P::G, g),
        (P::Hg, hg),
        (P::Hg5, hg5),
        (P::B, b),
        (P::Hb, 2.0 * b * curvature),
        (P::Lc, lc),
        (P::Wc, lc * 50.0 * 0.1 * t0 * squeezed / 2.0),
        (P::Rc, rc),
        (P::T0, t0),
        (P::Tm, t0 * (1.0 - squeezed)),
        (P::Miu, miu),
        (P::Mmd, mmd),
        (P::Smd, smd),
        (P::W, density * t0 * 0.1),
    ]
}

/// Whether a finding speaks of the values of the fabric as such.
fn is_told(values: &[(Parameter, f64)]) -> bool {
    let result = |(column, (parameter, value)): (usize, &(Parameter, f64))| ResultValue {
        parameter: *parameter,
        direction: parameter.is_directional().then_some(Direction::Warp),
        mean: value * parameter.kes_factor(),
        sd: None,
        n: 1,
        values: Vec::new(),
        lines: Vec::new(),
        status: Default::default(),
        place: Place::at("table.csv", 2, column + 1),
    };
    let results = values.iter().enumerate().map(result).collect();
    let input = FabricInput { name: "a".into(), results, ..FabricInput::default() };
    let sheet = characterise(&input, &Settings::default());
    sheet.findings.iter().any(|finding| ["K011", "K042", "K059"].contains(&finding.code()))
}

#[test]
fn slips_of_a_value_by_a_factor() {
    let mut rng = Pcg64::seed_from_u64(20_261_123);
    let fabrics: Vec<_> = (0..40).map(|_| fabric(&mut rng)).collect();
    let false_alarms = fabrics.iter().filter(|values| is_told(values)).count();
    println!("{false_alarms} of {} fabrics without a slip are told", fabrics.len());
    assert_eq!(false_alarms, 0);
    let mut reported = [0usize; FACTORS.len()];
    for values in &fabrics {
        for (count, factor) in reported.iter_mut().zip(FACTORS) {
            for slipped in 0..values.len() {
                let mut values = values.clone();
                values[slipped].1 *= factor;
                *count += usize::from(is_told(&values));
            }
        }
    }
    let slips = fabrics.len() * fabrics[0].len();
    for (count, factor) in reported.iter().zip(FACTORS) {
        println!(
            "factor {factor}: {count} of {slips} slips are told ({:.1} %)",
            100.0 * *count as f64 / slips as f64
        );
    }
    // A factor of two lies within the differences between fabrics, where nothing else follows from the value.
    let least = [0.9, 0.7, 0.7, 0.3, 0.3, 0.7, 0.7, 0.9];
    for ((count, factor), least) in reported.iter().zip(FACTORS).zip(least) {
        assert!(*count as f64 > least * slips as f64, "factor {factor}: {count} of {slips}");
    }
}
