//! Textures on triangles (docs/formats/texture.md, "On a triangle"): the planes of the coordinates, and the colour of a pixel.

use core::ops::RangeInclusive;

use glint_core::colour::{Rgb565, Rounding};
use glint_core::feature::TEXTURE;
use glint_core::mesh::{Attribute, Mesh, Triangle};
use glint_core::records::TextureCoordinates;
use glint_core::texture::{Filter, Texture, Wrap};

use crate::triangle::quotient::{CHANNEL_BITS, LARGEST};
use crate::triangle::setup::{Oriented, Plane, Setup, WEIGHT};
use crate::triangle::shade::HALF_CODE;

/// Number of fraction bits of a coordinate in the mesh, s16.16.
const COORDINATE_BITS: u32 = 16;
/// Number of fraction bits of σ, the fraction of a coordinate's range, u0.17.
const SHARE_BITS: u32 = 17;
/// Largest base-2 logarithm of the range of a coordinate on a triangle.
const MAX_RANGE_LOG2: u32 = 15;
/// Range of the offsets to which a clamped coordinate on a triangle is relative, in periods of two repeats. With the last offset, the
/// coordinate exceeds 1 everywhere on the triangle.
const PERIODS: RangeInclusive<i64> = -8..=1;
/// Number of fraction bits of a position in texels.
const PLACE_BITS: u32 = 8;
/// Number of bits of a weight in bilinear filtering.
const WEIGHT_BITS: u32 = 4;

/// A triangle with a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Textured<'a> {
    /// The texture to draw.
    pub texture: Texture<'a>,
    /// The planes of the coordinates s and t.
    pub axes: [Axis; 2],
    /// Light of each channel under flat shading, u0.8, as for [`lit`].
    pub light: [u8; 3],
    /// The weight of the coordinates in orthographic projection, in the format of the depth accumulator.
    pub weight: Option<u32>,
}

/// The texture of a triangle in a descriptor: a [`Textured`] with the number of the texture in the frame's table in place of the texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OfTexture {
    /// Number of the texture in the frame's table, from 1.
    pub number: u8,
    /// The planes of the coordinates s and t.
    pub axes: [Axis; 2],
    /// Light of each channel under flat shading, u0.8, as for [`lit`].
    pub light: [u8; 3],
    /// The weight of the coordinates in orthographic projection.
    pub weight: Option<u32>,
}

impl OfTexture {
    /// Replaces the number of the texture by the texture.
    pub fn with<'a>(&self, texture: Texture<'a>) -> Textured<'a> {
        Textured {
            texture,
            axes: self.axes,
            light: self.light,
            weight: self.weight,
        }
    }
}

/// The textures on a mesh, and the texture coordinates of the vertices.
#[derive(Clone, Copy, Debug)]
pub struct MeshTextures<'a> {
    mesh: Mesh<'a>,
    /// The replacement texture, drawn in place of the textures of the mesh.
    replacement: Option<&'a Texture<'a>>,
    coordinates: &'a [u8],
}

impl<'a> MeshTextures<'a> {
    /// The textures of a mesh, or a replacement texture for all of them; `None` if the mesh has no textures or no texture coordinates, or
    /// if textures are not drawn.
    pub fn new(
        mesh: &Mesh<'a>,
        is_drawn: bool,
        replacement: Option<&'a Texture<'a>>,
    ) -> Option<Self> {
        if !(TEXTURE.is_built && is_drawn && mesh.has_textures()) {
            return None;
        }
        let coordinates = mesh.attribute(Attribute::TextureCoordinates)?;
        Some(Self {
            mesh: *mesh,
            replacement,
            coordinates,
        })
    }

    /// The texture of a triangle, and the coordinates s and t at its vertices; `None` for a triangle without a texture. `first` is the
    /// index in the mesh of the first vertex of the triangle's chunk.
    pub fn of(&self, first: usize, triangle: &Triangle) -> Option<(Texture<'a>, [[i32; 2]; 3])> {
        let number = usize::from(triangle.texture).checked_sub(1)?;
        let texture = match self.replacement {
            Some(texture) => *texture,
            None => self.mesh.textures().nth(number)?,
        };
        let coordinates = triangle.indices.map(|index| {
            let at = TextureCoordinates::BYTES * (first + usize::from(index));
            let element = self.coordinates.get(at..).and_then(<[u8]>::first_chunk);
            // Every vertex of a checked mesh has texture coordinates.
            let element = element.map_or(TextureCoordinates::default(), |element| {
                TextureCoordinates::from_bytes(element)
            });
            [element.s, element.t]
        });
        Some((texture, coordinates))
    }
}

