//! Recorded commands of the crate `embedded-3dgfx`, drawn by the triangle engine.
//!
//! `K3dengine::record` transforms a program's meshes to primitives in pixels, and `K3dengine::execute` rasterises them on the CPU. Here the
//! engine takes the place of `execute`: [`convert`] makes a list of [`Triangles`] of the primitives, which a picture shows.
//!
//! | primitive | drawn as |
//! |---|---|
//! | triangles with depth | triangles; a larger depth is farther |
//! | triangles without depth, lines, points | behind all depths before the first primitive with depth is recorded, in front of them after it |
//! | translucent and screen-door triangles | triangles that are blended, by the nearest eighth of their opacity |
//! | Gouraud triangles | triangles with the mean colour, or shaded smoothly by the soft core |
//! | lines, points | squares of one pixel, moved along the line |
//! | triangles with a texture or a light map | not drawn, but counted in the [`Outcome`] |
//!
//! A pixel belongs to a triangle if its middle does, and to one of two triangles with a common edge. The rasteriser of `embedded-3dgfx`
//! also draws the pixels on the right and lower edges. Fog, dithering, tints and the sky of a `K3dengine` are parts of its rasteriser; a
//! picture has its own background and samples.
#![no_std]
#![forbid(unsafe_code)]

use embedded_3dgfx::pipeline::assemble::primitive::DrawPrimitive;
use embedded_3dgfx::pipeline::command_buffer::{CommandBuffer, RenderCommand};
use embedded_graphics::pixelcolor::{self, IntoStorage};
use glint_program::core::colour::Rgb565;
use glint_program::core::picture::Size;
use glint_program::core::texture::Blend;
use glint_program::triangles::{Triangle, Triangles};

/// Depth of primitives that are behind all others.
const FARTHEST: u16 = u16::MAX;

/// Replaces the triangles of a list by those of recorded commands, in their order, for pictures of the size of the `K3dengine`.
///
/// ```
/// use embedded_3dgfx::engine::K3dengine;
/// use embedded_3dgfx::pipeline::command_buffer::CommandBuffer;
/// use embedded_3dgfx::pipeline::vertex::mesh::{K3dMesh, RenderMode};
/// use embedded_3dgfx::pipeline::vertex::shapes;
/// use glint_embedded_3dgfx::Outcome;
/// use glint_program::core::picture::Size;
/// use glint_program::triangles::Triangles;
///
/// let mut engine = K3dengine::new(640, 360);
/// engine.camera.set_position([0.0, 2.0, 5.0].into());
/// engine.camera.set_target([0.0; 3].into());
/// let cube = shapes::cube([1.0; 3]);
/// let mut mesh = K3dMesh::new(cube.geometry());
/// mesh.set_render_mode(RenderMode::Solid);
///
/// let mut commands = CommandBuffer::<64>::new();
/// engine.record([&mesh], &mut commands, None).unwrap();
/// let mut list = Triangles::<2>::new();
/// let outcome = glint_embedded_3dgfx::convert(&commands, &mut list, Size::W640);
/// assert_eq!(outcome, Outcome { beyond: 0, unknown: 0 });
/// // In `draw`, `picture.triangles(&list)` shows them.
/// ```
pub fn convert<const MAX: usize, const N: usize>(
    commands: &CommandBuffer<MAX>,
    list: &mut Triangles<N>,
    size: Size,
) -> Outcome {
    let depths_of_all = primitives(commands).filter_map(depths).flatten();
    // Saturated depths stay the farthest after the shift.
    let largest = depths_of_all.filter(|&depth| depth != u32::MAX).max();
    // The smallest shift after which every depth has 16 bits.
    let shift = (u32::BITS - largest.unwrap_or(0).leading_zeros()).saturating_sub(16);
    let mut outcome = Outcome::default();
    let mut has_depth = false;
    let mut new = list.replace(size);
    for primitive in primitives(commands) {
        let depths = match depths(primitive) {
            Some(depths) => {
                has_depth = true;
                // Between those of the primitives without depth, so 16 bits suffice.
                depths.map(|depth| (depth >> shift).clamp(1, (FARTHEST - 1).into()) as u16)
            }
            None if has_depth => [0; 3],
            None => [FARTHEST; 3],
        };
        let Some(blend) = blend(primitive) else {
            continue;
        };
        let colours = colours(primitive);
        let mut add = |corners| {
            let triangle = Triangle {
                corners,
                depths,
                colours,
                blend,
            };
            outcome.beyond += usize::from(!new.add(&triangle));
        };
        let quadrilateral = match shape(primitive) {
            Shape::Triangle { corners, .. } => {
                add(corners.map(middle));
                continue;
            }
            Shape::Point(point) => line([middle(point); 2]),
            Shape::Line(ends) => line(ends.map(middle)),
            Shape::Unknown => {
                outcome.unknown += 1;
                continue;
            }
        };
        let [a, b, c, d] = quadrilateral;
        add([a, b, c]);
        add([a, c, d]);
    }
    outcome
}

/// What [`convert`] left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Number of triangles that exceed the capacity of the list.
    pub beyond: usize,
    /// Number of primitives of other kinds: those with a texture or a light map.
    pub unknown: usize,
}

/// The primitives in the order of the commands.
fn primitives<const MAX: usize>(
    commands: &CommandBuffer<MAX>,
) -> impl Iterator<Item = &DrawPrimitive> {
    commands.iter().filter_map(|command| match command {
        RenderCommand::Draw(primitive) => Some(primitive),
        RenderCommand::ClearColor(_) | RenderCommand::ClearDepth(_) => None,
    })
}

