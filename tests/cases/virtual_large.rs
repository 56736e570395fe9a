//! Goal: a specimen in the clamps of a KES machine, in large rotations, shows what the instrument is meant to measure.
//!
//! References (analytical): M = D11 κ in cylindrical bending; a trellis under a tension. Closed forms of the edge
//! effects (approximations, 1 %): tension 1 + φ [1/(1 - ν12 ν21) - 1] with φ = 0.5 (W/L) √(G/E2), shear
//! 1 - 0.54 (L/W) √(G/E1).

use std::path::Path;

use approx::assert_relative_eq;
use kesf::characterise::Settings;
use kesf::instrument::Direction;
use kesf::quantity::{Angle, Curvature};
use kesf::section::ShellSection;
use kesf::solve::Options;
use kesf::study::{Case, PreparedTest, VirtualCurve, simulate};
use nalgebra::{Matrix2, Matrix3};

fn fabric(nu_b: f64) -> ShellSection {
    let (e1, e2, nu) = (6000.0f64, 3000.0f64, 0.3);
    let f = 1.0 / (1.0 - nu * nu);
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

fn run(test: &str, keys: &str, direction: Direction, section: &ShellSection) -> VirtualCurve {
    let text = format!(
        "title = \"t\"\nfabric = \"*\"\n[virtual_test]\ntest = \"{test}\"\nformulation = \"nonlinear\"\n{keys}\n"
    );
    let case = Case::parse(Path::new("t.toml"), &text).unwrap();
    simulate(&case, case.specimen().unwrap(), direction, section).unwrap()
}

/// At every curvature up to 2.5 1/cm, in both directions and both senses.
#[test]
fn bending_is_the_rigidity_at_every_curvature() {
    let s = fabric(0.0);
    for (direction, b) in [(Direction::Warp, 1e-5), (Direction::Weft, 6e-6)] {
        let t = run("bending", "", direction, &s);
        for k in [-250.0, -100.0, 25.0, 50.0, 130.0, 250.0] {
            assert_relative_eq!(t.at(k) / (b * k), 1.0, max_relative = 1e-8);
        }
        assert_relative_eq!(t.edge.unwrap().ratio, 1.0, max_relative = 1e-8);
        assert_eq!(t.unstable_from, None);
    }
    // The free edges relax: 0.9997 to 0.9998 in an independent solution, half the specimen with 10 x 20 elements.
    let t = run("bending", "", Direction::Warp, &fabric(0.25));
    println!("nu_b = 0.25: {:?}", t.edge);
    assert!((0.999..1.0).contains(&t.edge.unwrap().ratio));
}

#[test]
fn clamps_hold_the_width_of_a_specimen_in_tension() {
    let t = run("tensile", "", Direction::Warp, &fabric(0.0));
    println!("{:?}, {:?}", t.edge, t.unstable_from);
    let edge = t.edge.unwrap();
    assert_relative_eq!(edge.ratio, edge.closed_form.unwrap(), max_relative = 0.01);
    assert_relative_eq!(t.ideal, 6000.0, max_relative = 1e-12);
}

/// Force per width that shears a trellis by a displacement tan x of its gauge under a tension W across, edges apart:
/// warp yarns λ long turn by φ, `E (λ - 1) cos φ - G φ sin φ / λ = W`, `λ sin φ = tan x` (analytical).
fn trellis(w: f64, g: f64, e: f64, x: f64) -> f64 {
    let turn = |l: f64| (x.tan() / l).asin();
    let (mut low, mut high) = (0.9, 1.1);
    for _ in 0..60 {
        let l = 0.5 * (low + high);
        let p = turn(l);
        let across = e * (l - 1.0) * p.cos() - g * p * p.sin() / l;
        if across > w { high = l } else { low = l }
    }
    let p = turn(low);
    e * (low - 1.0) * p.sin() + g * p * p.cos() / low
}

#[test]
fn a_tension_across_adds_itself_to_the_shear() {
    let (s, cells) = (fabric(0.0), "cells = [5, 40]");
    let g = run("shear", cells, Direction::Warp, &s);
    let edge = g.edge.unwrap();
    let tension = edge.tension.unwrap();
    println!("{edge:?}, {:?}", g.unstable_from);
    assert_relative_eq!(edge.ratio, edge.closed_form.unwrap(), max_relative = 0.01);
    assert_eq!(tension.value, 9.80665);
    // What free edges take off is that of small displacements on the same mesh; the rest is the trellis.
    let text = format!("title = \"t\"\nfabric = \"*\"\n[virtual_test]\ntest = \"shear\"\n{cells}\n");
    let case = Case::parse(Path::new("t.toml"), &text).unwrap();
    let small = simulate(&case, case.specimen().unwrap(), Direction::Warp, &s).unwrap();
    let slope = |w: f64| {
        let at = |degrees: f64| trellis(w, 60.0, 6000.0, degrees.to_radians());
        (at(2.5) - at(0.5)) / 2f64.to_radians()
    };
    let [slack, tight] = [0.0, tension.value].map(slope);
    assert_relative_eq!(edge.ratio, small.apparent / small.ideal * slack / 60.0, max_relative = 1e-3);
    // W stretches the gauge by 0.16 %, which takes 2 % of W off the shear: the closed form has it.
    assert_relative_eq!(tension.adds, tight - slack, max_relative = 0.01);
    assert_relative_eq!(g.apparent, tight - (small.ideal - small.apparent), max_relative = 2e-3);
    // Frames of other elements turn otherwise, and it does not matter: strains are those of the yarns.
    let long = run("shear", "cells = [5, 80]", Direction::Warp, &s).edge.unwrap();
    println!("{long:?}");
    assert_relative_eq!(long.tension.unwrap().adds, tension.adds, max_relative = 1e-3);
}

/// The cases of `examples/large_rotations` are read; they are no part of `cases`, for they take seconds a fabric.
#[test]
fn the_example_cases_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/large_rotations");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    assert_eq!(files.len(), 11);
    files.iter().for_each(|file| drop(Case::read(file).unwrap_or_else(|e| panic!("{e}"))));
}

