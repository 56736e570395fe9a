//! Cards read back: what another program's file says of a section.
//!
//! The stiffness that a card states is read, not the comments about it. Layers of a laminate are summed up as the
//! program sums them.

use nalgebra::{Matrix2, Matrix3};

use crate::finding::errors;
use crate::instrument::Origin;
use crate::section::{SectionError, ShellSection};

errors! {
    /// Why a card gives no section.
    #[derive(Clone, Debug, PartialEq)]
    pub enum CardReadError {
        from {
            /// The section is none.
            Section(SectionError),
        }
        /// O045: a keyword or its values are missing, or a field is no number.
        "O045" Syntax {
            /// Line, from 1.
            line: usize,
            /// What stands there.
            found: String,
            /// What should.
            expected: &'static str,
        } = "line {line}: {found}, where {expected} was expected";
    }
}

/// Lines of a card with their numbers, without comments.
type Lines<'a> = Vec<(usize, &'a str)>;

fn lines<'a>(text: &'a str, comment: &str) -> Lines<'a> {
    let numbered = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim_end()));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with(comment)).collect()
}

fn syntax(line: usize, found: impl Into<String>, expected: &'static str) -> CardReadError {
    CardReadError::Syntax { line, found: found.into(), expected }
}

fn real((line, field): (usize, &str), expected: &'static str) -> Result<f64, CardReadError> {
    let value = field.trim().parse().ok().filter(|v: &f64| v.is_finite());
    value.ok_or_else(|| syntax(line, format!("`{}`", field.trim()), expected))
}

/// The values of a line between commas.
fn values((line, text): (usize, &str), expected: &'static str) -> Result<Vec<f64>, CardReadError> {
    text.split(',').map(|field| real((line, field), expected)).collect()
}

/// The place of the line that begins with a keyword (any letter case).
fn keyword(lines: &Lines<'_>, name: &'static str) -> Result<usize, CardReadError> {
    let starts = |line: &str| line.get(..name.len()).is_some_and(|head| head.eq_ignore_ascii_case(name));
    let at = lines.iter().position(|(_, line)| starts(line));
    at.ok_or_else(|| syntax(lines.last().map_or(1, |l| l.0), "the end of the card", name))
}

/// The text of a parameter of a keyword line, such as `DENSITY=0.118`.
fn stated<'t>(text: &'t str, name: &str) -> Option<&'t str> {
    text.split(',').find_map(|part| {
        let (key, value) = part.split_once('=')?;
        key.trim().eq_ignore_ascii_case(name).then_some(value.trim())
    })
}

fn parameter((line, text): (usize, &str), name: &'static str) -> Result<f64, CardReadError> {
    real((line, stated(text, name).unwrap_or_default()), name)
}

/// Refuses what moves the reference surface, and a second section: which of them was meant is not said.
fn the_only_section(lines: &Lines<'_>, at: usize) -> Result<(), CardReadError> {
    let is_section = |line: &str| {
        let head = line.to_ascii_uppercase();
        head.starts_with("*SHELL SECTION") || head.starts_with("*SHELL GENERAL SECTION")
    };
    if let Some((line, _)) = lines.iter().skip(at + 1).find(|(_, line)| is_section(line)) {
        return Err(syntax(*line, "a second shell section", "one shell section a file"));
    }
    let (line, text) = lines[at];
    match stated(text, "OFFSET") {
        Some(offset) if offset.parse() != Ok(0.0) => {
            Err(syntax(line, format!("OFFSET={offset}"), "no offset of the reference surface"))
        }
        _ => Ok(()),
    }
}

/// A section that a card states.
#[derive(Clone, Debug, PartialEq)]
pub struct StatedSection {
    /// The keyword that states it.
    pub keyword: &'static str,
    /// The section.
    pub section: ShellSection,
    /// Whether the thickness is the card's; the one that was given otherwise.
    pub has_thickness: bool,
    /// Where the data come from, of a card of this program.
    pub origin: Option<Origin>,
}

