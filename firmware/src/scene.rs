//! The scene: model or field, camera, size and appearance, and whether they have changed since the last frame.

use core::fmt;

use glint_core::appearance::Appearance;
use glint_core::camera::{View, ViewError};
use glint_core::colour::{Shading, Winding};
use glint_core::feature::{CPU, FIELD, OBJECT, OVERLAY, STEREO, WIREFRAME};
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::picture::{Backend, Edges, Size};
use glint_core::quality::Quality;
use glint_core::stereo::Stereo;
use glint_core::wireframe::{Motion, Step};
use glint_hal::frequency::Frequency;
use glint_hal::triangle::Counters;
use glint_model::MeshOptions;
use glint_model::{Clip, FieldSubject, Frame, FrameStats, RenderError, Subject, WireframeSubject};

use crate::gateware::{Fallback, Lack};
use crate::mark::Mark;
use crate::models::Models;

/// A camera on a sphere about the origin.
#[derive(Clone, Copy)]
pub struct Sphere {
    /// Distance from the origin in world units.
    pub r: Q32_32,
    /// Azimuth, about the z axis.
    pub theta: Turns,
    /// Angle from the z axis.
    pub phi: Turns,
}

impl Sphere {
    /// The camera at start, which shows the whole model from above and in front.
    const START: Self = Self {
        r: Q32_32::lit("2.5"),
        // Azimuth 40°, and 65° from the z axis.
        theta: Turns::from_degrees(Q32_32::lit("40")),
        phi: Turns::from_degrees(Q32_32::lit("65")),
    };

    fn view(self) -> Result<View, ViewError> {
        View::spherical(self.r, self.theta, self.phi)
    }
}

/// Statistics of the last frame.
#[derive(Clone, Copy)]
pub struct Drawn {
    /// Clock cycles of drawing the frame, without the wait for a free frame buffer.
    pub cycles: u64,
    /// Counts of triangles, rays and pixels.
    pub stats: FrameStats,
    /// Which renderer drew the frame.
    pub by: RenderedBy,
    /// Whether the frame's depth codes are in memory.
    pub has_depth: bool,
}

impl Drawn {
    /// Number of such frames a second.
    pub fn rate(&self, frequency: Frequency) -> u64 {
        u64::from(frequency.hertz()) / self.cycles.max(1)
    }
}

/// The renderer of a frame.
#[derive(Clone, Copy)]
pub enum RenderedBy {
    /// The CPU, with the reason if the gateware could not draw the frame.
    Cpu(Option<Fallback>),
    /// The gateware, with the triangle engine's counters, and the reason if the CPU made the descriptors.
    Gateware(Counters, Option<Lack>),
}

/// Reason why a frame is not drawn.
#[derive(Clone, Copy, Debug)]
pub enum DrawError {
    /// The CPU cannot draw it.
    Render(RenderError),
    /// The gateware cannot draw it, for this reason or as the backend is the CPU, and this build leaves out drawing by the CPU.
    NoCpu(Option<Fallback>),
}

impl fmt::Display for DrawError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Render(error) => error.fmt(f),
            Self::NoCpu(None) => CPU.fmt(f),
            Self::NoCpu(Some(fallback)) => write!(f, "{fallback}; {CPU}"),
        }
    }
}

/// The state that the console sets.
pub struct Scene {
    /// The motion of the wireframe, while it is shown.
    wireframe: Option<Motion>,
    /// Whether the objects are shown.
    objects: bool,
    field: Option<Field>,
    with_mesh: bool,
    stereo: Option<Stereo>,
    appearance: Appearance,
    quality: Quality,
    prepass: bool,
    edges: Option<Edges>,
    view: View,
    sphere: Sphere,
    size: Size,
    options: MeshOptions,
    backend: Backend,
    changed: bool,
    wants_depth: bool,
    mark: Option<Mark>,
    overlay: bool,
    drawn: Option<Result<Drawn, DrawError>>,
}

impl Scene {
    /// The scene at start, drawn by `backend`.
    ///
    /// # Errors
    /// [`ViewError`] for the camera at start.
    pub fn new(backend: Backend) -> Result<Self, ViewError> {
        let sphere = Sphere::START;
        Ok(Self {
            wireframe: None,
            objects: false,
            field: None,
            with_mesh: false,
            stereo: None,
            appearance: Appearance::default(),
            quality: Quality::default(),
            prepass: false,
            edges: None,
            view: sphere.view()?,
            sphere,
            size: Size::default(),
            options: MeshOptions::default(),
            backend,
            changed: true,
            wants_depth: false,
            mark: None,
            overlay: false,
            drawn: None,
        })
    }

    /// The options of all meshes.
    pub const fn options(&self) -> &MeshOptions {
        &self.options
    }

