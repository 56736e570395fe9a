//! A case together with the fabric it is for: what solve, compare and run have in common.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use clap::Args;

use super::Ui;
use super::diagnostics::Failure;
use super::inputs::{self, Curves, EvaluateArgs, Fabric};
use crate::characterise::FabricSheet;
use crate::constitutive::{self, Constitutive};
use crate::finding::{Finding, Place, StudyFact, UsageFact};
use crate::instrument::{Direction, Parameter, Test};
use crate::quantity::{Curve, Estimate};
use crate::section::ShellSection;
use crate::solve::Options as SolveOptions;
use crate::study::bending::{BendingResult, simulate_records, simulate_strips};
use crate::study::{
    self, Analysis, BendingKind, BendingTest, Case, CaseResult, Comparison, Drape, PreparedCase,
    PreparedTest, Sampling, SolverChoice, SolverTable, StudyError, VirtualCurve, VirtualTest, Watch,
    compare_curves, measured_curve,
};

/// Cases and fabrics on the command line.
#[derive(Debug, Args)]
pub struct TaskArgs {
    /// Overwrite files in the output folder that this tool did not write
    #[arg(long)]
    pub force: bool,
    /// Draw no charts
    #[arg(long)]
    pub no_charts: bool,
    /// Exit with 1 if there is a finding
    #[arg(long)]
    pub strict: bool,
    /// How linear cases are solved, whatever their [solver] says
    #[arg(long, value_enum, value_name = "METHOD")]
    pub solver: Option<SolverArg>,
    #[command(flatten)]
    pub evaluate: EvaluateArgs,
}

/// [`SolverChoice`] as typed.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum SolverArg {
    /// Direct, unless the factor would be too large
    Auto,
    /// Sparse Cholesky factorisation
    Direct,
    /// Conjugate gradients, preconditioned by multigrid
    Iterative,
}

impl From<SolverArg> for SolverChoice {
    fn from(typed: SolverArg) -> Self {
        match typed {
            SolverArg::Auto => Self::Auto,
            SolverArg::Direct => Self::Direct,
            SolverArg::Iterative => Self::Iterative,
        }
    }
}

/// The cases and fabrics that the inputs name, and what could not be read (already told).
pub struct Work {
    /// In name order.
    pub cases: Vec<Case>,
    /// In name order; those that only a case names come last.
    pub fabrics: Vec<Fabric>,
    /// Told already.
    pub failures: Vec<Failure>,
    /// Threads for all tasks together.
    threads: usize,
}

/// A case and its fabric; none for a case with constants of its own.
#[derive(Clone)]
pub struct Task<'a> {
    pub case: &'a Case,
    pub fabric: Option<&'a FabricSheet>,
    /// Folder or file of its fabric.
    path: Option<&'a Path>,
    shared: Arc<Shared<'a>>,
    /// Its bands, once they are sampled.
    sampling: Arc<OnceLock<Option<Sampling>>>,
}

/// What the tasks of one case share, made by the first that needs it. Nothing in the making waits for
/// other threads' work, so those that wait for it cannot lock each other out.
#[derive(Default)]
struct Shared<'a> {
    options: SolveOptions,
    case: OnceLock<Result<PreparedCase<'a>, Failure>>,
    test: OnceLock<Result<PreparedTest, Failure>>,
}

/// A simulated test with what was measured.
pub struct Tested {
    /// E.g. `bending warp`.
    pub name: String,
    /// Name of its case.
    pub case: String,
    /// The simulated curve over the measured range.
    pub curve: Curve,
    /// The simulated test.
    pub simulated: VirtualCurve,
    /// The distance from the measured curves, where there are any.
    pub comparison: Option<Comparison>,
    /// Symbol and unit of the stiffness, and its estimate in the sheet.
    pub stiffness: Option<(&'static str, &'static str, Option<Estimate>)>,
}

