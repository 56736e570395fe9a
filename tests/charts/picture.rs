//! A chart as it is seen: pixels, texts that are found in them, axes that are read from their numbers.
//!
//! Nothing here knows how a chart was laid out. Texts are found by the likeness of pixels, and a scale
//! comes from two numbers at an axis and the tick marks beside them, so that a curve which is
//! drawn at the wrong place of a right axis is seen, and one at the right place of a wrong axis too.

use ab_glyph::{Font, FontRef, Glyph, ScaleFont, point};

pub const WIDTH: usize = 1800;
pub const HEIGHT: usize = 1350;

/// Pixels from the upper left corner of the page.
pub type Point = (f64, f64);
pub type Color = [u8; 3];

/// Largest difference of a channel between pixels of one colour.
const SAME: i32 = 36;
/// Least correlation of a text with the place where it is found; of a number, which is short, so that a
/// shift by half a pixel weighs more.
const TEXT: f64 = 0.9;
const NUMBER: f64 = 0.8;

pub struct Picture {
    pixels: Vec<[u8; 3]>,
}

/// Left, top, right, bottom (right and bottom outside).
pub type Region = [usize; 4];

/// A linear axis: page position of a value.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    at: [f64; 2],
    value: [f64; 2],
}

impl Scale {
    pub fn page(&self, value: f64) -> f64 {
        let [a, b] = self.value;
        self.at[0] + (value - a) / (b - a) * (self.at[1] - self.at[0])
    }
}

impl Picture {
    pub fn decode(bytes: &[u8]) -> Self {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut data).unwrap();
        assert_eq!((info.width as usize, info.height as usize), (WIDTH, HEIGHT));
        Self { pixels: data.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect() }
    }

    pub fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        self.pixels[y * WIDTH + x]
    }

    pub fn is(&self, x: usize, y: usize, color: Color) -> bool {
        let [r, g, b] = self.pixel(x, y).map(i32::from);
        let [cr, cg, cb] = color.map(i32::from);
        (r - cr).abs().max((g - cg).abs()).max((b - cb).abs()) <= SAME
    }

    /// Whether there is ink of a colour within so many pixels of a place.
    pub fn has(&self, at: Point, reach: f64, color: Color) -> bool {
        disc(at, reach).any(|(x, y)| self.is(x, y, color))
    }

    /// The part of the places that have ink of a colour within so many pixels.
    pub fn covered(&self, places: &[Point], reach: f64, color: Color) -> f64 {
        places.iter().filter(|p| self.has(**p, reach, color)).count() as f64 / places.len() as f64
    }

    /// The part of the ink of a colour in a region that is farther than `reach` from every place.
    pub fn stray(&self, places: &[Point], reach: f64, color: Color, region: Region) -> f64 {
        let mut near = vec![false; WIDTH * HEIGHT];
        for place in places {
            disc(*place, reach).for_each(|(x, y)| near[y * WIDTH + x] = true);
        }
        let ink: Vec<bool> = inside(region)
            .filter(|(x, y)| self.is(*x, *y, color))
            .map(|(x, y)| near[y * WIDTH + x])
            .collect();
        assert!(!ink.is_empty(), "no ink of {color:?} in {region:?}");
        ink.iter().filter(|near| !**near).count() as f64 / ink.len() as f64
    }

    /// The smallest box around the ink of a colour.
    pub fn extent(&self, color: Color, region: Region) -> [f64; 4] {
        let ink = inside(region).filter(|(x, y)| self.is(*x, *y, color));
        ink.fold([f64::MAX, f64::MAX, 0.0, 0.0], |e, (x, y)| {
            let (x, y) = (x as f64, y as f64);
            [e[0].min(x), e[1].min(y), e[2].max(x + 1.0), e[3].max(y + 1.0)]
        })
    }

    fn darkness(&self, x: usize, y: usize) -> f64 {
        255.0 - self.pixel(x, y).iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0
    }

    /// The middle of the place in the region that looks most like the text in letters of so many pixels
    /// an em; `None` where none does.
    pub fn find(&self, text: &str, kind: (f32, bool), region: Region) -> Option<Point> {
        self.best(text, kind, region, TEXT)
    }

    fn best(&self, text: &str, (size, bold): (f32, bool), region: Region, least: f64) -> Option<Point> {
        let (template, width, height) = template(text, size, bold);
        let norm = template.iter().map(|v| v * v).sum::<f64>().sqrt();
        let [left, top, right, bottom] = region;
        let mut best = (least, None);
        for y in top..(bottom.min(HEIGHT)).saturating_sub(height) {
            for x in left..(right.min(WIDTH)).saturating_sub(width) {
                // Most places are white in the middle row.
                if (x..x + width).all(|x| self.darkness(x, y + height / 2) < 60.0) {
                    continue;
                }
                let (mut product, mut square) = (0.0, 0.0);
                for (row, line) in template.chunks_exact(width).enumerate() {
                    for (column, v) in line.iter().enumerate() {
                        let ours = self.darkness(x + column, y + row);
                        product += ours * v;
                        square += ours * ours;
                    }
                }
                let likeness = product / (norm * f64::sqrt(square).max(1.0));
                if likeness > best.0 {
                    let middle = (x as f64 + 0.5 * width as f64, y as f64 + 0.5 * height as f64);
                    best = (likeness, Some(middle));
                }
            }
        }
        best.1
    }

    /// The scale along the numbers below a frame; each is centred at its tick mark.
    pub fn x_scale(&self, numbers: [&str; 2], region: Region) -> Scale {
        Scale { at: numbers.map(|number| self.number(number, region).0), value: numbers.map(value) }
    }

    /// The scale along the numbers left of a frame.
    pub fn y_scale(&self, numbers: [&str; 2], region: Region) -> Scale {
        Scale { at: numbers.map(|number| self.number(number, region).1), value: numbers.map(value) }
    }

    fn number(&self, number: &str, region: Region) -> Point {
        self.best(number, (26.0, false), region, NUMBER)
            .unwrap_or_else(|| panic!("the number {number} is nowhere in {region:?}"))
    }
}

