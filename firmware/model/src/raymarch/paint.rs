//! What a ray's end looks like: a colour of the palette, darkened by the steps that it took, faded by the fog.

use glint_core::fixed::U4_28;
use glint_core::light::{Background, Lighting, Material};

use super::field::Surface;
use super::light::{Light, Lights, whole};
use super::ray::{Ray, RayResult, State};
use super::setup::FieldSetup;

/// The colours of a frame, made by whoever knows materials and lights; eight bits a channel. With two eyes only the
/// luminance counts, so all channels of a colour are the same then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Of the faces, by [`Surface::face`](super::Surface::face), after their light.
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
        Self::new(Material::Normal, &Lighting::PLAIN, Background::White)
    }
}

impl Palette {
    /// Faces of a material in some light, in front of a background, without fog or shadows.
    pub fn new(material: Material, lighting: &Lighting, background: Background) -> Self {
        let [zenith, horizon] = background.colours();
        Self {
            faces: lighting.shine_on(&material.faces()),
            lights: Lights::new(material, lighting),
            undecided: [255, 0, 255],
            zenith,
            horizon,
            fog: [0; 256],
            fog_shift: 3,
            occlusion: [255; 256],
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

    /// With fog that leaves e^(−density·z) of what is z world units away along n. An entry is that of the middle of its
    /// depths, within 0.51; the last one is that of everything behind it too.
    #[must_use]
    pub fn with_fog(self, setup: &FieldSetup, density: U4_28) -> Self {
        // The smallest step of 256 that come to e^−8, or the largest that there is.
        const ENOUGH: u64 = 8 << 32;
        let unit = fog_of_unit(setup, density);
        let fog_shift = (0..7).find(|shift| unit << (shift + 8) >= ENOUGH);
        let fog_shift = fog_shift.unwrap_or(7);
        // Half a step first, then whole ones.
        let half = faded((unit << fog_shift) / 2);
        let whole = product(half, half);
        let mut left = half;
        Self {
            fog: core::array::from_fn(|_| {
                let hidden = FULL - left;
                left = product(left, whole);
                ((u128::from(hidden) * 255 + (1 << 61)) >> 62) as u8
            }),
            fog_shift,
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

/// 1 with 62 fraction bits.
const FULL: u64 = 1 << 62;

/// Of two numbers with 62 fraction bits.
fn product(a: u64, b: u64) -> u64 {
    ((u128::from(a) * u128::from(b)) >> 62) as u64
}

/// What a field unit times 2^e adds to the exponent of the fog, 32 fraction bits, rounded down: below 2^35.
fn fog_of_unit(setup: &FieldSetup, density: U4_28) -> u64 {
    let units = setup.scale.to_bits().max(1) as u128;
    // 28 and 36 over 32 fraction bits.
    (((u128::from(density.to_bits()) << 36) / units) >> setup.exponent) as u64
}

/// e^−x, 62 fraction bits, of x with 32: (1 − x/2^20)^(2^20), smaller by a part of x²/2^21, and 0 from 16 on.
fn faded(x: u64) -> u64 {
    if x >= 16 << 32 {
        return 0;
    }
    (0..20).fold(FULL - (x << 10), |power, _| product(power, power))
}

/// The colour of a ray's end, eight bits a channel.
pub fn paint(setup: &FieldSetup, palette: &Palette, ray: &Ray, outcome: &RayResult) -> [u8; 3] {
    let (colour, light, fog) = match outcome.state {
        State::Undecided => return palette.undecided,
        State::Miss => {
            // The sine of the height, 8 bits of its 17.
            let height = ray.direction[2].max(0) >> 9;
            (palette.zenith, 255, 255 - height.min(255) as u8)
        }
        State::Hit(surface) => {
            let depth = setup.depth_of(ray, outcome.reached()) >> (21 + palette.fog_shift);
            (
                surface_colour(setup, palette, ray, outcome, surface),
                palette.occlusion[outcome.steps.min(255) as usize],
                palette.fog[depth.min(255) as usize],
            )
        }
    };
    let lit = colour.map(|part| ((i32::from(part) * whole(light)) >> 8) as u8);
    mixed(lit, palette.horizon, fog)
}

/// The colour of a hit before it is darkened: a face's of the palette, a sphere's in its light, or what is between them.
fn surface_colour(
    setup: &FieldSetup,
    palette: &Palette,
    ray: &Ray,
    outcome: &RayResult,
    surface: Surface,
) -> [u8; 3] {
    let face = surface
        .face()
        .map_or([0; 3], |face| palette.faces[usize::from(face) % 6]);
    let Some(round) = lit(setup, palette, ray, outcome) else {
        return face;
    };
    mixed(face, round, surface.share())
}

/// The colour of something round in its light.
fn lit(setup: &FieldSetup, palette: &Palette, ray: &Ray, outcome: &RayResult) -> Option<[u8; 3]> {
    let State::Hit(surface) = outcome.state else {
        return None;
    };
    let (normal, number) = (setup.normal(ray, outcome)?, surface.number()?);
    let ball = setup.balls()?.list.get(usize::from(number))?;
    Some(palette.lights.shine_on(number, ball, normal))
}

/// From one colour a part of the way to another one, to nearest: 255 is all of it.
fn mixed(from: [u8; 3], to: [u8; 3], part: u8) -> [u8; 3] {
    core::array::from_fn(|i| {
        let [from, to] = [from[i], to[i]].map(i32::from);
        (from + (((to - from) * whole(part) + 128) >> 8)) as u8
    })
}
