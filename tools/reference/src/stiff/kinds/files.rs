//! Files of meshes, logs and scenes, and the bytes of meshes and flash images.

use std::path::Path;

use anyhow::Result;
use glint::convert::{self, Options};
use glint::formats::{Format, glm, parse};
use glint::imu::log;
use glint_core::flash::{CONTENTS, Image, Kind as Item, Piece, encode};
use glint_core::mesh::Mesh;
use glint_scene_file::SceneFile;
use glint_vectors::Model;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("mesh-file", mesh_file),
        Kind::new("mesh-bytes", mesh_bytes),
        Kind::new("conversion", conversion),
        Kind::new("sensor-log", |text: String| {
            Ok(Outcome::of(log::parse(text.as_bytes()), |log| {
                format!("{} samples", log.entries.len())
            }))
        }),
        Kind::new("scene-file", |text: String| {
            let scene = SceneFile::parse("scene", "scene.toml", &text);
            Ok(Outcome::of(scene, |scene| {
                scene.lines().collect::<Vec<_>>().join("; ")
            }))
        }),
        Kind::new("flash-image", flash_image),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    /// Name, whose extension selects the format.
    name: String,
    /// Start of the content. Then `repeated` follows `times` times, then `end`, then `hex`.
    text: String,
    #[serde(default)]
    repeated: String,
    #[serde(default)]
    times: usize,
    #[serde(default)]
    end: String,
    /// Further bytes in hexadecimal digits.
    #[serde(default)]
    hex: String,
}

/// Reads a mesh file.
fn mesh_file(file: File) -> Result<Outcome> {
    let path = Path::new(&file.name);
    let mut bytes = file.text.into_bytes();
    bytes.extend(file.repeated.repeat(file.times).bytes());
    bytes.extend(file.end.bytes());
    bytes.extend(bytes_of(&file.hex)?);
    let polygons = parse(path, Format::of(path)?, &bytes, &mut |_| None);
    Ok(Outcome::of(polygons, |polygons| {
        let counts = format!(
            "{} points, {} faces",
            polygons.points.len(),
            polygons.faces.len()
        );
        [counts]
            .into_iter()
            .chain(polygons.remarks)
            .collect::<Vec<_>>()
            .join("; ")
    }))
}

fn bytes_of(hex: &str) -> Result<Vec<u8>> {
    let digits: Vec<char> = hex.chars().filter(|c| !c.is_whitespace()).collect();
    let pairs = digits.chunks(2).map(|pair| pair.iter().collect::<String>());
    Ok(pairs
        .map(|pair| u8::from_str_radix(&pair, 16))
        .collect::<Result<_, _>>()?)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Bytes {
    /// Bytes that are overwritten in a cube's mesh, each as offset and hexadecimal digits.
    #[serde(default)]
    edits: Vec<(usize, String)>,
    /// Length of the mesh, truncated or padded with zeros.
    length: Option<usize>,
    /// Whether to check the file's checksum too.
    #[serde(default)]
    checksum: bool,
}

/// Checks a mesh in memory: a damaged cube of 368 bytes, with 8 vertices and 12 triangles without damage.
fn mesh_bytes(input: Bytes) -> Result<Outcome> {
    let mut bytes = Model::cube(8192).encoded();
    if input.checksum {
        glint_core::mesh::set_checksum(&mut bytes);
    }
    edit(&mut bytes, &input.edits, input.length)?;
    let counts = |mesh: Mesh| {
        format!(
            "{} vertices, {} triangles",
            mesh.vertex_count(),
            mesh.triangle_count()
        )
    };
    Ok(match input.checksum {
        true => Outcome::of(glm::check_file(&bytes), counts),
        false => Outcome::of(Mesh::new_checked(&bytes), counts),
    })
}

fn edit(bytes: &mut Vec<u8>, edits: &[(usize, String)], length: Option<usize>) -> Result<()> {
    bytes.resize(length.unwrap_or(bytes.len()), 0);
    for (offset, hex) in edits {
        let new = bytes_of(hex)?;
        let old = bytes.get_mut(*offset..offset + new.len());
        old.ok_or_else(|| anyhow::anyhow!("no bytes at {offset}"))?
            .copy_from_slice(&new);
    }
    Ok(())
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Conversion {
    /// The mesh as an OBJ file.
    obj: String,
    #[serde(default)]
    keep_scale: bool,
}

/// Converts a mesh for boards.
fn conversion(Conversion { obj, keep_scale }: Conversion) -> Result<Outcome> {
    let polygons = parse(
        Path::new("mesh.obj"),
        Format::Obj,
        obj.as_bytes(),
        &mut |_| None,
    )?;
    let options = Options {
        keep_scale,
        ..Options::default()
    };
    let converted = convert::convert(&polygons, options);
    Ok(Outcome::of(converted, |(_, report)| {
        format!(
            "{} vertices, {} triangles, {} dropped, rounded by at most {:.2} of 2^-14",
            report.vertices, report.triangles, report.degenerate, report.error_max_lsb
        )
    }))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Flash {
    /// Bytes that are overwritten in the contents, each as offset and hexadecimal digits.
    #[serde(default)]
    edits: Vec<(usize, String)>,
    /// Length of the image, truncated or padded with zeros.
    length: Option<usize>,
    /// Number of bytes of the firmware.
    #[serde(default = "small")]
    firmware: usize,
    /// Text of each scene.
    #[serde(default)]
    scene: String,
    /// Number of scenes.
    #[serde(default = "one")]
    scenes: usize,
}

fn small() -> usize {
    64
}

fn one() -> usize {
    1
}

/// A flash image with one or more scenes.
fn flash_image(input: Flash) -> Result<Outcome> {
    let piece = |number| Piece {
        kind: Item::Scene,
        name: format!("scene{number}"),
        bytes: input.scene.clone().into_bytes(),
    };
    let pieces: Vec<_> = (0..input.scenes).map(piece).collect();
    let mut bytes = match encode(&[], &vec![0; input.firmware], &pieces) {
        Ok(bytes) => bytes,
        Err(error) => return Ok(Outcome::Refused(error.to_string())),
    };
    let edits = input.edits.into_iter();
    let edits: Vec<_> = edits.map(|(at, hex)| (CONTENTS + at, hex)).collect();
    edit(&mut bytes, &edits, input.length)?;
    Ok(Outcome::of(Image::new_checked(&bytes), |image| {
        format!("{} items", image.contents.items().count())
    }))
}
