//! The directions of a frame's rays before they are narrowed to the gateware's word lengths.

use glint_core::camera::{Projection, View};
use glint_core::fixed::{Q2_23, U8_28};
use glint_core::picture::Window;

use crate::error::{FIELD_HALF_WIDTH, RenderError};

/// Directions of the pixels' rays with 51 fraction bits, scaled so that the component along the camera's forward axis n is 1. `narrow`
/// converts a direction to D of docs/formats/raymarch.md ("Rays").
pub(super) struct Directions {
    /// Direction of the ray of the window's first pixel, for each eye.
    pub first: [[i64; 3]; 2],
    /// Change of the direction from a pixel to the next pixel on the right.
    pub across: [i64; 3],
    /// Change of the direction from a pixel to the pixel below.
    pub down: [i64; 3],
    /// The exponent e, 0 to 3: D is 2^−e times the direction whose component along the camera's forward axis n is 1. e is chosen so that
    /// each component of D is smaller than 1.
    pub exponent: u32,
}

impl Directions {
    /// Computes the directions for the cameras of two eyes, which differ only in position and shift. For one eye, pass the same camera
    /// twice.
    pub fn new(eyes: &[View; 2], window: Window) -> Self {
        let ([view, _], [width, height]) = (eyes, window.picture());
        // The quotient of a length in the window and its number of pixels, both doubled; the dividend is below 2^54.
        let step = |row: [Q2_23; 3], (pixels, length): (u32, U8_28)| {
            let length = length.to_bits() as i64;
            row.map(|x| (2 * length * i64::from(x.to_bits())) / i64::from(2 * pixels))
        };
        let [of_width, of_height] = view.lens().scales([width, height]);
        let (across, down) = (step(view.u(), of_width), step(view.v(), of_height));
        let first = eyes.map(|eye| {
            let [right, below] = eye.lens().middle().map(|x| i64::from(x.to_bits()));
            [0, 1, 2].map(|i: usize| {
                (i64::from(view.n()[i].to_bits()) << 28)
                    + right * i64::from(view.u()[i].to_bits())
                    + below * i64::from(view.v()[i].to_bits())
                    - (i64::from(width - 1) * across[i] + i64::from(height - 1) * down[i]) / 2
            })
        });
        // The direction is linear over the picture, so the magnitude of each component is largest in a corner.
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

    /// Converts a component of a direction to a component of D: multiplies by 2^−e and rounds to nearest, to 30 fraction bits.
    pub fn narrow(&self, x: i64) -> i32 {
        let shift = 21 + self.exponent;
        ((x + (1 << (shift - 1))) >> shift) as i32
    }
}

/// Checks that a field can be drawn with this camera.
///
/// # Errors
/// [`RenderError::Orthographic`], [`RenderError::HalfWidth`] for a camera that is too narrow or too wide, and [`RenderError::Sides`] for a
/// camera whose window is too low, too high or too far from its axis.
pub(super) fn check(view: &View) -> Result<(), RenderError> {
    if view.projection() == Projection::Orthographic {
        return Err(RenderError::Orthographic);
    }
    let lens = view.lens();
    let [least, most] = FIELD_HALF_WIDTH;
    if !(least..=most).contains(&lens.half_width()) {
        return Err(RenderError::HalfWidth(lens.half_width()));
    }
    let middle = lens.middle().map(|x| U8_28::from(x.unsigned_abs()));
    let half = [lens.half_width(), lens.half_height()];
    let is_within = |(middle, half): (U8_28, U8_28)| middle + half <= most;
    // The least half height is 9/16 of the least half width, as with square pixels, rounded to nearest.
    let is_high = lens.half_height().to_bits() >= (9 * least.to_bits() + 8) >> 4;
    if !is_high || !core::iter::zip(middle, half).all(is_within) {
        return Err(RenderError::Sides);
    }
    Ok(())
}
