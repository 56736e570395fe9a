//! U3M 1.1, the material exchange format of Vizoo and Browzwear: JSON after `u3m_schema.json` of its repository.
//!
//! The format has a place for thickness, weight, composition, kind and construction of a material. Stiffness it knows
//! as a file of one device only (FAB), so that of KES stands under `custom`, which programs pass over.
//!
//! That file (`u3m1.1/physics/physics_schema.json`) has `raw_data` or null. What is there must be all of B, L and W, each with the
//! five tests of the device (D1, D2, S1, S2, U1: clamps 2 and 8 cm apart) and its serial number, and T and M: a record of KES-FB
//! would be passed off as one of another instrument. Curves as recorded stand under `custom.kesf.tests`, in the form that is
//! proposed for all instruments (`docs/src/exchange.md`).

use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};
use uuid::Builder;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Property, no_place};
use super::fabric::file_names;
use crate::characterise::SpecimenResult;
use crate::kes::AxisSpec;
use crate::report::json::{section_document, sheet_document, text};
use crate::section::ShellSection;

/// `kesf export --to u3m`.
pub static EXPORTER: Exporter = Exporter {
    name: "u3m",
    ending: "u3m",
    title: "U3M 1.1 material: thickness, weight, composition; curves and everything else under custom.kesf",
    holds: "thickness, mass per area and composition; stiffness stands under `custom`, which other programs pass over.",
    write: document,
};

/// Fibres that the format has a word for, beside ours for them.
const FIBRES: &[(&str, &str)] = &[
    ("acetate", "Acetate"),
    ("acrylic", "Acrylic"),
    ("alpaca", "Alpaca"),
    ("angora", "Angora"),
    ("aramid", "Aramid"),
    ("cashmere", "Cashmere"),
    ("cotton", "Cotton"),
    ("cupro", "Cupro"),
    ("elastane", "Elastane"),
    ("hemp", "Hemp"),
    ("jute", "Jute"),
    ("linen", "Linen"),
    ("lycra", "Lycra"),
    ("lyocell", "Lyocell"),
    ("modacrylic", "Modacrylic"),
    ("modal", "Modal"),
    ("mohair", "Mohair"),
    ("nylon", "Nylon"),
    ("polyamide", "Polyamid"),
    ("polyester", "Polyester"),
    ("polyethylene", "Polyethylene"),
    ("polypropylene", "Polypropylen"),
    ("ramie", "Ramie"),
    ("rayon", "Rayon"),
    ("silk", "Silk"),
    ("spandex", "Spandex"),
    ("triacetate", "Triacetate"),
    ("viscose", "Rayon"),
    ("wool", "Wool"),
];

/// Weaves and knits that the format has a word for, beside ours for them.
const CONSTRUCTIONS: &[(&str, &str, &str)] = &[
    ("canvas", "Woven", "Canvas"),
    ("jacquard", "Woven", "Jacquard"),
    ("oxford", "Woven", "Oxford"),
    ("plain", "Woven", "Plain weave"),
    ("poplin", "Woven", "Poplin"),
    ("ripstop", "Woven", "Ripstop"),
    ("satin", "Woven", "Satin"),
    ("twill", "Woven", "Twill"),
    ("interlock", "Knit", "Interlock"),
    ("jersey", "Knit", "Single jersey"),
    ("pique", "Knit", "Pique"),
    ("raschel", "Knit", "Raschel"),
    ("tricot", "Knit", "Tricot"),
];

/// A date for the fields that must have one, where none was asked for: the same fabric gives the same bytes.
const NO_DATE: &str = "1970-01-01T00:00:00Z";

/// The document.
fn document(material: &CardInput<'_>, checked: &ShellSection) -> Result<Card, CardError> {
    let wrong = |e: serde_json::Error| CardError::Json { program: "U3M", reason: e.to_string() };
    let CardInput { sheet, made, stamp, .. } = *material;
    let section = section_document([(sheet, made)]);
    let parameters = serde_json::to_value(sheet_document([sheet], None)).map_err(wrong)?;
    let mut ours = Map::new();
    ours.insert("sheet".into(), without_loops(parameters));
    ours.insert("section".into(), serde_json::to_value(section).map_err(wrong)?);
    let [kind, construction] = made_as(sheet.info.weave.as_deref().unwrap_or_default());
    // A stand-in is no property of the material.
    let known = |name: &str, value: f64| if material.is_assumed(name) { Value::Null } else { value.into() };
    let name = if sheet.info.title.is_empty() { &sheet.name } else { &sheet.info.title };
    let date = stamp.unwrap_or(NO_DATE);
    let origin = sheet.info.origin.name();
    let id = identifier(&text(&ours).map_err(wrong)?);
    ours.insert(
        "tests".into(),
        sheet.specimens.iter().map(|s| tested(s, sheet.info.climate.as_deref())).collect(),
    );
    let document = json!({
        "schema": "1.1",
        "material": {
            "name": name,
            "id": id,
            "created": date,
            "modified": date,
            "description": format!(
                "{origin} KES data; curves, stiffness, friction and the assumptions behind them under custom.kesf (SI units)"
            ),
            "front": null,
            "back": null,
            "side": null,
            "physics": {
                "thickness": known("thickness", 1e3 * made.section.thickness),
                "weight": known("areal density", 1e3 * made.section.areal_density),
                "devices": {"fab": "null"},
                "composition": sheet.info.composition.as_deref().and_then(composition),
                "material_type": kind,
                "construction": construction,
            },
            "metadata": null,
        },
        "custom": {"kesf": ours},
    });
    let outside = [Property::Tensile, Property::Bending, Property::Shear, Property::Torsion];
    let findings = outside.map(|what| no_place("U3M outside of `custom`", checked, what)).into();
    Ok(Card { text: text(&document).map_err(wrong)?, findings })
}

