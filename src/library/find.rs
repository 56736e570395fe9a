//! What a library answers.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch, StringArray, UInt64Array};
use arrow_schema::{ArrowError, DataType, Field, Schema};

use super::bounds::Bounds;
use super::build::rows_of_parameters;
use super::census::{Census, NoSuchText};
use super::error::LibraryError;
use super::file::LibraryFile;
use super::space::{
    Axis, FEWEST, Point, Usual, Values, can_be_compared, column, columns, compare, not_compared, point,
    rests_on, sources, status,
};
use crate::kes::{HAND, Parameter, ValueStatus};
use crate::report::arrow::{Metadata, UNIT};
use crate::report::table::{FabricRow, TableError, UnitSystem, in_unit};

/// Fabrics that people are shown if they do not say how many they want.
const SHOWN: usize = 10;

/// A fabric that others are to be like.
#[derive(Clone, Debug, PartialEq)]
pub enum Like {
    /// A fabric of the library, which is left out of the answer.
    Named(String),
    /// Parameters in SI, as those of a sheet.
    Rows(Vec<FabricRow>),
}

/// What is asked.
#[derive(Clone, Debug, Default)]
pub struct Question {
    /// Fabrics that are like this one, the most alike first; in order of names when `None`.
    pub like: Option<Like>,
    /// Fabrics within these bounds.
    pub bounds: Option<Bounds>,
    /// How many at most.
    pub count: usize,
}

/// The answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The fabric; with `like` the distance, how many parameters it rests on, in what the fabrics were not compared, and
    /// which of its values that it rests on are doubtful; and all columns of the library.
    pub table: RecordBatch,
    /// What is usual in the library, where fabrics were compared.
    pub axes: Vec<Axis>,
    /// How many more fabrics the question holds for than were asked for.
    pub more: usize,
    /// How many share too few parameters with the one that is asked about to be compared.
    pub apart: usize,
    /// Values of the fabric that is asked about that are compared and were not plainly measured, by their columns.
    pub like_status: BTreeMap<String, ValueStatus>,
    /// How many fabrics have no value in a column of the bounds, by its name: they are not within bounds on it.
    pub without_value: BTreeMap<String, usize>,
    /// Texts of the bounds that no fabric has.
    pub no_such_text: Vec<NoSuchText>,
}

/// What is kept of every fabric while they are compared.
struct Near {
    number: usize,
    name: String,
    distance: f64,
    count: u64,
}

/// The fabric that is asked about.
struct Target {
    point: Point,
    /// Of the values that are not plainly measured.
    statuses: BTreeMap<String, ValueStatus>,
}

impl Question {
    /// How many fabrics an answer has: as many as were asked for, else those that fit on a page if it is for one or goes
    /// by likeness, which every fabric has, else all that are within the bounds.
    pub fn most(count: Option<usize>, is_for_page: bool) -> usize {
        count.unwrap_or(if is_for_page { SHOWN } else { usize::MAX })
    }
}

impl Answer {
    /// How many fabrics the question holds for.
    pub fn total(&self) -> usize {
        self.table.num_rows() + self.more
    }
}

impl LibraryFile {
    /// Answers a question.
    ///
    /// # Errors
    /// O070 for a file that is broken, O072 for a fabric that is not there or has too little in common with the others.
    pub fn find(&self, question: &Question) -> Result<Answer, LibraryError> {
        match &question.like {
            Some(like) => self.nearest(like, question),
            None => self.within(question),
        }
    }

    fn within(&self, question: &Question) -> Result<Answer, LibraryError> {
        let wanted = question.bounds.as_ref();
        let (mut found, mut more, mut census) = (Vec::new(), 0, Census::new(wanted));
        let asked = wanted.into_iter().flat_map(Bounds::columns);
        let names: Vec<&str> = ["fabric"].into_iter().chain(asked).collect();
        self.scan(&names, |piece, first| {
            census.add(piece);
            for row in 0..piece.num_rows() {
                if wanted.is_some_and(|bounds| !bounds.hold(piece, row)) {
                    continue;
                }
                if found.len() < question.count {
                    found.push(first + row);
                } else {
                    more += 1;
                }
            }
        })?;
        Ok(Answer {
            table: self.rows(&found)?,
            axes: Vec::new(),
            more,
            apart: 0,
            like_status: BTreeMap::new(),
            without_value: census.without_value(),
            no_such_text: census.no_such_text(),
        })
    }

