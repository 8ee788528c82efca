//! The scene, with its options and its conversion to frames.

use core::fmt;

use glint_core::animation::{Animation, ObjectTurn, Rate};
use glint_core::appearance::Appearance;
use glint_core::block::Block;
use glint_core::camera::{View, ViewError};
use glint_core::colour::Rounding;
use glint_core::console::{ObjectAction, Setting};
use glint_core::feature::{
    ANIMATE, ANTIALIASING, FIELD, FIT, MESH_IN_FIELD, OBJECT, OVERLAY, SKY, STEREO, WIREFRAME,
};
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, Turns, U32_32};
use glint_core::framing;
use glint_core::light::Background;
use glint_core::matrix::{Axis, Matrix, MatrixError};
use glint_core::mesh::{MAX_NAME, Mesh};
use glint_core::object::{MAX_OBJECTS, Place};
use glint_core::picture::{Backend, Edges, Samples, Size};
use glint_core::quality::Quality;
use glint_core::stereo::Stereo;
use glint_core::texture::Texture;
use glint_core::wireframe::{Motion, Program, Step};
use glint_model::{
    Clip, FieldSubject, Frame, MeshOptions, Object, Placement, Subject, WireframeSubject,
};
use heapless::{String, Vec};

use crate::error::{ObjectError, SettingError};

/// Name of the mesh that the start scene shows.
pub const CUBE: &str = "cube";

/// The name of a mesh, a texture or a wireframe program.
pub type Name = String<MAX_NAME>;

/// Capabilities, meshes, textures and wireframe programs of the board that draws a scene.
pub trait Board {
    /// Whether the board supports pictures of this size.
    fn has_size(&self, size: Size) -> bool;

    /// Whether the board has a triangle engine.
    fn has_engine(&self) -> bool;

    /// Whether a mesh with this name exists. The board creates the mesh if necessary.
    fn has_mesh(&mut self, name: &str) -> bool;

    /// The mesh with this name, after [`has_mesh`](Self::has_mesh) has returned true for the name.
    fn mesh(&self, name: &str) -> Option<Mesh<'_>>;

    /// Whether a texture with this name exists.
    fn has_texture(&self, name: &str) -> bool;

    /// Whether a wireframe program with this name exists.
    fn has_program(&self, name: &str) -> bool;
}

/// A board without limits. Its meshes, textures and programs are loaded only when the scene is drawn.
#[derive(Clone, Copy, Debug)]
pub struct AnyBoard;

impl Board for AnyBoard {
    fn has_size(&self, _: Size) -> bool {
        true
    }

    fn has_engine(&self) -> bool {
        true
    }

    fn has_mesh(&mut self, _: &str) -> bool {
        true
    }

    fn mesh(&self, _: &str) -> Option<Mesh<'_>> {
        None
    }

    fn has_texture(&self, _: &str) -> bool {
        true
    }

    fn has_program(&self, _: &str) -> bool {
        true
    }
}

/// The options of a board's start scene that depend on the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Defaults {
    /// Backend that draws the picture.
    pub backend: Backend,
    /// Size of the picture.
    pub size: Size,
    /// Number of samples whose average is a pixel, in pictures that the board draws 60 times per second.
    pub samples: Samples,
    /// Background of meshes.
    pub background: Background,
}

impl Defaults {
    /// The options of a board with all parts of the gateware.
    pub const GATEWARE: Self = Self {
        backend: Backend::Gateware,
        size: Size::W1280,
        samples: Samples::Four,
        background: Background::Gradient,
    };

    /// The options of a board whose soft core draws: smaller pictures with one sample per pixel, which take less time.
    pub const SOFT_CORE: Self = Self {
        backend: Backend::Cpu,
        size: Size::W320,
        samples: Samples::One,
        background: Background::Colour([0; 3]),
    };
}

/// A camera on a sphere about the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sphere {
    /// Distance from the origin in world units.
    pub r: Q32_32,
    /// Azimuth, about the z axis.
    pub theta: Turns,
    /// Angle from the z axis.
    pub phi: Turns,
}

impl Sphere {
    /// The camera of the start scene, which shows the whole model from above and in front.
    pub const START: Self = Self {
        r: Q32_32::lit("2.5"),
        // Azimuth 40°, and 65° from the z axis.
        theta: Turns::from_degrees(Q32_32::lit("40")),
        phi: Turns::from_degrees(Q32_32::lit("65")),
    };

