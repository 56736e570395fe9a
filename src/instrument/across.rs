//! Texts that say `across the warp`: the direction that they name is not theirs.

use super::dialect::{DirectionWord, HeaderKey, TableColumn};
use super::vocabulary::{Vocabulary, words_of};
use super::words::normalised;

impl Vocabulary<'_> {
    /// `perpendicular to the warp`, `not warp`.
    pub fn is_across(self, text: &str) -> bool {
        let across = |word: &str| self.direction_word(word) == Some(DirectionWord::Across);
        let plain = normalised(text);
        // Chinese, Japanese and Korean have no blanks around such a word.
        let wide: Vec<char> = plain.chars().collect();
        let mut pairs = wide.windows(2).filter(|pair| pair.iter().all(|c| *c >= '\u{1100}'));
        words_of(text).any(|word| across(&word)) || pairs.any(|pair| across(&pair.iter().collect::<String>()))
    }

    /// The same in the name of a file or sheet, where such a word may belong to the cloth: only one that leads to the direction, or
    /// ends behind it, counts. `non-crimp warp` and `warp, not washed` are warp, and so is number 90.
    pub fn is_across_in_name(self, name: &str) -> bool {
        let words: Vec<String> = words_of(name).collect();
        let mut across = words.iter().enumerate().filter(|(_, word)| self.says_across(word));
        across.any(|(at, _)| self.leads_to_direction(&words[at + 1..]) || self.ends_direction(&words, at))
    }

    /// A word that is no number: `perpendicular`, `90deg`.
    fn says_across(self, word: &str) -> bool {
        let is_number = word.bytes().all(|b| b.is_ascii_digit());
        word == "90deg" || (!is_number && self.direction_word(word) == Some(DirectionWord::Across))
    }

    /// Whether a word of a text is `direction`: `in weft direction` and 纬向, and not `of other weft densities`.
    pub fn says_direction(self, text: &str) -> bool {
        let is_direction = |word: String| {
            self.key(&word) == Some(HeaderKey::Direction)
                || self.table_column(&word) == Some(TableColumn::Direction)
        };
        text.contains(['向', '방']) || words_of(text).any(is_direction)
    }

    /// A word that stands beside a direction and says nothing more: `in`, `way`, `sens`, `direction`.
    pub fn leads_to_a_direction(self, word: &str) -> bool {
        word == "in"
            || self.direction_word(word) == Some(DirectionWord::Along)
            || self.key(word) == Some(HeaderKey::Direction)
    }

    /// Whether words begin with a direction, perhaps behind `to the` and the like.
    fn leads_to_direction<'w>(self, words: impl IntoIterator<Item = &'w String>) -> bool {
        let mut words =
            words.into_iter().skip_while(|word| !self.is_direction_of_name(word) && self.connects(word));
        words.next().is_some_and(|word| self.is_direction_of_name(word))
    }

    /// Whether a word stands behind a direction and nothing unknown follows it: `zur Kette senkrecht`.
    fn ends_direction(self, words: &[String], at: usize) -> bool {
        let next = words.get(at + 1);
        let is_end =
            next.is_none_or(|word| self.knows(word) || word.starts_with(|c: char| c.is_ascii_digit()));
        is_end && self.leads_to_direction(words[..at].iter().rev())
    }

    /// A direction, perhaps with a number behind it, `warp2`.
    fn is_direction_of_name(self, word: &str) -> bool {
        self.direction_exactly(word.trim_end_matches(|c: char| c.is_ascii_digit())).is_some()
    }

    /// A word that may stand between `across` and its direction, in any language: a short one, `yarn`, or `direction`.
    fn connects(self, word: &str) -> bool {
        let is_short = word.chars().count() <= 3 && word.chars().all(char::is_alphabetic);
        is_short
            || self.direction_word(word) == Some(DirectionWord::Along)
            || self.key(word) == Some(HeaderKey::Direction)
    }
}
