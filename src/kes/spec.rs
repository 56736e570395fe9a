//! What is to be known of a test, and what follows from it.

use serde::{Deserialize, Serialize};

use super::Parameter;
use super::test::{Role, Test};
use crate::quantity::{QuantityError, Unit};

/// What the record of a test looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// To a set load and back: a loading and an unloading branch on one side of zero.
    Rise,
    /// To a set strain on both sides of zero and back: a loop about the origin.
    Loop,
    /// Along the cloth and back: a profile over the position. No law of the cloth, and no stiffness, comes of it.
    Sweep,
}

/// A dimension of a specimen or of the instrument by which something was divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Divisor {
    /// Area of the foot (m²).
    Area,
    /// Length between the jaws (m).
    Gauge,
    /// Width of the specimen (m).
    Width,
    /// Load on the contactor (N).
    Contact,
    /// Full scale of an analogue output (V).
    Voltage,
}

/// An axis of a record.
#[derive(Clone, Copy, Debug)]
pub struct AxisSpec {
    /// In sentences and in exchange files, e.g. `moment per width`.
    pub name: &'static str,
    /// On charts, e.g. `Moment per width M`.
    pub label: &'static str,
    /// The SI unit in which samples are kept.
    pub si: &'static str,
    /// The customary unit of the KES literature.
    pub kes: &'static str,
    /// The unit that charts name beside it, and its SI value.
    pub beside: Option<(&'static str, f64)>,
    /// What a column of it may hold, the customary one first. One that no other test has tells the test.
    pub columns: &'static [Role],
    /// What raw force, moment or travel is divided by.
    pub raw_by: Option<Divisor>,
    /// Units that would do, for a message.
    pub accepted: &'static str,
}

impl AxisSpec {
    /// SI value of one KES unit.
    pub fn kes_factor(&self) -> f64 {
        // A test of the charts reads the units of all axes.
        Unit::parse(self.kes).map_or(f64::NAN, |u| u.factor)
    }
}

/// The stiffness that a virtual test shows.
#[derive(Clone, Copy, Debug)]
pub struct StiffnessSpec {
    /// E.g. `B`.
    pub symbol: &'static str,
    /// The SI unit.
    pub unit: &'static str,
    /// The parameter that is measured of it; none where it is a modulus of the settings.
    pub parameter: Option<Parameter>,
}

/// What is to be known of a test: what it is called, what its record holds, its standard specimen, and how it is run.
#[derive(Clone, Copy, Debug)]
pub struct TestSpec {
    /// E.g. `bending`.
    pub name: &'static str,
    /// E.g. `KES-FB2`.
    pub instrument: &'static str,
    /// What its record looks like.
    pub shape: Shape,
    /// What is set of a test that rises to a load, in one word; nothing of the others.
    pub load: Option<&'static str>,
    /// Whether it is made along a direction of the cloth.
    pub is_directional: bool,
    /// The abscissa.
    pub x: AxisSpec,
    /// The ordinate.
    pub y: AxisSpec,
    /// Whether the abscissa falls while the load rises, as a thickness does.
    pub x_falls: bool,
    /// The parameter that laws are brought to, and whose middle specimen charts emphasise.
    pub leading: Parameter,
    /// The width of its loop that laws are brought to.
    pub loop_width: Option<Parameter>,
    /// What a virtual test shows; none where there is no virtual test, or no stiffness comes of it.
    pub stiffness: Option<StiffnessSpec>,
    /// Width between the free edges (m).
    pub width: f64,
    /// Length between jaws or clamps (m); 0 of compression and of the surface, which have none.
    pub gauge: f64,
    /// The set maximum: force per width (N/m), shear angle (rad), curvature (1/m), pressure (Pa) or sweep (m).
    pub maximum: f64,
    /// A text such as `500 gf/cm` as a maximum (SI).
    pub read_maximum: fn(&str) -> Result<f64, QuantityError>,
    /// The set maximum as people write it.
    pub customary_maximum: &'static str,
    /// Constant tension across the specimen, or along a sweep (N/m); 0 of the others.
    pub pretension: f64,
    /// Load on a contactor (N); 0 but of the surface.
    pub contact: f64,
    /// Abscissae that are shown where there is no record (SI).
    pub range: [f64; 2],
}

impl TestSpec {
    /// The axis that has the set maximum: the ordinate where a load is set, else the abscissa.
    pub fn driven(&self) -> &AxisSpec {
        match self.shape {
            Shape::Rise => &self.y,
            Shape::Loop | Shape::Sweep => &self.x,
        }
    }
}

impl Test {
    /// `tensile`, `shear`, `bending`, `compression`, `friction` or `roughness`.
    pub fn name(self) -> &'static str {
        self.spec().name
    }

