//! FAB strips: stiffness from the onset of load, cycle by cycle.

use std::collections::BTreeMap;

use serde::Serialize;

use super::graph::{Graph, LineFit};
use super::{Branch, FabricSheet, Key, Modulus, Settings, strip_bending};
use crate::finding::{EvaluationFact, Finding, Place, StripLength, Subject};
use crate::instrument::fab::{Contact, FabFile, FabKind, FabTest};
use crate::instrument::{Direction, Parameter};
use crate::quantity::{Curve, Estimate};

/// A stretch test of a strip after processing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StripTest {
    /// Direction of the strip.
    pub direction: Direction,
    /// Which test: short or long clamp distance.
    pub kind: FabKind,
    /// Width (m).
    pub width: f64,
    /// The cycles, in order.
    pub cycles: Vec<StripCycle>,
}

/// One cycle of a stretch test. Strain counts from the cycle's own onset of load.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StripCycle {
    /// Clamp distance at which the strip begins to carry load (m); the gauge length of the cycle.
    pub onset: f64,
    /// Travel from the first sample to the onset: slack (m).
    pub slack: f64,
    /// Growth of the onset since the first cycle over its onset: residual strain.
    pub residual: f64,
    /// Zero of the load, taken off (N/m).
    pub offset: f64,
    /// Loading and unloading branch: strain and force per width (N/m).
    pub branches: Vec<Branch>,
    /// Stiffness (N/m) by the name of [`Modulus`]. Tangents are the slopes between the ends of
    /// their window: few samples, unevenly spread over a J curve, would pull a fitted line to one end.
    pub moduli: BTreeMap<String, f64>,
    /// The lines behind the tangents, with the fitted slope, R² and n.
    pub fits: Vec<LineFit>,
}

/// Adds what FAB files tell to the sheet, where no KES record or table does.
pub(super) fn add(sheet: &mut FabricSheet, files: &[FabFile], settings: &Settings) {
    let Some(first) = files.first() else { return };
    let place = Place::file(&first.source.path);
    sheet.strips = (files.iter().flat_map(|f| &f.tests))
        .filter(|t| t.kind.is_stretch())
        .filter_map(|t| {
            let strip = stretch(t, settings);
            if strip.is_none() {
                let subject = Subject::Strip { strip: t.kind.name().into(), direction: t.direction };
                let fact = EvaluationFact::NotEvaluated { subject, reason: "it never carries load".into() };
                sheet.findings.push(Finding::new(fact).at(place.clone()));
            }
            strip
        })
        .collect();
    sheet.bend_tests =
        (files.iter().flat_map(|f| &f.tests)).filter(|t| !t.kind.is_stretch()).cloned().collect();
    stiffness(sheet, files, settings, &place);
    shear(sheet, settings, &place);
    let whole = |parameter| Key { parameter, direction: None };
    let masses: Vec<f64> = files.iter().filter_map(|f| f.areal_density).collect();
    if let Some(w) = Estimate::of(&masses) {
        sheet.values.entry(whole(Parameter::W)).or_insert(w);
    }
    strip_bending::add(sheet, files, settings, &place);
    // A thickness that the user states goes before it.
    if !sheet.values.contains_key(&whole(Parameter::T0)) && sheet.info.thickness.is_none() {
        thickness(sheet, files);
    }
}

/// Part of the force of the first contact within which another is its repeat.
const SAME_FORCE: f64 = 0.05;

/// Difference from which the thickness of the instrument's program is another one.
const SAME_THICKNESS: f64 = 0.05;

/// T0 where the foot first touches on loading, at the force of the first contact: branches that begin at another force are
/// no repeats of it, and on unloading the cloth is still compressed.
fn thickness(sheet: &mut FabricSheet, files: &[FabFile]) {
    let contacts = files.iter().flat_map(|f| &f.contacts);
    let Some(force) = contacts.clone().next().map(|c| c.force) else { return };
    let is_repeat = |c: &&Contact| (c.force - force).abs() <= SAME_FORCE * force.abs();
    let repeats: Vec<f64> = contacts.filter(is_repeat).map(|c| c.thickness).collect();
    let Some(t) = Estimate::of(&repeats) else { return };
    let place = files.first().map(|f| Place::file(&f.source.path));
    let mut found =
        |fact: EvaluationFact| sheet.findings.push(Finding { place: place.clone(), fact: fact.into() });
    found(EvaluationFact::FabThickness { thickness: t.mean, contacts: t.n, force });
    let program = files.iter().find_map(|f| f.program_thickness);
    if let Some(program) = program.filter(|p| (p / t.mean - 1.0).abs() > SAME_THICKNESS) {
        found(EvaluationFact::OtherThickness { thickness: t.mean, program });
    }
    sheet.values.insert(Key { parameter: Parameter::T0, direction: None }, t);
}

