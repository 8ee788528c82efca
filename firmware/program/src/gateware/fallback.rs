//! Reasons to draw a frame, or to make its descriptors, by the CPU.

use core::fmt;

use glint_core::feature::{ANTIALIASING, CLIPPING, CPU, FIELD, FOG, Feature, SKY, TEXTURE};
use glint_engines::raymarch::Missing;
use glint_hal::triangle::{EngineError, Error};
use glint_model::RenderError;

/// The reason why the gateware cannot draw a frame.
#[derive(Clone, Copy, Debug)]
pub enum Fallback {
    /// The triangle engine reported an error.
    Triangle(EngineError),
    /// The raymarcher of this gateware lacks a feature.
    Field(Missing),
    /// This gateware is built without smooth shading.
    NoSmoothShading,
    /// This gateware is built without textures.
    NoTextures,
    /// This gateware is built without the sky behind meshes.
    NoSky,
    /// This gateware is built without fog on meshes.
    NoFog,
    /// This gateware is built without support for four samples per pixel.
    NoAntialiasing,
    /// The triangle engine supports fog only in perspective.
    OrthographicFog,
    /// The fog of the triangle engine would also be drawn over rectangles.
    RectanglesInFog,
    /// The triangle engine supports textures only with flat shading.
    SmoothTextures,
    /// The frame has more textures than the table of the triangle engine can hold.
    TooManyTextures,
    /// This gateware is built without a depth buffer.
    NoDepths,
    /// The eye is farther from the origin than the number formats of the triangle engine allow.
    Eye,
    /// The triangle engine supports smooth shading only in perspective.
    Orthographic,
    /// This build of the gateware has no raymarcher.
    NoRaymarcher,
    /// The gateware has no line engine for a wireframe.
    NoLineEngine,
    /// The frame has an option that geometry passes do not support, and this firmware lacks the code that makes descriptors on the soft
    /// core.
    Descriptors(Unsupported),
}

impl Fallback {
    /// The options of `cargo xtask gateware` that add the missing feature; `None` for other reasons.
    const fn build(&self) -> Option<&'static str> {
        match self {
            Self::NoSmoothShading => Some("--smooth"),
            Self::NoTextures => Some("--texture"),
            Self::NoSky => Some("without --no-sky"),
            Self::NoAntialiasing => Some("without --no-antialiasing"),
            Self::NoFog => Some("--fog"),
            Self::Field(_) => Some("--fields all"),
            Self::NoRaymarcher => Some("--blocks scanout triangle raymarch"),
            Self::NoLineEngine => Some("--blocks scanout triangle line"),
            Self::Triangle(EngineError::Status(Error::Triangles)) => {
                Some("--blocks scanout triangle")
            }
            Self::NoDepths => Some("without --no-depths"),
            Self::Descriptors(Unsupported::Geometry) => Some("without --no-geometry"),
            Self::Triangle(_)
            | Self::SmoothTextures
            | Self::TooManyTextures
            | Self::Eye
            | Self::Orthographic
            | Self::OrthographicFog
            | Self::RectanglesInFog
            | Self::Descriptors(_) => None,
        }
    }

    /// The part of a build that draws such a frame.
    pub const fn part(&self) -> Feature {
        match self {
            Self::Descriptors(Unsupported::Clipping) => CLIPPING,
            _ => CPU,
        }
    }

    /// Whether the reason is a feature that this build of the gateware lacks.
    pub const fn is_left_out(&self) -> bool {
        self.build().is_some()
    }
}

impl From<EngineError> for Fallback {
    fn from(error: EngineError) -> Self {
        Self::Triangle(error)
    }
}

impl From<Missing> for Fallback {
    fn from(missing: Missing) -> Self {
        Self::Field(missing)
    }
}

impl From<RenderError> for Fallback {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Eye(_) => Self::Eye,
            RenderError::Size { .. }
            | RenderError::Buffer { .. }
            | RenderError::Scratch { .. }
            | RenderError::Edges { .. }
            | RenderError::Near { .. }
            | RenderError::Far(_)
            | RenderError::Width { .. }
            | RenderError::Orthographic
            | RenderError::HalfWidth(_)
            | RenderError::Sides
            | RenderError::Window
            | RenderError::Objects(_)
            | RenderError::Stereo => EngineError::from(Error::Size).into(),
        }
    }
}

