//! One file: bytes to measurements, result values or a FAB record.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::Source;
use super::blanks;
use super::branches;
use super::browzwear;
use super::caption;
use super::content::{FileContent, ReadSettings};
use super::context::Context;
use super::curves;
use super::dialect::Dialect;
use super::error::{ReadError, ReadProblem};
use super::fab::{self};
use super::keyed_rows;
use super::label::Label;
use super::layout::{self, Block};
use super::raw::{self, Row};
use super::result_table::{self};
use super::seen::Seen;
use super::sniff::{Sniffed, sniff, sniff_lines};
use super::vocabulary::Vocabulary;
use super::workbook::{self, Archive};
use super::{brackets_below, cell_units, code_page, letters, limits, lines, means, row_names, samples};
use super::{side_by_side, slashed, web_page};
use crate::finding::{Finding, Place, ReadFact};
use crate::platform;

/// Reads a file.
///
/// # Errors
/// See [`ReadProblem`].
pub fn read(path: &Path, settings: &ReadSettings) -> Result<FileContent, ReadError> {
    let bytes = platform::files::read(path)
        .map_err(|e| ReadError::new(Place::file(path), ReadProblem::Unreadable { reason: e.to_string() }))?;
    parse(path, &bytes, settings)
}

/// Reads the bytes of a file. `path` serves for its name and for messages only.
///
/// # Errors
/// See [`ReadProblem`]; one error, the first in the file.
pub fn parse(path: &Path, bytes: &[u8], settings: &ReadSettings) -> Result<FileContent, ReadError> {
    let source = Source {
        path: path.to_path_buf(),
        sha256: Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect(),
        ..Source::default()
    };
    let mut content = FileContent { source, ..FileContent::default() };
    let reader = match workbook::archive(bytes) {
        Some(Archive::Files) => archive,
        _ if workbook::is_workbook(bytes) => sheets,
        _ => text,
    };
    if let Err(mut error) = reader(path, bytes, settings, &mut content) {
        content.inference.append(&mut error.about.inference);
        error.about.inference = content.inference;
        return Err(error);
    }
    number_specimens(path, &mut content);
    for m in &mut content.measurements {
        m.source = content.source.clone();
    }
    Ok(content)
}

