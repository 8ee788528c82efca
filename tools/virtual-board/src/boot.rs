//! ROM contents for the preloaded start: a few instructions instead of the BIOS.

use litex_pac::memories::MAIN_RAM;
use litex_pac::register::Value;

/// Numbers of CPU registers, named as in the ABI.
const T0: u32 = 5;
const T1: u32 = 6;
const ZERO: u32 = 0;

/// Returns ROM contents: a program that connects the memory controller to the DDR3 and jumps to the start of main RAM.
///
/// A real DDR3 would first require set-up of its mode registers and training of the PHY; the model requires neither.
pub(crate) fn stub() -> Vec<u8> {
    // SAFETY: only computes the address of a register, without an access.
    let control = unsafe { litex_pac::sdram::Sdram::steal() }
        .dfii_control()
        .address() as u32;
    let controller_in_charge = litex_pac::sdram::DfiiControl::default().with_sel(true);
    [
        // `sw` adds the low 12 bits of the address as a signed number, so the upper bits are rounded, not truncated.
        lui(T0, control.wrapping_add(0x800) >> 12),
        addi(T1, ZERO, controller_in_charge.bits()),
        sw(T1, T0, control & 0xfff),
        lui(T0, MAIN_RAM.base >> 12),
        jalr(ZERO, T0, 0),
    ]
    .into_iter()
    .flat_map(u32::to_le_bytes)
    .collect()
}

/// `lui rd, upper`: rd = upper << 12.
const fn lui(rd: u32, upper: u32) -> u32 {
    upper << 12 | rd << 7 | 0x37
}

/// `addi rd, rs, immediate`; the immediate is a signed number of 12 bits.
const fn addi(rd: u32, rs: u32, immediate: u32) -> u32 {
    (immediate & 0xfff) << 20 | rs << 15 | rd << 7 | 0x13
}

/// `sw rs, offset(base)`; the offset is a signed number of 12 bits.
const fn sw(rs: u32, base: u32, offset: u32) -> u32 {
    (offset >> 5 & 0x7f) << 25 | rs << 20 | base << 15 | 2 << 12 | (offset & 0x1f) << 7 | 0x23
}

/// `jalr rd, offset(base)`; the offset is a signed number of 12 bits.
const fn jalr(rd: u32, base: u32, offset: u32) -> u32 {
    (offset & 0xfff) << 20 | base << 15 | rd << 7 | 0x67
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_are_encoded_as_the_assembler_does() {
        assert_eq!(lui(T0, 0xf0002), 0xf000_22b7);
        assert_eq!(addi(T1, ZERO, 1), 0x0010_0313);
        assert_eq!(sw(T1, T0, 0), 0x0062_a023);
        assert_eq!(sw(T1, T0, 0xffc), 0xfe62_ae23);
        assert_eq!(jalr(ZERO, T0, 0), 0x0002_8067);
    }
}
