//! The visible surface of each pixel of a scene with exact vertices, and the pixels where snapping the vertices to the subpixel
//! grid may change the result.
//!
//! The classes of pixels follow the rasterization checks of the Khronos conformance tests (dEQP). A pixel whose centre is inside
//! a triangle by at least the tolerance must be drawn. A pixel whose centre is outside by at least the tolerance must not be
//! drawn. For a pixel in between, both results are correct.

use crate::camera::{Camera, Size, Vector, cross, dot, subtract};

/// Position of a pixel's centre relative to a triangle, with a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Inside the triangle by at least the tolerance: the pixel must be drawn.
    Full,
    /// Closer to an edge than the tolerance: the pixel may be drawn.
    Partial,
    /// Outside the triangle by at least the tolerance: the pixel must not be drawn.
    None,
}

/// A triangle clipped and projected in f64.
#[derive(Clone, Debug)]
pub struct ProjectedTriangle {
    /// Corners, in pixels, of the triangle's part beyond the near plane; empty without such a part.
    pub corners: Vec<[f64; 2]>,
    /// Lines through the edges, each as (a, b, c): the distance of the point (x, y) to the edge is a·x + b·y + c in pixels,
    /// positive inside the triangle.
    edges: Vec<Vector>,
    /// Plane of the inverse depth: 1/z = plane · (x, y, 1), with x and y in pixels and z in world units.
    inverse_depth: Vector,
    /// Whether the front face is visible: the vertices are counter-clockwise on the screen.
    pub front: bool,
}

impl ProjectedTriangle {
    /// Clips and projects a triangle given by its vertices in world coordinates.
    pub fn new(camera: &Camera, size: Size, triangle: [Vector; 3]) -> Self {
        let points = triangle.map(|point| camera.coordinates(point));
        let normal = cross(
            subtract(points[1], points[0]),
            subtract(points[2], points[0]),
        );
        let offset = dot(normal, points[0]);
        let corners: Vec<_> = camera
            .clip_near(&points)
            .iter()
            .map(|&point| camera.screen(point, size))
            .collect();
        // With the picture's centre (cx, cy) and s pixels per unit, the ray through a point (x, y) of the screen has the direction ((x
        // − cx)/s, (y − cy)/s, 1). At depth z the ray intersects the triangle's plane: normal · (z · direction) = offset.
        let scale = camera.pixels_per_unit(size);
        let [a, b] = [normal[0] / scale, normal[1] / scale];
        let c = normal[2] - a * f64::from(size.width) / 2.0 - b * f64::from(size.height) / 2.0;
        let front = offset < 0.0;
        let inverse_depth = if offset == 0.0 {
            // The triangle is edge-on: its depth is not a function of the screen position.
            [0.0, 0.0, f64::INFINITY]
        } else {
            [a / offset, b / offset, c / offset]
        };
        Self {
            edges: inward_edges(&corners, front),
            corners,
            inverse_depth,
            front,
        }
    }

    /// Moves the triangle on the screen by (x, y) pixels, with its depths.
    #[must_use]
    pub fn moved(mut self, [x, y]: [f64; 2]) -> Self {
        for corner in &mut self.corners {
            *corner = [corner[0] + x, corner[1] + y];
        }
        self.edges = inward_edges(&self.corners, self.front);
        let [a, b, c] = self.inverse_depth;
        self.inverse_depth[2] = c - a * x - b * y;
        self
    }

    /// Returns the class of the pixel in `column` and `row`, for a tolerance in pixels.
    pub fn classify(&self, column: u32, row: u32, tolerance: f64) -> Class {
        if self.corners.is_empty() {
            return Class::None;
        }
        let here = centre(column, row);
        // Fewer than three edges enclose no area, so no pixel centre can be inside.
        let most = if self.edges.len() < 3 {
            0.0
        } else {
            f64::INFINITY
        };
        let inside = self
            .edges
            .iter()
            .map(|&edge| dot(edge, here))
            .fold(most, f64::min);
        if inside >= tolerance {
            Class::Full
        } else if inside > -tolerance {
            Class::Partial
        } else {
            Class::None
        }
    }

    /// Returns 1/z of the triangle's plane at the centre of a pixel, where z is the depth in world units. The result is infinite
    /// if the triangle is edge-on.
    pub fn inverse_depth(&self, column: u32, row: u32) -> f64 {
        dot(self.inverse_depth, centre(column, row))
    }

