//! Pages of a printed record: headings that stand again above the rest of a curve.

use super::layout::{Column, Scanner};
use super::raw::Row;
use super::shape::is_numeric;
use super::sniff::{Number, number};
use crate::finding::{Finding, Place, ReadFact};

/// Samples that a curve has at least.
const FEWEST: usize = 3;

impl Scanner<'_, '_> {
    /// The first row behind headings that stand once more, where the curves below go on: pages repeat the headings.
    /// Curves that begin anew are other specimens.
    pub(super) fn next_page(
        &mut self,
        heading: &Row<'_>,
        rows: &[&Row<'_>],
        columns: &[Column],
    ) -> Option<usize> {
        let mut at = self.at;
        while self.rows.get(at)?.is_blank() {
            at += 1;
        }
        let same =
            |a: &Row<'_>, b: &Row<'_>| a.cells.iter().map(|c| &c.text).eq(b.cells.iter().map(|c| &c.text));
        if is_numeric(heading, self.context.decimal) || !same(heading, self.rows.get(at)?) {
            return None;
        }
        // A row of units below the headings stands again, too.
        let first = self.rows.iter().position(|r| r.line == heading.line)?;
        let units = self
            .rows
            .get(first + 1)
            .filter(|r| rows.first().is_some_and(|d| d.line > r.line) && !r.is_blank());
        at += 1;
        if let (Some(units), Some(row)) = (units, self.rows.get(at)) {
            at += usize::from(same(units, row));
        }
        let below = self.rows[at..].iter().find(|r| !r.is_blank())?;
        let x = columns.iter().find(|c| c.role.is_abscissa())?;
        let number = |r: &Row<'_>| match r.get(x.index).map(|c| number(c, self.context.decimal)) {
            Some(Number::Value(v)) => Some(v),
            _ => None,
        };
        let before: Vec<f64> = rows.iter().filter_map(|r| number(r)).collect();
        let (start, last, next) = (*before.first()?, *before.last()?, number(below)?);
        let step = before.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0f64, f64::max);
        // Half a cycle that goes on to the other side is not over.
        let second = self.rows[at..].iter().filter(|r| !r.is_blank()).nth(1).and_then(number).unwrap_or(next);
        let side = |v: f64| if (v - start).abs() <= step { 0.0 } else { (v - start).signum() };
        let sides: Vec<f64> = before.iter().map(|v| side(*v)).filter(|s| *s != 0.0).collect();
        let one_sided = sides.windows(2).all(|w| w[0] == w[1]);
        let beyond = (second - start) * sides.first().copied().unwrap_or(0.0) < 0.0;
        let closed = (last - start).abs() <= step && !(one_sided && beyond);
        let goes_on = (next - last).abs() <= 2.0 * step;
        // Too few to be a specimen of their own.
        let page = self.rows[at..].iter().skip_while(|r| r.is_blank());
        let page = page.take_while(|r| is_numeric(r, self.context.decimal));
        let closed = closed && page.take(FEWEST).count() == FEWEST;
        if goes_on && closed {
            let place = Place::at(self.context.path, below.line, 0);
            self.findings.push(Finding::new(ReadFact::HeadingsAgain {}).at(place));
        }
        (goes_on && !closed).then_some(at)
    }
}
