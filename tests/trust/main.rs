//! The command under hostile conditions: folders that are inputs and outputs at once, names that are formulas, links
//! that lead nowhere, cases without an end, kills, full disks and closed pipes.
//!
//! Kind: own. Nothing here is a number of mechanics: what is held is that files are whole, that what was not
//! understood is told, and that every computation ends.

#[path = "../common/mod.rs"]
mod common;
mod factors;
mod folders;
mod limits;
#[cfg(target_os = "linux")]
#[allow(dead_code, reason = "the bench of the same runs uses the rest")]
#[path = "../common/many.rs"]
mod many;
mod memory;
mod names;
mod resume;
mod same;
mod sizes;
mod told;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// The command, with nothing on standard input.
fn kesf() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kesf"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).env_remove("NO_COLOR").stdin(Stdio::null());
    command
}

fn run(arguments: &[&str]) -> Output {
    kesf().args(arguments).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

/// A result table with bending of some fabrics.
fn table(names: &[&str]) -> String {
    let mut text = "fabric,B warp (gf·cm²/cm),B weft (gf·cm²/cm),W (mg/cm²)\n".to_string();
    for name in names {
        text += &format!("{name},0.1,0.05,10\n");
    }
    text
}

/// First cells of the rows below the heading of a table, each once.
fn first_cells(path: &Path) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new().from_path(path).unwrap();
    let mut names: Vec<String> = reader.records().map(|row| row.unwrap()[0].to_string()).collect();
    names.dedup();
    names
}

/// Every file below a folder, hidden ones included, by its name with `/`.
fn tree(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(root).unwrap().to_string_lossy().into_owned();
                files.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    files
}
