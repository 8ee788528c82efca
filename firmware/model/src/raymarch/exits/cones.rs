//! Spheres of a list, and the cones in which an eye sees them.
//!
//! An eye outside of a sphere sees the sphere in a cone. With q from the centre to the eye, the unit vector c towards the centre, and the
//! unit vectors a and b perpendicular to c and to each other, a ray with the direction D meets the sphere of the radius r if (c·D)² >
//! κ²·((a·D)² + (b·D)²) and c·D > 0, where κ² = |q|²/r² − 1. If ρ² is the difference of the two sides of the inequality, the ray meets the
//! sphere at T = (|q|² − r²)/|q| / (c·D + (r/|q|)·ρ). This form of the quadratic equation's solution avoids the subtraction of nearly equal
//! numbers.
//!
//! If the near plane cuts a sphere, the section is a disc. The rays through the disc also form a cone, with 1 in place of c·D, and 0 in
//! place of r/|q|, so that T is constant.
//!
//! The products with D are linear in a pixel's column and row. The vector b is perpendicular to the direction's change per column, so that
//! b·D depends on the row only.

use glint_core::feature::SPHERES;
use glint_core::field::{FixedSphere, MAX_SPHERES};
use glint_core::vector::cross;

use super::narrow::{nearest, saturated};
use super::rectangle::Rectangle;
use super::vectors::{Scaled, Vector, bits, perpendicular, product, rounded, unit};

/// Number of bits of the magnitude of a change per column or row.
pub(super) const STEP: u32 = 24;
/// Number of fraction bits of the linear functions.
pub(super) const FRACTION: u32 = 30;
/// Largest shift of the changes of a cone's sides.
pub(super) const MOST_SHIFT: u32 = 6;
/// Exponent of the largest factor of a side, and of the largest coordinate of a ray relative to a disc's centre, in radii.
pub(super) const MOST_SIDE: i32 = 12;
/// Largest number of halvings. Only a sphere that is far smaller than a pixel would need more.
const MOST_HALVINGS: i32 = 20;
/// Number of fraction bits of r/|q|, the ratio of the radius to the distance of the centre.
pub(super) const SHARE: u32 = 17;
/// Number of bits of the mantissa of a cone's distance.
const DISTANCE: u32 = 24;
/// The bias of a cone's exponent: its distance is the mantissa times 2^(exponent − bias).
pub(super) const DISTANCE_OFFSET: i32 = 24;
/// Largest exponent of a cone's distance; the smallest is 0.
const MOST_DISTANCE: i32 = 15;

/// Largest number of cones: two for each sphere, or three for a solid cone and two for at most one sphere next to it.
const MAX_CONES: usize = if SPHERES.is_built { 2 * MAX_SPHERES } else { 0 };

/// The cones in which an eye sees the spheres of a list, in the order of the list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cones {
    list: [Cone; MAX_CONES],
    count: usize,
}

impl Cone {
    /// The value of `number` for the base of a solid cone.
    pub const BASE: u8 = 7;

    /// The function `forward` at a pixel, s1.30. Far from the rectangle of a solid cone the value may exceed its word; it then wraps modulo
    /// 4.
    pub(super) const fn forward_at(&self, column: u32, row: u32) -> i64 {
        self.forward.at(column, row, 0) as i32 as i64
    }
}

impl Cones {
    /// The cones as a slice.
    pub fn list(&self) -> &[Cone] {
        &self.list[..self.count]
    }

    /// Adds a cone, if the list is not full.
    pub(super) fn push(&mut self, cone: Cone) {
        if let Some(place) = self.list.get_mut(self.count) {
            *place = cone;
            self.count += 1;
        }
    }
}

/// A cone in which an eye sees a sphere, or a disc of the sphere in the near plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cone {
    /// What a ray in the cone meets.
    pub kind: ConeKind,
    /// Number of the sphere, or of the surface of a solid cone.
    pub number: u8,
    /// The pixels that may see the sphere.
    pub rectangle: Rectangle,
    /// c·D (see the top of this file); 1 for a disc.
    pub forward: Linear,
    /// κ·(a·D) and κ·(b·D); for a disc, the distances of the disc's centre from the ray along a and b, in radii. The second function
    /// changes along a row only for solid cones.
    pub sides: [Linear; 2],
    /// Exponent of 2 by which the changes of `sides` are multiplied: 0, 2, 4 or 6.
    pub shift: u32,
    /// r/|q|, in u0.17; 0 for a disc.
    pub share: i64,
    /// (|q|² − r²)/|q| in field units, or T of the near plane for a disc: a mantissa of 24 bits and an exponent of 0 to 15, with a bias
    /// of 24.
    pub distance: (i64, u32),
}

