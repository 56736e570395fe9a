//! Why there is no chart.

use crate::finding::errors;

errors! {
    /// Why there is no chart.
    #[derive(Clone, Debug, PartialEq)]
    pub enum ChartError {
        /// O010: neither a curve nor the parameters that a schematic needs.
        "O010" NothingToDraw {
            /// Which chart.
            chart: String,
            /// The fabric or case.
            name: String,
            /// What would be needed.
            missing: String,
        } = "no {chart} chart of {name}: {missing}";
        /// O011: lists that belong together have different lengths, or an index points past the nodes.
        "O011" Inconsistent {
            /// The chart's title.
            name: String,
            /// What does not fit.
            problem: String,
        } = "the data of the chart {name} do not fit together: {problem}";
        /// O012: the drawing library or the PNG encoder failed.
        "O012" Drawing {
            /// What it said.
            problem: String,
        } = "drawing failed: {problem}";
    }
}

impl ChartError {
    /// What a library that draws or encodes says.
    pub(super) fn drawing(error: impl std::fmt::Display) -> Self {
        Self::Drawing { problem: error.to_string() }
    }
}
