//! What a task gives, whatever its kind: the one place that tells the kinds apart.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::bent::{self, BendingEntry};
use super::columns::Columns;
use super::complete::Complete;
use super::deflected::{Deflected, PageSheet};
use super::draped::{self, DrapeEntry, DrapePoint};
use super::failure::Failure;
use super::folder::Folder;
use super::judged;
use super::rests_on::{self, Ground};
use super::sampled;
use super::solved::{self, SolutionEntry};
use super::task::Task;
use super::tested::{self, TestEntry, Tested};
use super::work;
use crate::constitutive::MeasuredInput;
use crate::fields::curvatures_moved;
use crate::finding::Finding;
use crate::quantity::significant;
use crate::report::chart::ParityPoint;
use crate::report::html::{Figure, FigureKind};
use crate::report::json::FindingEntry;
use crate::report::table::PredictionRow;
use crate::study::bending::BendingResult;
use crate::study::{CaseResult, Drape, Status, StudyError};

/// Most values that are told with a picture.
const VALUES_SEEN: usize = 4;

/// The result of a task.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// Of a case with a `[sheet]`.
    Solved(Box<CaseResult>),
    /// Of a drape.
    Draped(Box<Drape>),
    /// Of a `[virtual_test]`, one a direction.
    Tested(Vec<Tested>),
    /// Of a `[bending_test]`, with the directions that gave nothing.
    Bent(BendingResult, Vec<Failure>),
}

/// A document with the outcome of a task or of several.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Document {
    /// Of cases with a sheet.
    Solutions(SolutionDocument),
    /// Of tests.
    Comparisons(ComparisonDocument),
}

/// `kesf.solution/1`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SolutionDocument {
    #[cfg_attr(test, schemars(extend("const" = "kesf.solution/1")))]
    schema: Cow<'static, str>,
    /// One a task.
    solutions: Vec<Solution>,
}

/// `kesf.comparison/1`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ComparisonDocument {
    #[cfg_attr(test, schemars(extend("const" = "kesf.comparison/1")))]
    schema: Cow<'static, str>,
    /// One a direction.
    comparisons: Vec<ComparisonEntry>,
}

/// An entry of `kesf.solution/1`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Solution {
    /// A solved case.
    Solved(Box<SolutionEntry>),
    /// A drape.
    Draped(Box<DrapeEntry>),
}

/// An entry of `kesf.comparison/1`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum ComparisonEntry {
    /// A simulated KES test.
    Tested(Box<TestEntry>),
    /// A bending test.
    Bent(Box<BendingEntry>),
}

impl Document {
    /// `kesf.solution/1`.
    pub(super) fn solutions(solutions: Vec<Solution>) -> Self {
        Self::Solutions(SolutionDocument { schema: "kesf.solution/1".into(), solutions })
    }

    /// `kesf.comparison/1`.
    pub(super) fn comparisons(comparisons: Vec<ComparisonEntry>) -> Self {
        Self::Comparisons(ComparisonDocument { schema: "kesf.comparison/1".into(), comparisons })
    }
}

/// Entries of a document; an outcome has those of one kind.
pub(super) enum Entries {
    Solutions(Vec<Solution>),
    Comparisons(Vec<ComparisonEntry>),
}

impl Outcome {
    /// Its entries; with `timings`, what differs from run to run too.
    pub(super) fn entries(&self, task: &Task, timings: bool) -> Entries {
        match self {
            Self::Solved(result) => {
                let grounds = solved::all_grounds(task, result);
                let entry = solved::entry(task, result, grounds, timings);
                Entries::Solutions(vec![Solution::Solved(Box::new(entry))])
            }
            Self::Draped(drape) => {
                Entries::Solutions(vec![Solution::Draped(Box::new(draped::entry(task, drape)))])
            }
            Self::Tested(tested) => {
                let entries = tested.iter().map(|t| Box::new(tested::entry(task, t)));
                Entries::Comparisons(entries.map(ComparisonEntry::Tested).collect())
            }
            Self::Bent(result, _) => {
                let entries = bent::entries(task, result).into_iter().map(Box::new);
                Entries::Comparisons(entries.map(ComparisonEntry::Bent).collect())
            }
        }
    }

