//! Test conditions: what a file states, else what its owner states, else the standard set.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Visitor};

use super::dialect::HeaderKey;
use super::{Conditions, Direction, Measurement, Source, Test};
#[cfg(test)]
use crate::quantity::schema;
use crate::quantity::{Curve, Force, Length, LineForce, deserialize_by};

/// Conditions that files leave out; the `[conditions]` of fabric.toml and of dialects.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StatedConditions {
    /// Specimen width in every test.
    pub width: Option<Length>,
    /// What is stated of single tests, `[conditions.tensile]` and so on.
    pub tests: BTreeMap<Test, TestConditions>,
}

/// What is stated of one test.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TestConditions {
    /// Specimen width.
    pub width: Option<Length>,
    /// Distance between jaws or clamps.
    pub gauge: Option<Length>,
    /// The set maximum (SI): see [`TestSpec::maximum`](crate::kes::TestSpec::maximum).
    pub maximum: Option<f64>,
    /// Constant tension per width, across the specimen or along a sweep.
    pub pretension: Option<LineForce>,
    /// Load on a contactor: a friction force is divided by it.
    pub contact: Option<Force>,
}

impl TestConditions {
    fn or(&self, other: &Self) -> Self {
        Self {
            width: self.width.or(other.width),
            gauge: self.gauge.or(other.gauge),
            maximum: self.maximum.or(other.maximum),
            pretension: self.pretension.or(other.pretension),
            contact: self.contact.or(other.contact),
        }
    }
}

/// The width of all specimens, beside the tables of tests.
const WIDTH: &str = "width";

/// What may be stated of a test: a specimen has a size where there are jaws or clamps, and a tension or a load on a
/// contactor where the test has one.
fn keys(test: Test) -> Vec<&'static str> {
    let spec = test.spec();
    let all = [
        (WIDTH, spec.gauge != 0.0),
        ("gauge", spec.gauge != 0.0),
        ("maximum", true),
        ("pretension", spec.pretension != 0.0),
        ("contact", spec.contact != 0.0),
    ];
    all.into_iter().filter(|(_, is_known)| *is_known).map(|(key, _)| key).collect()
}

impl<'de> Deserialize<'de> for StatedConditions {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        d.deserialize_map(OfTests)
    }
}

/// Reads the table of all tests.
struct OfTests;

impl<'de> Visitor<'de> for OfTests {
    type Value = StatedConditions;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<StatedConditions, A::Error> {
        let known: Vec<&str> = std::iter::once(WIDTH).chain(Test::ALL.map(Test::name)).collect();
        let mut stated = StatedConditions::default();
        while let Some(key) = map.next_key_seed(KeyOf(&known))? {
            match Test::ALL.into_iter().find(|test| test.name() == key) {
                Some(test) => {
                    let of_test = map.next_value_seed(OfTest(test))?;
                    stated.tests.insert(test, of_test);
                }
                None => stated.width = Some(map.next_value_seed(ABOVE_ZERO)?),
            }
        }
        Ok(stated)
    }
}

/// Reads the table of a test.
struct OfTest(Test);

