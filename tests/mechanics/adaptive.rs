//! Meshes that the estimate of their error refines.
//!
//! Goal: as good a result with fewer unknowns where a sheet is singular, and no harm where it is not.
//!
//! ```text
//!        +-----------+
//!        |           |        an L whose inner corner is free, moved along its outer edges as the field of that corner says;
//!        |     +-----+        a square that is pressed, or pulled by one node; a cloth that is sheared between clamps; a disc
//!        |     | free
//!        +-----+
//! ```
//! References (analytical): the field of the corner, `r^0.544` (Williams, *J. Appl. Mech.* 19 (1952) 526; as in Carstensen and
//! Klose, *J. Comput. Phys.* 184 (2003)), whose error in energy is integrated; series and polynomials of `kesf::analytical`. Of the
//! sheared cloth (own): uniform meshes, extrapolated.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;
use std::process::Command;

use kesf::analytical::Plate;
use kesf::analytical::elastica::heavy_elastica;
use kesf::analytical::levy::Edge;
use kesf::element::{Formulation, Membrane, gauss_point};
use kesf::fields::{self, ErrorEstimate, Resultants};
use kesf::mesh::{GridLines, QuadMesh, Refinement, rectangle};
use kesf::model::{Dof, Load, Model, Support};
use kesf::section::ShellSection;
use kesf::solve::{self, Options};
use kesf::study::{Case, CaseResult, section, solve_case};
use nalgebra::{Matrix2, Matrix3, Point3, Vector3};

/// Part of the energy of the error that `[adaptive]` divides.
const SHARE: f64 = 0.5;

/// The exponent of the inner corner of an L with free sides: `α sin 2ω + sin 2ωα = 0`, ω = 3π/4.
const ALPHA: f64 = 0.544483736782;
/// Constants of Lamé of the sheet in its plane (N/m): E = 1, ν = 0.3.
const MU: f64 = 0.5 / 1.3;
const LAMBDA: f64 = 0.3 / (1.0 - 0.09);

/// The displacement about the inner corner of an L (m): the angle runs from -ω to ω from the middle of the sheet.
fn corner(x: f64, y: f64) -> [f64; 2] {
    let omega = 0.75 * PI;
    // The axis of symmetry of the L, whose missing quadrant is x > 0, y > 0, points to (-1, -1).
    let turn = 1.25 * PI;
    let (r, mut angle) = (x.hypot(y), y.atan2(x) - turn);
    while angle < -PI {
        angle += 2.0 * PI;
    }
    let c1 = -((ALPHA + 1.0) * omega).cos() / ((ALPHA - 1.0) * omega).cos();
    let c2 = 2.0 * (LAMBDA + 2.0 * MU) / (LAMBDA + MU);
    let size = r.powf(ALPHA) / (2.0 * MU);
    let (plus, minus) = (ALPHA + 1.0, ALPHA - 1.0);
    let radial = size * (-plus * (plus * angle).cos() + (c2 - plus) * c1 * (minus * angle).cos());
    let around = size * (plus * (plus * angle).sin() + (c2 + minus) * c1 * (minus * angle).sin());
    let (sin, cos) = (angle + turn).sin_cos();
    [radial * cos - around * sin, radial * sin + around * cos]
}

/// The forces of that field by differences of fourth order.
fn corner_forces(x: f64, y: f64) -> Resultants {
    let h = 1e-3 * x.hypot(y);
    let slope = |[dx, dy]: [f64; 2]| {
        let at = |k: f64| corner(x + k * h * dx, y + k * h * dy);
        let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(at);
        [0, 1].map(|i| (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * h))
    };
    let (along_x, along_y) = (slope([1.0, 0.0]), slope([0.0, 1.0]));
    let (ex, ey, gamma) = (along_x[0], along_y[1], along_x[1] + along_y[0]);
    let sum = LAMBDA * (ex + ey);
    let membrane = [sum + 2.0 * MU * ex, sum + 2.0 * MU * ey, MU * gamma];
    Resultants { membrane, ..Resultants::default() }
}