    /// What its record looks like.
    pub fn shape(self) -> Shape {
        self.spec().shape
    }

    /// Whether it is made along a direction of the cloth.
    pub fn is_directional(self) -> bool {
        self.spec().is_directional
    }

    /// SI units of abscissa and ordinate.
    pub fn axes(self) -> [&'static str; 2] {
        [self.spec().x.si, self.spec().y.si]
    }

    /// Units of abscissa and ordinate in the KES literature.
    pub fn kes_axes(self) -> [&'static str; 2] {
        [self.spec().x.kes, self.spec().y.kes]
    }

    /// The KES unit of the set maximum: that of the ordinate where a load is set, else that of the abscissa.
    pub fn kes_maximum(self) -> &'static str {
        self.spec().driven().kes
    }

    /// The instrument, e.g. `KES-FB2`.
    pub fn instrument(self) -> &'static str {
        self.spec().instrument
    }

    /// The test of an instrument that a text in lower case names, if it has but one: `fb2`, and not `fb1`.
    pub fn of_instrument(text: &str) -> Option<Self> {
        let is_alone =
            |test: &Self| Self::ALL.iter().filter(|t| t.instrument() == test.instrument()).count() == 1;
        let is_named =
            |test: &Self| text.contains(&test.instrument().trim_start_matches("KES-").to_lowercase());
        Self::ALL.into_iter().filter(is_alone).find(is_named)
    }

    /// The only test whose abscissa a column of this kind is.
    pub fn of_abscissa(role: Role) -> Option<Self> {
        only(|test| test.spec().x.columns.contains(&role))
    }

    /// The only test whose ordinate a column of this kind is.
    pub fn of_ordinate(role: Role) -> Option<Self> {
        only(|test| test.spec().y.columns.contains(&role))
    }
}

/// The test for which something holds; none where it holds for several.
fn only(holds: impl Fn(Test) -> bool) -> Option<Test> {
    let mut tests = Test::ALL.into_iter().filter(|test| holds(*test));
    tests.next().filter(|_| tests.next().is_none())
}

impl Role {
    /// Whether it is the abscissa of a curve.
    pub fn is_abscissa(self) -> bool {
        Test::ALL.into_iter().any(|test| test.spec().x.columns.contains(&self))
    }

    /// The role of a column beside the position of a sweep: what moves there is the contactor, up and down.
    pub(crate) fn in_sweep(self) -> Self {
        match self {
            Self::Thickness | Self::Displacement => Self::Height,
            other => other,
        }
    }

    /// Whether it is measured along a sweep only.
    pub(crate) fn is_of_sweep(self) -> bool {
        Test::of_ordinate(self).is_some_and(|test| test.shape() == Shape::Sweep)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A heading that several tests have does not tell which it is.
    #[test]
    fn columns_of_one_test_tell_it() {
        assert_eq!(Test::of_abscissa(Role::Curvature), Some(Test::Bending));
        assert_eq!(Test::of_ordinate(Role::Pressure), Some(Test::Compression));
        assert_eq!(Test::of_ordinate(Role::Height), Some(Test::Roughness));
        for shared in [Role::Displacement, Role::Position] {
            assert_eq!(Test::of_abscissa(shared), None, "{shared:?}");
        }
        assert_eq!(Test::of_ordinate(Role::Ignored), None);
    }
}
