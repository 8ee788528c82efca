//! The texture of the crate: pictures of two of its sides, next to each other.

use crate::colour::Rgb565;
use crate::texture::{Blend, Picture};

/// Base-2 logarithm of the width and height of a side in texels.
const SIDE_LOG2: u8 = 6;
/// Width and height of a side in texels.
const SIDE: u32 = 1 << SIDE_LOG2;
/// The texture: the left half is the side with a brace, the right half the side with a star.
pub const PICTURE: Picture = Picture {
    size_log2: [SIDE_LOG2 + 1, SIDE_LOG2],
    is_cut_out: false,
    is_atlas: false,
    blend: Blend::Opaque,
    texel,
};

/// Width of a board of the frame in texels.
const FRAME: u32 = 10;
/// Width of a plank in texels.
const PLANK: u32 = 11;
/// Half the width, times √2, of the diagonal board (brace) of a side, in texels.
const BRACE: u32 = 7;
/// Distance of a nail from the edges of a side, in texels.
const NAIL: u32 = FRAME / 2;
/// Distance of a point of the star from its centre, in half texels.
const STAR: u32 = 39;

// Indices into `COLOURS`.
const GAP: usize = 0;
const PLANKS: usize = 1;
const EDGE: usize = 6;
const BOARDS: usize = 7;
const IRON: usize = 11;
const STEEL: usize = 12;
const OUTLINE: usize = 13;
const GOLD: usize = 14;
const BRIGHT: usize = 15;

/// The colours: one of a gap, five of planks, one of the edges and four of the boards of the frame, two of nails, three of the star.
const COLOURS: [Rgb565; 16] = [
    Rgb565::from_rgb888([0x28, 0x18, 0x0C]),
    Rgb565::from_rgb888([0x70, 0x46, 0x24]),
    Rgb565::from_rgb888([0x84, 0x54, 0x2C]),
    Rgb565::from_rgb888([0x96, 0x62, 0x35]),
    Rgb565::from_rgb888([0xA6, 0x70, 0x3E]),
    Rgb565::from_rgb888([0xB4, 0x7E, 0x48]),
    Rgb565::from_rgb888([0x58, 0x36, 0x1A]),
    Rgb565::from_rgb888([0xC0, 0x8E, 0x52]),
    Rgb565::from_rgb888([0xD0, 0x9E, 0x60]),
    Rgb565::from_rgb888([0xE0, 0xAE, 0x6E]),
    Rgb565::from_rgb888([0xEC, 0xBE, 0x7E]),
    Rgb565::from_rgb888([0x38, 0x38, 0x40]),
    Rgb565::from_rgb888([0xD8, 0xE0, 0xE8]),
    Rgb565::from_rgb888([0x38, 0x18, 0x10]),
    Rgb565::from_rgb888([0xF0, 0xA8, 0x18]),
    Rgb565::from_rgb888([0xFF, 0xF4, 0xA8]),
];

/// The colour of a texel.
fn texel([x, y]: [u32; 2]) -> Option<Rgb565> {
    COLOURS.get(place(x, y)).copied()
}

/// Index of a texel's colour in `COLOURS`.
fn place(x: u32, y: u32) -> usize {
    let (has_star, x) = (x >= SIDE, x % SIDE);
    let [from_left, from_top] = [from_side(x), from_side(y)];
    let [across, down] = [from_left.abs_diff(NAIL), from_top.abs_diff(NAIL)];
    match across * across + down * down {
        0 => return STEEL,
        1..=2 => return IRON,
        _ => {}
    }
    // The frame: boards above and below, and between them boards on the left and on the right.
    if from_top < FRAME {
        return board([from_top, FRAME], x + 40 * (y / FRAME));
    }
    if from_left < FRAME {
        return board([from_left, FRAME], y + 50 * (x / FRAME) + 7);
    }
    let shadow = x < FRAME + 1 || y < FRAME + 1;
    if has_star {
        let colour = star(
            2 * x as i32 + 1 - SIDE as i32,
            2 * y as i32 + 1 - SIDE as i32,
        );
        return colour.unwrap_or_else(|| plank([x, y], shadow));
    }
    // The brace, which begins at the upper left, casts a shadow too.
    match x.abs_diff(y) {
        0..BRACE => board([BRACE + x - y, 2 * BRACE], x + y),
        distance => plank([x, y], shadow || y > x && distance < BRACE + 2),
    }
}

/// Distance of a coordinate from the nearer edge of a side.
fn from_side(c: u32) -> u32 {
    if c < SIDE / 2 { c } else { SIDE - 1 - c }
}

/// Index of the colour of a board, from the position across the board, the board's width, and the
/// position along it.
fn board([across, width]: [u32; 2], along: u32) -> usize {
    match across {
        across if across == 0 || across + 1 >= width => EDGE,
        _ => BOARDS + grain(across, along, 4),
    }
}

/// Index of the colour of a plank behind the frame.
fn plank([x, y]: [u32; 2], is_shadow: bool) -> usize {
    let [number, across] = [(x - FRAME) / PLANK, (x - FRAME) % PLANK];
    match across {
        0 => GAP,
        _ if is_shadow => PLANKS,
        _ => PLANKS + 1 + number as usize % 2 + grain(x, y, 3),
    }
}

/// Index of the colour of the star at a position relative to its centre, in half texels; `None`
/// outside the star. The brightness of the star's faces alternates.
fn star(x: i32, y: i32) -> Option<usize> {
    let [across, down] = [x.unsigned_abs(), y.unsigned_abs()];
    let is_bright = (across > down) == ((x > 0) == (y > 0));
    if is_within(across, down, STAR) {
        Some(if is_bright { BRIGHT } else { GOLD })
    } else if is_within(across, down, STAR + 6) {
        Some(OUTLINE)
    } else {
        None
    }
}

/// Whether a position is within the curve √across + √down = √radius.
fn is_within(across: u32, down: u32, radius: u32) -> bool {
    let rest = radius.saturating_sub(across + down);
    4 * across * down < rest * rest
}

/// The grain of wood at a position, a pseudo-random number below `count`: lines along the wood, cut
/// into pieces.
fn grain(across: u32, along: u32, count: u32) -> usize {
    let line = across.wrapping_mul(0x9E37_79B1);
    let piece = (along + (line >> 27)) / 12;
    let hash = (line ^ piece.wrapping_mul(0x85EB_CA6B)).wrapping_mul(0xC2B2_AE35);
    (((hash >> 16) * count) >> 16) as usize
}
