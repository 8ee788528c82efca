//! Expected output of the sampler for a quad, computed with the model.

use glint_core::colour::Rgb565;
use glint_core::texture::{Filter, Texture};
use glint_model::triangle::textured::{average, sample};

/// One repeat of a texture, in the units of a position.
pub const REPEAT: i64 = 1 << POSITION_BITS;
const POSITION_BITS: u32 = 18;

/// Four neighbouring pixels of a row.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    /// Covered pixels, one bit each.
    pub mask: u8,
    pub half: bool,
    pub last: bool,
    pub level: u32,
    /// Positions by lane, then by axis, in 2^-18 repeats.
    pub positions: [[i64; 2]; 4],
}

/// The texels of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texels {
    /// The nearest texel; `None` if it is transparent.
    pub nearest: Option<u16>,
    /// The colours of the four neighbours; a transparent neighbour has the colour of the nearest
    /// texel. Without meaning if the nearest texel is transparent.
    pub neighbours: [u16; 4],
    pub weights: [u8; 2],
}

/// The texels of the pixel at a position.
pub fn texels(texture: &Texture, level: u32, position: [i64; 2]) -> Texels {
    let sides = texture.level_log2(level);
    let wrap = texture.sampler().wrap;
    // In units of 1/256 texel of the level.
    let places = [0, 1].map(|axis: usize| position[axis] >> (POSITION_BITS - 8 - sides[axis]));
    let at = |place: [i64; 2]| {
        let place = [0, 1].map(|axis: usize| wrap[axis].place(place[axis] as i32, sides[axis]));
        texture.colour(level, place).map(|Rgb565(colour)| colour)
    };
    let nearest = at(places.map(|place| place >> 8));
    let [u, v] = places.map(|place| (place - 120) >> 8);
    let neighbours = [[u, v], [u + 1, v], [u, v + 1], [u + 1, v + 1]]
        .map(|place| at(place).or(nearest).unwrap_or(0));
    let weights = places.map(|place| ((place - 120) >> 4 & 0xF) as u8);
    Texels {
        nearest,
        neighbours,
        weights,
    }
}

/// Returns the lanes of each step of a quad. A step serves the first waiting lane, and each other
/// waiting lane of its pair (bilinear) or quad (nearest) whose texels the same blocks contain: for
/// each parity of block columns, only the column of the first waiting texel of this parity, and
/// likewise for block rows.
pub fn steps(texture: &Texture, quad: &Quad) -> Vec<u8> {
    let is_bilinear = texture.sampler().filter == Filter::Bilinear;
    let (sides, block) = (
        texture.level_log2(quad.level),
        texture.format().block_log2(),
    );
    let wrap = texture.sampler().wrap;
    // The block columns and block rows of a lane's texels.
    let blocks = |lane: usize, axis: usize| {
        let place = quad.positions[lane][axis] >> (POSITION_BITS - 8 - sides[axis]);
        let texels = if is_bilinear {
            [place - 120, place - 120 + 256]
        } else {
            [place; 2]
        };
        texels.map(|place| wrap[axis].place((place >> 8) as i32, sides[axis]) >> block[axis])
    };
    let groups: &[u8] = if is_bilinear { &[0x3, 0xC] } else { &[0xF] };
    let mut steps = Vec::new();
    for group in groups {
        let mut waiting = quad.mask & group;
        while waiting != 0 {
            let lanes = (0..4).filter(|lane| waiting >> lane & 1 != 0);
            let fits = |lane: usize, axis: usize| {
                blocks(lane, axis).into_iter().all(|block| {
                    let mut all = lanes.clone().flat_map(|lane| blocks(lane, axis));
                    all.find(|other| other % 2 == block % 2) == Some(block)
                })
            };
            let served = lanes.clone().filter(|&lane| fits(lane, 0) && fits(lane, 1));
            let served = served.fold(0, |mask, lane| mask | 1 << lane);
            steps.push(served);
            waiting &= !served;
        }
    }
    steps
}

/// Compares the sampler's texels of a pixel with the model's sample. Without filtering only
/// `texels.nearest` is used, with filtering also the neighbours and weights.
pub fn check_sample(texture: &Texture, level: u32, position: [i64; 2], texels: &Texels) {
    let sides = texture.size_log2();
    // In units of 1/256 texel of level 0.
    let places = [0, 1].map(|axis: usize| position[axis] >> (POSITION_BITS - 8 - sides[axis]));
    let expected = sample(texture, level, places);
    let found = texels
        .nearest
        .map(|nearest| match texture.sampler().filter {
            Filter::Nearest => {
                let [r, g, b] = Rgb565(nearest).channels();
                [r << 3, g << 2, b << 3]
            }
            Filter::Bilinear => {
                let neighbours = texels.neighbours.map(|colour| Rgb565(colour).channels());
                average(neighbours, texels.weights.map(u32::from))
            }
        });
    assert_eq!(found, expected, "the model's sample at {position:?}");
}
