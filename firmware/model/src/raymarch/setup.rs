//! The constants of a frame of a field, made once from the field, the camera and the picture's size.

use glint_core::camera::View;
use glint_core::field::{Field, MAX_SPHERES, Sphere};
use glint_core::fixed::{Q2_23, Q2_30, Q32_32, U4_28};
use glint_core::stereo::{Stereo, Tint};
use glint_core::trig::sin_cos_q30;

use super::blend::{Beside, Blend};
use super::cone::{Cones, Prepass};
use super::field::{FRACTION, Sample, Solid, cropped};
use super::paint::Palette;
use super::sphere::{Ball, Balls};
use crate::depth::DepthScale;
use crate::error::{RenderError, SIZES};

/// Half the side of what a bounded field spans where the world's is 1: S of the sponge's levels is then 27, 9, 3, 1.
const HALF_SIDE: Q32_32 = Q32_32::lit("40.5");
/// The period of a repeated field.
const PERIOD: Q32_32 = Q32_32::lit("64");

/// More than any coordinate: those of points are s13.12.
const UNBOUNDED: u32 = (1 << (12 + FRACTION)) - 1;

/// Upper limit of t, u11.12.
pub(super) const FARTHEST: u32 = (1 << (11 + FRACTION)) - 1;

/// How finely a field is marched: what its error and its time depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tuning {
    /// A ray has arrived where the distance is below this (field units, 12 fraction bits, below 2^16) ...
    pub threshold: u32,
    /// ... and this power of two (7 to 15) of the distance that it has gone: t·2^−shift.
    pub footprint: u32,
    /// The points after which a ray is given up, undecided: 1 to 255; four times as many where there is anything round.
    pub cap: u32,
    /// t beyond which there is nothing, u11.12.
    pub far: u32,
}

/// What is used unless told otherwise, for pictures of all sizes (docs/report/raymarch.md).
///
/// What is wrong with a picture is wrong at edges: a ray that passes one by less than the threshold ends there. So the
/// threshold follows the distance by much less than a pixel does, 1/23 of one even at 1280 × 720 and half width 0.9, and one
/// rule serves all sizes: the evaluations hardly depend on them. They bound it from the other side: a smaller threshold, or
/// less of the distance, takes the slowest of the report's views beyond 14.4 evaluations a ray; a larger part of the distance
/// beside a smaller threshold shows more wrong faces for as many evaluations.
pub const DEFAULT_TUNING: Tuning = Tuning {
    threshold: 28,
    footprint: 14,
    cap: 255,
    far: FARTHEST,
};

/// What suits round fields: the silhouette of a sphere, and the normal beside it, show where a ray has ended.
pub const ROUND_TUNING: Tuning = Tuning {
    threshold: 4,
    footprint: 15,
    ..DEFAULT_TUNING
};

/// How a field is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldOptions {
    /// One eye, or two.
    pub stereo: Option<Stereo>,
    /// How finely.
    pub tuning: Tuning,
    /// In which colours, without fog.
    pub palette: Palette,
    /// How dense the fog is: e^−z of something is left that is z/density world units away. 0 is none.
    pub fog: U4_28,
    /// Cones before the rays, if any.
    pub prepass: Option<Prepass>,
}

