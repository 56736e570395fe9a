//! The layering of the crate, as data: which module may use which, who may name a heavy crate,
//! who may print, and that every diagnostic code has its explanation and is used.
//!
//! Imports are read from the text of `src/`: comments and test modules are left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use kesf::finding::explanations;

/// Module, modules that it may use, heavy crates that it may name; in the order of `lib.rs`.
const LAYERS: &[(&str, &[&str], &[&str])] = &[
    ("quantity", &[], &[]),
    ("kes", &["quantity"], &[]),
    ("finding", &["quantity", "kes"], &["toml"]),
    ("law", &["finding"], &[]),
    (
        "instrument",
        &["quantity", "kes", "finding"],
        &["csv", "calamine", "cfb", "encoding_rs", "toml", "zip"],
    ),
    ("characterise", &["quantity", "kes", "finding", "law", "instrument"], &["faer"]),
    ("section", &["finding", "quantity", "law"], &[]),
    ("analytical", &["section"], &[]),
    ("mesh", &["finding", "quantity"], &[]),
    ("element", &["finding", "section", "mesh", "law"], &[]),
    ("model", &["finding", "quantity", "section", "mesh", "law", "element"], &[]),
    ("solve", &["finding", "quantity", "section", "mesh", "law", "element", "model"], &["faer"]),
    ("fields", &["finding", "quantity", "section", "mesh", "law", "element", "model", "solve"], &[]),
    ("constitutive", &["finding", "quantity", "law", "instrument", "characterise", "section"], &[]),
    ("study", &ABOVE_STUDY, &["toml"]),
    (
        "verify",
        &["finding", "law", "section", "analytical", "mesh", "element", "model", "solve", "fields"],
        &["toml"],
    ),
    (
        "report",
        &ABOVE_REPORT,
        &["base64", "csv", "dejavu", "percent_encoding", "plotters", "png", "polars", "quick_xml"],
    ),
    ("results", &ABOVE_RESULTS, &["toml"]),
    ("run", &["finding", "instrument", "study", "report", "results"], &[]),
    ("cli", &ABOVE_CLI, &["clap", "clap_complete", "indicatif", "ctrlc"]),
];

const ABOVE_STUDY: [&str; 14] = [
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
];

const ABOVE_REPORT: [&str; 11] = [
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
];

const ABOVE_RESULTS: [&str; 14] = [
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
];

const ABOVE_CLI: [&str; 11] = [
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
];

/// Paths under which alone a crate may be named.
const ONE_PLACE: &[(&str, &[&str])] =
    &[("faer", &["src/solve/factor", "src/solve/multifrontal", "src/characterise/friction/nnls.rs"])];

/// What only `cli` may call.
const PRINTING: &[&str] = &["println!", "eprintln!", "print!", "eprint!", "dbg!"];

/// Product code of every file of a module: `(path, text without comments and tests)`.
fn files() -> BTreeMap<String, Vec<(PathBuf, String)>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut modules = BTreeMap::new();
    for &(module, ..) in LAYERS {
        let (mut found, mut folders) = (Vec::new(), vec![root.join(module)]);
        let file = root.join(format!("{module}.rs"));
        if let (Ok(text), Some(_)) = (fs::read_to_string(&file), folders.pop_if(|folder| !folder.is_dir())) {
            found.push((file, product_code(&text)));
        }
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|e| e == "rs") && path.file_stem().unwrap() != "tests"
                {
                    found.push((path.clone(), product_code(&fs::read_to_string(path).unwrap())));
                }
            }
        }
        modules.insert(module.to_string(), found);
    }
    modules
}

/// The text up to the test module, without comment lines.
fn product_code(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let code = |line: &&str| !line.trim_start().starts_with("//");
    text.lines().filter(code).map(|line| format!("{line}\n")).collect()
}

