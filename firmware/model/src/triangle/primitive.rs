//! The steps for one triangle between the vertex stage and the walker: facing, bounds, light, and the triangle fan of a clipped triangle.

use glint_core::camera::Projection;
use glint_core::colour::{Shading, Winding};
use glint_core::matrix::Normals;
use glint_core::mesh::{Chunk, Rgb565, Triangle, Vertex};
use glint_core::texture::Texture;

use crate::triangle::clip::{Cut, TexturedVertex, clip, off_picture};
use crate::triangle::facing::Facing;
use crate::triangle::mesh_light::MeshLight;
use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::setup::{Bounds, Oriented, Setup};
use crate::triangle::shade::{Light, Lit, intensity, lit};
use crate::triangle::textured::{OfTexture, axes, flat_light, weight};
use crate::triangle::vertex::{CameraVertex, ScreenVertex, snap, transform};

/// Options for drawing a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options<'a> {
    /// Whether back faces are culled.
    pub cull: bool,
    /// Background: the colour of pixels without a triangle, RGB565.
    pub clear: u16,
    /// Source of the colours: triangles (flat) or vertices (smooth).
    pub shading: Shading,
    /// The rule that selects the visible side of a triangle.
    pub winding: Winding,
    /// Colour that replaces the colours of the mesh.
    pub colour: Option<Rgb565>,
    /// Colours of the light and of the ambient light; `None` for white light at the camera, without ambient light. The direction of the
    /// light is in the frame constants.
    pub light: Option<&'a MeshLight>,
    /// The matrix that transforms the normals of an object to the coordinates of the light; `None` if the normals are already in these
    /// coordinates.
    pub normals: Option<&'a Normals>,
    /// Whether the light is in world coordinates, and not in the coordinates of the mesh.
    pub lit_in_world: bool,
    /// Whether the textures of the mesh are drawn.
    pub textures: bool,
    /// The replacement texture, which is drawn in place of the textures of the mesh.
    pub replacement_texture: Option<&'a Texture<'a>>,
}

impl Options<'_> {
    fn turned(&self, normal: [i16; 3]) -> [i16; 3] {
        match self.normals {
            None => normal,
            Some(normals) => normals.apply(normal),
        }
    }

    /// The factor of each channel of a surface's colour for an intensity of the light, u1.8.
    fn shares(&self, intensity: u32) -> [u32; 3] {
        match self.light {
            None => [intensity; 3],
            Some(light) => light.shares(intensity),
        }
    }

    /// The side of a surface that the camera sees, from the surface's normal in the coordinates of the light.
    fn seen(&self, frame: &MeshSetup, normal: [i16; 3]) -> Facing {
        let forward = match self.light {
            None => &frame.light,
            Some(light) if self.lit_in_world => &light.forward,
            Some(_) => &frame.n,
        };
        Facing::of(normal, forward)
    }
}

impl Default for Options<'_> {
    /// Back faces are culled, the background is black, shading is flat, and the winding is the mesh's.
    fn default() -> Self {
        Self {
            cull: true,
            clear: 0,
            shading: Shading::Flat,
            winding: Winding::Mesh,
            colour: None,
            light: None,
            normals: None,
            lit_in_world: false,
            textures: true,
            replacement_texture: None,
        }
    }
}

/// A triangle on the screen that reaches the walker, the stage that finds its pixels.
pub struct Placed {
    /// Vertices in clockwise order, and the visible side.
    pub oriented: Oriented,
    /// Rows and columns that contain all covered pixels.
    pub bounds: Bounds,
    /// Colour of all pixels under flat shading.
    pub colour: Rgb565,
    /// Light of the vertices under smooth shading, which replaces `colour`.
    pub lit: Option<[Lit; 3]>,
    /// The projection, which determines whether light is linear on the screen.
    pub projection: Projection,
}

impl Placed {
    /// Prepares a triangle; `None` for a culled back face, and for a triangle without bounds ([`Bounds::new`]).
    pub fn new(
        frame: &MeshSetup,
        options: &Options,
        triangle: &Triangle,
        vertices: [&ScreenVertex; 3],
        light: Option<&[Light; 3]>,
    ) -> Option<Self> {
        let is_plain = options.light.is_none() && options.colour.is_none();
        if frame.is_placed || options.winding == Winding::Screen || !is_plain {
            return Self::optional(frame, options, triangle, vertices, light);
        }
        let oriented = Oriented::new(vertices.map(|v| *v))?;
        let facing = oriented.facing;
        if options.cull && facing == Facing::Back {
            return None;
        }
        let bounds = Bounds::new(&oriented.vertices, frame.width, frame.height)?;
        let intensity = intensity(triangle.normal, &frame.light, facing);
        Some(Self {
            oriented,
            bounds,
            colour: lit(triangle.colour, [intensity; 3]),
            lit: light.map(|light| facing.order(light.map(|light| light.to(facing)))),
            projection: frame.projection,
        })
    }

