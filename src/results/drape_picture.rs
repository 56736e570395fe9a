//! Pictures of drape tests: captures, means, text, overlays, and the file that states them as measured.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::columns::Columns;
use super::failure::Failure;
use super::folder::Sink;
use super::names::{Named, distinguish};
use super::observer::Observer;
use crate::characterise::drape::{
    ClothSide, DrapeCapture, DrapeDocument, DrapeSetup, DrapeSummary, SeenSheet, Spread, drape_results,
    measure, summaries,
};
use crate::finding::{DrapeFact, Finding, Place};
use crate::instrument::picture::{Silhouette, read_silhouette};
use crate::instrument::{DRAPE_FILE, MeasuredResult};
use crate::platform::{self, files};
use crate::quantity::significant;
use crate::report::overlay::{Overlay, overlay};

/// Endings of pictures that are looked for in folders.
const ENDINGS: [&str; 3] = ["png", "jpg", "jpeg"];
/// What the names of overlays end with; they are no pictures of a test.
const OVERLAY: &str = ".outline.png";

/// What pictures of drape tests show.
#[derive(Clone, Debug, PartialEq)]
pub struct DrapePictures {
    /// Captures and their means.
    pub document: DrapeDocument,
    /// Pictures that show nothing.
    pub failures: Vec<Failure>,
}

/// A picture in which a sheet was found.
struct Seen {
    path: PathBuf,
    /// The folder of the test that it belongs to.
    folder: PathBuf,
    size: [u32; 2],
    sheet: SeenSheet,
    bytes: Option<Vec<u8>>,
}

/// Measures the pictures that are named, and those in folders that are, each once; the name of a picture's folder is that
/// of its test, numbered where two folders share one. With a sink the overlays, and the measured results of each test, are written there.
///
/// # Errors
/// O055 if there is no picture, O054 if the work was cancelled, and those of the sink.
pub fn drape_pictures(
    paths: &[PathBuf],
    setup: &DrapeSetup,
    sink: Option<&dyn Sink>,
    observer: &Observer,
) -> Result<DrapePictures, Failure> {
    let pictures = pictures(paths)?;
    if setup.method.assumed {
        let method = setup.method.text();
        observer.found(None, &Finding::new(DrapeFact::AssumedSizes { method }));
    }
    let read = observer.part("pictures", pictures.len(), || {
        platform::map(&pictures, |path| {
            let seen = if (observer.cancelled)() { Ok(None) } else { read(path, sink.is_some()).map(Some) };
            observer.step();
            seen
        })
    })?;
    let (mut seen, mut failures) = (Vec::new(), Vec::new());
    for result in read {
        match result {
            Ok(found) => seen.extend(found),
            Err(failure) => {
                observer.failed(&failure);
                failures.push(failure);
            }
        }
    }
    let (scales, tests) = (scales(&seen, setup), tests(&seen));
    tests.values().flat_map(|test| &test.findings).for_each(|finding| observer.found(None, finding));
    let mut captures = Vec::new();
    for Seen { path, folder, size, sheet, bytes } in &seen {
        let test = tests[folder.as_path()].name.clone();
        let others = scales.get(&(folder.as_path(), *size)).copied();
        let (capture, mut facts) = measure(sheet, setup, others);
        let name = path.to_string_lossy().replace('\\', "/");
        let side = ClothSide::in_name(&stem(path));
        let mut capture = DrapeCapture { picture: name, test, side, ..capture };
        facts.extend(capture.mark_copy(&captures));
        for fact in facts {
            observer.found(None, &Finding::new(fact).at(Place::file(path)));
        }
        if let Some((sink, bytes)) = sink.zip(bytes.as_ref()) {
            let picture = overlay(bytes, &drawn(sheet, &capture))?;
            sink.write(&format!("{}/{}{OVERLAY}", capture.test, file_name(path)), &picture)?;
        }
        captures.push(capture);
    }
    let document = DrapeDocument {
        schema: "kesf.drape-image/1".into(),
        method: setup.method,
        summaries: summaries(&captures),
        captures,
    };
    if let Some(sink) = sink {
        write_measured(&document, sink)?;
    }
    Ok(DrapePictures { document, failures })
}

