//! The clipper, for triangles that cross the near plane or leave the guard band.
//!
//! Clipping works on camera coordinates, before the perspective division. The intersection of an edge with a plane is the
//! exact point after rounding. It does not depend on the direction of the edge, so the two triangles at an edge get the
//! same vertex.

use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::vertex::CameraVertex;

/// Largest number of vertices of a clipped triangle. Each of the five planes replaces every run of consecutive outside
/// vertices by two vertices, and n vertices have at most n/2 such runs: 3 → 4 → 6 → 9 → 13 → 19. (A convex polygon reaches 8, but
/// rounding may make a polygon concave.)
const MAX_VERTICES: usize = 19;

/// The polygon that remains of a triangle after clipping.
#[derive(Clone, Copy, Debug)]
pub struct Polygon {
    vertices: [CameraVertex; MAX_VERTICES],
    len: usize,
}

impl Polygon {
    fn empty() -> Self {
        Self {
            vertices: [CameraVertex::default(); MAX_VERTICES],
            len: 0,
        }
    }

    /// The vertices in order; fewer than three if no part of the triangle is inside the view volume.
    pub fn vertices(&self) -> &[CameraVertex] {
        self.vertices.get(..self.len).unwrap_or_default()
    }

    fn push(&mut self, vertex: CameraVertex) {
        if let Some(slot) = self.vertices.get_mut(self.len) {
            *slot = vertex;
            self.len += 1;
        }
    }
}

/// A side of the view volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// Inside is Z ≥ near: at or beyond the near plane.
    Near,
    /// Inside is x ≥ −2047.5 pixels on the screen.
    Left,
    /// Inside is x ≤ 2047.5 pixels on the screen.
    Right,
    /// Inside is y ≥ −2047.5 pixels on the screen.
    Top,
    /// Inside is y ≤ 2047.5 pixels on the screen.
    Bottom,
}

impl Plane {
    /// All planes, in the order of clipping.
    pub const ALL: [Self; 5] = [Self::Near, Self::Left, Self::Right, Self::Top, Self::Bottom];

    /// The exact signed distance of a vertex from the plane, times a positive factor that depends on the plane only;
    /// negative is outside.
    pub fn distance(self, frame: &MeshSetup, vertex: &CameraVertex) -> i64 {
        let [width, height] = [frame.width, frame.height].map(i64::from);
        match self {
            Self::Near => vertex.z - frame.near,
            Self::Left => (4095 + width) * vertex.z + half_pixels(frame, vertex.x),
            Self::Right => (4095 - width) * vertex.z - half_pixels(frame, vertex.x),
            Self::Top => (4095 + height) * vertex.z + half_pixels(frame, vertex.y),
            Self::Bottom => (4095 - height) * vertex.z - half_pixels(frame, vertex.y),
        }
    }

    /// Writes the part of `polygon` that is inside the plane to `left`. Returns false without writing if the whole
    /// polygon is inside.
    fn cut(self, frame: &MeshSetup, polygon: &Polygon, left: &mut Polygon) -> bool {
        let vertices = polygon.vertices();
        let Some(mut from) = vertices.last() else {
            return false;
        };
        if vertices
            .iter()
            .all(|vertex| self.distance(frame, vertex) >= 0)
        {
            return false;
        }
        left.len = 0;
        let mut from_distance = self.distance(frame, from);
        for to in vertices {
            let to_distance = self.distance(frame, to);
            match (from_distance >= 0, to_distance >= 0) {
                (true, true) => left.push(*to),
                (true, false) => {
                    left.push(self.intersection(frame, from, from_distance, to, to_distance));
                }
                (false, true) => {
                    left.push(self.intersection(frame, to, to_distance, from, from_distance));
                    left.push(*to);
                }
                (false, false) => {}
            }
            (from, from_distance) = (to, to_distance);
        }
        true
    }

