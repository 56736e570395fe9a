//! Lists the files that the page brings with it: the example, and the cases that a browser can solve.

use std::env;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Two fabrics: all raw curves of one, a published table of another.
const EXAMPLE: [&str; 2] = ["kesf_data/poplin", "kesf_data/petrak_m1"];

/// Linear cases, simulated tests, the cantilever and the drape, which is made quick.
const CASES: [&str; 9] = [
    "cantilever",
    "cantilever_strip",
    "drape",
    "seed_clamped",
    "seed_simply_supported",
    "virtual_bending",
    "virtual_compression",
    "virtual_shear",
    "virtual_tensile",
];

fn main() -> Result<(), Box<dyn Error>> {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?).join("..");
    let mut example = Vec::new();
    for folder in EXAMPLE {
        println!("cargo::rerun-if-changed=../{folder}");
        let mut names: Vec<_> = fs::read_dir(root.join(folder))?
            .map(|entry| Ok::<_, std::io::Error>(entry?.file_name()))
            .collect::<Result<_, _>>()?;
        names.sort();
        example.extend(names.iter().map(|name| format!("{folder}/{}", name.to_string_lossy())));
    }
    let cases: Vec<String> = CASES.iter().map(|name| format!("cases/{name}.toml")).collect();
    let mut text = String::new();
    list(&mut text, "EXAMPLE", &example, &root)?;
    list(&mut text, "CASES", &cases, &root)?;
    fs::write(Path::new(&env::var("OUT_DIR")?).join("files.rs"), text)?;
    println!("cargo::rerun-if-changed=build.rs");
    Ok(())
}

fn list(text: &mut String, name: &str, files: &[String], root: &Path) -> Result<(), Box<dyn Error>> {
    writeln!(text, "pub const {name}: &[(&str, &[u8])] = &[")?;
    for file in files {
        writeln!(text, "    ({file:?}, include_bytes!({:?})),", root.join(file))?;
    }
    writeln!(text, "];")?;
    Ok(())
}
