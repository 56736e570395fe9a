//! Measurements in, KES parameters with statistics out.
//!
//! Definitions and windows follow Kawabata's standard conditions; everything that laboratories do
//! differently is a field of [`Settings`]. Raw curves are never altered: corrected branches, the
//! correction itself and the fitted lines stand beside them in [`SpecimenResult`].

pub mod bend_loop;
mod branch;
mod buckled;
mod checks;
mod choices;
mod crossing;
#[cfg(test)]
mod doubtful;
pub mod drape;
mod evaluation;
mod friction;
mod graph;
mod onset;
#[cfg(test)]
mod oracles;
mod recording;
mod relations;
mod saturation;
mod settings;
mod sheet;
mod simulated;
mod specimen;
mod spread;
mod statistics;
mod status;
mod strip;
mod strip_bending;
mod tables;

pub use crate::kes::{Key, ValueStatus};
pub use choices::{CycleChoice, Modulus, Sides, SlopeMethod, Sweeps};
pub(crate) use friction::nnls::nnls;
pub use friction::{
    Basis, ClosedForm, CycleFit, FrictionLaw, LawBand, LawTrace, LoopFit, ReExtracted, Relaxation,
    StripMemory, bending_law, cycle, extract,
};
pub use graph::LineFit;
pub use settings::Settings;
pub use sheet::{Branch, FabricSheet, RunTo, SpecimenResult, Window};
pub use simulated::parameters;
pub use spread::{MeanBranch, mean_branches};
pub use strip::{StripCycle, StripTest};

use crate::finding::Place;
use crate::instrument::{FabricInput, Measurement};

/// The parameter sheet of a fabric.
///
/// Never fails: what cannot be evaluated is left out and told in [`FabricSheet::findings`]
/// (codes `K001` ...), which begin with the findings of reading. Values of result tables pass
/// into the sheet as they are, unless curves give the same parameter.
pub fn characterise(input: &FabricInput, settings: &Settings) -> FabricSheet {
    let mut findings = input.findings.clone();
    findings.extend(checks::records(input));
    let (mut measurements, copies) = checks::originals(input);
    findings.extend(copies);
    measurements.sort_by_key(|m| (m.test, m.direction, m.specimen));
    let evaluated = |m: &Measurement| {
        let mut m = m.clone();
        m.conditions.maximum = settings.maximum(m.test).unwrap_or(m.conditions.maximum);
        let dropouts =
            recording::check(settings, &mut evaluation::Notes { measurement: &m, findings: &mut findings });
        specimen::evaluate(&m, &dropouts, settings, &mut findings)
    };
    let specimens = measurements.into_iter().filter_map(evaluated).collect();
    let mut sheet = FabricSheet {
        name: input.name.clone(),
        info: input.info.clone(),
        specimens,
        sources: input.sources.clone(),
        settings: settings.clone(),
        findings,
        ..Default::default()
    };
    for specimen in &sheet.specimens {
        let (m, conditions) = (&specimen.measurement, specimen.conditions(settings.cycle));
        let first = sheet.run_to.entry((m.test, m.direction));
        let first = first.or_insert(RunTo { conditions: conditions.clone(), alike: true });
        first.alike &= (conditions.maximum / first.conditions.maximum - 1.0).abs() <= 0.05;
    }
    statistics::pool(&mut sheet);
    let mut found = statistics::outliers(&sheet, settings);
    found.extend(statistics::swapped(&sheet));
    sheet.findings.append(&mut found);
    tables::merge(&mut sheet, input, settings);
    let mut found = statistics::no_repeats(&sheet, input);
    sheet.findings.append(&mut found);
    strip::add(&mut sheet, &input.fab, settings);
    tables::metadata(&mut sheet, input);
    tables::stiffnesses(&mut sheet, input, settings);
    tables::moduli(&mut sheet, settings);
    friction::add(&mut sheet, settings);
    let mut found = checks::plausibility(&sheet, input);
    found.extend(relations::relations(&sheet, input));
    found.extend(checks::shear_directions(&sheet, settings));
    sheet.findings.append(&mut found);
    status::assign(&mut sheet);
    // What concerns the fabric as a whole is found in its folder.
    for finding in sheet.findings.iter_mut().filter(|f| f.place.is_none() && *input.path != *"") {
        finding.place = Some(Place::file(&input.path));
    }
    // Several checks may lead to the same remark.
    let mut seen = std::collections::BTreeSet::new();
    sheet.findings.retain(|f| seen.insert(f.to_string()));
    sheet
}
