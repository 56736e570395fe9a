//! The Cusick drape: a round sheet on a smaller disc hangs down under its own weight.
//!
//! ```text
//!        ____________            the sheet between disc and rim is a ring, clamped at the disc;
//!    .-''|   disc   |''-.        its shadow over its area at rest is the drape coefficient
//!   /    '----------'    \       (A_shadow - A_disc) / (A_specimen - A_disc)
//! ```
//! The equilibria are many: a sheet hangs in four folds, or five, or six, and its coefficient moves by
//! ten points between them. So there are several searches, each from a sheet that is given its number
//! of folds at the start; every one ends in a stable equilibrium with whatever folds it then has. The
//! result is the state of lowest energy, refined, and the band of all coefficients.

mod method;
mod refine;
mod rim;
mod shadow;

use std::ops::ControlFlow;

use nalgebra::{UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub use method::{as_measured, drape_method};
pub use rim::Folds;

use super::effort::within_limits;
use super::{Case, StudyError, Watch, build, refused};
use crate::case::{Annulus, DrapeProblem, Outline, Problem, Sheet};
use crate::characterise::FabricSheet;
use crate::finding::{Finding, Located, Place, StudyFact};
use crate::model::Model;
use crate::platform;
use crate::quantity::Ratio;
use crate::section::{SheetLaw, ShellSection};
use crate::solve::nonlinear::{NonlinearError, Settings, Solution, State, Step, descend_from, plan};
use crate::solve::{Options, Plan};

/// A draped sheet.
#[derive(Clone, Debug)]
pub struct Drape {
    /// Name of the case.
    pub case: String,
    /// One state for each search that ended in an equilibrium, on the mesh of the case; lowest
    /// energy first.
    pub states: Vec<DrapeState>,
    /// Folds at the start of the searches that did not, and why.
    pub failed: Vec<(usize, NonlinearError)>,
    /// The state of lowest energy on each mesh, from that of the case to the finest.
    pub meshes: Vec<DrapeState>,
    /// The last of them.
    pub finest: DrapeState,
    /// The model on the finest mesh.
    pub model: Model,
    /// The equilibrium on the finest mesh.
    pub solution: Solution,
    /// Radius of the disc (m).
    pub disc_radius: f64,
    /// Radius of the sheet at rest (m).
    pub sheet_radius: f64,
    /// Distance of the shadow's outline from the axis (m), one for each degree from x.
    pub outline: Vec<f64>,
    /// What a reader of the result must know.
    pub findings: Vec<Finding>,
}

/// An equilibrium of a draped sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct DrapeState {
    /// Folds that the sheet was given at the start.
    pub start: usize,
    /// Elements of the mesh.
    pub elements: usize,
    /// Drape coefficient, 0 to 1.
    pub coefficient: f64,
    /// The folds.
    pub folds: Folds,
    /// Strain energy and energy of the weight, 0 for the flat sheet (J).
    pub energy: f64,
    /// Strain energy (J).
    pub strain_energy: f64,
    /// Unbalanced forces relative to loads or reactions.
    pub residual: f64,
    /// Directions in which the energy falls; 0 is stable.
    pub negative_pivots: usize,
    /// Lowest eigenvalue of the tangent per area (N/m³).
    pub lowest_eigenvalue: f64,
    /// Iterations of the search.
    pub iterations: usize,
}

impl Drape {
    /// The lowest and the highest coefficient of the states found, moved by what refinement changed
    /// in the state of lowest energy.
    pub fn band(&self) -> [f64; 2] {
        let moved = self.states.first().map_or(0.0, |lowest| self.finest.coefficient - lowest.coefficient);
        let all = self.states.iter().map(|s| s.coefficient + moved);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], c| [l.min(c), h.max(c)])
    }
}

/// Unbalanced forces that are accepted, relative to the weight or the reactions.
const TOLERANCE: f64 = 1e-6;

/// Steps of a search.
const STEPS: usize = 600;

/// How much the last refinement may change the coefficient without a word. No order of convergence is taken
/// off it: a limp sheet that went from 43.2 to 40.3 % ended at 37.0 % with the next one.
const MESH_ERROR: f64 = 0.02;

/// Height of the folds at the start over the width of the ring.
const START_HEIGHT: f64 = 0.15;

