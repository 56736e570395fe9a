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
    let tells = match numbers {
        // A count 1, 2, 3 is that of the repeats, and what was measured has decimals.
        Some(numbers) => {
            let whole = numbers.iter().all(|v| v.fract() == 0.0);
            let round = numbers.iter().all(|v| v % 5.0 == 0.0);
            let set = (numbers.len() > 2 || round) && numbers.windows(2).all(|w| w[1] > w[0] + 1.0);
            whole && (grouped || set)
        }
        None => {
            // `record 12` and `record 13` count; dates and times have no letters.
            let words = |e: &&String| e.chars().filter(|c| c.is_alphabetic()).collect::<String>();
            let words: BTreeSet<String> = distinct.iter().map(words).collect();
            words.len() > 1 && (grouped || distinct.len() == 2)
        }
    };
    tells.then(|| [first.clone(), other.clone()])
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
            &["X", "X", "Y"],
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
            &["red", "green", "blue"],
        ] {
            assert!(!tells(repeats), "{repeats:?}");
        }
    }
}
