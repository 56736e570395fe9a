//! How the tables of a case file become a problem.

use nalgebra::Vector3;

use super::adaptive::Adaptive;
use super::analysis::{Analysis, AnalysisTable, Buckling, DrapeSizes, DrapeTable, Linear, Modal, Nonlinear};
use super::bending_test::{BendingTest, BendingTestTable};
use super::check::{checks, probes};
use super::element::Purpose;
use super::error::refused;
use super::history::steps;
use super::loads::{LoadTable, SheetLoad, SheetLoads};
use super::material::{FabricMaterial, Material, SectionTable, check_assumptions};
use super::obstacles::SheetObstacle;
use super::problem::{DrapeProblem, InstrumentTest, Mounting, Problem, SheetProblem, ShellSpecimen};
use super::sheet::{Sheet, SheetTable};
use super::virtual_test::VirtualTestTable;
use super::{CaseError, CaseTable};
use crate::constitutive::TensileLaw;
use crate::element::{Formulation, Membrane};
use crate::finding::{Located, Node};
use crate::law::Mode;

/// What friction and bands ask of a problem, and whether it has it.
struct Abilities {
    /// Whether a law with friction has a meaning.
    friction: bool,
    /// Whether a sheet may follow curves of tension.
    curves: bool,
    /// Why bands by sampling have none, if so.
    against_sampling: Option<&'static str>,
}

const LINEAR_BANDS: &str = "[uncertainty] is for drapes, nonlinear statics, dynamics, cantilevers, heart loops and virtual \
                            tests in large rotations: remove it, the bands of linear cases need no points";

impl CaseTable {
    /// The problem of the tables of a file.
    pub(super) fn problem(&self, case: &Node<'_>) -> Result<Problem, CaseError> {
        if let (Some(table), Some(at)) = (&self.bending_test, case.get("bending_test")) {
            return self.bending_problem(case, table, &at).map(Problem::BendingTest);
        }
        if let (Some(table), Some(at)) = (&self.virtual_test, case.get("virtual_test")) {
            return self.instrument_problem(case, table, &at).map(Problem::InstrumentTest);
        }
        match (&self.sheet, case.get("sheet")) {
            (Some(table), Some(at)) => self.problem_of_sheet(case, table, &at),
            _ => refused(
                case.place(),
                "the case has neither a [sheet] nor a [virtual_test] nor a [bending_test]: give one of them",
            ),
        }
    }

