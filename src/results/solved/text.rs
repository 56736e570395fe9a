//! Solved cases as text.

use std::collections::BTreeSet;

use super::{adapted, all_grounds, convergence, effort, search, thickness_grounds};
use crate::model::Model;
use crate::quantity::significant;
use crate::results::columns::Columns;
use crate::results::rests_on;
use crate::results::task::Task;
use crate::study::{CaseResult, IN_PLANE, Status};

/// Deflections, then frequencies, probes, what the mesh leaves open, histories, searches and checks; with `verbose`
/// every step of a search; then why a deflection has no band; with `verbose` what each solution took.
pub(in crate::results) fn text(solved: &[(&Task, &CaseResult)], verbose: bool) -> String {
    let headings =
        ["case", "fabric", "w_max (mm)", "± 95 % (mm)", "w/t_b", "elements", "energy error (%)", "status"];
    let mut table = Columns::new(headings);
    let mut in_plane = Columns::new([
        "case",
        "fabric",
        "in plane (mm)",
        "± 95 % (mm)",
        "elements",
        "energy error (%)",
        "status",
    ]);
    let mut probes_in_plane =
        Columns::new(["probe", "case", "fabric", "u (mm)", "± 95 % (mm)", "v (mm)", "± 95 % (mm)"]);
    let mut probes = Columns::new(["probe", "case", "fabric", "u (mm)", "v (mm)", "w (mm)", "± 95 % (mm)"]);
    let mut modes = Columns::new(["mode", "case", "fabric", "frequency (Hz)", "± 95 % (Hz)", "elements"]);
    let mut factors = Columns::new(["buckle", "case", "fabric", "load factor", "elements"]);
    // That a linear solve cannot hold for cloth is said once, however many fabrics there are.
    let beyond = solved.iter().filter(|(_, r)| r.status == Status::BeyondLinear).count();
    for (task, r) in solved {
        let (fabric, grounds) = (task.shown_fabric(), all_grounds(task, r));
        let mark = rests_on::mark(&grounds);
        for (k, f) in r.frequencies.iter().enumerate() {
            let elements = elements(&r.model);
            let half = half_width(r, &format!("frequency_{}", k + 1), 1.0);
            let frequency = significant(*f) + &mark;
            modes.row([(k + 1).to_string(), r.case.clone(), fabric.clone(), frequency, half, elements]);
        }
        for (k, f) in r.load_factors.iter().enumerate() {
            let elements = elements(&r.model);
            let factor = significant(*f) + &mark;
            factors.row([(k + 1).to_string(), r.case.clone(), fabric.clone(), factor, elements]);
        }
        if r.is_modal() {
            // The shape of a mode has no size.
            continue;
        }
        let of_ratio = [grounds, thickness_grounds(task)].concat();
        let ratio = significant(r.w_over_thickness) + &rests_on::mark(&of_ratio);
        let w = significant(1e3 * r.w_max) + &mark;
        let elements = elements(&r.model);
        let status = status(r.status).to_string();
        if r.lies_in_its_plane() {
            let within = significant(1e3 * r.in_plane_max()) + &mark;
            let half = half_width(r, IN_PLANE, 1e3);
            in_plane.row([r.case.clone(), fabric.clone(), within, half, elements, error(r), status]);
        } else {
            let half = half_width(r, "w_max", 1e3);
            table.row([r.case.clone(), fabric.clone(), w, half, ratio, elements, error(r), status]);
        }
        for p in &r.probes {
            let u = p.value.u.map(|u| significant(1e3 * u));
            let half = |component: &str| half_width(r, &format!("{}.{component}", p.name), 1e3);
            let head = [p.name.clone(), r.case.clone(), fabric.clone()];
            if r.lies_in_its_plane() {
                let [u, v, _] = u.map(|u| u + &mark);
                probes_in_plane.row(head.into_iter().chain([u, half("u"), v, half("v")]));
            } else {
                let [u, v, w] = u;
                probes.row(head.into_iter().chain([u, v, w + &mark, half("w")]));
            }
        }
    }
    if beyond > 1 {
        let note = format!(
            "beyond linear: {beyond} of {} results say how stiff a sheet is, not what shape it takes",
            solved.len()
        );
        table = table.with_note(&note);
    }
    let steps = if verbose { search::steps(solved) } else { None };
    let parts = [
        table.filled(),
        in_plane.filled(),
        modes.filled(),
        factors.filled(),
        probes.filled(),
        probes_in_plane.filled(),
        convergence::table(solved),
        adapted::meshes(solved),
        adapted::quantities(solved),
        histories(solved),
        search::searches(solved),
        search::load_steps(solved),
        search::eigenvalues(solved),
        steps,
        checks(solved.iter().map(|(_, r)| *r)),
    ];
    let tables = parts.into_iter().flatten().map(|t| t.text());
    let text = tables.chain(without_band(solved)).collect::<Vec<_>>().join("\n");
    let costs = verbose.then(|| effort::text(solved.iter().map(|(_, r)| *r)));
    [text].into_iter().chain(costs).collect::<Vec<_>>().join("\n")
}

