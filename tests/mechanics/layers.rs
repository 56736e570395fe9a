//! Goal: layers of a sheet in large rotations that come to touch press each other, and do not pass.
//!
//! ```text
//!        .-''-.          the clamped ends of a strip are brought together, and the loop between them
//!       (      )         closes at its neck; by symmetry each half of it is pressed against
//!        '.  .'          the plane in its middle
//!   clamp==)(==clamp
//! ```
//! Reference: half of the strip against a rigid plane of symmetry, which `tests/mechanics/contact.rs` holds against the elastica. The two are
//! apart by the thickness of the sheet, in proportion to it.

use std::ops::ControlFlow;
use std::path::Path;

use kesf::element::Formulation;
use kesf::mesh::{crossings, rectangle};
use kesf::model::{Dof, Load, Model, RigidSurface, Support, SurfaceShape};
use kesf::section::ShellSection;
use kesf::solve::Options;
use kesf::solve::nonlinear::{Method, Settings, Solution, layers_in_touch, plan, search};
use kesf::study::{Case, CaseResult, section as section_of, solve_case};
use nalgebra::{Matrix2, Matrix3, Point3, Vector3};

/// Of the whole strip (m), and its bending rigidity (N·m).
const LENGTH: f64 = 0.2;
const B: f64 = 1e-5;

/// Part of the length that the clamps are brought nearer by.
const SHORTENING: f64 = 0.9;

/// A strip along x in cylindrical bending with clamped ends, of which the left one is moved by `shift`; a little weight tells it
/// where to go.
fn strip(length: f64, cells: usize, shift: f64, t: f64) -> Model {
    let plane = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5);
    let section = ShellSection {
        d_m: plane * (12.0 * B / (t * t)),
        d_b: plane * B,
        d_s: Matrix2::identity() * (5.0 * B / (t * t)),
        areal_density: 0.05,
        thickness: t,
    };
    let mesh = rectangle(length, LENGTH / 40.0, cells, 1).unwrap();
    let [left, right] = ["left", "right"].map(|set| mesh.set(set).unwrap().to_vec());
    Model {
        supports: vec![
            Support::fix(mesh.set("all").unwrap(), &[Dof::V, Dof::ThetaX, Dof::ThetaZ]),
            Support::fix(&left, &[Dof::W, Dof::ThetaY]),
            Support::at(left, vec![(Dof::U, shift)]),
            Support::fix(&right, &[Dof::U, Dof::ThetaY]),
        ],
        loads: vec![Load::Gravity(Vector3::new(0.0, 0.0, -1.0))],
        bodies: Vec::new(),
        section,
        mesh,
        warp: Vector3::x(),
        formulation: Formulation::default(),
    }
}

fn closed(model: &Model, settings: &Settings) -> Solution {
    let (options, settings) =
        (Options::default(), Settings { first_step: 0.02, largest_step: 0.05, ..settings.clone() });
    let plan = plan(model, &options).unwrap();
    let solution =
        search(model, &plan, &settings, &Method::Stable, &options, |_| ControlFlow::Continue(())).unwrap();
    assert!(solution.stability.is_stable());
    solution
}

/// Force that the left clamp needs (N).
fn force(model: &Model, solution: &Solution) -> f64 {
    model.mesh.set("left").unwrap().iter().map(|n| solution.reaction[6 * *n as usize]).sum()
}

