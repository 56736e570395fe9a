//! Diagnostics: stable codes, the place they speak of, and the text behind each code.
//!
//! A [`Finding`] is something a reader of the result must know; it never stops the work.
//! Errors are the layers' own types (`thiserror`) and carry the same codes, so that
//! `kesf explain CODE` has one table to look in: the TOML files in `codes/`.
//!
//! First letters: `R` reading files, `K` characterising, `C` constitutive assumptions and
//! sections, `M` meshes, elements and models, `N` numerics, `S` studies (cases and
//! comparisons), `O` output files and usage.

mod arrays;
mod error;
mod facts;
mod toml_file;
mod toml_words;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde::{Deserialize, Serialize, Serializer};

pub use crate::kes::Divisor;
pub(crate) use arrays::{array, arrays, optional_array};
#[cfg(feature = "results")]
pub(crate) use error::is_of_memory;
pub use error::{Coded, FailureKind};
pub(crate) use error::{as_text, errors, fields_of};
pub use facts::{
    CoarseQuantity, Contradiction, DrapeFact, EvaluationFact, Excess, ExchangeFact, Fact, Fields,
    LeftOutLine, Missed, ReadFact, RecordAxis, RefinementEnd, Renaming, Samples, SectionFact, StripLength,
    StudyFact, Subject, UsageFact,
};
pub use toml_file::Located;
pub(crate) use toml_file::{Node, ReadLater, TomlError, TomlFile, position};
#[cfg(feature = "parquet")]
pub(crate) use toml_words::nearest;
pub(crate) use toml_words::{in_words, with_meant};

/// Where in an input something was found. Lines and columns count from 1; a column counts
/// characters of the decoded line. 0 means "not applicable".
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Place {
    /// The file, as it was named to us.
    #[serde(serialize_with = "path_as_text")]
    pub path: PathBuf,
    /// Line, from 1; 0 when the whole file is meant.
    pub line: usize,
    /// Column, from 1; 0 when the whole line is meant.
    pub column: usize,
}

/// Writes a path as people read it: a name from an old share may be no UTF-8.
///
/// # Errors
/// Those of the serializer.
pub fn path_as_text<S: Serializer>(path: impl AsRef<Path>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.as_ref().display())
}

impl Place {
    /// A whole file.
    pub fn file(path: impl AsRef<Path>) -> Self {
        Self { path: path.as_ref().to_path_buf(), line: 0, column: 0 }
    }

    /// A position in a file.
    pub fn at(path: impl AsRef<Path>, line: usize, column: usize) -> Self {
        Self { path: path.as_ref().to_path_buf(), line, column }
    }
}

impl fmt::Display for Place {
    /// `file`, `file:line` or `file:line:column`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
            if self.column > 0 {
                write!(f, ":{}", self.column)?;
            }
        }
        Ok(())
    }
}

/// A non-fatal observation returned beside a result: what was found, and where.
///
/// As JSON it has `code`, `message`, `fields` (an object) and `place`; from JSON it is made of all but the message,
/// which is written anew from the fields.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub struct Finding {
    /// What was found.
    pub fact: Fact,
    /// The file and position it speaks of, where there is one.
    pub place: Option<Place>,
}

impl Finding {
    /// A finding without a place.
    pub fn new(fact: impl Into<Fact>) -> Self {
        Self { fact: fact.into(), place: None }
    }

    /// The same finding, at a place.
    pub fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    /// The stable code, e.g. `K003`; see [`explain`].
    pub fn code(&self) -> &'static str {
        self.fact.code()
    }

    /// One sentence: what was found, what was expected, what to do.
    pub fn message(&self) -> String {
        self.fact.to_string()
    }

    /// The data of the finding by their names, as they are in JSON.
    pub fn fields(&self) -> Fields {
        self.fact.fields()
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.place {
            Some(place) => write!(f, "{place}: {} {}", self.code(), self.fact),
            None => write!(f, "{} {}", self.code(), self.fact),
        }
    }
}

impl Serialize for Finding {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (code, message, fields) = (self.code(), self.message(), self.fields());
        Stated { code, message, fields, place: self.place.as_ref() }.serialize(serializer)
    }
}

/// What is written of a finding.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(rename = "Finding"))]
struct Stated<'f> {
    /// Code for `kesf explain`.
    code: &'static str,
    /// One sentence.
    message: String,
    /// What the sentence is made of, by name; numbers are SI.
    fields: Fields,
    /// Where it was found.
    place: Option<&'f Place>,
}

#[cfg(test)]
impl schemars::JsonSchema for Finding {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        <Stated as schemars::JsonSchema>::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        <Stated as schemars::JsonSchema>::json_schema(generator)
    }
}

/// A finding as it is written.
#[derive(Deserialize)]
struct Written {
    code: String,
    fields: Fields,
    place: Option<Place>,
}

impl TryFrom<Written> for Finding {
    type Error = serde_json::Error;

