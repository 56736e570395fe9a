//! Gmsh meshes: the ASCII form of MSH 4.1, quadrilaterals and triangles with named physical groups.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

use nalgebra::Point3;

use super::triangle::{FLAT, collapsed, height, turned_over};
use super::{MeshError, QuadMesh};
use crate::finding::Place;

/// Reads MSH 4.1 text; `scale` is the length of the file's unit (m), `path` names it in messages.
///
/// Each physical group with a name becomes a node set, whatever its dimension; `boundary` and `all`
/// are added unless the file has groups of these names. Lines and points only name sets; the lines of a group are
/// its edges. Nodes of geometry points that belong to no element (centres of arcs) are left out. A quad that has one
/// node twice in a row is a triangle. Elements are turned over until neighbours agree: a sheet in a plane z = const has the
/// normal +z, any other that of most of its elements.
///
/// # Errors
/// M011 with file and line: not this format, a damaged section, elements other than quads and triangles, elements of fewer
/// than three different nodes.
pub fn parse_gmsh(path: &Path, text: &str, scale: f64) -> Result<QuadMesh, MeshError> {
    let mut reader = Reader { path, lines: text.lines().enumerate(), line: 0 };
    let mut file = File::default();
    while let Some(section) = reader.next_section() {
        match section {
            "$MeshFormat" => reader.format()?,
            "$PhysicalNames" => reader.physical_names(&mut file)?,
            "$Entities" => reader.entities(&mut file)?,
            // Its elements belong to parts of surfaces and lines, whose groups would be lost.
            "$PartitionedEntities" => {
                return Err(reader.error(
                    "the mesh is split into partitions: save it without them (Mesh > Unpartition in Gmsh)"
                        .into(),
                ));
            }
            "$Nodes" => reader.nodes(&mut file, scale)?,
            "$Elements" => reader.elements(&mut file)?,
            _ => {}
        }
    }
    if file.quads.is_empty() {
        return Err(reader.error(
            "there is no quadrilateral and no triangle: mesh the surfaces (Mesh 2;) before saving".into(),
        ));
    }
    file.mesh(&reader)
}

#[derive(Default)]
struct File {
    /// (dimension, physical tag) to name.
    names: HashMap<(usize, i64), String>,
    /// (dimension, entity tag) to physical tags.
    physical: HashMap<(usize, i64), Vec<i64>>,
    nodes: HashMap<u64, Point3<f64>>,
    order: Vec<u64>,
    quads: Vec<[u64; 4]>,
    /// Named group to node tags.
    sets: BTreeMap<String, HashSet<u64>>,
    /// Named group to its lines, the lower tag first.
    lines: BTreeMap<String, HashSet<[u64; 2]>>,
}

struct Reader<'a> {
    path: &'a Path,
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    line: usize,
}

impl<'a> Reader<'a> {
    fn error(&self, message: String) -> MeshError {
        MeshError::File { place: Place::at(self.path, self.line, 0), message }
    }