/// An L of three squares of unit side without x > 0, y > 0, `n` cells along a side; sets `outer` (what is moved) and `all`.
fn l_shape(n: usize) -> QuadMesh {
    let whole = rectangle(2.0, 2.0, 2 * n, 2 * n).unwrap();
    let place = |p: &Point3<f64>| Point3::new(p.x - 1.0, p.y - 1.0, 0.0);
    let mut number = BTreeMap::new();
    let (mut nodes, mut quads) = (Vec::new(), Vec::new());
    for (k, quad) in whole.quads.iter().enumerate() {
        if k % (2 * n) >= n && k / (2 * n) >= n {
            continue;
        }
        quads.push(quad.map(|node| {
            *number.entry(node).or_insert_with(|| {
                nodes.push(place(&whole.nodes[node as usize]));
                nodes.len() as u32 - 1
            })
        }));
    }
    let outer = |node: &u32| {
        let p = nodes[*node as usize];
        p.x.abs() > 1.0 - 1e-9 || p.y.abs() > 1.0 - 1e-9
    };
    let all: Vec<u32> = (0..nodes.len() as u32).collect();
    let outer = all.iter().copied().filter(outer).collect();
    let node_sets = BTreeMap::from([("all".into(), all), ("outer".into(), outer)]);
    QuadMesh { nodes, quads, node_sets, ..QuadMesh::default() }
}

fn plane_section() -> ShellSection {
    let plane = Matrix3::new(LAMBDA + 2.0 * MU, LAMBDA, 0.0, LAMBDA, LAMBDA + 2.0 * MU, 0.0, 0.0, 0.0, MU);
    ShellSection {
        d_m: plane,
        d_b: plane * (1e-4 / 12.0),
        d_s: Matrix2::identity() * (MU * 5.0 / 6.0),
        areal_density: 1.0,
        thickness: 1e-2,
    }
}

fn model(mesh: QuadMesh, section: ShellSection, supports: Vec<Support>, loads: Vec<Load>) -> Model {
    let formulation = Formulation::default();
    Model { mesh, section, warp: Vector3::x(), formulation, supports, loads, bodies: Vec::new() }
}

fn pulled(mesh: QuadMesh) -> Model {
    let mut supports: Vec<Support> = Vec::new();
    for node in mesh.set("outer").unwrap() {
        let p = mesh.nodes[*node as usize];
        let [u, v] = corner(p.x, p.y);
        supports.push(Support::at(vec![*node], vec![(Dof::U, u), (Dof::V, v)]));
    }
    supports.push(Support::fix(mesh.set("all").unwrap(), &[Dof::W, Dof::ThetaX, Dof::ThetaY]));
    model(mesh, plane_section(), supports, Vec::new())
}

/// What a mesh gives.
#[derive(Clone, Copy, Debug)]
struct Point {
    unknowns: usize,
    /// The error itself over the whole, in the energy norm.
    error: f64,
    /// As it is estimated.
    estimated: f64,
    /// The estimate over the error.
    index: f64,
}

/// Energies of the difference of N and M of the elements from a field, and of the field (J).
fn energies(model: &Model, u: &[f64], exact: impl Fn(f64, f64) -> Resultants) -> [f64; 2] {
    let section = &model.section;
    let [membrane, bending] = [section.d_m, section.d_b].map(|d| d.try_inverse().unwrap());
    let energy = |n: [f64; 3], m: [f64; 3]| {
        let (n, m) = (Vector3::from(n), Vector3::from(m));
        0.5 * (n.dot(&(membrane * n)) + m.dot(&(bending * m)))
    };
    let (mut error, mut whole) = (0.0, 0.0);
    for (quad, own) in fields::cells(model, u).unwrap().iter().enumerate() {
        let xy = model.mesh.corners(quad).map(|p| [p.x, p.y]);
        for (k, own) in own.iter().enumerate() {
            let (points, area) = model.formulation.cells.gauss(k);
            for point in points {
                let at = gauss_point(&xy, point);
                let [x, y] = [0, 1].map(|axis| (0..4).map(|i| at.n[i] * xy[i][axis]).sum::<f64>());
                let exact = exact(x, y);
                let n = [0, 1, 2].map(|k| own.membrane[k] - exact.membrane[k]);
                let m = [0, 1, 2].map(|k| own.moment[k] - exact.moment[k]);
                error += area * at.det * energy(n, m);
                whole += area * at.det * energy(exact.membrane, exact.moment);
            }
        }
    }
    [error, whole]
}

