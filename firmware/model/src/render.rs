//! A whole frame.

use core::fmt;

use glint_core::camera::View;
use glint_core::colour::Shading;
use glint_core::fixed::Q32_32;
use glint_core::mesh::{Chunk, Mesh, Rgb565, Triangle};

use crate::clip::{clip, off_picture};
use crate::frame::{MAX_EYE, MeshSetup};
use crate::raster;
use crate::setup::{Bounds, Facing, Oriented, Setup};
use crate::shade::{Light, Lit, intensity, lit};
use crate::vertex::{CameraVertex, Projected, ScreenVertex, project, snap, transform};

/// The sizes of a picture: width and height in pixels.
pub const SIZES: [(u32, u32); 3] = [(320, 180), (640, 360), (1280, 720)];

/// Where a frame is drawn. Rows follow each other from the top, without padding.
#[derive(Debug)]
pub struct Target<'a> {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels; one of the [`SIZES`] with the width.
    pub height: u32,
    /// RGB565, one number a pixel.
    pub colour: &'a mut [u16],
    /// Depth codes, one a pixel: u18, larger is nearer, 0 where nothing is drawn.
    pub depth: &'a mut [u32],
}

impl Target<'_> {
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let &Self { width, height, .. } = self;
        if !SIZES.contains(&(width, height)) {
            return Err(RenderError::Size { width, height });
        }
        let expected = width as usize * height as usize;
        for (buffer, found) in [
            (Buffer::Colour, self.colour.len()),
            (Buffer::Depth, self.depth.len()),
        ] {
            if found != expected {
                return Err(RenderError::Buffer {
                    buffer,
                    expected,
                    found,
                });
            }
        }
        Ok(())
    }

    /// Whether it has the size that a frame's constants are made for.
    pub(crate) fn check_size(&self, (width, height): (u32, u32)) -> Result<(), RenderError> {
        if (self.width, self.height) == (width, height) {
            Ok(())
        } else {
            Err(RenderError::Size { width, height })
        }
    }
}

/// How a frame is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Whether back faces are left out.
    pub cull: bool,
    /// The colour where nothing is drawn, RGB565.
    pub clear: u16,
    /// Where colours come from.
    pub shading: Shading,
}

impl Default for Options {
    /// Back faces left out, on black, flat.
    fn default() -> Self {
        Self {
            cull: true,
            clear: 0,
            shading: Shading::Flat,
        }
    }
}

/// What drawing a frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Triangles in the mesh: `culled` + `drawn`.
    pub triangles_in: u32,
    /// Triangles that did not reach the walker: back faces, those without area, behind the near plane or off the picture,
    /// and those without a pixel's centre in their bounds.
    pub culled: u32,
    /// Triangles that went through the clipper, whether something was left or not.
    pub clipped: u32,
    /// Triangles that reached the walker, whole or in part.
    pub drawn: u32,
    /// Pixels that the walker came to: covered ones, and those where it found that a span has ended.
    pub pixels_tested: u64,
    /// Pixels covered by a triangle, each as often as it is.
    pub pixels_covered: u64,
    /// Pixels written: covered, and not behind what was there.
    pub pixels_drawn: u64,
}

/// A triangle that reached the walker, or a part of one that the clipper made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnTriangle {
    /// The triangle's number in the mesh, counted through all chunks.
    pub index: u32,
    /// Its vertices as they were snapped, clockwise on the screen (2A > 0).
    pub vertices: [ScreenVertex; 3],
    /// The side that is seen.
    pub facing: Facing,
    /// Its colour after flat shading.
    pub colour: Rgb565,
    /// The light of its vertices under smooth shading, which counts instead.
    pub lit: Option<[Lit; 3]>,
    /// Whether it comes from the clipper.
    pub clipped: bool,
}

/// Draws a mesh.
///
/// `scratch` has room for the vertices of the largest chunk; what is in it does not matter, and neither does what is in
/// the target. Triangles are drawn in their order, then those that had to be clipped in theirs, and the later wins where
/// depths are equal.
///
/// # Errors
/// [`RenderError`]; then nothing has been touched.
pub fn render(
    mesh: &Mesh,
    view: &View,
    target: &mut Target,
    scratch: &mut [Projected],
    options: &Options,
) -> Result<Stats, RenderError> {
    trace(mesh, view, target, scratch, options, |_| {})
}

/// Draws a mesh as [`render`] does, and shows every triangle just before it is drawn.
///
/// # Errors
/// [`RenderError`]; then nothing has been touched.
pub fn trace(
    mesh: &Mesh,
    view: &View,
    target: &mut Target,
    scratch: &mut [Projected],
    options: &Options,
    show: impl FnMut(&DrawnTriangle),
) -> Result<Stats, RenderError> {
    target.check()?;
    let frame = MeshSetup::new(view, target.width, target.height, mesh.radius())?;
    trace_frame(mesh, frame, target, scratch, options, show)
}

