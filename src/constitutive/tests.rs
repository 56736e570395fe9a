//! References: the closed forms of orthotropic plates; published table values with the exact
//! factor of the gram-force.

use super::*;
use crate::characterise::{Key, Modulus, ValueStatus};
use crate::instrument::Direction;
use crate::quantity::{ArealDensity, BendingRigidity, Estimate, Length, LineForce};
use approx::assert_relative_eq;

const WARP: Option<Direction> = Some(Direction::Warp);
const WEFT: Option<Direction> = Some(Direction::Weft);

fn sheet(values: &[(Parameter, Option<Direction>, f64)]) -> FabricSheet {
    let mut sheet = FabricSheet { name: "cloth".into(), ..Default::default() };
    for &(parameter, direction, value) in values {
        sheet.values.insert(Key { parameter, direction }, Estimate::single(value));
    }
    sheet
}

/// E 3000/1000 N/m (the pair of which one nu makes 989 against 330 N/m), B 8/4e-6 N·m.
fn cloth() -> FabricSheet {
    let mut cloth = sheet(&[
        (Parameter::B, WARP, 8e-6),
        (Parameter::B, WEFT, 4e-6),
        (Parameter::G, WARP, 50.0),
        (Parameter::G, WEFT, 54.0),
        (Parameter::T0, None, 5e-4),
        (Parameter::W, None, 0.15),
    ]);
    for (direction, e) in [(Direction::Warp, 3000.0), (Direction::Weft, 1000.0)] {
        cloth.moduli.insert(("tangent_low".into(), direction), Estimate::single(e));
    }
    cloth
}

fn codes(c: &Constitutive) -> Vec<&'static str> {
    c.findings.iter().map(|f| f.code()).collect()
}

#[test]
fn a_measured_cloth_gives_the_closed_forms_without_a_finding() {
    let c = section(&cloth(), &Assumptions::default()).unwrap();
    let s = &c.section;
    assert_relative_eq!(s.d_m[(0, 0)], 3000.0 / 0.91, max_relative = 1e-12);
    assert_relative_eq!(s.d_m[(1, 1)], 1000.0 / 0.91, max_relative = 1e-12);
    assert_relative_eq!(s.d_m[(0, 1)], 0.3 * 3e6_f64.sqrt() / 0.91, max_relative = 1e-12);
    assert_relative_eq!(s.d_m[(2, 2)], 52.0, max_relative = 1e-12);
    // No t³/12, no 1/(1-nu²): B is D11.
    assert_eq!((s.d_b[(0, 0)], s.d_b[(1, 1)], s.d_b[(0, 1)]), (8e-6, 4e-6, 0.0));
    assert_relative_eq!(s.d_b[(2, 2)], 32e-12_f64.sqrt() / 2.0, max_relative = 1e-12);
    assert_relative_eq!(s.d_s[(0, 0)], 52.0 * 5.0 / 6.0, max_relative = 1e-12);
    assert_eq!((s.areal_density, s.thickness), (0.15, 5e-4));
    assert_eq!(codes(&c), Vec::<&str>::new());
    let names: Vec<_> = c.used.iter().map(|u| &*u.name).collect();
    assert_eq!(names.len(), 9, "{names:?}");
}

/// F = G φ + W tan φ: what the tension adds to the slope is no stiffness of the cloth (KES-FB1: W = 10 gf/cm).
#[test]
fn the_share_of_the_tension_is_taken_off_the_shear_stiffness_on_request() {
    let assumptions = Assumptions { shear_tension: "10 gf/cm".parse().unwrap(), ..Assumptions::default() };
    let c = section(&cloth(), &assumptions).unwrap();
    assert_relative_eq!(c.section.d_m[(2, 2)], 52.0 - 9.80665, max_relative = 1e-12);
    let used = c.used.iter().find(|u| u.name == "shear stiffness G").unwrap();
    assert!(used.source.contains("less 9.807 N/m"), "{}", used.source);
    let of_warp = c.inputs.iter().find(|i| i.name == "G warp").unwrap();
    assert_relative_eq!(of_warp.derivative.d_m[(2, 2)], 25.0, max_relative = 1e-12);
    // A tension above the slope leaves nothing.
    let assumptions = Assumptions { shear_tension: LineForce(60.0), ..Assumptions::default() };
    assert_eq!(section(&cloth(), &assumptions).unwrap_err().code(), "C005");
}

