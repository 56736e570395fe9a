//! How many of a hundred random, reasonable cases in large rotations end in a stable equilibrium by default settings.
//!
//! `cargo bench --bench robustness --no-default-features -- [FIRST [COUNT]]`: the cases FIRST, FIRST + 1 ...; 1 to 100 without.
//! A case is the same whenever it is asked for. One line each: what it is, how it ended (status and findings), its steps,
//! iterations and attempts that failed, and its largest deflection; then the share that ended in a stable equilibrium.

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

/// What it is, and the tables of the sheet, its supports and its loads.
fn situation(dice: &mut Dice) -> (String, String) {
    let length = dice.between(0.05, 0.25);
    let wide = length * dice.between(0.1, 0.3);
    let strip = |width: f64, cells: [usize; 2]| {
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
            let moved = prescribed("jaw", "v", &format!("{} m", angle.to_radians().tan() * length));
            let ends = clamped("left") + &jaw("\"u\", \"w\", \"theta_x\", \"theta_y\", \"theta_z\"");
            (format!("square sheared by {angle:.1} degrees"), square + &ends + &moved)
        }
        _ => {
            let turn = dice.between(20.0, 120.0);
            let turned = prescribed("jaw", "theta_x", &format!("{turn} deg"));
            let ends = clamped("left") + &jaw("\"v\", \"w\", \"theta_y\", \"theta_z\"");
            (format!("strip twisted by {turn:.0} degrees"), narrow + &ends + &turned)
        }
    }
}

fn case(number: u64) -> (String, Case) {
    let mut dice = Dice(Pcg64Mcg::seed_from_u64(number));
    let fabric = fabric(&mut dice);
    let (what, tables) = situation(&mut dice);
    let text = format!("title = \"{what}\"\n{fabric}{tables}[analysis]\nkind = \"nonlinear\"\n");
    let case = Case::parse(Path::new("random.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    (what, case)
}

/// Whether the last equilibrium is stable, and how the case ended.
fn end(result: &CaseResult) -> (bool, String) {
    let path = result.path.as_ref().expect("a nonlinear case has a path");
    let stable = path.converged && path.stability.is_some_and(|s| s.is_stable());
    let codes: Vec<&str> = result.findings.iter().map(|f| f.code()).collect();
    let counts = [path.steps.len(), path.iterations(), path.cut_backs()];
    let ends = if stable { "stable" } else { "not stable" };
    (stable, format!("{ends} {codes:?} {counts:?} w_max {:.3} mm", 1e3 * result.w_max))
}

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(1), numbers.get(1).copied().unwrap_or(100));
    let mut stable = 0;
    for number in first..first + count {
        let (what, case) = case(number);
        let own = section(case.section().expect("a section")).expect("stiffnesses");
        let (well, how) = match solve_case(&case, own, &Options::default()) {
            Ok(result) => end(&result),
            Err(error) => (false, error.to_string()),
        };
        stable += u64::from(well);
        println!("{number:>3} {what}: {how}");
    }
    println!("{stable} of {count} end in a stable equilibrium");
}
