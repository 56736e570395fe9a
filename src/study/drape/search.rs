//! The searches of a drape: from flat sheets with folds to the states that they hang in.

use nalgebra::Vector3;

use super::{DrapeState, Folds, Ring, projected, refine, shadow};
use crate::case::DrapeProblem;
use crate::finding::StudyFact;
use crate::law::Mode;
use crate::mesh::crossings;
use crate::model::Model;
use crate::platform;
use crate::section::{SheetLaw, ShellSection};
use crate::solve::nonlinear::{
    NonlinearError, Settings, Solution, State, Step, descend_from, layers_in_touch, plan, shake,
};
use crate::solve::{Options, Plan};
use crate::study::{Case, StudyError, Watch};

/// Unbalanced forces that are accepted, relative to the weight or the reactions.
pub(super) const TOLERANCE: f64 = 1e-6;

/// Steps of a search that flows.
const STEPS: usize = 600;

/// Energy above the lowest on wide cells, relative to it, with which a state is carried to the mesh of the case. The states of
/// ten published fabrics that were the lowest there were up to 3.1 % above the lowest on wide cells.
pub(super) const WORTH_CARRYING: f64 = 0.05;

/// Relative difference of energies, and difference of coefficients, of states that are the same.
const SAME: f64 = 1e-3;

/// Swings of a sheet that is shaken.
const SWINGS: i32 = 5;

/// What hangs, and who watches.
pub(super) struct Cloth<'a> {
    pub case: &'a Case,
    pub problem: &'a DrapeProblem,
    pub section: &'a ShellSection,
    pub law: Option<&'a SheetLaw>,
    pub watch: Watch<'a>,
}

/// A ring with its model.
pub(super) struct Hanging<'a> {
    cloth: &'a Cloth<'a>,
    pub ring: Ring,
    pub model: Model,
    plan: Plan,
}

/// Where a search ended.
#[derive(Clone)]
pub(super) struct Found {
    pub solution: Solution,
    pub state: DrapeState,
    /// Before it was shaken, of a sheet with friction.
    pub hung: Option<DrapeState>,
}

/// Where a search ended, or the folds at its start and why it ended nowhere.
type SearchEnd = Result<Found, (usize, NonlinearError)>;

/// Where searches ended.
pub(super) struct Searches {
    /// Each state once, lowest energy first.
    pub found: Vec<Found>,
    /// Folds at the start of the searches that ended nowhere, and why.
    pub failed: Vec<(usize, NonlinearError)>,
}

impl Searches {
    fn sorted(ends: Vec<SearchEnd>) -> Self {
        let (mut all, mut failed) = (Vec::new(), Vec::new());
        for end in ends {
            match end {
                Ok(found) => all.push(found),
                Err(failure) => failed.push(failure),
            }
        }
        all.sort_by(|a: &Found, b: &Found| a.state.energy.total_cmp(&b.state.energy));
        let mut found: Vec<Found> = Vec::new();
        for one in all {
            match found.iter_mut().find(|other| other.state.is_same(&one.state)) {
                Some(same) => same.state.searches += one.state.searches,
                None => found.push(one),
            }
        }
        Self { found, failed }
    }
}

impl DrapeState {
    /// Whether two states on one mesh are the same but for a turn of the whole.
    fn is_same(&self, other: &Self) -> bool {
        self.folds.count == other.folds.count
            && (self.energy - other.energy).abs() <= SAME * self.energy.abs()
            && (self.coefficient - other.coefficient).abs() <= SAME
    }
}

impl<'a> Hanging<'a> {
    pub fn new(cloth: &'a Cloth<'a>, ring: Ring, options: &Options) -> Result<Self, StudyError> {
        let model = ring.model(cloth.case, cloth.problem, cloth.section)?;
        let plan = plan(&model, options)?;
        Ok(Self { cloth, ring, model, plan })
    }

    /// The states that sheets with these folds at the start end in.
    ///
    /// Where the mesh allows it the searches begin on cells of twice the width. States of nearly the lowest energy there
    /// are carried to the mesh itself. If no search on wide cells ends anywhere, all are made on the mesh.
    ///
    /// # Errors
    /// O054 if the work is to stop; the errors of mesh and model.
    pub fn searches(&self, folds: &[usize], options: &Options) -> Result<Searches, StudyError> {
        let (stage, silent) = (self.cloth.watch.stage, &|| ());
        let Some(ring) = self.ring.widened() else { return self.hang_all(folds, options, stage) };
        let wide = Hanging::new(self.cloth, ring, options)?;
        let Searches { found, mut failed } = wide.hang_all(folds, options, stage)?;
        if found.is_empty() {
            return self.hang_all(folds, options, silent);
        }
        let lowest = found.first().map_or(0.0, |f| f.state.energy);
        let highest = lowest + WORTH_CARRYING * lowest.abs();
        let found: Vec<Found> = found.into_iter().filter(|f| f.state.energy <= highest).collect();
        let carried = self.each(&found, |found| {
            let state = &found.state;
            let solution = self.relax(self.carried(&wide, &found.solution.state), options);
            let solution = solution.map_err(|e| (state.start, e))?;
            let state = DrapeState { searches: state.searches, ..self.state(&solution, state.start) };
            Ok(Found { state, solution, hung: found.hung.clone() })
        });
        let mut searches = Searches::sorted(carried?);
        searches.failed.append(&mut failed);
        Ok(searches)
    }

