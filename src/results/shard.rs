//! Which fabrics of a batch belong to which of its parts.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use sha2::{Digest, Sha256};

use super::failure::Failure;
use super::inputs::Input;
use super::names::key_of_name;
use crate::instrument::is_data_name;
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

    /// Whether a fabric of this name belongs to it.
    pub(super) fn has_name(self, name: &str) -> bool {
        shard_of_name(name, self.count) == self.number
    }
}

/// The number of the shard, from 1, that the fabric of a folder or file belongs to: by the hash of the name that it gets,
/// which is that of the folder to which it leads, or that of the file without ending. What is one name in a folder of
/// results (letters in any case, accents in any form, characters that no folder can have) is one here, so that fabrics that
/// could be of one name are in one shard and are told apart there, and a fabric more or less moves no other.
pub fn shard_of(path: &Path, count: usize) -> usize {
    shard_of_name(&name_of(path), count)
}

fn shard_of_name(name: &str, count: usize) -> usize {
    let mut first = [0; 8];
    first.copy_from_slice(&Sha256::digest(key_of_name(name).as_bytes())[..8]);
    (u64::from_be_bytes(first) % count.max(1) as u64) as usize + 1
}

/// The name that a folder or a file gives its fabric: a folder that of what it leads to, and a file its own without
/// ending. What is not on this disk is a file if it is named as those of measurements are.
pub(super) fn name_of(path: &Path) -> String {
    let is_folder = files::is_folder(path);
    // "." and ".." have a name only on disk.
    let real = if is_folder || path.file_name().is_none() { files::canonicalize(path).ok() } else { None };
    let path = real.as_deref().unwrap_or(path);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let is_file = !is_folder && (files::is_file(path) || is_data_name(&name));
    let name = if is_file { path.file_stem().unwrap_or_default().to_string_lossy() } else { name };
    // `<stdin>` stands for a path.
    name.trim_matches(['<', '>']).to_string()
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
    /// Whether the fabric of a folder or file of that name is one of this shard: with inputs of its own, all that they name.
    pub(crate) fn wants(self, inputs: &[Input], path: &Path, name: &str) -> bool {
        let is_own = |input: &Input| path.starts_with(input.path()) || input.path().starts_with(path);
        self.shard.has_name(name) || !self.of_whole && inputs.iter().any(is_own)
    }

    /// Whether this shard says what is true of all of them, such as that a case cannot be read: one of them does.
    pub(crate) fn speaks_for_all(self) -> bool {
        self.shard.number == 1
    }

    /// Whether this shard says what was found of the inputs as they are.
    pub(crate) fn speaks_of_inputs(self) -> bool {
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
    fn what_is_one_name_in_results_is_in_one_shard() {
        for (one, other) in
            [("trail", "trail "), ("a:b", "a-b"), ("g\u{e4}nse", "ga\u{308}nse"), ("con", "fabric-con")]
        {
            assert_eq!(shard_of(one.as_ref(), 1000), shard_of(other.as_ref(), 1000), "{one:?}, {other:?}");
        }
    }

    #[test]
    fn only_files_lose_their_ending() {
        let root = tempfile::tempdir().unwrap();
        let folders: Vec<_> = (0..60).map(|n| root.path().join(format!("shirting.{n:04}"))).collect();
        let shards = || folders.iter().map(|path| shard_of(path, 7)).collect::<Vec<_>>();
        // Elsewhere they are known by their names alone.
        let elsewhere = shards();
        folders.iter().for_each(|path| std::fs::create_dir(path).unwrap());
        assert_eq!(shards(), elsewhere);
        assert!(
            (1..=7).all(|number| elsewhere.iter().filter(|n| **n == number).count() < 20),
            "{elsewhere:?}"
        );
        std::fs::write(root.path().join("lot.tab"), "").unwrap();
        assert_eq!(name_of(&root.path().join("lot.tab")), "lot");
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
