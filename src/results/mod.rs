//! The application: inputs become tasks, tasks become outcomes, and outcomes become rows, documents, files and text.
//!
//! [`Job`] says what is to be read and how, [`Job::read`] gives the [`Work`], [`Work::tasks`] the cases with their
//! fabrics, [`simulate`](fn@simulate) the [`Outcome`] of one. [`crate::run`](fn@crate::run) does it all for a folder of results. An
//! [`Observer`] follows the work and may end it; nothing here prints.
//!
//! An outcome is of one of four kinds, each a file of its own with its rows, document, fields, charts and text; only
//! [`outcome`](Outcome) tells the kinds apart.

mod batch;
mod bent;
mod cards;
mod catalogue;
mod checked;
mod columns;
mod complete;
mod curve_table;
mod deflected;
#[cfg(feature = "pictures")]
mod drape_picture;
mod draped;
mod draped_stage;
mod fabric;
mod failure;
mod file_name;
mod folder;
mod friction;
mod init;
mod inputs;
mod judged;
pub mod list;
mod names;
mod observer;
mod outcome;
mod output_place;
mod overview;
mod page;
mod page_curves;
mod page_fabric;
mod page_index;
mod page_predictions;
mod page_problems;
mod page_section;
mod page_values;
mod paper;
mod population;
mod record;
mod rests_on;
mod sampled;
mod section;
mod shard;
mod sheet_text;
mod simulate;
mod solved;
mod task;
mod tested;
mod work;

pub use crate::finding::FailureKind;
pub use batch::{Batch, BatchKind};
pub use bent::BendingEntry;
pub use cards::{CardOptions, FabricCard, cards, cards_with, stated_crimp, write_cards};
pub(crate) use catalogue::Catalogue;
pub use checked::{CheckDocument, Checked, check};
pub use columns::Columns;
pub use complete::Complete;
pub use curve_table::{CurveTableError, fabrics_of_curves};
#[cfg(feature = "pictures")]
pub use drape_picture::{DrapePictures, drape_pictures};
pub use draped::{DrapeEntry, DrapePoint};
pub use fabric::FabricReport;
pub use failure::{Failure, FailureEntry};
pub(crate) use folder::Table;
pub use folder::{Folder, MemorySink, Sink, SinkFile};
pub use init::{Begun, FIRST_CASE, init};
pub(crate) use inputs::unread_row;
pub use inputs::{
    Curves, Fabric, FileEntry, Input, Read, Reading, ReadingEntry, cases, nothing_to_read, paths_of_several,
    readable, unread, without_cases,
};
pub use names::{FILES, distinguish_fabrics};
pub use observer::{Event, Found, Observer};
pub use outcome::{ComparisonDocument, ComparisonEntry, Document, Outcome, Solution, SolutionDocument};
pub use output_place::refuse_inputs;
pub use paper::write_claims;
pub use population::population;
pub(crate) use record::{Record, hash_of};
pub use sampled::{MeasuredInputEntry, SamplingEntry};
pub use section::{Sectioned, section_text, sections, sections_with};
pub use shard::{Shard, Share, shard_of};
pub use sheet_text::{evaluation_text, parameters_text, statistics_text};
pub use simulate::simulate;
pub use solved::{ModelEntry, QuantityEntry, SolutionEntry, SolverEntry, TimingsEntry};
pub(crate) use task::Shared;
pub use task::{Limits, Task};
pub use tested::{Stiffness, TestEntry, Tested};
pub use work::{Job, Work, named_fabric, no_such_fabric, unsuitable};
pub(crate) use work::{JobInputs, is_within, without_fabric, without_fabric_named, without_law};

pub(crate) use draped::{bracket, write_parity as write_drape_parity};
pub(crate) use friction::write_parity as write_friction_parity;
pub(crate) use overview::Overview;
pub(crate) use page::{Benchmark, FABRICS_OF_PAGE, Head, fabrics_page, page};
pub(crate) use page_index::{Pages, name_of_page};
pub(crate) use page_problems::Problems;
pub(crate) use solved::checks;
