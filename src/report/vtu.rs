//! Meshes and fields as VTU files (VTK XML unstructured grid) for ParaView and PyVista.

use crate::finding::errors;
use crate::mesh::{is_triangle, nodes_of};
use std::io;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use quick_xml::Writer;
use quick_xml::events::BytesText;

/// Values at the nodes or in the cells of a mesh (SI).
#[derive(Clone, Copy, Debug)]
pub struct MeshField<'a> {
    /// Name in the file, e.g. `displacement`.
    pub name: &'a str,
    /// Components of one value: 1 for a scalar, 3 for a vector.
    pub components: usize,
    /// All components of the first node (or cell), then of the second ...
    pub values: &'a [f64],
}

errors! {
    /// Why there is no file.
    #[derive(Clone, Debug, PartialEq)]
    pub enum VtuError {
        /// O020: a field has not one value for each node or cell.
        "O020" Length {
            /// The field.
            name: String,
            /// `nodes` or `cells`.
            kind: &'static str,
            /// How many nodes or cells there are.
            places: usize,
            /// Components that the field claims.
            components: usize,
            /// How many numbers it has.
            found: usize,
        } = "field `{name}` has {found} numbers, but {places} {kind} of {components} components were expected";
        /// O021: a quad names a node that is not there.
        "O021" Node {
            /// The index, from 0.
            node: u32,
            /// Number of nodes.
            nodes: usize,
        } = "a quad names node {node}, but there are {nodes} nodes";
        /// O022: the XML library refused.
        "O022" Encode {
            /// What it said.
            problem: String,
        } = "the VTU file could not be made: {problem}";
    }
}

/// The bytes of a VTU file: nodes n x 3 (m), quads of four node indices (triangles `[a, b, c, c]`), fields at nodes and in cells.
///
/// # Errors
/// [`VtuError`] if lists do not fit together.
pub fn vtu(
    nodes: &[[f64; 3]],
    quads: &[[u32; 4]],
    point_data: &[MeshField],
    cell_data: &[MeshField],
) -> Result<Vec<u8>, VtuError> {
    if let Some(&node) = quads.iter().flatten().find(|&&n| n as usize >= nodes.len()) {
        return Err(VtuError::Node { node, nodes: nodes.len() });
    }
    for (fields, kind, places) in [(point_data, "nodes", nodes.len()), (cell_data, "cells", quads.len())] {
        fields.iter().try_for_each(|field| field.fits(kind, places))?;
    }
    document(nodes, quads, point_data, cell_data).map_err(|e| VtuError::Encode { problem: e.to_string() })
}

impl MeshField<'_> {
    fn fits(&self, kind: &'static str, places: usize) -> Result<(), VtuError> {
        let (components, found) = (self.components, self.values.len());
        if components > 0 && found == places * components {
            return Ok(());
        }
        Err(VtuError::Length { name: self.name.into(), kind, places, components, found })
    }
}

/// Numbers of a triangle and of a quad among the cell types of VTK.
const VTK_TRIANGLE: u8 = 5;
const VTK_QUAD: u8 = 9;

fn cell_type(quad: &[u32; 4]) -> u8 {
    if is_triangle(quad) { VTK_TRIANGLE } else { VTK_QUAD }
}

/// Where the nodes of each cell end in the list of all.
fn ends(quads: &[[u32; 4]]) -> Vec<u32> {
    let mut end = 0;
    let mut ends = Vec::with_capacity(quads.len());
    for quad in quads {
        end += nodes_of(quad).len() as u32;
        ends.push(end);
    }
    ends
}