/// The pictures that paths name, in their order and each once; those of a folder and of the folders in it in name order.
fn pictures(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let (mut found, mut entered) = (Vec::new(), BTreeSet::new());
    for path in paths {
        if files::is_folder(path) {
            add_pictures(path, &mut found, &mut entered)?;
        } else {
            found.push(path.clone());
        }
    }
    let mut known = BTreeSet::new();
    found.retain(|picture| files::canonicalize(picture).map_or(true, |real| known.insert(real)));
    if found.is_empty() {
        return Err(Failure::new("O055", "there is no picture in what was named")
            .hint("name PNG or JPEG files, or a folder of them"));
    }
    Ok(found)
}

/// Adds the pictures below a folder; one that was entered before, by a link, is passed over.
fn add_pictures(
    folder: &Path,
    found: &mut Vec<PathBuf>,
    entered: &mut BTreeSet<PathBuf>,
) -> Result<(), Failure> {
    let unreadable = |e: std::io::Error| Failure::new("R001", e.to_string()).at(Place::file(folder));
    if !entered.insert(files::canonicalize(folder).map_err(unreadable)?) {
        return Ok(());
    }
    for entry in files::entries(folder).map_err(unreadable)? {
        if is_picture(&entry) {
            found.push(entry);
        } else if files::is_folder(&entry) && !is_hidden(&entry) {
            add_pictures(&entry, found, entered)?;
        }
    }
    Ok(())
}

fn is_hidden(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))
}

fn is_picture(path: &Path) -> bool {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let name = path.file_name().map(|n| n.to_string_lossy().to_lowercase()).unwrap_or_default();
    files::is_file(path) && ENDINGS.contains(&ending.as_str()) && !name.ends_with(OVERLAY) && !is_hidden(path)
}

fn read(path: &Path, keep: bool) -> Result<Seen, Failure> {
    let (Silhouette { size, outline, disc, contrast, noise, others, at_border }, bytes) =
        read_silhouette(path)?;
    let disc = disc.map(|d| (d.centre, d.radius));
    let sheet = SeenSheet { outline, disc, contrast: [contrast, noise], others, at_border };
    let real = files::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let folder = real.parent().unwrap_or(Path::new("")).to_path_buf();
    Ok(Seen { path: path.to_path_buf(), folder, size, sheet, bytes: keep.then_some(bytes) })
}

/// The scale by the discs in the pictures of a test that have one size: their median.
fn scales<'s>(seen: &'s [Seen], setup: &DrapeSetup) -> BTreeMap<(&'s Path, [u32; 2]), f64> {
    let mut all: BTreeMap<(&Path, [u32; 2]), Vec<f64>> = BTreeMap::new();
    for picture in seen {
        if let Some(scale) = setup.by_disc(&picture.sheet) {
            all.entry((&picture.folder, picture.size)).or_default().push(scale);
        }
    }
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    all.into_iter().map(|(key, values)| (key, median(values))).collect()
}

/// The tests by their folders: each with the name of its folder, or with one that no other has.
fn tests(seen: &[Seen]) -> BTreeMap<&Path, Named> {
    let folders: BTreeSet<&Path> = seen.iter().map(|picture| picture.folder.as_path()).collect();
    let folders: Vec<&Path> = folders.into_iter().collect();
    let name =
        |folder: &Path| folder.file_name().map_or("pictures".into(), OsStr::to_string_lossy).into_owned();
    let mut named: Vec<Named> = folders.iter().map(|folder| Named::new(name(folder))).collect();
    distinguish(&mut named, |at| folders[at], &BTreeSet::new());
    folders.into_iter().zip(named).collect()
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default()
}

