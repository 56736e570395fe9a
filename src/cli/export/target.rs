//! Names of programs behind `--to`.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Command, Error};

use crate::report::cards::{ALL, EXPORTERS, not_written};

/// A name that `kesf list exports` has; one for which nothing is written is answered with the reason.
#[derive(Clone, Debug)]
pub struct TargetName;

fn names() -> impl Iterator<Item = &'static str> {
    EXPORTERS.iter().map(|target| target.name).chain([ALL])
}

impl TypedValueParser for TargetName {
    type Value = String;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<String, Error> {
        let name = value.to_string_lossy();
        match not_written(&name) {
            Some(none) if !names().any(|own| own == name) => {
                let text = format!(
                    "nothing is written for {}: {}\n\n`kesf list exports` tells what is written.\n",
                    none.title, none.why
                );
                Err(Error::raw(ErrorKind::ValueValidation, text).with_cmd(command))
            }
            _ => PossibleValuesParser::new(names()).parse_ref(command, argument, value),
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(names().map(PossibleValue::new)))
    }
}
