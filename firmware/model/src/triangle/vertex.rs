//! The vertex stage, which transforms a position in the mesh to a position on the screen.

use glint_core::camera::Projection;

use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::reciprocal::Reciprocal;
use crate::triangle::rounding::nearest;
use crate::triangle::shade::Light;

/// Extent of the guard band from the top left corner in every direction: 2047 pixels, s12.8.
pub const GUARD: i32 = 2047 << 8;

/// Positions saturate at this distance from the centre: 4096 pixels, 12 fraction bits.
const LIMIT: i64 = 1 << 24;
/// The largest depth code, u18.6.
pub(super) const LARGEST_DEPTH: u32 = ((1 << 18) - 1) * 64;

/// A vertex in camera coordinates, before the perspective division.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CameraVertex {
    /// Coordinate X along the right axis, relative to the eye, in pixels (in perspective at distance 1): s44 with 14 + f fraction bits,
    /// where f is the scale shift of the frame constants.
    pub x: i64,
    /// Coordinate Y along the down axis, in the format of `x`.
    pub y: i64,
    /// Depth Z along the forward axis, in world units: s44 with 37 fraction bits. In orthographic projection it is relative to the depth
    /// of the code 2^18.
    pub z: i64,
    /// Light of the vertex under smooth shading, otherwise black.
    pub light: Light,
}

/// A vertex on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenVertex {
    /// Distance from the left in pixels, 8 fraction bits; s12.8 inside the guard band.
    pub x: i32,
    /// Distance from the top, in the format of `x`.
    pub y: i32,
    /// Depth code before rounding, u18.6; larger is nearer.
    pub w: u32,
}

/// The result of the vertex stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projected {
    /// The vertex is inside the guard band.
    Visible(ScreenVertex),
    /// The vertex is nearer than the near plane, or behind the eye.
    Behind,
    /// The vertex is beyond the near plane, but outside the guard band, or outside a view volume to which triangles are clipped. A position
    /// outside the guard band may be saturated, and then only shows beyond which sides of the picture the vertex is.
    BeyondGuard(ScreenVertex),
}

impl Projected {
    /// Position on the screen, inside or outside the guard band; `None` for a vertex behind the near plane.
    pub const fn place(&self) -> Option<&ScreenVertex> {
        match self {
            Self::Visible(place) | Self::BeyondGuard(place) => Some(place),
            Self::Behind => None,
        }
    }

    /// Whether the vertex is beyond the near plane, but its triangles need clipping.
    pub const fn is_beyond_guard(&self) -> bool {
        matches!(self, Self::BeyondGuard(_))
    }
}

/// Transforms a position to camera coordinates: steps 1 and 2 of the vertex stage (docs/formats/triangle.md).
///
/// The position P with |P| ≤ 2·√3 is less than 2^15.8 in its units, and a row is shorter than 2^24.01 (2^23.01 for n), so
/// each scalar product is below 2^39.9. A translation is at most 8 times the length of a row, 2^41.1. Therefore |X|, |Y| < 2^41.7 and |Z|
/// < 2^40.7.
pub fn transform(frame: &MeshSetup, position: [i16; 3]) -> CameraVertex {
    let dot = |row: &[i32; 3]| -> i64 {
        core::iter::zip(position, row)
            .map(|(p, &r)| i64::from(p) * i64::from(r))
            .sum()
    };
    let [tx, ty, tz] = frame.translation;
    CameraVertex {
        x: dot(&frame.u) + tx,
        y: dot(&frame.v) + ty,
        z: dot(&frame.n) + tz,
        light: Light::default(),
    }
}

/// Projects a vertex to the screen, or finds that it is nearer than the near plane: steps 3 to 8 of the vertex stage
/// (docs/formats/triangle.md).
pub fn project(frame: &MeshSetup, vertex: &CameraVertex) -> Projected {
    if vertex.z < frame.near {
        return Projected::Behind;
    }
    let place = snap(frame, vertex);
    let inside = |x: i32| (-GUARD..=GUARD).contains(&x);
    if inside(place.x) && inside(place.y) {
        Projected::Visible(place)
    } else {
        Projected::BeyondGuard(place)
    }
}

/// Projects a vertex at or beyond the near plane to the screen: steps 4 to 8 of the vertex stage (docs/formats/triangle.md).
///
/// A position more than 4096 pixels from the centre saturates at 4096 pixels or more: it stays outside the guard band.
///
/// Inlined, so that the code of the loop over vertices is contiguous and has no conflicts in the direct-mapped
/// instruction cache.
#[inline(always)]
pub fn snap(frame: &MeshSetup, vertex: &CameraVertex) -> ScreenVertex {
    if frame.projection == Projection::Orthographic {
        return snap_orthographic(frame, vertex);
    }
    let Reciprocal { y, lead } = Reciprocal::of(vertex.z as u64);
    // Z is at least the distance of the near plane, so `lead` is in 30…40, and at least 40 − f. With f in 6…18 the shift is in
    // 6…24.
    let shift = frame.scale_shift + lead - 34;
    let divide = |x: i64, middle: u32| {
        // `normalised` is s14.11, and its product with the u24 number y is exact.
        let normalised = nearest(x, shift).clamp(-LIMIT, LIMIT - 1);
        (middle << 8) as i32 + nearest(normalised * i64::from(y), 27) as i32
    };
    ScreenVertex {
        x: divide(vertex.x, frame.middle[0]),
        y: divide(vertex.y, frame.middle[1]),
        w: depth(frame, y, lead),
    }
}

/// Projects a vertex to the screen in orthographic projection: X and Y are the position in pixels, and the depth code is linear in Z.
///
/// Not inlined, so that the loop over vertices in perspective does not load this code into the instruction cache.
#[inline(never)]
fn snap_orthographic(frame: &MeshSetup, vertex: &CameraVertex) -> ScreenVertex {
    const BITS: i64 = (1 << 24) - 1;
    let place = |x: i64, middle: u32| {
        let normalised = nearest(x, frame.scale_shift + 2).clamp(-LIMIT, LIMIT - 1);
        (middle << 8) as i32 + nearest(normalised, 4) as i32
    };
    // Z is below 2^(36 + ke), with ke in −6…5. Only a vertex outside of the mesh's radius has other depths, which wrap.
    let m = (vertex.z >> (12 + frame.depth.exponent)) & BITS;
    ScreenVertex {
        x: place(vertex.x, frame.middle[0]),
        y: place(vertex.y, frame.middle[1]),
        w: (-m & BITS).min(LARGEST_DEPTH.into()) as u32,
    }
}

/// Step 8 of the vertex stage: the depth code before rounding, w = K/Z. The codes of a mesh within its radius never
/// saturate.
fn depth(frame: &MeshSetup, y: u32, lead: u32) -> u32 {
    // The product has 17 + 24 bits; the exponent is in −5…5, so the shift is in 6…26.
    let product = u64::from(frame.depth.mantissa) * u64::from(y);
    let shift = (lead as i32 - 19 - frame.depth.exponent) as u32;
    nearest(product as i64, shift).min(LARGEST_DEPTH.into()) as u32
}
