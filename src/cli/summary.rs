//! What `run` keeps of a fabric once its files are written, and the overview made of it.

use super::bending;
use super::diagnostics::Failure;
use super::drape;
use super::inputs::Fabric;
use super::output::Columns;
use super::sampled;
use super::search::{is_unconverged, unconverged};
use super::solve::status;
use super::task::{Task, Tested, Work};
use super::tree::Tree;
use crate::characterise::FabricSheet;
use crate::constitutive::{Assumptions, section};
use crate::finding::{Finding, Place};
use crate::instrument::{Direction, Parameter, Test};
use crate::quantity::significant;
use crate::report::chart::ParityPoint;
use crate::report::table::{
    FabricRow, PredictionRow, ProblemRow, UnitSystem, fabric_rows, problem_row, relative_error,
};
use crate::study::{Analysis, CaseResult, Drape, Status};

/// What is left of a fabric.
#[derive(Default)]
pub struct FabricReport {
    /// Its name.
    pub name: String,
    /// Whether it has values.
    pub useful: bool,
    /// Whether a check of one of its cases does not hold.
    pub unmet: bool,
    /// B, G, E, T, W as shown.
    pub cells: Vec<String>,
    /// Case and largest deflection (m).
    pub deflections: Vec<(String, f64)>,
    /// `ok`, or what is the matter.
    pub status: String,
    /// Rows of the tables.
    pub rows: Vec<FabricRow>,
    /// See `rows`.
    pub predictions: Vec<PredictionRow>,
    /// See `rows`.
    pub problems: Vec<ProblemRow>,
    /// Tests of which there is a chart.
    pub drawn: Vec<Test>,
    /// Charts of friction laws.
    pub friction: Vec<String>,
    /// Title and file of each chart of a bending test, and of a test with friction.
    pub bent: Vec<(String, String)>,
    /// Points of the parity chart.
    pub parity: Vec<ParityPoint>,
    /// Points of the parity chart of friction laws.
    pub re_extracted: Vec<ParityPoint>,
    /// Names of its drape cases.
    pub drapes: Vec<String>,
    /// Points of the parity chart of drape coefficients.
    pub drape_parity: Vec<drape::DrapePoint>,
    /// Findings of sheet, section and cases.
    pub findings: Vec<Finding>,
    /// What failed.
    pub failures: Vec<Failure>,
}

impl FabricReport {
    /// Does all of the work for one fabric and writes its files; `progress` is called after each sampled point.
    pub fn of(fabric: &Fabric, tasks: &[Task], tree: &Tree, progress: &(dyn Fn() + Sync)) -> Self {
        let sheet = &fabric.sheet;
        let mut report = Self { name: sheet.name.clone(), status: "ok".into(), ..Self::default() };
        report.findings.clone_from(&sheet.findings);
        report.rows = fabric_rows(sheet, UnitSystem::Si);
        report.cells = cells(sheet);
        report.useful = sheet.has_values();
        report.keep(tree.sheet(sheet));
        match section(sheet, &Assumptions::default()) {
            Ok(c) => {
                report.findings.extend(c.findings.iter().cloned());
                report.keep(tree.section(sheet, &c));
                report.cases(sheet, tasks, tree, progress);
            }
            Err(error) => {
                // Every case needs the section: one line, not one for each of them.
                report.keep(Err(Failure::of_fabric(error, &sheet.name).at(Place::file(&fabric.path))));
                report.charts(sheet, &[], tree);
            }
        }
        for finding in &mut report.findings {
            finding.place.get_or_insert_with(|| Place::file(&fabric.path));
        }
        report.problems = problems(&report.findings, &sheet.name);
        report.problems.iter_mut().for_each(|p| p.fabric = Some(sheet.name.clone()));
        if let Some(failure) = report.failures.first() {
            report.status = failure.code.to_string();
            let fabric = report.name.clone();
            report.rows.push(FabricRow { fabric, status: failure.code.to_string(), ..FabricRow::default() });
        }
        report
    }

    fn keep(&mut self, result: Result<(), Failure>) {
        self.failures.extend(result.err());
    }

    fn cases(&mut self, sheet: &FabricSheet, tasks: &[Task], tree: &Tree, progress: &(dyn Fn() + Sync)) {
        let mut simulated: Vec<Tested> = Vec::new();
        for task in tasks {
            if let Err(failure) = task.sample(progress) {
                self.failures.push(failure);
                continue;
            }
            self.findings.extend(task.sampling().iter().flat_map(|s| s.findings.iter().cloned()));
            let before = self.predictions.len();
            self.case(task, tree, &mut simulated);
            sampled::fill(&mut self.predictions[before..], task);
        }
        self.charts(sheet, &simulated, tree);
    }

