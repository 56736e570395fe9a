//! Rows to blocks: header lines, then curves in column pairs or a result table; repeated.
//!
//! Blocks may be stacked (each with its own header lines, which override those before) and stand
//! side by side (column pairs under one heading row, told apart by rows above the headings).

use super::caption::is_numbered;
use super::column_name::ColumnName;
use super::context::Context;
use super::dialect::{HeaderKey, Role};
use super::error::{ReadError, ReadProblem};
pub(super) use super::header::{Entry, Header};
use super::keyed_rows::{self, KeyColumn};
use super::label::Label;
use super::numbered;
use super::pairs;
use super::raw::Row;
use super::sample_cells::{begins_with_overflow, is_text, is_without_values};
use super::shape::{self, Region, has_numbers, is_numeric};
use super::sniff::may_be_number;
use super::stray;
use super::suggest;
use super::unit_text::{is_volt, split_unit, unbracketed, unit};
use super::words::folded;
use crate::finding::{Finding, Place, ReadFact};

/// A column of a curve.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub index: usize,
    pub role: Role,
    pub name: String,
    pub unit: Option<String>,
    pub line: usize,
    pub column: usize,
    /// Direction, specimen and branch that its name states.
    pub says: ColumnName,
}

/// The two columns of one curve and the header that holds for it.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub x: Column,
    pub y: Column,
    /// Abscissa and ordinate of the unloading branch, where it has columns of its own.
    pub back: Option<(Column, Column)>,
    pub header: Header,
}

/// A part of the record that the block above began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Part {
    Unloading,
    /// A cycle, from the second on.
    Cycle,
}

/// A part of the file that holds values.
pub(super) enum Block<'t> {
    Curves { pairs: Vec<Pair>, rows: Vec<&'t Row<'t>>, keys: Vec<KeyColumn> },
    Table { header: Header, region: Region<'t> },
}

impl Block<'_> {
    /// Its first and its last line.
    fn lines(&self) -> (usize, usize) {
        let (heads, rows): (&[&Row<'_>], _) = match self {
            Self::Curves { rows, .. } => (&[], rows),
            Self::Table { region, .. } => (&region.heads, &region.rows),
        };
        let first = heads.first().or(rows.first()).map_or(0, |row| row.line);
        (first, rows.last().map_or(first, |row| row.line))
    }
}

