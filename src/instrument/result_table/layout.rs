//! The columns of a table: which hold values, which label them, and what their heads say together.

use std::collections::{BTreeMap, BTreeSet};

use super::heads::{Heads, is_units};
use crate::instrument::Direction;
use crate::instrument::context::Context;
use crate::instrument::dialect::{Statistic, TableColumn};
use crate::instrument::error::{ReadError, ReadProblem};
use crate::instrument::facets::Facets;
use crate::instrument::raw::Row;
use crate::instrument::shape::{self, Region};
use crate::instrument::unit_text::unit;

/// Characters of the longest name of a fabric over columns; what is longer is a title.
pub(super) const NAME: usize = 40;

/// A column of values.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub index: usize,
    pub facets: Facets,
    /// The fabric that its head names.
    pub fabric: Option<String>,
    /// The state of the fabrics of the rows that stands over it, `before washing`: each state is a fabric of its own.
    pub state: Option<String>,
    /// The texts of its heads.
    pub name: String,
    /// Line and column of the head that names it or its unit.
    pub place: (usize, usize),
}

impl Column {
    /// The fabric of a value in the row of a fabric.
    pub fn fabric_of(&self, row: Option<&str>) -> Option<String> {
        match (&self.fabric, &self.state, row) {
            (Some(fabric), ..) => Some(fabric.clone()),
            (None, Some(state), Some(row)) => Some(format!("{row} {state}")),
            (None, state, row) => state.clone().or(row.map(str::to_string)),
        }
    }
}

/// A column of words about rows.
#[derive(Clone, Debug)]
pub(super) struct LabelColumn {
    pub index: usize,
    pub meta: Option<TableColumn>,
    /// The text of its heads.
    pub name: String,
}

/// The columns of a table.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub down: bool,
    pub labels: Vec<LabelColumn>,
    pub values: Vec<Column>,
    /// Standard deviations of the only column of values.
    pub sd_column: Option<usize>,
    /// The unit that their head states.
    pub sd_unit: Option<String>,
    /// Line of the lowest heads.
    pub line: usize,
    /// Rows of statistics that have no value of the parameter, with their labels.
    pub left_out_rows: BTreeMap<usize, String>,
    /// Numbers behind symbols, in heads or in labels of rows.
    numbers: BTreeSet<usize>,
    /// Columns of directions that hold angles to the warp.
    pub angles: BTreeSet<usize>,
    /// Heads that were read as directions although they say more.
    pub texts_of_directions: Vec<String>,
    /// Columns of numbers whose heads are not understood.
    pub strangers: Vec<String>,
    /// Those of them that may tell rows apart, where rows are parameters.
    pub strange_labels: Vec<LabelColumn>,
    /// The head over numbers of specimens, where it is not understood.
    pub counted_by: Option<String>,
    /// The head over numbers of specimens or samples, which it does not say.
    pub numbered_by: Option<String>,
    /// Heads and names whose letters are directions.
    pub letters: Vec<String>,
    /// What each column holds, for people.
    descriptions: Vec<String>,
}

