//! What bounds ask of a library that it does not have, and which bounds would pass over in silence.

use std::collections::{BTreeMap, BTreeSet};

use arrow_array::cast::AsArray;
use arrow_array::{Array, RecordBatch};
use serde::Serialize;

use super::bounds::Bounds;

/// A column with more texts than these, such as that of the names, is not told as a list.
const FEW: usize = 12;

/// A text that bounds compare a column with, and that no fabric has there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct NoSuchText {
    /// The column.
    pub column: String,
    /// The text.
    pub text: String,
    /// The texts that there are, if they are few.
    pub known: Vec<String>,
}

/// What is counted while the rows of a library go by.
#[derive(Debug)]
pub(super) struct Census<'b> {
    bounds: Option<&'b Bounds>,
    without_value: BTreeMap<&'b str, usize>,
    found: BTreeSet<(&'b str, &'b str)>,
    known: BTreeMap<&'b str, BTreeSet<String>>,
}

impl<'b> Census<'b> {
    /// Of the columns of bounds.
    pub fn new(bounds: Option<&'b Bounds>) -> Self {
        let (without_value, found, known) = (BTreeMap::new(), BTreeSet::new(), BTreeMap::new());
        Self { bounds, without_value, found, known }
    }

    /// Counts some rows.
    pub fn add(&mut self, piece: &RecordBatch) {
        for name in self.bounds.iter().flat_map(|bounds| bounds.columns()) {
            let missing = piece.column_by_name(name).map_or(0, |column| column.null_count());
            *self.without_value.entry(name).or_default() += missing;
        }
        for (name, wanted) in self.bounds.iter().flat_map(|bounds| bounds.texts()) {
            let column = piece.column_by_name(name).and_then(|column| column.as_string_opt::<i32>());
            let known = self.known.entry(name).or_default();
            for text in column.into_iter().flat_map(|texts| texts.iter().flatten()) {
                if text == wanted {
                    self.found.insert((name, wanted));
                }
                if known.len() <= FEW && !known.contains(text) {
                    known.insert(text.into());
                }
            }
        }
    }

    /// How many fabrics have no value in a column of the bounds, by its name.
    pub fn without_value(&self) -> BTreeMap<String, usize> {
        let some = self.without_value.iter().filter(|(_, count)| **count > 0);
        some.map(|(name, count)| ((*name).to_string(), *count)).collect()
    }

    /// Texts of the bounds that no fabric has.
    pub fn no_such_text(&self) -> Vec<NoSuchText> {
        let texts = self.bounds.iter().flat_map(|bounds| bounds.texts());
        let none = texts.filter(|pair| !self.found.contains(pair)).map(|(column, text)| {
            let known = self.known.get(column).filter(|known| known.len() <= FEW);
            let known = known.map_or_else(Vec::new, |known| known.iter().cloned().collect());
            NoSuchText { column: column.into(), text: text.into(), known }
        });
        none.collect()
    }
}
