//! Conversion of Glint's own mesh format GLM to polygons.

use crate::error::{FormatError, Location};
use crate::polygons::{Content, Corner, MAX_TEXTURES, Polygons, Rgb8, Texture};
use glint_core::mesh::{Attribute, Mesh, MeshHeader, checksum, stated_checksum};
use glint_core::records::TextureCoordinates;

/// Parses a GLM. Positions, normals, texture coordinates and colours of vertices are converted
/// exactly, colours of triangles by bit replication. The chunks of the mesh are merged. Textures
/// remain in the board's memory layout.
///
/// # Errors
/// As for [`check_file`], or the mesh has no triangles.
pub fn parse(bytes: &[u8]) -> Result<Polygons, FormatError> {
    let mesh = check_file(bytes)?;
    let world = |q: [i16; 3]| q.map(|c| f64::from(c) / 16384.0);
    let mut polygons = Polygons::default();
    // The normals may be averages of face normals.
    polygons.is_smooth = Some(false);
    for (number, texture) in (1..=MAX_TEXTURES).zip(mesh.textures()) {
        polygons.add_texture(Texture {
            name: number.to_string(),
            content: Content::Board(texture.bytes().to_vec()),
            sampler: texture.sampler(),
            cutoff: None,
            opacity: None,
        })?;
    }
    let coordinates = mesh.attribute(Attribute::TextureCoordinates);
    for element in coordinates.unwrap_or_default().as_chunks().0 {
        let TextureCoordinates { s, t } = TextureCoordinates::from_bytes(element);
        let coordinates = [s, t].map(|c| f64::from(c) / 65536.0);
        polygons.add_coordinates(coordinates, Location::Whole)?;
    }
    for chunk in mesh.chunks() {
        let first = polygons.points.len() as u32;
        for vertex in chunk.vertices() {
            polygons.add_point(world(vertex.position), Location::Whole)?;
            polygons.add_normal(world(vertex.normal), Location::Whole)?;
            polygons.point_colours.push(Rgb8(vertex.rgb888()));
        }
        for triangle in chunk.triangles() {
            let corner = |index| {
                let vertex = first + u32::from(index);
                Corner {
                    point: vertex,
                    normal: vertex,
                    coordinates: coordinates.map_or(Corner::NO_COORDINATES, |_| vertex),
                }
            };
            polygons.add_face(
                &triangle.indices.map(corner),
                Some(Rgb8(triangle.colour.to_rgb888())),
                Location::Whole,
            )?;
            if let Some(face) = polygons.faces.last_mut() {
                face.texture = triangle.texture;
            }
        }
    }
    polygons.finish()?;
    Ok(polygons)
}

/// First four bytes of the previous version of the format, which has no checksum.
const WITHOUT_CHECKSUM: &[u8] = b"GLM1";

/// Checks the bytes of a file, including its checksum, and returns them as a mesh.
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
            glint_core::deviation::Expected::Magic(_) => {
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
