//! U3M 1.1, the material exchange format of Vizoo and Browzwear: JSON after `u3m_schema.json` of its repository.
//!
//! The format has a place for thickness, weight, composition, kind and construction of a material. Stiffness it knows
//! as a file of one device only (FAB), so that of KES stands under `custom`, which programs pass over.

use serde_json::{Map, Value, json};
use uuid::Builder;

use super::{CardError, Material};
use crate::report::json::{section_document, sheet_document, text};
use crate::report::write::hash;

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

/// Weaves that the format has a word for.
const WEAVES: &[(&str, &str)] = &[
    ("plain", "Plain weave"),
    ("poplin", "Poplin"),
    ("satin", "Satin"),
    ("twill", "Twill"),
    ("canvas", "Canvas"),
];

/// A date for the fields that must have one, where none was asked for: the same fabric gives the same bytes.
const NO_DATE: &str = "1970-01-01T00:00:00Z";

/// The document.
pub fn document(material: &Material<'_>) -> Result<String, CardError> {
    let wrong = |e: serde_json::Error| CardError::Json(e.to_string());
    let Material { sheet, made, stamp } = *material;
    let used: Value = made
        .used
        .iter()
        .map(|u| (u.name.to_string(), json!({"value": u.value, "source": u.source})))
        .collect();
    let section = section_document([(sheet.name.as_str(), &made.section, &made.inputs[..], used)]);
    let sheet_text = text(&sheet_document([sheet], None)).map_err(wrong)?;
    let parameters: Value = serde_json::from_str(&sheet_text).map_err(wrong)?;
    let mut ours = Map::new();
    ours.insert("sheet".into(), without_loops(parameters));
    ours.insert("section".into(), serde_json::to_value(section).map_err(wrong)?);
    let name = if sheet.info.title.is_empty() { &sheet.name } else { &sheet.info.title };
    let date = stamp.unwrap_or(NO_DATE);
    let origin = sheet.info.origin.name();
    let document = json!({
        "schema": "1.1",
        "material": {
            "name": name,
            "id": identifier(&sheet_text),
            "created": date,
            "modified": date,
            "description": format!(
                "{origin} KES data; stiffness, friction and the assumptions behind them under custom.kesf (SI units)"
            ),
            "front": null,
            "back": null,
            "side": null,
            "physics": {
                "thickness": 1e3 * made.section.thickness,
                "weight": 1e3 * made.section.areal_density,
                "devices": {"fab": "null"},
                "composition": sheet.info.composition.as_deref().and_then(composition),
                "material_type": sheet.info.weave.as_ref().map(|_| json!({"type": "Woven", "name": null})),
                "construction": sheet.info.weave.as_deref().map(construction),
            },
            "metadata": null,
        },
        "custom": {"kesf": ours},
    });
    text(&document).map_err(wrong)
}

/// A sheet without the samples of its friction laws, which are in `sheet.json`.
fn without_loops(mut sheet: Value) -> Value {
    for fabric in sheet["fabrics"].as_array_mut().into_iter().flatten().filter_map(Value::as_object_mut) {
        for key in ["friction", "friction_bands", "re_extracted"] {
            fabric.remove(key);
        }
    }
    sheet
}

/// A version 4 identifier that the content decides.
fn identifier(content: &str) -> String {
    let digest = hash(content.as_bytes());
    let mut bytes = [0; 16];
    for (byte, pair) in bytes.iter_mut().zip(digest.as_bytes().chunks(2)) {
        *byte = std::str::from_utf8(pair).ok().and_then(|p| u8::from_str_radix(p, 16).ok()).unwrap_or(0);
    }
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
        Some((share, json!({"ratio": share, "type": kind, "name": name})))
    };
    let parts: Vec<(f64, Value)> = text.split([',', ';', '/']).map(part).collect::<Option<_>>()?;
    let whole: f64 = parts.iter().map(|p| p.0).sum();
    let parts: Vec<Value> = parts.into_iter().map(|p| p.1).collect();
    ((whole - 1.0).abs() < 1e-3).then(|| json!({"parts": parts}))
}

fn construction(weave: &str) -> Value {
    let word = weave.split_whitespace().next().unwrap_or(weave).to_lowercase();
    match WEAVES.iter().find(|(ours, _)| *ours == word) {
        Some((_, theirs)) => json!({"type": theirs, "name": null}),
        None => json!({"type": "other", "name": weave}),
    }
}
