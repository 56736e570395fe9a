//! The marks of an .xls: its records of formats, fonts, rows and columns (MS-XLS 2.4).

use std::collections::BTreeMap;
use std::rc::Rc;

use super::Marks;
use crate::instrument::limits::{Record, records, short};
use crate::instrument::number_format::Shown;

const BOUND_SHEET: u16 = 0x0085;
const BOF: u16 = 0x0809;
const FONT: u16 = 0x0031;
const FORMAT: u16 = 0x041e;
const XF: u16 = 0x00e0;
const ROW: u16 = 0x0208;
const COLUMNS: u16 = 0x007d;
const NUMBERS: [u16; 3] = [0x0203, 0x027e, 0x0006];
const TEXTS: [u16; 2] = [0x00fd, 0x0204];
const SEVERAL_NUMBERS: u16 = 0x00bd;

/// A format of cells: font and number format.
type CellFormat = (u32, u32);

/// What holds for all sheets.
#[derive(Default)]
struct Book {
    /// Where each sheet begins, and its name.
    names: BTreeMap<usize, String>,
    formats: BTreeMap<u32, Rc<Shown>>,
    struck_out: Vec<bool>,
    cells: Vec<CellFormat>,
}

/// The marks of the sheets by name, from the records of the workbook.
pub(in crate::instrument) fn marks(stream: &[u8]) -> BTreeMap<String, Marks> {
    let mut book = Book::default();
    for (id, percent) in [(9, "0%"), (10, "0.00%")] {
        book.formats.insert(id, Rc::new(Shown::of(percent)));
    }
    let mut out: BTreeMap<String, Marks> = BTreeMap::new();
    let mut sheet: Option<String> = None;
    for record in records(stream) {
        if record.kind == BOF {
            sheet = book.names.get(&record.at).cloned();
        }
        match &sheet {
            None => book.take(&record),
            Some(name) => take(&book, &record, out.entry(name.clone()).or_default()),
        }
    }
    out
}

/// The text of a string behind its length: of two bytes a character or one, as its flag says.
fn text(data: &[u8], count: usize) -> String {
    let Some((flag, body)) = data.split_first() else { return String::new() };
    if flag & 1 == 0 {
        return body.iter().take(count).map(|b| char::from(*b)).collect();
    }
    let units: Vec<u16> =
        body.chunks_exact(2).take(count).map(|b| u16::from_le_bytes([b[0], b[1]])).collect();
    String::from_utf16_lossy(&units)
}

impl Book {
    fn take(&mut self, record: &Record<'_>) {
        let data = record.data;
        match record.kind {
            BOUND_SHEET if data.len() > 7 => {
                let at = (short(data, 0) | short(data, 2) << 16) as usize;
                self.names.insert(at, text(&data[7..], usize::from(data[6])));
            }
            FORMAT if data.len() > 4 => {
                let code = text(&data[4..], short(data, 2) as usize);
                self.formats.insert(short(data, 0), Rc::new(Shown::of(&code)));
            }
            FONT => {
                self.struck_out.push(short(data, 2) & 0x0008 != 0);
                // The format counts a fifth font that is not there.
                if self.struck_out.len() == 4 {
                    self.struck_out.push(false);
                }
            }
            XF => self.cells.push((short(data, 0), short(data, 2))),
            _ => {}
        }
    }

    /// What the format of a cell says of it.
    fn mark(&self, at: (u32, u32), format: u32, marks: &mut Marks) {
        let Some((font, number)) = self.cells.get(format as usize) else { return };
        if self.struck_out.get(*font as usize).is_some_and(|struck| *struck) {
            marks.struck_out.insert(at);
        }
        if let Some(shown) = self.formats.get(number).filter(|shown| !shown.is_plain()) {
            marks.shown.insert(at, Rc::clone(shown));
        }
    }
}

fn take(book: &Book, record: &Record<'_>, marks: &mut Marks) {
    let data = record.data;
    let (row, column) = (short(data, 0), short(data, 2));
    match record.kind {
        kind if NUMBERS.contains(&kind) || TEXTS.contains(&kind) => {
            book.mark((row, column), short(data, 4), marks);
        }
        SEVERAL_NUMBERS => {
            for (i, of) in data.get(4..).unwrap_or_default().chunks_exact(6).enumerate() {
                book.mark((row, column + i as u32), short(of, 0), marks);
            }
        }
        ROW if short(data, 12) & 0x0020 != 0 => {
            marks.hidden_rows.insert(row);
        }
        COLUMNS if short(data, 8) & 1 != 0 => marks.hidden_columns.extend(row..=column.min(255)),
        _ => {}
    }
}