    /// The camera that looks at the origin from this position.
    ///
    /// # Errors
    /// [`ViewError`] for a distance or an angle out of range.
    pub fn view(self) -> Result<View, ViewError> {
        View::spherical(self.r, self.theta, self.phi)
    }
}

/// An entry of the list of objects: a mesh with its placement and colour.
#[derive(Clone, Debug)]
pub struct PlacedMesh {
    /// Name of the mesh.
    pub mesh: Name,
    /// Placement and colour.
    pub place: Place,
    /// The model matrix before the latest rotations. The rotations keep its shape.
    shape: Matrix,
    /// The model matrix before the turn of an animation.
    start: Matrix,
    /// The angle by which the animation has turned the object since `start`.
    turned: Turns,
}

impl PlacedMesh {
    /// Places a mesh.
    pub const fn new(mesh: Name, place: Place) -> Self {
        let start = place.matrix;
        Self {
            mesh,
            place,
            shape: start,
            start,
            turned: Turns(0),
        }
    }

    /// Turns the object about its own origin, as an animation does: many small turns about one axis give the matrix of a single
    /// turn. Another axis requires [`settle`](Self::settle) first.
    fn turn(&mut self, axis: Axis, by: Turns) {
        self.turned = self.turned.wrapping_add(by);
        // An object whose matrix would be out of range at this angle keeps its last matrix.
        let turned = self.start.turned(axis, self.turned);
        self.place.matrix = turned.unwrap_or(self.place.matrix);
    }

    /// Makes the current placement the start of the next turn of an animation.
    const fn settle(&mut self) {
        self.start = self.place.matrix;
        self.turned = Turns(0);
    }

    /// Applies `next` to the placement. Rotations keep the shape of the object, even many small ones.
    ///
    /// # Errors
    /// The matrix would be out of range or singular; the placement is then unchanged.
    pub fn change(&mut self, next: &Place) -> Result<(), MatrixError> {
        self.place = self.place.then(next)?;
        if next.matrix.is_rotation() {
            self.place.matrix = self.place.matrix.with_shape_of(&self.shape);
        } else {
            self.shape = self.place.matrix;
        }
        self.settle();
        Ok(())
    }
}

/// Meshes are equal by their names and placements.
impl PartialEq for PlacedMesh {
    fn eq(&self, other: &Self) -> bool {
        self.mesh == other.mesh && self.place == other.place
    }
}

impl Eq for PlacedMesh {}

/// The subject that a scene shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The selected mesh, the field, or both.
    Solid,
    /// The list of objects.
    Objects,
    /// The wireframe, moved by this motion.
    Wireframe(Motion),
}

/// The subject of a scene. `Display` writes the name of the subject.
#[derive(Clone, Copy, Debug)]
pub enum SceneSubject<'s> {
    /// The mesh with this name.
    Mesh(&'s str),
    /// The edges of the mesh with this name.
    Edges(&'s str, Edges),
    /// A field without a mesh.
    Field(&'s Field),
    /// A mesh in a field.
    MeshInField(&'s str, &'s Field),
    /// The list of objects.
    Objects,
    /// The wireframe, moved by this motion.
    Wireframe(&'s Motion),
}

impl fmt::Display for SceneSubject<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Mesh(mesh) | Self::Edges(mesh, _) => f.write_str(mesh),
            Self::Field(field) => field.fmt(f),
            Self::MeshInField(mesh, field) => write!(f, "{field} with {mesh}"),
            Self::Objects => f.write_str("objects"),
            Self::Wireframe(_) => f.write_str("wireframe"),
        }
    }
}

/// The meshes, the texture and the wireframe program of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Assets<'a> {
    /// The mesh that is shown alone or in a field; `None` if no such mesh is shown.
    pub mesh: Option<Mesh<'a>>,
    /// The shown objects.
    pub objects: &'a [Object<'a>],
    /// The texture that replaces the textures of meshes; `None` if the meshes show their own textures.
    pub replacement_texture: Option<Texture<'a>>,
    /// The wireframe program.
    pub program: Program<'a>,
}

