//! Bending tests as text.

use super::measured::{measured, role};
use crate::quantity::{STANDARD_GRAVITY, significant};
use crate::results::columns::Columns;
use crate::results::task::Task;
use crate::study::bending::{
    Agreement, BendLoop, BendLoops, BendingResult, Cantilever, HeartLoop, Simulated,
};

/// One table for each kind of test among the results.
pub(in crate::results) fn texts(results: &[(&Task, &BendingResult)]) -> Vec<String> {
    let mut cantilevers = Columns::new([
        "cantilever",
        "fabric",
        "overhang (mm)",
        "c elastic (mm)",
        "(B/w)^1/3 (mm)",
        "c friction (mm)",
        "µ = HB c/B",
        "c measured (mm)",
        "B by Peirce's formula",
    ]);
    let mut hearts = Columns::new([
        "heart loop",
        "fabric",
        "L (mm)",
        "height (mm)",
        "exact (mm)",
        "B read (µN·m)",
        "B (µN·m)",
    ]);
    let mut fab = Columns::new([
        "FAB",
        "fabric",
        "test",
        "role",
        "law",
        "B (µN·m)",
        "HB (µN)",
        "clamps (°)",
        "outer NRMSE",
        "R²",
        "inner NRMSE",
        "own zero",
        "held out",
        "its inner",
        "zero (gf)",
    ]);
    for (task, result) in results {
        match result {
            BendingResult::Cantilever(tests) => {
                tests.iter().for_each(|c| cantilevers.row(cantilever_row(task, c)))
            }
            BendingResult::HeartLoop(tests) => tests.iter().for_each(|h| hearts.row(heart_row(task, h))),
            BendingResult::FabBendLoop(directions) => {
                directions.iter().flat_map(|d| fab_rows(task, d)).for_each(|row| fab.row(row));
            }
        }
    }
    [cantilevers, hearts, fab].into_iter().filter_map(Columns::filled).map(|t| t.text()).collect()
}

pub(super) fn mm(metres: f64) -> String {
    significant(1e3 * metres)
}

fn micro(value: f64) -> String {
    significant(1e6 * value)
}

fn cantilever_row(task: &Task, c: &Cantilever) -> Vec<String> {
    let friction = c.friction.as_ref().map(|f| f.bending_length);
    vec![
        c.direction.to_string(),
        task.shown_fabric(),
        mm(c.overhang),
        mm(c.bending_length),
        mm(c.closed_form),
        or_dash(friction, mm),
        or_dash(c.friction.as_ref(), |f| significant(f.mu)),
        or_dash(measured(task, c), mm),
        format!("+{} %", significant(100.0 * c.peirce_excess())),
    ]
}

fn heart_row(task: &Task, h: &HeartLoop) -> Vec<String> {
    vec![
        h.direction.to_string(),
        task.shown_fabric(),
        mm(h.length),
        mm(h.height),
        or_dash(h.closed_form, mm),
        or_dash(h.rigidity, micro),
        micro(h.section_rigidity),
    ]
}

/// Two rows a test: elastic, and with friction.
fn fab_rows(task: &Task, d: &BendLoops) -> Vec<Vec<String>> {
    let percent = |a: Option<Agreement>| or_dash(a, |a| format!("{} %", significant(100.0 * a.nrmse)));
    let degrees = |angle: f64| significant(angle.to_degrees());
    let row = |l: &BendLoop, law: [String; 4], s: &Simulated, held_out: Option<&Simulated>| {
        let head =
            [d.direction.to_string(), task.shown_fabric(), l.kind.name().to_string(), role(l).to_string()];
        let figures = [
            percent(s.outer),
            or_dash(s.outer, |a| significant(a.r2)),
            percent(s.inner),
            percent(s.inner_with_own_zero),
            percent(held_out.and_then(|s| s.outer)),
            percent(held_out.and_then(|s| s.inner)),
            significant(s.zero / GRAM_FORCE),
        ];
        head.into_iter().chain(law).chain(figures).collect()
    };
    d.loops
        .iter()
        .flat_map(|l| {
            let e = &d.elastic;
            let law = ["elastic".into(), micro(e.rigidity), "-".into(), degrees(e.inclination)];
            let elastic = row(l, law, &l.elastic, l.held_out[0].as_ref());
            let friction = d.friction.as_ref().zip(l.friction.as_ref()).map(|(f, s)| {
                let [b, hb] = [f.kes_rigidity, f.kes_couple].map(micro);
                let law = ["friction".into(), b, hb, degrees(f.inclination)];
                row(l, law, s, l.held_out[1].as_ref())
            });
            std::iter::once(elastic).chain(friction)
        })
        .collect()
}

/// N.
const GRAM_FORCE: f64 = 1e-3 * STANDARD_GRAVITY;

pub(super) fn or_dash<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or("-".into(), text)
}
