//! Scenes: console commands that set a picture, as scene files and the flash contain them.

use core::fmt;

use glint_core::camera::ViewError;
use glint_core::mesh::Mesh;
use glint_core::object::MAX_OBJECTS;
use glint_core::picture::{Backend, Size};
use glint_core::texture::Texture;
use glint_core::wireframe::{self, CUBE, ProgramError};
use glint_model::{Frame, Object};
use glint_scene::{Assets, Board as _, LineError, Name, Scene, SettingError, lines};
use heapless::Vec;

use crate::Board;

/// Reason why a scene cannot be shown.
///
/// ```
/// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
/// use glint_program::{SceneError, SceneFiles, ShownScene};
///
/// # struct Errors(String);
/// # impl Program for Errors {
/// fn start(board: &mut Board) -> Self {
///     let error = ShownScene::new(board, "fov 60\nfog lots", SceneFiles::default()).err();
///     # assert!(matches!(error, Some(SceneError::Line(_))));
///     Self(error.map_or(String::new(), |error| error.to_string()))
/// }
/// #     fn update(&mut self, _: &mut Board) {}
/// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
/// # }
/// # let host = Host::<Errors>::start();
/// # let text = &host.program().0;
/// assert!(text.starts_with("scene: line 2: fog: ") && text.contains("expected off or a number"), "{text}");
/// ```
#[derive(Debug)]
pub enum SceneError<'t> {
    /// A line is no command that sets the picture.
    Line(LineError<'t>),
    /// The scene excludes the option of a line, whose number is from 1.
    Setting(usize, SettingError<'t>),
    /// The program has no mesh with this name.
    Missing(Name),
    /// The start scene's camera is invalid.
    View(ViewError),
    /// The built-in wireframe program is invalid.
    Program(ProgramError<'static>),
}

impl fmt::Display for SceneError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("scene: ")?;
        match self {
            Self::Line(error) => error.fmt(f),
            Self::Setting(line, error) => write!(f, "line {line}: {error}"),
            Self::Missing(name) => write!(f, "expected a mesh of the program, found '{name}'"),
            Self::View(error) => error.fmt(f),
            Self::Program(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SceneError<'_> {}

/// Meshes, textures and wireframe programs of a program by the names that a scene uses for them. They have priority over built-in ones, and
/// of two with one name the first is used.
///
/// ```
/// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
/// # use glint_program::core::{fixed::Q5_11, wireframe::{self, CUBE}};
/// # use glint_program::lines::Lines;
/// use glint_program::core::font::Font;
/// use glint_program::{SceneFiles, ShownScene};
///
/// # struct Scenes([ShownScene; 3], usize);
/// # impl Program for Scenes {
/// fn start(board: &mut Board) -> Self {
///     let font = Font::draw(vec![0; Font::BYTES].leak()).unwrap();
///     # let viewing = *wireframe::Program::new_checked(CUBE.as_flattened()).unwrap().viewing();
///     # let mut lines = Lines::<8>::new(viewing);
///     # lines.add([[Q5_11::lit("-1"); 3], [Q5_11::lit("1"); 3]]);
///     # let line = Box::leak(Box::new(lines)).program().unwrap();
///     let files = SceneFiles {
///         textures: &[("letters", font.texture())],
///         programs: &[("line", line)],
///         ..SceneFiles::default()
///     };
///     let texts = ["scene crate\ntexture letters", "program line", "scene crate"];
///     Self(texts.map(|text| ShownScene::new(board, text, files).unwrap()), 0)
/// }
/// #     fn update(&mut self, board: &mut Board) { self.1 = board.pictures() as usize % 3 }
/// #     fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> { picture.scene(&self.0[self.1]) }
/// # }
/// # let mut host = Host::<Scenes>::start();
/// # host.run(1)?;
/// # let letters = host.picture().to_vec();
/// # host.run(1)?;
/// # let lit = host.picture().iter().filter(|&&pixel| pixel != 0).count();
/// # assert!((50..1_000).contains(&lit), "one line, not the cube: {lit}");
/// # host.run(1)?;
/// # let changed = host.picture().iter().zip(&letters).filter(|(a, b)| a != b).count();
/// # assert!(changed > 1_000, "the crate has its own texture: {changed}");
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct SceneFiles<'f> {
    /// Meshes, for `scene` and `object add`.
    pub meshes: &'f [(&'f str, Mesh<'static>)],
    /// Textures, for `texture`.
    pub textures: &'f [(&'f str, Texture<'static>)],
    /// Wireframe programs, for `program`.
    pub programs: &'f [(&'f str, wireframe::Program<'static>)],
}

/// A scene with its files, for [`Picture::scene`](crate::Picture::scene).
///
/// ```
/// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
/// use glint_program::{SceneFiles, ShownScene};
///
/// struct Rings(ShownScene);
///
/// impl Program for Rings {
///     fn start(board: &mut Board) -> Self {
///         // `glint scene show FILE` prints the commands of a scene file.
///         let text = "background sky\nobject add torus\nobject colour 1 ff0000\nobject add sphere scale 0.4\nobject colour 2 0000ff";
///         Self(ShownScene::new(board, text, SceneFiles::default()).unwrap())
///     }
///     fn update(&mut self, _: &mut Board) {}
///     fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
///         picture.scene(&self.0)
///     }
/// }
/// # let mut host = Host::<Rings>::start();
/// # host.run(1)?;
/// # let colours = |lit: [bool; 3]| host.picture().iter().filter(|&&pixel| {
/// #     let rgb = glint_program::core::colour::Rgb565(pixel).to_rgb888();
/// #     [0, 1, 2].iter().all(|&i: &usize| (rgb[i] > 64) == lit[i])
/// # }).count();
/// # assert!(colours([true, false, false]) > 1_000 && colours([false, false, true]) > 1_000);
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
pub struct ShownScene {
    /// The options of the scene, such as its camera. The program may change them before each picture, except those that determine which
    /// meshes are shown.
    pub scene: Scene,
    mesh: Option<Mesh<'static>>,
    objects: Vec<Mesh<'static>, MAX_OBJECTS>,
    texture: Option<Texture<'static>>,
    program: wireframe::Program<'static>,
}

impl ShownScene {
    /// The scene that results from the commands of `text`, one per line, on the board's start scene. Motions are left out, because the
    /// program moves the scene.
    ///
    /// ```
    /// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
    /// use glint_program::{SceneFiles, ShownScene};
    /// # struct Ship(ShownScene);
    /// # impl Program for Ship {
    /// fn start(board: &mut Board) -> Self {
    ///     let files = SceneFiles { meshes: &[("ship", board.cube())], ..SceneFiles::default() };
    ///     Self(ShownScene::new(board, "object add ship\nfov 40", files).unwrap())
    /// }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// #     fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> { picture.scene(&self.0) }
    /// # }
    /// # Host::<Ship>::start().run(1)?;
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneError`].
    pub fn new<'t>(
        board: &mut Board,
        text: &'t str,
        files: SceneFiles,
    ) -> Result<Self, SceneError<'t>> {
        let mut scene = Scene::new(board.defaults()).map_err(SceneError::View)?;
        let mut content = Content { board, files };
        for line in lines(text) {
            let (number, line) = line.map_err(SceneError::Line)?;
            let applied = line.apply(&mut scene, &mut content);
            applied.map_err(|error| SceneError::Setting(number, error))?;
        }
        let mut find = |name: &str| {
            let found = content.has_mesh(name).then(|| content.find(name)).flatten();
            // The name of a scene's mesh is not longer than a name.
            found.ok_or_else(|| SceneError::Missing(Name::try_from(name).unwrap_or_default()))
        };
        let mesh = scene.shown_mesh().map(&mut find).transpose()?;
        let mut objects = Vec::new();
        if scene.shows_objects() {
            for object in &scene.objects {
                // The list has as many places as that of the scene.
                let _ = objects.push(find(&object.mesh)?);
            }
        }
        let texture = scene.texture.as_deref();
        let program = scene.program.as_deref();
        let program = program.and_then(|name| named(files.programs, name));
        let cube = || wireframe::Program::new_checked(CUBE.as_flattened());
        Ok(Self {
            mesh,
            objects,
            texture: texture.and_then(|name| named(files.textures, name)),
            program: program.map_or_else(cube, Ok).map_err(SceneError::Program)?,
            scene,
        })
    }

    /// The objects with their placements.
    pub(crate) fn objects(&self) -> Vec<Object<'_>, MAX_OBJECTS> {
        let placed = self.scene.objects.iter().zip(&self.objects);
        placed
            .map(|(object, mesh)| self.scene.object(&object.place, *mesh))
            .collect()
    }

    /// The scene as a frame, with the objects of [`objects`](Self::objects).
    pub(crate) fn frame<'a>(&'a self, objects: &'a [Object<'a>]) -> Frame<'a> {
        self.scene.frame(Assets {
            mesh: self.mesh,
            objects,
            replacement_texture: self.texture,
            program: self.program,
        })
    }
}

/// The first of `files` with this name.
fn named<T: Copy>(files: &[(&str, T)], name: &str) -> Option<T> {
    let found = files.iter().find(|(own, _)| *own == name);
    found.map(|(_, file)| *file)
}

/// The board and the files of a program, as a scene sees them.
struct Content<'c> {
    board: &'c mut Board,
    files: SceneFiles<'c>,
}

impl Content<'_> {
    /// The mesh with this name: one of the program, or a built-in one that has been made.
    fn find(&self, name: &str) -> Option<Mesh<'static>> {
        named(self.files.meshes, name).or_else(|| self.board.made(name))
    }
}

impl glint_scene::Board for Content<'_> {
    fn has_size(&self, size: Size) -> bool {
        size.width() <= self.board.largest_size().width()
    }

    fn has_engine(&self) -> bool {
        self.board.defaults().backend == Backend::Gateware
    }

    fn has_mesh(&mut self, name: &str) -> bool {
        self.find(name).or_else(|| self.board.named(name)).is_some()
    }

    fn mesh(&self, name: &str) -> Option<Mesh<'_>> {
        self.find(name)
    }

    fn has_texture(&self, name: &str) -> bool {
        named(self.files.textures, name).is_some()
    }

    fn has_program(&self, name: &str) -> bool {
        named(self.files.programs, name).is_some()
    }
}
