//! The colours of a frame.

use glint_core::field::Field;
use glint_core::light::{Background, Lighting, Material};

use super::lights::{Light, Lights};

/// The colours of a frame, made by whoever knows materials and lights; eight bits a channel. With two eyes only the
/// luminance counts, so all channels of a colour are the same then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Of the faces, by [`Surface::face`](glint_core::field::Surface::face), after their light: six across the axes, or eight across the
    /// diagonals.
    pub faces: [[u8; 3]; 8],
    /// Of what is round.
    pub lights: Lights,
    /// Of a ray that was given up.
    pub undecided: [u8; 3],
    /// Of the sky above.
    pub zenith: [u8; 3],
    /// Of the sky at the horizon and below, and of the fog.
    pub horizon: [u8; 3],
    /// How much of a surface the fog hides, of 255, by its depth in steps of 2^`fog_shift` field units times 2^e.
    pub fog: [u8; 256],
    /// See `fog`: 0 to 7.
    pub fog_shift: u32,
    /// How much light is left at a surface, of 255, by the steps that the ray took: many lie in narrow places.
    pub occlusion: [u8; 256],
}

impl Default for Palette {
    /// Faces in the colours of their normals, in front of white, without fog or shadows.
    fn default() -> Self {
        Self::new(Material::Normal, &Lighting::PLAIN, Background::White)
    }
}

impl Palette {
    /// Faces of a material in some light, in front of a background, without fog or shadows.
    pub fn new(material: Material, lighting: &Lighting, background: Background) -> Self {
        let [zenith, horizon] = background.colours();
        Self {
            faces: {
                let [a, b, c, d, e, f] = lighting.shine_on(&material.faces());
                [a, b, c, d, e, f, [0; 3], [0; 3]]
            },
            lights: Lights::new(material, lighting),
            undecided: [255, 0, 255],
            zenith,
            horizon,
            fog: [0; 256],
            fog_shift: 3,
            occlusion: [255; 256],
        }
    }

    /// The same for a field, whose faces may be across the diagonals.
    pub fn of(
        field: &Field,
        material: Material,
        lighting: &Lighting,
        background: Background,
    ) -> Self {
        let palette = Self::new(material, lighting, background);
        if field.has_octants() {
            Self {
                faces: lighting.shine_on_octants(&material.octants()),
                ..palette
            }
        } else {
            palette
        }
    }

    /// With narrow places darkened: 255·40/(40 + steps) is left, rounded down.
    #[must_use]
    pub fn with_occlusion(self) -> Self {
        const HALF: u32 = 40;
        Self {
            occlusion: core::array::from_fn(|steps| (255 * HALF / (HALF + steps as u32)) as u8),
            ..self
        }
    }

    /// The luminance in all channels, which two eyes need.
    #[must_use]
    pub fn grey(self) -> Self {
        let grey = |[r, g, b]: [u8; 3]| {
            // Rec. 601: the weights are 256 together.
            [((77 * u32::from(r) + 150 * u32::from(g) + 29 * u32::from(b) + 128) >> 8) as u8; 3]
        };
        let lights = Lights {
            ambient: grey(self.lights.ambient),
            list: self.lights.list.map(|light| Light {
                colour: grey(light.colour),
                ..light
            }),
            materials: self.lights.materials.map(grey),
            ..self.lights
        };
        Self {
            faces: self.faces.map(grey),
            lights,
            undecided: grey(self.undecided),
            zenith: grey(self.zenith),
            horizon: grey(self.horizon),
            ..self
        }
    }
}
