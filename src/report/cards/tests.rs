//! Goal: cards say what the section is, in the words of the program that reads them.
//! References: the layouts in the manuals that each writer names; laminate theory; the schema of U3M 1.1.

use approx::assert_relative_eq;
use nalgebra::{Matrix2, Matrix3};
use serde_json::Value;

use super::*;
use crate::characterise::FabricSheet;
use crate::constitutive::Constitutive;
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

pub(super) fn sheet() -> FabricSheet {
    let mut sheet = FabricSheet { name: "Köper 65".into(), ..Default::default() };
    sheet.info.title = "Köper 65".into();
    sheet.info.weave = Some("twill 2/1".into());
    sheet.info.composition = Some("65 % cotton, 31 % polyester, 4 % elastane".into());
    sheet
}

pub(super) fn constitutive(section: ShellSection) -> Constitutive {
    Constitutive {
        section,
        law: None,
        used: Vec::new(),
        inputs: Vec::new(),
        surface_friction: None,
        findings: Vec::new(),
    }
}

pub(super) fn written(name: &str, section: ShellSection) -> Result<String, CardError> {
    let made = constitutive(section);
    card(named(name).unwrap(), &CardInput { sheet: &sheet(), made: &made, stamp: None, crimp: None })
        .map(|c| c.text)
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
    let numbers_after = |command: &str| {
        let line = text.lines().find(|l| l.starts_with(command)).unwrap();
        numbers(line.split_once(',').unwrap().1)
    };
    assert_eq!(numbers_after("SSPA"), [6000.0, 900.0, 0.0, 4000.0, 0.0, 60.0]);
    assert_eq!(numbers_after("SSPD"), [8e-6, 5e-7, 0.0, 4e-6, 0.0, 2.5e-6]);
    assert_eq!((numbers_after("SSPE"), numbers_after("SSPM")), (vec![50.0, 0.0, 45.0], vec![0.118]));
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
    let held = &document["custom"]["kesf"]["section"]["sections"][0];
    for (key, matrix) in [("d_m", section().d_m), ("d_b", section().d_b)] {
        let rows: [[f64; 3]; 3] = serde_json::from_value(held[key].clone()).unwrap();
        assert_eq!(Matrix3::from_fn(|i, j| rows[i][j]), matrix, "{key}");
    }
    assert_eq!(written("u3m", section()).unwrap(), text);
}

fn json(name: &str) -> Value {
    serde_json::from_str(&written(name, section()).unwrap()).unwrap()
}

fn close(found: &Value, expected: f64) {
    assert_relative_eq!(found.as_f64().unwrap(), expected, max_relative = 1e-8);
}

/// `conf.cpp`: 6 x 4 and 3 x 5 numbers; `dde.cpp` doubles the first, and takes the second by the direction of the hinge.
#[test]
fn arcsim_has_the_rows_that_its_sources_read() {
    let card = json("arcsim");
    close(&card["density"], 0.118);
    let stretching = card["stretching"].as_array().unwrap();
    assert_eq!(stretching.len(), 6);
    for row in stretching {
        let k: Vec<f64> = row.as_array().unwrap().iter().map(|c| 2.0 * c.as_f64().unwrap()).collect();
        // Energies of D over [ε11, ε22, 2 ε12].
        assert_relative_eq!(k[..], [6000.0, 900.0, 4000.0, 4.0 * 60.0][..], max_relative = 1e-12);
    }
    let bending = card["bending"].as_array().unwrap();
    assert!(bending.len() == 3 && bending.iter().all(|row| row.as_array().unwrap().len() == 5));
    let strip = |i: usize, j: usize| section().d_b[(i, i)] - 5e-7 * 5e-7 / section().d_b[(j, j)];
    let bias = 0.25 * (8e-6 + 4e-6 + 2.0 * 5e-7) + 2.5e-6;
    for (row, rigidity) in bending.iter().zip([strip(1, 0), bias, strip(0, 1)]) {
        close(&row[0], 4.0 * rigidity);
        close(&row[4], 4.0 * rigidity);
    }
}

