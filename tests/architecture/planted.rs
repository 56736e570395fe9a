//! Each rule against a small crate with violations where a reader of texts would miss them.

use std::collections::BTreeMap;

use crate::rules;
use crate::source::Crate;

fn planted(files: &[(&str, &str)]) -> Crate {
    Crate::read(&texts(files))
}

fn texts(files: &[(&str, &str)]) -> BTreeMap<String, String> {
    files.iter().map(|(path, text)| (format!("src/{path}"), (*text).to_string())).collect()
}

const LIB: (&str, &str) = ("lib.rs", "pub mod section;\npub mod element;\npub mod study;\npub mod cli;\n");
const SECTION: (&str, &str) = ("section.rs", "pub struct S;\n");
const STUDY: (&str, &str) = ("study.rs", "pub struct Case;\n");
const CLI: (&str, &str) = ("cli.rs", "pub fn f() { println!(\"{}\", 1) }\n");

/// A crate whose `element` is the text.
fn with_element(text: &str) -> Crate {
    planted(&[LIB, SECTION, STUDY, CLI, ("element/mod.rs", text), ("element/inner.rs", "pub struct I;")])
}

#[test]
fn a_clean_crate_has_no_violation() {
    let clean = with_element(
        "use crate::section::S;\nmod inner;\npub use inner::I;\n// crate::study\n/// [`crate::study::Case`]\npub(in crate::element) fn f() {}\n",
    );
    assert_eq!(rules::upward(&clean), [""; 0]);
    assert_eq!(rules::heavy(&clean), [""; 0]);
    assert_eq!(rules::places(&clean), [""; 0]);
    assert_eq!(rules::printing(&clean), [""; 0]);
    assert_eq!(rules::circles(&clean), [""; 0]);
}

#[test]
fn upward_imports_are_seen_in_every_form_and_place() {
    let upward = ["src/element/mod.rs:3: element must not use study"];
    for text in [
        "#[cfg(test)]\nmod tests { use crate::cli; }\nuse crate::study::Case;",
        "#[cfg(test)]\nuse crate::cli::f;\nfn f(_: crate::study::Case) {}",
        "use crate::{\n    section::S,\n    study::{Case as Other},\n};",
        "\n\nuse super::study as s;",
        "mod deep {\nfn f() {\nlet _ = super::super::study::Case;\n} }",
        "\nfn f() {\nlet _ = vec![Some(crate::study::Case)]; }",
        "macro_rules! m { () => {\n{\n$crate::study::Case } } }",
        "#[cfg(any(test, unix))]\nfn f() {\nuse crate::{section::*, study::*}; }",
        "struct A {\n\na: Option<crate::study::Case> }",
        "impl<T> A for B<T>\nwhere T:\ncrate::study::Case {}",
        "#[cfg(not(test))]\n\npub use crate::study::Case;",
    ] {
        assert_eq!(rules::upward(&with_element(text)), upward, "{text}");
    }
    for text in ["use super as up;", "use crate as up;", "use crate::*;", "pub use super::*;"] {
        let found = rules::upward(&with_element(text));
        assert_eq!(found, ["src/element/mod.rs:1: the whole crate is named"], "{text}");
    }
}

#[test]
fn what_only_tests_compile_is_no_violation() {
    for text in [
        "#[cfg(test)]\nmod tests { use crate::study::Case; }",
        "#[cfg(all(test, unix))]\nfn f() { crate::study::g(); println!(); }",
        "struct A;\nimpl A { #[cfg(test)]\nfn f() { crate::study::g(); } }",
        "enum A { #[cfg(test)]\nB(crate::study::Case) }",
        "fn f() { #[cfg(test)]\nlet a = crate::study::Case; #[cfg(test)]\n{ faer::a(); } }",
        "struct A { #[cfg(test)]\na: crate::study::Case }",
    ] {
        let crate_ = with_element(text);
        assert_eq!(rules::upward(&crate_), [""; 0], "{text}");
        assert_eq!(rules::printing(&crate_), [""; 0], "{text}");
        assert_eq!(rules::heavy(&crate_), [""; 0], "{text}");
    }
    let files = [LIB, SECTION, STUDY, CLI, ("element.rs", "#[cfg(test)]\n#[path = \"odd.rs\"]\nmod tests;")];
    let crate_ = planted(&[&files[..], &[("odd.rs", "use crate::study::Case;")]].concat());
    assert_eq!(rules::upward(&crate_), [""; 0]);
    assert!(crate_.tests.contains("src/odd.rs"));
}

