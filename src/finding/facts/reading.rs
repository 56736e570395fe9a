//! Facts of files.

use super::parts::{Contradiction, LeftOutLine};
use crate::kes::{Direction, Divisor, Key, Parameter, RecordName, Test};
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
            /// A record of each test and direction in which they are averaged.
            records: Vec<RecordName>,
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
            /// Its standard value (SI; V of a voltage).
            value: f64,
            /// The test of a gauge, which is stated for each test of its own; none of the others.
            test: Option<Test>,
            /// Lines of the header that may state it in words which are not known.
            not_understood: Vec<String>,
        } = "{}", assumed(*dimension, *value, *test, not_understood);
        /// Numbers without a unit, in a file that states none for them.
        "R152" AssumedUnits {
            /// What was taken in which unit: `moment in gf·cm/cm`.
            units: Vec<String>,
        } = "no unit is stated, and the customary one of the instruments is assumed: {}", units.join(", ");
        /// What a file states against its dialect, fabric.toml or the settings.
        "R153" FileTaken {
            /// What the file says, and they.
            statements: Vec<Contradiction>,
        } = "what the file states is taken, and not what its dialect, fabric.toml or the settings do: {}",
            contradictions(statements);
        /// Rows, columns or curves that sum up others.
        "R110" SummingUp {
            /// `rows`, `columns`, `curves`, `sheets` or `files`.
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
        } = "what the workbook hides or strikes out is left out: {}", hidden.join("; ");
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
        /// Two lines of one header.
        "R118" StatedTwice {
            /// What the first says.
            first: String,
            /// Its line.
            first_line: usize,
            /// What this one says.
            second: String,
        } = "{second:?} is stated here and {first:?} in line {first_line}: the later one was taken; keep the one that holds";
        /// Ordinates of one kind under different names.
        "R119" ColumnsAsSpecimens {
            /// Names of the columns.
            names: Vec<String>,
        } = "the columns {} are read as specimens of one fabric; separate them if they are other fabrics, or if one was calculated from \
             another", names.join(", ");
        /// A value in several tables.
        "R120" SeveralTables {
            /// The parameters with their directions, the one that is told of first.
            keys: Vec<Key>,
            /// Where that stands first.
            first: String,
        } = "{} stands here and at {first}, in tables, sheets or files of one fabric: they are averaged; remove all but one, or \
             name the fabric or the direction of each", several_keys(keys);
        /// Numbers behind symbols that are no directions.
        "R121" NumbersAsSpecimens {
            /// The parameters, without a direction.
            keys: Vec<Key>,
        } = "the numbers behind the symbols are taken as those of specimens, and no direction is stated ({}): name the \
             direction of each column, or add a column `direction`", several_keys(keys);
        /// A factor that a header states.
        "R122" StatedFactor {
            /// What it is called.
            name: String,
            /// Its value, as it stands.
            value: String,
        } = "the header states `{name}: {value}`, which was not applied: remove the line if the numbers are already those \
             of the cloth, else correct them";
        /// A sheet with numbers under headings that are not known, or a table that cannot be read beside curves.
        "R123" SheetNotUnderstood {
            /// What was met.
            reason: String,
        } = "this sheet or table holds numbers that were not read: {reason}; correct it if they matter, remove or hide it if it holds \
             something else, or write a dialect file that names its columns";
        /// A direction among words that are not understood.
        "R125" MoreThanDirection {
            /// The text.
            text: String,
            /// What is taken of it.
            direction: Direction,
        } = "{text:?} is read as the direction {direction}, and what else it says is not understood: give rows or records of \
             different states different fabrics";
        /// Rows that are averaged although a column tells them apart.
        "R126" ColumnOfStates {
            /// Heading of the column.
            column: String,
            /// Two of its entries.
            entries: [String; 2],
            /// The values that are averaged.
            keys: Vec<Key>,
        } = "rows that differ in the column {column:?} ({:?} and {:?}) are averaged as repeats: make that a part of the name of the \
             fabric if they are of different states", entries[0], entries[1];
        /// Records that are averaged although their headers tell them apart.
        "R127" RecordsOfStates {
            /// The line of the header.
            name: String,
            /// Two of its entries.
            entries: [String; 2],
            /// The first of the records.
            record: RecordName,
        } = "records whose headers say {name:?} {:?} and {:?} are averaged as repeats: give each state a fabric of its own",
            entries[0], entries[1];
        /// Rows behind a table that look like its rows.
        "R128" RowsNotRead {
            /// Their lines.
            lines: Vec<usize>,
        } = "rows with numbers behind the end of the table were not read: line{} {}; give them the headings again, or remove \
             what stands between", if lines.len() == 1 { "" } else { "s" }, lines_text(lines);
        /// Formulas whose values were never stored.
        "R129" WithoutValue {
            /// Which ones.
            cells: Vec<String>,
        } = "formulas without a stored value are read as blank: {}; open the workbook in a spreadsheet program and save it",
            cells.join("; ");
        /// Numbers with letters of significance or signs of footnotes behind them.
        "R130" MarkedNumbers {
            /// What stands in the cells.
            cells: Vec<String>,
        } = "marks, ranges and counts behind numbers are left out, and the numbers are read: {}; see what the table says of them", some(cells);
        /// Cells that bound a value.
        "R131" BoundsLeftOut {
            /// What stands in the cells.
            cells: Vec<String>,
        } = "bounds and ranges are no values, and left out: {}; enter the value if it is known", some(cells);
        /// Numbers that the heading does not say to be those of specimens.
        "R132" CountedUnder {
            /// The heading, or the headings that are numbered.
            column: String,
        } = "{column:?} is taken to count specimens, whose values are averaged: call it `specimen` if that is so, and `fabric` if each \
             number is of another fabric or state";
        /// Letters that stand for directions.
        "R133" DirectionsFromLetters {
            /// The texts in which they stand.
            texts: Vec<String>,
        } = "single letters, or angles to the warp, are read as warp and weft, because each stands beside its partner: {}; write the words if they are \
             something else", some(texts);
        /// Units that number formats of a workbook add.
        "R134" UnitsOfFormats {
            /// Each unit with its cells.
            units: Vec<String>,
        } = "units that number formats show beside the numbers are taken as if they stood in the cells: {}; write them in the \
             headings", units.join("; ");
        /// A text that was read in another code page than it was written in.
        "R135" OtherCodePage {
            /// What stands there.
            found: String,
            /// What was written.
            written: String,
            /// The page it was written in.
            written_in: String,
            /// The page it was read in.
            read_in: String,
        } = "{found:?} is no unit, and is {written:?} where a text of {written_in} was taken for {read_in}: all texts of the table are \
             read so; save the file as UTF-8 from the program that wrote it";
        /// A value without a direction among others with one.
        "R136" WithoutDirection {
            /// The parameters, without a direction.
            keys: Vec<Key>,
        } = "{} stands without a direction beside values of it with one, and is read as one of the fabric: name its direction",
            several_keys(keys);
        /// Zeros that stand for what was not measured.
        "R137" ZerosLeftOut {
            /// The parameters with their directions.
            keys: Vec<Key>,
        } = "{} is 0 in some repeats and not in others: no cloth has none of it, and the zeros are left out as not measured; leave their \
             cells blank, or enter more digits", several_keys(keys);
        /// Names of statistics that are read as those of fabrics.
        "R138" StatisticsAsFabrics {
            /// The names.
            names: Vec<String>,
        } = "rows are read as those of fabrics that are called like statistics or limits: {}; remove them if they sum up or bound the \
             others, or give the fabrics other names", some(names);
        /// Numbers behind values that are no standard deviations.
        "R139" OtherSpreads {
            /// The parameters with their directions.
            keys: Vec<Key>,
        } = "the numbers behind {} in its cells are no standard deviations, as a heading, the line above the table or their size says, and \
             are left out: give them a column of their own", several_keys(keys);
        /// Words in a column of statuses that are none.
        "R140" UnknownStatus {
            /// The words with their lines.
            cells: Vec<LeftOutLine>,
        } = "words under `status` are not known, and their values are read as measured: {}; the words are measured, inferred, assumed \
             and doubtful", lines(cells);
        /// A fabric.toml that does not say where the data come from.
        "R141" AssumedOrigin {} = "no `origin` is stated, and the data count as measured: write `origin = \"measured\"`, \"published\" or \
             \"synthetic\"";
        /// Signs in the place of numbers that could not be shown.
        "R142" Overflow {
            /// What stands in the cells.
            cells: Vec<String>,
        } = "signs in the place of numbers that could not be shown are read as not measured: {}; enter the values if they are known",
            some(cells);
        /// A line of heads with one field less than the rows.
        "R143" NamesOfRows {} = "the line of headings has one field less than the rows, as `write.table` of R has it: the first column is read \
             as the names of the rows; write a heading over it if it is something else";
        /// A travel in the place of a thickness.
        "R144" TravelAsThickness {
            /// Heading of its column.
            column: String,
        } = "{column:?} is a travel, and is read as the thickness: T0, Tm and EMC hold only if it is 0 where the foot meets the \
             anvil; call the column `thickness` if it is one";
        /// Samples of a curve without a value.
        "R145" SamplesMissing {
            /// Heading of the column.
            column: String,
            /// What stands in the place of the values, with the lines.
            cells: Vec<LeftOutLine>,
        } = "samples without a value of {column:?} are left out of the curve: {}; enter the values if they are known", lines(cells);
        /// Negative numbers as accounts have them.
        "R146" NegativeOfAccounts {
            /// Heading of the column.
            column: String,
        } = "numbers in brackets or with the sign behind them are read as negative in {column:?}, where no number has a sign before \
             it: write the signs before the numbers";
        /// Signs of significance in the place of values.
        "R147" SignificanceAlone {
            /// What stands in the cells.
            cells: Vec<String>,
        } = "signs of a test of significance stand where values are expected, and are left out: {}; enter the values if they are known",
            some(cells);
        /// An unloading branch below its loading branch that rises as well.
        "R148" UnloadingTurned {} = "the branch below the word for unloading begins where loading began and ends where it ended: it is read \
             backwards, as the specimen was unloaded";
        /// Loading and unloading in two files or sheets.
        "R149" BranchesJoined {
            /// The names of the two, loading first.
            parts: [String; 2],
            /// The record that they make.
            record: RecordName,
        } = "{:?} and {:?} are read as loading and unloading of one specimen: give them other names if they are two", parts[0], parts[1];
        /// Angles in a column of directions.
        "R150" AnglesAsDirections {} =
            "the angles in the column of directions are taken as those to the warp: 0 is warp, 90 is weft, 45 is bias";
        /// Words in a column of records that are taken as a part of the names of fabrics.
        "R151" StatesAsFabrics {
            /// Heading of the column.
            column: String,
            /// Its entries.
            entries: Vec<String>,
        } = "what the column {column:?} says ({}) is taken as a part of the name of the fabric, so that each is a fabric of its own; remove the \
             column if the records are of one", some(entries);
        /// Blank cells below a direction or a parameter.
        "R124" MergedCells {} = "blank cells are read as the direction or parameter above them, as of merged cells: fill them in \
             if they are something else";
        /// A fabric that the file calls a knit.
        "R117" KnitDirections {} =
            "the fabric is a knit: warp stands for wale and weft for course in all that follows";
    }
}

