//! `[[probes]]` and `[[checks]]`: what is reported and what must come out.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::CaseError;
use super::analysis::{Analysis, Buckling, Modal};
use super::error::refused;
use super::point::SheetPoint;
use super::step_analysis::{SheetStep, StepAnalysis};
use crate::fields::Resultants;
use crate::finding::{Located, Node};
use crate::quantity::{Unit, counts_angles, parse_quantity};

/// `[[probes]]`.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct ProbeTable {
    /// Name used in results and checks.
    #[cfg_attr(test, schemars(example = &"centre"))]
    name: String,
    /// Point of the undeformed sheet: `[x, y]` in the plane z = 0, or `[x, y, z]`.
    at: SheetPoint,
}

/// A named point whose values are reported.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbePoint {
    /// Name used in results and checks; no other probe of the case has it.
    pub name: String,
    /// Point of the undeformed sheet.
    pub at: Located<SheetPoint>,
}

/// `[[checks]]`.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct CheckTable {
    /// `w_max`, `in_plane_max`, `strain_energy`, `frequency_1` ..., `load_factor_1` ..., those of a step as `<step>.frequency_1`, or `<probe>.<u|v|w|theta_x|...|moment_x|membrane_x|shear_x ...>`. `w_max` is the
    /// largest displacement along z, whatever the plane of the sheet. Moments, membrane and shear forces are per width and along
    /// the yarns at rest, x the warp and y the weft; displacements and rotations are along the axes of the case. In a motion `w_max` is
    /// the largest at any instant, and all else that of its end. Rotations in large rotations are vectors of half a turn at most: one of
    /// 270 deg about an axis is one of -90 deg.
    #[cfg_attr(test, schemars(example = &"centre.w"))]
    quantity: String,
    /// Expected value with unit; a frequency in `rad/s` is an angular one.
    #[cfg_attr(test, schemars(example = &"3.1 mm"))]
    expected: String,
    /// Accepted |value - expected| / |expected|.
    #[cfg_attr(test, schemars(example = 0.02))]
    relative_tolerance: f64,
    /// Where the expected value comes from.
    #[cfg_attr(test, schemars(example = serde_json::json!({"kind": "analytical", "source": "Timoshenko & Woinowsky-Krieger, Table 35"})))]
    reference: CheckReference,
}

/// A value that must come out.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// A quantity that the case has.
    pub quantity: Located<String>,
    /// Expected value (SI), not 0.
    pub expected: f64,
    /// SI unit of the value.
    pub unit: &'static str,
    /// Accepted |value - expected| / |expected|, above 0.
    pub relative_tolerance: f64,
    /// Where the expected value comes from.
    pub reference: CheckReference,
}

/// The source of an expected value.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CheckReference {
    /// What kind of reference.
    pub kind: ReferenceKind,
    /// Citation.
    #[cfg_attr(test, schemars(example = &"Timoshenko & Woinowsky-Krieger, Table 35"))]
    pub source: String,
}

/// Kinds of references; an accuracy claim never rests on `own`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ReferenceKind {
    /// A closed form or a high-precision series.
    Analytical,
    /// A number printed elsewhere.
    Published,
    /// A measurement.
    Measured,
    /// This program's own earlier result: guards against change, proves nothing.
    Own,
}

/// The probes of the tables of a case.
pub(super) fn probes(tables: &[ProbeTable], case: &Node<'_>) -> Result<Vec<ProbePoint>, CaseError> {
    let mut probes: Vec<ProbePoint> = Vec::with_capacity(tables.len());
    let places = case.get("probes");
    let mut names = BTreeSet::new();
    for (table, at) in tables.iter().zip(places.iter().flat_map(Node::items)) {
        if !names.insert(&table.name) {
            let message = format!("two [[probes]] are called `{}`: give each a name of its own", table.name);
            return refused(at.value_place("name"), message);
        }
        probes.push(ProbePoint { name: table.name.clone(), at: at.located_at("at", table.at) });
    }
    Ok(probes)
}

/// The checks of the tables of a case with an analysis and probes.
pub(super) fn checks(
    tables: &[CheckTable],
    case: &Node<'_>,
    analysis: &Analysis,
    probes: &[ProbePoint],
) -> Result<Vec<Check>, CaseError> {
    let places = case.get("checks");
    let pairs = tables.iter().zip(places.iter().flat_map(Node::items));
    pairs.map(|(table, at)| table.check(&at, analysis, probes)).collect()
}