/// ARCSim's own examples of a sheet without Poisson's ratio say by their comments what they are of: `paper.json` of
/// E = 5 GPa and h = 0.1 mm, `aluminium.json` of 70 GPa and 25.4 um; they have `stretching` rows of `E h`, 0, `E h`,
/// `E h` (N/m) and `bending` of `E h^3 / 12` (N m), each rounded to two digits. Our card of such a sheet has the same rows in the same
/// units, but for the factors of the code that reads them: it doubles `stretching`, and a hinge of k has the rigidity k/4.
#[test]
fn arcsim_has_the_rows_and_units_of_its_published_examples() {
    for (modulus, thickness, stretch, bend) in [(5e9, 0.1e-3, 0.5e6, 0.4e-3), (70e9, 25.4e-6, 1.8e6, 96e-6)] {
        let stiff: f64 = modulus * thickness;
        let isotropic = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5);
        let section = ShellSection {
            d_m: isotropic * stiff,
            d_b: isotropic * (stiff * thickness * thickness / 12.0),
            thickness,
            ..section()
        };
        let text = written("arcsim", section).unwrap();
        let card: Value = serde_json::from_str(&text).unwrap();
        let rows = |key: &str| -> Vec<Vec<f64>> { serde_json::from_value(card[key].clone()).unwrap() };
        for row in rows("stretching") {
            assert_relative_eq!(
                row[..],
                [0.5 * stretch, 0.0, 0.5 * stretch, stretch][..],
                max_relative = 0.05
            );
        }
        for row in rows("bending") {
            assert_relative_eq!(row[..], [4.0 * bend; 5][..], max_relative = 0.05);
        }
    }
}

/// The reference guide: fields of twenty columns, in the order of LAW19; read back they are the membrane.
#[test]
fn radioss_has_fields_of_twenty_columns() {
    let text = written("radioss", section()).unwrap();
    let at = text.find("/MAT/LAW19/1/1\nKESF_").unwrap();
    let rows: Vec<Vec<f64>> = text[at..]
        .lines()
        .skip(2)
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            assert!(line.len() % 20 == 0 && line.len() <= 100, "{line}");
            line.as_bytes()
                .chunks(20)
                .map(|f| std::str::from_utf8(f).unwrap().trim().parse().unwrap())
                .collect()
        })
        .collect();
    let [rho, e11, e22, nu12, g12, g23, g31, reduced] = rows.concat()[..] else { panic!("{rows:?}") };
    let t = section().thickness;
    let nu21 = nu12 * e22 / e11;
    let q = Matrix3::new(e11, nu21 * e11, 0.0, nu12 * e22, e22, 0.0, 0.0, 0.0, g12 * (1.0 - nu12 * nu21));
    assert_relative_eq!(q * (t / (1.0 - nu12 * nu21)), section().d_m, max_relative = 1e-8, epsilon = 1e-6);
    assert_relative_eq!(rho * t, 0.118, max_relative = 1e-8);
    assert_relative_eq!(Matrix2::new(g31 * t, 0.0, 0.0, g23 * t), section().d_s, max_relative = 1e-8);
    assert_eq!((rows.len(), reduced), (4, 1.0));
}

/// The blocks of `*LOADING DATA` in their order: pairs of stress and strain.
fn loading_data(text: &str) -> Vec<Vec<f64>> {
    let blocks = text.split("*LOADING DATA\n").skip(1);
    blocks.map(|b| b.lines().take_while(|l| !l.starts_with('*')).flat_map(numbers).collect()).collect()
}

#[test]
fn abaqus_fabric_has_measured_curves_as_stress_over_strain() {
    use crate::characterise::{Branch, SpecimenResult};
    use crate::instrument::{Direction, Measurement, Test};
    use crate::quantity::Curve;
    // Two warp specimens of 2000 and 4000 N/m: half the mean strain of 2:1 at every force. The weft and shear have no record.
    let specimen = |stiffness: f64| {
        let curve = Curve::from_points((0..=50).map(|i| f64::from(i) * 10.0).map(|f| (f / stiffness, f)));
        SpecimenResult {
            measurement: Measurement::of_curve(Test::Tensile, Some(Direction::Warp), 1, curve.clone()),
            branches: vec![Branch { cycle: 0, outgoing: true, curve }],
            correction: [0.0; 2],
            windows: Vec::new(),
            fits: Vec::new(),
            values: Default::default(),
            moduli: Default::default(),
        }
    };
    let sheet = FabricSheet { specimens: vec![specimen(2000.0), specimen(4000.0)], ..sheet() };
    let section = section();
    let made = Constitutive {
        section,
        law: None,
        used: Vec::new(),
        inputs: Vec::new(),
        surface_friction: None,
        findings: Vec::new(),
    };
    let card = card(
        named("abaqus-fabric").unwrap(),
        &CardInput { sheet: &sheet, made: &made, stamp: None, crimp: None },
    )
    .unwrap();
    let [warp, weft, shear] = loading_data(&card.text).try_into().unwrap();
    let (t, last) = (4e-4, warp.len() - 2);
    assert_relative_eq!(warp[last], 500.0 / t, max_relative = 1e-9);
    assert_relative_eq!(warp[last + 1], 0.5 * (500.0 / 2000.0 + 500.0 / 4000.0), max_relative = 1e-9);
    assert_eq!((warp[0], warp[1], weft[0]), (0.0, -1.0, 0.0), "yarns carry no push");
    assert!(warp.chunks(2).collect::<Vec<_>>().windows(2).all(|w| w[1][1] > w[0][1]));
    // Strips along the weft: D22 - D12²/D11. A swap of warp and weft or a lost thickness is seen here.
    let secant = |data: &[f64]| data[data.len() - 2] / data[data.len() - 1] * t;
    assert_relative_eq!(secant(&weft), 4000.0 - 900.0 * 900.0 / 6000.0, max_relative = 1e-8);
    assert_relative_eq!(secant(&shear), 60.0, max_relative = 1e-8);
    assert!(card.text.contains("n = 2") && card.text.contains("the input has no curve"));
    assert!(card.text.contains(&format!("*DENSITY\n{},", super::text::number(0.118 / t))));
    assert_eq!(card.findings.len(), 4);
}

