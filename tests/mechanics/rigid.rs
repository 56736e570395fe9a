//! Nodes that move as one rigid body, in linear statics, modes and dynamics.
//!
//! References: closed forms of beams and free bodies, the balance of forces and moments, and the same
//! constraint put into dense matrices by hand.

use std::ops::ControlFlow;

use kesf::element::{Formulation, Mass};
use kesf::mesh::{QuadMesh, distorted, rectangle};
use kesf::model::{Dof, DofGroup, Load, Model, RigidBody, Support};
use kesf::section::ShellSection;
use kesf::solve::assemble::{ElementMatrices, MatrixKind, multiply};
use kesf::solve::newmark::{Beginning, LoadHistory, Rayleigh, Scheme, Settings, newmark};
use kesf::solve::{self, Options, modes, modes_with};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Point3, Vector3};

fn section(nu: f64, t: f64) -> ShellSection {
    let plane = Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu));
    ShellSection {
        d_m: plane * (12.0 / (t * t)),
        d_b: plane,
        d_s: Matrix2::identity() * (3.5 / (t * t)),
        areal_density: 1.0,
        thickness: t,
    }
}

/// A model whose nodes `set`, with a point of reference at `at`, move as one body; the reference is the
/// last node.
fn with_body(mut mesh: QuadMesh, set: &[u32], at: [f64; 3], nu: f64, t: f64) -> (Model, u32) {
    let reference = mesh.nodes.len() as u32;
    mesh.nodes.push(Point3::from(at));
    let model = Model {
        mesh,
        section: section(nu, t),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports: Vec::new(),
        loads: Vec::new(),
        bodies: vec![RigidBody { nodes: [&[reference], set].concat() }],
    };
    (model, reference)
}

fn beyond(mesh: &QuadMesh, x: f64) -> Vec<u32> {
    (0..mesh.nodes.len() as u32).filter(|n| mesh.nodes[*n as usize].x > x - 1e-9).collect()
}

fn point(node: u32, force: [f64; 3], moment: [f64; 3]) -> Load {
    Load::Point { nodes: vec![node], force: force.into(), moment: moment.into() }
}

/// A strip (ν = 0, length 1, width 0.3) with a rigid clamp at its end, free to follow: `M = D κ` under a
/// moment; a force at the end of a lever adds its moment; the reaction of a turned clamp is `D κ b`.
#[test]
fn a_clamp_that_follows_bends_the_strip_to_a_circle() {
    let mesh = rectangle(1.0, 0.3, 8, 3).unwrap();
    let (left, right) = (mesh.set("left").unwrap().to_vec(), mesh.set("right").unwrap().to_vec());
    let (mut model, reference) = with_body(mesh, &right, [1.5, 0.15, 0.0], 0.0, 1e-2);
    model.supports.push(Support::clamped(&left));
    let at = 6 * reference as usize;
    let (b, m) = (0.3, 0.02);
    // Only a pure moment at the end of the strip: the force at the reference is zero.
    model.loads = vec![point(reference, [0.0; 3], [0.0, m, 0.0])];
    let u = solve::solve(&model, &Options::default()).unwrap().displacement;
    let kappa = m / b;
    assert!((u[at + 4] / kappa - 1.0).abs() < 1e-9, "{}", u[at + 4]);
    assert!((u[at + 2] / (-kappa * (0.5 + 0.5)) - 1.0).abs() < 1e-9, "{}", u[at + 2]);
    // Turned through φ and free to follow.
    model.loads.clear();
    model.supports.push(Support::at(vec![reference], vec![(Dof::ThetaY, 0.1)]));
    let solution = solve::solve(&model, &Options::default()).unwrap();
    assert!((solution.reaction[at + 4] / (0.1 * b) - 1.0).abs() < 1e-9);
    assert!((solution.strain_energy / (0.5 * 0.1 * 0.1 * b) - 1.0).abs() < 1e-9);
    // Forces in the plane and across it, all dofs of the body held: the reactions balance.
    model.supports[1] = Support::at(vec![reference], Dof::ALL.map(|d| (d, 0.0)).to_vec());
    model.loads = vec![point(right[0], [3.0, -2.0, 1.0], [0.1, 0.2, 0.3])];
    let r = solve::solve(&model, &Options::default()).unwrap().reaction;
    let lever = model.mesh.nodes[right[0] as usize] - model.mesh.nodes[reference as usize];
    let moment = Vector3::new(0.1, 0.2, 0.3) + lever.cross(&Vector3::new(3.0, -2.0, 1.0));
    let expected = [-3.0, 2.0, -1.0, -moment.x, -moment.y, -moment.z];
    (0..6).for_each(|d| assert!((r[at + d] - expected[d]).abs() < 1e-12, "{d}: {}", r[at + d]));
}

