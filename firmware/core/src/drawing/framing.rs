//! Cameras that show one or several whole meshes.

use core::fmt;

use crate::camera::{HALF_WIDTH, View, ViewError};
use crate::fixed::{Q32_32, Turns, U8_28};
use crate::matrix::{Axis, Matrix};
use crate::mesh::Mesh;
use crate::trig::sin_cos_q30;

/// A length or a coordinate in units of 2^−20.
type Length = i64;

/// 1 in units of a [`Length`].
const ONE: Length = 1 << 20;
/// Smallest distance between the camera and the sphere: twice the distance of the near plane.
const LEAST_GAP: Length = ONE / 5;
/// Largest distance of the eye from the origin, 7.9: just below the limit for pictures of meshes.
const FARTHEST: Length = ONE * 79 / 10;
/// Azimuth of the camera, 30°.
const AZIMUTH: Turns = Turns::from_degrees(Q32_32::lit("30"));
/// Angle of the camera from the up axis, 60°.
const POLAR: Turns = Turns::from_degrees(Q32_32::lit("60"));

/// The upward axis of mesh files with this extension, and the extension in lower case; `None` if the upward axis is z.
pub fn upright(extension: &str) -> Option<(Axis, &'static str)> {
    let mut known = ["obj", "gltf", "glb"].into_iter();
    let known = known.find(|known| extension.eq_ignore_ascii_case(known))?;
    Some((Axis::Y, known))
}

/// A sphere around all vertices of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundingSphere {
    /// The centre of the box around the vertices, rounded down.
    centre: [Length; 3],
    /// Distance of the farthest vertex from the centre, rounded up.
    radius: Length,
}

/// Reason why no camera shows a whole sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FramingError {
    /// The sphere extends too far from the origin: no allowed position of the eye is outside of it.
    TooFar(BoundingSphere),
    /// The field of view is out of range.
    View(ViewError),
}

impl fmt::Display for FramingError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::TooFar(sphere) => {
                let [x, y, z] = sphere.centre.map(world);
                write!(
                    f,
                    "meshes in a sphere of radius {:.3} about ({x:.3}, {y:.3}, {z:.3}): expected an eye outside of it within {:.1} of the origin",
                    world(sphere.radius),
                    world(FARTHEST)
                )
            }
            Self::View(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for FramingError {}

impl BoundingSphere {
    /// Computes the sphere around placed meshes; `None` without a mesh. Centre and radius are within 2^−19 of their exact values.
    pub fn around<'a>(meshes: impl Iterator<Item = (Mesh<'a>, Matrix)> + Clone) -> Option<Self> {
        let points = points(meshes);
        let first = points.clone().next()?;
        let (mut low, mut high) = (first, first);
        for point in points.clone() {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let centre = [0, 1, 2].map(|axis| (low[axis] + high[axis]) >> 1);
        let square = |point: [Length; 3]| length_squared([0, 1, 2].map(|i| point[i] - centre[i]));
        let square = points.map(square).max().unwrap_or(0);
        let radius = square.isqrt();
        Some(Self {
            centre,
            radius: (radius + u64::from(radius * radius < square)) as Length,
        })
    }

    /// Returns a camera in whose picture the sphere fills 80 % of the height, with the axis `up` up on the screen. The direction
    /// to the camera has an angle of 60° from this axis, and an azimuth of 30° plus `turned` about this
    /// axis.
    ///
    /// A given horizontal field of view determines the distance of the eye; otherwise the distance is 3.5 radii, which determines
    /// the field of view. The distance is clamped so that the eye is neither too far from the origin nor too close to the sphere.
    ///
    /// # Errors
    /// No allowed eye is outside of the sphere, or the field of view is out of range.
    pub fn framed(
        &self,
        up: Axis,
        turned: Turns,
        field_of_view: Option<Turns>,
    ) -> Result<View, FramingError> {
        let Self { centre, radius } = *self;
        let wanted = match field_of_view {
            None => radius * 7 / 2,
            Some(angle) => hypotenuse(radius, tangent_length(radius, angle)),
        };
        let (least, most) = (
            radius + LEAST_GAP,
            FARTHEST - length_squared(centre).isqrt() as Length,
        );
        if least > most {
            return Err(FramingError::TooFar(*self));
        }
        let distance = wanted.clamp(least, most);
        let [[sp, cp], [st, ct]] = [POLAR, AZIMUTH.wrapping_add(turned)].map(sines);
        // Direction from the sphere to the camera, in units of 2^−30.
        let back = about(up, [(sp * ct) >> 30, (sp * st) >> 30, cp]);
        let eye = [0, 1, 2].map(|i| {
            let shift = (distance * back[i]) >> 18;
            Q32_32::from_bits(world(centre[i]).to_bits() + shift)
        });
        let gaze = back.map(|x| Q32_32::from_bits(-x << 2));
        let up = about(up, [Q32_32::ZERO, Q32_32::ZERO, Q32_32::ONE]);
        let view = View::towards(eye, gaze, up).map_err(FramingError::View)?;
        let view = match field_of_view {
            Some(angle) => view.with_field_of_view(angle),
            None => view.with_half_width(half_width(radius, distance)),
        };
        view.map_err(FramingError::View)
    }
}

