//! Abaqus: `*SHELL GENERAL SECTION`.

use std::fmt::Write as _;

use super::card::{Card, CardError, CardInput, Exporter};
use super::text::{number, preamble, set};
use crate::section::ShellSection;

/// `kesf export --to abaqus`.
pub static EXPORTER: Exporter = Exporter {
    name: "abaqus",
    ending: "abaqus.inp",
    title: "*SHELL GENERAL SECTION, *TRANSVERSE SHEAR STIFFNESS: the matrices as they are; SI",
    holds: "D_m, D_b, D_s and mass per area as they are; no friction.",
    write,
};

/// Abaqus, Keywords Guide, `*SHELL GENERAL SECTION`: the symmetric half of the 6 × 6 stiffness by columns, eight
/// numbers a line, of `[N11, N22, N12, M11, M22, M12]` over `[ε11, ε22, γ12, κ11, κ22, κ12]` with the engineering
/// twist `κ12`; DENSITY is mass per area. `*TRANSVERSE SHEAR STIFFNESS`: K11, K22, K12.
fn write(material: &CardInput<'_>, section: &ShellSection) -> Result<Card, CardError> {
    let name = set(material);
    let note = "Turn the local axes of *ORIENTATION to the warp of your part, and give the set its elements.";
    let mut text = preamble(material, "**", &[note.into()]);
    let _ = writeln!(text, "*ORIENTATION, NAME={name}_AXES\n1., 0., 0., 0., 1., 0.\n3, 0.");
    let _ = writeln!(
        text,
        "*SHELL GENERAL SECTION, ELSET={name}, ORIENTATION={name}_AXES, DENSITY={}",
        number(section.areal_density)
    );
    let entry = |row: usize, column: usize| match (row / 3, column / 3) {
        (0, 0) => section.d_m[(row, column)],
        (1, 1) => section.d_b[(row - 3, column - 3)],
        _ => 0.0,
    };
    let half: Vec<String> = (0..6)
        .flat_map(|column| (0..=column).map(move |row| (row, column)))
        .map(|(r, c)| number(entry(r, c)))
        .collect();
    for line in half.chunks(8) {
        let _ = writeln!(text, "{}", line.join(", "));
    }
    let shear = [section.d_s[(0, 0)], section.d_s[(1, 1)], section.d_s[(0, 1)]].map(number);
    let _ = writeln!(text, "*TRANSVERSE SHEAR STIFFNESS\n{}", shear.join(", "));
    Ok(text.into())
}
