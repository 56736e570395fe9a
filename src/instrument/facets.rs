//! What a cell of words in a result table says: a parameter, a direction, a number, a statistic, a unit.
//!
//! Laboratories put these in any order and into any cell (`B warp (gf·cm²/cm)`, `Warp-1`, `2HG5_2`, `Weft mean`), so that
//! all cells of words are read alike; where they stand decides later what a value is.

use super::condition;
use super::dialect::{Statistic, TableColumn};
use super::fast::{self, FastValue};
use super::status_word;
use super::unit_text::{in_round_brackets, is_scaled, matching_open, split_unit, unit};
use super::vocabulary::{HEADING, Vocabulary};
use super::words::normalised;
use super::{Direction, Parameter};
use crate::kes::ValueStatus;

/// The most words of a name that are looked up together.
const PHRASE: usize = 6;
/// Numbers behind a symbol or a direction count specimens up to here.
const COUNTED: usize = 99;

/// What a cell says.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Facets {
    pub parameter: Option<Parameter>,
    /// A FAST value that is no KES parameter.
    pub fast: Option<FastValue>,
    /// What the column holds, apart from parameters.
    pub meta: Option<TableColumn>,
    pub direction: Option<Direction>,
    pub statistic: Option<Statistic>,
    /// Whether the statistic is the standard deviation.
    pub sd: bool,
    /// A number behind a symbol, a direction or a word for specimens.
    pub index: Option<usize>,
    pub unit: Option<String>,
    /// How many repeats a mean is of, `Mean (n=5)`.
    pub repeats: Option<usize>,
    /// How the value was had, as the words of the cell say.
    pub status: ValueStatus,
    /// Words that mean nothing here: a name, or prose.
    pub unknown: bool,
}

impl Facets {
    /// Reads a cell.
    pub fn of(cell: &str, vocabulary: Vocabulary<'_>) -> Self {
        let text = in_round_brackets(cell);
        let text = without_deviation(&text, vocabulary).unwrap_or(text);
        // `2HG at 0.5°`: a condition that is in the definition of the parameter says nothing new, another one makes it another
        // quantity.
        let whole = Self::of_words(&text, vocabulary);
        let condition = if text.chars().count() <= HEADING { condition::without(&text) } else { None };
        let Some((rest, stated)) = condition else { return whole };
        // A name may hold its condition: `thickness at 50 gf/cm²`.
        let is_plain = whole.index.is_none() && whole.unit.as_ref().is_none_or(|u| unit(u).is_ok());
        if is_plain && whole.names_value() && whole.parameter.is_some_and(|p| stated.defines(p)) {
            // The unit at its end may be that of the condition.
            let unit = whole.unit.clone().filter(|text| !stated.has_unit(text));
            return Self { unit, ..whole };
        }
        let other = Self::of_words(&rest, vocabulary);
        let Some(parameter) = other.parameter else { return whole };
        match stated.defined(parameter, &rest) {
            defined @ Some(_) => Self { parameter: defined, ..other },
            None if !stated.is_of(parameter) => Self { unknown: true, ..Self::default() },
            None => whole,
        }
    }

    fn of_words(text: &str, vocabulary: Vocabulary<'_>) -> Self {
        let mut facets = Self::default();
        if text.is_empty() {
            return facets;
        }
        if text.chars().count() > HEADING || text.matches('(').count() != text.matches(')').count() {
            facets.unknown = true;
            return facets;
        }
        let mut name = text;
        while let Some((before, inner)) = bracket(name) {
            if !facets.take_bracket(inner, vocabulary) {
                break;
            }
            name = before;
        }
        if is_scaled(name) || is_colour(name) {
            facets.unknown = true;
            return facets;
        }
        let (stem, own) = split_unit(name);
        let is_value = |n: &str| vocabulary.parameter(n).is_some() || fast::heading(n).is_some();
        // One letter behind words is part of a name: `Sample N`.
        let long = own.as_ref().is_some_and(|u| u == "%" || u.chars().count() > 1);
        // `B_warp_uN_m` has its unit in several words.
        let in_words =
            own.as_ref().is_some_and(|u| name.strip_suffix(u.as_str()).is_some_and(|n| n.ends_with('_')));
        if facets.unit.is_none() && own.is_some() && !in_words && (long || is_value(&stem)) {
            facets.unit = own;
            name = &stem;
        }
        if !facets.take_whole(name, vocabulary) {
            facets.take_words(name, vocabulary);
        }
        facets
    }

