//! Goal: sheets in motion stop at rigid surfaces, rub on them, and lose what physics says.
//!
//! ```text
//!      ______  falls h, stops: loses m g h           ____
//!   ____________  ground                        ____/ slides down: g (sin a - µ cos a)
//! ```
//! References (analytical): free fall, Coulomb's block on an inclined plane, a rope over a drum; the equilibrium of the
//! same strip by the statics of this program, which has references of its own (`tests/mechanics/contact.rs`).

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;

use kesf::element::{Formulation, Mass};
use kesf::mesh::rectangle;
use kesf::model::{Dof, Load, Model, RigidSurface, Support, SurfaceShape};
use kesf::section::ShellSection;
use kesf::solve::Options;
use kesf::solve::newmark::{LoadHistory, Rayleigh};
use kesf::solve::nonlinear::dynamics::{Dynamics, Launch, integrate_with};
use kesf::solve::nonlinear::{Carried, Flow, LoadStep, Method, Settings, continue_from, plan};
use kesf::study::{Case, CaseResult, section, solve_case};
use nalgebra::{Matrix2, Matrix3, Point3, Vector3};

const G: f64 = 9.80665;
/// Mass per area (kg/m²).
const RHO: f64 = 0.15;
const SECTION: &str = "title = \"impact\"\n[section]\ntensile_warp = \"600 N/m\"\ntensile_weft = \"600 N/m\"\npoisson = 0.3\nshear = \"230 N/m\"\n\
     bending_warp = \"8e-6 N·m\"\nbending_weft = \"8e-6 N·m\"\nbending_coupling = \"2.4e-6 N·m\"\ntorsion = \"2.8e-6 N·m\"\n\
     transverse_shear = \"200 N/m\"\nareal_density = \"0.15 kg/m²\"\nthickness = \"0.4 mm\"\n";

fn solved(text: &str) -> CaseResult {
    let case =
        Case::parse(Path::new("impact.toml"), &format!("{SECTION}{text}")).unwrap_or_else(|e| panic!("{e}"));
    solve_case(&case, section(case.section().unwrap()).unwrap(), &Options::default())
        .unwrap_or_else(|e| panic!("{e}"))
}

/// A sheet of 4 cm, free, over flat ground, with gravity along a direction.
fn free_sheet(direction: [f64; 3], ground: &str, duration: f64, step: f64) -> CaseResult {
    solved(&format!(
        "[sheet]\nshape = \"rectangle\"\nwidth = \"4 cm\"\nheight = \"4 cm\"\ncells = [4, 4]\n[[supports]]\nset = \"all\"\nkind = \"free\"\n\
         [[loads]]\nkind = \"gravity\"\ndirection = {direction:?}\n[[obstacles]]\nkind = \"plane\"\nname = \"ground\"\n{ground}\n\
         [analysis]\nkind = \"newmark\"\nlarge_rotations = true\nduration = \"{duration} s\"\nstep = \"{step} s\"\n\
         [[probes]]\nname = \"centre\"\nat = [\"2 cm\", \"2 cm\"]\n"
    ))
}

fn mass() -> f64 {
    RHO * 0.04 * 0.04
}

