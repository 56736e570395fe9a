//! The schema of the open fabric file: a contract for others, so that it is stated, not generated.

use serde_json::{Value, json};

use crate::instrument::Test;

/// The schema (draft 7) of `kesf.fabric/1`.
pub fn schema() -> Value {
    let text = json!({"type": ["string", "null"]});
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Open fabric file kesf.fabric/1",
        "description": "A fabric as it was measured: curves as recorded, parameters with their spread, friction laws, \
                        the shell section with its assumptions and bands, and where all of it comes from. SI; x is the \
                        warp, y the weft. Other keys may stand beside these, and readers pass over what they do not know.",
        "type": "object",
        "required": ["schema", "version", "name", "origin", "curves", "sheet", "section"],
        "properties": {
            "schema": {"const": "kesf.fabric/1"},
            "version": {"description": "Version of the program that wrote it.", "type": "string"},
            "name": {"description": "Identifier of the fabric.", "type": "string", "minLength": 1},
            "origin": {"description": "Where the data come from.", "enum": ["measured", "published", "synthetic"]},
            "source": with(&text, "Citation, or how the data were made."),
            "climate": with(&text, "Climate of the tests, such as 20 °C, 65 % RH."),
            "weave": with(&text, "Weave or knit."),
            "composition": with(&text, "Fibres with their shares."),
            "notes": {"description": "Cautions about the data.", "type": "array", "items": {"type": "string"}},
            "date": {"description": "RFC 3339.", "type": ["string", "null"], "format": "date-time"},
            "about": {
                "description": "Units, axes, origin and every assumption, in sentences.",
                "type": "array", "items": {"type": "string"},
            },
            "conventions": {"type": "object", "additionalProperties": {"type": "string"}},
            "curves": {"description": "A recorded specimen each.", "type": "array", "items": curve()},
            "sheet": {
                "description": "Parameters: a document kesf.sheet/1 of this one fabric.",
                "type": "object",
                "required": ["schema", "fabrics"],
                "properties": {"schema": {"const": "kesf.sheet/1"}, "fabrics": one(&sheet())},
            },
            "section": {
                "description": "The shell section: a document kesf.section/1 of this one fabric.",
                "type": "object",
                "required": ["schema", "units", "sections"],
                "properties": {"schema": {"const": "kesf.section/1"}, "sections": one(&section())},
            },
        },
    })
}

fn with(schema: &Value, description: &str) -> Value {
    let mut schema = schema.clone();
    schema["description"] = json!(description);
    schema
}

/// An array of exactly one.
fn one(items: &Value) -> Value {
    json!({"type": "array", "minItems": 1, "maxItems": 1, "items": items})
}

fn curve() -> Value {
    let axis = json!({
        "type": "object",
        "required": ["unit", "values"],
        "properties": {
            "unit": {"enum": ["1", "rad", "1/m", "m", "N/m", "N", "Pa"]},
            "values": {"type": "array", "items": {"type": "number"}},
        },
    });
    json!({
        "type": "object",
        "required": ["test", "direction", "specimen", "sha256", "conditions", "correction", "x", "y"],
        "properties": {
            "test": {"enum": Test::ALL.map(Test::name)},
            "direction": {"enum": ["warp", "weft", "bias", null]},
            "specimen": {"type": "integer", "minimum": 1},
            "file": {"type": ["string", "null"]},
            "sha256": {"description": "Of the file.", "type": "string", "pattern": "^[0-9a-f]{64}$"},
            "conditions": {
                "description": "Width and gauge of the specimen (m), the set maximum and the pretension (SI), of the surface the load on the contactor (N).",
                "type": "object", "additionalProperties": {"type": "number"},
            },
            "correction": {
                "description": "What the evaluation added to x and y.",
                "type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "number"},
            },
            "x": with(&axis, "Strain (1), shear angle (rad), curvature (1/m), approach of the faces or position of a sweep (m)."),
            "y": with(&axis, "Force per width (N/m), moment per width (N), pressure (Pa), coefficient of friction (1) or height (m)."),
        },
    })
}

fn sheet() -> Value {
    json!({
        "type": "object",
        "required": ["name", "origin", "parameters", "moduli"],
        "properties": {
            "parameters": {
                "description": "By symbol: mean, sd, n and unit, or one such object for each direction.",
                "type": "object",
                "additionalProperties": {"type": "object"},
            },
            "moduli": {"description": "Tensile moduli by name and direction (N/m).", "type": "object"},
            "friction": {"description": "Friction laws of specimens and of the fabric.", "type": "array"},
        },
    })
}

fn section() -> Value {
    let square = |n: usize| {
        let row = json!({"type": "array", "minItems": n, "maxItems": n, "items": {"type": "number"}});
        json!({"type": "array", "minItems": n, "maxItems": n, "items": row})
    };
    json!({
        "type": "object",
        "required": ["d_m", "d_b", "d_s", "areal_density", "thickness", "assumptions", "uncertainty"],
        "properties": {
            "d_m": with(&square(3), "Membrane stiffness (N/m) of [ε_x, ε_y, γ_xy]."),
            "d_b": with(&square(3), "Bending stiffness (N·m) of [κ_x, κ_y, κ_xy], with the engineering twist."),
            "d_s": with(&square(2), "Transverse shear stiffness (N/m)."),
            "areal_density": {"description": "kg/m²", "type": "number", "exclusiveMinimum": 0},
            "thickness": {"description": "m", "type": "number", "exclusiveMinimum": 0},
            "assumptions": {
                "description": "How every constant was found.",
                "type": "object",
                "additionalProperties": {
                    "type": "object",
                    "required": ["value", "source"],
                    "properties": {"value": {"type": "string"}, "source": {"type": "string"}},
                },
            },
            "uncertainty": {"description": "Entries of the matrices with their 95 % bands.", "type": "array"},
        },
    })
}
