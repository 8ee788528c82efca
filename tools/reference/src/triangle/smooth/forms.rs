//! Forms of smooth shading: the light of a pixel before its last rounding, with and without the division by depth at each pixel.

use glint_model::triangle::setup::{Plane, Setup};

use super::{Interpolated, Pixel, RANGES};

/// A form of smooth shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Light linear on the screen, in f64.
    Affine,
    /// Exact light in the first and the last lane of a group of eight pixels, in f64, clamped to the range of a channel because
    /// these lanes may lie outside the triangle. Light is linear between these lanes.
    GroupEnds,
    /// Light by Glint's division at the first and the last covered pixel of a group, and linear between these pixels.
    CoveredEnds,
    /// A division at each pixel.
    Pixels(Inverse),
}

/// The reciprocal of a division: a table of 2^`index` entries, each with `index` + 7 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inverse {
    /// Number of bits of the depth's mantissa for the index of an entry.
    pub index: u32,
    /// Whether a Newton step follows the table lookup. The Newton step's result has 17 bits.
    pub newton: bool,
}

impl Inverse {
    /// Glint's table: 1024 entries of 17 bits.
    pub const GLINT: Self = Self {
        index: 10,
        newton: false,
    };

    /// Returns the reciprocal of m and its number of fraction bits, for 1 ≤ m < 2 with 31 fraction bits.
    fn of(self, m: u32) -> (u64, u32) {
        let bits = self.index + 7;
        let entry = m << 1 >> (32 - self.index);
        // The exact entry is 2^(bits + index + 1)/d.
        let d = u64::from((2 << self.index) + 2 * entry + 1);
        let inverse = ((2 << (bits + self.index + 1)) + d) / (2 * d);
        if !self.newton {
            return (inverse, bits);
        }
        // Newton step y·(2 − m·y), with 17 fraction bits.
        let error = (2 << (31 + bits)) - u64::from(m) * inverse;
        let product = u128::from(inverse) * u128::from(error);
        let cut = 31 + 2 * bits - 17;
        (((product + (1 << (cut - 1))) >> cut) as u64, 17)
    }
}

/// The light of the pixels of a triangle.
pub struct Light<'a> {
    /// The model's setup of the triangle.
    pub setup: &'a Setup,
    /// The exact light of the triangle.
    pub exact: Interpolated,
}

impl Light<'_> {
    /// Returns red, green and blue of the covered pixels of a group, in steps of a channel before the rounding to whole steps.
    pub fn group(&self, form: Form, pixels: &[Pixel]) -> Vec<[f64; 3]> {
        let [Some(first), Some(last)] = [pixels.first(), pixels.last()] else {
            return vec![];
        };
        match form {
            Form::Affine => pixels
                .iter()
                .map(|pixel| self.exact.affine(pixel.centre()))
                .collect(),
            Form::Pixels(inverse) => pixels
                .iter()
                .map(|pixel| self.divided(inverse, pixel))
                .collect(),
            Form::GroupEnds => {
                let start = first.column & !7;
                let [left, right] = [start, start + 7].map(|column| {
                    let exact = self.exact.perspective(Pixel { column, ..*first }.centre());
                    [0, 1, 2].map(|i: usize| exact[i].clamp(0.0, RANGES[i] * 63.0 / 64.0))
                });
                between((start, left), (start + 7, right), pixels)
            }
            Form::CoveredEnds => {
                let [left, right] = [first, last].map(|pixel| self.divided(Inverse::GLINT, pixel));
                between((first.column, left), (last.column, right), pixels)
            }
        }
    }

    /// Returns light divided by depth at a pixel, as in docs/formats/triangle.md, "Smooth shading", with the given reciprocal.
    fn divided(&self, inverse: Inverse, pixel: &Pixel) -> [f64; 3] {
        let value = |plane: &Plane| {
            let right = (pixel.column - self.setup.start_column) as u32;
            let down = (pixel.row - self.setup.bounds.top) as u32;
            plane
                .start
                .wrapping_add(plane.step_x.wrapping_mul(right))
                .wrapping_add(plane.step_y.wrapping_mul(down))
        };
        let depth = value(&self.setup.depth).wrapping_add(1 << 13);
        let shift = depth.leading_zeros().min(11);
        let (inverse, bits) = inverse.of(depth << shift);
        let light = self.setup.light.expect("shading is smooth");
        [0, 1, 2].map(|channel| {
            let value = value(&light[channel]);
            if value >> 26 == 0x3F {
                return 0.0;
            }
            let product = (u64::from(value >> 8) * inverse) as f64;
            product * RANGES[channel] * f64::from(shift as i32 - 23 - bits as i32).exp2()
        })
    }
}

/// Interpolates light linearly between two columns.
fn between(
    (left, from): (i32, [f64; 3]),
    (right, to): (i32, [f64; 3]),
    pixels: &[Pixel],
) -> Vec<[f64; 3]> {
    let width = f64::from((right - left).max(1));
    let part = |pixel: &Pixel| f64::from(pixel.column - left) / width;
    let light = |part: f64| [0, 1, 2].map(|i: usize| from[i] + part * (to[i] - from[i]));
    pixels.iter().map(|pixel| light(part(pixel))).collect()
}
