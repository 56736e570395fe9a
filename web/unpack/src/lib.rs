//! Unpacks the engine of the page: browsers unpack gzip for scripts, and LZMA takes a quarter less.
#![cfg(any(clippy, all(target_family = "wasm", target_os = "unknown")))]

use std::io::Read;

use lzma_rust2::LzmaReader;
use wasm_bindgen::prelude::wasm_bindgen;

/// The bytes of a packed file (`.lzma`).
///
/// # Errors
/// The text of one for bytes that are damaged.
#[wasm_bindgen]
pub fn unpack(packed: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    LzmaReader::new_mem_limit(packed, u32::MAX, None)
        .and_then(|mut reader| reader.read_to_end(&mut bytes))
        .map_err(|e| e.to_string())?;
    Ok(bytes)
}
