//! Parts of solids, and hits of rays.

use crate::camera::Vector;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre, in world units.
    pub centre: Vector,
    /// Radius, in world units, above 0.
    pub radius: f64,
}

/// A plane that bounds a half-space of solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Outward normal, of any length but 0.
    pub normal: Vector,
    /// Scalar product of the normal with any point of the plane.
    pub offset: f64,
}

/// Kind of surface at a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// A plane perpendicular to an axis.
    Axis {
        /// Axis, 0 to 2.
        axis: usize,
        /// Whether the outward normal points along the axis.
        positive: bool,
    },
    /// A plane perpendicular to a diagonal.
    Diagonal {
        /// Whether the outward normal points along each axis.
        positive: [bool; 3],
    },
    /// A curved surface.
    Round,
    /// No surface: the ray starts inside the solid.
    Inside,
}

impl Face {
    /// The face with the given outward normal, along an axis or a diagonal.
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

    /// The face perpendicular to `axis` through which a ray of this direction enters.
    pub(super) fn entered(axis: usize, direction: Vector) -> Self {
        Self::Axis {
            axis,
            positive: direction[axis] < 0.0,
        }
    }
}

/// The first point of a ray inside a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter, in lengths of its direction.
    pub t: f64,
    /// Outward normal of length 1; zero for [`Face::Inside`].
    pub normal: Vector,
    /// Surface at the hit.
    pub face: Face,
    /// Number of the sphere in `Field::Spheres`, or of the member of the outermost union. 0 for other fields, and inside.
    pub member: usize,
}

impl Hit {
    /// Hit of a ray that starts inside.
    pub(super) fn inside(t: f64) -> Self {
        Self {
            t,
            normal: [0.0; 3],
            face: Face::Inside,
            member: 0,
        }
    }

    /// Hit on the face perpendicular to `axis` through which a ray of this direction enters.
    pub(super) fn entered(t: f64, axis: usize, direction: Vector) -> Self {
        let mut normal = [0.0; 3];
        normal[axis] = -direction[axis].signum();
        Self {
            t,
            normal,
            face: Face::entered(axis, direction),
            member: 0,
        }
    }

    /// Sets the number of the member. A hit inside keeps 0, because several members may contain the start.
    pub(super) fn of(mut self, member: usize) -> Self {
        if self.face != Face::Inside {
            self.member = member;
        }
        self
    }

    /// The nearer of two hits; the first at equal parameters.
    pub(super) fn nearer(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
            (a, b) => a.or(b),
        }
    }
}
