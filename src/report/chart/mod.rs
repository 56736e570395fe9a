//! Charts as PNG files: 300 dpi, 6 in x 4.5 in, built-in font, no date in the file.
//!
//! Warp is blue and solid, weft vermillion and dashed (Okabe-Ito colours), so that a chart is read
//! by every eye and on a grey printer. KES units stand at the left and bottom, SI at the right and top.
//! The legend, the values and the errors have a column of their own beside the plot.
//!
//! Every function returns the bytes of the file; `report::OutputFolder` writes them.

mod axes;
mod canvas;
mod contour;
mod drape;
mod error;
mod fabric;
mod field;
mod force;
mod friction;
mod head;
mod letters;
mod loops;
mod marks;
mod palette;
mod panel;
mod parity;
mod profile;
mod schematic;
mod spread;

pub use drape::{DrapePlot, drape_shadow, drape_view};
pub use error::ChartError;
pub use fabric::{SimulatedCurve, bending, compression, of_test, shear, tensile};
pub use field::{FieldPlot, field};
pub use force::{ForcePlot, bend_loops};
pub use friction::friction;
pub use parity::{ParityPoint, parity};
pub use profile::{ProfileLine, ProfilePlot, profile};

#[cfg(test)]
mod tests;
