//! The constants of a frame of a field, computed once from the field, the camera and the picture's size.

use glint_core::camera::{Projection, View};
use glint_core::feature::{SPHERES, STEREO};
use glint_core::field::{
    FRACTION, Field, FieldSample, FixedSpheres, Placed, Primitive, Solid, cropped, units,
};
use glint_core::fixed::Q32_32;
use glint_core::stereo::Tint;

use super::blend::{Beside, Blend};
use super::directions::Directions;
use super::options::{FARTHEST, FieldOptions, Tuning};
use crate::depth::DepthScale;
use crate::error::{FIELD_HALF_WIDTH, RenderError, SIZES};

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

/// The constants of a frame (docs/formats/raymarch.md, "Distance fields").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldSetup {
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// The solid of the field; for a union, its flat member.
    pub solid: Solid,
    /// Spheres in union with `solid`; `None` if the field is not a union.
    pub beside: Option<Beside>,
    /// Field units per world unit: 2 to 256.
    pub scale: Q32_32,
    /// Half side lengths of the bounding box about the origin, u12.12; the largest value along an unbounded axis.
    pub bounds: [u32; 3],
    /// The left and the right eye; the second is unused without stereo.
    pub eyes: [Eye; 2],
    /// Change of the unscaled ray direction D per pixel to the right and per pixel down, 30 fraction bits.
    pub steps: [[i32; 3]; 2],
    /// Exponent e, 0 to 3: D is 2^−e times the direction whose component along the camera's forward axis n is 1.
    pub exponent: u32,
    /// Depth of the near plane, or of the nearest corner of the bounding box if larger, in field
    /// units times 2^e, u11.12.
    pub near: u32,
    /// Scale K of depth codes (a code is K/depth), for depths in field units times 2^e.
    pub depth: DepthScale,
    /// Scale K of depth codes (a code is K/depth), for depths in world units, for the host.
    pub world_depth: DepthScale,
    /// Precision of the march of rays.
    pub tuning: Tuning,
    /// Colours in which the two eyes are shown in stereo; `None` for one eye.
    pub stereo: Option<Tint>,
}

impl FieldSetup {
    /// Computes the constants for a field, a camera and one of the [`SIZES`].
    ///
    /// # Errors
    /// [`RenderError::Size`] for another size, [`RenderError::Orthographic`], and [`RenderError::HalfWidth`] for a camera that is too
    /// narrow or too wide.
    pub fn new(
        field: &Field,
        view: &View,
        (width, height): (u32, u32),
        options: &FieldOptions,
    ) -> Result<Self, RenderError> {
        if !SIZES.contains(&(width, height)) {
            return Err(RenderError::Size { width, height });
        }
        if view.projection() == Projection::Orthographic {
            return Err(RenderError::Orthographic);
        }
        if !(FIELD_HALF_WIDTH[0]..=FIELD_HALF_WIDTH[1]).contains(&view.half_width()) {
            return Err(RenderError::HalfWidth(view.half_width()));
        }
        let round = field.is_round();
        let (
            Placed {
                solid,
                scale,
                extent,
            },
            beside,
        ) = placed(field);
        let bounds = extent.map_or([UNBOUNDED; 3], |extent| {
            extent.map(|half| units(half, scale) as u32)
        });

        let stereo = options.stereo.filter(|_| STEREO.is_built);
        let views = match stereo {
            Some(stereo) => stereo.eyes(view),
            None => [*view; 2],
        };
        let repeated = solid.is_repeated();
        let rays = Directions::new(&views, width, height, round);
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

        let near = i64::from(view.near().to_bits()) << 4;
        let nearest = nearest(view, extent);
        // The near plane is at most 2 world units away, the corner of the box at most 64. The code below reduces the depth of the corner
        // by one unit, because it is rounded.
        let [plane, corner] = [near, nearest >> 5].map(|x| units(Q32_32::from_bits(x), scale));
        let near_units = plane.max(corner - 1) << rays.exponent;
        let world_depth = DepthScale::from_nearest(nearest.max(near << 5));
        let steps = [rays.across, rays.down].map(|step| step.map(|x| rays.narrow(x)));
        Ok(Self {
            width,
            height,
            solid,
            beside,
            scale,
            bounds,
            eyes: [0, 1].map(|i: usize| eye(&views[i], rays.first[i])),
            steps,
            exponent: rays.exponent,
            near: near_units.clamp(0, FARTHEST.into()) as u32,
            depth: world_depth.times(scale, rays.exponent),
            world_depth,
            tuning: options.tuning,
            stereo: stereo.map(|stereo| stereo.tint),
        })
    }
}

impl FieldSetup {
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

    /// Whether an eye is in a solid, so that each of its rays ends at once.
    pub fn has_eye_inside(&self) -> bool {
        let eyes = &self.eyes[..if self.stereo.is_some() { 2 } else { 1 }];
        let is_inside = |eye: &Eye| eye.outside == [0; 3] && self.sample(eye.origin).distance < 0;
        eyes.iter().any(is_inside)
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
            Some(beside) if SPHERES.is_built => {
                beside.blend.union(flat, beside.spheres.sample(point))
            }
            _ => flat,
        }
    }
}

/// The solid of a field (for a union, its flat member), and the spheres of a union.
fn placed(field: &Field) -> (Placed<Solid>, Option<Beside>) {
    let union = match field {
        Field::Primitive(primitive) => return (primitive.placed(), None),
        Field::Union(union) if !SPHERES.is_built => return (union.flat().placed(), None),
        Field::Union(union) => union,
    };
    let [flat, round] = [union.flat(), union.round()].map(Primitive::placed);
    // A fillet extends beyond both members of the union by at most a quarter of its width.
    let extent = flat
        .extent
        .zip(round.extent)
        .map(|(flat, round)| [0, 1, 2].map(|i: usize| flat[i].max(round[i]) + union.blend() / 4));
    let beside = round.solid.spheres().map(|&spheres| Beside {
        spheres,
        blend: Blend::new(units(union.blend(), flat.scale) as u32),
    });
    (Placed { extent, ..flat }, beside)
}

/// Depth along the camera's forward axis n of the nearest corner of the bounding box, 37 fraction bits, rounded down;
/// negative for a corner behind the eye, and 0 for an unbounded field.
fn nearest(view: &View, extent: Option<[Q32_32; 3]>) -> i64 {
    extent.map_or(0, |half| -> i64 {
        (0..3)
            .map(|i| {
                let n = i64::from(view.n()[i].to_bits());
                // The products have 14 + 23 fraction bits. The reach is enlarged slightly, because the length of n is not exactly 1.
                let place = n * (view.eye()[i].to_bits() >> 18);
                let reach = n.abs() * ((half[i].to_bits() >> 18) + 2);
                -place - reach - (reach >> 13)
            })
            .sum()
    })
}
