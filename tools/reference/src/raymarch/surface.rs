//! Balls and planes as parts of solids, and hits of rays on solids.

use crate::camera::Vector;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre, in world units.
    pub centre: Vector,
    /// Radius, in world units, above 0.
    pub radius: f64,
}

/// A plane that bounds a solid. The solid lies behind the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Normal that points out of the solid, of any length but 0.
    pub normal: Vector,
    /// Scalar product of the normal with any point of the plane.
    pub offset: f64,
}

/// Kind of a hit surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// A plane perpendicular to an axis.
    Axis {
        /// Index of the axis: 0, 1 or 2 for x, y or z.
        axis: usize,
        /// Whether the outward normal points along the axis.
        positive: bool,
    },
    /// A plane perpendicular to a diagonal.
    Diagonal {
        /// Whether the outward normal's component along each axis is positive.
        positive: [bool; 3],
    },
    /// A curved surface.
    Round,
    /// No surface: the ray starts inside the solid.
    Inside,
}

impl Face {
    /// Returns the face with the outward normal `normal`, which must point along an axis or a diagonal.
    pub fn of_normal(normal: Vector) -> Self {
        let largest = normal
            .iter()
            .fold(0.0, |most: f64, part| most.max(part.abs()));
        let mut axes = (0..3).filter(|&axis| normal[axis].abs() > largest / 2.0);
        match (axes.next(), axes.next()) {
            (Some(axis), None) => Self::Axis {
                axis,
                positive: normal[axis] > 0.0,
            },
            _ => Self::Diagonal {
                positive: normal.map(|part| part > 0.0),
            },
        }
    }
}

/// The first point of a ray inside a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter at the hit: the distance in multiples of the direction's length.
    pub t: f64,
    /// Outward normal of length 1; zero if the face is [`Face::Inside`].
    pub normal: Vector,
    /// Kind of surface at the hit.
    pub face: Face,
    /// Hit part of the field: the index of the ball in `Field::Spheres`, or the index (0 or 1) of the outermost union's member.
    /// It is 0 for other fields, and if the ray starts inside the solid.
    pub member: usize,
}

impl Hit {
    /// Makes the hit of a ray that starts inside the solid, at the start's parameter `t`.
    pub(super) fn inside(t: f64) -> Self {
        Self {
            t,
            normal: [0.0; 3],
            face: Face::Inside,
            member: 0,
        }
    }

    /// Makes the hit at parameter `t` of a ray of this direction on a solid's face perpendicular to `axis`.
    pub(super) fn entered(t: f64, axis: usize, direction: Vector) -> Self {
        let mut normal = [0.0; 3];
        normal[axis] = -direction[axis].signum();
        let positive = direction[axis] < 0.0;
        Self {
            t,
            normal,
            face: Face::Axis { axis, positive },
            member: 0,
        }
    }

    /// Returns the hit with its `member` set. If the ray starts inside the solid, `member` stays 0, because several members may
    /// contain the start.
    pub(super) fn of(mut self, member: usize) -> Self {
        if self.face != Face::Inside {
            self.member = member;
        }
        self
    }

    /// Returns the hit with the smaller parameter, or `a` if the parameters are equal.
    pub(super) fn nearer(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
            (a, b) => a.or(b),
        }
    }
}
