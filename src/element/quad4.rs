//! Bilinear shape functions, Gauss points and the local frame.

use nalgebra::{Matrix3, Point3, Vector3};

/// `N_i(ξ, η)` in node order 1..4.
pub fn shape(xi: f64, eta: f64) -> [f64; 4] {
    [
        0.25 * (1.0 - xi) * (1.0 - eta),
        0.25 * (1.0 + xi) * (1.0 - eta),
        0.25 * (1.0 + xi) * (1.0 + eta),
        0.25 * (1.0 - xi) * (1.0 + eta),
    ]
}

const G: f64 = 0.577_350_269_189_625_8;

/// The 2 x 2 Gauss points (weights 1).
pub const GAUSS_2X2: [[f64; 2]; 4] = [[-G, -G], [G, -G], [G, G], [-G, G]];

/// Natural coordinates of the middle of a quad whose last two corners are one.
pub(super) const MIDDLE_OF_TRIANGLE: [f64; 2] = [0.0, -1.0 / 3.0];

/// Shape functions and geometry at a point of a plane quad.
#[derive(Clone, Copy, Debug)]
pub struct GaussPoint {
    /// `N_i`.
    pub n: [f64; 4],
    /// `N_i,ξ`.
    pub n_xi: [f64; 4],
    /// `N_i,η`.
    pub n_eta: [f64; 4],
    /// Inverse of `J = [x,ξ y,ξ; x,η y,η]`, row by row.
    pub j_inverse: [[f64; 2]; 2],
    /// `det J`: area per unit natural area.
    pub det: f64,
}

/// Shape functions and Jacobian at `(xi, eta)` of the plane quad `xy`.
pub fn gauss_point(xy: &[[f64; 2]; 4], [xi, eta]: [f64; 2]) -> GaussPoint {
    let n_xi = [-0.25 * (1.0 - eta), 0.25 * (1.0 - eta), 0.25 * (1.0 + eta), -0.25 * (1.0 + eta)];
    let n_eta = [-0.25 * (1.0 - xi), -0.25 * (1.0 + xi), 0.25 * (1.0 + xi), 0.25 * (1.0 - xi)];
    let sum = |d: &[f64; 4], axis: usize| (0..4).map(|i| d[i] * xy[i][axis]).sum::<f64>();
    let (x_xi, y_xi, x_eta, y_eta) = (sum(&n_xi, 0), sum(&n_xi, 1), sum(&n_eta, 0), sum(&n_eta, 1));
    let det = x_xi * y_eta - y_xi * x_eta;
    let j_inverse = [[y_eta / det, -y_xi / det], [-x_eta / det, x_xi / det]];
    GaussPoint { n: shape(xi, eta), n_xi, n_eta, j_inverse, det }
}

impl GaussPoint {
    /// `(N_i,x, N_i,y)`.
    pub fn gradient(&self, i: usize) -> [f64; 2] {
        let j = &self.j_inverse;
        [j[0][0] * self.n_xi[i] + j[0][1] * self.n_eta[i], j[1][0] * self.n_xi[i] + j[1][1] * self.n_eta[i]]
    }
}

/// The plane of an element and its corners in it.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Rows are the local axes e1, e2, e3: `local = rotation * global`.
    pub rotation: Matrix3<f64>,
    /// In-plane coordinates of the corners about the centre (m).
    pub xy: [[f64; 2]; 4],
    /// Distance of each corner from the plane (m): +h, -h, +h, -h for a warped quad.
    pub z: [f64; 4],
}

impl Frame {
    /// The frame of four corners in space: e3 normal to the diagonals, e1 their bisector, so that
    /// renumbering the nodes turns it by right angles only.
    pub fn of(corners: &[Point3<f64>; 4]) -> Self {
        let (d13, d24) = (corners[2] - corners[0], corners[3] - corners[1]);
        let e3 = d13.cross(&d24).normalize();
        let e1 = (d13.normalize() - d24.normalize()).normalize();
        let e2 = e3.cross(&e1);
        Self::with_axes(corners, Matrix3::from_rows(&[e1.transpose(), e2.transpose(), e3.transpose()]))
    }

    /// The global axes as frame, for sheets in a plane z = const.
    pub fn global(corners: &[Point3<f64>; 4]) -> Self {
        Self::with_axes(corners, Matrix3::identity())
    }

    fn with_axes(corners: &[Point3<f64>; 4], rotation: Matrix3<f64>) -> Self {
        let centre: Vector3<f64> = corners.iter().map(|c| c.coords).sum::<Vector3<f64>>() / 4.0;
        let local = corners.map(|c| rotation * (c.coords - centre));
        Self { rotation, xy: local.map(|p| [p.x, p.y]), z: local.map(|p| p.z) }
    }

    /// Whether the third corner is the fourth too.
    pub fn is_triangle(&self) -> bool {
        self.xy[2] == self.xy[3] && self.z[2] == self.z[3]
    }

    /// Natural coordinates of the middle of the element.
    pub fn middle(&self) -> [f64; 2] {
        if self.is_triangle() { MIDDLE_OF_TRIANGLE } else { [0.0, 0.0] }
    }

    /// Area of the plane quad (m²).
    pub fn area(&self) -> f64 {
        let [a, b, c, d] = self.xy;
        0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0]))
    }

    /// Longest side of the plane quad (m).
    pub fn longest_side(&self) -> f64 {
        (0..4)
            .map(|i| {
                let (a, b) = (self.xy[i], self.xy[(i + 1) % 4]);
                (b[0] - a[0]).hypot(b[1] - a[1])
            })
            .fold(0.0, f64::max)
    }

    /// Whether the corners lie in one plane, to rounding.
    pub fn is_plane(&self) -> bool {
        self.z[0].abs() <= 1e-14 * self.longest_side()
    }
}
