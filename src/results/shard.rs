//! Which fabrics of a batch belong to which of its parts.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use sha2::{Digest, Sha256};

use super::failure::Failure;
use crate::platform::files;

/// A part of a batch: the third of seven is `3/7`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    count: usize,
}

/// A shard, and what the inputs are to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// Which part.
    pub shard: Shard,
    /// Whether the inputs are those of the whole batch; else they are only those of this shard.
    pub of_whole: bool,
}

impl Shard {
    /// The shard of this number, from 1.
    ///
    /// # Errors
    /// O050 if there is no such shard.
    pub fn new(number: usize, count: usize) -> Result<Self, Failure> {
        if (1..=count).contains(&number) {
            return Ok(Self { number, count });
        }
        Err(Failure::new("O050", format!("there is no shard {number} of {count}"))
            .hint("shards count from 1"))
    }

    /// Which it is, from 1.
    pub fn number(self) -> usize {
        self.number
    }

    /// How many there are.
    pub fn count(self) -> usize {
        self.count
    }

    /// Name of its files.
    pub fn file(self) -> String {
        format!("part-{:04}-of-{:04}.parquet", self.number, self.count)
    }

    /// The shard whose files have this name.
    pub fn of_file(name: &str) -> Option<Self> {
        let (number, count) = name.strip_prefix("part-")?.strip_suffix(".parquet")?.split_once("-of-")?;
        let shard = Self::new(number.parse().ok()?, count.parse().ok()?).ok()?;
        (shard.file() == name).then_some(shard)
    }

    /// Whether the fabric of a folder or file belongs to it; see [`shard_of`].
    pub fn has(self, path: &Path) -> bool {
        shard_of(path, self.count) == self.number
    }
}

/// The number of the shard, from 1, that the fabric of a folder or file belongs to: by the hash of the last part of
/// its path without ending, whatever its case, so that fabrics that could be of one name are in one shard and are told
/// apart there, and a fabric more or less moves no other.
pub fn shard_of(path: &Path, count: usize) -> usize {
    // "." and ".." have a name only on disk.
    let real = if path.file_stem().is_none() { files::canonicalize(path).ok() } else { None };
    let stem =
        real.as_deref().unwrap_or(path).file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let mut first = [0; 8];
    first.copy_from_slice(&Sha256::digest(stem.as_bytes())[..8]);
    (u64::from_be_bytes(first) % count.max(1) as u64) as usize + 1
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl FromStr for Shard {
    type Err = Failure;

    fn from_str(text: &str) -> Result<Self, Failure> {
        let parsed = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        parsed.and_then(|(number, count)| Self::new(number, count).ok()).ok_or_else(|| {
            Failure::new("O050", format!("`{text}` is no shard")).hint("the third of seven is 3/7")
        })
    }
}

impl Share {
    /// Whether this shard says what is true of all of them, such as that a case cannot be read: one of them does.
    pub(crate) fn speaks_for_all(self) -> bool {
        self.shard.number == 1
    }

    /// Whether this shard says what was found of the inputs as they are.
    pub(super) fn speaks_of_inputs(self) -> bool {
        !self.of_whole || self.shard.number == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fabrics_that_could_be_of_one_name_are_in_one_shard() {
        for count in [1, 2, 7, 1000] {
            let shards = ["lot1/Poplin.csv", "lot2/poplin", "poplin/"].map(|p| shard_of(p.as_ref(), count));
            assert!((1..=count).contains(&shards[0]) && shards.iter().all(|s| *s == shards[0]));
        }
        // The first 8 bytes of what `printf poplin | sha256sum` gives, modulo 7.
        assert_eq!(shard_of("poplin".as_ref(), 7), 1);
        let shards: Vec<usize> = ["a", "b", "c", "d"].iter().map(|p| shard_of(p.as_ref(), 2)).collect();
        assert!(shards.contains(&1) && shards.contains(&2));
    }

    #[test]
    fn shards_are_written_and_read() {
        let shard: Shard = "3/7".parse().unwrap();
        assert_eq!((shard.to_string().as_str(), shard.file().as_str()), ("3/7", "part-0003-of-0007.parquet"));
        assert_eq!(Shard::of_file(&shard.file()), Some(shard));
        for wrong in ["0/7", "8/7", "3", "3/", "a/b", "-1/2"] {
            assert_eq!(&*wrong.parse::<Shard>().unwrap_err().code, "O050", "{wrong}");
        }
        for wrong in ["part-3-of-7.parquet", "part-0008-of-0007.parquet", "part-0003-of-0007.csv"] {
            assert_eq!(Shard::of_file(wrong), None, "{wrong}");
        }
    }
}
