//! What a number format of a workbook shows of a number: per cent, thousands, and a unit behind it.

use super::unit_text::{is_volt, unbracketed, unit};

/// What stands in a cell that is formatted so.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Shown {
    /// The number is shown times ten to this power.
    pub power: i32,
    /// The unit behind the number.
    pub unit: Option<String>,
    /// Whether the unit is the sign by which the format multiplies.
    pub is_percent: bool,
}

impl Shown {
    /// Whether the format changes nothing of what the number says.
    pub fn is_plain(&self) -> bool {
        self.power == 0 && self.unit.is_none()
    }

    /// What a format with this text behind the number shows.
    pub fn with(power: i32, behind: &str) -> Self {
        let text = unbracketed(behind);
        let is_percent = power == 2 && text == "%";
        let unit = Some(text).filter(|text| is_like_unit(text));
        Self { power, unit, is_percent }
    }

    /// What the first section of a format code shows: that of numbers above zero.
    pub fn of(code: &str) -> Self {
        let mut scan = Scan { rest: code, ..Scan::default() };
        while scan.step() {}
        if scan.is_date { Self::default() } else { Self::with(scan.power - 3 * scan.thousands, &scan.behind) }
    }
}

/// Whether a text behind a number is a unit, or written as units are: what nobody knows is refused where it stands.
fn is_like_unit(text: &str) -> bool {
    let says_something = text.contains(|c: char| c.is_alphabetic() || matches!(c, '%' | '°'));
    let written_so = text.contains(['/', '·', '^', '²', '³']) && !text.contains(' ');
    says_something && (is_volt(text) || unit(text).is_ok() || written_so)
}

/// A format code on its way.
#[derive(Default)]
struct Scan<'c> {
    rest: &'c str,
    power: i32,
    /// Commas behind the last digit, each of which divides by a thousand.
    thousands: i32,
    /// Whether a digit was met.
    begun: bool,
    is_date: bool,
    behind: String,
}

impl Scan<'_> {
    fn digit(&mut self) {
        (self.begun, self.thousands) = (true, 0);
        self.behind.clear();
    }

    /// Takes up to the end mark, which goes as well.
    fn until(&mut self, end: char) -> &str {
        let (text, rest) = self.rest.split_once(end).unwrap_or((self.rest, ""));
        self.rest = rest;
        text
    }

    fn next(&mut self) -> Option<char> {
        let c = self.rest.chars().next()?;
        self.rest = &self.rest[c.len_utf8()..];
        Some(c)
    }

    /// Takes one sign of the code; false at the end of the section.
    fn step(&mut self) -> bool {
        if let Some(rest) = self.rest.strip_prefix("General") {
            self.rest = rest;
            self.digit();
            return true;
        }
        let Some(c) = self.next() else { return false };
        match c {
            ';' => return false,
            '"' => {
                let text = self.until('"').to_string();
                self.behind += &text;
            }
            '\\' => {
                let literal = self.next();
                self.behind.extend(literal);
            }
            // A blank as wide as the next sign, and a sign that fills the cell.
            '_' | '*' => {
                self.next();
                self.behind.push(' ');
            }
            // A colour, a condition, or `[$mm-409]`, which shows its text.
            '[' => {
                let text = self.until(']').to_string();
                let shown = text.strip_prefix('$').and_then(|t| t.split('-').next());
                self.behind += shown.unwrap_or("");
            }
            '0' | '#' | '?' => self.digit(),
            '.' if self.begun && self.behind.is_empty() => {}
            ',' if self.begun && self.behind.is_empty() => self.thousands += 1,
            '%' => {
                self.power += 2;
                self.behind.push('%');
            }
            'E' if self.rest.starts_with(['+', '-']) => {
                self.next();
            }
            'y' | 'm' | 'd' | 'h' | 's' | 'Y' | 'M' | 'D' | 'H' | 'S' => self.is_date = true,
            c => self.behind.push(c),
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_show_powers_and_units() {
        for (code, power, unit) in [
            ("General", 0, None),
            ("0.000", 0, None),
            ("#,##0.00", 0, None),
            ("0.00E+00", 0, None),
            ("0.00_ ;[Red]-0.00 \"mm\"", 0, None),
            ("0.0%", 2, Some("%")),
            ("0.0 %", 2, Some("%")),
            ("0.0\"%\"", 0, Some("%")),
            ("0.0\\%", 0, Some("%")),
            ("0.000\" gf·cm²/cm\"", 0, Some("gf·cm2/cm")),
            ("0.000 \"mm\";-0.000 \"mm\"", 0, Some("mm")),
            ("0.0\\ \\m\\m", 0, Some("mm")),
            ("General\" mm\"", 0, Some("mm")),
            ("#,##0.0\" [gf/cm]\"", 0, Some("gf/cm")),
            ("[>0]0.00[$ mm-409]", 0, Some("mm")),
            ("0.0,\" kPa\"", -3, Some("kPa")),
            ("0.0°", 0, Some("°")),
            ("0 \"pcs\"", 0, None),
            ("0.00\" gf/foo\"", 0, Some("gf/foo")),
            ("\"No. \"0", 0, None),
            ("0.0 mm", 0, None),
            ("dd.mm.yyyy", 0, None),
            ("@", 0, None),
        ] {
            let shown = Shown::of(code);
            assert_eq!((shown.power, shown.unit.as_deref()), (power, unit), "{code}");
        }
        assert!(Shown::of("0%").is_percent && !Shown::of("0\"%\"").is_percent);
    }
}
