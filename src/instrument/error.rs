//! Why a file was not read: what was found, what was expected, what to do.

use serde::Serialize;
use thiserror::Error;

use crate::finding::{Coded, Fields, Finding, Place, ReadFact, fields_of};

/// A file, or a place in it, that cannot be read. One error never concerns more than one file.
///
/// Its text is one line: `file:line:column: R004 "0,35" is not a number (decimal mark is '.')`.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{place}: {} {problem}", .problem.code())]
pub struct ReadError {
    /// The file and position.
    pub place: Place,
    /// What is wrong there.
    pub problem: ReadProblem,
    /// What else is known.
    pub about: Box<About>,
}

/// What is known of an error besides its place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct About {
    /// The fabric that is lost by it: one of a table, that of a folder whose fabric.toml or dialect.toml is bad, or that of a
    /// link; none if it costs one file only.
    pub fabric: Option<String>,
    /// What had been decided about the file until then, for people (`kesf check -v`).
    pub inference: Vec<String>,
}

impl ReadError {
    /// A problem at a place.
    pub fn new(place: Place, problem: ReadProblem) -> Self {
        Self { place, problem, about: Box::default() }
    }

    /// R123: what is told of a table beside others that is not understood.
    pub(super) fn not_understood(self) -> Finding {
        let fact = ReadFact::SheetNotUnderstood { reason: self.problem.to_string() };
        Finding::new(fact).at(self.place)
    }

    /// The stable code, e.g. `R004`; see [`crate::finding::explain`].
    pub fn code(&self) -> &'static str {
        self.problem.code()
    }

    /// The file and position.
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// What to do about it.
    pub fn hint(&self) -> &'static str {
        self.problem.hint()
    }
}

impl Coded for ReadError {
    fn code(&self) -> &'static str {
        self.problem.code()
    }

    fn message(&self) -> String {
        self.problem.to_string()
    }

    fn fields(&self) -> Fields {
        fields_of(&self.problem)
    }

    fn place(&self) -> Option<Place> {
        Some(self.place.clone())
    }

    fn hint(&self) -> Option<&'static str> {
        Some(self.problem.hint())
    }

    fn fabric(&self) -> Option<String> {
        self.about.fabric.clone()
    }
}

