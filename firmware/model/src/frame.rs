//! A frame: the description of one picture, its constants, and its drawing by the model.
//!
//! The CPU backend, the gateware's driver and the host share these types. [`Frame`] is the description, [`FrameConstants`]
//! are computed from the description once, and [`Frame::draw`] draws the picture in integers, bit for bit as the gateware does.

use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::colour::{Rgb565, Shading, Winding};
use glint_core::field::Field;
use glint_core::light::MeshLighting;
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_core::stereo::Stereo;

use crate::depth::DepthScale;
use crate::error::RenderError;
use crate::frame_buffer::FrameBuffer;
use crate::mesh_in_field;
use crate::raymarch::{
    FieldOptions, FieldSetup, FieldStats, Palette, Ray, RayResult, render_field,
};
use crate::triangle::setup::Setup;
use crate::triangle::{
    Clip, DrawnTriangle, MeshLight, MeshSetup, Options, Part, Placement, Projected, Stats,
    draw_parts, set_up_parts,
};
use crate::wireframe::{WireframeStats, WireframeSubject, render_wireframe};

/// Number of triangles that are drawn between two calls of `progress` in [`Frame::draw`].
const TRIANGLES_A_CALL: u32 = 32;
/// Number of pixels of a field that are drawn between two calls of `progress` in [`Frame::draw`].
const PIXELS_A_CALL: u32 = 16;

/// The description of one picture.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Mesh, field, both, several meshes, or a wireframe.
    pub subject: Subject<'a>,
    /// Camera. A wireframe has its own eye and view plane.
    pub view: View,
    /// Size of the picture.
    pub size: Size,
    /// Colour of pixels without a triangle. A field covers every pixel.
    pub clear: Rgb565,
    /// Light on the meshes. A field, and a mesh in it, have the lights of the field's appearance.
    pub lighting: MeshLighting,
}

/// The subject of a frame.
#[derive(Clone, Copy, Debug)]
pub enum Subject<'a> {
    /// A mesh.
    Mesh(MeshSubject<'a>),
    /// A distance field.
    Field(FieldSubject<'a>),
    /// A mesh in a distance field.
    MeshInField(MeshSubject<'a>, FieldSubject<'a>),
    /// Several meshes, each with a place of its own. Of equal depths the later object wins.
    Objects(&'a [Object<'a>]),
    /// A program of the wireframe simulator.
    Wireframe(WireframeSubject<'a>),
}

/// A mesh with a place in the world.
#[derive(Clone, Copy, Debug)]
pub struct Object<'a> {
    /// The mesh and its options.
    pub subject: MeshSubject<'a>,
    /// The place: a model matrix.
    pub placement: Placement,
    /// Colour in place of those of the mesh.
    pub colour: Option<Rgb565>,
}

/// A mesh and its options.
#[derive(Clone, Copy, Debug)]
pub struct MeshSubject<'a> {
    /// The mesh.
    pub mesh: Mesh<'a>,
    /// Whether back faces are left out.
    pub cull: bool,
    /// Source of the colours: triangles (flat) or vertices (smooth).
    pub shading: Shading,
    /// Clipping of triangles.
    pub clip: Clip,
    /// The rule that tells which side of a triangle is seen.
    pub winding: Winding,
}

/// A distance field and its options.
#[derive(Clone, Copy, Debug)]
pub struct FieldSubject<'a> {
    /// The field.
    pub field: &'a Field,
    /// Material, lights, background, fog and occlusion.
    pub appearance: &'a Appearance,
    /// Two eyes for a stereo picture, or `None` for one eye. A mesh in a field has one eye.
    pub stereo: Option<Stereo>,
    /// Whether a prepass marches one cone for each block of pixels before the rays (docs/formats.md, "Cones").
    pub prepass: bool,
}

