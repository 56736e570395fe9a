//! Load factors.

use std::f64::consts::PI;
use std::path::Path;

use kesf::study::{Case, Status};
use nalgebra::{DMatrix, SymmetricEigen};

use super::{NONLINEAR, Strip, fix, of_step, pull, solved, step};

const BUCKLING: &str = "[analysis]\nkind = \"buckling\"\nfactors = 3\n";
const OF_STEP: &str = "[steps.analysis]\nkind = \"buckling\"\nfactors = 3\n";

/// `of_case` is the load of a case without steps.
fn of_case(load: String) -> String {
    load.replace("[[steps.loads]]", "[[loads]]")
}

/// π²D/L² times 1, 1/4, 4 and 2.0457 (tan kL = kL), and the higher ones.
#[test]
fn columns_buckle_at_eulers_loads() {
    let (length, bending) = (0.2, 8e-6);
    let unit = PI * PI * bending / (length * length);
    let (fourth, first) = (4.493409457909064f64, 7.725251836937707f64);
    let ends: [(&[&str], &[&str], [f64; 2]); 4] = [
        (&["u", "w"], &["w"], [1.0, 4.0]),
        (&["u", "w", "theta_y"], &[], [0.25, 2.25]),
        (&["u", "w", "theta_y"], &["w", "theta_y"], [4.0, 8.9868678]),
        (&["u", "w", "theta_y"], &["w"], [(fourth / PI).powi(2), (first / PI).powi(2)]),
    ];
    // The second of the clamped column: tan(kL/2) = kL/2, kL = 2 x 4.4934.
    let second = (2.0 * fourth / PI).powi(2);
    for (left, right, mut exact) in ends {
        if exact[0] == 4.0 {
            exact[1] = second;
        }
        let errors = |cells: usize| -> Vec<f64> {
            let column = Strip { membrane: 6e5, bending, length, cells };
            let right = if right.is_empty() { String::new() } else { fix("right", right) };
            let case = [fix("left", left), right, of_case(pull(-1.0)), BUCKLING.into()];
            let result = column.solved(&case.concat());
            assert!(result.is_modal() && result.modes.len() == 3 && result.frequencies.is_empty());
            let factors = result.load_factors.iter().zip(exact);
            factors.map(|(factor, exact)| factor / (exact * unit) - 1.0).collect()
        };
        let (coarse, fine) = (errors(20), errors(40));
        println!("{exact:?}: {coarse:?} {fine:?}");
        for (coarse, fine) in coarse.iter().zip(&fine) {
            // Of the shear that the column has: π²D/(L² S) = 2e-6.
            assert!(((4.0 * fine - coarse) / 3.0).abs() < 5e-4, "{exact:?}: {coarse:e} {fine:e}");
            assert!(fine.abs() < 0.01, "{exact:?}: {coarse:e} {fine:e}");
        }
    }
}

/// A rectangle on simple (hard) supports with its stresses in the plane: D = 1 N·m.
struct Plate {
    width: f64,
    bending: [f64; 4],
    cells: [usize; 2],
}

impl Plate {
    fn factors(&self, loads: &str) -> Vec<f64> {
        let Self { width, bending: [b1, b2, b12, h], cells } = self;
        let text = format!(
            r#"title = "plate"
[section]
tensile_warp = "1e6 N/m"
tensile_weft = "1e6 N/m"
poisson = 0.3
shear = "4e5 N/m"
bending_warp = "{b1} N·m"
bending_weft = "{b2} N·m"
bending_coupling = "{b12} N·m"
torsion = "{h} N·m"
transverse_shear = "1e7 N/m"
areal_density = "1 kg/m²"
thickness = "1 mm"
[sheet]
shape = "rectangle"
width = "{width} m"
height = "1 m"
cells = {cells:?}
[[supports]]
set = "left"
fix = ["v", "w", "theta_x"]
[[supports]]
set = "right"
fix = ["v", "w", "theta_x"]
[[supports]]
set = "bottom"
fix = ["u", "w", "theta_y"]
[[supports]]
set = "top"
fix = ["w", "theta_y"]
{loads}{BUCKLING}"#
        );
        solved(&Case::parse(Path::new("plate.toml"), &text).unwrap_or_else(|e| panic!("{e}"))).load_factors
    }
}

fn edge(set: &str, direction: [i32; 3]) -> String {
    format!(
        "[[loads]]\nkind = \"edge_force\"\nset = \"{set}\"\nvalue = \"1 N/m\"\ndirection = {direction:?}\n"
    )
}

