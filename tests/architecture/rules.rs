//! The rules, as tables and as functions from a crate to its violations, one line each.

use std::collections::{BTreeMap, BTreeSet};

use crate::source::Crate;

/// Module, modules that it may use, heavy crates that it may name; in the order of `lib.rs`.
pub const LAYERS: &[(&str, &[&str], &[&str])] = &[
    ("platform", &[], &["rayon"]),
    ("quantity", &["platform"], &[]),
    ("kes", &["quantity"], &[]),
    ("finding", &["quantity", "kes"], &["toml"]),
    ("law", &["finding"], &[]),
    (
        "instrument",
        &["platform", "quantity", "kes", "finding"],
        &[
            "csv",
            "calamine",
            "cfb",
            "contour",
            "encoding_rs",
            "image",
            "imageproc",
            "quick_xml",
            "toml",
            "zip",
        ],
    ),
    ("characterise", &["platform", "quantity", "kes", "finding", "law", "instrument"], &["faer"]),
    ("section", &["finding", "quantity", "law"], &[]),
    ("analytical", &["section"], &[]),
    ("mesh", &["finding", "quantity"], &["dxf", "encoding_rs", "kurbo", "quick_xml", "spade", "svgtypes"]),
    ("element", &["finding", "section", "mesh", "law"], &[]),
    ("model", &["finding", "quantity", "section", "mesh", "law", "element"], &[]),
    ("solve", &["platform", "finding", "quantity", "section", "mesh", "law", "element", "model"], &["faer"]),
    ("fields", &["finding", "quantity", "section", "mesh", "law", "element", "model", "solve"], &[]),
    ("constitutive", &["finding", "quantity", "law", "instrument", "characterise", "section"], &[]),
    (
        "case",
        &[
            "platform",
            "quantity",
            "kes",
            "finding",
            "law",
            "instrument",
            "characterise",
            "element",
            "model",
            "solve",
            "fields",
            "constitutive",
        ],
        &[],
    ),
    (
        "study",
        &[
            "case",
            "platform",
            "quantity",
            "kes",
            "finding",
            "law",
            "instrument",
            "characterise",
            "section",
            "analytical",
            "mesh",
            "element",
            "model",
            "solve",
            "fields",
            "constitutive",
        ],
        &[],
    ),
    (
        "verify",
        &[
            "platform",
            "quantity",
            "finding",
            "law",
            "instrument",
            "characterise",
            "section",
            "analytical",
            "mesh",
            "element",
            "model",
            "solve",
            "fields",
            "constitutive",
        ],
        &["toml"],
    ),
    (
        "report",
        &[
            "platform",
            "quantity",
            "kes",
            "finding",
            "law",
            "instrument",
            "characterise",
            "section",
            "mesh",
            "fields",
            "constitutive",
            "study",
        ],
        &[
            "base64",
            "csv",
            "dejavu",
            "gltf",
            "image",
            "imageproc",
            "krilla",
            "percent_encoding",
            "plotters",
            "png",
            "arrow_array",
            "arrow_schema",
            "arrow_select",
            "bytes",
            "parquet",
            "polars",
            "quick_xml",
            "rust_xlsxwriter",
        ],
    ),
    ("schema", &["quantity", "instrument", "characterise", "case"], &[]),
    (
        "results",
        &[
            "schema",
            "case",
            "platform",
            "quantity",
            "kes",
            "finding",
            "law",
            "instrument",
            "characterise",
            "section",
            "model",
            "solve",
            "fields",
            "constitutive",
            "study",
            "verify",
            "report",
        ],
        &["toml"],
    ),
    ("run", &["case", "platform", "finding", "instrument", "study", "report", "results"], &[]),
    (
        "parts",
        &["case", "platform", "finding", "instrument", "report", "results", "run"],
        &["arrow_array", "arrow_schema", "arrow_select", "bytes"],
    ),
    (
        "library",
        &["platform", "quantity", "kes", "finding", "instrument", "report", "results", "parts"],
        &["arrow_array", "arrow_schema", "arrow_select", "csv", "parquet", "winnow"],
    ),
    (
        "documents",
        &["schema", "kes", "finding", "instrument", "verify", "report", "results", "run", "library"],
        &[],
    ),
    (
        "cli",
        &[
            "documents",
            "schema",
            "case",
            "platform",
            "quantity",
            "kes",
            "finding",
            "instrument",
            "characterise",
            "constitutive",
            "study",
            "verify",
            "report",
            "results",
            "run",
            "parts",
            "library",
        ],
        &["clap", "clap_complete", "clap_mangen", "indicatif", "ctrlc", "rayon"],
    ),
];

