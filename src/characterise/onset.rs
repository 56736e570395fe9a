//! Where load begins: zero offset and slack of a one-sided test.

/// The sample from which the load rises, and the mean ordinate up to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Onset {
    /// Index of the last sample of the baseline; 0 if the record begins under load.
    pub index: usize,
    /// Mean of the ordinates up to it, those of a long rest at the start left out.
    pub baseline: f64,
    /// Samples before `index` that the baseline rests on.
    pub before: usize,
}

/// Samples at rest before the drive moves that are looked at. How long the recorder ran before the motor is no
/// property of the cloth, and must not decide what counts as the toe or whether there is a baseline.
const AT_REST: usize = 3;
/// Samples of the toe that the search looks at; more are thinned out.
const TOE: usize = 48;
/// Candidates of one round of the search, which then narrows down around the best.
const CANDIDATES: usize = 16;
/// First guesses of the exponent: from a stiff start to a J curve.
const EXPONENTS: [f64; 6] = [0.8, 1.2, 1.6, 2.1, 3.0, 4.5];

/// The largest exponent: steeper ones describe a flat approach and the rise behind it as one curve from the first sample on.
const STEEPEST: f64 = 5.0;

/// Finds the onset of load on a loading branch, abscissae rising.
///
/// The toe (up to 5 % of the rise) is described by `y0 + a (x - x0)^p` for `x > x0` and by `y0`
/// before; the sample x0 with the least squares is the onset. A threshold on the load would be
/// late by the strain that the threshold takes, several per cent of EMT for a J curve.
pub(super) fn onset(x: &[f64], y: &[f64]) -> Onset {
    let skipped = (rest(x) + 1).saturating_sub(AT_REST);
    let (before, baseline) = search(&x[skipped..], &y[skipped..]);
    Onset { index: skipped + before, baseline, before }
}

/// The step that the drive makes from one sample to the next: a third of the way is made in shorter ones. Samples at
/// rest do not count, since they make no way, and gaps may be as long as a branch.
pub(super) fn usual_step(x: &[f64]) -> f64 {
    let mut steps: Vec<f64> = x.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    steps.sort_by(f64::total_cmp);
    let third = steps.iter().sum::<f64>() / 3.0;
    let mut travelled = 0.0;
    let reaches = |step: &f64| {
        travelled += step;
        travelled >= third
    };
    steps.into_iter().find(reaches).unwrap_or(0.0)
}

/// The last sample before the drive moves: it stays within half a step of the first until one is a whole step away.
pub(super) fn rest(x: &[f64]) -> usize {
    let (Some(&start), step) = (x.first(), usual_step(x)) else { return 0 };
    let first = x.iter().position(|v| (v - start).abs() > step).unwrap_or(0);
    x[..first].iter().rposition(|v| (v - start).abs() <= 0.5 * step).unwrap_or(0)
}

/// Index of the onset and mean of the ordinates up to it.
fn search(x: &[f64], y: &[f64]) -> (usize, f64) {
    let first = y.first().copied().unwrap_or(0.0);
    let peak = y.iter().copied().fold(first, f64::max);
    let end = y.iter().rposition(|v| *v < first + 0.05 * (peak - first)).map_or(0, |i| i + 1);
    // Fewer samples cannot tell slack from a soft start: the record is taken as it is.
    if end < 6 || peak <= first {
        return (0, first);
    }
    let stride = end.div_ceil(TOE);
    let toe: Vec<(f64, f64)> = (0..=end.min(y.len() - 1)).step_by(stride).map(|i| (x[i], y[i])).collect();
    let mut best = (f64::INFINITY, 0, 1.0);
    // Some of the rise must be left to fit an exponent to.
    let limit = end - end / 4;
    // Coarse search over exponents, then rounds that narrow down to single samples.
    let mut step = (limit / CANDIDATES).max(1);
    for i in (0..limit).step_by(step) {
        for p in EXPONENTS {
            let sse = misfit(&toe, x[i], p);
            if sse < best.0 {
                best = (sse, i, p);
            }
        }
    }
    loop {
        let centre = best.1;
        let (from, to) = (centre.saturating_sub(2 * step), (centre + 2 * step).min(limit));
        step = (step / 3).max(1);
        let guess = best.2;
        for i in (from..=to).step_by(step) {
            let (sse, p) = refine(&toe, x[i], guess);
            if sse < best.0 {
                best = (sse, i, p);
            }
        }
        if step == 1 && best.1 == centre {
            break;
        }
    }
    let index = best.1;
    (index, y[..=index].iter().sum::<f64>() / (index + 1) as f64)
}

