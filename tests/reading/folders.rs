//! Reading of whole folders: the shipped fabrics, and the real FAB record where it is present.

use std::path::{Path, PathBuf};

use approx::assert_relative_eq;
use kesf::characterise::{Key, Settings, ValueStatus, characterise};
use kesf::instrument::fab::FabKind;
use kesf::instrument::{Direction, FabricInput, Parameter, ReadSettings, Shape, Test, parse, read_fabrics};

use crate::common;

/// Every synthetic fabric has 3 specimens of 4 tests in 2 directions (compression has none).
#[test]
fn the_shipped_fabrics_are_read_completely() {
    let root = std::env::var_os("KESF_DATA").map_or_else(|| PathBuf::from("kesf_data"), PathBuf::from);
    for name in ["poplin", "twill", "satin"] {
        let folder = root.join(name);
        if !folder.is_dir() {
            common::skipped("the_shipped_fabrics_are_read_completely", &format!("no {}", folder.display()));
            continue;
        }
        let batch = read_fabrics(&[folder], &ReadSettings::default(), &|_: &Path| ());
        assert_eq!(batch.failures, [], "{name}");
        let fabric = &batch.fabrics[0];
        assert_eq!(fabric.name, name);
        assert_eq!(fabric.findings, [], "{name}");
        // Of the surface there are no shipped curves.
        for test in Test::ALL.into_iter().filter(|t| t.shape() != Shape::Sweep) {
            let directions: &[_] = match test {
                Test::Compression => &[None],
                _ => &[Some(Direction::Warp), Some(Direction::Weft)],
            };
            for direction in directions {
                let measurements: Vec<_> = fabric
                    .measurements
                    .iter()
                    .filter(|m| m.test == test && m.direction == *direction)
                    .collect();
                assert_eq!(
                    measurements.iter().map(|m| m.specimen).collect::<Vec<_>>(),
                    [1, 2, 3],
                    "{name} {test:?} {direction:?}"
                );
                for m in measurements {
                    assert_eq!(m.sample.as_deref(), Some(name));
                    assert_eq!(m.conditions.width, 0.2);
                    let max = |v: &[f64]| v.iter().copied().fold(f64::MIN, f64::max);
                    let (x, y) = (max(&m.curve.x), max(&m.curve.y));
                    // The set maxima in SI: 490 N/m, 8 deg, 250 1/m, 4.9 kPa.
                    match test {
                        Test::Tensile => assert!(x < 0.2 && (480.0..500.0).contains(&y), "{name} {x} {y}"),
                        Test::Shear => assert!((0.138..0.141).contains(&x) && y < 30.0, "{name} {x} {y}"),
                        Test::Bending => assert!((249.0..251.0).contains(&x) && y < 0.01, "{name} {x} {y}"),
                        Test::Compression => {
                            assert!(x < 2e-3 && (4700.0..5100.0).contains(&y), "{name} {x} {y}")
                        }
                        Test::Friction | Test::Roughness => panic!("{name}: a sweep"),
                    }
                }
            }
        }
    }
}

/// The published tables, against the numbers printed in them.
#[test]
fn published_result_tables_are_read() {
    let folder = Path::new("../shared/data/published");
    if !folder.is_dir() {
        common::skipped("published_result_tables_are_read", &format!("no {}", folder.display()));
        return;
    }
    let batch = read_fabrics(&[folder.to_path_buf()], &ReadSettings::default(), &|_: &Path| ());
    assert_eq!(batch.failures, []);
    let names: Vec<_> = batch.fabrics.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names, ["A", "B", "C", "F", "M1", "M2", "M3", "M4", "M5", "M6"]);
    let value = |fabric: usize, parameter, direction| {
        let results = &batch.fabrics[fabric].results;
        results.iter().find(|r| r.parameter == parameter && r.direction == direction).unwrap()
    };
    // Cotton broad: B = 0.118 gf·cm²/cm, of which one is 9.80665e-5 N·m; W = 12.38 mg/cm².
    assert_relative_eq!(value(0, Parameter::B, None).mean, 0.118 * 9.80665e-5, max_relative = 1e-14);
    assert_relative_eq!(value(0, Parameter::W, None).mean, 0.1238, max_relative = 1e-14);
    // M2: B weft = 0.33 µN·m; EMT weft = 31.3 %, marked as inferred in the table.
    assert_relative_eq!(value(5, Parameter::B, Some(Direction::Weft)).mean, 0.33e-6, max_relative = 1e-14);
    let emt = value(5, Parameter::Emt, Some(Direction::Weft));
    assert!(emt.status == ValueStatus::Inferred);
    assert_relative_eq!(emt.mean, 0.313, max_relative = 1e-14);
}

