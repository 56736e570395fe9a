use super::*;
use crate::mesh::rectangle;
use approx::assert_relative_eq;

/// Random numbers that are the same always, from -1 to 1.
fn noise(k: usize) -> f64 {
    2.0 * ((k as f64 + 1.0) * 0.754_877_666).fract() - 1.0
}

fn triangle() -> [Point3<f64>; 3] {
    [[0.1, 0.0, 0.02], [1.1, 0.2, -0.1], [0.3, 0.9, 0.05]].map(Point3::from)
}

/// Within the triangle, beside two of its sides, and beyond a corner.
const POINTS: [[f64; 3]; 4] = [[0.4, 0.4, 0.3], [0.7, -0.2, 0.1], [0.9, 0.9, -0.2], [-0.4, -0.3, 0.2]];

/// The distance of a point that goes with four nodes, from the places of all seven nodes.
fn distance(places: &[Point3<f64>; NODES], weights: &[f64; 4]) -> Distance {
    let [a, b, c, d, e, f, g] = places;
    let point = Point3::from(
        [a, b, c, d].iter().zip(weights).fold(Vector3::zeros(), |sum, (p, w)| sum + p.coords * *w),
    );
    Distance::of(&point, weights, &[*e, *f, *g])
}

#[test]
fn distances_and_their_derivatives_agree_with_differences() {
    let weights = [0.5, 0.2, 0.2, 0.1];
    for point in POINTS.map(Point3::from) {
        let off = |k: usize| Vector3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2)) * 0.1;
        let mean = (0..4).fold(Vector3::zeros(), |sum, k| sum + off(k) * weights[k]);
        let [e, f, g] = triangle();
        let [a, b, c, d] = std::array::from_fn(|k| point + off(k) - mean);
        let places = [a, b, c, d, e, f, g];
        let here = distance(&places, &weights);
        let brute = (0..=200).flat_map(|i| (0..=200 - i).map(move |j| (i as f64 / 200.0, j as f64 / 200.0)));
        let least = brute
            .map(|(u, v)| (point - (e + (f - e) * u + (g - e) * v)).norm())
            .fold(f64::INFINITY, f64::min);
        assert!(here.value <= least && here.value > least - 1e-3, "{} {least}", here.value);
        let h = 1e-6;
        for (j, axis) in (0..NODES).flat_map(|j| (0..3).map(move |axis| (j, axis))) {
            let displaced = [h, -h].map(|h| {
                let mut places = places;
                places[j][axis] += h;
                distance(&places, &weights)
            });
            let [more, less] = &displaced;
            let slope = (more.value - less.value) / (2.0 * h);
            assert_relative_eq!(slope, here.normal[axis] * here.weights[j], epsilon = 1e-8);
            for i in 0..NODES {
                let bend = (more.normal * more.weights[i] - less.normal * less.weights[i]) / (2.0 * h);
                assert_relative_eq!(bend, here.curvature(i, j).column(axis).into_owned(), epsilon = 1e-6);
            }
        }
    }
}

/// Nothing is let through, and what does not come nearer is not held up.
#[test]
fn a_way_ends_before_the_triangle() {
    let [a, b, c] = triangle();
    let still = Vector3::zeros();
    for point in POINTS.map(Point3::from) {
        let before = Distance::of(&point, &[1.0, 0.0, 0.0, 0.0], &[a, b, c]).value;
        let through = (Point3::from((a.coords + b.coords + c.coords) / 3.0) - point) * 2.0;
        let part = safe_part(&[point, a, b, c], &[through, still, still, still], 0.1);
        let after = Distance::of(&(point + through * part), &[1.0, 0.0, 0.0, 0.0], &[a, b, c]).value;
        assert!(part < 0.5 && after >= 0.0999 * before && after < 0.2 * before, "{part} {after} {before}");
        let together = safe_part(&[point, a, b, c], &[through; 4], 0.1);
        assert_relative_eq!(together, 1.0);
        assert_relative_eq!(safe_part(&[point, a, b, c], &[-through, still, still, still], 0.1), 1.0);
    }
}

/// Whichever node a triangle has twice, its points are the same and a pressure is shared alike by its nodes.
#[test]
fn points_of_triangles_do_not_depend_on_the_first_node() {
    let nodes: Vec<Point3<f64>> = triangle().into();
    for quad in [[0, 1, 2, 2], [1, 2, 0, 0], [2, 0, 1, 1]] {
        let mesh = QuadMesh { nodes: nodes.clone(), quads: vec![quad], ..QuadMesh::default() };
        let (points, of_quads) = samples(&mesh, &[0.6]);
        let mut share = [0.0; 3];
        for point in &points {
            quad.iter().zip(point.weights).for_each(|(n, w)| share[*n as usize] += w * point.area);
        }
        assert_eq!((points.len(), of_quads[0][2]), (7, of_quads[0][3]));
        share.iter().for_each(|s| assert_relative_eq!(*s, 0.2, max_relative = 1e-12));
    }
}

/// Two flat layers on each other: the pressure of the barrier over their common area, whatever the mesh.
#[test]
fn flat_layers_press_each_other_by_the_barrier() {
    let (thickness, load) = (1e-3, 2.0);
    for (cells, shift) in [(4, 0.0), (7, 0.3)] {
        let lower = rectangle(0.1, 0.1, 4, 4).unwrap();
        let upper = rectangle(0.1, 0.1, cells, cells).unwrap();
        let mut mesh = lower.clone();
        let first = mesh.nodes.len() as u32;
        // The other layer is beside the first at rest, and brought over it.
        mesh.nodes.extend(upper.nodes.iter().map(|p| p + Vector3::new(1.0, 0.0, 0.0)));
        mesh.quads.extend(upper.quads.iter().map(|quad| quad.map(|n| n + first)));
        let height = thickness * (1.0 - YIELDING);
        let places: Vec<Point3<f64>> = (lower.nodes.iter().copied())
            .chain(upper.nodes.iter().map(|p| p + Vector3::new(shift * 0.01, 0.0, height)))
            .collect();
        let areas: Vec<f64> = (0..mesh.quads.len())
            .map(|q| if q < 16 { 0.01 / 16.0 } else { 0.01 / (cells * cells) as f64 })
            .collect();
        let layers = Layers::new(&mesh, &areas, [thickness, load], Path::Auto);
        let contacts = layers.contacts(&places);
        let mut force = Vector3::zeros();
        for contact in &contacts {
            for (i, node) in contact.nodes.iter().enumerate() {
                if *node >= first {
                    force += contact.force(i);
                }
            }
        }
        // -b'(0.8 t) of κ = load/(0.12 t), and what hangs over the edge.
        let pressure = load / 0.12 * (0.04 / 0.8 + 0.4 * 0.8f64.ln().abs());
        assert_relative_eq!(force.z, pressure * 0.01, max_relative = 0.02 + shift * 0.1);
        assert!(force.x.abs() < 0.02 * force.z && layers.contacts(&mesh.nodes).is_empty());
        let down: Vec<Vector3<f64>> = (0..places.len())
            .map(|n| Vector3::new(0.0, 0.0, if n < first as usize { 0.0 } else { -0.01 }))
            .collect();
        let part = layers.free_part(&places, &down);
        assert!(part * 0.01 < height && part * 0.01 > 0.85 * height, "{part}");
    }
}
