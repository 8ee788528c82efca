//! Ambient and directional light on spheres, whose normal varies from point to point.

use glint_core::field::{FixedSphere, MAX_SPHERES};
use glint_core::light::{Lighting, MAX_LIGHTS, Material, Rgb, whole};

/// A directional light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Light {
    /// Direction to the light, s1.16, of length 1 at most.
    pub direction: [i32; 3],
    /// Colour of the light, eight bits per channel.
    pub colour: Rgb,
}

/// The lights of a frame, and the materials of the spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lights {
    /// Ambient light, eight bits per channel.
    pub ambient: Rgb,
    /// Lights; the first `count` entries are valid.
    pub list: [Light; MAX_LIGHTS],
    /// Number of lights, 1 to 4. The gateware takes one clock for each light.
    pub count: usize,
    /// Material colours of the spheres, by sphere number.
    pub materials: [Rgb; MAX_SPHERES],
}

impl Lights {
    /// Returns the lights of a scene for spheres of the given material. For the material `Normal` without lights, returns daylight,
    /// because unshaded spheres look flat.
    pub fn new(material: Material, lighting: &Lighting) -> Self {
        let day = Lighting::day();
        let lighting = if material == Material::Normal && lighting.lights.is_empty() {
            &day
        } else {
            lighting
        };
        let mut list = [Light::default(); MAX_LIGHTS];
        for (place, light) in list.iter_mut().zip(&lighting.lights) {
            *place = Light {
                // Converts a direction from 14 to 16 fraction bits.
                direction: light.direction().map(|x| i32::from(x) << 2),
                colour: light.colour(),
            };
        }
        Self {
            ambient: lighting.ambient,
            list,
            count: lighting.lights.len().max(1),
            materials: material.spheres(),
        }
    }
}

impl Lights {
    /// Returns the colour of the lit sphere `number` at the point `from_centre`, relative to its centre: (ambient +
    /// Σ max(0, n·l)·colour) times the material. The normal n is `from_centre` divided by the radius, and l is the
    /// direction to a light.
    pub(super) fn shine_on(&self, number: u8, sphere: &FixedSphere, from_centre: [i32; 3]) -> Rgb {
        let mut sum = self.ambient.map(|part| i32::from(part) << 8);
        for light in self.list.iter().take(self.count) {
            let share = cosine(sphere, from_centre, light.direction);
            for (sum, part) in sum.iter_mut().zip(light.colour) {
                *sum += share * i32::from(part);
            }
        }
        let material = self.materials[usize::from(number) % MAX_SPHERES];
        core::array::from_fn(|i| {
            let light = (sum[i] >> 8).min(255) as u8;
            ((i32::from(material[i]) * whole(light)) >> 8) as u8
        })
    }
}

/// The cosine of the angle between the normal at the point `from_centre` of a sphere and a direction: 8 fraction bits,
/// rounded down, 0 if negative, at most 256.
fn cosine(sphere: &FixedSphere, from_centre: [i32; 3], direction: [i32; 3]) -> i32 {
    let product: i64 = core::iter::zip(from_centre, direction)
        .map(|(a, b)| i64::from(a) * i64::from(b))
        .sum();
    // A direction has length 1 and 16 fraction bits, so a shift by floor(log2 radius) leaves 17 bits of the product for
    // a point on the sphere.
    let size = (product.max(0) >> sphere.shift).min((1 << 17) - 1);
    ((size * i64::from(sphere.inverse)) >> 25).min(256) as i32
}
