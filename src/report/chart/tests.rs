//! Goal: every chart is drawn from ordinary and from extreme data, twice with the same bytes.
//!
//! Data: loops made from stated parameters with noise. With `KESF_GALLERY=dir` the files are kept for
//! looking at, which no assertion replaces.

mod mock;

use std::collections::BTreeMap;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::*;
use crate::characterise::{self, Branch, FabricSheet, Key, SpecimenResult, ValueStatus, Window};
use crate::instrument::{self, Direction, FabricInfo, Measurement, Origin, Parameter, Test};
use crate::quantity::{Curve, Estimate};
use crate::study;
use mock::Mock;

const WARP: Option<Direction> = Some(Direction::Warp);
const WEFT: Option<Direction> = Some(Direction::Weft);

fn keep(name: &str, bytes: &[u8]) {
    if let Some(folder) = std::env::var_os("KESF_GALLERY") {
        std::fs::write(std::path::Path::new(&folder).join(name), bytes).unwrap();
    }
}

/// The file, drawn twice to see that the bytes are the same, and its size on the page.
fn drawn(name: &str, draw: impl Fn() -> Result<Chart, ChartError>) {
    let (chart, again) = (draw().unwrap(), draw().unwrap());
    let bytes = chart.png().unwrap();
    assert_eq!(bytes, again.png().unwrap(), "{name}: same data, same bytes");
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    assert_eq!((reader.info().width, reader.info().height), (1800, 1350));
    keep(name, &bytes);
    for &format in Format::ALL.iter().filter(|format| **format != Format::Png) {
        let bytes = chart.file(format).unwrap();
        assert_eq!(bytes, again.file(format).unwrap(), "{name}, {format:?}: same data, same bytes");
        keep(&name.replace(".png", &format!(".{}", format.ending())), &bytes);
        let texts = match format {
            Format::Svg => svg_texts(&bytes),
            _ => pdf_texts(&bytes),
        };
        // Every word that is drawn in a font that the file can name is there to be found.
        for mark in &chart.0.marks {
            let canvas::Mark::Text { text, .. } = mark else { continue };
            let is_found = |word: &str| word.chars().any(|c| c > '\u{2fff}') || texts.contains(word);
            let missing = text.split_whitespace().find(|word| !is_found(word));
            assert_eq!(missing, None, "{name}, {format:?}: not in {texts}");
        }
        assert!(texts.contains(chart.title()), "{name}, {format:?}: {}", chart.title());
    }
}

/// What stands in the elements of an SVG file, which is read as XML.
fn svg_texts(bytes: &[u8]) -> String {
    use quick_xml::events::Event;
    let mut reader = quick_xml::Reader::from_str(std::str::from_utf8(bytes).unwrap());
    let mut texts = String::new();
    loop {
        match reader.read_event().unwrap() {
            Event::Eof => return texts,
            Event::Text(text) => texts.push_str(&text),
            Event::GeneralRef(name) if name.is_char_ref() => {
                texts.extend(name.resolve_char_ref().unwrap());
            }
            Event::GeneralRef(name) => texts.push_str(match &*name.xml10_content() {
                "lt" => "<",
                "gt" => ">",
                "amp" => "&",
                "quot" => "\"",
                "apos" => "'",
                other => panic!("&{other};"),
            }),
            Event::End(_) => texts.push('\n'),
            _ => {}
        }
    }
}

/// What stands on the page of a PDF file, and its title; no date is in the file.
#[cfg(feature = "pdf")]
fn pdf_texts(bytes: &[u8]) -> String {
    let file = lopdf::Document::load_mem(bytes).unwrap();
    assert_eq!(file.get_pages().len(), 1);
    let about = file.trailer.get(b"Info").and_then(|info| info.as_reference()).unwrap();
    let about = file.get_dictionary(about).unwrap();
    assert!(about.iter().all(|(key, _)| !key.ends_with(b"Date")), "{about:?}");
    let title = lopdf::decode_text_string(about.get(b"Title").unwrap()).unwrap();
    format!("{title}\n{}", file.extract_text(&[1]).unwrap())
}

#[cfg(not(feature = "pdf"))]
fn pdf_texts(_: &[u8]) -> String {
    unreachable!("there are no PDF files")
}

