//! Rounding of colours in f64 to RGB565, with matrices of ordered dithering.

use glint_core::colour::{Rgb565, Rounding};
use glint_core::picture::Samples;
use glint_model::average_lines;

use super::SHOWN;
use crate::camera::Vector;

/// Thresholds that depend on a pixel's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matrix {
    /// Bayer's matrix of 2^n × 2^n thresholds. With n = 0 colours are rounded to nearest.
    Bayer(u32),
    /// The engine's matrix ([`Rounding::threshold`]) of 4×4 places: eight thresholds for red and blue, four for green.
    Glint,
}

impl Matrix {
    /// The matrix of the engine's rounding.
    pub const fn of(rounding: Rounding) -> Self {
        match rounding {
            Rounding::Dithered => Self::Glint,
            Rounding::Nearest => Self::Bayer(0),
        }
    }

    /// The thresholds of red, green and blue, in steps of RGB565: the addends of the channels before they are rounded down.
    fn thresholds(self, [x, y]: [u32; 2]) -> Vector {
        let middle = |number: u32, log2: u32| (f64::from(number) + 0.5) / f64::from(1 << log2);
        match self {
            Self::Bayer(size) => {
                let number = (0..size).fold(0, |number, bit| {
                    4 * number + 2 * ((x ^ y) >> bit & 1) + (y >> bit & 1)
                });
                [middle(number, 2 * size); 3]
            }
            Self::Glint => {
                let number = u32::from(Rounding::Dithered.threshold([x, y]));
                [middle(number, 3), middle(number / 2, 2), middle(number, 3)]
            }
        }
    }

    /// Rounds a colour, whose channels are from 0 to 255, for the pixel in column x and line y.
    pub fn rounded(self, colour: Vector, place: [u32; 2]) -> Rgb565 {
        let thresholds = self.thresholds(place);
        let [red, green, blue] = [0, 1, 2].map(|i: usize| {
            let most = [31.0, 63.0, 31.0][i];
            (colour[i] / 255.0 * most + thresholds[i]).clamp(0.0, most) as u16
        });
        Rgb565(red << 11 | green << 5 | blue)
    }

    /// Rounds a picture of 1280×720.
    pub fn picture(self, colours: &[Vector]) -> Vec<Rgb565> {
        let places = (0..SHOWN.height()).flat_map(|y| (0..SHOWN.width()).map(move |x| [x, y]));
        let pixels = places.zip(colours);
        pixels
            .map(|(place, colour)| self.rounded(*colour, place))
            .collect()
    }

    /// Rounds the samples of a picture of 1280×720, and then the averages of the rounded samples, as the engine does. `samples` are the
    /// pictures of the four samples of a pixel, row by row. A sum of four channels has two fraction bits, so an average has four of the
    /// matrix's thresholds.
    pub fn averages(self, samples: [&[Vector]; 4]) -> Vec<Rgb565> {
        let columns = SHOWN.width();
        let mut picture = Vec::new();
        for y in 0..SHOWN.height() {
            let [upper, lower] = [0, 1].map(|down: u32| -> Vec<u16> {
                let places = (0..Samples::Four.across() * columns).map(|x| {
                    let sample = samples[(2 * down + x % 2) as usize];
                    let colour = sample[(y * columns + x / 2) as usize];
                    self.rounded(colour, [x, 2 * y + down]).0
                });
                places.collect()
            });
            let mut line = vec![0; columns as usize];
            match self {
                Self::Glint => average_lines([&upper, &lower], y, Rounding::Dithered, &mut line),
                Self::Bayer(_) => {
                    let quads = upper
                        .as_chunks::<2>()
                        .0
                        .iter()
                        .zip(lower.as_chunks::<2>().0);
                    for (x, (pixel, (&[a, b], &[c, d]))) in (0..).zip(line.iter_mut().zip(quads)) {
                        *pixel = self.average([a, b, c, d], [x, y]).0;
                    }
                }
            }
            picture.extend(line.into_iter().map(Rgb565));
        }
        picture
    }

    /// The average of four samples in RGB565, rounded for the pixel in column x and line y.
    fn average(self, samples: [u16; 4], place: [u32; 2]) -> Rgb565 {
        let channels = samples.map(|sample| Rgb565(sample).channels());
        let thresholds = self.thresholds(place);
        let [red, green, blue] = [0, 1, 2].map(|i: usize| {
            let sum: u16 = channels.iter().map(|channels| u16::from(channels[i])).sum();
            (sum + (4.0 * thresholds[i]) as u16) / 4
        });
        Rgb565(red << 11 | green << 5 | blue)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The thresholds of red over a matrix of this size.
    fn thresholds(matrix: Matrix, size: u32) -> Vec<f64> {
        let places = (0..size).flat_map(|y| (0..size).map(move |x| [x, y]));
        places.map(|place| matrix.thresholds(place)[0]).collect()
    }

    #[test]
    fn matrices_have_all_thresholds() {
        assert_eq!(thresholds(Matrix::Bayer(0), 1), [0.5]);
        assert_eq!(
            thresholds(Matrix::Bayer(1), 2),
            [0.125, 0.625, 0.875, 0.375]
        );
        for (matrix, size, count) in [
            (Matrix::Bayer(2), 4, 16),
            (Matrix::Bayer(3), 8, 64),
            (Matrix::Glint, 4, 8),
        ] {
            let mut found = thresholds(matrix, size);
            found.sort_by(f64::total_cmp);
            found.dedup();
            let expected: Vec<_> = (0..count)
                .map(|i| (f64::from(i) + 0.5) / f64::from(count))
                .collect();
            assert_eq!(found, expected, "{matrix:?}");
        }
    }

    /// The engine rounds channels with fraction bits like the matrix rounds exact channels.
    #[test]
    fn the_engine_rounds_in_the_same_way() {
        for rounding in [Rounding::Dithered, Rounding::Nearest] {
            for place in (0..4).flat_map(|y| (0..4).map(move |x| [x, y])) {
                for number in 0..=248 {
                    let fine = [number, number.min(252), number];
                    // Slightly above a tie: rounding errors would otherwise decide the result.
                    let steps = fine.map(|channel| f64::from(channel) + 1e-9);
                    let colour = [0, 1, 2].map(|i: usize| {
                        let (most, fractions) = [(31.0, 8.0), (63.0, 4.0), (31.0, 8.0)][i];
                        255.0 * steps[i] / (most * fractions)
                    });
                    let found = Matrix::of(rounding).rounded(colour, place);
                    assert_eq!(found, Rgb565::rounded(fine, rounding, place), "{number}");
                }
            }
        }
    }

    #[test]
    fn averages_of_rounded_samples_keep_a_colour_of_rgb565() {
        let colour = Rgb565(0x5A_CB);
        let channels = colour.channels().map(f64::from);
        let exact = [0, 1, 2].map(|i: usize| 255.0 * channels[i] / [31.0, 63.0, 31.0][i]);
        let sample = vec![exact; SHOWN.pixel_count()];
        for matrix in [
            Matrix::Bayer(0),
            Matrix::Bayer(1),
            Matrix::Bayer(2),
            Matrix::Glint,
        ] {
            let averages = matrix.averages([&sample; 4]);
            assert!(averages.iter().all(|&pixel| pixel == colour), "{matrix:?}");
        }
    }
}