/// What is drawn over a picture.
fn drawn(sheet: &SeenSheet, capture: &DrapeCapture) -> Overlay {
    let pixels = capture.scale.map_or(1.0, |s| s.pixels_per_metre);
    let [x, y] = capture.centre_px;
    let tip = |deg: &usize| {
        let (sin, cos) = (*deg as f64).to_radians().sin_cos();
        let r = pixels * capture.outline.get(*deg).copied().unwrap_or(0.0);
        [x + r * cos, y - r * sin]
    };
    Overlay {
        outline: sheet.outline.clone(),
        disc: sheet.disc,
        centre: capture.centre_px,
        folds: capture.folds_at_deg.iter().map(tip).collect(),
    }
}

/// `drape.toml`.
#[derive(Serialize)]
struct Measured {
    results: Vec<MeasuredResult>,
}

/// Writes `drape.toml` of each test: beside `fabric.toml` it is the measured drape of that fabric.
fn write_measured(document: &DrapeDocument, sink: &dyn Sink) -> Result<(), Failure> {
    for summary in document.summaries.iter().filter(|s| s.side.is_none()) {
        let results = drape_results(summary, &document.method);
        // Where no picture counts, nothing was measured.
        if results.is_empty() {
            continue;
        }
        let text = toml::to_string(&Measured { results }).map_err(|e| Failure::new("O057", e.to_string()))?;
        let text =
            format!("# Measured in pictures by `kesf drape-image`; lay it beside fabric.toml.\n{text}");
        sink.write(&format!("{}/{DRAPE_FILE}", summary.test), text.as_bytes())?;
    }
    Ok(())
}

impl DrapePictures {
    /// Tables of the captures and of their means.
    pub fn text(&self) -> String {
        let mut captures = Columns::new([
            "picture",
            "side",
            "coefficient (%)",
            "folds",
            "may be",
            "harmonic",
            "amplitude (mm)",
            "pixels/cm",
            "scale",
        ]);
        for c in &self.document.captures {
            let [clear, all] = c.folds_band;
            let scale = c.scale.map(|s| s.source.text().to_string());
            let mark = if c.left_out_for.is_empty() { "" } else { "?" };
            captures.row([
                c.picture.clone(),
                c.side.map_or("", ClothSide::name).into(),
                c.coefficient.map_or("-".into(), |v| format!("{:.2}{mark}", 100.0 * v)),
                c.folds.to_string(),
                if clear == all { String::new() } else { format!("{clear} to {all}") },
                c.harmonic.to_string(),
                c.scale.map_or("-".into(), |_| significant(1e3 * c.amplitude)),
                c.scale.map_or("-".into(), |s| format!("{:.2}", 0.01 * s.pixels_per_metre)),
                scale.unwrap_or_else(|| "unknown".into()),
            ]);
        }
        let mut means =
            Columns::new(["test", "side", "coefficient (%)", "SD", "folds", "SD", "n", "left out"]);
        for DrapeSummary { test, side, coefficient, folds, left_out } in &self.document.summaries {
            let mean = |s: &Spread, factor: f64| format!("{:.2}", factor * s.mean);
            let sd = |s: &Spread, factor: f64| s.sd.map_or("-".into(), |sd| format!("{:.2}", factor * sd));
            means.row([
                test.clone(),
                side.map_or("", ClothSide::name).into(),
                coefficient.as_ref().map_or("-".into(), |c| mean(c, 100.0)),
                coefficient.as_ref().map_or("-".into(), |c| sd(c, 100.0)),
                folds.as_ref().map_or("-".into(), |f| mean(f, 1.0)),
                folds.as_ref().map_or("-".into(), |f| sd(f, 1.0)),
                folds.as_ref().map_or(0, |f| f.n).to_string(),
                left_out.to_string(),
            ]);
        }
        format!("{}\n{}", captures.text(), means.text())
    }
}
