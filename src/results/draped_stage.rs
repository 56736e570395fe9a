//! A drape as a USD stage: the whole sheet at rest and as it hangs, with the materials of its fabric.

use super::failure::Failure;
use super::folder::Folder;
use super::task::Task;
use crate::constitutive::Constitutive;
use crate::report::cards::{self, CardInput, DrapedSheet};
use crate::study::Drape;

/// Writes `<stem>.usda` with a line of what shape it is, if the drape is that of a fabric: a case with constants of its own has no origin to tell.
pub(super) fn write(task: &Task, d: &Drape, about: String, folder: &Folder) -> Result<(), Failure> {
    let (Some(sheet), (_, Some(made))) = (task.fabric, task.section()?) else { return Ok(()) };
    let made = Constitutive { section: d.model.section.clone(), ..made };
    let card = cards::draped(&CardInput { sheet, made: &made, stamp: None, crimp: None }, &whole(d, about))?;
    folder.write(&format!("{}.usda", task.stem()), card.text.as_bytes())
}

/// The ring that was solved and the disc under it, as a fan of triangles about its centre: so the hinges of the rim, whose
/// other side lies flat on the disc, clamp the ring as the disc does.
fn whole(d: &Drape, about: String) -> DrapedSheet {
    let mesh = &d.model.mesh;
    let mut rest: Vec<[f64; 3]> = mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect();
    let mut points: Vec<[f64; 3]> = d.solution.state.position.iter().map(|p| [p.x, p.y, p.z]).collect();
    let corners = mesh.quads.iter().map(|quad| quad.map(|n| n as usize));
    let mut triangles: Vec<[usize; 3]> = corners.flat_map(|[p, q, r, s]| [[p, q, r], [p, r, s]]).collect();
    let between = 0.5 * (d.disc_radius + d.sheet_radius);
    let edges = mesh.boundary_edges().into_iter().map(|edge| edge.map(|n| n as usize));
    let rim: Vec<[usize; 2]> = edges.filter(|[a, _]| rest[*a][0].hypot(rest[*a][1]) < between).collect();
    let mut held: Vec<usize> = rim.iter().map(|[a, _]| *a).collect();
    let centre = rest.len();
    rest.push(mean(&rest, &held));
    points.push(mean(&points, &held));
    triangles.extend(rim.iter().map(|[a, b]| [*b, *a, centre]));
    held.push(centre);
    held.sort_unstable();
    DrapedSheet { about, rest, points, triangles, held }
}

/// The middle of some points.
fn mean(points: &[[f64; 3]], of: &[usize]) -> [f64; 3] {
    [0, 1, 2].map(|k| of.iter().map(|n| points[*n][k]).sum::<f64>() / of.len() as f64)
}
