//! Every JSON document that the command writes or prints is as its schema says, and has no key that its schema does not know.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use jsonschema::Validator;
use kesf::report::json::{SectionDocument, SheetDocument, text};
use serde_json::{Value, json};

/// The schema of a document by its name, closed: a key that is not in it is an error.
fn validator(name: &str) -> Validator {
    let file = kesf::documents::schemas().into_iter().find(|file| file.name == name);
    let mut schema = file.unwrap_or_else(|| panic!("no schema {name}")).schema;
    close(&mut schema);
    jsonschema::draft7::new(&schema).unwrap()
}

/// Forbids other keys in objects whose keys are known; not where the keys of several schemas meet in one object.
fn close(schema: &mut Value) {
    let meets = ["allOf", "anyOf", "oneOf", "$ref"].iter().any(|word| schema.get(word).is_some());
    match schema {
        Value::Object(object) => {
            if object.contains_key("properties") && !object.contains_key("additionalProperties") && !meets {
                object.insert("additionalProperties".into(), json!(false));
            }
            let is_meeting = |key: &str| meets && ["allOf", "anyOf", "oneOf"].contains(&key);
            let has_own = object.contains_key("properties");
            for (key, below) in object.iter_mut() {
                if !(is_meeting(key) && has_own) {
                    close(below);
                }
            }
        }
        Value::Array(items) => items.iter_mut().for_each(close),
        _ => {}
    }
}

/// What was seen, and what was wrong with it.
#[derive(Default)]
struct Seen {
    schemas: BTreeSet<String>,
    wrong: Vec<String>,
}

impl Seen {
    fn check(&mut self, what: &str, document: &Value) {
        let schema = document["schema"].as_str().unwrap_or_else(|| panic!("{what}: no schema: {document}"));
        let name = schema.strip_prefix("kesf.").and_then(|s| s.strip_suffix("/1")).unwrap();
        let errors: Vec<String> = validator(name)
            .iter_errors(document)
            .map(|e| {
                format!("{}: {}", e.instance_path(), e.to_string().chars().take(300).collect::<String>())
            })
            .collect();
        if !errors.is_empty() {
            self.wrong.push(format!("{what} is not {schema}:\n{}", errors.join("\n")));
        }
        self.schemas.insert(name.to_string());
    }

    /// What a command prints.
    fn print(&mut self, arguments: &[&str]) -> Value {
        let output = Command::new(env!("CARGO_BIN_EXE_kesf"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .arg("--json")
            .args(arguments)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        let document: Value =
            serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{arguments:?}: {e}\n{stderr}"));
        self.check(&arguments.join(" "), &document);
        for line in stderr.lines() {
            let line: Value = serde_json::from_str(line).unwrap_or_else(|e| panic!("{line}: {e}"));
            assert!(validator("error").is_valid(&line), "{line}");
            self.schemas.insert("error".into());
        }
        document
    }

    /// The JSON files of a folder.
    fn files(&mut self, folder: &Path) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                self.files(&path);
            } else if path.extension().is_some_and(|ending| ending == "json") {
                let document: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
                // By them a run goes on: they are for the program alone.
                if document["schema"] != "kesf.record/1" {
                    self.check(&path.display().to_string(), &document);
                    assert_read_back(&path, &document);
                }
            }
        }
    }
}

/// A sheet or a section is read to what was written, curves of bands and friction laws included.
fn assert_read_back(path: &Path, document: &Value) {
    let bytes = fs::read(path).unwrap();
    let again = match document["schema"].as_str().unwrap() {
        "kesf.sheet/1" => text(&serde_json::from_slice::<SheetDocument>(&bytes).unwrap()),
        "kesf.section/1" => text(&serde_json::from_slice::<SectionDocument>(&bytes).unwrap()),
        _ => return,
    };
    assert_eq!(again.unwrap(), String::from_utf8(bytes).unwrap(), "{}", path.display());
}

/// A strip in every analysis that gives other keys.
const CASES: &[(&str, &str)] = &[
    ("modal", "[analysis]\nkind = \"modal\"\nmodes = 2\n"),
    ("motion", "[analysis]\nkind = \"newmark\"\ntime_step = \"1 ms\"\nend_time = \"10 ms\"\n"),
    ("large", "[analysis]\nkind = \"nonlinear\"\n"),
    (
        "steps",
        "[[steps]]\nname = \"half\"\n[[steps.loads]]\nkind = \"gravity\"\nvalue = \"4.9 m/s²\"\n\
         [[steps]]\nname = \"all\"\n[[steps.loads]]\nkind = \"gravity\"\nvalue = \"9.8 m/s²\"\n",
    ),
    ("meshes", "[convergence]\nmeshes = 3\n"),
    ("sampled", "[uncertainty]\npoints = 8\n"),
];

