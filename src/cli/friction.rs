//! Friction laws as text, and their parameters beside the measured ones.

use super::output::Columns;
use crate::characterise::{Basis, FabricSheet};
use crate::instrument::{Direction, Parameter};
use crate::quantity::significant;
use crate::report::chart::ParityPoint;
use crate::report::table::UnitSystem;

/// One line a law, then one line a parameter that is re-extracted from its simulated cycle; empty for
/// a sheet without laws.
pub fn text(sheet: &FabricSheet, units: UnitSystem) -> String {
    if sheet.laws.is_empty() {
        return String::new();
    }
    let headings = ["friction law", "", "", "fit (%)", "line (%)", "noise (%)", "loop energy (%)"];
    let mut laws = Columns::new(headings);
    let percent = |v: f64| format!("{:.2}", 100.0 * v);
    for law in &sheet.laws {
        let basis = match law.basis {
            Basis::Loop => format!("specimen {}", law.specimen),
            Basis::Strip => format!("strip S{}", law.specimen),
            Basis::AssumedSpectrum => "assumed spectrum".into(),
        };
        let direction = law.direction.map_or("", Direction::name);
        let fit = law.fit.as_ref().map(|f| {
            let of = [Some(f.fitted.nrmse), Some(f.fitted.line_nrmse), Some(f.noise), f.fitted.loop_energy];
            of.map(|v| v.map_or("-".into(), percent))
        });
        laws.row(
            [law.test.name().into(), direction.into(), basis].into_iter().chain(fit.unwrap_or_default()),
        );
    }
    let mut values = Columns::new(["from the law", "", "simulated", "measured", "difference (%)", "unit"]);
    for r in sheet.re_extracted() {
        let (unit, factor) = units.of(r.key.parameter);
        let [ours, theirs] = [r.simulated.mean, r.measured.mean];
        values.row([
            r.key.parameter.symbol().to_string(),
            r.key.direction.map_or("", Direction::name).into(),
            significant(ours / factor),
            significant(theirs / factor),
            if theirs == 0.0 { "-".into() } else { percent(ours / theirs - 1.0) },
            unit.to_string(),
        ]);
    }
    let values = if values.is_empty() { String::new() } else { format!("\n{}", values.text()) };
    format!("\n{}{values}", laws.text())
}

/// Charts of re-extracted against measured parameters over all fabrics: file, title, parameters.
/// Four panels are what a page has room for.
pub const PARITY: [(&str, &str, [Parameter; 4]); 2] = [
    (
        "friction_stiffness.png",
        "Friction laws: stiffness and width",
        [Parameter::B, Parameter::Hb, Parameter::G, Parameter::Hg],
    ),
    (
        "friction_energy.png",
        "Friction laws: energy and resilience",
        [Parameter::Wt, Parameter::Rt, Parameter::Wc, Parameter::Rc],
    ),
];

/// Points of the charts of [`PARITY`].
pub fn parity(sheet: &FabricSheet) -> Vec<ParityPoint> {
    sheet
        .re_extracted()
        .into_iter()
        .filter(|r| PARITY.iter().any(|page| page.2.contains(&r.key.parameter)))
        .map(|r| {
            let p = r.key.parameter;
            ParityPoint {
                label: sheet.name.clone(),
                group: if r.from_loops { "from a loop" } else { "assumed spectrum" }.into(),
                quantity: p.symbol().into(),
                unit: p.kes_unit().into(),
                measured: r.measured.mean / p.kes_factor(),
                measured_half_width: r.measured.ci95().map(|half| half / p.kes_factor()),
                simulated: r.simulated.mean / p.kes_factor(),
                simulated_half_width: None,
                simulated_band: None,
            }
        })
        .collect()
}
