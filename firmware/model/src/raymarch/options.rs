//! Options of drawing a field: colours, fog, one eye or two, and precision of the march.

use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::field::{FRACTION, Field};
use glint_core::fixed::U4_28;
use glint_core::light::{Background, Light, Lighting, Material};
use glint_core::quality::{Quality, Threshold};
use glint_core::stereo::Stereo;

use super::palette::Palette;

/// Upper limit of the parameter t of a point along its ray, u11.12.
pub(super) const FARTHEST: u32 = (1 << (11 + FRACTION)) - 1;

/// Precision of the march of rays, which determines the errors of a picture and the time to draw it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tuning {
    /// Threshold: a ray hits if the distance is below `threshold` + t·2^−`footprint`. In field units, 12 fraction bits, below 2^16.
    pub threshold: u32,
    /// Footprint: the exponent of the part of the threshold that grows with t, t·2^−`footprint`; 7 to 15.
    pub footprint: u32,
    /// Step limit: number of evaluations after which a ray ends undecided, 1 to 255. In scenes with spheres the limit is
    /// four times this number.
    pub cap: u32,
    /// Far limit: a ray has missed when its parameter t exceeds this number, u11.12.
    pub far: u32,
}

/// Default tuning for pictures of all sizes (docs/report/raymarch.md).
///
/// Errors of a picture occur at edges: a ray that passes an edge within the threshold counts as a hit. The part of the
/// threshold that grows with t is therefore much less than a pixel's width, 1/23 of a pixel even at 1280 × 720 and half
/// width 0.9. One tuning serves all sizes, because the number of evaluations per ray hardly depends on the size. Smaller
/// thresholds need more evaluations: if the constant part or the growing part were smaller, the slowest view of the
/// report would take more than 14.4 evaluations per ray. A smaller constant part with a larger growing part gives more wrong faces for an
/// equal number of evaluations.
pub const DEFAULT_TUNING: Tuning = Tuning::with(Quality::Balanced.preset().faces);

/// Default tuning for round fields and oblique faces, whose silhouettes and sphere normals reveal errors in the position of a hit.
pub const ROUND_TUNING: Tuning = Tuning::with(Quality::Balanced.preset().round);

impl Tuning {
    const fn with(Threshold { base, footprint }: Threshold) -> Self {
        Self {
            threshold: base,
            footprint,
            cap: 255,
            far: FARTHEST,
        }
    }

    /// Tuning for a field and a picture quality.
    pub const fn of(field: &Field, quality: Quality) -> Self {
        let preset = quality.preset();
        if field.is_round() || field.has_octants() {
            Self::with(preset.round)
        } else {
            Self::with(preset.faces)
        }
    }
}

/// Debug colour of undecided rays: magenta.
const MARK: [u8; 3] = [255, 0, 255];

/// Options of drawing a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldOptions {
    /// Two eyes for a stereo picture, or `None` for one eye.
    pub stereo: Option<Stereo>,
    /// Whether rays march also in a field that is drawn by exits, to compare both, where they can ([`Marching::draws`](super::Marching::draws)).
    pub marches: bool,
    /// Precision of the march of rays.
    pub tuning: Tuning,
    /// Colours, without fog.
    pub palette: Palette,
    /// Direction to the first light, s1.14, of length 1, if it throws shadows.
    pub sun: Option<[i16; 3]>,
    /// Density of the fog per world unit: transmittance is e^(−density · z) at depth z. 0 is no fog.
    pub fog: U4_28,
}

impl FieldOptions {
    /// Default options, with the default tuning of the field.
    pub fn of(field: &Field) -> Self {
        Self {
            tuning: Tuning::of(field, Quality::default()),
            palette: Palette::of(field, Material::Normal, &Lighting::PLAIN, Background::White),
            ..Self::default()
        }
    }

    /// Options for a field, its appearance, a camera, one eye or two, and a picture quality.
    pub fn new(
        field: &Field,
        appearance: &Appearance,
        quality: Quality,
        stereo: Option<Stereo>,
        view: &View,
    ) -> Self {
        let &Appearance {
            material,
            fog,
            occlusion,
            undecided,
            shadow,
            ..
        } = appearance;
        let lighting = appearance.lighting().seen_from(view);
        let mut palette = Palette::of(field, material, &lighting, appearance.field_background());
        if occlusion {
            palette = palette.with_occlusion(field);
        }
        if undecided {
            palette.undecided = MARK;
        }
        Self {
            stereo,
            marches: false,
            palette,
            sun: lighting
                .lights
                .first()
                .filter(|_| shadow)
                .map(Light::direction),
            fog,
            tuning: Tuning::of(field, quality),
        }
    }
}

impl Default for FieldOptions {
    fn default() -> Self {
        Self {
            stereo: None,
            marches: false,
            tuning: DEFAULT_TUNING,
            palette: Palette::default(),
            sun: None,
            fog: U4_28::ZERO,
        }
    }
}
