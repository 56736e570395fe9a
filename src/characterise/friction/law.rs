//! The friction law of one test in one direction.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::closed_form::ClosedForm;
use super::loop_fit::LoopFit;
use super::strip_memory::StripMemory;
use crate::instrument::{Direction, Parameter, Test};
use crate::law::Channel;
use crate::quantity::Curve;

/// A law of one test in one direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FrictionLaw {
    /// The test, and so what strain and stress are.
    pub test: Test,
    /// Yarn direction; `None` for compression.
    pub direction: Option<Direction>,
    /// Specimen number; 0 for a law of the fabric from summary values.
    pub specimen: usize,
    /// The strip of a law that rests on one: its place in [`FabricSheet::strips`](crate::characterise::FabricSheet::strips).
    #[serde(skip)]
    pub strip: Option<usize>,
    /// What the law rests on.
    pub basis: Basis,
    /// Thickness at which the approach of the faces counts from (m); compression only.
    pub thickness: Option<f64>,
    /// The law (SI: 1/m and N; rad and N/m; 1 and N/m; m and Pa).
    pub channel: Channel,
    /// How a FAB strip grows as it is stretched further, and how its stress relaxes; the channel alone is the strip before its
    /// last cycle, strained slowly.
    pub memory: Option<StripMemory>,
    /// Measured beside simulated; `None` without a loop.
    pub fit: Option<LoopFit>,
    /// B and 2HB by a closed form, as a check on the fit; bending loops only.
    pub closed_form: Option<ClosedForm>,
    /// Parameters re-extracted from the cycle of the instrument, simulated with this law (SI).
    pub values: BTreeMap<Parameter, f64>,
    /// What the backbone alone gives of B or G (SI): the rest is that of sliders. Bending and shear only.
    pub backbone_stiffness: Option<f64>,
}

/// What a law rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    /// A measured loop.
    Loop,
    /// A cycle of a FAB strip.
    Strip,
    /// Bend loops of FAB strips: one law over all tests of a direction.
    BendLoops,
    /// Summary values: stiffness and loop width are measured, how friction begins is assumed.
    AssumedSpectrum,
}

impl FrictionLaw {
    /// The strain of the law at an abscissa of the test.
    pub fn strain(&self, abscissa: f64) -> f64 {
        self.thickness.map_or(abscissa, |t| t - abscissa)
    }

    /// The abscissa of the test at a strain of the law.
    pub fn abscissa(&self, strain: f64) -> f64 {
        self.thickness.map_or(strain, |t| t - strain)
    }

    /// The ordinates that the law gives along a record of the test, from cloth never deformed.
    pub fn simulate(&self, record: &Curve) -> Curve {
        let strains = record.x.iter().map(|x| self.strain(*x));
        let stresses = self.channel.path(Default::default(), strains).map(|r| r.stress);
        Curve { x: record.x.clone(), y: stresses.collect() }
    }
}
