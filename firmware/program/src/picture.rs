//! The description of a picture.

use core::fmt;

use glint_core::appearance::Appearance;
use glint_core::camera::{View, ViewError};
use glint_core::feature::{EDGES, FIELD, Feature, MESH_IN_FIELD, OBJECT, TEXTURE, WIREFRAME};
use glint_core::field::Field;
use glint_core::fixed::U4_28;
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

use crate::shown_scene::ShownScene;
use crate::triangles::Triangles;

/// Largest number of rectangles of a picture.
///
/// ```
/// /// Whether each character of a text, except spaces, can be a rectangle of one picture.
/// fn fits(text: &str) -> bool {
///     text.split(' ').map(str::len).sum::<usize>() <= glint_program::MAX_RECTANGLES
/// }
/// assert!(fits("game over") && !fits(&"x".repeat(129)));
/// ```
pub const MAX_RECTANGLES: usize = 128;

/// Reason why a picture cannot be described.
///
/// ```
/// # use glint_program::core::{matrix::Matrix, mesh::Mesh};
/// # use glint_program::{Board, Program, host::Host};
/// use glint_program::{Picture, PictureError};
///
/// # struct Crowd(Mesh<'static>);
/// # impl Program for Crowd {
/// #     fn start(board: &mut Board) -> Self { Self(board.cube()) }
/// #     fn update(&mut self, _: &mut Board) {}
/// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
///     for _ in 0..17 {
///         picture.mesh(self.0, Matrix::IDENTITY)?;
///     }
///     Ok(())
/// }
/// # }
/// let error = Host::<Crowd>::start().run(1).unwrap_err();
/// assert_eq!(error.to_string(), "picture: expected at most 16 meshes in a picture");
/// ```
#[derive(Clone, Copy, Debug)]
pub enum PictureError {
    /// More meshes than [`MAX_OBJECTS`].
    Meshes,
    /// More rectangles than [`MAX_RECTANGLES`].
    Rectangles,
    /// A picture of lines, or of a mesh's edges, also has a mesh or a field; or a picture with a field has several meshes.
    Subjects,
    /// A number of the camera is out of range.
    View(ViewError),
    /// An entry of a model matrix is out of range.
    Matrix(MatrixError),
    /// The viewing parameters of the lines are invalid.
    Lines(ProgramError<'static>),
    /// The program is built without this part of the library.
    Lacks(Feature),
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Meshes => write!(f, "expected at most {MAX_OBJECTS} meshes in a picture"),
            Self::Rectangles => {
                write!(f, "expected at most {MAX_RECTANGLES} rectangles in a picture")
            }
            Self::Subjects => f.write_str(
                "subjects: expected meshes, a field with at most one mesh, the edges of a mesh, or lines",
            ),
            Self::View(error) => write!(f, "camera: {error}"),
            Self::Matrix(error) => error.fmt(f),
            Self::Lines(error) if WIREFRAME.is_built => write!(f, "lines: {error}"),
            Self::Lines(_) => Self::Lacks(WIREFRAME).fmt(f),
            Self::Lacks(Feature { name, .. }) => {
                write!(f, "this program lacks the feature {name} of glint-program in Cargo.toml")
            }
        }
    }
}

impl core::error::Error for PictureError {}

/// Checks that the program is built with a part of the library. The compiler knows the result, so a check of an existing part has no code.
const fn built(part: Feature) -> Result<(), PictureError> {
    if part.is_built {
        Ok(())
    } else {
        Err(PictureError::Lacks(part))
    }
}

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

