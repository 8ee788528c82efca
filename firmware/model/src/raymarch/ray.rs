//! A pixel's ray: where it begins, and where it ends.

use glint_core::field::{FRACTION, Surface, cropped, magnitude};

use super::options::FARTHEST;
use super::setup::{Eye, FieldSetup};

/// Below 1/m for every m that begins with these ten bits behind its point: 2^10/(i + 1), cut so that no product
/// with m rounds to 1. u8.9, 17 bits.
const INVERSE: [u32; 1024] = inverses();

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

/// Below 1/√q for every q that begins with these ten bits behind its point: √(2^10/(i + 1)), less by a part of 2^−16 at least for
/// what is rounded up afterwards. u8.9, 15 bits.
const ROUND_INVERSE: [u32; 1024] = round_inverses();

const fn round_inverses() -> [u32; 1024] {
    let mut table = [0; 1024];
    let mut i = 0;
    while i < table.len() {
        table[i] = (((1 << 28) - (1 << 13)) / (i as u32 + 1)).isqrt();
        i += 1;
    }
    table
}

/// A ray at its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ray {
    /// Which eye it starts from: 0 is the left one, or the only one.
    pub eye: usize,
    /// Its direction, s1.17, of at most length 1: in the maximum norm, or in the Euclidean one if there is anything round.
    pub direction: [i32; 3],
    /// The first ten bits of the largest component of D, or of |D|²: the entry of the table that made the direction.
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
pub struct RayResult {
    /// How.
    pub state: State,
    /// Where the last evaluation was, or, of a hit on something round, a step further: u11.12.
    pub t: u32,
    /// From there to the plane of a face that was hit, at most 1 − 2^−12; 0 of all others. u0.12.
    pub gap: u32,
    /// The first ten bits of the direction's part along the face's normal, where the ray goes towards it; or else all ones.
    pub slope: u32,
    /// Points at which the field was asked, at most 1020.
    pub steps: u32,
}

impl RayResult {
    /// Where the ray has come to, u11.12: the surface's plane, if that is where it ends.
    pub fn reached(&self) -> u32 {
        let rest = (self.gap * INVERSE[self.slope as usize & 0x3FF]) >> 9;
        (self.t + rest).min(FARTHEST)
    }
}

impl FieldSetup {
    /// The ray of a pixel.
    pub fn ray(&self, eye: usize, x: u32, y: u32) -> Ray {
        self.ray_from(eye, x, y, self.near)
    }

    /// The same from another near plane on.
    pub(super) fn ray_from(&self, eye: usize, x: u32, y: u32, near: u32) -> Ray {
        // s1.24.
        let direction = [0, 1, 2].map(|i: usize| {
            let across = self.steps[0][i].wrapping_mul(x as i32);
            let down = self.steps[1][i].wrapping_mul(y as i32);
            self.eyes[eye].first[i]
                .wrapping_add(across)
                .wrapping_add(down)
                >> 6
        });
        let length = self.length(direction.map(magnitude));
        let direction = self.scaled(direction, length);
        let near = self.at_depth(near, length);
        let entry = self.entry(eye, &direction).min(u64::from(u32::MAX)) as u32;
        Ray {
            eye,
            direction,
            length,
            start: near.max(entry).min(FARTHEST),
        }
    }

    /// The first ten bits of D's length, or of its square or a little more, from the magnitudes of its parts, 24 fraction bits.
    pub(super) fn length(&self, parts: [u32; 3]) -> u32 {
        if self.is_round() {
            // 17 bits of each. What was cut off them is below 2^−15 in all, which is added.
            let square: u64 = parts.map(|part| u64::from(part >> 7).pow(2)).iter().sum();
            ((square + (1 << 19)) >> 24) as u32 & 0x3FF
        } else {
            let [a, b, c] = parts;
            a.max(b).max(c) >> 14 & 0x3FF
        }
    }

    /// What a direction is D times of, u8.9.
    pub(super) fn inverse(&self, length: u32) -> u32 {
        if self.is_round() {
            ROUND_INVERSE[length as usize]
        } else {
            INVERSE[length as usize]
        }
    }

    /// A direction of length at most 1, of D and the first bits of its length.
    pub(super) fn scaled(&self, direction: [i32; 3], length: u32) -> [i32; 3] {
        let inverse = i64::from(self.inverse(length));
        // 24, 9 and 17 fraction bits.
        direction.map(|d| ((i64::from(d) * inverse + (1 << 15)) >> 16) as i32)
    }

