//! Refined meshes: outline, sets and angles.

use super::*;
use crate::mesh::{annulus, disc, distorted, graded_annulus, is_triangle, rectangle, sides_of};
use approx::assert_relative_eq;

fn area(mesh: &QuadMesh) -> f64 {
    (0..mesh.quads.len())
        .map(|q| {
            let c = mesh.corners(q);
            0.5 * (c[2] - c[0]).cross(&(c[3] - c[1])).z
        })
        .sum()
}

/// The smallest angle between two sides (degrees).
fn least_angle(mesh: &QuadMesh) -> f64 {
    let mut least = f64::INFINITY;
    for quad in &mesh.quads {
        let nodes = nodes_of(quad);
        for i in 0..nodes.len() {
            let [before, at, after] =
                [nodes.len() - 1, 0, 1].map(|k| mesh.nodes[nodes[(i + k) % nodes.len()] as usize]);
            least = least.min((before - at).angle(&(after - at)));
        }
    }
    least.to_degrees()
}

/// No hanging nodes, no overlap, sets that are what they were: of the outline by its places.
fn assert_sound(refined: &Refined) {
    let mesh = &refined.mesh;
    mesh.check().unwrap();
    let mut uses: HashMap<[u32; 2], usize> = HashMap::new();
    mesh.quads.iter().flat_map(sides_of).for_each(|side| *uses.entry(key(side)).or_default() += 1);
    assert!(uses.values().all(|n| (1..=2).contains(n)));
    assert_eq!(mesh.unjoined(), None);
    let edge: BTreeSet<u32> = mesh.boundary_edges().into_iter().flatten().collect();
    assert_eq!(mesh.set("boundary").unwrap(), edge.into_iter().collect::<Vec<_>>());
    assert_eq!(mesh.set("all").unwrap().len(), mesh.nodes.len());
    assert_eq!(refined.cells.len(), mesh.quads.len());
    assert!(refined.cells.is_sorted());
}

/// The cells of which a corner is within a distance of a point.
fn about(refinement: &Refinement, point: Point3<f64>, distance: f64) -> BTreeSet<usize> {
    let near = |n: &u32| (refinement.nodes[*n as usize] - point).norm() <= distance;
    (0..refinement.cells.len()).filter(|cell| refinement.cells[*cell].iter().any(near)).collect()
}

#[test]
fn six_levels_about_a_corner_keep_outline_sets_and_angles() {
    for (size, cells) in [([1.0, 1.0], [4, 4]), ([2.0, 1.0], [2, 1]), ([1.0, 1.0], [1, 1])] {
        let [w, h] = size;
        let coarse = rectangle(w, h, cells[0], cells[1]).unwrap();
        let mut refinement = Refinement::new(&coarse, GridLines::Straight).unwrap();
        for level in 1..=6 {
            refinement.divide(about(&refinement, Point3::origin(), 1e-9));
            let refined = refinement.mesh();
            assert_sound(&refined);
            let mesh = &refined.mesh;
            assert_relative_eq!(area(mesh), w * h, max_relative = 1e-12);
            // That of a square from a corner to the middle of a side.
            assert!(least_angle(mesh) > 0.5f64.atan().to_degrees() - 1e-9);
            let shortest = mesh.quads.iter().flat_map(sides_of);
            let shortest = shortest.map(|[a, b]| (mesh.nodes[a as usize] - mesh.nodes[b as usize]).norm());
            let width = w / cells[0] as f64 / f64::from(1 << level);
            assert_relative_eq!(shortest.fold(f64::INFINITY, f64::min), width, max_relative = 1e-9);
            for (name, on) in [
                ("left", (|p, _| p.x == 0.0) as fn(&Point3<f64>, [f64; 2]) -> bool),
                ("right", |p, [w, _]| p.x == w),
                ("bottom", |p, _| p.y == 0.0),
                ("top", |p, [_, h]| p.y == h),
                ("corners", |p, [w, h]| (p.x == 0.0 || p.x == w) && (p.y == 0.0 || p.y == h)),
            ] {
                let expected: Vec<u32> =
                    (0..mesh.nodes.len() as u32).filter(|n| on(&mesh.nodes[*n as usize], size)).collect();
                assert_eq!(mesh.set(name).unwrap(), expected, "{name}, level {level}");
            }
            let length: f64 = mesh
                .set_edges("left")
                .unwrap()
                .iter()
                .map(|[a, b]| (mesh.nodes[*a as usize] - mesh.nodes[*b as usize]).norm())
                .sum();
            assert_relative_eq!(length, h, max_relative = 1e-12);
        }
        // What was a node stays one.
        assert_eq!(refinement.mesh().mesh.nodes[..coarse.nodes.len()], coarse.nodes);
    }
}

#[test]
fn dividing_every_cell_is_the_finer_mesh() {
    for (coarse, fine, lines) in [
        (rectangle(1.0, 2.0, 3, 2), rectangle(1.0, 2.0, 12, 8), GridLines::Straight),
        (annulus(1.0, 2.0, 2, 7), annulus(1.0, 2.0, 8, 28), GridLines::Rings),
    ] {
        let mut refinement = Refinement::new(&coarse.unwrap(), lines).unwrap();
        (0..2).for_each(|_| refinement.divide((0..refinement.cells.len()).collect()));
        let (found, fine) = (refinement.mesh(), fine.unwrap());
        assert_sound(&found);
        assert_eq!(found.mesh.triangles(), 0);
        assert_eq!(found.mesh.quads.len(), fine.quads.len());
        for (name, set) in &fine.node_sets {
            for node in set {
                let at = fine.nodes[*node as usize];
                let mut places = found.mesh.set(name).unwrap().iter().map(|n| found.mesh.nodes[*n as usize]);
                assert!(places.any(|place| (place - at).norm() < 1e-12), "{name}: {at}");
            }
            assert_eq!(set.len(), found.mesh.set(name).unwrap().len());
        }
    }
}

