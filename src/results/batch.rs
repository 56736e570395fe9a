//! Cases of one kind, solved or compared.

use super::draped;
use super::failure::Failure;
use super::folder::Folder;
use super::observer::Observer;
use super::outcome::{Document, Entries, Outcome, text};
use super::simulate::simulate;
use super::task::Task;
use super::work::{Work, findings};
use crate::platform::map_several;
use crate::study::Case;

/// Which cases are done together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BatchKind {
    /// Those with a `[sheet]`.
    Solve,
    /// Those with a `[virtual_test]` or a `[bending_test]`.
    Compare,
}

impl BatchKind {
    fn includes(self, case: &Case) -> bool {
        match self {
            Self::Solve => case.has_sheet(),
            Self::Compare => !case.has_sheet(),
        }
    }

    /// What goes on, for the observer.
    fn activity(self) -> &'static str {
        match self {
            Self::Solve => "solving",
            Self::Compare => "simulating",
        }
    }

    /// O055: there is no case of the kind.
    fn nothing(self) -> Failure {
        let (text, hint) = match self {
            Self::Solve => (
                "there is no case with a [sheet] in the inputs",
                "name a case file; a [virtual_test] or a [bending_test] belongs to `kesf compare`",
            ),
            Self::Compare => (
                "there is no case with a [virtual_test] or a [bending_test] in the inputs",
                "name a case file; a [sheet] belongs to `kesf solve`",
            ),
        };
        Failure::new("O055", text).hint(hint)
    }
}

/// The outcomes of the cases of one kind.
pub struct Batch<'w> {
    kind: BatchKind,
    /// Every task with what it gave.
    pub tasks: Vec<(Task<'w, 'w>, Result<Outcome, Failure>)>,
    /// What failed, of inputs and of tasks.
    pub failures: Vec<Failure>,
}

impl<'w> Batch<'w> {
    /// Simulates every case of the kind with every fabric it is for, and writes the files into `folder` if there is
    /// one. What fails and what is found goes to the observer.
    ///
    /// # Errors
    /// O055 if there is no such case, O054 if the work was cancelled, and those of charts over all fabrics.
    pub fn simulate(
        work: &'w mut Work,
        kind: BatchKind,
        folder: Option<&Folder>,
        observer: &Observer,
    ) -> Result<Self, Failure> {
        work.cases.retain(|case| kind.includes(case));
        let work: &'w Work = work;
        let (tasks, mut failures) = work.tasks();
        for finding in work.cases.iter().filter_map(|case| work.without_law(case)) {
            observer.found(None, &finding);
        }
        work.idle(&tasks).iter().for_each(|text| observer.note(text));
        if tasks.is_empty() && failures.is_empty() && work.failures.is_empty() {
            return Err(kind.nothing());
        }
        let steps = tasks.len() + tasks.iter().map(Task::stages).sum::<usize>();
        let tasks = observer.part(kind.activity(), steps, || {
            map_several(tasks, |task| {
                let outcome = simulate_and_write(&task, folder, observer);
                observer.step();
                (task, outcome)
            })
        })?;
        for (task, outcome) in &tasks {
            match outcome {
                Ok(outcome) => {
                    failures.extend(outcome.failures(task).into_iter().chain(outcome.nothing(task)))
                }
                Err(failure) => failures.push(failure.clone()),
            }
        }
        failures.iter().for_each(|failure| observer.failed(failure));
        failures.extend(work.failures.iter().cloned());
        let batch = Self { kind, tasks, failures };
        batch.tell_findings(observer);
        if let Some(folder) = folder {
            let points: Vec<_> = batch.outcomes().filter_map(|(task, o)| o.drape_point(task)).collect();
            draped::write_parity(folder, &points)?;
        }
        Ok(batch)
    }

    fn tell_findings(&self, observer: &Observer) {
        for (fabric, finding) in findings(self.tasks.iter().map(|(task, _)| task)) {
            observer.found(Some(&fabric), &finding);
        }
        for (task, outcome) in self.outcomes() {
            for finding in outcome.findings(task) {
                observer.found(task.fabric_name(), finding);
            }
        }
    }

    /// The tasks that gave something.
    pub fn outcomes(&self) -> impl Iterator<Item = (&Task<'w, 'w>, &Outcome)> {
        self.tasks.iter().filter_map(|(task, outcome)| Some((task, outcome.as_ref().ok()?)))
    }

    /// `kesf.solution/1` or `kesf.comparison/1`, timings included.
    pub fn document(&self) -> Document {
        let (mut solutions, mut comparisons) = (Vec::new(), Vec::new());
        for (task, outcome) in self.outcomes() {
            match outcome.entries(task, true) {
                Entries::Solutions(entries) => solutions.extend(entries),
                Entries::Comparisons(entries) => comparisons.extend(entries),
            }
        }
        match self.kind {
            BatchKind::Solve => Document::solutions(solutions),
            BatchKind::Compare => Document::comparisons(comparisons),
        }
    }

    /// The outcomes for people; with `verbose` every step of a search, and what each solution took.
    pub fn text(&self, verbose: bool) -> String {
        text(&self.outcomes().collect::<Vec<_>>(), verbose)
    }

    /// How many outcomes are useful.
    pub fn useful(&self) -> usize {
        self.outcomes().filter(|(_, outcome)| outcome.is_useful()).count()
    }

    /// Whether a check of a case does not hold.
    pub fn fails_a_check(&self) -> bool {
        self.outcomes().any(|(_, outcome)| outcome.fails_a_check())
    }
}

fn simulate_and_write(task: &Task, folder: Option<&Folder>, observer: &Observer) -> Result<Outcome, Failure> {
    observer.go_on()?;
    let outcome = simulate(task, observer)?;
    if let Some(folder) = folder {
        outcome.write(task, folder)?;
    }
    Ok(outcome)
}
