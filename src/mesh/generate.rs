//! Meshes of simple sheets: rectangle, disc, annulus; and seeded distortion.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Point3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::{MeshError, QuadMesh, sides_of};

fn sorted(mut nodes: Vec<u32>) -> Vec<u32> {
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

fn positive(what: &str, value: f64) -> Result<(), MeshError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(MeshError::Parameters { what: format!("{what} is {value} m: it must be a positive length") })
}

fn at_least(what: &str, count: usize, least: usize) -> Result<(), MeshError> {
    // Node numbers are 32-bit; 4096 x 4096 cells are far past the memory of any direct solve.
    if (least..=4096).contains(&count) {
        return Ok(());
    }
    Err(MeshError::Parameters { what: format!("{what} is {count}: it must be {least} to 4096") })
}

/// A rectangle `[0, width] x [0, height]` in z = 0 with `nx` by `ny` equal cells.
///
/// Nodes run along x first. Sets: `left` (x = 0), `right`, `bottom` (y = 0), `top`, `boundary`,
/// `corners`, `all`.
///
/// # Errors
/// M006 for a size that is not positive or a count of zero.
pub fn rectangle(width: f64, height: f64, nx: usize, ny: usize) -> Result<QuadMesh, MeshError> {
    positive("the width", width)?;
    positive("the height", height)?;
    at_least("the number of cells along x", nx, 1)?;
    at_least("the number of cells along y", ny, 1)?;
    let node = |i: usize, j: usize| (j * (nx + 1) + i) as u32;
    let nodes = (0..=ny)
        .flat_map(|j| {
            (0..=nx)
                .map(move |i| Point3::new(width * i as f64 / nx as f64, height * j as f64 / ny as f64, 0.0))
        })
        .collect();
    let quads = (0..ny)
        .flat_map(|j| (0..nx).map(move |i| [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]))
        .collect();
    let left: Vec<u32> = (0..=ny).map(|j| node(0, j)).collect();
    let right: Vec<u32> = (0..=ny).map(|j| node(nx, j)).collect();
    let bottom: Vec<u32> = (0..=nx).map(|i| node(i, 0)).collect();
    let top: Vec<u32> = (0..=nx).map(|i| node(i, ny)).collect();
    let node_sets = BTreeMap::from([
        ("boundary".to_string(), sorted([&left[..], &right, &bottom, &top].concat())),
        ("corners".to_string(), sorted(vec![node(0, 0), node(nx, 0), node(nx, ny), node(0, ny)])),
        ("all".to_string(), (0..((nx + 1) * (ny + 1)) as u32).collect()),
        ("left".to_string(), left),
        ("right".to_string(), right),
        ("bottom".to_string(), bottom),
        ("top".to_string(), top),
    ]);
    Ok(QuadMesh { nodes, quads, node_sets, ..QuadMesh::default() })
}

/// A ring `inner <= r <= outer` about the origin in z = 0: `radial` by `around` cells.
///
/// Sets: `inner`, `outer`, `boundary` (both), `all`.
///
/// # Errors
/// M006 unless `0 < inner < outer`, `radial >= 1` and `around >= 3`.
pub fn annulus(inner: f64, outer: f64, radial: usize, around: usize) -> Result<QuadMesh, MeshError> {
    graded_annulus(inner, outer, [radial, around], 1.0)
}

/// The same with cells that grow outwards as a geometric series, to `grading` times their width: `[radial, around]`
/// of them. Twice as many lie on the same circles and between them.
///
/// # Errors
/// Those of [`annulus`]; M006 for a grading that is not positive.
pub fn graded_annulus(
    inner: f64,
    outer: f64,
    [radial, around]: [usize; 2],
    grading: f64,
) -> Result<QuadMesh, MeshError> {
    if !(grading.is_finite() && grading > 0.0) {
        let what = format!(
            "the grading of the cells along the radius is {grading}: it must be a positive number, the size of the \
                            outermost cell over the innermost"
        );
        return Err(MeshError::Parameters { what });
    }
    positive("the inner radius", inner)?;
    positive("the width of the ring (outer - inner radius)", outer - inner)?;
    at_least("the number of cells along the radius", radial, 1)?;
    at_least("the number of cells around", around, 3)?;
    let node = |i: usize, k: usize| (i * around + k % around) as u32;
    let mut nodes = Vec::with_capacity((radial + 1) * around);
    for i in 0..=radial {
        let s = i as f64 / radial as f64;
        let part = if grading == 1.0 { s } else { (grading.powf(s) - 1.0) / (grading - 1.0) };
        let r = inner + (outer - inner) * part;
        for k in 0..around {
            let (s, c) = (TAU * k as f64 / around as f64).sin_cos();
            nodes.push(Point3::new(r * c, r * s, 0.0));
        }
    }
    let quads = (0..radial)
        .flat_map(|i| {
            (0..around).map(move |k| [node(i, k), node(i + 1, k), node(i + 1, k + 1), node(i, k + 1)])
        })
        .collect();
    let inner_set: Vec<u32> = (0..around as u32).collect();
    let outer_set: Vec<u32> = (0..around).map(|k| node(radial, k)).collect();
    let node_sets = BTreeMap::from([
        ("boundary".to_string(), sorted([&inner_set[..], &outer_set].concat())),
        ("all".to_string(), (0..nodes.len() as u32).collect()),
        ("inner".to_string(), inner_set),
        ("outer".to_string(), outer_set),
    ]);
    Ok(QuadMesh { nodes, quads, node_sets, ..QuadMesh::default() })
}

