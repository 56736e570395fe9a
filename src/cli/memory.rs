//! How much memory this process may take, where the system says so.

use std::fs::read_to_string;

use clap::Args;

use crate::case::Bytes;
use crate::results::Limits;

/// How much memory a case may need.
#[derive(Clone, Copy, Debug, Args)]
pub struct MemoryArgs {
    /// Most memory that a case may need, estimated before it begins [default: what the machine has free, else 16 GB]
    #[arg(long, value_name = "SIZE")]
    memory_limit: Option<Bytes>,
}

impl MemoryArgs {
    /// Bytes.
    pub fn bytes(self) -> u64 {
        let free = || available().unwrap_or(Limits::default().bytes);
        self.memory_limit.map_or_else(free, |typed| typed.0)
    }
}

/// Bytes that the machine has free, that the container may hold, and that the process may address: the least of them.
/// `None` where no file of the system says it.
fn available() -> Option<u64> {
    let free = read_to_string("/proc/meminfo").ok().and_then(|text| free(&text));
    let container =
        read_to_string("/sys/fs/cgroup/memory.max").ok().and_then(|text| text.trim().parse().ok());
    let address_space = read_to_string("/proc/self/limits").ok().and_then(|text| address_space(&text));
    [free, container, address_space].into_iter().flatten().min()
}

/// `MemAvailable:   19876543 kB`.
fn free(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// `Max address space         6442450944           6442450944           bytes`: the first number is what holds.
fn address_space(limits: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_of_linux_are_read() {
        assert_eq!(free("MemTotal: 24 kB\nMemAvailable:   1000 kB\n"), Some(1_024_000));
        assert_eq!(free("MemTotal: 24 kB\n"), None);
        let limits = |soft| {
            format!("Limit  Soft Limit\nMax address space         {soft}           unlimited   bytes\n")
        };
        assert_eq!(address_space(&limits("6442450944")), Some(6_442_450_944));
        assert_eq!(address_space(&limits("unlimited")), None);
    }
}
