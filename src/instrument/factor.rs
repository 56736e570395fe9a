//! Factors that stand in words: `force of 2 layers`, `moment divided by 2`, `values x 10`.

use super::dialect::HeaderKey;
use super::unit_text::unit;
use super::vocabulary::{HEADING, Vocabulary};
use super::words::folded;

/// Words between a number and what it counts, or is the factor of: `divided by 2`.
const BETWEEN: usize = 2;
/// Words that are factors in a heading, and parts of names elsewhere: `double jersey`.
const IN_HEADINGS: [&str; 8] =
    ["half", "halved", "double", "doubled", "halbe", "halbes", "doppelte", "doppeltes"];

/// Whether words of a text state a factor other than 1: nobody can say whether it was applied.
pub(super) fn is_stated(text: &str, vocabulary: Vocabulary<'_>) -> bool {
    let text = folded(text);
    if text.chars().count() > HEADING {
        return false;
    }
    let words: Vec<&str> = text.split(|c: char| !(c.is_alphanumeric() || "×.,%°".contains(c))).collect();
    let words: Vec<&str> =
        words.into_iter().map(|w| w.trim_matches(['.', ','])).filter(|w| !w.is_empty()).collect();
    by_word(&words, vocabulary) || by_sign(&words)
}

/// Whether a heading names a factor at all: `half moment`, `thickness of 2 layers`, `moment/2`, `curvature x2`.
pub(super) fn in_heading(name: &str, vocabulary: Vocabulary<'_>) -> bool {
    let name = folded(name);
    let digits = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let is_divided = digits.len() < name.len() && digits.trim_end().ends_with(['/', '×', '*', '÷']);
    is_divided
        || name
            .split(|c: char| !c.is_alphanumeric())
            .any(|word| names_factor(word, vocabulary) || IN_HEADINGS.contains(&word.to_lowercase().as_str()))
        || is_stated(&name, vocabulary)
}

fn names_factor(word: &str, vocabulary: Vocabulary<'_>) -> bool {
    vocabulary.key(word) == Some(HeaderKey::Factor)
}

/// A word for a factor or for what is counted, and a number without a unit near it.
fn by_word(words: &[&str], vocabulary: Vocabulary<'_>) -> bool {
    words.iter().enumerate().filter(|(_, word)| names_factor(word, vocabulary)).any(|(at, _)| {
        let near = at.saturating_sub(1)..(at + BETWEEN + 1).min(words.len());
        near.into_iter()
            .any(|i| is_factor(words[i]) && words.get(i + 1).is_none_or(|next| unit(next).is_err()))
    })
}

/// `values x 10`, `range x10`, but no size such as `20 x 20`.
fn by_sign(words: &[&str]) -> bool {
    words.iter().enumerate().filter(|(_, word)| is_word(word)).any(|(at, _)| match words[at + 1..] {
        ["x" | "×", number, ..] => is_factor(number),
        [scaled, ..] => scaled.strip_prefix(['x', '×']).is_some_and(is_factor),
        [] => false,
    })
}

fn is_word(word: &str) -> bool {
    word.chars().count() > 1 && word.chars().all(char::is_alphabetic)
}

/// A number other than 1, or a word for two.
fn is_factor(word: &str) -> bool {
    let number = word.replace(',', ".").parse::<f64>();
    number.map_or_else(
        |_| matches!(word.to_lowercase().as_str(), "two" | "three" | "zwei" | "drei"),
        |n| n != 1.0,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_in_words_and_signs_are_found() {
        let found = |text: &str| is_stated(text, Vocabulary::new(&[]));
        for text in [
            "force of 2 layers",
            "moment divided by 2",
            "moment values x 10",
            "B und 2HB mit 10 multipliziert",
            "All values are to be divided by 10",
            "2 layers",
            "two layers",
            "range x10",
            "sample a (2 layers)",
        ] {
            assert!(found(text), "{text}");
        }
        for text in [
            "20 x 20 cm",
            "twill 2/2",
            "1 layer",
            "warp x weft",
            "specimen 2",
            "cotton 2 ply yarn",
            "KES-FB2 AUTO-A 10:31",
            "layers",
            "poplin 120 g/m²",
            "double jersey 180 g/m²",
            "strips 5 cm wide",
            "weight gain 5 %",
        ] {
            assert!(!found(text), "{text}");
        }
        for name in ["half moment", "moment/2", "curvature x2", "moment of 2 strips", "thickness of 2 layers"]
        {
            assert!(in_heading(name, Vocabulary::new(&[])), "{name}");
        }
        for name in ["moment", "moment 2", "K_warp", "shear force 1", "M/cm", "angle (2)"] {
            assert!(!in_heading(name, Vocabulary::new(&[])), "{name}");
        }
    }
}
