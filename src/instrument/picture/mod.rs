//! Photos and silhouettes of a drape test seen from above: the outline of the sheet, and the disc where it is seen.
//!
//! Nothing here knows centimetres: outlines are in pixels, from the upper left corner of the picture, y downwards.
//!
//! 1. The background is a colour that changes slowly over the picture (`background`); what differs from it is split
//!    off by Otsu's level, and the largest part is the sheet (`blob`).
//! 2. The outline lies where the colour is halfway between those inside and outside nearby (`edge`): uneven light
//!    and blur do not move it, and it is found between pixels.
//! 3. The disc is a circle within, along which the brightness steps the same way all around (`disc`).

mod background;
mod blob;
mod disc;
mod edge;
mod raster;

use std::f64::consts::PI;
use std::path::Path;

use imageproc::filter::gaussian_blur_f32;

pub use disc::Circle;
pub(crate) use raster::decoded;

use super::error::{ReadError, ReadProblem};
use crate::finding::Place;
use crate::platform::files;
use crate::quantity::{polygon_area, polygon_centre};
use raster::{Colours, Raster};

/// The outline of a sheet in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Silhouette {
    /// Width and height of the picture (pixels).
    pub size: [u32; 2],
    /// The outline, closed, without its first point again (pixels).
    pub outline: Vec<[f64; 2]>,
    /// The support disc, where it is seen within.
    pub disc: Option<Circle>,
    /// Distance of the colours on both sides of the outline, 0 to 1 in each channel.
    pub contrast: f64,
    /// Standard deviation of the noise of a channel.
    pub noise: f64,
    /// Areas of other things in the picture, relative to that of the sheet.
    pub others: Vec<f64>,
    /// Part of the outline that lies along the border of the picture.
    pub at_border: f64,
}

/// Smallest picture that is measured (pixels).
const SMALLEST: u32 = 40;

/// Reads a picture and finds the sheet in it; the bytes of the file go with it.
///
/// # Errors
/// R001 if the file cannot be read, and those of [`silhouette`].
pub fn read_silhouette(path: &Path) -> Result<(Silhouette, Vec<u8>), ReadError> {
    let at = |problem| ReadError::new(Place::file(path), problem);
    let bytes = files::read(path).map_err(|e| at(ReadProblem::Unreadable { reason: e.to_string() }))?;
    Ok((silhouette(&bytes).map_err(at)?, bytes))
}

/// Finds the sheet in a picture (PNG or JPEG).
///
/// # Errors
/// R024 if it cannot be decoded, R025 if there is no sheet.
pub fn silhouette(bytes: &[u8]) -> Result<Silhouette, ReadProblem> {
    let raster = Raster::decode(bytes).map_err(|reason| ReadProblem::BadPicture { reason })?;
    if raster.size.iter().any(|n| *n < SMALLEST) {
        let reason = format!("{} x {} pixels are too few", raster.size[0], raster.size[1]);
        return Err(ReadProblem::NoSheet { reason });
    }
    let noise = noise(&raster.colours);
    let found = found(&raster.colours, noise);
    let nothing = || ReadProblem::NoSheet { reason: "nothing stands out from the background".into() };
    let Found { colours, edge, others, remaining_noise } = found.ok_or_else(nothing)?;
    let radius = (polygon_area(&edge.outline).abs() / PI).sqrt();
    let disc = disc::disc(&colours, &edge.depth, (polygon_centre(&edge.outline), radius), remaining_noise);
    let mut outline: Vec<[f64; 2]> = edge.outline.iter().map(|p| raster.place(*p)).collect();
    outline.dedup();
    if outline.len() > 1 && outline.first() == outline.last() {
        outline.pop();
    }
    Ok(Silhouette {
        at_border: at_border(&edge.outline, &raster.colours),
        disc: disc.map(|d| Circle {
            centre: raster.place(d.centre),
            radius: d.radius * raster.factor(),
            ..d
        }),
        size: raster.size,
        outline,
        contrast: edge.contrast,
        noise,
        others,
    })
}

/// The sheet of a picture, and the smoothed colours in which its edge was found.
struct Found {
    colours: Colours,
    edge: edge::Edge,
    others: Vec<f64>,
    /// Noise that is left in the colours.
    remaining_noise: f64,
}

fn found(colours: &Colours, noise: f64) -> Option<Found> {
    let smooth = gaussian_blur_f32(colours, 1.0);
    let blob = blob::largest(&smooth)?;
    let rough = edge::refined(&smooth, blob.mask, 1)?;
    // Where noise is strong against the contrast, more is needed to see the edge.
    let sigma = (0.4 + 8.0 * noise / rough.contrast.max(1e-3)).clamp(0.6, 3.0) as f32;
    let colours = gaussian_blur_f32(colours, sigma);
    let edge = edge::refined(&colours, rough.mask, 2)?;
    let remaining_noise = noise / f64::from(sigma).max(1.0);
    Some(Found { colours, edge, others: blob.others, remaining_noise })
}

/// Standard deviation of what changes from pixel to pixel, from the median of second differences across both ways,
/// which edges and slopes hardly move; that of the noisiest channel.
fn noise(colours: &Colours) -> f64 {
    let (width, height) = colours.dimensions();
    let mut most = 0.0f64;
    for channel in 0..4 {
        let at = |x: u32, y: u32| f64::from(colours.get_pixel(x, y).0[channel]);
        let mut all = Vec::new();
        for y in (1..height - 1).step_by(2) {
            for x in (1..width - 1).step_by(2) {
                let corners = at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1);
                let sides = at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1);
                all.push((corners - 2.0 * sides + 4.0 * at(x, y)).abs() / 6.0);
            }
        }
        let middle = all.len() / 2;
        let (_, median, _) = all.select_nth_unstable_by(middle, f64::total_cmp);
        most = most.max(*median / 0.6745);
    }
    most
}

/// Part of a line that lies within a pixel of the border of the picture.
fn at_border(line: &[[f64; 2]], colours: &Colours) -> f64 {
    let (width, height) = (f64::from(colours.width()), f64::from(colours.height()));
    let (mut along, mut all) = (0.0, 0.0);
    for (a, b) in line.iter().zip(line.iter().cycle().skip(1)) {
        let length = (a[0] - b[0]).hypot(a[1] - b[1]);
        let near = a[0] < 1.0 || a[1] < 1.0 || a[0] > width - 1.0 || a[1] > height - 1.0;
        (along, all) = (along + if near { length } else { 0.0 }, all + length);
    }
    along / all
}
