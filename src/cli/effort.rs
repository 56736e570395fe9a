//! What a solution took: systems, counts, memory and seconds.

use serde_json::{Value, json};

use super::output::Columns;
use crate::quantity::significant;
use crate::solve::{Solution, System};
use crate::study::CaseResult;

/// `solver` of an entry of `kesf.solution/1`: what does not depend on the machine.
pub fn document(s: &Solution) -> Value {
    let systems: Vec<Value> = s
        .systems
        .iter()
        .map(|system| {
            let c = &system.counts;
            let mut entry = json!({
                "dofs": system.group.dofs().iter().map(|d| d.name()).collect::<Vec<_>>(),
                "path": system.path, "rows": c.rows, "nnz_a": c.nnz_a, "bytes": c.bytes,
            });
            if system.history.is_empty() {
                entry["nnz_l"] = json!(c.nnz_l);
                entry["flops"] = json!(c.flops);
            } else {
                entry["iterations"] = json!(system.iterations());
                entry["residual_history"] = json!(system.history);
            }
            entry
        })
        .collect();
    json!({ "residual": s.residual, "systems": systems })
}

/// `timings`: seconds, rate, threads and the peak memory of the process, which differ from run to run.
pub fn timings(s: &Solution) -> Value {
    let t = &s.timings;
    json!({
        "analyse_s": t.order_s + t.symbolic_s, "order_s": t.order_s, "symbolic_s": t.symbolic_s, "assemble_s": t.assemble_s,
        "factor_s": t.factor_s, "solve_s": t.solve_s,
        "gflop_per_s": rate(s),
        "threads": s.systems.iter().map(|system| system.threads).max(),
        "peak_memory_bytes": peak_memory(),
    })
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
pub fn text<'a>(results: impl Iterator<Item = &'a CaseResult>) -> String {
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
        format!("{case}: {}", s.group.dofs().iter().map(|d| d.name()).collect::<Vec<_>>().join(" ")),
        s.path.into(),
        s.threads.to_string(),
        c.rows.to_string(),
        direct(c.nnz_l.to_string()),
        direct(significant(1e-9 * c.flops)),
        significant(1e-6 * c.bytes as f64),
        if s.history.is_empty() { String::new() } else { s.iterations().to_string() },
    ]
}
