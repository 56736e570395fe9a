use std::path::Path;

use super::*;

fn committed(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// `kesf list schemas -o docs/schemas` and `kesf list keys -o docs/src` write them anew.
#[test]
fn the_committed_schemas_and_the_reference_are_those_of_the_types() {
    for file in schemas() {
        let name = format!("schemas/{}.json", file.name);
        assert_eq!(committed(&name), file.text(), "docs/{name} is stale: kesf list schemas -o docs/schemas");
    }
    let reference = committed("src/case-reference.md");
    assert_eq!(reference, case_reference(), "stale: kesf list keys > docs/src/case-reference.md");
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
    let case = schemas().into_iter().find(|file| file.name == "case").unwrap().schema;
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

/// Defaults are as a file states them; `tests/documents.rs` holds the files of this repository against the schemas.
#[test]
fn defaults_are_written_as_a_file_writes_them() {
    let files = schemas();
    let schema = |name: &str| &files.iter().find(|file| file.name == name).unwrap().schema;
    let settings = &schema("settings")["properties"];
    assert_eq!(settings["shear_slope"]["default"], json!(["0.5 deg", "2.5 deg"]));
    assert_eq!(settings["reversal"]["default"], json!("5 %"));
    assert_eq!(schema("case")["additionalProperties"], json!(false));
    // The open fabric file is JSON.
    let text = files.iter().filter(|f| f.name != "open-fabric").map(SchemaFile::text).collect::<String>();
    assert!(!text.contains("null"), "TOML has no null");
}