/// The cycles of a stretch test; `None` if the first never carries load.
fn stretch(test: &FabTest, settings: &Settings) -> Option<StripTest> {
    let mut cycles: Vec<StripCycle> = Vec::new();
    for (i, pair) in test.branches.chunks(2).enumerate() {
        let first_onset = cycles.first().map(|c| c.onset);
        match cycle(i, pair, test.width, first_onset, settings) {
            Some(cycle) => cycles.push(cycle),
            None => break,
        }
    }
    (!cycles.is_empty()).then_some(StripTest {
        direction: test.direction,
        kind: test.kind,
        width: test.width,
        cycles,
    })
}

fn cycle(
    index: usize,
    pair: &[Curve],
    width: f64,
    first_onset: Option<f64>,
    settings: &Settings,
) -> Option<StripCycle> {
    let load = pair.first()?;
    // The zero of the load differs from test to test; the first samples are taken on the slack strip.
    let mut rest: Vec<f64> = load.y.iter().take(5).copied().collect();
    rest.sort_by(f64::total_cmp);
    let zero = *rest.get(rest.len() / 2)?;
    let per_width = |c: &Curve| Curve::from_points(c.points().map(|(d, f)| (d, (f - zero) / width)));
    let onset = Graph::of(&per_width(load)).first_rise_to(settings.strip_onset.si()).filter(|d| *d > 0.0)?;
    let strained = |c: &Curve| Curve::from_points(per_width(c).points().map(|(d, f)| (d / onset - 1.0, f)));
    let branches: Vec<Branch> = (pair.iter().enumerate())
        .map(|(k, c)| Branch { cycle: index, outgoing: k == 0, curve: strained(c) })
        .collect();
    let graph = Graph::of(&branches[0].curve);
    let (mut moduli, mut fits) = (BTreeMap::new(), Vec::new());
    let windows = settings.strip_windows.iter().map(|[a, b]| Modulus::Window(*a, *b));
    for modulus in [Modulus::TangentLow].into_iter().chain(windows) {
        let [low, high] = match modulus {
            Modulus::Window(low, high) => [low, high],
            _ => settings.tangent_low,
        };
        if let Some(fit) = graph.fit_between_ordinates(&modulus.name(), low.si(), high.si()) {
            moduli.insert(modulus.name(), fit.two_point);
            fits.push(fit);
        }
    }
    if let Some(strain) = graph.first_rise_to(settings.strip_secant.si()).filter(|e| *e > 0.0) {
        moduli.insert(Modulus::Secant.name(), settings.strip_secant.si() / strain);
    }
    let residual = first_onset.map_or(0.0, |first| onset / first - 1.0);
    let slack = onset - load.x.first()?;
    Some(StripCycle { onset, slack, residual, offset: zero / width, branches, moduli, fits })
}

/// The strips of a direction and a kind.
fn strips_of_kind(strips: &[StripTest], direction: Direction, kind: FabKind) -> Vec<&StripTest> {
    strips.iter().filter(|s| s.direction == direction && s.kind == kind).collect()
}

/// Moduli of the long strips (short ones where there is no other), last cycle.
fn stiffness(sheet: &mut FabricSheet, files: &[FabFile], settings: &Settings, place: &Place) {
    let mut lengths: Vec<StripLength> = Vec::new();
    for direction in Direction::ALL {
        if sheet.moduli.keys().any(|(_, d)| *d == direction) {
            continue;
        }
        let mut strips = strips_of_kind(&sheet.strips, direction, FabKind::S2);
        if strips.is_empty() {
            strips = strips_of_kind(&sheet.strips, direction, FabKind::S1);
        }
        let last: Vec<&StripCycle> = strips.iter().filter_map(|s| s.cycles.last()).collect();
        let Some(shown) = last.first() else { continue };
        lengths.push(StripLength { direction, length: shown.onset, cycle: strips[0].cycles.len() });
        let mut names: Vec<&String> = last.iter().flat_map(|c| c.moduli.keys()).collect();
        names.sort();
        names.dedup();
        let estimates: Vec<_> = (names.into_iter())
            .filter_map(|name| {
                let values: Vec<f64> = last.iter().filter_map(|c| c.moduli.get(name).copied()).collect();
                Some(((name.clone(), direction), Estimate::of(&values)?))
            })
            .collect();
        sheet.moduli.extend(estimates);
    }
    if lengths.is_empty() {
        return;
    }
    let warnings = files.iter().flat_map(|f| &f.warnings).cloned().collect();
    let secant = settings.strip_secant.si();
    let fact = EvaluationFact::ModuliOfStrips { strips: lengths, secant, warnings };
    sheet.findings.push(Finding::new(fact).at(place.clone()));
}