impl<'a> MeshSubject<'a> {
    fn options(&self) -> Options<'a> {
        Options {
            cull: self.cull,
            shading: self.shading,
            winding: self.winding,
            ..Options::default()
        }
    }

    /// A mesh with flat shading, culled back faces, clipping to the guard band and its own winding.
    pub const fn new(mesh: Mesh<'a>) -> Self {
        Self {
            mesh,
            cull: true,
            shading: Shading::Flat,
            clip: Clip::Guard,
            winding: Winding::Mesh,
        }
    }
}

impl<'a> Subject<'a> {
    /// A mesh with the default options of [`MeshSubject::new`].
    pub const fn mesh(mesh: Mesh<'a>) -> Self {
        Self::Mesh(MeshSubject::new(mesh))
    }

    /// The mesh, if the subject has one.
    pub const fn mesh_part(&self) -> Option<&MeshSubject<'a>> {
        match self {
            Self::Mesh(mesh) | Self::MeshInField(mesh, _) => Some(mesh),
            Self::Field(_) | Self::Objects(_) | Self::Wireframe(_) => None,
        }
    }

    /// The objects, if the subject has several meshes.
    pub const fn objects(&self) -> Option<&'a [Object<'a>]> {
        match self {
            Self::Objects(objects) => Some(objects),
            _ => None,
        }
    }

    /// The mesh with this number, and the options of its drawing in a light ([`FrameConstants::light`]), of which `clear` has no effect;
    /// `None` after the last mesh.
    pub fn numbered_mesh<'s>(
        &'s self,
        number: usize,
        light: Option<&'s MeshLight>,
    ) -> Option<(&'s MeshSubject<'a>, Options<'s>)> {
        match self {
            Self::Mesh(subject) | Self::MeshInField(subject, _) if number == 0 => {
                let options = Options {
                    light,
                    ..subject.options()
                };
                Some((subject, options))
            }
            Self::Objects(objects) => {
                let object = objects.get(number)?;
                let options = Options {
                    colour: object.colour,
                    light,
                    normals: object.placement.normals(),
                    lit_in_world: object.placement.has_normals_in_world(),
                    ..object.subject.options()
                };
                Some((&object.subject, options))
            }
            _ => None,
        }
    }

    /// The field, if the subject has one.
    pub const fn field_part(&self) -> Option<&FieldSubject<'a>> {
        match self {
            Self::Field(field) | Self::MeshInField(_, field) => Some(field),
            Self::Mesh(_) | Self::Objects(_) | Self::Wireframe(_) => None,
        }
    }
}

impl FieldSubject<'_> {
    fn options(&self, view: &View) -> FieldOptions {
        FieldOptions {
            prepass: self.prepass,
            ..FieldOptions::new(self.field, self.appearance, self.stereo, view)
        }
    }
}

/// Numbers of a frame that do not depend on the pixel or triangle, computed once before drawing.
///
/// The constants take about 1,500 bytes, mostly tables of a field's palette. To save time, keep one `FrameConstants`
/// and [update](Self::update) it for each frame instead of moving new ones.
#[derive(Clone, Debug, Default)]
pub struct FrameConstants {
    mesh: Option<MeshSetup>,
    light: Option<MeshLight>,
    field: Option<FieldConstants>,
}

/// Frame constants of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldConstants {
    /// Constants of the rays and of the solid.
    pub setup: FieldSetup,
    /// Colours of surfaces, sky and fog.
    pub palette: Palette,
}

impl FrameConstants {
    /// Returns the constants of the mesh, if the frame has a mesh.
    pub const fn mesh(&self) -> Option<&MeshSetup> {
        self.mesh.as_ref()
    }

    /// Returns the light on the meshes; `None` for white light at the camera, without ambient light.
    pub const fn light(&self) -> Option<&MeshLight> {
        self.light.as_ref()
    }

    /// Returns the constants of the field, if the frame has a field.
    pub const fn field(&self) -> Option<&FieldConstants> {
        self.field.as_ref()
    }

