//! The thin orthotropic rectangular plate: what all methods of this module solve.

use nalgebra::Vector4;

use crate::section::ShellSection;

/// A thin rectangular plate, `0 <= x <= a`, `0 <= y <= b`, orthotropic along its edges:
/// `D11 w,xxxx + 2 T w,xxyy + D22 w,yyyy = q` with `T = D12 + 2 D66`
/// (Timoshenko and Woinowsky-Krieger, *Theory of Plates and Shells*, Eq. (213)).
///
/// The methods need `a, b, d11, d22 > 0` and `T > -sqrt(D11 D22)` (ellipticity); `d66 = 0` is
/// allowed. Outside of that their results are meaningless (NaN, or `None` where one is offered).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Length along x (m).
    pub a: f64,
    /// Length along y (m).
    pub b: f64,
    /// Bending rigidity along x (N·m).
    pub d11: f64,
    /// Bending rigidity along y (N·m).
    pub d22: f64,
    /// Coupling rigidity (N·m).
    pub d12: f64,
    /// Twisting rigidity (N·m): `M_xy = -2 D66 w,xy`.
    pub d66: f64,
}

/// Deflection and moments at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlateState {
    /// Deflection along the pressure (m).
    pub deflection: f64,
    /// `M_x = -(D11 w,xx + D12 w,yy)` (N).
    pub mx: f64,
    /// `M_y = -(D12 w,xx + D22 w,yy)` (N).
    pub my: f64,
    /// `M_xy = -2 D66 w,xy` (N).
    pub mxy: f64,
}

/// `[w, w,xx, w,yy, w,xy]`: what the series are summed in.
pub(super) type Jet = Vector4<f64>;

impl Plate {
    /// An isotropic plate of rigidity `D` (N·m) and Poisson's ratio `nu`.
    pub fn isotropic(a: f64, b: f64, d: f64, nu: f64) -> Self {
        Self { a, b, d11: d, d22: d, d12: nu * d, d66: 0.5 * (1.0 - nu) * d }
    }

    /// The plate with the bending stiffness of a section whose axes are along the edges
    /// (the couplings `D16` and `D26` are not looked at).
    pub fn of_section(a: f64, b: f64, section: &ShellSection) -> Self {
        let d = &section.d_b;
        Self { a, b, d11: d[(0, 0)], d22: d[(1, 1)], d12: d[(0, 1)], d66: d[(2, 2)] }
    }

    /// `T = D12 + 2 D66` (N·m), half the coefficient of `w,xxyy`.
    pub fn twist(&self) -> f64 {
        self.d12 + 2.0 * self.d66
    }

    /// The same plate with x and y exchanged.
    pub fn transposed(&self) -> Self {
        Self { a: self.b, b: self.a, d11: self.d22, d22: self.d11, ..*self }
    }

    /// `D11 α⁴ + 2 T α² β² + D22 β⁴` (N/m³): load over deflection of `sin αx sin βy`.
    pub(super) fn symbol(&self, alpha: f64, beta: f64) -> f64 {
        let (x, y) = (alpha * alpha, beta * beta);
        self.d11 * x * x + 2.0 * self.twist() * x * y + self.d22 * y * y
    }

    pub(super) fn state(&self, jet: Jet) -> PlateState {
        let [w, xx, yy, xy] = jet.into();
        PlateState {
            deflection: w,
            mx: -(self.d11 * xx + self.d12 * yy),
            my: -(self.d12 * xx + self.d22 * yy),
            mxy: -2.0 * self.d66 * xy,
        }
    }
}

/// A jet of the transposed plate, seen from the plate.
pub(super) fn transpose(jet: Jet) -> Jet {
    Jet::new(jet[0], jet[2], jet[1], jet[3])
}

/// Smooth cut-off of a Fourier series at `theta = m / m_max` in `[0, 1]` (exponential filter of
/// order 8; Gottlieb and Shu, *SIAM Review* 39 (1997) 644): away from the edges, where the
/// odd periodic continuation is smooth, the error then falls like `m_max^-8` instead of with
/// the algebraic decay of the coefficients.
pub(super) fn filter(theta: f64) -> f64 {
    // exp(-36) is the unit round-off: the last term is switched off.
    (-36.0 * theta.powi(8)).exp()
}
