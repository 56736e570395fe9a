//! Where the words of a TOML file stand, so that a message that quotes one can point at it.

use std::path::Path;

use toml::de::{DeTable, DeValue};

use super::Place;

/// A key or a text of the file.
#[derive(Clone, Debug)]
struct Word {
    text: String,
    /// Byte offset.
    offset: usize,
    /// Line and column, from 1.
    position: (usize, usize),
    is_key: bool,
}

/// The keys and texts of a file, in its order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Words(Vec<Word>);

impl Words {
    /// The words of a file; none if it is no TOML.
    pub fn of(file: &str) -> Self {
        let mut words = Vec::new();
        if let Ok(table) = DeTable::parse(file) {
            of_table(table.get_ref(), file, &mut words);
        }
        words.sort_by_key(|w: &Word| w.offset);
        Self(words)
    }

    /// The place of the first word that a message quotes, as `` `word` `` or else as `[word]`; else the whole file.
    pub fn place(&self, path: &Path, message: &str) -> Place {
        let of = |quoted: &str| self.0.iter().find(|w| w.text == quoted);
        quoted(message, '`').chain(quoted(message, '[')).find_map(of).map_or_else(
            || Place::file(path),
            |w| {
                let (line, column) = w.position;
                Place::at(path, line, column)
            },
        )
    }

    /// The position of a text that a message quotes, or a part of it, in the table whose head is at an offset: what is
    /// wrong in a table of several kinds is known to the parser no closer than that.
    pub fn position_after(&self, offset: usize, file: &str, message: &str) -> Option<(usize, usize)> {
        let table = file.get(offset..)?.strip_prefix('[')?;
        let end = table.find("\n[").map_or(file.len(), |at| offset + 1 + at);
        let inside = || self.0.iter().filter(|w| !w.is_key && (offset..end).contains(&w.offset));
        let of = |quoted: &str| inside().find(|w| w.text.contains(quoted));
        quoted(message, '`').find_map(of).map(|w| w.position)
    }
}

fn of_table(table: &DeTable<'_>, file: &str, words: &mut Vec<Word>) {
    for (key, value) in table {
        words.push(word(key.get_ref(), key.span().start, true, file));
        of_value(value.get_ref(), value.span().start, file, words);
    }
}

fn of_value(value: &DeValue<'_>, offset: usize, file: &str, words: &mut Vec<Word>) {
    match value {
        DeValue::String(text) => words.push(word(text, offset, false, file)),
        DeValue::Table(table) => of_table(table, file, words),
        DeValue::Array(array) => {
            array.iter().for_each(|item| of_value(item.get_ref(), item.span().start, file, words));
        }
        _ => {}
    }
}

fn word(text: &str, offset: usize, is_key: bool, file: &str) -> Word {
    Word { text: text.into(), offset, position: position(file, offset), is_key }
}

/// What a message quotes, in its order.
fn quoted(message: &str, open: char) -> impl Iterator<Item = &str> {
    let close = if open == '[' { ']' } else { open };
    let mut rest = message;
    std::iter::from_fn(move || {
        let inner = rest[rest.find(open)?..].trim_start_matches(open);
        let end = inner.find(close)?;
        rest = inner[end..].trim_start_matches(close);
        Some(&inner[..end])
    })
}

/// Line and column (from 1, in characters) of a byte offset.
pub(crate) fn position(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
    (line, column)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "title = \"a\"\n[sheet]\nshape = \"disc\"\n[[loads]]\nkind = \"pressure\"\nvalue = \"1 m\"\n\
                        [[loads]]\nkind = \"point\"\nvalue = \"1 foot\"\nset = \"rim\"\n";

    #[test]
    fn a_message_points_at_what_it_quotes() {
        let words = Words::of(FILE);
        let place = |message: &str| words.place(Path::new("c.toml"), message).to_string();
        assert_eq!(place("the mesh has no set `rim`; it has: `all`"), "c.toml:10:7");
        assert_eq!(place("[sheet] needs `cells`"), "c.toml:2:2");
        assert_eq!(place("[sheet] `shape` is none"), "c.toml:3:1");
        assert_eq!(place("remove [[loads]]"), "c.toml:4:3");
        assert_eq!(place("nothing holds it"), "c.toml");
        assert_eq!(place("a lone ` is no quote"), "c.toml");
    }

    #[test]
    fn a_wrong_value_is_found_in_its_table_only() {
        let words = Words::of(FILE);
        let second = FILE.rfind("[[loads]]").unwrap();
        let first = FILE.find("[[loads]]").unwrap();
        assert_eq!(words.position_after(second, FILE, "`foot` is no unit"), Some((9, 9)));
        assert_eq!(words.position_after(first, FILE, "`1 m` has the wrong dimension"), Some((6, 9)));
        assert_eq!(words.position_after(first, FILE, "`foot` is no unit"), None);
        assert_eq!(words.position_after(FILE.find("shape").unwrap(), FILE, "`disc` is none"), None);
    }
}