/// The measured FAB record: every strip, and numbers copied from the file by hand.
#[test]
fn the_real_fab_record_is_read() {
    let file = Path::new("../shared/data/u3m/physics_example2.json");
    if !file.is_file() {
        common::skipped("the_real_fab_record_is_read", &format!("no {}", file.display()));
        return;
    }
    let batch = read_fabrics(&[file.to_path_buf()], &ReadSettings::default(), &|_: &Path| ());
    assert_eq!(batch.failures, []);
    let fab = &batch.fabrics[0].fab[0];
    assert_eq!(fab.tests.len(), 15, "5 tests in 3 directions");
    assert_eq!(fab.name.as_deref(), Some("SU-1098 Cupro"));
    assert_relative_eq!(fab.areal_density.unwrap(), 0.1055999984741211, max_relative = 1e-12);
    assert_eq!(fab.contacts.len(), 5, "every other of ten branches is loading");
    // The first contact is 0.010464... cm thick, at 558.999... gf.
    assert_relative_eq!(fab.contacts[0].thickness, 1.0464174672961237e-4, max_relative = 1e-12);
    assert_relative_eq!(fab.contacts[0].force, 558.9993896484375 * 9.80665e-3, max_relative = 1e-12);
    assert_relative_eq!(fab.program_thickness.unwrap(), 1.0464175045490265e-4, max_relative = 1e-12);
    assert!(!fab.is_knit);
    let s1 = fab.tests.iter().find(|t| t.direction == Direction::Warp && t.kind == FabKind::S1).unwrap();
    assert_eq!(s1.branches.len(), 8);
    assert_eq!(s1.branches[0].len(), 78);
    assert_relative_eq!(s1.width, 0.05);
    assert_relative_eq!(s1.length, 2.0833001136779785e-2, max_relative = 1e-12);
    // First sample: 1.94525... cm and -2.430284... gf.
    assert_relative_eq!(s1.gap(), 1.9452528953552248e-2, max_relative = 1e-12);
    assert_relative_eq!(s1.branches[0].y[0], -2.430284023284912 * 9.80665e-3, max_relative = 1e-12);
}

const CURVE: &str = "direction,warp\nK (1/cm),M (gf·cm/cm)\n0,0\n1,0.1\n2,0.2\n";

