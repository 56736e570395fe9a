//! Triangles among the quads: quads whose last two corners are one node.
//!
//! ```text
//!        3 = 4         [a, b, c, c]: whatever an element does at its third and at its fourth corner meets at node c.
//!        /   \         The side from 3 to 4 has no length, and is none of the element's sides.
//!       1 --- 2
//! ```

use nalgebra::{Point3, Vector3};

/// A triangle whose height is a smaller part of its longest side is refused: as flat as a quad of which one corner's Jacobian
/// is a thousandth of the mean.
pub(super) const FLAT: f64 = 1e-3;

/// The height of a triangle over its longest side; 0 if it has no size.
pub(super) fn height([a, b, c]: [Point3<f64>; 3]) -> f64 {
    let longest = [b - a, c - b, a - c].iter().map(Vector3::norm).fold(0.0, f64::max);
    let ratio = (b - a).cross(&(c - a)).norm() / (longest * longest);
    if ratio.is_finite() { ratio } else { 0.0 }
}

/// Whether a quad is a triangle `[a, b, c, c]`.
#[inline]
pub fn is_triangle(quad: &[u32; 4]) -> bool {
    quad[2] == quad[3]
}

/// The nodes of a quad, each once: three of a triangle.
pub fn nodes_of(quad: &[u32; 4]) -> &[u32] {
    &quad[..if is_triangle(quad) { 3 } else { 4 }]
}

/// The sides of a quad, each along it: three of a triangle.
pub fn sides_of(quad: &[u32; 4]) -> impl Iterator<Item = [u32; 2]> + Clone {
    let nodes = nodes_of(quad);
    (0..nodes.len()).map(move |i| [nodes[i], nodes[(i + 1) % nodes.len()]])
}

/// A quad with its normal to the other side.
pub(super) fn turned_over(quad: &[u32; 4]) -> [u32; 4] {
    let [a, b, c, d] = *quad;
    if is_triangle(quad) { [b, a, c, c] } else { [d, c, b, a] }
}

/// The triangle that a quad is if one of its sides has the same node at both ends, `[a, b, c, c]` in the order of its
/// corners; the quad itself if its corners are four nodes. `None` if they are less than three, or if opposite corners
/// are one node.
pub(super) fn collapsed<T: Copy + PartialEq>(quad: [T; 4]) -> Option<[T; 4]> {
    let [a, b, c, d] = quad;
    let same = [a == b, b == c, c == d, d == a];
    match (same.iter().filter(|same| **same).count(), a == c || b == d) {
        (0, false) => Some(quad),
        // The node after the repeated one comes first.
        (1, false) => same.iter().position(|same| *same).map(|k| {
            let mut turned = quad;
            turned.rotate_left((k + 2) % 4);
            [turned[0], turned[1], turned[2], turned[2]]
        }),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quad_with_a_node_twice_in_a_row_is_the_triangle_of_its_corners() {
        assert_eq!(collapsed([1, 2, 3, 4]), Some([1, 2, 3, 4]));
        for (quad, triangle) in [
            ([1, 1, 2, 3], [2, 3, 1, 1]),
            ([1, 2, 2, 3], [3, 1, 2, 2]),
            ([1, 2, 3, 3], [1, 2, 3, 3]),
            ([1, 2, 3, 1], [2, 3, 1, 1]),
        ] {
            assert_eq!(collapsed(quad), Some(triangle), "{quad:?}");
        }
        for quad in [[1, 2, 1, 3], [1, 2, 3, 2], [1, 1, 2, 2], [1, 1, 1, 2], [1, 1, 1, 1]] {
            assert_eq!(collapsed(quad), None, "{quad:?}");
        }
    }

    #[test]
    fn a_triangle_has_three_sides_whichever_side_is_up() {
        let triangle = [4, 5, 6, 6];
        assert_eq!(sides_of(&triangle).collect::<Vec<_>>(), [[4, 5], [5, 6], [6, 4]]);
        assert_eq!(sides_of(&turned_over(&triangle)).collect::<Vec<_>>(), [[5, 4], [4, 6], [6, 5]]);
        assert_eq!(sides_of(&[1, 2, 3, 4]).count(), 4);
        assert_eq!(turned_over(&[1, 2, 3, 4]), [4, 3, 2, 1]);
    }
}