/// Solves a drape case for a section, elastic or with a law of friction; `progress` is called after each search and each refinement.
///
/// # Errors
/// S003 if the case is no drape; the errors of mesh and model; N007 if no search ended in an
/// equilibrium, or the refined one did not.
pub fn drape(
    case: &Case,
    section: &ShellSection,
    law: Option<&SheetLaw>,
    options: &Options,
    watch: Watch<'_>,
) -> Result<Drape, StudyError> {
    let Problem::Drape(problem) = &case.problem else {
        let message = "the case is no drape: write [analysis] kind = \"drape\"";
        return Err(refused(case, &Located::from(()), message));
    };
    let DrapeProblem { folds, refinements, .. } = problem;
    within_limits(case, &case.options(options)?)?;
    let ring = Ring::of(problem);
    let model = ring.model(case, problem, section)?;
    build::weighed(&model)?;
    let single = Options { threads: 1, ..case.options(options)? };
    let shared = plan(&model, &single)?;
    let searches: Vec<Result<(Solution, DrapeState), (usize, NonlinearError)>> =
        platform::map(folds, |&start| {
            let found = ring.relax(&model, law, &shared, ring.start(&model, start), &single, watch);
            (watch.stage)();
            found.map(|s| (s.clone(), ring.state(&model, &s, start))).map_err(|e| (start, e))
        });
    let go_on = || if (watch.stopped)() { Err(StudyError::Stopped) } else { Ok(()) };
    go_on()?;
    let (mut found, mut failed) = (Vec::new(), Vec::new());
    for search in searches {
        match search {
            Ok(state) => found.push(state),
            Err(failure) => failed.push(failure),
        }
    }
    found.sort_by(|a, b| a.1.energy.total_cmp(&b.1.energy));
    let Some((lowest, _)) = found.first() else {
        // `folds` is not empty, so there is a failure.
        return Err(failed.swap_remove(0).1.into());
    };
    let (mut ring, mut model, mut solution, start) = (ring, model, lowest.clone(), found[0].1.start);
    let mut meshes = vec![found[0].1.clone()];
    for _ in 0..*refinements {
        let finer = ring.refined();
        let fine = finer.model(case, problem, section)?;
        let from = refine::refined(&solution.state, &model.mesh, &fine.mesh, ring.cells);
        solution = finer.relax(&fine, law, &plan(&fine, options)?, from, options, watch)?;
        go_on()?;
        meshes.push(finer.state(&fine, &solution, start));
        (watch.stage)();
        (ring, model) = (finer, fine);
    }
    // `meshes` holds the first one at least.
    let finest = meshes.last().unwrap_or(&found[0].1).clone();
    let states: Vec<DrapeState> = found.into_iter().map(|(_, s)| s).collect();
    let outline = shadow::outline(&projected(&solution.state), &model.mesh.quads, ring.inner, 360);
    let findings = findings(case, &meshes, &failed, folds.len(), law.is_none());
    Ok(Drape {
        case: case.name.clone(),
        states,
        failed,
        meshes,
        finest,
        model,
        solution,
        disc_radius: ring.inner,
        sheet_radius: ring.outer,
        outline,
        findings,
    })
}

/// How often [`Watch::stage`] is called for a case.
pub fn drape_stages(case: &Case) -> usize {
    match &case.problem {
        Problem::Drape(DrapeProblem { folds, refinements, .. }) => folds.len() + refinements,
        Problem::Sheet(_) | Problem::InstrumentTest(_) | Problem::BendingTest(_) => 0,
    }
}

/// A measured drape coefficient of a fabric (0 to 1) and its method, if its folder has one.
pub fn measured_drape(sheet: &FabricSheet) -> Option<(f64, &str)> {
    let result = sheet.info.results.iter().find(|r| r.quantity == "drape_coefficient")?;
    Some((result.value.parse::<Ratio>().ok()?.si(), &result.method))
}

/// The ring between disc and rim.
struct Ring {
    seed: u64,
    cells: [usize; 2],
    inner: f64,
    outer: f64,
}

impl Ring {
    fn of(problem: &DrapeProblem) -> Self {
        let Annulus { inner_diameter, diameter, cells, .. } = problem.ring;
        let (inner, outer) = (0.5 * inner_diameter.si(), 0.5 * diameter.si());
        Self { seed: problem.layout.seed, cells, inner, outer }
    }

    fn refined(&self) -> Self {
        Self { cells: self.cells.map(|n| 2 * n), ..*self }
    }

    /// The model of the problem with the cells of this ring.
    fn model(
        &self,
        case: &Case,
        problem: &DrapeProblem,
        section: &ShellSection,
    ) -> Result<Model, StudyError> {
        let outline = Outline::Annulus(Annulus { cells: self.cells, ..problem.ring });
        let sheet = Sheet { outline, ..problem.sheet() };
        build::model(case, &sheet, &problem.mounting, (&problem.loads(), &[]), section.clone())
    }

