//! The shipped synthetic fabrics in other dress: every combination of encoding, delimiter, decimal
//! mark and layout gives the same sheet; and so do other units, to rounding.
//!
//! Kind: property. The digits are those of the shipped files, so the sheets must be identical to the
//! last bit, and no tolerance is used for them.

use std::path::Path;

use encoding_rs::{SHIFT_JIS, WINDOWS_1252};
use kesf::characterise::{FabricSheet, Settings, characterise};
use kesf::instrument::{Direction, FabricInput, Measurement, ReadSettings, Test, parse, read_fabrics};
use kesf::quantity::Unit;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Layout {
    /// A file for each specimen.
    Single,
    /// A file for each test: blocks below each other.
    Stacked,
    /// A file for each test and direction: column pairs beside each other.
    SideBySide,
}

/// English words, but Japanese ones where the encoding is.
fn words(test: Test, japanese: bool) -> [&'static str; 3] {
    match (test, japanese) {
        (Test::Tensile, false) => ["tensile", "strain", "force"],
        (Test::Shear, false) => ["shear", "angle", "shear force"],
        (Test::Bending, false) => ["bending", "curvature", "moment"],
        (Test::Compression, false) => ["compression", "thickness", "pressure"],
        (Test::Tensile, true) => ["引張", "伸び", "荷重"],
        (Test::Shear, true) => ["せん断", "せん断角", "せん断力"],
        (Test::Bending, true) => ["曲げ", "曲率", "曲げモーメント"],
        (Test::Compression, true) => ["圧縮", "厚さ", "圧力"],
        (Test::Friction | Test::Roughness, _) => panic!("no shipped fabric has a sweep"),
    }
}

/// Units as the shipped files have them.
fn kes(test: Test) -> [&'static str; 2] {
    match test {
        Test::Tensile => ["%", "gf/cm"],
        Test::Shear => ["deg", "gf/cm"],
        Test::Bending => ["1/cm", "gf cm/cm"],
        Test::Compression => ["mm", "gf/cm2"],
        Test::Friction => ["cm", "1"],
        Test::Roughness => ["cm", "um"],
    }
}

/// The satin's laboratory writes extension and load: 5 cm between the jaws, 20 cm of width.
fn raw_tensile(test: Test) -> [&'static str; 2] {
    if test == Test::Tensile { ["mm", "gf"] } else { kes(test) }
}

/// SI value of a unit on the axes of a test.
fn factor(test: Test, unit: &str) -> f64 {
    let si = Unit::parse(unit).unwrap().factor;
    match (test, unit) {
        (Test::Tensile, "mm") => si / 0.05,
        (_, "gf") => si / 0.20,
        _ => si,
    }
}

/// Header keys, yarn directions: English, Japanese.
const KEYS: [[&str; 2]; 3] = [["test", "測定器"], ["direction", "方向"], ["specimen", "試料番号"]];

fn direction(direction: Direction, japanese: bool) -> &'static str {
    match (direction, japanese) {
        (Direction::Warp, true) => "経",
        (Direction::Weft, true) => "緯",
        (Direction::Bias, true) => "バイアス",
        (d, false) => d.name(),
    }
}

/// Texts of the files of a fabric: lines of cells.
fn tables(
    of: &[Measurement],
    layout: Layout,
    units: fn(Test) -> [&'static str; 2],
    japanese: bool,
) -> Vec<Vec<Vec<String>>> {
    let group = |m: &Measurement| match layout {
        Layout::Single => (m.test, m.direction, m.specimen),
        Layout::Stacked => (m.test, None, 0),
        Layout::SideBySide => (m.test, m.direction, 0),
    };
    let key = |i: usize| KEYS[i][usize::from(japanese)].to_string();
    let mut files = Vec::new();
    for part in of.chunk_by(|a, b| group(a) == group(b)) {
        let [name, x, y] = words(part[0].test, japanese);
        let [ux, uy] = units(part[0].test);
        let headings = [format!("{x} ({ux})"), format!("{y} ({uy})")];
        let mut lines = Vec::new();
        let header = |m: &Measurement| {
            let mut lines = vec![vec![key(0), name.to_string()]];
            lines.extend(m.direction.map(|d| vec![key(1), direction(d, japanese).to_string()]));
            lines
        };
        // Six decimals: all digits of the shipped files, and enough of any other unit.
        let cells = |m: &Measurement, i: usize| -> Vec<String> {
            let digits = |v: &[f64], unit| {
                v.get(i).map_or(String::new(), |v| format!("{:.6}", v / factor(m.test, unit)))
            };
            vec![digits(&m.curve.x, ux), digits(&m.curve.y, uy)]
        };
        if layout == Layout::SideBySide {
            lines.extend(header(&part[0]));
            lines.push(Vec::new());
            lines.push(part.iter().flat_map(|m| [key(2), m.specimen.to_string()]).collect());
            lines.push(part.iter().flat_map(|_| headings.clone()).collect());
            let longest = part.iter().map(|m| m.curve.len()).max().unwrap_or(0);
            lines.extend((0..longest).map(|i| part.iter().flat_map(|m| cells(m, i)).collect()));
        } else {
            for m in part {
                lines.extend(header(m));
                lines.extend([vec![key(2), m.specimen.to_string()], Vec::new(), headings.to_vec()]);
                lines.extend((0..m.curve.len()).map(|i| cells(m, i)));
                lines.push(Vec::new());
            }
        }
        files.push(lines);
    }
    files
}

const ENCODINGS: [&str; 8] =
    ["utf-8", "utf-8 bom", "utf-16le", "utf-16le bom", "utf-16be", "utf-16be bom", "cp932", "windows-1252"];

fn encoded(text: &str, encoding: &str) -> Vec<u8> {
    let le = || text.encode_utf16().flat_map(u16::to_le_bytes);
    let be = || text.encode_utf16().flat_map(u16::to_be_bytes);
    let legacy = |to: &'static encoding_rs::Encoding| {
        let (bytes, _, lossy) = to.encode(text);
        assert!(!lossy);
        bytes.into_owned()
    };
    match encoding {
        "utf-8" => text.as_bytes().to_vec(),
        "utf-8 bom" => [b"\xef\xbb\xbf", text.as_bytes()].concat(),
        "utf-16le" => le().collect(),
        "utf-16le bom" => [0xff, 0xfe].into_iter().chain(le()).collect(),
        "utf-16be" => be().collect(),
        "utf-16be bom" => [0xfe, 0xff].into_iter().chain(be()).collect(),
        "cp932" => legacy(SHIFT_JIS),
        _ => legacy(WINDOWS_1252),
    }
}

