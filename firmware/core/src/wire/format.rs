//! Blocks and the manifest of a transfer.

use core::ops::Range;

/// Number of bytes in a block, the unit of acknowledgement.
pub const BLOCK: u32 = 16;
/// Maximum number of blocks in a data frame.
pub const MAX_BLOCKS: u32 = 15;
/// Maximum number of blocks from the first unacknowledged block to the last sent block: the number of bits in the
/// map of an acknowledgement.
pub const WINDOW: u32 = u128::BITS;

/// Maximum length of a transfer in bytes, because block numbers have 24 bits.
pub const MAX_LENGTH: u32 = ((1 << 24) - 1) * BLOCK;

/// The CRC-32 algorithm by which a whole transfer is checked.
pub static CRC_32: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// Incremental computation of a CRC-32.
pub type Digest = crc::Digest<'static, u32>;

/// Computes the CRC-32 (IEEE 802.3, as in zlib) of all bytes of a transfer.
pub fn crc32(data: &[u8]) -> u32 {
    CRC_32.checksum(data)
}

/// Computes the CRC-32 of all bytes of a file except those of its own checksum, at `place`.
pub fn crc_32_without(data: &[u8], place: Range<usize>) -> u32 {
    let (before, rest) = data.split_at(place.start.min(data.len()));
    let mut digest = CRC_32.digest();
    digest.update(before);
    digest.update(rest.get(place.len()..).unwrap_or_default());
    digest.finalize()
}

/// Length and CRC-32 of a transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Manifest {
    /// Length in bytes, at most [`MAX_LENGTH`].
    pub length: u32,
    /// The [`crc32`] of all bytes.
    pub crc32: u32,
}

impl Manifest {
    /// Computes the manifest of `data`.
    pub fn of(data: &[u8]) -> Self {
        // A saturated length is harmless, because both sides reject lengths above `MAX_LENGTH`.
        Self {
            length: u32::try_from(data.len()).unwrap_or(u32::MAX),
            crc32: crc32(data),
        }
    }

    /// Number of blocks of the transfer; the last block may be short.
    pub const fn blocks(self) -> u32 {
        self.length.div_ceil(BLOCK)
    }
}
