//! Damaged files: thousands of deterministic mutations of valid ones must never panic or hang, and
//! whatever is still read must be finite and complete.
//!
//! Kind: property. The long run is `.ci/fuzz`; this replays a short one of texts and workbooks.

use std::io::{Cursor, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use kesf::instrument::{FileContent, ReadSettings, parse};
use kesf::quantity::Unit;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// Valid files of every layout.
fn seeds() -> Vec<Vec<u8>> {
    let english = "sample,poplin\ninstrument,KES-FB2\ndirection,warp\nspecimen,1\nwidth,20 cm\ngauge,1 cm\nmaximum,2.5 1/cm\n\n\
                   curvature (1/cm),moment (gf·cm/cm)\n0.0000,0.001\n0.5000,0.052\n1.0000,0.0951\n2.5000,0.231\n-2.5,-0.22\n0,0.01\n";
    let japanese = "試料名\ttwill\r\n測定器\tKES-FB1 引張\r\n方向\t経\r\n幅\t20cm\r\n\r\n試料番号\t1\t試料番号\t2\r\n\
                    伸び(％)\t荷重(ｇｆ/㎝)\t伸び(％)\t荷重(ｇｆ/㎝)\r\n0.0\t0.1\t0.0\t0.2\r\n1.5\t50.1\t1.4\t49.0\r\n3.0\t500.2\t3.1\t500\r\n\t\t3.0\t480\r\n";
    let portuguese = "amostra;satin\r\nensaio;FB1 corte\r\ndireção;trama\r\nprovete;1\r\n\r\nângulo (°);força (gf/cm)\r\n0,0;0,1\r\n\
                      4,0;2,5\r\n8,0;5,25\r\n\r\namostra;satin\r\nensaio;FB3 compressão\r\nprovete;1\r\n\r\nespessura (mm);pressão (gf/cm²)\r\n\
                      0,50;0,1\r\n0,45;10,0\r\n0,40;50,0\r\n";
    let volts = "test,bending\ndirection,weft\nsens,20 gf·cm/cm\nsens x,2.5 1/cm\n\nK (V),M (mV)\n0,0\n5,1200\n10,2500\n";
    let wide = "id,B_warp_uN_m,B_weft_uN_m,G_N_per_m,W_g_per_m2,T_mm\nM1,1.95,0.61,41,135.17,0.31\nM2,0.85,0.33,46,83.66,0.25\n";
    let long = "fabric\tparameter\tdirection\tmean\tsd\tn\tunit\npoplin\tB\twarp\t0.085\t0.003\t3\tgf·cm²/cm\npoplin\tEMT\tweft\t7.6\t0.2\t3\t%\n";
    let fab = r#"{"raw_data": {"L": {"S1": {"length": 2.08, "width": "5", "samplesTree": [[1.9, 0.1, 2.0, "5.5", 2.1, 20], [2.1, 20, 1.9, 0.1]]}}, "M": "105.6"}}"#;
    let surface = "test,KES-FB4\ndirection,warp\ncontact load,50 gf\n\nposition (mm),friction force (gf),height (um)\n0,9,10\n10,11,14\n\
                   20,9,9\n30,12,15\n20,-10,11\n10,-9,13\n0,-11,10\n";
    let utf16 = english.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let mut seeds: Vec<Vec<u8>> = [english, japanese, portuguese, volts, wide, long, fab, surface]
        .iter()
        .map(|t| t.as_bytes().to_vec())
        .collect();
    seeds.push(utf16);
    seeds.push(encoding_rs::SHIFT_JIS.encode(japanese).0.into_owned());
    seeds.push(encoding_rs::WINDOWS_1252.encode(portuguese).0.into_owned());
    seeds.push(include_bytes!("../workbooks/twill.xlsx").to_vec());
    seeds.push(include_bytes!("../workbooks/twill.xls").to_vec());
    seeds
}

fn mutated(seed: &[u8], other: &[u8], rng: &mut Pcg64) -> Vec<u8> {
    const TOKENS: &[&[u8]] = &[
        b"NaN",
        b"1e999",
        b"-",
        b",",
        b";",
        b"\t",
        b"\n\n",
        b"\r",
        b"\"",
        b"(",
        b")",
        b"\0",
        b"\xff\xfe",
        b"0,35",
        b"1e-320",
        b"gf",
        b" (gf/cm)",
        b"direction,weft\n",
        b"9999999999999999999999",
        "・㎝".as_bytes(),
        b"\x81",
        b"\xef\xbb\xbf",
        b"-0",
        b"specimen,0\n",
        b"1/(",
        b"^99",
        b"#N/A",
        b"[[[[",
        b"B (gf\xb7cm/deg)",
    ];
    let mut bytes = seed.to_vec();
    for _ in 0..rng.random_range(1..6) {
        let at = rng.random_range(0..=bytes.len());
        let end = (at + rng.random_range(1..20)).min(bytes.len());
        match rng.random_range(0..6) {
            0 if at < bytes.len() => bytes[at] ^= 1 << rng.random_range(0..8),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            3 => bytes.truncate(at),
            4 => {
                let from = rng.random_range(0..=other.len());
                let until = (from + rng.random_range(1..80)).min(other.len());
                bytes.splice(at..at, other[from..until].iter().copied());
            }
            _ => {
                let token = TOKENS[rng.random_range(0..TOKENS.len())];
                bytes.splice(at..at, token.iter().copied());
            }
        }
    }
    bytes
}

/// An archive whose parts are mutated and packed again: damage that the checksums do not catch.
fn mutated_parts(seed: &[u8], rng: &mut Pcg64) -> Vec<u8> {
    let mut parts = ZipArchive::new(Cursor::new(seed)).expect("an archive");
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for i in 0..parts.len() {
        let mut part = parts.by_index(i).expect("a part");
        let (name, mut bytes) = (part.name().expect("a name").into_owned(), Vec::new());
        part.read_to_end(&mut bytes).expect("its bytes");
        if name.contains("sheet") || rng.random_range(0..4) == 0 {
            bytes = mutated(&bytes, &bytes, rng);
        }
        zip.start_file(name, SimpleFileOptions::default().compression_method(CompressionMethod::Stored))
            .expect("a part");
        zip.write_all(&bytes).expect("its bytes");
    }
    zip.finish().expect("an archive").into_inner()
}

fn check(content: &FileContent) {
    for m in &content.measurements {
        assert_eq!(m.curve.x.len(), m.curve.y.len());
        assert_eq!(m.curve.x.len(), m.lines.len());
        assert!(m.curve.points().all(|(x, y)| x.is_finite() && y.is_finite()));
        assert!(m.specimen > 0 && m.curve.len() >= 3);
        assert_eq!(m.direction.is_some(), m.test.is_directional());
        assert!(m.conditions.width > 0.0 && m.conditions.maximum > 0.0);
    }
    assert!(content.results.iter().all(|(_, r)| r.mean.is_finite() && r.n > 0));
}

#[test]
fn every_seed_is_read() {
    for (i, seed) in seeds().iter().enumerate() {
        let content = parse(Path::new("seed.csv"), seed, &ReadSettings::default());
        check(&content.unwrap_or_else(|e| panic!("seed {i}: {e}")));
    }
}

#[test]
fn mutations_neither_panic_nor_hang_nor_leave_anything_unfinished() {
    let count = std::env::var("KESF_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(5_000);
    let seeds = seeds();
    let mut rng = Pcg64::seed_from_u64(20_260_101);
    let settings = [ReadSettings::default(), ReadSettings { kes_units: true, ..ReadSettings::default() }];
    let (mut read, mut slowest) = (0, Duration::ZERO);
    for _ in 0..count {
        let (a, b) = (rng.random_range(0..seeds.len()), rng.random_range(0..seeds.len()));
        let bytes = if seeds[a].starts_with(b"PK") && rng.random_range(0..2) == 0 {
            mutated_parts(&seeds[a], &mut rng)
        } else {
            mutated(&seeds[a], &seeds[b], &mut rng)
        };
        let start = Instant::now();
        let content =
            parse(Path::new("F01_warp_FB2_1.csv"), &bytes, &settings[(rng.next_u32() % 2) as usize]);
        slowest = slowest.max(start.elapsed());
        if let Ok(content) = content {
            check(&content);
            read += 1;
        }
    }
    println!("{read} of {count} mutations were still read; the slowest took {slowest:?}");
    // A file of a kilobyte takes microseconds; a second means a loop.
    assert!(slowest < Duration::from_secs(1));
    assert!(read > 0);
}

/// A unit with one to three slips of the pen is refused, or it is another unit and taken as such:
/// the scale of the curve is then that unit's, found here without the reader.
#[test]
fn a_damaged_unit_is_never_taken_for_another() {
    const SLIPS: [&str; 22] = [
        "g", "f", "c", "m", "N", "/", "·", "(", ")", "[", "]", " ", "%", "u", "k", "2", "-", "^", "deg", "²",
        ",", "cm",
    ];
    let mut rng = Pcg64::seed_from_u64(7);
    let mut read = 0;
    for _ in 0..4_000 {
        let mut heading: Vec<String> = "moment (gf·cm/cm)".chars().map(String::from).collect();
        for _ in 0..rng.random_range(1..4) {
            // Behind the name of the column.
            let at = rng.random_range(6..heading.len());
            let slip = SLIPS[rng.random_range(0..SLIPS.len())].to_string();
            match rng.random_range(0..3) {
                0 if heading.len() > 8 => drop(heading.remove(at)),
                1 => heading.insert(at, slip),
                _ => heading[at] = slip,
            }
        }
        let heading = heading.concat();
        let text = format!("direction,warp\ncurvature (1/cm);{heading}\n0;0\n1;0.1\n2;0.2\n")
            .replace(",warp", ";warp");
        let Ok(content) = parse(Path::new("a.csv"), text.as_bytes(), &ReadSettings::default()) else {
            continue;
        };
        read += 1;
        let scale = content.measurements[0].curve.y[2] / 0.2;
        // What stands at the end of the heading, from any character on, in a bracket or not; a moment
        // per width, or a moment over the standard width of 20 cm.
        let plain = heading.replace('[', "(").replace(']', ")");
        let inside =
            plain.rsplit_once('(').map_or(plain.as_str(), |(_, unit)| unit).trim_end_matches([' ', ')']);
        let ends = |text: &str| -> Vec<String> {
            text.char_indices().map(|(i, _)| text[i..].trim().to_string()).collect()
        };
        let readings = [ends(inside), ends(&plain)].concat();
        let is_meant = |unit: &String| {
            // Print sets symbols without a mark between them: `gfcm/cm`.
            let marked = unit.char_indices().map(|(i, _)| format!("{}·{}", &unit[..i], &unit[i..]));
            marked.chain([unit.clone()]).filter_map(|text| Unit::parse(&text).ok()).any(|meant| {
                let ratio = scale / meant.factor;
                (ratio - 1.0).abs() < 1e-12 || (ratio * 0.20 - 1.0).abs() < 1e-12
            })
        };
        assert!(readings.iter().any(is_meant), "{heading:?} was read with a scale of {scale}");
    }
    println!("{read} of 4000 damaged units were still units of a moment");
    assert!(read > 0);
}
