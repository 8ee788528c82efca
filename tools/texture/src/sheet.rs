//! The levels of a texture side by side, as a board shows them.

use crate::picture::Picture;
use glint_core::texture::Texture;

/// A picture of all levels, the largest on the left. Texels that are transparent, or outside of the levels, have the opacity 0.
pub fn sheet(texture: &Texture) -> Picture {
    of_levels(texture, texture.levels())
}

/// A picture of the largest level. Texels that are transparent have the opacity 0.
pub fn largest_level(texture: &Texture) -> Picture {
    of_levels(texture, 1)
}

/// A picture of the first `count` levels side by side.
fn of_levels(texture: &Texture, count: u32) -> Picture {
    let sides = |level| texture.level_log2(level).map(|side| 1_u32 << side);
    let [_, height] = sides(0);
    let width = (0..count).map(|level| sides(level)[0]).sum();
    let mut texels = vec![[0; 4]; (width * height) as usize];
    let mut left = 0;
    for level in 0..count {
        let [level_width, level_height] = sides(level);
        for y in 0..level_height {
            let row = &mut texels[(y * width + left) as usize..][..level_width as usize];
            for (x, texel) in (0..).zip(row) {
                if let Some(colour) = texture.colour(level, [x, y]) {
                    let [red, green, blue] = colour.to_rgb888();
                    *texel = [red, green, blue, 255];
                }
            }
        }
        left += level_width;
    }
    Picture {
        size: [width, height],
        texels,
    }
}
