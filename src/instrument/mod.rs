//! Laboratory files in, typed measurements in SI out.
//!
//! `raw` keeps every cell with its line and column, [`Dialect`]s know layouts as data, and `curves`
//! and `result_table` turn cells into [`Measurement`]s and [`ResultValue`]s. Nothing here computes a
//! parameter, and raw data are never altered beyond their units.

mod about;
mod abscissae;
mod across;
mod angle;
pub mod anonymise;
mod assembled;
mod axis;
mod blanks;
mod brackets_below;
mod branches;
mod browzwear;
mod caption;
mod cell;
mod cell_units;
mod code_page;
mod column_name;
mod column_values;
mod condition;
mod conditions;
mod content;
mod context;
mod continued;
mod contradictions;
mod curves;
mod dialect;
mod dos;
mod error;
pub mod fab;
mod fabric_file;
mod facets;
mod factor;
mod fast;
mod file_name;
mod folder;
mod header;
mod header_line;
mod header_value;
mod inference;
mod keyed_rows;
mod known_letters;
mod label;
mod layout;
mod letters;
mod limits;
mod lines;
mod marks;
mod means;
mod measurement;
mod number_format;
mod numbered;
mod ordinates;
mod over_columns;
mod own_results;
mod pages;
mod pairs;
mod passed_by;
#[cfg(feature = "pictures")]
pub mod picture;
mod raw;
mod read;
mod result_table;
mod row_kind;
mod row_names;
mod sample_cells;
mod samples;
mod section;
mod seen;
mod shape;
mod side_by_side;
mod slashed;
mod sniff;
mod specimen_size;
mod states;
mod statistic;
mod status_word;
mod stray;
mod suggest;
mod table_title;
mod unit_text;
mod unpacked;
mod value;
mod vocabulary;
mod volts;
mod web_page;
mod words;
mod workbook;
mod written_direction;

pub use crate::kes::{Direction, Parameter, Shape, Test};
pub use assembled::parse_fabrics;
pub use conditions::{StatedConditions, TestConditions, standard_conditions};
pub use content::{FileContent, ReadSettings};
pub use dialect::{BranchColumn, DIALECT_FILES, Dialect, HeaderKey, Role, Statistic, TableColumn, dialects};
pub use error::{About, ReadError, ReadProblem};
#[cfg(test)]
pub(crate) use fabric_file::FabricFile;
#[cfg(feature = "results")]
pub(crate) use fabric_file::is_drape_file;
pub use fabric_file::{DRAPE_FILE, read_dialect};
pub use file_name::is_data_name;
pub use folder::{FabricBatch, Library, read_fabrics};
pub use measurement::{
    Conditions, FabricInfo, FabricInput, Inference, MeasuredResult, Measurement, Origin, ResultValue, Source,
    StatedStiffness,
};
pub use own_results::{JOURNAL, MANIFEST};
pub use read::{parse, read};
pub use unpacked::unpacked;
