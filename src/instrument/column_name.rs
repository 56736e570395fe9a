//! The name of a curve's column: its role, and the direction, specimen and branch that stand in it.
//!
//! `Warp-1 K`, `K_warp`, `曲率 経 2`, `force (unloading)`: what is left when these are taken out names the role.

use super::Direction;
use super::dialect::{BranchColumn, Role};
use super::factor;
use super::label::SPECIMENS;
use super::unit_text::is_scaled;
use super::vocabulary::{HEADING, Vocabulary};
use super::words::normalised;

/// What the name of a column says.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ColumnName {
    pub role: Option<Role>,
    pub direction: Option<Direction>,
    /// The direction that a word would be which may be a dimension as well: `width` in `force per width`.
    pub dimension: Option<Direction>,
    pub specimen: Option<usize>,
    pub branch: Option<BranchColumn>,
    /// The words that stand in it beside these, those of the role with them.
    pub words: String,
}

impl ColumnName {
    /// Reads a name without its unit.
    pub fn of(name: &str, vocabulary: Vocabulary<'_>) -> Self {
        if name.chars().count() > HEADING || is_scaled(name) {
            return Self::default();
        }
        if let Some(found) = Self::signed(name, vocabulary) {
            return found;
        }
        if let Some(role) = vocabulary.role_exactly(name) {
            return Self { role: Some(role), words: long_words(name.split(is_no_letter)), ..Self::default() };
        }
        let words: Vec<&str> = name.split(is_no_letter).filter(|w| !w.is_empty()).collect();
        let mut found = Self::default();
        let mut rest: Vec<&str> = Vec::new();
        let mut i = 0;
        while i < words.len() {
            let pair = words.get(i..i + 2).map(|w| w.join(" "));
            if let Some(branch) = pair.and_then(|p| vocabulary.branch(&p)) {
                found.branch = Some(branch);
                i += 2;
                continue;
            }
            if !found.take(words[i], vocabulary) {
                rest.push(words[i]);
            }
            i += 1;
        }
        found.words = long_words(rest.iter().copied());
        let rest = rest.join(" ");
        found.role = vocabulary.role(&rest).or_else(|| vocabulary.role(name));
        // Nobody can say whether a factor in a name was applied.
        if found.role.is_some() && factor::in_heading(name, vocabulary) { Self::default() } else { found }
    }

    /// `Force+` and `Force-`: a load that grows, and one that falls.
    fn signed(name: &str, vocabulary: Vocabulary<'_>) -> Option<Self> {
        let stem = name.trim_end().strip_suffix(['+', '-', '−', '–'])?;
        let role = vocabulary.role_exactly(stem).filter(|r| matches!(r, Role::Force | Role::Pressure))?;
        let up = name.trim_end().ends_with('+');
        let branch = Some(if up { BranchColumn::Loading } else { BranchColumn::Unloading });
        Some(Self { role: Some(role), branch, ..Self::default() })
    }

    fn take(&mut self, word: &str, vocabulary: Vocabulary<'_>) -> bool {
        let number = |t: &str| t.parse().ok().filter(|n| (1..SPECIMENS).contains(n));
        let stem = word.trim_end_matches(|c: char| c.is_ascii_digit());
        let digits = &word[stem.len()..];
        if stem.is_empty() {
            let new = self.specimen.is_none();
            self.specimen = self.specimen.or(number(digits));
            return new && self.specimen.is_some();
        }
        if let Some(direction) = vocabulary.direction_exactly(stem) {
            if vocabulary.is_dimension(stem) {
                self.dimension = self.dimension.or(Some(direction));
                return true;
            }
            if self.direction.is_some() {
                return false;
            }
            self.direction = Some(direction);
            self.specimen = self.specimen.or(number(digits));
            return true;
        }
        if let Some(branch) = vocabulary.branch(word).filter(|_| self.branch.is_none()) {
            // `load` may be the force itself: then nothing else names the role.
            self.branch = Some(branch);
            return vocabulary.role_exactly(word).is_none();
        }
        false
    }
}

fn is_no_letter(c: char) -> bool {
    !c.is_alphanumeric()
}

/// Words as one; a letter numbers specimens as well, and says nothing: `moment A`, `moment B`.
fn long_words<'w>(words: impl Iterator<Item = &'w str>) -> String {
    let words: Vec<&str> = words.filter(|word| word.chars().nth(1).is_some()).collect();
    normalised(&words.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_everything_in_them() {
        let parsed = |t| ColumnName::of(t, Vocabulary::new(&[]));
        let warp = Some(Direction::Warp);
        for (text, specimen) in [("Warp-1 K", Some(1)), ("K_warp", None), ("曲率 経 2", Some(2))] {
            let found = parsed(text);
            assert_eq!((found.role, found.direction), (Some(Role::Curvature), warp), "{text}");
            assert_eq!((found.specimen, found.branch), (specimen, None), "{text}");
        }
        assert_eq!(parsed("moment 2").specimen, Some(2));
        let unload = parsed("Tensile force unloading");
        assert_eq!((unload.role, unload.branch), (Some(Role::Force), Some(BranchColumn::Unloading)));
        assert_eq!(parsed("load").role, Some(Role::Force));
        assert_eq!(parsed("Biegemoment").role, Some(Role::Moment));
        for (text, role) in [("moment per unit width", Role::Moment), ("longitudinal strain", Role::Strain)] {
            assert_eq!((parsed(text).role, parsed(text).direction), (Some(role), None), "{text}");
        }
        assert_eq!(parsed("moment per width, warp").direction, warp);
        assert_eq!(parsed("foo").role, None);
    }
}