/// Splits rows into blocks, with what was noticed on the way.
///
/// # Errors
/// `R002`, `R005`, `R006`, `R007` and `R013`.
pub(super) fn blocks<'t>(
    rows: &'t [Row<'t>],
    context: &Context<'_>,
) -> Result<(Vec<Block<'t>>, Vec<Finding>), ReadError> {
    let (header, lists, findings) = (Header::default(), Vec::new(), Vec::new());
    let (labels, caption_line) = (Vec::new(), 0);
    let mut scanner = Scanner {
        rows,
        context,
        at: 0,
        header,
        lists,
        labels,
        caption_line,
        findings,
        above: None,
        tells_another: false,
    };
    let mut blocks = Vec::new();
    let mut words: Vec<String> = Vec::new();
    // The first row of numbers under headings that nobody knows; a remark may look like one, so that it is an error only
    // where nothing else was read.
    let (mut unread, mut behind, mut stray, mut above) = (None, Vec::new(), Vec::new(), Vec::new());
    let mut title_above: Option<&Row<'_>> = None;
    // The same below a row of words in each of its columns: it is told where something else was read.
    let mut headed: Option<ReadError> = None;
    while let Some(row) = rows.get(scanner.at) {
        if row.is_blank() {
            above.clear();
            scanner.at += 1;
        } else if let Some(columns) = scanner.headings(row) {
            // `Direction,warp` above results of the record that follows holds for that as well.
            let direction = scanner.header.known.get(&HeaderKey::Direction);
            let is_last = |title: &&Row<'_>| direction.is_none_or(|entry| entry.line < title.line);
            if let Some(title) = title_above.take().filter(is_last) {
                scanner.header.known.remove(&HeaderKey::Direction);
                scanner.header_line(title);
            }
            let (block, part) = scanner.curves(columns)?;
            scanner.add(&mut blocks, block, part);
        } else if let Some((region, end)) = shape::region(rows, scanner.at, context) {
            scanner.at = end;
            // Nothing heads the table: a row with a number right above it may be its first.
            stray.extend(std::mem::take(&mut above).into_iter().filter(|_| region.heads.is_empty()));
            // What stood over columns of curves before is over.
            scanner.lists.clear();
            scanner.labels.clear();
            scanner.above = None;
            title_above = region.title.filter(|row| row.filled().nth(1).is_some());
            blocks.push(Block::Table { header: scanner.header.clone(), region });
            scanner.header.repeats = None;
        } else if !numbered::is_key(row, context) && scanner.labels(row) {
            scanner.at += 1;
        } else if let Some(columns) = scanner.columns_above() {
            let (block, part) = scanner.curves(columns)?;
            scanner.add(&mut blocks, block, part);
        } else if is_numeric(row, context.decimal) {
            return Err(suggest::unknown_layout(context, row, &words));
        } else {
            if words.len() > 1 && has_numbers(row, context.decimal) {
                if headed.is_none() && shape::heads_row(&rows[..scanner.at], row, context) {
                    headed = Some(suggest::unknown_layout(context, row, &words));
                }
                unread.get_or_insert_with(|| suggest::unknown_layout(context, row, &words));
            }
            if let Some(Block::Table { region, .. }) = blocks.last()
                && shape::continues(row, region, context)
            {
                behind.push(row.line);
            }
            match stray::value_of_header(row, context) {
                Some(name) => stray.push((row.line, name)),
                None => above.extend(stray::unknown_number(row, context).map(|name| (row.line, name))),
            }
            words = row.filled().map(|(_, c)| folded(&c.text).into_owned()).collect();
            scanner.note_line_between(row);
            scanner.header_line(row);
            scanner.at += 1;
        }
    }
    if blocks.is_empty() {
        return Err(unread.unwrap_or_else(|| suggest::not_read(rows, context)));
    }
    scanner.findings.extend(headed.map(ReadError::not_understood));
    scanner.hand_on_notes(&mut blocks, unread.is_none());
    let has_table = blocks.iter().any(|block| matches!(block, Block::Table { .. }));
    scanner.findings.extend(Some(stray).filter(|_| has_table).and_then(|stray| stray::apart(stray, context)));
    if let Some(line) = behind.first() {
        let place = Place::at(context.path, *line, 0);
        scanner.findings.push(Finding::new(ReadFact::RowsNotRead { lines: behind }).at(place));
    }
    Ok((blocks, scanner.findings))
}

pub(super) struct Scanner<'t, 'a> {
    pub(super) rows: &'t [Row<'t>],
    pub(super) context: &'a Context<'a>,
    pub(super) at: usize,
    pub(super) header: Header,
    /// Header lines with several values, one for each column pair of the next headings.
    pub(super) lists: Vec<(HeaderKey, Vec<Entry>)>,
    /// Rows of labels over the columns of the next headings, each with the index of its cell.
    pub(super) labels: Vec<Vec<(usize, Label, Entry)>>,
    /// Line of the header's caption.
    pub(super) caption_line: usize,
    /// Curves that were left out.
    pub(super) findings: Vec<Finding>,
    /// The columns of the block above, as long as nothing came between that is not understood.
    pub(super) above: Option<Vec<Column>>,
    /// Whether a line behind that block tells another record, or another part of one.
    pub(super) tells_another: bool,
}

