//! Titles that say what the numbers of a table are: `Standard deviations of the KES parameters`, a sheet `Correlation`.
//!
//! Such numbers look like values, and are none. Only a title that says nothing else counts: `Means and standard deviations` stands over
//! values.

use super::dialect::{Statistic, TableColumn, TitleWord};
use super::vocabulary::Vocabulary;
use super::words::{folded, normalised};

/// Names of a spread that a sheet has for something else.
const NAMES: [&str; 4] = ["sigma", "error", "dev", "err"];
/// Most words before the head of a title, `Relative changes`.
const BEFORE: usize = 3;
/// Most words of a phrase.
const PHRASE: usize = 4;
/// Most letters of the ending of an adjective.
const ENDING: usize = 2;

/// Whether a line over a table says that its numbers are no values.
pub(super) fn is_of_no_values(text: &str, v: Vocabulary<'_>) -> bool {
    let text = folded(text);
    let title = without_number(&text, v).replace(" (%)", "%").replace("(%)", "%");
    // What stands behind a mark or in brackets is another thing.
    let marks = ['(', '[', ',', ';', '±', '&', '+', '/'];
    let (head, rest) = title.split_at(title.find(marks).unwrap_or(title.len()));
    // `Weight reduction (10 %)` is a treatment.
    let is_amount = rest.contains(|c: char| c.is_ascii_digit());
    let mut has_percent =
        head.contains('%') || (!is_amount && (rest.contains('%') || names_percent(rest, v)));
    let head = head.replace("'s ", " ").replace("’s ", " ");
    let words = words_of(&head);
    let means: Vec<Option<TitleWord>> = words.iter().map(|word| meaning(word, v)).collect();
    if means.contains(&Some(TitleWord::Verb)) {
        return false;
    }
    has_percent |= means.contains(&Some(TitleWord::Percent));
    let mut is_head = true;
    for at in 0..words.len().min(BEFORE + 1) {
        if matches!(means[at], Some(TitleWord::And | TitleWord::With)) {
            return false;
        }
        is_head &= at == 0 || matches!(means[at - 1], Some(TitleWord::Percent | TitleWord::Qualifier));
        for n in 1..=PHRASE.min(words.len() - at) {
            let next = words.get(at + n).map(|_| means[at + n]);
            // `Standard deviations in brackets` and `… shown in brackets` are remarks on values.
            let says_where = means.get(at + n + 1) == Some(&Some(TitleWord::Place));
            let leads_on = next.is_none_or(|word| {
                matches!(word, Some(TitleWord::Of | TitleWord::With | TitleWord::Percent))
            });
            let phrase = words[at..at + n].join(" ");
            let in_percent = has_percent && is_head;
            if leads_on
                && !says_where
                && is_of_comparison(&phrase, in_percent, v)
                && !names_mean(&words[at + n..], v)
            {
                return true;
            }
        }
    }
    ends_with_comparison(&head, v)
}

/// What a word says; a capital letter alone is a name, `Fabric A` and `Type I`, and an ending may be one of an adjective:
/// `relativen`.
fn meaning(word: &str, v: Vocabulary<'_>) -> Option<TitleWord> {
    let is_name = word.chars().nth(1).is_none() && word.chars().all(char::is_uppercase);
    let whole = v.title_word(word).filter(|_| !is_name);
    whole.or_else(|| {
        let ends = word.char_indices().rev().take(ENDING).filter(|(at, _)| *at > PHRASE);
        let mut stems = ends.filter_map(|(at, _)| v.title_word(&word[..at]));
        stems.find(|found| matches!(found, TitleWord::Percent | TitleWord::Qualifier))
    })
}

/// Whether a line says what stands in brackets, and that it is no spread: `Weft values in brackets`.
pub(super) fn says_what_is_in_brackets(text: &str, v: Vocabulary<'_>) -> bool {
    let words = words_of(text);
    let mut phrases = (1..=PHRASE).flat_map(|n| words.windows(n)).map(|words| words.join(" "));
    words.iter().any(|word| v.title_word(word) == Some(TitleWord::Place))
        && !phrases.any(|phrase| is_spread(&phrase, v) || v.statistic(&phrase) == Some(Statistic::Spread))
}

