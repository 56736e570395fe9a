//! Facts of files.

use super::parts::{Divisor, LeftOutLine};
use crate::kes::{Direction, Parameter, Test};
use crate::quantity::{STANDARD_GRAVITY, without_rounding};

super::facts! {
    /// What a reader of the data of a file must know.
    ReadFact {
        /// A folder without fabric.toml.
        "R101" NoFabricFile {} =
            "there is no fabric.toml: the data count as measured, and of weave, areal density and source is known what the files say";
        /// The last row of a file was cut off.
        "R102" RowIncomplete {} = "the last row is incomplete and was left out";
        /// Two specimens have one number.
        "R103" Renumbered {
            /// The number in the file.
            specimen: usize,
            /// The number that the later one has here.
            number: usize,
        } = "specimen {specimen} occurs twice; the later one is numbered {number}";
        /// Values that nothing here can use.
        "R104" Unusable {
            /// Their names.
            names: Vec<String>,
            /// What is wrong with a measured result of fabric.toml; none of columns that are no parameters.
            reason: Option<String>,
        } = "{}", unusable(names, reason.as_deref());
        /// Files of several samples make one fabric.
        "R105" SeveralSamples {
            /// Their names.
            samples: Vec<String>,
        } = "several samples are read as one fabric: {}; give each its own folder", samples.join(", ");
        /// Two statements of the yarn direction.
        "R106" TwoDirections {
            /// In the header.
            header: Direction,
            /// In the name of the file.
            file_name: Direction,
        } = "the header says {header}, the file name {file_name}: the header was taken";
        /// A parameter that was calculated from a value of FAST.
        "R107" FromFast {
            /// The parameter.
            parameter: Parameter,
            /// Symbol of the FAST value.
            symbol: String,
        } = "{parameter} was calculated from the FAST value {symbol}";
        /// What the program of the instrument wrote into the file.
        "R108" InstrumentWarning {
            /// The warning.
            warning: String,
        } = "the instrument's program warned: {warning}";
        /// A column was divided by a dimension that nobody stated.
        "R109" AssumedDimension {
            /// By which it was divided.
            dimension: Divisor,
            /// Its standard value (SI).
            value: f64,
            /// The test of a gauge, which is stated for each test of its own; none of the others.
            test: Option<Test>,
            /// Lines of the header that may state it in words which are not known.
            not_understood: Vec<String>,
        } = "{}", assumed(*dimension, *value, *test, not_understood);
        /// Rows, columns or curves that sum up others.
        "R110" SummingUp {
            /// `rows`, `columns` or `curves`.
            what: String,
            /// Which ones.
            left_out: Vec<LeftOutLine>,
        } = "{what} that sum up others are left out: {}", lines(left_out);
        /// `LT-1` and `LT-2`, as the literature writes them.
        "R111" NumbersAsDirections {} =
            "the numbers behind the symbols are taken as the literature uses them: 1 is warp, 2 is weft";
        /// Rows of one fabric and direction without numbers of specimens.
        "R112" RowsAsRepeats {
            /// The parameter.
            parameter: Parameter,
            /// Its direction.
            direction: Option<Direction>,
            /// The fabric, where the table names it.
            fabric: Option<String>,
            /// How many other values were had in the same manner.
            others: usize,
        } = "several rows without a number of their specimen give {parameter}{}{}{}: they are taken as repeats and averaged",
            direction.map_or(String::new(), |d| format!(" {d}")),
            fabric.as_ref().map_or(String::new(), |f| format!(" of {f:?}")),
            if *others > 0 { format!(" and {others} more") } else { String::new() };
        /// Hidden sheets, rows and columns of a workbook.
        "R113" HiddenCells {
            /// Which ones.
            hidden: Vec<String>,
        } = "what the workbook hides is left out: {}", hidden.join("; ");
        /// Headings that stand again where a curve is closed.
        "R114" HeadingsAgain {} =
            "the headings stand again where the curve is back at its start: what follows is taken as another specimen";
        /// A direction that no header states.
        "R115" DirectionFromName {} =
            "the direction comes from the name of the file, sheet or archive only: state it in the header";
        /// An ordinate that is counted the other way round.
        "R116" SignTurned {
            /// Its column.
            ordinate: String,
            /// The column of the abscissa.
            abscissa: String,
        } = "{ordinate:?} has the opposite sign of {abscissa:?}: it was turned";
        /// A fabric that the file calls a knit.
        "R117" KnitDirections {} =
            "the fabric is a knit: warp stands for wale and weft for course in all that follows";
    }
}

fn unusable(names: &[String], reason: Option<&str>) -> String {
    let names = names.join(", ");
    match reason {
        Some(reason) => format!("the measured result `{names}` is left out: {reason}"),
        None => format!("no KES parameters, and left out: {names}"),
    }
}

fn assumed(dimension: Divisor, value: f64, test: Option<Test>, not_understood: &[String]) -> String {
    let quoted: Vec<String> = not_understood.iter().map(|line| format!("{line:?}")).collect();
    // What was not understood is not denied.
    let stated = match quoted.is_empty() {
        true => "stated".to_string(),
        false => format!("understood (the header says {})", quoted.join(", ")),
    };
    let [cm, cm2] = [value * 1e2, value * 1e4].map(without_rounding);
    match dimension {
        Divisor::Area => format!(
            "no foot area is {stated}: force was divided by the standard {cm2} cm²; state `area` in the header"
        ),
        Divisor::Gauge => format!(
            "no gauge is {stated}: travel was divided by the standard {cm} cm; state `gauge` in the header or in [conditions{}] of fabric.toml",
            test.map_or(String::new(), |test| format!(".{}", test.name()))
        ),
        Divisor::Contact => format!(
            "no load on the contactor is {stated}: force was divided by the standard {} gf; state `contact load` in the header or `contact` in [conditions.friction] of fabric.toml",
            without_rounding(value / (1e-3 * STANDARD_GRAVITY))
        ),
        Divisor::Width => format!(
            "no width is {stated}: force or moment was divided by the standard {cm} cm; state `width` in the header or in [conditions] of fabric.toml"
        ),
    }
}

/// The most that a message names one by one.
const NAMED: usize = 8;

fn lines(left_out: &[LeftOutLine]) -> String {
    let named: Vec<String> =
        left_out.iter().take(NAMED).map(|l| format!("{:?} (line {})", l.word, l.line)).collect();
    let more = left_out.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    named.join(", ") + &more
}
