//! Large rotations around the linear element: the element-independent corotational formulation
//! (Rankin and Brogan 1986; Nour-Omid and Rankin 1991; Felippa and Haugen 2005).
//!
//! A frame follows the element, so that what is left of the nodal motion in it is small strain;
//! the linear element acts on that. Rigid motions of any size are free, rotations of the nodes
//! may be of any size, and only the rotation of a node against its element must stay below π.
//! Rotations are orthogonal matrices, their increments spatial spins: `R <- exp(δω) R`.
//!
//! [`Motion`] is geometry alone: the law of the element enters as a local force and a local
//! stiffness, in the axes of the frame, dofs `(u, v, w, θx, θy, θz)` node by node.

use nalgebra::{Matrix3, Point3, Rotation3, SMatrix, UnitQuaternion, Vector3};

use super::prepared::{Matrix24, Vector24};
use super::quad4::Frame;
use super::transposed::add_with_transpose;

type Matrix24x3 = SMatrix<f64, 24, 3>;
type Matrix3x24 = SMatrix<f64, 3, 24>;

/// Where the element rests: its axes and its corners in them.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceFrame {
    axes: Matrix3<f64>,
    corners: [Vector3<f64>; 4],
}

impl ReferenceFrame {
    /// The rest position of a frame.
    pub fn of(frame: &Frame) -> Self {
        Self { axes: frame.rotation, corners: corners(frame) }
    }
}

fn corners(frame: &Frame) -> [Vector3<f64>; 4] {
    [0, 1, 2, 3].map(|i| Vector3::new(frame.xy[i][0], frame.xy[i][1], frame.z[i]))
}

/// An element in motion: its frame, its deformation, and the maps between the two.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Displacements and rotations against the frame: what strains the element (m, rad).
    pub deformation: Vector24,
    /// Rows are the axes of the frame.
    axes: Matrix3<f64>,
    /// Corners in the frame.
    corners: [Vector3<f64>; 4],
    /// Spin of each node against the frame to the rate of its rotation vector.
    h: [Matrix3<f64>; 4],
    /// Local displacements to the spin of the frame.
    g: Matrix3x24,
}

impl Motion {
    /// The motion that brings an element from rest to corners `x` with nodal rotations `r`.
    pub fn of(reference: &ReferenceFrame, x: &[Point3<f64>; 4], r: &[UnitQuaternion<f64>; 4]) -> Self {
        let frame = Frame::of(x);
        let (axes, corners) = (frame.rotation, corners(&frame));
        let mut deformation = Vector24::zeros();
        let mut h = [Matrix3::zeros(); 4];
        for i in 0..4 {
            let turned = axes * r[i].to_rotation_matrix().matrix() * reference.axes.transpose();
            let theta = rotation_vector(&turned);
            deformation.fixed_rows_mut::<3>(6 * i).copy_from(&(corners[i] - reference.corners[i]));
            deformation.fixed_rows_mut::<3>(6 * i + 3).copy_from(&theta);
            h[i] = spin_to_rate(&theta);
        }
        Self { deformation, axes, corners, h, g: frame_spin(&corners) }
    }

    /// The largest rotation of a node against the frame (rad).
    pub fn largest_rotation(&self) -> f64 {
        (0..4).map(|i| self.deformation.fixed_rows::<3>(6 * i + 3).norm()).fold(0.0, f64::max)
    }

    /// Nodal forces and moments, global axes, of the local force that is conjugate to the
    /// deformation.
    pub fn force(&self, local: &Vector24) -> Vector24 {
        let f = self.with_h(local);
        self.to_global(&(f - self.g.transpose() * (self.s().transpose() * f)))
    }

