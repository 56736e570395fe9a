//! The Cusick drape: a round sheet on a smaller disc hangs down under its own weight.
//!
//! ```text
//!        ____________            the sheet between disc and rim is a ring, clamped at the disc;
//!    .-''|   disc   |''-.        its shadow over its area at rest is the drape coefficient
//!   /    '----------'    \       (A_shadow - A_disc) / (A_specimen - A_disc)
//! ```
//! The equilibria are many: a sheet hangs in four folds, or five, or six, and its coefficient moves by
//! ten points between them. So there are several searches, each from a sheet that is given its number
//! of folds at the start; every one ends in a stable equilibrium with whatever folds it then has. The searches begin on
//! cells of twice the width, where the mesh can be made of such: most of the way is gone there. The result is the state of
//! lowest energy, refined, and the band of the coefficients of all states whose energy is nearly as low.
//!
//! A sheet with friction is hung, and then shaken: its weight swings about itself, less and less. A sheet that is laid on a disc by
//! hands has been through more than the way down from flat, and what friction holds up in it is less.

mod faces;
mod interference;
mod method;
mod refine;
mod rim;
mod search;
mod shadow;

use std::collections::BTreeMap;

use nalgebra::{UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub use faces::{Faces, hang_by_face};
pub use method::as_measured;
pub use rim::Folds;

use self::search::{Cloth, Found, Hanging, Searches, WORTH_CARRYING};
use super::effort::within_limits;
use super::{Case, StudyError, Watch, build, refused};
use crate::case::{Annulus, DrapeProblem, Outline, Problem, Sheet};
use crate::characterise::FabricSheet;
use crate::fields::{Resultants, element_means_moved};
use crate::finding::{Finding, Located, Place, StudyFact};
use crate::kes::DrapeMethod;
use crate::law::Mode;
use crate::model::Model;
use crate::section::{SheetLaw, ShellSection};
use crate::solve::Options;
use crate::solve::nonlinear::{NonlinearError, Solution, State};

/// A draped sheet.
#[derive(Clone, Debug)]
pub struct Drape {
    /// Name of the case.
    pub case: String,
    /// The states that the searches ended in, on the mesh of the case, lowest energy first; those whose energy was
    /// clearly higher on the wide cells where the searches began are left out.
    pub states: Vec<DrapeState>,
    /// Folds at the start of the searches that did not, and why.
    pub failed: Vec<(usize, NonlinearError)>,
    /// The state of lowest energy before it was shaken, on the mesh of its search; of sheets with friction only.
    pub hung: Option<DrapeState>,
    /// Energy above the lowest, relative to it, of states that a real sheet may hang in as well: two hundredths, and of a quick
    /// drape five, as its states are those on wide cells and a finer mesh may find them in another order.
    pub near_energy: f64,
    /// The state of lowest energy on each mesh, from that of the case to the finest.
    pub meshes: Vec<DrapeState>,
    /// The last of them.
    pub finest: DrapeState,
    /// The same with bending that differs by face; `None` where that was not asked for, [`hang_by_face`].
    pub faces: Option<Faces>,
    /// The model on the finest mesh.
    pub model: Model,
    /// The equilibrium on the finest mesh.
    pub solution: Solution,
    /// Its resultants in each element, in the axes of the elements as they have turned.
    pub resultants: Vec<Resultants>,
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
    /// Folds that the sheet was given at the start of the first search that ended in it.
    pub start: usize,
    /// How many searches ended in it.
    pub searches: usize,
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
    /// The lowest and the highest coefficient of the states [near](Self::near) the one of lowest energy, moved by what
    /// refinement changed in that one.
    pub fn band(&self) -> [f64; 2] {
        let all = self.near().iter().map(|s| s.coefficient + self.refinement_change());
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], c| [l.min(c), h.max(c)])
    }

    /// States whose energy is above the lowest by [`near_energy`](Self::near_energy) at most: a real sheet may hang in any of them.
    pub fn near(&self) -> &[DrapeState] {
        let lowest = self.states.first().map_or(0.0, |s| s.energy);
        let near = self.states.partition_point(|s| s.energy - lowest <= self.near_energy * lowest.abs());
        &self.states[..near]
    }

    /// The mean coefficient of the states near the one of lowest energy, each as often as searches ended in it, moved as the band.
    pub fn mean(&self) -> f64 {
        let near = self.near();
        let sum: f64 = near.iter().map(|s| s.searches as f64 * s.coefficient).sum();
        sum / near.iter().map(|s| s.searches as f64).sum::<f64>() + self.refinement_change()
    }

    /// How many searches ended in a state with a number of folds near the lowest energy, by that number.
    pub fn fold_numbers(&self) -> BTreeMap<usize, usize> {
        let mut numbers = BTreeMap::new();
        self.near().iter().for_each(|s| *numbers.entry(s.folds.count).or_default() += s.searches);
        numbers
    }

    /// What refinement changed in the coefficient of the state of lowest energy.
    fn refinement_change(&self) -> f64 {
        self.states.first().map_or(0.0, |lowest| self.finest.coefficient - lowest.coefficient)
    }
}

