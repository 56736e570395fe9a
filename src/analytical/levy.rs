//! Lévy's single series: simply supported at `x = 0, a`, any symmetric pair of edges at `y = 0, b`.
//!
//! For one wave `sin αx` the plate equation becomes, with `η = α λ (y - b/2)`,
//! `λ⁴ = D11/D22` and `ρ = T/√(D11 D22)`,
//! `Y'''' - 2ρ Y'' + Y = load`, whose roots are `±(p ± δ)` with `p² = (ρ+1)/2`, `δ² = (ρ-1)/2`:
//! real and distinct for ρ > 1, equal for ρ = 1 (isotropy), complex for ρ < 1 (H = 0).
//! The pair `e^-ps cosh δs`, `e^-ps sinh(δs)/δ` (s the distance from an edge) is real, bounded and
//! independent at the edge in all three cases.

use std::f64::consts::PI;

use nalgebra::{Matrix2, Vector2};

use super::plate::{Jet, Plate, PlateState, transpose};

/// How the two edges `y = 0` and `y = b` are held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// `w = 0`, `M_y = 0`: the plate is SSSS.
    Supported,
    /// `w = 0`, `w,y = 0`: SCSC.
    Clamped,
    /// `M_y = 0`, `V_y = Q_y + M_xy,x = 0`: SFSF.
    Free,
}

/// Waves summed at most; reached at the edges `y = 0, b` only.
const WAVES: usize = 4001;

impl Plate {
    /// Simply supported at `x = 0, a`, held as `edge` says at `y = 0, b`, under uniform pressure
    /// `q` (Pa), at `(x, y)` (m). Lévy's series (Timoshenko and Woinowsky-Krieger, sections 30, 42 and 48),
    /// its particular part summed to the beam's `q x (a³ - 2 a x² + x³) / (24 D11)`.
    ///
    /// Exact to rounding inside; towards `y = 0, b` the series turn algebraic and the last digits of
    /// the moments are lost (about 1e-10 of the largest moment is left at an edge). Rounding grows like
    /// `(a/b)⁴`: for long narrow plates, supported at the long edges, turn the plate.
    pub fn levy(&self, edge: Edge, x: f64, y: f64, q: f64) -> PlateState {
        self.state(self.levy_jet(edge, x, y, q))
    }

    pub(super) fn levy_jet(&self, edge: Edge, x: f64, y: f64, q: f64) -> Jet {
        let a = self.a;
        let beam = q * x / self.d11;
        let mut jet =
            Jet::new(beam * (a * a * a - 2.0 * a * x * x + x * x * x) / 24.0, beam * (x - a) / 2.0, 0.0, 0.0);
        for m in (1..=WAVES).step_by(2) {
            let strip = Strip::under_load(self, m, edge);
            let alpha = strip.alpha;
            jet -= strip.jet(x, y) * (4.0 * q / (m as f64 * PI * self.d11 * alpha.powi(4)));
            if strip.vanished(y) {
                break;
            }
        }
        jet
    }
}

/// `g(y) sin αx` without surface load, `g` even about the middle line: what the edges of one wave add.
pub(super) struct Strip {
    /// Wave number along x (1/m).
    pub alpha: f64,
    /// Wave number of `η` (1/m): `α λ`.
    scale: f64,
    half: f64,
    pair: Pair,
    coefficients: Vector2<f64>,
}

impl Strip {
    fn new(plate: &Plate, m: usize) -> Self {
        let alpha = m as f64 * PI / plate.a;
        let scale = alpha * (plate.d11 / plate.d22).powf(0.25);
        let rho = plate.twist() / (plate.d11 * plate.d22).sqrt();
        let half = 0.5 * plate.b;
        Self { alpha, scale, half, pair: Pair::new(rho, scale * half), coefficients: Vector2::zeros() }
    }

    /// `1 - g` is the wave's response to a unit load, in units of the beam's.
    pub fn under_load(plate: &Plate, m: usize, edge: Edge) -> Self {
        let root = (plate.d11 * plate.d22).sqrt();
        let (rho, nu) = (plate.twist() / root, plate.d12 / root);
        let mut strip = Self::new(plate, m);
        strip.coefficients = match edge {
            Edge::Supported => strip.pair.solve(|f| [f[0], f[2]], [1.0, 0.0]),
            Edge::Clamped => strip.pair.solve(|f| [f[0], f[1]], [1.0, 0.0]),
            Edge::Free => {
                strip.pair.solve(|f| [f[2] - nu * f[0], f[3] - (2.0 * rho - nu) * f[1]], [-nu, 0.0])
            }
        };
        strip
    }