/// One texture coordinate, s or t, on a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Axis {
    /// The plane of σ times the depth, or times a constant in orthographic projection. The coordinate is
    /// 2·`periods` + σ·2^`range_log2`.
    pub plane: Plane,
    /// Base-2 logarithm of the range of the coordinate, in repeats of the texture; 0 to 15.
    pub range_log2: u32,
    /// Offset of the coordinate in periods of two repeats, −8 to 1; used only for clamping.
    pub periods: i32,
}

impl<'a> Textured<'a> {
    /// Computes the planes of a triangle in perspective or, if `is_linear`, in orthographic projection. `coordinates` are the s and t of
    /// each vertex, s16.16, in the order of the vertices of `triangle`.
    ///
    /// Not inlined, so that triangles without textures do not load this code into the instruction cache.
    #[inline(never)]
    pub fn new(
        texture: Texture<'a>,
        triangle: &Oriented,
        setup: &Setup,
        coordinates: &[[i32; 2]; 3],
        light: [u8; 3],
        is_linear: bool,
    ) -> Self {
        Self {
            texture,
            axes: axes(triangle, setup, coordinates, is_linear),
            light,
            weight: weight(is_linear),
        }
    }

    /// Replaces the texture by its number in the frame's table, for a descriptor.
    pub fn numbered(&self, number: u8) -> OfTexture {
        OfTexture {
            number,
            axes: self.axes,
            light: self.light,
            weight: self.weight,
        }
    }

    /// The colour of a pixel, in the format of [`lit`]; `None` where the texture is transparent. `depth` is the depth accumulator plus half
    /// a code, `values` are the accumulators of the coordinates, `level` is the mip level, and `light` has the accumulators of the light
    /// under smooth shading.
    pub fn colour(
        &self,
        depth: u32,
        values: [u32; 2],
        level: u32,
        light: Option<[u32; 3]>,
        rounding: Rounding,
    ) -> Option<[u8; 3]> {
        let inverse = Inverse::of(self.weight.unwrap_or(depth));
        let texel = sample(&self.texture, level, self.places_by(&inverse, values))?;
        let light = match light {
            None => self.light,
            // Rounded to nearest. Light and coordinates have the same weight.
            Some(light) => [0, 1, 2].map(|i: usize| {
                let light = (inverse.share(light[i], 8 + 1) + 1) >> 1;
                light.min(LARGEST[i].into()) as u8
            }),
        };
        Some(lit(texel, light, rounding))
    }

    /// The position of a pixel in the texture, in texels of level 0 with 8 fraction bits, rounded down; `depth` and `values` as for
    /// [`colour`](Self::colour).
    pub fn places(&self, depth: u32, values: [u32; 2]) -> [i64; 2] {
        self.places_by(&Inverse::of(self.weight.unwrap_or(depth)), values)
    }

    fn places_by(&self, inverse: &Inverse, values: [u32; 2]) -> [i64; 2] {
        let sides = self.texture.size_log2();
        let wrap = self.texture.sampler().wrap;
        [0, 1].map(|i: usize| {
            let axis = &self.axes[i];
            let bits = axis.range_log2 + sides[i] + PLACE_BITS;
            let place = inverse.share(values[i], bits);
            match wrap[i] {
                Wrap::Clamp => {
                    place as i64 + (i64::from(axis.periods) << (sides[i] + PLACE_BITS + 1))
                }
                // Modulo 2^24 texels.
                Wrap::Repeat | Wrap::Mirror => (place as u32).into(),
            }
        })
    }

    /// The mip level of a pixel: the level at which neighbouring pixels are 0.75 to 1.5 texels apart, with an error of up to an eighth. The
    /// distance is the largest for both coordinates and both directions on the screen.
    pub fn level(&self, setup: &Setup, depth: u32, values: [u32; 2]) -> u32 {
        let last = self.texture.levels() - 1;
        if last == 0 {
            return 0;
        }
        let inverse = Inverse::of(self.weight.unwrap_or(depth));
        let depth_steps = match self.weight {
            None => [setup.depth.step_x, setup.depth.step_y],
            Some(_) => [0; 2],
        };
        let sides = self.texture.size_log2();
        let most = [0, 1].map(|i: usize| {
            let axis = &self.axes[i];
            let share = inverse.share(values[i], SHARE_BITS) as i64 & ((1 << SHARE_BITS) - 1);
            let change = |step: u32, depth_step: u32| {
                // The steps are truncated to multiples of 2^8, so that one DSP block computes each product.
                let [step, depth_step] = [step, depth_step].map(|step| i64::from(step as i32 >> 8));
                let change = (step << SHARE_BITS) - (share + 1) * depth_step;
                // The magnitude, less 1 for a negative number.
                (if change < 0 { !change } else { change }) as u64 >> CHANGE_CUT
            };
            let [across, down] = depth_steps;
            let most = change(axis.plane.step_x, across).max(change(axis.plane.step_y, down));
            let lead = most.max(1).ilog2();
            let unit = 8 + CHANGE_CUT - SHARE_BITS;
            // The code of a change in texels times the depth: the position of the leading bit, then the three bits below the leading bit.
            ((lead + unit + axis.range_log2 + sides[i]) << 3) + ((most << 3 >> lead) as u32 & 7)
        });
        level_of(most[0].max(most[1]), &inverse).min(last)
    }
}