    /// The t at a depth along n, or a little before it.
    pub(super) fn at_depth(&self, depth: u32, length: u32) -> u32 {
        // The inverse of the inverse, or less, 10 fraction bits.
        let part = if self.is_round() {
            (self.inverse(length) * (length + 1)) >> 9
        } else {
            length + 1
        };
        ((u64::from(depth) * u64::from(part)) >> 10) as u32
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
                let near = divided(outside).min(FARTHEST.into());
                // |d| is at most part + 1.
                let gone = (near * (part + 1)) >> 17;
                near + divided(outside.saturating_sub(gone + 1))
            })
            .max()
            .unwrap_or(0)
    }

    /// Follows a ray to its end.
    pub fn march(&self, ray: &Ray) -> RayResult {
        let tuning = &self.tuning;
        let mut t = ray.start;
        let mut steps = 0;
        loop {
            let point = self.point(ray, t);
            let sample = self.sample(point.map(|x| cropped(x, 10 + FRACTION)));
            let gone = self.is_gone(ray, &point);
            let threshold = (tuning.threshold + (t >> tuning.footprint)) << self.patience(steps);
            steps += 1;
            let next = t + sample.distance.max(0) as u32;
            let state = if gone || next > tuning.far {
                Some(State::Miss)
            } else if sample.distance < threshold as i32 {
                Some(State::Hit(sample.surface))
            } else if steps >= self.cap() {
                Some(State::Undecided)
            } else {
                None
            };
            if let Some(state) = state {
                let (t, gap, slope) = match state {
                    State::Hit(Surface::Face { axis, positive }) => {
                        let (gap, slope) = approach(ray, sample.distance, axis, positive);
                        (t, gap, slope)
                    }
                    State::Hit(Surface::Octant { signs }) => {
                        let (gap, slope) = approach_diagonal(ray, sample.distance, signs);
                        (t, gap, slope)
                    }
                    State::Hit(Surface::Round { .. } | Surface::Blended { .. }) => (next, 0, 0x3FF),
                    _ => (t, 0, 0),
                };
                return RayResult {
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

    /// By which power of two the threshold has grown. A ray along a face takes short steps; it need not come as near. Beside a sphere
    /// it takes many too, and passes.
    pub(super) fn patience(&self, steps: u32) -> u32 {
        if self.is_round() { 0 } else { steps >> 6 }
    }

    /// The points after which a ray is given up: beside what is round it creeps for longer.
    pub(super) fn cap(&self) -> u32 {
        self.tuning.cap << if self.is_round() { 2 } else { 0 }
    }

    /// Whether a ray has left the box, or never came to it, and goes away from it.
    pub(super) fn is_gone(&self, ray: &Ray, point: &[i32; 3]) -> bool {
        (0..3).any(|i| {
            magnitude(point[i]) > self.bounds[i] && (point[i] < 0) == (ray.direction[i] < 0)
        })
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
        u64::from(t) * u64::from(self.inverse(ray.length))
    }
}

/// The gap to the plane of a face, u0.12, and the slope of the ray against it.
fn approach(ray: &Ray, distance: i32, axis: u8, positive: bool) -> (u32, u32) {
    let part = ray.direction[usize::from(axis) % 3];
    let comes = (part < 0) == positive;
    let slope = if comes {
        magnitude(part) >> 7 & 0x3FF
    } else {
        0x3FF
    };
    (gap(distance), slope)
}

/// The same of a face across a diagonal, three quarters of both: a third of the sum of three parts is the slope, and a quarter
/// needs no division.
fn approach_diagonal(ray: &Ray, distance: i32, signs: u8) -> (u32, u32) {
    let towards = [0, 1, 2].map(|i: usize| {
        let part = ray.direction[i] >> 7;
        if signs >> i & 1 == 1 { !part } else { part }
    });
    let sum: i32 = towards.iter().sum();
    let slope = if sum < 0 {
        0x3FF
    } else {
        (sum >> 2) as u32 & 0x3FF
    };
    let gap = gap(distance);
    (gap - (gap >> 2), slope)
}

/// A distance as an end has it: saturates.
fn gap(distance: i32) -> u32 {
    distance.clamp(0, (1 << FRACTION) - 1) as u32
}
