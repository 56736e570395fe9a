//! What a workbook may claim before a reader believes it.
//!
//! The readers of .xlsx and .xls trust the file: an archive may unpack to a thousand times its size,
//! and a declared dimension makes them reserve memory for cells that are not there, which ends the
//! program. Both are looked at here first, so that a damaged file costs that file only.

use std::collections::BTreeSet;
use std::io::{Cursor, Read};

use super::error::{ReadProblem, bad_workbook as bad};

/// More cells than any workbook of measurements has.
pub(super) const CELLS: usize = 4_000_000;
/// Bytes that an archive may unpack to.
const UNPACKED: u64 = 128 << 20;
/// The most that deflate packs (zlib, technical details).
const DEFLATE: u64 = 1032;
/// Rows of a sheet of .xls.
const XLS_ROWS: u32 = 65_536;
/// Columns of a sheet of .xls.
const XLS_COLUMNS: u32 = 256;

/// The error of a workbook with too many cells.
pub(super) fn too_many_cells() -> ReadProblem {
    bad(format!("its cells span more than {CELLS} places; remove stray cells far from the table"))
}

/// Refuses an archive that unpacks to too much. Declared sizes can lie, so the entries of a large
/// one are unpacked and counted.
///
/// # Errors
/// `R021`.
pub(super) fn archive(bytes: &[u8]) -> Result<(), ReadProblem> {
    if bytes.len() as u64 * DEFLATE <= UNPACKED {
        return Ok(());
    }
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(bad)?;
    let mut remaining = UNPACKED;
    for i in 0..archive.len() {
        let entry = archive.by_index(i).map_err(bad)?;
        let size = std::io::copy(&mut entry.take(remaining + 1), &mut std::io::sink()).map_err(bad)?;
        let Some(rest) = remaining.checked_sub(size) else {
            return Err(bad(format!("it unpacks to more than {} MB", UNPACKED >> 20)));
        };
        remaining = rest;
    }
    Ok(())
}

/// Records of a sheet of .xls that matter here (MS-XLS 2.3).
mod record {
    pub const EOF: u16 = 0x000a;
    pub const BOUND_SHEET: u16 = 0x0085;
    pub const DIMENSIONS: u16 = 0x0200;
    pub const MUL_RK: u16 = 0x00bd;
    /// Records that begin with row and column of a cell: formula, mulrk, rstring, labelsst, number,
    /// label, boolerr, rk.
    pub const CELL: [u16; 8] = [0x0006, 0x00bd, 0x00d6, 0x00fd, 0x0203, 0x0204, 0x0205, 0x027e];
}

/// The records of a compound document; refuses one whose sheets declare or span more cells than can be meant.
///
/// # Errors
/// `R021`.
pub(super) fn compound(bytes: &[u8]) -> Result<Vec<u8>, ReadProblem> {
    let stream = workbook_stream(bytes)?;
    let mut sheets = vec![0];
    let mut seen = BTreeSet::new();
    let mut cells = 0;
    while let Some(start) = sheets.pop() {
        cells += span(&stream, start, &mut sheets, &mut seen)?;
        if cells > CELLS {
            return Err(too_many_cells());
        }
    }
    Ok(stream)
}

/// The records of an .xls.
fn workbook_stream(bytes: &[u8]) -> Result<Vec<u8>, ReadProblem> {
    let mut file = cfb::CompoundFile::open(Cursor::new(bytes)).map_err(bad)?;
    let name = ["/Workbook", "/Book"].into_iter().find(|n| file.is_stream(n));
    let name = name.ok_or_else(|| bad("it has no stream `Workbook`"))?;
    let mut stream = Vec::new();
    file.open_stream(name).and_then(|mut s| s.read_to_end(&mut stream)).map_err(bad)?;
    Ok(stream)
}

/// A record of an .xls.
pub(super) struct Record<'b> {
    /// Where it begins.
    pub at: usize,
    pub kind: u16,
    pub data: &'b [u8],
}

/// The records from the beginning on, up to one that is cut.
pub(super) fn records(stream: &[u8]) -> impl Iterator<Item = Record<'_>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let head = stream.get(at..at + 4)?;
        let (kind, length) = (short(head, 0) as u16, short(head, 2) as usize);
        let data = stream.get(at + 4..at + 4 + length)?;
        let record = Record { at, kind, data };
        at += 4 + length;
        Some(record)
    })
}

/// Number of places that the cells of a substream span. Offsets of sheets go to `sheets`; a walk
/// ends at records that were `seen` by another.
fn span(
    stream: &[u8],
    start: usize,
    sheets: &mut Vec<usize>,
    seen: &mut BTreeSet<usize>,
) -> Result<usize, ReadProblem> {
    let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
    let (mut at, mut total) = (start, 0);
    while let (Some(head), true) = (stream.get(at..at + 4), seen.insert(at)) {
        let (kind, length) = (short(head, 0) as u16, short(head, 2) as usize);
        let Some(data) = stream.get(at + 4..at + 4 + length) else { break };
        match kind {
            record::BOUND_SHEET => sheets.push((short(data, 0) | short(data, 2) << 16) as usize),
            record::DIMENSIONS if !is_possible(data) => {
                return Err(bad("a sheet declares more rows or columns than the format has"));
            }
            kind if record::CELL.contains(&kind) => {
                let (row, first) = (short(data, 0), short(data, 2));
                // A row of numbers ends with its last column.
                let last = if kind == record::MUL_RK { short(data, length.saturating_sub(2)) } else { first };
                if first.max(last) >= XLS_COLUMNS {
                    return Err(bad("a cell stands in a column that the format does not have"));
                }
                low = [low[0].min(row), low[1].min(first)];
                high = [high[0].max(row), high[1].max(last).max(first)];
            }
            // The walk from the start passes through every sheet: each has its own span.
            record::EOF => {
                total += area(low, high);
                (low, high) = ([u32::MAX; 2], [0; 2]);
            }
            _ => {}
        }
        at += 4 + length;
    }
    Ok(total + area(low, high))
}

/// Two bytes of a record, 0 behind its end.
pub(super) fn short(data: &[u8], i: usize) -> u32 {
    data.get(i..i + 2).map_or(0, |b| u32::from(b[0]) | u32::from(b[1]) << 8)
}

/// Whether the dimensions that a sheet declares exist: first row, last row + 1, first column and
/// last column + 1; rows have two bytes in old files and four in later ones.
fn is_possible(data: &[u8]) -> bool {
    let long = |i| short(data, i) | short(data, i + 2) << 16;
    let (first, end, columns) = match data.len() {
        ..14 => (short(data, 0), short(data, 2), short(data, 6)),
        _ => (long(0), long(4), short(data, 10)),
    };
    end <= XLS_ROWS && columns <= XLS_COLUMNS && (end == 0 || first < end)
}

/// Places in the rectangle from `low` to `high`; none if it was never begun.
fn area(low: [u32; 2], high: [u32; 2]) -> usize {
    if low[0] == u32::MAX { 0 } else { ((high[0] - low[0] + 1) * (high[1] - low[1] + 1)) as usize }
}
