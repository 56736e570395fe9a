//! `[analysis]`: what is computed.

use serde::Deserialize;

use super::CaseError;
use super::adaptive::Adaptive;
use super::error::refused;
use super::loads::{Prescribed, SheetLoad, SheetLoads};
use super::motion::{Newmark, NewmarkTable, Rotations, mass};
use super::nonlinear::NonlinearTable;
use super::sheet::Sheet;
use super::step_analysis::{SheetStep, StepAnalysis};
use super::supports::SheetSupport;
use crate::element::Mass;
use crate::finding::{Located, Node, TomlError};
use crate::solve::nonlinear::{Method, Settings};

/// `[analysis]`: what is computed; of several kinds, `linear` without the table.
#[derive(Clone, Debug)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(tag = "kind", rename_all = "snake_case"))]
pub(super) enum AnalysisTable {
    /// Small displacements, one solve; the analysis of a case without the table.
    Linear(LinearTable),
    /// Natural frequencies and modes, without loads.
    Modal(ModalTable),
    /// Load factors at which a sheet buckles, and the shapes.
    Buckling(BucklingTable),
    /// Dynamics.
    Newmark(NewmarkTable),
    /// Statics in large rotations.
    Nonlinear(NonlinearTable),
    /// A round sheet hangs from a disc.
    Drape(DrapeTable),
}

/// `kind = "linear"`: small displacements, one solve.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct LinearTable {}

/// `kind = "modal"`: natural frequencies and modes, without loads.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct ModalTable {
    /// How many of the lowest.
    modes: usize,
    /// How the mass of an element goes to its nodes.
    #[cfg_attr(test, schemars(extend("default" = "lumped")))]
    mass: Option<Mass>,
    /// The older word: `true` is `mass = "lumped"`, `false` is `mass = "consistent"`.
    lumped: Option<bool>,
}

impl Default for ModalTable {
    fn default() -> Self {
        Self { modes: 6, mass: None, lumped: None }
    }
}

/// `kind = "buckling"`: the factors of the loads at which a sheet buckles, those nearest to zero first, and the shapes. One below
/// zero is a factor of the loads turned round. The stresses are those of a linear answer to the loads.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct BucklingTable {
    /// How many factors.
    factors: usize,
}

impl Default for BucklingTable {
    fn default() -> Self {
        Self { factors: 4 }
    }
}

impl BucklingTable {
    /// How many factors the table at a node asks for.
    pub fn checked(&self, at: &Node<'_>) -> Result<usize, CaseError> {
        if self.factors == 0 {
            return refused(
                at.value_place("factors"),
                "[analysis] factors = 0 asks for nothing: take 1 or more",
            );
        }
        Ok(self.factors)
    }
}

/// `kind = "drape"`: a round sheet hangs from a disc, an `annulus` held at `inner`, in large rotations.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct DrapeTable {
    /// Folds that the sheet is given at the start, one search for each: the equilibria are many.
    pub folds: Vec<usize>,
    /// How often the cells are halved for the state of lowest energy.
    pub refinements: usize,
    /// Whose sizes disc and sheet have: `case` (those of [sheet]), or `measured` (those that the method of the fabric's
    /// measured drape coefficient states, such as 24 cm on 18 cm, where it states some).
    pub sizes: DrapeSizes,
    /// How hard a sheet with friction is shaken after it has been hung: the largest change of its weight over the weight
    /// itself. It swings about its weight in turns, each half as large as the one before; 0 leaves it as it was hung. An elastic
    /// sheet would only come back.
    pub shaking: f64,
}

/// Whose sizes disc and sheet of a drape have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(super) enum DrapeSizes {
    /// Those of the case.
    #[default]
    Case,
    /// Those with which the fabric was measured.
    Measured,
}

impl Default for DrapeTable {
    fn default() -> Self {
        Self { folds: (2..=12).collect(), refinements: 1, sizes: DrapeSizes::default(), shaking: 1.0 }
    }
}

/// What is computed of a sheet.
#[derive(Clone, Debug)]
pub enum Analysis {
    /// Small displacements, one solve.
    Linear(Linear),
    /// Natural frequencies and modes.
    Modal(Modal),
    /// Buckling under loads that grow from nothing.
    Buckling(Buckling),
    /// Dynamics.
    Newmark(Newmark),
    /// Statics in large rotations.
    Nonlinear(Box<Nonlinear>),
    /// Steps in large rotations, each from where the one before has ended; one at least, and the first is static.
    Steps(Vec<SheetStep>),
}

