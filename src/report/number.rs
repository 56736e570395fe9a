//! Numbers as people read them: true minus signs, superscripts, digits that the spread justifies.

use crate::quantity::Estimate;

/// So many of what is named: "1 finding", "2 findings".
pub fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A value with fixed decimals, the sign U+2212, and never "-0".
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let Some(digits) = text.strip_prefix('-') else { return text };
    if digits.bytes().all(|b| matches!(b, b'0' | b'.')) {
        digits.to_string()
    } else {
        format!("\u{2212}{digits}")
    }
}

/// A value with this many significant digits: `0.0521`, `1250`, or `1.27 × 10⁻⁵` where plain digits mislead.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    if !value.is_finite() {
        return if value.is_nan() { "not a number".into() } else { "infinite".into() };
    }
    let exponent = decade(value);
    if (-3..6).contains(&exponent) {
        return fixed(value, usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0));
    }
    let text = fixed(value / 10f64.powi(exponent), digits.saturating_sub(1));
    format!("{text} × {}", power_of_ten(exponent))
}

/// Mean and standard deviation in one unit (`factor` SI per unit): the SD with two significant digits
/// and the mean to the same place; at most four significant digits where there is no spread.
pub fn with_spread(estimate: &Estimate, factor: f64) -> String {
    let mean = estimate.mean / factor;
    match estimate.sd.map(|sd| sd / factor).filter(|sd| sd.is_finite() && *sd > 0.0) {
        Some(sd) => {
            let decimals = usize::try_from(1 - decade(sd)).unwrap_or(0).min(8);
            format!("{} ± {}", fixed(mean, decimals), fixed(sd, decimals))
        }
        None => {
            let text = significant(mean, 4);
            if text.contains('.') && !text.contains('×') {
                text.trim_end_matches('0').trim_end_matches('.').to_string()
            } else {
                text
            }
        }
    }
}

/// Mean and standard deviation: the SD with two significant digits and the mean to the same place, and where there is no
/// spread as [`concise`]. The script of the page writes the same texts (`spread` in page.js).
pub fn mean_and_spread(mean: f64, sd: Option<f64>) -> String {
    let Some(sd) = sd.filter(|sd| sd.is_finite() && *sd > 0.0) else { return concise(mean) };
    let exponent = plain_exponent(mean);
    let (mean, sd) = (mean / 10f64.powi(exponent), sd / 10f64.powi(exponent));
    let decimals = usize::try_from(1 - decade(sd)).unwrap_or(0).min(8);
    let text = format!("{} ± {}", fixed(mean, decimals), fixed(sd, decimals));
    if exponent == 0 { text } else { format!("({text}) × {}", power_of_ten(exponent)) }
}

/// A value to four significant digits at most, without zeros at its end: what was printed as 0.067 is not 0.06700.
pub fn concise(value: f64) -> String {
    let text = significant(value, 4);
    let (digits, power) = text.split_at(text.find(" × ").unwrap_or(text.len()));
    let digits =
        if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits };
    format!("{digits}{power}")
}

/// The power of ten to take out of a value so that it is readable; 0 where plain digits are.
pub fn plain_exponent(value: f64) -> i32 {
    if value == 0.0 || !value.is_finite() || (-3..6).contains(&decade(value)) { 0 } else { decade(value) }
}

/// `10⁻³`.
pub fn power_of_ten(exponent: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        // The other superscript digits are in one row of Unicode.
        c => char::from_u32(0x2070 + u32::from(c) - u32::from('0')).unwrap_or(c),
    };
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

/// Units as printed: `µm` for `um`, `°` for `deg`, nothing for `1`.
pub fn unit_text(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        "um" => "µm".to_string(),
        _ => unit.replace("deg", "°"),
    }
}

