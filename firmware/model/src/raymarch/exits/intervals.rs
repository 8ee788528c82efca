//! Solids as rules about the intervals of a point along three axes.
//!
//! Coordinates are relative to the solid's lower corner, along axes that are mirrored so that every ray points up. The coordinates of a
//! bounded solid are between 0 and the solid's side. Interval numbers increase along every axis.

use core::ops::Range;

use glint_core::field::{FRACTION, Surface};

/// Number of axes: three, and a fourth for the fourth pair of faces of an octahedron.
pub const AXES: usize = 4;

/// Exponent of the period of a repeated solid, 64 field units with 12 fraction bits.
pub(super) const PERIOD: u32 = 18;

/// The first cell beyond a repeated solid, at 2^11 field units.
const LAST_CELL: i64 = 32;

/// A rule that decides from the intervals of a point whether the point is in a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rule {
    /// The inside of a box. Interval numbers: −1 below the box, 0 inside, 1 above.
    #[default]
    Box,
    /// The outside of a slab between two planes perpendicular to z. Interval numbers as for a box.
    Planes,
    /// The Menger sponge. Interval numbers: −1 below the sponge, then the numbers of the smallest cells, from 0.
    Sponge {
        /// Number of the smallest cells along an axis: 3^4 or 3^6.
        cells: i32,
        /// Side of the last level's cells, in units of the smallest cells.
        last: i32,
        /// Exponent of the side of a smallest cell, with 12 fraction bits.
        exponent: u32,
    },
    /// Boxes, or spheres in cubes, in every cell of a lattice. Interval numbers: 2·cell in a box, 2·cell + 1 in the gap above the box. An
    /// axis along which the side of a box equals the period has no gaps. The solid ends before cell `LAST_CELL`.
    Repeated {
        /// Whether each box is replaced by a sphere with the box's side as diameter.
        round: bool,
    },
    /// The octahedron: the intersection of four slabs perpendicular to its diagonals, with the interval numbers of a box. An octahedron is
    /// convex: a ray that has left the prism around the eye is not below any slab, so a lane does not need the border of the fourth slab.
    Octahedron,
}

impl Rule {
    /// The sponge with this number of levels, at most 6. The side of the smallest cells is a power of two: 1 field unit, or 1/8 field unit
    /// in a sponge of more than four levels.
    pub const fn sponge(levels: u32) -> Self {
        let (cells, exponent) = match levels {
            ..=4 => (81, FRACTION),
            _ => (729, FRACTION - 3),
        };
        Self::Sponge {
            cells,
            last: cells / 3_i32.pow(if levels < 6 { levels } else { 6 }),
            exponent,
        }
    }

    /// Whether the solid consists of spheres.
    pub const fn is_lattice(&self) -> bool {
        matches!(self, Self::Repeated { round: true })
    }

    /// Whether the solid casts shadows on its own faces. Boxes and octahedra do not, because they are convex, and planes do not, because no
    /// light enters the room between them. Shadows of spheres are not drawn.
    pub const fn has_shadows(&self) -> bool {
        matches!(self, Self::Sponge { .. } | Self::Repeated { round: false })
    }

    /// Number of levels of a sponge. The value 1 tells the gateware that repeated cubes are spheres, or that a box is an octahedron; other
    /// solids have the value 0.
    pub const fn levels(&self) -> u32 {
        match *self {
            Self::Octahedron => 1,
            Self::Repeated { round } => round as u32,
            Self::Sponge { cells, last, .. } if last > 0 => (cells / last).ilog(3),
            _ => 0,
        }
    }
}

/// A solid, for one frame. The default is an empty box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Solid {
    /// The rule that maps the intervals of a point to the solid or an empty prism.
    pub rule: Rule,
    /// Side length of the solid along each axis, u12.12; for a repeated solid, the side length of a box.
    pub side: [i64; AXES],
}

/// Where a point is, relative to a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The point is in the solid.
    Solid,
    /// The point is above the solid along an axis, so the ray cannot meet the solid any more.
    Gone,
    /// The point is in this empty prism.
    Empty(Prism),
    /// The point is in the bounding box of a sphere.
    Box(Prism),
}

/// An empty prism: the upper borders that bound it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prism {
    /// The upper border along each axis; `None` if the axis does not bound the prism.
    pub borders: [Option<Border>; AXES],
    /// Which of the exits along the axes leaves the prism.
    pub exit: Exit,
}

