//! The plate clamped on four edges, by Hencky's superposition.
//!
//! The simply supported plate under the load, plus edge moments that turn its edges back:
//! `M_y = Σ E_m sin α_m x` on `y = 0, b` and `M_x = Σ F_n sin β_n y` on `x = 0, a`
//! (Timoshenko and Woinowsky-Krieger, section 44; Hencky 1913). The slope that a wave of
//! moment makes along its own edge is closed ([`super::levy`]); the slope across is
//! `4 α β / (a S)`, `S = D11 α⁴ + 2 T α² β² + D22 β⁴`.

use nalgebra::{DMatrix, DVector};

use super::levy::{Edge, Strip};
use super::plate::{Jet, Plate, PlateState, filter};

/// Waves of edge moment per pair of edges.
const WAVES: usize = 120;

/// A clamped plate under uniform pressure, solved.
#[derive(Clone, Debug)]
pub struct ClampedPlate {
    plate: Plate,
    pressure: f64,
    /// Moment waves of the edges `y = 0, b`: E_1, E_3, ... (N).
    along_x: Vec<f64>,
    /// Moment waves of the edges `x = 0, a`: F_1, F_3, ... (N).
    along_y: Vec<f64>,
}

impl Plate {
    /// Clamped on four edges under uniform pressure `q` (Pa). `None` if the rigidities are not those
    /// of an elliptic plate.
    pub fn clamped(&self, q: f64) -> Option<ClampedPlate> {
        self.superpose(q, WAVES)
    }

    /// With `n` waves per pair of edges.
    pub(super) fn superpose(&self, q: f64, n: usize) -> Option<ClampedPlate> {
        let (loaded_x, own_x) = edge_slopes(self, n);
        let (loaded_y, own_y) = edge_slopes(&self.transposed(), n);
        let mut slopes = DMatrix::zeros(2 * n, 2 * n);
        let mut load = DVector::zeros(2 * n);
        for i in 0..n {
            // Rows are multiplied by the length of their edge: the matrix is then symmetric.
            slopes[(i, i)] = self.a * own_x[i];
            slopes[(n + i, n + i)] = self.b * own_y[i];
            load[i] = -q * self.a * loaded_x[i];
            load[n + i] = -q * self.b * loaded_y[i];
            let alpha = wave(i, self.a);
            for j in 0..n {
                let beta = wave(j, self.b);
                let across = 4.0 * alpha * beta / self.symbol(alpha, beta);
                slopes[(i, n + j)] = across;
                slopes[(n + j, i)] = across;
            }
        }
        let moments = slopes.cholesky()?.solve(&load);
        Some(ClampedPlate {
            plate: *self,
            pressure: q,
            along_x: moments.rows(0, n).iter().copied().collect(),
            along_y: moments.rows(n, n).iter().copied().collect(),
        })
    }
}

/// Wave number of the i-th odd wave (1/m).
fn wave(i: usize, length: f64) -> f64 {
    (2 * i + 1) as f64 * std::f64::consts::PI / length
}

/// Slopes at `y = 0` per wave: of the supported plate under unit pressure, and of a unit edge moment.
fn edge_slopes(plate: &Plate, waves: usize) -> (Vec<f64>, Vec<f64>) {
    (0..waves)
        .map(|i| {
            let m = 2 * i + 1;
            let loaded = Strip::under_load(plate, m, Edge::Supported);
            // The beam's coefficient 4 / (m π D11 α⁴), and 1 - g.
            let beam = 4.0 / (plate.a * plate.d11 * loaded.alpha.powi(5));
            (-beam * loaded.edge_slope(), Strip::under_edge_moment(plate, m).edge_slope())
        })
        .unzip()
}

impl ClampedPlate {
    /// Deflection and moments inside the plate: to 1e-11 of the maximum at the centre. Within a tenth of
    /// the side from the edges the moments lose digits; on them take [`Self::edge_moment_x`] and
    /// [`Self::edge_moment_y`].
    pub fn state(&self, x: f64, y: f64) -> PlateState {
        let plate = &self.plate;
        let mut jet: Jet = plate.levy_jet(Edge::Supported, x, y, self.pressure);
        for (i, moment) in self.along_x.iter().enumerate() {
            let strip = Strip::under_edge_moment(plate, 2 * i + 1);
            jet += strip.jet(x, y) * *moment;
        }
        let turned = plate.transposed();
        for (i, moment) in self.along_y.iter().enumerate() {
            let strip = Strip::under_edge_moment(&turned, 2 * i + 1);
            jet += strip.transposed_jet(x, y) * *moment;
        }
        plate.state(jet)
    }

    /// Deflection at a point (m).
    pub fn deflection(&self, x: f64, y: f64) -> f64 {
        self.state(x, y).deflection
    }

    /// `M_x` on the clamped edges `x = 0` and `x = a` (N), at the height `y`; to 1e-10 of its
    /// maximum in the middle half of the edge, to 1e-9 farther than a tenth of it from the corners.
    pub fn edge_moment_x(&self, y: f64) -> f64 {
        sine_series(&self.along_y, y, self.plate.b)
    }

    /// `M_y` on the clamped edges `y = 0` and `y = b` (N), at `x`; as accurate.
    pub fn edge_moment_y(&self, x: f64) -> f64 {
        sine_series(&self.along_x, x, self.plate.a)
    }
}

fn sine_series(coefficients: &[f64], at: f64, length: f64) -> f64 {
    let n = coefficients.len() as f64;
    let term = |(i, c): (usize, &f64)| c * (wave(i, length) * at).sin() * filter((i + 1) as f64 / n);
    coefficients.iter().enumerate().map(term).sum()
}
