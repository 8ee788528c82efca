//! The register `sphere`: constants of spheres, of their lighting, of the faces 6 and 7, and of
//! shadows.

use glint_core::field::{FixedCone, FixedSphere, MAX_SPHERES};
use glint_core::light::MAX_LIGHTS;
use glint_model::raymarch::exits::{Inverse, Sun};
use glint_model::raymarch::{Blend, Light, Lights, Shine};
use litex_pac::raymarch::Sphere;
use litex_pac::register::Value;

/// The constants that writes to the register have set.
pub struct Spheres {
    pub list: [FixedSphere; MAX_SPHERES],
    lights: Lights,
    pub blend: Blend,
    /// The kinds of light: bit 0 is set for colours by normals, bit 1 for lights, bit 2 for a highlight.
    kinds: u32,
    highlight: Shine,
    /// Colours of the faces 6 and 7 of a field with eight faces.
    pub faces: [[u8; 3]; 2],
    /// Colours of faces in the shadow of the first light.
    pub shadows: [[u8; 3]; 3],
    /// The direction to the first light, s1.14, and the reciprocals of half its components, for shadows.
    direction: [i16; 3],
    inverse: [u32; 3],
    /// The constants of the light on a solid cone: the exponent and whether there is a cone, and the directions of the axes.
    cone: u32,
    axes: [i32; 2],
    /// The constants that the next write to an entry of `list` stores.
    next: FixedSphere,
}

impl Spheres {
    pub fn new() -> Self {
        Self {
            list: [FixedSphere::default(); MAX_SPHERES],
            lights: Lights {
                ambient: [0; 3],
                list: [Light::default(); MAX_LIGHTS],
                count: 1,
                materials: [[0; 3]; MAX_SPHERES],
                normals: None,
                axes: [1 << 16; 3],
                highlight: None,
            },
            kinds: 0,
            highlight: Shine::default(),
            blend: Blend::default(),
            faces: [[0; 3]; 2],
            shadows: [[0; 3]; 3],
            direction: [0; 3],
            inverse: [0; 3],
            cone: 0,
            axes: [0; 2],
            next: FixedSphere::default(),
        }
    }

    /// The lights of a frame: the lights with the numbers 0 to `last`. `is_stereo` states whether
    /// the frame has two eyes.
    pub fn lights(&self, last: u8, is_stereo: bool) -> Lights {
        let [has_normals, is_lit, has_highlight] = [0, 1, 2].map(|bit| self.kinds >> bit & 1 != 0);
        Lights {
            // Without colours by normals, there is at least one light.
            count: if is_lit || !has_normals {
                usize::from(last) + 1
            } else {
                0
            },
            normals: has_normals.then(|| Lights::components(is_stereo)),
            axes: match self.has_cone() {
                true => [self.axes[0], self.axes[0], self.axes[1]],
                false => [1 << 16; 3],
            },
            highlight: has_highlight.then_some(self.highlight),
            ..self.lights
        }
    }

    /// The solid cone whose lateral surface has this number, if there is one.
    pub fn cone(&self, number: usize) -> Option<FixedCone> {
        let [.., half] = self.list[number % MAX_SPHERES].centre;
        self.has_cone()
            .then(|| FixedCone::lit(half, self.cone & 0xF))
    }

    const fn has_cone(&self) -> bool {
        self.cone >> 4 & 1 == 1
    }

    /// The rays to the first light.
    pub fn sun(&self) -> Sun {
        Sun::with_inverse(self.direction, self.inverse.map(Inverse::of_word))
    }

    /// Processes a write to the register. Undefined entries have no effect.
    pub fn set(&mut self, value: u32) {
        let register = Sphere::from_bits(value);
        let (entry, value) = (usize::from(register.entry()), register.value());
        let signed = |bits: u32| (value << (32 - bits)) as i32 >> (32 - bits);
        match entry {
            0..=2 => self.next.centre[entry] = signed(23),
            3 => self.next.radius = (value & 0x1F_FFFF) as i32,
            4 => {
                self.next.inverse = value & 0x1_FFFF;
                self.next.shift = value >> 17 & 0x1F;
            }
            5 => self.lights.ambient = colour(value),
            6 => self.blend.width = value & 0x1_FFFF,
            7 => self.blend.inverse = value & 0x1_FFFF,
            8..=15 => {
                self.list[entry - 8] = self.next;
                self.lights.materials[entry - 8] = colour(value);
            }
            16..=31 => {
                let light = &mut self.lights.list[(entry - 16) / 4];
                match entry % 4 {
                    axis @ 0..=2 => light.direction[axis] = signed(18),
                    _ => light.colour = colour(value),
                }
            }
            32 | 33 => self.faces[entry - 32] = colour(value),
            34..=36 => self.highlight.light.direction[entry - 34] = signed(18),
            37 => {
                self.kinds = value & 7;
                self.highlight.steepness = (value >> 8 & 0x1FFF) as u16;
            }
            40..=42 => self.shadows[entry - 40] = colour(value),
            43..=45 => self.direction[entry - 43] = value as i16,
            46..=48 => {
                let inverse = &mut self.inverse[entry - 46];
                *inverse = *inverse & 0xFF00_0000 | value;
            }
            49..=51 => {
                let inverse = &mut self.inverse[entry - 49];
                *inverse = *inverse & 0x00FF_FFFF | value << 24;
            }
            38 => self.highlight.light.colour = colour(value),
            39 => self.cone = value & 0x1F,
            52 | 53 => self.axes[entry - 52] = signed(18),
            _ => {}
        }
    }
}

/// A colour: red in bits 0 to 7, then green, then blue.
pub const fn colour(value: u32) -> [u8; 3] {
    let [red, green, blue, _] = value.to_le_bytes();
    [red, green, blue]
}
