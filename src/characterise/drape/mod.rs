//! What a drape test shows, from the outline of the sheet seen from above: pure geometry, no files.
//!
//! The coefficient is (shadow - disc) / (sheet - disc) with the areas of the method's disc and sheet. Folds are the
//! maxima of the distance from the centre that stand out by a tenth of the largest difference along the outline, as
//! in the simulated test; the strongest harmonic is given beside them, and who counts otherwise is told.

mod folds;
mod outline;
mod summary;

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

pub use crate::kes::DrapeMethod;
pub use summary::{DrapeSummary, Spread, drape_results, summaries};

use crate::finding::DrapeFact;
use crate::quantity::{polygon_area, polygon_centre};

/// Orders of the harmonics that are given.
const ORDERS: usize = 20;
/// How far the scale that is given may be from the one of the disc that is seen.
const SCALES: f64 = 0.02;
/// Along more of the picture's border than this the sheet is cut off.
const CUT: f64 = 0.005;
/// Below this difference of brightness, or this multiple of the noise, an outline is faint.
const FAINT: [f64; 2] = [0.06, 4.0];

/// What was seen of a sheet in a picture (pixels, y downwards).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeenSheet {
    /// The outline, closed.
    pub outline: Vec<[f64; 2]>,
    /// Centre and radius of the support disc, where it is seen.
    pub disc: Option<([f64; 2], f64)>,
    /// Difference of brightness at the outline, and the standard deviation of the noise (0 to 1).
    pub contrast: [f64; 2],
    /// Areas of other things in the picture, relative to that of the sheet.
    pub others: Vec<f64>,
    /// Part of the outline that lies along the border of the picture.
    pub at_border: f64,
}

/// Where the scale of a picture comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ScaleSource {
    /// It was given.
    Given,
    /// From the disc that is seen.
    Disc,
    /// From the disc in other pictures of the same size.
    OtherPictures,
}

impl ScaleSource {
    /// What people call it.
    pub fn text(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Disc => "disc",
            Self::OtherPictures => "other pictures",
        }
    }
}

/// A scale with its source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Scale {
    /// Pixels in a metre.
    pub pixels_per_metre: f64,
    /// Where it comes from.
    pub source: ScaleSource,
}

/// Side of the cloth that is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ClothSide {
    /// Face up.
    Face,
    /// Back up.
    Back,
}

impl ClothSide {
    /// The side that the words of a file name state: `poplin-face-2`, `裏`. Letters and places such as `a` or `top` are
    /// names of specimens and views as well, and state none.
    pub fn in_name(name: &str) -> Option<Self> {
        let name = name.to_lowercase();
        let words: Vec<&str> = name.split(|c: char| !c.is_alphabetic()).collect();
        let has = |list: &[&str]| words.iter().any(|word| list.contains(word));
        let (face, back) = (has(&["face", "front", "表"]), has(&["back", "rear", "reverse", "裏"]));
        match (face, back) {
            (true, false) => Some(Self::Face),
            (false, true) => Some(Self::Back),
            _ => None,
        }
    }

    /// `face` or `back`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Back => "back",
        }
    }
}

/// One harmonic of the distance from the centre: `amplitude · cos(order · (direction - phase))`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Harmonic {
    /// Waves around.
    pub order: usize,
    /// In the unit of the capture.
    pub amplitude: f64,
    /// Direction of its first crest (degrees from the right, counter-clockwise in the picture).
    pub phase_deg: f64,
}