    /// The change of the deformation with nodal displacements and spins, to first order and up to a
    /// translation of the element, which strains nothing.
    pub fn deformation_rate(&self, spins: &Vector24) -> Vector24 {
        let mut rate = Vector24::zeros();
        for b in 0..8 {
            rate.fixed_rows_mut::<3>(3 * b).copy_from(&(self.axes * spins.fixed_rows::<3>(3 * b)));
        }
        rate -= self.s() * (self.g * rate);
        for i in 0..4 {
            let spin: Vector3<f64> = rate.fixed_rows::<3>(6 * i + 3).into();
            rate.fixed_rows_mut::<3>(6 * i + 3).copy_from(&(self.h[i] * spin));
        }
        rate
    }

    /// Tangent stiffness for a symmetric local stiffness and a local force, global axes: symmetric, and without the
    /// change of the frame's own gradient, neither of which costs Newton's method an iteration.
    pub fn tangent(&self, stiffness: &Matrix24, local: &Vector24) -> Matrix24 {
        // The symmetric part of `tangent_in_frame`, as K' + Z G + (Z G)ᵀ: most of a search goes into it, and S and G are
        // sparse.
        let mut k = *stiffness;
        self.stiffness_for_spins(&mut k, local, true);
        let f = self.with_h(local);
        let moment = self.moment(&f);
        let balanced = f - self.g.tr_mul(&moment);
        let mut rigid = self.of_rigid_rotation(&k);
        let whole = self.moments(&rigid);
        let mut levers = Matrix3::zeros();
        for (i, x) in self.corners.iter().enumerate() {
            let force = f.fixed_rows::<3>(6 * i);
            levers += Matrix3::identity() * x.dot(&force) - x * force.transpose();
        }
        // `levers` is the product of the levers of tangent_in_frame with S, `whole` that of Sᵀ K S.
        let inner = 0.5 * (levers + levers.transpose()) - 0.5 * (whole + whole.transpose());
        for i in 0..4 {
            for at in [6 * i, 6 * i + 3] {
                let mut part = skew(&balanced.fixed_rows::<3>(at).into());
                if at == 6 * i {
                    part += skew(&f.fixed_rows::<3>(at).into());
                }
                let mut rows = rigid.fixed_rows_mut::<3>(at);
                rows += 0.5 * part;
            }
        }
        let z = -rigid - 0.5 * self.g.tr_mul(&inner);
        // A column of G has one entry for a displacement in the plane, two for one across it, none for a rotation.
        let mut products = SMatrix::<f64, 24, 12>::zeros();
        for i in 0..4 {
            for (d, rows) in [(0, 2..3), (1, 2..3), (2, 0..2)] {
                let mut product = products.column_mut(3 * i + d);
                rows.for_each(|row| product.axpy(self.g[(row, 6 * i + d)], &z.column(row), 1.0));
            }
        }
        add_with_transpose(&mut k, &products, |c| 6 * (c / 3) + c % 3);
        let t = self.axes.transpose();
        for (i, j) in (0..8).flat_map(|i| (0..=i).map(move |j| (3 * i, 3 * j))) {
            let block = t * k.fixed_view::<3, 3>(i, j) * self.axes;
            k.fixed_view_mut::<3, 3>(i, j).copy_from(&block);
            if i > j {
                k.fixed_view_mut::<3, 3>(j, i).copy_from(&block.transpose());
            }
        }
        k
    }

    /// The derivative of [`force`](Self::force) with respect to spatial displacements and spins:
    /// not symmetric. For checks.
    pub fn exact_tangent(&self, stiffness: &Matrix24, local: &Vector24) -> Matrix24 {
        let moment = self.s().transpose() * self.with_h(local);
        let change = self.frame_spin_change(&moment);
        let k = self.tangent_in_frame(stiffness, local) - change + (change * self.s()) * self.g;
        self.matrix_to_global(&k)
    }

