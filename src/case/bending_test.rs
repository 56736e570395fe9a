//! `[bending_test]`: a bending test of another instrument than KES.

use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::material::{FabricMaterial, Material};
use crate::finding::Node;
use crate::instrument::fab::FabKind;
use crate::quantity::Length;

/// `[bending_test]`: a strip in large rotations, once along the warp and once along the weft (a FAB test
/// along the bias too).
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct BendingTestTable {
    /// Which test.
    pub test: BendingKind,
    /// Elements along the strip of a cantilever, along half of a loop, 4 at least; along a long heart
    /// loop as many as its bends need when left out.
    #[cfg_attr(test, schemars(extend("default" = 32)))]
    cells: Option<usize>,
    /// Width of a cantilever or heart loop with free edges; left out, the strip bends to a cylinder.
    width: Option<Length>,
    /// Length of the strip of a heart loop.
    length: Option<Length>,
    /// Tests of a FAB record that the law is identified from, a short one among them: the others are predicted by it. All
    /// tests of a direction when left out.
    from: Option<Vec<BendTestName>>,
}

/// The bend tests of a FAB record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) enum BendTestName {
    /// Bent upwards at the short clamp distance.
    U1,
    /// Bent downwards at the short clamp distance.
    D1,
    /// Bent downwards at the long clamp distance.
    D2,
}

impl BendTestName {
    fn kind(self) -> FabKind {
        match self {
            Self::U1 => FabKind::U1,
            Self::D1 => FabKind::D1,
            Self::D2 => FabKind::D2,
        }
    }
}

/// The bending tests of a strip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub(super) enum BendingKind {
    /// Peirce, Shirley, FAST-2: the overhang at 41.5°.
    Cantilever,
    /// A strip hung by both ends, which point upwards.
    HeartLoop,
    /// FAB: force against the distance of two clamps; the fabric must bring the records.
    FabBendLoop,
}

/// A bending test.
#[derive(Clone, Debug)]
pub enum BendingTest {
    /// Of a strip with a section, along warp and weft.
    Strip(StripBending),
    /// The bend loops of FAB, with the records of a fabric.
    FabBendLoop(FabBendLoop),
}

/// A bending test of a strip.
#[derive(Clone, Debug)]
pub struct StripBending {
    /// How the strip is bent.
    pub kind: StripKind,
    /// The strip.
    pub strip: Strip,
}

/// How a strip is bent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StripKind {
    /// Peirce, Shirley, FAST-2: the overhang at 41.5°.
    Cantilever,
    /// Hung by both ends, which point upwards.
    HeartLoop {
        /// Its length.
        length: Length,
    },
}

impl StripKind {
    /// Whether the strip is simulated with the friction of its fabric too.
    pub fn has_friction(&self) -> bool {
        match self {
            Self::Cantilever => true,
            Self::HeartLoop { .. } => false,
        }
    }
}

/// FAB: force against the distance of two clamps, beside the records of a fabric.
#[derive(Clone, Debug)]
pub struct FabBendLoop {
    /// The fabric.
    pub fabric: FabricMaterial,
    /// Elements along half of the strip, 4 at least, where the case says so.
    pub cells: Option<usize>,
    /// The tests that serve to identify the law; empty for all.
    pub from: Vec<FabKind>,
}

/// The name of each bending test in a case, and what it gives, for lists.
pub const BENDING_TESTS: [(&str, &str); 3] = [
    ("cantilever", "overhang at 41.5 degrees, bending length"),
    ("heart_loop", "strip hung by both ends: height, and B from it"),
    ("fab_bend_loop", "FAB force against clamp distance: B, predictions"),
];

/// A strip that is bent.
#[derive(Clone, Debug)]
pub struct Strip {
    /// What it is made of.
    pub material: Material,
    /// Elements along it, or along half of a loop, 4 at least, where the case says so.
    pub cells: Option<usize>,
    /// Its width with free edges; without, it bends to a cylinder.
    pub width: Option<Length>,
}

impl BendingTestTable {
    /// Whether the test needs records of a fabric.
    pub fn uses_records(&self) -> bool {
        match self.test {
            BendingKind::FabBendLoop => true,
            BendingKind::Cantilever | BendingKind::HeartLoop => false,
        }
    }

    /// The test of the table at a node, in the table of a case.
    pub fn checked(
        &self,
        at: &Node<'_>,
        material: Material,
        case: &Node<'_>,
    ) -> Result<BendingTest, CaseError> {
        if self.cells.is_some_and(|c| c < 4) {
            let message = "a [bending_test] needs at least 4 `cells` along the strip";
            return refused(at.value_place("cells"), message);
        }
        for (key, length) in [("length", self.length), ("width", self.width)] {
            if length.is_some_and(|l| l.si() <= 0.0) {
                let example = if key == "length" { "15 cm" } else { "2.5 cm" };
                let message = format!("[bending_test] `{key}` must be positive, such as \"{example}\"");
                return refused(at.value_place(key), message);
            }
        }
        let cells = self.cells;
        let of_strip = |kind, material| {
            Ok(BendingTest::Strip(StripBending { kind, strip: Strip { material, cells, width: self.width } }))
        };
        let from: Vec<FabKind> = self.from.iter().flatten().map(|t| t.kind()).collect();
        if self.from.is_some() && !self.uses_records() {
            return refused(at.key_place("from"), "only a fab_bend_loop has `from`: remove it");
        }
        if self.from.is_some() && from.iter().all(|kind| *kind == FabKind::D2) {
            let message =
                "`from` needs a short test, \"U1\" or \"D1\": the long one is governed by its weight";
            return refused(at.value_place("from"), message);
        }
        match (self.test, self.length, material) {
            (BendingKind::Cantilever, None, material) => of_strip(StripKind::Cantilever, material),
            (BendingKind::Cantilever, Some(_), _) => {
                refused(at.key_place("length"), "a cantilever finds its own length: remove `length`")
            }
            (BendingKind::HeartLoop, Some(length), material) => {
                of_strip(StripKind::HeartLoop { length }, material)
            }
            (BendingKind::HeartLoop, None, _) => {
                let message = "a heart_loop needs the `length` of its strip, such as \"15 cm\"";
                refused(at.place(), message)
            }
            (BendingKind::FabBendLoop, length, _) if length.or(self.width).is_some() => {
                let key = if length.is_some() { "length" } else { "width" };
                refused(
                    at.key_place(key),
                    "the records of a fab_bend_loop say the size of the strip: remove `length` and `width`",
                )
            }
            (BendingKind::FabBendLoop, _, Material::Fabric(fabric)) => {
                Ok(BendingTest::FabBendLoop(FabBendLoop { fabric, cells, from }))
            }
            (BendingKind::FabBendLoop, _, Material::Section(_)) => refused(
                case.key_place("section"),
                "a fab_bend_loop needs the records of a fabric: name a `fabric` in the place of the [section]",
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bending_test_is_listed_under_its_name() {
        for (name, _) in BENDING_TESTS {
            let kind: Result<BendingKind, _> = serde_json::from_value(name.into());
            assert!(kind.is_ok(), "{name}");
        }
        let schema = schemars::schema_for!(BendingKind);
        assert_eq!(schema.get("oneOf").unwrap().as_array().unwrap().len(), BENDING_TESTS.len());
    }
}
