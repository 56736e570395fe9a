//! Result tables: KES symbols across or down, with directions, specimens, units and statistics in any cell.
//!
//! Every cell of words is read for what it says ([`Facets`]); a value is then what its column, its row, the title of its
//! section and the lines above the table say together. So `fabric,direction,B (gf·cm²/cm)`, `id,B_warp_uN_m`, two rows of
//! heads, `parameter,unit,warp,weft`, `1 2 3 AVE` under WARP and WEFT and one row for each value are one kind of table.

mod cells;
mod counting;
mod deviations;
mod directions;
mod fast_cells;
mod heads;
mod labels;
mod layout;
mod merged_cells;
mod names;
mod noted;
mod repeats;
mod row_facts;
mod rows_above;
mod sections;
mod shifted;
mod states;
mod statuses;
mod strangers;
mod summaries;
mod units;

use std::collections::{BTreeMap, BTreeSet};

use fast_cells::FastCell;
use layout::{Column, Layout};
pub(super) use layout::{differ, two_units};
use row_facts::{RowFacts, Title};

use super::context::Context;
use super::dialect::{HeaderKey, Statistic};
use super::error::{ReadError, ReadProblem};
use super::layout::Header;
use super::raw::Row;
use super::shape::{self, Region};
use super::value::is_significance;
use super::{Direction, Parameter, ResultValue, StatedStiffness};
use crate::finding::{Finding, LeftOutLine};
use crate::kes::ValueStatus;

/// Values with the fabric that each belongs to.
pub(super) type Values = Vec<(Option<String>, ResultValue)>;

/// What a table gives.
#[derive(Debug)]
pub(super) struct Contents {
    pub values: Values,
    pub stiffnesses: Vec<(Option<String>, StatedStiffness)>,
    pub findings: Vec<Finding>,
    /// Fabrics that are left out, each with what is wrong in one of its rows.
    pub failures: Vec<ReadError>,
}

/// One number of the table, SI, with all that is said of it.
#[derive(Clone, Debug)]
struct Datum {
    fabric: Option<String>,
    parameter: Parameter,
    direction: Option<Direction>,
    /// Number of the specimen, where it has one.
    index: Option<usize>,
    /// How it sums up others, and the words that say so.
    statistic: Option<(Statistic, bool, String)>,
    /// Whether the row, and not the column, sums up others.
    by_row: bool,
    /// The direction of the row, also where the parameter has none.
    row_direction: Option<Direction>,
    mean: f64,
    sd: Option<f64>,
    n: usize,
    status: ValueStatus,
    line: usize,
    column: usize,
    /// Index of its cell.
    cell: usize,
    /// How its deviation stands behind it, if it does.
    own: Option<Own>,
}

/// How a deviation stands behind a number in one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Own {
    /// `0.61 (0.03)`.
    Bracket,
    /// `0.61 ± 0.03`.
    Sign,
}

/// Reads a table. In one of several fabrics a bad row leaves out its own fabric only.
///
/// # Errors
/// `R004`, `R008`, `R009`, `R010`, `R017`, `R018`.
pub(super) fn read(
    header: &Header,
    region: &Region<'_>,
    context: &Context<'_>,
    log: &mut Vec<String>,
) -> Result<Contents, ReadError> {
    let mut layout = Layout::of(region, context)?;
    let sample = header.known.get(&HeaderKey::Sample).map(|entry| entry.text.as_str());
    layout.leave_out_false_names(region, sample.is_some(), context);
    layout.count_columns(region, sample.is_some(), context);
    layout.note_numbered_columns(sample.is_some());
    layout.name_sides(sample, context);
    layout.leave_out_masses();
    log.push(layout.described());
    let mut table = Table {
        header,
        context,
        layout,
        data: Vec::new(),
        fast: Vec::new(),
        ignored: Vec::new(),
        findings: Vec::new(),
        failures: BTreeMap::new(),
        derived: Vec::new(),
        several: false,
        section: region.section,
        directions: BTreeSet::new(),
        states: BTreeMap::new(),
        above: None,
        marked: None,
        bounds: None,
        signs: Vec::new(),
        unknown_statuses: Vec::new(),
        factors: BTreeSet::new(),
        odd_names: Vec::new(),
    };
    for text in std::mem::take(&mut table.layout.texts_of_directions) {
        table.note_more_than_direction((table.layout.line, 0), &text);
    }
    if let Some(title) = region.title {
        table.note_title(title);
    }
    table.direction_of_the_corner();
    let rows = table.facts(region)?;
    let names: BTreeSet<&Option<String>> = rows.iter().map(|(_, facts)| &facts.fabric).collect();
    table.several = names.len() > 1 || table.layout.names_fabrics();
    let rows = table.without_shifted(rows)?;
    for (row, facts) in &rows {
        let read = table.values_of(row, facts);
        // An error in the heading is every row's.
        read.or_else(|e| {
            if e.place.line == row.line { table.leave_out(facts.fabric.clone(), e) } else { Err(e) }
        })?;
    }
    table.hold_values(region)?;
    table.leave_out_other_spreads();
    table.refuse_negative_deviations()?;
    table.note_cells();
    table.direction_of_the_header()?;
    table.direction_of_the_sheet()?;
    table.direction_of_the_caption();
    let unused = table.layout.unused(region, context);
    table.ignored.extend(unused);
    table.note_strangers();
    table.directions_of_numbers();
    table.note_without_direction();
    table.finish()
}

