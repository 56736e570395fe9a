//! Degrees of freedom and the groups that couple.

/// A degree of freedom of a node; the discriminant is its place among the six.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(usize)]
pub enum Dof {
    /// Displacement along x (m).
    U = 0,
    /// Displacement along y (m).
    V = 1,
    /// Displacement along z (m).
    W = 2,
    /// Rotation about x (rad).
    ThetaX = 3,
    /// Rotation about y (rad).
    ThetaY = 4,
    /// Rotation about z (rad).
    ThetaZ = 5,
}

impl Dof {
    /// All six in order.
    pub const ALL: [Self; 6] = [Self::U, Self::V, Self::W, Self::ThetaX, Self::ThetaY, Self::ThetaZ];

    /// `u`, `v`, `w`, `theta_x`, `theta_y` or `theta_z`.
    pub fn name(self) -> &'static str {
        ["u", "v", "w", "theta_x", "theta_y", "theta_z"][self as usize]
    }

    /// The dof of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|d| d.name() == name)
    }
}

/// Dofs that are solved together. In a flat sheet, bending and membrane action do not couple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DofGroup {
    /// Bending of a flat sheet: w, θx, θy.
    Plate,
    /// Membrane action of a flat sheet: u, v, θz.
    Membrane,
    /// All six.
    Shell,
}

impl DofGroup {
    /// The dofs of the group, in the order of its blocks.
    pub fn dofs(self) -> &'static [Dof] {
        match self {
            Self::Plate => &[Dof::W, Dof::ThetaX, Dof::ThetaY],
            Self::Membrane => &[Dof::U, Dof::V, Dof::ThetaZ],
            Self::Shell => &Dof::ALL,
        }
    }

    /// The part of a full vector (six a node) that belongs to the group.
    pub fn gather(self, full: &[f64]) -> Vec<f64> {
        full.chunks_exact(6).flat_map(|node| self.dofs().iter().map(|d| node[*d as usize])).collect()
    }

    /// Writes the group's part back into a full vector.
    pub fn scatter(self, part: &[f64], full: &mut [f64]) {
        for (node, values) in full.chunks_exact_mut(6).zip(part.chunks_exact(self.dofs().len())) {
            for (dof, value) in self.dofs().iter().zip(values) {
                node[*dof as usize] = *value;
            }
        }
    }
}
