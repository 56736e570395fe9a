//! `[adaptive]`: a mesh that is refined where the estimate of its error asks for it.

use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::sheet::Sheet;
use crate::constitutive::Assumptions;
use crate::finding::{Located, Node};
use crate::quantity::Ratio;

/// `[adaptive]`: the case is solved on the mesh of `[sheet]`, the cells with the largest part of the estimated error are divided in
/// four, and it is solved again, until the estimate is small enough.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct AdaptiveTable {
    /// The estimated error in the energy norm, over the whole, at which it ends: the `energy error` of the results.
    #[cfg_attr(test, schemars(example = &"5 %"))]
    error: Ratio,
    /// Meshes at most, with that of `[sheet]`.
    #[serde(default = "meshes")]
    meshes: usize,
    /// Elements at most: a mesh of more is not solved.
    #[serde(default = "elements")]
    elements: usize,
}

fn meshes() -> usize {
    10
}

fn elements() -> usize {
    20_000
}

/// How far a mesh is refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// The estimated relative error in the energy norm at which it ends, 0 to 1.
    pub error: f64,
    /// Meshes at most, with the first; 2 or more.
    pub meshes: usize,
    /// Elements of a mesh at most.
    pub elements: usize,
}

impl AdaptiveTable {
    /// What the table at a node asks for.
    pub fn checked(
        self,
        at: &Node<'_>,
        case: &Node<'_>,
        sheet: &Sheet,
        assumptions: Option<&Assumptions>,
    ) -> Result<Located<Adaptive>, CaseError> {
        let error = self.error.si();
        if !(error > 0.0 && error < 1.0) {
            let message =
                "[adaptive] error: give a part of the whole between 0 and 100 %, such as error = \"5 %\"";
            return refused(at.value_place("error"), message);
        }
        if self.meshes < 2 {
            let message =
                format!("[adaptive] meshes = {}: take 2 or more, or remove [adaptive]", self.meshes);
            return refused(at.value_place("meshes"), message);
        }
        if self.elements == 0 {
            let message = "[adaptive] elements = 0: give how many a mesh may have, such as 20000";
            return refused(at.value_place("elements"), message);
        }
        if sheet.outline.cells().is_none() {
            let message = "[adaptive] divides the cells of a shape, and a mesh file or a drawing has none: remove it, or give `shape`";
            return refused(at.place(), message);
        }
        for (other, message) in [
            (
                "convergence",
                "[adaptive] refines one mesh, [convergence] compares equal ones: remove one of them",
            ),
            (
                "uncertainty",
                "[adaptive] has a mesh for each solution, and bands by sampling need the same one: remove one of them",
            ),
            (
                "obstacles",
                "[adaptive] would divide cells at the edges of [[obstacles]], where the estimate is too large: remove one of them",
            ),
        ] {
            if case.has(other) {
                return refused(at.place(), message);
            }
        }
        if assumptions.is_some_and(Assumptions::has_laws) {
            let message = "[adaptive] follows an estimate that a sheet with a law does not have: remove it, or `law` and `tensile_law`";
            return refused(at.place(), message);
        }
        Ok(at.located(Adaptive { error, meshes: self.meshes, elements: self.elements }))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::case::{Adaptive, Case};
    use crate::element::Membrane;

    const PRESSED: &str = r#"
title = "t"
[section]
tensile_warp = "10.92e6 N/m"
tensile_weft = "10.92e6 N/m"
poisson = 0.3
shear = "4.2e6 N/m"
bending_warp = "1 N·m"
bending_weft = "1 N·m"
bending_coupling = "0.3 N·m"
torsion = "0.35 N·m"
transverse_shear = "3.5e6 N/m"
areal_density = "1 kg/m²"
thickness = "1 mm"
[[supports]]
set = "boundary"
kind = "clamped"
[[loads]]
kind = "pressure"
value = "0.001 Pa"
[sheet]
shape = "disc"
diameter = "1 m"
cells = 4
"#;

    fn parse(text: &str) -> Result<Case, crate::case::CaseError> {
        Case::parse(Path::new("c.toml"), text)
    }

    #[test]
    fn what_is_left_out_has_limits() {
        let text = PRESSED
            .replace("disc", "rectangle")
            .replace("diameter = \"1 m\"", "width = \"1 m\"\nheight = \"1 m\"");
        let text = text.replace("cells = 4", "cells = [4, 4]");
        let nonlinear = "[analysis]\nkind = \"nonlinear\"\n";
        for (more, membrane) in [("", Membrane::Cells), (nonlinear, Membrane::AssumedStress)] {
            let case = parse(&format!("{text}[adaptive]\nerror = \"5 %\"\n{more}")).unwrap();
            let problem = case.sheet().unwrap();
            let adaptive = problem.analysis.adaptive().unwrap();
            assert_eq!(adaptive.value, Adaptive { error: 0.05, meshes: 10, elements: 20_000 });
            // One membrane on all meshes, with triangles and without.
            assert_eq!(problem.mounting.formulation.membrane, membrane);
        }
    }

    /// Every refusal has its place: line and column of the key or table that it speaks of.
    #[test]
    fn what_cannot_be_refined_is_refused_at_its_place() {
        let square = PRESSED.replace("disc", "rectangle").replace("diameter", "height = \"1 m\"\nwidth");
        let square = square.replace("cells = 4", "cells = [4, 4]");
        let lines = square.lines().count();
        let plain = "[adaptive]\nerror = \"5 %\"\n";
        for (more, line, why) in [
            ("[adaptive]\nerror = \"0 %\"\n", 2, "between 0 and 100 %"),
            ("[adaptive]\nerror = \"100 %\"\n", 2, "between 0 and 100 %"),
            ("[adaptive]\nerror = \"5 %\"\nmeshes = 1\n", 3, "2 or more"),
            ("[adaptive]\nerror = \"5 %\"\nelements = 0\n", 3, "elements = 0"),
            (&format!("{plain}[convergence]\n"), 1, "remove one of them"),
            (&format!("{plain}[analysis]\nkind = \"modal\"\n"), 1, "linear and nonlinear"),
            (&format!("{plain}[analysis]\nkind = \"buckling\"\n"), 1, "linear and nonlinear"),
            (
                &format!("{plain}[analysis]\nkind = \"newmark\"\nduration = \"0.1 s\"\nstep = \"1 ms\"\n"),
                1,
                "linear and nonlinear",
            ),
            (
                &format!("{plain}[analysis]\nkind = \"nonlinear\"\n[[steps]]\nname = \"a\"\n"),
                1,
                "linear and nonlinear",
            ),
            (&format!("{plain}[element]\nprofile = \"fourth_order\"\n"), 4, "equal rectangles"),
            (&format!("{plain}[element]\nprofile = \"seed\"\n"), 4, "shear_stabilisation"),
            (&format!("{plain}[element]\nshear_stabilisation = 0\n"), 4, "shear_stabilisation"),
            (&format!("{plain}[element]\nshear = \"displacement\"\n"), 4, "mitc4"),
            (
                &format!(
                    "{plain}[analysis]\nkind = \"nonlinear\"\n[[obstacles]]\nkind = \"plane\"\nat = [\"0 m\", \"0 m\", \
                     \"-1 m\"]\nnormal = [0.0, 0.0, 1.0]\n"
                ),
                1,
                "obstacles",
            ),
        ] {
            let e = parse(&format!("{square}{more}")).unwrap_err();
            assert!(e.code() == "S003" && e.to_string().contains(why), "{more}: {e}");
            assert_eq!(e.place().line, lines + line, "{more}: {e}");
        }
        let file = square.replace(
            "shape = \"rectangle\"\nheight = \"1 m\"\nwidth = \"1 m\"\ncells = [4, 4]",
            "file = \"a.msh\"\nunit = \"m\"",
        );
        assert!(parse(&format!("{file}{plain}")).unwrap_err().to_string().contains("mesh file"));
        assert_eq!(parse(&format!("{square}[adaptive]\n")).unwrap_err().code(), "S002");
    }
}
