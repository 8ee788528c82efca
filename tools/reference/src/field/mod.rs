//! Solids given by signed distance fields, in f64: where a ray hits them, found in two ways that share no code.
//!
//! - [`Field::distance`]: the distance fields themselves.
//! - [`Field::traced`]: any field by sphere tracing, which sees nothing but its distance.
//! - [`Field::hit`]: each solid from its own geometry, exact but for the rounding of f64.
//! - [`views`]: cameras that look at the sponge.
//! - [`metrics`]: how far a picture is from the reference.
//! - [`raymarched`]: pictures of Glint's raymarcher, to be compared.
//! - [`variant`]: other ways to march.
//! - [`verilated`]: what pictures take of the raymarcher itself.
//!
//! A ray that only touches a solid, or lies in the plane of one of its faces, may hit or miss it.

mod distance;
mod grid;
mod menger;
pub mod metrics;
pub mod raymarched;
mod solids;
mod trace;
pub mod variant;
pub mod verilated;
pub mod views;

pub use trace::Unconverged;

use crate::camera::{Ray, Vector};

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

/// A solid of the world. Lengths are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// The Menger sponge that fills the cube from −1 to 1 in every axis.
    Menger {
        /// How often holes are cut, 1 to 6.
        depth: u32,
    },
    /// A box about the origin.
    Box {
        /// Half of its sides.
        half: Vector,
    },
    /// A convex solid: what is behind all of some planes.
    Convex(Vec<Plane>),
    /// The union of balls.
    Spheres(Vec<Sphere>),
    /// Balls about all points whose coordinates are integer multiples of the period.
    Lattice {
        /// From centre to centre.
        period: f64,
        /// Of each ball.
        radius: f64,
    },
    /// Cubes along the axes about all points whose coordinates are integer multiples of the period.
    Cubes {
        /// From centre to centre.
        period: f64,
        /// Half of each cube's side, at most half the period.
        half: f64,
    },
    /// Everything but the room between a floor at z = −half and a ceiling at z = half.
    Planes {
        /// Half of the room's height.
        half: f64,
    },
    /// What is in either.
    Union(Box<Self>, Box<Self>),
    /// What is in either, with a fillet where they are close (the quadratic smooth minimum of Quilez).
    SmoothUnion {
        /// The difference of the distances to the members up to which the fillet reaches.
        k: f64,
        /// Member 0.
        a: Box<Self>,
        /// Member 1.
        b: Box<Self>,
    },
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
    fn entered(axis: usize, direction: Vector) -> Self {
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
    /// The number of the ball in [`Field::Spheres`], or of the outermost union's member; otherwise, and inside, 0.
    pub member: usize,
}

impl Hit {
    /// That of a ray which starts within.
    fn inside(t: f64) -> Self {
        Self {
            t,
            normal: [0.0; 3],
            face: Face::Inside,
            member: 0,
        }
    }

    /// On the face across `axis` by which a ray of this direction enters.
    fn entered(t: f64, axis: usize, direction: Vector) -> Self {
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
    fn of(mut self, member: usize) -> Self {
        if self.face != Face::Inside {
            self.member = member;
        }
        self
    }

    /// The nearer of two, the first when they are equally near.
    fn nearer(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
            (a, b) => a.or(b),
        }
    }
}

impl Field {
    /// The first point of a ray with a parameter from `t_min` to `t_max` that is in the solid; at `t_min` itself and
    /// [`Face::Inside`] when the ray is there already.
    ///
    /// `direction` is of any length but 0. For [`Field::Lattice`] and [`Field::Cubes`] `t_max` is finite: the ray may go on
    /// between them for ever.
    ///
    /// # Panics
    /// When a ray neither hits a [`Field::SmoothUnion`] nor leaves it behind: see [`Unconverged`].
    pub fn hit(&self, origin: Vector, direction: Vector, t_min: f64, t_max: f64) -> Option<Hit> {
        let ray = Ray { origin, direction };
        let hit = match self {
            Self::Menger { depth } => menger::hit(*depth, &ray, t_min),
            Self::Box { half } => solids::box_hit(*half, &ray, t_min),
            Self::Convex(planes) => solids::convex_hit(planes, &ray, t_min),
            Self::Spheres(spheres) => solids::spheres_hit(spheres, &ray, t_min),
            Self::Lattice { period, radius } => grid::nearest(*period, &ray, t_min, t_max, |ray| {
                solids::sphere_hit(*radius, ray, t_min)
            }),
            Self::Cubes { period, half } => grid::nearest(*period, &ray, t_min, t_max, |ray| {
                solids::box_hit([*half; 3], ray, t_min)
            }),
            Self::Planes { half } => solids::planes_hit(*half, &ray, t_min),
            Self::Union(a, b) => {
                let [a, b] = [(a, 0), (b, 1)].map(|(field, member)| {
                    let hit = field.hit(origin, direction, t_min, t_max)?;
                    Some(hit.of(member))
                });
                Hit::nearer(a, b)
            }
            Self::SmoothUnion { .. } => self
                .traced(origin, direction, t_min, t_max)
                .expect("a ray ends"),
        };
        hit.filter(|hit| hit.t <= t_max)
    }
}
