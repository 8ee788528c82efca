//! Conversion of GLM, Glint's own mesh format, to polygons.

use crate::error::{FormatError, Location};
use crate::polygons::{Corner, Polygons, Rgb8};
use glint_core::mesh::{Mesh, MeshHeader, Rgb565, checksum, stated_checksum};

/// Parses a GLM. Positions and normals are converted exactly, colours by bit replication. The chunks of the mesh are merged.
///
/// # Errors
/// Those of [`check_file`], or the mesh has no triangles.
pub fn parse(bytes: &[u8]) -> Result<Polygons, FormatError> {
    let mesh = check_file(bytes)?;
    let world = |q: [i16; 3]| q.map(|c| f64::from(c) / 16384.0);
    let rgb8 = |colour: Rgb565| Rgb8(colour.to_rgb888());
    let mut polygons = Polygons::default();
    for chunk in mesh.chunks() {
        let first = polygons.points.len() as u32;
        for vertex in chunk.vertices() {
            polygons.add_point(world(vertex.position), Location::Whole)?;
            polygons.add_normal(world(vertex.normal), Location::Whole)?;
            polygons.point_colours.push(rgb8(vertex.colour));
        }
        for triangle in chunk.triangles() {
            let corner = |index| Corner {
                normal: first + u32::from(index),
                ..Corner::at(first + u32::from(index))
            };
            polygons.add_face(
                &triangle.indices.map(corner),
                Some(rgb8(triangle.colour)),
                Location::Whole,
            )?;
        }
    }
    polygons.finish()?;
    Ok(polygons)
}

/// First four bytes of the previous version of the format, which has no checksum.
const WITHOUT_CHECKSUM: &[u8] = b"GLM1";

/// Checks the bytes of a file with its checksum, and returns them as a mesh.
///
/// # Errors
/// The file has another version or a wrong checksum, or [`Mesh::new_checked`] rejects it.
pub fn check_file(bytes: &[u8]) -> Result<Mesh<'_>, FormatError> {
    if bytes.starts_with(WITHOUT_CHECKSUM) {
        let expected = "\"GLM2\", a mesh with a checksum";
        let found = "'GLM1', written by an earlier glint: convert the original file again";
        return Err(FormatError::new(Location::Byte(0), expected, found));
    }
    let mesh = check(bytes)?;
    let needed = checksum(bytes);
    match stated_checksum(bytes) {
        Some(stated) if stated == needed => Ok(mesh),
        stated => Err(FormatError::new(
            Location::Byte(MeshHeader::CHECKSUM.start),
            format!("the CRC-32 {needed:08x} of the other bytes"),
            format!("{:08x}: the file is damaged", stated.unwrap_or_default()),
        )),
    }
}

/// Checks the bytes of a mesh, except the checksum, and returns them as a mesh.
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
            Location::Byte(error.offset as usize),
            error.expected.to_string(),
            found,
        )
    })
}