    /// Returns the largest slope of 1/z over all directions on the screen, per pixel.
    pub fn inverse_depth_slope(&self) -> f64 {
        self.inverse_depth[0].hypot(self.inverse_depth[1])
    }

    /// Returns the ranges of columns and rows of all pixels with centres inside the triangle or within a pixel of it.
    pub fn bounds(&self, size: Size) -> [std::ops::Range<u32>; 2] {
        let range = |axis: usize, limit: u32| {
            let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
            for corner in &self.corners {
                first = first.min(corner[axis]);
                last = last.max(corner[axis]);
            }
            let cut = |value: f64| value.clamp(0.0, f64::from(limit)) as u32;
            cut(first - 2.0)..cut(last + 2.0)
        };
        [range(0, size.width), range(1, size.height)]
    }
}

/// Length in pixels below which an edge is dropped, because its direction is unreliable. A dropped edge enlarges the polygon only
/// where the polygon is about as narrow as this length.
const SHORTEST_EDGE: f64 = 1e-6;

/// Returns the edges of a convex polygon as lines whose normals point inwards. A front face is counter-clockwise on the screen,
/// where y points down, so its signed area is negative.
fn inward_edges(corners: &[[f64; 2]], front: bool) -> Vec<Vector> {
    let sign = if front { -1.0 } else { 1.0 };
    let mut edges = Vec::with_capacity(corners.len());
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        if length > SHORTEST_EDGE {
            let (nx, ny) = (-dy / length * sign, dx / length * sign);
            edges.push([nx, ny, -(nx * a[0] + ny * a[1])]);
        }
    }
    edges
}

fn centre(column: u32, row: u32) -> Vector {
    [f64::from(column) + 0.5, f64::from(row) + 0.5, 1.0]
}

/// The visible surface of a pixel, if it does not depend on the snapping of vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Visible {
    /// No surface, independent of the snapping of the vertices.
    Background,
    /// A triangle, independent of the snapping of the vertices.
    Surface {
        /// Index of the triangle in the scene's list of triangles.
        triangle: usize,
        /// Value of 1/z at the pixel's centre, where z is the depth in world units.
        inverse_depth: f64,
        /// The largest slope of 1/z on the triangle, per pixel.
        slope: f64,
    },
    /// The visible surface depends on the snapping of vertices or the rounding of depths.
    Unstable,
}

/// Allowed deviation from the exact scene.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Largest displacement of an edge, in pixels.
    pub pixels: f64,
    /// Largest error of a depth, in units of 1/z.
    pub inverse_depth: f64,
}

/// Computes the visible surface of each pixel of a picture, row by row.
///
/// `cull` removes back faces. A pixel near an edge of a back face can still be unstable, because snapping can turn a very thin back face
/// into a front face.
pub fn visible_surfaces(
    camera: &Camera,
    size: Size,
    triangles: &[[Vector; 3]],
    cull: bool,
    tolerance: Tolerance,
) -> Vec<Visible> {
    let width = size.width as usize;
    let mut pixels = vec![Candidates::default(); width * size.height as usize];
    for (index, &triangle) in triangles.iter().enumerate() {
        let projected = ProjectedTriangle::new(camera, size, triangle);
        let hidden = cull && !projected.front;
        let slope = projected.inverse_depth_slope();
        let spread = tolerance.inverse_depth + slope * tolerance.pixels;
        let [columns, rows] = projected.bounds(size);
        for row in rows {
            for column in columns.clone() {
                let class = projected.classify(column, row, tolerance.pixels);
                let pixel = &mut pixels[row as usize * width + column as usize];
                let inverse_depth = projected.inverse_depth(column, row);
                match class {
                    Class::Full if hidden => {}
                    Class::Full => pixel.add(index, inverse_depth, slope, spread),
                    Class::Partial => pixel.rival = pixel.rival.max(inverse_depth + spread),
                    Class::None => {}
                }
            }
        }
    }
    pixels.iter().map(Candidates::decide).collect()
}

/// The nearest surface of a pixel so far (index of the triangle, its 1/z at the pixel, the largest slope of its 1/z, and the
/// largest error of its 1/z), and the largest 1/z that any other surface may have there.
#[derive(Clone)]
struct Candidates {
    nearest: Option<(usize, f64, f64, f64)>,
    rival: f64,
}

impl Default for Candidates {
    fn default() -> Self {
        Self {
            nearest: None,
            rival: f64::NEG_INFINITY,
        }
    }
}

