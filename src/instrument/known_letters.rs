//! How much of a text is known words, by which its encoding is decided.

use super::unit_text::unit;
use super::vocabulary::{WITHIN, is_built_in_word};
use super::words::normalised;

/// How much of a text is known words with letters beyond ASCII: the squares of their lengths, since a chance meeting of
/// one or two characters says little.
pub(super) fn known_letters(text: &str) -> usize {
    let mut sum = 0;
    for line in text.lines() {
        let words: Vec<&str> = line.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
        // Many words are known as parts of phrases only.
        let phrases = words.windows(2).filter(|w| w.iter().any(|w| !w.is_ascii())).map(|w| w.join(" "));
        sum += phrases.map(|p| weight(&normalised(&p), &p)).sum::<usize>();
        sum += signs_of_units(line);
        // One letter means nothing, unless it is a whole word of Chinese or Japanese.
        let one =
            |w: &str| w.chars().nth(1).is_none() && w.chars().all(|c| !('\u{2e80}'..'\u{ff00}').contains(&c));
        let words = words.iter().filter(|w| !w.is_ascii() && !one(w));
        sum += words.map(|w| weight(&normalised(w), w)).sum::<usize>();
    }
    sum
}

fn is_sign(part: &str) -> bool {
    !part.is_ascii() && (part == "±" || (part.chars().count() > 1 && unit(part).is_ok()))
}

/// How much of a line is units and signs of deviations beyond ASCII: `gf·cm²/cm` is one in the right encoding only.
fn signs_of_units(line: &str) -> usize {
    let parts = line.split(|c: char| c.is_whitespace() || ",;()[]\"=:".contains(c));
    parts.filter(|part| is_sign(part)).map(|part| part.chars().count().pow(2)).sum()
}

fn weight(word: &str, written: &str) -> usize {
    if is_built_in_word(word) {
        return written.chars().count().pow(2);
    }
    // No blanks stand between words of Chinese and Japanese; a single character of them says nothing within others.
    let starts: Vec<usize> = word.char_indices().map(|(i, _)| i).chain([word.len()]).collect();
    let n = starts.len() - 1;
    let (mut at, mut sum) = (0, 0);
    while at < n {
        let longest = (2..=WITHIN.min(n - at)).rev().find(|k| {
            let part = &word[starts[at]..starts[at + k]];
            part.chars().all(|c| c >= '\u{1100}') && is_built_in_word(part)
        });
        sum += longest.map_or(0, |k| k * k);
        at += longest.unwrap_or(1);
    }
    sum
}