/// A disc about the origin in z = 0: a core of `cells` by `cells` quads with bulged sides, and
/// `cells / 2` rings of quads from it to the rim (at least one).
///
/// Sets: `outer` and `boundary` (the rim), `centre` (the middle node, for even `cells`), `all`.
///
/// # Errors
/// M006 for a radius that is not positive or no cells.
pub fn disc(radius: f64, cells: usize) -> Result<QuadMesh, MeshError> {
    positive("the radius", radius)?;
    at_least("the number of cells across the core", cells, 1)?;
    let (n, rings) = (cells, (cells / 2).max(1));
    // Core: the square of half side a with sides bulged a third of the way to the circle.
    let a = 0.5 * radius * std::f64::consts::FRAC_1_SQRT_2 * 1.1;
    let core = |u: f64, v: f64| {
        let bulge = 1.0 + 0.12 * (1.0 - u * u) * v * v + 0.12 * (1.0 - v * v) * u * u;
        Point3::new(a * u * bulge, a * v * bulge, 0.0)
    };
    let parameter = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
    let mut nodes: Vec<Point3<f64>> =
        (0..=n).flat_map(|j| (0..=n).map(move |i| core(parameter(i), parameter(j)))).collect();
    let core_node = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    let mut quads: Vec<[u32; 4]> = (0..n)
        .flat_map(|j| {
            (0..n).map(move |i| {
                [core_node(i, j), core_node(i + 1, j), core_node(i + 1, j + 1), core_node(i, j + 1)]
            })
        })
        .collect();
    // The rim of the core, counter-clockwise from its lower right corner (angle -45 degrees).
    let rim: Vec<u32> = (0..n)
        .map(|j| core_node(n, j))
        .chain((0..n).map(|i| core_node(n - i, n)))
        .chain((0..n).map(|j| core_node(0, n - j)))
        .chain((0..n).map(|i| core_node(i, 0)))
        .collect();
    let around = rim.len();
    let mut ring = rim.clone();
    for r in 1..=rings {
        let next: Vec<u32> = (0..around).map(|k| (nodes.len() + k) as u32).collect();
        for (k, &start) in rim.iter().enumerate() {
            let angle = -0.25 * PI + FRAC_PI_2 * k as f64 / n as f64;
            let on_circle = Point3::new(radius * angle.cos(), radius * angle.sin(), 0.0);
            let from = nodes[start as usize];
            nodes.push(from + (on_circle - from) * (r as f64 / rings as f64));
        }
        for k in 0..around {
            let l = (k + 1) % around;
            quads.push([ring[k], next[k], next[l], ring[l]]);
        }
        ring = next;
    }
    let outer = sorted(ring);
    let mut node_sets = BTreeMap::from([
        ("boundary".to_string(), outer.clone()),
        ("outer".to_string(), outer),
        ("all".to_string(), (0..nodes.len() as u32).collect()),
    ]);
    if n.is_multiple_of(2) {
        node_sets.insert("centre".to_string(), vec![core_node(n / 2, n / 2)]);
    }
    Ok(QuadMesh { nodes, quads, node_sets, ..QuadMesh::default() })
}

