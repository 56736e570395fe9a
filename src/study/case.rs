//! The case file: what is solved, in TOML, with units on every number that has one.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use thiserror::Error;

use super::solver::SolverTable;
use crate::constitutive::Assumptions;
use crate::finding::Place;
use crate::instrument::Test;
use crate::quantity::{
    Acceleration, ArealDensity, BendingRigidity, Curvature, Length, LineForce, LineMoment, Pressure, Time,
};

/// A case as it is written in its file; unknown keys are refused.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Identifier: the stem of the file name.
    #[serde(skip)]
    pub name: String,
    /// The file.
    #[serde(skip)]
    pub path: PathBuf,
    /// For people.
    pub title: String,
    /// Where the problem comes from.
    pub source: Option<String>,
    /// A fabric folder, or `*` for every fabric at hand.
    pub fabric: Option<String>,
    /// Explicit constants instead of a fabric.
    pub section: Option<SectionTable>,
    /// Choices between a fabric's sheet and its section.
    #[serde(default)]
    pub assumptions: Assumptions,
    /// The sheet and its mesh.
    pub sheet: Option<Sheet>,
    /// The element.
    #[serde(default)]
    pub element: ElementTable,
    /// Where it is held.
    #[serde(default)]
    pub supports: Vec<SupportTable>,
    /// What acts on it.
    #[serde(default)]
    pub loads: Vec<LoadTable>,
    /// A test of an instrument instead of `sheet`, `supports` and `loads`.
    pub virtual_test: Option<VirtualTest>,
    /// What is computed.
    #[serde(default)]
    pub analysis: Analysis,
    /// How the equations are solved.
    #[serde(default)]
    pub solver: SolverTable,
    /// Points whose values are reported.
    #[serde(default)]
    pub probes: Vec<ProbeTable>,
    /// Values that must come out.
    #[serde(default)]
    pub checks: Vec<Check>,
}

/// `[section]`: constants of a shell, per unit width.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SectionTable {
    /// E1 t.
    pub tensile_warp: LineForce,
    /// E2 t.
    pub tensile_weft: LineForce,
    /// √(ν12 ν21).
    pub poisson: f64,
    /// G12 t.
    pub shear: LineForce,
    /// D11.
    pub bending_warp: BendingRigidity,
    /// D22.
    pub bending_weft: BendingRigidity,
    /// D12.
    pub bending_coupling: BendingRigidity,
    /// D66, the seed's H.
    pub torsion: BendingRigidity,
    /// χ G_t t.
    pub transverse_shear: LineForce,
    /// Mass per area.
    pub areal_density: ArealDensity,
    /// Thickness.
    pub thickness: Length,
}

/// `[sheet]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// Which outline; left out when the mesh comes from a file.
    pub shape: Option<Shape>,
    /// A Gmsh mesh (MSH 4.1, ASCII, quads), relative to the case file.
    pub file: Option<PathBuf>,
    /// Unit of the coordinates in the file, such as `"mm"`.
    pub unit: Option<String>,
    /// Along x (`rectangle`), or the length of a `strip` along x.
    pub width: Option<Length>,
    /// Along y (`rectangle`), or the breadth of a `strip` along y.
    pub height: Option<Length>,
    /// Of a `disc`; outer one of an `annulus`.
    pub diameter: Option<Length>,
    /// Inner one of an `annulus`.
    pub inner_diameter: Option<Length>,
    /// Cells along x and y; across the core of a disc (one number twice); along the radius and
    /// around an annulus.
    pub cells: Option<[usize; 2]>,
    /// Angle of the warp from x.
    #[serde(default)]
    pub warp_angle_deg: f64,
    /// Seeded displacement of interior nodes, 0 to 0.5 of half an edge.
    #[serde(default)]
    pub distortion: f64,
    /// Seed of the distortion.
    #[serde(default)]
    pub seed: u64,
}

/// Outline of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// `width` x `height`, lower left corner at the origin.
    Rectangle,
    /// The same; the word for a long narrow one.
    Strip,
    /// `diameter`, centre at the origin.
    Disc,
    /// `inner_diameter` to `diameter`, centre at the origin.
    Annulus,
}

/// `[element]`; what is left out is as in the profile, and that is the default one when left out.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ElementTable {
    /// A named formulation to start from.
    pub profile: Option<Profile>,
    /// Smoothing cells: a number (1, 2, 3, 4, 9, 16 ...) or `[along_xi, along_eta]`; 4.
    pub subcells: Option<Subcells>,
    /// α of the transverse shear; 0.05, seed 0.
    pub shear_stabilisation: Option<f64>,
    /// What holds the drilling rotation; `scaled`, seed `seed`.
    pub drilling: Option<DrillingChoice>,
}

/// Named formulations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// The paper's: nc = 4, no shear stabilisation, drilling spring 1e-3.
    Seed,
}

/// Smoothing cells as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum Subcells {
    /// nc of the paper.
    Count(u32),
    /// A grid.
    Grid([u8; 2]),
}

