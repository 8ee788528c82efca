//! Distances to spheres from a table of square roots. Distances are rounded down, so that a ray that advances by the distance
//! never passes a surface.

use super::fixed_cone::FixedCone;
use crate::division::quotient;
use crate::feature::SPHERES;
use crate::field::limits::MAX_SPHERES;
use crate::field::surface::{FRACTION, FieldSample, Surface, cropped, magnitude};

/// A sphere with lengths in field units, which have 12 fraction bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedSphere {
    /// The centre, s10.12.
    pub centre: [i32; 3],
    /// The radius, u10.12: from 2^6 to 2^22 − 1 units of 2^−12; below 2^21 for marching rays.
    pub radius: i32,
    /// Reciprocal of the radius: 2^37 over the radius, which is first shifted until it has 21 bits. The quotient is rounded
    /// to nearest and saturates to 17 bits.
    pub inverse: u32,
    /// The right shift (6 to 21) by which the product of the radius and a number with 16 fraction bits is reduced to 17 bits.
    pub shift: u32,
}

impl FixedSphere {
    /// Makes a sphere from its centre and its radius, which is from 2^6 to 2^22 − 1 units of 2^−12.
    pub fn new(centre: [i32; 3], radius: i32) -> Self {
        let lead = radius.max(1).ilog2().clamp(6, 21);
        let shifted = (radius.max(1) as u64) << (21 - lead) >> 1;
        let inverse = quotient((1 << 37) + shifted / 2, shifted).min((1 << 17) - 1) as u32;
        Self {
            centre,
            radius,
            inverse,
            shift: lead,
        }
    }
}

/// Several spheres, which the gateware evaluates sequentially, and a cone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedSpheres {
    /// The spheres are in the first `count` entries; the other entries are not used.
    pub list: [FixedSphere; MAX_SPHERES],
    /// Number of spheres, at most 8.
    pub count: usize,
    /// Whether the first sphere, about the origin, is periodic with 64 field units along each axis.
    pub repeated: bool,
    /// The cone whose lateral surface has the number of the last entry of `list`. This entry is a sphere around the cone.
    pub cone: Option<FixedCone>,
}

/// Largest distance, s10.12.
const MOST: i32 = (1 << 21) - 1;

impl FixedSpheres {
    /// Adds the spheres of a list until this list is full.
    pub fn add(&mut self, list: &Self) {
        let places = self.list.iter_mut().skip(self.count);
        for (place, sphere) in places.zip(list.list.iter().take(list.count)) {
            *place = *sphere;
            self.count += 1;
        }
        self.cone = list.cone;
    }

    /// Returns the distance of a point from the nearest sphere, and the number of this sphere; of equally near spheres the first.
    pub fn sample(&self, point: [i32; 3]) -> FieldSample {
        let mut nearest = FieldSample {
            distance: MOST,
            surface: Surface::Round { number: 0 },
        };
        let count = if SPHERES.is_built { self.count } else { 0 };
        for (number, sphere) in (0..).zip(self.list.iter().take(count)) {
            // Before saturation to `MOST`, the distance is below 2^23.
            let sample = match self.cone(number) {
                Some(cone) => {
                    let [x, y, z] = point;
                    cone.sample(length([x, y, 0]), z, number)
                }
                None => FieldSample {
                    distance: length(self.from(number, point)) - sphere.radius,
                    surface: Surface::Round { number },
                },
            };
            if sample.distance < nearest.distance {
                nearest = sample;
            }
        }
        nearest
    }

    /// The cone whose lateral surface has this number.
    pub fn cone(&self, number: u8) -> Option<&FixedCone> {
        (self.cone.as_ref()).filter(|_| usize::from(number) + 1 == self.count)
    }

    /// Returns the vector from the centre of sphere `number`, or from the apex of the cone, to a point, s11.12, modulo 2^23.
    pub fn from(&self, number: u8, point: [i32; 3]) -> [i32; 3] {
        // A period of 64 field units is 2^18 in this format. Therefore the lowest 18 bits of a coordinate, as a signed number,
        // are the coordinate relative to the centre of its cell.
        let bits = match self.repeated && number == 0 {
            true => 6 + FRACTION,
            false => 23,
        };
        let centre = match self.cone(number) {
            Some(cone) => cone.apex(),
            None => self.list[usize::from(number) % MAX_SPHERES].centre,
        };
        [0, 1, 2].map(|i: usize| cropped(point[i] - centre[i], bits))
    }
}

/// Table of √x for x from 1 to 4 in steps of 1/128: the root, and the difference between the next root and this one. The index is
/// 128·x; the roots have 18 fraction bits and are rounded down. Linear interpolation between entries never exceeds the exact root; its
/// relative error is at most 2.3·2^−18.
const ROOTS: [(u32, u32); 512] = roots();

const fn roots() -> [(u32, u32); 512] {
    let mut table = [(0, 0); 512];
    let mut i = 0;
    while i < table.len() {
        // The entries for x below 1 are unused, and repeat the value for x = 1.
        let from = if i < 128 { 128 } else { i as u64 };
        let root = (from << 29).isqrt() as u32;
        table[i] = (root, ((from + 1) << 29).isqrt() as u32 - root);
        i += 1;
    }
    table
}

/// Returns a lower bound of the length of a vector with components of at most 23 bits. The result is too small by at most 3 units
/// of the components plus 2^−15 of the length.
pub fn length(q: [i32; 3]) -> i32 {
    let parts = q.map(magnitude);
    let Some(lead) = (parts[0] | parts[1] | parts[2]).checked_ilog2() else {
        return 0;
    };
    // The components are scaled so that the largest has 17 bits, and their squares are added.
    let square: u64 = parts
        .map(|part| u64::from((part << (21 - lead)) >> 5).pow(2))
        .iter()
        .sum();
    let doubled = (square >> 34 != 0) as u32;
    ((normalised_root(square >> (2 * doubled)) << 4) >> (22 - lead - doubled)) as i32
}

/// Returns a lower bound of 4·√x for x from 2^32 to 2^34 − 1. The relative error is at most 2^−18.
pub fn normalised_root(x: u64) -> u32 {
    let (root, slope) = ROOTS[(x >> 25) as usize & 511];
    let rest = (x >> 8) as u32 & 0x1_FFFF;
    root + ((u64::from(slope) * u64::from(rest)) >> 17) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_rounded_down() {
        let mut state = 1_u64;
        let mut random = |bits: u32| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as i32 >> (32 - bits)
        };
        for round in 0..1_000_000 {
            let q = [0; 3].map(|_| random(1 + round % 23));
            let square: i64 = q.map(|x| i64::from(x).pow(2)).iter().sum();
            let found = i64::from(length(q));
            let exact = (square as u64).isqrt() as i64;
            assert!(found <= exact, "{q:?}: {found}");
            assert!(exact - found <= 3 + (exact >> 15), "{q:?}: {found}");
        }
        assert_eq!(length([0; 3]), 0);
    }
}