/// What one picture shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DrapeCapture {
    /// The picture, as it was named.
    pub picture: String,
    /// The test that it belongs to: the name of its folder.
    pub test: String,
    /// Side of the cloth that is up, where the name of the picture says so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<ClothSide>,
    /// Codes of the findings for which no mean counts this picture: the sheet is cut off (K054), the coefficient cannot be (K056), or
    /// it is a copy of another picture of the test (K070).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out_for: Vec<String>,
    /// Drape coefficient, 0 to 1; not there without a scale.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coefficient: Option<f64>,
    /// Folds: places that stand out from their neighbours.
    pub folds: usize,
    /// Folds that stand out twice as clearly as needed, and all that stand out half as clearly.
    pub folds_band: [usize; 2],
    /// Directions of the folds (degrees from the right, counter-clockwise in the picture).
    pub folds_at_deg: Vec<usize>,
    /// The strongest harmonic from order 2 on.
    pub harmonic: usize,
    /// Half the mean difference between folds and the valleys beside them.
    pub amplitude: f64,
    /// Unit of all lengths: `m`, or `px` without a scale. Areas are in its square.
    pub unit: Cow<'static, str>,
    /// Area of the shadow, the disc and holes included.
    pub area: f64,
    /// The scale, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<Scale>,
    /// Centre of the outline (pixels): that of the disc where it is seen, else of the shadow.
    pub centre_px: [f64; 2],
    /// Radius of the disc that is seen (pixels).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub disc_px: Option<f64>,
    /// Harmonics of the distance from the centre; order 0 is the mean, 1 a shift.
    pub harmonics: Vec<Harmonic>,
    /// Distance of the outline from the centre, one a degree from the right, counter-clockwise in the picture: the
    /// farthest point where it turns back on itself.
    pub outline: Vec<f64>,
}

/// `kesf.drape-image/1`: what pictures of drape tests show.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(extend("additionalProperties" = true)))]
pub struct DrapeDocument {
    /// `kesf.drape-image/1`.
    pub schema: Cow<'static, str>,
    /// Disc and sheet of all tests.
    pub method: DrapeMethod,
    /// One entry per picture.
    pub captures: Vec<DrapeCapture>,
    /// Means by test, and by the side that is up.
    pub summaries: Vec<DrapeSummary>,
}

/// What is known of how a picture was taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DrapeSetup {
    /// Sizes of disc and sheet.
    pub method: DrapeMethod,
    /// Pixels in a metre, where that is known.
    pub pixels_per_metre: Option<f64>,
}

impl DrapeSetup {
    /// The scale by the disc that is seen.
    pub fn by_disc(&self, seen: &SeenSheet) -> Option<f64> {
        seen.disc.map(|(_, radius)| 2.0 * radius / self.method.disc)
    }

    /// The scale of a picture, with the one of other pictures of its size if it has none itself.
    fn scale(&self, seen: &SeenSheet, others: Option<f64>) -> Option<Scale> {
        let scale_from = |source| move |pixels_per_metre| Scale { pixels_per_metre, source };
        let given = self.pixels_per_metre.map(scale_from(ScaleSource::Given));
        given
            .or(self.by_disc(seen).map(scale_from(ScaleSource::Disc)))
            .or(others.map(scale_from(ScaleSource::OtherPictures)))
    }
}

/// Measures a sheet that was seen: the capture without its names, and what a reader must know.
pub fn measure(seen: &SeenSheet, setup: &DrapeSetup, others: Option<f64>) -> (DrapeCapture, Vec<DrapeFact>) {
    let scale = setup.scale(seen, others);
    let (unit, metre) = scale.map_or(("px", 1.0), |s| ("m", s.pixels_per_metre));
    // Upwards in the picture is upwards here.
    let upright = |[x, y]: [f64; 2]| [x / metre, -y / metre];
    let line: Vec<[f64; 2]> = seen.outline.iter().map(|p| upright(*p)).collect();
    let middle = polygon_centre(&line);
    let axis = seen.disc.map_or(middle, |(centre, _)| upright(centre));
    let counted = folds::count(&outline::distances(&line, middle));
    let distance = outline::distances(&line, axis);
    let parts = outline::harmonics(&distance, ORDERS);
    let harmonics: Vec<Harmonic> = parts.iter().enumerate().map(|(k, part)| harmonic(k, *part)).collect();
    let strongest = harmonics.iter().skip(2).max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let area = polygon_area(&line).abs();
    let coefficient = scale.map(|_| setup.method.coefficient(area));
    let capture = DrapeCapture {
        picture: String::new(),
        test: String::new(),
        side: None,
        left_out_for: Vec::new(),
        coefficient,
        folds: counted.count,
        folds_band: counted.band,
        folds_at_deg: counted.at,
        harmonic: strongest.map_or(0, |h| h.order),
        amplitude: counted.amplitude,
        unit: unit.into(),
        area,
        scale,
        centre_px: [axis[0] * metre, -axis[1] * metre],
        disc_px: seen.disc.map(|d| d.1),
        harmonics,
        outline: distance,
    };
    let facts = facts(seen, setup, &capture);
    let is_fatal =
        |fact: &&DrapeFact| matches!(fact, DrapeFact::CutOff { .. } | DrapeFact::OutOfRange { .. });
    let left_out_for = facts.iter().filter(is_fatal).map(|fact| fact.code().to_string()).collect();
    (DrapeCapture { left_out_for, ..capture }, facts)
}

