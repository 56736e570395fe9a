//! Volts of analogue outputs: at how many the full scale of a range is reached.

use super::words::folded;

/// The full scale (V) of the outputs of KES instruments.
pub(super) const FULL_SCALE: f64 = 10.0;

/// A voltage (V), greater than zero: `5 V`, `±5 V`.
pub(super) fn value(text: &str) -> Option<f64> {
    let text = folded(text);
    let text = text.trim().trim_start_matches(['±', '+', '-', '/', ' ']);
    let (number, factor) = match text.strip_suffix("mV") {
        Some(number) => (number, 1e-3),
        None => (text.strip_suffix('V')?, 1.0),
    };
    let value = number.trim().replace(',', ".").parse::<f64>().ok()? * factor;
    (value.is_finite() && value > 0.0).then_some(value)
}

/// A range without the voltage that it states, and that voltage: `20 gf/cm (5 V)`, `20 gf/cm / 5 V`, `5 V = 20 gf/cm`, `4 gf/cm/V`.
pub(super) fn of_range(text: &str) -> (String, Option<f64>) {
    let text = folded(text).trim().to_string();
    if let Some((first, second)) = text.split_once('=') {
        let (a, b) = (value(first), value(second));
        if a.is_some() != b.is_some() {
            let range = if a.is_some() { second } else { first };
            return (range.trim().to_string(), a.or(b));
        }
    }
    for per in ["/V", "/ V", " per V"] {
        if let Some(range) = text.strip_suffix(per) {
            return (range.trim().to_string(), Some(1.0));
        }
    }
    let inside = text.strip_suffix(')').unwrap_or(&text);
    for mark in ['(', '/'] {
        if let Some((range, volts)) = inside.rsplit_once(mark)
            && let Some(volts) = value(volts)
        {
            return (range.trim().to_string(), Some(volts));
        }
    }
    (text, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_state_their_full_scale() {
        for (text, range, volts) in [
            ("20 gf/cm", "20 gf/cm", None),
            ("20 gf/cm (5 V)", "20 gf/cm", Some(5.0)),
            ("20 gf/cm / 5 V", "20 gf/cm", Some(5.0)),
            ("5 V = 20 gf/cm", "20 gf/cm", Some(5.0)),
            ("4 gf/cm/V", "4 gf/cm", Some(1.0)),
            ("2.5 1/cm", "2.5 1/cm", None),
        ] {
            assert_eq!(of_range(text), (range.to_string(), volts), "{text}");
        }
        assert_eq!(
            [value("±5 V"), value("500 mV"), value("5 cm"), value("V")],
            [Some(5.0), Some(0.5), None, None]
        );
    }
}
