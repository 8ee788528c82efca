//! PLY (the Stanford polygon format), ASCII and binary of both byte orders.
//!
//! This parser replaces `ply-rs` and `ply-rs-bw`, which need 2 GB for a header of 70 bytes that declares 30 million elements without
//! properties, and whose errors in binary files have no offset.

mod header;
mod source;

use super::text::{Lines, checked};
use crate::error::{FormatError, Location, MAX_COORDINATE, MAX_POLYGON, quote};
use crate::polygons::{Corner, Polygons, Rgb8};
use header::{Element, Encoding, Header, Kind, Property, Scalar};
use source::{AsciiSource, BinarySource, Source};

/// Parses a PLY: the elements `vertex` (x y z, optionally nx ny nz and red green blue) and `face` (vertex_indices or
/// vertex_index, optionally red green blue); other elements are skipped.
///
/// # Errors
/// The first violation of the format, with its line (header, ASCII) or offset (binary).
pub fn parse(file: &[u8]) -> Result<Polygons, FormatError> {
    let mut lines = Lines::new(file);
    let header = Header::parse(&mut lines)?;
    let mut polygons = match header.encoding {
        Encoding::Ascii => read_body(&header, AsciiSource::new(lines))?,
        Encoding::LittleEndian | Encoding::BigEndian => {
            let offset = file.len() - lines.rest().len();
            let big_endian = header.encoding == Encoding::BigEndian;
            read_body(&header, BinarySource::new(file, offset, big_endian))?
        }
    };
    polygons.check_indices()?;
    for remark in header.remarks {
        polygons.remark(remark);
    }
    Ok(polygons)
}

fn read_body(header: &Header, mut source: impl Source) -> Result<Polygons, FormatError> {
    let mut polygons = Polygons::default();
    for element in &header.elements {
        // An element without properties takes no bytes in the file, for any count.
        if element.properties.is_empty() {
            continue;
        }
        match element.name.as_slice() {
            b"vertex" => read_vertices(element, &mut source, &mut polygons)?,
            b"face" => read_faces(element, &mut source, &mut polygons)?,
            _ => skip(element, &mut source)?,
        }
    }
    Ok(polygons)
}

fn skip(element: &Element, source: &mut impl Source) -> Result<(), FormatError> {
    for _ in 0..element.count {
        source.start()?;
        for property in &element.properties {
            skip_property(property, source)?;
        }
        source.end()?;
    }
    Ok(())
}

fn skip_property(property: &Property, source: &mut impl Source) -> Result<(), FormatError> {
    match property.kind {
        Kind::Scalar(scalar) => source.value(scalar).map(drop),
        Kind::List { count, item } => {
            for _ in 0..list_length(count, source)? {
                source.value(item)?;
            }
            Ok(())
        }
    }
}

fn list_length(count: Scalar, source: &mut impl Source) -> Result<u64, FormatError> {
    let place = source.place();
    let length = source.value(count)?;
    if length < 0.0 {
        return Err(FormatError::new(
            place,
            "a list's length",
            format!("{length}"),
        ));
    }
    Ok(length as u64)
}

/// The coordinate or colour channel that a scalar property sets.
#[derive(Clone, Copy)]
enum Slot {
    Position(usize),
    Normal(usize),
    /// Number of the channel, and the value of full intensity in the property's type.
    Colour(usize, f64),
    None,
}

impl Slot {
    fn of(property: &Property) -> Self {
        let Kind::Scalar(scalar) = property.kind else {
            return Self::None;
        };
        match property.name.as_slice() {
            b"x" => Self::Position(0),
            b"y" => Self::Position(1),
            b"z" => Self::Position(2),
            b"nx" => Self::Normal(0),
            b"ny" => Self::Normal(1),
            b"nz" => Self::Normal(2),
            b"red" | b"r" | b"diffuse_red" => Self::Colour(0, scalar.full_scale()),
            b"green" | b"g" | b"diffuse_green" => Self::Colour(1, scalar.full_scale()),
            b"blue" | b"b" | b"diffuse_blue" => Self::Colour(2, scalar.full_scale()),
            _ => Self::None,
        }
    }
}

/// Whether the properties of an element set x, y and z, or red, green and blue, as selected by `kind`.
fn has_all(slots: &[Slot], kind: impl Fn(&Slot) -> Option<usize>) -> bool {
    (0..3).all(|i| slots.iter().any(|slot| kind(slot) == Some(i)))
}

fn has_colour(slots: &[Slot]) -> bool {
    has_all(slots, |slot| {
        if let Slot::Colour(i, _) = slot {
            Some(*i)
        } else {
            None
        }
    })
}

fn coordinate(value: f64, place: Location) -> Result<f64, FormatError> {
    checked(value).ok_or_else(|| {
        FormatError::new(
            place,
            format!("a number within ±{MAX_COORDINATE:e}"),
            format!("{value:e}"),
        )
    })
}

