//! Rays that march through a distance field: their start, their march and their end.

use glint_core::field::{FRACTION, Surface, cropped, magnitude};

use super::end::{RayEnd, State};
use super::marching::{Eye, Marching};
use super::options::FARTHEST;

/// Lower bounds of 1/m for numbers m in (0, 1). The index i is the first ten fraction bits of m. The entry is
/// 2^10/(i + 1), truncated so that its product with m is always less than 1 after rounding: u8.9, 17 bits.
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

/// Lower bounds of 1/√q for numbers q in (0, 1). The index i is the first ten fraction bits of q. The entry is
/// √(2^10/(i + 1)), reduced by a relative 2^−16 at least, to allow for later rounding up: u8.9, 15 bits.
pub const ROUND_INVERSE: [u32; 1024] = round_inverses();

const fn round_inverses() -> [u32; 1024] {
    let mut table = [0; 1024];
    let mut i = 0;
    while i < table.len() {
        table[i] = (((1 << 28) - (1 << 13)) / (i as u32 + 1)).isqrt();
        i += 1;
    }
    table
}

/// A ray before its first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ray {
    /// Number of the eye: 0 for the left or only eye, 1 for the right eye.
    pub eye: usize,
    /// Direction, s1.17, of length 1 at most: in the maximum norm, or in the Euclidean norm for scenes with spheres.
    pub direction: [i32; 3],
    /// Length index: the first ten fraction bits of the largest component of the unscaled direction D (docs/formats/raymarch.md,
    /// "Rays"), or of |D|² for scenes with spheres. It selects the table entry that scales D to `direction`.
    pub length: u32,
    /// Parameter t at the start of the ray, u11.12: at the near plane, or where the ray enters the bounding box.
    pub start: u32,
}

/// The end of a marching ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayResult {
    /// Whether the ray hit a surface, missed or ended undecided.
    pub state: State,
    /// Parameter t of the last evaluated point; for a hit on a sphere or fillet, of the point one step farther. u11.12.
    pub t: u32,
    /// Distance from the point at `t` to the plane of the face that was hit, at most 1 − 2^−12; 0
    /// without a face. u0.12.
    pub gap: u32,
    /// The first ten fraction bits of the direction's component along the face's inward normal; all ones for a ray that
    /// does not approach the face.
    pub slope: u32,
    /// Evaluated points, at most 1020.
    pub steps: u32,
}

impl RayResult {
    /// Parameter t at the end of the ray, u11.12. For a hit on a face, the end is on the plane of the face.
    pub fn reached(&self) -> u32 {
        let rest = (self.gap * INVERSE[self.slope as usize & 0x3FF]) >> 9;
        (self.t + rest).min(FARTHEST)
    }
}

impl Marching {
    /// The ray of pixel (x, y) for an eye.
    pub fn ray(&self, eye: usize, x: u32, y: u32) -> Ray {
        // The unscaled direction D with 24 fraction bits, s1.24.
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
        let near = self.at_depth(self.near, length);
        let entry = self.entry(eye, &direction).min(u64::from(u32::MAX)) as u32;
        Ray {
            eye,
            direction,
            length,
            start: near.max(entry).min(FARTHEST),
        }
    }

    /// Length index of an unscaled direction D whose components have the magnitudes `parts`, with 24 fraction bits: the
    /// first ten fraction bits of the largest magnitude, or of |D|² rounded up for scenes with spheres.
    fn length(&self, parts: [u32; 3]) -> u32 {
        if self.is_round() {
            // Squares 17 bits of each component. The truncated bits change the sum by less than 2^−15; this bound is added.
            let square: u64 = parts.map(|part| u64::from(part >> 7).pow(2)).iter().sum();
            ((square + (1 << 19)) >> 24) as u32 & 0x3FF
        } else {
            longest(parts)
        }
    }

    /// The factor that scales D to a direction of length 1 at most, by the length index of D: u8.9.
    pub(super) fn inverse(&self, length: u32) -> u32 {
        if self.is_round() {
            ROUND_INVERSE[length as usize]
        } else {
            INVERSE[length as usize]
        }
    }

    /// Scales an unscaled direction D with length index `length` to a direction of length 1 at most.
    fn scaled(&self, direction: [i32; 3], length: u32) -> [i32; 3] {
        let inverse = self.inverse(length);
        direction.map(|part| scaled(part, inverse))
    }

    /// Parameter t at the given depth along the camera's forward axis n, or slightly less, of a ray with length index
    /// `length`.
    fn at_depth(&self, depth: u32, length: u32) -> u32 {
        // A lower bound of the reciprocal of `inverse`, with 10 fraction bits.
        let part = if self.is_round() {
            (self.inverse(length) * (length + 1)) >> 9
        } else {
            length + 1
        };
        ((u64::from(depth) * u64::from(part)) >> 10) as u32
    }

