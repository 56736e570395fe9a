//! Result tables: the KES symbols as columns (wide) or as rows (long).
//!
//! `fabric,direction,B (gf·cm²/cm),2HB (gf·cm/cm)`, `id,B_warp_uN_m,EMT_weft_percent_inferred`,
//! `parameter,unit,warp,weft` and `fabric,parameter,direction,mean,sd,n,unit` are all read.

mod fast_cells;

use std::collections::{BTreeMap, BTreeSet};

use fast_cells::FastCell;

use super::curves::finite;
use super::dialect::{Statistic, TableColumn};
use super::error::{Problem, ReadError};
use super::fast;
use super::heading::{self, Column, ParameterColumn, columns, parameter_column};
use super::layout::{Context, Header};
use super::raw::Row;
use super::sniff::{Number, folded, number};
use super::statistic::{self, RowLabel, summing_up};
use super::words::{known_unit, normalised, unit};
use super::{Direction, Parameter, ResultValue};
use crate::finding::{Finding, Place, ReadFact};
use crate::quantity::{Estimate, Unit};

/// Values with the fabric that each belongs to.
pub(super) type Values = Vec<(Option<String>, ResultValue)>;

/// What a table gives.
#[derive(Debug)]
pub(super) struct Contents {
    pub values: Values,
    pub findings: Vec<Finding>,
    /// Fabrics that are left out, each with what is wrong in one of its rows.
    pub failures: Vec<ReadError>,
}

