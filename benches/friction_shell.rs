//! Cost of a Newton iteration of a sheet of `n` x `n` quads that sags from an edge: linear elastic,
//! with laws that are linear (the same iterations, cell by cell), and with six sliders in bending
//! and shear. Milliseconds on one thread.
//!
//! `cargo bench --bench friction_shell --no-default-features -- [N]`; the default `n` is 71 (5,041 elements).

use std::ops::ControlFlow;
use std::time::Instant;

use kesf::element::Formulation;
use kesf::law::{Backbone, Channel, Family, LawError, Mode, Slider, Widening};
use kesf::mesh::rectangle;
use kesf::model::{Load, Model, Support};
use kesf::section::{SheetLaw, ShellSection};
use kesf::solve::Options;
use kesf::solve::nonlinear::{Settings, Solution, solve};
use nalgebra::{Matrix2, Matrix3, Vector3};

fn section() -> ShellSection {
    ShellSection {
        d_m: Matrix3::new(6000.0, 1200.0, 0.0, 1200.0, 4000.0, 0.0, 0.0, 0.0, 50.0),
        d_b: Matrix3::from_diagonal(&Vector3::new(1e-5, 6e-6, 3e-6)),
        d_s: Matrix2::identity() * 50.0,
        areal_density: 0.15,
        thickness: 4e-4,
    }
}

/// Six sliders that carry `stress` together, slip levels from `first` to 8 `first`.
fn sliders(tangent: f64, stress: f64, first: f64) -> Result<Option<Channel>, LawError> {
    let levels = (0..6).map(|i| first * 8f64.powf(f64::from(i) / 5.0));
    let sliders = levels.map(|slip| Slider { stiffness: stress / 6.0 / slip, slip }).collect();
    let family = Family { widening: Widening::Constant, sliders };
    Channel::new(Backbone::line(tangent)?, vec![family], false).map(Some)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let n = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(71);
    let mesh = rectangle(0.2, 0.2, n, n)?;
    let model = Model {
        supports: vec![Support::clamped(mesh.set("left")?)],
        loads: vec![Load::Gravity(Vector3::new(0.0, 0.0, -0.05))],
        mesh,
        section: section(),
        warp: Vector3::new(0.8, 0.6, 0.0),
        formulation: Formulation::default(),
        bodies: Vec::new(),
    };
    let shear = sliders(50.0, 1.0, 1e-3)?;
    let [x, y, xy] = [sliders(1e-5, 2e-4, 2.0)?, sliders(6e-6, 1e-4, 2.0)?, sliders(3e-6, 7e-5, 2.0)?];
    let laws = [
        ("elastic", None),
        ("linear laws", Some(SheetLaw::linear(&model.section)?)),
        ("six sliders", Some(SheetLaw::new(Mode::Friction, [None, None, shear, x, y, xy]))),
    ];
    println!("{} elements, one thread", n * n);
    for (name, law) in laws {
        let settings = Settings { law, iterations: 40, ..Settings::default() };
        let start = Instant::now();
        let options = Options { threads: 1, ..Options::default() };
        let Solution { iterations, steps, .. } =
            solve(&model, &settings, &options, |_| ControlFlow::Continue(()))?;
        let each = start.elapsed().as_secs_f64() * 1e3 / iterations as f64;
        println!("{name:>12}: {each:8.1} ms an iteration, {iterations} iterations, {steps} steps");
    }
    Ok(())
}
