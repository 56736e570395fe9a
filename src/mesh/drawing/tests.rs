use std::f64::consts::PI;
use std::path::Path;

use super::{Drawing, DrawingOptions};
use crate::mesh::{MeshError, QuadMesh};

/// A DXF drawing of R12 with these entities, the group codes and values of each one line.
fn dxf(unit: Option<u8>, entities: &str) -> String {
    let header = unit.map_or(String::new(), |u| format!("9\n$INSUNITS\n70\n{u}\n"));
    let pairs = entities.replace([';', '='], "\n").replace(' ', "");
    format!(
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n{header}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{pairs}0\nENDSEC\n0\nEOF\n"
    )
}

/// A closed polyline of points, each with its bulge.
fn polyline(layer: &str, points: &[[f64; 3]]) -> String {
    let points: String = points.iter().map(|[x, y, b]| format!("10={x};20={y};42={b}\n")).collect();
    format!("0=LWPOLYLINE;5=2F;8={layer};90=4;70=1\n{points}")
}

fn line(a: [f64; 2], b: [f64; 2]) -> String {
    format!("0=LINE;8=0;10={};20={};30=0;11={};21={};31=0\n", a[0], a[1], b[0], b[1])
}

const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [100.0, 100.0, 0.0], [0.0, 100.0, 0.0]];

fn read(name: &str, text: &str, options: &DrawingOptions<'_>, cell: f64) -> Result<QuadMesh, MeshError> {
    let mesh = Drawing::parse(Path::new(name), text.as_bytes(), options)?.mesh(cell)?;
    mesh.check().unwrap();
    assert!(mesh.is_flat());
    assert_eq!(mesh.triangles(), mesh.quads.len());
    Ok(mesh)
}

fn of_dxf(unit: Option<u8>, entities: &str, cell: f64) -> Result<QuadMesh, MeshError> {
    read("a.dxf", &dxf(unit, entities), &DrawingOptions::default(), cell)
}

fn of_svg(page: &str, shapes: &str, cell: f64) -> Result<QuadMesh, MeshError> {
    let text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {page}>\n{shapes}\n</svg>");
    read("a.svg", &text, &DrawingOptions::default(), cell)
}

const MM: &str = "width=\"200mm\" height=\"100mm\" viewBox=\"0 0 200 100\"";

fn area(mesh: &QuadMesh) -> f64 {
    let of_one = |quad: usize| {
        let c = mesh.corners(quad);
        0.5 * (c[1] - c[0]).cross(&(c[2] - c[0])).z
    };
    (0..mesh.quads.len()).map(of_one).sum()
}

/// The smallest angle of all triangles, in degrees, and the mean length of their sides.
fn quality(mesh: &QuadMesh) -> (f64, f64) {
    let (mut least, mut sum) = (180.0f64, 0.0);
    for quad in 0..mesh.quads.len() {
        let c = mesh.corners(quad);
        for k in 0..3 {
            let (a, b) = (c[(k + 1) % 3] - c[k], c[(k + 2) % 3] - c[k]);
            least = least.min(a.angle(&b).to_degrees());
            sum += a.norm();
        }
    }
    (least, sum / (3 * mesh.quads.len()) as f64)
}

fn refusal(result: Result<QuadMesh, MeshError>) -> String {
    result.map(|m| m.quads.len()).unwrap_err().to_string()
}

fn near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() <= relative, "{found} instead of {expected}");
}

#[test]
fn a_square_has_its_area_sets_and_good_triangles() {
    let mesh = of_dxf(Some(4), &polyline("0", &SQUARE), 5e-3).unwrap();
    near(area(&mesh), 1e-2, 1e-12);
    let (angle, side) = quality(&mesh);
    println!(
        "square: {} triangles, least angle {angle:.1}, mean side {:.2} mm",
        mesh.quads.len(),
        1e3 * side
    );
    assert!(angle > 29.9 && side > 4e-3 && side < 5.5e-3, "{angle} {side}");
    assert_eq!(mesh.set("corners").unwrap().len(), 4);
    assert_eq!(mesh.set("outer").unwrap(), mesh.set("boundary").unwrap());
    assert_eq!(mesh.set_edges("outer").unwrap().len(), mesh.boundary_edges().len());
    assert!(mesh.set("inner").is_err());
    assert_eq!(mesh.set("all").unwrap().len(), mesh.nodes.len());
    // The same again, to the last bit.
    assert_eq!(mesh, of_dxf(Some(4), &polyline("0", &SQUARE), 5e-3).unwrap());
}

