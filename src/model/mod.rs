//! A mesh with section, supports and loads; constraints, load vector and assembly.

mod dof;
pub mod rigid;

use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use thiserror::Error;

pub use dof::{Dof, DofGroup};
pub use rigid::{Links, RigidBody, RigidBodyError};

use crate::element::{Formulation, Frame, MaterialAxisError, Prepared, gravity_load, pressure_load};
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

/// Dofs held at a value on some nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// The nodes.
    pub nodes: Vec<u32>,
    /// The dofs held, each with its value (m or rad).
    pub held: Vec<(Dof, f64)>,
}

impl Support {
    /// All six dofs held at zero.
    pub fn clamped(nodes: &[u32]) -> Self {
        Self::fix(nodes, &Dof::ALL)
    }

    /// Dofs held at zero.
    pub fn fix(nodes: &[u32], dofs: &[Dof]) -> Self {
        Self { nodes: nodes.to_vec(), held: dofs.iter().map(|d| (*d, 0.0)).collect() }
    }

    /// The plane x = const through the nodes is one of symmetry.
    pub fn symmetry_x(nodes: &[u32]) -> Self {
        Self::fix(nodes, &[Dof::U, Dof::ThetaY, Dof::ThetaZ])
    }

    /// The plane y = const through the nodes is one of symmetry.
    pub fn symmetry_y(nodes: &[u32]) -> Self {
        Self::fix(nodes, &[Dof::V, Dof::ThetaX, Dof::ThetaZ])
    }

    /// A simple support of a boundary set: no displacement, free rotation.
    ///
    /// `hard` also holds the rotation that would lift the edge line, `θ·n` with `n` the normal of each
    /// edge in the plane of the sheet, as a thin plate on a support does; soft leaves it free.
    ///
    /// # Errors
    /// M007 for an unknown set; M009 for a hard support on an edge oblique to x and y.
    pub fn simple(mesh: &QuadMesh, set: &str, hard: bool) -> Result<Vec<Self>, ModelError> {
        let mut supports = vec![Self::fix(mesh.set(set)?, &[Dof::U, Dof::V, Dof::W])];
        if !hard {
            return Ok(supports);
        }
        let (mut along_x, mut along_y) = (Vec::new(), Vec::new());
        for [a, b] in mesh.set_edges(set)? {
            let d = mesh.nodes[b as usize] - mesh.nodes[a as usize];
            let along = |component: f64| component.abs() > (1.0 - 1e-9) * d.norm();
            match (along(d.x), along(d.y)) {
                (true, _) => along_x.extend([a, b]),
                (_, true) => along_y.extend([a, b]),
                _ => {
                    let angle_deg = d.y.atan2(d.x).to_degrees();
                    return Err(ModelError::SkewHardSupport { set: set.to_string(), angle_deg });
                }
            }
        }
        // On an edge along x, w = 0 means w,x = -θy = 0; along y it is w,y = θx.
        supports.push(Self::fix(&along_x, &[Dof::ThetaY]));
        supports.push(Self::fix(&along_y, &[Dof::ThetaX]));
        Ok(supports)
    }
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

/// Why a model cannot be assembled.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ModelError {
    /// A defect of the mesh, or a set that it does not have.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// M008.
    #[error(transparent)]
    MaterialAxis(#[from] MaterialAxisError),
    /// M009: a hard simple support on an edge that is not parallel to an axis.
    #[error(
        "M009 set `{set}` has an edge at {angle_deg:.1} degrees: a hard simple support needs edges along x or y; \
         use kind = \"simply_supported_soft\""
    )]
    SkewHardSupport {
        /// The node set.
        set: String,
        /// Angle of the edge from x (degrees).
        angle_deg: f64,
    },
    /// M010.
    #[error(transparent)]
    Body(#[from] RigidBodyError),
}

impl ModelError {
    /// The stable code.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Mesh(e) => e.code(),
            Self::MaterialAxis(_) => "M008",
            Self::SkewHardSupport { .. } => "M009",
            Self::Body(_) => "M010",
        }
    }
}

impl Model {
    /// What the rigid bodies tie together.
    ///
    /// # Errors
    /// M010 if a node is in two bodies.
    pub fn links(&self) -> Result<Arc<Links>, ModelError> {
        Ok(Links::new(&self.mesh.nodes, &self.bodies)?)
    }

    /// Value of each held dof, followers of rigid bodies at zero; `None` where free. Six a node.
    ///
    /// # Errors
    /// M010 if a follower is held and its lead is not.
    pub fn held(&self, links: &Links) -> Result<Vec<Option<f64>>, ModelError> {
        let mut held = self.constraints();
        links.hold_followers(&mut held)?;
        Ok(held)
    }

    /// Value of each dof that a support holds; `None` elsewhere. Six a node.
    pub fn constraints(&self) -> Vec<Option<f64>> {
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
        self.nodal_loads(|_| true)
    }

    /// The same without the follower pressures, which depend on where the sheet is.
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

    /// Calls `add` with each node of each element and its force; equal elements in a row are computed once.
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