    /// The intersection of the plane with the edge from the vertex `a` inside, at distance `da`, to the vertex `b`
    /// outside, at distance `db`.
    fn intersection(
        self,
        frame: &MeshSetup,
        a: &CameraVertex,
        da: i64,
        b: &CameraVertex,
        db: i64,
    ) -> CameraVertex {
        let (part, whole) = (da.unsigned_abs(), da.abs_diff(db));
        let between = |a: i64, b: i64| a + portion(b - a, part, whole);
        CameraVertex {
            x: between(a.x, b.x),
            y: between(a.y, b.y),
            z: if self == Self::Near {
                frame.near
            } else {
                between(a.z, b.z)
            },
            light: a
                .light
                .zip_with(b.light, |a, b| between(a.into(), b.into()) as u16),
        }
    }
}

/// Converts the camera coordinate X or Y of a vertex to half pixels at distance 1, with the fraction bits of Z. The result
/// is below 2^58.7. `Plane::distance` adds multiples of Z to it, at most 5375·|Z|, which is below 2^53.1.
fn half_pixels(frame: &MeshSetup, x: i64) -> i64 {
    x << (24 - frame.scale_shift)
}

/// Whether a triangle lies wholly beyond one side of the picture. The plane through this side and the eye separates it
/// from the picture, so the test also holds for vertices behind the eye.
///
/// Such a triangle is left out by this fast test instead of clipping, after which it would cover no pixel.
pub fn off_picture(frame: &MeshSetup, triangle: &[CameraVertex; 3]) -> bool {
    let off = |x: fn(&CameraVertex) -> i64, size: u32| {
        let places = triangle
            .each_ref()
            .map(|v| (half_pixels(frame, x(v)), i64::from(size) * v.z));
        places.iter().all(|(x, border)| *x < -border) || places.iter().all(|(x, border)| x > border)
    };
    off(|v| v.x, frame.width) || off(|v| v.y, frame.height)
}

/// Clips a triangle to the view volume, starting with its first vertex.
pub fn clip(frame: &MeshSetup, triangle: [CameraVertex; 3]) -> Polygon {
    let (mut polygon, mut left) = (Polygon::empty(), Polygon::empty());
    triangle.into_iter().for_each(|vertex| polygon.push(vertex));
    for plane in Plane::ALL {
        if plane.cut(frame, &polygon, &mut left) {
            core::mem::swap(&mut polygon, &mut left);
        }
    }
    polygon
}

/// Computes x·part/whole to nearest, ties up, for part ≤ whole < 2^61 and whole > 0.
///
/// Long division: the product may have 100 bits, but the quotient is at most x.
fn portion(x: i64, part: u64, whole: u64) -> i64 {
    let size = x.unsigned_abs();
    let (mut quotient, mut rest) = (0i64, 0u64);
    for bit in (0..u64::BITS - size.leading_zeros()).rev() {
        quotient *= 2;
        rest = 2 * rest + part * (size >> bit & 1);
        // rest < 2·whole + part ≤ 3·whole
        while rest >= whole {
            rest -= whole;
            quotient += 1;
        }
    }
    if x < 0 {
        -quotient - i64::from(2 * rest > whole)
    } else {
        quotient + i64::from(2 * rest >= whole)
    }
}

#[cfg(test)]
mod tests {
    use super::portion;

    #[test]
    fn portions_are_nearest_with_ties_up() {
        let mut state = 1u64;
        let mut random = |bits: u32| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            state >> (64 - bits)
        };
        for round in 0..200_000u32 {
            // Half of the rounds use small numbers, for which many quotients are ties.
            let (wide, long) = if round % 2 == 0 { (4, 5) } else { (61, 44) };
            let whole = random(wide) + 1;
            let part = random(wide) % (whole + 1);
            let x = random(long) as i64 - (1 << (long - 1));
            let twice = 2 * i128::from(x) * i128::from(part) + i128::from(whole);
            let expected = twice.div_euclid(2 * i128::from(whole));
            assert_eq!(
                i128::from(portion(x, part, whole)),
                expected,
                "{x}·{part}/{whole}"
            );
        }
        assert_eq!(portion(0, 0, 1), 0);
        assert_eq!(
            portion(-(1 << 44), (1 << 61) - 1, (1 << 61) - 1),
            -(1 << 44)
        );
    }
}
