//! When something is made that nobody has to have, as typed.

use std::ffi::OsString;

use clap::ValueEnum;

/// Whether fields are written and drapes solved, as typed.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum When {
    #[default]
    Auto,
    Always,
    Never,
}

impl When {
    /// Yes or no; nothing where the program is to decide.
    pub fn answer(self) -> Option<bool> {
        match self {
            Self::Auto => None,
            Self::Always => Some(true),
            Self::Never => Some(false),
        }
    }
}

/// Joins `--drape never` to `--drape=never`: the option may stand alone, so that the word behind it would be an input, and
/// every drape be computed. A path of that name is `./never`.
pub fn joined(arguments: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut out: Vec<OsString> = Vec::new();
    for argument in arguments {
        let is_when = argument.to_str().is_some_and(|word| When::from_str(word, false).is_ok());
        match out.last_mut().filter(|last| is_when && *last == "--drape") {
            Some(last) => last.push(format!("={}", argument.display())),
            None => out.push(argument),
        }
    }
    out
}
