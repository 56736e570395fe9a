//! The law of one strain component, and its memory at a point.

use serde::{Deserialize, Serialize};

use super::widening::Growth;
use super::{Backbone, ElasticResponse, LawError, Widening};

/// Sliders that a [`State`] has room for: two families of six.
pub const MAX_SLIDERS: usize = 12;

/// An elastic-slider element: a spring of which the deformation never exceeds a level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Slider {
    /// Stiffness w of the spring (stress per strain).
    pub stiffness: f64,
    /// Slip level x where `q` is 1 (strain); the stress there is `w x q`.
    pub slip: f64,
}

/// Sliders whose levels widen alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Family {
    /// How their slip levels grow with the strain.
    pub widening: Widening,
    /// The sliders.
    pub sliders: Vec<Slider>,
}

/// A law `σ = E(e) + Σ w_j t_j` with its memory `t_j` in [`State`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(try_from = "Parts", into = "Parts")]
pub struct Channel {
    backbone: Backbone,
    families: Vec<Family>,
    one_sided: bool,
}

/// A channel as it is written to a file.
#[derive(Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Parts {
    backbone: Backbone,
    families: Vec<Family>,
    one_sided: bool,
}

/// What the sliders do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// No friction: the backbone, the elastic part, acts alone.
    Elastic,
    /// The sliders slip, and keep their state.
    #[default]
    Friction,
    /// The sliders follow the initial loading curve of cloth that was never deformed, on the way back too:
    /// a nonlinear elastic law.
    Virgin,
}

/// The memory of a channel at a point: strain and deformation of each slider's spring, in the order
/// of families and sliders. [`State::default`] is cloth that was never deformed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// The strain.
    pub strain: f64,
    /// Deformations t (strain); those beyond the number of sliders are not used.
    pub slip: [f64; MAX_SLIDERS],
}

/// The answer to a strain.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Stress.
    pub stress: f64,
    /// Its derivative with respect to the new strain, not negative in the modes
    /// [`Elastic`](Mode::Elastic) and [`Friction`](Mode::Friction).
    pub tangent: f64,
    /// The memory, should the strain be kept.
    pub state: State,
    /// Work lost in this step, not negative.
    pub dissipation: f64,
    /// Energy stored: that of the backbone from strain 0, and that of the sliders' springs. The
    /// derivative of `energy + dissipation` with respect to the new strain is the stress (of a
    /// channel that is not one-sided).
    pub energy: f64,
}

impl Channel {
    /// A law of a backbone and families of sliders. `one_sided`: the stress is never below zero, as
    /// that of a strip that goes slack or of a foot that leaves the cloth; energy and dissipation
    /// then count what the strip does unseen.
    ///
    /// # Errors
    /// M020 if a stiffness, slip level or widening is negative or not finite, if there are more than
    /// [`MAX_SLIDERS`] sliders, or if a slip level widens faster than the strain grows.
    pub fn new(backbone: Backbone, families: Vec<Family>, one_sided: bool) -> Result<Self, LawError> {
        let count = families.iter().map(|f| f.sliders.len()).sum();
        if count > MAX_SLIDERS {
            return Err(LawError::Sliders { count });
        }
        for family in &families {
            family.widening.check()?;
            for Slider { stiffness, slip } in &family.sliders {
                for (what, value) in [("a stiffness", *stiffness), ("a slip level", *slip)] {
                    if !(value.is_finite() && value >= 0.0) {
                        return Err(LawError::Value { what, value });
                    }
                }
                let slope = slip * family.widening.steepest();
                // Rounding of levels that were made to just fit is no widening.
                if slope > 1.0 + 1e-12 {
                    return Err(LawError::Steep { slip: *slip, slope });
                }
            }
        }
        Ok(Self { backbone, families, one_sided })
    }

    /// A law of a backbone with the memory of other laws, the stresses of each multiplied by a factor. It is not one-sided.
    ///
    /// # Errors
    /// See [`new`](Self::new).
    pub fn with_memory_of(backbone: Backbone, others: &[(&Self, f64)]) -> Result<Self, LawError> {
        let scaled = |family: &Family, factor: f64| {
            let stiffer = |s: &Slider| Slider { stiffness: factor * s.stiffness, ..*s };
            Family { sliders: family.sliders.iter().map(stiffer).collect(), ..family.clone() }
        };
        let families =
            others.iter().flat_map(|(law, factor)| law.families.iter().map(|family| scaled(family, *factor)));
        Self::new(backbone, families.collect(), false)
    }

