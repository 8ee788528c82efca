//! Colours in RGB565, and the shading of triangles.

use crate::choice::choices;

/// A colour in the format of the frame buffer: red in bits 15–11, green in 10–5, blue in 4–0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Rgb565(pub u16);

impl Rgb565 {
    /// White: red, green and blue at their largest values.
    pub const WHITE: Self = Self(0xFFFF);

    /// Returns the RGB565 colour nearest to the given red, green and blue of 8 bits each.
    pub const fn from_rgb888(rgb: [u8; 3]) -> Self {
        const fn nearest(channel: u8, max: u32) -> u16 {
            ((channel as u32 * max * 2 + 255) / 510) as u16
        }
        Self(nearest(rgb[0], 31) << 11 | nearest(rgb[1], 63) << 5 | nearest(rgb[2], 31))
    }

    /// Scales a colour of 8 bits per channel to channels with fraction bits: red u5.3, green u6.2, blue u5.3, whose largest values are
    /// those of RGB565.
    pub const fn with_fractions([r, g, b]: [u8; 3]) -> [u8; 3] {
        [r - (r >> 5), g - (g >> 6), b - (b >> 5)]
    }

    /// The channels in the format of [`with_fractions`](Self::with_fractions), with fractions of 0.
    pub const fn fractions(self) -> [u8; 3] {
        let [r, g, b] = self.channels();
        [r << 3, g << 2, b << 3]
    }

    /// Rounds channels with fraction bits, as of [`with_fractions`](Self::with_fractions), for the pixel in column x and line y. A channel
    /// whose fraction is 0 keeps its value; a channel above the largest value wraps, as in the gateware.
    pub fn rounded([r, g, b]: [u8; 3], rounding: Rounding, place: [u32; 2]) -> Self {
        let threshold = rounding.threshold(place);
        let five = |channel: u8| (channel.wrapping_add(threshold) >> 3) as u16;
        let green = (g.wrapping_add(threshold / 2) >> 2) as u16;
        Self(five(r) << 11 | green << 5 | five(b))
    }

    /// Converts the colour to red, green and blue of 8 bits each, widened by bit replication as in the video output.
    pub const fn to_rgb888(self) -> [u8; 3] {
        let [r, g, b] = self.channels();
        [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2]
    }

    /// Red (0…31), green (0…63) and blue (0…31).
    pub const fn channels(self) -> [u8; 3] {
        [
            (self.0 >> 11) as u8,
            (self.0 >> 5 & 0x3F) as u8,
            (self.0 & 0x1F) as u8,
        ]
    }
}

/// How channels with fraction bits are rounded to RGB565.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rounding {
    /// With ordered dithering: over 4×4 pixels of one colour, the mean of a channel is the given value within 1/255.
    #[default]
    Dithered,
    /// To nearest.
    Nearest,
}

impl Rounding {
    /// The rounding with or without dithering.
    pub const fn new(is_dithered: bool) -> Self {
        match is_dithered {
            true => Self::Dithered,
            false => Self::Nearest,
        }
    }

    /// Number to add before a channel is truncated to the fraction bits that [`Rgb565::rounded`] takes, whose unit is 2^`unit_log2`. With
    /// dithering the number is half the unit. Otherwise it is 0, because `rounded` rounds to nearest, and a second rounding would be
    /// less exact.
    pub const fn before_fractions(self, unit_log2: u32) -> u32 {
        match self {
            Self::Dithered => 1 << (unit_log2 - 1),
            Self::Nearest => 0,
        }
    }

    /// Number to add to red and blue before they are truncated, for the pixel in column x and line y. Its unit is an eighth of a step of
    /// red or blue. Half of this number, rounded down, is added to green, in quarters of a step.
    pub fn threshold(self, [x, y]: [u32; 2]) -> u8 {
        match self {
            Self::Dithered => ((x ^ y) << 2 & 4 | y << 1 & 2 | (x ^ y) >> 1 & 1) as u8,
            Self::Nearest => 4,
        }
    }
}

/// Luminance of a colour (Rec. 601), rounded to nearest, for stereo pictures.
pub const fn luminance(rgb: [u8; 3]) -> u8 {
    ((fine_luminance(rgb) + HALF_LUMINANCE) >> 8) as u8
}

/// The luminance of a colour in units of 2^−8, exactly: a sum with weights that add up to 256.
pub const fn fine_luminance([r, g, b]: [u8; 3]) -> u16 {
    77 * r as u16 + 150 * g as u16 + 29 * b as u16
}

/// Half a unit of luminance, in units of 2^−8; adding it before truncation rounds to nearest.
pub const HALF_LUMINANCE: u16 = 1 << 7;

/// Source of a triangle's colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Each triangle has one colour, from the colour and normal stored with the triangle.
    #[default]
    Flat,
    /// Colours are interpolated between the vertices, from the colours and normals stored with the vertices.
    Smooth,
}

choices!(Shading {
    Flat: "flat",
    Smooth: "smooth"
});

/// Rule that determines which side of a triangle is visible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Winding {
    /// The order of the vertices in the mesh: counter-clockwise on the screen is the front.
    #[default]
    Mesh,
    /// Position on the screen: the vertices are reordered clockwise, beginning with the upper left vertex. Every triangle is
    /// visible, independent of the order of its vertices in the mesh, and normals are turned towards the camera.
    Screen,
}

choices!(Winding {
    Mesh: "mesh",
    Screen: "screen"
});

#[cfg(test)]
mod tests {
    use super::Rgb565;

    #[test]
    fn every_colour_survives_the_way_through_888() {
        for colour in (0..=u16::MAX).map(Rgb565) {
            assert_eq!(Rgb565::from_rgb888(colour.to_rgb888()), colour);
        }
    }
}
