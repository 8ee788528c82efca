//! Frame constants of the triangle setup.

use glint_model::{MeshLight, SIZES, Shading};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Frame constants: picture size, culling of back faces, mirroring of the mesh, light, and shading.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub size: (u32, u32),
    pub cull: bool,
    pub mirror: bool,
    pub light: MeshLight,
    pub shading: Shading,
}

/// White light in the direction −z, without ambient light.
pub const WHITE: MeshLight = MeshLight {
    row: [0, 0, 1 << 23],
    forward: [0, 0, 1 << 23],
    colour: MeshLight::PLAIN.0,
    ambient: MeshLight::PLAIN.1,
};

/// Makes the constants of a random frame.
pub fn frame(random: &mut Pcg64Mcg, round: usize) -> Frame {
    let row = [0; 3].map(|_| match random.random_range(0..8) {
        0 => -1 << 24,
        1 => (1 << 24) - 1,
        2 => 0,
        _ => random.random_range(-1 << 23..=1 << 23),
    });
    Frame {
        size: SIZES[round % 3],
        cull: round.is_multiple_of(2),
        mirror: round % 8 > 4,
        light: if round % 4 < 2 {
            MeshLight { row, ..WHITE }
        } else {
            let mut part = || [0, 256, random.random_range(0..=256)][random.random_range(0..3)];
            MeshLight {
                row,
                colour: [(); 3].map(|()| part()),
                ambient: [(); 3].map(|()| part()),
                ..WHITE
            }
        },
        shading: Shading::Flat,
    }
}
