//! `kesf drape-image`: pictures of a drape test to coefficients and folds.

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::ui::Ui;
use crate::characterise::drape::{DrapeMethod, DrapeSetup};
use crate::report::OutputFolder;
use crate::results::{Failure, Sink, drape_pictures};

/// Measure drape coefficient, folds and outline in photos or silhouettes of a Cusick test seen from above
#[derive(Debug, Args)]
#[command(after_help = "Example: kesf drape-image photos/poplin --method \"ISO 9073-9, 30 cm\" -o drape\n\
    The scale is that of the support disc where it is seen within the sheet, else that of --pixels-per-cm.")]
pub struct Options {
    /// PNG or JPEG files, or folders of them; the name of their folder is that of the test
    #[arg(value_name = "PHOTO", required = true)]
    photos: Vec<PathBuf>,
    /// Pixels in a centimetre, at the height of the rim of the sheet [default: from the disc that is seen]
    #[arg(long, value_name = "NUMBER", value_parser = positive)]
    pixels_per_cm: Option<f64>,
    /// Words that state the sizes, such as "JIS L 1096" or "24 cm on 18 cm" [default: 30 cm on 18 cm, assumed]
    #[arg(long, value_name = "TEXT", conflicts_with_all = ["disc", "sheet"])]
    method: Option<String>,
    /// Diameter of the support disc in cm
    #[arg(long, value_name = "CM", value_parser = positive, requires = "sheet")]
    disc: Option<f64>,
    /// Diameter of the flat sheet in cm
    #[arg(long, value_name = "CM", value_parser = positive, requires = "disc")]
    sheet: Option<f64>,
    /// Write the outline drawn over each picture, and drape.toml with the measured results, into this folder
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Overwrite files in that folder that this tool did not write
    #[arg(long)]
    force: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches("cm").trim().parse::<f64>();
    number.ok().filter(|n| n.is_finite() && *n > 0.0).ok_or_else(|| "a number above zero".into())
}

pub fn run(options: &Options, ui: &Ui) -> Result<Exit, Failure> {
    let setup = setup(options)?;
    let folder = options.output.as_ref().map(|path| OutputFolder::open(path, options.force)).transpose()?;
    let sink = folder.as_ref().map(|folder| folder as &dyn Sink);
    let found = ui.observe(|observer| drape_pictures(&options.photos, &setup, sink, observer))?;
    folder.map(OutputFolder::finish).transpose()?;
    if ui.json {
        ui.document(&found.document)?;
    } else if !found.document.captures.is_empty() {
        ui.print(&found.text())?;
    }
    Ok(Exit::of_batch(found.document.captures.len(), &found.failures))
}

fn setup(options: &Options) -> Result<DrapeSetup, Failure> {
    let method = match (&options.method, options.disc.zip(options.sheet)) {
        (Some(words), _) => DrapeMethod::read(words),
        (None, Some((disc, sheet))) => DrapeMethod::hanging(0.01 * disc, 0.01 * sheet).ok_or_else(|| {
            Failure::new("O050", format!("a sheet of {sheet} cm does not hang over a disc of {disc} cm"))
                .hint("--disc is the smaller diameter; both are in cm, from 5 to 100")
        })?,
        (None, None) => DrapeMethod::default(),
    };
    Ok(DrapeSetup { method, pixels_per_metre: options.pixels_per_cm.map(|n| 100.0 * n) })
}
