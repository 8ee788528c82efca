//! Fog on meshes: the fraction of a pixel's colour that the fog replaces, from the pixel's depth code (docs/formats/triangle.md, "Fog").

use glint_core::colour::Rgb565;
use glint_core::fixed::U4_28;

use crate::depth::DepthScale;
use crate::raymarch::{FULL, faded, mixed, product};

/// Fog in a frame. Its transmittance is e^(−x), with x = density·z at the depth z along the camera's forward axis, in world units.
///
/// In perspective z is K divided by the depth code. The logarithm of x needs no division: −log2 x is log2 of the code minus
/// log2(density·K), which is a constant of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fog {
    /// The index into the table of shares is 128·log2(code) − `offset`; in orthographic projection it is −128·log2(depth) − `offset`.
    pub offset: i32,
    /// Colour of the fog: in 8 bits per channel, the upper 5, 6 and 5 bits of red, green and blue are the RGB565 value, and the remaining
    /// bits are fraction bits.
    pub colour: [u8; 3],
    /// The scale of the depth codes in orthographic projection; `None` in perspective.
    linear: Option<DepthScale>,
}

/// Base-2 logarithm of the number of table entries per octave.
const STEPS_LOG2: u32 = 7;
/// Number of octaves of the table of shares. They cover x from 2^3, where the fog hides everything, to 2^−9, where it hides nothing.
const OCTAVES: usize = 12;
/// Base-2 logarithm of the largest x in the table.
const DENSEST: i32 = 3;

impl Fog {
    /// The fog of a frame with the given density per world unit, scale of depth codes, and colour; `None` without density.
    pub fn new(density: U4_28, depth: DepthScale, colour: [u8; 3]) -> Option<Self> {
        if density == U4_28::ZERO {
            return None;
        }
        let (factor, exponent) = match depth.origin {
            // The logarithm is of density·K; this product has at most 49 bits.
            None => (depth.mantissa, depth.exponent - 28),
            // The logarithm is of the density alone; a depth has 37 fraction bits.
            Some(_) => (1, -28 - 37),
        };
        let logarithm = fine_log2(u64::from(density.to_bits()) * u64::from(factor));
        Some(Self {
            offset: logarithm + ((exponent - DENSEST) << STEPS_LOG2),
            colour: Rgb565::with_fractions(colour),
            linear: depth.origin.map(|_| depth),
        })
    }

    /// The fog with the values of an engine's registers, for a frame in perspective.
    pub const fn in_perspective(offset: i32, colour: [u8; 3]) -> Self {
        Self {
            offset,
            colour,
            linear: None,
        }
    }

    /// Whether the triangle engine supports this fog: only in perspective.
    pub const fn is_in_perspective(&self) -> bool {
        self.linear.is_none()
    }

    /// The share of a colour that the fog hides at a depth code, in 255ths.
    pub fn share(&self, code: u32) -> u8 {
        let index = match self.linear {
            None => log2(code.into()) - self.offset,
            Some(scale) => -log2(scale.linear_depth(code).max(1) as u64) - self.offset,
        };
        SHARES.get(index.max(0) as usize).copied().unwrap_or(0)
    }

    /// Mixes the `colour` of a pixel with the fog's colour `fog`, by the share at the pixel's depth code. All colours have the format of
    /// [`colour`](Self::colour).
    pub fn over(&self, fog: [u8; 3], colour: [u8; 3], code: u32) -> [u8; 3] {
        mixed(colour, fog, self.share(code))
    }
}

/// `SHARES[i]` is 255·(1 − e^(−x)) to nearest, for x = 2^(3 − (i + 1/2)/128).
const SHARES: [u8; OCTAVES << STEPS_LOG2] = {
    /// 2^(−1/128) and 2^(−1/256), with 62 fraction bits.
    const STEP: u64 = 0x3FA7_8457_1EE3_E212;
    const HALF_STEP: u64 = 0x3FD3_B2D6_5447_B229;
    let mut table = [0; OCTAVES << STEPS_LOG2];
    // x/2^3.
    let mut part = HALF_STEP;
    let mut i = 0;
    while i < table.len() {
        let hidden = FULL - faded(part >> (30 - DENSEST));
        table[i] = ((hidden as u128 * 255 + (1 << 61)) >> 62) as u8;
        part = product(part, STEP);
        i += 1;
    }
    table
};

/// 128·log2 of a number, computed from its highest eight bits with an error of up to 1.3; 0 for the number 0.
fn log2(number: u64) -> i32 {
    /// `MORE[m]` is 128·log2(1 + (m + 1/2)/128) − m, to nearest.
    const MORE: [u8; 128] = {
        let mut table = [0; 128];
        let mut m = 0;
        while m < 128 {
            table[m] = (fine_log2(257 + 2 * m as u64) - fine_log2(256) - m as i32) as u8;
            m += 1;
        }
        table
    };
    let number = number.max(1);
    let lead = number.ilog2();
    let below = (number << (63 - lead) >> (63 - STEPS_LOG2)) as usize % MORE.len();
    let more = MORE.get(below).copied().unwrap_or(0);
    (lead << STEPS_LOG2) as i32 + below as i32 + i32::from(more)
}

/// 128·log2 of a number above 0, to nearest.
const fn fine_log2(number: u64) -> i32 {
    let lead = number.ilog2();
    // In [1, 2) with 31 fraction bits; each square yields one bit of the logarithm.
    let mut mantissa = (number << (63 - lead)) >> 32;
    let mut bits = lead;
    let mut left = STEPS_LOG2 + 1;
    while left > 0 {
        let square = (mantissa * mantissa) >> 31;
        let is_two = (square >> 32) as u32;
        bits = bits << 1 | is_two;
        mantissa = square >> is_two;
        left -= 1;
    }
    bits.div_ceil(2) as i32
}
