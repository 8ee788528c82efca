//! Ambient and directional light on spheres and cones, whose normal varies from point to point.

use glint_core::colour::luminance;
use glint_core::field::{FixedCone, FixedSpheres, MAX_SPHERES};
use glint_core::light::{Lighting, MAX_LIGHTS, Material, Rgb, highlight_share, whole};

use super::exits::{Inverse, Words};

/// Each channel of [`Material::Normal`] on a sphere is this value plus [`SLOPE`] times a component of the normal.
const MIDDLE: u8 = 130;

/// Change of a channel per unit of a component of the normal ([`MIDDLE`]).
const SLOPE: u8 = 95;

/// A directional light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Light {
    /// Direction to the light, s1.16, of length 1 at most.
    pub direction: [i32; 3],
    /// Colour of the light, eight bits per channel.
    pub colour: Rgb,
}

/// The highlight of the first light: a power of the cosine between the normal and the direction halfway between the light and the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shine {
    /// The direction halfway between the light and the camera, and the colour of the highlight.
    pub light: Light,
    /// The steepness of the highlight, which determines the exponent of the power, u5.8.
    pub steepness: u16,
}

/// The lights of a frame, and the materials of the spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lights {
    /// Ambient light, eight bits per channel.
    pub ambient: Rgb,
    /// Lights; the first `count` entries are valid.
    pub list: [Light; MAX_LIGHTS],
    /// Number of lights, 0 to 4; 0 only with `normals`. The gateware takes one clock for each light.
    pub count: usize,
    /// Material colours of the spheres, by sphere number.
    pub materials: [Rgb; MAX_SPHERES],
    /// The colour by which each of the three components of a normal is multiplied, if the material's colour depends on the normal. The
    /// gateware takes one clock for each component.
    pub normals: Option<[Rgb; 3]>,
    /// The factors of a normal's components x, y and z for `normals`, s1.16; 1 in every valid frame.
    pub axes: [i32; 3],
    /// The highlight, which takes the gateware one more clock; `None` without a highlight.
    pub highlight: Option<Shine>,
}

impl Lights {
    /// The value of `normals` for [`Material::Normal`], or its luminances for two eyes.
    pub fn components(is_grey: bool) -> [Rgb; 3] {
        let colours = [[SLOPE, 0, 0], [0, SLOPE, 0], [0, 0, SLOPE]];
        if is_grey { colours.map(grey) } else { colours }
    }

    /// Returns the lights and materials for the spheres of a scene.
    pub fn new(material: Material, lighting: &Lighting) -> Self {
        let mut list = [Light::default(); MAX_LIGHTS];
        for (place, light) in list.iter_mut().zip(&lighting.lights) {
            *place = Light {
                direction: widened(light.direction()),
                colour: light.colour(),
            };
        }
        let count = lighting.lights.len();
        let normals = (material == Material::Normal).then(|| Self::components(false));
        Self {
            ambient: lighting.ambient,
            list,
            count: if normals.is_some() {
                count
            } else {
                count.max(1)
            },
            materials: material.spheres(),
            normals,
            axes: [1 << 16; 3],
            highlight: lighting
                .highlight
                .zip(lighting.lights.first())
                .map(|(highlight, light)| Shine {
                    light: Light {
                        direction: widened(lighting.half),
                        colour: highlight.colour(light.colour()),
                    },
                    steepness: highlight.steepness(),
                }),
        }
    }

    /// Replaces each colour by its luminance in all channels.
    pub(super) fn grey(self) -> Self {
        let grey_light = |light: Light| Light {
            colour: grey(light.colour),
            ..light
        };
        Self {
            ambient: grey(self.ambient),
            list: self.list.map(grey_light),
            highlight: self.highlight.map(|shine| Shine {
                light: grey_light(shine.light),
                ..shine
            }),
            materials: self.materials.map(grey),
            normals: self.normals.map(|_| Self::components(true)),
            ..self
        }
    }

