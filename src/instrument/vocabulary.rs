//! The words of all languages, found by their normalised form.

use std::collections::{BTreeMap, HashMap};
use std::hash::Hash;
use std::sync::OnceLock;

use super::dialect::{
    BranchColumn, Dialect, DirectionWord, HeaderKey, Role, Statistic, TableColumn, TitleWord, dialects,
    letter_of,
};
use super::unit_text::split_unit;
use super::words::{folded, normalised};
use super::{Direction, Parameter, Test};

/// Characters of the longest heading that is looked through for words; longer texts are prose.
pub(super) const HEADING: usize = 160;
/// Characters of the longest word that is looked for within another.
pub(super) const WITHIN: usize = 32;

/// The words of the built-in dialects; where two languages share a word, the first file's meaning holds.
struct Index {
    columns: HashMap<&'static str, Role>,
    keys: HashMap<&'static str, HeaderKey>,
    directions: HashMap<&'static str, Direction>,
    direction_words: HashMap<&'static str, DirectionWord>,
    tests: HashMap<&'static str, Test>,
    branches: HashMap<&'static str, BranchColumn>,
    table: HashMap<&'static str, TableColumn>,
    statistics: HashMap<&'static str, Statistic>,
    titles: HashMap<&'static str, TitleWord>,
    symbols: HashMap<&'static str, Parameter>,
    /// The built-in dialects that know a word, one bit each.
    known: HashMap<&'static str, u32>,
}

/// Which built-in dialects know a word: bit `i` is that of the `i`-th.
fn known() -> HashMap<&'static str, u32> {
    let mut known = HashMap::new();
    for (i, dialect) in dialects().iter().enumerate() {
        dialect.vocabulary().for_each(|word| *known.entry(word).or_insert(0) |= 1 << i);
    }
    known
}

fn collect<K: 'static, V>(
    map: impl Fn(&'static Dialect) -> &'static BTreeMap<K, Vec<String>>,
    meaning: impl Fn(&K) -> Option<V>,
) -> HashMap<&'static str, V> {
    let mut out = HashMap::new();
    for (key, words) in dialects().iter().flat_map(map) {
        for word in words.iter().filter(|w| !w.is_empty()) {
            if let Some(value) = meaning(key) {
                out.entry(word.as_str()).or_insert(value);
            }
        }
    }
    out
}

/// The words of columns of result tables, those for factors in headers among them.
fn table_columns() -> HashMap<&'static str, TableColumn> {
    let mut columns = collect(|d| &d.table, |k| Some(*k));
    for (word, _) in collect(|d| &d.keys, |k| (*k == HeaderKey::Factor).then_some(())) {
        columns.entry(word).or_insert(TableColumn::Factor);
    }
    columns
}

fn index() -> &'static Index {
    static INDEX: OnceLock<Index> = OnceLock::new();
    INDEX.get_or_init(|| Index {
        columns: collect(|d| &d.columns, |k| Some(*k)),
        keys: collect(|d| &d.keys, |k| Some(*k)),
        directions: collect(|d| &d.directions, |k| Some(*k)),
        direction_words: collect(|d| &d.direction_words, |k| Some(*k)),
        tests: collect(|d| &d.tests, |k| Some(*k)),
        branches: collect(|d| &d.branches, |k| Some(*k)),
        table: table_columns(),
        statistics: collect(|d| &d.statistics, |k| Some(*k)),
        titles: collect(|d| &d.titles, |k| Some(*k)),
        symbols: collect(|d| &d.symbols, |k| Parameter::from_symbol(k)),
        known: known(),
    })
}

/// The words of the user's dialects, then of the built-in ones.
#[derive(Clone, Copy)]
pub(super) struct Vocabulary<'a> {
    user: &'a [Dialect],
}

/// Whether a word may be looked for within another: short ones stand in many words of other meaning.
fn long_enough(word: &str) -> bool {
    word.chars().any(|c| c >= '\u{1100}') || word.chars().nth(3).is_some()
}

/// Words between blanks and marks.
pub(super) fn words_of(text: &str) -> impl Iterator<Item = String> {
    let folded = folded(text).into_owned();
    let words: Vec<String> =
        folded.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).map(String::from).collect();
    words.into_iter()
}

impl<'a> Vocabulary<'a> {
    pub fn new(user: &'a [Dialect]) -> Self {
        Self { user }
    }

