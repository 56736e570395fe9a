//! How bend loops are simulated, and why they cannot be.

use crate::finding::errors;
use crate::instrument::fab::FabKind;
use crate::law::LawError;

/// How the tests are simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopSettings {
    /// Elements on half of the strip.
    pub cells: usize,
    /// Steps from one sample to the next.
    pub steps: usize,
    /// The tests that serve to identify; all where none is named.
    pub from: Vec<FabKind>,
    /// Whether every test is predicted by laws of the others as well.
    pub held_out: bool,
}

impl LoopSettings {
    /// Whether a test serves to identify.
    pub(super) fn serves(&self, test: FabKind) -> bool {
        self.from.is_empty() || self.from.contains(&test)
    }
}

impl Default for LoopSettings {
    /// 32 elements on half of the strip, one step from sample to sample; all tests serve, and none is held out.
    fn default() -> Self {
        Self { cells: 32, steps: 1, from: Vec::new(), held_out: false }
    }
}

errors! {
    /// Why a strip cannot be bent as its record says.
    #[derive(Clone, Debug, PartialEq)]
    pub enum LoopError {
        from {
            /// M020: numbers that make no law.
            Law(LawError),
        }
        /// S005: no equilibrium between the clamps.
        "S005" Stuck {
            /// The test.
            test: FabKind,
            /// The clamp distance that was not reached (m).
            distance: f64,
        } = "test {} cannot be followed: no shape of a strip of its length was found at a clamp distance of {} cm: look at \
             `length` and at the distances of this test", test.name(), crate::quantity::significant(1e2 * distance);
    }
}