/// Draws a mesh as [`trace`] does, by constants that were made for it.
///
/// # Errors
/// [`RenderError`], also if the target has not the size of the constants; then nothing has been touched.
pub fn trace_frame(
    mesh: &Mesh,
    frame: MeshSetup,
    target: &mut Target,
    scratch: &mut [Projected],
    options: &Options,
    mut show: impl FnMut(&DrawnTriangle),
) -> Result<Stats, RenderError> {
    draw_frame(mesh, frame, target, scratch, options, &mut show)
}

/// [`trace_frame`], not generic: compiled here, once, and as this crate is optimised.
fn draw_frame(
    mesh: &Mesh,
    frame: MeshSetup,
    target: &mut Target,
    scratch: &mut [Projected],
    options: &Options,
    show: &mut dyn FnMut(&DrawnTriangle),
) -> Result<Stats, RenderError> {
    target.check()?;
    target.check_size((frame.width, frame.height))?;
    let expected = mesh
        .chunks()
        .map(|chunk| chunk.vertex_count())
        .max()
        .unwrap_or(0);
    let found = scratch.len();
    let scratch = scratch
        .get_mut(..expected)
        .ok_or(RenderError::Scratch { expected, found })?;
    target.colour.fill(options.clear);
    target.depth.fill(0);

    let mut renderer = Renderer {
        frame,
        options: *options,
        target,
        show,
        stats: Stats::default(),
    };
    renderer.regular(mesh, scratch);
    renderer.exceptions(mesh, scratch);
    let mut stats = renderer.stats;
    stats.triangles_in = mesh.triangle_count();
    stats.culled = stats.triangles_in - stats.drawn;
    Ok(stats)
}

/// Where a triangle goes after the vertex stage.
enum Path<'a> {
    /// Wholly off one side of the picture, or behind.
    Unseen,
    /// To the setup.
    Regular([&'a ScreenVertex; 3]),
    /// To the clipper.
    Exception,
}

struct Renderer<'a, 'b> {
    frame: MeshSetup,
    options: Options,
    target: &'a mut Target<'b>,
    show: &'a mut dyn FnMut(&DrawnTriangle),
    stats: Stats,
}

impl Renderer<'_, '_> {
    /// Draws what needs no clipping, and counts what does.
    fn regular(&mut self, mesh: &Mesh, scratch: &mut [Projected]) {
        let mut index = 0;
        for chunk in mesh.chunks() {
            self.project(&chunk, scratch);
            for triangle in chunk.triangles() {
                match self.path(&triangle, scratch) {
                    Path::Unseen => {}
                    Path::Regular(vertices) => {
                        let light = match self.options.shading {
                            Shading::Flat => None,
                            Shading::Smooth => {
                                Some(vertex_light(&self.frame, triangle.indices, &chunk))
                            }
                        };
                        let drawn = self.draw(index, &triangle, vertices, light.as_ref(), false);
                        self.stats.drawn += u32::from(drawn);
                    }
                    Path::Exception => self.stats.clipped += 1,
                }
                index += 1;
            }
        }
    }

    /// Draws what needs clipping.
    fn exceptions(&mut self, mesh: &Mesh, scratch: &mut [Projected]) {
        let mut left = self.stats.clipped;
        if left == 0 {
            return;
        }
        let several_chunks = mesh.chunks().nth(1).is_some();
        let mut index = 0;
        for chunk in mesh.chunks() {
            // A single chunk is still in the scratch.
            if several_chunks {
                self.project(&chunk, scratch);
            }
            for triangle in chunk.triangles() {
                if let Path::Exception = self.path(&triangle, scratch) {
                    let drawn = self.clip(index, &triangle, &chunk);
                    self.stats.drawn += u32::from(drawn);
                    left -= 1;
                    if left == 0 {
                        return;
                    }
                }
                index += 1;
            }
        }
    }

    /// The vertex stage for a whole chunk.
    fn project(&self, chunk: &Chunk, scratch: &mut [Projected]) {
        for (vertex, projected) in chunk.vertices().zip(scratch) {
            *projected = project(&self.frame, &transform(&self.frame, vertex.position));
        }
    }

    fn path<'s>(&self, triangle: &Triangle, scratch: &'s [Projected]) -> Path<'s> {
        // A checked mesh has all the vertices it names.
        let [Some(a), Some(b), Some(c)] = triangle.indices.map(|i| scratch.get(usize::from(i)))
        else {
            return Path::Unseen;
        };
        match [a, b, c].map(Projected::place) {
            [None, None, None] => Path::Unseen,
            [Some(a), Some(b), Some(c)] if self.off_screen([a, b, c]) => Path::Unseen,
            [Some(p), Some(q), Some(r)] if ![a, b, c].iter().any(|v| v.is_beyond_guard()) => {
                Path::Regular([p, q, r])
            }
            _ => Path::Exception,
        }
    }

    /// Whether all vertices are off the same side of the picture.
    fn off_screen(&self, [a, b, c]: [&ScreenVertex; 3]) -> bool {
        // A bitwise and is negative when all are.
        let off = |[a, b, c]: [i32; 3], size: u32| {
            let last = (size << 8) as i32 - 1;
            a & b & c < 0 || (last - a) & (last - b) & (last - c) < 0
        };
        off([a.x, b.x, c.x], self.frame.width) || off([a.y, b.y, c.y], self.frame.height)
    }

    /// Clips a triangle and draws what is left. Returns whether a part of it reached the walker.
    fn clip(&mut self, index: u32, triangle: &Triangle, chunk: &Chunk) -> bool {
        let (frame, shading) = (self.frame, self.options.shading);
        let mut any = false;
        clip_fan(&frame, shading, triangle, chunk, &mut |corners| {
            let light = lit_corners(shading, corners);
            any |= self.draw(
                index,
                triangle,
                corners.map(|c| &c.place),
                light.as_ref(),
                true,
            );
        });
        any
    }

    /// Setup, shading and walk of one screen triangle. Returns whether it reached the walker.
    fn draw(
        &mut self,
        index: u32,
        triangle: &Triangle,
        vertices: [&ScreenVertex; 3],
        light: Option<&[Light; 3]>,
        clipped: bool,
    ) -> bool {
        let Some(placed) = Placed::new(&self.frame, self.options.cull, triangle, vertices, light)
        else {
            return false;
        };
        (self.show)(&DrawnTriangle {
            index,
            vertices: placed.oriented.vertices,
            facing: placed.oriented.facing,
            colour: placed.colour,
            lit: placed.lit,
            clipped,
        });
        let coverage = raster::draw(&placed.setup(), placed.colour, self.target);
        self.stats.pixels_tested += u64::from(coverage.tested);
        self.stats.pixels_covered += u64::from(coverage.covered);
        self.stats.pixels_drawn += u64::from(coverage.drawn);
        true
    }
}