    /// The flat ring, waved by folds whose place along the rim is random, but the same always.
    fn start(&self, model: &Model, folds: usize) -> State {
        let mut random = Pcg64Mcg::seed_from_u64(self.seed ^ folds as u64);
        let phase: f64 = random.random_range(0.0..std::f64::consts::TAU);
        let (n, width) = (folds as f64, self.outer - self.inner);
        let mut state = State::rest(&model.mesh);
        for (i, p) in model.mesh.nodes.iter().enumerate() {
            let (r, t) = (p.x.hypot(p.y), p.y.atan2(p.x));
            let part = (r - self.inner).max(0.0) / width;
            let (sin, cos) = (n * t + phase).sin_cos();
            let height = START_HEIGHT * width * part * part;
            // Slopes along the radius and around.
            let (along, around) =
                (2.0 * START_HEIGHT * part * (cos - 1.0), -START_HEIGHT * width * part * part * n * sin / r);
            let (x, y) = (p.x / r, p.y / r);
            let (dx, dy) = (along * x - around * y, along * y + around * x);
            state.position[i].z += height * (cos - 1.0);
            state.rotation[i] = UnitQuaternion::from_scaled_axis(Vector3::new(dy, -dx, 0.0));
        }
        state
    }

    fn relax(
        &self,
        model: &Model,
        law: Option<&SheetLaw>,
        plan: &Plan,
        from: State,
        options: &Options,
        watch: Watch<'_>,
    ) -> Result<Solution, NonlinearError> {
        let settings = Settings { tolerance: TOLERANCE, law: law.cloned(), ..Settings::default() };
        let observe =
            |_: &Step<'_>| if (watch.stopped)() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        descend_from(model, plan, from, &settings, STEPS, options, observe)
    }

    fn state(&self, model: &Model, solution: &Solution, start: usize) -> DrapeState {
        let mesh = &model.mesh;
        let [now, rest] = [projected(&solution.state), projected(&State::rest(mesh))];
        let area = |points: &[[f64; 2]], quads: &[[u32; 4]]| shadow::area(points, quads, self.inner);
        let (disc, specimen) = (area(&[], &[]), area(&rest, &mesh.quads));
        let rim: Vec<f64> = now[now.len() - self.cells[1]..].iter().map(|p| p[0].hypot(p[1])).collect();
        let load = model.load_vector();
        let work: f64 = solution
            .state
            .position
            .iter()
            .zip(&mesh.nodes)
            .zip(load.chunks_exact(6))
            .map(|((now, rest), f)| (now - rest).dot(&Vector3::new(f[0], f[1], f[2])))
            .sum();
        DrapeState {
            start,
            elements: mesh.quads.len(),
            coefficient: (area(&now, &mesh.quads) - disc) / (specimen - disc),
            folds: Folds::of(&rim),
            energy: solution.energy - work,
            strain_energy: solution.energy,
            residual: solution.residual,
            negative_pivots: solution.stability.negative_pivots,
            lowest_eigenvalue: solution.stability.lowest_eigenvalue,
            iterations: solution.iterations,
        }
    }
}

/// Nodes seen from above (m).
fn projected(state: &State) -> Vec<[f64; 2]> {
    state.position.iter().map(|p| [p.x, p.y]).collect()
}

fn findings(
    case: &Case,
    meshes: &[DrapeState],
    failed: &[(usize, NonlinearError)],
    searches: usize,
    elastic: bool,
) -> Vec<Finding> {
    let mut facts = Vec::new();
    if elastic {
        facts.push(StudyFact::ElasticDrape {});
    }
    if !failed.is_empty() {
        let starts = failed.iter().map(|(start, _)| *start).collect();
        facts.push(StudyFact::FailedSearches { starts, searches });
    }
    if let Some(finest) = meshes.last().filter(|s| s.negative_pivots > 0) {
        facts.push(StudyFact::UnstableDrape { directions: finest.negative_pivots });
    }
    if let [.., coarser, finest] = meshes {
        let change = finest.coefficient - coarser.coefficient;
        if change.abs() > MESH_ERROR {
            facts.push(StudyFact::CoarseDrape { elements: finest.elements, change });
        }
    }
    facts.into_iter().map(|fact| Finding::new(fact).at(Place::file(&case.path))).collect()
}

#[cfg(test)]
mod tests;