fn case(name: &str, analysis: &str) -> String {
    let load = "[[loads]]\nkind = \"gravity\"\nvalue = \"9.8 m/s²\"\n";
    let load = if ["steps", "modal"].contains(&name) { "" } else { load };
    format!(
        "title = \"{name}\"\nfabric = \"*\"\n[sheet]\nshape = \"strip\"\nwidth = \"20 mm\"\nheight = \"10 mm\"\n\
         cells = [8, 4]\n[[supports]]\nset = \"left\"\nkind = \"clamped\"\n\
         [[probes]]\nname = \"tip\"\nat = [\"20 mm\", \"5 mm\"]\n\
         [[checks]]\nquantity = \"w_max\"\nexpected = \"1 mm\"\nrelative_tolerance = 0.5\n\
         reference = {{ kind = \"own\", source = \"of this test\" }}\n{load}{analysis}"
    )
}

const DRAPE: &str = "title = \"coarse drape\"\nfabric = \"*\"\n[sheet]\nshape = \"annulus\"\ninner_diameter = \"18 cm\"\n\
    diameter = \"24 cm\"\ncells = [4, 24]\n[[supports]]\nset = \"inner\"\nkind = \"clamped\"\n\
    [[loads]]\nkind = \"gravity\"\n[analysis]\nkind = \"drape\"\nnodes = [4]\nrefinements = 0\n";

#[test]
fn every_document_is_as_its_schema_says() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let mut seen = Seen::default();
    seen.print(&["run", "kesf_data", "cases", "--no-charts", "-o", &at("results")]);
    seen.files(&folder.path().join("results"));
    for topic in ["formats", "dialects", "analyses", "exports", "units", "codes", "schemas"] {
        seen.print(&["list", topic]);
    }
    seen.print(&["explain", "all"]);
    seen.print(&["read", "kesf_data/poplin"]);
    seen.print(&["characterise", "kesf_data", "no_such_folder"]);
    seen.print(&["section", "kesf_data"]);
    seen.print(&["check", "kesf_data", "cases"]);
    seen.print(&["verify", "--filter", "patch"]);
    seen.print(&["export", "kesf_data/poplin", "--to", "u3m", "-o", "-"]);
    seen.print(&["export", "kesf_data/poplin", "--to", "usd", "-o", &at("poplin.usda")]);
    // A sheet is an input again.
    let sheet = at("results/poplin/sheet.json");
    let [from, back] = ["kesf_data/poplin", &sheet].map(|fabric| seen.print(&["section", fabric]));
    assert_eq!(from["sections"], back["sections"]);
    seen.print(&["report", &at("results")]);
    fs::create_dir(at("fresh")).unwrap();
    fs::copy("kesf_data/poplin/poplin_warp_FB2_1.csv", at("fresh/a_warp_FB2_1.csv")).unwrap();
    seen.print(&["init", &at("fresh")]);
    seen.print(&[
        "run",
        "kesf_data/petrak_m1",
        "kesf_data/petrak_m2",
        "cases/cantilever.toml",
        "--shard",
        "1/1",
        "-o",
        &at("parts"),
    ]);
    for table in ["results", "findings", "failures"] {
        seen.print(&["merge", &at("parts"), "--table", table, "-o", "-"]);
    }
    seen.print(&["library", "build", &at("fabrics.parquet"), &at("results")]);
    seen.print(&["library", "find", &at("fabrics.parquet"), "--like", "poplin"]);
    for (name, analysis) in CASES {
        let path = at(&format!("{name}.toml"));
        fs::write(&path, case(name, analysis)).unwrap();
        seen.print(&["solve", &path, "kesf_data/poplin"]);
    }
    fs::write(at("drape.toml"), DRAPE).unwrap();
    seen.print(&["solve", &at("drape.toml"), "kesf_data/petrak_m1"]);
    assert!(seen.wrong.is_empty(), "{}", seen.wrong.join("\n"));
    let seen_or_read: BTreeSet<String> =
        ["case", "dialect", "drape-image", "fabric", "open-fabric", "settings"].map(String::from).into();
    let all: BTreeSet<String> = kesf::documents::schemas().iter().map(|file| file.name.to_string()).collect();
    assert_eq!(all, &seen.schemas | &seen_or_read, "each schema has seen a document");
}

/// A schema that is of something else says so.
#[test]
fn a_key_that_no_schema_knows_is_an_error() {
    let known = json!({"schema": "kesf.library/1", "output": "a.parquet", "fabrics": 3, "failures": []});
    assert!(validator("library").is_valid(&known));
    for wrong in [
        json!({"schema": "kesf.library/1", "output": "a.parquet", "fabrics": 3, "shelf": 1}),
        json!({"schema": "kesf.library/1", "output": "a.parquet"}),
        json!({"schema": "kesf.found/1", "output": "a.parquet", "fabrics": 3}),
        json!({"schema": "kesf.library/1", "output": "a.parquet", "fabrics": "3"}),
    ] {
        assert!(!validator("library").is_valid(&wrong), "{wrong}");
    }
}
