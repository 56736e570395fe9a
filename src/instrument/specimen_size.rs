//! The size of a specimen: its width and the distance between the jaws, in one line of the header or in several.

use super::Test;
use super::context::Context;
use super::dialect::HeaderKey;
use super::error::ReadError;
use super::header_value::{positive, quantity};
use super::layout::Header;
use super::unit_text;
use super::words::folded;
use crate::quantity::Length;

/// Width and distance between the jaws (m) of `20 x 5 cm`: the specimen is wide and short. A square, `20 x 20 cm`, is that of
/// the cloth that was cut, and says nothing of the jaws. `5 x 20 cm (L x W)` is the other way round, and so are the sizes of the
/// instrument, `5 x 20 cm`, without a word; `5 x 10 cm` and `10 x 20 cm` are not understood then.
pub(super) fn size(test: Test, header: &Header, context: &Context<'_>) -> Option<(f64, Option<f64>)> {
    let entry = header.known.get(&HeaderKey::Size)?;
    let text = folded(&entry.text).replace(['×', 'X', '*'], "x");
    // In the bracket of the key, `(L x W)` or `(cm)`.
    let (text, inside) = text.split_once('(').unwrap_or((&text, ""));
    let inside = inside.trim_end_matches(')').trim();
    let (first, second) = text.split_once('x')?;
    let second = with_point(second, context);
    let second = match unit_text::unit(inside) {
        Ok(_) if second.ends_with(|c: char| c.is_ascii_digit()) => format!("{second} {inside}"),
        _ => second,
    };
    let unit: String =
        second.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.' || c == ' ').to_string();
    let first = with_point(first, context);
    let first = if first.ends_with(|c: char| c.is_ascii_digit()) { format!("{first} {unit}") } else { first };
    let (first, second) = (length(&first)?, length(&second)?);
    let jaws = test.spec().gauge;
    let (width, gauge) = match width_is_first(inside) {
        Some(true) => (first, second),
        Some(false) => (second, first),
        None if first >= second || jaws == 0.0 || alike(second, jaws) => (first, second),
        None if alike(first, jaws) && alike(second, test.spec().width) => (second, first),
        None => return None,
    };
    Some((width, Some(gauge).filter(|gauge| !is_square(*gauge, width))))
}

/// Whether the two are those of the cloth that was cut.
fn is_square(length: f64, width: f64) -> bool {
    alike(length, width)
}

/// The number with a point for its decimal mark.
fn with_point(text: &str, context: &Context<'_>) -> String {
    let text = text.trim();
    if context.decimal == ',' { text.replace(',', ".") } else { text.to_string() }
}

fn length(text: &str) -> Option<f64> {
    text.parse::<Length>().ok().map(Length::si).filter(|v| *v > f64::MIN_POSITIVE)
}

/// The stated distance between the jaws (m): that of words for jaws, else the length of a specimen which may be it. A square, or
/// a length beyond the customary distance, is that of the cloth, and says nothing of the jaws.
pub(super) fn gauge(
    test: Test,
    header: &Header,
    width: f64,
    context: &Context<'_>,
) -> Result<Option<f64>, ReadError> {
    let customary = test.spec().gauge;
    if customary <= 0.0 {
        return Ok(None);
    }
    if let Some(gauge) = length_of(header, HeaderKey::Gauge, "gauge", context)? {
        return Ok(Some(gauge));
    }
    let length = length_of(header, HeaderKey::Length, "specimen length", context)?;
    Ok(length.filter(|length| !is_square(*length, width) && *length <= customary * (1.0 + 1e-6)))
}

/// A length (m) of the header, greater than zero.
pub(super) fn length_of(
    header: &Header,
    key: HeaderKey,
    name: &str,
    context: &Context<'_>,
) -> Result<Option<f64>, ReadError> {
    let Some(entry) = header.known.get(&key) else { return Ok(None) };
    let length: Length = quantity(entry, name, "cm", context)?;
    positive(length.si(), key, header, context).map(Some)
}

/// Whether two lengths are one but for rounding.
fn alike(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 1e-6
}

/// Whether an order such as `W x L` or `length x width` begins with the width; `None` of other words.
fn width_is_first(order: &str) -> Option<bool> {
    let order = order.to_lowercase();
    let (first, second) = order.split_once('x')?;
    let [first, second] = [first, second].map(|word| is_width(word.trim()));
    (first != second).then_some(first)
}

/// Whether a word is one for the width, by its beginning; `largo` is the length.
fn is_width(word: &str) -> bool {
    let width = ["w", "b", "anch", "larg", "幅", "宽", "寬"];
    !word.starts_with("largo") && width.iter().any(|beginning| word.starts_with(beginning))
}