impl FieldOptions {
    /// What is used unless told otherwise: as finely as suits the field.
    pub fn of(field: &Field) -> Self {
        let tuning = if field.is_round() {
            ROUND_TUNING
        } else {
            DEFAULT_TUNING
        };
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// The colours of a frame: with its fog, and grey for two eyes.
    pub fn palette_for(&self, setup: &FieldSetup) -> Palette {
        let palette = if self.fog == U4_28::ZERO {
            self.palette
        } else {
            self.palette.with_fog(setup, self.fog)
        };
        match setup.stereo {
            Some(_) => palette.grey(),
            None => palette,
        }
    }
}

impl Default for FieldOptions {
    fn default() -> Self {
        Self {
            stereo: None,
            tuning: DEFAULT_TUNING,
            palette: Palette::default(),
            fog: U4_28::ZERO,
            prepass: None,
        }
    }
}

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
        let (solid, beside, scale, extent) = match *field {
            Field::Union { flat, round, blend } => {
                let (solid, scale, flat) = in_units(&flat.into());
                let (balls, _, round) = in_units(&round.into());
                // A fillet is a quarter of its width high.
                let extent = flat.zip(round).map(|(flat, round)| {
                    [0, 1, 2].map(|i: usize| flat[i].max(round[i]) + blend / 4)
                });
                let beside = balls.balls().map(|&balls| Beside {
                    balls,
                    blend: Blend::new(units(blend, scale) as u32),
                });
                (solid, beside, scale, extent)
            }
            ref field => {
                let (solid, scale, extent) = in_units(field);
                (solid, None, scale, extent)
            }
        };
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
        let rays = Directions::new(view, width, height, parallax, round);
        let eye = |sign: i64, first: [i64; 3]| {
            let origin = [0, 1, 2].map(|i: usize| {
                // |C| ≤ 32 and e ≤ 1.
                let aside = (shift.to_bits() >> 8) * i64::from(view.u()[i].to_bits());
                let place = Q32_32::from_bits(view.eye()[i].to_bits() + sign * (aside >> 15));
                let place = units(place, scale) as i32;
                match solid {
                    // The same place in the cell about the origin.
                    Solid::Box { repeated: true, .. }
                    | Solid::Balls(Balls { repeated: true, .. }) => cropped(place, 6 + FRACTION),
                    _ => place,
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
            .map(|prepass| Cones::new(prepass, (width, height), eyes, round, &steps));
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
    pub fn balls(&self) -> Option<&Balls> {
        self.solid
            .balls()
            .or(self.beside.as_ref().map(|beside| &beside.balls))
    }

    /// The fillet between them and what has faces.
    pub fn blend(&self) -> Blend {
        self.beside
            .map_or_else(Blend::default, |beside| beside.blend)
    }

    /// Whether there is anything round: then rays are scaled by their Euclidean length. It is never less than that in the maximum
    /// norm, so distances of faces hold for such rays too.
    pub fn is_round(&self) -> bool {
        self.balls().is_some()
    }

    /// How often the field is asked for one distance: once for each sphere.
    pub fn passes(&self) -> u32 {
        self.balls().map_or(1, |balls| balls.count as u32)
    }

    /// What is nearest to a point, each coordinate s10.12; of equals, the face.
    pub fn sample(&self, point: [i32; 3]) -> Sample {
        let flat = self.solid.sample(point);
        match &self.beside {
            Some(beside) => beside.blend.union(flat, beside.balls.sample(point)),
            None => flat,
        }
    }
}

/// The solid, its units in one world unit, and half the sides of its box in world units.
fn in_units(field: &Field) -> (Solid, Q32_32, Option<[Q32_32; 3]>) {
    let solid_units = |x: Q32_32, scale| units(x, scale) as i32;
    match *field {
        Field::Menger { depth } => {
            // 81/3^i, each an even number of 2^−12.
            let one = 1 << FRACTION;
            let [third, ninth] = [3, 9].map(|parts| (one / 2 + parts / 2) / parts * 2);
            let levels = [27 * one, 9 * one, 3 * one, one, third, ninth];
            let last = levels[usize::from(depth.clamp(1, 6)) - 1];
            let solid = Solid::Menger {
                levels,
                depth,
                half: last / 2,
            };
            (solid, HALF_SIDE, Some([Q32_32::ONE; 3]))
        }
        Field::Box { half } => {
            let solid = Solid::Box {
                half: half.map(|x| Some(solid_units(x, HALF_SIDE))),
                room: false,
                repeated: false,
            };
            (solid, HALF_SIDE, Some(half))
        }
        Field::Cubes { period, half } => {
            let scale = scale_of(period);
            let solid = Solid::Box {
                half: [Some(solid_units(half, scale)); 3],
                room: false,
                repeated: true,
            };
            (solid, scale, None)
        }
        Field::Planes { half } => {
            let solid = Solid::Box {
                half: [None, None, Some(solid_units(half, HALF_SIDE))],
                room: true,
                repeated: false,
            };
            (solid, HALF_SIDE, None)
        }
        Field::Sphere { radius } => balls(&[Sphere {
            radius,
            ..Sphere::default()
        }]),
        Field::Spheres(ref spheres) => balls(spheres.iter()),
        Field::Moving {
            radius,
            orbit,
            angle,
        } => {
            let (sine, cosine) = sin_cos_q30(angle);
            // At most 12, with 20 and 30 fraction bits.
            let along = |part: Q2_30| {
                Q32_32::from_bits(((orbit.to_bits() >> 12) * i64::from(part.to_bits())) >> 18)
            };
            let (solid, scale, _) = balls(&[Sphere {
                centre: [along(cosine), along(sine), Q32_32::ZERO],
                radius,
            }]);
            // The same box in every frame of a turn.
            let reach = orbit + radius;
            (solid, scale, Some([reach, reach, radius]))
        }
        Field::Lattice { period, radius } => {
            let scale = scale_of(period);
            let mut list = [Ball::default(); MAX_SPHERES];
            list[0] = Ball::new([0; 3], solid_units(radius, scale));
            let solid = Solid::Balls(Balls {
                list,
                count: 1,
                repeated: true,
            });
            (solid, scale, None)
        }
        // One of both, which is told apart before.
        Field::Union { flat, .. } => in_units(&flat.into()),
    }
}

/// The units in one world unit of a field that repeats itself.
fn scale_of(period: Q32_32) -> Q32_32 {
    Q32_32::from_bits(((PERIOD.to_bits() << 16) / (period.to_bits() >> 8).max(1)) << 8)
}

/// As [`in_units`], of some spheres.
fn balls<'a>(
    spheres: impl IntoIterator<Item = &'a Sphere>,
) -> (Solid, Q32_32, Option<[Q32_32; 3]>) {
    let mut list = [Ball::default(); MAX_SPHERES];
    let mut extent = [Q32_32::ZERO; 3];
    let mut count = 0;
    for (ball, sphere) in list.iter_mut().zip(spheres) {
        let length = |x: Q32_32| units(x, HALF_SIDE) as i32;
        *ball = Ball::new(sphere.centre.map(length), length(sphere.radius));
        extent = [0, 1, 2].map(|i: usize| extent[i].max(sphere.centre[i].abs() + sphere.radius));
        count += 1;
    }
    let solid = Solid::Balls(Balls {
        list,
        count,
        repeated: false,
    });
    (solid, HALF_SIDE, Some(extent))
}

/// A length in world units in field units, nearest. |x| is at most 64 and the scale 256.
fn units(x: Q32_32, scale: Q32_32) -> i64 {
    // 24 and 20 fraction bits.
    let product = (x.to_bits() >> 8) * (scale.to_bits() >> 12);
    (product + (1 << (43 - FRACTION))) >> (44 - FRACTION)
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

/// The directions of the rays, D with 51 fraction bits before they are narrowed.
struct Directions {
    first: [[i64; 3]; 2],
    across: [i64; 3],
    down: [i64; 3],
    exponent: u32,
}

impl Directions {
    /// `parallax` is what the left eye's direction takes of u and the right eye's gives, 28 fraction bits, at most 1; `round` says
    /// that D is below 1 in the Euclidean norm, and not only in the maximum norm.
    fn new(view: &View, width: u32, height: u32, parallax: i64, round: bool) -> Self {
        let half_width = i64::from(view.half_width().to_bits());
        // Twice the half width over the pixels: below 2^54 before the division.
        let step = |row: [Q2_23; 3]| {
            row.map(|x| (2 * half_width * i64::from(x.to_bits())) / i64::from(width))
        };
        let (across, down) = (step(view.u()), step(view.v()));
        let first = [1, -1].map(|sign| {
            [0, 1, 2].map(|i: usize| {
                (i64::from(view.n()[i].to_bits()) << 28)
                    + sign * parallax * i64::from(view.u()[i].to_bits())
                    - (i64::from(width - 1) * across[i] + i64::from(height - 1) * down[i]) / 2
            })
        });
        // D is linear on the picture, so it is longest in a corner.
        let corners = first.iter().flat_map(|&first| {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
                [0, 1, 2].map(|i: usize| {
                    (first[i]
                        + x * i64::from(width - 1) * across[i]
                        + y * i64::from(height - 1) * down[i])
                        .abs()
                })
            })
        });
        // A little below 1, as steps are rounded.
        const ONE: i64 = (1 << 51) - (1 << 36);
        const SQUARE: i64 = (1 << 50) - (1 << 40);
        let exponent = if round {
            // 25 of the fraction bits, and 3 others.
            let squares = corners.map(|d| d.map(|x| ((x >> 26) + 1).pow(2)).iter().sum());
            let longest: i64 = squares.max().unwrap_or(0);
            (0..3).find(|&e| longest >> (2 * e) < SQUARE).unwrap_or(3)
        } else {
            let largest = corners.flatten().max().unwrap_or(0);
            (0..3).find(|&e| largest >> e < ONE).unwrap_or(3)
        };
        Self {
            first,
            across,
            down,
            exponent,
        }
    }

    /// 30 fraction bits, nearest, times 2^−e.
    fn narrow(&self, x: i64) -> i32 {
        let shift = 21 + self.exponent;
        ((x + (1 << (shift - 1))) >> shift) as i32
    }
}
