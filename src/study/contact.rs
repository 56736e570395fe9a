//! What a sheet touches: itself, and the obstacles of its case.

use std::collections::BTreeSet;

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::{Case, StudyError, refused};
use crate::case::SheetObstacle;
use crate::finding::{Finding, StudyFact};
use crate::mesh::{Crossings, QuadMesh, crossings};
use crate::model::{Gap, Model, RigidSurface, SurfaceShape};
use crate::quantity::significant;
use crate::solve::nonlinear::{ACCEPTED, LayersInTouch, State, Touch, layers_in_touch};

/// What an obstacle bears (SI).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ContactResult {
    /// Its name.
    pub obstacle: String,
    /// The coefficient of friction that it has.
    pub friction: f64,
    /// Force on the sheet, global axes (N).
    pub force: [f64; 3],
    /// Sum of the sizes of the forces along its normals (N).
    pub normal_force: f64,
    /// Nodes that it presses.
    pub nodes: usize,
    /// Those of them that slip, or that have come to it in the last step.
    pub slipping: usize,
    /// How far a node is beyond it at most (m).
    pub penetration: f64,
    /// Force on each node of the sheet (N).
    #[serde(skip)]
    pub forces: Vec<[f64; 3]>,
}

/// Friction of cloth on what nobody described: about that of cotton on steel and on wood.
const ASSUMED_FRICTION: f64 = 0.2;

fn friction(obstacle: &SheetObstacle, of_fabric: Option<f64>) -> f64 {
    obstacle.friction.or(of_fabric).unwrap_or(ASSUMED_FRICTION)
}

/// The obstacles of a case for a fabric.
pub(super) fn surfaces(obstacles: &[SheetObstacle], of_fabric: Option<f64>) -> Vec<RigidSurface> {
    let surfaces = obstacles.iter().map(|obstacle| RigidSurface {
        name: obstacle.name.value.clone(),
        shape: obstacle.shape,
        friction: friction(obstacle, of_fabric),
    });
    surfaces.collect()
}

/// Refuses supports that hold nodes inside an obstacle, which no contact could push out.
///
/// # Errors
/// S003 at the obstacle.
pub(super) fn holds_nothing_within(
    case: &Case,
    obstacles: &[SheetObstacle],
    model: &Model,
) -> Result<(), StudyError> {
    let held = model.constraints();
    for obstacle in obstacles {
        let within = within_at_rest(&obstacle.shape, &model.mesh);
        if let Some((node, gap)) =
            within.into_iter().find(|(node, gap)| is_held(&held[6 * *node as usize..], &gap.normal))
        {
            let at = model.mesh.nodes[node as usize];
            let text = format!(
                "[[obstacles]] `{}` contains a node that a support holds, at ({}, {}, {}) m, {} mm deep: move the obstacle or the support",
                obstacle.name.value,
                significant(at.x),
                significant(at.y),
                significant(at.z),
                significant(-1e3 * gap.distance)
            );
            return Err(refused(case, &obstacle.name, text));
        }
    }
    Ok(())
}

/// Whether the dofs of a node, its own first, are held along all of a normal.
fn is_held(dofs: &[Option<f64>], normal: &Vector3<f64>) -> bool {
    (0..3).all(|k| normal[k].abs() < AXIS || dofs[k].is_some())
}

/// A component of a normal below this is rounding.
const AXIS: f64 = 1e-9;

/// The nodes of a sheet that lie inside an obstacle at rest, and how far.
fn within_at_rest(shape: &SurfaceShape, mesh: &QuadMesh) -> Vec<(u32, Gap)> {
    let [low, high] = mesh.bounds();
    let accepted = ACCEPTED * (high - low).norm();
    let nodes: BTreeSet<u32> = mesh.quads.iter().flatten().copied().collect();
    let gaps = nodes.into_iter().map(|node| (node, shape.gap(&mesh.nodes[node as usize])));
    gaps.filter(|(_, gap)| gap.distance < -accepted).collect()
}

