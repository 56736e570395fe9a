//! Simulated tests as text.

use std::collections::{BTreeMap, BTreeSet};

use super::{Stiffness, Tested};
use crate::instrument::Parameter;
use crate::quantity::{Estimate, significant};
use crate::results::columns::Columns;
use crate::results::rests_on;
use crate::results::sheet_text::{BOTH, BOTH_LEGEND};
use crate::results::task::Task;

/// One line a test, then what is to be said of some.
pub(in crate::results) fn text(compared: &[(&Task, &Tested)]) -> String {
    let mut table = Columns::new([
        "test",
        "fabric",
        "",
        "simulated",
        "± 95 %",
        "measured",
        "± 95 %",
        "unit",
        "edge effect",
        "closed form",
        "RMSE",
        "NRMSE",
        "R²",
        "n",
    ]);
    for (task, t) in compared {
        table.row(text_row(task, t));
    }
    if compared.iter().any(|(_, t)| t.stiffness.as_ref().is_some_and(|stiffness| stiffness.is_of_both)) {
        table = table.with_note(BOTH_LEGEND);
    }
    let uncertain = compared.iter().filter_map(|(_, t)| t.simulated.uncertainty.as_ref());
    let unknown: BTreeSet<&str> = uncertain.flat_map(|p| &p.without_spread).map(String::as_str).collect();
    let unknown = unknown.into_iter().collect::<Vec<_>>().join(", ");
    let without = if unknown.is_empty() {
        String::new()
    } else {
        format!("no band (-) where no spread is known of: {unknown}\n")
    };
    let notes: Vec<String> = compared.iter().flat_map(|(task, t)| notes(task, t)).collect();
    [table.text(), without, notes.concat()].concat()
}

fn text_row(task: &Task, t: &Tested) -> Vec<String> {
    let mut cells = vec![t.name.clone(), task.shown_fabric()];
    match &t.stiffness {
        Some(Stiffness { symbol, unit, measured, is_of_both }) => cells.extend([
            symbol.to_string(),
            significant(t.simulated.apparent) + &rests_on::mark(&t.grounds),
            or_dash(t.band().map(|b| b.half_width)),
            or_dash(measured.as_ref().map(|e| e.mean)) + if *is_of_both { BOTH } else { "" },
            or_dash(measured.as_ref().and_then(Estimate::ci95)),
            unit.to_string(),
        ]),
        None => cells.extend([const { String::new() }; 6]),
    }
    let edge = t.simulated.edge.as_ref();
    cells.push(edge.map_or("-".into(), |e| fixed(e.ratio)));
    cells.push(edge.and_then(|e| e.closed_form).map_or("-".into(), fixed));
    match &t.comparison {
        Some(c) => cells.extend([
            format!("{} {}", significant(c.rmse), c.unit),
            significant(c.nrmse),
            significant(c.r2),
            c.n.to_string(),
        ]),
        None => cells.extend(["-", "-", "-", "0"].map(String::from)),
    }
    cells
}

fn or_dash(value: Option<f64>) -> String {
    value.map_or("-".into(), significant)
}

/// A ratio near 1.
fn fixed(ratio: f64) -> String {
    format!("{ratio:.5}")
}

/// What a tension across the specimen adds, where the specimen buckles, and the parameters of a cycle.
fn notes(task: &Task, t: &Tested) -> Vec<String> {
    let (simulated, name) = (&t.simulated, &t.name);
    let mut notes = Vec::new();
    if let Some(tension) = simulated.edge.as_ref().and_then(|e| e.tension) {
        let [value, adds] = [tension.value, tension.adds].map(significant);
        let without = significant(simulated.apparent - tension.adds);
        notes
            .push(format!("{name}: {without} N/m, and {adds} N/m by the tension of {value} N/m across it\n"));
    }
    if let Some(x) = simulated.unstable_from {
        let unit = match simulated.test.axes()[0] {
            "1" => "strain",
            unit => unit,
        };
        notes.push(format!("{name}: the specimen buckles before {} {unit}\n", significant(x)));
    }
    let values: BTreeMap<Parameter, f64> =
        simulated.cycle.as_ref().map_or_else(BTreeMap::new, |cycle| cycle.values.clone());
    for (p, value) in values {
        let measured = task.measured(p, simulated.direction).map(|m| m / p.kes_factor());
        let (value, unit) = (significant(value / p.kes_factor()), p.kes_unit());
        let measured = or_dash(measured);
        let of = if task.is_of_both(p, simulated.direction) { " for warp and weft together" } else { "" };
        notes.push(format!(
            "{name}: {p} {value} {unit} in the simulated cycle with friction, {measured} measured{of}\n"
        ));
    }
    notes
}