/// The error of a model against a field, in the energy norm, and the estimate.
fn against(model: &Model, exact: impl Fn(f64, f64) -> Resultants) -> (Point, ErrorEstimate) {
    let solution = solve::solve(model, &Options::default()).unwrap();
    let u = &solution.displacement;
    let estimate = ErrorEstimate::new(model, u, &fields::nodal(model, u).unwrap()).unwrap();
    let [error, energy] = energies(model, u, exact);
    let point = Point {
        unknowns: solution.dofs,
        error: (error / energy).sqrt(),
        estimated: estimate.relative(),
        index: (estimate.energy() / error).sqrt(),
    };
    (point, estimate)
}

/// The slope of a line through logarithms (least squares).
fn slope(points: &[Point]) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|p| [(p.unknowns as f64).ln(), p.error.ln()]).collect();
    let mean = [0, 1].map(|k| logs.iter().map(|l| l[k]).sum::<f64>() / logs.len() as f64);
    let products = logs.iter().map(|l| (l[0] - mean[0]) * (l[1] - mean[1])).sum::<f64>();
    products / logs.iter().map(|l| (l[0] - mean[0]).powi(2)).sum::<f64>()
}

/// The energy norm of the error at the inner corner of an L: `N^-0.27` on uniform meshes, whose elements are small where nothing needs them,
/// and `N^-0.5`, the best that elements of first order can do, where the estimate refines.
#[test]
fn a_singular_corner_needs_few_unknowns() {
    let uniform: Vec<Point> =
        [4, 8, 16, 32, 64].map(|n| against(&pulled(l_shape(n)), corner_forces).0).to_vec();
    let mut refinement = Refinement::new(&l_shape(4), GridLines::Straight).unwrap();
    let mut adaptive = Vec::new();
    for _ in 0..16 {
        let refined = refinement.mesh();
        let (point, estimate) = against(&pulled(refined.mesh.clone()), corner_forces);
        adaptive.push(point);
        refinement.divide_largest(&refined, &estimate.elements, SHARE);
    }
    for (what, points) in [("uniform", &uniform), ("adaptive", &adaptive)] {
        for p in points {
            println!(
                "{what}: {} unknowns, error {:.2} %, estimated {:.2} %, effectivity {:.3}",
                p.unknowns,
                100.0 * p.error,
                100.0 * p.estimated,
                p.index
            );
        }
    }
    let fine: Vec<Point> = adaptive.iter().copied().filter(|p| p.unknowns > 1000).collect();
    let slopes = [slope(&uniform), slope(&fine)];
    println!("slopes {slopes:.3?}");
    // Half the exponent of the corner, and half the order of the elements.
    assert!((slopes[0] + 0.5 * ALPHA).abs() < 0.03 && slopes[1] < -0.48, "{slopes:?}");
    assert!(uniform.iter().chain(&adaptive).all(|p| (0.95..1.15).contains(&p.index)));
    assert!(fine.iter().all(|p| (0.98..1.05).contains(&p.index)));
    let finest = uniform.last().unwrap();
    let as_good = adaptive.iter().find(|p| p.error < finest.error).unwrap();
    println!("{} unknowns instead of {}", as_good.unknowns, finest.unknowns);
    assert!(20 * as_good.unknowns < finest.unknowns);
}

fn solved(text: &str) -> CaseResult {
    let case = Case::parse(Path::new("c.toml"), text).unwrap();
    let own = section(case.section().unwrap()).unwrap();
    solve_case(&case, own, &Options::default()).unwrap()
}

fn example() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/adaptive/sheared.toml");
    std::fs::read_to_string(file).unwrap()
}

/// A plate with D = 1 N·m, ν = 0.3, t = 1 mm.
const PLATE: &str = r#"
title = "t"
[section]
tensile_warp = "10.92e6 N/m"
tensile_weft = "10.92e6 N/m"
poisson = 0.3
shear = "4.2e6 N/m"
bending_warp = "1 N·m"
bending_weft = "1 N·m"
bending_coupling = "0.3 N·m"
torsion = "0.35 N·m"
transverse_shear = "3.5e6 N/m"
areal_density = "1 kg/m²"
thickness = "1 mm"
"#;

