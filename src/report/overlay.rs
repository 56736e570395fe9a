//! A picture with what was found in it drawn over it, for a person to check.

use image::imageops::grayscale;
use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use imageproc::drawing::{draw_filled_circle_mut, draw_hollow_circle_mut, draw_line_segment_mut};

use super::chart::ChartError;

/// Longest side of the overlay (pixels).
const LONGEST: u32 = 1400;
const OUTLINE: Rgb<u8> = Rgb([0xd5, 0x5e, 0x00]);
const DISC: Rgb<u8> = Rgb([0x00, 0x72, 0xb2]);
const FOLD: Rgb<u8> = Rgb([0x00, 0x9e, 0x73]);

/// What is drawn, in pixels of the picture.
#[derive(Clone, Debug, Default)]
pub struct Overlay {
    /// The outline of the sheet, closed.
    pub outline: Vec<[f64; 2]>,
    /// Centre and radius of the disc.
    pub disc: Option<([f64; 2], f64)>,
    /// The centre of the outline.
    pub centre: [f64; 2],
    /// Tips of the folds.
    pub folds: Vec<[f64; 2]>,
}

/// The picture (PNG or JPEG) in pale grey with outline, disc, centre and folds, as PNG.
///
/// # Errors
/// [`ChartError::Drawing`] if the picture cannot be decoded or the overlay not be encoded.
pub fn overlay(bytes: &[u8], overlay: &Overlay) -> Result<Vec<u8>, ChartError> {
    let drawing = |e: image::ImageError| ChartError::Drawing { problem: e.to_string() };
    let mut picture = decoded(bytes).map_err(drawing)?;
    let width = picture.width();
    if picture.width().max(picture.height()) > LONGEST {
        picture = picture.thumbnail(LONGEST, LONGEST);
    }
    let scale = f64::from(picture.width()) / f64::from(width);
    let grey = grayscale(&picture);
    let mut page = RgbImage::from_fn(grey.width(), grey.height(), |x, y| {
        let pale = 110 + (u16::from(grey.get_pixel(x, y).0[0]) * 145 / 255) as u8;
        Rgb([pale; 3])
    });
    let at = |p: [f64; 2]| [(scale * p[0]) as f32, (scale * p[1]) as f32];
    let whole = |p: [f64; 2]| at(p).map(|v| v.round() as i32);
    for (a, b) in overlay.outline.iter().zip(overlay.outline.iter().cycle().skip(1)) {
        // Two pixels wide.
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)] {
            let [a, b] = [at(*a), at(*b)].map(|[x, y]| (x - 0.5 + dx, y - 0.5 + dy));
            draw_line_segment_mut(&mut page, a, b, OUTLINE);
        }
    }
    if let Some((centre, radius)) = overlay.disc {
        for more in 0..2 {
            let [x, y] = whole(centre);
            draw_hollow_circle_mut(&mut page, (x, y), (scale * radius).round() as i32 + more, DISC);
        }
    }
    for (place, color) in overlay.folds.iter().map(|p| (*p, FOLD)).chain([(overlay.centre, DISC)]) {
        let [x, y] = whole(place);
        draw_filled_circle_mut(&mut page, (x, y), 5, color);
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    DynamicImage::from(page).write_to(&mut bytes, ImageFormat::Png).map_err(drawing)?;
    Ok(bytes.into_inner())
}

fn decoded(bytes: &[u8]) -> Result<DynamicImage, image::ImageError> {
    crate::instrument::picture::decoded(bytes)
}
