//! Layouts as data: the words, marks and units of a laboratory's files.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use serde::{Deserialize, Deserializer, de};

use super::conditions::StatedConditions;
use super::unit_text::{is_volt, unit};
use super::words::{folded, normalised};
use super::{Direction, Parameter, Test};
use crate::finding::arrays;
pub use crate::kes::Role;

/// What a header line states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum HeaderKey {
    /// Name of the fabric.
    Sample,
    /// Number of the specimen.
    Specimen,
    /// Instrument or test.
    Test,
    /// Yarn direction.
    Direction,
    /// Specimen width.
    Width,
    /// Distance between jaws or clamps.
    Gauge,
    /// Length of the specimen: the distance between the jaws, unless it is that of the cloth that was cut.
    Length,
    /// Width and distance between the jaws in one: `20 x 5 cm`.
    Size,
    /// Area of the compression foot.
    Area,
    /// Set maximum of the drive or load.
    Maximum,
    /// Constant tension during shear, or along a sweep.
    Pretension,
    /// Load on the contactor of a sweep.
    Contact,
    /// Full scale of the ordinate, in volts that of [`HeaderKey::Voltage`] or 10 V.
    Sens,
    /// Full scale of the abscissa.
    SensX,
    /// Voltage of an analogue output at the full scale.
    Voltage,
    /// Areal density from a balance.
    Weight,
    /// A number that the samples are to be multiplied by, or were: it is told, never applied.
    Factor,
    /// Known and kept as text: date, operator, speed, side, remarks.
    Remark,
    /// Who measured when, in what climate and which file: what differs between repeats of one state.
    Circumstance,
}

/// What a column of a result table holds, apart from parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum TableColumn {
    /// Identifier of the fabric; goes before `Fabric`.
    Id,
    /// Name of the fabric.
    Fabric,
    /// Number of the specimen: its rows are averaged.
    Specimen,
    /// Number of a specimen or of a sample, which the word does not say: read as `Specimen`, and told (R132).
    Number,
    /// Symbol of the parameter (long form).
    Parameter,
    /// Value (long form).
    Value,
    /// Unit of the row (long form).
    Unit,
    /// Direction of the row.
    Direction,
    /// Standard deviation of the row (long form).
    Sd,
    /// Number of repeats of the row.
    N,
    /// How the row was had: `measured`, `inferred`, `assumed` or `doubtful`, and words for these (long form).
    Status,
    /// A factor of the row: its words are those of [`HeaderKey::Factor`].
    #[serde(skip)]
    Factor,
}

impl TableColumn {
    /// Whether it names fabrics or specimens, row by row.
    pub(super) fn names_rows(self) -> bool {
        matches!(self, Self::Id | Self::Fabric | Self::Specimen | Self::Number)
    }

    /// Whether its numbers may be those of specimens.
    pub(super) fn counts(self) -> bool {
        matches!(self, Self::Specimen | Self::Number)
    }
}

/// How a row or a column sums up others; it is no specimen itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Statistic {
    /// The mean.
    Mean,
    /// Standard deviation, coefficient of variation and the like.
    Spread,
    /// Extremes, median, number.
    Other,
}

/// A word in the title of a table, or in the name of its sheet, that tells what the numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum TitleWord {
    /// It stands before the number of a table: `Table`, `Appendix`.
    Table,
    /// Such numbers are no values of a fabric: `correlation`, `p values`, `uncertainty`.
    NoValues,
    /// They are none if they are in per cent, else it may be told by values: `changes of B by washing`.
    Change,
    /// They are in per cent.
    Percent,
    /// It stands before a change without making it that of something else: `relative`, `mean`.
    Qualifier,
    /// It leads on to what the numbers are of: `of`, `between`.
    Of,
    /// The title names more than one thing: `and`.
    And,
    /// It leads on, or names one thing more: `with`.
    With,
    /// A remark has it, and no title: `are`.
    Verb,
    /// Where deviations stand that a remark speaks of, behind one more word: `in brackets`.
    Place,
}

/// Which way the drive goes in a column that holds one branch of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BranchColumn {
    /// Loading.
    Loading,
    /// Unloading.
    Unloading,
}

/// What stands beside a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum DirectionWord {
    /// It turns it: `across the warp`, `not warp`.
    Across,
    /// It adds nothing: `along the warp`, `warp yarns`.
    Along,
    /// In the heading of a curve it is a dimension or a part of a name: `force per width`, `longitudinal strain`.
    Dimension,
}