    /// The problem of a case with the `[sheet]` at a node.
    fn problem_of_sheet(
        &self,
        case: &Node<'_>,
        table: &SheetTable,
        at: &Node<'_>,
    ) -> Result<Problem, CaseError> {
        let analysis = AnalysisTable::read(case)?;
        if !matches!(analysis, AnalysisTable::Nonlinear(_)) {
            foreign(case, &["steps"], NO_STEPS)?;
        }
        if !analysis.can_have_obstacles() {
            foreign(case, &["obstacles"], NO_OBSTACLES)?;
        }
        let is_one_state = matches!(analysis, AnalysisTable::Linear(_) | AnalysisTable::Nonlinear(_));
        if !is_one_state || case.has("steps") {
            foreign(case, &["adaptive"], NO_ADAPTIVE)?;
        }
        let abilities = Abilities {
            friction: analysis.can_have_friction(),
            curves: analysis.can_have_friction(),
            against_sampling: (!analysis.can_be_sampled()).then_some(LINEAR_BANDS),
        };
        let material = self.material(case, &abilities)?;
        let of_sheet = at;
        let at = case.get("analysis").unwrap_or(*case);
        let (sheet, analysis) = match analysis {
            AnalysisTable::Drape(drape) => {
                return self
                    .drape_problem(case, material, (table, of_sheet), drape)
                    .map(Box::new)
                    .map(Problem::Drape);
            }
            AnalysisTable::Linear(_) => {
                let sheet = table.sheet(of_sheet)?;
                let adaptive = self.adaptive(case, &sheet)?;
                let linear = Linear { loads: loads(case)?, adaptive, coarser: self.coarser(case, &sheet)? };
                (sheet, Analysis::Linear(linear))
            }
            AnalysisTable::Modal(modal) => {
                let sheet = table.sheet(of_sheet)?;
                let (modes, mass) = modal.checked(&at)?;
                foreign(case, &["loads"], "a modal analysis has no loads: remove [[loads]]")?;
                let coarser = self.coarser(case, &sheet)?;
                (sheet, Analysis::Modal(Modal { modes, mass, coarser }))
            }
            AnalysisTable::Buckling(buckling) => {
                let sheet = table.sheet(of_sheet)?;
                let (factors, coarser) = (buckling.checked(&at)?, self.coarser(case, &sheet)?);
                (sheet, Analysis::Buckling(Buckling { loads: loads(case)?, factors, coarser }))
            }
            AnalysisTable::Newmark(newmark) => {
                foreign(case, &["convergence"], NO_CONVERGENCE)?;
                (table.sheet(of_sheet)?, Analysis::Newmark(newmark.checked(&at, loads(case)?)?))
            }
            AnalysisTable::Nonlinear(nonlinear) => {
                let sheet = table.sheet(of_sheet)?;
                let nonlinear = nonlinear.with_obstacles(case, &at)?;
                let analysis = match steps(&self.steps, case, &nonlinear)? {
                    Some(steps) => {
                        foreign(case, &["convergence"], NO_CONVERGENCE)?;
                        Analysis::Steps(steps)
                    }
                    None => {
                        let (adaptive, coarser) = (self.adaptive(case, &sheet)?, self.coarser(case, &sheet)?);
                        let nonlinear = nonlinear.checked(&at, loads(case)?)?;
                        Analysis::Nonlinear(Box::new(Nonlinear { adaptive, coarser, ..nonlinear }))
                    }
                };
                (sheet, analysis)
            }
        };
        let problem = self.sheet_problem(case, material, sheet, analysis)?;
        Ok(Problem::Sheet(Box::new(problem)))
    }

    /// The fabric or the section of the case.
    fn material(&self, case: &Node<'_>, abilities: &Abilities) -> Result<Material, CaseError> {
        let name = match (&self.fabric, &self.section) {
            (None, None) => {
                let message = "the case names neither `fabric` nor a [section]: give one of them";
                return refused(case.place(), message);
            }
            (Some(_), Some(_)) => {
                let message = "the case gives both `fabric` and [section]: remove one of them";
                return refused(case.key_place("section"), message);
            }
            (None, Some(section)) => return self.own_section(section, case),
            (Some(name), None) => case.located_at("fabric", name.clone()),
        };
        let assumptions = self.assumptions.clone().unwrap_or_default();
        check_assumptions(&assumptions, case)?;
        let at = case.get("assumptions").unwrap_or(*case);
        if assumptions.tensile_law == TensileLaw::Curve && !abilities.curves {
            return refused(
                at.value_place("tensile_law"),
                "tensile_law = \"curve\" is for a [sheet] in large rotations and a drape (a test of tension follows its curve with [assumptions] \
                 law = \"friction\"): write [analysis] kind = \"nonlinear\", \"drape\" or \"newmark\" with large_rotations = true, or remove \
                 `tensile_law`",
            );
        }
        if assumptions.law != Mode::Elastic && !abilities.friction {
            return refused(
                at.value_place("law"),
                "friction needs large rotations: write [analysis] kind = \"nonlinear\", \"drape\" or \"newmark\" with large_rotations = true (or \
                 [virtual_test] formulation = \"nonlinear\"), or [assumptions] law = \"elastic\"",
            );
        }
        let sampling = match (&self.uncertainty, case.get("uncertainty")) {
            (Some(table), Some(at)) => {
                let plan = table.clone().plan(&at)?;
                if let Some(message) = abilities.against_sampling {
                    return refused(at.place(), message);
                }
                Some(plan)
            }
            _ => None,
        };
        Ok(Material::Fabric(FabricMaterial { name, assumptions, sampling }))
    }

