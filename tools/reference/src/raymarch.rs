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
mod surface;
mod trace;
pub mod variant;
pub mod verilated;
pub mod views;

pub use surface::{Face, Hit, Plane, Sphere};
pub use trace::Unconverged;

use crate::camera::{Ray, Vector};

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
