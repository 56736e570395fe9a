//! The same curves in every dress: encoding, delimiter, decimal mark, line ending, column order and
//! layout never change a measurement.
//!
//! Kind: property. The written digits are the same in every dress, so the numbers must be
//! identical to the last bit, and no tolerance is used.

use std::path::Path;

use encoding_rs::{SHIFT_JIS, WINDOWS_1252};
use kesf::instrument::{Direction, Measurement, ReadSettings, Test, parse};
use proptest::prelude::*;

/// The words of a language.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Language {
    English,
    Japanese,
    Portuguese,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Utf8,
    Utf8Bom,
    Utf16Le,
    Utf16LeBom,
    Utf16Be,
    Utf16BeBom,
    Cp932,
    Windows1252,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Layout {
    /// Column pairs beside each other, specimen numbers in a row above.
    SideBySide,
    /// Blocks below each other, each with its header lines.
    Stacked,
}

#[derive(Clone, Copy, Debug)]
struct Dress {
    language: Language,
    encoding: Encoding,
    delimiter: char,
    decimal: char,
    ending: &'static str,
    layout: Layout,
    ordinate_first: bool,
    trailing_delimiter: bool,
    counter: bool,
}

/// A bending test of the weft: specimens of (curvature in 1/cm, moment in gf·cm/cm), as digits.
type Specimens = Vec<Vec<(String, String)>>;

impl Dress {
    fn words(&self) -> [&'static str; 7] {
        match self.language {
            Language::English => {
                ["test", "bending", "direction", "weft", "specimen", "curvature (1/cm)", "moment (gf cm/cm)"]
            }
            Language::Japanese => [
                "測定器",
                "KES-FB2 曲げ",
                "方向",
                "緯",
                "試料番号",
                "曲率(㎝-1)",
                "曲げモーメント(ｇｆ・㎝/㎝)",
            ],
            Language::Portuguese => [
                "ensaio",
                "FB2 flexão",
                "direção",
                "trama",
                "provete",
                "curvatura (1/cm)",
                "momento (gf·cm/cm)",
            ],
        }
    }

