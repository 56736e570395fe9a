//! Deflected sheets for the viewer of the page, as small as a picture needs them.

use std::collections::BTreeMap;

#[cfg(feature = "results")]
use base64::Engine as _;
#[cfg(feature = "results")]
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

#[cfg(feature = "results")]
use super::data::shortened;
#[cfg(feature = "results")]
use crate::report::gltf::{DeflectedSheet, GltfError, share};

/// Most nodes of a sheet on the page, which 16 bits tell apart; larger ones are in their files alone.
#[cfg(feature = "results")]
const NODES: usize = 1 << 16;
/// Bytes of all sheets of a page, at most.
const BYTES: usize = 1_000_000;

/// A deflected sheet of a fabric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeflectedShape {
    /// Place in [`PageData::fabrics`](super::PageData::fabrics).
    pub fabric: usize,
    /// Whether it is a drape, which comes first where there is not room for all.
    #[serde(default)]
    pub is_drape: bool,
    /// Title of its case.
    pub title: String,
    /// Its file, from the page.
    pub file: String,
    /// Largest displacement (m).
    pub largest: f64,
    /// By what displacements are multiplied.
    pub scale: f64,
    /// Smallest and largest coordinate in each direction (m).
    pub bounds: [[f64; 3]; 2],
    /// Nodes where they are shown, after those of the outline before: three parts of 65535 of the bounds each, 16 bits
    /// little endian in base64.
    pub places: String,
    /// How many of the places are of the outline; two are an edge.
    pub outline: usize,
    /// Displacement of each node as a part of 255 of the largest, in base64.
    pub values: String,
    /// What the quads can be coloured by instead.
    #[serde(default)]
    pub fields: Vec<ShapeField>,
    /// Corners of the quads, 16 bits little endian in base64; on a page a number of [`Shapes::quads`].
    pub quads: String,
}

/// A value of each quad of a sheet, 0 or more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapeField {
    /// What it is.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The largest value.
    pub largest: f64,
    /// Value of each quad as a part of 255 of the largest, in base64.
    pub values: String,
}

#[cfg(feature = "results")]
impl ShapeField {
    /// Of a value of each quad.
    pub fn new(name: &str, unit: &str, values: &[f64]) -> Self {
        let largest = values.iter().copied().fold(0.0, f64::max);
        Self {
            name: name.into(),
            unit: unit.into(),
            largest: shortened(largest),
            values: parts(values, largest),
        }
    }
}

/// Values as parts of 255 of the largest, in base64.
#[cfg(feature = "results")]
fn parts(values: &[f64], largest: f64) -> String {
    let bytes: Vec<u8> = values.iter().map(|v| (255.0 * share(*v, largest)).round() as u8).collect();
    STANDARD.encode(bytes)
}

/// The sheets of a page. Those of one mesh share its quads.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Shapes {
    /// The sheets.
    pub sheets: Vec<DeflectedShape>,
    /// Quads of meshes.
    pub quads: Vec<String>,
    /// The fabrics of those that are not here, to keep the page small: one place a sheet.
    pub left_out: Vec<usize>,
}

#[cfg(feature = "results")]
impl DeflectedShape {
    /// A sheet for the page; `None` if it is too large for it.
    ///
    /// # Errors
    /// [`GltfError`] if lists do not fit together.
    pub fn of(sheet: &DeflectedSheet, file: String) -> Result<Option<Self>, GltfError> {
        sheet.checked()?;
        if sheet.rest.len() > NODES {
            return Ok(None);
        }
        let (shown, magnitudes) = (sheet.shown(), sheet.displacement_magnitudes());
        let largest = magnitudes.iter().copied().fold(0.0, f64::max);
        let before = sheet.outline.as_flattened().iter().map(|n| sheet.rest[*n as usize]);
        let places: Vec<[f64; 3]> = before.chain(shown).collect();
        let bound = |pick: fn(f64, f64) -> f64, from: f64| {
            places.iter().fold([from; 3], |a, p| [0, 1, 2].map(|k| pick(a[k], p[k])))
        };
        let bounds = [bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY)];
        let part = |p: &[f64; 3]| {
            [0, 1, 2].map(|k| {
                let t = (p[k] - bounds[0][k]) / (bounds[1][k] - bounds[0][k]);
                (if t.is_finite() { t } else { 0.0 } * f64::from(u16::MAX)).round() as u16
            })
        };
        let short = |numbers: &mut dyn Iterator<Item = u16>| {
            STANDARD.encode(numbers.flat_map(u16::to_le_bytes).collect::<Vec<u8>>())
        };
        Ok(Some(Self {
            fabric: 0,
            is_drape: false,
            title: sheet.name.clone(),
            file,
            largest: shortened(largest),
            scale: sheet.scale_factor(),
            bounds: bounds.map(|b| b.map(shortened)),
            places: short(&mut places.iter().flat_map(part)),
            outline: 2 * sheet.outline.len(),
            values: parts(&magnitudes, largest),
            fields: Vec::new(),
            // No more nodes than 16 bits tell apart.
            quads: short(&mut sheet.quads.as_flattened().iter().map(|n| *n as u16)),
        }))
    }
}

