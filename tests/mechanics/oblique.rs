//! Hard simple supports on edges that are along no axis.
//!
//! Goal: turning a sheet with all that is on it turns its answer, whatever solves it. Data: an
//! orthotropic rectangle 1 x 0.7, t = 1 mm, all edges hard, under pressure; turned in its plane and
//! in space. Reference: the same sheet along the axes.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use kesf::element::{Formulation, Mass};
use kesf::fields::edge_moments;
use kesf::mesh::rectangle;
use kesf::model::{Dof, Load, Model, RigidBody, Support};
use kesf::section::ShellSection;
use kesf::solve::iterative::Settings as Iteration;
use kesf::solve::linear::Method;
use kesf::solve::modal::modes;
use kesf::solve::newmark::{Beginning, LoadHistory, Rayleigh, Scheme, Settings, newmark};
use kesf::solve::{Options, solve};
use kesf::study::{Case, validate};
use nalgebra::{Matrix2, Matrix3, Rotation3, Vector3};

fn plate(turn: &Rotation3<f64>) -> Model {
    let mut mesh = rectangle(1.0, 0.7, 12, 10).unwrap();
    mesh.nodes.iter_mut().for_each(|p| *p = turn * *p);
    if (turn * Vector3::z()).z == 1.0 {
        mesh.nodes.iter_mut().for_each(|p| p.z = 0.0);
    }
    let d_b = Matrix3::new(1.0, 0.2, 0.0, 0.2, 0.4, 0.0, 0.0, 0.0, 0.15);
    let section = ShellSection {
        d_m: d_b * 12e6,
        d_b,
        d_s: Matrix2::identity() * 3.5e6,
        areal_density: 1.0,
        thickness: 1e-3,
    };
    let hard = |set: &&str| Support::simple(&mesh, set, true).unwrap();
    let supports = ["left", "bottom", "right", "top"].iter().map(hard).collect();
    Model {
        section,
        warp: turn * Vector3::x(),
        formulation: Formulation::default(),
        supports,
        loads: vec![Load::Pressure(1.0)],
        bodies: Vec::new(),
        mesh,
    }
}

fn about_z() -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), 0.5)
}

fn in_space() -> Rotation3<f64> {
    Rotation3::from_euler_angles(0.4, -0.7, 1.1)
}

/// The largest difference of nodal vectors, turned back, relative to the largest of them; displacements and rotations,
/// or forces and moments, apart.
fn off(turn: &Rotation3<f64>, turned: &[f64], along: &[f64]) -> f64 {
    let vectors = |u: &[f64], at: usize| -> Vec<Vector3<f64>> {
        u.chunks_exact(6).map(|n| Vector3::from_column_slice(&n[at..at + 3])).collect()
    };
    let deviation = |at: usize| {
        let (a, b) = (vectors(turned, at), vectors(along, at));
        let largest = b.iter().map(Vector3::norm).fold(0.0, f64::max);
        a.iter().zip(&b).map(|(a, b)| (turn.inverse() * a - b).norm()).fold(0.0, f64::max) / largest
    };
    deviation(0).max(deviation(3))
}

#[test]
fn a_turned_sheet_deflects_and_reacts_as_the_one_along_the_axes() {
    let coupled = Options { coupled: true, ..Options::default() };
    let iterated = Options {
        method: Method::Iterative,
        iteration: Iteration { tolerance: 1e-10, max_iterations: 500 },
        ..Options::default()
    };
    for (turn, options) in [
        (about_z(), Options::default()),
        (about_z(), coupled),
        (about_z(), iterated),
        (in_space(), Options::default()),
        (in_space(), iterated),
    ] {
        let along =
            solve(&plate(&Rotation3::identity()), &Options { method: Method::Direct, ..options }).unwrap();
        let model = plate(&turn);
        let found = solve(&model, &options).unwrap();
        let (u, r) = (
            off(&turn, &found.displacement, &along.displacement),
            off(&turn, &found.reaction, &along.reaction),
        );
        println!("displacements {u:.1e}, reactions {r:.1e}");
        assert!(u < 1e-8 && r < 1e-8, "{u:.1e} {r:.1e}");
        // What a hard support carries is a twist about the normal, no moment about the edge.
        let edges = model.mesh.set_edges("left").unwrap();
        let bending = edge_moments(&model.mesh, &found.reaction, &edges[1..edges.len() - 1]);
        assert!(bending.iter().flatten().all(|m| m.abs() < 1e-7), "{bending:?}");
    }
}

