//! The command; see [`kesf::cli`].
use std::process::ExitCode;

fn main() -> ExitCode {
    kesf::cli::run(std::env::args_os())
}
