//! Consistent nodal forces of one element.

use nalgebra::Vector3;

use super::quad4::{Frame, GAUSS_2X2, gauss_point};

/// `∫ N_i dA` over the plane quad (m²).
fn nodal_areas(frame: &Frame) -> [f64; 4] {
    let mut areas = [0.0; 4];
    for point in GAUSS_2X2 {
        let at = gauss_point(&frame.xy, point);
        for (a, n) in areas.iter_mut().zip(at.n) {
            *a += n * at.det;
        }
    }
    areas
}

/// Global forces (N) on the four nodes of a pressure (Pa) along the element normal +e3.
pub fn pressure_load(frame: &Frame, pressure: f64) -> [Vector3<f64>; 4] {
    let normal = frame.rotation.row(2).transpose();
    nodal_areas(frame).map(|a| normal * (a * pressure))
}

/// Global forces (N) of an acceleration field (m/s²) on an areal density (kg/m²).
pub fn gravity_load(frame: &Frame, areal_density: f64, acceleration: &Vector3<f64>) -> [Vector3<f64>; 4] {
    nodal_areas(frame).map(|a| acceleration * (a * areal_density))
}
