//! glTF 2.0, as JSON (`.gltf`) or binary (`.glb`).
//!
//! This parser replaces the crate `gltf`, which rejects files for faults in parts that Glint
//! ignores, such as application-specific attributes, textures and required material extensions, and
//! which panics on offsets out of range.

mod buffers;
pub mod example;
mod json;
mod materials;

use super::text::{BYTE_ORDER_MARK, finite};
use crate::error::{FormatError, Location, MAX_TRIANGLES, quote};
use crate::polygons::{Corner, Polygons, Rgb8, Vector};
use buffers::{Beside, Buffers, Values};
use json::{Dimensions, Index, Instancing, Material, Mode, Node, Primitive, Root, item};
use materials::{Materials, blended_opacity};
use serde::Deserialize;

/// Maximum number of bytes of JSON outside of strings. It bounds the memory for parsed JSON: three
/// such bytes can become an object of some hundred bytes. Buffers within the file are strings, so
/// they are not counted.
const MAX_STRUCTURE: usize = 4 << 20;
/// Maximum number of characters of the JSON parser's message in an error.
const MAX_MESSAGE: usize = 200;

/// Columns of an affine map: the images of the axes, and the translation.
type Affine = [Vector; 4];

const IDENTITY: Affine = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];

/// Parses a glTF. The meshes of the default scene, or of the first scene if there is no default,
/// are merged, with the transforms of their nodes and instances (EXT_mesh_gpu_instancing). Hidden
/// nodes (KHR_node_visibility) are left out. Colours come from materials, including
/// KHR_materials_pbrSpecularGlossiness, and from vertices, and are converted from linear
/// intensities to sRGB. Base colour textures are read with their samplers, KHR_texture_transform
/// and alpha cutoff; a texture that cannot be used adds a remark. Skins, morph targets and
/// animations are ignored with a remark. `beside` reads a file in the same folder.
///
/// # Errors
/// The first violation of the format in the parts that Glint reads, a required extension that can change the shape, or a buffer file that
/// cannot be read.
pub fn parse(file: &[u8], beside: Beside) -> Result<Polygons, FormatError> {
    let (json, binary) = split(file)?;
    let structure = structure(json);
    if structure > MAX_STRUCTURE {
        return Err(FormatError::whole(
            format!("at most {MAX_STRUCTURE} bytes of JSON outside of strings"),
            structure.to_string(),
        ));
    }
    check_version(json)?;
    let root: Root = from_json(json)?;
    check_extensions(&root)?;
    let buffers = Buffers::read(&root, binary, &mut *beside)?;
    let mut reader = Reader {
        root: &root,
        buffers: &buffers,
        materials: Materials::new(&root, &buffers, beside),
        polygons: Polygons::default(),
        placed: 0,
    };
    if !root.animations.is_empty() {
        reader.polygons.remark("animations are ignored");
    }
    reader.add_scene()?;
    let mut polygons = reader.polygons;
    polygons.finish()?;
    Ok(polygons)
}

fn from_json<'a, T: Deserialize<'a>>(json: &'a [u8]) -> Result<T, FormatError> {
    serde_json::from_slice(json).map_err(|error| {
        let message = error.to_string();
        let message = message.chars().take(MAX_MESSAGE);
        let message = message.map(|c| if c.is_control() { ' ' } else { c });
        FormatError::whole("valid glTF 2.0", message.collect::<String>())
    })
}

