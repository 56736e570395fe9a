//! Writes the synthetic fabrics of `kesf_data/`: raw KES-F exports with everything that real
//! ones have (slack, zero offset, drift, noise, rounded loops, overshoot, repeated samples), from
//! stated parameters, in three laboratories' layouts.
//!
//! ```text
//! cargo run --example synthesise [-- FOLDER]
//! ```
//!
//! The output depends on nothing but this file: a second run writes the same bytes. Beside the
//! raw files each folder gets `truth.toml`, the exact parameters of every specimen; they come
//! from the closed forms and dense noise-free sums below and share no code with
//! `src/characterise`. Everything here is in KES units: gf, cm, deg, %; thickness in mm.
//!
//! The hysteresis is the exponential Duhem (Dahl) family, `dz/dx = (sgn ẋ - z) / l`, scaled by a
//! friction that may grow with the drive; it is not a Prandtl-Ishlinskii operator, so that what
//! is identified from these data is never the law that made them.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Force per width at the end of the tensile test (gf/cm).
const FM: f64 = 500.0;
/// Pressure at which thickness counts as begun, and at the end of the compression test (gf/cm²).
const P0: f64 = 0.5;
const PM: f64 = 50.0;
/// Load and pressure run over the set maximum by this much before the drive turns.
const OVERSHOOT: f64 = 1.004;
const REPEATS: usize = 3;

/// One yarn direction of a fabric.
#[derive(Clone, Copy)]
struct Yarns {
    /// Strain (%) at FM, loading and unloading exponents, residual over maximum strain.
    emt: f64,
    loading: f64,
    unloading: f64,
    residual: f64,
    /// Shear stiffness (gf/(cm·deg)), its relative growth at 8 deg; friction (gf/cm), its relative
    /// growth at 8 deg, and its sliding length (deg).
    shear: f64,
    shear_growth: f64,
    shear_friction: f64,
    friction_growth: f64,
    shear_length: f64,
    /// Bending rigidity (gf·cm²/cm), (face - back) / (face + back); friction (gf·cm/cm) and its
    /// sliding length (1/cm).
    bending: f64,
    asymmetry: f64,
    bending_friction: f64,
    bending_length: f64,
}

/// Thickness behaviour: P = contact (exp((T_s - T)/L) - 1) on loading.
#[derive(Clone, Copy)]
struct Thickness {
    /// Thickness at first contact (mm), decay length (mm), contact pressure scale (gf/cm²).
    start: f64,
    length: f64,
    contact: f64,
    /// Unloading: sharpness, and the part of the way back at which the pressure is gone.
    sharpness: f64,
    recovered: f64,
}

/// Imperfections of one channel, in its own units.
#[derive(Clone, Copy)]
struct Channel {
    /// SD of the ordinate noise, SD of the zero offset, drift over the whole test.
    noise: f64,
    offset: f64,
    drift: f64,
    /// SD of the abscissa jitter.
    jitter: f64,
}

const TENSILE: Channel = Channel { noise: 0.10, offset: 1.0, drift: 0.3, jitter: 2e-4 };
const SHEAR: Channel = Channel { noise: 0.01, offset: 0.10, drift: 0.02, jitter: 2e-3 };
const BENDING: Channel = Channel { noise: 3e-4, offset: 3e-3, drift: 5e-4, jitter: 5e-4 };
const COMPRESSION: Channel = Channel { noise: 0.015, offset: 0.10, drift: 0.02, jitter: 5e-5 };

#[derive(Clone, Copy, PartialEq)]
enum Layout {
    /// UTF-8, comma, one specimen per file.
    Poplin,
    /// CP932, TAB, specimens side by side.
    Twill,
    /// Windows-1252, semicolon, decimal comma, specimens stacked.
    Satin,
}

struct Fabric {
    name: &'static str,
    title: &'static str,
    weave: &'static str,
    composition: &'static str,
    layout: Layout,
    seed: u64,
    areal_density: f64, // g/m²
    warp: Yarns,
    weft: Yarns,
    thickness: Thickness,
}

