//! How many of a hundred random, reasonable cases in large rotations end in a stable equilibrium by default settings.
//!
//! `cargo bench --bench robustness --no-default-features -- [FIRST [COUNT]]`: the cases FIRST, FIRST + 1 ...; 1 to 100 without.
//! A case is the same whenever it is asked for. One line each: what it is, how it ended (status and findings), its steps,
//! iterations and attempts that failed, and its largest deflection; then the share that ended in a stable equilibrium.
//!
//! With `refined` after the numbers, each is solved again with twice as many cells along each side, and the line says how far
//! its largest deflection and displacement move; then those that move by more than 5 % although nothing that was found says so.

use std::path::Path;

use kesf::solve::Options;
use kesf::study::{Case, CaseResult, section, solve_case};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Random numbers of one case.
struct Dice(Pcg64Mcg);

impl Dice {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0.random_range(low..high)
    }

    /// Evenly over the decades.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn one_of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.0.random_range(0..words.len())]
    }
}

/// A fabric: bending rigidities from 1e-7 to 1e-4 N·m.
fn fabric(dice: &mut Dice) -> String {
    let (b, e) = (dice.decades(1e-7, 1e-4), dice.decades(300.0, 6000.0));
    format!(
        "[section]\ntensile_warp = \"{e} N/m\"\ntensile_weft = \"{} N/m\"\npoisson = {}\nshear = \"{} N/m\"\n\
         bending_warp = \"{b} N·m\"\nbending_weft = \"{} N·m\"\nbending_coupling = \"0 N·m\"\ntorsion = \"{} N·m\"\n\
         transverse_shear = \"50 N/m\"\nareal_density = \"{} kg/m²\"\nthickness = \"0.4 mm\"\n",
        e * dice.between(0.4, 1.0),
        dice.between(0.0, 0.3),
        dice.between(20.0, 100.0),
        b * dice.between(0.4, 1.0),
        b * dice.between(0.15, 0.5),
        dice.between(0.08, 0.35),
    )
}

fn table(name: &str, keys: &str) -> String {
    format!("[[{name}]]\n{keys}\n")
}

fn clamped(set: &str) -> String {
    table("supports", &format!("set = \"{set}\"\nkind = \"clamped\""))
}

fn prescribed(set: &str, dof: &str, value: &str) -> String {
    table("loads", &format!("kind = \"prescribed\"\nset = \"{set}\"\ndof = \"{dof}\"\nvalue = \"{value}\""))
}

fn weight() -> String {
    table("loads", "kind = \"gravity\"")
}

/// The right edge as a body that is held but for what is prescribed.
fn jaw(held: &str) -> String {
    table("rigid", "name = \"jaw\"\nset = \"right\"")
        + &table("supports", &format!("set = \"jaw\"\nfix = [{held}]"))
}

/// What it is, and the tables of the sheet with `times` as many cells along each side, its supports and its loads.
fn situation(dice: &mut Dice, times: usize) -> (String, String) {
    let length = dice.between(0.05, 0.25);
    let wide = length * dice.between(0.1, 0.3);
    let strip = |width: f64, cells: [usize; 2]| {
        let cells = cells.map(|n| times * n);
        format!(
            "[sheet]\nshape = \"rectangle\"\nwidth = \"{length} m\"\nheight = \"{width} m\"\ncells = {cells:?}\n"
        )
    };
    let (narrow, square) = (strip(wide, [24, 4]), strip(length, [14, 14]));
    match dice.0.random_range(0..8) {
        0 => ("cantilever under its weight".into(), narrow + &clamped("left") + &weight()),
        1 => {
            let kind = dice.one_of(&["clamped", "simply_supported"]);
            let held = table("supports", &format!("set = \"boundary\"\nkind = \"{kind}\""));
            let pressure =
                format!("kind = \"pressure\"\nvalue = \"{} Pa\"\nfollower = true", dice.decades(0.1, 100.0));
            (format!("{kind} square under pressure"), square + &held + &table("loads", &pressure))
        }
        2 => {
            let held = table("supports", "set = \"corners\"\nkind = \"simply_supported_soft\"");
            ("square on its corners under its weight".into(), square + &held + &weight())
        }
        3 => {
            let part = dice.decades(5e-4, 0.4);
            let shortened = prescribed("jaw", "u", &format!("{} m", -part * length));
            let ends = clamped("left") + &jaw("\"v\", \"w\", \"theta_x\", \"theta_y\", \"theta_z\"");
            (format!("clamped strip shortened by {:.2} %", 100.0 * part), narrow + &ends + &shortened)
        }
        4 => {
            let part = dice.decades(5e-4, 0.3);
            let shortened = prescribed("right", "u", &format!("{} m", -part * length));
            let ends = table("supports", "set = \"left\"\nfix = [\"u\", \"v\", \"w\"]")
                + &table("supports", "set = \"right\"\nfix = [\"v\", \"w\"]");
            (
                format!("hinged strip under its weight shortened by {:.2} %", 100.0 * part),
                narrow + &ends + &weight() + &shortened,
            )
        }
        5 => {
            let turn = dice.between(30.0, 330.0);
            let turned = prescribed("jaw", "theta_y", &format!("{} deg", -turn));
            let ends = clamped("left") + &jaw("\"v\", \"theta_x\", \"theta_z\"");
            (format!("strip rolled by {turn:.0} degrees"), narrow + &ends + &turned)
        }
        6 => {
            let angle = dice.between(1.0, 12.0);
            let prescribed = prescribed("jaw", "v", &format!("{} m", angle.to_radians().tan() * length));
            let ends = clamped("left") + &jaw("\"u\", \"w\", \"theta_x\", \"theta_y\", \"theta_z\"");
            (format!("square sheared by {angle:.1} degrees"), square + &ends + &prescribed)
        }
        _ => {
            let turn = dice.between(20.0, 120.0);
            let turned = prescribed("jaw", "theta_x", &format!("{turn} deg"));
            let ends = clamped("left") + &jaw("\"v\", \"w\", \"theta_y\", \"theta_z\"");
            (format!("strip twisted by {turn:.0} degrees"), narrow + &ends + &turned)
        }
    }
}

