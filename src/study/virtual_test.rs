//! A KES test as a model: the specimen of the instrument, its clamps, and the curve it would record.
//!
//! The linear solve gives one stiffness per test; the curve is that stiffness over the abscissae
//! of the measurement. What a straight line cannot give (hysteresis, crimp interchange) shows as
//! the difference.

use nalgebra::Vector3;

use super::StudyError;
use super::build;
use super::case::{Case, VirtualTest};
use super::prepared::stand_in;
use super::solver;
use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Parameter, Test};
use crate::mesh;
use crate::model::{Dof, Model, Support};
use crate::quantity::Curve;
use crate::section::ShellSection;
use crate::solve::{self, Options, Plan};

/// Standard specimen: width between the free edges (m).
const WIDTH: f64 = 0.20;

/// A simulated test. Axes are those of [`Test`].
#[derive(Clone, Debug, PartialEq)]
pub struct VirtualCurve {
    /// Which test.
    pub test: Test,
    /// Direction; `None` for compression.
    pub direction: Option<Direction>,
    /// What the specimen shows: force per width over strain or angle (N/m), or moment per width
    /// over curvature (N·m). 0 for compression.
    pub apparent: f64,
    /// The entry of the section that the test is meant to measure, same unit.
    pub ideal: f64,
    law: Law,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Law {
    Line(f64),
    /// P = P0 exp((T0 - T) / length).
    Exponential {
        p0: f64,
        t0: f64,
        length: f64,
    },
}

impl VirtualCurve {
    /// A straight line through the origin.
    pub(super) fn line(test: Test, direction: Option<Direction>, slope: f64) -> Self {
        Self { test, direction, apparent: slope, ideal: slope, law: Law::Line(slope) }
    }

    /// The simulated ordinate at an abscissa (SI).
    pub fn at(&self, x: f64) -> f64 {
        match self.law {
            Law::Line(slope) => slope * x,
            Law::Exponential { p0, t0, length } => p0 * ((t0 - x) / length).exp(),
        }
    }

    /// The simulated curve over `[from, to]` (SI).
    pub fn curve(&self, from: f64, to: f64) -> Curve {
        let steps = 100;
        Curve::from_points((0..=steps).map(|k| {
            let x = from + (to - from) * f64::from(k) / f64::from(steps);
            (x, self.at(x))
        }))
    }
}

/// A mechanical test (tensile, shear, bending) with everything that does not depend on the fabric:
/// specimen, clamps, order of elimination and symbolic factorisation.
#[derive(Debug)]
pub struct PreparedTest {
    test: Test,
    /// The unit of the abscissa that is applied.
    x: f64,
    /// What is read at the moving clamp.
    reading: Dof,
    /// Nodes of the moving clamp.
    right: Vec<u32>,
    /// With a stand-in for the section, warp along x.
    model: Model,
    plan: Plan,
    options: Options,
}

impl PreparedTest {
    /// Makes the test of a case ready.
    ///
    /// # Errors
    /// See [`StudyError`]; S003 for compression, which a shell does not have.
    pub fn new(case: &Case, spec: &VirtualTest, options: &Options) -> Result<Self, StudyError> {
        let gauge = match spec.test {
            Test::Tensile | Test::Shear => 0.05,
            Test::Bending => 0.01,
            Test::Compression => {
                return Err(case.inconsistent(
                    "a shell has no thickness to compress: use `compression` of a sheet".into(),
                ));
            }
        };
        let mesh = mesh::rectangle(gauge, WIDTH, spec.cells[0], spec.cells[1])?;
        let (left, right) = (mesh.set("left")?.to_vec(), mesh.set("right")?.to_vec());
        // A small unit of the abscissa; the solution is scaled, so its size is free.
        let x = match spec.test {
            Test::Bending => 1.0,
            _ => 1e-3,
        };
        let (reading, moved) = match spec.test {
            Test::Tensile => (Dof::U, vec![(Dof::U, x * gauge), (Dof::V, 0.0), (Dof::ThetaZ, 0.0)]),
            Test::Shear => (Dof::V, vec![(Dof::U, 0.0), (Dof::V, x * gauge), (Dof::ThetaZ, 0.0)]),
            // A circular arc: θy = κ x and w = -κ x² / 2 satisfy w,x = -θy.
            _ => {
                let w = -0.5 * x * gauge * gauge;
                (Dof::ThetaY, vec![(Dof::ThetaY, x * gauge), (Dof::W, w), (Dof::ThetaX, 0.0)])
            }
        };
        let model = Model {
            mesh,
            section: stand_in(),
            warp: Vector3::x(),
            formulation: build::formulation(case)?,
            supports: vec![Support::clamped(&left), Support { nodes: right.clone(), held: moved }],
            loads: Vec::new(),
        };
        let options = solver::options(case, options)?;
        let plan = Plan::of(&model, &options)?;
        Ok(Self { test: spec.test, x, reading, right, model, plan, options })
    }

