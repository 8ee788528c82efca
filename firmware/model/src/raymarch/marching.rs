//! The constants of a frame whose rays march by distances.

use glint_core::camera::View;
use glint_core::feature::SPHERES;
use glint_core::field::{
    FRACTION, Field, FieldSample, FixedSpheres, Placed, Primitive, Solid, cropped, units,
};
use glint_core::fixed::Q32_32;

use super::blend::{Beside, Blend};
use super::directions::Directions;
use super::options::{FARTHEST, Tuning};

/// Half side of the bounding box that is used for unbounded fields: the largest magnitude of a point's coordinate (s13.12).
const UNBOUNDED: u32 = (1 << (12 + FRACTION)) - 1;

/// Position of an eye, and direction of its first ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Eye {
    /// Position in field units, s13.12.
    pub origin: [i32; 3],
    /// Distance outside of the bounding box along each axis, u12.12; 0 inside, and for unbounded fields.
    pub outside: [u32; 3],
    /// Unscaled direction D (docs/formats/raymarch.md, "Rays") of the first pixel's ray, 30 fraction bits, modulo 2^32.
    pub first: [i32; 3],
}

/// The constants of a frame whose rays march by distances (docs/formats/raymarch.md, "Distance fields").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marching {
    /// The solid of the field; for a union, its flat member.
    pub solid: Solid,
    /// Spheres in union with `solid`; `None` if the field is not a union.
    pub beside: Option<Beside>,
    /// Half side lengths of the bounding box about the origin, u12.12; the largest value along an unbounded axis.
    pub bounds: [u32; 3],
    /// The left and the right eye; the second is unused without stereo.
    pub eyes: [Eye; 2],
    /// Change of the unscaled ray direction D per pixel to the right and per pixel down, 30 fraction bits.
    pub steps: [[i32; 3]; 2],
    /// Depth of the near plane, or of the nearest corner of the bounding box if larger, in field
    /// units times 2^e, u11.12.
    pub near: u32,
    /// Precision of the march of rays.
    pub tuning: Tuning,
}

impl Marching {
    /// Whether rays can march in a field: in all fields but unions with a field that repeats, in which the eye's position is that in the cell
    /// about the origin.
    pub fn draws(field: &Field) -> bool {
        !field.is_repeated_union()
    }

    /// Computes the constants for a field in the form of [`placed`], and for the cameras of the two eyes with their rays. `nearest` is the
    /// depth of the nearest corner of the field's bounding box, with 37 fraction bits.
    pub(super) fn new(
        (placed, beside): (Placed<Solid>, Option<Beside>),
        views: &[View; 2],
        rays: &Directions,
        nearest: i64,
        tuning: Tuning,
    ) -> Self {
        let Placed {
            solid,
            scale,
            extent,
        } = placed;
        let bounds = extent.map_or([UNBOUNDED; 3], |extent| {
            extent.map(|half| units(half, scale) as u32)
        });
        let repeated = solid.is_repeated();
        let eye = |view: &View, first: [i64; 3]| {
            let origin = [0, 1, 2].map(|i: usize| {
                // The camera is within 32 world units of the origin, and each of two eyes at most 1 world unit to the side of the camera.
                let place = units(view.eye()[i], scale) as i32;
                if repeated {
                    // The equivalent position relative to the field, in the cell about the origin.
                    cropped(place, 6 + FRACTION)
                } else {
                    place
                }
            });
            Eye {
                origin,
                outside: [0, 1, 2]
                    .map(|i: usize| origin[i].unsigned_abs().saturating_sub(bounds[i])),
                first: first.map(|x| rays.narrow(x)),
            }
        };
        // The near plane is at most 2 world units away, the corner of the box at most 64. The code below reduces the depth of the corner
        // by one unit, because it is rounded.
        let near = i64::from(views[0].near().to_bits()) << 4;
        let [plane, corner] = [near, nearest >> 5].map(|x| units(Q32_32::from_bits(x), scale));
        let near_units = plane.max(corner - 1) << rays.exponent;
        Self {
            solid,
            beside,
            bounds,
            eyes: [0, 1].map(|i: usize| eye(&views[i], rays.first[i])),
            steps: [rays.across, rays.down].map(|step| step.map(|x| rays.narrow(x))),
            near: near_units.clamp(0, FARTHEST.into()) as u32,
            tuning,
        }
    }

    /// The spheres, if any.
    pub fn spheres(&self) -> Option<&FixedSpheres> {
        self.solid
            .spheres()
            .or(self.beside.as_ref().map(|beside| &beside.spheres))
            .filter(|_| SPHERES.is_built)
    }

    /// The fillet between the spheres and the flat solid.
    pub fn blend(&self) -> Blend {
        self.beside
            .map_or_else(Blend::default, |beside| beside.blend)
    }

    /// Whether the scene has spheres. Rays are then scaled by their Euclidean length. The Euclidean length is never below the length in
    /// the maximum norm, so distances of flat solids are also valid for such rays.
    pub fn is_round(&self) -> bool {
        self.spheres().is_some()
    }

    /// Number of evaluations per step: one for each sphere of the scene, or one without spheres.
    pub fn passes(&self) -> u32 {
        self.spheres().map_or(1, |spheres| spheres.count as u32)
    }

    /// Whether an eye is in the solid.
    pub(super) fn is_inside(&self, eye: usize) -> bool {
        let Eye {
            origin, outside, ..
        } = self.eyes[eye];
        outside == [0; 3] && self.sample(origin).distance < 0
    }

    /// Returns only the distance of [`sample`](Self::sample).
    pub fn distance(&self, point: [i32; 3]) -> i32 {
        match &self.beside {
            Some(_) => self.sample(point).distance,
            None => self.solid.distance(point),
        }
    }

    /// Evaluates the field at a point with coordinates in s10.12. Returns the distance and the nearest surface; at equal
    /// distances of a face and a sphere, the face.
    pub fn sample(&self, point: [i32; 3]) -> FieldSample {
        let flat = self.solid.sample(point);
        match &self.beside {
            Some(beside) if SPHERES.is_built => beside.union(flat, beside.spheres.sample(point)),
            _ => flat,
        }
    }
}

/// The solid of a field (for a union, its flat member), and the spheres of a union.
pub(super) fn placed(field: &Field) -> (Placed<Solid>, Option<Beside>) {
    let union = match field {
        Field::Primitive(primitive) => return (primitive.placed(), None),
        Field::Union(union) if !SPHERES.is_built => return (union.first().placed(), None),
        Field::Union(union) => union,
    };
    let [first, round] = [union.first(), union.spheres()].map(Primitive::placed);
    // A fillet extends beyond both members of the union by at most a quarter of its width.
    let extent = first
        .extent
        .zip(round.extent)
        .map(|(first, round)| [0, 1, 2].map(|i: usize| first[i].max(round[i]) + union.blend() / 4));
    let beside = union.spheres().spheres(first.scale).map(|spheres| Beside {
        spheres,
        blend: Blend::new(units(union.blend(), first.scale) as u32),
        bend: union.bend().into(),
    });
    (Placed { extent, ..first }, beside)
}