/// Adds a remark for each list of an element that is skipped.
fn remark_lists(element: &Element, used: impl Fn(&Property) -> bool, polygons: &mut Polygons) {
    for property in &element.properties {
        if matches!(property.kind, Kind::List { .. }) && !used(property) {
            let [list, of] = [&property.name, &element.name].map(|name| quote(name));
            polygons.remark(format!("the list {list} of {of} is skipped"));
        }
    }
}

fn read_vertices(
    element: &Element,
    source: &mut impl Source,
    polygons: &mut Polygons,
) -> Result<(), FormatError> {
    let slots: Vec<Slot> = element.properties.iter().map(Slot::of).collect();
    remark_lists(element, |_| false, polygons);
    if !has_all(&slots, |slot| {
        if let Slot::Position(i) = slot {
            Some(*i)
        } else {
            None
        }
    }) {
        return Err(FormatError::new(
            element.place,
            "the properties x, y and z of vertex",
            "not all of them",
        ));
    }
    let with_normal = has_all(&slots, |slot| {
        if let Slot::Normal(i) = slot {
            Some(*i)
        } else {
            None
        }
    });
    let with_colour = has_colour(&slots);
    for _ in 0..element.count {
        source.start()?;
        let start = source.place();
        let (mut point, mut normal, mut colour) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for (property, slot) in element.properties.iter().zip(&slots) {
            let Kind::Scalar(scalar) = property.kind else {
                skip_property(property, source)?;
                continue;
            };
            let place = source.place();
            let value = source.value(scalar)?;
            match *slot {
                Slot::Position(i) => point[i] = coordinate(value, place)?,
                Slot::Normal(i) => normal[i] = value,
                Slot::Colour(i, full) => colour[i] = value / full,
                Slot::None => {}
            }
        }
        source.end()?;
        polygons.add_point(point, start)?;
        if with_normal {
            polygons.add_normal(normal, start)?;
        }
        if with_colour {
            polygons.point_colours.push(Rgb8::from_unit(colour));
        }
    }
    Ok(())
}

fn read_faces(
    element: &Element,
    source: &mut impl Source,
    polygons: &mut Polygons,
) -> Result<(), FormatError> {
    let slots: Vec<Slot> = element.properties.iter().map(Slot::of).collect();
    let is_indices = |property: &Property| {
        matches!(property.kind, Kind::List { .. })
            && matches!(
                property.name.as_slice(),
                b"vertex_indices" | b"vertex_index"
            )
    };
    if !element.properties.iter().any(is_indices) {
        return Err(FormatError::new(
            element.place,
            "the list vertex_indices or vertex_index of face",
            "none",
        ));
    }
    remark_lists(element, is_indices, polygons);
    let with_colour = has_colour(&slots);
    // Faces use the normals of the vertices only if the vertices come first, as in every known file.
    let with_normal = !polygons.normals.is_empty();
    let mut corners = Vec::new();
    for _ in 0..element.count {
        source.start()?;
        let start = source.place();
        let mut colour = [0.0; 3];
        corners.clear();
        for (property, slot) in element.properties.iter().zip(&slots) {
            match property.kind {
                Kind::List { count, item } if is_indices(property) => {
                    read_corners(count, item, with_normal, source, &mut corners)?;
                }
                Kind::List { .. } => skip_property(property, source)?,
                Kind::Scalar(scalar) => {
                    let value = source.value(scalar)?;
                    if let Slot::Colour(i, full) = *slot {
                        colour[i] = value / full;
                    }
                }
            }
        }
        source.end()?;
        polygons.add_face(
            &corners,
            with_colour.then(|| Rgb8::from_unit(colour)),
            start,
        )?;
    }
    Ok(())
}

