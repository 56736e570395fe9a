//! What a laboratory could write so that an unknown layout becomes known.

use super::dialect::Role;
use super::unit_text::{split_unit, unit};
use crate::quantity::{Dimension, divides_by_length};

/// What every dialect knows of a heading row, and the lines of a dialect file that would name the
/// rest: the unit of a column often tells what it holds.
pub(super) fn layout(words: &[String], closest: &[(String, Vec<String>)]) -> Vec<String> {
    if words.is_empty() {
        return vec!["a dialect file that names columns without headings: column_order = [\"curvature\", \"moment\"], and [units]".into()];
    }
    let mut lines = vec![format!("headings {}", words.join(" | "))];
    for (name, unknown) in closest {
        let known: Vec<&str> = words.iter().filter(|w| !unknown.contains(w)).map(String::as_str).collect();
        let known = if known.is_empty() { "nothing".to_string() } else { known.join(", ") };
        lines.push(format!("dialect {name}: knows {known}; does not know {}", unknown.join(", ")));
    }
    let unknown = closest.first().map(|(_, unknown)| unknown.as_slice()).unwrap_or_default();
    let named: Vec<String> = unknown.iter().filter_map(|heading| entry(heading)).collect();
    if named.is_empty() {
        let names = unknown.iter().map(|w| format!("... = [{:?}]", split_unit(w).0)).collect::<Vec<_>>();
        lines.push(format!(
            "no unit tells what the unknown columns hold; a dialect file names them: [columns] {}",
            names.join(", ")
        ));
    } else {
        lines.push(format!(
            "a dialect file may say, if the units guess right: [columns] {}",
            named.join(", ")
        ));
    }
    lines
}

/// `curvature = ["foo"]` for the heading `foo (1/cm)`.
fn entry(heading: &str) -> Option<String> {
    let (name, unit) = split_unit(heading);
    let role = role(&unit?)?;
    Some(format!("{role} = [{name:?}]"))
}

/// The column that has such a unit, in the spelling of dialect files.
fn role(text: &str) -> Option<&'static str> {
    let of = unit(text).ok()?;
    let is_angle = ["deg", "rad", "°", "度"].iter().any(|a| text.contains(a));
    let is = |role: Role| unit(role.kes_unit()).is_ok_and(|u| u.dimension == of.dimension);
    const MOMENT: Dimension = Dimension { kg: 1, m: 2, s: -2 };
    match () {
        () if is_angle && is(Role::Angle) => Some("angle"),
        () if is_angle => None,
        () if is(Role::Strain) => Some("strain"),
        () if is(Role::Curvature) => Some("curvature"),
        () if is(Role::Displacement) => Some("displacement"),
        () if is(Role::Force) => Some("force"),
        () if is(Role::Pressure) => Some("pressure"),
        // gf·cm/cm is a force by its dimension; plain gf is one that was not divided by the width. gf·cm²/cm is
        // a moment by its dimension, and the unit of B.
        () if is(Role::Moment) && divides_by_length(text) => Some("moment"),
        () if of.dimension == MOMENT && !divides_by_length(text) => Some("moment"),
        () if is(Role::Moment) => Some("force"),
        () => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_tells_what_a_column_holds() {
        for (heading, expected) in [
            ("foo (1/cm)", "curvature = [\"foo\"]"),
            ("bar (gf·cm/cm)", "moment = [\"bar\"]"),
            ("M [mN·m]", "moment = [\"M\"]"),
            ("F (gf)", "force = [\"F\"]"),
            ("F (gf/cm)", "force = [\"F\"]"),
            ("phi2 (deg)", "angle = [\"phi2\"]"),
            ("e (%)", "strain = [\"e\"]"),
            ("s (mm)", "displacement = [\"s\"]"),
            ("p (gf/cm²)", "pressure = [\"p\"]"),
        ] {
            assert_eq!(entry(heading).as_deref(), Some(expected), "{heading}");
        }
        assert_eq!(entry("foo"), None);
        assert_eq!(entry("foo (kg)"), None);
        assert_eq!(entry("foo (gf·cm²/cm)"), None);
    }
}
