//! Browzwear: the physics file of U3M 1.1 with the values of its own block.
//!
//! | key | meaning, unit | source |
//! |---|---|---|
//! | `bend.length`, `bend.width` | bending rigidity along the grain line and across it, dyn·cm | help.browzwear.com, *Physics Reference* |
//! | `stretch.length`, `stretch.width` | force per width at twice the length, of a linear fabric, N/m | the same |
//! | `mass` | g/m² | the same |
//! | `thickness` | mm | the same |
//! | the file and its keys, numbers as text | | `u3m1.1/physics/physics_schema.json` and its example, Vizoo |

use serde_json::{Map, Value, json};

use super::card::{Card, CardError, CardInput, Exporter};
use super::constants::{Constants, Property, no_place};
use super::text::provenance;
use crate::report::json::text;
use crate::section::ShellSection;

/// `kesf export --to browzwear`.
pub static EXPORTER: Exporter = Exporter {
    name: "browzwear",
    ending: "browzwear.json",
    title: "physics file of U3M 1.1 with Browzwear's block: bend (dyn cm), stretch (N/m), mass (g/m2), thickness (mm)",
    holds: "tensile stiffness and bending rigidity along length (warp) and width (weft), mass and thickness; its \
            shear, linearities and friction are not written: nobody says how they are defined.",
    write,
};

/// The unit of `bend` (N·m): a dyn times a cm.
const DYN_CM: f64 = 1e-7;

/// `raw_data` is what the FAB recorded, and must be null without: KES has other tests.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let c = Constants::of(section);
    let [warp, weft] = c.yarns;
    let along = |length: f64, width: f64| json!({"length": number(length), "width": number(width)});
    let sheet = material.sheet;
    let mut block = Map::new();
    block.insert("name".into(), json!(sheet.name));
    block.insert("bend".into(), along(warp.bending / DYN_CM, weft.bending / DYN_CM));
    block.insert("stretch".into(), along(warp.tensile, weft.tensile));
    // A stand-in is no property of the material.
    if !material.is_assumed("areal density") {
        block.insert("mass".into(), json!(number(1e3 * section.areal_density)));
    }
    if !material.is_assumed("thickness") {
        block.insert("thickness".into(), json!(number(1e3 * section.thickness)));
    }
    let notes = [
        "length is the warp, width the weft. bend: dyn cm; stretch: N/m, of a strip that is free to contract; mass: \
         g/m2; thickness: mm, as help.browzwear.com (Physics Reference) has them.",
        "Browzwear evaluates otherwise: of a public FAB record its bend and stretch are 2 to 4 times smaller than ours \
         (docs, Other programs). Compare a drape before you trust the numbers.",
        "Keys that are not here (shear, linearities, friction, hysteresis) are for you to set: their definition is not \
         published. The friction of Browzwear is that of cloth on the avatar, MIU of KES-FB4 that on a contactor.",
    ];
    let document: Value = json!({
        "schema": "1.1",
        "raw_data": null,
        "custom": {"browzwear": block, "kesf": provenance(material, &notes.map(String::from))},
    });
    let text =
        text(&document).map_err(|e| CardError::Json { program: "Browzwear", reason: e.to_string() })?;
    let lost = [Property::Shear, Property::Torsion, Property::Poisson, Property::TransverseShear];
    let missing = |what| no_place("Browzwear's documentation", section, what);
    Ok(Card { text, findings: lost.map(missing).into() })
}

/// Numbers are text in the block, as its example has them.
fn number(value: f64) -> String {
    // Digits beyond those of a double say nothing.
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    rounded.to_string()
}
