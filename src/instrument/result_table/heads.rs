//! What the heads of a table say of each column.

use super::layout::{NAME, differ, two_units};
use crate::instrument::Direction;
use crate::instrument::context::Context;
use crate::instrument::dialect::TableColumn;
use crate::instrument::facets::Facets;
use crate::instrument::letters;
use crate::instrument::raw::Row;
use crate::instrument::shape::{self, Region};
use crate::instrument::sniff::{Number, number};
use crate::instrument::table_title;
use crate::instrument::unit_text::{unbracketed, unit};
use crate::instrument::words::folded;

/// What the heads say over a column, their text, and where it stands.
pub(super) type Head = (Facets, String, (usize, usize));

/// What the heads say of each column.
pub(super) struct Heads {
    /// From the lowest row up: facets, and whether the text was spread over the columns to the right.
    rows: Vec<Vec<Head>>,
    units: Option<Vec<(String, (usize, usize))>>,
    /// Heads whose letters are directions.
    pub letters: Vec<String>,
    /// Columns whose heads say that parameters are named in them.
    parameters: Vec<usize>,
}

impl Heads {
    pub fn of(region: &Region<'_>, context: &Context<'_>) -> Self {
        let width = region.heads.iter().chain(&region.rows).map(|r| r.cells.len()).max().unwrap_or(0);
        let (mut units, mut letter_texts) = (None, Vec::new());
        let mut rows = Vec::new();
        let words: Vec<&&Row<'_>> = region.heads.iter().filter(|h| !is_units(h)).collect();
        let lowest = words.last().map_or(0, |row| row.line);
        for head in region.heads.iter().filter(|h| is_units(h)) {
            let mut spread: Vec<(String, (usize, usize))> = Vec::with_capacity(width);
            let above = region.heads.iter().rev().find(|row| row.line < head.line);
            for i in 0..width {
                // Between rows of words it stands once over what its parameter stands over.
                let is_merged = head.line < lowest && above.is_some_and(|row| row.get(i).is_none());
                let before = spread.last().filter(|_| is_merged && head.get(i).is_none()).cloned();
                let own = head.get(i).map(unbracketed).unwrap_or_default();
                spread.push(before.unwrap_or((own, (head.line, head.column(i)))));
            }
            units = Some(spread);
        }
        for (k, head) in words.iter().enumerate() {
            let lowest = k + 1 == words.len();
            let mut cells: Vec<Head> = Vec::with_capacity(width);
            let ends = end_of_directions(head, context);
            for i in 0..width {
                let at = (head.line, head.column(i));
                let cell = head.get(i).map(|t| (context.facets(t), folded(t).into_owned(), at));
                let spread = || {
                    if ends.is_some_and(|end| i >= end) {
                        return None;
                    }
                    let below = |j: usize| words[k + 1..].iter().any(|r| r.get(j).is_some());
                    let before = cells.last().filter(|_| !lowest && below(i))?;
                    (before.0.meta.is_none() && !before.1.is_empty()).then(|| before.clone())
                };
                let empty = || (Facets::default(), String::new(), at);
                let cell = cell.or_else(spread).unwrap_or_else(empty);
                cells.push(cell);
            }
            if !region.down && !lowest {
                spread_title(&mut cells, head, words[k + 1], context);
            }
            let lettered = letters::in_heads(head, context.vocabulary);
            letter_texts.extend(lettered.iter().filter_map(|(i, _)| Some(cells.get(*i)?.1.clone())));
            for (i, facets) in lettered {
                cells[i].0 = facets;
            }
            // Where rows are parameters, `B` and `G` beside `A` over their columns are names like it.
            let names = cells.iter().filter(|(f, ..)| f.unknown && f.meta.is_none());
            if region.down && !lowest && names.count() > 0 {
                let symbols = cells.iter_mut().filter(|(f, ..)| f.parameter.is_some() || f.fast.is_some());
                symbols.for_each(|(f, ..)| *f = Facets { unknown: true, ..Facets::default() });
            }
            rows.insert(0, cells);
        }
        let cells = rows.iter().flat_map(|cells| cells.iter().enumerate());
        let parameters =
            cells.filter(|(_, (f, ..))| f.meta == Some(TableColumn::Parameter)).map(|(i, _)| i).collect();
        Self { rows, units, letters: letter_texts, parameters }
    }

    /// The parameter that labels a row: before its first number, else in a column of parameters, `specimen, parameter, value`.
    pub fn label_of(&self, row: &Row<'_>, context: &Context<'_>) -> Option<(usize, Facets)> {
        shape::row_label(row, context).or_else(|| {
            let mut named = self.parameters.iter().filter_map(|i| Some((*i, context.facets(row.get(*i)?))));
            named.find(|(_, f)| f.names_value())
        })
    }

    /// The name that stands in a row above the lowest heads of a column.
    pub fn name_over(&self, index: usize) -> Option<String> {
        let over = self.rows.iter().skip(1).filter_map(|row| row.get(index));
        let mut names =
            over.filter(|(f, text, _)| f.unknown && !text.is_empty() && text.chars().count() <= NAME);
        names.next().map(|(_, text, _)| text.clone())
    }

