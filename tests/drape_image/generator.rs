//! Silhouettes of a drape test whose truth is known, made without anything of the program.

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A picture to be made.
#[derive(Clone, Debug)]
pub struct Synthetic {
    pub seed: u64,
    pub folds: usize,
    pub coefficient: f64,
    pub size: [u32; 2],
    pub pixels_per_cm: f64,
    pub centre: [f64; 2],
    /// Depth, two modulations of it, and of the spacing of the folds.
    pub shape: [f64; 4],
    pub phases: [f64; 4],
    /// Background, sheet, disc (0 to 1).
    pub levels: [f64; 3],
    pub disc_seen: bool,
    /// Change of the light across the picture and its direction.
    pub light: [f64; 2],
    /// Strength of a soft shadow beside the sheet and where it lies.
    pub shadow: [f64; 3],
    /// Standard deviations: blur (px), noise.
    pub blur: f64,
    pub noise: f64,
    pub labels: usize,
    pub holes: usize,
}

const DISC: f64 = 9.0;
const SHEET: f64 = 15.0;

impl Synthetic {
    pub fn random(seed: u64) -> Self {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut between = |low: f64, high: f64| random.random_range(low..high);
        let folds = (2.0 + between(0.0, 11.0).floor()) as usize;
        let coefficient = between(0.10, 0.95);
        let long = 300.0 * 10f64.powf(between(0.0, 1.0));
        let size = [long, long * between(0.75, 1.0)].map(|n| n.round() as u32);
        let short = f64::from(size[1]);
        let pixels_per_cm = short / 2.0 / SHEET * between(0.72, 0.96);
        let free = [f64::from(size[0]), short].map(|n| 0.5 * n - SHEET * pixels_per_cm);
        let centre = [0, 1].map(|i| 0.5 * f64::from(size[i]) + free[i] * between(-0.8, 0.8));
        let mean = (DISC * DISC + coefficient * (SHEET * SHEET - DISC * DISC)).sqrt();
        let room = (SHEET - mean).min(mean - DISC);
        let shape = [room * between(0.35, 0.7), between(0.0, 0.3), between(0.0, 0.3), between(0.0, 0.8)];
        let phases = [0.0; 4].map(|_: f64| between(0.0, TAU));
        let contrast = between(0.3, 0.8);
        let dark = between(0.05, 0.95 - contrast);
        let swap = between(0.0, 1.0) < 0.4;
        let (back, sheet) = if swap { (dark, dark + contrast) } else { (dark + contrast, dark) };
        let disc_seen = between(0.0, 1.0) < 0.5;
        let step = contrast * between(0.25, 0.5) * if between(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
        let disc = (sheet + step).clamp(0.02, 0.98);
        let light = [between(0.0, 0.35), between(0.0, TAU)];
        let is_shaded = !swap && between(0.0, 1.0) < 0.3;
        let shadow =
            [if is_shaded { between(0.05, 0.35) } else { 0.0 }, between(-0.8, 0.8), between(-0.8, 0.8)];
        let blur = between(0.3, 0.004 * short);
        let noise = contrast * between(0.0, 0.12);
        let (labels, holes) = (between(0.0, 4.0) as usize, between(0.0, 3.0) as usize);
        Self {
            seed,
            folds,
            coefficient,
            size,
            pixels_per_cm,
            centre,
            shape,
            phases,
            levels: [back, sheet, disc],
            disc_seen,
            light,
            shadow,
            blur,
            noise,
            labels,
            holes,
        }
    }

    /// Whether the cast shadow takes more than six tenths of the difference between background and sheet: the analysis
    /// may take it for a part of the sheet.
    pub fn is_deeply_shaded(&self) -> bool {
        let [back, sheet, _] = self.levels;
        self.shadow[0] * back > 0.6 * (back - sheet).abs()
    }

    /// Distance of the outline from the axis (cm): folds that are unequal in depth and in spacing, brought to the area
    /// of the coefficient.
    fn outline(&self) -> Vec<f64> {
        const STEPS: usize = 14_400;
        let [depth, first, second, spacing] = self.shape;
        let [turn, a, b, c] = self.phases;
        let wave: Vec<f64> = (0..STEPS)
            .map(|i| {
                let t = TAU * i as f64 / STEPS as f64;
                let height = 1.0 + first * (t + a).cos() + second * (2.0 * t + b).cos();
                depth * height * (self.folds as f64 * t + turn + spacing * (t + c).sin()).cos()
            })
            .collect();
        let target = DISC * DISC + self.coefficient * (SHEET * SHEET - DISC * DISC);
        // Mean of (m + w)² = target.
        let (one, two) = wave.iter().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
        let (one, two) = (one / STEPS as f64, two / STEPS as f64);
        let mean = -one + (one * one - two + target).sqrt();
        wave.iter().map(|w| mean + w).collect()
    }

    pub fn pixels(&self) -> Vec<u8> {
        let outline = self.outline();
        let [width, height] = self.size.map(|n| n as usize);
        let mut random = Pcg64Mcg::seed_from_u64(self.seed ^ 0xabcdef);
        let n = outline.len();
        let at = |t: f64| {
            let s = t.rem_euclid(TAU) / TAU * n as f64;
            let (i, part) = (s.floor() as usize % n, s.fract());
            let (p, q) = (outline[i], outline[(i + 1) % n]);
            (p + part * (q - p), (q - p) * n as f64 / TAU)
        };
        // How much of the pixel at (x, y) cm the sheet covers.
        let cover = |x: f64, y: f64| {
            let (r, t) = (x.hypot(y), y.atan2(x));
            let (edge, slope) = at(t);
            let steep = (1.0 + (slope / edge).powi(2)).sqrt();
            (0.5 + (edge - r) * self.pixels_per_cm / steep).clamp(0.0, 1.0)
        };
        let disc = |x: f64, y: f64| (0.5 + (DISC - x.hypot(y)) * self.pixels_per_cm).clamp(0.0, 1.0);
        let [back, sheet, top] = self.levels;
        let mut picture = vec![0.0; width * height];
        for (i, value) in picture.iter_mut().enumerate() {
            let x = ((i % width) as f64 + 0.5 - self.centre[0]) / self.pixels_per_cm;
            let y = ((i / width) as f64 + 0.5 - self.centre[1]) / self.pixels_per_cm;
            let c = cover(x, y);
            let mut around = back;
            if self.shadow[0] > 0.0 {
                // A soft edge of a centimetre.
                let (sx, sy) = (x - self.shadow[1], y - self.shadow[2]);
                let far = at(sy.atan2(sx)).0 - sx.hypot(sy);
                around *= 1.0 - self.shadow[0] * (0.5 + far).clamp(0.0, 1.0);
            }
            let mut inside = sheet;
            if self.disc_seen {
                inside += (top - sheet) * disc(x, y);
            }
            *value = around + c * (inside - around);
        }
        self.add_labels(&mut picture, &mut random);
        self.add_holes(&mut picture, &mut random);
        blurred(&mut picture, width, height, self.blur);
        let (sin, cos) = self.light[1].sin_cos();
        picture
            .iter()
            .enumerate()
            .map(|(i, v)| {
                let x = (i % width) as f64 / width as f64 - 0.5;
                let y = (i / width) as f64 / height as f64 - 0.5;
                let light = 1.0 - self.light[0] * (0.5 + x * cos + y * sin);
                let noise: f64 = (0..6).map(|_| random.random_range(-1.0..1.0)).sum::<f64>() / 2f64.sqrt();
                ((v * light + self.noise * noise) * 255.0).round().clamp(0.0, 255.0) as u8
            })
            .collect()
    }

    /// Texts at the border: rows of small bars.
    fn add_labels(&self, picture: &mut [f64], random: &mut Pcg64Mcg) {
        let [width, height] = self.size.map(|n| n as usize);
        let unit = (height / 150).max(1);
        for label in 0..self.labels {
            let top = if label % 2 == 0 { unit } else { height - 6 * unit };
            let left = random.random_range(0..width / 2);
            for letter in 0..8 {
                for (dx, dy) in (0..unit).flat_map(|dx| (0..4 * unit).map(move |dy| (dx, dy))) {
                    let x = left + 3 * letter * unit + dx;
                    if x < width {
                        picture[(top + dy) * width + x] = self.levels[1];
                    }
                }
            }
        }
    }

    /// Reflections: small spots within the disc that look like the background.
    fn add_holes(&self, picture: &mut [f64], random: &mut Pcg64Mcg) {
        let width = self.size[0] as usize;
        for _ in 0..self.holes {
            let [x, y] = [0, 1].map(|_| random.random_range(-0.5..0.5) * DISC);
            let r = random.random_range(0.02..0.12) * DISC;
            for (i, value) in picture.iter_mut().enumerate() {
                let px = ((i % width) as f64 + 0.5 - self.centre[0]) / self.pixels_per_cm;
                let py = ((i / width) as f64 + 0.5 - self.centre[1]) / self.pixels_per_cm;
                if (px - x).hypot(py - y) < r {
                    *value = self.levels[0];
                }
            }
        }
    }

    pub fn png(&self) -> Vec<u8> {
        self.encoded(&self.pixels())
    }

    /// A picture of nothing.
    pub fn blank(&self) -> Vec<u8> {
        self.encoded(&vec![128; (self.size[0] * self.size[1]) as usize])
    }

    /// The same with a dark bar at the left.
    pub fn beside_a_ruler(&self) -> Vec<u8> {
        let mut pixels = self.pixels();
        for y in 100..400 {
            let from = y * self.size[0] as usize + 12;
            pixels[from..from + 20].fill(60);
        }
        self.encoded(&pixels)
    }

    fn encoded(&self, pixels: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.size[0], self.size[1]);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.write_header().unwrap().write_image_data(pixels).unwrap();
        bytes
    }
}

/// A Gaussian along both ways.
fn blurred(picture: &mut [f64], width: usize, height: usize, sigma: f64) {
    let reach = (3.0 * sigma).ceil() as i64;
    let kernel: Vec<f64> = (-reach..=reach).map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp()).collect();
    let sum: f64 = kernel.iter().sum();
    for (count, along, across) in [(height, 1, width), (width, width, 1)] {
        let length = width * height / count;
        for line in 0..count {
            let values: Vec<f64> = (0..length).map(|i| picture[line * across + i * along]).collect();
            for i in 0..length {
                let part = kernel.iter().enumerate().map(|(k, w)| {
                    let at = (i as i64 + k as i64 - reach).clamp(0, length as i64 - 1);
                    w * values[at as usize]
                });
                picture[line * across + i * along] = part.sum::<f64>() / sum;
            }
        }
    }
}
