//! Damaged files for every reader of kesf.
//!
//! A target takes valid files ([`corpus`]), damages them ([`damage`]) and hands them to a reader ([`readers`]). Nothing
//! may panic; the time stays in proportion to the size ([`watch`]); and where a reader accepts what it gets, the same
//! is read from what is written of it.
//!
//! `cargo test --release -p kesf-fuzz` runs every target for a minute; `KESF_FUZZ_SECONDS` is another time,
//! `KESF_FUZZ_FILES` a number of files instead, the same ones every time. With
//! `cargo-bolero`, `cargo bolero test -p kesf-fuzz text` lets libFuzzer choose the damage by what it reaches.
#![warn(missing_docs)]

pub mod archives;
pub mod corpus;
pub mod damage;
pub mod readers;
pub mod watch;

pub use damage::Damage;
pub use watch::Run;

/// A reader, and the files that are damaged for it.
#[derive(Clone)]
pub struct Target {
    /// Valid files.
    pub seeds: Vec<Vec<u8>>,
    /// A file that is damaged.
    pub damaged: fn(&Damage, &[Vec<u8>]) -> Vec<u8>,
    /// How much there is to read (bytes): what is packed counts as it is unpacked.
    pub size: fn(&[u8]) -> usize,
    /// Reads it and panics where something does not hold; whether it was accepted.
    pub holds: fn(&[u8]) -> bool,
}
