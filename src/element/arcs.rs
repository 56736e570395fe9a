//! Strains of the membrane along the bent sheet, not along its chords.
//!
//! The corners of an element lie on the sheet; its sides and diagonals are chords of it, and shorter than their arcs. Where the
//! curvature is the same everywhere, that is a uniform strain, which moves the nodes a little and costs nothing. Where it
//! varies, no position of the nodes keeps all chords of one smoothing cell and of the hourglass modes beside it, and the mesh
//! locks. So the strains are measured along the surface `w = T ξη + ½ K_ξ ξ² + ½ K_η η²` over the frame, `T` from the warp of
//! the corners and the curvatures from the rotations along the sides:
//!
//! ```text
//! side along ξ at η = ∓1     ε_ξξ += ½ T² + K²/6        K = (w,ξ(2) - w,ξ(1)) / 2 on that side
//! diagonals                  γ_ξη += ⅔ T (K̄_ξ + K̄_η)    arc² = chord² + 4/3 (w,ss)² on each
//! ```
//!
//! (covariant, in natural coordinates; the first is the strain of shallow arches, as in corotational beams: Pacoste and
//! Eriksson, *Comput. Methods Appl. Mech. Eng.* 144 (1997) 163). An element that folds along a diagonal keeps the
//! length of its sides and of that diagonal.
//!
//! A triangle has no `T`, for its corners lie in its plane, and no stresses that vary. Its strain is the one that gives each of its three sides the length of its arc.

use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};

use super::assumed::Assumed;
use super::quad4::{Frame, gauss_point};
use super::transposed::add_with_transpose;
use super::triangle;

/// Shapes of an element: T, then K of the sides 1-2, 4-3 (along ξ), 1-4, 2-3 (along η) (m).
const SHAPES: usize = 5;
/// Strains: three mean ones along the material axes, two of the assumed stresses that vary.
const STRAINS: usize = 5;
type Shapes = SVector<f64, SHAPES>;
type Quadratic = SMatrix<f64, SHAPES, SHAPES>;
/// On the dofs (w, θx, θy) of the four corners, the only ones that shape an element.
type Rows = SMatrix<f64, SHAPES, 12>;
type Vector12 = SVector<f64, 12>;
type Matrix24 = SMatrix<f64, 24, 24>;
type Vector24 = SVector<f64, 24>;
type Matrix2x24 = SMatrix<f64, 2, 24>;
const SIDES: [[usize; 2]; 4] = [[0, 1], [3, 2], [0, 3], [1, 2]];

/// Strains of an element as quadratic functions of its shape, and the assumed stresses that some of them belong to.
#[derive(Clone, Debug)]
pub struct Arcs {
    area: f64,
    /// Shapes for the displacements that shape it.
    shapes: Rows,
    /// `½ cᵀ Q c` of shapes c: three mean strains (1/m²), two of the assumed stresses.
    quadratics: [Quadratic; STRAINS],
    /// Strains of the assumed stresses for local displacements, and their stiffness.
    varying: Matrix2x24,
    stiffness: Matrix2<f64>,
}

/// The shape of an element, and what it strains.
#[derive(Clone, Copy, Debug)]
pub struct Bent {
    /// What the mean strain along the material axes has above that of chords.
    pub strain: Vector3<f64>,
    /// Amplitudes of the stresses that vary.
    pub varying: Vector2<f64>,
    /// Energy that those have above that of chords (J).
    pub energy: f64,
    /// Amplitudes that the arcs add.
    added: Vector2<f64>,
    /// Rates of the strains with the shapes.
    rates: SMatrix<f64, STRAINS, SHAPES>,
}

impl Arcs {
    /// `assumed` are the stresses that vary; `None` in a triangle.
    pub(super) fn new(
        frame: &Frame,
        to_material: &Matrix3<f64>,
        assumed: Option<&Assumed>,
        links: Option<&Matrix24>,
    ) -> Self {
        let varying = assumed.map_or_else(Matrix2x24::zeros, varying_rows);
        Self {
            area: frame.area(),
            shapes: shapes(frame),
            quadratics: match assumed {
                Some(assumed) => quadratics(frame, to_material, assumed),
                None => of_three_sides(frame, to_material),
            },
            varying: links.map_or(varying, |links| varying * links),
            stiffness: assumed.map_or_else(Matrix2::zeros, |assumed| assumed.stiffness),
        }
    }

