//! Files to begin with, beside measurements that are already there: a `fabric.toml` for each fabric, a case, and the
//! schemas by which an editor completes both.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::inputs::{Input, Reading};
use super::observer::Observer;
use crate::instrument::{Direction, FabricInput, Test};
use crate::report::OutputError;
use crate::report::write::write_file;
use crate::schema;

/// A `fabric.toml` in which every key stands as a comment.
const FABRIC: &str = include_str!("fabric.toml");
/// A case that any fabric with B and an areal density can be taken through.
const CASE: &str = include_str!("../../../cases/cantilever.toml");
/// Where that case is put below the folder that is begun.
pub const FIRST_CASE: &str = "cases/cantilever.toml";
/// Folder of the schemas below the one that is begun.
const SCHEMAS: &str = "schemas";

/// What was written and what was there already.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Begun {
    /// Files that were written.
    pub written: Vec<PathBuf>,
    /// Files that were there and stay as they are.
    pub kept: Vec<PathBuf>,
    /// What could not be read.
    pub failures: Vec<Failure>,
}

/// Writes what a folder of measurements lacks: `fabric.toml` in the folder of each fabric, `cases/cantilever.toml`, and
/// schemas for the editor. A file that is there is never changed.
///
/// # Errors
/// O055 if the folder holds no measurement, O001 if a file cannot be written, and those of [`Reading::each`].
pub fn init(folder: &Path, reading: &Reading, observer: &Observer) -> Result<Begun, Failure> {
    let inputs = [Input::from(folder)];
    let read = reading.each(&inputs, "reading", |fabric| fabric, observer)?;
    if read.done.is_empty() {
        return Err(Failure::new("O055", format!("{}: no measurement that can be read", folder.display()))
            .hint("put the exports of a fabric into a folder of their own below it; `kesf check -v` says what is there"));
    }
    // A table of many fabrics gives several for one path.
    let mut of_path: BTreeMap<&Path, Vec<&FabricInput>> = BTreeMap::new();
    for fabric in &read.done {
        of_path.entry(&fabric.path).or_default().push(fabric);
    }
    let mut begun = Begun { failures: read.failures, ..Begun::default() };
    for (path, fabrics) in of_path {
        let [fabric] = fabrics[..] else { continue };
        if path.is_dir() {
            let schema = up_to(folder, path).join(SCHEMAS).join("fabric.json");
            begun.write(&path.join("fabric.toml"), &fabric_toml(fabric, &schema))?;
        }
    }
    // The first line of the case that is shipped names the schema of the repository.
    let case = CASE.split_once('\n').map_or(CASE, |(_, rest)| rest);
    begun.write(
        &folder.join(FIRST_CASE),
        &format!(
            "#:schema ../{SCHEMAS}/case.json\n# `kesf run {} {}` solves it for every fabric.\n{case}",
            folder.display(),
            folder.join(FIRST_CASE).display()
        ),
    )?;
    for schema in schema::SCHEMAS.iter().filter(|schema| ["case", "fabric"].contains(&schema.name)) {
        begun.write(&folder.join(SCHEMAS).join(format!("{}.json", schema.name)), schema.text)?;
    }
    Ok(begun)
}

impl Begun {
    fn write(&mut self, path: &Path, text: &str) -> Result<(), Failure> {
        if path.exists() {
            self.kept.push(path.to_path_buf());
            return Ok(());
        }
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|source| OutputError::Write { path: folder.to_path_buf(), source })?;
        }
        write_file(path, text.as_bytes(), false)?;
        self.written.push(path.to_path_buf());
        Ok(())
    }
}

/// The way from a folder up to one above it.
fn up_to(above: &Path, folder: &Path) -> PathBuf {
    let depth = folder.strip_prefix(above).map_or(0, |below| below.components().count());
    if depth == 0 { PathBuf::from(".") } else { std::iter::repeat_n("..", depth).collect() }
}

/// The file for a fabric, with what was found of it.
fn fabric_toml(fabric: &FabricInput, schema: &Path) -> String {
    let schema = schema.to_string_lossy().replace('\\', "/");
    let name = toml::Value::String(fabric.name.clone());
    FABRIC
        .replace("SCHEMA", &schema)
        .replace("FOUND", &found(fabric).join(", "))
        .replace("\"NAME\"", &name.to_string())
}

