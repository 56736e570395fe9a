//! Closed forms and high-precision references for plates, beams and heavy strips.
//!
//! Nothing here knows textiles or finite elements: plain SI `f64` in and out, so that every
//! result of the mechanics arm can be judged by something that shares no code with it.
//!
//! | file | problem | method |
//! |---|---|---|
//! | [`plate`] | the plate, its rigidities, its state at a point | definitions |
//! | [`navier`] | simply supported on four edges, uniform pressure | double sine series |
//! | [`levy`] | two edges simply supported, two supported, clamped or free | single series, closed inner sums |
//! | [`clamped`] | four clamped edges | Hencky's superposition, closed inner sums |
//! | [`ritz`] | clamped, cantilevered and free edges: statics | polynomials of high degree |
//! | [`mindlin`] | shear-flexible plates, supported (hard) and clamped | double series, polynomials |
//! | [`von_karman`] | clamped and immovable, moderately large deflection | polynomials, Newton |
//! | [`vibration`] | natural frequencies of the same plates | Navier, polynomials of high degree |
//! | [`beam`] | beam strips, Peirce's formula, the fit to the heart loop | closed forms |
//! | [`elastica`] | large deflection of cantilevers under tip load and own weight | spectral collocation |
//! | [`hanging`] | hanging loops, slack strips between clamps | spectral collocation |
//!
//! Signs: deflection `w` along the pressure; `M_x = -(D11 w,xx + D12 w,yy)` and so on, hence
//! positive at the centre of a pressed plate and negative at its clamped edges.
//!
//! ```
//! use kesf::analytical::{Plate, elastica, levy::Edge};
//!
//! // 20 cm square, D = 1e-5 N·m, nu = 0.3, under 0.1 Pa: the textbook coefficients.
//! let plate = Plate::isotropic(0.2, 0.2, 1e-5, 0.3);
//! let unit = 0.1 * 0.2_f64.powi(4) / 1e-5;
//! let supported = plate.levy(Edge::Supported, 0.1, 0.1, 0.1).deflection;
//! let clamped = plate.clamped(0.1).map(|p| p.deflection(0.1, 0.1));
//! assert!((supported / unit - 0.00406235).abs() < 1e-8);
//! assert!((clamped.unwrap_or_default() / unit - 0.00126532).abs() < 1e-8);
//!
//! // The overhang at 41.5 degrees is twice the bending length.
//! let ratio = elastica::bending_length_ratio(41.5_f64.to_radians());
//! assert!((ratio.unwrap_or_default() - 0.499913).abs() < 1e-6);
//! ```

pub mod beam;
pub mod clamped;
pub mod elastica;
pub mod hanging;
mod legendre;
pub mod levy;
pub mod mindlin;
pub mod navier;
pub mod plate;
pub mod ritz;
mod rod;
pub mod vibration;
pub mod von_karman;

pub use plate::{Plate, PlateState};

#[cfg(test)]
mod tests;
