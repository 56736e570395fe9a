//! The chain from a section to its results on one thread: many fabrics on one mesh, the stages of
//! one solve, and natural frequencies.
//!
//! `cargo bench --bench pipeline`. Times depend on the machine and on what else it does.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use kesf::element::Mass;
use kesf::section::ShellSection;
use kesf::solve::{Options, modes};
use kesf::study::{Case, PreparedCase};
use nalgebra::{Matrix2, Matrix3};

const CASE: &str = r#"
title = "Clamped square under uniform pressure"
fabric = "*"
[sheet]
shape = "rectangle"
width = "20 cm"
height = "20 cm"
cells = [N, N]
[[supports]]
set = "boundary"
kind = "clamped"
[[loads]]
kind = "pressure"
value = "2e-6 Pa"
[[probes]]
name = "centre"
at = ["10 cm", "10 cm"]
"#;

/// A clamped square of `n` x `n` elements.
fn case(n: usize) -> Case {
    let text = CASE.replace('N', &n.to_string());
    Case::parse(Path::new("pipeline.toml"), &text).expect("a case")
}

/// The `k`-th synthetic fabric: stiffnesses over a decade.
fn section(k: usize) -> ShellSection {
    let s = 10f64.powf((k % 97) as f64 / 97.0);
    ShellSection {
        d_m: Matrix3::new(2000.0 * s, 300.0, 0.0, 300.0, 1500.0, 0.0, 0.0, 0.0, 60.0 * s),
        d_b: Matrix3::new(5e-6 * s, 5e-7, 0.0, 5e-7, 4e-6, 0.0, 0.0, 0.0, 2e-6),
        d_s: Matrix2::identity() * 50.0,
        areal_density: 0.15,
        thickness: 4e-4,
    }
    .checked()
    .expect("a section")
}

/// Fabrics per second on one thread, nodal resultants and probes included.
fn fabrics(count: usize) {
    let case = case(40);
    let start = Instant::now();
    let prepared = PreparedCase::new(&case, &Options::default()).expect("a mesh");
    let ready = start.elapsed().as_secs_f64();
    for k in 0..count {
        black_box(prepared.solve(section(k)).expect("a solution"));
    }
    let all = start.elapsed().as_secs_f64();
    println!(
        "{count} fabrics, 40 x 40: {:.0} a second; the case made ready in {:.2} ms",
        count as f64 / all,
        ready * 1e3
    );
}

/// Stages of one 40 x 40 solve, the best of 50 (ms).
fn stages(name: &str, coupled: bool) {
    let case = case(40);
    let options = Options { coupled, ..Options::default() };
    let model = PreparedCase::new(&case, &options).expect("a mesh").model(section(0));
    let mut best = [f64::INFINITY; 4];
    for _ in 0..50 {
        let t = kesf::solve::solve(&model, &options).expect("a solution").timings;
        let seconds = [t.analyse_s, t.assemble_s, t.factor_s, t.solve_s];
        best.iter_mut().zip(seconds).for_each(|(b, s)| *b = b.min(1e3 * s));
    }
    let [analyse, assemble, factor, solve] = best;
    println!(
        "40 x 40 {name}: analyse {analyse:.2}, assemble {assemble:.2}, factor {factor:.2}, solve {solve:.2} ms; \
         without the analysis {:.2} ms",
        assemble + factor + solve
    );
}

/// Seconds for ten modes of a 100 x 100 sheet.
fn modal() {
    let case = case(100);
    let options = Options::default();
    let model = PreparedCase::new(&case, &options).expect("a mesh").model(section(0));
    let start = Instant::now();
    let found = modes(&model, 10, Mass::default(), &options).expect("modes");
    println!("{} modes, 100 x 100 clamped: {:.2} s", found.len(), start.elapsed().as_secs_f64());
}

fn main() {
    stages("bending", false);
    stages("6-dof shell", true);
    fabrics(1000);
    modal();
}