/// The upper border of an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Border {
    /// Coordinate of the border along its axis, s13.12.
    pub at: i64,
    /// Number of the interval above the border.
    pub next: i32,
}

/// Which exit leaves a prism, among the exits along the axes in the order in which a ray reaches them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Exit {
    /// The first exit: the ray is in the prism while it is in all intervals.
    #[default]
    First,
    /// The second of three exits: the ray is in one of three prisms while it is in two of the intervals.
    Second,
    /// The last exit: the ray is in the prism while it is in any of the intervals.
    Last,
}

impl Exit {
    /// The axis of the exit at which the ray leaves a prism, and for each axis whether the ray has crossed the border by then. Of two exits
    /// at the same parameter, the exit along the axis with the smaller number is the earlier one. `exits` has the parameters at the
    /// borders; without borders, the axis is z.
    pub(super) fn leaving(self, exits: &[Option<i64>; AXES]) -> (usize, [bool; AXES]) {
        let rank = |axis: usize| {
            let exit = exits[axis]?;
            let is_earlier =
                |&other: &usize| exits[other].is_some_and(|found| (found, other) < (exit, axis));
            Some((0..AXES).filter(is_earlier).count())
        };
        let ranks = [0, 1, 2, 3].map(rank);
        let wanted = match self {
            Self::First => 0,
            Self::Second => 1,
            Self::Last => ranks.iter().flatten().count().saturating_sub(1),
        };
        let crossed = ranks.map(|rank| rank.is_some_and(|rank| rank <= wanted));
        let face = ranks.iter().position(|&rank| rank == Some(wanted));
        (face.unwrap_or(2), crossed)
    }
}

impl Solid {
    /// Half the side along each of the axes x, y and z, u9.12.
    pub const fn half(&self) -> [i32; 3] {
        let [x, y, z, _] = self.side;
        [(x / 2) as i32, (y / 2) as i32, (z / 2) as i32]
    }

    /// For each of the axes x, y and z, the coordinate from the centre, s9.12, of one plane perpendicular to the axis: the lower plane of a
    /// box or sponge, the upper of two planes, or the lower plane of the box above the middle box of repeated boxes.
    pub fn borders(&self) -> [i32; 3] {
        self.half().map(|half| match self.rule {
            Rule::Planes => half,
            Rule::Repeated { .. } => (1 << PERIOD) - half,
            Rule::Box | Rule::Sponge { .. } | Rule::Octahedron => -half,
        })
    }

    /// The intervals of a point. Rounding may move a point below a border that the ray has crossed, so the result is never below the
    /// intervals that the ray has `reached`.
    pub(super) fn intervals(&self, point: &[i64; AXES], reached: &[i32; AXES]) -> [i32; AXES] {
        [0, 1, 2, 3].map(|axis: usize| {
            let (x, side) = (point[axis], self.side[axis]);
            let interval = match self.rule {
                Rule::Sponge { exponent, .. } => (x >> exponent).max(-1) as i32,
                Rule::Repeated { .. } => {
                    let (cell, within) = (x >> PERIOD, x & ((1 << PERIOD) - 1));
                    match cell < LAST_CELL {
                        true => 2 * cell as i32 + i32::from(within >= side),
                        false => 2 * LAST_CELL as i32,
                    }
                }
                Rule::Box | Rule::Planes | Rule::Octahedron => {
                    i32::from(x >= side) - i32::from(x < 0)
                }
            };
            interval.max(reached[axis])
        })
    }

    /// Where a point with these intervals is, relative to the solid.
    pub(super) fn place(&self, k: &[i32; AXES]) -> Place {
        match self.rule {
            Rule::Box => outside(k, 1, 0..3).unwrap_or(Place::Solid),
            Rule::Octahedron => outside(k, 1, 0..AXES).unwrap_or(Place::Solid),
            Rule::Planes if k[2] == 0 => Place::Empty(prism(Exit::First, |axis| {
                (axis == 2).then_some(Border {
                    at: self.side[2],
                    next: 1,
                })
            })),
            Rule::Planes => Place::Solid,
            Rule::Sponge {
                cells,
                last,
                exponent,
            } => outside(k, cells, 0..3).unwrap_or_else(|| {
                sponge(k, cells, last).map_or(Place::Solid, |(exit, next)| {
                    let border = |next| Border {
                        at: i64::from(next) << exponent,
                        next,
                    };
                    Place::Empty(prism(exit, |axis| (axis < 3).then(|| border(next[axis]))))
                })
            }),
            Rule::Repeated { round } => self.repeated(k, round),
        }
    }