    /// The scale between depth codes and distances in world units; `None` before the first frame.
    pub fn depth_scale(&self) -> Option<DepthScale> {
        match (self.mesh(), self.field()) {
            (Some(mesh), _) => Some(mesh.depth),
            (None, Some(field)) => Some(field.setup.world_depth),
            (None, None) => None,
        }
    }

    /// Replaces the constants by those of `frame`.
    ///
    /// # Errors
    /// A [`RenderError`] for a frame that cannot be drawn; the constants must then not be used for drawing.
    pub fn update(&mut self, frame: &Frame) -> Result<(), RenderError> {
        (self.mesh, self.light, self.field) = (None, None, None);
        let (view, [width, height]) = (&frame.view, frame.size.pixels());
        match &frame.subject {
            Subject::Mesh(subject) => {
                let setup = MeshSetup::new(view, width, height, subject.mesh.radius())?;
                self.mesh = Some(setup.with_clip(subject.clip)?);
            }
            Subject::Field(subject) => {
                let options = subject.options(view);
                let setup = FieldSetup::new(subject.field, view, (width, height), &options)?;
                self.set_field(setup, &options);
            }
            Subject::MeshInField(mesh, subject) => {
                let (size, radius, clip) = ((width, height), mesh.mesh.radius(), mesh.clip);
                let options = subject.options(view);
                let (mesh, field) =
                    mesh_in_field::constants(view, size, radius, subject.field, &options)?;
                self.mesh = Some(mesh.with_clip(clip)?);
                self.set_field(field, &options);
            }
            Subject::Objects(objects) => {
                let mut camera = MeshSetup::new(view, width, height, 0)?;
                let depths = objects.iter().map(|object| {
                    let radius = object.subject.mesh.radius();
                    object.placement.depths(&camera, radius)
                });
                let range = |[a, b]: [i64; 2], [c, d]: [i64; 2]| [a.min(c), b.max(d)];
                camera.set_depths(depths.reduce(range));
                self.mesh = Some(camera);
            }
            Subject::Wireframe(_) => {}
        }
        let lighting = frame.mesh_lighting();
        if let Some(mesh) = &mut self.mesh
            && lighting != MeshLighting::CAMERA
        {
            let light = MeshLight::new(&lighting, view);
            mesh.light = light.row;
            self.light = Some(light);
        }
        Ok(())
    }

    fn set_field(&mut self, setup: FieldSetup, options: &FieldOptions) {
        let palette = options.palette_for(&setup);
        self.field = Some(FieldConstants { setup, palette });
    }
}

/// Counts of the work of drawing a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Counts of the mesh, if any.
    pub mesh: Option<Stats>,
    /// Counts of the field, if any.
    pub field: Option<FieldStats>,
    /// Counts of the wireframe, if any.
    pub wireframe: Option<WireframeStats>,
}

impl<'a> Frame<'a> {
    /// A frame with a black background, and white light at the camera for its meshes.
    pub const fn new(subject: Subject<'a>, view: View, size: Size) -> Self {
        Self {
            subject,
            view,
            size,
            clear: Rgb565(0),
            lighting: MeshLighting::CAMERA,
        }
    }

    /// The lighting of the meshes: that of the frame, or of the field's appearance for a mesh in a field.
    pub fn mesh_lighting(&self) -> MeshLighting {
        match &self.subject {
            Subject::MeshInField(_, field) => field.appearance.mesh_lighting(),
            _ => self.lighting,
        }
    }

    /// Computes the constants of this frame.
    ///
    /// # Errors
    /// As [`FrameConstants::update`].
    pub fn constants(&self) -> Result<FrameConstants, RenderError> {
        let mut constants = FrameConstants::default();
        constants.update(self)?;
        Ok(constants)
    }

    /// Number of vertices for which the scratch memory of [`draw`](Self::draw) needs room.
    pub fn scratch_vertices(&self) -> usize {
        (0..)
            .map_while(|number| self.subject.numbered_mesh(number, None))
            .map(|(subject, _)| subject.mesh.largest_chunk())
            .max()
            .unwrap_or(0)
    }