/// The JSON of a file, and the binary chunk of a `.glb`, which may be empty.
fn split(file: &[u8]) -> Result<(&[u8], &[u8]), FormatError> {
    const HEADER: usize = 12;
    if !file.starts_with(b"glTF") {
        let json = file.strip_prefix(BYTE_ORDER_MARK).unwrap_or(file);
        return Ok((json, &[]));
    }
    let word = |file: &[u8], offset: usize| {
        let bytes = file.get(offset..).and_then(<[u8]>::first_chunk);
        bytes.copied().map(u32::from_le_bytes)
    };
    let (Some(version), Some(length)) = (word(file, 4), word(file, 8)) else {
        return Err(FormatError::whole(
            format!("a header of {HEADER} bytes"),
            file.len().to_string(),
        ));
    };
    if version != 2 {
        return Err(FormatError::new(
            Location::Byte(4),
            "version 2",
            version.to_string(),
        ));
    }
    let length = length as usize;
    if !(HEADER..=file.len()).contains(&length) {
        return Err(FormatError::new(
            Location::Byte(8),
            format!("a length of {HEADER} to {} bytes", file.len()),
            length.to_string(),
        ));
    }
    let file = &file[..length];
    let [mut json, mut binary] = [None; 2];
    let mut at = HEADER;
    while let (Some(size), Some(kind)) = (word(file, at), file.get(at + 4..at + 8)) {
        let start = at + 8;
        let chunk = file.get(start..).and_then(|rest| rest.get(..size as usize));
        let chunk = chunk.ok_or_else(|| {
            let expected = format!("a chunk of at most {} bytes", length.saturating_sub(start));
            FormatError::new(Location::Byte(at), expected, format!("{size} bytes"))
        })?;
        match kind {
            b"JSON" => json = json.or(Some(chunk)),
            b"BIN\0" => binary = binary.or(Some(chunk)),
            _ => {}
        }
        at = start + chunk.len();
    }
    let json = json.ok_or_else(|| FormatError::whole("a chunk JSON", "none"))?;
    Ok((json, binary.unwrap_or_default()))
}

/// Counts the bytes of a JSON text outside of strings.
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

/// Checks that the file's version is 2.x, and that its `minVersion`, if any, is 2.0. A reader of
/// version 2.0 can then read the file.
fn check_version(json: &[u8]) -> Result<(), FormatError> {
    let Head { asset } = from_json(json)?;
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

/// Required extensions that Glint supports.
const SUPPORTED: [&str; 3] = [
    "EXT_mesh_gpu_instancing",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
];

/// Substrings of the names of extensions that affect neither shapes nor base colours.
const WITHOUT_EFFECT: [&str; 5] = [
    "_materials_",
    "_texture_",
    "_lights_",
    "_animation_",
    "_xmp",
];

/// Checks that no required extension can change the shape in a way that Glint does not support, such as compression.
fn check_extensions(root: &Root) -> Result<(), FormatError> {
    let unknown = root.extensions_required.iter().find(|name| {
        !SUPPORTED.contains(&name.as_str())
            && !WITHOUT_EFFECT.iter().any(|part| name.contains(part))
    });
    match unknown {
        Some(name) => {
            let expected = if name.contains("compression") {
                "a file without compression"
            } else {
                "no required extension that can change the shape"
            };
            Err(FormatError::whole(expected, quote(name.as_bytes())))
        }
        None => Ok(()),
    }
}

struct Reader<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    materials: Materials<'a>,
    polygons: Polygons,
    /// Number of primitives added so far, counted once per node and instance.
    placed: usize,
}