    fn case(&mut self, task: &Task, tree: &Tree, simulated: &mut Vec<Tested>) {
        if let Some(spec) = &task.case.virtual_test {
            match task.test(spec).and_then(|t| tree.tested(task, &t).map(|()| t)) {
                Ok(tested) => {
                    tested.iter().for_each(|t| self.tested(task, t));
                    if tree.charts() && tested.iter().any(|t| t.simulated.cycle.is_some()) {
                        self.bent.push((task.case.title.clone(), format!("{}.png", task.stem())));
                    }
                    simulated.extend(tested);
                }
                Err(failure) => self.failures.push(failure),
            }
        } else if let Some(spec) = &task.case.bending_test {
            match task.bend(spec).and_then(|r| tree.bent(task, &r.0).map(|drawn| (r, drawn))) {
                Ok(((result, failed), drawn)) => {
                    self.failures.extend(failed);
                    self.predictions.extend(bending::predictions(task, &result));
                    self.bent.extend(drawn.into_iter().map(|file| (task.case.title.clone(), file)));
                }
                Err(failure) => self.failures.push(failure),
            }
        } else if task.is_drape() {
            match task.drape(&|| ()).and_then(|d| drape::write(tree, task, &d).map(|()| d)) {
                Ok(draped) => self.draped(task, &draped),
                Err(failure) => self.failures.push(failure),
            }
        } else {
            match task.solve().and_then(|r| tree.solved(task, &r).map(|()| r)) {
                Ok(result) => self.solved(task, &result),
                Err(failure) => self.failures.push(failure),
            }
        }
    }

    fn charts(&mut self, sheet: &FabricSheet, simulated: &[Tested], tree: &Tree) {
        if !tree.charts() {
            return;
        }
        match tree.fabric_charts(sheet, simulated) {
            Ok(drawn) => self.drawn = drawn,
            Err(failure) => self.failures.push(failure),
        }
        match tree.friction_charts(sheet) {
            Ok(drawn) => self.friction = drawn,
            Err(failure) => self.failures.push(failure),
        }
        self.re_extracted = super::friction::parity(sheet);
    }

    fn solved(&mut self, task: &Task, result: &CaseResult) {
        self.deflections.push((result.case.clone(), result.w_max));
        self.findings.extend(result.findings.iter().filter(|f| !is_unconverged(f)).cloned());
        self.failures.extend(unconverged(task, result));
        self.predictions.extend(predictions(task, result));
        self.unmet |= unmet(result);
        if result.status != Status::Ok && self.status == "ok" {
            self.status = status(result.status).into();
        }
    }

    fn draped(&mut self, task: &Task, draped: &Drape) {
        self.drapes.push(draped.case.clone());
        self.findings.extend(draped.findings.iter().cloned());
        self.predictions.extend(drape::predictions(task, draped));
        self.drape_parity.extend(drape::point(task, draped));
    }

    fn tested(&mut self, task: &Task, t: &Tested) {
        let direction = t.simulated.direction.map_or("", Direction::name);
        if let Some(cycle) = &t.simulated.cycle {
            // What the cycle gives; its elastic part alone is that of the case without friction.
            let rows = cycle.values.iter().map(|(p, v)| {
                let measured = task.measured(*p, t.simulated.direction);
                PredictionRow {
                    fabric: self.name.clone(),
                    case: t.case.clone(),
                    quantity: format!("{p} {direction}"),
                    simulated: Some(*v),
                    measured,
                    unit: p.si_unit().into(),
                    error: measured.and_then(|m| relative_error(*v, m)),
                    ..PredictionRow::default()
                }
            });
            self.predictions.extend(rows);
            return;
        }
        let Some((symbol, unit, measured)) = &t.stiffness else { return };
        let simulated = t.simulated.apparent;
        let band = t.simulated.uncertainty.as_ref().and_then(|u| u.bands).map(|b| b.mean_fabric);
        let mean = measured.as_ref().map(|e| e.mean);
        self.predictions.push(PredictionRow {
            fabric: self.name.clone(),
            case: t.case.clone(),
            quantity: format!("{symbol} {direction}"),
            simulated: Some(simulated),
            measured: mean,
            unit: (*unit).into(),
            error: mean.and_then(|m| relative_error(simulated, m)),
            simulated_low: band.map(|b| simulated - b.half_width),
            simulated_high: band.map(|b| simulated + b.half_width),
        });
        if let Some(measured) = measured {
            self.parity.push(ParityPoint {
                label: self.name.clone(),
                group: direction.into(),
                quantity: quantity(t.simulated.test).into(),
                unit: (*unit).into(),
                measured: measured.mean,
                measured_half_width: measured.ci95(),
                simulated,
                simulated_half_width: band.map(|b| b.half_width),
                simulated_band: None,
            });
        }
    }
}

