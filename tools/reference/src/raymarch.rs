//! Solids as signed distance fields in f64, and two independent methods to find a ray's hit on a solid.
//!
//! - [`Field::distance`]: the distance of a point from a solid.
//! - [`Field::traced`]: hits by sphere tracing, which uses only the distance.
//! - [`Field::hit`]: hits computed from each solid's geometry, exact up to the rounding of f64.
//! - [`views`]: cameras that look at the Menger sponge.
//! - [`metrics`]: errors of a picture against the reference.
//! - [`raymarched`]: pictures of Glint's raymarcher, in the form that `metrics` compares.
//! - [`exited`]: pictures of the rays by exits, in the same form.
//!
//! If a ray only touches a solid, or lies in the plane of a face of the solid, a hit and a miss are both correct.

mod distance;
pub mod exited;
mod grid;
mod menger;
pub mod metrics;
pub mod raymarched;
mod rendered;
mod solids;
mod surface;
mod trace;
pub mod views;

pub use surface::{Face, Hit, Plane, Sphere};
pub use trace::Unconverged;

use crate::camera::{Ray, Vector};

/// A solid. Lengths are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// The Menger sponge in the cube from −1 to 1 along every axis.
    Menger {
        /// Number of levels of holes, 1 to 6.
        depth: u32,
    },
    /// A box about the origin.
    Box {
        /// Half of the side length along each axis.
        half: Vector,
    },
    /// A convex solid: the points behind all planes.
    Convex(Vec<Plane>),
    /// The union of balls.
    Spheres(Vec<Sphere>),
    /// A cone about the z axis, with the origin half-way between the apex, which is above, and the base.
    Cone {
        /// Radius of the base.
        radius: f64,
        /// Height from the base to the apex.
        height: f64,
    },
    /// Balls about all points whose coordinates are integer multiples of the period.
    Lattice {
        /// Distance between the centres of neighbouring balls.
        period: f64,
        /// Radius of each ball.
        radius: f64,
    },
    /// Boxes along the axes about all points whose coordinates are integer multiples of the period.
    Boxes {
        /// Distance between the centres of neighbouring boxes along each axis.
        period: f64,
        /// Half of each box's side length along each axis: at most half the period, or infinite for a solid that is unbounded along the
        /// axis.
        half: Vector,
    },
    /// The solid outside a room of infinite width, which has its floor at z = −half and its ceiling at z = half.
    Planes {
        /// Half of the room's height.
        half: f64,
    },
    /// The union of two fields.
    Union(Box<Self>, Box<Self>),
    /// The smooth union of two fields, with a fillet between surfaces close to each other (quadratic smooth minimum of Quilez).
    SmoothUnion {
        /// Range of the fillet: the fillet is present where the distances to the two members differ by less than `k`.
        k: f64,
        /// The first of the two members.
        a: Box<Self>,
        /// The second of the two members.
        b: Box<Self>,
    },
}

impl Field {
    /// Finds the first point of a ray inside the solid, with a parameter from `t_min` to `t_max`. If the point at `t_min` is
    /// inside the solid, the hit is at `t_min` and its face is [`Face::Inside`].
    ///
    /// `direction` may have any length but 0. For [`Field::Lattice`] and [`Field::Boxes`] `t_max` must be finite, because a ray
    /// may never hit a ball or box.
    ///
    /// # Panics
    /// When a ray runs close to a [`Field::SmoothUnion`] for too many steps (see [`Unconverged`]).
    pub fn hit(&self, origin: Vector, direction: Vector, t_min: f64, t_max: f64) -> Option<Hit> {
        let ray = Ray { origin, direction };
        let hit = match self {
            Self::Menger { depth } => menger::hit(*depth, &ray, t_min),
            Self::Box { half } => solids::box_hit(*half, &ray, t_min),
            Self::Convex(planes) => solids::convex_hit(planes, &ray, t_min),
            Self::Spheres(spheres) => solids::spheres_hit(spheres, &ray, t_min),
            Self::Cone { radius, height } => solids::cone_hit(*radius, *height, &ray, t_min),
            Self::Lattice { period, radius } => grid::nearest(*period, &ray, t_min, t_max, |ray| {
                solids::sphere_hit(*radius, ray, t_min)
            }),
            Self::Boxes { period, half } => grid::nearest(*period, &ray, t_min, t_max, |ray| {
                solids::box_hit(*half, ray, t_min)
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
