//! A chart, and the files that can be made of it.

use super::bitmap::Bitmap;
use super::canvas::Canvas;
use super::error::ChartError;
#[cfg(feature = "pdf")]
use super::pdf;
use super::svg;

/// What kind of file a chart becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Pixels, 300 dpi.
    Png,
    /// Lines and text for browsers and drawing programs. The letters are those of the reader's machine.
    Svg,
    /// Lines and text with their font, for print.
    #[cfg(feature = "pdf")]
    Pdf,
}

impl Format {
    /// Those that there are.
    pub const ALL: &[Self] = &[
        Self::Png,
        Self::Svg,
        #[cfg(feature = "pdf")]
        Self::Pdf,
    ];

    /// The one whose files end like this, if there is one.
    pub fn from_ending(ending: &str) -> Option<Self> {
        Self::ALL.iter().find(|format| format.ending() == ending).copied()
    }

    /// `png`, `svg` or `pdf`: how the name of a file ends.
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            #[cfg(feature = "pdf")]
            Self::Pdf => "pdf",
        }
    }
}

/// A chart of 6 in x 4.5 in. Its files carry title and description, and no date.
#[derive(Clone)]
pub struct Chart(pub(super) Canvas);

impl Canvas {
    /// The chart, once all of it is drawn.
    pub(super) fn chart(self) -> Chart {
        Chart(self)
    }
}

impl Chart {
    /// What it is called.
    pub fn title(&self) -> &str {
        &self.0.title
    }

    /// What is said of it to those who do not see it, beside its title.
    pub fn description(&self) -> &str {
        &self.0.description
    }

    /// The chart as a file.
    ///
    /// # Errors
    /// [`ChartError::Drawing`] if an encoder fails.
    pub fn file(&self, format: Format) -> Result<Vec<u8>, ChartError> {
        match format {
            Format::Png => self.png(),
            Format::Svg => self.svg(),
            #[cfg(feature = "pdf")]
            Format::Pdf => self.pdf(),
        }
    }

    /// 1800 x 1350 pixels of 300 dpi.
    ///
    /// # Errors
    /// [`ChartError::Drawing`] if the encoder fails.
    pub fn png(&self) -> Result<Vec<u8>, ChartError> {
        Bitmap::of(&self.0.marks)?.png(&self.0.title)
    }

    /// Lines as lines and text as text; surfaces that are coloured by values are pictures of 300 dpi within it.
    ///
    /// # Errors
    /// [`ChartError::Drawing`] if an encoder fails.
    pub fn svg(&self) -> Result<Vec<u8>, ChartError> {
        svg::file(&self.0)
    }

    /// As [`svg`](Self::svg), with the glyphs of its text. Characters that DejaVu Sans lacks are drawn, and are no text.
    ///
    /// # Errors
    /// [`ChartError::Drawing`] if the encoder fails.
    #[cfg(feature = "pdf")]
    pub fn pdf(&self) -> Result<Vec<u8>, ChartError> {
        pdf::file(&self.0)
    }
}