fn text(
    path: &Path,
    bytes: &[u8],
    settings: &ReadSettings,
    content: &mut FileContent,
) -> Result<(), ReadError> {
    let error = |(line, column, problem)| ReadError::new(Place::at(path, line, column), problem);
    let mut decoded = raw::decode(bytes, None);
    let as_guessed = decoded.as_ref().map_or("", |t| t.text.as_str());
    let dialect = settings.dialects.iter().find(|d| d.applies_to(as_guessed));
    if let Some(label) = dialect.and_then(|d| d.encoding.as_deref()) {
        decoded = raw::decode(bytes, Some(label));
    }
    let raw::Text { mut text, encoding, why } = decoded.map_err(error)?;
    content.source.encoding = encoding.to_string();
    content.inference.push(format!("encoding {encoding}: {why}"));
    if text.trim().is_empty() {
        return Err(error((0, 0, ReadProblem::Empty)));
    }
    if text.trim_start().starts_with('{') {
        if let Some(values) = browzwear::parse(path, &text)? {
            content.source.dialect = "u3m-browzwear".to_string();
            content
                .inference
                .push(format!("JSON without raw data: {} of Browzwear's block", values.summary()));
            (content.results, content.stiffnesses) = (values.results, values.stiffnesses);
            return Ok(());
        }
        let (mut file, findings) = fab::parse(path, &text)?;
        content.source.dialect = "u3m-fab".to_string();
        content.inference.push(format!("JSON with raw_data: {}", file.summary()));
        file.source = content.source.clone();
        (content.fab, content.findings) = (Some(file), findings);
        return Ok(());
    }
    if let Some(list) = text.trim_start().strip_prefix('[')
        && list.trim_start().starts_with(['{', '['])
    {
        let reason = "a list of records in JSON is not read: write the table as CSV, in pandas by `to_csv(\"table.csv\", index=False)`";
        return Err(error((0, 0, ReadProblem::BadFab { reason: reason.into() })));
    }
    if web_page::is_page(&text) {
        content.inference.push("a web page or XML workbook: its tables are read".to_string());
        let rows = web_page::rows(&text).map_err(|p| error((0, 0, p)))?;
        let decimal =
            settings.decimal.or(dialect.and_then(|d| d.decimal)).unwrap_or_else(|| workbook::mark(&rows));
        let unread = table(&rows, &context(path, settings, dialect, '\t', decimal), true, content)?;
        return beside_curves(unread, content);
    }
    let delimiter = settings.delimiter.or(dialect.and_then(|d| d.delimiter));
    let decimal = settings.decimal.or(dialect.and_then(|d| d.decimal));
    let mut sniffed = sniff(&text, delimiter, decimal);
    // Blanks stand in headings too: they are tried where no other mark separates any number.
    let nothing = sniffed.as_ref().is_ok_and(|s| s.numbers <= 0) && delimiter.is_none();
    if let Some(tabbed) = nothing.then(|| blanks::tabbed(&text)).flatten() {
        content.inference.push("columns that blanks separate: gaps are read as tabs".to_string());
        text = tabbed;
        sniffed = sniff(&text, Some('\t'), decimal);
    } else if let Some(lines) = nothing.then(|| sniff_lines(&text, decimal)).flatten() {
        sniffed = Ok(lines);
    }
    let Sniffed { format, why, .. } = sniffed.map_err(|p| error((0, 0, p)))?;
    content
        .inference
        .push(format!("delimiter {:?}, decimal mark {:?}: {why}", format.delimiter, format.decimal));
    let mut rows = raw::rows(&text, format.delimiter);
    let context = context(path, settings, dialect, format.delimiter, format.decimal);
    if row_names::put_under_heads(&mut rows, &text, format.decimal, context.vocabulary) {
        let line = rows.iter().find(|row| !row.is_blank()).map_or(0, |row| row.line);
        content.findings.push(Finding::new(ReadFact::NamesOfRows {}).at(Place::at(path, line, 0)));
    }
    let unread = table(&rows, &context, text.ends_with('\n'), content)?;
    beside_curves(unread, content)
}

/// R123: result tables that cannot be read cost nothing but themselves beside curves, and are told; so do those of no values beside others.
///
/// # Errors
/// The first of the others, where there is no curve.
fn beside_curves(unread: Vec<ReadError>, content: &mut FileContent) -> Result<(), ReadError> {
    let has_values = !content.results.is_empty() || !content.stiffnesses.is_empty();
    for error in unread {
        let is_other = has_values && matches!(error.problem, ReadProblem::NoValuesByTitle { .. });
        if content.measurements.is_empty() && !is_other {
            return Err(error);
        }
        content.findings.push(error.not_understood());
    }
    Ok(())
}

fn context<'a>(
    path: &'a Path,
    settings: &'a ReadSettings,
    dialect: Option<&'a Dialect>,
    delimiter: char,
    decimal: char,
) -> Context<'a> {
    let vocabulary = Vocabulary::new(&settings.dialects);
    let of_dialect = dialect.map(|d| d.conditions.clone()).unwrap_or_default();
    Context {
        path,
        vocabulary,
        dialect,
        delimiter,
        decimal,
        kes_units: settings.kes_units || dialect.is_some_and(|d| d.kes_units),
        conditions: settings.conditions.or(&of_dialect),
        label: label(path, vocabulary),
        sheet_of_no_values: None,
        facets: Seen::default(),
        column_names: Seen::default(),
        assumed_units: RefCell::default(),
        contradictions: RefCell::default(),
    }
}

/// What the name of a file says; of `lab.zip[warp/FB2_1.csv]` that of the file within, and then that of the archive.
fn label(path: &Path, vocabulary: Vocabulary<'_>) -> Label {
    let name = path.to_string_lossy();
    let stem = |path: &Path| {
        let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
        stem.map(|s| Label::parse(&s, vocabulary)).unwrap_or_default()
    };
    match name.strip_suffix(']').and_then(|n| n.split_once('[')) {
        Some((archive, within)) => stem(Path::new(within)).or(stem(Path::new(archive))),
        None => stem(path),
    }
}

