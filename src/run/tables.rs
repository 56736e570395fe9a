//! Tables, pages and charts over all fabrics, from their records: one in memory at a time.

use std::collections::BTreeMap;

use super::document::{OriginEntry, document};
use super::fabrics::Made;
use super::own::Own;
use super::settings::RunSettings;
use super::work::RunWork;
use crate::case::Case;
use crate::finding::Finding;
use crate::instrument::Source;
use crate::platform::files;
use crate::report::CsvTable;
use crate::report::chart::{self, ParityPoint};
use crate::report::html::{Figure, FigureKind, html};
use crate::report::table::{FabricRow, PredictionRow, ProblemRow, problem_row};
#[cfg(feature = "workbook")]
use crate::report::workbook;
use crate::results::{
    Benchmark, Columns, DrapePoint, FABRICS_OF_PAGE, FabricReport, Failure, FileEntry, Folder, Head, Job,
    Observer, Overview, Pages, Problems, Record, SinkFile, Table, bracket, checks, fabrics_page,
    name_of_page, page, unread_row, write_drape_parity, write_friction_parity,
};

/// Fabrics that the overview for people lists; all of them are in `fabrics.csv`.
pub(super) const LISTED: usize = 200;

/// Bytes of records from which a page is full: fabrics of many curves are fewer to a page, which a browser opens and memory
/// holds. A fabric of 21 records has 94 kB of them, and takes seven times as much memory while its page is made.
const LENGTH_OF_PAGE: usize = 8_000_000;

/// So many fabrics share a page whatever they hold.
const SHARING: usize = 40;

/// What there is to write about.
pub(super) struct Results<'r, 'w> {
    pub work: &'w RunWork,
    pub folder: &'r Folder<'r>,
    pub settings: &'r RunSettings,
    pub made: &'r [Made],
    pub own: &'r [Own<'w>],
    /// Of inputs and tasks.
    pub failures: &'r [Failure],
    pub without_law: &'r [Finding],
    /// Cases that were not left out.
    pub cases: &'r [&'w Case],
}

/// The files that get rows of every fabric.
struct Tables<'s> {
    fabrics: Table<'s, FabricRow>,
    predictions: Table<'s, PredictionRow>,
    problems: CsvTable<Box<dyn SinkFile + 's>>,
    /// What the page shows of the problems.
    shown: Problems,
    /// The rows once more, for a workbook.
    #[cfg(feature = "workbook")]
    workbook: Option<Rows>,
}

/// The rows of a workbook.
#[cfg(feature = "workbook")]
#[derive(Default)]
struct Rows {
    fabrics: Vec<FabricRow>,
    predictions: Vec<PredictionRow>,
    problems: Vec<ProblemRow>,
}

/// What is kept of all fabrics together.
#[derive(Default)]
struct Kept {
    parity: Vec<ParityPoint>,
    re_extracted: Vec<ParityPoint>,
    drapes: Vec<DrapePoint>,
    /// Reports for the page that is being filled.
    reports: Vec<FabricReport>,
    /// Where pages begin, by the places of their fabrics; one if all of them are on the index.
    begin: Vec<usize>,
    /// The pages that are full.
    pages: Pages,
}

/// Where pages begin of fabrics whose records are so long.
fn pages_begin(lengths: impl Iterator<Item = usize>) -> Vec<usize> {
    let (mut begin, mut fabrics, mut length) = (Vec::new(), 0, 0);
    for (at, of_fabric) in lengths.enumerate() {
        let is_full = fabrics >= SHARING && length + of_fabric > LENGTH_OF_PAGE;
        if at == 0 || is_full || fabrics == FABRICS_OF_PAGE {
            begin.push(at);
            (fabrics, length) = (0, 0);
        }
        fabrics += 1;
        length += of_fabric;
    }
    begin
}

