//! Cameras that show the whole of a model.

use crate::error::FormatError;
use crate::view;
use glint_core::camera::View;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::matrix::{Axis, Matrix};
use glint_core::mesh::Mesh;

/// Part of the picture's height that the sphere around the model takes.
const PART: f64 = 0.8;
/// Height of a picture divided by its width.
const ASPECT: f64 = 9.0 / 16.0;
/// Distance of the camera in radii of the sphere, without a given field of view.
const RADII: f64 = 3.5;
/// Least distance between the camera and the sphere: twice that of the near plane.
const LEAST_GAP: f64 = 0.2;
/// Largest distance of the eye from the origin, just below that which a mesh allows.
const FARTHEST: f64 = 7.9;
/// Azimuth and polar angle of the camera in degrees.
const ANGLES: [f64; 2] = [30.0, 60.0];

/// A sphere around all vertices of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The centre of the box around the vertices, in world units.
    pub centre: [f64; 3],
    /// Distance of the farthest vertex from the centre.
    pub radius: f64,
}

impl Sphere {
    /// The sphere around meshes at their places.
    pub fn around(meshes: &[(Mesh, Matrix)]) -> Self {
        let points = || {
            meshes.iter().flat_map(|(mesh, matrix)| {
                let chunks = mesh.chunks();
                chunks.flat_map(|chunk| {
                    chunk
                        .vertices()
                        .map(|vertex| placed(matrix, vertex.position))
                })
            })
        };
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in points() {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let centre = [0, 1, 2].map(|axis| (low[axis] + high[axis]) / 2.0);
        let distance = |point: [f64; 3]| {
            let squares = [0, 1, 2].map(|axis| (point[axis] - centre[axis]).powi(2));
            squares.iter().sum::<f64>().sqrt()
        };
        Self {
            centre,
            radius: points().map(distance).fold(0.0, f64::max),
        }
    }

    /// A camera in which the sphere takes 80 % of the picture's height, with `up` up on the screen and `turned` degrees farther around
    /// that axis than usual. With a horizontal field of view in degrees the distance follows from it; otherwise the field of view
    /// follows from a distance of 3.5 radii.
    ///
    /// # Errors
    /// The sphere is too far from the origin for a camera.
    pub fn framed(
        &self,
        up: Axis,
        turned: f64,
        field_of_view: Option<f64>,
    ) -> Result<View, FormatError> {
        let Self { centre, radius } = *self;
        let wanted = field_of_view.map_or(RADII * radius, |degrees| {
            let half_height = (degrees / 2.0).to_radians().tan() * ASPECT;
            radius * (1.0 + (PART * half_height).powi(-2)).sqrt()
        });
        let aside = centre.iter().map(|c| c * c).sum::<f64>().sqrt();
        let distance = wanted.max(radius + LEAST_GAP).min(FARTHEST - aside);
        let [azimuth, polar] = [ANGLES[0] + turned, ANGLES[1]].map(f64::to_radians);
        let back = turn(
            up,
            [
                polar.sin() * azimuth.cos(),
                polar.sin() * azimuth.sin(),
                polar.cos(),
            ],
        );
        let eye = [0, 1, 2].map(|axis| centre[axis] + distance * back[axis]);
        let text = [eye, back.map(|c| -c), turn(up, [0.0, 0.0, 1.0])];
        let text = text.as_flattened().iter().map(|c| format!("{c:.9}"));
        let view = view::look_at(&text.collect::<Vec<_>>().join(","))?;
        let half_height = radius / (distance.powi(2) - radius.powi(2)).max(1e-6).sqrt() / PART;
        let degrees = 2.0 * (half_height / ASPECT).atan().to_degrees();
        let degrees = field_of_view.unwrap_or(degrees).clamp(1.0, 179.0);
        let angle = Turns::from_degrees(Q32_32::from_num(degrees));
        view.with_field_of_view(angle).map_err(view::no_camera)
    }
}

/// The place of a vertex in the world.
fn placed(matrix: &Matrix, position: [i16; 3]) -> [f64; 3] {
    let point = position.map(|c| f64::from(c) / 16384.0);
    let (rows, place) = (matrix.linear(), matrix.place());
    [0, 1, 2].map(|i: usize| {
        let row = rows[i].map(|c| c.to_num::<f64>());
        row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + place[i].to_num::<f64>()
    })
}

/// A direction about z, about another axis instead.
fn turn(up: Axis, [a, b, c]: [f64; 3]) -> [f64; 3] {
    match up {
        Axis::X => [c, a, b],
        Axis::Y => [b, c, a],
        Axis::Z => [a, b, c],
    }
}