#[test]
fn it_swings_as_the_one_along_the_axes() {
    let settings = Settings {
        duration: 0.4,
        step: 0.02,
        tolerance: None,
        damping: Rayleigh::default(),
        load: LoadHistory::Step,
        mass: Mass::Lumped,
        scheme: Scheme::default(),
        beginning: Beginning::default(),
    };
    let centre = 6 * (5 * 13 + 6);
    let history = |turn: &Rotation3<f64>| {
        let normal = turn * Vector3::z();
        let mut w = Vec::new();
        newmark(&plate(turn), &settings, &Options::default(), |at| {
            w.push(Vector3::from_column_slice(&at.displacement[centre..centre + 3]).dot(&normal));
            ControlFlow::Continue(())
        })
        .unwrap();
        w
    };
    let lowest = |turn: &Rotation3<f64>| modes(&plate(turn), 4, Mass::Lumped, &Options::default()).unwrap();
    let (along, motion) = (lowest(&Rotation3::identity()), history(&Rotation3::identity()));
    for turn in [about_z(), in_space()] {
        for (a, b) in lowest(&turn).iter().zip(&along) {
            assert!((a.angular_frequency / b.angular_frequency - 1.0).abs() < 1e-8);
        }
        let largest = motion.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        assert!(history(&turn).iter().zip(&motion).all(|(a, b)| (a - b).abs() < 1e-6 * largest));
    }
}

/// A body, a prescribed rotation or a large one take a direction along that nothing can hold.
#[test]
fn what_turns_such_a_node_otherwise_is_refused() {
    let turn = about_z();
    let code = |model: &Model| solve(model, &Options::default()).unwrap_err().code().to_string();
    let mut model = plate(&turn);
    model.bodies = vec![RigidBody { nodes: vec![0, 1] }];
    assert_eq!(code(&model), "M009");
    let mut model = plate(&turn);
    model.supports.push(Support::at(vec![0], vec![(Dof::ThetaX, 0.1)]));
    let refused = solve(&model, &Options::default()).unwrap_err().to_string();
    assert!(refused.starts_with("M009 the node at (0.0000, 0.0000, 0.0000) m"), "{refused}");
    let large = kesf::solve::nonlinear::solve(
        &plate(&turn),
        &kesf::solve::nonlinear::Settings::default(),
        &Options::default(),
        |_| ControlFlow::Continue(()),
    );
    assert!(large.unwrap_err().to_string().contains("large rotations turn that direction away"));
}

/// Checking a case finds it before anything is solved.
#[test]
fn a_check_refuses_an_oblique_rim_in_large_rotations() {
    let text = fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/benchmark_clamped_isotropic.toml"),
    );
    let text = text.unwrap();
    let head = text.split("[[probes]]").next().unwrap().replace("clamped\"", "simply_supported\"");
    let (outline, disc) =
        ("width = \"1 m\"\nheight = \"1 m\"\ncells = [40, 40]", "diameter = \"1 m\"\ncells = [8, 8]");
    let head = head.replace("\"rectangle\"", "\"disc\"").replace(outline, disc).replace("boundary", "outer");
    let check = |analysis: &str| {
        validate(
            &Case::parse(Path::new("disc.toml"), &format!("{head}{analysis}")).unwrap(),
            &Options::default(),
        )
    };
    check("").unwrap();
    check("[analysis]\nkind = \"newmark\"\nduration = \"1 s\"\nstep = \"0.1 s\"").unwrap();
    for analysis in [
        "kind = \"nonlinear\"",
        "kind = \"newmark\"\nduration = \"1 s\"\nstep = \"0.1 s\"\nlarge_rotations = true",
    ] {
        let refused = check(&format!("[analysis]\n{analysis}")).unwrap_err().to_string();
        assert!(refused.contains("M009") && refused.contains("large rotations"), "{refused}");
    }
}
