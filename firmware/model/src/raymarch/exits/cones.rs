//! Spheres of a list, and the cones in which an eye sees them.
//!
//! An eye outside of a sphere sees it in a cone. With q from the centre to the eye, the unit vector c towards the centre, and the unit
//! vectors a and b perpendicular to c and to each other, a ray with the direction D meets the sphere of the radius r if
//! (c·D)² > κ²·((a·D)² + (b·D)²) and c·D > 0, where κ² = |q|²/r² − 1. With ρ² the difference of the two sides, it meets it at
//! T = (|q|² − r²)/|q| / (c·D + (r/|q|)·ρ). This form of the quadratic equation's solution has no difference of nearly equal numbers.
//!
//! A sphere that the near plane cuts shows a disc there. The rays through a disc are a cone too, with 1 in place of c·D, and the share 0 in
//! place of r/|q|: its T is constant.
//!
//! All of these are linear in a pixel's column and row. The vector b is perpendicular to the direction's change per column, so that b·D
//! depends on the row only.

use glint_core::feature::SPHERES;
use glint_core::field::{FixedSphere, MAX_SPHERES};

use super::narrow::{nearest, saturated};
use super::rectangle::Rectangle;
use super::vectors::{Scaled, Vector, across, dot, unit};

/// Bits of the magnitude of a change per column or row.
const STEP: u32 = 24;
/// Fraction bits of the linear functions.
pub(super) const FRACTION: u32 = 30;
/// Largest shift of the changes of a cone's sides.
const MOST_SHIFT: u32 = 6;
/// Exponent of the largest factor of a side, and of the largest distance of a disc from the ray's axis in radii.
const MOST_SIDE: i32 = 12;
/// Largest number of halvings. Only a sphere that is far smaller than a pixel would need more.
const MOST_HALVINGS: i32 = 20;
/// Fraction bits of the ratio of the radius to the distance of the centre.
pub(super) const SHARE: u32 = 17;
/// Bits of the mantissa of a cone's distance.
const DISTANCE: u32 = 24;
/// A cone's distance is the mantissa times 2 to the exponent less this number.
pub(super) const DISTANCE_OFFSET: i32 = 24;
/// Exponents of a cone's distance: 0 to this number.
const MOST_DISTANCE: i32 = 15;

/// Largest number of cones: two for each sphere.
const MAX_CONES: usize = if SPHERES.is_built { 2 * MAX_SPHERES } else { 0 };

/// The cones in which an eye sees the spheres of a list, in the order of the list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cones {
    list: [Cone; MAX_CONES],
    count: usize,
}

impl Cones {
    /// The cones.
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
    /// Number of the sphere.
    pub number: u8,
    /// The pixels that may see the sphere.
    pub rectangle: Rectangle,
    /// c·D, 1 for a disc.
    pub forward: Linear,
    /// κ·(a·D) and κ·(b·D); of a disc, its centre's distances from the ray along a and b, in radii.
    pub sides: [Linear; 2],
    /// Exponent of 2 by which the changes of `sides` are multiplied: 0, 2, 4 or 6.
    pub shift: u32,
    /// r/|q|, u0.17; 0 for a disc.
    pub share: i64,
    /// (|q|² − r²)/|q| in field units, T of the near plane for a disc: a mantissa of 24 bits and an exponent from 0 to 15, which counts
    /// from −24.
    pub distance: (i64, u32),
}

/// A number that is linear in the column and the row of a pixel, with 30 fraction bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Linear {
    /// The number of the first pixel, s15.30.
    pub first: i64,
    /// Change per column, of 24 bits and a sign.
    pub across: i64,
    /// Change per row, of 24 bits and a sign.
    pub down: i64,
}

impl Linear {
    /// The number of a pixel, with the changes multiplied by 2^`shift`.
    pub(super) const fn at(&self, column: u32, row: u32, shift: u32) -> i64 {
        self.first + ((column as i64 * self.across + row as i64 * self.down) << shift)
    }
}