/// Sets the half width of the image plane of cameras whose eyes are outside of the sphere around placed meshes: the smallest with which all
/// vertices, in the pictures of all cameras, are within the middle 90 % of width and height; rounding leaves them within 90.01 %.
///
/// A mesh that is too small for this fills less.
///
/// # Errors
/// None: the half width is clamped to its range.
pub fn fill<'a>(
    views: &mut [View],
    meshes: impl Iterator<Item = (Mesh<'a>, Matrix)> + Clone,
) -> Result<(), ViewError> {
    let mut widest = 0_u64;
    for view in views.iter() {
        let eye = view.eye().map(|x| x.to_bits() >> 12);
        let axes = [view.u(), view.v(), view.n()];
        for point in points(meshes.clone()) {
            let from_eye = [0, 1, 2].map(|i| point[i] - eye[i]);
            // Units of 2^−43; below 2^51, because eye and point are within 8 world units of the origin.
            let [right, down, forward] = axes.map(|axis| {
                let products = [0, 1, 2].map(|i| from_eye[i] * i64::from(axis[i].to_bits()));
                products.iter().sum::<Length>()
            });
            // A half width h means a half height of 9/16·h.
            let across = right.unsigned_abs().max(down.unsigned_abs() / 9 * 16);
            widest = widest.max(across / (forward.unsigned_abs() >> 28).max(1));
        }
    }
    let half_width = U8_28::from_bits(widest / 9 * 10).clamp(HALF_WIDTH[0], HALF_WIDTH[1]);
    for view in views {
        *view = view.with_half_width(half_width)?;
    }
    Ok(())
}

/// The vertices of placed meshes, rounded down.
fn points<'a>(
    meshes: impl Iterator<Item = (Mesh<'a>, Matrix)> + Clone,
) -> impl Iterator<Item = [Length; 3]> + Clone {
    meshes.flat_map(|(mesh, matrix)| {
        let vertices = mesh.chunks().flat_map(|chunk| chunk.vertices());
        // Converted from units of 2^−38.
        vertices.map(move |vertex| matrix.apply(vertex.position).map(|x| x >> 18))
    })
}

/// Length of a tangent from the eye to a sphere of this radius that fills 80 % of the height with this field of view; at most
/// [`FARTHEST`].
fn tangent_length(radius: Length, angle: Turns) -> Length {
    let [sin, cos] = sines(Turns(angle.0 / 2)).map(i64::unsigned_abs);
    // A half width h means a half height of 9/16·h, and 80 % of this is 9/20·h. As a radius is below 2^29, the products are
    // below 2^64.
    let length = radius.unsigned_abs() * cos * 20 / (sin * 9).max(1);
    length.min(FARTHEST as u64) as Length
}

/// The half width of the image plane with which a sphere of this radius fills 80 % of the height at
/// this distance. The distance is larger than the
/// radius.
fn half_width(radius: Length, distance: Length) -> U8_28 {
    let touching = ((distance - radius) * (distance + radius)).isqrt().max(1);
    // The radius is below 2^23, because the eye is outside of the sphere.
    let bits = ((radius << 28) * 20 / (touching * 9)).unsigned_abs();
    U8_28::from_bits(bits).clamp(HALF_WIDTH[0], HALF_WIDTH[1])
}

/// Sine and cosine in units of 2^−30.
fn sines(angle: Turns) -> [i64; 2] {
    let (sin, cos) = sin_cos_q30(angle);
    [sin, cos].map(|x| x.to_bits().into())
}

/// The squared length of a vector with components below 2^30.
fn length_squared(vector: [Length; 3]) -> u64 {
    vector.map(|x| x.unsigned_abs().pow(2)).iter().sum()
}

/// The square root of a² + b². `a` and `b` are below 2^30.
fn hypotenuse(a: Length, b: Length) -> Length {
    length_squared([a, b, 0]).isqrt() as Length
}

/// Converts a length to world units.
const fn world(length: Length) -> Q32_32 {
    Q32_32::from_bits(length << 12)
}

/// Permutes the coordinates of a vector so that its z axis becomes the axis `up`.
fn about<T>(up: Axis, [a, b, c]: [T; 3]) -> [T; 3] {
    match up {
        Axis::X => [c, a, b],
        Axis::Y => [b, c, a],
        Axis::Z => [a, b, c],
    }
}
