//! A virtual, read-only SPI flash: its content, and its pins edge by edge.
//!
//! It supports one command, 0x6b: fast read with quad output. It ignores any other command. Writes and a maximum clock frequency are not
//! modelled.

#![forbid(unsafe_code)]

/// Largest number of bytes: addresses have 24 bits.
pub const MAX_BYTES: usize = 1 << 24;
/// Value of an erased byte.
pub const ERASED: u8 = 0xff;

/// Fast read with quad output.
const READ_QUAD: u32 = 0x6b;
/// Number of clocks of a command and its address.
const ADDRESS_END: u32 = 32;
/// Number of clocks from the start of a command to the data.
const DATA_START: u32 = ADDRESS_END + 8;

/// Levels of the input pins of the flash.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pins {
    /// CS#: the flash is selected while it is low.
    pub cs_n: bool,
    /// The clock; the flash samples commands at its rising edge.
    pub clk: bool,
    /// The data lines; undriven lines are high.
    pub lines: u8,
}

/// A read-only SPI flash.
#[derive(Clone, Debug)]
pub struct Flash {
    bytes: Vec<u8>,
    clk: bool,
    /// Number of rising edges of the clock since the flash was selected.
    clocks: u32,
    /// The last 32 bits of line 0 before [`ADDRESS_END`]: command and address.
    received: u32,
    /// The nibble that the flash sends.
    sent: Option<u8>,
    commands: u64,
}

impl Flash {
    /// A flash that contains `bytes`, at most [`MAX_BYTES`], followed by erased bytes.
    #[must_use]
    pub fn new(bytes: Vec<u8>) -> Self {
        Self {
            bytes,
            clk: false,
            clocks: 0,
            received: 0,
            sent: None,
            commands: 0,
        }
    }

    /// The byte at `address`.
    #[must_use]
    pub fn byte(&self, address: usize) -> u8 {
        self.bytes.get(address).copied().unwrap_or(ERASED)
    }

    /// The little-endian word at `address`.
    #[must_use]
    pub fn word(&self, address: usize) -> u32 {
        u32::from_le_bytes([0, 1, 2, 3].map(|place| self.byte(address + place)))
    }

    /// Number of read commands so far.
    #[must_use]
    pub fn commands(&self) -> u64 {
        self.commands
    }

    /// Processes new levels of the pins; returns the levels of the four data lines, if the flash drives them.
    pub fn update(&mut self, pins: Pins) -> Option<u8> {
        let (rises, falls) = (pins.clk && !self.clk, !pins.clk && self.clk);
        self.clk = pins.clk;
        if pins.cs_n {
            self.clocks = 0;
            self.sent = None;
        } else if rises {
            if self.clocks < ADDRESS_END {
                self.received = self.received << 1 | u32::from(pins.lines & 1);
            }
            self.clocks += 1;
            let is_command = self.clocks == ADDRESS_END && self.received >> 24 == READ_QUAD;
            self.commands += u64::from(is_command);
        } else if falls && self.clocks >= DATA_START && self.received >> 24 == READ_QUAD {
            self.sent = Some(self.half_byte(self.clocks - DATA_START));
        }
        self.sent
    }

    /// The nibble at index `place`, the high nibble of a byte first. The address wraps from the last to the first.
    fn half_byte(&self, place: u32) -> u8 {
        let address = self.received.wrapping_add(place / 2) as usize % MAX_BYTES;
        let byte = self.byte(address);
        if place.is_multiple_of(2) {
            byte >> 4
        } else {
            byte & 0xf
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sends bits on line 0, the highest first, and returns the levels that the flash drives after each falling edge.
    fn clock(flash: &mut Flash, bits: &[u8]) -> Vec<Option<u8>> {
        let clocks = bits.iter().map(|&bit| {
            let mut pins = Pins {
                lines: 0b1110 | bit,
                ..Pins::default()
            };
            flash.update(pins);
            pins.clk = true;
            flash.update(pins);
            pins.clk = false;
            flash.update(pins)
        });
        clocks.collect()
    }

    fn bits(value: u32) -> Vec<u8> {
        (0..32).rev().map(|bit| (value >> bit & 1) as u8).collect()
    }

    fn selected(bytes: &[u8]) -> Flash {
        let mut flash = Flash::new(bytes.to_vec());
        let idle = Pins {
            cs_n: true,
            clk: false,
            lines: 0xf,
        };
        assert_eq!(flash.update(idle), None);
        flash
    }

    #[test]
    fn bytes_follow_the_command_the_high_half_first() {
        let mut flash = selected(&[0x12, 0x34, 0x56]);
        assert!(
            clock(&mut flash, &bits(0x6b00_0001))
                .iter()
                .all(Option::is_none)
        );
        let answer = clock(&mut flash, &[1; 13]);
        let mut expected = vec![None; 7];
        expected.extend([3, 4, 5, 6, 0xf, 0xf].map(Some));
        assert_eq!(answer, expected);
        assert_eq!(flash.commands(), 1);
    }

    #[test]
    fn the_first_byte_follows_the_last_one() {
        let mut flash = selected(&[0x21]);
        clock(&mut flash, &bits(0x6bff_ffff));
        let answer = clock(&mut flash, &[1; 11]);
        assert_eq!(answer[7..], [0xf, 0xf, 2, 1].map(Some));
    }

    #[test]
    fn another_command_has_no_answer_until_the_flash_is_selected_again() {
        let mut flash = selected(&[0x12]);
        clock(&mut flash, &bits(0x0300_0000));
        assert!(clock(&mut flash, &[1; 40]).iter().all(Option::is_none));
        let idle = Pins {
            cs_n: true,
            ..Pins::default()
        };
        flash.update(idle);
        clock(&mut flash, &bits(0x6b00_0000));
        assert_eq!(clock(&mut flash, &[1; 8])[7], Some(1));
        assert_eq!(flash.commands(), 1);
    }
}
