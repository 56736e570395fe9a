//! Charts of 6 in x 4.5 in, as PNG files of 300 dpi, as SVG and as PDF files; no date is in any of them.
//!
//! Warp is blue and solid, weft vermillion and dashed (Okabe-Ito colours), so that a chart is read
//! by every eye and on a grey printer. KES units stand at the left and bottom, SI at the right and top.
//! The legend, the values and the errors have a column of their own beside the plot.
//!
//! Every function returns a [`Chart`], which gives the bytes of its files; `report::OutputFolder` writes them.

mod axes;
mod bitmap;
mod camera;
mod canvas;
mod contour;
mod curves;
mod drape;
mod error;
mod fabric;
mod field;
mod fonts;
mod force;
mod friction;
mod head;
mod history;
mod letters;
mod loops;
mod marks;
mod output;
mod palette;
mod panel;
mod parity;
#[cfg(feature = "pdf")]
mod pdf;
mod profile;
mod schematic;
mod spread;
mod surface;
mod svg;
mod view;

pub use curves::{CurvesPlot, curves};
pub use drape::{DrapePlot, drape_shadow, drape_view};
pub use error::ChartError;
pub use fabric::{SimulatedCurve, bending, compression, of_test, shear, tensile};
pub use field::{FieldPlot, field};
pub use force::{ForcePlot, bend_loops};
pub use friction::friction;
pub use history::{HistoryPanel, HistoryPlot, history};
pub use output::{Chart, Format};
pub use parity::{ParityPoint, parity};
pub use profile::{ProfileLine, ProfilePlot, profile};
pub use view::{ViewPlot, sheet_view};

/// Colour of a value that is a part (0 to 1) of the largest, red, green and blue.
pub(crate) fn value_color(part: f64) -> [u8; 3] {
    let color = palette::sequential(part);
    [color.0, color.1, color.2]
}

#[cfg(test)]
mod tests;
