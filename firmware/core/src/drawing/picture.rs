//! Sizes and samples of a picture, the backends that draw pictures, and the edges of a mesh in pictures.

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

    /// The size of twice this width and height; `None` if there is no such size.
    pub const fn doubled(self) -> Option<Self> {
        match self {
            Self::W320 => Some(Self::W640),
            Self::W640 => Some(Self::W1280),
            Self::W1280 => None,
        }
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

/// The number of samples whose average is a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Samples {
    /// One, at the centre of the pixel.
    #[default]
    One,
    /// Four, at the centres of the quarters of the pixel: the pixels of a picture of twice the width and height.
    Four,
}

choices!(Samples {
    One: "1",
    Four: "4"
});

impl Samples {
    /// Number of samples in a line of a pixel, which is also the number of lines.
    pub const fn across(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 2,
        }
    }
}

/// A quarter of a picture: half of its width, and half of its height.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quarter {
    /// Whether the quarter is on the right side.
    pub is_right: bool,
    /// Whether the quarter is at the bottom.
    pub is_lower: bool,
}

impl Quarter {
    /// All quarters, in the order in which they are drawn.
    pub const ALL: [Self; 4] = {
        const fn quarter(is_right: bool, is_lower: bool) -> Quarter {
            Quarter { is_right, is_lower }
        }
        [
            quarter(false, false),
            quarter(true, false),
            quarter(false, true),
            quarter(true, true),
        ]
    };
}

/// The part of a picture that is drawn at once: a picture of one of the sizes, or a quarter of a picture of twice the width and height.
/// Lengths are in samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// Size of the part.
    pub size: Size,
    /// The quarter that is drawn; `None` for the whole picture.
    pub quarter: Option<Quarter>,
}

impl Window {
    /// A whole picture of this size.
    pub const fn whole(size: Size) -> Self {
        Self {
            size,
            quarter: None,
        }
    }

    /// Width and height of the whole picture.
    pub const fn picture(self) -> [u32; 2] {
        let [width, height] = self.size.pixels();
        match self.quarter {
            Some(_) => [2 * width, 2 * height],
            None => [width, height],
        }
    }

    /// Column and line of the picture at which the part begins.
    pub const fn origin(self) -> [u32; 2] {
        let [width, height] = self.size.pixels();
        match self.quarter {
            Some(Quarter { is_right, is_lower }) => {
                [width * is_right as u32, height * is_lower as u32]
            }
            None => [0; 2],
        }
    }

    /// Column and line of the middle of the picture, counted from the beginning of the part.
    pub const fn middle(self) -> [u32; 2] {
        let ([width, height], [left, top]) = (self.picture(), self.origin());
        [width / 2 - left, height / 2 - top]
    }
}

/// Makes the window that is the whole picture of this size.
impl From<Size> for Window {
    fn from(size: Size) -> Self {
        Self::whole(size)
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
