//! Result tables: the KES symbols as columns (wide) or as rows (long).
//!
//! `fabric,direction,B (gf·cm²/cm),2HB (gf·cm/cm)`, `id,B_warp_uN_m,EMT_weft_percent_inferred`,
//! `parameter,unit,warp,weft` and `fabric,parameter,direction,mean,sd,n,unit` are all read.

use super::curves::finite;
use super::dialect::TableColumn;
use super::error::{Problem, ReadError};
use super::layout::{Context, Header};
use super::raw::Row;
use super::sniff::{Number, folded, number};
use super::words::{Vocabulary, known_unit, normalised, split_unit, unit};
use super::{Direction, Parameter, ResultValue};
use crate::finding::{Finding, Place};
use crate::quantity::{Estimate, Unit};

/// Values with the fabric that each belongs to.
pub(super) type Values = Vec<(Option<String>, ResultValue)>;

/// A column of a result table.
#[derive(Clone, Debug, PartialEq)]
enum Column {
    Meta(TableColumn),
    Parameter(ParameterColumn),
    /// Values of one direction (long form).
    Of(Direction),
}

/// A parameter in a heading: `B_warp_uN_m`, `EMT weft (%)`, `2HB sd`.
#[derive(Clone, Debug, PartialEq)]
struct ParameterColumn {
    parameter: Parameter,
    direction: Option<Direction>,
    unit: Option<String>,
    sd: bool,
    inferred: bool,
}

/// Whether a row is the heading of a result table.
pub(super) fn is_heading(row: &Row<'_>, vocabulary: Vocabulary<'_>) -> bool {
    // Header lines carry values; headings never do.
    let value =
        |t: &str| t.starts_with(|c: char| c.is_ascii_digit()) && parameter_column(t, vocabulary).is_none();
    if row.filled().any(|(_, c)| value(&folded(&c.text))) {
        return false;
    }
    let columns: Vec<Column> = row.filled().filter_map(|(_, c)| column(&c.text, vocabulary)).collect();
    let filled = row.filled().count();
    let has = |t| columns.contains(&Column::Meta(t));
    let parameters: Vec<_> =
        columns.iter().filter_map(|c| if let Column::Parameter(p) = c { Some(p) } else { None }).collect();
    let long = has(TableColumn::Parameter)
        && columns.iter().any(|c| matches!(c, Column::Meta(TableColumn::Value) | Column::Of(_)));
    let named = [TableColumn::Id, TableColumn::Fabric, TableColumn::Direction].into_iter().any(has);
    // `sample,B` is a header line of a fabric called B.
    let wide = parameters.len() >= 2
        || (parameters.len() == 1 && named && (filled > 2 || parameters.iter().any(|p| p.unit.is_some())));
    long || wide
}

fn column(cell: &str, vocabulary: Vocabulary<'_>) -> Option<Column> {
    let (name, _) = split_unit(cell);
    if let Some(meta) = vocabulary.table_column(&name) {
        return Some(Column::Meta(meta));
    }
    if let Some(parameter) = parameter_column(cell, vocabulary) {
        return Some(Column::Parameter(parameter));
    }
    vocabulary.direction(&name).filter(|_| name.chars().count() < 12).map(Column::Of)
}

fn parameter_column(cell: &str, vocabulary: Vocabulary<'_>) -> Option<ParameterColumn> {
    let text = folded(cell).into_owned();
    let (name, mut unit) = if text.contains('_') { (text, None) } else { split_unit(&text) };
    let mut found =
        ParameterColumn { parameter: Parameter::B, direction: None, unit: None, sd: false, inferred: false };
    if let Some(parameter) = vocabulary.parameter(&name) {
        found.parameter = parameter;
        found.unit = unit;
        return Some(found);
    }
    let mut symbol: Vec<&str> = Vec::new();
    let mut unit_parts: Vec<&str> = Vec::new();
    let mut parameter = None;
    for part in name.split(['_', ' ', '(', ')', '-', ',']).filter(|p| !p.is_empty()) {
        match normalised(part).as_str() {
            "sd" | "std" | "stdev" => found.sd = true,
            "inferred" => found.inferred = true,
            "mean" | "average" => {}
            _ if parameter.is_some() && vocabulary.direction(part).is_some() => {
                found.direction = vocabulary.direction(part);
            }
            _ if parameter.is_some() => unit_parts.push(part),
            _ => {
                symbol.push(part);
                parameter = vocabulary.parameter(&symbol.join(" "));
            }
        }
    }
    if !unit_parts.is_empty() {
        unit = unit.or_else(|| Some(spelt_out(&unit_parts)));
    }
    found.parameter = parameter?;
    found.unit = unit;
    Some(found)
}

