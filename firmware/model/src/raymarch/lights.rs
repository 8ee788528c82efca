//! Light on what is round, whose normals are different at every point: ambient light and that of some directions.

use glint_core::field::{FixedSphere, MAX_SPHERES};
use glint_core::light::{Lighting, MAX_LIGHTS, Material, Rgb};

/// Light from one direction, and what there is of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Light {
    /// Towards the light, s1.16, of length 1 at most.
    pub direction: [i32; 3],
    /// Its colour, eight bits a channel.
    pub colour: Rgb,
}

/// The lights of a frame and what they shine on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lights {
    /// What comes from everywhere, eight bits a channel.
    pub ambient: Rgb,
    /// The first `count` of them shine.
    pub list: [Light; MAX_LIGHTS],
    /// 1 to 4. The gateware takes a clock for each.
    pub count: usize,
    /// The spheres' colours, by their numbers.
    pub materials: [Rgb; MAX_SPHERES],
}

impl Lights {
    /// The lights of a scene on spheres of a material. Spheres that are to be told apart by their colours need some light to
    /// be round: where there is none, it is day.
    pub fn new(material: Material, lighting: &Lighting) -> Self {
        let day = Lighting::day();
        let lighting = match material {
            Material::Normal if lighting.lights.is_empty() => &day,
            _ => lighting,
        };
        let mut list = [Light::default(); MAX_LIGHTS];
        for (place, light) in list.iter_mut().zip(&lighting.lights) {
            *place = Light {
                // Two fraction bits more.
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

/// 255 is the whole.
pub(super) const fn whole(part: u8) -> i32 {
    part as i32 + (part >> 7) as i32
}

impl Lights {
    /// A sphere's material in the light at a point, by the point as seen from its centre: (ambient + Σ max(0, n·l)·colour) times the
    /// material, where n is the point over the radius.
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

/// The cosine between the normal and a direction in 256ths, rounded down, 0 if it is negative: 256 is the most.
fn cosine(sphere: &FixedSphere, from_centre: [i32; 3], direction: [i32; 3]) -> i32 {
    let product: i64 = core::iter::zip(from_centre, direction)
        .map(|(a, b)| i64::from(a) * i64::from(b))
        .sum();
    // The radius, shifted alike, has 21 bits; so this has 17 where it is not beyond the sphere.
    let size = (product.max(0) >> sphere.shift).min((1 << 17) - 1);
    ((size * i64::from(sphere.inverse)) >> 25).min(256) as i32
}
