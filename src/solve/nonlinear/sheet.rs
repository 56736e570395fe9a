//! The elements of a sheet in motion: linear ones with a stiffness that is computed once, or
//! elements whose cells follow laws with a memory.

use nalgebra::{Matrix3, Point3, UnitQuaternion, Vector2, Vector3};

use super::Memory;
use crate::element::corotational::{Motion, ReferenceFrame};
use crate::element::{Arcs, Bent, Cellwise, Matrix24, Prepared, Strains, Vector24, YarnStrain, Yarns};
use crate::law::{self, Response};
use crate::model::Model;
use crate::section::SheetLaw;

/// The elements. Equal ones share their matrices.
pub(super) struct Sheet<'a> {
    law: Option<&'a SheetLaw>,
    /// Membrane stiffness along the material axes of what follows no law (N/m).
    d_m: Matrix3<f64>,
    references: Vec<ReferenceFrame>,
    /// Which matrices each element has.
    kinds: Vec<u32>,
    yarns: Vec<Yarns>,
    /// Strains of bent elements; `None` where chords are measured.
    arcs: Vec<Option<Arcs>>,
    /// Stiffnesses without the mean of the membrane,
    rests: Vec<Matrix24>,
    /// and the cells of elements with a law.
    cellwise: Vec<Cellwise>,
    /// Cells of an element.
    cells: usize,
}

/// An element's answer to a motion.
pub(super) struct Answer {
    pub motion: Motion,
    pub forces: Forces,
    /// Nodal forces and moments, global axes.
    pub nodal: Vector24,
    strain: YarnStrain,
    /// What its arcs add to the strain of its chords.
    bent: Option<Bent>,
    /// Tangents of its cells; none if it is linear.
    tangents: Vec<Strains>,
    /// Energy stored, and lost since the memory (J).
    pub energy: f64,
    pub dissipation: f64,
}

/// What the geometric stiffness of an element comes from.
#[derive(Clone, Copy, Default)]
pub(super) struct Forces {
    /// Force in the frame of the element.
    pub local: Vector24,
    /// Mean resultants of the membrane along the material axes (N/m).
    resultant: Vector3<f64>,
    /// Amplitudes of the stresses that vary over the element.
    varying: Vector2<f64>,
}

impl Forces {
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            local: self.local + other.local,
            resultant: self.resultant + other.resultant,
            varying: self.varying + other.varying,
        }
    }
}

impl<'a> Sheet<'a> {
    pub fn new(model: &Model, law: Option<&'a SheetLaw>) -> Self {
        let quads = model.mesh.quads.len();
        Self {
            law,
            d_m: law.map_or(model.section.d_m, |law| law.beside(&model.section)[0]),
            references: Vec::with_capacity(quads),
            kinds: Vec::with_capacity(quads),
            yarns: Vec::new(),
            arcs: Vec::new(),
            rests: Vec::new(),
            cellwise: Vec::new(),
            cells: model.formulation.cells.count(),
        }
    }

    /// Adds an element, which may be equal to the last.
    pub fn push(&mut self, element: &Prepared, model: &Model, like_the_last: bool) {
        if !like_the_last {
            let yarns = element.yarns();
            let mut rest = match self.law {
                None => element.local_stiffness(),
                Some(law) => {
                    let cells = element.cellwise(law.beside(&model.section));
                    let linear = *cells.linear();
                    self.cellwise.push(cells);
                    linear
                }
            };
            yarns.remove_mean(&self.d_m, &mut rest);
            self.rests.push(rest);
            self.yarns.push(yarns);
            self.arcs.push(element.arcs());
        }
        self.kinds.push(self.yarns.len() as u32 - 1);
        self.references.push(ReferenceFrame::of(&element.frame));
    }

    /// The answer of an element to places and rotations of its nodes, from a memory.
    pub fn answer(
        &self,
        quad: usize,
        memory: &Memory,
        x: &[Point3<f64>; 4],
        r: &[UnitQuaternion<f64>; 4],
    ) -> Answer {
        let (motion, kind) = (Motion::of(&self.references[quad], x, r), self.kinds[quad] as usize);
        let yarns = &self.yarns[kind];
        let strain = YarnStrain::of(&yarns.gradient(&motion.deformation));
        let bent = self.arcs[kind].as_ref().map(|arcs| (arcs, arcs.bent(&motion.deformation)));
        let added = bent.as_ref().map_or_else(Vector3::zeros, |(_, bent)| bent.strain);
        let mean_strain = strain.strain + added;
        let (mut local, mut resultant) = (self.rests[kind] * motion.deformation, self.d_m * mean_strain);
        let mean = yarns.area() * resultant.dot(&mean_strain);
        let mut energy = 0.5 * (local.dot(&motion.deformation) + mean);
        let (mut dissipation, mut tangents) = (0.0, Vec::new());
        if let Some(law) = self.law {
            let element = &self.cellwise[kind];
            let mut stresses = Vec::with_capacity(self.cells);
            let strains = element.strains(&motion.deformation, strain.excess + added).zip(element.areas());
            for (cell, (strain, area)) in strains.enumerate() {
                let (mut stress, mut tangent) = (Strains::default(), Strains::default());
                respond(law, memory.cells.get(quad * self.cells + cell), &strain, |i, response| {
                    (stress[i], tangent[i]) = (response.stress, response.tangent);
                    energy += area * response.energy;
                    dissipation += area * response.dissipation;
                });
                stresses.push(stress);
                tangents.push(tangent);
            }
            self.add_cells(kind, &stresses, &mut local, &mut resultant);
        }
        local += yarns.force(&strain, &resultant);
        let mut varying = Vector2::zeros();
        if let Some((arcs, bent)) = &bent {
            local += arcs.force(bent, &resultant);
            energy += bent.energy;
            varying = bent.varying;
        }
        let (forces, nodal) = (Forces { local, resultant, varying }, motion.force(&local));
        Answer {
            motion,
            forces,
            nodal,
            strain,
            bent: bent.map(|(_, bent)| bent),
            tangents,
            energy,
            dissipation,
        }
    }

