//! Bytes to text to cells. Nothing is interpreted here, and every cell keeps its place.

use std::borrow::Cow;

use encoding_rs::{
    BIG5, EUC_JP, EUC_KR, Encoding, GB18030, ISO_2022_JP, SHIFT_JIS, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1250,
    WINDOWS_1252, WINDOWS_1254,
};

use super::dos::CodePage;
use super::error::ReadProblem;
use super::known_letters::known_letters;
use super::words::trimmed;

/// Decoded text and the name of the encoding that was decided.
pub(super) struct Text {
    pub text: String,
    pub encoding: &'static str,
    /// What decided it, for people.
    pub why: &'static str,
}

/// One cell as it stands in the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cell<'a> {
    pub text: Cow<'a, str>,
    /// Column of its first character, from 1 (in a workbook: the cell's column).
    pub column: usize,
}

/// One line of the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row<'a> {
    /// From 1.
    pub line: usize,
    pub cells: Vec<Cell<'a>>,
    /// Whether columns count cells, as in a workbook, and not characters.
    pub in_cells: bool,
}

impl Cell<'_> {
    /// The same text, borrowed.
    pub fn by_reference(&self) -> Cell<'_> {
        Cell { text: Cow::Borrowed(self.text.as_ref()), column: self.column }
    }
}

impl Row<'_> {
    pub fn is_blank(&self) -> bool {
        self.cells.iter().all(|c| trimmed(&c.text).is_empty())
    }

    /// Index and cell of those that hold anything.
    pub fn filled(&self) -> impl Iterator<Item = (usize, &Cell<'_>)> {
        self.cells.iter().enumerate().filter(|(_, c)| !trimmed(&c.text).is_empty())
    }

    /// The trimmed text of a cell, if there is any.
    pub fn get(&self, index: usize) -> Option<&str> {
        self.cells.get(index).map(|c| trimmed(&c.text)).filter(|t| !t.is_empty())
    }

    /// The same cells, borrowed.
    pub fn by_reference(&self) -> Row<'_> {
        let cells = self.cells.iter().map(Cell::by_reference).collect();
        Row { line: self.line, cells, in_cells: self.in_cells }
    }

    /// The column of a cell; past the end, the column after the last one.
    pub fn column(&self, index: usize) -> usize {
        let width = |c: &Cell<'_>| if self.in_cells { 1 } else { c.text.chars().count() };
        let end = || self.cells.last().map_or(1, |c| c.column + width(c));
        self.cells.get(index).map_or_else(end, |c| c.column)
    }
}

/// Decodes a whole file: byte order mark, strict UTF-8, UTF-16 by its NUL pattern, strict CP932
/// where it looks like Japanese, else Windows-1252. `label` (of a dialect) settles it at once.
///
/// The whole file is decoded before anything is split, because the second byte of a CP932
/// character can be `|` or a backslash. The error carries line and column.
pub(super) fn decode(bytes: &[u8], label: Option<&str>) -> Result<Text, (usize, usize, ReadProblem)> {
    let (set, why) = match label.and_then(|l| Encoding::for_label(l.as_bytes())) {
        Some(encoding) => (Set::Web(encoding), "stated by the dialect"),
        None => guess(bytes),
    };
    let body = Encoding::for_bom(bytes).map_or(bytes, |(_, n)| &bytes[n..]);
    let Some(decoded) = set.decode(body) else {
        return Err((0, 0, not_text(format!("its bytes are not valid {}", set.name()))));
    };
    // DOS programs end a file with Ctrl-Z.
    let text = decoded.trim_end_matches('\u{1a}');
    // C0 controls and DEL are single bytes; the C1 controls are C2 80 to C2 9F.
    let bytes = text.as_bytes();
    let control = |i: usize| match bytes[i] {
        b'\t' | b'\r' | b'\n' | 0x0c => false,
        0xc2 => bytes.get(i + 1).is_some_and(|b| *b < 0xa0),
        b => b < 0x20 || b == 0x7f,
    };
    if let Some(at) = (0..bytes.len()).find(|&i| control(i)) {
        let line = text[..at].matches('\n').count() + 1;
        let column = text[..at].rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        let code = text[at..].chars().next().map_or(0, u32::from);
        return Err((line, column, not_text(format!("control character U+{code:04X}"))));
    }
    // Old programs end lines with a carriage return alone.
    let text = if text.contains('\n') { text.to_string() } else { text.replace('\r', "\n") };
    Ok(Text { text, encoding: set.name(), why })
}

