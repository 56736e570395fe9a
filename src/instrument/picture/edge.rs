//! The outline between pixels: where a colour is halfway between those on both sides of the edge nearby.

use contour::ContourBuilder;
use image::imageops::fast_blur;
use image::{GrayImage, Luma, Rgba};
use imageproc::distance_transform::euclidean_squared_distance_transform;

use super::background::colour;
use super::blob::filled;
use super::raster::{Colours, Field};
use crate::quantity::polygon_area;

/// Half the width of the band in which the edge is looked for, and the reach of the levels on both sides: part of
/// the diameter of a circle of the same area.
const BAND: f64 = 0.03;
/// How far the levels on both sides reach, as part of the band.
const REACH: f64 = 0.25;
/// Pixels beside the edge that are part of its blur.
const BLUR: f64 = 2.0;
/// Weight of what is far away, which counts only where nothing is near.
const FAR: f32 = 1e-3;

/// The outline and how clear it is.
pub(super) struct Edge {
    /// A closed line, in pixels; the upper left corner of the picture is the origin.
    pub outline: Vec<[f64; 2]>,
    /// Distance of the colours on both sides, 0 to 1 in each channel; the median along the edge.
    pub contrast: f64,
    /// The sheet to a pixel.
    pub mask: GrayImage,
    /// Distance from its edge (pixels), positive inside.
    pub depth: Field,
}

/// Finds the outline of a mask's sheet in the colours, by so many rounds of levels and edge.
pub(super) fn refined(colours: &Colours, mask: GrayImage, rounds: usize) -> Option<Edge> {
    let mut mask = mask;
    let mut edge = None;
    for _ in 0..rounds {
        let near = Nearby::of(colours, &mask);
        let part = near.part(colours);
        let found = outline(&part)?;
        let sheet = GrayImage::from_fn(part.width(), part.height(), |x, y| {
            Luma([if part.get_pixel(x, y).0[0] > 0.5 { 255 } else { 0 }])
        });
        mask = filled(&sheet);
        edge =
            Some(Edge { outline: found, contrast: near.contrast(), mask: mask.clone(), depth: near.depth });
    }
    edge
}

/// What is near the edge of a mask.
struct Nearby {
    inside: Colours,
    outside: Colours,
    /// Distance from the edge in pixels, positive inside.
    depth: Field,
    band: f64,
}

impl Nearby {
    fn of(colours: &Colours, mask: &GrayImage) -> Self {
        let area = mask.pixels().filter(|p| p.0[0] > 0).count() as f64;
        let band = (BAND * 2.0 * (area / std::f64::consts::PI).sqrt()).max(4.0);
        let depth = depth(mask);
        let side = |sign: f64| {
            level(
                colours,
                |x, y| f64::from(depth.get_pixel(x, y).0[0]) * sign > BLUR,
                (REACH * band).max(2.5),
            )
        };
        Self { inside: side(1.0), outside: side(-1.0), depth, band }
    }

    /// How much of a pixel is sheet: 0 at the level outside, 1 at the level inside.
    fn part(&self, colours: &Colours) -> Field {
        Field::from_fn(colours.width(), colours.height(), |x, y| {
            let depth = f64::from(self.depth.get_pixel(x, y).0[0]);
            if depth.abs() > self.band {
                return Luma([if depth > 0.0 { 1.0 } else { 0.0 }]);
            }
            let [inside, outside, here] =
                [&self.inside, &self.outside, colours].map(|c| colour(c.get_pixel(x, y)));
            let across = inside - outside;
            Luma([((here - outside).dot(&across) / across.norm_squared().max(1e-9)).clamp(0.0, 1.0) as f32])
        })
    }

    fn contrast(&self) -> f64 {
        let mut all: Vec<f64> = self
            .depth
            .enumerate_pixels()
            .filter(|(.., d)| f64::from(d.0[0].abs()) < BLUR)
            .map(|(x, y, _)| {
                (colour(self.inside.get_pixel(x, y)) - colour(self.outside.get_pixel(x, y))).amax()
            })
            .collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(0.0)
    }
}

/// Distance from the edge of a mask (pixels), positive inside.
fn depth(mask: &GrayImage) -> Field {
    let mut other = mask.clone();
    other.pixels_mut().for_each(|p| p.0[0] = 255 - p.0[0]);
    let (to_sheet, to_rest) =
        (euclidean_squared_distance_transform(mask), euclidean_squared_distance_transform(&other));
    Field::from_fn(mask.width(), mask.height(), |x, y| {
        let [out, within] = [&to_sheet, &to_rest].map(|d| d.get_pixel(x, y).0[0].min(1e9).sqrt());
        Luma([if within > 0.0 { (within - 0.5) as f32 } else { (0.5 - out) as f32 }])
    })
}

/// The mean colour nearby of the pixels that belong.
fn level(colours: &Colours, belongs: impl Fn(u32, u32) -> bool, reach: f64) -> Colours {
    let weight = |x, y| if belongs(x, y) { 1.0 } else { 0.0 };
    let (width, height) = colours.dimensions();
    let weighted =
        Colours::from_fn(width, height, |x, y| Rgba(colours.get_pixel(x, y).0.map(|c| c * weight(x, y))));
    let weights = Field::from_fn(width, height, |x, y| Luma([weight(x, y)]));
    let reach = reach as f32;
    let [near, far] =
        [reach, 6.0 * reach].map(|sigma| (fast_blur(&weighted, sigma), fast_blur(&weights, sigma)));
    Colours::from_fn(width, height, |x, y| {
        let sum = near.1.get_pixel(x, y).0[0] + FAR * far.1.get_pixel(x, y).0[0];
        let (near, far) = (near.0.get_pixel(x, y).0, far.0.get_pixel(x, y).0);
        Rgba(std::array::from_fn(|i| (near[i] + FAR * far[i]) / sum.max(1e-12)))
    })
}

/// The longest way around: the line of one half that encloses the largest area.
fn outline(part: &Field) -> Option<Vec<[f64; 2]>> {
    let values: Vec<f64> = part.pixels().map(|p| f64::from(p.0[0])).collect();
    let builder = ContourBuilder::new(part.width() as usize, part.height() as usize, true);
    let contours = builder.contours(&values, &[0.5]).ok()?;
    let rings = contours.iter().flat_map(|c| c.geometry()).map(|polygon| polygon.exterior());
    let lines = rings.map(|ring| ring.coords().map(|c| [c.x, c.y]).collect::<Vec<_>>());
    lines.max_by(|a, b| polygon_area(a).abs().total_cmp(&polygon_area(b).abs()))
}