    /// Whether anything at all was understood, and nothing was not.
    pub fn is_clear(&self) -> bool {
        !self.unknown && *self != Self::default()
    }

    /// Whether a value belongs to it.
    pub fn names_value(&self) -> bool {
        !self.unknown && (self.parameter.is_some() || self.fast.is_some())
    }

    /// `self`, completed by what `other` says.
    pub fn or(&self, other: &Self) -> Self {
        Self {
            parameter: self.parameter.or(other.parameter),
            fast: self.fast.or(other.fast),
            meta: self.meta.or(other.meta),
            direction: self.direction.or(other.direction),
            statistic: self.statistic.or(other.statistic),
            sd: self.sd || (self.statistic.is_none() && other.sd),
            index: self.index.or(other.index),
            unit: self.unit.clone().or_else(|| other.unit.clone()),
            repeats: self.repeats.or(other.repeats),
            status: self.status.max(other.status),
            unknown: self.unknown || other.unknown,
        }
    }

    /// A bracket behind a name: a direction, a statistic, a symbol, else a unit, known or not.
    fn take_bracket(&mut self, inner: &str, vocabulary: Vocabulary<'_>) -> bool {
        if let Some(direction) = vocabulary.direction_exactly(inner) {
            self.direction = self.direction.or(Some(direction));
        } else if let Some(repeats) = repeats(inner) {
            self.repeats = self.repeats.or(Some(repeats));
        } else if unit(inner).is_err() && self.take_statistic(inner, vocabulary) {
        } else if let Some(parameter) = vocabulary.parameter(inner).filter(|_| unit(inner).is_err()) {
            self.parameter = self.parameter.or(Some(parameter));
        } else if self.unit.is_none() {
            self.unit = Some(inner.to_string());
        } else {
            return false;
        }
        true
    }

    fn take_statistic(&mut self, text: &str, vocabulary: Vocabulary<'_>) -> bool {
        let Some(statistic) = vocabulary.statistic(text) else { return false };
        self.sd |= self.statistic.is_none()
            && statistic == Statistic::Spread
            && vocabulary.table_column(text) == Some(TableColumn::Sd);
        self.statistic = self.statistic.or(Some(statistic));
        true
    }

    /// The whole name as one word.
    fn take_whole(&mut self, name: &str, vocabulary: Vocabulary<'_>) -> bool {
        let name = name.trim();
        if name.is_empty() {
            return true;
        }
        // `T 40` and `2HG5`: a symbol goes before everything that it contains.
        self.meta = vocabulary.table_column(name);
        if self.take_statistic(name, vocabulary) {
            return true;
        }
        if let Some(parameter) = vocabulary.parameter(name) {
            self.parameter = Some(parameter);
            return true;
        }
        if let Some((value, direction, own)) = fast::heading(name).filter(|_| self.meta.is_none()) {
            self.fast = Some(value);
            self.direction = self.direction.or(direction);
            self.unit = self.unit.take().or(own);
            return true;
        }
        if let Some(direction) = vocabulary.direction_exactly(name) {
            self.direction = self.direction.or(Some(direction));
            return true;
        }
        self.meta.is_some()
    }

