//! Goal: the law is what theory.md says. References: Coulomb friction in closed form, central
//! differences, the energy balance; none is our own output.

use approx::assert_relative_eq;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::*;

/// A bending-like law: asymmetric backbone, six sliders, widening loop (SI of order 1).
fn bending() -> Channel {
    let knots = [-2.5, -1.6, -0.8, 0.0, 0.8, 1.6, 2.5];
    let backbone = Backbone::new(0.02, &knots, &[1.4, 1.0, 0.9, 0.8, 0.9, 1.2, 1.1]).unwrap();
    let sliders = (1..=6).map(|i| Slider { stiffness: 2.0 / f64::from(i), slip: 0.02 * f64::from(i) });
    let widening = Widening::Quadratic { alpha: 1.5, e_max: 2.5 };
    Channel::new(backbone, vec![Family { widening, sliders: sliders.collect() }], false).unwrap()
}

/// A tension-like law: J curve, two families.
fn tension() -> Channel {
    let knots = [0.0, 0.02, 0.05, 0.08];
    let backbone = Backbone::new(0.0, &knots, &[300.0, 900.0, 4000.0, 9000.0]).unwrap();
    let loading = Widening::Loading(backbone.clone());
    let family = |widening, part: f64| Family {
        widening,
        sliders: vec![
            Slider { stiffness: 900.0 * part, slip: 4e-4 },
            Slider { stiffness: 400.0 * part, slip: 3e-3 },
        ],
    };
    Channel::new(backbone, vec![family(Widening::Constant, 0.3), family(loading, 1.0)], false).unwrap()
}

fn random_path(seed: u64, range: [f64; 2], steps: usize) -> Vec<f64> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let width = range[1] - range[0];
    let mut at = 0.0;
    let step = |_| {
        // Mostly small steps, now and then a leap across the range.
        let leap = if rng.random_bool(0.05) { 1.0 } else { 0.02 };
        at = (at + leap * width * (rng.random::<f64>() - 0.5)).clamp(range[0], range[1]);
        at
    };
    (0..steps).map(step).collect()
}

#[test]
fn the_backbone_integrates_its_tangent() {
    let b = bending().backbone().clone();
    assert_relative_eq!(b.at(0.0).stress, 0.02, epsilon = 1e-15);
    assert_eq!(b.at(0.0).energy, 0.0);
    for i in -40..=40 {
        let (e, h) = (0.1 * f64::from(i) + 0.013, 1e-5);
        let difference = |f: fn(ElasticResponse) -> f64| (f(b.at(e + h)) - f(b.at(e - h))) / (2.0 * h);
        assert_relative_eq!(difference(|x| x.stress), b.at(e).tangent, epsilon = 1e-8);
        assert_relative_eq!(difference(|x| x.energy), b.at(e).stress, epsilon = 1e-8);
    }
    // Beyond the knots it goes on with its end tangents.
    assert_relative_eq!(b.at(4.0).stress, b.at(2.5).stress + 1.5 * 1.1, max_relative = 1e-14);
    assert_relative_eq!(b.at(-4.0).stress, b.at(-2.5).stress - 1.5 * 1.4, max_relative = 1e-14);
    // The trapezoids of a tangent that is linear between knots.
    assert_relative_eq!(b.at(0.8).stress, 0.02 + 0.8 * 0.85, max_relative = 1e-14);
    assert_relative_eq!(b.with_offset(0.5).at(1.0).stress, b.at(1.0).stress + 0.48, max_relative = 1e-14);
    assert_relative_eq!(b.with_offset(0.5).at(1.0).energy, b.at(1.0).energy + 0.48, max_relative = 1e-14);
}

#[test]
fn the_tangent_and_the_stress_are_derivatives() {
    for (channel, range) in [(bending(), [-2.5, 2.5]), (tension(), [0.0, 0.09])] {
        let mut state = State::default();
        let (h, mut checked) = (1e-7 * range[1], 0);
        for strain in random_path(7, range, 3000) {
            let [low, here, high] = [strain - h, strain, strain + h].map(|e| channel.trial(&state, e));
            // At the kinks, where a slider begins to slip or a knot lies, there is no derivative.
            if (low.tangent - high.tangent).abs() < 1e-5 * here.tangent {
                let (stress, energy) =
                    (high.stress - low.stress, high.energy + high.dissipation - low.energy - low.dissipation);
                assert_relative_eq!(stress / (2.0 * h), here.tangent, max_relative = 1e-6);
                let scale = channel.backbone().at(range[1]).stress;
                assert_relative_eq!(
                    energy / (2.0 * h),
                    here.stress,
                    max_relative = 1e-6,
                    epsilon = 1e-6 * scale
                );
                checked += 1;
            }
            assert!(here.tangent >= 0.0);
            state = here.state;
        }
        // A path that stays at an end of its range stands on a kink.
        assert!(checked > 2500, "{checked}");
    }
}