/// Drilling stiffness as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DrillingChoice {
    /// Scaled penalty (default).
    Scaled,
    /// Penalty with the membrane shear stiffness.
    HughesBrezzi,
    /// The paper's spring, 1e-3 of the largest diagonal term.
    Seed,
}

/// `[[supports]]`: a set with either a kind or a list of dofs.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SupportTable {
    /// Node set.
    pub set: String,
    /// A named kind.
    pub kind: Option<SupportKind>,
    /// Names of dofs: `u v w theta_x theta_y theta_z`.
    pub fix: Option<Vec<String>>,
}

/// Named supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SupportKind {
    /// All dofs held.
    Clamped,
    /// Displacements held, and the rotation along the normal of the edge: a thin plate on a support.
    SimplySupported,
    /// Displacements held only.
    SimplySupportedSoft,
    /// Symmetry about a plane x = const.
    SymmetryX,
    /// Symmetry about a plane y = const.
    SymmetryY,
    /// Nothing held; a way to say so.
    Free,
}

/// `[[loads]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum LoadTable {
    /// Along the normal of the sheet (+z of a flat one).
    Pressure {
        /// Pressure.
        value: Pressure,
    },
    /// Own weight.
    Gravity {
        /// Acceleration; standard gravity when left out.
        value: Option<Acceleration>,
        /// Direction; `[0, 0, -1]` when left out.
        direction: Option<[f64; 3]>,
    },
    /// A force (N) or moment (N·m) shared by the nodes of a set.
    Point {
        /// Node set.
        set: String,
        /// Force, such as `"0.1 N"`, or moment, such as `"1 N·mm"`.
        value: String,
        /// Direction of the force or axis of the moment.
        direction: [f64; 3],
    },
    /// A force per length on the boundary edges of a set.
    EdgeForce {
        /// Node set.
        set: String,
        /// Force per length.
        value: LineForce,
        /// Direction.
        direction: [f64; 3],
    },
    /// A moment per length on the boundary edges of a set.
    EdgeMoment {
        /// Node set.
        set: String,
        /// Moment per length.
        value: LineMoment,
        /// Axis.
        direction: [f64; 3],
    },
    /// A displacement or rotation of a set.
    Prescribed {
        /// Node set.
        set: String,
        /// `u v w theta_x theta_y theta_z`.
        dof: String,
        /// Displacement, such as `"1 mm"`, or rotation, such as `"2 deg"`.
        value: String,
    },
}

/// `[analysis]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Analysis {
    /// Small displacements, one solve.
    #[default]
    Linear,
    /// Natural frequencies and modes; loads are not used.
    Modal {
        /// How many of the lowest.
        #[serde(default = "default_modes")]
        modes: usize,
        /// Row sums as mass matrix instead of the consistent one.
        #[serde(default)]
        lumped: bool,
    },
    /// Linear dynamics from rest (Newmark, average acceleration).
    Newmark {
        /// End of the time range.
        duration: Time,
        /// Time step; the first one when a tolerance is given.
        step: Time,
        /// Relative local error at which the step adapts; constant step when left out.
        tolerance: Option<f64>,
        /// Damping ratios of the first and the third natural frequency; undamped when left out.
        damping: Option<[f64; 2]>,
        /// `"step"`, `"ramp until 0.1 s"` or `"sine 5 Hz"`.
        #[serde(default = "default_load_history")]
        load: String,
        /// Row sums as mass matrix.
        #[serde(default)]
        lumped: bool,
    },
}

fn default_modes() -> usize {
    6
}

fn default_load_history() -> String {
    "step".into()
}

/// `[virtual_test]`: an instrument's test as a model, once along the warp and once along the weft.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VirtualTest {
    /// Which test.
    pub test: Test,
    /// Elements along the gauge length and across the specimen.
    #[serde(default = "default_cells")]
    pub cells: [usize; 2],
    /// Largest curvature of a bending test; 2.5 1/cm.
    pub curvature: Option<Curvature>,
}

fn default_cells() -> [usize; 2] {
    [10, 20]
}

/// `[[probes]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProbeTable {
    /// Name used in results and checks.
    pub name: String,
    /// Point of the undeformed sheet.
    pub at: [Length; 2],
}

/// `[[checks]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// `w_max`, `strain_energy`, or `<probe>.<u|v|w|theta_x|...|moment_x|membrane_x|shear_x ...>`.
    pub quantity: String,
    /// Expected value with unit.
    pub expected: String,
    /// Accepted |value - expected| / |expected|.
    pub relative_tolerance: f64,
    /// Where the expected value comes from.
    pub reference: Reference,
}

/// The source of an expected value.
#[derive(Clone, Debug, Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// What kind of reference.
    pub kind: ReferenceKind,
    /// Citation.
    pub source: String,
}

/// Kinds of references; an accuracy claim never rests on `own`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReferenceKind {
    /// A closed form or a high-precision series.
    Analytical,
    /// A number printed elsewhere.
    Published,
    /// A measurement.
    Measured,
    /// This program's own earlier result: guards against change, proves nothing.
    Own,
}