/// The mesh with its interior nodes moved in x and y by up to `amount` of half the shortest
/// edge at that node (0..0.5 keeps every quad convex), by a seeded generator.
///
/// # Errors
/// M006 unless `0 <= amount <= 0.5`, and for a sheet that is not in a plane z = const, which the nodes would leave.
pub fn distorted(mut mesh: QuadMesh, amount: f64, seed: u64) -> Result<QuadMesh, MeshError> {
    if !(0.0..=0.5).contains(&amount) {
        return Err(MeshError::Parameters { what: format!("distortion is {amount}: it must be 0 to 0.5") });
    }
    if amount > 0.0 && !mesh.is_level() {
        let what = format!(
            "distortion = {amount} moves nodes along x and y, off a sheet that is not in a plane z = const: leave it out"
        );
        return Err(MeshError::Parameters { what });
    }
    let mut shortest = vec![f64::INFINITY; mesh.nodes.len()];
    for quad in &mesh.quads {
        for [a, b] in sides_of(quad) {
            let (a, b) = (a as usize, b as usize);
            let length = (mesh.nodes[a] - mesh.nodes[b]).norm();
            shortest[a] = shortest[a].min(length);
            shortest[b] = shortest[b].min(length);
        }
    }
    let fixed: std::collections::HashSet<u32> = mesh.boundary_edges().into_iter().flatten().collect();
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    for (i, node) in mesh.nodes.iter_mut().enumerate() {
        let step = 0.5 * amount * shortest[i];
        let (dx, dy): (f64, f64) = (random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
        if !fixed.contains(&(i as u32)) {
            node.x += step * dx;
            node.y += step * dy;
        }
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn area(mesh: &QuadMesh) -> f64 {
        (0..mesh.quads.len())
            .map(|q| {
                let c = mesh.corners(q);
                0.5 * (c[2] - c[0]).cross(&(c[3] - c[1])).z
            })
            .sum()
    }

    #[test]
    fn areas_are_those_of_the_polygons() {
        assert_relative_eq!(area(&rectangle(0.2, 0.1, 7, 3).unwrap()), 0.02, max_relative = 1e-12);
        let ring = annulus(0.09, 0.15, 4, 64).unwrap();
        let polygon = 0.5 * 64.0 * (TAU / 64.0).sin();
        assert_relative_eq!(area(&ring), polygon * (0.15f64.powi(2) - 0.09f64.powi(2)), max_relative = 1e-12);
        // Graded: the same outline; a finer mesh has the circles of the coarser one.
        let [coarse, fine] = [[4, 64], [8, 64]].map(|cells| graded_annulus(0.09, 0.15, cells, 4.0).unwrap());
        assert_relative_eq!(area(&coarse), area(&ring), max_relative = 1e-12);
        let radius = |mesh: &QuadMesh, i: usize| mesh.nodes[64 * i].x;
        (0..5).for_each(|i| {
            assert_relative_eq!(radius(&coarse, i), radius(&fine, 2 * i), max_relative = 1e-14)
        });
        let width = |i: usize| radius(&fine, i + 1) - radius(&fine, i);
        assert_relative_eq!(width(7) / width(0), 4f64.powf(7.0 / 8.0), max_relative = 1e-12);
        let disc = disc(0.15, 8).unwrap();
        let polygon = 0.5 * 32.0 * (TAU / 32.0).sin();
        assert_relative_eq!(area(&disc), polygon * 0.15f64.powi(2), max_relative = 1e-12);
    }

    #[test]
    fn every_generated_mesh_passes_the_check_and_distortion_keeps_the_boundary() {
        for n in [1, 2, 5, 16] {
            disc(1.0, n).unwrap().check().unwrap();
        }
        annulus(1.0, 2.0, 1, 3).unwrap().check().unwrap();
        let plain = rectangle(1.0, 1.0, 8, 8).unwrap();
        let bent = distorted(plain.clone(), 0.5, 7).unwrap();
        bent.check().unwrap();
        assert_relative_eq!(area(&bent), 1.0, max_relative = 1e-12);
        assert_eq!(distorted(plain.clone(), 0.5, 7).unwrap(), bent, "seeded");
        for &n in plain.set("boundary").unwrap() {
            assert_eq!(plain.nodes[n as usize], bent.nodes[n as usize]);
        }
        assert_ne!(plain, bent);
    }

    #[test]
    fn senseless_sizes_are_refused() {
        assert!(rectangle(0.0, 1.0, 1, 1).is_err());
        assert!(rectangle(1.0, f64::NAN, 1, 1).is_err());
        assert!(rectangle(1.0, 1.0, 0, 1).is_err());
        assert!(annulus(2.0, 1.0, 1, 8).is_err());
        assert!(distorted(rectangle(1.0, 1.0, 2, 2).unwrap(), 0.6, 0).is_err());
        let mut roof = rectangle(1.0, 1.0, 2, 2).unwrap();
        roof.nodes.iter_mut().for_each(|n| n.z = 0.1 * n.x);
        assert_eq!(distorted(roof.clone(), 0.0, 0).unwrap(), roof);
        assert!(distorted(roof, 0.1, 0).unwrap_err().to_string().contains("z = const"));
    }
}