/// The subject of a picture; subjects exclude each other.
enum Main<'p> {
    /// Only meshes.
    Meshes,
    /// A field, with at most one mesh in it.
    Field(&'p Field, Quality),
    /// The edges of a mesh, drawn as lines.
    Edges(MeshSubject<'p>, Edges),
    /// Lines, drawn by the line engine.
    Lines(WireframeSubject<'p>),
    /// A scene, and the function that converts it with these objects; a pointer, so that only programs that show a scene contain the
    /// function.
    Scene(&'p ShownScene, SceneFrame),
}

/// [`ShownScene::frame`].
type SceneFrame = for<'a> fn(&'a ShownScene, &'a [Object<'a>]) -> Frame<'a>;

/// The description of a picture: camera, light, and what the picture shows.
///
/// A new picture has the board's largest size. It has four samples per pixel if the gateware supports them. The light is white, and is at
/// the camera. The background of meshes is a grey gradient.
///
/// ```
/// use glint_program::core::fixed::{Q8_24, Q32_32, Turns, U4_28};
/// use glint_program::core::light::Background;
/// use glint_program::core::matrix::{Axis, Matrix};
/// use glint_program::core::camera::View;
/// # use glint_program::core::{colour::Rgb565, mesh::Mesh, shape::Shape};
/// # use glint_program::{Board, Program, host::Host};
/// use glint_program::{Picture, PictureError};
///
/// # struct Two { mesh: Mesh<'static> }
/// # impl Program for Two {
/// #     fn start(board: &mut Board) -> Self { Self { mesh: board.shape(Shape::Sphere) } }
/// #     fn update(&mut self, _: &mut Board) {}
/// /// Two copies of a mesh in fog, one of them turned and twice as large.
/// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
///     picture.view = View::spherical(Q32_32::lit("4"), Turns(0), Turns::QUARTER)?;
///     picture.appearance.background = Some(Background::Sky);
///     picture.appearance.fog = U4_28::lit("0.2");
///     let right = Matrix::translation([Q8_24::ZERO, Q8_24::lit("1.2"), Q8_24::ZERO])?;
///     picture.mesh(self.mesh, right)?;
///     let large = Matrix::scale([Q8_24::lit("2"); 3])?;
///     picture.mesh(self.mesh, large.turned(Axis::Z, Turns::from_degrees(Q32_32::lit("30")))?)?;
///     Ok(())
/// }
/// # }
/// # let mut host = Host::<Two>::start();
/// # host.run(1)?;
/// # let row = &host.picture()[180 * 640..][..640];
/// # assert!(row[320] != row[0] && row[440] != row[0] && row[200] == row[0]);
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
pub struct Picture<'p> {
    /// The camera. Not used for lines, which have their own viewing parameters.
    pub view: View,
    /// Width and height. A smaller picture is enlarged to the screen.
    pub size: Size,
    /// Number of samples per pixel.
    pub samples: Samples,
    /// Lights, background and fog, and the material of a field.
    pub appearance: Appearance,
    /// Whether the engines or the soft core draw the picture.
    pub backend: Backend,
    main: Main<'p>,
    meshes: Vec<Object<'p>, MAX_OBJECTS>,
    rectangles: Vec<Rectangle<'p>, MAX_RECTANGLES>,
    /// The background of meshes if the appearance has no background.
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

    /// Adds a mesh with this model matrix. Set further options in the result, such as a replacement colour, shading and culling. At equal
    /// depths a later mesh hides an earlier mesh. A mesh in a [field](Self::field) is at the origin, and the matrix is not used.
    ///
    /// ```
    /// # use glint_program::core::mesh::Mesh;
    /// # use glint_program::{Board, Program, host::Host};
    /// use glint_program::core::colour::Rgb565;
    /// use glint_program::core::matrix::{Axis, Matrix};
    /// use glint_program::core::fixed::Turns;
    /// use glint_program::{Picture, PictureError};
    ///
    /// # struct Red(Mesh<'static>);
    /// # impl Program for Red {
    /// #     fn start(board: &mut Board) -> Self { Self(board.cube()) }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     let cube = picture.mesh(self.0, Matrix::rotation(Axis::Z, Turns::QUARTER))?;
    ///     cube.colour = Some(Rgb565::from_rgb888([0xff, 0, 0]));
    ///     Ok(())
    /// }
    /// # }
    /// # let mut host = Host::<Red>::start();
    /// # host.run(1)?;
    /// # let middle = Rgb565(host.picture()[180 * 640 + 320]).to_rgb888();
    /// # assert!(middle[0] > 0x40 && middle[1..] == [0, 0]);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Meshes`] for too many meshes. A program without the feature `object` fails when the picture is drawn, unless the mesh
    /// is in a field.
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

    /// Adds a list of triangles in pixels, and sets the picture's size and camera for it, so all lists of a picture have the same size;
    /// lights and fog return to their defaults, so triangles have their own colours. Set further options in the result. The engine draws
    /// flat shading, the soft core smooth shading.
    ///
    /// ```
    /// # use glint_program::core::{colour::Rgb565, picture::Size, texture::Blend};
    /// # use glint_program::{Board, Program, host::Host};
    /// # use glint_program::triangles::{Triangle, Triangles};
    /// use glint_program::{Picture, PictureError};
    ///
    /// # struct Glass { list: Triangles<2> }
    /// # impl Program for Glass {
    /// #     fn start(_: &mut Board) -> Self {
    /// #         let mut list = Triangles::new();
    /// #         let corners = [[0, 0], [5120, 0], [0, 2880]];
    /// #         let triangle = |depth, channel, blend| {
    /// #             let colour = Rgb565::from_rgb888([0, 1, 2].map(|other| if other == channel { 0xff } else { 0 }));
    /// #             Triangle { corners, depths: [depth; 3], colours: [colour; 3], blend }
    /// #         };
    /// #         list.set(Size::W640, [triangle(2, 0, Blend::Opaque), triangle(1, 2, Blend::ALL[4]), triangle(3, 1, Blend::Opaque)]);
    /// #         Self { list }
    /// #     }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// /// A blue pane, half of whose colour is that of the red triangle behind it.
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     picture.triangles(&self.list)?;
    ///     Ok(())
    /// }
    /// # }
    /// # let mut host = Host::<Glass>::start();
    /// # host.run(1)?;
    /// # assert_eq!(host.picture()[0], 0x8010);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Meshes`] for too many meshes and lists; [`PictureError::Lacks`].
    pub fn triangles<const N: usize>(
        &mut self,
        list: &'p Triangles<N>,
    ) -> Result<&mut Object<'p>, PictureError> {
        built(OBJECT)?;
        self.view = list.view()?;
        self.size = list.size();
        self.appearance.lights.clear();
        self.appearance.ambient = None;
        self.appearance.fog = U4_28::ZERO;
        // Every list is a valid mesh, unless the program has leaked its `New`.
        let mesh = list.mesh().map_err(|_| PictureError::Meshes)?;
        self.mesh(mesh, Matrix::IDENTITY)
    }

    /// Shows a distance field, with rays of this precision.
    ///
    /// ```
    /// # use glint_program::{Board, Program, host::Host};
    /// use glint_program::core::field::Field;
    /// use glint_program::core::light::Background;
    /// use glint_program::core::quality::Quality;
    /// use glint_program::{Picture, PictureError};
    ///
    /// # struct Sponge { field: Field }
    /// # impl Program for Sponge {
    /// #     fn start(_: &mut Board) -> Self { Self { field: Field::parse("menger:3").unwrap() } }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     picture.appearance.background = Some(Background::White);
    ///     picture.field(&self.field, Quality::Balanced)
    /// }
    /// # }
    /// # let mut host = Host::<Sponge>::start();
    /// # host.run(1)?;
    /// # let [corner, middle] = [0, 180 * 640 + 320].map(|place| host.picture()[place]);
    /// # assert!(corner == 0xffff && middle != 0xffff);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Subjects`] if the picture shows lines or edges; [`PictureError::Lacks`].
    pub fn field(&mut self, field: &'p Field, quality: Quality) -> Result<(), PictureError> {
        built(FIELD)?;
        self.set(Main::Field(field, quality))
    }

    /// Shows the edges of a mesh as lines.
    ///
    /// ```
    /// # use glint_program::core::mesh::Mesh;
    /// # use glint_program::{Board, Program, host::Host};
    /// use glint_program::core::picture::Edges;
    /// use glint_program::{Picture, PictureError};
    ///
    /// # struct Drawing(Mesh<'static>);
    /// # impl Program for Drawing {
    /// #     fn start(board: &mut Board) -> Self { Self(board.cube()) }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     picture.edges(self.0, Edges::Hidden)
    /// }
    /// # }
    /// # let mut host = Host::<Drawing>::start();
    /// # host.run(1)?;
    /// # let colours = host.picture().iter().collect::<std::collections::BTreeSet<_>>();
    /// # assert!(colours.len() > 1, "lines before the background");
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Subjects`] if the picture shows something else; [`PictureError::Lacks`].
    pub fn edges(&mut self, mesh: Mesh<'p>, edges: Edges) -> Result<(), PictureError> {
        built(EDGES)?;
        self.set(Main::Edges(MeshSubject::new(mesh), edges))
    }

    /// Shows lines, transformed by a pose.
    ///
    /// ```
    /// # use glint_program::{Board, Program, host::Host};
    /// use glint_program::core::wireframe::{self, CUBE, Motion};
    /// use glint_program::{Picture, PictureError};
    ///
    /// # struct Cube;
    /// # impl Program for Cube {
    /// #     fn start(_: &mut Board) -> Self { Self }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     let lines = wireframe::Program::new_checked(CUBE.as_flattened())?;
    ///     picture.wireframe(lines, Motion::default().pose())
    /// }
    /// # }
    /// # let mut host = Host::<Cube>::start();
    /// # host.run(1)?;
    /// # assert!(host.picture().iter().any(|&colour| colour != 0));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Subjects`] if the picture shows something else; [`PictureError::Lacks`].
    pub fn wireframe(&mut self, lines: Program<'p>, pose: Pose) -> Result<(), PictureError> {
        built(WIREFRAME)?;
        self.set(Main::Lines(WireframeSubject {
            program: lines,
            pose,
        }))
    }

    /// Shows a scene. Its camera, size, samples, lights, background and renderer replace those of the picture; rectangles are in front.
    ///
    /// ```
    /// # use glint_program::{Board, Program, host::Host};
    /// use glint_program::core::fixed::{Q32_32, Turns};
    /// use glint_program::{Picture, PictureError, SceneFiles, ShownScene};
    ///
    /// # struct Sponge(ShownScene);
    /// # impl Program for Sponge {
    /// fn start(board: &mut Board) -> Self {
    ///     Self(ShownScene::new(board, "field menger:3\nbackground sky\nsize 320 180", SceneFiles::default()).unwrap())
    /// }
    /// fn update(&mut self, board: &mut Board) {
    ///     let azimuth = board.turns(Q32_32::lit("0.1"));
    ///     self.0.scene.sphere.theta = azimuth;
    ///     let _ = self.0.scene.set_sphere(self.0.scene.sphere);
    /// }
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     picture.scene(&self.0)
    /// }
    /// # }
    /// # let mut host = Host::<Sponge>::start();
    /// # host.run(1)?;
    /// # let first = host.picture().to_vec();
    /// # assert_eq!(first.len(), 320 * 180);
    /// # host.run(60)?;
    /// # assert!(host.picture() != first);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Subjects`] if the picture shows something else.
    pub fn scene(&mut self, scene: &'p ShownScene) -> Result<(), PictureError> {
        if !self.meshes.is_empty() {
            return Err(PictureError::Subjects);
        }
        self.backend = scene.scene.backend;
        self.meshes = scene.objects();
        self.set(Main::Scene(scene, ShownScene::frame))
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
    /// # use glint_program::{Board, Program, host::Host};
    /// use glint_program::{Picture, PictureError};
    ///
    /// # struct Title { font: Font<'static> }
    /// # impl Program for Title {
    /// #     fn start(_: &mut Board) -> Self { Self { font: Font::draw(vec![0; Font::BYTES].leak()).unwrap() } }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     let mut characters = self.font.line("ready", [16, 16], 2, Rgb565::WHITE);
    ///     characters.try_for_each(|character| picture.rectangle(character))
    /// }
    /// # }
    /// # let mut host = Host::<Title>::start();
    /// # host.run(1)?;
    /// # assert!(host.picture().contains(&Rgb565::WHITE.0));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`PictureError::Rectangles`] for too many rectangles; [`PictureError::Lacks`].
    pub fn rectangle(&mut self, rectangle: Rectangle<'p>) -> Result<(), PictureError> {
        built(TEXTURE)?;
        let added = self.rectangles.push(rectangle);
        added.map_err(|_| PictureError::Rectangles)
    }

    /// Converts the description to a frame for the renderer.
    ///
    /// # Errors
    /// [`PictureError::Subjects`] and [`PictureError::Lacks`].
    pub(crate) fn frame(&self) -> Result<Frame<'_>, PictureError> {
        let subject = match (&self.main, self.meshes.as_slice()) {
            (Main::Meshes, meshes) => {
                if !meshes.is_empty() {
                    built(OBJECT)?;
                }
                Subject::Objects(meshes)
            }
            (Main::Field(field, quality), meshes) => {
                let field = FieldSubject {
                    field,
                    appearance: &self.appearance,
                    quality: *quality,
                };
                match meshes {
                    [] => Subject::Field(field),
                    [mesh] => {
                        built(MESH_IN_FIELD)?;
                        Subject::MeshInField(mesh.subject, field)
                    }
                    _ => return Err(PictureError::Subjects),
                }
            }
            (Main::Edges(mesh, edges), []) => Subject::edges(*mesh, *edges),
            (Main::Lines(lines), []) => Subject::Wireframe(*lines),
            (Main::Scene(scene, frame), objects) => {
                return Ok(Frame {
                    rectangles: &self.rectangles,
                    ..frame(scene, objects)
                });
            }
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