impl Layout {
    /// # Errors
    /// R018 where the heads of a column state two units.
    pub fn of(region: &Region<'_>, context: &Context<'_>) -> Result<Self, ReadError> {
        let width = region.heads.iter().chain(&region.rows).map(|r| r.cells.len()).max().unwrap_or(0);
        let heads = Heads::of(region, context);
        let mut layout = Self {
            down: region.down,
            labels: Vec::new(),
            values: Vec::new(),
            sd_column: None,
            sd_unit: None,
            line: region.heads.last().or(region.rows.first()).map_or(0, |r| r.line),
            left_out_rows: BTreeMap::new(),
            numbers: BTreeSet::new(),
            angles: BTreeSet::new(),
            texts_of_directions: Vec::new(),
            strangers: Vec::new(),
            strange_labels: Vec::new(),
            counted_by: None,
            numbered_by: None,
            letters: heads.letters.clone(),
            descriptions: Vec::new(),
        };
        let labels: Vec<(&Row<'_>, usize)> = region
            .rows
            .iter()
            .filter(|_| region.down)
            .filter_map(|r| heads.label_of(r, context).map(|(i, _)| (*r, i)))
            .collect();
        for index in 0..width {
            layout.add(index, &heads, region, &labels, context);
        }
        layout.angles = layout.columns_of_angles(region);
        layout.deviations_beside_values(region, context);
        layout.settle(&heads, region, context);
        let indices = layout.values.iter().map(|c| c.index).chain(layout.sd_column);
        match indices.into_iter().find_map(|i| heads.two_units(i)) {
            Some((found, (line, column))) => {
                Err(context.error(line, column, ReadProblem::BadTable { found }))
            }
            None => Ok(layout),
        }
    }

    fn add(
        &mut self,
        index: usize,
        heads: &Heads,
        region: &Region<'_>,
        labelled: &[(&Row<'_>, usize)],
        context: &Context<'_>,
    ) {
        let (facets, name, place) = heads.column(index, region);
        let meta = match facets.meta {
            Some(TableColumn::Number) => {
                self.numbered_by = Some(name.clone());
                Some(TableColumn::Specimen)
            }
            meta => meta,
        };
        let has_values =
            region.rows.iter().any(|r| r.get(index).is_some_and(|c| shape::is_value(c, context)));
        let column =
            |facets: Facets, fabric| Column { index, facets, fabric, state: None, name: name.clone(), place };
        if !self.down {
            if facets.names_value() {
                self.descriptions.push(described(&name, &facets));
                self.values.push(column(facets, None));
            } else if meta.is_some() || has_values || region.rows.iter().any(|r| r.get(index).is_some()) {
                self.descriptions
                    .extend(meta.map(|m| format!("{name:?} is {}", format!("{m:?}").to_lowercase())));
                self.labels.push(LabelColumn { index, meta, name });
            }
            return;
        }
        let is_value = labelled.iter().any(|(_, at)| index > *at) || !self.labels.is_empty();
        let numeric = labelled.iter().any(|(r, _)| r.get(index).is_some_and(|c| shape::is_value(c, context)));
        match meta {
            Some(TableColumn::Sd) if numeric => {
                self.sd_column = Some(index);
                self.values.push(column(
                    Facets { meta: None, sd: true, statistic: Some(Statistic::Spread), ..facets },
                    None,
                ));
            }
            // The number of repeats is no value; a column of the second specimen may be headed by a number.
            Some(TableColumn::Value) if numeric => {
                self.values.push(column(Facets { meta: None, ..facets }, None));
            }
            Some(m)
                if !numeric
                    || matches!(
                        m,
                        TableColumn::N
                            | TableColumn::Unit
                            | TableColumn::Factor
                            | TableColumn::Specimen
                            | TableColumn::Id
                            | TableColumn::Fabric
                    ) =>
            {
                self.labels.push(LabelColumn { index, meta: Some(m), name: name.clone() });
            }
            _ if numeric && is_value => {
                // A name may look like a symbol: `G-1`, `T 40`. What labels the rows decides.
                let is_name = facets.unknown || facets.parameter.is_some() || facets.fast.is_some();
                let fabric = (is_name && !name.is_empty()).then(|| name.clone());
                let facets = if is_name { Facets::default() } else { facets };
                self.values.push(column(facets, fabric));
            }
            _ => self.labels.push(LabelColumn { index, meta, name: name.clone() }),
        }
        if let Some(m) = meta {
            self.descriptions.push(format!("{name:?} is {}", format!("{m:?}").to_lowercase()));
        } else if let Some(c) = self.values.last().filter(|c| c.index == index) {
            self.descriptions.push(described(&name, &c.facets));
        }
    }

    /// What can be said only when all columns are known.
    fn settle(&mut self, heads: &Heads, region: &Region<'_>, context: &Context<'_>) {
        if self.down {
            self.leave_out_beside_values(context);
            // Numbered columns are specimens: an unknown word among them is no fabric.
            let numbered = self.values.iter().filter(|c| c.facets.index.is_some()).count();
            for c in self.values.iter_mut().filter(|c| numbered >= 2 && c.fabric.is_some()) {
                c.fabric = None;
                c.facets.statistic = Some(Statistic::Other);
            }
            // A number among names is a name as well: `No. 12`.
            let named = self.values.iter().filter(|c| c.fabric.is_some()).count();
            for c in self.values.iter_mut().filter(|c| numbered == 1 && named > 0 && c.facets.index.is_some())
            {
                c.fabric = Some(c.name.clone());
                c.facets.index = None;
            }
            self.name_single_letters();
            let singles = self.values.iter().filter(|c| c.facets.statistic.is_none()).count();
            let means = self.values.iter().filter(|c| c.facets.statistic == Some(Statistic::Mean)).count();
            let deviations = self.values.iter().filter(|c| c.facets.sd).count();
            // One deviation beside one value is that of the value; among specimens it sums them up.
            let own = deviations == 1 && singles + means == 1;
            if own {
                let deviation = self.values.iter().find(|c| c.facets.sd);
                self.sd_column = deviation.map(|c| c.index);
                self.sd_unit = deviation.and_then(|c| c.facets.unit.clone());
                self.values.retain(|c| !c.facets.sd);
            } else {
                self.sd_column = None;
            }
            let labels: Vec<Facets> =
                region.rows.iter().filter_map(|r| heads.label_of(r, context)).map(|(_, f)| f).collect();
            self.numbers = labels.iter().filter_map(|f| f.index).collect();
            self.directions_over_columns(context.vocabulary);
            self.directions_in_heads(context.vocabulary);
            self.names_below_directions(heads);
            self.fabrics_over_columns(heads);
            self.leave_out_strangers();
            return;
        }
        self.states_over_columns(heads);
        self.drop_numbers_that_do_not_count();
        self.numbers = self.values.iter().filter_map(|c| c.facets.index).collect();
        self.counters(region, context);
    }

    /// Names of fabrics below their directions, `A` and `B` below `Warp` and again below `Weft`: each has both.
    fn names_below_directions(&mut self, heads: &Heads) {
        let below: Vec<_> = self.values.iter().map(|c| heads.name_below(c.index)).collect();
        let mut of_name = BTreeMap::<&str, BTreeSet<Direction>>::new();
        for (name, direction) in below.iter().flatten() {
            of_name.entry(name).or_default().insert(*direction);
        }
        let columns: usize = of_name.values().map(BTreeSet::len).sum();
        let is_whole = columns == self.values.len() && below.iter().all(Option::is_some);
        if of_name.len() < 2 || !is_whole || of_name.values().any(|of| of.len() < 2) {
            return;
        }
        for (column, (name, direction)) in self.values.iter_mut().zip(below.into_iter().flatten()) {
            (column.fabric, column.facets.direction) = (Some(name), Some(direction));
        }
    }

    /// Names of fabrics over their directions: where every column has one above it, and there are several.
    fn fabrics_over_columns(&mut self, heads: &Heads) {
        let names: Vec<_> = self.values.iter().map(|c| heads.name_over(c.index)).collect();
        let distinct: BTreeSet<_> = names.iter().flatten().collect();
        let all = names.iter().all(Option::is_some) && self.values.iter().all(|c| c.fabric.is_none());
        if all && distinct.len() > 1 {
            for (column, name) in self.values.iter_mut().zip(&names) {
                column.fabric.clone_from(name);
            }
        }
    }

    /// `Control` and `Treated` over the same parameters: where every column has one above it, and is told from the others by it alone.
    fn states_over_columns(&mut self, heads: &Heads) {
        let states: Vec<_> = self.values.iter().map(|c| heads.name_over(c.index)).collect();
        let (mut bare, mut named) = (BTreeSet::new(), BTreeSet::new());
        for (column, state) in self.values.iter().zip(&states) {
            let Facets { parameter, fast, direction, statistic, sd, index, .. } = column.facets;
            let key = (parameter, fast.map(|f| f.symbol()), direction, statistic, sd, index);
            bare.insert(key);
            named.insert((state, key));
        }
        let all = states.iter().all(Option::is_some) && named.len() == states.len();
        if all && bare.len() < states.len() {
            for (column, state) in self.values.iter_mut().zip(states) {
                column.state = state;
            }
        }
    }

    /// `B`, `B1`, `B2` and `EMT`, `EMT50`: beside a column without a number, or with gaps between them, numbers do not count
    /// specimens. What they are nobody says; the columns are told as not used.
    fn drop_numbers_that_do_not_count(&mut self) {
        let key = |c: &Column| (c.facets.parameter, c.facets.direction, c.facets.fast.map(|f| f.symbol()));
        let mut groups: BTreeMap<_, BTreeSet<Option<usize>>> = BTreeMap::new();
        for c in self.values.iter().filter(|c| c.facets.statistic.is_none()) {
            groups.entry(key(c)).or_default().insert(c.facets.index);
        }
        self.values.retain(|c| {
            c.facets.index.is_none()
                || c.facets.statistic.is_some()
                || groups.get(&key(c)).is_none_or(numbers_count_specimens)
        });
    }

    pub fn names_fabrics(&self) -> bool {
        self.values.iter().filter(|c| c.fabric.is_some() || c.state.is_some()).count() > 1
    }

    pub fn numbers_of_symbols(&self) -> BTreeSet<usize> {
        self.numbers.clone()
    }

    pub fn meta(&self, meta: TableColumn) -> bool {
        self.labels.iter().any(|l| l.meta == Some(meta))
    }

    /// Heading texts of columns with numbers that name no parameter; words describe and need no remark.
    pub fn unused(&self, region: &Region<'_>, context: &Context<'_>) -> Vec<String> {
        let numeric =
            |i: usize| region.rows.iter().any(|r| r.get(i).is_some_and(|c| shape::is_value(c, context)));
        let Some(head) = region.heads.iter().rev().find(|h| !is_units(h)) else { return Vec::new() };
        let unknown = |i: usize| {
            !self.values.iter().any(|c| c.index == i)
                && !self
                    .labels
                    .iter()
                    .any(|l| l.index == i && l.meta.is_some_and(|meta| meta != TableColumn::Sd))
                && self.sd_column != Some(i)
        };
        let unused = head.filled().filter(|(i, _)| !self.down && unknown(*i) && numeric(*i));
        let width = region.rows.iter().map(|r| r.cells.len()).max().unwrap_or(0);
        let without = (0..width)
            .filter(|i| !self.down && unknown(*i) && numeric(*i))
            .filter(|i| !region.heads.iter().any(|h| !is_units(h) && h.get(*i).is_some()));
        let without = without.map(|i| format!("column {} without a heading", i + 1));
        unused.map(|(_, c)| c.text.to_string()).chain(without).collect()
    }

    /// The form of the table and what its columns hold, for people.
    pub fn described(&self) -> String {
        let form = if self.down { "one row a parameter" } else { "one column a parameter" };
        format!(
            "result table with its headings in line {}, {form}: {}",
            self.line,
            self.descriptions.join(", ")
        )
    }
}

fn described(name: &str, f: &Facets) -> String {
    let what = match (f.parameter, f.fast) {
        (Some(p), _) => p.to_string(),
        (None, Some(fast)) => format!("FAST {}", fast.symbol()),
        (None, None) => "values".to_string(),
    };
    let direction = match (f.direction, f.parameter) {
        (Some(d), Some(_)) => format!(" {d}"),
        (Some(d), None) => format!(" of {d}"),
        (None, _) => String::new(),
    };
    format!("{name:?} is {what}{direction}")
}

/// Whether two texts are units that are not the same.
pub(in crate::instrument) fn differ(a: &str, b: &str) -> bool {
    let (Ok(a), Ok(b)) = (unit(a), unit(b)) else { return false };
    a.dimension != b.dimension || (a.factor - b.factor).abs() > 1e-9 * a.factor.abs()
}

/// Of two units of one value.
pub(in crate::instrument) fn two_units(first: &str, second: &str) -> String {
    format!("the unit of these values is {first:?} and {second:?}: remove the one that does not hold")
}

/// Whether the numbers of columns or rows count specimens: they follow each other, and none is without one.
pub(super) fn numbers_count_specimens(indices: &BTreeSet<Option<usize>>) -> bool {
    let numbers: Vec<usize> = indices.iter().flatten().copied().collect();
    let run = numbers.windows(2).all(|pair| pair[1] == pair[0] + 1);
    !indices.contains(&None) && run && (numbers.len() > 1 || numbers == [1] || numbers == [2])
}
