// From a folder of exports to the matrices of a shell section, with every assumption behind them.
//
//     cargo run --release --example section

use std::error::Error;
use std::path::PathBuf;

use kesf::characterise::{Settings, characterise};
use kesf::constitutive::{Assumptions, Torsion, section};
use kesf::instrument::{Direction, Parameter, ReadSettings, read_fabrics};

fn main() -> Result<(), Box<dyn Error>> {
    let inputs = [PathBuf::from("kesf_data/poplin")];
    let batch = read_fabrics(&inputs, &ReadSettings::default(), &|_| ());
    let fabric = batch.fabrics.first().ok_or("no fabric was found")?;

    let sheet = characterise(fabric, &Settings::default());
    let b = sheet.get(Parameter::B, Some(Direction::Warp)).ok_or("bending was not measured")?;
    println!("B warp = {:.3e} N·m (n = {})", b.mean, b.n);

    // KES measures no torsion: the choice is an assumption, and is written down as one.
    let assumptions = Assumptions { torsion: Torsion::Huber, ..Assumptions::default() };
    let made = section(&sheet, &assumptions)?;
    println!("D_b (N·m) = {:.3e}", made.section.d_b);
    for used in &made.used {
        println!("{}: {} ({})", used.name, used.value, used.source);
    }
    for finding in &made.findings {
        println!("{finding}");
    }
    Ok(())
}
