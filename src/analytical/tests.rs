//! References: values of 40-digit Navier and Levy series, and of Hencky's superposition against a
//! p-Ritz method, computed independently of this library (Python, mpmath and SciPy) and rounded to
//! the digits shown; and the agreement of two methods that share nothing but the plate.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use proptest::prelude::*;

use super::Plate;
use super::levy::Edge;

/// A square of side 1 with `D22 = 1`; `t = T/√(D11 D22)`, 40 % of it from `D12`.
fn square(d11: f64, t: f64) -> Plate {
    let t = t * d11.sqrt();
    Plate { a: 1.0, b: 1.0, d11, d22: 1.0, d12: 0.4 * t, d66: 0.3 * t }
}

/// D11/D22, T/√(D11 D22), centre deflection SSSS and CCCC in q a⁴/D22, edge moments CCCC in q a².
const SQUARES: [(f64, f64, f64, f64, f64, f64); 9] = [
    (1.0, 0.0, 8.2041612287e-3, 1.6646234831e-3, -0.05726137, -0.05726137),
    (1.0, 0.5, 5.4401605850e-3, 1.4353127756e-3, -0.05411352, -0.05411352),
    (1.0, 1.0, 4.0623526607e-3, 1.2653190875e-3, -0.05133376, -0.05133376),
    (2.0, 0.0, 5.4594049655e-3, 1.1039178901e-3, -0.07231316, -0.04166537),
    (2.0, 0.5, 3.6911188826e-3, 9.5972655264e-4, -0.06740460, -0.04041835),
    (2.0, 1.0, 2.7839426677e-3, 8.5144215209e-4, -0.06331991, -0.03908491),
    // With D11 = 4 D22 and T = 0 the centre is that of the beam along x.
    (4.0, 0.0, 5.0 / 1536.0, 1.0 / 1536.0, -1.0 / 12.0, -0.02883450),
    (4.0, 0.5, 2.3151611622e-3, 5.7846564682e-4, -0.07769654, -0.02876975),
    (4.0, 1.0, 1.7947715845e-3, 5.2200976422e-4, -0.07307468, -0.02842338),
];

#[test]
fn squares_have_their_tabulated_deflections_and_edge_moments() {
    for (d11, t, ssss, cccc, mx, my) in SQUARES {
        let plate = square(d11, t);
        // Half a unit of the last digit tabulated.
        let digits = 0.5e-13;
        assert_abs_diff_eq!(plate.navier(0.5, 0.5, 1.0).deflection, ssss, epsilon = digits);
        assert_abs_diff_eq!(plate.levy(Edge::Supported, 0.5, 0.5, 1.0).deflection, ssss, epsilon = digits);
        let clamped = plate.clamped(1.0).unwrap();
        assert_abs_diff_eq!(clamped.deflection(0.5, 0.5), cccc, epsilon = digits);
        assert_abs_diff_eq!(clamped.edge_moment_x(0.5), mx, epsilon = 0.51e-8);
        assert_abs_diff_eq!(clamped.edge_moment_y(0.5), my, epsilon = 0.51e-8);
    }
}

#[test]
fn isotropic_square_to_all_digits() {
    let plate = Plate::isotropic(1.0, 1.0, 1.0, 0.3);
    let ssss = plate.levy(Edge::Supported, 0.5, 0.5, 1.0);
    assert_relative_eq!(ssss.deflection, 4.06235266067505e-3, max_relative = 1e-13);
    assert_relative_eq!(ssss.mx, 0.0478863796330, max_relative = 1e-12);
    assert_relative_eq!(ssss.my, 0.0478863796330, max_relative = 1e-12);
    let clamped = plate.clamped(1.0).unwrap();
    assert_relative_eq!(clamped.deflection(0.5, 0.5), 1.26531908748e-3, max_relative = 4e-12);
    assert_relative_eq!(clamped.state(0.5, 0.5).mx, 0.0229050907842, max_relative = 3e-12);
    assert_relative_eq!(clamped.edge_moment_x(0.5), -0.0513337647410, max_relative = 2e-11);
    let edge = |edge, y| plate.levy(edge, 0.5, y, 1.0).deflection;
    assert_relative_eq!(edge(Edge::Clamped, 0.5), 1.917137991048e-3, max_relative = 3e-13);
    assert_relative_eq!(edge(Edge::Free, 0.5), 1.309368130205e-2, max_relative = 3e-13);
    assert_relative_eq!(edge(Edge::Free, 0.0), 1.501125697549e-2, max_relative = 1e-12);
}

