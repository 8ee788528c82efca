//! glTF 2.0, as JSON (`.gltf`) or binary (`.glb`).
//!
//! The crate `gltf` parses and validates the JSON. Its functions to read values panic on offsets out of range, so this module reads the
//! values.

mod buffers;
pub mod example;

use super::text::{BYTE_ORDER_MARK, checked};
use crate::error::{FormatError, Location, MAX_COORDINATE, quote};
use crate::polygons::{Corner, Polygons, Rgb8, Vector};
use buffers::{Beside, Buffers};
use gltf::accessor::Dimensions;
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};
use gltf::mesh::Mode;
use gltf::{Document, Error, Glb, Material, Node, Primitive, Semantic};
use serde::Deserialize;
use std::borrow::Cow;

/// Maximum number of bytes of JSON outside of strings. This bounds the memory, because three such bytes can become an object of some
/// hundred bytes. Buffers within the file are strings.
const MAX_STRUCTURE: usize = 4 << 20;
/// Maximum length in an error of a message of the crate.
const MAX_MESSAGE: usize = 200;

/// Columns of an affine map: the images of the axes, and the translation.
type Affine = [Vector; 4];

const IDENTITY: Affine = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];

/// Parses a glTF. The meshes of the first scene are merged, each with the transforms of its nodes. Colours come from materials and
/// vertices, converted from linear intensities to sRGB. Textures, skins and animations are ignored with a remark. `beside` reads a file in
/// the same folder.
///
/// # Errors
/// The first violation of the format, a required extension, sparse values, or a buffer file that cannot be read.
pub fn parse(file: &[u8], beside: Beside) -> Result<Polygons, FormatError> {
    let (json, binary) = split(file)?;
    let structure = structure(&json);
    if structure > MAX_STRUCTURE {
        return Err(FormatError::whole(
            format!("at most {MAX_STRUCTURE} bytes of JSON outside of strings"),
            structure.to_string(),
        ));
    }
    check_version(&json)?;
    let root = gltf::json::deserialize::from_slice(&json)
        .map_err(|error| invalid(Error::Deserialize(error)))?;
    check_positions(&root)?;
    let document = Document::from_json(root).map_err(invalid)?;
    let buffers = Buffers::read(&document, binary.as_deref().unwrap_or_default(), beside)?;
    let mut polygons = Polygons::default();
    if document.animations().next().is_some() {
        polygons.remark("animations are ignored");
    }
    add_scene(&mut polygons, &document, &buffers)?;
    polygons.finish()?;
    Ok(polygons)
}

/// The JSON of a file, and the binary chunk of a `.glb`.
type Chunks<'a> = (Cow<'a, [u8]>, Option<Cow<'a, [u8]>>);

fn split(file: &[u8]) -> Result<Chunks<'_>, FormatError> {
    if !file.starts_with(b"glTF") {
        let json = file.strip_prefix(BYTE_ORDER_MARK).unwrap_or(file);
        return Ok((json.into(), None));
    }
    let Some(length) = file.get(8..12).and_then(<[u8]>::first_chunk) else {
        return Err(FormatError::whole(
            "a header of 12 bytes",
            file.len().to_string(),
        ));
    };
    // The crate subtracts the header's 12 bytes from this length without a check.
    let length = u32::from_le_bytes(*length);
    if length < 12 || length as usize > file.len() {
        return Err(FormatError::new(
            Location::Byte(8),
            format!("a length of 12 to {} bytes", file.len()),
            length.to_string(),
        ));
    }
    let chunks = Glb::from_slice(file).map_err(invalid)?;
    Ok((chunks.json, chunks.bin))
}

/// Number of bytes of a JSON text outside of strings.
fn structure(json: &[u8]) -> usize {
    let (mut in_string, mut escaped, mut count) = (false, false, 0);
    for &byte in json {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => {
                in_string = !in_string;
                count += 1;
            }
            _ if in_string => {}
            _ => count += 1,
        }
    }
    count
}

/// Fields that exist in every version of the format.
#[derive(Deserialize)]
struct Head {
    asset: Asset,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: String,
    min_version: Option<String>,
}

