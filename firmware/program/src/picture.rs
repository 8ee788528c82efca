//! The description of a picture.

use core::fmt;

use glint_core::appearance::Appearance;
use glint_core::camera::{View, ViewError};
use glint_core::feature::WIREFRAME;
use glint_core::field::Field;
use glint_core::light::Background;
use glint_core::matrix::{Matrix, MatrixError};
use glint_core::mesh::Mesh;
use glint_core::object::MAX_OBJECTS;
use glint_core::picture::{Backend, Edges, Samples, Size};
use glint_core::quality::Quality;
use glint_core::rectangle::Rectangle;
use glint_core::wireframe::{Pose, Program, ProgramError};
use glint_model::{FieldSubject, Frame, MeshSubject, Object, Placement, Subject, WireframeSubject};
use glint_scene::{Defaults, Sphere};
use heapless::Vec;

/// Largest number of rectangles of a picture.
pub const MAX_RECTANGLES: usize = 128;

/// Reason why a picture cannot be described.
#[derive(Clone, Copy, Debug)]
pub enum PictureError {
    /// More meshes than [`MAX_OBJECTS`].
    Meshes,
    /// More rectangles than [`MAX_RECTANGLES`].
    Rectangles,
    /// A picture of lines, or of a mesh's edges, has another mesh or a field; or a picture with a field has several meshes.
    Subjects,
    /// The camera is out of range.
    View(ViewError),
    /// A model matrix is out of range.
    Matrix(MatrixError),
    /// The lines have no eye before a view plane with a window.
    Lines(ProgramError<'static>),
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Meshes => write!(f, "expected at most {MAX_OBJECTS} meshes in a picture"),
            Self::Rectangles => {
                write!(f, "expected at most {MAX_RECTANGLES} rectangles in a picture")
            }
            Self::Subjects => f.write_str(
                "subjects of a picture: expected meshes, a field with at most one mesh, the edges of a mesh, or lines",
            ),
            Self::View(error) => write!(f, "camera: {error}"),
            Self::Matrix(error) => error.fmt(f),
            Self::Lines(error) if WIREFRAME.is_built => write!(f, "lines: {error}"),
            Self::Lines(_) => WIREFRAME.fmt(f),
        }
    }
}

impl core::error::Error for PictureError {}

impl From<ViewError> for PictureError {
    fn from(error: ViewError) -> Self {
        Self::View(error)
    }
}

impl From<MatrixError> for PictureError {
    fn from(error: MatrixError) -> Self {
        Self::Matrix(error)
    }
}

impl From<ProgramError<'static>> for PictureError {
    fn from(error: ProgramError<'static>) -> Self {
        Self::Lines(error)
    }
}