    /// `Pᵀ (Hᵀ K H + L) P - F_nm G - Gᵀ F_nᵀ P`, with `P = I - S G`.
    fn tangent_in_frame(&self, stiffness: &Matrix24, local: &Vector24) -> Matrix24 {
        let mut k = *stiffness;
        self.stiffness_for_spins(&mut k, local, false);
        let (s, f) = (self.s(), self.with_h(local));
        let balanced = f - self.g.transpose() * (s.transpose() * f);
        let mut turned = Matrix24x3::zeros();
        let mut levers = Matrix3x24::zeros();
        for i in 0..4 {
            for at in [6 * i, 6 * i + 3] {
                turned.fixed_rows_mut::<3>(at).copy_from(&skew(&balanced.fixed_rows::<3>(at).into()));
            }
            levers.fixed_columns_mut::<3>(6 * i).copy_from(&skew(&f.fixed_rows::<3>(6 * i).into()));
        }
        // All products with G on one side: K - (K S + F_nm) G + Gᵀ (F_n' P - Sᵀ K P).
        let projected = levers - s.transpose() * k;
        let projected = projected - (projected * s) * self.g;
        k - (k * s + turned) * self.g + self.g.transpose() * projected
    }

    /// `Hᵀ K H + L`, or with the symmetric part of `L`, in the place of `K`.
    fn stiffness_for_spins(&self, k: &mut Matrix24, local: &Vector24, symmetric: bool) {
        for i in 0..4 {
            let at = 6 * i + 3;
            let columns = k.fixed_columns::<3>(at) * self.h[i];
            k.fixed_columns_mut::<3>(at).copy_from(&columns);
        }
        for (i, h) in self.h.iter().enumerate() {
            let (at, h) = (6 * i + 3, h.transpose());
            for b in 0..8 {
                let mut block = k.fixed_view_mut::<3, 3>(at, 3 * b);
                let rows = h * block.clone_owned();
                block.copy_from(&rows);
            }
            let theta = self.deformation.fixed_rows::<3>(at).into();
            let change = transpose_change(&theta, &local.fixed_rows::<3>(at).into()) * self.h[i];
            let mut block = k.fixed_view_mut::<3, 3>(at, at);
            block += if symmetric { 0.5 * (change + change.transpose()) } else { change };
        }
    }

    /// `K S`.
    fn of_rigid_rotation(&self, k: &Matrix24) -> Matrix24x3 {
        let mut product = Matrix24x3::zeros();
        for (i, x) in self.corners.iter().enumerate() {
            for c in 0..3 {
                let (next, last) = ((c + 1) % 3, (c + 2) % 3);
                let mut column = product.column_mut(c);
                column += k.column(6 * i + 3 + c);
                // e_c × x, on the displacements.
                column.axpy(-x[last], &k.column(6 * i + next), 1.0);
                column.axpy(x[next], &k.column(6 * i + last), 1.0);
            }
        }
        product
    }

    /// `Sᵀ f`: the moment of local forces about the origin of the frame.
    fn moment(&self, f: &Vector24) -> Vector3<f64> {
        let mut moment = Vector3::zeros();
        for (i, x) in self.corners.iter().enumerate() {
            let (force, own) = (f.fixed_rows::<3>(6 * i), f.fixed_rows::<3>(6 * i + 3));
            moment += x.cross(&force) + own;
        }
        moment
    }

    /// [`moment`](Self::moment) of each column.
    fn moments(&self, forces: &Matrix24x3) -> Matrix3<f64> {
        let [a, b, c] = [0, 1, 2].map(|column| self.moment(&forces.column(column).into()));
        Matrix3::from_columns(&[a, b, c])
    }