const SQUARE: &str = "[sheet]\nshape = \"rectangle\"\nwidth = \"1 m\"\nheight = \"1 m\"\ncells = [8, 8]\n";
const PRESSURE: &str = "[[loads]]\nkind = \"pressure\"\nvalue = \"0.001 Pa\"\n";
const CENTRE: &str = "[[probes]]\nname = \"centre\"\nat = [\"0.5 m\", \"0.5 m\"]\n";

fn support(set: &str, kind: &str) -> String {
    format!("[[supports]]\nset = \"{set}\"\nkind = \"{kind}\"\n")
}

fn adaptive(error: &str) -> String {
    format!("[adaptive]\nerror = \"{error}\"\n")
}

/// The energy of a cloth that is sheared between clamps, singular at their corners: what it needs on equal cells, and what it needs
/// where the estimate refines.
#[test]
fn a_sheared_cloth_needs_few_unknowns() {
    let text = example();
    let plain = text.split("[adaptive]").next().unwrap();
    let uniform: Vec<[f64; 2]> = [8, 16, 32, 64, 128]
        .map(|n| {
            let result = solved(&plain.replace("[8, 16]", &format!("[{n}, {}]", 2 * n)));
            [result.solution.dofs as f64, result.solution.strain_energy]
        })
        .to_vec();
    // Differences fall by one factor: what they come to.
    let [a, b, c] = [2, 3, 4].map(|k| uniform[k][1]);
    let limit = c - (b - c) * (b - c) / ((a - b) - (b - c));
    let result = solved(&text);
    let found = result.adapted.as_ref().unwrap();
    assert!(found.reached && found.meshes.len() > 4);
    let energy = found.quantities.iter().find(|q| q.quantity == "strain_energy").unwrap();
    let error = |energy: f64| 100.0 * (energy / limit - 1.0);
    for [unknowns, energy] in &uniform {
        println!("uniform: {unknowns} unknowns, energy {:+.3} %", error(*energy));
    }
    for (mesh, value) in found.meshes.iter().zip(&energy.values) {
        println!(
            "adaptive: {} unknowns, energy {:+.3} %, estimated {:.2} %",
            mesh.dofs,
            error(*value),
            100.0 * mesh.error
        );
    }
    assert_eq!(energy.values.last(), Some(&result.solution.strain_energy));
    let [equal, of_equal] = uniform[3];
    let mut meshes = found.meshes.iter().zip(&energy.values);
    let as_good = meshes.find(|(_, value)| error(**value).abs() < error(of_equal).abs()).unwrap().0;
    println!("{} unknowns instead of {equal}", as_good.dofs);
    assert!(5.0 * as_good.dofs as f64 <= equal);
}

/// A pressed square has an error everywhere: as many unknowns as equal cells need for the same error in energy. Its deflection is
/// as good as the energy is, which equal squares surpass.
#[test]
fn a_smooth_case_is_not_harmed() {
    let square = Plate::of_section(1.0, 1.0, &section_of(PLATE));
    let clamped = square.clamped(1e-3).unwrap();
    for kind in ["simply_supported", "clamped"] {
        let exact = |x: f64, y: f64| match kind {
            "clamped" => clamped.state(x, y),
            _ => square.levy(Edge::Supported, x, y, 1e-3),
        };
        let moments = |x: f64, y: f64| {
            let at = exact(x, y);
            Resultants { moment: [at.mx, at.my, at.mxy], ..Resultants::default() }
        };
        let w = exact(0.5, 0.5).deflection.abs();
        let mut costs = Vec::new();
        for (cells, more) in [(32, String::new()), (8, adaptive("5 %"))] {
            let square = SQUARE.replace("[8, 8]", &format!("[{cells}, {cells}]"));
            let r = solved(&format!("{PLATE}{square}{}{PRESSURE}{CENTRE}{more}", support("boundary", kind)));
            let estimated = r.error_estimate().unwrap().unwrap();
            let [error, whole] = energies(&r.model, &r.solution.displacement, moments);
            let (index, error) = ((estimated.energy() / error).sqrt(), (error / whole).sqrt());
            let off = r.probes[0].value.u[2].abs() / w - 1.0;
            println!(
                "{kind}: {} elements, {} triangles, {} unknowns, error {:.2} %, effectivity {index:.3}, w {:+.3} % off",
                r.model.mesh.quads.len(),
                r.model.mesh.triangles(),
                r.solution.dofs,
                100.0 * error,
                100.0 * off,
            );
            // Unknowns times the square of an error are the same on all uniform meshes in the end.
            costs.push(r.solution.dofs as f64 * error * error);
            assert!((0.9..1.1).contains(&index) && off.abs() < 2.0 * error * error, "{index} {off}");
        }
        println!("unknowns x error²: {:.2} of those of equal cells", costs[1] / costs[0]);
        assert!(costs[1] < 1.25 * costs[0]);
    }
}