    /// The document of the task.
    pub fn document(&self, task: &Task) -> Document {
        match self.entries(task, false) {
            Entries::Solutions(entries) => Document::solutions(entries),
            Entries::Comparisons(entries) => Document::comparisons(entries),
        }
    }

    /// The same with what a reader of it must know, of the fabric and its section too, and with what gave nothing.
    fn complete(&self, task: &Task) -> Complete<Document> {
        let name = task.fabric_name();
        let of_fabric = work::findings(std::iter::once(task)).into_iter();
        let findings = of_fabric.map(|(fabric, finding)| FindingEntry::new(Some(&fabric), &finding));
        let own = self.findings(task).into_iter().map(|finding| FindingEntry::new(name, finding));
        Complete {
            document: self.document(task),
            findings: Some(findings.chain(own).collect()),
            failures: self.failures(task).iter().map(Failure::entry).collect(),
        }
    }

    /// Rows of `predictions.csv`, with the bands that were sampled and with what speaks against them.
    pub fn rows(&self, task: &Task) -> Vec<PredictionRow> {
        let mut rows = self.values(task);
        sampled::fill(&mut rows, task);
        judged::fill(&mut rows, task, self);
        rows
    }

    /// What was simulated, beside what was measured.
    fn values(&self, task: &Task) -> Vec<PredictionRow> {
        match self {
            Self::Solved(result) => solved::rows(task, result),
            Self::Draped(drape) => draped::rows(task, drape),
            Self::Tested(tested) => tested.iter().flat_map(|t| tested::rows(task, t)).collect(),
            Self::Bent(result, _) => bent::rows(task, result),
        }
    }

    /// Writes the files of the task: its document, fields and charts. Returns the charts.
    ///
    /// # Errors
    /// Those of the encoders and of the folder.
    pub fn write(&self, task: &Task, folder: &Folder) -> Result<Vec<Figure>, Failure> {
        let stem = task.stem();
        folder.json(&format!("{stem}.json"), &self.complete(task))?;
        if let Some(sheet) = self.deflected(task).filter(|_| folder.fields()) {
            sheet.write(folder)?;
        }
        let drawn = match self {
            Self::Solved(result) => solved::write(task, result, folder)?,
            Self::Draped(drape) => draped::write(task, drape, folder)?,
            Self::Tested(tested) => tested::write_chart(task, tested, folder)?.into_iter().collect(),
            Self::Bent(result, _) => bent::write_charts(task, result, folder)?,
        };
        let kind = self.figure_kind(task);
        let figure = |picture: String| Figure {
            caption: task.case.title.clone(),
            alt: self.seen(task, &picture),
            picture,
            kind,
        };
        Ok(drawn.into_iter().map(figure).collect())
    }

    /// What it rests on that is not to be relied on, each once.
    fn grounds(&self, task: &Task) -> Vec<Ground> {
        match self {
            Self::Solved(result) => solved::all_grounds(task, result),
            Self::Draped(_) => draped::grounds(task, &rests_on::known(task)),
            Self::Tested(tested) => rests_on::each_once(tested.iter().flat_map(|t| t.grounds.clone())),
            Self::Bent(result, _) => bent::all_grounds(task, result),
        }
    }

    /// What one of its quantities rests on that is not to be relied on.
    pub(super) fn grounds_of(&self, task: &Task, inputs: &[MeasuredInput], quantity: &str) -> Vec<Ground> {
        match self {
            Self::Solved(result) => solved::grounds(result, inputs, quantity),
            Self::Draped(_) => draped::grounds(task, inputs),
            Self::Tested(_) => rests_on::grounds(inputs, quantity),
            Self::Bent(result, _) => rests_on::grounds(inputs, &bent::shown_most(result, quantity)),
        }
    }

