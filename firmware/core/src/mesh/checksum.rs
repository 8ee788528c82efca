//! The checksum of a mesh in a file.

use super::HEADER;
use crate::wire::CRC_32;

/// Offset of the checksum in the header (docs/formats/mesh.md, "Mesh in memory").
const OFFSET: usize = 24;

/// The checksum in the header of a mesh; `None` for bytes without a whole header.
pub fn stated_checksum(mesh: &[u8]) -> Option<u32> {
    let bytes = mesh.get(..HEADER)?.get(OFFSET..)?.first_chunk()?;
    Some(u32::from_le_bytes(*bytes))
}

/// The checksum that a mesh needs: the CRC-32 of all its bytes but those of the checksum itself.
pub fn checksum(mesh: &[u8]) -> u32 {
    let (before, rest) = mesh.split_at(OFFSET.min(mesh.len()));
    let mut digest = CRC_32.digest();
    digest.update(before);
    digest.update(rest.get(4..).unwrap_or_default());
    digest.finalize()
}

/// Sets the checksum in the header of a mesh. Bytes without a whole header stay as they are.
pub fn set_checksum(mesh: &mut [u8]) {
    let checksum = checksum(mesh).to_le_bytes();
    if let Some(header) = mesh.get_mut(..HEADER)
        && let Some(place) = header.get_mut(OFFSET..OFFSET + 4)
    {
        place.copy_from_slice(&checksum);
    }
}