/// Compressed along x: N = π² [D1 (m/a)² + 2 (D12 + 2 H) + D2 (a/m)²] on a breadth of 1.
#[test]
fn compressed_plates_buckle_at_the_closed_form() {
    let square = Plate { width: 1.0, bending: [1.0, 1.0, 0.3, 0.35], cells: [0, 0] };
    let long = Plate { width: 1.5, bending: [4.0, 1.0, 0.1, 0.3], cells: [0, 0] };
    for (plate, cells) in [(square, [8, 8]), (long, [12, 8])] {
        let [b1, b2, b12, h] = plate.bending;
        let critical_load = |m: i32| {
            let k = f64::from(m) / plate.width;
            PI * PI * (b1 * k * k + 2.0 * (b12 + 2.0 * h) + b2 / (k * k))
        };
        let mut exact: Vec<f64> = (1..6).map(critical_load).collect();
        exact.sort_by(f64::total_cmp);
        let errors = |times: usize| -> Vec<f64> {
            let plate = Plate { cells: cells.map(|n| times * n), ..plate };
            // The bottom edge may not slide along x here: its supports are those of the other load.
            let found = plate.compressed();
            found.iter().zip(&exact).map(|(found, exact)| found / exact - 1.0).collect()
        };
        let (coarse, fine) = (errors(2), errors(4));
        println!("{:?}: {exact:?} {coarse:?} {fine:?}", plate.bending);
        for (coarse, fine) in coarse.iter().zip(&fine).take(2) {
            assert!(fine.abs() < 0.02 && fine.abs() < 0.35 * coarse.abs(), "{coarse:e} {fine:e}");
            assert!(((4.0 * fine - coarse) / 3.0).abs() < 2e-3, "{coarse:e} {fine:e}");
        }
    }
}

impl Plate {
    /// Load factors of a compression along x whose edges slide freely.
    fn compressed(&self) -> Vec<f64> {
        let Self { width, bending: [b1, b2, b12, h], cells } = self;
        let text = format!(
            r#"title = "plate"
[section]
tensile_warp = "1e6 N/m"
tensile_weft = "1e6 N/m"
poisson = 0.3
shear = "4e5 N/m"
bending_warp = "{b1} N·m"
bending_weft = "{b2} N·m"
bending_coupling = "{b12} N·m"
torsion = "{h} N·m"
transverse_shear = "1e7 N/m"
areal_density = "1 kg/m²"
thickness = "1 mm"
[sheet]
shape = "rectangle"
width = "{width} m"
height = "1 m"
cells = {cells:?}
[[supports]]
set = "left"
fix = ["u", "w", "theta_x"]
[[supports]]
set = "right"
fix = ["w", "theta_x"]
[[supports]]
set = "bottom"
fix = ["v", "w", "theta_y"]
[[supports]]
set = "top"
fix = ["w", "theta_y"]
{}{BUCKLING}"#,
            edge("right", [-1, 0, 0])
        );
        solved(&Case::parse(Path::new("plate.toml"), &text).unwrap_or_else(|e| panic!("{e}"))).load_factors
    }
}

/// Load factor of a simply supported square of D = 1 and side 1 in shear, over π², by a double sine series of so many waves.
fn shear_by_ritz(waves: i32) -> f64 {
    let shapes: Vec<[i32; 2]> = (1..=waves)
        .flat_map(|m| (1..=waves).map(move |n| [m, n]))
        .filter(|[m, n]| (m + n) % 2 == 0)
        .collect();
    // ∫ cos(aπx) sin(bπx) dx, where a + b is odd.
    let mixed = |a: i32, b: i32| 2.0 * f64::from(b) / (PI * f64::from(b * b - a * a));
    let stiffness = |[m, n]: [i32; 2]| PI.powi(4) / 4.0 * f64::from(m * m + n * n).powi(2);
    let sheared = |[m, n]: [i32; 2], [p, q]: [i32; 2]| {
        if (m + p) % 2 == 0 || (n + q) % 2 == 0 {
            return 0.0;
        }
        let one = f64::from(m * q) * mixed(m, p) * mixed(q, n);
        let other = f64::from(p * n) * mixed(p, m) * mixed(n, q);
        PI * PI * (one + other)
    };
    let matrix = DMatrix::from_fn(shapes.len(), shapes.len(), |i, j| {
        sheared(shapes[i], shapes[j]) / (stiffness(shapes[i]) * stiffness(shapes[j])).sqrt()
    });
    1.0 / SymmetricEigen::new(matrix).eigenvalues.max() / (PI * PI)
}

/// Either sign of shear buckles a plate alike: k = 9.34 (Timoshenko and Gere, Table 9-10), 9.32 by more terms.
#[test]
fn a_sheared_plate_buckles_both_ways() {
    let series = shear_by_ritz(16);
    println!("series {series}, {}", shear_by_ritz(10));
    assert!((series / 9.34 - 1.0).abs() < 3e-3, "{series}");
    // Shear flow: the other three edges are held.
    let loads = edge("top", [1, 0, 0]);
    let errors = |n: usize| {
        let plate = Plate { width: 1.0, bending: [1.0, 1.0, 0.3, 0.35], cells: [n, n] };
        let found = plate.factors(&loads);
        assert!((found[0] / found[1] + 1.0).abs() < 1e-6, "{found:?}");
        found[0].abs() / (PI * PI) / series - 1.0
    };
    let (coarse, fine) = (errors(16), errors(32));
    println!("{coarse:.2e} {fine:.2e}");
    assert!(fine.abs() < 0.01 && fine.abs() < 0.4 * coarse.abs(), "{coarse:e} {fine:e}");
    assert!(((4.0 * fine - coarse) / 3.0).abs() < 2e-3, "{coarse:e} {fine:e}");
}

