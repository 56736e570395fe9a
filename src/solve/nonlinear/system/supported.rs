//! Whether supports hold a sheet, before an equilibrium is looked for.

use nalgebra::Vector3;

use super::System;
use crate::model::DofGroup;
use crate::solve::{SolveError, loose};

impl System<'_> {
    /// N001 if a rigid motion of a part of the sheet at rest meets no support.
    pub fn is_supported(&self) -> Result<(), SolveError> {
        let places = &self.model.mesh.nodes;
        let loose = loose::motion(places, &self.plan.pattern, DofGroup::Shell, &self.held);
        loose.map_or(Ok(()), |motion| Err(SolveError::loose(&motion, places)))
    }

    /// A displacement of a part of the sheet, across its loads, that only surfaces can stop.
    ///
    /// # Errors
    /// N001 if there is no surface that could stop one of any direction.
    pub fn only_touched(&self) -> Result<Option<String>, SolveError> {
        let (places, pattern) = (&self.model.mesh.nodes, &self.plan.pattern);
        let carried = (!self.contact.are_none()).then(|| {
            let load = self.model.load_vector();
            load.chunks_exact(6).map(|f| Vector3::new(f[0], f[1], f[2])).sum()
        });
        let loose = loose::displacement(places, pattern, &self.held, carried);
        match loose {
            Some(motion) if carried.is_none() => Err(SolveError::loose(&motion, places)),
            other => Ok(other.map(|motion| motion.to_string())),
        }
    }
}