/// Paths (crates, or modules and types of the standard library) that may be named below certain
/// places only.
const PLACES: &[(&str, &[&str])] = &[
    (
        "faer",
        &[
            "src/solve/factor",
            "src/solve/modal/products.rs",
            "src/solve/multifrontal",
            "src/characterise/friction/nnls.rs",
        ],
    ),
    // A target without a system has none of these: threads, the clock and files that are read are in
    // `platform`, files are written where results leave, and the rest is the command's.
    ("rayon", &["src/platform/parallel.rs", "src/cli/"]),
    ("std::thread", &["src/cli/"]),
    ("std::time::Instant", &["src/platform/clock.rs", "src/cli/"]),
    ("std::time::SystemTime", &["src/cli/"]),
    ("std::fs", FILES),
    ("std::env", &["src/cli/"]),
    ("std::process", &["src/cli/"]),
    ("std::net", &[]),
    ("std::io::stdin", &["src/cli/"]),
    ("std::io::stdout", &["src/cli/"]),
    ("std::io::stderr", &["src/cli/"]),
];

/// Where files are read, or written.
const FILES: &[&str] = &[
    "src/platform/files",
    "src/report/output_folder.rs",
    "src/report/write.rs",
    "src/results/init/",
    // What the system tells of this process.
    "src/results/solved/effort.rs",
    "src/cli/",
];

/// What asks the system about a path: the layers ask `platform::files`, but for those that write.
const QUESTIONS: &[&str] =
    &["is_dir", "is_file", "exists", "canonicalize", "is_symlink", "read_dir", "metadata"];

/// What only `cli` may call.
const PRINTING: &[&str] = &["println", "eprintln", "print", "eprint", "dbg"];

/// Most files that may need one another in a circle.
const CIRCLE: usize = 3;

/// Most lines of a file of the command, and the files that are longer still. The list only gets shorter.
const COMMAND_LINES: usize = 120;
const LONG_COMMANDS: &[&str] = &[];

/// Violations of the layering: every path to a module that the table does not allow.
pub fn upward(source: &Crate) -> Vec<String> {
    let layer = |name: &str| LAYERS.iter().find(|l| l.0 == name);
    let mut wrong = Vec::new();
    for module in source.modules.values() {
        let Some((own, uses, _)) = module.path.first().and_then(|name| layer(name)) else { continue };
        for name in &module.names {
            let Some(path) = source.absolute(&module.path, &name.segments) else { continue };
            let at = format!("{}:{}", module.file, name.line);
            match path.first().map(String::as_str) {
                None | Some("*") => wrong.push(format!("{at}: the whole crate is named")),
                Some(other) if other == *own || uses.contains(&other) => {}
                Some(other) if layer(other).is_some() => {
                    wrong.push(format!("{at}: {own} must not use {other}"));
                }
                Some(_) => {}
            }
        }
    }
    wrong
}

/// Heavy crates that are named in a layer to which the table does not give them.
pub fn heavy(source: &Crate) -> Vec<String> {
    let heavy: BTreeSet<_> = LAYERS.iter().flat_map(|l| l.2.iter().copied()).collect();
    let mut wrong = Vec::new();
    for module in source.modules.values() {
        let own = module.path.first().and_then(|name| LAYERS.iter().find(|l| l.0 == name));
        for name in &module.names {
            let first = name.segments[0].as_str();
            let other = source.absolute(&module.path, &name.segments).is_none();
            if other && heavy.contains(first) && !own.is_some_and(|l| l.2.contains(&first)) {
                wrong.push(format!("{}:{}: {first} must not be named here", module.file, name.line));
            }
        }
    }
    wrong
}

/// Paths of [`PLACES`] that are named elsewhere.
pub fn places(source: &Crate) -> Vec<String> {
    let mut wrong = Vec::new();
    for module in source.modules.values() {
        for name in &module.names {
            if source.absolute(&module.path, &name.segments).is_some() {
                continue;
            }
            let segments = source.foreign(&module.path, &name.segments);
            for (path, places) in PLACES {
                let inside = places.iter().any(|place| module.file.starts_with(place));
                if !inside && begins(&segments, path) {
                    wrong.push(format!("{}:{}: {path} must not be named here", module.file, name.line));
                }
            }
        }
    }
    wrong
}

