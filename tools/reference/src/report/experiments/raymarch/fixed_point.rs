//! Raymarching of the Menger sponge in integers with an adjustable number of fraction bits, for the study of word lengths.
//!
//! The gateware and its model have 12 fraction bits. Ray directions always have 17 fraction bits, as in the model.

use glint_model::raymarch::{DEFAULT_TUNING, Marching, Ray, Tuning};

use crate::raymarch::metrics::RayOutcome;
use crate::raymarch::raymarched::{RenderedRay, Subject, marching};
use crate::raymarch::{Face, Field};

/// Number of fraction bits of a length in the model, whose unit is the field unit (docs/formats/raymarch.md).
pub const MODEL_FRACTION: u32 = 12;

/// Twice the number of field units per world unit. The sponge's half side is 1 world unit or 40.5 field units.
const TWICE_SCALE: i64 = 81;

/// The constants of a picture of the sponge for a number of fraction bits.
pub struct FixedPoint {
    /// Width and height of the picture.
    size: (u32, u32),
    /// The model's constants of the picture, from which the ray directions are computed.
    marching: Marching,
    /// Exponent e of the directions D (docs/formats/raymarch.md, "Rays").
    exponent: u32,
    /// Number of fraction bits of a length in field units, from 8 to 16.
    fraction: u32,
    /// Sides S of the cells of each level, in field units with `fraction` bits: see `menger` in docs/formats/raymarch.md.
    levels: Vec<i32>,
    /// Half the sponge's side, in field units with `fraction` bits.
    bound: u32,
    /// Position of the eye, in field units with `fraction` bits.
    origin: [i32; 3],
    /// Smallest depth of a hit, in field units with `fraction` bits, times 2^`exponent`.
    near: u32,
    /// Parameters of the march. Threshold and far limit have `fraction` bits.
    tuning: Tuning,
}

impl FixedPoint {
    /// Computes the constants of a subject's picture for `fraction` fraction bits. `threshold` has
    /// the model's fraction bits, and is rounded to the nearest number with `fraction` bits.
    ///
    /// # Panics
    /// When the subject is not a sponge with one to four levels.
    pub fn new(subject: &Subject, fraction: u32, threshold: u32) -> Self {
        let Field::Menger { depth } = subject.field else {
            panic!("{}: expected a sponge", subject.scene);
        };
        assert!((1..=4).contains(&depth), "expected at most four levels");
        let setup = subject.setup(&marching());
        let view = subject
            .camera
            .view()
            .expect("a subject's camera is a view's");
        // Converts a length in world units with 24 fraction bits to field units with `fraction` bits. Rounds to nearest, halves up.
        let units =
            |length: i64| (length * TWICE_SCALE + (1 << (24 - fraction))) >> (25 - fraction);
        let corner: i64 = (0..3)
            .map(|i| {
                let n = i64::from(view.n()[i].to_bits());
                let reach = n.abs() * ((1 << 14) + 2);
                -n * (view.eye()[i].to_bits() >> 18) - reach - (reach >> 13)
            })
            .sum();
        let plane = units(i64::from(view.near().to_bits()) >> 4);
        let near = plane.max(units(corner >> 13) - 1) << setup.exponent;
        let rescaled = |length: u32| {
            ((u64::from(length) << fraction) + (1 << (MODEL_FRACTION - 1))) >> MODEL_FRACTION
        };
        Self {
            size: subject.size,
            marching: *setup.marching().expect("marching rays"),
            exponent: setup.exponent,
            fraction,
            levels: (0..depth)
                .map(|i| (27 / 3_i32.pow(i)) << fraction)
                .collect(),
            bound: units(1 << 24) as u32,
            origin: view.eye().map(|c| units(c.to_bits() >> 8) as i32),
            near: near.clamp(0, i64::from(farthest(fraction))) as u32,
            tuning: Tuning {
                threshold: rescaled(threshold) as u32,
                far: (rescaled(DEFAULT_TUNING.far + 1) - 1) as u32,
                ..DEFAULT_TUNING
            },
        }
    }

    /// Draws the picture, row by row, and returns the results of its rays.
    pub fn picture(&self) -> Vec<RenderedRay> {
        let (width, height) = self.size;
        (0..width * height)
            .map(|i| self.march(&self.marching.ray(0, i % width, i / width)))
            .collect()
    }

    fn march(&self, ray: &Ray) -> RenderedRay {
        let mut t = self.start(ray);
        let mut steps = 0;
        let outcome = loop {
            let point = self.point(ray, t);
            let (distance, axis, positive) = self.sample(point);
            let threshold = (self.tuning.threshold + (t >> self.tuning.footprint)) << (steps >> 6);
            steps += 1;
            let next = t + distance.max(0) as u32;
            let leaves = |i: usize| {
                magnitude(point[i]) > self.bound && (point[i] < 0) == (ray.direction[i] < 0)
            };
            if (0..3).any(leaves) || next > self.tuning.far {
                break RayOutcome::Miss;
            }
            if distance < threshold as i32 {
                let reached = t + self.rest(ray, distance, axis, positive);
                let mut normal = [0.0; 3];
                normal[axis] = if positive { 1.0 } else { -1.0 };
                break RayOutcome::Hit {
                    t: self.depth(ray, reached.min(farthest(self.fraction))),
                    face: Face::Axis { axis, positive },
                    normal,
                };
            }
            if steps >= self.tuning.cap {
                break RayOutcome::Undecided;
            }
            t = next;
        };
        RenderedRay {
            outcome,
            coded: None,
            steps,
        }
    }