/// What an eye sees.
pub(super) struct Sight {
    /// Position in field units, s13.12.
    origin: [i32; 3],
    /// Direction D of the first ray, and its changes per column and row, s2.30.
    directions: [Vector; 3],
    /// The parameter T of the near plane, u14.14, slightly behind it: a sphere's hit that is rounded to before the plane is in the disc.
    near: i64,
    /// T for the hits in a disc: that of the near plane, or larger by at most 2^−16.
    disc: Scaled,
    /// The near plane's normal, and two axes in it; the second is perpendicular to the change per column.
    plane: [Vector; 3],
    /// The first ray's point in the near plane, from the eye, with 16 fraction bits.
    point: Vector,
}

impl Sight {
    /// What an eye at `origin` sees, with the near plane at the parameter `near`, u14.14.
    pub(super) fn new(origin: [i32; 3], directions: [Vector; 3], near: i64) -> Self {
        let [first, step, down] = directions;
        // A picture of a single ray has no such axes.
        let normal = match across(step, down) {
            [0, 0, 0] => unit(first),
            normal => unit(normal),
        };
        let a = match step {
            [0, 0, 0] => unit(across(normal, smallest_axis(normal))),
            step => unit(step),
        };
        let b = unit(across(normal, a));
        let behind = near + (near >> 16);
        let margin = Scaled::new((1 << 17) + 1, -17);
        Self {
            origin,
            directions,
            near: behind,
            disc: Scaled::new(near, -14).by(margin),
            plane: [normal, a, b],
            point: first.map(|part| nearest(behind * part, 28)),
        }
    }

    /// Computes the cones of a sphere, each of which a pixel sees only in a rectangle.
    pub(super) fn cones(
        &self,
        number: u8,
        sphere: &FixedSphere,
        rectangle: Rectangle,
        take: &mut dyn FnMut(Cone),
    ) {
        if rectangle.is_empty() {
            return;
        }
        let cones = [
            self.outline(sphere, &rectangle),
            self.disc(sphere, &rectangle),
        ];
        for cone in cones.into_iter().flatten() {
            take(Cone {
                number,
                rectangle,
                ..cone
            });
        }
    }

    /// The vector from a sphere's centre to the eye.
    fn place(&self, sphere: &FixedSphere) -> Vector {
        [0, 1, 2].map(|i: usize| i64::from(self.origin[i]) - i64::from(sphere.centre[i]))
    }

    /// The cone around a sphere; `None` for an eye inside.
    fn outline(&self, sphere: &FixedSphere, rectangle: &Rectangle) -> Option<Cone> {
        let q = self.place(sphere);
        let radius = i64::from(sphere.radius.max(1));
        let beyond = dot(q, q) - radius * radius;
        if beyond < 0 {
            return None;
        }
        let [_, step, _] = self.directions;
        let forward = unit(q.map(|part| -part));
        let side = match across(forward, step) {
            // The direction does not change in the row, or it changes towards the centre.
            [0, 0, 0] => across(forward, smallest_axis(forward)),
            side => side,
        };
        let b = unit(side);
        let a = unit(across(b, forward));
        let length = Scaled::root(dot(q, q), -24);
        let radius = Scaled::new(radius, -12);
        let factor = Scaled::root(beyond, -24).over(radius);
        let (cone, halvings) = self.cone(rectangle, [a, b], factor, [0, 0]);
        let one = Scaled::ONE.halved(halvings);
        Some(Cone {
            forward: self.linear(rectangle, forward, one, 0, 0),
            share: radius.over(length).fixed(SHARE).min((1 << SHARE) - 1),
            distance: distance(Scaled::new(beyond, -24).over(length).halved(halvings)),
            ..cone
        })
    }

    /// The disc that is the part of a sphere in the near plane; `None` if the plane does not cut the sphere.
    fn disc(&self, sphere: &FixedSphere, rectangle: &Rectangle) -> Option<Cone> {
        let [normal, a, b] = self.plane;
        // From the centre to the eye, and to the first ray's point in the plane, with 16 fraction bits.
        let q = self.place(sphere).map(|part| part << 4);
        let point = [0, 1, 2].map(|i: usize| q[i] + self.point[i]);
        let radius = i64::from(sphere.radius) << 4;
        let depth = along(point, normal);
        if depth.abs() >= radius {
            return None;
        }
        let radius = Scaled::root(radius * radius - depth * depth, -32);
        // From the centre to the eye, along a and b, in radii of the disc.
        let offsets = [a, b].map(|axis| {
            let offset = along(q, axis);
            let size = Scaled::new(offset.abs(), -16).over(radius);
            size.fixed(FRACTION) * offset.signum()
        });
        let factor = Scaled::new(self.near, -14).over(radius);
        let (cone, halvings) = self.cone(rectangle, [a, b], factor, offsets);
        let forward = Linear {
            first: 1 << (FRACTION - halvings),
            ..Linear::default()
        };
        // All rays have one divisor, 2^22 and a half if there are no halvings.
        let divisor = Scaled::new((1 << (23 - halvings)) + 1, -23);
        Some(Cone {
            forward,
            distance: distance(self.disc.by(divisor)),
            ..cone
        })
    }

