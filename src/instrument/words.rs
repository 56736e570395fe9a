//! Words to meanings: normalisation, vocabulary, headings and their units, labels.

use std::borrow::Borrow;
use std::collections::BTreeMap;

use unicode_normalization::UnicodeNormalization;
use unicode_normalization::char::is_combining_mark;

use super::dialect::{Dialect, Key, Role, Statistic, TableColumn, dialects};
use super::error::Problem;
use super::sniff::folded;
use super::{Direction, Parameter, Test};
use crate::quantity::{QuantityError, Unit};

/// A word as it is compared: NFKC, lower case, without Latin accents, blanks and punctuation.
pub(super) fn normalised(text: &str) -> String {
    if text.is_ascii() {
        return text.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect();
    }
    // Only accents of the Latin block go: the voicing marks of kana are part of the word.
    text.nfkd()
        .filter(|c| !(is_combining_mark(*c) && *c < '\u{370}'))
        .nfc()
        .filter(|c| c.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

/// The words of the user's dialects, then of the built-in ones.
#[derive(Clone, Copy)]
pub(super) struct Vocabulary<'a> {
    user: &'a [Dialect],
}

impl<'a> Vocabulary<'a> {
    pub fn new(user: &'a [Dialect]) -> Self {
        Self { user }
    }

    pub fn dialects(self) -> impl Iterator<Item = &'a Dialect> {
        self.user.iter().chain(dialects())
    }

    /// The meaning of a word: exactly, else that of the longest known word within it.
    fn find<K: 'a + Clone>(
        self,
        text: &str,
        inside: bool,
        map: impl Fn(&'a Dialect) -> &'a BTreeMap<K, Vec<String>>,
    ) -> Option<K> {
        let word = normalised(text);
        if word.is_empty() {
            return None;
        }
        let entries = || self.dialects().flat_map(&map).flat_map(|(k, v)| v.iter().map(move |w| (k, w)));
        if let Some((key, _)) = entries().find(|(_, w)| **w == word) {
            return Some(key.clone());
        }
        let long_enough = |w: &str| if w.is_ascii() { w.len() >= 4 } else { !w.is_empty() };
        entries()
            .filter(|(_, w)| inside && long_enough(w) && word.contains(w.as_str()))
            .max_by_key(|(_, w)| w.chars().count())
            .map(|(key, _)| key.clone())
    }

    pub fn role(self, name: &str) -> Option<Role> {
        self.find(name, true, |d| &d.columns)
    }

    pub fn key(self, name: &str) -> Option<Key> {
        self.find(name, false, |d| &d.keys)
    }

    pub fn direction(self, text: &str) -> Option<Direction> {
        self.find(text, true, |d| &d.directions)
    }

    pub fn test(self, text: &str) -> Option<Test> {
        // "KES-FB1 せん断": the longest word decides, and FB1 alone decides nothing.
        let word = normalised(text);
        self.find(&word, true, |d| &d.tests).or_else(|| {
            let instrument = [("fb2", Test::Bending), ("fb3", Test::Compression)];
            instrument.into_iter().find(|(w, _)| word.contains(w)).map(|(_, t)| t)
        })
    }

    pub fn table_column(self, name: &str) -> Option<TableColumn> {
        self.find(name, false, |d| &d.table)
    }

    /// How a label says that a row or column sums up others: the whole label, and no word within it.
    pub fn statistic(self, label: &str) -> Option<Statistic> {
        // Most labels are numbers.
        if label.trim_start().starts_with(|c: char| c.is_ascii_digit()) {
            return None;
        }
        self.find(label, false, |d| &d.statistics)
    }

    /// The same for a heading, in which the word stands among others: `mean moment`, `曲げモーメント平均`.
    pub fn statistic_within(self, heading: &str) -> Option<Statistic> {
        let text = folded(heading).into_owned();
        let parts: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).filter(|p| !p.is_empty()).collect();
        // `standard deviation` and `coefficient of variation`; one letter is a unit or a number.
        let windows = (1..=3).flat_map(|n| parts.windows(n)).map(|w| w.join(" "));
        let mut named = windows.filter(|w| w.chars().count() > 1).filter_map(|w| self.statistic(&w));
        if let Some(statistic) = named.next() {
            return Some(statistic);
        }
        if text.is_ascii() {
            return None;
        }
        // Japanese has no blanks between words.
        let word = normalised(&text);
        let within = |w: &String| !w.is_ascii() && w.chars().count() > 1 && word.contains(w.as_str());
        let mut all = self.dialects().flat_map(|d| &d.statistics);
        all.find(|(_, words)| words.iter().any(within)).map(|(statistic, _)| *statistic)
    }

    pub fn parameter(self, name: &str) -> Option<Parameter> {
        Parameter::from_symbol(name).or_else(|| {
            self.find(name, false, |d| &d.symbols).and_then(|s| Parameter::from_symbol(s.borrow()))
        })
    }

    /// Every dialect with those of the words that it does not know, the closest first.
    pub fn closest(self, words: &[String]) -> Vec<(String, Vec<String>)> {
        let words: Vec<(&String, String)> = words.iter().map(|w| (w, normalised(&split_unit(w).0))).collect();
        let unknown = |d: &Dialect| -> Vec<String> {
            let knows = |word: &str| d.vocabulary().any(|v| v == word);
            words.iter().filter(|(_, word)| !knows(word)).map(|(w, _)| (*w).clone()).collect()
        };
        let mut found: Vec<_> = self.dialects().map(|d| (d.name.clone(), unknown(d))).collect();
        // A stable sort: among equals the user's, then the first built-in one.
        found.sort_by_key(|(_, unknown)| unknown.len());
        found
    }
}

