//! Colour of a ray's end: a colour of the palette, darkened by the occlusion and blended with the fog.

use glint_core::field::Surface;
use glint_core::light::whole;

use super::end::{RayEnd, State};
use super::palette::Palette;
use super::setup::FieldSetup;

/// The colour of a ray's end, eight bits per channel.
pub fn paint(setup: &FieldSetup, palette: &Palette, end: &RayEnd) -> [u8; 3] {
    let (colour, light, fog) = match end.state {
        State::Undecided => return palette.undecided,
        State::Miss => (palette.zenith, 255, 255 - end.height),
        State::Hit(surface) => (
            surface_colour(setup, palette, end, surface),
            palette.occlusion[end.steps.min(255) as usize],
            palette.fog_at(end.depth),
        ),
    };
    let lit = colour.map(|part| ((i32::from(part) * whole(light)) >> 8) as u8);
    mixed(lit, palette.horizon, fog)
}

/// Colour of a hit before darkening: a face of the palette, a lit sphere, or a mixture of both on a fillet.
fn surface_colour(
    setup: &FieldSetup,
    palette: &Palette,
    end: &RayEnd,
    surface: Surface,
) -> [u8; 3] {
    let face = surface.face().map_or([0; 3], |face| match end.shadow {
        true => palette.shadows[usize::from(face) / 2 % 3],
        false => palette.faces[usize::from(face) % 8],
    });
    let Some(round) = lit(setup, palette, end, surface) else {
        return face;
    };
    mixed(face, round, surface.share())
}

/// Colour of the sphere that was hit, with light; `None` if the ray hit no sphere or fillet.
fn lit(setup: &FieldSetup, palette: &Palette, end: &RayEnd, surface: Surface) -> Option<[u8; 3]> {
    let (normal, number) = (end.normal?, surface.number()?);
    Some(palette.lights.shine_on(number, setup.spheres()?, normal))
}

/// Mixes two colours, rounded to nearest. `part` is the weight of `to` in 255ths.
pub(crate) fn mixed(from: [u8; 3], to: [u8; 3], part: u8) -> [u8; 3] {
    core::array::from_fn(|i| {
        let [from, to] = [from[i], to[i]].map(i32::from);
        (from + (((to - from) * whole(part) + 128) >> 8)) as u8
    })
}
