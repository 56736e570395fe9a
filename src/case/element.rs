//! `[element]`: the formulation.

use std::fmt;

use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::CaseError;
use super::error::refused;
use crate::element::{Cells, Drilling, Formulation, Mass, Membrane, ShearInterpolation};
use crate::finding::{Node, array};

/// `[element]`; what is left out is as in the profile, and that is the default one when left out.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct ElementTable {
    /// A named formulation to start from.
    profile: Option<Profile>,
    /// Smoothing cells: a number (1, 2, 3, 4, 9, 16 ...) or `[along_xi, along_eta]`.
    #[cfg_attr(test, schemars(extend("default" = 4)))]
    subcells: Option<Subcells>,
    /// The membrane: `cells` (smoothed as bending), `one_cell`, or `assumed_stress`, which is the default of a drape, and
    /// in large rotations of a mesh that has triangles.
    #[cfg_attr(test, schemars(extend("default" = "cells")))]
    membrane: Option<Membrane>,
    /// The transverse shear: `mitc4`, or for comparison only `displacement` (locks in thin sheets) and `reduced` (leaves
    /// motions without energy); nothing else of the element changes.
    #[cfg_attr(test, schemars(extend("default" = "mitc4")))]
    shear: Option<ShearInterpolation>,
    /// α of the transverse shear, 0 to 1; in the profile `seed` 0 when left out, and `fourth_order` has its own.
    #[cfg_attr(test, schemars(extend("default" = 0.05)))]
    shear_stabilisation: Option<f64>,
    /// What holds the drilling rotation; in the profile `seed` `seed` when left out.
    #[cfg_attr(test, schemars(extend("default" = "scaled")))]
    drilling: Option<DrillingChoice>,
}

/// Named formulations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
enum Profile {
    /// That of Nguyen-Trong, Ferreira and Gomes: nc = 4, no shear stabilisation, drilling spring 1e-3.
    Seed,
    /// One bending cell and the residual bending flexibility: bending waves of fourth order on equal rectangles along
    /// the yarns, so frequencies and deflections of flat sheets between clamped and hard supported edges. Moments keep the
    /// second order, `[convergence]` takes second order for everything, and S123 tells of sheets for which this profile is not.
    FourthOrder,
}

/// Smoothing cells as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Subcells {
    /// nc of Nguyen-Trong et al.
    Count(u32),
    /// A grid.
    Grid([u8; 2]),
}

#[cfg(test)]
impl schemars::JsonSchema for Subcells {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Subcells".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let grid = generator.subschema_for::<[u8; 2]>();
        schemars::json_schema!({"anyOf": [{"type": "integer", "minimum": 1}, grid], "examples": [4, [2, 2]]})
    }
}

impl<'de> Deserialize<'de> for Subcells {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct CountOrGrid;
        impl<'de> Visitor<'de> for CountOrGrid {
            type Value = Subcells;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number of smoothing cells, such as 4, or [nx, ny]")
            }

            fn visit_i64<E: de::Error>(self, number: i64) -> Result<Subcells, E> {
                let count = u32::try_from(number);
                count
                    .map(Subcells::Count)
                    .map_err(|_| E::invalid_value(de::Unexpected::Signed(number), &self))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, grid: A) -> Result<Subcells, A::Error> {
                let grid = de::value::SeqAccessDeserializer::new(grid);
                array(grid).map(Subcells::Grid)
            }
        }
        d.deserialize_any(CountOrGrid)
    }
}

/// Drilling stiffness as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
enum DrillingChoice {
    /// Scaled penalty (default).
    Scaled,
    /// Penalty with the membrane shear stiffness.
    HughesBrezzi,
    /// The spring of Nguyen-Trong et al., 1e-3 of the largest diagonal term.
    Seed,
}

/// What an element is for, as far as its formulation depends on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Purpose {
    /// Whether rotations are large.
    pub large_rotations: bool,
    /// Whether it is a drape.
    pub drape: bool,
    /// Mass matrix of an analysis that has one.
    pub mass: Option<Mass>,
}

impl Purpose {
    /// Statics in small or large rotations.
    pub fn statics(large_rotations: bool) -> Self {
        Self { large_rotations, drape: false, mass: None }
    }
}