#[test]
fn a_sheet_that_falls_flat_stops_and_loses_what_it_fell() {
    let h: f64 = 0.05;
    for step in [1e-3, 4e-3] {
        let result =
            free_sheet([0.0, 0.0, -1.0], "at = [\"0 m\", \"0 m\", \"-5 cm\"]\nfriction = 0", 0.4, step);
        let history = result.history.as_ref().unwrap();
        let w = |k: usize| history.probe_displacements[0][k][2];
        // Free until it arrives.
        let arrival = (2.0 * h / G).sqrt();
        let before = history.time.iter().rposition(|t| *t < arrival - step).unwrap();
        let t = history.time[before];
        assert!((w(before) + 0.5 * G * t * t).abs() < 1e-9, "{} {}", w(before), -0.5 * G * t * t);
        let end = history.energy.last().unwrap();
        let (rest, lost) = (*history.probes[0].last().unwrap(), end.dissipated / (mass() * G * h));
        let deepest = history.probes[0].iter().fold(0.0f64, |m, w| m.min(*w)) + h;
        let again = history.time.iter().zip(&history.probes[0]).filter(|(t, _)| **t > arrival + 0.03);
        let rebound = again.map(|(_, w)| w + h).fold(f64::MIN, f64::max);
        println!(
            "step {step}: rests at {:.3e} m, deepest {deepest:.2e} m, rebound {rebound:.2e} m, loses {lost:.5}, balance {:.1e}",
            rest + h,
            history.imbalance
        );
        assert!((rest + h).abs() < 1e-6 && deepest > -2e-4 && rebound < 1e-5 && (lost - 1.0).abs() < 1e-4);
        assert!(history.imbalance < 1e-6 && end.kinetic < 1e-6 * mass() * G * h);
        let weight = &result.contacts[0];
        assert!((weight.force[2] / (mass() * G) - 1.0).abs() < 1e-3, "{:?}", weight.force);
        assert_eq!(weight.nodes, 25);
    }
}

#[test]
fn a_sheet_slides_down_an_inclined_plane_or_stays() {
    // The plane is level and the weight is oblique: 30 degrees.
    let (sin, cos) = (0.5, 0.75f64.sqrt());
    let direction = [sin, 0.0, -cos];
    let duration = 0.2;
    for mu in [0.0, 0.2, 0.4] {
        let ground = format!("at = [\"0 m\", \"0 m\", \"0 m\"]\nfriction = {mu}");
        let result = free_sheet(direction, &ground, duration, 1e-3);
        let history = result.history.as_ref().unwrap();
        let x = |t: f64| {
            let k = history.time.iter().position(|time| (time - t).abs() < 1e-6).unwrap();
            history.probe_displacements[0][k][0]
        };
        // It lies on the ground without a force at first: the acceleration once the ground bears it.
        let acceleration = (x(0.2) - 2.0 * x(0.125) + x(0.05)) / 0.075f64.powi(2);
        let (exact, travelled) = (G * (sin - mu * cos), x(0.2));
        let lost = history.energy.last().unwrap().dissipated / (mu * mass() * G * cos * travelled).max(1e-12);
        println!(
            "friction {mu}: slides with {acceleration:.6} m/s², exact {exact:.6}, lost over friction {lost:.4}"
        );
        assert!((acceleration / exact - 1.0).abs() < 1e-4, "{acceleration} {exact}");
        assert!(mu == 0.0 || (lost - 1.0).abs() < 1e-3, "{lost}");
        assert!(history.imbalance < 1e-5, "{}", history.imbalance);
    }
    // Steeper than it slides: sticks.
    let result = free_sheet(direction, "at = [\"0 m\", \"0 m\", \"0 m\"]\nfriction = 0.7", duration, 1e-3);
    let travelled = result.history.as_ref().unwrap().probe_displacements[0].last().unwrap()[0];
    println!("friction 0.7: travelled {travelled:.2e} m");
    assert!(travelled.abs() < 1e-5, "{travelled}");
}

const STRIP: &str = "[sheet]\nshape = \"strip\"\nwidth = \"20 cm\"\nheight = \"1 cm\"\ncells = [40, 1]\n\
     [[supports]]\nset = \"left\"\nkind = \"clamped\"\n[[loads]]\nkind = \"gravity\"\n\
     [[obstacles]]\nkind = \"plane\"\nname = \"ground\"\nat = [\"0 m\", \"0 m\", \"-5 cm\"]\nfriction = 0\n\
     [[probes]]\nname = \"end\"\nat = [\"20 cm\", \"5 mm\"]\n";

