//! When fields of sheets are written, as typed.

use clap::ValueEnum;

use crate::run::FieldFiles;

/// [`FieldFiles`] as typed.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum FieldsArg {
    /// In runs of up to 100 fabrics
    #[default]
    Auto,
    /// Of every fabric
    Always,
    /// Of none
    Never,
}

impl From<FieldsArg> for FieldFiles {
    fn from(typed: FieldsArg) -> Self {
        match typed {
            FieldsArg::Auto => Self::Auto,
            FieldsArg::Always => Self::Always,
            FieldsArg::Never => Self::Never,
        }
    }
}