/// Energy above the lowest, relative to it, of states that a real sheet may hang in as well.
const NEARLY_AS_LOW: f64 = 0.02;

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
    let DrapeProblem { folds, refinements, .. } = &**problem;
    within_limits(case, &case.options(options)?)?;
    let single = Options { threads: 1, ..case.options(options)? };
    let cloth = Cloth { case, problem, section, law, watch };
    let sheet = Hanging::new(&cloth, Ring::of(problem), &single)?;
    build::weighed(&sheet.model)?;
    let Searches { found, mut failed } = sheet.searches(folds, &single)?;
    watch.not_stopped()?;
    let Some(lowest) = found.first() else {
        // `folds` is not empty, so there is a failure.
        return Err(failed.swap_remove(0).1.into());
    };
    let Found { mut solution, state, hung } = lowest.clone();
    let (start, mut sheet, mut finest, mut meshes) = (state.start, sheet, state.clone(), vec![state]);
    for _ in 0..*refinements {
        let finer = Hanging::new(&cloth, sheet.ring.refined(), options)?;
        solution = finer.relax(finer.carried(&sheet, &solution.state), options)?;
        watch.not_stopped()?;
        finest = finer.state(&solution, start);
        meshes.push(finest.clone());
        (watch.stage)();
        sheet = finer;
    }
    let states: Vec<DrapeState> = found.into_iter().map(|found| found.state).collect();
    let not_kept = sheet.not_kept_apart(&solution.state, options);
    let Hanging { ring, model, .. } = sheet;
    let resultants = element_means_moved(&model, &solution.state, law)?;
    let outline = shadow::outline(&projected(&solution.state), &model.mesh.quads, ring.inner, 360);
    let shaken = hung.as_ref().map(|state| StudyFact::ShakenDrape {
        shaking: problem.shaking,
        coefficient: state.coefficient,
        elements: state.elements,
    });
    let slips = law.is_some_and(|law| law.mode != Mode::Elastic);
    let of_law = if !slips { Some(StudyFact::ElasticDrape {}) } else { shaken };
    let mut findings = findings(case, problem, &meshes, &failed, [of_law, not_kept]);
    findings.extend(interference::of(case, &model, &solution.state, ring.inner));
    Ok(Drape {
        case: case.name.clone(),
        states,
        failed,
        hung,
        near_energy: if problem.is_quick { WORTH_CARRYING } else { NEARLY_AS_LOW },
        meshes,
        finest,
        faces: None,
        model,
        solution,
        resultants,
        disc_radius: ring.inner,
        sheet_radius: ring.outer,
        outline,
        findings,
    })
}

/// How often [`Watch::stage`] is called for a case.
pub fn drape_stages(case: &Case) -> usize {
    match &case.problem {
        Problem::Drape(problem) => problem.folds.len() + problem.refinements,
        Problem::Sheet(_) | Problem::InstrumentTest(_) | Problem::BendingTest(_) => 0,
    }
}

/// What was measured of a fabric's drape, `drape_coefficient` (0 to 1) or `drape_nodes`, and its method: the first with disc and sheet of these
/// diameters (m). Coefficients of other sizes are not to be compared.
pub fn measured_drape<'s>(
    sheet: &'s FabricSheet,
    quantity: &str,
    [disc, diameter]: [f64; 2],
) -> Option<(f64, &'s str)> {
    let is_same = |(_, method): &(f64, &str)| !DrapeMethod::read(method).differs(disc, diameter);
    measured_drapes(sheet, quantity).find(is_same)
}

fn measured_drapes<'s>(sheet: &'s FabricSheet, quantity: &str) -> impl Iterator<Item = (f64, &'s str)> {
    let results = sheet.info.results.iter().filter(move |result| result.quantity == quantity);
    results.filter_map(|result| Some((result.si()?.0, result.method.as_str())))
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

    /// The ring with cells of twice the width, where a sheet can be made of them.
    fn widened(&self) -> Option<Self> {
        DrapeProblem::wider(self.cells).map(|cells| Self { cells, ..*self })
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
}

/// Nodes seen from above (m).
fn projected(state: &State) -> Vec<[f64; 2]> {
    state.position.iter().map(|p| [p.x, p.y]).collect()
}

fn findings(
    case: &Case,
    problem: &DrapeProblem,
    meshes: &[DrapeState],
    failed: &[(usize, NonlinearError)],
    of_sheet: [Option<StudyFact>; 2],
) -> Vec<Finding> {
    let mut facts: Vec<StudyFact> = of_sheet.into_iter().flatten().collect();
    if !failed.is_empty() {
        let starts = failed.iter().map(|(start, _)| *start).collect();
        facts.push(StudyFact::FailedSearches { starts, searches: problem.folds.len() });
    }
    if let Some(finest) = meshes.last().filter(|s| s.negative_pivots > 0) {
        facts.push(StudyFact::UnstableDrape { directions: finest.negative_pivots });
    }
    if let [.., coarser, finest] = meshes {
        let change = finest.coefficient - coarser.coefficient;
        if problem.is_quick {
            facts.push(StudyFact::QuickDrape { elements: finest.elements, change });
        } else if change.abs() > MESH_ERROR {
            facts.push(StudyFact::CoarseDrape { elements: finest.elements, change });
        }
    }
    facts.into_iter().map(|fact| Finding::new(fact).at(Place::file(&case.path))).collect()
}

#[cfg(test)]
mod tests;