fn section_of(text: &str) -> ShellSection {
    let whole = format!("{text}{SQUARE}{}{PRESSURE}", support("boundary", "clamped"));
    section(Case::parse(Path::new("c.toml"), &whole).unwrap().section().unwrap()).unwrap()
}

/// The energy of a clamped square that one node is pulled at: half the work of its force, 0.00560 F L²/D (Timoshenko and
/// Woinowsky-Krieger, *Theory of Plates and Shells*, Table 37).
#[test]
fn a_pulled_plate_is_refined_about_its_force() {
    let pulled = "[[loads]]\nkind = \"point\"\nat = [\"0.5 m\", \"0.5 m\"]\nvalue = \"0.001 N\"\ndirection = [0, 0, 1]\n";
    let text = format!("{PLATE}{SQUARE}{}{pulled}{CENTRE}", support("boundary", "clamped"));
    let result = solved(&format!("{text}{}", adaptive("6 %")));
    let mesh = &result.model.mesh;
    let area = |about: [f64; 2]| {
        let near = |q: &usize| mesh.corners(*q).iter().any(|p| (p.x - about[0]).hypot(p.y - about[1]) < 1e-9);
        let quad = (0..mesh.quads.len()).find(near).unwrap();
        let c = mesh.corners(quad);
        0.5 * (c[2] - c[0]).cross(&(c[3] - c[1])).norm()
    };
    let ratio = area([0.0, 0.0]) / area([0.5, 0.5]);
    let equal = solved(&text.replace("[8, 8]", "[64, 64]"));
    let costs = [&result, &equal]
        .map(|r| r.solution.dofs as f64 * r.error_estimate().unwrap().unwrap().relative().powi(2));
    println!("unknowns x estimated error²: {:.2} of those of 64 x 64 equal cells", costs[0] / costs[1]);
    assert!(costs[0] < 0.7 * costs[1]);
    let w = result.probes[0].value.u[2];
    println!(
        "{} unknowns, cells in a corner are {ratio} of those about the force, w {:+.3} % off",
        result.solution.dofs,
        100.0 * (w / 5.60e-6 - 1.0)
    );
    // The force stays on its node, and so it is whole.
    assert!((result.reactions().unwrap()[0].z + 1e-3).abs() < 1e-9 * 1e-3);
    assert!(ratio >= 64.0 && (w / 5.60e-6 - 1.0).abs() < 0.005, "{ratio} {w:e}");
}

