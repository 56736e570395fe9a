//! The whole cycle of an instrument, simulated with a shell that has friction.
//!
//! | test | drive | cycle, where no record goes elsewhere | the moving clamp |
//! |---|---|---|---|
//! | bending | rotation | 0, +2.5, -2.5, 0 1/cm | rigid, free to follow the arc |
//! | shear | displacement along the clamps | 0, +8, -8, 0 deg | rigid, free to approach |
//! | tension | force | 0, 500 gf/cm, 0 | rigid, moves straight away |
//!
//! The conditions are those of the fabric's own records, and the parameters are read with the settings of its sheet.
//!
//! Shear and tension keep the sheet in its plane, as its own pretension does in the instrument;
//! that pretension itself (10 gf/cm in shear, which adds W tan φ to the force) is left out.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use nalgebra::Vector3;

use super::StudyError;
use super::virtual_large::CELLS;
use crate::case::{ShellSpecimen, ShellTest, VirtualTest};
use crate::characterise::{FabricSheet, Settings as Evaluation, parameters};
use crate::constitutive::{Constitutive, tension};
use crate::element::Formulation;
use crate::instrument::{Conditions, Direction, Parameter, Test};
use crate::kes::TestSpec;
use crate::law::{Channel, Mode};
use crate::mesh;
use crate::model::{Dof, Load, Model, RigidBody, Support};
use crate::quantity::Curve;
use crate::section::{SheetLaw, ShellSection};
use crate::solve::Options;
use crate::solve::nonlinear::{Settings, Step, solve};

/// Steps from the start to the maximum of a cycle that is driven by strain, and of one driven by force,
/// whose first steps are long in strain.
const STEPS: [f64; 2] = [50.0, 200.0];

/// A simulated cycle. Axes are those of [`Test`].
#[derive(Clone, Debug, PartialEq)]
pub struct VirtualLoop {
    /// Which test.
    pub test: Test,
    /// Direction of the specimen.
    pub direction: Direction,
    /// What the friction of the sheet did.
    pub mode: Mode,
    /// The record, from the start to the end of the cycle.
    pub record: Curve,
    /// Its KES parameters, by the evaluation that instrument files go through (SI).
    pub values: BTreeMap<Parameter, f64>,
    /// Newton iterations of all steps.
    pub iterations: usize,
}

impl VirtualLoop {
    /// The ordinate at an abscissa on the way out, from the rest or from the other side, or on the way
    /// back; straight between the steps of the record, and beyond its ends as there.
    pub fn at(&self, outgoing: bool, x: f64) -> f64 {
        // The runs of the cycle: out, back (and out to the other side), and back from there.
        let turns = self.turns();
        let run = match (outgoing, x >= 0.0) {
            (true, true) => 0..=turns[0],
            (false, false) if turns.len() > 1 => turns[1]..=self.record.len() - 1,
            _ => turns[0]..=turns.get(1).copied().unwrap_or(self.record.len() - 1),
        };
        let (xs, ys) = (&self.record.x, &self.record.y);
        let pairs = run.clone().zip(run.clone().skip(1));
        let found = pairs.into_iter().find(|(a, b)| (xs[*a] - x) * (xs[*b] - x) <= 0.0 && xs[*a] != xs[*b]);
        match found {
            Some((a, b)) => ys[a] + (ys[b] - ys[a]) * (x - xs[a]) / (xs[b] - xs[a]),
            None => {
                let (a, b) = (*run.start(), *run.end());
                if (xs[a] - x).abs() < (xs[b] - x).abs() { ys[a] } else { ys[b] }
            }
        }
    }

    /// Where the drive turns: at the greatest and, in a two-sided test, at the least abscissa.
    fn turns(&self) -> Vec<usize> {
        let xs = &self.record.x;
        let last = |order: fn(&f64, &f64) -> std::cmp::Ordering| {
            (0..xs.len()).max_by(|a, b| order(&xs[*a], &xs[*b])).unwrap_or(0)
        };
        let top = last(f64::total_cmp);
        let bottom = last(|a, b| b.total_cmp(a));
        if bottom > top && self.test != Test::Tensile { vec![top, bottom] } else { vec![top] }
    }
}

/// Simulates a test for a fabric with friction; `None` for an elastic one.
///
/// # Errors
/// See [`StudyError`].
pub fn simulate_cycle(
    specimen: &ShellSpecimen,
    direction: Direction,
    sheet: &FabricSheet,
    made: &Constitutive,
    options: &Options,
) -> Result<Option<VirtualLoop>, StudyError> {
    let Some(mut law) = made.law.clone() else { return Ok(None) };
    let spec = &specimen.test;
    if spec.kind() == ShellTest::Tensile {
        let [x, y] = tension(sheet);
        (law.channels[0], law.channels[1]) = (x, y);
    }
    let mut conditions = sheet.conditions(spec.test(), Some(direction));
    if let Some(curvature) = spec.curvature() {
        conditions.maximum = curvature.si();
    }
    let run = (&conditions, &sheet.settings);
    simulate_loop(spec, specimen.formulation, direction, &made.section, &law, run, options).map(Some)
}

