//! Words as they are compared.

use std::borrow::Cow;

use unicode_normalization::UnicodeNormalization;
use unicode_normalization::char::is_combining_mark;

/// A text without the blanks at its ends. Nearly all have none, as the first and the last byte tell.
pub(super) fn trimmed(text: &str) -> &str {
    let ends = [text.as_bytes().first(), text.as_bytes().last()];
    if ends.iter().all(|end| end.is_some_and(u8::is_ascii_graphic)) { text } else { text.trim() }
}

/// NFKC and one kind of minus: full-width digits and signs become ASCII.
pub(super) fn folded(cell: &str) -> Cow<'_, str> {
    if cell.is_ascii() {
        return Cow::Borrowed(trimmed(cell));
    }
    let text: String = cell.nfkc().map(|c| if matches!(c, '−' | '‐' | '–') { '-' } else { c }).collect();
    Cow::Owned(text.trim().to_string())
}

/// A word as it is compared: NFKC, lower case, without Latin accents, blanks and punctuation.
pub(super) fn normalised(text: &str) -> String {
    if text.is_ascii() {
        let mut plain = String::with_capacity(text.len());
        plain.extend(text.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()));
        // The sign that stands for "number".
        return if plain.is_empty() && text.contains('#') { "no".to_string() } else { plain };
    }
    // The sign that stands for the deviation.
    if text.trim() == "±" {
        return "sd".to_string();
    }
    // `n°` and `N.º` are "no", as their letters say.
    let text = text.replace("n°", "no").replace("N°", "no");
    // Only accents of the Latin block go: the voicing marks of kana are part of the word.
    text.nfkd()
        .filter(|c| !(is_combining_mark(*c) && *c < '\u{370}'))
        .nfc()
        .filter(|c| c.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

/// A name without the sign that leads to its value.
pub(super) fn bare(text: &str) -> String {
    text.trim().trim_end_matches([':', '=']).trim().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanks_go_at_both_ends_alone() {
        for text in ["", " ", "a", "a b", " a b\t", "\u{a0}a", "é ", " é", "\u{3000}1\u{3000}"] {
            assert_eq!(trimmed(text), text.trim());
        }
    }

    #[test]
    fn words_are_compared_without_case_width_accents_and_blanks() {
        assert_eq!(normalised("Direção do Ensaio"), "direcaodoensaio");
        assert_eq!(normalised("ｶﾞｰｾﾞ"), normalised("ガーゼ"));
        assert_eq!(normalised("Specimen No."), "specimenno");
        assert_eq!(normalised("N.º"), "no");
        assert_eq!(normalised("n°"), "no");
        assert_eq!(normalised("#"), "no");
    }
}
