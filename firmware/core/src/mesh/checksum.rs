//! The checksum of a mesh in a file.

use super::MeshHeader;
use crate::wire::crc_32_without;

/// Reads the checksum in the header of a mesh; `None` for bytes shorter than a header.
pub fn stated_checksum(mesh: &[u8]) -> Option<u32> {
    Some(MeshHeader::from_bytes(mesh.first_chunk()?).checksum)
}

/// Computes the checksum of a mesh: the CRC-32 of all bytes except the checksum's own bytes.
pub fn checksum(mesh: &[u8]) -> u32 {
    crc_32_without(mesh, MeshHeader::CHECKSUM)
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
