//! The projection of moved segments to the screen.
//!
//! A point P is projected from the eye E to the view plane z = a: x' = Ex − (Ez − a)·(Ex − x)/(Ez − z), and y' by the same
//! formula. The window then fills the picture. Projection and scaling together need one quotient for each axis of the
//! screen, with 8 fraction bits:
//!
//! ```text
//! right = 256·W·((Ex − xl)·(Ez − z) − (Ez − a)·(Ex − x)) / ((xh − xl)·(Ez − z))
//! down  = 256·H·((yh − Ey)·(Ez − z) + (Ez − a)·(Ey − y)) / ((yh − yl)·(Ez − z))
//! ```
//!
//! A segment is first clipped at z = a, so z ≤ a < Ez: the divisor is positive, and z = Ez cannot occur.

use super::program::Viewing;
use crate::division::quotient;
use crate::fixed::{Q5_11, Q12_20};
use crate::picture::Window;

/// A line on the screen: the distances of its two ends from the left and the top border, in units of 2^−8 pixels, within
/// ±[`GUARD`].
pub type ScreenLine = [[i32; 2]; 2];

/// The guard band: the largest distance of an end from the top left corner, 2047 pixels in units of 2^−8 pixels.
pub const GUARD: i32 = 2047 << 8;

/// A coordinate with 20 fraction bits.
type Moved = [Q12_20; 3];

/// The constants for projection in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projection {
    /// The eye, with 20 fraction bits.
    eye: [i64; 3],
    /// The view plane, with 20 fraction bits.
    plane: i64,
    /// Ez − a, with 11 fraction bits, positive.
    depth: i64,
    /// The two axes of the screen: to the right, and down.
    axes: [Axis; 2],
}

/// Constants of one axis of the screen. Lengths have 11 fraction bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Axis {
    /// Distance along the axis from the window's side at screen coordinate 0 to the eye.
    offset: i64,
    /// Extent of the window, positive.
    span: i64,
    /// Extent of the picture in units of 2^−8 pixels. The extent is negative for the downward axis, which is opposite to the
    /// world's y axis.
    extent: i64,
    /// Beginning of the drawn part of the picture, in units of 2^−8 pixels.
    origin: i64,
}

impl Projection {
    /// Makes the projection from a program's viewing parameters to a picture, or to a part of a picture.
    pub fn new(viewing: &Viewing, window: impl Into<Window>) -> Self {
        let window = window.into();
        let bits = |x: Q5_11| i64::from(x.to_bits());
        let [ex, ey, ez] = viewing.eye.map(bits);
        let [xl, yl] = viewing.window.low.map(bits);
        let [xh, yh] = viewing.window.high.map(bits);
        let plane = bits(viewing.plane);
        let fine = |pixels: [u32; 2]| pixels.map(|pixels| i64::from(pixels) << 8);
        let ([width, height], [left, top]) = (fine(window.picture()), fine(window.origin()));
        Self {
            eye: [ex, ey, ez].map(|x| x << 9),
            plane: plane << 9,
            depth: ez - plane,
            axes: [
                Axis {
                    offset: ex - xl,
                    span: xh - xl,
                    extent: width,
                    origin: left,
                },
                Axis {
                    offset: ey - yh,
                    span: yh - yl,
                    extent: -height,
                    origin: top,
                },
            ],
        }
    }

    /// Projects a moved segment, whose coordinates are within ±56. `None` if no part of the segment is behind the view plane and
    /// within the guard band.
    ///
    /// The part in front of the view plane is cut off; the cut point is rounded to nearest with 20 fraction bits. A part beyond
    /// the guard band is cut off exactly. Each end is then rounded once, to nearest, half units up.
    pub fn line(&self, segment: [Moved; 2]) -> Option<ScreenLine> {
        let [a, b] = self.behind(segment.map(|point| point.map(|x| i64::from(x.to_bits()))))?;
        let (a, b) = (self.fractions(a), self.fractions(b));
        Some([end(a, b)?, end(b, a)?])
    }

    /// Clips a segment to the half space z ≤ a.
    fn behind(&self, [a, b]: [[i64; 3]; 2]) -> Option<[[i64; 3]; 2]> {
        let above = |[_, _, z]: [i64; 3]| z - self.plane;
        match (above(a) > 0, above(b) > 0) {
            (true, true) => None,
            (false, false) => Some([a, b]),
            (false, true) => Some([a, self.cut(a, b)]),
            (true, false) => Some([self.cut(b, a), b]),
        }
    }

    /// Computes the point at which a segment from a point behind the view plane to a point in front of it crosses the plane.
    fn cut(&self, [x, y, z]: [i64; 3], [x2, y2, z2]: [i64; 3]) -> [i64; 3] {
        // All differences are below 2^27.
        let along = |from, to| from + nearest((to - from) * (self.plane - z), z2 - z);
        [along(x, x2), along(y, y2), self.plane]
    }