#[test]
fn no_path_gives_energy() {
    for (channel, range) in [(bending(), [-2.5, 2.5]), (tension(), [-0.01, 0.09])] {
        for seed in 0..20 {
            let mut total = 0.0;
            for response in channel.path(State::default(), random_path(seed, range, 3000)) {
                assert!(response.dissipation >= 0.0);
                total += response.dissipation;
            }
            assert!(total > 0.0);
        }
    }
}

#[test]
fn work_is_stored_or_lost() {
    // With constant slip levels the trapezoid rule on a fine path balances to its own error.
    let family = Family { widening: Widening::Constant, ..bending().families()[0].clone() };
    let channel = Channel::new(bending().backbone().clone(), vec![family], false).unwrap();
    let strains: Vec<f64> = (0..=40_000).map(|i| 2.4 * (f64::from(i) * 4e-4).sin()).collect();
    let responses: Vec<_> = channel.path(State::default(), strains).collect();
    let work: f64 = responses
        .windows(2)
        .map(|r| 0.5 * (r[0].stress + r[1].stress) * (r[1].state.strain - r[0].state.strain))
        .sum();
    let lost: f64 = responses.iter().map(|r| r.dissipation).sum();
    let stored = responses.last().unwrap().energy - responses[0].energy;
    assert_relative_eq!(work, stored + lost, max_relative = 1e-6);
}

#[test]
fn one_slider_is_coulomb_friction() {
    // M = B K +- 2HB/2, from B and 2HB alone.
    let (b, two_hb, slip) = (4.7e-6, 3.74e-4, 4.0);
    let slider = Slider { stiffness: 0.5 * two_hb / slip, slip };
    let family = Family { widening: Widening::Constant, sliders: vec![slider] };
    let channel = Channel::new(Backbone::line(b).unwrap(), vec![family], false).unwrap();
    let up = |from: i32, to: i32| (from..=to).map(|i| f64::from(i) * 0.5);
    let strains: Vec<f64> = up(0, 500).chain(up(-500, 500).rev()).chain(up(-500, 500)).collect();
    let loop_: Vec<_> = channel.path(State::default(), strains.iter().copied()).collect();
    let at = |strain: f64, nth: usize| {
        let mut found = loop_.iter().filter(|r| r.state.strain == strain);
        found.nth(nth).unwrap().stress
    };
    assert_relative_eq!((at(150.0, 0) - at(50.0, 0)) / 100.0, b, max_relative = 1e-12);
    assert_relative_eq!(at(100.0, 0) - at(100.0, 1), two_hb, max_relative = 1e-12);
    // Both sides, and the second outgoing branch as the first.
    assert_relative_eq!(at(-100.0, 1) - at(-100.0, 0), two_hb, max_relative = 1e-12);
    assert_relative_eq!(at(100.0, 2), at(100.0, 0), max_relative = 1e-12);
}

#[test]
fn the_virgin_curve_is_first_loading() {
    for (channel, range) in [(bending(), [-2.6, 2.6]), (tension(), [0.0, 0.085])] {
        for end in range {
            let n = 200_000;
            let strains = (1..=n).map(|i| end * f64::from(i) / f64::from(n));
            let scale = channel.backbone().at(range[1]).stress;
            let mut energy = 0.0;
            let mut last = (0.0, channel.virgin(0.0).stress);
            for (i, r) in channel.path(State::default(), strains).enumerate() {
                energy += 0.5 * (r.stress + last.1) * (r.state.strain - last.0);
                last = (r.state.strain, r.stress);
                if i % 997 == 0 {
                    // Frozen q lags by a step: first order in 1/n.
                    let virgin = channel.virgin(r.state.strain);
                    assert_relative_eq!(virgin.stress, r.stress, epsilon = 1e-5 * scale);
                    assert_relative_eq!(virgin.energy, energy, epsilon = 1e-5 * scale * range[1]);
                }
            }
        }
        for strain in random_path(3, range, 300) {
            let h = 1e-7 * range[1];
            let [low, here, high] = [strain - h, strain, strain + h].map(|e| channel.virgin(e));
            if (low.tangent - high.tangent).abs() < 1e-5 * here.tangent {
                assert_relative_eq!(
                    (high.stress - low.stress) / (2.0 * h),
                    here.tangent,
                    max_relative = 1e-6
                );
            }
        }
    }
}

