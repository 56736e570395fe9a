//! Goal: ink is where the data are, in the colour that the legend promises, and nowhere else.
//!
//! The places come from the data and from the numbers at the axes as they are read in the picture
//! ([`picture`]). The curves are those of the synthetic poplin of `kesf_data`.
#![cfg(feature = "charts")]

#[path = "../common/mod.rs"]
mod common;
mod picture;

use std::path::Path;

use kesf::characterise::{FabricSheet, characterise};
use kesf::instrument::{Direction, ReadSettings, Test, read_fabrics};
use kesf::quantity::Curve;
use kesf::report::chart::{
    DrapePlot, FieldPlot, HistoryPanel, HistoryPlot, ParityPoint, ProfileLine, ProfilePlot, SimulatedCurve,
    bending, drape_shadow, field, friction, history, of_test, parity, profile,
};
use picture::{Color, HEIGHT, Picture, Point, Region, Scale, along};

// Okabe & Ito (2008).
const BLUE: Color = [0x00, 0x72, 0xb2];
const VERMILLION: Color = [0xd5, 0x5e, 0x00];
const INK: Color = [0x1a, 0x1a, 0x1a];

/// gf/cm in N/m, gf·cm/cm in N·m/m, gf/cm² in Pa.
const FORCE: f64 = 0.980_665;
const MOMENT: f64 = 9.80665e-3;
const PRESSURE: f64 = 98.0665;

/// The page beside the column of values, and where the numbers of a chart of a test are.
const PLOT: Region = [0, 130, 1400, HEIGHT];
const BELOW: Region = [120, 1226, 1300, 1275];
const BESIDE: Region = [60, 130, 182, 1260];

fn mix(color: Color, other: u8, part: f64) -> Color {
    color.map(|c| (f64::from(c) + part * (f64::from(other) - f64::from(c))).round() as u8)
}

fn lighter(color: Color, part: f64) -> Color {
    mix(color, 255, part)
}

fn darker(color: Color, part: f64) -> Color {
    mix(color, 0, part)
}

fn poplin(test: &str) -> Option<FabricSheet> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data/poplin");
    if !folder.is_dir() {
        common::skipped(test, "no kesf_data");
        return None;
    }
    let batch = read_fabrics(&[folder], &ReadSettings::default(), &|_| {});
    Some(characterise(&batch.fabrics[0], &Default::default()))
}

/// A polyline on the page: abscissae and ordinates in the units of the axes.
fn on_page(points: impl IntoIterator<Item = (f64, f64)>, [x, y]: [Scale; 2]) -> Vec<Point> {
    points.into_iter().map(|(a, b)| (x.page(a), y.page(b))).collect()
}

/// Asserts that the places have ink of a colour, and that places beside them have none.
fn assert_line(picture: &Picture, places: &[Point], color: Color, expected: f64) {
    let covered = picture.covered(places, 4.0, color);
    assert!(covered > expected, "{covered} of the line has ink of {color:?}");
    // Across one diagonal at least there is none: the line may run along the other.
    let beside_by = |dx: f64| {
        picture.covered(&places.iter().map(|p| (p.0 + dx, p.1 - 14.0)).collect::<Vec<_>>(), 4.0, color)
    };
    let beside = beside_by(-14.0).min(beside_by(14.0));
    assert!(beside < 0.5 * covered, "{beside} of the same line beside it has ink too");
}

/// The curves of each specimen of a test and direction, each as places along its branches.
fn specimens(
    sheet: &FabricSheet,
    test: Test,
    direction: Option<Direction>,
    units: [f64; 2],
    scales: [Scale; 2],
) -> Vec<Vec<Point>> {
    let mine =
        sheet.specimens.iter().filter(|s| (s.measurement.test, s.measurement.direction) == (test, direction));
    mine.map(|s| {
        let branch =
            |c: &Curve| along(&on_page(c.points().map(|(x, y)| (x / units[0], y / units[1])), scales));
        s.branches.iter().flat_map(|b| branch(&b.curve)).collect()
    })
    .collect()
}

/// One specimen of a direction is drawn in the full colour, along its data and nowhere else.
fn assert_specimen(picture: &Picture, specimens: &[Vec<Point>], color: Color, expected: f64, region: Region) {
    let covered = |places: &&Vec<Point>| picture.covered(places, 4.0, color);
    let drawn = specimens.iter().max_by(|a, b| covered(a).total_cmp(&covered(b))).unwrap();
    assert_line(picture, drawn, color, expected);
    let stray = picture.stray(drawn, 7.0, color, region);
    assert!(stray < 0.03, "{stray} of the ink of {color:?} is elsewhere");
}