impl DrapeCapture {
    /// Looks for the picture of which this one is a copy, among those before it; as a copy within its test it counts in no mean.
    pub fn mark_copy(&mut self, before: &[Self]) -> Option<DrapeFact> {
        let originals =
            before.iter().filter(|other| other.outline == self.outline && other.centre_px == self.centre_px);
        // One of the same test, where there is one.
        let original = originals.min_by_key(|other| other.test != self.test)?;
        let same_test = original.test == self.test;
        let fact = DrapeFact::CopiedPicture { original: original.picture.clone(), same_test };
        if same_test {
            self.left_out_for.push(fact.code().to_string());
        }
        Some(fact)
    }
}

fn harmonic(order: usize, [cos, sin]: [f64; 2]) -> Harmonic {
    if order == 0 {
        return Harmonic { order, amplitude: cos, phase_deg: 0.0 };
    }
    let phase = sin.atan2(cos).to_degrees().rem_euclid(360.0) / order as f64;
    Harmonic { order, amplitude: cos.hypot(sin), phase_deg: phase }
}

fn facts(seen: &SeenSheet, setup: &DrapeSetup, capture: &DrapeCapture) -> Vec<DrapeFact> {
    let mut facts = Vec::new();
    match capture.scale.map(|s| s.source) {
        None => facts.push(DrapeFact::NoScale {}),
        Some(ScaleSource::OtherPictures) => facts.push(DrapeFact::ScaleOfOthers {}),
        Some(ScaleSource::Given | ScaleSource::Disc) => {}
    }
    if let Some((given, disc)) = setup.pixels_per_metre.zip(setup.by_disc(seen))
        && (disc / given - 1.0).abs() > SCALES
    {
        facts.push(DrapeFact::TwoScales { given: 0.01 * given, disc: 0.01 * disc });
    }
    if !seen.others.is_empty() {
        let largest = seen.others.iter().copied().fold(0.0, f64::max);
        facts.push(DrapeFact::OtherThings { count: seen.others.len(), largest });
    }
    if seen.at_border > CUT {
        facts.push(DrapeFact::CutOff { part: seen.at_border });
    }
    let [contrast, noise] = seen.contrast;
    if contrast < FAINT[0].max(FAINT[1] * noise) {
        facts.push(DrapeFact::Faint { contrast, noise });
    }
    if let Some(coefficient) = capture.coefficient.filter(|c| !(0.0..=1.0).contains(c)) {
        facts.push(DrapeFact::OutOfRange { coefficient, method: setup.method.text() });
    }
    let [clear, all] = capture.folds_band;
    if clear != all || (capture.harmonic != capture.folds && capture.folds > 0) {
        let (folds, harmonic) = (capture.folds, capture.harmonic);
        facts.push(DrapeFact::DoubtfulFolds { folds, clear, all, harmonic });
    }
    facts
}

#[cfg(test)]
mod tests;
