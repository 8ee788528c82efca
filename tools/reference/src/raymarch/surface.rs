//! Parts of solids, and hits on them.

use crate::camera::Vector;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// In world units.
    pub centre: Vector,
    /// In world units, above 0.
    pub radius: f64,
}

/// A plane, with the solid behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Out of the solid, of any length but 0.
    pub normal: Vector,
    /// The product of the normal with any point of the plane.
    pub offset: f64,
}

/// What of a surface was hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// A plane across an axis.
    Axis {
        /// 0 to 2.
        axis: usize,
        /// Whether the outward normal points along the axis and not against it.
        positive: bool,
    },
    /// A plane across a diagonal.
    Diagonal {
        /// Whether the outward normal points along each axis, and not against it.
        positive: [bool; 3],
    },
    /// A curved surface.
    Round,
    /// None: the ray starts within the solid.
    Inside,
}

impl Face {
    /// The face with an outward normal along an axis or a diagonal.
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

    /// The face across `axis` by which a ray of this direction enters.
    pub(super) fn entered(axis: usize, direction: Vector) -> Self {
        Self::Axis {
            axis,
            positive: direction[axis] < 0.0,
        }
    }
}

/// The first point of a ray that is in a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter, in lengths of its direction.
    pub t: f64,
    /// Of length 1 and out of the solid; zero for [`Face::Inside`].
    pub normal: Vector,
    /// What was hit.
    pub face: Face,
    /// Number of the sphere in `Field::Spheres`, or of the member of the outermost union. 0 for other fields, and inside.
    pub member: usize,
}

impl Hit {
    /// That of a ray which starts within.
    pub(super) fn inside(t: f64) -> Self {
        Self {
            t,
            normal: [0.0; 3],
            face: Face::Inside,
            member: 0,
        }
    }

    /// On the face across `axis` by which a ray of this direction enters.
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

    /// As the hit of a member of more; where the ray starts may be in several.
    pub(super) fn of(mut self, member: usize) -> Self {
        if self.face != Face::Inside {
            self.member = member;
        }
        self
    }

    /// The nearer of two, the first when they are equally near.
    pub(super) fn nearer(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
            (a, b) => a.or(b),
        }
    }
}