/// S160 of every obstacle that contains a part of the sheet at rest.
pub(super) fn starts_within(obstacles: &[SheetObstacle], mesh: &QuadMesh) -> Vec<StudyFact> {
    let facts = obstacles.iter().filter_map(|obstacle| {
        let depths = within_at_rest(&obstacle.shape, mesh).into_iter().map(|(_, gap)| -gap.distance);
        let depth = depths.reduce(f64::max)?;
        Some(StudyFact::StartsWithin { obstacle: obstacle.name.value.clone(), depth })
    });
    facts.collect()
}

/// What each obstacle bears in a state.
pub(super) fn contacts(
    obstacles: &[SheetObstacle],
    of_fabric: Option<f64>,
    state: &State,
) -> Vec<ContactResult> {
    let mut contacts = Vec::with_capacity(obstacles.len());
    for (k, obstacle) in obstacles.iter().enumerate() {
        let mut contact = ContactResult {
            obstacle: obstacle.name.value.clone(),
            friction: friction(obstacle, of_fabric),
            force: [0.0; 3],
            normal_force: 0.0,
            nodes: 0,
            slipping: 0,
            penetration: 0.0,
            forces: vec![[0.0; 3]; state.position.len()],
        };
        let touches = state.memory.touches.iter().skip(k).step_by(obstacles.len());
        for (node, touch) in touches.enumerate().filter(|(_, touch)| touch.pressing > 0.0) {
            contact.add(obstacle, state, node, touch);
        }
        contacts.push(contact);
    }
    contacts
}

impl ContactResult {
    fn add(&mut self, obstacle: &SheetObstacle, state: &State, node: usize, touch: &Touch) {
        let gap = obstacle.shape.gap(&state.position[node]);
        let force: Vector3<f64> = gap.normal * touch.pressing + touch.traction;
        self.forces[node] = force.into();
        (0..3).for_each(|d| self.force[d] += force[d]);
        self.normal_force += touch.pressing;
        self.nodes += 1;
        self.slipping +=
            usize::from(touch.slips || (self.friction > 0.0 && touch.traction == Vector3::zeros()));
        self.penetration = self.penetration.max(-gap.distance);
    }
}

/// S144, S146, S147, S151 and S155 of a sheet in a state.
pub(super) fn touching(
    obstacles: &[SheetObstacle],
    model: &Model,
    of_fabric: Option<f64>,
    state: &State,
) -> Vec<Finding> {
    let [low, high] = model.mesh.bounds();
    let accepted = ACCEPTED * (high - low).norm();
    let itself = through_or_on_itself(model, state).map(Finding::new);
    itself.into_iter().chain(at_obstacles(obstacles, &model.mesh, of_fabric, state, accepted)).collect()
}

/// S146, S147 and S155 of a sheet in a state that may be so far beyond an obstacle (m).
pub(super) fn at_obstacles(
    obstacles: &[SheetObstacle],
    mesh: &QuadMesh,
    of_fabric: Option<f64>,
    state: &State,
    accepted: f64,
) -> Vec<Finding> {
    let sides = mesh.edges().map(|side| side.map(|node| &state.position[node as usize]));
    let mut facts = through_obstacles(obstacles, sides, false);
    for (contact, obstacle) in contacts(obstacles, of_fabric, state).into_iter().zip(obstacles) {
        let ContactResult { obstacle: name, friction, penetration: depth, .. } = contact;
        if depth > 1.01 * accepted {
            facts.push(StudyFact::Penetrates { obstacle: name.clone(), depth, accepted });
        }
        if obstacle.friction.is_none() {
            facts.push(StudyFact::AssumedFriction {
                obstacle: name,
                friction,
                measured: of_fabric.is_some(),
            });
        }
    }
    facts.into_iter().map(Finding::new).collect()
}

