//! Rays by exits: each step advances a ray to the exit of a whole empty prism. Hits are exact, because no distance is compared with a
//! threshold (docs/raymarch-exits.md).
//!
//! The planes of a solid cut each axis into intervals. A field is a rule for the three intervals of a point: either the point is in the
//! solid, or the rule returns the planes that bound an empty prism around the point. An *evaluation* moves the ray to the exit of this
//! prism. A ray therefore ends after a few evaluations, on a plane of the solid, exactly up to the rounding of one product.
//!
//! A ray is o + T·D. The direction D is not normalised, so T is a depth. All solids are symmetric about the origin, so an axis along which
//! a ray points down can be mirrored. All rays then point up, and every exit is at the upper border of an interval.
//!
//! The spheres of a list are tested before the flat solid, with the cones in which an eye sees these spheres. A sphere of a lattice is
//! tested when a ray is in the bounding box of the sphere.
//!
//! [`Exits`] has the constants of a frame, [`Exits::ray`] computes the ray of a pixel, [`Exits::end`] finds the end of the ray, and
//! [`Words`] has the word lengths.

mod code;
mod cone_words;
mod cones;
mod follow;
mod intervals;
mod lattice;
mod narrow;
mod ray;
mod rectangle;
mod seen;
mod setup;
mod shadow;
mod solid_cone;
mod spheres;
mod sun;
mod vectors;
mod words;

pub use code::CODE_BITS;
pub use cones::{Cone, ConeKind, Cones, Linear};
pub use follow::End;
pub use intervals::{AXES, Border, Exit, Place, Prism, Rule, Solid};
pub use ray::{Beam, Way};
pub use rectangle::Rectangle;
pub use setup::{Exits, Eye, Side, Start};
pub use spheres::Met;
pub use sun::Sun;
pub use words::{Inverse, Words};