const FABRICS: [Fabric; 3] = [
    Fabric {
        name: "poplin",
        title: "Poplin (synthetic)",
        weave: "plain",
        composition: "cotton (nominal)",
        layout: Layout::Poplin,
        seed: 101,
        areal_density: 118.0,
        warp: Yarns {
            emt: 4.2,
            loading: 1.35,
            unloading: 3.1,
            residual: 0.10,
            shear: 1.05,
            shear_growth: 0.15,
            shear_friction: 0.95,
            friction_growth: 0.55,
            shear_length: 0.22,
            bending: 0.085,
            asymmetry: 0.06,
            bending_friction: 0.034,
            bending_length: 0.11,
        },
        weft: Yarns {
            emt: 7.6,
            loading: 1.50,
            unloading: 3.6,
            residual: 0.09,
            shear: 0.98,
            shear_growth: 0.18,
            shear_friction: 0.90,
            friction_growth: 0.60,
            shear_length: 0.24,
            bending: 0.052,
            asymmetry: 0.04,
            bending_friction: 0.022,
            bending_length: 0.12,
        },
        thickness: Thickness { start: 0.52, length: 0.045, contact: 0.55, sharpness: 5.5, recovered: 0.80 },
    },
    Fabric {
        name: "twill",
        title: "Twill (synthetic)",
        weave: "twill 2/2",
        composition: "wool (nominal)",
        layout: Layout::Twill,
        seed: 202,
        areal_density: 214.0,
        warp: Yarns {
            emt: 6.3,
            loading: 1.70,
            unloading: 3.3,
            residual: 0.07,
            shear: 0.62,
            shear_growth: 0.20,
            shear_friction: 0.48,
            friction_growth: 0.70,
            shear_length: 0.20,
            bending: 0.118,
            asymmetry: -0.09,
            bending_friction: 0.021,
            bending_length: 0.10,
        },
        weft: Yarns {
            emt: 9.8,
            loading: 1.85,
            unloading: 3.7,
            residual: 0.06,
            shear: 0.59,
            shear_growth: 0.22,
            shear_friction: 0.45,
            friction_growth: 0.75,
            shear_length: 0.21,
            bending: 0.081,
            asymmetry: -0.11,
            bending_friction: 0.017,
            bending_length: 0.10,
        },
        thickness: Thickness { start: 0.86, length: 0.072, contact: 0.60, sharpness: 4.6, recovered: 0.88 },
    },
    Fabric {
        name: "satin",
        title: "Satin (synthetic)",
        weave: "satin 5",
        composition: "polyester (nominal)",
        layout: Layout::Satin,
        seed: 303,
        areal_density: 96.0,
        warp: Yarns {
            emt: 3.1,
            loading: 1.25,
            unloading: 2.6,
            residual: 0.08,
            shear: 0.38,
            shear_growth: 0.12,
            shear_friction: 0.21,
            friction_growth: 0.50,
            shear_length: 0.18,
            bending: 0.046,
            asymmetry: 0.13,
            bending_friction: 0.012,
            bending_length: 0.09,
        },
        weft: Yarns {
            emt: 5.5,
            loading: 1.40,
            unloading: 2.9,
            residual: 0.08,
            shear: 0.36,
            shear_growth: 0.12,
            shear_friction: 0.20,
            friction_growth: 0.55,
            shear_length: 0.18,
            bending: 0.029,
            asymmetry: 0.10,
            bending_friction: 0.009,
            bending_length: 0.09,
        },
        thickness: Thickness { start: 0.31, length: 0.026, contact: 0.60, sharpness: 5.0, recovered: 0.84 },
    },
];

