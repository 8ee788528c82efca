//! The volume to which triangles are clipped.

use glint_core::fixed::U8_28;

/// Which triangles are clipped, and to which volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clip {
    /// Triangles that cross the near plane or leave the guard band are clipped. There is no far plane.
    #[default]
    Guard,
    /// Triangles that leave the view volume are clipped to its six planes: the sides of the picture, the near plane and a far
    /// plane.
    View {
        /// Distance of the far plane from the eye along the camera's forward axis, in world units; beyond the near plane.
        far: U8_28,
    },
}

impl Clip {
    /// Clipping to the view volume up to a far plane at this distance from the eye, in world units; the default clipping for `None`.
    pub const fn to(far: Option<U8_28>) -> Self {
        match far {
            None => Self::Guard,
            Some(far) => Self::View { far },
        }
    }
}

/// The volume to which triangles are clipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Volume {
    /// Beyond the near plane and inside the guard band: the triangle engine's volume, with which the fewest triangles are clipped.
    #[default]
    Guard,
    /// The view volume: inside the picture, and between the near plane and a far plane.
    View {
        /// Distance of the far plane from the eye, 37 fraction bits.
        far: i64,
    },
}

impl Volume {
    /// The distances in half pixels from the middle of the picture to the two sides of the volume along one axis. `picture` is the width or
    /// height of the picture in pixels, and `middle` is the position of its middle in the window.
    pub fn sides(self, picture: u32, middle: u32) -> [i64; 2] {
        let [picture, twice] = [picture, 2 * middle].map(i64::from);
        // The guard band ends at ±2047.5 pixels from the first column.
        let guard = [4095 + twice, 4095 - twice];
        match self {
            Self::Guard => guard,
            Self::View { .. } => guard.map(|side| side.min(picture)),
        }
    }
}