/// Checks that the file has version 2, and that a reader of version 2.0 can read it: later minor versions are compatible. The crate
/// rejects a file without a version.
fn check_version(json: &[u8]) -> Result<(), FormatError> {
    let Ok(Head { asset }) = serde_json::from_slice(json) else {
        return Ok(());
    };
    let minor = asset.version.strip_prefix("2.").unwrap_or_default();
    if minor.is_empty() || !minor.bytes().all(|byte| byte.is_ascii_digit()) {
        let found = quote(asset.version.as_bytes());
        return Err(FormatError::whole("an asset.version 2.0 or 2.x", found));
    }
    match asset.min_version {
        Some(least) if least != "2.0" => {
            let found = quote(least.as_bytes());
            Err(FormatError::whole(
                "an asset.minVersion of 2.0 or none",
                found,
            ))
        }
        _ => Ok(()),
    }
}

/// Checks values that the crate's validation uses before it checks them.
fn check_positions(root: &Root) -> Result<(), FormatError> {
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let positions = primitives.filter_map(|primitive| {
        primitive
            .attributes
            .get(&Checked::Valid(Semantic::Positions))
    });
    let accessors = root.accessors.len();
    for index in positions.map(Index::value) {
        if index >= accessors {
            let expected = format!("an accessor of positions below {accessors}");
            return Err(FormatError::whole(expected, index.to_string()));
        }
    }
    Ok(())
}

fn invalid(error: Error) -> FormatError {
    let message = match error {
        Error::Validation(errors) => errors
            .first()
            .map_or(String::new(), |(path, error)| format!("{path}: {error}")),
        other => other.to_string(),
    };
    let message = message.chars().take(MAX_MESSAGE);
    let message = message.map(|c| if c.is_control() { ' ' } else { c });
    FormatError::whole("valid glTF 2.0", message.collect::<String>())
}

fn add_scene(
    polygons: &mut Polygons,
    document: &Document,
    buffers: &Buffers,
) -> Result<(), FormatError> {
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    let scene = scene.ok_or_else(|| FormatError::whole("a scene", "none"))?;
    // Without this check a few nodes could multiply a mesh exponentially.
    let mut visited = vec![false; document.nodes().count()];
    let mut waiting: Vec<(Node, Affine)> = scene.nodes().map(|node| (node, IDENTITY)).collect();
    while let Some((node, parent)) = waiting.pop() {
        if std::mem::replace(&mut visited[node.index()], true) {
            return Err(FormatError::whole(
                format!("one parent of node {}", node.index()),
                "several",
            ));
        }
        let map = product(&parent, &local(&node));
        if node.skin().is_some() {
            polygons.remark("skins are ignored: meshes have their rest pose");
        }
        if let Some(mesh) = node.mesh() {
            for primitive in mesh.primitives() {
                add_primitive(polygons, &primitive, buffers, &map)?;
            }
        }
        waiting.extend(node.children().map(|child| (child, map)));
    }
    Ok(())
}

