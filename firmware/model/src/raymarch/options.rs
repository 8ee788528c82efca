//! Options for drawing a field: colours, fog, one eye or two, and the precision of marching rays.

use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::U4_28;
use glint_core::light::{Background, Light, Lighting, Material};
use glint_core::quality::{Quality, Threshold};
use glint_core::stereo::Stereo;

use super::palette::Palette;

/// Precision of marching rays, a trade-off between the errors and the drawing time of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tuning {
    /// A ray hits at the depth z if the distance is below `threshold` + z·2^−`footprint`. In field units with 12 fraction bits, below 2^16.
    pub threshold: u32,
    /// Exponent of the part of the threshold that grows with the depth, 7 to 15.
    pub footprint: u32,
    /// Step limit, 1 to 1023: a ray ends undecided after this number of evaluations.
    pub cap: u32,
}

impl Tuning {
    /// Returns the precision for a picture quality.
    pub const fn of(quality: Quality) -> Self {
        let Threshold { base, footprint } = quality.preset().threshold;
        Self {
            threshold: base,
            footprint,
            cap: 1020,
        }
    }
}

impl Default for Tuning {
    fn default() -> Self {
        Self::of(Quality::default())
    }
}

/// Debug colour of undecided rays: magenta.
const MARK: [u8; 3] = [255, 0, 255];

/// Options for drawing a field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FieldOptions {
    /// Two eyes for a stereo picture, or `None` for one eye.
    pub stereo: Option<Stereo>,
    /// Precision of marching rays.
    pub tuning: Tuning,
    /// Colours of the picture before fog is added.
    pub palette: Palette,
    /// Direction to the first light, a unit vector, s1.14; `None` if the light casts no shadows.
    pub sun: Option<[i16; 3]>,
    /// Density of the fog per world unit: transmittance is e^(−density · z) at depth z. 0 is no fog.
    pub fog: U4_28,
}

impl FieldOptions {
    /// Returns the default options for a field.
    pub fn of(field: &Field) -> Self {
        Self {
            palette: Palette::of(field, Material::Normal, &Lighting::PLAIN, Background::White),
            ..Self::default()
        }
    }

    /// Returns the options for a field with this appearance, camera, number of eyes and picture quality.
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
            palette,
            sun: lighting
                .lights
                .first()
                .filter(|_| shadow)
                .map(Light::direction),
            fog,
            tuning: Tuning::of(quality),
        }
    }
}
