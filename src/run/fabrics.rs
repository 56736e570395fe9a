//! Every fabric with its cases: read, evaluated, simulated, written and dropped, one at a time on each thread.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use serde_json::json;

use super::settings::RunSettings;
use super::tally::CaseTally;
use super::work::RunWork;
use crate::case::{Case, Outline};
use crate::finding::{Finding, Place};
use crate::platform::{files, map_several};
use crate::report::number::counted;
use crate::results::{
    Fabric, FabricReport, Failure, FileEntry, Folder, Job, Observer, Record, Shared, Task, hash_of,
    is_within, named_fabric, without_fabric, without_law,
};

/// What is known of a fabric once its files are written.
pub(super) struct Made {
    pub failures: Vec<Failure>,
    pub is_useful: bool,
    pub fails_a_check: bool,
    /// Whether an earlier run had made it.
    pub resumed: bool,
    /// Whether another run of the same would find nothing more.
    pub is_final: bool,
    /// How long its record is (bytes): what it takes on a page.
    pub length: usize,
    /// What could not be written, for JSON cannot hold it.
    pub held: Option<Box<Record>>,
}

/// What the fabrics are to a case.
#[derive(Default)]
struct Tally {
    suits_any: bool,
    lacked_by_any: bool,
    tasks: usize,
    /// Fabrics that it is for, and that have no law, by their places.
    without: BTreeMap<usize, String>,
}

/// A case with what all of its tasks share.
struct CaseWork<'c> {
    case: &'c Case,
    shared: Arc<Shared<'c>>,
    /// The fabric that it names.
    named: Option<PathBuf>,
    /// Hash of what it says, and of its mesh.
    key: String,
    tally: Mutex<Tally>,
}

/// The work on all fabrics.
pub(super) struct Workshop<'c> {
    work: &'c RunWork,
    folder: &'c Folder<'c>,
    observer: &'c Observer<'c>,
    /// Cases without constants of their own.
    jobs: Vec<CaseWork<'c>>,
    /// Hash of program and settings.
    base: String,
    fresh: bool,
    with_fields: bool,
    /// Why the results cannot be written: what is still to do is left, for that reason.
    ended: OnceLock<Failure>,
}

impl<'c> Workshop<'c> {
    /// Nothing is made yet.
    pub fn new(
        (job, settings): (&Job, &RunSettings),
        work: &'c RunWork,
        folder: &'c Folder<'c>,
        observer: &'c Observer<'c>,
    ) -> Result<Self, Failure> {
        let of_fabrics = work.cases.iter().filter(|case| case.section().is_none());
        let jobs = of_fabrics.map(|case| CaseWork::new(case, work)).collect::<Result<_, _>>()?;
        let base = json!({
            "record": 3,
            "program": settings.program.as_deref().unwrap_or(env!("CARGO_PKG_VERSION")),
            "charts": settings.charts,
            "formats": settings.formats.iter().map(|format| format.ending()).collect::<Vec<_>>(),
            "bom": settings.bom,
            "evaluation": job.reading.entry(),
        });
        Ok(Self {
            work,
            folder,
            observer,
            jobs,
            base: hash_of(&base)?,
            fresh: settings.fresh,
            with_fields: folder.fields(),
            ended: OnceLock::new(),
        })
    }

    /// Makes every fabric, in parallel; in name order.
    pub fn run(&self) -> Result<Vec<Made>, Failure> {
        let fabrics = &self.work.catalogue;
        let mine = |at: usize| self.jobs.iter().filter(move |job| job.is_for(self.work, at));
        let stages = |at: usize| mine(at).map(|job| job.task(None).stages()).sum::<usize>();
        let steps = (0..fabrics.len()).map(|at| 1 + stages(at)).sum();
        let what = if steps > fabrics.len() { "fabrics and stages of their cases" } else { "fabrics" };
        // Of thousands of fabrics there are as many results: a failure that is large is kept elsewhere.
        let made = self
            .observer
            .part(what, steps, || map_several(fabrics.units(), |unit| self.unit(unit).map_err(Box::new)))?;
        let mut all = Vec::with_capacity(fabrics.len());
        for unit in made {
            all.extend(unit.map_err(|failure| *failure)?);
        }
        Ok(all)
    }

