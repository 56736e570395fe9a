//! Goal: what a card does not hold is told.

use super::tests::{constitutive, section, sheet, written};
use super::*;
use crate::section::ShellSection;

/// What is left out is told with its size.
#[test]
fn what_has_no_place_is_told_with_its_size() {
    use crate::characterise::Key;
    use crate::instrument::{Direction, Parameter};
    use crate::quantity::Estimate;
    let made = constitutive(section());
    let mut sheet = sheet();
    for (parameter, direction, mean) in [
        (Parameter::Hb, Some(Direction::Warp), 3.25e-4),
        (Parameter::Hb, Some(Direction::Weft), 2.75e-4),
        (Parameter::Hg, None, 0.625),
    ] {
        sheet.values.insert(Key { parameter, direction }, Estimate::single(mean));
    }
    for target in EXPORTERS {
        let card = card(target, &CardInput { sheet: &sheet, made: &made, stamp: None, crimp: None }).unwrap();
        let messages: Vec<String> =
            card.findings.iter().filter(|f| f.code() == "O044").map(|f| f.message().to_string()).collect();
        for message in &messages {
            assert!(
                message.contains('(') && message.contains(char::is_numeric),
                "{}: {message}",
                target.name
            );
        }
        let says = |what: &str| messages.iter().any(|message| message.contains(what));
        // Only the open fabric file holds all.
        assert_eq!(messages.is_empty(), target.name == "fabric", "{}: {messages:?}", target.name);
        let with_friction = ["fabric", "u3m"].contains(&target.name);
        for hysteresis in ["2HB (3.250e-4 and 2.750e-4 N)", "2HG (0.6250 N/m)"] {
            assert_eq!(says(hysteresis), !with_friction, "{}: {messages:?}", target.name);
        }
        let own = match target.name {
            "kratos" => "transverse shear (50.00 and 45.00 N/m)",
            "opensees" => "mass per area (0.1180 kg/m²)",
            "u3m" => "shear stiffness (60.00 N/m)",
            _ => continue,
        };
        assert!(says(own), "{}: {messages:?}", target.name);
    }
}

/// The name of a property, and what changes it.
type Plant = (&'static str, fn(&mut ShellSection));

/// A stiffness, mass or thickness that makes no difference to a card is one that it leaves out, and is told.
#[test]
fn what_a_card_does_not_hold_is_told() {
    let plants: [Plant; 11] = [
        ("tensile stiffness", |s| s.d_m[(0, 0)] *= 1.25),
        ("tensile stiffness", |s| s.d_m[(1, 1)] *= 1.25),
        ("Poisson's ratio", |s| (s.d_m[(0, 1)], s.d_m[(1, 0)]) = (700.0, 700.0)),
        ("shear stiffness", |s| s.d_m[(2, 2)] *= 1.25),
        ("bending rigidity", |s| s.d_b[(0, 0)] *= 1.25),
        ("bending rigidity", |s| s.d_b[(1, 1)] *= 1.25),
        ("torsional rigidity", |s| s.d_b[(2, 2)] *= 1.25),
        ("transverse shear", |s| s.d_s[(0, 0)] *= 1.25),
        ("transverse shear", |s| s.d_s[(1, 1)] *= 1.25),
        ("mass per area", |s| s.areal_density *= 1.25),
        ("thickness", |s| s.thickness *= 1.25),
    ];
    let mut untold = Vec::new();
    for target in EXPORTERS {
        let made = constitutive(section());
        let own =
            card(target, &CardInput { sheet: &sheet(), made: &made, stamp: None, crimp: None }).unwrap();
        for (name, plant) in plants {
            let mut other = section();
            plant(&mut other);
            let is_told = own.findings.iter().any(|finding| finding.message().to_string().contains(name));
            let is_held = written(target.name, other).unwrap() != own.text;
            if !is_held && !is_told {
                untold.push(format!("{}: {name}", target.name));
            }
            // Of others a part may be told.
            assert!(name != "thickness" || is_held != is_told, "{}", target.name);
        }
    }
    assert!(untold.is_empty(), "{untold:#?}");
}
