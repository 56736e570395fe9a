//! Goal: the book, the README and the examples say what is so.
//!
//! Every command of a `console` block runs and prints what is shown; every page, picture, file of the repository and
//! subcommand that is named is there; the examples run. Each page has a folder of its own with the shipped data.

mod examples;
mod page;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use page::{Block, Page};

fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn markdown_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<PathBuf> = entries
        .flat_map(|path| if path.is_dir() { markdown_below(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect();
    found.sort();
    found
}

fn pages() -> Vec<Page> {
    let own = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"].map(root);
    own.into_iter().chain(markdown_below(&root("docs/src"))).map(|path| Page::read(&path)).collect()
}

#[test]
fn the_summary_lists_every_page_and_every_link_leads_somewhere() {
    for page in pages() {
        for link in page.links() {
            assert!(link.exists(), "{}: {} is not there", page.path.display(), link.display());
        }
    }
    let summary = Page::read(&root("docs/src/SUMMARY.md"));
    let listed: BTreeSet<PathBuf> = summary.links().into_iter().collect();
    let missing: Vec<PathBuf> = markdown_below(&root("docs/src"))
        .into_iter()
        .filter(|path| *path != summary.path && !listed.contains(path))
        .collect();
    assert!(missing.is_empty(), "in no line of SUMMARY.md: {missing:?}");
}

/// What stands in backticks and begins like a path of the repository is one.
#[test]
fn every_file_that_is_named_exists() {
    for page in pages() {
        for name in page.files_named() {
            assert!(root(&name).exists(), "{}: `{name}` is not there", page.path.display());
        }
    }
}

#[test]
fn every_command_that_is_named_exists() {
    let commands = page::subcommands();
    for page in pages() {
        for (line, word) in page.commands_named() {
            assert!(commands.contains(&word), "{}: no command `{word}` in `{line}`", page.path.display());
        }
    }
}

#[test]
fn every_command_prints_what_is_shown() {
    let mut shown = 0;
    for page in pages() {
        let folder = page::workplace();
        for block in page.blocks() {
            match block {
                Block::File { name, text } => fs::write(folder.path().join(name), text).unwrap(),
                Block::Console(lines) => shown += page::replay(&page.path, &lines, folder.path()),
                Block::Other => (),
            }
        }
    }
    assert!(shown >= 20, "only {shown} commands are shown");
}

#[test]
fn the_readme_is_short_and_has_the_two_commands() {
    let text = Page::read(&root("README.md")).text;
    assert!(text.split_whitespace().count() <= 1200);
    for command in ["cargo run --release -- run", "cargo test --release"] {
        assert!(text.contains(&format!("```sh\n{command}\n```")), "{command}");
    }
}

#[test]
fn a_source_is_cited_by_its_authors() {
    let sources = text_files_below(&root("src")).into_iter().map(|path| Page::read(&path));
    for page in pages().into_iter().chain(sources) {
        // Comments break where their lines end.
        let words = page.text.split(['/', '!', '#', '*', ' ', '\n']).filter(|word| !word.is_empty());
        let text = words.collect::<Vec<_>>().join(" ").to_lowercase();
        for private in
            ["as the seed ", "seed's", "seed paper", "the seed allows", "the seed puts", "the seed does"]
        {
            assert!(!text.contains(private), "{}: {private}", page.path.display());
        }
    }
}

/// Code, texts and data of the program.
fn text_files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let is_text =
        |path: &PathBuf| path.extension().is_some_and(|e| ["rs", "md", "toml"].iter().any(|t| e == *t));
    entries
        .flat_map(|path| if path.is_dir() { text_files_below(&path) } else { vec![path] })
        .filter(is_text)
        .collect()
}

/// The checks above can fail.
#[test]
fn what_is_not_so_is_seen() {
    let wrong = Page {
        path: root("README.md"),
        text: "[a](docs/none.md) `src/none.rs`\n\n```sh\nkesf dance\n```\n".into(),
    };
    assert!(!wrong.links()[0].exists());
    assert_eq!(wrong.files_named(), ["src/none.rs"]);
    assert!(!page::subcommands().contains(&wrong.commands_named()[0].1));
    assert!(page::is_like(&["a", "...", "d"], &["a", "b", "c", "d"]));
    assert!(!page::is_like(&["a", "...", "d"], &["a", "b", "c"]));
    assert!(!page::is_like(&["a"], &["a", "b"]));
    assert!(!page::is_like(&["a", "b"], &["a", "c"]));
}
