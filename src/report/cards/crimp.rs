//! Crimped yarns as LAW58 of OpenRadioss has them: they straighten, and press each other into the other direction.
//!
//! In the unit cell a yarn of the length `1 + S` spans the flat cloth's length 1 and rises by `H0 = √((1 + S)² - 1)`. Stretched cloth of
//! the length `L` has yarns of the length `D = √(L² + H²)`, whose tension `F(D - 1 - S)` is function 1 or 2. What a yarn loses in height
//! the other gains, `H = H0 + y` and `H' = H0' - y`, against a spring: `K y + F H/D - F' H'/D' = 0` (`sigeps58c.F`). The stress is `F L/D`
//! over the width that the cloth had.
//!
//! In a strip that is free to contract the other yarn pulls nothing, `F' = 0`, and all follows from strain and stress of the
//! cloth: `H = H0 / (1 + stress / (L K))`.

/// How crimped the yarns along warp and weft are (`S1`, `S2`), and what holds them so: the spring `K` (Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crimp {
    /// What a yarn is longer than the cloth, over the cloth's length.
    pub excess: [f64; 2],
    /// Stress over the change of height.
    pub spring: f64,
}

/// What yarns have at least of every step of a measured curve; the rest is the crimp's.
const LEAST_OF_YARNS: f64 = 0.5;

/// Greatest spring (Pa) that is looked for.
const STIFFEST: f64 = 1e30;

impl Crimp {
    /// The softest spring that gives strips no more contraction than that of the section, whose compliance `ν12 / E1` is
    /// `contraction` (1/Pa), and that leaves yarns [`LEAST_OF_YARNS`] of every step of the curves (a yarn; strain, nominal stress).
    pub fn of(excess: [f64; 2], contraction: f64, curves: &[(usize, &[[f64; 2]])]) -> Self {
        let mut soft = Self { excess, spring: 1.0 };
        let heights = soft.height(0) * soft.height(1);
        soft.spring = heights / contraction.max(heights / STIFFEST);
        if soft.leaves_to_yarns(curves) {
            return soft;
        }
        let mut stiff = Self { excess, spring: STIFFEST };
        while stiff.spring / soft.spring > 1.0 + 1e-9 {
            let middle = Self { excess, spring: (soft.spring * stiff.spring).sqrt() };
            if middle.leaves_to_yarns(curves) { stiff = middle } else { soft = middle }
        }
        stiff
    }

    /// `H0` of a yarn.
    fn height(&self, yarn: usize) -> f64 {
        let length = 1.0 + self.excess[yarn];
        (length * length - 1.0).sqrt()
    }

    /// Height of a yarn in a strip with this strain and nominal stress.
    fn pulled(&self, yarn: usize, [strain, stress]: [f64; 2]) -> f64 {
        self.height(yarn) / (1.0 + stress / ((1.0 + strain) * self.spring))
    }

    /// Abscissa and ordinate of the function of a yarn in a strip with this strain and nominal stress.
    pub fn yarn(&self, yarn: usize, [strain, stress]: [f64; 2]) -> [f64; 2] {
        let along = 1.0 + strain;
        let length = along.hypot(self.pulled(yarn, [strain, stress]));
        [length - 1.0 - self.excess[yarn], stress * length / along]
    }

    /// By how much such a strip is narrower, over its width.
    pub fn contraction(&self, yarn: usize, point: [f64; 2]) -> f64 {
        let (other, length) = (1 - yarn, 1.0 + self.excess[1 - yarn]);
        let height = self.height(other) + self.height(yarn) - self.pulled(yarn, point);
        1.0 - (length * length - height * height).max(0.0).sqrt()
    }

    /// Poisson's ratio of a strip of this modulus (Pa) where it begins to be pulled.
    pub fn at_rest(&self, modulus: f64) -> f64 {
        self.height(0) * self.height(1) * modulus / self.spring
    }

    /// The factor by which a spring of this stiffness is written, of the stiffness that yarns begin with (Pa).
    pub fn flex(&self, stiffness: [f64; 2]) -> f64 {
        let shares = [0, 1].map(|i| stiffness[i] * self.height(i) / (1.0 + self.excess[i]));
        self.spring / (shares[0] + shares[1])
    }

    fn leaves_to_yarns(&self, curves: &[(usize, &[[f64; 2]])]) -> bool {
        let stiff = Self { spring: f64::INFINITY, ..*self };
        let mut steps = curves.iter().flat_map(|(yarn, curve)| curve.windows(2).map(|pair| (*yarn, pair)));
        steps.all(|(yarn, pair)| {
            let ([length, tension], [whole, _]) = (self.step(yarn, pair), stiff.step(yarn, pair));
            length >= LEAST_OF_YARNS * whole && tension > 0.0
        })
    }

    /// What the function of a yarn grows by between two points of the cloth's curve.
    fn step(&self, yarn: usize, pair: &[[f64; 2]]) -> [f64; 2] {
        let [from, to] = [0, 1].map(|k| self.yarn(yarn, pair[k]));
        [to[0] - from[0], to[1] - from[1]]
    }
}
