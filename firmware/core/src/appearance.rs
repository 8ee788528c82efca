//! Appearance of a field.

use heapless::Vec;

use crate::fixed::U4_28;
use crate::light::{Background, Light, Lighting, MAX_LIGHTS, Material, Rgb};

/// Appearance of a field. By default each face has the colour of its normal, on white.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Appearance {
    /// Material.
    pub material: Material,
    /// Lights; an empty list selects the material's own lights.
    pub lights: Vec<Light, MAX_LIGHTS>,
    /// Ambient light; `None` selects the default of the lights.
    pub ambient: Option<Rgb>,
    /// Background.
    pub background: Background,
    /// Density of the fog, per world unit: transmittance is exp(−distance · density). 0 is no fog.
    pub fog: U4_28,
    /// Whether ambient occlusion is on.
    pub occlusion: bool,
}

impl Appearance {
    /// The ambient light and the lights to draw with: the values of this appearance, or the defaults where it has none.
    pub fn lighting(&self) -> Lighting {
        let lighting = if self.lights.is_empty() {
            self.material.light()
        } else {
            Lighting {
                ambient: Lighting::AMBIENT,
                lights: self.lights.clone(),
            }
        };
        Lighting {
            ambient: self.ambient.unwrap_or(lighting.ambient),
            ..lighting
        }
    }
}
