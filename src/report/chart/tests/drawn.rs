//! Goal: ink is where the data are, in the colour that the legend promises, and nowhere else.
//!
//! The places come from the data and from the numbers at the axes as they are read in the picture
//! ([`super::picture`]).

use plotters::prelude::RGBColor;

use super::super::canvas::Point;
use super::super::letters::Type;
use super::super::palette::{BLUE, GROUPS, INK, VERMILLION, darker, lighter, sequential};
use super::picture::{PLOT, Picture, Scale, along};
use super::*;

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// N/m in gf/cm, N·m/m in gf·cm/cm, Pa in gf/cm².
const FORCE: f64 = 0.980_665;
const MOMENT: f64 = 9.80665e-3;
const PRESSURE: f64 = 98.0665;

/// A polyline on the page: abscissae and ordinates in the units of the axes.
fn on_page(points: impl IntoIterator<Item = (f64, f64)>, x: Scale, y: Scale) -> Vec<Point> {
    points.into_iter().map(|(a, b)| (x.page(a), y.page(b))).collect()
}

/// Asserts that a line of a colour runs along the data; for a dashed one, that nothing else has the colour too.
fn assert_line(picture: &Picture, line: &[Point], color: RGBColor, dashed: bool, alone: bool) {
    let places = along(line);
    let covered = picture.covered(&places, 3.0, color);
    let expected = if dashed { 0.55 } else { 0.9 };
    assert!(covered > expected, "{covered} of the line has ink");
    if alone {
        let stray = picture.stray(&places, 6.0, color, PLOT);
        assert!(stray < 0.02, "{stray} of the ink is elsewhere");
    }
    // The same line one hundredth of the page higher is not there.
    let beside: Vec<Point> = places.iter().map(|p| (p.0, p.1 - 14.0)).collect();
    assert!(picture.covered(&beside, 3.0, color) < 0.6 * covered);
}

/// The branches of the first specimen of a direction, in the units of the chart.
fn branches(
    sheet: &FabricSheet,
    direction: Option<Direction>,
    units: [f64; 2],
    [x, y]: [Scale; 2],
) -> Vec<Vec<Point>> {
    let first = sheet.specimens.iter().find(|s| s.measurement.direction == direction).unwrap();
    let page = |b: &Branch| on_page(b.curve.points().map(|(a, b)| (a / units[0], b / units[1])), x, y);
    first.branches.iter().map(page).collect()
}

/// The curves of both directions of a test.
fn assert_both(sheet: &FabricSheet, bytes: &[u8], numbers: [[&str; 2]; 2], units: [f64; 2]) {
    let picture = Picture::decode(bytes);
    let scales = [picture.x_scale(numbers[0], PLOT), picture.y_scale(numbers[1], PLOT)];
    for (direction, color) in [(WARP, BLUE), (WEFT, VERMILLION)] {
        for branch in branches(sheet, direction, units, scales) {
            assert_line(&picture, &branch, color, direction == WEFT, false);
        }
        let all: Vec<Point> =
            branches(sheet, direction, units, scales).iter().flat_map(|b| along(b)).collect();
        let stray = picture.stray(&all, 6.0, color, PLOT);
        assert!(stray < 0.02, "{direction:?}: {stray} of the ink is elsewhere");
    }
}

#[test]
fn tensile_curves_are_where_the_data_are() {
    let mut mock = Mock::new("Cotton poplin", Origin::Synthetic);
    mock.tensile(WARP, 0.041);
    mock.tensile(WEFT, 0.092);
    let bytes = tensile(&mock.sheet, &[]).unwrap();
    assert_both(&mock.sheet, &bytes, [["2", "8"], ["100", "400"]], [0.01, FORCE]);
}

