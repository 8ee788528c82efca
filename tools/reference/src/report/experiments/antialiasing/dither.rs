//! Matrices of ordered dithering for averages of four samples.

use serde::{Deserialize, Serialize};

use super::compared::{FourSamples, displayed, mean};
use crate::camera::Vector;
use crate::errors::Errors;
use crate::picture::SHOWN;
use crate::picture::averaged::grid;
use crate::picture::dither::Matrix;

/// Errors of averages of four samples after their rounding to RGB565, against the same averages in f64: a line of
/// `antialiasing-dither.csv`. Errors are of a channel in steps of 1/255.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct DitherRow {
    /// The pictures: `scenes` for all scenes, or `ramp`.
    pub picture: String,
    /// Name of the matrix.
    pub matrix: String,
    /// How many times a colour is rounded: 1 for averages of exact samples, 2 for averages of rounded samples.
    pub roundings: u32,
    /// RMS of the errors of pixels.
    pub rms: f64,
    /// RMS of the errors of means over 8×8 pixels.
    pub means_rms: f64,
    /// Largest error of a mean over 8×8 pixels.
    pub means_largest: f64,
    /// Whether the engine rounds in this way.
    pub shipped: bool,
}

/// The ways of rounding averages of four samples: matrix, its name, and number of roundings.
fn roundings() -> impl Iterator<Item = (Matrix, &'static str, u32)> {
    let matrices = [
        (Matrix::Bayer(0), "none"),
        (Matrix::Bayer(1), "Bayer 2×2"),
        (Matrix::Bayer(2), "Bayer 4×4"),
        (Matrix::Bayer(3), "Bayer 8×8"),
        (Matrix::Glint, "Glint's"),
    ];
    [1, 2].into_iter().flat_map(move |roundings| {
        matrices
            .into_iter()
            .map(move |(matrix, name)| (matrix, name, roundings))
    })
}

/// Errors of pictures in all ways of rounding.
pub struct Sums(Vec<Dithered>);

impl Default for Sums {
    fn default() -> Self {
        Self(roundings().map(|_| Dithered::default()).collect())
    }
}

impl Sums {
    /// Adds the errors of a picture.
    pub fn add(&mut self, samples: &FourSamples) {
        for (sums, (matrix, _, roundings)) in self.0.iter_mut().zip(roundings()) {
            sums.add(samples, matrix, roundings);
        }
    }

    /// The lines of the table for these pictures.
    pub fn rows(&self, picture: &str) -> Vec<DitherRow> {
        let ways = self.0.iter().zip(roundings());
        let row = |(sums, (matrix, name, roundings)): (&Dithered, (Matrix, &str, u32))| DitherRow {
            picture: picture.to_owned(),
            matrix: name.to_owned(),
            roundings,
            rms: sums.pixels.rms(),
            means_rms: sums.means.rms(),
            means_largest: sums.means.max,
            shipped: (matrix, roundings) == (Matrix::Glint, 2),
        };
        ways.map(row).collect()
    }
}

/// The lines of the table for the ramp.
pub fn of_ramp() -> Vec<DitherRow> {
    let mut sums = Sums::default();
    sums.add(&ramp());
    sums.rows("ramp")
}

/// A slow change of grey from 0 to 255 over the picture's diagonal.
fn ramp() -> FourSamples {
    let [width, height] = SHOWN.pixels();
    let whole = f64::from(width + height);
    let offsets = grid(2);
    [0, 1, 2, 3].map(|sample: usize| {
        let [right, down] = offsets[sample];
        let places = (0..height).flat_map(|y| (0..width).map(move |x| f64::from(x + y)));
        places
            .map(|place| [255.0 * (place + right + down + 1.0) / whole; 3])
            .collect()
    })
}

/// Errors of rounded averages.
#[derive(Default)]
struct Dithered {
    /// Errors of single pixels.
    pixels: Errors,
    /// Errors of the means of blocks of 8×8 pixels.
    means: Errors,
}

impl Dithered {
    fn add(&mut self, samples: &FourSamples, matrix: Matrix, roundings: u32) {
        const SIDE: usize = 8;
        let count = SHOWN.pixel_count();
        let exact: Vec<Vector> = (0..count).map(|pixel| mean(samples, pixel)).collect();
        let found = match roundings {
            1 => matrix.picture(&exact),
            _ => matrix.averages(samples.each_ref().map(Vec::as_slice)),
        };
        let columns = SHOWN.width() as usize;
        let mut sums = vec![[0.0; 3]; count / SIDE / SIDE];
        for (pixel, (found, exact)) in found.into_iter().zip(&exact).enumerate() {
            let [column, line] = [pixel % columns, pixel / columns].map(|place| place / SIDE);
            let sum = &mut sums[line * (columns / SIDE) + column];
            for ((found, exact), sum) in displayed(found).into_iter().zip(exact).zip(sum) {
                self.pixels.add(found - exact);
                *sum += found - exact;
            }
        }
        for sum in sums.into_iter().flatten() {
            self.means.add(sum / (SIDE * SIDE) as f64);
        }
    }
}