    /// Simulates the test of a specimen cut along `direction`.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn simulate(&self, direction: Direction, section: &ShellSection) -> Result<VirtualCurve, StudyError> {
        let warp = match direction {
            Direction::Warp => Vector3::x(),
            Direction::Weft => Vector3::y(),
            Direction::Bias => Vector3::new(1.0, 1.0, 0.0),
        };
        let model = Model { section: section.clone(), warp, ..self.model.clone() };
        let solution = solve::solve_with(&model, &self.plan, &self.options)?;
        let at = |n: &u32| solution.reaction[6 * *n as usize + self.reading as usize];
        let apparent = self.right.iter().map(at).sum::<f64>() / WIDTH / self.x;
        let along = section.rotated(warp.y.atan2(warp.x));
        let ideal = match self.test {
            // A wide strip between free edges: uniaxial stiffness, 1 over the compliance.
            Test::Tensile => along.d_m.try_inverse().map_or(f64::NAN, |c| 1.0 / c[(0, 0)]),
            Test::Shear => along.d_m[(2, 2)],
            _ => along.d_b[(0, 0)],
        };
        Ok(VirtualCurve { ideal, ..VirtualCurve::line(self.test, Some(direction), apparent) })
    }
}

/// Simulates a mechanical test of a specimen cut along `direction`: a [`PreparedTest`] used once.
///
/// # Errors
/// See [`StudyError`]; S003 for compression, which a shell does not have.
pub fn simulate(
    case: &Case,
    spec: &VirtualTest,
    direction: Direction,
    section: &ShellSection,
) -> Result<VirtualCurve, StudyError> {
    PreparedTest::new(case, spec, &Options::default())?.simulate(direction, section)
}

/// The compression curve of a sheet: the exponential through its two thicknesses, T0 at
/// 0.5 gf/cm² and Tm at 50 gf/cm². `None` without both.
///
/// A closed form with two measured numbers, not a prediction of the shell.
pub fn compression(sheet: &FabricSheet) -> Option<VirtualCurve> {
    const P0: f64 = 0.5 * 98.0665;
    const PM: f64 = 50.0 * 98.0665;
    let t0 = sheet.get(Parameter::T0, None)?.mean;
    let tm = sheet.get(Parameter::Tm, None)?.mean;
    let length = (t0 - tm) / (PM / P0).ln();
    (length > 0.0).then_some(VirtualCurve {
        test: Test::Compression,
        direction: None,
        apparent: 0.0,
        ideal: 0.0,
        law: Law::Exponential { p0: P0, t0, length },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::{Matrix2, Matrix3};
    use std::path::Path;

    fn case(test: &str) -> Case {
        let text =
            format!("title = \"t\"\nfabric = \"*\"\n[virtual_test]\ntest = \"{test}\"\ncells = [10, 40]\n");
        Case::parse(Path::new("t.toml"), &text).unwrap()
    }

    fn fabric(nu: f64, nu_b: f64) -> ShellSection {
        let (e1, e2, f) = (6000.0f64, 3000.0f64, 1.0 / (1.0 - nu * nu));
        let d12 = nu * (e1 * e2).sqrt() * f;
        let (b1, b2) = (1e-5f64, 6e-6f64);
        let b12 = nu_b * (b1 * b2).sqrt();
        ShellSection {
            d_m: Matrix3::new(e1 * f, d12, 0.0, d12, e2 * f, 0.0, 0.0, 0.0, 60.0),
            d_b: Matrix3::new(b1, b12, 0.0, b12, b2, 0.0, 0.0, 0.0, 3e-6),
            d_s: Matrix2::identity() * 50.0,
            areal_density: 0.15,
            thickness: 4e-4,
        }
        .checked()
        .unwrap()
    }

    fn run(test: &str, direction: Direction, section: &ShellSection) -> VirtualCurve {
        let case = case(test);
        simulate(&case, case.virtual_test.as_ref().unwrap(), direction, section).unwrap()
    }

    /// FB2 bends a 20 x 1 cm strip into a cylinder: M = D11 κ (analytical; exact without D12).
    #[test]
    fn bending_gives_the_rigidity_of_each_direction() {
        let s = fabric(0.3, 0.0);
        assert_relative_eq!(run("bending", Direction::Warp, &s).apparent, 1e-5, max_relative = 1e-8);
        assert_relative_eq!(run("bending", Direction::Weft, &s).apparent, 6e-6, max_relative = 1e-8);
        // With ν_b = 0.25 the free edges relax: 0.9998 D11 in an independent solution, 20 x 1 cm.
        let s = fabric(0.3, 0.25);
        assert_relative_eq!(run("bending", Direction::Warp, &s).apparent, 1e-5, max_relative = 1e-3);
    }

    /// FB1: clamps hold the contraction in two corners' reach. Reference: the published-form
    /// estimate E_app/E1 = 1 + φ [1/(1-ν12 ν21) - 1], φ = 0.5 (W/L) √(G/E2), an approximation.
    #[test]
    fn tension_and_shear_carry_their_edge_effects() {
        let s = fabric(0.3, 0.0);
        let t = run("tensile", Direction::Warp, &s);
        let phi = 0.5 * (0.20 / 0.05) * (60.0f64 / 3000.0).sqrt();
        let estimate = 1.0 + phi * (1.0 / (1.0 - 0.09) - 1.0);
        assert_relative_eq!(t.ideal, 6000.0, max_relative = 1e-12);
        assert_relative_eq!(t.apparent / t.ideal, estimate, max_relative = 0.01);
        let g = run("shear", Direction::Warp, &s);
        let estimate = 1.0 - 0.54 * (0.05 / 0.20) * (60.0f64 / 6000.0).sqrt();
        assert_relative_eq!(g.apparent / g.ideal, estimate, max_relative = 0.01);
    }

    #[test]
    fn without_contraction_tension_is_exact() {
        let t = run("tensile", Direction::Weft, &fabric(0.0, 0.0));
        assert_relative_eq!(t.apparent, 3000.0, max_relative = 1e-8);
    }
}