/// The fabric as other files would give it.
fn redressed(
    fabric: &FabricInput,
    encoding: &str,
    (delimiter, decimal): (char, char),
    layout: Layout,
    units: fn(Test) -> [&'static str; 2],
) -> FabricInput {
    let mut measurements = Vec::new();
    for lines in tables(&fabric.measurements, layout, units, encoding == "cp932") {
        let join = |cells: &Vec<String>| {
            let marked = cells.iter().map(|c| {
                let number = c.parse::<f64>().is_ok();
                if number { c.replace('.', &decimal.to_string()) } else { c.clone() }
            });
            marked.collect::<Vec<_>>().join(&delimiter.to_string()) + "\r\n"
        };
        let text: String = lines.iter().map(join).collect();
        let content = parse(Path::new("export.dat"), &encoded(&text, encoding), &ReadSettings::default());
        let content =
            content.unwrap_or_else(|e| panic!("{encoding} {delimiter:?} {decimal:?} {layout:?}: {e}"));
        measurements.extend(content.measurements);
    }
    FabricInput {
        measurements,
        name: fabric.name.clone(),
        info: fabric.info.clone(),
        ..FabricInput::default()
    }
}

fn fabrics() -> Vec<FabricInput> {
    let root = std::env::var_os("KESF_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data"), Into::into);
    let folders: Vec<_> = ["poplin", "twill", "satin"].into_iter().map(|n| root.join(n)).collect();
    read_fabrics(&folders, &ReadSettings::default(), &|_: &Path| ()).fabrics
}

/// Everything of a sheet that may not depend on the dress.
fn essence(sheet: &FabricSheet) -> impl PartialEq + std::fmt::Debug + use<> {
    let specimens: Vec<_> = (sheet.specimens.iter())
        .map(|s| {
            (s.measurement.specimen, s.values.clone(), s.moduli.clone(), s.correction, s.branches.clone())
        })
        .collect();
    let findings: Vec<_> = sheet.findings.iter().map(|f| (f.code(), f.message())).collect();
    (sheet.values.clone(), sheet.moduli.clone(), specimens, findings)
}

#[test]
fn every_dress_gives_the_same_sheet() {
    const MARKS: [(char, char); 5] = [(',', '.'), (';', '.'), ('\t', '.'), (';', ','), ('\t', ',')];
    const LAYOUTS: [Layout; 3] = [Layout::Single, Layout::Stacked, Layout::SideBySide];
    let settings = Settings::default();
    for fabric in fabrics() {
        let expected = essence(&characterise(&fabric, &settings));
        let mut combinations = 0;
        for (e, encoding) in ENCODINGS.into_iter().enumerate() {
            for (m, marks) in MARKS.into_iter().enumerate() {
                // All pairs of encoding and marks for the first fabric, three marks with each encoding
                // for the others; layouts take turns.
                if fabric.name != "poplin" && (m + e) % 5 > 2 {
                    continue;
                }
                let layout = LAYOUTS[(e + m) % 3];
                let units = if fabric.name == "satin" { raw_tensile } else { kes };
                let found = redressed(&fabric, encoding, marks, layout, units);
                let found = essence(&characterise(&found, &settings));
                assert_eq!(found, expected, "{} {encoding} {marks:?} {layout:?}", fabric.name);
                combinations += 1;
            }
        }
        assert_eq!(combinations, if fabric.name == "poplin" { 40 } else { 24 });
    }
}

/// The same curves in other units: equal to the digits that are written (six decimals of numbers
/// that are 0.01 and more) and to rounding.
#[test]
fn units_never_change_a_parameter() {
    let others: [fn(Test) -> [&'static str; 2]; 2] = [
        |test| match test {
            Test::Tensile => ["1", "N/m"],
            Test::Shear => ["rad", "mN/m"],
            Test::Bending => ["1/m", "uN"],
            Test::Compression => ["um", "Pa"],
            _ => kes(test),
        },
        |test| match test {
            Test::Tensile => ["%", "cN/cm"],
            Test::Shear => ["rad", "cN/cm"],
            Test::Bending => ["1/cm", "mN mm/mm"],
            Test::Compression => ["um", "kPa"],
            _ => kes(test),
        },
    ];
    let settings = Settings::default();
    for fabric in fabrics() {
        let expected = characterise(&fabric, &settings);
        for units in others {
            let found = redressed(&fabric, "utf-8", (',', '.'), Layout::Single, units);
            let found = characterise(&found, &settings);
            for (key, e) in &expected.values {
                let ratio = found.values[key].mean / e.mean;
                assert!((ratio - 1.0).abs() < 1e-3, "{} {key:?}: {ratio}", fabric.name);
            }
            assert_eq!(found.values.len(), expected.values.len());
        }
    }
}
