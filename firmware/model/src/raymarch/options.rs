//! How a field is drawn: appearance, eyes, tuning, prepass.

use glint_core::appearance::Appearance;
use glint_core::field::{FRACTION, Field};
use glint_core::fixed::U4_28;
use glint_core::light::{Background, Lighting, Material};
use glint_core::stereo::Stereo;

use super::palette::Palette;

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

/// For round fields and oblique faces: silhouettes, and the normals of spheres, show where a ray has ended.
pub const ROUND_TUNING: Tuning = Tuning {
    threshold: 4,
    footprint: 15,
    ..DEFAULT_TUNING
};

impl Tuning {
    /// The default of a field.
    const fn of(field: &Field) -> Self {
        if field.is_round() || field.has_octants() {
            ROUND_TUNING
        } else {
            DEFAULT_TUNING
        }
    }
}

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
    /// Whether cones precede the rays.
    pub prepass: bool,
}

impl FieldOptions {
    /// What is used unless told otherwise: as finely as suits the field.
    pub fn of(field: &Field) -> Self {
        Self {
            tuning: Tuning::of(field),
            palette: Palette::of(field, Material::Normal, &Lighting::PLAIN, Background::White),
            ..Self::default()
        }
    }

    /// A field of such an appearance, seen with one eye or two, with the default tuning.
    pub fn new(field: &Field, appearance: &Appearance, stereo: Option<Stereo>) -> Self {
        let &Appearance {
            material,
            background,
            fog,
            occlusion,
            ..
        } = appearance;
        let palette = Palette::of(field, material, &appearance.lighting(), background);
        Self {
            stereo,
            palette: if occlusion {
                palette.with_occlusion()
            } else {
                palette
            },
            fog,
            tuning: Tuning::of(field),
            ..Self::default()
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
            prepass: false,
        }
    }
}
