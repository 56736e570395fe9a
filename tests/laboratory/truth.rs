//! What is true of the files: fabrics, their parameters, and the units that they are printed in.

use kesf::instrument::{Direction, Parameter};
use rand::RngExt;
use rand_pcg::Pcg64;

use Parameter as P;

/// One of several, at random.
pub fn pick<T: Copy>(rng: &mut Pcg64, all: &[T]) -> T {
    all[rng.random_range(0..all.len())]
}

/// True with this probability.
pub fn chance(rng: &mut Pcg64, p: f64) -> bool {
    rng.random::<f64>() < p
}

/// A unit as print spells it, and the SI value of one.
pub type Printed = (&'static str, f64);

const GF: f64 = 9.80665e-3;
const DEG: f64 = std::f64::consts::PI / 180.0;

/// The spellings of the units of a parameter, the customary one first.
pub fn units(p: Parameter) -> &'static [Printed] {
    const B: &[Printed] = &[
        ("gf·cm²/cm", GF * 1e-2),
        ("gf.cm2/cm", GF * 1e-2),
        ("gf·cm^2/cm", GF * 1e-2),
        ("gf*cm²/cm", GF * 1e-2),
        ("gf cm²/cm", GF * 1e-2),
        ("gf.cm²/cm", GF * 1e-2),
        ("gfcm²/cm", GF * 1e-2),
        ("µN·m", 1e-6),
        ("uN.m", 1e-6),
        ("cN·cm²/cm", 1e-4),
        ("lbf.in2/in", 4.4482216152605 * 0.0254),
    ];
    const HB: &[Printed] = &[
        ("gf·cm/cm", GF),
        ("gf.cm/cm", GF),
        ("gf cm/cm", GF),
        ("gfcm/cm", GF),
        ("mN", 1e-3),
        ("cN·cm/cm", 1e-2),
    ];
    const G: &[Printed] = &[
        ("gf/(cm·deg)", GF / 1e-2 / DEG),
        ("gf/cm·deg", GF / 1e-2 / DEG),
        ("gf/cm.deg", GF / 1e-2 / DEG),
        ("gf/cm.degree", GF / 1e-2 / DEG),
        ("gf/cm·degree", GF / 1e-2 / DEG),
        ("gf/cm degree", GF / 1e-2 / DEG),
        ("gf/cm/deg", GF / 1e-2 / DEG),
        ("gf/(cm.degree)", GF / 1e-2 / DEG),
        ("gf/cm·°", GF / 1e-2 / DEG),
        ("N/(m·deg)", 1.0 / DEG),
        ("cN/cm·deg", 1.0 / DEG),
    ];
    const HG: &[Printed] =
        &[("gf/cm", GF / 1e-2), ("N/m", 1.0), ("cN/cm", 1.0), ("lbf/in", 4.4482216152605 / 0.0254)];
    const ENERGY: &[Printed] = &[
        ("gf·cm/cm²", GF / 1e-2),
        ("gf.cm/cm2", GF / 1e-2),
        ("gf cm/cm²", GF / 1e-2),
        ("gfcm/cm²", GF / 1e-2),
        ("J/m²", 1.0),
        ("cN·cm/cm²", 1.0),
    ];
    const PART: &[Printed] = &[("%", 0.01)];
    const ONE: &[Printed] = &[("", 1.0), ("-", 1.0)];
    const T: &[Printed] = &[("mm", 1e-3), ("mm", 1e-3), ("µm", 1e-6), ("in", 0.0254)];
    const W: &[Printed] = &[("mg/cm²", 1e-2), ("mg/cm2", 1e-2), ("g/m²", 1e-3), ("g/m2", 1e-3)];
    const SMD: &[Printed] = &[("µm", 1e-6), ("um", 1e-6), ("micron", 1e-6), ("μm", 1e-6)];
    match p {
        P::B => B,
        P::Hb => HB,
        P::G => G,
        P::Hg | P::Hg5 => HG,
        P::Wt | P::Wc => ENERGY,
        P::Rt | P::Emt | P::Rc => PART,
        P::T0 | P::Tm => T,
        P::W => W,
        P::Smd => SMD,
        _ => ONE,
    }
}

/// A usual value in the customary unit; weft differs by a factor of its own.
fn usual(p: Parameter) -> f64 {
    match p {
        P::B => 0.085,
        P::Hb => 0.062,
        P::G => 0.74,
        P::Hg => 1.13,
        P::Hg5 => 2.31,
        P::Lt => 0.68,
        P::Wt => 9.4,
        P::Rt => 57.0,
        P::Emt => 6.2,
        P::Lc => 0.34,
        P::Wc => 0.123,
        P::Rc => 46.0,
        P::T0 => 0.62,
        P::Tm => 0.41,
        P::W => 15.3,
        P::Miu => 0.171,
        P::Mmd => 0.0162,
        P::Smd => 3.7,
        _ => 1.0,
    }
}