/// A column that is held taut has its tension to lose first; one that is pushed already has less to go.
#[test]
fn steps_before_count() {
    let (length, bending) = (0.2, 8e-6);
    let euler = PI * PI * bending / (length * length);
    let column = Strip { membrane: 600.0, bending, length, cells: 40 };
    let case = [
        fix("left", &["u", "w"]),
        fix("right", &["w"]),
        NONLINEAR.into(),
        step("tension", &pull(0.01)),
        step("taut", &format!("{OF_STEP}{}", pull(-0.001))),
        step("push", &pull(-0.5 * euler)),
        step("pushed", &format!("{OF_STEP}{}", pull(-0.001))),
        step("turned round", &format!("{OF_STEP}{}", pull(0.001))),
    ];
    let result = column.solved(&case.concat());
    assert_eq!(result.status, Status::Ok, "{:?}", result.findings);
    let factor = |name: &str| 1e-3 * of_step(&result, name).load_factors[0];
    println!(
        "{} {} {}",
        factor("taut") / (euler + 0.01),
        factor("pushed") / euler,
        factor("turned round") / euler
    );
    assert!((factor("taut") / (euler + 0.01) - 1.0).abs() < 2e-3);
    assert!((factor("pushed") / (0.5 * euler) - 1.0).abs() < 4e-3);
    assert!((factor("turned round") / factor("pushed") + 1.0).abs() < 1e-6);
    let codes: Vec<&str> = result.findings.iter().map(|f| f.code()).collect();
    assert_eq!(codes, ["S143"]);
}

/// A strip that is held by its tension has its factors close together: π²D n²/L² above it, one after the other.
#[test]
fn a_taut_strip_goes_slack_in_all_its_shapes() {
    let (length, bending, tension) = (0.3, 8e-6, 2.0);
    let strip = Strip { membrane: 4000.0, bending, length, cells: 60 };
    let case = [
        fix("left", &["u", "w"]),
        fix("right", &["w"]),
        NONLINEAR.into(),
        step("pull", &pull(tension)),
        step("push", &format!("{OF_STEP}{}", pull(-1.0))),
    ];
    let result = strip.solved(&case.concat());
    for (k, factor) in of_step(&result, "push").load_factors.iter().enumerate() {
        let wave = (k + 1) as f64 * PI / length;
        let euler = bending * wave * wave;
        println!("{factor} {}", tension + euler);
        assert!(((factor - tension) / euler - 1.0).abs() < 0.05, "{factor} {euler}");
    }
}

/// An end that is moved: the strain at which the column buckles is Euler's load over its stiffness.
#[test]
fn an_end_that_is_moved_buckles_a_column_too() {
    let (length, bending, membrane) = (0.2, 8e-6, 6e5);
    let euler = PI * PI * bending / (length * length);
    let column = Strip { membrane, bending, length, cells: 40 };
    let prescribed = "[[loads]]\nkind = \"prescribed\"\nset = \"right\"\ndof = \"u\"\nvalue = \"-1e-9 m\"\n";
    let case = [fix("left", &["u", "w"]), fix("right", &["w"]), prescribed.into(), BUCKLING.into()];
    let found = 1e-9 * column.solved(&case.concat()).load_factors[0];
    let exact = euler / membrane * length;
    assert!((found / exact - 1.0).abs() < 2e-3, "{found} {exact}");
}

/// What cannot buckle says so, and what has buckled already is refused.
#[test]
fn what_has_no_load_factor_is_told() {
    let column = Strip { membrane: 6e5, bending: 8e-6, length: 0.2, cells: 10 };
    let ends = [fix("left", &["u", "w", "theta_y"])].concat();
    let across = "[[loads]]\nkind = \"pressure\"\nvalue = \"1 Pa\"\n";
    let result = column.solved(&format!("{ends}{across}{BUCKLING}"));
    println!("{:?}", result.load_factors);
    assert!(result.load_factors.is_empty());
    assert!(result.findings.iter().any(|f| f.code() == "S142"), "{:?}", result.findings);
    let free = column.parsed(&format!("{}{}{BUCKLING}", fix("left", &["u"]), of_case(pull(-1.0)))).unwrap();
    let section = kesf::study::section(free.section().unwrap()).unwrap();
    let error = kesf::study::solve_case(&free, section, &Default::default()).unwrap_err();
    assert!(["N001", "N006"].contains(&error.code()), "{error}");
}