#[test]
fn units_are_those_of_the_file_or_of_the_case() {
    for (code, length) in [(1, 0.0254), (4, 1e-3), (5, 1e-2), (6, 1.0)] {
        let mesh = of_dxf(Some(code), &polyline("0", &SQUARE), 20.0 * length).unwrap();
        near(area(&mesh), 1e4 * length * length, 1e-12);
    }
    let none = refusal(of_dxf(None, &polyline("0", &SQUARE), 5e-3));
    assert!(none.contains("a.dxf: M021") && none.contains("give `unit`"), "{none}");
    let options = DrawingOptions { unit: Some(1e-3), layer: None };
    near(area(&read("a.DXF", &dxf(None, &polyline("0", &SQUARE)), &options, 5e-3).unwrap()), 1e-2, 1e-12);
    let two = refusal(read("a.dxf", &dxf(Some(1), &polyline("0", &SQUARE)), &options, 5e-3));
    assert!(two.contains("inches") && two.contains("remove `unit`"), "{two}");
    let odd = refusal(of_dxf(Some(18), &polyline("0", &SQUARE), 5e-3));
    assert!(odd.contains("AstronomicalUnits"), "{odd}");
    // 4 in² in each of these.
    let inch = 0.0254;
    for (page, shape) in [
        (
            "width=\"10in\" height=\"5in\" viewBox=\"0 0 10 5\"",
            "<rect x=\"1\" y=\"1\" width=\"2\" height=\"2\"/>",
        ),
        (
            "width=\"25.4cm\" height=\"12.7cm\" viewBox=\"0 0 10 5\"",
            "<rect x=\"1\" y=\"1\" width=\"2\" height=\"2\"/>",
        ),
        ("width=\"960px\" height=\"480px\"", "<rect x=\"96\" y=\"1in\" width=\"192\" height=\"50.8mm\"/>"),
        ("width=\"720pt\" height=\"360pt\" viewBox=\"0 0 720 360\"", "<path d=\"M72 72h144v144h-144z\"/>"),
    ] {
        near(area(&of_svg(page, shape, 0.3 * inch).unwrap()), 4.0 * inch * inch, 1e-9);
    }
    let pixels = refusal(of_svg("width=\"100\" height=\"100\"", "<rect width=\"9\" height=\"9\"/>", 1e-3));
    assert!(pixels.contains("a.svg: M021") && pixels.contains("give `unit`"), "{pixels}");
    let stretched = refusal(of_svg("width=\"10mm\" height=\"20mm\" viewBox=\"0 0 9 9\"", "<rect/>", 1e-3));
    assert!(stretched.contains("a.svg:1: M021") && stretched.contains("stretched"), "{stretched}");
}

/// Polygons of n chords have n sin(2π/n) / 2π of the area of a circle.
fn polygon(n: f64) -> f64 {
    n * (2.0 * PI / n).sin() / (2.0 * PI)
}

