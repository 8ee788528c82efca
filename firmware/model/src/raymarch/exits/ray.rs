//! The ray of a pixel, its points and its exits.

use glint_core::field::{FRACTION, magnitude};

use super::intervals::{AXES, Exit, Prism, Rule, Solid};
use super::narrow::{floor, nearest, squared};
use super::setup::Exits;
use super::words::Inverse;

/// A ray before its first evaluation. The axes are those of the solid: x, y and z, or the four diagonals of an octahedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beam {
    /// Number of the eye: 0 for the left or only eye, 1 for the right eye.
    pub eye: usize,
    /// Column of the pixel.
    pub column: u32,
    /// Row of the pixel.
    pub row: u32,
    /// Whether the ray points down along each axis; the axis is then mirrored.
    pub down: [bool; AXES],
    /// Magnitude of the direction's component along each axis, u0.28. The component is truncated, and the magnitude is the middle of the
    /// truncation interval, an odd number.
    pub speed: [u32; AXES],
    /// Reciprocals of `speed`.
    pub inverse: [Inverse; AXES],
    /// The number of doublings, 0 to 3, that brings the direction's length to between 1 and 2.
    pub doublings: u32,
    /// D's components along x, y and z, s1.10, rounded down; halved for an octahedron.
    pub heading: [i32; 3],
    /// The square of the doubled direction's length, u2.23, rounded down.
    pub square: i64,
    /// The reciprocal of `square`, times 2^`doublings`.
    pub inverse_square: Inverse,
    /// Where the ray leaves the empty prism around the eye.
    pub start: Way,
    /// Whether the ray points away from the flat solid.
    pub is_away: bool,
}

/// A point on a ray's path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    /// The parameter T, with 14 integer bits and `Words::parameter` fraction bits.
    pub t: i64,
    /// The axis of the last crossed border.
    pub face: usize,
    /// The interval that the ray has reached along each axis; the lowest number if no border along the axis has been crossed.
    pub reached: [i32; AXES],
}

impl Beam {
    /// The direction D, s1.17, rounded down, for a solid whose axes are x, y and z.
    pub fn direction(&self) -> [i32; 3] {
        [0, 1, 2].map(|axis: usize| {
            let size = (self.speed[axis] >> 11) as i32;
            if self.down[axis] { !size } else { size }
        })
    }

    /// Height of the direction ([`RayEnd::height`](crate::raymarch::RayEnd::height)): the first ten bits of the component along z, divided
    /// by the first ten bits of the largest component plus 1.
    pub fn height(&self) -> u8 {
        let [x, y, z] = self.heading.map(magnitude);
        match self.heading[2] < 0 {
            true => 0,
            false => ((z << 8) / (x.max(y).max(z) + 1)) as u8,
        }
    }
}

impl Way {
    /// Whether the ray can meet the solid no more: it is above the solid along an axis, or beyond `limit`.
    pub(super) fn has_left(&self, solid: &Solid, limit: i64) -> bool {
        self.t > limit || (0..AXES).any(|axis| solid.is_above(axis, self.reached[axis]))
    }
}

impl Exits {
    /// The ray of pixel (x, y) for an eye.
    pub fn ray(&self, eye: usize, column: u32, row: u32) -> Beam {
        // The direction D, s1.27, rounded down. A component k represents the middle of its truncation interval, k + 1/2, so the magnitude
        // of a negative component is the component's bitwise complement. A component wraps only for invalid frame constants.
        let [x, y, z] = self.direction(eye, column, row).map(|part| part << 1 >> 4);
        // The component along the fourth diagonal of an octahedron is the sum of the three other components. The sum of three middles k +
        // 1/2 is again the middle of an interval. The sum of the components along two diagonals is half the component along x, y or z.
        let first @ [a, b, c] = [x, y, z].map(|part| part >> 17);
        let (fourth, heading) = match self.octahedron() {
            Some(_) => ((x + y + z + 1) << 4 >> 4, [b + c, a + c, a + b]),
            None => (0, first),
        };
        let direction = [x, y, z, fourth];
        let down = direction.map(|part| part < 0);
        let speed = direction.map(|part| 2 * magnitude(part) + 1);
        // The squares of the highest 23 bits, minus the square of the lowest 6 of these bits.
        let [x, y, z, _] = speed.map(|speed| squared(i64::from(speed >> 5), 6));
        let square = x + y + z;
        // No camera has a direction shorter than 1/8.
        let doublings = (0..3).find(|&doublings| square >> (46 - 2 * doublings) != 0);
        let doublings = doublings.unwrap_or(3);
        let square = square >> (23 - 2 * doublings);
        // `Inverse::of` requires a number below 1, which a quarter of the square is.
        let quarter = Inverse::of((square as u32) << 3, &self.words);
        let beam = Beam {
            eye,
            column,
            row,
            down,
            speed,
            inverse: speed.map(|speed| Inverse::of(self.words.component_of(speed), &self.words)),
            heading,
            doublings,
            square,
            inverse_square: Inverse {
                exponent: quarter.exponent + doublings as i32 - 2,
                ..quarter
            },
            // A ray that starts in the solid hits a face perpendicular to the z axis.
            start: Way {
                t: self.near,
                face: 2,
                // A lane needs no border of an octahedron's fourth slab, so no ray is below the slab.
                reached: [i32::MIN, i32::MIN, i32::MIN, 0],
            },
            is_away: false,
        };
        let start = &self.eyes[eye].start;
        let sides = [0, 1, 2, 3].map(|axis: usize| &start.sides[usize::from(down[axis])][axis]);
        let borders = sides.map(|side| side.is_bounded.then_some((side.distance, side.next)));
        Beam {
            start: self.leave(&beam, &beam.start, start.exit, &borders),
            is_away: sides.iter().any(|side| side.is_away),
            ..beam
        }
    }

