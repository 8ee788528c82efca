//! What is to be seen: the camera and how the picture is drawn, and whether that has changed since it was drawn.

use core::fmt;

use glint_core::appearance::Appearance;
use glint_core::camera::{View, ViewError};
use glint_core::colour::Shading;
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::picture::Backend;
use glint_core::stereo::Stereo;
use glint_hal::display::Scale;
use glint_hal::raymarch::Missing;
use glint_hal::triangle::{Counters, Fault};
use glint_model::raymarch::FieldStats;
use glint_model::{RenderError, Stats};

/// A camera on a sphere about the origin.
#[derive(Clone, Copy)]
pub struct Sphere {
    /// Distance from the origin.
    pub r: Q32_32,
    /// Azimuth.
    pub theta: Turns,
    /// Angle from the z axis.
    pub phi: Turns,
}

impl Sphere {
    /// Where the machine starts: far enough to see all of a model, from above and in front.
    const START: Self = Self {
        r: Q32_32::lit("2.5"),
        // 40° and 65°.
        theta: Turns::from_degrees(Q32_32::lit("40")),
        phi: Turns::from_degrees(Q32_32::lit("65")),
    };

    fn view(self) -> Result<View, ViewError> {
        View::spherical(self.r, self.theta, self.phi)
    }
}

/// The last frame.
#[derive(Clone, Copy)]
pub struct Drawn {
    /// Clock cycles that it took, waiting for the screen not included.
    pub cycles: u64,
    /// What the renderer counted.
    pub stats: Counts,
    /// Who drew it.
    pub by: Painter,
    /// Whether its depth codes are in memory.
    pub has_depth: bool,
}

/// What was counted of a frame.
#[derive(Clone, Copy)]
pub struct Counts {
    /// Of its mesh, if it has one.
    pub triangles: Option<Stats>,
    /// Of its field.
    pub rays: Option<FieldStats>,
}

/// Who has drawn a frame.
#[derive(Clone, Copy)]
pub enum Painter {
    /// The CPU, because it was to, or because the gateware could not.
    Cpu(Option<Fallback>),
    /// The triangle engine, with its counters.
    Engine(Counters),
}

/// Why the gateware could not draw.
#[derive(Clone, Copy, Debug)]
pub enum Fallback {
    /// The triangle engine could not.
    Triangle(Fault),
    /// The raymarcher lacks something, or is not there at all.
    Field(Option<Missing>),
}

impl From<Fault> for Fallback {
    fn from(fault: Fault) -> Self {
        Self::Triangle(fault)
    }
}

impl fmt::Display for Fallback {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Triangle(fault) => fault.fmt(f),
            Self::Field(Some(missing)) => missing.fmt(f),
            Self::Field(None) => {
                f.write_str("distance fields: this gateware has no engine for them")
            }
        }
    }
}

/// The state that a frame shows.
pub struct Scene {
    field: Option<Field>,
    with_mesh: bool,
    stereo: Option<Stereo>,
    appearance: Appearance,
    prepass: bool,
    view: View,
    sphere: Sphere,
    scale: Scale,
    cull: bool,
    shading: Shading,
    backend: Backend,
    changed: bool,
    wants_depth: bool,
    drawn: Option<Result<Drawn, RenderError>>,
}

impl Scene {
    /// The start, to be drawn by `backend`.
    ///
    /// # Errors
    /// When the first camera is none.
    pub fn new(backend: Backend) -> Result<Self, ViewError> {
        let sphere = Sphere::START;
        Ok(Self {
            field: None,
            with_mesh: false,
            stereo: None,
            appearance: Appearance::default(),
            prepass: false,
            view: sphere.view()?,
            sphere,
            scale: Scale::Four,
            cull: true,
            shading: Shading::Flat,
            backend,
            changed: true,
            wants_depth: false,
            drawn: None,
        })
    }

    /// The distance field that is shown, instead of the mesh or with it.
    pub const fn field(&self) -> Option<&Field> {
        self.field.as_ref()
    }

    /// Shows a field, or the mesh.
    pub fn set_field(&mut self, field: Option<Field>) {
        self.changed |= self.field != field;
        self.field = field;
    }

