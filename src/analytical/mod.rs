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
//! | [`elastica`] | large deflection under tip load and own weight, hanging loops | spectral collocation |
//!
//! Signs: deflection `w` along the pressure; `M_x = -(D11 w,xx + D12 w,yy)` and so on, hence
//! positive at the centre of a pressed plate and negative at its clamped edges.

pub mod beam;
pub mod clamped;
pub mod elastica;
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