/// The same of the name of a sheet: only as its first or last words, `cotton_SD`; `Mean and SD` holds values.
fn is_name_of_no_values(name: &str, v: Vocabulary<'_>) -> bool {
    let name = folded(name);
    let words = words_of(&name);
    let ends = (1..=PHRASE.min(words.len())).flat_map(|n| [&words[..n], &words[words.len() - n..]]);
    !names_mean(&words, v)
        && !words.iter().any(|word| matches!(meaning(word, v), Some(TitleWord::And | TitleWord::With)))
        && ends.into_iter().map(|phrase| phrase.join(" ")).any(|phrase| {
            !NAMES.contains(&normalised(&phrase).as_str()) && is_of_comparison(&phrase, false, v)
        })
}

/// The name of a sheet that says so by itself, or is that of a spread beside a sheet of means.
pub(super) fn sheet_of_no_values(name: &str, sheets: &[&str], v: Vocabulary<'_>) -> Option<String> {
    let has_mean = sheets.iter().any(|other| v.statistic(other) == Some(Statistic::Mean));
    let beside_mean = has_mean && v.statistic(name) == Some(Statistic::Spread);
    (beside_mean || is_name_of_no_values(name, v)).then(|| name.to_string())
}

fn words_of(text: &str) -> Vec<&str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '%')).filter(|word| !word.is_empty()).collect()
}

/// Whether some of the words, up to three together, name a mean.
fn names_mean(words: &[&str], v: Vocabulary<'_>) -> bool {
    let mut phrases = (1..PHRASE).flat_map(|n| words.windows(n)).map(|words| words.join(" "));
    phrases.any(|phrase| v.statistic(&phrase) == Some(Statistic::Mean))
}

/// Whether some word of a text says that numbers are in per cent.
fn names_percent(text: &str, v: Vocabulary<'_>) -> bool {
    words_of(text).iter().any(|word| meaning(word, v) == Some(TitleWord::Percent))
}

fn is_of_comparison(phrase: &str, in_percent: bool, v: Vocabulary<'_>) -> bool {
    match v.title_word(phrase) {
        Some(TitleWord::NoValues) => true,
        Some(TitleWord::Change) => in_percent || is_spread(phrase, v),
        _ => is_spread(phrase, v),
    }
}

/// Chinese and Japanese have no blanks between words: the head is the last of them.
fn ends_with_comparison(head: &str, v: Vocabulary<'_>) -> bool {
    let chars: Vec<char> = head.trim().chars().collect();
    let is_wide = chars.iter().any(|c| *c >= '\u{1100}');
    let mut ends = (0..chars.len().saturating_sub(1)).map(|at| chars[at..].iter().collect::<String>());
    is_wide
        && !head.contains("平均")
        && ends.any(|end| {
            v.statistic(&end) == Some(Statistic::Spread) || v.title_word(&end) == Some(TitleWord::NoValues)
        })
}

/// `Table A2: …` and `Tab. 3 …` without what numbers it.
pub(super) fn without_number<'t>(text: &'t str, v: Vocabulary<'_>) -> &'t str {
    let mut parts = text.splitn(3, |c: char| c.is_whitespace() || matches!(c, ':' | '.'));
    let first = parts.next().unwrap_or_default();
    let stem = first.trim_end_matches(|c: char| c.is_ascii_digit());
    if v.title_word(stem) != Some(TitleWord::Table) {
        return text;
    }
    let rest = text[first.len()..].trim_start_matches([' ', '.', ':', '-']);
    let number = rest.split(|c: char| c.is_whitespace() || c == ':').next().unwrap_or_default();
    let is_number = stem.len() < first.len()
        || number.contains(|c: char| c.is_ascii_digit())
        || number.chars().count() == 1;
    if !is_number {
        return text;
    }
    let rest = if stem.len() < first.len() { rest } else { &rest[number.len()..] };
    rest.trim_start_matches([' ', '.', ':', '-', '|'])
}

/// Whether a title begins with the number of its table and goes on.
pub(super) fn is_numbered(title: &str, v: Vocabulary<'_>) -> bool {
    without_number(title, v).len() < title.len()
}

/// Whether a text is the number of a table: `Table A2`.
pub(super) fn is_number_of_table(text: &str, v: Vocabulary<'_>) -> bool {
    let mut words = text.split([' ', '.']).filter(|w| !w.is_empty());
    let (first, second) = (words.next().unwrap_or_default(), words.next());
    let stem = first.trim_end_matches(|c: char| c.is_ascii_digit());
    let is_numbered = stem.len() < first.len() || second.is_some_and(|w| w.chars().count() <= 5);
    v.title_word(stem) == Some(TitleWord::Table) && is_numbered && words.count() <= 1
}