/// What a ray in a cone meets, which determines how T follows from the linear functions (`solid_cone` has the formulas).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ConeKind {
    /// A sphere, or the disc that the near plane cuts from a sphere.
    #[default]
    Sphere,
    /// The plane of a solid cone's base, for an eye below the plane: rays in the cone meet the base, and the lateral surface is behind the
    /// plane.
    Base,
    /// The plane of a solid cone's base, for an eye above the plane: no ray meets the base, and the lateral surface is in front of the
    /// plane.
    Limit,
    /// The lateral surface of a solid cone.
    Lateral,
    /// The lateral surface of a solid cone, for an eye above the apex that sees the surface on all sides.
    Around,
    /// The section of a solid cone by the near plane.
    Section,
}

impl ConeKind {
    /// The kind for each number in the gateware; unused numbers act as spheres.
    pub(super) const ALL: [Self; 8] = [
        Self::Sphere,
        Self::Base,
        Self::Limit,
        Self::Lateral,
        Self::Around,
        Self::Section,
        Self::Sphere,
        Self::Sphere,
    ];
}

/// A function that is linear in the column and the row of a pixel, with 30 fraction bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Linear {
    /// The value at the first pixel, s15.30.
    pub first: i64,
    /// Change per column, of 24 bits and a sign.
    pub across: i64,
    /// Change per row, of 24 bits and a sign.
    pub down: i64,
}

impl Linear {
    /// The value at a pixel, with the changes multiplied by 2^`shift`.
    pub(super) const fn at(&self, column: u32, row: u32, shift: u32) -> i64 {
        self.first + ((column as i64 * self.across + row as i64 * self.down) << shift)
    }
}

/// The position, the rays and the near plane of an eye.
pub(super) struct Sight {
    /// Position in field units, s13.12.
    pub(super) origin: [i32; 3],
    /// Direction D of the first ray, and its changes per column and row, s2.30.
    pub(super) directions: [Vector; 3],
    /// The parameter T of the near plane, u14.14, slightly enlarged, so that a hit on a sphere that rounding moves in front of the plane is
    /// in the disc.
    pub(super) near: Scaled,
    /// T of the hits in a disc: T of the near plane, or larger by a relative 2^−16 at most.
    disc: Scaled,
    /// The near plane's normal, and two axes in the plane. The second axis is perpendicular to the change of D per column.
    pub(super) plane: [Vector; 3],
    /// The vector from the eye to the first ray's point in the near plane, with 16 fraction bits.
    pub(super) point: Vector,
}

/// A pixel and the direction D of its ray.
pub(super) struct Pixel {
    column: u32,
    row: u32,
    pub direction: Vector,
}

impl Sight {
    /// The view of an eye at `origin`, with the near plane at the parameter `near`, u14.14.
    pub(super) fn new(origin: [i32; 3], directions: [Vector; 3], near: i64) -> Self {
        let [first, step, down] = directions;
        // The changes per column and row are 0 in a picture of a single ray.
        let normal = match cross(step, down) {
            [0, 0, 0] => unit(first.map(i64::from)),
            normal => unit(normal),
        };
        let a = match step {
            [0, 0, 0] => perpendicular(&normal, &step),
            step => unit(step.map(i64::from)),
        };
        let b = perpendicular(&normal, &a);
        let behind = near + (near >> 16);
        let margin = Scaled::new((1 << 17) + 1, -17);
        Self {
            origin,
            directions,
            near: Scaled::new(behind.cast_unsigned(), -14),
            disc: Scaled::new(near.cast_unsigned(), -14).by(margin),
            plane: [normal, a, b],
            point: first.map(|part| nearest(behind * i64::from(part), 28) as i32),
        }
    }