impl Results<'_, '_> {
    /// Writes everything that is about all fabrics; the tables for people.
    pub fn write(&self, job: &Job, observer: &Observer) -> Result<Vec<Columns>, Failure> {
        let mut lost = self.unread();
        let mut tables = self.begin()?;
        #[cfg(feature = "workbook")]
        {
            tables.workbook = self.settings.workbook.then(Rows::default);
        }
        self.add_problems(&mut tables)?;
        let mut overview = Overview::new(self.cases.iter().copied());
        let begin = pages_begin(self.made.iter().map(|made| made.length));
        let mut kept = Kept { begin, ..Kept::default() };
        let mut origins = Vec::new();
        for at in 0..self.made.len() {
            observer.go_on()?;
            let mut report = self.record(at)?.report;
            report.findings.iter().for_each(|finding| observer.found_in_batch(finding));
            tables.add(&report)?;
            report.unread = lost.remove(&report.name).unwrap_or_default();
            if let Some(failure) = report.unread.first().filter(|_| report.status == "ok") {
                report.status = failure.code.to_string();
            }
            if at < LISTED {
                overview.row(&report);
            }
            origins.push(OriginEntry { fabric: report.name.clone(), origin: report.origin() });
            self.keep(at, report, &mut kept)?;
        }
        let listed = LISTED.saturating_sub(self.made.len());
        for (at, (name, failures)) in lost.into_iter().enumerate() {
            let Some(failure) = failures.into_iter().next() else { continue };
            if at < listed {
                overview.unread(&name, &failure.code);
            }
            kept.reports.push(FabricReport::failed(&name, failure));
        }
        for own in self.own {
            own.findings().into_iter().for_each(|finding| observer.found_in_batch(finding));
        }
        let problems = self.finish(tables)?;
        self.write_document(job, origins)?;
        let benchmarks: Vec<Benchmark> = self.own.iter().filter_map(Own::benchmark).collect();
        let bracket = bracket(&kept.drapes);
        self.write_pages(kept, &benchmarks, problems)?;
        let checks = checks(benchmarks.iter().map(|b| b.result));
        Ok([Some(overview.table()), checks, bracket].into_iter().flatten().collect())
    }

    /// The record of a fabric.
    fn record(&self, at: usize) -> Result<Record, Failure> {
        record(self.folder, self.work, self.made, at)
    }

    /// What could not be read of each fabric.
    fn unread(&self) -> BTreeMap<String, Vec<Failure>> {
        let mut unread: BTreeMap<String, Vec<Failure>> = BTreeMap::new();
        for (fabric, failure) in self.work.unread() {
            unread.entry(fabric.to_string()).or_default().push(failure.clone());
        }
        unread
    }

    /// Rows of inputs that could not be read.
    pub fn unread_rows(&self) -> Vec<FabricRow> {
        self.work.unread().map(|(fabric, failure)| unread_row(fabric.to_string(), failure)).collect()
    }

    /// Rows of findings that belong to no fabric.
    pub fn problems_of_batch(&self) -> Vec<ProblemRow> {
        let findings = self.work.catalogue.findings.iter().chain(self.without_law);
        findings.map(|finding| problem_row(finding, "")).collect()
    }

    /// Rows of findings of cases with constants of their own.
    pub fn problems_of_own(&self) -> Vec<ProblemRow> {
        let rows = |own: &Own| -> Vec<ProblemRow> {
            own.findings().into_iter().map(|finding| problem_row(finding, &own.task.case.name)).collect()
        };
        self.own.iter().flat_map(rows).collect()
    }

