//! Shading of triangles and vertices.

use glint_core::colour::Rgb565;

use crate::triangle::facing::{Facing, along};
use crate::triangle::rounding::nearest;

/// Half a depth code, u18.6, which is added to the weight of light (docs/formats/triangle.md, "Smooth shading").
pub const HALF_CODE: u32 = 1 << 5;

/// Intensity clamp(−N·l, 0, 1), u1.8, for the normal N (s2.14) and the row l of the light (s2.23). For a back face, N is negated.
pub fn intensity(normal: [i16; 3], row: &[i32; 3], facing: Facing) -> u32 {
    let product = along(normal, row);
    let towards = match facing {
        Facing::Front => -product,
        Facing::Back => product,
    };
    nearest(towards, 37 - 8).clamp(0, 1 << 8) as u32
}

/// Multiplies each channel of a colour by a factor (u1.8, at most 1), and rounds to nearest.
pub fn lit(colour: Rgb565, shares: [u32; 3]) -> Rgb565 {
    let channels = colour.channels();
    let [r, g, b] =
        [0, 1, 2].map(|i| ((u32::from(channels[i]) * shares[i] + (1 << 7)) >> 8) as u16);
    Rgb565(r << 11 | g << 5 | b)
}

/// The light L of a vertex (docs/formats/triangle.md, "Smooth shading"): red, green and blue after shading. Each channel is a fraction of
/// the channel's range, u0.16, at most 63/64.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lit(pub [u16; 3]);

impl Lit {
    /// Multiplies each channel of a colour, with the fraction bits of [`Rgb565::with_fractions`], by a factor (u1.8, at most 1), without
    /// rounding.
    pub fn new(channels: [u8; 3], shares: [u32; 3]) -> Self {
        Self([0, 1, 2].map(|i| (u32::from(channels[i]) * shares[i]) as u16))
    }

    /// Returns the value P = L·(w + ½) of each channel, u18.6, rounded to nearest. L is the channel's light, and `w` is the vertex's depth
    /// code before it is rounded to an integer (u18.6). Between the vertices P is interpolated linearly.
    pub fn weighted(self, w: u32) -> [u32; 3] {
        // The product has 24 + 16 bits.
        self.0
            .map(|x| nearest(i64::from(x) * i64::from(w + HALF_CODE), 16) as u32)
    }
}

/// The light of a vertex, for front faces and for back faces.
// Aligned to words, so that copies are always made in words.
#[repr(align(4))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Light {
    /// Light if the front face is visible.
    pub front: Lit,
    /// Light if the back face is visible.
    pub back: Lit,
}

impl Light {
    /// Returns the light of a vertex with this colour, as for [`Lit::new`], and this normal. `row` is the row of the light, and `shares`
    /// returns the factor of each channel for an intensity.
    pub fn new(
        channels: [u8; 3],
        normal: [i16; 3],
        row: &[i32; 3],
        shares: impl Fn(u32) -> [u32; 3],
    ) -> Self {
        let to = |facing| Lit::new(channels, shares(intensity(normal, row, facing)));
        Self {
            front: to(Facing::Front),
            back: to(Facing::Back),
        }
    }

    /// Returns the light for a triangle whose visible side is `facing`.
    pub const fn to(self, facing: Facing) -> Lit {
        match facing {
            Facing::Front => self.front,
            Facing::Back => self.back,
        }
    }

    /// Returns the light of the brighter side: at most one side of a vertex is lit, or both are equal.
    pub fn visible(self) -> Lit {
        let (Lit(front), Lit(back)) = (self.front, self.back);
        Lit([0, 1, 2].map(|channel| front[channel].max(back[channel])))
    }

    /// Combines two lights with `operation`, separately for each channel and for front and back faces.
    pub fn zip_with(self, other: Self, operation: impl Fn(u16, u16) -> u16) -> Self {
        let both = |Lit(a): Lit, Lit(b): Lit| {
            Lit([0, 1, 2].map(|channel| operation(a[channel], b[channel])))
        };
        Self {
            front: both(self.front, other.front),
            back: both(self.back, other.back),
        }
    }
}