/// The coordinates s and t on a triangle, as for [`Textured::new`].
pub fn axes(
    triangle: &Oriented,
    setup: &Setup,
    coordinates: &[[i32; 2]; 3],
    is_linear: bool,
) -> [Axis; 2] {
    let weights = if is_linear {
        [WEIGHT; 3]
    } else {
        triangle.vertices.map(|vertex| vertex.w)
    };
    [0, 1].map(|number: usize| Axis::new(triangle, setup, coordinates.map(|c| c[number]), weights))
}

/// The weight of coordinates in orthographic projection, which replaces the depth.
pub fn weight(is_linear: bool) -> Option<u32> {
    is_linear.then_some((WEIGHT + HALF_CODE) << 8)
}

impl Axis {
    fn new(triangle: &Oriented, setup: &Setup, coordinates: [i32; 3], weights: [u32; 3]) -> Self {
        let [a, b, c] = coordinates.map(i64::from);
        // The period of a mirrored texture is two repeats.
        let periods = a.min(b).min(c) >> (COORDINATE_BITS + 1);
        let [a, b, c] = [a, b, c].map(|x| (x - (periods << (COORDINATE_BITS + 1))) as u64);
        // A fraction of the range is below 63/64, like light, so the highest bits of an accumulator show whether the accumulator is just
        // below 0.
        let limit = |range_log2: u32| 63 << (COORDINATE_BITS + range_log2 - 6);
        let most = a.max(b).max(c);
        let mut range_log2 = 0;
        while most >= limit(range_log2) && range_log2 < MAX_RANGE_LOG2 {
            range_log2 += 1;
        }
        let [a, b, c] = [a, b, c].map(|x| x.min(limit(MAX_RANGE_LOG2) - 1));
        let weighted = |coordinate: u64, weight: u32| {
            // The fraction is exact for a range of at most two repeats.
            let share = ((coordinate << 2 >> range_log2) + 1) >> 1;
            let product = share * u64::from(weight + HALF_CODE);
            ((product + (1 << (SHARE_BITS - 1))) >> SHARE_BITS) as u32
        };
        let [x, y, z] = weights;
        Self {
            plane: Plane::new(
                triangle,
                [weighted(a, x), weighted(b, y), weighted(c, z)],
                setup.start(),
            ),
            range_log2,
            periods: periods.clamp(*PERIODS.start(), *PERIODS.end()) as i32,
        }
    }
}

/// Number of low bits that [`Textured::level`] removes from a change, so that 30 bits remain.
const CHANGE_CUT: u32 = 13;

/// `INVERSES[i]` is 2^20/(1 + i/512), rounded to nearest, u0.20, for i up to 512. The first entry is reduced by 3, so that every inverse is
/// below 1.
const INVERSES: [u32; 513] = {
    let mut table = [(1 << 20) - 3; 513];
    let mut i = 1;
    while i < table.len() {
        let d = 512 + i as u32;
        table[i] = ((1 << 30) + d) / (2 * d);
        i += 1;
    }
    table
};

/// The reciprocal of a depth, as a mantissa and an exponent.
struct Inverse {
    /// 1 divided by the depth's mantissa in [1, 2), u0.18.
    mantissa: u32,
    /// Number of leading zeros of the depth, at most 11.
    zeros: u32,
    /// The three bits of the depth below its leading 1.
    top: u32,
}

impl Inverse {
    fn of(depth: u32) -> Self {
        let zeros = depth.leading_zeros().min(11);
        let normalised = depth << zeros;
        let (i, part) = (
            (normalised >> 22 & 0x1FF) as usize,
            normalised >> 13 & 0x1FF,
        );
        // The index has 9 bits.
        let [from, to] = [i, i + 1].map(|i| INVERSES.get(i).copied().unwrap_or(0));
        let inverse = from - (((from - to) * part + (1 << 8)) >> 9);
        Self {
            mantissa: (inverse + 2) >> 2,
            zeros,
            top: normalised >> 28 & 7,
        }
    }

