//! `[analysis]` with `kind = "nonlinear"`: statics in large rotations.

use serde::{Deserialize, Serialize};

use super::CaseError;
use super::analysis::Nonlinear;
use super::error::refused;
use super::loads::SheetLoads;
use crate::finding::Node;
use crate::solve::nonlinear::{ArcLength, Flow, Method, Perturbation, Settings};

/// `kind = "nonlinear"`: statics in large rotations; what is left out is chosen by the method.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct NonlinearTable {
    /// The way to the equilibrium.
    method: MethodChoice,
    /// Unbalanced forces that are accepted, relative to loads or reactions, above 0 and at most 1.
    #[cfg_attr(test, schemars(extend("default" = 1e-8)))]
    tolerance: Option<f64>,
    /// Iterations in a step before it counts as failed (`newton`, `arc_length`, `stable`).
    #[cfg_attr(test, schemars(extend("default" = 25)))]
    iterations: Option<usize>,
    /// First step of the load factor: `newton` 1, `arc_length` 0.1, `stable` 0.1 at most.
    #[cfg_attr(test, schemars(example = 0.1))]
    first_step: Option<f64>,
    /// Largest step of the load factor (`newton`, `stable`).
    #[cfg_attr(test, schemars(extend("default" = 1.0)))]
    largest_step: Option<f64>,
    /// A step that has been halved below this one ends the search (`newton`, `stable`).
    #[cfg_attr(test, schemars(extend("default" = 1e-5)))]
    smallest_step: Option<f64>,
    /// Steps before the search is given up: `arc_length` 100, `flow` 400.
    #[cfg_attr(test, schemars(example = 200))]
    steps: Option<usize>,
    /// Size of random loads that break the symmetry, relative to the mean load: `newton` none, `flow` 1e-3.
    #[cfg_attr(test, schemars(example = 1e-3))]
    perturbation: Option<f64>,
    /// Seed of the random loads (`newton`, `flow`).
    #[cfg_attr(test, schemars(extend("default" = 1)))]
    seed: Option<u64>,
}

/// Ways to an equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum MethodChoice {
    /// Newton's method in adaptive steps of the load.
    #[default]
    Newton,
    /// The path through limit points of the load.
    ArcLength,
    /// The implicit gradient flow of the energy, which ends in a stable equilibrium.
    Flow,
    /// Newton's method along stable equilibria: a sheet that buckles goes on with the shape into which it buckles. This is
    /// what `newton` does by itself where its own path ends unstable or nowhere, and it is told.
    Stable,
}

impl MethodChoice {
    /// The name of a method.
    pub fn of(method: &Method) -> Self {
        match method {
            Method::Newton(_) => Self::Newton,
            Method::ArcLength(_) => Self::ArcLength,
            Method::Flow(_) => Self::Flow,
            Method::Stable => Self::Stable,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Newton => "newton",
            Self::ArcLength => "arc_length",
            Self::Flow => "flow",
            Self::Stable => "stable",
        }
    }

    /// The keys that belong to some methods only.
    const KEYS: [(&'static str, &'static [Self]); 7] = [
        ("first_step", &[Self::Newton, Self::ArcLength, Self::Stable]),
        ("largest_step", &[Self::Newton, Self::Stable]),
        ("smallest_step", &[Self::Newton, Self::Stable]),
        ("steps", &[Self::ArcLength, Self::Flow]),
        ("iterations", &[Self::Newton, Self::ArcLength, Self::Stable]),
        ("perturbation", &[Self::Newton, Self::Flow]),
        ("seed", &[Self::Newton, Self::Flow]),
    ];
}

/// Largest step of the load factor beside obstacles.
const STEP_WITH_OBSTACLES: f64 = 0.1;

impl NonlinearTable {
    /// The table of a case, which may have `[[obstacles]]`: what touches and rubs depends on the way, so that steps are short.
    pub fn with_obstacles(mut self, case: &Node<'_>, at: &Node<'_>) -> Result<Self, CaseError> {
        if !case.has("obstacles") {
            return Ok(self);
        }
        match self.method {
            MethodChoice::Newton | MethodChoice::Stable => {
                self.largest_step.get_or_insert(STEP_WITH_OBSTACLES);
            }
            MethodChoice::Flow => {}
            MethodChoice::ArcLength => {
                let message =
                    "[[obstacles]] are for method = \"newton\", \"stable\" or \"flow\": choose one of them";
                return refused(at.value_place("method"), message);
            }
        }
        Ok(self)
    }

