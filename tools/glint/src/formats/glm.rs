//! Conversion of GLM, Glint's own mesh format, to polygons.

use crate::error::{FormatError, Place};
use crate::polygons::{Corner, Polygons, Rgb8};
use glint_core::mesh::{Mesh, Rgb565};

/// Parses a GLM. Positions and normals are converted exactly, colours by bit replication. The chunks of the mesh are joined.
///
/// # Errors
/// [`Mesh::new_checked`] rejects the mesh, or the mesh has no triangles.
pub fn parse(bytes: &[u8]) -> Result<Polygons, FormatError> {
    let mesh = check(bytes)?;
    let world = |q: [i16; 3]| q.map(|c| f64::from(c) / 16384.0);
    let rgb8 = |colour: Rgb565| Rgb8(colour.to_rgb888());
    let mut polygons = Polygons::default();
    for chunk in mesh.chunks() {
        let first = polygons.points.len() as u32;
        for vertex in chunk.vertices() {
            polygons.add_point(world(vertex.position), Place::Whole)?;
            polygons.add_normal(world(vertex.normal), Place::Whole)?;
            polygons.point_colours.push(rgb8(vertex.colour));
        }
        for triangle in chunk.triangles() {
            let corner = |index| Corner {
                point: first + u32::from(index),
                normal: first + u32::from(index),
            };
            polygons.add_face(
                &triangle.indices.map(corner),
                Some(rgb8(triangle.colour)),
                Place::Whole,
            )?;
        }
    }
    polygons.check_indices()?;
    Ok(polygons)
}

/// Checks a GLM, and returns it as a mesh.
///
/// # Errors
/// [`Mesh::new_checked`] rejects the mesh.
pub fn check(bytes: &[u8]) -> Result<Mesh<'_>, FormatError> {
    Mesh::new_checked(bytes).map_err(|error| {
        let found = match error.expected {
            glint_core::mesh::Expected::Magic => {
                format!("'{}'", error.found.to_le_bytes().escape_ascii())
            }
            _ => error.found.to_string(),
        };
        FormatError::new(
            Place::Byte(error.offset as usize),
            error.expected.to_string(),
            found,
        )
    })
}