/// The words and marks of one kind of file. A laboratory with a layout of its own writes one.
///
/// Words are compared after NFKC in lower case, without accents, blanks and punctuation.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Dialect {
    /// Short name, e.g. `kes-japanese`.
    pub name: String,
    /// One line about it.
    pub title: String,
    /// Texts that a file must contain, all of them, for the settings below to apply; empty: every file.
    #[serde(rename = "match")]
    pub matches: Vec<String>,
    /// Encoding label (WHATWG), e.g. `shift_jis`; decided from the bytes if absent.
    #[serde(deserialize_with = "encoding")]
    pub encoding: Option<String>,
    /// Cell delimiter, e.g. `"\t"`; decided from the rows if absent.
    pub delimiter: Option<char>,
    /// Decimal mark, `.` or `,`; decided from the rows if absent.
    #[serde(deserialize_with = "decimal_mark")]
    pub decimal: Option<char>,
    /// Whether numbers without a unit are in the customary KES unit. Otherwise they are refused.
    pub kes_units: bool,
    /// The test, where files do not say.
    pub test: Option<Test>,
    /// Columns in order, for files without headings.
    pub column_order: Vec<Role>,
    /// Units of columns that state none.
    #[serde(deserialize_with = "units")]
    pub units: BTreeMap<Role, String>,
    /// Heading words of curve columns.
    #[serde(deserialize_with = "distinct_words")]
    pub columns: BTreeMap<Role, Vec<String>>,
    /// Words of header lines.
    #[serde(deserialize_with = "distinct_words")]
    pub keys: BTreeMap<HeaderKey, Vec<String>>,
    /// Words of directions.
    #[serde(deserialize_with = "distinct_words")]
    pub directions: BTreeMap<Direction, Vec<String>>,
    /// Letters of warp and weft: directions only in a column of directions, or where each stands beside the other.
    #[serde(deserialize_with = "pairs")]
    pub direction_letters: Vec<[String; 2]>,
    /// Words beside those of directions.
    #[serde(deserialize_with = "words")]
    pub direction_words: BTreeMap<DirectionWord, Vec<String>>,
    /// Words of tests.
    #[serde(deserialize_with = "distinct_words")]
    pub tests: BTreeMap<Test, Vec<String>>,
    /// Words of columns that hold one branch of a curve.
    #[serde(deserialize_with = "words")]
    pub branches: BTreeMap<BranchColumn, Vec<String>>,
    /// Heading words of result tables.
    #[serde(deserialize_with = "words")]
    pub table: BTreeMap<TableColumn, Vec<String>>,
    /// Words of rows and columns that sum up others.
    #[serde(deserialize_with = "words")]
    pub statistics: BTreeMap<Statistic, Vec<String>>,
    /// Words of titles that say what the numbers of a table are.
    #[serde(deserialize_with = "words")]
    pub titles: BTreeMap<TitleWord, Vec<String>>,
    /// Other names of parameters, by symbol.
    #[serde(deserialize_with = "symbols")]
    pub symbols: BTreeMap<String, Vec<String>>,
    /// Conditions that the files leave out.
    pub conditions: StatedConditions,
}

fn words<'de, D, K>(d: D) -> Result<BTreeMap<K, Vec<String>>, D::Error>
where
    D: Deserializer<'de>,
    K: Deserialize<'de> + Ord,
{
    let map = BTreeMap::<K, Vec<String>>::deserialize(d)?;
    Ok(map.into_iter().map(|(k, v)| (k, v.iter().map(|w| normalised(w)).collect())).collect())
}

/// Words each of which has one meaning.
fn distinct_words<'de, D, K>(d: D) -> Result<BTreeMap<K, Vec<String>>, D::Error>
where
    D: Deserializer<'de>,
    K: Deserialize<'de> + Ord,
{
    let map: BTreeMap<K, Vec<String>> = words(d)?;
    let mut seen = BTreeSet::new();
    // A word may stand twice in one list, in two ways of writing.
    for of_key in map.values().map(|words| words.iter().collect::<BTreeSet<_>>()) {
        if let Some(word) = of_key.into_iter().find(|word| !seen.insert(word.as_str())) {
            return Err(de::Error::custom(format!("the word `{word}` has two meanings: keep one of them")));
        }
    }
    Ok(map)
}

/// Names of parameters, by symbols that there are.
fn symbols<'de, D: Deserializer<'de>>(d: D) -> Result<BTreeMap<String, Vec<String>>, D::Error> {
    let map: BTreeMap<String, Vec<String>> = distinct_words(d)?;
    match map.keys().find(|symbol| Parameter::from_symbol(symbol).is_none()) {
        Some(symbol) => Err(de::Error::custom(format!(
            "`{symbol}` is the symbol of no parameter, such as B, 2HB, G, LT or T0"
        ))),
        None => Ok(map),
    }
}

