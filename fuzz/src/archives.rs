//! Containers whose parts are damaged and packed again: damage that no checksum catches.

use std::io::{Cursor, Read, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::Damage;

/// An archive of files.
///
/// # Panics
/// Never, in memory.
pub fn zipped(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        zip.start_file(name.as_str(), options).expect("a part of an archive");
        zip.write_all(bytes).expect("its bytes");
    }
    zip.finish().expect("an archive").into_inner()
}

/// The files of an archive that is whole.
///
/// # Panics
/// Of a damaged one.
pub fn unzipped(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).expect("an archive");
    let mut files = Vec::new();
    for i in 0..archive.len() {
        let mut part = archive.by_index(i).expect("a part of an archive");
        let (name, mut bytes) = (part.name().expect("its name").into_owned(), Vec::new());
        part.read_to_end(&mut bytes).expect("its bytes");
        files.push((name, bytes));
    }
    files
}

/// Bytes of what an archive unpacks to, and of the archive itself.
pub fn unpacked_size(bytes: &[u8]) -> usize {
    let Ok(mut archive) = ZipArchive::new(Cursor::new(bytes)) else { return bytes.len() };
    let mut size = bytes.len();
    for i in 0..archive.len() {
        size += archive.by_index_raw(i).map_or(0, |part| part.size() as usize);
    }
    size
}

/// A damaged archive, or one with a damaged part.
pub fn damaged_zip(damage: &Damage, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut files = unzipped(damage.seed(seeds));
    let Some(part) = damage.part(files.len()) else { return damage.of(seeds) };
    files[part].1 = damage.to(&files[part].1, b"");
    zipped(&files)
}

/// A damaged compound file (.xls), or one whose workbook is damaged.
///
/// # Panics
/// Of a seed that is none.
pub fn damaged_compound(damage: &Damage, seeds: &[Vec<u8>]) -> Vec<u8> {
    if damage.part(1).is_none() {
        return damage.of(seeds);
    }
    let mut file =
        cfb::CompoundFile::open(Cursor::new(damage.seed(seeds).to_vec())).expect("a compound file");
    let mut book = Vec::new();
    file.open_stream("/Workbook").expect("a workbook").read_to_end(&mut book).expect("its bytes");
    let damaged = damage.to(&book, b"");
    file.create_stream("/Workbook").expect("a workbook").write_all(&damaged).expect("its bytes");
    file.flush().expect("a compound file");
    file.into_inner().into_inner()
}