impl Shapes {
    /// Those that a page has room for: drapes first, then what is shown as it is, then what is shown larger; each in
    /// their order.
    pub fn of(sheets: impl Iterator<Item = DeflectedShape>) -> Self {
        let mut sheets: Vec<DeflectedShape> = sheets.collect();
        sheets.sort_by_key(|sheet| (!sheet.is_drape, sheet.scale != 1.0));
        let mut all = Self::default();
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        let mut room = BYTES;
        for mut sheet in sheets {
            let of_fields: usize = sheet.fields.iter().map(|field| field.values.len() + 100).sum();
            let own = sheet.places.len() + sheet.values.len() + of_fields + 300;
            let needed = own + if known.contains_key(&sheet.quads) { 0 } else { sheet.quads.len() };
            if needed > room {
                all.left_out.push(sheet.fabric);
                continue;
            }
            room -= needed;
            let next = known.len();
            let at = *known.entry(sheet.quads.clone()).or_insert(next);
            if at == next {
                all.quads.push(std::mem::take(&mut sheet.quads));
            }
            sheet.quads = at.to_string();
            all.sheets.push(sheet);
        }
        all
    }

    /// Whether there is nothing to say of any.
    pub fn is_empty(&self) -> bool {
        self.sheets.is_empty() && self.left_out.is_empty()
    }

    /// How many sheets there are, here or not.
    pub fn count(&self) -> usize {
        self.sheets.len() + self.left_out.len()
    }
}

/// Tells how many sheets of a fabric are not in the page.
pub(super) fn left_out(out: &mut String, shapes: &Shapes, fabric: usize) {
    let missing = shapes.left_out.iter().filter(|of| **of == fabric).count();
    if missing > 0 {
        let all = missing + shapes.sheets.iter().filter(|sheet| sheet.fabric == fabric).count();
        out.push_str(&format!(
            "<p class=\"absent\">{missing} of {all} deflected sheets of this fabric do not turn here, to keep the page small; \
             their files (.glb) are in the folder of results.</p>\n"
        ));
    }
}

#[cfg(all(test, feature = "results"))]
mod tests {
    use super::*;

    fn shape(nodes: usize) -> DeflectedShape {
        let rest: Vec<[f64; 3]> = (0..nodes).map(|i| [(i / 2) as f64, (i % 2) as f64, 0.0]).collect();
        let quads: Vec<[u32; 4]> =
            (0..nodes as u32 / 2 - 1).map(|i| [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]).collect();
        let displacement: Vec<[f64; 3]> = (0..nodes).map(|i| [0.0, 0.0, 0.05 * (i / 2) as f64]).collect();
        let sheet = DeflectedSheet {
            name: "t".into(),
            about: String::new(),
            rest: &rest,
            displacement: &displacement,
            quads: &quads,
            outline: &[[0, 1]],
        };
        DeflectedShape::of(&sheet, "a/b.glb".into()).unwrap().unwrap()
    }

    #[test]
    fn places_are_parts_of_the_bounds() {
        let made = shape(4);
        assert_eq!(made.bounds, [[0.0; 3], [1.0, 1.0, 0.05]]);
        // Two ends of the outline at x = 0, then the nodes (0, 0), (0, 1), (1, 0), (1, 1).
        let bytes = STANDARD.decode(&made.places).unwrap();
        let numbers: Vec<u16> = bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect();
        let m = u16::MAX;
        assert_eq!(numbers, [0, 0, 0, 0, m, 0, 0, 0, 0, 0, m, 0, m, 0, m, m, m, m]);
        assert_eq!((made.outline, made.scale), (2, 1.0));
        assert_eq!(STANDARD.decode(&made.values).unwrap(), [0, 0, 255, 255]);
    }

    /// The shipped drapes have 5220 nodes.
    #[test]
    fn drapes_are_in_the_page_before_anything_else_and_what_is_not_is_told() {
        let plate = |fabric| DeflectedShape { fabric, scale: 200.0, ..shape(3000) };
        let strip = |fabric| DeflectedShape { fabric, ..shape(2000) };
        let drape = |fabric| DeflectedShape { fabric, is_drape: true, ..shape(5220) };
        let page = Shapes::of((0..20).flat_map(|at| [plate(at), strip(at), drape(at)]));
        let drapes = page.sheets.iter().filter(|sheet| sheet.is_drape).count();
        assert!(drapes >= 10, "{drapes}");
        assert_eq!(page.count(), 60);
        assert!(page.sheets[..drapes].iter().all(|sheet| sheet.is_drape));
        let mut remark = String::new();
        left_out(&mut remark, &page, 19);
        let here = page.sheets.iter().filter(|sheet| sheet.fabric == 19).count();
        assert!(remark.contains(&format!("{} of 3 deflected sheets of this fabric", 3 - here)), "{remark}");
        remark.clear();
        left_out(&mut remark, &Shapes::default(), 0);
        assert!(remark.is_empty());
    }

    #[test]
    fn a_page_shares_meshes_and_stays_small() {
        let page = Shapes::of([shape(4), shape(4), shape(6)].into_iter());
        assert_eq!(page.quads.len(), 2);
        assert_eq!(page.sheets.iter().map(|s| s.quads.as_str()).collect::<Vec<_>>(), ["0", "0", "1"]);
        let many = Shapes::of((0..100).map(|_| shape(3000)));
        assert!(!many.left_out.is_empty() && !many.sheets.is_empty());
        assert_eq!(many.count(), 100);
    }
}
