//! The open fabric file `kesf.fabric/1`: curves as recorded, parameters, laws, section, uncertainty, provenance.

use serde_json::{Value, json};

use super::card::{Card, CardError, CardInput, Exporter};
use super::text::provenance;
use crate::characterise::SpecimenResult;
use crate::report::json::{section_document, sheet_document, text};
use crate::section::ShellSection;

/// `kesf export --to fabric`.
pub static EXPORTER: Exporter = Exporter {
    name: "fabric",
    ending: "fabric.json",
    title: "open fabric file kesf.fabric/1: curves as recorded, parameters, friction laws, section, bands; SI",
    holds: "everything, as docs/schemas/open-fabric.json describes it; an input of kesf for its values, its laws and its section, \
            not for its curves and notes.",
    write,
};

/// The schema is `docs/schemas/open-fabric.json`.
fn write(material: &CardInput<'_>, _: &ShellSection) -> Result<Card, CardError> {
    let wrong = |e: serde_json::Error| CardError::Json { program: "kesf.fabric/1", reason: e.to_string() };
    let CardInput { sheet, made, stamp, .. } = *material;
    let section = section_document([(sheet, made)]);
    let mut parameters = serde_json::to_value(sheet_document([sheet], None)).map_err(wrong)?;
    file_names(&mut parameters);
    let document = json!({
        "schema": "kesf.fabric/1",
        "version": env!("CARGO_PKG_VERSION"),
        "name": sheet.name,
        "origin": sheet.info.origin.name(),
        "source": sheet.info.source,
        "climate": sheet.info.climate,
        "weave": sheet.info.weave,
        "composition": sheet.info.composition,
        "notes": sheet.info.notes,
        "date": stamp,
        "about": provenance(material, &[]),
        "conventions": {
            "units": "SI; every quantity names its unit",
            "axes": "x is the warp, y the weft; forces and moments are per width of the specimen",
            "curves": "as recorded, in recorded order, before any correction; `correction` is what the evaluation added \
                       to x and y",
        },
        "curves": sheet.specimens.iter().map(curve).collect::<Vec<_>>(),
        "sheet": parameters,
        "section": section,
    });
    Ok(text(&document).map_err(wrong)?.into())
}

/// What a specimen was recorded to do.
fn curve(specimen: &SpecimenResult) -> Value {
    let m = &specimen.measurement;
    let [x, y] = m.test.axes();
    let file = m.source.path.file_name().map(|name| name.to_string_lossy().into_owned());
    json!({
        "test": m.test,
        "direction": m.direction,
        "specimen": m.specimen,
        "file": file,
        "sha256": m.source.sha256,
        "conditions": m.conditions,
        "correction": specimen.correction,
        "x": {"unit": x, "values": m.curve.x},
        "y": {"unit": y, "values": m.curve.y},
    })
}

/// Names of files in the place of their paths: the same fabric is the same material wherever its files lie.
pub fn file_names(sheet: &mut Value) {
    let last = |path: &mut Value| {
        if let Value::String(text) = path {
            *text = text.rsplit('/').next().unwrap_or_default().to_string();
        }
    };
    for list in ["inputs", "findings"] {
        for entry in sheet[list].as_array_mut().into_iter().flatten() {
            entry.get_mut("path").into_iter().for_each(last);
        }
    }
}