/// A workbook: every sheet is a table, and its name may carry metadata as a file name does.
fn sheets(
    path: &Path,
    bytes: &[u8],
    settings: &ReadSettings,
    content: &mut FileContent,
) -> Result<(), ReadError> {
    let error = |problem| ReadError::new(Place::file(path), problem);
    let decimal = settings.decimal.or_else(|| settings.dialects.iter().find_map(|d| d.decimal));
    let workbook::Book { sheets, decimal, hidden, without_value, units } =
        workbook::sheets(bytes, decimal).map_err(error)?;
    if !hidden.is_empty() {
        content.findings.push(Finding::new(ReadFact::HiddenCells { hidden }).at(Place::file(path)));
    }
    if !without_value.is_empty() {
        let fact = ReadFact::WithoutValue { cells: without_value };
        content.findings.push(Finding::new(fact).at(Place::file(path)));
    }
    if !units.is_empty() {
        content.findings.push(Finding::new(ReadFact::UnitsOfFormats { units }).at(Place::file(path)));
    }
    let names: Vec<&str> = sheets.iter().map(|sheet| sheet.name.as_str()).collect();
    let letters = letters::in_names(&names, Vocabulary::new(&settings.dialects));
    let several = sheets.len() > 1;
    let (mut unread, mut of_letters) = (Vec::new(), Vec::new());
    let (mut of_sheets, mut tables) = (Vec::<String>::new(), Vec::new());
    for sheet in &sheets {
        // The place of a cell needs its sheet: `book.xlsx[sheet]:line:column`.
        let named = PathBuf::from(format!("{}[{}]", path.display(), sheet.name));
        let at = if several { named.as_path() } else { path };
        let dialect = settings.dialects.iter().find(|d| d.matches.is_empty());
        let mut context = context(path, settings, dialect, '\t', decimal);
        context.path = at;
        context.sheet_of_no_values = caption::sheet_of_no_values(&sheet.name, &names, context.vocabulary);
        let own = Label::parse(&sheet.name, context.vocabulary);
        let letter = letters.get(sheet.name.as_str()).copied();
        let own = Label { direction: own.direction.or(letter), ..own };
        context.label = own.or(context.label);
        let before = content.inference.len();
        let (curves, values) = (content.measurements.len(), content.results.len());
        content.inference.push(format!("sheet {:?}: {} rows", sheet.name, sheet.rows.len()));
        match table(&sheet.rows, &context, true, content) {
            // A sheet of remarks or charts among others.
            Err(e) if several && e.problem == ReadProblem::Empty => content.inference.truncate(before),
            // A sheet of something else: a mistake of its own costs nothing but itself, and is told.
            Err(e) if several && matches!(e.problem, ReadProblem::UnknownLayout { .. }) => {
                content.inference.truncate(before);
                unread.push(e);
            }
            result => tables.extend(result?),
        }
        of_sheets.resize(content.measurements.len(), sheet.name.clone());
        let is_used = content.measurements.len() > curves || content.results.len() > values;
        if is_used && letter.is_some() {
            of_letters.push(sheet.name.clone());
        }
    }
    if !of_letters.is_empty() {
        let fact = ReadFact::DirectionsFromLetters { texts: of_letters };
        content.findings.push(Finding::new(fact).at(Place::file(path)));
    }
    if content.measurements.is_empty() && content.results.is_empty() {
        let first = tables.into_iter().chain(unread).next();
        return Err(first.unwrap_or_else(|| error(ReadProblem::Empty)));
    }
    content.findings.extend(unread.into_iter().map(ReadError::not_understood));
    beside_curves(tables, content)?;
    let vocabulary = Vocabulary::new(&settings.dialects);
    let joined = branches::join(&mut content.measurements, &mut of_sheets, path, vocabulary);
    content.findings.extend(joined);
    content.findings.extend(means::leave_out(
        &mut content.measurements,
        &mut of_sheets,
        "sheets",
        path,
        vocabulary,
    ));
    // A letter of a direction names no sample, and no more does a mean.
    let mut names: Vec<&str> = of_sheets.iter().map(String::as_str).collect();
    let mut seen = BTreeSet::new();
    names.retain(|name| {
        seen.insert(*name) && !letters.contains_key(name) && !means::names_mean(name, vocabulary)
    });
    let samples = samples::of_sheets(&names, vocabulary);
    if samples.len() > 1 {
        let mut names = of_sheets.iter();
        let records = samples::averaged(&content.measurements, |_| names.next().cloned().unwrap_or_default());
        let fact = ReadFact::SeveralSamples { samples, records };
        content.findings.push(Finding::new(fact).at(Place::file(path)));
    }
    Ok(())
}