    /// Derivative of `Gᵀ m` with respect to the corners in the frame.
    fn frame_spin_change(&self, m: &Vector3<f64>) -> Matrix24 {
        let (a, b, doubled) = diagonals(&self.corners);
        // Rates of 1/2A with a and b; of y/(x² + y²) and x/(x² + y²).
        let (area_a, area_b) = (Vector3::new(b.y, -b.x, 0.0), Vector3::new(-a.y, a.x, 0.0));
        let plane = |d: &Vector3<f64>| {
            let n = d.norm_squared();
            let (same, mixed) = ((d.x * d.x - d.y * d.y) / (n * n), 2.0 * d.x * d.y / (n * n));
            Matrix3::new(mixed, -same, 0.0, -same, -mixed, 0.0, 0.0, 0.0, 0.0) * (0.5 * m.z)
        };
        let across = |d: &Vector3<f64>| m.x * d.x + m.y * d.y;
        let in_plane = Vector3::new(m.x, m.y, 0.0);
        // Blocks of (∂/∂a, ∂/∂b) of the parts of Gᵀ m on a and on b.
        let (mut aa, mut ab) = (plane(&a), Matrix3::zeros());
        let (mut ba, mut bb) = (Matrix3::zeros(), plane(&b));
        let over = doubled * doubled;
        aa.set_row(2, &(area_a * (across(&b) / over)).transpose());
        ab.set_row(2, &(area_b * (across(&b) / over) - in_plane / doubled).transpose());
        ba.set_row(2, &(in_plane / doubled - area_a * (across(&a) / over)).transpose());
        bb.set_row(2, &(-area_b * (across(&a) / over)).transpose());
        let mut change = Matrix24::zeros();
        // a = x3 - x1, b = x4 - x2.
        const ENDS: [(usize, usize, f64); 4] = [(0, 0, -1.0), (1, 1, -1.0), (2, 0, 1.0), (3, 1, 1.0)];
        for (i, p, sign) in ENDS {
            for (j, q, other) in ENDS {
                let block = [[aa, ab], [ba, bb]][p][q] * (sign * other);
                change.fixed_view_mut::<3, 3>(6 * i, 6 * j).copy_from(&block);
            }
        }
        change
    }

    /// `Hᵀ f`.
    fn with_h(&self, local: &Vector24) -> Vector24 {
        let mut f = *local;
        for i in 0..4 {
            let moment: Vector3<f64> = local.fixed_rows::<3>(6 * i + 3).into();
            f.fixed_rows_mut::<3>(6 * i + 3).copy_from(&(self.h[i].transpose() * moment));
        }
        f
    }

    /// `S`: the spin of the frame to the local displacements of a rigid rotation.
    fn s(&self) -> Matrix24x3 {
        let mut s = Matrix24x3::zeros();
        for (i, x) in self.corners.iter().enumerate() {
            s.fixed_rows_mut::<3>(6 * i).copy_from(&-skew(x));
            s.fixed_rows_mut::<3>(6 * i + 3).copy_from(&Matrix3::identity());
        }
        s
    }

    fn to_global(&self, f: &Vector24) -> Vector24 {
        let mut global = Vector24::zeros();
        for b in 0..8 {
            let part = self.axes.transpose() * f.fixed_rows::<3>(3 * b);
            global.fixed_rows_mut::<3>(3 * b).copy_from(&part);
        }
        global
    }

    fn matrix_to_global(&self, k: &Matrix24) -> Matrix24 {
        let (t, mut global) = (self.axes.transpose(), Matrix24::zeros());
        for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (3 * i, 3 * j))) {
            let block = t * k.fixed_view::<3, 3>(i, j) * self.axes;
            global.fixed_view_mut::<3, 3>(i, j).copy_from(&block);
        }
        global
    }
}

/// Diagonals 1-3 and 2-4 in the frame, and twice the area.
fn diagonals(x: &[Vector3<f64>; 4]) -> (Vector3<f64>, Vector3<f64>, f64) {
    let (a, b) = (x[2] - x[0], x[3] - x[1]);
    (a, b, a.x * b.y - a.y * b.x)
}

/// `G`: both diagonals lie in the plane of the frame, and `e1` bisects them.
fn frame_spin(x: &[Vector3<f64>; 4]) -> Matrix3x24 {
    let (a, b, doubled) = diagonals(x);
    let mut g = Matrix3x24::zeros();
    let part = |own: &Vector3<f64>, other: &Vector3<f64>, sign: f64| {
        let n = 2.0 * own.norm_squared();
        Matrix3::new(
            0.0,
            0.0,
            -sign * other.x / doubled,
            0.0,
            0.0,
            -sign * other.y / doubled,
            -own.y / n,
            own.x / n,
            0.0,
        )
    };
    let (on_a, on_b) = (part(&a, &b, 1.0), part(&b, &a, -1.0));
    for (node, block) in [(0, -on_a), (1, -on_b), (2, on_a), (3, on_b)] {
        g.fixed_columns_mut::<3>(6 * node).copy_from(&block);
    }
    g
}