    fn own_section(&self, section: &SectionTable, case: &Node<'_>) -> Result<Material, CaseError> {
        let at = case.get("section").unwrap_or(*case);
        section.check(&at)?;
        if let (Some(assumptions), Some(at)) = (&self.assumptions, case.get("assumptions")) {
            return match assumptions.law {
                Mode::Elastic => refused(
                    at.place(),
                    "[assumptions] lie between the sheet of a fabric and its section: remove them beside a [section]",
                ),
                Mode::Friction | Mode::Virgin => refused(
                    at.key_place("law"),
                    "a [section] has no law of friction: remove `law`, or name a `fabric`",
                ),
            };
        }
        if self.uncertainty.is_some() {
            return refused(
                case.key_place("uncertainty"),
                "the constants of a [section] have no spread: remove [uncertainty], or name a `fabric`",
            );
        }
        Ok(Material::Section(at.located(section.clone())))
    }

    fn bending_problem(
        &self,
        case: &Node<'_>,
        table: &BendingTestTable,
        at: &Node<'_>,
    ) -> Result<BendingTest, CaseError> {
        without_analysis(case)?;
        let message = "a [bending_test] brings its own specimen: remove [sheet] and [virtual_test]";
        foreign(case, &["sheet", "virtual_test"], message)?;
        foreign(case, &["element"], "a [bending_test] has its own elements: remove [element]")?;
        foreign(
            case,
            &["supports", "rigid", "loads", "probes", "obstacles"],
            "a [bending_test] brings its own supports and loads: remove [[supports]], [[rigid]], [[loads]], [[obstacles]], [[probes]]",
        )?;
        foreign(
            case,
            &["solver"],
            "a [bending_test] is an elastic strip, which has no choice of solver: remove [solver]",
        )?;
        if self.assumptions.as_ref().is_some_and(|a| a.law != Mode::Elastic) && self.section.is_none() {
            return refused(
                case.get("assumptions").unwrap_or(*case).key_place("law"),
                "a [bending_test] shows the elastic strip and friction beside it: remove `law`",
            );
        }
        let records = "FAB records are of one specimen and have no spread: remove [uncertainty]";
        let abilities = Abilities {
            friction: false,
            curves: false,
            against_sampling: table.uses_records().then_some(records),
        };
        let material = self.material(case, &abilities)?;
        table.checked(at, material, case)
    }

    fn instrument_problem(
        &self,
        case: &Node<'_>,
        table: &VirtualTestTable,
        at: &Node<'_>,
    ) -> Result<InstrumentTest, CaseError> {
        without_analysis(case)?;
        let message = "a [virtual_test] brings its own specimen: remove [sheet], or the [virtual_test]";
        foreign(case, &["sheet"], message)?;
        foreign(
            case,
            &["supports", "rigid", "loads", "probes", "obstacles"],
            "a [virtual_test] brings its own supports and loads: remove [[supports]], [[rigid]], [[loads]], [[obstacles]], [[probes]]",
        )?;
        let test = table.checked(at)?;
        let large = test.is_some_and(|test| test.is_large());
        let against_sampling = (!large).then_some(LINEAR_BANDS);
        let material =
            self.material(case, &Abilities { friction: large, curves: false, against_sampling })?;
        if material.law() != Mode::Elastic && table.pretension.is_some() {
            return refused(
                at.key_place("pretension"),
                "[virtual_test] pretension belongs to an elastic sheet: the cycle of one with friction is run without a tension \
                 across; remove it, or write [assumptions] law = \"elastic\"",
            );
        }
        let Some(test) = test else {
            let message =
                "compression is a closed form of measured thicknesses: remove [element] and [solver]";
            foreign(case, &["element", "solver"], message)?;
            return match material {
                Material::Fabric(fabric) => Ok(InstrumentTest::Compression(fabric)),
                Material::Section(_) => refused(
                    case.key_place("section"),
                    "compression is a closed form of measured thicknesses: name a `fabric` in the place of the [section]",
                ),
            };
        };
        let formulation = self.element.formulation(case, Purpose::statics(large))?;
        let solver = self.solver.checked(case, !large)?;
        Ok(InstrumentTest::Shell(ShellSpecimen { material, formulation, test, solver }))
    }