fn add_primitive(
    polygons: &mut Polygons,
    primitive: &Primitive,
    buffers: &Buffers,
    map: &Affine,
) -> Result<(), FormatError> {
    let mode = primitive.mode();
    if !matches!(
        mode,
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
    ) {
        polygons.remark("points and lines are ignored");
        return Ok(());
    }
    if primitive.morph_targets().next().is_some() {
        polygons.remark("morph targets are ignored");
    }
    let positions = primitive
        .get(&Semantic::Positions)
        .ok_or_else(|| FormatError::whole("positions of a primitive", "none"))?;
    let positions = buffers.values(&positions, &[Dimensions::Vec3], None)?;
    let count = positions.count;
    let values = |accessor, dimensions: &[Dimensions]| {
        let accessor: Option<gltf::Accessor> = accessor;
        let values = accessor.map(|accessor| buffers.values(&accessor, dimensions, Some(count)));
        values.transpose()
    };
    let normals = values(primitive.get(&Semantic::Normals), &[Dimensions::Vec3])?;
    let mut colours = values(
        primitive.get(&Semantic::Colors(0)),
        &[Dimensions::Vec3, Dimensions::Vec4],
    )?;
    if let Some(colours) = &mut colours {
        // Integer colours are always normalised.
        colours.normalised = true;
    }
    let indices = primitive.indices();
    let indices = indices.map(|indices| buffers.values(&indices, &[Dimensions::Scalar], None));
    let indices = indices.transpose()?;

    let base = base_colour(polygons, &primitive.material(), colours.is_some());
    let first_point = polygons.points.len() as u32;
    let first_normal = polygons.normals.len() as u32;
    let turned = turn_of_normals(map);
    for i in 0..count {
        let point = apply(map, positions.vector(i));
        if let Some(found) = point.iter().find(|c| checked(**c).is_none()) {
            return Err(FormatError::whole(
                format!("coordinates within ±{MAX_COORDINATE:e}"),
                format!("{found:.3e} of a mesh in its place"),
            ));
        }
        polygons.add_point(point, Location::Whole)?;
        let colour = colours
            .as_ref()
            .map_or([1.0; 3], |colours| colours.vector(i));
        let colour = base.map(|base| srgb(multiplied(base, colour)));
        polygons.point_colours.push(colour.unwrap_or(Rgb8::DEFAULT));
        if let Some(normals) = &normals {
            polygons.add_normal(apply(&turned, normals.vector(i)), Location::Whole)?;
        }
    }

    let corners = indices.as_ref().map_or(count, |indices| indices.count);
    let corner = |i: usize| {
        let index = indices.as_ref().map_or(i, |indices| indices.index(i));
        if index >= count {
            return Err(FormatError::whole(
                format!("an index below {count}"),
                index.to_string(),
            ));
        }
        Ok(Corner {
            normal: match normals {
                Some(_) => first_normal + index as u32,
                None => Corner::NO_NORMAL,
            },
            ..Corner::at(first_point + index as u32)
        })
    };
    let triangles = match mode {
        Mode::Triangles => corners / 3,
        _ => corners.saturating_sub(2),
    };
    let colour = base.filter(|_| colours.is_none()).map(srgb);
    let mirrored = determinant(map) < 0.0;
    for i in 0..triangles {
        let [a, b, c] = match mode {
            Mode::Triangles => [3 * i, 3 * i + 1, 3 * i + 2],
            Mode::TriangleFan => [0, i + 1, i + 2],
            _ if i % 2 == 0 => [i, i + 1, i + 2],
            _ => [i + 1, i, i + 2],
        };
        let [b, c] = if mirrored { [c, b] } else { [b, c] };
        let face = [corner(a)?, corner(b)?, corner(c)?];
        polygons.add_face(&face, colour, Location::Whole)?;
    }
    Ok(())
}

/// The colour of a material, as linear intensities; `None` for the default material without vertex colours.
fn base_colour(polygons: &mut Polygons, material: &Material, has_colours: bool) -> Option<Vector> {
    if material.index().is_none() && !has_colours {
        return None;
    }
    let material = material.pbr_metallic_roughness();
    if material.base_color_texture().is_some() {
        polygons.remark("textures are ignored: materials have their base colours");
    }
    let [red, green, blue, _] = material.base_color_factor();
    Some([red, green, blue].map(f64::from))
}

fn multiplied(a: Vector, b: Vector) -> Vector {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// Converts linear intensities to sRGB (IEC 61966-2-1).
fn srgb(linear: Vector) -> Rgb8 {
    Rgb8::from_unit(linear.map(|c| {
        if c <= 0.003_130_8 {
            12.92 * c
        } else {
            1.055 * c.powf(1.0 / 2.4) - 0.055
        }
    }))
}

/// The map from a node to its parent.
fn local(node: &Node) -> Affine {
    let matrix = node.transform().matrix();
    matrix.map(|[x, y, z, _]| [x, y, z].map(f64::from))
}

fn apply(map: &Affine, [x, y, z]: Vector) -> Vector {
    [0, 1, 2].map(|i| map[0][i] * x + map[1][i] * y + map[2][i] * z + map[3][i])
}

/// The map that applies `inner`, then `outer`.
fn product(outer: &Affine, inner: &Affine) -> Affine {
    let linear = [outer[0], outer[1], outer[2], [0.0; 3]];
    let [x, y, z, place] = *inner;
    [
        apply(&linear, x),
        apply(&linear, y),
        apply(&linear, z),
        apply(outer, place),
    ]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn determinant(map: &Affine) -> f64 {
    let [x, y, z, _] = *map;
    multiplied(cross(x, y), z).iter().sum()
}

/// The map for normals: the inverse transpose, times the magnitude of the determinant.
fn turn_of_normals(map: &Affine) -> Affine {
    let [x, y, z, _] = *map;
    let sign = determinant(map).signum();
    let scaled = |column: Vector| column.map(|c| sign * c);
    [
        scaled(cross(y, z)),
        scaled(cross(z, x)),
        scaled(cross(x, y)),
        [0.0; 3],
    ]
}

#[cfg(test)]
mod tests;