/// Parameters of a specimen: symbol, exact value, and how far an evaluation of the noisy record
/// may be from it.
type Truth = Vec<(&'static str, f64, f64)>;

/// The recorded samples of one specimen and the truth behind them.
struct Record {
    points: Vec<(f64, f64)>,
    truth: Truth,
}

struct Noise(Pcg64);

impl Noise {
    /// A standard normal deviate (Box-Muller).
    fn normal(&mut self) -> f64 {
        let u: f64 = 1.0 - self.0.random::<f64>();
        let v: f64 = self.0.random();
        (-2.0 * u.ln()).sqrt() * (2.0 * std::f64::consts::PI * v).cos()
    }

    /// `value` with a relative scatter `cv` from specimen to specimen.
    fn scatter(&mut self, value: f64, cv: f64) -> f64 {
        value * (1.0 + cv * self.normal().clamp(-2.0, 2.0))
    }

    /// The record of a clean curve: jitter, noise, offset and drift.
    fn record(&mut self, clean: &[(f64, f64)], channel: Channel) -> Vec<(f64, f64)> {
        let offset = channel.offset * self.normal();
        let step = channel.drift * self.normal().clamp(-1.0, 1.0) / clean.len() as f64;
        (clean.iter().enumerate())
            .map(|(i, &(x, y))| {
                let x = x + channel.jitter * self.normal();
                (x, y + offset + step * i as f64 + channel.noise * self.normal())
            })
            .collect()
    }

    fn yarns(&mut self, mean: &Yarns) -> Yarns {
        Yarns {
            emt: self.scatter(mean.emt, 0.03),
            loading: self.scatter(mean.loading, 0.01),
            unloading: self.scatter(mean.unloading, 0.01),
            shear: self.scatter(mean.shear, 0.025),
            shear_friction: self.scatter(mean.shear_friction, 0.04),
            bending: self.scatter(mean.bending, 0.03),
            asymmetry: self.scatter(mean.asymmetry, 0.1),
            bending_friction: self.scatter(mean.bending_friction, 0.04),
            ..*mean
        }
    }

    fn thickness(&mut self, mean: &Thickness) -> Thickness {
        Thickness {
            start: self.scatter(mean.start, 0.01),
            length: self.scatter(mean.length, 0.02),
            sharpness: self.scatter(mean.sharpness, 0.02),
            ..*mean
        }
    }
}

/// `n` abscissae from `a` (excluded) to `b` (included).
fn steps(a: f64, b: f64, n: usize) -> impl Iterator<Item = f64> {
    (1..=n).map(move |i| a + (b - a) * i as f64 / n as f64)
}

/// Least-squares slope of a function over an interval, on a dense uniform grid.
fn slope(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    const N: usize = 20_000;
    let middle = 0.5 * (a + b);
    let (mut xy, mut xx) = (0.0, 0.0);
    for x in steps(a, b, N) {
        let t = x - middle - 0.5 * (b - a) / N as f64; // grid centred in the interval
        xy += t * f(middle + t);
        xx += t * t;
    }
    xy / xx
}

/// Uncertainty (4 SD) of a least-squares slope from `n` noisy samples over a window of `width`.
fn slope_tolerance(channel: Channel, n: f64, width: f64) -> f64 {
    4.0 * channel.noise * (12.0 / n).sqrt() / width + channel.drift / n
}

/// FB1 tensile: x = strain (%), y = force (gf/cm).
fn tensile(yarns: &Yarns, noise: &mut Noise) -> Record {
    const LOADING: usize = 160;
    const UNLOADING: usize = 90;
    let Yarns { emt, loading: n, unloading: m, .. } = *yarns;
    let top = emt * OVERSHOOT.powf(1.0 / n);
    let (peak, rest) = (FM * OVERSHOOT, yarns.residual * emt);
    let force = |e: f64| FM * (e.max(0.0) / emt).powf(n);
    let back = |e: f64| peak * ((e - rest).max(0.0) / (top - rest)).powf(m);

    // Slack: the jaws travel before the cloth takes load; some samples are taken at rest.
    let slack = emt * (0.04 + 0.04 * noise.0.random::<f64>());
    let mut clean = vec![(0.0, 0.0); 3];
    clean.extend(steps(0.0, top + slack, LOADING).map(|x| (x, force(x - slack))));
    clean.push((top + slack, peak));
    clean.extend(steps(top + slack, 0.0, UNLOADING).map(|x| (x, back(x - slack))));

    let wt = FM * emt / 100.0 / (n + 1.0);
    // The unloading branch below the strain at FM.
    let recovered = peak * (top - rest) / 100.0 / (m + 1.0) * ((emt - rest) / (top - rest)).powf(m + 1.0);
    let strain_at = |f: f64| emt * (f / FM).powf(1.0 / n);
    let (low, high) = (strain_at(5.0), strain_at(20.0));
    let tangent = slope(force, low, high) * 100.0;

    // Onset of load: one sampling step, and the strain at which load leaves the noise.
    let step = (top + slack) / LOADING as f64;
    let onset = step + strain_at(TENSILE.noise);
    let area = emt / 100.0 * (4.0 * TENSILE.noise + TENSILE.drift);
    let samples = (high - low) / step;
    let truth = vec![
        ("LT", 2.0 / (n + 1.0), 2.0 / (n + 1.0) * (onset / emt + area / wt)),
        ("WT", wt, area),
        ("RT", 100.0 * recovered / wt, 100.0 * (area / wt + recovered * area / (wt * wt))),
        ("EMT", emt, onset),
        ("tangent_low", tangent, 100.0 * slope_tolerance(TENSILE, samples, high - low) + 0.03 * tangent),
        ("secant", 100.0 * FM / emt, 100.0 * FM / emt * onset / emt),
        ("energy", 2e4 * wt / (emt * emt), 2e4 * wt / (emt * emt) * (2.0 * onset / emt + area / wt)),
    ];
    Record { points: noise.record(&clean, TENSILE), truth }
}

/// A closed cycle 0, +top, -top, 0 with exponential (Dahl) friction `z` of sliding length `l`.
struct Cycle<F: Fn(f64, f64) -> f64> {
    top: f64,
    l: f64,
    /// Ordinate of (x, z).
    law: F,
}

impl<F: Fn(f64, f64) -> f64> Cycle<F> {
    /// First branch, 0 to +top, in virgin cloth.
    fn first(&self, x: f64) -> f64 {
        (self.law)(x, 1.0 - (-x / self.l).exp())
    }

    /// Second branch, +top to -top.
    fn second(&self, x: f64) -> f64 {
        let z = 1.0 - (-self.top / self.l).exp();
        (self.law)(x, -1.0 + (z + 1.0) * ((x - self.top) / self.l).exp())
    }

    /// Third branch, -top to 0.
    fn third(&self, x: f64) -> f64 {
        let z = 1.0 - (-self.top / self.l).exp();
        let z = -1.0 + (z + 1.0) * (-2.0 * self.top / self.l).exp();
        (self.law)(x, 1.0 + (z - 1.0) * (-(x + self.top) / self.l).exp())
    }

    /// Loop width at +x and -x, mean of both.
    fn width(&self, x: f64) -> f64 {
        0.5 * (self.first(x) - self.second(x) + self.third(-x) - self.second(-x))
    }

    /// Samples at `n` per quarter, some at rest before the start and at each reversal.
    fn sample(&self, n: usize) -> Vec<(f64, f64)> {
        let top = self.top;
        let mut points = vec![(0.0, self.first(0.0)); 3];
        points.extend(steps(0.0, top, n).map(|x| (x, self.first(x))));
        points.push((top, self.first(top)));
        points.extend(steps(top, -top, 2 * n).map(|x| (x, self.second(x))));
        points.push((-top, self.second(-top)));
        points.extend(steps(-top, 0.0, n).map(|x| (x, self.third(x))));
        points
    }
}

/// FB1 shear: x = angle (deg), y = force (gf/cm).
fn shear(yarns: &Yarns, noise: &mut Noise) -> Record {
    const QUARTER: usize = 60;
    let y = *yarns;
    let cycle = Cycle {
        top: 8.0,
        l: y.shear_length,
        law: |x: f64, z: f64| {
            let u2 = (x / 8.0) * (x / 8.0);
            y.shear * x * (1.0 + y.shear_growth * u2) + y.shear_friction * (1.0 + y.friction_growth * u2) * z
        },
    };
    let g = 0.5 * (slope(|x| cycle.first(x), 0.5, 2.5) + slope(|x| cycle.second(x), -2.5, -0.5));
    let per_deg = QUARTER as f64 / 8.0;
    // Where the first branch still bends (below 1 deg), samples 0.13 deg apart and jitter add to the noise.
    let bend = 0.03 * y.shear_friction;
    let reading = 4.0 * SHEAR.noise + SHEAR.drift;
    let truth = vec![
        ("G", g, slope_tolerance(SHEAR, 2.0 * per_deg, 2.0) + 0.01 * g),
        ("2HG", cycle.width(0.5), reading + bend),
        ("2HG5", cycle.width(5.0), reading),
    ];
    Record { points: noise.record(&cycle.sample(QUARTER), SHEAR), truth }
}

/// FB2 bending: x = curvature (1/cm), y = moment (gf·cm/cm).
fn bending(yarns: &Yarns, noise: &mut Noise) -> Record {
    const QUARTER: usize = 60;
    let y = *yarns;
    let cycle = Cycle {
        top: 2.5,
        l: y.bending_length,
        // Face and back differ; the change from one to the other takes about 0.1 1/cm.
        law: |x: f64, z: f64| {
            let turn = (x * x + 0.01).sqrt() - 0.1;
            y.bending * (x + y.asymmetry * turn) + y.bending_friction * z
        },
    };
    let face = slope(|x| cycle.first(x), 0.5, 1.5);
    let back = slope(|x| cycle.second(x), -1.5, -0.5);
    let spread = slope_tolerance(BENDING, QUARTER as f64 / 2.5, 1.0);
    let reading = 4.0 * BENDING.noise + BENDING.drift;
    let truth = vec![
        ("B", 0.5 * (face + back), spread),
        ("Bf", face, spread),
        ("Bb", back, spread),
        ("2HB", cycle.width(1.0), reading),
        ("2HB05", cycle.width(0.5), reading),
    ];
    Record { points: noise.record(&cycle.sample(QUARTER), BENDING), truth }
}

/// FB3 compression: x = thickness (mm), y = pressure (gf/cm²).
fn compression(cloth: &Thickness, noise: &mut Noise) -> Record {
    const LOADING: usize = 150;
    let Thickness { start, length, contact, sharpness, recovered } = *cloth;
    let pressure = |t: f64| contact * (((start - t) / length).max(0.0).exp() - 1.0);
    let thickness = |p: f64| start - length * (1.0 + p / contact).ln();
    let (t0, tm, end) = (thickness(P0), thickness(PM), thickness(PM * OVERSHOOT));
    let (peak, gone) = (PM * OVERSHOOT, end + recovered * (start - end));
    let back = |t: f64| {
        peak * ((sharpness * (gone - t).max(0.0) / (gone - end)).exp() - 1.0) / (sharpness.exp() - 1.0)
    };
    // The foot starts above the cloth.
    let above = start + 0.12 * (start - end);
    let mut clean = vec![(above, 0.0); 3];
    clean.extend(steps(above, end, LOADING).map(|t| (t, pressure(t))));
    clean.push((end, peak));
    clean.extend(steps(end, above, LOADING / 2).map(|t| (t, back(t))));

    // Energies in gf·cm/cm²: thickness in cm.
    let primitive = |t: f64| -contact * (length * ((start - t) / length).exp() + t);
    let wc = 0.1 * (primitive(t0) - primitive(tm));
    let scale = peak / (sharpness.exp() - 1.0);
    let back_primitive = |t: f64| {
        let rate = sharpness / (gone - end);
        -scale * ((rate * (gone - t)).exp() / rate + t)
    };
    let regained = 0.1 * (back_primitive(gone.min(t0)) - back_primitive(tm));

    let step = (above - end) / LOADING as f64;
    // Reading the thickness where the pressure is low: noise over the slope there, plus jitter.
    let slope_at_p0 = (contact + P0) / length;
    let low = 4.0 * (COMPRESSION.noise + COMPRESSION.jitter * slope_at_p0) / slope_at_p0
        + COMPRESSION.drift / slope_at_p0
        + 0.25 * step;
    let high = 8.0 * COMPRESSION.jitter + 0.25 * step;
    let area = 0.1 * ((4.0 * COMPRESSION.noise + COMPRESSION.drift) * (t0 - tm) + PM * high);
    let lc = wc / (0.1 * PM * (t0 - tm) / 2.0);
    let truth = vec![
        ("LC", lc, lc * (area / wc + (low + high) / (t0 - tm))),
        ("WC", wc, area),
        ("RC", 100.0 * regained / wc, 100.0 * (area / wc) * (1.0 + regained / wc)),
        ("T0", t0, low),
        ("Tm", tm, high),
        ("EMC", 100.0 * (t0 - tm) / t0, 100.0 * (low + high) / t0),
    ];
    Record { points: noise.record(&clean, COMPRESSION), truth }
}

/// The tests: key, decimals of abscissa and ordinate.
#[derive(Clone, Copy, PartialEq)]
enum Test {
    Tensile,
    Shear,
    Bending,
    Compression,
}

impl Test {
    const ALL: [Self; 4] = [Self::Tensile, Self::Shear, Self::Bending, Self::Compression];

    fn name(self) -> &'static str {
        ["tensile", "shear", "bending", "compression"][self as usize]
    }

    fn decimals(self) -> (usize, usize) {
        [(4, 2), (3, 3), (4, 5), (4, 3)][self as usize]
    }
}

