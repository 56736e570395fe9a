//! Goal: frames of polars have what the tables have, and polars, which shares no code with our writer, reads the Parquet files.
//! Data: the shipped fabrics.

use std::path::Path;

use kesf::characterise::{Settings, characterise};
use kesf::instrument::read_fabrics;
use kesf::report::frame::frame;
use kesf::report::table::{FabricRow, ProblemRow, Row, UnitSystem, fabric_rows, parquet};
use polars::prelude::{ParquetReader, SerReader};

fn rows() -> Vec<FabricRow> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data");
    let batch = read_fabrics(&[data], &Default::default(), &|_| ());
    let sheets = batch.fabrics.iter().map(|fabric| characterise(fabric, &Settings::default()));
    sheets.flat_map(|sheet| fabric_rows(&sheet, UnitSystem::Si)).collect()
}

#[test]
fn polars_reads_the_parquet_file_as_the_frame() {
    let rows = rows();
    let read = ParquetReader::new(std::io::Cursor::new(parquet(&rows).unwrap())).finish().unwrap();
    let made = frame(&rows).unwrap();
    assert!(rows.len() > 100 && read.equals_missing(&made));
    assert_eq!(read.schema(), made.schema());
    let names: Vec<&str> = made.get_column_names().into_iter().map(|name| name.as_str()).collect();
    assert_eq!(names, FabricRow::HEADER);
}

#[test]
fn an_empty_table_keeps_its_columns() {
    let empty = frame::<ProblemRow>(&[]).unwrap();
    assert_eq!((empty.height(), empty.width()), (0, ProblemRow::HEADER.len()));
}