/// What is wrong with a case file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CaseError {
    /// S001: it cannot be read.
    #[error("{place}: S001 cannot read the case: {reason}")]
    Unreadable {
        /// The file.
        place: Place,
        /// The system's message.
        reason: String,
    },
    /// S002: not a case: syntax, an unknown key, a wrong unit.
    #[error("{place}: S002 {message}")]
    Malformed {
        /// Position.
        place: Place,
        /// What was found and expected.
        message: String,
    },
    /// S003: a combination of keys that makes no problem.
    #[error("{place}: S003 {message}")]
    Inconsistent {
        /// The file.
        place: Place,
        /// What is missing or too much, and what to do.
        message: String,
    },
}

impl CaseError {
    /// The stable code.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Unreadable { .. } => "S001",
            Self::Malformed { .. } => "S002",
            Self::Inconsistent { .. } => "S003",
        }
    }

    /// File and position.
    pub fn place(&self) -> &Place {
        match self {
            Self::Unreadable { place, .. }
            | Self::Malformed { place, .. }
            | Self::Inconsistent { place, .. } => place,
        }
    }
}

impl Case {
    /// Reads a case file.
    ///
    /// # Errors
    /// S001 to S003 with the position in the file.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let text = std::fs::read_to_string(path)
            .map_err(|e| CaseError::Unreadable { place: Place::file(path), reason: e.to_string() })?;
        Self::parse(path, &text)
    }

    /// Parses the text of a case file; `path` names it in messages.
    ///
    /// # Errors
    /// S002 and S003 with the position in the file.
    pub fn parse(path: &Path, text: &str) -> Result<Self, CaseError> {
        let mut case: Self = toml::from_str(text).map_err(|e| {
            let (line, column) = position(text, e.span().map_or(0, |s| s.start));
            CaseError::Malformed { place: Place::at(path, line, column), message: one_line(e.message()) }
        })?;
        case.path = path.to_path_buf();
        case.name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        case.consistent()?;
        Ok(case)
    }

    fn consistent(&self) -> Result<(), CaseError> {
        let refuse = |message: &str| {
            Err(CaseError::Inconsistent { place: Place::file(&self.path), message: message.into() })
        };
        match (&self.fabric, &self.section) {
            (None, None) => {
                return refuse("the case names neither `fabric` nor a [section]: give one of them");
            }
            (Some(_), Some(_)) => {
                return refuse("the case gives both `fabric` and [section]: remove one of them");
            }
            _ => {}
        }
        match (&self.sheet, &self.virtual_test) {
            (None, None) => refuse("the case has neither a [sheet] nor a [virtual_test]: give one of them"),
            (Some(_), Some(_)) => {
                refuse("a [virtual_test] brings its own specimen: remove [sheet], or the [virtual_test]")
            }
            (None, Some(_))
                if !(self.supports.is_empty() && self.loads.is_empty() && self.probes.is_empty()) =>
            {
                refuse(
                    "a [virtual_test] brings its own supports and loads: remove [[supports]], [[loads]], [[probes]]",
                )
            }
            (Some(_), None) if self.supports.is_empty() => {
                refuse("nothing holds the sheet: add [[supports]] (kind = \"free\" says that this is meant)")
            }
            (Some(_), None) if self.loads.is_empty() && !matches!(self.analysis, Analysis::Modal { .. }) => {
                refuse("nothing acts on the sheet: add [[loads]]")
            }
            (Some(_), None) if !self.loads.is_empty() && matches!(self.analysis, Analysis::Modal { .. }) => {
                refuse("a modal analysis has no loads: remove [[loads]]")
            }
            _ => Ok(()),
        }
    }
}

/// Line and column (from 1, in characters) of a byte offset.
fn position(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
    (line, column)
}

fn one_line(message: &str) -> String {
    message.lines().map(str::trim).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"
title = "t"
fabric = "*"
[sheet]
shape = "rectangle"
width = "20 cm"
height = "20 cm"
cells = [4, 4]
[[supports]]
set = "boundary"
kind = "clamped"
[[loads]]
kind = "pressure"
value = "0.5 Pa"
"#;

    fn error(from: &str, to: &str) -> CaseError {
        assert!(GOOD.contains(from));
        Case::parse(Path::new("c.toml"), &GOOD.replace(from, to)).unwrap_err()
    }

    #[test]
    fn a_case_is_read_and_named_after_its_file() {
        let case = Case::parse(Path::new("cases/plate.toml"), GOOD).unwrap();
        assert_eq!(case.name, "plate");
        assert_eq!(case.element.subcells, None);
    }

    #[test]
    fn mistakes_are_placed_and_say_what_was_expected() {
        let e = error("width = \"20 cm\"", "width = 20");
        assert_eq!((e.code(), e.place().line), ("S002", 6));
        assert!(e.to_string().contains("20 cm"), "{e}");
        let e = error("cells", "celsl");
        assert!(e.to_string().contains("celsl") && e.place().line > 1, "{e}");
        assert!(error("\"0.5 Pa\"", "\"0.5 N\"").to_string().contains("Pa"));
        assert_eq!(error("fabric = \"*\"", "").code(), "S003");
        assert_eq!(error("[sheet]", "[shet]").code(), "S002");
    }
}
