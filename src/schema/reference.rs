//! The reference of all keys of a case file, as Markdown.

use std::fmt::Write;

use serde_json::Value;

use super::generated::GeneratedSchema;
use crate::case::CaseTable;

const HEAD: &str = "\
# Case reference

<!-- Generated from the types that read case files: do not edit. -->

A case file is TOML. Every number that has a unit is written with it, as text: `\"20 cm\"`, `\"0.5 Pa\"`; the units of the
tables below are examples of what fits, and `kesf list units` shows all of them. A key that is not listed here is refused
with its place, and so is one that has no meaning beside the others. `kesf check CASE` tells without computing anything.

A case has a `fabric` or a `[section]`, and one of `[sheet]`, `[virtual_test]` and `[bending_test]`; a `[sheet]` with
`[analysis] kind = \"drape\"` is a drape.

Editors that know JSON Schema complete keys and show their meaning after a first line
`#:schema PATH/case.json` (`kesf list schemas -o FOLDER` writes it).
";

/// The reference of all keys of a case file, as Markdown: for each table its keys with type, unit, default, meaning and
/// example.
pub fn case_reference() -> String {
    let file = GeneratedSchema::of::<CaseTable>("case", "Case file of kesf");
    let reader = Reader { root: &file.schema };
    let mut text = HEAD.to_string();
    reader.heading(&mut text, "Keys at the top of the file", &file.schema);
    reader.keys(&mut text, &file.schema, |_, of| !reader.is_tables(of));
    for (key, schema) in properties(&file.schema) {
        reader.section(&mut text, key, schema);
    }
    text
}

/// Reads a schema with its definitions.
struct Reader<'a> {
    root: &'a Value,
}

fn properties(schema: &Value) -> impl Iterator<Item = (&String, &Value)> {
    schema["properties"].as_object().into_iter().flatten()
}

