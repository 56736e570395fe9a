//! Texts that were written in one code page and read in another before they came here: `gf/cmø` that was `gf/cm°`.
//!
//! Which page it was is told by units: a text behind a name that is no unit as it stands, and is one when its bytes are
//! read otherwise, decides the pair of pages for the whole table.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::OnceLock;

use encoding_rs::{Encoding, MACINTOSH, UTF_8, WINDOWS_1252};
use oem_cp::code_table::{DECODING_TABLE_CP437, DECODING_TABLE_CP850};

use super::known_letters::known_letters;
use super::raw::{Cell, Row};
use super::unit_text::{split_unit, unbracketed, unit};
use super::vocabulary::HEADING;
use crate::finding::ReadFact;
use crate::quantity::Unit;

/// A page in which a text is a sequence of bytes.
#[derive(Clone, Copy)]
enum Page {
    Web(&'static Encoding),
    Dos(&'static str, &'static [char; 128]),
}

const PAGES: [Page; 5] = [
    Page::Web(WINDOWS_1252),
    Page::Dos("CP850", &DECODING_TABLE_CP850),
    Page::Dos("CP437", &DECODING_TABLE_CP437),
    Page::Web(MACINTOSH),
    Page::Web(UTF_8),
];

impl Page {
    fn name(self) -> &'static str {
        match self {
            Self::Web(encoding) => encoding.name(),
            Self::Dos(name, _) => name,
        }
    }

    fn decode(self, bytes: &[u8]) -> Option<String> {
        match self {
            Self::Web(encoding) => {
                encoding.decode_without_bom_handling_and_without_replacement(bytes).map(Cow::into_owned)
            }
            Self::Dos(_, table) => Some(
                bytes
                    .iter()
                    .map(|b| b.checked_sub(0x80).map_or(char::from(*b), |i| table[usize::from(i)]))
                    .collect(),
            ),
        }
    }

    /// The byte of each character beyond ASCII; of a page with one byte a character.
    fn bytes(self) -> Vec<(char, u8)> {
        (0x80..=0xff).filter_map(|b| Some((self.decode(&[b])?.chars().next()?, b))).collect()
    }
}

/// A text in the characters of one page as the bytes of another.
struct Recoding {
    from: Page,
    to: Page,
    bytes: Vec<(char, u8)>,
}

impl Recoding {
    fn byte(&self, c: char) -> Option<u8> {
        let ascii = u8::try_from(c).ok().filter(|b| *b < 0x80);
        ascii.or_else(|| self.bytes.iter().find(|(of, _)| *of == c).map(|(_, b)| *b))
    }

    /// The text in the other page; none if it cannot have come that way.
    fn apply(&self, text: &str) -> Option<String> {
        let bytes: Vec<u8> = text.chars().map(|c| self.byte(c)).collect::<Option<_>>()?;
        self.to.decode(&bytes)
    }

    /// A text as it was, with the unit in it, where no known word is lost by that.
    fn unit_of<'t>(&self, text: &'t str) -> Option<(&'t str, String, Unit)> {
        let other = self.apply(text).filter(|other| known_letters(other) >= known_letters(text))?;
        let unit = unit_in(&other)?;
        Some((text, other, unit))
    }

    fn row<'r>(&self, row: &'r Row<'_>) -> Row<'r> {
        let mut cells = Vec::with_capacity(row.cells.len());
        for cell in &row.cells {
            let other = is_strange(&cell.text).then(|| self.apply(&cell.text)).flatten();
            let text = other.map_or(Cow::Borrowed(cell.text.as_ref()), Cow::Owned);
            cells.push(Cell { text, column: cell.column });
        }
        Row { line: row.line, cells, in_cells: row.in_cells }
    }
}

/// All recodings between two pages.
fn recodings() -> &'static [Recoding] {
    static RECODINGS: OnceLock<Vec<Recoding>> = OnceLock::new();
    RECODINGS.get_or_init(all_recodings)
}

