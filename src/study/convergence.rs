//! What the mesh leaves open in a result: the case on coarser meshes, and what its values approach.

use super::checked::lookup;
use super::mesh_series::{Convergence, MeshSeries};
use super::result::CaseResult;
use super::{Case, StudyError};
use crate::case::{Analysis, Buckling, Modal, ProbePoint, SheetProblem, unit_of};
use crate::fields::{Extrapolation, Resultants};
use crate::finding::{CoarseQuantity, Finding, Place, StudyFact};
use crate::model::Dof;

/// A value is 0 below this part of the largest of its kind in the sheet.
pub(super) const ROUNDING: f64 = 1e-9;
/// A value below this part of the largest of its kind in the sheet is not warned of.
const SMALL: f64 = 0.01;
/// Part of a value that the mesh may leave open without a warning.
const COARSE: f64 = 0.05;

impl Convergence {
    /// From the results on the meshes, coarsest first.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub(super) fn of(problem: &SheetProblem, results: &[&CaseResult]) -> Result<Self, StudyError> {
        let coarser = problem.analysis.coarser().into_iter().flat_map(|meshes| &meshes.value);
        let cells = coarser.chain([&problem.sheet]).filter_map(|s| s.outline.cells()).collect();
        let sizes = results.last().map_or(Ok(Sizes::default()), |finest| Sizes::of(finest))?;
        let series = |quantity: String| {
            let values: Vec<f64> = results.iter().filter_map(|r| lookup(&quantity, r)).collect();
            let unit = unit_of(&quantity, &problem.analysis, &problem.probes)?;
            let (unit, finest) = (unit, values.last()?.abs());
            let size = sizes.like(&quantity).unwrap_or(finest);
            // A coarse mesh may have fewer modes.
            let known = values.len() == results.len() && finest > ROUNDING * size;
            let extrapolation = Extrapolation::of(&values).filter(|_| known)?;
            Some(MeshSeries { quantity, unit: unit.into(), values, extrapolation, size })
        };
        Ok(Self { cells, quantities: names(problem).into_iter().filter_map(series).collect() })
    }

    /// What the mesh leaves too open.
    pub(super) fn finding(&self, case: &Case) -> Option<Finding> {
        let open = |q: &&MeshSeries| q.relative_index() > COARSE && q.finest().abs() > SMALL * q.size;
        let quantities: Vec<CoarseQuantity> = (self.quantities.iter().filter(open))
            .map(|q| CoarseQuantity { quantity: q.quantity.clone(), left: q.relative_index() })
            .collect();
        (self.quantities.is_empty() || !quantities.is_empty())
            .then(|| Finding::new(StudyFact::CoarseMesh { quantities }).at(Place::file(&case.path)))
    }
}

/// The largest values in a sheet.
#[derive(Default)]
pub(super) struct Sizes {
    /// Displacement (m) and rotation (rad).
    motion: [f64; 2],
    /// Membrane force (N/m), moment (N), shear force (N/m).
    resultants: [f64; 3],
}

impl Sizes {
    /// Those of a result; none of modes, which have no size.
    pub fn of(result: &CaseResult) -> Result<Self, StudyError> {
        let largest = |values: &[f64], size: f64| values.iter().fold(size, |m, v| m.max(v.abs()));
        let mut sizes = Self::default();
        if result.is_modal() {
            return Ok(sizes);
        }
        for node in result.solution.displacement.chunks_exact(6) {
            let [u, theta] = sizes.motion;
            sizes.motion = [largest(&node[..3], u), largest(&node[3..], theta)];
        }
        for r in result.nodal()? {
            let [n, m, q] = sizes.resultants;
            sizes.resultants = [largest(&r.membrane, n), largest(&r.moment, m), largest(&r.shear, q)];
        }
        Ok(sizes)
    }

    /// The largest of the kind of a probe's value; `None` for other results.
    pub fn like(&self, quantity: &str) -> Option<f64> {
        let (_, component) = quantity.split_once('.')?;
        let kind = component.split('_').next()?;
        Some(match kind {
            "membrane" => self.resultants[0],
            "moment" => self.resultants[1],
            "shear" => self.resultants[2],
            "theta" => self.motion[1],
            _ => self.motion[0],
        })
    }
}

