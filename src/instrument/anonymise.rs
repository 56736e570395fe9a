//! Samples of files that a laboratory can give away: the layout, the headings and the units as they are, the numbers
//! and the names replaced.
//!
//! What is kept: every word that a dialect knows, units, the texts of rows that hold no number (headings), and the first
//! cell of a line of two (a key). Everything else is replaced, letter by letter and digit by digit, so that widths,
//! signs, decimal marks and magnitudes stay. The texts that were kept although no dialect knows them are listed:
//! somebody has to look at them before the sample leaves the house.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Read, Write};
use std::path::PathBuf;

use encoding_rs::Encoding;
use quick_xml::events::{BytesText, Event};
use quick_xml::{Reader, Writer};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use sha2::{Digest, Sha256};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use super::error::{Problem, ReadError, bad_workbook as bad};
use super::facets::Facets;
use super::raw::{self, Row};
use super::sniff::{Number, number, sniff};
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
    /// Each file, and its name in the archive, which says nothing of the fabric.
    pub names: Vec<(PathBuf, String)>,
    /// Texts that were kept as headings or keys and that no dialect knows.
    pub unknown: BTreeSet<String>,
    /// Files of which no sample can be made.
    pub failures: Vec<ReadError>,
}

/// The samples of files, in their order; names that a dialect knows words of keep these words.
///
/// # Errors
/// `R021` if the archive cannot be written.
pub fn bundle(files: &[(PathBuf, Vec<u8>)]) -> Result<Bundle, ReadError> {
    let mut out = Bundle::default();
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let failed = |e: &dyn std::fmt::Display| ReadError::new(Place::file("bundle"), bad(e));
    for (i, (path, bytes)) in files.iter().enumerate() {
        let mut replacing = Replacing::new(bytes);
        let sample = match replacing.file(bytes) {
            Ok(sample) => sample,
            Err((line, column, problem)) => {
                out.failures.push(ReadError::new(Place::at(path, line, column), problem));
                continue;
            }
        };
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let ending = path.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
        let name = format!("{:03}_{}{ending}", i + 1, replacing.name_of_file(&stem));
        archive.start_file(&name, SimpleFileOptions::default()).map_err(|e| failed(&e))?;
        archive.write_all(&sample).map_err(|e| failed(&e))?;
        out.names.push((path.clone(), name));
        out.unknown.extend(replacing.unknown);
    }
    out.bytes = archive.finish().map_err(|e| failed(&e))?.into_inner();
    Ok(out)
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

type Failed = (usize, usize, Problem);

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

    fn file(&mut self, bytes: &[u8]) -> Result<Vec<u8>, Failed> {
        let whole = |problem| (0, 0, problem);
        if workbook::is_workbook(bytes) {
            return match workbook::archive(bytes) {
                Some(Archive::Files) => Err(whole(bad("it is an archive of files: unpack it first"))),
                Some(_) => self.workbook(bytes).map_err(whole),
                None => {
                    Err(whole(bad("no sample can be made of an .xls file: save it as .xlsx or .csv first")))
                }
            };
        }
        let raw::Text { text, encoding, .. } = raw::decode(bytes, None)?;
        let sample = if web_page::is_page(&text) {
            self.page(&text).map_err(whole)?
        } else if text.trim_start().starts_with('{') {
            self.json(&text).map_err(whole)?
        } else {
            self.text(&text)
        };
        Ok(encoded(&sample, encoding, bytes))
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

    /// The words of a file's name that are known, which may say test and direction.
    fn name_of_file(&mut self, stem: &str) -> String {
        let words = stem.split(|c: char| !c.is_alphanumeric());
        let known = words.filter(|word| !word.is_empty() && is_known(word));
        known.collect::<Vec<_>>().join("_")
    }

    /// The cells of rows, each with what it becomes.
    fn decisions(&mut self, rows: &[Row<'_>], decimal: char) -> BTreeMap<String, String> {
        let mut out = BTreeMap::new();
        for row in rows {
            let cells: Vec<&str> = row.cells.iter().map(|c| c.text.as_ref()).collect();
            for (cell, part) in cells.iter().zip(parts(&cells, decimal)) {
                let text = bare(cell);
                if text.is_empty() {
                    continue;
                }
                // What is a heading anywhere stays everywhere: workbooks keep a text once.
                if part == Part::Layout || !out.contains_key(text) {
                    let replaced = self.cell(text, part);
                    out.insert(text.to_string(), replaced);
                }
            }
        }
        out
    }

    fn page(&mut self, text: &str) -> Result<String, Problem> {
        let rows = web_page::rows(text)?;
        let decisions = self.decisions(&rows, workbook::mark(&rows));
        let mut out = String::new();
        // Text stands between `>` and `<`; a page that hides `>` in an attribute loses more than it has to.
        for piece in text.split_inclusive('>') {
            let (inner, tag) = piece.split_at(piece.find('<').unwrap_or(piece.len()));
            out.push_str(&self.decided(inner, &decisions));
            out.push_str(tag);
        }
        Ok(out)
    }

    /// A text with its blanks, replaced as was decided; one that no row holds is a name.
    fn decided(&mut self, text: &str, decisions: &BTreeMap<String, String>) -> String {
        let inner = bare(text);
        if inner.is_empty() {
            return text.to_string();
        }
        let replacement = match decisions.get(inner) {
            Some(replacement) => replacement.clone(),
            None if matches!(number(inner, '.'), Number::Value(_)) => self.cell(inner, Part::Number),
            None => self.name(inner),
        };
        text.replacen(inner, &replacement, 1)
    }

    fn json(&mut self, text: &str) -> Result<String, Problem> {
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

    /// The workbook with its texts and numbers replaced. Merged, hidden and formatted cells stay as they are;
    /// properties, comments, pictures and formulas lose their content.
    fn workbook(&mut self, bytes: &[u8]) -> Result<Vec<u8>, Problem> {
        limits::archive(bytes)?;
        let book = workbook::sheets(bytes, None)?;
        let mut decisions = BTreeMap::new();
        for sheet in &book.sheets {
            decisions.extend(self.decisions(&sheet.rows, book.decimal));
        }
        let mut source = ZipArchive::new(Cursor::new(bytes)).map_err(bad)?;
        let mut out = ZipWriter::new(Cursor::new(Vec::new()));
        for i in 0..source.len() {
            let mut entry = source.by_index(i).map_err(bad)?;
            let name = entry.name().map_err(bad)?.into_owned();
            if entry.is_dir() {
                continue;
            }
            let mut inner = Vec::new();
            entry.read_to_end(&mut inner).map_err(bad)?;
            let is_xml = name.ends_with(".xml") || name.ends_with(".rels");
            // Pictures, printer settings and macros may show anything.
            if !is_xml {
                continue;
            }
            let is_structure =
                name.ends_with(".rels") || name == "[Content_Types].xml" || name.contains("styles");
            if !is_structure {
                let has_cells =
                    name.contains("sharedStrings") || name.contains("worksheets/") || name == "content.xml";
                inner = self.xml(&inner, has_cells.then_some(&decisions))?;
            }
            out.start_file(&name, SimpleFileOptions::default()).map_err(bad)?;
            out.write_all(&inner).map_err(bad)?;
        }
        Ok(out.finish().map_err(bad)?.into_inner())
    }

    /// XML with its texts replaced as was decided, or taken out where nothing was; values in attributes of .ods too.
    fn xml(
        &mut self,
        bytes: &[u8],
        decisions: Option<&BTreeMap<String, String>>,
    ) -> Result<Vec<u8>, Problem> {
        let text = std::str::from_utf8(bytes).map_err(bad)?;
        let (mut reader, mut writer) = (Reader::from_str(text), Writer::new(Vec::new()));
        // Indices of shared texts are no numbers of anybody, and formulas name sheets.
        let (mut is_shared, mut is_formula) = (false, false);
        loop {
            let event = reader.read_event().map_err(bad)?;
            match &event {
                Event::Eof => return Ok(writer.into_inner()),
                Event::Start(e) if e.local_name().as_ref() == "c" => {
                    let kind = e.attributes().flatten().find(|a| a.key.as_ref() == "t");
                    is_shared = kind.is_some_and(|kind| matches!(kind.value.as_ref(), "s" | "b" | "e"));
                }
                Event::Start(e) if e.local_name().as_ref() == "f" => is_formula = true,
                Event::End(e) if e.local_name().as_ref() == "f" => is_formula = false,
                _ => {}
            }
            let replaced = match event {
                Event::Text(t) if is_formula => {
                    drop(t);
                    Event::Text(BytesText::new(""))
                }
                Event::Text(t) if !is_shared || decisions.is_none() => {
                    let old = t.xml10_content().into_owned();
                    let new = decisions.map_or(String::new(), |d| self.decided(&old, d));
                    Event::Text(BytesText::new(&new).into_owned())
                }
                Event::Start(e) => Event::Start(self.attributes(e)),
                Event::Empty(e) => Event::Empty(self.attributes(e)),
                Event::Comment(_) => continue,
                other => other,
            };
            writer.write_event(replaced).map_err(bad)?;
        }
    }

    /// An element whose attributes hold values (.ods) or names (sheets).
    fn attributes<'e>(
        &mut self,
        element: quick_xml::events::BytesStart<'e>,
    ) -> quick_xml::events::BytesStart<'e> {
        let holds = |key: &str| {
            matches!(
                key,
                "office:value" | "office:string-value" | "office:date-value" | "table:formula" | "table:name"
            )
        };
        let is_sheet = element.local_name().as_ref() == "sheet";
        if !is_sheet && !element.attributes().flatten().any(|a| holds(a.key.as_ref())) {
            return element;
        }
        let name = element.name().as_ref().to_string();
        let mut out = quick_xml::events::BytesStart::new(name);
        for attribute in element.attributes().flatten() {
            let (key, value) = (attribute.key.as_ref().to_string(), attribute.value.to_string());
            let value = match key.as_str() {
                "table:formula" => continue,
                "office:value" | "office:date-value" => value.chars().map(|c| self.digit(c)).collect(),
                "office:string-value" | "table:name" => self.name(&value),
                "name" if is_sheet => self.name(&value),
                _ => value,
            };
            out.push_attribute((key.as_str(), value.as_str()));
        }
        out
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
        && (!matches!(number(text, decimal), Number::Text)
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

/// Whether a dialect knows the whole text: a heading, a key, a direction, a unit.
fn is_known(text: &str) -> bool {
    let vocabulary = Vocabulary::new(&[]);
    let stem = split_unit(text).0;
    Facets::of(text, vocabulary).is_clear()
        || [text, stem.as_str()].iter().any(|name| {
            vocabulary.role_exactly(name).is_some()
                || vocabulary.key(name).is_some()
                || vocabulary.direction_exactly(name).is_some()
                || vocabulary.test_exactly(name).is_some()
                || vocabulary.branch(name).is_some()
                || vocabulary.statistic(name).is_some()
        })
        || unit(text).is_ok()
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
    use super::*;
    use crate::instrument::{FileContent, ReadSettings, parse};
    use std::path::Path;

    const FILE: &str = "Sample;Müller \"Secret\" 4711\nOperator;Ana Silva\ndirection;warp\nMax. curvature;2,5 1/cm\n\n\
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
        assert_eq!(bundle.unknown, BTreeSet::from(["Max. curvature".to_string()]));
        // What reads the one reads the other, cell by cell.
        let (own, other) = (read("a.csv", &latin), read("a.csv", &sample));
        assert_eq!(own.measurements[0].curve.len(), other.measurements[0].curve.len());
        assert_eq!(own.measurements[0].direction, other.measurements[0].direction);
        assert_ne!(own.measurements[0].curve, other.measurements[0].curve);
    }

    #[test]
    fn a_workbook_keeps_its_cells_and_a_fab_file_its_tree() {
        let mut book = rust_xlsxwriter::Workbook::new();
        let sheet = book.add_worksheet().set_name("Müller").unwrap();
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
        let mut archive = ZipArchive::new(Cursor::new(bundle.bytes)).unwrap();
        let mut samples = [Vec::new(), Vec::new()];
        for (i, sample) in samples.iter_mut().enumerate() {
            archive.by_index(i).unwrap().read_to_end(sample).unwrap();
        }
        let content = read("x.xlsx", &samples[0]);
        assert_eq!(content.results.len(), 2);
        assert!(!content.results[0].0.clone().unwrap_or_default().contains("ller"));
        assert!(
            (0.01..0.1).contains(&(content.results[0].1.mean / content.results[0].1.parameter.kes_factor()))
        );
        let content = read("y.u3m", &samples[1]);
        assert_eq!(content.fab.unwrap().tests.len(), 1);
        assert!(!String::from_utf8_lossy(&samples[1]).contains("Secret"));
    }
}
