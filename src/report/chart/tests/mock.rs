//! A fabric with loops made from stated parameters with noise.

use super::*;

/// The fabric, and what its noise is drawn from.
pub struct Mock {
    pub sheet: FabricSheet,
    pub random: Pcg64,
    pub noise: f64,
}

impl Mock {
    pub fn new(name: &str, origin: Origin) -> Self {
        let info = FabricInfo {
            title: name.into(),
            origin,
            weave: Some("plain".into()),
            composition: Some("100 % cotton".into()),
            ..FabricInfo::default()
        };
        let sheet = FabricSheet { name: name.to_lowercase(), info, ..FabricSheet::default() };
        Self { sheet, random: Pcg64::seed_from_u64(7), noise: 0.004 }
    }

    pub fn value(&mut self, p: Parameter, direction: Option<Direction>, kes: f64) {
        let f = p.kes_factor();
        let values = [0.97 * kes * f, kes * f, 1.035 * kes * f];
        self.sheet.values.insert(Key { parameter: p, direction }, Estimate::of(&values).unwrap());
    }

    pub fn specimen(
        &mut self,
        test: Test,
        direction: Option<Direction>,
        specimen: usize,
        parts: Vec<(bool, Vec<(f64, f64)>)>,
        windows: Vec<Window>,
    ) {
        let peak = parts.iter().flat_map(|p| &p.1).fold(0f64, |a, p| a.max(p.1.abs()));
        let mut branches = Vec::new();
        for (outgoing, points) in parts {
            let noisy = points
                .into_iter()
                .map(|(x, y)| (x, y + peak * self.noise * (self.random.random::<f64>() - 0.5) * 2.0));
            branches.push(Branch { cycle: 0, outgoing, curve: Curve::from_points(noisy) });
        }
        self.sheet.specimens.push(SpecimenResult {
            measurement: Measurement::of_curve(test, direction, specimen, Curve::default()),
            branches,
            correction: [0.0; 2],
            windows,
            fits: Vec::new(),
            values: BTreeMap::new(),
            moduli: BTreeMap::new(),
        });
    }

    pub fn bending(&mut self, direction: Option<Direction>, b: f64, hb: f64, specimens: usize) {
        for (p, v) in [
            (Parameter::B, b),
            (Parameter::Bf, 1.03 * b),
            (Parameter::Bb, 0.97 * b),
            (Parameter::Hb, hb),
            (Parameter::Hb05, 0.93 * hb),
        ] {
            self.value(p, direction, v);
        }
        for s in 1..=specimens {
            let (b, h) = (b * 9.80665e-5 * (0.94 + 0.03 * s as f64), 0.5 * hb * 9.80665e-3);
            let side =
                |k: f64, sign: f64| b * k + sign * h * (1.0 - (-(250.0 - sign * -k).abs() / 30.0).exp());
            let sweep = |from: f64, to: f64| (0..=120).map(move |i| from + (to - from) * i as f64 / 120.0);
            let parts = vec![
                (true, sweep(0.0, 250.0).map(|k| (k, b * k + h * (1.0 - (-k / 20.0).exp()))).collect()),
                (false, sweep(250.0, 0.0).map(|k| (k, side(k, -1.0))).collect()),
                (true, sweep(0.0, -250.0).map(|k| (k, side(k, -1.0))).collect()),
                (false, sweep(-250.0, 0.0).map(|k| (k, side(k, 1.0))).collect()),
            ];
            let line = |p, from: f64, to: f64, sign: f64| Window {
                parameter: p,
                from,
                to,
                ordinates: [b * from + sign * h, b * to + sign * h],
            };
            let width = |p, at: f64, part: f64| Window {
                parameter: p,
                from: at,
                to: at,
                ordinates: [b * at - part * h, b * at + part * h],
            };
            let windows = vec![
                line(Parameter::Bf, 50.0, 150.0, 1.0),
                line(Parameter::Bb, -50.0, -150.0, -1.0),
                width(Parameter::Hb, 100.0, 1.0),
                width(Parameter::Hb, -100.0, 1.0),
                width(Parameter::Hb05, 50.0, 1.0),
                width(Parameter::Hb05, -50.0, 1.0),
            ];
            self.specimen(Test::Bending, direction, s, parts, windows);
        }
    }

