// What `kesf run` does, from a program: every fabric, every case, into a folder in memory.
//
//     cargo run --release --example batch

use std::error::Error;

use kesf::RunSettings;
use kesf::results::{Event, Job, MemorySink, Observer};

fn main() -> Result<(), Box<dyn Error>> {
    let inputs = ["kesf_data/poplin", "kesf_data/petrak_m1", "cases/virtual_bending.toml"];
    let job = Job { inputs: inputs.map(Into::into).to_vec(), ..Job::default() };
    let settings = RunSettings { charts: false, ..RunSettings::default() };
    let event = |event: Event<'_>| match event {
        Event::Failed(failure) => eprintln!("{failure}"),
        Event::Found(found) => eprintln!("{}", found.finding),
        _ => (),
    };
    // `kesf::report::OutputFolder` is the same on disk.
    let sink = MemorySink::default();
    let report = kesf::run(&job, &settings, &sink, &Observer { event: &event, cancelled: &|| false })?;
    for row in &report.predictions(&sink)? {
        if let (Some(simulated), Some(measured)) = (row.simulated, row.measured) {
            let (fabric, quantity, unit) = (&row.fabric, &row.quantity, &row.unit);
            println!(
                "{fabric}, {quantity}: simulated {simulated:.4e} {unit}, measured {measured:.4e} {unit}"
            );
        }
    }
    for (name, bytes) in sink.into_files() {
        println!("{name}: {} bytes", bytes.len());
    }
    Ok(())
}
