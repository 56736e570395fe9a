//! The triangle among the elements: a quad whose last two corners are one node, `[a, b, c, c]`.
//!
//! The bilinear shape functions of such a quad are the area coordinates of the triangle, `λ1 = N1`, `λ2 = N2` and
//! `λ3 = N3 + N4`: whatever is made of them alone (strain smoothing, masses, loads) is that of the linear triangle once both
//! copies of c are added up, and 2 x 2 points integrate polynomials of second degree over it exactly. What is not made of them
//! alone is here: the transverse shear, which is tied at the middles of the three sides (MITC3: Lee and Bathe, *Comput.
//! Struct.* 82 (2004) 945), its stabilisation, and what the sides add to strains and loads. Of the two copies of c these
//! use the first.

use nalgebra::{Matrix2, Matrix3, SMatrix, Vector2};

use super::quad4::shape;

/// Corners in the plane.
type Corners = [[f64; 2]; 4];

/// The ends of the three sides.
pub(super) const SIDES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The vector along a side (m).
fn along(xy: &Corners, [i, j]: [usize; 2]) -> Vector2<f64> {
    Vector2::new(xy[j][0] - xy[i][0], xy[j][1] - xy[i][1])
}

/// The area coordinates at a point in natural coordinates of the quad.
fn area_coordinates([xi, eta]: [f64; 2]) -> [f64; 3] {
    let [first, second, third, again] = shape(xi, eta);
    [first, second, third + again]
}

/// The gradients of the area coordinates (1/m).
fn gradients(xy: &Corners) -> [Vector2<f64>; 3] {
    let doubled = along(xy, [0, 1]).perp(&along(xy, [0, 2]));
    [[1, 2], [2, 0], [0, 1]].map(|opposite| {
        let side = along(xy, opposite);
        Vector2::new(-side.y, side.x) / doubled
    })
}

/// The shear strains (2 x 12) at a point in natural coordinates of the quad, dofs `(w, θx, θy)` node by node:
///
/// ```text
/// γ = Σ_sides g_ij (λ_i ∇λ_j - λ_j ∇λ_i)      g_ij = w_j - w_i + ½ s_ij·(β_i + β_j)      β = (θy, -θx)
/// ```
///
/// The field of MITC3, written with the edge functions of Whitney: `γ·s` of each side is constant along it. Its mean over the
/// triangle is the strain of CS-DSG3 (Nguyen-Thoi et al., *Int. J. Numer. Methods Eng.* 91 (2012) 705); alone that mean would
/// leave the element a motion without energy, the rotations `β = e3 × x`.
pub(super) fn tied_shear(xy: &Corners, natural: [f64; 2]) -> SMatrix<f64, 2, 12> {
    let (at, gradient) = (area_coordinates(natural), gradients(xy));
    let mut b = SMatrix::<f64, 2, 12>::zeros();
    for [i, j] in SIDES {
        let form = gradient[j] * at[i] - gradient[i] * at[j];
        let half = 0.5 * along(xy, [i, j]);
        for (node, sign) in [(i, -1.0), (j, 1.0)] {
            for (dof, factor) in [sign, -half.y, half.x].into_iter().enumerate() {
                let mut column = b.column_mut(3 * node + dof);
                column += form * factor;
            }
        }
    }
    b
}

/// The same of the linear displacements themselves, which lock: for comparison only.
pub(super) fn compatible_shear(xy: &Corners, natural: [f64; 2]) -> SMatrix<f64, 2, 12> {
    let (at, gradient) = (area_coordinates(natural), gradients(xy));
    let mut b = SMatrix::<f64, 2, 12>::zeros();
    for i in 0..3 {
        (b[(0, 3 * i)], b[(0, 3 * i + 2)]) = (gradient[i].x, at[i]);
        (b[(1, 3 * i)], b[(1, 3 * i + 1)]) = (gradient[i].y, -at[i]);
    }
    b
}

/// What stands for the `Σ s sᵀ` of a quad's [`sides`](super::shear::sides) in the stabilisation of the transverse shear (m²):
/// half of that of the three sides, which has the trace of the square that two triangles make.
pub(super) fn metric(xy: &Corners) -> Matrix2<f64> {
    SIDES.iter().map(|side| along(xy, *side)).map(|s| s * s.transpose()).sum::<Matrix2<f64>>() * 0.5
}

/// The stabilisation α of a triangle for that of quads.
///
/// Quads need it for the digits of very thin sheets, triangles against locking: their sides are as many as there are dofs, and a
/// thin sheet without it bends along straight lines of the mesh alone. With seven times the α of quads, 0.35 by default, pressed
/// squares of 2 x 16 x 16 triangles are within 1.0 % of the series, clamped or simply supported, whichever way their diagonals
/// run; with as much as quads they are up to 5.0 % too stiff. The seven was chosen on these squares (`tests/mechanics/triangles.rs`). More makes them too soft, and so the larger α of
/// [`Formulation::fourth_order`](super::Formulation) is not for them.
pub(super) fn stabilisation(of_quads: f64) -> f64 {
    (7.0 * of_quads).min(0.35)
}

/// The strains `(ε_x, ε_y, γ_xy)` that make the sides 1-2, 1-3, 2-3 as long as they are, each for a strain `1` of `h·ε·h`
/// with half the side as `h`: columns.
pub(super) fn strains_of_sides(xy: &Corners) -> Matrix3<f64> {
    let rows = [[0, 1], [0, 2], [1, 2]].map(|side| {
        let h = 0.5 * along(xy, side);
        [h.x * h.x, h.y * h.y, h.x * h.y]
    });
    // A triangle with an area has three sides of different directions.
    Matrix3::from_fn(|i, j| rows[i][j]).try_inverse().unwrap_or_else(Matrix3::zeros)
}

/// A matrix over three dofs a corner with both copies of the third corner as one.
pub(super) fn merged(mut k: SMatrix<f64, 12, 12>) -> SMatrix<f64, 12, 12> {
    let columns = k.fixed_columns::<3>(6) + k.fixed_columns::<3>(9);
    k.fixed_columns_mut::<3>(6).copy_from(&columns);
    k.fixed_columns_mut::<3>(9).fill(0.0);
    let rows = k.fixed_rows::<3>(6) + k.fixed_rows::<3>(9);
    k.fixed_rows_mut::<3>(6).copy_from(&rows);
    k.fixed_rows_mut::<3>(9).fill(0.0);
    k
}
