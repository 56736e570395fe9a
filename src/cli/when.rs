//! When something is made that nobody has to have, as typed.

use clap::ValueEnum;

use crate::run::{Drapes, FieldFiles};

/// [`FieldFiles`] and [`Drapes`] as typed.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum When {
    #[default]
    Auto,
    Always,
    Never,
}

impl From<When> for FieldFiles {
    fn from(typed: When) -> Self {
        match typed {
            When::Auto => Self::Auto,
            When::Always => Self::Always,
            When::Never => Self::Never,
        }
    }
}

impl From<When> for Drapes {
    fn from(typed: When) -> Self {
        match typed {
            When::Auto => Self::Auto,
            When::Always => Self::Always,
            When::Never => Self::Never,
        }
    }
}