#[test]
fn modes_without_friction_have_no_memory() {
    let channel = bending();
    let state = channel.trial(&State::default(), 1.0).state;
    let elastic = channel.respond(Mode::Elastic, &state, 0.5);
    assert_eq!(elastic.stress, channel.backbone().at(0.5).stress);
    assert_eq!((elastic.state.slip, elastic.state.strain), (state.slip, 0.5));
    assert_eq!(channel.respond(Mode::Virgin, &state, 0.5).stress, channel.virgin(0.5).stress);
    assert_eq!(channel.respond(Mode::Friction, &state, 0.5), channel.trial(&state, 0.5));
    let centred = channel.centred();
    assert_eq!(centred.respond(Mode::Elastic, &state, 0.0).stress, 0.0);
}

#[test]
fn a_one_sided_channel_never_pulls_back() {
    let channel = Channel::new(tension().backbone().clone(), tension().families().to_vec(), true).unwrap();
    let strains = (0..200).map(|i| 0.08 * (1.0 - f64::from(i) / 190.0).abs());
    let back: Vec<_> = channel.path(State::default(), strains).collect();
    assert!(back.iter().all(|r| r.stress >= 0.0));
    let slack = back.iter().find(|r| r.state.strain > 0.0 && r.stress == 0.0).unwrap();
    assert_eq!(slack.tangent, 0.0);
}

#[test]
fn a_law_survives_its_file() {
    for channel in [bending(), tension()] {
        let text = serde_json::to_string(&channel).unwrap();
        let read: Channel = serde_json::from_str(&text).unwrap();
        for e in random_path(1, [-0.05, 0.09], 50) {
            assert_relative_eq!(read.virgin(e).stress, channel.virgin(e).stress, max_relative = 1e-14);
        }
        assert_eq!(read.families(), channel.families());
    }
    let bad = r#"{"offset": 0.0, "knots": [0.0, 1.0], "tangents": [1.0, -1.0]}"#;
    assert!(serde_json::from_str::<Backbone>(bad).unwrap_err().to_string().contains("M020"));
}

#[test]
fn what_is_no_law_is_refused() {
    assert!(matches!(Backbone::new(0.0, &[], &[]), Err(LawError::Count { .. })));
    assert!(matches!(Backbone::new(0.0, &[1.0, 1.0], &[1.0, 1.0]), Err(LawError::Order { .. })));
    assert!(matches!(Backbone::line(f64::NAN), Err(LawError::Value { .. })));
    let too_large = Backbone::new(0.0, &[-1e200, 1e200], &[1.0, 1.0]);
    assert!(matches!(too_large, Err(LawError::Value { .. })), "{too_large:?}");
    let line = || Backbone::line(1.0).unwrap();
    let with = |widening, slider, count| {
        Channel::new(line(), vec![Family { widening, sliders: vec![slider; count] }], false)
    };
    let slider = Slider { stiffness: 1.0, slip: 0.1 };
    assert!(with(Widening::Constant, slider, MAX_SLIDERS).is_ok());
    let too_many = with(Widening::Constant, slider, MAX_SLIDERS + 1);
    assert!(matches!(too_many, Err(LawError::Sliders { count: 13 })));
    let negative = with(Widening::Constant, Slider { stiffness: -1.0, ..slider }, 1);
    assert!(matches!(negative, Err(LawError::Value { .. })));
    let steep = Widening::Quadratic { alpha: 6.0, e_max: 1.0 };
    assert!(matches!(with(steep, slider, 1), Err(LawError::Steep { .. })));
    let flat = Widening::Loading(Backbone::line(1.0).unwrap());
    assert!(with(flat, slider, 1).is_err(), "a loading curve must end above zero strain");
}
