//! The elements of a sheet in motion: linear ones with a stiffness that is computed once, or
//! elements whose cells follow laws with a memory.

use std::borrow::Cow;

use nalgebra::{Point3, UnitQuaternion};

use super::Memory;
use crate::element::corotational::{Motion, Reference};
use crate::element::{Cellwise, Matrix24, Prepared, Strains, Vector24};
use crate::law::{self, Response};
use crate::model::Model;
use crate::section::SheetLaw;

/// The elements. Equal ones share their matrices.
pub(super) struct Sheet<'a> {
    law: Option<&'a SheetLaw>,
    references: Vec<Reference>,
    /// Which matrices each element has.
    kinds: Vec<u32>,
    /// Those of linear elements,
    stiffnesses: Vec<Matrix24>,
    /// or those of elements with a law.
    cellwise: Vec<Cellwise>,
    /// Cells of an element.
    cells: usize,
}

/// An element's answer to a motion.
pub(super) struct Answer {
    pub motion: Motion,
    /// Force in the frame of the element.
    pub local: Vector24,
    /// Tangents of its cells; none if it is linear.
    tangents: Vec<Strains>,
    /// Energy stored, and lost since the memory (J).
    pub energy: f64,
    pub dissipation: f64,
}

impl<'a> Sheet<'a> {
    pub fn new(model: &Model, law: Option<&'a SheetLaw>) -> Self {
        let quads = model.mesh.quads.len();
        Self {
            law,
            references: Vec::with_capacity(quads),
            kinds: Vec::with_capacity(quads),
            stiffnesses: Vec::new(),
            cellwise: Vec::new(),
            cells: model.formulation.cells.count(),
        }
    }

    /// Adds an element, which may be equal to the last.
    pub fn push(&mut self, element: &Prepared, model: &Model, like_the_last: bool) {
        if !like_the_last {
            match self.law {
                None => self.stiffnesses.push(element.local_stiffness()),
                Some(law) => self.cellwise.push(element.cellwise(&model.section, law.replaced())),
            }
        }
        self.kinds.push((self.stiffnesses.len() + self.cellwise.len()) as u32 - 1);
        self.references.push(Reference::of(&element.frame));
    }

    /// The answer of an element to places and rotations of its nodes, from a memory.
    pub fn answer(
        &self,
        quad: usize,
        memory: &Memory,
        x: &[Point3<f64>; 4],
        r: &[UnitQuaternion<f64>; 4],
    ) -> Answer {
        let motion = Motion::of(&self.references[quad], x, r);
        let Some(law) = self.law else {
            let local = self.stiffnesses[self.kinds[quad] as usize] * motion.deformation;
            let energy = 0.5 * local.dot(&motion.deformation);
            return Answer { motion, local, tangents: Vec::new(), energy, dissipation: 0.0 };
        };
        let element = &self.cellwise[self.kinds[quad] as usize];
        let linear = element.linear_force(&motion.deformation);
        let (mut energy, mut dissipation) = (0.5 * linear.dot(&motion.deformation), 0.0);
        let (mut stresses, mut tangents) = (Vec::with_capacity(self.cells), Vec::with_capacity(self.cells));
        let strains = element.strains(&motion.deformation).zip(element.areas());
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
        let local = linear + element.cell_force(&stresses);
        Answer { motion, local, tangents, energy, dissipation }
    }

    /// Tangent stiffness of an element in its frame.
    pub fn stiffness(&self, quad: usize, answer: &Answer) -> Cow<'_, Matrix24> {
        let kind = self.kinds[quad] as usize;
        match self.law {
            None => Cow::Borrowed(&self.stiffnesses[kind]),
            Some(_) => Cow::Owned(self.cellwise[kind].stiffness(&answer.tangents)),
        }
    }

    /// The change of the local force for a change of the deformation, to first order.
    pub fn force_change(&self, quad: usize, answer: &Answer, change: &Vector24) -> Vector24 {
        let kind = self.kinds[quad] as usize;
        if self.law.is_none() {
            return self.stiffnesses[kind] * change;
        }
        let element = &self.cellwise[kind];
        let stresses: Vec<Strains> = element
            .strains(change)
            .zip(&answer.tangents)
            .map(|(strain, tangent)| std::array::from_fn(|i| tangent[i] * strain[i]))
            .collect();
        element.linear_force(change) + element.cell_force(&stresses)
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
            for (strain, states) in element.strains(&answer.motion.deformation).zip(cells) {
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
