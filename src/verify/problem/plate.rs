//! Rectangular plates under unit pressure, or vibrating.

use nalgebra::{Point3, Vector3};
use serde::Deserialize;

use super::setting::{CellLayout, Law, Statics, nearest, unit};
use crate::analytical::levy::Edge;
use crate::analytical::mindlin::MindlinPlate;
use crate::analytical::{Plate, PlateState};
use crate::element::{Bending, Formulation, Mass, ShearInterpolation};
use crate::fields;
use crate::mesh::{distorted, rectangle};
use crate::model::{Dof, DofGroup, Load, Model, Support};
use crate::solve::{Options, modes};
use crate::verify::error::VerifyError;
use crate::verify::function::Function;

/// A rectangle `[0, a] x [0, b]`, one section, unit pressure.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlateProblem {
    /// Length along x (m).
    #[serde(default = "unit")]
    a: f64,
    /// Length along y (m).
    #[serde(default = "unit")]
    b: f64,
    /// Elements along x and along y.
    n: usize,
    /// The section.
    law: Law,
    /// How the edges x = 0, y = 0, x = a, y = b are held.
    edges: Edges,
    /// Smoothing cells.
    #[serde(default)]
    cells: CellLayout,
    /// Smoothing of the curvature.
    #[serde(default)]
    bending: Bending,
    /// Interpolation of the transverse shear.
    #[serde(default)]
    shear: ShearInterpolation,
    /// Shear stabilisation; 0.05, with one bending cell the residual flexibility.
    alpha: Option<f64>,
    /// Random distortion of the mesh, 0 to 0.5.
    #[serde(default)]
    distortion: f64,
    /// Mass matrix, of frequencies.
    #[serde(default)]
    mass: Mass,
    /// What is taken.
    measure: Measure,
    /// Where: fractions of a and b; the nearest node.
    #[serde(default = "middle")]
    at: [f64; 2],
}

fn middle() -> [f64; 2] {
    [0.5, 0.5]
}

/// Four letters, for x = 0, y = 0, x = a, y = b: `C` clamped, `S` simply supported (hard), `s` (soft), `F` free.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(try_from = "String")]
struct Edges([u8; 4]);

impl TryFrom<String> for Edges {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let letters: [u8; 4] =
            text.as_bytes().try_into().map_err(|_| format!("`{text}` is not four letters"))?;
        let known = letters.iter().all(|l| b"CSsF".contains(l));
        known.then_some(Self(letters)).ok_or_else(|| format!("`{text}` has a letter other than C, S, s, F"))
    }
}

/// What is taken from the solution.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Measure {
    /// `w D22 / (q a⁴)`.
    Deflection,
    /// `M_x / (q a²)` from the nodal recovery.
    MomentX,
    /// `M_y / (q a²)` from the nodal recovery.
    MomentY,
    /// `M_x / (q a²)` on the edge x = 0, from its reactions.
    EdgeMoment,
    /// The same from one node's reaction alone, spread over half the edges that meet in it.
    NodalEdgeMoment,
    /// `Q_x / (q a)` from the nodal recovery.
    ShearX,
    /// `ω_k a² √(ρ/D22)` of this mode, from 1.
    Frequency(usize),
}

impl PlateProblem {
    fn model(&self) -> Result<Model, VerifyError> {
        let mesh = distorted(rectangle(self.a, self.b, self.n, self.n)?, self.distortion, 1)?;
        let mut supports = Vec::new();
        for (set, letter) in ["left", "bottom", "right", "top"].into_iter().zip(self.edges.0) {
            match letter {
                b'C' => supports.push(Support::clamped(mesh.set(set)?)),
                b'S' => supports.push(Support::simple(&mesh, set, true)?),
                b's' => supports.push(Support::simple(&mesh, set, false)?),
                _ => {}
            }
        }
        Ok(Model {
            mesh,
            section: self.law.section(),
            warp: Vector3::x(),
            formulation: self.formulation(),
            supports,
            loads: vec![Load::Pressure(1.0)],
            bodies: Vec::new(),
        })
    }

