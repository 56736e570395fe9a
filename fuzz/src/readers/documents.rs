//! What this program and others keep of a fabric: JSON of sheets and sections, cards.

use std::path::PathBuf;

use kesf::characterise::{FabricSheet, characterise};
use kesf::constitutive::{Assumptions, Constitutive, section};
use kesf::instrument::{ReadSettings, read_fabrics};
use kesf::report::cards::{CardInput, EXPORTERS, card, read::section_in};
use kesf::report::json::{section_document, sheet_document, text};
use kesf::report::read_back::{self, ReadDocument};

use crate::{Damage, Target, corpus};

/// Shipped fabrics with their sections.
fn fabrics() -> Vec<(FabricSheet, Constitutive)> {
    let folders: Vec<PathBuf> = ["poplin", "petrak_m1"]
        .iter()
        .map(|name| corpus::package().join("../kesf_data").join(name))
        .collect();
    let batch = read_fabrics(&folders, &ReadSettings::default(), &|_| ());
    let characterised = |fabric| {
        let sheet = characterise(fabric, &kesf::characterise::Settings::default());
        let made = section(&sheet, &Assumptions::default()).expect("a section");
        (sheet, made)
    };
    batch.fabrics.iter().map(characterised).collect()
}

/// Documents of sheets and sections, and open fabric files.
pub fn documents() -> Target {
    let mut seeds = Vec::new();
    for (mut sheet, made) in fabrics() {
        // Findings are long, and are not read.
        sheet.findings.clear();
        seeds.push(sheet_text(&[sheet.clone()]));
        seeds.push(section_text(&[(sheet.clone(), made.clone())]));
    }
    seeds.extend(cards_of(|name| name == "kesf"));
    let seeds = seeds.into_iter().map(String::into_bytes).collect();
    Target { seeds, damaged: Damage::of, size: <[u8]>::len, holds: document_holds }
}

fn sheet_text(sheets: &[FabricSheet]) -> String {
    text(&sheet_document(sheets, None)).expect("JSON of a sheet")
}

fn section_text(sections: &[(FabricSheet, Constitutive)]) -> String {
    let entries = sections.iter().map(|(sheet, made)| (sheet, made));
    text(&section_document(entries)).expect("JSON of a section")
}

/// Two texts that are the same but for the last digits of their numbers.
fn assert_alike(a: &str, b: &str) {
    let words = |text: &str| -> Vec<String> {
        text.split([' ', ',', '(', ')', '[', ']', '{', '}', ':']).map(str::to_string).collect()
    };
    let (a, b) = (words(a), words(b));
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        let alike = match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => x == y || (x - y).abs() <= 1e-9 * (x.abs() + y.abs()) + 1e-12,
            _ => a == b,
        };
        assert!(alike, "{a} and {b}");
    }
}

fn document_holds(bytes: &[u8]) -> bool {
    match read_back::read(bytes) {
        Ok(Some(ReadDocument::Sheets(sheets))) => {
            let written = sheet_text(&sheets);
            let again = read_back::read(written.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{written}"));
            let Some(ReadDocument::Sheets(again)) = again else { panic!("another document\n{written}") };
            for (a, b) in sheets.iter().zip(&again) {
                assert_eq!((&a.name, &a.values, &a.statuses), (&b.name, &b.values, &b.statuses));
                assert_eq!((&a.moduli, &a.info), (&b.moduli, &b.info));
                // Energies are summed up along the curves of a law, which are read from its start.
                assert_alike(&format!("{:?}", a.laws), &format!("{:?}", b.laws));
                assert!(a.values.values().all(|e| e.mean.is_finite()));
            }
            assert_eq!(sheets.len(), again.len());
            for sheet in &sheets {
                let _ = section(sheet, &Assumptions::default());
            }
            true
        }
        Ok(Some(ReadDocument::Sections(sections))) => {
            let written = section_text(&sections);
            let again = read_back::read(written.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{written}"));
            let Some(ReadDocument::Sections(again)) = again else { panic!("another document\n{written}") };
            for ((a, of_a), (b, of_b)) in sections.iter().zip(&again) {
                assert_eq!((&a.name, a.info.origin), (&b.name, b.info.origin));
                assert_eq!((&of_a.section, &of_a.used), (&of_b.section, &of_b.used));
            }
            assert_eq!(sections.len(), again.len());
            true
        }
        Ok(None) => false,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// The cards of the shipped fabrics for some programs.
fn cards_of(wanted: impl Fn(&str) -> bool) -> Vec<String> {
    let mut texts = Vec::new();
    for (sheet, made) in &fabrics() {
        let material = CardInput { sheet, made, stamp: None, crimp: None };
        let exporters = EXPORTERS.iter().filter(|e| wanted(e.name));
        texts.extend(exporters.filter_map(|e| Some(card(e, &material).ok()?.text)));
    }
    texts
}

/// Input files of Abaqus and CalculiX.
pub fn cards() -> Target {
    let seeds =
        cards_of(|name| name == "abaqus" || name == "calculix").into_iter().map(String::into_bytes).collect();
    Target { seeds, damaged: Damage::of, size: <[u8]>::len, holds: card_holds }
}

fn card_holds(bytes: &[u8]) -> bool {
    let Some(Ok(stated)) = section_in(&String::from_utf8_lossy(bytes), 4e-4) else { return false };
    stated.section.clone().checked().expect("a section that can be used");
    let made = Constitutive {
        section: stated.section.clone(),
        law: None,
        used: Vec::new(),
        inputs: Vec::new(),
        surface_friction: None,
        findings: Vec::new(),
    };
    let sheet = FabricSheet::default();
    let material = CardInput { sheet: &sheet, made: &made, stamp: None, crimp: None };
    let abaqus = EXPORTERS.iter().find(|e| e.name == "abaqus").expect("a card of Abaqus");
    let text = card(abaqus, &material).expect("a card").text;
    let again = section_in(&text, stated.section.thickness)
        .expect("a card")
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
    // Ten digits are written.
    let (a, b) = (&stated.section, &again.section);
    let near = |a: f64, b: f64, of: f64| (a - b).abs() <= 1e-9 * of.abs();
    assert!(a.d_m.iter().zip(&b.d_m).all(|(x, y)| near(*x, *y, a.d_m.abs().max())), "{text}");
    assert!(a.d_b.iter().zip(&b.d_b).all(|(x, y)| near(*x, *y, a.d_b.abs().max())), "{text}");
    assert!(near(a.areal_density, b.areal_density, a.areal_density), "{text}");
    true
}