/// G from the long bias strip, last cycle: the strip shears by twice its strain under half its force
/// per width, so G = F/(4 ε); with strain in per cent at 5 gf/cm that is G = 123/EB5 N/m of FAST.
/// Force and strain count from the onset of load. Short strips are held by their clamps.
fn shear(sheet: &mut FabricSheet, settings: &Settings, place: &Place) {
    let key = Key { parameter: Parameter::G, direction: None };
    let known = sheet.values.keys().any(|k| k.parameter == Parameter::G);
    let of_cycle = |cycle: &StripCycle| {
        let load = Graph::of(&cycle.branches.first()?.curve);
        let strain = load.first_rise_to(settings.strip_shear.si()).filter(|e| *e > 0.0)?;
        Some((settings.strip_shear.si() - settings.strip_onset.si()) / (4.0 * strain))
    };
    let bias = |s: &&StripTest| s.direction == Direction::Bias && s.kind == FabKind::S2;
    let strips: Vec<&StripTest> = sheet.strips.iter().filter(bias).collect();
    let ends: Vec<[f64; 2]> = (strips.iter())
        .filter_map(|s| Some([of_cycle(s.cycles.first()?)?, of_cycle(s.cycles.last()?)?]))
        .collect();
    let last: Vec<f64> = ends.iter().map(|e| e[1]).collect();
    let (Some(estimate), [[first, _], ..], false) = (Estimate::of(&last), &ends[..], known) else { return };
    let slenderness = strips[0].cycles[0].onset / strips[0].width;
    let (force, last) = (settings.strip_shear.si(), estimate.mean);
    let fact = EvaluationFact::BiasStrip { force, last, first: *first, slenderness };
    sheet.findings.push(Finding::new(fact).at(place.clone()));
    sheet.values.insert(key, estimate);
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn test_of(kind: FabKind, branches: Vec<Curve>) -> FabTest {
        FabTest { direction: Direction::Warp, kind, length: 0.02, width: 0.05, branches }
    }

    /// 1 mm of slack, an offset of -20 mN and 2000 N/m over the length at the onset.
    #[test]
    fn slack_and_offset_do_not_enter_the_stiffness() {
        let force = |d: f64| -0.02 + 0.05 * 2000.0 * (d - 0.021).max(0.0) / 0.021;
        let curve = Curve::from_points((0..=200).map(|i| 0.02 + 2e-5 * f64::from(i)).map(|d| (d, force(d))));
        let strip = stretch(&test_of(FabKind::S1, vec![curve]), &Settings::default()).unwrap();
        let cycle = &strip.cycles[0];
        assert_relative_eq!(cycle.offset, -0.4, max_relative = 1e-12);
        // The onset is where the load passes 1 gf/cm, 0.05 % of strain late.
        assert_relative_eq!(cycle.onset, 0.021 * (1.0 + 0.980665 / 2000.0), max_relative = 1e-12);
        assert_relative_eq!(cycle.moduli["tangent_low"], 2000.0, max_relative = 1e-3);
    }

    /// A bias strip of G = 30 N/m extends by F/(4 G): FAST's 123/EB5, with EB5 in per cent at 5 gf/cm.
    #[test]
    fn a_bias_strip_gives_its_shear_stiffness() {
        let force = |d: f64| 0.05 * 4.0 * 30.0 * (d / 0.08 - 1.0).max(0.0);
        let curve = Curve::from_points((0..=200).map(|i| 0.079 + 1e-4 * f64::from(i)).map(|d| (d, force(d))));
        let test = FabTest { direction: Direction::Bias, length: 0.08, ..test_of(FabKind::S2, vec![curve]) };
        let mut sheet = FabricSheet::default();
        add(&mut sheet, &[FabFile { tests: vec![test], ..FabFile::default() }], &Settings::default());
        let g = sheet.get(Parameter::G, None).unwrap().mean;
        // Strain counts from the length at 1 gf/cm, which is 0.8 % longer.
        assert_relative_eq!(g, 30.0 * (1.0 + 0.980665 / 120.0), max_relative = 1e-9);
        let eb5 = 100.0 * 5.0 * 0.980665 / 120.0;
        assert_relative_eq!(123.0 / eb5, 30.0, max_relative = 5e-3);
        assert!(sheet.findings.iter().any(|f| f.code() == "K033"));
    }

    #[test]
    fn a_strip_without_load_is_left_out() {
        let flat = Curve::from_points((0..20).map(|i| (0.02 + 1e-4 * f64::from(i), 0.0)));
        assert_eq!(stretch(&test_of(FabKind::S2, vec![flat]), &Settings::default()), None);
    }
}