    /// Computes the cones of a sphere and passes them to `take`. `cone` has the number and the rectangle of the sphere.
    pub(super) fn cones(&self, sphere: &FixedSphere, cone: &mut Cone, take: &mut dyn FnMut(&Cone)) {
        if cone.rectangle.is_empty() {
            return;
        }
        // The vector from the sphere's centre to the eye.
        let place = [0, 1, 2].map(|i: usize| self.origin[i] - sphere.centre[i]);
        let middle = self.pixel(cone.rectangle.middle());
        if self.outline(cone, &place, sphere.radius, &middle) {
            take(cone);
        }
        let q = place.map(|part| part << 4);
        let depth = self.depth(&q);
        let radius = i64::from(sphere.radius) << 4;
        if depth.abs() < radius {
            self.disc(cone, &q, radius * radius - depth * depth, &middle);
            take(cone);
        }
    }

    /// The distance from a point to the near plane, with 16 fraction bits. `q` is the vector from the point to the eye, with 16 fraction
    /// bits.
    fn depth(&self, q: &Vector) -> i64 {
        let point = [0, 1, 2].map(|i: usize| q[i] + self.point[i]);
        rounded(product(&point, &self.plane[0]), 30)
    }

    /// Whether the near plane cuts a sphere.
    pub(super) fn cuts(&self, sphere: &FixedSphere) -> bool {
        let q = [0, 1, 2].map(|i: usize| (self.origin[i] - sphere.centre[i]) << 4);
        self.depth(&q).abs() < i64::from(sphere.radius) << 4
    }

    /// The pixel with this column and row, and its ray.
    pub(super) fn pixel(&self, [column, row]: [u32; 2]) -> Pixel {
        let [first, step, down] = &self.directions;
        Pixel {
            column,
            row,
            direction: [0, 1, 2].map(|i: usize| {
                let across = step[i].wrapping_mul(column as i32);
                let down = down[i].wrapping_mul(row as i32);
                first[i].wrapping_add(across).wrapping_add(down)
            }),
        }
    }

    /// Sets the constants of the cone around a sphere. `q` is the vector from the sphere's centre to the eye. Returns `false` for an eye
    /// inside the sphere.
    fn outline(&self, cone: &mut Cone, q: &Vector, radius: i32, middle: &Pixel) -> bool {
        let radius = i64::from(radius.max(1));
        let square = product(q, q);
        let beyond = square - radius * radius;
        if beyond < 0 {
            return false;
        }
        let forward = unit(q.map(|part| -i64::from(part)));
        // `b` is any axis perpendicular to `forward` if D does not change along a row, or changes in the direction of the centre.
        let b = perpendicular(&forward, &self.directions[1]);
        let a = perpendicular(&b, &forward);
        // Quotients and roots are computed as products with reciprocal square roots.
        let reciprocal = |square: i64| Scaled::inverse_root(square.cast_unsigned(), -24);
        let inverse_length = reciprocal(square);
        let inverse_radius = reciprocal(radius * radius);
        let dividend = Scaled::new(beyond.cast_unsigned(), -24);
        let factor = match beyond {
            0 => dividend,
            _ => dividend.by(reciprocal(beyond)).by(inverse_radius),
        };
        let sides = [&a, &b].map(|axis| Function {
            axis,
            factor,
            offset: 0,
        });
        let halvings = self.set_sides(cone, middle, &sides, false);
        let [_, step, down] = &self.directions;
        let one = Function {
            axis: &forward,
            factor: Scaled::ONE,
            offset: 0,
        };
        let changes = [one.change(step), one.change(down)];
        cone.forward = one.words(middle, changes, 0, halvings);
        let radius = Scaled::new(radius.cast_unsigned(), -12);
        cone.share = radius.by(inverse_length).fixed(SHARE).min((1 << SHARE) - 1);
        cone.distance = distance(dividend.by(inverse_length).halved(halvings));
        true
    }

