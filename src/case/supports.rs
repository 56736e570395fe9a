//! `[[supports]]` and `[[rigid]]`: where the sheet is held, and what moves as one body.

use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::point::SheetPoint;
use crate::finding::{Located, Node};
use crate::model::Dof;

/// `[[supports]]`: a set with either a kind or a list of dofs.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct SupportTable {
    /// Node set: `boundary`, `left`, `right`, `bottom`, `top`, `corners`, `inner`, `outer`, `all` ..., a named set of the
    /// mesh file, or a rigid body.
    #[cfg_attr(test, schemars(example = &"boundary"))]
    set: String,
    /// A named kind.
    kind: Option<SupportKind>,
    /// Names of dofs: `u v w theta_x theta_y theta_z`.
    #[cfg_attr(test, schemars(extend("examples" = [["u", "w"]])))]
    fix: Option<Vec<String>>,
}

/// Named supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum SupportKind {
    /// All dofs held.
    Clamped,
    /// Displacements held, and the rotation about the normal of the edge in the plane of the sheet: a thin plate on a
    /// support. In large rotations that normal has to be along x, y or z.
    SimplySupported,
    /// Displacements held only.
    SimplySupportedSoft,
    /// Symmetry about a plane x = const.
    SymmetryX,
    /// Symmetry about a plane y = const.
    SymmetryY,
    /// Nothing held; a way to say so.
    Free,
}

/// Where the sheet is held.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetSupport {
    /// Node set.
    pub set: Located<String>,
    /// What is held there.
    pub held: Held,
}

/// What a support holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Held {
    /// A named kind.
    Kind(SupportKind),
    /// These dofs.
    Dofs(Vec<Dof>),
}

/// `[[rigid]]`: a set whose nodes move as one rigid body: a stiff clamp, a bar sewn to an edge.
///
/// The body's point of reference becomes a node set of its own, `name`: supports, prescribed values and
/// loads on that set act on the body, and its reactions are those about the point.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RigidTable {
    /// Name of the set that holds the point of reference alone.
    #[cfg_attr(test, schemars(example = &"clamp"))]
    name: String,
    /// Node set that moves.
    #[cfg_attr(test, schemars(example = &"right"))]
    set: String,
    /// The point of reference: `[x, y]` in the plane z = 0, or `[x, y, z]`; the mean of the set's nodes
    /// when left out.
    at: Option<SheetPoint>,
}

/// Nodes of a set that move as one rigid body about a point of reference.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidSet {
    /// Name of the set that holds the point of reference alone.
    pub name: Located<String>,
    /// Node set that moves.
    pub set: Located<String>,
    /// The point of reference; the mean of the set's nodes without.
    pub at: Option<SheetPoint>,
}

impl SupportTable {
    /// The support of the table at a node.
    pub fn support(self, at: &Node<'_>) -> Result<SheetSupport, CaseError> {
        let held = match (self.kind, &self.fix) {
            (Some(kind), None) => Held::Kind(kind),
            (None, Some(names)) => {
                let items = at.get("fix");
                let places = items.iter().flat_map(Node::items);
                let dofs = names.iter().zip(places).map(|(name, place)| dof_named(name, &place));
                Held::Dofs(dofs.collect::<Result<_, _>>()?)
            }
            _ => {
                let message =
                    format!("the support of set `{}` needs either `kind` or `fix`, and not both", self.set);
                return refused(at.key_place("fix"), message);
            }
        };
        Ok(SheetSupport { set: at.located_at("set", self.set), held })
    }
}

impl RigidTable {
    /// The body of the table at a node.
    pub fn body(self, at: &Node<'_>) -> RigidSet {
        RigidSet { name: at.located_at("name", self.name), set: at.located_at("set", self.set), at: self.at }
    }
}

/// The dof of a name, written at a node.
pub(super) fn dof_named(name: &str, at: &Node<'_>) -> Result<Dof, CaseError> {
    match Dof::from_name(name) {
        Some(dof) => Ok(dof),
        None => {
            refused(at.place(), format!("`{name}` is not a dof: take u, v, w, theta_x, theta_y or theta_z"))
        }
    }
}