/// The section that an input file of Abaqus or CalculiX states, by its first keyword of a shell section; `None` if it has
/// none. `thickness` (m) is taken where the card states none.
///
/// # Errors
/// See [`CardReadError`].
pub fn section_in(text: &str, thickness: f64) -> Option<Result<StatedSection, CardReadError>> {
    const GENERAL: &str = "*SHELL GENERAL SECTION";
    const LAYERS: &str = "*SHELL SECTION, COMPOSITE";
    let lines = lines(text, "**");
    let stated = |keyword, at: usize, section: Result<ShellSection, _>, has_thickness| {
        let section = section?;
        match super::beyond_cards(&section) {
            Some(value) => {
                let found = format!("a stiffness, mass or thickness of {value:e} (SI)");
                Err(syntax(lines[at].0, found, "a section of numbers from 1e-30 to 1e30"))
            }
            None => Ok(StatedSection { keyword, section, has_thickness, origin: origin(text) }),
        }
    };
    if let Ok(at) = keyword(&lines, GENERAL) {
        Some(stated(GENERAL, at, abaqus(text, thickness), false))
    } else if let Ok(at) = keyword(&lines, "*SHELL SECTION") {
        Some(stated(LAYERS, at, calculix(text), true))
    } else {
        None
    }
}

/// What a card of this program says of its data in the comment at its head.
fn origin(text: &str) -> Option<Origin> {
    let head = text.lines().next().unwrap_or_default();
    let says = |origin: &Origin| head.contains(&format!("({} data), by kesf", origin.name()));
    [Origin::Measured, Origin::Published, Origin::Synthetic].into_iter().find(says)
}

/// An Abaqus `*SHELL GENERAL SECTION` with `*TRANSVERSE SHEAR STIFFNESS`. Abaqus knows no thickness of such a section: it is
/// `thickness` (m). A coupling of stretching and bending is refused, as a section has none.
///
/// # Errors
/// See [`CardReadError`].
pub fn abaqus(text: &str, thickness: f64) -> Result<ShellSection, CardReadError> {
    let lines = lines(text, "**");
    let at = keyword(&lines, "*SHELL GENERAL SECTION")?;
    the_only_section(&lines, at)?;
    let areal_density = parameter(lines[at], "DENSITY")?;
    let mut half = Vec::new();
    for line in lines.iter().skip(at + 1).take_while(|(_, l)| !l.starts_with('*')) {
        half.extend(values(*line, "a stiffness")?.into_iter().map(|v| (line.0, v)));
    }
    if half.len() != 21 {
        return Err(syntax(lines[at].0, format!("{} stiffnesses", half.len()), "21 stiffnesses"));
    }
    let (mut d_m, mut d_b) = (Matrix3::zeros(), Matrix3::zeros());
    let places = (0..6).flat_map(|column| (0..=column).map(move |row| (row, column)));
    for ((row, column), (line, value)) in places.zip(half) {
        match (row / 3, column / 3) {
            (0, 0) => (d_m[(row, column)], d_m[(column, row)]) = (value, value),
            (1, 1) => {
                let (r, c) = (row - 3, column - 3);
                (d_b[(r, c)], d_b[(c, r)]) = (value, value);
            }
            _ if value != 0.0 => {
                return Err(syntax(line, format!("a coupling of {value:e} N"), "no coupling"));
            }
            _ => {}
        }
    }
    let at = keyword(&lines, "*TRANSVERSE SHEAR STIFFNESS")?;
    let expected = "K11, K22, K12";
    let line = *lines.get(at + 1).ok_or_else(|| syntax(lines[at].0, "the end of the card", expected))?;
    let [k11, k22, k12] = values(line, expected)?[..] else {
        return Err(syntax(line.0, format!("`{}`", line.1), expected));
    };
    let d_s = Matrix2::new(k11, k12, k12, k22);
    Ok(ShellSection { d_m, d_b, d_s, areal_density, thickness }.checked()?)
}

/// Coupling of stretching and bending, over the root of both stiffnesses, that the digits of a card may leave.
const LARGEST_COUPLING: f64 = 1e-6;