/// An archive of files: each is read by itself, and a bad one costs itself only.
fn archive(
    path: &Path,
    bytes: &[u8],
    settings: &ReadSettings,
    content: &mut FileContent,
) -> Result<(), ReadError> {
    let error = |problem| ReadError::new(Place::file(path), problem);
    limits::archive(bytes).map_err(error)?;
    let mut of_files: Vec<String> = Vec::new();
    for (name, inner) in workbook::files(bytes).map_err(error)? {
        let at = PathBuf::from(format!("{}[{name}]", path.display()));
        match parse(&at, &inner, settings) {
            Ok(file) => {
                content.inference.push(format!("{name} in the archive:"));
                content.inference.extend(file.inference);
                content.measurements.extend(file.measurements);
                content.results.extend(file.results);
                content.findings.extend(file.findings);
                content.rows_name_fabrics |= file.rows_name_fabrics;
                content.failures.extend(file.failures);
                content.fab = content.fab.take().or(file.fab);
            }
            Err(e) => content.failures.push(e),
        }
        let stem = Path::new(&name).file_stem().map(|s| s.to_string_lossy().into_owned());
        of_files.resize(content.measurements.len(), stem.unwrap_or_default());
    }
    let vocabulary = Vocabulary::new(&settings.dialects);
    content.findings.extend(branches::join(&mut content.measurements, &mut of_files, path, vocabulary));
    let means = means::leave_out(&mut content.measurements, &mut of_files, "files", path, vocabulary);
    content.findings.extend(means);
    if content.measurements.is_empty() && content.results.is_empty() && content.fab.is_none() {
        return Err(content.failures.drain(..).next().unwrap_or_else(|| error(ReadProblem::Empty)));
    }
    Ok(())
}

