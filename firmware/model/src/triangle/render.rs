//! Drawing of all triangles of a mesh, in the order of the gateware.

use glint_core::camera::View;
use glint_core::colour::Shading;
use glint_core::feature::{FOG, TEXTURE};
use glint_core::mesh::{Chunk, Mesh, Rgb565, Triangle};
use glint_core::texture::Texture;

use crate::error::RenderError;
use crate::fog::Fog;
use crate::frame_buffer::FrameBuffer;
use crate::triangle::classify::Path;
use crate::triangle::clip::contains;
use crate::triangle::facing::Facing;
use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::primitive::{
    Options, Placed, TexturedCorner, clip_fan, clip_textured_fan, lit_corners, texture_on,
    vertex_light,
};
use crate::triangle::raster::{self, Coverage};
use crate::triangle::setup::Setup;
use crate::triangle::shade::{Light, Lit};
use crate::triangle::textured::{MeshTextures, Textured};
use crate::triangle::vertex::{Projected, ScreenVertex, project, transform};
use crate::triangle::volume::Volume;

/// Counts of the triangles and pixels of a mesh in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Number of triangles in the mesh: `culled` + `drawn`.
    pub triangles_in: u32,
    /// Number of triangles that did not reach the walker, the stage that finds pixels: culled back faces, triangles without area, behind
    /// the near plane or outside of the picture, triangles without a pixel centre in their bounds, and tiny triangles that cover no pixel
    /// centre.
    pub culled: u32,
    /// Number of triangles that the clipper processed, with or without a visible part.
    pub clipped: u32,
    /// Number of triangles of which at least a part reached the walker.
    pub drawn: u32,
    /// Number of pixels tested by the walker: covered pixels, and pixels just outside the ends of a span. `None` if the triangle engine
    /// draws, because the engine tests groups of eight pixels, which the engine's counter `cycles_walking` counts.
    pub pixels_tested: Option<u64>,
    /// Number of pixels covered. A pixel counts once for each triangle that covers it.
    pub pixels_covered: u64,
    /// Number of covered pixels that passed the depth test and were written.
    pub pixels_drawn: u64,
}

impl Stats {
    /// Adds the counts of another frame.
    pub fn add(&mut self, other: &Self) {
        self.triangles_in += other.triangles_in;
        self.culled += other.culled;
        self.clipped += other.clipped;
        self.drawn += other.drawn;
        self.pixels_tested = self
            .pixels_tested
            .zip(other.pixels_tested)
            .map(|(a, b)| a + b);
        self.pixels_covered += other.pixels_covered;
        self.pixels_drawn += other.pixels_drawn;
    }

    /// Adds the pixels of a triangle or rectangle.
    pub(crate) fn add_pixels(&mut self, coverage: &Coverage) {
        self.pixels_tested = self
            .pixels_tested
            .map(|tested| tested + u64::from(coverage.tested));
        self.pixels_covered += u64::from(coverage.covered);
        self.pixels_drawn += u64::from(coverage.drawn);
    }
}

/// A triangle that reached the walker (the stage that finds pixels), or a part of a clipped triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnTriangle {
    /// Number of the triangle in the mesh, across all chunks.
    pub index: u32,
    /// Snapped vertices, clockwise on the screen (2A > 0).
    pub vertices: [ScreenVertex; 3],
    /// The side that the camera sees.
    pub facing: Facing,
    /// Colour of all pixels under flat shading.
    pub colour: Rgb565,
    /// Light of the vertices under smooth shading, which replaces `colour`.
    pub lit: Option<[Lit; 3]>,
    /// Whether the triangle is a part that the clipper made.
    pub clipped: bool,
}

/// Receives a triangle, its setup, and its texture if the triangle has one.
pub type Emit<'b> = dyn FnMut(&DrawnTriangle, &Setup, Option<&Textured>) + 'b;

/// Draws a mesh for a camera.
///
/// `scratch` must hold the vertices of the largest chunk. The contents of `scratch` and of the frame buffer are overwritten. Unclipped
/// triangles are drawn first, in the order of their indices, then clipped triangles. At equal depths the later triangle hides the earlier
/// one.
///
/// # Errors
/// [`RenderError`]; the frame buffer is then unchanged.
pub fn render(
    mesh: &Mesh,
    view: &View,
    target: &mut FrameBuffer,
    scratch: &mut [Projected],
    options: &Options,
) -> Result<Stats, RenderError> {
    trace(mesh, view, target, scratch, options, |_| {})
}

