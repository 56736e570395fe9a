//! How directions are written in a column of them: in words, as angles to the warp, by letters, or as 1 and 2.

use std::collections::{BTreeMap, BTreeSet};

use super::Direction;
use super::angle::{are_angles, direction_of_angle};
use super::context::Context;
use super::header::Header;
use super::numbered;
use crate::finding::ReadFact;

/// The way of writing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Written {
    Words,
    Angles,
    Letters,
    /// As the literature uses them: 1 is warp, 2 is weft.
    Numbers,
    /// As a line of the file says what 1 and 2 are.
    StatedNumbers,
}

/// How the entries of a column are written, and the direction of each that is no word; none where some entry is no direction.
pub(super) fn of_column(
    entries: &BTreeSet<&str>,
    header: &Header,
    context: &Context<'_>,
) -> Option<(Written, BTreeMap<String, Direction>)> {
    let v = context.vocabulary;
    if are_angles(entries.iter().copied()) {
        let of_angles = entries.iter().filter_map(|text| Some((text.to_string(), direction_of_angle(text)?)));
        return Some((Written::Angles, of_angles.collect()));
    }
    if entries.iter().all(|text| v.direction(text).is_some()) {
        return Some((Written::Words, BTreeMap::new()));
    }
    let [first, second] = entries.iter().copied().collect::<Vec<_>>()[..] else { return None };
    if (first, second) == ("1", "2") {
        return match numbered::key_of(header, context) {
            Some([Direction::Warp, Direction::Weft]) => of_pair(Written::StatedNumbers, [first, second]),
            Some([Direction::Weft, Direction::Warp]) => of_pair(Written::StatedNumbers, [second, first]),
            Some(_) => None,
            None => of_pair(Written::Numbers, [first, second]),
        };
    }
    // W and F are warp and fill.
    let is_fill = first.eq_ignore_ascii_case("f") && second.eq_ignore_ascii_case("w");
    if v.are_partners(first, second) {
        of_pair(Written::Letters, [first, second])
    } else if is_fill || v.are_partners(second, first) {
        of_pair(Written::Letters, [second, first])
    } else {
        None
    }
}

fn of_pair(written: Written, [warp, weft]: [&str; 2]) -> Option<(Written, BTreeMap<String, Direction>)> {
    let directions = [(warp.to_string(), Direction::Warp), (weft.to_string(), Direction::Weft)];
    Some((written, directions.into_iter().collect()))
}

impl Written {
    /// What is told of columns that are written so.
    pub fn fact(self, entries: impl Iterator<Item = String>) -> Option<ReadFact> {
        match self {
            Self::Words | Self::StatedNumbers => None,
            Self::Angles => Some(ReadFact::AnglesAsDirections {}),
            Self::Letters => Some(ReadFact::DirectionsFromLetters { texts: entries.collect() }),
            Self::Numbers => Some(ReadFact::NumbersAsDirections {}),
        }
    }
}
