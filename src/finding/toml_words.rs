//! What a TOML file should have said, in a user's words.

use strsim::normalized_damerau_levenshtein as alike;

/// Rust's words in the messages of deserialisers, and those of TOML.
const WORDS: [(&str, &str); 19] = [
    ("expected usize", "expected a whole number, 0 or more"),
    ("expected u8", "expected a whole number from 0 to 255"),
    ("expected u16", "expected a whole number from 0 to 65535"),
    ("expected u32", "expected a whole number, 0 or more"),
    ("expected u64", "expected a whole number, 0 or more"),
    ("expected i32", "expected a whole number"),
    ("expected i64", "expected a whole number"),
    ("expected f64", "expected a number"),
    ("expected a boolean", "expected true or false"),
    ("expected a sequence", "expected an array"),
    ("expected a map", "expected a table"),
    ("invalid type: map", "invalid type: table"),
    ("invalid type: sequence", "invalid type: array"),
    ("invalid type: floating point", "invalid type: number"),
    ("invalid type: integer", "invalid type: whole number"),
    ("invalid value: integer", "invalid value: whole number"),
    ("unknown field", "unknown key"),
    ("missing field", "missing key"),
    ("duplicate field", "duplicate key"),
];

/// How alike a word and one that is known must be for the one to be a slip of the other.
const ALIKE: f64 = 0.6;

/// The message of an error, in one line: in the words of TOML, and with the key or word that was probably meant.
/// Deserialisers give sentences only; they are never asked what is wrong, they are worded anew.
pub(crate) fn in_words(error: &toml::de::Error) -> String {
    let mut message = error.message().lines().map(str::trim).collect::<Vec<_>>().join("; ");
    message = with_meant(message);
    for (rust, toml) in WORDS {
        if let Some(at) = message.find(rust)
            && !message[at + rust.len()..].starts_with(char::is_alphanumeric)
        {
            message.replace_range(at..at + rust.len(), toml);
        }
    }
    if let Some(at) = message.find("expected struct ") {
        message.replace_range(at.., "expected a table");
    }
    if message.ends_with("expected an array") {
        message.push_str(match message.contains("invalid type: table") {
            true => ": what may come several times has double brackets, [[name]]",
            false => ": write it between brackets, [1, 2]",
        });
    }
    message
}

/// The same message, with the word that was probably meant where it names an unknown one and then those that are known.
pub(crate) fn with_meant(message: String) -> String {
    match meant(&message) {
        Some(word) => format!("{message}; did you mean `{word}`?"),
        None => message,
    }
}

/// The known word that an unknown one is nearest to, if it is near.
fn meant(message: &str) -> Option<&str> {
    if !message.starts_with("unknown ") {
        return None;
    }
    let mut words = message.split('`').skip(1).step_by(2);
    let found = words.next()?;
    nearest(found, words)
}

/// The known word that another is nearest to, if it is near; capitals count for nothing.
pub(crate) fn nearest<'w>(found: &str, known: impl IntoIterator<Item = &'w str>) -> Option<&'w str> {
    let found = found.to_lowercase();
    let known = known.into_iter().map(|word| (alike(&found, &word.to_lowercase()), word));
    let (likeness, word) = known.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (likeness >= ALIKE).then_some(word)
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code, reason = "what is read is not looked at")]
    struct Sheet {
        width: f64,
        cells: Option<[usize; 2]>,
        kind: Option<Kind>,
        large_rotations: Option<bool>,
        layers: Option<Vec<u8>>,
        inner: Option<Box<Sheet>>,
    }

    #[derive(Debug, Deserialize)]
    #[serde(rename_all = "snake_case")]
    enum Kind {
        Rectangle,
        Disc,
    }

    #[test]
    fn messages_are_in_the_words_of_toml() {
        for (text, expected) in [
            ("width = \"2\"", "invalid type: string \"2\", expected a number"),
            ("width = 1\ncells = [1.5, 2]", "invalid type: number `1.5`, expected a whole number, 0 or more"),
            (
                "width = 1\nlayers = [300]",
                "invalid value: whole number `300`, expected a whole number from 0 to 255",
            ),
            ("width = 1\nlarge_rotations = 1", "invalid type: whole number `1`, expected true or false"),
            (
                "width = 1\nlayers = 3",
                "invalid type: whole number `3`, expected an array: write it between brackets, [1, 2]",
            ),
            (
                "width = 1\n[layers]\nof = 1",
                "invalid type: table, expected an array: what may come several times has double brackets, [[name]]",
            ),
            ("width = 1\ninner = 3", "invalid type: whole number `3`, expected a table"),
            ("cells = [1, 2]", "missing key `width`"),
        ] {
            assert_eq!(in_words(&toml::from_str::<Sheet>(text).unwrap_err()), expected);
        }
    }

    #[test]
    fn a_slip_is_told_what_was_meant() {
        let said = |text: &str| in_words(&toml::from_str::<Sheet>(text).unwrap_err());
        let key = said("widht = 1");
        assert!(key.starts_with("unknown key `widht`, expected one of "), "{key}");
        assert!(key.ends_with("; did you mean `width`?"), "{key}");
        assert!(said("width = 1\nLarge-Rotations = true").ends_with("did you mean `large_rotations`?"));
        assert!(said("width = 1\nkind = \"disk\"").ends_with("did you mean `disc`?"));
        assert!(!said("width = 1\nxyz = 1").contains("did you mean"));
    }
}
