//! The background of a picture: a colour that changes slowly over it.

use image::{GrayImage, Rgba};
use nalgebra::{Matrix6, SMatrix, SVector};

use super::raster::{Colours, Field};

/// Part of the shorter side that counts as the border.
const BORDER: f64 = 0.05;
/// About so many pixels make the fit.
const SAMPLES: usize = 6000;
/// Rounds of the fit of least distances.
const ROUNDS: usize = 12;

/// A polynomial of second order for each channel.
pub(super) struct Background {
    factors: SMatrix<f64, 6, 4>,
    size: [f64; 2],
}

impl Background {
    /// Of the border of the picture.
    pub fn of_border(colours: &Colours) -> Self {
        let (width, height) = colours.dimensions();
        let wide = (BORDER * f64::from(width.min(height))).max(2.0) as u32;
        let inside = |at: u32, size: u32| at >= wide && at + wide < size;
        Self::of(colours, |x, y| !(inside(x, width) && inside(y, height)))
    }

    /// Of what is outside a mask.
    pub fn outside(colours: &Colours, mask: &GrayImage) -> Self {
        Self::of(colours, |x, y| mask.get_pixel(x, y).0[0] == 0)
    }

    /// Least distances, which labels and dust do not pull as squares would.
    fn of(colours: &Colours, belongs: impl Fn(u32, u32) -> bool) -> Self {
        let (width, height) = colours.dimensions();
        let size = [f64::from(width), f64::from(height)];
        let all: Vec<(u32, u32)> = (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .filter(|&(x, y)| belongs(x, y))
            .collect();
        let samples: Vec<(SVector<f64, 6>, SVector<f64, 4>)> = all
            .iter()
            .step_by((all.len() / SAMPLES).max(1))
            .map(|&(x, y)| (terms(x, y, size), colour(colours.get_pixel(x, y))))
            .collect();
        let mut background = Self { factors: SMatrix::zeros(), size };
        let mut weights = vec![1.0; samples.len()];
        for _ in 0..ROUNDS {
            let (mut left, mut right) = (Matrix6::<f64>::identity() * 1e-9, SMatrix::<f64, 6, 4>::zeros());
            for ((t, c), w) in samples.iter().zip(&weights) {
                left += *w * t * t.transpose();
                right += *w * t * c.transpose();
            }
            let Some(factors) = left.cholesky().map(|l| l.solve(&right)) else { break };
            background.factors = factors;
            for ((t, c), w) in samples.iter().zip(&mut weights) {
                *w = 1.0 / ((c - factors.transpose() * t).norm() + 2e-3);
            }
        }
        background
    }

    /// How far each pixel is from the background.
    pub fn distance(&self, colours: &Colours) -> Field {
        Field::from_fn(colours.width(), colours.height(), |x, y| {
            let expected = self.factors.transpose() * terms(x, y, self.size);
            image::Luma([(colour(colours.get_pixel(x, y)) - expected).norm() as f32])
        })
    }
}

fn terms(x: u32, y: u32, [width, height]: [f64; 2]) -> SVector<f64, 6> {
    let (x, y) = (2.0 * f64::from(x) / width - 1.0, 2.0 * f64::from(y) / height - 1.0);
    SVector::from([1.0, x, y, x * x, x * y, y * y])
}

/// A colour as a vector.
pub(super) fn colour(Rgba(channels): &Rgba<f32>) -> SVector<f64, 4> {
    SVector::from(channels.map(f64::from))
}
