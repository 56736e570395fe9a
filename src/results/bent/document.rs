//! The entries of `kesf.comparison/1` of bending tests.

use std::borrow::Cow;

use serde::{Deserialize, Deserializer, Serialize};

use super::measured::{measured, role};
use crate::instrument::Direction;
use crate::law::Channel;
use crate::quantity::Curve;
use crate::results::sampled::SamplingEntry;
use crate::results::solved::QuantityEntry;
use crate::results::task::Task;
use crate::study::bending::{
    Agreement, BendLoop, BendLoops, BendingResult, CHORD_ANGLE_DEG, Cantilever, Friction, HeartLoop,
    Simulated, WithFriction,
};

/// An entry of `kesf.comparison/1`: a bending test of a strip (SI).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct BendingEntry {
    name: String,
    case: String,
    fabric: Option<String>,
    #[serde(flatten)]
    test: BendingTestEntry,
    /// Of tests with sampled bands, or `null`; a FAB test has none.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "stated")]
    uncertainty: Option<Option<SamplingEntry>>,
    /// Origin of the data of the fabric: `measured`, `published` or `synthetic`.
    #[serde(default)]
    origin: Option<String>,
}

/// What is there, `null` too; what is not there has its default.
fn stated<'d, T: Deserialize<'d>, D: Deserializer<'d>>(value: D) -> Result<Option<T>, D::Error> {
    T::deserialize(value).map(Some)
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
enum BendingTestEntry {
    Cantilever(CantileverEntry),
    HeartLoop(HeartEntry),
    FabBendLoop(FabEntry),
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct CantileverEntry {
    chord_angle_deg: f64,
    overhang: QuantityEntry,
    bending_length: BendingLengthEntry,
    rigidity_by_peirce_formula_excess: f64,
    rigidity: QuantityEntry,
    friction: Option<CantileverFrictionEntry>,
    profile: ProfileEntry,
    elements: usize,
    strips: usize,
    iterations: usize,
    stable: bool,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct BendingLengthEntry {
    simulated: f64,
    closed_form: f64,
    measured: Option<f64>,
    by_peirce_formula: f64,
    unit: Cow<'static, str>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct CantileverFrictionEntry {
    couple: QuantityEntry,
    mu: f64,
    overhang: QuantityEntry,
    bending_length: EstimatedLengthEntry,
    profile: ProfileEntry,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct EstimatedLengthEntry {
    simulated: f64,
    estimate: f64,
    unit: Cow<'static, str>,
}

/// The middle line of a strip.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ProfileEntry {
    x: Vec<f64>,
    z: Vec<f64>,
    unit: Cow<'static, str>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct HeartEntry {
    length: QuantityEntry,
    height: HeightEntry,
    rigidity: HeartRigidityEntry,
    gamma: f64,
    profile: ProfileEntry,
    elements: usize,
    iterations: usize,
    stable: bool,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct HeightEntry {
    simulated: f64,
    closed_form: Option<f64>,
    unit: Cow<'static, str>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct HeartRigidityEntry {
    read_from_height: Option<f64>,
    section: f64,
    unit: Cow<'static, str>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct FabEntry {
    rigidity: QuantityEntry,
    clamp_inclination: QuantityEntry,
    friction: Option<FabFrictionEntry>,
    elements: usize,
    tests: Vec<LoopEntry>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct FabFrictionEntry {
    rigidity: QuantityEntry,
    as_kes: AsKesEntry,
    /// Over the inclination of the clamps and the growth of slip levels.
    band: KesBandEntry,
    clamp_inclination: QuantityEntry,
    /// α of `1 + α (κ/κ_max)²`.
    slip_level_growth: f64,
    largest_curvature: QuantityEntry,
    law: Channel,
    rounds: usize,
}

/// What KES-FB2 would read of a law.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct AsKesEntry {
    #[serde(rename = "B")]
    b: f64,
    #[serde(rename = "half_2HB")]
    half_2hb: f64,
    unit: [Cow<'static, str>; 2],
}

/// Lowest and highest value of what KES-FB2 would read.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct KesBandEntry {
    #[serde(rename = "B")]
    b: [f64; 2],
    #[serde(rename = "half_2HB")]
    half_2hb: [f64; 2],
    unit: [Cow<'static, str>; 2],
}

/// The agreement of a test with laws that were identified without it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct HeldOutEntry {
    load_zero: QuantityEntry,
    outer: Option<Agreement>,
    inner: Option<Agreement>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LoopEntry {
    test: Cow<'static, str>,
    role: Cow<'static, str>,
    distance: Vec<f64>,
    measured: Vec<f64>,
    branches_begin: Vec<usize>,
    unit: [Cow<'static, str>; 2],
    elastic: SimulatedEntry,
    friction: Option<SimulatedEntry>,
    held_out_elastic: Option<HeldOutEntry>,
    held_out_friction: Option<HeldOutEntry>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct SimulatedEntry {
    load_zero: QuantityEntry,
    outer: Option<Agreement>,
    inner: Option<Agreement>,
    inner_with_own_zero: Option<Agreement>,
    force: Vec<f64>,
}

/// The entries, one a direction.
pub(in crate::results) fn entries(task: &Task, result: &BendingResult) -> Vec<BendingEntry> {
    match result {
        BendingResult::Cantilever(tests) => tests
            .iter()
            .map(|c| {
                let test = BendingTestEntry::Cantilever(CantileverEntry::new(c, measured(task, c)));
                entry(task, "cantilever", c.direction, test, true)
            })
            .collect(),
        BendingResult::HeartLoop(tests) => tests
            .iter()
            .map(|h| {
                entry(task, "heart_loop", h.direction, BendingTestEntry::HeartLoop(HeartEntry::new(h)), true)
            })
            .collect(),
        BendingResult::FabBendLoop(directions) => directions
            .iter()
            .map(|d| {
                let test = BendingTestEntry::FabBendLoop(FabEntry::new(d));
                entry(task, "fab_bend_loop", d.direction, test, false)
            })
            .collect(),
    }
}

fn entry(
    task: &Task,
    name: &str,
    direction: Direction,
    test: BendingTestEntry,
    has_bands: bool,
) -> BendingEntry {
    let sampling = || task.sampling().map(|s| SamplingEntry::ending_with(s, direction.name()));
    BendingEntry {
        name: format!("{name} {direction}"),
        case: task.case.name.clone(),
        fabric: task.fabric_name().map(str::to_string),
        test,
        uncertainty: has_bands.then(sampling),
        origin: task.origin_name(),
    }
}

fn quantity(value: f64, unit: &'static str) -> QuantityEntry {
    QuantityEntry { value, unit: unit.into() }
}

impl ProfileEntry {
    fn new(profile: &Curve) -> Self {
        Self { x: profile.x.clone(), z: profile.y.clone(), unit: "m".into() }
    }
}

impl CantileverEntry {
    fn new(c: &Cantilever, measured: Option<f64>) -> Self {
        Self {
            chord_angle_deg: CHORD_ANGLE_DEG,
            overhang: quantity(c.overhang, "m"),
            bending_length: BendingLengthEntry {
                simulated: c.bending_length,
                closed_form: c.closed_form,
                measured,
                by_peirce_formula: c.peirce,
                unit: "m".into(),
            },
            rigidity_by_peirce_formula_excess: c.peirce_excess(),
            rigidity: quantity(c.rigidity, "N·m"),
            friction: c.friction.as_ref().map(CantileverFrictionEntry::new),
            profile: ProfileEntry::new(&c.profile),
            elements: c.elements,
            strips: c.strips,
            iterations: c.iterations,
            stable: c.stable,
        }
    }
}

impl CantileverFrictionEntry {
    fn new(f: &WithFriction) -> Self {
        let bending_length =
            EstimatedLengthEntry { simulated: f.bending_length, estimate: f.estimate, unit: "m".into() };
        Self {
            couple: quantity(f.couple, "N"),
            mu: f.mu,
            overhang: quantity(f.overhang, "m"),
            bending_length,
            profile: ProfileEntry::new(&f.profile),
        }
    }
}

impl HeartEntry {
    fn new(h: &HeartLoop) -> Self {
        Self {
            length: quantity(h.length, "m"),
            height: HeightEntry { simulated: h.height, closed_form: h.closed_form, unit: "m".into() },
            rigidity: HeartRigidityEntry {
                read_from_height: h.rigidity,
                section: h.section_rigidity,
                unit: "N·m".into(),
            },
            gamma: h.gamma,
            profile: ProfileEntry::new(&h.profile),
            elements: h.elements,
            iterations: h.iterations,
            stable: h.stable,
        }
    }
}

impl FabEntry {
    fn new(d: &BendLoops) -> Self {
        Self {
            rigidity: quantity(d.elastic.rigidity, "N·m"),
            clamp_inclination: quantity(d.elastic.inclination, "rad"),
            friction: d.friction.as_ref().map(FabFrictionEntry::new),
            elements: d.cells,
            tests: d.loops.iter().map(LoopEntry::new).collect(),
        }
    }
}

impl FabFrictionEntry {
    fn new(f: &Friction) -> Self {
        Self {
            rigidity: quantity(f.rigidity, "N·m"),
            as_kes: AsKesEntry {
                b: f.kes_rigidity,
                half_2hb: f.kes_couple,
                unit: ["N·m".into(), "N".into()],
            },
            band: KesBandEntry { b: f.band[0], half_2hb: f.band[1], unit: ["N·m".into(), "N".into()] },
            clamp_inclination: quantity(f.inclination, "rad"),
            slip_level_growth: f.growth,
            largest_curvature: quantity(f.largest_curvature, "1/m"),
            law: f.law.clone(),
            rounds: f.rounds,
        }
    }
}

impl LoopEntry {
    fn new(l: &BendLoop) -> Self {
        Self {
            test: l.kind.name().into(),
            role: role(l).into(),
            distance: l.measured.x.clone(),
            measured: l.measured.y.clone(),
            branches_begin: l.branches.clone(),
            unit: ["m".into(), "N".into()],
            elastic: SimulatedEntry::new(&l.elastic),
            friction: l.friction.as_ref().map(SimulatedEntry::new),
            held_out_elastic: l.held_out[0].as_ref().map(HeldOutEntry::new),
            held_out_friction: l.held_out[1].as_ref().map(HeldOutEntry::new),
        }
    }
}

impl HeldOutEntry {
    fn new(s: &Simulated) -> Self {
        Self { load_zero: quantity(s.zero, "N"), outer: s.outer, inner: s.inner }
    }
}

impl SimulatedEntry {
    fn new(s: &Simulated) -> Self {
        Self {
            load_zero: quantity(s.zero, "N"),
            outer: s.outer,
            inner: s.inner,
            inner_with_own_zero: s.inner_with_own_zero,
            force: s.force.y.clone(),
        }
    }
}
