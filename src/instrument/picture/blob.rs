//! The sheet among all that stands out from the background, to a pixel.

use image::{GrayImage, Luma};
use imageproc::contrast::otsu_level;
use imageproc::distance_transform::Norm;
use imageproc::morphology::open;
use imageproc::region_labelling::{Connectivity, connected_components};

use super::background::Background;
use super::raster::{Colours, Field};

/// Bridges, hairs and letters thinner than this part of the shorter side are none of the sheet.
const THIN: f64 = 0.008;
/// A part that is smaller than this part of the sheet is dust.
const DUST: f64 = 0.005;
/// What lies along more of the picture's border than this is its frame.
const FRAME: f64 = 0.5;
/// What fills more than this part of the circle or rectangle around it is one; a sheet with folds fills less of a
/// circle, and more of its table than the last.
const ROUND: f64 = 0.96;
const FOLDED: f64 = 0.94;
const HOLE: f64 = 0.1;
/// The least part of the picture that can be a sheet.
const LEAST: f64 = 0.002;

/// The sheet and what else was seen.
pub(super) struct Blob {
    /// 255 in the sheet, its holes filled; 0 elsewhere.
    pub mask: GrayImage,
    /// Areas of the parts outside of it, relative to its own.
    pub others: Vec<f64>,
}

/// Splits the picture into what is like its background and what is not, and takes the largest part.
pub(super) fn largest(colours: &Colours) -> Option<Blob> {
    let mut split = apart(&Background::of_border(colours).distance(colours));
    for _ in 0..2 {
        let background = Background::outside(colours, &split);
        split = apart(&background.distance(colours));
    }
    let (width, height) = colours.dimensions();
    let thin = (0.5 * THIN * f64::from(width.min(height))).round().clamp(1.0, 20.0) as u8;
    let parts = Parts::of(&open(&split, Norm::L2, thin));
    let sheet = parts.sheet(width, height)?;
    let mask = filled(&parts.mask(sheet));
    if let Some(dark) = on_a_table(&parts.mask(sheet), &mask) {
        return Some(Blob { mask: dark, others: Vec::new() });
    }
    let outside = |part: &&Part| part.number != sheet && mask.get_pixel(part.first.0, part.first.1).0[0] == 0;
    let area = mask.pixels().filter(|p| p.0[0] > 0).count() as f64;
    let others = parts.all.iter().filter(outside).map(|part| part.area as f64 / area);
    Some(Blob { others: others.filter(|a| *a > DUST).collect(), mask })
}

/// The sheet on a lit table, round or rectangular, in dark surroundings: what looks like a part with one large hole is
/// the table, and the hole is the sheet, which is as dark as what is around. The hole of a disc is round.
fn on_a_table(part: &GrayImage, filled_part: &GrayImage) -> Option<GrayImage> {
    let hole = GrayImage::from_fn(part.width(), part.height(), |x, y| {
        let is_hole = filled_part.get_pixel(x, y).0[0] > 0 && part.get_pixel(x, y).0[0] == 0;
        Luma([if is_hole { 255 } else { 0 }])
    });
    let holes = Parts::of(&hole);
    let largest = holes.all.iter().max_by_key(|p| p.area)?;
    let sheet = filled(&holes.mask(largest.number));
    let (table, inside) = (Shape::of(filled_part), Shape::of(&sheet));
    let is_table = table.round > ROUND || table.rectangular > ROUND;
    let is_sheet = inside.area > HOLE * table.area && inside.round < FOLDED;
    (is_table && is_sheet).then_some(sheet)
}

/// How near a mask is to a circle and to an upright rectangle: parts of those around it that it fills.
struct Shape {
    area: f64,
    round: f64,
    rectangular: f64,
}