/// Files below a folder, by their paths.
fn write(root: &Path, files: &[(&str, &str)]) {
    for (name, text) in files {
        let path = root.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
}

fn names(inputs: &[PathBuf]) -> Vec<(String, usize)> {
    let batch = read_fabrics(inputs, &ReadSettings::default(), &|_: &Path| ());
    batch.fabrics.into_iter().map(|f| (f.name, f.measurements.len())).collect()
}

/// Results of this program lie among the data: they are passed by.
#[test]
fn folders_of_results_are_no_fabrics() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let table = "direction,B (gf·cm²/cm),G (N/m)\nwarp,0.1,30\n";
    write(
        root,
        &[
            ("poplin/a_warp_FB2_1.csv", CURVE),
            ("results/fabrics.csv", table),
            (
                "results/.kesf-manifest.json",
                r#"{"files": {"fabrics.csv": "", "poplin/b_warp_FB2_1.csv": ""}}"#,
            ),
            ("results/poplin/b_warp_FB2_1.csv", CURVE),
            ("twill/fabric.toml", ""),
            ("twill/a_warp_FB2_1.csv", CURVE),
            ("twill/out/b_warp_FB2_1.csv", CURVE),
            // As a run that was killed leaves it.
            ("twill/out/.kesf-journal", "[\"b_warp_FB2_1.csv\",\"\"]\n[\"c.c"),
            // Cards were exported into the folders of two fabrics, and beside their folders.
            ("lab/cotton/c_warp_FB2_1.csv", CURVE),
            ("lab/cotton/.kesf-manifest.json", r#"{"files": {"cotton.inp": ""}}"#),
            ("lab/wool/fabric.toml", ""),
            ("lab/wool/d_warp_FB2_1.csv", CURVE),
            ("lab/wool/.kesf-manifest.json", r#"{"files": {"wool.inp": ""}}"#),
            ("lab/.kesf-manifest.json", r#"{"files": {"cotton.inp": ""}}"#),
        ],
    );
    let fabrics = ["cotton", "wool", "poplin", "twill"].map(|name| (name.to_string(), 1));
    assert_eq!(names(&[root.to_path_buf()]), fabrics);
    // Named as an input they are none either, and told.
    assert_eq!(names(&[root.join("results")]), []);
    let batch = read_fabrics(&[root.join("results")], &ReadSettings::default(), &|_: &Path| ());
    assert_eq!(batch.findings.iter().map(|f| f.code()).collect::<Vec<_>>(), ["O061", "O061"]);
}

/// A fabric that is lost by its fabric.toml or dialect.toml is called like its folder.
#[test]
fn a_bad_fabric_file_names_its_fabric() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    write(
        root,
        &[
            ("a/fabric.toml", "name = 1"),
            ("a/a_warp_FB2_1.csv", CURVE),
            ("b/dialect.toml", "x"),
            ("b/b_warp_FB2_1.csv", CURVE),
        ],
    );
    let failures_of = |inputs: &[PathBuf]| -> Vec<_> {
        let batch = read_fabrics(inputs, &ReadSettings::default(), &|_: &Path| ());
        assert!(batch.fabrics.is_empty());
        batch.failures.iter().map(|e| (e.code(), e.about.fabric.clone().unwrap_or_default())).collect()
    };
    assert_eq!(failures_of(&[root.to_path_buf()]), [("R019", "a".to_string()), ("R020", "b".to_string())]);
    // Named directly, and told once.
    let file = root.join("a/a_warp_FB2_1.csv");
    assert_eq!(failures_of(&[file.clone(), file]), [("R019", "a".to_string())]);
}

/// Files that are named belong to the fabric of their folder, and those of one folder are one fabric.
#[test]
fn files_that_are_named_know_their_fabric() {
    let root = Path::new("kesf_data/poplin");
    let file = |name: &str| root.join(name);
    let inputs = [file("poplin_weft_FB2_1.csv"), "kesf_data/petrak_m1".into(), file("poplin_warp_FB2_1.csv")];
    let batch = read_fabrics(&inputs, &ReadSettings::default(), &|_: &Path| ());
    let found: Vec<_> =
        batch.fabrics.iter().map(|f| (f.name.as_str(), f.measurements.len(), f.path.clone())).collect();
    assert_eq!(found, [("poplin", 2, root.into()), ("petrak_m1", 0, "kesf_data/petrak_m1".into())]);
    let poplin = &batch.fabrics[0];
    assert_eq!((poplin.info.origin.name(), poplin.info.title.as_str()), ("synthetic", "Poplin (synthetic)"));
    assert_eq!(poplin.findings, []);
    // One file is its own path.
    let one = read_fabrics(&inputs[..1], &ReadSettings::default(), &|_: &Path| ());
    assert_eq!((one.fabrics[0].name.as_str(), &one.fabrics[0].path), ("poplin", &inputs[0]));
    // A file that cannot be read gives no fabric.
    let none = read_fabrics(&[file("no.csv")], &ReadSettings::default(), &|_: &Path| ());
    assert_eq!((none.fabrics.len(), none.failures.len()), (0, 1));

    let folder = tempfile::tempdir().unwrap();
    let dialect = "name = \"lab\"\n[columns]\ncurvature = [\"foo\"]\n";
    write(
        folder.path(),
        &[
            ("a/fabric.toml", ""),
            ("a/dialect.toml", dialect),
            ("a/raw/x_1.csv", &CURVE.replace('K', "foo")),
            ("a/raw/x_2.csv", &CURVE.replace('K', "foo")),
            ("b/x_1.csv", CURVE),
            ("b/x_2.csv", CURVE),
        ],
    );
    let file = |name: &str| folder.path().join(name);
    assert_eq!(
        names(&[file("a/raw/x_1.csv"), file("a/raw/x_2.csv"), file("a/raw/x_1.csv")]),
        [("a".into(), 2)]
    );
    // Without a fabric.toml each is its own; what stands before a `..` is not above it.
    assert_eq!(names(&[file("b/x_1.csv"), file("b/x_2.csv")]), [("x".into(), 1), ("x".into(), 1)]);
    assert_eq!(names(&[file("a/raw/../../b/x_1.csv")]), [("x".into(), 1)]);
}

/// What a table says of each value goes with it, in words of several languages; what is not known is told by line and word.
#[test]
fn the_status_of_a_table_is_that_of_its_values() {
    let text = "parameter,direction,mean,unit,status\nB,warp,0.1,gf·cm²/cm,published\nB,weft,0.09,gf·cm²/cm,doubtful\n\
                2HB,warp,0.05,gf·cm/cm,calculated\nT0,,0.5,mm,assumed\nTm,,0.3,mm,estimated\nG,warp,0.7,gf/(cm·deg),angenommen\n\
                G,weft,0.7,gf/(cm·deg),approved\nW,,12,mg/cm²,mean_of_warp_and_weft\n";
    let content = parse(Path::new("t.csv"), text.as_bytes(), &ReadSettings::default()).unwrap();
    let told: Vec<String> =
        content.findings.iter().filter(|f| f.code() == "R140").map(ToString::to_string).collect();
    assert!(told.len() == 1 && told[0].starts_with("t.csv:8: ") && told[0].contains("\"approved\" (line 8)"));
    let results = content.results.into_iter().map(|(_, value)| value).collect();
    let input = FabricInput { name: "x".into(), results, ..FabricInput::default() };
    let sheet = characterise(&input, &Settings::default());
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    for (parameter, direction, status) in [
        (Parameter::B, warp, ValueStatus::Measured),
        (Parameter::B, weft, ValueStatus::Doubtful),
        (Parameter::Hb, warp, ValueStatus::Inferred),
        (Parameter::T0, None, ValueStatus::Assumed),
        (Parameter::Tm, None, ValueStatus::Assumed),
        (Parameter::G, warp, ValueStatus::Assumed),
        (Parameter::G, weft, ValueStatus::Measured),
        (Parameter::W, None, ValueStatus::Measured),
    ] {
        assert_eq!(sheet.status(Key { parameter, direction }), status, "{parameter} {direction:?}");
    }
    // A mean is no better than the worst of its repeats, whichever comes first.
    let repeats = "parameter,direction,mean,unit,status\nB,warp,0.1,gf·cm²/cm,measured\nB,warp,0.12,gf·cm²/cm,assumed\n";
    let content = parse(Path::new("t.csv"), repeats.as_bytes(), &ReadSettings::default()).unwrap();
    assert_eq!(content.results[0].1.status, ValueStatus::Assumed);
}

/// A fabric.toml that does not say where the data come from is told, once; one that does is not.
#[test]
fn an_origin_that_nobody_states_is_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.csv"), "parameter,direction,mean,unit\nB,warp,0.1,gf·cm²/cm\n")
        .unwrap();
    for (toml, told) in [("name = \"x\"\n", 1), ("origin = \"measured\"\n", 0)] {
        std::fs::write(folder.path().join("fabric.toml"), toml).unwrap();
        let batch = read_fabrics(&[folder.path().to_path_buf()], &ReadSettings::default(), &|_: &Path| ());
        let found = batch.fabrics[0].findings.iter().filter(|f| f.code() == "R141").count();
        assert_eq!(found, told, "{toml}");
    }
}
