//! What is said of how a field looks, beside its shape.

use heapless::Vec;

use crate::fixed::U4_28;
use crate::light::{Background, Light, Lighting, MAX_LIGHTS, Material, Rgb};

/// How a field looks. By default each face is in the colour of its normal, in front of white.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Appearance {
    /// What it is made of.
    pub material: Material,
    /// What shines on it; without any, what shows the material best.
    pub lights: Vec<Light, MAX_LIGHTS>,
    /// The light that comes from everywhere; unless told, what goes with the lights.
    pub ambient: Option<Rgb>,
    /// What is behind it.
    pub background: Background,
    /// How dense the fog is: e^−z of something is left that is z/density world units away. 0 is none.
    pub fog: U4_28,
    /// Whether narrow places are darkened.
    pub occlusion: bool,
}

impl Appearance {
    /// All of its light.
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