fn document(
    nodes: &[[f64; 3]],
    quads: &[[u32; 4]],
    point_data: &[MeshField],
    cell_data: &[MeshField],
) -> io::Result<Vec<u8>> {
    let numbers: usize = point_data.iter().chain(cell_data).map(|field| field.values.len()).sum();
    let numbers = 3 * nodes.len() + 4 * quads.len() + numbers;
    // Eight bytes each, in base64; then the tags.
    let mut writer = Writer::new(Vec::with_capacity(numbers * 8 * 4 / 3 + 8192));
    // Little-endian on every machine, so that the bytes do not depend on it.
    let file = [
        ("type", "UnstructuredGrid"),
        ("version", "1.0"),
        ("byte_order", "LittleEndian"),
        ("header_type", "UInt64"),
    ];
    writer.create_element("VTKFile").with_attributes(file).write_inner_content(|writer| {
        inside(writer, "UnstructuredGrid", |writer| {
            let piece =
                [("NumberOfPoints", nodes.len().to_string()), ("NumberOfCells", quads.len().to_string())];
            let piece = piece.iter().map(|(name, number)| (*name, number.as_str()));
            writer.create_element("Piece").with_attributes(piece).write_inner_content(|writer| {
                fields(writer, "PointData", point_data)?;
                fields(writer, "CellData", cell_data)?;
                inside(writer, "Points", |writer| array(writer, "Points", 3, nodes.as_flattened()))?;
                inside(writer, "Cells", |writer| {
                    let nodes: Vec<u32> = quads.iter().flat_map(nodes_of).copied().collect();
                    array(writer, "connectivity", 1, &nodes)?;
                    array(writer, "offsets", 1, &ends(quads))?;
                    let types: Vec<u8> = quads.iter().map(cell_type).collect();
                    array(writer, "types", 1, &types)
                })
            })?;
            Ok(())
        })
    })?;
    Ok(writer.into_inner())
}

fn inside(
    writer: &mut Writer<Vec<u8>>,
    tag: &str,
    content: impl FnOnce(&mut Writer<Vec<u8>>) -> io::Result<()>,
) -> io::Result<()> {
    writer.create_element(tag).write_inner_content(content).map(drop)
}

/// The fields of one kind; the first vector is what a program warps the mesh by unless told otherwise.
fn fields(writer: &mut Writer<Vec<u8>>, tag: &str, fields: &[MeshField]) -> io::Result<()> {
    let vector = fields.iter().find(|field| field.components == 3).map(|field| ("Vectors", field.name));
    writer
        .create_element(tag)
        .with_attributes(vector)
        .write_inner_content(|writer| {
            fields.iter().try_for_each(|f| array(writer, f.name, f.components, f.values))
        })
        .map(drop)
}

/// Numbers that VTK has a name for.
trait Number: Copy {
    const TYPE: &'static str;
    fn append(self, bytes: &mut Vec<u8>);
}

impl Number for f64 {
    const TYPE: &'static str = "Float64";
    fn append(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_le_bytes());
    }
}

impl Number for u32 {
    /// Cells of VTK have signed numbers; no mesh has 2³¹ nodes.
    const TYPE: &'static str = "Int32";
    fn append(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_le_bytes());
    }
}

impl Number for u8 {
    const TYPE: &'static str = "UInt8";
    fn append(self, bytes: &mut Vec<u8>) {
        bytes.push(self);
    }
}