impl Reader<'_> {
    fn add_scene(&mut self) -> Result<(), FormatError> {
        let root = self.root;
        let scene = match root.scene {
            Some(index) => item(&root.scenes, index, "scenes")?,
            None => {
                let first = root.scenes.first();
                first.ok_or_else(|| FormatError::whole("a scene", "none"))?
            }
        };
        // Without this check a few nodes could multiply a mesh exponentially.
        let mut visited = vec![false; root.nodes.len()];
        let mut waiting: Vec<(Index, Affine)> =
            scene.nodes.iter().map(|&node| (node, IDENTITY)).collect();
        while let Some((index, parent)) = waiting.pop() {
            let node = item(&root.nodes, index, "nodes")?;
            if std::mem::replace(&mut visited[index as usize], true) {
                return Err(FormatError::whole(
                    format!("one parent of node {index}"),
                    "several",
                ));
            }
            let hidden = node.extensions.visibility.as_ref();
            if hidden.is_some_and(|visibility| !visibility.visible) {
                self.polygons
                    .remark("hidden nodes are left out (KHR_node_visibility)");
                continue;
            }
            let map = product(&parent, &local(node));
            if node.skin.is_some() {
                self.polygons
                    .remark("skins are ignored: meshes have their rest pose");
            }
            if let Some(mesh) = node.mesh {
                match &node.extensions.instancing {
                    None => self.add_mesh(mesh, &map)?,
                    Some(instancing) => self.add_instances(mesh, instancing, &map)?,
                }
            }
            waiting.extend(node.children.iter().map(|&child| (child, map)));
        }
        Ok(())
    }

    /// Adds a mesh once for each instance of a node.
    fn add_instances(
        &mut self,
        mesh: Index,
        instancing: &Instancing,
        map: &Affine,
    ) -> Result<(), FormatError> {
        let buffers = self.buffers;
        let values = |index: Option<Index>, dimensions| {
            let values = index.map(|index| buffers.values(index, &[dimensions], None));
            values.transpose()
        };
        let attributes = &instancing.attributes;
        let translations = values(attributes.translation, Dimensions::Vec3)?;
        let rotations = values(attributes.rotation, Dimensions::Vec4)?;
        let scales = values(attributes.scale, Dimensions::Vec3)?;
        let lists = [&translations, &rotations, &scales];
        let counts = lists.into_iter().flatten().map(|values| values.count);
        for i in 0..counts.min().unwrap_or(0) {
            let place = placed(
                translations
                    .as_ref()
                    .map_or([0.0; 3], |values| values.vector(i)),
                rotations
                    .as_ref()
                    .map_or([0.0, 0.0, 0.0, 1.0], |values| values.vector(i)),
                scales.as_ref().map_or([1.0; 3], |values| values.vector(i)),
            );
            self.add_mesh(mesh, &product(map, &place))?;
        }
        Ok(())
    }

    fn add_mesh(&mut self, mesh: Index, map: &Affine) -> Result<(), FormatError> {
        let mesh = item(&self.root.meshes, mesh, "meshes")?;
        self.placed += mesh.primitives.len().max(1);
        if self.placed > MAX_TRIANGLES {
            let expected = format!("at most {MAX_TRIANGLES} primitives of nodes and instances");
            return Err(FormatError::whole(expected, "more"));
        }
        for primitive in &mesh.primitives {
            self.add_primitive(primitive, map)?;
        }
        Ok(())
    }

    fn add_primitive(&mut self, primitive: &Primitive, map: &Affine) -> Result<(), FormatError> {
        let Self {
            root,
            buffers,
            materials,
            polygons,
            ..
        } = self;
        if primitive.mode == Mode::PointsOrLines {
            polygons.remark("points and lines are ignored");
            return Ok(());
        }
        if !primitive.targets.is_empty() {
            polygons.remark("morph targets are ignored");
        }
        let attributes = &primitive.attributes;
        let positions = attributes
            .position
            .ok_or_else(|| FormatError::whole("positions of a primitive", "none"))?;
        let positions = buffers.values(positions, &[Dimensions::Vec3], None)?;
        let count = positions.count;
        let values = |index: Option<Index>, dimensions: &[Dimensions]| {
            let values = index.map(|index| buffers.values(index, dimensions, Some(count)));
            values.transpose()
        };
        let normals = values(attributes.normal, &[Dimensions::Vec3])?;
        let mut colours = values(attributes.color_0, &[Dimensions::Vec3, Dimensions::Vec4])?;
        if let Some(colours) = &mut colours {
            // Integer colours are always normalised.
            colours.normalised = true;
        }
        let indices = primitive.indices;
        let indices = indices.map(|index| buffers.values(index, &[Dimensions::Scalar], None));
        let indices = indices.transpose()?;
        let material = primitive.material;
        let material = material.map(|index| item(&root.materials, index, "materials"));
        let material = material.transpose()?;

        let texture = match material {
            Some(material) => materials.texture(material, polygons)?,
            None => None,
        };
        let coordinates = texture
            .as_ref()
            .and_then(|used| attributes.coordinates(used.set));
        let coordinates = values(coordinates, &[Dimensions::Vec2])?;
        let texture = match (texture, &coordinates) {
            (Some(used), Some(_)) => Some(used),
            (Some(used), None) => {
                polygons.remark(format!(
                    "no texture coordinates TEXCOORD_{} (up to 3 are read): surfaces keep their base colours",
                    used.set
                ));
                None
            }
            (None, _) => None,
        };

        let number = match &texture {
            Some(used) => used.texture,
            None => match material.and_then(blended_opacity) {
                Some(opacity) if opacity < 255 => polygons.white(opacity)?,
                _ => 0,
            },
        };
        let base = base_colour(polygons, material, colours.is_some());
        let first_point = polygons.points.len() as u32;
        let first_normal = polygons.normals.len() as u32;
        add_points(polygons, &positions, base, colours.as_ref(), map)?;
        let turned = turn_of_normals(map);
        if let Some(normals) = &normals {
            for i in 0..count {
                let normal = apply(&turned, normals.vector(i));
                polygons.add_normal(normal, Location::Whole)?;
            }
        }

        let first_coordinates = polygons.coordinates.len() as u32;
        if let (Some(used), Some(coordinates)) = (&texture, &coordinates) {
            for i in 0..count {
                let coordinates = used.transformed(coordinates.vector(i));
                polygons.add_coordinates(coordinates, Location::Whole)?;
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
                coordinates: match texture {
                    Some(_) => first_coordinates + index as u32,
                    None => Corner::NO_COORDINATES,
                },
                ..Corner::at(first_point + index as u32)
            })
        };
        let triangles = match primitive.mode {
            Mode::Triangles => corners / 3,
            _ => corners.saturating_sub(2),
        };
        let colour = base.filter(|_| colours.is_none()).map(srgb);
        let mirrored = determinant(map) < 0.0;
        let first_face = polygons.faces.len();
        for i in 0..triangles {
            let [a, b, c] = match primitive.mode {
                Mode::Triangles => [3 * i, 3 * i + 1, 3 * i + 2],
                Mode::TriangleFan => [0, i + 1, i + 2],
                _ if i % 2 == 0 => [i, i + 1, i + 2],
                _ => [i + 1, i, i + 2],
            };
            let [b, c] = if mirrored { [c, b] } else { [b, c] };
            let face = [corner(a)?, corner(b)?, corner(c)?];
            polygons.add_face(&face, colour, Location::Whole)?;
        }
        for face in &mut polygons.faces[first_face..] {
            face.texture = number;
            face.double_sided = material.is_some_and(|material| material.double_sided);
        }
        Ok(())
    }
}