#[test]
fn a_strip_that_falls_on_the_ground_comes_to_rest_where_statics_lays_it() {
    let statics = solved(&format!("{STRIP}[analysis]\nkind = \"nonlinear\"\n"));
    let motion = solved(&format!(
        "{STRIP}[analysis]\nkind = \"newmark\"\nlarge_rotations = true\nduration = \"3 s\"\nstep = \"2 ms\"\ndamping = [0.3, 0.3]\n"
    ));
    let history = motion.history.as_ref().unwrap();
    let [a, b] = [&statics, &motion].map(|r| r.probes[0].value.u);
    let off = (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt();
    println!("end by statics {a:?}, by a motion {b:?}, apart {off:.2e} m; balance {:.1e}", history.imbalance);
    let [on_statics, on_motion] = [&statics, &motion].map(|r| r.contacts[0].force[2]);
    println!("the ground bears {on_statics:.6e} N and {on_motion:.6e} N");
    assert!(off < 2e-5 && (on_motion / on_statics - 1.0).abs() < 1e-3);
    assert!(history.imbalance < 1e-4 && history.energy.last().unwrap().kinetic < 1e-9);
}

/// A strip over a drum, half a turn, with a heavier and a lighter weight at its ends, which have no mass.
///
/// With tensions T1 and T2 where it meets the drum, lengths l1 and l2 beside it and mass ρ: T1 - P1 = ρ l1 a, P2 - T2 = ρ l2 a, and on
/// the drum dT = (μ T + ρ r a) dθ while it is slow.
fn acceleration_over_a_drum([p1, p2]: [f64; 2], [l1, l2]: [f64; 2], rho: f64, r: f64, mu: f64) -> f64 {
    let (grown, turn) = if mu > 0.0 { ((mu * PI).exp(), ((mu * PI).exp() - 1.0) / mu) } else { (1.0, PI) };
    (p2 - p1 * grown) / (rho * (l2 + l1 * grown + r * turn))
}

#[test]
fn a_strip_slides_over_a_drum() {
    let (length, radius, cells, rho) = (6.0, 1.0, 60, 1.0);
    let (b, t) = (1e-3, 1e-3);
    let plane = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.5));
    let section = ShellSection {
        d_m: plane * (12.0 * b / (t * t)),
        d_b: plane * b,
        d_s: Matrix2::identity() * (5.0 * b / (t * t)),
        areal_density: rho,
        thickness: t,
    };
    let mut mesh = rectangle(length, length / cells as f64, cells, 1).unwrap();
    mesh.nodes.iter_mut().for_each(|p| p.x -= 0.5 * length);
    let all = mesh.set("all").unwrap();
    let supports = vec![Support::fix(all, &[Dof::V, Dof::ThetaX, Dof::ThetaZ])];
    let [left, right] = ["left", "right"].map(|set| mesh.set_edges(set).unwrap());
    let end = mesh.set("right").unwrap()[0] as usize;
    let down = |edges: &[[u32; 2]], pull: f64| Load::Edge {
        edges: edges.to_vec(),
        force: Vector3::new(0.0, 0.0, -pull),
        moment: Vector3::zeros(),
    };
    let model = |pulls: [f64; 2]| Model {
        mesh: mesh.clone(),
        section: section.clone(),
        warp: Vector3::x(),
        supports: supports.clone(),
        loads: vec![down(&left, pulls[0]), down(&right, pulls[1])],
        formulation: Formulation::default(),
        bodies: Vec::new(),
    };
    for (mu, pulls) in [(0.0, [1.0, 1.5]), (0.3, [1.0, 3.5])] {
        let shape = SurfaceShape::Cylinder { at: Point3::new(0.0, 0.0, -radius), axis: Vector3::y(), radius };
        let drum = |friction| vec![RigidSurface { name: "drum".into(), shape, friction }];
        // Something has to hold it while it comes to rest.
        let surfaces = drum(mu);
        let settings =
            Settings { surfaces: drum(0.3), first_step: 0.02, largest_step: 0.05, ..Settings::default() };
        let (hanging, options) = (model([1.0; 2]), Options::default());
        let plan = plan(&hanging, &options).unwrap();
        let flow = Method::Flow(Flow { perturbation: 0.0, ..Flow::default() });
        let step = LoadStep { model: &hanging, prescribed: &[], settings: &settings, method: &flow };
        let (_, carried) =
            continue_from(&Carried::rest(&hanging), &step, &plan, &options, |_| ControlFlow::Continue(()))
                .unwrap();
        let pulled = model(pulls);
        let dynamics = Dynamics {
            duration: 1.2,
            step: 2e-3,
            tolerance: None,
            spectral_radius: None,
            damping: Rayleigh::default(),
            load: LoadHistory::Ramp(0.4),
            mass: Mass::Lumped,
        };
        let launch = Launch { carried: Some(&carried), surfaces: &surfaces, ..Launch::default() };
        let (mut heights, mut last) = (Vec::new(), Default::default());
        integrate_with(&pulled, &plan, &launch, &dynamics, &options, |at| {
            heights.push((at.time, at.displacement[6 * end + 2]));
            last = at.energy;
            ControlFlow::Continue(())
        })
        .unwrap();
        // Steps may have been halved.
        let height = |t: f64| {
            let after = heights.iter().position(|(time, _)| *time >= t - 1e-9).unwrap();
            let [(t0, z0), (t1, z1)] = [heights[after - 1], heights[after]];
            z0 + (z1 - z0) * (t - t0) / (t1 - t0)
        };
        let found = -(height(1.2) - 2.0 * height(0.9) + height(0.6)) / 0.09;
        // Halfway.
        let gone = -(height(0.9) - heights[0].1);
        let beside = 0.5 * (length - PI * radius);
        let exact = acceleration_over_a_drum(pulls, [beside - gone, beside + gone], rho, radius, mu);
        println!("friction {mu}: {found:.5} m/s², exact {exact:.5}; {} steps, {last:?}", heights.len() - 1);
        assert!((found / exact - 1.0).abs() < 5e-3, "{found} {exact}");
        assert!(last.imbalance().abs() < 1e-5 * last.work && last.dissipated >= 0.0, "{last:?}");
    }
}