/// Whether a phrase names a spread; of short ones only that of the deviation, as `CV` is viscose and `se` a word.
fn is_spread(phrase: &str, v: Vocabulary<'_>) -> bool {
    ["", "s", "en", "es"].iter().any(|plural| {
        let singular: Vec<&str> =
            phrase.split(' ').map(|word| word.strip_suffix(plural).unwrap_or(word)).collect();
        let name = singular.join(" ");
        // `CV%` is no name.
        let is_plain = name.chars().count() > PHRASE || !name.is_ascii() || name.ends_with('%');
        v.statistic(&name) == Some(Statistic::Spread)
            && (is_plain || v.table_column(&name) == Some(TableColumn::Sd))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_over_what_is_no_value() {
        let v = Vocabulary::new(&[]);
        for title in [
            "Table A2: Standard deviations of the KES parameters",
            "Standard deviations",
            "Table 3. Standard deviation of B",
            "Tab. 4 Standardabweichungen der KES-Werte",
            "SD",
            "Coefficients of variation (%)",
            "Coefficient of variation of the low-stress properties",
            "Change of KES parameters after washing (%)",
            "Percentage change in KES parameters after washing",
            "Differences in bending rigidity",
            "CV% of the KES parameters",
            "CV (%) of the KES parameters",
            "Relative change of B (%)",
            "Percentage change of bending rigidity",
            "Pearson correlation coefficients",
            "Correlation between B and hand",
            "Difference between warp and weft",
            "KES特性値の標準偏差",
            "表2 标准差",
            "RSD",
            "RSD of KES parameters",
            "Abweichung in %",
            "Percent retention",
            "Percent retention of B after washing",
            "Pearson's r",
            "Fabric A standard deviations",
            "Type I standard deviations",
            "Student's t values",
            "Relativen Änderungen (%)",
            "Prozentuelle Änderung",
            "Measurement uncertainty",
            "Table 4. Expanded uncertainty (k = 2)",
            "Minimum values",
            "Simulated values",
            "Korrelationskoeffizienten",
            "Changement en %",
            "Variação percentual",
            "KES特性値の最大値",
        ] {
            assert!(is_of_no_values(title, v), "{title}");
        }
        for title in [
            "Table 2: Means and standard deviations of the KES parameters",
            "KES parameters and standard deviations",
            "Mean values, standard deviations in brackets",
            "Results (SD)",
            "Standard deviations in brackets",
            "Changes of B by washing",
            "Table 1",
            "KES results of standard fabrics",
            "Variation of bending rigidity with washing",
            "CV",
            "Weight reduction (10%)",
            "Differences between fabrics are significant at p < 0.05",
            "Standard deviation of all values is below 5 %",
            "Effect of moisture variation (percent)",
            "Standard deviations in parentheses",
            "平均値と標準偏差",
            "Bending",
            "Percent cotton",
            "Simulated wear",
            "Minimum values and means",
            "Maximum load 50 gf/cm",
            "Gemessene Werte (Abweichung in Klammern)",
            "温度差",
        ] {
            assert!(!is_of_no_values(title, v), "{title}");
        }
        for name in ["SD", "cotton_SD", "Correlation", "standard deviation", "KES correlations", "Stdev"] {
            assert!(is_name_of_no_values(name, v), "{name}");
        }
        for name in ["mean_SD", "Mean ± SD", "CV", "cotton", "results 2", "Sigma"] {
            assert!(!is_name_of_no_values(name, v), "{name}");
        }
        assert!(sheet_of_no_values("CV", &["Mean", "CV"], v).is_some());
        assert!(sheet_of_no_values("CV", &["CV", "CO"], v).is_none());
    }

    #[test]
    fn numbers_of_tables() {
        let v = Vocabulary::new(&[]);
        for text in ["Table A2", "Table 3", "Tab. 4", "表2", "Table 3.1"] {
            assert!(is_number_of_table(text, v), "{text}");
        }
        for text in ["Table of contents here", "Date", "Tablecloth", "Sample 2"] {
            assert!(!is_number_of_table(text, v), "{text}");
        }
    }
}
