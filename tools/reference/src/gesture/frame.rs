//! Camera frames as masks of the hand's colour, and the gesture engine's statistics of a frame.

use std::sync::OnceLock;

use glint_core::gesture::{EngineSetting, Region, Statistics};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::imu::sensor::normal;

/// Numbers of columns and rows of a frame.
pub const SIZE: [u16; 2] = [320, 240];
const COLUMNS: usize = SIZE[0] as usize;
const ROWS: usize = SIZE[1] as usize;

/// Outline of a hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A disc.
    Disc,
    /// A palm with four fingers upwards and a thumb to the left.
    Hand,
}

/// The fingers, in units of the palm's radius: for each finger, the fingertip's position relative to the palm's centre, and half the width.
const FINGERS: [([f64; 2], f64); 5] = [
    ([-0.8, -1.9], 0.27),
    ([-0.3, -2.2], 0.27),
    ([0.25, -2.2], 0.27),
    ([0.8, -1.8], 0.25),
    ([-1.7, -0.4], 0.28),
];

impl Shape {
    /// Signed distance of a point from the outline, negative inside. The palm or disc has the radius 1 and its centre at the origin.
    fn distance(self, [x, y]: [f64; 2]) -> f64 {
        let palm = x.hypot(y) - 1.0;
        match self {
            Self::Disc => palm,
            Self::Hand => FINGERS.iter().fold(palm, |least, &([ex, ey], half)| {
                let along = ((x * ex + y * ey) / (ex * ex + ey * ey)).clamp(0.0, 1.0);
                least.min((x - along * ex).hypot(y - along * ey) - half)
            }),
        }
    }

    /// Area and centre of mass of the shape with radius 1, summed over a grid of squares of side 1/200.
    pub fn area_and_centre(self) -> (f64, [f64; 2]) {
        // Cached, because every hand needs these values, and their computation takes longer than a frame.
        static SUMS: [OnceLock<(f64, [f64; 2])>; 2] = [const { OnceLock::new() }; 2];
        *SUMS[self as usize].get_or_init(|| self.sum())
    }

    fn sum(self) -> (f64, [f64; 2]) {
        let mut sums = [0.0; 3];
        for row in -600..600 {
            for column in -600..600 {
                let [x, y] = [column, row].map(|i| (f64::from(i) + 0.5) / 200.0);
                if self.distance([x, y]) < 0.0 {
                    sums[0] += 1.0;
                    sums[1] += x;
                    sums[2] += y;
                }
            }
        }
        (sums[0] / 40_000.0, [sums[1] / sums[0], sums[2] / sums[0]])
    }
}

/// A hand in a frame.
#[derive(Clone, Copy, Debug)]
pub struct Drawn {
    /// Outline of the hand.
    pub shape: Shape,
    /// Coordinates of the palm's centre, in pixels.
    pub palm: [f64; 2],
    /// Radius of the palm, in pixels.
    pub radius: f64,
}

impl Drawn {
    /// Makes a hand of `area` pixels with its centre of mass at `centre`.
    pub fn new(shape: Shape, centre: [f64; 2], area: f64) -> Self {
        let (unit, offset) = shape.area_and_centre();
        let radius = (area / unit).sqrt();
        let palm = [0, 1].map(|axis| centre[axis] - radius * offset[axis]);
        Self {
            shape,
            palm,
            radius,
        }
    }

    /// Returns the hand moved by an offset in pixels.
    #[must_use]
    pub fn moved(self, way: [f64; 2]) -> Self {
        let palm = [0, 1].map(|axis| self.palm[axis] + way[axis]);
        Self { palm, ..self }
    }
}

/// Noise parameters of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    /// Fraction of the pixels outside of hands with the hand's colour.
    pub salt: f64,
    /// Fraction of the hand's pixels without the hand's colour.
    pub pepper: f64,
    /// Standard deviation of the outline's position at each pixel, in pixels.
    pub edge: f64,
}

impl Noise {
    /// No noise.
    pub const NONE: Self = Self {
        salt: 0.0,
        pepper: 0.0,
        edge: 0.0,
    };
    /// The noise of the measurements: 5 % false pixels, and a standard deviation of 0.3 pixels of the outlines.
    pub const SENSOR: Self = Self {
        salt: 0.05,
        pepper: 0.0,
        edge: 0.3,
    };
}

/// A frame as the mask of the pixels that have the hand's colour.
#[derive(Clone, Debug)]
pub struct Frame {
    mask: Vec<bool>,
}