fn case(number: u64, times: usize) -> (String, Case) {
    let mut dice = Dice(Pcg64Mcg::seed_from_u64(number));
    let fabric = fabric(&mut dice);
    let (what, tables) = situation(&mut dice, times);
    let text = format!("title = \"{what}\"\n{fabric}{tables}[analysis]\nkind = \"nonlinear\"\n");
    let case = Case::parse(Path::new("random.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    (what, case)
}

fn solved(case: &Case) -> Result<CaseResult, String> {
    let own = section(case.section().expect("a section")).expect("stiffnesses");
    solve_case(case, own, &Options::default()).map_err(|e| e.to_string())
}

/// Whether the last equilibrium is stable.
fn is_stable(result: &CaseResult) -> bool {
    let path = result.path.as_ref().expect("a nonlinear case has a path");
    path.converged && path.stability.is_some_and(|s| s.is_stable())
}

fn codes(result: &CaseResult) -> Vec<&str> {
    result.findings.iter().map(|f| f.code()).collect()
}

/// How a case ended.
fn end(result: &CaseResult) -> String {
    let path = result.path.as_ref().expect("a nonlinear case has a path");
    let counts = [path.steps.len(), path.iterations(), path.cut_backs()];
    let ends = if is_stable(result) { "stable" } else { "not stable" };
    format!("{ends} {:?} {counts:?} w_max {:.3} mm", codes(result), 1e3 * result.w_max)
}

/// The largest displacement of a node (m).
fn displacement(result: &CaseResult) -> f64 {
    let nodes = result.solution.displacement.chunks(6);
    nodes.map(|u| u[0].hypot(u[1]).hypot(u[2])).fold(0.0, f64::max)
}

/// How far largest deflection and displacement move from a mesh to a finer one, in parts of the displacement there.
fn change(coarse: &CaseResult, fine: &CaseResult) -> [f64; 2] {
    let size = displacement(fine);
    [coarse.w_max.abs() - fine.w_max.abs(), displacement(coarse) - size].map(|d| d / size)
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let numbers: Vec<u64> = arguments.iter().filter_map(|a| a.parse().ok()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(1), numbers.get(1).copied().unwrap_or(100));
    let refined = arguments.iter().any(|a| a == "refined");
    let (mut stable, mut compared, mut unsaid) = (0, 0, Vec::new());
    for number in first..first + count {
        let (what, coarse) = case(number, 1);
        let result = solved(&coarse);
        println!("{number:>3} {what}: {}", result.as_ref().map_or_else(Clone::clone, end));
        let Ok(result) = result else { continue };
        stable += u64::from(is_stable(&result));
        if !(refined && is_stable(&result)) {
            continue;
        }
        match solved(&case(number, 2).1) {
            Ok(fine) if is_stable(&fine) => {
                let change = change(&result, &fine);
                println!("    twice the cells: {}, moved by {:.2?} %", end(&fine), change.map(|d| 100.0 * d));
                compared += 1;
                if change.iter().any(|d| d.abs() > 0.05) && codes(&result).is_empty() {
                    unsaid.push(number);
                }
            }
            Ok(fine) => println!("    twice the cells: {}", end(&fine)),
            Err(error) => println!("    twice the cells: {error}"),
        }
    }
    println!("{stable} of {count} end in a stable equilibrium");
    if refined {
        println!(
            "{compared} of them with twice the cells as well; moved by more than 5 %, with no finding: {unsaid:?}"
        );
    }
}
