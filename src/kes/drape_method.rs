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
/// The smallest sheet over its disc: what hangs over less has no folds.
const LEAST_SHEET: f64 = 1.1;

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
    /// A sheet alone has the disc of its standard. The standards with several sheets, words without a size, and sizes of which
    /// it is not clear which one is the disc ([`Self::in_words`]) are taken as 30 cm on 18 cm, assumed; so is what the
    /// words call assumed.
    pub fn read(method: &str) -> Self {
        Self::in_words(method).unwrap_or_default()
    }

    /// The sizes that the words state, be they assumed in these words; nothing without sizes, and nothing where more than two
    /// are named, or two of which none is the disc of a standard and the words do not say which one it is (`disc`, `40 cm on 20 cm`, `40/20 cm`).
    pub fn in_words(method: &str) -> Option<Self> {
        let words = method.to_lowercase();
        let says = |word: &str| words.contains(word);
        let mut sizes = lengths(&words);
        let radii = if says("radii") { sizes.len() } else { words.matches("radius").count() };
        if radii > 0 {
            // One radius beside a diameter is not clear enough.
            if radii < sizes.len() {
                return None;
            }
            sizes.iter_mut().for_each(|size| *size *= 2.0);
        }
        sizes.sort_by(f64::total_cmp);
        sizes.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
        let near = |a: f64, b: f64| (a - b).abs() < 5e-4;
        let is_jis = says("jis") || says("l 1096") || says("l1096");
        let is_disc = |size: f64| {
            [CUSICK_DISC, JIS[1]].iter().any(|disc| near(*disc, size))
                || ["disc", "disk", "plate", "pedestal"].iter().any(|word| says(word))
                || is_pair(&words)
        };
        let found = match sizes[..] {
            [] if is_jis => Self::stated(JIS[1], JIS[0]),
            [sheet] if near(sheet, JIS[0]) => Self::stated(JIS[1], JIS[0]),
            [sheet] if CUSICK.iter().any(|known| near(*known, sheet)) => Self::stated(CUSICK_DISC, sheet),
            [disc, sheet] if is_disc(disc) => Self::hanging(disc, sheet)?,
            _ => return None,
        };
        Some(Self { assumed: says("assumed"), ..found })
    }

    /// Disc and sheet (m) that can be those of a drape test: 5 cm to 1 m, and a sheet that hangs over its disc.
    pub fn hanging(disc: f64, sheet: f64) -> Option<Self> {
        let can_be = POSSIBLE[0] <= disc && sheet <= POSSIBLE[1] && sheet >= LEAST_SHEET * disc;
        can_be.then(|| Self::stated(disc, sheet))
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

/// Whether two numbers stand as a sheet and its disc do: `40 cm on 20 cm`, `40/20 cm`.
fn is_pair(words: &str) -> bool {
    let mut after_on = words.split(" on ").skip(1);
    let mut strokes = words.split('/').zip(words.split('/').skip(1));
    after_on.any(|text| begins_with_digit(text.trim_start_matches("an ").trim_start_matches("a ")))
        || strokes.any(|(before, after)| {
            before.trim_end().ends_with(|c: char| c.is_ascii_digit()) && begins_with_digit(after.trim_start())
        })
}

fn begins_with_digit(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit())
}

/// Numbers with a unit of length, and the one before a stroke (`24/18 cm`) or a tolerance (`30.0±0.1 cm`), in metres.
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
        let factor = [
            ("cm", 1e-2),
            ("centim", 1e-2),
            ("mm", 1e-3),
            ("millim", 1e-3),
            ("in", 0.0254),
            ("\"", 0.0254),
            ("m ", 1.0),
        ]
        .iter()
        .find(|(unit, _)| rest.starts_with(unit))
        .map(|u| u.1);
        let before = waiting.take();
        match (number, factor) {
            (Some(number), Some(factor)) => {
                found.extend(before.into_iter().chain([number]).map(|n| n * factor))
            }
            (Some(number), None) if rest.starts_with(['/', '×', 'x', '±', '+']) => waiting = Some(number),
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
            ("24 centimetres on 18 centimetres", 0.24, 0.18, false),
            ("30.0±0.1 cm, 18 cm", 0.30, 0.18, false),
            ("sheet radius 12 cm, disc radius 9 cm", 0.24, 0.18, false),
            ("radii of disc and sheet: 9 cm, 12 cm", 0.24, 0.18, false),
            ("disk of 20 cm, specimen of 40 cm", 0.40, 0.20, false),
            ("40 cm on 20 cm", 0.40, 0.20, false),
            ("40/20 cm", 0.40, 0.20, false),
            // Which one is the disc, or the sheet, is not said.
            ("36 cm specimen, camera 60 cm above", 0.30, 0.18, true),
            ("24 cm, 30 cm and 36 cm", 0.30, 0.18, true),
            ("36 cm specimen, disc radius 9 cm", 0.30, 0.18, true),
            ("18 cm on 18.1 cm", 0.30, 0.18, true),
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