    /// The library is read twice, that no more than a name and a distance of each of its fabrics is in memory.
    fn nearest(&self, like: &Like, question: &Question) -> Result<Answer, LibraryError> {
        let (mut usual, mut own) = (Usual::default(), None);
        let named = if let Like::Named(name) = like { Some(name.as_str()) } else { None };
        self.scan(&self.names(None), |piece, first| {
            // What is asked for does not change what is usual in the library.
            points(piece).for_each(|point| usual.add(&point));
            own = own.or(names(piece).position(|name| named == Some(name)).map(|row| first + row));
        })?;
        let target = match like {
            Like::Named(name) => {
                let number = own.ok_or_else(|| LibraryError::Unknown { fabric: name.clone() })?;
                Target::of_table(&self.rows(&[number])?)
            }
            Like::Rows(rows) => Target::of_rows(rows),
        };
        let axes = usual.axes();
        refuse_few(&target.point, &axes)?;
        let bounds = question.bounds.as_ref();
        let (mut near, mut apart, mut census) = (Vec::new(), 0, Census::new(bounds));
        self.scan(&self.names(bounds), |piece, first| {
            census.add(piece);
            for (row, (name, point)) in names(piece).zip(points(piece)).enumerate() {
                let number = first + row;
                if own == Some(number) || bounds.is_some_and(|bounds| !bounds.hold(piece, row)) {
                    continue;
                }
                let comparison = compare(&point, &target.point, &axes);
                if comparison.count < FEWEST as u64 {
                    apart += 1;
                    continue;
                }
                let (distance, count) = (comparison.distance, comparison.count);
                near.push(Near { number, name: name.into(), distance, count });
            }
        })?;
        near.sort_by(|a, b| a.distance.total_cmp(&b.distance).then_with(|| a.name.cmp(&b.name)));
        let more = near.len().saturating_sub(question.count);
        near.truncate(question.count);
        let table = self.with_distances(&near, &target.point, &axes)?;
        let (without_value, no_such_text) = (census.without_value(), census.no_such_text());
        Ok(Answer { table, axes, more, apart, like_status: target.statuses, without_value, no_such_text })
    }

    /// The columns that a comparison needs.
    fn names<'q>(&'q self, bounds: Option<&'q Bounds>) -> Vec<&'q str> {
        let of_space: BTreeSet<String> = HAND.iter().flat_map(|(parameter, _)| columns(*parameter)).collect();
        let fields = self.schema().fields().iter().map(|field| field.name().as_str());
        let space = fields.filter(|name| of_space.contains(*name));
        let bounds = bounds.into_iter().flat_map(Bounds::columns);
        ["fabric"].into_iter().chain(space).chain(bounds).collect()
    }

    /// The rows of fabrics with their distances and what these rest on, in this order.
    fn with_distances(
        &self,
        near: &[Near],
        target: &Point,
        axes: &[Axis],
    ) -> Result<RecordBatch, LibraryError> {
        let mut numbers: Vec<usize> = near.iter().map(|one| one.number).collect();
        numbers.sort_unstable();
        let whole = self.rows(&numbers)?;
        let place = |number: usize| numbers.binary_search(&number).unwrap_or_default() as u64;
        let order: UInt64Array = near.iter().map(|one| Some(place(one.number))).collect();
        let whole = arrow_select::take::take_record_batch(&whole, &order).map_err(|e| failed(&e))?;
        let (mut apart, mut doubtful) = (Vec::new(), Vec::new());
        for (row, point) in points(&whole).enumerate() {
            let comparison = compare(&point, target, axes);
            let mut rests_on = rests_on(&point, &comparison);
            rests_on.retain(|name| status(&whole, name, row) == ValueStatus::Doubtful);
            apart.push(listed(&not_compared(target, &comparison)));
            doubtful.push(listed(&rests_on));
        }
        let one = Metadata::from([(UNIT.to_string(), "1".to_string())]);
        let distances: Float64Array = near.iter().map(|one| Some(one.distance)).collect();
        let counts: UInt64Array = near.iter().map(|one| Some(one.count)).collect();
        let added: [(Field, ArrayRef); 4] = [
            (Field::new("distance", DataType::Float64, true).with_metadata(one.clone()), Arc::new(distances)),
            (Field::new("parameters", DataType::UInt64, true).with_metadata(one), Arc::new(counts)),
            (Field::new(NOT_COMPARED, DataType::Utf8, true), Arc::new(StringArray::from(apart))),
            (Field::new(DOUBTFUL, DataType::Utf8, true), Arc::new(StringArray::from(doubtful))),
        ];
        let schema = whole.schema();
        let fields = schema.fields().iter().map(|field| field.as_ref().clone());
        let mut columns: Vec<(Field, ArrayRef)> = fields.zip(whole.columns().iter().cloned()).collect();
        columns.splice(1..1, added);
        let (fields, arrays): (Vec<_>, Vec<_>) = columns.into_iter().unzip();
        RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays).map_err(|e| failed(&e))
    }
}