    /// The next `$Section` header.
    fn next_section(&mut self) -> Option<&'a str> {
        for (i, text) in self.lines.by_ref() {
            self.line = i + 1;
            let text = text.trim();
            if text.starts_with('$') && !text.starts_with("$End") {
                return Some(text);
            }
        }
        None
    }

    fn row(&mut self) -> Result<&'a str, MeshError> {
        match self.lines.next() {
            Some((i, text)) if !text.starts_with('$') => {
                self.line = i + 1;
                Ok(text)
            }
            Some((i, _)) => {
                self.line = i + 1;
                Err(self.error("the section ends before all its rows: save the mesh again".into()))
            }
            None => Err(self.error("the file ends in the middle of a section: it was cut short".into())),
        }
    }

    fn numbers<T: std::str::FromStr>(&mut self, least: usize) -> Result<Vec<T>, MeshError> {
        let row = self.row()?;
        let numbers = row.split_whitespace().map(str::parse).collect::<Result<Vec<T>, _>>();
        match numbers {
            Ok(numbers) if numbers.len() >= least => Ok(numbers),
            Ok(numbers) => Err(self.error(format!("{} numbers in a row that needs {least}", numbers.len()))),
            Err(_) => Err(self.error(format!("`{row}` is not a row of numbers"))),
        }
    }

    fn format(&mut self) -> Result<(), MeshError> {
        let row = self.row()?;
        let mut words = row.split_whitespace();
        match (words.next(), words.next()) {
            (Some("4.1"), Some("0")) => Ok(()),
            (Some("4.1"), _) => {
                Err(self.error("the mesh is binary: save it as ASCII (Mesh.Binary = 0;)".into()))
            }
            (version, _) => Err(self.error(format!(
                "MSH version {}: save it as version 4.1 (Mesh.MshFileVersion = 4.1;)",
                version.unwrap_or("unknown")
            ))),
        }
    }

    fn physical_names(&mut self, file: &mut File) -> Result<(), MeshError> {
        let count = self.numbers::<usize>(1)?[0];
        for _ in 0..count {
            let row = self.row()?;
            let mut words = row.splitn(3, ' ');
            let numbers =
                (words.next().and_then(|w| w.parse().ok()), words.next().and_then(|w| w.parse().ok()));
            let name = words.next().map(|w| w.trim().trim_matches('"').to_string());
            let ((Some(dimension), Some(tag)), Some(name)) = (numbers, name) else {
                return Err(self.error(format!("`{row}` is not: dimension, tag, \"name\"")));
            };
            file.names.insert((dimension, tag), name);
        }
        Ok(())
    }

    fn entities(&mut self, file: &mut File) -> Result<(), MeshError> {
        let counts = self.numbers::<usize>(4)?;
        for (dimension, count) in counts.into_iter().take(4).enumerate() {
            // A point has one position, every other entity a bounding box.
            let start = if dimension == 0 { 4 } else { 7 };
            for _ in 0..count {
                let row = self.numbers::<f64>(start + 1)?;
                let physical = row[start] as usize;
                let Some(tags) = row[start + 1..].get(..physical) else {
                    return Err(self.error(format!("{physical} physical tags announced, fewer given")));
                };
                file.physical
                    .insert((dimension, row[0] as i64), tags.iter().map(|t| t.abs() as i64).collect());
            }
        }
        Ok(())
    }

    fn nodes(&mut self, file: &mut File, scale: f64) -> Result<(), MeshError> {
        let blocks = self.numbers::<usize>(4)?[0];
        for _ in 0..blocks {
            let count = self.numbers::<usize>(4)?[3];
            let tags = (0..count).map(|_| Ok(self.numbers::<u64>(1)?[0])).collect::<Result<Vec<_>, _>>()?;
            for tag in tags {
                let x = self.numbers::<f64>(3)?;
                file.nodes.insert(tag, Point3::new(x[0], x[1], x[2]) * scale);
                file.order.push(tag);
            }
        }
        Ok(())
    }

    fn elements(&mut self, file: &mut File) -> Result<(), MeshError> {
        let blocks = self.numbers::<usize>(4)?[0];
        for _ in 0..blocks {
            let head = self.numbers::<i64>(4)?;
            let (dimension, entity, kind) = (head[0] as usize, head[1], head[2]);
            let corners = match kind {
                15 => 1,
                1 => 2,
                2 => 3,
                3 => 4,
                _ => {
                    return Err(self.error(format!(
                        "elements of Gmsh type {kind}: 3-node triangles (type 2) and 4-node quads (type 3) make a sheet"
                    )));
                }
            };
            let groups: Vec<String> = file
                .physical
                .get(&(dimension, entity))
                .into_iter()
                .flatten()
                .filter_map(|tag| file.names.get(&(dimension, *tag)).cloned())
                .collect();
            for _ in 0..head[3] {
                let row = self.numbers::<u64>(corners + 1)?;
                let nodes = &row[1..=corners];
                if let Some(missing) = nodes.iter().find(|n| !file.nodes.contains_key(n)) {
                    return Err(
                        self.error(format!("element {} names node {missing}, which is not there", row[0]))
                    );
                }
                match *nodes {
                    [a, b, c] => file.quads.push(self.element(file, row[0], [a, b, c, c])?),
                    [a, b, c, d] => file.quads.push(self.element(file, row[0], [a, b, c, d])?),
                    _ => {}
                }
                for group in &groups {
                    file.sets.entry(group.clone()).or_default().extend(nodes);
                    if let [a, b] = *nodes {
                        file.lines.entry(group.clone()).or_default().insert([a.min(b), a.max(b)]);
                    }
                }
            }
        }
        Ok(())
    }

    /// The corners of an element that has three different ones at least, and an area if there are no more.
    fn element(&self, file: &File, tag: u64, corners: [u64; 4]) -> Result<[u64; 4], MeshError> {
        let Some(found @ [a, b, c, d]) = collapsed(corners) else {
            return Err(self.error(format!(
                "element {tag} has the nodes {corners:?}: an element needs three different ones, and has none twice but in \
                 a row; remove it"
            )));
        };
        if c == d && height([a, b, c].map(|n| file.nodes[&n])) < FLAT {
            return Err(self.error(format!(
                "element {tag} has its nodes {a}, {b} and {c} in a line, and so no area: move one of them or remove it"
            )));
        }
        Ok(found)
    }
}