/// Places along a polyline, two pixels apart.
pub fn along(points: &[Point]) -> Vec<Point> {
    let mut places = Vec::new();
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let count = ((b.0 - a.0).hypot(b.1 - a.1) / 2.0).ceil().max(1.0);
        let at = |t: f64| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
        places.extend((0..count as usize).map(|i| at(i as f64 / count)));
    }
    places.extend(points.last());
    places
}

fn disc(at: Point, reach: f64) -> impl Iterator<Item = (usize, usize)> {
    let range = move |c: f64, end: usize| {
        let first = (c - reach).floor().max(0.0) as usize;
        first..((c + reach).ceil().max(0.0) as usize + 1).min(end)
    };
    let inside = move |x: usize, y: usize| (x as f64 + 0.5 - at.0).hypot(y as f64 + 0.5 - at.1) <= reach;
    range(at.1, HEIGHT)
        .flat_map(move |y| range(at.0, WIDTH).map(move |x| (x, y)))
        .filter(move |(x, y)| inside(*x, *y))
}

fn inside([left, top, right, bottom]: Region) -> impl Iterator<Item = (usize, usize)> {
    (top..bottom.min(HEIGHT)).flat_map(move |y| (left..right.min(WIDTH)).map(move |x| (x, y)))
}

/// The darkness of a text in DejaVu Sans on white, row by row, its width and its height.
fn template(text: &str, size: f32, bold: bool) -> (Vec<f64>, usize, usize) {
    let font =
        FontRef::try_from_slice(if bold { dejavu::sans::bold() } else { dejavu::sans::regular() }).unwrap();
    let scale = size * font.height_unscaled() / font.units_per_em().unwrap();
    let scaled = font.as_scaled(scale);
    // White around it belongs to the text: `5` is not found in `55`.
    let (width, height) = ((text.len() as f32 * size) as usize + 20, 2 * size as usize);
    let mut page = vec![0.0; width * height];
    let (mut x, mut last) = (10.0, None);
    for c in text.chars() {
        let id = font.glyph_id(c);
        x += last.map_or(0.0, |last| scaled.kern(last, id));
        let glyph = Glyph { id, scale: scale.into(), position: point(x, 1.4 * size) };
        if let Some(outline) = font.outline_glyph(glyph) {
            let corner = outline.px_bounds().min;
            outline.draw(|dx, dy, part| {
                page[(corner.y as usize + dy as usize) * width + corner.x as usize + dx as usize] +=
                    229.0 * f64::from(part);
            });
        }
        x += scaled.h_advance(id);
        last = Some(id);
    }
    let ink = |(_, v): &(usize, &f64)| **v > 0.0;
    let places: Vec<usize> = page.iter().enumerate().filter(ink).map(|(i, _)| i).collect();
    let (left, right) =
        (places.iter().map(|i| i % width).min().unwrap(), places.iter().map(|i| i % width).max().unwrap());
    let (top, bottom) = (places[0] / width, places[places.len() - 1] / width);
    let rows = top - 2..bottom + 3;
    let values =
        rows.clone().flat_map(|y| page[y * width + left - 4..y * width + right + 5].to_vec()).collect();
    (values, right - left + 9, rows.len())
}

/// The number that is printed with a minus sign of its own.
fn value(number: &str) -> f64 {
    number.replace('−', "-").parse().unwrap()
}