    /// Prepares a triangle in the less common cases: part of an object, replaced colour, any light but white light at the camera, or
    /// [`Winding::Screen`], with which no triangle is culled.
    ///
    /// Not inlined, so that other triangles do not load this code into the instruction cache.
    #[inline(never)]
    fn optional(
        frame: &MeshSetup,
        options: &Options,
        triangle: &Triangle,
        vertices: [&ScreenVertex; 3],
        light: Option<&[Light; 3]>,
    ) -> Option<Self> {
        let vertices = vertices.map(|v| *v);
        let normal = options.turned(triangle.normal);
        let by_screen = options.winding == Winding::Screen;
        let (order, facing) = if by_screen {
            let facing = options.seen(frame, normal);
            (Oriented::screen_order(&vertices), facing)
        } else {
            let facing = Oriented::new(vertices)?.facing;
            let seen = if frame.mirrors {
                facing.opposite()
            } else {
                facing
            };
            if options.cull && seen == Facing::Back {
                return None;
            }
            (facing.order([0, 1, 2]), seen)
        };
        let oriented = Oriented {
            facing,
            ..Oriented::new(order.map(|i| vertices[i]))?
        };
        let bounds = Bounds::new(&oriented.vertices, frame.width, frame.height)?;
        let intensity = intensity(normal, &frame.light, facing);
        let light_of = |light: Light| {
            if by_screen {
                light.visible()
            } else {
                light.to(facing)
            }
        };
        Some(Self {
            oriented,
            bounds,
            colour: lit(
                options.colour.unwrap_or(triangle.colour),
                options.shares(intensity),
            ),
            lit: light.map(|light| order.map(|i| light_of(light[i]))),
            projection: frame.projection,
        })
    }

    /// Computes the edge functions and planes of the triangle.
    pub fn setup(&self) -> Setup {
        match (&self.lit, self.projection) {
            (None, _) => Setup::new(&self.oriented, self.bounds),
            (Some(lit), Projection::Perspective) => Setup::smooth(&self.oriented, self.bounds, lit),
            (Some(lit), Projection::Orthographic) => {
                Setup::linear(&self.oriented, self.bounds, lit)
            }
        }
    }
}

/// The texture on a triangle, for `placed`, the result of [`Placed::new`]. Next to `coordinates`, the s and t of the triangle's vertices,
/// `number` is the number of the texture in the frame's table.
///
/// Not inlined, so that triangles without textures do not load this code into the instruction cache.
#[inline(never)]
pub fn texture_on(
    frame: &MeshSetup,
    options: &Options,
    triangle: &Triangle,
    vertices: [&ScreenVertex; 3],
    (number, coordinates): (u8, &[[i32; 2]; 3]),
    placed: &Placed,
    setup: &Setup,
) -> OfTexture {
    let vertices = vertices.map(|v| *v);
    let order = match options.winding {
        Winding::Screen => Oriented::screen_order(&vertices),
        Winding::Mesh => {
            Oriented::new(vertices).map_or([0, 1, 2], |new| new.facing.order([0, 1, 2]))
        }
    };
    let normal = options.turned(triangle.normal);
    let intensity = intensity(normal, &frame.light, placed.oriented.facing);
    let colour = options.colour.unwrap_or(triangle.colour);
    let is_linear = placed.projection == Projection::Orthographic;
    OfTexture {
        number,
        axes: axes(
            &placed.oriented,
            setup,
            &order.map(|i| coordinates[i]),
            is_linear,
        ),
        light: flat_light(colour, options.shares(intensity)),
        weight: weight(is_linear),
    }
}

/// The light at the three vertices of a triangle.
///
/// Not inlined, so that flat triangles do not load this code into the instruction cache.
#[inline(never)]
pub fn vertex_light(
    frame: &MeshSetup,
    options: &Options,
    indices: [u16; 3],
    chunk: &Chunk,
) -> [Light; 3] {
    indices.map(|i| {
        // All indices of a checked mesh are valid.
        chunk
            .vertex(usize::from(i))
            .map_or(Light::default(), |v| light_of(frame, options, &v))
    })
}

/// The light at a vertex, for both sides of a surface.
pub fn light_of(frame: &MeshSetup, options: &Options, vertex: &Vertex) -> Light {
    let channels = match options.colour {
        None => Rgb565::with_fractions(vertex.rgb888()),
        Some(colour) => colour.fractions(),
    };
    let normal = options.turned(vertex.normal);
    match options.light {
        None => Light::new(channels, normal, &frame.light, |i| [i; 3]),
        Some(light) => light_in(light, frame, options, channels, normal),
    }
}

