//! Every JSON document that the command writes or prints is as its schema says, has no key that its schema does not know, and is
//! read to what was written. Every TOML file that is shipped is as its schema says.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use jsonschema::Validator;
use kesf::characterise::drape::DrapeDocument;
use kesf::documents::{
    Complete, CurvesDocument, ErrorLine, ExplanationsDocument, ExportDocument, InitDocument, LibraryDocument,
    PartDocument, ReportDocument, ResultsDocument,
};
use kesf::report::json::{SectionDocument, SheetDocument, text};
use kesf::results::list::ListDocument;
use kesf::results::{CheckDocument, ComparisonDocument, SolutionDocument};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::common;
use crate::generator;

/// The schema of a document by its name, closed: a key that is not in it is an error.
fn validator(name: &str) -> Validator {
    let file = kesf::schema::SCHEMAS.iter().find(|file| file.name == name);
    let mut schema = file.unwrap_or_else(|| panic!("no schema {name}")).schema();
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

    /// What a command prints that does all of its work.
    fn print(&mut self, arguments: &[&str]) -> Value {
        self.print_with(0, arguments)
    }

    /// What a command prints that ends with a code.
    fn print_with(&mut self, code: i32, arguments: &[&str]) -> Value {
        let output = Command::new(env!("CARGO_BIN_EXE_kesf"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .arg("--json")
            .args(arguments)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
        let document: Value =
            serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{arguments:?}: {e}\n{stderr}"));
        let what = arguments.join(" ");
        self.check(&what, &document);
        if let Some([_, printed]) = readers(&document) {
            assert_same(&what, printed(&output.stdout), &output.stdout);
        }
        for line in stderr.lines() {
            let value: Value = serde_json::from_str(line).unwrap_or_else(|e| panic!("{line}: {e}"));
            assert!(validator("error").is_valid(&value), "{line}");
            let again: ErrorLine = serde_json::from_str(line).unwrap();
            assert_eq!(serde_json::to_string(&again).unwrap(), line);
            self.schemas.insert("error".into());
        }
        document
    }

    /// The entries of a case that was computed, not only refused.
    fn entries(&mut self, code: i32, arguments: &[&str], key: &str) -> Vec<Value> {
        let document = self.print_with(code, arguments);
        assert_eq!(document["failures"], json!([]), "{arguments:?}");
        let entries = document[key].as_array().unwrap().clone();
        assert!(!entries.is_empty(), "{arguments:?}: no {key}");
        entries
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
                if document["schema"] != "kesf.record/2" {
                    self.check(&path.display().to_string(), &document);
                    if let Some([file, _]) = readers(&document) {
                        let bytes = fs::read(&path).unwrap();
                        assert_same(&path.display().to_string(), file(&bytes), &bytes);
                    }
                }
            }
        }
    }
}

/// Writes what it has read.
type Again = fn(&[u8]) -> String;

fn again<D: Serialize + DeserializeOwned>(bytes: &[u8]) -> String {
    let document: D = serde_json::from_slice(bytes).unwrap_or_else(|e| {
        panic!("{}: {e}: {:.500}", std::any::type_name::<D>(), String::from_utf8_lossy(bytes))
    });
    text(&document).unwrap()
}

/// A sheet as it is printed: it has findings of its own.
#[derive(Serialize, serde::Deserialize)]
struct WithFailures<D> {
    #[serde(flatten)]
    document: D,
    failures: Vec<kesf::results::FailureEntry>,
}

macro_rules! readers {
    ($document:ty) => {
        [again::<$document>, again::<Complete<$document>>]
    };
}

/// The readers of a document as a file and as it is printed. Rows of Parquet tables are read as such, and `manifest.json` and
/// `run.json` are written piece by piece.
fn readers(document: &Value) -> Option<[Again; 2]> {
    Some(match document["schema"].as_str()? {
        "kesf.check/1" => readers!(CheckDocument),
        // Their files have findings and failures too.
        "kesf.comparison/1" => [again::<Complete<ComparisonDocument>>; 2],
        "kesf.curves/1" => readers!(CurvesDocument),
        "kesf.drape-image/1" => readers!(DrapeDocument),
        "kesf.explanations/1" => readers!(ExplanationsDocument),
        "kesf.export/1" => readers!(ExportDocument),
        "kesf.init/1" => readers!(InitDocument),
        "kesf.library/1" => readers!(LibraryDocument),
        "kesf.list/1" => readers!(ListDocument),
        "kesf.part/1" => readers!(PartDocument),
        "kesf.report/1" => readers!(ReportDocument),
        "kesf.results/1" => readers!(ResultsDocument),
        "kesf.section/1" => readers!(SectionDocument),
        "kesf.sheet/1" => [again::<SheetDocument>, again::<WithFailures<SheetDocument>>],
        "kesf.solution/1" => [again::<Complete<SolutionDocument>>; 2],
        "kesf.verify/1" => readers!(kesf::verify::VerifyDocument),
        "kesf.found/1" | "kesf.manifest/1" | "kesf.merged/1" | "kesf.run/1" => return None,
        other => panic!("no reader of {other}"),
    })
}