    fn mounting(&self, case: &Node<'_>, formulation: Formulation) -> Result<Mounting, CaseError> {
        if self.supports.is_empty() {
            return refused(
                case.place(),
                "nothing holds the sheet: add [[supports]] (kind = \"free\" says that this is meant)",
            );
        }
        let (supports, bodies) = (case.get("supports"), case.get("rigid"));
        let supports = self.supports.iter().zip(supports.iter().flat_map(Node::items));
        let bodies = self.rigid.iter().zip(bodies.iter().flat_map(Node::items));
        Ok(Mounting {
            formulation,
            arcs_of_triangles: false,
            supports: supports.map(|(t, at)| t.clone().support(&at)).collect::<Result<_, _>>()?,
            bodies: bodies.map(|(table, at)| table.clone().body(&at)).collect(),
        })
    }

    fn sheet_problem(
        &self,
        case: &Node<'_>,
        material: Material,
        sheet: Sheet,
        analysis: Analysis,
    ) -> Result<SheetProblem, CaseError> {
        let purpose =
            Purpose { large_rotations: analysis.has_large_rotations(), drape: false, mass: analysis.mass() };
        let mut formulation = self.element.formulation(case, purpose)?;
        let solver = self.solver.checked(case, matches!(analysis, Analysis::Linear(_)))?;
        let arcs_of_triangles = purpose.large_rotations && self.element.leaves_the_membrane();
        if arcs_of_triangles && analysis.adaptive().is_some() {
            // The first mesh has no triangles yet, and all are to be of the same elements.
            formulation.membrane = Membrane::AssumedStress;
        }
        let mounting = Mounting { arcs_of_triangles, ..self.mounting(case, formulation)? };
        let probes = probes(&self.probes, case)?;
        let checks = checks(&self.checks, case, &analysis, &probes)?;
        let obstacles = SheetObstacle::read(case)?;
        Ok(SheetProblem { material, sheet, mounting, obstacles, analysis, solver, probes, checks })
    }

    /// How far `[adaptive]` refines the mesh.
    fn adaptive(&self, case: &Node<'_>, sheet: &Sheet) -> Result<Option<Located<Adaptive>>, CaseError> {
        let (Some(table), Some(at)) = (self.adaptive, case.get("adaptive")) else { return Ok(None) };
        let adaptive = table.checked(&at, case, sheet, self.assumptions.as_ref())?;
        self.element.fits_triangles(case)?;
        Ok(Some(adaptive))
    }

    /// The coarser meshes of `[convergence]`.
    fn coarser(&self, case: &Node<'_>, sheet: &Sheet) -> Result<Option<Located<Vec<Sheet>>>, CaseError> {
        match (self.convergence, case.get("convergence")) {
            (Some(table), Some(at)) => table.coarser(&at, sheet).map(Some),
            _ => Ok(None),
        }
    }