impl TaskArgs {
    /// Reads everything that the inputs name, and the fabrics that only cases name.
    pub fn load(&self, inputs: &[PathBuf], ui: &mut Ui) -> Result<Work, Failure> {
        let (mut cases, mut failures) = inputs::cases(inputs);
        inputs::distinguish_cases(&mut cases).iter().for_each(|f| ui.diagnostics.finding(f));
        if let Some(typed) = self.solver {
            for case in &mut cases {
                let iterates = !matches!(typed, SolverArg::Direct);
                let kept = if iterates { case.solver } else { SolverTable::default() };
                case.solver = SolverTable { method: Some(typed.into()), ..kept };
            }
        }
        failures.iter().for_each(|f| ui.diagnostics.error(f));
        let mut folders: Vec<PathBuf> =
            inputs.iter().filter(|p| p.is_dir() || !inputs::is_case(p)).cloned().collect();
        for case in &cases {
            let Some(named) = named_fabric(case) else { continue };
            if !named.exists() {
                let failure = no_such_fabric(case);
                ui.diagnostics.error(&failure);
                failures.push(failure);
                continue;
            }
            if let Some(finding) = two_fabrics(case, &named) {
                ui.diagnostics.finding(&finding);
            }
            let known = folders.iter().any(|f| is_within(&named, f));
            if !known {
                folders.push(named);
            }
        }
        let moduli: Vec<_> = cases.iter().map(|c| c.assumptions.modulus).collect();
        let (fabrics, unread) = self.evaluate.sheets(&folders, &moduli, Curves::Kept, ui)?;
        failures.extend(unread);
        Ok(Work { cases, fabrics, failures, threads: ui.threads })
    }
}

/// Long work ends at its next step once Ctrl-C was pressed.
fn watch<'a>(stage: &'a (dyn Fn() + Sync)) -> Watch<'a> {
    Watch { stage, stopped: &super::interrupted }
}

/// The folder that a case names: as it stands, else beside the case file.
pub fn named_fabric(case: &Case) -> Option<PathBuf> {
    let path = PathBuf::from(case.fabric.as_deref().filter(|f| *f != "*")?);
    let beside = beside_case(case, &path);
    Some(if path.exists() { path } else { beside.unwrap_or(path) })
}

/// A path beside the case file, if it is there.
fn beside_case(case: &Case, path: &Path) -> Option<PathBuf> {
    case.path.parent().map(|p| p.join(path)).filter(|p| p.exists())
}

/// O055: a case whose fabric is nowhere.
pub fn no_such_fabric(case: &Case) -> Failure {
    let name = case.fabric.as_deref().unwrap_or_default();
    let text = format!("there is no fabric `{name}`, neither from here nor beside the case");
    let place = case.place_of(&text);
    Failure::new("O055", text)
        .at(place)
        .hint("correct the name in the case, or write fabric = \"*\" and name a fabric beside it")
}

/// O060: a case whose fabric is there twice, and which one was taken.
fn two_fabrics(case: &Case, taken: &Path) -> Option<Finding> {
    let name = case.fabric.as_deref()?;
    let other = beside_case(case, Path::new(name)).filter(|p| !is_within(p, taken))?;
    let fact = UsageFact::FabricTwice {
        fabric: name.to_string(),
        taken: std::path::absolute(taken).unwrap_or_else(|_| taken.to_path_buf()).display().to_string(),
        other: std::path::absolute(&other).unwrap_or(other).display().to_string(),
    };
    let place = case.place_of(&fact.to_string());
    Some(Finding::new(fact).at(place))
}

fn is_within(path: &Path, folder: &Path) -> bool {
    match (path.canonicalize(), folder.canonicalize()) {
        (Ok(path), Ok(folder)) => path.starts_with(folder),
        _ => path == folder,
    }
}