/// Without `D12` a plate between two supports bends as beams do, whatever the twisting rigidity is.
#[test]
fn without_coupling_the_sfsf_plate_is_a_beam() {
    for d66 in [0.0, 0.2, 3.0] {
        let plate = Plate { a: 2.0, b: 0.7, d11: 3.0, d22: 1.0, d12: 0.0, d66 };
        for y in [0.0, 0.2, 0.35] {
            let state = plate.levy(Edge::Free, 1.0, y, 6.0);
            assert_relative_eq!(
                state.deflection,
                5.0 / 384.0 * 6.0 * 2.0_f64.powi(4) / 3.0,
                max_relative = 1e-13
            );
            assert_relative_eq!(state.mx, 6.0 * 4.0 / 8.0, max_relative = 1e-13);
            assert_abs_diff_eq!(state.my, 0.0, epsilon = 1e-13);
        }
    }
}

/// A long clamped plate is a clamped beam in its middle: q b⁴/384 D, -q b²/12.
#[test]
fn long_clamped_plate_is_a_beam_across() {
    let plate = Plate::isotropic(10.0, 1.0, 2.0, 0.3);
    let clamped = plate.clamped(3.0).unwrap();
    // The influence of the ends decays as e^(-4.7 * 5).
    assert_relative_eq!(clamped.deflection(5.0, 0.5), 3.0 / (384.0 * 2.0), max_relative = 1e-7);
    assert_relative_eq!(clamped.edge_moment_y(5.0), -3.0 / 12.0, max_relative = 1e-7);
}

#[test]
fn boundary_values_vanish_where_they_must() {
    let plate = Plate { a: 1.3, b: 0.9, d11: 2.0, d22: 1.0, d12: 0.2, d66: 0.5 };
    let scale = plate.levy(Edge::Supported, 0.65, 0.45, 1.0);
    let side = plate.levy(Edge::Supported, 0.4, 0.0, 1.0);
    assert_abs_diff_eq!(side.deflection, 0.0, epsilon = 1e-12 * scale.deflection);
    assert_abs_diff_eq!(side.my, 0.0, epsilon = 1e-9 * scale.my);
    let end = plate.levy(Edge::Supported, 0.0, 0.3, 1.0);
    assert_abs_diff_eq!(end.mx, 0.0, epsilon = 1e-12 * scale.mx);
    let clamped = plate.clamped(1.0).unwrap();
    for (x, y) in [(0.0, 0.4), (1.3, 0.2), (0.3, 0.0), (0.7, 0.9)] {
        assert_abs_diff_eq!(clamped.deflection(x, y), 0.0, epsilon = 1e-9 * scale.deflection);
    }
    let ritz = plate.clamped_ritz(1.0, 12).unwrap();
    assert_relative_eq!(clamped.deflection(0.2, 0.3), ritz.deflection(0.2, 0.3), max_relative = 1e-8);
    assert_relative_eq!(clamped.state(0.4, 0.3).mxy, ritz.state(0.4, 0.3).mxy, max_relative = 1e-6);
}

/// Tip of a cantilever strip under pressure: `q L⁴/(8 D11)` for any width and twisting rigidity if
/// `D12 = 0`; isotropic, nu = 0.3, by width/length: computed independently, digits as shown.
#[test]
fn cantilever_strips() {
    for (b, d66) in [(0.1, 0.0), (1.0, 0.7)] {
        let strip = Plate { a: 2.0, b, d11: 3.0, d22: 1.0, d12: 0.0, d66 };
        // d66 = 0 leaves a strip's torsion free; the symmetric functions do not contain it.
        let ritz = strip.cantilever_ritz(5.0, 8).unwrap();
        for y in [0.0, 0.5 * b] {
            assert_relative_eq!(ritz.deflection(2.0, y), 5.0 * 16.0 / (8.0 * 3.0), max_relative = 1e-10);
        }
    }
    for (b, tip, half) in [(1.0, 0.12907, 0.5e-5), (0.25, 0.1333, 0.5e-4), (0.125, 0.1351, 0.5e-4)] {
        let ritz = Plate::isotropic(1.0, b, 1.0, 0.3).cantilever_ritz(1.0, 20).unwrap();
        assert_abs_diff_eq!(ritz.deflection(1.0, 0.5 * b), tip, epsilon = half);
    }
}

#[test]
fn a_plate_that_is_not_elliptic_is_refused() {
    let plate = Plate { a: 1.0, b: 1.0, d11: 1.0, d22: 1.0, d12: -3.0, d66: 0.1 };
    assert!(plate.clamped(1.0).is_none());
    assert!(plate.clamped_ritz(1.0, 6).is_none());
}