    fn headings(&self) -> Vec<&'static str> {
        let [.., x, y] = self.words();
        let mut cells = if self.ordinate_first { vec![y, x] } else { vec![x, y] };
        if self.counter {
            cells.insert(0, if self.language == Language::Japanese { "時間(s)" } else { "time (s)" });
        }
        cells
    }

    fn cells(&self, i: usize, point: Option<&(String, String)>) -> Vec<String> {
        let Some((x, y)) = point else { return vec![String::new(); self.headings().len()] };
        let (x, y) = (self.mark(x), self.mark(y));
        let mut cells = if self.ordinate_first { vec![y, x] } else { vec![x, y] };
        if self.counter {
            cells.insert(0, self.mark(&format!("{}.5", i)));
        }
        cells
    }

    fn mark(&self, digits: &str) -> String {
        digits.replace('.', &self.decimal.to_string())
    }

    fn text(&self, specimens: &Specimens) -> String {
        let [test, bending, direction, weft, specimen, ..] = self.words();
        let mut lines: Vec<Vec<String>> = Vec::new();
        let pair = |a: &str, b: &str| vec![a.to_string(), b.to_string()];
        let owned = |cells: Vec<&str>| cells.into_iter().map(str::to_string).collect::<Vec<_>>();
        match self.layout {
            Layout::SideBySide => {
                lines.extend([pair(test, bending), pair(direction, weft), Vec::new()]);
                let labels = (1..=specimens.len()).flat_map(|n| pair(specimen, &n.to_string()));
                lines.push(labels.collect());
                lines.push(specimens.iter().flat_map(|_| owned(self.headings())).collect());
                let longest = specimens.iter().map(Vec::len).max().unwrap_or(0);
                for i in 0..longest {
                    lines.push(specimens.iter().flat_map(|s| self.cells(i, s.get(i))).collect());
                }
            }
            Layout::Stacked => {
                for (n, points) in specimens.iter().enumerate() {
                    lines.extend([
                        pair(test, bending),
                        pair(direction, weft),
                        pair(specimen, &(n + 1).to_string()),
                    ]);
                    lines.extend([Vec::new(), owned(self.headings())]);
                    lines.extend(points.iter().enumerate().map(|(i, p)| self.cells(i, Some(p))));
                    lines.push(Vec::new());
                }
            }
        }
        let delimiter = self.delimiter.to_string();
        let line = |cells: Vec<String>| {
            let trailing = if self.trailing_delimiter && !cells.is_empty() { delimiter.as_str() } else { "" };
            cells.join(&delimiter) + trailing + self.ending
        };
        lines.into_iter().map(line).collect()
    }

    fn bytes(&self, specimens: &Specimens) -> Vec<u8> {
        let text = self.text(specimens);
        let le = || text.encode_utf16().flat_map(u16::to_le_bytes);
        let be = || text.encode_utf16().flat_map(u16::to_be_bytes);
        let legacy = |encoding: &'static encoding_rs::Encoding| {
            let (bytes, _, lossy) = encoding.encode(&text);
            assert!(!lossy, "the words of {:?} are not in {}", self.language, encoding.name());
            bytes.into_owned()
        };
        match self.encoding {
            Encoding::Utf8 => text.into_bytes(),
            Encoding::Utf8Bom => [b"\xef\xbb\xbf", text.as_bytes()].concat(),
            Encoding::Utf16Le => le().collect(),
            Encoding::Utf16LeBom => [0xff, 0xfe].into_iter().chain(le()).collect(),
            Encoding::Utf16Be => be().collect(),
            Encoding::Utf16BeBom => [0xfe, 0xff].into_iter().chain(be()).collect(),
            Encoding::Cp932 => legacy(SHIFT_JIS),
            Encoding::Windows1252 => legacy(WINDOWS_1252),
        }
    }

    /// Whether the words exist in the encoding and the marks do not clash.
    fn is_possible(&self) -> bool {
        self.delimiter != self.decimal
            && match self.encoding {
                Encoding::Cp932 => self.language != Language::Portuguese,
                Encoding::Windows1252 => self.language != Language::Japanese,
                _ => true,
            }
    }
}

const LANGUAGES: [Language; 3] = [Language::English, Language::Japanese, Language::Portuguese];
const ENCODINGS: [Encoding; 8] = [
    Encoding::Utf8,
    Encoding::Utf8Bom,
    Encoding::Utf16Le,
    Encoding::Utf16LeBom,
    Encoding::Utf16Be,
    Encoding::Utf16BeBom,
    Encoding::Cp932,
    Encoding::Windows1252,
];

fn read(dress: &Dress, specimens: &Specimens) -> Vec<Measurement> {
    let bytes = dress.bytes(specimens);
    let content = parse(Path::new("export.dat"), &bytes, &ReadSettings::default());
    let content = content.unwrap_or_else(|e| panic!("{dress:?}: {e}\n{}", dress.text(specimens)));
    assert_eq!(content.findings, [], "{dress:?}");
    content.measurements
}

/// The numbers must be those of the digits, and nothing else may differ.
fn check(dress: &Dress, specimens: &Specimens) {
    let measurements = read(dress, specimens);
    assert_eq!(measurements.len(), specimens.len(), "{dress:?}");
    for (n, (m, points)) in measurements.iter().zip(specimens).enumerate() {
        assert_eq!(
            (m.test, m.direction, m.specimen),
            (Test::Bending, Some(Direction::Weft), n + 1),
            "{dress:?}"
        );
        let digits = |t: &str| t.parse::<f64>().unwrap();
        // 1/cm is 100 1/m; gf·cm/cm is 9.80665e-3 N. The product is formed as the reader forms it.
        let expected: Vec<(f64, f64)> =
            points.iter().map(|(x, y)| (digits(x) * 100.0, digits(y) * 9.80665e-3)).collect();
        for ((x, y), (ex, ey)) in m.curve.points().zip(&expected) {
            assert!((x - ex).abs() <= 1e-14 * ex.abs() && (y - ey).abs() <= 1e-14 * ey.abs(), "{dress:?}");
        }
        assert_eq!(m.curve.len(), expected.len(), "{dress:?}");
    }
}

