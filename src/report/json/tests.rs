use super::*;
use nalgebra::{Matrix2, Matrix3};

use crate::characterise::Key;
use crate::constitutive::{Constitutive, Provenance, Used};
use crate::finding::EvaluationFact;
use crate::finding::Place;
use crate::instrument::Source;
use crate::section::ShellSection;
use serde_json::{Value, json};

#[test]
fn a_sheet_has_the_keys_of_the_contract_in_their_order() {
    let mut sheet = FabricSheet { name: "poplin".into(), ..FabricSheet::default() };
    let mut put = |parameter, direction, e| drop(sheet.values.insert(Key { parameter, direction }, e));
    put(Parameter::W, None, Estimate::single(0.15));
    let b = Estimate { mean: 5e-6, sd: Some(1e-7), n: 3, values: vec![] };
    put(Parameter::B, Some(Direction::Weft), Estimate::single(3e-6));
    put(Parameter::B, Some(Direction::Warp), b);
    put(Parameter::Lt, None, Estimate::single(f64::NAN));
    sheet.moduli.insert(("secant".into(), Direction::Warp), Estimate::single(9e3));
    let source = Source { path: "p/b.csv".into(), sha256: "00".into(), ..Source::default() };
    sheet.sources = vec![source.clone(), source];
    let (own, other) = (Direction::Warp, Direction::Weft);
    let fact = EvaluationFact::OtherDirection { parameter: Parameter::B, own, other, specimen: 2 };
    sheet.findings = vec![Finding::new(fact).at(Place::at("p/b.csv", 3, 0))];
    let text = text(&sheet_document([&sheet], Some(&Settings::default()))).unwrap();
    assert!(text.ends_with("}\n"));
    let v: Value = serde_json::from_str(&text).unwrap();
    let keys: Vec<&String> = v.as_object().unwrap().keys().collect();
    assert_eq!(keys, ["schema", "version", "inputs", "fabrics", "findings", "settings"]);
    assert_eq!(v["inputs"], json!([{ "path": "p/b.csv", "sha256": "00" }]));
    let parameters = &v["fabrics"][0]["parameters"];
    let symbols: Vec<&String> = parameters.as_object().unwrap().keys().collect();
    assert_eq!(symbols, ["LT", "B", "W"], "the order of sheets");
    let b = &parameters["B"]["warp"];
    assert_eq!((&b["mean"], &b["sd"], &b["n"]), (&json!(5e-6), &json!(1e-7), &json!(3)));
    assert_eq!(b["unit"], "N·m");
    assert!((b["cv"].as_f64().unwrap() - 0.02).abs() < 1e-15);
    // t(0.975, 2) = 4.30265273 (tables).
    assert!((b["ci95"].as_f64().unwrap() / (4.302_652_73e-7 / 3f64.sqrt()) - 1.0).abs() < 1e-7);
    assert_eq!(v["settings"]["G fitted over"], "0.5 deg .. 2.5 deg");
    assert_eq!(parameters["B"]["weft"]["sd"], Value::Null);
    assert_eq!(parameters["W"]["mean"], json!(0.15));
    assert_eq!(parameters["LT"]["fabric"]["mean"], Value::Null);
    assert_eq!(v["fabrics"][0]["moduli"]["secant"]["warp"]["mean"], json!(9e3));
    assert_eq!(v["findings"][0]["line"], json!(3));
    assert_eq!(
        v["findings"][0]["fields"],
        json!({ "parameter": "B", "own": "warp", "other": "weft", "specimen": 2 })
    );
}

#[test]
fn a_section_is_written_by_rows() {
    let section = ShellSection {
        d_m: Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0),
        d_b: Matrix3::identity(),
        d_s: Matrix2::new(1.0, 2.0, 3.0, 4.0),
        areal_density: 0.2,
        thickness: 4e-4,
    };
    let used = vec![Used {
        name: "poisson".into(),
        value: "geometric".into(),
        provenance: Provenance::Assumed,
        source: "assumed".into(),
    }];
    let made = Constitutive {
        section,
        law: None,
        used,
        inputs: Vec::new(),
        surface_friction: None,
        findings: Vec::new(),
    };
    let sheet = FabricSheet { name: "poplin".into(), ..Default::default() };
    let document = section_document([(&sheet, &made)]);
    let v = serde_json::to_value(&document).unwrap();
    assert_eq!(v["schema"], "kesf.section/1");
    assert_eq!(v["sections"][0]["d_m"], json!([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]));
    assert_eq!(v["sections"][0]["d_s"], json!([[1.0, 2.0], [3.0, 4.0]]));
    assert_eq!(v["sections"][0]["assumptions"]["poisson"]["value"], "geometric");
    assert_eq!(v["units"]["d_b"], "N·m");
}
