//! Driver of two displays of four digits, each digit with seven segments and a point.

use litex_pac::digits;

/// The displays. On a board without displays the driver has no effect.
pub struct Digits {
    registers: digits::Digits,
}

impl Digits {
    /// Returns the displays, switched off.
    #[must_use]
    pub fn new(registers: digits::Digits) -> Self {
        let mut digits = Self { registers };
        digits.show([0; 8]);
        digits
    }

    /// Lights the segments of the eight digits from left to right: bits 0 to 6 for the segments a to g, bit 7 for the point.
    pub fn show(&mut self, segments: [u8; 8]) {
        let [a, b, c, d, e, f, g, h] = segments;
        self.registers
            .left()
            .write(u32::from_le_bytes([a, b, c, d]));
        self.registers
            .right()
            .write(u32::from_le_bytes([e, f, g, h]));
    }
}

#[cfg(test)]
mod tests {
    use litex_pac::Peripherals;
    use litex_pac::digits::Digits as Registers;

    use super::*;
    use litex_pac::recording;

    #[test]
    fn the_leftmost_digit_is_the_lowest_byte() {
        let block = recording::connect([]);
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        let mut digits = Digits::new(unsafe { Peripherals::steal() }.digits);
        digits.show([1, 2, 3, 4, 5, 6, 7, 8]);
        let writes = block.borrow().writes.clone();
        let (left, right) = (Registers::BASE, Registers::BASE + 4);
        let shown = [(left, 0x0403_0201), (right, 0x0807_0605)];
        assert_eq!(writes, [&[(left, 0), (right, 0)], &shown[..]].concat());
    }
}
