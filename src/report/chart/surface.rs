//! Surfaces coloured by values, as pixels: shading has no lines that would stay sharp at any size.

use plotters::prelude::RGBColor;

use super::canvas::{HEIGHT, Mark, OVERSAMPLING, Point, WIDTH};
use super::error::ChartError;

/// Part of the page in pixels, with transparency (RGBA); what a file that is not of pixels takes for surfaces.
pub(super) struct Raster {
    /// Of the upper left corner.
    pub left: usize,
    /// Of the upper left corner.
    pub top: usize,
    pub width: usize,
    pub height: usize,
    pub rgba: Vec<u8>,
}

/// Calls `draw` for the pixels inside a triangle, three times as fine as those of the page, with the value there,
/// which is linear between its corners.
pub(super) fn pixels<E>(
    corners: [Point; 3],
    values: [f64; 3],
    mut draw: impl FnMut((i32, i32), f64) -> Result<(), E>,
) -> Result<(), E> {
    let s = OVERSAMPLING as f64;
    let [a, b, c] = corners.map(|p| (p.0 * s, p.1 * s));
    let area = (b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1);
    if area.abs() < 1e-9 || !area.is_finite() {
        return Ok(());
    }
    // The pixels of a shared edge belong to both triangles, so that no gap can open.
    let margin = -0.75
        * [a, b, c].iter().zip([b, c, a]).map(|(p, q)| (p.0 - q.0).hypot(p.1 - q.1)).fold(0.0, f64::max)
        / area.abs();
    let low = |f: fn(Point) -> f64| f(a).min(f(b)).min(f(c)).floor() as i32;
    let high = |f: fn(Point) -> f64| f(a).max(f(b)).max(f(c)).ceil() as i32;
    for y in low(|p| p.1)..=high(|p| p.1) {
        for x in low(|p| p.0)..=high(|p| p.0) {
            let p = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let u = ((b.0 - p.0) * (c.1 - p.1) - (c.0 - p.0) * (b.1 - p.1)) / area;
            let v = ((c.0 - p.0) * (a.1 - p.1) - (a.0 - p.0) * (c.1 - p.1)) / area;
            let w = 1.0 - u - v;
            if u.min(v).min(w) >= margin {
                draw((x, y), u * values[0] + v * values[1] + w * values[2])?;
            }
        }
    }
    Ok(())
}

/// The surfaces among the marks, drawn one over the other; `None` if nothing of them is on the page.
pub(super) fn raster(marks: &[Mark]) -> Result<Option<Raster>, ChartError> {
    let corners = marks.iter().flat_map(|mark| match mark {
        Mark::Shade { corners, .. } => corners.as_slice(),
        _ => &[],
    });
    let Some([left, top, right, bottom]) = bounds(corners) else { return Ok(None) };
    let (width, height) = (right - left, bottom - top);
    let row = width * OVERSAMPLING;
    let mut fine: Vec<Option<RGBColor>> = vec![None; row * height * OVERSAMPLING];
    for mark in marks {
        let Mark::Shade { corners, values, tones } = mark else { continue };
        pixels(*corners, *values, |(x, y), value| {
            let place = |at: i32, from: usize| usize::try_from(at).ok()?.checked_sub(from * OVERSAMPLING);
            if let (Some(x), Some(y)) = (place(x, left), place(y, top))
                && x < row
                && let Some(pixel) = fine.get_mut(y * row + x)
            {
                *pixel = Some(tones(value));
            }
            Ok::<(), ChartError>(())
        })?;
    }
    Ok(Some(Raster { left, top, width, height, rgba: averaged(&fine, width, height) }))
}

/// Pixels of the page around the points: left, top, right, bottom (right and bottom outside).
fn bounds<'p>(points: impl Iterator<Item = &'p Point>) -> Option<[usize; 4]> {
    let (mut low, mut high) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
    for p in points.filter(|p| p.0.is_finite() && p.1.is_finite()) {
        low = (low.0.min(p.0), low.1.min(p.1));
        high = (high.0.max(p.0), high.1.max(p.1));
    }
    let within = |at: f64, size: usize| at.clamp(0.0, size as f64) as usize;
    let [left, top] = [within(low.0.floor() - 1.0, WIDTH), within(low.1.floor() - 1.0, HEIGHT)];
    let [right, bottom] = [within(high.0.ceil() + 1.0, WIDTH), within(high.1.ceil() + 1.0, HEIGHT)];
    (left < right && top < bottom).then_some([left, top, right, bottom])
}

fn averaged(fine: &[Option<RGBColor>], width: usize, height: usize) -> Vec<u8> {
    let count = (OVERSAMPLING * OVERSAMPLING) as u32;
    let mut rgba = Vec::with_capacity(4 * width * height);
    for y in 0..height {
        for x in 0..width {
            let first = (y * width * OVERSAMPLING + x) * OVERSAMPLING;
            let rows = (0..OVERSAMPLING).map(|k| first + k * width * OVERSAMPLING);
            let covered = rows.flat_map(|from| &fine[from..from + OVERSAMPLING]).flatten();
            let (mut sum, mut n) = ([0_u32; 3], 0);
            for color in covered {
                n += 1;
                for (total, part) in sum.iter_mut().zip([color.0, color.1, color.2]) {
                    *total += u32::from(part);
                }
            }
            rgba.extend(sum.map(|total| ((total + n / 2) / n.max(1)) as u8));
            rgba.push((255 * n / count) as u8);
        }
    }
    rgba
}