impl<'de> DeserializeSeed<'de> for OfTest {
    type Value = TestConditions;

    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<TestConditions, D::Error> {
        d.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for OfTest {
    type Value = TestConditions;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<TestConditions, A::Error> {
        let mut stated = TestConditions::default();
        while let Some(key) = map.next_key_seed(KeyOf(&keys(self.0)))? {
            match key {
                WIDTH => stated.width = Some(map.next_value_seed(ABOVE_ZERO)?),
                "gauge" => stated.gauge = Some(map.next_value_seed(ABOVE_ZERO)?),
                "pretension" => stated.pretension = Some(map.next_value_seed(NOT_NEGATIVE)?),
                "contact" => {
                    stated.contact = Some(map.next_value_seed(Within { si: Force::si, zero: false })?)
                }
                _ => stated.maximum = Some(map.next_value_seed(MaximumOf(self.0))?),
            }
        }
        Ok(stated)
    }
}

/// Reads the maximum of a test.
struct MaximumOf(Test);

impl<'de> DeserializeSeed<'de> for MaximumOf {
    type Value = f64;

    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<f64, D::Error> {
        let maximum = deserialize_by(d, self.0.spec().read_maximum, self.0.spec().customary_maximum)?;
        within(maximum, false)
    }
}

/// Reads a quantity that is not below zero, nor zero unless that may be.
struct Within<T> {
    si: fn(T) -> f64,
    zero: bool,
}

const ABOVE_ZERO: Within<Length> = Within { si: Length::si, zero: false };
/// A specimen may be sheared without a tension.
const NOT_NEGATIVE: Within<LineForce> = Within { si: LineForce::si, zero: true };

impl<'de, T: Deserialize<'de> + Copy> DeserializeSeed<'de> for Within<T> {
    type Value = T;

    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<T, D::Error> {
        let value = T::deserialize(d)?;
        within((self.si)(value), self.zero).map(|_| value)
    }
}

fn within<E: Error>(si: f64, zero: bool) -> Result<f64, E> {
    match si.partial_cmp(&0.0) {
        Some(Ordering::Greater) => Ok(si),
        Some(Ordering::Equal) if zero => Ok(si),
        _ => Err(E::custom(if zero { "it must not be below zero" } else { "it must be above zero" })),
    }
}

/// Reads one of the known keys.
struct KeyOf<'k>(&'k [&'static str]);

impl<'de> DeserializeSeed<'de> for KeyOf<'_> {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<&'static str, D::Error> {
        d.deserialize_identifier(self)
    }
}

impl Visitor<'_> for KeyOf<'_> {
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E: Error>(self, found: &str) -> Result<&'static str, E> {
        // In the words of derived deserialisers, which are worded anew in one place.
        let unknown = || {
            let known: Vec<String> = self.0.iter().map(|key| format!("`{key}`")).collect();
            E::custom(format!("unknown field `{found}`, expected one of {}", known.join(", ")))
        };
        self.0.iter().find(|key| **key == found).copied().ok_or_else(unknown)
    }
}

#[cfg(test)]
impl schemars::JsonSchema for StatedConditions {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "StatedConditions".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let mut properties = serde_json::Map::new();
        let width = described(generator.subschema_for::<Length>(), "Specimen width in every test.");
        properties.insert(WIDTH.into(), width);
        for test in Test::ALL {
            properties.insert(test.name().into(), schema_of(test, generator));
        }
        schemars::json_schema!({
            "type": "object",
            "additionalProperties": false,
            "properties": properties,
            "description": "Conditions that files leave out; the `[conditions]` of fabric.toml and of dialects.",
        })
    }
}

#[cfg(test)]
fn schema_of(test: Test, generator: &mut schemars::SchemaGenerator) -> serde_json::Value {
    let spec = test.spec();
    let mut properties = serde_json::Map::new();
    for key in keys(test) {
        let (schema, text) = match key {
            WIDTH => (generator.subschema_for::<Length>(), "Specimen width.".to_string()),
            "gauge" => (generator.subschema_for::<Length>(), "Distance between jaws or clamps.".to_string()),
            "pretension" => {
                (generator.subschema_for::<LineForce>(), "Constant tension per width.".to_string())
            }
            "contact" => {
                let text = "Load on the contactor: a friction force is divided by it.";
                (generator.subschema_for::<Force>(), text.to_string())
            }
            _ => {
                let schema = schema(
                    spec.driven().si,
                    spec.customary_maximum,
                    &schemars::generate::Contract::Deserialize,
                );
                (schema, format!("Set maximum: {}.", spec.driven().name))
            }
        };
        properties.insert(key.into(), described(schema, &text));
    }
    serde_json::json!({
        "type": "object",
        "additionalProperties": false,
        "properties": properties,
        "description": format!("{}, {}.", spec.instrument, spec.name),
    })
}

#[cfg(test)]
fn described(mut schema: schemars::Schema, text: &str) -> serde_json::Value {
    schema.insert("description".into(), text.into());
    schema.to_value()
}

/// The standard set of conditions of a test; see [`TestSpec`](crate::kes::TestSpec).
pub fn standard_conditions(test: Test) -> Conditions {
    let spec = test.spec();
    Conditions {
        width: spec.width,
        gauge: spec.gauge,
        maximum: spec.maximum,
        pretension: spec.pretension,
        contact: spec.contact,
    }
}

impl Measurement {
    /// A record of no file (SI, the axes those of the test), taken under the standard conditions of its test.
    pub fn of_curve(test: Test, direction: Option<Direction>, specimen: usize, curve: Curve) -> Self {
        Self {
            test,
            sample: None,
            direction,
            specimen,
            conditions: standard_conditions(test),
            curve,
            lines: Vec::new(),
            source: Source::default(),
            metadata: BTreeMap::new(),
            caption: None,
        }
    }
}