/// The tests and values that were found: `bending warp: 3`, `12 values of tables`.
fn found(fabric: &FabricInput) -> Vec<String> {
    let series: BTreeSet<(Test, Option<Direction>)> =
        fabric.measurements.iter().map(|m| (m.test, m.direction)).collect();
    let count = |(test, direction): (Test, Option<Direction>)| {
        let n = fabric.measurements.iter().filter(|m| (m.test, m.direction) == (test, direction)).count();
        let direction = direction.map_or(String::new(), |d| format!(" {d}"));
        format!("{}{direction}: {n}", test.name())
    };
    let values = (!fabric.results.is_empty()).then(|| format!("{} values of tables", fabric.results.len()));
    let strips = fabric.fab.iter().map(|fab| format!("FAB record: {} strip tests", fab.tests.len()));
    series.into_iter().map(count).chain(values).chain(strips).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::instrument::{ReadSettings, read_fabrics};

    const CURVE: &str = "direction,warp\nK (1/cm),M (gf·cm/cm)\n0,0\n1,0.1\n2,0.2\n2.5,0.25\n";

    #[test]
    fn a_folder_of_exports_gets_what_it_lacks_and_keeps_what_it_has() {
        let folder = tempfile::tempdir().unwrap();
        for (name, fabric) in [("\"a\" = b", "x.csv"), ("plain", "y.csv")] {
            std::fs::create_dir(folder.path().join(name)).unwrap();
            std::fs::write(folder.path().join(name).join(fabric), CURVE).unwrap();
        }
        let own = folder.path().join("plain/fabric.toml");
        std::fs::write(&own, "name = \"Mine\"\n").unwrap();
        let observer = Observer::default();
        let begun = init(folder.path(), &Reading::default(), &observer).unwrap();
        assert_eq!((begun.written.len(), begun.kept.len(), begun.failures.len()), (4, 1, 0), "{begun:?}");
        assert_eq!(std::fs::read_to_string(own).unwrap(), "name = \"Mine\"\n");
        let text = std::fs::read_to_string(folder.path().join("\"a\" = b/fabric.toml")).unwrap();
        assert!(
            text.starts_with("#:schema ../schemas/fabric.json\n") && text.contains("bending warp: 1"),
            "{text}"
        );
        let batch = read_fabrics(&[folder.path().to_path_buf()], &ReadSettings::default(), &|_: &Path| ());
        assert!(batch.failures.is_empty(), "{:?}", batch.failures);
        assert_eq!(batch.fabrics[0].info.title, "\"a\" = b");
        Case::read(&folder.path().join(FIRST_CASE)).unwrap();
        // Once more: nothing is written.
        let again = init(folder.path(), &Reading::default(), &observer).unwrap();
        assert_eq!((again.written.len(), again.kept.len()), (0, 5));
        assert!(init(&folder.path().join("cases"), &Reading::default(), &observer).is_err());
    }

    /// Every key that stands as a comment is one that is read.
    #[test]
    fn what_stands_as_a_comment_can_be_stated() {
        let folder = tempfile::tempdir().unwrap();
        let fabric = FabricInput { name: "x".into(), ..FabricInput::default() };
        let text = fabric_toml(&fabric, Path::new("schemas/fabric.json"));
        let stated = |line: &str| match line.strip_prefix("#= ") {
            Some(line) => format!("{line}\n"),
            None => format!("{line}\n"),
        };
        let text: String = text.lines().map(stated).collect();
        std::fs::write(folder.path().join("fabric.toml"), &text).unwrap();
        std::fs::write(folder.path().join("a.csv"), CURVE).unwrap();
        let batch = read_fabrics(&[folder.path().to_path_buf()], &ReadSettings::default(), &|_: &Path| ());
        assert!(batch.failures.is_empty(), "{:?}\n{text}", batch.failures);
        let info = &batch.fabrics[0].info;
        assert_eq!((info.areal_density, info.results.len()), (Some(0.12), 3));
        assert!(
            !batch.fabrics[0].findings.iter().any(|f| f.code() == "R104"),
            "{:?}",
            batch.fabrics[0].findings
        );
    }
}
