//! The lines of the suite from the TOML files that are compiled in.

use serde::Deserialize;
use toml::{Table, Value};

use super::line::{Expected, Kind, Line, Reference, Tolerance};
use super::problem::VerifyProblem;

const FILES: [&str; 12] = [
    include_str!("suite/element.toml"),
    include_str!("suite/patch.toml"),
    include_str!("suite/plates.toml"),
    include_str!("suite/accuracy.toml"),
    include_str!("suite/orthotropic.toml"),
    include_str!("suite/rectangles.toml"),
    include_str!("suite/skew.toml"),
    include_str!("suite/shells.toml"),
    include_str!("suite/membrane.toml"),
    include_str!("suite/dynamics.toml"),
    include_str!("suite/fourth_order.toml"),
    include_str!("suite/large.toml"),
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    line: Vec<Entry>,
}

/// One line, or several that differ in some parameters.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entry {
    id: String,
    quantity: String,
    /// One key: the family; its value: the parameters.
    problem: Table,
    /// Parameter (dotted path) and its values, or several in alphabetical order: every combination, the
    /// last parameter fastest.
    #[serde(default)]
    vary: Table,
    reference: References,
    tolerance: Tolerance,
    #[serde(default)]
    expect: Expectations,
    /// What the publication that makes the claim prints.
    published: Option<f64>,
    kind: Kind,
    citation: String,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Expectations {
    /// The same for every combination.
    One(Expected),
    /// One for each combination.
    Each(Vec<Expected>),
}

impl Default for Expectations {
    fn default() -> Self {
        Self::One(Expected::Within)
    }
}

#[derive(Deserialize)]
#[serde(untagged)]
enum References {
    /// The same for every combination.
    One(Reference),
    /// One for each combination.
    Each(Vec<Reference>),
}

/// Every line of the suite, in the order of its files.
///
/// # Panics
/// Only if the files that are compiled into the program are malformed; a test reads them.
pub fn suite() -> Vec<Line> {
    FILES
        .iter()
        .flat_map(|text| toml::from_str::<File>(text).expect("built-in suite").line)
        .flat_map(Entry::expand)
        .collect()
}

impl Entry {
    pub fn expand(self) -> Vec<Line> {
        let mut variants = vec![(self.id.clone(), self.problem.clone())];
        for (path, values) in &self.vary {
            let values = values.as_array().cloned().unwrap_or_default();
            variants = variants
                .into_iter()
                .flat_map(|(id, problem)| {
                    values
                        .iter()
                        .map(move |v| (suffixed(&id, path, v), with(&problem, path, v)))
                        .collect::<Vec<_>>()
                })
                .collect();
        }
        let references = match self.reference {
            References::One(r) => vec![r; variants.len()],
            References::Each(each) => each,
        };
        assert_eq!(references.len(), variants.len(), "built-in suite: references of {}", self.id);
        let expected = match self.expect {
            Expectations::One(e) => vec![e; variants.len()],
            Expectations::Each(each) => each,
        };
        assert_eq!(expected.len(), variants.len(), "built-in suite: expectations of {}", self.id);
        variants
            .into_iter()
            .zip(references.into_iter().zip(expected))
            .map(|((id, problem), (reference, expected))| Line {
                problem: problem
                    .try_into::<VerifyProblem>()
                    .unwrap_or_else(|e| panic!("built-in suite: {id}: {e}")),
                id,
                quantity: self.quantity.clone(),
                reference,
                tolerance: self.tolerance,
                expected,
                published: self.published,
                kind: self.kind,
                citation: self.citation.clone(),
            })
            .collect()
    }
}

/// `id.n=4`, by the last part of the parameter's path.
fn suffixed(id: &str, path: &str, value: &Value) -> String {
    let name = path.rsplit('.').next().unwrap_or(path);
    let value = value.as_str().map_or_else(|| value.to_string(), str::to_string);
    format!("{id}.{name}={value}")
}

/// The problem with one parameter of its family set.
pub(super) fn with(problem: &Table, path: &str, value: &Value) -> Table {
    let mut problem = problem.clone();
    let mut at = problem.iter_mut().next().map(|(_, parameters)| parameters);
    for key in path.split('.') {
        at = at.and_then(Value::as_table_mut).map(|t| t.entry(key).or_insert_with(|| Table::new().into()));
    }
    if let Some(at) = at {
        *at = value.clone();
    }
    problem
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn the_suite_parses_and_no_id_is_given_twice() {
        let lines = suite();
        let ids: BTreeSet<_> = lines.iter().map(|l| l.id.as_str()).collect();
        assert_eq!(ids.len(), lines.len());
        assert!(lines.iter().all(|l| !l.citation.is_empty() && !l.quantity.is_empty()));
    }
}
