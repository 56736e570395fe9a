//! The chain from a section to its results: many fabrics on one mesh, the stages of one solve, the
//! iterative path, large meshes, and natural frequencies.
//!
//! `cargo bench --bench pipeline --no-default-features -- [PART]...`, with the parts `stages`, `fabrics`,
//! `iterative`, `large` (640 x 640 bending), `largest` (640 x 640 with six dofs, 16 GB) and `modal`; all
//! but `large` and `largest` when none is named. Times depend on the machine and on what else it does.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use kesf::element::Mass;
use kesf::section::ShellSection;
use kesf::solve::{Method, Options, Timings, modes, solve};
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

/// Processor seconds of this process so far, to 10 ms; wall time where the system does not tell.
fn processor_seconds(since: Instant) -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> = stat
        .rsplit(')')
        .next()
        .unwrap_or_default()
        .split_whitespace()
        .map(|field| field.parse().unwrap_or(0.0))
        .collect();
    // utime and stime, in hundredths of a second, are fields 14 and 15; the list begins with 3.
    fields.get(11..13).map_or_else(|| since.elapsed().as_secs_f64(), |t| t.iter().sum::<f64>() / 100.0)
}

/// Fabrics per second on one thread, nodal resultants and probes included.
fn fabrics(count: usize) {
    let case = case(40);
    let start = Instant::now();
    let prepared = PreparedCase::new(&case, &Options::default()).expect("a mesh");
    let (ready, before) = (start.elapsed().as_secs_f64(), processor_seconds(start));
    for k in 0..count {
        black_box(prepared.solve(section(k)).expect("a solution"));
    }
    let (all, used) = (start.elapsed().as_secs_f64(), processor_seconds(start) - before);
    println!(
        "{count} fabrics, 40 x 40: {:.0} a second, {:.0} a second of processor time; the case made ready in {:.2} ms",
        count as f64 / all,
        count as f64 / used,
        ready * 1e3
    );
}

fn phases(t: &Timings) -> [f64; 5] {
    [t.order_s, t.symbolic_s, t.assemble_s, t.factor_s, t.solve_s].map(|s| 1e3 * s)
}

/// Stages of one 40 x 40 solve: the first, and the best of 50 (ms).
fn stages(name: &str, coupled: bool) {
    let case = case(40);
    let options = Options { coupled, ..Options::default() };
    let model = PreparedCase::new(&case, &options).expect("a mesh").model(section(0));
    let mut best = [f64::INFINITY; 5];
    for run in 0..50 {
        let seconds = phases(&solve(&model, &options).expect("a solution").timings);
        best.iter_mut().zip(seconds).for_each(|(b, s)| *b = b.min(s));
        if run == 0 || run == 49 {
            let [order, symbolic, assemble, factor, solve] = best;
            println!(
                "40 x 40 {name}, {}: order {order:.2}, symbolic {symbolic:.2}, assemble {assemble:.2}, factor \
                 {factor:.2}, solve {solve:.2} ms; without the analysis {:.2} ms",
                if run == 0 { "the first" } else { "the best of 50" },
                assemble + factor + solve
            );
        }
    }
}

/// Iterations and milliseconds against the mesh, beside the direct path.
fn iterative(sizes: &[usize]) {
    println!(
        "   n dofs  rows      iterations  levels+solve (ms)  MB   | direct factor+solve (ms)  MB(L)  | largest difference"
    );
    for coupled in [false, true] {
        for &n in sizes {
            let case = case(n);
            let direct = Options { coupled, method: Method::Direct, ..Options::default() };
            let model = PreparedCase::new(&case, &direct).expect("a mesh").model(section(0));
            let d = solve(&model, &direct).expect("a solution");
            let i = solve(&model, &Options { method: Method::Iterative, ..direct }).expect("a solution");
            let largest = d.displacement.iter().fold(0.0f64, |m, u| m.max(u.abs()));
            let off =
                d.displacement.iter().zip(&i.displacement).fold(0.0f64, |m, (d, i)| m.max((d - i).abs()));
            let ms = |t: &Timings| 1e3 * (t.factor_s + t.solve_s);
            let (s, f) = (&i.systems[0], &d.systems[0]);
            println!(
                "{n:4} {:4}  {:8} {:8}  {:17.0}  {:6.1}  | {:22.0}  {:7.1}  | {:.1e}",
                if coupled { 6 } else { 3 },
                s.counts.rows,
                s.iterations(),
                ms(&i.timings),
                s.counts.bytes as f64 * 1e-6,
                ms(&d.timings),
                f.counts.bytes as f64 * 1e-6,
                off / largest
            );
        }
    }
}

/// One direct solve on a large mesh, with the peak memory of the process so far.
fn large(n: usize, coupled: bool, threads: usize) {
    let case = case(n);
    let options = Options { coupled, method: Method::Direct, threads, ..Options::default() };
    let model = PreparedCase::new(&case, &Options { method: Method::Iterative, ..options })
        .expect("a mesh")
        .model(section(0));
    let s = solve(&model, &options).expect("a solution");
    let [order, symbolic, assemble, factor, substitution] = phases(&s.timings);
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or("VmHWM: not known here");
    println!(
        "{n} x {n}, {} dofs, {threads} threads: order {order:.0}, symbolic {symbolic:.0}, assemble {assemble:.0}, factor \
         {factor:.0}, solve {substitution:.0} ms; {:.0} GFLOP, L {:.2} GB; residual {:.1e}; {peak}",
        s.dofs,
        s.systems[0].counts.flops * 1e-9,
        s.systems[0].counts.bytes as f64 * 1e-9,
        s.residual
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
    let named: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).collect();
    let is_on =
        |part: &str| named.iter().any(|n| n == part) || (named.is_empty() && !part.starts_with("large"));
    if is_on("stages") {
        stages("bending", false);
        stages("6-dof shell", true);
    }
    if is_on("fabrics") {
        fabrics(1000);
    }
    if is_on("iterative") {
        iterative(&[40, 80, 160, 320]);
    }
    if is_on("large") {
        [160, 320, 640].into_iter().for_each(|n| large(n, false, 1));
    }
    if is_on("largest") {
        [160, 320, 640].into_iter().for_each(|n| large(n, true, 2));
    }
    if is_on("modal") {
        modal();
    }
}
