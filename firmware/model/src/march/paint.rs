//! What a ray's end looks like: a colour of the palette, darkened by the steps that it took, faded by the fog.

use super::light::{Light, Lights, whole};
use super::ray::{Outcome, Ray, State};
use super::setup::Setup;

/// The colours of a frame, made by whoever knows materials and lights; eight bits a channel. With two eyes only the
/// luminance counts, so all channels of a colour are the same then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Of the faces, by [`Surface::code`](super::Surface::code), after their light.
    pub faces: [[u8; 3]; 6],
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
        Self {
            faces: [
                [40, 130, 130],
                [230, 130, 130],
                [130, 40, 130],
                [130, 230, 130],
                [130, 130, 40],
                [130, 130, 230],
            ],
            lights: Lights::default(),
            undecided: [255, 0, 255],
            zenith: [255; 3],
            horizon: [255; 3],
            fog: [0; 256],
            fog_shift: 3,
            occlusion: [255; 256],
        }
    }
}

impl Palette {
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

/// The colour of a ray's end, eight bits a channel.
pub fn paint(setup: &Setup, palette: &Palette, ray: &Ray, outcome: &Outcome) -> [u8; 3] {
    let (colour, light, fog) = match outcome.state {
        State::Undecided => return palette.undecided,
        State::Miss => {
            // The sine of the height, 8 bits of its 17.
            let height = ray.direction[2].max(0) >> 9;
            (palette.zenith, 255, 255 - height.min(255) as u8)
        }
        State::Hit(surface) => {
            let depth = setup.depth_of(ray, outcome.t) >> (21 + palette.fog_shift);
            (
                lit(setup, palette, ray, outcome)
                    .unwrap_or(palette.faces[usize::from(surface.code()) % 6]),
                palette.occlusion[outcome.steps.min(255) as usize],
                palette.fog[depth.min(255) as usize],
            )
        }
    };
    let [light, fog] = [light, fog].map(whole);
    core::array::from_fn(|i| {
        let lit = (i32::from(colour[i]) * light) >> 8;
        let faded = lit + (((i32::from(palette.horizon[i]) - lit) * fog + 128) >> 8);
        faded as u8
    })
}

/// The colour of something round before it is darkened.
fn lit(setup: &Setup, palette: &Palette, ray: &Ray, outcome: &Outcome) -> Option<[u8; 3]> {
    let State::Hit(surface) = outcome.state else {
        return None;
    };
    let (normal, number) = (setup.normal(ray, outcome)?, surface.number()?);
    let ball = setup.balls()?.list.get(usize::from(number))?;
    Some(palette.lights.shine_on(number, ball, normal))
}