    /// For local displacements.
    pub fn bent(&self, local: &Vector24) -> Bent {
        let shapes: Shapes = self.shapes_of(local);
        let mut rates = SMatrix::<f64, STRAINS, SHAPES>::zeros();
        let mut strains = SVector::<f64, STRAINS>::zeros();
        for (i, q) in self.quadratics.iter().enumerate() {
            let rate = q * shapes;
            strains[i] = 0.5 * rate.dot(&shapes);
            rates.set_row(i, &rate.transpose());
        }
        let arcs = Vector2::new(strains[3], strains[4]);
        let (chords, added) = (self.varying * local, self.stiffness * arcs);
        Bent {
            strain: Vector3::new(strains[0], strains[1], strains[2]),
            varying: self.stiffness * chords + added,
            energy: added.dot(&(chords + 0.5 * arcs)),
            added,
            rates,
        }
    }

    /// Rate of the mean strains above those of chords for that of the local displacements.
    pub fn rate(&self, bent: &Bent, rate: &Vector24) -> Vector3<f64> {
        bent.rates.fixed_rows::<3>(0) * self.shapes_of(rate)
    }

    /// Local force of what arcs add, for the mean resultants (N/m).
    pub fn force(&self, bent: &Bent, resultant: &Vector3<f64>) -> Vector24 {
        self.of_stresses(bent, resultant, &bent.varying) + self.varying.tr_mul(&bent.added)
    }

    fn of_stresses(&self, bent: &Bent, resultant: &Vector3<f64>, varying: &Vector2<f64>) -> Vector24 {
        let mean: Shapes = bent.rates.fixed_rows::<3>(0).tr_mul(resultant) * self.area;
        let all: Shapes = mean + bent.rates.fixed_rows::<2>(3).tr_mul(varying);
        let shaping: Vector12 = self.shapes.tr_mul(&all);
        let mut local = Vector24::zeros();
        shaping.iter().enumerate().for_each(|(c, f)| local[shaping_dof(c)] = *f);
        local
    }

    /// The change of the amplitudes and of the force for a change of the local displacements with a change of the
    /// resultants, the geometric part left out.
    pub fn change(
        &self,
        bent: &Bent,
        change: &Vector24,
        resultant: &Vector3<f64>,
    ) -> (Vector2<f64>, Vector24) {
        let added = self.stiffness * (bent.rates.fixed_rows::<2>(3) * self.shapes_of(change));
        let varying = self.stiffness * (self.varying * change) + added;
        (varying, self.of_stresses(bent, resultant, &varying) + self.varying.tr_mul(&added))
    }

    /// Adds the stiffness that arcs add, without the geometric one; `d` is that of the mean membrane (N/m) and `coupled` gives
    /// the local force of mean resultants along the chords.
    pub fn add(
        &self,
        bent: &Bent,
        d: &Matrix3<f64>,
        coupled: impl Fn(&Vector3<f64>) -> Vector24,
        k: &mut Matrix24,
    ) {
        let (mean, varying) = (bent.rates.fixed_rows::<3>(0), bent.rates.fixed_rows::<2>(3));
        // Chords with arcs, both ways, and arcs with arcs.
        let mut of_chords = SMatrix::<f64, 24, 3>::zeros();
        for i in 0..3 {
            of_chords.set_column(i, &coupled(&d.column(i).into()));
        }
        let mixed = of_chords * mean + self.varying.tr_mul(&(self.stiffness * varying));
        add_with_transpose(k, &(mixed * self.shapes), shaping_dof);
        self.add_quadratic(
            &(mean.tr_mul(&(d * self.area * mean)) + varying.tr_mul(&(self.stiffness * varying))),
            k,
        );
    }

    /// Adds the geometric stiffness of mean resultants and of the stresses that vary.
    pub fn add_geometric(&self, resultant: &Vector3<f64>, varying: &Vector2<f64>, k: &mut Matrix24) {
        let mut sum = Quadratic::zeros();
        for (i, q) in self.quadratics.iter().enumerate() {
            sum += q * if i < 3 { resultant[i] * self.area } else { varying[i - 3] };
        }
        self.add_quadratic(&sum, k);
    }