/// Whether a path leads to another or below it; a glob leads to everything.
fn begins(segments: &[String], path: &str) -> bool {
    let mut rest = segments.iter();
    path.split("::").all(|part| match rest.next().map(String::as_str) {
        Some("*") => true,
        found => found == Some(part),
    })
}

/// Calls of [`QUESTIONS`] where files are not read or written.
pub fn questions(source: &Crate) -> Vec<String> {
    let mut wrong = Vec::new();
    for module in source.modules.values() {
        if FILES.iter().any(|place| module.file.starts_with(place)) {
            continue;
        }
        let asked = module.methods.iter().filter(|(name, _)| QUESTIONS.contains(&name.as_str()));
        wrong.extend(
            asked.map(|(name, line)| format!("{}:{line}: .{name}(): ask platform::files", module.file)),
        );
    }
    wrong
}

/// Printing outside the command.
pub fn printing(source: &Crate) -> Vec<String> {
    let mut wrong = Vec::new();
    for module in source.modules.values().filter(|m| m.path.first().is_none_or(|name| name != "cli")) {
        let printing = module.macros.iter().filter(|(name, _)| PRINTING.contains(&name.as_str()));
        wrong.extend(printing.map(|(name, line)| format!("{}:{line}: {name}!", module.file)));
    }
    wrong
}

/// Sets of files each of which needs, over others, every other one.
fn circles_of(source: &Crate) -> Vec<BTreeSet<&str>> {
    let needs = source.needs();
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        needs.keys().map(|file| (*file, reachable(&needs, file))).collect();
    let mut found: Vec<BTreeSet<&str>> = Vec::new();
    for (file, all) in &reached {
        if found.iter().all(|circle| !circle.contains(file)) {
            let circle: BTreeSet<_> =
                all.iter().copied().filter(|other| reached[other].contains(file)).collect();
            found.push(circle);
        }
    }
    found
}

fn reachable<'a>(needs: &BTreeMap<&'a str, BTreeSet<&'a str>>, from: &'a str) -> BTreeSet<&'a str> {
    let (mut found, mut next) = (BTreeSet::new(), vec![from]);
    while let Some(file) = next.pop() {
        next.extend(needs[file].iter().copied().filter(|needed| found.insert(*needed)));
    }
    found
}

/// Circles of files that are too long.
pub fn circles(source: &Crate) -> Vec<String> {
    let mut wrong = Vec::new();
    for circle in circles_of(source) {
        if circle.len() > CIRCLE {
            let files: Vec<_> = circle.iter().copied().collect();
            wrong.push(format!("{} files need one another: {}", files.len(), files.join(" ")));
        }
    }
    wrong
}

/// Files of the command that are too long, with their tests.
pub fn long_commands(source: &Crate, files: &BTreeMap<String, String>) -> Vec<String> {
    let command = source.modules.values().filter(|m| m.path.first().is_some_and(|name| name == "cli"));
    let paths: BTreeSet<_> = command.map(|m| &m.file).collect();
    let lines = paths.into_iter().map(|file| (file, files[file].lines().count()));
    let known = |file: &str| LONG_COMMANDS.iter().any(|name| file == format!("src/cli/{name}.rs"));
    lines
        .filter(|(file, lines)| *lines > COMMAND_LINES && !known(file))
        .map(|(file, lines)| format!("{file}: {lines} lines, at most {COMMAND_LINES}"))
        .collect()
}

/// Diagnostic codes that product code names, in identifiers and literals.
pub fn codes(source: &Crate) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for word in source.modules.values().flat_map(|m| &m.words) {
        let text: Vec<char> = word.chars().collect();
        for (i, w) in text.windows(4).enumerate() {
            let code = "RKCMNSO".contains(w[0]) && w[1..].iter().all(char::is_ascii_digit);
            let part_of_a_word = |at: Option<&char>| at.is_some_and(|c| c.is_alphanumeric() || *c == '_');
            let before = i.checked_sub(1).and_then(|b| text.get(b));
            if code && !part_of_a_word(before) && !part_of_a_word(text.get(i + 4)) {
                used.insert(w.iter().collect::<String>());
            }
        }
    }
    used
}