/// The column of an answer that says in what two fabrics were not compared.
pub(super) const NOT_COMPARED: &str = "not_compared";

/// The column of an answer that says which values that a distance rests on are doubtful.
pub(super) const DOUBTFUL: &str = "doubtful";

fn listed(names: &[String]) -> Option<String> {
    (!names.is_empty()).then(|| names.join(", "))
}

fn failed(error: &ArrowError) -> LibraryError {
    let problem = TableError::Encode { format: "Parquet", problem: error.to_string() }.to_string();
    LibraryError::Results { path: "the answer".into(), problem }
}

/// The fabrics of a table of a library in the space.
fn points(table: &RecordBatch) -> impl Iterator<Item = Point> {
    let numbers = sources(|name| table.column_by_name(name)?.as_primitive_opt::<Float64Type>());
    (0..table.num_rows()).map(move |row| {
        point(&numbers, |column| column.filter(|column| column.is_valid(row)).map(|column| column.value(row)))
    })
}

/// Their names.
fn names(table: &RecordBatch) -> impl Iterator<Item = &str> {
    let names = table.column_by_name("fabric").and_then(|column| column.as_string_opt::<i32>());
    names.into_iter().flat_map(|names| names.iter()).map(Option::unwrap_or_default)
}

/// Refuses a fabric that has too little in common with the library.
fn refuse_few(target: &Point, axes: &[Axis]) -> Result<(), LibraryError> {
    let (mut shared, mut differing) = (0, 0);
    for (axis, _) in axes.iter().zip(target).filter(|(axis, sides)| can_be_compared(**sides, axis)) {
        shared += usize::from(axis.n > 0);
        differing += usize::from(axis.spread().is_some());
    }
    match differing < FEWEST {
        true => Err(LibraryError::Apart { shared, differing, needed: FEWEST }),
        false => Ok(()),
    }
}

impl Like {
    /// The parameters in SI of a table of one fabric.
    ///
    /// # Errors
    /// O069 for another table.
    pub fn of_table(table: &RecordBatch) -> Result<Self, LibraryError> {
        Ok(Self::Rows(rows_of_parameters("the fabric", table)?))
    }
}

impl Target {
    /// A fabric of a library: the first of a table.
    fn of_table(table: &RecordBatch) -> Self {
        let point = points(table).next().unwrap_or([[f64::NAN; 3]; HAND.len()]);
        let names = HAND.iter().flat_map(|(parameter, _)| columns(*parameter));
        let statuses = names.map(|name| (status(table, &name, 0), name));
        Self { point, statuses: statuses.filter_map(not_measured).collect() }
    }

    /// Parameters in SI.
    fn of_rows(rows: &[FabricRow]) -> Self {
        let values: Values = rows.iter().filter_map(value_of).collect();
        let point = point(&sources(|name| values.get(name).copied()), |value| *value);
        let of_hand: BTreeSet<String> = HAND.iter().flat_map(|(parameter, _)| columns(*parameter)).collect();
        let statuses = rows.iter().filter(|row| row.mean.is_some()).map(|row| {
            let status = ValueStatus::from_name(&row.status).unwrap_or_default();
            (status, column(&row.parameter, row.direction.as_deref()))
        });
        let of_hand = statuses.filter(|(_, name)| of_hand.contains(name));
        Self { point, statuses: of_hand.filter_map(not_measured).collect() }
    }
}

/// The column of a row of parameters in SI, and its value in the library's unit.
fn value_of(row: &FabricRow) -> Option<(String, f64)> {
    let (_, factor) = UnitSystem::Kes.of(Parameter::from_symbol(&row.parameter)?);
    Some((column(&row.parameter, row.direction.as_deref()), in_unit(row.mean?, factor)))
}

fn not_measured((status, name): (ValueStatus, String)) -> Option<(String, ValueStatus)> {
    (status != ValueStatus::Measured).then_some((name, status))
}