    /// A cone with the sides `factor`·(axis·D) + offset, and the number of halvings that make their words fit.
    fn cone(
        &self,
        rectangle: &Rectangle,
        axes: [Vector; 2],
        factor: Scaled,
        offsets: [i64; 2],
    ) -> (Cone, u32) {
        let [_, step, down] = self.directions;
        let steps = axes.map(|axis| [step, down].map(|step| factor.times(dot(axis, step)).abs()));
        let most = steps.as_flattened().iter().fold(0, |all, step| all | step);
        let excess = (64 - most.leading_zeros()).saturating_sub(STEP);
        let shift = excess.next_multiple_of(2).min(MOST_SHIFT);
        let largest = offsets.iter().fold(1, |all, offset| all | offset.abs());
        let side = factor.log2().max(largest.ilog2() as i32 - FRACTION as i32);
        let halvings = (excess.saturating_sub(MOST_SHIFT) as i32)
            .max(side + 1 - MOST_SIDE)
            .clamp(0, MOST_HALVINGS) as u32;
        let factor = factor.halved(halvings);
        let side = |i: usize| {
            let offset = nearest(offsets[i], halvings as i32);
            self.linear(rectangle, axes[i], factor, offset, shift)
        };
        let [a, b] = [side(0), side(1)];
        let cone = Cone {
            // The second axis is perpendicular to the change per column.
            sides: [a, Linear { across: 0, ..b }],
            shift,
            ..Cone::default()
        };
        (cone, halvings)
    }

    /// `factor`·(axis·D) + offset, with changes in units of 2^`shift`. Rounding of the changes has the smallest effect in the middle of the
    /// rectangle.
    fn linear(
        &self,
        rectangle: &Rectangle,
        axis: Vector,
        factor: Scaled,
        offset: i64,
        shift: u32,
    ) -> Linear {
        let [first, step, down] = self.directions;
        let [column, row] = rectangle.middle().map(i64::from);
        let middle = [0, 1, 2].map(|i: usize| first[i] + column * step[i] + row * down[i]);
        let change = |step| saturated(nearest(factor.times(dot(axis, step)), shift as i32), STEP);
        let mut linear = Linear {
            first: 0,
            across: change(step),
            down: change(down),
        };
        let [column, row] = rectangle.middle();
        linear.first = factor.times(dot(axis, middle)) + offset - linear.at(column, row, shift);
        linear
    }
}

/// The mantissa and the exponent of a cone's distance. It is larger than the exact one by 2^−19, because the mantissa of a reciprocal is
/// rounded down to 18 fraction bits.
fn distance(exact: Scaled) -> (i64, u32) {
    let exponent = (exact.log2() + 1 - DISTANCE as i32 + DISTANCE_OFFSET).clamp(0, MOST_DISTANCE);
    let mantissa = exact.fixed_at(exponent - DISTANCE_OFFSET);
    let mantissa = mantissa + (mantissa >> 19);
    (mantissa.min((1 << DISTANCE) - 1), exponent as u32)
}

/// The axis along which a vector is shortest.
fn smallest_axis(vector: Vector) -> Vector {
    let sizes = vector.map(i64::abs);
    let axis = (0..3).min_by_key(|&i| sizes[i]).unwrap_or_default();
    [0, 1, 2].map(|i: usize| i64::from(i == axis))
}

/// The component of a vector along a unit vector.
fn along(vector: Vector, axis: Vector) -> i64 {
    nearest(dot(vector, axis), 30)
}
