//! What people write: cases, `fabric.toml`, settings, dialects.

use std::cell::RefCell;
use std::fs;
use std::path::Path;

use kesf::case::Case;
use kesf::characterise::Settings;
use kesf::instrument::{DIALECT_FILES, Dialect, FabricInfo, ReadSettings, parse, read_fabrics};

use crate::{Damage, Target, corpus};

/// Case files.
pub fn case() -> Target {
    let mut seeds = corpus::shipped("cases", &[".toml"]);
    seeds.extend(corpus::shipped("examples", &[".toml"]));
    Target { seeds, damaged: Damage::of, size: <[u8]>::len, holds: case_holds }
}

fn case_holds(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let path = Path::new("case.toml");
    match Case::parse(path, text) {
        Ok(case) => {
            let again = Case::parse(path, &anew(text)).unwrap_or_else(|e| panic!("{e}\n{}", anew(text)));
            assert_eq!(
                without_places(&format!("{:?}", case.problem)),
                without_places(&format!("{:?}", again.problem))
            );
            assert_eq!((case.title, case.source), (again.title, again.source));
            true
        }
        Err(error) => {
            assert!(error.to_string().contains("case.toml"), "{error}");
            false
        }
    }
}

/// The same document in other words: what a writer of TOML makes of it.
fn anew(text: &str) -> String {
    let table: toml::Table = toml::from_str(text).expect("TOML that was accepted");
    toml::to_string(&table).expect("TOML of a table")
}

/// A text of a case without the lines and columns of its values.
fn without_places(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("line: ").into_iter().chain(rest.find("column: ")).min() {
        let (head, tail) = rest.split_at(at);
        out.push_str(head);
        rest = tail[tail.find(' ').unwrap_or(0) + 1..].trim_start_matches(|c: char| c.is_ascii_digit());
    }
    out + rest
}

/// `fabric.toml` beside a table.
pub fn fabric() -> Target {
    let seeds = corpus::shipped("kesf_data", &["fabric.toml"]);
    Target { seeds, damaged: Damage::of, size: <[u8]>::len, holds: fabric_holds }
}

thread_local! {
    static FOLDER: RefCell<tempfile::TempDir> = RefCell::new(corpus::scratch());
}

fn fabric_holds(bytes: &[u8]) -> bool {
    let Some(found) = fabric_of(bytes) else { return false };
    let text = std::str::from_utf8(bytes).expect("text that was accepted");
    let again = fabric_of(anew(text).as_bytes()).expect("the same in other words");
    assert_eq!(found, again);
    let json = serde_json::to_string(&found).expect("JSON of a fabric");
    assert_eq!(serde_json::from_str::<FabricInfo>(&json).expect("a fabric"), found);
    true
}

fn fabric_of(bytes: &[u8]) -> Option<FabricInfo> {
    FOLDER.with_borrow(|folder| {
        let cloth = folder.path().join("cloth");
        fs::create_dir_all(&cloth).expect("a folder");
        fs::write(cloth.join("fabric.toml"), bytes).expect("a file");
        let table = "parameter,unit,warp,weft\nB,gf·cm²/cm,0.1,0.05\n";
        fs::write(cloth.join("table.csv"), table).expect("a file");
        let batch = read_fabrics(&[cloth], &ReadSettings::default(), &|_| ());
        assert!(!batch.fabrics.is_empty() || !batch.failures.is_empty(), "nothing is said");
        (batch.failures.is_empty()).then(|| batch.fabrics[0].info.clone())
    })
}

/// Settings of the evaluation.
pub fn settings() -> Target {
    let seeds = corpus::folder("settings");
    Target { seeds, damaged: Damage::of, size: <[u8]>::len, holds: settings_hold }
}

fn settings_hold(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let path = Path::new("settings.toml");
    match Settings::parse(path, text) {
        Ok(settings) => {
            let again = Settings::parse(path, &anew(text)).unwrap_or_else(|e| panic!("{e}\n{}", anew(text)));
            assert_eq!(again, settings);
            assert!(settings.describe().iter().all(|(_, value)| !value.is_empty()));
            true
        }
        Err(error) => {
            assert!(error.to_string().contains("settings.toml"), "{error}");
            false
        }
    }
}

/// Dialects of laboratories.
pub fn dialect() -> Target {
    let mut seeds: Vec<Vec<u8>> = DIALECT_FILES.iter().map(|text| text.as_bytes().to_vec()).collect();
    seeds.extend(corpus::folder("dialect"));
    Target { seeds, damaged: Damage::of, size: <[u8]>::len, holds: dialect_holds }
}

fn dialect_holds(bytes: &[u8]) -> bool {
    const EXPORT: &str =
        "direction,warp\ncurvature (1/cm),moment (gf·cm/cm)\n0,0.001\n1,0.1\n2.5,0.23\n-2.5,-0.2\n";
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let Ok(dialect) = Dialect::from_toml(text) else { return false };
    let again = Dialect::from_toml(&anew(text)).expect("the same in other words");
    assert_eq!(format!("{dialect:?}"), format!("{again:?}"));
    let settings = ReadSettings { dialects: vec![dialect], ..ReadSettings::default() };
    for export in [EXPORT, "0;1\n1;2\n2;3,5\n", "id,B_warp_uN_m\nM1,1.95\n"] {
        if let Ok(content) = parse(Path::new("a_warp_FB2_1.csv"), export.as_bytes(), &settings) {
            assert!(
                content
                    .measurements
                    .iter()
                    .flat_map(|m| m.curve.points())
                    .all(|(x, y)| x.is_finite() && y.is_finite())
            );
        }
    }
    true
}
