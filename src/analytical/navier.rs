//! Navier's double sine series for the plate that is simply supported on all edges.

use std::f64::consts::PI;

use super::plate::{Jet, Plate, PlateState, filter};

/// Largest wave number of the double series.
const WAVES: usize = 401;

impl Plate {
    /// Simply supported on four edges, under uniform pressure `q` (Pa), at `(x, y)` (m).
    ///
    /// `w = Σ Σ 16 q / (π² m n S(α, β)) sin αx sin βy`, m and n odd, `α = mπ/a`, `β = nπ/b`,
    /// `S = D11 α⁴ + 2 T α² β² + D22 β⁴` (Timoshenko and Woinowsky-Krieger, sections 28 and 88).
    ///
    /// The series is cut off smoothly: exact to 1e-13 farther than a tenth of the side from the edges, to
    /// 1e-10 (relative to the largest) at a twentieth. Nearer to an edge the deflection is still good to
    /// 1e-9 of its maximum (sides up to 1:4), the moments to 1e-6: for those take [`Plate::levy`].
    pub fn navier(&self, x: f64, y: f64, q: f64) -> PlateState {
        let along_x = Waves::new(self.a, x);
        let along_y = Waves::new(self.b, y);
        let mut jet = Jet::zeros();
        for i in 0..along_x.number.len() {
            let alpha = along_x.number[i];
            for j in 0..along_y.number.len() {
                let beta = along_y.number[j];
                // 16 q / (π² m n S) = 16 q / (a b α β S).
                let smooth = along_x.filter[i] * along_y.filter[j];
                let w = smooth / (alpha * beta * self.symbol(alpha, beta));
                let sines = along_x.sine[i] * along_y.sine[j];
                jet += Jet::new(
                    w * sines,
                    -alpha * alpha * w * sines,
                    -beta * beta * w * sines,
                    alpha * beta * w * along_x.cosine[i] * along_y.cosine[j],
                );
            }
        }
        self.state(jet * (16.0 * q / (self.a * self.b)))
    }
}

/// The odd waves `k = mπ/length` of one direction and their values at a point.
pub(super) struct Waves {
    /// Wave numbers (1/m).
    pub number: Vec<f64>,
    pub sine: Vec<f64>,
    pub cosine: Vec<f64>,
    pub filter: Vec<f64>,
}

impl Waves {
    pub fn new(length: f64, at: f64) -> Self {
        let odd = || (1..=WAVES).step_by(2);
        let number: Vec<f64> = odd().map(|m| m as f64 * PI / length).collect();
        Self {
            sine: number.iter().map(|k| (k * at).sin()).collect(),
            cosine: number.iter().map(|k| (k * at).cos()).collect(),
            filter: odd().map(|m| filter(m as f64 / WAVES as f64)).collect(),
            number,
        }
    }
}