/// A CalculiX `*SHELL SECTION, COMPOSITE` of layers along the warp: their sums are D_m, D_b and the mass per area.
/// The thickness is that of the laminate. Layers that couple stretching with bending are refused, as a section has no coupling.
///
/// # Errors
/// See [`CardReadError`].
pub fn calculix(text: &str) -> Result<ShellSection, CardReadError> {
    let lines = lines(text, "**");
    let at = keyword(&lines, "*SHELL SECTION")?;
    the_only_section(&lines, at)?;
    let mut layers = Vec::new();
    for (line, layer) in lines.iter().skip(at + 1).take_while(|(_, l)| !l.starts_with('*')) {
        let fields: Vec<&str> = layer.split(',').map(str::trim).collect();
        let [thickness, "", name] = fields[..] else {
            return Err(syntax(*line, format!("`{layer}`"), "thickness, , material"));
        };
        layers.push((real((*line, thickness), "a thickness")?, material(&lines, *line, name)?));
    }
    let whole: f64 = layers.iter().map(|l| l.0).sum();
    let (mut d_m, mut d_b, mut d_s) = (Matrix3::zeros(), Matrix3::zeros(), Matrix2::zeros());
    let (mut areal_density, mut below, mut coupling) = (0.0, -0.5 * whole, Matrix3::zeros());
    for (thickness, (q, shear, density)) in layers {
        let above = below + thickness;
        d_m += q * thickness;
        d_b += q * ((above.powi(3) - below.powi(3)) / 3.0);
        coupling += q * (0.5 * (above * above - below * below));
        d_s += shear * thickness;
        areal_density += density * thickness;
        below = above;
    }
    if coupling.amax() > LARGEST_COUPLING * (d_m.amax() * d_b.amax()).sqrt() {
        let found = format!("layers with a coupling of {:e} N", coupling.amax());
        return Err(syntax(lines[at].0, found, "layers that are the same on both sides"));
    }
    Ok(ShellSection { d_m, d_b, d_s, areal_density, thickness: whole }.checked()?)
}

