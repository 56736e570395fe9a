//! What a laboratory could write so that an unknown layout becomes known.

use std::collections::BTreeMap;

use super::context::Context;
use super::dialect::Role;
use super::error::{ReadError, ReadProblem};
use super::raw::Row;
use super::row_kind::is_value;
use super::unit_text::{is_angular, split_unit, unit};
use super::vocabulary::Vocabulary;
use super::words::folded;
use crate::quantity::{Dimension, divides_by_length};

/// What is wrong with a file of which no row was taken: R006 where a row has a number, R002 where none has.
pub(super) fn not_read(rows: &[Row<'_>], context: &Context<'_>) -> ReadError {
    let Some(at) = rows.iter().position(|row| has_value(row, context)) else {
        return context.error(0, 0, ReadProblem::Empty);
    };
    let above = rows[..at].iter().rfind(|row| !row.is_blank()).unwrap_or(&rows[at]);
    let words: Vec<String> = above.filled().map(|(_, c)| folded(&c.text).into_owned()).collect();
    let found = format!(
        "{:?} is over the numbers; a column of values is named by a symbol and its unit, B (gf·cm²/cm), beside a column of names or directions",
        words.join(" | ")
    );
    context.error(above.line, above.column(0), ReadProblem::UnknownLayout { found })
}

/// Whether a cell is a number, or begins with one: `0.0812/0.0533`.
fn has_value(row: &Row<'_>, context: &Context<'_>) -> bool {
    row.filled().any(|(_, cell)| {
        let begins =
            cell.text.starts_with(|c: char| c.is_ascii_digit()) && cell.text.contains(context.decimal);
        begins || is_value(&cell.text, context)
    })
}

pub(super) fn unknown_layout(context: &Context<'_>, row: &Row<'_>, words: &[String]) -> ReadError {
    let (problem, inference) = unknown_words(words, context.vocabulary);
    let mut error = context.error(row.line, row.column(0), problem);
    error.about.inference = inference;
    error
}

/// What R006 says of words over a row of numbers, and what a laboratory could write so that they are known.
fn unknown_words(words: &[String], vocabulary: Vocabulary<'_>) -> (ReadProblem, Vec<String>) {
    let closest = vocabulary.closest(words);
    let found = match closest.first().filter(|_| !words.is_empty()) {
        None => "numbers stand without a heading row".to_string(),
        Some((name, unknown)) => {
            format!("dialect {name:?} comes closest, but it does not know {}", unknown.join(", "))
        }
    };
    (ReadProblem::UnknownLayout { found }, layout(words, &closest))
}

/// What the dialects know of a heading row, and a dialect file that names the rest, ready to be saved: the unit of a
/// column often tells what it holds; where it does not, the line is left as a remark.
fn layout(words: &[String], closest: &[(&str, Vec<&str>)]) -> Vec<String> {
    if words.is_empty() {
        return vec!["a dialect file that names columns without headings: column_order = [\"curvature\", \"moment\"], and [units]".into()];
    }
    let mut lines = vec![format!("headings {}", words.join(" | "))];
    for (name, unknown) in closest.iter().filter(|(_, unknown)| unknown.len() < words.len()) {
        let known: Vec<&str> = words.iter().map(String::as_str).filter(|w| !unknown.contains(w)).collect();
        let missing = if unknown.is_empty() { "nothing".to_string() } else { unknown.join(", ") };
        lines.push(format!("dialect {name}: knows {}; does not know {missing}", known.join(", ")));
    }
    let unknown = closest.first().map(|(_, unknown)| unknown.as_slice()).unwrap_or_default();
    lines.push("a dialect file, to be saved as dialect.toml beside the data and completed:".to_string());
    lines.extend(dialect_file(unknown, words).lines().map(|line| format!("    {line}")));
    lines
}

/// A dialect file with a line for every unknown heading, of all that stand over the numbers.
fn dialect_file(unknown: &[&str], all: &[String]) -> String {
    let mut roles: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    let mut open = Vec::new();
    let stated: Vec<&str> = all.iter().filter_map(|heading| held(heading)).collect();
    // Micrometres over the sweep of a surface are its height, and beside a pressure a thickness.
    let is_surface = stated.contains(&"height") && !stated.contains(&"pressure");
    for heading in unknown {
        let (name, _) = split_unit(heading);
        match held(heading) {
            Some("displacement") if is_surface => roles.entry("position").or_default().push(name),
            Some("height") if !is_surface => roles.entry("thickness").or_default().push(name),
            Some(role) => roles.entry(role).or_default().push(name),
            None => open.push(name),
        }
    }
    let mut out = "name = \"laboratory\"\n\n[columns]\n".to_string();
    for (role, names) in roles {
        out += &format!("{role} = {names:?}\n");
    }
    for name in open {
        out += &format!("# {CHOICE} = [{name:?}]\n");
    }
    out
}

/// What a heading holds, as far as its unit tells.
fn held(heading: &str) -> Option<&'static str> {
    role(&split_unit(heading).1?)
}

