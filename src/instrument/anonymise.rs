//! Samples of files that a laboratory can give away: the layout, the headings and the units as they are, the numbers
//! and the names replaced.
//!
//! What is kept: words that a dialect knows, units, the texts of rows that hold no number (headings), and the first
//! cell of a line of two (a key). Everything else is replaced, letter by letter and digit by digit, so that widths,
//! signs, decimal marks and magnitudes stay. The texts that were kept although no dialect knows them are listed:
//! somebody has to look at them before the sample leaves the house.
//!
//! Of workbooks and web pages only the visible cells are in the sample, as text with tabs: their files hold authors,
//! paths, comments, links and hidden cells in more places than anybody can name.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Write};
use std::path::PathBuf;

use encoding_rs::Encoding;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use sha2::{Digest, Sha256};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::error::{ReadError, ReadProblem, bad_workbook as bad};
use super::raw::{self, Row};
use super::sniff::{may_be_number, sniff};
use super::unit_text::{split_unit, unit};
use super::vocabulary::Vocabulary;
use super::workbook::{self, Archive};
use super::{limits, web_page};
use crate::finding::Place;

/// Samples of files in one archive.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bundle {
    /// A zip archive.
    pub bytes: Vec<u8>,
    /// Each file, and the name of a sample of it, which says nothing of the fabric; a workbook has one for each sheet.
    pub names: Vec<(PathBuf, String)>,
    /// Texts that were kept as headings or keys and that no dialect knows.
    pub unknown: BTreeSet<String>,
    /// Files of which no sample can be made.
    pub failures: Vec<ReadError>,
}

/// The samples of files, in their order.
///
/// # Errors
/// `R021` if the archive cannot be written.
pub fn bundle(files: &[(PathBuf, Vec<u8>)]) -> Result<Bundle, ReadError> {
    let mut out = Bundle::default();
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let failed = |e: &dyn std::fmt::Display| ReadError::new(Place::file("bundle"), bad(e));
    for (i, (path, bytes)) in files.iter().enumerate() {
        let mut replacing = Replacing::new(bytes);
        let samples = match replacing.file(bytes) {
            Ok(samples) => samples,
            Err((line, column, problem)) => {
                out.failures.push(ReadError::new(Place::at(path, line, column), problem));
                continue;
            }
        };
        let stem = known_words(&path.file_stem().unwrap_or_default().to_string_lossy());
        let ending = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
        for (k, Sample { sheet, is_grid, bytes }) in samples.into_iter().enumerate() {
            let part = if is_grid { format!("{:03}-{}", i + 1, k + 1) } else { format!("{:03}", i + 1) };
            let words: Vec<&str> =
                [part.as_str(), &stem, &sheet].into_iter().filter(|w| !w.is_empty()).collect();
            let name = format!("{}.{}", words.join("_"), if is_grid { "tsv" } else { &ending });
            archive.start_file(&name, SimpleFileOptions::default()).map_err(|e| failed(&e))?;
            archive.write_all(&bytes).map_err(|e| failed(&e))?;
            out.names.push((path.clone(), name));
        }
        out.unknown.extend(replacing.unknown);
    }
    out.bytes = archive.finish().map_err(|e| failed(&e))?.into_inner();
    Ok(out)
}

/// A file of the archive.
struct Sample {
    /// Known words in the name of its sheet.
    sheet: String,
    /// Whether it is cells with tabs between them, and not a file of the original's kind.
    is_grid: bool,
    bytes: Vec<u8>,
}

/// What becomes of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// It stays.
    Layout,
    /// Its digits are replaced.
    Number,
    /// Its letters and digits are replaced.
    Name,
}

type Failed = (usize, usize, ReadProblem);

struct Replacing {
    rng: Pcg64,
    unknown: BTreeSet<String>,
    /// The replacement of each name: equal names stay equal.
    names: BTreeMap<String, String>,
}

impl Replacing {
    /// Digits follow from the whole content, which nobody else has.
    fn new(bytes: &[u8]) -> Self {
        let hash = Sha256::digest(bytes);
        let seed = hash.iter().take(8).fold(0, |seed: u64, byte| (seed << 8) | u64::from(*byte));
        Self { rng: Pcg64::seed_from_u64(seed), unknown: BTreeSet::new(), names: BTreeMap::new() }
    }