    /// The frame of the scene, with the shown mesh, objects or program of `models`.
    pub fn frame<'a>(&'a self, models: &'a Models) -> Frame<'a> {
        let mesh = self.options.subject(*models.mesh());
        let subject = match (&self.wireframe, &self.field) {
            (Some(motion), _) => Subject::Wireframe(WireframeSubject {
                program: *models.program(),
                pose: motion.pose(),
            }),
            (None, _) if self.objects => Subject::Objects(models.objects().all()),
            (None, None) => match self.edges {
                None => Subject::Mesh(mesh),
                Some(edges) => Subject::edges(mesh, edges),
            },
            (None, Some(field)) => {
                let field = FieldSubject {
                    field,
                    appearance: &self.appearance,
                    quality: self.quality,
                    prepass: self.prepass,
                };
                if self.with_mesh {
                    Subject::MeshInField(mesh, field)
                } else {
                    Subject::Field(field)
                }
            }
        };
        Frame {
            stereo: self.stereo(),
            ..Frame::in_appearance(subject, self.view, self.size, &self.appearance)
        }
    }

    /// Whether the wireframe is shown.
    pub const fn shows_wireframe(&self) -> bool {
        WIREFRAME.is_built && self.wireframe.is_some()
    }

    /// Shows the wireframe as its program has it. Edges of a mesh and two eyes are off from now on.
    pub fn show_wireframe(&mut self) {
        self.wireframe = Some(Motion::default());
        self.objects = false;
        self.edges = None;
        self.stereo = None;
        self.changed = true;
    }

    /// Whether the objects are shown.
    pub const fn shows_objects(&self) -> bool {
        OBJECT.is_built && self.objects
    }

    /// Shows the objects. Edges of a mesh are off from now on.
    pub const fn show_objects(&mut self) {
        self.wireframe = None;
        self.objects = true;
        self.edges = None;
        self.changed = true;
    }

    /// Moves the wireframe by a step, if it is shown. Returns whether the step was possible.
    pub fn move_wireframe(&mut self, step: Step) -> bool {
        let moved = self
            .wireframe
            .as_mut()
            .is_some_and(|motion| motion.apply(step));
        self.changed |= moved;
        moved
    }

    /// The distance field, alone or with the mesh in it.
    pub const fn field(&self) -> Option<&Field> {
        if FIELD.is_built {
            self.field.as_ref()
        } else {
            None
        }
    }

    /// Whether the field is shown, alone or with the mesh in it.
    pub const fn shows_field(&self) -> bool {
        self.field.is_some() && self.wireframe.is_none() && !self.objects
    }

    /// Shows a field, or the mesh alone for `None`, instead of wireframe or objects if they are shown. A field sets the edges of a mesh
    /// off.
    pub fn set_field(&mut self, field: Option<Field>) {
        self.changed |= self.wireframe.take().is_some() || self.objects || self.field != field;
        self.objects = false;
        if field.is_some() {
            self.edges = None;
        }
        self.field = field;
    }

    /// Whether the mesh is shown in a field.
    pub const fn with_mesh(&self) -> bool {
        self.with_mesh
    }

    /// Sets whether a field is shown with the mesh in it or alone.
    pub fn set_with_mesh(&mut self, with_mesh: bool) {
        self.changed |= self.field.is_some() && self.with_mesh != with_mesh;
        self.with_mesh = with_mesh;
    }

    /// The appearance of a field, with the lights of meshes.
    pub const fn appearance(&self) -> &Appearance {
        &self.appearance
    }

    /// Sets the appearance of a field, with the lights of meshes.
    pub fn set_appearance(&mut self, appearance: Appearance) {
        self.changed |= if self.shows_field() {
            self.appearance != appearance
        } else {
            self.appearance.mesh_lighting() != appearance.mesh_lighting()
                || self.appearance.mesh_background() != appearance.mesh_background()
        };
        self.appearance = appearance;
    }

    /// The two eyes; `None` for one eye, which wireframes always have.
    pub const fn stereo(&self) -> Option<Stereo> {
        if STEREO.is_built { self.stereo } else { None }
    }

    /// Sets two eyes, or one eye for `None`. Returns whether that was possible.
    pub fn set_stereo(&mut self, stereo: Option<Stereo>) -> bool {
        let is_possible = stereo.is_none() || self.wireframe.is_none();
        if is_possible {
            self.changed |= self.stereo != stereo;
            self.stereo = stereo;
        }
        is_possible
    }

    /// The quality that was set last. The size may be another one.
    pub const fn quality(&self) -> Quality {
        self.quality
    }

    /// Sets the precision of a field's rays to that of a quality.
    pub fn set_quality(&mut self, quality: Quality) {
        self.changed |= self.field.is_some() && self.quality != quality;
        self.quality = quality;
    }

    /// Sets whether a prepass marches cones before the rays of a field.
    pub fn set_prepass(&mut self, prepass: bool) {
        self.changed |= self.field.is_some() && self.prepass != prepass;
        self.prepass = prepass;
    }

    /// Whether a mesh is shown alone: no field, objects or wireframe.
    const fn shows_mesh_alone(&self) -> bool {
        self.field.is_none() && self.wireframe.is_none() && !self.objects
    }

    /// The edges of the mesh that is shown alone; `None` for its faces alone, and as soon as anything else is shown.
    pub const fn edges(&self) -> Option<Edges> {
        self.edges
    }

