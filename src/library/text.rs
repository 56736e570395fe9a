//! An answer as text.

use arrow_array::RecordBatch;
use arrow_array::cast::AsArray;
use arrow_array::types::UInt64Type;

use super::bounds::Bounds;
use super::find::Answer;
use crate::instrument::Origin;
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
        let names: Vec<&str> =
            ["fabric"].into_iter().chain(FIRST).chain(asked.filter(|n| *n != "fabric")).collect();
        let names: Vec<&str> =
            names.into_iter().filter(|name| table.column_by_name(name).is_some()).collect();
        let units = units(table);
        let heading = |name: &&str| match units.get(*name).filter(|unit| *unit != "1") {
            Some(unit) => format!("{name} ({unit})"),
            None => (*name).to_string(),
        };
        let mut columns = Columns::new(names.iter().map(heading));
        for row in 0..table.num_rows() {
            let mut cells: Vec<String> = names.iter().map(|name| shown(table, name, row)).collect();
            if let (Some(fabric), Some(origin)) =
                (cells.first_mut(), Origin::from_name(&shown(table, "origin", row)))
            {
                *fabric = origin.beside(fabric);
            }
            columns.row(cells);
        }
        columns.text() + &self.notes()
    }

    /// How many fabrics are not shown, and that distances over other parameters are not alike.
    fn notes(&self) -> String {
        let mut notes = String::new();
        let counts = self.table.column_by_name("parameters").and_then(|c| c.as_primitive_opt::<UInt64Type>());
        let counts = counts.map_or(&[][..], |counts| counts.values());
        if let (Some(fewest), Some(most)) = (counts.iter().min(), counts.iter().max())
            && fewest < most
        {
            notes += &format!(
                "distances are over {fewest} to {most} parameters, as the column `parameters` says: one over few of them says less\n"
            );
        }
        if self.more > 0 {
            notes += &format!(
                "{} more, not shown: -n {} shows all\n",
                counted(self.more, "fabric"),
                self.table.num_rows() + self.more
            );
        }
        notes
    }
}

fn shown(table: &RecordBatch, name: &str, row: usize) -> String {
    match table.column_by_name(name).map(|column| cell(column, row)) {
        Some(Cell::Text(text)) => text,
        Some(Cell::Number(value)) => significant(value, 4),
        Some(Cell::Count(count)) => count.to_string(),
        Some(Cell::Nothing) | None => String::new(),
    }
}
