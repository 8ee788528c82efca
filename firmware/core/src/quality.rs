//! Quality of pictures: presets of the picture's size and of the precision of a field's rays.

use crate::choice::choices;
use crate::picture::Size;

/// A preset that trades frames per second for accuracy of the picture (docs/scenes.md, "Quality").
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Most frames per second.
    Fast,
    /// Few errors, and four times the pixels of [`Fast`](Self::Fast).
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

/// The threshold of a hit: a ray hits where the distance is below `base` + t·2^−`footprint`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threshold {
    /// The constant part, in field units with 12 fraction bits.
    pub base: u32,
    /// The exponent of the part that grows with the ray's parameter t, 7 to 15.
    pub footprint: u32,
}

/// Settings of a quality.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Size of the picture, which a monitor shows as 1280×720.
    pub size: Size,
    /// Threshold in fields whose faces are perpendicular to an axis: errors lie at edges alone.
    pub faces: Threshold,
    /// Threshold in round fields, and in those with oblique faces: silhouettes and the normals of spheres show the position of a hit.
    pub round: Threshold,
}

const fn threshold(base: u32, footprint: u32) -> Threshold {
    Threshold { base, footprint }
}

impl Quality {
    /// Settings of this quality.
    pub const fn preset(self) -> Preset {
        match self {
            Self::Fast => Preset {
                size: Size::W320,
                faces: threshold(160, 12),
                round: threshold(28, 14),
            },
            Self::Balanced => Preset {
                size: Size::W640,
                faces: threshold(28, 14),
                round: threshold(4, 15),
            },
            Self::Exact => Preset {
                size: Size::W1280,
                faces: threshold(6, 15),
                round: threshold(2, 15),
            },
        }
    }

    /// Size of the picture.
    pub const fn size(self) -> Size {
        self.preset().size
    }
}