    fn begin(&self) -> Result<Tables<'_>, Failure> {
        Ok(Tables {
            fabrics: self.folder.table("fabrics")?,
            predictions: self.folder.table("predictions")?,
            problems: self.folder.csv_table::<ProblemRow>("problems.csv")?,
            shown: Problems::default(),
            #[cfg(feature = "workbook")]
            workbook: None,
        })
    }

    /// What failed, and what was found of the batch: it comes first.
    fn add_problems(&self, tables: &mut Tables) -> Result<(), Failure> {
        let failed = self.failures.iter().map(Failure::row);
        failed.chain(self.problems_of_batch()).try_for_each(|row| tables.problem(row))
    }

    /// Writes what is about no fabric, and closes the tables; what the page shows of the problems.
    fn finish(&self, mut tables: Tables) -> Result<Problems, Failure> {
        self.unread_rows().iter().try_for_each(|row| tables.fabric(row))?;
        for own in self.own {
            own.rows().iter().try_for_each(|row| tables.prediction(row))?;
        }
        self.problems_of_own().into_iter().try_for_each(|row| tables.problem(row))?;
        #[cfg(feature = "workbook")]
        if let Some(Rows { fabrics, predictions, problems }) = &tables.workbook {
            let sheets = workbook::Tables { fabrics, predictions, problems };
            self.folder.write("results.xlsx", &workbook::workbook(&sheets)?)?;
        }
        tables.fabrics.commit()?;
        tables.predictions.commit()?;
        tables.problems.finish()?.commit()?;
        Ok(tables.shown)
    }

    /// Keeps what charts and pages need of the fabric at a place, and writes a page that is full.
    fn keep(&self, at: usize, report: FabricReport, kept: &mut Kept) -> Result<(), Failure> {
        if self.folder.charts() {
            kept.parity.extend(report.parity.iter().cloned());
            kept.re_extracted.extend(report.re_extracted.iter().cloned());
        }
        kept.drapes.extend(report.drapes.iter().cloned());
        kept.reports.push(report);
        let is_full = kept.begin.get(kept.pages.len() + 1) == Some(&(at + 1));
        if is_full { self.write_page_of_fabrics(kept) } else { Ok(()) }
    }

    fn write_page_of_fabrics(&self, kept: &mut Kept) -> Result<(), Failure> {
        let reports = std::mem::take(&mut kept.reports);
        let (name, number) = kept.pages.next();
        self.folder.write(
            &name,
            html(&fabrics_page(&reports, number, self.made.len(), self.settings.population.as_ref()))
                .as_bytes(),
        )?;
        kept.pages.add(name, &reports);
        Ok(())
    }

    fn write_pages(
        &self,
        mut kept: Kept,
        benchmarks: &[Benchmark],
        problems: Problems,
    ) -> Result<(), Failure> {
        let figures = self.write_parity(&kept)?;
        if !kept.pages.is_empty() && !kept.reports.is_empty() {
            self.write_page_of_fabrics(&mut kept)?;
        }
        let Kept { drapes, reports, begin, pages, .. } = kept;
        let fabrics = self.made.len();
        let names: Vec<&str> = (0..fabrics).map(|at| self.work.catalogue.name(at)).collect();
        let page_of = |at: usize| match pages.is_empty() {
            true => String::new(),
            false => name_of_page(begin.partition_point(|first| *first <= at)),
        };
        let problems = problems.groups(&names, page_of);
        let RunSettings { charts, formats, population, .. } = self.settings;
        let (formats, population) = (if *charts { formats.as_slice() } else { &[] }, population.as_ref());
        let unread = self.work.failures.len();
        let failed = [unread, self.failures.len().saturating_sub(unread)];
        let head = Head { fabrics, failed, figures, problems, drapes: &drapes, population, formats, pages };
        self.folder.write("index.html", html(&page(&reports, benchmarks, head)).as_bytes())
    }

    /// Charts over all fabrics.
    fn write_parity(&self, kept: &Kept) -> Result<Vec<Figure>, Failure> {
        let (folder, mut figures) = (self.folder, Vec::new());
        // The section is made of the measured value, so this is a closed loop and must say so.
        let subtitle = "closed loop: the measured stiffness through a simulated test (clamps, edges); both: one value for warp and weft together";
        let draw = || chart::parity(&kept.parity, "Simulated against measured", subtitle);
        if let Some(picture) = folder.chart("parity", draw)? {
            figures.push(figure("Simulated against measured stiffness", &picture));
        }
        figures.extend(write_friction_parity(folder, &kept.re_extracted)?);
        if let Some(picture) = write_drape_parity(folder, &kept.drapes)? {
            figures.push(figure("Simulated against measured drape", &picture));
        }
        Ok(figures)
    }

    fn write_document(&self, job: &Job, origins: Vec<OriginEntry>) -> Result<(), Failure> {
        let fabrics = &self.work.catalogue;
        let sources = (0..self.made.len()).flat_map(|at| match self.record(at) {
            Ok(record) => record.sources.into_iter().map(Ok::<Source, Failure>).collect(),
            Err(failure) => vec![Err(failure)],
        });
        let stated = (0..fabrics.len()).map(|at| fabrics.path(at).join("fabric.toml"));
        let stated = stated.filter(|path| files::is_file(path)).map(|path| Ok(FileEntry::of(&path)));
        self.folder.stream(
            "run.json",
            &document(job, self.settings, self.cases.iter().copied(), sources, stated, origins),
        )
    }
}

