//! Metadata in the name of a file or over a block of columns: `F01_warp_FB2_1`, `経-1`, `タテ`.

use super::dialect::HeaderKey;
use super::vocabulary::Vocabulary;
use super::words::{folded, normalised};
use super::{Direction, Test};

/// A number from here on does not count specimens.
pub(super) const SPECIMENS: usize = 10_000;
/// A number behind the name of a sample that is larger is a part of it: `Style 501`.
const COUNTED: usize = 99;

/// What a name says.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Label {
    pub sample: Option<String>,
    pub test: Option<Test>,
    pub direction: Option<Direction>,
    pub specimen: Option<usize>,
    /// Two words of directions that differ: then none is taken.
    pub conflict: Option<[Direction; 2]>,
    /// Whether it is across the direction that it names: then none is taken.
    pub across: bool,
    /// Words that mean nothing here.
    pub unknown: bool,
    /// A sample and the number behind it, which is read as that of a specimen: `Lot 3`.
    pub numbered: Option<(String, usize)>,
    /// Words behind the first known one that mean nothing here.
    pub rest: Vec<String>,
}

impl Label {
    /// Reads what the parts of a text mean; unknown parts before the first known one are the sample.
    pub fn parse(text: &str, vocabulary: Vocabulary<'_>) -> Self {
        let mut label = Self::default();
        let mut sample: Vec<&str> = Vec::new();
        let mut begun = false;
        let text = folded(text).replace('°', "deg");
        let parts: Vec<&str> =
            text.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty()).collect();
        for (at, part) in parts.iter().enumerate() {
            if !begun && sample.last().is_some_and(|last| at > 0 && *last == parts[at - 1]) {
                if belongs_to_sample(&parts[at..]) {
                    sample.push(part);
                    continue;
                }
                label.numbered = part.parse().ok().map(|n| ([&sample[..], &[part]].concat().join("-"), n));
            }
            let known = label.take(part, vocabulary) || label.take_with_number(part, vocabulary);
            if !known && !begun {
                sample.push(part);
            } else if !known && !part.starts_with(|c: char| c.is_ascii_digit()) && part.chars().count() > 1 {
                label.rest.push((*part).to_string());
            }
            label.unknown |= !known;
            begun |= label.test.is_some() || label.direction.is_some() || label.specimen.is_some();
        }
        label.across = label.direction.is_some() && vocabulary.is_across_in_name(&text);
        if label.conflict.is_some() || label.across {
            label.direction = None;
        }
        label.sample = (!sample.is_empty()).then(|| sample.join("-"));
        label
    }

    /// `self` where it says something, else `other`; the sample is a file name's, not a sheet's.
    pub fn or(self, other: Self) -> Self {
        Self {
            sample: other.sample,
            test: self.test.or(other.test),
            direction: self.direction.or(other.direction.filter(|_| !self.across)),
            specimen: self.specimen.or(other.specimen),
            conflict: if self.direction.is_some() { None } else { self.conflict.or(other.conflict) },
            across: self.across || (other.across && self.direction.is_none()),
            unknown: self.unknown || other.unknown,
            numbered: other.numbered,
            rest: other.rest,
        }
    }

    /// Whether it is nothing but direction, test and number.
    pub fn is_plain(&self) -> bool {
        !self.unknown && self.conflict.is_none() && (self.direction.is_some() || self.specimen.is_some())
    }

    fn turn(&mut self, direction: Direction) {
        match self.direction {
            Some(other) if other != direction => self.conflict = self.conflict.or(Some([other, direction])),
            _ => self.direction = Some(direction),
        }
    }

    fn take(&mut self, part: &str, vocabulary: Vocabulary<'_>) -> bool {
        if is_number(part) && !part.is_empty() {
            // A longer number is a date or an order; and a number alone is no angle.
            self.specimen = part.parse().ok().filter(|n| *n < SPECIMENS).or(self.specimen);
        } else if let Some(direction) = vocabulary.direction_exactly(part) {
            self.turn(direction);
        } else if let Some(test) = vocabulary.test_exactly(part) {
            self.test = self.test.or(Some(test));
        } else {
            let word = normalised(part);
            return matches!(word.as_str(), "kes" | "kesf" | "fb1" | "fb4" | "no")
                || vocabulary.key(part) == Some(HeaderKey::Specimen);
        }
        true
    }

    /// `経1`, `warp2`: a direction or "specimen" with a number behind it.
    fn take_with_number(&mut self, part: &str, vocabulary: Vocabulary<'_>) -> bool {
        let word = part.trim_end_matches(|c: char| c.is_ascii_digit());
        let known = word != part
            && (vocabulary.direction_exactly(word).is_some()
                || vocabulary.key(word) == Some(HeaderKey::Specimen));
        known && self.take(word, vocabulary) && self.take(&part[word.len()..], vocabulary)
    }
}