/// Golden-section search for the exponent around a guess: least misfit and its exponent.
fn refine(toe: &[(f64, f64)], x0: f64, guess: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut a, mut b) = (guess / 1.5, (guess * 1.5).min(STEEPEST));
    let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
    let (mut fc, mut fd) = (misfit(toe, x0, c), misfit(toe, x0, d));
    for _ in 0..24 {
        if fc < fd {
            (b, d, fd) = (d, c, fc);
            c = b - GOLDEN * (b - a);
            fc = misfit(toe, x0, c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + GOLDEN * (b - a);
            fd = misfit(toe, x0, d);
        }
    }
    if fc < fd { (fc, c) } else { (fd, d) }
}

/// Sum of squares that the best `y0 + a (x - x0)₊^p` leaves.
fn misfit(toe: &[(f64, f64)], x0: f64, p: f64) -> f64 {
    let n = toe.len() as f64;
    let rise: Vec<f64> = toe.iter().map(|(x, _)| if *x > x0 { (x - x0).powf(p) } else { 0.0 }).collect();
    let mr = rise.iter().sum::<f64>() / n;
    let my = toe.iter().map(|t| t.1).sum::<f64>() / n;
    let (mut rr, mut ry) = (0.0, 0.0);
    for (r, (_, y)) in rise.iter().zip(toe) {
        rr += (r - mr) * (r - mr);
        ry += (r - mr) * (y - my);
    }
    let a = if rr > 0.0 { ry / rr } else { 0.0 };
    rise.iter().zip(toe).map(|(r, (_, y))| (y - my - a * (r - mr)).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    /// 200 samples of slack and a power law.
    fn record(slack: f64, p: f64, noise: f64) -> (Vec<f64>, Vec<f64>) {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(7);
        let x: Vec<f64> = (0..=200).map(|i| f64::from(i) / 200.0 * (1.0 + slack)).collect();
        let y = x
            .iter()
            .map(|x| 2.0 + 500.0 * (x - slack).max(0.0).powf(p) + noise * (rng.random::<f64>() - 0.5));
        let y = y.collect();
        (x, y)
    }

    #[test]
    fn without_slack_the_first_sample_is_the_onset() {
        for p in [1.0, 1.3, 1.5, 2.0, 2.7] {
            let (x, y) = record(0.0, p, 0.0);
            assert_eq!(onset(&x, &y), Onset { index: 0, baseline: 2.0, before: 0 }, "p = {p}");
        }
    }

    #[test]
    fn slack_is_found_to_the_sample() {
        for p in [1.0, 1.3, 1.5, 2.0, 2.7] {
            let (mut x, mut y) = record(0.0, p, 0.0);
            x = (0..20).map(|i| f64::from(i) / 200.0).chain(x.iter().map(|x| x + 0.1)).collect();
            y = [2.0; 20].into_iter().chain(y).collect();
            assert_eq!(onset(&x, &y).index, 20, "p = {p}");
        }
    }

    /// With noise of 0.04 % of the range the onset is within 1.5 % of the strain at the maximum;
    /// a threshold at 1 % of the load would be late by (0.01)^(1/1.5) = 4.6 %.
    #[test]
    fn noise_moves_it_little() {
        let (x, y) = record(0.06, 1.5, 0.4);
        let found = onset(&x, &y);
        assert!((x[found.index] - 0.06).abs() < 0.015, "{}", x[found.index]);
        assert!((found.baseline - 2.0).abs() < 0.2);
    }

    /// A recorder that was started long before the motor: the onset, the baseline and the samples after the start
    /// are those of a record that begins three samples before the motion.
    #[test]
    fn a_rest_before_the_motion_does_not_hide_it() {
        let (mut x, mut y) = record(0.06, 1.5, 0.4);
        let jitter = |i: i32| 1e-4 * f64::from(i * 7 % 5);
        for (from, to) in [(0, 4), (4, 10), (10, 400)] {
            x.splice(0..0, (from..to).map(jitter));
            y.splice(0..0, (from..to).map(|i| 2.0 + 0.3 * jitter(i)));
            let found = onset(&x, &y);
            assert!((x[found.index] - 0.06).abs() < 0.015, "{to}: {}", x[found.index]);
            assert!((found.baseline - 2.0).abs() < 0.1);
            assert_eq!(found.before, found.index - (to as usize - 2));
        }
    }

    #[test]
    fn short_and_flat_records_are_left_alone() {
        assert_eq!(onset(&[], &[]).index, 0);
        assert_eq!(onset(&[0.0, 1.0], &[1.0, 2.0]).index, 0);
        assert_eq!(onset(&[0.0; 9], &[1.0; 9]).index, 0);
    }
}
