//! Errors as data: what every error of this program has, and the macro that makes their enums.

use std::error::Error;
use std::fmt::Display;

use serde::Serializer;

use super::{Fields, Place};

/// What kind of failure an error is, for those who must choose what to do about it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FailureKind {
    /// The input, the task or the place of the output is at fault.
    #[default]
    Input,
    /// The numerics failed: no factor, no equilibrium, a step that vanished.
    Numerics,
    /// It was interrupted.
    Interrupted,
}

/// Codes that mean that numerics failed, rather than the input, or that a search did not reach its end.
const NUMERIC: [&str; 12] =
    ["N001", "N002", "N003", "N004", "N005", "N006", "N007", "N010", "N012", "N021", "S004", "S112"];

/// Codes of failures for want of memory, which another run may not meet.
#[cfg_attr(not(feature = "results"), allow(dead_code))]
const OF_MEMORY: [&str; 2] = ["N002", "N011"];

/// Whether a code is that of a failure for want of memory.
#[cfg_attr(not(feature = "results"), allow(dead_code))]
pub(crate) fn is_of_memory(code: &str) -> bool {
    OF_MEMORY.contains(&code)
}

/// The code of an interruption.
const INTERRUPTED: &str = "O054";

impl FailureKind {
    /// The kind of the errors of a code.
    pub fn of_code(code: &str) -> Self {
        match code {
            INTERRUPTED => Self::Interrupted,
            _ if NUMERIC.contains(&code) => Self::Numerics,
            _ => Self::Input,
        }
    }
}

/// An error of any layer: a stable code, typed fields, the place where it has one, and the sentence made of them.
///
/// Its text ([`Display`]) is `place: code message; hint`, without what it does not have.
pub trait Coded: Error {
    /// The stable code, e.g. `R004`; see [`explain`](super::explain).
    fn code(&self) -> &'static str;

    /// The sentence, without code, place and hint.
    fn message(&self) -> String;

    /// The data of the sentence by their names; numbers are SI where nothing else is said.
    fn fields(&self) -> Fields;

    /// File and position.
    fn place(&self) -> Option<Place> {
        None
    }

    /// What to do about it, where the sentence does not say so.
    fn hint(&self) -> Option<&'static str> {
        None
    }

    /// The fabric that is lost by it, where a file has several.
    fn fabric(&self) -> Option<String> {
        None
    }

    /// What kind of failure it is.
    fn kind(&self) -> FailureKind {
        FailureKind::of_code(self.code())
    }
}

/// Writes a value as people read it.
///
/// # Errors
/// Those of the serializer.
pub(crate) fn as_text<S: Serializer>(value: &impl Display, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}

/// The fields of an error.
pub(crate) fn fields_of(error: &impl serde::Serialize) -> Fields {
    match serde_json::to_value(error) {
        Ok(serde_json::Value::Object(fields)) => fields,
        _ => Fields::new(),
    }
}