#[test]
fn round_outlines_stay_round() {
    for (coarse, lines, centre) in [
        (disc(1.0, 1), GridLines::RoundEdge, false),
        (disc(1.0, 2), GridLines::RoundEdge, true),
        (disc(1.0, 5), GridLines::RoundEdge, false),
        (annulus(0.5, 1.0, 2, 3), GridLines::Rings, false),
        (annulus(0.5, 1.0, 12, 8), GridLines::Rings, false),
        (graded_annulus(0.6, 1.0, [3, 24], 5.0), GridLines::Rings, false),
        (distorted(annulus(0.5, 1.0, 4, 24).unwrap(), 0.4, 3), GridLines::Rings, false),
    ] {
        let coarse = coarse.unwrap();
        let mut least = f64::INFINITY;
        let mut refinement = Refinement::new(&coarse, lines).unwrap();
        let rim = coarse.nodes[coarse.set("outer").unwrap()[0] as usize];
        for level in 0..11 {
            refinement.divide(about(&refinement, rim, 1e-9));
            let refined = refinement.mesh();
            assert_sound(&refined);
            let mesh = &refined.mesh;
            for node in mesh.set("outer").unwrap() {
                assert_relative_eq!(mesh.nodes[*node as usize].coords.norm(), 1.0, max_relative = 1e-12);
            }
            // Sides become straight, and cells with that parallelograms, which are all alike: by half of what is left a level.
            let found = least_angle(mesh);
            println!("{level}: {} elements, {found:.1} degrees", mesh.quads.len());
            least = if level < 9 { least.min(found) } else { least };
            assert!(found > 0.95 * least && found > 1.0);
            assert_eq!(mesh.node_sets.contains_key("centre"), centre);
            assert!(!centre || mesh.set("centre") == coarse.set("centre"));
        }
    }
}

/// Cells, elements and triangles of nine squares of which some are divided.
fn elements(cells: &[usize]) -> [usize; 3] {
    let mut refinement = Refinement::new(&rectangle(3.0, 3.0, 3, 3).unwrap(), GridLines::Straight).unwrap();
    refinement.divide(cells.iter().copied().collect());
    let refined = refinement.mesh();
    assert_sound(&refined);
    assert_relative_eq!(area(&refined.mesh), 9.0, max_relative = 1e-12);
    [refinement.cells.len(), refined.mesh.quads.len(), refined.mesh.triangles()]
}

/// By hand: a cell with one, two and three finer neighbours; the last is divided itself.
#[test]
fn cells_beside_finer_ones_are_closed() {
    // In a corner: two neighbours have a triangle each.
    assert_eq!(elements(&[0]), [12, 14, 2]);
    // The cell in the middle has two sides in a row, the two neighbours at the boundary one each.
    assert_eq!(elements(&[1, 3]), [15, 4 + 4 + 3 + 3 + 4 + 3, 2]);
    // Opposite ones.
    assert_eq!(elements(&[3, 5]), [15, 8 + 2 + 4 * 2 + 2, 4]);
    // Three: the one between is divided too.
    assert_eq!(elements(&[1, 3, 5])[0], 5 + 4 * 4);
}

#[test]
fn the_largest_parts_are_divided_and_their_equals() {
    let mut refinement = Refinement::new(&rectangle(4.0, 1.0, 4, 1).unwrap(), GridLines::Straight).unwrap();
    let refined = refinement.mesh();
    refinement.divide_largest(&refined, &[4.0, 1.0, 1.0, 4.0 + 1e-9], 0.3);
    assert_eq!(refinement.cells.len(), 2 * 4 + 2);
    let refined = refinement.mesh();
    assert_eq!(refined.cells, [0, 1, 2, 3, 4, 4, 5, 5, 6, 7, 8, 9]);
    // Both elements of the fifth cell together are the largest.
    let mut parts = [1.0; 12];
    (parts[4], parts[5]) = (1.0, 1.5);
    refinement.divide_largest(&refined, &parts, 0.1);
    assert!(refinement.mesh().mesh.quads.iter().filter(|q| is_triangle(q)).count() < 3);
    assert_eq!(refinement.cells.len(), 13);
}

#[test]
fn lines_inside_are_kept_and_triangles_refused() {
    let mut mesh = rectangle(2.0, 2.0, 2, 2).unwrap();
    mesh.node_sets.insert("seam".into(), vec![1, 4, 7]);
    mesh.edge_sets.insert("seam".into(), vec![[1, 4], [4, 7]]);
    let mut refinement = Refinement::new(&mesh, GridLines::Straight).unwrap();
    refinement.divide(BTreeSet::from([0]));
    let refined = refinement.mesh();
    assert_sound(&refined);
    let edges = refined.mesh.set_edges("seam").unwrap();
    assert_eq!((edges.len(), edges[0][0], edges[0][1], edges[2]), (3, 1, edges[1][0], [4, 7]));
    assert_eq!(refined.mesh.set("seam").unwrap().len(), 4);
    mesh.quads = vec![[0, 1, 4, 4]];
    assert!(Refinement::new(&mesh, GridLines::Straight).unwrap_err().to_string().contains("triangles"));
}