/// Reads a table of cells into `content`; `complete` says that its last row ended properly. Returns what is wrong with result
/// tables that cannot be read.
fn table(
    rows: &[Row<'_>],
    context: &Context<'_>,
    complete: bool,
    content: &mut FileContent,
) -> Result<Vec<ReadError>, ReadError> {
    let restored = code_page::restored(rows);
    if let Some((_, fact)) = &restored {
        content.findings.push(Finding::new(fact.clone()).at(Place::file(context.path)));
    }
    let rows = restored.as_ref().map_or(rows, |(rows, _)| rows.as_slice());
    rearranged(rows, &REARRANGEMENTS, context, complete, content)
}

/// Makes plain rows of those that are written in another way; nothing of rows that are not.
type Rearrange = for<'r> fn(&'r [Row<'_>], &Context<'_>) -> Result<Option<Vec<Row<'r>>>, ReadError>;

/// In the order in which they are undone.
const REARRANGEMENTS: [Rearrange; 5] = [
    |rows, context| Ok(side_by_side::stacked(rows, context)),
    |rows, context| Ok(slashed::apart(rows, context)),
    |rows, context| Ok(brackets_below::to_values(rows, context)),
    |rows, context| Ok(lines::split(rows, context.decimal, context.vocabulary)),
    cell_units::to_headings,
];

/// Reads a table once each of the `steps` has been taken.
fn rearranged(
    rows: &[Row<'_>],
    steps: &[Rearrange],
    context: &Context<'_>,
    complete: bool,
    content: &mut FileContent,
) -> Result<Vec<ReadError>, ReadError> {
    let Some((step, steps)) = steps.split_first() else {
        return plain_table(rows, context, complete, content);
    };
    let plainer = step(rows, context)?;
    rearranged(plainer.as_deref().unwrap_or(rows), steps, context, complete, content)
}

/// Reads a table whose rows are as they are to be.
fn plain_table(
    rows: &[Row<'_>],
    context: &Context<'_>,
    complete: bool,
    content: &mut FileContent,
) -> Result<Vec<ReadError>, ReadError> {
    let (blocks, findings) = layout::blocks(rows, context)?;
    content.findings.extend(findings);
    content.source.dialect = dialect_name(rows, context, &mut content.inference);
    let (count, mut unread) = (blocks.len(), Vec::new());
    for (i, block) in blocks.into_iter().enumerate() {
        let ends_file = !complete && i + 1 == count;
        match block {
            Block::Curves { pairs, rows, keys } => {
                content.rows_name_fabrics |= keyed_rows::name_fabrics(&keys);
                let records = keyed_rows::records(pairs, rows, &keys, context);
                let of_block = records.len();
                for (k, (pairs, rows)) in records.into_iter().enumerate() {
                    curves::add(&pairs, &rows, ends_file && k + 1 == of_block, context, content)?;
                }
            }
            Block::Table { header, region } => {
                match result_table::read(&header, &region, context, &mut content.inference) {
                    Ok(read) => {
                        content.results.extend(read.values);
                        content.stiffnesses.extend(read.stiffnesses);
                        content.findings.extend(read.findings);
                        content.failures.extend(read.failures);
                    }
                    Err(error) => unread.push(error),
                }
            }
        }
    }
    content.findings.extend(context.note_of_units());
    content.findings.extend(context.note_of_contradictions());
    let mut seen = BTreeSet::new();
    content.inference.retain(|line| seen.insert(line.clone()));
    content.findings.dedup();
    Ok(unread)
}

/// The dialect that knows most words of the rows that are not numbers.
fn dialect_name(rows: &[Row<'_>], context: &Context<'_>, log: &mut Vec<String>) -> String {
    let is_text = |t: &str| t.chars().any(char::is_alphabetic);
    let words: Vec<String> = rows
        .iter()
        .filter(|r| r.filled().next().is_some_and(|(_, c)| is_text(&c.text)))
        .take(40)
        .flat_map(|r| r.filled().map(|(_, c)| c.text.to_string()).collect::<Vec<_>>())
        .collect();
    let dialects = context.vocabulary.closest(&words);
    let known = |(name, unknown): &(&str, Vec<&str>)| format!("{name} {}", words.len() - unknown.len());
    let knowing = dialects.iter().filter(|(_, unknown)| unknown.len() < words.len());
    let counts: Vec<String> = knowing.map(known).collect();
    log.push(format!("words that dialects know, of {} texts: {}", words.len(), counts.join(", ")));
    dialects.first().map_or_else(String::new, |(name, _)| (*name).to_string())
}

/// Numbers the specimens that the file leaves unnumbered, per test and direction, in file order.
fn number_specimens(path: &Path, content: &mut FileContent) {
    let unnumbered = content.measurements.iter().filter(|m| m.specimen == 0).count();
    let mut numbers: BTreeMap<_, BTreeSet<usize>> = BTreeMap::new();
    for m in &mut content.measurements {
        let taken = numbers.entry((m.test, m.direction, m.sample.clone())).or_default();
        let next = taken.last().map_or(1, |n| n + 1);
        if m.specimen == 0 {
            m.specimen = next;
        } else if taken.contains(&m.specimen) {
            let fact = ReadFact::Renumbered { specimen: m.specimen, number: next };
            content.findings.push(Finding::new(fact).at(Place::at(path, m.lines[0], 0)));
            m.specimen = next;
        }
        taken.insert(m.specimen);
    }
    if unnumbered > 1 {
        content.inference.push(format!("{unnumbered} specimens numbered in file order"));
    }
}
