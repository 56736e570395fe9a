//! Letters of directions, or angles to the warp, each beside its partner: `B_K` and `B_S`, `L` and `T` over columns, `0°` and `90°`.

use std::collections::BTreeMap;

use super::Direction;
use super::facets::Facets;
use super::raw::Row;
use super::vocabulary::Vocabulary;
use super::words::{folded, normalised};

/// A text without its letter of a direction.
struct Lettered {
    index: usize,
    direction: Direction,
    letter: String,
    rest: String,
}

impl Lettered {
    /// Whether the other is the same text with the letter of the other direction.
    fn is_partner(&self, other: &Self, v: Vocabulary<'_>) -> bool {
        let (warp, weft) = if self.direction == Direction::Warp { (self, other) } else { (other, self) };
        let fill = warp.letter.eq_ignore_ascii_case("w") && weft.letter.eq_ignore_ascii_case("f");
        normalised(&self.rest) == normalised(&other.rest)
            && (fill || v.are_partners(&warp.letter, &weft.letter))
    }
}

/// What the cells of a row of heads say, where letters of directions stand in them, each beside its partner: facets by index.
/// Letters alone are that only where nothing else in the row names a value or is not understood.
pub(super) fn in_heads(row: &Row<'_>, v: Vocabulary<'_>) -> Vec<(usize, Facets)> {
    // Most rows have no letter that stands alone.
    if row.filled().filter(|(_, c)| has_letter(&c.text, v)).count() < 2 {
        return Vec::new();
    }
    let found: Vec<Lettered> = row.filled().filter_map(|(i, c)| lettered(i, &c.text, v)).collect();
    let paired: Vec<&Lettered> =
        found.iter().filter(|one| found.iter().any(|other| one.is_partner(other, v))).collect();
    let mut others = row.filled().filter(|(i, _)| paired.iter().all(|one| one.index != *i));
    let alone = !others.any(|(_, c)| is_value_or_strange(&c.text, v));
    let mut out = Vec::new();
    for one in paired {
        let rest = Facets::of(&one.rest, v);
        if if one.rest.is_empty() { alone } else { rest.names_value() } {
            out.push((one.index, Facets { direction: Some(one.direction), ..rest }));
        }
    }
    out
}

fn is_value_or_strange(text: &str, v: Vocabulary<'_>) -> bool {
    let says = Facets::of(text, v);
    says.names_value() || (says.unknown && says.meta.is_none())
}

/// The letter of a direction behind the name of a value, or as the whole text.
fn lettered(index: usize, text: &str, v: Vocabulary<'_>) -> Option<Lettered> {
    let text = folded(text).into_owned();
    if let Some(direction) = v.letter(&text) {
        return Some(Lettered { index, direction, letter: text, rest: String::new() });
    }
    if Facets::of(&text, v).direction.is_some() {
        return None;
    }
    let mut at = 0;
    for word in text.split(is_between) {
        let (start, end) = (at, at + word.len());
        at = end + text[end..].chars().next().map_or(0, char::len_utf8);
        let Some(direction) = behind_name(word, v).filter(|_| start > 0) else { continue };
        let rest =
            format!("{} {}", text[..start].trim_end_matches(['_', '-', ' ']), text[end..].trim_start());
        let rest = rest.replace("( )", "").replace("()", "").trim().to_string();
        if Facets::of(&rest, v).names_value() {
            return Some(Lettered { index, direction, letter: word.to_string(), rest });
        }
    }
    None
}

/// The direction of a letter behind the name of a value. `B_w` and `B_f` are warp and fill there, and nowhere else: alone W is the areal
/// density, and `B_f` without its partner the rigidity of the face.
fn behind_name(word: &str, v: Vocabulary<'_>) -> Option<Direction> {
    match word {
        "w" | "W" => Some(Direction::Warp),
        "f" | "F" => Some(Direction::Weft),
        _ => v.letter(word),
    }
}

/// The directions that names state by letters, each beside its partner: sheets `L` and `T`, `silk O` and `silk T`.
pub(super) fn in_names<'n>(names: &[&'n str], v: Vocabulary<'_>) -> BTreeMap<&'n str, Direction> {
    let found: Vec<Lettered> =
        names.iter().enumerate().filter_map(|(i, name)| lettered_name(i, name, v)).collect();
    let paired = found.iter().filter(|one| found.iter().any(|other| one.is_partner(other, v)));
    paired.map(|one| (names[one.index], one.direction)).collect()
}

/// A name with one letter of a direction, which may have a number behind it.
fn lettered_name(index: usize, name: &str, v: Vocabulary<'_>) -> Option<Lettered> {
    let text = folded(name).into_owned();
    let words: Vec<&str> = text.split(is_between).filter(|w| !w.is_empty()).collect();
    if words.iter().any(|word| v.direction(word).is_some()) {
        return None;
    }
    let mut letters = words.iter().filter_map(|word| letter_of_word(word, v));
    let (direction, letter, whole) = letters.next()?;
    if letters.next().is_some() {
        return None;
    }
    let number = whole[letter.len()..].to_string();
    let rest: Vec<String> =
        words.iter().map(|word| if **word == whole { number.clone() } else { word.to_string() }).collect();
    Some(Lettered { index, direction, letter, rest: rest.join(" ") })
}

/// The direction of a word that is a letter with or without a number behind it, the letter and the word.
fn letter_of_word(word: &str, v: Vocabulary<'_>) -> Option<(Direction, String, String)> {
    let letter = word.trim_end_matches(|c: char| c.is_ascii_digit());
    Some((v.letter(letter).filter(|_| is_short(letter))?, letter.to_string(), word.to_string()))
}

/// Whether a character stands between words; the sign of degrees belongs to its number.
fn is_between(c: char) -> bool {
    !(c.is_alphanumeric() || c == '°')
}

/// One letter, or an angle.
fn is_short(word: &str) -> bool {
    let is_letter = word.starts_with(char::is_alphabetic) && word.chars().nth(1).is_none();
    is_letter || ["°", "deg"].into_iter().any(|sign| word.ends_with(sign))
}

fn has_letter(text: &str, v: Vocabulary<'_>) -> bool {
    text.split(is_between).any(|word| is_short(word) && behind_name(word, v).is_some())
}