    /// A law without friction.
    pub fn elastic(backbone: Backbone) -> Self {
        Self { backbone, families: Vec::new(), one_sided: false }
    }

    /// The reversible part.
    pub fn backbone(&self) -> &Backbone {
        &self.backbone
    }

    /// The sliders.
    pub fn families(&self) -> &[Family] {
        &self.families
    }

    /// Whether stresses below zero are cut off.
    pub fn is_one_sided(&self) -> bool {
        self.one_sided
    }

    /// The same law to both sides and through the origin: without the cut of stresses below zero and
    /// without the stress at strain 0 (set, zero error), as a structure wants it.
    pub fn centred(&self) -> Self {
        Self { backbone: self.backbone.with_offset(0.0), families: self.families.clone(), one_sided: false }
    }

    /// The same law without the cut of stresses below zero.
    pub fn uncut(&self) -> Self {
        Self { one_sided: false, ..self.clone() }
    }

    /// The same law of cloth of which either face may be up: the backbone [`Backbone::symmetric`].
    pub fn symmetric(&self) -> Self {
        Self { backbone: self.backbone.symmetric(), ..self.centred() }
    }

    /// The stress of all sliders when they slip and `q` is 1.
    pub fn couple(&self) -> f64 {
        self.sliders().map(|s| s.stiffness * s.slip).sum()
    }

    /// The law with the tangents of its backbone and the stiffnesses of its sliders multiplied by factors;
    /// slip levels and the stress at strain 0 stay.
    ///
    /// # Errors
    /// M020 for factors that are negative or not finite.
    pub fn scaled(&self, backbone: f64, sliders: f64) -> Result<Self, LawError> {
        let knots: Vec<f64> = self.backbone.knots().collect();
        let tangents: Vec<f64> = self.backbone.tangents().map(|t| backbone * t).collect();
        let backbone = Backbone::new(self.backbone.offset(), &knots, &tangents)?;
        Ok(Self { one_sided: self.one_sided, ..Self::with_memory_of(backbone, &[(self, sliders)])? })
    }

    /// The law with every strain multiplied by a factor: it takes the same stresses at strains that are so much greater.
    ///
    /// # Errors
    /// M020 for a factor that is not above zero and finite.
    pub fn stretched(&self, factor: f64) -> Result<Self, LawError> {
        let further = |s: &Slider| Slider { stiffness: s.stiffness / factor, slip: s.slip * factor };
        let family = |f: &Family| {
            let sliders = f.sliders.iter().map(further).collect();
            Ok(Family { widening: f.widening.stretched(factor)?, sliders })
        };
        let families = self.families.iter().map(family).collect::<Result<_, LawError>>()?;
        Self::new(self.backbone.stretched(factor)?, families, self.one_sided)
    }

    /// All sliders, in the order of [`State::slip`].
    pub fn sliders(&self) -> impl Iterator<Item = &Slider> {
        self.families.iter().flat_map(|f| &f.sliders)
    }

    /// The answer of the law in a mode; see [`trial`](Self::trial). Without friction there is no
    /// memory: the state keeps its slips, and nothing is dissipated.
    pub fn respond(&self, mode: Mode, from: &State, strain: f64) -> Response {
        let ElasticResponse { stress, tangent, energy } = match mode {
            Mode::Friction => return self.trial(from, strain),
            Mode::Elastic => self.backbone.at(strain),
            Mode::Virgin => self.virgin(strain),
        };
        let state = State { strain, ..*from };
        self.cut(Response { stress, tangent, state, dissipation: 0.0, energy })
    }

    /// The stress of a state that was kept.
    pub fn stress(&self, mode: Mode, state: &State) -> f64 {
        let stress = match mode {
            Mode::Elastic => self.backbone.at(state.strain).stress,
            Mode::Virgin => self.virgin(state.strain).stress,
            Mode::Friction => {
                let springs = self.sliders().zip(&state.slip).map(|(s, t)| s.stiffness * t);
                self.backbone.at(state.strain).stress + springs.sum::<f64>()
            }
        };
        if self.one_sided { stress.max(0.0) } else { stress }
    }

