// A model without a case file: a clamped square of an orthotropic sheet under pressure.
//
//     cargo run --release --example solve

use std::error::Error;

use kesf::element::Formulation;
use kesf::mesh::rectangle;
use kesf::model::{Load, Model, Support};
use kesf::section::ShellSection;
use kesf::solve::{Options, solve};
use nalgebra::{Matrix2, Matrix3, Vector3};

fn main() -> Result<(), Box<dyn Error>> {
    // B1 / B2 = 4, no Poisson coupling, no torsion; stiff in transverse shear.
    let (b1, b2) = (4e-5, 1e-5);
    let section = ShellSection {
        d_m: Matrix3::from_diagonal(&Vector3::new(6000.0, 4000.0, 50.0)),
        d_b: Matrix3::from_diagonal(&Vector3::new(b1, b2, 0.0)),
        d_s: Matrix2::identity() * 5e3,
        areal_density: 0.15,
        thickness: 4e-4,
    }
    .checked()?;
    let (side, pressure) = (0.2, 1e-4);
    let mesh = rectangle(side, side, 40, 40)?;
    let supports = vec![Support::clamped(mesh.set("boundary")?)];
    let (warp, formulation) = (Vector3::x(), Formulation::default());
    let loads = vec![Load::Pressure(pressure)];
    let model = Model { mesh, section, warp, formulation, supports, loads, bodies: Vec::new() };

    let solution = solve(&model, &Options::default())?;
    let deflection = solution.displacement.chunks(6).map(|node| node[2]).fold(0.0, f64::max);
    let exact = pressure * side.powi(4) / (1536.0 * b2);
    println!("{deflection:.5e} m; q L^4 / (1536 B2) = {exact:.5e} m; residual {:.1e}", solution.residual);
    assert!((deflection / exact - 1.0).abs() < 2e-3, "{deflection} is not {exact}");
    Ok(())
}
