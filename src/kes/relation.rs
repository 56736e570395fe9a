//! What the parameters of one fabric must obey together, whatever the fabric: a unit slip of a single value shows here
//! where no range of a population can show it.

use serde::{Deserialize, Serialize};

use super::Parameter;

/// A relation between parameters, with the ratio that tells whether it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Relation {
    /// WT over LT Fm EMT / 2: one by definition.
    TensileEnergy,
    /// WC over LC Pm (T0 − Tm) / 2: one by definition.
    CompressionEnergy,
    /// EMC over (T0 − Tm) / T0: one by definition.
    Compressibility,
    /// Tm over T0: cloth is not thicker under more pressure.
    CompressedThickness,
    /// 2HB / (2 B), the curvature that is left without a moment, over the maximum of the test.
    ResidualCurvature,
    /// 2HG / (2 G), the angle that is left without a force, over the maximum of the test.
    ResidualAngle,
    /// 2HG5 over 2HG.
    ShearHysteresis,
    /// W over T0, in kg/m³: the density of cloth is below that of its fibres.
    Density,
    /// MMD over MIU: a mean deviation is less than the mean.
    FrictionDeviation,
}

impl Relation {
    /// Every relation.
    pub const ALL: [Self; 9] = [
        Self::TensileEnergy,
        Self::CompressionEnergy,
        Self::Compressibility,
        Self::CompressedThickness,
        Self::ResidualCurvature,
        Self::ResidualAngle,
        Self::ShearHysteresis,
        Self::Density,
        Self::FrictionDeviation,
    ];

    /// The parameters that it is about.
    pub fn parameters(self) -> &'static [Parameter] {
        use Parameter as P;
        match self {
            Self::TensileEnergy => &[P::Wt, P::Lt, P::Emt],
            Self::CompressionEnergy => &[P::Wc, P::Lc, P::T0, P::Tm],
            Self::Compressibility => &[P::Emc, P::T0, P::Tm],
            Self::CompressedThickness => &[P::Tm, P::T0],
            Self::ResidualCurvature => &[P::Hb, P::B],
            Self::ResidualAngle => &[P::Hg, P::G],
            Self::ShearHysteresis => &[P::Hg5, P::Hg],
            Self::Density => &[P::W, P::T0],
            Self::FrictionDeviation => &[P::Mmd, P::Miu],
        }
    }

    /// Between which values the ratio of cloth lies.
    ///
    /// Definitions hold to a quarter: of a table the mean of products is compared with the product of means. Residual
    /// strains lie below half of the maximum (beyond it the loop would be all friction) and above a five-hundredth of
    /// it (below, less than an instrument tells); Tm lies below T0 by more than a two-hundredth for the same reason. Fibres have 900 (polypropylene) to 2600 kg/m³ (glass), textile
    /// fibres up to 1600 (Morton and Hearle, Physical Properties of Textile Fibres, 4th ed., 2008, ch. 5); the lightest
    /// fabrics are three hundredths fibre. Friction at 5° lies at or above that at 0.5° (Kawabata 1980).
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::TensileEnergy | Self::CompressionEnergy | Self::Compressibility => [0.75, 1.33],
            Self::CompressedThickness => [0.1, 0.995],
            Self::ResidualCurvature | Self::ResidualAngle => [0.002, 0.5],
            Self::ShearHysteresis => [0.7, 10.0],
            Self::Density => [30.0, 1600.0],
            Self::FrictionDeviation => [0.0, 1.0],
        }
    }

    /// What the ratio is, for people.
    pub fn text(self) -> &'static str {
        match self {
            Self::TensileEnergy => "WT / (LT Fm EMT / 2), which is 1 by definition,",
            Self::CompressionEnergy => "WC / (LC Pm (T0 − Tm) / 2), which is 1 by definition,",
            Self::Compressibility => "EMC / ((T0 − Tm) / T0), which is 1 by definition,",
            Self::CompressedThickness => "Tm / T0",
            Self::ResidualCurvature => "the residual curvature 2HB / (2 B) over the maximum curvature",
            Self::ResidualAngle => "the residual angle 2HG / (2 G) over the maximum angle",
            Self::ShearHysteresis => "2HG5 / 2HG",
            Self::Density => "the density W / T0 (kg/m³)",
            Self::FrictionDeviation => "MMD / MIU",
        }
    }
}