/// An array of values of some components: their length in bytes and the bytes, in base64.
fn array<T: Number>(
    writer: &mut Writer<Vec<u8>>,
    name: &str,
    components: usize,
    values: &[T],
) -> io::Result<()> {
    let length = size_of_val(values);
    let mut bytes = Vec::with_capacity(8 + length);
    bytes.extend_from_slice(&(length as u64).to_le_bytes());
    values.iter().for_each(|value| value.append(&mut bytes));
    writer
        .create_element("DataArray")
        .with_attribute(("type", T::TYPE))
        .with_attribute(("Name", name))
        .with_attribute(("NumberOfComponents", components.to_string().as_str()))
        .with_attribute(("format", "binary"))
        .write_text_content(BytesText::from_escaped(STANDARD.encode(&bytes)))
        .map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use vtkio::model::{Attribute, CellType, DataSet, Piece, Vtk};

    const NODES: [[f64; 3]; 6] =
        [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 0.25]];
    const QUADS: [[u32; 4]; 2] = [[0, 1, 4, 3], [1, 2, 5, 4]];

    fn fields() -> ([f64; 18], [f64; 6], [f64; 12]) {
        let mut u = [0.0; 18];
        u.iter_mut().enumerate().for_each(|(i, v)| *v = 0.1 * i as f64);
        let mut m = [0.0; 12];
        m.iter_mut().enumerate().for_each(|(i, v)| *v = -(i as f64) / 3.0);
        (u, [1.0, -2.0, 3.0, 4.5, 1e-300, 6.0], m)
    }

    fn file() -> Vec<u8> {
        let (u, t, m) = fields();
        let points = [
            MeshField { name: "displacement", components: 3, values: &u },
            MeshField { name: "w", components: 1, values: &t },
        ];
        vtu(&NODES, &QUADS, &points, &[MeshField { name: "moment", components: 6, values: &m }]).unwrap()
    }

    #[test]
    fn the_file_reads_back_to_the_same_numbers() {
        let bytes = file();
        assert_eq!(bytes, file(), "same data, same bytes");
        if let Some(folder) = std::env::var_os("KESF_GALLERY") {
            std::fs::write(std::path::Path::new(&folder).join("two.vtu"), &bytes).unwrap();
        }
        let vtk = Vtk::parse_xml(bytes.as_slice()).unwrap();
        let DataSet::UnstructuredGrid { pieces, .. } = vtk.data else { panic!("not an unstructured grid") };
        let Piece::Inline(piece) = &pieces[0] else { panic!("not inline") };
        assert_eq!(piece.points.cast_into::<f64>().unwrap(), NODES.concat());
        assert_eq!(piece.cells.types, [CellType::Quad, CellType::Quad]);
        let (connectivity, offsets) = piece.cells.cell_verts.clone().into_xml();
        assert_eq!(connectivity, [0, 1, 4, 3, 1, 2, 5, 4]);
        assert_eq!(offsets, [4, 8]);
        let numbers = |attribute: &Attribute| match attribute {
            Attribute::DataArray(a) => (a.name.clone(), a.data.cast_into::<f64>().unwrap()),
            Attribute::Field { .. } => panic!("not an array"),
        };
        let (u, t, m) = fields();
        assert_eq!(numbers(&piece.data.point[0]), ("displacement".into(), u.to_vec()));
        assert_eq!(numbers(&piece.data.point[1]), ("w".into(), t.to_vec()));
        assert_eq!(numbers(&piece.data.cell[0]), ("moment".into(), m.to_vec()));
    }

    #[test]
    fn triangles_are_cells_of_three_nodes() {
        let cells = [[0, 1, 4, 3], [1, 2, 5, 5], [5, 4, 1, 1]];
        let bytes = vtu(&NODES, &cells, &[], &[]).unwrap();
        let DataSet::UnstructuredGrid { pieces, .. } = Vtk::parse_xml(bytes.as_slice()).unwrap().data else {
            panic!("not an unstructured grid")
        };
        let Piece::Inline(piece) = &pieces[0] else { panic!("not inline") };
        assert_eq!(piece.cells.types, [CellType::Quad, CellType::Triangle, CellType::Triangle]);
        let (connectivity, offsets) = piece.cells.cell_verts.clone().into_xml();
        assert_eq!(connectivity, [0, 1, 4, 3, 1, 2, 5, 5, 4, 1]);
        assert_eq!(offsets, [4, 7, 10]);
    }

    #[test]
    fn lists_that_do_not_fit_are_refused() {
        let short = MeshField { name: "w", components: 1, values: &[1.0] };
        assert!(matches!(vtu(&NODES, &QUADS, &[short], &[]), Err(VtuError::Length { kind: "nodes", .. })));
        assert!(matches!(vtu(&NODES, &QUADS, &[], &[short]), Err(VtuError::Length { kind: "cells", .. })));
        let missing = [[0, 1, 9, 3]];
        assert_eq!(vtu(&NODES, &missing, &[], &[]), Err(VtuError::Node { node: 9, nodes: 6 }));
    }
}
