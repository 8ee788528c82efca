//! Colour of a ray's end: a colour of the palette, darkened by the ray's number of steps and blended with the fog.

use glint_core::field::Surface;
use glint_core::light::whole;

use super::palette::Palette;
use super::ray::{Ray, RayResult, State};
use super::setup::FieldSetup;

/// The colour of a ray's end, eight bits per channel.
pub fn paint(setup: &FieldSetup, palette: &Palette, ray: &Ray, outcome: &RayResult) -> [u8; 3] {
    let (colour, light, fog) = match outcome.state {
        State::Undecided => return palette.undecided,
        State::Miss => {
            // The sky's colour depends on the upper 8 of the 17 fraction bits of the direction's component along z.
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

/// Colour of a hit before darkening: a face of the palette, a lit sphere, or a mixture of both on a fillet.
fn surface_colour(
    setup: &FieldSetup,
    palette: &Palette,
    ray: &Ray,
    outcome: &RayResult,
    surface: Surface,
) -> [u8; 3] {
    let face = surface
        .face()
        .map_or([0; 3], |face| palette.faces[usize::from(face) % 8]);
    let Some(round) = lit(setup, palette, ray, outcome) else {
        return face;
    };
    mixed(face, round, surface.share())
}

/// Colour of the lit sphere that was hit; `None` if the ray hit no sphere or fillet.
fn lit(setup: &FieldSetup, palette: &Palette, ray: &Ray, outcome: &RayResult) -> Option<[u8; 3]> {
    let State::Hit(surface) = outcome.state else {
        return None;
    };
    let (normal, number) = (setup.normal(ray, outcome)?, surface.number()?);
    let sphere = setup.spheres()?.list.get(usize::from(number))?;
    Some(palette.lights.shine_on(number, sphere, normal))
}

/// Mixes two colours, rounded to nearest. `part` is the weight of `to`: 255 gives only `to`.
fn mixed(from: [u8; 3], to: [u8; 3], part: u8) -> [u8; 3] {
    core::array::from_fn(|i| {
        let [from, to] = [from[i], to[i]].map(i32::from);
        (from + (((to - from) * whole(part) + 128) >> 8)) as u8
    })
}

impl FieldSetup {
    /// The normal at a hit on a sphere, in field units with 12 fraction bits; it is about as long as the radius. `None`
    /// if the ray hit no sphere or fillet.
    pub fn normal(&self, ray: &Ray, outcome: &RayResult) -> Option<[i32; 3]> {
        let State::Hit(surface) = outcome.state else {
            return None;
        };
        let (spheres, number) = (self.spheres()?, surface.number()?);
        let sphere = spheres.list.get(usize::from(number))?;
        Some(spheres.from(sphere, self.point(ray, outcome.t)))
    }
}