/// A character set: one of the web, or of DOS.
#[derive(Clone, Copy)]
enum Set {
    Web(&'static Encoding),
    Dos(CodePage),
}

impl Set {
    fn name(self) -> &'static str {
        match self {
            Self::Web(encoding) => encoding.name(),
            Self::Dos(page) => page.name(),
        }
    }

    /// The text of whole bytes; none where they are none of this set.
    fn decode(self, bytes: &[u8]) -> Option<Cow<'_, str>> {
        match self {
            Self::Web(encoding) => encoding.decode_without_bom_handling_and_without_replacement(bytes),
            Self::Dos(page) => page.decode(bytes).map(Cow::Owned),
        }
    }

    /// The text of the beginning of bytes, which may end within a character.
    fn beginning(self, bytes: &[u8]) -> Cow<'_, str> {
        match self {
            Self::Web(encoding) => encoding.decode_without_bom_handling(bytes).0,
            Self::Dos(page) => Cow::Owned(page.decode(bytes).unwrap_or_default()),
        }
    }
}

fn not_text(found: String) -> ReadProblem {
    ReadProblem::NotText { found }
}

/// The encoding, and what speaks for it.
fn guess(bytes: &[u8]) -> (Set, &'static str) {
    if let Some((encoding, _)) = Encoding::for_bom(bytes) {
        return (Set::Web(encoding), "byte order mark");
    }
    const NULS: &str = "every second byte is NUL";
    let nuls = |offset: usize| bytes.iter().skip(offset).step_by(2).take(2000).filter(|&&b| b == 0).count();
    match (std::str::from_utf8(bytes).is_ok(), nuls(0), nuls(1)) {
        (true, 0, 0) if bytes.is_ascii() && has_escapes(bytes) => {
            (Set::Web(ISO_2022_JP), "its escape sequences")
        }
        (true, 0, 0) if bytes.is_ascii() => (Set::Web(UTF_8), "plain ASCII"),
        (true, 0, 0) => (Set::Web(UTF_8), "the bytes are valid UTF-8"),
        // ASCII characters of UTF-16 have a NUL in every second byte, always on the same side.
        (_, even, odd) if odd > 10 * even && odd > 3 => (Set::Web(UTF_16LE), NULS),
        (_, even, odd) if even > 10 * odd && even > 3 => (Set::Web(UTF_16BE), NULS),
        (true, ..) => (Set::Web(UTF_8), "the bytes are valid UTF-8"),
        _ => by_words(bytes),
    }
}

/// The escapes by which ISO-2022-JP changes its character set.
fn has_escapes(bytes: &[u8]) -> bool {
    bytes.windows(3).any(|w| matches!(w, b"\x1b$B" | b"\x1b$@" | b"\x1b(J"))
}

/// Encodings that laboratories have besides Unicode, and what they are called in messages.
const OLD: [(Set, &str); 11] = [
    (Set::Web(SHIFT_JIS), "not UTF-8, and the byte pairs are Japanese"),
    (Set::Web(WINDOWS_1252), "not UTF-8, and its words are known in this Western encoding"),
    (Set::Web(EUC_JP), "not UTF-8, and its words are known in Japanese"),
    (Set::Web(GB18030), "not UTF-8, and its words are known in Chinese"),
    (Set::Web(BIG5), "not UTF-8, and its words are known in traditional Chinese"),
    (Set::Web(EUC_KR), "not UTF-8, and its words are known in Korean"),
    (Set::Web(WINDOWS_1250), "not UTF-8, and its words are known in this Central European encoding"),
    (Set::Web(WINDOWS_1254), "not UTF-8, and its words are known in Turkish"),
    (Set::Dos(CodePage::Cp850), "not UTF-8, and its words are known in this Western code page of DOS"),
    (
        Set::Dos(CodePage::Cp852),
        "not UTF-8, and its words are known in this Central European code page of DOS",
    ),
    (Set::Dos(CodePage::Cp857), "not UTF-8, and its words are known in the Turkish code page of DOS"),
];
/// Bytes of lines that are looked at for words.
const SAMPLE: usize = 16_384;

