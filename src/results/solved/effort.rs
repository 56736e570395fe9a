//! What a solution took: systems, counts, memory and seconds.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::quantity::significant;
use crate::results::columns::Columns;
use crate::solve::{Solution, System};
use crate::study::CaseResult;

/// `solver` of an entry of `kesf.solution/1`: what does not depend on the machine.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SolverEntry {
    residual: f64,
    systems: Vec<SystemEntry>,
}

/// One system of equations.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct SystemEntry {
    dofs: Vec<Cow<'static, str>>,
    path: Cow<'static, str>,
    rows: usize,
    nnz_a: usize,
    bytes: usize,
    /// Of a factorisation.
    #[serde(skip_serializing_if = "Option::is_none")]
    nnz_l: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    flops: Option<f64>,
    /// Of an iteration.
    #[serde(skip_serializing_if = "Option::is_none")]
    iterations: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    residual_history: Option<Vec<f64>>,
}

/// `timings` of an entry: seconds, rate, threads and the peak memory of the process, which differ from run to run.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TimingsEntry {
    analyse_s: f64,
    order_s: f64,
    symbolic_s: f64,
    assemble_s: f64,
    factor_s: f64,
    solve_s: f64,
    gflop_per_s: Option<f64>,
    threads: Option<usize>,
    peak_memory_bytes: Option<u64>,
}

impl SolverEntry {
    /// The entry of a solution.
    pub fn new(solution: &Solution) -> Self {
        Self { residual: solution.residual, systems: solution.systems.iter().map(SystemEntry::new).collect() }
    }
}

impl SystemEntry {
    fn new(system: &System) -> Self {
        let counts = &system.counts;
        let iterates = !system.history.is_empty();
        Self {
            dofs: dof_names(system).into_iter().map(Cow::Borrowed).collect(),
            path: system.path.into(),
            rows: counts.rows,
            nnz_a: counts.nnz_a,
            bytes: counts.bytes,
            nnz_l: (!iterates).then_some(counts.nnz_l),
            flops: (!iterates).then_some(counts.flops),
            iterations: iterates.then(|| system.iterations()),
            residual_history: iterates.then(|| system.history.clone()),
        }
    }
}

fn dof_names(system: &System) -> Vec<&'static str> {
    system.group.dofs().iter().map(|dof| dof.name()).collect()
}

impl TimingsEntry {
    /// The entry of a solution.
    pub fn new(solution: &Solution) -> Self {
        let t = &solution.timings;
        Self {
            analyse_s: t.order_s + t.symbolic_s,
            order_s: t.order_s,
            symbolic_s: t.symbolic_s,
            assemble_s: t.assemble_s,
            factor_s: t.factor_s,
            solve_s: t.solve_s,
            gflop_per_s: rate(solution),
            threads: solution.systems.iter().map(|system| system.threads).max(),
            peak_memory_bytes: peak_memory(),
        }
    }
}

/// Rate of the factorisations (GFLOP/s); `None` without one.
fn rate(s: &Solution) -> Option<f64> {
    let flops: f64 = s.systems.iter().map(|system| system.counts.flops).sum();
    (flops > 0.0 && s.timings.factor_s > 0.0).then(|| 1e-9 * flops / s.timings.factor_s)
}

/// Most memory that this process has held so far; `None` where the system does not tell (Linux does).
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.parse::<u64>().ok().map(|kib| 1024 * kib)
}

/// The same for people: one row for every system.
pub(super) fn text<'a>(results: impl Iterator<Item = &'a CaseResult>) -> String {
    let mut systems =
        Columns::new(["system", "path", "threads", "rows", "nnz(L)", "GFLOP", "MB", "iterations"]);
    let mut seconds =
        Columns::new(["ms", "order", "symbolic", "assemble", "factor", "solve", "GFLOP/s", "residual"]);
    for r in results {
        r.solution.systems.iter().for_each(|s| systems.row(row(&r.case, s)));
        let t = r.solution.timings;
        let phases = [t.order_s, t.symbolic_s, t.assemble_s, t.factor_s, t.solve_s];
        let rate = rate(&r.solution).map_or_else(String::new, significant);
        let head = [r.case.clone()].into_iter().chain(phases.map(|s| significant(1e3 * s)));
        seconds.row(head.chain([rate, format!("{:.1e}", r.solution.residual)]));
    }
    let memory = peak_memory().map_or_else(String::new, |b| format!("peak memory {} MB\n", b / 1_000_000));
    [systems, seconds].iter().filter(|t| !t.is_empty()).map(|t| t.text() + "\n").collect::<String>() + &memory
}

fn row(case: &str, s: &System) -> [String; 8] {
    let c = &s.counts;
    let direct = |number: String| if s.history.is_empty() { number } else { String::new() };
    [
        format!("{case}: {}", dof_names(s).join(" ")),
        s.path.into(),
        s.threads.to_string(),
        c.rows.to_string(),
        direct(c.nnz_l.to_string()),
        direct(significant(1e-9 * c.flops)),
        significant(1e-6 * c.bytes as f64),
        if s.history.is_empty() { String::new() } else { s.iterations().to_string() },
    ]
}