    /// Word by word, the longest phrases first.
    fn take_words(&mut self, name: &str, vocabulary: Vocabulary<'_>) {
        let separators = ['_', ' ', '(', ')', '-', ',', ':', '#', '=', '\'', '"'];
        let parts = name.split(separators).filter(|p| !p.is_empty());
        let words: Vec<&str> = parts.flat_map(|w| without_blank(w, vocabulary)).collect();
        let mut rest: Vec<&str> = Vec::new();
        let mut i = 0;
        while i < words.len() {
            let longest = PHRASE.min(words.len() - i);
            let taken = (1..=longest).rev().find(|n| {
                let (before, phrase) = (&words[..i], &words[i..i + n]);
                is_phrase(phrase) && self.take_phrase(before, phrase, vocabulary)
            });
            if taken.is_none() {
                rest.push(words[i]);
            }
            i += taken.unwrap_or(1);
        }
        if rest.is_empty() {
            return;
        }
        let spelt = spelt_out(&rest);
        let joined = rest.join(" ");
        // One letter is no unit of its own, unless it stands where one is looked for: behind a symbol.
        let is_unit =
            (unit(&spelt).is_ok() || unit(&joined).is_ok()) && !(joined == "in" && name.contains(' '));
        if self.parameter.is_some() && self.unit.is_none() && is_unit {
            self.unit = Some(if unit(&spelt).is_ok() { spelt } else { joined });
        } else {
            self.unknown = !self.parameter.is_some_and(|p| vocabulary.belongs_to(&joined, p));
        }
    }

    fn take_phrase(&mut self, before: &[&str], words: &[&str], vocabulary: Vocabulary<'_>) -> bool {
        let phrase = words.join(" ");
        // The symbol says which of two siblings a name stands for: `thickness TM`. Two symbols are two values: `T0-Tm`.
        if let Some(parameter) = vocabulary.parameter(&phrase)
            && self.parameter.is_none_or(|p| {
                p == parameter
                    || (condition::sibling(p) == Some(parameter)
                        && !before.iter().any(|word| word.len() <= 4 && is_symbol(word, vocabulary)))
            })
        {
            self.parameter = Some(parameter);
            return true;
        }
        if let Some(direction) = vocabulary.direction_exactly(&phrase).filter(|_| !is_number(&phrase)) {
            let first = self.direction.is_none_or(|d| d == direction);
            self.direction = Some(direction);
            return first;
        }
        if self.statistic.is_none() && phrase.chars().count() > 1 && self.take_statistic(&phrase, vocabulary)
        {
            return true;
        }
        words.len() == 1 && self.take_word(words[0], vocabulary)
    }

    fn take_word(&mut self, word: &str, vocabulary: Vocabulary<'_>) -> bool {
        let counted = |digits: &str| digits.parse().ok().filter(|n| (1..=COUNTED).contains(n));
        if is_number(word) {
            let new = self.index.is_none();
            self.index = self.index.or(counted(word));
            return new && self.index.is_some();
        }
        // Other words of these meanings may be parts of names here: `B calculated` beside `B`.
        if let "inferred" | "assumed" | "doubtful" = normalised(word).as_str() {
            self.status = self.status.max(status_word::meaning(word).unwrap_or_default());
            return true;
        }
        if vocabulary.table_column(word).is_some_and(TableColumn::counts) {
            return true;
        }
        // `経1`, `B2`, `No.3`.
        let mut stem = word.trim_end_matches(|c: char| c.is_ascii_digit());
        // The longest symbol: `2HG51` is the first 2HG5.
        let longer = |end: &usize| vocabulary.parameter(&word[..*end]).is_some();
        if let Some(end) = (stem.len() + 1..word.len()).rev().find(longer) {
            stem = &word[..end];
        }
        let digits = &word[stem.len()..];
        let Some(n) = (if stem.is_empty() { None } else { counted(digits) }) else { return false };
        let stem = stem.trim_end_matches('.');
        let known = match (vocabulary.direction_exactly(stem), vocabulary.parameter(stem)) {
            (Some(direction), _) => {
                self.direction = self.direction.or(Some(direction));
                true
            }
            (_, Some(parameter)) if self.parameter.is_none() => {
                self.parameter = Some(parameter);
                true
            }
            _ => vocabulary.table_column(stem).is_some_and(TableColumn::counts),
        };
        if known && self.index.is_none() {
            self.index = Some(n);
        }
        known
    }
}

