//! Fabrics as material files of other programs.

use std::borrow::Cow;

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::file_name::{file_name, is_device, on_disk};
use super::folder::Sink;
use super::observer::Observer;
use super::section::Sectioned;
use crate::finding::Place;
use crate::quantity::Ratio;
use crate::report::cards::{CardInput, Target, card, named};

/// The material file of a fabric.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FabricCard {
    /// Its name.
    pub fabric: String,
    /// The program.
    pub target: Cow<'static, str>,
    /// The file.
    pub text: String,
}

/// What is told to programs beside the fabric.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CardOptions<'a> {
    /// The date to be noted.
    pub stamp: Option<&'a str>,
    /// What yarns along warp and weft are longer than the cloth, over the cloth's length, if it is known.
    pub crimp: Option<[f64; 2]>,
}

/// Greatest crimp that is taken: beyond it the law of the program has no angle at which its yarns lock.
const GREATEST_CRIMP: f64 = 0.4;

/// A crimp of none is written as this one, as the program takes a zero for its default.
const LEAST_CRIMP: f64 = 1e-6;

/// The crimp of warp and weft, if both are stated and some program asks for it.
///
/// # Errors
/// O050: no chosen program asks for it, or it is none of a yarn.
pub fn stated_crimp(targets: &[Target], stated: [Option<Ratio>; 2]) -> Result<Option<[f64; 2]>, Failure> {
    let [Some(warp), Some(weft)] = stated else { return Ok(None) };
    if !targets.iter().any(|target| target.asks_for_crimp()) {
        return Err(Failure::new("O050", "no chosen program asks for the crimp of yarns")
            .hint("leave --crimp-warp and --crimp-weft out, or add `radioss-fabric-a` to --to"));
    }
    for (option, crimp) in [("--crimp-warp", warp), ("--crimp-weft", weft)] {
        if !(0.0..=GREATEST_CRIMP).contains(&crimp.si()) {
            let text = format!("{option} is {} %, and a crimp is between 0 % and 40 %", 100.0 * crimp.si());
            let hint = "state what a yarn is longer than the cloth, such as `8 %`";
            return Err(Failure::new("O050", text).hint(hint));
        }
    }
    Ok(Some([warp, weft].map(|crimp| crimp.si().max(LEAST_CRIMP))))
}

/// A card for each section that a target can hold, target by target, and why the others have none. `stamp` is the date to
/// be noted.
pub fn cards(
    sections: &[Sectioned],
    targets: &[Target],
    stamp: Option<&str>,
    observer: &Observer,
) -> (Vec<FabricCard>, Vec<Failure>) {
    cards_with(sections, targets, CardOptions { stamp, ..CardOptions::default() }, observer)
}

/// The same with all that can be told.
pub fn cards_with(
    sections: &[Sectioned],
    targets: &[Target],
    CardOptions { stamp, crimp }: CardOptions<'_>,
    observer: &Observer,
) -> (Vec<FabricCard>, Vec<Failure>) {
    let (mut cards, mut failures) = (Vec::new(), Vec::new());
    let pairs = targets.iter().flat_map(|target| sections.iter().map(move |section| (*target, section)));
    for (target, Sectioned { path, sheet, made }) in pairs {
        match card(target, &CardInput { sheet, made, stamp, crimp }) {
            Ok(card) => {
                for finding in card.findings {
                    observer.found(Some(&sheet.name), &finding.at(Place::file(path)));
                }
                cards.push(FabricCard {
                    fabric: sheet.name.clone(),
                    target: target.name.into(),
                    text: card.text,
                });
            }
            Err(error) => {
                let failure = Failure::from(error).of(&sheet.name).at(Place::file(path));
                observer.failed(&failure);
                failures.push(failure);
            }
        }
    }
    (cards, failures)
}

/// Writes a file for each card, `<fabric>.<ending>`; the names of those that are there, and why others are not.
pub fn write_cards(
    cards: &[FabricCard],
    sink: &dyn Sink,
    observer: &Observer,
) -> (Vec<String>, Vec<Failure>) {
    let (mut names, mut failures) = (Vec::new(), Vec::new());
    let mut taken = BTreeSet::new();
    for FabricCard { fabric, target, text } in cards {
        let ending = named(target).map_or("txt", |target| target.ending);
        let name = free_name(fabric, ending, &mut taken);
        match sink.write(&name, text.as_bytes()) {
            Ok(()) => names.push(name),
            Err(error) => {
                let failure = Failure::from(error);
                observer.failed(&failure);
                failures.push(failure);
            }
        }
    }
    (names, failures)
}

/// The name of a file, or with a number behind that of the fabric: it may come from a folder and from a document, which
/// may have any name.
fn free_name(fabric: &str, ending: &str, taken: &mut BTreeSet<String>) -> String {
    let bare = file_name(fabric);
    let fabric = if bare.is_empty() || is_device(&bare) { format!("fabric-{bare}") } else { bare };
    let mut free = format!("{fabric}.{ending}");
    let mut number = 1;
    while !taken.insert(on_disk(&free)) {
        number += 1;
        free = format!("{fabric}-{number}.{ending}");
    }
    free
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::MemorySink;

    #[test]
    fn every_name_is_one_of_windows_and_macos() {
        let card = |name: &str| FabricCard { fabric: name.into(), target: "u3m".into(), text: name.into() };
        let sink = MemorySink::default();
        let cards = ["../out", "NUL", "Poplin", "poplin", "a:b."].map(card);
        let (names, failures) = write_cards(&cards, &sink, &Observer::default());
        assert_eq!(names, ["-out.u3m", "fabric-NUL.u3m", "Poplin.u3m", "poplin-2.u3m", "a-b.u3m"]);
        assert_eq!(failures, Vec::new());
    }

    #[test]
    fn two_fabrics_of_one_name_have_a_file_each() {
        let card =
            |text: &str| FabricCard { fabric: "poplin".into(), target: "u3m".into(), text: text.into() };
        let sink = MemorySink::default();
        let (names, failures) = write_cards(&[card("a"), card("b")], &sink, &Observer::default());
        assert_eq!((names, failures), (vec!["poplin.u3m".to_string(), "poplin-2.u3m".into()], Vec::new()));
        assert_eq!(sink.into_files()["poplin-2.u3m"], b"b");
    }
}
