//! `[bending_test]`: a bending test of another instrument than KES.

use serde::Deserialize;

use crate::quantity::Length;

/// `[bending_test]`: a strip in large rotations, once along the warp and once along the weft (a FAB test
/// along the bias too).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BendingTest {
    /// Which test.
    pub test: BendingKind,
    /// Elements along the strip of a cantilever, along half of a loop; 32, and along a long heart loop as many as its
    /// bends need.
    pub cells: Option<usize>,
    /// Width of a cantilever or heart loop with free edges; left out, the strip bends to a cylinder.
    pub width: Option<Length>,
    /// Length of the strip of a heart loop.
    pub length: Option<Length>,
}

/// The bending tests of a strip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BendingKind {
    /// Peirce, Shirley, FAST-2: the overhang at 41.5°.
    Cantilever,
    /// A strip hung by both ends, which point upwards.
    HeartLoop,
    /// FAB: force against the distance of two clamps; the fabric must bring the records.
    FabBendLoop,
}

impl BendingTest {
    /// What does not fit together, if anything does not.
    pub(super) fn contradiction(&self) -> Option<&'static str> {
        match self.test {
            _ if self.cells.is_some_and(|c| c < 4) => {
                Some("a [bending_test] needs at least 4 `cells` along the strip")
            }
            BendingKind::HeartLoop if self.length.is_none() => {
                Some("a heart_loop needs the `length` of its strip, such as \"15 cm\"")
            }
            BendingKind::Cantilever if self.length.is_some() => {
                Some("a cantilever finds its own length: remove `length`")
            }
            BendingKind::FabBendLoop if self.length.or(self.width).is_some() => {
                Some("the records of a fab_bend_loop say the size of the strip: remove `length` and `width`")
            }
            _ if self.length.is_some_and(|l| l.si() <= 0.0) => {
                Some("[bending_test] `length` must be positive, such as \"15 cm\"")
            }
            _ if self.width.is_some_and(|w| w.si() <= 0.0) => {
                Some("[bending_test] `width` must be positive, such as \"2.5 cm\"")
            }
            _ => None,
        }
    }
}
