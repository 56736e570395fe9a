//! A page of Markdown: its links, the files and commands that it names, and its blocks.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

/// Folders of the repository; what begins with one of them in backticks is meant to be there.
const FOLDERS: [&str; 9] =
    ["src/", "tests/", "cases/", "examples/", "docs/", "kesf_data/", "benches/", "fuzz/", ".ci/"];

pub struct Page {
    pub path: PathBuf,
    pub text: String,
}

pub enum Block {
    /// A file that the commands below use.
    File {
        name: String,
        text: String,
    },
    /// Commands after `$`, each with what it prints.
    Console(Vec<String>),
    Other,
}

impl Page {
    pub fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        Self { path: path.to_path_buf(), text }
    }

    /// Links and pictures within the repository, and files that are included.
    pub fn links(&self) -> Vec<PathBuf> {
        let prose = self.prose();
        let links = prose.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let included = self.text.split("{{#include ").skip(1).filter_map(|rest| rest.split("}}").next());
        let here = links.filter(|link| !link.contains("://") && !link.starts_with('#'));
        let folder = self.path.parent().unwrap();
        here.chain(included).map(|link| folder.join(link.split('#').next().unwrap())).map(plain).collect()
    }

    pub fn files_named(&self) -> Vec<String> {
        let prose = self.prose();
        let spans = prose.split('`').skip(1).step_by(2);
        let files = spans.filter(|span| FOLDERS.iter().any(|folder| span.starts_with(folder)));
        files.filter(|span| !span.contains(['*', '<', ' ', '{'])).map(str::to_string).collect()
    }

    /// Lines of shell blocks that call the program, with the subcommand.
    pub fn commands_named(&self) -> Vec<(String, String)> {
        let blocks = self.fenced().into_iter();
        let lines = blocks.flat_map(|(info, lines)| lines.into_iter().filter(move |l| is_command(&info, l)));
        lines.filter_map(|line| subcommand(&line).map(|word| (line.clone(), word))).collect()
    }

    pub fn blocks(&self) -> Vec<Block> {
        let block = |(info, lines): (String, Vec<String>)| match info.split_once("file=") {
            Some((_, name)) => Block::File { name: name.into(), text: lines.join("\n") + "\n" },
            None if info == "console" => Block::Console(lines),
            None => Block::Other,
        };
        self.fenced().into_iter().map(block).collect()
    }

    /// Fenced blocks: what stands after the fence, and the lines.
    fn fenced(&self) -> Vec<(String, Vec<String>)> {
        let mut parts = self.text.split("\n```");
        let mut blocks = Vec::new();
        parts.next();
        while let Some(block) = parts.next() {
            let mut lines = block.lines().map(str::to_string);
            blocks.push((lines.next().unwrap_or_default(), lines.collect()));
            parts.next();
        }
        blocks
    }

    /// The text without its fenced blocks.
    fn prose(&self) -> String {
        self.text.split("\n```").step_by(2).collect()
    }
}

/// Whether a line of a block is a command and not what one prints.
fn is_command(info: &str, line: &str) -> bool {
    info == "sh" || (info == "console" && line.starts_with("$ "))
}

/// A path without `..`.
fn plain(path: PathBuf) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        if part == std::path::Component::ParentDir {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}

fn subcommand(line: &str) -> Option<String> {
    let line = line.strip_prefix("$ ").unwrap_or(line);
    let after =
        line.strip_prefix("kesf ").or_else(|| line.split_once("cargo run --release -- ").map(|x| x.1))?;
    let word = after.split_whitespace().find(|word| !word.starts_with('-'))?;
    Some(word.to_string())
}

fn kesf() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kesf"));
    command.env("NO_COLOR", "1").env_remove("KESF_SKIPPED");
    command
}

/// The subcommands that `kesf help` lists.
pub fn subcommands() -> BTreeSet<String> {
    let help = String::from_utf8(kesf().arg("--help").output().unwrap().stdout).unwrap();
    let list = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap().to_string();
    let names = list.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.filter_map(|line| line.split_whitespace().next()).map(str::to_string).collect()
}

/// A folder with the shipped data and cases.
pub fn workplace() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["kesf_data", "cases", "examples"] {
        copy(&crate::root(name), &folder.path().join(name));
    }
    folder
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if from.is_dir() {
            copy(&from, &to);
        } else {
            fs::copy(from, to).unwrap();
        }
    }
}

/// Runs the commands of a block and compares; how many there were.
pub fn replay(page: &Path, lines: &[String], folder: &Path) -> usize {
    let starts: Vec<usize> = (0..lines.len()).filter(|i| lines[*i].starts_with("$ ")).collect();
    for (k, start) in starts.iter().enumerate() {
        let end = starts.get(k + 1).copied().unwrap_or(lines.len());
        let printed = print(&lines[*start][2..], folder);
        let printed: Vec<&str> = printed.lines().map(str::trim_end).collect();
        let shown: Vec<&str> = lines[start + 1..end].iter().map(|line| line.trim_end()).collect();
        assert!(
            is_like(&shown, &printed),
            "{}: {} prints\n{}\n\nshown:\n{}",
            page.display(),
            lines[*start],
            printed.join("\n"),
            shown.join("\n")
        );
    }
    starts.len()
}

/// What a command prints: standard output, then standard error. `ls` and `cat` are done here.
fn print(command: &str, folder: &Path) -> String {
    // What stands in quotes is one word.
    let parts = command.split('"').enumerate();
    let words: Vec<&str> = parts
        .flat_map(|(k, part)| if k % 2 == 1 { vec![part] } else { part.split_whitespace().collect() })
        .collect();
    match words[..] {
        ["kesf", ref arguments @ ..] => {
            let output = kesf().args(arguments).current_dir(folder).output().unwrap();
            let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
            text.concat()
        }
        ["ls", name] => {
            let entries = fs::read_dir(folder.join(name)).unwrap().map(|e| e.unwrap().file_name());
            let names: BTreeSet<String> = entries.map(|n| n.into_string().unwrap()).collect();
            names.into_iter().filter(|n| !n.starts_with('.')).map(|n| n + "\n").collect()
        }
        ["cat", name] => fs::read_to_string(folder.join(name)).unwrap(),
        _ => panic!("only kesf, ls and cat can be shown: {command}"),
    }
}

/// Whether lines are as shown; a line `...` stands for any number of them.
pub fn is_like(shown: &[&str], printed: &[&str]) -> bool {
    match shown {
        [] => printed.is_empty(),
        ["...", rest @ ..] => (0..=printed.len()).any(|n| is_like(rest, &printed[n..])),
        [line, rest @ ..] => printed.first() == Some(line) && is_like(rest, &printed[1..]),
    }
}
