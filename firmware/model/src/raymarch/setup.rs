//! The constants of a frame of a field, made once from the field, the camera and the picture's size.

use glint_core::camera::View;
use glint_core::field::{
    FRACTION, Field, FixedSpheres, Placed, Primitive, Sample, Solid, cropped, units,
};
use glint_core::fixed::Q32_32;
use glint_core::stereo::{Stereo, Tint};

use super::blend::{Beside, Blend};
use super::directions::Directions;
use super::options::{FARTHEST, FieldOptions, Tuning};
use super::prepass::{Cones, block_for};
use crate::depth::DepthScale;
use crate::error::{RenderError, SIZES};

/// More than any coordinate: those of points are s13.12.
const UNBOUNDED: u32 = (1 << (12 + FRACTION)) - 1;

/// Where an eye is, and where it looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Eye {
    /// In field units, s13.12.
    pub origin: [i32; 3],
    /// How far it is outside of the box along each axis, u12.12; 0 inside, and where there is no box.
    pub outside: [u32; 3],
    /// D of the first pixel, 30 fraction bits, modulo 2^32.
    pub first: [i32; 3],
}

/// The constants of a frame (formats.md, "Distance fields").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FieldSetup {
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// What there is.
    pub solid: Solid,
    /// Spheres beside a solid that has faces: then there are both.
    pub beside: Option<Beside>,
    /// Field units in a world unit: 2 to 256.
    pub scale: Q32_32,
    /// Half the sides of the box about the origin that holds it, u12.12; as large as can be where it has no end.
    pub bounds: [u32; 3],
    /// The left and the right eye; the second is unused without stereo.
    pub eyes: [Eye; 2],
    /// What D grows by with a pixel to the right and one down, 30 fraction bits.
    pub steps: [[i32; 3]; 2],
    /// D is 2^−e of the direction whose part along n is 1; e is 0 to 3.
    pub exponent: u32,
    /// The near plane's distance in field units times 2^e, or that of the nearest corner of the box, 12 fraction bits, u11.12.
    pub near: u32,
    /// The cones before the rays, if any.
    pub cones: Option<Cones>,
    /// K for depths in field units times 2^e.
    pub depth: DepthScale,
    /// K for depths in world units: the host's.
    pub world_depth: DepthScale,
    /// How finely.
    pub tuning: Tuning,
    /// Two eyes, and in which colours.
    pub stereo: Option<Tint>,
}

impl FieldSetup {
    /// The constants for a field, a camera and one of the [`SIZES`].
    ///
    /// # Errors
    /// [`RenderError::Size`].
    pub fn new(
        field: &Field,
        view: &View,
        (width, height): (u32, u32),
        options: &FieldOptions,
    ) -> Result<Self, RenderError> {
        if !SIZES.contains(&(width, height)) {
            return Err(RenderError::Size { width, height });
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

        let (shift, parallax) = match options.stereo {
            Some(Stereo {
                half_separation,
                zero_parallax,
                ..
            }) => (
                half_separation,
                // At most 1.
                (half_separation.to_bits() << 24) / (zero_parallax.to_bits() >> 4).max(1),
            ),
            None => (Q32_32::ZERO, 0),
        };
        let repeated = solid.is_repeated();
        let rays = Directions::new(view, width, height, parallax, round);
        let eye = |sign: i64, first: [i64; 3]| {
            let origin = [0, 1, 2].map(|i: usize| {
                // |C| ≤ 32 and e ≤ 1.
                let aside = (shift.to_bits() >> 8) * i64::from(view.u()[i].to_bits());
                let place = Q32_32::from_bits(view.eye()[i].to_bits() + sign * (aside >> 15));
                let place = units(place, scale) as i32;
                if repeated {
                    // The same place in the cell about the origin.
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
        // At most 2 world units for the plane, 64 for the box, of which a step of rounding is left out.
        let [plane, corner] = [near, nearest >> 5].map(|x| units(Q32_32::from_bits(x), scale));
        let near_units = plane.max(corner - 1) << rays.exponent;
        let world_depth = DepthScale::from_nearest(nearest.max(near << 5));
        let steps = [rays.across, rays.down].map(|step| step.map(|x| rays.narrow(x)));
        let eyes = if options.stereo.is_some() { 2 } else { 1 };
        let cones = options
            .prepass
            .then(|| Cones::new(block_for((width, height), eyes), round, &steps));
        Ok(Self {
            width,
            height,
            solid,
            beside,
            scale,
            bounds,
            eyes: [eye(-1, rays.first[0]), eye(1, rays.first[1])],
            steps,
            exponent: rays.exponent,
            near: near_units.clamp(0, FARTHEST.into()) as u32,
            cones,
            depth: world_depth.times(scale, rays.exponent),
            world_depth,
            tuning: options.tuning,
            stereo: options.stereo.map(|stereo| stereo.tint),
        })
    }
}

impl FieldSetup {
    /// The spheres that there are.
    pub fn spheres(&self) -> Option<&FixedSpheres> {
        self.solid
            .spheres()
            .or(self.beside.as_ref().map(|beside| &beside.spheres))
    }

    /// The fillet between them and what has faces.
    pub fn blend(&self) -> Blend {
        self.beside
            .map_or_else(Blend::default, |beside| beside.blend)
    }

    /// Whether there is anything round: then rays are scaled by their Euclidean length. It is never less than that in the maximum
    /// norm, so distances of faces hold for such rays too.
    pub fn is_round(&self) -> bool {
        self.spheres().is_some()
    }

    /// How often the field is asked for one distance: once for each sphere.
    pub fn passes(&self) -> u32 {
        self.spheres().map_or(1, |spheres| spheres.count as u32)
    }

    /// What is nearest to a point, each coordinate s10.12; of equals, the face.
    pub fn sample(&self, point: [i32; 3]) -> Sample {
        let flat = self.solid.sample(point);
        match &self.beside {
            Some(beside) => beside.blend.union(flat, beside.spheres.sample(point)),
            None => flat,
        }
    }
}

/// The solid of a field, of a union its flat member, and the spheres beside that.
fn placed(field: &Field) -> (Placed<Solid>, Option<Beside>) {
    let union = match field {
        Field::Primitive(primitive) => return (primitive.placed(), None),
        Field::Union(union) => union,
    };
    let [flat, round] = [union.flat(), union.round()].map(Primitive::placed);
    // A fillet is a quarter of its width high.
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

/// The depth along n of the corner of the box that is nearest, 37 fraction bits, rounded down: below 0 beside it; 0 where there is
/// no box.
fn nearest(view: &View, extent: Option<[Q32_32; 3]>) -> i64 {
    extent.map_or(0, |half| -> i64 {
        (0..3)
            .map(|i| {
                let n = i64::from(view.n()[i].to_bits());
                // 14 and 23 fraction bits; a little more for a length that is not quite 1.
                let place = n * (view.eye()[i].to_bits() >> 18);
                let reach = n.abs() * ((half[i].to_bits() >> 18) + 2);
                -place - reach - (reach >> 13)
            })
            .sum()
    })
}