/// Draws a mesh as [`render`] does. Calls `show` with each triangle before the triangle is drawn.
///
/// # Errors
/// [`RenderError`]; the frame buffer is then unchanged.
pub fn trace(
    mesh: &Mesh,
    view: &View,
    target: &mut FrameBuffer,
    scratch: &mut [Projected],
    options: &Options,
    show: impl FnMut(&DrawnTriangle),
) -> Result<Stats, RenderError> {
    target.check()?;
    let mut frame = MeshSetup::new(view, target.width, target.height, mesh.radius())?;
    if let Some(light) = options.light {
        frame.light = light.row;
    }
    trace_frame(mesh, frame, target, scratch, options, show)
}

/// Draws a mesh as [`trace`] does, from its frame constants.
///
/// # Errors
/// [`RenderError`], also for a frame buffer whose size differs from the constants; the frame buffer is then unchanged.
pub fn trace_frame(
    mesh: &Mesh,
    frame: MeshSetup,
    target: &mut FrameBuffer,
    scratch: &mut [Projected],
    options: &Options,
    mut show: impl FnMut(&DrawnTriangle),
) -> Result<Stats, RenderError> {
    let part = PreparedMesh {
        mesh: *mesh,
        frame,
        options: *options,
    };
    let mut part = |number| (number == 0).then_some(part);
    draw_parts(
        &mut part,
        Some(options.clear),
        None,
        target,
        scratch,
        &mut show,
    )
}

/// A mesh of a frame: its frame constants and options.
#[derive(Clone, Copy, Debug)]
pub struct PreparedMesh<'a> {
    /// The mesh to draw.
    pub mesh: Mesh<'a>,
    /// The frame constants of the mesh.
    pub frame: MeshSetup,
    /// Options for drawing the mesh. `clear` has no effect.
    pub options: Options<'a>,
}

/// Draws the parts of a frame (see [`set_up_parts`]) on the background colour `clear` or, with `None`, over the picture in the frame
/// buffer; in `fog`, if any. Calls `show` with each triangle before the triangle is drawn.
///
/// # Errors
/// As [`set_up_parts`], or the size of a part differs from the frame buffer's. If no triangle has been drawn yet, the frame buffer is
/// unchanged.
pub fn draw_parts<'a>(
    part: &mut dyn FnMut(usize) -> Option<PreparedMesh<'a>>,
    mut clear: Option<u16>,
    fog: Option<&Fog>,
    target: &mut FrameBuffer,
    scratch: &mut [Projected],
    show: &mut dyn FnMut(&DrawnTriangle),
) -> Result<Stats, RenderError> {
    target.check()?;
    let size = (target.width, target.height);
    let mut pixels = Stats {
        pixels_tested: Some(0),
        ..Stats::default()
    };
    let mut draw = |triangle: &DrawnTriangle, setup: &Setup, textured: Option<&Textured>| {
        if let Some(clear) = clear.take() {
            target.clear(clear);
        }
        show(triangle);
        let coverage = match (fog, textured) {
            (Some(fog), _) if FOG.is_built => {
                raster::draw_in_fog(setup, triangle.colour, textured, fog, target)
            }
            (_, Some(textured)) if TEXTURE.is_built => {
                raster::draw_textured(setup, textured, target)
            }
            _ => raster::draw(setup, triangle.colour, target),
        };
        pixels.add_pixels(&coverage);
    };
    let stats = set_up_parts(part, size, scratch, &mut draw)?;
    if let Some(clear) = clear {
        target.clear(clear);
    }
    Ok(Stats {
        pixels_tested: pixels.pixels_tested,
        pixels_covered: pixels.pixels_covered,
        pixels_drawn: pixels.pixels_drawn,
        ..stats
    })
}