    /// Settings and method under loads of the table at a node.
    pub fn checked(&self, at: &Node<'_>, loads: SheetLoads) -> Result<Nonlinear, CaseError> {
        self.check_keys(at)?;
        self.check_values(at)?;
        let default = Settings::default();
        let largest_step = self.largest_step.unwrap_or(default.largest_step);
        let settings = Settings {
            tolerance: self.tolerance.unwrap_or(default.tolerance),
            iterations: self.iterations.unwrap_or(default.iterations),
            first_step: self.first_step.unwrap_or(default.first_step).min(largest_step),
            largest_step,
            smallest_step: self.smallest_step.unwrap_or(default.smallest_step),
            ..default
        };
        let perturbation = at.located_at("perturbation", ());
        let method = self.solver_method();
        Ok(Nonlinear { loads, adaptive: None, settings, method, coarser: None, perturbation })
    }

    fn solver_method(&self) -> Method {
        let seed = self.seed.unwrap_or(1);
        match self.method {
            MethodChoice::Newton => Method::Newton(self.perturbation.map(|size| Perturbation { size, seed })),
            MethodChoice::ArcLength => {
                let default = ArcLength::default();
                Method::ArcLength(ArcLength {
                    first: self.first_step.unwrap_or(default.first),
                    steps: self.steps.unwrap_or(default.steps),
                    until: Some(1.0),
                    ..default
                })
            }
            MethodChoice::Stable => Method::Stable,
            MethodChoice::Flow => {
                let default = Flow::default();
                let perturbation = self.perturbation.unwrap_or(default.perturbation);
                Method::Flow(Flow { perturbation, seed, steps: self.steps.unwrap_or(default.steps) })
            }
        }
    }

    /// Refuses keys that the method does not have.
    fn check_keys(&self, at: &Node<'_>) -> Result<(), CaseError> {
        let foreign =
            |(key, methods): &(&str, &[MethodChoice])| at.has(key) && !methods.contains(&self.method);
        if let Some((key, methods)) = MethodChoice::KEYS.into_iter().find(foreign) {
            let names: Vec<&str> = methods.iter().map(|m| m.name()).collect();
            let names = names.join("\" or \"");
            return refused(
                at.key_place(key),
                format!("[analysis] {key} belongs to method = \"{names}\": remove it, or change the method"),
            );
        }
        if self.method == MethodChoice::Newton && self.seed.is_some() && self.perturbation.is_none() {
            return refused(
                at.key_place("seed"),
                "[analysis] seed needs a perturbation, such as perturbation = 1e-3",
            );
        }
        Ok(())
    }

    /// Refuses values out of range.
    fn check_values(&self, at: &Node<'_>) -> Result<(), CaseError> {
        let fractions = [
            ("tolerance", self.tolerance),
            ("first_step", self.first_step),
            ("largest_step", self.largest_step),
            ("smallest_step", self.smallest_step),
        ];
        let beyond = |(_, value): &(&str, Option<f64>)| value.is_some_and(|v| !(v > 0.0 && v <= 1.0));
        if let Some((key, _)) = fractions.into_iter().find(beyond) {
            return refused(at.value_place(key), format!("[analysis] {key} must be above 0 and at most 1"));
        }
        let steps = [
            ("smallest_step", self.smallest_step),
            ("first_step", self.first_step),
            ("largest_step", self.largest_step),
        ];
        let given: Vec<(&str, f64)> = steps
            .into_iter()
            .filter(|(key, _)| at.has(key))
            .filter_map(|(key, value)| Some((key, value?)))
            .collect();
        if let Some([(key, value), (longer, limit)]) = given.array_windows().find(|[a, b]| a.1 > b.1) {
            let message = format!(
                "[analysis] {key} = {value} is above {longer} = {limit}: steps go from the smallest to the largest"
            );
            return refused(at.value_place(key), message);
        }
        if self.perturbation.is_some_and(|p| !(0.0..=1.0).contains(&p)) {
            return refused(at.value_place("perturbation"), "[analysis] perturbation must be 0 to 1");
        }
        for (key, value) in [("iterations", self.iterations), ("steps", self.steps)] {
            if value == Some(0) {
                return refused(at.value_place(key), "[analysis] iterations and steps must be at least 1");
            }
        }
        Ok(())
    }
}
