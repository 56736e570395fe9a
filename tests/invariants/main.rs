//! Cases at random, valid by construction, and what holds of every one of them.
//!
//! Goal: whatever the outline, the mesh, the cloth, the supports and the loads are, reactions balance loads, the strain
//! energy is positive and the work of the loads, a mirrored case gives the mirrored answer and a symmetric one a
//! symmetric one, a turned case the turned answer, and neither the order of nodes and quads nor the number of threads
//! matters. Reference: none is needed, both sides are the solver's; the laws are those of statics and of space.
//!
//! `KESF_CASES=2000 cargo test --release --test invariants -- --nocapture` runs so many of each kind, and prints how many
//! of what there were; the gate runs 40. The seeds are fixed: a case that fails is the same in every run.

mod generate;
mod hold;
mod transform;

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use generate::Generated;
use hold::{balance, energy_of_work, off, same_bytes};
use kesf::element::Mass;
use kesf::model::Model;
use kesf::solve::nonlinear::{self, Settings};
use kesf::solve::{Options, modes, solve};
use transform::{Transform, mirrored, renumbered, turned};

/// What the transformed answer of a linear case may differ by, relative to the largest displacement: solutions are
/// refined until rounding is what is left, and the conditions of thin sheets take some digits of that.
const LINEAR: f64 = 1e-8;
/// The same of modes, whose systems are solved without refinement.
const MODES: f64 = 1e-6;
/// The same in large rotations, where searches end at 1e-8 of the loads.
const LARGE: f64 = 1e-5;

fn count() -> u64 {
    std::env::var("KESF_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(40)
}

/// Runs a kind of case and prints what there was.
fn each(kind: &str, seed: u64, mut hold: impl FnMut(&Generated)) {
    let mut parts: BTreeMap<String, usize> = BTreeMap::new();
    for n in 0..count() {
        let case = Generated::new(1_000_000 * seed + n);
        case.parts.iter().for_each(|part| *parts.entry(part.clone()).or_default() += 1);
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| hold(&case)));
        if let Err(panic) = result {
            println!(
                "{kind}: case {n} does not hold: {:?}, {} nodes",
                case.parts,
                case.model.mesh.nodes.len()
            );
            std::panic::resume_unwind(panic);
        }
    }
    let parts: Vec<String> = parts.iter().map(|(part, n)| format!("{n} {part}")).collect();
    println!("{kind}: {} cases; {}", count(), parts.join(", "));
}

