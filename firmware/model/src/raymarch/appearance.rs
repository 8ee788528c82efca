//! How a field looks, as people say it, made into numbers.

use glint_core::appearance::Appearance;
use glint_core::field::Field;
use glint_core::stereo::Stereo;

use super::paint::Palette;
use super::setup::FieldOptions;

impl FieldOptions {
    /// A field of such an appearance, seen with one eye or two, and as finely as it is unless told.
    pub fn new(field: &Field, appearance: &Appearance, stereo: Option<Stereo>) -> Self {
        let &Appearance {
            material,
            background,
            fog,
            occlusion,
            ..
        } = appearance;
        let palette = Palette::new(material, &appearance.lighting(), background);
        Self {
            stereo,
            palette: if occlusion {
                palette.with_occlusion()
            } else {
                palette
            },
            fog,
            ..Self::of(field)
        }
    }
}