/// A heading split into its name and the unit text, if it has one: `name (unit)`, `name [unit]`,
/// `name/unit`, `name, unit` or `name unit`.
pub(super) fn split_unit(cell: &str) -> (String, Option<String>) {
    let text = folded(cell).replace('[', "(").replace(']', ")");
    if let Some(open) = text.ends_with(')').then(|| matching_open(&text)).flatten() {
        let inner = text[open + 1..text.len() - 1].trim().to_string();
        // "1/(cm)": the bracket belongs to the unit, not to a name.
        if !inner.is_empty() && open > 0 && !text[..open].trim_end().ends_with(['/', '·']) {
            return (text[..open].trim().to_string(), Some(inner));
        }
    }
    // A bracket that was lost took something with it: "moment (gf·cm/N" is no moment in N.
    if text.matches('(').count() != text.matches(')').count() {
        return (text, None);
    }
    for (i, c) in text.char_indices().filter(|(_, c)| matches!(c, ' ' | '/' | ',' | ':' | '_')) {
        let rest = text[i + c.len_utf8()..].trim();
        let name = text[..i].trim();
        if !name.is_empty()
            && !rest.starts_with(|c: char| c.is_ascii_digit())
            && (is_volt(rest) || unit(rest).is_ok())
        {
            return (name.to_string(), Some(rest.to_string()));
        }
    }
    (text, None)
}

fn matching_open(text: &str) -> Option<usize> {
    let mut depth = 0;
    for (i, c) in text.char_indices().rev() {
        match c {
            ')' => depth += 1,
            '(' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(i);
        }
    }
    None
}

/// Spellings of units that occur in headings and that the unit table rightly refuses elsewhere.
const SPELLINGS: &[(&str, &str)] = &[
    ("gf/cm·deg", "gf/(cm·deg)"),
    ("gf/cm°", "gf/(cm·deg)"),
    ("gf/cm·°", "gf/(cm·deg)"),
    ("n/m·deg", "N/(m·deg)"),
    ("percent", "%"),
    ("degrees", "deg"),
    ("deg.", "deg"),
    ("度", "deg"),
    ("micron", "um"),
    ("-", "1"),
];