/// One specimen of the set: test, direction (`None` for compression), number, data.
struct Specimen {
    test: Test,
    direction: Option<&'static str>,
    number: usize,
    record: Record,
}

fn specimens(fabric: &Fabric) -> Vec<Specimen> {
    let mut noise = Noise(Pcg64::seed_from_u64(fabric.seed));
    let mut all = Vec::new();
    for test in Test::ALL {
        let directions: &[(Option<&str>, &Yarns)] = match test {
            Test::Compression => &[(None, &fabric.warp)],
            _ => &[(Some("warp"), &fabric.warp), (Some("weft"), &fabric.weft)],
        };
        for &(direction, mean) in directions {
            for number in 1..=REPEATS {
                let record = match test {
                    Test::Tensile => tensile(&noise.yarns(mean), &mut noise),
                    Test::Shear => shear(&noise.yarns(mean), &mut noise),
                    Test::Bending => bending(&noise.yarns(mean), &mut noise),
                    Test::Compression => compression(&noise.thickness(&fabric.thickness), &mut noise),
                };
                all.push(Specimen { test, direction, number, record });
            }
        }
    }
    all
}

/// `value` with `decimals` places, never "-0.000".
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.')) { text.replace('-', "") } else { text }
}

fn poplin(folder: &Path, all: &[Specimen]) -> Result<(), Box<dyn Error>> {
    for s in all {
        let (instrument, gauge, maximum, header) = match s.test {
            Test::Tensile => ("FB1", "5 cm", "500 gf/cm", "strain (%),force (gf/cm)"),
            Test::Shear => ("FB1", "5 cm", "8 deg", "angle (deg),force (gf/cm)"),
            Test::Bending => ("FB2", "1 cm", "2.5 1/cm", "curvature (1/cm),moment (gf·cm/cm)"),
            Test::Compression => ("FB3", "", "50 gf/cm²", "thickness (mm),pressure (gf/cm²)"),
        };
        let mut text = format!("sample,poplin\ninstrument,KES-{instrument}\ntest,{}\n", s.test.name());
        if let Some(direction) = s.direction {
            writeln!(text, "direction,{direction}")?;
        }
        writeln!(text, "specimen,{}", s.number)?;
        if s.test == Test::Compression {
            writeln!(text, "area,2 cm²")?;
        } else {
            writeln!(text, "width,20 cm\ngauge,{gauge}")?;
        }
        if s.test == Test::Shear {
            writeln!(text, "pretension,10 gf/cm")?;
        }
        writeln!(text, "maximum,{maximum}\n\n{header}")?;
        let (dx, dy) = s.test.decimals();
        for &(x, y) in &s.record.points {
            writeln!(text, "{},{}", number(x, dx), number(y, dy))?;
        }
        let kind = if s.test == Test::Shear { "_shear" } else { "" };
        let direction = s.direction.map_or(String::new(), |d| format!("_{d}"));
        fs::write(folder.join(format!("poplin{direction}_{instrument}{kind}_{}.csv", s.number)), text)?;
    }
    Ok(())
}

