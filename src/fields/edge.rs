//! Moments along supported edges, from the reactions.

use nalgebra::Vector3;

use crate::mesh::QuadMesh;

/// Bending moment about each edge at its two ends (N·m/m = N; positive stretches the +z face), from the
/// nodal reactions of a solution (six a node), edge by edge as given.
///
/// Nodal reaction moments are the moment per length m weighed with the shape functions of the edges,
/// `r_i = ∫ N_i m ds`, so m is the linear function along the edges with `Σ_j ∫ N_i N_j ds m_j = r_i`
/// (consistent recovery of boundary fluxes: Carey, *Comput. Methods Appl. Mech. Eng.* 35 (1982) 1). It is
/// second order up to the edge, where averages of element values are first order.
///
/// Edges must run counter-clockwise about the sheet, as [`QuadMesh::boundary_edges`] gives them, and hold
/// the rotation about themselves; where several edges meet at a corner, ask for each straight part alone.
pub fn edge_moments(mesh: &QuadMesh, reaction: &[f64], edges: &[[u32; 2]]) -> Vec<[f64; 2]> {
    let mut nodes: Vec<u32> = edges.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    // Every end of an edge is in the list that was made of the edges.
    let place = |n: u32| nodes.binary_search(&n).unwrap_or(0);
    let sides: Vec<(usize, usize, Vector3<f64>)> = edges
        .iter()
        .map(|[a, b]| (place(*a), place(*b), mesh.nodes[*b as usize] - mesh.nodes[*a as usize]))
        .collect();
    let right: Vec<Vector3<f64>> =
        nodes.iter().map(|n| Vector3::from_column_slice(&reaction[6 * *n as usize + 3..][..3])).collect();
    let moment = per_length(&sides, right);
    sides.iter().map(|(a, b, side)| [*a, *b].map(|n| moment[n].dot(&side.normalize()))).collect()
}

/// Solves `Σ_j ∫ N_i N_j ds m_j = r_i` by conjugate gradients, preconditioned with the row sums: the
/// condition number is then below 4 whatever the edges, and forty rounds reach rounding.
fn per_length(sides: &[(usize, usize, Vector3<f64>)], right: Vec<Vector3<f64>>) -> Vec<Vector3<f64>> {
    let mut lumped = vec![0.0; right.len()];
    for (a, b, side) in sides {
        lumped[*a] += 0.5 * side.norm();
        lumped[*b] += 0.5 * side.norm();
    }
    let times = |x: &[Vector3<f64>]| {
        let mut y = vec![Vector3::zeros(); x.len()];
        for (a, b, side) in sides {
            let sixth = side.norm() / 6.0;
            y[*a] += (2.0 * x[*a] + x[*b]) * sixth;
            y[*b] += (x[*a] + 2.0 * x[*b]) * sixth;
        }
        y
    };
    let dot = |a: &[Vector3<f64>], b: &[Vector3<f64>]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    let precondition =
        |r: &[Vector3<f64>]| -> Vec<Vector3<f64>> { r.iter().zip(&lumped).map(|(r, l)| r / *l).collect() };
    let mut x = vec![Vector3::zeros(); right.len()];
    let mut r = right;
    let mut z = precondition(&r);
    let mut p = z.clone();
    let start = dot(&r, &z);
    let mut rz = start;
    for _ in 0..40 {
        if rz <= 1e-30 * start {
            break;
        }
        let ap = times(&p);
        let step = rz / dot(&p, &ap);
        x.iter_mut().zip(&p).for_each(|(x, p)| *x += p * step);
        r.iter_mut().zip(&ap).for_each(|(r, ap)| *r -= ap * step);
        z = precondition(&r);
        let next = dot(&r, &z);
        p = z.iter().zip(&p).map(|(z, p)| z + p * (next / rz)).collect();
        rz = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;
    use approx::assert_relative_eq;

    /// Forces made from a linear moment are turned back into it, on sides of unequal length.
    #[test]
    fn a_linear_moment_is_recovered() {
        let mut mesh = rectangle(1.0, 3.0, 2, 4).unwrap();
        mesh.nodes.iter_mut().for_each(|p| p.y *= p.y);
        let moment = |y: f64| 2.0 - 0.3 * y;
        let edges = mesh.set_edges("left").unwrap();
        let mut reaction = vec![0.0; 6 * mesh.nodes.len()];
        for [a, b] in &edges {
            let (ya, yb) = (mesh.nodes[*a as usize].y, mesh.nodes[*b as usize].y);
            let sixth = (yb - ya).abs() / 6.0;
            // On x = 0 the edges run downwards: M_x is minus the moment about y.
            reaction[6 * *a as usize + 4] -= sixth * (2.0 * moment(ya) + moment(yb));
            reaction[6 * *b as usize + 4] -= sixth * (moment(ya) + 2.0 * moment(yb));
        }
        for (edge, found) in edges.iter().zip(edge_moments(&mesh, &reaction, &edges)) {
            for (node, value) in edge.iter().zip(found) {
                assert_relative_eq!(value, moment(mesh.nodes[*node as usize].y), max_relative = 1e-12);
            }
        }
    }
}