/// The manual of LS-DYNA: fields of ten columns; read back they are the membrane.
#[test]
fn lsdyna_has_fields_of_ten_columns() {
    let text = written("lsdyna", section()).unwrap();
    let block = |keyword: &str| -> Vec<Vec<f64>> {
        let lines = text.lines().skip_while(|l| *l != keyword).skip(2).take_while(|l| !l.starts_with('*'));
        let real = |f: &[u8]| std::str::from_utf8(f).unwrap().trim().parse().unwrap_or(f64::NAN);
        lines
            .map(|line| {
                assert!(line.len() % 10 == 0 && line.len() <= 80, "{line}");
                line.as_bytes().chunks(10).map(real).collect()
            })
            .collect()
    };
    let (shell, fabric) = (block("*SECTION_SHELL_TITLE"), block("*MAT_FABRIC_TITLE"));
    assert_eq!((shell.len(), fabric.len(), fabric[2][5]), (2, 6, 14.0));
    let t = shell[1][0];
    assert_relative_eq!(t, section().thickness, max_relative = 1e-4);
    let [_, rho, ea, eb, _, prba, prab, _] = fabric[0][..] else { panic!("{fabric:?}") };
    let gab = fabric[1][0];
    // PRBA EA = PRAB EB, and the fields hold five digits.
    assert_relative_eq!(prba * ea, prab * eb, max_relative = 1e-3);
    let free = 1.0 - prba * prab;
    let q = Matrix3::new(ea, prba * ea, 0.0, prba * ea, eb, 0.0, 0.0, 0.0, gab * free) * (t / free);
    assert_relative_eq!(q, section().d_m, max_relative = 1e-3, epsilon = 1e-6);
    assert_relative_eq!(rho * t, 0.118, max_relative = 1e-3);
}

/// The open fabric file is an input like a section, and loses nothing of it.
#[test]
fn the_open_fabric_file_is_read_back() {
    use crate::report::read_back::{ReadDocument, read};
    let text = written("fabric", section()).unwrap();
    let Some(ReadDocument::Sections(found)) = read(text.as_bytes()).unwrap() else { panic!("no section") };
    let [(sheet, made)] = &found[..] else { panic!("{}", found.len()) };
    assert_eq!((sheet.name.as_str(), &made.section), ("Köper 65", &section()));
    assert!(read(text.replace("\"d_m\"", "\"a\"").as_bytes()).is_err());
}

/// What is exchanged, slipped by a unit or doubled in a section is another number in the card of every program.
#[test]
fn a_planted_mistake_is_another_card() {
    let mistakes: [fn(&mut ShellSection); 4] = [
        |s| s.d_m = Matrix3::new(4000.0, 900.0, 0.0, 900.0, 6000.0, 0.0, 0.0, 0.0, 60.0),
        |s| s.d_m *= 1e-3,
        |s| s.d_m[(2, 2)] *= 2.0,
        |s| s.areal_density *= 1e3,
    ];
    for target in EXPORTERS {
        let own = written(target.name, section()).unwrap();
        for plant in mistakes {
            let mut other = section();
            plant(&mut other);
            // MuJoCo has no shear stiffness, and Browzwear none whose definition is published.
            let shows = !["mujoco", "browzwear"].contains(&target.name)
                || other.d_m[(2, 2)] / other.d_m[(0, 0)] == 0.01;
            // A mesh has no constants.
            assert!(
                !shows || target.name == "kratos-mesh" || written(target.name, other).unwrap() != own,
                "{}",
                target.name
            );
        }
    }
}