impl Candidates {
    fn add(&mut self, triangle: usize, inverse_depth: f64, slope: f64, spread: f64) {
        let candidate = (triangle, inverse_depth, slope, spread);
        let loser = match self.nearest {
            Some(nearest) if nearest.1 >= inverse_depth => Some(candidate),
            displaced => {
                self.nearest = Some(candidate);
                displaced
            }
        };
        if let Some((_, inverse_depth, _, spread)) = loser {
            self.rival = self.rival.max(inverse_depth + spread);
        }
    }

    fn decide(&self) -> Visible {
        match self.nearest {
            None if self.rival == f64::NEG_INFINITY => Visible::Background,
            Some((triangle, inverse_depth, slope, spread))
                if self.rival < inverse_depth - spread =>
            {
                Visible::Surface {
                    triangle,
                    inverse_depth,
                    slope,
                }
            }
            _ => Visible::Unstable,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        eye: [0.0, 0.0, -2.0],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 1.0, 0.0],
        n: [0.0, 0.0, 1.0],
        half_width: 1.0,
        near: 0.5,
    };
    const SIZE: Size = Size {
        width: 16,
        height: 16,
    };
    const TOLERANCE: Tolerance = Tolerance {
        pixels: 3.0 / 256.0,
        inverse_depth: 1e-5,
    };

    /// Returns a front face in the plane at `z`. The face covers the left half of the picture and extends beyond the border.
    fn half(z: f64) -> [Vector; 3] {
        [[0.0, 9.0, z], [0.0, -9.0, z], [-9.0, 0.0, z]]
    }

    #[test]
    fn classes_change_at_the_tolerance() {
        let triangle = ProjectedTriangle::new(&CAMERA, SIZE, half(0.0));
        assert!(triangle.front);
        assert_eq!(triangle.classify(7, 8, 0.25), Class::Full);
        assert_eq!(triangle.classify(7, 8, 0.75), Class::Partial);
        assert_eq!(triangle.classify(8, 8, 0.75), Class::Partial);
        assert_eq!(triangle.classify(8, 8, 0.25), Class::None);
    }

    #[test]
    fn the_nearer_surface_shows_and_depth_is_its_plane() {
        let seen = visible_surfaces(&CAMERA, SIZE, &[half(1.0), half(0.0)], true, TOLERANCE);
        assert_eq!(
            seen[8 * 16 + 3],
            Visible::Surface {
                triangle: 1,
                inverse_depth: 0.5,
                slope: 0.0
            }
        );
        assert_eq!(seen[8 * 16 + 12], Visible::Background);
    }

    #[test]
    fn coplanar_surfaces_and_near_edges_are_unstable() {
        let seen = visible_surfaces(&CAMERA, SIZE, &[half(0.0), half(0.0)], true, TOLERANCE);
        assert_eq!(seen[8 * 16 + 3], Visible::Unstable);
        let shifted = half(0.0).map(|[x, y, z]| [x + 0.125, y, z]);
        let seen = visible_surfaces(&CAMERA, SIZE, &[shifted], true, TOLERANCE);
        assert_eq!(seen[8 * 16 + 8], Visible::Unstable);
    }

    #[test]
    fn back_faces_are_culled() {
        let [a, b, c] = half(0.0);
        let seen = visible_surfaces(&CAMERA, SIZE, &[[a, c, b]], true, TOLERANCE);
        assert!(seen.iter().all(|pixel| *pixel == Visible::Background));
    }

    #[test]
    fn seen_edge_on_a_triangle_is_uncertain_along_its_line() {
        let edge_on =
            [[0.0, 0.5, 0.0], [0.0, 0.5, 1.0], [1.0, 0.5, 0.0]].map(|[x, y, z]| [x, y - 0.5, z]);
        let triangle = ProjectedTriangle::new(&CAMERA, SIZE, edge_on);
        assert_eq!(triangle.classify(9, 7, 0.75), Class::Partial);
        assert_eq!(triangle.classify(9, 7, 0.25), Class::None);
        let line_through_centres = edge_on.map(|[x, y, z]| [x, y + (z + 2.0) / 16.0, z]);
        let seen = visible_surfaces(&CAMERA, SIZE, &[line_through_centres], false, TOLERANCE);
        assert_eq!(seen[8 * 16 + 9], Visible::Unstable);
        assert_eq!(seen[3 * 16 + 9], Visible::Background);
    }
}
