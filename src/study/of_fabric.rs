//! What a sheet has of its fabric beside its section.

use crate::constitutive::Constitutive;
use crate::section::SheetLaw;

/// What a sheet in large rotations has of its fabric beside its section.
#[derive(Clone, Copy, Default)]
pub(super) struct OfFabric<'a> {
    /// Its law with friction.
    pub law: Option<&'a SheetLaw>,
    /// Its coefficient of friction on steel, where it was measured.
    pub friction: Option<f64>,
}

impl<'a> OfFabric<'a> {
    pub fn of(made: &'a Constitutive) -> Self {
        Self { law: made.law.as_ref(), friction: made.surface_friction }
    }
}
