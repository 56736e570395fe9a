//! A deflected sheet as a glTF file (binary, `.glb`), for Blender and browsers: coloured by how far it moved, with its
//! outline before.
//!
//! glTF 2.0, Khronos Group 2021: metres, y upwards, colours linear.

use std::borrow::Cow;

use gltf::binary::{Glb, Header};
use nalgebra::Vector3;
use serde_json::{Value, json};

use super::chart::value_color;
use crate::finding::errors;
use crate::mesh::{is_triangle, nodes_of};

errors! {
    /// Why there is no file.
    #[derive(Clone, Debug, PartialEq)]
    pub enum GltfError {
        /// O023: the lists do not fit together, or have a number that is none.
        "O023" Inconsistent {
            /// What does not fit.
            problem: String,
        } = "the glTF file could not be made: {problem}";
    }
}

/// A sheet before and after (m, z upwards).
#[derive(Clone, Debug)]
pub struct DeflectedSheet<'a> {
    /// What it is called.
    pub name: String,
    /// What is said of it beside that, such as the fabric and where its data come from.
    pub about: String,
    /// Nodes before.
    pub rest: &'a [[f64; 3]],
    /// Displacement of each node.
    pub displacement: &'a [[f64; 3]],
    /// Corner nodes of each quad.
    pub quads: &'a [[u32; 4]],
    /// Edges that belong to one quad.
    pub outline: &'a [[u32; 2]],
}

/// Smallest and largest part of the size of a sheet that is shown as it is.
const SHOWN: [f64; 2] = [0.02, 1.0];
/// Part of the size of a sheet that other deflections are brought near.
const BROUGHT_TO: f64 = 0.1;

impl DeflectedSheet<'_> {
    /// Whether the lists fit together and all numbers are such.
    ///
    /// # Errors
    /// [`GltfError::Inconsistent`].
    pub fn checked(&self) -> Result<(), GltfError> {
        let nodes = self.rest.len();
        let problem = if self.displacement.len() != nodes {
            format!("{} displacements of {nodes} nodes", self.displacement.len())
        } else if self.quads.is_empty() {
            "there is no quad".into()
        } else if self
            .quads
            .as_flattened()
            .iter()
            .chain(self.outline.as_flattened())
            .any(|n| *n as usize >= nodes)
        {
            format!("a quad or an edge names a node that is none of {nodes}")
        } else if !self.rest.iter().chain(self.displacement).flatten().all(|v| v.is_finite()) {
            "a position is no number".into()
        } else {
            return Ok(());
        };
        Err(GltfError::Inconsistent { problem })
    }

    /// Length of the displacement of each node.
    pub fn displacement_magnitudes(&self) -> Vec<f64> {
        self.displacement.iter().map(|u| Vector3::from(*u).norm()).collect()
    }

    /// The largest extent of the sheet before.
    pub fn size(&self) -> f64 {
        let extent = |k: usize| {
            let along = || self.rest.iter().map(|p| p[k]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        };
        (0..3).map(extent).fold(0.0, f64::max)
    }

    /// By what displacements are multiplied to be seen: 1 where they are between 2 % and 100 % of the size of the sheet,
    /// otherwise 1, 2 or 5 times a power of ten, at which the largest is near a tenth of it.
    pub fn scale_factor(&self) -> f64 {
        let largest = self.displacement_magnitudes().into_iter().fold(0.0, f64::max);
        let part = largest / self.size();
        if largest == 0.0 || !part.is_finite() || (SHOWN[0]..=SHOWN[1]).contains(&part) {
            return 1.0;
        }
        let wanted = BROUGHT_TO / part;
        let decade = 10f64.powf(wanted.log10().floor());
        let digit = [5.0, 2.0, 1.0].into_iter().find(|d| d * decade <= wanted * (1.0 + 1e-9)).unwrap_or(1.0);
        digit * decade
    }

    /// Where the nodes are shown.
    pub fn shown(&self) -> Vec<[f64; 3]> {
        let by = self.scale_factor();
        let place = |(p, u): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| p[k] + by * u[k]);
        self.rest.iter().zip(self.displacement).map(place).collect()
    }
}

/// What the accessors of a file are of.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// Numbers of the format.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const UNSIGNED_SHORT: u32 = 5123;
const LINES: u32 = 1;
const TRIANGLES: u32 = 4;
const OF_VERTICES: u32 = 34962;
const OF_INDICES: u32 = 34963;