impl StatedConditions {
    /// `self` where it states something, else `other`.
    pub(super) fn or(&self, other: &Self) -> Self {
        let mut tests = other.tests.clone();
        for (test, stated) in &self.tests {
            tests.entry(*test).and_modify(|of_other| *of_other = stated.or(of_other)).or_insert(*stated);
        }
        Self { width: self.width.or(other.width), tests }
    }

    fn of(&self, test: Test) -> TestConditions {
        self.tests.get(&test).copied().unwrap_or_default()
    }

    /// Whether a condition of a test is stated; otherwise it is that of the standard set.
    pub(super) fn states(&self, test: Test, key: HeaderKey) -> bool {
        let stated = self.of(test);
        match key {
            HeaderKey::Contact => stated.contact.is_some(),
            HeaderKey::Width => stated.width.or(self.width).is_some(),
            HeaderKey::Gauge => stated.gauge.is_some(),
            HeaderKey::Maximum => stated.maximum.is_some(),
            HeaderKey::Pretension => stated.pretension.is_some(),
            _ => false,
        }
    }

    /// The standard set with everything that is stated here put over it.
    pub fn over_standard(&self, test: Test) -> Conditions {
        let (stated, standard) = (self.of(test), standard_conditions(test));
        Conditions {
            width: stated.width.or(self.width).map_or(standard.width, Length::si),
            gauge: stated.gauge.map_or(standard.gauge, Length::si),
            maximum: stated.maximum.unwrap_or(standard.maximum),
            pretension: stated.pretension.map_or(standard.pretension, LineForce::si),
            contact: stated.contact.map_or(standard.contact, Force::si),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<StatedConditions, String> {
        toml::from_str(text).map_err(|error: toml::de::Error| {
            let from = error.span().map_or(0, |span| span.start);
            format!("{} at {}", error.message(), &text[from..])
        })
    }

    #[test]
    fn what_is_stated_goes_over_the_standard_and_wider_statements_give_way() {
        let own =
            read("width = \"10 cm\"\n[tensile]\ngauge = \"20 cm\"\n[shear]\nmaximum = \"4 deg\"").unwrap();
        let other =
            read("[tensile]\ngauge = \"1 cm\"\nmaximum = \"50 gf/cm\"\n[friction]\ncontact = \"25 gf\"")
                .unwrap();
        let both = own.or(&other);
        let tensile = both.over_standard(Test::Tensile);
        assert_eq!((tensile.width, tensile.gauge), (0.10, 0.20));
        approx::assert_relative_eq!(tensile.maximum, 49.03325);
        approx::assert_relative_eq!(both.over_standard(Test::Shear).maximum, 4f64.to_radians());
        approx::assert_relative_eq!(
            both.over_standard(Test::Friction).contact,
            0.245166,
            max_relative = 1e-5
        );
        assert!(both.states(Test::Tensile, HeaderKey::Gauge) && !both.states(Test::Shear, HeaderKey::Gauge));
        assert_eq!(
            both.over_standard(Test::Roughness),
            StatedConditions { width: both.width, ..Default::default() }.over_standard(Test::Roughness)
        );
    }

    #[test]
    fn what_a_test_does_not_have_cannot_be_stated() {
        let refused = |text: &str| read(text).unwrap_err();
        assert_eq!(
            refused("[compression]\ngauge = \"5 cm\""),
            "unknown field `gauge`, expected one of `maximum` at gauge = \"5 cm\""
        );
        assert!(
            refused("[stretch]\n").starts_with("unknown field `stretch`, expected one of `width`, `tensile`")
        );
        assert!(refused("[tensile]\ncontact = \"5 gf\"").starts_with("unknown field `contact`"));
        assert!(refused("[tensile]\nmaximum = 500").contains("500 gf/cm"));
        assert!(refused("[tensile]\nmaximum = \"5 cm\"").ends_with("at \"5 cm\""));
        for (key, value) in [("width", "0 cm"), ("gauge", "-5 cm"), ("maximum", "0 gf/cm")] {
            let expected = format!("it must be above zero at \"{value}\"");
            assert_eq!(refused(&format!("[tensile]\n{key} = \"{value}\"")), expected);
        }
        assert!(refused("width = \"-20 cm\"").starts_with("it must be above zero"));
        assert!(read("[shear]\npretension = \"0 gf/cm\"").is_ok());
        assert!(refused("[shear]\npretension = \"-1 gf/cm\"").starts_with("it must not be below zero"));
    }
}