    /// Adds the stresses of the cells: their mean to the resultants, their deviations to the rest of the force.
    fn add_cells(
        &self,
        kind: usize,
        stresses: &[Strains],
        rest: &mut Vector24,
        resultant: &mut Vector3<f64>,
    ) {
        let (element, yarns) = (&self.cellwise[kind], &self.yarns[kind]);
        for (area, [x, y, xy, ..]) in element.areas().zip(stresses) {
            *resultant += Vector3::new(*x, *y, *xy) * (area / yarns.area());
        }
        *rest += element.cell_force(stresses, &-yarns.linear_rows());
    }

    /// Tangent stiffness of an element in its frame, of its law alone.
    pub fn stiffness(&self, quad: usize, answer: &Answer) -> Matrix24 {
        let kind = self.kinds[quad] as usize;
        let (yarns, strain) = (&self.yarns[kind], &answer.strain);
        let mut k = self.rests[kind];
        if self.law.is_some() {
            k += self.cellwise[kind].stiffness(&answer.tangents, &yarns.excess_rows(strain));
        }
        yarns.add(&strain.rate.tr_mul(&(self.d_m * strain.rate)), &mut k);
        if let Some((arcs, bent)) = self.arcs[kind].as_ref().zip(answer.bent.as_ref()) {
            let d = self.mean_stiffness(kind, &answer.tangents);
            arcs.add(bent, &d, |resultant| yarns.force(strain, resultant), &mut k);
        }
        k
    }

    /// Mean stiffness of the membrane of an element whose cells have these tangents (N/m).
    fn mean_stiffness(&self, kind: usize, tangents: &[Strains]) -> Matrix3<f64> {
        let mut d = self.d_m;
        if !tangents.is_empty() {
            let whole = self.yarns[kind].area();
            for (area, tangent) in self.cellwise[kind].areas().zip(tangents) {
                (0..3).for_each(|i| d[(i, i)] += tangent[i] * area / whole);
            }
        }
        d
    }

    /// Adds the geometric stiffness of yarns that turn in the frame.
    pub fn add_geometric(&self, quad: usize, answer: &Answer, forces: &Forces, k: &mut Matrix24) {
        let kind = self.kinds[quad] as usize;
        self.yarns[kind].add(&answer.strain.geometric(&forces.resultant), k);
        if let Some(arcs) = &self.arcs[kind] {
            arcs.add_geometric(&forces.resultant, &forces.varying, k);
        }
    }

    /// The change of the forces for a change of the deformation, to first order, the yarns where they are.
    pub fn change(&self, quad: usize, answer: &Answer, change: &Vector24) -> Forces {
        let kind = self.kinds[quad] as usize;
        let (yarns, strain) = (&self.yarns[kind], &answer.strain);
        let bent = self.arcs[kind].as_ref().zip(answer.bent.as_ref());
        let added = bent.map_or_else(Vector3::zeros, |(arcs, bent)| arcs.rate(bent, change));
        let mut resultant = self.d_m * (strain.rate * yarns.gradient(change) + added);
        let mut local = self.rests[kind] * change;
        if self.law.is_some() {
            let excess = yarns.excess_rows(strain);
            let rates = self.cellwise[kind].strain_rates(change, &excess, added);
            let stresses: Vec<Strains> = rates
                .zip(&answer.tangents)
                .map(|(rate, tangent)| std::array::from_fn(|i| tangent[i] * rate[i]))
                .collect();
            self.add_cells(kind, &stresses, &mut local, &mut resultant);
        }
        local += yarns.force(strain, &resultant);
        let mut varying = Vector2::zeros();
        if let Some((arcs, bent)) = bent {
            let (amplitudes, force) = arcs.change(bent, change, &resultant);
            (varying, local) = (amplitudes, local + force);
        }
        Forces { local, resultant, varying }
    }

    /// Keeps in the memory what the elements have been through.
    pub fn remember(&self, answers: &[Answer], memory: &mut Memory) {
        let Some(law) = self.law else { return };
        if memory.cells.is_empty() {
            memory.cells = vec![Default::default(); answers.len() * self.cells];
        }
        let elements = memory.cells.chunks_exact_mut(self.cells);
        for (quad, (answer, cells)) in answers.iter().zip(elements).enumerate() {
            let element = &self.cellwise[self.kinds[quad] as usize];
            let added = answer.bent.as_ref().map_or_else(Vector3::zeros, |bent| bent.strain);
            let strains = element.strains(&answer.motion.deformation, answer.strain.excess + added);
            for (strain, states) in strains.zip(cells) {
                let from = *states;
                respond(law, Some(&from), &strain, |i, response| states[i] = response.state);
            }
            memory.dissipated += answer.dissipation;
        }
    }
}

/// Shows the response of every law of a cell to its strains; without a memory, of new cloth.
fn respond(
    law: &SheetLaw,
    memory: Option<&[law::State; 6]>,
    strain: &Strains,
    mut show: impl FnMut(usize, &Response),
) {
    let new = law::State::default();
    for (i, channel) in law.channels.iter().enumerate() {
        if let Some(channel) = channel {
            let from = memory.map_or(&new, |states| &states[i]);
            show(i, &channel.respond(law.mode, from, strain[i]));
        }
    }
}

#[cfg(test)]
#[path = "sheet_tests.rs"]
mod tests;