    fn drape_problem(
        &self,
        case: &Node<'_>,
        material: Material,
        (sheet, of_sheet): (&SheetTable, &Node<'_>),
        drape: DrapeTable,
    ) -> Result<DrapeProblem, CaseError> {
        let at = case.get("analysis").unwrap_or(*case);
        if drape.folds.is_empty() {
            return refused(at.value_place("folds"), "folds = []: give at least one number");
        }
        if !(0.0..=1.0).contains(&drape.shaking) {
            let message = format!("shaking = {}: give 0 to 1; more would throw the sheet up", drape.shaking);
            return refused(at.value_place("shaking"), message);
        }
        foreign(case, &["convergence"], NO_CONVERGENCE)?;
        if case.has("section") && at.has("sizes") {
            let message = "`sizes` are those of a measured drape, which a [section] has none of: remove it, or the section";
            return refused(at.key_place("sizes"), message);
        }
        if case.has("section") && at.has("shaking") {
            let message = "`shaking` works against the friction of a measured fabric, which a [section] has none of: remove it, or the \
                           section";
            return refused(at.key_place("shaking"), message);
        }
        if at.has("shaking") && self.assumptions.as_ref().is_none_or(|a| a.law == Mode::Elastic) {
            let message = "`shaking` works against friction, which an elastic sheet has none of: remove it, or add [assumptions] \
                           law = \"friction\"";
            return refused(at.key_place("shaking"), message);
        }
        let (ring, layout) = sheet.ring(of_sheet)?;
        let message = "a drape has no [[probes]] and no [[checks]]: remove them";
        foreign(case, &["probes", "checks"], message)?;
        let message =
            "a drape hangs from its disc alone: [[supports]] of set = \"inner\" only, and no [[rigid]]";
        foreign(case, &["rigid"], message)?;
        let purpose = Purpose { large_rotations: true, drape: true, mass: None };
        let formulation = self.element.formulation(case, purpose)?;
        let solver = self.solver.checked(case, false)?;
        let mounting = self.mounting(case, formulation)?;
        let supports = case.get("supports");
        let mut places = mounting.supports.iter().zip(supports.iter().flat_map(Node::items));
        if let Some((_, at)) = places.find(|(support, _)| support.set.value != "inner") {
            return refused(at.value_place("set"), message);
        }
        Ok(DrapeProblem {
            material,
            ring,
            layout,
            table: of_sheet.located(()),
            mounting,
            gravity: weight(case)?,
            folds: drape.folds,
            refinements: drape.refinements,
            is_quick: false,
            sizes_as_measured: drape.sizes == DrapeSizes::Measured,
            shaking: drape.shaking,
            solver,
        })
    }
}

const NO_CONVERGENCE: &str = "[convergence] is for linear, modal, buckling and nonlinear analyses without [[steps]]: remove it (a drape has `refinements`)";

const NO_ADAPTIVE: &str = "[adaptive] is for linear and nonlinear analyses of a [sheet] without [[steps]]: remove it (a drape has `refinements`)";

const NO_OBSTACLES: &str = "[[obstacles]] are for large rotations: write [analysis] kind = \"nonlinear\", or kind = \"newmark\" with \
                            large_rotations = true and without spectral_radius, or remove them (a drape is clamped between its discs)";

const NO_STEPS: &str =
    "[[steps]] are for large rotations: write [analysis] kind = \"nonlinear\", or remove them";

/// Refuses tables that a problem has no use for.
fn foreign(case: &Node<'_>, keys: &[&str], message: &str) -> Result<(), CaseError> {
    match keys.iter().find(|key| case.has(key)) {
        Some(key) => refused(case.key_place(key), message),
        None => Ok(()),
    }
}

/// Refuses what neither a virtual test nor a bending test has.
fn without_analysis(case: &Node<'_>) -> Result<(), CaseError> {
    foreign(
        case,
        &["analysis", "steps", "checks"],
        "a [virtual_test] or [bending_test] brings its own analysis and is compared with what was measured: \
         remove [analysis], [[steps]] and [[checks]]",
    )?;
    foreign(case, &["adaptive"], NO_ADAPTIVE)?;
    foreign(case, &["convergence"], "[convergence] is for cases with a [sheet]: remove it")
}

/// What acts on a sheet, and that is not nothing.
fn loads(case: &Node<'_>) -> Result<SheetLoads, CaseError> {
    let loads = SheetLoads::read(case)?;
    if loads.is_empty() {
        return refused(case.place(), "nothing acts on the sheet: add [[loads]]");
    }
    Ok(loads)
}

/// The weight of a drape.
fn weight(case: &Node<'_>) -> Result<Vec<Vector3<f64>>, CaseError> {
    let loads = case.get("loads");
    let mut gravity = Vec::new();
    for at in loads.iter().flat_map(Node::items) {
        match LoadTable::read(&at)?.load(&at)? {
            Some(SheetLoad::Gravity(g)) if g.x == 0.0 && g.y == 0.0 && g.z < 0.0 => gravity.push(g),
            _ => {
                return refused(
                    at.value_place("kind"),
                    "a drape hangs under its weight: [[loads]] of kind = \"gravity\" along -z only",
                );
            }
        }
    }
    if gravity.is_empty() {
        return refused(case.place(), "nothing acts on the sheet: add [[loads]]");
    }
    Ok(gravity)
}