impl Work {
    /// Every case with every fabric it is for, cases in order; a case that finds none is a failure.
    pub fn tasks<'w>(&'w self) -> (Vec<Task<'w>>, Vec<Failure>) {
        let (mut tasks, mut failures) = (Vec::new(), Vec::new());
        // Tasks share the threads; one that is alone has them all.
        let alone = self.cases.len() == 1 && self.fabrics.len() < 2;
        let threads = if alone { self.threads } else { 1 };
        for case in &self.cases {
            let options = SolveOptions { threads, ..SolveOptions::default() };
            let shared = Arc::new(Shared { options, ..Shared::default() });
            if case.section.is_some() {
                tasks.push(Task { case, fabric: None, path: None, shared, sampling: Arc::default() });
                continue;
            }
            let named = named_fabric(case);
            if named.as_ref().is_some_and(|path| !path.exists()) {
                continue; // told already
            }
            let is_for = |f: &&'w Fabric| named.as_ref().is_none_or(|n| is_within(&f.path, n));
            let before = tasks.len();
            let homeless = |text: String| Failure::new("O055", text).at(Place::file(&case.path));
            let task = |f: &'w Fabric| Task {
                case,
                fabric: Some(&f.sheet),
                path: Some(&f.path),
                shared: Arc::clone(&shared),
                sampling: Arc::default(),
            };
            tasks.extend(self.fabrics.iter().filter(is_for).filter(|f| case.suits(&f.sheet)).map(task));
            if tasks.len() == before && case.is_for_fab_records() {
                let text = format!("{} is for a fabric with FAB bend tests, and none is there", case.name);
                failures.push(homeless(text).hint(
                    "name a U3M file with `raw_data`, as in `kesf compare cases/fab_bend_loop.toml FABRIC.u3m`",
                ));
            } else if tasks.len() == before && self.without_law(case).is_some() {
                let text =
                    format!("{} is for fabrics with a friction law of bending, and none has one", case.name);
                failures.push(
                    homeless(text)
                        .hint("add FB2 loops, or 2HB beside B in a result table, or take law = \"elastic\""),
                );
            } else if tasks.len() == before {
                let text = format!("{} is for a fabric, and none is there", case.name);
                failures.push(homeless(text).hint("name one, as in `kesf solve CASE kesf_data/poplin`"));
            }
        }
        (tasks, failures)
    }
}

impl Work {
    /// S118: the fabrics that a case with friction is for, and that have no law; `None` without such.
    pub fn without_law(&self, case: &Case) -> Option<Finding> {
        let named = named_fabric(case);
        let is_for = |f: &&Fabric| named.as_ref().is_none_or(|n| is_within(&f.path, n));
        let lacks = |f: &&Fabric| case.lacks_law(&f.sheet);
        let lawless = self.fabrics.iter().filter(is_for).filter(lacks);
        let fabrics: Vec<String> = lawless.map(|f| f.sheet.name.clone()).collect();
        (!fabrics.is_empty())
            .then(|| Finding::new(StudyFact::WithoutLaw { fabrics }).at(Place::file(&case.path)))
    }
}

impl Work {
    /// What to say of fabrics that no task is for because every case brings or names its own.
    pub fn idle(&self, tasks: &[Task]) -> Option<String> {
        let own = |c: &Case| c.section.is_some() || named_fabric(c).is_some();
        if self.cases.is_empty() || !self.cases.iter().all(own) {
            return None;
        }
        let used =
            |f: &&Fabric| tasks.iter().any(|t| t.fabric.is_some_and(|s| std::ptr::eq(s, &raw const f.sheet)));
        let idle: Vec<&str> =
            self.fabrics.iter().filter(|f| !used(f)).map(|f| f.sheet.name.as_str()).collect();
        (!idle.is_empty()).then(|| {
            format!("not used, as every case names its own fabric or has a [section]: {}", idle.join(", "))
        })
    }
}

/// What is known of the fabrics of tasks, and of the sections that were made of them, each thing once.
pub fn findings<'a>(tasks: impl Iterator<Item = &'a Task<'a>>) -> Vec<(String, Finding)> {
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    for task in tasks {
        let Some(sheet) = task.fabric else { continue };
        let uses_section = !task.case.is_for_fab_records()
            && task.case.virtual_test.as_ref().is_none_or(|t| t.test != Test::Compression);
        let made = if uses_section { task.section().ok().and_then(|(_, made)| made) } else { None };
        for finding in sheet.findings.iter().chain(made.iter().flat_map(|c| &c.findings)) {
            let mut finding = finding.clone();
            finding.place = finding.place.or_else(|| task.path.map(Place::file));
            if seen.insert((sheet.name.clone(), finding.to_string())) {
                all.push((sheet.name.clone(), finding));
            }
        }
    }
    all
}

