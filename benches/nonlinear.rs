//! Cost of statics in large rotations: on one thread a square sheet that sags from an edge, and a whole search for a drape, whose
//! starts use all cores.
//!
//! `cargo bench --bench nonlinear` prints iterations, milliseconds an iteration, elements a second, and how many times
//! the time of an iteration is that in which this machine does as many operations as its factorisation has in a dense product.
//! `-- drape` searches for the drape of the shipped case as well, every start and every mesh (a minute).

mod machine;

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use kesf::characterise::{Settings as Evaluation, characterise};
use kesf::constitutive::section;
use kesf::element::Formulation;
use kesf::instrument::{ReadSettings, read_fabrics};
use kesf::mesh::{QuadMesh, rectangle};
use kesf::model::{Load, Model, Support};
use kesf::section::ShellSection;
use kesf::solve::Options;
use kesf::solve::factor::{Path as FactorPath, analyse_ordered, order};
use kesf::solve::nonlinear::{Settings, Solution, solve};
use kesf::solve::sparse::BlockGraph;
use kesf::study::{Case, Watch, drape};
use machine::dense_product;
use nalgebra::{Matrix2, Matrix3, Vector3};

/// Operations of the factorisation of the equations of a mesh, six a node.
fn operations(mesh: &QuadMesh) -> f64 {
    let points: Vec<[f64; 3]> = mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect();
    let graph = Arc::new(BlockGraph::from_elements(mesh.nodes.len(), &mesh.quads));
    let ordering = order(&graph, Some(&points)).expect("memory");
    analyse_ordered(&graph, 6, &ordering, FactorPath::Auto).expect("memory").counts().flops
}

fn line(name: &str, mesh: &QuadMesh, seconds: f64, iterations: usize, rate: f64) {
    let (each, elements) = (seconds / iterations as f64, mesh.quads.len());
    println!(
        "{name:>8} {elements:6} elements: {iterations:5} iterations, {:7.2} ms each, {:8.0} elements/s, {:5.1} times the dense product",
        1e3 * each,
        elements as f64 / each,
        each / (operations(mesh) / (1e9 * rate))
    );
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rate = dense_product();
    println!("C = {rate:.1} GFLOP/s: dense 512 x 512 product, one thread");
    let options = Options { threads: 1, ..Options::default() };
    for n in [20, 36, 71] {
        let mesh = rectangle(0.2, 0.2, n, n)?;
        let model = Model {
            supports: vec![Support::clamped(mesh.set("left")?)],
            loads: vec![Load::Gravity(Vector3::new(0.0, 0.0, -0.05))],
            mesh,
            section: ShellSection {
                d_m: Matrix3::new(6000.0, 1200.0, 0.0, 1200.0, 4000.0, 0.0, 0.0, 0.0, 50.0),
                d_b: Matrix3::from_diagonal(&Vector3::new(1e-5, 6e-6, 3e-6)),
                d_s: Matrix2::identity() * 50.0,
                areal_density: 0.15,
                thickness: 4e-4,
            },
            warp: Vector3::new(0.8, 0.6, 0.0),
            formulation: Formulation::default(),
            bodies: Vec::new(),
        };
        let start = Instant::now();
        let Solution { iterations, .. } =
            solve(&model, &Settings::default(), &options, |_| ControlFlow::Continue(()))?;
        line("sheet", &model.mesh, start.elapsed().as_secs_f64(), iterations, rate);
    }
    if std::env::args().any(|arg| arg == "drape") {
        let home = Path::new(env!("CARGO_MANIFEST_DIR"));
        let batch = read_fabrics(&[home.join("kesf_data/poplin")], &ReadSettings::default(), &|_: &Path| ());
        let sheet = characterise(&batch.fabrics[0], &Evaluation::default());
        let made = section(&sheet, &Default::default())?;
        let case = Case::read(&home.join("cases/drape.toml"))?;
        let start = Instant::now();
        let found = drape(&case, &made.section, None, &options, Watch::default())?;
        println!("a whole search: {:.1} s of wall-clock time", start.elapsed().as_secs_f64());
        for state in found.states.iter().chain(&found.meshes) {
            let (elements, iterations) = (state.elements, state.iterations);
            println!("{elements:6} elements, {:2} folds: {iterations:5} iterations", state.folds.count);
        }
    }
    Ok(())
}
