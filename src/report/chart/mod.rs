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
mod fabric;
mod field;
mod force;
mod friction;
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
pub use fabric::{SimulatedCurve, bending, compression, shear, tensile};
pub use field::{FieldPlot, field};
pub use force::{ForcePlot, bend_loops};
pub use friction::friction;
pub use parity::{ParityPoint, parity};
pub use profile::{ProfileLine, ProfilePlot, profile};

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

/// Title, subtitle and the mark of origin that every chart carries above the plot.
struct Head<'a> {
    title: &'a str,
    /// Follows the title, and stays where a long title is cut short.
    kind: &'a str,
    subtitle: &'a str,
    /// `measured data`, `synthetic data` ...; empty for none.
    origin: &'a str,
}

impl Head<'_> {
    fn draw(&self, canvas: &mut canvas::Canvas) -> Result<(), ChartError> {
        use canvas::WIDTH;
        use letters::{Align, Type};
        let right = WIDTH as f64 - 40.0;
        let mark = Type::new(26.0, palette::INK).bold().align(Align::Right);
        let mut room = right - 40.0;
        if !self.origin.is_empty() {
            let width = canvas.text_width(self.origin, mark)?;
            canvas.rectangle(
                (right - width - 32.0, 28.0),
                (right, 74.0),
                palette::lighter(palette::GROUPS[4], 0.6),
            )?;
            canvas.text((right - 16.0, 60.0), self.origin, mark)?;
            room -= width + 60.0;
        }
        let title = Type::new(40.0, palette::INK).bold();
        let room = room - canvas.text_width(self.kind, title)?;
        let text = panel::fitted(canvas, self.title, title, room)?;
        canvas.text((40.0, 66.0), &format!("{text}{}", self.kind), title)?;
        let subtitle = Type::new(27.0, palette::GREY);
        let text = panel::fitted(canvas, self.subtitle, subtitle, right - 40.0)?;
        canvas.text((40.0, 112.0), &text, subtitle)
    }
}

#[cfg(test)]
mod tests;