    fn repeated(&self, k: &[i32; AXES], round: bool) -> Place {
        let in_gap = |axis: usize| axis < 3 && k[axis] & 1 == 1;
        let border = |axis: usize| {
            let cell = i64::from(k[axis] >> 1);
            Border {
                at: match in_gap(axis) {
                    true => (cell + 1) << PERIOD,
                    false => (cell << PERIOD) + self.side[axis],
                },
                next: k[axis] + 1,
            }
        };
        if (0..3).any(|axis| self.is_above(axis, k[axis])) {
            return Place::Gone;
        }
        if (0..3).any(in_gap) {
            return Place::Empty(prism(Exit::Last, |axis| in_gap(axis).then(|| border(axis))));
        }
        match round {
            true => Place::Box(prism(Exit::First, |axis| (axis < 3).then(|| border(axis)))),
            false => Place::Solid,
        }
    }

    /// Whether the interval along an axis is above the solid: a ray that has reached this interval cannot meet the solid any more.
    pub(super) fn is_above(&self, axis: usize, interval: i32) -> bool {
        match self.rule {
            Rule::Sponge { cells, .. } => interval >= cells,
            Rule::Octahedron => interval >= 1,
            Rule::Box => interval >= 1 && axis < 3,
            Rule::Repeated { .. } => i64::from(interval) >= 2 * LAST_CELL,
            Rule::Planes => false,
        }
    }

    /// The surface that a ray hits whose last crossed border is along the axis `face`. `down` states which axes are mirrored.
    pub(super) fn surface(&self, down: &[bool; AXES], face: usize) -> Surface {
        match self.rule {
            Rule::Octahedron => {
                // Normals of the slabs: bit i is set if component i is positive. A ray meets the face whose normal points against the ray.
                const NORMALS: [u8; AXES] = [0b110, 0b101, 0b011, 0b111];
                let normal = NORMALS[face];
                Surface::Octant {
                    signs: if down[face] { normal } else { !normal & 7 },
                }
            }
            _ => Surface::Face {
                axis: face as u8,
                positive: down[face],
            },
        }
    }
}

fn prism(exit: Exit, border: impl Fn(usize) -> Option<Border>) -> Prism {
    Prism {
        borders: [0, 1, 2, 3].map(border),
        exit,
    }
}

/// Where a point outside of a box is; `None` for a point inside the box. `above` is the number of the first interval above the box.
fn outside(k: &[i32; AXES], above: i32, axes: Range<usize>) -> Option<Place> {
    if axes.clone().any(|axis| k[axis] >= above) {
        return Some(Place::Gone);
    }
    let below = |axis: usize| axes.contains(&axis) && k[axis] < 0;
    (0..AXES).any(below).then(|| {
        let border = Border { at: 0, next: 0 };
        Place::Empty(prism(Exit::Last, |axis| below(axis).then_some(border)))
    })
}

/// The empty prism of a point in the cube about a sponge.
///
/// The sponge is the intersection of three extruded Sierpinski carpets: a point is outside if, at some level, the digits of two of its
/// coordinates are 1. The point is then in a prism that is bounded along these two axes by the borders of the point's cell at this level,
/// and that goes through the whole sponge along the third axis. If all three digits are 1, there are three prisms.
///
/// Returns which exit leaves the prism, and the numbers of the cells above the prism's borders; `None` for a point in the sponge.
fn sponge(k: &[i32; AXES], cells: i32, last: i32) -> Option<(Exit, [i32; AXES])> {
    let mut cell = cells / 3;
    while cell >= last {
        let middle = [0, 1, 2, 3].map(|axis: usize| axis < 3 && k[axis] / cell % 3 == 1);
        let exit = match middle.iter().filter(|&&is_middle| is_middle).count() {
            3 => Some(Exit::Second),
            2 => Some(Exit::First),
            _ => None,
        };
        if let Some(exit) = exit {
            let next = |axis: usize| match middle[axis] {
                true => (k[axis] / cell + 1) * cell,
                false => cells,
            };
            return Some((exit, [0, 1, 2, 3].map(next)));
        }
        cell /= 3;
    }
    None
}
