//! The equations of a model in large rotations: forces, tangent, and the motion of the nodes.

mod apart;
mod presses;
mod rates;
mod stress;
mod supported;

use std::sync::Arc;

use nalgebra::{Matrix3, Point3, UnitQuaternion, Vector3};

pub(super) use stress::Stressing;

use super::contact::{Press, Surfaces};
use super::layers::{Contact, Layers};
use super::sheet::{Answer, Forces, Sheet};
use super::{NonlinearError, Settings, State};
use crate::element::corotational::Motion;
use crate::element::{Matrix24, Vector24, follower_pressure, lumped_mass};
use crate::model::rigid::lever;
use crate::model::{DofGroup, Links, Model, ModelError};
use crate::platform;
use crate::solve::SolveError;
use crate::solve::assemble::{scatter, unit_rows};
use crate::solve::factor::{Factor, FactorError};
use crate::solve::linear::Options;
use crate::solve::plan::Plan;
use crate::solve::sparse::BlockMatrix;

/// What depends on the mesh, the bodies and the hard supports only, shared by every model on them.
///
/// # Errors
/// M009, M010 for supports and bodies; N002 for memory.
pub fn plan(model: &Model, options: &Options) -> Result<Plan, NonlinearError> {
    Ok(Plan::direct(model, &[DofGroup::Shell], options)?)
}

/// Elements whose tangents are held at a time before they are added up in order.
const BATCH: usize = 512;

/// What does not change while a model deforms. Vectors hold six numbers a node; followers of a
/// rigid body have theirs added to the lead's and count as held.
pub(super) struct System<'a> {
    pub model: &'a Model,
    pub plan: &'a Plan,
    threads: usize,
    sheet: Sheet<'a>,
    contact: Surfaces<'a>,
    /// The layers of a sheet that keep apart.
    layers: Option<Layers<'a>>,
    links: Arc<Links>,
    /// Dead loads at factor 1.
    load: Vec<f64>,
    /// Follower pressure at factor 1 (Pa).
    pressure: f64,
    /// Loads at factor 0, where there are any.
    pub before: Option<Before>,
    /// Whether a dof is held.
    pub held: Vec<bool>,
    /// Values of the held dofs at factor 1.
    pub values: Vec<f64>,
    /// Area of each node (m²), and that times h²/12 for its rotations: the metric of the flow and
    /// of the eigenvalues.
    pub metric: Vec<f64>,
    /// Areas of the elements (m²).
    areas: Vec<f64>,
    /// Length that makes moments comparable with forces: the mean side of an element (m).
    side: f64,
    /// Diagonal of the sheet at rest (m).
    pub size: f64,
}

/// Loads at the start of a load step.
pub(super) struct Before {
    /// Dead ones, six a node.
    pub load: Vec<f64>,
    /// Follower pressure (Pa).
    pub pressure: f64,
    /// Norm of loads or reactions, whichever is larger (N): a step that takes them away ends with nothing to compare with.
    pub scale: f64,
}

/// The forces in a state.
pub(super) struct Balance {
    answers: Vec<Answer>,
    /// Nodes at rigid surfaces.
    presses: Vec<Press>,
    /// Layers that press each other.
    contacts: Vec<Contact>,
    /// Internal minus external forces at each node, followers not yet added to their leads.
    nodal: Vec<f64>,
    /// Internal minus external forces by dof: the reactions where held, what must vanish elsewhere.
    pub unbalanced: Vec<f64>,
    /// Energy stored, that of layers that press each other with it (J).
    pub energy: f64,
    /// Norm of what must vanish (N).
    pub residual: f64,
    /// Norm of loads or reactions, whichever is larger, now or at the start of a load step (N).
    pub scale: f64,
}