/// The matrix of `v ×`.
fn skew(v: &Vector3<f64>) -> Matrix3<f64> {
    v.cross_matrix()
}

/// The rotation vector of an orthogonal matrix, up to π; accurate for small and large angles.
fn rotation_vector(r: &Matrix3<f64>) -> Vector3<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*r)).scaled_axis()
}

/// Below this angle the closed forms of η and μ lose digits to cancellation.
const SMALL_ANGLE: f64 = 0.05;

/// `η = (1 - θ/2 cot θ/2) / θ²` and `μ = dη/dθ / θ`.
fn eta_mu(angle: f64) -> (f64, f64) {
    let squared = angle * angle;
    if angle < SMALL_ANGLE {
        let eta = 1.0 / 12.0 + squared * (1.0 / 720.0 + squared * (1.0 / 30240.0 + squared / 1_209_600.0));
        let mu = 1.0 / 360.0 + squared * (1.0 / 7560.0 + squared * (1.0 / 201_600.0 + squared / 5_987_520.0));
        return (eta, mu);
    }
    let half_sine = (0.5 * angle).sin();
    let eta = (1.0 - 0.5 * angle / (0.5 * angle).tan()) / squared;
    let mu = (squared + 4.0 * angle.cos() + angle * angle.sin() - 4.0)
        / (4.0 * squared * squared * half_sine * half_sine);
    (eta, mu)
}

/// `H(θ)`: a spin to the rate of the rotation vector θ.
fn spin_to_rate(theta: &Vector3<f64>) -> Matrix3<f64> {
    let (s, eta) = (skew(theta), eta_mu(theta.norm()).0);
    Matrix3::identity() - 0.5 * s + eta * s * s
}

/// Derivative of `H(θ)ᵀ m` with respect to θ.
fn transpose_change(theta: &Vector3<f64>, m: &Vector3<f64>) -> Matrix3<f64> {
    let (eta, mu) = eta_mu(theta.norm());
    let s = skew(theta);
    let change = Matrix3::identity() * theta.dot(m) + theta * m.transpose() - 2.0 * m * theta.transpose();
    eta * change + mu * (s * s * m) * theta.transpose() - 0.5 * skew(m)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    /// The tangent that is used takes every shortcut; the formula takes none.
    #[test]
    fn the_tangent_is_the_symmetric_part_of_the_formula() {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        let mut number = |_: usize, _: usize| random.random_range(-1.0..1.0);
        for size in [0.0, 0.1, 0.8] {
            let at = [[0.0, 0.0], [2.0, 0.3], [2.2, 1.4], [-0.2, 1.1]];
            let corner = |i: usize, z: f64| Point3::new(at[i][0], at[i][1], z);
            let rest = Frame::of(&[0, 1, 2, 3].map(|i| corner(i, 0.0)));
            let x = [0, 1, 2, 3].map(|i| corner(i, size * number(0, 0)));
            let turn = [0, 1, 2, 3].map(|_| Vector3::from_fn(&mut number) * size);
            let motion =
                Motion::of(&ReferenceFrame::of(&rest), &x, &turn.map(UnitQuaternion::from_scaled_axis));
            let any = Matrix24::from_fn(&mut number);
            let (stiffness, local) = (any + any.transpose(), Vector24::from_fn(&mut number));
            let formula = motion.tangent_in_frame(&stiffness, &local);
            let formula = motion.matrix_to_global(&(0.5 * (formula + formula.transpose())));
            assert_relative_eq!(
                motion.tangent(&stiffness, &local),
                formula,
                max_relative = 1e-12,
                epsilon = 1e-12
            );
        }
    }
}
