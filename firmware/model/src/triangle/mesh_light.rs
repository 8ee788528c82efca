//! Coloured directional light and ambient light on meshes (docs/formats/triangle.md, "Light on meshes").

use glint_core::camera::View;
use glint_core::fixed::Q2_23;
use glint_core::light::{MeshLighting, whole};

/// The light on the meshes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshLight {
    /// The row of the light: the direction from the light in world coordinates, a unit vector, s2.23.
    pub row: [i32; 3],
    /// The camera's forward axis, s2.23.
    pub forward: [i32; 3],
    /// Colour of the light, u1.8 for each channel, at most 1.
    pub colour: [u16; 3],
    /// Ambient light, u1.8 for each channel, at most 1.
    pub ambient: [u16; 3],
}

impl MeshLight {
    /// Colour of the light, and ambient light, in a frame without a `MeshLight`: white and none.
    pub const PLAIN: ([u16; 3], [u16; 3]) = ([1 << 8; 3], [0; 3]);

    /// Computes the light on meshes for a camera.
    pub fn new(lighting: &MeshLighting, view: &View) -> Self {
        let MeshLighting { ambient, light } = lighting;
        let forward = view.n().map(Q2_23::to_bits);
        let part = |colour: [u8; 3]| colour.map(|part| whole(part) as u16);
        Self {
            row: if light.is_at_camera() {
                forward
            } else {
                // Converts a direction from 14 to 23 fraction bits.
                light.direction().map(|x| -i32::from(x) << 9)
            },
            forward,
            colour: part(light.colour()),
            ambient: part(*ambient),
        }
    }

    /// Returns the factor of each channel of a surface's colour: ambient + colour·intensity, at most 1, u1.8. The product is rounded to
    /// nearest.
    ///
    /// Not inlined, so that frames with white light at the camera do not load this code into the instruction cache.
    #[inline(never)]
    pub fn shares(&self, intensity: u32) -> [u32; 3] {
        [0, 1, 2].map(|i| {
            let product = u32::from(self.colour[i]) * intensity;
            (u32::from(self.ambient[i]) + ((product + (1 << 7)) >> 8)).min(1 << 8)
        })
    }
}