    fn try_from(Written { code, fields, place }: Written) -> Result<Self, serde_json::Error> {
        Ok(Self { fact: Fact::read(&code, &fields)?, place })
    }
}

/// The text behind a code, for `kesf explain`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Explanation {
    /// The code, e.g. `R004`.
    pub code: String,
    /// `error` (the input or task is not used) or `finding` (the result comes with it).
    pub kind: String,
    /// A headline.
    pub title: String,
    /// Why it occurs.
    pub cause: String,
    /// What it looks like.
    pub example: String,
    /// What to do.
    pub cure: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CodeFile {
    code: Vec<Explanation>,
}

/// Every code of the program with its explanation, ordered by code.
///
/// # Panics
/// Only if the tables that are compiled into the program are malformed; a test reads them.
pub fn explanations() -> &'static [Explanation] {
    static TABLE: OnceLock<Vec<Explanation>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut all: Vec<Explanation> = [
            include_str!("codes/read.toml"),
            include_str!("codes/characterise.toml"),
            include_str!("codes/constitutive.toml"),
            include_str!("codes/mechanics.toml"),
            include_str!("codes/study.toml"),
            include_str!("codes/output.toml"),
            include_str!("codes/usage.toml"),
        ]
        .into_iter()
        .flat_map(|text| toml::from_str::<CodeFile>(text).expect("built-in code table").code)
        .collect();
        all.sort_by(|a, b| a.code.cmp(&b.code));
        all
    })
}

/// The explanation of one code (any letter case), if there is such a code.
pub fn explain(code: &str) -> Option<&'static Explanation> {
    explanations().iter().find(|e| e.code.eq_ignore_ascii_case(code))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kes::{Direction, Key, Parameter, RecordName, Test};

    #[test]
    fn the_tables_parse_and_no_code_is_given_twice() {
        let all = explanations();
        assert!(!all.is_empty());
        for pair in all.windows(2) {
            assert_ne!(pair[0].code, pair[1].code);
        }
        for e in all {
            assert!(e.kind == "error" || e.kind == "finding", "{}: kind {}", e.code, e.kind);
            for text in [&e.title, &e.cause, &e.example, &e.cure] {
                assert!(!text.trim().is_empty(), "{}: empty text", e.code);
            }
        }
    }

    #[test]
    fn a_finding_is_its_fields_and_its_sentence_follows_from_them() {
        let record = RecordName { test: Test::Bending, direction: Some(Direction::Warp), specimen: 3 };
        let samples = Samples { numbers: vec![57, 91, 92, 93], lines: true };
        let dropout = EvaluationFact::Dropout { record, samples, abscissa: 250.0, ordinate: 0.0 };
        let finding = Finding::new(dropout).at(Place::at("a.csv", 57, 0));
        assert_eq!(
            finding.to_string(),
            "a.csv:57: K045 bending warp, specimen 3: samples jump away and back in lines 57, 91, 92 ..., first to \
             2.500 1/cm and 0 gf·cm/cm: a dropout? No evaluation uses them"
        );
        assert_eq!(
            serde_json::to_value(&finding).unwrap()["fields"],
            serde_json::json!({
                "record": { "test": "bending", "direction": "warp", "specimen": 3 },
                "samples": { "numbers": [57, 91, 92, 93], "lines": true },
                "abscissa": 250.0,
                "ordinate": 0.0,
            })
        );
    }

    #[test]
    fn findings_are_read_as_they_were_written() {
        let key = Key { parameter: Parameter::T0, direction: None };
        let facts: [Fact; 6] = [
            ReadFact::NoFabricFile {}.into(),
            ReadFact::AssumedDimension {
                dimension: Divisor::Gauge,
                value: 0.05,
                test: Some(Test::Shear),
                not_understood: Vec::new(),
            }
            .into(),
            EvaluationFact::Implausible { key, value: 5e-3, range: Some([0.1, 2.0]) }.into(),
            SectionFact::OneRigidity { fabric: "poplin".into(), known: None }.into(),
            StudyFact::NotJoined { nodes: 2, at: [0.1, 0.2, 0.0] }.into(),
            UsageFact::Renamed { name: "a".into(), renamed: "a-2".into(), because: Renaming::CaseTwice }
                .into(),
        ];
        for fact in facts {
            for place in [None, Some(Place::at("a.csv", 3, 7))] {
                let finding = Finding { fact: fact.clone(), place };
                let text = serde_json::to_string(&finding).unwrap();
                assert_eq!(serde_json::from_str::<Finding>(&text).unwrap(), finding, "{text}");
            }
        }
    }

    #[test]
    fn a_place_prints_only_what_it_knows() {
        assert_eq!(Place::file("a.csv").to_string(), "a.csv");
        assert_eq!(Place::at("a.csv", 3, 0).to_string(), "a.csv:3");
        assert_eq!(Place::at("a.csv", 3, 7).to_string(), "a.csv:3:7");
    }
}
