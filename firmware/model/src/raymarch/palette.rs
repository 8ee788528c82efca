//! The palette: the colours of a frame with a distance field.

use glint_core::colour::luminance;
use glint_core::field::Field;
use glint_core::light::{Background, Lighting, Material};

use super::exits::Exits;
use super::lights::Lights;

/// The colours of a frame, computed from materials and lights; eight bits per channel. With two eyes the colours are grey: all channels
/// have the luminance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Lit colours of the faces, by [`Surface::face`](glint_core::field::Surface::face): six perpendicular to the axes,
    /// or eight perpendicular to the diagonals.
    pub faces: [[u8; 3]; 8],
    /// Lit colours of the faces perpendicular to each axis that are in the shadow of the first light.
    pub shadows: [[u8; 3]; 3],
    /// Lights on the spheres, and materials of the spheres.
    pub lights: Lights,
    /// Colour of an undecided ray, which has reached its step limit. This is the horizon's colour, because most undecided rays run along a
    /// face into the distance, where fog and sky also have the horizon's colour.
    pub undecided: [u8; 3],
    /// Colour of the sky at the zenith.
    pub zenith: [u8; 3],
    /// Colour of the sky at the horizon and below, and of the fog.
    pub horizon: [u8; 3],
    /// Fraction of a surface's colour that fog replaces, in 255ths, by the hit's depth along n ([`fog_at`](Self::fog_at)).
    pub fog: [u8; 256],
    /// The table `fog` covers depths up to 2^(8 + `fog_shift`); 0 to 7. Depths are in field units multiplied by 2^e
    /// (docs/formats/raymarch.md, "Rays" and "Ends").
    pub fog_shift: u32,
    /// Fraction of the light that occlusion leaves at a surface, in 255ths. The index is the number of steps of the ray, because rays take
    /// many steps in narrow gaps.
    pub occlusion: [u8; 256],
}

impl Default for Palette {
    /// Faces coloured by their normals on a white background, without fog or occlusion.
    fn default() -> Self {
        Self::new(Material::Normal, &Lighting::PLAIN, Background::White)
    }
}

impl Palette {
    /// Faces of a material in the given light on a background, without fog or occlusion.
    pub fn new(material: Material, lighting: &Lighting, background: Background) -> Self {
        let [zenith, horizon] = background.colours();
        let faces = material.faces();
        Self {
            faces: {
                let [a, b, c, d, e, f] = lighting.shine_on(&faces);
                [a, b, c, d, e, f, [0; 3], [0; 3]]
            },
            shadows: lighting.shadows(&faces),
            lights: Lights::new(material, lighting),
            undecided: horizon,
            zenith,
            horizon,
            fog: [0; 256],
            fog_shift: 3,
            occlusion: [255; 256],
        }
    }

    /// As [`new`](Self::new), for a field whose faces may be perpendicular to the diagonals.
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

    /// Adds ambient occlusion, which darkens narrow gaps: the remaining light is 255·h/(h + n), rounded down. For marching rays, h is 40
    /// and n is the number of steps. For rays by exits, which take far fewer steps, h is 6 and n is the number of steps before the last
    /// one, so a surface that the first step reaches is not darkened.
    #[must_use]
    pub fn with_occlusion(self, field: &Field) -> Self {
        let (half, last) = if Exits::draws(field) { (6, 1) } else { (40, 0) };
        let share = |steps: usize| 255 * half / (half + steps.saturating_sub(last));
        Self {
            occlusion: core::array::from_fn(|steps| share(steps) as u8),
            ..self
        }
    }

    /// Replaces each colour by the grey of its luminance, for two eyes.
    #[must_use]
    pub fn grey(self) -> Self {
        let grey = |colour| [luminance(colour); 3];
        Self {
            faces: self.faces.map(grey),
            shadows: self.shadows.map(grey),
            lights: self.lights.grey(),
            undecided: grey(self.undecided),
            zenith: grey(self.zenith),
            horizon: grey(self.horizon),
            ..self
        }
    }
}