/// Adds the points of a primitive with their colours.
fn add_points(
    polygons: &mut Polygons,
    positions: &Values,
    base: Option<Vector>,
    colours: Option<&Values>,
    map: &Affine,
) -> Result<(), FormatError> {
    for i in 0..positions.count {
        let point = apply(map, positions.vector(i));
        for c in point {
            finite(c, Location::Whole)?;
        }
        polygons.add_point(point, Location::Whole)?;
        let colour = colours.map_or([1.0; 3], |colours| colours.vector(i));
        let colour = base.map(|base| srgb(multiplied(base, colour)));
        polygons.point_colours.push(colour.unwrap_or(Rgb8::DEFAULT));
    }
    Ok(())
}

/// The base colour of a material as linear intensities; `None` for the default material without
/// vertex colours.
fn base_colour(
    polygons: &mut Polygons,
    material: Option<&Material>,
    has_colours: bool,
) -> Option<Vector> {
    let Some(material) = material else {
        return has_colours.then_some([1.0; 3]);
    };
    if material.emissive_factor != [0.0; 3] {
        polygons.remark("emitted light is ignored (emissiveFactor)");
    }
    let (_, [red, green, blue, _]) = material.base();
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

/// The affine map from a node's coordinates to its parent's.
fn local(node: &Node) -> Affine {
    match &node.matrix {
        Some(matrix) => [0, 4, 8, 12].map(|i| [i, i + 1, i + 2].map(|i| f64::from(matrix[i]))),
        None => placed(
            node.translation.map(f64::from),
            node.rotation.map(f64::from),
            node.scale.map(f64::from),
        ),
    }
}

/// The map that scales, then rotates by a quaternion (x, y, z, w) of any length, then translates.
fn placed(translation: Vector, [x, y, z, w]: [f64; 4], scale: Vector) -> Affine {
    let square = x * x + y * y + z * z + w * w;
    let s = if square > 0.0 { 2.0 / square } else { 0.0 };
    let rotation = [
        [
            1.0 - s * (y * y + z * z),
            s * (x * y + w * z),
            s * (x * z - w * y),
        ],
        [
            s * (x * y - w * z),
            1.0 - s * (x * x + z * z),
            s * (y * z + w * x),
        ],
        [
            s * (x * z + w * y),
            s * (y * z - w * x),
            1.0 - s * (x * x + y * y),
        ],
    ];
    let [a, b, c] = [0, 1, 2].map(|i| rotation[i].map(|c| c * scale[i]));
    [a, b, c, translation]
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
