//! PLY (the Stanford polygon format), ASCII and binary of both byte orders.
//!
//! This parser replaces `ply-rs` and `ply-rs-bw`, which need 2 GB for a header of 70 bytes that declares 30 million elements without
//! properties, and whose errors in binary files have no offset.

mod header;
mod source;

use super::text::{Lines, finite};
use crate::error::{FormatError, Location, MAX_POLYGON, quote};
use crate::polygons::{Corner, Polygons, Rgb8};
use header::{Element, Encoding, Header, Kind, Property, Scalar};
use source::{AsciiSource, BinarySource, Source};

/// Parses a PLY: the elements `vertex` (x y z, optionally nx ny nz and red green blue), `face` (vertex_indices or vertex_index,
/// optionally red green blue) and `tristrips` (vertex_indices; -1 ends a strip); other elements are skipped.
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
    polygons.finish()?;
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
            b"tristrips" => read_strips(element, &mut source, &mut polygons)?,
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

/// The vector that a scalar property is a component of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Target {
    Position,
    Normal,
    Colour,
    None,
}

/// The component that a property sets.
struct Slot {
    target: Target,
    /// Index of the component in the vector.
    index: usize,
    /// The value that means full intensity, if the vector is a colour.
    full: f64,
}

impl Slot {
    fn of(property: &Property) -> Self {
        let (target, index) = match property.name.as_slice() {
            b"x" => (Target::Position, 0),
            b"y" => (Target::Position, 1),
            b"z" => (Target::Position, 2),
            b"nx" => (Target::Normal, 0),
            b"ny" => (Target::Normal, 1),
            b"nz" => (Target::Normal, 2),
            b"red" | b"r" | b"diffuse_red" => (Target::Colour, 0),
            b"green" | b"g" | b"diffuse_green" => (Target::Colour, 1),
            b"blue" | b"b" | b"diffuse_blue" => (Target::Colour, 2),
            _ => (Target::None, 0),
        };
        let (target, full) = match property.kind {
            Kind::Scalar(scalar) => (target, scalar.full_scale()),
            Kind::List { .. } => (Target::None, 1.0),
        };
        Self {
            target,
            index,
            full,
        }
    }
}

/// Whether an element has all three components of a vector.
fn has_all(slots: &[Slot], target: Target) -> bool {
    let has = |index| {
        let mut slots = slots.iter();
        slots.any(|slot| slot.target == target && slot.index == index)
    };
    (0..3).all(has)
}

/// Adds a remark for each skipped list of an element.
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
    if !has_all(&slots, Target::Position) {
        return Err(FormatError::new(
            element.place,
            "the properties x, y and z of vertex",
            "not all of them",
        ));
    }
    let with_normal = has_all(&slots, Target::Normal);
    let with_colour = has_all(&slots, Target::Colour);
    let mut colours = Vec::new();
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
            match slot.target {
                Target::Position => point[slot.index] = finite(value, place)?,
                Target::Normal => normal[slot.index] = value,
                Target::Colour => colour[slot.index] = (value / slot.full) as f32,
                Target::None => {}
            }
        }
        source.end()?;
        polygons.add_point(point, start)?;
        if with_normal {
            polygons.add_normal(normal, start)?;
        }
        if with_colour {
            colours.push(Some(colour));
        }
    }
    polygons.point_colours = Rgb8::from_floats(&colours);
    Ok(())
}

/// Whether a property is the list of a face's corners.
fn is_indices(property: &Property) -> bool {
    let names: [&[u8]; 2] = [b"vertex_indices", b"vertex_index"];
    matches!(property.kind, Kind::List { .. }) && names.contains(&property.name.as_slice())
}

/// Checks that an element has a list of corners, and adds remarks on its other lists.
fn check_lists(element: &Element, polygons: &mut Polygons) -> Result<(), FormatError> {
    if !element.properties.iter().any(is_indices) {
        let name = String::from_utf8_lossy(&element.name);
        return Err(FormatError::new(
            element.place,
            format!("the list vertex_indices or vertex_index of {name}"),
            "none",
        ));
    }
    remark_lists(element, is_indices, polygons);
    Ok(())
}

