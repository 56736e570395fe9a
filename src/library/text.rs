//! An answer as text.

use arrow_array::cast::AsArray;
use arrow_array::types::UInt64Type;
use arrow_array::{Array, RecordBatch};

use super::bounds::Bounds;
use super::census::NoSuchText;
use super::find::{Answer, DOUBTFUL, NOT_COMPARED};
use super::space::{FEWEST, status};
use crate::instrument::Origin;
use crate::kes::ValueStatus;
use crate::report::arrow_text::{Cell, cell, units};
use crate::report::number::{counted, significant};
use crate::results::Columns;

/// What people ask for first; the other columns are in tables and documents.
const FIRST: [&str; 8] =
    ["distance", "parameters", "thickness", "mass", "B_warp", "B_weft", "2HB_warp", "G_warp"];

impl Answer {
    /// The fabrics with their distances, the columns that the bounds speak of, and those that people ask for first.
    pub fn text(&self, bounds: Option<&Bounds>) -> String {
        let table = &self.table;
        let asked = bounds.into_iter().flat_map(Bounds::columns).filter(|name| !FIRST.contains(name));
        let names = ["fabric"].into_iter().chain(FIRST).chain(asked.filter(|n| *n != "fabric"));
        let names = names.chain([NOT_COMPARED, DOUBTFUL].into_iter().filter(|name| has_any(table, name)));
        let names: Vec<&str> = names.filter(|name| table.column_by_name(name).is_some()).collect();
        let units = units(table);
        let heading = |name: &&str| match units.get(*name).filter(|unit| *unit != "1") {
            Some(unit) => format!("{name} ({unit})"),
            None => name.replace('_', if *name == NOT_COMPARED { " " } else { "_" }),
        };
        let mut columns = Columns::new(names.iter().map(heading));
        let mut has_marks = false;
        for row in 0..table.num_rows() {
            has_marks |= names.iter().any(|name| !status(table, name, row).mark().is_empty());
            let mut cells: Vec<String> = names.iter().map(|name| shown(table, name, row)).collect();
            if let (Some(fabric), Some(origin)) =
                (cells.first_mut(), Origin::from_name(&shown(table, "origin", row)))
            {
                *fabric = origin.beside(fabric);
            }
            columns.row(cells);
        }
        let legend = if has_marks { ValueStatus::legend() } else { String::new() };
        let notes: String = self.notes().iter().map(|note| format!("{note}\n")).collect();
        columns.with_note(&legend).text() + &notes
    }

    /// What a reader of the table must know: that of the values, and how many fabrics are not shown.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = self.warnings();
        let counts = self.table.column_by_name("parameters").and_then(|c| c.as_primitive_opt::<UInt64Type>());
        let counts = counts.map_or(&[][..], |counts| counts.values());
        if let (Some(fewest), Some(most)) = (counts.iter().min(), counts.iter().max())
            && fewest < most
        {
            notes.push(format!(
                "distances are over {fewest} to {most} parameters, as the column `parameters` says: one over few of them says less"
            ));
        }
        if self.more > 0 {
            notes.push(format!(
                "{} more, not shown: -n {} shows all",
                counted(self.more, "fabric"),
                self.total()
            ));
        }
        notes
    }

    /// What speaks against the answer, or against the question.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if !self.like_status.is_empty() {
            let values = self.like_status.iter().map(|(name, status)| format!("{name} ({})", status.name()));
            let values: Vec<String> = values.collect();
            warnings.push(format!(
                "values of the fabric that is asked about are not plainly measured: {}",
                values.join(", ")
            ));
        }
        for (name, count) in &self.without_value {
            let have = if *count == 1 { "has" } else { "have" };
            warnings.push(format!("{} {have} no {name}", counted(*count, "fabric")));
        }
        for NoSuchText { column, text, known } in &self.no_such_text {
            let known =
                if known.is_empty() { String::new() } else { format!(": it is {}", known.join(" or ")) };
            warnings.push(format!("no {column} is `{text}`{known}"));
        }
        if self.apart > 0 {
            let share = if self.apart == 1 { "shares" } else { "share" };
            warnings.push(format!(
                "{} {share} fewer than {FEWEST} parameters with it and cannot be compared",
                counted(self.apart, "fabric")
            ));
        }
        warnings
    }
}

fn has_any(table: &RecordBatch, name: &str) -> bool {
    table.column_by_name(name).is_some_and(|column| column.null_count() < column.len())
}

fn shown(table: &RecordBatch, name: &str, row: usize) -> String {
    match table.column_by_name(name).map(|column| cell(column, row)) {
        Some(Cell::Text(text)) => text,
        Some(Cell::Number(value)) => status(table, name, row).behind(&significant(value, 4)),
        Some(Cell::Count(count)) => count.to_string(),
        Some(Cell::Nothing) | None => String::new(),
    }
}
