use super::*;

fn point(label: &str, law: Mode, simulated: f64, band: [f64; 2]) -> DrapePoint {
    let point = ParityPoint {
        label: label.into(),
        measured: 50.0,
        simulated,
        simulated_band: Some(band),
        ..ParityPoint::default()
    };
    DrapePoint { law, point }
}

#[test]
fn a_fabric_hung_both_ways_has_a_bracket() {
    let hung = [
        point("a", Mode::Elastic, 40.0, [39.0, 45.0]),
        point("b", Mode::Elastic, 60.0, [55.0, 61.0]),
        point("c", Mode::Elastic, 60.0, [55.0, 61.0]),
        point("b", Mode::Friction, 70.0, [52.0, 71.0]),
        point("a", Mode::Friction, 55.0, [48.0, 56.0]),
    ];
    let text = bracket(&hung).unwrap().text();
    let rows: Vec<&str> = text.lines().skip(1).map(str::trim_end).collect();
    assert_eq!(rows.len(), 2, "{text}");
    assert!(rows[0].starts_with("a ") && rows[0].ends_with("within"), "{text}");
    assert!(rows[0].contains("40.0 (39.0 to 45.0)") && rows[0].contains("55.0 (48.0 to 56.0)"), "{text}");
    assert!(rows[1].starts_with("b ") && rows[1].ends_with("below"), "{text}");
    assert!(bracket(&hung[..3]).is_none());
}