/// Small displacements, one solve.
#[derive(Clone, Debug)]
pub struct Linear {
    /// What acts.
    pub loads: SheetLoads,
    /// How far the mesh is refined; not at all without it.
    pub adaptive: Option<Located<Adaptive>>,
    /// Coarser meshes, coarsest first, that show what the mesh leaves open.
    pub coarser: Option<Located<Vec<Sheet>>>,
}

/// Natural frequencies and modes.
#[derive(Clone, Debug)]
pub struct Modal {
    /// How many of the lowest, 1 or more.
    pub modes: usize,
    /// How the mass of an element goes to its nodes.
    pub mass: Mass,
    /// Coarser meshes, coarsest first, that show what the mesh leaves open.
    pub coarser: Option<Located<Vec<Sheet>>>,
}

/// Buckling under loads that grow from nothing.
#[derive(Clone, Debug)]
pub struct Buckling {
    /// What grows.
    pub loads: SheetLoads,
    /// How many factors, 1 or more.
    pub factors: usize,
    /// Coarser meshes, coarsest first, that show what the mesh leaves open.
    pub coarser: Option<Located<Vec<Sheet>>>,
}

/// Statics in large rotations.
#[derive(Clone, Debug)]
pub struct Nonlinear {
    /// What acts.
    pub loads: SheetLoads,
    /// How far the mesh is refined; not at all without it.
    pub adaptive: Option<Located<Adaptive>>,
    /// Tolerances and steps.
    pub settings: Settings,
    /// The way to the equilibrium.
    pub method: Method,
    /// Coarser meshes, coarsest first, that show what the mesh leaves open.
    pub coarser: Option<Located<Vec<Sheet>>>,
    /// Position of the perturbation, or else of the table, in the case file.
    pub perturbation: Located<()>,
}

impl Analysis {
    /// What acts, in the last of its steps that changes anything; nothing in a modal analysis.
    pub fn loads(&self) -> &[SheetLoad] {
        match self {
            Self::Steps(steps) => SheetStep::last_state(steps).map_or(&[], |step| step.acting()),
            Self::Linear(linear) => &linear.loads.acting,
            Self::Nonlinear(nonlinear) => &nonlinear.loads.acting,
            Self::Buckling(buckling) => &buckling.loads.acting,
            Self::Newmark(newmark) => &newmark.loads,
            Self::Modal(_) => &[],
        }
    }

    /// Whether it looks at vibrations or motions in time, of which there are none without mass.
    pub fn has_inertia(&self) -> bool {
        match self {
            Self::Modal(_) | Self::Newmark(_) => true,
            Self::Linear(_) | Self::Nonlinear(_) | Self::Buckling(_) => false,
            Self::Steps(steps) => steps
                .iter()
                .any(|step| matches!(step.analysis, StepAnalysis::Modal { .. } | StepAnalysis::Motion(_))),
        }
    }

    /// Whether the sheet has its own weight in it, in any of its steps.
    pub fn has_weight(&self) -> bool {
        let loads: Vec<&SheetLoad> = match self {
            Self::Steps(steps) => steps.iter().flat_map(|step| step.acting()).collect(),
            Self::Linear(_) | Self::Modal(_) | Self::Buckling(_) | Self::Newmark(_) | Self::Nonlinear(_) => {
                self.loads().iter().collect()
            }
        };
        loads.into_iter().any(|load| matches!(load, SheetLoad::Gravity(_)))
    }

    /// What is prescribed, in the last of its steps that changes anything; nothing in a modal analysis and in a motion.
    pub fn prescribed(&self) -> &[Prescribed] {
        match self {
            Self::Steps(steps) => SheetStep::last_state(steps).map_or(&[], |step| step.prescribed()),
            Self::Linear(linear) => &linear.loads.prescribed,
            Self::Nonlinear(nonlinear) => &nonlinear.loads.prescribed,
            Self::Buckling(buckling) => &buckling.loads.prescribed,
            Self::Modal(_) | Self::Newmark(_) => &[],
        }
    }

    /// Where the sheet is held in the last of its steps that changes anything, beside the supports of the case; nowhere
    /// without steps.
    pub fn supports(&self) -> &[SheetSupport] {
        match self {
            Self::Steps(steps) => SheetStep::last_state(steps).map_or(&[], |step| &step.supports),
            Self::Linear(_) | Self::Modal(_) | Self::Buckling(_) | Self::Newmark(_) | Self::Nonlinear(_) => {
                &[]
            }
        }
    }

