//! The textures of the atrium.

use crate::colour::Rgb565;
use crate::texture::{Blend, Picture};

/// Base-2 logarithms of the sides of the large pictures, and of the small pictures.
const LARGE: [u8; 2] = [6; 2];
const SMALL: [u8; 2] = [5; 2];
/// Width and height of the large pictures in texels.
const SIDE: u32 = 1 << LARGE[0];

/// The floor: 2×2 tiles, alternately light and dark.
pub const TILES: Picture = picture(LARGE, tile);
/// The walls: four rows of two bricks; every other row is offset by half a brick.
pub const BRICKS: Picture = picture(LARGE, brick);
/// Wood, whose grain is along the rows.
pub const WOOD: Picture = picture(SMALL, wood);
/// Narrow leaves that grow from the middle of the lower side, on a transparent background.
pub const LEAVES: Picture = Picture {
    is_cut_out: true,
    ..picture(LARGE, leaf)
};
/// Burnt clay with a rim.
pub const POT: Picture = picture(SMALL, clay);
/// Blue glass with two diagonal reflections; its opacity is three eighths.
pub const GLASS: Picture = Picture {
    blend: Blend::ALL[3],
    ..picture(SMALL, pane)
};

/// For each leaf: the position of its end to the right of the middle, and its height, in texels.
const ENDS: [[i32; 2]; 8] = [
    [-26, 40],
    [-19, 52],
    [-11, 60],
    [-4, 63],
    [4, 62],
    [12, 58],
    [20, 50],
    [27, 42],
];
/// The colours that the leaves have in turn.
const GREENS: [[u8; 3]; 4] = [
    [0x40, 0x78, 0x2C],
    [0x54, 0x94, 0x36],
    [0x34, 0x68, 0x30],
    [0x68, 0xA4, 0x3E],
];

/// An opaque picture.
const fn picture(size_log2: [u8; 2], texel: fn([u32; 2]) -> Option<Rgb565>) -> Picture {
    Picture {
        size_log2,
        is_cut_out: false,
        is_atlas: false,
        blend: Blend::Opaque,
        texel,
    }
}

fn tile([x, y]: [u32; 2]) -> Option<Rgb565> {
    const TILE: u32 = SIDE / 2;
    let edge = (x % TILE).min(y % TILE);
    if edge == 0 {
        return shaded([96, 84, 72], noise([x, y]) % 10);
    }
    let is_light = (x < TILE) == (y < TILE);
    let base = if is_light {
        [214, 200, 176]
    } else {
        [156, 120, 92]
    };
    let bevel = if edge == 1 { 8 } else { 0 };
    shaded(base, bevel + noise([x / 2, y / 2]) % 12)
}

fn brick([x, y]: [u32; 2]) -> Option<Rgb565> {
    const WIDTH: u32 = SIDE / 2;
    const HEIGHT: u32 = SIDE / 4;
    let row = y / HEIGHT;
    let along = x + row % 2 * (WIDTH / 2);
    if along.is_multiple_of(WIDTH) || y.is_multiple_of(HEIGHT) {
        return shaded([100, 118, 118], noise([x, y]) % 12);
    }
    let number = noise([along / WIDTH % 2, row]) % 30;
    let is_edge = along % WIDTH == WIDTH - 1 || y % HEIGHT == HEIGHT - 1;
    let edge = if is_edge { 10 } else { 0 };
    shaded([160, 190, 190], number + edge + noise([x, y]) % 14)
}

fn wood([x, y]: [u32; 2]) -> Option<Rgb565> {
    let line = y / 2;
    let piece = (x + noise([line, 3])) % 32 / 16;
    shaded([140, 92, 52], noise([line, piece]) % 24)
}

fn leaf([x, y]: [u32; 2]) -> Option<Rgb565> {
    let height = (SIDE - 1 - y) as i32;
    let mut colour = None;
    for ([end, top], green) in ENDS.into_iter().zip(GREENS.into_iter().cycle()) {
        if height >= top {
            continue;
        }
        // Positions across are in half texels. A leaf bends outwards with the square of the height.
        let middle =
            SIDE as i32 + 2 * end * height * height / (top * top) + end * height / (4 * top);
        let width = 2 + 9 * (top - height) * (height + 10) / (top * top);
        let across = 2 * x as i32 + 1 - middle;
        if across.abs() > width {
            continue;
        }
        // A leaf has a bright rib, and its right half is darker than its left half.
        let rib = if across.abs() <= 1 { 22 } else { 0 };
        let half = if across < 0 { 0 } else { 14 };
        let foot = if height < 10 { 30 } else { 0 };
        colour = shaded(green.map(|c| c + rib), half + foot + noise([x, y / 4]) % 8);
    }
    colour
}

fn clay([x, y]: [u32; 2]) -> Option<Rgb565> {
    let grain = noise([x, y]) % 10;
    match y {
        0..5 => shaded([206, 124, 84], grain),
        5..8 => shaded([160, 90, 60], grain),
        _ => shaded([186, 104, 68], grain),
    }
}

fn pane([x, y]: [u32; 2]) -> Option<Rgb565> {
    match (x + y) % 32 {
        10..13 | 15 => shaded([226, 240, 248], 0),
        _ => shaded([120, 178, 206], 0),
    }
}

/// The colour, with `darker` subtracted from each channel; `darker` is below 256.
fn shaded(colour: [u8; 3], darker: u32) -> Option<Rgb565> {
    let colour = colour.map(|c| c.saturating_sub(darker as u8));
    Some(Rgb565::from_rgb888(colour))
}

/// A pseudo-random number of 16 bits for a position.
fn noise([x, y]: [u32; 2]) -> u32 {
    let key = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA6B);
    (key ^ key >> 15).wrapping_mul(0xC2B2_AE35) >> 16
}