/// In a step of 10 ms a sheet that has fallen 20 cm goes 2 cm, three times the diameter of the bar.
#[test]
fn a_long_step_does_not_jump_over_a_bar() {
    let result = solved(
        "[sheet]\nshape = \"strip\"\nwidth = \"10 cm\"\nheight = \"1 cm\"\ncells = [20, 1]\n\
         [[supports]]\nset = \"all\"\nfix = [\"v\", \"theta_x\", \"theta_z\"]\n[[loads]]\nkind = \"gravity\"\n\
         [[obstacles]]\nkind = \"cylinder\"\nname = \"bar\"\nat = [\"5 cm\", \"0 m\", \"-20.3 cm\"]\naxis = [0, 1, 0]\ndiameter = \"6 mm\"\n\
         friction = 0.5\n[analysis]\nkind = \"newmark\"\nlarge_rotations = true\nduration = \"0.24 s\"\nstep = \"10 ms\"\n\
         [[probes]]\nname = \"middle\"\nat = [\"5 cm\", \"5 mm\"]\n[[probes]]\nname = \"end\"\nat = [\"10 cm\", \"5 mm\"]\n",
    );
    let history = result.history.as_ref().unwrap();
    let [middle, end] = [0, 1].map(|probe: usize| *history.probes[probe].last().unwrap());
    println!(
        "middle {middle:.5}, end {end:.5}, {} steps, imbalance {:.1e}",
        history.time.len(),
        history.imbalance
    );
    assert!((middle + 0.2).abs() < 1e-3 && end < -0.215, "{middle} {end}");
    assert!(history.imbalance < 1e-2);
}

#[test]
fn obstacles_of_motions_need_the_method_that_keeps_the_energy() {
    for wrong in ["large_rotations = false", "large_rotations = true\nspectral_radius = 0.9"] {
        let text = format!(
            "{SECTION}{STRIP}[analysis]\nkind = \"newmark\"\n{wrong}\nduration = \"1 s\"\nstep = \"1 ms\"\n"
        );
        let refused = Case::parse(Path::new("impact.toml"), &text).unwrap_err().to_string();
        println!("{refused}");
        assert!(
            refused.contains("[[obstacles]] are for large rotations")
                && refused.contains("without spectral_radius"),
            "{refused}"
        );
    }
}
