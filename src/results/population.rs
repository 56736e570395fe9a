//! The population of the control chart, from a file or a folder of results.

use std::path::Path;

use serde::Deserialize;

use super::failure::Failure;
use crate::finding::{Place, in_words};
use crate::platform::files;
use crate::report::population::{Population, PopulationError, Written, of_csv, of_written};

/// The table of a folder of results.
const TABLE: &str = "fabrics.csv";

/// A population in TOML.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    source: String,
    parameters: Vec<toml::Spanned<Written>>,
}

/// Reads a population: TOML with mean and SD of each parameter, CSV of the same or as `fabrics.csv`, or a folder that
/// `kesf run` wrote.
///
/// # Errors
/// O074 with the place, for what cannot be read or used.
pub fn population(path: &Path) -> Result<Population, Failure> {
    let table = if files::is_folder(path) { path.join(TABLE) } else { path.to_path_buf() };
    let refused = |problem: PopulationError| {
        let place = Place { path: table.clone(), line: problem.line, ..Place::default() };
        let failure = Failure::new("O074", format!("no population of fabrics: {}", problem.message));
        failure.at(place).hint("`kesf explain O074` shows what such a file looks like")
    };
    let unreadable = |e: std::io::Error| refused(PopulationError { line: 0, message: e.to_string() });
    let bytes = files::read(&table).map_err(unreadable)?;
    if table.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        return of_toml(&bytes).map_err(refused);
    }
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    of_csv(&bytes, &name).map_err(refused)
}

fn of_toml(bytes: &[u8]) -> Result<Population, PopulationError> {
    let text = std::str::from_utf8(bytes).map_err(|e| PopulationError { line: 0, message: e.to_string() })?;
    let line_at = |at: usize| 1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count();
    let document: Document = toml::from_str(text).map_err(|e| PopulationError {
        line: e.span().map_or(0, |span| line_at(span.start)),
        message: in_words(&e),
    })?;
    let written = document.parameters.iter().map(|row| (line_at(row.span().start), row.get_ref()));
    of_written(written, &document.source)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_says_where_it_is_wrong() {
        let good = "source = \"212 shirtings\"\n[[parameters]]\nparameter = \"log B\"\nmean = -1.0\nsd = 0.2\nunit = \"gf·cm²/cm\"\n";
        let found = of_toml(good.as_bytes()).unwrap();
        assert_eq!((found.source.as_str(), found.parameters.len()), ("212 shirtings", 1));
        let bad = of_toml(good.replace("log B", "log Q").as_bytes()).unwrap_err();
        assert_eq!(bad.line, 2, "{bad:?}");
        let unknown = of_toml(good.replace("sd =", "sdev =").as_bytes()).unwrap_err();
        assert!(unknown.line > 1 && unknown.message.contains("sdev"), "{unknown:?}");
        assert!(of_toml(&good.as_bytes()[24..]).unwrap_err().message.contains("source"));
    }
}