/// A screen triangle that reaches the walker.
struct Placed {
    oriented: Oriented,
    bounds: Bounds,
    colour: Rgb565,
    lit: Option<[Lit; 3]>,
}

impl Placed {
    /// Nothing for a back face that is culled, and where no pixel can be covered.
    fn new(
        frame: &MeshSetup,
        cull: bool,
        triangle: &Triangle,
        vertices: [&ScreenVertex; 3],
        light: Option<&[Light; 3]>,
    ) -> Option<Self> {
        let oriented = Oriented::new(vertices.map(|v| *v))?;
        let facing = oriented.facing;
        if cull && facing == Facing::Back {
            return None;
        }
        let bounds = Bounds::new(&oriented.vertices, frame.width, frame.height)?;
        let intensity = intensity(triangle.normal, &frame.n, facing);
        Some(Self {
            oriented,
            bounds,
            colour: lit(triangle.colour, intensity),
            lit: light.map(|light| facing.order(light.map(|light| light.to(facing)))),
        })
    }

    fn setup(&self) -> Setup {
        match &self.lit {
            None => Setup::new(&self.oriented, self.bounds),
            Some(lit) => Setup::smooth(&self.oriented, self.bounds, lit),
        }
    }
}

/// The light of a triangle's vertices.
///
/// Not inlined, so that flat triangles need no room for it in an instruction cache.
#[inline(never)]
fn vertex_light(frame: &MeshSetup, indices: [u16; 3], chunk: &Chunk) -> [Light; 3] {
    indices.map(|i| {
        // A checked mesh has all the vertices it names.
        chunk.vertex(usize::from(i)).map_or(Light::default(), |v| {
            Light::new(v.colour, v.normal, &frame.n)
        })
    })
}

/// A vertex of what the clipper leaves, with its light under smooth shading.
struct Corner {
    place: ScreenVertex,
    light: Light,
}

/// The light of what the clipper leaves, where it counts.
fn lit_corners(shading: Shading, corners: [&Corner; 3]) -> Option<[Light; 3]> {
    (shading == Shading::Smooth).then(|| corners.map(|corner| corner.light))
}

