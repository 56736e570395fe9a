//! Smoothing cells and the mean gradients of the shape functions over them.

use super::quad4::{GAUSS_2X2, shape};

/// How an element is divided into smoothing cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    /// `along_xi` by `along_eta` equal rectangles in natural coordinates.
    Grid {
        /// Number along ξ.
        along_xi: u8,
        /// Number along η.
        along_eta: u8,
    },
    /// nc = 3 of the smoothed finite element literature: one half and two quarters.
    HalfAndQuarters,
}

/// One smoothing cell of a plane quad.
#[derive(Clone, Copy, Debug)]
pub struct SmoothingCell {
    /// Area (m²).
    pub area: f64,
    /// Mean of `(N_i,x, N_i,y)` over the cell (1/m).
    pub gradient: [[f64; 2]; 4],
    /// Natural coordinates of the middle of the cell.
    pub middle: [f64; 2],
}

impl Cells {
    /// A grid of cells; 1 x 1 is reduced integration, 2 x 2 the default.
    pub const fn grid(along_xi: u8, along_eta: u8) -> Self {
        Self::Grid { along_xi, along_eta }
    }

    /// The usual layout for a number of cells: 1, 2 (halves), 3 (a half and two quarters) and the
    /// squares 4, 9, 16 ...; `None` for other numbers.
    pub fn from_count(nc: u32) -> Option<Self> {
        match nc {
            2 => Some(Self::grid(2, 1)),
            3 => Some(Self::HalfAndQuarters),
            _ => {
                let side = nc.isqrt();
                (side > 0 && side * side == nc && side <= 64).then(|| Self::grid(side as u8, side as u8))
            }
        }
    }

    /// Number of cells.
    pub fn count(self) -> usize {
        match self {
            Self::Grid { along_xi, along_eta } => usize::from(along_xi) * usize::from(along_eta),
            Self::HalfAndQuarters => 3,
        }
    }

    /// The `k`-th cell as `[ξ0, ξ1, η0, η1]`.
    fn bounds(self, k: usize) -> [f64; 4] {
        match self {
            Self::Grid { along_xi, along_eta } => {
                let (nx, ny) = (usize::from(along_xi), usize::from(along_eta));
                let at = |i: usize, n: usize| 2.0 * i as f64 / n as f64 - 1.0;
                let (i, j) = (k % nx, k / nx);
                [at(i, nx), at(i + 1, nx), at(j, ny), at(j + 1, ny)]
            }
            Self::HalfAndQuarters => [[-1.0, 0.0, -1.0, 1.0], [0.0, 1.0, -1.0, 0.0], [0.0, 1.0, 0.0, 1.0]][k],
        }
    }

    /// The 2 x 2 Gauss points of the `k`-th cell, in the natural coordinates of the element, and the natural area of each.
    pub fn gauss(self, k: usize) -> ([[f64; 2]; 4], f64) {
        let [x0, x1, y0, y1] = self.bounds(k);
        let points =
            GAUSS_2X2.map(|[x, y]| [0.5 * (x0 + x1 + x * (x1 - x0)), 0.5 * (y0 + y1 + y * (y1 - y0))]);
        (points, 0.25 * (x1 - x0) * (y1 - y0))
    }

    /// Every cell of the plane quad `xy`.
    pub fn over(self, xy: &[[f64; 2]; 4]) -> impl Iterator<Item = SmoothingCell> {
        (0..self.count()).map(move |k| SmoothingCell::of(xy, self.bounds(k)))
    }
}

impl SmoothingCell {
    /// The whole of the plane quad `xy` as one cell.
    pub fn whole(xy: &[[f64; 2]; 4]) -> Self {
        Self::of(xy, [-1.0, 1.0, -1.0, 1.0])
    }

    /// The rectangle `[ξ0, ξ1, η0, η1]` of the quad (Eqs. (20) to (23), corrected: see the theory).
    fn of(xy: &[[f64; 2]; 4], [xi0, xi1, eta0, eta1]: [f64; 4]) -> Self {
        let n = [shape(xi0, eta0), shape(xi1, eta0), shape(xi1, eta1), shape(xi0, eta1)];
        let at = n.map(|n| {
            [0, 1]
                .map(|axis| n[0] * xy[0][axis] + n[1] * xy[1][axis] + n[2] * xy[2][axis] + n[3] * xy[3][axis])
        });
        let area = 0.5
            * ((at[2][0] - at[0][0]) * (at[3][1] - at[1][1]) - (at[2][1] - at[0][1]) * (at[3][0] - at[1][0]));
        let mut gradient = [[0.0; 2]; 4];
        for e in 0..4 {
            let f = (e + 1) % 4;
            // Outward normal times length of a counter-clockwise edge.
            let normal = [at[f][1] - at[e][1], at[e][0] - at[f][0]];
            for (i, g) in gradient.iter_mut().enumerate() {
                let middle = 0.5 * (n[e][i] + n[f][i]) / area;
                g[0] += middle * normal[0];
                g[1] += middle * normal[1];
            }
        }
        Self { area, gradient, middle: [0.5 * (xi0 + xi1), 0.5 * (eta0 + eta1)] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::quad4::gauss_point;
    use approx::assert_relative_eq;

    const QUAD: [[f64; 2]; 4] = [[0.1, -0.2], [1.3, 0.1], [1.1, 0.9], [-0.2, 1.2]];

    #[test]
    fn cells_fill_the_quad_and_reproduce_linear_fields() {
        let area = 0.5 * ((1.1 - 0.1) * (1.2 - 0.1) - (0.9 + 0.2) * (-0.2 - 1.3));
        for nc in [1, 2, 3, 4, 9, 16] {
            let cells = Cells::from_count(nc).unwrap();
            assert_eq!(cells.over(&QUAD).count(), nc as usize);
            assert_relative_eq!(cells.over(&QUAD).map(|c| c.area).sum::<f64>(), area, max_relative = 1e-14);
            for cell in cells.over(&QUAD) {
                let field = |i: usize| 3.0 + 2.0 * QUAD[i][0] - 5.0 * QUAD[i][1];
                let g = (0..4).fold([0.0; 2], |s, i| {
                    [s[0] + cell.gradient[i][0] * field(i), s[1] + cell.gradient[i][1] * field(i)]
                });
                assert_relative_eq!(g[0], 2.0, max_relative = 1e-12);
                assert_relative_eq!(g[1], -5.0, max_relative = 1e-12);
            }
        }
        assert_eq!(Cells::from_count(5), None);
        assert_eq!(Cells::from_count(0), None);
    }

    /// Many small cells see the compatible gradient at their middles.
    #[test]
    fn small_cells_tend_to_the_compatible_gradient() {
        for cell in Cells::grid(64, 64).over(&QUAD).step_by(97) {
            let exact = gauss_point(&QUAD, cell.middle);
            for i in 0..4 {
                assert_relative_eq!(cell.gradient[i][0], exact.gradient(i)[0], epsilon = 2e-4);
                assert_relative_eq!(cell.gradient[i][1], exact.gradient(i)[1], epsilon = 2e-4);
            }
        }
    }
}