impl File {
    fn mesh(self, reader: &Reader<'_>) -> Result<QuadMesh, MeshError> {
        let used: HashSet<u64> = self.quads.iter().flatten().copied().collect();
        let kept: Vec<u64> = self.order.iter().copied().filter(|t| used.contains(t)).collect();
        let index: HashMap<u64, u32> = kept.iter().enumerate().map(|(i, t)| (*t, i as u32)).collect();
        let mut mesh = QuadMesh {
            nodes: kept.iter().map(|t| self.nodes[t]).collect(),
            quads: self.quads.iter().map(|q| q.map(|t| index[&t])).collect(),
            ..QuadMesh::default()
        };
        for (name, tags) in self.sets {
            let mut nodes: Vec<u32> = tags.iter().filter_map(|t| index.get(t).copied()).collect();
            nodes.sort_unstable();
            if nodes.is_empty() {
                return Err(reader.error(format!("the group `{name}` has no node on the sheet")));
            }
            mesh.node_sets.insert(name, nodes);
        }
        mesh.orient();
        let [low, high] = mesh.bounds();
        // Coordinates of a plane may carry the rounding of another program.
        if high.z - low.z <= 1e-12 * (high - low).norm() {
            mesh.nodes.iter_mut().for_each(|n| n.z = low.z);
            for quad in 0..mesh.quads.len() {
                if super::normal(&mesh.corners(quad)).z < 0.0 {
                    mesh.quads[quad] = turned_over(&mesh.quads[quad]);
                }
            }
        }
        let mut taken = HashSet::new();
        let edges: Vec<[u32; 2]> =
            mesh.edges().filter(|&[a, b]| taken.insert([a.min(b), a.max(b)])).collect();
        for (name, lines) in self.lines {
            let on_line = |[a, b]: &[u32; 2]| {
                let [a, b] = [kept[*a as usize], kept[*b as usize]];
                lines.contains(&[a.min(b), a.max(b)])
            };
            mesh.edge_sets.insert(name, edges.iter().filter(|e| on_line(e)).copied().collect());
        }
        let mut boundary: Vec<u32> = mesh.boundary_edges().into_iter().flatten().collect();
        boundary.sort_unstable();
        boundary.dedup();
        mesh.node_sets.entry("boundary".into()).or_insert(boundary);
        let all = (0..mesh.nodes.len() as u32).collect();
        mesh.node_sets.entry("all".into()).or_insert(all);
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two quads of 1 x 1 in millimetres as Gmsh writes them, clockwise, with a stray centre point.
    const TWO: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 \"clamp line\"
2 2 \"cloth\"
$EndPhysicalNames
$Entities
1 1 1 0
9 5 5 0 0
1 0 0 0 0 1 0 1 1 2 1 -2
1 0 0 0 2 1 0 1 2 0
$EndEntities
$Nodes
2 7 1 9
0 9 0 1
9
5 5 0
2 1 0 6
1
2
3
4
5
6
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
2 3 1 3
1 1 1 1
1 1 4
2 1 3 2
2 1 4 5 2
3 2 5 6 3
$EndElements
";

    fn parse(text: &str) -> Result<QuadMesh, MeshError> {
        parse_gmsh(Path::new("part.msh"), text, 1e-3)
    }

    #[test]
    fn quads_groups_units_and_orientation() {
        let mesh = parse(TWO).unwrap();
        mesh.check().unwrap();
        assert!(mesh.is_flat(), "clockwise quads are turned over");
        assert_eq!((mesh.nodes.len(), mesh.quads.len()), (6, 2));
        assert_eq!(mesh.nodes[5], Point3::new(2e-3, 1e-3, 0.0));
        assert_eq!(mesh.set("clamp line").unwrap(), [0, 3]);
        assert_eq!(mesh.set("cloth").unwrap().len(), 6);
        assert_eq!(mesh.set("boundary").unwrap().len(), 6);
        // Node 3 follows node 0 when the quad is counter-clockwise.
        assert_eq!(mesh.set_edges("clamp line").unwrap(), [[3, 0]]);
        assert_eq!(mesh.set_edges("boundary").unwrap().len(), 6);
        // One of the two upside down, and z with the rounding of another program.
        let mixed =
            parse(&TWO.replace("3 2 5 6 3", "3 3 6 5 2").replace("2 1 0\n$", "2 1 1e-17\n$")).unwrap();
        assert!(mixed.is_flat() && mixed.opposed().is_none());
    }

    /// The nodes of two lines with one element between them are neighbours, but that edge is none of theirs.
    #[test]
    fn the_edges_of_a_group_are_its_lines() {
        let nodes = "0 0 0\n1 0 0\n2 0 0\n3 0 0\n0 1 0\n1 1 0\n2 1 0\n3 1 0";
        let text = TWO
            .replace(
                "2 7 1 9\n0 9 0 1\n9\n5 5 0\n2 1 0 6\n1\n2\n3\n4\n5\n6\n",
                "1 8 1 8\n2 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n",
            )
            .replace("0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0", nodes)
            .replace(
                "2 3 1 3\n1 1 1 1\n1 1 4\n2 1 3 2\n2 1 4 5 2\n3 2 5 6 3",
                "2 5 1 5\n1 1 1 2\n1 1 2\n2 3 4\n2 1 3 3\n3 1 2 6 5\n4 2 3 7 6\n5 3 4 8 7",
            );
        let mesh = parse(&text).unwrap();
        assert_eq!(mesh.set("clamp line").unwrap(), [0, 1, 2, 3]);
        assert_eq!(mesh.set_edges("clamp line").unwrap(), [[0, 1], [2, 3]]);
    }

    /// A triangle beside a quad, and the same as quads with a node twice, whichever it is; clockwise all.
    #[test]
    fn triangles_are_read_as_such_and_as_quads_with_a_node_twice() {
        let mixed = TWO.replace(
            "2 3 1 3\n1 1 1 1\n1 1 4\n2 1 3 2\n2 1 4 5 2\n3 2 5 6 3",
            "3 4 1 4\n1 1 1 1\n1 1 4\n2 1 3 1\n2 1 4 5 2\n2 1 2 2\n3 2 5 6\n4 2 6 3",
        );
        let mesh = parse(&mixed).unwrap();
        mesh.check().unwrap();
        assert!(mesh.is_flat(), "clockwise triangles are turned over");
        assert_eq!((mesh.quads.len(), mesh.triangles()), (3, 2));
        assert_eq!(mesh.quads[1..], [[4, 1, 5, 5], [5, 1, 2, 2]]);
        assert_eq!(mesh.set_edges("boundary").unwrap().len(), 6);
        assert_eq!(mesh.set_edges("clamp line").unwrap(), [[3, 0]]);
        for rows in ["3 2 5 6 6\n4 2 6 3 3", "3 2 2 5 6\n4 3 2 6 3", "3 2 5 5 6\n4 2 6 6 3"] {
            let quads = mixed.replace("2 1 2 2\n3 2 5 6\n4 2 6 3", &format!("2 1 3 2\n{rows}"));
            let quads = parse(&quads).unwrap();
            assert_eq!((quads.quads.len(), quads.triangles()), (3, 2), "{rows}");
            assert!(quads.is_flat() && quads.check().is_ok());
            assert_eq!(quads.boundary_edges().len(), 6);
        }
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let message = |from: &str, to: &str| parse(&TWO.replace(from, to)).unwrap_err().to_string();
        assert!(message("4.1 0 8", "2.2 0 8").starts_with("part.msh:2: M011"));
        assert!(message("4.1 0 8", "4.1 1 8").contains("binary"));
        assert!(
            message("2 1 3 2\n", "2 1 9 2\n").contains("3-node triangles (type 2) and 4-node quads (type 3)")
        );
        for corners in ["5 6 5 3", "5 5 6 6", "5 5 5 6"] {
            let two = message("3 2 5 6 3", &format!("3 {corners}"));
            assert!(two.starts_with("part.msh:40: M011") && two.contains("three different ones"), "{two}");
        }
        let line = message("3 2 5 6 3", "3 2 1 3 3");
        assert!(line.starts_with("part.msh:40: M011") && line.contains("in a line"), "{line}");
        assert!(message("1 4 5 2", "1 4 5 8").contains("node 8"));
        assert!(message("1 1 0\n2 1 0", "1 x 0\n2 1 0").contains("`1 x 0`"));
        let cut = &TWO[..TWO.find("3 2 5 6 3").unwrap()];
        assert!(parse(cut).unwrap_err().to_string().contains("cut short"));
        assert!(message("$EndEntities", "$EndEntities\n$PartitionedEntities").contains("partitions"));
        assert!(parse("").is_err());
    }
}