fn read_corners(
    count: Scalar,
    item: Scalar,
    with_normal: bool,
    source: &mut impl Source,
    corners: &mut Vec<Corner>,
) -> Result<(), FormatError> {
    let place = source.place();
    let length = list_length(count, source)?;
    if length > MAX_POLYGON as u64 {
        let expected = format!("a face of 3 to {MAX_POLYGON} corners");
        return Err(FormatError::new(place, expected, format!("{length}")));
    }
    corners.clear();
    for _ in 0..length {
        let place = source.place();
        let index = source.value(item)?;
        if !(0.0..f64::from(Corner::NO_NORMAL)).contains(&index) || index.fract() != 0.0 {
            return Err(FormatError::new(
                place,
                "an index (0, 1, …)",
                format!("{index}"),
            ));
        }
        let point = index as u32;
        corners.push(Corner {
            normal: if with_normal {
                point
            } else {
                Corner::NO_NORMAL
            },
            ..Corner::at(point)
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASCII: &str = "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement other 1\nproperty list uchar int a\nproperty int b\nelement nothing 4000000000\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n\n0 1 0 1 2 3\n2 7 8 9\n4 0 1 2 3\n3 2 1 0\n";

    #[test]
    fn ascii() {
        let polygons = parse(ASCII.as_bytes()).unwrap();
        assert_eq!(polygons.points[3], [0.0, 1.0, 0.0]);
        assert_eq!(polygons.point_colours[3], Rgb8([1, 2, 3]));
        assert_eq!(
            polygons.faces.iter().map(|f| f.count).collect::<Vec<_>>(),
            [4, 3]
        );
    }

    fn binary(order: &str, swap: bool, index: i32) -> Vec<u8> {
        let mut file = format!(
            "ply\r\nformat binary_{order}_endian 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty double y\r\nproperty short z\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\nelement face 1\r\nproperty ushort red\r\nproperty ushort green\r\nproperty ushort blue\r\nproperty list ushort int vertex_index\r\nend_header\r\n"
        )
        .into_bytes();
        let mut put = |bytes: &[u8]| {
            let mut bytes = bytes.to_vec();
            if swap {
                bytes.reverse();
            }
            file.extend(bytes);
        };
        for i in 0..3i16 {
            put(&f32::from(i).to_le_bytes());
            put(&f64::from(i * i).to_le_bytes());
            put(&(-i).to_le_bytes());
            [0.0f32, 0.0, f32::NAN]
                .iter()
                .for_each(|c| put(&c.to_le_bytes()));
        }
        [0, 65535, 32768u16, 3]
            .iter()
            .for_each(|c| put(&c.to_le_bytes()));
        [0, 1, index].iter().for_each(|i| put(&i.to_le_bytes()));
        file
    }

    #[test]
    fn both_byte_orders() {
        for (order, swap) in [("little", false), ("big", true)] {
            let polygons = parse(&binary(order, swap, 2)).unwrap();
            assert_eq!(polygons.points[2], [2.0, 4.0, -2.0]);
            assert_eq!(polygons.faces[0].colour, Some(Rgb8([0, 255, 128])));
            assert_eq!(
                polygons.corners[2],
                Corner {
                    normal: 2,
                    ..Corner::at(2)
                }
            );
            assert_eq!(polygons.normals[2], [0.0; 3]);
        }
    }

    #[test]
    fn normals_that_are_no_numbers() {
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 -nan(ind) 0 1\n1 0 0 1.#QNAN -1.#IND 0\n0 1 0 0 0 1\n3 0 1 2\n";
        let normals = parse(text.as_bytes()).unwrap().normals;
        assert_eq!(normals, [[0.0; 3], [0.0; 3], [0.0, 0.0, 1.0]]);
    }

    #[test]
    fn errors_name_their_place() {
        let good = binary("little", false, 2);
        let ascii = |from: &str, to: &str| ASCII.replace(from, to).into_bytes();
        let cases: [(Vec<u8>, &str); 14] = [
            (vec![], "line 1: expected ply, found the end of the file"),
            (b"plx\n".to_vec(), "line 1: expected ply, found 'plx'"),
            (
                b"ply\nformat ascii 1.0\n".to_vec(),
                "line 2: expected end_header, found the end of the file",
            ),
            (
                b"ply\nend_header\n".to_vec(),
                "line 2: expected a line format before end_header, found 'end_header'",
            ),
            (
                b"ply\nformat ascii 1.0\nend_header\n".to_vec(),
                "expected at least one face, found none",
            ),
            (
                ascii("element vertex 4", "element vertex 4294967296"),
                "line 4: expected a count of elements up to 2^32 - 1, found 'element vertex 4294967296'",
            ),
            (
                ascii("element vertex 4", "element vertex 4000000000"),
                "line 23: expected a uint8, found the end of the line",
            ),
            (
                ascii("1 1 0 0 0 255", "1 1 0 0 0 256"),
                "line 20: expected a uint8, found '256'",
            ),
            (
                ascii("1 1 0 0 0 255", "1 nan 0 0 0 255"),
                "line 20: expected a number within ±1e30, found NaN",
            ),
            (
                ascii("property double z", "property double w"),
                "line 4: expected the properties x, y and z of vertex, found not all of them",
            ),
            (
                ascii("3 2 1 0\n", "3 2 1 -1\n"),
                "line 25: expected an index (0, 1, …), found -1",
            ),
            (
                ascii("3 2 1 0\n", "3 2 1 4\n"),
                "line 25: expected a point index below 4, found 4 (counted from 0)",
            ),
            (
                good[..good.len() - 1].to_vec(),
                "byte 395: expected an int32, found the end of the file",
            ),
            (
                binary("little", false, -7),
                "byte 395: expected an index (0, 1, …), found -7",
            ),
        ];
        for (file, message) in cases {
            let found = parse(&file).unwrap_err().to_string();
            assert_eq!(found, message);
        }
    }
}