/// The light at a vertex, for any light but white light at the camera. `normal` is in the coordinates of the light.
///
/// Not inlined, so that frames with white light at the camera do not load this code into the instruction cache.
#[inline(never)]
fn light_in(
    light: &MeshLight,
    frame: &MeshSetup,
    options: &Options,
    channels: [u8; 3],
    normal: [i16; 3],
) -> Light {
    let lit = Light::new(channels, normal, &frame.light, |i| light.shares(i));
    if options.winding == Winding::Mesh {
        return lit;
    }
    // The visible side is the side that faces the camera, which need not be at the light.
    let seen = lit.to(options.seen(frame, normal));
    Light {
        front: seen,
        back: seen,
    }
}

/// A vertex of a clipped triangle.
pub struct Corner {
    /// Position on the screen.
    pub place: ScreenVertex,
    /// Light of the vertex under smooth shading; black under flat shading.
    pub light: Light,
}

impl Corner {
    fn new(frame: &MeshSetup, vertex: &CameraVertex) -> Self {
        Self {
            place: snap(frame, vertex),
            light: vertex.light,
        }
    }
}

/// A vertex of a clipped triangle with a texture: the vertex, and the coordinates s and t, s16.16.
pub type TexturedCorner = (Corner, [i32; 2]);

/// The light at three vertices of a clipped triangle; `None` under flat shading.
pub fn lit_corners(shading: Shading, corners: [&Corner; 3]) -> Option<[Light; 3]> {
    (shading == Shading::Smooth).then(|| corners.map(|corner| corner.light))
}

/// Clips a triangle, and emits the remaining polygon as a triangle fan.
pub fn clip_fan(
    frame: &MeshSetup,
    options: &Options,
    triangle: &Triangle,
    chunk: &Chunk,
    emit: &mut dyn FnMut([&Corner; 3]),
) {
    if let Some((_, vertices)) = fan_vertices(frame, options, triangle, chunk) {
        fan(frame, vertices, |vertex| Corner::new(frame, vertex), emit);
    }
}

/// As [`clip_fan`], with the coordinates of a texture at the vertices.
///
/// Not inlined, so that triangles without textures do not load this code into the instruction cache.
#[inline(never)]
pub fn clip_textured_fan(
    frame: &MeshSetup,
    options: &Options,
    triangle: &Triangle,
    chunk: &Chunk,
    coordinates: &[[i32; 2]; 3],
    emit: &mut dyn FnMut([&TexturedCorner; 3]),
) {
    let Some((order, vertices)) = fan_vertices(frame, options, triangle, chunk) else {
        return;
    };
    let vertices = [0, 1, 2].map(|i: usize| TexturedVertex {
        vertex: vertices[i],
        coordinates: coordinates[order[i]],
    });
    let corner = |corner: &TexturedVertex| (Corner::new(frame, &corner.vertex), corner.coordinates);
    fan(frame, vertices, corner, emit);
}

/// The vertices of a triangle in the order of the fan, and the index of each vertex in the triangle.
///
/// The fan starts at the vertex whose position is the first in lexicographic order, so that a cyclic shift of the triangle's indices has
/// no effect.
fn fan_vertices(
    frame: &MeshSetup,
    options: &Options,
    triangle: &Triangle,
    chunk: &Chunk,
) -> Option<([usize; 3], [CameraVertex; 3])> {
    let [a, b, c] = triangle.indices.map(|i| chunk.vertex(usize::from(i)));
    let vertices = [a?, b?, c?];
    let [p, q, r] = vertices.each_ref().map(|vertex| vertex.position);
    let mut order = if p <= q && p <= r {
        [0, 1, 2]
    } else if q <= r {
        [1, 2, 0]
    } else {
        [2, 0, 1]
    };
    if options.winding == Winding::Screen
        && vertices[order[2]].position < vertices[order[1]].position
    {
        // With this order, the orientation of the triangle in the mesh has no effect on the result.
        order.swap(1, 2);
    }
    let vertices = order.map(|i| CameraVertex {
        light: match options.shading {
            Shading::Flat => Light::default(),
            Shading::Smooth => light_of(frame, options, &vertices[i]),
        },
        ..transform(frame, vertices[i].position)
    });
    Some((order, vertices))
}

/// Clips a triangle, converts the vertices of the remaining polygon with `corner`, and emits the polygon as a triangle fan.
fn fan<C: Cut, R>(
    frame: &MeshSetup,
    vertices: [C; 3],
    corner: impl Fn(&C) -> R,
    emit: &mut dyn FnMut([&R; 3]),
) {
    if off_picture(frame, &vertices) {
        return;
    }
    let mut space = Default::default();
    let mut left = clip(frame, vertices, &mut space).iter().map(corner);
    let (Some(first), Some(mut last)) = (left.next(), left.next()) else {
        return;
    };
    for corner in left {
        emit([&first, &last, &corner]);
        last = corner;
    }
}