/// Constant tension (ν = 0) of a distorted mesh whose far end is a rigid block.
#[test]
fn a_rigid_block_passes_the_membrane_patch() {
    let mesh = distorted(rectangle(1.0, 0.5, 6, 4).unwrap(), 0.3, 2).unwrap();
    let (left, right) = (mesh.set("left").unwrap().to_vec(), mesh.set("right").unwrap().to_vec());
    let (mut model, reference) = with_body(mesh, &right, [2.0, 0.25, 0.0], 0.0, 1e-2);
    model.supports = vec![
        Support::fix(&left, &[Dof::U]),
        Support::fix(&left[..1], &[Dof::V]),
        Support::fix(&[reference], &[Dof::W, Dof::ThetaX, Dof::ThetaY]),
    ];
    model.loads = vec![point(reference, [0.5, 0.0, 0.0], [0.0; 3])];
    let solution = solve::solve(&model, &Options::default()).unwrap();
    for e in kesf::fields::cells(&model, &solution.displacement).unwrap().concat() {
        assert!((e.membrane[0] - 1.0).abs() < 1e-9 && e.membrane[1].abs() < 1e-9, "{:?}", e.membrane);
        assert!(e.membrane[2].abs() < 1e-9);
    }
    let stretch = 1.0 / model.section.d_m[(0, 0)];
    let tip = solution.displacement[6 * reference as usize];
    assert!((tip / stretch - 1.0).abs() < 1e-9, "{tip}");
}

/// A curved patch with a body of five nodes about a point off the surface, loads everywhere: the same
/// as `Tᵀ K T q = Tᵀ f` with dense matrices, T written down node by node.
#[test]
fn bodies_are_eliminated_exactly() {
    let mut mesh = rectangle(1.0, 1.0, 4, 4).unwrap();
    mesh.nodes.iter_mut().for_each(|p| p.z = 0.3 * p.x * p.x - 0.2 * p.x * p.y);
    let held = mesh.set("left").unwrap().to_vec();
    let (mut model, reference) = with_body(mesh, &[6, 12, 18, 23, 24], [0.7, -0.2, 0.4], 0.3, 0.05);
    model.supports.push(Support::clamped(&held));
    model.supports.push(Support::at(vec![reference], vec![(Dof::V, 0.01)]));
    model.loads.push(Load::Pressure(2.0));
    model.loads.push(point(18, [1.0, 2.0, -1.0], [0.3, -0.1, 0.2]));
    let solution = solve::solve(&model, &Options::default()).unwrap();

    let n = 6 * model.mesh.nodes.len();
    let bare = Model { bodies: Vec::new(), ..model.clone() };
    let mut k = DMatrix::zeros(n, n);
    for j in 0..n {
        let unit: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == j))).collect();
        k.set_column(
            j,
            &multiply(ElementMatrices::new(&bare, DofGroup::Shell, MatrixKind::Stiffness), &unit)
                .unwrap()
                .into(),
        );
    }
    let mut t = DMatrix::identity(n, n);
    for &node in &model.bodies[0].nodes[1..] {
        let (row, column) = (6 * node as usize, 6 * reference as usize);
        let r = model.mesh.nodes[node as usize] - model.mesh.nodes[reference as usize];
        t.view_mut((row, row), (6, 6)).fill(0.0);
        for (i, j, value) in [(0, 4, r.z), (0, 5, -r.y), (1, 3, -r.z), (1, 5, r.x), (2, 3, r.y), (2, 4, -r.x)]
        {
            t[(row + i, column + j)] = value;
        }
        (0..6).for_each(|i| t[(row + i, column + i)] = 1.0);
    }
    let f = t.transpose() * DVector::from_vec(model.load_vector());
    let reduced = t.transpose() * &k * &t;
    let constraints = model.constraints();
    let follows = |d: &usize| model.bodies[0].nodes[1..].contains(&(*d as u32 / 6));
    let free: Vec<usize> = (0..n).filter(|d| constraints[*d].is_none() && !follows(d)).collect();
    let known = DVector::from_fn(n, |d, _| constraints[d].unwrap_or(0.0));
    let push = &reduced * &known;
    let matrix = DMatrix::from_fn(free.len(), free.len(), |i, j| reduced[(free[i], free[j])]);
    let right = DVector::from_fn(free.len(), |i, _| f[free[i]] - push[free[i]]);
    let mut q = known;
    let part = matrix.cholesky().unwrap().solve(&right);
    free.iter().zip(part.iter()).for_each(|(d, v)| q[*d] = *v);
    let (u, reaction) = (&t * &q, &reduced * &q - f);
    let scale = u.amax();
    for d in 0..n {
        assert!((solution.displacement[d] - u[d]).abs() < 1e-10 * scale, "dof {d}");
        if constraints[d].is_some() {
            assert!((solution.reaction[d] - reaction[d]).abs() < 1e-8, "reaction {d}");
        }
    }
}