/// The unit of a heading: the unit table, and the spellings of G that print uses.
pub(super) fn unit(text: &str) -> Result<Unit, QuantityError> {
    Unit::parse(text).or_else(|error| {
        let plain =
            folded(text).to_lowercase().replace(['*', '⋅', '・', ' '], "·").replace("cm.deg", "cm·deg");
        match SPELLINGS.iter().find(|(spelling, _)| *spelling == plain) {
            Some((_, meant)) => Unit::parse(meant),
            None => Err(error),
        }
    })
}

/// [`unit`] with the error of the readers.
pub(super) fn known_unit(text: &str) -> Result<Unit, Problem> {
    unit(text).map_err(|e| Problem::UnitUnknown { reason: e.to_string() })
}

/// Volts of an analogue output; not in the unit table, since they only mean something with a range.
pub(super) fn is_volt(text: &str) -> bool {
    matches!(text, "V" | "mV")
}

/// A number from here on does not count specimens.
pub(super) const SPECIMENS: usize = 10_000;

/// Metadata in a file name or over a block of columns: `F01_warp_FB2_1`, `経-1`, `タテ`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Label {
    pub sample: Option<String>,
    pub test: Option<Test>,
    pub direction: Option<Direction>,
    pub specimen: Option<usize>,
}

impl Label {
    /// Reads what the parts of a text mean; unknown parts before the first known one are the sample.
    pub fn parse(text: &str, vocabulary: Vocabulary<'_>) -> Self {
        let mut label = Self::default();
        let mut sample: Vec<&str> = Vec::new();
        let text = folded(text).into_owned();
        for part in text.split(|c: char| !c.is_alphanumeric()).filter(|p| !p.is_empty()) {
            let known = label.take(part, vocabulary) || label.take_with_number(part, vocabulary);
            let first = label == Self::default();
            if !known && first {
                sample.push(part);
            }
        }
        label.sample = (!sample.is_empty()).then(|| sample.join("-"));
        label
    }

    /// `self` where it says something, else `other`; the sample is a file name's, not a sheet's.
    pub fn or(self, other: Self) -> Self {
        Self {
            sample: other.sample,
            test: self.test.or(other.test),
            direction: self.direction.or(other.direction),
            specimen: self.specimen.or(other.specimen),
        }
    }

