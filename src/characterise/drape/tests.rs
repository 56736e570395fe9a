use std::f64::consts::{PI, TAU};

use super::*;
use crate::finding::Finding;
use approx::assert_relative_eq;

/// An outline in pixels: r (angle counter-clockwise) about a centre.
fn seen(r: impl Fn(f64) -> f64) -> SeenSheet {
    let point = |i: i32| {
        let t = TAU * f64::from(i) / 2000.0;
        [700.0 + r(t) * t.cos(), 600.0 - r(t) * t.sin()]
    };
    SeenSheet { outline: (0..2000).map(point).collect(), contrast: [0.5, 0.01], ..SeenSheet::default() }
}

fn setup() -> DrapeSetup {
    DrapeSetup { method: DrapeMethod::stated(0.18, 0.30), pixels_per_metre: Some(4000.0) }
}

fn codes(facts: Vec<DrapeFact>) -> Vec<&'static str> {
    facts.into_iter().map(|fact| Finding::new(fact).code()).collect()
}

#[test]
fn a_waved_circle_has_its_area_its_folds_and_its_harmonic() {
    let (mean, wave) = (480.0, 40.0);
    let (capture, facts) = measure(&seen(|t| mean + wave * (7.0 * (t - 0.1)).cos()), &setup(), None);
    // ½ ∫ r² = π (m² + a²/2), in closed form.
    let area = PI * (mean * mean + 0.5 * wave * wave) / 4000f64.powi(2);
    assert_relative_eq!(capture.area, area, max_relative = 1e-4);
    let expected = (area - PI * 0.0081) / (PI * 0.0225 - PI * 0.0081);
    assert_relative_eq!(capture.coefficient.unwrap(), expected, epsilon = 1e-4);
    assert_eq!((capture.folds, capture.harmonic, capture.folds_band), (7, 7, [7, 7]));
    assert_relative_eq!(capture.harmonics[7].amplitude, wave / 4000.0, max_relative = 1e-3);
    assert_relative_eq!(capture.harmonics[7].phase_deg, 0.1f64.to_degrees(), max_relative = 1e-3);
    assert_relative_eq!(capture.amplitude, wave / 4000.0, max_relative = 5e-3);
    assert!(facts.is_empty(), "{facts:?}");
}

/// The smoothing that folds are counted on takes nothing off their amplitude, however many there are.
#[test]
fn many_folds_keep_their_amplitude() {
    for folds in [3, 6, 10, 12] {
        let (capture, _) = measure(&seen(|t| 480.0 + 40.0 * (f64::from(folds) * t).cos()), &setup(), None);
        assert_eq!(capture.folds, folds as usize);
        assert_relative_eq!(capture.amplitude, 0.01, max_relative = 5e-3);
    }
}

#[test]
fn folds_are_maxima_and_a_strongest_harmonic_of_another_order_is_told() {
    let oval = |t: f64| 480.0 + 45.0 * (2.0 * t).cos() + 30.0 * (6.0 * t).cos();
    let (capture, facts) = measure(&seen(oval), &setup(), None);
    assert_eq!((capture.folds, capture.harmonic), (6, 2));
    assert_eq!(codes(facts), ["K057"]);
    let (round, _) = measure(&seen(|_| 590.0), &setup(), None);
    assert_eq!((round.folds, round.amplitude), (0, 0.0));
}

#[test]
fn the_disc_gives_the_scale_and_a_scale_that_contradicts_it_is_told() {
    let disc = SeenSheet { disc: Some(([700.0, 600.0], 360.0)), ..seen(|_| 480.0) };
    let own = DrapeSetup { pixels_per_metre: None, ..setup() };
    let (capture, facts) = measure(&disc, &own, None);
    assert_eq!(capture.scale.unwrap().source, ScaleSource::Disc);
    assert_relative_eq!(capture.scale.unwrap().pixels_per_metre, 4000.0, max_relative = 1e-12);
    assert!(facts.is_empty(), "{facts:?}");
    let (_, facts) = measure(&disc, &DrapeSetup { pixels_per_metre: Some(4400.0), ..setup() }, None);
    assert_eq!(codes(facts), ["K052"]);
    let (capture, facts) = measure(&seen(|_| 480.0), &own, None);
    assert_eq!((capture.coefficient, capture.unit), (None, "px".into()));
    assert_eq!(codes(facts), ["K050"]);
    let (capture, facts) = measure(&seen(|_| 480.0), &own, Some(4000.0));
    assert!(capture.coefficient.is_some());
    assert_eq!(codes(facts), ["K051"]);
}

