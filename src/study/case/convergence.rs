//! `[convergence]`: what the mesh leaves open in a result.

use serde::Deserialize;

use super::{Analysis, Case};

/// `[convergence]`: the case is solved on coarser meshes too, of which each halves the `cells` of the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ConvergenceTable {
    /// Meshes with that of `[sheet]`, the finest: 2, with the order of the element assumed, or 3, which show it; 3.
    pub meshes: u32,
}

impl Default for ConvergenceTable {
    fn default() -> Self {
        Self { meshes: 3 }
    }
}

impl ConvergenceTable {
    /// What keeps a case from having coarser meshes, if anything does.
    pub(super) fn contradiction(self, case: &Case) -> Option<String> {
        let refuse = |why: &str| Some(format!("[convergence] {why}"));
        if !(2..=3).contains(&self.meshes) {
            return Some(format!("[convergence] meshes = {}: take 2 or 3", self.meshes));
        }
        if !matches!(case.analysis, Analysis::Linear {} | Analysis::Modal { .. }) {
            return refuse("is for linear and modal analyses: remove it (a drape has `refinements`)");
        }
        let Some(sheet) = &case.sheet else {
            return refuse("is for cases with a [sheet]: remove it");
        };
        if sheet.shape.is_none() {
            return refuse("halves `cells`, and a mesh file has none: remove it, or give `shape`");
        }
        if sheet.distortion != 0.0 {
            return refuse("needs meshes that are alike, and distorted ones are not: remove one of them");
        }
        let parts = 1 << (self.meshes - 1);
        let cells = sheet.cells?;
        (cells.iter().any(|n| n % parts != 0)).then(|| {
            format!(
                "[convergence] meshes = {} halves cells = {cells:?} {} time(s): make them multiples of {parts}",
                self.meshes,
                self.meshes - 1
            )
        })
    }
}
