//! Triangles between the contours of a piece.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

use kurbo::{Affine, Point};
use nalgebra::Point3;
use spade::{AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation};

use super::checks::{Piece, distance};
use super::division::Polygon;
use super::reading::refused;
use crate::finding::Place;
use crate::mesh::{MeshError, QuadMesh};

/// Most triangles of a piece.
const MOST: f64 = 2e6;
/// No side of a grid of points inside comes nearer to a chord than this part of a cell.
const APART: f64 = 0.6;
/// The angles that are asked for, in degrees, one after the other where the ones before cannot be had: sharp corners
/// of a drawing stay as they are.
const ANGLES: [f64; 4] = [30.0, 25.0, 15.0, 0.0];

/// Nodes and triangles.
type Filled = (Vec<Point2<f64>>, Vec<[usize; 3]>);
type Constrained = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// The triangles of a piece with sides of about `cell`, with its sets; all in the plane z = 0.
pub(super) fn filled(
    path: &Path,
    piece: &Piece,
    cell: f64,
    to_metres: Affine,
) -> Result<QuadMesh, MeshError> {
    let contours = oriented(&piece.contours, to_metres);
    let cell = cell * to_metres.determinant().abs().sqrt();
    let area: f64 = contours.iter().map(Polygon::area).sum();
    let about = area / (0.25 * 3f64.sqrt() * cell * cell);
    if about > MOST {
        let message = format!(
            "a piece of {area:.3e} m² in cells of {cell:.3e} m would have {about:.1e} triangles: give a larger `cell`"
        );
        return Err(refused(Place::file(path), message));
    }
    let mut points: Vec<Point> = contours.iter().flat_map(|c| c.points.iter().copied()).collect();
    let (mut edges, mut first) = (Vec::new(), 0);
    for contour in &contours {
        let count = contour.points.len();
        edges.extend((0..count).map(|k| [first + k, first + (k + 1) % count]));
        first += count;
    }
    points.extend(inside(&contours, cell));
    let points: Vec<Point2<f64>> = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let filled = refined(&points, &edges, cell, about).map_err(|why| refused(Place::file(path), why))?;
    Ok(named(&contours, filled))
}

/// The contours in metres, the outer one counter-clockwise and the holes clockwise: the piece is to the left.
fn oriented(contours: &[Polygon], to_metres: Affine) -> Vec<Polygon> {
    let mut contours = contours.to_vec();
    for (k, contour) in contours.iter_mut().enumerate() {
        contour.points.iter_mut().for_each(|p| *p = to_metres * *p);
        if (contour.area() > 0.0) != (k == 0) {
            contour.points.reverse();
            contour.corners.reverse();
            // The chord that began at a point ends there now.
            contour.names.reverse();
            contour.names.rotate_left(1);
        }
    }
    contours
}

/// The points of a grid of equal triangles that lie well inside.
fn inside(contours: &[Polygon], cell: f64) -> Vec<Point> {
    let outer = &contours[0].points;
    let (mut low, mut high) = (outer[0], outer[0]);
    for p in outer {
        low = Point::new(low.x.min(p.x), low.y.min(p.y));
        high = Point::new(high.x.max(p.x), high.y.max(p.y));
    }
    // Chords by the cell of a coarse grid in which they begin, for they are hardly longer than one.
    let mut chords: HashMap<[i64; 2], Vec<[Point; 2]>> = HashMap::new();
    for chord in contours.iter().flat_map(|c| (0..c.points.len()).map(|k| c.chord(k))) {
        chords.entry(bucket(chord[0], cell)).or_default().push(chord);
    }
    let rise = 0.5 * 3f64.sqrt() * cell;
    let rows = ((high.y - low.y) / rise).floor() as usize;
    // As far from the lowest edge as from the highest.
    let base = low.y + 0.5 * ((high.y - low.y) - rise * rows as f64);
    let mut points = Vec::new();
    for (row, crossings) in crossings(contours, base, rise, rows).iter().enumerate() {
        let y = base + rise * row as f64;
        let start = low.x + if row % 2 == 0 { 0.0 } else { 0.5 * cell };
        for [left, right] in crossings.chunks_exact(2).map(|w| [w[0], w[1]]) {
            let from = ((left - start) / cell).ceil() as i64;
            let to = ((right - start) / cell).floor() as i64;
            let row = (from..=to).map(|column| Point::new(start + cell * column as f64, y));
            points.extend(row.filter(|p| is_apart(&chords, *p, cell)));
        }
    }
    points
}

/// Where contours cross each of the lines y = base, base + rise and so on, from left to right.
fn crossings(contours: &[Polygon], base: f64, rise: f64, rows: usize) -> Vec<Vec<f64>> {
    let mut crossings = vec![Vec::new(); rows + 1];
    for [a, b] in contours.iter().flat_map(|c| (0..c.points.len()).map(|k| c.chord(k))) {
        let first = ((a.y.min(b.y) - base) / rise).floor().max(0.0) as usize;
        let last = (((a.y.max(b.y) - base) / rise).ceil().max(0.0) as usize).min(rows);
        for (row, crossed) in crossings.iter_mut().enumerate().take(last + 1).skip(first) {
            let y = base + rise * row as f64;
            if (a.y > y) != (b.y > y) {
                crossed.push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
            }
        }
    }
    crossings.iter_mut().for_each(|c| c.sort_by(f64::total_cmp));
    crossings
}