#[test]
fn shear_loops_are_where_the_data_are() {
    let mut mock = Mock::new("Cotton poplin", Origin::Synthetic);
    mock.shear(WARP, 0.82, 1.3);
    mock.shear(WEFT, 0.44, 1.1);
    let bytes = shear(&mock.sheet, &[]).unwrap();
    assert_both(&mock.sheet, &bytes, [["−6", "8"], ["−4", "6"]], [DEGREE, FORCE]);
}

#[test]
fn bending_loops_are_where_the_data_are() {
    let mut mock = Mock::new("Cotton poplin", Origin::Synthetic);
    mock.bending(WARP, 0.092, 0.058, 3);
    mock.bending(WEFT, 0.051, 0.031, 3);
    let bytes = bending(&mock.sheet, &[]).unwrap();
    assert_both(&mock.sheet, &bytes, [["−2.0", "1.5"], ["−0.2", "0.1"]], [100.0, MOMENT]);
    let picture = Picture::decode(&bytes);
    let title = Type::new(40.0, INK).bold();
    assert!(picture.find("Cotton poplin, bending", title, [0, 0, 1000, 130]).is_some());
    assert!(picture.find("Cotton poplin, shear", title, [0, 0, 1000, 130]).is_none());
}

#[test]
fn compression_curves_are_where_the_data_are() {
    let mut mock = Mock::new("Cotton poplin", Origin::Synthetic);
    mock.compression();
    let picture = Picture::decode(&compression(&mock.sheet, &[]).unwrap());
    let scales = [picture.x_scale(["0.45", "0.60"], PLOT), picture.y_scale(["10", "40"], PLOT)];
    for branch in branches(&mock.sheet, None, [1e-3, PRESSURE], scales) {
        assert_line(&picture, &branch, BLUE, false, false);
    }
}

#[test]
fn a_simulated_curve_lies_over_the_measured_one() {
    let mut mock = Mock::new("Cotton poplin", Origin::Synthetic);
    mock.bending(WARP, 0.092, 0.058, 1);
    let rigidity = 0.05 * 9.80665e-5;
    let ends = [(-250.0, -250.0 * rigidity), (250.0, 250.0 * rigidity)];
    let picture = Picture::decode(&bending(&mock.sheet, &[simulated(WARP, ends)]).unwrap());
    let scales = [picture.x_scale(["−2.0", "1.5"], PLOT), picture.y_scale(["−0.2", "0.1"], PLOT)];
    let line = on_page(ends.map(|(k, m)| (k / 100.0, m / MOMENT)), scales[0], scales[1]);
    assert_line(&picture, &line, darker(BLUE, 0.55), false, false);
    for branch in branches(&mock.sheet, WARP, [100.0, MOMENT], scales) {
        let covered = picture.covered(&along(&branch), 5.0, lighter(BLUE, 0.5));
        assert!(covered > 0.9, "{covered} of the measured branch is seen below");
    }
}

#[test]
fn parity_points_are_where_the_numbers_are() {
    let point = |i: usize| ParityPoint {
        group: if i.is_multiple_of(2) { "warp" } else { "weft" }.into(),
        quantity: "Bending rigidity B".into(),
        unit: "µN·m".into(),
        measured: 1.0 + 0.9 * i as f64,
        simulated: (1.0 + 0.9 * i as f64) * (1.0 + 0.17 * (i as f64 * 2.1).sin()),
        ..ParityPoint::default()
    };
    let points: Vec<ParityPoint> = (0..9).map(point).collect();
    let picture = Picture::decode(&parity(&points, "Simulated against measured", "").unwrap());
    let scales = [picture.x_scale(["2", "8"], PLOT), picture.y_scale(["2", "8"], PLOT)];
    for (group, color) in [("warp", GROUPS[0]), ("weft", GROUPS[1])] {
        let mine = points.iter().filter(|p| p.group == group).map(|p| (p.measured, p.simulated));
        let places = on_page(mine, scales[0], scales[1]);
        // Markers are 10 pixels in radius: their whole inside is filled.
        for &(x, y) in &places {
            for (dx, dy) in [(0.0, 0.0), (5.0, 5.0), (-5.0, 5.0), (5.0, -5.0), (-5.0, -5.0)] {
                assert!(picture.has((x + dx, y + dy), 1.0, color), "{group} at {x} {y}");
            }
        }
        assert!(picture.stray(&places, 16.0, color, PLOT) < 0.01);
    }
    let equal = on_page([(1.0, 1.0), (9.0, 9.0)], scales[0], scales[1]);
    let covered = picture.covered(&along(&equal), 2.0, INK);
    assert!(covered > 0.85, "{covered} of the 1:1 line");
}

