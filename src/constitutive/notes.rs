//! What is written down while a section is made: inputs and assumptions, where constants come from, findings.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::error::ConstitutiveError;
use super::perturbed::InputSource;
use super::sensitivity::{Constant, Origin};
use crate::characterise::{FabricSheet, Key, Modulus, ValueStatus};
use crate::finding::{Finding, SectionFact};
use crate::instrument::{Direction, Parameter};
use crate::quantity::Estimate;

/// What a constant of a section rests on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Provenance {
    /// A measurement, or what `fabric.toml` says.
    Measured,
    /// A measurement of something else, from which it follows.
    Inferred,
    /// Somebody's word, such as a card of another program.
    #[default]
    Stated,
    /// A choice or a stand-in: it is no property of the material.
    Assumed,
}

impl Provenance {
    /// `measured`, `inferred`, `stated` or `assumed`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Inferred => "inferred",
            Self::Stated => "stated",
            Self::Assumed => "assumed",
        }
    }
}

/// Values that differ by less than this part are the same.
const ALIKE: f64 = 1e-3;

/// A provenance and what it consists of.
pub(super) type Because = (Provenance, Cow<'static, str>);

/// One input or assumption behind a section.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Used {
    /// What it is, e.g. `tensile modulus`.
    pub name: Cow<'static, str>,
    /// Its value with unit, e.g. `warp 5120 N/m, weft 3080 N/m`.
    pub value: String,
    /// What it rests on.
    pub provenance: Provenance,
    /// That and why, for people: `measured: ...` or `assumed: ...`.
    pub source: String,
}

/// A value that a section rests on, as its sheet knows it.
pub(super) struct Known {
    /// Symbol and direction, e.g. `B warp`.
    name: String,
    status: ValueStatus,
    /// Codes of the findings that gave the status.
    causes: Vec<&'static str>,
}

/// What a constant of the section rests on that follows from these values, with what speaks against any of them.
pub(super) fn because(known: &[Known], why: impl Into<String>) -> Because {
    let mut why = why.into();
    for Known { name, status, causes } in known {
        let remark = match status {
            ValueStatus::Doubtful => "is doubtful",
            ValueStatus::Assumed => "rests on an assumption",
            ValueStatus::Measured | ValueStatus::Inferred => continue,
        };
        let causes = if causes.is_empty() { String::new() } else { format!(" ({})", causes.join(", ")) };
        why += &format!("; {name} {remark}{causes}");
    }
    let inferred = known.iter().any(|value| value.status == ValueStatus::Inferred);
    (if inferred { Provenance::Inferred } else { Provenance::Measured }, why.into())
}

/// What is said where the one direction that is known stands for both.
pub(super) fn for_both(known: Direction, why: &str) -> Because {
    let across = known.across();
    (
        Provenance::Assumed,
        format!("{why}; that of the {known} stands for the {across}, which is not known").into(),
    )
}

/// An estimate of the sheet, and where it stands.
pub(super) fn value(
    sheet: &FabricSheet,
    parameter: Parameter,
    direction: Option<Direction>,
) -> Option<(Estimate, InputSource)> {
    let estimate = sheet.get(parameter, direction)?.clone();
    Some((estimate, InputSource::Value(Key { parameter, direction })))
}

/// What is written down on the way: the sheet, the inputs used and the findings.
pub(super) struct Notes<'a> {
    pub sheet: &'a FabricSheet,
    pub used: Vec<Used>,
    pub origins: Vec<Origin>,
    pub findings: Vec<Finding>,
}