    /// The states that sheets with these folds at the start end in, on this mesh; `stage` is called after each.
    fn hang_all(
        &self,
        folds: &[usize],
        options: &Options,
        stage: &(dyn Fn() + Sync),
    ) -> Result<Searches, StudyError> {
        let ends = self.each(folds, |&start| {
            let found = self.hang_and_shake(start, options);
            stage();
            found.map_err(|e| (start, e))
        });
        Ok(Searches::sorted(ends?))
    }

    /// Searches side by side. Once the work is to stop, none begins, and where those that had begun are is no result.
    fn each<T: Sync>(
        &self,
        from: &[T],
        search: impl Fn(&T) -> SearchEnd + Sync + Send,
    ) -> Result<Vec<SearchEnd>, StudyError> {
        let watch = self.cloth.watch;
        let ends = platform::map(from, |one| watch.not_stopped().map(|()| search(one)));
        watch.not_stopped()?;
        ends.into_iter().collect()
    }

    fn hang_and_shake(&self, start: usize, options: &Options) -> Result<Found, NonlinearError> {
        let mut solution = self.relax(self.ring.start(&self.model, start), options)?;
        let mut hung = None;
        let shaking = self.cloth.problem.shaking;
        let slips = self.cloth.law.is_some_and(|law| law.mode == Mode::Friction);
        if slips && shaking > 0.0 && !self.is_to_stop() {
            hung = Some(self.state(&solution, start));
            let factors: Vec<f64> =
                (0..SWINGS).map(|k| 1.0 + shaking * (-0.5f64).powi(k)).chain([1.0]).collect();
            let touches = layers_in_touch(&self.model, &solution.state).is_some();
            let settings = self.settings(touches && !self.is_tangled(&solution.state));
            solution = shake(&self.model, &self.plan, solution.state, &factors, &settings, options, |_| {
                self.cloth.watch.go_on()
            })?;
            if !touches && layers_in_touch(&self.model, &solution.state).is_some() {
                solution = self.relax(solution.state, options)?;
            }
        }
        Ok(Found { state: self.state(&solution, start), solution, hung })
    }

    /// A state on cells of twice the width, on these.
    pub fn carried(&self, wide: &Self, state: &State) -> State {
        refine::refined(state, &wide.model.mesh, &self.model.mesh, wide.ring.cells)
    }

    fn settings(&self, self_contact: bool) -> Settings {
        Settings { tolerance: TOLERANCE, law: self.cloth.law.cloned(), self_contact, ..Settings::default() }
    }

    /// The equilibrium that a sheet comes to. Where its layers have come to touch they press each other from there on, and where they have passed
    /// through each other it is let down again, and they are kept apart. If that ends nowhere, it is the one that there is.
    pub fn relax(&self, from: State, options: &Options) -> Result<Solution, NonlinearError> {
        let found = self.descend(from.clone(), false, options)?;
        if self.is_to_stop() {
            return Ok(found);
        }
        let again = if !self.is_tangled(&found.state) {
            layers_in_touch(&self.model, &found.state).map(|_| found.state.clone())
        } else {
            // From where layers are in each other they do not come apart.
            (!self.is_tangled(&from)).then_some(from)
        };
        let Some(again) = again else { return Ok(found) };
        match self.descend(again, true, options) {
            Err(NonlinearError::NotConverged { .. }) => Ok(found),
            end => end,
        }
    }

    /// S152 of a sheet whose layers touch, if it is in no equilibrium with what they press each other by.
    pub fn not_kept_apart(&self, state: &State, options: &Options) -> Option<StudyFact> {
        let touches = layers_in_touch(&self.model, state).is_some() && !self.is_tangled(state);
        let cause = touches.then(|| self.descend(state.clone(), true, options).err()).flatten()?;
        let cause = format!("the search that does so came to no equilibrium, {cause}");
        Some(StudyFact::LayersNotKept { cause })
    }

    /// Whether the work is to stop: a search is left where it is.
    fn is_to_stop(&self) -> bool {
        self.cloth.watch.go_on().is_break()
    }

    fn is_tangled(&self, state: &State) -> bool {
        crossings(&state.position, &self.model.mesh.quads).is_some()
    }

    fn descend(
        &self,
        from: State,
        self_contact: bool,
        options: &Options,
    ) -> Result<Solution, NonlinearError> {
        let (settings, observe) = (self.settings(self_contact), |_: &Step<'_>| self.cloth.watch.go_on());
        descend_from(&self.model, &self.plan, from, &settings, STEPS, options, observe)
    }

    pub fn state(&self, solution: &Solution, start: usize) -> DrapeState {
        let (ring, model) = (&self.ring, &self.model);
        let mesh = &model.mesh;
        let [now, rest] = [projected(&solution.state), projected(&State::rest(mesh))];
        let area = |points: &[[f64; 2]], quads: &[[u32; 4]]| shadow::area(points, quads, ring.inner);
        let (disc, specimen) = (area(&[], &[]), area(&rest, &mesh.quads));
        let rim: Vec<f64> = now[now.len() - ring.cells[1]..].iter().map(|p| p[0].hypot(p[1])).collect();
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
            searches: 1,
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
