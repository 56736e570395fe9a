//! Titles of sections: a row that states a direction for those below it.

use super::Direction;
use super::context::Context;
use super::dialect::{HeaderKey, TableColumn};
use super::raw::Row;
use super::words::folded;

/// The section that a row opens: a direction and nothing else, also `[WARP]`, `in the weft direction`, `Direction: warp`.
pub(super) fn section(row: &Row<'_>, context: &Context<'_>) -> Option<Direction> {
    let mut filled = row.filled();
    let (_, first) = filled.next()?;
    match (filled.next(), filled.next()) {
        (None, _) => match first.text.split_once([':', '=']) {
            Some((key, of)) if is_direction_key(key, context) => stated_direction(of, context),
            _ => direction_alone(&first.text, context),
        },
        (Some((_, second)), None) if is_direction_key(&first.text, context) => {
            stated_direction(&second.text, context)
        }
        _ => None,
    }
}

/// The direction that a title states, and nothing else.
fn direction_alone(text: &str, context: &Context<'_>) -> Option<Direction> {
    let bare = without_marks(text);
    let f = context.facets(&bare);
    let is_other = f.parameter.is_some() || f.fast.is_some();
    let alone = f.direction.filter(|_| {
        !f.unknown && !is_other && f.index.is_none() && f.statistic.is_none() && f.meta.is_none()
    });
    alone.or_else(|| {
        let is_short = bare.chars().count() < 16 && !f.unknown;
        let found = context.vocabulary.direction(&bare)?;
        let is_all = !is_other && !context.vocabulary.says_more_than_direction(&bare);
        (is_short || is_all).then_some(found)
    })
}

/// The direction behind its key, as the header of a record has it: what else the text says is told elsewhere.
fn stated_direction(text: &str, context: &Context<'_>) -> Option<Direction> {
    let f = context.facets(text);
    let is_heading = f.names_value() || f.unit.is_some();
    let stated = context.vocabulary.direction(text).filter(|_| !is_heading);
    stated.or_else(|| direction_alone(text, context))
}

/// A title without the marks around it; brackets go only where nothing of them is left.
fn without_marks(text: &str) -> String {
    let bare = folded(text);
    let bare = bare.trim_matches(['<', '>', '*', '=', '-', ':', ' ']);
    let inner = bare.trim_matches(['(', ')', '[', ']', '【', '】', '<', '>', '*', '=', '-', ':', ' ']);
    if inner.contains(['(', '[', '【', ')', ']', '】']) { bare.to_string() } else { inner.to_string() }
}

fn is_direction_key(text: &str, context: &Context<'_>) -> bool {
    let v = context.vocabulary;
    let name = text.trim_end_matches([':', '=', ' ']);
    v.key(name) == Some(HeaderKey::Direction) || v.table_column(name) == Some(TableColumn::Direction)
}
