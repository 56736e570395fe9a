//! A mesh with section, supports and loads; constraints, load vector and assembly.

mod dof;
mod hard;
pub mod rigid;
mod support;
mod surface;

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

pub use dof::{Dof, DofGroup};
pub use hard::{HardEdge, OwnAxes};
pub use rigid::{Links, RigidBody, RigidBodyError};
pub use support::Support;
pub use surface::{Gap, RigidSurface, SurfaceShape};

use crate::element::{
    Bending, Formulation, Frame, MaterialAxisError, Prepared, gravity_load, pressure_load, pressure_moments,
};
use crate::finding::errors;
use crate::mesh::{MeshError, QuadMesh, is_translated};
use crate::section::ShellSection;

/// A shell model. Vectors over the model hold six numbers a node, `(u, v, w, θx, θy, θz)`, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The mesh.
    pub mesh: QuadMesh,
    /// One section for the whole sheet, material axes.
    pub section: ShellSection,
    /// Direction of the warp (material x), projected on each element.
    pub warp: Vector3<f64>,
    /// How the elements are formulated.
    pub formulation: Formulation,
    /// Supports, applied in order; a later value replaces an earlier one on the same dof.
    pub supports: Vec<Support>,
    /// Loads, added up.
    pub loads: Vec<Load>,
    /// Nodes that move as rigid bodies.
    pub bodies: Vec<RigidBody>,
}

/// A load.
#[derive(Clone, Debug, PartialEq)]
pub enum Load {
    /// Pressure (Pa) along the element normal, on every element.
    Pressure(f64),
    /// Pressure (Pa) that stays normal to the sheet as it moves and acts on its area as it stretches; without
    /// large rotations the same as [`Load::Pressure`].
    FollowerPressure(f64),
    /// Acceleration (m/s²) on the mass of the sheet.
    Gravity(Vector3<f64>),
    /// Force (N) and moment (N·m), shared equally by some nodes.
    Point {
        /// The nodes.
        nodes: Vec<u32>,
        /// Total force.
        force: Vector3<f64>,
        /// Total moment.
        moment: Vector3<f64>,
    },
    /// Force (N/m) and moment (N) per length of edges.
    Edge {
        /// The edges, as pairs of nodes.
        edges: Vec<[u32; 2]>,
        /// Force per length.
        force: Vector3<f64>,
        /// Moment per length.
        moment: Vector3<f64>,
    },
}

errors! {
    /// Why a model cannot be assembled.
    #[derive(Clone, Debug, PartialEq)]
    pub enum ModelError {
        from {
            /// A defect of the mesh, or a set that it does not have.
            Mesh(MeshError),
            /// M008.
            MaterialAxis(MaterialAxisError),
            /// M010.
            Body(RigidBodyError),
        }
        /// M009: a hard simple support on an edge that is oblique to the axes, where something else turns the node.
        "M009" Oblique {
            /// Place of the node (m).
            at: [f64; 3],
            /// Direction of the rotation that is held, of length 1.
            about: [f64; 3],
            /// What it is besides.
            clash: &'static str,
        } = "the node at ({:.4}, {:.4}, {:.4}) m is on a hard simple support that holds its rotation about ({:.3}, {:.3}, {:.3}), \
             and {clash}: use kind = \"simply_supported_soft\" there",
at[0], at[1], at[2], about[0], about[1], about[2];
        /// M014: two values of one dof.
        "M014" TwoValues {
            /// Name of the dof.
            dof: &'static str,
            /// Both values (m or rad), in the order given.
            values: [f64; 2],
            /// Place of the node (m).
            at: [f64; 3],
        } = "{dof} of the node at ({}, {}, {}) m is prescribed twice, as {} and as {} {}: remove one of the two, or leave \
             the node out of one of the sets",
at[0], at[1], at[2], values[0], values[1], if dof.starts_with("theta") { "rad" } else { "m" };
    }
}

impl Model {
    /// What ties nodes to the unknowns.
    ///
    /// # Errors
    /// M009 if rotations about oblique directions cannot be held; M010 if a node is in two bodies.
    pub fn links(&self) -> Result<Arc<Links>, ModelError> {
        Ok(Links::new(&self.mesh.nodes, &self.bodies, OwnAxes::of(self)?)?)
    }

    /// Value of each unknown that is held, followers of rigid bodies at zero; `None` where free. Six a node.
    ///
    /// # Errors
    /// M010 if a follower is held and its lead is not.
    pub fn held(&self, links: &Links) -> Result<Vec<Option<f64>>, ModelError> {
        let mut held = self.constraints();
        links.hold(&mut held)?;
        Ok(held)
    }

    /// Value of each dof that a support holds; `None` elsewhere, and where one holds the rotation about a direction
    /// that is no axis. Six a node.
    pub fn constraints(&self) -> Vec<Option<f64>> {
        let mut held = self.held_by_name();
        let (dofs, _) = hard::rotations(self, &held);
        dofs.into_iter().for_each(|dof| held[dof] = Some(0.0));
        held
    }

