//! Goal: every membrane has one energy, and force and tangent of an element are its derivatives.
//!
//! Data: a warped, irregular quad and an oblique triangle of an orthotropic section, displaced and turned at random (seeded). Reference: central
//! differences with step h, whose error is about ε/h + h² (ε = 1e-16); the linear sheet for one whose cells follow
//! its laws.

use nalgebra::{Matrix2, SVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::*;
use crate::element::{Formulation, Membrane};
use crate::law::{Backbone, Channel, Family, Mode, Slider, Widening};
use crate::mesh::{QuadMesh, is_triangle};
use crate::section::ShellSection;

type Nodes = ([Point3<f64>; 4], [UnitQuaternion<f64>; 4]);

/// Of one element on these nodes.
fn model(membrane: Membrane, quad: [u32; 4]) -> Model {
    let corners = [[0.1, -0.2, 0.05], [1.3, 0.1, -0.02], [1.1, 0.9, 0.08], [-0.2, 1.2, -0.06]];
    Model {
        mesh: QuadMesh {
            nodes: corners.map(Point3::from).to_vec(),
            quads: vec![quad],
            ..QuadMesh::default()
        },
        section: ShellSection {
            d_m: Matrix3::new(3.0, 0.4, 0.0, 0.4, 2.0, 0.0, 0.0, 0.0, 0.5),
            d_b: Matrix3::new(0.03, 0.004, 0.0, 0.004, 0.01, 0.0, 0.0, 0.0, 0.008),
            d_s: Matrix2::identity() * 0.7,
            areal_density: 1.0,
            thickness: 0.3,
        },
        warp: Vector3::new(0.8, 0.6, 0.0),
        formulation: Formulation { membrane, ..Formulation::default() },
        supports: Vec::new(),
        loads: Vec::new(),
        bodies: Vec::new(),
    }
}

fn sheet<'a>(model: &Model, law: Option<&'a SheetLaw>) -> Sheet<'a> {
    let mut sheet = Sheet::new(model, law);
    sheet.push(&model.element(0, false).unwrap(), model, false);
    sheet
}

fn displaced((x, r): &Nodes, step: &Vector24) -> Nodes {
    let part = |i: usize| -> Vector3<f64> { step.fixed_rows::<3>(3 * i).into() };
    (
        [0, 1, 2, 3].map(|i| x[i] + part(2 * i)),
        [0, 1, 2, 3].map(|i| UnitQuaternion::from_scaled_axis(part(2 * i + 1)) * r[i]),
    )
}

/// Nodes displaced and turned by up to `size` after a rigid rotation.
fn state(model: &Model, size: f64, rng: &mut Pcg64) -> Nodes {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -1.1, 2.0));
    let corners = model.mesh.corners(0).map(|p| turn * p);
    let mut step = Vector24::from_fn(|_, _| rng.random_range(-size..size));
    if is_triangle(&model.mesh.quads[0]) {
        let third: SVector<f64, 6> = step.fixed_rows::<6>(12).into();
        step.fixed_rows_mut::<6>(18).copy_from(&third);
    }
    displaced(&(corners, [turn; 4]), &step)
}

const QUAD: [u32; 4] = [0, 1, 2, 3];
const TRIANGLE: [u32; 4] = [3, 0, 1, 1];
const ELEMENTS: [(Membrane, [u32; 4]); 6] = [
    (Membrane::Cells, QUAD),
    (Membrane::OneCell, QUAD),
    (Membrane::AssumedStress, QUAD),
    (Membrane::Cells, TRIANGLE),
    (Membrane::OneCell, TRIANGLE),
    (Membrane::AssumedStress, TRIANGLE),
];

/// Friction in every strain, of sliders that slip and of such that do not.
fn friction() -> SheetLaw {
    let d = [3.0, 2.0, 0.5, 0.03, 0.01, 0.008];
    let channel = |d: f64| {
        let sliders =
            vec![Slider { stiffness: 0.5 * d, slip: 0.043 }, Slider { stiffness: 0.2 * d, slip: 0.4 }];
        let family = Family { widening: Widening::Constant, sliders };
        Channel::new(Backbone::line(0.3 * d).unwrap(), vec![family], false).unwrap()
    };
    SheetLaw::new(Mode::Friction, d.map(|d| Some(channel(d))))
}