/// The encoding in which most letters belong to known words; without any, by the byte pairs.
fn by_words(bytes: &[u8]) -> (Set, &'static str) {
    let mut lines: Vec<u8> = Vec::new();
    // A line end is the same byte in all of them.
    for line in bytes.split_inclusive(|b| *b == b'\n').filter(|l| !l.is_ascii()) {
        lines.extend(line);
        if lines.len() > SAMPLE {
            break;
        }
    }
    // A line may be as long as the file. A character that is cut there is known to nobody.
    lines.truncate(SAMPLE);
    let known = |set: Set| set.decode(bytes).map(|_| known_letters(&set.beginning(&lines)));
    let scores = OLD.iter().map(|(set, why)| (known(*set).unwrap_or(0), *set, *why));
    // Among equals the first.
    let best = scores.reduce(|a, b| if b.0 > a.0 { b } else { a });
    match best {
        Some((score, set, why)) if score > 0 => (set, why),
        _ if looks_japanese(bytes) => (Set::Web(SHIFT_JIS), "not UTF-8, and the byte pairs are Japanese"),
        _ => (Set::Web(WINDOWS_1252), "not UTF-8 and not Japanese"),
    }
}

/// Whether bytes are CP932 rather than Windows-1252, of which nearly every file is valid CP932
/// too: `ão` is a pair of it. Japanese text has lead bytes 81..9F (kana, everyday kanji) and runs
/// of half-width katakana; accented Latin letters and `° ² µ` fall on E0..FC and on single A1..DF.
fn looks_japanese(bytes: &[u8]) -> bool {
    if SHIFT_JIS.decode_without_bom_handling_and_without_replacement(bytes).is_none() {
        return false;
    }
    let (mut japanese, mut latin, mut i) = (0, 0, 0);
    while i < bytes.len() {
        match bytes[i] {
            0x81..=0x9f => (japanese, i) = (japanese + 1, i + 2),
            0xe0..=0xfc => (latin, i) = (latin + 1, i + 2),
            0xa1..=0xdf => {
                let run = bytes[i..].iter().take_while(|b| (0xa1..=0xdf).contains(*b)).count();
                // ° ± ² ³ µ · stand together in units: `gf/cm·°`.
                let signs = bytes[i..i + run].iter().all(|b| matches!(b, 0xb0..=0xb3 | 0xb5 | 0xb7));
                if run > 1 && !signs {
                    japanese += run;
                } else {
                    latin += 1;
                }
                i += run;
            }
            _ => i += 1,
        }
    }
    japanese > latin
}

/// Splits text into rows and cells. A cell in double quotes may hold the delimiter.
///
/// Hand-written because the csv crate gives no position of a field and skips blank lines, which
/// separate blocks here.
pub(super) fn rows(text: &str, delimiter: char) -> Vec<Row<'_>> {
    let (mut out, mut line, mut rest) = (Vec::new(), 1, Some(text));
    while let Some(here) = rest {
        let (end, lines) = logical_line(here, delimiter);
        let own = &here[..end];
        out.push(Row {
            line,
            cells: cells(own.strip_suffix('\r').unwrap_or(own), delimiter),
            in_cells: false,
        });
        line += lines;
        rest = here.get(end + 1..);
    }
    out
}

/// Lines that one heading with line breaks in it may take.
const BREAKS: usize = 8;
/// Lines that a row of such headings may take.
const ROW_BREAKS: usize = 200;

