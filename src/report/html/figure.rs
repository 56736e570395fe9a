//! Pictures of the page.

use serde::{Deserialize, Serialize};

use super::text::{address, escape};
use crate::report::CHART_PIXELS;

/// A picture with its caption.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Below it.
    pub caption: String,
    /// A sentence on what is seen, for readers who do not see it; empty for the caption.
    #[serde(default)]
    pub alt: String,
    /// The file: path relative to the page, with `/`.
    pub picture: String,
    /// What it is of.
    #[serde(default)]
    pub kind: FigureKind,
}

/// What a picture is of, what is worth most in a page that has no room for all of them first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FigureKind {
    /// A drape.
    Drape,
    /// A bending test of a strip under its own weight.
    Cantilever,
    /// All fabrics together, simulated against measured.
    Overview,
    /// The law of friction of a fabric.
    Friction,
    /// A simulated or measured KES test.
    Test,
    /// A plate.
    Plate,
    /// Of no fabric, and everything else.
    #[default]
    Benchmark,
}

impl FigureKind {
    const ALL: [Self; 7] = [
        Self::Drape,
        Self::Cantilever,
        Self::Overview,
        Self::Friction,
        Self::Test,
        Self::Plate,
        Self::Benchmark,
    ];

    /// As it stands in the page.
    fn name(self) -> &'static str {
        match self {
            Self::Drape => "drape",
            Self::Cantilever => "cantilever",
            Self::Overview => "overview",
            Self::Friction => "friction",
            Self::Test => "test",
            Self::Plate => "plate",
            Self::Benchmark => "benchmark",
        }
    }

    /// Of the attributes of an `<img>` of the page. Texts in them have no raw `"`.
    pub(super) fn of_attributes(attributes: &str) -> Self {
        let named = |kind: &Self| attributes.contains(&format!(" data-kind=\"{}\"", kind.name()));
        Self::ALL.into_iter().find(named).unwrap_or_default()
    }
}

pub(super) fn figure(out: &mut String, figure: &Figure) {
    let caption = escape(&figure.caption);
    let address = address(&figure.picture);
    if figure.picture.ends_with(".pdf") {
        // No browser shows it as a picture.
        out.push_str(&format!("<p><a href=\"{address}\">{caption} (PDF)</a></p>\n"));
        return;
    }
    let alt = if figure.alt.is_empty() { caption.clone() } else { escape(&figure.alt) };
    let kind = figure.kind.name();
    // With its size a picture has its room before it is loaded, and what stands below does not jump.
    let (width, height) = CHART_PIXELS;
    let size = format!("width=\"{width}\" height=\"{height}\"");
    let image = format!(
        "<a href=\"{address}\"><img src=\"{address}\" alt=\"{alt}\" data-kind=\"{kind}\" {size} loading=\"lazy\"></a>"
    );
    out.push_str(&format!("<figure>{image}<figcaption>{caption}</figcaption></figure>\n"));
}
