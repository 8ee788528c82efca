//! The directions of a frame's rays in full precision.

use glint_core::camera::{Projection, View};
use glint_core::fixed::Q2_23;
use glint_core::picture::Window;

use crate::error::{FIELD_HALF_WIDTH, RenderError};

/// Directions of the pixels' rays with 51 fraction bits, scaled so that their component along the camera's forward axis n
/// is 1. `narrow` converts them to the directions D of docs/formats/raymarch.md ("Rays").
pub(super) struct Directions {
    /// Direction of the ray of the window's first pixel, for each eye.
    pub first: [[i64; 3]; 2],
    /// Change of the direction per pixel to the right.
    pub across: [i64; 3],
    /// Change of the direction per pixel down.
    pub down: [i64; 3],
    /// The exponent e, 0 to 3: D is 2^−e times the direction whose component along the camera's forward axis n is 1. This
    /// makes each component of D smaller than 1.
    pub exponent: u32,
}

impl Directions {
    /// Computes the directions for the cameras of two eyes, which differ only in position and shift, or for one camera given twice.
    pub fn new(eyes: &[View; 2], window: Window) -> Self {
        let ([view, _], [width, height]) = (eyes, window.picture());
        let half_width = view.half_width().to_bits() as i64;
        // The width of the picture at distance 1 divided by the number of pixels; the dividend is below 2^54.
        let step = |row: [Q2_23; 3]| {
            row.map(|x| (2 * half_width * i64::from(x.to_bits())) / i64::from(width))
        };
        let (across, down) = (step(view.u()), step(view.v()));
        let first = eyes.map(|eye| {
            [0, 1, 2].map(|i: usize| {
                (i64::from(view.n()[i].to_bits()) << 28)
                    + i64::from(eye.shift().to_bits()) * i64::from(view.u()[i].to_bits())
                    - (i64::from(width - 1) * across[i] + i64::from(height - 1) * down[i]) / 2
            })
        });
        // The direction is linear over the picture, so each component is largest in a corner.
        let corners = first.iter().flat_map(|&first| {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
                [0, 1, 2].map(|i: usize| {
                    (first[i]
                        + x * i64::from(width - 1) * across[i]
                        + y * i64::from(height - 1) * down[i])
                        .abs()
                })
            })
        });
        // Slightly below 1, because the steps are rounded.
        const ONE: i64 = (1 << 51) - (1 << 36);
        let largest = corners.flatten().max().unwrap_or(0);
        let exponent = (0..3).find(|&e| largest >> e < ONE).unwrap_or(3);
        let [column, line] = window.origin().map(i64::from);
        Self {
            first: first.map(|first| {
                [0, 1, 2].map(|i: usize| first[i] + column * across[i] + line * down[i])
            }),
            across,
            down,
            exponent,
        }
    }

    /// Converts a component of a direction to D: multiplies it by 2^−e and rounds it to 30 fraction bits, to nearest.
    pub fn narrow(&self, x: i64) -> i32 {
        let shift = 21 + self.exponent;
        ((x + (1 << (shift - 1))) >> shift) as i32
    }
}

/// Checks that a field can be drawn with this camera.
///
/// # Errors
/// [`RenderError::Orthographic`], and [`RenderError::HalfWidth`] for a camera that is too narrow or too wide.
pub(super) fn check(view: &View) -> Result<(), RenderError> {
    if view.projection() == Projection::Orthographic {
        return Err(RenderError::Orthographic);
    }
    if !(FIELD_HALF_WIDTH[0]..=FIELD_HALF_WIDTH[1]).contains(&view.half_width()) {
        return Err(RenderError::HalfWidth(view.half_width()));
    }
    Ok(())
}