fn twill(folder: &Path, all: &[Specimen]) -> Result<(), Box<dyn Error>> {
    for set in all.chunks(REPEATS) {
        let (test, direction) = (set[0].test, set[0].direction);
        let (machine, gauge, x_name, y_name) = match test {
            Test::Tensile => ("KES-FB1 引張", "5cm", "伸び(％)", "荷重(ｇｆ/㎝)"),
            Test::Shear => ("KES-FB1 せん断", "5cm", "せん断角(度)", "せん断力(ｇｆ/㎝)"),
            Test::Bending => ("KES-FB2 曲げ", "1cm", "曲率(㎝-1)", "曲げモーメント(ｇｆ・㎝/㎝)"),
            Test::Compression => ("KES-FB3 圧縮", "", "厚さ(㎜)", "圧力(ｇｆ/㎝2)"),
        };
        let mut text = format!("試料名\ttwill\r\n測定器\t{machine}\r\n");
        if let Some(direction) = direction {
            let kanji = if direction == "warp" { "経" } else { "緯" };
            write!(text, "方向\t{kanji}\r\n幅\t20cm\r\nチャック間隔\t{gauge}\r\n")?;
        }
        let numbers: Vec<String> = set.iter().map(|s| format!("試料番号\t{}", s.number)).collect();
        let headers = vec![format!("{x_name}\t{y_name}"); set.len()];
        write!(text, "\r\n{}\r\n{}\r\n", numbers.join("\t"), headers.join("\t"))?;
        let (dx, dy) = test.decimals();
        let rows = set.iter().map(|s| s.record.points.len()).max().unwrap_or(0);
        for row in 0..rows {
            let cells: Vec<String> = (set.iter())
                .map(|s| match s.record.points.get(row) {
                    Some(&(x, y)) => format!("{}\t{}", number(x, dx), number(y, dy)),
                    None => "\t".to_string(),
                })
                .collect();
            write!(text, "{}\r\n", cells.join("\t"))?;
        }
        let (bytes, _, unmappable) = encoding_rs::SHIFT_JIS.encode(&text);
        if unmappable {
            return Err("a character is not in CP932".into());
        }
        let direction = direction.map_or(String::new(), |d| format!("_{d}"));
        fs::write(folder.join(format!("twill_{}{direction}.txt", test.name())), bytes)?;
    }
    Ok(())
}