    fn formulation(&self) -> Formulation {
        let start = match self.bending {
            Bending::Cells => Formulation::default(),
            Bending::OneCell => Formulation::fourth_order(),
        };
        let shear_stabilisation = self.alpha.unwrap_or(start.shear_stabilisation);
        Formulation { cells: self.cells.0, shear: self.shear, shear_stabilisation, ..start }
    }

    /// The same on elements half as large.
    pub fn refined(&self) -> Self {
        Self { n: 2 * self.n, ..self.clone() }
    }

    /// The same on elements twice as large.
    pub fn coarsened(&self) -> Self {
        Self { n: self.n / 2, ..self.clone() }
    }

    /// Its mesh, the deflection of the nodes over the largest one, and their bending moment along x over `q a²`.
    pub fn bent(&self) -> Result<BentPlate, VerifyError> {
        let model = self.model()?;
        let solution = Statics::default().solve(&model)?;
        let w: Vec<f64> = solution.displacement.chunks_exact(6).map(|u| u[2]).collect();
        let largest = w.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        let moments = fields::nodal(&model, &solution.displacement)?;
        Ok(BentPlate {
            side: self.a,
            nodes: model.mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect(),
            quads: model.mesh.quads.clone(),
            deflection: w.iter().map(|w| w / largest).collect(),
            moment: moments.iter().map(|r| r.moment[0] / (self.a * self.a)).collect(),
        })
    }

    /// The value, and the coordinates of the node at which it was taken.
    pub fn value(&self, statics: &mut Statics) -> Result<(f64, [f64; 2]), VerifyError> {
        let model = self.model()?;
        let node = nearest(&model.mesh, Point3::new(self.a * self.at[0], self.b * self.at[1], 0.0));
        let at = [model.mesh.nodes[node].x, model.mesh.nodes[node].y];
        Ok((self.measure_at(&model, node, statics)? * self.unit(), at))
    }

    fn measure_at(&self, model: &Model, node: usize, statics: &mut Statics) -> Result<f64, VerifyError> {
        if let Measure::Frequency(k) = self.measure {
            let found = modes(model, k, self.mass, &Options::default())?;
            return Ok(found.get(k - 1).map_or(f64::NAN, |m| m.angular_frequency));
        }
        let solution = statics.solve(model)?;
        Ok(match self.measure {
            Measure::MomentX => fields::nodal(model, &solution.displacement)?[node].moment[0],
            Measure::MomentY => fields::nodal(model, &solution.displacement)?[node].moment[1],
            Measure::EdgeMoment => {
                let edges = model.mesh.set_edges("left")?;
                at_end(&edges, &fields::edge_moments(&model.mesh, &solution.reaction, &edges), node)
            }
            Measure::NodalEdgeMoment => {
                let length = |[a, b]: &[u32; 2]| {
                    (model.mesh.nodes[*a as usize] - model.mesh.nodes[*b as usize]).norm()
                };
                let edges = model.mesh.set_edges("left")?;
                let meet = edges.iter().filter(|e| e.contains(&(node as u32)));
                // M_x on x = 0 is a moment against θy.
                -solution.reaction[6 * node + Dof::ThetaY as usize]
                    / meet.map(|e| 0.5 * length(e)).sum::<f64>()
            }
            Measure::ShearX => fields::nodal(model, &solution.displacement)?[node].shear[0],
            Measure::Deflection | Measure::Frequency(_) => solution.displacement[6 * node + 2],
        })
    }

    /// What makes the value a number of the plate's shape and support alone.
    fn unit(&self) -> f64 {
        let d22 = self.law.section().d_b[(1, 1)];
        match self.measure {
            Measure::Deflection => d22 / self.a.powi(4),
            Measure::MomentX | Measure::MomentY | Measure::EdgeMoment | Measure::NodalEdgeMoment => {
                self.a.powi(-2)
            }
            Measure::ShearX => self.a.recip(),
            Measure::Frequency(_) => self.a.powi(2) / d22.sqrt(),
        }
    }

