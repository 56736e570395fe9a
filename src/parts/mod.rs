//! Results of a large batch in parts: a Parquet file for each shard, whole or not at all, and all of them as one.
//!
//! A folder of parts:
//!
//! ```text
//! out/part-0001-of-0007.parquet             results: one row group, units in the metadata of the fields
//! out/_findings/part-0001-of-0007.parquet   what a reader must know
//! out/_failures/part-0001-of-0007.parquet   what gave nothing
//! ```
//!
//! The metadata of a part has the version of kesf, the hash of the set-up that all parts of a batch share, and a key,
//! the hash of everything that this one depends on: a part with the same key is not made again. The results are
//! written last, so that a part that is there is complete.

mod error;
mod evaluation;
mod make;
mod merge;
mod part;

pub use error::PartError;
pub use evaluation::{Evaluation, evaluate};
pub use make::{Done, Request, make};
pub use merge::{Merged, complete, merge, merge_folder};
pub use part::{Part, TABLES, Table, encode, key_of};