    /// An accumulator divided by the depth, with `bits` fraction bits, rounded down.
    fn share(&self, value: u32, bits: u32) -> u64 {
        // As for light, an accumulator whose highest six bits are ones is just below 0, and counts as 0.
        let value = if value >> 26 == 0x3F { 0 } else { value >> 8 };
        let product = u64::from(value) * u64::from(self.mantissa);
        // The product has 42 bits, of which 41 − `zeros` are fraction bits of the result.
        let fraction = 41 - self.zeros;
        if bits <= fraction {
            product >> (fraction - bits)
        } else {
            product << (bits - fraction)
        }
    }
}

/// The smallest level l, at least 0, with change/depth ≤ 1.5·2^l, where both numbers are truncated to their four leading bits. `most` is
/// the code of the change: the position of the leading bit, then in the three lowest bits the bits below the leading bit.
fn level_of(most: u32, inverse: &Inverse) -> u32 {
    let (lead, most, depth) = ((most >> 3) as i32, 8 + (most & 7), 8 + inverse.top);
    let depth_lead = 31 - inverse.zeros as i32;
    let more = if 2 * most > 3 * depth {
        1
    } else if 4 * most > 3 * depth {
        0
    } else {
        -1
    };
    (lead - depth_lead + more).max(0) as u32
}

/// The colour of a texture at a position in texels of level 0 with 8 fraction bits; `None` where the texture is transparent. A channel has
/// 8 bits: the 5 or 6 bits of RGB565, then fraction bits.
pub fn sample(texture: &Texture, level: u32, places: [i64; 2]) -> Option<[u8; 3]> {
    let (sides, level_sides) = (texture.size_log2(), texture.level_log2(level));
    let sampler = texture.sampler();
    let at = |place: [i64; 2]| {
        let place = [0, 1].map(|i: usize| {
            let place = place[i].clamp(i32::MIN.into(), i32::MAX.into());
            sampler.wrap[i].place(place as i32, level_sides[i])
        });
        texture.colour(level, place).map(Rgb565::channels)
    };
    let places = [0, 1].map(|i: usize| places[i] >> (sides[i] - level_sides[i]));
    let nearest = at(places.map(|place| place >> PLACE_BITS))?;
    match sampler.filter {
        Filter::Nearest => {
            let [r, g, b] = nearest;
            Some([r << 3, g << 2, b << 3])
        }
        Filter::Bilinear => {
            // Moves the position half a texel to the upper left, and adds half a unit of the weights for rounding.
            let corner = places.map(|place| place - 128 + 8);
            let [x, y] = corner.map(|place| place >> PLACE_BITS);
            let weights = corner.map(|place| (place >> WEIGHT_BITS & 0xF) as u32);
            // A transparent neighbour has the colour of the nearest texel.
            let texels = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]]
                .map(|place| at(place).unwrap_or(nearest));
            Some(average(texels, weights))
        }
    }
}

/// The weighted average of the channels of four neighbouring texels: (u, v), (u + 1, v), (u, v + 1), (u + 1, v + 1). `weights` are the
/// weights of u + 1 and v + 1, u0.4. A channel of the result has 8 bits, as in [`sample`].
pub fn average(neighbours: [[u8; 3]; 4], weights: [u32; 2]) -> [u8; 3] {
    [0, 1, 2].map(|channel: usize| {
        let [a, b, c, d] = neighbours.map(|texel| u32::from(texel[channel]));
        let between = |a: u32, b: u32, weight: u32| a * (16 - weight) + b * weight;
        let [across, down] = weights;
        let sum = between(between(a, b, across), between(c, d, across), down);
        let bits = CHANNEL_BITS[channel];
        // The sum has 8 fraction bits, of which 8 − `bits` remain.
        ((sum + (1 << (bits - 1))) >> bits) as u8
    })
}

/// Multiplies a colour of [`sample`] by the light of each channel, u0.8. The largest light is 31/32 for red and blue, and 63/64 for green,
/// and does not change the colour. A channel of the result has 8 bits, as in [`sample`].
pub fn lit(texel: [u8; 3], light: [u8; 3], rounding: Rounding) -> [u8; 3] {
    [0, 1, 2].map(|i: usize| {
        let light = u32::from(light[i]);
        // The light times 32/31 or 64/63, from its highest six bits.
        let most = (1 << CHANNEL_BITS[i]) - 1;
        let share = light + (2 * (light & !3) + most) / (2 * most);
        ((u32::from(texel[i]) * share + rounding.before_fractions(8)) >> 8) as u8
    })
}

/// The light of a flat triangle for [`lit`]: the colour of the triangle times the factor of each channel, u1.8.
pub fn flat_light(colour: Rgb565, shares: [u32; 3]) -> [u8; 3] {
    let channels = colour.channels();
    [0, 1, 2].map(|i: usize| {
        let bits = CHANNEL_BITS[i];
        let product = u32::from(channels[i]) * shares[i];
        ((product + (1 << (bits - 1))) >> bits) as u8
    })
}