#[test]
fn every_poisson_rule_keeps_the_matrix_symmetric() {
    let rule = |poisson_rule, poisson| {
        section(&cloth(), &Assumptions { poisson_rule, poisson, ..Default::default() })
    };
    // nu12 = 0.3, nu21 = 0.1: D12 = nu12 E2 / (1 - 0.03).
    let major = rule(PoissonRule::Major, 0.3).unwrap().section.d_m;
    assert_relative_eq!(major[(0, 1)], 300.0 / 0.97, max_relative = 1e-12);
    assert_eq!(major[(0, 1)], major[(1, 0)]);
    let zero = rule(PoissonRule::Zero, 0.3).unwrap().section.d_m;
    assert_eq!((zero[(0, 0)], zero[(0, 1)]), (3000.0, 0.0));
    // nu12² < E1/E2 = 3.
    assert!(rule(PoissonRule::Major, 1.7).is_ok());
    assert_eq!(rule(PoissonRule::Major, 1.74).unwrap_err().code(), "C006");
    assert_eq!(rule(PoissonRule::Geometric, 1.0).unwrap_err().code(), "C006");
    assert_eq!(rule(PoissonRule::Geometric, f64::NAN).unwrap_err().code(), "C006");
}

#[test]
fn torsion_from_the_bias_test_gives_the_bias_rigidity_back() {
    let mut cloth = cloth();
    let bias = Assumptions { torsion: Torsion::Bias, ..Default::default() };
    assert_eq!(section(&cloth, &bias).unwrap_err().code(), "C004");
    let key = Key { parameter: Parameter::B, direction: Some(Direction::Bias) };
    cloth.values.insert(key, Estimate::single(5e-6));
    let s = section(&cloth, &bias).unwrap().section;
    assert_relative_eq!(s.d_b[(2, 2)], 5e-6 - 3e-6, max_relative = 1e-12);
    let b45 = s.rotated(std::f64::consts::FRAC_PI_4).d_b[(0, 0)];
    assert_relative_eq!(b45, 5e-6, max_relative = 1e-12);
    cloth.values.insert(key, Estimate::single(2e-6));
    assert_eq!(section(&cloth, &bias).unwrap_err().code(), "C005");
}

#[test]
fn the_other_sources_of_torsion_and_coupling() {
    let with = |torsion, bending_coupling| {
        section(&cloth(), &Assumptions { torsion, bending_coupling, ..Default::default() })
    };
    let none = BendingCoupling::default();
    // G t²/12 = 52 · 25e-8 / 12.
    let s = with(Torsion::Shear, none).unwrap().section;
    assert_relative_eq!(s.d_b[(2, 2)], 52.0 * 25e-8 / 12.0, max_relative = 1e-12);
    let neglected = with(Torsion::Neglect, none).unwrap();
    assert_eq!(neglected.section.d_b[(2, 2)], 0.0);
    assert_eq!(codes(&neglected), ["C016"]);
    let s = with(Torsion::Huber, BendingCoupling::Poisson(0.2)).unwrap().section;
    let root = 32e-12_f64.sqrt();
    // A unit that slipped: a hundred times the geometric mean of the rigidities.
    let value = |times: f64| with(Torsion::Value(BendingRigidity(times * root)), none).unwrap();
    assert_eq!((codes(&value(101.0)), codes(&value(99.0))), (vec!["C019"], vec![]));
    assert!(value(101.0).findings[0].message().contains("101.0 times"));
    assert_relative_eq!(s.d_b[(0, 1)], 0.2 * root, max_relative = 1e-12);
    assert_relative_eq!(s.d_b[(0, 1)] + 2.0 * s.d_b[(2, 2)], root, max_relative = 1e-12);
    // D12 above √(B1 B2) releases energy.
    let h = Torsion::Value(BendingRigidity(1e-6));
    let error = with(h, BendingCoupling::Value(BendingRigidity(6e-6))).unwrap_err();
    assert_eq!(error.code(), "C003");
}