/// How many elements, and how many of them are triangles.
fn elements(model: &Model) -> String {
    let (all, triangles) = (model.mesh.quads.len(), model.mesh.triangles());
    match triangles {
        0 => all.to_string(),
        1 => format!("{all}, 1 triangle"),
        _ => format!("{all}, {triangles} triangles"),
    }
}

/// How dynamic analyses went, if there are any: instants kept, and what the balance of kinetic, strain and
/// potential energy, damping and work misses at most, over the largest work.
fn histories(solved: &[(&Task, &CaseResult)]) -> Option<Columns> {
    let mut table =
        Columns::new(["dynamics", "fabric", "instants", "end (s)", "energy imbalance (% of work)"]);
    for (task, r) in solved {
        let Some(history) = &r.history else { continue };
        table.row([
            r.case.clone(),
            task.shown_fabric(),
            history.time.len().to_string(),
            history.time.last().map_or("-".into(), |t| significant(*t)),
            significant(100.0 * history.imbalance),
        ]);
    }
    table.filled()
}

/// The inputs without a spread that forbid the band of a largest deflection or first frequency, if there are any.
fn without_band(solved: &[(&Task, &CaseResult)]) -> Option<String> {
    let first = |(_, r): &(&Task, &CaseResult)| {
        let u = r.uncertainty.as_ref()?;
        u.of("w_max").or_else(|| u.of("frequency_1")).or_else(|| u.of(IN_PLANE)).cloned()
    };
    let uncertain: Vec<_> = solved.iter().filter_map(first).collect();
    let names: BTreeSet<&str> =
        uncertain.iter().flat_map(|p| &p.without_spread).map(String::as_str).collect();
    let names = names.into_iter().collect::<Vec<_>>().join(", ");
    (!names.is_empty()).then(|| format!("no band (-) where no spread is known of: {names}\n"))
}

/// Half of the 95 % band of the mean fabric of a quantity, times `unit`; `-` where it has none.
fn half_width(result: &CaseResult, quantity: &str, unit: f64) -> String {
    let bands = result.uncertainty.as_ref().and_then(|u| u.of(quantity)?.bands);
    bands.map_or("-".into(), |b| significant(unit * b.mean_fabric.half_width))
}

/// The estimated error of a result in the energy norm (%); `-` where there is no estimate.
fn error(result: &CaseResult) -> String {
    let estimate = result.error_estimate().ok().flatten();
    estimate.map_or("-".into(), |estimate| format!("{:.1}", 100.0 * estimate.relative()))
}

/// The checks of cases, if there are any.
pub(crate) fn checks<'a>(results: impl Iterator<Item = &'a CaseResult>) -> Option<Columns> {
    let mut table =
        Columns::new(["check", "case", "found", "expected", "unit", "error", "tolerance", "outcome"]);
    for r in results {
        for c in &r.checks {
            let percent = |v: f64| format!("{} %", significant(100.0 * v));
            let numbers = [format!("{:.6e}", c.value), format!("{:.6e}", c.expected), c.unit.to_string()];
            let errors = [percent(c.relative_error), percent(c.relative_tolerance)];
            let outcome = if c.passed { "holds" } else { "fails" };
            let head = [c.quantity.clone(), r.case.clone()];
            table.row(head.into_iter().chain(numbers).chain(errors).chain([outcome.to_string()]));
        }
    }
    table.filled()
}

/// The status of a result in words.
pub(in crate::results) fn status(status: Status) -> &'static str {
    match status {
        Status::Ok => "ok",
        Status::BeyondLinear => "beyond linear",
        Status::CheckFailed => "check failed",
        Status::NotConverged => "not converged",
    }
}
