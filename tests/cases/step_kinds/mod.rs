//! Goal: what can be asked about a loaded sheet beside where it comes to rest: how it vibrates there, how it buckles, and how it
//! moves on when supports move or let go.
//!
//! References (analytical): strings and hanging chains (Rayleigh, *Theory of Sound*; Lamb, *Higher Mechanics*), Euler columns and
//! plates (Timoshenko and Gere, *Theory of Elastic Stability*), their beams under axial force; a double sine Ritz series for
//! shear; oscillators in closed form, and one with friction by small steps of its own.

mod buckling;
mod friction;
mod modes;
mod motion;
mod refused;

use std::path::Path;

use kesf::solve::Options;
use kesf::study::{Case, CaseError, CaseResult, section, solve_case};

/// A strip along x in the plane of x and z: constants of its section, and what the case has besides.
pub struct Strip {
    pub membrane: f64,
    pub bending: f64,
    pub length: f64,
    pub cells: usize,
}

/// Mass per area of all strips (kg/m²).
pub const DENSITY: f64 = 0.15;
/// Breadth of all strips (m).
pub const BREADTH: f64 = 0.01;

impl Strip {
    pub fn parsed(&self, rest: &str) -> Result<Case, CaseError> {
        let Self { membrane, bending, length, cells } = self;
        let text = format!(
            r#"title = "strip"
[section]
tensile_warp = "{membrane} N/m"
tensile_weft = "{membrane} N/m"
poisson = 0.0
shear = "{membrane} N/m"
bending_warp = "{bending} N·m"
bending_weft = "{bending} N·m"
bending_coupling = "0 N·m"
torsion = "{bending} N·m"
transverse_shear = "1000 N/m"
areal_density = "{DENSITY} kg/m²"
thickness = "0.1 mm"
[sheet]
shape = "strip"
width = "{length} m"
height = "{BREADTH} m"
cells = [{cells}, 1]
[[supports]]
set = "all"
fix = ["v", "theta_x", "theta_z"]
[[probes]]
name = "middle"
at = ["{} m", "5 mm"]
[[probes]]
name = "end"
at = ["{length} m", "5 mm"]
{rest}"#,
            0.5 * length
        );
        Case::parse(Path::new("strip.toml"), &text)
    }

    pub fn solved(&self, rest: &str) -> CaseResult {
        solved(&self.parsed(rest).unwrap_or_else(|e| panic!("{e}")))
    }
}

pub fn solved(case: &Case) -> CaseResult {
    solve_case(case, section(case.section().unwrap()).unwrap(), &Options::default())
        .unwrap_or_else(|e| panic!("{e}"))
}

/// A support of a set.
pub fn fix(set: &str, dofs: &[&str]) -> String {
    format!("[[supports]]\nset = \"{set}\"\nfix = {dofs:?}\n")
}

pub const NONLINEAR: &str = "[analysis]\nkind = \"nonlinear\"\n";

/// A step with its loads.
pub fn step(name: &str, rest: &str) -> String {
    format!("[[steps]]\nname = \"{name}\"\n{rest}")
}

/// A pull on the right end of a strip (N/m), along x.
pub fn pull(newtons: f64) -> String {
    format!(
        "[[steps.loads]]\nkind = \"edge_force\"\nset = \"right\"\nvalue = \"{} N/m\"\ndirection = [{}, 0, 0]\n",
        newtons.abs(),
        newtons.signum()
    )
}

/// The values of a step.
pub fn of_step<'a>(result: &'a CaseResult, name: &str) -> &'a kesf::study::LoadStepEnd {
    result.path.as_ref().unwrap().load_steps.iter().find(|step| step.name == name).unwrap()
}