#[test]
fn without_a_tangent_the_secant_modulus_is_used_and_that_is_said() {
    let mut table = cloth();
    table.moduli.clear();
    for (direction, e) in [(Direction::Warp, 6000.0), (Direction::Weft, 2000.0)] {
        table.moduli.insert(("secant".into(), direction), Estimate::single(e));
    }
    let assumptions = Assumptions { poisson_rule: PoissonRule::Zero, ..Default::default() };
    let c = section(&table, &assumptions).unwrap();
    assert_eq!((c.section.d_m[(0, 0)], c.section.d_m[(1, 1)]), (6000.0, 2000.0));
    assert_eq!(codes(&c), ["C011"]);
    // A window is chosen on purpose: nothing replaces it.
    let modulus = Modulus::Window(LineForce(10.0), LineForce(40.0));
    let error = section(&table, &Assumptions { modulus, ..assumptions.clone() }).unwrap_err();
    assert_eq!(error.code(), "C004");
    for (direction, e) in [(Direction::Warp, 3000.0), (Direction::Weft, 1500.0)] {
        table.moduli.insert((modulus.name(), direction), Estimate::single(e));
    }
    let c = section(&table, &Assumptions { modulus, ..assumptions }).unwrap();
    assert_eq!((c.section.d_m[(0, 0)], c.section.d_m[(1, 1)]), (3000.0, 1500.0));
}

/// Matsudaira et al. 2015, fabric A: B 0.118 gf·cm²/cm, W 12.38 mg/cm², T 0.497 mm and nothing else.
#[test]
fn stand_ins_are_marked_and_do_not_touch_bending() {
    let b = 0.118 * 9.80665e-5;
    let mut table = sheet(&[(Parameter::B, None, b), (Parameter::W, None, 0.1238)]);
    table.info.thickness = Some(4.97e-4);
    let c = section(&table, &Assumptions::default()).unwrap();
    assert_relative_eq!(c.section.d_b[(0, 0)], b, max_relative = 1e-15);
    assert_relative_eq!(c.section.d_b[(1, 1)], b, max_relative = 1e-15);
    assert_eq!(c.section.thickness, 4.97e-4);
    assert_eq!(codes(&c), ["C013", "C012", "C010"]);
    assert!(c.used.iter().any(|u| u.name == "tensile modulus" && u.provenance == Provenance::Assumed));
}

/// Warp curves of FB1 and FB2 alone: what they give stands for the weft, and the section says so.
#[test]
fn one_direction_stands_for_both() {
    let mut warp = sheet(&[
        (Parameter::B, WARP, 8e-6),
        (Parameter::G, WARP, 50.0),
        (Parameter::T0, None, 5e-4),
        (Parameter::W, None, 0.15),
    ]);
    for (name, e) in [("tangent_low", 3000.0), ("secant", 4000.0)] {
        warp.moduli.insert((name.into(), Direction::Warp), Estimate::single(e));
    }
    let assumptions = Assumptions { poisson_rule: PoissonRule::Zero, ..Assumptions::default() };
    let c = section(&warp, &assumptions).unwrap();
    assert_eq!((c.section.d_m[(0, 0)], c.section.d_m[(1, 1)]), (3000.0, 3000.0));
    assert_eq!(codes(&c), ["C020", "C010"]);
    for name in ["tensile modulus", "bending rigidity"] {
        let used = c.used.iter().find(|u| u.name == name).unwrap();
        assert_eq!(used.provenance, Provenance::Assumed, "{}", used.source);
        assert!(
            used.source.ends_with("that of the warp stands for the weft, which is not known"),
            "{used:?}"
        );
    }
    // The weft has none of the repeats of the warp, and no band of theirs.
    let input = |name: &str| c.inputs.iter().find(|i| i.name == name).unwrap();
    for (symbol, modulus) in [("E", true), ("B", false)] {
        let [own, other] = ["warp", "weft"].map(|direction| input(&format!("{symbol} {direction}")));
        assert_eq!((own.status, own.estimate.n), (ValueStatus::Measured, 1));
        assert_eq!((other.status, other.estimate.n), (ValueStatus::Assumed, 0));
        let d = |i: &MeasuredInput| if modulus { i.derivative.d_m } else { i.derivative.d_b };
        assert!(d(own)[(0, 0)] > 0.0 && d(own)[(1, 1)] == 0.0 && d(other)[(1, 1)] > 0.0);
    }
    // The weft has another slope: both have that one, and nothing is made up.
    warp.moduli.insert(("secant".into(), Direction::Weft), Estimate::single(2000.0));
    let c = section(&warp, &assumptions).unwrap();
    assert_eq!((c.section.d_m[(0, 0)], c.section.d_m[(1, 1)]), (4000.0, 2000.0));
    let used = c.used.iter().find(|u| u.name == "tensile modulus").unwrap();
    assert_eq!(used.source, "measured: secant, because there is no tangent_low modulus of the weft");
    // Slopes of two kinds, each said.
    warp.moduli.remove(&("secant".into(), Direction::Warp));
    let c = section(&warp, &assumptions).unwrap();
    assert_eq!((c.section.d_m[(0, 0)], c.section.d_m[(1, 1)]), (3000.0, 2000.0));
    let said = c.findings.iter().find(|f| f.code() == "C011").unwrap().to_string();
    assert!(said.contains("no tangent_low modulus of the weft"), "{said}");
    // A window is a choice that nothing replaces.
    let window = Assumptions { modulus: Modulus::Window(LineForce(5.0), LineForce(20.0)), ..assumptions };
    assert_eq!(section(&warp, &window).unwrap_err().code(), "C004");
}

