//! Writers of OBJ, binary STL and binary PLY.

use crate::polygons::{Polygons, Rgb8};
use crate::triangulate;
use std::io::{self, Write};

/// Writes an OBJ with point colours after the coordinates. Face colours, which would need a material file, are omitted.
///
/// # Errors
/// Writing to `out` fails.
pub fn obj(polygons: &Polygons, out: &mut impl Write) -> io::Result<()> {
    for (i, [x, y, z]) in polygons.points.iter().enumerate() {
        write!(out, "v {x} {y} {z}")?;
        if let Some(Rgb8(rgb)) = polygons.point_colours.get(i) {
            let [r, g, b] = rgb.map(|c| f64::from(c) / 255.0);
            write!(out, " {r:.4} {g:.4} {b:.4}")?;
        }
        writeln!(out)?;
    }
    for face in &polygons.faces {
        write!(out, "f")?;
        for corner in polygons.corners_of(face) {
            write!(out, " {}", corner.point + 1)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Writes a binary STL with face colours in the attribute word (VisCAM).
///
/// # Errors
/// Writing to `out` fails.
pub fn stl(polygons: &Polygons, out: &mut impl Write) -> io::Result<()> {
    let mut header = [0; 80];
    header[..5].copy_from_slice(b"glint");
    out.write_all(&header)?;
    out.write_all(&(polygons.triangle_count() as u32).to_le_bytes())?;
    let mut scratch = triangulate::Scratch::default();
    for face in &polygons.faces {
        let attribute = face.colour.map_or(0, |Rgb8(rgb)| {
            let [r, g, b] = rgb.map(|c| (u16::from(c) * 31 + 127) / 255);
            0x8000 | r << 10 | g << 5 | b
        });
        for triangle in triangulate::face(polygons, face, &mut scratch) {
            let points = triangle.map(|corner| polygons.point(corner));
            let normal = triangulate::unit(triangulate::area_vector(points)).unwrap_or_default();
            for vector in std::iter::once(normal).chain(points) {
                for c in vector {
                    out.write_all(&(c as f32).to_le_bytes())?;
                }
            }
            out.write_all(&attribute.to_le_bytes())?;
        }
    }
    Ok(())
}

/// Writes a binary PLY, little-endian, with the colours of points and faces.
///
/// # Errors
/// Writing to `out` fails.
pub fn ply(polygons: &Polygons, out: &mut impl Write) -> io::Result<()> {
    const COLOUR: &str = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let with_faces = polygons.faces.iter().any(|face| face.colour.is_some());
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n",
        polygons.points.len()
    )?;
    write!(
        out,
        "property double x\nproperty double y\nproperty double z\n"
    )?;
    write!(
        out,
        "{}",
        if polygons.point_colours.is_empty() {
            ""
        } else {
            COLOUR
        }
    )?;
    write!(
        out,
        "element face {}\nproperty list ushort uint vertex_indices\n",
        polygons.faces.len()
    )?;
    writeln!(out, "{}end_header", if with_faces { COLOUR } else { "" })?;
    for (i, point) in polygons.points.iter().enumerate() {
        for c in point {
            out.write_all(&c.to_le_bytes())?;
        }
        if let Some(Rgb8(rgb)) = polygons.point_colours.get(i) {
            out.write_all(rgb)?;
        }
    }
    for face in &polygons.faces {
        // The count of corners has 16 bits, which suffice for MAX_POLYGON.
        out.write_all(&(face.count as u16).to_le_bytes())?;
        for corner in polygons.corners_of(face) {
            out.write_all(&corner.point.to_le_bytes())?;
        }
        if with_faces {
            out.write_all(&face.colour.unwrap_or(Rgb8::DEFAULT).0)?;
        }
    }
    Ok(())
}