fn simulated(direction: Option<Direction>, points: impl IntoIterator<Item = (f64, f64)>) -> SimulatedCurve {
    SimulatedCurve {
        label: "simulated".into(),
        direction,
        curve: Curve::from_points(points),
        rmse: Some(1.3e-5),
        nrmse: Some(0.021),
        r2: Some(0.9942),
        band: None,
        repeats: None,
        bands: Vec::new(),
    }
}

#[test]
fn the_four_charts_of_a_measured_fabric() {
    let mut mock = Mock::new("Cotton poplin", Origin::Synthetic);
    mock.tensile(WARP, 0.041);
    mock.tensile(WEFT, 0.092);
    mock.shear(WARP, 0.82, 1.3);
    mock.shear(WEFT, 0.74, 1.1);
    mock.bending(WARP, 0.092, 0.058, 3);
    mock.bending(WEFT, 0.051, 0.031, 3);
    mock.compression();
    let sheet = &mock.sheet;
    drawn("tensile.png", || tensile(sheet, &[]));
    drawn("shear.png", || shear(sheet, &[]));
    drawn("bending.png", || bending(sheet, &[]));
    drawn("compression.png", || compression(sheet, &[]));
    let line =
        |b: f64| (0..=50).map(move |i| (f64::from(i) * 10.0 - 250.0, b * (f64::from(i) * 10.0 - 250.0)));
    let over = [simulated(WARP, line(0.092 * 9.80665e-5)), simulated(WEFT, line(0.051 * 9.80665e-5))];
    drawn("bending-simulated.png", || bending(sheet, &over));
    let pull = |em: f64| (0..=20).map(move |i| f64::from(i) / 20.0).map(move |t| (em * t, 490.0 * t * t));
    drawn("tensile-simulated.png", || {
        tensile(sheet, &[simulated(WARP, pull(0.041)), simulated(WEFT, pull(0.09))])
    });
}

/// The package that goes to a registry leaves `kesf_data` out; then there is nothing to draw here.
#[test]
fn every_shipped_fabric_has_the_charts_that_its_data_allow() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data");
    if !folder.is_dir() {
        crate::common::skipped("every_shipped_fabric_has_the_charts_that_its_data_allow", "no kesf_data");
        return;
    }
    let batch = instrument::read_fabrics(&[folder], &instrument::ReadSettings::default(), &|_| {});
    for fabric in &batch.fabrics {
        let sheet = characterise::characterise(fabric, &characterise::Settings::default());
        for test in Test::ALL {
            let chart = of_test(&sheet, test, &[]);
            let curves = sheet.specimens.iter().any(|s| s.measurement.test == test);
            match chart {
                Ok(chart) => keep(&format!("{}-{}.png", sheet.name, test.name()), &chart.png().unwrap()),
                Err(ChartError::NothingToDraw { .. }) if !curves => {}
                Err(e) => panic!("{e}"),
            }
        }
    }
}

#[test]
fn a_comparison_is_drawn_as_one_line() {
    let comparison = study::Comparison {
        name: "bending warp".into(),
        test: Test::Bending,
        direction: WARP,
        rmse: 1e-5,
        nrmse: 0.02,
        r2: f64::NAN,
        n: 4,
        unit: "N",
        simulated: Curve::from_points([(0.0, 0.0), (2.0, 4.0), (1.0, 2.0), (2.0, 4.0)]),
        measured: Curve::default(),
    };
    let curve = SimulatedCurve::from(&comparison);
    assert_eq!(curve.curve, Curve::from_points([(0.0, 0.0), (1.0, 2.0), (2.0, 4.0)]));
    assert_eq!((curve.rmse, curve.r2), (Some(1e-5), None));
}

#[test]
fn extremes_stiff_tiny_single_weft_only_and_long_names() {
    let mut mock = Mock::new(
        "A very long name of a polyester filament membrane with a coating on both of its sides, lot 2026-11",
        Origin::Measured,
    );
    mock.sheet.info.source = Some("laboratory of a university with a long name, unpublished".into());
    mock.noise = 0.03;
    mock.bending(WEFT, 250.0, 12.0, 1);
    drawn("stiff.png", || bending(&mock.sheet, &[]));
    let mut mock = Mock::new("Tiny", Origin::Measured);
    mock.bending(WARP, 2.0e-5, 1.1e-5, 1);
    drawn("tiny.png", || bending(&mock.sheet, &[]));
}