/// The slope is taken in the window of the settings, which moves the measured value too. Reference: the trellis under
/// tension for what the tension adds, the rigidity itself in bending.
#[test]
fn the_slope_is_taken_in_the_window_of_the_settings() {
    let s = fabric(0.0);
    let case = |test: &str, keys: &str| {
        let text = format!(
            "title = \"t\"\nfabric = \"*\"\n[virtual_test]\ntest = \"{test}\"\nformulation = \"nonlinear\"\n{keys}\n"
        );
        Case::parse(Path::new("t.toml"), &text).unwrap()
    };
    let shear = case("shear", "cells = [5, 40]");
    let shear = PreparedTest::new(&shear, shear.specimen().unwrap(), &Options::default()).unwrap();
    let mut found = Vec::new();
    for window in [[0.5f64, 2.5], [0.5, 5.0], [5.0, 7.0]].map(|w| w.map(f64::to_radians)) {
        let settings = Settings { shear_slope: window.map(Angle), ..Settings::default() };
        let t = shear.simulate(Direction::Warp, &s, &settings).unwrap();
        assert_eq!(t.window, Some(window));
        let [from, to] = window;
        assert_relative_eq!(t.apparent, (t.at(to) - t.at(from)) / (to - from), max_relative = 1e-12);
        let slope = |w: f64| (trellis(w, 60.0, 6000.0, to) - trellis(w, 60.0, 6000.0, from)) / (to - from);
        let adds = t.edge.unwrap().tension.unwrap().adds;
        // As above: W stretches the gauge, and the closed form has it.
        assert_relative_eq!(adds, slope(9.80665) - slope(0.0), max_relative = 0.01);
        found.push(t.apparent);
    }
    assert!(found[0] != found[1] && found[1] != found[2], "{found:?}");
    let bending = case("bending", "");
    let bending = PreparedTest::new(&bending, bending.specimen().unwrap(), &Options::default()).unwrap();
    let settings = Settings { bending_slope: [Curvature(20.0), Curvature(190.0)], ..Settings::default() };
    let t = bending.simulate(Direction::Warp, &s, &settings).unwrap();
    assert_eq!(t.window, Some([20.0, 190.0]));
    assert_relative_eq!(t.apparent, 1e-5, max_relative = 1e-8);
}