struct Table<'t, 'a> {
    header: &'t Header,
    context: &'a Context<'a>,
    layout: Layout,
    data: Vec<Datum>,
    fast: Vec<FastCell>,
    /// Texts that name no KES parameter.
    ignored: Vec<String>,
    findings: Vec<Finding>,
    /// Fabrics that are left out.
    failures: BTreeMap<String, ReadError>,
    /// What is said of values that were calculated, with their fabrics.
    derived: Vec<(Option<String>, Finding)>,
    /// Whether the rows name more than one fabric.
    several: bool,
    /// The direction that a title of a section states.
    section: Option<Direction>,
    /// Texts of directions that were met.
    directions: BTreeSet<String>,
    /// What each line says in columns of unknown meaning, by the index of the column.
    states: BTreeMap<usize, BTreeMap<usize, String>>,
    /// The fabric of the row above: a name often stands in the first of its rows only.
    above: Option<String>,
    /// The first of the cells with marks behind their numbers, and their texts.
    marked: noted::Cells,
    /// The same of cells that bound a value.
    bounds: noted::Cells,
    /// Signs in the place of values.
    signs: Vec<noted::Sign>,
    /// Words for statuses that are not known, with their lines.
    unknown_statuses: Vec<LeftOutLine>,
    /// Columns of factors that were told.
    factors: BTreeSet<usize>,
    /// Names of fabrics that are those of statistics, each with its line.
    odd_names: Vec<(usize, String)>,
}