    fn file(&mut self, bytes: &[u8]) -> Result<Vec<Sample>, Failed> {
        let whole = |problem| (0, 0, problem);
        if workbook::is_workbook(bytes) {
            return match workbook::archive(bytes) {
                Some(Archive::Files) => Err(whole(bad("it is an archive of files: unpack it first"))),
                kind => self.workbook(bytes, kind.is_some()).map_err(whole),
            };
        }
        let raw::Text { text, encoding, .. } = raw::decode(bytes, None)?;
        if web_page::is_page(&text) {
            let rows = web_page::rows(&text).map_err(whole)?;
            return Ok(vec![self.grid("", &rows, workbook::mark(&rows))]);
        }
        let sample = if text.trim_start().starts_with('{') {
            self.json(&text).map_err(whole)?
        } else {
            self.text(&text)
        };
        let bytes = encoded(&sample, encoding, bytes);
        Ok(vec![Sample { sheet: String::new(), is_grid: false, bytes }])
    }

    fn workbook(&mut self, bytes: &[u8], is_zip: bool) -> Result<Vec<Sample>, ReadProblem> {
        if is_zip {
            limits::archive(bytes)?
        } else {
            limits::compound(bytes)?;
        }
        let book = workbook::sheets(bytes, None)?;
        Ok(book.sheets.iter().map(|sheet| self.grid(&sheet.name, &sheet.rows, book.decimal)).collect())
    }

