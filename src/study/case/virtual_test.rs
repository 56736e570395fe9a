//! `[virtual_test]`: an instrument's test.

use serde::Deserialize;

use crate::instrument::Test;
use crate::quantity::Curvature;

/// `[virtual_test]`: an instrument's test as a model, once along the warp and once along the weft.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VirtualTest {
    /// Which test.
    pub test: Test,
    /// Elements along the gauge length and across the specimen.
    #[serde(default = "default_cells")]
    pub cells: [usize; 2],
    /// Largest curvature of a bending test; 2.5 1/cm.
    pub curvature: Option<Curvature>,
}

fn default_cells() -> [usize; 2] {
    [10, 20]
}