/// A cantilever of length 1 that carries a rigid plate of length 1/2 of the same mass per length:
/// ω √(ρ/D) L² = 1.568739770, 10.451186160, the roots of the beam with that mass and inertia at the
/// joint (see `kesf verify`, `frequency.rigid_plate`).
#[test]
fn a_rigid_plate_swings_at_the_end_of_a_cantilever() {
    for mass in [Mass::Consistent, Mass::Lumped, Mass::Averaged] {
        let found = [24, 48].map(|cells| {
            let mesh = rectangle(1.5, 0.02, cells, 1).unwrap();
            let (left, outer) = (mesh.set("left").unwrap().to_vec(), beyond(&mesh, 1.0));
            let (mut model, reference) = with_body(mesh, &outer, [1.25, 0.01, 0.0], 0.0, 1e-3);
            model.supports.push(Support::clamped(&left));
            model.supports.push(Support::fix(&[reference], &[Dof::V, Dof::ThetaX, Dof::ThetaZ]));
            let found = modes(&model, 2, mass, &Options::default()).unwrap();
            // The shape is a rigid one out there.
            let q = |n: u32, d: usize| found[0].shape[6 * n as usize + d];
            for n in outer {
                let dx = model.mesh.nodes[n as usize].x - 1.25;
                assert!((q(n, 2) - q(reference, 2) + q(reference, 4) * dx).abs() < 1e-12);
            }
            [found[0].angular_frequency / 1.568739770 - 1.0, found[1].angular_frequency / 10.451186160 - 1.0]
        });
        for k in 0..2 {
            let slope = (found[0][k] / found[1][k]).log2();
            assert!(found[1][k].abs() < 2e-3, "{mass:?}: {found:?}");
            // With row sums the errors of mass and stiffness nearly cancel, and no slope is left to see.
            let second_order = mass != Mass::Consistent || (1.9..2.1).contains(&slope);
            assert!(second_order, "{mass:?}: {slope}, {found:?}");
        }
    }
}

/// A sheet that is one free rigid body under a force off its centre, undamped and damped: w = F t²/(2 m),
/// θ = M t²/(2 I), which the average acceleration method follows exactly.
#[test]
fn a_free_rigid_sheet_accelerates_steadily() {
    let mesh = rectangle(1.0, 0.5, 4, 2).unwrap();
    let all: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    let (mut model, reference) = with_body(mesh, &all, [0.5, 0.25, 0.0], 0.3, 1e-2);
    model.loads.push(point(reference, [0.0, 0.0, 3.0], [0.0, 0.2, 0.0]));
    let settings = Settings {
        duration: 1.0,
        step: 0.1,
        tolerance: None,
        damping: Rayleigh { alpha: 0.0, beta: 0.3 },
        load: LoadHistory::Step,
        mass: Mass::Consistent,
        scheme: Scheme::default(),
        beginning: Beginning::default(),
    };
    let (m, inertia) = (0.5, 0.5 * (1.0 + 1e-4) / 12.0);
    newmark(&model, &settings, &Options::default(), |at| {
        let q = &at.displacement[6 * reference as usize..][..6];
        let half = 0.5 * at.time * at.time;
        assert!((q[2] - 3.0 / m * half).abs() < 1e-9 && (q[4] - 0.2 / inertia * half).abs() < 1e-9, "{q:?}");
        assert!(at.energy.imbalance().abs() < 1e-10);
        ControlFlow::Continue(())
    })
    .unwrap();
}

/// A plan made once serves statics, modes and dynamics; bodies that cannot be are refused in each.
#[test]
fn plans_know_the_bodies_and_errors_name_them() {
    let mesh = rectangle(1.0, 1.0, 4, 4).unwrap();
    let (left, right) = (mesh.set("left").unwrap().to_vec(), mesh.set("right").unwrap().to_vec());
    let (mut model, reference) = with_body(mesh, &right, [1.0, 0.5, 0.0], 0.3, 1e-2);
    model.supports.push(Support::clamped(&left));
    model.loads.push(point(reference, [0.0, 0.0, 1.0], [0.0; 3]));
    let options = Options::default();
    let plan = solve::Plan::new(&model, &solve::Plan::all_groups(&model, &options), options.path).unwrap();
    let once = modes(&model, 3, Mass::Lumped, &options).unwrap();
    assert_eq!(modes_with(&model, &plan, 3, Mass::Lumped, &options).unwrap(), once);
    // A follower that its own lead holds already is no contradiction; any other support is.
    model.supports.push(Support::fix(&right, &[Dof::ThetaX]));
    let refused = solve::solve(&model, &options).unwrap_err();
    assert_eq!(refused.code(), "M010");
    assert!(refused.to_string().contains(&format!("hold node {reference}")), "{refused}");
    model.supports.push(Support::fix(&[reference], &[Dof::ThetaX]));
    assert!(solve::solve(&model, &options).is_ok());
    model.bodies.push(model.bodies[0].clone());
    assert_eq!(modes(&model, 1, Mass::Lumped, &options).unwrap_err().code(), "M010");
}
