//! Colours: Okabe & Ito (2008), told apart by every common kind of colour vision and in grey.

use plotters::prelude::RGBColor;

use super::canvas::Stroke;
use crate::instrument::Direction;

pub(super) const INK: RGBColor = RGBColor(0x1a, 0x1a, 0x1a);
pub(super) const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);
pub(super) const GRID: RGBColor = RGBColor(0xe3, 0xe3, 0xe3);
pub(super) const WHITE: RGBColor = RGBColor(0xff, 0xff, 0xff);
pub(super) const WARNING: RGBColor = RGBColor(0xb0, 0x10, 0x10);

pub(super) const BLUE: RGBColor = RGBColor(0x00, 0x72, 0xb2);
pub(super) const VERMILLION: RGBColor = RGBColor(0xd5, 0x5e, 0x00);
pub(super) const GREEN: RGBColor = RGBColor(0x00, 0x9e, 0x73);

/// The colours of groups, in order.
pub(super) const GROUPS: [RGBColor; 7] = [
    BLUE,
    VERMILLION,
    GREEN,
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    INK,
];

/// Between a colour (0) and white (1).
pub(super) fn lighter(color: RGBColor, by: f64) -> RGBColor {
    mix(color, WHITE, by)
}

/// Between a colour (0) and black (1).
pub(super) fn darker(color: RGBColor, by: f64) -> RGBColor {
    mix(color, RGBColor(0, 0, 0), by)
}

fn mix(a: RGBColor, b: RGBColor, t: f64) -> RGBColor {
    let channel = |a: u8, b: u8| (f64::from(a) + t * (f64::from(b) - f64::from(a))).round() as u8;
    RGBColor(channel(a.0, b.0), channel(a.1, b.1), channel(a.2, b.2))
}

/// Warp blue and solid, weft vermillion and dashed, bias green and dotted; blue without a direction.
pub(super) fn direction(direction: Option<Direction>, width: f64) -> Stroke {
    let (color, dash) = match direction {
        None | Some(Direction::Warp) => (BLUE, None),
        Some(Direction::Weft) => (VERMILLION, Some([20.0, 11.0])),
        Some(Direction::Bias) => (GREEN, Some([7.0, 9.0])),
    };
    Stroke { color, width, dash }
}

/// Colour of a fraction 0..1 on a scale that is even to the eye (viridis).
pub(super) fn sequential(t: f64) -> RGBColor {
    // Anchors of viridis (van der Walt & Smith, CC0) at 0, 1/8, ... 1.
    const ANCHORS: [RGBColor; 9] = [
        RGBColor(0x44, 0x01, 0x54),
        RGBColor(0x47, 0x2d, 0x7b),
        RGBColor(0x3b, 0x52, 0x8b),
        RGBColor(0x2c, 0x72, 0x8e),
        RGBColor(0x21, 0x91, 0x8c),
        RGBColor(0x28, 0xae, 0x80),
        RGBColor(0x5e, 0xc9, 0x62),
        RGBColor(0xad, 0xdc, 0x30),
        RGBColor(0xfd, 0xe7, 0x25),
    ];
    ramp(&ANCHORS, t)
}

/// Colour of a fraction 0..1 on a scale with a white middle, for values of both signs.
pub(super) fn diverging(t: f64) -> RGBColor {
    const ANCHORS: [RGBColor; 5] = [
        RGBColor(0x05, 0x30, 0x61),
        RGBColor(0x56, 0x9f, 0xcb),
        RGBColor(0xf7, 0xf7, 0xf7),
        RGBColor(0xe8, 0x91, 0x5a),
        RGBColor(0x7f, 0x27, 0x04),
    ];
    ramp(&ANCHORS, t)
}

fn ramp(anchors: &[RGBColor], t: f64) -> RGBColor {
    let place = t.clamp(0.0, 1.0) * (anchors.len() - 1) as f64;
    let i = (place as usize).min(anchors.len() - 2);
    mix(anchors[i], anchors[i + 1], place - i as f64)
}