    /// Whether the user has no dialects, so that a text says the same in every file.
    pub fn is_built_in(self) -> bool {
        self.user.is_empty()
    }

    pub fn dialects(self) -> impl Iterator<Item = &'a Dialect> {
        self.user.iter().chain(dialects())
    }

    /// The meaning of a normalised word.
    fn exact<K: 'a, V: Copy>(
        self,
        word: &str,
        map: impl Fn(&'a Dialect) -> &'a BTreeMap<K, Vec<String>>,
        meaning: impl Fn(&K) -> Option<V>,
        built_in: &HashMap<&'static str, V>,
    ) -> Option<V> {
        if word.is_empty() {
            return None;
        }
        let own = self.user.iter().flat_map(map).find(|(_, words)| words.iter().any(|w| w == word));
        own.and_then(|(key, _)| meaning(key)).or_else(|| built_in.get(word).copied())
    }

    /// The meaning of a text: exactly, else that of the longest known word within it.
    fn find<K: 'a + Copy + Eq + Hash>(
        self,
        text: &str,
        inside: bool,
        map: impl Fn(&'a Dialect) -> &'a BTreeMap<K, Vec<String>> + Copy,
        built_in: &HashMap<&'static str, K>,
    ) -> Option<K> {
        let word = normalised(text);
        if let Some(key) = self.exact(&word, map, |k| Some(*k), built_in) {
            return Some(key);
        }
        if !inside {
            return None;
        }
        let starts: Vec<usize> = word.char_indices().map(|(i, _)| i).chain([word.len()]).collect();
        let n = starts.len() - 1;
        if n > HEADING {
            return None;
        }
        for length in (1..=n.min(WITHIN)).rev() {
            for i in 0..=n - length {
                let part = &word[starts[i]..starts[i + length]];
                if let Some(key) =
                    long_enough(part).then(|| self.exact(part, map, |k| Some(*k), built_in)).flatten()
                {
                    return Some(key);
                }
            }
        }
        None
    }

    /// Whether a whole text is a word of any kind, or the symbol of a parameter.
    pub fn knows(self, text: &str) -> bool {
        self.role_exactly(text).is_some()
            || self.key(text).is_some()
            || self.direction_exactly(text).is_some()
            || self.test_exactly(text).is_some()
            || self.branch(text).is_some()
            || self.table_column(text).is_some()
            || self.statistic(text).is_some()
            || self.parameter(text).is_some()
    }

    pub fn role(self, name: &str) -> Option<Role> {
        self.find(name, true, |d| &d.columns, &index().columns)
    }

    /// The role that a whole word names.
    pub fn role_exactly(self, name: &str) -> Option<Role> {
        self.find(name, false, |d| &d.columns, &index().columns)
    }

    pub fn key(self, name: &str) -> Option<HeaderKey> {
        self.find(name, false, |d| &d.keys, &index().keys)
    }

    /// The direction that a text names; none of one that names two, or says that it is across one.
    pub fn direction(self, text: &str) -> Option<Direction> {
        self.direction_exactly(text).or_else(|| {
            let found = self.find(text, true, |d| &d.directions, &index().directions)?;
            (!self.names_another(text, found) && !self.is_across(text)).then_some(found)
        })
    }

    /// Whether a text names more than one direction: `warp and weft`.
    pub fn names_several_directions(self, text: &str) -> bool {
        let found = self.find(text, true, |d| &d.directions, &index().directions);
        found.is_some_and(|found| self.names_another(text, found))
    }

    /// Whether a word that may be a direction is a dimension as well.
    pub fn is_dimension(self, word: &str) -> bool {
        self.direction_word(word) == Some(DirectionWord::Dimension)
    }

    /// Whether a word of a text is a dimension: `specimen width`.
    pub fn names_dimension(self, text: &str) -> bool {
        words_of(text).any(|word| self.is_dimension(&word))
    }

    pub fn direction_word(self, word: &str) -> Option<DirectionWord> {
        self.find(word, false, |d| &d.direction_words, &index().direction_words)
    }

    /// Whether a text says more than the direction that it names: `warp before washing`.
    pub fn says_more_than_direction(self, text: &str) -> bool {
        let is_direction = |word: &str| {
            self.direction(word).is_some()
                || self.key(word) == Some(HeaderKey::Direction)
                || self.table_column(word) == Some(TableColumn::Direction)
        };
        let means_nothing = |word: &str| {
            word.chars().count() < 3
                || word.chars().all(|c| c.is_ascii_digit())
                || self.direction_word(word) == Some(DirectionWord::Along)
        };
        self.direction_exactly(text).is_none()
            && words_of(text).any(|word| !is_direction(&word) && !means_nothing(&word))
    }

    /// Whether a word of a text, or a single character of Chinese or Japanese, is another direction.
    fn names_another(self, text: &str, direction: Direction) -> bool {
        let text = folded(text);
        let is_another = |word: &str| self.direction_exactly(word).is_some_and(|other| other != direction);
        let mut words = text.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty());
        let mut wide = text.chars().filter(|c| *c >= '\u{2e80}');
        words.any(is_another) || wide.any(|c| is_another(c.encode_utf8(&mut [0; 4])))
    }

    /// The direction that a whole word names.
    pub fn direction_exactly(self, text: &str) -> Option<Direction> {
        self.find(text, false, |d| &d.directions, &index().directions)
    }

    /// The direction of a letter that is one in company only: beside its partner, or in a column of directions. Where dialects
    /// differ it is none.
    pub fn letter(self, text: &str) -> Option<Direction> {
        let word = letter_of(text);
        let pairs = self.dialects().flat_map(|d| &d.direction_letters);
        let mut found = pairs.filter_map(|pair| match pair.iter().position(|letter| *letter == word)? {
            0 => Some(Direction::Warp),
            _ => Some(Direction::Weft),
        });
        let first = found.next()?;
        found.all(|other| other == first).then_some(first)
    }

    /// Whether two letters are partners: that of warp first.
    pub fn are_partners(self, warp: &str, weft: &str) -> bool {
        let own = [letter_of(warp), letter_of(weft)];
        self.dialects().flat_map(|d| &d.direction_letters).any(|pair| *pair == own)
    }

    pub fn test(self, text: &str) -> Option<Test> {
        // "KES-FB1 せん断": the longest word decides, and FB1 alone decides nothing.
        let word = normalised(text);
        self.find(&word, true, |d| &d.tests, &index().tests).or_else(|| Test::of_instrument(&word))
    }

    /// The test that a whole word names.
    pub fn test_exactly(self, text: &str) -> Option<Test> {
        self.find(text, false, |d| &d.tests, &index().tests)
    }

    pub fn branch(self, text: &str) -> Option<BranchColumn> {
        self.find(text, false, |d| &d.branches, &index().branches)
    }

    pub fn table_column(self, name: &str) -> Option<TableColumn> {
        let named = self.find(name, false, |d| &d.table, &index().table);
        // Those of the built-in dialects are in the index.
        named.or_else(|| {
            (!self.is_built_in() && self.key(name) == Some(HeaderKey::Factor)).then_some(TableColumn::Factor)
        })
    }

    /// What a whole word or phrase of a title says of the numbers below.
    pub fn title_word(self, phrase: &str) -> Option<TitleWord> {
        self.find(phrase, false, |d| &d.titles, &index().titles)
    }

    /// How a label says that a row or column sums up others: the whole label, and no word within it.
    pub fn statistic(self, label: &str) -> Option<Statistic> {
        // Most labels are numbers; `95 % CI` is not.
        if !label.chars().any(|c| c.is_alphabetic() || c == '±') {
            return None;
        }
        // Compared words lose their accents, and the sign of the mean its bar.
        if ["x\u{304}", "X\u{304}", "x\u{305}", "X\u{305}"].contains(&label.trim()) {
            return Some(Statistic::Mean);
        }
        self.find(label, false, |d| &d.statistics, &index().statistics)
    }

    /// The same for a heading, in which the word stands among others: `mean moment`, `曲げモーメント平均`.
    pub fn statistic_within(self, heading: &str) -> Option<Statistic> {
        let text = folded(heading).into_owned();
        if text.chars().count() > HEADING {
            return None;
        }
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
        // Chinese and Japanese have no blanks between words.
        let word = normalised(&text);
        let within =
            |w: &str| w.chars().all(|c| c >= '\u{1100}') && w.chars().count() > 1 && word.contains(w);
        let mut own = self.user.iter().flat_map(|d| &d.statistics);
        let found = own.find(|(_, words)| words.iter().any(|w| within(w))).map(|(statistic, _)| *statistic);
        let mut built_in: Vec<(&str, Statistic)> =
            index().statistics.iter().filter(|(w, _)| within(w)).map(|(w, s)| (*w, *s)).collect();
        // The longest word decides; the order of a hash table must not.
        built_in.sort_by_key(|(w, s)| (std::cmp::Reverse(w.len()), *w, *s));
        found.or_else(|| built_in.first().map(|(_, statistic)| *statistic))
    }

    /// Whether two entries are the same direction or the same word.
    pub fn says_the_same(self, a: &str, b: &str) -> bool {
        match (self.direction(a), self.direction(b)) {
            (None, None) => normalised(a) == normalised(b),
            (a, b) => a == b,
        }
    }

    pub fn parameter(self, name: &str) -> Option<Parameter> {
        // `X2HB` of R, whose names begin with a letter.
        let name = name
            .strip_prefix('X')
            .filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
            .unwrap_or(name);
        let word = normalised(name);
        // What a laboratory says of its own names goes before what they are elsewhere.
        let own = self.exact(&word, |d| &d.symbols, |k| Parameter::from_symbol(k), &HashMap::new());
        own.or_else(|| Parameter::from_symbol(name)).or_else(|| index().symbols.get(word.as_str()).copied())
    }

    /// Whether words are a part of a name of this parameter, as they follow each other there: `Hysteresis` beside 2HB says
    /// nothing new. Short ones, such as `UR`, stand in some name by chance.
    pub fn belongs_to(self, words: &str, parameter: Parameter) -> bool {
        let words = normalised(words);
        let mut names = self.dialects().flat_map(|d| &d.symbols);
        long_enough(&words)
            && names.any(|(symbol, names)| {
                Parameter::from_symbol(symbol) == Some(parameter)
                    && names.iter().any(|name| name.contains(words.as_str()))
            })
    }

    /// Every dialect with those of the words that it does not know, the closest first.
    pub fn closest<'w>(self, words: &'w [String]) -> Vec<(&'a str, Vec<&'w str>)> {
        let words: Vec<(&String, String)> = words.iter().map(|w| (w, normalised(&split_unit(w).0))).collect();
        let built_in: Vec<u32> =
            words.iter().map(|(_, word)| index().known.get(word.as_str()).copied().unwrap_or(0)).collect();
        let mut found = Vec::new();
        for dialect in self.user {
            let unknown = words.iter().filter(|(_, word)| !dialect.vocabulary().any(|known| known == word));
            found.push((dialect.name.as_str(), unknown.map(|(written, _)| written.as_str()).collect()));
        }
        for (i, dialect) in dialects().iter().enumerate() {
            let unknown = words.iter().zip(&built_in).filter(|(_, known)| *known >> i & 1 == 0);
            found.push((dialect.name.as_str(), unknown.map(|((written, _), _)| written.as_str()).collect()));
        }
        // A stable sort: among equals the user's, then the first built-in one.
        found.sort_by_key(|(_, unknown): &(&str, Vec<&str>)| unknown.len());
        found
    }
}