/// The results of a case by name.
pub(super) fn names(problem: &SheetProblem) -> Vec<String> {
    if let Analysis::Modal(Modal { modes, .. }) = &problem.analysis {
        return (1..=*modes).map(|k| format!("frequency_{k}")).collect();
    }
    if let Analysis::Buckling(Buckling { factors, .. }) = &problem.analysis {
        return (1..=*factors).map(|k| format!("load_factor_{k}")).collect();
    }
    let components = || {
        let dofs = Dof::ALL.into_iter().map(Dof::name);
        dofs.chain(Resultants::COMPONENTS.into_iter().map(|(name, _)| name))
    };
    let of_probe = |p: &ProbePoint| components().map(|c| format!("{}.{c}", p.name)).collect::<Vec<_>>();
    let all = ["w_max".to_string(), "strain_energy".to_string()];
    all.into_iter().chain(problem.probes.iter().flat_map(of_probe)).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::analytical::von_karman::VonKarmanPlate;
    use crate::solve::Options;
    use crate::study::{PreparedCase, Status, build, solve_case};

    /// A clamped square of side 1 m, D = 1 N·m, nu = 0.3, t = 1 mm, under 1 mPa.
    const SQUARE: &str = r#"
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
[sheet]
shape = "rectangle"
width = "1 m"
height = "1 m"
cells = [CELLS, CELLS]
[[supports]]
set = "boundary"
kind = "clamped"
"#;

    const PRESSED: &str = r#"
[[loads]]
kind = "pressure"
value = "0.001 Pa"
[[probes]]
name = "centre"
at = ["0.5 m", "0.5 m"]
[[probes]]
name = "edge"
at = ["0 m", "0.5 m"]
"#;

    fn case(cells: usize, more: &str) -> Case {
        let text = format!("{}{more}", SQUARE.replace("CELLS", &cells.to_string()));
        Case::parse(Path::new("c.toml"), &text).unwrap()
    }

    fn solved(case: &Case) -> CaseResult {
        let section = build::section(case.section().unwrap()).unwrap();
        solve_case(case, section, &Options::default()).unwrap()
    }

    /// The meshes are those of cases of their own, and the index holds the distance to the series of
    /// superposition, which is eight times smaller after extrapolation, and more.
    #[test]
    fn coarser_meshes_tell_the_error_of_the_finest() {
        let result = solved(&case(16, &format!("{PRESSED}[convergence]\nmeshes = 3\n")));
        let found = result.convergence.as_ref().unwrap();
        assert_eq!(found.cells, [[4, 4], [8, 8], [16, 16]]);
        let w = found.get("centre.w").unwrap();
        for (value, cells) in w.values.iter().zip([4, 8, 16]) {
            assert_eq!(*value, solved(&case(cells, PRESSED)).probes[0].value.u[2], "{cells}");
        }
        for (quantity, exact) in [("centre.w", 1.26531908748e-6), ("centre.moment_x", 2.29050907842e-5)] {
            let series = found.get(quantity).unwrap();
            let error = |v: f64| (v - exact).abs() / exact;
            assert!(error(series.finest()) < series.relative_index(), "{quantity}");
            assert!(5.0 * error(series.extrapolation.value) < error(series.finest()), "{quantity}");
        }
        // By symmetry there is no rotation at the centre, and on the edge nothing moves at all.
        let absent = ["centre.theta_x", "centre.shear_y", "edge.w", "centre.membrane_x", "edge.moment_xy"];
        assert!(absent.iter().all(|q| found.get(q).is_none()));
        assert!(found.get("edge.moment_x").is_some() && found.get("strain_energy").is_some());
        let is_reported = |q: &MeshSeries| result.findings.iter().any(|f| f.message().contains(&q.quantity));
        assert!(
            found.quantities.iter().all(|q| is_reported(q) == (q.relative_index() > COARSE)),
            "{:?}",
            result.findings
        );
    }

    /// Large rotations: a clamped square that stretches, deflected by 1.4 thicknesses, against polynomials in von Karman's
    /// equations; its rotations of 0.01 rad add 1e-4 to them.
    #[test]
    fn a_nonlinear_case_tells_what_its_mesh_leaves_open() {
        let heavy = PRESSED.replace("0.001 Pa", "2 Pa");
        let nonlinear = format!("{heavy}[analysis]\nkind = \"nonlinear\"\n");
        let result = solved(&case(16, &format!("{nonlinear}[convergence]\n")));
        let found = result.convergence.as_ref().unwrap();
        assert_eq!(found.cells, [[4, 4], [8, 8], [16, 16]]);
        let w = found.get("centre.w").unwrap();
        assert_eq!(w.values[0], solved(&case(4, &nonlinear)).probes[0].value.u[2]);
        let plate = VonKarmanPlate::of_section(1.0, 1.0, &result.model.section);
        let exact = plate.clamped(2.0, 6).unwrap().deflection(0.5, 0.5);
        let [finest, limit] = [w.finest(), w.extrapolation.value].map(|value| (value - exact).abs() / exact);
        assert!((1.0..2.0).contains(&(exact / 1e-3)), "{exact}");
        assert!(finest < w.relative_index(), "{w:?}, exact {exact}");
        assert!(2.0 * limit < finest, "{w:?}, exact {exact}");
        assert!(found.get("centre.membrane_x").is_some() && found.get("strain_energy").is_some());
    }

    /// A search that came to no equilibrium on a coarser mesh leaves the result as it is, and says so.
    #[test]
    fn a_coarser_mesh_without_equilibrium_is_told() {
        let case = case(16, &format!("{PRESSED}[analysis]\nkind = \"nonlinear\"\n[convergence]\n"));
        let prepared = PreparedCase::new(&case, &Options::default()).unwrap();
        let section = build::section(case.section().unwrap()).unwrap();
        let result = prepared.solve(section).unwrap();
        let mut coarser = [result.clone(), result.clone()];
        coarser[1].status = Status::NotConverged;
        let mut reported = CaseResult { convergence: None, findings: Vec::new(), ..result };
        prepared.tell_meshes(&mut reported, &coarser).unwrap();
        assert!(reported.convergence.is_none());
        let [finding] = &reported.findings[..] else { panic!("{:?}", reported.findings) };
        assert!(
            finding.code() == "S150" && finding.message().contains("cells = [8, 8]"),
            "{}",
            finding.message()
        );
    }

    /// Of small displacements the estimate in large rotations is the linear one.
    #[test]
    fn the_error_of_a_search_under_little_load_is_that_of_a_linear_solve() {
        let [linear, search] = ["", "[analysis]\nkind = \"nonlinear\"\n"].map(|more| {
            solved(&case(8, &format!("{PRESSED}{more}"))).error_estimate().unwrap().unwrap().clone()
        });
        assert!((linear.relative() / search.relative() - 1.0).abs() < 1e-5);
        for (a, b) in linear.elements.iter().zip(&search.elements) {
            assert!((a - b).abs() < 1e-5 * linear.energy(), "{a} {b}");
        }
    }

    #[test]
    fn frequencies_of_which_a_coarse_mesh_has_none_are_left_out_and_coarse_ones_told() {
        let result =
            solved(&case(8, "[analysis]\nkind = \"modal\"\nmodes = 12\n[convergence]\nmeshes = 3\n"));
        let found = result.convergence.as_ref().unwrap();
        // 2 x 2 elements have one free node: three displacements, three modes across the sheet and two in it.
        assert!(found.quantities.len() < 12 && found.get("frequency_1").is_some());
        let coarse = result.findings.iter().find(|f| f.code() == "S106").unwrap();
        assert!(coarse.message().contains("frequency_2 ("), "{}", coarse.message());
    }

    /// Checking a case finds what only its coarser meshes lack, and names them.
    #[test]
    fn what_a_coarser_mesh_lacks_is_told_with_that_mesh() {
        let disc = SQUARE
            .replace(
                "shape = \"rectangle\"\nwidth = \"1 m\"\nheight = \"1 m\"",
                "shape = \"disc\"\ndiameter = \"1 m\"",
            )
            .replace("CELLS", "8");
        let rim = "[[loads]]\nkind = \"pressure\"\nvalue = \"0.001 Pa\"\n[[probes]]\nname = \"rim\"\nat = [\"0.4975 m\", \"0 m\"]\n";
        let at_angle = rim.replace("[\"0.4975 m\", \"0 m\"]", "[\"0.455 m\", \"0.19 m\"]");
        let case = |more: &str| Case::parse(Path::new("c.toml"), &format!("{disc}{at_angle}{more}")).unwrap();
        crate::study::validate(&case(""), &Options::default()).unwrap();
        let e = crate::study::validate(&case("[convergence]\n"), &Options::default()).unwrap_err();
        assert!(e.to_string().contains("cells = [2, 2]") && e.to_string().contains("rim"), "{e}");
    }

    #[test]
    fn what_has_no_coarser_meshes_is_refused() {
        let refused = |cells: usize, more: &str, why: &str| {
            let text = format!("{}{more}", SQUARE.replace("CELLS", &cells.to_string()));
            let e = Case::parse(Path::new("c.toml"), &text).unwrap_err();
            assert!(e.code() == "S003" && e.to_string().contains(why), "{e}");
        };
        let with = |more: &str| format!("{PRESSED}{more}");
        refused(18, &with("[convergence]\n"), "multiples of 4");
        refused(16, &with("[convergence]\nmeshes = 4\n"), "take 2 or 3");
        let motion = "[convergence]\n[analysis]\nkind = \"newmark\"\nduration = \"0.1 s\"\nstep = \"1 ms\"\n";
        refused(16, &with(motion), "linear, modal");
        let steps = "[convergence]\n[analysis]\nkind = \"nonlinear\"\n[[steps]]\nname = \"pressed\"\n";
        refused(
            16,
            &format!("{steps}{}", PRESSED.replace("[[loads]]", "[[steps.loads]]")),
            "without [[steps]]",
        );
        let file = SQUARE.replace("cells = [CELLS, CELLS]", "cells = [16, 16]\ndistortion = 0.2");
        let e = Case::parse(Path::new("c.toml"), &format!("{file}{PRESSED}[convergence]\n")).unwrap_err();
        assert!(e.to_string().contains("distorted"), "{e}");
    }
}