    /// Sets the edges of the mesh that is shown alone. Returns whether that was possible.
    pub fn set_edges(&mut self, edges: Option<Edges>) -> bool {
        let is_possible = edges.is_none() || self.shows_mesh_alone();
        if is_possible {
            self.changed |= self.edges != edges;
            self.edges = edges;
        }
        is_possible
    }

    /// Sets everything except backend and overlay as at start.
    ///
    /// # Errors
    /// [`ViewError`] for the camera at start.
    pub fn reset(&mut self) -> Result<(), ViewError> {
        self.view = Sphere::START.view()?;
        self.sphere = Sphere::START;
        self.wireframe = None;
        self.objects = false;
        self.field = None;
        self.with_mesh = false;
        self.stereo = None;
        self.appearance = Appearance::default();
        self.quality = Quality::default();
        self.prepass = false;
        self.edges = None;
        self.size = Size::default();
        self.options = MeshOptions::default();
        self.changed = true;
        Ok(())
    }

    /// The camera.
    pub const fn view(&self) -> &View {
        &self.view
    }

    /// Sets the camera.
    pub fn set_view(&mut self, view: View) {
        self.changed |= self.view != view;
        self.view = view;
    }

    /// The camera on a sphere that was set last.
    pub const fn sphere(&self) -> Sphere {
        self.sphere
    }

    /// Sets position and basis of the camera to those of `view`, and keeps projection, half width and near plane.
    pub fn move_view(&mut self, view: View) {
        self.set_view(view.with_lens_of(&self.view));
    }

    /// Sets position and basis of the camera to those of a camera on a sphere.
    ///
    /// # Errors
    /// [`ViewError`] for a camera out of range; the scene is then unchanged.
    pub fn set_sphere(&mut self, sphere: Sphere) -> Result<(), ViewError> {
        self.move_view(sphere.view()?);
        self.sphere = sphere;
        Ok(())
    }

    /// The size of the picture.
    pub const fn size(&self) -> Size {
        self.size
    }

    /// Sets the size of the picture.
    pub fn set_size(&mut self, size: Size) {
        self.changed |= self.size != size;
        self.size = size;
    }

    /// Sets whether back faces are culled.
    pub fn set_cull(&mut self, cull: bool) {
        self.changed |= self.options.cull != cull;
        self.options.cull = cull;
    }

    /// The shading of the mesh.
    pub const fn shading(&self) -> Shading {
        self.options.shading
    }

    /// Sets the shading of the mesh.
    pub fn set_shading(&mut self, shading: Shading) {
        self.changed |= self.options.shading != shading;
        self.options.shading = shading;
    }

    /// Sets the clipping of the mesh's triangles.
    pub fn set_clip(&mut self, clip: Clip) {
        self.changed |= self.options.clip != clip;
        self.options.clip = clip;
    }

    /// Sets the rule that tells which side of a triangle is seen.
    pub fn set_winding(&mut self, winding: Winding) {
        self.changed |= self.options.winding != winding;
        self.options.winding = winding;
    }

    /// The backend.
    pub const fn backend(&self) -> Backend {
        self.backend
    }

    /// Sets the backend.
    pub fn set_backend(&mut self, backend: Backend) {
        self.changed |= self.backend != backend;
        self.backend = backend;
    }

    /// Whether the next frame needs depth codes in memory.
    pub const fn wants_depth(&self) -> bool {
        self.wants_depth
    }

    /// Requests depth codes in memory for the next frame. The gateware writes them on request only.
    pub const fn want_depth(&mut self, wanted: bool) {
        self.wants_depth = wanted;
    }

    /// The mark of the hand's position, if it is drawn.
    pub const fn mark(&self) -> Option<Mark> {
        self.mark
    }

    /// Sets the mark of the hand's position; `None` draws none.
    pub fn set_mark(&mut self, mark: Option<Mark>) {
        self.changed |= self.mark != mark;
        self.mark = mark;
    }

    /// Whether text is written over the picture.
    pub const fn has_overlay(&self) -> bool {
        OVERLAY.is_built && self.overlay
    }

    /// Sets whether text is written over the picture.
    pub fn set_overlay(&mut self, overlay: bool) {
        self.changed |= self.overlay != overlay;
        self.overlay = overlay;
    }

    /// Marks the scene as changed, after a change of the mesh that it shows.
    pub const fn touch(&mut self) {
        self.changed = true;
    }

    /// Whether a new frame is needed.
    pub const fn changed(&self) -> bool {
        self.changed
            || self.wants_depth
                && matches!(
                    self.drawn,
                    Some(Ok(Drawn {
                        has_depth: false,
                        ..
                    }))
                )
    }

    /// Statistics of the last frame, if there is one, or the error of its drawing.
    pub const fn drawn(&self) -> Option<Result<Drawn, DrawError>> {
        self.drawn
    }

    /// Stores the statistics of the frame of the present scene, or the error of its drawing.
    pub const fn set_drawn(&mut self, drawn: Result<Drawn, DrawError>) {
        self.drawn = Some(drawn);
        self.changed = false;
    }
}