/// Where on the colour scale a place is: the most frequent answer around it, as contour lines cross.
fn level(picture: &Picture, (x, y): Point) -> f64 {
    let nearest = |pixel: [u8; 3]| {
        let off = |t: &f64| {
            let RGBColor(r, g, b) = sequential(*t);
            [r, g, b].iter().zip(pixel).map(|(a, b)| i32::from(a.abs_diff(b)).pow(2)).sum::<i32>()
        };
        (0..=200).map(|i| f64::from(i) / 200.0).min_by_key(off).unwrap()
    };
    let (x, y) = (x as usize, y as usize);
    let mut levels: Vec<f64> =
        (y - 4..=y + 4).flat_map(|y| (x - 4..=x + 4).map(move |x| nearest(picture.pixel(x, y)))).collect();
    levels.sort_by(f64::total_cmp);
    levels[levels.len() / 2]
}

#[test]
fn a_field_is_coloured_by_its_values() {
    let pi = std::f64::consts::PI;
    let (nodes, quads) = plate(40, 40, [0.2, 0.2]);
    let w = |x: f64, y: f64| 1e-3 * (pi * x / 0.2).sin() * (pi * y / 0.2).sin();
    let values: Vec<f64> = nodes.iter().map(|n| w(n[0], n[1])).collect();
    let profile: Vec<(f64, f64)> =
        (0..=80).map(|i| 0.2 * f64::from(i) / 80.0).map(|x| (x, w(x, 0.1))).collect();
    let plot = FieldPlot {
        title: "Square".into(),
        quantity: "Deflection w".into(),
        unit: "m".into(),
        nodes: &nodes,
        quads: &quads,
        values: &values,
        profile: Curve::from_points(profile.iter().copied()),
        ..FieldPlot::default()
    };
    let picture = Picture::decode(&field(&plot).unwrap());
    let map = [0, 130, 1020, HEIGHT_OF_PAGE];
    let (x, y) = (picture.x_scale(["5", "15"], map), picture.y_scale(["5", "15"], map));
    for (px, py) in [(10.0, 10.0), (5.0, 5.0), (16.0, 8.0), (2.0, 18.0), (1.0, 10.0), (10.0, 17.0)] {
        let found = level(&picture, (x.page(px), y.page(py)));
        let expected = 1e3 * w(px / 100.0, py / 100.0);
        // Ten bands, each of one colour.
        assert!((found - expected).abs() < 0.075, "at {px} {py}: {found} instead of {expected}");
    }
    let beside = [1180, 130, 1800, HEIGHT_OF_PAGE];
    let scales = [picture.x_scale(["5", "15"], beside), picture.y_scale(["0.2", "0.8"], beside)];
    let line = on_page(profile.iter().map(|(x, w)| (100.0 * x, 1e3 * w)), scales[0], scales[1]);
    assert_line(&picture, &line, BLUE, false, false);
    assert!(picture.stray(&along(&line), 6.0, BLUE, beside) < 0.02);
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
    let picture = Picture::decode(&drape_shadow(&plot).unwrap());
    // There are no axes: the scale comes from the box around the outline, the same across and up.
    let points: Vec<Point> = nodes[around..].iter().map(|p| (p[0], p[1])).collect();
    let bounds = |of: fn(&Point) -> f64| {
        points.iter().map(of).fold([f64::MAX, f64::MIN], |b, v| [b[0].min(v), b[1].max(v)])
    };
    let ([x0, x1], [y0, y1]) = (bounds(|p| p.0), bounds(|p| p.1));
    let picture_of = [0, 130, 1310, HEIGHT_OF_PAGE];
    let [left, top, right, bottom] = picture.extent(BLUE, picture_of);
    let scale = (right - left - 4.0) / (x1 - x0);
    assert!(((bottom - top - 4.0) / (y1 - y0) / scale - 1.0).abs() < 0.01);
    let at = |x: f64, y: f64| (left + 2.0 + (x - x0) * scale, bottom - 2.0 - (y - y0) * scale);
    let mut line: Vec<Point> = points.iter().map(|p| at(p.0, p.1)).collect();
    line.push(line[0]);
    let places = along(&line);
    assert!(picture.covered(&places, 3.0, BLUE) > 0.98);
    assert!(picture.stray(&places, 6.0, BLUE, picture_of) < 0.02);
    for k in (0..around).step_by(9) {
        let (sin, cos) = (tau * k as f64 / around as f64).sin_cos();
        let place = |r: f64| at(r * cos, r * sin);
        let shade = lighter(BLUE, 0.55);
        assert!(picture.has(place(0.5 * (disc + radius(k))), 1.0, shade), "shadow at {k}");
        assert!(!picture.has(place(radius(k) + 0.006), 1.0, shade), "no shadow outside at {k}");
        assert!(!picture.has(place(0.5 * disc), 1.0, shade), "the disc at {k}");
    }
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
    let picture = Picture::decode(&profile(&plot).unwrap());
    let scales = [picture.x_scale(["20", "60"], PLOT), picture.y_scale(["−40", "−20"], PLOT)];
    let page = on_page(shape.iter().map(|(x, z)| (1e3 * x, 1e3 * z)), scales[0], scales[1]);
    assert_line(&picture, &page, BLUE, false, true);
    let marked = scales.map(|s| (s.page(30.0) - s.page(20.0)).abs());
    assert!((marked[0] / marked[1] - 1.0).abs() < 0.01, "a millimetre is as long across as up: {marked:?}");
}

