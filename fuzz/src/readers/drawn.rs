//! Meshes, drawings and pictures.

use std::fmt::Write;
use std::path::Path;

use kesf::instrument::picture::silhouette;
use kesf::mesh::{Drawing, DrawingOptions, QuadMesh, parse_gmsh};

use crate::{Damage, Target, corpus};

/// Meshes of Gmsh.
pub fn gmsh() -> Target {
    Target { seeds: corpus::folder("gmsh"), damaged: Damage::of, size: <[u8]>::len, holds: gmsh_holds }
}

fn gmsh_holds(bytes: &[u8]) -> bool {
    let path = Path::new("part.msh");
    match parse_gmsh(path, &String::from_utf8_lossy(bytes), 1e-3) {
        Ok(mesh) => {
            assert!(mesh.quads.iter().flatten().all(|n| (*n as usize) < mesh.nodes.len()));
            assert!(mesh.node_sets.values().flatten().all(|n| (*n as usize) < mesh.nodes.len()));
            if mesh.check().is_ok() {
                let text = written(&mesh);
                let again = parse_gmsh(path, &text, 1.0).unwrap_or_else(|e| panic!("{e}\n{text}"));
                assert_eq!((&again.nodes, &again.quads), (&mesh.nodes, &mesh.quads), "{text}");
            }
            true
        }
        Err(error) => {
            assert!(error.to_string().contains("part.msh"), "{error}");
            false
        }
    }
}

/// A mesh as Gmsh writes it, without its groups.
fn written(mesh: &QuadMesh) -> String {
    let (nodes, quads) = (mesh.nodes.len(), mesh.quads.len());
    let mut text =
        format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {nodes} 1 {nodes}\n2 1 0 {nodes}\n");
    for n in 1..=nodes {
        let _ = writeln!(text, "{n}");
    }
    for p in &mesh.nodes {
        let _ = writeln!(text, "{:?} {:?} {:?}", p.x, p.y, p.z);
    }
    let _ = write!(text, "$EndNodes\n$Elements\n1 {quads} 1 {quads}\n2 1 3 {quads}\n");
    for (i, quad) in mesh.quads.iter().enumerate() {
        let [a, b, c, d] = quad.map(|n| n + 1);
        let _ = writeln!(text, "{} {a} {b} {c} {d}", i + 1);
    }
    text + "$EndElements\n"
}

/// Drawings of pieces.
pub fn drawing() -> Target {
    Target { seeds: corpus::folder("drawing"), damaged: Damage::of, size: <[u8]>::len, holds: drawing_holds }
}

fn drawing_holds(bytes: &[u8]) -> bool {
    let is_svg = bytes.trim_ascii_start().starts_with(b"<");
    let path = Path::new(if is_svg { "part.svg" } else { "part.dxf" });
    // The unit of the case counts where the file does not say its own.
    let options = [None, Some(1e-2)].map(|unit| DrawingOptions { unit, layer: None });
    let read = options.iter().map(|o| Drawing::parse(path, bytes, o)).find_map(Result::ok);
    let drawing = match read.map_or_else(|| Drawing::parse(path, bytes, &options[0]), Ok) {
        Ok(drawing) => drawing,
        Err(error) => {
            assert!(error.to_string().contains("part."), "{error}");
            return false;
        }
    };
    let [width, height] = drawing.size();
    match drawing.mesh(width.max(height) / 12.0) {
        Ok(mesh) => {
            mesh.check().unwrap_or_else(|e| panic!("{e}"));
            assert!(mesh.is_flat() && mesh.set("boundary").is_ok_and(|set| !set.is_empty()));
            // No node lies beyond what was drawn.
            for (axis, drawn) in [width, height].into_iter().enumerate() {
                let places = mesh.nodes.iter().map(|p| p[axis]);
                let (low, high) = places.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
                assert!(high - low <= drawn * (1.0 + 1e-6), "{low} to {high} of {drawn}");
            }
            true
        }
        Err(error) => {
            assert!(error.to_string().contains("part."), "{error}");
            false
        }
    }
}

/// Photos of drape tests: the file is damaged, or its pixels are.
pub fn picture() -> Target {
    let seeds = [40, 48, 64].into_iter().map(|side| encoded(side, side, &sheet(side))).collect();
    Target { seeds, damaged, size: pixels_of, holds: picture_holds }
}

/// The pixels of a wavy sheet on a light ground.
fn sheet(side: u32) -> Vec<u8> {
    let half = 0.5 * f64::from(side);
    let mut pixels = Vec::new();
    for i in 0..side * side {
        let (x, y) = (f64::from(i % side) - half, f64::from(i / side) - half);
        let within = x.hypot(y) < half * (0.6 + 0.1 * (6.0 * y.atan2(x)).cos());
        pixels.extend(if within { [40, 60, 90] } else { [230, 232, 228] });
    }
    pixels
}

fn encoded(width: u32, height: u32, pixels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().expect("a picture").write_image_data(pixels).expect("its pixels");
    bytes
}

fn damaged(damage: &Damage, seeds: &[Vec<u8>]) -> Vec<u8> {
    if damage.part(1).is_none() {
        return damage.of(seeds);
    }
    let mut reader =
        png::Decoder::new(std::io::Cursor::new(damage.seed(seeds))).read_info().expect("a picture");
    let mut pixels = vec![0; reader.output_buffer_size().expect("its size")];
    reader.next_frame(&mut pixels).expect("its pixels");
    let width = reader.info().width;
    let mut pixels = damage.to(&pixels, b"");
    let row = 3 * width as usize;
    pixels.resize(pixels.len().div_ceil(row).max(1) * row, 0);
    encoded(width, (pixels.len() / row) as u32, &pixels)
}

/// Bytes of the file and of its pixels.
fn pixels_of(bytes: &[u8]) -> usize {
    let read = png::Decoder::new(std::io::Cursor::new(bytes)).read_info();
    bytes.len() + read.map_or(0, |r| 16 * r.info().width as usize * r.info().height as usize)
}

fn picture_holds(bytes: &[u8]) -> bool {
    let Ok(found) = silhouette(bytes) else { return false };
    assert!(found.outline.len() > 2 && found.outline.iter().flatten().all(|v| v.is_finite()));
    let [width, height] = found.size.map(f64::from);
    assert!(
        found
            .outline
            .iter()
            .all(|[x, y]| (-1.0..=width + 1.0).contains(x) && (-1.0..=height + 1.0).contains(y))
    );
    assert!(found.contrast.is_finite() && found.noise.is_finite() && (0.0..=1.0).contains(&found.at_border));
    assert!(found.disc.as_ref().is_none_or(|disc| disc.radius > 0.0 && disc.radius.is_finite()));
    true
}
