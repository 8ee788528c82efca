//! Sizes of a picture, the backends that draw pictures, and the edges of a mesh in pictures.

use core::fmt;

use crate::choice::choices;
use crate::constants::{PICTURES, Picture};

/// The size of a picture. The discriminant is the code of the size in registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Size {
    /// 320×180.
    #[default]
    W320,
    /// 640×360.
    W640,
    /// 1280×720.
    W1280,
}

impl Size {
    /// All sizes, the smallest first.
    pub const ALL: [Self; 3] = [Self::W320, Self::W640, Self::W1280];

    /// Returns the size with this width and height; `None` if there is no such size.
    pub fn of(width: u32, height: u32) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|size| size.pixels() == [width, height])
    }

    const fn machine(self) -> Picture {
        PICTURES[self as usize]
    }

    /// Width and height in pixels.
    pub const fn pixels(self) -> [u32; 2] {
        let Picture { width, height, .. } = self.machine();
        [width, height]
    }

    /// Width in pixels.
    pub const fn width(self) -> u32 {
        self.pixels()[0]
    }

    /// Height in pixels.
    pub const fn height(self) -> u32 {
        self.pixels()[1]
    }

    /// Number of lines in a band, one of the horizontal strips in which a picture is drawn.
    pub const fn band_lines(self) -> u32 {
        self.machine().band_lines
    }

    /// Number of bands in a picture.
    pub const fn bands(self) -> u32 {
        self.height() / self.band_lines()
    }

    /// Number of pixels: width times height.
    pub const fn pixel_count(self) -> usize {
        self.width() as usize * self.height() as usize
    }
}

/// Writes width and height, such as `320x180`.
impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}x{}", self.width(), self.height())
    }
}

/// The renderer that draws the frames of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// The software renderer: the bit-exact model of the gateware, on the soft core.
    Cpu,
    /// The blocks in the gateware: triangle engine and raymarcher.
    Gateware,
}

choices!(Backend {
    Cpu: "cpu",
    Gateware: "gateware"
});

/// The edges of a mesh in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// Only the edges, without the edges that faces hide.
    Hidden,
    /// The edges over the shaded faces.
    Over,
}

choices!(Edges {
    Hidden: "hidden",
    Over: "over"
});

#[cfg(test)]
mod tests {
    use super::Size;

    #[test]
    fn a_size_is_found_by_its_pixels() {
        for size in Size::ALL {
            assert_eq!(Size::of(size.width(), size.height()), Some(size));
        }
        assert_eq!(Size::W320.pixels(), [320, 180]);
        assert_eq!(Size::of(320, 360), None);
        assert_eq!(Size::of(0, 0), None);
    }
}
