//! The layering of the crate, as data: which module may use which, who may name a heavy crate, the
//! clock, threads, files or the terminal, how long files of the command are, how far files need one
//! another in circles, and that every diagnostic code has its explanation and is used.
//!
//! [`source`] reads the modules as the compiler does, tests left out. Each rule is shown to see a
//! violation that is planted in a small crate ([`planted`]).

mod planted;
mod ratchet;
mod rules;
mod source;

use std::collections::BTreeSet;
use std::sync::LazyLock;

use kesf::finding::explanations;
use source::Crate;

static SOURCE: LazyLock<Crate> = LazyLock::new(|| Crate::read(&source::files()));

fn assert_none(violations: &[String]) {
    assert!(violations.is_empty(), "{}", violations.join("\n"));
}

#[test]
fn every_file_belongs_to_a_module() {
    let used: BTreeSet<_> = SOURCE.modules.values().map(|m| &m.file).chain(&SOURCE.tests).cloned().collect();
    let files: BTreeSet<_> = source::files().into_keys().filter(|f| f != "src/main.rs").collect();
    assert_eq!(used, files);
}

#[test]
fn lib_rs_lists_the_layers_in_their_order() {
    let lib = &source::files()["src/lib.rs"];
    let listed: Vec<_> =
        lib.lines().filter_map(|l| l.trim().strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    let table: Vec<_> = rules::LAYERS.iter().map(|l| l.0).collect();
    assert_eq!(listed, table);
    for (i, (module, uses, _)) in rules::LAYERS.iter().enumerate() {
        for used in *uses {
            assert!(table[..i].contains(used), "the table lets {module} use {used}, which is not above it");
        }
    }
}

#[test]
fn a_module_uses_only_the_layers_that_the_table_allows() {
    assert_none(&rules::upward(&SOURCE));
}

#[test]
fn heavy_crates_are_named_only_where_the_table_allows() {
    assert_none(&rules::heavy(&SOURCE));
}

#[test]
fn clock_threads_files_and_process_are_named_only_where_the_table_allows() {
    assert_none(&rules::places(&SOURCE));
}

#[test]
fn the_layers_ask_the_platform_about_files_and_not_the_system() {
    assert_none(&rules::questions(&SOURCE));
}

#[test]
fn only_the_command_line_prints() {
    assert_none(&rules::printing(&SOURCE));
}

#[test]
fn files_do_not_need_one_another_in_long_circles() {
    assert_none(&rules::circles(&SOURCE));
}

#[test]
fn files_of_the_command_are_short() {
    assert_none(&rules::long_commands(&SOURCE, &source::files()));
}

#[test]
fn the_command_is_small() {
    let lines = ratchet::command_lines(&SOURCE, &source::files());
    println!("{lines} lines of code in src/cli");
    assert!(
        lines <= ratchet::COMMAND_LINES,
        "{lines}: what can be of use without the command belongs into the library"
    );
}

/// What we want less of: whoever takes one away lowers the figure in `ratchet.rs`.
#[test]
fn what_is_private_to_this_code_only_becomes_less() {
    for (what, most, found) in [
        ("local closures with a name", ratchet::CLOSURES, ratchet::closures(&SOURCE)),
        ("closures called `of`", ratchet::CLOSURES_OF, ratchet::closures_called_of(&SOURCE)),
        ("names of several public types", ratchet::SHARED_NAMES, ratchet::shared_names(&SOURCE).len()),
    ] {
        println!("{what}: {found}");
        assert!(found <= most, "{what}: {found}, at most {most}");
    }
}

#[test]
fn every_code_is_explained_and_every_explained_code_is_used() {
    let used = rules::codes(&SOURCE);
    let explained: BTreeSet<_> = explanations().iter().map(|e| e.code.clone()).collect();
    let missing: Vec<_> = used.difference(&explained).collect();
    let idle: Vec<_> = explained.difference(&used).collect();
    assert!(missing.is_empty(), "codes without an explanation: {missing:?}");
    assert!(idle.is_empty(), "explanations of codes that nothing gives: {idle:?}");
}
