//! Where a result table begins and ends, and which way it lies: parameters across, or down.

use std::collections::BTreeSet;

use super::caption::is_numbered;
use super::context::Context;
use super::dialect::{Role, Statistic, TableColumn};
use super::facets::Facets;
use super::numbered;
use super::raw::{Cell, Row};
use super::row_kind::{Kind, kind};
pub(super) use super::row_kind::{facets, is_value, is_value_of};
pub(super) use super::section::section;
use super::sniff::may_be_number;
use super::table_title;
use super::unit_text::split_unit;
use super::value::is_gap;
use super::{Direction, Parameter};

/// The most rows of heads.
const HEADS: usize = 5;

/// The most titles of sections above one table: who writes more writes header lines.
const TITLES: usize = 3;

/// A result table: its heads and the rows below them.
pub(super) struct Region<'t> {
    /// Rows of heads, from above; one row of units may be the last.
    pub heads: Vec<&'t Row<'t>>,
    /// Rows below the heads: values, and titles of sections.
    pub rows: Vec<&'t Row<'t>>,
    /// Whether each row is a parameter; else each column is.
    pub down: bool,
    /// The direction that stands above the heads, and its row.
    pub section: Option<Direction>,
    pub title: Option<&'t Row<'t>>,
}

/// Whether a row behind a table is laid out like its first or last one: no other cells are filled, with numbers in the same
/// places and words that are no header line in the others.
pub(super) fn continues(row: &Row<'_>, region: &Region<'_>, context: &Context<'_>) -> bool {
    let form = |row: &Row<'_>| -> Vec<(usize, bool)> {
        row.filled().map(|(i, c)| (i, is_value(&c.text, context))).collect()
    };
    let own = form(row);
    let is_header = row.filled().next().is_some_and(|(_, c)| {
        let name = c.text.split([':', '=']).next().unwrap_or_default();
        context.vocabulary.key(name.trim_start_matches('#').trim()).is_some()
    });
    let mut ends = [region.rows.first(), region.rows.last()].into_iter().flatten();
    own.len() > 1
        && own.iter().any(|c| c.1)
        && !is_header
        && ends.any(|r| {
            let other = form(r);
            own.iter().all(|c| other.contains(c))
        })
}

