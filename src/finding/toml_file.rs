//! TOML files whose keys and values keep their places.

use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::{Place, in_words};

/// A value together with the place in the file where it is written.
///
/// A value that was made in a program has no place: its line is 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Line, from 1; 0 without a place.
    pub line: usize,
    /// Column, from 1; 0 without a place.
    pub column: usize,
}

impl<T> Located<T> {
    /// The place of the value in a file; the whole file for a value that was made in a program.
    pub fn place(&self, path: &Path) -> Place {
        Place::at(path, self.line, self.column)
    }

    /// Another value at the same place.
    pub fn with<U>(&self, value: U) -> Located<U> {
        Located { value, line: self.line, column: self.column }
    }
}

impl<T> From<T> for Located<T> {
    fn from(value: T) -> Self {
        Self { value, line: 0, column: 0 }
    }
}

impl<T: PartialEq> PartialEq for Located<T> {
    /// Equal values: where they are written makes no difference.
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

/// What is wrong in a TOML file, and where.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TomlError {
    /// Position of the key or value.
    pub place: Place,
    /// What was found and expected, in one line.
    pub message: String,
}

/// A parsed file.
#[derive(Debug)]
pub(crate) struct TomlFile<'t> {
    path: &'t Path,
    text: &'t str,
    /// Where each line begins (bytes): a place is asked for every value of a file of many tables.
    lines: Vec<usize>,
    root: Spanned<DeValue<'t>>,
}

/// A value of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node<'f> {
    file: &'f TomlFile<'f>,
    value: &'f Spanned<DeValue<'f>>,
}

impl<'t> TomlFile<'t> {
    /// Parses the text of a file; `path` names it in places.
    ///
    /// # Errors
    /// What is no TOML, at its position.
    pub fn parse(path: &'t Path, text: &'t str) -> Result<Self, TomlError> {
        let table = DeTable::parse(text).map_err(|e| at_position(path, text, &e))?;
        let root = Spanned::new(0..text.len(), DeValue::Table(table.into_inner()));
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Ok(Self { path, text, lines, root })
    }

    /// The file's table.
    pub fn root(&self) -> Node<'_> {
        Node { file: self, value: &self.root }
    }
}

impl<'f> Node<'f> {
    fn entry(&self, key: &str) -> Option<(&'f Spanned<std::borrow::Cow<'f, str>>, Node<'f>)> {
        let (key, value) = self.value.get_ref().as_table()?.get_key_value(key)?;
        Some((key, Self { file: self.file, value }))
    }

    /// The value of a key of this table.
    pub fn get(&self, key: &str) -> Option<Self> {
        self.entry(key).map(|(_, value)| value)
    }

    /// Whether this table has a key.
    pub fn has(&self, key: &str) -> bool {
        self.entry(key).is_some()
    }

    /// The items of this array; none of other values.
    pub fn items(&self) -> impl Iterator<Item = Self> {
        let items = self.value.get_ref().as_array();
        items.into_iter().flat_map(|array| array.iter()).map(|value| Self { file: self.file, value })
    }

    /// The text of this value, if it is one.
    pub fn text(&self) -> Option<&'f str> {
        self.value.get_ref().as_str()
    }

    /// Where this value is written; a table at its head, the table of the file nowhere in particular.
    pub fn place(&self) -> Place {
        if std::ptr::eq(self.value, &raw const self.file.root) {
            return Place::file(self.file.path);
        }
        self.at(self.value.span().start)
    }

    /// Where a key of this table is written; the table's place without it.
    pub fn key_place(&self, key: &str) -> Place {
        self.entry(key).map_or_else(|| self.place(), |(key, _)| self.at(key.span().start))
    }

    /// Where the value of a key of this table is written; the table's place without it.
    pub fn value_place(&self, key: &str) -> Place {
        self.get(key).map_or_else(|| self.place(), |value| value.place())
    }

    /// A value with the place of this one.
    pub fn located<T>(&self, value: T) -> Located<T> {
        let Place { line, column, .. } = self.place();
        Located { value, line, column }
    }

    /// A value with the place of the value of a key; the table's place without it.
    pub fn located_at<T>(&self, key: &str, value: T) -> Located<T> {
        self.get(key).unwrap_or(*self).located(value)
    }

    /// Reads a type from this value.
    ///
    /// # Errors
    /// What does not fit, at its key or value.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, TomlError> {
        self.read_from(self.value.clone())
    }

    /// Reads a type from this table as if it had not got a key.
    ///
    /// # Errors
    /// What does not fit, at its key or value.
    pub fn read_without<T: DeserializeOwned>(&self, key: &str) -> Result<T, TomlError> {
        let mut value = self.value.clone();
        if let DeValue::Table(table) = value.get_mut() {
            table.remove(key);
        }
        self.read_from(value)
    }

    fn read_from<T: DeserializeOwned>(&self, value: Spanned<DeValue<'f>>) -> Result<T, TomlError> {
        let read = T::deserialize(ValueDeserializer::from(value));
        read.map_err(|e| at_position(self.file.path, self.file.text, &e))
    }

    /// An error at this value.
    pub fn error(&self, message: impl Into<String>) -> TomlError {
        TomlError { place: self.place(), message: message.into() }
    }

    fn at(&self, offset: usize) -> Place {
        let line = self.file.lines.partition_point(|start| *start <= offset);
        let start = self.file.lines[line.saturating_sub(1)];
        let column = self.file.text.get(start..offset).map_or(0, |before| before.chars().count()) + 1;
        Place::at(self.file.path, line, column)
    }
}

