// Reads the exports of a laboratory as they are and says what is in them.
//
//     cargo run --release --example read

use std::error::Error;
use std::path::PathBuf;

use kesf::instrument::{ReadSettings, read_fabrics};

fn main() -> Result<(), Box<dyn Error>> {
    // Semicolons, decimal commas, Windows-1252, Portuguese words: nothing has to be said about it.
    let inputs = [PathBuf::from("kesf_data/satin")];
    let batch = read_fabrics(&inputs, &ReadSettings::default(), &|_| ());
    // A file that cannot be read costs the others nothing.
    for failure in &batch.failures {
        eprintln!("{failure}");
    }
    let satin = batch.fabrics.first().ok_or("no fabric was found")?;
    println!("{} ({} data)", satin.name, satin.info.origin.name());
    for measurement in &satin.measurements {
        let [x_unit, y_unit] = measurement.test.axes();
        let most = measurement.curve.y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        println!(
            "{}: {} points, x in {x_unit}, greatest y {most:.4e} {y_unit}, from {}",
            measurement.record_name(),
            measurement.curve.x.len(),
            measurement.place(),
        );
    }
    Ok(())
}