#[test]
fn a_table_without_curves_is_drawn_and_says_so() {
    let mut mock = Mock::new("Wool serge B", Origin::Published);
    for (d, f) in [(WARP, 1.0), (WEFT, 0.7)] {
        for (p, v) in [
            (Parameter::B, 0.11),
            (Parameter::Hb, 0.04),
            (Parameter::G, 0.9),
            (Parameter::Hg, 1.2),
            (Parameter::Hg5, 2.1),
            (Parameter::Lt, 0.65),
            (Parameter::Wt, 8.0),
            (Parameter::Rt, 60.0),
            (Parameter::Emt, 5.0),
        ] {
            let estimate = Estimate { values: vec![], ..Estimate::single(v * f * p.kes_factor()) };
            mock.sheet.values.insert(Key { parameter: p, direction: d }, estimate);
        }
    }
    mock.value(Parameter::Lt, WEFT, 0.6);
    mock.value(Parameter::Rt, WEFT, 55.0);
    let sheet = &mock.sheet;
    drawn("published-bending.png", || bending(sheet, &[]));
    drawn("published-shear.png", || shear(sheet, &[]));
    drawn("published-tensile.png", || tensile(sheet, &[]));
    assert!(matches!(compression(sheet, &[]), Err(ChartError::NothingToDraw { .. })));
}

fn plate(nx: u32, ny: u32, size: [f64; 2]) -> (Vec<[f64; 3]>, Vec<[u32; 4]>) {
    let mut nodes = Vec::new();
    for j in 0..=ny {
        for i in 0..=nx {
            nodes.push([size[0] * f64::from(i) / f64::from(nx), size[1] * f64::from(j) / f64::from(ny), 0.0]);
        }
    }
    let corner = |i: u32, j: u32| j * (nx + 1) + i;
    let quads = (0..ny)
        .flat_map(|j| {
            (0..nx).map(move |i| [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)])
        })
        .collect();
    (nodes, quads)
}

#[test]
fn fields_of_a_square_a_strip_and_a_constant() {
    let pi = std::f64::consts::PI;
    let (nodes, quads) = plate(40, 40, [0.2, 0.2]);
    let w = |x: f64, y: f64| -3.07e-3 * ((pi * x / 0.2).sin() * (pi * y / 0.2).sin()).powi(2);
    let values: Vec<f64> = nodes.iter().map(|n| w(n[0], n[1])).collect();
    let line = |n: i32| {
        Curve::from_points((0..=n).map(|i| 0.2 * f64::from(i) / f64::from(n)).map(|x| (x, w(x, 0.1))))
    };
    let square = FieldPlot {
        title: "Clamped square under uniform pressure".into(),
        subtitle: "Cotton poplin  ·  40 × 40 cells, 4 subcells  ·  q = 0.5 Pa".into(),
        origin: "synthetic data".into(),
        quantity: "Deflection w".into(),
        unit: "m".into(),
        nodes: &nodes,
        quads: &quads,
        values: &values,
        profile_along: "x at y = 10 cm".into(),
        profile: line(40),
        profile_reference: Some(line(10)),
        reference_label: "series solution".into(),
        notes: vec!["Linear solve outside its validity: w / t = 1600; the shape is qualitative only, use the nonlinear analysis.".into()],
    };
    drawn("field-square.png", || field(&square));
    let mut wrong = square.clone();
    wrong.values = &values[1..];
    assert!(matches!(field(&wrong), Err(ChartError::Inconsistent { .. })));

    let (nodes, quads) = plate(100, 5, [0.2, 0.01]);
    let values: Vec<f64> = nodes.iter().map(|n| 4e-7 * (3.0 * pi * n[0] / 0.2).sin()).collect();
    let strip = FieldPlot { nodes: &nodes, quads: &quads, values: &values, notes: vec![], ..square.clone() };
    drawn("field-strip.png", || field(&strip));
    // A hole makes two lines of one, and nothing is drawn where there is no number.
    let lines = |profile: Curve| {
        let chart = field(&FieldPlot { profile, profile_reference: None, ..strip.clone() }).unwrap();
        let lines = chart.0.marks.iter().filter_map(|mark| match mark {
            canvas::Mark::Line { points, .. } => Some(points),
            _ => None,
        });
        assert!(lines.clone().flatten().all(|point| point.0.is_finite() && point.1.is_finite()));
        lines.count()
    };
    let (whole, mut holed) = (line(40), line(40));
    holed.y[18..22].fill(f64::NAN);
    assert_eq!(lines(holed), lines(whole) + 1);
    let zero = vec![0.0; nodes.len()];
    drawn("field-zero.png", || {
        field(&FieldPlot { values: &zero, profile: Curve::default(), ..strip.clone() })
    });
    let none: &[[u32; 4]] = &[];
    assert!(matches!(field(&FieldPlot { quads: none, ..strip }), Err(ChartError::NothingToDraw { .. })));
}

