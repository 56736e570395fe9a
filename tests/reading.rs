//! Reading of whole folders: the shipped fabrics, and the real FAB record where it is present.

use std::path::{Path, PathBuf};

use kesf::instrument::{Direction, ReadSettings, Test, read_fabrics};

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
