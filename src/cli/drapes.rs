//! Which drape cases are solved, as typed.

use clap::ValueEnum;

use crate::run::Drapes;

/// [`Drapes`] as typed.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum DrapesArg {
    /// In runs of up to 20 fabrics, a quick one of each fabric with measured curves, without friction
    #[default]
    Auto,
    /// All, as their cases say: a minute or so for each fabric
    Always,
    /// None
    Never,
}

impl From<DrapesArg> for Drapes {
    fn from(typed: DrapesArg) -> Self {
        match typed {
            DrapesArg::Auto => Self::Auto,
            DrapesArg::Always => Self::Always,
            DrapesArg::Never => Self::Never,
        }
    }
}