/// S155 of every obstacle that the nodes of a sheet have gone straight through from one equilibrium to the next.
pub(super) fn passed(
    obstacles: &[SheetObstacle],
    mesh: &QuadMesh,
    [from, to]: [&State; 2],
) -> Vec<StudyFact> {
    let nodes = mesh.quads.iter().flatten().map(|node| *node as usize);
    through_obstacles(obstacles, nodes.map(|n| [&from.position[n], &to.position[n]]), true)
}

/// S155 of every obstacle that lines go through deeper than half its radius, with the deepest of them: where a sheet lies on a
/// bar, or moves about it, straight lines between its nodes cut off less.
fn through_obstacles<'p>(
    obstacles: &[SheetObstacle],
    lines: impl Iterator<Item = [&'p Point3<f64>; 2]> + Clone,
    between_steps: bool,
) -> Vec<StudyFact> {
    let mut facts = Vec::new();
    for obstacle in obstacles {
        let Some(radius) = obstacle.shape.radius() else { continue };
        let depths = lines.clone().filter_map(|[a, b]| obstacle.shape.depth_of_line(a, b));
        let Some((depth, at)) = depths.max_by(|(a, _), (b, _)| a.total_cmp(b)) else { continue };
        if depth > 0.5 * radius {
            let (obstacle, at) = (obstacle.name.value.clone(), at.coords.into());
            facts.push(StudyFact::ThroughObstacle { obstacle, depth, radius, at, between_steps });
        }
    }
    facts
}

/// S144 of a sheet that passes through itself, or S151 of one whose layers touch.
pub(super) fn through_or_on_itself(model: &Model, state: &State) -> Option<StudyFact> {
    let thickness = model.section.thickness;
    let touching =
        |LayersInTouch { points, distance, at }| StudyFact::LayersTouch { points, distance, thickness, at };
    through_itself(&model.mesh, state).or_else(|| layers_in_touch(model, state).map(touching))
}

/// S144 of a sheet that passes through itself.
pub(super) fn through_itself(mesh: &QuadMesh, state: &State) -> Option<StudyFact> {
    let Crossings { pairs, at, depth, .. } = crossings(&state.position, &mesh.quads)?;
    Some(StudyFact::ThroughItself { pairs, at, depth })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finding::Located;
    use crate::mesh::rectangle;
    use crate::model::SurfaceShape;

    /// Cells of 5 mm over bars between and under them, and a node that comes from one side of a bar to the other.
    #[test]
    fn bars_in_a_sheet_and_on_the_ways_of_its_nodes_are_told() {
        let mesh = rectangle(0.1, 0.005, 20, 1).unwrap();
        let rest = State::rest(&mesh);
        let bar = |x: f64, z: f64, radius: f64| {
            let shape = SurfaceShape::Cylinder { at: Point3::new(x, 0.0, z), axis: Vector3::y(), radius };
            [SheetObstacle { name: Located::from("bar".to_string()), shape, friction: Some(0.2) }]
        };
        let told = |bar: &[SheetObstacle]| {
            let findings = at_obstacles(bar, &mesh, None, &rest, 1e-6);
            findings.iter().map(Finding::code).collect::<Vec<_>>()
        };
        assert_eq!(told(&bar(0.0525, 0.0, 0.002)), ["S155"], "between two nodes");
        assert!(told(&bar(0.05, -0.01, 0.01)).is_empty(), "the sheet lies on it");
        assert!(told(&bar(0.0525, -0.002, 0.002)).is_empty(), "a side cuts off less than half of it");
        let mut below = rest.clone();
        below.position.iter_mut().for_each(|p| p.z -= 0.1);
        for (radius, count) in [(0.01, 1), (1e-4, 1)] {
            let facts = passed(&bar(0.05, -0.05, radius), &mesh, [&rest, &below]);
            assert_eq!(facts.len(), count, "{facts:?}");
        }
        assert!(passed(&bar(0.05, -0.05, 0.01), &mesh, [&rest, &rest]).is_empty());
        assert!(passed(&bar(0.2, -0.05, 0.01), &mesh, [&rest, &below]).is_empty(), "beside the sheet");
    }
}