#[test]
fn what_makes_a_picture_doubtful_is_told() {
    let doubtful =
        SeenSheet { others: vec![0.1, 0.3], at_border: 0.1, contrast: [0.03, 0.02], ..seen(|_| 700.0) };
    let (capture, facts) = measure(&doubtful, &setup(), None);
    assert!(capture.coefficient.unwrap() > 1.0);
    assert_eq!(codes(facts), ["K053", "K054", "K055", "K056"]);
    assert_eq!(capture.left_out_for, ["K054", "K056"]);
}

#[test]
fn captures_are_summed_up_by_test_and_side() {
    let capture = |test: &str, side: Option<ClothSide>, r: f64| DrapeCapture {
        test: test.into(),
        side,
        ..measure(&seen(|t| r + 30.0 * (5.0 * t).cos()), &setup(), None).0
    };
    let all = [
        capture("a", Some(ClothSide::Face), 470.0),
        capture("a", Some(ClothSide::Face), 480.0),
        capture("a", Some(ClothSide::Back), 500.0),
        capture("b", None, 500.0),
    ];
    let found = summaries(&all);
    let rows: Vec<_> = found.iter().map(|s| (s.test.as_str(), s.side, s.folds.map_or(0, |f| f.n))).collect();
    assert_eq!(
        rows,
        [("a", None, 3), ("a", Some(ClothSide::Face), 2), ("a", Some(ClothSide::Back), 1), ("b", None, 1)]
    );
    let results = drape_results(&found[0], &DrapeMethod::stated(0.18, 0.30));
    assert_eq!((results[0].quantity.as_str(), results[1].value.as_str()), ("drape_coefficient", "5.0"));
    assert!(results[0].method.contains("30 cm sheet on a disc of 18 cm; mean of 3 pictures"), "{results:?}");
    let cut_off = DrapeCapture { left_out_for: vec!["K054".into()], ..capture("a", None, 200.0) };
    let with_it = summaries(&[all[0].clone(), all[1].clone(), cut_off.clone()]);
    assert_eq!((with_it[0].left_out, with_it[0].coefficient), (1, found[1].coefficient));
    let results = drape_results(&with_it[0], &DrapeMethod::default());
    assert!(results[0].method.ends_with("points, 1 left out"), "{results:?}");
    let alone = summaries(&[cut_off]);
    assert!(alone[0].folds.is_none() && drape_results(&alone[0], &DrapeMethod::default()).is_empty());
    let mut copy = DrapeCapture { picture: "c.png".into(), ..all[0].clone() };
    assert_eq!(copy.mark_copy(&all[1..]), None);
    assert_eq!(codes(copy.mark_copy(&all).into_iter().collect()), ["K070"]);
    assert_eq!((copy.left_out_for, summaries(&all)[0].left_out), (vec!["K070".to_string()], 0));
    let mut elsewhere = DrapeCapture { test: "b".into(), ..all[0].clone() };
    assert!(elsewhere.mark_copy(&all).is_some() && elsewhere.left_out_for.is_empty());
    let mut again = elsewhere.clone();
    assert!(again.mark_copy(&[all[0].clone(), elsewhere]).is_some() && again.left_out_for == ["K070"]);
    assert_eq!(ClothSide::in_name("poplin-Face-2"), Some(ClothSide::Face));
    assert_eq!(ClothSide::in_name("poplin_2"), None);
}
