//! Abaqus/Explicit: `*FABRIC` with the curves that were measured.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, no_place};
use super::text::{number, preamble_of, set};
use crate::characterise::{FabricSheet, mean_branches};
use crate::instrument::{Direction, Test};
use crate::quantity::Curve;
use crate::section::ShellSection;

/// `kesf export --to abaqus-fabric`.
pub static EXPORTER: Exporter = Exporter {
    name: "abaqus-fabric",
    ending: "fabric.inp",
    title: "*FABRIC of Abaqus/Explicit with *UNIAXIAL curves of tension and shear, as measured; a membrane; SI",
    holds: "The loading curves along warp and weft and in shear, and mass; a membrane does not resist bending; no \
            contraction across, no unloading curve.",
    write,
};

/// One response: its component in Abaqus, its curve of strain and force per width, and where the curve comes from.
pub(super) struct Response {
    component: &'static str,
    /// Strain (an angle in rad for shear) and force per width (N/m), from the origin, neither ever falling.
    pub curve: Curve,
    /// Where the curve comes from.
    pub source: String,
    /// The way back from its end, as recorded: towards the origin.
    pub back: Option<Curve>,
}

/// Abaqus Keywords Guide, `*FABRIC`, `*UNIAXIAL`, `*LOADING DATA`: nominal stress and nominal strain a line, strains rising;
/// without DIRECTION the response is nonlinear elastic, and data to one side only count for both. Component 1 is given the warp (Abaqus
/// calls its two yarns fill and warp in that order; the orientation decides which is which). The shear strain is the change of the
/// angle between the yarns (rad).
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let (name, thickness) = (set(material), section.thickness);
    let responses = responses(material.sheet, section);
    let mut notes = vec![
        "A membrane for Abaqus/Explicit: it does not resist bending. Component 1 is along the warp: turn the local axes \
         of *ORIENTATION to the warp of your part."
            .to_string(),
        "Stresses are forces per width over the thickness of *MEMBRANE SECTION: change both or none.".into(),
        "Yarns that are pushed carry nothing: this is assumed, KES-FB1 only pulls.".into(),
    ];
    notes.extend(responses.iter().map(|r| format!("*UNIAXIAL, COMPONENT={}: {}", r.component, r.source)));
    let law = "Elastic, along the loading curves: no friction, no time.";
    let mut text = preamble_of(material, "**", law, &notes);
    let _ = writeln!(text, "*ORIENTATION, NAME={name}_AXES\n1., 0., 0., 0., 1., 0.\n3, 0.");
    let _ =
        writeln!(text, "*MEMBRANE SECTION, ELSET={name}, MATERIAL={name}_FABRIC, ORIENTATION={name}_AXES");
    let _ = writeln!(text, "{},", number(thickness));
    let _ = writeln!(
        text,
        "*MATERIAL, NAME={name}_FABRIC\n*DENSITY\n{},",
        number(section.areal_density / thickness)
    );
    let _ = writeln!(text, "*FABRIC");
    for Response { component, curve, .. } in &responses {
        let _ = writeln!(text, "*UNIAXIAL, COMPONENT={component}\n*LOADING DATA");
        if *component != "SHEAR" {
            let _ = writeln!(text, "{}, {}", number(0.0), number(-1.0));
        }
        for (strain, force) in curve.points() {
            let _ = writeln!(text, "{}, {}", number(force / thickness), number(strain));
        }
    }
    let lost = [Property::Bending, Property::Torsion, Property::TransverseShear, Property::Poisson];
    Ok(Card { text, findings: lost.map(|what| no_place("Abaqus *FABRIC", section, what)).into() })
}

/// Tension along the warp and the weft, and shear.
pub(super) fn responses(sheet: &FabricSheet, section: &ShellSection) -> [Response; 3] {
    let c = Constants::of(section);
    [
        response(sheet, "1", Test::Tensile, Direction::Warp, c.yarns[0].tensile),
        response(sheet, "2", Test::Tensile, Direction::Weft, c.yarns[1].tensile),
        response(sheet, "SHEAR", Test::Shear, Direction::Warp, c.shear),
    ]
}

/// The measured loading curve of a test; a straight line of the section where there is none.
fn response(
    sheet: &FabricSheet,
    component: &'static str,
    test: Test,
    direction: Direction,
    stiffness: f64,
) -> Response {
    let measured = run(sheet, test, direction, 0).map(|(curve, n)| (rising(&curve), n));
    match measured.filter(|(curve, _)| curve.len() > 2 && curve.y.iter().any(|y| *y > 0.0)) {
        Some((curve, n)) => {
            let source = format!("measured by KES-FB1 along the {}, mean of n = {n}", direction.name());
            Response {
                component,
                curve,
                source,
                back: run(sheet, test, direction, 1).map(|(curve, _)| curve),
            }
        }
        None => {
            // As far as the test goes: to a force, or to an angle.
            let end = sheet.conditions(test, Some(direction)).maximum;
            let end = if test == Test::Shear { (end, end * stiffness) } else { (end / stiffness, end) };
            let line = Curve::from_points([(0.0, 0.0), end]);
            let source = "a straight line, the stiffness of the section: the input has no curve".into();
            Response { component, curve: line, source, back: None }
        }
    }
}

/// A run of the drive, the first of which is the way out and the second the way back: the mean over all specimens, or that of the
/// only one, and how many there are.
fn run(sheet: &FabricSheet, test: Test, direction: Direction, place: usize) -> Option<(Curve, usize)> {
    let mut means = mean_branches(sheet, test).into_iter().filter(|m| m.direction == Some(direction));
    if let Some(mean) = means.nth(place) {
        return Some((mean.mean, mean.n));
    }
    let mine = |m: &crate::instrument::Measurement| (m.test, m.direction) == (test, Some(direction));
    let specimen = sheet.specimens.iter().find(|s| mine(&s.measurement))?;
    Some((specimen.branches.get(place)?.curve.clone(), 1))
}

/// From the origin, with strains and forces that never fall: noise at the start is left out.
fn rising(curve: &Curve) -> Curve {
    let mut last = (0.0, 0.0);
    let mut points = vec![last];
    for (strain, force) in curve.points() {
        if strain > last.0 && force >= last.1 {
            last = (strain, force);
            points.push(last);
        }
    }
    Curve::from_points(points)
}