fn example() -> Specimens {
    let specimen = |scale: f64| {
        (0..12)
            .map(|i| (format!("{:.4}", 0.2 * f64::from(i) - 0.4), format!("{:.5}", scale * f64::from(i))))
            .collect()
    };
    vec![specimen(0.011), specimen(0.0125), specimen(0.0117)]
}

/// Every possible combination of language, encoding, delimiter, decimal mark and layout.
#[test]
fn every_combination_of_encoding_delimiter_decimal_mark_and_layout_gives_the_same_curves() {
    let (mut count, mut reference) = (0, None);
    for language in LANGUAGES {
        for encoding in ENCODINGS {
            for delimiter in [',', ';', '\t'] {
                for decimal in ['.', ','] {
                    for layout in [Layout::SideBySide, Layout::Stacked] {
                        let dress = Dress {
                            language,
                            encoding,
                            delimiter,
                            decimal,
                            ending: "\r\n",
                            layout,
                            ordinate_first: false,
                            trailing_delimiter: false,
                            counter: false,
                        };
                        if !dress.is_possible() {
                            continue;
                        }
                        check(&dress, &example());
                        let curves: Vec<_> = read(&dress, &example()).into_iter().map(|m| m.curve).collect();
                        assert_eq!(reference.get_or_insert_with(|| curves.clone()), &curves, "{dress:?}");
                        count += 1;
                    }
                }
            }
        }
    }
    // 5 delimiter and decimal pairs, 2 layouts, 8 encodings of 3 languages less 2 impossible ones.
    assert_eq!(count, 5 * 2 * 22);
}

fn dresses() -> impl Strategy<Value = Dress> {
    let marks = prop::sample::select(vec![(',', '.'), (';', '.'), ('\t', '.'), (';', ','), ('\t', ',')]);
    let switches = (any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>());
    let languages = prop::sample::select(LANGUAGES.to_vec());
    let encodings = prop::sample::select(ENCODINGS.to_vec());
    (languages, encodings, marks, switches)
        .prop_map(
            |(
                language,
                encoding,
                (delimiter, decimal),
                (crlf, stacked, ordinate_first, trailing_delimiter, counter),
            )| Dress {
                language,
                encoding,
                delimiter,
                decimal,
                ending: if crlf { "\r\n" } else { "\n" },
                layout: if stacked { Layout::Stacked } else { Layout::SideBySide },
                ordinate_first,
                trailing_delimiter,
                counter,
            },
        )
        .prop_filter("the encoding has no such words", Dress::is_possible)
}

fn specimens() -> impl Strategy<Value = Specimens> {
    let point = (-2.5..2.5f64, -0.5..0.5f64).prop_map(|(x, y)| (format!("{x:.4}"), format!("{y:.5}")));
    prop::collection::vec(prop::collection::vec(point, 3..30), 1..5)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn dress_never_changes_a_measurement(dress in dresses(), specimens in specimens()) {
        check(&dress, &specimens);
    }
}

/// One line of bytes that are no text took a minute: its encoding was looked for in all of it, character by character.
#[test]
fn a_line_of_bytes_takes_no_minutes() {
    let mut bytes = vec![0xff; 100_000];
    bytes.push(b'\n');
    let start = std::time::Instant::now();
    assert!(parse(Path::new("a_warp_FB2_1.csv"), &bytes, &ReadSettings::default()).is_err());
    assert!(start.elapsed().as_secs() < 5, "{:?}", start.elapsed());
}