/// The record of a fabric of a run.
pub(super) fn record(folder: &Folder, work: &RunWork, made: &[Made], at: usize) -> Result<Record, Failure> {
    if let Some(held) = &made[at].held {
        return Ok((**held).clone());
    }
    let name = work.catalogue.name(at);
    Record::read(folder.sink(), name)?.ok_or_else(|| {
        Failure::new("O064", format!("the record of {name} was changed while the run was going on"))
            .hint("run again when nothing else writes into the folder of results")
    })
}

impl Tables<'_> {
    fn add(&mut self, report: &FabricReport) -> Result<(), Failure> {
        report.rows.iter().try_for_each(|row| self.fabric(row))?;
        report.predictions.iter().try_for_each(|row| self.prediction(row))?;
        self.shown.speak_against(report.doubted());
        report.problems().try_for_each(|row| self.problem(row))
    }

    fn fabric(&mut self, row: &FabricRow) -> Result<(), Failure> {
        #[cfg(feature = "workbook")]
        self.workbook.iter_mut().for_each(|rows| rows.fabrics.push(row.clone()));
        self.fabrics.row(row)
    }

    fn prediction(&mut self, row: &PredictionRow) -> Result<(), Failure> {
        #[cfg(feature = "workbook")]
        self.workbook.iter_mut().for_each(|rows| rows.predictions.push(row.clone()));
        self.predictions.row(row)
    }

    fn problem(&mut self, row: ProblemRow) -> Result<(), Failure> {
        self.problems.row(&row)?;
        self.shown.add(&row);
        #[cfg(feature = "workbook")]
        self.workbook.iter_mut().for_each(|rows| rows.problems.push(row.clone()));
        Ok(())
    }
}

fn figure(caption: &str, picture: &str) -> Figure {
    let alt = format!("{caption}: one point a fabric and parameter, on the line where both are equal.");
    Figure { caption: caption.into(), alt, picture: picture.into(), kind: FigureKind::Overview }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_so_many_fabrics_and_not_more_than_so_much_of_them() {
        let begin = |lengths: &[usize]| pages_begin(lengths.iter().copied());
        assert_eq!(begin(&[]), [0usize; 0]);
        assert_eq!(begin(&[10; FABRICS_OF_PAGE]), [0]);
        assert_eq!(begin(&[10; 2 * FABRICS_OF_PAGE + 1]), [0, FABRICS_OF_PAGE, 2 * FABRICS_OF_PAGE]);
        let long = LENGTH_OF_PAGE / 50;
        assert_eq!(begin(&[long; 101]), [0, 50, 100]);
        assert_eq!(begin(&[LENGTH_OF_PAGE; 41]), [0, SHARING]);
    }
}