impl Task<'_> {
    /// A failure of this task: with its name, at its case file unless it has a place of its own.
    fn told(&self, failure: Failure) -> Failure {
        let failure = failure.of(&self.name());
        if failure.place.is_some() {
            return failure;
        }
        let place = self.case.place_of(&failure.message);
        failure.at(place)
    }

    /// Names the task in messages: `case`, or `case of fabric`.
    pub fn name(&self) -> String {
        match self.fabric {
            Some(fabric) => format!("{} of {}", self.case.name, fabric.name),
            None => self.case.name.clone(),
        }
    }

    /// Where its files go in a results tree, without ending: `<fabric>/<case>`, or `cases/<case>`.
    pub fn stem(&self) -> String {
        format!("{}/{}", self.fabric.map_or("cases", |f| &f.name), self.case.name)
    }

    /// Name of its fabric, if it has one.
    pub fn fabric_name(&self) -> Option<&str> {
        self.fabric.map(|f| f.name.as_str())
    }

    /// The section, with the assumptions where it comes from a sheet.
    pub fn section(&self) -> Result<(ShellSection, Option<Constitutive>), Failure> {
        match (self.fabric, &self.case.section) {
            (Some(sheet), _) => {
                let c = constitutive::section(sheet, &self.case.assumptions)?;
                Ok((c.section.clone(), Some(c)))
            }
            (None, Some(table)) => Ok((study::section(table)?, None)),
            // `Case::read` refuses a case with neither.
            (None, None) => Err(Failure::new("O055", format!("{} has no section", self.case.name))),
        }
    }

    /// The mean of a parameter of its fabric in a direction, or of the fabric as a whole (SI).
    pub fn measured(&self, parameter: Parameter, direction: Option<Direction>) -> Option<f64> {
        let sheet = self.fabric?;
        sheet.get(parameter, direction).or_else(|| sheet.get(parameter, None)).map(|e| e.mean)
    }

    /// Solves a case with a `[sheet]`.
    pub fn solve(&self) -> Result<CaseResult, Failure> {
        let solved = self.section().and_then(|(section, from)| {
            let prepare = || Ok(PreparedCase::new(self.case, &self.shared.options)?);
            let prepared = self.shared.case.get_or_init(prepare).as_ref().map_err(Clone::clone)?;
            Ok(match from {
                Some(made) => prepared.solve_fabric(&made)?,
                None => prepared.solve(section)?,
            })
        });
        solved.map_err(|f| self.told(f))
    }

    /// Samples the bands of a case with `[uncertainty]`; nothing without.
    pub fn sample(&self, stage: &(dyn Fn() + Sync)) -> Result<(), Failure> {
        let Some(sheet) = self.fabric.filter(|_| self.case.uncertainty.is_some()) else { return Ok(()) };
        let sampled = constitutive::section(sheet, &self.case.assumptions)
            .map_err(Failure::from)
            .and_then(|made| Ok(study::sample(self.case, sheet, &made, watch(stage))?));
        let sampling = sampled.map_err(|f| self.told(f))?;
        self.sampling.get_or_init(|| sampling);
        Ok(())
    }

    /// What [`sample`](Self::sample) has found.
    pub fn sampling(&self) -> Option<&Sampling> {
        self.sampling.get()?.as_ref()
    }

    /// Whether its case is a drape.
    pub fn is_drape(&self) -> bool {
        matches!(self.case.analysis, Analysis::Drape { .. })
    }

    /// Searches the states of a drape.
    pub fn drape(&self, stage: &(dyn Fn() + Sync)) -> Result<Drape, Failure> {
        let options = SolveOptions::default();
        let draped = self.section().and_then(|(section, made)| {
            let law = made.as_ref().and_then(|m| m.law.as_ref());
            Ok(study::drape(self.case, &section, law, &options, watch(stage))?)
        });
        draped.map_err(|f| self.told(f))
    }

    /// Simulates a `[virtual_test]` along warp and weft and compares it with the sheet.
    pub fn test(&self, spec: &VirtualTest) -> Result<Vec<Tested>, Failure> {
        self.simulate(spec).map_err(|f| self.told(f))
    }

    /// Simulates a `[bending_test]`; with the result, the directions that failed.
    pub fn bend(&self, spec: &BendingTest) -> Result<(BendingResult, Vec<Failure>), Failure> {
        let result = match (spec.test, self.fabric) {
            // It finds a rigidity of its own and needs no section.
            (BendingKind::FabBendLoop, Some(sheet)) => simulate_records(self.case, spec, sheet)
                .map_err(Failure::from)
                .map(|(result, failed)| (result, failed.into_iter().map(|f| self.failed(f)).collect())),
            (_, fabric) => {
                let nothing = FabricSheet::default();
                let sheet = fabric.unwrap_or(&nothing);
                let simulate = |(section, _)| Ok(simulate_strips(self.case, spec, sheet, &section)?);
                self.section().and_then(simulate).map(|result| (result, Vec::new()))
            }
        };
        result.map_err(|f| self.told(f))
    }

    fn failed(&self, (direction, error): (Direction, StudyError)) -> Failure {
        self.told(Failure::from(error).of(&direction.to_string()))
    }

    fn simulate(&self, spec: &VirtualTest) -> Result<Vec<Tested>, Failure> {
        let nothing = FabricSheet::default();
        let sheet = self.fabric.unwrap_or(&nothing);
        let curves = if spec.test == Test::Compression {
            study::compression(sheet).into_iter().collect()
        } else {
            let (section, made) = self.section()?;
            let inputs = made.as_ref().map_or_else(Vec::new, |c| c.inputs.clone());
            let prepare = || Ok(PreparedTest::new(self.case, spec, &self.shared.options)?);
            let prepared = self.shared.test.get_or_init(prepare).as_ref().map_err(Clone::clone)?;
            [Direction::Warp, Direction::Weft]
                .into_iter()
                .map(|d| {
                    let mut curve = prepared.simulate_measured(d, &section, &inputs)?;
                    if let Some(made) = &made {
                        let options = SolveOptions::default();
                        curve.cycle = study::simulate_cycle(self.case, spec, d, sheet, made, &options)?;
                    }
                    Ok(curve)
                })
                .collect::<Result<Vec<_>, StudyError>>()?
        };
        Ok(curves.into_iter().map(|c| self.tested(sheet, c)).collect())
    }

    fn tested(&self, sheet: &FabricSheet, simulated: VirtualCurve) -> Tested {
        let (test, direction) = (simulated.test, simulated.direction);
        let measured = measured_curve(sheet, test, direction);
        let fold = |f: fn(f64, f64) -> f64, start| measured.x.iter().copied().fold(start, f);
        let [from, to] = match test {
            _ if measured.len() > 1 => [fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY)],
            Test::Tensile => [0.0, 0.05],
            Test::Shear => [-8f64.to_radians(), 8f64.to_radians()],
            Test::Bending => [-250.0, 250.0],
            Test::Compression => [0.0, 0.0],
        };
        let of = |p: Parameter| sheet.get(p, direction).or_else(|| sheet.get(p, None)).cloned();
        let modulus = || {
            let name = self.case.assumptions.modulus.name();
            direction.and_then(|d| sheet.moduli.get(&(name, d)).cloned())
        };
        let stiffness = match test {
            Test::Tensile => Some(("E", "N/m", modulus())),
            Test::Shear => Some(("G", "N/m", of(Parameter::G))),
            Test::Bending => Some(("B", "N·m", of(Parameter::B))),
            Test::Compression => None,
        };
        let name = match direction {
            Some(direction) => format!("{} {direction}", test.name()),
            None => test.name().to_string(),
        };
        let comparison = compare_curves(sheet, &simulated);
        let curve = if from < to { simulated.curve(from, to) } else { Curve::default() };
        Tested { name, case: self.case.name.clone(), curve, simulated, comparison, stiffness }
    }
}