/// Round sheets: the boundary lies on its circle, pressure and edge forces are those of the polygon, which comes nearer to it.
#[test]
fn round_sheets_and_their_loads_stay_round() {
    let disc = "[sheet]\nshape = \"disc\"\ndiameter = \"1 m\"\ncells = [4, 4]\n";
    let ring =
        "[sheet]\nshape = \"annulus\"\ndiameter = \"1 m\"\ninner_diameter = \"0.2 m\"\ncells = [4, 16]\n";
    let edge =
        "[[loads]]\nkind = \"edge_force\"\nset = \"outer\"\nvalue = \"0.001 N/m\"\ndirection = [0, 0, 1]\n";
    let full = 0.25 * PI * 1e-3;
    for (sheet, held, loads, whole) in [
        (disc, "outer", PRESSURE, full),
        (ring, "inner", PRESSURE, full * (1.0 - 0.04)),
        (ring, "inner", edge, PI * 1e-3),
    ] {
        let result = solved(&format!("{PLATE}{sheet}{}{loads}{}", support(held, "clamped"), adaptive("7 %")));
        let mesh = &result.model.mesh;
        assert!(
            result.adapted.as_ref().unwrap().reached && mesh.check().is_ok() && mesh.unjoined().is_none()
        );
        let area: f64 = (0..mesh.quads.len())
            .map(|q| {
                let c = mesh.corners(q);
                0.5 * (c[2] - c[0]).cross(&(c[3] - c[1])).z
            })
            .sum();
        let outer = mesh.set("outer").unwrap();
        assert!(outer.iter().all(|n| (mesh.nodes[*n as usize].coords.norm() - 0.5).abs() < 1e-12));
        let around: f64 = (mesh.set_edges("outer").unwrap().iter())
            .map(|[a, b]| (mesh.nodes[*a as usize] - mesh.nodes[*b as usize]).norm())
            .sum();
        let acting = 1e-3 * if loads == edge { around } else { area };
        let borne = -result.reactions().unwrap()[0].z;
        println!(
            "{} elements bear {:.4} % of the load of the circle",
            mesh.quads.len(),
            100.0 * borne / whole
        );
        assert!((borne / acting - 1.0).abs() < 1e-8, "{borne:e} {acting:e}");
        // 16 sides in a circle have 97.4 % of its area and 99.4 % of its length.
        assert!((0.98..1.0 + 1e-9).contains(&(borne / whole)));
    }
}

/// Large rotations: a cantilever that hangs under its weight, B = 1, ν = 0, of two cells at the beginning.
#[test]
fn a_hanging_strip_is_refined_in_large_rotations() {
    let strip = r#"
title = "t"
[section]
tensile_warp = "3e6 N/m"
tensile_weft = "3e6 N/m"
poisson = 0
shear = "1.5e6 N/m"
bending_warp = "1 N·m"
bending_weft = "1 N·m"
bending_coupling = "0 N·m"
torsion = "0.5 N·m"
transverse_shear = "1.2e6 N/m"
areal_density = "1 kg/m²"
thickness = "2 mm"
[sheet]
shape = "strip"
width = "1 m"
height = "0.25 m"
cells = [8, 2]
[[supports]]
set = "left"
kind = "clamped"
[[loads]]
kind = "gravity"
[analysis]
kind = "nonlinear"
[[probes]]
name = "end"
at = ["1 m", "0.125 m"]
"#;
    let exact = heavy_elastica(9.80665).unwrap().drop;
    let result = solved(&format!("{strip}{}", adaptive("5 %")));
    let found = result.adapted.as_ref().unwrap();
    let off = -result.probes[0].value.u[2] / exact - 1.0;
    println!("{:?}, drop {:+.3} % off", found.meshes, 100.0 * off);
    assert!(found.reached && result.model.mesh.triangles() > 0);
    assert_eq!(result.model.formulation.membrane, Membrane::AssumedStress);
    assert!(off.abs() < 2e-3, "{off}");
}

/// Where the mesh cannot be as fine as that, the result of the last mesh stands, and a finding at the table says why.
#[test]
fn limits_end_it_and_are_told() {
    let text = format!("{PLATE}{SQUARE}{}{PRESSURE}", support("boundary", "clamped"));
    let line = text.lines().count() + 1;
    for (limit, meshes, why) in [("meshes = 3", 3, "`meshes`"), ("elements = 200", 2, "`elements`")] {
        let result = solved(&format!("{text}{}{limit}\n", adaptive("1 %")));
        let found = result.adapted.as_ref().unwrap();
        assert!(!found.reached && found.meshes.len() == meshes && found.goal == 0.01);
        assert_eq!(found.meshes.last().unwrap().elements, result.model.mesh.quads.len());
        assert!(found.meshes.iter().all(|m| m.elements <= 200 || limit.starts_with("meshes")));
        let finding = result.findings.iter().find(|f| f.code() == "S153").unwrap();
        assert!(finding.message().contains(why), "{}", finding.message());
        assert_eq!(finding.place.as_ref().unwrap().line, line);
    }
    // Nothing to do: the mesh of the case has it.
    let coarse = solved(&format!("{text}{}", adaptive("90 %")));
    assert!(coarse.adapted.as_ref().unwrap().meshes.len() == 1 && coarse.model.mesh.triangles() == 0);
    assert!(coarse.findings.iter().all(|f| f.code() != "S153"));
}