/// Groups of parameters as tests give them.
pub const GROUPS: &[&[Parameter]] = &[
    &[P::B, P::Hb],
    &[P::G, P::Hg, P::Hg5],
    &[P::Lt, P::Wt, P::Rt, P::Emt],
    &[P::Miu, P::Mmd, P::Smd],
    &[P::Lc, P::Wc, P::Rc, P::T0, P::Tm],
    &[P::B, P::Hb, P::G, P::Hg, P::Hg5],
    &[P::Lt, P::Wt, P::Rt, P::Emt, P::B, P::Hb, P::G, P::Hg, P::Hg5],
    &[
        P::Lt,
        P::Wt,
        P::Rt,
        P::Emt,
        P::B,
        P::Hb,
        P::G,
        P::Hg,
        P::Hg5,
        P::Lc,
        P::Wc,
        P::Rc,
        P::T0,
        P::W,
        P::Miu,
        P::Mmd,
        P::Smd,
    ],
];

/// A printed number: its value and the decimals that it is printed with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printing {
    pub value: f64,
    pub decimals: usize,
}

impl Printing {
    /// `value` to four figures.
    pub fn of(value: f64) -> Self {
        let decimals = (3 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 9) as usize;
        let text = format!("{value:.decimals$}");
        Self { value: text.parse().unwrap_or(value), decimals }
    }

    pub fn text(self) -> String {
        format!("{:.*}", self.decimals, self.value)
    }
}

/// One parameter of one fabric in one direction: repeats, in the unit that is printed.
#[derive(Clone, Debug)]
pub struct Quantity {
    pub parameter: Parameter,
    pub direction: Option<Direction>,
    pub unit: Printed,
    pub repeats: Vec<Printing>,
}

impl Quantity {
    /// Mean of the printed repeats, in the printed unit.
    pub fn mean(&self) -> f64 {
        self.repeats.iter().map(|r| r.value).sum::<f64>() / self.repeats.len() as f64
    }

    /// Sample standard deviation of the repeats, in the printed unit.
    pub fn sd(&self) -> f64 {
        let m = self.mean();
        let n = self.repeats.len() as f64;
        (self.repeats.iter().map(|r| (r.value - m).powi(2)).sum::<f64>() / (n - 1.0).max(1.0)).sqrt()
    }
}

/// A fabric with everything that a file says of it.
#[derive(Clone, Debug)]
pub struct Fabric {
    pub name: String,
    pub quantities: Vec<Quantity>,
}

impl Fabric {
    pub fn get(&self, p: Parameter, d: Option<Direction>) -> &Quantity {
        let d = d.filter(|_| p.is_directional());
        self.quantities
            .iter()
            .find(|q| q.parameter == p && q.direction == d)
            .expect("a quantity of the fabric")
    }
}

/// Names and codes that laboratories give to samples.
const NAMES: &[&str] = &[
    "Poplin",
    "Twill 2/1",
    "Denim A",
    "S1",
    "F01",
    "Sample 3",
    "cotton broadcloth",
    "W-17",
    "B-2",
    "T 40",
    "G-1",
    "LT-1",
    "PES 01",
    "Wool tropical",
    "JF-203",
    "No. 12",
    "K12",
    "C-03",
    "M3",
    "N 21",
];

/// Fabrics with these parameters, each with so many repeats.
pub fn fabrics(
    rng: &mut Pcg64,
    parameters: &[Parameter],
    count: usize,
    repeats: usize,
    si: bool,
) -> Vec<Fabric> {
    let printed: Vec<(Parameter, Printed)> = parameters
        .iter()
        .map(|p| {
            let all = units(*p);
            (*p, if si { pick(rng, all) } else { all[0] })
        })
        .collect();
    let first = rng.random_range(0..NAMES.len());
    (0..count)
        .map(|i| {
            let name = NAMES[(first + 7 * i) % NAMES.len()].to_string();
            let mut quantities = Vec::new();
            for (p, unit) in &printed {
                let directions: &[Option<Direction>] = if p.is_directional() {
                    &[Some(Direction::Warp), Some(Direction::Weft)]
                } else {
                    &[None]
                };
                let shape = 0.6 + 0.8 * rng.random::<f64>();
                for d in directions {
                    let of_direction =
                        if *d == Some(Direction::Weft) { 0.55 + 0.3 * rng.random::<f64>() } else { 1.0 };
                    let centre = usual(*p) * units(*p)[0].1 * shape * of_direction / unit.1;
                    let one = |rng: &mut Pcg64| Printing::of(centre * (0.94 + 0.12 * rng.random::<f64>()));
                    let repeats = (0..repeats).map(|_| one(rng)).collect();
                    quantities.push(Quantity { parameter: *p, direction: *d, unit: *unit, repeats });
                }
            }
            Fabric { name, quantities }
        })
        .collect()
}