    /// Parameter t at which a ray enters the bounding box, or less by a relative 2^−17 at most. The point at t is therefore never inside
    /// the box.
    ///
    /// Along each axis, t is the distance to the box divided by the component of the direction. The reciprocal from the table is too small
    /// by up to a relative 1/i for index i, so the remaining distance is divided a second time.
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
                // For a negative component `magnitude` is |d| − 1, so |d| is at most `part` + 1.
                let gone = (near * (part + 1)) >> 17;
                near + divided(outside.saturating_sub(gone + 1))
            })
            .max()
            .unwrap_or(0)
    }

    /// Marches a ray to its end.
    pub fn march(&self, ray: &Ray) -> RayResult {
        let tuning = &self.tuning;
        let mut t = ray.start;
        let mut steps = 0;
        loop {
            let (distance, gone) = self.evaluate(ray, t);
            let threshold = (tuning.threshold + (t >> tuning.footprint)) << self.patience(steps);
            steps += 1;
            let next = t + distance.max(0) as u32;
            let state = if gone || next > tuning.far {
                Some(State::Miss)
            } else if distance < threshold as i32 {
                // Only the last point needs its surface.
                let point = self.point(ray, t).map(in_range);
                Some(State::Hit(self.sample(point).surface))
            } else if steps >= self.cap() {
                Some(State::Undecided)
            } else {
                None
            };
            if let Some(state) = state {
                let (t, gap, slope) = match state {
                    State::Hit(Surface::Face { axis, positive }) => {
                        let (gap, slope) = approach(ray, distance, axis, positive);
                        (t, gap, slope)
                    }
                    State::Hit(Surface::Octant { signs }) => {
                        let (gap, slope) = approach_diagonal(ray, distance, signs);
                        (t, gap, slope)
                    }
                    State::Hit(Surface::Round { .. } | Surface::Blended { .. }) => (next, 0, 0x3FF),
                    State::Miss | State::Undecided => (t, 0, 0),
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

    /// Number of times that the threshold has doubled after `steps` evaluations. A ray along a face takes many short
    /// steps, so its threshold grows. A ray close to a sphere also takes many short steps, but then passes the sphere,
    /// so in scenes with spheres the threshold does not grow.
    pub(super) fn patience(&self, steps: u32) -> u32 {
        if self.is_round() { 0 } else { steps >> 6 }
    }

    /// Step limit of a ray; larger for scenes with spheres, because rays take many short steps close to a sphere.
    pub(super) fn cap(&self) -> u32 {
        self.tuning.cap << if self.is_round() { 2 } else { 0 }
    }

    /// Evaluates the field at the ray's point at t. Returns the distance, and whether the ray has left the field's bounds and cannot
    /// reenter them.
    pub(super) fn evaluate(&self, ray: &Ray, t: u32) -> (i32, bool) {
        let point = self.point(ray, t);
        let distance = self.distance(point.map(in_range));
        (distance, self.is_gone(ray, &point))
    }

    /// Whether a ray is outside of the bounding box and moves away from it.
    fn is_gone(&self, ray: &Ray, point: &[i32; 3]) -> bool {
        (0..3).any(|i| {
            magnitude(point[i]) > self.bounds[i] && (point[i] < 0) == (ray.direction[i] < 0)
        })
    }

    /// The point of a ray at the parameter t, in field units, s13.12.
    pub fn point(&self, ray: &Ray, t: u32) -> [i32; 3] {
        [0, 1, 2].map(|i: usize| {
            let way = i64::from(t) * i64::from(ray.direction[i]);
            // The sum wraps only for invalid frame constants.
            self.eyes[ray.eye].origin[i].wrapping_add((way >> 17) as i32)
        })
    }

    /// The end of a ray as a picture shows it.
    pub fn seen(&self, ray: &Ray, end: &RayResult) -> RayEnd {
        RayEnd {
            shadow: false,
            state: end.state,
            depth: self.depth_of(ray, end.reached()),
            steps: end.steps,
            evaluations: end.steps * self.passes(),
            // The upper 8 of the 17 fraction bits.
            height: (ray.direction[2].max(0) >> 9).min(255) as u8,
            normal: self.normal(ray, end),
        }
    }

    /// The vector from the centre of the sphere that was hit to the hit; `None` if the ray hit no sphere or fillet. t has 10 fraction bits.
    fn normal(&self, ray: &Ray, end: &RayResult) -> Option<[i32; 3]> {
        let State::Hit(surface) = end.state else {
            return None;
        };
        let (spheres, number) = (self.spheres()?, surface.number()?);
        Some(spheres.from(number, self.point(ray, end.t & !3)))
    }

    /// Depth along the camera's forward axis n of a ray's point at t, in field units times 2^e with the exponent e of this
    /// setup, 21 fraction bits.
    pub fn depth_of(&self, ray: &Ray, t: u32) -> u64 {
        u64::from(t) * u64::from(self.inverse(ray.length))
    }
}

/// The first ten fraction bits of the largest of three magnitudes with 24 fraction bits.
fn longest([a, b, c]: [u32; 3]) -> u32 {
    a.max(b).max(c) >> 14 & 0x3FF
}

/// The product of a component of D, s1.24, and a factor, u8.9: s1.17, to nearest.
fn scaled(part: i32, factor: u32) -> i32 {
    ((i64::from(part) * i64::from(factor) + (1 << 15)) >> 16) as i32
}

/// Converts a coordinate of a point to the field's format s10.12.
fn in_range(x: i32) -> i32 {
    cropped(x, 10 + FRACTION)
}

/// Returns gap and slope of a hit on a face perpendicular to an axis (see the fields of these names in `RayResult`).
/// `distance` is the distance at the last point, and `positive` states whether the face's normal points along the axis.
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

/// Like [`approach`], for a face perpendicular to a diagonal. Gap and slope are both three quarters of their exact values, so their
/// quotient is exact. The exact slope is a third of the sum of the direction's three components towards the face; a quarter of the sum
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

/// Converts a distance to a gap: u0.12, saturated at 0 and at 1 − 2^−12.
fn gap(distance: i32) -> u32 {
    distance.clamp(0, (1 << FRACTION) - 1) as u32
}
