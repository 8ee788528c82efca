//! Rays that march through a distance field: start, steps and end of a ray.

use glint_core::field::{FRACTION, magnitude};

use super::end::{RayEnd, State};
use super::marching::{MARCH_FRACTION, Marching};

/// Lower bounds of 1/√q for q in (0, 4], u3.14. Entry i is for q up to (i + 1)/32.
const PACES: [u32; 128] = paces();

const fn paces() -> [u32; 128] {
    let mut table = [0; 128];
    let mut i = 0;
    while i < table.len() {
        table[i] = ((1 << 33) / (i as u64 + 1)).isqrt() as u32;
        i += 1;
    }
    table
}

/// A ray before its first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ray {
    /// Number of the eye: 0 for the left or only eye, 1 for the right eye.
    pub eye: usize,
    /// Direction D, s1.17, to nearest.
    pub direction: [i32; 3],
    /// Parameter T at the start of the ray, u14.10, rounded down: where it enters the bounding box, or at the near plane.
    pub start: u32,
    /// Whether the ray misses because it does not meet the bounding box before the far limit. `start` is then not used.
    pub is_over: bool,
    /// Change of T per distance: a lower bound of 1/|D|, u3.14.
    pub pace: u32,
    /// Height of the direction ([`RayEnd::height`]).
    pub height: u8,
}

/// The end of a marching ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayResult {
    /// Whether the ray hit a surface, missed or ended undecided.
    pub state: State,
    /// Parameter T of the last evaluated point or, for a hit, of the point one step farther; u14.10.
    pub t: u32,
    /// Number of evaluated points, at most 1023.
    pub steps: u32,
}

impl Marching {
    /// Largest parameter T, u14.10. A ray whose next step would exceed it misses.
    pub const FARTHEST: u32 = (1 << 24) - 1;

    /// The ray of pixel (x, y) for an eye.
    pub fn ray(&self, eye: usize, x: u32, y: u32) -> Ray {
        let beam = self.entry.ray(eye, x, y);
        let direction = beam.direction();
        Ray {
            eye,
            direction,
            pace: match self.beside.bend {
                0 => pace(direction),
                // In a bent union, the point where a ray enters the solid depends on the lengths of the ray's steps.
                _ => long_pace(direction),
            },
            height: beam.height(),
            start: (beam.start.t >> (self.entry.words.parameter - MARCH_FRACTION)) as u32,
            is_over: self.entry.ends_at_start(&beam, self.entry.far),
        }
    }

    /// Marches a ray to its end.
    pub fn march(&self, ray: &Ray) -> RayResult {
        let mut t = ray.start;
        let mut steps = 0;
        loop {
            let point = self.point(ray, t);
            let sample = self.sample(point);
            steps += 1;
            let next = t + stride(sample.distance, ray.pace);
            let state = if ray.is_over || self.is_gone(ray, &point) || next > Self::FARTHEST {
                Some(State::Miss)
            } else if sample.distance < self.reach(t) {
                Some(State::Hit(sample.surface))
            } else if steps >= self.cap {
                Some(State::Undecided)
            } else {
                None
            };
            if let Some(state) = state {
                let t = if let State::Hit(_) = state { next } else { t };
                return RayResult { state, t, steps };
            }
            t = next;
        }
    }

    /// The distance below which a ray hits at the parameter T, s10.12.
    fn reach(&self, t: u32) -> i32 {
        // T has two fraction bits fewer than the distance. The exponent is at least 7 in valid frames.
        (self.threshold + (t >> self.footprint.saturating_sub(FRACTION - MARCH_FRACTION))) as i32
    }

    /// Whether a ray is outside of the bounding box and moves away from it.
    fn is_gone(&self, ray: &Ray, point: &[i32; 3]) -> bool {
        let bounds = self.bounds();
        (0..3).any(|i| {
            magnitude(point[i]) > bounds[i].unsigned_abs()
                && (point[i] < 0) == (ray.direction[i] < 0)
        })
    }

    /// The point of a ray at the parameter T, in field units, s15.12.
    pub fn point(&self, ray: &Ray, t: u32) -> [i32; 3] {
        [0, 1, 2].map(|i: usize| {
            let way = i64::from(t) * i64::from(ray.direction[i]);
            self.entry.eyes[ray.eye].origin[i] + (way >> (17 + MARCH_FRACTION - FRACTION)) as i32
        })
    }

    /// The end of a ray, with all that the colour and the depth code of a pixel need.
    pub fn seen(&self, ray: &Ray, end: &RayResult) -> RayEnd {
        RayEnd {
            shadow: false,
            state: end.state,
            depth: self.depth_of(end.t),
            steps: end.steps,
            evaluations: end.steps * self.passes(),
            height: ray.height,
            normal: self.normal(ray, end),
        }
    }

    /// The vector from the centre of the hit sphere to the hit point; `None` if the ray hit no sphere or fillet.
    fn normal(&self, ray: &Ray, end: &RayResult) -> Option<[i32; 3]> {
        let State::Hit(surface) = end.state else {
            return None;
        };
        let number = surface.number()?;
        Some(self.spheres().from(number, self.point(ray, end.t)))
    }

    /// Depth along the camera's forward axis n of a point at the parameter T, in field units times 2^e with the exponent e of this setup,
    /// 21 fraction bits.
    pub fn depth_of(&self, t: u32) -> u64 {
        u64::from(t) << (21 - MARCH_FRACTION)
    }
}

/// A lower bound of 1/|D|, u3.14, for a direction D, s1.17.
fn pace(direction: [i32; 3]) -> u32 {
    // An upper bound of |D|², at most 3, with 12 fraction bits, from the first six bits of each component.
    let squares = direction.map(|part| ((magnitude(part) >> 11 & 0x3F) + 1).pow(2));
    let square: u32 = squares.iter().sum();
    PACES[(square >> 7) as usize & 127]
}

/// As [`pace`], but computed from all bits of the direction, so that the pace does not jump between neighbouring pixels. Used for bent
/// unions, which only the CPU draws.
fn long_pace(direction: [i32; 3]) -> u32 {
    // The squares have 34 fraction bits.
    let squares = direction.map(|part| (u64::from(magnitude(part)) + 1).pow(2));
    let square: u64 = squares.iter().sum();
    ((1_u64 << 62) / square).isqrt() as u32
}

/// The step in T that a ray may take from a point with this `distance` to the solid; 0 inside the solid. Rounded up, so that every step
/// outside of the solid increases T.
fn stride(distance: i32, pace: u32) -> u32 {
    const SHIFT: u32 = FRACTION + 14 - MARCH_FRACTION;
    let product = u64::from(distance.max(0) as u32) * u64::from(pace);
    ((product + ((1 << SHIFT) - 1)) >> SHIFT) as u32
}