/// Simulates the cycle of a specimen cut along `direction`.
///
/// The cycle goes to the maximum of the conditions; the parameters are those of the evaluation.
///
/// In tension the coupling of warp and weft is left out where `law` replaces both: the laws are those
/// of specimens that were clamped as this one is. Across the pull nothing is clamped, so that the law there has
/// no slack: with it the free edges would part by millimetres, and take the yarns of the pull along.
///
/// # Errors
/// See [`StudyError`].
pub fn simulate_loop(
    spec: &VirtualTest,
    formulation: Formulation,
    direction: Direction,
    section: &ShellSection,
    law: &SheetLaw,
    (conditions, evaluation): (&Conditions, &Evaluation),
    options: &Options,
) -> Result<VirtualLoop, StudyError> {
    let (gauge, maximum) = (conditions.gauge, conditions.maximum);
    let TestSpec { width, .. } = *spec.test().spec();
    let (mut section, mut law) = (section.clone(), law.clone());
    let mode = law.mode;
    if spec.kind() == ShellTest::Tensile {
        if law.channels[0].is_some() && law.channels[1].is_some() {
            (section.d_m[(0, 1)], section.d_m[(1, 0)]) = (0.0, 0.0);
        }
        let across = if direction == Direction::Weft { 0 } else { 1 };
        law.channels[across] = law.channels[across].as_ref().map(Channel::centred);
    }
    let model = Model { formulation, ..model(spec, direction, section, gauge, maximum)? };
    let right = model.mesh.set("right")?.to_vec();
    let lead = right[0] as usize;
    let (path, steps) = match spec.kind() {
        ShellTest::Tensile => (vec![1.0, 0.0], STEPS[1]),
        ShellTest::Shear | ShellTest::Bending => (vec![1.0, -1.0, 0.0], STEPS[0]),
    };
    let settings = Settings {
        first_step: 1.0 / steps,
        largest_step: 1.0 / steps,
        path,
        law: Some(law),
        ..Settings::default()
    };
    let mut record = vec![(0.0, 0.0)];
    let rest = model.mesh.nodes[lead];
    let solution = solve(&model, &settings, options, |step: &Step<'_>| {
        let displacement = step.state.position[lead] - rest;
        let reaction = |dof: Dof| step.reaction[6 * lead + dof as usize] / width;
        record.push(match spec.kind() {
            ShellTest::Bending => (step.state.factor * maximum, reaction(Dof::ThetaY)),
            ShellTest::Shear => ((displacement.y / gauge).atan(), reaction(Dof::V)),
            ShellTest::Tensile => (displacement.x / gauge, step.state.factor * maximum),
        });
        ControlFlow::Continue(())
    })?;
    let record = Curve::from_points(record);
    let values = parameters(spec.test(), Some(direction), conditions, &record, evaluation);
    Ok(VirtualLoop { test: spec.test(), direction, mode, record, values, iterations: solution.iterations })
}

/// The specimen between its clamps; the lead of the moving one is the first node of the set `right`.
fn model(
    spec: &VirtualTest,
    direction: Direction,
    section: ShellSection,
    gauge: f64,
    maximum: f64,
) -> Result<Model, StudyError> {
    let [along, across] = spec.cells.unwrap_or(CELLS);
    let TestSpec { width, .. } = *spec.test().spec();
    let mesh = mesh::rectangle(gauge, width, along, across)?;
    let (left, right) = (mesh.set("left")?.to_vec(), mesh.set("right")?.to_vec());
    let turns = [(Dof::ThetaX, 0.0), (Dof::ThetaZ, 0.0)];
    let held = match spec.kind() {
        ShellTest::Bending => vec![(Dof::V, 0.0), (Dof::ThetaY, maximum * gauge)],
        ShellTest::Shear => vec![(Dof::V, maximum.tan() * gauge), (Dof::W, 0.0), (Dof::ThetaY, 0.0)],
        ShellTest::Tensile => vec![(Dof::V, 0.0), (Dof::W, 0.0), (Dof::ThetaY, 0.0)],
    };
    let mut supports = vec![Support::clamped(&left)];
    if spec.kind() != ShellTest::Bending {
        let all = 0..mesh.nodes.len() as u32;
        let free: Vec<u32> = all.filter(|n| !left.contains(n) && !right.contains(n)).collect();
        supports.push(Support::fix(&free, &[Dof::W, Dof::ThetaX, Dof::ThetaY]));
    }
    supports.push(Support::at(vec![right[0]], [&held[..], &turns].concat()));
    let force = Vector3::new(maximum * width, 0.0, 0.0);
    let bodies = vec![RigidBody { nodes: right.clone() }];
    let pull = Load::Point { nodes: right, force, moment: Vector3::zeros() };
    Ok(Model {
        loads: if spec.kind() == ShellTest::Tensile { vec![pull] } else { Vec::new() },
        mesh,
        section,
        warp: match direction {
            Direction::Warp => Vector3::x(),
            Direction::Weft => Vector3::y(),
            Direction::Bias => Vector3::new(1.0, 1.0, 0.0),
        },
        formulation: Formulation::default(),
        supports,
        bodies,
    })
}
