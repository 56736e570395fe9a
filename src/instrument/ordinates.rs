//! Ordinates over one abscissa: which are repeats of one another, and which were recorded beside them.

use super::Test;
use super::context::Context;
use super::dialect::Role;
use super::layout::{Column, Pair, Scanner};
use super::raw::Row;
use super::sniff::{Number, number};
use super::unit_text::{is_volt, unit};
use crate::finding::{Finding, Place, ReadFact};
use crate::quantity::Dimension;

/// Numbers from which a column is seen not to change.
const CONSTANT: usize = 3;

/// What the numbers of an ordinate are: repeats of a curve are of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Volts,
    Of(Dimension),
}

impl Scanner<'_, '_> {
    /// R104: a constant tension, the load cell's force beside the moment, or the raw force beside that per width are no repeats
    /// of the curve over whose abscissa they stand.
    pub(super) fn leave_out_companions(&mut self, pairs: &mut Vec<Pair>, rows: &[&Row<'_>]) {
        let all = pairs.len();
        let is_curve: Vec<bool> = pairs.iter().map(|p| changes(&p.y, rows, self.context.decimal)).collect();
        let curves: Vec<&Pair> = pairs.iter().zip(&is_curve).filter(|(_, is)| **is).map(|(p, _)| p).collect();
        let kept: Vec<bool> = pairs
            .iter()
            .zip(&is_curve)
            .map(|(p, is)| (*is || curves.is_empty()) && is_repeat(p, &curves, self.context))
            .collect();
        let names: Vec<String> =
            pairs.iter().zip(&kept).filter(|(_, kept)| !**kept).map(|(p, _)| p.y.name.clone()).collect();
        if names.is_empty() || names.len() == all {
            return;
        }
        let place = Place::at(self.context.path, pairs[0].y.line, 0);
        self.findings.push(Finding::new(ReadFact::Unusable { names, reason: None }).at(place));
        let mut kept = kept.into_iter();
        pairs.retain(|_| kept.next().unwrap_or(true));
    }
}

/// Whether the numbers of a column change at all.
pub(super) fn changes(column: &Column, rows: &[&Row<'_>], decimal: char) -> bool {
    let mut values = rows.iter().filter_map(|row| match number(row.get(column.index)?, decimal) {
        Number::Value(value) => Some(value),
        _ => None,
    });
    let Some(first) = values.next() else { return true };
    let mut count = 1;
    let same = values.all(|value| {
        count += 1;
        value == first
    });
    !same || count < CONSTANT
}

/// Whether an ordinate has the role and the kind of unit that the curve of the test has.
fn is_repeat(pair: &Pair, curves: &[&Pair], context: &Context<'_>) -> bool {
    let own: Vec<&&Pair> = curves.iter().filter(|p| belongs(p, p.x.role, curves)).collect();
    if !own.is_empty() && !belongs(pair, pair.x.role, curves) {
        return false;
    }
    let group = family(pair.y.role);
    let kinds: Vec<Kind> =
        own.iter().filter(|p| family(p.y.role) == group).filter_map(|p| kind(p, context)).collect();
    let customary = unit(group.kes_unit()).ok().map(|u| Kind::Of(u.dimension));
    // Per width goes before what is yet to be divided.
    let best = customary.filter(|k| kinds.contains(k)).or(kinds.first().copied());
    best.is_none() || kind(pair, context).is_none_or(|k| Some(k) == best)
}

/// Whether the ordinate is the one that the test of the abscissa has, where any is: a shear force, not a force beside it.
fn belongs(pair: &Pair, abscissa: Role, curves: &[&Pair]) -> bool {
    let own = match Test::of_abscissa(abscissa) {
        Some(test) => test.spec().y.columns.first().copied(),
        None if abscissa == Role::Position && curves.iter().any(|p| p.y.role.is_of_sweep()) => {
            return pair.y.role.is_of_sweep();
        }
        // A travel is that of the test whose ordinate stands beside it.
        None => curves.iter().map(|p| p.y.role).find(|role| *role != Role::Force),
    };
    own.is_none_or(|own| pair.y.role == own || curves.iter().all(|p| p.y.role != own))
}

/// Roles that are one quantity of a test in several forms: the friction force is the coefficient times the load.
fn family(role: Role) -> Role {
    if role == Role::FrictionForce { Role::FrictionCoefficient } else { role }
}

/// The kind of an ordinate's unit; `None` if it states none that is known, which is refused later.
fn kind(pair: &Pair, context: &Context<'_>) -> Option<Kind> {
    let text = pair.y.unit.clone().or_else(|| context.default_unit(pair.y.role))?;
    if is_volt(&text) { Some(Kind::Volts) } else { unit(&text).ok().map(|u| Kind::Of(u.dimension)) }
}