/// Reduced stiffness, transverse shear moduli (Pa) and density of a `*MATERIAL` with engineering constants.
fn material(
    lines: &Lines<'_>,
    from: usize,
    name: &str,
) -> Result<(Matrix3<f64>, Matrix2<f64>, f64), CardReadError> {
    let wanted = format!("*MATERIAL, NAME={name}");
    let at = lines.iter().position(|(_, line)| line.eq_ignore_ascii_case(&wanted));
    let at = at.ok_or_else(|| syntax(from, format!("the material {name}"), "a material of the card"))?;
    let block: Lines<'_> = lines[at + 1..]
        .iter()
        .copied()
        .take_while(|(_, l)| !l.starts_with("*MATERIAL") && !l.starts_with("*SHELL"))
        .collect();
    let expected = "nine engineering constants";
    let elastic = keyword(&block, "*ELASTIC")?;
    let (line, text) = block[elastic];
    if !stated(text, "TYPE").is_some_and(|kind| kind.eq_ignore_ascii_case("ENGINEERING CONSTANTS")) {
        return Err(syntax(line, format!("`{text}`"), "*ELASTIC, TYPE=ENGINEERING CONSTANTS"));
    }
    let mut constants = Vec::new();
    for line in block.iter().skip(elastic + 1).take_while(|(_, l)| !l.starts_with('*')) {
        constants.extend(values(*line, expected)?);
    }
    let [e1, e2, _, nu12, _, _, g12, g13, g23] = constants[..] else {
        return Err(syntax(block[elastic].0, format!("{} constants", constants.len()), expected));
    };
    let at = keyword(&block, "*DENSITY")?;
    let line = *block.get(at + 1).ok_or_else(|| syntax(block[at].0, "the end of the card", "a density"))?;
    let density = real(line, "a density")?;
    let free = 1.0 - nu12 * nu12 * e2 / e1;
    let [q11, q22, q12] = [e1 / free, e2 / free, nu12 * e2 / free];
    let q = Matrix3::new(q11, q12, 0.0, q12, q22, 0.0, 0.0, 0.0, g12);
    Ok((q, Matrix2::new(g13, 0.0, 0.0, g23), density))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{section, written};
    use super::*;
    use approx::assert_relative_eq;

    fn same(found: &ShellSection, section: &ShellSection) {
        assert_relative_eq!(found.d_m, section.d_m, max_relative = 1e-8, epsilon = 1e-6);
        assert_relative_eq!(found.d_b, section.d_b, max_relative = 1e-8, epsilon = 1e-14);
        assert_relative_eq!(found.areal_density, section.areal_density, max_relative = 1e-8);
    }

    #[test]
    fn cards_say_the_section_that_they_were_written_of() {
        let section = section();
        let found = abaqus(&written("abaqus", section.clone()).unwrap(), section.thickness).unwrap();
        same(&found, &section);
        assert_relative_eq!(found.d_s, section.d_s, max_relative = 1e-8);
        let found = calculix(&written("calculix", section.clone()).unwrap()).unwrap();
        same(&found, &section);
        assert_relative_eq!(found.d_s, section.d_s, max_relative = 1e-8);
    }

    /// A field that is exchanged, slipped by a unit or doubled in the text of a card is another section.
    #[test]
    fn a_changed_field_is_another_section() {
        let section = section();
        let card = written("abaqus", section.clone()).unwrap();
        let d11 = super::super::text::number(section.d_b[(0, 0)]);
        for other in [section.d_b[(1, 1)], 1e3 * section.d_b[(0, 0)], 2.0 * section.d_b[(0, 0)]] {
            let changed = card.replacen(&d11, &super::super::text::number(other), 1);
            assert_ne!(changed, card);
            let found = abaqus(&changed, section.thickness).unwrap();
            assert!((found.d_b[(0, 0)] / section.d_b[(0, 0)] - 1.0).abs() > 0.1);
        }
    }

    /// Decks of others that look alike: nothing of what they say is passed over.
    #[test]
    fn what_a_section_cannot_hold_is_refused() {
        let card = written("calculix", section()).unwrap();
        let at = card.lines().position(|l| l.starts_with("*SHELL SECTION")).unwrap();
        let without_the_last_layer: String =
            card.lines().enumerate().filter(|(i, _)| *i != at + 3).map(|(_, l)| format!("{l}\n")).collect();
        let second = format!("{card}*SHELL SECTION, COMPOSITE, ELSET=OTHER\n");
        let cases = [
            (without_the_last_layer, "coupling"),
            (card.replace("TYPE=ENGINEERING CONSTANTS", "TYPE=ORTHO"), "TYPE=ORTHO"),
            (card.replacen("COMPOSITE,", "COMPOSITE, OFFSET=0.5,", 1), "OFFSET=0.5"),
            (second, "a second shell section"),
        ];
        for (text, said) in cases {
            assert_ne!(text, card, "{said}");
            let error = calculix(&text).unwrap_err().to_string();
            assert!(error.starts_with("O045") && error.contains(said), "{said}: {error}");
        }
        assert!(calculix(&card.replacen("COMPOSITE,", "COMPOSITE, OFFSET=0.,", 1)).is_ok());

        // A section that no card could hold, of fields that are numbers.
        let abaqus = written("abaqus", section()).unwrap();
        let first = super::super::text::number(section().d_m[(0, 0)]);
        let error = section_in(&abaqus.replacen(&first, "1e49", 1), 4e-4).unwrap().unwrap_err().to_string();
        assert!(error.starts_with("O045") && error.contains("1e49"), "{error}");
    }

    #[test]
    fn what_is_no_card_is_refused_with_its_line() {
        let card = written("abaqus", section()).unwrap();
        let line = card.lines().position(|l| l.starts_with("*SHELL")).unwrap() + 2;
        let broken = card.replacen("6.000000000E3", "six", 1);
        let error = abaqus(&broken, 4e-4).unwrap_err().to_string();
        assert!(error.starts_with(&format!("O045 line {line}: `six`")), "{error}");
        let cut: String = card.lines().take(line).map(|l| format!("{l}\n")).collect();
        assert!(abaqus(&cut, 4e-4).unwrap_err().to_string().contains("8 stiffnesses"));
        assert!(calculix("").is_err() && abaqus("*SHELL GENERAL SECTION\n", 4e-4).is_err());
        let coupled = card.replacen("0.000000000E0", "1.000000000E0", 1);
        assert!(abaqus(&coupled, 4e-4).is_err() || coupled != card);
    }
}