/// The modules named after `crate::`, in paths and in `use crate::{a::B, c}`.
fn imports(code: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for rest in code.split("crate::").skip(1) {
        if !rest.starts_with('{') {
            names.insert(identifier(rest));
            continue;
        }
        let (mut depth, mut start) = (0, true);
        for (i, c) in rest.char_indices() {
            match c {
                '{' => (depth, start) = (depth + 1, depth == 0),
                '}' => depth -= 1,
                ',' => start = depth == 1,
                c if c.is_whitespace() => {}
                _ if start && depth == 1 => {
                    names.insert(identifier(&rest[i..]));
                    start = false;
                }
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    names
}

fn identifier(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// Whether the code names `name` as a crate: `name::` at the start of a path, or `use name`.
fn names_crate(code: &str, name: &str) -> bool {
    code.match_indices(&format!("{name}::")).any(|(at, _)| {
        let before = code[..at].chars().next_back().unwrap_or(' ');
        !(before.is_alphanumeric() || matches!(before, '_' | ':'))
    })
}

#[test]
fn lib_rs_lists_the_layers_in_their_order() {
    let lib = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    let listed: Vec<_> =
        lib.lines().filter_map(|l| l.trim().strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    let table: Vec<_> = LAYERS.iter().map(|l| l.0).collect();
    assert_eq!(listed, table);
    for (i, (module, uses, _)) in LAYERS.iter().enumerate() {
        for used in *uses {
            assert!(table[..i].contains(used), "the table lets {module} use {used}, which is not above it");
        }
    }
}

#[test]
fn a_module_uses_only_the_layers_that_the_table_allows() {
    let modules = files();
    let all: BTreeSet<_> = LAYERS.iter().map(|l| l.0).collect();
    let mut wrong = Vec::new();
    for (module, uses, _) in LAYERS {
        for (path, code) in &modules[*module] {
            for name in imports(code) {
                if all.contains(name.as_str()) && name != *module && !uses.contains(&name.as_str()) {
                    wrong.push(format!("{}: {module} must not use {name}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn heavy_crates_are_named_only_where_the_table_allows() {
    let modules = files();
    let heavy: BTreeSet<_> = LAYERS.iter().flat_map(|l| l.2.iter().copied()).collect();
    let mut wrong = Vec::new();
    for (module, _, crates) in LAYERS {
        for (path, code) in &modules[*module] {
            for name in heavy.iter().filter(|name| names_crate(code, name)) {
                let only = ONE_PLACE.iter().find(|(c, _)| c == name);
                let elsewhere = only
                    .is_some_and(|(_, places)| !places.iter().any(|p| path.to_string_lossy().contains(p)));
                if !crates.contains(name) || elsewhere {
                    wrong.push(format!("{}: {module} must not name {name} here", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn only_the_command_line_prints() {
    let mut wrong = Vec::new();
    for (module, files) in files() {
        for (path, code) in files {
            let macros = PRINTING.iter().filter(|m| code.contains(**m) && module != "cli");
            wrong.extend(macros.map(|m| format!("{}: {m}", path.display())));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_code_is_explained_and_every_explained_code_is_used() {
    let mut used = BTreeSet::new();
    for (_, code) in files().into_values().flatten() {
        let text: Vec<char> = code.chars().collect();
        for (i, w) in text.windows(4).enumerate() {
            let letter = "RKCMNSO".contains(w[0]) && w[1..].iter().all(char::is_ascii_digit);
            let part_of_a_word = |at: Option<&char>| at.is_some_and(|c| c.is_alphanumeric() || *c == '_');
            let before = i.checked_sub(1).and_then(|b| text.get(b));
            if letter && !part_of_a_word(before) && !part_of_a_word(text.get(i + 4)) {
                used.insert(w.iter().collect::<String>());
            }
        }
    }
    let explained: BTreeSet<_> = explanations().iter().map(|e| e.code.clone()).collect();
    let missing: Vec<_> = used.difference(&explained).collect();
    let idle: Vec<_> = explained.difference(&used).collect();
    assert!(missing.is_empty(), "codes without an explanation: {missing:?}");
    assert!(idle.is_empty(), "explanations of codes that nothing gives: {idle:?}");
}

#[test]
fn the_scanner_sees_every_form_of_import() {
    let code = "use crate::a::B;\nuse crate::{b, c::{D, e}, f::G};\nfn x() { crate::h::y(); }\n";
    let names: Vec<_> = imports(&product_code(code)).into_iter().collect();
    assert_eq!(names, ["a", "b", "c", "f", "h"]);
    assert!(names_crate("let x = faer::Mat::new();", "faer"));
    assert!(!names_crate("let x = not_faer::Mat::new();", "faer"));
    assert!(!product_code("// crate::a\nx\n#[cfg(test)]\nmod tests {}\n").contains("tests"));
}