/// What a finding says against a value stands beside it where it is used.
#[test]
fn doubts_of_the_sheet_stand_in_the_sources() {
    let mut doubtful = cloth();
    let (b, e) =
        (Key { parameter: Parameter::B, direction: WEFT }, ("tangent_low".to_string(), Direction::Warp));
    doubtful.statuses.insert(b, ValueStatus::Doubtful);
    doubtful.modulus_statuses.insert(e, ValueStatus::Inferred);
    let c = section(&doubtful, &Assumptions::default()).unwrap();
    let source = |name: &str| c.used.iter().find(|u| u.name == name).map(|u| u.source.clone()).unwrap();
    assert_eq!(source("bending rigidity"), "measured: B of KES-FB2 is D11, D22; B weft is doubtful");
    assert_eq!(source("tensile modulus"), "inferred: tangent_low");
}

#[test]
fn what_cannot_be_assumed_is_an_error() {
    let assumptions = Assumptions::default();
    assert_eq!(section(&sheet(&[]), &assumptions).unwrap_err().code(), "C004");
    let error = section(&sheet(&[(Parameter::B, None, 1e-5)]), &assumptions).unwrap_err();
    assert!(error.to_string().contains("areal density"), "{error}");
    let mut bad = cloth();
    bad.values.insert(Key { parameter: Parameter::B, direction: WARP }, Estimate::single(-1e-6));
    assert_eq!(section(&bad, &assumptions).unwrap_err().code(), "C005");
}

#[test]
fn what_is_stated_and_not_used_is_told() {
    let told = |sheet: &FabricSheet, assumptions: Assumptions| codes(&section(sheet, &assumptions).unwrap());
    let sheet = cloth();
    let before = told(&sheet, Assumptions::default());
    let with = |change: fn(&mut Assumptions)| {
        let mut assumptions = Assumptions::default();
        change(&mut assumptions);
        let mut codes = told(&sheet, assumptions);
        codes.retain(|code| !before.contains(code));
        codes
    };
    assert_eq!(with(|a| a.thickness = Length(1e-3)), ["C022"]);
    assert_eq!(with(|a| a.areal_density = Some(ArealDensity(0.5))), ["C022"]);
    assert_eq!(with(|a| a.shear = LineForce(1.0)), ["C022"]);
    assert_eq!(with(|a| a.tensile = LineForce(1.0)), ["C022"]);
    assert_eq!(with(|a| (a.poisson, a.poisson_rule) = (0.2, PoissonRule::Zero)), ["C023"]);
    assert!(with(|a| a.poisson_rule = PoissonRule::Zero).is_empty());
    let mut unlike = cloth();
    unlike.moduli.insert(("tangent_low".into(), Direction::Warp), Estimate::single(60_000.0));
    unlike.moduli.insert(("tangent_low".into(), Direction::Weft), Estimate::single(1000.0));
    assert!(told(&unlike, Assumptions::default()).contains(&"C024"));
    // What stands in is used, and nothing is left over.
    let bare = self::sheet(&[(Parameter::B, None, 1e-5)]);
    let used = Assumptions {
        thickness: Length(1e-3),
        areal_density: Some(ArealDensity(0.5)),
        shear: LineForce(1.0),
        tensile: LineForce(1000.0),
        ..Assumptions::default()
    };
    assert!(!told(&bare, used).contains(&"C022"));
}

#[test]
fn what_no_weight_acts_on_needs_no_areal_density() {
    let bare = self::sheet(&[(Parameter::B, None, 1e-5)]);
    assert_eq!(section(&bare, &Assumptions::default()).unwrap_err().code(), "C004");
    let made = section_without_mass(&bare, &Assumptions::default()).unwrap();
    assert_eq!(made.section.areal_density, 0.0);
    let used = made.used.iter().find(|used| used.name == "areal density").unwrap();
    assert_eq!(used.provenance, Provenance::Assumed);
    let cloth = cloth();
    let both = [section, section_without_mass].map(|of| of(&cloth, &Assumptions::default()).unwrap());
    assert_eq!(both[0], both[1]);
}
