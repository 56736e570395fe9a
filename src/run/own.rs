//! Cases with constants of their own, and what they gave.

use std::sync::Arc;

use super::work::RunWork;
use crate::finding::Finding;
use crate::platform::map_several;
use crate::report::html::Figure;
use crate::report::table::PredictionRow;
use crate::results::{Benchmark, Failure, Folder, Observer, Outcome, Share, Shared, Task, simulate};

/// A case with constants of its own, and what it gave.
pub(super) struct Own<'w> {
    pub task: Task<'w, 'w>,
    outcome: Result<(Outcome, Vec<Figure>), Failure>,
}

/// Simulates them all, and writes their files.
pub(super) fn own_cases<'w>(
    work: &'w RunWork,
    folder: &Folder,
    observer: &Observer,
) -> Result<Vec<Own<'w>>, Failure> {
    // They are for no fabric: one share has them.
    let is_mine = work.share.is_none_or(Share::speaks_for_all);
    let own = work.cases.iter().filter(|case| is_mine && case.section().is_some() && case.has_sheet());
    let task = |case| Task::new(case, None, Arc::new(Shared::new(work.threads_of_task(), work.limits)));
    let own: Vec<Task> = own.map(task).collect();
    let steps = own.iter().map(|task| task.stages() + 1).sum();
    observer.part("cases", steps, || {
        map_several(own, |task| {
            let outcome = observer.go_on().and_then(|()| simulate(&task, observer)).and_then(|outcome| {
                let figures = outcome.write(&task, folder)?;
                Ok((outcome, figures))
            });
            observer.step();
            Own { task, outcome }
        })
    })
}

impl<'w> Own<'w> {
    fn outcome(&self) -> Option<&Outcome> {
        self.outcome.as_ref().ok().map(|(outcome, _)| outcome)
    }

    pub fn failures(&self) -> Vec<Failure> {
        match &self.outcome {
            Ok((outcome, _)) => outcome.failures(&self.task),
            Err(failure) => vec![failure.clone()],
        }
    }

    pub fn findings(&self) -> Vec<&Finding> {
        self.outcome().map_or_else(Vec::new, |outcome| outcome.findings(&self.task))
    }

    pub fn rows(&self) -> Vec<PredictionRow> {
        self.outcome().map_or_else(Vec::new, |outcome| outcome.rows(&self.task))
    }

    pub fn is_useful(&self) -> bool {
        self.outcome().is_some_and(Outcome::is_useful)
    }

    pub fn fails_a_check(&self) -> bool {
        self.outcome().is_some_and(Outcome::fails_a_check)
    }

    pub fn benchmark(&self) -> Option<Benchmark<'_, 'w>> {
        let (_, figures) = self.outcome.as_ref().ok()?;
        Some(Benchmark { task: &self.task, result: self.outcome()?.solved()?, figures })
    }
}