impl Buffer {
    /// Adds a list and says its number. Every list is a multiple of four bytes.
    fn add(&mut self, bytes: &[u8], target: u32, mut accessor: Value) -> usize {
        let view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target });
        accessor["bufferView"] = json!(self.views.len());
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn vectors(&mut self, vectors: &[[f32; 3]]) -> usize {
        let bytes: Vec<u8> = vectors.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
        let bound = |pick: fn(f32, f32) -> f32, from: f32| {
            vectors.iter().fold([from; 3], |a, v| [0, 1, 2].map(|k| pick(a[k], v[k])))
        };
        let (low, high) = (bound(f32::min, f32::INFINITY), bound(f32::max, f32::NEG_INFINITY));
        let accessor = json!({ "componentType": FLOAT, "count": vectors.len(), "type": "VEC3", "min": low, "max": high });
        self.add(&bytes, OF_VERTICES, accessor)
    }

    fn colors(&mut self, colors: &[[u16; 4]]) -> usize {
        let bytes: Vec<u8> = colors.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
        let accessor = json!({ "componentType": UNSIGNED_SHORT, "normalized": true, "count": colors.len(), "type": "VEC4" });
        self.add(&bytes, OF_VERTICES, accessor)
    }

    fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|v| v.to_le_bytes()).collect();
        let accessor = json!({ "componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR" });
        self.add(&bytes, OF_INDICES, accessor)
    }
}

