//! The parameter sheet of one fabric.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use serde::Serialize;

use super::friction::FrictionLaw;
use super::graph::LineFit;
use super::strip::StripTest;
use super::{CycleChoice, Key, Settings, ValueStatus};
use crate::finding::Finding;
use crate::instrument::fab::FabTest;
use crate::instrument::{
    Conditions, Direction, FabricInfo, Measurement, Parameter, Shape, Source, Test, standard_conditions,
};
use crate::quantity::{Curve, Estimate};

/// One monotonic run of the drive, corrected (zero, slack, offset), SI, in recorded order.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Branch {
    /// Cycle, from 0.
    pub cycle: usize,
    /// Whether the drive moves away from the origin (loading, outgoing).
    pub outgoing: bool,
    /// Corrected points.
    pub curve: Curve,
}

/// A straight line fitted over a window, or a loop width read at an abscissa; drawn in charts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Window {
    /// The parameter it yields.
    pub parameter: Parameter,
    /// Abscissae of the window (SI); equal for a reading at one abscissa.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// Ordinates of the drawn segment at `from` and `to` (SI): the ends of the fitted line, or the
    /// lower and upper side of a loop width.
    pub ordinates: [f64; 2],
}

/// One specimen after processing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpecimenResult {
    /// The measurement it comes from (raw curve, conditions, source).
    pub measurement: Measurement,
    /// Corrected branches in recorded order.
    pub branches: Vec<Branch>,
    /// What was added to raw abscissa and ordinate (SI), by the zero/offset/slack correction.
    pub correction: [f64; 2],
    /// Windows and readings, for charts.
    pub windows: Vec<Window>,
    /// Straight lines behind the slopes, with R², n and the two-point slope.
    pub fits: Vec<LineFit>,
    /// Parameters of this specimen (SI).
    pub values: BTreeMap<Parameter, f64>,
    /// Tangent stiffness over the low-load window and other moduli, by name (SI N/m):
    /// `tangent_low`, `secant`, `energy`. Tensile only.
    pub moduli: BTreeMap<String, f64>,
}

/// The characterised fabric. Values are SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FabricSheet {
    /// Identifier (folder name).
    pub name: String,
    /// What `fabric.toml` says, origin included.
    pub info: FabricInfo,
    /// Mean, SD and n per parameter and direction.
    pub values: BTreeMap<Key, Estimate>,
    /// Tensile moduli by name and direction (N/m): `tangent_low`, `secant`, `energy`.
    pub moduli: BTreeMap<(String, Direction), Estimate>,
    /// How each of the values was had; measured where nothing is said.
    pub statuses: BTreeMap<Key, ValueStatus>,
    /// How each of the moduli was had.
    pub modulus_statuses: BTreeMap<(String, Direction), ValueStatus>,
    /// Ranges of values (SI) over what was identified together with them and is not measured: B and 2HB of bend loops. They hold
    /// no scatter of repeats.
    pub model_bands: BTreeMap<Key, [f64; 2]>,
    /// Specimens in order of test, direction, number; empty for fabrics known from tables only.
    pub specimens: Vec<SpecimenResult>,
    /// Stretch tests of FAB strips, in file order.
    pub strips: Vec<StripTest>,
    /// Friction laws: of specimens in their order, then of strips, then from summary values.
    pub laws: Vec<FrictionLaw>,
    /// Bend tests of FAB strips as recorded, in file order.
    pub bend_tests: Vec<FabTest>,
    /// How the values were evaluated.
    pub settings: Settings,
    /// Files of the result tables that gave a value.
    pub table_files: BTreeMap<Key, BTreeSet<PathBuf>>,
    /// What each test was run to; see [`conditions`](Self::conditions).
    pub run_to: BTreeMap<(Test, Option<Direction>), RunTo>,
    /// Files behind the sheet.
    pub sources: Vec<Source>,
    /// What a reader of the sheet must know.
    pub findings: Vec<Finding>,
}

/// What the specimens of a test in a direction were run to.
#[derive(Clone, Debug, PartialEq)]
pub struct RunTo {
    /// The conditions of the first specimen, with the maximum that its chosen cycle reaches.
    pub conditions: Conditions,
    /// Whether the others reach the same maximum, to a twentieth.
    pub alike: bool,
}

impl FabricSheet {
    /// Drops the curves of specimens and strips with what their files say beside; values and conditions of specimens stay, as the bands
    /// of laws ask for them.
    pub fn drop_curves(&mut self) {
        for SpecimenResult { measurement, branches, windows, fits, .. } in &mut self.specimens {
            measurement.curve = Curve::default();
            measurement.lines = Vec::new();
            measurement.metadata = BTreeMap::new();
            (*branches, *windows, *fits) = (Vec::new(), Vec::new(), Vec::new());
        }
        self.strips = Vec::new();
    }
}

impl SpecimenResult {
    /// The number of the cycle that the parameters are taken from.
    pub(super) fn cycle(&self, choice: CycleChoice) -> Option<usize> {
        let cycles = self.branches.iter().map(|b| b.cycle);
        match choice {
            CycleChoice::First => cycles.min(),
            CycleChoice::Last => cycles.max(),
        }
    }

    /// The conditions of the test; the maximum is the set one, or what the chosen cycle reaches if that is less.
    pub fn conditions(&self, choice: CycleChoice) -> Conditions {
        let m = &self.measurement;
        let cycle = self.cycle(choice);
        let by_strain = m.test.shape() != Shape::Rise;
        let driven = |b: &Branch| if by_strain { b.curve.x.clone() } else { b.curve.y.clone() };
        let reached = self
            .branches
            .iter()
            .filter(|b| Some(b.cycle) == cycle)
            .flat_map(driven)
            .fold(0.0f64, |far, v| far.max(v.abs()));
        let set = m.conditions.maximum;
        let maximum = if set.is_finite() && set > 0.0 { set.min(reached) } else { reached };
        Conditions { maximum, ..m.conditions.clone() }
    }
}

impl FabricSheet {
    /// The estimate of a parameter in a direction, or of the fabric as a whole.
    ///
    /// A directional parameter for which only a fabric mean is known is found under `None`.
    pub fn get(&self, parameter: Parameter, direction: Option<Direction>) -> Option<&Estimate> {
        self.values.get(&Key { parameter, direction })
    }

    /// The conditions under which a test was run, and a simulated one is to be: those of the first specimen, whose
    /// maximum is what its record reaches; the customary ones where no record is known.
    pub fn conditions(&self, test: Test, direction: Option<Direction>) -> Conditions {
        self.run_to.get(&(test, direction)).map(|r| r.conditions.clone()).unwrap_or_else(|| {
            let standard = standard_conditions(test);
            Conditions { maximum: self.settings.maximum_of_tables(test), ..standard }
        })
    }

    /// Whether anything could be evaluated.
    pub fn has_values(&self) -> bool {
        !(self.values.is_empty() && self.moduli.is_empty() && self.bend_tests.is_empty())
    }
}
