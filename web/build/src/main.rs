//! Makes the page that is dropped on: `cargo run -p kesf-web-build [-- FILE]`.
//!
//! It compiles `kesf-web` to WebAssembly and puts everything into one HTML file: engine (LZMA, base64) and what unpacks
//! it (gzip, base64), script, worker and style. One file opens from a disk as from a server, asks for nothing once it is there, and can be sent; and its
//! policy can name the scripts that may run by their hashes, and forbid every request.

use std::error::Error;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use lzma_rust2::{LzmaOptions, LzmaWriter};
use sha2::{Digest, Sha256};
use wasm_bindgen_cli_support::Bindgen;

const TARGET: &str = "wasm32-unknown-unknown";
/// Bytes that the page may have as a server sends it.
const LIMIT: usize = 2_000_000;
/// Bytes of the stack: the default of 1 MB is little for solvers that call themselves.
const STACK: &str = "-C link-arg=-zstack-size=8388608";

const PAGE: &str = include_str!("../../page/index.html");
const STYLE: &str = include_str!("../../page/style.css");
const SCRIPT: &str = include_str!("../../page/page.js");
const WORKER: &str = include_str!("../../page/worker.js");
/// Those of the report, which is shown in a frame and has the policy of the page beside its own.
const REPORT_STYLE: &str = include_str!("../../../src/report/page.css");
const REPORT_SCRIPT: &str = concat!(
    include_str!("../../../src/report/page.js"),
    include_str!("../../../src/report/page_fabrics.js"),
    include_str!("../../../src/report/page_curves.js"),
    include_str!("../../../src/report/page_correlation.js"),
    include_str!("../../../src/report/page_3d.js"),
    include_str!("../../../src/report/page_print.js")
);

fn main() -> Result<(), Box<dyn Error>> {
    let root =
        Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).ok_or("this crate is not in web/build")?;
    let out = env::args_os().nth(1).map_or_else(|| root.join("target/web/kesf.html"), PathBuf::from);
    let compiled = compiled(root)?;
    let engine = bound(&compiled, "kesf_web")?;
    let page = page(&engine, &bound(&compiled, "kesf_web_unpack")?)?;
    let sent = gzip(page.as_bytes())?.len();
    if let Some(folder) = out.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(&out, &page)?;
    println!(
        "{}: {} bytes, {sent} as a server sends it (gzip); WebAssembly {} bytes",
        out.display(),
        page.len(),
        engine.wasm.len()
    );
    if sent > LIMIT { Err(format!("the page may have {LIMIT} bytes").into()) } else { Ok(()) }
}

/// A part that is compiled: the script that speaks with it, and its code.
struct Part {
    glue: String,
    wasm: Vec<u8>,
}

/// The folder of what the compiler gives.
fn compiled(root: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .current_dir(root)
        .args([
            "build",
            "--locked",
            "--profile",
            "web",
            "-p",
            "kesf-web",
            "-p",
            "kesf-web-unpack",
            "--target",
            TARGET,
        ])
        .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", STACK)
        .status()?;
    if !status.success() {
        return Err(format!(
            "kesf-web does not compile; `rustup target add {TARGET}` if the target is missing"
        )
        .into());
    }
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    Ok(target.join(TARGET).join("web"))
}

/// A part with its script, whose one global name is that of the part.
fn bound(folder: &Path, name: &str) -> Result<Part, Box<dyn Error>> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(folder.join(format!("{name}.wasm"))).no_modules(true)?.no_modules_global(name)?;
    bindgen.typescript(false).remove_name_section(true).remove_producers_section(true);
    let mut output = bindgen.generate_output()?;
    Ok(Part { glue: output.js().to_string(), wasm: output.wasm_mut().emit_wasm() })
}

fn page(engine: &Part, unpack: &Part) -> Result<String, Box<dyn Error>> {
    let worker = format!("{}\n{}\n{WORKER}", engine.glue, unpack.glue);
    for script in [SCRIPT, &worker] {
        if script.contains("</script") || script.contains("<!--") {
            return Err("a script must not hold what ends it in a page".into());
        }
    }
    let packed = STANDARD.encode(lzma(&engine.wasm)?);
    let unpack = STANDARD.encode(gzip(&unpack.wasm)?);
    let parts = [
        ("{{policy}}", policy().as_str()),
        ("{{style}}", STYLE),
        ("{{script}}", SCRIPT),
        ("{{worker}}", &worker),
        ("{{engine}}", &packed),
        ("{{unpack}}", &unpack),
    ]
    .map(|(place, part)| (place, part.to_string()));
    // Each place once, from the front: what is put in is not looked at again.
    let (mut page, mut rest) = (String::new(), PAGE);
    while let Some((before, behind)) = rest.split_once("{{") {
        let name = behind.split_once("}}").ok_or("a place has no end")?.0;
        let part =
            parts.iter().find(|(place, _)| *place == format!("{{{{{name}}}}}")).ok_or("an unknown place")?;
        page.push_str(before);
        page.push_str(&part.1);
        rest = &behind[name.len() + 2..];
    }
    page.push_str(rest);
    Ok(page)
}

/// The scripts and styles of the page and of the report, the engine, a worker and a frame that the page makes itself;
/// no request to anywhere.
fn policy() -> String {
    let hash = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text.as_bytes())));
    format!(
        "default-src 'none'; script-src {} {} 'wasm-unsafe-eval'; style-src {} {}; img-src data:; worker-src blob:; \
         frame-src blob:; base-uri 'none'; form-action 'none'",
        hash(SCRIPT),
        hash(REPORT_SCRIPT),
        hash(STYLE),
        hash(REPORT_STYLE)
    )
}

/// The densest settings that were tried: code of WebAssembly is not aligned, and its bytes depend on the one before.
fn lzma(bytes: &[u8]) -> Result<Vec<u8>, std::io::Error> {
    let options =
        LzmaOptions { lc: 4, pb: 0, nice_len: LzmaOptions::NICE_LEN_MAX, ..LzmaOptions::with_preset(9) };
    let mut writer = LzmaWriter::new_use_header(Vec::new(), &options, Some(bytes.len() as u64))?;
    writer.write_all(bytes)?;
    writer.finish()
}

fn gzip(bytes: &[u8]) -> Result<Vec<u8>, std::io::Error> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}