/// Writes the reason and, if a feature is missing, the command that builds gateware with this feature.
impl fmt::Display for Fallback {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Triangle(error) => error.fmt(f)?,
            Self::Field(missing) => FIELD.when_built(|| missing.fmt(f))?,
            Self::NoSmoothShading => {
                f.write_str("triangle engine: this gateware has no smooth shading")?;
            }
            Self::NoTextures => TEXTURE.when_built(|| {
                f.write_str(
                    "triangle engine: this gateware has no textures; `textures off` draws the mesh without them, fast",
                )
            })?,
            Self::NoSky => SKY.when_built(|| {
                f.write_str("triangle engine: this gateware has no sky behind meshes")
            })?,
            Self::NoFog => {
                FOG.when_built(|| f.write_str("triangle engine: this gateware has no fog on meshes"))?;
            }
            Self::NoAntialiasing => ANTIALIASING.when_built(|| {
                f.write_str("triangle engine: this gateware draws one sample per pixel")
            })?,
            Self::OrthographicFog => {
                FOG.when_built(|| f.write_str("triangle engine: no fog in orthographic projection"))?;
            }
            Self::RectanglesInFog => TEXTURE.when_built(|| {
                f.write_str("triangle engine: no rectangles in front of fog")
            })?,
            Self::SmoothTextures => TEXTURE.when_built(|| {
                f.write_str(
                    "triangle engine: no textures with smooth shading, expected `shading flat` or `textures off`",
                )
            })?,
            Self::TooManyTextures => TEXTURE.when_built(|| {
                f.write_str("triangle engine: expected at most 255 textures in a frame")
            })?,
            Self::NoDepths => f.write_str("triangle engine: this gateware has no depth buffer")?,
            Self::Eye => f.write_str("triangle engine: the eye is too far from the origin")?,
            Self::Orthographic => {
                f.write_str("triangle engine: no smooth shading in orthographic projection")?;
            }
            Self::NoRaymarcher => {
                FIELD.when_built(|| f.write_str("distance fields: this gateware has no raymarcher"))?;
            }
            Self::Descriptors(unsupported) => unsupported.fmt(f)?,
            Self::NoLineEngine => f.write_str("wireframe: this gateware has no line engine")?,
        }
        match self.build() {
            Some(build) => write!(f, ", expected a build by `cargo xtask gateware {build}`"),
            None => Ok(()),
        }
    }
}

/// A mesh option that geometry passes do not support. The CPU makes the descriptors of a frame with this option, and the gateware draws
/// them.
#[derive(Clone, Copy, Debug)]
pub enum Unsupported {
    /// All options, because this gateware has no geometry passes.
    Geometry,
    /// Clipping of triangles to the view volume.
    Volume,
    /// [`Winding::Screen`](glint_core::colour::Winding::Screen).
    Winding,
    /// Ambient light on the dark sides of smooth triangles: the engine stores the light of only one side of a vertex.
    DarkSides,
    /// Transformed normals of the object with this number, from 1, because no memory is free for a copy of the object's mesh.
    Normals(usize),
    /// A triangle that crosses the near plane or reaches far beyond the picture, in a build without the code that clips it.
    Clipping,
}

impl fmt::Display for Unsupported {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("geometry passes: ")?;
        match self {
            Self::Geometry => f.write_str("none in this gateware"),
            Self::Volume => f.write_str("no clipping to the view volume"),
            Self::Winding => f.write_str("no `winding screen`"),
            Self::DarkSides => f.write_str("no ambient light on smooth triangles with `cull off`"),
            Self::Clipping => f.write_str(
                "no triangle that crosses the near plane or reaches far beyond the picture",
            ),
            Self::Normals(object) => write!(
                f,
                "not enough memory for the transformed normals of object {object}, expected fewer or smaller objects with non-uniform scale"
            ),
        }
    }
}
