//! The atrium: a room without a ceiling, open at two sides, around a space for a solid in [-1, 1]³. It has two walls with windows, two
//! plants and a screen of glass.
//!
//! Lengths of the tables are in hundredths of a world unit; positions of faces are in Q2.14. Each wall with its window and its plant is
//! the mirror image of the other wall; the reflection exchanges x and −y.

use super::number::{ONE, scaled, sin_cos};
use super::paint;
use crate::colour::Rgb565;
use crate::fixed::Turns;
use crate::records::TextureCoordinates;
use crate::texture::Picture;

/// The textures, by their numbers from 1. The last texture is blended, so its faces come last.
pub const PICTURES: [Picture; 6] = [
    paint::TILES,
    paint::BRICKS,
    paint::WOOD,
    paint::LEAVES,
    paint::POT,
    paint::GLASS,
];

// Numbers of the textures.
const TILES: u8 = 1;
const BRICKS: u8 = 2;
const WOOD: u8 = 3;
const LEAVES: u8 = 4;
const POT: u8 = 5;
const GLASS: u8 = 6;

/// Colours of faces in sunlight, and of faces in the shadow of the solid.
const LIT: Rgb565 = Rgb565::WHITE;
const SHADOW: Rgb565 = Rgb565::from_rgb888([0x78, 0x78, 0x84]);
/// Colour of the soil in a pot.
const SOIL: Rgb565 = Rgb565::from_rgb888([0x60, 0x50, 0x48]);

/// Height of the floor.
const FLOOR: i16 = -100;
/// Inner side of a wall.
const WALL: i16 = -190;
/// Outer side of a wall.
const OUTSIDE: i16 = -197;
/// Height of the walls.
const TOP: i16 = 120;

/// The floor, in quadrangles; two equal corners make a triangle. The last two quadrangles are the shadow of the cube [-1, 1]³ in
/// light from the direction (0.82, −0.62, 2).
const GROUND: [[[i16; 2]; 4]; 8] = {
    let [p, q, r, s] = [[-190, -197], [197, -197], [197, 190], [-190, 190]];
    let [a, b, c] = [[-100, -100], [100, -100], [100, 100]];
    let [d, e, f] = [[18, 162], [-182, 162], [-182, -38]];
    [
        [p, q, b, a],
        [q, r, c, b],
        [r, d, c, c],
        [r, s, e, d],
        [s, p, f, e],
        [p, a, f, f],
        [a, b, c, d],
        [a, d, e, f],
    ]
};
/// The number of quadrangles of [`GROUND`] that are not in the shadow.
const SUNNY: usize = 6;

/// Rectangles of a wall around its window: the two ends along y, and the two ends along z.
const BRICKWORK: [[[i16; 2]; 2]; 4] = [
    [[WALL, -155], [FLOOR, TOP]],
    [[-65, -WALL], [FLOOR, TOP]],
    [[-155, -65], [FLOOR, -5]],
    [[-155, -65], [90, TOP]],
];
/// The glass of a window: the two ends along y, and the two ends along z.
const PANES: [[i16; 2]; 2] = [[-149, -71], [1, 84]];
/// The glass of the screen: x, the two ends along y, and the two ends along z.
const SCREEN: (i16, [[i16; 2]; 2]) = (150, [[-155, -55], [-90, 25]]);

/// A beam of wood.
struct Beam {
    /// The corner with the smallest coordinates.
    from: [i16; 3],
    /// The corner with the largest coordinates.
    to: [i16; 3],
    /// The visible sides: one bit for each of [`SIDES`].
    sides: u8,
}

const fn beam(from: [i16; 3], to: [i16; 3], sides: u8) -> Beam {
    Beam { from, to, sides }
}

// The sides of a box, as bits of [`Beam::sides`].
const FRONT: u8 = 1;
const RIGHT: u8 = 2;
const BACK: u8 = 4;
const LEFT: u8 = 8;
const UPPER: u8 = 16;
const LOWER: u8 = 32;

