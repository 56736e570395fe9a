//! `[analysis]` with `kind = "newmark"`: dynamics.

use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::load_history::load_history;
use super::loads::{SheetLoad, SheetLoads};
use crate::element::Mass;
use crate::finding::{Located, Node, Place, optional_array};
use crate::quantity::{Time, Velocity};
use crate::solve::newmark::{Beginning, LoadHistory, Scheme};

/// `kind = "newmark"`: dynamics, from rest unless another beginning is given (Newmark's method, average acceleration
/// unless β and γ are given). In `[[steps]]` it goes on from the state of the step before in large rotations, and `load` says how the
/// loads go from those of that step (0) to its own (1).
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct NewmarkTable {
    /// End of the time range.
    duration: Time,
    /// Time step; the first one when a tolerance is given.
    step: Time,
    /// Relative local error at which the step adapts, above 0 and below 1; constant step when left out. The
    /// errors of the steps add up, over a few periods to about its power 2/3.
    #[cfg_attr(test, schemars(example = 1e-3))]
    tolerance: Option<f64>,
    /// Damping ratios of the first and the third natural frequency; undamped when left out. Rayleigh's damping brakes rigid motions as
    /// well, as a medium would: a sheet that falls free falls more slowly with it.
    #[cfg_attr(test, schemars(extend("examples" = [[0.02, 0.02]])))]
    #[serde(default, deserialize_with = "optional_array")]
    damping: Option<[f64; 2]>,
    /// `"step"`, `"ramp until 0.1 s"`, `"sine 5 Hz"` (the same as `"sine 31.416 rad/s"`), or `"off"`: nothing acts, and the
    /// sheet goes on from its `start` (in `[[steps]]`: what acted in the step before goes on).
    #[serde(default = "step_load")]
    #[cfg_attr(test, schemars(example = &"ramp until 0.1 s"))]
    load: String,
    /// How the mass of an element goes to its nodes.
    #[cfg_attr(test, schemars(extend("default" = "lumped")))]
    mass: Option<Mass>,
    /// The older word: `true` is `mass = "lumped"`, `false` is `mass = "consistent"`.
    lumped: Option<bool>,
    /// Rotations of any size instead of small displacements; the energies balance in every step. A motion in `[[steps]]` has them
    /// always.
    #[serde(default)]
    large_rotations: bool,
    /// How much of the highest frequencies is left after a step, 0 to 1, and the method that damps them (generalised-α)
    /// in the place of the one that keeps the energy. With large rotations only.
    #[cfg_attr(test, schemars(example = 0.9))]
    spectral_radius: Option<f64>,
    /// β of Newmark's method, γ/2 to 1, so that no step is too long. With small displacements only.
    #[cfg_attr(test, schemars(extend("default" = 0.25)))]
    beta: Option<f64>,
    /// γ of Newmark's method, 1/2 to 1: above 1/2 what is fast is damped, the order is the first, the step is constant,
    /// and the imbalance of the energies in the result is what the method has taken. With small displacements only.
    #[cfg_attr(test, schemars(extend("default" = 0.5)))]
    gamma: Option<f64>,
    /// The sheet at the first instant; another one than `rest` with small displacements only.
    #[serde(default)]
    start: StartingShape,
    /// Velocity along z of every node that is not held, at the first instant. With small displacements only.
    start_velocity: Option<Velocity>,
    /// How many shapes on the way `kesf run` writes as a series of fields, evenly in time. In `[[steps]]` only.
    #[cfg_attr(test, schemars(extend("default" = 0), example = 20))]
    frames: Option<usize>,
}

/// The sheet at the first instant of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub(super) enum StartingShape {
    /// Without deformation.
    #[default]
    Rest,
    /// With the deflection that the whole loads cause in statics: with `load = "off"` they let go of it.
    Deflected,
}

/// Dynamics: nothing is prescribed.
#[derive(Clone, Debug)]
pub struct Newmark {
    /// Forces and moments.
    pub loads: Vec<SheetLoad>,
    /// End of the time range, not before the first step.
    pub duration: Time,
    /// Time step, above 0; the first one with a tolerance.
    pub step: Time,
    /// Relative local error at which the step adapts; constant step without.
    pub tolerance: Option<f64>,
    /// Damping ratios of the first and the third natural frequency, 0 to below 1; undamped without.
    pub damping: Option<Located<[f64; 2]>>,
    /// How the loads vary in time.
    pub history: LoadHistory,
    /// How the mass of an element goes to its nodes.
    pub mass: Mass,
    /// The size of rotations.
    pub rotations: Rotations,
    /// β and γ; those of the average acceleration in large rotations.
    pub scheme: Scheme,
    /// The state at the first instant; rest in large rotations.
    pub beginning: Beginning,
}

/// The size of rotations in a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rotations {
    /// Small displacements (Newmark's method).
    Small,
    /// Any size.
    Large {
        /// How much of the highest frequencies is left after a step of the generalised-α method, 0 to 1; without, the
        /// energy is conserved.
        spectral_radius: Option<f64>,
    },
}

impl NewmarkTable {
    /// Whether rotations may be of any size.
    pub fn has_large_rotations(&self) -> bool {
        self.large_rotations
    }

    /// Whether rigid surfaces may stop the sheet: where the method keeps the energy.
    pub fn can_have_obstacles(&self) -> bool {
        self.large_rotations && self.spectral_radius.is_none()
    }

    /// Shapes on the way that are kept.
    pub fn frames(&self) -> usize {
        self.frames.unwrap_or(0)
    }