impl Notes<'_> {
    /// Writes down where constants come from; `gives` has `∂ln c/∂ln p` of each.
    pub fn origin(
        &mut self,
        name: impl Into<String>,
        (estimate, source): (&Estimate, InputSource),
        gives: &[(Constant, f64)],
    ) {
        let (estimate, status, gives) = (estimate.clone(), source.status(self.sheet), gives.to_vec());
        self.origins.push(Origin { name: name.into(), estimate, status, source, gives });
    }

    /// The same for a parameter of the sheet; nothing if the sheet has none.
    pub fn origin_value(
        &mut self,
        parameter: Parameter,
        direction: Option<Direction>,
        gives: &[(Constant, f64)],
    ) {
        if let Some((estimate, from)) = value(self.sheet, parameter, direction) {
            self.origin(Key { parameter, direction }.to_string(), (&estimate, from), gives);
        }
    }

    pub fn used(&mut self, name: &'static str, value: impl Into<String>, (provenance, why): Because) {
        let source = format!("{}: {why}", provenance.name());
        self.used.push(Used { name: name.into(), value: value.into(), provenance, source });
    }

    /// A parameter of the sheet as what a constant rests on.
    pub fn known(&self, parameter: Parameter, direction: Option<Direction>) -> Known {
        let (key, sheet) = (Key { parameter, direction }, self.sheet);
        Known { name: key.to_string(), status: sheet.status(key), causes: sheet.causes(key) }
    }

    /// A tensile modulus of the sheet as what a constant rests on.
    pub fn known_modulus(&self, modulus: Modulus, direction: Direction) -> Known {
        let (name, sheet) = (modulus.name(), self.sheet);
        Known {
            name: format!("E {direction}"),
            status: sheet.modulus_status(&name, direction),
            causes: sheet.modulus_causes(&name, direction),
        }
    }

    /// Name of the fabric.
    pub fn fabric(&self) -> String {
        self.sheet.name.clone()
    }

    pub fn finding(&mut self, fact: SectionFact) {
        let finding = Finding::new(fact);
        // A value that is looked at twice is reported once.
        if !self.findings.contains(&finding) {
            self.findings.push(finding);
        }
    }

    /// C022: what the assumptions have for a value that is known already; nothing where they leave it at `default`.
    pub fn not_used(&mut self, what: &str, [stand_in, default, used]: [f64; 3], unit: &str) {
        if stand_in == default || (stand_in - used).abs() <= ALIKE * used.abs() {
            return;
        }
        let (fabric, what, unit) = (self.fabric(), what.to_string(), unit.to_string());
        self.finding(SectionFact::StandInNotUsed { fabric, what, stand_in, used, unit });
    }

    pub fn missing(&self, what: impl Into<String>, cure: &'static str) -> ConstitutiveError {
        ConstitutiveError::Missing { fabric: self.sheet.name.clone(), what: what.into(), cure }
    }

    pub fn positive(
        &self,
        what: &str,
        value: f64,
        unit: &'static str,
        cure: &'static str,
    ) -> Result<(), ConstitutiveError> {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        let (fabric, what) = (self.sheet.name.clone(), what.to_string());
        Err(ConstitutiveError::NotPositive { fabric, what, value, unit, cure })
    }

    /// Bending rigidities along warp and weft. One value for the fabric, or for one direction only,
    /// stands for both, with a finding.
    pub fn bending_rigidities(&mut self) -> Option<[f64; 2]> {
        let (parameter, sheet) = (Parameter::B, self.sheet);
        let get = |direction| sheet.get(parameter, direction);
        let constants = [0, 1].map(|i| (Constant::Bending(i), 1.0));
        let known = match (get(Some(Direction::Warp)), get(Some(Direction::Weft)), get(None)) {
            (Some(warp), Some(weft), _) => {
                self.origin_value(parameter, Some(Direction::Warp), &constants[..1]);
                self.origin_value(parameter, Some(Direction::Weft), &constants[1..]);
                return Some([warp.mean, weft.mean]);
            }
            (_, _, Some(mean)) => (mean, None),
            (Some(warp), None, None) => (warp, Some(Direction::Warp)),
            (None, Some(weft), None) => (weft, Some(Direction::Weft)),
            (None, None, None) => return None,
        };
        let (estimate, direction) = known;
        self.finding(SectionFact::OneRigidity { fabric: self.fabric(), known: direction });
        let Some(direction) = direction else {
            self.origin_value(parameter, None, &constants);
            return Some([estimate.mean; 2]);
        };
        let (own, other) = if direction == Direction::Warp { (0, 1) } else { (1, 0) };
        self.origin_value(parameter, Some(direction), &constants[own..=own]);
        let across = Key { parameter, direction: Some(direction.across()) };
        let stand_in = (&Estimate::stand_in(estimate.mean), InputSource::Value(across));
        self.origin(across.to_string(), stand_in, &constants[other..=other]);
        Some([estimate.mean; 2])
    }
}