/// Corners of the sides of a box, counter-clockwise from the lower left as seen from outside: 1 for the larger x, y or z, 0 for the
/// smaller one.
const SIDES: [[[usize; 3]; 4]; 6] = [
    [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
    [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
    [[1, 1, 0], [0, 1, 0], [0, 1, 1], [1, 1, 1]],
    [[0, 1, 0], [0, 0, 0], [0, 0, 1], [0, 1, 1]],
    [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    [[0, 1, 0], [1, 1, 0], [1, 0, 0], [0, 0, 0]],
];

/// The beams of one wall: its end, its cap, and the frame of its window with two bars.
const FRAME: [Beam; 8] = [
    beam(
        [OUTSIDE, OUTSIDE, FLOOR],
        [WALL, WALL, TOP],
        FRONT | RIGHT | LEFT,
    ),
    beam(
        [OUTSIDE, OUTSIDE, TOP],
        [-185, -OUTSIDE, 127],
        FRONT | RIGHT | LEFT | UPPER,
    ),
    beam(
        [OUTSIDE, -155, -5],
        [-186, -149, 90],
        FRONT | RIGHT | BACK | UPPER,
    ),
    beam(
        [OUTSIDE, -71, -5],
        [-186, -65, 90],
        FRONT | RIGHT | BACK | UPPER,
    ),
    beam(
        [OUTSIDE, -149, -5],
        [-181, -71, 1],
        FRONT | RIGHT | BACK | UPPER | LOWER,
    ),
    beam([OUTSIDE, -149, 84], [-186, -71, 90], RIGHT | UPPER | LOWER),
    beam([OUTSIDE, -112, 1], [-189, -108, 84], FRONT | RIGHT | BACK),
    beam([OUTSIDE, -149, 40], [-189, -71, 44], RIGHT | UPPER | LOWER),
];

/// The edge of the floor, and the frame of the screen.
const OTHERS: [Beam; 5] = [
    beam(
        [OUTSIDE, OUTSIDE, -112],
        [-OUTSIDE, -OUTSIDE, FLOOR],
        FRONT | RIGHT | BACK | LEFT | LOWER,
    ),
    beam(
        [147, -160, FLOOR],
        [153, -155, 30],
        FRONT | RIGHT | BACK | LEFT | UPPER,
    ),
    beam(
        [147, -55, FLOOR],
        [153, -50, 30],
        FRONT | RIGHT | BACK | LEFT | UPPER,
    ),
    beam(
        [147, -155, 25],
        [153, -55, 30],
        RIGHT | LEFT | UPPER | LOWER,
    ),
    beam([147, -155, FLOOR], [153, -55, -90], RIGHT | LEFT | UPPER),
];

/// Position of a plant, along x and along y.
const PLANT: i16 = -145;
/// Height of the rim of a pot.
const RIM: i16 = -64;
/// Height of the soil in a pot, from which the leaves grow.
const EARTH: i16 = -68;
/// Height of the leaves' ends.
const TIPS: i16 = 27;
/// Half of the width of the leaves.
const WIDTH: i16 = 44;
/// Radius of a pot at its rim, and at the floor.
const RADII: [i16; 2] = [22, 15];

/// A face with four corners, counter-clockwise as seen from its visible side.
#[derive(Clone, Copy)]
pub struct Face {
    /// Positions of the corners in Q2.14.
    pub corners: [[i32; 3]; 4],
    /// The number of its texture.
    pub texture: u8,
    /// The colour of its light.
    pub colour: Rgb565,
}

impl Face {
    fn new(corners: [[i16; 3]; 4], texture: u8) -> Self {
        Self {
            corners: corners.map(|corner| corner.map(place)),
            texture,
            colour: LIT,
        }
    }

    /// The mirror image of the face; the reflection exchanges x and −y.
    fn mirrored(self) -> Self {
        let [a, b, c, d] = self.corners.map(|[x, y, z]| [-y, -x, z]);
        Self {
            corners: [b, a, d, c],
            ..self
        }
    }

    /// Texture coordinates of the corners. Tiles, bricks and wood repeat once per world unit, and the grain of wood runs along
    /// the longer side of the face; faces of leaves, pots and glass show the whole texture once.
    pub fn coordinates(&self) -> [TextureCoordinates; 4] {
        if !matches!(self.texture, TILES | BRICKS | WOOD) {
            return [[0, 1], [1, 1], [1, 0], [0, 0]].map(|[s, t]| TextureCoordinates {
                s: s << 16,
                t: t << 16,
            });
        }
        let extent = |axis: usize| {
            let [a, b, c, _] = self.corners.map(|corner| corner[axis]);
            (c - a).abs().max((b - a).abs())
        };
        let (right, up) = match [0, 1, 2].map(extent) {
            [0, ..] => (1, 2),
            [_, 0, _] => (0, 2),
            _ => (0, 1),
        };
        let is_upright = self.texture == WOOD && extent(up) > extent(right);
        self.corners.map(|corner| {
            // From Q2.14 to s16.16.
            let [s, t] = [corner[right] << 2, -corner[up] << 2];
            match is_upright {
                true => TextureCoordinates { s: t, t: s },
                false => TextureCoordinates { s, t },
            }
        })
    }
}

/// From hundredths to Q2.14, truncated.
fn place(hundredths: i16) -> i32 {
    i32::from(hundredths) * i32::from(ONE) / 100
}

/// Calls `each` with every face, faces of glass last, until `each` returns `None`.
pub fn faces(each: &mut dyn FnMut(Face) -> Option<()>) -> Option<()> {
    for (number, corners) in GROUND.iter().enumerate() {
        let face = Face::new(corners.map(|[x, y]| [x, y, FLOOR]), TILES);
        each(match number < SUNNY {
            true => face,
            false => Face {
                colour: SHADOW,
                ..face
            },
        })?;
    }
    half(each)?;
    half(&mut |face| each(face.mirrored()))?;
    beams(&OTHERS, each)?;
    let panes = upright(OUTSIDE + 4, PANES, GLASS);
    let (x, ends) = SCREEN;
    let screen = upright(x, ends, GLASS);
    for face in [panes, panes.mirrored(), screen] {
        let [a, b, c, d] = face.corners;
        each(face)?;
        each(Face {
            corners: [b, a, d, c],
            ..face
        })?;
    }
    Some(())
}

/// Half of the room: a wall with its window, and a plant.
fn half(each: &mut dyn FnMut(Face) -> Option<()>) -> Option<()> {
    for ends in BRICKWORK {
        each(upright(WALL, ends, BRICKS))?;
    }
    beams(&FRAME, each)?;
    plant(each)
}

/// A rectangle that faces +x, from its ends along y and along z.
fn upright(x: i16, [[left, right], [low, high]]: [[i16; 2]; 2], texture: u8) -> Face {
    let corners = [[left, low], [right, low], [right, high], [left, high]];
    Face::new(corners.map(|[y, z]| [x, y, z]), texture)
}

fn beams(beams: &[Beam], each: &mut dyn FnMut(Face) -> Option<()>) -> Option<()> {
    for &Beam { from, to, sides } in beams {
        for (number, side) in SIDES.iter().enumerate() {
            if sides >> number & 1 == 1 {
                let [xs, ys, zs] = [0, 1, 2].map(|axis| [from[axis], to[axis]]);
                let corners = side.map(|[x, y, z]| [xs[x], ys[y], zs[z]]);
                each(Face::new(corners, WOOD))?;
            }
        }
    }
    Some(())
}

/// A pot with eight sides, and leaves on three planes that cross each other.
fn plant(each: &mut dyn FnMut(Face) -> Option<()>) -> Option<()> {
    let around = |angle: u32, radius: i16, z: i16| {
        let (sin, cos) = sin_cos(Turns(angle));
        let [x, y] = [cos, sin].map(|factor| place(PLANT) + scaled(factor, place(radius)));
        [x, y, place(z)]
    };
    let [rim, foot] = RADII;
    let corner = |number: u32, radius, z| around(number << 29, radius, z);
    for side in 0..8 {
        each(Face {
            corners: [
                corner(side, foot, FLOOR),
                corner(side + 1, foot, FLOOR),
                corner(side + 1, rim, RIM),
                corner(side, rim, RIM),
            ],
            texture: POT,
            colour: LIT,
        })?;
    }
    for first in [1, 3, 5] {
        each(Face {
            corners: [0, first, first + 1, first + 2].map(|number| corner(number, rim, EARTH)),
            texture: POT,
            colour: SOIL,
        })?;
    }
    // Both sides of the planes, at 20°, 80°, 140° and so on.
    for side in 0..6 {
        let right = u32::MAX / 18 * (1 + 3 * side);
        let left = right.wrapping_add(1 << 31);
        each(Face {
            corners: [
                around(left, WIDTH, EARTH),
                around(right, WIDTH, EARTH),
                around(right, WIDTH, TIPS),
                around(left, WIDTH, TIPS),
            ],
            texture: LEAVES,
            colour: LIT,
        })?;
    }
    Some(())
}