/// Sets up the triangles of the parts of a frame of this size. Calls `emit` with each triangle, its setup, and its texture if the triangle
/// has one. `part` returns a part by its number, and `None` after the last part; `part` is called twice for a part with triangles to clip.
/// The pixel counts in the result are 0.
///
/// Unclipped triangles come first, ordered by part and index, then clipped triangles in the same order. This is the order in which the
/// gateware draws.
///
/// Not generic, so that it is compiled once, with this crate's optimisation level.
///
/// # Errors
/// [`RenderError`]; if a later part causes it, the triangles of the previous parts have been emitted.
#[inline(never)]
pub fn set_up_parts<'a>(
    part: &mut dyn FnMut(usize) -> Option<PreparedMesh<'a>>,
    (width, height): (u32, u32),
    scratch: &mut [Projected],
    emit: &mut Emit,
) -> Result<Stats, RenderError> {
    let mut stats = Stats::default();
    // `first` is the number of the first part with triangles to clip, and `projected` that of the part whose vertices are in the
    // scratch memory.
    let (mut first, mut projected) = (None, 0);
    let mut number = 0;
    while let Some(PreparedMesh {
        mesh,
        frame,
        options,
    }) = part(number)
    {
        if (frame.width, frame.height) != (width, height) {
            return Err(RenderError::Size {
                width: frame.width,
                height: frame.height,
            });
        }
        let (expected, found) = (mesh.largest_chunk(), scratch.len());
        let scratch = scratch
            .get_mut(..expected)
            .ok_or(RenderError::Scratch { expected, found })?;
        stats.triangles_in += mesh.triangle_count();
        let clipped = stats.clipped;
        let mut renderer = Renderer {
            stats,
            ..Renderer::new(&mesh, &frame, &options, emit)
        };
        renderer.regular(&mesh, scratch);
        stats = renderer.stats;
        if stats.clipped > clipped && first.is_none() {
            first = Some(number);
        }
        projected = number;
        number += 1;
    }
    let mut left = stats.clipped;
    for number in first.unwrap_or(number)..number {
        let Some(PreparedMesh {
            mesh,
            frame,
            options,
        }) = part(number)
        else {
            break;
        };
        let mut renderer = Renderer {
            stats,
            ..Renderer::new(&mesh, &frame, &options, emit)
        };
        // If a mesh has a single chunk, its projected vertices are still in the scratch memory.
        let is_projected = number == projected && mesh.chunks().nth(1).is_none();
        left = renderer.exceptions(&mesh, scratch, is_projected, left);
        stats = renderer.stats;
        if left == 0 {
            break;
        }
        projected = number;
    }
    stats.culled = stats.triangles_in - stats.drawn;
    Ok(stats)
}

/// Runs the vertex stage for all vertices of a chunk.
///
/// Not inlined, so that the loop over vertices can use all registers.
#[inline(never)]
pub fn project_chunk(frame: &MeshSetup, chunk: &Chunk, scratch: &mut [Projected]) {
    for (vertex, projected) in chunk.vertices().zip(&mut *scratch) {
        *projected = project(frame, &transform(frame, vertex.position));
    }
    if frame.volume != Volume::Guard {
        mark_outside(frame, chunk, scratch);
    }
}

/// Marks the vertices outside of the view volume, which need clipping.
///
/// Not inlined, so that frames with the guard band do not load this code into the instruction cache.
#[inline(never)]
fn mark_outside(frame: &MeshSetup, chunk: &Chunk, scratch: &mut [Projected]) {
    for (vertex, projected) in chunk.vertices().zip(scratch) {
        if let Projected::Visible(place) = *projected
            && !contains(frame, &transform(frame, vertex.position))
        {
            *projected = Projected::BeyondGuard(place);
        }
    }
}

/// Sets up the triangles of one mesh, and counts them.
pub(super) struct Renderer<'a, 'b> {
    frame: MeshSetup,
    options: Options<'a>,
    /// The textures of the mesh; `None` if the mesh has none, or if textures are not drawn.
    textures: Option<MeshTextures<'a>>,
    emit: &'b mut Emit<'b>,
    stats: Stats,
}

impl<'a, 'b> Renderer<'a, 'b> {
    pub(super) fn new(
        mesh: &Mesh<'a>,
        frame: &MeshSetup,
        options: &Options<'a>,
        emit: &'b mut Emit<'b>,
    ) -> Self {
        Self {
            frame: *frame,
            options: *options,
            textures: MeshTextures::new(mesh, options.textures, options.replacement_texture),
            emit,
            stats: Stats::default(),
        }
    }

    /// Sets up the triangles that need no clipping, and counts the other triangles.
    fn regular(&mut self, mesh: &Mesh, scratch: &mut [Projected]) {
        let mut index = 0;
        let mut first = 0;
        for chunk in mesh.chunks() {
            project_chunk(&self.frame, &chunk, scratch);
            for triangle in chunk.triangles() {
                match self.path(&triangle, scratch) {
                    Path::Unseen => {}
                    Path::Regular(vertices) => {
                        let light = match self.options.shading {
                            Shading::Flat => None,
                            Shading::Smooth => Some(vertex_light(
                                &self.frame,
                                &self.options,
                                triangle.indices,
                                &chunk,
                            )),
                        };
                        let texture = self.texture(first, &triangle);
                        let drawn = self.draw(
                            index,
                            false,
                            &triangle,
                            vertices,
                            light.as_ref(),
                            texture.as_ref(),
                        );
                        self.stats.drawn += u32::from(drawn);
                    }
                    Path::Exception => self.stats.clipped += 1,
                }
                index += 1;
            }
            first += chunk.vertex_count();
        }
    }

