//! Unpacks the engine of the page: browsers unpack gzip for scripts, and brotli takes a quarter less.
#![cfg(all(target_family = "wasm", target_os = "unknown"))]

use wasm_bindgen::prelude::wasm_bindgen;

/// The bytes behind brotli.
///
/// # Errors
/// The text of one for bytes that are damaged.
#[wasm_bindgen]
pub fn unpack(packed: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    brotli_decompressor::BrotliDecompress(&mut &*packed, &mut bytes).map_err(|e| e.to_string())?;
    Ok(bytes)
}
