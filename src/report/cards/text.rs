//! What the cards of all programs share: comments, plain letters, labels and numbers.

use std::fmt::Write as _;

use unicode_normalization::UnicodeNormalization;

use super::card::CardInput;
use crate::report::write::hash;

/// What cards say of a law that is a section.
const LINEAR: &str = "Linear and elastic: no friction, no time.";

/// What every card says of itself: the fabric, the origin of its data, units, axes, date, assumptions, and notes.
pub fn provenance(material: &CardInput<'_>, notes: &[String]) -> Vec<String> {
    provenance_of(material, LINEAR, notes)
}

/// The same of a law that is not linear, with a sentence of what it is.
fn provenance_of(material: &CardInput<'_>, law: &str, notes: &[String]) -> Vec<String> {
    let info = &material.sheet.info;
    let mut lines = vec![
        format!(
            "{} ({} data), by kesf {}",
            material.sheet.name,
            info.origin.name(),
            env!("CARGO_PKG_VERSION")
        ),
        format!("SI: m, kg, s, N. Local axis 1 is the warp, 2 the weft. {law}"),
    ];
    lines.extend(material.stamp.map(|date| format!("date: {date}")));
    lines.extend(info.source.iter().map(|s| format!("source: {s}")));
    lines.extend(material.made.used.iter().map(|u| format!("{}: {} ({})", u.name, u.value, u.source)));
    lines.extend(notes.iter().cloned());
    lines.iter().map(|line| ascii(line)).collect()
}

/// The same as comments, each line behind `comment`.
pub fn preamble(material: &CardInput<'_>, comment: &str, notes: &[String]) -> String {
    preamble_of(material, comment, LINEAR, notes)
}

/// The same of a law that is not linear, with a sentence of what it is.
pub fn preamble_of(material: &CardInput<'_>, comment: &str, law: &str, notes: &[String]) -> String {
    let mut text = String::new();
    for part in provenance_of(material, law, notes).iter().flat_map(|line| wrapped(line)) {
        let _ = writeln!(text, "{comment} {part}");
    }
    text
}

/// Text without characters that an input file may not hold.
pub fn ascii(text: &str) -> String {
    let plain = |c: char| match c {
        '·' | '×' => Some('*'),
        '–' | '−' => Some('-'),
        c if c.is_ascii_graphic() || c == ' ' => Some(c),
        c if c.is_whitespace() => Some(' '),
        // Accents go, letters stay.
        c if unicode_normalization::char::is_combining_mark(c) => None,
        _ => Some('?'),
    };
    let greek = text.replace('√', "sqrt").replace('ν', "nu").replace(['µ', 'μ'], "u");
    greek.nfkd().filter_map(plain).collect()
}

/// Lines of at most a hundred characters, broken between words.
pub fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].len() + word.len() > 100 {
            lines.push(format!("  {word}"));
        } else {
            let gap = if lines[last].is_empty() { "" } else { " " };
            lines[last] = format!("{}{gap}{word}", lines[last]);
        }
    }
    lines
}

/// A name of at most so many characters for a set of elements or a section: capitals, digits and `_`. What had to
/// change of the fabric's name stands in a tail of digits of its hash, so that two fabrics never share a label.
pub fn label(name: &str, longest: usize) -> String {
    const TAIL: usize = 6;
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if name.chars().all(plain) && name.len() <= longest {
        return name.to_ascii_uppercase();
    }
    let safe = ascii(name).to_ascii_uppercase();
    let safe = safe.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let kept: String = safe.take(longest - TAIL).collect();
    format!("{kept}{}", &hash(name.as_bytes())[..TAIL].to_ascii_uppercase())
}

/// The name of a set of elements.
pub fn set(material: &CardInput<'_>) -> String {
    format!("KESF_{}", label(&material.sheet.name, 50))
}

/// A number as every input file reads it.
pub fn number(value: f64) -> String {
    format!("{value:.9E}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_short_and_never_shared() {
        assert_eq!(label("poplin_2", 50), "POPLIN_2");
        let names = ["a b", "a-b", "A_B", "経糸", "緯糸", "petrak_m1", "petrak_m2", "a_b"];
        let labels: std::collections::BTreeSet<String> = names.iter().map(|n| label(n, 8)).collect();
        assert_eq!(labels.len(), names.len(), "{labels:?}");
        assert!(
            labels.iter().all(|l| l.len() <= 8
                && l.bytes().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == b'_'))
        );
    }

    #[test]
    fn comments_are_plain_and_short() {
        assert_eq!(ascii("Köper, 1e-6 N·m, 150 g/m² – ν"), "Koper, 1e-6 N*m, 150 g/m2 - nu");
        let long = wrapped(&"word ".repeat(60));
        assert!(long.len() > 2 && long.iter().all(|l| l.len() <= 102));
    }
}
