//! A synthetic scene: hands whose centre of mass and area are known, in front of a wall.

use std::sync::OnceLock;

use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::frame::{Frame, Source, rgb565};

/// Colour of a hand in full light: red, green and blue.
const SKIN: [f64; 3] = [224.0, 172.0, 140.0];
/// Colour of the wall in full light, at its top and at its bottom.
const WALL: [[f64; 3]; 2] = [[120.0, 132.0, 150.0], [70.0, 84.0, 96.0]];
/// Number of samples per pixel in each direction.
const SAMPLES: usize = 4;

/// A hand in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// Coordinates x and y of the centre of mass in pixels. The centre of the top left pixel is (0, 0).
    pub centre: [f64; 2],
    /// Number of pixels that the hand covers.
    pub area: f64,
}

/// A palm with four fingers and a thumb: the ends of each part's axis, and half of its width, in radii of the palm.
const PARTS: [([f64; 2], [f64; 2], f64); 6] = [
    ([0.0, 0.0], [0.0, 0.0], 1.0),
    ([-0.72, -0.6], [-0.9, -1.6], 0.2),
    ([-0.24, -0.7], [-0.3, -1.9], 0.2),
    ([0.24, -0.7], [0.3, -1.9], 0.2),
    ([0.72, -0.6], [0.9, -1.6], 0.2),
    ([0.7, 0.1], [1.5, -0.6], 0.23),
];
/// Bound on the distance of the hand's points from the palm's centre, in radii of the palm.
const REACH: f64 = 2.2;

fn is_hand([x, y]: [f64; 2]) -> bool {
    PARTS.iter().any(|&(from, to, half_width)| {
        let along = [to[0] - from[0], to[1] - from[1]];
        let way = [x - from[0], y - from[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let part = if square > 0.0 {
            ((way[0] * along[0] + way[1] * along[1]) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let off = [way[0] - part * along[0], way[1] - part * along[1]];
        off[0] * off[0] + off[1] * off[1] <= half_width * half_width
    })
}

/// Area and centre of mass of the hand, in radii of the palm.
fn moments() -> (f64, [f64; 2]) {
    static MOMENTS: OnceLock<(f64, [f64; 2])> = OnceLock::new();
    *MOMENTS.get_or_init(|| {
        const STEPS: i32 = 400;
        let step = REACH / f64::from(STEPS);
        let (mut count, mut sums) = (0.0, [0.0; 2]);
        for y in -STEPS..STEPS {
            for x in -STEPS..STEPS {
                let point = [x, y].map(|i| (f64::from(i) + 0.5) * step);
                if is_hand(point) {
                    count += 1.0;
                    sums = [sums[0] + point[0], sums[1] + point[1]];
                }
            }
        }
        (count * step * step, sums.map(|sum| sum / count))
    })
}

/// A function from the time in s to a property of the scene.
type Over<T> = Box<dyn Fn(f64) -> T + Send>;

/// Hands in front of a wall, with uniform lighting.
pub struct Scene {
    /// Width and height of a frame.
    pub size: [usize; 2],
    /// The hands as a function of time: none, one or several.
    pub hands: Over<Vec<Hand>>,
    /// Discs of the hand's colour that never move: a face, a wooden door.
    pub discs: Vec<Hand>,
    /// Brightness of the light as a function of time; 1 is full light.
    pub light: Over<f64>,
    /// Standard deviation of the noise of each channel, in units of 1/255 of its range.
    pub noise: f64,
    /// Fraction of the pixels that are salt-and-pepper noise: at random black or of the hand's
    /// colour.
    pub salt: f64,
    random: Pcg64Mcg,
}

impl Scene {
    /// Creates a scene in full light, without noise. `hands` is a function of the time in s.
    #[must_use]
    pub fn new(size: [usize; 2], hands: impl Fn(f64) -> Vec<Hand> + Send + 'static) -> Self {
        Self {
            size,
            hands: Box::new(hands),
            discs: Vec::new(),
            light: Box::new(|_| 1.0),
            noise: 0.0,
            salt: 0.0,
            random: Pcg64Mcg::new(1),
        }
    }

    /// A random number of mean 0 and variance 1, approximately normally distributed.
    fn gauss(&mut self) -> f64 {
        // Three uniform numbers of 21 bits each.
        const BITS: u32 = 21;
        let bits: u64 = self.random.random();
        let part = |number: u32| bits >> (number * BITS) & ((1 << BITS) - 1);
        let sum = (part(0) + part(1) + part(2)) as f64 / f64::from(1 << BITS);
        2.0 * (sum - 1.5)
    }
}

/// Blends the hand's colour into the pixels of a picture of `size` for which `is_inside` is true. `is_inside` gets a point relative to
/// `centre` in pixels, and is called within `reach` pixels of the centre.
fn paint(
    picture: &mut [[f64; 3]],
    size: [usize; 2],
    centre: [f64; 2],
    reach: f64,
    is_inside: impl Fn([f64; 2]) -> bool,
) {
    let range = |axis: usize| {
        let first = (centre[axis] - reach).floor().max(0.0) as usize;
        let end = (centre[axis] + reach).ceil().max(-1.0) + 1.0;
        first..(end as usize).min(size[axis])
    };
    let sample = |i: usize| (i as f64 + 0.5) / SAMPLES as f64 - 0.5;
    for y in range(1) {
        for x in range(0) {
            let covered = (0..SAMPLES * SAMPLES)
                .filter(|i| {
                    let offset = [sample(i % SAMPLES), sample(i / SAMPLES)];
                    is_inside([
                        x as f64 + offset[0] - centre[0],
                        y as f64 + offset[1] - centre[1],
                    ])
                })
                .count();
            let part = covered as f64 / (SAMPLES * SAMPLES) as f64;
            let pixel = &mut picture[y * size[0] + x];
            *pixel = [0, 1, 2].map(|i| pixel[i] + part * (SKIN[i] - pixel[i]));
        }
    }
}

impl Source for Scene {
    fn frame(&mut self, time: f64) -> Frame {
        let [width, height] = self.size;
        let wall = |y: usize| {
            let down = y as f64 / height as f64;
            [0, 1, 2].map(|i| WALL[0][i] + down * (WALL[1][i] - WALL[0][i]))
        };
        let mut picture: Vec<[f64; 3]> = (0..width * height).map(|at| wall(at / width)).collect();
        for disc in &self.discs {
            let radius = (disc.area / std::f64::consts::PI).sqrt();
            paint(&mut picture, self.size, disc.centre, radius, |[x, y]| {
                x * x + y * y <= radius * radius
            });
        }
        let (area, middle) = moments();
        for hand in (self.hands)(time) {
            let radius = (hand.area / area).sqrt();
            let palm = [0, 1].map(|axis| hand.centre[axis] - middle[axis] * radius);
            paint(&mut picture, self.size, palm, REACH * radius, |point| {
                is_hand(point.map(|length| length / radius))
            });
        }
        let light = (self.light)(time);
        let mut pixels = Vec::with_capacity(picture.len());
        for colour in picture {
            let colour = if self.salt > 0.0 && self.random.random_range(0.0..1.0) < self.salt {
                if self.random.random_range(0.0..1.0) < 0.5 {
                    SKIN
                } else {
                    [0.0; 3]
                }
            } else {
                colour
            };
            let channels = colour.map(|channel| {
                let noise = if self.noise > 0.0 {
                    self.noise * self.gauss()
                } else {
                    0.0
                };
                (channel * light + noise).clamp(0.0, 255.0) as u8
            });
            pixels.push(rgb565(channels));
        }
        Frame { width, pixels }
    }
}