    /// Shapes for local displacements.
    fn shapes_of(&self, local: &Vector24) -> Shapes {
        self.shapes * Vector12::from_fn(|c, _| local[shaping_dof(c)])
    }

    /// Adds a stiffness of the shapes to a local one.
    fn add_quadratic(&self, q: &Quadratic, k: &mut Matrix24) {
        let shaping: SMatrix<f64, 12, 12> = self.shapes.transpose() * (q * self.shapes);
        for (i, j) in (0..12).flat_map(|j| (0..12).map(move |i| (i, j))) {
            k[(shaping_dof(i), shaping_dof(j))] += shaping[(i, j)];
        }
    }
}

/// The local dof of a column of [`Rows`].
fn shaping_dof(column: usize) -> usize {
    6 * (column / 3) + 2 + column % 3
}

/// The strains of the assumed stresses on all dofs.
fn varying_rows(assumed: &Assumed) -> Matrix2x24 {
    let mut rows = Matrix2x24::zeros();
    for k in 0..12 {
        rows.set_column(6 * (k / 3) + [0, 1, 5][k % 3], &assumed.strain.column(k));
    }
    rows
}

/// T and the four K for the displacements that shape an element.
fn shapes(frame: &Frame) -> Rows {
    let mut rows = Rows::zeros();
    for (i, sign) in [1.0, -1.0, 1.0, -1.0].into_iter().enumerate() {
        rows[(0, 3 * i)] = 0.25 * sign;
    }
    for (side, [i, j]) in SIDES.into_iter().enumerate() {
        let [x, y] = [0, 1].map(|axis| 0.5 * (frame.xy[j][axis] - frame.xy[i][axis]));
        // w,ξ = x,ξ w,x + y,ξ w,y with w,x = -θy, w,y = θx.
        for (node, sign) in [(i, -0.5), (j, 0.5)] {
            rows[(side + 1, 3 * node + 1)] = sign * y;
            rows[(side + 1, 3 * node + 2)] = -sign * x;
        }
    }
    rows
}

/// Of a triangle: `K²/6` on each of its sides 1-2, 1-4 and 2-3, of which T is no part.
fn of_three_sides(frame: &Frame, to_material: &Matrix3<f64>) -> [Quadratic; STRAINS] {
    let strains = to_material * triangle::strains_of_sides(&frame.xy);
    let mut all = [Quadratic::zeros(); STRAINS];
    for (i, q) in all.iter_mut().enumerate().take(3) {
        for (side, shape) in [1, 3, 4].into_iter().enumerate() {
            q[(shape, shape)] = strains[(i, side)] / 3.0;
        }
    }
    all
}

fn quadratics(frame: &Frame, to_material: &Matrix3<f64>, assumed: &Assumed) -> [Quadratic; STRAINS] {
    let centre = gauss_point(&frame.xy, [0.0, 0.0]);
    let inverse = &centre.j_inverse;
    // Gradients of ξ and η are the columns of the inverse of J.
    let [a, b] = [0, 1].map(|k| [inverse[0][k], inverse[1][k]]);
    let square = |g: [f64; 2]| Vector3::new(g[0] * g[0], g[1] * g[1], 2.0 * g[0] * g[1]);
    let mixed = Vector3::new(a[0] * b[0], a[1] * b[1], a[0] * b[1] + a[1] * b[0]);
    let along = [to_material * square(a), to_material * square(b)];
    let across = to_material * mixed;
    std::array::from_fn(|i| {
        let mut q = Quadratic::zeros();
        for (direction, along) in along.iter().enumerate() {
            for end in 0..2 {
                let side = 2 * direction + end;
                let weight = if i < 3 { 0.5 * along[i] } else { assumed.sides[(i - 3, side)] };
                q[(0, 0)] += weight;
                q[(side + 1, side + 1)] += weight / 3.0;
                if i < 3 {
                    q[(0, side + 1)] += across[i] / 3.0;
                    q[(side + 1, 0)] += across[i] / 3.0;
                }
            }
        }
        q
    })
}
