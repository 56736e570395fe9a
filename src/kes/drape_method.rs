//! The sizes of a drape test, from the words in which a source states its method.

use serde::{Deserialize, Serialize};

/// Disc and sheet of a Cusick drape test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DrapeMethod {
    /// Diameter of the support disc (m).
    pub disc: f64,
    /// Diameter of the flat sheet (m).
    pub sheet: f64,
    /// Whether a size was not stated, but assumed.
    pub assumed: bool,
}

/// Sheets (m) of BS 5058 and ISO 9073-9 on a disc of 18 cm, the usual one first.
pub const CUSICK: [f64; 3] = [0.30, 0.24, 0.36];
/// Disc of them (m).
pub const CUSICK_DISC: f64 = 0.18;
/// Sheet and disc of JIS L 1096 (m).
pub const JIS: [f64; 2] = [0.254, 0.127];

/// Sizes that can be those of a drape test (m).
const POSSIBLE: [f64; 2] = [0.05, 1.0];

impl Default for DrapeMethod {
    /// The usual one, assumed: 30 cm on 18 cm.
    fn default() -> Self {
        Self { disc: CUSICK_DISC, sheet: CUSICK[0], assumed: true }
    }
}

impl DrapeMethod {
    /// Sizes that are known.
    pub fn stated(disc: f64, sheet: f64) -> Self {
        Self { disc, sheet, assumed: false }
    }

    /// Sizes that the words of a source state: `Cusick drape, 30 cm specimen on an 18 cm disc`, `24/18 cm`, `JIS L 1096`.
    ///
    /// A sheet alone has the disc of its standard. The standards with several sheets, and words without a size, are
    /// taken as 30 cm on 18 cm, assumed; so is what the words call assumed.
    pub fn read(method: &str) -> Self {
        let words = method.to_lowercase();
        let says = |word: &str| words.contains(word);
        let sizes = lengths(&words);
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let smallest = sizes.iter().copied().fold(f64::INFINITY, f64::min);
        let near = |a: f64, b: f64| (a - b).abs() < 5e-4;
        let is_jis = says("jis") || says("l 1096") || says("l1096");
        let found = match sizes.len() {
            0 if is_jis => Self::stated(JIS[1], JIS[0]),
            0 => Self::default(),
            _ if largest - smallest > 1e-3 => Self::stated(smallest, largest),
            _ if near(largest, JIS[0]) => Self::stated(JIS[1], JIS[0]),
            _ if CUSICK.iter().any(|sheet| near(*sheet, largest)) => Self::stated(CUSICK_DISC, largest),
            _ => Self::default(),
        };
        Self { assumed: found.assumed || says("assumed"), ..found }
    }

    /// The drape coefficient (0 to 1) of a shadow of this area (m²): (shadow - disc) / (sheet - disc), as BS 5058, ISO 9073-9
    /// and JIS L 1096 define it.
    pub fn coefficient(&self, shadow: f64) -> f64 {
        let [disc, sheet] = [self.disc, self.sheet].map(|d| 0.25 * std::f64::consts::PI * d * d);
        (shadow - disc) / (sheet - disc)
    }

    /// Whether a sheet of another size than this method's was hung.
    pub fn differs(&self, disc: f64, sheet: f64) -> bool {
        (self.disc - disc).abs() > 5e-4 || (self.sheet - sheet).abs() > 5e-4
    }

    /// `30 cm sheet on an 18 cm disc`, and whether it is assumed.
    pub fn text(&self) -> String {
        let centimetres = |size: f64| crate::quantity::without_rounding(100.0 * size);
        let assumed = if self.assumed { " (assumed)" } else { "" };
        format!("{} cm sheet on a disc of {} cm{assumed}", centimetres(self.sheet), centimetres(self.disc))
    }
}

/// Numbers with a unit of length, and the one before a stroke (`24/18 cm`), in metres.
fn lengths(words: &str) -> Vec<f64> {
    let text: Vec<char> = words.chars().collect();
    let (mut found, mut waiting, mut i) = (Vec::new(), None, 0);
    while i < text.len() {
        let length = text[i..].iter().take_while(|c| c.is_ascii_digit() || matches!(c, '.' | ',')).count();
        if length == 0 {
            i += 1;
            continue;
        }
        let digits: String = text[i..i + length].iter().collect();
        let number = digits.trim_end_matches(['.', ',']).replace(',', ".").parse::<f64>().ok();
        i += length;
        let rest: String = text[i..].iter().collect();
        let rest = rest.trim_start_matches([' ', '-']);
        let factor = [("cm", 1e-2), ("mm", 1e-3), ("in", 0.0254), ("\"", 0.0254), ("m ", 1.0)]
            .iter()
            .find(|(unit, _)| rest.starts_with(unit))
            .map(|u| u.1);
        let before = waiting.take();
        match (number, factor) {
            (Some(number), Some(factor)) => {
                found.extend(before.into_iter().chain([number]).map(|n| n * factor))
            }
            (Some(number), None) if rest.starts_with(['/', '×', 'x']) => waiting = Some(number),
            _ => {}
        }
    }
    found.retain(|length| (POSSIBLE[0]..=POSSIBLE[1]).contains(length));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn sizes_are_read_in_the_words_of_sources() {
        for (words, sheet, disc, assumed) in [
            ("Cusick drape, 30 cm specimen (assumed) on an 18 cm disc", 0.30, 0.18, true),
            ("Cusick drape, 24 cm specimen on an 18 cm disc", 0.24, 0.18, false),
            ("BS 5058, 36/18 cm", 0.36, 0.18, false),
            ("ISO 9073-9, sheet of 240 mm", 0.24, 0.18, false),
            ("ISO 9073-9:2008", 0.30, 0.18, true),
            ("drape tester, as published", 0.30, 0.18, true),
            ("JIS L 1096 G", 0.254, 0.127, false),
            ("25.4 cm on 12.7 cm", 0.254, 0.127, false),
            ("10 in sheet, 5 in disc", 0.254, 0.127, false),
            ("25,4 cm", 0.254, 0.127, false),
            ("", 0.30, 0.18, true),
        ] {
            let found = DrapeMethod::read(words);
            assert_relative_eq!(found.sheet, sheet, max_relative = 1e-12);
            assert_relative_eq!(found.disc, disc, max_relative = 1e-12);
            assert_eq!(found.assumed, assumed, "{words}");
        }
    }

    #[test]
    fn the_coefficient_is_0_at_the_disc_and_1_at_the_sheet() {
        let method = DrapeMethod::default();
        let area = |d: f64| 0.25 * std::f64::consts::PI * d * d;
        assert_relative_eq!(method.coefficient(area(0.18)), 0.0, epsilon = 1e-12);
        assert_relative_eq!(method.coefficient(area(0.30)), 1.0, max_relative = 1e-12);
        assert_eq!(method.text(), "30 cm sheet on a disc of 18 cm (assumed)");
    }
}