    pub fn shear(&mut self, direction: Option<Direction>, g: f64, hg: f64) {
        let degree = std::f64::consts::PI / 180.0;
        self.value(Parameter::G, direction, g);
        self.value(Parameter::Hg, direction, hg);
        self.value(Parameter::Hg5, direction, 1.6 * hg);
        for s in 1..=3 {
            let g = g * 56.188 * (0.94 + 0.03 * s as f64);
            let half = |phi: f64| 0.5 * hg * 0.980_665 * (1.0 + 0.6 * (phi / (5.0 * degree)).powi(2));
            let sweep =
                |from: f64, to: f64| (0..=160).map(move |i| (from + (to - from) * i as f64 / 160.0) * degree);
            let parts = vec![
                (true, sweep(0.0, 8.0).map(|p| (p, g * p + half(p) * (p / degree / 0.4).min(1.0))).collect()),
                (false, sweep(8.0, 0.0).map(|p| (p, g * p - half(p))).collect()),
                (true, sweep(0.0, -8.0).map(|p| (p, g * p - half(p))).collect()),
                (false, sweep(-8.0, 0.0).map(|p| (p, g * p + half(p))).collect()),
            ];
            let mut windows = Vec::new();
            for sign in [1.0, -1.0] {
                let [from, to] = [0.5 * degree * sign, 2.5 * degree * sign];
                let ordinates = [from, to].map(|p| g * p + sign * half(p));
                windows.push(Window { parameter: Parameter::G, from, to, ordinates });
                for (p, at) in [(Parameter::Hg, 0.5), (Parameter::Hg5, 5.0)] {
                    let at = at * degree * sign;
                    let ordinates = [g * at - half(at), g * at + half(at)];
                    windows.push(Window { parameter: p, from: at, to: at, ordinates });
                }
            }
            self.specimen(Test::Shear, direction, s, parts, windows);
        }
    }

    pub fn tensile(&mut self, direction: Option<Direction>, em: f64) {
        for (p, v) in [
            (Parameter::Lt, 0.62),
            (Parameter::Wt, 155.0 * em),
            (Parameter::Rt, 58.0),
            (Parameter::Emt, 100.0 * em),
        ] {
            self.value(p, direction, v);
        }
        for s in 1..=3 {
            let em = em * (0.94 + 0.03 * s as f64);
            let sweep = || (0..=150).map(|i| f64::from(i) / 150.0);
            let parts = vec![
                (true, sweep().map(|t| (em * t, 490.3325 * t.powf(2.2))).collect()),
                (
                    false,
                    sweep()
                        .map(|t| 1.0 - t)
                        .map(|t| (em * (0.12 + 0.88 * t), 490.3325 * t.powf(3.6)))
                        .collect(),
                ),
            ];
            self.specimen(Test::Tensile, direction, s, parts, vec![]);
        }
    }

    pub fn compression(&mut self) {
        for (p, v) in [
            (Parameter::Lc, 0.38),
            (Parameter::Wc, 0.11),
            (Parameter::Rc, 44.0),
            (Parameter::T0, 0.62),
            (Parameter::Tm, 0.44),
            (Parameter::Emc, 29.0),
        ] {
            self.value(p, None, v);
        }
        for s in 1..=3 {
            let t0 = 6.2e-4 * (0.97 + 0.015 * s as f64);
            let sweep = || (0..=100).map(|i| f64::from(i) / 100.0);
            let law = |t: f64, n: f64| (t0 - 1.8e-4 * t, 49.0 + 4854.0 * t.powf(n));
            let parts = vec![
                (true, sweep().map(|t| law(t, 4.0)).collect()),
                (false, sweep().map(|t| law(1.0 - t, 8.0)).collect()),
            ];
            self.specimen(Test::Compression, None, s, parts, vec![]);
        }
    }
}