    /// Rows as text with tabs, each cell in its column.
    fn grid(&mut self, sheet: &str, rows: &[Row<'_>], decimal: char) -> Sample {
        let mut text = String::new();
        for row in rows {
            let flat: Vec<String> =
                row.cells.iter().map(|c| c.text.replace(['\t', '\r', '\n'], " ")).collect();
            let cells: Vec<&str> = flat.iter().map(String::as_str).collect();
            let parts = parts(&cells, decimal);
            let cells = cells.iter().zip(parts).map(|(cell, part)| self.cell(cell, part));
            text += &cells.collect::<Vec<_>>().join("\t");
            text.push('\n');
        }
        Sample { sheet: known_words(sheet), is_grid: true, bytes: text.into_bytes() }
    }

    fn text(&mut self, text: &str) -> String {
        let format = sniff(text, None, None).ok().map(|s| s.format);
        let (delimiter, decimal) = format.map_or(('\t', '.'), |f| (f.delimiter, f.decimal));
        let lines = text.split_inclusive('\n').map(|line| {
            let cells: Vec<&str> = line.split(delimiter).collect();
            let parts = parts(&cells, decimal);
            let cells = cells.iter().zip(parts).map(|(cell, part)| self.cell(cell, part));
            cells.collect::<Vec<_>>().join(&delimiter.to_string())
        });
        lines.collect()
    }

    /// A cell with its blanks and quotes.
    fn cell(&mut self, cell: &str, part: Part) -> String {
        match part {
            Part::Layout => {
                let text = bare(cell);
                if !text.is_empty() && !is_known(text) {
                    self.unknown.insert(text.to_string());
                }
                cell.to_string()
            }
            // The number of a specimen, which is layout too.
            Part::Number if bare(cell).len() == 1 => cell.to_string(),
            Part::Number => cell.chars().map(|c| self.digit(c)).collect(),
            Part::Name => {
                let name = bare(cell);
                let replacement = self.name(name);
                cell.replacen(name, &replacement, 1)
            }
        }
    }

    /// Another digit; zero stays, so that magnitudes do.
    fn digit(&mut self, c: char) -> char {
        match c {
            '1'..='9' => char::from(b'1' + self.rng.random_range(0..9u8)),
            other => other,
        }
    }

    /// Letters become `x`, but for words that are known.
    fn name(&mut self, name: &str) -> String {
        if let Some(known) = self.names.get(name) {
            return known.clone();
        }
        let words = name.split_inclusive(|c: char| !c.is_alphanumeric());
        let replaced: String = words.map(|word| self.word(word)).collect();
        self.names.insert(name.to_string(), replaced.clone());
        replaced
    }

    fn word(&mut self, word: &str) -> String {
        let letters = word.trim_end_matches(|c: char| !c.is_alphanumeric());
        if letters.chars().all(char::is_alphabetic) && !letters.is_empty() && is_known(letters) {
            return word.to_string();
        }
        let replace = |c: char| match c {
            c if c.is_uppercase() => 'X',
            c if c.is_alphabetic() => 'x',
            c => self.digit(c),
        };
        word.chars().map(replace).collect()
    }

    fn json(&mut self, text: &str) -> Result<String, ReadProblem> {
        let mut document: serde_json::Value = serde_json::from_str(text).map_err(bad)?;
        self.json_value(&mut document);
        Ok(document.to_string())
    }

    fn json_value(&mut self, value: &mut serde_json::Value) {
        match value {
            serde_json::Value::Number(n) => {
                let text: String = n.to_string().chars().map(|c| self.digit(c)).collect();
                *value = text.parse::<serde_json::Number>().map_or(serde_json::Value::Null, Into::into);
            }
            serde_json::Value::String(text) => *text = self.name(text),
            serde_json::Value::Array(list) => list.iter_mut().for_each(|v| self.json_value(v)),
            serde_json::Value::Object(map) => map.values_mut().for_each(|v| self.json_value(v)),
            serde_json::Value::Null | serde_json::Value::Bool(_) => {}
        }
    }
}

/// What each cell of a row becomes.
fn parts(cells: &[&str], decimal: char) -> Vec<Part> {
    let is_number = |cell: &&str| is_value(bare(cell), decimal);
    let filled = cells.iter().filter(|c| !bare(c).is_empty()).count();
    let has_number = cells.iter().any(is_number);
    let first = cells.iter().position(|c| !bare(c).is_empty());
    let part = |(i, cell): (usize, &&str)| {
        let text = bare(cell);
        match () {
            () if is_value(text, decimal) => Part::Number,
            () if text.is_empty() || is_known(text) => Part::Layout,
            // A key and what it states.
            () if filled == 2 && first == Some(i) => Part::Layout,
            // Headings; but a code with digits names something.
            () if filled > 2 && !has_number && !text.contains(|c: char| c.is_ascii_digit()) => Part::Layout,
            () => Part::Name,
        }
    };
    cells.iter().enumerate().map(part).collect()
}

/// A number, alone or before a unit or a deviation.
fn is_value(text: &str, decimal: char) -> bool {
    let begins = text.trim_start_matches(['-', '+', '−', '<', '>', '±', '(']);
    begins.starts_with(|c: char| c.is_ascii_digit())
        && (may_be_number(text, decimal)
            || split_unit(text).1.is_some_and(|u| unit(&u).is_ok())
            || text
                .split_whitespace()
                .skip(1)
                .all(|rest| unit(rest).is_ok() || rest.contains(|c: char| c.is_ascii_digit())))
}

/// Without blanks and quotes.
fn bare(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

/// Whether every word of a text is one of a dialect or a unit: a heading, a key, a direction. A name in which such a word
/// stands is none.
fn is_known(text: &str) -> bool {
    let (stem, own) = split_unit(text);
    let vocabulary = Vocabulary::new(&[]);
    if own.is_some_and(|own| unit(&own).is_err()) {
        return false;
    }
    let mut words = stem.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).peekable();
    vocabulary.knows(&stem)
        || unit(text).is_ok()
        || words.peek().is_some() && words.all(|word| vocabulary.knows(word))
}

/// The words of the name of a file or a sheet that are known: they may say test and direction.
fn known_words(name: &str) -> String {
    let is_number = |word: &str| word.len() == 1 && word.starts_with(|c: char| c.is_ascii_digit());
    let words = name.split(|c: char| !c.is_alphanumeric());
    let words = words.filter(|word| !word.is_empty() && (is_number(word) || is_known(word)));
    words.collect::<Vec<_>>().join("_")
}

/// The text in the encoding of the original, with its mark.
fn encoded(text: &str, encoding: &str, original: &[u8]) -> Vec<u8> {
    let wide = |to: fn(u16) -> [u8; 2], mark: u16| {
        std::iter::once(mark).chain(text.encode_utf16()).flat_map(to).collect::<Vec<u8>>()
    };
    match encoding {
        "UTF-16LE" => wide(u16::to_le_bytes, 0xfeff),
        "UTF-16BE" => wide(u16::to_be_bytes, 0xfeff),
        _ => {
            let body = Encoding::for_label(encoding.as_bytes()).map(|e| e.encode(text).0.into_owned());
            let mark: &[u8] = if original.starts_with(b"\xef\xbb\xbf") { b"\xef\xbb\xbf" } else { b"" };
            [mark, &body.unwrap_or_else(|| text.as_bytes().to_vec())].concat()
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;
    use std::path::Path;

    use zip::ZipArchive;

    use super::*;
    use crate::instrument::{FileContent, ReadSettings, parse};

    const FILE: &str = "Sample;Müller \"Secret\" 4711\nOperator;Ana Silva\ndirection;warp\nDrum setting;2,5 1/cm\n\n\
        curvature (1/cm);moment (gf·cm/cm);Humidity\n0,00;0,000;65,1\n1,25;0,081;65,2\n-2,50;-0,162;65,3\n";

    fn read(name: &str, bytes: &[u8]) -> FileContent {
        parse(Path::new(name), bytes, &ReadSettings::default()).unwrap()
    }

    #[test]
    fn numbers_and_names_are_replaced_and_the_layout_stays() {
        let latin = encoding_rs::WINDOWS_1252.encode(FILE).0.into_owned();
        let bundle = bundle(&[("Müller_warp_FB2_1.csv".into(), latin.clone())]).unwrap();
        assert_eq!(bundle.failures, []);
        assert_eq!(bundle.names[0].1, "001_warp_FB2_1.csv");
        let mut archive = ZipArchive::new(Cursor::new(bundle.bytes)).unwrap();
        let mut sample = Vec::new();
        archive.by_index(0).unwrap().read_to_end(&mut sample).unwrap();
        let text = encoding_rs::WINDOWS_1252.decode(&sample).0.into_owned();
        for secret in ["ller", "ecret", "4711", "Ana", "Silva", "0,081", "65,1"] {
            assert!(!text.contains(secret), "{secret}: {text}");
        }
        assert_eq!(text.lines().count(), FILE.lines().count());
        for kept in ["direction;warp", "curvature (1/cm);moment (gf·cm/cm);Humidity", "0,00;0,000;"] {
            assert!(text.contains(kept), "{kept}: {text}");
        }
        assert_eq!(bundle.unknown, BTreeSet::from(["Drum setting".to_string()]));
        // What reads the one reads the other, cell by cell.
        let (own, other) = (read("a.csv", &latin), read("a.csv", &sample));
        assert_eq!(own.measurements[0].curve.len(), other.measurements[0].curve.len());
        assert_eq!(own.measurements[0].direction, other.measurements[0].direction);
        assert_ne!(own.measurements[0].curve, other.measurements[0].curve);
    }

    #[test]
    fn a_name_with_a_known_word_in_it_is_a_name() {
        let table = "Sample,B warp (gf·cm²/cm),B weft (gf·cm²/cm)\nCustomer Miller,0.081,0.05\nSample Warp 12,0.09,0.06\n";
        let mut replacing = Replacing::new(table.as_bytes());
        let text = replacing.text(table);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "Sample,B warp (gf·cm²/cm),B weft (gf·cm²/cm)");
        assert!(lines[1].starts_with("Customer Xxxxxx,0.0"), "{text}");
        assert!(!text.contains("12") && replacing.unknown.is_empty(), "{text}");
    }

    #[test]
    fn a_workbook_gives_its_visible_cells_and_a_fab_file_its_tree() {
        let mut book = rust_xlsxwriter::Workbook::new();
        book.set_properties(&rust_xlsxwriter::DocProperties::new().set_author("Müller"));
        let sheet = book.add_worksheet().set_name("Müller warp").unwrap();
        for (i, text) in ["Sample", "B warp (gf·cm²/cm)", "B weft (gf·cm²/cm)"].iter().enumerate() {
            sheet.write_string(0, i as u16, *text).unwrap();
        }
        sheet.write_string(1, 0, "Müller 7").unwrap();
        sheet.write_number(1, 1, 0.0814).unwrap().write_number(1, 2, 0.0523).unwrap();
        let bytes = book.save_to_buffer().unwrap();
        let fab = r#"{"raw_data": {"M": "105.6", "L": {"S1": {"length": 2.08, "width": 5, "samplesTree": [[1.9, 0.1, 2.0, 5.5]]}}},
            "custom": {"browzwear": {"name": "Secret"}}}"#;
        let bundle = bundle(&[("x.xlsx".into(), bytes), ("y.u3m".into(), fab.into())]).unwrap();
        assert_eq!(bundle.failures, []);
        let names: Vec<&str> = bundle.names.iter().map(|(_, name)| name.as_str()).collect();
        assert_eq!(names, ["001-1_warp.tsv", "002.u3m"]);
        let mut archive = ZipArchive::new(Cursor::new(bundle.bytes)).unwrap();
        let mut samples = [String::new(), String::new()];
        for (i, sample) in samples.iter_mut().enumerate() {
            archive.by_index(i).unwrap().read_to_string(sample).unwrap();
        }
        assert!(samples.iter().all(|s| !s.contains("ller") && !s.contains("Secret")), "{samples:?}");
        let content = read("x.tsv", samples[0].as_bytes());
        assert_eq!(content.results.len(), 2, "{}", samples[0]);
        let (_, b) = &content.results[0];
        assert!((0.01..0.1).contains(&(b.mean / b.parameter.kes_factor())));
        assert_eq!(read("y.u3m", samples[1].as_bytes()).fab.unwrap().tests.len(), 1);
    }
}
