//! Reasons why an option of a scene cannot be set.

use core::fmt::{self, Display};

use glint_core::camera::ViewError;
use glint_core::feature::{ANTIALIASING, MESH, OBJECT, SKY, TEXTURE, WIREFRAME};
use glint_core::framing::FramingError;
use glint_core::light::MAX_LIGHTS;
use glint_core::matrix::MatrixError;
use glint_core::object::MAX_OBJECTS;
use glint_core::picture::Size;
use glint_core::wireframe::CUBE_NAME;

/// Reason why an option is rejected. The error text names the option and the expected value.
#[derive(Clone, Copy, Debug)]
pub enum SettingError<'l> {
    /// The camera is out of range.
    View(ViewError),
    /// The board's memory or screen does not support this picture size.
    Size(Size),
    /// The SoC has no triangle engine.
    NoEngine,
    /// `stereo` was requested while the wireframe is shown, whose program sets its single eye.
    StereoOfWireframe,
    /// Edges were requested while the scene is not a single mesh.
    EdgesOfOthers,
    /// `fit` was requested while neither a single mesh nor objects are shown.
    FitOfOthers,
    /// No allowed camera shows the meshes completely.
    Fit(FramingError),
    /// A sky or a gradient was requested from a firmware without them.
    NoSky,
    /// Four samples a pixel were requested from a firmware without them.
    NoAntialiasing,
    /// The list of lights is full.
    Lights,
    /// No mesh has this name.
    ObjectMesh(&'l str),
    /// No uploaded texture has this name.
    Texture(&'l str),
    /// No wireframe program has this name.
    Program(&'l str),
    /// The list of objects cannot be changed.
    Object(ObjectError),
}

/// Reason why the list of objects cannot be changed.
#[derive(Clone, Copy, Debug)]
pub enum ObjectError {
    /// The list is full.
    Full,
    /// The list is empty.
    None,
    /// No object has this number.
    Number {
        /// The number that was given.
        number: u32,
        /// Number of objects.
        count: usize,
    },
    /// The matrix of an object would be out of range or singular.
    Matrix {
        /// The number of the object.
        number: u32,
        /// The error, which names the row and its violated condition.
        error: MatrixError,
    },
}

impl Display for SettingError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::View(error) => error.fmt(f),
            Self::Size(size) => write!(
                f,
                "size: {size} not available on this board, expected a smaller size"
            ),
            Self::NoEngine => f.write_str("gateware: no triangle engine in this SoC, expected cpu"),
            Self::StereoOfWireframe => f.write_str(
                "stereo: not available for the wireframe, expected `scene NAME` or `field FIELD` first",
            ),
            Self::EdgesOfOthers => f.write_str(
                "edges: not available for objects, fields and wireframes, expected `scene NAME` of a mesh first",
            ),
            Self::FitOfOthers => f.write_str(
                "fit: expected a mesh alone or objects; `camera 4 30 60` shows most fields",
            ),
            Self::Fit(error) => MESH.when_built(|| write!(f, "fit: {error}")),
            Self::NoSky => write!(f, "background: {SKY}"),
            Self::NoAntialiasing => write!(f, "aa: {ANTIALIASING}"),
            Self::Lights => write!(
                f,
                "light: expected at most {MAX_LIGHTS} lights, `light default` removes them"
            ),
            Self::ObjectMesh(name) => {
                write!(
                    f,
                    "object add `{name}`: expected a mesh, `models` lists them"
                )
            }
            Self::Texture(name) => TEXTURE.when_built(|| {
                write!(
                    f,
                    "texture `{name}`: expected own or an uploaded texture, `models` lists them"
                )
            }),
            Self::Program(name) => WIREFRAME.when_built(|| {
                write!(
                    f,
                    "program `{name}`: expected {CUBE_NAME} or an uploaded program, `models` lists them"
                )
            }),
            Self::Object(error) => OBJECT.when_built(|| error.fmt(f)),
        }
    }
}

impl Display for ObjectError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Full => write!(
                f,
                "object: expected at most {MAX_OBJECTS} objects, `object remove` removes one"
            ),
            Self::None => f.write_str("object: no objects, expected `object add MESH` first"),
            Self::Number { number, count: 0 } => write!(
                f,
                "object {number}: no objects, expected `object add MESH` first"
            ),
            Self::Number { number, count } => write!(
                f,
                "object {number}: expected 1 to {count}, `object list` lists the objects"
            ),
            Self::Matrix { number, error } => write!(f, "object {number}: {error}"),
        }
    }
}

impl core::error::Error for SettingError<'_> {}
impl core::error::Error for ObjectError {}

impl From<ViewError> for SettingError<'_> {
    fn from(error: ViewError) -> Self {
        Self::View(error)
    }
}

impl From<ObjectError> for SettingError<'_> {
    fn from(error: ObjectError) -> Self {
        Self::Object(error)
    }
}