fn assert_test(name: &str, test: Test, numbers: [[&str; 2]; 2], units: [f64; 2]) {
    let Some(sheet) = poplin(name) else { return };
    let picture = Picture::decode(&of_test(&sheet, test, &[]).unwrap().png().unwrap());
    let scales = [picture.x_scale(numbers[0], BELOW), picture.y_scale(numbers[1], BESIDE)];
    let curves = |direction| specimens(&sheet, test, direction, units, scales);
    if test == Test::Compression {
        return assert_specimen(&picture, &curves(None), BLUE, 0.85, PLOT);
    }
    assert_specimen(&picture, &curves(Some(Direction::Warp)), BLUE, 0.85, PLOT);
    // Dashed: 20 pixels of 31.
    assert_specimen(&picture, &curves(Some(Direction::Weft)), VERMILLION, 0.5, PLOT);
    let title = format!("Poplin (synthetic), {}", test.name());
    assert!(picture.find(&title, (40.0, true), [20, 20, 1000, 90]).is_some(), "no title {title}");
    let other = if test == Test::Shear { "Poplin (synthetic), tensile" } else { "Poplin (synthetic), shear" };
    assert!(picture.find(other, (40.0, true), [20, 20, 1000, 90]).is_none(), "the title is {other}");
}

#[test]
fn tensile_curves_are_where_the_data_are() {
    let numbers = [["2", "6"], ["100", "400"]];
    assert_test("tensile_curves_are_where_the_data_are", Test::Tensile, numbers, [0.01, FORCE]);
}

#[test]
fn shear_loops_are_where_the_data_are() {
    let degree = std::f64::consts::PI / 180.0;
    let numbers = [["−6", "0"], ["−8", "0"]];
    assert_test("shear_loops_are_where_the_data_are", Test::Shear, numbers, [degree, FORCE]);
}

#[test]
fn bending_loops_are_where_the_data_are() {
    let numbers = [["−2.0", "0.0"], ["0.20", "0.00"]];
    assert_test("bending_loops_are_where_the_data_are", Test::Bending, numbers, [100.0, MOMENT]);
}

#[test]
fn compression_curves_are_where_the_data_are() {
    let numbers = [["0.34", "0.48"], ["10", "40"]];
    assert_test("compression_curves_are_where_the_data_are", Test::Compression, numbers, [1e-3, PRESSURE]);
}

#[test]
fn a_simulated_curve_lies_over_the_measured_one() {
    let Some(sheet) = poplin("a_simulated_curve_lies_over_the_measured_one") else { return };
    let rigidity = 0.04 * 9.80665e-5;
    let ends = [(-250.0, -250.0 * rigidity), (250.0, 250.0 * rigidity)];
    let simulated = SimulatedCurve {
        label: "simulated".into(),
        direction: Some(Direction::Warp),
        curve: Curve::from_points(ends),
        ..SimulatedCurve::default()
    };
    let picture = Picture::decode(&bending(&sheet, &[simulated]).unwrap().png().unwrap());
    let scales = [picture.x_scale(["−2.0", "0.0"], BELOW), picture.y_scale(["0.20", "0.00"], BESIDE)];
    let line = along(&on_page(ends.map(|(k, m)| (k / 100.0, m / MOMENT)), scales));
    assert_line(&picture, &line, darker(BLUE, 0.55), 0.9);
    // The measured loop is a pale broad band below it.
    let measured = specimens(&sheet, Test::Bending, Some(Direction::Warp), [100.0, MOMENT], scales);
    let covered = measured.iter().map(|m| picture.covered(m, 5.0, lighter(BLUE, 0.5))).fold(0.0, f64::max);
    assert!(covered > 0.85, "{covered} of the measured loop is seen");
}

