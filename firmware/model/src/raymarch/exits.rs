//! Rays by exits: each step takes a ray out of a whole empty prism, so hits are exact, without distances and thresholds
//! (docs/raymarch-exits.md).
//!
//! The planes of a solid cut each axis into intervals. A field is a rule about the three intervals of a point: whether the point is in the
//! solid, or which planes bound an empty prism around the point. An *evaluation* moves the ray to the end of this prism. A ray therefore
//! ends after a few evaluations, and its end is on a plane of the solid, exact up to the rounding of one product.
//!
//! A ray is o + T·D with the unscaled direction D, so T is a depth. All solids here are symmetric about the origin,
//! so each axis along which a ray points down is mirrored. All rays then point up, and every exit is at the upper border of an interval.
//!
//! The spheres of a list are tested before the flat solid, by the cones in which an eye sees them. A sphere of a lattice is tested when a
//! ray is in the box about the sphere.
//!
//! [`Exits`] has the constants of a frame, [`Exits::ray`] makes the ray of a pixel, [`Exits::end`] finds its end, and [`Words`] has the
//! word lengths.

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
