//! Goal: frames of polars have what the tables have. That polars reads our Parquet files, python/tests/test_library.py shows.
//! Data: the shipped fabrics. Reference: the cells of the CSV file, which share no code with the frames.

use std::path::Path;

use kesf::characterise::{Settings, characterise};
use kesf::instrument::read_fabrics;
use kesf::report::frame::frame;
use kesf::report::table::{FabricRow, ProblemRow, Row, UnitSystem, csv, fabric_rows};
use polars::prelude::{AnyValue, DataFrame, DataType};

fn rows() -> Vec<FabricRow> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data");
    let batch = read_fabrics(&[data], &Default::default(), &|_| ());
    let sheets = batch.fabrics.iter().map(|fabric| characterise(fabric, &Settings::default()));
    sheets.flat_map(|sheet| fabric_rows(&sheet, UnitSystem::Si)).collect()
}

/// Whether a value of a frame is what a cell says.
fn is_cell(value: &AnyValue<'_>, cell: &str) -> bool {
    match value {
        AnyValue::Null => cell.is_empty(),
        AnyValue::String(text) => *text == cell,
        AnyValue::Float64(number) => cell.parse() == Ok(*number),
        AnyValue::UInt64(count) => cell.parse() == Ok(*count),
        _ => false,
    }
}

#[test]
fn a_frame_has_the_cells_of_the_csv_file() {
    let rows = rows();
    let made: DataFrame = frame(&rows).unwrap();
    let file = csv(&rows).unwrap();
    let mut reader = ::csv::Reader::from_reader(file.as_slice());
    let names: Vec<&str> = made.get_column_names().into_iter().map(|name| name.as_str()).collect();
    assert_eq!(names, FabricRow::HEADER);
    assert_eq!(names, reader.headers().unwrap().iter().collect::<Vec<_>>());
    let cells: Vec<::csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert!(rows.len() > 100 && cells.len() == rows.len() && made.height() == rows.len());
    for (name, column) in names.iter().zip(made.columns()) {
        for (row, record) in cells.iter().enumerate() {
            let cell = &record[names.iter().position(|n| n == name).unwrap()];
            let value = column.get(row).unwrap();
            assert!(is_cell(&value, cell), "{name}, row {row}: {value:?} for {cell:?}");
        }
    }
    // The types of the Parquet file.
    for column in made.columns() {
        let expected = match column.name().as_str() {
            "mean" | "sd" | "cv" | "ci95" => DataType::Float64,
            "n" => DataType::UInt64,
            _ => DataType::String,
        };
        assert_eq!(*column.dtype(), expected, "{}", column.name());
    }
    assert!(made.columns().iter().any(|c| c.null_count() > 0));
}

#[test]
fn an_empty_table_keeps_its_columns() {
    let empty = frame::<ProblemRow>(&[]).unwrap();
    assert_eq!((empty.height(), empty.width()), (0, ProblemRow::HEADER.len()));
}