    /// The answer to a strain reached in one straight step from a state, which is not changed: keep
    /// [`Response::state`] when the step is accepted. `q` is that of the start of the step.
    pub fn trial(&self, from: &State, strain: f64) -> Response {
        let ElasticResponse { stress, tangent, energy } = self.backbone.at(strain);
        let state = State { strain, ..*from };
        let mut r = Response { stress, tangent, state, dissipation: 0.0, energy };
        let step = strain - from.strain;
        let mut memory = r.state.slip.iter_mut();
        for family in &self.families {
            let q = family.widening.factor(from.strain);
            for (&Slider { stiffness, slip }, t) in family.sliders.iter().zip(&mut memory) {
                let (free, level) = (*t + step, slip * q);
                let kept = free.min(level).max(-level);
                let force = stiffness * kept;
                r.stress += force;
                r.energy += 0.5 * force * kept;
                r.dissipation += force * (free - kept);
                // On the very edge it still sticks; where the level is zero there is nothing to stick to.
                r.tangent += if kept == free && level > 0.0 { stiffness } else { 0.0 };
                *t = kept;
            }
        }
        self.cut(r)
    }

    /// The curve of first loading from strain 0, in small steps: slider j carries `w_j e` until its
    /// level is reached and `w_j x_j q(e)` from there.
    pub fn virgin(&self, strain: f64) -> ElasticResponse {
        let mut sum = self.backbone.at(strain);
        for family in &self.families {
            let growth = family.widening.growth(strain);
            for slider in &family.sliders {
                let part = slider.virgin(&family.widening, &growth, strain);
                sum.stress += part.stress;
                sum.tangent += part.tangent;
                sum.energy += part.energy;
            }
        }
        sum
    }

    /// The responses along a path of strains from a state.
    pub fn path<'a>(
        &'a self,
        from: State,
        strains: impl IntoIterator<Item = f64> + 'a,
    ) -> impl Iterator<Item = Response> + 'a {
        strains.into_iter().scan(from, |state, strain| {
            let response = self.trial(state, strain);
            *state = response.state;
            Some(response)
        })
    }

    /// Cuts stresses below zero off where the channel is one-sided.
    fn cut(&self, response: Response) -> Response {
        let slack = self.one_sided && response.stress < 0.0;
        if slack { Response { stress: 0.0, tangent: 0.0, ..response } } else { response }
    }
}

impl Slider {
    /// First loading; the level is overtaken once, as it grows more slowly than the strain.
    fn virgin(&self, widening: &Widening, growth: &Growth, strain: f64) -> ElasticResponse {
        let Self { stiffness: w, slip: x } = *self;
        let size = strain.abs();
        if size <= x * growth.q {
            return ElasticResponse { stress: w * strain, tangent: w, energy: 0.5 * w * strain * strain };
        }
        let start = self.overtaken(widening);
        let before = widening.growth(start.copysign(strain)).integral;
        ElasticResponse {
            stress: (w * x * growth.q).copysign(strain),
            tangent: w * x * growth.slope,
            energy: w * (0.5 * start * start + x * (growth.integral - before)),
        }
    }

    /// The strain at which first loading reaches the level: `e = x q(e)`.
    fn overtaken(&self, widening: &Widening) -> f64 {
        let x = self.slip;
        match widening {
            Widening::Constant => x,
            Widening::Loading(_) => 0.0,
            Widening::Quadratic { alpha, e_max } if x * (1.0 + alpha) >= *e_max => x * (1.0 + alpha),
            // The smaller root of x alpha (e/e_max)² - e + x = 0.
            Widening::Quadratic { alpha, e_max } => {
                2.0 * x / (1.0 + (1.0 - 4.0 * alpha * (x / e_max).powi(2)).sqrt())
            }
        }
    }
}

impl TryFrom<Parts> for Channel {
    type Error = LawError;

    fn try_from(parts: Parts) -> Result<Self, LawError> {
        Self::new(parts.backbone, parts.families, parts.one_sided)
    }
}

impl From<Channel> for Parts {
    fn from(Channel { backbone, families, one_sided }: Channel) -> Self {
        Self { backbone, families, one_sided }
    }
}