#[test]
fn curves_are_followed_by_chords() {
    let (cell, exact) = (5e-3, PI * 0.04 * 0.04);
    let n = (2.0 * PI * 8.0f64 - 0.25).ceil();
    let bulges = polyline("0", &[[-40.0, 0.0, 1.0], [40.0, 0.0, 1.0]]);
    let halves = 2.0 * (PI * 8.0 - 0.25).ceil();
    near(area(&of_dxf(Some(4), &bulges, cell).unwrap()), exact * polygon(halves), 1e-8);
    let circle = "0=CIRCLE;8=0;10=7;20=-3;30=0;40=40\n";
    near(area(&of_dxf(Some(4), circle, cell).unwrap()), exact * polygon(n), 1e-8);
    // Two arcs, one of them drawn by its angles across 0.
    let arcs = "0=ARC;8=0;10=0;20=0;30=0;40=40;50=270;51=90\n0=ARC;8=0;10=0;20=0;30=0;40=40;50=90;51=270\n";
    near(area(&of_dxf(Some(4), arcs, cell).unwrap()), exact * polygon(halves), 1e-8);
    let ellipse = "0=ELLIPSE;8=0;10=0;20=0;30=0;11=0;21=40;31=0;40=0.5;41=0;42=6.283185307179586\n";
    near(area(&of_dxf(Some(4), ellipse, 2e-3).unwrap()), 0.5 * exact, 5e-3);
    let mesh = of_svg(MM, "<circle cx=\"100\" cy=\"50\" r=\"40\"/>", cell).unwrap();
    near(area(&mesh), exact * polygon(n), 1e-8);
    assert!(mesh.set("corners").unwrap().is_empty());
    let [low, high] = mesh.bounds();
    near(0.5 * (low.x + high.x), 0.1, 1e-3);
    near(0.5 * (low.y + high.y), 0.05, 1e-3);
    let d = "<path d=\"M140 50a40 40 0 1 1-80 0A40 40 0 1 1 140 50\"/>";
    near(area(&of_svg(MM, d, cell).unwrap()), exact * polygon(halves), 1e-8);
    // A parabola over its chord has two thirds of its height.
    let d = "<path d=\"M20 90Q70-10 120 90\"/><line x1=\"120\" y1=\"90\" x2=\"20\" y2=\"90\"/>";
    near(area(&of_svg(MM, d, 1e-3).unwrap()), 1e-6 * 100.0 * 50.0 * 2.0 / 3.0, 1e-3);
    // The same one as a spline of degree 2 with a chord.
    let spline = "0=SPLINE;8=0;70=8;71=2;72=6;73=3;40=0;40=0;40=0;40=1;40=1;40=1;10=20;20=90;30=0;10=70;20=-10;30=0;10=120;20=90;30=0\n";
    let closed = format!("{spline}{}", line([120.0, 90.0], [20.0, 90.0]));
    near(area(&of_dxf(Some(4), &closed, 1e-3).unwrap()), 1e-6 * 100.0 * 50.0 * 2.0 / 3.0, 1e-3);
    // A small hole keeps 12 chords.
    let mesh =
        of_svg(MM, "<rect width=\"100\" height=\"90\"/><circle cx=\"50\" cy=\"50\" r=\"1\"/>", cell).unwrap();
    near(9e-3 - area(&mesh), 1e-6 * PI * polygon(12.0), 1e-6);
}

#[test]
fn a_rational_spline_is_a_quarter_of_a_circle() {
    let w = 0.5f64.sqrt();
    let spline = format!(
        "0=SPLINE;8=0;70=12;71=2;72=6;73=3;40=0;40=0;40=0;40=1;40=1;40=1;41=1;41={w};41=1;10=40;20=0;30=0;10=40;20=40;30=0;\
         10=0;20=40;30=0\n{}{}",
        line([0.0, 40.0], [0.0, 0.0]),
        line([0.0, 0.0], [40.0, 0.0])
    );
    let mesh = of_dxf(Some(4), &spline, 2e-3).unwrap();
    let rim = mesh.set("outer").unwrap().iter().map(|n| mesh.nodes[*n as usize].coords.norm());
    assert!(rim.fold(0.0, f64::max) < 0.04 * (1.0 + 1e-6));
    near(area(&mesh), 0.25 * PI * 1.6e-3, 2e-3);
    assert_eq!(mesh.set("corners").unwrap().len(), 3);
}

#[test]
fn chains_close_whichever_way_their_lines_run() {
    let [a, b, c] = [[0.0, 0.0], [60.0, 0.0], [60.0, 30.0]];
    let gap = [60.0, 0.0004];
    let mesh = of_dxf(Some(4), &(line(a, b) + &line(c, gap) + &line(a, c)), 5e-3).unwrap();
    near(area(&mesh), 9e-4, 1e-4);
    let open = refusal(of_dxf(Some(4), &(line(a, b) + &line(b, c)), 5e-3));
    assert!(open.contains("a.dxf:20: M021") && open.contains("(0, 0) of the file"), "{open}");
    let twice = refusal(of_dxf(Some(4), &(line(a, b) + &line(b, c) + &line(c, a) + &line(a, b)), 5e-3));
    assert!(twice.contains("(0, 0) of the file") && twice.contains("drawn twice"), "{twice}");
}