fn satin(folder: &Path, all: &[Specimen]) -> Result<(), Box<dyn Error>> {
    for test in Test::ALL {
        let (name, gauge, header, factors) = match test {
            // The machine's own record: extension over 5 cm, load on 20 cm.
            Test::Tensile => ("FB1 tração", "5 cm", "extensão (mm);força (gf)", (0.5, 20.0)),
            Test::Shear => ("FB1 corte", "5 cm", "ângulo (°);força (gf/cm)", (1.0, 1.0)),
            Test::Bending => ("FB2 flexão", "1 cm", "curvatura (1/cm);momento (gf·cm/cm)", (1.0, 1.0)),
            Test::Compression => ("FB3 compressão", "", "espessura (mm);pressão (gf/cm²)", (1.0, 1.0)),
        };
        let (dx, dy) = test.decimals();
        let mut text = String::new();
        for s in all.iter().filter(|s| s.test == test) {
            write!(text, "amostra;satin\r\nensaio;{name}\r\n")?;
            if let Some(direction) = s.direction {
                let word = if direction == "warp" { "urdume" } else { "trama" };
                write!(text, "direção;{word}\r\nprovete;{}\r\n", s.number)?;
                write!(text, "largura;20 cm\r\ndistância;{gauge}\r\n")?;
            } else {
                write!(text, "provete;{}\r\n", s.number)?;
            }
            write!(text, "\r\n{header}\r\n")?;
            for &(x, y) in &s.record.points {
                let row = format!("{};{}\r\n", number(x * factors.0, dx), number(y * factors.1, dy));
                text.push_str(&row.replace('.', ","));
            }
            text.push_str("\r\n");
        }
        let (bytes, _, unmappable) = encoding_rs::WINDOWS_1252.encode(&text);
        if unmappable {
            return Err("a character is not in Windows-1252".into());
        }
        fs::write(folder.join(format!("satin_{}.csv", test.name())), bytes)?;
    }
    Ok(())
}

