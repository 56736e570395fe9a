//! Columns of curves whose cells carry their units, `0.5 mm` below `thickness`: the unit goes to the heading.

use std::borrow::Cow;

use super::context::Context;
use super::error::{ReadError, ReadProblem};
use super::raw::Row;
use super::result_table::{differ, two_units};
use super::sniff::{Number, number};
use super::unit_text::{split_unit, unit};
use super::words::{folded, trimmed};

/// The rows with bare numbers below headings with units; none where no cell of a curve has one.
///
/// # Errors
/// R018 where cells of a column, or a cell and its heading, state units that are not the same.
pub(super) fn to_headings<'r>(
    rows: &'r [Row<'_>],
    context: &Context<'_>,
) -> Result<Option<Vec<Row<'r>>>, ReadError> {
    let mut out: Option<Vec<Row<'r>>> = None;
    let mut before: Option<usize> = None;
    let mut at = 0;
    while let Some(row) = rows.get(at) {
        let is_first = is_united(row) && before.is_some_and(|b| !is_united(&rows[b]));
        let columns = before.filter(|_| is_first).map(|b| Columns::of(&rows[b], b, context));
        if let Some(mut columns) = columns.filter(|c| c.is_pair) {
            let out = out.get_or_insert_with(|| rows.iter().map(Row::by_reference).collect());
            while let Some(row) = rows.get(at).filter(|row| row.is_blank() || is_of_numbers(row)) {
                columns.take(row, &mut out[at], context)?;
                at += 1;
            }
            columns.finish(out);
            before = None;
            continue;
        }
        if !row.is_blank() {
            before = Some(at);
        }
        at += 1;
    }
    Ok(out)
}

/// Whether every cell begins as a number: one look at each.
fn is_of_numbers(row: &Row<'_>) -> bool {
    row.filled()
        .all(|(_, c)| trimmed(&c.text).starts_with(|c: char| c.is_ascii_digit() || "-+.−".contains(c)))
}

/// Whether all begin so, and one of them ends as none.
fn is_united(row: &Row<'_>) -> bool {
    // What most rows lack is asked first.
    row.filled().any(|(_, c)| !ends_as_number(&c.text)) && row.filled().nth(1).is_some() && is_of_numbers(row)
}

fn ends_as_number(cell: &str) -> bool {
    trimmed(cell).ends_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | ','))
}

/// A number and the unit behind it. An angle is one here: a curve has no directions in its cells.
fn parts(cell: &str, decimal: char) -> Option<(String, String)> {
    let text = folded(cell);
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.,".contains(c)))?;
    let exponent = text[end..].starts_with(['e', 'E'])
        && text[end + 1..].starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-'));
    let end = if exponent {
        end + 1 + text[end + 1..].find(|c: char| !(c.is_ascii_digit() || matches!(c, '+' | '-')))?
    } else {
        end
    };
    let (bare, behind) = (text[..end].trim_end(), text[end..].trim());
    let is_unit =
        behind.contains(|c: char| c.is_alphabetic() || matches!(c, '%' | '°')) && unit(behind).is_ok();
    let is_number = matches!(number(bare, decimal), Number::Value(_));
    (is_unit && is_number).then(|| (bare.to_string(), behind.to_string()))
}

/// The columns of a curve below its headings.
struct Columns {
    /// Index of the row of the headings.
    heading: usize,
    /// Index of each column that has a role, its own unit, and that of its cells.
    of: Vec<(usize, Option<String>, Option<String>)>,
    is_pair: bool,
}

impl Columns {
    fn of(row: &Row<'_>, heading: usize, context: &Context<'_>) -> Self {
        let (mut abscissa, mut ordinate) = (false, false);
        let mut of = Vec::new();
        for (index, cell) in row.filled() {
            let (name, unit) = split_unit(&cell.text);
            let Some(role) = context.column_name(&name).role else { continue };
            if role.is_abscissa() {
                abscissa = true
            } else {
                ordinate = true
            }
            of.push((index, unit, None));
        }
        Self { heading, of, is_pair: abscissa && ordinate }
    }

    /// Takes the units out of a row.
    fn take(&mut self, row: &Row<'_>, own: &mut Row<'_>, context: &Context<'_>) -> Result<(), ReadError> {
        for (index, of_heading, of_cells) in &mut self.of {
            let Some((bare, unit)) = row.get(*index).and_then(|c| parts(c, context.decimal)) else {
                continue;
            };
            let stated = of_cells.as_deref().or(of_heading.as_deref());
            if let Some(stated) = stated.filter(|stated| differ(stated, &unit)) {
                let problem = ReadProblem::BadTable { found: two_units(stated, &unit) };
                return Err(context.error(row.line, row.column(*index), problem));
            }
            of_cells.get_or_insert(unit);
            own.cells[*index].text = Cow::Owned(bare);
        }
        Ok(())
    }

    /// Gives the headings without a unit that of their cells.
    fn finish(&self, rows: &mut [Row<'_>]) {
        let Some(row) = rows.get_mut(self.heading) else { return };
        for (index, of_heading, of_cells) in &self.of {
            if let (None, Some(unit), Some(cell)) = (of_heading, of_cells, row.cells.get_mut(*index)) {
                cell.text = Cow::Owned(format!("{} ({unit})", cell.text.trim()));
            }
        }
    }
}