/// `LT mean ± SD` and `LT mean (SD)` without the deviation, which stands beside each number; none of other heads.
fn without_deviation(text: &str, vocabulary: Vocabulary<'_>) -> Option<String> {
    if text.chars().count() > HEADING {
        return None;
    }
    if let Some((before, behind)) = ["±", "+/-"].iter().find_map(|mark| text.split_once(mark)) {
        let (word, rest) = behind.split_at(behind.find(['(', ')', ',']).unwrap_or(behind.len()));
        return is_deviation(word, vocabulary).then(|| format!("{}{rest}", before.trim_end()));
    }
    let (before, inner) = bracket(text)?;
    let mut words = before.split([' ', '_', '-', '(']);
    (is_deviation(inner, vocabulary) && words.any(|word| vocabulary.statistic(word) == Some(Statistic::Mean)))
        .then(|| before.to_string())
}

fn is_deviation(word: &str, vocabulary: Vocabulary<'_>) -> bool {
    vocabulary.statistic(word) == Some(Statistic::Spread)
        || vocabulary.table_column(word) == Some(TableColumn::Sd)
}

/// The number of repeats in `n=5`.
pub(super) fn repeats(text: &str) -> Option<usize> {
    let number = text.trim().strip_prefix(['n', 'N'])?.trim_start().strip_prefix('=')?;
    number.trim().parse().ok().filter(|n| *n > 0)
}

/// Whether the ends of a phrase are words: a sign there, such as `%`, would be swallowed with it.
fn is_phrase(words: &[&str]) -> bool {
    let ends = [words.first(), words.last()];
    words.len() == 1 || ends.into_iter().flatten().all(|word| word.contains(char::is_alphanumeric))
}

fn is_wide(c: char) -> bool {
    c >= '\u{2e80}'
}

fn is_symbol(word: &str, vocabulary: Vocabulary<'_>) -> bool {
    word.is_ascii() && vocabulary.parameter(word).is_some()
}

/// `弯曲刚度B` as a name and its symbol: no blank stands between words of Chinese and Japanese and those of others.
fn without_blank<'w>(word: &'w str, vocabulary: Vocabulary<'_>) -> Vec<&'w str> {
    let mut ends = word.char_indices().zip(word.chars().skip(1));
    let edge = ends.find(|((_, a), b)| is_wide(*a) != is_wide(*b)).map(|((at, a), _)| at + a.len_utf8());
    let Some((before, behind)) = edge.map(|at| word.split_at(at)) else { return vec![word] };
    let has_symbol = is_symbol(before, vocabulary) || is_symbol(behind, vocabulary);
    if has_symbol { vec![before, behind] } else { vec![word] }
}

fn is_number(word: &str) -> bool {
    !word.is_empty() && word.bytes().all(|b| b.is_ascii_digit())
}

/// The text before the last bracket, and what stands in it.
fn bracket(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_end();
    let open = text.ends_with(')').then(|| matching_open(text)).flatten()?;
    let (before, inner) = (text[..open].trim_end(), text[open + 1..text.len() - 1].trim());
    // "1/(cm)": the bracket belongs to the unit, not to a name.
    (!inner.is_empty() && !before.ends_with(['/', '·', '.'])).then_some((before, inner))
}

/// `gf cm2 per cm` as a unit: `gf·cm2/cm`; several divisors go in brackets.
fn spelt_out(parts: &[&str]) -> String {
    let at = parts.iter().position(|p| *p == "per").unwrap_or(parts.len());
    let symbols =
        |p: &[&str]| p.iter().map(|s| if *s == "percent" { "%" } else { s }).collect::<Vec<_>>().join("·");
    let above = if at == 0 { "1".to_string() } else { symbols(&parts[..at]) };
    if at >= parts.len() { above } else { format!("{above}/({})", symbols(&parts[at + 1..])) }
}

