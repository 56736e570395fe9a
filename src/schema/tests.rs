use std::path::Path;

use serde_json::{Value, json};

use super::generated::{GeneratedSchema, generated};
use super::reference::case_reference;

/// `KESF_SCHEMAS_WRITE=1 cargo test --release --lib committed` writes all of them anew.
#[test]
fn the_committed_reference_is_that_of_the_types() {
    as_committed("src/case-reference.md", &case_reference());
}

/// Whether a file below `docs` is as the types say; with `KESF_SCHEMAS_WRITE` it is written.
pub(crate) fn as_committed(path: &str, text: &str) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(path);
    if std::env::var_os("KESF_SCHEMAS_WRITE").is_some() {
        std::fs::write(&file, text).unwrap();
    }
    let committed = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(
        committed == text,
        "docs/{path} is stale: KESF_SCHEMAS_WRITE=1 cargo test --release --lib committed"
    );
}

/// Keys of a schema, with those of the tables below it and of each kind of a table.
fn keys(root: &Value, schema: &Value, found: &mut Vec<String>) {
    if let Some(target) = schema["$ref"].as_str() {
        return keys(root, root.pointer(target.strip_prefix('#').unwrap()).unwrap(), found);
    }
    for (key, below) in schema["properties"].as_object().into_iter().flatten() {
        found.push(key.clone());
        keys(root, below, found);
    }
    for word in ["oneOf", "anyOf", "allOf"] {
        schema[word].as_array().into_iter().flatten().for_each(|below| keys(root, below, found));
    }
    keys_of_items(root, schema, found);
}

fn keys_of_items(root: &Value, schema: &Value, found: &mut Vec<String>) {
    if schema["items"].is_object() {
        keys(root, &schema["items"], found);
    }
}

/// Every key has a row with a type, a meaning and an example, and every example is TOML.
#[test]
fn every_key_of_a_case_file_stands_in_the_reference() {
    let reference = case_reference();
    let case = generated().into_iter().find(|file| file.name == "case").unwrap().schema;
    let mut all = Vec::new();
    keys(&case, &case, &mut all);
    assert!(all.len() > 90, "{}", all.len());
    let tables = ["sheet", "loads", "supports", "probes"];
    assert!(tables.iter().all(|key| all.iter().any(|k| k == key)));
    for key in all {
        let heading = reference.contains(&format!("\n## `[{key}]`"))
            || reference.contains(&format!("\n## `[[{key}]]`"));
        let kind = key == "kind" && reference.contains("with `kind = \"pressure\"`");
        assert!(heading || kind || reference.contains(&format!("\n| `{key}` |")), "{key}");
    }
    for row in reference.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split(" | ").collect();
        assert_eq!(cells.len(), 6, "{row}");
        assert!(cells.iter().all(|cell| !cell.trim_matches([' ', '|']).is_empty()), "{row}");
        let example = cells[5].trim_matches([' ', '|', '`']);
        assert!(toml::from_str::<toml::Table>(example).is_ok(), "{example}");
    }
}

/// What explains a malformed file names every key that it may have.
#[test]
fn the_codes_of_malformed_files_name_all_keys() {
    for (name, code) in [("fabric", "R019"), ("dialect", "R020")] {
        let schema = generated().into_iter().find(|file| file.name == name).unwrap().schema;
        let cause = &crate::finding::explain(code).unwrap().cause;
        let named: Vec<&str> = cause.split(|c: char| !(c.is_ascii_alphabetic() || c == '_')).collect();
        for key in schema["properties"].as_object().unwrap().keys() {
            assert!(named.contains(&key.as_str()), "{code}: {key}");
        }
    }
}

/// Defaults are as a file states them; `tests/command/documents.rs` holds the files of this repository against the schemas.
#[test]
fn defaults_are_written_as_a_file_writes_them() {
    let files = generated();
    let schema = |name: &str| &files.iter().find(|file| file.name == name).unwrap().schema;
    let settings = &schema("settings")["properties"];
    assert_eq!(settings["shear_slope"]["default"], json!(["0.5 deg", "2.5 deg"]));
    assert_eq!(settings["reversal"]["default"], json!("5 %"));
    assert_eq!(schema("case")["additionalProperties"], json!(false));
    // The open fabric file is JSON.
    let text =
        files.iter().filter(|f| f.name != "open-fabric").map(GeneratedSchema::text).collect::<String>();
    assert!(!text.contains("null"), "TOML has no null");
}