#[test]
fn heavy_crates_are_seen() {
    for text in [
        "#[cfg(test)]\nmod tests {}\nuse faer::Mat;",
        "\n\nuse {std::fmt, faer as linear};",
        "\n\nextern crate faer;",
        "fn f() {\nassert_eq!(1,\n::faer::one()); }",
    ] {
        let found = rules::heavy(&with_element(text));
        assert_eq!(found, ["src/element/mod.rs:3: faer must not be named here"], "{text}");
    }
    assert_eq!(rules::heavy(&with_element("fn f() { not::faer::x(); }\nmod faer {}")), [""; 0]);
}

#[test]
fn clock_threads_and_files_are_seen() {
    for (text, what) in [
        ("#[cfg(test)]\nmod tests {}\nuse std::{fs, fmt};", "std::fs"),
        ("\n\nuse std::time::{Duration, Instant as Now};", "std::time::Instant"),
        ("fn f() {\nvec![\nstd::fs::read(\"a\")]; }", "std::fs"),
        ("fn f() {\n\nstd::thread::spawn(g); }", "std::thread"),
        ("use std::io::{self, Write};\nfn f() {\nio::stdout(); }", "std::io::stdout"),
        ("#[cfg(feature = \"threads\")]\n\nuse rayon::prelude::*;", "rayon"),
    ] {
        let found = rules::places(&with_element(text));
        assert_eq!(found, [format!("src/element/mod.rs:3: {what} must not be named here")], "{text}");
    }
    assert_eq!(rules::places(&with_element("use std::time::Duration;\nuse std::{fmt, io};")), [""; 0]);
}

#[test]
fn questions_to_the_system_are_seen() {
    let text = "fn f(p: &std::path::Path) -> bool {\np.join(\"a\").exists() }\n#[cfg(test)]\nmod tests { fn f() { p.is_dir(); } }";
    assert_eq!(
        rules::questions(&with_element(text)),
        ["src/element/mod.rs:2: .exists(): ask platform::files"]
    );
    assert_eq!(rules::questions(&with_element("fn f() { crate::section::exists(1) }")), [""; 0]);
}

#[test]
fn printing_is_seen() {
    for text in [
        "#[cfg(test)]\nmod tests {}\nfn f() { println!() }",
        "fn f() {\nformat!(\"{}\",\n{ std::eprintln!(\"a\"); 1 }) }",
        "macro_rules! m { () => {\n{\ndbg!(1) } } }",
    ] {
        let found = rules::printing(&with_element(text));
        assert_eq!(found.len(), 1, "{text}");
        assert!(found[0].starts_with("src/element/mod.rs:3: "), "{text}");
    }
}

#[test]
fn circles_are_seen_behind_names_that_are_passed_on() {
    let ring = |last: &str| {
        planted(&[
            ("lib.rs", "pub mod element;"),
            ("element/mod.rs", "mod a; mod b; mod c; mod d;\npub use {a::A, b::*, c::C, d::D};"),
            ("element/a.rs", "use super::B; pub struct A;"),
            ("element/b.rs", "use crate::element; pub struct B(element::C);"),
            ("element/c.rs", "use super::*; pub struct C(D, super::d::D);"),
            ("element/d.rs", last),
        ])
    };
    assert_eq!(rules::circles(&ring("pub struct D;")), [""; 0]);
    assert_eq!(rules::circles(&ring("#[cfg(test)] use super::A; pub struct D;")), [""; 0]);
    let found = rules::circles(&ring("pub struct D(super::A);"));
    let files = "src/element/a.rs src/element/b.rs src/element/c.rs src/element/d.rs";
    assert_eq!(found, [format!("4 files need one another: {files}")]);
}
