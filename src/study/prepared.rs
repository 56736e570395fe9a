//! A case made ready once for every fabric that it is solved for.

use std::sync::{Arc, OnceLock};

use nalgebra::{Matrix2, Matrix3, Point3};

use super::case::{Analysis, Case};
use super::{StudyError, build, solver};
use crate::fields::{Line, Locator, Recovery};
use crate::mesh::QuadMesh;
use crate::model::Model;
use crate::section::ShellSection;
use crate::solve::{Options, Plan};

/// A case with a `[sheet]`, and everything of it that does not depend on the fabric: mesh, supports,
/// loads, order of elimination and symbolic factorisation, places of probes. Shared between threads
/// by reference; [`solve`](Self::solve) gives the same bytes as a solve from scratch.
#[derive(Debug)]
pub struct PreparedCase<'a> {
    pub(super) case: &'a Case,
    pub(super) options: Options,
    /// With a stand-in for the section.
    model: Model,
    /// Of a linear analysis; the others have analyses of their own.
    pub(super) plan: Option<Plan>,
    pub(super) probes: Vec<Locator>,
    /// The middle line along x.
    pub(super) middle: Line,
    /// Made when a result first asks for it.
    pub(super) recovery: Arc<OnceLock<Recovery>>,
}

/// Steps of the profile along the middle line.
const STEPS: usize = 200;

impl<'a> PreparedCase<'a> {
    /// Makes a case ready.
    ///
    /// # Errors
    /// See [`StudyError`]: the case itself, its mesh, supports and loads; N002.
    pub fn new(case: &'a Case, options: &Options) -> Result<Self, StudyError> {
        let Some(sheet) = &case.sheet else {
            return Err(
                case.inconsistent("the case has no [sheet]; a [virtual_test] is compared, not solved".into())
            );
        };
        let options = &solver::options(case, options)?;
        let model = build::model(case, sheet, stand_in())?;
        let plan = match case.analysis {
            Analysis::Linear => Some(Plan::of(&model, options)?),
            _ => None,
        };
        let probes = locators(case, &model.mesh)?;
        let [from, to] = middle_line(&model.mesh);
        let middle = Line::new(&model.mesh, &from, &to, STEPS);
        Ok(Self { case, options: *options, model, plan, probes, middle, recovery: Arc::default() })
    }

    /// The model of the case with a section.
    pub fn model(&self, section: ShellSection) -> Model {
        Model { section, ..self.model.clone() }
    }
}

/// Ones: which dofs the loads set in motion does not depend on the section, whose density is positive.
pub(super) fn stand_in() -> ShellSection {
    ShellSection {
        d_m: Matrix3::identity(),
        d_b: Matrix3::identity(),
        d_s: Matrix2::identity(),
        areal_density: 1.0,
        thickness: 1.0,
    }
}

/// Ends of the middle line along x.
fn middle_line(mesh: &QuadMesh) -> [Point3<f64>; 2] {
    let start = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
    let (low, high) = mesh.nodes.iter().fold(start, |(l, h), p| (l.inf(p), h.sup(p)));
    let middle = nalgebra::center(&low, &high);
    [Point3::new(low.x, middle.y, middle.z), Point3::new(high.x, middle.y, middle.z)]
}

fn locators(case: &Case, mesh: &QuadMesh) -> Result<Vec<Locator>, StudyError> {
    case.probes
        .iter()
        .map(|p| {
            let [x, y] = p.at.map(|c| c.si());
            Locator::find(mesh, &Point3::new(x, y, 0.0)).ok_or_else(|| {
                case.inconsistent(format!("probe `{}` at ({x}, {y}) m lies outside the sheet", p.name))
            })
        })
        .collect()
}
