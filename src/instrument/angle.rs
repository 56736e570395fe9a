//! Angles to the warp in columns of directions: 0, 45 and 90.

use std::collections::BTreeSet;

use super::Direction;

/// The direction of an angle to the warp, with or without a sign for degrees.
pub(super) fn direction_of_angle(text: &str) -> Option<Direction> {
    let degrees = text.trim_end_matches(['°', ' ']).trim_end_matches("deg").trim_end();
    match degrees.parse::<f64>().ok()? {
        0.0 => Some(Direction::Warp),
        45.0 => Some(Direction::Bias),
        90.0 => Some(Direction::Weft),
        _ => None,
    }
}

/// Whether the entries of a column are angles, 0 and 90 among them.
pub(super) fn are_angles<'e>(entries: impl Iterator<Item = &'e str>) -> bool {
    let found: Option<BTreeSet<Direction>> = entries.map(direction_of_angle).collect();
    found.is_some_and(|of| of.contains(&Direction::Warp) && of.contains(&Direction::Weft))
}