    /// The fabrics that are read together.
    fn unit(&self, unit: Range<usize>) -> Result<Vec<Made>, Failure> {
        let finished: Vec<_> = unit.clone().map(|at| self.finished(at)).collect::<Result<_, _>>()?;
        if finished.iter().all(Option::is_some) {
            return Ok(finished.into_iter().flatten().collect());
        }
        self.go_on()?;
        let fabrics = self.work.catalogue.fabrics(unit.clone()).into_iter();
        let all = unit.zip(fabrics).zip(finished).collect();
        let made = map_several(all, |((at, fabric), finished)| {
            if let Some(made) = finished {
                return Ok(made);
            }
            self.go_on()?;
            let made = self.make(at, fabric);
            if let Err(failure) = &made {
                self.ended.get_or_init(|| failure.clone());
            }
            self.observer.step();
            made
        });
        let mut made: Vec<Made> = made.into_iter().collect::<Result<_, _>>()?;
        // What is collected in the place of fabrics keeps their room.
        made.shrink_to_fit();
        Ok(made)
    }

    /// The failure of another fabric that ended the run, or that it was cancelled.
    fn go_on(&self) -> Result<(), Failure> {
        self.ended.get().map_or_else(|| self.observer.go_on(), |failure| Err(failure.clone()))
    }

    /// Hash of all that the results of a fabric depend on.
    fn key(&self, at: usize, with_fields: bool) -> Result<String, Failure> {
        let fabrics = &self.work.catalogue;
        let cases = self.jobs.iter().filter(|job| job.is_for(self.work, at)).map(|job| &job.key);
        hash_of(&json!({
            "base": self.base,
            "fabric": fabrics.name(at),
            "inputs": fabrics.inputs(at),
            "cases": cases.collect::<Vec<_>>(),
            "fields": with_fields,
        }))
    }

    /// A fabric that an earlier run has made of the same inputs; fields that are not wanted do no harm.
    fn finished(&self, at: usize) -> Result<Option<Made>, Failure> {
        if self.fresh {
            return Ok(None);
        }
        let (sink, name) = (self.folder.sink(), self.work.catalogue.name(at));
        let mut found = Record::finished(sink, name, &self.key(at, self.with_fields)?)?;
        if found.is_none() && !self.with_fields {
            found = Record::finished(sink, name, &self.key(at, true)?)?;
        }
        Ok(found.map(|record| {
            self.count(at, &record);
            self.observer.step();
            Made { resumed: true, ..Made::of(&record) }
        }))
    }

    fn make(&self, at: usize, fabric: Result<Fabric, Failure>) -> Result<Made, Failure> {
        let fabrics = &self.work.catalogue;
        let fabric = match fabric {
            Ok(fabric) => fabric,
            Err(failure) => {
                let report = FabricReport::failed(fabrics.name(at), failure);
                let record = Record::new("", Vec::new(), Vec::new(), Default::default(), report);
                return Ok(Made { held: Some(Box::new(record.clone())), ..Made::of(&record) });
            }
        };
        Record::begin(self.folder.sink(), &fabric.sheet.name)?;
        let names = |wanted: &dyn Fn(&Case) -> bool| -> Vec<String> {
            self.jobs.iter().filter(|job| wanted(job.case)).map(|job| job.case.name.clone()).collect()
        };
        let of_cases =
            [names(&|case| case.suits(&fabric.sheet)), names(&|case| case.lacks_law(&fabric.sheet))];
        let mine = self.jobs.iter().filter(|job| job.is_for(self.work, at) && job.case.suits(&fabric.sheet));
        let tasks: Vec<Task> = mine.map(|job| job.task(Some(&fabric))).collect();
        let folder = self.folder.listing();
        let report = FabricReport::new(&fabric, &tasks, &folder, self.observer);
        drop(tasks);
        self.observer.go_on()?;
        let key = self.key(at, self.with_fields)?;
        let record = Record::new(&key, folder.into_names(), fabric.sheet.sources, of_cases, report);
        self.count(at, &record);
        let (made, length) = (Made::of(&record), record.write(self.folder.sink())?);
        let held = length.is_none().then(|| Box::new(record));
        Ok(Made { length: length.unwrap_or_default(), held, ..made })
    }

    /// Counts what a fabric is to the cases.
    fn count(&self, at: usize, record: &Record) {
        for job in &self.jobs {
            let (suits, lacks) =
                (record.suited.contains(&job.case.name), record.lacking.contains(&job.case.name));
            let is_for = job.is_for(self.work, at);
            let mut tally = job.tally();
            tally.suits_any |= suits;
            tally.lacked_by_any |= lacks;
            tally.tasks += usize::from(is_for && suits);
            if is_for && lacks {
                tally.without.insert(at, record.report.name.clone());
            }
        }
    }