impl<'a> System<'a> {
    /// Of a model; `plan` is that of [`plan`](super::plan) for its mesh and bodies.
    pub fn new(
        model: &'a Model,
        plan: &'a Plan,
        settings: &'a Settings,
        options: &Options,
    ) -> Result<Self, NonlinearError> {
        let nodes = model.mesh.nodes.len();
        let links = Arc::clone(&plan.pattern.links);
        if let Some(own) = links.first_own_axes() {
            return Err(SolveError::from(own.in_large_rotations(model)).into());
        }
        let held = model.held(&links).map_err(SolveError::from)?;
        let [low, high] = model.mesh.bounds();
        let mut system = Self {
            model,
            plan,
            threads: options.threads,
            sheet: Sheet::new(model, settings.law.as_ref()),
            contact: Surfaces::new(&[], &model.mesh, &[], [0.0; 2]),
            layers: None,
            links,
            load: model.dead_load_vector(),
            pressure: model.follower_pressure(),
            before: None,
            held: held.iter().map(Option::is_some).collect(),
            values: held.iter().map(|c| c.unwrap_or(0.0)).collect(),
            metric: vec![0.0; 6 * nodes],
            areas: Vec::with_capacity(model.mesh.quads.len()),
            side: 0.0,
            size: (high - low).norm(),
        };
        system.prepare_elements()?;
        let of_sheet = [system.stiffest(), system.size];
        system.contact = Surfaces::new(&settings.surfaces, &model.mesh, &system.metric, of_sheet);
        Ok(system)
    }

    /// Elements at rest; equal ones in a row share their matrices.
    fn prepare_elements(&mut self) -> Result<(), SolveError> {
        let mesh = &self.model.mesh;
        let unit = crate::section::ShellSection { areal_density: 1.0, ..self.model.section.clone() };
        for quad in 0..mesh.quads.len() {
            if quad % BATCH == 0 {
                SolveError::in_time()?;
            }
            let element = self.model.element(quad, false).map_err(ModelError::from)?;
            let same = quad > 0 && {
                let (now, last) = (mesh.corners(quad), mesh.corners(quad - 1));
                let off = |i: usize| ((now[i] - now[0]) - (last[i] - last[0])).amax();
                (1..4).map(off).fold(0.0, f64::max) <= 1e-12 * element.frame.longest_side()
            };
            self.sheet.push(&element, self.model, same);
            let rotary = element.frame.area() / 12.0;
            for (node, share) in self.plan.pattern.quads[quad].iter().zip(lumped_mass(&element.frame, &unit))
            {
                for d in 0..6 {
                    self.metric[6 * *node as usize + d] += if d < 3 { share } else { share * rotary };
                }
            }
            self.areas.push(element.frame.area());
        }
        self.side = (self.areas.iter().sum::<f64>() / mesh.quads.len().max(1) as f64).sqrt();
        Ok(())
    }

    /// Applies `f` to every index, in parallel if asked for; the results are in order.
    fn each<T: Send>(&self, range: std::ops::Range<usize>, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        if self.threads > 1 { platform::map(range, f) } else { range.map(f).collect() }
    }

    /// Forces in a state, with the loads times its factor and `extra` loads on top.
    pub fn balance(&self, state: &State, extra: Option<&[f64]>) -> Balance {
        let mesh = &self.model.mesh;
        let answers = self.each(0..mesh.quads.len(), |q| {
            let nodes = mesh.quads[q].map(|n| n as usize);
            let (x, r) = (nodes.map(|n| state.position[n]), nodes.map(|n| state.rotation[n]));
            self.sheet.answer(q, &state.memory, &x, &r)
        });
        let mut external = self.dead_loads(state.factor);
        if let Some(extra) = extra {
            external.iter_mut().zip(extra).for_each(|(f, e)| *f += e);
        }
        let pressure = self.pressure_at(state.factor);
        if pressure != 0.0 {
            self.add_pressure(state, pressure, &mut external);
        }
        let mut nodal: Vec<f64> = external.iter().map(|f| -f).collect();
        let mut energy = 0.0;
        for (quad, answer) in mesh.quads.iter().zip(&answers) {
            for (i, node) in quad.iter().enumerate() {
                for d in 0..6 {
                    nodal[6 * *node as usize + d] += answer.nodal[6 * i + d];
                }
            }
            energy += answer.energy;
        }
        let presses = self.contact.presses(&state.position, &state.memory);
        for press in &presses {
            let force = press.force();
            (0..3).for_each(|d| nodal[6 * press.node + d] -= force[d]);
        }
        let contacts = self.layers.as_ref().map_or_else(Vec::new, |layers| layers.contacts(&state.position));
        for contact in &contacts {
            energy += contact.energy;
            for (i, node) in contact.nodes.iter().enumerate() {
                let force = contact.force(i);
                (0..3).for_each(|d| nodal[6 * *node as usize + d] -= force[d]);
            }
        }
        let unbalanced = self.to_leads(state, &nodal);
        let residual = self.norm(&unbalanced, false);
        let loads = self.to_leads(state, &external);
        let scale = self.norm(&unbalanced, true).max(self.norm(&loads, false));
        let scale = self.before.as_ref().map_or(scale, |before| scale.max(before.scale));
        Balance { answers, presses, contacts, nodal, unbalanced, energy, residual, scale }
    }