impl<'a> Reader<'a> {
    /// What a reference stands for.
    fn resolved(&self, schema: &'a Value) -> &'a Value {
        let only = schema["allOf"].as_array().filter(|all| all.len() == 1).map(|all| &all[0]);
        let reference = schema["$ref"].as_str().and_then(|r| self.root.pointer(r.strip_prefix('#')?));
        match (reference, only) {
            (Some(target), _) => self.resolved(target),
            (None, Some(only)) => self.resolved(only),
            (None, None) => schema,
        }
    }

    /// A word of the schema of a key, or else of what it refers to.
    fn word(&self, schema: &'a Value, word: &str) -> Option<&'a Value> {
        schema.get(word).or_else(|| self.resolved(schema).get(word))
    }

    /// The tables of a key at the top: one, or those of each kind.
    fn section(&self, text: &mut String, key: &str, schema: &'a Value) {
        let own = self.resolved(schema);
        let (own, heading) = match self.resolved(&own["items"]) {
            items if own["type"] == "array" && is_table(items) => (items, format!("`[[{key}]]`")),
            _ if is_table(own) => (own, format!("`[{key}]`")),
            _ => return,
        };
        self.heading(text, &heading, own);
        let Some(kinds) = own["oneOf"].as_array() else {
            return self.keys_and_below(text, &heading, own, &[]);
        };
        for kind in kinds {
            let name = kind["properties"]["kind"]["const"].as_str().unwrap_or_default();
            let heading = format!("{heading} with `kind = \"{name}\"`");
            self.heading(text, &heading, kind);
            self.keys_and_below(text, &heading, kind, &["kind"]);
        }
    }

    fn heading(&self, text: &mut String, heading: &str, schema: &Value) {
        let about = schema["description"].as_str().unwrap_or_default();
        // Writing into a string cannot fail.
        let _ = writeln!(text, "\n## {heading}\n\n{about}");
    }

    /// The keys of a table but those that are known, and the tables in it.
    fn keys_and_below(&self, text: &mut String, heading: &str, schema: &'a Value, known: &[&str]) {
        self.keys(text, schema, |key, _| !known.contains(&key));
        for (key, of) in properties(schema) {
            let below = self.resolved(of);
            if is_table(below) {
                let heading = format!("`{key}` in {heading}");
                self.heading(text, &heading, below);
                if below["oneOf"].is_array() {
                    let _ = writeln!(text, "\nThe keys are those of `[{key}]` with the same `kind`.");
                } else {
                    self.keys_and_below(text, &heading, below, &[]);
                }
            }
        }
    }

    /// A table of keys, and what their choices mean.
    fn keys(&self, text: &mut String, schema: &'a Value, is_shown: impl Fn(&str, &'a Value) -> bool) {
        let rows: Vec<_> = properties(schema).filter(|(key, of)| is_shown(key, of)).collect();
        if rows.is_empty() {
            text.push_str("\nNo other keys.\n");
            return;
        }
        text.push_str("\n| key | type | unit | default | meaning | example |\n|---|---|---|---|---|---|\n");
        for (key, of) in &rows {
            let required = schema["required"].as_array().is_some_and(|r| r.iter().any(|r| r == key.as_str()));
            let cells = [
                format!("`{key}`"),
                self.kind(of),
                self.unit(of),
                if required { "required".into() } else { self.default(of) },
                self.meaning(of),
                format!("`{key} = {}`", self.example(of)),
            ];
            let _ = writeln!(text, "| {} |", cells.map(|cell| cell.replace('|', "\\|")).join(" | "));
        }
        for (key, of) in rows {
            self.choices(text, key, of);
        }
    }

    /// Whether a key holds a table that has a section of its own.
    fn is_tables(&self, schema: &'a Value) -> bool {
        let own = self.resolved(schema);
        is_table(own) || is_table(self.resolved(&own["items"]))
    }

    fn choices(&self, text: &mut String, key: &str, schema: &'a Value) {
        let choices = self.resolved(schema)["oneOf"].as_array();
        let named = choices
            .into_iter()
            .flatten()
            .filter_map(|c| Some((c["const"].as_str()?, c["description"].as_str().unwrap_or_default())));
        let lines: Vec<String> = named.map(|(name, about)| format!("- `\"{name}\"`: {about}\n")).collect();
        if !lines.is_empty() {
            let _ = write!(text, "\nChoices of `{key}`:\n\n{}", lines.concat());
        }
    }

    fn kind(&self, schema: &'a Value) -> String {
        let own = self.resolved(schema);
        if is_table(own) {
            return "table".into();
        }
        if own.get("x-unit").is_some() && own["type"] == "string" {
            return "quantity".into();
        }
        if let Some(only) = own.get("const") {
            return format!("`{}`", literal(only));
        }
        if let Some(options) = own["oneOf"].as_array() {
            let names: Vec<String> =
                options.iter().filter_map(|o| o["const"].as_str()).map(|c| format!("`\"{c}\"`")).collect();
            return names.join(", ");
        }
        if let Some(options) = own["anyOf"].as_array() {
            return options.iter().map(|option| self.kind(option)).collect::<Vec<_>>().join(", or ");
        }
        match &own["type"] {
            Value::String(name) => self.named_kind(name, own),
            Value::Array(names) => {
                let names = names.iter().filter_map(Value::as_str);
                names.map(|name| self.named_kind(name, own)).collect::<Vec<_>>().join(", or ")
            }
            _ => String::new(),
        }
    }

    fn named_kind(&self, name: &str, own: &'a Value) -> String {
        match name {
            "string" => "text".into(),
            "integer" => "whole number".into(),
            "number" => "number".into(),
            "boolean" => "`true` or `false`".into(),
            "array" => {
                let items = self.kind(&own["items"]);
                match (own["minItems"].as_u64(), own["maxItems"].as_u64()) {
                    (Some(low), Some(high)) if low == high => format!("{low} of: {items}"),
                    (Some(low), Some(high)) => format!("{low} to {high} of: {items}"),
                    _ => format!("list of: {items}"),
                }
            }
            other => other.into(),
        }
    }

    fn unit(&self, schema: &'a Value) -> String {
        let own = self.resolved(schema);
        let unit = self.word(schema, "x-unit").or_else(|| self.word(&own["items"], "x-unit"));
        let of_options = || own["anyOf"].as_array()?.iter().find_map(|option| self.word(option, "x-unit"));
        unit.or_else(of_options).and_then(Value::as_str).unwrap_or("–").to_string()
    }

    fn default(&self, schema: &'a Value) -> String {
        schema.get("default").map_or("–".into(), |value| format!("`{}`", literal(value)))
    }

    fn meaning(&self, schema: &'a Value) -> String {
        let text = self.word(schema, "description").and_then(Value::as_str).unwrap_or_default();
        text.replace("\n\n", " ")
    }

    /// An example of a value, as it is written.
    fn example(&self, schema: &'a Value) -> String {
        if let Some(example) = self.word(schema, "examples").and_then(|e| e.get(0)) {
            return literal(example);
        }
        let own = self.resolved(schema);
        if let Some(only) = own.get("const").or_else(|| own["oneOf"].get(0)?.get("const")) {
            return literal(only);
        }
        match (own["type"].as_str(), schema.get("default"), own["anyOf"].get(0)) {
            (Some("boolean"), default, _) => (default != Some(&Value::Bool(true))).to_string(),
            (_, Some(default), _) => literal(default),
            (_, None, Some(first)) => self.example(first),
            (Some("array"), None, None) => {
                let count = own["minItems"].as_u64().unwrap_or(1).max(1) as usize;
                format!("[{}]", vec![self.example(&own["items"]); count].join(", "))
            }
            _ => String::new(),
        }
    }
}

fn is_table(schema: &Value) -> bool {
    let of_tables = |kinds: &Vec<Value>| kinds.iter().all(|kind| kind["type"] == "object");
    schema["type"] == "object" || schema["oneOf"].as_array().is_some_and(of_tables)
}

/// A value as TOML writes it.
fn literal(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("[{}]", items.iter().map(literal).collect::<Vec<_>>().join(", ")),
        Value::Object(table) => {
            let entries = table.iter().map(|(key, value)| format!("{key} = {}", literal(value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}