    /// What is to be said of fabrics without the law that a case needs.
    pub fn without_law(&self) -> Vec<Finding> {
        let names = |job: &CaseWork| job.tally().without.values().cloned().collect();
        self.jobs.iter().filter_map(|job| without_law(job.case, names(job))).collect()
    }

    /// Says for how many fabrics a drape was made quick.
    pub fn tell_of_quick_drapes(&self) {
        let all = self.work.catalogue.len();
        for job in self.jobs.iter().filter(|job| all > 0 && job.case.is_quick()) {
            let hung = job.tally().tasks;
            self.observer.note(&format!(
                "{}: quick drapes for {hung} of {}, those with measured curves; --drape makes the whole of \
                 the case for every fabric",
                job.case.path.display(),
                counted(all, "fabric")
            ));
        }
    }

    /// What the fabrics are to each case.
    pub fn tallies(&self) -> Vec<CaseTally> {
        self.jobs.iter().map(CaseWork::case_tally).collect()
    }

    /// The cases that a batch of these fabrics is for: one for FAB records or laws is nothing to fabrics without them,
    /// and a drape that nobody asked for nothing to fabrics without curves.
    pub fn suitable(&self) -> Vec<&'c Case> {
        let some_fabrics = self.work.catalogue.len() > 0;
        let left_out = |case: &Case| {
            let job = self.jobs.iter().find(|job| std::ptr::eq(job.case, case));
            job.is_some_and(|job| {
                let tally = job.tally();
                let may_suit_none = case.is_for_fab_records() || tally.lacked_by_any;
                (may_suit_none || case.is_quick() && some_fabrics) && !tally.suits_any
            })
        };
        self.work.cases.iter().filter(|case| !left_out(case)).collect()
    }

    /// Of the suitable cases, those that found no fabric.
    pub fn without_fabric(&self, suitable: &[&Case]) -> Vec<Failure> {
        let idle = |job: &&CaseWork| {
            let is_there = job.named.as_ref().is_none_or(|path| files::exists(path));
            is_there && job.tally().tasks == 0 && suitable.iter().any(|case| std::ptr::eq(*case, job.case))
        };
        let failure = |job: &CaseWork| without_fabric(job.case, !job.tally().without.is_empty());
        self.jobs.iter().filter(idle).map(failure).collect()
    }
}

/// Hash of what a case says, and of its mesh.
pub(crate) fn key_of_case(case: &Case) -> Result<String, Failure> {
    let mesh = case.sheet().and_then(|problem| match &problem.sheet.outline {
        Outline::File { path, .. } => Some(FileEntry::of(&case.path.with_file_name("").join(path))),
        Outline::Drawn(drawn) => Some(FileEntry::of(&case.path.with_file_name("").join(&drawn.path))),
        Outline::Rectangle { .. } | Outline::Disc { .. } | Outline::Annulus(_) => None,
    });
    hash_of(&json!({ "case": format!("{case:?}"), "mesh": mesh }))
}

impl Made {
    fn of(record: &Record) -> Self {
        let FabricReport { failures, is_useful, fails_a_check, .. } = &record.report;
        Self {
            failures: failures.clone(),
            is_useful: *is_useful,
            fails_a_check: *fails_a_check,
            resumed: false,
            is_final: record.is_final(),
            length: record.length,
            held: None,
        }
    }
}

impl<'c> CaseWork<'c> {
    fn new(case: &'c Case, work: &RunWork) -> Result<Self, Failure> {
        let key = key_of_case(case)?;
        let shared = Arc::new(Shared::new(work.threads_of_task(), work.limits));
        Ok(Self { case, shared, named: named_fabric(case), key, tally: Mutex::default() })
    }

    /// Whether the case is for a fabric, if that has what it needs.
    fn is_for(&self, work: &RunWork, at: usize) -> bool {
        self.named.as_ref().is_none_or(|named| is_within(work.catalogue.path(at), named))
    }

    fn task<'f>(&self, fabric: Option<&'f Fabric>) -> Task<'f, 'c> {
        Task::new(self.case, fabric, Arc::clone(&self.shared))
    }

    fn tally(&self) -> MutexGuard<'_, Tally> {
        self.tally.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What the fabrics are to the case.
    fn case_tally(&self) -> CaseTally {
        let tally = self.tally();
        CaseTally {
            name: self.case.name.clone(),
            place: Place::file(&self.case.path),
            is_for_fab_records: self.case.is_for_fab_records(),
            is_there: self.named.as_ref().is_none_or(|path| files::exists(path)),
            suits_any: tally.suits_any,
            lacked_by_any: tally.lacked_by_any,
            tasks: tally.tasks,
            without: tally.without.values().cloned().collect(),
        }
    }
}
