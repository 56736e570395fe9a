//! Several abscissae of one curve: the extension of the jaws beside the strain, a travel beside the thickness, volts beside the
//! curvature that they stand for.

use super::Test;
use super::context::Context;
use super::dialect::{HeaderKey, Role};
use super::layout::{Column, Scanner};
use super::ordinates::changes;
use super::raw::Row;
use super::unit_text::{is_volt, unit};
use crate::finding::{Finding, Place, ReadFact};
use crate::quantity::Dimension;

const LENGTH: Dimension = Dimension { kg: 0, m: 1, s: 0 };

impl Scanner<'_, '_> {
    /// R104: of abscissae that stand beside one another, or over one ordinate, only that of the test is kept; all where none is
    /// more than another. One that does not change, such as the thickness of the specimen, is none.
    pub(super) fn one_abscissa_each(&mut self, mut columns: Vec<Column>, rows: &[&Row<'_>]) -> Vec<Column> {
        let test = self.test_of_columns(&columns);
        let mut others = Vec::new();
        for run in runs(&columns) {
            let (moving, resting): (Vec<&Column>, Vec<&Column>) =
                run.into_iter().partition(|c| changes(c, rows, self.context.decimal));
            others.extend(self.others(&moving, test));
            others.extend(resting.iter().filter(|_| !moving.is_empty()).map(|c| c.index));
        }
        if others.is_empty() {
            return columns;
        }
        let place = Place::at(self.context.path, columns[0].line, 0);
        let left_out = columns.extract_if(.., |c| others.contains(&c.index));
        let names = left_out.map(|c| c.name).collect();
        self.findings.push(Finding::new(ReadFact::Unusable { names, reason: None }).at(place));
        columns
    }

    /// Indices of all but the one that is nearest to the abscissa of the test; none if several are as near, or are of different
    /// curves.
    fn others(&self, run: &[&Column], test: Option<Test>) -> Vec<usize> {
        let nearest = run.iter().map(|c| remoteness(c, test, self.context)).min();
        let mut near = run.iter().filter(|c| Some(remoteness(c, test, self.context)) == nearest);
        let (Some(one), None) = (near.next(), near.next()) else { return Vec::new() };
        if !run.iter().all(|c| are_of_one_curve(c, one)) {
            return Vec::new();
        }
        run.iter().filter(|c| c.index != one.index).map(|c| c.index).collect()
    }

    /// The test that an ordinate belongs to, or that the header or the name of the file states.
    fn test_of_columns(&self, columns: &[Column]) -> Option<Test> {
        let stated =
            self.header.known.get(&HeaderKey::Test).and_then(|e| self.context.vocabulary.test(&e.text));
        let of_columns = columns.iter().find_map(|c| Test::of_ordinate(c.role));
        of_columns.or(stated).or(self.context.label.test)
    }
}

/// The abscissae that serve the same ordinates: all where there is one ordinate, else those that stand beside one another.
fn runs(columns: &[Column]) -> Vec<Vec<&Column>> {
    let ordinates = columns.iter().filter(|c| !c.role.is_abscissa()).count();
    if ordinates == 1 {
        return vec![columns.iter().filter(|c| c.role.is_abscissa()).collect()];
    }
    let runs = columns.chunk_by(|a, b| a.role.is_abscissa() == b.role.is_abscissa());
    runs.filter(|run| run[0].role.is_abscissa()).map(|run| run.iter().collect()).collect()
}

/// Whether the names of two columns say the same of direction, specimen and branch.
fn are_of_one_curve(a: &Column, b: &Column) -> bool {
    (a.says.direction, a.says.specimen, a.says.branch) == (b.says.direction, b.says.specimen, b.says.branch)
}

/// How far a column is from the abscissa of the test: first by its role, then by its unit.
fn remoteness(column: &Column, test: Option<Test>, context: &Context<'_>) -> (u8, u8) {
    let own = test.and_then(|test| test.spec().x.columns.first().copied());
    let of_role = match own {
        Some(own) if column.role == own => 0,
        None if column.role != Role::Displacement => 0,
        _ if column.role == Role::Displacement => 1,
        _ => 2,
    };
    (of_role, steps_to_unit(column, context))
}

/// What lies between the numbers and the unit of the abscissa: nothing, the length of the specimen, the full scale of an amplifier, or
/// nobody knows what.
fn steps_to_unit(column: &Column, context: &Context<'_>) -> u8 {
    let Some(text) = column.unit.clone().or_else(|| context.default_unit(column.role)) else { return 3 };
    if is_volt(&text) {
        return 2;
    }
    match (unit(&text), unit(column.role.kes_unit())) {
        (Ok(own), Ok(customary)) if own.dimension == customary.dimension => 0,
        (Ok(own), Ok(customary))
            if customary.dimension == Dimension::default() && own.dimension == LENGTH =>
        {
            1
        }
        _ => 3,
    }
}