/// `B warp`, or `B warp with 3 more`.
fn several_keys(keys: &[Key]) -> String {
    let first = keys.first().map(Key::to_string).unwrap_or_default();
    match keys.len() {
        0 | 1 => first,
        n => format!("{first} with {} more", n - 1),
    }
}

/// The first lines of a list.
fn lines_text(lines: &[usize]) -> String {
    let first: Vec<String> = lines.iter().take(10).map(usize::to_string).collect();
    let more = lines.len().saturating_sub(10);
    format!("{}{}", first.join(", "), if more > 0 { format!(" and {more} more") } else { String::new() })
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
        Divisor::Voltage => format!(
            "no full-scale voltage is {stated}: the range was taken as that of {} V; state `full scale voltage` in the header",
            without_rounding(value)
        ),
        Divisor::Width => format!(
            "no width is {stated}: force or moment was divided by the standard {cm} cm; state `width` in the header or in [conditions] of fabric.toml"
        ),
    }
}

/// The most that a message names one by one.
const NAMED: usize = 8;

/// The first of some texts, and how many more there are.
fn some(texts: &[String]) -> String {
    let named = texts.iter().take(NAMED).map(|text| format!("{text:?}")).collect::<Vec<_>>().join(", ");
    match texts.len().saturating_sub(NAMED) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

fn contradictions(statements: &[Contradiction]) -> String {
    let each = statements.iter().map(|s| format!("{} {}, and not {}", s.what, s.file, s.elsewhere));
    each.collect::<Vec<_>>().join("; ")
}

fn lines(left_out: &[LeftOutLine]) -> String {
    let named: Vec<String> =
        left_out.iter().take(NAMED).map(|l| format!("{:?} (line {})", l.word, l.line)).collect();
    let more = left_out.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    named.join(", ") + &more
}