#[test]
fn force_and_tangent_are_derivatives_of_the_energy() {
    let mut rng = Pcg64::seed_from_u64(4);
    let friction = friction();
    for ((membrane, quad), law) in ELEMENTS.into_iter().flat_map(|e| [(e, None), (e, Some(&friction))]) {
        let model = model(membrane, quad);
        let sheet = sheet(&model, law);
        let at = |nodes: &Nodes| sheet.answer(0, &Memory::default(), &nodes.0, &nodes.1);
        let force = |nodes: &Nodes| -> Vector24 {
            let answer = at(nodes);
            answer.motion.force(&answer.forces.local)
        };
        for size in [0.01, 0.1, 0.3] {
            let nodes = state(&model, size, &mut rng);
            let (answer, f) = (at(&nodes), force(&nodes));
            let mut k = sheet.stiffness(0, &answer);
            sheet.add_geometric(0, &answer, &answer.forces, &mut k);
            let tangent = answer.motion.exact_tangent(&k, &answer.forces.local);
            for i in 0..24 {
                let case = || format!("{membrane:?} {quad:?} friction {} {size}: {i}", law.is_some());
                let [up, down] = [1e-5, -1e-5].map(|h| displaced(&nodes, &Vector24::ith(i, h)));
                if at(&up).tangents != at(&down).tangents {
                    // A slider comes to its level between the two.
                    continue;
                }
                let potential = [&up, &down].map(&at).map(|a| a.energy + a.dissipation);
                let slope = (potential[0] - potential[1]) / 2e-5;
                // The second differences of small forces are those of the stiffness, of order 1.
                assert!((slope - f[i]).abs() < 1e-8 * f.norm().max(0.01), "{}", case());
                let change = (force(&up) - force(&down)) / 2e-5;
                assert!((change - tangent.column(i)).norm() < 1e-8 * tangent.norm(), "{}", case());
            }
        }
    }
}

/// The prediction of the mixed integration point is the derivative of the local force without the geometric part.
#[test]
fn changes_are_those_of_the_stiffness() {
    let mut rng = Pcg64::seed_from_u64(5);
    for (membrane, quad) in ELEMENTS {
        let model = model(membrane, quad);
        let sheet = sheet(&model, None);
        let (x, r) = state(&model, 0.2, &mut rng);
        let answer = sheet.answer(0, &Memory::default(), &x, &r);
        let step = Vector24::from_fn(|_, _| rng.random_range(-1.0..1.0));
        let (change, product) = (sheet.change(0, &answer, &step).local, sheet.stiffness(0, &answer) * step);
        assert!((change - product).norm() < 1e-12 * product.norm(), "{membrane:?}");
    }
}

#[test]
fn laws_without_friction_are_the_linear_sheet() {
    let mut rng = Pcg64::seed_from_u64(6);
    for (membrane, quad) in ELEMENTS {
        let model = model(membrane, quad);
        let law = SheetLaw::linear(&model.section).unwrap();
        let sheets = [sheet(&model, None), sheet(&model, Some(&law))];
        let (x, r) = state(&model, 0.2, &mut rng);
        let [a, b] = sheets.map(|sheet| {
            let answer = sheet.answer(0, &Memory::default(), &x, &r);
            let step = Vector24::from_element(1e-3);
            let change = sheet.change(0, &answer, &step);
            (answer.energy, answer.forces.local, sheet.stiffness(0, &answer), change.local)
        });
        assert!((a.0 - b.0).abs() < 1e-12 * a.0, "{membrane:?}");
        assert!((a.1 - b.1).norm() < 1e-12 * a.1.norm(), "{membrane:?}");
        assert!((a.2 - b.2).norm() < 1e-12 * a.2.norm(), "{membrane:?}");
        assert!((a.3 - b.3).norm() < 1e-12 * a.3.norm(), "{membrane:?}");
    }
}
