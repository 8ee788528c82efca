//! Limits of the frames that the model draws, and errors for frames beyond these limits.

use core::fmt;

use glint_core::fixed::{Decimal, Q32_32, U4_28, U8_28};
use glint_core::object::MAX_OBJECTS;
use glint_core::picture::{Size, Window};

/// The sizes of a picture: width and height in pixels.
pub const SIZES: [(u32, u32); 3] = {
    let [a, b, c] = Size::ALL;
    [
        (a.width(), a.height()),
        (b.width(), b.height()),
        (c.width(), c.height()),
    ]
};

/// The window that covers the whole picture of this width and height.
///
/// # Errors
/// [`RenderError::Size`] for a size that is not one of the [`SIZES`].
pub(crate) fn whole_picture((width, height): (u32, u32)) -> Result<Window, RenderError> {
    let size = Size::of(width, height).ok_or(RenderError::Size { width, height })?;
    Ok(Window::whole(size))
}

/// Largest distance of the eye from the origin in a frame with a mesh, in world units. This bounds the translation in the mesh's frame
/// constants, and thereby the bit widths of the vertex stage.
pub const MAX_EYE: u32 = 8;

/// Smallest and largest half width of the camera in a frame with a field, in world units. This bounds the directions of rays.
pub const FIELD_HALF_WIDTH: [U8_28; 2] = [U8_28::lit("0.05"), U8_28::lit("4")];

/// A buffer of a picture, for [`RenderError::Buffer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffer {
    /// Colours of the pixels.
    Colour,
    /// Depth codes of the pixels.
    Depth,
}

/// Reason why a frame was refused; nothing was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RenderError {
    /// The picture's size is not one of the [`SIZES`].
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// A buffer does not have exactly one element for each pixel.
    Buffer {
        /// The buffer of the wrong size.
        buffer: Buffer,
        /// Number of pixels of the picture.
        expected: usize,
        /// Number of elements of the buffer.
        found: usize,
    },
    /// The scratch memory holds fewer vertices than the largest chunk of the mesh has.
    Scratch {
        /// Number of vertices in the largest chunk.
        expected: usize,
        /// Number of vertices that the scratch memory holds.
        found: usize,
    },
    /// The memory for the list of a mesh's edges is too small.
    Edges {
        /// Number of triangles of the mesh.
        triangles: u32,
    },
    /// The eye of a frame with a mesh is farther than [`MAX_EYE`] from the origin.
    Eye([Q32_32; 3]),
    /// The near plane of a frame with a mesh is too near for the half width, the width of the picture and the size of an object.
    Near {
        /// Distance of the near plane in world units.
        near: U4_28,
        /// Smallest allowed distance in world units.
        least: U4_28,
    },
    /// The far plane is not beyond the near plane.
    Far(U8_28),
    /// The view of an orthographic camera is too narrow for the picture's width in pixels and the size of an object.
    Width {
        /// Width in world units.
        width: U8_28,
        /// Smallest allowed width in world units.
        least: U8_28,
    },
    /// The camera in a frame with a field, or with two eyes, is orthographic.
    Orthographic,
    /// The half width of the camera is out of range for a field.
    HalfWidth(U8_28),
    /// A side of the camera's window is out of range for a field.
    Sides,
    /// The camera's window is too far from its axis for its width or height.
    Window,
    /// A frame has more objects than [`MAX_OBJECTS`].
    Objects(usize),
    /// Two eyes were requested for a wireframe, which has its own eye, or for a frame that must be drawn as one frame per eye.
    Stereo,
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Size { width, height } => {
                write!(f, "picture size {width}x{height}: expected")?;
                SIZES
                    .iter()
                    .enumerate()
                    .try_for_each(|(i, (width, height))| {
                        write!(f, "{} {width}x{height}", if i == 0 { "" } else { "," })
                    })
            }
            Self::Buffer {
                buffer,
                expected,
                found,
            } => {
                let name = match buffer {
                    Buffer::Colour => "colour",
                    Buffer::Depth => "depth",
                };
                write!(
                    f,
                    "{name} buffer of {found} pixels: expected {expected}, the picture's width times its height"
                )
            }
            Self::Scratch { expected, found } => write!(
                f,
                "scratch for {found} vertices: expected at least {expected}, the number in the largest chunk"
            ),
            Self::Edges { triangles } => write!(
                f,
                "edges of {triangles} triangles: expected fewer triangles, to fit the memory for edges"
            ),
            Self::Eye(eye) => {
                let [x, y, z] = eye.map(Decimal);
                write!(f, "eye ({x}, {y}, {z}): expected within {MAX_EYE} of the origin for a mesh")
            }
            Self::Near { near, least } => {
                let [near, least] = [*near, *least].map(Decimal);
                write!(
                    f,
                    "near {near}: expected at least {least} for a mesh of this size in a picture of this width and field of view"
                )
            }
            Self::Far(far) => {
                let far = Decimal(*far);
                write!(f, "far {far}: expected a plane beyond the near plane")
            }
            Self::Width { width, least } => {
                let [width, least] = [*width, *least].map(Decimal);
                write!(
                    f,
                    "width {width}: expected at least {least} for an object of this size in a picture of this width"
                )
            }
            Self::Orthographic => {
                f.write_str("orthographic projection: expected perspective with a field or two eyes, set by a field of view")
            }
            Self::HalfWidth(half_width) => {
                let [found, least, most] =
                    [*half_width, FIELD_HALF_WIDTH[0], FIELD_HALF_WIDTH[1]].map(Decimal);
                write!(f, "half_width {found}: expected {least} to {most} with a field")
            }
            Self::Sides => {
                let [least, most] = FIELD_HALF_WIDTH.map(Decimal);
                write!(f, "window: expected sides within {most} of the camera's axis, and a half height of at least 9/16 * {least}, with a field")
            }
            Self::Window => f.write_str(
                "window: expected a centre closer to the camera's axis, or a larger width and height, for a picture of this width",
            ),
            Self::Objects(found) => {
                write!(f, "{found} objects: expected at most {MAX_OBJECTS}")
            }
            Self::Stereo => {
                f.write_str("two eyes: expected meshes or a field, or one eye for a wireframe")
            }
        }
    }
}

impl core::error::Error for RenderError {}
