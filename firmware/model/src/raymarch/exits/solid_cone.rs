//! The cones in which an eye sees a solid cone: the cones of its base, of its lateral surface, and of its section by the near plane.
//!
//! With q from the apex to the eye, k the ratio of radius to height, and the z axis as that of the solid cone, a ray meets the double cone
//! x² + y² = k²·z² about the apex at the solutions of A·T² + 2·B·T + C = 0, where A = Dx² + Dy² − k²·Dz², B = qx·Dx + qy·Dy − k²·qz·Dz and
//! C = qx² + qy² − k²·qz². Outside of the double cone C is positive, and B² − A·C is the product of two linear functions of D, those of the
//! tangent planes through the eye: f² − a² with f = k·(qz·Dr − E·Dz) and a = √C·Dφ, where E is the eye's distance from the axis, r the
//! direction from the axis to the eye, and φ the direction around the axis. With f > 0 the ray first meets the lower half at T = C/(ρ − B),
//! where ρ² = f² − a². As for spheres, the root is in the divisor, but the divisor's addend is −B in place of f.
//!
//! An eye above the apex in the upper half sees the lower half on all sides, with no outline. There C is negative, and the ray meets the
//! lower half at T = −C/(B − ρ), where ρ² = f² + a². An eye in the lower half does not see the lateral surface. Only for an eye close to
//! the surface of the upper half are ρ and B nearly equal.
//!
//! The base is a disc, which an eye below the disc's plane sees in a cone, like the disc of a sphere in the near plane. The lateral surface
//! is in front of the plane for an eye above the plane, and behind the plane for an eye below.
//!
//! The section by the near plane consists of the points of the plane with x² + y² < k²·z², where x, y and z are again linear functions of a
//! pixel's column and row.

use glint_core::field::FixedCone;

use super::cones::{
    Cone, ConeKind, FRACTION, Function, Linear, MOST_SHIFT, MOST_SIDE, Pixel, SHARE, STEP, Sight,
    distance,
};
use super::vectors::{Scaled, Vector, bits, product, unit};

/// Number of bits of the squares of radius and height, of which only the ratio matters.
const RATIO: i32 = 36;

/// Smallest distance of an eye from the surface of the upper half, 12 fraction bits. A closer eye is moved outwards.
const BESIDE: i64 = 1 << 8;

/// The unit vectors of the axes.
const X: Vector = [1 << 30, 0, 0];
const Y: Vector = [0, 1 << 30, 0];
const UP: Vector = [0, 0, 1 << 30];
const DOWN: Vector = [0, 0, -1 << 30];

impl Sight {
    /// Computes the cones of a solid cone and passes them to `take`. `cone` has the number and the rectangle of the solid cone. `is_cut`
    /// states whether the near plane may cut the solid cone.
    // Not inlined, because few frames have a solid cone.
    #[inline(never)]
    pub(super) fn solid_cone(
        &self,
        shape: &FixedCone,
        is_cut: bool,
        cone: &mut Cone,
        take: &mut dyn FnMut(&Cone),
    ) {
        let middle = self.pixel(cone.rectangle.middle());
        let number = cone.number;
        cone.number = Cone::BASE;
        self.base(shape, cone, &middle);
        take(cone);
        cone.number = number;
        if self.lateral(shape, cone, &middle) {
            take(cone);
        }
        if is_cut {
            self.section(shape, cone, &middle);
            take(cone);
        }
        cone.kind = ConeKind::Sphere;
    }

    /// Sets the constants of the base and its plane.
    fn base(&self, shape: &FixedCone, cone: &mut Cone, middle: &Pixel) {
        let [x, y, z] = self.origin;
        let up = -shape.half - z;
        let mut to_plane = Scaled::new(up.unsigned_abs().into(), -12);
        let (axis, halvings) = if up >= 0 {
            cone.kind = ConeKind::Base;
            // Reduces the distance by a relative 2^−17, so that faces behind the plane remain behind the plane after rounding.
            to_plane = to_plane.by(Scaled::new((1 << 17) - 1, -17));
            // The point where the ray meets the plane, in radii, times D's component along z.
            let axes = [[up, 0, x], [0, up, y]];
            let inverse_radius = inverse(shape.radius.unsigned_abs().into());
            let [a, b] = axes.map(|axis| (unit(axis.map(i64::from)), length(&axis)));
            let sides = [&a, &b].map(|(axis, length)| Function {
                axis,
                factor: length.by(inverse_radius),
                offset: 0,
            });
            (UP, self.set_sides(cone, middle, &sides, true))
        } else {
            cone.kind = ConeKind::Limit;
            (cone.sides, cone.shift) = Default::default();
            (DOWN, 0)
        };
        self.set_forward(cone, middle, &axis, halvings);
        cone.share = 0;
        cone.distance = distance(to_plane.halved(halvings));
    }

