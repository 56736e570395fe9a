//! The engine of the page that is dropped on. It has the files that the page puts into its memory, does what `kesf check`,
//! `kesf run` and `kesf export` do with them, and gives back texts (JSON) and bytes. Elsewhere than in a browser there is
//! nothing of it.
#![cfg(any(clippy, all(target_family = "wasm", target_os = "unknown")))]

mod files;
mod said;
mod work;

use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// Takes what happens: a kind of event and its text, `started` with a number of steps behind it.
    #[wasm_bindgen(js_name = tell)]
    fn tell(kind: &str, text: &str, steps: usize);
}

/// Makes a defect of the program say what it is before it ends the worker.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|info| tell("defect", &info.to_string(), 0)));
}

/// Version of the program.
#[wasm_bindgen]
#[must_use]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").into()
}

/// Forgets all files.
#[wasm_bindgen]
pub fn clear() {
    files::clear();
}

/// Takes a file by its path as it was dropped. Files without a folder are put into the folder `loose`; an archive is
/// unpacked.
#[wasm_bindgen]
pub fn put(path: &str, bytes: Vec<u8>, loose: &str) {
    files::put(path, bytes, loose);
}

/// Takes the example in place of what is dropped.
#[wasm_bindgen]
pub fn put_example() {
    files::put_example();
}

/// What `kesf check -v` says of the files, as JSON. `options` is the JSON of the form.
#[wasm_bindgen]
#[must_use]
pub fn check(options: &str) -> String {
    work::answer(work::check(options))
}

/// What `kesf run` makes of the files; the names of the results as JSON. With `fabrics_only`, without any case; with
/// `drapes`, with quick drapes, which take long.
#[wasm_bindgen]
#[must_use]
pub fn run(options: &str, fabrics_only: bool, drapes: bool) -> String {
    work::answer(work::run(options, fabrics_only, drapes))
}

/// Adds the cards of `kesf export` for every program to the results; their names as JSON.
#[wasm_bindgen]
#[must_use]
pub fn cards(options: &str) -> String {
    work::answer(work::cards(options))
}

/// A file of the results; empty if there is none of the name.
#[wasm_bindgen]
#[must_use]
pub fn read(name: &str) -> Vec<u8> {
    work::read(name)
}

/// All results as one archive.
///
/// # Errors
/// The text of one for an archive that cannot be made.
#[wasm_bindgen]
pub fn archive() -> Result<Vec<u8>, String> {
    work::archive()
}
