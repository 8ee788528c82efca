//! Frames with several samples a pixel, and their differences from a reference.

use anyhow::Result;
use glint::scene::{self, Changes};
use glint_core::colour::{Rgb565, Rounding};
use glint_core::picture::Samples;
use glint_core::quality::Quality;
use glint_model::Frame;
use glint_scene_file::SceneFile;

use crate::camera::Vector;
use crate::errors::Errors;
use crate::picture::SHOWN;
use crate::picture::averaged::{Averaged, grid};
use crate::picture::exact::Exact;

/// A frame as it is measured: 1280×720, with all options that this page compares.
pub fn measured<'a>(frame: &Frame<'a>, samples: Samples, rounding: Rounding) -> Frame<'a> {
    Frame {
        size: SHOWN,
        samples,
        rounding,
        ..*frame
    }
}

/// Calls `draw` with the frame of a scene in the exact quality.
///
/// # Errors
/// No board can draw the scene, or `draw` fails.
pub fn draw<T>(scene: &SceneFile, draw: impl FnOnce(&Frame) -> Result<T>) -> Result<T> {
    let changes = Changes {
        quality: Some(Quality::Exact),
        size: Some(SHOWN),
        ..Changes::default()
    };
    scene::draw(scene, &changes, draw)?
}

/// Errors of all pixels, and of the pixels along edges.
#[derive(Default)]
pub struct Compared {
    /// Of all pixels.
    pub all: Errors,
    /// Of the pixels whose samples in the reference show more than one surface.
    pub edges: Errors,
}

impl Compared {
    /// Compares colours with a reference.
    pub fn new(found: impl IntoIterator<Item = Vector>, exact: &Averaged) -> Self {
        let mut errors = Self::default();
        let expected = exact.colours.iter().zip(&exact.edges);
        for (found, (expected, &is_edge)) in found.into_iter().zip(expected) {
            for (found, expected) in found.into_iter().zip(expected) {
                errors.all.add(found - expected);
                if is_edge {
                    errors.edges.add(found - expected);
                }
            }
        }
        errors
    }
}

/// The colour on the monitor.
pub fn displayed(pixel: Rgb565) -> Vector {
    pixel.to_rgb888().map(f64::from)
}

/// The pictures of the four samples of a pixel, row by row.
pub type FourSamples = [Vec<Vector>; 4];

/// Draws the four samples of a pixel in f64.
///
/// # Errors
/// The frame cannot be drawn in f64.
pub fn four_samples(frame: &Frame) -> Result<FourSamples> {
    let mut pictures = FourSamples::default();
    for (picture, offset) in pictures.iter_mut().zip(grid(2)) {
        *picture = Exact::at(frame, offset)?.colours;
    }
    Ok(pictures)
}

/// The mean of the colours of four samples.
pub fn mean(samples: &FourSamples, pixel: usize) -> Vector {
    [0, 1, 2].map(|i: usize| samples.iter().map(|sample| sample[pixel][i]).sum::<f64>() / 4.0)
}
