//! Entries that tell apart what is averaged as repeats: states of one fabric, or other fabrics.

use std::collections::BTreeSet;

use super::sniff::{Number, number};

/// Two different entries of repeats that are more than a count or a measured value: some agree, or words are two, or numbers
/// are set values such as 0, 5 and 10 washes.
pub(super) fn told_apart(entries: &[String], decimal: char) -> Option<[String; 2]> {
    let first = entries.first()?;
    let other = entries.iter().find(|e| *e != first)?;
    let distinct: BTreeSet<&String> = entries.iter().collect();
    let grouped = distinct.len() < entries.len();
    let plain_value = |entry: &String| match number(entry, decimal) {
        Number::Value(v) => Some(v),
        _ => None,
    };
    let numbers: Option<Vec<f64>> = entries.iter().map(plain_value).collect();
    // `0 washes` and `5 washes`: numbers with one word.
    let with_word = if numbers.is_none() { numbers_of_one_word(entries, decimal) } else { None };
    let has_word = with_word.is_some();
    let numbers = numbers.or(with_word);
    let tells = match numbers {
        // A count 1, 2, 3 is that of the repeats, and what was measured has decimals.
        Some(numbers) => {
            let whole = numbers.iter().all(|v| v.fract() == 0.0);
            let round = numbers.iter().all(|v| v % 5.0 == 0.0);
            let rises = numbers.windows(2).all(|w| w[1] > w[0] + 1.0);
            // `0` and `24`: before a treatment, and behind it.
            let from_none = numbers[0] == 0.0 && numbers.last().is_some_and(|last| *last > 2.0);
            let set = (numbers.len() > 2 || round || has_word || from_none) && rises;
            let years = numbers.iter().all(|v| (1900.0..2100.0).contains(v));
            whole && (grouped || set || years)
        }
        None => {
            // `record 12` and `record 13` count; dates and times have no letters.
            let words = |e: &&String| e.chars().filter(|c| c.is_alphabetic()).collect::<String>();
            let words: BTreeSet<String> = distinct.iter().map(words).collect();
            let has_digits = distinct.iter().any(|e| e.contains(|c: char| c.is_ascii_digit()));
            words.len() > 1 && (grouped || distinct.len() == 2 || !has_digits)
        }
    };
    tells.then(|| [first.clone(), other.clone()])
}

/// The numbers before a word or unit that all entries share.
fn numbers_of_one_word(entries: &[String], decimal: char) -> Option<Vec<f64>> {
    let mut words = BTreeSet::new();
    let mut numbers = Vec::new();
    for entry in entries {
        let (digits, word) = entry.split_at(entry.find(|c: char| !(c.is_ascii_digit() || c == decimal))?);
        let Number::Value(value) = number(digits, decimal) else { return None };
        words.insert(word.trim());
        numbers.push(value);
    }
    (words.len() == 1).then_some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_told_from_counts_times_and_measured_values() {
        let tells = |entries: &[&str]| {
            told_apart(&entries.iter().map(|e| (*e).to_string()).collect::<Vec<_>>(), '.').is_some()
        };
        for states in [
            &["none", "none", "softener", "softener"][..],
            &["before", "after"],
            &["", "discarded", ""],
            &["0", "5", "10"],
            &["0", "90"],
            &["0", "0", "5", "5"],
            &["0", "24"],
            &["2019", "2020"],
            &["X", "X", "Y"],
            &["0 washes", "5 washes"],
            &["20/cm", "24/cm"],
            &["0 %", "2 %", "5 %"],
            &["untreated", "silicone", "enzyme"],
        ] {
            assert!(tells(states), "{states:?}");
        }
        for repeats in [
            &["1", "2", "3"][..],
            &["20.1", "20.3", "20.1"],
            &["a1", "a2", "a3"],
            &["10:31", "10:35"],
            &["2024-03-01", "2024-03-01", "2024-03-02"],
            &["same", "same"],
            &["record 12", "record 13"],
            &["20 °C", "21 °C"],
            &["20.1 °C", "20.4 °C"],
        ] {
            assert!(!tells(repeats), "{repeats:?}");
        }
    }
}