/// Everything that a picture depends on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scene {
    /// The shown subject: mesh and field, objects, or wireframe.
    pub kind: Kind,
    /// Name of the mesh.
    pub mesh: Name,
    /// The list of objects, even if the scene shows another subject.
    pub objects: Vec<PlacedMesh, MAX_OBJECTS>,
    /// The distance field, alone or with the mesh in it; `None` shows the mesh alone.
    pub field: Option<Field>,
    /// Whether a shown field contains the mesh.
    pub with_mesh: bool,
    /// Drawing mode of the edges of a single mesh; `None` for faces only, and for every other subject.
    pub edges: Option<Edges>,
    /// Stereo settings; `None` for one eye, as always for wireframes.
    pub stereo: Option<Stereo>,
    /// The appearance of a field, with lights and background of meshes.
    pub appearance: Appearance,
    /// The quality that was set last. The picture size may differ from the quality's size.
    pub quality: Quality,
    /// The current camera, also after motions.
    pub view: View,
    /// The camera on a sphere that was set last.
    pub sphere: Sphere,
    /// Size of the picture.
    pub size: Size,
    /// The set number of samples whose average is a pixel; `None` for the [default](Self::samples).
    pub fixed_samples: Option<Samples>,
    /// The drawing options of all meshes.
    pub options: MeshOptions,
    /// Name of the replacement texture; `None` if the meshes show their own textures.
    pub texture: Option<Name>,
    /// Name of the wireframe program, even if the scene shows another subject; `None` for the program that was uploaded without a name, or
    /// else the built-in program.
    pub program: Option<Name>,
    /// Backend that draws the picture.
    pub backend: Backend,
    /// The options of the board's start scene.
    pub defaults: Defaults,
    /// Whether colours are dithered, or else rounded to nearest.
    pub dither: bool,
    /// Whether text is written over the picture.
    pub overlay: bool,
    /// The motion over time.
    pub animation: Animation,
}

impl Scene {
    /// Returns the start scene.
    ///
    /// # Errors
    /// [`ViewError`] if the camera of the start scene is invalid.
    pub fn new(defaults: Defaults) -> Result<Self, ViewError> {
        let sphere = Sphere::START;
        Ok(Self {
            kind: Kind::Solid,
            mesh: name(CUBE),
            objects: Vec::new(),
            field: None,
            with_mesh: false,
            edges: None,
            stereo: None,
            appearance: Appearance::default(),
            quality: Quality::default(),
            view: sphere.view()?,
            sphere,
            size: defaults.size,
            fixed_samples: None,
            options: MeshOptions::default(),
            texture: None,
            program: None,
            backend: defaults.backend,
            defaults,
            dither: true,
            overlay: false,
            animation: Animation::default(),
        })
    }

    /// Resets all options except backend and overlay to those of the start scene. A scene that the soft core draws gets the size of a board
    /// whose soft core draws.
    ///
    /// # Errors
    /// [`ViewError`] if the camera of the start scene is invalid.
    pub fn reset(&mut self) -> Result<(), ViewError> {
        let start = Self::new(self.defaults)?;
        *self = Self {
            backend: self.backend,
            overlay: self.overlay,
            size: match self.backend {
                Backend::Cpu => Defaults::SOFT_CORE.size,
                Backend::Gateware => start.size,
            },
            ..start
        };
        Ok(())
    }