    /// Sets the constants of the cone of a disc in the near plane. `q` is the vector from the sphere's centre to the eye, with 16 fraction
    /// bits. `square` is the square of the disc's radius, with 32 fraction bits.
    // Not inlined, because most spheres do not reach the near plane.
    #[inline(never)]
    fn disc(&self, cone: &mut Cone, q: &Vector, square: i64, middle: &Pixel) {
        let [_, a, b] = &self.plane;
        let inverse_radius = Scaled::inverse_root(square.cast_unsigned(), -32);
        // The vector from the centre to the eye, along a and b, in radii of the disc.
        let offsets = [a, b].map(|axis| {
            let offset = rounded(product(q, axis), 30);
            let size = Scaled::new(offset.unsigned_abs(), -16).by(inverse_radius);
            size.fixed(FRACTION) * offset.signum()
        });
        let factor = self.near.by(inverse_radius);
        let sides = [(a, offsets[0]), (b, offsets[1])].map(|(axis, offset)| Function {
            axis,
            factor,
            offset,
        });
        let halvings = self.set_sides(cone, middle, &sides, false);
        cone.forward = Linear {
            first: 1 << (FRACTION - halvings),
            ..Linear::default()
        };
        cone.share = 0;
        // All rays have the same divisor: 2^22 + 1/2 in units of 2^−22, if there are no halvings.
        let divisor = Scaled::new((1 << (23 - halvings)) + 1, -23);
        cone.distance = distance(self.disc.by(divisor));
    }

    /// Sets the functions `sides` of a cone. `varies` states whether the second function changes along a row; if not, its axis is
    /// perpendicular to the change of D per column. Returns how often the constants of the cone must be halved to fit their words.
    #[inline(never)]
    pub(super) fn set_sides(
        &self,
        cone: &mut Cone,
        middle: &Pixel,
        sides: &[Function; 2],
        varies: bool,
    ) -> u32 {
        let [_, step, down] = &self.directions;
        let [a, b] = sides;
        let across = if varies { b.change(step) } else { 0 };
        let changes = [[a.change(step), a.change(down)], [across, b.change(down)]];
        let sizes = changes.as_flattened().iter().map(|x| x.unsigned_abs());
        let excess = (bits(sizes.fold(0, |all, size| all | size)) - STEP as i32).max(0);
        cone.shift = excess.cast_unsigned().next_multiple_of(2).min(MOST_SHIFT);
        let largest = (sides.iter()).fold(1, |all, side| all | side.offset.unsigned_abs());
        let side = (a.factor.log2())
            .max(b.factor.log2())
            .max(bits(largest) - 1 - FRACTION as i32);
        let halvings = (excess - MOST_SHIFT as i32)
            .max(side + 1 - MOST_SIDE)
            .clamp(0, MOST_HALVINGS) as u32;
        for ((words, side), changes) in cone.sides.iter_mut().zip(sides).zip(changes) {
            *words = side.words(middle, changes, cone.shift, halvings);
        }
        halvings
    }
}

/// The function `factor`·(axis·D) + offset of a direction D.
pub(super) struct Function<'a> {
    pub axis: &'a Vector,
    pub factor: Scaled,
    /// The constant term, with 30 fraction bits.
    pub offset: i64,
}

impl Function<'_> {
    /// The change of the function for a change `step` of D, with 30 fraction bits.
    pub(super) fn change(&self, step: &Vector) -> i64 {
        self.factor.times(product(self.axis, step))
    }

    /// The linear function with these changes per column and row, halved `halvings` times. The changes are stored in units of 2^`shift`.
    /// Their rounding has the smallest effect at the pixel `middle`.
    #[inline(never)]
    pub(super) fn words(
        &self,
        middle: &Pixel,
        changes: [i64; 2],
        shift: u32,
        halvings: u32,
    ) -> Linear {
        let lost = (halvings + shift) as i32;
        let [across, down] = changes.map(|change| saturated(rounded(change, lost), STEP));
        let changes = Linear {
            first: 0,
            across,
            down,
        };
        let there = self.change(&middle.direction) + self.offset;
        Linear {
            first: rounded(there, halvings as i32) - changes.at(middle.column, middle.row, shift),
            ..changes
        }
    }
}

/// The mantissa and the exponent of a cone's distance. The result is larger than the exact distance by a relative 2^−19, to compensate that
/// the mantissa of a reciprocal is rounded down to 18 fraction bits.
pub(super) fn distance(exact: Scaled) -> (i64, u32) {
    let exponent = (exact.log2() + 1 - DISTANCE as i32 + DISTANCE_OFFSET).clamp(0, MOST_DISTANCE);
    let mantissa = exact.fixed_at(exponent - DISTANCE_OFFSET);
    let mantissa = mantissa + (mantissa >> 19);
    (mantissa.min((1 << DISTANCE) - 1), exponent as u32)
}