    /// Norm of the forces on the held or the free dofs (N), moments over the side of an element.
    pub fn norm(&self, forces: &[f64], held: bool) -> f64 {
        let square = |(d, f): (usize, &f64)| if d % 6 < 3 { f * f } else { (f / self.side).powi(2) };
        forces.iter().enumerate().filter(|(d, _)| self.held[*d] == held).map(square).sum::<f64>().sqrt()
    }

    /// Adds the forces of followers to their leads.
    pub fn to_leads(&self, state: &State, nodal: &[f64]) -> Vec<f64> {
        let mut reduced = nodal.to_vec();
        for node in self.links.followers() {
            let (force, moment) = (vector(nodal, 6 * node), vector(nodal, 6 * node + 3));
            let moment = moment + lever(&state.position, &self.links.leads, node).cross(&force);
            let at = 6 * self.links.leads[node] as usize;
            reduced[6 * node..][..6].fill(0.0);
            for d in 0..3 {
                reduced[at + d] += force[d];
                reduced[at + 3 + d] += moment[d];
            }
        }
        reduced
    }

    /// Adds the forces of a follower pressure (Pa) on the nodes.
    fn add_pressure(&self, state: &State, pressure: f64, nodal: &mut [f64]) {
        for (q, quad) in self.model.mesh.quads.iter().enumerate() {
            let forces = follower_pressure(&self.corners(state, q), pressure);
            for (node, force) in quad.iter().zip(forces) {
                (0..3).for_each(|d| nodal[6 * *node as usize + d] += force[d]);
            }
        }
    }

    /// Where the corners of an element are.
    fn corners(&self, state: &State, quad: usize) -> [Point3<f64>; 4] {
        self.model.mesh.quads[quad].map(|n| state.position[n as usize])
    }

    /// Takes the follower pressure from a tangent. The part that is not symmetric belongs to free edges; without
    /// it Newton's method is still quick, but no longer quadratic there.
    fn soften(&self, state: &State, quad: usize, k: &mut Matrix24) {
        let pressure = self.pressure_at(state.factor);
        if pressure == 0.0 {
            return;
        }
        self.take_pressure(&self.corners(state, quad), pressure, k);
    }

    /// Dead loads at a factor, six a node.
    fn dead_loads(&self, factor: f64) -> Vec<f64> {
        let mut loads: Vec<f64> = self.load.iter().map(|f| f * factor).collect();
        if let Some(before) = &self.before {
            loads.iter_mut().zip(&before.load).for_each(|(f, b)| *f += b * (1.0 - factor));
        }
        loads
    }

    /// Follower pressure at a factor (Pa).
    fn pressure_at(&self, factor: f64) -> f64 {
        self.pressure * factor + self.before.as_ref().map_or(0.0, |before| before.pressure * (1.0 - factor))
    }

    /// What the loads grow by from factor 0 to 1, by dof.
    pub fn reference_load(&self, state: &State) -> Vec<f64> {
        let (mut nodal, mut pressure) = (self.load.clone(), self.pressure);
        if let Some(before) = &self.before {
            nodal.iter_mut().zip(&before.load).for_each(|(f, b)| *f -= b);
            pressure -= before.pressure;
        }
        if pressure != 0.0 {
            self.add_pressure(state, pressure, &mut nodal);
        }
        self.to_leads(state, &nodal)
    }

    /// All loads in a state, by dof.
    pub fn loads(&self, state: &State) -> Vec<f64> {
        if self.before.is_none() {
            return self.reference_load(state).iter().map(|f| f * state.factor).collect();
        }
        self.loads_of(state, &self.dead_loads(state.factor), self.pressure_at(state.factor))
    }

    /// Sum of the sizes of the nodal loads at factor 1 (N).
    pub fn total_load(&self) -> f64 {
        self.model.load_vector().chunks_exact(6).map(|n| n[0].hypot(n[1]).hypot(n[2])).sum()
    }