/// Where the first line ends, and how many it is: spreadsheets write a line break within a cell in quotes. A quote that no
/// cell of the next lines closes is an inch mark or a slip, and ends with its line.
fn logical_line(text: &str, delimiter: char) -> (usize, usize) {
    let ends = text.match_indices('\n').map(|(at, _)| at).chain([text.len()]);
    let (mut first, mut start, mut without) = (None, 0, 0);
    let (mut quote, mut has_quotes) = (Quote::default(), false);
    for (end, lines) in ends.zip(1..=ROW_BREAKS) {
        first.get_or_insert(end);
        let line = &text[start..end];
        let quotes = line.contains('"');
        has_quotes |= quotes;
        // A line without a quote goes on with the cell of the line before.
        without = if quotes { 0 } else { without + 1 };
        start = end;
        if !has_quotes || without >= BREAKS {
            break;
        }
        line.chars().for_each(|c| quote.read(c, delimiter));
        if !quote.is_open {
            return (end, lines);
        }
    }
    (first.unwrap_or(text.len()), 1)
}

/// Whether a cell that begins with a quote lacks the closing one, a character at a time: no line is read twice for it.
#[derive(Default)]
struct Quote {
    /// Something else than a space was in the cell.
    has_begun: bool,
    /// The first of that was a quote.
    protects: bool,
    is_open: bool,
}

impl Quote {
    fn read(&mut self, c: char, delimiter: char) {
        if c == delimiter && !self.is_open {
            *self = Self::default();
            return;
        }
        if c == '"' && !self.has_begun {
            self.protects = true;
        }
        self.has_begun |= c != ' ';
        self.is_open ^= c == '"' && self.protects;
    }
}

pub(super) fn cells(line: &str, delimiter: char) -> Vec<Cell<'_>> {
    let mut out = Vec::new();
    let (mut rest, mut column) = (line, 1);
    let (plain, is_ascii) = (!line.contains('"'), line.is_ascii());
    loop {
        let end = if plain { rest.find(delimiter).unwrap_or(rest.len()) } else { cell_end(rest, delimiter) };
        let raw = &rest[..end];
        let behind_lead = raw.trim_start_matches(' ');
        let bare = behind_lead.trim_end_matches(' ');
        let text = if plain { Cow::Borrowed(bare) } else { unquoted(bare) };
        out.push(Cell { text, column: column + raw.len() - behind_lead.len() });
        if end == rest.len() {
            return out;
        }
        column += 1 + if is_ascii { raw.len() } else { raw.chars().count() };
        rest = &rest[end + delimiter.len_utf8()..];
    }
}

fn cell_end(rest: &str, delimiter: char) -> usize {
    // A quote only protects at the start of a cell; elsewhere it is an inch mark or a slip.
    let mut quoted = false;
    let starts_quoted = rest.trim_start_matches(' ').starts_with('"');
    for (i, c) in rest.char_indices() {
        if c == '"' && starts_quoted {
            quoted = !quoted;
        } else if c == delimiter && !quoted {
            return i;
        }
    }
    if quoted { rest.find(delimiter).unwrap_or(rest.len()) } else { rest.len() }
}

