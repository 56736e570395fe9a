//! Goal: a sheet that `kesf solve` drapes arrives elsewhere as the shape that it is, and of what it is.
//! Sketch: the shipped Cusick drape of the poplin on few cells; its glTF file and its USD stage in Blender, its stage in
//! newton (USD's own library reads it there). References: the sizes of the case, the section, the drape coefficient that
//! the document states, which newton's points show again by a shadow of their own.

use super::*;

/// Radii of the disc and of the sheet (m).
const RADII: [f64; 2] = [0.09, 0.15];

/// The JSON part of a binary glTF file (Khronos, glTF 2.0, 4.4): a header of 12 bytes, the length and kind of the part.
fn gltf_document(bytes: &[u8]) -> serde_json::Value {
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).unwrap()
}

/// Solves `cases/drape.toml` of the poplin on few cells into `out` of a folder.
fn solve_drape(folder: &Path) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let case = std::fs::read_to_string(root.join("cases/drape.toml")).unwrap();
    let coarse = [
        ("cells = [14, 90]", "cells = [6, 40]"),
        ("folds = [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]", "folds = [4]"),
        ("refinements = 1", "refinements = 0"),
        ("#:schema", "#"),
    ];
    let case = coarse.iter().fold(case, |text, (own, few)| text.replace(own, few));
    std::fs::write(folder.join("drape.toml"), case).unwrap();
    let ran = Command::new(env!("CARGO_BIN_EXE_kesf"))
        .args(["-q", "solve", "drape.toml"])
        .arg(root.join("kesf_data/poplin"))
        .args(["-o", "out"])
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    folder.join("out")
}

/// The only file of an ending in a folder of results.
fn file_below(folder: &Path, ending: &str) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?.map(|entry| entry.unwrap().path());
    entries.into_iter().find_map(|path| match path.extension() {
        Some(own) if own == ending => Some(path),
        _ if path.is_dir() => file_below(&path, ending),
        _ => None,
    })
}

/// What a script says of a file, as JSON on its last line.
fn said(program: &Program, script: &str, file: &Path) -> serde_json::Value {
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/exchange");
    let ran = Command::new(program.python())
        .arg(scripts.join(script))
        .arg(file)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    let last = said.lines().rfind(|l| l.starts_with('{')).unwrap_or_default();
    serde_json::from_str(last).unwrap_or_else(|_| panic!("{said}\n{}", String::from_utf8_lossy(&ran.stderr)))
}

/// Lowest and highest corner of a mesh.
fn box_of(answer: &serde_json::Value, name: &str) -> [Vec<f64>; 2] {
    [0, 1].map(|end| {
        let corner = answer["boxes"][name][end].as_array().unwrap_or_else(|| panic!("{name}: {answer}"));
        corner.iter().map(|v| v.as_f64().unwrap()).collect()
    })
}

fn near(found: &[f64], stated: &[f64], by: f64) -> bool {
    found.len() == stated.len() && found.iter().zip(stated).all(|(a, b)| (a - b).abs() <= by)
}