    /// Returns the parameter t of a ray's start: at the near plane, or at the cube around the sponge if the cube is farther.
    fn start(&self, ray: &Ray) -> u32 {
        let near = ((u64::from(self.near) * u64::from(ray.length + 1)) >> 10) as u32;
        let farthest = farthest(self.fraction);
        let entry = (0..3)
            .filter(|&i| (self.origin[i] < 0) != (ray.direction[i] < 0))
            .map(|i| {
                let outside = u64::from(self.origin[i].unsigned_abs().saturating_sub(self.bound));
                let part = magnitude(ray.direction[i]);
                let inverse = u64::from(self.reciprocal(part >> 7));
                // The reciprocal is slightly too small, and so is the first product. A second product, with the remaining length, corrects
                // the first product.
                let first = ((outside * inverse) >> 9).min(farthest.into());
                let gone = (first * (u64::from(part) + 1)) >> 17;
                first + ((outside.saturating_sub(gone + 1) * inverse) >> 9)
            })
            .max()
            .unwrap_or(0);
        near.max(entry.min(farthest.into()) as u32).min(farthest)
    }

    /// Returns the point of a ray at its parameter t.
    fn point(&self, ray: &Ray, t: u32) -> [i32; 3] {
        [0, 1, 2].map(|i: usize| {
            let way = i64::from(t) * i64::from(ray.direction[i]);
            self.origin[i] + (way >> 17) as i32
        })
    }

    /// Returns the signed distance of a point from the sponge in the maximum norm, the axis perpendicular to the nearest face,
    /// and whether the face's outward normal points along that axis.
    fn sample(&self, point: [i32; 3]) -> (i32, usize, bool) {
        let mut p = [0, 1, 2].map(|axis| (point[axis], axis, true));
        for &s in &self.levels {
            // `mirrored` negates x as `!x`, which is −x − 1, because an integer coordinate x represents x + 1/2.
            p = p.map(|x| if x.0 >= 0 { mirrored(x) } else { x });
            p = p.map(|(x, axis, positive)| (x + s, axis, positive));
            let big = largest(p.map(|x| x.0));
            p.swap(1, big);
            if p[1].0 < s / 2 {
                p[1] = mirrored(p[1]);
            } else {
                p[1].0 -= s;
            }
        }
        let p = p.map(|x| if x.0 < 0 { mirrored(x) } else { x });
        let (value, axis, positive) = p[largest(p.map(|x| x.0))];
        let half = self.levels.last().map_or(0, |s| s / 2);
        (value - half, axis, positive)
    }

    /// Returns the increase of t with which a ray that approaches a face reaches the plane of the face, at this distance.
    fn rest(&self, ray: &Ray, distance: i32, axis: usize, positive: bool) -> u32 {
        let part = ray.direction[axis];
        let slope = if (part < 0) == positive {
            magnitude(part) >> 7 & 0x3FF
        } else {
            0x3FF
        };
        let gap = distance.clamp(0, (1 << self.fraction) - 1) as u32;
        ((u64::from(gap) * u64::from(self.reciprocal(slope))) >> 9) as u32
    }

    /// Returns the depth of a ray at its parameter t, in world units along the camera's n.
    fn depth(&self, ray: &Ray, t: u32) -> f64 {
        let scaled = u64::from(t) * u64::from(self.reciprocal(ray.length));
        // The depth has 21 fraction bits, as in the model. The reciprocal contributes 9 of these bits.
        let scaled = scaled << MODEL_FRACTION >> self.fraction;
        let bits = 21.0 + f64::from(self.exponent);
        scaled as f64 * (-bits).exp2() / (TWICE_SCALE as f64 / 2.0)
    }

    /// Returns the reciprocal (u8.9) that the model uses for a number whose first ten bits are `first_bits`.
    fn reciprocal(&self, first_bits: u32) -> u32 {
        let ray = Ray {
            eye: 0,
            direction: [0; 3],
            length: first_bits & 0x3FF,
            start: 0,
        };
        self.marching.depth_of(&ray, 1) as u32
    }
}

/// Returns the largest parameter t of a ray, a number with 11 integer bits and `fraction` fraction bits.
const fn farthest(fraction: u32) -> u32 {
    (1 << (11 + fraction)) - 1
}

/// Returns |x| for x ≥ 0, and |x| − 1 for x < 0.
const fn magnitude(x: i32) -> u32 {
    (x ^ (x >> 31)) as u32
}

fn mirrored((value, axis, positive): (i32, usize, bool)) -> (i32, usize, bool) {
    (!value, axis, !positive)
}

/// Returns the index of the largest of three numbers. For equal numbers, index 1 has priority over 0, and 0 over 2.
fn largest([x, y, z]: [i32; 3]) -> usize {
    if z > x && z > y {
        2
    } else if x > y {
        0
    } else {
        1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raymarch::raymarched::sponges;

    #[test]
    fn with_the_models_fraction_bits_the_picture_is_the_models() {
        for subject in sponges((320, 180)) {
            let fixed = FixedPoint::new(&subject, MODEL_FRACTION, DEFAULT_TUNING.threshold);
            let model = subject.picture(&marching());
            for (found, expected) in fixed.picture().iter().zip(&model) {
                assert_eq!(
                    (found.outcome, found.steps),
                    (expected.outcome, expected.steps),
                    "{}",
                    subject.name
                );
            }
        }
    }
}