impl CheckTable {
    fn check(&self, at: &Node<'_>, analysis: &Analysis, probes: &[ProbePoint]) -> Result<Check, CaseError> {
        let unit = unit_of(&self.quantity, analysis, probes);
        // A number without a dimension needs no unit.
        let plain =
            self.expected.trim().parse().ok().filter(|number: &f64| number.is_finite() && unit == Some("1"));
        let (number, given) = plain
            .map_or_else(
                || parse_quantity(&self.expected, "3.1 mm"),
                |number| Ok((number, Unit::parse("1")?)),
            )
            .or_else(|e| refused(at.value_place("expected"), format!("check of {}: {e}", self.quantity)))?;
        if number == 0.0 {
            let message = format!(
                "the check of {} expects 0, from which no value has a relative error: check the quantity where it \
                 is not 0",
                self.quantity
            );
            return refused(at.value_place("expected"), message);
        }
        if !(self.relative_tolerance.is_finite() && self.relative_tolerance > 0.0) {
            let message = format!(
                "the check of `{}` has relative_tolerance = {}: give a positive number, such as 0.02",
                self.quantity, self.relative_tolerance
            );
            return refused(at.value_place("relative_tolerance"), message);
        }
        let Some(unit) = unit else {
            let names: Vec<&str> = probes.iter().map(|p| p.name.as_str()).collect();
            let message = format!(
                "there is no quantity `{}` to check: take {}, or PROBE.COMPONENT with the probes [{}] and \
                 u v w theta_x theta_y theta_z moment_x moment_y moment_xy membrane_x membrane_y membrane_xy shear_x shear_y",
                self.quantity,
                whole_results(analysis),
                names.join(", ")
            );
            return refused(at.value_place("quantity"), message);
        };
        if Unit::parse(unit).map(|u| u.dimension) != Ok(given.dimension) {
            let message = format!(
                "check of {}: `{}` has the wrong dimension, it is in {unit}",
                self.quantity, self.expected
            );
            return refused(at.value_place("expected"), message);
        }
        // Frequencies are in Hz: one in rad/s is an angular frequency.
        let turn = if unit == "1/s" && counts_angles(&self.expected) { TAU } else { 1.0 };
        Ok(Check {
            quantity: at.located_at("quantity", self.quantity.clone()),
            expected: number * given.factor / turn,
            unit,
            relative_tolerance: self.relative_tolerance,
            reference: self.reference.clone(),
        })
    }
}

/// The quantities of a sheet as a whole that an analysis has.
fn whole_results(analysis: &Analysis) -> &'static str {
    match analysis {
        Analysis::Modal(_) => "frequency_1 ...",
        Analysis::Buckling(_) => "load_factor_1 ...",
        Analysis::Steps(_) => {
            "w_max, in_plane_max, strain_energy, STEP.frequency_1 ... and STEP.load_factor_1 ... of a step that looks for them"
        }
        Analysis::Linear(_) | Analysis::Newmark(_) | Analysis::Nonlinear(_) => {
            "w_max, in_plane_max, strain_energy"
        }
    }
}

/// SI unit of a quantity by name, if an analysis with these probes has it.
pub(crate) fn unit_of(quantity: &str, analysis: &Analysis, probes: &[ProbePoint]) -> Option<&'static str> {
    match quantity {
        // Shapes of modes and of buckling have no size.
        "w_max" | "in_plane_max" | "strain_energy"
            if matches!(analysis, Analysis::Modal(_) | Analysis::Buckling(_)) =>
        {
            return None;
        }
        "w_max" | "in_plane_max" => return Some("m"),
        "strain_energy" => return Some("J"),
        _ => {}
    }
    let wanted = match analysis {
        Analysis::Modal(Modal { modes, .. }) => Some(("frequency", *modes, "1/s")),
        Analysis::Buckling(Buckling { factors, .. }) => Some(("load_factor", *factors, "1")),
        Analysis::Linear(_) | Analysis::Newmark(_) | Analysis::Nonlinear(_) | Analysis::Steps(_) => None,
    };
    if let Some((kind, number)) = numbered(quantity) {
        return wanted.filter(|(name, count, _)| *name == kind && number <= *count).map(|(.., unit)| unit);
    }
    let (name, component) = quantity.split_once('.')?;
    if let (Analysis::Steps(steps), Some((kind, number))) = (analysis, numbered(component)) {
        let step = steps.iter().find(|step| step.name.value == name)?;
        let (wanted, count, unit) = eigenvalues(step)?;
        return (wanted == kind && number <= count).then_some(unit);
    }
    probes.iter().find(|p| p.name == name)?;
    let resultant = Resultants::COMPONENTS.iter().find(|(name, _)| *name == component);
    match component {
        "u" | "v" | "w" => Some("m"),
        "theta_x" | "theta_y" | "theta_z" => Some("rad"),
        _ => resultant.map(|(_, unit)| *unit),
    }
}

/// The name and number of an eigenvalue, such as `frequency_1`; from 1.
pub(crate) fn numbered(quantity: &str) -> Option<(&'static str, usize)> {
    ["frequency", "load_factor"].into_iter().find_map(|name| {
        let number = quantity.strip_prefix(name)?.strip_prefix('_')?.parse::<usize>().ok()?;
        (number > 0).then_some((name, number))
    })
}

/// Name, number and unit of what a step looks for.
fn eigenvalues(step: &SheetStep) -> Option<(&'static str, usize, &'static str)> {
    match step.analysis {
        StepAnalysis::Modal { modes, .. } => Some(("frequency", modes, "1/s")),
        StepAnalysis::Buckling { factors, .. } => Some(("load_factor", factors, "1")),
        StepAnalysis::Static(_) | StepAnalysis::Motion(_) => None,
    }
}