    /// Returns the frame constants of the mesh with this number: `constants`, those of the frame, or for an object its own ones, which
    /// are computed into `own`.
    ///
    /// # Errors
    /// As [`Placement::setup`] and [`MeshSetup::with_clip`].
    pub fn mesh_setup<'s>(
        &self,
        constants: &'s MeshSetup,
        number: usize,
        own: &'s mut Option<MeshSetup>,
    ) -> Result<&'s MeshSetup, RenderError> {
        let objects = self.subject.objects().unwrap_or_default();
        let Some(Object {
            subject, placement, ..
        }) = objects.get(number)
        else {
            return Ok(constants);
        };
        let volume = constants.volume_of(subject.clip)?;
        let own = own.get_or_insert(*constants);
        placement.update(own, &self.view, constants, subject.mesh.radius(), volume)?;
        Ok(own)
    }

    /// The mesh with this number, with its options and frame constants, from those of the frame; `None` after the last mesh.
    fn part<'s>(
        &'s self,
        constants: &'s FrameConstants,
        setup: &MeshSetup,
        number: usize,
    ) -> Result<Option<Part<'s>>, RenderError> {
        let Some((subject, options)) = self.subject.numbered_mesh(number, constants.light()) else {
            return Ok(None);
        };
        Ok(Some(Part {
            mesh: subject.mesh,
            frame: *self.mesh_setup(setup, number, &mut None)?,
            options,
        }))
    }

    /// Makes the triangles of all meshes of the frame from the frame's `constants`, in the order in which they are drawn, and calls `emit`
    /// with each and its setup. `scratch` is memory for projected vertices. The counts of pixels in the result are 0.
    ///
    /// # Errors
    /// [`RenderError`] for scratch memory that is too small, or for an object whose constants are out of range.
    pub fn set_up_meshes(
        &self,
        constants: &FrameConstants,
        scratch: &mut [Projected],
        emit: &mut dyn FnMut(&DrawnTriangle, &Setup),
    ) -> Result<Stats, RenderError> {
        let Some(setup) = constants.mesh() else {
            return Ok(Stats::default());
        };
        let mut part = |number| self.part(constants, setup, number);
        let size = (setup.width, setup.height);
        set_up_parts(&mut part, size, scratch, emit)
    }

    /// Draws the frame into `buffer` from the frame's `constants`, with `scratch` as memory for projected vertices. Calls
    /// `progress` at short intervals.
    ///
    /// # Errors
    /// [`RenderError`] for a buffer or scratch memory of the wrong size.
    pub fn draw(
        &self,
        constants: &FrameConstants,
        buffer: &mut FrameBuffer,
        scratch: &mut [Projected],
        progress: &mut dyn FnMut(),
    ) -> Result<FrameStats, RenderError> {
        let mut stats = FrameStats::default();
        if let Subject::Wireframe(subject) = &self.subject {
            stats.wireframe = Some(render_wireframe(subject, self.clear, buffer, progress)?);
            return Ok(stats);
        }
        if let Some(setup) = constants.mesh() {
            let mut part = |number| self.part(constants, setup, number);
            let mut show = |triangle: &DrawnTriangle| {
                if triangle.index.is_multiple_of(TRIANGLES_A_CALL) {
                    progress();
                }
            };
            let clear = self.clear.0;
            stats.mesh = Some(draw_parts(&mut part, clear, buffer, scratch, &mut show)?);
        } else {
            buffer.depth.fill(0);
        }
        if let Some(FieldConstants { setup, palette }) = constants.field() {
            let mut show = |x, _, _: &Ray, _: &RayResult| {
                if x % PIXELS_A_CALL == 0 {
                    progress();
                }
            };
            stats.field = Some(render_field(setup, palette, buffer, &mut show)?);
        }
        Ok(stats)
    }
}