    /// Sets an option.
    ///
    /// # Errors
    /// The scene or the board excludes the value; the scene is then unchanged.
    // Not inlined, because the firmware has several callers.
    #[inline(never)]
    pub fn apply<'l>(
        &mut self,
        setting: &Setting<'l>,
        board: &mut dyn Board,
    ) -> Result<(), SettingError<'l>> {
        match *setting {
            Setting::Field { field } => self.show_field(field),
            Setting::Mesh { on } => self.with_mesh = on,
            Setting::Stereo { eyes } => {
                if eyes.is_some() && self.wireframe().is_some() {
                    return Err(SettingError::StereoOfWireframe);
                }
                self.stereo = eyes;
            }
            Setting::Object { ref action } => {
                if OBJECT.is_built {
                    self.change_objects(action, board)?;
                }
            }
            Setting::Material { material } => self.appearance.material = material,
            Setting::Light { light: Some(light) } => {
                let added = self.appearance.lights.push(light);
                added.map_err(|_| SettingError::Lights)?;
            }
            Setting::Light { light: None } => self.appearance.lights.clear(),
            Setting::Ambient { colour } => self.appearance.ambient = colour,
            Setting::Highlight { highlight } => self.appearance.highlight = highlight,
            Setting::Shadow { on } => self.appearance.shadow = on,
            Setting::Background { background } => {
                if background.and_then(Background::gradient).is_some() && !SKY.is_built {
                    return Err(SettingError::NoSky);
                }
                self.appearance.background = background;
            }
            Setting::Fog { density } => self.appearance.fog = density.unwrap_or_default(),
            Setting::Occlusion { on } => self.appearance.occlusion = on,
            Setting::Undecided { on } => self.appearance.undecided = on,
            Setting::Camera { r, theta, phi } => self.set_sphere(Sphere { r, theta, phi })?,
            Setting::View { view } => self.view = view,
            Setting::Look { yaw, pitch, roll } => {
                self.move_view(View::look(self.view.eye(), yaw, pitch, roll)?);
            }
            Setting::LookAt { view } => self.move_view(view),
            Setting::Projection { volume } => {
                self.view = self.view.with_lens(volume.lens);
                self.options.clip = Clip::to(volume.far);
            }
            Setting::FieldOfView { angles } => {
                self.view = match angles {
                    (across, None) => self.view.with_field_of_view(across)?,
                    (across, Some(down)) => self.view.with_fields_of_view([across, down])?,
                };
            }
            Setting::Orthographic { width } => self.view = self.view.with_width(width)?,
            Setting::Near { distance } => self.view = self.view.with_near(distance)?,
            Setting::Zoom { factor } => self.view = self.view.zoomed(factor)?,
            Setting::Fit { lens } => {
                if FIT.is_built {
                    let (up, angle) = lens.unwrap_or((Axis::Z, None));
                    let meshes = self.placed_meshes(board);
                    let meshes = meshes.iter().copied();
                    let sphere = framing::BoundingSphere::around(meshes.clone());
                    let sphere = sphere.ok_or(SettingError::FitOfOthers)?;
                    let view = sphere.framed(up, Turns::default(), angle);
                    self.view = view.map_err(SettingError::Fit)?;
                    if angle.is_none() {
                        framing::fill(core::slice::from_mut(&mut self.view), meshes)?;
                    }
                }
            }
            Setting::Quality { quality } => {
                // The largest size that the board supports, up to the quality's size.
                let mut sizes = (Size::ALL.into_iter().rev())
                    .skip_while(|size| *size != quality.size())
                    .filter(|size| board.has_size(*size));
                self.size = sizes.next().unwrap_or(self.size);
                self.fixed_samples = quality.samples();
                self.quality = quality;
            }
            Setting::Size { size } => {
                if !board.has_size(size) {
                    return Err(SettingError::Size(size));
                }
                self.size = size;
            }
            Setting::Antialiasing { samples } => {
                if samples == Some(Samples::Four) && !ANTIALIASING.is_built {
                    return Err(SettingError::NoAntialiasing);
                }
                self.fixed_samples = samples;
            }
            Setting::Backend { backend } => {
                if backend == Backend::Gateware && !board.has_engine() {
                    return Err(SettingError::NoEngine);
                }
                self.backend = backend;
            }
            Setting::Shading { shading } => self.options.shading = shading,
            Setting::Cull { on } => self.options.cull = on,
            Setting::Textures { on } => self.options.textures = on,
            Setting::Texture { texture } => {
                if let Some(texture) = texture.filter(|texture| !board.has_texture(texture)) {
                    return Err(SettingError::Texture(texture));
                }
                self.texture = texture.map(name);
            }
            Setting::Clip { far } => self.options.clip = Clip::to(far),
            Setting::Winding { rule } => self.options.winding = rule,
            Setting::Edges { edges } => {
                if edges.is_some() && (self.kind != Kind::Solid || self.field.is_some()) {
                    return Err(SettingError::EdgesOfOthers);
                }
                self.edges = edges;
            }
            Setting::Dither { on } => self.dither = on,
            Setting::Overlay { on } => self.overlay = on,
            Setting::Animate { animation } => {
                if ANIMATE.is_built {
                    self.objects.iter_mut().for_each(PlacedMesh::settle);
                    self.animation = animation;
                }
            }
            // [`Setting::note`] states that it has no effect.
            Setting::Prepass { .. } => {}
        }
        Ok(())
    }

    fn change_objects<'l>(
        &mut self,
        action: &ObjectAction<'l>,
        board: &mut dyn Board,
    ) -> Result<(), SettingError<'l>> {
        let count = self.objects.len();
        let index = |number: u32| {
            let index = (number as usize).checked_sub(1);
            let index = index.filter(|index| *index < count);
            index.ok_or(ObjectError::Number { number, count })
        };
        match *action {
            ObjectAction::List => {}
            ObjectAction::Show if count == 0 => return Err(ObjectError::None.into()),
            ObjectAction::Show => self.show_objects(),
            ObjectAction::Add { mesh, place } => {
                if !board.has_mesh(mesh) {
                    return Err(SettingError::ObjectMesh(mesh));
                }
                let mesh = name(mesh);
                let added = self.objects.push(PlacedMesh::new(mesh, place));
                added.map_err(|_| ObjectError::Full)?;
                self.show_objects();
            }
            ObjectAction::Change { number, next } => {
                if let Some(object) = self.objects.get_mut(index(number)?) {
                    let changed = object.change(&next);
                    changed.map_err(|error| ObjectError::Matrix { number, error })?;
                }
            }
            ObjectAction::Remove(number) => {
                match number {
                    Some(number) => drop(self.objects.remove(index(number)?)),
                    None => self.objects.clear(),
                }
                if self.objects.is_empty() && self.kind == Kind::Objects {
                    self.show_field(None);
                }
            }
        }
        Ok(())
    }

    /// Shows a field, or the mesh alone for `None`. A field turns the edges of a mesh off.
    fn show_field(&mut self, field: Option<Field>) {
        self.kind = Kind::Solid;
        if field.is_some() {
            self.edges = None;
        }
        self.field = field;
    }

    /// Shows the mesh with this name alone.
    pub fn show_mesh(&mut self, mesh: &str) {
        self.set_mesh(mesh);
        self.show_field(None);
    }

    /// Selects the mesh with this name, without showing it.
    pub fn set_mesh(&mut self, mesh: &str) {
        self.mesh = name(mesh);
    }

    /// Shows the objects, and turns the edges of a mesh off.
    fn show_objects(&mut self) {
        self.kind = Kind::Objects;
        self.edges = None;
    }

    /// Shows the wireframe program with this name, or for `None` the scene's program, without motion.
    ///
    /// # Errors
    /// The board has no program of this name; the scene is then unchanged.
    pub fn show_program<'l>(
        &mut self,
        program: Option<&'l str>,
        board: &dyn Board,
    ) -> Result<(), SettingError<'l>> {
        if let Some(program) = program {
            if !board.has_program(program) {
                return Err(SettingError::Program(program));
            }
            self.program = Some(name(program));
        }
        self.show_wireframe();
        Ok(())
    }

    /// Shows the wireframe without motion, and turns edges of a mesh and stereo off.
    pub fn show_wireframe(&mut self) {
        self.kind = Kind::Wireframe(Motion::default());
        self.edges = None;
        self.stereo = None;
    }

    /// The motion of the wireframe, if it is shown.
    pub const fn wireframe(&self) -> Option<&Motion> {
        match &self.kind {
            Kind::Wireframe(motion) if WIREFRAME.is_built => Some(motion),
            Kind::Wireframe(_) | Kind::Solid | Kind::Objects => None,
        }
    }

    /// Moves the wireframe by a step, if it is shown. Returns whether the step was possible.
    pub fn move_wireframe(&mut self, step: Step) -> bool {
        match &mut self.kind {
            Kind::Wireframe(motion) => motion.apply(step),
            Kind::Solid | Kind::Objects => false,
        }
    }

    /// Whether the objects are shown.
    pub fn shows_objects(&self) -> bool {
        OBJECT.is_built && self.kind == Kind::Objects
    }

    /// Whether the field is shown, alone or with the mesh in it.
    pub fn shows_field(&self) -> bool {
        self.field.is_some() && self.kind == Kind::Solid
    }

    /// Moves the camera to the position and basis of `view`, and keeps the lens.
    pub fn move_view(&mut self, view: View) {
        self.view = view.with_lens_of(&self.view);
    }

    /// Moves the camera to the position and basis of a camera on a sphere.
    ///
    /// # Errors
    /// [`ViewError`] for a camera out of range; the scene is then unchanged.
    pub fn set_sphere(&mut self, sphere: Sphere) -> Result<(), ViewError> {
        self.move_view(sphere.view()?);
        self.sphere = sphere;
        Ok(())
    }

    /// Moves the scene by its [animation](Self::animation) from one point in time to another, in seconds
    /// since the animation's start. Many steps give the same scene as a single step: no errors add up. The camera moves only with `moves_camera`.
    // Not inlined, so that the firmware's main loop takes few lines of the instruction cache.
    #[inline(never)]
    pub fn animate(&mut self, from: U32_32, to: U32_32, moves_camera: bool) {
        let Animation {
            azimuth,
            orbit,
            turn,
        } = self.animation;
        let between = |rate: Rate| rate.angle(to).wrapping_add(-rate.angle(from));
        let by = between(azimuth);
        if moves_camera && by != Turns(0) && self.wireframe().is_none() {
            let sphere = Sphere {
                theta: self.sphere.theta.wrapping_add(by),
                ..self.sphere
            };
            // Every azimuth is in range.
            let _ = self.set_sphere(sphere);
        }
        if self.shows_field()
            && let Some(moving) = self.field.as_mut().and_then(Field::moving)
        {
            moving.angle = moving.angle.wrapping_add(between(orbit));
        }
        if let Some(ObjectTurn { object, axis, rate }) = turn
            && self.shows_objects()
        {
            let by = between(rate);
            for (number, placed) in (1..).zip(&mut self.objects) {
                if object.is_none_or(|object| object == number) {
                    placed.turn(axis, by);
                }
            }
        }
    }

    /// Whether text is written over the picture.
    pub const fn has_overlay(&self) -> bool {
        OVERLAY.is_built && self.overlay
    }

    /// The subject that the scene shows.
    pub fn subject(&self) -> SceneSubject<'_> {
        if let Some(motion) = self.wireframe() {
            return SceneSubject::Wireframe(motion);
        }
        if self.shows_objects() {
            return SceneSubject::Objects;
        }
        let field = self.field.as_ref().filter(|_| FIELD.is_built);
        match (field, self.edges) {
            (None, None) => SceneSubject::Mesh(&self.mesh),
            (None, Some(edges)) => SceneSubject::Edges(&self.mesh, edges),
            (Some(field), _) if self.with_mesh && MESH_IN_FIELD.is_built => {
                SceneSubject::MeshInField(&self.mesh, field)
            }
            (Some(field), _) => SceneSubject::Field(field),
        }
    }

    /// The number of samples whose average is a pixel: the set number, or else the board's default. Without a set number, pictures that the
    /// board does not draw 60 times per second have one sample: pictures by the soft core, for two eyes, or of fields in the largest size.
    pub fn samples(&self) -> Samples {
        let is_slow = self.backend == Backend::Cpu
            || self.stereo.is_some()
            || self.shows_field() && self.size.doubled().is_none();
        let default = if is_slow {
            Samples::One
        } else {
            self.defaults.samples
        };
        let samples = self.fixed_samples.unwrap_or(default);
        if ANTIALIASING.is_built {
            samples
        } else {
            Samples::One
        }
    }

    /// Whether a picture of the scene has depth codes: only a picture with one sample per pixel has.
    pub fn has_depths(&self) -> bool {
        self.samples() == Samples::One
    }

    /// Name of the mesh that is shown, alone or in a field.
    pub fn shown_mesh(&self) -> Option<&str> {
        match self.subject() {
            SceneSubject::Mesh(mesh)
            | SceneSubject::Edges(mesh, _)
            | SceneSubject::MeshInField(mesh, _) => Some(mesh),
            SceneSubject::Field(_) | SceneSubject::Objects | SceneSubject::Wireframe(_) => None,
        }
    }

    /// Whether a shown mesh has textures that are drawn, as `MeshSubject::has_textures` states. `find` returns a mesh by its name.
    pub fn has_textures<'m>(&self, find: impl Fn(&str) -> Option<Mesh<'m>>) -> bool {
        let has_textures = |name: &str| {
            let mesh = find(name).map(|mesh| self.options.subject(mesh));
            mesh.is_some_and(|mesh| mesh.has_textures())
        };
        if self.shows_objects() {
            self.objects.iter().any(|object| has_textures(&object.mesh))
        } else {
            self.shown_mesh().is_some_and(has_textures)
        }
    }

    /// Makes an object from a mesh and its placement.
    pub fn object<'a>(&self, place: &Place, mesh: Mesh<'a>) -> Object<'a> {
        Object {
            subject: self.options.subject(mesh),
            placement: Placement::new(place.matrix),
            colour: place.colour,
        }
    }

    /// Converts the scene to a frame.
    pub fn frame<'a>(&'a self, content: Assets<'a>) -> Frame<'a> {
        let mesh = content.mesh.map(|mesh| self.options.subject(mesh));
        let field = |field| FieldSubject {
            field,
            appearance: &self.appearance,
            quality: self.quality,
        };
        let subject = match (self.subject(), mesh) {
            (SceneSubject::Mesh(_), Some(mesh)) => Subject::Mesh(mesh),
            (SceneSubject::Edges(_, edges), Some(mesh)) => Subject::edges(mesh, edges),
            (SceneSubject::MeshInField(_, shown), Some(mesh)) => {
                Subject::MeshInField(mesh, field(shown))
            }
            (SceneSubject::Field(shown) | SceneSubject::MeshInField(_, shown), _) => {
                Subject::Field(field(shown))
            }
            (SceneSubject::Objects, _) => Subject::Objects(content.objects),
            (SceneSubject::Mesh(_) | SceneSubject::Edges(..), None) => Subject::Objects(&[]),
            (SceneSubject::Wireframe(motion), _) => Subject::Wireframe(WireframeSubject {
                program: content.program,
                pose: motion.pose(),
            }),
        };
        let background = self.defaults.background;
        Frame {
            rounding: Rounding::new(self.dither),
            replacement_texture: content.replacement_texture,
            stereo: self.stereo.filter(|_| STEREO.is_built),
            samples: self.samples(),
            ..Frame::in_appearance(subject, self.view, self.size, &self.appearance, background)
        }
    }

    /// The single shown mesh, or the objects.
    fn placed_meshes<'b>(&self, board: &'b dyn Board) -> Vec<(Mesh<'b>, Matrix), MAX_OBJECTS> {
        let mut meshes = Vec::new();
        // The list has space for all objects, so no object is dropped.
        match self.subject() {
            SceneSubject::Mesh(mesh) | SceneSubject::Edges(mesh, _) => {
                meshes.extend(board.mesh(mesh).map(|mesh| (mesh, Matrix::IDENTITY)));
            }
            SceneSubject::Objects => {
                for object in &self.objects {
                    let mesh = board.mesh(&object.mesh);
                    meshes.extend(mesh.map(|mesh| (mesh, object.place.matrix)));
                }
            }
            SceneSubject::Field(_) | SceneSubject::MeshInField(..) | SceneSubject::Wireframe(_) => {
            }
        }
        meshes
    }

    /// The optional gateware blocks that the scene needs, one bit per block ([`Block::bit`]). A picture drawn by the soft core
    /// needs no engine.
    pub fn blocks(&self) -> u32 {
        let engines = match self.subject() {
            SceneSubject::Mesh(_) | SceneSubject::Objects => Block::Triangle.bit(),
            SceneSubject::Edges(..) => Block::Triangle.bit() | Block::Line.bit(),
            SceneSubject::Wireframe(_) => Block::Line.bit(),
            SceneSubject::Field(_) => Block::Raymarch.bit(),
            SceneSubject::MeshInField(..) => Block::Triangle.bit() | Block::Raymarch.bit(),
        };
        let drawn = match self.backend {
            Backend::Gateware => engines,
            Backend::Cpu => 0,
        };
        Block::Scanout.bit() | drawn
    }

    /// The number of the first object whose mesh has this name, from 1.
    pub fn first_object_of(&self, mesh: &str) -> Option<u32> {
        let mut numbered = (1..).zip(&self.objects);
        let found = numbered.find(|(_, object)| object.mesh == mesh);
        found.map(|(number, _)| number)
    }
}

/// The name of a mesh or a texture, which has at most [`MAX_NAME`] bytes.
fn name(name: &str) -> Name {
    Name::try_from(name).unwrap_or_default()
}