    /// Computes the two screen coordinates, as quotients, of a point behind the view plane.
    ///
    /// With coordinates within ±56 and Q5.11 constants, each difference is below 2^16 units of 2^−11 or 72·2^20 units of 2^−20.
    /// Therefore a denominator is below 2^42.2, and a numerator below 2^62.5 for a picture 2560 pixels wide, or below 2^62.9 for a part
    /// of it.
    fn fractions(&self, point: [i64; 3]) -> [Fraction; 2] {
        let ([x, y, z], [ex, ey, ez]) = (point, self.eye);
        let distance = ez - z;
        let [right, down] = self.axes;
        [(right, ex - x), (down, ey - y)].map(|(axis, beside)| {
            let denominator = axis.span * distance;
            let from_picture = axis.extent * (axis.offset * distance - self.depth * beside);
            Fraction {
                numerator: from_picture - axis.origin * denominator,
                denominator,
            }
        })
    }
}

/// A quotient with a positive denominator: a distance in units of 2^−8 pixels. Numerator and denominator are linear in the point.
#[derive(Clone, Copy, Debug)]
struct Fraction {
    numerator: i64,
    denominator: i64,
}

impl Fraction {
    /// Whether the distance is within the guard band.
    const fn is_inside(self) -> bool {
        self.numerator.unsigned_abs() <= (GUARD as i64 * self.denominator).cast_unsigned()
    }

    /// The distances from both sides of the guard band, times the denominator; negative outside.
    fn to_sides(self) -> [i128; 2] {
        let guard = i128::from(GUARD) * i128::from(self.denominator);
        [1, -1].map(|sign| guard + sign * i128::from(self.numerator))
    }

    /// Computes the quotient, rounded to nearest, of a fraction within the guard band.
    fn value(self) -> i32 {
        // The quotient is within ±GUARD, so it fits.
        nearest(self.numerator, self.denominator) as i32
    }
}

/// Clips the segment's end `a` to the guard band: returns `a`, or the point at which the segment enters the guard band. `None` if
/// the whole segment is outside.
// Neither this function nor `enter` is inlined, so that the code that draws a line occupies few lines of the instruction cache.
#[inline(never)]
fn end(a: [Fraction; 2], b: [Fraction; 2]) -> Option<[i32; 2]> {
    if a.iter().all(|axis| axis.is_inside()) {
        return Some(a.map(Fraction::value));
    }
    enter(a, b)
}

/// Returns the point at which the segment from an end `a` outside of the guard band enters the guard band; `None` if the whole segment
/// is outside.
///
/// For each side of the guard band between `a` and `b`, the position of the crossing on the other axis is exact. The crossing
/// that lies within the guard band becomes the end, and is then rounded.
#[inline(never)]
fn enter([ax, ay]: [Fraction; 2], [bx, by]: [Fraction; 2]) -> Option<[i32; 2]> {
    for (axis, (from, to), other) in [(0, (ax, bx), (ay, by)), (1, (ay, by), (ax, bx))] {
        for (side, (&out, &within)) in [-GUARD, GUARD]
            .iter()
            .zip(from.to_sides().iter().zip(&to.to_sides()))
        {
            if out >= 0 || within < 0 {
                continue;
            }
            let Some(across) = crossing(other, within, out) else {
                continue;
            };
            return Some(if axis == 0 {
                [*side, across]
            } else {
                [across, *side]
            });
        }
    }
    None
}

/// Computes the position on one axis, rounded to nearest, at which a segment from `a` to `b` crosses a plane, from the ends'
/// distances to the plane: `out` < 0 at `a` and `within` ≥ 0 at `b`. `None` outside the guard band.
fn crossing((a, b): (Fraction, Fraction), within: i128, out: i128) -> Option<i32> {
    // The point is (a·within − b·out)/(within − out). The common divisor cancels; both sums are below 2^126.9.
    let blend = |a: i64, b: i64| i128::from(a) * within - i128::from(b) * out;
    let numerator = blend(a.numerator, b.numerator);
    let denominator = blend(a.denominator, b.denominator);
    let guard = i128::from(GUARD) * denominator;
    (-guard..=guard).contains(&numerator).then(|| {
        let quotient = numerator.div_euclid(denominator);
        let rest = numerator.rem_euclid(denominator);
        (quotient + i128::from(2 * rest >= denominator)) as i32
    })
}

/// Divides by a positive number and rounds to nearest, half units up, even for negative quotients.
fn nearest(numerator: i64, denominator: i64) -> i64 {
    let (size, divisor) = (numerator.unsigned_abs(), denominator.cast_unsigned());
    let quotient = quotient(size, divisor);
    let rest = size - quotient * divisor;
    if numerator < 0 {
        -(quotient + u64::from(rest > divisor - rest)).cast_signed()
    } else {
        (quotient + u64::from(rest >= divisor - rest)).cast_signed()
    }
}
