//! An example file for tests and fuzzing.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// A glTF of two meshes, with its buffer in base64.
pub const TWO_MESHES: &str = include_str!("two-meshes.gltf");

/// Converts a glTF with one buffer in base64 to `.glb`; returns the `.glb` and the buffer.
pub fn as_binary(gltf: &str) -> Option<(Vec<u8>, Vec<u8>)> {
    let (start, rest) = gltf.split_once("\"uri\": \"data:application/octet-stream;base64,")?;
    let (data, end) = rest.split_once("\", ")?;
    let buffer = BASE64_STANDARD.decode(data).ok()?;
    let glb = gltf::Glb {
        header: gltf::binary::Header {
            magic: *b"glTF",
            version: 2,
            length: 0,
        },
        json: [start, end].concat().into_bytes().into(),
        bin: Some(buffer.as_slice().into()),
    };
    glb.to_vec().ok().map(|glb| (glb, buffer))
}