/// The part of a picture that excludes others.
enum Main<'p> {
    /// The meshes alone.
    Meshes,
    /// A field, with at most one mesh in it.
    Field(&'p Field, Quality),
    /// The edges of a mesh.
    Edges(MeshSubject<'p>, Edges),
    /// Lines.
    Lines(WireframeSubject<'p>),
}

/// The description of a picture: camera, light, and the things that it shows.
///
/// A new picture has the board's largest size. It has four samples a pixel if the gateware draws them. The light is white and comes from
/// the camera. Meshes stand before a grey gradient.
///
/// ```
/// use glint_program::core::fixed::{Q8_24, Q32_32, Turns, U4_28};
/// use glint_program::core::light::Background;
/// use glint_program::core::matrix::{Axis, Matrix};
/// use glint_program::core::camera::View;
/// use glint_program::core::mesh::Mesh;
/// use glint_program::{Picture, PictureError};
///
/// /// Two copies of a mesh in fog, one of them turned and twice as large.
/// fn draw<'p>(mesh: Mesh<'p>, picture: &mut Picture<'p>) -> Result<(), PictureError> {
///     picture.view = View::spherical(Q32_32::lit("4"), Turns(0), Turns::QUARTER)?;
///     picture.appearance.background = Some(Background::Sky);
///     picture.appearance.fog = U4_28::lit("0.2");
///     let right = Matrix::translation([Q8_24::ZERO, Q8_24::lit("1.2"), Q8_24::ZERO])?;
///     picture.mesh(mesh, right)?;
///     let large = Matrix::scale([Q8_24::lit("2"); 3])?;
///     picture.mesh(mesh, large.turned(Axis::Z, Turns::from_degrees(Q32_32::lit("30")))?)?;
///     Ok(())
/// }
/// ```
pub struct Picture<'p> {
    /// The camera. Lines have their own.
    pub view: View,
    /// Width and height. A smaller picture is enlarged to the screen.
    pub size: Size,
    /// Samples of a pixel.
    pub samples: Samples,
    /// Lights, background and fog, and the material of a field.
    pub appearance: Appearance,
    /// Whether the engines or the soft core draw the picture.
    pub backend: Backend,
    main: Main<'p>,
    meshes: Vec<Object<'p>, MAX_OBJECTS>,
    rectangles: Vec<Rectangle<'p>, MAX_RECTANGLES>,
    /// The background of meshes if the appearance has none.
    background: Background,
}

impl<'p> Picture<'p> {
    /// An empty picture with the defaults of a board.
    ///
    /// # Errors
    /// [`ViewError`], which the default camera does not cause.
    pub(crate) fn new(defaults: Defaults) -> Result<Self, ViewError> {
        Ok(Self {
            view: Sphere::START.view()?,
            size: defaults.size,
            samples: defaults.samples,
            appearance: Appearance::default(),
            backend: defaults.backend,
            main: Main::Meshes,
            meshes: Vec::new(),
            rectangles: Vec::new(),
            background: defaults.background,
        })
    }

    /// Adds a mesh at a place in the world. The result has its further options: a colour in place of its own, shading, culling. At equal
    /// depths a later mesh covers an earlier one. A mesh in a [field](Self::field) stands at the origin; its matrix is not used.
    ///
    /// # Errors
    /// [`PictureError::Meshes`] for too many meshes.
    pub fn mesh(&mut self, mesh: Mesh<'p>, place: Matrix) -> Result<&mut Object<'p>, PictureError> {
        let object = Object {
            colour: None,
            subject: MeshSubject::new(mesh),
            placement: Placement::new(place),
        };
        let added = self.meshes.push(object);
        added.map_err(|_| PictureError::Meshes)?;
        self.meshes.last_mut().ok_or(PictureError::Meshes)
    }

    /// Shows a distance field, with rays of this precision.
    ///
    /// ```
    /// use glint_program::core::field::Field;
    /// use glint_program::core::quality::Quality;
    /// use glint_program::{Picture, PictureError};
    ///
    /// fn draw<'p>(sponge: &'p Field, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     picture.field(sponge, Quality::Balanced)
    /// }
    /// assert!(Field::parse("menger:3").is_ok());
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Subjects`] if the picture shows lines or edges.
    pub fn field(&mut self, field: &'p Field, quality: Quality) -> Result<(), PictureError> {
        self.set(Main::Field(field, quality))
    }

    /// Shows the edges of a mesh.
    ///
    /// # Errors
    /// [`PictureError::Subjects`] if the picture shows something else.
    pub fn edges(&mut self, mesh: Mesh<'p>, edges: Edges) -> Result<(), PictureError> {
        self.set(Main::Edges(MeshSubject::new(mesh), edges))
    }

    /// Shows lines, moved to a pose.
    ///
    /// # Errors
    /// [`PictureError::Subjects`] if the picture shows something else.
    pub fn wireframe(&mut self, lines: Program<'p>, pose: Pose) -> Result<(), PictureError> {
        self.set(Main::Lines(WireframeSubject {
            program: lines,
            pose,
        }))
    }

    fn set(&mut self, main: Main<'p>) -> Result<(), PictureError> {
        if !matches!(self.main, Main::Meshes) {
            return Err(PictureError::Subjects);
        }
        self.main = main;
        Ok(())
    }

    /// Adds a rectangle with a texture, in front of everything else: a sprite, or a character of a
    /// [font](glint_core::font::Font).
    ///
    /// ```
    /// use glint_program::core::colour::Rgb565;
    /// use glint_program::core::font::Font;
    /// use glint_program::{Picture, PictureError};
    ///
    /// fn draw<'p>(font: &Font<'p>, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     font.line("ready", [16, 16], 2, Rgb565::WHITE).try_for_each(|character| picture.rectangle(character))
    /// }
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Rectangles`] for too many rectangles.
    pub fn rectangle(&mut self, rectangle: Rectangle<'p>) -> Result<(), PictureError> {
        let added = self.rectangles.push(rectangle);
        added.map_err(|_| PictureError::Rectangles)
    }

    /// The frame of this picture.
    ///
    /// # Errors
    /// [`PictureError::Subjects`].
    pub(crate) fn frame(&self) -> Result<Frame<'_>, PictureError> {
        let subject = match (&self.main, self.meshes.as_slice()) {
            (Main::Meshes, meshes) => Subject::Objects(meshes),
            (Main::Field(field, quality), meshes) => {
                let field = FieldSubject {
                    field,
                    appearance: &self.appearance,
                    quality: *quality,
                };
                match meshes {
                    [] => Subject::Field(field),
                    [mesh] => Subject::MeshInField(mesh.subject, field),
                    _ => return Err(PictureError::Subjects),
                }
            }
            (Main::Edges(mesh, edges), []) => Subject::edges(*mesh, *edges),
            (Main::Lines(lines), []) => Subject::Wireframe(*lines),
            (Main::Edges(..) | Main::Lines(_), _) => return Err(PictureError::Subjects),
        };
        Ok(Frame {
            samples: self.samples,
            rectangles: &self.rectangles,
            ..Frame::in_appearance(
                subject,
                self.view,
                self.size,
                &self.appearance,
                self.background,
            )
        })
    }
}
