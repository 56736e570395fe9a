//! What a library answers.

use std::collections::BTreeSet;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch, UInt64Array};
use arrow_schema::{DataType, Field, Schema};

use super::bounds::Bounds;
use super::build::rows_of_parameters;
use super::error::LibraryError;
use super::file::LibraryFile;
use super::space::{Axis, FEWEST, Point, Usual, Values, column, columns, distance, point, sources};
use crate::kes::{HAND, Parameter};
use crate::report::arrow::{Metadata, UNIT};
use crate::report::table::{FabricRow, TableError, UnitSystem, in_unit};

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
    /// The fabric; with `like` the distance and how many parameters it rests on; and all columns of the library.
    pub table: RecordBatch,
    /// What is usual in the library, where fabrics were compared.
    pub axes: Vec<Axis>,
    /// How many more fabrics the question holds for than were asked for.
    pub more: usize,
}

/// What is kept of every fabric while they are compared.
struct Row {
    number: usize,
    name: String,
    point: Point,
}

impl LibraryFile {
    /// Answers a question.
    ///
    /// # Errors
    /// O070 for a file that is broken, O072 for a fabric that is not there or has too little in common with the others.
    pub fn find(&self, question: &Question) -> Result<Answer, LibraryError> {
        match &question.like {
            Some(like) => self.nearest(like, question),
            None => {
                let (mut found, mut all) = (Vec::new(), 0);
                let wanted = question.bounds.as_ref();
                let names: Vec<&str> =
                    ["fabric"].into_iter().chain(wanted.into_iter().flat_map(Bounds::columns)).collect();
                self.scan(&names, |piece, first| {
                    let within = |row: &usize| wanted.is_none_or(|bounds| bounds.hold(piece, *row));
                    for row in (0..piece.num_rows()).filter(within) {
                        all += 1;
                        if found.len() < question.count {
                            found.push(first + row);
                        }
                    }
                })?;
                Ok(Answer { table: self.rows(&found)?, axes: Vec::new(), more: all - found.len() })
            }
        }
    }

    fn nearest(&self, like: &Like, question: &Question) -> Result<Answer, LibraryError> {
        let (mut usual, mut rows, mut target) = (Usual::default(), Vec::new(), None);
        let named = if let Like::Named(name) = like { Some(name.as_str()) } else { None };
        self.scan(&self.names(question), |piece, first| {
            let names = piece.column_by_name("fabric").and_then(|c| c.as_string_opt::<i32>());
            let numbers = sources(|name| piece.column_by_name(name)?.as_primitive_opt::<Float64Type>());
            for row in 0..piece.num_rows() {
                let name = names.filter(|names| names.is_valid(row)).map_or("", |names| names.value(row));
                let point = point(&numbers, |column| {
                    column.filter(|column| column.is_valid(row)).map(|column| column.value(row))
                });
                // What is asked for does not change what is usual in the library.
                usual.add(&point);
                if named == Some(name) {
                    target = Some(point);
                } else if question.bounds.as_ref().is_none_or(|bounds| bounds.hold(piece, row)) {
                    rows.push(Row { number: first + row, name: name.into(), point });
                }
            }
        })?;
        let target = match like {
            Like::Named(name) => target.ok_or_else(|| LibraryError::Unknown { fabric: name.clone() })?,
            Like::Rows(rows) => point_of(rows),
        };
        let axes = usual.axes();
        let shared =
            axes.iter().zip(target).filter(|(axis, x)| x.is_finite() && axis.sd.is_some_and(|sd| sd > 0.0));
        let shared = shared.count();
        if shared < FEWEST {
            return Err(LibraryError::Apart { shared, needed: FEWEST });
        }
        let mut near: Vec<(f64, u64, Row)> = rows
            .into_iter()
            .map(|row| {
                let (distance, count) = distance(&row.point, &target, &axes);
                (distance, count, row)
            })
            .filter(|(_, count, _)| *count >= FEWEST as u64)
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.2.name.cmp(&b.2.name)));
        let more = near.len().saturating_sub(question.count);
        near.truncate(question.count);
        Ok(Answer { table: self.with_distances(&near)?, axes, more })
    }

    /// The columns that a comparison needs.
    fn names<'q>(&'q self, question: &'q Question) -> Vec<&'q str> {
        let of_space: BTreeSet<String> = HAND.iter().flat_map(|(parameter, _)| columns(*parameter)).collect();
        let fields = self.schema().fields().iter().map(|field| field.name().as_str());
        let space = fields.filter(|name| of_space.contains(*name));
        let bounds = question.bounds.iter().flat_map(Bounds::columns);
        ["fabric"].into_iter().chain(space).chain(bounds).collect()
    }

    /// The rows of fabrics with their distances, in this order.
    fn with_distances(&self, near: &[(f64, u64, Row)]) -> Result<RecordBatch, LibraryError> {
        let mut numbers: Vec<usize> = near.iter().map(|(_, _, row)| row.number).collect();
        numbers.sort_unstable();
        let whole = self.rows(&numbers)?;
        let place = |number: usize| numbers.binary_search(&number).unwrap_or_default() as u64;
        let order: UInt64Array = near.iter().map(|(_, _, row)| Some(place(row.number))).collect();
        let failed = |e: arrow_schema::ArrowError| {
            let problem = TableError::Encode { format: "Parquet", problem: e.to_string() }.to_string();
            LibraryError::Results { path: "the answer".into(), problem }
        };
        let whole = arrow_select::take::take_record_batch(&whole, &order).map_err(failed)?;
        let distances: ArrayRef = Arc::new(near.iter().map(|n| Some(n.0)).collect::<Float64Array>());
        let counts: ArrayRef = Arc::new(near.iter().map(|n| Some(n.1)).collect::<UInt64Array>());
        let one = Metadata::from([(UNIT.to_string(), "1".to_string())]);
        let added = [
            (Field::new("distance", DataType::Float64, true).with_metadata(one.clone()), distances),
            (Field::new("parameters", DataType::UInt64, true).with_metadata(one), counts),
        ];
        let mut columns: Vec<(Field, ArrayRef)> = whole
            .schema()
            .fields()
            .iter()
            .map(|f| f.as_ref().clone())
            .zip(whole.columns().iter().cloned())
            .collect();
        columns.splice(1..1, added);
        let (fields, arrays): (Vec<_>, Vec<_>) = columns.into_iter().unzip();
        RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays).map_err(failed)
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

/// The point of parameters in SI.
fn point_of(rows: &[FabricRow]) -> Point {
    let value = |row: &FabricRow| {
        let (_, factor) = UnitSystem::Kes.of(Parameter::from_symbol(&row.parameter)?);
        Some((column(&row.parameter, row.direction.as_deref()), in_unit(row.mean?, factor)))
    };
    let values: Values = rows.iter().filter_map(value).collect();
    point(&sources(|name| values.get(name).copied()), |value| *value)
}