    /// Of a case with a `[sheet]`.
    pub fn solved(&self) -> Option<&CaseResult> {
        match self {
            Self::Solved(result) => Some(result),
            Self::Draped(_) | Self::Tested(_) | Self::Bent(..) => None,
        }
    }

    /// What its charts are of.
    fn figure_kind(&self, task: &Task) -> FigureKind {
        if task.fabric.is_none() {
            return FigureKind::Benchmark;
        }
        match self {
            Self::Draped(_) => FigureKind::Drape,
            Self::Bent(..) => FigureKind::Cantilever,
            // A strip that bends far, as in the test.
            Self::Solved(result) if result.path.is_some() => FigureKind::Cantilever,
            Self::Solved(_) => FigureKind::Plate,
            Self::Tested(_) => FigureKind::Test,
        }
    }

    /// What is seen in one of its charts, for readers who do not see it.
    fn seen(&self, task: &Task, picture: &str) -> String {
        let what = match self {
            Self::Draped(_) if picture.contains("_view.") => "the draped sheet from the side",
            Self::Draped(_) => "the shadow of the draped sheet from above",
            Self::Bent(..) => "the shape of a strip under its own weight",
            Self::Solved(_) if picture.contains("-history.") => "displacements and energies along the way",
            Self::Solved(result) if result.lies_in_its_plane() => "the displacements of a sheet",
            Self::Solved(_) => "the deflection of a sheet",
            Self::Tested(_) => "the simulated test beside the measured curves",
        };
        let fabric = task.fabric_name().map_or(String::new(), |name| format!(", {name}"));
        let described = |row: &PredictionRow| {
            let unit = if row.unit == "1" { String::new() } else { format!(" {}", row.unit) };
            let number = |v: f64| if v.fract() == 0.0 { v.to_string() } else { significant(v) };
            // Who counts nodes of a drape counts its folds.
            let name =
                if row.quantity == "drape_nodes" { "folds".into() } else { row.quantity.replace('_', " ") };
            row.simulated.map(|v| format!("{name} {}{unit}", number(v)))
        };
        let values: Vec<String> = self.values(task).iter().filter_map(described).take(VALUES_SEEN).collect();
        let values = if values.is_empty() { String::new() } else { format!("; {}", values.join(", ")) };
        format!("{}{fabric}: {what}{values}.", task.case.title)
    }

    /// The sheet before and after.
    fn deflected(&self, task: &Task) -> Option<Deflected> {
        match self {
            Self::Solved(result) => solved::deflected(task, result),
            Self::Draped(drape) => Some(draped::deflected(task, drape)),
            Self::Tested(_) | Self::Bent(..) => None,
        }
    }

    /// What the page shows of the sheet.
    pub(super) fn shape(&self, task: &Task) -> Result<Option<PageSheet>, Failure> {
        let Some(sheet) = self.deflected(task) else { return Ok(None) };
        match self {
            Self::Solved(result) => {
                let fields = result.element_means().and_then(|all| Ok((all, result.curvatures()?)));
                let (resultants, curvatures) = fields.map_err(StudyError::from)?;
                sheet.shape(false, &resultants, &curvatures).map(Some)
            }
            Self::Draped(drape) => {
                let curvatures = curvatures_moved(&drape.model, &drape.solution.state);
                sheet.shape(true, &drape.resultants, &curvatures.map_err(StudyError::from)?).map(Some)
            }
            Self::Tested(_) | Self::Bent(..) => Ok(None),
        }
    }

    /// What a reader of the outcome must know.
    pub fn findings<'o>(&'o self, task: &'o Task) -> Vec<&'o Finding> {
        let of_sampling = task.sampling().into_iter().flat_map(|s| &s.findings);
        match self {
            Self::Solved(result) => solved::findings(result).chain(of_sampling).collect(),
            Self::Draped(drape) => drape.findings.iter().chain(of_sampling).collect(),
            Self::Tested(_) | Self::Bent(..) => of_sampling.collect(),
        }
    }

