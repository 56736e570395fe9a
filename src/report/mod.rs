//! Everything that people see as files: charts, tables, JSON, VTU, a page, and how they are put in place.
//!
//! The makers are pure: they return bytes, the same for the same data. [`mod@write`] is the only part that
//! touches the disk.

#[cfg(feature = "parquet")]
pub mod arrow;
#[cfg(feature = "parquet")]
pub mod arrow_text;
pub mod cards;
mod file_list;
#[cfg(feature = "polars")]
pub mod frame;
#[cfg(feature = "results")]
pub mod gltf;
pub mod html;
pub mod json;
mod output_folder;
pub mod population;
pub mod read_back;
pub mod table;
mod table_stream;
pub mod vtu;
#[cfg(feature = "workbook")]
pub mod workbook;
pub mod write;

// Charts need all of it, the page a part.
#[cfg_attr(not(feature = "results"), allow(dead_code))]
pub(crate) mod number;

#[cfg(feature = "results")]
pub mod chart;

/// Width and height of a chart in pixels: the page has room for a chart before it is loaded.
const CHART_PIXELS: (usize, usize) = (1800, 1350);

#[cfg(feature = "pictures")]
pub mod overlay;

pub use file_list::is_hidden;
pub use output_folder::{OutputFolder, Pending};
pub use table_stream::CsvTable;
#[cfg(feature = "parquet")]
pub use table_stream::ParquetTable;
pub use write::OutputError;