    /// Returns the colour of the lit sphere or cone `number` at the point `place`, relative to its centre or apex: (ambient +
    /// Σ max(0, n·l)·colour) times the material, plus the highlight. The normal n of a sphere is `place` divided by the radius, and l is
    /// the direction to a light.
    pub fn shine_on(&self, number: u8, spheres: &FixedSpheres, place: [i32; 3]) -> Rgb {
        let (length, cone) = match spheres.cone(number) {
            Some(cone) => (Length::below_apex(cone, place), Some(cone)),
            None => {
                let sphere = &spheres.list[usize::from(number) % MAX_SPHERES];
                let (inverse, shift) = (sphere.inverse, sphere.shift);
                (Length { inverse, shift }, None)
            }
        };
        let cosine = |direction| {
            let direction = cone.map_or(direction, |cone| cone.lit_from(direction));
            length.cosine(place, direction)
        };
        let mut sum = Sum::of(self.ambient);
        for light in self.list.iter().take(self.count) {
            sum.add(light.colour, (cosine(light.direction).max(0) >> 8) as i32);
        }
        let material = match &self.normals {
            None => self.materials[usize::from(number) % MAX_SPHERES],
            Some(normals) => {
                let mut sum = Sum::of([MIDDLE; 3]);
                for (axis, colour) in normals.iter().enumerate() {
                    let mut direction = [0; 3];
                    direction[axis] = self.axes[axis];
                    sum.add(*colour, (cosine(direction) >> 8) as i32);
                }
                sum.colour()
            }
        };
        let highlight = self.highlight.map_or([0; 3], |Shine { light, steepness }| {
            let share = highlight_share(steepness, cosine(light.direction) as i32);
            let mut sum = Sum::of([0; 3]);
            sum.add(light.colour, whole(share));
            sum.colour()
        });
        let light = sum.colour();
        core::array::from_fn(|i| {
            let lit = (i32::from(material[i]) * whole(light[i])) >> 8;
            (lit + i32::from(highlight[i])).min(255) as u8
        })
    }
}

/// The grey colour with the luminance of a colour.
fn grey(colour: Rgb) -> Rgb {
    [luminance(colour); 3]
}

/// Converts a direction from 14 to 16 fraction bits.
fn widened(direction: [i16; 3]) -> [i32; 3] {
    direction.map(|x| i32::from(x) << 2)
}

/// A sum of colours, each multiplied by a share, with 8 fraction bits.
struct Sum([i32; 3]);

impl Sum {
    fn of(colour: Rgb) -> Self {
        Self(colour.map(|part| i32::from(part) << 8))
    }

    /// Adds a colour times a share with 8 fraction bits.
    fn add(&mut self, colour: Rgb, share: i32) {
        for (sum, part) in self.0.iter_mut().zip(colour) {
            *sum += share * i32::from(part);
        }
    }

    /// The sum, rounded down, 255 at most.
    fn colour(&self) -> Rgb {
        self.0.map(|part| (part >> 8).clamp(0, 255) as u8)
    }
}

/// The length of a normal, stored as a reciprocal, because scalar products are divided by it.
struct Length {
    /// 2^(17 + shift) divided by the length, 17 bits.
    inverse: u32,
    /// The base-2 logarithm of the length, rounded down; 6 to 21.
    shift: u32,
}

impl Length {
    /// The distance from a cone's apex along its axis, times 2^−`lead`. The argument is the vector from the apex to the lateral surface.
    fn below_apex(cone: &FixedCone, [_, _, z]: [i32; 3]) -> Self {
        let below = z.saturating_neg().clamp(1, (1 << 23) - 1).cast_unsigned();
        let Inverse { mantissa, exponent } = Inverse::of(below << 3, &Words::CHOSEN);
        // The reciprocal has 47 − `exponent` fraction bits.
        let inverse = mantissa >> (30 - exponent - below.ilog2() as i32);
        Self {
            inverse: inverse.min((1 << 17) - 1),
            shift: below.ilog2().saturating_sub(cone.lead).clamp(6, 21),
        }
    }

    /// The cosine of the angle between a normal and a direction: 16 fraction bits, its magnitude rounded down and at most 1. A negative
    /// cosine is the bitwise complement of its magnitude, as in the gateware.
    fn cosine(&self, normal: [i32; 3], direction: [i32; 3]) -> i64 {
        let product: i64 = core::iter::zip(normal, direction)
            .map(|(a, b)| i64::from(a) * i64::from(b))
            .sum();
        let sign = product >> 63;
        // A direction has length 1 and 16 fraction bits, so a shift by floor(log2 radius) leaves 17 bits of the product for
        // a point on the sphere.
        let size = ((product ^ sign) >> self.shift).min((1 << 17) - 1);
        ((size * i64::from(self.inverse)) >> 17).min(1 << 16) ^ sign
    }
}