fn unquoted(cell: &str) -> Cow<'_, str> {
    if cell.contains('\n') {
        let one_line = cell.split('\n').map(str::trim).collect::<Vec<_>>().join(" ");
        return Cow::Owned(unquoted(&one_line).into_owned());
    }
    match cell.strip_prefix('"').and_then(|c| c.strip_suffix('"')) {
        Some(inner) if inner.contains("\"\"") => Cow::Owned(inner.replace("\"\"", "\"")),
        Some(inner) => Cow::Borrowed(inner),
        None => Cow::Borrowed(cell),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoding(bytes: &[u8]) -> &'static str {
        decode(bytes, None).map(|t| t.encoding).unwrap()
    }

    /// Quotes that no cell closes are looked for once, not anew from each line of the next two hundred.
    #[test]
    fn an_open_quote_is_an_inch_mark_however_many_there_are() {
        let open = "1\": {\"length\": 2.08, \"wid\n";
        let text = open.repeat(4000);
        let rows = rows(&text, ',');
        assert_eq!(rows.len(), 4001);
        assert!(rows[..4000].iter().zip(1..).all(|(row, line)| row.line == line && row.cells.len() == 2));
    }

    #[test]
    fn each_encoding_is_recognised() {
        let japanese = "試料名\t綿ブロード\r\n曲率(㎝-1)\t曲げモーメント(ｇｆ・㎝/㎝)\r\n1\t2\r\n";
        assert_eq!(encoding(japanese.as_bytes()), "UTF-8");
        assert_eq!(encoding(&[b"\xef\xbb\xbf", japanese.as_bytes()].concat()), "UTF-8");
        assert_eq!(encoding(&SHIFT_JIS.encode(japanese).0), "Shift_JIS");
        let little: Vec<u8> = japanese.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = japanese.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(encoding(&little), "UTF-16LE");
        assert_eq!(encoding(&big), "UTF-16BE");
        assert_eq!(encoding(&[b"\xff\xfe", &little[..]].concat()), "UTF-16LE");
        let portuguese = "extensão (mm);força (gf/cm²)\r\nângulo (°);direção\r\n";
        assert_eq!(encoding(&WINDOWS_1252.encode(portuguese).0), "windows-1252");
        let portuguese = "amostra;direção\r\nespessura;0,5 mm\r\n".replace("çã", "\u{1}");
        let bytes: Vec<u8> =
            portuguese.bytes().flat_map(|b| if b == 1 { vec![0x87, 0xc6] } else { vec![b] }).collect();
        assert_eq!(encoding(&bytes), "CP850");
        // Half-width katakana, as old instruments write it.
        assert_eq!(encoding(&SHIFT_JIS.encode("ﾀﾃ,ﾖｺ\n1,2\n").0), "Shift_JIS");
    }

    /// The second byte of 表 in CP932 is a backslash, of the full-width minus a '|'.
    #[test]
    fn cells_are_split_after_decoding() {
        let bytes = SHIFT_JIS.encode("表\t−１\n").0.into_owned();
        let text = decode(&bytes, None).map(|t| t.text).unwrap();
        let rows = rows(&text, '\t');
        assert_eq!(rows[0].get(0), Some("表"));
        assert_eq!(rows[0].cells[1].column, 3);
    }

    #[test]
    fn binary_is_refused_with_its_place() {
        let (line, column, problem) = decode(b"a,b\n1,\x012", None).err().unwrap();
        assert_eq!((line, column, problem.code()), (2, 3, "R003"));
    }

    #[test]
    fn quotes_protect_the_delimiter_and_columns_count_characters() {
        let row = &rows("\"a, b\", é ,\"c \"\"d\"\"\",", ',')[0];
        let cells: Vec<_> = row.cells.iter().map(|c| (c.text.as_ref(), c.column)).collect();
        assert_eq!(cells, [("a, b", 1), ("é", 9), ("c \"d\"", 12), ("", 22)]);
    }

    #[test]
    fn headings_with_line_breaks_are_one_cell_and_lines_are_counted() {
        let rows = rows("a,\"Bending\r\nrigidity\n(gf)\",b\r\n1,2,3\n5\",6,7\nc,\"d\ne,f", ',');
        let cells = |i: usize| rows[i].cells.iter().map(|c| c.text.to_string()).collect::<Vec<_>>();
        assert_eq!(cells(0), ["a", "Bending rigidity (gf)", "b"]);
        assert_eq!((rows[1].line, cells(1)), (4, vec!["1".into(), "2".into(), "3".into()]));
        assert_eq!((rows[2].line, cells(2)), (5, vec!["5\"".into(), "6".into(), "7".into()]));
        // Nothing closes this quote.
        assert_eq!((rows[3].line, cells(3)), (6, vec!["c".into(), "\"d".into()]));
        assert_eq!((rows[4].line, cells(4)), (7, vec!["e".into(), "f".into()]));
    }
}
