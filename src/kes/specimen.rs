//! Where parameters are read on a record, and sizes and loads of the instruments (SI).
//!
//! Sources: Kawabata (1980), The Standardization and Analysis of Hand Evaluation, 2nd ed., and the manuals of KES-FB1
//! to FB4. Specimens and conditions of the tests are in their [`TestSpec`](super::TestSpec).

use crate::quantity::STANDARD_GRAVITY;

/// 1 gf/cm (N/m).
pub const GF_PER_CM: f64 = STANDARD_GRAVITY * 0.1;
/// 1 gf/cm² (Pa).
pub(super) const GF_PER_CM2: f64 = 98.0665;
/// 1 degree (rad).
pub const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Shear angles between which G is fitted: 0.5 to 2.5 degrees (rad).
pub const SHEAR_SLOPE: [f64; 2] = [0.5 * DEGREE, 2.5 * DEGREE];
/// Shear angles at which 2HG and 2HG5 are read: 0.5 and 5 degrees (rad).
pub const SHEAR_READINGS: [f64; 2] = [0.5 * DEGREE, 5.0 * DEGREE];
/// Curvatures between which B is fitted: 0.5 to 1.5 1/cm (1/m).
pub const BENDING_SLOPE: [f64; 2] = [50.0, 150.0];
/// Curvatures at which 2HB and 2HB05 are read: 1.0 and 0.5 1/cm (1/m).
pub const BENDING_READINGS: [f64; 2] = [100.0, 50.0];
/// Forces per width between which the low-load tangent is fitted: 5 to 20 gf/cm (N/m).
pub const TENSILE_SLOPE: [f64; 2] = [5.0 * GF_PER_CM, 20.0 * GF_PER_CM];
/// Pressure at which T0 is read: 0.5 gf/cm² (Pa).
pub const COMPRESSION_START: f64 = 0.5 * STANDARD_GRAVITY * 10.0;
/// Area of the foot of KES-FB3: 2 cm² (m²).
pub const FOOT_AREA: f64 = 2.0e-4;
/// Length of a sweep of KES-FB4 that MIU, MMD and SMD are means over: 2 cm (m), in the middle of the sweep.
pub const SURFACE_LENGTH: f64 = 0.02;
/// Load on the contactor of the friction of KES-FB4, by which a force is divided: 50 gf (N).
pub const FRICTION_LOAD: f64 = 50.0e-3 * STANDARD_GRAVITY;
/// Load on the contactor of the roughness of KES-FB4: 10 gf (N).
pub const ROUGHNESS_LOAD: f64 = 10.0e-3 * STANDARD_GRAVITY;