/// Whether the number right behind a sample is a part of its name: it is none of a specimen, or that follows as the last part,
/// `Lot 3 weft 1`. Numbers that follow one another are a date.
fn belongs_to_sample(parts: &[&str]) -> bool {
    let [first, rest @ ..] = parts else { return false };
    let Some(number) = first.parse::<usize>().ok().filter(|n| is_number(first) && *n < SPECIMENS) else {
        return false;
    };
    let is_date = rest.first().is_some_and(|part| is_number(part));
    !is_date && (number > COUNTED || rest.last().is_some_and(|part| is_number(part)))
}

fn is_number(part: &str) -> bool {
    part.bytes().all(|b| b.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_carry_metadata() {
        let label = |t| Label::parse(t, Vocabulary::new(&[]));
        let l = label("F01_warp_FB2_1");
        assert_eq!(l.sample.as_deref(), Some("F01"));
        assert_eq!((l.test, l.direction, l.specimen), (Some(Test::Bending), Some(Direction::Warp), Some(1)));
        assert_eq!((label("経-1").direction, label("経-1").specimen), (Some(Direction::Warp), Some(1)));
        assert_eq!((label("タテ2").direction, label("タテ2").specimen), (Some(Direction::Warp), Some(2)));
        assert_eq!(label("試料番号 3").specimen, Some(3));
        assert_eq!(label("fb1-shear-weft-2").test, Some(Test::Shear));
        assert_eq!(label("poplin_20240105_warp").specimen, None);
        assert_eq!(label("poplin_20240105_warp").sample.as_deref(), Some("poplin"));
        assert_eq!(label("経方向-3").direction, Some(Direction::Warp));
        for (name, sample, specimen) in [
            ("Lot 3_weft_1", Some("Lot-3"), Some(1)),
            ("PES-150_weft_2", Some("PES-150"), Some(2)),
            ("Style 501_warp", Some("Style-501"), None),
            ("Uno_3_warp", Some("Uno"), Some(3)),
            ("Uno_2024-05-12_warp_3", Some("Uno"), Some(3)),
            ("2024-05-12 Uno_warp_3", None, Some(3)),
            ("Uno 20240512 warp 3", Some("Uno"), Some(3)),
            ("Uno_warp_501", Some("Uno"), Some(501)),
        ] {
            let label = label(name);
            assert_eq!((label.sample.as_deref(), label.specimen), (sample, specimen), "{name}");
        }
        assert_eq!(label("Lot 3_weft").numbered, Some(("Lot-3".to_string(), 3)));
        assert_eq!(label("warp_Alpha_1_b").rest, ["Alpha"]);
    }

    /// A number is an angle only when it is said to be one, and two directions are none.
    #[test]
    fn numbers_are_no_angles_and_two_directions_are_none() {
        let direction = |t| Label::parse(t, Vocabulary::new(&[])).direction;
        for (name, expected) in [
            ("45_warp_FB2_1", Some(Direction::Warp)),
            ("sample 45", None),
            ("Ne40-45_FB2", None),
            ("T 45 FB2", None),
            ("course_warp", None),
            ("warp_weft_FB2", None),
            ("poplin_45deg_FB2", Some(Direction::Bias)),
            ("poplin 45° FB2", Some(Direction::Bias)),
            ("poplin_bias45_FB2", Some(Direction::Bias)),
            ("bias 45 FB2", Some(Direction::Bias)),
        ] {
            assert_eq!(direction(name), expected, "{name}");
        }
    }

    #[test]
    fn a_name_that_is_across_a_direction_states_none() {
        let label = |t| Label::parse(t, Vocabulary::new(&[]));
        for name in [
            "Uno_perpendicular to warp",
            "Uno normal to the warp yarns 1",
            "Uno not warp",
            "Uno_90° to warp",
            "Uno_senkrecht zur Kette",
            "Uno_zur Kette senkrecht",
            "perpendiculaire à la chaîne",
            "perpendicolare all'ordito",
            "perpendicular a la urdimbre",
            "across warp",
        ] {
            assert!(label(name).across && label(name).direction.is_none(), "{name}");
        }
        for name in ["90_warp", "non-crimp_warp_1", "warp_not washed", "Uno along the warp"] {
            assert_eq!(label(name).direction, Some(Direction::Warp), "{name}");
        }
    }
}