impl ElementTable {
    /// The formulation that the table asks for; `case` is the file's table, which may be without `[element]`.
    pub fn formulation(&self, case: &Node<'_>, purpose: Purpose) -> Result<Formulation, CaseError> {
        let at = &case.get("element").unwrap_or(*case);
        if self.profile == Some(Profile::FourthOrder) {
            self.fits_fourth_order(case, at, purpose)?;
        }
        let mut formulation = match self.profile {
            Some(Profile::Seed) => Formulation::seed(),
            Some(Profile::FourthOrder) => Formulation::fourth_order(),
            None => Formulation::default(),
        };
        if let Some(subcells) = self.subcells {
            formulation.cells = cells(subcells, at)?;
        }
        match self.drilling {
            None => {}
            Some(DrillingChoice::Scaled) => formulation.drilling = Drilling::Scaled,
            Some(DrillingChoice::HughesBrezzi) => formulation.drilling = Drilling::HughesBrezzi,
            Some(DrillingChoice::Seed) => formulation.drilling = Drilling::Seed(1e-3),
        }
        let of_drape = purpose.drape.then_some(Membrane::AssumedStress);
        formulation.membrane = self.membrane.or(of_drape).unwrap_or(formulation.membrane);
        formulation.shear = self.shear.unwrap_or_default();
        if let Some(alpha) = self.shear_stabilisation {
            if !(0.0..=1.0).contains(&alpha) {
                let message = format!("shear_stabilisation = {alpha}: it must be 0 to 1");
                return refused(at.value_place("shear_stabilisation"), message);
            }
            formulation.shear_stabilisation = alpha;
        }
        Ok(formulation)
    }

    /// Whether nothing is said of the membrane.
    pub fn leaves_the_membrane(&self) -> bool {
        self.membrane.is_none() && self.profile.is_none()
    }

    /// Refuses what triangles cannot do: a refined mesh has some.
    pub fn fits_triangles(&self, case: &Node<'_>) -> Result<(), CaseError> {
        let at = case.get("element").unwrap_or(*case);
        if self.profile == Some(Profile::FourthOrder) {
            let message = "the [element] profile `fourth_order` is for equal rectangles, and [adaptive] makes others: remove one of them";
            return refused(at.value_place("profile"), message);
        }
        if self.shear.is_some_and(|shear| shear != ShearInterpolation::Mitc4) {
            let message = "[adaptive] closes its meshes with triangles, which need shear = \"mitc4\": remove `shear`, or [adaptive]";
            return refused(at.value_place("shear"), message);
        }
        let default = if self.profile == Some(Profile::Seed) {
            0.0
        } else {
            Formulation::default().shear_stabilisation
        };
        if self.shear_stabilisation.unwrap_or(default) == 0.0 {
            let key = if self.shear_stabilisation.is_some() { "shear_stabilisation" } else { "profile" };
            let message = "[adaptive] closes its meshes with triangles, which lock in thin sheets without stabilisation: give a \
                           shear_stabilisation above 0, such as 0.05, or remove [adaptive]";
            return refused(at.value_place(key), message);
        }
        Ok(())
    }

    fn fits_fourth_order(&self, case: &Node<'_>, at: &Node<'_>, purpose: Purpose) -> Result<(), CaseError> {
        if purpose.large_rotations {
            let message = "the [element] profile `fourth_order` is derived for small rotations: remove it";
            return refused(at.value_place("profile"), message);
        }
        if self.shear_stabilisation.is_some() {
            return refused(
                at.key_place("shear_stabilisation"),
                "`shear_stabilisation` is given by the [element] profile \"fourth_order\": remove one of them",
            );
        }
        if self.shear.is_some_and(|shear| shear != ShearInterpolation::Mitc4) {
            return refused(
                at.value_place("shear"),
                "the [element] profile `fourth_order` is derived for the shear of MITC4: remove `shear`, or the profile",
            );
        }
        if purpose.mass.is_some_and(|mass| mass != Mass::Lumped) {
            let analysis = case.get("analysis").unwrap_or(*case);
            let key = if analysis.has("mass") { "mass" } else { "lumped" };
            return refused(
                analysis.value_place(key),
                "the [element] profile `fourth_order` goes with mass = \"lumped\", the default: remove it, or the other mass",
            );
        }
        Ok(())
    }
}

fn cells(subcells: Subcells, at: &Node<'_>) -> Result<Cells, CaseError> {
    let place = || at.value_place("subcells");
    match subcells {
        Subcells::Count(nc) => match Cells::from_count(nc) {
            Some(cells) => Ok(cells),
            None => refused(
                place(),
                format!("subcells = {nc} has no layout: take 1, 2, 3, 4, 9, 16 ... or [nx, ny]"),
            ),
        },
        Subcells::Grid([nx, ny]) if nx > 0 && ny > 0 => Ok(Cells::grid(nx, ny)),
        Subcells::Grid(_) => refused(place(), "subcells = [nx, ny] needs two positive numbers"),
    }
}