    /// Sets the constants of the lateral surface. Returns `false` for an eye that does not see the surface.
    fn lateral(&self, shape: &FixedCone, cone: &mut Cone, middle: &Pixel) -> bool {
        let q = self.beside_surface(shape);
        let [x, y, z] = q.map(i64::from);
        let squares = [shape.radius, 2 * shape.half].map(|x| u64::from(x.unsigned_abs()).pow(2));
        let excess = bits(squares[0] | squares[1]) - RATIO;
        let [radius, height] = squares.map(|square| match excess < 0 {
            true => (square << -excess) as i64,
            false => (square >> excess) as i64,
        });
        // C and −B, both times `height`.
        let from_axis = x * x + y * y;
        let c = i128::from(from_axis) * i128::from(height) - i128::from(z * z) * i128::from(radius);
        let towards = [-x * height, -y * height, z * radius];
        cone.kind = match c.signum() {
            1 => ConeKind::Lateral,
            -1 if z > 0 => ConeKind::Around,
            _ => return false,
        };
        // All functions are divided by the length of the vector whose scalar product with D is −B.
        let lost = (bits(towards.iter().fold(0, |all, x| all | x.unsigned_abs())) - 31).max(0);
        let square = towards
            .map(|x| (x.unsigned_abs() >> lost).pow(2))
            .iter()
            .sum();
        let inverse_length = Scaled::inverse_root(square, 2 * lost);
        // The first 62 or 63 bits of C.
        let exponent = 66_u32.saturating_sub(c.unsigned_abs().leading_zeros()) & !1;
        let (c, exponent) = ((c.unsigned_abs() >> exponent) as u64, exponent as i32);
        let root =
            |x: u64, exponent| Scaled::new(x, exponent).by(Scaled::inverse_root(x, exponent));
        let along = length(&q)
            .by(root(squares[0], 0))
            .by(root(squares[1], 0))
            .by(Scaled::new(1, -excess))
            .by(inverse_length);
        let around = root(c, exponent)
            .by(root(height as u64, 0))
            .by(inverse_length);
        let (f, a) = match from_axis {
            0 => (X, Y),
            _ => (unit([z * x, z * y, -from_axis]), unit([-y, x, 0])),
        };
        // The number under the root is scaled up as far as its word allows within the rectangle, and the root is then divided by a power of
        // two.
        let [f, a] = [(&f, along), (&a, around)].map(|(axis, factor)| Function {
            axis,
            factor,
            offset: 0,
        });
        let forward = unit(towards);
        let doublings = if cone.kind == ConeKind::Lateral {
            let doublings = (FRACTION as i32 + 1 - bits(self.largest(cone, &f)))
                .min(STEP as i32 - bits(self.largest_change(&f)))
                .min((STEP + MOST_SHIFT) as i32 - bits(self.largest_change(&a)))
                .min(MOST_SIDE - 1 - a.factor.log2())
                .min(SHARE as i32);
            // `share`, by which the root is multiplied, is at most 1/2.
            let addend = Function {
                axis: &forward,
                factor: power(doublings.min(1) - 1),
                offset: 0,
            };
            self.set_sides(cone, middle, &[a.doubled(doublings), addend], true);
            cone.forward = self.words_of(&f.doubled(doublings), middle, 0);
            doublings
        } else {
            let doublings = FRACTION as i32 - bits(self.largest(cone, &f) | self.largest(cone, &a));
            let doublings = doublings.min(SHARE as i32);
            let sides = [a, f].map(|side| side.doubled(doublings));
            let doublings = doublings - self.set_sides(cone, middle, &sides, true) as i32;
            let away = forward.map(|part| -part);
            self.set_forward(cone, middle, &away, (1 - doublings).max(0).cast_unsigned());
            doublings
        };
        let halvings = (1 - doublings).max(0).cast_unsigned();
        cone.share = 1 << (SHARE as i32 - doublings - halvings as i32);
        let c = Scaled::new(c, exponent - 12).by(inverse_length);
        cone.distance = distance(c.halved(halvings));
        true
    }

