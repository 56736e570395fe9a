//! A draped sheet as a USD stage: where it hangs, where it lay, and of what it is.

use super::card::{Card, CardError, CardInput};
use super::constants::Constants;
use super::usd::{Body, HINGES, losses, stage};

/// A sheet that hangs, as a mesh of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct DrapedSheet {
    /// What it is a shape of, in a line.
    pub about: String,
    /// Points without any force (m); x along the warp, z upwards.
    pub rest: Vec<[f64; 3]>,
    /// Where they are (m).
    pub points: Vec<[f64; 3]>,
    /// Triangles, counter-clockwise seen from above at rest.
    pub triangles: Vec<[usize; 3]>,
    /// Points that do not move.
    pub held: Vec<usize>,
}

impl DrapedSheet {
    /// What does not fit together, if anything.
    fn fault(&self) -> Option<String> {
        let count = self.points.len();
        if self.rest.len() != count {
            Some(format!("{} points at rest of {count}", self.rest.len()))
        } else if self.triangles.as_flattened().iter().chain(&self.held).any(|n| *n >= count) {
            Some(format!("a triangle or a held point names a point that is none of {count}"))
        } else if !self.rest.iter().chain(&self.points).flatten().all(|v| v.is_finite()) {
            Some("a position is no number".into())
        } else {
            None
        }
    }
}

/// The stage of a draped sheet: `points` as it hangs, `physics:restShapePoints` as it lay, flat hinges (AOUSD, proposal for
/// deformable bodies, *Rest Shape Attributes*), bound to the material of a sheet. What the material cannot hold of the
/// fabric stands in the file and in the findings.
///
/// # Errors
/// See [`CardError`]; O041 if the lists do not fit together.
pub fn draped(material: &CardInput<'_>, sheet: &DrapedSheet) -> Result<Card, CardError> {
    if let Some(reason) = sheet.fault() {
        return Err(CardError::Json { program: "USD", reason });
    }
    let section = material.made.section.clone().checked()?;
    let findings = losses(&Constants::of(&section), &section);
    let mut notes = vec![
        sheet.about.clone(),
        "The points are those of the draped sheet, m; physics:restShapePoints are those of the flat one, x along the warp. \
         Points of the disc are held: custom int[] kesf:held. Hinges are flat at rest."
            .into(),
        "The shape is that of the orthotropic fabric; the material `sheet` is isotropic (geometric means of warp and \
         weft), so that a program that goes on from here moves the sheet. Stretch and shear N/m, bend N*m, density kg/m3 \
         (times the thickness of the mesh it is mass per area)."
            .into(),
        HINGES.into(),
    ];
    notes.extend(findings.iter().map(|finding| finding.message()));
    let body = Body {
        name: "drape",
        material: "sheet",
        points: sheet.points.clone(),
        rest: Some(&sheet.rest),
        triangles: sheet.triangles.clone(),
        held: sheet.held.clone(),
    };
    Ok(Card { text: stage(material, &section, &notes, &[body]), findings })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{constitutive, section, sheet};
    use super::*;

    /// Two triangles that share an edge, the second of which hangs.
    fn corner() -> DrapedSheet {
        let rest = vec![[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.2, 0.05, 0.0]];
        let points = vec![rest[0], rest[1], rest[2], [0.15, 0.05, -0.08660254]];
        let triangles = vec![[0, 1, 2], [1, 3, 2]];
        DrapedSheet { about: "corner".into(), rest, points, triangles, held: vec![0, 1, 2] }
    }

    fn written(shape: &DrapedSheet) -> Result<Card, CardError> {
        let (sheet, made) = (sheet(), constitutive(section()));
        draped(&CardInput { sheet: &sheet, made: &made, stamp: None, crimp: None }, shape)
    }

    #[test]
    fn the_stage_has_the_shape_at_rest_and_as_it_hangs() {
        let card = written(&corner()).unwrap();
        let line = |key: &str| {
            let found = card.text.lines().find_map(|line| line.trim().strip_prefix(key));
            found.unwrap_or_else(|| panic!("no {key} in\n{}", card.text))
        };
        assert!(line("point3f[] points = ").ends_with("(0.150000000, 0.050000000, -0.086602540)]"));
        assert!(
            line("point3f[] physics:restShapePoints = ")
                .ends_with("(0.200000000, 0.050000000, 0.000000000)]")
        );
        assert_eq!(line("int[] faceVertexIndices = "), "[0, 1, 2, 1, 3, 2]");
        assert_eq!(line("custom int[] kesf:held = "), "[0, 1, 2]");
        assert!(line("rel material:binding:physics = ").contains("/World/Materials/sheet"));
        let sheet = card.text.split("def Material \"sheet\"").nth(1).unwrap();
        let (c, density) = (Constants::of(&section()), section().areal_density / section().thickness);
        for (key, value) in [
            ("surfaceStretchStiffness", c.mean().tensile),
            ("surfaceShearStiffness", 60.0),
            ("surfaceBendStiffness", c.mean().bending),
            ("density", density),
        ] {
            let said =
                sheet.split(&format!("physics:{key} = ")).nth(1).and_then(|s| s.lines().next()).unwrap();
            assert!((said.parse::<f64>().unwrap() / value - 1.0).abs() < 1e-8, "{key}: {said}");
        }
        assert_eq!(line("float[] physics:thicknesses = "), "[4.000000000E-4]");
        assert!(card.text.is_ascii() && card.text.contains("# corner\n"));
        // What the isotropic material loses is told, and stands in the file.
        assert!(!card.findings.is_empty());
        let remarks =
            card.text.lines().take_while(|l| !l.starts_with("def")).filter(|l| l.contains("USD")).count();
        assert!(remarks >= card.findings.len(), "{}", card.text);
    }

    #[test]
    fn lists_that_do_not_fit_are_refused() {
        let own = corner();
        let short = DrapedSheet { rest: own.rest[1..].to_vec(), ..own.clone() };
        let beyond = DrapedSheet { held: vec![4], ..own.clone() };
        let mut lost = own;
        lost.points[3][2] = f64::NAN;
        for wrong in [short, beyond, lost] {
            assert!(matches!(written(&wrong), Err(CardError::Json { program: "USD", .. })), "{wrong:?}");
        }
    }
}
