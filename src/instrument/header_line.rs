//! What a header line says: `key,value`, `key: value`, several pairs, or a list of values.

use super::caption::{is_number_of_table, is_of_no_values};
use super::dialect::HeaderKey;
use super::header::Entry;
use super::layout::Scanner;
use super::numbered;
use super::raw::Row;
use super::sniff::{Number, number};
use super::unit_text::{split_unit, unit};
use super::volts;
use super::words::{bare, folded};

impl Scanner<'_, '_> {
    /// Keeps what a header line says.
    pub(super) fn header_line(&mut self, row: &Row<'_>) {
        let filled: Vec<(String, usize)> =
            row.filled().map(|(_, c)| (folded(&c.text).into_owned(), c.column)).collect();
        let vocabulary = self.context.vocabulary;
        let key_of = |text: &str| vocabulary.key(&split_unit(text.trim_start_matches('#')).0);
        let keys: Vec<HeaderKey> = filled.iter().filter_map(|(t, _)| key_of(t)).collect();
        // `試料番号,1,試料番号,2`: one value for each column block.
        if let [first, rest @ ..] = &keys[..]
            && !rest.is_empty()
            && !matches!(first, HeaderKey::Remark | HeaderKey::Circumstance)
            && filled.len() == 2 * keys.len()
            && rest.iter().all(|k| k == first)
        {
            let entry = |(text, column): &(String, usize)| Entry {
                text: text.clone(),
                line: row.line,
                column: *column,
            };
            self.lists.push((*first, filled.iter().skip(1).step_by(2).map(entry).collect()));
            return;
        }
        let mut i = 0;
        while i < filled.len() {
            let (cell, column) = &filled[i];
            // `key: value` in one cell, and no time such as `9:05`.
            let is_entry = |(name, value): &(&str, &str)| {
                let is_time = name.ends_with(|c: char| c.is_ascii_digit())
                    && value.starts_with(|c: char| c.is_ascii_digit());
                !value.trim().is_empty() && !is_time
            };
            if let Some((name, value)) = cell.split_once([':', '=']).filter(is_entry) {
                let offset = cell.chars().count() - value.trim_start().chars().count();
                self.keep(name, vec![(value.trim().to_string(), column + offset)], row.line);
                i += 1;
                continue;
            }
            if filled.len() == 1
                && let Some((name, number, offset)) = numbered::specimen(cell, vocabulary)
            {
                self.keep(name, vec![(number.to_string(), column + offset)], row.line);
                return;
            }
            let more = filled[i + 1..].iter().take_while(|(t, _)| key_of(t).is_none()).count();
            // The first value may be spelt like a key (`direction,width`).
            let count = if more == 0 && i + 1 < filled.len() { 1 } else { more };
            self.keep(cell, filled[i + 1..i + 1 + count].to_vec(), row.line);
            i += 1 + count;
        }
    }

    fn keep(&mut self, name: &str, mut values: Vec<(String, usize)>, line: usize) {
        if let Some(repeats) = numbered::repeats(name, &values) {
            self.header.repeats = Some(repeats);
            // `Standard deviations (n = 5)`.
            let title = name.trim_end().trim_end_matches(['n', 'N']).trim_end_matches([' ', '(', '[', ',']);
            if is_of_no_values(title, self.context.vocabulary) {
                (self.header.caption, self.caption_line) = (Some(title.to_string()), line);
            }
        }
        let name = name.trim_start_matches('#');
        let (plain, own_unit) = split_unit(name);
        let plain = bare(&plain);
        // `width,20,cm` and `幅(cm),20`: the unit goes with the number.
        let is_number = |t: &str| matches!(number(t, self.context.decimal), Number::Value(_));
        if let [(value, _), (unit_text, _)] = &values[..]
            && is_number(value)
            && !is_number(unit_text)
            && unit(unit_text).is_ok()
        {
            values = vec![(format!("{value} {unit_text}"), values[0].1)];
        }
        if let (Some(inside), [(value, _)]) = (&own_unit, &mut values[..]) {
            if is_number(value) {
                *value = format!("{value} {inside}");
            } else if self.context.vocabulary.key(&plain) == Some(HeaderKey::Size) {
                *value = format!("{value} ({inside})"); // `(L x W)`, `(cm)`
            }
        }
        let entry = |(text, column): (String, usize)| Entry { text, line, column };
        // "Sens" is a range in English and the direction in French: the value tells.
        let is_direction = |t: &str| self.context.vocabulary.direction_exactly(t).is_some();
        let key = match (self.context.vocabulary.key(&plain), &values[..]) {
            (Some(HeaderKey::Sens), [(value, _)]) if is_direction(value) => Some(HeaderKey::Direction),
            // `Full scale: 5 V` is that of the output; `Output: report.csv` is none.
            (Some(HeaderKey::Sens), [(value, _)]) if volts::value(value).is_some() => {
                Some(HeaderKey::Voltage)
            }
            (Some(HeaderKey::Voltage), values) if !values.iter().any(|(v, _)| volts::value(v).is_some()) => {
                None
            }
            (key, _) => key,
        };
        // A bracket of a line without a value is no unit: `Bending results (values x 10)`, `Wool (wet)`.
        let words = if values.is_empty() { bare(name) } else { plain.clone() };
        self.note_factor(key, &words, &values, line);
        match (key, values.len()) {
            (Some(HeaderKey::Remark | HeaderKey::Circumstance | HeaderKey::Factor) | None, _) => {
                let text: Vec<String> = values.into_iter().map(|(t, _)| t).collect();
                if text.is_empty() {
                    self.header.caption = Some(words);
                    self.caption_line = line;
                } else if is_number_of_table(name, self.context.vocabulary) {
                    self.header.caption = Some(format!("{name}: {}", text.join(", ")));
                    self.caption_line = line;
                }
                self.header.other.insert(plain, text.join(", "));
            }
            (Some(_), 0) => {}
            (Some(key), 1) => {
                for value in values {
                    let entry = entry(value);
                    self.note_contradiction(key, &entry);
                    if key == HeaderKey::Direction {
                        self.note_more_than_direction(&entry);
                    }
                    self.header.known.insert(key, entry);
                }
            }
            (Some(key), _) => self.lists.push((key, values.into_iter().map(entry).collect())),
        }
    }
}