    /// Area of each node; 0 off the sheet (m²).
    pub fn areas_of_nodes(&self) -> Vec<f64> {
        self.metric.iter().step_by(6).copied().collect()
    }

    /// The order of the largest eigenvalue per area: the membrane of an element (N/m³).
    pub fn stiffest(&self) -> f64 {
        self.model.section.d_m.diagonal().max() / (self.side * self.side)
    }

    /// Tangent with `shift` times the metric added, held dofs as unit rows, and the forces that the
    /// held values at factor 1 exert on the free dofs.
    ///
    /// `forces` are the element forces that enter the geometric stiffness.
    pub fn tangent(
        &self,
        state: &State,
        balance: &Balance,
        forces: &[Forces],
        shift: f64,
    ) -> (BlockMatrix, Vec<f64>) {
        self.tangent_of(state, balance, forces, shift, 1.0)
    }

    /// The same with the stiffnesses of the elements times `stiffening`.
    pub fn tangent_of(
        &self,
        state: &State,
        balance: &Balance,
        forces: &[Forces],
        shift: f64,
        stiffening: f64,
    ) -> (BlockMatrix, Vec<f64>) {
        let coupling =
            self.layers.as_ref().and_then(|l| l.coupling(&self.links, &state.position, &balance.contacts));
        let pattern = coupling.as_ref().map_or(&self.plan.pattern, |coupling| &coupling.pattern);
        let mut matrix = BlockMatrix::zeros(Arc::clone(&pattern.graph), 6);
        let mut push = vec![0.0; self.held.len()];
        let pushes = self.values.iter().any(|v| *v != 0.0);
        let of_element = |q: usize| {
            let answer = &balance.answers[q];
            let mut k = self.sheet.stiffness(q, answer);
            if stiffening != 1.0 {
                k.scale_mut(stiffening);
            }
            self.sheet.add_geometric(q, answer, &forces[q], &mut k);
            let mut k = answer.motion.tangent(&k, &forces[q].local);
            self.soften(state, q, &mut k);
            let push = self.constrain(state, q, &mut k, pushes);
            (k, push)
        };
        let mut add = |q: usize, (k, forces): (Matrix24, Option<Vector24>)| {
            let nodes = &pattern.quads[q];
            scatter(k.as_slice(), 6, nodes, &pattern.blocks[q], &mut matrix);
            let Some(forces) = forces else { return };
            for (i, node) in nodes.iter().enumerate() {
                (0..6).for_each(|d| push[6 * *node as usize + d] += forces[6 * i + d]);
            }
        };
        if self.threads > 1 {
            for start in (0..pattern.quads.len()).step_by(BATCH) {
                let batch = start..(start + BATCH).min(pattern.quads.len());
                platform::map(batch.clone(), of_element).into_iter().zip(batch).for_each(|(k, q)| add(q, k));
            }
        } else {
            // One after the other, none is kept.
            (0..pattern.quads.len()).for_each(|q| add(q, of_element(q)));
        }
        self.add_body_terms(state, &balance.nodal, &mut matrix);
        let presses = balance.presses.iter().map(|press| (press.node, press.stiffness));
        self.add_presses(state, presses, &mut matrix, &mut push);
        self.add_contacts(state, &balance.contacts, &mut matrix, &mut push);
        let graph = &pattern.graph;
        for dof in (0..self.held.len()).filter(|d| !self.held[*d]) {
            matrix.values[graph.col_ptr[dof / 6] * 36 + (dof % 6) * 7] += shift * self.metric[dof];
        }
        unit_rows(&mut matrix, &self.held);
        (matrix, push)
    }