#[test]
fn a_friction_law_runs_along_its_loop() {
    let Some(sheet) = poplin("a_friction_law_runs_along_its_loop") else { return };
    let law = sheet.law(Test::Compression, None).unwrap();
    let traces = law.traces(&sheet);
    let fitted = traces.iter().find(|t| t.fitted).unwrap();
    let picture = Picture::decode(&friction(&sheet, Some(Test::Compression)).unwrap().png().unwrap());
    let scales = [
        picture.x_scale(["0.34", "0.48"], [120, 890, 1400, 945]),
        picture.y_scale(["10", "40"], [60, 190, 160, 900]),
    ];
    let page = |ordinates: &[f64]| {
        on_page(fitted.x.iter().zip(ordinates).map(|(x, y)| (x / 1e-3, y / PRESSURE)), scales)
    };
    assert_line(&picture, &along(&page(&fitted.law)), darker(BLUE, 0.45), 0.9);
    let covered = picture.covered(&page(&fitted.measured), 6.0, lighter(BLUE, 0.35));
    assert!(covered > 0.85, "{covered} of the samples are seen");
}

#[test]
fn histories_are_where_the_data_are() {
    let displacement = Curve::from_points([(0.0, 0.0), (1.0, 0.042), (2.0, 0.01)]);
    let stored = Curve::from_points([(0.0, 0.0), (1.0, 2e-6), (2.0, 6e-6)]);
    let panel = |quantity: &str, unit: &str, curve: &Curve| HistoryPanel {
        quantity: quantity.into(),
        unit: unit.into(),
        lines: vec![("one".into(), curve.clone())],
    };
    let plot = HistoryPlot {
        along: ["Steps done".into(), String::new()],
        panels: vec![panel("Displacement", "m", &displacement), panel("Energy", "J", &stored)],
        ..HistoryPlot::default()
    };
    let picture = Picture::decode(&history(&plot).unwrap().png().unwrap());
    let x = picture.x_scale(["0.0", "2.0"], [120, 645, 1400, 690]);
    let mut places = Vec::new();
    for (curve, numbers, beside, unit) in [
        (&displacement, ["0", "40"], [60, 190, 160, 650], 1e-3),
        (&stored, ["0", "6"], [60, 770, 160, 1230], 1e-6),
    ] {
        let scales = [x, picture.y_scale(numbers, beside)];
        let line = along(&on_page(curve.points().map(|(x, y)| (x, y / unit)), scales));
        assert_line(&picture, &line, BLUE, 0.95);
        places.extend(line);
    }
    assert!(picture.stray(&places, 7.0, BLUE, [0, 130, 1360, HEIGHT]) < 0.01);
}

#[test]
fn parity_points_are_where_the_numbers_are() {
    let point = |i: usize| ParityPoint {
        group: if i.is_multiple_of(2) { "warp" } else { "weft" }.into(),
        quantity: "Bending length".into(),
        unit: "cm".into(),
        measured: 1.0 + 0.9 * i as f64,
        simulated: (1.0 + 0.9 * i as f64) * (1.0 + 0.17 * (i as f64 * 2.1).sin()),
        ..ParityPoint::default()
    };
    let points: Vec<ParityPoint> = (0..9).map(point).collect();
    let picture = Picture::decode(&parity(&points, "Simulated against measured", "").unwrap().png().unwrap());
    let scales = [
        picture.x_scale(["2", "8"], [150, 1150, 1400, 1350]),
        picture.y_scale(["2", "8"], [60, 200, 167, 1250]),
    ];
    for (group, color) in [("warp", BLUE), ("weft", VERMILLION)] {
        let mine = points.iter().filter(|p| p.group == group).map(|p| (p.measured, p.simulated));
        let places = on_page(mine, scales);
        // Markers are 10 pixels in radius: their whole inside is filled.
        for &(x, y) in &places {
            for (dx, dy) in [(0.0, 0.0), (5.0, 5.0), (-5.0, 5.0), (5.0, -5.0), (-5.0, -5.0)] {
                assert!(picture.has((x + dx, y + dy), 1.0, color), "{group} at {x} {y}");
            }
        }
        assert!(picture.stray(&places, 16.0, color, PLOT) < 0.01);
    }
    let equal = along(&on_page([(1.0, 1.0), (8.0, 8.0)], scales));
    let covered = picture.covered(&equal, 3.0, INK);
    assert!(covered > 0.8, "{covered} of the 1:1 line");
}

/// A clamped-looking square of 40 x 40 quads with side 20 cm: nodes, quads and deflections (m).
type Square = (Vec<[f64; 3]>, Vec<[u32; 4]>, Vec<f64>);

