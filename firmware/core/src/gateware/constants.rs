//! Numbers that gateware, firmware and host share.
// Generated from gateware/glint_soc/constants.py by `cargo xtask pac`. Do not edit.

/// A picture size of the gateware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Number of lines of a band.
    pub band_lines: u32,
}

/// The picture sizes by their code in registers. The last size is the size of the screen.
pub const PICTURES: [Picture; 3] = [
    Picture { width: 320, height: 180, band_lines: 45 },
    Picture { width: 640, height: 360, band_lines: 24 },
    Picture { width: 1280, height: 720, band_lines: 12 },
];

/// Number of neighbouring pixels of a line in a 128-bit word, which is a row of the band buffer.
pub const GROUP: u32 = 8;

/// Number of band lists of a set.
pub const LISTS: u32 = 64;

/// Number of 128-bit words before the first band list of a set: the table of the lists' lengths.
pub const LIST_TABLE_WORDS: u32 = 16;

/// Number of 128-bit words between two band lists.
pub const LIST_GAP_WORDS: u32 = 128;

/// Offset of the firmware in the SPI flash.
pub const FLASH_FIRMWARE: u32 = 0x300000;
