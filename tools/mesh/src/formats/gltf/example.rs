//! An example file for tests and fuzzing.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// A glTF with two meshes and a base64 buffer.
pub const TWO_MESHES: &str = include_str!("two-meshes.gltf");

/// Converts a glTF with one base64 buffer to `.glb`. Returns the `.glb` and the buffer.
pub fn as_binary(gltf: &str) -> Option<(Vec<u8>, Vec<u8>)> {
    let (start, rest) = gltf.split_once("\"uri\": \"data:application/octet-stream;base64,")?;
    let (data, end) = rest.split_once("\", ")?;
    let buffer = BASE64_STANDARD.decode(data).ok()?;
    let mut json = [start, end].concat().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    let chunks = [
        &length(&json)[..],
        b"JSON",
        &json,
        &length(&buffer),
        b"BIN\0",
        &buffer,
    ]
    .concat();
    let whole = (chunks.len() as u32 + 12).to_le_bytes();
    let header = [&b"glTF"[..], &2_u32.to_le_bytes(), &whole];
    Some(([&header.concat()[..], &chunks].concat(), buffer))
}