/// Supports inside, rigid bodies and distorted cells are where the case has put them, on every mesh.
#[test]
fn what_a_case_says_of_places_holds_on_every_mesh() {
    let inside = SQUARE.replace("cells", "inside_radius = \"13 cm\"\ndistortion = 0.2\ncells");
    let rigid = "[[rigid]]\nname = \"bar\"\nset = \"right\"\n";
    let bar = "[[loads]]\nkind = \"point\"\nset = \"bar\"\nvalue = \"0.001 N\"\ndirection = [0, 0, 1]\n";
    let text =
        format!("{PLATE}{inside}{}{rigid}{bar}{}", support("inside_radius", "clamped"), adaptive("20 %"));
    let result = solved(&text);
    let mesh = &result.model.mesh;
    assert!(result.adapted.as_ref().unwrap().meshes.len() > 2);
    let w = |n: u32| result.solution.displacement[6 * n as usize + 2];
    let near = |p: &Point3<f64>| (p.x - 0.5).hypot(p.y - 0.5) <= 0.13;
    let held = mesh.set("inside_radius").unwrap();
    assert_eq!(held.len(), mesh.nodes.iter().filter(|p| near(p)).count());
    assert!(held.iter().all(|n| w(*n) == 0.0));
    let right = mesh.set("right").unwrap();
    let on_it = mesh.nodes.iter().take(mesh.nodes.len() - 1).filter(|p| p.x == 1.0).count();
    assert_eq!(right.len(), on_it);
    let [first, last] = [right[0], right[right.len() - 1]];
    println!(
        "{} elements, {} nodes in the bar: {:e} to {:e} m",
        mesh.quads.len(),
        right.len(),
        w(first),
        w(last)
    );
    for n in right {
        let [a, b, y] = [first, last, *n].map(|n| mesh.nodes[n as usize].y);
        let line = w(first) + (w(last) - w(first)) * (y - a) / (b - a);
        assert!((w(*n) - line).abs() < 1e-9 * w(first).abs());
    }
}

/// The shipped example through the command: what the document and the text tell of the meshes.
#[test]
fn a_refined_case_goes_through_the_command() {
    let run = |more: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_kesf"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["solve", "examples/adaptive/sheared.toml"])
            .args(more)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let document: serde_json::Value = serde_json::from_str(&run(&["--json", "-q"])).unwrap();
    let solution = &document["solutions"][0];
    let adaptive = &solution["results"]["adaptive"];
    assert_eq!(adaptive["reached"], true);
    assert_eq!(adaptive["goal"], 0.02);
    let meshes = adaptive["meshes"].as_array().unwrap();
    let last = meshes.last().unwrap();
    assert_eq!(last["elements"], solution["model"]["elements"]);
    assert_eq!(last["triangles"], solution["model"]["triangles"]);
    assert_eq!(last["dofs"], solution["model"]["dofs"]);
    assert_eq!(last["error"], solution["results"]["error_estimate"]["relative"]);
    let energy = adaptive["quantities"].as_array().unwrap().iter().find(|q| q["quantity"] == "strain_energy");
    let values = energy.unwrap()["values"].as_array().unwrap();
    assert_eq!(values.len(), meshes.len());
    assert_eq!(*values.last().unwrap(), solution["results"]["strain_energy"]);
    let text = run(&[]);
    let lines: Vec<&str> = text.lines().filter(|line| line.contains("sheared")).collect();
    // The case, its meshes, its energy.
    assert_eq!(lines.len(), 1 + meshes.len() + 1, "{text}");
    assert!(text.contains("unknowns") && text.contains("last change (%)"), "{text}");
}
