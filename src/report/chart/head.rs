//! What every chart carries above its plot.

use super::canvas::{Align, Canvas, Type, WIDTH};
use super::error::ChartError;
use super::palette;
use super::panel::fitted;

/// Title, subtitle and the mark of origin that every chart carries above the plot.
pub(super) struct Head<'a> {
    pub title: &'a str,
    /// Follows the title, and stays where a long title is cut short.
    pub kind: &'a str,
    pub subtitle: &'a str,
    /// `measured data`, `synthetic data` ...; empty for none.
    pub origin: &'a str,
}

impl Head<'_> {
    /// Draws it at the top of the canvas, and says it to those who do not see the chart.
    pub fn draw(&self, canvas: &mut Canvas) -> Result<(), ChartError> {
        canvas.title = format!("{}{}", self.title, self.kind);
        let said = [self.subtitle, self.origin].into_iter().filter(|text| !text.is_empty());
        canvas.description = said.collect::<Vec<_>>().join("; ");
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
        let text = fitted(canvas, self.title, title, room)?;
        canvas.text((40.0, 66.0), &format!("{text}{}", self.kind), title)?;
        let subtitle = Type::new(27.0, palette::GREY);
        let text = fitted(canvas, self.subtitle, subtitle, right - 40.0)?;
        canvas.text((40.0, 112.0), &text, subtitle)
    }
}