fn read_faces(
    element: &Element,
    source: &mut impl Source,
    polygons: &mut Polygons,
) -> Result<(), FormatError> {
    let slots: Vec<Slot> = element.properties.iter().map(Slot::of).collect();
    check_lists(element, polygons)?;
    let with_colour = has_all(&slots, Target::Colour);
    // Faces use the normals of the vertices only if the vertices precede the faces, as in every
    // known file.
    let with_normal = !polygons.normals.is_empty();
    let mut corners = Vec::new();
    let first = polygons.faces.len();
    let mut colours = Vec::new();
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
                    if slot.target == Target::Colour {
                        colour[slot.index] = (value / slot.full) as f32;
                    }
                }
            }
        }
        source.end()?;
        polygons.add_face(&corners, None, start)?;
        if with_colour && first + colours.len() < polygons.faces.len() {
            colours.push(Some(colour));
        }
    }
    let faces = polygons.faces[first..].iter_mut();
    for (face, colour) in faces.zip(Rgb8::from_floats(&colours)) {
        face.colour = Some(colour);
    }
    Ok(())
}

/// Reads triangle strips: each index forms a triangle with the two previous indices, and -1 starts a new strip.
fn read_strips(
    element: &Element,
    source: &mut impl Source,
    polygons: &mut Polygons,
) -> Result<(), FormatError> {
    check_lists(element, polygons)?;
    let with_normal = !polygons.normals.is_empty();
    for _ in 0..element.count {
        source.start()?;
        for property in &element.properties {
            match property.kind {
                Kind::List { count, item } if is_indices(property) => {
                    read_strip(count, item, with_normal, source, polygons)?;
                }
                _ => skip_property(property, source)?,
            }
        }
        source.end()?;
    }
    Ok(())
}

fn read_strip(
    count: Scalar,
    item: Scalar,
    with_normal: bool,
    source: &mut impl Source,
    polygons: &mut Polygons,
) -> Result<(), FormatError> {
    let (mut before, mut reversed) = ([None; 2], false);
    for _ in 0..list_length(count, source)? {
        let place = source.place();
        let index = source.value(item)?;
        if index == -1.0 {
            (before, reversed) = ([None; 2], false);
            continue;
        }
        let c = corner(index, with_normal, place)?;
        let [a, b] = before;
        before = [b, Some(c)];
        let (Some(a), Some(b)) = (a, b) else {
            continue;
        };
        // Writers repeat a corner to continue a strip at another place; such a triangle has no
        // area.
        if a != b && b != c && c != a {
            let face = if reversed { [b, a, c] } else { [a, b, c] };
            polygons.add_face(&face, None, place)?;
        }
        reversed = !reversed;
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
        corners.push(corner(source.value(item)?, with_normal, place)?);
    }
    Ok(())
}