/// What a specimen was recorded to do, in the form that `docs/src/exchange.md` proposes.
fn tested(specimen: &SpecimenResult, climate: Option<&str>) -> Value {
    let m = &specimen.measurement;
    let spec = m.test.spec();
    let axis = |of: &AxisSpec, values: &[f64]| json!({"name": of.name, "unit": of.si, "values": values});
    json!({
        "standard": m.test.instrument(),
        "quantity": m.test,
        "direction": m.direction,
        "specimen": {"width": m.conditions.width, "length": m.conditions.gauge, "unit": "m", "number": m.specimen},
        "climate": climate,
        "x": axis(&spec.x, &m.curve.x),
        "y": axis(&spec.y, &m.curve.y),
    })
}

/// A sheet without the samples of its friction laws, which are in `sheet.json` with the digest of all, and without the paths of
/// its files: the same fabric is the same material wherever its files lie.
fn without_loops(mut sheet: Value) -> Value {
    for fabric in sheet["fabrics"].as_array_mut().into_iter().flatten().filter_map(Value::as_object_mut) {
        for key in ["friction", "friction_bands", "re_extracted", "digest"] {
            fabric.shift_remove(key);
        }
    }
    file_names(&mut sheet);
    if let Some(document) = sheet.as_object_mut() {
        document.shift_remove("findings");
    }
    sheet
}

/// A version 4 identifier that the content decides.
fn identifier(content: &str) -> String {
    let digest = Sha256::digest(content.as_bytes());
    let mut bytes = [0; 16];
    bytes.copy_from_slice(&digest[..16]);
    Builder::from_random_bytes(bytes).into_uuid().to_string()
}

/// `65 % cotton, 35 % polyester` as parts; `None` if a part is not understood or they are not all of it.
fn composition(text: &str) -> Option<Value> {
    let part = |part: &str| {
        let part = part.trim();
        let (share, fibre) = match part.split_once('%') {
            Some((share, fibre)) => (share.trim().parse::<f64>().ok()? / 100.0, fibre),
            None => (1.0, part),
        };
        let fibre = fibre.split('(').next()?.trim().to_lowercase();
        let known = FIBRES.iter().find(|(ours, _)| *ours == fibre);
        let (kind, name) = known.map_or(("other", Some(fibre.as_str())), |(_, theirs)| (*theirs, None));
        let real = share > 0.0 && !fibre.is_empty();
        real.then(|| (share, json!({"ratio": share, "type": kind, "name": name})))
    };
    let parts: Vec<(f64, Value)> = text.split([',', ';', '/']).map(part).collect::<Option<_>>()?;
    let whole: f64 = parts.iter().map(|p| p.0).sum();
    let parts: Vec<Value> = parts.into_iter().map(|p| p.1).collect();
    ((whole - 1.0).abs() < 1e-3).then(|| json!({"parts": parts}))
}

/// Kind and construction of a fabric by the first word of its weave that the format knows.
fn made_as(weave: &str) -> [Value; 2] {
    let entry = |word: &str| json!({"type": word, "name": null});
    let weave = weave.trim();
    let known = |word: &str| CONSTRUCTIONS.iter().find(|(ours, ..)| ours.eq_ignore_ascii_case(word));
    match weave.split([' ', ',', '-', '_']).find_map(known) {
        Some((_, kind, construction)) => [entry(kind), entry(construction)],
        None if weave.is_empty() => [Value::Null, Value::Null],
        None => [Value::Null, json!({"type": "other", "name": weave})],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_said_that_is_not_known() {
        for none in ["", "-20% cotton, 120% wool", "60 % cotton", "cotton, wool", "cotton/?"] {
            assert_eq!(composition(none), None, "{none}");
        }
        let parts = composition("60 % cotton, 40 % milk fibre").unwrap();
        assert_eq!(parts["parts"][1], json!({"ratio": 0.4, "type": "other", "name": "milk fibre"}));
        let kinds = |weave: &str| made_as(weave).map(|v| v["type"].as_str().map(str::to_string));
        let some = |a: &str, b: &str| [Some(a.to_string()), Some(b.to_string())];
        assert_eq!(kinds("3/1 twill"), some("Woven", "Twill"));
        assert_eq!(kinds("single jersey"), some("Knit", "Single jersey"));
        assert_eq!(kinds("nonwoven"), [None, Some("other".to_string())]);
        assert_eq!(kinds(" "), [None, None]);
    }
}
