//! What a file that was read holds.

use kesf::instrument::{Direction, FileContent, Parameter};

/// The findings of a code, a line each.
pub fn findings_of(content: &FileContent, code: &str) -> String {
    let found: Vec<String> =
        content.findings.iter().filter(|f| f.code() == code).map(ToString::to_string).collect();
    found.join("\n")
}

/// The mean of the only value of a parameter and direction.
pub fn value(content: &FileContent, parameter: Parameter, direction: Option<Direction>) -> f64 {
    let same: Vec<_> = content
        .results
        .iter()
        .filter(|(_, r)| r.parameter == parameter && r.direction == direction)
        .collect();
    assert_eq!(same.len(), 1, "{parameter} {direction:?}: {:?}", content.results);
    same[0].1.mean
}