/// Units of Browzwear's help: dyn cm, N/m, g/m² and mm; length is the warp. Read back it is the strip of the section.
#[test]
fn browzwear_has_documented_units() {
    let card = json("browzwear");
    assert_eq!((&card["schema"], &card["raw_data"]), (&Value::from("1.1"), &Value::Null));
    let block = &card["custom"]["browzwear"];
    let number = |v: &Value| v.as_str().unwrap().parse::<f64>().unwrap();
    let strip = |d: &Matrix3<f64>, i: usize| d[(i, i)] - d[(0, 1)] * d[(0, 1)] / d[(1 - i, 1 - i)];
    let s = section();
    for (i, key) in ["length", "width"].iter().enumerate() {
        // 1 dyn = 1e-5 N.
        assert_relative_eq!(number(&block["bend"][key]) * 1e-5 * 1e-2, strip(&s.d_b, i), max_relative = 1e-8);
        assert_relative_eq!(number(&block["stretch"][key]), strip(&s.d_m, i), max_relative = 1e-8);
    }
    assert_relative_eq!(number(&block["mass"]), 118.0, max_relative = 1e-8);
    assert_relative_eq!(number(&block["thickness"]), 0.4, max_relative = 1e-8);
    for none in ["shear", "friction", "stretch_linearity"] {
        assert!(block.get(none).is_none(), "{none}");
    }
}

/// `USDImportNode_v2.cpp`: factors 1e-5 to kg·cm²/s², 1e-3 to kg/s², 1e3 to kg/m², 1e-1 to cm; the prims that it looks for.
#[test]
fn clo_is_what_unreal_reads() {
    let text = written("clo", section()).unwrap();
    let primvar = |key: &str| -> f64 {
        let head = format!("float[] primvars:clo:{key} = [");
        let line = text.lines().find_map(|l| l.trim().strip_prefix(&head)).unwrap();
        line.trim_end_matches(']').parse().unwrap()
    };
    let s = section();
    let strip = |d: &Matrix3<f64>, i: usize| d[(i, i)] - d[(0, 1)] * d[(0, 1)] / d[(1 - i, 1 - i)];
    // 1 kg·cm²/s² = 1e-4 N·m.
    for (key, i) in [("bendingWarp", 0), ("bendingWeft", 1)] {
        assert_relative_eq!(primvar(key) * 1e-5 * 1e-4, strip(&s.d_b, i), max_relative = 1e-8);
    }
    for (key, i) in [("stretchWarp", 0), ("stretchWeft", 1)] {
        assert_relative_eq!(primvar(key) * 1e-3, strip(&s.d_m, i), max_relative = 1e-8);
    }
    for side in ["Left", "Right"] {
        assert_relative_eq!(primvar(&format!("shear{side}")) * 1e-3, 60.0, max_relative = 1e-8);
        let bias = 0.25 * (8e-6 + 4e-6 + 2.0 * 5e-7) + 2.5e-6;
        assert_relative_eq!(primvar(&format!("bendingBias{side}")) * 1e-9, bias, max_relative = 1e-8);
    }
    assert_relative_eq!(primvar("density") * 1e3, 0.118, max_relative = 1e-8);
    assert_relative_eq!(primvar("thickness") * 0.1, 0.04, max_relative = 1e-8);
    for schema in ["ClothRootAPI", "SimMeshDataAPI", "SimPatternAPI"] {
        assert!(text.contains(&format!("prepend apiSchemas = [\"{schema}\"]")), "{schema}");
    }
    assert!(text.contains("familyName = \"pattern\"") && text.contains("elementType = \"face\""));
}

/// A factor 2 that is lost or added in the bending of any card that holds bending is another card.
#[test]
fn a_lost_factor_in_bending_is_another_card() {
    let plants: [fn(&mut ShellSection); 2] = [|s| s.d_b *= 2.0, |s| s.d_b[(0, 0)] = 9e-6];
    for target in EXPORTERS.iter().filter(|t| {
        !["lsdyna", "radioss", "radioss-fabric", "radioss-fabric-a", "abaqus-fabric", "kratos-mesh"]
            .contains(&t.name)
    }) {
        let own = written(target.name, section()).unwrap();
        for plant in plants {
            let mut other = section();
            plant(&mut other);
            assert!(written(target.name, other).unwrap() != own, "{}", target.name);
        }
    }
}

/// What fields of eight or ten columns cannot hold is refused for all programs alike.
#[test]
fn numbers_that_no_cloth_has_are_refused() {
    let tiny = ShellSection { thickness: 1e-203, ..section() };
    for target in EXPORTERS {
        let error = written(target.name, tiny.clone()).unwrap_err().to_string();
        assert!(
            error.starts_with("O046 a stiffness, mass or thickness of 1e-203"),
            "{}: {error}",
            target.name
        );
    }
}
