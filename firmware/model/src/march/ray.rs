//! A pixel's ray: where it begins, and where it ends.

use super::field::{Surface, cropped};
use super::setup::{Eye, FRACTION, Setup, farthest};

/// Below 1/m for every m that begins with these ten bits behind its point: 2^10/(i + 1), cut so that no product
/// with m rounds to 1. u8.9, 17 bits.
pub(super) const INVERSE: [u32; 1024] = inverses();

const fn inverses() -> [u32; 1024] {
    let mut table = [0; 1024];
    let mut i = 0;
    while i < table.len() {
        let inverse = ((1 << 19) - 2) / (i as u32 + 1);
        table[i] = if inverse < 1 << 17 {
            inverse
        } else {
            (1 << 17) - 1
        };
        i += 1;
    }
    table
}

/// |x|, or one less: |x| − 1 of a negative x.
const fn magnitude(x: i32) -> u32 {
    (x ^ (x >> 31)) as u32
}

/// A ray at its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ray {
    /// Which eye it starts from: 0 is the left one, or the only one.
    pub eye: usize,
    /// Its direction, s1.17, of at most length 1 in the maximum norm.
    pub direction: [i32; 3],
    /// The first ten bits of the largest component of D: the entry of the table that made the direction.
    pub length: u32,
    /// Where it begins, u11.12: at the near plane, or where it comes to the box.
    pub start: u32,
}

/// How a ray has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// At a surface.
    Hit(Surface),
    /// In nothing.
    Miss,
    /// Nobody knows: it was given up.
    Undecided,
}

/// The end of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// How.
    pub state: State,
    /// Where the last evaluation was, u11.12.
    pub t: u32,
    /// From there to the surface of a hit, at most 1 − 2^−12; 0 of all others. u0.12.
    pub gap: u32,
    /// The first ten bits of the direction's part along the surface's normal, where the ray goes towards it; or else all ones.
    pub slope: u32,
    /// Evaluations of the field.
    pub steps: u32,
}

impl Outcome {
    /// Where the ray has come to, u11.12: the surface's plane, if that is where it ends.
    pub fn reached(&self) -> u32 {
        let rest = (self.gap * INVERSE[self.slope as usize & 0x3FF]) >> 9;
        (self.t + rest).min(farthest(FRACTION))
    }
}

impl Setup {
    /// The ray of a pixel.
    pub fn ray(&self, eye: usize, x: u32, y: u32) -> Ray {
        // s1.24.
        let direction = [0, 1, 2].map(|i: usize| {
            let across = self.steps[0][i].wrapping_mul(x as i32);
            let down = self.steps[1][i].wrapping_mul(y as i32);
            self.eyes[eye].first[i]
                .wrapping_add(across)
                .wrapping_add(down)
                >> 6
        });
        let [a, b, c] = direction.map(magnitude);
        let length = a.max(b).max(c) >> 14 & 0x3FF;
        let inverse = INVERSE[length as usize];
        // 24, 9 and 17 fraction bits.
        let direction =
            direction.map(|d| ((i64::from(d) * i64::from(inverse) + (1 << 15)) >> 16) as i32);
        let near = (u64::from(self.near) * (u64::from(length) + 1)) >> 10;
        let entry = self.entry(eye, &direction);
        Ray {
            eye,
            direction,
            length,
            start: near.max(entry).min(farthest(self.fraction).into()) as u32,
        }
    }

    /// Where a ray comes to the box if it does: never beyond it, and before it by some 2^−17 of the way.
    ///
    /// The table's reciprocal is too small by up to 1/i, so what is left to the box is divided once more.
    fn entry(&self, eye: usize, direction: &[i32; 3]) -> u64 {
        let Eye {
            origin, outside, ..
        } = &self.eyes[eye];
        (0..3)
            .filter(|&i| (origin[i] < 0) != (direction[i] < 0))
            .map(|i| {
                let inverse = INVERSE[(magnitude(direction[i]) >> 7) as usize & 0x3FF];
                let divided = |way: u64| (way * u64::from(inverse)) >> 9;
                let outside = u64::from(outside[i]);
                let part = u64::from(magnitude(direction[i]));
                let near = divided(outside).min(farthest(self.fraction).into());
                // |d| is at most part + 1.
                let gone = (near * (part + 1)) >> 17;
                near + divided(outside.saturating_sub(gone + 1))
            })
            .max()
            .unwrap_or(0)
    }

    /// Follows a ray to its end.
    pub fn march(&self, ray: &Ray) -> Outcome {
        let tuning = &self.tuning;
        let mut t = ray.start;
        let mut steps = 0;
        loop {
            let point = self.point(ray, t);
            let sample = self
                .solid
                .sample(point.map(|x| cropped(x, 10 + self.fraction)), self.fraction);
            // A ray that has left the box, or never came to it, and goes away from it.
            let gone = (0..3).any(|i| {
                magnitude(point[i]) > self.bounds[i] && (point[i] < 0) == (ray.direction[i] < 0)
            });
            // A ray along a face takes short steps; it need not come as near.
            let threshold = (tuning.threshold + (t >> tuning.footprint)) << (steps >> 6);
            steps += 1;
            let next = t + sample.distance.max(0) as u32;
            let state = if gone || next > tuning.far {
                Some(State::Miss)
            } else if sample.distance < threshold as i32 {
                Some(State::Hit(sample.surface))
            } else if steps >= tuning.cap {
                Some(State::Undecided)
            } else {
                None
            };
            if let Some(state) = state {
                let (gap, slope) = match state {
                    State::Hit(surface) => self.approach(ray, sample.distance, surface),
                    _ => (0, 0),
                };
                return Outcome {
                    state,
                    t,
                    gap,
                    slope,
                    steps,
                };
            }
            t = next;
        }
    }

    /// How far the surface of a hit is, and how steeply the ray goes there.
    fn approach(&self, ray: &Ray, distance: i32, surface: Surface) -> (u32, u32) {
        let part = ray.direction[usize::from(surface.axis) % 3];
        let comes = (part < 0) == surface.positive;
        let gap = distance.clamp(0, (1 << self.fraction) - 1);
        let slope = if comes {
            magnitude(part) >> 7 & 0x3FF
        } else {
            0x3FF
        };
        (gap as u32, slope)
    }

    /// The point of a ray, s13.12.
    pub fn point(&self, ray: &Ray, t: u32) -> [i32; 3] {
        [0, 1, 2].map(|i: usize| {
            let way = i64::from(t) * i64::from(ray.direction[i]);
            self.eyes[ray.eye].origin[i] + (way >> 17) as i32
        })
    }

    /// The depth of a point of a ray along n in field units times 2^e, 21 fraction bits.
    pub fn depth_of(&self, ray: &Ray, t: u32) -> u64 {
        (u64::from(t) * u64::from(INVERSE[ray.length as usize])) << FRACTION >> self.fraction
    }
}