    /// Whether a field is shown with the mesh in it.
    pub const fn with_mesh(&self) -> bool {
        self.with_mesh
    }

    /// Sets whether a field is shown with the mesh in it.
    pub fn set_with_mesh(&mut self, with_mesh: bool) {
        self.changed |= self.field.is_some() && self.with_mesh != with_mesh;
        self.with_mesh = with_mesh;
    }

    /// How a field looks.
    pub const fn appearance(&self) -> &Appearance {
        &self.appearance
    }

    /// Changes how a field looks.
    pub fn set_appearance(&mut self, appearance: Appearance) {
        self.changed |= self.field.is_some() && self.appearance != appearance;
        self.appearance = appearance;
    }

    /// The two eyes that look at a field.
    pub const fn stereo(&self) -> Option<Stereo> {
        self.stereo
    }

    /// Sets two eyes, or one.
    pub fn set_stereo(&mut self, stereo: Option<Stereo>) {
        // A mesh is seen with one eye.
        self.changed |= self.field.is_some() && self.stereo != stereo;
        self.stereo = stereo;
    }

    /// Whether cones go before the rays of a field.
    pub const fn prepass(&self) -> bool {
        self.prepass
    }

    /// Sets whether they do.
    pub fn set_prepass(&mut self, prepass: bool) {
        self.changed |= self.field.is_some() && self.prepass != prepass;
        self.prepass = prepass;
    }

    /// The camera.
    pub const fn view(&self) -> &View {
        &self.view
    }

    /// Sets any camera.
    pub fn set_view(&mut self, view: View) {
        self.changed |= self.view != view;
        self.view = view;
    }

    /// The spherical camera that was set last.
    pub const fn sphere(&self) -> Sphere {
        self.sphere
    }

    /// Moves and turns the camera, and leaves its lens.
    pub fn move_view(&mut self, view: View) {
        self.set_view(view.with_lens_of(&self.view));
    }

    /// Sets a spherical camera, and leaves its lens.
    ///
    /// # Errors
    /// When it is out of range; then nothing changes.
    pub fn set_sphere(&mut self, sphere: Sphere) -> Result<(), ViewError> {
        self.move_view(sphere.view()?);
        self.sphere = sphere;
        Ok(())
    }

    /// The picture's size, as its scale on the screen.
    pub const fn scale(&self) -> Scale {
        self.scale
    }

    /// Sets the picture's size.
    pub fn set_scale(&mut self, scale: Scale) {
        self.changed |= self.scale != scale;
        self.scale = scale;
    }

    /// Whether back faces are left out.
    pub const fn cull(&self) -> bool {
        self.cull
    }

    /// Sets whether back faces are left out.
    pub fn set_cull(&mut self, cull: bool) {
        self.changed |= self.cull != cull;
        self.cull = cull;
    }

    /// Where colours come from.
    pub const fn shading(&self) -> Shading {
        self.shading
    }

    /// Sets where colours come from.
    pub fn set_shading(&mut self, shading: Shading) {
        self.changed |= self.shading != shading;
        self.shading = shading;
    }

    /// Who is to draw.
    pub const fn backend(&self) -> Backend {
        self.backend
    }

    /// Sets who is to draw.
    pub fn set_backend(&mut self, backend: Backend) {
        self.changed |= self.backend != backend;
        self.backend = backend;
    }

    /// Whether depth codes are to be in memory with the next frame.
    pub const fn wants_depth(&self) -> bool {
        self.wants_depth
    }

    /// Wants the depth codes of what is shown in memory, or no longer. The engine writes them only for those who do.
    pub const fn want_depth(&mut self, wanted: bool) {
        self.wants_depth = wanted;
    }

    /// Something else than the above has changed: the model.
    pub const fn touch(&mut self) {
        self.changed = true;
    }

    /// Whether a frame is to be drawn.
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

    /// The last frame, if one was drawn.
    pub const fn drawn(&self) -> Option<Result<Drawn, RenderError>> {
        self.drawn
    }

    /// A frame has been drawn of what the scene is now.
    pub const fn set_drawn(&mut self, drawn: Result<Drawn, RenderError>) {
        self.drawn = Some(drawn);
        self.changed = false;
    }
}