/// Clips a triangle, and gives out what is left as a fan.
fn clip_fan(
    frame: &MeshSetup,
    shading: Shading,
    triangle: &Triangle,
    chunk: &Chunk,
    emit: &mut dyn FnMut([&Corner; 3]),
) {
    let [Some(a), Some(b), Some(c)] = triangle.indices.map(|i| chunk.vertex(usize::from(i))) else {
        return;
    };
    // Starting at the smallest position, so that it does not matter which vertex the triangle names first.
    let [p, q, r] = [&a, &b, &c].map(|vertex| vertex.position);
    let vertices = if p <= q && p <= r {
        [a, b, c]
    } else if q <= r {
        [b, c, a]
    } else {
        [c, a, b]
    };
    let corners = vertices.map(|vertex| CameraVertex {
        light: match shading {
            Shading::Flat => Light::default(),
            Shading::Smooth => Light::new(vertex.colour, vertex.normal, &frame.n),
        },
        ..transform(frame, vertex.position)
    });
    if off_picture(frame, &corners) {
        return;
    }
    let polygon = clip(frame, corners);
    let mut left = polygon.vertices().iter().map(|vertex| Corner {
        place: snap(frame, vertex),
        light: vertex.light,
    });
    let (Some(first), Some(mut last)) = (left.next(), left.next()) else {
        return;
    };
    for corner in left {
        emit([&first, &last, &corner]);
        last = corner;
    }
}

/// Clips the triangles that the gateware has left as exceptions, by their `numbers` in the mesh, and gives out the setup
/// and the colour of every part that is left. Returns how many triangles have one.
///
/// Numbers come in ascending order from the gateware; in another order they take longer. One that the mesh has not is
/// passed over.
pub fn clip_exceptions(
    mesh: &Mesh,
    frame: &MeshSetup,
    options: &Options,
    numbers: &mut dyn Iterator<Item = u32>,
    emit: &mut dyn FnMut(&Setup, Rgb565),
) -> u32 {
    let mut chunks = mesh.chunks();
    let (mut chunk, mut first) = (chunks.next(), 0);
    let mut drawn = 0;
    for number in numbers {
        if number < first {
            chunks = mesh.chunks();
            (chunk, first) = (chunks.next(), 0);
        }
        while let Some(passed) = &chunk
            && number - first >= passed.triangle_count() as u32
        {
            first += passed.triangle_count() as u32;
            chunk = chunks.next();
        }
        let Some(chunk) = &chunk else { continue };
        let Some(triangle) = chunk.triangle((number - first) as usize) else {
            continue;
        };
        let mut any = false;
        clip_fan(frame, options.shading, &triangle, chunk, &mut |corners| {
            let light = lit_corners(options.shading, corners);
            let vertices = corners.map(|corner| &corner.place);
            if let Some(placed) =
                Placed::new(frame, options.cull, &triangle, vertices, light.as_ref())
            {
                emit(&placed.setup(), placed.colour);
                any = true;
            }
        });
        drawn += u32::from(any);
    }
    drawn
}

/// A buffer of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffer {
    /// The picture.
    Colour,
    /// The depth codes.
    Depth,
}

/// Why a frame was not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RenderError {
    /// The picture's size is not one of the [`SIZES`].
    Size {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
    /// A buffer does not have one number a pixel.
    Buffer {
        /// Which.
        buffer: Buffer,
        /// The pixels.
        expected: usize,
        /// The numbers.
        found: usize,
    },
    /// The scratch is smaller than the largest chunk.
    Scratch {
        /// Vertices of the largest chunk.
        expected: usize,
        /// Room for vertices.
        found: usize,
    },
    /// The eye is too far from the origin for a mesh.
    Eye([Q32_32; 3]),
    /// Two eyes, where there is a mesh in the field.
    Stereo,
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Size { width, height } => {
                write!(f, "picture size {width}x{height}: expected")?;
                SIZES
                    .iter()
                    .enumerate()
                    .try_for_each(|(i, (width, height))| {
                        write!(f, "{} {width}x{height}", if i == 0 { "" } else { "," })
                    })
            }
            Self::Buffer {
                buffer,
                expected,
                found,
            } => {
                let name = match buffer {
                    Buffer::Colour => "colour",
                    Buffer::Depth => "depth",
                };
                write!(
                    f,
                    "{name} buffer of {found} pixels: expected {expected}, the picture's width times its height"
                )
            }
            Self::Scratch { expected, found } => {
                write!(
                    f,
                    "scratch for {found} vertices: expected at least {expected}, as the largest chunk has"
                )
            }
            Self::Eye([x, y, z]) => {
                write!(
                    f,
                    "eye ({x}, {y}, {z}): expected within {MAX_EYE} of the origin for a mesh"
                )
            }
            Self::Stereo => {
                f.write_str("two eyes: expected a field alone, or one eye for a mesh in a field")
            }
        }
    }
}

impl core::error::Error for RenderError {}
