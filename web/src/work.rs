//! What the page asks for: the commands of the program, over the files in memory.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Write};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use kesf::RunSettings;
use kesf::constitutive::Assumptions;
use kesf::report::cards::EXPORTERS;
use kesf::report::html::{LIMIT, self_contained};
use kesf::results::{
    CheckDocument, Curves, Failure, Input, Job, Limits, MemorySink, Observer, Reading, cards as cards_of,
    check as checked_of, sections_with, write_cards,
};
use kesf::run::Drapes;
use serde::{Deserialize, Serialize};
use zip::write::SimpleFileOptions;

use crate::files;
use crate::said::{Line, Said};

/// The most that a case may need (bytes): WebAssembly has no more than 4 GB for everything.
const MEMORY: u64 = 2 << 30;

/// Name of the report as one file.
const REPORT: &str = "report.html";

/// The results of the last run.
static RESULTS: Mutex<BTreeMap<String, Vec<u8>>> = Mutex::new(BTreeMap::new());

/// What the form holds.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Form {
    /// Text of a settings file.
    settings: String,
    /// Text of a dialect file.
    dialect: String,
    /// Whether numbers without a unit are in the customary KES unit.
    assume_kes_units: bool,
    /// Whether the cases that the page brings with it are solved.
    cases: bool,
    /// Whether drapes are hung, by those cases and by dropped ones. The page asks for them when all else is shown.
    drape: bool,
}

/// The answer to `check`.
#[derive(Serialize)]
pub struct CheckAnswer {
    document: Option<CheckDocument>,
    said: Vec<Line>,
    /// Files that are named like no measurement, and were not looked at.
    passed_by: Vec<PathBuf>,
}

/// The answer to `run` and `cards`.
#[derive(Serialize)]
pub struct RunAnswer {
    said: Vec<Line>,
    files: Vec<FileEntry>,
}

/// A file of the results.
#[derive(Serialize)]
struct FileEntry {
    name: String,
    bytes: usize,
}

/// The JSON of an answer; a failure is a line like others.
pub fn answer<T: Serialize>(result: Result<T, Failure>) -> String {
    #[derive(Serialize)]
    struct Failed {
        said: [Line; 1],
    }
    let text = match &result {
        Ok(answer) => serde_json::to_string(answer),
        Err(failure) => serde_json::to_string(&Failed { said: [Line::of_failure(failure)] }),
    };
    text.unwrap_or_default()
}

impl Form {
    fn read(options: &str) -> Result<Self, Failure> {
        Ok(serde_json::from_str(options)?)
    }

    fn reading(&self) -> Reading {
        Reading {
            settings: files::put_text("settings.toml", &self.settings),
            dialect: files::put_text("dialect.toml", &self.dialect),
            assume_kes_units: self.assume_kes_units,
            ..Reading::default()
        }
    }

    fn job(&self, fabrics_only: bool) -> Job {
        let mut inputs = inputs();
        if fabrics_only {
            inputs.retain(|input| !input.is_case());
        } else if self.cases {
            inputs.push(files::put_cases().into());
        }
        let limits = Limits { bytes: MEMORY, ..Limits::default() };
        Job { inputs, reading: self.reading(), threads: 1, limits, ..Job::default() }
    }
}

fn inputs() -> Vec<Input> {
    files::dropped().into_iter().map(Input::from).collect()
}

/// `kesf check`.
pub fn check(options: &str) -> Result<CheckAnswer, Failure> {
    let form = Form::read(options)?;
    let said = Said::default();
    let event = |event: kesf::results::Event<'_>| said.hear(event);
    let observer = Observer { event: &event, cancelled: &|| false };
    let checked = checked_of(&inputs(), &form.reading(), MEMORY, &observer)?;
    let looked_at: BTreeSet<PathBuf> = checked.files().into_iter().collect();
    let about = |path: &PathBuf| path.extension().is_some_and(|e| e == "toml");
    let passed_by =
        files::all().into_iter().filter(|path| !looked_at.contains(path) && !about(path)).collect();
    Ok(CheckAnswer { document: Some(checked.document()), said: said.lines(), passed_by })
}

/// `kesf run`, and `kesf report` behind it.
pub fn run(options: &str, fabrics_only: bool, drapes: bool) -> Result<RunAnswer, Failure> {
    let form = Form::read(options)?;
    let said = Said::default();
    let event = |event: kesf::results::Event<'_>| said.hear(event);
    let observer = Observer { event: &event, cancelled: &|| false };
    let drapes = if drapes && form.drape { Drapes::Auto } else { Drapes::Never };
    let settings = RunSettings { charts: false, drapes, workbook: !fabrics_only, ..RunSettings::default() };
    let sink = MemorySink::default();
    keep(BTreeMap::new());
    kesf::run(&form.job(fabrics_only), &settings, &sink, &observer)?;
    let mut made = sink.into_files();
    if let Some(page) = made.get("index.html").and_then(|index| one_file(index)) {
        made.insert(REPORT.into(), page);
    }
    keep(made);
    Ok(RunAnswer { said: said.lines(), files: entries() })
}

/// The page of a folder of results without the folder.
fn one_file(index: &[u8]) -> Option<Vec<u8>> {
    let none = |_: &str| Ok::<_, Failure>(Vec::new());
    let page = self_contained(&String::from_utf8_lossy(index), LIMIT, none).ok().flatten()?;
    Some(page.page.into_bytes())
}

/// `kesf export` for every program.
pub fn cards(options: &str) -> Result<RunAnswer, Failure> {
    let form = Form::read(options)?;
    let said = Said::default();
    let event = |event: kesf::results::Event<'_>| said.hear(event);
    let observer = Observer { event: &event, cancelled: &|| false };
    let fabrics: Vec<Input> = inputs().into_iter().filter(|input| !input.is_case()).collect();
    let (sections, _) =
        sections_with(&fabrics, &form.reading(), &Assumptions::default(), Curves::Kept, &observer)?;
    let mut made = results(Clone::clone);
    for target in EXPORTERS {
        let sink = MemorySink::default();
        let (cards, _) = cards_of(&sections, &[target], None, &observer);
        write_cards(&cards, &sink, &observer);
        made.extend(
            sink.into_files().into_iter().map(|(name, text)| (format!("cards/{}/{name}", target.name), text)),
        );
    }
    keep(made);
    Ok(RunAnswer { said: said.lines(), files: entries() })
}

/// A file of the results.
pub fn read(name: &str) -> Vec<u8> {
    results(|made| made.get(name).cloned().unwrap_or_default())
}

/// All files of the results.
pub fn archive() -> Result<Vec<u8>, String> {
    results(|made| {
        let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in made {
            zip.start_file(name, SimpleFileOptions::default()).map_err(|e| e.to_string())?;
            zip.write_all(bytes).map_err(|e| e.to_string())?;
        }
        Ok(zip.finish().map_err(|e| e.to_string())?.into_inner())
    })
}

fn entries() -> Vec<FileEntry> {
    results(|made| {
        made.iter().map(|(name, file)| FileEntry { name: name.clone(), bytes: file.len() }).collect()
    })
}

fn results<T>(work: impl FnOnce(&BTreeMap<String, Vec<u8>>) -> T) -> T {
    work(&RESULTS.lock().unwrap_or_else(PoisonError::into_inner))
}

fn keep(made: BTreeMap<String, Vec<u8>>) {
    *RESULTS.lock().unwrap_or_else(PoisonError::into_inner) = made;
}
