//! One-dimensional laws with friction: a stress that depends on a strain and on its history.
//!
//! A [`Channel`] is the law of one strain component (a curvature, a membrane strain, an approach
//! of two faces); [`State`] is its memory at a material point. Stress and strain may be of any
//! conjugate pair: only their product, a work, has a meaning here. All numbers are SI.
#![doc = include_str!("theory.md")]

mod backbone;
mod channel;
mod widening;

pub use backbone::{Backbone, ElasticResponse};
pub use channel::{Channel, Family, MAX_SLIDERS, Mode, Response, Slider, State};
pub use widening::Widening;

use crate::finding::errors;

errors! {
    /// M020: numbers that make no law.
    #[derive(Clone, Debug, PartialEq)]
    pub enum LawError {
        /// Knots and tangents do not belong together.
        "M020" Count {
            /// Number of knots.
            knots: usize,
            /// Number of tangents.
            tangents: usize,
        } = "a backbone needs a tangent for each knot, and one at least: {knots} knots, {tangents} tangents";
        /// Knots do not increase.
        "M020" Order {
            /// A knot.
            before: f64,
            /// The next one.
            after: f64,
        } = "the knots of a backbone must increase, but {after:e} follows {before:e}";
        /// A number is negative, or not finite.
        "M020" Value {
            /// Which number.
            what: &'static str,
            /// The number.
            value: f64,
        } = "{what} of a law is {value:e}: it must be finite, and not below zero";
        /// More sliders than a state has room for.
        "M020" Sliders {
            /// Number of sliders.
            count: usize,
        } = "a law of {count} sliders: there is room for {MAX_SLIDERS}";
        /// A slider's slip level rises faster than the strain.
        "M020" Steep {
            /// Slip level of the slider.
            slip: f64,
            /// Greatest derivative of the widened level with respect to the strain.
            slope: f64,
        } = "the slip level of {slip:e} widens faster than the strain grows (slope {slope}): take a smaller one";
    }
}

#[cfg(test)]
mod tests;
