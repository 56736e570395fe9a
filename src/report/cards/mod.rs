//! Fabrics as material files of other programs.
//!
//! A card states units, axes, the origin of the data and every assumption. What a program has no place for is left
//! out and named; no value is invented. Cards are pure text: the same fabric gives the same bytes.

mod finite_element;
mod laminate;
mod u3m;

use std::fmt::Write as _;

use unicode_normalization::UnicodeNormalization;

pub use laminate::{Laminate, laminate};

use crate::characterise::FabricSheet;
use crate::constitutive::Constitutive;
use crate::finding::errors;
use crate::report::write::hash;
use crate::section::SectionError;

/// Programs that a fabric can be handed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Abaqus: `*SHELL GENERAL SECTION`.
    Abaqus,
    /// Ansys Mechanical APDL: preintegrated section of SHELL181 and SHELL281.
    Ansys,
    /// CalculiX: three layers that have the stiffness of the sheet.
    Calculix,
    /// U3M 1.1 material.
    U3m,
}

impl Target {
    /// All of them, by name.
    pub const ALL: [Self; 4] = [Self::Abaqus, Self::Ansys, Self::Calculix, Self::U3m];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Abaqus => "abaqus",
            Self::Ansys => "ansys",
            Self::Calculix => "calculix",
            Self::U3m => "u3m",
        }
    }

    /// The target of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|t| t.name() == name)
    }

    /// Ending of the files that the program expects.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Abaqus => "abaqus.inp",
            Self::Calculix => "calculix.inp",
            Self::Ansys => "mac",
            Self::U3m => "u3m",
        }
    }

    /// What is written, in a line.
    pub fn title(self) -> &'static str {
        match self {
            Self::Abaqus => {
                "*SHELL GENERAL SECTION, *TRANSVERSE SHEAR STIFFNESS: the matrices as they are; SI"
            }
            Self::Ansys => "SECTYPE,,GENS with SSPA, SSPD, SSPE, SSPM: the matrices as they are; SI",
            Self::Calculix => {
                "*SHELL SECTION, COMPOSITE of three layers with the same D_m and D_b, for S8R; SI"
            }
            Self::U3m => {
                "U3M 1.1 material: thickness, weight, composition; everything else under custom.kesf"
            }
        }
    }
}

errors! {
    /// Why there is no card.
    #[derive(Clone, Debug, PartialEq)]
    pub enum CardError {
        from {
            /// The section is none.
            Section(SectionError),
        }
        /// O040: the program cannot hold this stiffness.
        "O040" Stiffness {
            /// The program.
            program: &'static str,
            /// What is wrong.
            reason: &'static str,
        } = "{program} cannot hold this stiffness: {reason}; export a section with torsional rigidity \
             (--torsion huber)";
        /// O041: the document could not be written.
        "O041" Json {
            /// What it said.
            problem: String,
        } = "the U3M document could not be made: {problem}";
    }
}

/// A fabric with its section, as it is handed over.
#[derive(Clone, Copy, Debug)]
pub struct Material<'a> {
    /// Its parameters.
    pub sheet: &'a FabricSheet,
    /// Its section, with the assumptions.
    pub made: &'a Constitutive,
    /// Date and time (RFC 3339), if they are wanted; a format that must have a date gets a fixed one without.
    pub stamp: Option<&'a str>,
}

/// The text of a card.
///
/// # Errors
/// See [`CardError`].
pub fn card(target: Target, material: &Material<'_>) -> Result<String, CardError> {
    let section = material.made.section.clone().checked()?;
    match target {
        Target::Abaqus => Ok(finite_element::abaqus(material, &section)),
        Target::Ansys => finite_element::ansys(material, &section),
        Target::Calculix => finite_element::calculix(material, &section),
        Target::U3m => u3m::document(material),
    }
}

/// What every card of a finite-element program begins with, as comments.
fn preamble(material: &Material<'_>, comment: &str, notes: &[&str]) -> String {
    let info = &material.sheet.info;
    let mut lines = vec![
        format!(
            "{} ({} data), by kesf {}",
            material.sheet.name,
            info.origin.name(),
            env!("CARGO_PKG_VERSION")
        ),
        "SI: m, kg, s, N. Local axis 1 is the warp, 2 the weft. Linear and elastic: no friction, no time."
            .into(),
    ];
    lines.extend(material.stamp.map(|date| format!("date: {date}")));
    lines.extend(info.source.iter().map(|s| format!("source: {s}")));
    lines.extend(material.made.used.iter().map(|u| format!("{}: {} ({})", u.name, u.value, u.source)));
    lines.extend(notes.iter().map(ToString::to_string));
    let mut text = String::new();
    for line in lines {
        for part in wrapped(&ascii(&line)) {
            let _ = writeln!(text, "{comment} {part}");
        }
    }
    text
}

/// Text without characters that an input file may not hold.
fn ascii(text: &str) -> String {
    let plain = |c: char| match c {
        '·' | '×' => Some('*'),
        '–' | '−' => Some('-'),
        c if c.is_ascii_graphic() || c == ' ' => Some(c),
        c if c.is_whitespace() => Some(' '),
        // Accents go, letters stay.
        c if unicode_normalization::char::is_combining_mark(c) => None,
        _ => Some('?'),
    };
    let greek = text.replace('√', "sqrt").replace('ν', "nu").replace(['µ', 'μ'], "u");
    greek.nfkd().filter_map(plain).collect()
}

/// Lines of at most a hundred characters, broken between words.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].len() + word.len() > 100 {
            lines.push(format!("  {word}"));
        } else {
            let gap = if lines[last].is_empty() { "" } else { " " };
            lines[last] = format!("{}{gap}{word}", lines[last]);
        }
    }
    lines
}

/// A name of at most so many characters for a set of elements or a section: capitals, digits and `_`. What had to
/// change of the fabric's name stands in a tail of digits of its hash, so that two fabrics never share a label.
fn label(name: &str, longest: usize) -> String {
    const TAIL: usize = 6;
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if name.chars().all(plain) && name.len() <= longest {
        return name.to_ascii_uppercase();
    }
    let safe = ascii(name).to_ascii_uppercase();
    let safe = safe.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let kept: String = safe.take(longest - TAIL).collect();
    format!("{kept}{}", &hash(name.as_bytes())[..TAIL].to_ascii_uppercase())
}

/// A number as every input file reads it.
fn number(value: f64) -> String {
    format!("{value:.9E}")
}

#[cfg(test)]
mod tests;