/// A table or value that a reader of the whole file passes over, as it is read on its own.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ReadLater;

impl<'de> Deserialize<'de> for ReadLater {
    fn deserialize<D: serde::Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        serde::de::IgnoredAny::deserialize(d).map(|_| Self)
    }
}

fn at_position(path: &Path, text: &str, error: &toml::de::Error) -> TomlError {
    let (line, column) = position(text, error.span().map_or(0, |span| span.start));
    TomlError { place: Place::at(path, line, column), message: in_words(error) }
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

    const FILE: &str = "title = \"µ\"\n[sheet]\nshape = \"disc\"\n[[loads]]\nkind = \"a\"\n[[loads]]\n\
                        kind = \"b\"\nsizes = [1, 2, \"3\"]\nof = { x = 1, y = 2 }\n";

    fn shown(place: &Place) -> String {
        place.to_string()
    }

    #[test]
    fn keys_and_values_are_found_where_they_stand() {
        let path = Path::new("c.toml");
        let file = TomlFile::parse(path, FILE).unwrap();
        let root = file.root();
        assert_eq!(shown(&root.place()), "c.toml");
        assert_eq!(shown(&root.key_place("title")), "c.toml:1:1");
        assert_eq!(shown(&root.value_place("title")), "c.toml:1:9");
        let sheet = root.get("sheet").unwrap();
        assert_eq!(shown(&sheet.place()), "c.toml:2:1");
        assert_eq!(shown(&sheet.key_place("shape")), "c.toml:3:1");
        assert_eq!(shown(&sheet.value_place("shape")), "c.toml:3:9");
        assert_eq!(shown(&sheet.key_place("cells")), "c.toml:2:1", "what is missing is missing in the table");
        let loads: Vec<Node<'_>> = root.get("loads").unwrap().items().collect();
        assert_eq!(shown(&loads[1].place()), "c.toml:6:1");
        assert_eq!(shown(&loads[1].value_place("kind")), "c.toml:7:8");
        assert_eq!(shown(&loads[1].get("of").unwrap().value_place("y")), "c.toml:9:19");
        assert_eq!(loads[1].located_at("kind", ()).column, 8);
        assert!(root.has("loads") && !root.has("supports"));
    }

    #[test]
    fn what_does_not_fit_is_found_inside_of_a_table() {
        let path = Path::new("c.toml");
        let file = TomlFile::parse(path, FILE).unwrap();
        let second = file.root().get("loads").unwrap().items().nth(1).unwrap();
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Load {
            #[allow(dead_code)]
            sizes: Vec<u8>,
            #[allow(dead_code)]
            of: ReadLater,
        }
        let place = |e: TomlError| e.place.to_string();
        assert_eq!(place(second.read_without::<Load>("kind").unwrap_err()), "c.toml:8:16");
        assert_eq!(place(second.read::<Load>().unwrap_err()), "c.toml:7:1", "an unknown key");
        let file = TomlFile::parse(path, "[a]\nb = 1\n[a.c]\n").unwrap();
        let error = file.root().get("a").unwrap().read_without::<Load>("b").unwrap_err();
        assert_eq!(place(error), "c.toml:3:4", "an unknown table");
        assert_eq!(TomlFile::parse(path, "a = \n").unwrap_err().place.to_string(), "c.toml:1:5");
    }
}