#[test]
fn transforms_of_svg_and_blocks_of_dxf_move_what_they_hold() {
    let turned = "<g transform=\"translate(100,50) rotate(30)\"><rect transform=\"scale(2,1) skewX(20)\" x=\"-10\" y=\"-10\" width=\"20\" height=\"20\"/></g>";
    let mesh = of_svg(MM, turned, 3e-3).unwrap();
    near(area(&mesh), 8e-4, 1e-9);
    let [low, high] = mesh.bounds();
    near(0.5 * (low.x + high.x), 0.1, 1e-6);
    // y points upwards from the lower edge of the page.
    let low_one = of_svg(MM, "<rect x=\"10\" y=\"80\" width=\"30\" height=\"10\" rx=\"2\"/>", 3e-3).unwrap();
    near(low_one.bounds()[0].y, 0.01, 1e-9);
    near(area(&low_one), 1e-6 * (300.0 - (4.0 - PI) * 4.0), 2e-3);
    let block = format!(
        "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nP\n70\n0\n10\n10\n20\n0\n30\n0\n{}0\nENDBLK\n8\n0\n0\nENDSEC\n",
        polyline("0", &SQUARE).replace([';', '='], "\n")
    );
    let insert = "0\nSECTION\n2\nENTITIES\n0\nINSERT\n8\nfront\n2\nP\n10\n5\n20\n5\n30\n0\n41\n2\n42\n0.5\n50\n90\n0\nENDSEC\n0\nEOF\n";
    let mesh = read("b.dxf", &(block.clone() + insert), &DrawingOptions::default(), 8e-3).unwrap();
    near(area(&mesh), 1e-2, 1e-9);
    near(mesh.bounds()[0].x, -0.045, 1e-9);
    near(mesh.bounds()[0].y, -0.015, 1e-9);
    assert_eq!(mesh.set("front").unwrap(), mesh.set("outer").unwrap());
    let missing =
        read("b.dxf", &(block + &insert.replace("\nP\n", "\nQ\n")), &DrawingOptions::default(), 8e-3);
    assert!(refusal(missing).contains("the block \"Q\", which is not there"));
}

#[test]
fn holes_layers_and_ids_are_sets() {
    let hole = "0=CIRCLE;8=eyelet;10=50;20=50;30=0;40=20\n";
    let text = dxf(
        Some(4),
        &(hole.to_string() + &polyline("cut", &SQUARE) + "0=TEXT;8=cut;10=1;20=1;30=0;40=3;1=front\n"),
    );
    let options = DrawingOptions::default();
    let mesh = read("a.dxf", &text, &options, 5e-3).unwrap();
    near(area(&mesh), 1e-2 - 4e-4 * PI * polygon((8.0 * PI - 0.25).ceil()), 1e-8);
    assert_eq!(mesh.set("eyelet").unwrap(), mesh.set("inner").unwrap());
    assert_eq!(mesh.set("cut").unwrap(), mesh.set("outer").unwrap());
    assert_eq!(mesh.set_edges("eyelet").unwrap().len(), mesh.set("eyelet").unwrap().len());
    let both = mesh.set("inner").unwrap().len() + mesh.set("outer").unwrap().len();
    assert_eq!(both, mesh.set("boundary").unwrap().len());
    // Each edge of a set runs with the sheet to its left.
    let edges = mesh.set_edges("boundary").unwrap();
    assert!(mesh.edge_sets["inner"].iter().all(|e| edges.contains(e)));
    let drawing = Drawing::parse(Path::new("a.dxf"), text.as_bytes(), &options).unwrap();
    let [text_left] = drawing.left_out() else { panic!("{:?}", drawing.left_out()) };
    assert_eq!((text_left.what.as_str(), text_left.count, text_left.place.line > 0), ("TEXT", 1, true));
    let cut = DrawingOptions { unit: None, layer: Some("cut") };
    near(area(&read("a.dxf", &text, &cut, 5e-3).unwrap()), 1e-2, 1e-12);
    let unknown = DrawingOptions { unit: None, layer: Some("front") };
    assert!(refusal(read("a.dxf", &text, &unknown, 5e-3)).contains("no lines of the name \"front\""));
    let two = "<g id=\"front\"><rect width=\"50\" height=\"50\"/><circle id=\"neck\" cx=\"25\" cy=\"25\" r=\"9\"/></g>\
               <rect id=\"back\" x=\"60\" width=\"50\" height=\"50\"/>\n<text>size 12</text>";
    let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {MM}>\n{two}</svg>");
    let several = refusal(read("a.svg", &svg, &options, 5e-3));
    assert!(
        several.contains("2 separate pieces") && several.contains("<rect id=\"back\"> (line 2"),
        "{several}"
    );
    let front = DrawingOptions { unit: None, layer: Some("front") };
    let mesh = read("a.svg", &svg, &front, 5e-3).unwrap();
    assert_eq!(mesh.set("neck").unwrap(), mesh.set("inner").unwrap());
    assert_eq!(mesh.set("front").unwrap(), mesh.set("boundary").unwrap());
}

