//! Meshes and fields as VTU files (VTK XML unstructured grid) for ParaView and PyVista.

use thiserror::Error;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};

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

/// Why there is no file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum VtuError {
    /// O020: a field has not one value for each node or cell.
    #[error(
        "O020 field `{name}` has {found} numbers, but {places} {kind} of {components} components were expected"
    )]
    Length {
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
    },
    /// O021: a quad names a node that is not there.
    #[error("O021 a quad names node {node}, but there are {nodes} nodes")]
    Node {
        /// The index, from 0.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
    /// O022: the VTK library refused.
    #[error("O022 the VTU file could not be made: {0}")]
    Encode(String),
}

/// The bytes of a VTU file: nodes n x 3 (m), quads of four node indices, fields at nodes and in cells.
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
    let data = Attributes {
        point: attributes(point_data, "nodes", nodes.len())?,
        cell: attributes(cell_data, "cells", quads.len())?,
    };
    let cells = Cells {
        cell_verts: VertexNumbers::XML {
            connectivity: quads.iter().flatten().map(|&n| u64::from(n)).collect(),
            offsets: (1..=quads.len() as u64).map(|i| 4 * i).collect(),
        },
        types: vec![CellType::Quad; quads.len()],
    };
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        // Fixed, so that the bytes do not depend on the machine.
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(UnstructuredGridPiece { points: nodes.concat().into(), cells, data }),
    };
    let numbers = 3 * nodes.len() + 5 * quads.len() + values(point_data) + values(cell_data);
    // Eight bytes each, in base64; then the tags.
    let mut bytes = Vec::with_capacity(numbers * 8 * 4 / 3 + 8192);
    file.write_xml(&mut bytes).map_err(|e| VtuError::Encode(e.to_string()))?;
    Ok(bytes)
}

fn values(fields: &[MeshField]) -> usize {
    fields.iter().map(|field| field.values.len()).sum()
}

fn attributes(fields: &[MeshField], kind: &'static str, places: usize) -> Result<Vec<Attribute>, VtuError> {
    fields
        .iter()
        .map(|field| {
            let (name, components) = (field.name, field.components);
            if components == 0 || field.values.len() != places * components {
                let found = field.values.len();
                return Err(VtuError::Length { name: name.into(), kind, places, components, found });
            }
            let attribute = match components {
                1 => Attribute::scalars(name, 1),
                3 => Attribute::vectors(name),
                // Fewer than a component count of u32 fits by far.
                n => Attribute::generic(name, n as u32),
            };
            Ok(attribute.with_data(field.values.to_vec()))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use vtkio::model::Piece;

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
    fn lists_that_do_not_fit_are_refused() {
        let short = MeshField { name: "w", components: 1, values: &[1.0] };
        assert!(matches!(vtu(&NODES, &QUADS, &[short], &[]), Err(VtuError::Length { kind: "nodes", .. })));
        assert!(matches!(vtu(&NODES, &QUADS, &[], &[short]), Err(VtuError::Length { kind: "cells", .. })));
        let missing = [[0, 1, 9, 3]];
        assert_eq!(vtu(&NODES, &missing, &[], &[]), Err(VtuError::Node { node: 9, nodes: 6 }));
    }
}