/// Whether a normalised word is one of the built-in dialects in any of the senses that files are decoded by.
pub(super) fn is_built_in_word(word: &str) -> bool {
    let i = index();
    i.columns.contains_key(word)
        || i.keys.contains_key(word)
        || i.directions.contains_key(word)
        || i.tests.contains_key(word)
        || i.table.contains_key(word)
        || i.statistics.contains_key(word)
        || i.symbols.contains_key(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: Vocabulary<'static> = Vocabulary { user: &[] };

    #[test]
    fn words_of_many_languages_have_meanings() {
        assert_eq!(WORDS.role("曲げモーメント"), Some(Role::Moment));
        assert_eq!(WORDS.role("Bending moment per width"), Some(Role::Moment));
        assert_eq!(WORDS.role("força"), Some(Role::Force));
        assert_eq!(WORDS.role("せん断力"), Some(Role::ShearForce));
        assert_eq!(WORDS.test("KES-FB1 せん断"), Some(Test::Shear));
        assert_eq!(WORDS.test("KES-FB2"), Some(Test::Bending));
        assert_eq!(WORDS.test("KES-FB1"), None);
        assert_eq!(WORDS.direction("経方向"), Some(Direction::Warp));
        assert_eq!(WORDS.direction("kierunek osnowy"), Some(Direction::Warp));
        assert_eq!(WORDS.parameter("2hb"), Some(Parameter::Hb));
        assert_eq!(WORDS.parameter("目付"), Some(Parameter::W));
        assert_eq!(WORDS.parameter("弯曲刚度"), Some(Parameter::B));
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
}