    /// The motion under loads of the table at a node.
    pub fn checked(&self, at: &Node<'_>, loads: SheetLoads) -> Result<Newmark, CaseError> {
        if self.frames.is_some() {
            return refused(at.key_place("frames"), "`frames` are of a motion in [[steps]]: remove it");
        }
        self.checked_from(at, loads, false)
    }

    /// The same; one that goes on from the state of a step need not say how it begins.
    pub fn checked_from(
        &self,
        at: &Node<'_>,
        loads: SheetLoads,
        goes_on: bool,
    ) -> Result<Newmark, CaseError> {
        if let Some(prescribed) = loads.prescribed.first() {
            let place = Place { line: prescribed.table.line, column: prescribed.table.column, ..at.place() };
            return refused(place, "a dynamic analysis has no prescribed values: remove them");
        }
        if self.damping.is_some_and(|ratios| !ratios.iter().all(|ratio| (0.0..1.0).contains(ratio))) {
            return refused(
                at.value_place("damping"),
                "[analysis] damping ratios are parts of the critical damping: take 0 to below 1",
            );
        }
        if self.tolerance.is_some_and(|t| !(t > 0.0 && t < 1.0)) {
            return refused(
                at.value_place("tolerance"),
                "[analysis] tolerance is the local error of a step relative to the displacement: take one above 0 and \
                 below 1, such as 1e-3",
            );
        }
        let (step, duration) = (self.step.si(), self.duration.si());
        if !(step > 0.0 && duration >= step) {
            return refused(at.value_place("step"), "newmark needs 0 < step <= duration");
        }
        Ok(Newmark {
            loads: loads.acting,
            duration: self.duration,
            step: self.step,
            tolerance: self.tolerance,
            damping: self.damping.map(|ratios| at.located_at("damping", ratios)),
            history: load_history(&self.load).or_else(|reason| refused(at.value_place("load"), reason))?,
            mass: mass(self.mass, self.lumped, at)?,
            rotations: self.rotations(at)?,
            scheme: self.scheme(at)?,
            beginning: self.beginning(at, goes_on)?,
        })
    }

    fn scheme(&self, at: &Node<'_>) -> Result<Scheme, CaseError> {
        let start = Scheme::default();
        let gamma = self.gamma.unwrap_or(start.gamma);
        let scheme = Scheme { beta: self.beta.unwrap_or(start.beta.max(0.5 * gamma)), gamma };
        let key = if self.beta.is_some() { "beta" } else { "gamma" };
        if !(scheme.is_stable() && scheme.beta <= 1.0 && scheme.gamma <= 1.0) {
            let message = format!(
                "[analysis] beta = {} with gamma = {}: take 1/2 <= gamma <= 2 beta and both at most 1, for which no step is \
                 too long; a thin sheet has frequencies that no step resolves",
                scheme.beta, scheme.gamma
            );
            return refused(at.value_place(key), message);
        }
        if self.tolerance.is_some() && scheme.gamma != start.gamma {
            let message = "`tolerance` adapts the step by the local error of gamma = 0.5: remove one of them";
            return refused(at.value_place("gamma"), message);
        }
        Ok(scheme)
    }

    fn beginning(&self, at: &Node<'_>, goes_on: bool) -> Result<Beginning, CaseError> {
        let small = ["beta", "gamma", "start", "start_velocity"];
        if let Some(key) = small.into_iter().find(|key| self.large_rotations && at.has(key)) {
            return refused(
                at.key_place(key),
                format!("`{key}` is for small displacements: remove it, or large_rotations"),
            );
        }
        let velocity = self.start_velocity.map_or(0.0, Velocity::si);
        let beginning = Beginning { deflected: self.start == StartingShape::Deflected, velocity };
        if self.load == "off" && beginning == Beginning::default() && !goes_on {
            let message = if self.large_rotations {
                "load = \"off\" lets nothing act, so that the sheet stays at rest: give a load, or let the motion follow a static step, in [[steps]]"
            } else {
                "load = \"off\" lets nothing act: give start = \"deflected\" or a start_velocity too"
            };
            return refused(at.value_place("load"), message);
        }
        Ok(beginning)
    }

    fn rotations(&self, at: &Node<'_>) -> Result<Rotations, CaseError> {
        let message = "spectral_radius is 0 to 1, and needs large_rotations = true";
        match (self.large_rotations, self.spectral_radius) {
            (false, None) => Ok(Rotations::Small),
            (false, Some(_)) => refused(at.key_place("spectral_radius"), message),
            (true, Some(radius)) if !(0.0..=1.0).contains(&radius) => {
                refused(at.value_place("spectral_radius"), message)
            }
            (true, spectral_radius) => Ok(Rotations::Large { spectral_radius }),
        }
    }
}

fn step_load() -> String {
    "step".into()
}

/// The mass matrix: the key `mass`, or the older `lumped`.
pub(super) fn mass(mass: Option<Mass>, lumped: Option<bool>, at: &Node<'_>) -> Result<Mass, CaseError> {
    match (mass, lumped) {
        (Some(_), Some(_)) => {
            let message = "[analysis] gives both `mass` and `lumped`: remove `lumped`";
            refused(at.key_place("lumped"), message)
        }
        (Some(mass), None) => Ok(mass),
        (None, Some(false)) => Ok(Mass::Consistent),
        (None, Some(true)) => Ok(Mass::Lumped),
        (None, None) => Ok(Mass::default()),
    }
}
