//! Numbers as people read them.

use super::Unit;

/// Four significant digits, without an exponent where people would not write one:
/// `5120`, `0.05000`, `1.157e-5`.
pub fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    // Rounding first: 9.9996 is 10.00, not 10.000.
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    let exponent = rounded.abs().log10().floor();
    if !(-3.0..6.0).contains(&exponent) {
        return format!("{value:.3e}");
    }
    format!("{value:.*}", (3.0 - exponent).max(0.0) as usize)
}

/// A value (SI) in another unit of its dimension, with four significant digits: `8.000 deg`.
pub fn in_unit(value: f64, unit: &str) -> String {
    let factor = Unit::parse(unit).map_or(f64::NAN, |u| u.factor);
    format!("{} {unit}", significant(value / factor))
}

/// A number without the noise that a conversion of units leaves in its last bits: `5` for 5.000000000000001.
pub fn without_rounding(value: f64) -> String {
    format!("{value:.8e}").parse::<f64>().unwrap_or(value).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_are_shown() {
        let shown = [0.0, 1.0, 5120.4, 0.05, 1.157_184_7e-5, 123_456.0, 9.9996, -0.5].map(significant);
        assert_eq!(shown, ["0", "1.000", "5120", "0.05000", "1.157e-5", "123456", "10.00", "-0.5000"]);
    }
}
