//! Kratos Multiphysics: the materials of its thin shells.

use serde_json::{Value, json};

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Property, no_place, plane_stress};
use super::laminate::laminate;
use super::text::provenance;
use crate::report::json;
use crate::section::ShellSection;

/// `kesf export --to kratos`.
pub static EXPORTER: Exporter = Exporter {
    name: "kratos",
    ending: "kratos.json",
    title: "materials JSON: three orthotropic layers with the same D_m and D_b, for thin shells; SI",
    holds: "D_m, D_b and mass per area as a laminate, if D_b is positive definite; thin shell elements know no \
            transverse shear; no friction.",
    write,
};

/// Kratos StructuralMechanicsApplication, `SHELL_ORTHOTROPIC_LAYERS`: a row for each layer of thickness, angle (deg),
/// density, E1, E2, ν12, G12, G13, G23; the law is in the ConstitutiveLawsApplication.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let layers = laminate("Kratos", section)?;
    let density = section.areal_density / layers.thickness;
    let [g13, g23] = [0, 1].map(|i| section.d_s[(i, i)] / layers.thickness);
    let layer = |thickness: f64, q| {
        let [e1, e2, nu12, g12] = plane_stress(q);
        json!([thickness, 0.0, density, e1, e2, nu12, g12, g13, g23])
    };
    let outer = layer(0.5 * (layers.thickness - layers.core), &layers.outer);
    let core = layer(layers.core, &layers.inner);
    let notes = [
        "The layers are no cloth: together they have its D_m, D_b and mass per area. Stresses within them mean \
         nothing; forces and moments per width do.",
        "Elements ShellThinElementCorotational3D4N or ShellThinElementCorotational3D3N, which know no transverse \
         shear, with element axes along the warp; import the ConstitutiveLawsApplication; call your model part \
         Structure.sheet or change its name here. `kesf export --to kratos-mesh` writes one.",
    ];
    let document: Value = json!({
        "kesf": provenance(material, &notes.map(String::from)),
        "properties": [{
            "model_part_name": "Structure.sheet",
            "properties_id": 1,
            "Material": {
                "constitutive_law": {"name": "LinearElasticOrthotropic2DLaw"},
                "Variables": {
                    "THICKNESS": layers.thickness,
                    "DENSITY": density,
                    "SHELL_ORTHOTROPIC_LAYERS": [outer.clone(), core, outer],
                },
                "Tables": {},
            },
        }],
    });
    let text =
        json::text(&document).map_err(|e| CardError::Json { program: "Kratos", reason: e.to_string() })?;
    Ok(Card { text, findings: vec![no_place("Kratos", section, Property::TransverseShear)] })
}
