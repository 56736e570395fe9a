//! Lines of DXF: which entities a file has, where, and on which layer. The reader of the drawing itself leaves out in
//! silence what it does not know, and does not tell lines.

use std::borrow::Cow;
use std::ops::Range;

use encoding_rs::Encoding;

/// An entity of a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Written<'a> {
    /// Its kind, such as `LINE`.
    pub kind: &'a str,
    /// Line of its kind, from 1.
    pub line: usize,
    /// In hexadecimal digits; empty if it has none.
    pub handle: &'a str,
    /// `0` if it names none.
    pub layer: &'a str,
}

/// The entities of a file, in their order: those of its sheet, and those of each block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Entities<'a> {
    /// Of the section ENTITIES.
    pub drawn: Vec<Written<'a>>,
    /// Of each block of the section BLOCKS.
    pub blocks: Vec<Vec<Written<'a>>>,
    /// Lines of the file, from 0, that tell contours and their unit: the sections BLOCKS and ENTITIES, and two values of
    /// the header. Tables and objects of old programs keep a reader from all the rest, and say nothing of contours.
    pub needed: Vec<Range<usize>>,
}

impl Entities<'_> {
    /// The file without what is not needed.
    pub fn shortened(&self, text: &str) -> String {
        let lines: Vec<&str> = text.lines().collect();
        let mut short = String::with_capacity(text.len());
        let (header, sections): (Vec<&Range<usize>>, Vec<_>) =
            self.needed.iter().partition(|range| lines[range.start].trim() == "9");
        let header = header.iter().flat_map(|range| &lines[(*range).clone()]);
        let begin = ["0", "SECTION", "2", "HEADER"];
        let between = ["0", "ENDSEC"];
        let sections = sections.iter().flat_map(|range| &lines[(*range).clone()]);
        for line in begin.iter().chain(header).chain(&between).chain(sections).chain(&["0", "EOF"]) {
            short.push_str(line.trim_end());
            short.push('\n');
        }
        short
    }
}

impl Written<'_> {
    /// Its kind with its handle.
    pub fn what(&self) -> String {
        if self.handle.is_empty() {
            self.kind.to_string()
        } else {
            format!("{} (handle {})", self.kind, self.handle)
        }
    }
}

/// The text of a file: UTF-8, or else in the code page that it names.
pub(super) fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, String> {
    if bytes.starts_with(b"AutoCAD Binary DXF") || bytes.starts_with(b"AutoCAD DXB") {
        return Err("the drawing is binary: save it as ASCII DXF".into());
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if let Ok(text) = std::str::from_utf8(bytes) {
        return Ok(text.into());
    }
    // Names of code pages are in ASCII, whatever the rest is.
    let ascii = String::from_utf8_lossy(bytes);
    let page = ascii.lines().skip_while(|l| l.trim() != "$DWGCODEPAGE").nth(2).unwrap_or("").trim();
    let number = page.to_ascii_lowercase().replace("ansi_", "");
    let labels = [format!("windows-{number}"), format!("ms{number}"), format!("ms_{number}")];
    let known = labels.iter().find_map(|label| Encoding::for_label(label.as_bytes()));
    let decoded = known.and_then(|e| e.decode_without_bom_handling_and_without_replacement(bytes));
    decoded.ok_or_else(|| {
        format!(
            "the text is neither UTF-8 nor in its code page \"{page}\": save it as ASCII DXF of 2007 or later"
        )
    })
}

/// The entities of a text.
///
/// # Errors
/// Line and message where it is no DXF.
pub(super) fn entities(text: &str) -> Result<Entities<'_>, (usize, String)> {
    let mut found = Entities::default();
    let (mut section, mut after_section, mut ended) = ("", false, false);
    // The line on which the section begins, and that of the last name of a value of the header.
    let (mut begun, mut name_at) = (0, None);
    // Whether the groups that follow are those of an entity.
    let mut open = false;
    let mut lines = text.lines().enumerate();
    while let Some((at, code)) = lines.next() {
        if code.trim().is_empty() && lines.clone().all(|(_, l)| l.trim().is_empty()) {
            break;
        }
        let Ok(code) = code.trim().parse::<i32>() else {
            return Err((at + 1, format!("`{}` is no group code: this is no ASCII DXF", code.trim())));
        };
        let Some((value_at, value)) = lines.next() else {
            return Err((at + 1, "the file ends after a group code: it was cut short".into()));
        };
        let value = value.trim();
        match (code, value) {
            (0, "SECTION") => (begun, after_section, open) = (at, true, false),
            (0, "ENDSEC") => {
                if matches!(section, "BLOCKS" | "ENTITIES") {
                    found.needed.push(begun..value_at + 1);
                }
                (section, open) = ("", false);
            }
            (9, name) if section == "HEADER" => {
                name_at = matches!(name, "$ACADVER" | "$INSUNITS").then_some(at);
            }
            (_, _) if section == "HEADER" && name_at.is_some() => {
                found.needed.extend(name_at.take().map(|from| from..value_at + 1));
            }
            (0, "EOF") => ended = true,
            (2, name) if after_section => (section, after_section) = (name, false),
            (0, "BLOCK") if section == "BLOCKS" => {
                found.blocks.push(Vec::new());
                open = false;
            }
            (0, "ENDBLK") if section == "BLOCKS" => open = false,
            (0, kind) => {
                let written = Written { kind, line: value_at + 1, handle: "", layer: "0" };
                open = match section {
                    "ENTITIES" => {
                        found.drawn.push(written);
                        true
                    }
                    "BLOCKS" => found.blocks.last_mut().map(|b| b.push(written)).is_some(),
                    _ => false,
                };
            }
            (5 | 8, _) if open => {
                let list = if section == "BLOCKS" { found.blocks.last_mut() } else { Some(&mut found.drawn) };
                if let Some(written) = list.and_then(|l| l.last_mut()) {
                    let field = if code == 5 { &mut written.handle } else { &mut written.layer };
                    *field = value;
                }
            }
            _ => {}
        }
    }
    if !ended {
        return Err((text.lines().count(), "the file ends without EOF: it was cut short".into()));
    }
    Ok(found)
}
