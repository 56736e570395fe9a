//! The page of an SVG drawing: how long its unit is, and where its corner lies.

use kurbo::Affine;
use quick_xml::events::BytesStart;
use svgtypes::{Length, LengthUnit, ViewBox};

/// CSS pixels of an inch.
const PIXELS: f64 = 96.0;

/// What the outermost element says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Page {
    /// Length of a unit of its coordinates (m), where it gives one.
    pub unit: Option<f64>,
    /// Where the lower left corner of the page lies.
    pub corner: [f64; 2],
}

impl Page {
    /// The page of the outermost element.
    pub fn of(e: &BytesStart<'_>) -> Result<Self, String> {
        let view = attribute(e, "viewBox")?;
        let view =
            view.map(|v| v.parse::<ViewBox>().map_err(|e| format!("viewBox=\"{v}\": {e}"))).transpose()?;
        let [width, height] = [size(e, "width")?, size(e, "height")?];
        let Some(view) = view else {
            // Without a box one unit is a pixel, whose length is sure where a size of the page is in a unit.
            let unit = (width.is_some() || height.is_some()).then_some(0.0254 / PIXELS);
            return Ok(Self { unit, corner: [0.0, height.map_or(0.0, |h| h * PIXELS / 0.0254)] });
        };
        let units = [width.map(|w| w / view.w), height.map(|h| h / view.h)];
        let unit = match units {
            [Some(x), Some(y)] if (x - y).abs() > 0.01 * x.max(y) => {
                return Err(format!(
                    "the page is stretched: a unit is {x} m along x and {y} m along y by width, height and viewBox"
                ));
            }
            // The smaller one is that of a page that keeps its proportions.
            [Some(x), Some(y)] => Some(x.min(y)),
            [x, y] => x.or(y),
        };
        Ok(Self { unit, corner: [view.x, view.y + view.h] })
    }

    /// From the coordinates of the file, whose y points downwards, to the sheet (m).
    pub fn to_metres(self, unit: f64) -> Affine {
        let [x, y] = self.corner;
        Affine::new([unit, 0.0, 0.0, -unit, -unit * x, unit * y])
    }
}

/// A size of the page (m), if it is in a unit.
fn size(e: &BytesStart<'_>, name: &str) -> Result<Option<f64>, String> {
    let Some(value) = attribute(e, name)? else { return Ok(None) };
    let length: Length = value.trim().parse().map_err(|e| format!("{name}=\"{value}\": {e}"))?;
    let inches = match length.unit {
        LengthUnit::None | LengthUnit::Percent => return Ok(None),
        _ => {
            pixels(&length).ok_or_else(|| format!("{name}=\"{value}\" is not in mm, cm, in, pt, pc or px"))?
                / PIXELS
        }
    };
    if inches > 0.0 { Ok(Some(0.0254 * inches)) } else { Err(format!("{name}=\"{value}\" is not positive")) }
}

/// A length in units of the coordinates; none of one that depends on a font or on the page.
pub(super) fn pixels(length: &Length) -> Option<f64> {
    let each = match length.unit {
        LengthUnit::None | LengthUnit::Px => 1.0,
        LengthUnit::In => PIXELS,
        LengthUnit::Cm => PIXELS / 2.54,
        LengthUnit::Mm => PIXELS / 25.4,
        LengthUnit::Pt => PIXELS / 72.0,
        LengthUnit::Pc => PIXELS / 6.0,
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => return None,
    };
    Some(length.number * each)
}

/// An attribute by its local name.
pub(super) fn attribute(e: &BytesStart<'_>, name: &str) -> Result<Option<String>, String> {
    for attribute in e.attributes() {
        let attribute = attribute.map_err(|e| format!("its attributes cannot be read: {e}"))?;
        if attribute.key.local_name().as_ref() == name {
            let value = attribute.normalized_value(quick_xml::XmlVersion::Implicit1_0);
            return value
                .map(|v| Some(v.into_owned()))
                .map_err(|e| format!("its `{name}` cannot be read: {e}"));
        }
    }
    Ok(None)
}