/// A factor and prefix such that `largest / factor` lies in 1..1000, for units that take a prefix
/// (`m`, `N`, `N/m`, `N·m`, `Pa` ...). Others keep their unit and factor 1.
pub fn prefixed(largest: f64, unit: &str) -> (f64, String) {
    const ATOMS: [&str; 7] = ["Pa", "Hz", "m", "N", "J", "s", "rad"];
    const PREFIXES: [&str; 7] = ["p", "n", "µ", "m", "", "k", "M"];
    let takes_prefix = ATOMS.iter().any(|atom| {
        unit.strip_prefix(atom).is_some_and(|rest| rest.is_empty() || rest.starts_with(['/', '·']))
    });
    if !takes_prefix || largest == 0.0 || !largest.is_finite() {
        return (1.0, unit_text(unit));
    }
    let step = decade(largest).div_euclid(3).clamp(-4, 2);
    let prefix = usize::try_from(step + 4).ok().and_then(|i| PREFIXES.get(i)).copied().unwrap_or("");
    (10f64.powi(3 * step), format!("{prefix}{unit}"))
}

/// The power of ten of the leading digit.
fn decade(value: f64) -> i32 {
    // The guard keeps 999.9999999 and 1000.0 in one decade.
    (value.abs().log10() + 1e-9).floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_superscripts_and_digits() {
        assert_eq!(fixed(-0.5, 1), "−0.5");
        assert_eq!(fixed(-0.01, 1), "0.0");
        assert_eq!(significant(0.052_14, 3), "0.0521");
        assert_eq!(significant(-1_234_567.0, 3), "−1.23 × 10⁶");
        assert_eq!(significant(1.27e-5, 3), "1.27 × 10⁻⁵");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(f64::NAN, 3), "not a number");
        assert_eq!(power_of_ten(-10), "10⁻¹⁰");
        assert_eq!(unit_text("gf/(cm·deg)"), "gf/(cm·°)");
    }

    #[test]
    fn the_spread_decides_the_digits_of_the_mean() {
        let e = Estimate { mean: 0.052_14, sd: Some(0.001_34), n: 3, values: vec![] };
        assert_eq!(with_spread(&e, 1.0), "0.0521 ± 0.0013");
        let e = Estimate { mean: 5.213_4e-6, sd: Some(1.34e-7), n: 3, values: vec![] };
        assert_eq!(plain_exponent(e.mean), -6);
        assert_eq!(with_spread(&e, 1e-6), "5.21 ± 0.13");
        assert_eq!(plain_exponent(0.01), 0);
        assert_eq!(with_spread(&Estimate::single(61.2345), 1.0), "61.23");
        let e = Estimate { mean: 52.0, sd: Some(0.0), n: 3, values: vec![] };
        assert_eq!(with_spread(&e, 1.0), "52");
    }

    #[test]
    fn digits_follow_the_spread_or_what_was_printed() {
        assert_eq!(mean_and_spread(0.05214, Some(0.00134)), "0.0521 ± 0.0013");
        assert_eq!(mean_and_spread(8.474e-6, Some(2.1e-7)), "(8.47 ± 0.21) × 10⁻⁶");
        assert_eq!(mean_and_spread(5.944, None), "5.944");
        assert_eq!(mean_and_spread(52.0, Some(0.0)), "52");
        assert_eq!([0.067, 2.5e-4, -1200.0, 0.0].map(concise), ["0.067", "2.5 × 10⁻⁴", "−1200", "0"]);
    }

    #[test]
    fn prefixes_only_where_they_have_a_meaning() {
        assert_eq!(prefixed(0.003_05, "m"), (1e-3, "mm".to_string()));
        assert_eq!(prefixed(42.0, "N/m"), (1.0, "N/m".to_string()));
        assert_eq!(prefixed(4.2e-6, "N·m"), (1e-6, "µN·m".to_string()));
        assert_eq!(prefixed(1e-6, "m²"), (1.0, "m²".to_string()));
        assert_eq!(prefixed(1e-6, "1/m"), (1.0, "1/m".to_string()));
    }
}
