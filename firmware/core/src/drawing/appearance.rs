//! Appearance of distance fields, and lighting, background and fog of meshes.

use heapless::Vec;

use crate::fixed::U4_28;
use crate::light::{
    Background, Highlight, Light, Lighting, MAX_LIGHTS, Material, MeshLighting, Rgb,
};

/// Appearance of a distance field: material, lights, background and fog. By default each face has a colour that depends on its
/// normal, and the background is white. Lights, ambient light, background and fog also apply to meshes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Appearance {
    /// Material of the solid.
    pub material: Material,
    /// Lights; an empty list selects the default lights of the material.
    pub lights: Vec<Light, MAX_LIGHTS>,
    /// Ambient light; `None` selects the default ambient light.
    pub ambient: Option<Rgb>,
    /// Highlight of the first light on a field.
    pub highlight: Option<Highlight>,
    /// Whether the first light casts shadows in a field.
    pub shadow: bool,
    /// Background; `None` selects white for a field, and the board's default for meshes.
    pub background: Option<Background>,
    /// Density of the fog per world unit: over a distance d, the fog transmits the fraction exp(−d · density) of the light. 0
    /// means no fog.
    pub fog: U4_28,
    /// Whether surfaces are darker where other surfaces are close.
    pub occlusion: bool,
    /// Whether rays that end at the step limit are magenta instead of the colour of the horizon.
    pub undecided: bool,
}

impl Appearance {
    /// Returns the ambient light and the lights of this appearance, with defaults for unset values.
    pub fn lighting(&self) -> Lighting {
        let lighting = if self.lights.is_empty() {
            self.material.light()
        } else {
            Lighting {
                ambient: Lighting::AMBIENT,
                lights: self.lights.clone(),
                ..Lighting::PLAIN
            }
        };
        Lighting {
            ambient: self.ambient.unwrap_or(lighting.ambient),
            highlight: self.highlight,
            ..lighting
        }
    }

    /// Whether fields have a highlight, which requires lights.
    pub fn has_highlight(&self) -> bool {
        let lighting = self.lighting();
        lighting.highlight.is_some() && !lighting.lights.is_empty()
    }

    /// Whether fields may have shadows, which require lights.
    pub fn has_shadows(&self) -> bool {
        self.shadow && !self.lighting().lights.is_empty()
    }

    /// Returns the lighting of meshes: the first light, or white light at the camera if the list is empty. The default ambient
    /// light is [`Lighting::AMBIENT`] with a light in the list, and black for an empty list.
    pub fn mesh_lighting(&self) -> MeshLighting {
        let lighting = match self.lights.first() {
            Some(&light) => MeshLighting {
                ambient: Lighting::AMBIENT,
                light,
            },
            None => MeshLighting::CAMERA,
        };
        MeshLighting {
            ambient: self.ambient.unwrap_or(lighting.ambient),
            ..lighting
        }
    }

    /// The background of a field: the set background, by default white.
    pub fn field_background(&self) -> Background {
        self.background.unwrap_or(Background::White)
    }
}
