//! The clipper: homogeneous Sutherland–Hodgman in integers, before the perspective division.
//!
//! The clipper cuts triangles that cross the near plane or leave the guard band, or, as an option, all triangles that leave the view
//! volume. The intersection of an edge with a plane is the exact point, rounded. The result does not depend on the direction of the edge,
//! so two triangles that share an edge get the same vertex.

use core::mem;

use glint_core::camera::Projection;
use heapless::Vec;

use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::vertex::CameraVertex;
use crate::triangle::volume::Volume;

/// Largest number of vertices of a clipped triangle. Each of the six planes replaces every run of consecutive outside
/// vertices by two vertices, and n vertices have at most n/2 such runs: 3 → 4 → 6 → 9 → 13 → 19 → 28. (A convex polygon reaches
/// 9, but rounding may make a polygon concave.)
pub const MAX_VERTICES: usize = 28;

/// A vertex that the clipper interpolates. This is a trait, so that the code for triangles without textures does not interpolate texture
/// coordinates.
pub trait Cut: Copy + Default {
    /// Position and light of the vertex.
    fn vertex(&self) -> &CameraVertex;
    /// The vertex at a fraction of the way from `self` to `other`; `vertex` is the position and light of the result.
    fn towards(&self, other: &Self, vertex: CameraVertex, fraction: &Fraction) -> Self;
}

impl Cut for CameraVertex {
    fn vertex(&self) -> &CameraVertex {
        self
    }
    fn towards(&self, _: &Self, vertex: CameraVertex, _: &Fraction) -> Self {
        vertex
    }
}

/// A vertex of a triangle with a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexturedVertex {
    /// Position and light of the vertex.
    pub vertex: CameraVertex,
    /// Coordinates s and t of the texture, s16.16.
    pub coordinates: [i32; 2],
}

impl Cut for TexturedVertex {
    fn vertex(&self) -> &CameraVertex {
        &self.vertex
    }
    fn towards(&self, other: &Self, vertex: CameraVertex, fraction: &Fraction) -> Self {
        let coordinates = [0, 1].map(|i: usize| {
            let [a, b] = [self, other].map(|corner| i64::from(corner.coordinates[i]));
            (a + fraction.of(b - a)) as i32
        });
        Self {
            vertex,
            coordinates,
        }
    }
}

/// The vertices of a polygon that remains of a triangle after clipping.
pub type Polygon<C = CameraVertex> = Vec<C, MAX_VERTICES>;

/// The planes of a volume, in the order of clipping.
fn planes(volume: Volume) -> impl Iterator<Item = Plane> {
    let has_far = volume != Volume::Guard;
    Plane::ALL
        .into_iter()
        .filter(move |&plane| has_far || plane != Plane::Far)
}

/// Whether a vertex is inside all planes of the volume.
pub fn contains(frame: &MeshSetup, vertex: &CameraVertex) -> bool {
    planes(frame.volume).all(|plane| plane.distance(frame, vertex) >= 0)
}

/// A plane that bounds the volume of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// Near plane; inside is Z ≥ near.
    Near,
    /// Far plane; inside is Z ≤ far.
    Far,
    /// Left side of the picture; inside is at or to the right of this side.
    Left,
    /// Right side of the picture; inside is at or to the left of this side.
    Right,
    /// Top side of the picture; inside is at or below this side.
    Top,
    /// Bottom side of the picture; inside is at or above this side.
    Bottom,
}

impl Plane {
    /// All planes, in the order of clipping.
    pub const ALL: [Self; 6] = [
        Self::Near,
        Self::Far,
        Self::Left,
        Self::Right,
        Self::Top,
        Self::Bottom,
    ];

    /// The exact signed distance of a vertex from the plane, times a positive factor that depends on the plane only;
    /// negative is outside.
    pub fn distance(self, frame: &MeshSetup, vertex: &CameraVertex) -> i64 {
        let ([width, height], [across, down]) = (frame.picture, frame.middle);
        let [left, right] = frame.volume.sides(width, across);
        let [top, bottom] = frame.volume.sides(height, down);
        match self {
            Self::Near => vertex.z - frame.near,
            Self::Far => match frame.volume {
                Volume::Guard => i64::MAX,
                Volume::View { far } => far - vertex.z,
            },
            Self::Left => left * divisor(frame, vertex) + half_pixels(frame, vertex.x),
            Self::Right => right * divisor(frame, vertex) - half_pixels(frame, vertex.x),
            Self::Top => top * divisor(frame, vertex) + half_pixels(frame, vertex.y),
            Self::Bottom => bottom * divisor(frame, vertex) - half_pixels(frame, vertex.y),
        }
    }