fn square(w: impl Fn(f64, f64) -> f64) -> Square {
    let at = |i: u32| 0.2 * f64::from(i) / 40.0;
    let nodes: Vec<[f64; 3]> = (0..=40).flat_map(|j| (0..=40).map(move |i| [at(i), at(j), 0.0])).collect();
    let corner = |i: u32, j: u32| 41 * j + i;
    let quad = |i, j| [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
    let quads = (0..40).flat_map(|j| (0..40).map(move |i| quad(i, j))).collect();
    let values = nodes.iter().map(|n| w(n[0], n[1])).collect();
    (nodes, quads, values)
}

#[test]
fn a_field_is_coloured_by_its_values() {
    let pi = std::f64::consts::PI;
    let w = |x: f64, y: f64| 1e-3 * (pi * x / 0.2).sin() * (pi * y / 0.2).sin();
    let (nodes, quads, values) = square(w);
    let line: Vec<(f64, f64)> = (0..=80).map(|i| 0.2 * f64::from(i) / 80.0).map(|x| (x, w(x, 0.1))).collect();
    let plot = FieldPlot {
        title: "Square".into(),
        quantity: "Deflection w".into(),
        unit: "m".into(),
        nodes: &nodes,
        quads: &quads,
        values: &values,
        profile: Curve::from_points(line.iter().copied()),
        ..FieldPlot::default()
    };
    let picture = Picture::decode(&field(&plot).unwrap().png().unwrap());
    let map = [
        picture.x_scale(["4", "16"], [120, 1040, 1020, 1200]),
        picture.y_scale(["4", "16"], [60, 200, 157, 1100]),
    ];
    // Viridis (van der Walt & Smith): green and blue fall from the yellow of 1 to the violet of 0.
    let color = |x: f64, y: f64| {
        let (x, y) = (map[0].page(x) as usize, map[1].page(y) as usize);
        let mut greens: Vec<u8> = (y - 4..=y + 4)
            .flat_map(|y| (x - 4..=x + 4).map(move |x| (x, y)))
            .map(|(x, y)| picture.pixel(x, y)[1])
            .collect();
        greens.sort_unstable();
        greens[greens.len() / 2]
    };
    let falling = [(10.0, 10.0), (7.0, 10.0), (13.0, 5.0), (4.0, 6.0), (17.0, 4.0), (2.0, 2.0)];
    let greens = falling.map(|(x, y)| color(x, y));
    assert!(greens.is_sorted_by(|a, b| a > b), "{greens:?}");
    assert_eq!(color(13.0, 5.0), color(7.0, 15.0), "the field is symmetric");
    let right = [1180, 200, 1800, 1200];
    let scales = [
        picture.x_scale(["5", "15"], [1180, 1040, 1800, 1120]),
        picture.y_scale(["0.2", "0.8"], [1220, 200, 1322, 1100]),
    ];
    let places = along(&on_page(line.iter().map(|(x, w)| (100.0 * x, 1e3 * w)), scales));
    assert_line(&picture, &places, BLUE, 0.95);
    assert!(picture.stray(&places, 7.0, BLUE, right) < 0.02);
}

#[test]
fn a_strip_from_the_side_is_where_its_shape_is() {
    let shape: Vec<(f64, f64)> =
        (0..=60).map(|i| f64::from(i) / 60.0).map(|t| (0.08 * t, -0.05 * t * t)).collect();
    let line = ProfileLine {
        direction: Direction::Warp,
        pale: false,
        name: "warp".into(),
        shape: Curve::from_points(shape.iter().copied()),
        values: vec![],
    };
    let plot = ProfilePlot { title: "Strip".into(), lines: vec![line], ..ProfilePlot::default() };
    let picture = Picture::decode(&profile(&plot).unwrap().png().unwrap());
    let scales = [
        picture.x_scale(["20", "60"], [120, 1240, 1400, 1300]),
        picture.y_scale(["−40", "−20"], [50, 190, 147, 1260]),
    ];
    let places = along(&on_page(shape.iter().map(|(x, z)| (1e3 * x, 1e3 * z)), scales));
    assert_line(&picture, &places, BLUE, 0.98);
    assert!(picture.stray(&places, 7.0, BLUE, [0, 130, 1380, HEIGHT]) < 0.02);
    let marked = scales.map(|s| (s.page(30.0) - s.page(20.0)).abs());
    assert!((marked[0] / marked[1] - 1.0).abs() < 0.02, "a millimetre is as long across as up: {marked:?}");
}

#[test]
fn the_shadow_of_a_draped_sheet_ends_at_its_outline() {
    let tau = std::f64::consts::TAU;
    let (around, disc) = (144, 0.09);
    let radius = |k: usize| 0.12 + 0.02 * (5.0 * tau * k as f64 / around as f64).cos();
    let ring = |part: f64| {
        (0..around).map(move |k| {
            let (sin, cos) = (tau * k as f64 / around as f64).sin_cos();
            let r = disc + part * (radius(k) - disc);
            [r * cos, r * sin, -0.05 * part]
        })
    };
    let nodes: Vec<[f64; 3]> = ring(0.0).chain(ring(1.0)).collect();
    let next = |k: usize| (k + 1) % around;
    let quads: Vec<[u32; 4]> =
        (0..around).map(|k| [k, around + k, around + next(k), next(k)].map(|n| n as u32)).collect();
    let outline: Vec<f64> = (0..around).map(radius).collect();
    let plot = DrapePlot {
        title: "Drape".into(),
        nodes: &nodes,
        quads: &quads,
        disc_radius: disc,
        sheet_radius: 0.15,
        outline: &outline,
        ..DrapePlot::default()
    };
    let picture = Picture::decode(&drape_shadow(&plot).unwrap().png().unwrap());
    // There are no axes: the scale comes from the box around the outline, the same across and up.
    let points: Vec<Point> = nodes[around..].iter().map(|p| (p[0], p[1])).collect();
    let bounds = |of: fn(&Point) -> f64| {
        points.iter().map(of).fold([f64::MAX, f64::MIN], |b, v| [b[0].min(v), b[1].max(v)])
    };
    let ([x0, x1], [y0, y1]) = (bounds(|p| p.0), bounds(|p| p.1));
    let region = [0, 130, 1310, HEIGHT];
    let [left, top, right, bottom] = picture.extent(BLUE, region);
    let scale = (right - left - 4.0) / (x1 - x0);
    assert!(((bottom - top - 4.0) / (y1 - y0) / scale - 1.0).abs() < 0.01);
    let at = |x: f64, y: f64| (left + 2.0 + (x - x0) * scale, bottom - 2.0 - (y - y0) * scale);
    let mut line: Vec<Point> = points.iter().map(|p| at(p.0, p.1)).collect();
    line.push(line[0]);
    let places = along(&line);
    assert!(picture.covered(&places, 3.0, BLUE) > 0.98);
    assert!(picture.stray(&places, 6.0, BLUE, region) < 0.02);
    for k in (0..around).step_by(9) {
        let (sin, cos) = (tau * k as f64 / around as f64).sin_cos();
        let place = |r: f64| at(r * cos, r * sin);
        let shade = lighter(BLUE, 0.55);
        assert!(picture.has(place(0.5 * (disc + radius(k))), 1.0, shade), "shadow at {k}");
        assert!(!picture.has(place(radius(k) + 0.006), 1.0, shade), "no shadow outside at {k}");
        assert!(!picture.has(place(0.5 * disc), 1.0, shade), "the disc at {k}");
    }
    // Nothing was measured, so that nothing is drawn of it.
    assert_eq!(picture.extent(VERMILLION, [0, 130, 1800, HEIGHT])[2], 0.0);
    // The round shadow of 40 %: π r² = π R_d² + 0.4 (π R_s² − π R_d²), with 9 and 15 cm.
    let measured = DrapePlot { measured: Some(0.4), ..plot };
    let picture = Picture::decode(&drape_shadow(&measured).unwrap().png().unwrap());
    let round = (0.0081_f64 + 0.4 * (0.0225 - 0.0081)).sqrt();
    let ring: Vec<Point> = (0..720)
        .map(|k| (tau * f64::from(k) / 720.0).sin_cos())
        .map(|(sin, cos)| at(round * cos, round * sin))
        .collect();
    // Dashed: 20 pixels of 31, and more where a disc of 3 pixels reaches into a gap.
    let covered = picture.covered(&ring, 3.0, VERMILLION);
    assert!((0.6..0.95).contains(&covered), "{covered} of the measured circle has ink");
    assert!(picture.stray(&ring, 6.0, VERMILLION, region) < 0.02);
    assert!(picture.find("measured, as a circle", (25.0, false), [1390, 262, 1790, 320]).is_some());
}
