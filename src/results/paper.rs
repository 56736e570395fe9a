//! Pictures of the claims of the paper of Nguyen-Trong, Ferreira and Gomes.

use super::failure::Failure;
use super::folder::Folder;
use crate::report::chart::{self, CurvesPlot, FieldPlot, ViewPlot};
use crate::verify::{BentPlate, Claim, CurveChart, SheetPicture, VerifyError};

/// Height of the largest deflection in the view, over the side.
const EXAGGERATION: f64 = 0.25;

/// Writes the pictures of the claims.
///
/// # Errors
/// Those of the problems, of the drawing and of the folder.
pub fn write_claims(claims: &[Claim], folder: &Folder<'_>) -> Result<(), Failure> {
    for claim in claims {
        claim.charts.iter().try_for_each(|chart| write_curves(chart, folder))?;
        claim.sheets.iter().try_for_each(|sheet| write_sheet(sheet, folder))?;
    }
    Ok(())
}

fn write_curves(chart: &CurveChart, folder: &Folder<'_>) -> Result<(), Failure> {
    let computed = chart.computed().map_err(failed)?;
    let plot = CurvesPlot {
        title: chart.title.clone(),
        subtitle: chart.subtitle.clone(),
        x: chart.x.clone(),
        y: chart.y.clone(),
        curves: computed.into_iter().map(|curve| (curve.name, curve.points)).collect(),
    };
    folder.chart(&chart.stem, || chart::curves(&plot))?;
    Ok(())
}

/// `<stem>_stress`, the map of the moment, and `<stem>_view`, the sheet with it.
fn write_sheet(sheet: &SheetPicture, folder: &Folder<'_>) -> Result<(), Failure> {
    let bent = sheet.bent().map_err(failed)?;
    let quantity = "M_x/(q L²)";
    let map = FieldPlot {
        title: sheet.title.clone(),
        subtitle: sheet.subtitle.clone(),
        quantity: quantity.into(),
        unit: String::new(),
        nodes: &bent.nodes,
        quads: &bent.quads,
        values: &bent.moment,
        ..FieldPlot::default()
    };
    folder.chart(&format!("{}_stress", sheet.stem), || chart::field(&map))?;
    let nodes = raised(&bent);
    let view = ViewPlot {
        title: sheet.title.clone(),
        subtitle: sheet.subtitle.clone(),
        origin: String::new(),
        quantity: quantity.into(),
        nodes: &nodes,
        quads: &bent.quads,
        values: &bent.moment,
        remarks: vec![format!("Deflection drawn so that the largest is {EXAGGERATION} of the side.")],
    };
    folder.chart(&format!("{}_view", sheet.stem), || chart::sheet_view(&view))?;
    Ok(())
}

/// The nodes with their deflection.
fn raised(bent: &BentPlate) -> Vec<[f64; 3]> {
    let height = EXAGGERATION * bent.side;
    bent.nodes.iter().zip(&bent.deflection).map(|([x, y, z], w)| [*x, *y, z + height * w]).collect()
}

fn failed(error: VerifyError) -> Failure {
    Failure::new(error.code(), error.to_string())
}
