//! What findings say, as data: one enum for each group of codes, from which codes, fields and sentences are made.
//!
//! Each variant has its own code, typed fields (SI where nothing else is said) and the sentence that is written of
//! them. Programs ask the variant and its fields; nothing reads a sentence.

mod drape;
mod evaluation;
mod exchange;
mod parts;
mod reading;
mod section;
mod sentences;
mod study;
mod usage;

use std::fmt;

use serde::Serialize;
use serde::de::{DeserializeOwned, Error as _};
use serde_json::Value;

pub use drape::DrapeFact;
pub use evaluation::EvaluationFact;
pub use exchange::ExchangeFact;
pub use parts::{
    CoarseQuantity, Contradiction, Excess, LeftOutLine, Missed, RecordAxis, RefinementEnd, Renaming, Samples,
    StripLength, Subject,
};
pub use reading::ReadFact;
pub use section::SectionFact;
pub use study::StudyFact;
pub use usage::UsageFact;

/// The data of a JSON object, in the order of their declaration.
pub type Fields = serde_json::Map<String, Value>;

/// Makes an enum of facts: a variant, its code, its fields and the format of its sentence, with the arguments that
/// are not fields as they stand.
macro_rules! facts {
    ($(#[$meta:meta])* $name:ident {$(
        $(#[$doc:meta])* $code:literal $variant:ident { $($(#[$field_doc:meta])* $field:ident: $type:ty),* $(,)? }
            = $format:literal $(, $argument:expr)*;
    )*}) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize)]
        #[serde(tag = "code", content = "fields")]
        pub enum $name {$(
            #[doc = concat!("`", $code, "`: ")]
            $(#[$doc])*
            #[serde(rename = $code)]
            $variant { $($(#[$field_doc])* $field: $type),* },
        )*}

        impl $name {
            /// The stable code; see [`explain`](crate::finding::explain).
            pub fn code(&self) -> &'static str {
                match self { $(Self::$variant { .. } => $code,)* }
            }

            /// The fact of a code with these fields, if the code is one of this group.
            #[allow(unused_variables)]
            pub(super) fn read(code: &str, fields: &super::Fields) -> serde_json::Result<Option<Self>> {
                Ok(Some(match code {
                    $($code => Self::$variant { $($field: super::field(fields, stringify!($field))?),* },)*
                    _ => return Ok(None),
                }))
            }
        }

        /// The sentence: what was found, what was expected, what to do.
        impl std::fmt::Display for $name {
            #[allow(unused_variables)]
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                match self {
                    $(Self::$variant { $($field),* } => write!(f, $format $(, $argument)*),)*
                }
            }
        }
    };
}
use facts;

/// A field of a fact, as it was written. Facts are read field by field, as readers that are derived for some hundred
/// variants are a tenth of the program.
fn field<T: DeserializeOwned>(fields: &Fields, name: &str) -> serde_json::Result<T> {
    T::deserialize(fields.get(name).unwrap_or(&Value::Null))
        .map_err(|e| serde_json::Error::custom(format_args!("field `{name}`: {e}")))
}

/// What a finding says.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Fact {
    /// Of files (codes `R`).
    Reading(ReadFact),
    /// Of the evaluation of records and tables (`K`).
    Evaluation(EvaluationFact),
    /// Of what a sheet leaves open for a section (`C`).
    Section(SectionFact),
    /// Of a case and its results (`S`, `N`).
    Study(StudyFact),
    /// Of the task as it was given (`O`).
    Usage(UsageFact),
    /// Of other programs that read a card (`O`).
    Exchange(ExchangeFact),
    /// Of pictures of a drape test (`K`).
    Drape(DrapeFact),
}

impl Fact {
    /// The stable code, e.g. `K003`; see [`explain`](crate::finding::explain).
    pub fn code(&self) -> &'static str {
        match self {
            Self::Reading(fact) => fact.code(),
            Self::Evaluation(fact) => fact.code(),
            Self::Section(fact) => fact.code(),
            Self::Study(fact) => fact.code(),
            Self::Usage(fact) => fact.code(),
            Self::Exchange(fact) => fact.code(),
            Self::Drape(fact) => fact.code(),
        }
    }

    /// The fields by their names; numbers that are not finite are null.
    pub fn fields(&self) -> Fields {
        match serde_json::to_value(self) {
            Ok(Value::Object(mut document)) => match document.remove("fields") {
                Some(Value::Object(fields)) => fields,
                _ => Fields::new(),
            },
            _ => Fields::new(),
        }
    }
}

impl fmt::Display for Fact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reading(fact) => fact.fmt(f),
            Self::Evaluation(fact) => fact.fmt(f),
            Self::Section(fact) => fact.fmt(f),
            Self::Study(fact) => fact.fmt(f),
            Self::Usage(fact) => fact.fmt(f),
            Self::Exchange(fact) => fact.fmt(f),
            Self::Drape(fact) => fact.fmt(f),
        }
    }
}

/// A group of facts is a fact.
macro_rules! groups {
    ($($group:ident($name:ty)),*) => {
        impl Fact {
            /// The fact of a code with its fields, as [`Fact::code`] and [`Fact::fields`] give them.
            ///
            /// # Errors
            /// If there is no such code, or a field is not one of it.
            pub fn read(code: &str, fields: &Fields) -> serde_json::Result<Self> {
                $(if let Some(fact) = <$name>::read(code, fields)? {
                    return Ok(Self::$group(fact));
                })*
                Err(serde_json::Error::custom(format_args!("no finding has the code `{code}`")))
            }
        }
        $(
        impl From<$name> for Fact {
            fn from(fact: $name) -> Self {
                Self::$group(fact)
            }
        }
    )*};
}
groups!(
    Reading(ReadFact),
    Evaluation(EvaluationFact),
    Section(SectionFact),
    Study(StudyFact),
    Usage(UsageFact),
    Exchange(ExchangeFact),
    Drape(DrapeFact)
);