impl<'t> Scanner<'t, '_> {
    /// Gives tables the keys of numbers below them, and the only block of a file that is all understood a title with a number.
    fn hand_on_notes(&self, blocks: &mut [Block<'_>], is_understood: bool) {
        let spans: Vec<_> = blocks.iter().map(Block::lines).collect();
        let keys = numbered::keys_below(&spans, self.rows, self.context);
        let title = self.header.caption.as_ref().filter(|title| is_numbered(title, self.context.vocabulary));
        for ((block, key), (_, last)) in blocks.iter_mut().zip(keys).zip(&spans) {
            let Block::Table { header, .. } = block else { continue };
            header.key_below = key;
            if is_understood && spans.len() == 1 && header.caption.is_none() && self.caption_line > *last {
                header.caption = title.cloned();
            }
        }
    }

    /// The columns of a heading row: at least an abscissa and an ordinate.
    pub(super) fn headings(&self, row: &Row<'_>) -> Option<Vec<Column>> {
        let column = |(index, cell): (usize, &super::raw::Cell<'_>)| {
            let (name, unit) = split_unit(&cell.text);
            let says = self.context.column_name(&name);
            let role = says.role?;
            Some(Column { index, role, name, unit, line: row.line, column: cell.column, says })
        };
        let mut columns: Vec<Column> = pairs::along_sweep(row.filled().filter_map(column).collect());
        pairs::directions_of_dimensions(&mut columns);
        let sweep = columns
            .iter()
            .any(|c| c.role == Role::Position && (c.unit.is_some() || self.has_unit_below(row, c.index)));
        let abscissa = columns.iter().any(|c| c.role.is_abscissa());
        let ordinate = columns.iter().any(|c| !c.role.is_abscissa() && c.role != Role::Ignored);
        // A result table may have columns named thickness and pressure too; then it has symbols.
        let curve = abscissa && ordinate && (sweep || !shape::has_symbols(row, self.context));
        let curve = curve || self.half_pair(row, &columns);
        if curve {
            return Some(columns);
        }
        self.headless(row)
    }

    /// Whether a unit stands in the next row, below a heading.
    fn has_unit_below(&self, row: &Row<'_>, index: usize) -> bool {
        let next = self.rows.partition_point(|r| r.line <= row.line);
        let below = self.rows.get(next).and_then(|r| r.get(index)).map(unbracketed);
        below.is_some_and(|t| !t.starts_with(|c: char| c.is_ascii_digit()) && unit(&t).is_ok())
    }

    /// A single known column over numbers: a heading row that lacks its other half.
    fn half_pair(&self, row: &Row<'_>, columns: &[Column]) -> bool {
        let below = self.rows[self.at + 1..].iter().find(|r| !r.is_blank());
        columns.iter().any(|c| c.role != Role::Ignored)
            && columns.len() == row.filled().count()
            && columns.iter().all(|c| c.unit.is_some())
            && below.is_some_and(|r| r.filled().all(|(_, c)| may_be_number(&c.text, self.context.decimal)))
    }

    /// The columns that the dialect states for files without headings.
    fn headless(&self, row: &Row<'_>) -> Option<Vec<Column>> {
        let order = &self.context.dialect?.column_order;
        if order.is_empty() || !is_numeric(row, self.context.decimal) {
            return None;
        }
        let column = |(index, role): (usize, &Role)| Column {
            index,
            role: *role,
            name: format!("column {}", index + 1),
            unit: None,
            line: row.line,
            column: row.column(index),
            says: ColumnName::default(),
        };
        Some(order.iter().enumerate().map(column).collect())
    }

    fn curves(&mut self, mut columns: Vec<Column>) -> Result<(Block<'t>, Option<Part>), ReadError> {
        let heading = &self.rows[self.at];
        if !is_numeric(heading, self.context.decimal) {
            self.at += 1;
            self.unit_row(&mut columns);
            self.lines_below_headings();
        }
        let part = self.part();
        let mut rows = self.data_rows(&columns);
        while let Some(next) = self.next_page(heading, &rows, &columns) {
            self.at = next;
            rows.extend(self.data_rows(&columns));
        }
        self.direction_above();
        self.check_width(heading, &rows)?;
        let keys = keyed_rows::columns(heading, &columns, &rows, &self.header, self.context);
        self.note_strange_columns(heading, &columns, &keys, &rows);
        for column in &keys {
            if column.is_its_key() {
                self.note_entry_in_rows(column, &rows);
            }
            let written = column.directions.as_ref();
            let fact = written.and_then(|(written, of_texts)| written.fact(of_texts.keys().cloned()));
            let place = Place::at(self.context.path, heading.line, heading.column(column.index));
            let fact = fact.or_else(|| column.states_told(&heading.cells[column.index].text, &rows));
            self.findings.extend(fact.map(|fact| Finding::new(fact).at(place)));
        }
        (self.above, self.tells_another) = (Some(columns.clone()), false);
        let mut pairs = self.pairs(columns, &rows)?;
        self.distribute(&mut pairs)?;
        self.leave_out_statistics(&mut pairs);
        self.note_words(&pairs);
        self.header.caption = None;
        Ok((Block::Curves { pairs, rows, keys }, part))
    }

    /// A row of units below headings that have none.
    fn unit_row(&mut self, columns: &mut [Column]) {
        let Some(row) = self.rows.get(self.at) else { return };
        let bare = |i: usize| row.get(i).map(unbracketed);
        let is_unit =
            |t: &str| !t.starts_with(|c: char| c.is_ascii_digit()) && (is_volt(t) || unit(t).is_ok());
        if columns.iter().any(|c| c.unit.is_some()) || row.is_blank() {
            return;
        }
        if row
            .filled()
            .all(|(i, _)| bare(i).is_some_and(|t| is_unit(&t) || t == "1/cm" || row.get(i) == Some("(1)")))
        {
            for column in columns {
                column.unit = bare(column.index);
                (column.line, column.column) = (row.line, row.column(column.index));
            }
            self.at += 1;
        }
    }

    /// Rows up to the next header line, heading or text. Remarks among the numbers are none of them.
    fn data_rows(&mut self, columns: &[Column]) -> Vec<&'t Row<'t>> {
        let mut out = Vec::new();
        let mut after_blank = false;
        while let Some(row) = self.rows.get(self.at) {
            if row.is_blank() {
                after_blank = true;
            } else if self.is_remark(row, columns) {
                // Remarks before other header lines or at the end belong to those.
                let other = |r: &Row<'_>| !r.is_blank() && !self.is_remark(r, columns);
                let next = self.rows[self.at..].iter().position(other).map(|n| self.at + n);
                match next.filter(|n| !self.ends_data(&self.rows[*n], columns, false)) {
                    Some(next) => self.at = next,
                    None => break,
                }
                continue;
            } else if self.ends_data(row, columns, after_blank) {
                break;
            } else {
                out.push(row);
                after_blank = false;
            }
            self.at += 1;
        }
        out
    }

    /// A line that begins with `#`, states nothing that is known here, and holds no value. `#REF!` is the error
    /// of a spreadsheet.
    fn is_remark(&self, row: &Row<'_>, columns: &[Column]) -> bool {
        let Some(text) = row.filled().next().and_then(|(_, c)| c.text.strip_prefix('#')) else {
            return false;
        };
        let key =
            self.context.vocabulary.key(&split_unit(text.split([':', '=']).next().unwrap_or_default()).0);
        let used = |i: usize| columns.iter().any(|c| c.index == i && c.role != Role::Ignored);
        let is_word = |t: &str| !t.starts_with('#') && !may_be_number(t, self.context.decimal);
        let is_error = text.starts_with(char::is_alphabetic)
            && (text.ends_with(['!', '?'])
                || !row.filled().skip(1).filter(|(i, _)| used(*i)).all(|(_, c)| is_word(&c.text)));
        !is_error
            && !begins_with_overflow(row)
            && key.is_none_or(|k| matches!(k, HeaderKey::Remark | HeaderKey::Circumstance))
    }

    fn ends_data(&self, row: &Row<'_>, columns: &[Column], after_blank: bool) -> bool {
        let used = |i: usize| columns.iter().any(|c| c.index == i && c.role != Role::Ignored);
        let Some((first, cell)) = row.filled().next() else { return false };
        let decimal = self.context.decimal;
        if !is_text(&cell.text, decimal) {
            return false;
        }
        let columns_used: Vec<usize> =
            columns.iter().filter(|c| c.role != Role::Ignored).map(|c| c.index).collect();
        if is_without_values(row, &columns_used, decimal) {
            return false;
        }
        let key = split_unit(cell.text.split([':', '=']).next().unwrap_or_default()).0;
        let known = !begins_with_overflow(row)
            && (self.context.vocabulary.key(&key).is_some() || self.headings(row).is_some());
        let no_number = row.filled().filter(|(i, _)| used(*i)).all(|(_, c)| is_text(&c.text, decimal));
        known || no_number || (after_blank && used(first))
    }

    /// Comma as delimiter and as decimal mark at once: twice as many cells as headings.
    fn check_width(&self, heading: &Row<'_>, rows: &[&Row<'_>]) -> Result<(), ReadError> {
        let named = heading.filled().last().map_or(0, |(i, _)| i + 1);
        let Some(row) = rows.iter().find(|r| r.filled().last().is_some_and(|(i, _)| i >= named)) else {
            return Ok(());
        };
        let cells = row.filled().count();
        let whole = row.filled().all(|(_, c)| !c.text.contains('.'));
        let problem = if self.context.delimiter == ',' && named < cells && whole {
            ReadProblem::Ambiguous {
                found: format!("{named} headings over {cells} cells: ',' is delimiter or decimal mark"),
            }
        } else {
            ReadProblem::RaggedRow { found: format!("the row has {cells} cells under {named} headings") }
        };
        Err(self.context.error(row.line, row.column(named), problem))
    }
}