    /// The response to edge moments `M_y = sin αx` on both supported edges `y = 0, b`.
    pub fn under_edge_moment(plate: &Plate, m: usize) -> Self {
        let mut strip = Self::new(plate, m);
        let curvature = -1.0 / (plate.d22 * strip.scale * strip.scale);
        strip.coefficients = strip.pair.solve(|f| [f[0], f[2]], [0.0, curvature]);
        strip
    }

    /// `dg/dy` at `y = 0`.
    pub fn edge_slope(&self) -> f64 {
        -self.scale * self.pair.combine(self.coefficients, self.pair.half)[1]
    }

    /// `[w, w,xx, w,yy, w,xy]` of `g(y) sin αx`.
    pub fn jet(&self, x: f64, y: f64) -> Jet {
        let g = self.pair.combine(self.coefficients, self.scale * (y - self.half));
        let (sine, cosine) = (self.alpha * x).sin_cos();
        Jet::new(
            g[0] * sine,
            -self.alpha * self.alpha * g[0] * sine,
            self.scale * self.scale * g[2] * sine,
            self.alpha * self.scale * g[1] * cosine,
        )
    }

    /// The same for a strip of the transposed plate, in the coordinates of the plate.
    pub fn transposed_jet(&self, x: f64, y: f64) -> Jet {
        transpose(self.jet(y, x))
    }

    /// This far from the edges the wave and all shorter ones are below rounding.
    pub fn vanished(&self, y: f64) -> bool {
        let distance = self.scale * (self.half - (y - self.half).abs());
        distance * self.pair.slowest() > 45.0
    }
}

/// The two even solutions of `Y'''' - 2ρ Y'' + Y = 0` on `[-half, half]`: sums of functions that
/// decay from either edge.
struct Pair {
    p: f64,
    /// `δ²`, negative for complex roots.
    delta2: f64,
    half: f64,
}

impl Pair {
    fn new(rho: f64, half: f64) -> Self {
        Self { p: (0.5 * (rho + 1.0)).sqrt(), delta2: 0.5 * (rho - 1.0), half }
    }

    /// The slowest rate of decay. `(p + δ)(p - δ) = 1`.
    fn slowest(&self) -> f64 {
        if self.delta2 > 0.0 { 1.0 / (self.p + self.delta2.sqrt()) } else { self.p }
    }

    /// `(e^-ps cosh δs, e^-ps sinh(δs)/δ)`.
    fn decay(&self, s: f64) -> Vector2<f64> {
        let delta = self.delta2.abs().sqrt();
        let angle = delta * s;
        let scale = (-self.p * s).exp();
        if self.delta2 <= 0.0 {
            let ratio = if angle == 0.0 { s } else { angle.sin() / delta };
            return Vector2::new(scale * angle.cos(), scale * ratio);
        }
        if angle < 1.0 {
            return Vector2::new(scale * angle.cosh(), scale * angle.sinh() / delta);
        }
        let (slow, fast) = ((-s / (self.p + delta)).exp(), (-(self.p + delta) * s).exp());
        Vector2::new(0.5 * (slow + fast), 0.5 * (slow - fast) / delta)
    }

    /// Value and first three derivatives of `c · (f1, f2)` at `eta`.
    fn combine(&self, c: Vector2<f64>, eta: f64) -> [f64; 4] {
        // d/ds (E, F) = (-p E + δ² F, E - p F); towards one edge s falls with eta.
        let derive = Matrix2::new(-self.p, self.delta2, 1.0, -self.p);
        let mut near = self.decay(self.half - eta);
        let mut far = self.decay(self.half + eta);
        let mut out = [0.0; 4];
        for value in &mut out {
            *value = c.dot(&(near + far));
            near = -(derive * near);
            far = derive * far;
        }
        out
    }

    /// The coefficients for which two conditions at the edge hold.
    fn solve(&self, conditions: impl Fn([f64; 4]) -> [f64; 2], values: [f64; 2]) -> Vector2<f64> {
        let first = conditions(self.combine(Vector2::x(), self.half));
        let second = conditions(self.combine(Vector2::y(), self.half));
        let [[a, c], [b, d]] = [first, second];
        let determinant = a * d - b * c;
        Vector2::new(d * values[0] - b * values[1], a * values[1] - c * values[0]) / determinant
    }
}
