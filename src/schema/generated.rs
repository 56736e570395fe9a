//! JSON Schemas from the types that read and write files, for the tests that hold the committed ones.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, transform_subschemas};
use serde_json::{Value, json};

use super::open_fabric;
use crate::case::CaseTable;
use crate::characterise::Settings;
use crate::characterise::drape::DrapeDocument;
use crate::instrument::{Dialect, FabricFile};
use crate::quantity::Unit;

/// A JSON Schema (draft 7) as the types that read or write its files say: what [`SchemaFile`](super::SchemaFile) is held against.
#[derive(Clone, Debug, PartialEq)]
pub struct GeneratedSchema {
    /// Name without an ending, such as `case`.
    pub name: &'static str,
    /// The schema.
    pub schema: Value,
}

impl GeneratedSchema {
    pub fn of<T: JsonSchema>(name: &'static str, title: &'static str) -> Self {
        let settings = SchemaSettings::draft07()
            .with_transform(RecursiveTransform(on_one_line))
            .with_transform(without_null)
            .with_transform(RecursiveTransform(with_units));
        let mut schema = settings.into_generator().into_root_schema_for::<T>().to_value();
        schema["title"] = json!(title);
        Self { name, schema }
    }

    /// The schema of what is serialised, and of what is read of it.
    #[cfg(feature = "results")]
    pub fn of_document<T: JsonSchema>(name: &'static str, title: &'static str) -> Self {
        let settings =
            SchemaSettings::draft07().for_serialize().with_transform(RecursiveTransform(on_one_line));
        let mut schema = settings.into_generator().into_root_schema_for::<T>().to_value();
        schema["title"] = json!(title);
        Self { name, schema }
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        format!("{:#}\n", self.schema)
    }
}

/// Schemas of all files that the program reads and describes to others, from their types, in name order.
pub fn generated() -> Vec<GeneratedSchema> {
    vec![
        GeneratedSchema::of::<CaseTable>("case", "Case file of kesf"),
        GeneratedSchema::of::<Dialect>("dialect", "Dialect file of kesf"),
        GeneratedSchema::of::<DrapeDocument>(
            "drape-image",
            "kesf.drape-image/1, the document of kesf drape-image",
        ),
        GeneratedSchema::of::<FabricFile>("fabric", "fabric.toml of kesf"),
        GeneratedSchema { name: "open-fabric", schema: open_fabric::schema() },
        GeneratedSchema::of::<Settings>("settings", "Settings of the evaluation of kesf"),
    ]
}

/// Descriptions are comments of the source, broken where its lines end.
fn on_one_line(schema: &mut schemars::Schema) {
    if let Some(Value::String(text)) = schema.get_mut("description") {
        let paragraphs = text.split("\n\n").map(|p| p.split_whitespace().collect::<Vec<_>>().join(" "));
        *text = paragraphs.collect::<Vec<_>>().join("\n\n");
    }
}

/// TOML has no null: a key is left out instead.
fn without_null(schema: &mut schemars::Schema) {
    transform_subschemas(&mut without_null, schema);
    let is_null = |v: &Value| v == "null" || v["type"] == "null" || v.is_null();
    for key in ["type", "anyOf", "oneOf", "enum"] {
        let Some(Value::Array(options)) = schema.get_mut(key) else { continue };
        options.retain(|option| !is_null(option));
        let single = (options.len() == 1 && key != "enum").then(|| options[0].clone());
        match single {
            Some(only @ Value::String(_)) => drop(schema.insert(key.to_string(), only)),
            Some(Value::Object(only)) => {
                schema.remove(key);
                let Some(object) = schema.as_object_mut() else { continue };
                // In draft 7 nothing may stand beside a reference.
                if only.contains_key("$ref") && !object.is_empty() {
                    object.insert("allOf".into(), json!([only]));
                } else {
                    for (key, value) in only {
                        object.entry(key).or_insert(value);
                    }
                }
            }
            _ => {}
        }
    }
    if schema.get("default").is_some_and(Value::is_null) {
        schema.remove("default");
    }
}

/// Defaults of quantities are numbers in SI in the types, and texts with a unit in a file.
fn with_units(schema: &mut schemars::Schema) {
    let value = schema.clone().to_value();
    let items = value.pointer("/items/items").or_else(|| value.pointer("/items")).unwrap_or(&value);
    if items.get("x-unit").is_none() || items["type"] != "string" {
        return;
    }
    if let (Some(example), Some(default)) = (first_example(items), schema.get_mut("default")) {
        in_unit_of(default, &example);
    }
}

/// The first example of a schema, where that is a text.
fn first_example(schema: &Value) -> Option<String> {
    Some(schema.pointer("/examples/0")?.as_str()?.to_string())
}

/// Writes a number, or each of a list, in the unit of an example.
fn in_unit_of(value: &mut Value, example: &str) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| in_unit_of(item, example)),
        Value::Number(number) => {
            let symbol = example.split_once(' ').map_or("", |(_, unit)| unit);
            let Some((si, unit)) = number.as_f64().zip(Unit::parse(symbol).ok()) else { return };
            // Nine digits are past every default: this removes the last-bit noise of a conversion.
            let shown: f64 = format!("{:.8e}", si / unit.factor).parse().unwrap_or(si);
            *value = json!(format!("{shown} {symbol}"));
        }
        _ => {}
    }
}