macro_rules! problems {
    ($($(#[$doc:meta])* $code:literal $variant:ident $({ $($(#[$fdoc:meta])* $field:ident: $type:ty),* $(,)? })? = $message:literal, $hint:literal;)*) => {
        /// What can be wrong with an input. Each kind has a code, a message and a cure.
        #[derive(Clone, Debug, Error, PartialEq, Serialize)]
        #[serde(untagged)]
        pub enum ReadProblem {
            $(
                #[doc = concat!("`", $code, "`: ")]
                $(#[$doc])*
                #[error($message)]
                $variant $({ $($(#[$fdoc])* $field: $type),* })?,
            )*
        }

        impl ReadProblem {
            /// Every code, in order.
            pub const CODES: &[&str] = &[$($code),*];

            /// The stable code.
            pub fn code(&self) -> &'static str {
                match self { $(Self::$variant { .. } => $code,)* }
            }

            /// What to do about it.
            pub fn hint(&self) -> &'static str {
                match self { $(Self::$variant { .. } => $hint,)* }
            }
        }
    };
}

problems! {
    /// The operating system does not give us the bytes.
    "R001" Unreadable {
        /// What it says.
        reason: String,
    } = "the file cannot be opened: {reason}",
        "check the path and the permissions; close the program that locks the file";
    /// No numbers at all.
    "R002" Empty = "the file holds no measured values",
        "export the measurement again, or remove the file from the folder";
    /// Not text, and no format that is known here.
    "R003" NotText {
        /// What was met.
        found: String,
    } = "this is not a text table: {found}",
        "export as CSV or text, or as .xlsx; for an unusual encoding set `encoding` in a dialect file";
    /// A cell that should be a number.
    "R004" NotANumber {
        /// The cell.
        found: String,
        /// The decimal mark in force.
        decimal: char,
    } = "{found:?} is not a number (decimal mark is '{decimal}')",
        "correct the cell; if the whole file uses the other decimal mark, set `--decimal` or `decimal` in a dialect file";
    /// Two readings of the same text.
    "R005" Ambiguous {
        /// The two readings.
        found: String,
    } = "the numbers can be read in two ways: {found}",
        "say which: options `--delimiter` and `--decimal`, or `delimiter` and `decimal` in a dialect file";
    /// No header row that any dialect knows.
    "R006" UnknownLayout {
        /// The words that were met, and the closest dialect.
        found: String,
    } = "no column headings that are known here: {found}",
        "write a dialect file that names the columns (`kesf list dialects -v` shows examples; `kesf check -v` says what each dialect knows), and pass it with `--dialect` or as dialect.toml beside the data";
    /// An abscissa without its ordinate, or the reverse.
    "R007" IncompletePair {
        /// The column, and what it lacks.
        found: String,
    } = "{found}",
        "each curve needs two columns: strain and force, angle and force, curvature and moment, thickness and pressure";
    /// A number without a unit.
    "R008" UnitMissing {
        /// The column or key.
        found: String,
        /// An example of a unit.
        expected: &'static str,
    } = "{found:?} has no unit (such as {expected})",
        "write the unit in the heading, or in a unit row below it, or name it in a dialect file; `--assume-kes-units` takes the customary unit";
    /// A unit that is not in the table.
    "R009" UnitUnknown {
        /// The reason.
        reason: String,
    } = "{reason}",
        "use a unit that `kesf list units` shows, such as gf/cm or N/m";
    /// A unit of another kind.
    "R010" UnitWrong {
        /// The unit.
        found: String,
        /// The column or key.
        of: String,
        /// A unit of the right dimension.
        expected: &'static str,
    } = "{found:?} is not a unit of {of} (which needs one like {expected})",
        "correct the unit: force is gf (a gram-force), g is a mass; gf·cm²/cm is the unit of B and gf/(cm·deg) that of G";
    /// Which test it is cannot be told, or is told in two ways.
    "R011" TestUnclear {
        /// Why.
        found: String,
    } = "{found}",
        "state the test in the header: instrument,KES-FB2 or test,bending";
    /// The yarn direction is not stated.
    "R012" DirectionMissing = "the yarn direction is stated neither in the header nor in the file name",
        "add a header line such as direction,warp, or name the file as in poplin_warp_FB2_1.csv";
    /// A header value that cannot be understood.
    "R013" BadValue {
        /// The key.
        key: String,
        /// Why.
        reason: String,
    } = "{key:?}: {reason}",
        "correct the header line";
    /// A curve that is no curve.
    "R014" TooShort {
        /// Points found.
        points: usize,
    } = "the curve has {points} points; at least 3 are needed",
        "export the whole measurement again";
    /// Volts without a range.
    "R015" NoRange {
        /// The column.
        found: String,
    } = "{found:?} is in volts, and the header does not say what 10 V stand for",
        "add a header line with the full scale, such as sens,50 gf/cm (or sens x for the abscissa)";
    /// A row with a hole, or with too many cells.
    "R016" RaggedRow {
        /// What was met.
        found: String,
    } = "{found}",
        "complete the row, or remove it";
    /// Not a number by name.
    "R017" NotFinite {
        /// The cell.
        found: String,
    } = "{found:?} is not a finite number",
        "remove the row or repair the export: a gap is never filled by guessing";
    /// A result table without a usable value.
    "R018" BadTable {
        /// Why.
        found: String,
    } = "{found}",
        "correct that place; a result table has the symbols (B, 2HB, G ...) in its header row, or one row per symbol with columns parameter, value, unit, and each value once";
    /// `fabric.toml` is wrong.
    "R019" BadFabricFile {
        /// The parser's words.
        reason: String,
    } = "{reason}",
        "see `kesf explain R019` for the keys of fabric.toml";
    /// A dialect file is wrong.
    "R020" BadDialect {
        /// The parser's words.
        reason: String,
    } = "{reason}",
        "see `kesf explain R020` for the keys of a dialect file";
    /// A workbook that cannot be opened.
    "R021" BadWorkbook {
        /// The reader's words.
        reason: String,
    } = "the workbook cannot be read: {reason}",
        "open it in the spreadsheet program and save it again as .xlsx without a password";
    /// JSON that is not well formed.
    "R022" BadJson {
        /// The parser's words.
        reason: String,
    } = "this is not valid JSON: {reason}",
        "export the file again";
    /// JSON that is not a FAB measurement.
    "R023" BadFab {
        /// The path inside the document and what is wrong with it.
        reason: String,
    } = "{reason}",
        "only the FAB raw data of a U3M file (raw_data.L|W|B.S1 ...), or Browzwear's values without them (custom.browzwear), are read; remove other JSON files from the folder";
    /// A picture that cannot be decoded.
    "R024" BadPicture {
        /// The decoder's words.
        reason: String,
    } = "the picture cannot be read: {reason}",
        "PNG and JPEG are read; open it in another program and save it as one of them";
    /// A picture without a sheet.
    "R025" NoSheet {
        /// Why.
        reason: String,
    } = "no draped sheet is seen in the picture: {reason}",
        "take the picture from above, the whole sheet on a background that is lighter or darker everywhere";
    /// A table whose title says that its numbers are no values.
    "R026" NoValuesByTitle {
        /// The title, or the name of the sheet.
        title: String,
    } = "{title:?} says that the numbers are statistics or comparisons, and no values of fabrics",
        "remove the table, or give it another title if it holds values; standard deviations stand beside their values, or in brackets behind them";
    /// A file that says something of a fabric was named as a measurement.
    "R027" NoMeasurement {
        /// The name of the file.
        found: String,
    } = "{found} says something of the fabric in its folder, and holds no measurement",
        "name the folder in its place: the file is read with the measurements there";
    /// A link among the inputs leads nowhere.
    "O062" DanglingLink = "this link leads nowhere, and nothing was read",
        "restore what it leads to, or remove it";
}

/// `R021`, in the words of a reader.
pub(super) fn bad_workbook(reason: impl std::fmt::Display) -> ReadProblem {
    ReadProblem::BadWorkbook { reason: reason.to_string() }
}
