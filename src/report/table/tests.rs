use super::*;
use crate::characterise::Key;

fn sheet() -> FabricSheet {
    let mut sheet = FabricSheet { name: "poplin, \"A\"".into(), ..FabricSheet::default() };
    let b = Estimate { mean: 9.80665e-6, sd: Some(9.80665e-8), n: 3, values: vec![] };
    sheet.values.insert(Key { parameter: Parameter::B, direction: Some(Direction::Warp) }, b);
    sheet.values.insert(Key { parameter: Parameter::T0, direction: None }, Estimate::single(4e-4));
    sheet
}

#[test]
fn fabrics_as_csv() {
    // B: 9.80665e-6 N·m is 0.1 gf·cm²/cm.
    let text = String::from_utf8(csv(&fabric_rows(&sheet(), UnitSystem::Kes)).unwrap()).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("fabric,parameter,direction,mean,sd,n,unit,status,cv,ci95,origin"));
    let b = lines.next().unwrap();
    // t(0.975, 2) = 4.30265272991 (tables): 0.001 t / √3.
    let (values, half) = b.strip_suffix(",measured").unwrap().rsplit_once(',').unwrap();
    assert_eq!(values, "\"poplin, \"\"A\"\"\",B,warp,0.1,0.001,3,gf·cm²/cm,measured,0.01");
    assert!((half.parse::<f64>().unwrap() / 0.002_484_137_711_8 - 1.0).abs() < 1e-10);
    assert!(lines.next().unwrap().ends_with(",T0,,0.4,,1,mm,measured,,,measured"));
    let si = String::from_utf8(csv(&fabric_rows(&sheet(), UnitSystem::Si)).unwrap()).unwrap();
    assert!(si.contains(",B,warp,9.80665e-6,9.80665e-8,3,N·m,measured"), "{si}");
}

#[test]
fn the_columns_of_rows_are_their_cells() {
    let mut rows = fabric_rows(&sheet(), UnitSystem::Si);
    rows.push(failed_fabric_row("bad", "R004"));
    let columns: Vec<_> = FabricRow::HEADER.iter().copied().zip(FabricRow::values(&rows)).collect();
    assert_eq!(columns[1].0, "parameter");
    assert_eq!(columns[1].1, Values::Text(["B", "T0", ""].map(|t| Some(t.to_string())).to_vec()));
    assert_eq!(columns[3], ("mean", Values::Number(vec![Some(9.80665e-6), Some(4e-4), None])));
    assert_eq!(columns[5], ("n", Values::Count(vec![Some(3), Some(1), Some(0)])));
    assert_eq!(FabricRow::values(&[])[2], Values::Text(Vec::new()), "an empty column keeps its type");
}

#[test]
fn no_text_is_a_formula_and_numbers_stay_numbers() {
    for name in
        ["=cmd|' /C calc'!A0", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "＝1", "＋1", "－1", "＠SUM(A1)"]
    {
        let row = FabricRow { fabric: name.into(), mean: Some(-1.5), ..FabricRow::default() };
        let bytes = csv(&[row]).unwrap();
        let mut reader = csv::ReaderBuilder::new().from_reader(&bytes[..]);
        let cells = reader.records().next().unwrap().unwrap();
        assert_eq!((&cells[0], &cells[3]), (format!("'{name}").as_str(), "-1.5"));
    }
    let plain = FabricRow { fabric: "a=b".into(), ..FabricRow::default() };
    assert!(String::from_utf8(csv(&[plain]).unwrap()).unwrap().contains("\na=b,"));
}

#[test]
fn an_empty_table_keeps_its_header() {
    assert_eq!(csv::<ProblemRow>(&[]).unwrap(), b"place,code,message,fabric,hint\n");
}

#[test]
fn units_of_curves_are_known_and_belong_together() {
    for test in Test::ALL {
        let kes = curve_units(test, UnitSystem::Kes);
        for (axis, (name, factor)) in curve_units(test, UnitSystem::Si).into_iter().enumerate() {
            assert_eq!(factor, 1.0, "{name}");
            let dimension = |u: &str| crate::quantity::Unit::parse(u).unwrap().dimension;
            assert_eq!(dimension(name), dimension(kes[axis].0), "{test:?}");
        }
    }
    assert_eq!(relative_error(1.1, 0.0), None);
    assert!((relative_error(1.1, 1.0).unwrap() - 0.1).abs() < 1e-12);
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_reads_back_to_the_same_table() {
    use crate::report::arrow::{batch, read};
    let mut rows = fabric_rows(&sheet(), UnitSystem::Si);
    rows.push(failed_fabric_row("bad", "R004"));
    let bytes = parquet(&rows).unwrap();
    assert_eq!(bytes, parquet(&rows).unwrap(), "same rows, same bytes");
    assert_eq!(read(bytes.into()).unwrap().1, batch(&rows).unwrap());
    assert!(parquet::<ProblemRow>(&[]).is_ok(), "an empty table is a table");
}