    /// Moves the stiffness of followers to their leads, empties the rows and columns of held dofs,
    /// and returns the forces of their values if they are asked for.
    pub fn constrain(&self, state: &State, q: usize, k: &mut Matrix24, pushes: bool) -> Option<Vector24> {
        let nodes = &self.model.mesh.quads[q];
        for (i, node) in nodes.iter().enumerate() {
            if self.links.leads[*node as usize] == *node {
                continue;
            }
            // du = du_lead + dω x r.
            let lever = lever(&state.position, &self.links.leads, *node as usize).cross_matrix();
            let columns = k.fixed_columns::<3>(6 * i + 3) - k.fixed_columns::<3>(6 * i) * lever;
            k.fixed_columns_mut::<3>(6 * i + 3).copy_from(&columns);
            let rows = k.fixed_rows::<3>(6 * i + 3) + lever * k.fixed_rows::<3>(6 * i);
            k.fixed_rows_mut::<3>(6 * i + 3).copy_from(&rows);
        }
        let dof = |a: usize| 6 * self.plan.pattern.quads[q][a / 6] as usize + a % 6;
        let mut push = pushes.then(|| *k * Vector24::from_fn(|a, _| self.values[dof(a)]));
        for a in (0..24).filter(|a| self.held[dof(*a)]) {
            k.row_mut(a).fill(0.0);
            k.column_mut(a).fill(0.0);
            push.iter_mut().for_each(|push| push[a] = 0.0);
        }
        push
    }

    /// Forces on followers (`nodal`, six a node) turn with the body: `n (r · dω) - ...` on the rotation of
    /// the lead.
    pub fn add_body_terms(&self, state: &State, nodal: &[f64], matrix: &mut BlockMatrix) {
        let graph = Arc::clone(&matrix.graph);
        for node in self.links.followers() {
            let lead = self.links.leads[node] as usize;
            let lever = lever(&state.position, &self.links.leads, node).cross_matrix();
            let term: Matrix3<f64> = vector(nodal, 6 * node).cross_matrix() * lever;
            let at = graph.col_ptr[lead] * 36;
            for (row, column) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                if !self.held[6 * lead + 3 + row] && !self.held[6 * lead + 3 + column] {
                    matrix.values[at + (column + 3) * 6 + row + 3] +=
                        0.5 * (term[(row, column)] + term[(column, row)]);
                }
            }
        }
    }

    pub fn factorise(&self, matrix: &BlockMatrix) -> Result<Factor, FactorError> {
        let coupling = self.layers.as_ref().and_then(|layers| layers.coupling_of(matrix));
        let analysis = match &coupling {
            Some(coupling) => coupling.analysis()?,
            None => &self.plan.groups[0].1,
        };
        analysis.factorise_indefinite(matrix, analysis.worth(self.threads))
    }

    /// Moves the nodes by a step of the dofs: rotations compose, bodies stay rigid.
    pub fn advance(&self, state: &mut State, step: &[f64]) {
        let before = state.position.clone();
        for node in 0..before.len() {
            let lead = self.links.leads[node] as usize;
            let turn = UnitQuaternion::from_scaled_axis(vector(step, 6 * lead + 3));
            state.position[node] =
                before[lead] + vector(step, 6 * lead) + turn * (before[node] - before[lead]);
            let mut rotation = turn * state.rotation[node];
            rotation.renormalize();
            state.rotation[node] = rotation;
        }
    }

    /// Largest rotation of a node against its element (rad).
    pub fn largest_rotation(balance: &Balance) -> f64 {
        balance.answers.iter().map(|a| Motion::largest_rotation(&a.motion)).fold(0.0, f64::max)
    }

    /// Keeps what the sheet has been through on the way to a state.
    pub fn remember(&self, balance: &Balance, state: &mut State) {
        self.sheet.remember(&balance.answers, &mut state.memory);
        self.contact.remember(&balance.presses, &mut state.memory);
    }

    /// Gives the forces of rigid surfaces in an equilibrium to their multipliers; whether it is one no longer.
    pub fn augment(&self, balance: &Balance, state: &mut State) -> bool {
        self.contact.augment(&balance.presses, &mut state.memory)
    }

    /// Reactions at the held dofs; 0 elsewhere.
    pub fn reactions(&self, balance: &Balance) -> Vec<f64> {
        balance.unbalanced.iter().zip(&self.held).map(|(f, held)| if *held { *f } else { 0.0 }).collect()
    }
}

impl Balance {
    /// Forces of the elements.
    pub fn forces(&self) -> Vec<Forces> {
        self.answers.iter().map(|a| a.forces).collect()
    }

    /// Deformations of the elements in their frames.
    pub fn deformations(&self) -> impl Iterator<Item = &Vector24> {
        self.answers.iter().map(|a| &a.motion.deformation)
    }
}

/// Three entries as a vector.
fn vector(values: &[f64], at: usize) -> Vector3<f64> {
    Vector3::new(values[at], values[at + 1], values[at + 2])
}
