//! Reasons to draw a frame by the CPU.

use core::fmt;

use glint_hal::raymarch::Missing;
use glint_hal::triangle::{EngineError, Error};
use glint_model::RenderError;

/// The reason why the gateware cannot draw a frame.
#[derive(Clone, Copy, Debug)]
pub enum Fallback {
    /// The triangle engine reported an error.
    Triangle(EngineError),
    /// The raymarcher of this gateware lacks a feature.
    Field(Missing),
    /// The triangle engine draws one mesh a frame.
    Objects,
    /// The triangle engine clips to the guard band only.
    Clip,
    /// The triangle engine knows the winding of the mesh only.
    Winding,
    /// The triangle engine shades smoothly in perspective only.
    Orthographic,
    /// The triangle engine has no ambient light on the dark side of smooth triangles.
    Light,
    /// This build of the gateware has no raymarcher.
    NoRaymarcher,
    /// The gateware has no line engine for a wireframe.
    NoLineEngine,
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
        Self::Triangle(match error {
            RenderError::Eye(_) => EngineError::Eye,
            _ => Error::Size.into(),
        })
    }
}

impl fmt::Display for Fallback {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Triangle(error) => error.fmt(f),
            Self::Field(missing) => missing.fmt(f),
            Self::Objects => f.write_str("triangle engine: one mesh a frame"),
            Self::Clip => f.write_str("triangle engine: no clipping to the view volume"),
            Self::Winding => f.write_str("triangle engine: no winding by the screen"),
            Self::Orthographic => {
                f.write_str("triangle engine: no smooth shading in orthographic projection")
            }
            Self::Light => {
                f.write_str("triangle engine: no ambient light on smooth triangles with `cull off`")
            }
            Self::NoRaymarcher => f.write_str("distance fields: this gateware has no raymarcher"),
            Self::NoLineEngine => f.write_str("wireframe: this gateware has no line engine"),
        }
    }
}