/// Makes the enum of the errors of a layer, and all of [`Coded`] for it.
///
/// First come the errors of other layers that are its own (`from` with a conversion, `inner` without), and those that
/// it gives a fabric (`of_fabric`); then the variants, each with its code, its fields, the place that it speaks of
/// (`at`), the format of its sentence with the arguments that are not fields as they stand, and its hint (`=>`).
macro_rules! errors {
    (
        $(#[$meta:meta])* pub enum $name:ident {
            $(from { $($(#[$from_doc:meta])* $from:ident($from_type:ty)),* $(,)? })?
            $(inner { $($(#[$inner_doc:meta])* $inner:ident($inner_type:ty)),* $(,)? })?
            $(of_fabric { $($(#[$with_doc:meta])* $with:ident($with_type:ty)),* $(,)? })?
            $(
                $(#[$doc:meta])* $code:literal $variant:ident
                $({ $($(#[$field_doc:meta])* $field:ident: $type:ty),* $(,)? })?
                $(at $place:expr,)?
                = $format:literal $(, $argument:expr)* $(=> $hint:literal)?;
            )*
        }
    ) => {
        $(#[$meta])*
        #[derive(serde::Serialize)]
        #[serde(untagged)]
        pub enum $name {
            $($($(#[$from_doc])* $from($from_type),)*)?
            $($($(#[$inner_doc])* $inner($inner_type),)*)?
            $($(
                $(#[$with_doc])*
                $with {
                    /// Name of the fabric.
                    fabric: String,
                    /// What is wrong.
                    #[serde(flatten)]
                    source: $with_type,
                },
            )*)?
            $($(#[$doc])* $variant $({ $($(#[$field_doc])* $field: $type),* })?,)*
        }

        impl $name {
            /// The stable code; see [`explain`](crate::finding::explain).
            pub fn code(&self) -> &'static str {
                match self {
                    $($(Self::$from(e) => e.code(),)*)?
                    $($(Self::$inner(e) => e.code(),)*)?
                    $($(Self::$with { source, .. } => source.code(),)*)?
                    $(Self::$variant { .. } => $code,)*
                }
            }
        }

        impl $crate::finding::Coded for $name {
            fn code(&self) -> &'static str {
                Self::code(self)
            }

            #[allow(unused_variables)]
            fn message(&self) -> String {
                match self {
                    $($(Self::$from(e) => $crate::finding::Coded::message(e),)*)?
                    $($(Self::$inner(e) => $crate::finding::Coded::message(e),)*)?
                    $($(Self::$with { fabric, source } => {
                        format!("{} ({fabric})", $crate::finding::Coded::message(source))
                    })*)?
                    $(Self::$variant { $($($field),*)? } => format!($format $(, $argument)*),)*
                }
            }

            fn fields(&self) -> $crate::finding::Fields {
                $crate::finding::fields_of(self)
            }

            #[allow(unused_variables)]
            fn place(&self) -> Option<$crate::finding::Place> {
                match self {
                    $($(Self::$from(e) => $crate::finding::Coded::place(e),)*)?
                    $($(Self::$inner(e) => $crate::finding::Coded::place(e),)*)?
                    $($(Self::$with { source, .. } => $crate::finding::Coded::place(source),)*)?
                    $(Self::$variant { $($($field),*)? } => $crate::finding::errors!(@optional $($place)?),)*
                }
            }

            fn hint(&self) -> Option<&'static str> {
                match self {
                    $($(Self::$from(e) => $crate::finding::Coded::hint(e),)*)?
                    $($(Self::$inner(e) => $crate::finding::Coded::hint(e),)*)?
                    $($(Self::$with { source, .. } => $crate::finding::Coded::hint(source),)*)?
                    $(Self::$variant { .. } => $crate::finding::errors!(@optional $($hint)?),)*
                }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                use $crate::finding::Coded;
                if let Some(place) = Coded::place(self) {
                    write!(f, "{place}: ")?;
                }
                write!(f, "{} {}", self.code(), Coded::message(self))?;
                Coded::hint(self).map_or(Ok(()), |hint| write!(f, "; {hint}"))
            }
        }

        impl std::error::Error for $name {}

        $($(
            impl From<$from_type> for $name {
                fn from(e: $from_type) -> Self {
                    Self::$from(e)
                }
            }
        )*)?
    };
    (@optional) => { None };
    (@optional $value:expr) => { Some($value) };
}
pub(crate) use errors;

#[cfg(test)]
mod tests {
    use super::*;

    errors! {
        /// Of a lower layer.
        #[derive(Debug)]
        pub enum Lower {
            /// Without fields.
            "N008" Empty = "there is nothing";
            /// At a place.
            "R004" At {
                /// Where.
                #[serde(skip)]
                place: Place,
                /// What.
                found: Vec<f64>,
            } at place.clone(), = "{} numbers, the first is {:.1}", found.len(), found[0] => "count again";
        }
    }

    errors! {
        /// Of an upper one.
        #[derive(Debug)]
        pub enum Upper {
            from {
                /// Its own.
                Below(Lower),
            }
            of_fabric {
                /// That of a fabric.
                Of(Lower),
            }
            /// Numerics.
            "N005" Vanished {
                /// When (s).
                time: f64,
            } = "the step vanished at t = {time} s";
        }
    }

    fn found() -> Lower {
        Lower::At { place: Place::at("a.csv", 3, 7), found: vec![0.25, 1.0] }
    }

    #[test]
    fn an_error_is_its_fields_and_its_text_follows_from_them() {
        let error = Upper::from(found());
        assert_eq!(error.to_string(), "a.csv:3:7: R004 2 numbers, the first is 0.2; count again");
        assert_eq!((error.code(), error.message().as_str()), ("R004", "2 numbers, the first is 0.2"));
        assert_eq!(serde_json::Value::Object(error.fields()), serde_json::json!({ "found": [0.25, 1.0] }));
        assert_eq!((error.place(), error.hint()), (Some(Place::at("a.csv", 3, 7)), Some("count again")));
        let error = Upper::Of { fabric: "poplin".into(), source: found() };
        assert_eq!(error.to_string(), "a.csv:3:7: R004 2 numbers, the first is 0.2 (poplin); count again");
        let fields = serde_json::json!({ "fabric": "poplin", "found": [0.25, 1.0] });
        assert_eq!(serde_json::Value::Object(error.fields()), fields);
        let empty = Upper::Below(Lower::Empty);
        assert_eq!((empty.to_string().as_str(), empty.fields().len()), ("N008 there is nothing", 0));
    }

    #[test]
    fn the_code_tells_what_kind_of_failure_it_is() {
        assert_eq!(Upper::Vanished { time: 0.1 }.kind(), FailureKind::Numerics);
        assert_eq!(Upper::Below(Lower::Empty).kind(), FailureKind::Input);
        assert_eq!(FailureKind::of_code("O054"), FailureKind::Interrupted);
    }
}