/// Every transformation of a case.
fn transforms(case: &Generated) -> [(&'static str, Model, Transform); 4] {
    let plane = turned(&case.model, &case.turn_in_plane());
    let space = turned(&case.model, &case.turn_in_space());
    let mirror = mirrored(&case.model);
    let order = renumbered(&case.model, case.seed);
    [
        ("turned in its plane", plane.0, plane.1),
        ("turned in space", space.0, space.1),
        ("mirrored", mirror.0, mirror.1),
        ("in another order", order.0, order.1),
    ]
}

fn threads(n: usize) -> Options {
    Options { threads: n, ..Options::default() }
}

#[test]
fn linear_cases() {
    each("linear", 1, |case| {
        let model = &case.model;
        let found = solve(model, &threads(1)).unwrap();
        balance(&model.mesh.nodes, &model.load_vector(), &found.reaction, 1e-8);
        energy_of_work(model, &found, 1e-8);
        for n in [2, 8] {
            let other = solve(model, &threads(n)).unwrap();
            same_bytes(&other.displacement, &found.displacement);
            same_bytes(&other.reaction, &found.reaction);
        }
        for (what, other, transform) in transforms(case) {
            let other = solve(&other, &threads(1)).unwrap();
            let size = case.size();
            let u = off(&transform.of(&found.displacement), &other.displacement, size);
            let r = off(&transform.of(&found.reaction), &other.reaction, 1.0 / size);
            assert!(u < LINEAR && r < LINEAR, "{what}: displacements {u:.1e}, reactions {r:.1e}");
        }
    });
}

#[test]
fn symmetric_cases() {
    let mut cases = 0;
    for n in 0..count() {
        let (model, image) = Generated::symmetric(2_000_000 + n);
        let found = solve(&model, &threads(1)).unwrap();
        let mirror = Transform::mirror(image);
        let [low, high] = model.mesh.bounds();
        let size = (high - low).norm();
        let u = off(&mirror.of(&found.displacement), &found.displacement, size);
        let r = off(&mirror.of(&found.reaction), &found.reaction, 1.0 / size);
        assert!(u < LINEAR && r < LINEAR, "case {n}: displacements {u:.1e}, reactions {r:.1e}");
        cases += 1;
    }
    println!("symmetric: {cases} cases");
}

/// Betti: the work of one load along the displacements of another is that of the other along the one's.
#[test]
fn loads_do_each_others_work() {
    each("reciprocal", 3, |case| {
        let mut first = case.model.clone();
        first.supports.iter_mut().flat_map(|s| &mut s.held).for_each(|(_, value)| *value = 0.0);
        let second = Model { loads: case.other_loads(), ..first.clone() };
        let [a, b] = [&first, &second].map(|model| solve(model, &threads(1)).unwrap().displacement);
        let work = |f: Vec<f64>, u: &[f64]| f.iter().zip(u).map(|(f, u)| f * u).sum::<f64>();
        let (ab, ba) = (work(first.load_vector(), &b), work(second.load_vector(), &a));
        let own = (work(first.load_vector(), &a) * work(second.load_vector(), &b)).sqrt();
        assert!((ab - ba).abs() < 1e-8 * own, "{ab:e} and {ba:e} of {own:e}");
    });
}

#[test]
fn modes_at_random() {
    each("modal", 4, |case| {
        let frequencies = |model: &Model, n| -> Vec<f64> {
            let found = modes(model, 4, Mass::Lumped, &threads(n)).unwrap();
            found.iter().map(|mode| mode.angular_frequency).collect()
        };
        let found = frequencies(&case.model, 1);
        assert!(found[0] > 0.0 && found.is_sorted(), "{found:?}");
        same_bytes(&frequencies(&case.model, 2), &found);
        for (what, other, _) in transforms(case) {
            for (a, b) in frequencies(&other, 1).iter().zip(&found) {
                assert!((a / b - 1.0).abs() < MODES, "{what}: {a} where {b} was");
            }
        }
    });
}

#[test]
fn large_rotations() {
    let (mut not_found, mut all) = (0, 0);
    each("large rotations", 6, |case| {
        let model = case.with_moderate_loads();
        let search = |model: &Model, n| {
            let settings = Settings { first_step: 0.25, largest_step: 0.25, ..Settings::default() };
            nonlinear::solve(model, &settings, &threads(n), |_| ControlFlow::Continue(()))
        };
        all += 1;
        let Ok(found) = search(&model, 1) else {
            not_found += 1;
            return;
        };
        balance(&found.state.position, &model.load_vector(), &found.reaction, 1e-6);
        assert!(found.energy > 0.0, "{:e} J", found.energy);
        let displacement = found.state.displacement(&model.mesh);
        let other = search(&model, 2).unwrap();
        same_bytes(&other.state.displacement(&model.mesh), &displacement);
        let moderate = Generated { model, ..case.clone() };
        for (what, other, transform) in transforms(&moderate) {
            let there = search(&other, 1).unwrap();
            let u = off(&transform.of(&displacement), &there.state.displacement(&other.mesh), case.size());
            assert!(u < LARGE, "{what}: {u:.1e}");
        }
    });
    println!("large rotations: {not_found} of {all} cases found no equilibrium");
    // Sheets that buckle under their loads have none on the way there; most are to have one.
    assert!(2 * not_found < all, "{not_found} of {all}");
}