/// Reads the rows of a table. In a table of several fabrics a bad row leaves out its own fabric only.
///
/// # Errors
/// `R004`, `R008`, `R009`, `R010`, `R017`, `R018`.
pub(super) fn read(
    header: &Header,
    heading: &Row<'_>,
    rows: &[&Row<'_>],
    context: &Context<'_>,
    log: &mut Vec<String>,
) -> Result<Contents, ReadError> {
    let columns = columns(heading, context.vocabulary);
    let mut table = Table {
        header,
        heading,
        columns,
        context,
        values: Vec::new(),
        fast: Vec::new(),
        ignored: Vec::new(),
        findings: Vec::new(),
        failures: BTreeMap::new(),
        derived: Vec::new(),
        several: false,
    };
    let long = table.meta(TableColumn::Parameter).is_some();
    log.push(table.told(long));
    let rows = if long { rows } else { table.unit_row(rows) };
    let rows = &table.specimens(rows, long)[..];
    let names: BTreeSet<Option<String>> = rows.iter().map(|row| table.fabric(row)).collect();
    table.several = names.len() > 1;
    for row in rows {
        let read = if long { table.long_row(row) } else { table.wide_row(row) };
        // An error in the heading is every row's.
        read.or_else(
            |e| if e.place.line == row.line { table.leave_out(table.fabric(row), e) } else { Err(e) },
        )?;
    }
    let unused = table.unused(rows);
    // In a table with a row for each parameter other numbers are expected, but not those of a direction.
    let of_direction = |heading: &String| !long || heading::sums_up(heading, context.vocabulary);
    table.ignored.extend(unused.into_iter().filter(of_direction));
    table.derive_from_fast();
    table.finish()
}

struct Table<'t, 'a> {
    header: &'t Header,
    heading: &'t Row<'t>,
    columns: Vec<Option<Column>>,
    context: &'a Context<'a>,
    values: Values,
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
}

impl Table<'_, '_> {
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

    /// The form of the table and what its columns hold, for people.
    fn told(&self, long: bool) -> String {
        let form = if long { "one row a parameter" } else { "one column a parameter" };
        let named = self.columns.iter().zip(&self.heading.cells).filter_map(|(column, cell)| {
            let meaning = match column.as_ref()? {
                Column::Meta(meta) => format!("{meta:?}").to_lowercase(),
                Column::Parameter(p) => match p.direction {
                    Some(direction) => format!("{} {direction}", p.parameter),
                    None => p.parameter.to_string(),
                },
                Column::Of(direction) => format!("values of {direction}"),
                Column::Fast(value, ..) => format!("FAST {}", value.symbol()),
            };
            Some(format!("{:?} is {meaning}", cell.text))
        });
        let named = named.collect::<Vec<_>>().join(", ");
        format!("result table with its headings in line {}, {form}: {named}", self.heading.line)
    }

    fn meta(&self, meta: TableColumn) -> Option<usize> {
        self.columns.iter().position(|c| *c == Some(Column::Meta(meta)))
    }

    fn text<'r>(&self, row: &'r Row<'_>, meta: TableColumn) -> Option<&'r str> {
        self.meta(meta).and_then(|i| row.get(i))
    }

    /// Takes a row of units below a heading that has none.
    fn unit_row<'r, 's>(&mut self, rows: &'r [&'s Row<'s>]) -> &'r [&'s Row<'s>] {
        let Some((first, rest)) = rows.split_first() else { return rows };
        let bare = |i: usize| first.get(i).map(|t| folded(t).trim_matches(['(', ')', '[', ']']).to_string());
        let is_unit = |t: &str| t == "-" || (!matches!(number(t, '.'), Number::Value(_)) && unit(t).is_ok());
        let parameters = |c: &Option<Column>| matches!(c, Some(Column::Parameter(_) | Column::Fast(..)));
        let indices = || self.columns.iter().enumerate().filter(|(_, c)| parameters(c)).map(|(i, _)| i);
        let any = indices().any(|i| bare(i).is_some_and(|t| is_unit(&t) && t != "-"));
        if !any || !indices().all(|i| bare(i).is_none_or(|t| is_unit(&t))) {
            return rows;
        }
        for (i, column) in self.columns.iter_mut().enumerate() {
            if let Some(Column::Parameter(ParameterColumn { unit, .. }) | Column::Fast(_, _, unit)) = column {
                *unit = unit.take().or_else(|| bare(i));
            }
        }
        rest
    }

    /// The rows without those of means, deviations and extremes of others, which are told.
    fn specimens<'r>(&mut self, rows: &[&'r Row<'r>], long: bool) -> Vec<&'r Row<'r>> {
        let label = |row: &&'r Row<'r>| RowLabel {
            fabric: [self.text(row, TableColumn::Id), self.text(row, TableColumn::Fabric)],
            specimen: self.text(row, TableColumn::Specimen),
            parameter: self.text(row, TableColumn::Parameter).filter(|_| long),
        };
        let labels: Vec<RowLabel<'_>> = rows.iter().map(label).collect();
        let words = summing_up(&labels, self.context.vocabulary);
        let left_out: Vec<(usize, &str)> =
            rows.iter().zip(&words).filter_map(|(row, word)| Some((row.line, (*word)?))).collect();
        let finding = statistic::finding("rows", &left_out, self.context.path);
        self.findings.extend(finding);
        rows.iter().zip(words).filter(|(_, word)| word.is_none()).map(|(row, _)| *row).collect()
    }

    fn fabric(&self, row: &Row<'_>) -> Option<String> {
        let of_row = self.text(row, TableColumn::Id).or_else(|| self.text(row, TableColumn::Fabric));
        let of_header = self.header.known.get(&super::dialect::Key::Sample).map(|e| e.text.as_str());
        of_row.or(of_header).map(|t| folded(t).into_owned())
    }

    fn direction(&self, row: &Row<'_>) -> Result<Option<Direction>, ReadError> {
        let Some(text) = self.text(row, TableColumn::Direction) else { return Ok(None) };
        let of_both = self.context.vocabulary.statistic(text) == Some(Statistic::Mean);
        if of_both || matches!(normalised(text).as_str(), "" | "all" | "none") {
            return Ok(None);
        }
        self.context.vocabulary.direction(text).map(Some).ok_or_else(|| {
            let column = self.meta(TableColumn::Direction).map_or(0, |i| row.column(i));
            let found = format!("{text:?} is not a direction (warp, weft, bias or mean)");
            self.context.error(row.line, column, Problem::BadTable { found })
        })
    }

    fn repeats(&self, row: &Row<'_>) -> Result<usize, ReadError> {
        let Some(index) = self.meta(TableColumn::N) else { return Ok(1) };
        let Some(cell) = row.get(index) else { return Ok(1) };
        let n = finite(row, index, cell, self.context)?;
        if n >= 1.0 && n.fract() == 0.0 && n < 1e6 {
            // The range was just checked.
            return Ok(n as usize);
        }
        let found = format!("{cell:?} is not a number of repeats");
        Err(self.context.error(row.line, row.column(index), Problem::BadTable { found }))
    }

    /// Heading texts of columns with numbers that name no parameter; words describe and need no remark.
    fn unused(&self, rows: &[&Row<'_>]) -> Vec<String> {
        let is_number = |t: &str| matches!(number(t, self.context.decimal), Number::Value(_));
        let numeric = |i: usize| rows.iter().any(|r| r.get(i).is_some_and(is_number));
        let unknown = |i: usize| self.columns.get(i).is_none_or(Option::is_none);
        let unused = self.heading.filled().filter(|(i, _)| unknown(*i) && numeric(*i));
        unused.map(|(_, c)| c.text.to_string()).collect()
    }

    fn wide_row(&mut self, row: &Row<'_>) -> Result<(), ReadError> {
        let (fabric, direction, n) = (self.fabric(row), self.direction(row)?, self.repeats(row)?);
        let columns = self.columns.clone();
        let mut spreads = Vec::new();
        for (i, column) in columns.iter().enumerate() {
            let Some(cell) = row.get(i).filter(|c| !is_gap(c)) else { continue };
            let heading = (self.heading.line, self.heading.column(i));
            match column {
                Some(Column::Parameter(p)) => {
                    let unit = self.unit(p.parameter, p.unit.as_deref(), heading)?;
                    let value = finite(row, i, cell, self.context)? * unit.factor;
                    let of = p.direction.or(direction).filter(|_| p.parameter.is_directional());
                    if p.sd {
                        spreads.push((p.parameter, of, value));
                    } else {
                        self.push(fabric.clone(), p, of, value, n, (row.line, row.column(i)));
                    }
                }
                Some(Column::Fast(value, of, unit)) => {
                    let factor = self.fast_unit(*value, unit.as_deref(), heading)?.factor;
                    let si = finite(row, i, cell, self.context)? * factor;
                    let (fabric, direction) = (fabric.clone(), of.or(direction));
                    self.fast.push(FastCell {
                        fabric,
                        value: *value,
                        direction,
                        si,
                        line: row.line,
                        column: row.column(i),
                    });
                }
                _ => {}
            }
        }
        for (parameter, of, sd) in spreads {
            self.spread(&fabric, parameter, of, sd);
        }
        Ok(())
    }

    fn long_row(&mut self, row: &Row<'_>) -> Result<(), ReadError> {
        let Some(index) = self.meta(TableColumn::Parameter) else { return Ok(()) };
        let Some(name) = row.get(index) else { return Ok(()) };
        let Some(mut p) = parameter_column(name, self.context.vocabulary) else {
            return match fast::heading(name) {
                Some(heading) => self.long_fast(row, heading),
                None => {
                    self.ignored.push(name.to_string());
                    Ok(())
                }
            };
        };
        p.inferred |= self.text(row, TableColumn::Status).is_some_and(|t| normalised(t) == "inferred");
        let (fabric, direction, n) = (self.fabric(row), self.direction(row)?, self.repeats(row)?);
        let unit_at = self.meta(TableColumn::Unit).unwrap_or(index);
        let text = self.text(row, TableColumn::Unit).or(p.unit.as_deref());
        let unit = self.unit(p.parameter, text, (row.line, row.column(unit_at)))?;
        for (i, column) in self.columns.clone().iter().enumerate() {
            let of = match column {
                Some(Column::Meta(TableColumn::Value)) => p.direction.or(direction),
                Some(Column::Of(d)) => Some(*d),
                _ => continue,
            };
            let Some(cell) = row.get(i).filter(|c| !is_gap(c)) else { continue };
            let value = finite(row, i, cell, self.context)? * unit.factor;
            let of = of.filter(|_| p.parameter.is_directional());
            self.push(fabric.clone(), &p, of, value, n, (row.line, row.column(i)));
            if let Some(at) = self.meta(TableColumn::Sd)
                && let Some(cell) = row.get(at)
            {
                let sd = finite(row, at, cell, self.context)? * unit.factor;
                self.spread(&fabric, p.parameter, of, sd);
            }
        }
        Ok(())
    }

    /// The unit of a value; dimensionless parameters need none.
    fn unit(
        &self,
        p: Parameter,
        text: Option<&str>,
        (line, column): (usize, usize),
    ) -> Result<Unit, ReadError> {
        let error = |problem| self.context.error(line, column, problem);
        let text = match text {
            Some(text) if text != "-" || p.kes_unit() == "1" => text,
            _ if p.kes_unit() == "1" || self.context.kes_units => p.kes_unit(),
            _ => {
                let found = p.symbol().to_string();
                return Err(error(Problem::UnitMissing { found, expected: p.kes_unit() }));
            }
        };
        let unit = known_unit(text).map_err(error)?;
        let expected = known_unit(p.si_unit()).map_err(error)?;
        // G in gf/cm could be per degree or per radian, a factor 57: only SI is clear without deg.
        let per_angle = p == Parameter::G
            && text.contains("gf")
            && !(text.contains("deg") || text.contains("rad") || text.contains('°'));
        if unit.dimension != expected.dimension || per_angle {
            let of = p.symbol().to_string();
            let expected = p.kes_unit();
            return Err(error(Problem::UnitWrong { found: text.to_string(), of, expected }));
        }
        Ok(unit)
    }

    fn push(
        &mut self,
        fabric: Option<String>,
        p: &ParameterColumn,
        direction: Option<Direction>,
        mean: f64,
        n: usize,
        (line, column): (usize, usize),
    ) {
        let place = Place::at(self.context.path, line, column);
        let value = ResultValue {
            parameter: p.parameter,
            direction,
            mean,
            sd: None,
            n,
            values: Vec::new(),
            lines: Vec::new(),
            inferred: p.inferred,
            place,
        };
        self.values.push((fabric, value));
    }

    /// Adds a standard deviation to the value that was read last for the same thing.
    fn spread(
        &mut self,
        fabric: &Option<String>,
        parameter: Parameter,
        direction: Option<Direction>,
        sd: f64,
    ) {
        let same = |(f, v): &&mut (Option<String>, ResultValue)| {
            f == fabric && v.parameter == parameter && v.direction == direction
        };
        if let Some((_, value)) = self.values.iter_mut().rev().find(same) {
            value.sd = Some(sd);
        }
    }

    /// Averages repeated rows, refuses contradictions, and says what was left out.
    fn finish(mut self) -> Result<Contents, ReadError> {
        let repeats = self.meta(TableColumn::Specimen).is_some();
        let mut out: Vec<(Option<String>, ResultValue, Vec<f64>)> = Vec::new();
        let mut known: BTreeMap<_, usize> = BTreeMap::new();
        for (fabric, value) in std::mem::take(&mut self.values) {
            let key = (fabric.clone(), value.parameter, value.direction);
            let Some(&at) = known.get(&key) else {
                known.insert(key, out.len());
                let (mean, line) = (value.mean, value.place.line);
                out.push((fabric, ResultValue { lines: vec![line], ..value }, vec![mean]));
                continue;
            };
            let means = &mut out[at].2;
            if repeats {
                means.push(value.mean);
                out[at].1.lines.push(value.place.line);
            } else if value.parameter.is_directional() {
                let found =
                    format!("{} is given twice (first in line {})", value.parameter, out[at].1.place.line);
                self.leave_out(fabric, ReadError::new(value.place, Problem::BadTable { found }))?;
            } else if !means.contains(&value.mean) {
                // A thickness in each direction's row: the fabric has one.
                means.push(value.mean);
            }
        }
        out.retain(|(fabric, ..)| !self.is_left_out(fabric));
        if out.is_empty() && self.failures.is_empty() {
            let found = "the table has no value of a KES parameter".to_string();
            return Err(self.context.error(self.heading.line, 0, Problem::BadTable { found }));
        }
        let averaged = |(fabric, mut value, means): (Option<String>, ResultValue, Vec<f64>)| {
            if let Some(e) = Estimate::of(&means).filter(|e| e.n > 1) {
                (value.mean, value.sd, value.n, value.values) = (e.mean, e.sd, e.n, e.values);
            }
            (fabric, value)
        };
        for (fabric, finding) in std::mem::take(&mut self.derived) {
            if !self.is_left_out(&fabric) {
                self.findings.push(finding);
            }
        }
        self.ignored.dedup();
        if !self.ignored.is_empty() {
            let fact = ReadFact::Unusable { names: self.ignored, reason: None };
            let place = Place::at(self.context.path, self.heading.line, 0);
            self.findings.push(Finding::new(fact).at(place));
        }
        let values = out.into_iter().map(averaged).collect();
        let failures = self.failures.into_values().collect();
        Ok(Contents { values, findings: self.findings, failures })
    }
}

/// A cell that stands for "not measured".
fn is_gap(cell: &str) -> bool {
    matches!(cell, "-" | "–" | "—")
}