fn plates() -> impl Strategy<Value = Plate> {
    let twist = prop_oneof![Just(0.0), Just(1.0), 0.0..2.0_f64];
    (0.5..2.0_f64, 0.25..4.0_f64, twist, 0.0..1.0_f64).prop_map(|(a, d11, t, share)| {
        let t = t * d11.sqrt();
        // |D12| < √(D11 D22): positive definite.
        let d12 = (share * t).min(0.9 * d11.sqrt());
        Plate { a, b: 1.0, d11, d22: 1.0, d12, d66: 0.5 * (t - d12) }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn navier_and_levy_agree(plate in plates(), x in 0.2..0.8_f64, y in 0.2..0.8_f64) {
        let (x, y) = (x * plate.a, y * plate.b);
        let double = plate.navier(x, y, 2.0);
        let single = plate.levy(Edge::Supported, x, y, 2.0);
        let turned = plate.transposed().levy(Edge::Supported, y, x, 2.0);
        assert_relative_eq!(double.deflection, single.deflection, max_relative = 1e-11);
        assert_relative_eq!(turned.deflection, single.deflection, max_relative = 1e-11);
        let centre = plate.levy(Edge::Supported, 0.5 * plate.a, 0.5 * plate.b, 2.0);
        let scale = centre.mx.abs().max(centre.my.abs());
        assert_abs_diff_eq!(double.mx, single.mx, epsilon = 1e-10 * scale);
        assert_abs_diff_eq!(double.my, single.my, epsilon = 1e-10 * scale);
        assert_abs_diff_eq!(double.mxy, single.mxy, epsilon = 1e-10 * scale);
        assert_abs_diff_eq!(turned.my, single.mx, epsilon = 1e-10 * scale);
        assert_abs_diff_eq!(turned.mxy, single.mxy, epsilon = 1e-10 * scale);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn superposition_and_ritz_agree(plate in plates()) {
        let (x, y) = (0.5 * plate.a, 0.5 * plate.b);
        let hencky = plate.clamped(2.0).unwrap();
        let ritz = plate.clamped_ritz(2.0, 18).unwrap();
        assert_relative_eq!(hencky.deflection(x, y), ritz.deflection(x, y), max_relative = 1e-9);
        // The polynomials' second derivatives converge more slowly than their values, slowest at the edges.
        let scale = hencky.edge_moment_x(y).abs().max(hencky.edge_moment_y(x).abs());
        assert_abs_diff_eq!(hencky.state(x, y).mx, ritz.state(x, y).mx, epsilon = 1e-6 * scale);
        assert_abs_diff_eq!(hencky.state(x, y).my, ritz.state(x, y).my, epsilon = 1e-6 * scale);
        assert_abs_diff_eq!(hencky.edge_moment_x(y), ritz.state(0.0, y).mx, epsilon = 3e-5 * scale);
        assert_abs_diff_eq!(hencky.edge_moment_y(x), ritz.state(x, 0.0).my, epsilon = 3e-5 * scale);
    }
}
/// The series are cut where more waves change nothing: the plate with the most singular corners of the
/// set (T = 2 √(D11 D22)) and a long one.
#[test]
fn superposition_has_converged() {
    for plate in [square(0.5, 2.0), Plate { a: 3.0, ..square(1.0, 0.4) }] {
        let (x, y) = (0.5 * plate.a, 0.5 * plate.b);
        let (used, more) = (plate.clamped(1.0).unwrap(), plate.superpose(1.0, 200).unwrap());
        assert_relative_eq!(used.deflection(x, y), more.deflection(x, y), max_relative = 1e-11);
        for at in [0.25, 0.5] {
            let (along_x, along_y) = (at * plate.a, at * plate.b);
            assert_relative_eq!(
                used.edge_moment_x(along_y),
                more.edge_moment_x(along_y),
                max_relative = 1e-9
            );
            assert_relative_eq!(
                used.edge_moment_y(along_x),
                more.edge_moment_y(along_x),
                max_relative = 1e-9
            );
        }
    }
}

/// Side ratios and laws far out: Navier against both directions of Levy. Rounding of Levy's series
/// grows like (a/b)⁴ where its waves run along the long side.
#[test]
fn extreme_shapes_and_laws() {
    let cases = [
        (10.0, 1.0, 1.0, 1e-11),
        (30.0, 1.0, 0.0, 1e-8),
        (1.0, 1000.0, 1.0, 1e-11),
        (1.0, 1e-3, 0.0, 1e-11),
        (1.0, 1.0, 20.0, 1e-12),
        (3.0, 10.0, 100.0, 1e-11),
        (1.0, 1.0, 1.0 + 1e-9, 1e-12),
        (1.0, 1.0, 1.0 - 1e-7, 1e-12),
        (1.0, 1.0, -0.9, 1e-12),
    ];
    for (a, d11, t, tolerance) in cases {
        let plate = Plate { a, ..square(d11, t) };
        let navier = plate.navier(0.5 * a, 0.5, 1.0);
        let turned = plate.transposed().levy(Edge::Supported, 0.5, 0.5 * a, 1.0);
        let levy = plate.levy(Edge::Supported, 0.5 * a, 0.5, 1.0);
        assert_relative_eq!(navier.deflection, turned.deflection, max_relative = 1e-12);
        assert_relative_eq!(levy.deflection, turned.deflection, max_relative = tolerance);
        assert_relative_eq!(navier.my, turned.mx, max_relative = 1e-11);
    }
}