    /// The vector from the apex to the eye. An eye that is too close to the surface of the upper half is moved outwards.
    fn beside_surface(&self, shape: &FixedCone) -> Vector {
        let [x, y, z] = self.origin;
        let q = [x, y, z - shape.half];
        let [sine, cosine] = shape.angle.map(i64::from);
        let from_axis = length(&[x, y, 0]).fixed(0);
        let beside = (from_axis * cosine - i64::from(q[2]) * sine) >> 30;
        if q[2] <= 0 || beside.abs() >= BESIDE {
            return q;
        }
        let outwards = match [x, y] {
            [0, 0] => X,
            _ => unit([x.into(), y.into(), 0]),
        };
        let way = BESIDE - beside;
        let moved = |part: i64| (((part >> 15) * way) >> 15) as i32;
        let [across, along] = [cosine, -sine].map(moved);
        let [a, b, _] = outwards.map(|part| ((i64::from(part) * i64::from(across)) >> 30) as i32);
        [q[0] + a, q[1] + b, q[2] + along]
    }

    /// Sets the constants of the section by the near plane.
    fn section(&self, shape: &FixedCone, cone: &mut Cone, middle: &Pixel) {
        let [x, y, z] = self.origin;
        let z = z - shape.half;
        let near = self.near.fixed(12).unsigned_abs();
        let [radius, height] = [shape.radius, 2 * shape.half].map(|x| u64::from(x.unsigned_abs()));
        // Scales radius and height so that the values of all functions are below 1.
        let most = |sum: u32| u64::from(sum) + 4 * near;
        let sum =
            height * most(x.unsigned_abs() + y.unsigned_abs()) + radius * most(z.unsigned_abs());
        let [radius, height] = [radius, height].map(|x| Scaled::new(x, 12).by(inverse(sum)));
        let function = |axis, scale: Scaled, offset: i32| {
            let offset_size = Scaled::new(offset.unsigned_abs().into(), -12).by(scale);
            Function {
                axis,
                factor: scale.by(self.near),
                offset: offset_size.fixed(FRACTION) * i64::from(offset.signum()),
            }
        };
        let sides = [function(&X, height, x), function(&Y, height, y)];
        let halvings = self.set_sides(cone, middle, &sides, true);
        cone.kind = ConeKind::Section;
        cone.forward = self.words_of(&function(&DOWN, radius, -z), middle, halvings);
        cone.share = 0;
        cone.distance = (0, 0);
    }

    /// Sets the function `forward` to the scalar product of D and a unit vector.
    fn set_forward(&self, cone: &mut Cone, middle: &Pixel, axis: &Vector, halvings: u32) {
        let one = Function {
            axis,
            factor: Scaled::ONE,
            offset: 0,
        };
        cone.forward = self.words_of(&one, middle, halvings);
    }

    fn words_of(&self, function: &Function, middle: &Pixel, halvings: u32) -> Linear {
        let [_, step, down] = &self.directions;
        let changes = [function.change(step), function.change(down)];
        let words = function.words(middle, changes, 0, halvings);
        Linear {
            first: i64::from(words.first as i32),
            ..words
        }
    }

    /// The bitwise OR of a function's magnitudes in the corners of a cone's rectangle, which has as many bits as the largest magnitude; 30
    /// fraction bits.
    fn largest(&self, cone: &Cone, function: &Function) -> u64 {
        let [columns, rows] = [cone.rectangle.columns, cone.rectangle.rows];
        let corners = [0, 1, 2, 3].map(|i: usize| self.pixel([columns[i % 2], rows[i / 2]]));
        corners.iter().fold(0, |all, pixel| {
            all | function.change(&pixel.direction).unsigned_abs()
        })
    }

    /// The bitwise OR of the magnitudes of a function's changes per column and row, 30 fraction bits.
    fn largest_change(&self, function: &Function) -> u64 {
        let [_, step, down] = &self.directions;
        function.change(step).unsigned_abs() | function.change(down).unsigned_abs()
    }
}

impl Function<'_> {
    /// The function times a power of two.
    fn doubled(&self, times: i32) -> Self {
        Self {
            factor: self.factor.by(power(times)),
            ..*self
        }
    }
}

/// 2^`exponent`.
const fn power(exponent: i32) -> Scaled {
    Scaled::new(1, exponent)
}

/// The length of a vector; 0 for the zero vector.
fn length(vector: &Vector) -> Scaled {
    match product(vector, vector).cast_unsigned() {
        0 => Scaled::new(0, 0),
        square => Scaled::new(square, 0).by(Scaled::inverse_root(square, 0)),
    }
}

/// The reciprocal of x, which must be at least 1.
fn inverse(x: u64) -> Scaled {
    let root = Scaled::inverse_root(x, 0);
    root.by(root)
}