    /// What failed within it.
    pub fn failures(&self, task: &Task) -> Vec<Failure> {
        match self {
            Self::Solved(result) => solved::unconverged(task, result).into_iter().collect(),
            Self::Draped(_) | Self::Tested(_) => Vec::new(),
            Self::Bent(_, failures) => failures.clone(),
        }
    }

    /// O055: a test that the fabric has nothing for; in a batch of many fabrics it is left out.
    pub fn nothing(&self, task: &Task) -> Option<Failure> {
        let Self::Tested(tested) = self else { return None };
        let text = "there is nothing to simulate";
        let hint = "compression takes T0 and Tm of the fabric, T0 the larger of both: add KES-FB3 records, or both to a result table";
        tested.is_empty().then(|| task.located(Failure::new("O055", text).hint(hint)))
    }

    /// Whether it holds anything to go on with.
    pub fn is_useful(&self) -> bool {
        match self {
            Self::Solved(result) => result.status != Status::NotConverged,
            Self::Draped(_) => true,
            Self::Tested(tested) => !tested.is_empty(),
            Self::Bent(result, failures) => failures.is_empty() || !result.is_empty(),
        }
    }

    /// Whether a check does not hold.
    pub fn fails_a_check(&self) -> bool {
        match self {
            Self::Solved(result) => result.status == Status::CheckFailed,
            Self::Draped(_) | Self::Tested(_) | Self::Bent(..) => false,
        }
    }

    /// Points of the chart of simulated against measured stiffness.
    pub(super) fn parity_points(&self, task: &Task) -> Vec<ParityPoint> {
        match self {
            Self::Tested(tested) => tested::parity_points(task, tested),
            Self::Solved(_) | Self::Draped(_) | Self::Bent(..) => Vec::new(),
        }
    }

    /// The drape beside its measured coefficient.
    pub(super) fn drape_point(&self, task: &Task) -> Option<DrapePoint> {
        match self {
            Self::Draped(drape) => draped::point(task, drape),
            Self::Solved(_) | Self::Tested(_) | Self::Bent(..) => None,
        }
    }
}

/// What outcomes rest on that is not to be relied on, if there is anything.
fn rested(outcomes: &[(&Task, &Outcome)]) -> Option<String> {
    let mut table = Columns::new(["case", "fabric", "rests on"]).with_note(rests_on::LEGEND);
    for (task, outcome) in outcomes {
        let grounds = outcome.grounds(task);
        if rests_on::warning(&grounds).is_some() {
            table.row([task.case.name.clone(), task.shown_fabric(), rests_on::joined(&grounds)]);
        }
    }
    table.filled().map(|table| table.text())
}

/// Outcomes as text, kind by kind; with `verbose` every step of a search, and what each solution took.
pub(super) fn text(outcomes: &[(&Task, &Outcome)], verbose: bool) -> String {
    let (mut solved, mut draped, mut tested, mut bent) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for &(task, outcome) in outcomes {
        match outcome {
            Outcome::Solved(result) => solved.push((task, &**result)),
            Outcome::Draped(drape) => draped.push((task, &**drape)),
            Outcome::Tested(tests) => tested.extend(tests.iter().map(|t| (task, t))),
            Outcome::Bent(result, _) => bent.push((task, result)),
        }
    }
    let mut parts = Vec::new();
    parts.extend((!solved.is_empty()).then(|| solved::text(&solved, verbose)));
    parts.extend(draped::table(draped.iter().copied()).filled().map(|table| table.text()));
    parts.extend((!tested.is_empty()).then(|| tested::text(&tested)));
    parts.extend(bent::texts(&bent));
    parts.extend(rested(outcomes));
    parts.extend(sampled::table(outcomes.iter().map(|(task, _)| *task)));
    parts.join("\n")
}
