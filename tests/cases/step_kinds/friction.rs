//! Friction in motions.
//!
//! A strip of one cell with a law along it is an oscillator of its end: m ü + b σ(u/L) = 0, σ that of a backbone and sliders
//! (Prandtl-Ishlinskii). The reference follows the sliders by itself in small steps.

use std::ops::ControlFlow;

use kesf::element::{Formulation, Mass};
use kesf::law::{Backbone, Channel, Family, Mode, Slider, Widening};
use kesf::mesh::rectangle;
use kesf::model::{Dof, Load, Model, Support};
use kesf::section::{SheetLaw, ShellSection};
use kesf::solve::Options;
use kesf::solve::newmark::{Energy, LoadHistory, Rayleigh};
use kesf::solve::nonlinear::dynamics::{Dynamics, Launch, integrate_with};
use kesf::solve::nonlinear::{Carried, LoadStep, Method, Settings, continue_from, plan};
use nalgebra::{Matrix2, Matrix3, Vector3};

use super::{BREADTH, DENSITY};

const LENGTH: f64 = 0.1;
const BACKBONE: f64 = 4e3;
/// Stiffness (N/m) and the strain at which each slips.
const SLIDERS: [[f64; 2]; 3] = [[1e3, 2e-5], [8e2, 6e-5], [2e2, 2e-4]];

fn law() -> SheetLaw {
    let sliders = SLIDERS.map(|[stiffness, slip]| Slider { stiffness, slip }).to_vec();
    let family = Family { widening: Widening::Constant, sliders };
    let channel = Channel::new(Backbone::line(BACKBONE).unwrap(), vec![family], false).unwrap();
    SheetLaw::new(Mode::Friction, [Some(channel), None, None, None, None, None])
}

fn strip(force: f64) -> Model {
    let mesh = rectangle(LENGTH, BREADTH, 1, 1).unwrap();
    let end = mesh.set("right").unwrap().to_vec();
    let across = [Dof::V, Dof::W, Dof::ThetaX, Dof::ThetaY, Dof::ThetaZ];
    Model {
        supports: vec![
            Support::fix(mesh.set("all").unwrap(), &across),
            Support::fix(mesh.set("left").unwrap(), &[Dof::U]),
        ],
        loads: vec![Load::Point {
            nodes: end,
            force: Vector3::new(force, 0.0, 0.0),
            moment: Vector3::zeros(),
        }],
        mesh,
        section: ShellSection {
            d_m: Matrix3::from_diagonal(&Vector3::new(6e3, 6e3, 3e3)),
            d_b: Matrix3::from_diagonal(&Vector3::new(1e-5, 1e-5, 5e-6)),
            d_s: Matrix2::identity() * 50.0,
            areal_density: DENSITY,
            thickness: 4e-4,
        },
        warp: Vector3::x(),
        formulation: Formulation::default(),
        bodies: Vec::new(),
    }
}

/// The reference: springs of the sliders, and the force of a strain.
#[derive(Clone, Copy, Default)]
struct Sliding {
    strain: f64,
    kept: [f64; 3],
    lost: f64,
}

impl Sliding {
    /// Stress (N/m) at a strain that is reached straight.
    fn stress(&mut self, strain: f64) -> f64 {
        let step = strain - self.strain;
        self.strain = strain;
        let mut stress = BACKBONE * strain;
        for ([stiffness, slip], kept) in SLIDERS.iter().zip(&mut self.kept) {
            let free = *kept + step;
            let held = free.clamp(-slip, *slip);
            self.lost += BREADTH * LENGTH * stiffness * held * (free - held);
            *kept = held;
            stress += stiffness * held;
        }
        stress
    }
}

/// An end that was pulled, let go: the same motion and the same loss as the oscillator, and what is lost is the area of the loops.
#[test]
fn a_strip_with_friction_swings_as_its_law_says() {
    let options = Options::default();
    // Pulled so far that two of three sliders slip.
    let pulled = strip(0.01);
    let (bare, law) = (strip(0.0), law());
    let plan = plan(&bare, &options).unwrap();
    let settings = Settings {
        law: Some(law.clone()),
        first_step: 0.02,
        largest_step: 0.02,
        tolerance: 1e-12,
        ..Settings::default()
    };
    let newton = Method::Newton(None);
    let step = LoadStep { model: &pulled, prescribed: &[], settings: &settings, method: &newton };
    let rest = Carried::rest(&bare);
    let (end, carried) = continue_from(&rest, &step, &plan, &options, |_| ControlFlow::Continue(())).unwrap();
    let tip = *bare.mesh.set("right").unwrap().first().unwrap() as usize;
    let start = end.state.position[tip].x - LENGTH;

    let mass = 0.5 * DENSITY * LENGTH * BREADTH;
    let omega = ((BACKBONE + 2e3) * BREADTH / LENGTH / mass).sqrt();
    let (period, periods) = (std::f64::consts::TAU / omega, 4.0);
    // The reference: pulled, and then central differences of 1/20,000 of a period.
    let mut sliding = Sliding::default();
    for k in 1..=1000 {
        sliding.stress(start / LENGTH * f64::from(k) / 1000.0);
    }
    assert!((sliding.stress(start / LENGTH) * BREADTH / 0.01 - 1.0).abs() < 1e-6);
    let (fine, mut u, mut v) = (period / 20_000.0, start, 0.0);
    let (before, mut path) = (sliding.lost, vec![[start, 0.0]]);
    let mut acceleration = -sliding.stress(u / LENGTH) * BREADTH / mass;
    for _ in 0..(20_000.0 * periods) as usize {
        v += 0.5 * fine * acceleration;
        u += fine * v;
        acceleration = -sliding.stress(u / LENGTH) * BREADTH / mass;
        v += 0.5 * fine * acceleration;
        path.push([u, sliding.lost - before]);
    }
    let run = |steps: f64| {
        let dynamics = Dynamics {
            duration: periods * period,
            step: period / steps,
            tolerance: None,
            spectral_radius: None,
            damping: Rayleigh::default(),
            load: LoadHistory::Step,
            mass: Mass::Lumped,
        };
        let launch = Launch { carried: Some(&carried), law: Some(&law), ..Launch::default() };
        let mut seen: Vec<(f64, f64, Energy)> = Vec::new();
        integrate_with(&bare, &plan, &launch, &dynamics, &options, |at| {
            seen.push((at.time, at.displacement[6 * tip], at.energy));
            ControlFlow::Continue(())
        })
        .unwrap();
        let (mut worst, mut loss) = (0.0f64, 0.0f64);
        let stored = seen[0].2.strain;
        for (time, u, energy) in &seen {
            let [expected, lost] = path[((time / fine).round() as usize).min(path.len() - 1)];
            worst = worst.max((u - expected).abs() / start);
            loss = loss.max((energy.dissipated - lost).abs() / stored);
            assert!(energy.imbalance().abs() < 1e-3 * stored, "{time}: {energy:?}");
        }
        let most = seen.last().unwrap().2.dissipated / stored;
        println!("{steps}: {worst:.3e} of the start, {loss:.3e} of the energy; lost {most:.3}");
        assert!(most > 0.05);
        [worst, loss]
    };
    let (coarse, fine) = (run(50.0), run(200.0));
    assert!(fine[0] < 0.01 && fine[1] < 0.005, "{fine:?}");
    assert!(fine[0] < 0.3 * coarse[0], "{coarse:?} {fine:?}");
}