impl Shape {
    fn of(mask: &GrayImage) -> Self {
        let inside =
            || mask.enumerate_pixels().filter(|p| p.2.0[0] > 0).map(|(x, y, _)| (f64::from(x), f64::from(y)));
        let area = inside().count() as f64;
        let (x, y) = inside().fold((0.0, 0.0), |s, p| (s.0 + p.0 / area, s.1 + p.1 / area));
        let reach = inside().map(|p| (p.0 - x).hypot(p.1 - y)).fold(0.0, f64::max) + 0.5;
        let ends = |of: fn((f64, f64)) -> f64| {
            let (low, high) =
                inside().map(of).fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
            high - low + 1.0
        };
        let rectangle = ends(|p| p.0) * ends(|p| p.1);
        Self { area, round: area / (std::f64::consts::PI * reach * reach), rectangular: area / rectangle }
    }
}

/// 255 where the distance is above the level that parts two classes best.
fn apart(distance: &Field) -> GrayImage {
    let mut sorted: Vec<f32> = distance.pixels().map(|p| p.0[0]).collect();
    let last = (sorted.len() - 1) * 995 / 1000;
    let (_, &mut most, _) = sorted.select_nth_unstable_by(last, f32::total_cmp);
    let scale = 255.0 / most.max(1e-6);
    let grey = GrayImage::from_fn(distance.width(), distance.height(), |x, y| {
        Luma([(distance.get_pixel(x, y).0[0] * scale).min(255.0) as u8])
    });
    let level = otsu_level(&grey);
    GrayImage::from_fn(grey.width(), grey.height(), |x, y| {
        Luma([if grey.get_pixel(x, y).0[0] > level { 255 } else { 0 }])
    })
}

/// One connected part.
struct Part {
    number: u32,
    area: usize,
    at_border: usize,
    first: (u32, u32),
}

/// All connected parts.
struct Parts {
    labels: image::ImageBuffer<Luma<u32>, Vec<u32>>,
    all: Vec<Part>,
}

impl Parts {
    fn of(mask: &GrayImage) -> Self {
        let labels = connected_components(mask, Connectivity::Eight, Luma([0]));
        let (width, height) = mask.dimensions();
        let mut all: Vec<Part> = Vec::new();
        for (x, y, label) in labels.enumerate_pixels().filter(|(.., l)| l.0[0] > 0) {
            let number = label.0[0] as usize;
            while all.len() < number {
                all.push(Part { number: all.len() as u32 + 1, area: 0, at_border: 0, first: (x, y) });
            }
            let part = &mut all[number - 1];
            part.area += 1;
            part.at_border += usize::from(x == 0 || y == 0 || x + 1 == width || y + 1 == height);
        }
        Self { labels, all }
    }

    /// The number of the largest part that is no frame.
    fn sheet(&self, width: u32, height: u32) -> Option<u32> {
        let border = 2.0 * f64::from(width + height);
        let least = LEAST * f64::from(width) * f64::from(height);
        let inside = self.all.iter().filter(|p| (p.at_border as f64) < FRAME * border);
        inside.max_by_key(|p| p.area).filter(|p| p.area as f64 > least).map(|p| p.number)
    }

    fn mask(&self, number: u32) -> GrayImage {
        GrayImage::from_fn(self.labels.width(), self.labels.height(), |x, y| {
            Luma([if self.labels.get_pixel(x, y).0[0] == number { 255 } else { 0 }])
        })
    }
}

/// A mask without its holes.
pub(super) fn filled(mask: &GrayImage) -> GrayImage {
    let mut outside = mask.clone();
    outside.pixels_mut().for_each(|p| p.0[0] = 255 - p.0[0]);
    let labels = connected_components(&outside, Connectivity::Four, Luma([0]));
    let (width, height) = mask.dimensions();
    let mut open = std::collections::BTreeSet::new();
    for (x, y, label) in labels.enumerate_pixels() {
        if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            open.insert(label.0[0]);
        }
    }
    open.remove(&0);
    GrayImage::from_fn(width, height, |x, y| {
        Luma([if open.contains(&labels.get_pixel(x, y).0[0]) { 0 } else { 255 }])
    })
}