    /// The name in the lowest heads of a column, and the direction above it.
    pub fn name_below(&self, index: usize) -> Option<(String, Direction)> {
        let [lowest, above, ..] = &self.rows[..] else { return None };
        let (says, text, _) = lowest.get(index)?;
        let (over, ..) = above.get(index)?;
        // Where rows are parameters, a symbol over a column is a name like others.
        let is_name = says.unknown || says.parameter.is_some() || says.fast.is_some();
        let direction = over.direction.filter(|_| !over.unknown && is_name && says.direction.is_none())?;
        (!text.is_empty()).then(|| (text.clone(), direction))
    }

    /// Two units of one column that are not the same, as people read it, with the place of the second.
    pub fn two_units(&self, index: usize) -> Option<(String, (usize, usize))> {
        let below = self.units.as_ref().and_then(|u| u.get(index)).filter(|(text, _)| !text.is_empty());
        let below = below.map(|(text, at)| (text.as_str(), *at));
        let heads = self.rows.iter().filter_map(|row| row.get(index));
        let mut stated =
            below.into_iter().chain(heads.filter_map(|(f, _, at)| Some((f.unit.as_deref()?, *at))));
        let (text, at) = stated.next()?;
        let (other, _) = stated.find(|(other, _)| differ(text, other))?;
        Some((two_units(other, text), at))
    }

    /// What stands over a column: facets, text, and the place of the head that names it.
    pub fn column(&self, index: usize, region: &Region<'_>) -> Head {
        let mut all = Facets::default();
        let mut names: Vec<String> = Vec::new();
        let mut place = None;
        for row in &self.rows {
            let Some((f, text, at)) = row.get(index) else { continue };
            if text.is_empty() {
                continue;
            }
            if f.parameter.is_some() || place.is_none() {
                place = Some(*at);
            }
            // A title above the heads means nothing for the column.
            let prose = f.unknown && (all.is_clear() || region.down && all != Facets::default());
            if !prose {
                all = if all == Facets::default() { f.clone() } else { all.or(f) };
                names.insert(0, text.clone());
            }
        }
        if let Some((text, at)) =
            self.units.as_ref().and_then(|u| u.get(index)).filter(|(t, _)| !t.is_empty())
            && all.unit.is_none()
        {
            all.unit = Some(text.clone());
            place = Some(*at);
        }
        let default = region.heads.last().map_or((0, 0), |h| (h.line, h.column(index)));
        (all, names.join(" "), place.unwrap_or(default))
    }
}

/// `Bending rigidity (gf·cm²/cm)` alone over `Fabric,Warp,Weft`: it stands over the directions, statistics and numbers below it.
fn spread_title(cells: &mut [Head], head: &Row<'_>, below: &Row<'_>, context: &Context<'_>) {
    let Some(says) = table_title::parameter(head, context) else { return };
    let heads_names = below.get(0).is_none_or(|text| context.facets(text).meta.is_some());
    let Some((_, text, place)) = cells.first().cloned().filter(|_| heads_names) else { return };
    let title = (says, text, place);
    let mut is_over = false;
    for (index, cell) in cells.iter_mut().enumerate() {
        let says = below.get(index).map(|text| context.facets(text));
        // A direction reaches over the columns behind it.
        is_over = match says {
            Some(says) if says.names_value() => false,
            Some(says) => says.direction.is_some() || says.statistic.is_some() || says.index.is_some(),
            None => is_over && index > 0,
        };
        *cell = if is_over { title.clone() } else { (Facets::default(), String::new(), title.2) };
    }
}

/// The column behind the last of several directions over columns, `Warp` and `Weft`, each of which reaches as far: none where they are no
/// directions, or reach over different numbers of columns.
fn end_of_directions(head: &Row<'_>, context: &Context<'_>) -> Option<usize> {
    let named: Vec<(usize, Direction)> =
        head.filled().filter_map(|(i, c)| Some((i, context.facets(&c.text).direction?))).collect();
    let last = head.filled().last()?.0;
    let [.., (before, one), (at, other)] = named[..] else { return None };
    // `Warp, Warp, Weft, Weft`: each column has its own.
    if last == at && named.windows(2).any(|pair| pair[0].0 + 1 == pair[1].0 && pair[0].1 == pair[1].1) {
        return Some(at + 1);
    }
    let width = at - before;
    let is_even = named.windows(2).all(|pair| pair[1].0 - pair[0].0 == width);
    (is_even && one != other && last == at).then_some(at + width)
}

pub(super) fn is_units(row: &Row<'_>) -> bool {
    let mut any = false;
    for (_, c) in row.filled() {
        let text = unbracketed(&c.text);
        if text != "-" && (number(&text, '.') != Number::Text || unit(&text).is_err()) {
            return false;
        }
        any |= text != "-";
    }
    any
}
