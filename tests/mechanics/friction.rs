//! Goal: a shell whose cells follow laws with friction is the material law, in every loop.
//!
//! ```text
//!   clamp |==========> x    weight down; or a clamp that turns there and back and is free to follow
//! ```
//! Data: strips and one irregular, warped quad; laws of one slider (`w`, `x`) beside a straight
//! backbone `B`, so `2HB = 2 w x`. Synthetic.
//! References (analytical): the linear element; central differences of the potential; the law
//! itself, as bending in a circle strains every cell alike; the heavy rod with the virgin curve,
//! integrated from its tip.

use std::ops::ControlFlow;

use kesf::element::corotational::{Motion, ReferenceFrame};
use kesf::element::{
    Cellwise, Drilling, Formulation, Gradient, Matrix24, Prepared, Strains, Vector24, YarnStrain, Yarns,
};
use kesf::fields::{Recovery, curvatures_moved, element_means_moved};
use kesf::law::{Backbone, Channel, Family, Mode, Slider, State, Widening};
use kesf::mesh::rectangle;
use kesf::model::{Dof, Load, Model, RigidBody, Support};
use kesf::section::{SectionError, SheetLaw, ShellSection};
use kesf::solve::Options;
use kesf::solve::nonlinear::{Settings, Solution, Step, solve};
use nalgebra::{Matrix2, Matrix3, Point3, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn section() -> ShellSection {
    ShellSection {
        d_m: Matrix3::new(6000.0, 1200.0, 0.0, 1200.0, 4000.0, 0.0, 0.0, 0.0, 50.0),
        d_b: Matrix3::new(1e-5, 1e-6, 0.0, 1e-6, 6e-6, 0.0, 0.0, 0.0, 3e-6),
        d_s: Matrix2::identity() * 50.0,
        areal_density: 0.15,
        thickness: 4e-4,
    }
}

/// A straight backbone with sliders of given stiffness and slip level.
fn channel(tangent: f64, sliders: &[(f64, f64)]) -> Channel {
    let sliders = sliders.iter().map(|(stiffness, slip)| Slider { stiffness: *stiffness, slip: *slip });
    let family = Family { widening: Widening::Constant, sliders: sliders.collect() };
    Channel::new(Backbone::line(tangent).unwrap(), vec![family], false).unwrap()
}

/// Friction in every strain of [`section`].
fn friction() -> SheetLaw {
    let d = [6000.0, 4000.0, 50.0, 1e-5, 6e-6, 3e-6];
    let slip = [1e-3, 1e-3, 5e-3, 20.0, 20.0, 20.0];
    let law = |i: usize| channel(d[i], &[(0.8 * d[i], slip[i]), (0.3 * d[i], 4.0 * slip[i])]);
    SheetLaw::new(Mode::Friction, std::array::from_fn(|i| Some(law(i))))
}

fn quad(height: f64, drilling: Drilling) -> Prepared {
    let corners =
        [[0.0, 0.0, height], [0.013, 0.001, -height], [0.012, 0.011, height], [-0.001, 0.009, -height]];
    let corners = corners.map(|[x, y, z]| Point3::new(x, y, z));
    let formulation = Formulation { drilling, ..Formulation::default() };
    Prepared::from_corners(&corners, &section(), formulation, &Vector3::new(0.8, 0.6, 0.0)).unwrap()
}

/// Plane and warped, material axes oblique to the element, some or all of the strains, every drilling.
#[test]
fn linear_laws_give_the_linear_element() {
    let section = section();
    let diagonal: Strains =
        std::array::from_fn(|i| if i < 3 { section.d_m[(i, i)] } else { section.d_b[(i - 3, i - 3)] });
    for (height, drilling) in
        [(0.0, Drilling::Scaled), (0.002, Drilling::HughesBrezzi), (0.001, Drilling::Seed(1e-3))]
    {
        let element = quad(height, drilling);
        let linear = element.local_stiffness();
        let d = Vector24::from_fn(|i, _| 1e-3 * (1.0 + i as f64 * 0.618).fract());
        for replaced in [[true; 6], [false, false, true, true, true, true]] {
            let tangent: Strains = std::array::from_fn(|i| if replaced[i] { diagonal[i] } else { 0.0 });
            let of_laws =
                [0, 3].map(|i| Matrix3::from_diagonal(&Vector3::from_column_slice(&tangent[i..i + 3])));
            let cells = element.cellwise([section.d_m - of_laws[0], section.d_b - of_laws[1]]);
            let stress = |e: Strains| std::array::from_fn(|i| tangent[i] * e[i]);
            let (none, small) = (Vector3::zeros(), Gradient::zeros());
            let stresses: Vec<Strains> = cells.strains(&d, none).map(stress).collect();
            let k = cells.linear() + cells.stiffness(&[tangent; 4], &small);
            let (f, exact) = (cells.linear() * d + cells.cell_force(&stresses, &small), linear * d);
            for i in 0..24 {
                // Bending and membrane entries differ by many orders: each against its own size.
                for j in 0..24 {
                    let size = (linear[(i, i)] * linear[(j, j)]).sqrt();
                    assert!((k[(i, j)] - linear[(i, j)]).abs() < 1e-13 * size, "{height} {i} {j}");
                }
                let size: f64 = (0..24).map(|j| (linear[(i, j)] * d[j]).abs()).sum();
                assert!((f[i] - exact[i]).abs() < 1e-13 * size, "{height} {i}");
            }
        }
    }
}

/// An element of cells and yarns under a law, and what of its membrane stays linear.
struct Element {
    cells: Cellwise,
    yarns: Yarns,
    rest: Matrix3<f64>,
}

impl Element {
    /// Local force and stiffness, and `∫ (ψ + D)`, of an element whose cells have memories.
    fn answer(&self, law: &SheetLaw, from: &[[State; 6]], d: &Vector24) -> (Vector24, Matrix24, f64) {
        let strain = YarnStrain::of(&self.yarns.gradient(d));
        let mut linear = *self.cells.linear();
        self.yarns.remove_mean(&self.rest, &mut linear);
        let mut resultant = self.rest * strain.strain;
        let mean = self.yarns.area() * resultant.dot(&strain.strain);
        let mut potential = 0.5 * (d.dot(&(linear * d)) + mean);
        let (mut stresses, mut tangents): (Vec<Strains>, Vec<Strains>) = (Vec::new(), Vec::new());
        for ((e, area), from) in self.cells.strains(d, strain.excess).zip(self.cells.areas()).zip(from) {
            let response = |i: usize| law.channels[i].as_ref().unwrap().respond(law.mode, &from[i], e[i]);
            let r: [_; 6] = std::array::from_fn(response);
            potential += area * r.iter().map(|r| r.energy + r.dissipation).sum::<f64>();
            resultant += Vector3::from_fn(|i, _| r[i].stress) * (area / self.yarns.area());
            stresses.push(r.map(|r| r.stress));
            tangents.push(r.map(|r| r.tangent));
        }
        let mut k = linear + self.cells.stiffness(&tangents, &self.yarns.excess_rows(&strain));
        let mean = strain.rate.tr_mul(&(self.rest * strain.rate)) + strain.geometric(&resultant);
        self.yarns.add(&mean, &mut k);
        let deviations = self.cells.cell_force(&stresses, &-self.yarns.linear_rows());
        (linear * d + deviations + self.yarns.force(&strain, &resultant), k, potential)
    }
}

/// Force and tangent of a corotational element with friction, after a history, are the derivatives
/// of its incremental potential. Central differences, step 1e-6 of the element's side and of a radian;
/// no slider is within that of its level.
#[test]
fn force_and_tangent_are_derivatives_of_the_potential() {
    let mut rng = Pcg64::seed_from_u64(7);
    let element = quad(1e-3, Drilling::Scaled);
    let reference = ReferenceFrame::of(&element.frame);
    let (law, frame) = (friction(), &element.frame);
    let rest = [0, 1, 2, 3].map(|i| {
        let [x, y] = frame.xy[i];
        Point3::from(frame.rotation.transpose() * Vector3::new(x, y, frame.z[i]))
    });
    let mut rest_of_law = section().d_m;
    rest_of_law.fill_diagonal(0.0);
    let cells = element.cellwise(law.beside(&section()));
    let element = Element { cells, yarns: element.yarns(), rest: rest_of_law };
    let displaced = |step: &Vector24| {
        let part = |i: usize| -> Vector3<f64> { step.fixed_rows::<3>(3 * i).into() };
        let turn = |i: usize| UnitQuaternion::from_scaled_axis(part(2 * i + 1));
        ([0, 1, 2, 3].map(|i| rest[i] + 0.01 * part(2 * i)), [0, 1, 2, 3].map(turn))
    };
    for mode in [Mode::Friction, Mode::Virgin, Mode::Elastic] {
        let law = SheetLaw { mode, ..law.clone() };
        // A path of ten steps about a large rotation leaves its traces in the memory.
        let mut memory = vec![[State::default(); 6]; 4];
        let mut u = Vector24::zeros();
        for _ in 0..10 {
            u += Vector24::from_fn(|_, _| rng.random_range(-0.02..0.02));
            let (x, r) = displaced(&u);
            let d = Motion::of(&reference, &x, &r).deformation;
            let excess = YarnStrain::of(&element.yarns.gradient(&d)).excess;
            for (e, states) in element.cells.strains(&d, excess).zip(&mut memory) {
                for i in 0..6 {
                    states[i] = law.channels[i].as_ref().unwrap().respond(mode, &states[i], e[i]).state;
                }
            }
        }
        u += Vector24::from_fn(|_, _| rng.random_range(-0.02..0.02));
        // Spins act on the turned nodes, scaled lengths on the places.
        let spun = |v: &Vector24| {
            let (mut x, mut r) = displaced(&u);
            for i in 0..4 {
                let part = |at: usize| -> Vector3<f64> { v.fixed_rows::<3>(at).into() };
                x[i] += 0.01 * part(6 * i);
                r[i] = UnitQuaternion::from_scaled_axis(part(6 * i + 3)) * r[i];
            }
            let motion = Motion::of(&reference, &x, &r);
            let (local, k, potential) = element.answer(&law, &memory, &motion.deformation);
            let (force, exact) = (motion.force(&local), motion.exact_tangent(&k, &local));
            let scale = Vector24::from_fn(|i, _| if i % 6 < 3 { 0.01 } else { 1.0 });
            (
                force.component_mul(&scale),
                exact.map_with_location(|i, j, k| k * scale[i] * scale[j]),
                potential,
            )
        };
        let (force, tangent, _) = spun(&Vector24::zeros());
        let h = 1e-6;
        for i in 0..24 {
            let mut step = Vector24::zeros();
            step[i] = h;
            let (ahead, behind) = (spun(&step), spun(&-step));
            let slope = (ahead.2 - behind.2) / (2.0 * h);
            assert!((slope - force[i]).abs() < 1e-6 * force.amax(), "{mode:?} {i}: {slope} {}", force[i]);
            let column = (ahead.0 - behind.0) / (2.0 * h);
            let off = (column - tangent.column(i)).amax() / tangent.amax();
            assert!(off < 1e-6, "{mode:?} {i}: {off}");
        }
    }
}

fn go_on(_: &Step<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// A horizontal strip clamped at one end under its own weight, in cylindrical bending.
fn cantilever(length: f64, cells: usize, section: &ShellSection) -> Model {
    let mesh = rectangle(length, length / cells as f64, cells, 1).unwrap();
    Model {
        supports: vec![
            Support::fix(mesh.set("all").unwrap(), &[Dof::V, Dof::ThetaX, Dof::ThetaZ]),
            Support::clamped(mesh.set("left").unwrap()),
        ],
        loads: vec![Load::Gravity(Vector3::new(0.0, 0.0, -9.80665))],
        mesh,
        section: section.clone(),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        bodies: Vec::new(),
    }
}

fn run(model: &Model, law: Option<SheetLaw>) -> Solution {
    let settings = Settings { law, ..Settings::default() };
    solve(model, &settings, &Options::default(), go_on).unwrap()
}

#[test]
fn linear_laws_give_the_solution_of_the_linear_sheet() {
    let mut section = section();
    section.d_b[(0, 1)] = 0.0;
    section.d_b[(1, 0)] = 0.0;
    let model = cantilever(0.1, 16, &section);
    let (linear, law) = (run(&model, None), run(&model, Some(SheetLaw::linear(&section).unwrap())));
    assert_eq!(linear.iterations, law.iterations);
    let apart = linear.state.position.iter().zip(&law.state.position).map(|(a, b)| (a - b).norm());
    let apart = apart.fold(0.0, f64::max);
    // Both solutions stop at a residual of 1e-8 of the load.
    assert!(apart < 1e-9 * 0.1, "{apart:e}");
    assert!((linear.energy / law.energy - 1.0).abs() < 1e-9);
    assert_eq!(law.state.memory.dissipated, 0.0);
}

/// KES-FB2: a gap of 1 cm, the moving clamp turns and is free to follow.
fn bending_test(cells: usize, law: SheetLaw, steps: f64) -> (Model, Settings, usize) {
    let mesh = rectangle(0.01, 0.2, cells, 1).unwrap();
    let right = mesh.set("right").unwrap().to_vec();
    let turn = vec![(Dof::V, 0.0), (Dof::ThetaX, 0.0), (Dof::ThetaY, 2.5), (Dof::ThetaZ, 0.0)];
    let mut section = section();
    section.d_b = Matrix3::from_diagonal(&section.d_b.diagonal());
    let model = Model {
        supports: vec![Support::clamped(mesh.set("left").unwrap()), Support::at(vec![right[0]], turn)],
        loads: Vec::new(),
        bodies: vec![RigidBody { nodes: right.clone() }],
        mesh,
        section,
        warp: Vector3::x(),
        formulation: Formulation::default(),
    };
    let lead = 6 * right[0] as usize + Dof::ThetaY as usize;
    let settings = Settings {
        first_step: 1.0 / steps,
        largest_step: 1.0 / steps,
        tolerance: 1e-10,
        law: Some(law),
        ..Settings::default()
    };
    (model, settings, lead)
}

/// The bending channel alone; curvatures in 1/m.
fn bending_only(law: Channel, mode: Mode) -> SheetLaw {
    SheetLaw::new(mode, [None, None, None, Some(law), None, None])
}

/// The instrument's cycle 0, 2.5, -2.5, 0 per cm: the moment is that of the law at every curvature,
/// so the loop has B and 2HB of the law; and what the clamp does is stored or lost. The slip
/// levels are met by whole steps, so that the trapezoidal rule is exact for the work.
#[test]
fn the_bending_loop_is_that_of_the_law_and_its_work_is_stored_or_lost() {
    let (b, hb, slip) = (1e-5, 3e-4, 12.5);
    let law = channel(b, &[(hb / slip, slip)]);
    let (model, settings, lead) = bending_test(10, bending_only(law.clone(), Mode::Friction), 20.0);
    let (mut state, mut last) = (State::default(), (0.0, 0.0));
    let (mut work, mut lost, mut steps) = (0.0, 0.0, 0);
    let mut moments = Vec::new();
    let settings = Settings { path: vec![1.0, -1.0, 0.0], ..settings };
    solve(&model, &settings, &Options::default(), |step| {
        let curvature = step.state.factor * 250.0;
        let expected = law.trial(&state, curvature);
        state = expected.state;
        let moment = step.reaction[lead] / 0.2;
        assert!((moment - expected.stress).abs() < 1e-8 * (b * 250.0 + hb), "{curvature}: {moment}");
        work += 0.5 * (moment + last.1) * (curvature - last.0) * 0.2 * 0.01;
        let kept = step.energy + step.state.memory.dissipated;
        assert!((work - kept).abs() < 1e-8 * b * 250.0 * 250.0 * 0.002, "{curvature}: {work} {kept}");
        assert!(step.state.memory.dissipated >= lost);
        lost = step.state.memory.dissipated;
        last = (curvature, moment);
        moments.push(last);
        steps += 1;
        ControlFlow::Continue(())
    })
    .unwrap();
    assert_eq!(steps, 80);
    // B: mean slope between 0.5 and 1.5 per cm; 2HB: width of the loop at 1 per cm.
    let at = |k: f64, from: usize| moments[from..].iter().find(|(at, _)| (at - k).abs() < 1e-9).unwrap().1;
    let slope = (at(150.0, 0) - at(50.0, 0)) / 100.0;
    assert!((slope / b - 1.0).abs() < 1e-8, "{slope}");
    let width = at(100.0, 0) - at(100.0, 20);
    assert!((width / (2.0 * hb) - 1.0).abs() < 1e-8, "{width}");
}

/// Moments and membrane forces are those of the laws and of statics, not of the section, of which nothing is left where
/// laws replace it: the moment of the clamp all along the loop, and the weight below each element of a strip that hangs.
#[test]
fn resultants_are_those_of_the_laws() {
    let law = bending_only(channel(1e-5, &[(2.4e-5, 12.5), (1e-5, 40.0)]), Mode::Friction);
    let (model, settings, lead) = bending_test(10, law.clone(), 10.0);
    let settings = Settings { path: vec![1.0, -0.5, 0.3], ..settings };
    let recovery = Recovery::new(&model.mesh);
    solve(&model, &settings, &Options::default(), |step| {
        let at_clamp = step.reaction[lead] / 0.2;
        let nodal = recovery.nodal_moved(&model, step.state, Some(&law)).unwrap();
        let means = element_means_moved(&model, step.state, Some(&law)).unwrap();
        for found in nodal.iter().chain(&means) {
            assert!((found.moment[0] - at_clamp).abs() < 1e-7 * 250.0 * 3e-5, "{found:?} {at_clamp}");
        }
        // A circle; the law has a memory, and the curvature has none.
        let curvature = 250.0 * step.state.factor;
        for [along, across, twist] in curvatures_moved(&model, step.state).unwrap() {
            assert!((along - curvature).abs() < 1e-6 * 250.0, "{along} {curvature}");
            assert!(across.abs().max(twist.abs()) < 1e-6 * 250.0, "{across} {twist}");
        }
        ControlFlow::Continue(())
    })
    .unwrap();

    let law = friction();
    let mesh = rectangle(0.2, 0.01, 20, 1).unwrap();
    let model = Model {
        supports: vec![
            Support::fix(mesh.set("all").unwrap(), &[Dof::W, Dof::ThetaX, Dof::ThetaY]),
            Support::fix(mesh.set("left").unwrap(), &[Dof::U, Dof::ThetaZ]),
            Support::fix(&[0], &[Dof::V]),
        ],
        // Ten times its weight, along the warp.
        loads: vec![Load::Gravity(Vector3::new(98.0665, 0.0, 0.0))],
        mesh,
        ..cantilever(0.1, 1, &section())
    };
    let solution = run(&model, Some(law.clone()));
    let means = element_means_moved(&model, &solution.state, Some(&law)).unwrap();
    for (quad, found) in means.iter().enumerate() {
        let below = 0.15 * 98.0665 * 0.01 * (19.5 - quad as f64);
        assert!((found.membrane[0] / below - 1.0).abs() < 2e-3, "{quad}: {found:?} {below}");
        // The coupling D12 acts on the strains to first order.
        assert!(
            found.membrane[1].abs() < 1e-3 * means[0].membrane[0] && found.moment[0].abs() < 1e-12,
            "{quad}: {found:?}"
        );
    }
    let elastic = element_means_moved(&model, &solution.state, None).unwrap();
    assert!(elastic[0].membrane[0] < 0.6 * means[0].membrane[0]);
}

/// The same equilibria whether steps are cut back on the way or not, and whatever the threads.
#[test]
fn a_step_that_is_cut_back_leaves_no_trace() {
    let law = SheetLaw::new(Mode::Friction, {
        let mut channels = friction().channels;
        channels[0] = None;
        channels[1] = None;
        channels
    });
    let model = cantilever(0.12, 16, &section());
    let hasty = Settings { law: Some(law), iterations: 6, ..Settings::default() };
    let mut factors = Vec::new();
    let cut = solve(&model, &hasty, &Options::default(), |step| {
        factors.push(step.state.factor);
        ControlFlow::Continue(())
    })
    .unwrap();
    let tries: usize = cut.iterations;
    assert!(factors.len() > 1 && tries > 6 * factors.len() / 2, "{factors:?}");
    let options = Options { threads: 2, ..Options::default() };
    let straight = solve(&model, &Settings { path: factors, ..hasty }, &options, go_on).unwrap();
    assert!(straight.iterations < tries, "{} {tries}", straight.iterations);
    assert_eq!(cut.state, straight.state);
    assert_eq!(cut.reaction, straight.reaction);
}

/// Angle of the chord below the horizontal (degrees) of a heavy rod whose curvature follows a law:
/// `dM/ds = w s cos θ`, `dθ/ds = -κ(M)` from the tip at angle `tip`; the midpoint rule with 4,000 steps.
/// Returns the angle at the clamp as well.
fn heavy_rod(weight: f64, length: f64, tip: f64, curvature: impl Fn(f64) -> f64) -> (f64, f64) {
    let (steps, mut theta, mut moment, mut x, mut y) = (4000, tip, 0.0, 0.0, 0.0);
    let ds = length / f64::from(steps);
    for i in 0..steps {
        let s = f64::from(i) * ds;
        let middle = theta - 0.5 * ds * curvature(moment);
        let half = moment + 0.5 * ds * weight * (s + 0.25 * ds) * theta.cos();
        moment += ds * weight * (s + 0.5 * ds) * middle.cos();
        theta -= ds * curvature(half);
        x += ds * middle.cos();
        y += ds * middle.sin();
    }
    (y.atan2(x).to_degrees(), theta)
}

/// Chord angle (degrees) of the strip of the shell.
fn chord(model: &Model, law: SheetLaw) -> f64 {
    let solution = run(model, Some(law));
    let tip = model.mesh.set("right").unwrap()[0] as usize;
    let p = solution.state.position[tip];
    (-p.z).atan2(p.x).to_degrees()
}

/// Cloth with a friction couple HB = μ B/c hangs over a clamp as a rod with the virgin law, and its
/// bending length is c (1 + 0.423 μ - 0.056 μ²) to 1 %: at this overhang, and 1 % more and less,
/// the chord is at, above and below 41.5 degrees.
#[test]
fn a_cantilever_of_virgin_cloth_has_the_bending_length_of_its_friction() {
    let section = ShellSection { d_b: Matrix3::from_diagonal(&section().d_b.diagonal()), ..section() };
    let (b, weight) = (section.d_b[(0, 0)], section.areal_density * 9.80665);
    let c = (b / weight).cbrt();
    for mu in [0.0, 0.5, 1.0, 2.0f64] {
        let (couple, slip) = (mu * b / c, 0.01 / c);
        let law = channel(b, &[(couple / slip, slip)]);
        let length = 2.0 * c * (1.0 + 0.423 * mu - 0.056 * mu * mu);
        let angle = |factor: f64, mode| {
            chord(&cantilever(factor * length, 40, &section), bending_only(law.clone(), mode))
        };
        let (at, under, over) =
            (angle(1.0, Mode::Virgin), angle(0.99, Mode::Virgin), angle(1.01, Mode::Virgin));
        println!("mu {mu}: {under:.3} {at:.3} {over:.3}");
        assert!(under < 41.5 && over > 41.5, "mu {mu}: {under} {at} {over}");
        // The rod with the same law: the tip angle that leaves none at the clamp.
        let first = (couple + b * slip, couple / slip + b);
        let bent = |m: f64| if m < first.0 { m / first.1 } else { (m - couple) / b };
        let (mut low, mut high) = (0.0, 1.5);
        for _ in 0..50 {
            let tip = 0.5 * (low + high);
            if heavy_rod(weight, length, tip, bent).1 > 0.0 { high = tip } else { low = tip }
        }
        let exact = heavy_rod(weight, length, low, bent).0;
        // Facets of the mesh: 1e-4 of the length with 40 elements.
        assert!((at - exact).abs() < 0.05, "mu {mu}: {at} {exact}");
        // In one step there is no way back: friction is the virgin curve.
        assert!((angle(1.0, Mode::Friction) - at).abs() < 1e-6);
    }
}

/// A coupling that is stronger than the least tangents of two laws could release energy.
#[test]
fn laws_too_soft_for_the_coupling_are_refused() {
    let section = section();
    assert!(friction().checked(&section).is_ok());
    let mut law = friction();
    law.channels[0] = Some(channel(100.0, &[(6000.0, 1e-3)]));
    assert!(matches!(law.checked(&section), Err(SectionError::NotPositiveDefinite { .. })));
}
