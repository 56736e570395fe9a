//! Friction laws as text, and their parameters beside the measured ones.

use super::columns::Columns;
use super::failure::Failure;
use super::folder::Folder;
use crate::characterise::{Basis, FabricSheet};
use crate::instrument::{Direction, Parameter, Shape, Test};
use crate::quantity::significant;
use crate::report::chart::{self, ParityPoint};
use crate::report::html::{Figure, FigureKind};
use crate::report::table::UnitSystem;

/// One line a law, then one line a parameter that is re-extracted from its simulated cycle; empty for
/// a sheet without laws.
pub(super) fn text(sheet: &FabricSheet, units: UnitSystem) -> String {
    if sheet.laws.is_empty() {
        return String::new();
    }
    let headings = ["friction law", "", "", "fit (%)", "line (%)", "noise (%)", "energy error (%)"];
    let mut laws = Columns::new(headings);
    for law in &sheet.laws {
        let basis = match law.basis {
            Basis::Loop => format!("specimen {}", law.specimen),
            Basis::Strip => format!("strip S{}", law.specimen),
            Basis::BendLoops => "bend loops".into(),
            Basis::AssumedSpectrum => "assumed spectrum".into(),
        };
        let direction = law.direction.map_or("", Direction::name);
        let fit = law.fit.as_ref().map(|f| {
            let shares =
                [Some(f.fitted.nrmse), Some(f.fitted.line_nrmse), Some(f.noise), f.fitted.loop_energy];
            shares.map(|v| v.map_or("-".into(), percent))
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

/// Charts of re-extracted against measured parameters over all fabrics: name, title, parameters.
/// Four panels are what a page has room for.
const PARITY: [(&str, &str, [Parameter; 4]); 2] = [
    (
        "friction_stiffness",
        "Friction laws: stiffness and width",
        [Parameter::B, Parameter::Hb, Parameter::G, Parameter::Hg],
    ),
    (
        "friction_energy",
        "Friction laws: energy and resilience",
        [Parameter::Wt, Parameter::Rt, Parameter::Wc, Parameter::Rc],
    ),
];

/// Writes the charts of [`PARITY`]; those that there are.
pub(crate) fn write_parity(folder: &Folder, points: &[ParityPoint]) -> Result<Vec<Figure>, Failure> {
    let subtitle =
        "read from the simulated cycle of each friction law, by the evaluation of instrument files";
    let mut drawn = Vec::new();
    for (stem, title, parameters) in PARITY {
        let is_of_page = |p: &&ParityPoint| parameters.iter().any(|q| q.symbol() == p.quantity);
        let points: Vec<ParityPoint> = points.iter().filter(is_of_page).cloned().collect();
        if let Some(picture) = folder.chart(stem, || chart::parity(&points, title, subtitle))? {
            let alt = format!(
                "{title}: one point a fabric and parameter, {} in all, on the line where simulated equals measured.",
                points.len()
            );
            drawn.push(Figure { caption: title.into(), alt, picture, kind: FigureKind::Overview });
        }
    }
    Ok(drawn)
}

/// Writes the charts `<fabric>/friction_bending` ...: laws beside the loops behind them; those that there are.
pub(super) fn write_charts(folder: &Folder, sheet: &FabricSheet) -> Result<Vec<Figure>, Failure> {
    let mut drawn = Vec::new();
    let looped = Test::ALL.into_iter().filter(|test| test.shape() != Shape::Sweep);
    for test in looped.map(Some).chain([None]) {
        let what = test.map_or("strips", Test::name);
        let stem = format!("{}/friction_{what}", sheet.name);
        if let Some(picture) = folder.chart(&stem, || chart::friction(sheet, test))? {
            let alt = format!(
                "Laws of friction of {}, {what}: the loops of the laws over the measured ones.",
                sheet.name
            );
            let caption = format!("friction: {what}");
            drawn.push(Figure { caption, alt, picture, kind: FigureKind::Friction });
        }
    }
    Ok(drawn)
}

/// Points of the charts of [`PARITY`].
pub(super) fn parity_points(sheet: &FabricSheet) -> Vec<ParityPoint> {
    sheet
        .re_extracted()
        .into_iter()
        .filter(|r| PARITY.iter().any(|page| page.2.contains(&r.key.parameter)))
        .map(|r| {
            let p = r.key.parameter;
            ParityPoint {
                label: sheet.name.clone(),
                group: format!(
                    "{}, {} data",
                    if r.from_loops { "from a loop" } else { "assumed spectrum" },
                    sheet.info.origin.name()
                ),
                quantity: p.symbol().into(),
                unit: p.kes_unit().into(),
                measured: r.measured.mean / p.kes_factor(),
                measured_half_width: r.measured.ci95().map(|half| half / p.kes_factor()),
                simulated: r.simulated.mean / p.kes_factor(),
                simulated_half_width: None,
                simulated_band: None,
                is_closed_loop: false,
                status: sheet.status(r.key),
            }
        })
        .collect()
}

fn percent(ratio: f64) -> String {
    format!("{:.2}", 100.0 * ratio)
}