/// The bytes of the file. The scale factor, the largest displacement and its unit are in `extras` of the sheet.
///
/// # Errors
/// [`GltfError`] if lists do not fit together.
pub fn glb(sheet: &DeflectedSheet) -> Result<Vec<u8>, GltfError> {
    sheet.checked()?;
    let (shown, magnitudes, by) = (sheet.shown(), sheet.displacement_magnitudes(), sheet.scale_factor());
    let largest = magnitudes.iter().copied().fold(0.0, f64::max);
    let mut buffer = Buffer::default();
    let position = buffer.vectors(&single(&shown));
    let normal = buffer.vectors(&single(&normals(&shown, sheet.quads)));
    let colors: Vec<[u16; 4]> = magnitudes.iter().map(|m| linear(value_color(share(*m, largest)))).collect();
    let color = buffer.colors(&colors);
    let faces = buffer.indices(&sheet.quads.iter().flat_map(faces).flatten().collect::<Vec<_>>());
    let before = buffer.vectors(&single(sheet.rest));
    let edges = buffer.indices(sheet.outline.as_flattened());
    let attributes = json!({ "POSITION": position, "NORMAL": normal, "COLOR_0": color });
    let mut meshes = vec![json!({
        "name": "deflected",
        "primitives": [{ "attributes": attributes, "indices": faces, "mode": TRIANGLES, "material": 0 }],
    })];
    if !sheet.outline.is_empty() {
        meshes.push(json!({
            "name": "outline before",
            "primitives": [{ "attributes": { "POSITION": before }, "indices": edges, "mode": LINES, "material": 1 }],
        }));
    }
    let extras = json!({
        "about": sheet.about,
        "quantity": "length of the displacement",
        "unit": "m",
        "largest": largest,
        "scale_factor": by,
        "note": "displacements are multiplied by scale_factor; colours are of the displacements themselves, from 0 to largest",
    });
    // z is upwards here, and y there.
    let turned = [-std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2];
    let children: Vec<usize> = (1..=meshes.len()).collect();
    let mut nodes =
        vec![json!({ "name": sheet.name, "rotation": turned, "children": children, "extras": extras })];
    nodes.extend(meshes.iter().enumerate().map(|(k, mesh)| json!({ "name": mesh["name"], "mesh": k })));
    let document = json!({
        "asset": { "version": "2.0", "generator": concat!("kesf ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [
            { "name": "sheet", "doubleSided": true, "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.9 } },
            { "name": "outline", "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.1, 0.1, 1.0], "metallicFactor": 0.0 } },
        ],
        "buffers": [{ "byteLength": buffer.bytes.len() }],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    });
    let text =
        serde_json::to_vec(&document).map_err(|e| GltfError::Inconsistent { problem: e.to_string() })?;
    let header = Header { magic: *b"glTF", version: 2, length: 0 };
    let file = Glb { header, json: Cow::Owned(text), bin: Some(Cow::Owned(buffer.bytes)) };
    file.to_vec().map_err(|e| GltfError::Inconsistent { problem: e.to_string() })
}

/// Part of the largest, 0 to 1.
pub(crate) fn share(value: f64, largest: f64) -> f64 {
    if largest > 0.0 { value / largest } else { 0.0 }
}

fn single(vectors: &[[f64; 3]]) -> Vec<[f32; 3]> {
    vectors.iter().map(|v| v.map(|x| x as f32)).collect()
}

/// The triangles of a quad: two, or the one that it is.
fn faces(quad: &[u32; 4]) -> impl Iterator<Item = [u32; 3]> {
    let [a, b, c, d] = *quad;
    let count = if is_triangle(quad) { 1 } else { 2 };
    [[a, b, c], [a, c, d]].into_iter().take(count)
}

/// Unit normals of nodes, means over the quads around them.
fn normals(nodes: &[[f64; 3]], quads: &[[u32; 4]]) -> Vec<[f64; 3]> {
    let mut sums = vec![Vector3::zeros(); nodes.len()];
    for quad in quads {
        let [a, b, c, d] = quad.map(|n| Vector3::from(nodes[n as usize]));
        let normal = (c - a).cross(&(d - b));
        nodes_of(quad).iter().for_each(|n| sums[*n as usize] += normal);
    }
    sums.iter().map(|n| n.try_normalize(0.0).unwrap_or_else(Vector3::z).into()).collect()
}

/// A colour of a screen (sRGB, IEC 61966-2-1) as light, opaque.
fn linear(color: [u8; 3]) -> [u16; 4] {
    let [r, g, b] = color.map(|part| {
        let c = f64::from(part) / 255.0;
        let light = if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
        (light * f64::from(u16::MAX)).round() as u16
    });
    [r, g, b, u16::MAX]
}

#[cfg(test)]
mod tests {
    use super::*;

    const REST: [[f64; 3]; 6] = [
        [0.0, 0.0, 0.0],
        [0.1, 0.0, 0.0],
        [0.2, 0.0, 0.0],
        [0.0, 0.1, 0.0],
        [0.1, 0.1, 0.0],
        [0.2, 0.1, 0.0],
    ];
    const QUADS: [[u32; 4]; 2] = [[0, 1, 4, 3], [1, 2, 5, 4]];
    const OUTLINE: [[u32; 2]; 6] = [[0, 1], [1, 2], [2, 5], [5, 4], [4, 3], [3, 0]];

    fn sheet(displacement: &[[f64; 3]]) -> DeflectedSheet<'_> {
        DeflectedSheet {
            name: "strip".into(),
            about: "synthetic".into(),
            rest: &REST,
            displacement,
            quads: &QUADS,
            outline: &OUTLINE,
        }
    }

    #[test]
    fn what_cannot_be_seen_is_enlarged_by_a_round_factor_and_what_can_is_as_it_is() {
        let by = |w: f64| sheet(&[[0.0, 0.0, w]; 6]).scale_factor();
        // The sheet is 0.2 m long: a tenth is 20 mm.
        assert_eq!([by(0.0), by(0.03), by(0.2), by(0.004)], [1.0; 4]);
        assert_eq!(by(1e-3), 20.0);
        assert!((by(3.1e-9) / 5e6 - 1.0).abs() < 1e-12);
        // A linear solve that leads beyond the sheet: 0.02 / 3 is 0.0066.
        assert!((by(3.0) / 0.005 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_file_is_read_by_another_library() {
        let displacement = [0.0, 0.0, 1e-3, 0.0, 0.0, 2e-3].map(|w| [0.0, 0.0, w]);
        let bytes = glb(&sheet(&displacement)).unwrap();
        assert_eq!(bytes, glb(&sheet(&displacement)).unwrap(), "same data, same bytes");
        // It checks the whole document.
        let file = gltf::Gltf::from_slice(&bytes).unwrap();
        let blob = file.blob.as_deref().unwrap();
        let meshes: Vec<_> = file.meshes().collect();
        let primitive = meshes[0].primitives().next().unwrap();
        let (_, accessor) =
            primitive.attributes().find(|(kind, _)| *kind == gltf::Semantic::Positions).unwrap();
        let view = accessor.view().unwrap();
        let last = view.offset() + 5 * 12;
        let z = f32::from_le_bytes(blob[last + 8..last + 12].try_into().unwrap());
        // 2 mm of a 0.2 m strip are below 2 %: ten times as much is shown.
        assert!((z - 0.02).abs() < 1e-7, "{z}");
        assert_eq!(primitive.indices().unwrap().count(), 12);
        assert_eq!(meshes[1].primitives().next().unwrap().mode(), gltf::mesh::Mode::Lines);
        let text: Value = serde_json::from_slice(&Glb::from_slice(&bytes).unwrap().json).unwrap();
        assert_eq!(text["nodes"][0]["extras"]["scale_factor"], 10.0);
        assert_eq!(text["nodes"][0]["extras"]["largest"], 2e-3);
    }

    #[test]
    fn a_triangle_is_one_face_and_has_the_normal_of_its_plane() {
        let quads = [[0, 1, 4, 3], [1, 2, 5, 5]];
        let bytes = glb(&DeflectedSheet { quads: &quads, ..sheet(&[[0.0; 3]; 6]) }).unwrap();
        let file = gltf::Gltf::from_slice(&bytes).unwrap();
        let faces = file.meshes().next().unwrap().primitives().next().unwrap().indices().unwrap();
        assert_eq!(faces.count(), 9);
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(normals(&corners, &[[0, 1, 2, 2]]), [[0.0, -1.0, 0.0]; 3]);
    }

    #[test]
    fn lists_that_do_not_fit_are_refused() {
        assert!(glb(&sheet(&[[0.0; 3]; 5])).is_err());
        assert!(glb(&sheet(&[[f64::NAN; 3]; 6])).is_err());
        assert!(glb(&DeflectedSheet { quads: &[[0, 1, 2, 9]], ..sheet(&[[0.0; 3]; 6]) }).is_err());
        assert!(glb(&DeflectedSheet { quads: &[], ..sheet(&[[0.0; 3]; 6]) }).is_err());
    }
}