    fn take(&mut self, part: &str, vocabulary: Vocabulary<'_>) -> bool {
        if let Some(direction) = vocabulary.find(part, false, |d| &d.directions) {
            self.direction = self.direction.or(Some(direction));
        } else if let Some(test) = vocabulary.find(part, false, |d| &d.tests) {
            self.test = self.test.or(Some(test));
        } else if !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()) {
            // A longer number is a date or an order.
            self.specimen = part.parse().ok().filter(|n| *n < SPECIMENS).or(self.specimen);
        } else {
            let word = normalised(part);
            return matches!(word.as_str(), "kes" | "kesf" | "fb1" | "no")
                || vocabulary.key(part) == Some(Key::Specimen);
        }
        true
    }

    /// `経1`, `warp2`: a direction or "specimen" with a number behind it.
    fn take_with_number(&mut self, part: &str, vocabulary: Vocabulary<'_>) -> bool {
        let word = part.trim_end_matches(|c: char| c.is_ascii_digit());
        let known = word != part
            && (vocabulary.find(word, false, |d| &d.directions).is_some()
                || vocabulary.key(word) == Some(Key::Specimen));
        known && self.take(word, vocabulary) && self.take(&part[word.len()..], vocabulary)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: Vocabulary<'static> = Vocabulary { user: &[] };

    #[test]
    fn words_are_compared_without_case_width_accents_and_blanks() {
        assert_eq!(normalised("Direção do Ensaio"), "direcaodoensaio");
        assert_eq!(normalised("ｶﾞｰｾﾞ"), normalised("ガーゼ"));
        assert_eq!(normalised("Specimen No."), "specimenno");
        assert_eq!(WORDS.role("曲げモーメント"), Some(Role::Moment));
        assert_eq!(WORDS.role("Bending moment per width"), Some(Role::Moment));
        assert_eq!(WORDS.role("força"), Some(Role::Force));
        assert_eq!(WORDS.role("せん断力"), Some(Role::ShearForce));
        assert_eq!(WORDS.test("KES-FB1 せん断"), Some(Test::Shear));
        assert_eq!(WORDS.test("KES-FB2"), Some(Test::Bending));
        assert_eq!(WORDS.test("KES-FB1"), None);
        assert_eq!(WORDS.direction("経方向"), Some(Direction::Warp));
        assert_eq!(WORDS.parameter("2hb"), Some(Parameter::Hb));
        assert_eq!(WORDS.parameter("目付"), Some(Parameter::W));
    }

    #[test]
    fn labels_and_headings_of_statistics() {
        use Statistic::{Mean, Other, Spread};
        for (label, expected) in [
            ("Mean:", Some(Mean)),
            ("ＡＶＧ．", Some(Mean)),
            ("média", Some(Mean)),
            ("Std. Dev.", Some(Spread)),
            ("CV %", Some(Spread)),
            ("écart-type", Some(Spread)),
            ("最大値", Some(Other)),
            ("n", Some(Other)),
            ("Mean of Anna", None),
            ("12", None),
            ("", None),
        ] {
            assert_eq!(WORDS.statistic(label), expected, "{label}");
        }
        for (heading, expected) in [
            ("mean moment", Some(Mean)),
            ("moment_avg", Some(Mean)),
            ("standard deviation of the moment", Some(Spread)),
            ("曲げモーメント平均", Some(Mean)),
            ("moment 1", None),
            ("momentum", None),
            ("force n", None),
            ("maxwell force", None),
        ] {
            assert_eq!(WORDS.statistic_within(heading), expected, "{heading}");
        }
    }

    #[test]
    fn headings_are_split_from_their_units() {
        let split = |t| split_unit(t);
        let pair = |n: &str, u: &str| (n.to_string(), Some(u.to_string()));
        assert_eq!(split("curvature (1/cm)"), pair("curvature", "1/cm"));
        assert_eq!(split("荷重(ｇｆ/㎝)"), pair("荷重", "gf/cm"));
        assert_eq!(split("G [gf/(cm·deg)]"), pair("G", "gf/(cm·deg)"));
        assert_eq!(split("force gf/cm"), pair("force", "gf/cm"));
        assert_eq!(split("strain/%"), pair("strain", "%"));
        assert_eq!(split("bending moment"), ("bending moment".to_string(), None));
        assert_eq!(split("moment (gf·cm/N").1, None);
        assert_eq!(split("force (front) gf/cm"), pair("force (front)", "gf/cm"));
        assert!((unit("gf/cm·deg").unwrap().factor - 56.187_965_62).abs() < 1e-8);
        assert!((unit("gf/cm*deg").unwrap().factor - 56.187_965_62).abs() < 1e-8);
    }

    #[test]
    fn file_names_carry_metadata() {
        let label = |t| Label::parse(t, WORDS);
        let l = label("F01_warp_FB2_1");
        assert_eq!(l.sample.as_deref(), Some("F01"));
        assert_eq!((l.test, l.direction, l.specimen), (Some(Test::Bending), Some(Direction::Warp), Some(1)));
        assert_eq!((label("経-1").direction, label("経-1").specimen), (Some(Direction::Warp), Some(1)));
        assert_eq!((label("タテ2").direction, label("タテ2").specimen), (Some(Direction::Warp), Some(2)));
        assert_eq!(label("試料番号 3").specimen, Some(3));
        assert_eq!(label("fb1-shear-weft-2").test, Some(Test::Shear));
        assert_eq!(label("poplin_20240105_warp").specimen, None);
        assert_eq!(label("poplin_20240105_warp").sample.as_deref(), Some("poplin"));
    }
}