    /// Everything that is prescribed, in any of its steps.
    pub fn all_prescribed(&self) -> Vec<&Prescribed> {
        match self {
            Self::Steps(steps) => steps.iter().flat_map(|step| step.prescribed()).collect(),
            Self::Linear(_) | Self::Modal(_) | Self::Buckling(_) | Self::Newmark(_) | Self::Nonlinear(_) => {
                self.prescribed().iter().collect()
            }
        }
    }

    /// Coarser meshes that show what the mesh leaves open, coarsest first.
    pub fn coarser(&self) -> Option<&Located<Vec<Sheet>>> {
        match self {
            Self::Linear(Linear { coarser, .. })
            | Self::Modal(Modal { coarser, .. })
            | Self::Buckling(Buckling { coarser, .. }) => coarser.as_ref(),
            Self::Nonlinear(nonlinear) => nonlinear.coarser.as_ref(),
            Self::Newmark(_) | Self::Steps(_) => None,
        }
    }

    /// How far the mesh is refined; `None` where it stays as it is.
    pub fn adaptive(&self) -> Option<&Located<Adaptive>> {
        match self {
            Self::Linear(linear) => linear.adaptive.as_ref(),
            Self::Nonlinear(nonlinear) => nonlinear.adaptive.as_ref(),
            Self::Modal(_) | Self::Buckling(_) | Self::Newmark(_) | Self::Steps(_) => None,
        }
    }

    /// How the mass of an element goes to its nodes, where the analysis has a mass.
    pub fn mass(&self) -> Option<Mass> {
        match self {
            Self::Modal(modal) => Some(modal.mass),
            Self::Newmark(newmark) => Some(newmark.mass),
            Self::Linear(_) | Self::Buckling(_) | Self::Nonlinear(_) | Self::Steps(_) => None,
        }
    }

    /// Whether rotations may be large, or the equations are those of large rotations.
    pub fn has_large_rotations(&self) -> bool {
        match self {
            Self::Linear(_) | Self::Modal(_) => false,
            Self::Newmark(newmark) => newmark.rotations != Rotations::Small,
            Self::Buckling(_) | Self::Nonlinear(_) | Self::Steps(_) => true,
        }
    }
}

impl AnalysisTable {
    /// Reads the `[analysis]` of a case; a linear one when left out.
    pub fn read(case: &Node<'_>) -> Result<Self, TomlError> {
        const KINDS: [&str; 6] = ["linear", "modal", "buckling", "newmark", "nonlinear", "drape"];
        let Some(at) = case.get("analysis") else { return Ok(Self::Linear(LinearTable {})) };
        Ok(match super::kind::kind_of(&at, &KINDS)? {
            "linear" => Self::Linear(at.read_without("kind")?),
            "modal" => Self::Modal(at.read_without("kind")?),
            "buckling" => Self::Buckling(at.read_without("kind")?),
            "newmark" => Self::Newmark(at.read_without("kind")?),
            "nonlinear" => Self::Nonlinear(at.read_without("kind")?),
            _ => Self::Drape(at.read_without("kind")?),
        })
    }

    /// Whether a law with friction has a meaning: in large rotations.
    pub fn can_have_friction(&self) -> bool {
        match self {
            Self::Nonlinear(_) | Self::Drape(_) => true,
            Self::Newmark(newmark) => newmark.has_large_rotations(),
            Self::Linear(_) | Self::Modal(_) | Self::Buckling(_) => false,
        }
    }

    /// Whether rigid surfaces have a meaning: in large rotations, and in motions that keep their energy.
    pub fn can_have_obstacles(&self) -> bool {
        match self {
            Self::Nonlinear(_) => true,
            Self::Newmark(newmark) => newmark.can_have_obstacles(),
            Self::Linear(_) | Self::Modal(_) | Self::Buckling(_) | Self::Drape(_) => false,
        }
    }

    /// Whether bands by sampling have a meaning: where results are no linear function of the inputs.
    pub fn can_be_sampled(&self) -> bool {
        match self {
            Self::Newmark(_) | Self::Nonlinear(_) | Self::Drape(_) => true,
            Self::Linear(_) | Self::Modal(_) | Self::Buckling(_) => false,
        }
    }
}

impl ModalTable {
    /// How many modes, and the mass matrix, of the table at a node.
    pub fn checked(&self, at: &Node<'_>) -> Result<(usize, Mass), CaseError> {
        if self.modes == 0 {
            return refused(at.value_place("modes"), "[analysis] modes = 0 asks for nothing: take 1 or more");
        }
        Ok((self.modes, mass(self.mass, self.lumped, at)?))
    }
}