/// At the first line that is not the same.
fn assert_same(what: &str, again: String, bytes: &[u8]) {
    let written = String::from_utf8_lossy(bytes);
    let differs =
        again.lines().zip(written.lines()).enumerate().find(|(_, (again, written))| again != written);
    assert_eq!((differs, again.len()), (None, written.len()), "{what}: read and written");
}

/// A strip in every analysis that gives other keys.
const CASES: &[(&str, &str)] = &[
    ("modal", "[analysis]\nkind = \"modal\"\nmodes = 2\n"),
    ("motion", "[analysis]\nkind = \"newmark\"\nstep = \"1 ms\"\nduration = \"10 ms\"\n"),
    ("large", "[analysis]\nkind = \"nonlinear\"\n"),
    (
        "steps",
        "[analysis]\nkind = \"nonlinear\"\n[[steps]]\nname = \"half\"\n[[steps.loads]]\nkind = \"gravity\"\nvalue = \"4.9 m/s²\"\n\
         [[steps]]\nname = \"all\"\n[[steps.loads]]\nkind = \"gravity\"\nvalue = \"9.8 m/s²\"\n",
    ),
    ("meshes", "[convergence]\nmeshes = 3\n"),
    ("sampled", "[analysis]\nkind = \"nonlinear\"\n[uncertainty]\npoints = 16\n"),
];

fn case(name: &str, analysis: &str) -> String {
    let load = "[[loads]]\nkind = \"gravity\"\nvalue = \"9.8 m/s²\"\n";
    let load = if ["steps", "modal"].contains(&name) { "" } else { load };
    let (quantity, expected) = match name {
        "modal" => ("frequency_1", "1e5 Hz"),
        _ => ("w_max", "1 mm"),
    };
    format!(
        "title = \"{name}\"\nfabric = \"*\"\n[sheet]\nshape = \"strip\"\nwidth = \"20 mm\"\nheight = \"10 mm\"\n\
         cells = [8, 4]\n[[supports]]\nset = \"left\"\nkind = \"clamped\"\n\
         [[probes]]\nname = \"tip\"\nat = [\"20 mm\", \"5 mm\"]\n\
         [[checks]]\nquantity = \"{quantity}\"\nexpected = \"{expected}\"\nrelative_tolerance = 0.5\n\
         reference = {{ kind = \"own\", source = \"of this test\" }}\n{load}{analysis}"
    )
}

const DRAPE: &str = "title = \"coarse drape\"\nfabric = \"*\"\n[sheet]\nshape = \"annulus\"\ninner_diameter = \"18 cm\"\n\
    diameter = \"24 cm\"\ncells = [4, 24]\n[[supports]]\nset = \"inner\"\nkind = \"clamped\"\n\
    [[loads]]\nkind = \"gravity\"\n[analysis]\nkind = \"drape\"\nfolds = [4]\nrefinements = 0\n";

/// Bending tests of a strip.
const STRIPS: &[(&str, &str)] = &[
    ("heart", "[bending_test]\ntest = \"heart_loop\"\nlength = \"10 cm\"\n"),
    ("bent", "[bending_test]\ntest = \"cantilever\"\n[uncertainty]\npoints = 16\n"),
    ("fab", "[bending_test]\ntest = \"fab_bend_loop\"\ncells = 8\n"),
];

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
    seen.print_with(1, &["characterise", "kesf_data", "no_such_folder"]);
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
    assert!(seen.wrong.is_empty(), "{}", seen.wrong.join("\n"));
    let seen_or_read: BTreeSet<String> =
        ["case", "dialect", "drape-image", "fabric", "open-fabric", "settings"].map(String::from).into();
    let all: BTreeSet<String> = kesf::schema::SCHEMAS.iter().map(|file| file.name.to_string()).collect();
    assert_eq!(all, &seen.schemas | &seen_or_read, "each schema has seen a document");
}