#[test]
fn a_friction_law_runs_along_its_loop() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data/poplin");
    if !folder.is_dir() {
        return crate::common::skipped("a_friction_law_runs_along_its_loop", "no kesf_data");
    }
    let batch = instrument::read_fabrics(&[folder], &instrument::ReadSettings::default(), &|_| {});
    let sheet = characterise::characterise(&batch.fabrics[0], &characterise::Settings::default());
    let law = sheet.law(Test::Compression, None).unwrap();
    let traces = law.traces(&sheet);
    let fitted = traces.iter().find(|t| t.fitted).unwrap();
    let picture = Picture::decode(&friction(&sheet, Some(Test::Compression)).unwrap());
    let upper = [0, 180, 1400, 960];
    let scales = [picture.x_scale(FRICTION[0], upper), picture.y_scale(FRICTION[1], upper)];
    let page = |ordinates: &[f64]| {
        on_page(fitted.x.iter().zip(ordinates).map(|(x, y)| (x / 1e-3, y / PRESSURE)), scales[0], scales[1])
    };
    assert_line(&picture, &page(&fitted.law), darker(BLUE, 0.45), false, false);
    let dots = page(&fitted.measured);
    let covered = picture.covered(&dots, 5.0, lighter(BLUE, 0.35));
    assert!(covered > 0.9, "{covered} of the samples are seen beside the law");
}

/// Numbers at the axes of the compression of the poplin.
const FRICTION: [[&str; 2]; 2] = [["0.20", "0.30"], ["10", "40"]];
const HEIGHT_OF_PAGE: usize = super::super::canvas::HEIGHT;