    /// The same without what hard edges hold.
    fn held_by_name(&self) -> Vec<Option<f64>> {
        let mut held = vec![None; 6 * self.mesh.nodes.len()];
        for support in &self.supports {
            for node in &support.nodes {
                for &(dof, value) in &support.held {
                    held[6 * *node as usize + dof as usize] = Some(value);
                }
            }
        }
        held
    }

    /// Nodal forces and moments of all loads (N, N·m). Six a node.
    pub fn load_vector(&self) -> Vec<f64> {
        let mut f = self.nodal_loads(|_| true);
        if self.formulation.bending == Bending::OneCell {
            self.add_moments(&mut f);
        }
        f
    }

    /// The same without the follower pressures, which depend on where the sheet is, and without moments of
    /// distributed loads, which would not turn with it.
    pub fn dead_load_vector(&self) -> Vec<f64> {
        self.nodal_loads(|load| !matches!(load, Load::FollowerPressure(_)))
    }

    /// Sum of the follower pressures (Pa).
    pub fn follower_pressure(&self) -> f64 {
        let pressure = |load: &Load| if let Load::FollowerPressure(p) = load { *p } else { 0.0 };
        self.loads.iter().map(pressure).sum()
    }

    fn nodal_loads(&self, counts: impl Fn(&Load) -> bool) -> Vec<f64> {
        let mut f = vec![0.0; 6 * self.mesh.nodes.len()];
        let mut add = |node: u32, at: usize, v: Vector3<f64>| {
            for k in 0..3 {
                f[6 * node as usize + at + k] += v[k];
            }
        };
        for load in self.loads.iter().filter(|load| counts(load)) {
            match load {
                Load::Pressure(pressure) | Load::FollowerPressure(pressure) => {
                    self.for_each_nodal_force(|frame| pressure_load(frame, *pressure), |n, f| add(n, 0, f));
                }
                Load::Gravity(g) => {
                    let weight = |frame: &Frame| gravity_load(frame, self.section.areal_density, g);
                    self.for_each_nodal_force(weight, |n, force| add(n, 0, force));
                }
                Load::Point { nodes, force, moment } => {
                    let share = 1.0 / nodes.len() as f64;
                    for node in nodes {
                        add(*node, 0, force * share);
                        add(*node, 3, moment * share);
                    }
                }
                Load::Edge { edges, force, moment } => {
                    for edge in edges {
                        let [a, b] = edge.map(|n| self.mesh.nodes[n as usize]);
                        let half = 0.5 * (b - a).norm();
                        for node in edge {
                            add(*node, 0, force * half);
                            add(*node, 3, moment * half);
                        }
                    }
                }
            }
        }
        f
    }

    /// Adds the moments of pressures and of the weight across the sheet.
    fn add_moments(&self, f: &mut [f64]) {
        let across = |frame: &Frame| -> f64 {
            let pressure = |load: &Load| match load {
                Load::Pressure(pressure) | Load::FollowerPressure(pressure) => *pressure,
                Load::Gravity(g) => self.section.areal_density * (frame.rotation * g).z,
                Load::Point { .. } | Load::Edge { .. } => 0.0,
            };
            self.loads.iter().map(pressure).sum()
        };
        self.for_each_nodal_force(
            |frame| pressure_moments(frame, across(frame)),
            |node, moment| {
                for k in 0..3 {
                    f[6 * node as usize + 3 + k] += moment[k];
                }
            },
        );
    }

    /// Calls `add` with each node of each element and its force or moment; equal elements in a row are computed once.
    fn for_each_nodal_force(
        &self,
        forces: impl Fn(&Frame) -> [Vector3<f64>; 4],
        mut add: impl FnMut(u32, Vector3<f64>),
    ) {
        let (mut last, mut nodal) = (None, [Vector3::zeros(); 4]);
        for (quad, nodes) in self.mesh.quads.iter().enumerate() {
            let corners = self.mesh.corners(quad);
            if !last.is_some_and(|last| is_translated(&last, &corners)) {
                nodal = forces(&Frame::of(&corners));
                last = Some(corners);
            }
            nodes.iter().zip(nodal).for_each(|(n, force)| add(*n, force));
        }
    }

    /// The element, in the global axes when the sheet is flat.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to it.
    pub fn element(&self, quad: usize, flat: bool) -> Result<Prepared, MaterialAxisError> {
        self.element_of(&self.section, quad, flat)
    }

    /// The element if the sheet had this section.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to it.
    pub fn element_of(
        &self,
        section: &ShellSection,
        quad: usize,
        flat: bool,
    ) -> Result<Prepared, MaterialAxisError> {
        let corners: [Point3<f64>; 4] = self.mesh.corners(quad);
        let frame = if flat { Frame::global(&corners) } else { Frame::of(&corners) };
        Prepared::new(frame, section, self.formulation, &self.warp)
    }
}