/// Whether the row above has words in the same three columns or more, beside words and numbers of its own: a table of something that is
/// not known, and no header line.
pub(super) fn heads_row(above: &[Row<'_>], row: &Row<'_>, context: &Context<'_>) -> bool {
    let Some(head) = above.last() else { return false };
    let columns = |row: &Row<'_>| row.filled().map(|(i, _)| i).collect::<Vec<_>>();
    let has_name = row.filled().next().is_some_and(|(_, c)| !is_value(&c.text, context));
    has_name
        && row.filled().nth(2).is_some()
        && columns(row) == columns(head)
        && row.filled().skip(1).all(|(_, c)| is_value(&c.text, context))
        && head.filled().all(|(_, c)| !is_value(&c.text, context))
}

/// Several numbers and nothing else.
pub(super) fn is_numeric(row: &Row<'_>, decimal: char) -> bool {
    row.filled().count() > 1 && row.filled().all(|(_, c)| may_be_number(&c.text, decimal))
}

/// Whether numbers stand beside what may be the name of their row.
pub(super) fn has_numbers(row: &Row<'_>, decimal: char) -> bool {
    row.filled().filter(|(_, c)| may_be_number(&c.text, decimal)).count() > 1
}

/// Whether a row of words is the heading of a result table by its symbols.
pub(super) fn has_symbols(row: &Row<'_>, context: &Context<'_>) -> bool {
    if row.filled().any(|(_, c)| is_value(&c.text, context)) {
        return false;
    }
    // A curve may have one column that is a parameter's namesake: thickness, elongation.
    let quantity = |f: &Facets| (f.parameter, f.direction, f.index, f.fast.map(|v| v.symbol()));
    let named: Vec<Facets> = facets(row, context).into_iter().filter(Facets::names_value).collect();
    named.iter().map(quantity).collect::<BTreeSet<_>>().len() > 1 && across(&[row], context)
}

/// Whether a row heads the columns of curves: an abscissa and an ordinate.
fn is_curve(row: &Row<'_>, context: &Context<'_>) -> bool {
    let role = |cell: &str| context.column_name(&split_unit(cell).0).role;
    let roles: Vec<Role> = row.filled().filter_map(|(_, c)| role(&c.text)).collect();
    roles.iter().any(|r| r.is_abscissa()) && roles.iter().any(|r| !r.is_abscissa() && *r != Role::Ignored)
}

/// The parameter or FAST value that labels a row: one of the cells before its first number.
pub(super) fn row_label(row: &Row<'_>, context: &Context<'_>) -> Option<(usize, Facets)> {
    let labels = row.filled().take_while(|(_, c)| !is_value(&c.text, context) && !is_gap(&c.text));
    labels.map(|(i, c)| (i, context.facets(&c.text))).find(|(_, f)| f.names_value())
}

/// Columns whose heads say that they name fabrics, directions or specimens, beside one that names a value with its unit or a
/// column of directions: a sample called `T` there is no thickness. `Sample` alone may stand over parameters, beside names.
fn named_columns(heads: &[&Row<'_>], context: &Context<'_>) -> BTreeSet<usize> {
    use TableColumn::{Direction, Fabric, Id, N, Number, Specimen};
    let cells: Vec<Facets> = heads.iter().flat_map(|row| facets(row, context)).collect();
    let has_directions = cells.iter().any(|f| f.meta == Some(Direction));
    if !cells.iter().any(|f| f.names_value() && (f.unit.is_some() || has_directions)) {
        return BTreeSet::new();
    }
    let all = heads.iter().flat_map(|row| facets(row, context).into_iter().enumerate());
    all.filter(|(_, f)| matches!(f.meta, Some(Id | Fabric | Direction | Specimen | Number | N)))
        .map(|(i, _)| i)
        .collect()
}

fn is_labelled(row: &Row<'_>, named: &BTreeSet<usize>, context: &Context<'_>) -> bool {
    let label = row_label(row, context).filter(|(at, f)| f.statistic.is_none() && !named.contains(at));
    label.is_some_and(|(_, f)| row.filled().any(|(_, c)| is_value_of(&c.text, &f, context)))
}

/// What the heads from a row on are, if a table begins there.
struct Heads {
    end: usize,
    down: bool,
    section: Option<Direction>,
    title: Option<usize>,
    first: usize,
}

/// Whether heads of parameters make a table: several, or one with a column of names or a unit.
fn across(heads: &[&Row<'_>], context: &Context<'_>) -> bool {
    let all: Vec<Facets> = heads.iter().flat_map(|r| facets(r, context)).collect();
    let named = all.iter().filter(|f| f.names_value());
    let parameters: Vec<&Facets> =
        named.filter(|f| matches!(f.statistic, None | Some(Statistic::Mean))).collect();
    let named = all.iter().any(|f| {
        matches!(
            f.meta,
            Some(
                TableColumn::Id
                    | TableColumn::Fabric
                    | TableColumn::Direction
                    | TableColumn::Specimen
                    | TableColumn::Number
                    | TableColumn::N
            )
        )
    });
    let filled: usize = heads.iter().map(|r| r.filled().count()).max().unwrap_or(0);
    let has_unit =
        parameters.iter().any(|f| f.unit.is_some()) || heads.iter().any(|r| kind(r, context) == Kind::Units);
    let distinct: BTreeSet<_> =
        parameters.iter().map(|f| (f.parameter, f.direction, f.index, f.fast.map(|v| v.symbol()))).collect();
    match distinct.len() {
        0 => false,
        1 => named && (filled > 2 || has_unit),
        // `sample,B` is a header line of a fabric called B, and so is `weight,15 mg/cm²`.
        _ => true,
    }
}

/// Whether names stand over the symbols of the next row, and none over its first column.
fn stands_over(row: &Row<'_>, next: Option<&Row<'_>>, context: &Context<'_>) -> bool {
    row.get(0).is_none()
        && row.filled().nth(1).is_some()
        && row.filled().all(|(_, c)| !is_value(&c.text, context))
        && facets(row, context).iter().all(|f| f.unknown || *f == Facets::default())
        && next.is_some_and(|next| {
            has_symbols(next, context)
                || heads_statistics(next, context)
                || heads_directions_again(next, context)
        })
}

/// `Parameter, Direction, Mean, CV, Mean, CV`: statistics of several fabrics beside a column of parameters.
fn heads_statistics(row: &Row<'_>, context: &Context<'_>) -> bool {
    let says = facets(row, context);
    let means = says.iter().filter(|f| f.statistic == Some(Statistic::Mean)).count();
    means > 1 && says.iter().any(|f| f.meta == Some(TableColumn::Parameter))
}

/// `Parameter, Unit, Warp, Weft, Warp, Weft`: directions of several fabrics beside a column of parameters.
fn heads_directions_again(row: &Row<'_>, context: &Context<'_>) -> bool {
    let says = facets(row, context);
    let warps = says.iter().filter(|f| f.direction == Some(Direction::Warp)).count();
    let wefts = says.iter().filter(|f| f.direction == Some(Direction::Weft)).count();
    warps > 1 && warps == wefts && says.iter().any(|f| f.meta == Some(TableColumn::Parameter))
}

/// Whether a row has one cell alone, and no number in it.
fn is_alone(row: &Row<'_>, context: &Context<'_>) -> bool {
    row.filled().count() == 1 && row.filled().all(|(_, cell)| !is_value(&cell.text, context))
}

/// How many rows below a head for values name a parameter, where the first does in words that are not understood.
fn below_values<'r>(
    heads: &[&Row<'_>],
    rows: impl Iterator<Item = &'r Row<'r>>,
    named: &BTreeSet<usize>,
    context: &Context<'_>,
) -> usize {
    let mut says = heads.iter().flat_map(|row| facets(row, context).into_iter().enumerate());
    // In the first column it is no head of values: a name stands before each.
    if !says.any(|(i, f)| i > 0 && f.meta == Some(TableColumn::Value)) {
        return 0;
    }
    rows.take(3).filter(|row| has_own_label(row, context) && is_labelled(row, named, context)).count()
}

/// Whether a row is labelled by a parameter that no header line has: the weight and the thickness of the sample stand there too.
fn has_own_label(row: &Row<'_>, context: &Context<'_>) -> bool {
    row_label(row, context).is_some_and(|(_, f)| !matches!(f.parameter, Some(Parameter::T0 | Parameter::W)))
}

fn heads(rows: &[Row<'_>], at: usize, context: &Context<'_>) -> Option<Heads> {
    let (mut end, mut first, mut section, mut title, mut titles) = (at, at, None, None, 0);
    let mut found: Vec<&Row<'_>> = Vec::new();
    while let Some(row) = rows.get(end).filter(|_| found.len() < HEADS) {
        if row.is_blank() {
            // A title of a section may stand apart from its heads.
            if !found.is_empty() {
                break;
            }
            end += 1;
            continue;
        }
        match kind(row, context) {
            // Columns of curves that share a name with a parameter: thickness, elongation.
            Kind::Head if is_curve(row, context) && !has_symbols(row, context) => return None,
            Kind::Head | Kind::Units => {
                if found.is_empty() {
                    first = end;
                }
                found.push(row);
            }
            // `1 2 3` below `Warp` and again below `Weft`.
            Kind::Values if !found.is_empty() && numbered::counts_columns(row, context) => found.push(row),
            Kind::Other if found.is_empty() && stands_over(row, rows.get(end + 1), context) => {
                first = end;
                found.push(row);
            }
            Kind::Section(direction) if found.is_empty() && titles < TITLES => {
                (section, title) = (Some(direction), Some(end));
                titles += 1;
            }
            _ => break,
        }
        end += 1;
    }
    // The title of a section may be the first row below the heads: `Bending`, `Shear`.
    let next = || {
        rows[end..].iter().filter(|r| !r.is_blank()).skip_while(|r| !found.is_empty() && is_alone(r, context))
    };
    let named = named_columns(&found, context);
    let labelled = next().take(3).take_while(|r| is_labelled(r, &named, context)).count();
    let labelled = if labelled == 0 { below_values(&found, next(), &named, context) } else { labelled };
    let several = found.iter().flat_map(|r| facets(r, context)).filter(Facets::names_value).count() > 1;
    let parameter_column =
        found.iter().flat_map(|r| facets(r, context)).any(|f| f.meta == Some(TableColumn::Parameter));
    if found.is_empty() {
        // Rows of parameters without heads: the values stand behind them.
        let bare = rows.get(end).is_some_and(|r| is_labelled(r, &named, context))
            && labelled >= 2
            && next().take(labelled).any(|r| has_own_label(r, context));
        return bare.then_some(Heads { end, down: true, section, title, first: end });
    }
    if parameter_column || (labelled > 0 && !several) {
        let enough = labelled > 0
            || parameter_column && next().next().is_some_and(|r| kind(r, context) == Kind::Values);
        return enough.then_some(Heads { end, down: true, section, title, first });
    }
    if !across(&found, context) {
        let first = title_above(&rows[..first], &found, context)?;
        return next().next().is_some().then_some(Heads { end, down: false, section, title, first });
    }
    // Heads without anything below are a list of words.
    next().next().is_some().then_some(Heads { end, down: false, section, title, first })
}

/// The row of a title that names the parameter of directions below it, `B (gf·cm²/cm)` over `Fabric,Warp,Weft`, with a blank row between
/// them at most.
fn title_above(above: &[Row<'_>], found: &[&Row<'_>], context: &Context<'_>) -> Option<usize> {
    let says: Vec<Facets> = found.iter().flat_map(|row| facets(row, context)).collect();
    let heads_directions =
        says.iter().any(|f| f.direction.is_some()) && !says.iter().any(Facets::names_value);
    // `Yarn,Warp,Weft` heads something else.
    let names_fabrics = found.iter().all(|row| {
        row.get(0).is_none_or(|text| context.facets(text).meta.is_some_and(TableColumn::names_rows))
    });
    let blanks = above.iter().rev().take_while(|row| row.is_blank()).count();
    let at =
        above.len().checked_sub(blanks + 1).filter(|_| heads_directions && names_fabrics && blanks < 2)?;
    table_title::parameter(&above[at], context).map(|_| at)
}

/// Whether a row is a title like that of the table, over another parameter, one with the number of a table, or heads over something else.
fn begins_another(row: &Row<'_>, region: &Region<'_>, context: &Context<'_>) -> bool {
    if is_alone(row, context) && row.get(0).is_some_and(|text| is_numbered(text, context.vocabulary)) {
        return true;
    }
    let Some(last) = region.heads.last().filter(|_| !region.down) else { return false };
    if facets(last, context).iter().any(Facets::names_value) {
        return false;
    }
    let behind =
        |row: &Row<'_>| row.filled().skip(1).map(|(i, c)| (i, c.text.to_string())).collect::<Vec<_>>();
    // The same heads once more go on with the table.
    let has_heads = row.get(0).is_some()
        && row.get(0) != last.get(0)
        && row.filled().count() > 1
        && behind(row) == behind(last);
    has_heads || table_title::parameter(row, context).is_some()
}

/// The table that begins at a row, and the row behind it.
pub(super) fn region<'t>(
    rows: &'t [Row<'t>],
    at: usize,
    context: &Context<'_>,
) -> Option<(Region<'t>, usize)> {
    let row = rows.get(at)?;
    // Long records are numbers nearly everywhere.
    let first = row.filled().next()?.1;
    if first.text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.'))
        && kind(row, context) != Kind::Head
        && !is_labelled(row, &BTreeSet::new(), context)
    {
        return None;
    }
    let found = heads(rows, at, context)?;
    let head_rows: Vec<&Row<'_>> = rows[found.first..found.end].iter().filter(|r| !r.is_blank()).collect();
    let title = found.title.and_then(|at| rows.get(at));
    let mut region =
        Region { heads: head_rows, rows: Vec::new(), down: found.down, section: found.section, title };
    let mut i = found.end;
    let mut end = i;
    while let Some(row) = rows.get(i) {
        // A blank row may stand below the heads.
        let after_blank = i > end && !region.rows.is_empty();
        // A rule below the heads, `|---|---|`, says nothing.
        if row.is_blank() || row.filled().all(|(_, c)| is_gap(&c.text)) {
            i += 1;
            continue;
        }
        if is_head_again(&rows[i..], &region.heads) {
            i += region.heads.len();
            end = i;
            continue;
        }
        if !belongs(rows, i, &region, after_blank, context) {
            // A note between two rows: below it the table goes on.
            let goes_on = !after_blank
                && is_header_line(row, context)
                && rows.get(i + 1).is_some_and(|next| {
                    kind(next, context) == Kind::Values
                        && !is_header_line(next, context)
                        && (fits(next, &region, context) || heads_first_rows(row, next, &region, context))
                });
            if !goes_on {
                break;
            }
            if is_bare_key(row) {
                region.rows.push(row);
            }
            i += 1;
            continue;
        }
        region.rows.push(row);
        i += 1;
        end = i;
    }
    Some((region, end))
}

/// `Surface` alone is a title as well as a key.
fn is_bare_key(row: &Row<'_>) -> bool {
    row.filled().count() == 1 && !row.filled().any(|(_, c)| c.text.contains([':', '=']))
}

/// Whether it is that of the first rows of parameters.
fn heads_first_rows(row: &Row<'_>, next: &Row<'_>, region: &Region<'_>, context: &Context<'_>) -> bool {
    is_bare_key(row) && region.down && region.rows.is_empty() && is_labelled(next, &BTreeSet::new(), context)
}

/// Whether the heads stand here once more, as at the top of a new page.
fn is_head_again(rows: &[Row<'_>], heads: &[&Row<'_>]) -> bool {
    !heads.is_empty()
        && rows.len() >= heads.len()
        && heads
            .iter()
            .zip(rows)
            .all(|(a, b)| a.cells.iter().map(|c| &c.text).eq(b.cells.iter().map(|c| &c.text)))
}

/// Whether a row below the heads is part of the table.
fn belongs(
    rows: &[Row<'_>],
    at: usize,
    region: &Region<'_>,
    after_blank: bool,
    context: &Context<'_>,
) -> bool {
    let row = &rows[at];
    let is_remark = row.get(0).is_some_and(|t| t.starts_with('#')) && row.filled().count() == 1;
    if is_remark {
        return !after_blank;
    }
    // `1 = weft, 2 = warp` below the table.
    if numbered::is_key(row, context) || begins_another(row, region, context) {
        return false;
    }
    match kind(row, context) {
        // Heads of their own may follow the title of a section: then it is another table.
        Kind::Section(_) => heads(rows, at, context).is_none_or(|h| h.first == h.end),
        Kind::Values if region.down => {
            is_labelled(row, &BTreeSet::new(), context) || (!after_blank && kind(row, context) != Kind::Head)
        }
        Kind::Values => !after_blank || fits(row, region, context),
        Kind::Head => !after_blank && heads(rows, at, context).is_none() && !is_header_line(row, context),
        Kind::Units | Kind::Other => !after_blank && !is_header_line(row, context),
    }
}

/// A key that header lines have, with a value.
fn is_header_line(row: &Row<'_>, context: &Context<'_>) -> bool {
    let mut filled = row.filled();
    let Some((_, first)) = filled.next() else { return false };
    let key = first.text.split([':', '=']).next().unwrap_or_default();
    context.vocabulary.key(key).is_some()
        && row.filled().count() <= 2
        && !row.filled().any(|(_, c)| is_value(&c.text, context))
}

/// Whether a row behind a blank one has values where the table has them.
fn fits(row: &Row<'_>, region: &Region<'_>, context: &Context<'_>) -> bool {
    let Some(above) = region.rows.iter().rev().find(|r| r.filled().any(|(_, c)| may_hold(c, context))) else {
        return false;
    };
    row.filled().any(|(_, c)| may_hold(c, context))
        && holds(row, above, context)
        && holds(above, row, context)
}

/// Whether a row has values, or dashes in their place, wherever another has values; a unit or a direction may be a dash too.
fn holds(other: &Row<'_>, row: &Row<'_>, context: &Context<'_>) -> bool {
    let mut values = other.filled().filter(|(_, c)| is_value(&c.text, context));
    values.all(|(i, _)| row.cells.get(i).is_some_and(|c| may_hold(c, context)))
}

fn may_hold(cell: &Cell<'_>, context: &Context<'_>) -> bool {
    is_value(&cell.text, context) || is_gap(&cell.text)
}
