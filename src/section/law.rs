//! Laws with friction beside the matrices of a section.

use nalgebra::Matrix3;

use super::{SectionError, ShellSection};
use crate::law::{Channel, Mode, State};

/// The strains of a sheet that follow laws of their own in large-rotation statics, each alone; what
/// couples them (`D12`) and every other stiffness is that of the [`ShellSection`].
#[derive(Clone, Debug, PartialEq)]
pub struct SheetLaw {
    /// What the friction does.
    pub mode: Mode,
    /// Laws for `ε_x, ε_y, γ_xy` (N/m) and `κ_x, κ_y, κ_xy` (N·m over 1/m) in material axes; `None`
    /// where the diagonal entry of the section's `d_m` or `d_b` holds.
    pub channels: [Option<Channel>; 6],
}

impl SheetLaw {
    /// Laws in a mode.
    pub fn new(mode: Mode, channels: [Option<Channel>; 6]) -> Self {
        Self { mode, channels }
    }

    /// The linear laws of a section: its diagonals as laws without friction. For checks.
    ///
    /// # Errors
    /// M020 if a diagonal entry is negative or not finite.
    pub fn linear(section: &ShellSection) -> Result<Self, crate::law::LawError> {
        let mut channels = [const { None }; 6];
        for (i, channel) in channels.iter_mut().enumerate() {
            *channel = Some(Channel::elastic(crate::law::Backbone::line(diagonal(section, i))?));
        }
        Ok(Self { mode: Mode::Friction, channels })
    }

    /// `d_m` and `d_b` of a section without the diagonal entries that the laws replace.
    pub fn beside(&self, section: &ShellSection) -> [Matrix3<f64>; 2] {
        let (mut d_m, mut d_b) = (section.d_m, section.d_b);
        for i in (0..6).filter(|i| self.channels[*i].is_some()) {
            if i < 3 { d_m[(i, i)] = 0.0 } else { d_b[(i - 3, i - 3)] = 0.0 }
        }
        [d_m, d_b]
    }

    /// The stresses `(N_x, N_y, N_xy, M_x, M_y, M_xy)` that the laws have in states that were kept; 0 where there is none.
    pub fn stresses(&self, states: &[State; 6]) -> [f64; 6] {
        std::array::from_fn(|i| self.channels[i].as_ref().map_or(0.0, |c| c.stress(self.mode, &states[i])))
    }

    /// The laws themselves if they stay stable beside the couplings of a section: `D12²` is at most
    /// the product of the least tangents of the two laws.
    ///
    /// # Errors
    /// C003 if a strain state could release energy.
    pub fn checked(self, section: &ShellSection) -> Result<Self, SectionError> {
        let least = |i: usize| match &self.channels[i] {
            Some(channel) => channel.backbone().tangents().fold(f64::INFINITY, f64::min),
            None => diagonal(section, i),
        };
        for (matrix, d12, at) in [
            ("D_m with the least tangents of its laws", section.d_m[(0, 1)], 0),
            ("D_b with the least tangents of its laws", section.d_b[(0, 1)], 3),
        ] {
            let (a, b) = (least(at), least(at + 1));
            if d12 * d12 > a * b {
                let eigenvalue = 0.5 * (a + b - (a - b).hypot(2.0 * d12));
                return Err(SectionError::NotPositiveDefinite { matrix, eigenvalue });
            }
        }
        Ok(self)
    }
}

/// The diagonal entry of `d_m` or `d_b` of a strain.
fn diagonal(section: &ShellSection, i: usize) -> f64 {
    if i < 3 { section.d_m[(i, i)] } else { section.d_b[(i - 3, i - 3)] }
}