    /// The analytical value at a point.
    pub fn exact(&self, function: Function, [x, y]: [f64; 2]) -> Option<f64> {
        let section = self.law.section();
        let plate = Plate::of_section(self.a, self.b, &section);
        let pick = |s: PlateState| match self.measure {
            Measure::Deflection => Some(s.deflection),
            Measure::MomentX | Measure::EdgeMoment | Measure::NodalEdgeMoment => Some(s.mx),
            Measure::MomentY => Some(s.my),
            Measure::ShearX | Measure::Frequency(_) => None,
        };
        let value = match (function, &self.edges.0) {
            (Function::Navier, b"SSSS") => pick(plate.navier(x, y, 1.0)),
            (Function::Levy, b"SSSS") => pick(plate.levy(Edge::Supported, x, y, 1.0)),
            (Function::Levy, b"SCSC") => pick(plate.levy(Edge::Clamped, x, y, 1.0)),
            (Function::Levy, b"SFSF") => pick(plate.levy(Edge::Free, x, y, 1.0)),
            (Function::Superposition, b"CCCC") => {
                let solved = plate.clamped(1.0)?;
                if x == 0.0 { Some(solved.edge_moment_x(y)) } else { pick(solved.state(x, y)) }
            }
            (Function::Ritz, b"CFFF") => pick(plate.cantilever_ritz(1.0, 20)?.state(x, y)),
            (Function::ShearFlexible, edges) => {
                let thick = MindlinPlate::of_section(self.a, self.b, &section);
                match edges {
                    b"SSSS" => pick(thick.supported(x, y, 1.0)),
                    b"CCCC" => pick(thick.clamped(1.0, 10)?.state(x, y)),
                    _ => None,
                }
            }
            (Function::Frequencies, _) => self.exact_frequency(&plate),
            _ => None,
        };
        value.map(|v| v * self.unit())
    }

    fn exact_frequency(&self, plate: &Plate) -> Option<f64> {
        let Measure::Frequency(k) = self.measure else { return None };
        let all = match &self.edges.0 {
            b"SSSS" => plate.supported_frequencies(1.0, k),
            b"CCCC" => plate.clamped_frequencies(1.0, k)?,
            b"CFFF" => plate.cantilever_frequencies(1.0, k)?,
            _ => return None,
        };
        all.get(k - 1).copied()
    }
}

/// The value at a node among those at the ends of edges.
fn at_end(edges: &[[u32; 2]], values: &[[f64; 2]], node: usize) -> f64 {
    let mut ends = edges.iter().zip(values).flat_map(|(e, v)| e.iter().zip(v));
    ends.find(|(n, _)| **n as usize == node).map_or(f64::NAN, |(_, v)| *v)
}

/// A plate under pressure, for pictures.
#[derive(Clone, Debug)]
pub struct BentPlate {
    /// Its length along x (m).
    pub side: f64,
    /// Its nodes at rest (m).
    pub nodes: Vec<[f64; 3]>,
    /// Corner nodes of each element.
    pub quads: Vec<[u32; 4]>,
    /// Of each node, over the largest.
    pub deflection: Vec<f64>,
    /// `M_x / (q a²)` of each node, from the nodal recovery.
    pub moment: Vec<f64>,
}

/// Plate motions without energy, counted.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mechanisms {
    /// The plate.
    plate: PlateProblem,
}

impl Mechanisms {
    /// Number of zero frequencies among the lowest eight. Rounding leaves them below 1e-2 rad/s where it
    /// meets the small rotary inertia; the lowest elastic ones are above 1 rad/s.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let found = modes(&self.plate.model()?, 8, Mass::Consistent, &Options::default())?;
        let free = found.iter().filter(|m| m.group == DofGroup::Plate && m.angular_frequency < 1e-2);
        Ok(free.count() as f64)
    }
}