fn all_recodings() -> Vec<Recoding> {
    let single = PAGES.into_iter().filter(|page| page.name() != "UTF-8");
    let pairs = single.flat_map(|from| PAGES.into_iter().map(move |to| (from, to)));
    let other = pairs.filter(|(from, to)| from.name() != to.name());
    other.map(|(from, to)| Recoding { from, to, bytes: from.bytes() }).collect()
}

/// Different texts that are looked at.
const TEXTS: usize = 100;

/// The unit beyond ASCII that a text holds.
fn unit_in(text: &str) -> Option<Unit> {
    // Before it is folded: `cm²` is `cm2` then.
    if text.rsplit(['(', '[']).next().is_none_or(str::is_ascii) {
        return None;
    }
    unit(&split_unit(text).1.unwrap_or_else(|| unbracketed(text))).ok()
}

/// Whether a text has characters beyond ASCII and no unit among them.
fn is_strange(text: &str) -> bool {
    !text.is_ascii() && text.chars().nth(HEADING).is_none() && unit_in(text).is_none()
}

/// The rows as they were written, and what is told of it; none where no unit speaks for another page.
pub(super) fn restored<'r>(rows: &'r [Row<'_>]) -> Option<(Vec<Row<'r>>, ReadFact)> {
    let texts = rows.iter().flat_map(|r| &r.cells).map(|c| c.text.as_ref());
    // A single letter may be a name: `ø` is a diameter.
    let strange: BTreeSet<&str> =
        texts.filter(|t| t.trim().chars().nth(1).is_some() && is_strange(t)).take(TEXTS).collect();
    if strange.is_empty() {
        return None;
    }
    let (mut best, mut found): (Option<&Recoding>, Vec<(&str, String, Unit)>) = (None, Vec::new());
    for recoding in recodings() {
        let units: Vec<_> = strange.iter().filter_map(|text| recoding.unit_of(text)).collect();
        if units.len() > found.len() {
            (best, found) = (Some(recoding), units);
        } else if !units.is_empty() && units.len() == found.len() {
            // Two pages that give other units leave it open.
            let same = units.iter().zip(&found).all(|(a, b)| a.0 == b.0 && a.2 == b.2);
            if !same {
                return None;
            }
        }
    }
    let recoding = best?;
    let (was, is, _) = found.into_iter().next()?;
    let fact = ReadFact::OtherCodePage {
        written: is,
        found: was.to_string(),
        written_in: recoding.to.name().to_string(),
        read_in: recoding.from.name().to_string(),
    };
    Some((rows.iter().map(|row| recoding.row(row)).collect(), fact))
}

#[cfg(test)]
mod tests {
    use super::super::raw::rows;
    use super::*;

    fn cells(text: &str) -> Option<Vec<String>> {
        let rows = rows(text, ';');
        let (restored, _) = restored(&rows)?;
        Some(restored.iter().flat_map(|r| &r.cells).map(|c| c.text.to_string()).collect())
    }

    #[test]
    fn a_unit_decides_the_page() {
        for (text, expected) in [
            ("G (gf/cmø);B", "G (gf/cm°)"),
            ("angle (ø);F", "angle (°)"),
            ("B (gfúcmý/cm);T", "B (gf·cm²/cm)"),
            ("B (gfÀcm▓/cm);T", "B (gf·cm²/cm)"),
            ("G (gf/cm░);T", "G (gf/cm°)"),
            ("B (gf.cmÂ²/cm);T", "B (gf.cm²/cm)"),
            ("G (gf/cmÂ°);T", "G (gf/cm°)"),
            ("G (gf/cm¡);T", "G (gf/cm°)"),
            ("espessura (æm);T", "espessura (µm)"),
        ] {
            assert_eq!(cells(text).map(|c| c[0].clone()).as_deref(), Some(expected), "{text}");
        }
    }

    #[test]
    fn words_of_the_same_page_follow_and_others_stay() {
        assert_eq!(cells("Kr³mmung;G (gf/cm░)\n").unwrap()[0], "Krümmung");
        for text in
            ["ø;1", "Ø (mm);1", "Krümmung (1/cm);1", "G (gf/cm°);1", "曲げ (gf·cm/cm);1", "μ;1", "é;à"]
        {
            assert_eq!(cells(text), None, "{text}");
        }
    }
}