#[test]
fn the_documents_of_every_analysis_and_test_are_as_their_schema_says() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let mut seen = Seen::default();
    for (name, analysis) in CASES {
        let path = at(&format!("{name}.toml"));
        fs::write(&path, case(name, analysis)).unwrap();
        let solutions = seen.entries(1, &["solve", &path, "kesf_data/poplin"], "solutions");
        assert!(solutions.iter().all(|solution| solution["status"] == "check_failed"), "{name}");
    }
    fs::write(at("drape.toml"), DRAPE).unwrap();
    let drapes = seen.entries(0, &["solve", &at("drape.toml"), "kesf_data/petrak_m1"], "solutions");
    assert!(drapes.iter().all(|drape| drape["status"] == "ok"));
    compare_strips(&mut seen, &at);
    fs::write(at("drape.png"), generator::Synthetic::random(0).png()).unwrap();
    let picture = seen.print(&["drape-image", &at("drape.png"), "--pixels-per-cm", "10"]);
    assert_eq!(picture["captures"].as_array().unwrap().len(), 1);
    assert!(seen.wrong.is_empty(), "{}", seen.wrong.join("\n"));
}

fn compare_strips(seen: &mut Seen, at: &impl Fn(&str) -> String) {
    let fab = "../shared/data/u3m/physics_example2.json";
    for (name, test) in STRIPS {
        let path = at(&format!("{name}.toml"));
        fs::write(&path, format!("title = \"{name}\"\nfabric = \"*\"\n{test}")).unwrap();
        let fabric = if *name == "fab" { fab } else { "kesf_data/poplin" };
        if Path::new(env!("CARGO_MANIFEST_DIR")).join(fabric).exists() {
            seen.entries(0, &["compare", &path, fabric], "comparisons");
        } else {
            common::skipped(
                "the_documents_of_every_analysis_and_test_are_as_their_schema_says",
                &format!("no {fabric}"),
            );
        }
    }
}

/// The errors of a TOML text under a schema that is closed.
fn errors_of_toml(schema: &str, text: &str) -> Vec<String> {
    let value = serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap();
    validator(schema).iter_errors(&value).map(|e| format!("{}: {e:.300}", e.instance_path())).collect()
}

/// The TOML files of a folder, and one level below it.
fn toml_files(folder: &str) -> Vec<std::path::PathBuf> {
    let below =
        |folder: &Path| -> Vec<_> { fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect() };
    let all = below(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    let deeper: Vec<_> = all.iter().filter(|path| path.is_dir()).flat_map(|path| below(path)).collect();
    all.into_iter().chain(deeper).filter(|path| path.extension().is_some_and(|e| e == "toml")).collect()
}

#[test]
fn every_toml_file_that_is_shipped_is_as_its_schema_says() {
    for (schema, folder, at_least) in
        [("case", "cases", 15), ("fabric", "kesf_data", 13), ("dialect", "src/instrument/dialects", 14)]
    {
        // What is known of a synthetic fabric is for the tests alone.
        let files: Vec<_> =
            toml_files(folder).into_iter().filter(|path| !path.ends_with("truth.toml")).collect();
        assert!(files.len() >= at_least, "{folder}: {}", files.len());
        for path in files {
            let wrong = errors_of_toml(schema, &fs::read_to_string(&path).unwrap());
            assert!(wrong.is_empty(), "{}: {}", path.display(), wrong.join("\n"));
        }
    }
    let settings = "shear_slope = [\"0.5 deg\", \"2.5 deg\"]\nreversal = \"5 %\"\n";
    assert_eq!(errors_of_toml("settings", settings), Vec::<String>::new());
    assert!(!errors_of_toml("settings", "shear_slop = [\"0.5 deg\", \"2.5 deg\"]\n").is_empty());
    let wrong = case("motion", "[analysis]\nkind = \"newmark\"\ntime_step = \"1 ms\"\n");
    assert!(!errors_of_toml("case", &wrong).is_empty());
    for (name, analysis) in CASES {
        assert_eq!(errors_of_toml("case", &case(name, analysis)), Vec::<String>::new(), "{name}");
    }
}

/// A schema that is of something else says so.
#[test]
fn a_key_that_no_schema_knows_is_an_error() {
    let known = json!({"schema": "kesf.library/1", "output": "a.parquet", "fabrics": 3, "left_out": [], "failures": []});
    assert!(validator("library").is_valid(&known));
    for wrong in [
        json!({"schema": "kesf.library/1", "output": "a.parquet", "fabrics": 3, "left_out": [], "shelf": 1}),
        json!({"schema": "kesf.library/1", "output": "a.parquet", "left_out": []}),
        json!({"schema": "kesf.found/1", "output": "a.parquet", "fabrics": 3, "left_out": []}),
        json!({"schema": "kesf.library/1", "output": "a.parquet", "fabrics": "3", "left_out": []}),
    ] {
        assert!(!validator("library").is_valid(&wrong), "{wrong}");
    }
}