impl<'t> Table<'t, '_> {
    /// Leaves out the fabric of a bad row, for the first thing that is wrong with it; the error of a table that is
    /// all of one fabric is that of the table.
    fn leave_out(&mut self, fabric: Option<String>, error: ReadError) -> Result<(), ReadError> {
        match fabric.filter(|_| self.several) {
            Some(name) => {
                let mut error = error;
                error.about.fabric = Some(name.clone());
                self.failures.entry(name).or_insert(error);
                Ok(())
            }
            None => Err(error),
        }
    }

    fn is_left_out(&self, fabric: &Option<String>) -> bool {
        fabric.as_ref().is_some_and(|name| self.failures.contains_key(name))
    }

    /// The rows of values with what each says; titles of sections hold for those below them.
    fn facts<'r>(&mut self, region: &Region<'r>) -> Result<Vec<(&'r Row<'r>, RowFacts)>, ReadError> {
        let mut out = Vec::new();
        let titles = self.titles(region);
        let (mut group, mut specimen, mut sums_up) = (None, None, false);
        // Directions within each fabric end with it; those over several fabrics do not.
        let mut within = None;
        for row in &region.rows {
            let is_remark = row.get(0).is_some_and(|t| t.starts_with('#')) && row.filled().count() == 1;
            if is_remark {
                continue;
            }
            if let Some(direction) = shape::section(row, self.context) {
                (self.section, sums_up) = (Some(direction), false);
                self.note_title(row);
                continue;
            }
            if let Some(title) = titles.get(&row.line) {
                match title {
                    Title::Fabric(name) => {
                        sums_up = false;
                        self.above = Some(name.clone());
                        self.end_section(&mut within);
                    }
                    Title::Group(name) => {
                        (group, sums_up) = (Some(name), false);
                        // Rows of directions below it are of the group itself.
                        self.above = None;
                        self.end_section(&mut within);
                    }
                    Title::Specimen(number) => specimen = Some(*number),
                    Title::NoDirection => (self.section, sums_up) = (None, false),
                    Title::Summary(text) => {
                        sums_up = true;
                        self.layout.left_out_rows.insert(row.line, text.clone());
                    }
                }
                continue;
            }
            if sums_up {
                continue;
            }
            self.note_row_in_one_cell(row);
            if self.names_a_test(row) && group.is_some() {
                continue;
            }
            let facts = self.within_heads(row, region).and_then(|()| self.row_facts(row));
            match facts {
                Ok(mut facts) => {
                    facts.facets.index = facts.facets.index.or(specimen);
                    facts.group = group.cloned();
                    let named = facts.fabric.take().map(|name| facts.in_group(name));
                    facts.fabric = named.or_else(|| group.cloned());
                    out.push((*row, facts));
                }
                Err(error) => {
                    let fabric = self.above.clone();
                    self.leave_out(fabric, error)?;
                }
            }
        }
        self.fill_merged_cells(&mut out);
        self.fill_states(out.iter().map(|(row, _)| row.line));
        self.numbers_that_do_not_count(&mut out);
        self.directions_in_names(&mut out);
        self.sort_out_summaries(&mut out);
        Ok(out)
    }

    /// `Bending` alone, over its parameters or over rows of one of several groups.
    fn names_a_test(&self, row: &Row<'_>) -> bool {
        let mut filled = row.filled();
        let text = filled.next().filter(|_| filled.next().is_none()).map(|(_, cell)| &cell.text);
        text.is_some_and(|text| self.context.vocabulary.test_exactly(text).is_some())
    }

    /// A number beyond the last heading is a part of another, where the delimiter is a decimal mark as well.
    fn within_heads(&self, row: &Row<'_>, region: &Region<'_>) -> Result<(), ReadError> {
        let named = region.heads.iter().filter_map(|h| h.filled().last()).map(|(i, _)| i + 1).max();
        let Some(named) = named.filter(|_| !region.down) else { return Ok(()) };
        let beyond = row.filled().find(|(i, c)| *i >= named && shape::is_value(&c.text, self.context));
        let Some((index, _)) = beyond else { return Ok(()) };
        let found = format!("the row has {} cells under {named} headings", row.filled().count());
        Err(self.context.error(row.line, row.column(index), ReadProblem::RaggedRow { found }))
    }

    /// The values of a row.
    fn values_of(&mut self, row: &Row<'_>, facts: &RowFacts) -> Result<(), ReadError> {
        if self.layout.down && !facts.facets.names_value() {
            let any = self.layout.values.iter().any(|c| row.get(c.index).is_some());
            if any && !facts.label.is_empty() {
                self.ignored.push(facts.label.clone());
            } else if any && row.filled().any(|(_, c)| shape::is_value(&c.text, self.context)) {
                self.ignored.push(format!("line {} without a name", row.line));
            }
            return Ok(());
        }
        let columns = self.layout.values.clone();
        let mut deviations = Vec::new();
        let first = self.data.len();
        for column in &columns {
            let Some(cell) = row.get(column.index) else { continue };
            let all = column.facets.or(&facts.facets);
            // A deviation in per cent is no value of the parameter, and its unit is its own.
            let own_unit = !all.sd && matches!(all.statistic, Some(Statistic::Spread | Statistic::Other));
            let of_row = facts.facets.statistic.is_some();
            if own_unit && is_significance(cell) {
                self.summary_only(facts, column, of_row, row.line);
                continue;
            }
            if self.is_not_measured(row, column.index, cell) || self.states_no_value(row, column.index, cell)
            {
                continue;
            }
            if !own_unit {
                let units = [&column.facets, &facts.facets].map(|f| f.unit.as_deref());
                self.one_unit(row, column.index, units[0], units[1])?;
            }
            let unit_place = self.unit_place(row, column, facts);
            let fabric = match &column.fabric {
                Some(name) => Some(facts.in_group(name.clone())),
                None => column.fabric_of(facts.fabric.as_deref()),
            };
            let fabric = fabric.filter(|_| !facts.summary_of_fabrics);
            if let Some(fast) = all.fast.filter(|_| all.parameter.is_none()) {
                let reading = self.reading(row, column.index, cell)?;
                let (text, place) =
                    self.stated_unit((row, column.index), all.unit.as_deref(), unit_place, &reading)?;
                let si = reading.mean * self.fast_unit(fast, text, place)?.factor;
                let (line, column) = (row.line, row.column(column.index));
                self.fast.push(FastCell {
                    fabric,
                    value: fast,
                    direction: all.direction,
                    index: all.index,
                    si,
                    line,
                    column,
                });
                continue;
            }
            let Some(parameter) = all.parameter else { continue };
            let summary = all
                .statistic
                .map(|s| (s, all.sd, if of_row { facts.label.clone() } else { column.name.clone() }));
            if own_unit {
                self.summary_only(facts, column, of_row, row.line);
                continue;
            }
            let mut reading = self.reading(row, column.index, cell)?;
            reading.settle_percent(parameter, all.unit.as_deref());
            let (text, place) =
                self.stated_unit((row, column.index), all.unit.as_deref(), unit_place, &reading)?;
            let unit = self.unit(parameter, text, place)?;
            let direction = all.direction.filter(|_| parameter.is_directional());
            let datum = Datum {
                fabric,
                parameter,
                direction,
                index: all.index,
                statistic: summary,
                by_row: of_row,
                row_direction: facts.facets.direction,
                mean: reading.mean * unit.factor,
                sd: reading.sd.map(|s| s * unit.factor),
                n: reading.repeats.or(all.repeats).or(facts.n).or(self.header.repeats).unwrap_or(1),
                status: all.status,
                line: row.line,
                column: row.column(column.index),
                cell: column.index,
                own: reading.sd.map(|_| match cell.contains(['±', '+']) {
                    true => Own::Sign,
                    false => Own::Bracket,
                }),
            };
            if all.sd && !of_row && !self.layout.down {
                deviations.push(datum);
            } else {
                self.data.push(datum);
            }
        }
        self.attach(first, deviations);
        self.attach_own(row, facts, first)
    }

    /// A column or row of coefficients of variation, extremes and the like.
    fn summary_only(&mut self, facts: &RowFacts, column: &Column, of_row: bool, line: usize) {
        let label = if of_row { &facts.label } else { &column.name };
        if of_row {
            self.layout.left_out_rows.insert(line, label.clone());
        } else {
            self.ignored.push(label.clone());
        }
    }
}