/// The corner at a point, with the point's normal.
fn corner(index: f64, with_normal: bool, place: Location) -> Result<Corner, FormatError> {
    if !(0.0..f64::from(Corner::NO_NORMAL)).contains(&index) || index.fract() != 0.0 {
        return Err(FormatError::new(
            place,
            "an index (0, 1, …)",
            format!("{index}"),
        ));
    }
    let point = index as u32;
    Ok(Corner {
        normal: if with_normal {
            point
        } else {
            Corner::NO_NORMAL
        },
        ..Corner::at(point)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::text::rows;

    const ASCII: &str = "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement other 1\nproperty list uchar int a\nproperty int b\nelement nothing 4000000000\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n\n0 1 0 1 2 3\n2 7 8 9\n4 0 1 2 3\n3 2 1 0\n";

    #[test]
    fn ascii() {
        let polygons = parse(ASCII.as_bytes()).unwrap();
        assert_eq!(polygons.points[3], [0.0, 1.0, 0.0]);
        assert_eq!(polygons.point_colours[3], Rgb8([1, 2, 3]));
        let counts: Vec<u32> = polygons.faces.iter().map(|face| face.count).collect();
        assert_eq!(counts, [4, 3]);
    }

    const VERTICES: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";

    #[test]
    fn triangle_strips() {
        let text = format!(
            "{VERTICES}element tristrips 2\nproperty int flags\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n7 9 0 1 2 3 -1 2 1 0 0\n8 3 1 3 2\n"
        );
        let polygons = parse(text.as_bytes()).unwrap();
        let corners: Vec<u32> = polygons.corners.iter().map(|corner| corner.point).collect();
        let expected = [[0, 1, 2], [2, 1, 3], [2, 1, 0], [1, 3, 2]];
        assert_eq!(corners, expected.as_flattened());
        assert!(polygons.remarks.is_empty());
        let error = parse(text.replace("8 3 1 3 2", "8 3 1 3 -2").as_bytes());
        let error = error.unwrap_err().to_string();
        assert_eq!(error, "line 16: expected an index (0, 1, …), found -2");
    }

    /// A strip is one line, which may have any length.
    #[test]
    fn long_strips() {
        let count = 100_000;
        let indices: String = (0..count).map(|i| format!(" {}", i % 4)).collect();
        let text = format!(
            "{VERTICES}element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n{count}{indices}\n"
        );
        assert_eq!(parse(text.as_bytes()).unwrap().faces.len(), count - 2);
        let error = parse(text.replace("1 2 3\n", "1 2 -3\n").as_bytes());
        let error = error.unwrap_err().to_string();
        assert_eq!(error, "line 14: expected an index (0, 1, …), found -3");
    }

    #[test]
    fn colours_of_floats_to_1_and_to_255() {
        for (one, half) in [("1", "0.5"), ("255", "127.5")] {
            let colour = "property float red\nproperty float green\nproperty float blue\n";
            let text = format!(
                "{VERTICES}{colour}element face 3\nproperty list uchar int vertex_indices\n{colour}end_header\n0 0 0 {one} {half} 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n1 1 0 nan 0 0\n3 0 1 2 0 {half} {one}\n2 0 1 0 0 0\n3 0 1 2 0 0 0\n"
            );
            let polygons = parse(text.as_bytes()).unwrap();
            assert_eq!(polygons.point_colours[0], Rgb8([255, 128, 0]));
            assert_eq!(polygons.point_colours[3], Rgb8::DEFAULT);
            let colours: Vec<_> = polygons.faces.iter().map(|face| face.colour).collect();
            assert_eq!(colours, [Some(Rgb8([0, 128, 255])), Some(Rgb8([0; 3]))]);
            let remark = "line 21: a face of fewer than three corners is skipped";
            assert_eq!(polygons.remarks, [remark]);
        }
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
            let normal = [0.0f32, 0.0, f32::NAN];
            normal.iter().for_each(|c| put(&c.to_le_bytes()));
        }
        let shorts = [0, 65535, 32768u16, 3];
        shorts.iter().for_each(|c| put(&c.to_le_bytes()));
        [0, 1, index].iter().for_each(|i| put(&i.to_le_bytes()));
        file
    }

    #[test]
    fn both_byte_orders() {
        for (order, swap) in [("little", false), ("big", true)] {
            let polygons = parse(&binary(order, swap, 2)).unwrap();
            assert_eq!(polygons.points[2], [2.0, 4.0, -2.0]);
            assert_eq!(polygons.faces[0].colour, Some(Rgb8([0, 255, 128])));
            let corner = polygons.corners[2];
            assert_eq!((corner.point, corner.normal), (2, 2));
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
        let cases = [
            (&[][..], "line 1: expected ply, found the end of the file"),
            (b"plx\n", "line 1: expected ply, found 'plx'"),
            (
                b"ply\nformat ascii 1.0\n",
                "line 2: expected end_header, found the end of the file",
            ),
            (
                b"ply\nend_header\n",
                "line 2: expected a format line before end_header, found 'end_header'",
            ),
            (
                b"ply\nformat ascii 1.0\nend_header\n",
                "expected at least one face, found none",
            ),
            (
                &good[..good.len() - 1],
                "byte 395: expected an int32, found the end of the file",
            ),
            (
                &binary("little", false, -7),
                "byte 395: expected an index (0, 1, …), found -7",
            ),
        ];
        for (file, message) in cases {
            assert_eq!(parse(file).unwrap_err().to_string(), message);
        }
        let changes = "
            element vertex 4 → element vertex 4294967296 → line 4: expected a count of elements up to 2^32 - 1, found 'element vertex 4294967296'
            element vertex 4 → element vertex 4000000000 → line 23: expected a uint8, found the end of the line
            1 1 0 0 0 255 → 1 1 0 0 0 256 → line 20: expected a uint8, found '256'
            1 1 0 0 0 255 → 1 nan 0 0 0 255 → line 20: expected a finite number, found NaN
            property double z → property double w → line 4: expected the properties x, y and z of vertex, found not all of them
            3 2 1 0 → 3 2 1 -1 → line 25: expected an index (0, 1, …), found -1
            3 2 1 0 → 3 2 1 4 → line 25: expected a point index below 4, found 4 (counted from 0)
        ";
        for [from, to, message] in rows(changes) {
            let error = parse(ASCII.replace(from, to).as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), message);
        }
    }
}