/// The geometry of a primitive.
enum Shape<'p> {
    Point([i32; 2]),
    Line([[i32; 2]; 2]),
    Triangle {
        corners: [[i32; 2]; 3],
        depths: Option<&'p [f32; 3]>,
    },
    /// A primitive that is not drawn.
    Unknown,
}

/// The geometry of a primitive; [`colours`] and [`blend`] return the rest.
fn shape(primitive: &DrawPrimitive) -> Shape<'_> {
    use DrawPrimitive as P;
    match primitive {
        P::ColoredPoint(point, _) => Shape::Point([point.x, point.y]),
        P::Line(ends, _) => Shape::Line(ends.map(|end| [end.x, end.y])),
        P::ColoredTriangle(points, _) | P::GouraudTriangle { points, .. } => Shape::Triangle {
            corners: points.map(|point| [point.x, point.y]),
            depths: None,
        },
        P::ColoredTriangleWithDepth { points, depths, .. }
        | P::TranslucentTriangleWithDepth { points, depths, .. }
        | P::ScreenDoorTriangleWithDepth { points, depths, .. }
        | P::GouraudTriangleWithDepth { points, depths, .. } => Shape::Triangle {
            corners: points.map(|point| [point.x, point.y]),
            depths: Some(depths),
        },
        // The primitives of the feature `textured`, if a program has it.
        #[allow(unreachable_patterns)]
        _ => Shape::Unknown,
    }
}

/// The depths of a primitive in units of 2^-16; `None` without depths.
fn depths(primitive: &DrawPrimitive) -> Option<[u32; 3]> {
    match shape(primitive) {
        Shape::Triangle { depths, .. } => depths.map(|depths| depths.map(fixed)),
        Shape::Point(_) | Shape::Line(_) | Shape::Unknown => None,
    }
}

/// Converts a number to units of 2^-16: truncates, saturates, and makes 0 of NaN, like `(z * 65536.0) as u32` in the rasteriser of
/// `embedded-3dgfx`. The soft core has no floating-point unit, so this function uses the bits of the number.
fn fixed(z: f32) -> u32 {
    if z.is_nan() || z.is_sign_negative() {
        return 0;
    }
    let bits = z.to_bits();
    // The number is significand·2^(exponent − 150); a subnormal number is below 2^-126.
    let (exponent, significand) = (bits >> 23, bits & 0x7f_ffff | 1 << 23);
    match exponent {
        ..111 => 0,
        111..134 => significand >> (134 - exponent),
        134..=142 => significand << (exponent - 134),
        _ => u32::MAX,
    }
}

/// The colour of each corner.
fn colours(primitive: &DrawPrimitive) -> [Rgb565; 3] {
    use DrawPrimitive as P;
    let colours = match primitive {
        P::ColoredPoint(_, color)
        | P::Line(_, color)
        | P::ColoredTriangle(_, color)
        | P::ColoredTriangleWithDepth { color, .. }
        | P::TranslucentTriangleWithDepth { color, .. }
        | P::ScreenDoorTriangleWithDepth { color, .. } => [*color; 3],
        P::GouraudTriangle { colors, .. } | P::GouraudTriangleWithDepth { colors, .. } => *colors,
        #[allow(unreachable_patterns)]
        _ => [pixelcolor::Rgb565::default(); 3],
    };
    colours.map(|colour| Rgb565(colour.into_storage()))
}

/// How a primitive is blended; `None` if its opacity is below a sixteenth.
fn blend(primitive: &DrawPrimitive) -> Option<Blend> {
    use DrawPrimitive as P;
    match primitive {
        P::TranslucentTriangleWithDepth { alpha, .. }
        | P::ScreenDoorTriangleWithDepth { alpha, .. } => {
            match (usize::from(*alpha) * 8 + 127) / 255 {
                0 => None,
                8 => Some(Blend::Opaque),
                eighths => Some(Blend::ALL[eighths]),
            }
        }
        _ => Some(Blend::Opaque),
    }
}

/// The middle of a pixel in quarters of a pixel; saturates outside of every picture.
fn middle(point: [i32; 2]) -> [i32; 2] {
    const LIMIT: i32 = 1 << 16;
    point.map(|pixels| 4 * pixels.clamp(-LIMIT, LIMIT) + 2)
}

/// The parallelogram of a line: along its longer direction half a pixel longer than the ends, one pixel wide in the other direction.
fn line([from, to]: [[i32; 2]; 2]) -> [[i32; 2]; 4] {
    let along = usize::from(from[0].abs_diff(to[0]) < from[1].abs_diff(to[1]));
    let [from, to] = if from[along] <= to[along] {
        [from, to]
    } else {
        [to, from]
    };
    let corner = |end: [i32; 2], outward: i32, aside: i32| {
        let mut corner = end;
        corner[along] += outward;
        corner[1 - along] += aside;
        corner
    };
    [
        corner(from, -2, -2),
        corner(to, 2, -2),
        corner(to, 2, 2),
        corner(from, -2, 2),
    ]
}

#[cfg(test)]
mod tests {
    use super::fixed;

    #[test]
    fn depths_are_those_of_the_rasteriser() {
        let exact = |z: f32| (z * 65536.0) as u32;
        let bits = (0..u32::MAX).step_by(65_521).chain([f32::MAX.to_bits()]);
        for z in bits
            .map(f32::from_bits)
            .chain([65536.0, 65535.996, 1.0, 0.0])
        {
            assert_eq!(fixed(z), exact(z), "{z}");
        }
    }
}
