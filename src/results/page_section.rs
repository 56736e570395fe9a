//! The section of a fabric on the page: its three matrices, and what they rest on.

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use crate::constitutive::Constitutive;
use crate::instrument::Parameter;
use crate::report::html::{Block, without_folders};
use crate::report::number::{significant, unit_text};
use crate::report::table::UnitSystem;

/// Above the matrices.
const MATRICES: &str =
    "N = D_m [ε_x, ε_y, γ_xy], M = D_b [κ_x, κ_y, κ_xy], Q = D_s [γ_xz, γ_yz]; x is the warp, y the weft.";

/// Above the inputs.
const INPUTS: &str = "What the section rests on, and where each value comes from.";

/// What the page shows of a section (SI).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PageSection {
    membrane: [[f64; 3]; 3],
    bending: [[f64; 3]; 3],
    shear: [[f64; 2]; 2],
    /// Name, value with unit, source.
    used: Vec<[String; 3]>,
}

impl PageSection {
    pub(super) fn new(made: &Constitutive) -> Self {
        let rows = |d: &Matrix3<f64>| [0, 1, 2].map(|i| [0, 1, 2].map(|j| d[(i, j)]));
        let section = &made.section;
        Self {
            membrane: rows(&section.d_m),
            bending: rows(&section.d_b),
            shear: [0, 1].map(|i| [0, 1].map(|j| section.d_s[(i, j)])),
            used: made
                .used
                .iter()
                .map(|used| [used.name.to_string(), used.value.clone(), used.source.clone()])
                .collect(),
        }
    }

    /// Closed until it is wanted.
    pub(super) fn block(&self) -> Block {
        let assumed = self.used.iter().filter(|[_, _, source]| source.starts_with("assumed")).count();
        Block::More {
            summary: format!(
                "Shell section: D_m, D_b, D_s and what they rest on, {assumed} of {} inputs assumed",
                self.used.len()
            ),
            blocks: vec![self.matrices(), self.inputs()],
        }
    }

    fn matrices(&self) -> Block {
        let [force, couple] =
            [UnitSystem::of_modulus as fn(UnitSystem) -> _, |system| system.of(Parameter::B)]
                .map(|of| [UnitSystem::Kes, UnitSystem::Si].map(of));
        let matrix = |name: &str, entries: &[[f64; 3]; 3], units| -> Vec<Vec<[String; 2]>> {
            ["x", "y", "xy"].iter().zip(entries).map(|(axis, row)| line(name, axis, row, units)).collect()
        };
        let mut rows = matrix("D_m", &self.membrane, force);
        rows.extend(matrix("D_b", &self.bending, couple));
        rows.extend(["xz", "yz"].iter().zip(&self.shear).map(|(axis, row)| line("D_s", axis, row, force)));
        let header = ["row", "x, xz", "y, yz", "xy", "unit"].map(String::from).to_vec();
        Block::Units { caption: MATRICES.into(), header, rows }
    }

    fn inputs(&self) -> Block {
        let row = |used: &[String; 3]| used.iter().map(|text| without_folders(text).into()).collect();
        Block::Table {
            caption: INPUTS.into(),
            header: ["input", "value", "source"].map(String::from).to_vec(),
            rows: self.used.iter().map(row).collect(),
            of_fabrics: false,
        }
    }
}

/// A row of a matrix in both systems of units, whose names and SI values are given.
fn line(name: &str, axis: &str, entries: &[f64], units: [(&'static str, f64); 2]) -> Vec<[String; 2]> {
    let head = format!("{name}, {axis}");
    let numbers = entries.iter().map(|entry| units.map(|(_, factor)| significant(entry / factor, 4)));
    let missing = std::iter::repeat_n([String::new(), String::new()], 3 - entries.len());
    std::iter::once([head.clone(), head])
        .chain(numbers)
        .chain(missing)
        .chain([units.map(|(unit, _)| unit_text(unit))])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_stand_in_both_units_with_their_inputs() {
        let section = PageSection {
            // 98.0665 N/m are 100 gf/cm, and 9.80665e-5 N·m are one gf·cm²/cm.
            membrane: [[98.0665, 0.0, 0.0], [0.0; 3], [0.0; 3]],
            bending: [[9.80665e-5, 0.0, 0.0], [0.0; 3], [0.0; 3]],
            shear: [[196.133, 0.0], [0.0, 98.0665]],
            used: vec![["thickness", "0.5 mm", "measured: T0"], ["poisson", "0.3", "assumed: usual"]]
                .into_iter()
                .map(|row| row.map(String::from))
                .collect(),
        };
        let Block::More { summary, blocks } = section.block() else { panic!("a closed part") };
        assert!(summary.ends_with("1 of 2 inputs assumed"), "{summary}");
        let [Block::Units { rows, .. }, Block::Table { rows: inputs, .. }] = &blocks[..] else {
            panic!("{blocks:?}")
        };
        let firsts = |at: usize| [&rows[at][0][0], &rows[at][1][0], &rows[at][1][1], &rows[at][4][0]];
        assert_eq!(firsts(0), ["D_m, x", "100.0", "98.07", "gf/cm"]);
        assert_eq!(firsts(3), ["D_b, x", "1.000", "9.807 × 10⁻⁵", "gf·cm²/cm"]);
        assert_eq!(firsts(6), ["D_s, xz", "200.0", "196.1", "gf/cm"]);
        assert_eq!((rows.len(), inputs.len()), (8, 2));
        assert!(rows.iter().all(|row| row.len() == 5));
    }
}