/// Units that are known.
fn units<'de, D: Deserializer<'de>>(d: D) -> Result<BTreeMap<Role, String>, D::Error> {
    let map = BTreeMap::<Role, String>::deserialize(d)?;
    for text in map.values().filter(|text| !is_volt(text)) {
        unit(text).map_err(de::Error::custom)?;
    }
    Ok(map)
}

/// A letter as it is compared: with its accents, since `Ç` is a warp where `C` may be a course.
pub(super) fn letter_of(text: &str) -> String {
    folded(text).to_lowercase()
}

fn pairs<'de, D: Deserializer<'de>>(d: D) -> Result<Vec<[String; 2]>, D::Error> {
    let pairs: Vec<[String; 2]> = arrays(d)?;
    Ok(pairs.into_iter().map(|pair| pair.map(|letter| letter_of(&letter))).collect())
}

fn encoding<'de, D: Deserializer<'de>>(d: D) -> Result<Option<String>, D::Error> {
    let label = String::deserialize(d)?;
    if encoding_rs::Encoding::for_label(label.as_bytes()).is_none() {
        return Err(de::Error::custom(format!("`{label}` is not an encoding label such as \"shift_jis\"")));
    }
    Ok(Some(label))
}

fn decimal_mark<'de, D: Deserializer<'de>>(d: D) -> Result<Option<char>, D::Error> {
    match char::deserialize(d)? {
        mark @ ('.' | ',') => Ok(Some(mark)),
        other => Err(de::Error::custom(format!("`{other}` is not a decimal mark: \".\" or \",\""))),
    }
}

impl Dialect {
    /// Reads a dialect from TOML.
    ///
    /// # Errors
    /// The parser's, with its position in the text.
    pub fn from_toml(text: &str) -> Result<Self, toml::de::Error> {
        toml::from_str(text)
    }

    /// Whether its settings apply to a file of this text.
    pub(super) fn applies_to(&self, text: &str) -> bool {
        self.matches.iter().all(|m| text.contains(m.as_str()))
    }

    /// Every heading and key word, for naming the closest dialect.
    pub(super) fn vocabulary(&self) -> impl Iterator<Item = &str> {
        let columns = self.columns.values().chain(self.keys.values()).chain(self.table.values());
        columns.chain(self.symbols.values()).flatten().map(String::as_str)
    }
}

/// The dialects that are built in: their words are known for every file.
///
/// # Panics
/// Only if the files that are compiled into the program are malformed; a test reads them.
pub fn dialects() -> &'static [Dialect] {
    static TABLE: OnceLock<Vec<Dialect>> = OnceLock::new();
    TABLE.get_or_init(|| {
        DIALECT_FILES.iter().map(|text| Dialect::from_toml(text).expect("built-in dialect")).collect()
    })
}

/// The texts of the built-in dialects, one file for each language: examples for dialect files of one's own.
pub const DIALECT_FILES: [&str; 14] = [
    include_str!("dialects/english.toml"),
    include_str!("dialects/japanese.toml"),
    include_str!("dialects/portuguese.toml"),
    include_str!("dialects/german.toml"),
    include_str!("dialects/french.toml"),
    include_str!("dialects/italian.toml"),
    include_str!("dialects/spanish.toml"),
    include_str!("dialects/dutch.toml"),
    include_str!("dialects/polish.toml"),
    include_str!("dialects/czech.toml"),
    include_str!("dialects/turkish.toml"),
    include_str!("dialects/chinese.toml"),
    include_str!("dialects/chinese-traditional.toml"),
    include_str!("dialects/korean.toml"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_dialects_parse_and_have_names() {
        assert!(dialects().iter().all(|d| !d.name.is_empty() && !d.title.is_empty()));
        assert!(dialects().iter().all(|d| d.vocabulary().count() > 5));
    }

    #[test]
    fn an_unknown_key_of_a_dialect_is_refused() {
        assert!(Dialect::from_toml("name = \"x\"\ndelimeter = \";\"").is_err());
    }

    #[test]
    fn what_a_file_could_not_be_read_by_is_refused() {
        for (toml, said) in [
            ("[directions]\nwarp = [\"SD\", \"up\"]\nweft = [\"s d\"]", "`sd` has two meanings"),
            ("[columns]\nmoment = [\"M\"]\ncurvature = [\"m\"]", "`m` has two meanings"),
            ("[symbols]\nXX = [\"Kenn1\"]", "`XX` is the symbol of no parameter"),
            ("[units]\ncurvature = \"1/furlong\"", "furlong"),
        ] {
            let error = Dialect::from_toml(toml).unwrap_err();
            assert!(error.to_string().contains(said) && error.span().is_some(), "{error}");
        }
        let volts = "[units]\nmoment = \"V\"\n[directions]\nwarp = [\"SD\", \"s d\"]";
        assert!(Dialect::from_toml(volts).is_ok());
    }
}
