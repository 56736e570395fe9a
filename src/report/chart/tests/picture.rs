//! A chart as it is seen: pixels, texts that are found in them, axes that are read from their numbers.
//!
//! Nothing here knows how a chart was laid out. Texts are found by the likeness of pixels, and a scale
//! comes from two numbers at an axis and the tick marks beside them, so that a curve which is
//! drawn at the wrong place of a right axis is seen, and one at the right place of a wrong axis too.

use super::super::canvas::{Canvas, HEIGHT, Point, WIDTH};
use super::super::letters::Type;
use super::super::palette::INK;
use plotters::prelude::RGBColor;

/// Largest difference of a channel between pixels of one colour.
const SAME: i32 = 36;
/// Least correlation of a text with the place where it is found.
const ALIKE: f64 = 0.9;

pub struct Picture {
    pixels: Vec<[u8; 3]>,
}

/// Left, top, right, bottom (right and bottom outside).
pub type Region = [usize; 4];

/// The page beside the column of values.
pub const PLOT: Region = [0, 130, 1400, HEIGHT];

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

    pub fn is(&self, x: usize, y: usize, color: RGBColor) -> bool {
        let [r, g, b] = self.pixel(x, y).map(i32::from);
        let (cr, cg, cb) = (i32::from(color.0), i32::from(color.1), i32::from(color.2));
        (r - cr).abs().max((g - cg).abs()).max((b - cb).abs()) <= SAME
    }

    /// Whether there is ink of a colour within so many pixels of a place.
    pub fn has(&self, at: Point, reach: f64, color: RGBColor) -> bool {
        disc(at, reach).any(|(x, y)| self.is(x, y, color))
    }

    /// The part of the places that have ink of a colour within so many pixels.
    pub fn covered(&self, places: &[Point], reach: f64, color: RGBColor) -> f64 {
        places.iter().filter(|p| self.has(**p, reach, color)).count() as f64 / places.len() as f64
    }

    /// The part of the ink of a colour in a region that is farther than `reach` from every place.
    pub fn stray(&self, places: &[Point], reach: f64, color: RGBColor, region: Region) -> f64 {
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
    pub fn extent(&self, color: RGBColor, region: Region) -> [f64; 4] {
        let ink = inside(region).filter(|(x, y)| self.is(*x, *y, color));
        ink.fold([f64::MAX, f64::MAX, 0.0, 0.0], |e, (x, y)| {
            let (x, y) = (x as f64, y as f64);
            [e[0].min(x), e[1].min(y), e[2].max(x + 1.0), e[3].max(y + 1.0)]
        })
    }

    fn darkness(&self, x: usize, y: usize) -> f64 {
        255.0 - self.pixel(x, y).iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0
    }

    /// The middle of the place in the region that looks most like the text; `None` where none does.
    pub fn find(&self, text: &str, kind: Type, region: Region) -> Option<Point> {
        let (template, width, height) = template(text, kind);
        let norm = template.iter().map(|v| v * v).sum::<f64>().sqrt();
        let [left, top, right, bottom] = region;
        let mut best = (ALIKE, None);
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

    /// The scale along the bottom of a frame whose lower edge is in the region.
    pub fn x_scale(&self, numbers: [&str; 2], region: Region) -> Scale {
        let at = numbers.map(|number| {
            let (x, y) = self.number(number, region);
            // The number is centred below its tick mark.
            let mark = |at: &usize| (8..45).any(|up| self.run_up(*at, y as usize - up) >= 5);
            let around = (x as usize - 9)..=(x as usize + 9);
            self.mark_middle(around.filter(mark), number)
        });
        Scale { at, value: numbers.map(value) }
    }

    /// The scale along the left side of a frame.
    pub fn y_scale(&self, numbers: [&str; 2], region: Region) -> Scale {
        let at = numbers.map(|number| {
            let (x, y) = self.number(number, region);
            let mark =
                |at: &usize| (0..90).map(|right| x as usize + right).any(|x| self.run_right(x, *at) >= 5);
            // Beside the digits, where no letter is as wide as a tick mark and the white before it.
            let around = (y as usize - 9)..=(y as usize + 9);
            self.mark_middle(around.filter(mark), number)
        });
        Scale { at, value: numbers.map(value) }
    }

    fn number(&self, number: &str, region: Region) -> Point {
        self.find(number, Type::new(26.0, INK), region)
            .unwrap_or_else(|| panic!("the number {number} is nowhere in {region:?}"))
    }

    fn mark_middle(&self, marks: impl Iterator<Item = usize>, number: &str) -> f64 {
        let marks: Vec<usize> = marks.collect();
        assert!((1..=4).contains(&marks.len()), "tick marks at {number}: {marks:?}");
        marks.iter().sum::<usize>() as f64 / marks.len() as f64 + 0.5
    }

    /// How many pixels from here upwards are dark, below a dark line that is crossed at right angles.
    fn run_up(&self, x: usize, y: usize) -> usize {
        let dark = (0..14).take_while(|up| self.darkness(x, y - up) > 120.0).count();
        let line = |y: usize| (x - 30..x + 30).all(|x| self.darkness(x, y) > 120.0);
        if self.darkness(x, y + 1) < 60.0 && (y - 14..y).any(line) { dark } else { 0 }
    }

    fn run_right(&self, x: usize, y: usize) -> usize {
        let dark = (0..14).take_while(|right| self.darkness(x + right, y) > 120.0).count();
        let line = |x: usize| (y - 30..y + 30).all(|y| self.darkness(x, y) > 120.0);
        if self.darkness(x - 1, y) < 60.0 && (x..x + 14).any(line) { dark } else { 0 }
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

/// The darkness of a text on white, row by row, its width and its height.
fn template(text: &str, kind: Type) -> (Vec<f64>, usize, usize) {
    let mut canvas = Canvas::new().unwrap();
    canvas.text((100.0, 100.0), text, kind).unwrap();
    let page = Picture::decode(&canvas.png("text").unwrap());
    let ink = |(x, y): &(usize, usize)| page.darkness(*x, *y) > 0.0;
    let places: Vec<_> = inside([0, 0, WIDTH, 200]).filter(ink).collect();
    let ends = |of: fn(&(usize, usize)) -> usize| {
        (places.iter().map(of).min().unwrap(), places.iter().map(of).max().unwrap() + 1)
    };
    let ((left, right), (top, bottom)) = (ends(|p| p.0), ends(|p| p.1));
    // White around it belongs to the text: `5` is not found in `55`.
    let region = [left - 4, top - 2, right + 4, bottom + 2];
    let values = inside(region).map(|(x, y)| page.darkness(x, y)).collect();
    (values, region[2] - region[0], region[3] - region[1])
}

/// The number that is printed with a minus sign of its own.
fn value(number: &str) -> f64 {
    number.replace('−', "-").parse().unwrap()
}
