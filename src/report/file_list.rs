//! Names of many files and what is in them, in little memory: a run of 10,000 fabrics writes 40,000 files, and knows each.

use std::collections::BTreeMap;
use std::fmt;

use indexmap::IndexSet;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// SHA-256 of the bytes of a file.
pub(super) type Digest32 = [u8; 32];

/// Files by their names (with `/` between the parts), each with one digest or several.
///
/// A folder is kept once, and so is a name that files of many folders have, such as `sheet.json`: what a file takes is its
/// digest and a number.
#[derive(Debug, Default)]
pub(super) struct FileList {
    /// Names in their folders.
    names: IndexSet<Box<str>>,
    /// Files by folder, in the order of the places of their names.
    folders: BTreeMap<Box<str>, Vec<(u32, Digest32)>>,
}

/// Folder and name in it.
fn parts(name: &str) -> (&str, &str) {
    name.rsplit_once('/').unwrap_or(("", name))
}

impl FileList {
    /// Says what is in a file, whatever was known of it.
    pub fn set(&mut self, name: &str, digest: Digest32) {
        self.put(name, digest, true);
    }

    /// Says what else may be in a file.
    pub fn add(&mut self, name: &str, digest: Digest32) {
        self.put(name, digest, false);
    }

    fn put(&mut self, name: &str, digest: Digest32, alone: bool) {
        let (folder, name) = parts(name);
        let place = match self.names.get_index_of(name) {
            Some(place) => place,
            None => self.names.insert_full(name.into()).0,
        };
        // More names than that are more files than a disk has.
        let place = u32::try_from(place).unwrap_or(u32::MAX);
        if !self.folders.contains_key(folder) {
            self.folders.insert(folder.into(), Vec::new());
        }
        let Some(files) = self.folders.get_mut(folder) else { return };
        let (from, to) = within(files, place);
        if alone {
            files.drain(from..to);
            files.insert(from, (place, digest));
        } else {
            files.insert(to, (place, digest));
        }
    }

    /// What may be in a file; nothing of one that is not listed.
    pub fn of(&self, name: &str) -> impl Iterator<Item = &Digest32> {
        let (folder, name) = parts(name);
        let place = self.names.get_index_of(name).and_then(|place| u32::try_from(place).ok());
        let found = self.folders.get(folder).zip(place).map(|(files, place)| {
            let (from, to) = within(files, place);
            &files[from..to]
        });
        found.unwrap_or_default().iter().map(|(_, digest)| digest)
    }

    /// Whether a file is listed.
    pub fn has(&self, name: &str) -> bool {
        self.of(name).next().is_some()
    }

    /// Folders of the files.
    pub fn folders(&self) -> impl Iterator<Item = &str> {
        self.folders.keys().map(|folder| &**folder)
    }

    /// Every file with what may be in it, in the order of folders and of names in them.
    pub fn iter(&self) -> impl Iterator<Item = (String, Vec<Digest32>)> {
        self.folders.iter().flat_map(|(folder, files)| {
            let mut all: Vec<(String, Vec<Digest32>)> = Vec::new();
            for of_name in files.chunk_by(|a, b| a.0 == b.0) {
                let name = of_name.first().and_then(|(place, _)| self.names.get_index(*place as usize));
                let name = name.map_or("", |name| &**name);
                let path = if folder.is_empty() { name.to_string() } else { format!("{folder}/{name}") };
                all.push((path, of_name.iter().map(|(_, digest)| *digest).collect()));
            }
            all.sort_unstable();
            all
        })
    }
}

/// Where the digests of a name are among the files of a folder.
fn within(files: &[(u32, Digest32)], place: u32) -> (usize, usize) {
    (files.partition_point(|file| file.0 < place), files.partition_point(|file| file.0 <= place))
}

/// A digest in hexadecimal digits.
pub(super) fn hexadecimal(digest: &Digest32) -> String {
    digest.iter().map(|b| format!("{b:02x}")).collect()
}

/// The digest of hexadecimal digits, if they are 64.
pub(super) fn from_hexadecimal(text: &str) -> Option<Digest32> {
    let mut digest = [0; 32];
    if text.len() != 64 || !text.is_ascii() {
        return None;
    }
    for (byte, at) in digest.iter_mut().zip((0..64).step_by(2)) {
        *byte = u8::from_str_radix(&text[at..at + 2], 16).ok()?;
    }
    Some(digest)
}

/// Names and hexadecimal digits, one after the other: of a large folder the text is long, and never in memory.
impl Serialize for FileList {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let files = self.iter().filter_map(|(name, digests)| Some((name, hexadecimal(digests.first()?))));
        serializer.collect_map(files)
    }
}

impl<'de> Deserialize<'de> for FileList {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Files;
        impl<'de> Visitor<'de> for Files {
            type Value = FileList;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("names of files and their hashes")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FileList, A::Error> {
                let mut files = FileList::default();
                while let Some((name, text)) = map.next_entry::<String, String>()? {
                    let digest = from_hexadecimal(&text)
                        .ok_or_else(|| A::Error::custom(format!("the hash of `{name}` is none")))?;
                    files.set(&name, digest);
                }
                Ok(files)
            }
        }
        deserializer.deserialize_map(Files)
    }
}

/// Whether a name (with `/` between its parts) is that of a file for the next run, which people are not shown.
pub fn is_hidden(name: &str) -> bool {
    name.rsplit('/').next().is_some_and(|file| file.starts_with('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_many_folders_are_told_apart() {
        let mut files = FileList::default();
        for folder in ["b", "a", "a/c"] {
            for (name, digest) in [("z.json", 1), ("y.json", 2)] {
                files.set(&format!("{folder}/{name}"), [digest; 32]);
            }
        }
        files.set("y.json", [3; 32]);
        files.set("a/y.json", [4; 32]);
        files.add("a/y.json", [5; 32]);
        let digests = |name: &str| files.of(name).map(|digest| digest[0]).collect::<Vec<_>>();
        assert_eq!(digests("a/y.json"), [4, 5]);
        assert_eq!(digests("b/y.json"), [2]);
        assert_eq!(digests("y.json"), [3]);
        assert_eq!(["z.json", "c", "a", "a/x.json", "", "a/c/y.jso"].map(|name| files.has(name)), [false; 6]);
        let names: Vec<String> = files.iter().map(|(name, _)| name).collect();
        assert_eq!(
            names,
            ["y.json", "a/y.json", "a/z.json", "a/c/y.json", "a/c/z.json", "b/y.json", "b/z.json"]
        );
        assert_eq!(files.folders().collect::<Vec<_>>(), ["", "a", "a/c", "b"]);
    }

    #[test]
    fn a_list_is_read_as_it_was_written() {
        let mut files = FileList::default();
        ["a", "b/a", "ü/\"\\.csv"].iter().zip(1..).for_each(|(name, digest)| files.set(name, [digest; 32]));
        let text = serde_json::to_string(&files).unwrap();
        let again: FileList = serde_json::from_str(&text).unwrap();
        assert_eq!(serde_json::to_string(&again).unwrap(), text);
        assert!(again.of("ü/\"\\.csv").eq([&[3; 32]]));
        let refused = serde_json::from_str::<FileList>(r#"{"a":"00"}"#).unwrap_err().to_string();
        assert!(refused.contains("the hash of `a` is none"), "{refused}");
    }
}