/// A drape as a shape: Blender imports the files that `kesf solve` writes, as large as they say, in metres and upright.
#[test]
fn blender_opens_a_drape() {
    let blender = PROGRAMS.iter().find(|p| p.target == "blender").unwrap();
    if !blender.is_there() {
        return common::skipped("drape", "blender is not installed; ci/exchange installs it");
    }
    let folder = tempfile::tempdir().unwrap();
    let out = solve_drape(folder.path());
    let file = file_below(&out, "glb").expect("a .glb file");
    let answer = said(blender, "blender_drape.py", &file);
    println!("{answer}");
    let document = gltf_document(&std::fs::read(&file).unwrap());
    // z is upwards in both, and metres are units.
    for (mesh, name) in ["deflected", "outline before"].iter().enumerate() {
        let place =
            document["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"].as_u64().unwrap() as usize;
        for (end, key) in ["min", "max"].iter().enumerate() {
            let stated: Vec<f64> =
                serde_json::from_value(document["accessors"][place][*key].clone()).unwrap();
            assert!(near(&box_of(&answer, name)[end], &stated, 1e-6), "{name}, {key}: {answer}");
        }
    }
    // The sheet before is 30 cm wide and flat; hung, it is narrower, and deep by no more than its ring of 6 cm.
    let [low, high] = box_of(&answer, "outline before");
    assert!(near(&[high[0] - low[0], high[1] - low[1]], &[2.0 * RADII[1]; 2], 1e-6), "{answer}");
    // Blender turns in single precision.
    assert!((high[2] - low[2]).abs() < 1e-6, "{answer}");
    let [low, high] = box_of(&answer, "deflected");
    assert!(high[0] - low[0] < 0.3 && (0.01..=0.0601).contains(&(high[2] - low[2])), "{answer}");
    assert!(low[2] < -0.01, "it hangs: {answer}");
    assert_eq!(answer["said"]["scale_factor"], 1.0, "{answer}");
    // The stage has the same shape, and the disc beside.
    let stage = said(blender, "blender_drape.py", &file_below(&out, "usda").expect("a .usda file"));
    let [lowest, highest] = box_of(&stage, "sim");
    assert!(near(&lowest, &low, 1e-6) && near(&highest, &high, 1e-6), "{stage} beside {answer}");
}

/// The stage of a drape, read by USD's library and by newton: shape, rest shape and material arrive.
#[test]
fn newton_reads_a_drape() {
    let newton = PROGRAMS.iter().find(|p| p.target == "usd").unwrap();
    if !newton.is_there() {
        return common::skipped("drape", "newton is not installed; ci/exchange installs it");
    }
    let folder = tempfile::tempdir().unwrap();
    let out = solve_drape(folder.path());
    let answer = said(newton, "newton_drape.py", &file_below(&out, "usda").expect("a .usda file"));
    println!("{answer}");
    let number = |key: &str| answer[key].as_f64().unwrap_or_else(|| panic!("{key}: {answer}"));
    let section = poplin().1.section;
    let document: serde_json::Value =
        serde_json::from_slice(&std::fs::read(file_below(&out, "json").unwrap()).unwrap()).unwrap();
    let stated = document["solutions"][0]["results"]["drape"]["coefficient"]
        .as_f64()
        .unwrap_or_else(|| panic!("{document}"));
    // A regular polygon of 40 corners, as the case has cells.
    let around = 40.0;
    let polygon = |r: f64| 0.5 * around * (std::f64::consts::TAU / around).sin() * r * r;
    let expected = [
        ("area", polygon(RADII[1]), 1e-5),
        ("held_area", polygon(RADII[0]), 1e-5),
        ("mass", section.areal_density * polygon(RADII[1]), 1e-5),
        ("tensile", reference(&section, "mean_tensile"), SINGLE),
        ("bend", reference(&section, "mean_rigidity"), SINGLE),
        ("shear", reference(&section, "shear"), SINGLE),
        ("thickness", section.thickness, SINGLE),
        ("density", section.areal_density / section.thickness, SINGLE),
        // Its shadow is cut into 3600 rays.
        ("coefficient", stated, 5e-3),
    ];
    for (key, reference, bound) in expected {
        let off = number(key) / reference - 1.0;
        println!("newton: drape {key} {:+.4} %", 100.0 * off);
        assert!(off.abs() <= bound, "{key}: {} beside {reference}, {answer}", number(key));
    }
    // Cloth in its own weight bends, and stretches by some thousandths: rest shape and shape are of the same points. Chords of
    // folds are shorter than the cloth.
    assert!(number("longer") < 0.005, "{answer}");
    assert!((0.99..1.0).contains(&(number("area_now") / number("area"))), "{answer}");
    // Hinges are flat at rest and bent now; the disc has not moved.
    assert!(number("rest_angle") < 1e-6 && number("angle") > 0.1, "{answer}");
    assert!(number("held_moved") < 1e-6, "{answer}");
}
