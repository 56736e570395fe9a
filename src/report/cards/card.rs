//! What a card is made of, and what it is made by.

use crate::characterise::FabricSheet;
use crate::constitutive::{Constitutive, Provenance};
use crate::finding::{Finding, errors};
use crate::section::{SectionError, ShellSection};

/// A program that a fabric can be handed to.
#[derive(Debug)]
pub struct Exporter {
    /// The name on the command line.
    pub name: &'static str,
    /// Ending of the files that the program expects.
    pub ending: &'static str,
    /// What is written, in a line.
    pub title: &'static str,
    /// What the material model of the program can and cannot hold of a section.
    pub holds: &'static str,
    /// Writes the card of a material with a checked section.
    pub(super) write: fn(&CardInput<'_>, &ShellSection) -> Result<Card, CardError>,
}

impl Exporter {
    /// Whether the card depends on [`CardInput::crimp`].
    pub fn asks_for_crimp(&self) -> bool {
        self.name == "radioss-fabric-a"
    }
}

/// A program of [`super::EXPORTERS`].
pub type Target = &'static Exporter;

/// A file for another program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Card {
    /// The text of the file.
    pub text: String,
    /// What the program cannot hold of the fabric, with the size of what is lost.
    pub findings: Vec<Finding>,
}

impl From<String> for Card {
    /// A card that loses nothing.
    fn from(text: String) -> Self {
        Self { text, findings: Vec::new() }
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
            /// The program.
            program: &'static str,
            /// What is wrong.
            reason: String,
        } = "the document of {program} could not be made: {reason}";
        /// O046: a number that the fields of a card cannot hold.
        "O046" Range {
            /// Stiffness, mass per area or thickness (SI).
            value: f64,
        } = "a stiffness, mass or thickness of {value:e} (SI) is beyond what a card can hold, 1e-30 to 1e30: correct \
             the value that it comes from";
    }
}

/// A fabric with its section, as it is handed over.
#[derive(Clone, Copy, Debug)]
pub struct CardInput<'a> {
    /// Its parameters.
    pub sheet: &'a FabricSheet,
    /// Its section, with the assumptions.
    pub made: &'a Constitutive,
    /// Date and time (RFC 3339), if they are wanted; a format that must have a date gets a fixed one without.
    pub stamp: Option<&'a str>,
    /// What yarns along warp and weft are longer than the cloth, over the cloth's length, if it is known: only LAW58 of
    /// OpenRadioss asks for it.
    pub crimp: Option<[f64; 2]>,
}

impl CardInput<'_> {
    /// Whether a value is a stand-in: it is no property of the material, and formats that describe one leave it out.
    pub(super) fn is_assumed(&self, name: &str) -> bool {
        self.made.used.iter().any(|u| u.name == name && u.provenance == Provenance::Assumed)
    }
}