#[test]
fn contours_that_cross_or_touch_are_told_with_coordinates() {
    let eight = polyline("0", &[[0.0, 0.0, 0.0], [100.0, 100.0, 0.0], [100.0, 0.0, 0.0], [0.0, 100.0, 0.0]]);
    let crossing = refusal(of_dxf(Some(4), &eight, 30e-3));
    assert!(crossing.contains("LWPOLYLINE (handle 2F) crosses or touches itself at (50"), "{crossing}");
    let hole = "0=CIRCLE;8=0;10=20;20=50;30=0;40=20\n";
    let touching = refusal(of_dxf(Some(4), &(polyline("0", &SQUARE) + hole), 5e-3));
    assert!(touching.contains("cross or touch at (0") && touching.contains(", 50"), "{touching}");
    let beside =
        refusal(of_dxf(Some(4), &(polyline("0", &SQUARE) + &hole.replace("10=20;", "10=-20;")), 5e-3));
    assert!(beside.contains("cross or touch"), "{beside}");
    // Holes between a circle and its chords, and across a chord.
    let middle = PI / 13.0;
    for (radius, distance) in [(0.2, 39.4), (0.5, 39.2)] {
        let (sin, cos) = middle.sin_cos();
        let hole = format!("0=CIRCLE;8=0;10={};20={};30=0;40={radius}\n", distance * cos, distance * sin);
        let circle = "0=CIRCLE;8=0;10=0;20=0;30=0;40=40\n";
        let chords = refusal(of_dxf(Some(4), &(circle.to_string() + &hole), 20e-3));
        assert!(chords.contains("give a smaller `cell`"), "{chords}");
        of_dxf(Some(4), &(circle.to_string() + &hole), 5e-3).unwrap();
    }
    let spike = [[0.0, 0.0], [50.0, 0.0], [80.0, 0.0], [50.0, 0.0], [20.0, 60.0]].map(|[x, y]| [x, y, 0.0]);
    let spike = refusal(of_dxf(Some(4), &polyline("0", &spike), 200e-3));
    assert!(
        spike.contains("crosses or touches itself at (") && spike.contains(", 0) of the file"),
        "{spike}"
    );
    let twice = polyline("0", &SQUARE) + &polyline("0", &SQUARE);
    assert!(refusal(of_dxf(Some(4), &twice, 50e-3)).contains("cross or touch"));
    let island =
        polyline("0", &SQUARE) + "0=CIRCLE;8=0;10=50;20=50;30=0;40=30\n0=CIRCLE;8=0;10=50;20=50;30=0;40=10\n";
    assert!(refusal(of_dxf(Some(4), &island, 5e-3)).contains("inside a hole"));
    let there_and_back = line([0.0, 0.0], [9.0, 0.0]) + &line([9.0, 0.0], [0.0, 0.0]);
    assert!(refusal(of_dxf(Some(4), &there_and_back, 50e-3)).contains("no area"));
}