impl Frame {
    /// Draws hands and noise.
    pub fn draw(hands: &[Drawn], noise: &Noise, random: &mut Pcg64Mcg) -> Self {
        let mut mask = vec![false; COLUMNS * ROWS];
        for (place, pixel) in mask.iter_mut().enumerate() {
            let [x, y] = [place % COLUMNS, place / COLUMNS].map(|i| i as f64);
            let distance = hands.iter().map(|hand| {
                let [dx, dy] = [x - hand.palm[0], y - hand.palm[1]].map(|d| d / hand.radius);
                // Every shape lies within three radii of its centre.
                if dx.abs().max(dy.abs()) > 4.0 {
                    return f64::INFINITY;
                }
                hand.shape.distance([dx, dy]) * hand.radius
            });
            let mut distance = distance.fold(f64::INFINITY, f64::min);
            if distance.abs() < 5.0 * noise.edge {
                distance += noise.edge * normal(random);
            }
            let (inside, flip) = match distance < 0.0 {
                true => (true, noise.pepper),
                false => (false, noise.salt),
            };
            *pixel = inside != (flip > 0.0 && random.random::<f64>() < flip);
        }
        Self { mask }
    }

    /// Returns a frame with the hand's colour only in the given pixels, each a column and a row.
    pub fn of(pixels: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let mut mask = vec![false; COLUMNS * ROWS];
        for (x, y) in pixels {
            mask[y * COLUMNS + x] = true;
        }
        Self { mask }
    }

    /// Returns a frame with the hand's colour in all pixels.
    pub fn full() -> Self {
        Self {
            mask: vec![true; COLUMNS * ROWS],
        }
    }

    /// Centre of mass of all pixels of the mask, in f64.
    pub fn centre(&self) -> [f64; 2] {
        let mut sums = [0.0; 3];
        for (place, _) in self.mask.iter().enumerate().filter(|(_, set)| **set) {
            sums[0] += 1.0;
            sums[1] += (place % COLUMNS) as f64;
            sums[2] += (place / COLUMNS) as f64;
        }
        [sums[1] / sums[0], sums[2] / sums[0]]
    }

    /// The gesture engine's statistics, without runs shorter than the minimum length. Runs are cut at the region's border.
    pub fn statistics(&self, setting: EngineSetting) -> Statistics {
        let Region { first, last } = setting.region;
        let least = usize::from(setting.least_run.max(1));
        let mut statistics = Statistics {
            size: SIZE,
            count: 0,
            sums: [0; 2],
            bounds: Region {
                first: [u16::MAX; 2],
                last: [0; 2],
            },
            is_whole: true,
        };
        let columns = usize::from(first[0])..COLUMNS.min(usize::from(last[0]) + 1);
        for y in usize::from(first[1])..ROWS.min(usize::from(last[1]) + 1) {
            let mut x = columns.start;
            while x < columns.end {
                let length = (x..columns.end)
                    .take_while(|x| self.mask[y * COLUMNS + x])
                    .count();
                if length >= least {
                    statistics.count += length as u32;
                    statistics.sums[0] += (x..x + length).sum::<usize>() as u32;
                    statistics.sums[1] += (y * length) as u32;
                    let bounds = &mut statistics.bounds;
                    bounds.first = [bounds.first[0].min(x as u16), bounds.first[1].min(y as u16)];
                    let end = (x + length - 1) as u16;
                    bounds.last = [bounds.last[0].max(end), bounds.last[1].max(y as u16)];
                }
                x += length + 1;
            }
        }
        statistics
    }
}

/// Number of successive frames of a hand at rest, for each position.
const FRAMES: u32 = 8;

/// Returns the errors, in pixels, of the centre that is computed from the statistics, compared with the noise-free centre in f64. The hand
/// has `area` pixels and is placed at `places` random positions, with several frames at each position. `setting` computes the engine's
/// settings from the bounds in the previous frame, as the control does; for the first frame, from the bounds of the noise-free hand.
pub fn centre_errors(
    shape: Shape,
    area: f64,
    noise: &Noise,
    places: u32,
    random: &mut Pcg64Mcg,
    setting: impl Fn(&Region) -> EngineSetting,
) -> Vec<f64> {
    let start = Drawn::new(shape, [0.0; 2], area);
    let mut errors = Vec::new();
    for _ in 0..places {
        let place = [
            random.random_range(60.0..260.0),
            random.random_range(60.0..180.0),
        ];
        let hand = start.moved(place);
        let exact = Frame::draw(&[hand], &Noise::NONE, random);
        let mut bounds = exact.statistics(EngineSetting::SEARCHING).bounds;
        let exact = exact.centre();
        for _ in 0..FRAMES {
            let noisy = Frame::draw(&[hand], noise, random).statistics(setting(&bounds));
            bounds = noisy.bounds;
            let centre = noisy
                .blob()
                .map_or([f64::NAN; 2], |blob| blob.centre.map(|x| x.to_num::<f64>()));
            errors.extend([centre[0] - exact[0], centre[1] - exact[1]]);
        }
    }
    errors
}
