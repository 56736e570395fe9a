//! Files of laboratories, from their bytes to fabrics and parameters.

mod cells;
mod characterise;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/content.rs"]
mod content;
mod encodings;
mod folders;
mod layouts;
mod malformed;
mod mutations;
mod rearranged;
mod records;
mod reencoded;
mod shown;
mod spikes;
mod tables;
mod workbooks;