fn quantity(test: Test) -> &'static str {
    match test {
        Test::Tensile => "Tensile stiffness",
        Test::Shear => "Shear stiffness G",
        Test::Bending => "Bending rigidity B",
        Test::Compression => "Compression",
    }
}

/// Whether a check does not hold.
pub fn unmet(result: &CaseResult) -> bool {
    result.status == Status::CheckFailed
}

/// The largest deflection and that of each probe, or the natural frequencies.
pub fn predictions(task: &Task, result: &CaseResult) -> Vec<PredictionRow> {
    let row = |quantity: String, value: f64, unit: &str| {
        let band = result.uncertainty.as_ref().and_then(|u| u.of(&quantity)?.mean_fabric());
        PredictionRow {
            fabric: task.fabric_name().unwrap_or_default().into(),
            case: result.case.clone(),
            quantity,
            simulated: Some(value),
            unit: unit.into(),
            simulated_low: band.map(|[low, _]| low),
            simulated_high: band.map(|[_, high]| high),
            ..PredictionRow::default()
        }
    };
    if !result.frequencies.is_empty() {
        let frequency = |(i, f): (usize, &f64)| row(format!("frequency_{}", i + 1), *f, "1/s");
        return result.frequencies.iter().enumerate().map(frequency).collect();
    }
    let probes = result.probes.iter().map(|p| row(format!("{}.w", p.name), p.value.u[2], "m"));
    std::iter::once(row("w_max".into(), result.w_max, "m")).chain(probes).collect()
}

/// Findings as rows of `problems.csv`; `otherwise` is the place of one without a place. A search that found no
/// equilibrium is there as a failure.
pub fn problems(findings: &[Finding], otherwise: &str) -> Vec<ProblemRow> {
    findings.iter().filter(|f| !is_unconverged(f)).map(|f| problem_row(f, otherwise)).collect()
}

/// Headings of the overview before the deflections, in KES units.
pub const HEADINGS: [&str; 9] = [
    "fabric",
    "B warp",
    "B weft",
    "G warp",
    "G weft",
    "E warp (N/m)",
    "E weft (N/m)",
    "T (mm)",
    "W (mg/cm²)",
];

/// Units of the columns that do not name theirs.
pub const CAPTION: &str = "B in gf·cm²/cm, G in gf/(cm·deg)";

/// B, G, E, T, W: KES units, except E in N/m.
fn cells(sheet: &FabricSheet) -> Vec<String> {
    let kes = |p: Parameter, d: Option<Direction>| {
        let e = sheet.get(p, d).or_else(|| sheet.get(p, None));
        e.map_or("-".into(), |e| significant(e.mean / p.kes_factor()))
    };
    let modulus = |d: Direction| {
        let of = |name: &str| sheet.moduli.get(&(name.to_string(), d));
        of("tangent_low").or_else(|| of("secant")).map_or("-".into(), |e| significant(e.mean))
    };
    let (warp, weft) = (Direction::Warp, Direction::Weft);
    let both = |p| [kes(p, Some(warp)), kes(p, Some(weft))];
    let [b, g] = [Parameter::B, Parameter::G].map(both);
    let rest = [modulus(warp), modulus(weft), kes(Parameter::T0, None), kes(Parameter::W, None)];
    [b.to_vec(), g.to_vec(), rest.to_vec()].concat()
}

/// The table on standard output: one line a fabric, one column of deflections a case.
pub fn summary(reports: &[FabricReport], work: &Work) -> Columns {
    let cases: Vec<&str> = work
        .cases
        .iter()
        .filter(|c| c.sheet.is_some() && c.section.is_none() && !matches!(c.analysis, Analysis::Drape { .. }))
        .map(|c| c.name.as_str())
        .collect();
    let deflections = cases.iter().map(|c| format!("w_max {c} (mm)"));
    let headings = HEADINGS.map(String::from).into_iter().chain(deflections).chain(["status".to_string()]);
    let mut table = Columns::new(headings);
    for r in reports {
        let w = cases.iter().map(|c| {
            let found = r.deflections.iter().find(|(case, _)| case == c);
            found.map_or("-".into(), |(_, w)| significant(1e3 * w))
        });
        let cells = std::iter::once(r.name.clone()).chain(r.cells.iter().cloned()).chain(w);
        table.row(cells.chain([r.status.clone()]));
    }
    table
}