/// What a column may be, in the spelling of dialect files.
const CHOICE: &str = "strain, angle, curvature, thickness, displacement, force, shear_force, moment, pressure, position, height, \
                      friction_coefficient, friction_force or ignored";

/// The column that has such a unit, in the spelling of dialect files.
fn role(text: &str) -> Option<&'static str> {
    let stated = unit(text).ok()?;
    let is_angle = is_angular(text);
    let is = |role: Role| unit(role.kes_unit()).is_ok_and(|u| u.dimension == stated.dimension);
    const MOMENT: Dimension = Dimension { kg: 1, m: 2, s: -2 };
    match () {
        () if is_angle && is(Role::Angle) => Some("angle"),
        () if is_angle => None,
        () if is(Role::Strain) => Some("strain"),
        () if is(Role::Curvature) => Some("curvature"),
        () if is(Role::Height) && stated.factor < 1e-4 => Some("height"),
        () if is(Role::Displacement) => Some("displacement"),
        () if is(Role::Force) => Some("force"),
        () if is(Role::Pressure) => Some("pressure"),
        // gf·cm/cm is a force by its dimension; plain gf is one that was not divided by the width. gf·cm²/cm is
        // a moment by its dimension, and the unit of B.
        () if is(Role::Moment) && divides_by_length(text) => Some("moment"),
        () if stated.dimension == MOMENT && !divides_by_length(text) => Some("moment"),
        () if is(Role::Moment) => Some("force"),
        () => None,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::instrument::Dialect;

    #[test]
    fn a_unit_tells_what_a_column_holds() {
        for (heading, expected) in [
            ("foo (1/cm)", "curvature"),
            ("bar (gf·cm/cm)", "moment"),
            ("M [mN·m]", "moment"),
            ("F (gf)", "force"),
            ("F (gf/cm)", "force"),
            ("phi2 (deg)", "angle"),
            ("e (%)", "strain"),
            ("s (mm)", "displacement"),
            ("p (gf/cm²)", "pressure"),
            ("h (um)", "height"),
        ] {
            let text = dialect_file(&[heading], &[heading.to_string()]);
            let dialect = Dialect::from_toml(&text).unwrap();
            let role = format!("{:?}", dialect.columns.keys().next().unwrap()).to_lowercase();
            assert_eq!(role, expected, "{heading}");
        }
        for heading in ["foo", "foo (kg)", "foo (gf·cm²/cm)"] {
            let dialect = Dialect::from_toml(&dialect_file(&[heading], &[heading.to_string()])).unwrap();
            assert!(dialect.columns.is_empty(), "{heading}");
        }
        for (headings, expected) in [
            (["x (mm)", "h (µm)"], [Role::Position, Role::Height]),
            (["p (gf/cm²)", "h (µm)"], [Role::Thickness, Role::Pressure]),
        ] {
            let dialect = Dialect::from_toml(&dialect_file(&headings, &headings.map(String::from))).unwrap();
            assert_eq!(dialect.columns.into_keys().collect::<Vec<_>>(), expected);
        }
    }

    /// What is offered for a column are the words that a dialect file takes.
    #[test]
    fn every_column_is_offered() {
        let offered: BTreeSet<Role> = CHOICE
            .replace(" or ", ", ")
            .split(", ")
            .flat_map(|word| {
                let text = format!("name = \"x\"\n\n[columns]\n{word} = [\"y\"]\n");
                Dialect::from_toml(&text).unwrap().columns.into_keys()
            })
            .collect();
        let schema = serde_json::to_value(schemars::schema_for!(Role)).unwrap();
        assert_eq!(Some(offered.len()), schema["oneOf"].as_array().map(Vec::len), "{schema}");
    }
}