fn bucket(p: Point, cell: f64) -> [i64; 2] {
    [p.x, p.y].map(|x| (x / (2.0 * cell)).floor() as i64)
}

fn is_apart(chords: &HashMap<[i64; 2], Vec<[Point; 2]>>, p: Point, cell: f64) -> bool {
    let [i, j] = bucket(p, cell);
    let near = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
    near.filter_map(|b| chords.get(&b)).flatten().all(|chord| distance(p, chord) >= APART * cell)
}

/// Nodes, the given points first, and triangles, counter-clockwise.
fn refined(points: &[Point2<f64>], edges: &[[usize; 2]], cell: f64, about: f64) -> Result<Filled, String> {
    // Equal triangles have 0.433 of the square of their sides; those at an edge may be half as large again.
    let largest = 0.65 * cell * cell;
    let most = 20 * (about as usize + points.len()) + 1000;
    for angle in ANGLES {
        let mut crossed = false;
        let mut cdt = Constrained::try_bulk_load_cdt(points.to_vec(), edges.to_vec(), |_| crossed = true)
            .map_err(|e| e.to_string())?;
        if crossed {
            return Err("sides of its contours cross, or are too short for the numbers of the drawing".into());
        }
        let parameters = RefinementParameters::new()
            .exclude_outer_faces(true)
            .with_angle_limit(AngleLimit::from_deg(angle))
            .with_max_allowed_area(largest)
            .with_max_additional_vertices(most);
        let result = cdt.refine(parameters);
        let outside: HashSet<_> = result.excluded_faces.into_iter().collect();
        let nodes = cdt.vertices().map(|v| v.position()).collect();
        let triangles = (cdt.inner_faces())
            .filter(|f| !outside.contains(&f.fix()))
            .map(|f| f.vertices().map(|v| v.fix().index()))
            .collect();
        if result.refinement_complete {
            return Ok((nodes, triangles));
        }
    }
    Err("no triangles of this `cell` come to an end between its contours: give a smaller `cell`, or draw its narrow places wider".into())
}

/// The mesh with its sets.
fn named(contours: &[Polygon], (nodes, triangles): Filled) -> QuadMesh {
    // A point outside that no triangle has is no node.
    let mut number = vec![u32::MAX; nodes.len()];
    let mut used = vec![false; nodes.len()];
    triangles.iter().flatten().for_each(|n| used[*n] = true);
    let mut mesh = QuadMesh::default();
    for (k, p) in nodes.iter().enumerate().filter(|(k, _)| used[*k]) {
        number[k] = mesh.nodes.len() as u32;
        mesh.nodes.push(Point3::new(p.x, p.y, 0.0));
    }
    mesh.quads = triangles.iter().map(|t| t.map(|n| number[n])).map(|[a, b, c]| [a, b, c, c]).collect();
    let boundary = mesh.boundary_edges();
    let next: HashMap<u32, u32> = boundary.iter().map(|[a, b]| (*a, *b)).collect();
    let mut edges: BTreeMap<String, Vec<[u32; 2]>> = BTreeMap::new();
    let mut corners = Vec::new();
    let mut first = 0;
    for (which, contour) in contours.iter().enumerate() {
        let count = contour.points.len();
        for (k, names) in contour.names.iter().enumerate() {
            let (from, to) = (number[first + k], number[first + (k + 1) % count]);
            if contour.corners[k] {
                corners.push(from);
            }
            let ours = if which == 0 { "outer" } else { "inner" };
            // The file's own name counts where it is one of ours.
            let ours = (!is_named(contours, ours)).then(|| ours.to_string());
            let mut at = from;
            // A chord may have been divided.
            while let Some(on) = (at != to).then(|| next.get(&at)).flatten() {
                for name in names.iter().chain(&ours) {
                    edges.entry(name.clone()).or_default().push([at, *on]);
                }
                at = *on;
            }
        }
        first += count;
    }
    corners.sort_unstable();
    mesh.node_sets.insert("corners".into(), corners);
    let all = (0..mesh.nodes.len() as u32).collect();
    mesh.node_sets.insert("all".into(), all);
    mesh.node_sets.insert("boundary".into(), nodes_of_edges(&boundary));
    for (name, edges) in edges {
        mesh.node_sets.insert(name.clone(), nodes_of_edges(&edges));
        mesh.edge_sets.insert(name, edges);
    }
    mesh
}

fn is_named(contours: &[Polygon], name: &str) -> bool {
    contours.iter().flat_map(|c| &c.names).flatten().any(|n| n == name)
}

fn nodes_of_edges(edges: &[[u32; 2]]) -> Vec<u32> {
    let mut nodes: Vec<u32> = edges.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
