//! Reading of whole folders: the shipped fabrics, and the real FAB record where it is present.

use std::path::{Path, PathBuf};

use approx::assert_relative_eq;
use kesf::instrument::fab::FabKind;
use kesf::instrument::{Direction, Parameter, ReadSettings, Test, read_fabrics};

/// Every synthetic fabric has 3 specimens of 4 tests in 2 directions (compression has none).
#[test]
fn the_shipped_fabrics_are_read_completely() {
    let root = std::env::var_os("KESF_DATA").map_or_else(|| PathBuf::from("kesf_data"), PathBuf::from);
    for name in ["poplin", "twill", "satin"] {
        let folder = root.join(name);
        if !folder.is_dir() {
            println!("skipped: no {}", folder.display());
            continue;
        }
        let batch = read_fabrics(&[folder], &ReadSettings::default(), &|_: &Path| ());
        assert_eq!(batch.failures, [], "{name}");
        let fabric = &batch.fabrics[0];
        assert_eq!(fabric.name, name);
        assert_eq!(fabric.findings, [], "{name}");
        for test in Test::ALL {
            let directions: &[_] = match test {
                Test::Compression => &[None],
                _ => &[Some(Direction::Warp), Some(Direction::Weft)],
            };
            for direction in directions {
                let of: Vec<_> = fabric
                    .measurements
                    .iter()
                    .filter(|m| m.test == test && m.direction == *direction)
                    .collect();
                assert_eq!(
                    of.iter().map(|m| m.specimen).collect::<Vec<_>>(),
                    [1, 2, 3],
                    "{name} {test:?} {direction:?}"
                );
                for m in of {
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
        println!("skipped: no {}", folder.display());
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
    assert!(emt.inferred);
    assert_relative_eq!(emt.mean, 0.313, max_relative = 1e-14);
}

/// The measured FAB record: every strip, and numbers copied from the file by hand.
#[test]
fn the_real_fab_record_is_read() {
    let file = Path::new("../shared/data/u3m/physics_example2.json");
    if !file.is_file() {
        println!("skipped: no {}", file.display());
        return;
    }
    let batch = read_fabrics(&[file.to_path_buf()], &ReadSettings::default(), &|_: &Path| ());
    assert_eq!(batch.failures, []);
    let fab = &batch.fabrics[0].fab[0];
    assert_eq!(fab.tests.len(), 15, "5 tests in 3 directions");
    assert_eq!(fab.name.as_deref(), Some("SU-1098 Cupro"));
    assert_relative_eq!(fab.areal_density.unwrap(), 0.1055999984741211, max_relative = 1e-12);
    assert_eq!(fab.thickness.len(), 10);
    // The first contact is 0.010464... cm thick.
    assert_relative_eq!(fab.thickness[0], 1.0464174672961237e-4, max_relative = 1e-12);
    let s1 = fab.tests.iter().find(|t| t.direction == Direction::Warp && t.kind == FabKind::S1).unwrap();
    assert_eq!(s1.branches.len(), 8);
    assert_eq!(s1.branches[0].len(), 78);
    assert_relative_eq!(s1.width, 0.05);
    assert_relative_eq!(s1.length, 2.0833001136779785e-2, max_relative = 1e-12);
    // First sample: 1.94525... cm and -2.430284... gf.
    assert_relative_eq!(s1.gap(), 1.9452528953552248e-2, max_relative = 1e-12);
    assert_relative_eq!(s1.branches[0].y[0], -2.430284023284912 * 9.80665e-3, max_relative = 1e-12);
}