    /// Clips and sets up the mesh's triangles that need clipping. `left` is the number of such triangles in this and all further meshes.
    /// With `is_projected` the vertices of the mesh are in the scratch memory. Returns the number in the further meshes.
    fn exceptions(
        &mut self,
        mesh: &Mesh,
        scratch: &mut [Projected],
        is_projected: bool,
        mut left: u32,
    ) -> u32 {
        let mut index = 0;
        let mut first = 0;
        for chunk in mesh.chunks() {
            if !is_projected {
                project_chunk(&self.frame, &chunk, scratch);
            }
            for triangle in chunk.triangles() {
                if let Path::Exception = self.path(&triangle, scratch) {
                    let drawn = self.clip(index, &triangle, &chunk, first);
                    self.stats.drawn += u32::from(drawn);
                    left -= 1;
                    if left == 0 {
                        return 0;
                    }
                }
                index += 1;
            }
            first += chunk.vertex_count();
        }
        left
    }

    /// The texture of a triangle, with the coordinates of its vertices, for the chunk whose first vertex has this number in the mesh.
    fn texture(&self, first: usize, triangle: &Triangle) -> Option<(Texture<'a>, [[i32; 2]; 3])> {
        if !TEXTURE.is_built {
            return None;
        }
        self.textures.as_ref()?.of(first, triangle)
    }

    fn path<'s>(&self, triangle: &Triangle, scratch: &'s [Projected]) -> Path<'s> {
        // All indices of a checked mesh are valid.
        let [Some(a), Some(b), Some(c)] = triangle.indices.map(|i| scratch.get(usize::from(i)))
        else {
            return Path::Unseen;
        };
        Path::of(&self.frame, [a, b, c])
    }

    /// Clips a triangle and sets up its parts. Returns whether a part reached the walker. `first` is the number of the chunk's first
    /// vertex in the mesh.
    pub(super) fn clip(
        &mut self,
        index: u32,
        triangle: &Triangle,
        chunk: &Chunk,
        first: usize,
    ) -> bool {
        let (frame, options) = (self.frame, self.options);
        let mut any = false;
        if let Some((texture, coordinates)) = self.texture(first, triangle) {
            let mut draw = |corners: [&TexturedCorner; 3]| {
                let light = lit_corners(options.shading, corners.map(|(corner, _)| corner));
                let places = corners.map(|(corner, _)| &corner.place);
                let texture = (texture, corners.map(|(_, coordinates)| *coordinates));
                any |= self.draw(
                    index,
                    true,
                    triangle,
                    places,
                    light.as_ref(),
                    Some(&texture),
                );
            };
            clip_textured_fan(&frame, &options, triangle, chunk, &coordinates, &mut draw);
            return any;
        }
        clip_fan(&frame, &options, triangle, chunk, &mut |corners| {
            let light = lit_corners(options.shading, corners);
            let places = corners.map(|corner| &corner.place);
            any |= self.draw(index, true, triangle, places, light.as_ref(), None);
        });
        any
    }

    /// Sets up and shades one triangle on the screen. Returns whether the triangle reaches the walker, the stage that finds pixels.
    fn draw(
        &mut self,
        index: u32,
        is_clipped: bool,
        triangle: &Triangle,
        vertices: [&ScreenVertex; 3],
        light: Option<&[Light; 3]>,
        texture: Option<&(Texture<'a>, [[i32; 2]; 3])>,
    ) -> bool {
        let Some(placed) = Placed::new(&self.frame, &self.options, triangle, vertices, light)
        else {
            return false;
        };
        let setup = placed.setup();
        let textured = texture.filter(|_| TEXTURE.is_built);
        let textured = textured.map(|(texture, coordinates)| {
            let (frame, options) = (&self.frame, &self.options);
            let texture_of = (0, coordinates);
            texture_on(
                frame, options, triangle, vertices, texture_of, &placed, &setup,
            )
            .with(*texture)
        });
        let triangle = DrawnTriangle {
            index,
            vertices: placed.oriented.vertices,
            facing: placed.oriented.facing,
            colour: placed.colour,
            lit: placed.lit,
            clipped: is_clipped,
        };
        (self.emit)(&triangle, &setup, textured.as_ref());
        true
    }
}
