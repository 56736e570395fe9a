//! What stands over the columns of curves: rows of labels, and a line that is a direction alone.

use super::dialect::{BranchColumn, HeaderKey};
use super::label::Label;
use super::layout::{Entry, Scanner};
use super::pairs;
use super::raw::{Cell, Row};
use super::unit_text::split_unit;
use super::words::folded;
use crate::finding::{Finding, Place, ReadFact};

impl Scanner<'_, '_> {
    /// A row of labels over column blocks: `1,,2,,3`, `経-1 … 経-2`, `Warp,,Weft` or `試料番号 1 … 試料番号 2`.
    pub(super) fn labels(&mut self, row: &Row<'_>) -> bool {
        let label = |(index, c): (usize, &Cell<'_>)| {
            let entry = Entry { text: folded(&c.text).into_owned(), line: row.line, column: c.column };
            (index, Label::parse(&c.text, self.context.vocabulary), entry)
        };
        let labels: Vec<(usize, Label, Entry)> = row.filled().map(label).collect();
        let is_mean = |e: &Entry| pairs::of_label(&e.text, self.context.vocabulary).is_some();
        let are_branches = self.are_branches(&labels);
        // Specimens and directions come first: `maximum,2.5 1/cm` is a header line, and so is `direction,warp`.
        let is_key = labels.first().is_some_and(|(_, _, e)| self.context.vocabulary.key(&e.text).is_some());
        // `width,20`: a key, and not the direction of that name.
        let complete = !is_key
            && (are_branches
                || labels.first().is_some_and(|(_, l, _)| l.is_plain())
                    && labels.iter().all(|(_, l, e)| l.is_plain() || is_mean(e)));
        let below = || self.rows[self.at + 1..].iter().filter(|r| !r.is_blank()).take(2);
        if labels.len() < 2 || !below().any(|r| self.headings(r).is_some()) {
            return false;
        }
        if !complete {
            let key = |e: &Entry| self.context.vocabulary.key(&split_unit(&e.text).0);
            let is_name = |(_, l, e): &(usize, Label, Entry)| {
                (l.sample.is_some() || l.unknown) && key(e).is_none_or(|k| k == HeaderKey::Remark)
            };
            // `X1,,X2,` and `X1,X1,X2,X2`: names over blocks of columns, a blank beside each or the name again.
            let blocks = blocks(&labels);
            let over_blocks = blocks.len() > 1 && blocks.windows(2).all(|pair| pair[1].0 > pair[0].0 + 1);
            if over_blocks && labels.iter().all(is_name) {
                let names = blocks.iter().map(|(_, name)| (*name).to_string()).collect();
                let place = Place::at(self.context.path, row.line, 0);
                self.findings.push(Finding::new(ReadFact::ColumnsAsSpecimens { names }).at(place));
            }
            return false;
        }
        self.labels.push(labels);
        true
    }

    /// `Loading,,Unloading,`, again and again: the branches of records whose columns stand beside each other.
    fn are_branches(&self, labels: &[(usize, Label, Entry)]) -> bool {
        let branches: Vec<_> =
            labels.iter().map(|(_, _, e)| self.context.vocabulary.branch(&e.text)).collect();
        let is_pair = |pair: &[Option<BranchColumn>]| {
            pair.contains(&Some(BranchColumn::Loading)) && pair.contains(&Some(BranchColumn::Unloading))
        };
        !branches.is_empty() && branches.chunks(2).all(is_pair)
    }

    /// `Weft direction` or `** WARP **` right above the headings is the direction of the record below.
    pub(super) fn direction_above(&mut self) {
        let Some(text) = self.header.caption.clone() else { return };
        let (line, column) = (self.caption_line, 1);
        let vocabulary = self.context.vocabulary;
        let label = Label::parse(&text, vocabulary);
        let alone = label.is_plain() && label.test.is_none();
        let direction = vocabulary.direction_exactly(&text).or(label.direction.filter(|_| alone));
        let Some(direction) = direction else { return };
        let entry = Entry { text: direction.to_string(), line, column };
        self.note_contradiction(HeaderKey::Direction, &entry);
        self.header.known.insert(HeaderKey::Direction, entry);
        if let Some(number) = label.specimen.filter(|_| alone) {
            self.header.known.insert(HeaderKey::Specimen, Entry { text: number.to_string(), line, column });
        }
        self.header.caption = None;
    }
}

/// Labels and their places, where equal neighbours are one over a block of columns.
fn blocks(labels: &[(usize, Label, Entry)]) -> Vec<(usize, &str)> {
    let mut out: Vec<(usize, &str)> = Vec::new();
    for (i, (index, _, entry)) in labels.iter().enumerate() {
        let again = i > 0 && labels[i - 1].0 + 1 == *index && labels[i - 1].2.text == entry.text;
        if !again {
            out.push((*index, &entry.text));
        }
    }
    out
}