#[test]
fn histories_of_steps_and_in_time() {
    let curve = |points: &[(f64, f64)]| Curve::from_points(points.iter().copied());
    let line = |name: &str, points: &[(f64, f64)]| (name.to_string(), curve(points));
    let plot = HistoryPlot {
        title: "A folded strip, let go of".into(),
        subtitle: "poplin; 400 elements".into(),
        origin: "synthetic data".into(),
        along: ["Steps done".into(), String::new()],
        ends: vec![(1.0, "fold".into()), (1.02, "hold".into()), (2.0, "release".into())],
        panels: vec![
            HistoryPanel {
                quantity: "Displacement".into(),
                unit: "m".into(),
                lines: vec![
                    line("w_max", &[(0.0, 0.0), (1.0, 0.042), (2.0, 0.071)]),
                    line("end u", &[(0.0, 0.0), (1.0, -0.05), (2.0, -0.02)]),
                ],
            },
            HistoryPanel {
                quantity: "Energy".into(),
                unit: "J".into(),
                lines: vec![line("strain", &[(0.0, 0.0), (1.0, 1.1e-5), (2.0, 3.6e-6)])],
            },
        ],
        remarks: vec!["2 more probes are in the table beside.".into()],
    };
    drawn("history-steps.png", || history(&plot));
    let swing = |t: f64| (t, 1e-3 * (7.0 * t).cos());
    let line = Curve::from_points((0..400).map(|k| swing(0.01 * f64::from(k))));
    let lines = (0..7).map(|k| (format!("probe {k} w"), line.clone())).collect();
    let time = ["Time".to_string(), "s".to_string()];
    let panel = HistoryPanel { quantity: "Displacement".into(), unit: "m".into(), lines };
    let in_time = HistoryPlot {
        title: "A strip that swings".into(),
        along: time,
        panels: vec![panel],
        ..HistoryPlot::default()
    };
    drawn("history-time.png", || history(&in_time));
    assert!(matches!(history(&HistoryPlot::default()), Err(ChartError::NothingToDraw { .. })));
}

#[test]
fn parity_of_one_and_of_four_quantities() {
    let names = ["A", "B", "C", "D", "serge", "denim", "voile", "poplin", "satin", "twill"];
    let point = |i: usize, quantity: &str, unit: &str, scale: f64| ParityPoint {
        label: names[i].into(),
        group: if i.is_multiple_of(2) { "warp" } else { "weft" }.into(),
        quantity: quantity.into(),
        unit: unit.into(),
        measured: scale * (1.0 + 0.9 * i as f64),
        measured_half_width: Some(0.06 * scale * (1.0 + 0.9 * i as f64)),
        simulated: scale * (1.0 + 0.9 * i as f64) * (1.0 + 0.17 * (i as f64 * 2.1).sin()),
        simulated_half_width: Some(0.05 * scale * (1.0 + 0.9 * i as f64)),
        simulated_band: i.is_multiple_of(3).then_some([0.9 * scale, 1.2 * scale * (1.0 + i as f64)]),
        is_closed_loop: false,
        status: if i == 3 { ValueStatus::Doubtful } else { ValueStatus::Measured },
    };
    let one: Vec<ParityPoint> = (0..10).map(|i| point(i, "Bending rigidity B", "N·m", 1.1e-6)).collect();
    drawn("parity-one.png", || parity(&one, "Simulated against measured", "ten fabrics"));
    let mut four = one.clone();
    four.extend((0..10).map(|i| ParityPoint {
        simulated: 0.4 * 8f64.powf(0.45 * i as f64),
        measured: 0.45 * 8f64.powf(0.44 * i as f64),
        measured_half_width: None,
        simulated_half_width: None,
        ..point(i, "Shear stiffness G", "gf/(cm·°)", 0.3)
    }));
    four.extend((0..4).map(|i| point(i, "Drape coefficient", "%", 22.0)));
    four.extend((0..1).map(|i| point(i, "Bending length", "m", 0.021)));
    drawn("parity-four.png", || parity(&four, "Simulated against measured", "ten fabrics"));
    // Where the data are from is said whole: the name of a group goes on in the next line.
    for point in &mut four {
        point.group =
            if point.group == "warp" { "assumed spectrum, published data" } else { "from a loop" }.into();
    }
    let chart = parity(&four, "Simulated against measured", "ten fabrics").unwrap();
    let texts = svg_texts(&chart.svg().unwrap());
    assert!(texts.contains("published") && texts.contains("data") && !texts.contains('…'), "{texts}");
    let names = |texts: &str| texts.lines().filter(|line| names.contains(line)).count();
    let left_out = four.len() - names(&texts);
    assert!(
        left_out > 0 && one_line(&texts).contains(&format!("Names left out for want of room: {left_out} "))
    );
    assert!(one_line(&texts).contains("Hollow: rests on a value that is assumed or doubtful"), "{texts}");
    keep("parity-names.png", &chart.png().unwrap());
}