    /// Whether a ray ends without an evaluation, because it cannot hit the flat solid up to the parameter `limit`.
    pub fn ends_at_start(&self, beam: &Beam, limit: i64) -> bool {
        let has_left = |solid: &Solid| beam.start.has_left(solid, limit);
        beam.is_away || self.solid.as_ref().is_none_or(has_left)
    }

    /// The point where a ray with its origin at `corner` leaves the prism that contains the point `way`.
    pub(super) fn left(&self, beam: &Beam, corner: &[i64; AXES], way: &Way, prism: &Prism) -> Way {
        let borders = [0, 1, 2, 3].map(|axis: usize| {
            let border = prism.borders[axis]?;
            Some((border.at - corner[axis], border.next))
        });
        self.leave(beam, way, prism.exit, &borders)
    }

    /// The point where a ray leaves the prism that contains the point `way`. `borders` has, for each border of the prism, the distance from
    /// the eye to the border and the interval beyond the border.
    fn leave(
        &self,
        beam: &Beam,
        way: &Way,
        exit: Exit,
        borders: &[Option<(i64, i32)>; AXES],
    ) -> Way {
        let exits = [0, 1, 2, 3].map(|axis: usize| {
            let (distance, _) = borders[axis]?;
            Some(self.words.divided(distance, FRACTION, beam.inverse[axis]))
        });
        let (face, crossed) = exit.leaving(&exits);
        let reached = [0, 1, 2, 3].map(|axis: usize| match borders[axis] {
            Some((_, next)) if crossed[axis] => next,
            _ => way.reached[axis],
        });
        Way {
            t: way.t.max(exits[face].unwrap_or_default()),
            face,
            reached,
        }
    }

    /// The magnitude of a direction's component for the product T·D. The magnitude is truncated to `Words::direction` fraction bits; the
    /// result is the middle of the truncation interval, with one more fraction bit.
    pub(super) fn speed(&self, beam: &Beam, axis: usize) -> i64 {
        let cut = 27 - self.words.direction;
        i64::from((beam.speed[axis] >> 1 >> cut) << 1 | 1)
    }

    /// The point of a ray at the parameter `t`, relative to the solid's lower corner, along mirrored axes, s15.12. It is rounded down, or
    /// to nearest in a lattice. `corner` is the ray's origin in the same coordinates, s13.12.
    pub(super) fn point(&self, beam: &Beam, corner: &[i64; AXES], t: i64) -> [i64; AXES] {
        let bits = (self.words.parameter + self.words.direction + 1) as i32 - 12;
        let is_lattice = (self.solid).is_some_and(|solid| solid.rule.is_lattice());
        let [x, y, z] = [0, 1, 2].map(|axis: usize| {
            let way = t * self.speed(beam, axis);
            corner[axis]
                + match is_lattice {
                    true => nearest(way, bits),
                    false => floor(way, bits),
                }
        });
        [x, y, z, self.fourth(beam, [x, y, z])]
    }

    /// The coordinate of a point along the fourth diagonal of an octahedron, computed from the three other coordinates; 0 for other solids.
    /// Each coordinate is relative to the solid's lower corner, along a mirrored axis, and represents the middle of its truncation
    /// interval.
    fn fourth(&self, beam: &Beam, point: [i64; 3]) -> i64 {
        let Some(solid) = self.octahedron() else {
            return 0;
        };
        let half = solid.side[0] / 2;
        let mirrored = |axis: usize, x: i64| if beam.down[axis] { !x } else { x };
        let parts = [0, 1, 2].map(|axis: usize| mirrored(axis, point[axis] - half));
        mirrored(3, parts.iter().sum::<i64>() + 1) + half
    }

    /// The solid if it is an octahedron, otherwise `None`.
    fn octahedron(&self) -> Option<Solid> {
        self.solid.filter(|solid| solid.rule == Rule::Octahedron)
    }
}
