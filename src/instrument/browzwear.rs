//! The physics file of U3M 1.1 without raw data: the values of Browzwear's block, as its help defines them.
//!
//! | key | meaning | unit |
//! |---|---|---|
//! | `bend.length`, `bend.width` | bending rigidity along the grain line and across it | dyn·cm |
//! | `stretch.length`, `stretch.width` | force per width at twice the length, of a linear fabric | N/m |
//! | `mass`, `thickness` | | g/m², mm |
//!
//! (help.browzwear.com, *Physics Reference*.) They are what a program made of a record, so that all are inferred. Shear,
//! linearities and friction have no published definition, and are left out.

use std::path::Path;

use serde_json::Value;

use super::error::{ReadError, ReadProblem};
use super::fab::as_number;
use super::{Direction, Parameter, ResultValue, StatedStiffness};
use crate::finding::Place;
use crate::kes::ValueStatus;

/// A dyn times a cm (N·m).
const DYN_CM: f64 = 1e-7;

/// The fabric, by its name, and its values.
pub(super) struct Block {
    pub results: Vec<(Option<String>, ResultValue)>,
    pub stiffnesses: Vec<(Option<String>, StatedStiffness)>,
}

impl Block {
    /// What was read, for people.
    pub fn summary(&self) -> String {
        let symbols: Vec<&str> = self.results.iter().map(|(_, value)| value.parameter.symbol()).collect();
        format!("{} and {} tensile stiffnesses", symbols.join(", "), self.stiffnesses.len())
    }
}

/// The block of a document whose `raw_data` is null; `None` of all other documents.
///
/// # Errors
/// R023 if there is no block, or nothing in it that is understood, or a value is no number above zero.
pub(super) fn parse(path: &Path, text: &str) -> Result<Option<Block>, ReadError> {
    let Ok(document) = serde_json::from_str::<Value>(text) else { return Ok(None) };
    if document.get("raw_data") != Some(&Value::Null) {
        return Ok(None);
    }
    let bad = |reason: String| ReadError::new(Place::file(path), ReadProblem::BadFab { reason });
    let block = document.pointer("/custom/browzwear").filter(|block| block.is_object());
    let block =
        block.ok_or_else(|| bad("`raw_data` is null, and there is no block `custom.browzwear`".into()))?;
    let name = block.get("name").and_then(Value::as_str).map(str::to_string);
    let number = |at: &str| {
        let Some(value) = block.pointer(at).filter(|value| !value.is_null()) else { return Ok(None) };
        let number = as_number(value).filter(|number| *number > 0.0);
        let place = at.replace('/', ".");
        number.map(Some).ok_or_else(|| {
            bad(format!("custom.browzwear{place} is {value}, where a number above zero was expected"))
        })
    };
    let mut out = Block { results: Vec::new(), stiffnesses: Vec::new() };
    let warp_and_weft = [("length", Some(Direction::Warp)), ("width", Some(Direction::Weft))];
    let bend =
        warp_and_weft.map(|(key, direction)| (format!("/bend/{key}"), Parameter::B, direction, DYN_CM));
    let others = [("/mass", Parameter::W, 1e-3), ("/thickness", Parameter::T0, 1e-3)];
    let others = others.map(|(at, parameter, unit)| (at.to_string(), parameter, None, unit));
    for (at, parameter, direction, unit) in bend.into_iter().chain(others) {
        if let Some(value) = number(&at)? {
            out.results.push((name.clone(), inferred(path, parameter, direction, unit * value)));
        }
    }
    for (key, direction) in warp_and_weft {
        if let (Some(stiffness), Some(direction)) = (number(&format!("/stretch/{key}"))?, direction) {
            let what = "Browzwear, whose stretch is that of a linear fabric".to_string();
            let place = Place::file(path);
            let stated = StatedStiffness { direction, loads: None, stiffness, what, place };
            out.stiffnesses.push((name.clone(), stated));
        }
    }
    if out.results.is_empty() {
        return Err(bad(
            "`raw_data` is null, and `custom.browzwear` has neither bend, mass nor thickness".into()
        ));
    }
    Ok(Some(out))
}

fn inferred(path: &Path, parameter: Parameter, direction: Option<Direction>, mean: f64) -> ResultValue {
    let place = Place::file(path);
    let (sd, values, lines) = (None, Vec::new(), Vec::new());
    ResultValue { parameter, direction, mean, sd, n: 1, values, lines, status: ValueStatus::Inferred, place }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = r#"{"schema": "1.1", "raw_data": null, "custom": {"browzwear": {"name": "cupro",
        "bend": {"length": "43", "width": "53"}, "stretch": {"length": "588", "width": "1035"}, "mass": "105.6",
        "thickness": 0.12, "shear": "40"}}}"#;

    /// The numbers of the cupro of the U3M repository; 1 dyn·cm is 1e-7 N·m.
    #[test]
    fn values_have_the_units_of_the_help() {
        let block = parse(Path::new("cupro.json"), FILE).unwrap().unwrap();
        let rounded = |(name, v): &(Option<String>, ResultValue)| {
            assert!(v.status == ValueStatus::Inferred && name.as_deref() == Some("cupro"));
            (v.parameter.symbol(), v.direction, (v.mean * 1e9).round())
        };
        let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
        let expected =
            [("B", warp, 4300.0), ("B", weft, 5300.0), ("W", None, 105_600_000.0), ("T0", None, 120_000.0)];
        assert_eq!(block.results.iter().map(rounded).collect::<Vec<_>>(), expected);
        let stiffness: Vec<_> = block.stiffnesses.iter().map(|(_, s)| (s.direction, s.stiffness)).collect();
        assert_eq!(stiffness, [(Direction::Warp, 588.0), (Direction::Weft, 1035.0)]);
    }

    #[test]
    fn what_is_no_block_is_told() {
        let none = |text: &str| parse(Path::new("a.json"), text).unwrap().is_none();
        assert!(none("{") && none("{}") && none(r#"{"raw_data": {"L": {}}}"#));
        for (from, to, said) in [
            ("\"browzwear\"", "\"other\"", "no block `custom.browzwear`"),
            ("\"43\"", "\"soft\"", "custom.browzwear.bend.length is \"soft\""),
            ("\"1035\"", "-1035", "custom.browzwear.stretch.width is -1035"),
        ] {
            let error =
                parse(Path::new("a.json"), &FILE.replace(from, to)).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains("R023") && error.contains(said), "{error}");
        }
    }
}
