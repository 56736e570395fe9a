//! The command from outside: what it prints, writes and refuses.

mod cli;
#[path = "../common/mod.rs"]
mod common;
mod documents;
mod export;
#[path = "../drape_image/generator.rs"]
#[expect(dead_code, reason = "one picture is enough here")]
mod generator;
mod inputs;
mod library;
mod parts;
mod recorded;
mod safe;
