//! The checksum of a mesh in a file.

use super::MeshHeader;
use crate::wire::CRC_32;

/// Reads the checksum in the header of a mesh; `None` for bytes shorter than a header.
pub fn stated_checksum(mesh: &[u8]) -> Option<u32> {
    Some(MeshHeader::from_bytes(mesh.first_chunk()?).checksum)
}

/// Computes the checksum of a mesh: the CRC-32 of all bytes except the checksum's own bytes.
pub fn checksum(mesh: &[u8]) -> u32 {
    let place = MeshHeader::CHECKSUM;
    let (before, rest) = mesh.split_at(place.start.min(mesh.len()));
    let mut digest = CRC_32.digest();
    digest.update(before);
    digest.update(rest.get(place.len()..).unwrap_or_default());
    digest.finalize()
}

/// Sets the checksum in the header of a mesh. Bytes shorter than a header stay unchanged.
pub fn set_checksum(mesh: &mut [u8]) {
    let checksum = checksum(mesh);
    if let Some(header) = mesh.first_chunk_mut() {
        *header = MeshHeader {
            checksum,
            ..MeshHeader::from_bytes(header)
        }
        .to_bytes();
    }
}