/// `gf cm2 per cm` as a unit: `gf·cm2/cm`; several divisors go in brackets.
fn spelt_out(parts: &[&str]) -> String {
    let at = parts.iter().position(|p| *p == "per").unwrap_or(parts.len());
    let symbols =
        |p: &[&str]| p.iter().map(|s| if *s == "percent" { "%" } else { s }).collect::<Vec<_>>().join("·");
    let above = if at == 0 { "1".to_string() } else { symbols(&parts[..at]) };
    if at >= parts.len() { above } else { format!("{above}/({})", symbols(&parts[at + 1..])) }
}

/// Reads the rows of a table.
///
/// # Errors
/// `R004`, `R008`, `R009`, `R010`, `R017`, `R018`.
pub(super) fn read(
    header: &Header,
    heading: &Row<'_>,
    rows: &[&Row<'_>],
    context: &Context<'_>,
) -> Result<(Values, Vec<Finding>), ReadError> {
    let columns: Vec<Option<Column>> = heading
        .cells
        .iter()
        .map(|c| Some(&c.text).filter(|t| !t.trim().is_empty()).and_then(|t| column(t, context.vocabulary)))
        .collect();
    let mut table = Table { header, heading, columns, context, values: Vec::new(), ignored: Vec::new() };
    let long = table.meta(TableColumn::Parameter).is_some();
    let rows = if long { rows } else { table.unit_row(rows) };
    for row in rows {
        if long { table.long_row(row)? } else { table.wide_row(row)? }
    }
    if !long {
        let unknown =
            table.heading.filled().filter(|(i, _)| table.columns.get(*i).is_none_or(Option::is_none));
        let unknown: Vec<_> = unknown.map(|(i, c)| (c.text.to_string(), heading.column(i))).collect();
        table.ignored.extend(unknown.into_iter().map(|(text, column)| (text, heading.line, column)));
    }
    table.finish()
}

struct Table<'t, 'a> {
    header: &'t Header,
    heading: &'t Row<'t>,
    columns: Vec<Option<Column>>,
    context: &'a Context<'a>,
    values: Values,
    /// What is not a KES parameter: text, line, column.
    ignored: Vec<(String, usize, usize)>,
}

impl Table<'_, '_> {
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
        let parameters = |c: &Option<Column>| matches!(c, Some(Column::Parameter(_)));
        let indices = || self.columns.iter().enumerate().filter(|(_, c)| parameters(c)).map(|(i, _)| i);
        let any = indices().any(|i| bare(i).is_some_and(|t| is_unit(&t) && t != "-"));
        if !any || !indices().all(|i| bare(i).is_none_or(|t| is_unit(&t))) {
            return rows;
        }
        for (i, column) in self.columns.iter_mut().enumerate() {
            if let Some(Column::Parameter(p)) = column {
                p.unit = p.unit.take().or_else(|| bare(i));
            }
        }
        rest
    }

    fn fabric(&self, row: &Row<'_>) -> Option<String> {
        let of_row = self.text(row, TableColumn::Id).or_else(|| self.text(row, TableColumn::Fabric));
        let of_header = self.header.known.get(&super::dialect::Key::Sample).map(|e| e.text.as_str());
        of_row.or(of_header).map(|t| folded(t).into_owned())
    }

    fn direction(&self, row: &Row<'_>) -> Result<Option<Direction>, ReadError> {
        let Some(text) = self.text(row, TableColumn::Direction) else { return Ok(None) };
        if matches!(normalised(text).as_str(), "" | "mean" | "average" | "平均" | "all" | "none") {
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

    fn wide_row(&mut self, row: &Row<'_>) -> Result<(), ReadError> {
        let (fabric, direction, n) = (self.fabric(row), self.direction(row)?, self.repeats(row)?);
        for (i, column) in self.columns.clone().iter().enumerate() {
            let (Some(Column::Parameter(p)), Some(cell)) = (column, row.get(i)) else { continue };
            if matches!(cell, "-" | "–" | "—") {
                continue;
            }
            let unit =
                self.unit(p.parameter, p.unit.as_deref(), self.heading.line, self.heading.column(i))?;
            let value = finite(row, i, cell, self.context)? * unit.factor;
            let direction = p.direction.or(direction).filter(|_| p.parameter.is_directional());
            if p.sd {
                self.spread(&fabric, p.parameter, direction, value);
            } else {
                self.push(fabric.clone(), p, direction, value, n, (row.line, row.column(i)));
            }
        }
        Ok(())
    }

    fn long_row(&mut self, row: &Row<'_>) -> Result<(), ReadError> {
        let Some(index) = self.meta(TableColumn::Parameter) else { return Ok(()) };
        let Some(name) = row.get(index) else { return Ok(()) };
        let Some(p) = parameter_column(name, self.context.vocabulary) else {
            self.ignored.push((name.to_string(), row.line, row.column(index)));
            return Ok(());
        };
        let (fabric, direction, n) = (self.fabric(row), self.direction(row)?, self.repeats(row)?);
        let unit_at = self.meta(TableColumn::Unit).unwrap_or(index);
        let text = self.text(row, TableColumn::Unit).or(p.unit.as_deref());
        let unit = self.unit(p.parameter, text, row.line, row.column(unit_at))?;
        for (i, column) in self.columns.clone().iter().enumerate() {
            let of = match column {
                Some(Column::Meta(TableColumn::Value)) => p.direction.or(direction),
                Some(Column::Of(d)) => Some(*d),
                _ => continue,
            };
            let Some(cell) = row.get(i).filter(|c| !matches!(*c, "-" | "–" | "—")) else { continue };
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
    fn unit(&self, p: Parameter, text: Option<&str>, line: usize, column: usize) -> Result<Unit, ReadError> {
        let error = |problem| self.context.error(line, column, problem);
        let text = match text {
            Some(text) if text != "-" || p.kes_unit() == "1" => text,
            _ if p.kes_unit() == "1" || self.context.kes_units => p.kes_unit(),
            _ => {
                let found = p.symbol().to_string();
                return Err(error(Problem::UnitMissing { found, expected: p.kes_unit().to_string() }));
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
            let expected = p.kes_unit().to_string();
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
        let value =
            ResultValue { parameter: p.parameter, direction, mean, sd: None, n, inferred: p.inferred, place };
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
    fn finish(self) -> Result<(Values, Vec<Finding>), ReadError> {
        let repeats = self.meta(TableColumn::Specimen).is_some();
        let mut out: Vec<(Option<String>, ResultValue, Vec<f64>)> = Vec::new();
        for (fabric, value) in self.values {
            let same = |(f, v, _): &&mut (Option<String>, ResultValue, Vec<f64>)| {
                *f == fabric && v.parameter == value.parameter && v.direction == value.direction
            };
            match out.iter_mut().find(same) {
                None => out.push((fabric, value.clone(), vec![value.mean])),
                // One thickness per direction row: the fabric has one.
                Some((_, known, means)) if repeats || !value.parameter.is_directional() => {
                    if repeats || !means.contains(&value.mean) {
                        means.push(value.mean);
                    }
                    known.mean = means.iter().sum::<f64>() / means.len() as f64;
                }
                Some((_, known, _)) => {
                    let found =
                        format!("{} is given twice (first in line {})", value.parameter, known.place.line);
                    return Err(ReadError { place: value.place, problem: Problem::BadTable { found } });
                }
            }
        }
        if out.is_empty() {
            let found = "the table has no value of a KES parameter".to_string();
            return Err(self.context.error(self.heading.line, 0, Problem::BadTable { found }));
        }
        let averaged = |(fabric, mut value, means): (Option<String>, ResultValue, Vec<f64>)| {
            if let Some(e) = Estimate::of(&means).filter(|e| e.n > 1) {
                (value.mean, value.sd, value.n) = (e.mean, e.sd, e.n);
            }
            (fabric, value)
        };
        let ignored =
            |(text, line, column): (String, usize, usize)| {
                Finding::new("R104", format!("{text:?} is not a KES parameter and was left out"))
                    .at(Place::at(self.context.path, line, column))
            };
        Ok((out.into_iter().map(averaged).collect(), self.ignored.into_iter().map(ignored).collect()))
    }
}
