//! Goal: cards say what the section is, in the words of the program that reads them.
//! References: the layouts in the manuals that each writer names; laminate theory; the schema of U3M 1.1.

use approx::assert_relative_eq;
use nalgebra::{Matrix2, Matrix3};
use serde_json::Value;

use super::*;
use crate::section::ShellSection;

/// A poplin-like sheet: every entry another number.
pub(super) fn section() -> ShellSection {
    ShellSection {
        d_m: Matrix3::new(6000.0, 900.0, 0.0, 900.0, 4000.0, 0.0, 0.0, 0.0, 60.0),
        d_b: Matrix3::new(8e-6, 5e-7, 0.0, 5e-7, 4e-6, 0.0, 0.0, 0.0, 2.5e-6),
        d_s: Matrix2::new(50.0, 0.0, 0.0, 45.0),
        areal_density: 0.118,
        thickness: 4e-4,
    }
}

fn sheet() -> FabricSheet {
    let mut sheet = FabricSheet { name: "Köper 65".into(), ..Default::default() };
    sheet.info.title = "Köper 65".into();
    sheet.info.weave = Some("twill 2/1".into());
    sheet.info.composition = Some("65 % cotton, 31 % polyester, 4 % elastane".into());
    sheet
}

pub(super) fn written(name: &str, section: ShellSection) -> Result<String, CardError> {
    let made =
        Constitutive { section, law: None, used: Vec::new(), inputs: Vec::new(), findings: Vec::new() };
    card(named(name).unwrap(), &Material { sheet: &sheet(), made: &made, stamp: None }).map(|c| c.text)
}

fn numbers(line: &str) -> Vec<f64> {
    line.split(',').map(|v| v.trim().parse().unwrap()).collect()
}

#[test]
fn abaqus_has_the_half_of_the_stiffness_by_columns() {
    let text = written("abaqus", section()).unwrap();
    assert!(text.is_ascii() && text.contains("ELSET=KESF_KOPER_65"));
    let at = text.find("*SHELL GENERAL").unwrap();
    let lines: Vec<&str> = text[at..].lines().collect();
    assert!(lines[0].ends_with("DENSITY=1.180000000E-1"));
    assert_eq!([8, 8, 5], [1, 2, 3].map(|i| numbers(lines[i]).len()));
    let half: Vec<f64> = lines[1..4].iter().flat_map(|l| numbers(l)).collect();
    let mut next = half.into_iter();
    let (d_m, d_b) = (section().d_m, section().d_b);
    for column in 0..6 {
        for row in 0..=column {
            let expected = match (row / 3, column / 3) {
                (0, 0) => d_m[(row, column)],
                (1, 1) => d_b[(row - 3, column - 3)],
                _ => 0.0,
            };
            assert_eq!(next.next().unwrap(), expected, "{row} {column}");
        }
    }
    assert_eq!(lines[4], "*TRANSVERSE SHEAR STIFFNESS");
    assert_eq!(numbers(lines[5]), [50.0, 45.0, 0.0]);
}

#[test]
fn ansys_has_the_lower_parts_by_columns() {
    let text = written("ansys", section()).unwrap();
    let of = |command: &str| {
        let line = text.lines().find(|l| l.starts_with(command)).unwrap();
        numbers(line.split_once(',').unwrap().1)
    };
    assert_eq!(of("SSPA"), [6000.0, 900.0, 0.0, 4000.0, 0.0, 60.0]);
    assert_eq!(of("SSPD"), [8e-6, 5e-7, 0.0, 4e-6, 0.0, 2.5e-6]);
    assert_eq!((of("SSPE"), of("SSPM")), (vec![50.0, 0.0, 45.0], vec![0.118]));
}

/// The layers summed give the matrices back, and each is a material.
#[test]
fn layers_have_the_stiffness_of_the_sheet() {
    let section = section();
    let l = laminate("CalculiX", &section).unwrap();
    let (t, c) = (l.thickness, l.core);
    let d_m = l.outer * (t - c) + l.inner * c;
    let d_b = (l.outer * (t.powi(3) - c.powi(3)) + l.inner * c.powi(3)) / 12.0;
    assert_relative_eq!(d_m, section.d_m, max_relative = 1e-12);
    assert_relative_eq!(d_b, section.d_b, max_relative = 1e-12);
    for q in [l.outer, l.inner] {
        assert!(nalgebra::SymmetricEigen::new(q).eigenvalues.min() > 0.0);
    }
    assert!(0.0 < c && c < t);
    let twistless = ShellSection { d_b: Matrix3::from_diagonal(&[8e-6, 4e-6, 0.0].into()), ..section };
    for target in ["calculix", "ansys", "kratos", "nastran", "opensees"] {
        let refused = written(target, twistless.clone()).unwrap_err();
        assert!(refused.to_string().starts_with("O040"), "{refused}");
    }
}

/// What `u3m_schema.json` requires: the keys of each object, no others, and units of millimetres and g/m².
#[test]
fn u3m_has_the_keys_of_its_schema() {
    let text = written("u3m", section()).unwrap();
    let document: Value = serde_json::from_str(&text).unwrap();
    let keys = |v: &Value| -> Vec<String> {
        let mut keys: Vec<String> = v.as_object().unwrap().keys().cloned().collect();
        keys.sort();
        keys
    };
    assert_eq!(keys(&document), ["custom", "material", "schema"]);
    let material = &document["material"];
    let required = "back created description front id metadata modified name physics side";
    assert_eq!(keys(material).join(" "), required);
    let physics = &material["physics"];
    assert_eq!(keys(physics).join(" "), "composition construction devices material_type thickness weight");
    assert_eq!(physics["devices"], serde_json::json!({"fab": "null"}));
    assert_relative_eq!(physics["thickness"].as_f64().unwrap(), 0.4, max_relative = 1e-12);
    assert_relative_eq!(physics["weight"].as_f64().unwrap(), 118.0, max_relative = 1e-12);
    let parts = physics["composition"]["parts"].as_array().unwrap();
    let ratios: Vec<f64> = parts.iter().map(|p| p["ratio"].as_f64().unwrap()).collect();
    assert_relative_eq!(ratios.iter().sum::<f64>(), 1.0, max_relative = 1e-12);
    assert_eq!(parts[0]["type"], "Cotton");
    assert_eq!(physics["construction"], serde_json::json!({"type": "Twill", "name": null}));
    let id = material["id"].as_str().unwrap();
    assert!(id.len() == 36 && &id[14..15] == "4" && "89ab".contains(&id[19..20]), "{id}");
    assert_eq!(document["custom"]["kesf"]["section"]["sections"][0]["d_m"][0][0], 6000.0);
    assert_eq!(written("u3m", section()).unwrap(), text);
}
