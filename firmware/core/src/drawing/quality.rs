//! Quality of pictures: presets for size and samples of the picture, and for the precision of rays in a distance field.

use crate::choice::choices;
use crate::picture::{Samples, Size};

/// A preset that trades frames per second for accuracy of the picture (docs/scenes.md, "Quality").
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Highest frame rate.
    Fast,
    /// Few errors, and four times as many pixels as [`Fast`](Self::Fast).
    #[default]
    Balanced,
    /// The smallest errors.
    Exact,
}

choices!(Quality {
    Fast: "fast",
    Balanced: "balanced",
    Exact: "exact",
});

/// Threshold of a marching ray: the ray hits if the distance is below `base` + z·2^−`footprint` at the
/// depth z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threshold {
    /// The constant part of the threshold, in field units with 12 fraction bits.
    pub base: u32,
    /// The exponent of the part that grows with the depth, 7 to 15.
    pub footprint: u32,
}

/// Settings of a quality preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Size of the picture, which scan-out enlarges to 1280×720.
    pub size: Size,
    /// Number of samples whose average is a pixel; `None` for the number at which the board draws 60 frames per second.
    pub samples: Option<Samples>,
    /// Threshold of marching rays.
    pub threshold: Threshold,
}

const fn threshold(base: u32, footprint: u32) -> Threshold {
    Threshold { base, footprint }
}

impl Quality {
    /// Settings of this quality preset.
    pub const fn preset(self) -> Preset {
        match self {
            Self::Fast => Preset {
                size: Size::W320,
                samples: Some(Samples::One),
                threshold: threshold(28, 14),
            },
            Self::Balanced => Preset {
                size: Size::W640,
                samples: None,
                threshold: threshold(4, 15),
            },
            Self::Exact => Preset {
                size: Size::W1280,
                samples: Some(Samples::Four),
                threshold: threshold(2, 15),
            },
        }
    }

    /// Samples of this preset's pixels.
    pub const fn samples(self) -> Option<Samples> {
        self.preset().samples
    }

    /// Size of this preset's picture.
    pub const fn size(self) -> Size {
        self.preset().size
    }
}
