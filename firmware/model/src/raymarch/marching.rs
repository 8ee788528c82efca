//! The constants of a frame that is drawn with marching rays.

use glint_core::camera::View;
use glint_core::field::{
    Cuboid, FRACTION, Field, FieldSample, FixedSphere, FixedSpheres, MAX_SPHERES, Placed,
    Primitive, Solid, Union, units,
};
use glint_core::fixed::Q32_32;
use glint_core::picture::Window;
use glint_core::stereo::Stereo;

use super::blend::{Beside, Blend};
use super::exits::{Exits, Words};
use super::options::Tuning;
use crate::error::RenderError;

/// Fraction bits of the parameter T of a marching ray, u14.10.
pub const MARCH_FRACTION: u32 = 10;

/// The constants of a frame whose rays march by distances (docs/formats/raymarch.md, "Marching rays"), of a smooth or bent union.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marching {
    /// The constants of rays by exits that enter the bounding box around the origin. Marching rays start at the same points, in the same
    /// directions.
    pub entry: Exits,
    /// The flat solid of the union.
    pub solid: Solid,
    /// The spheres, and how they are united with `solid`.
    pub beside: Beside,
    /// A ray hits if the distance is below `threshold` + T·2^−`footprint`. In field units with 12 fraction bits, below 2^16.
    pub threshold: u32,
    /// Exponent of the part of the threshold that grows with T, 7 to 22: the exponent of the options plus the exponent e of D.
    pub footprint: u32,
    /// Step limit, 1 to 1023: a ray ends undecided after this number of evaluations.
    pub cap: u32,
}

impl Marching {
    /// Computes the constants for a union, its bounding box, a camera and a window of a picture.
    ///
    /// # Errors
    /// Those of [`Exits::in_window`].
    pub(super) fn new(
        union: &Union,
        half: [Q32_32; 3],
        view: &View,
        window: Window,
        stereo: Option<Stereo>,
        tuning: Tuning,
    ) -> Result<Self, RenderError> {
        let bounds = Field::Primitive(Cuboid { half }.into());
        let mut entry = Exits::in_window(&bounds, view, window, stereo, Words::CHOSEN)?;
        for eye in &mut entry.eyes {
            // Adds 2^−18 to D, so that truncation to 18 bits rounds to nearest.
            eye.first = eye.first.map(|part| part.wrapping_add(1 << 12));
        }
        let Placed { solid, scale, .. } = union.first().placed();
        let spheres = union.spheres().spheres(scale);
        Ok(Self {
            entry,
            solid,
            beside: Beside {
                spheres: spheres.unwrap_or(FixedSpheres {
                    list: [FixedSphere::default(); MAX_SPHERES],
                    count: 0,
                    repeated: false,
                    cone: None,
                }),
                blend: Blend::new(units(union.blend(), scale) as u32),
                bend: union.bend().into(),
            },
            threshold: tuning.threshold,
            footprint: tuning.footprint + entry.exponent,
            cap: tuning.cap,
        })
    }

    /// Half side lengths of the bounding box, u9.12.
    pub fn bounds(&self) -> [i32; 3] {
        self.entry.solid.unwrap_or_default().half()
    }

    /// The spheres of the union.
    pub const fn spheres(&self) -> &FixedSpheres {
        &self.beside.spheres
    }

    /// Number of evaluations per step: one for each sphere.
    pub const fn passes(&self) -> u32 {
        self.beside.spheres.count as u32
    }

    /// Whether an eye is in the solid.
    pub(super) fn is_inside(&self, eye: usize) -> bool {
        self.sample(self.entry.eyes[eye].origin).distance < 0
    }

    /// Evaluates the field at a point, s15.12. Returns the distance and the nearest surface. If a face and a sphere are at equal distances,
    /// returns the face. A coordinate that exceeds the field's format s10.12 saturates. The solid is within this range, so saturation never
    /// makes the distance too large.
    pub fn sample(&self, point: [i32; 3]) -> FieldSample {
        const MOST: i32 = (1 << (9 + FRACTION)) - 1;
        let point = point.map(|x| x.clamp(!MOST, MOST));
        let round = self.beside.spheres.sample(point);
        self.beside.union(self.solid.sample(point), round)
    }
}

/// Half side lengths of the bounding box of both members of a union; `None` for an unbounded member. A fillet extends beyond both members
/// by at most a quarter of the fillet's width.
pub(super) fn extent(union: &Union) -> Option<[Q32_32; 3]> {
    let [first, round] = [union.first(), union.spheres()].map(Primitive::placed);
    first
        .extent
        .zip(round.extent)
        .map(|(first, round)| [0, 1, 2].map(|i: usize| first[i].max(round[i]) + union.blend() / 4))
}