#[test]
fn what_is_not_read_is_refused_with_its_line() {
    for (entity, what) in [
        ("0=REGION;5=3A;8=0\n", "REGION (handle 3A) is not read"),
        ("0=SHEEP;5=3A;8=0\n", "SHEEP (handle 3A) is not read"),
        ("0=CIRCLE;5=3A;8=0;10=0;20=0;30=0;40=-2\n", "CIRCLE (handle 3A): its radius"),
        ("0=CIRCLE;5=3A;8=0;10=2;20=2;30=0;40=1e-320\n", "CIRCLE (handle 3A)"),
        ("0=CIRCLE;5=3A;8=0;10=0;20=0;30=0;40=2;210=1;220=0;230=0\n", "no plane z = const"),
        ("0=SPLINE;5=3A;8=0;71=3;11=0;21=0;31=0\n", "no control points"),
        ("0=SPLINE;5=3A;8=0;71=3;40=0;10=0;20=0;30=0\n", "1 knots make no spline"),
        ("0=LINE;5=3A;8=0;10=0;20=0;30=7;11=1;21=0;31=7\n", "at z = 7"),
        ("0=LINE;5=3A;8=0;10=x;20=0;30=0;11=1;21=0;31=0\n", "cannot be read"),
    ] {
        let message = refusal(of_dxf(Some(4), &(polyline("0", &SQUARE) + entity), 5e-3));
        assert!(message.contains("M021") && message.contains(what), "{message}");
    }
    let line = refusal(of_dxf(Some(4), &(polyline("0", &SQUARE) + "0=REGION;5=3A;8=0\n"), 5e-3));
    assert!(line.starts_with("a.dxf:54: M021"), "{line}");
    for (shape, what) in [
        ("<use href=\"#a\"/>", "<use>: it is not read"),
        ("<rect width=\"50%\" height=\"1\"/>", "depends on a font or on the page"),
        ("<path d=\"M0 0L1 q\"/>", "its path cannot be read"),
        ("<path d=\"M0 0L10 0L10 10\"/>", "the contour is open: <path> ends at (0, 0)"),
        ("<g style=\"transform: scale(2)\"/>", "a transform of its style"),
        ("<style>.a{display:none}</style>", "its style sheet sets `display`"),
        ("<circle r=\"-1\"/>", "its radius is not positive"),
        ("<polygon points=\"0,0 1,a 3,3\"/>", "not all pairs of numbers"),
        ("<rect transform=\"turn(3)\"/>", "transform=\"turn(3)\""),
        ("<g><rect width=\"1\"", "cannot be read"),
        ("", "no lines and no curves"),
    ] {
        let message = refusal(of_svg(MM, shape, 5e-3));
        let lined = message.starts_with("a.svg:2: M021") || shape.is_empty() || shape.starts_with("<g><");
        assert!(lined && message.contains(what), "{message}");
    }
    let other = refusal(read("a.pdf", "", &DrawingOptions::default(), 1.0));
    assert!(other.contains(".dxf or .svg"), "{other}");
    let hidden =
        "<rect width=\"20\" height=\"20\"/><g style=\"display:none\"><rect width=\"90\" height=\"20\"/></g>";
    near(area(&of_svg(MM, hidden, 5e-3).unwrap()), 4e-4, 1e-9);
    let fine = refusal(of_dxf(Some(4), &polyline("0", &SQUARE), 1e-6));
    assert!(fine.contains("give a larger `cell`"), "{fine}");
    let many = refusal(of_dxf(Some(4), &polyline("0", &SQUARE), 5e-5));
    assert!(many.contains("give a larger `cell`"), "{many}");
}

/// Files that are cut, and files with other bytes in them: an error or a mesh, and no panic.
#[test]
fn damaged_files_are_refused_or_read() {
    let dxf =
        dxf(Some(4), &("0=CIRCLE;8=eyelet;10=50;20=50;30=0;40=20\n".to_string() + &polyline("cut", &SQUARE)));
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" {MM}><g transform=\"rotate(3)\"><path d=\"M9 9h50v60a4 4 0 0 1-9 9z\"/></g></svg>"
    );
    let mut state = 1u64;
    for (name, text) in [("a.dxf", dxf), ("a.svg", svg)] {
        let mut read = 0;
        for round in 0..3000 {
            let mut bytes = text.clone().into_bytes();
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let at = (state >> 33) as usize % bytes.len();
            match round % 3 {
                0 => bytes.truncate(at),
                1 => bytes[at] = b"0123456789-.eE \nzMaL\xff\0"[(state >> 20) as usize % 22],
                _ => drop(bytes.drain(at..(at + 3).min(text.len()))),
            }
            let options = DrawingOptions { unit: None, layer: None };
            let drawing = Drawing::parse(Path::new(name), &bytes, &options);
            read += usize::from(drawing.and_then(|d| d.mesh(0.02)).is_ok());
        }
        assert!(read > 100, "{name}: {read}");
    }
}
