//! From where a motion goes on, and what it moves by force.

use std::f64::consts::TAU;

use super::motion::{Motion, Now, Rates};
use crate::model::RigidSurface;
use crate::section::SheetLaw;
use crate::solve::nonlinear::Carried;

/// From where a motion goes on, and what it moves; from rest, and nothing, by default.
#[derive(Clone, Copy, Debug, Default)]
pub struct Launch<'a> {
    /// The state in which the sheet is let go: what acted in it goes over into the loads of the motion as the factor of these
    /// grows, and what was held in it and is held no longer is let go of at once.
    pub carried: Option<&'a Carried>,
    /// Dofs that supports move; the model holds them.
    pub guided: &'a [Guided],
    /// Laws with friction in the place of diagonal entries of the section.
    pub law: Option<&'a SheetLaw>,
    /// Rigid surfaces that the sheet cannot pass; for the method that conserves the energy.
    pub surfaces: &'a [RigidSurface],
}

/// A dof of a node that a support moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Guided {
    /// Node.
    pub node: u32,
    /// Dof of it, 0 to 5.
    pub dof: usize,
    /// How it moves.
    pub course: Course,
}

/// A displacement (m) or rotation (rad) in time, counted from where the motion begins.
#[derive(Clone, Debug, PartialEq)]
pub enum Course {
    /// To a value evenly until a time (s), and there it stays.
    Ramp {
        /// The value.
        value: f64,
        /// The time.
        until: f64,
    },
    /// A value times sin(2π f t).
    Sine {
        /// The value.
        value: f64,
        /// Frequency (Hz).
        frequency: f64,
    },
    /// Times (s), ascending from 0, and values: straight from one to the next, and after the last it stays.
    Table(Vec<[f64; 2]>),
}

impl Course {
    /// The value at a time (s).
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Self::Ramp { value, until } => value * (t / until).min(1.0),
            Self::Sine { value, frequency } => value * (TAU * frequency * t).sin(),
            Self::Table(points) => {
                let Some([[t0, u0], [t1, u1]]) = piece(points, t) else {
                    return points.last().map_or(0.0, |[_, u]| *u);
                };
                u0 + (u1 - u0) * (t - t0) / (t1 - t0)
            }
        }
    }

    /// Its rate from a time (s) on.
    pub fn rate(&self, t: f64) -> f64 {
        match self {
            Self::Ramp { value, until } if t < *until => value / until,
            Self::Ramp { .. } => 0.0,
            Self::Sine { value, frequency } => value * TAU * frequency * (TAU * frequency * t).cos(),
            Self::Table(points) => piece(points, t).map_or(0.0, |[[t0, u0], [t1, u1]]| (u1 - u0) / (t1 - t0)),
        }
    }
}

/// The points of a table about a time; none after the last.
fn piece(points: &[[f64; 2]], t: f64) -> Option<[[f64; 2]; 2]> {
    points.windows(2).find(|pair| t < pair[1][0]).map(|pair| [pair[0], pair[1]])
}

impl Motion<'_> {
    /// Gives the dofs that supports move what they move by in a step that ends at a time.
    pub fn guide(&self, travelled: &mut [f64], time: f64, dt: f64) {
        for (d, course) in &self.guided {
            travelled[*d] = course.at(time) - course.at(time - dt);
        }
    }

    /// Gives these dofs the rates of their courses. Inertia meets the mean acceleration of the step: a course with a corner has
    /// an impulse there, and no vibration of the method.
    pub fn steer(&self, mut rates: Rates, now: &Now, time: f64, dt: f64) -> Rates {
        for (d, course) in &self.guided {
            let velocity = course.rate(time);
            rates.velocity[*d] = velocity;
            rates.acceleration[*d] = (velocity - now.velocity[*d]) / dt;
            rates.mean_acceleration[*d] = rates.acceleration[*d];
            if !self.conserves() {
                rates.acting[*d] = velocity;
            }
        }
        rates
    }

    /// Work of moved supports in a step: of the mean forces (by dof) on what they move by, and of inertia on the mean velocity,
    /// which is what the kinetic energy grows by.
    pub fn work_of_supports(
        &self,
        now: &Now,
        next: (&Rates, &[f64]),
        forces: (&[f64], &[f64]),
        dt: f64,
    ) -> f64 {
        let ((rates, travelled), (steady, inertia)) = (next, forces);
        let works = self.guided.iter().map(|&(d, _)| {
            let mean = 0.5 * (now.velocity[d] + rates.velocity[d]);
            steady[d] * travelled[d] + inertia[d] * mean * dt
        });
        works.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn courses_go_where_they_are_sent() {
        let table = Course::Table(vec![[0.0, 0.0], [0.5, 2.0], [1.0, 1.0]]);
        let ramp = Course::Ramp { value: 2.0, until: 0.5 };
        let sine = Course::Sine { value: 3.0, frequency: 0.25 };
        for (t, in_table, on_ramp) in
            [(0.0, 0.0, 0.0), (0.25, 1.0, 1.0), (0.5, 2.0, 2.0), (0.75, 1.5, 2.0), (9.0, 1.0, 2.0)]
        {
            assert_eq!((table.at(t), ramp.at(t)), (in_table, on_ramp), "{t}");
        }
        assert_eq!([0.0, 0.5, 0.75, 1.0].map(|t| table.rate(t)), [4.0, -2.0, -2.0, 0.0]);
        assert_eq!([0.0, 0.4, 0.5].map(|t| ramp.rate(t)), [4.0, 4.0, 0.0]);
        assert!(
            (sine.at(1.0) - 3.0).abs() < 1e-15 && (sine.rate(0.0) - 1.5 * std::f64::consts::PI).abs() < 1e-15
        );
    }
}