    /// Writes the part of `polygon` inside the plane to `left`. If the whole polygon is inside, writes nothing and returns `false`.
    fn cut<C: Cut>(self, frame: &MeshSetup, polygon: &Polygon<C>, left: &mut Polygon<C>) -> bool {
        let Some(mut from) = polygon.last() else {
            return false;
        };
        if polygon
            .iter()
            .all(|corner| self.distance(frame, corner.vertex()) >= 0)
        {
            return false;
        }
        left.clear();
        // A clipped triangle has at most `MAX_VERTICES` vertices, so the push does not fail.
        let mut put = |vertex| {
            let _ = left.push(vertex);
        };
        let mut from_distance = self.distance(frame, from.vertex());
        for to in polygon {
            let to_distance = self.distance(frame, to.vertex());
            match (from_distance >= 0, to_distance >= 0) {
                (true, true) => put(*to),
                (true, false) => {
                    put(self.intersection(frame, from, from_distance, to, to_distance));
                }
                (false, true) => {
                    put(self.intersection(frame, to, to_distance, from, from_distance));
                    put(*to);
                }
                (false, false) => {}
            }
            (from, from_distance) = (to, to_distance);
        }
        true
    }

    /// The intersection of the plane with the edge from `from` to `to`. `from` is inside at the distance `da`, and `to` is outside at the
    /// distance `db`.
    fn intersection<C: Cut>(self, frame: &MeshSetup, from: &C, da: i64, to: &C, db: i64) -> C {
        let fraction = Fraction::new(da.unsigned_abs(), da.abs_diff(db));
        let (a, b) = (from.vertex(), to.vertex());
        let between = |a: i64, b: i64| a + fraction.of(b - a);
        let vertex = CameraVertex {
            x: between(a.x, b.x),
            y: between(a.y, b.y),
            z: match (self, frame.volume) {
                (Self::Near, _) => frame.near,
                (Self::Far, Volume::View { far }) => far,
                _ => between(a.z, b.z),
            },
            light: a
                .light
                .zip_with(b.light, |a, b| between(a.into(), b.into()) as u16),
        };
        from.towards(to, vertex, &fraction)
    }
}

/// The homogeneous coordinate by which X and Y are divided, 37 fraction bits.
const fn divisor(frame: &MeshSetup, vertex: &CameraVertex) -> i64 {
    match frame.projection {
        Projection::Perspective => vertex.z,
        Projection::Orthographic => 1 << 37,
    }
}

/// Converts the camera coordinate X or Y of a vertex to half pixels at distance 1, with the fraction bits of Z. The result
/// is below 2^59.7. `Plane::distance` adds multiples of Z to it, at most 6655·|Z|, which is below 2^53.4.
fn half_pixels(frame: &MeshSetup, x: i64) -> i64 {
    x << (24 - frame.scale_shift)
}

/// Whether a triangle is completely beyond one side of the window. In perspective the plane through this side and the eye separates the
/// triangle from the window, so the test is also valid for vertices behind the eye.
///
/// With this fast test, such a triangle is not clipped, which would leave no pixel of it.
pub fn off_picture<C: Cut>(frame: &MeshSetup, triangle: &[C; 3]) -> bool {
    let off = |x: fn(&CameraVertex) -> i64, size: u32, middle: u32| {
        let [first, last] = [2 * middle, 2 * (size - middle)].map(i64::from);
        let places = triangle.each_ref().map(|corner| {
            let v = corner.vertex();
            (half_pixels(frame, x(v)), divisor(frame, v))
        });
        places.iter().all(|(x, z)| *x < -first * z) || places.iter().all(|(x, z)| *x > last * z)
    };
    let [across, down] = frame.middle;
    off(|v| v.x, frame.width, across) || off(|v| v.y, frame.height, down)
}

