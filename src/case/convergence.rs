//! `[convergence]`: what the mesh leaves open in a result.

use serde::Deserialize;

use super::CaseError;
use super::error::refused;
use super::sheet::Sheet;
use crate::finding::{Located, Node};

/// `[convergence]`: the case is solved on coarser meshes too, of which each halves the `cells` of the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct ConvergenceTable {
    /// Meshes with that of `[sheet]`, the finest: 2, with the order of the element assumed, or 3, which show it.
    meshes: u32,
}

impl Default for ConvergenceTable {
    fn default() -> Self {
        Self { meshes: 3 }
    }
}

impl ConvergenceTable {
    /// The coarser sheets of the table at a node, coarsest first.
    pub fn coarser(self, at: &Node<'_>, sheet: &Sheet) -> Result<Located<Vec<Sheet>>, CaseError> {
        if !(2..=3).contains(&self.meshes) {
            let message = format!("[convergence] meshes = {}: take 2 or 3", self.meshes);
            return refused(at.value_place("meshes"), message);
        }
        let Some(cells) = sheet.outline.cells() else {
            let message = "[convergence] halves `cells`, and a mesh file or a drawing has none: remove it, or give `shape`";
            return refused(at.place(), message);
        };
        if sheet.layout.distortion != 0.0 {
            let message =
                "[convergence] needs meshes that are alike, and distorted ones are not: remove one of them";
            return refused(at.place(), message);
        }
        let (parts, halvings) = (1 << (self.meshes - 1), self.meshes - 1);
        if cells.iter().any(|n| n % parts != 0) {
            let message = format!(
                "[convergence] meshes = {} halves cells = {cells:?} {halvings} time(s): make them multiples of {parts}",
                self.meshes,
            );
            return refused(at.value_place("meshes"), message);
        }
        let coarse = |times| Sheet { outline: sheet.outline.coarser(times), ..sheet.clone() };
        Ok(at.located((1..self.meshes).rev().map(coarse).collect()))
    }
}
