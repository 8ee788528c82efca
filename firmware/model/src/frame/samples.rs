//! Averaging of samples to the pixels of a frame with four samples per pixel (docs/formats/triangle.md, "Samples").

use glint_core::colour::{Rgb565, Rounding};
use glint_core::picture::Samples;

use super::description::Frame;

impl Frame<'_> {
    /// Stores the pixels of the frame's [window](Self::window) in `picture`, which has the frame's size. The pixels are the averages of
    /// `samples` or, with one sample per pixel, a copy of `samples`. Calls `progress` after each line.
    pub fn average(&self, samples: &[u16], picture: &mut [u16], progress: &mut dyn FnMut()) {
        let window = self.window();
        let columns = window.size.width() as usize;
        if self.drawn_samples() == Samples::One {
            for (line, pixels) in samples.chunks(columns).zip(picture.chunks_mut(columns)) {
                pixels.copy_from_slice(line);
                progress();
            }
            return;
        }
        let [left, top] = window.origin().map(|place| place as usize / 2);
        let pairs = samples.chunks_exact(2 * columns);
        let lines = picture.chunks_exact_mut(self.size.width() as usize);
        for (y, (pair, line)) in pairs.zip(lines.skip(top)).enumerate() {
            let (upper, lower) = pair.split_at(columns);
            let pixels = line.get_mut(left..).unwrap_or_default();
            average_lines([upper, lower], y as u32, self.rounding, pixels);
            progress();
        }
    }
}

/// Averages two lines of samples to the `pixels` of line y.
pub fn average_lines([upper, lower]: [&[u16]; 2], y: u32, rounding: Rounding, pixels: &mut [u16]) {
    let [upper, lower] = [upper, lower].map(|line| line.as_chunks::<2>().0);
    let quads = upper.iter().zip(lower);
    for (x, (pixel, (&[a, b], &[c, d]))) in (0..).zip(pixels.iter_mut().zip(quads)) {
        *pixel = average([a, b, c, d], threshold(rounding, x, y));
    }
}

/// The number from 0 to 3 that is added to the sum of four samples of a channel, in the pixel in column x and line y, before the sum is
/// divided by four and rounded down. Each block of 2×2 pixels contains all four thresholds. So do four neighbouring pixels with an even sum
/// of column and line, because the dithering of the samples depends on this sum ([`Rounding::threshold`]).
fn threshold(rounding: Rounding, x: u32, y: u32) -> u8 {
    const THRESHOLDS: [[u8; 4]; 2] = [[0, 2, 3, 1], [3, 1, 0, 2]];
    match rounding {
        Rounding::Dithered => THRESHOLDS[y as usize % 2][x as usize % 4],
        Rounding::Nearest => 2,
    }
}

/// The average of four samples in RGB565. The threshold is added to the sum of each channel before the division.
fn average(samples: [u16; 4], threshold: u8) -> u16 {
    let channels = samples.map(|sample| Rgb565(sample).channels());
    let [red, green, blue] = [0, 1, 2].map(|i: usize| {
        let sum: u8 = channels.iter().map(|channels| channels[i]).sum();
        u16::from((sum + threshold) >> 2)
    });
    red << 11 | green << 5 | blue
}
