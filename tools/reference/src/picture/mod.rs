//! Whole pictures: a frame in f64, and the errors of the model's picture as displayed on a monitor.
//!
//! - [`exact`]: the frame in f64, from triangles, exact hits of rays and exact segments, with light, fog and sky in f64.
//! - [`averaged`]: the same frame with several samples a pixel.
//! - [`dither`]: its colours in RGB565.
//! - [`drawn`]: the surface visible at each pixel of the model's picture.

pub mod averaged;
pub mod dither;
pub mod drawn;
pub mod exact;
mod seen;

pub use seen::{Eyes, SHOWN, Seen};

use anyhow::Result;
use glint::picture::Image;
use glint::render;
use glint_core::colour::Rgb565;
use glint_core::picture::Samples;
use glint_model::Frame;

use self::averaged::Averaged;
use self::exact::Exact;
use crate::errors::Errors;

/// Errors of a picture as displayed on a monitor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Fraction of the pixels at which an eye sees a different surface than in the reference: a different triangle, face, object or sphere,
    /// or a surface instead of the background.
    pub wrong: f64,
    /// RMS of the errors of red, green and blue against the mean of many samples, in steps of 1/255.
    pub colour: f64,
}

/// Draws a frame with the model, and compares the displayed picture with the same frame in f64: the surface at the centre of each pixel
/// with `exact`, and its colour with `mean`. A pixel of a smaller picture is a square of the monitor's pixels.
///
/// # Errors
/// The model cannot draw the frame.
pub fn measure(frame: &Frame, exact: &Exact, mean: &Averaged) -> Result<Measured> {
    let Image { width, colour, .. } = render::on_model(frame)?.image;
    let seen = drawn::seen(&Frame {
        samples: Samples::One,
        ..*frame
    })?;
    let scale = SHOWN.width() / width;
    let mut errors = Errors::default();
    let mut wrong = 0_u64;
    let [columns, rows] = SHOWN.pixels();
    let places = (0..rows).flat_map(|y| (0..columns).map(move |x| (x / scale, y / scale)));
    for ((x, y), (expected, exact)) in places.zip(exact.seen.iter().zip(&mean.colours)) {
        let place = (y * width + x) as usize;
        wrong += u64::from(seen[place] != *expected);
        let found = Rgb565(colour[place]).to_rgb888();
        for (found, exact) in found.into_iter().zip(exact) {
            errors.add(f64::from(found) - exact);
        }
    }
    Ok(Measured {
        wrong: wrong as f64 / SHOWN.pixel_count() as f64,
        colour: errors.rms(),
    })
}