/// The lines of a chart as one.
fn one_line(texts: &str) -> String {
    texts.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A value that a finding speaks against looks in the chart as it does in the table.
#[test]
fn values_that_are_not_plainly_measured_have_their_marks() {
    let mut mock = Mock::new("Cotton poplin", Origin::Synthetic);
    mock.bending(WARP, 0.092, 0.058, 3);
    mock.bending(WEFT, 0.051, 0.031, 3);
    let texts = |sheet: &FabricSheet| svg_texts(&bending(sheet, &[]).unwrap().svg().unwrap());
    let has_marks = |texts: &str| texts.lines().any(|line| line.ends_with(['?', '*', '~']));
    assert!(!has_marks(&texts(&mock.sheet)));
    let key = |parameter, direction| Key { parameter, direction };
    mock.sheet.statuses.insert(key(Parameter::B, WARP), ValueStatus::Doubtful);
    mock.sheet.statuses.insert(key(Parameter::Hb, WEFT), ValueStatus::Assumed);
    let texts = texts(&mock.sheet);
    let ending_in = |mark: &str| texts.lines().filter(|line| line.ends_with(mark)).count();
    assert_eq!((ending_in(" ?"), ending_in(" *"), ending_in(" ~")), (1, 1, 0), "{texts}");
    assert!(
        texts.contains("? doubtful (see its findings)") && texts.contains("* rests on an assumption"),
        "{texts}"
    );
    drawn("bending-marks.png", || bending(&mock.sheet, &[]));
}

#[test]
fn a_draped_sheet_from_above_and_aside() {
    let tau = std::f64::consts::TAU;
    let (radial, around) = (6, 72);
    let nodes: Vec<[f64; 3]> = (0..=radial)
        .flat_map(|i| (0..around).map(move |k| (f64::from(i) / f64::from(radial), f64::from(k))))
        .map(|(part, k)| {
            let angle = tau * k / f64::from(around);
            let r = 0.09 + 0.06 * part * (0.75 + 0.2 * part * (6.0 * angle).cos());
            [r * angle.cos(), r * angle.sin(), -0.04 * part * part * (1.0 - 0.4 * (6.0 * angle).cos())]
        })
        .collect();
    let node = |i: i32, k: i32| (i * around + k % around) as u32;
    let quads: Vec<[u32; 4]> = (0..radial)
        .flat_map(|i| {
            (0..around).map(move |k| [node(i, k), node(i + 1, k), node(i + 1, k + 1), node(i, k + 1)])
        })
        .collect();
    let outline: Vec<f64> = nodes[nodes.len() - around as usize..].iter().map(|p| p[0].hypot(p[1])).collect();
    let plot = DrapePlot {
        title: "Drape".into(),
        subtitle: "made up".into(),
        origin: "synthetic data".into(),
        nodes: &nodes,
        quads: &quads,
        disc_radius: 0.09,
        sheet_radius: 0.15,
        outline: &outline,
        measured: Some(0.55),
        values: vec![("Drape coefficient".into(), "60 %".into())],
        remarks: vec!["nothing measured".into()],
    };
    drawn("drape-shadow.png", || drape_shadow(&plot));
    drawn("drape-view.png", || drape_view(&plot));
    let none: &[[u32; 4]] = &[];
    let empty = DrapePlot { quads: none, ..plot.clone() };
    assert!(matches!(drape_view(&empty), Err(ChartError::NothingToDraw { .. })));
    let short = DrapePlot { nodes: &nodes[1..], ..plot };
    assert!(matches!(drape_shadow(&short), Err(ChartError::Inconsistent { .. })));
}
