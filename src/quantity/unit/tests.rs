//! Factors of units by their definitions, and what is refused.

use super::super::{ArealDensity, BendingRigidity, Length, LineForce, Ratio};
use super::*;
use approx::assert_relative_eq;

fn factor(text: &str) -> f64 {
    Unit::parse(text).unwrap().factor
}

#[test]
fn kes_units_have_their_exact_factors() {
    // 1 gf = 9.80665e-3 N exactly.
    assert_relative_eq!(factor("gf/cm"), 0.980665, max_relative = 1e-15);
    assert_relative_eq!(factor("gf·cm/cm²"), 0.980665, max_relative = 1e-15);
    assert_relative_eq!(factor("gf cm2/cm"), 9.80665e-5, max_relative = 1e-15);
    assert_relative_eq!(factor("gf/(cm·deg)"), 56.187_965_62, max_relative = 1e-9);
    assert_relative_eq!(factor("gf/cm/deg"), factor("gf/(cm deg)"), max_relative = 1e-15);
    assert_relative_eq!(factor("gf/cm²"), 98.0665, max_relative = 1e-15);
    assert_relative_eq!(factor("mg/cm2"), 0.01, max_relative = 1e-15);
    assert_relative_eq!(factor("cm⁻¹"), 100.0, max_relative = 1e-15);
    assert_relative_eq!(factor("ｇｆ/㎝"), 0.980665, max_relative = 1e-15);
    assert_relative_eq!(factor("µN·m"), 1e-6, max_relative = 1e-15);
}

/// `in` is a length where one can stand, and else the word before a unit.
#[test]
fn inches_and_the_word_in() {
    assert_relative_eq!(factor("in"), 0.0254);
    assert_relative_eq!(factor("in²"), 6.4516e-4, max_relative = 1e-14);
    assert_relative_eq!(factor("1/in"), 1.0 / 0.0254, max_relative = 1e-14);
    assert_relative_eq!(factor("lbf.in2/in"), 4.4482216152605 * 0.0254, max_relative = 1e-14);
    assert_relative_eq!(factor("lbf in/in"), 4.4482216152605, max_relative = 1e-14);
    assert_relative_eq!(factor("in·lbf"), 4.4482216152605 * 0.0254, max_relative = 1e-14);
    for text in ["in gf/cm", "in gf", "in mm", "in %", "(in mm)"] {
        assert!(Unit::parse(text).is_err(), "{text}");
    }
}

#[test]
fn brackets_have_powers() {
    assert!(Unit::parse(&format!("{}mm{}", "(".repeat(16), ")".repeat(16))).is_ok());
    assert!(Unit::parse(&"(".repeat(1_000_000)).is_err());
    assert_relative_eq!(factor("gf·(cm·(°))-1"), factor("gf/(cm·deg)"), max_relative = 1e-14);
    assert_relative_eq!(factor("gf·(cm²)^-1"), factor("gf/cm²"), max_relative = 1e-14);
    assert!(divides_by_length("gf·cm²·(cm)-1") && !divides_by_length("N·(m)"));
}

#[test]
fn angles_are_told_from_turns() {
    assert!(["6.28 rad/s", "360 deg/s", "360 °/s", "1 ㎭/s"].into_iter().all(counts_angles));
    assert!(["1 Hz", "1 1/s", "60 1/min"].into_iter().all(|text| !counts_angles(text)));
}

/// Rigidities and moments per width divide by a length, in every spelling; moments do not.
#[test]
fn what_divides_by_a_length_is_told_from_what_does_not() {
    for text in [
        "gf·cm²/cm",
        "gf cm2/cm",
        "gf.cm.cm/cm",
        "(gf·cm^2)/cm",
        "gf·cm²·cm⁻¹",
        "gf·cm2/(cm)",
        "uN m2/m",
        "ｇｆ・㎝²/㎝",
        "gf/(cm·deg)",
        "N/(1/m)/m2",
    ] {
        assert!(divides_by_length(text), "{text}");
    }
    for text in ["gf·cm", "N·m", "mN·m", "kg·m²/s²", "g mm2/s2", "N/(1/m)", "J", "furlong/cm"] {
        assert!(!divides_by_length(text), "{text}");
    }
}

#[test]
fn a_quotient_that_two_people_read_differently_is_refused() {
    assert!(matches!(Unit::parse("gf/cm·deg"), Err(QuantityError::Ambiguous { .. })));
    assert!(matches!(Unit::parse("furlong"), Err(QuantityError::UnknownUnit { .. })));
    assert!(matches!(Unit::parse(""), Err(QuantityError::UnknownUnit { .. })));
}

#[test]
fn quantities_need_their_unit_and_dimension() {
    assert_relative_eq!("20 cm".parse::<Length>().unwrap().si(), 0.2, max_relative = 1e-15);
    assert_relative_eq!("1e-1m".parse::<Length>().unwrap().si(), 0.1);
    assert_relative_eq!("150 g/m²".parse::<ArealDensity>().unwrap().si(), 0.15, max_relative = 1e-15);
    assert_relative_eq!("5 %".parse::<Ratio>().unwrap().si(), 0.05);
    assert!(matches!("20".parse::<Length>(), Err(QuantityError::NoUnit { .. })));
    assert!(matches!("cm".parse::<Length>(), Err(QuantityError::NoNumber { .. })));
    assert!(matches!("2,5 cm".parse::<Length>(), Err(QuantityError::NoNumber { .. })));
    assert!(matches!("20 g".parse::<LineForce>(), Err(QuantityError::Dimension { .. })));
    assert_relative_eq!(
        "0.1 gf·cm²/cm".parse::<BendingRigidity>().unwrap().si(),
        9.80665e-6,
        max_relative = 1e-14
    );
}

#[test]
fn a_bare_number_in_a_settings_file_says_what_to_write() {
    #[derive(Debug, serde::Deserialize)]
    struct Sheet {
        #[allow(dead_code)]
        width: Length,
    }
    let error = toml::from_str::<Sheet>("width = 20").unwrap_err().to_string();
    assert!(error.contains("\"20 cm\""), "{error}");
    let error = toml::from_str::<Sheet>("width = true").unwrap_err().to_string();
    assert!(error.contains("expected a quantity in quotes, such as \"20 cm\""), "{error}");
    let error = toml::from_str::<Sheet>("").unwrap_err().to_string();
    assert!(error.contains("missing field `width`"), "{error}");
}