/// Clips a triangle to the volume of the frame, starting with its first vertex. Returns the vertices of the remaining polygon in order;
/// fewer than three if no part of the triangle is inside the volume. `space` is memory for the polygons before and after a plane, which are
/// too large to be moved.
pub fn clip<'a, C: Cut>(
    frame: &MeshSetup,
    triangle: [C; 3],
    [polygon, left]: &'a mut [Polygon<C>; 2],
) -> &'a [C] {
    let (mut polygon, mut left) = (polygon, left);
    polygon.clear();
    polygon.extend(triangle);
    for plane in planes(frame.volume) {
        if plane.cut(frame, polygon, left) {
            mem::swap(&mut polygon, &mut left);
        }
    }
    polygon
}

/// Clips an edge to the volume of the frame; `None` if no part of the edge is inside. The new ends equal the vertices of the clipped
/// triangles with this edge.
pub fn clip_edge(
    frame: &MeshSetup,
    [mut a, mut b]: [CameraVertex; 2],
) -> Option<[CameraVertex; 2]> {
    for plane in planes(frame.volume) {
        let [da, db] = [&a, &b].map(|vertex| plane.distance(frame, vertex));
        match (da >= 0, db >= 0) {
            (true, true) => {}
            (true, false) => b = plane.intersection(frame, &a, da, &b, db),
            (false, true) => a = plane.intersection(frame, &b, db, &a, da),
            (false, false) => return None,
        }
    }
    Some([a, b])
}

/// A fraction `part`/`whole` from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Fraction {
    part: u64,
    whole: u64,
    /// The fraction, rounded down, 48 fraction bits.
    approximation: u64,
}

impl Fraction {
    /// Fraction bits of the approximation.
    const BITS: u32 = 48;

    /// The fraction `part`/`whole`, for part ≤ whole < 2^61 and whole > 0.
    fn new(part: u64, whole: u64) -> Self {
        let (mut quotient, mut rest) = (0, part);
        if rest >= whole {
            (quotient, rest) = (1, 0);
        }
        for _ in 0..Self::BITS {
            (quotient, rest) = (2 * quotient, 2 * rest);
            if rest >= whole {
                (quotient, rest) = (quotient + 1, rest - whole);
            }
        }
        Self {
            part,
            whole,
            approximation: quotient,
        }
    }

    /// The fraction of `x`, to nearest, ties up, for |x| < 2^45.
    ///
    /// The product with the approximation is at most |x| / 2^48 < 1/8 too small, so its whole part is the exact quotient or the quotient
    /// less 1; it is at most |x|, so it fits i64. The rest of the division is less than 2·whole, so 64 bits hold it although both products
    /// may have more.
    fn of(&self, x: i64) -> i64 {
        debug_assert!(x.unsigned_abs() < 1 << 45);
        let (size, low) = (x.unsigned_abs(), self.approximation & 0xffff_ffff);
        let lower = (size >> 32) * low + (((size & 0xffff_ffff) * low) >> 32);
        let mut quotient = (size * (self.approximation >> 32) + lower) >> (Self::BITS - 32);
        let mut rest = size
            .wrapping_mul(self.part)
            .wrapping_sub(quotient.wrapping_mul(self.whole));
        if rest >= self.whole {
            (quotient, rest) = (quotient + 1, rest - self.whole);
        }
        if x < 0 {
            -(quotient as i64) - i64::from(2 * rest > self.whole)
        } else {
            quotient as i64 + i64::from(2 * rest >= self.whole)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Fraction;

    #[test]
    fn fractions_are_nearest_with_ties_up() {
        let mut state = 1u64;
        let mut random = |bits: u32| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            state >> (64 - bits)
        };
        for round in 0..200_000u32 {
            // Half of the iterations use small numbers, for which many quotients are ties.
            let (wide, long) = if round % 2 == 0 { (4, 5) } else { (61, 45) };
            let whole = random(wide).max(1);
            let part = random(wide) % (whole + 1);
            let x = random(long) as i64 - (1 << (long - 1));
            let twice = 2 * i128::from(x) * i128::from(part) + i128::from(whole);
            let expected = twice.div_euclid(2 * i128::from(whole));
            assert_eq!(
                i128::from(Fraction::new(part, whole).of(x)),
                expected,
                "{x}·{part}/{whole}"
            );
        }
        assert_eq!(Fraction::new(0, 1).of(0), 0);
        let (largest, longest) = ((1 << 61) - 1, (1 << 45) - 1);
        for x in [-longest, longest] {
            assert_eq!(Fraction::new(largest, largest).of(x), x);
            assert_eq!(Fraction::new(largest - 1, largest).of(x), x);
            assert_eq!(Fraction::new(1, largest).of(x), 0);
        }
    }
}