#[test]
fn a_loop_closes_as_its_half_does_at_the_plane_of_symmetry() {
    let plane = SurfaceShape::Plane { at: Point3::new(0.5 * LENGTH, 0.0, 0.0), normal: -Vector3::x() };
    let surfaces = vec![RigidSurface { name: "middle".into(), shape: plane, friction: 0.0 }];
    let half = strip(0.5 * LENGTH, 20, 0.5 * SHORTENING * LENGTH, 1e-3);
    let at_plane = closed(&half, &Settings { surfaces, ..Settings::default() });
    let (energy, push) = (2.0 * at_plane.energy, force(&half, &at_plane));
    let mut distances = Vec::new();
    for t in [1e-3, 5e-4, 2.5e-4] {
        let mut whole = strip(LENGTH, 40, SHORTENING * LENGTH, t);
        whole.supports.push(Support::fix(whole.mesh.set("right").unwrap(), &[Dof::W]));
        // The membrane of the half, so that the layers alone differ.
        whole.section.d_m = half.section.d_m;
        whole.section.d_s = half.section.d_s;
        let through = closed(&whole, &Settings::default());
        assert!(
            crossings(&through.state.position, &whole.mesh.quads).is_some(),
            "the loop is large enough to cross"
        );
        let apart = closed(&whole, &Settings { self_contact: true, ..Settings::default() });
        assert_eq!(crossings(&apart.state.position, &whole.mesh.quads), None);
        let touching = layers_in_touch(&whole, &apart.state).expect("the neck is closed");
        assert!(touching.distance > 0.3 * t && touching.distance < t, "{touching:?}");
        distances.push([apart.energy / energy - 1.0, force(&whole, &apart) / push - 1.0]);
        println!(
            "t = {t}: {touching:?}, energy and force beside the half {:?}, through {:.2}",
            distances.last(),
            through.energy / energy - 1.0
        );
    }
    let [.., [energy, force]] = distances[..] else { panic!("a thickness") };
    assert!(energy.abs() < 4e-3 && force.abs() < 0.04, "{distances:?}");
    let falls = |k: usize| distances.windows(2).all(|pair| pair[1][k].abs() < 0.6 * pair[0][k].abs());
    assert!(falls(0) && falls(1), "in proportion to the thickness: {distances:?}");
}

const LOADS: &str = "[[loads]]\nkind = \"gravity\"\n\
    [[loads]]\nkind = \"prescribed\"\nset = \"jaw\"\ndof = \"u\"\nvalue = \"-18 cm\"\n";

fn solved(analysis: &str) -> CaseResult {
    let text = format!(
        "title = \"a loop\"\n[section]\ntensile_warp = \"1000 N/m\"\ntensile_weft = \"1000 N/m\"\npoisson = 0\n\
         shear = \"60 N/m\"\nbending_warp = \"1e-5 N·m\"\nbending_weft = \"1e-5 N·m\"\nbending_coupling = \"0 N·m\"\n\
         torsion = \"3e-6 N·m\"\ntransverse_shear = \"50 N/m\"\nareal_density = \"0.01 kg/m²\"\nthickness = \"0.5 mm\"\n\
         [sheet]\nshape = \"rectangle\"\nwidth = \"20 cm\"\nheight = \"1 cm\"\ncells = [40, 2]\n\
         [[rigid]]\nname = \"jaw\"\nset = \"right\"\n\
         [[supports]]\nset = \"left\"\nkind = \"clamped\"\n\
         [[supports]]\nset = \"jaw\"\nfix = [\"v\", \"w\", \"theta_x\", \"theta_y\", \"theta_z\"]\n{analysis}"
    );
    let case = Case::parse(Path::new("loop.toml"), &text).unwrap_or_else(|e| panic!("{e}"));
    let section = section_of(case.section().expect("a section")).expect("stiffnesses");
    solve_case(&case, section, &Options::default()).unwrap()
}

/// What a case does without being told to, and that it says so.
#[test]
fn a_case_keeps_its_layers_apart_and_tells() {
    let analysis = "[analysis]\nkind = \"nonlinear\"\nmethod = \"stable\"\nlargest_step = 0.05\n";
    let result = solved(&format!("{LOADS}{analysis}"));
    let codes: Vec<&str> = result.findings.iter().map(|f| f.code()).collect();
    assert!(codes.contains(&"S151") && !codes.contains(&"S144") && !codes.contains(&"S152"), "{codes:?}");
    let path = result.path.unwrap();
    assert!(path.converged && path.stability.unwrap().is_stable());
}

/// A step that leaves out what layers press each other by.
#[test]
fn a_step_that_knows_no_layers_says_so() {
    let result = solved(
        "[analysis]\nkind = \"nonlinear\"\nmethod = \"stable\"\nlargest_step = 0.05\n\
         [[steps]]\nname = \"close\"\n\
         [[steps.loads]]\nkind = \"gravity\"\n\
         [[steps.loads]]\nkind = \"prescribed\"\nset = \"jaw\"\ndof = \"u\"\nvalue = \"-18 cm\"\n\
         [[steps]]\nname = \"modes\"\n[steps.analysis]\nkind = \"modal\"\nmodes = 1\n",
    );
    let codes: Vec<&str> = result.findings.iter().map(|f| f.code()).collect();
    assert!(codes.contains(&"S151") && codes.contains(&"S152") && !codes.contains(&"S144"), "{codes:?}");
}