fn fabric_toml(fabric: &Fabric) -> String {
    format!(
        "name = \"{}\"\nweave = \"{}\"\ncomposition = \"{}\"\norigin = \"synthetic\"\n\
         source = \"Generated by examples/synthesise.rs from stated parameters; no cloth was measured. The exact parameters of each specimen are in truth.toml.\"\n\
         areal_density = \"{} g/m²\"\n\
         notes = [\"Synthetic data: exponential (Dahl) hysteresis with slack, zero offset, drift, noise and specimen scatter.\"]\n",
        fabric.title, fabric.weave, fabric.composition, fabric.areal_density
    )
}

fn truth_toml(fabric: &Fabric, all: &[Specimen]) -> Result<String, Box<dyn Error>> {
    let mut text = format!(
        "# Exact parameters behind the synthetic records of this folder, KES units, written by\n\
         # examples/synthesise.rs: symbol = [value, tolerance]. The tolerance follows from the stated\n\
         # noise, drift and sampling step. tangent_low, secant and energy are in gf/cm.\n\n\
         areal_density = {} # g/m²\n",
        fabric.areal_density
    );
    for (test, c) in Test::ALL.iter().zip([TENSILE, SHEAR, BENDING, COMPRESSION]) {
        write!(text, "\n[noise.{}] # units of the ordinate; jitter: of the abscissa\n", test.name())?;
        writeln!(
            text,
            "sd = {}\noffset_sd = {}\ndrift = {}\njitter_sd = {}",
            c.noise, c.offset, c.drift, c.jitter
        )?;
    }
    for s in all {
        write!(text, "\n[[specimen]]\ntest = \"{}\"\n", s.test.name())?;
        if let Some(direction) = s.direction {
            writeln!(text, "direction = \"{direction}\"")?;
        }
        writeln!(text, "number = {}\n[specimen.values]", s.number)?;
        for (symbol, value, tolerance) in &s.record.truth {
            // Six significant figures: the same bytes on machines whose exp() differs in the last bit.
            let value: f64 = format!("{value:.5e}").parse()?;
            let tolerance: f64 = format!("{tolerance:.1e}").parse()?;
            writeln!(text, "{symbol} = [{value:?}, {tolerance:?}]")?;
        }
    }
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    let root = std::env::args_os()
        .nth(1)
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data"), PathBuf::from);
    for fabric in &FABRICS {
        let folder = root.join(fabric.name);
        fs::create_dir_all(&folder)?;
        let all = specimens(fabric);
        match fabric.layout {
            Layout::Poplin => poplin(&folder, &all)?,
            Layout::Twill => twill(&folder, &all)?,
            Layout::Satin => satin(&folder, &all)?,
        }
        fs::write(folder.join("fabric.toml"), fabric_toml(fabric))?;
        fs::write(folder.join("truth.toml"), truth_toml(fabric, &all)?)?;
    }
    Ok(())
}