/// `b*` and `Δb*` of CIELAB, which would be B with a footnote otherwise.
fn is_colour(name: &str) -> bool {
    name.trim().trim_start_matches(['Δ', 'd']) == "b*"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::column_name::ColumnName;

    fn of(text: &str) -> Facets {
        Facets::of(text, Vocabulary::new(&[]))
    }

    fn parameter(text: &str) -> (Parameter, Option<Direction>, Option<String>, bool, bool) {
        let f = of(text);
        assert!(!f.unknown, "{text}: {f:?}");
        (f.parameter.unwrap(), f.direction, f.unit, f.sd, f.status != ValueStatus::Measured)
    }

    #[test]
    fn symbols_with_everything_that_print_puts_beside_them() {
        use Direction::{Warp, Weft};
        use Parameter::{B, Emt, G, Hb, Hg5, T0};
        let unit = |u: &str| Some(u.to_string());
        assert_eq!(parameter("B_gf_cm2_per_cm"), (B, None, unit("gf·cm2/(cm)"), false, false));
        assert_eq!(parameter("B_warp_uN_m"), (B, Some(Warp), unit("uN·m"), false, false));
        assert_eq!(parameter("EMT_weft_percent_inferred"), (Emt, Some(Weft), unit("%"), false, true));
        assert_eq!(of("T0_mm_assumed").status, ValueStatus::Assumed);
        assert_eq!(of("B warp doubtful").status, ValueStatus::Doubtful);
        assert_eq!(parameter("G [gf/(cm·deg)]"), (G, None, unit("gf/(cm·deg)"), false, false));
        assert_eq!(parameter("2HB warp (gf·cm/cm)"), (Hb, Some(Warp), unit("gf·cm/cm"), false, false));
        assert_eq!(parameter("2HG5 sd"), (Hg5, None, None, true, false));
        assert_eq!(parameter("T_mm"), (T0, None, unit("mm"), false, false));
        assert_eq!(parameter("G_gf_per_cm_deg").2, unit("gf/(cm·deg)"));
        assert_eq!(parameter("2HB desvio padrão (gf·cm/cm)"), (Hb, None, unit("gf·cm/cm"), true, false));
        assert!(parameter("B standard deviation").3);
        assert_eq!(parameter("B Mittelwert (gf·cm²/cm)").2, unit("gf·cm2/cm"));
        assert_eq!(parameter("Warp B, gf·cm²/cm"), (B, Some(Warp), unit("gf·cm2/cm"), false, false));
        assert_eq!(parameter("B (経) [gf·cm²/cm]"), (B, Some(Warp), unit("gf·cm2/cm"), false, false));
        assert_eq!(parameter("Bending rigidity B warp"), (B, Some(Warp), None, false, false));
        assert!(of("drape_nodes").unknown);
        // Words of a parameter's own names, and the condition that defines it.
        assert_eq!(parameter("Hysteresis 2HB (gf·cm/cm)").0, Hb);
        assert_eq!(parameter("Linearity of compression LC").0, Parameter::Lc);
        assert_eq!(parameter("Resiliência RT (%)").0, Parameter::Rt);
        assert_eq!(parameter("Weight per unit area (mg/cm²)").0, Parameter::W);
        assert_eq!(parameter("2HG at 0.5 degrees (gf/cm)").0, Parameter::Hg);
        assert_eq!(parameter("Hysteresis of shear force at 5 deg, 2HG5 (gf/cm)").0, Hg5);
        assert_eq!(parameter("Hysteresis of shear force (at 0.5°) (2HG) (gf/cm)").0, Parameter::Hg);
        assert_eq!(parameter("EMT (% at 500 gf/cm)"), (Emt, None, unit("%"), false, false));
        assert_eq!(parameter("2HB bei K=1 1/cm (cN·cm/cm)").0, Hb);
        assert_eq!(parameter("Thickness at 50 gf/cm2 TM (mm)").0, Parameter::Tm);
        assert_eq!(parameter("Thickness at 0.5 gf/cm2 (mm)").0, T0);
        assert_eq!(parameter("2HG at 5 deg (gf/cm)"), (Hg5, None, unit("gf/cm"), false, false));
        assert_eq!(parameter("2HB at 0.5 1/cm (gf·cm/cm)").0, Parameter::Hb05);
        assert_eq!(parameter("T at 50 gf/cm2 (mm)").0, Parameter::Tm);
        assert_eq!(parameter("Fabric thickness at 0.5 gf/cm²"), (T0, None, None, false, false));
        assert_eq!(parameter("EMT at 500 gf/cm (%) warp"), (Emt, Some(Warp), unit("%"), false, false));
        assert_eq!(parameter("弯曲刚度B(cN·cm2/cm)"), (B, None, unit("cN·cm2/cm"), false, false));
        assert_eq!(parameter("剪切滞后矩2HG5/(gf·cm-1)"), (Hg5, None, unit("(gf·cm-1)"), false, false));
        assert_eq!(parameter("Biegesteifigkeit B in gf·cm²/cm"), (B, None, unit("gf·cm2/cm"), false, false));
        // Other conditions, and words of other meaning.
        for text in [
            "2HG at 3 degrees (gf/cm)",
            "T0 at 50 gf/cm2 (mm)",
            "2HG5 at 0.5 deg (gf/cm)",
            "EMT at 50 gf/cm (%)",
            "EMT (% at 50 gf/cm)",
            "2HB corrected",
            "G hysteresis",
            "B loss",
            // An abbreviation stands in some name by chance.
            "W UR (mg/cm²)",
            "2HB force hysteresis",
        ] {
            let f = of(text);
            assert!(f.unknown, "{text}: {f:?}");
        }
        assert_eq!(of("LT CV (%)").statistic, Some(Statistic::Spread));
        assert_eq!(of("EMT warp max (%)").statistic, Some(Statistic::Other));
    }

    /// Long lines are prose: no heading is looked for in them, whatever they cost.
    #[test]
    fn prose_is_not_looked_through() {
        let line = "lorem ipsum dolor sit ".repeat(5000);
        assert_eq!(of(&line), Facets { unknown: true, ..Facets::default() });
        assert_eq!(ColumnName::of(&line, Vocabulary::new(&[])), ColumnName::default());
        assert_eq!(split_unit(&line), (line.trim().to_string(), None));
    }

    #[test]
    fn numbers_behind_symbols_and_directions() {
        let index = |t| (of(t).parameter, of(t).direction, of(t).index, of(t).unknown);
        assert_eq!(index("LT-2"), (Some(Parameter::Lt), None, Some(2), false));
        assert_eq!(index("B1"), (Some(Parameter::B), None, Some(1), false));
        assert_eq!(index("2HG5-1"), (Some(Parameter::Hg5), None, Some(1), false));
        assert_eq!(index("2HB_2"), (Some(Parameter::Hb), None, Some(2), false));
        assert_eq!(index("2HG51"), (Some(Parameter::Hg5), None, Some(1), false));
        assert_eq!(index("T50"), (Some(Parameter::Tm), None, None, false));
        assert!(of("b*").unknown && of("Δb* (D65)").unknown && of("B*").parameter == Some(Parameter::B));
        assert!(of("B×10 (gf·cm²/cm)").unknown && !of("B (10^-4 N·m)").unknown);
        assert_eq!(index("Warp-3"), (None, Some(Direction::Warp), Some(3), false));
        assert_eq!(index("No. 3"), (None, None, Some(3), false));
        assert!(of("W-17 poplin").unknown && of("Denim A").unknown && of("course wale").unknown);
    }
}
